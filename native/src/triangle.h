/* The measures of one triangle of a mesh, at any size. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_TRIANGLE_H
#define ORB_TRIANGLE_H

#include "mesh.h"

/* A triangle's edge vectors, divided by a power of two that brings the longest component into [1, 2): exact, and no
 * square can overflow or vanish against the others, at any size of the mesh. */
typedef struct triangle_shape {
    double edge[3][3];  /* corner c to corner c + 1 */
    double length[3];   /* of these */
    double double_area; /* 0 where rounding alone could have made it */
    double scale;       /* the power of two: a true length times this is the length here */
} triangle_shape;

triangle_shape triangle_measure(const orb_mesh *mesh, int32_t triangle);

#endif
