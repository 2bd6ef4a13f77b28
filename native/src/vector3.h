/* Vectors of space. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_VECTOR3_H
#define ORB_VECTOR3_H

#include <math.h>
#include <stdbool.h>

static inline double vector_dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline double vector_length(const double a[3]) { return sqrt(vector_dot(a, a)); }

static inline void vector_cross(const double a[3], const double b[3], double c[3]) {
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}

static inline void vector_subtract(const double a[3], const double b[3], double c[3]) {
    for (int k = 0; k < 3; k++)
        c[k] = a[k] - b[k];
}

/* To unit length; false for the zero vector. */
static inline bool vector_normalize(double a[3]) {
    double size = vector_length(a);
    for (int k = 0; k < 3 && size > 0; k++)
        a[k] /= size;
    return size > 0;
}

#endif
