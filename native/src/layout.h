/* Corner copies -> texture coordinates. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Gives orb_uv (orbifold.h): one table row for each chart. */
#ifndef ORB_LAYOUT_H
#define ORB_LAYOUT_H

#include "error.h"

/* Triangles of uv[n_triangles*3*2] whose signed area is not positive once the coordinates are rounded to float; the
 * area is formed in double from the floats. */
int64_t layout_flipped_float32(int32_t n_triangles, const double *uv);

#endif
