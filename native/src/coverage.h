/* Texels whose middles lie in triangles. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_COVERAGE_H
#define ORB_COVERAGE_H

#include <stdbool.h>
#include <stdint.h>

enum { MOST_PERIODS = 64 }; /* that a triangle may be away from the image, or wide */

/* Sets covered[height][width] to 1 there; the image repeats. uv [n_triangles*6]; triangles that reach over more than a
 * few periods, or are no numbers, are left out. */
void coverage_mark(int32_t width, int32_t height, int32_t n_triangles, const double *uv, uint8_t *covered);

/* number[height][width]: the triangle, the last of several, or -1. What lies beyond an image that does not repeat is
 * left out. */
void coverage_number(int32_t width, int32_t height, bool repeats, int32_t n_triangles, const double *uv,
                     int32_t *number);

#endif
