/* What is left of a number that is stored as a float. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_ROUNDING_H
#define ORB_ROUNDING_H

/* Volatile on purpose: gcc 12.2 at -O3, packing several (double)(float)x side by side, was seen to drop some of the
 * roundings (mend.c, is_bad; tests/native/test_whole_sphere.c counts the flips again by other means). */
static inline double rounding_to_float(double x) {
    volatile float stored = (float)x;
    return stored;
}

#endif
