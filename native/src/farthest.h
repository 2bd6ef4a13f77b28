/* Points far from one another. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_FARTHEST_H
#define ORB_FARTHEST_H

#include "mesh.h"

/* Up to `count` of the eligible[n_vertices] vertices, each the farthest one, along edges, from those before it, from their
 * images and from start[n_start]; without any of these the first is the one farthest from the mean vertex. Of equally far
 * ones, the one with the lowest number. *n_points is less than `count` where there are no more. `image` [n_vertices]: each
 * vertex's mirror image, or NULL. O(count * n_vertices + n_vertices log n_vertices log count), roughly. Error:
 * ORB_OUT_OF_MEMORY. */
orb_status farthest_points(const orb_mesh *mesh, const bool *eligible, const int32_t *image, int32_t n_start,
                           const int32_t *start, int32_t count, int32_t *points, int32_t *n_points, orb_error *error);

#endif
