/* The mirror plane of a mesh. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_REFLECTION_H
#define ORB_REFLECTION_H

#include "mesh.h"

typedef struct orb_reflection {
    double plane[4]; /* a x + b y + c z = d, with a unit normal */
    int32_t *image;  /* [n_vertices] the mirror image of each used vertex, its own for one on the plane; -1: none */
} orb_reflection;

/* With a plane: the images are the nearest vertices, where two are one another's. Without: the first of the planes through
 * the centre of area that are orthogonal to x, y, z or a principal axis, and in which every vertex has a vertex for its
 * image, to a quarter of its shortest edge and a thousandth of the mesh's size. *reflection: NULL if there is none. Errors:
 * ORB_BAD_ARGUMENT (the plane's normal is zero or not finite), ORB_OUT_OF_MEMORY. */
orb_status reflection_find(const orb_mesh *mesh, const double *plane, orb_reflection **reflection, orb_error *error);
void reflection_free(orb_reflection *reflection);

#endif
