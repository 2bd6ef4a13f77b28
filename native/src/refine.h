/* Mesh + marked edges -> the same surface with these edges halved. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Vertices keep their numbers, midpoints follow in the sequence of the edges; a triangle with one, two or three
 * marked edges becomes two, three or four, which follow one another, and the orientation stays. */
#ifndef ORB_REFINE_H
#define ORB_REFINE_H

#include "mesh.h"

/* Where a path through cones has got to, for each vertex: its place on the path, counted from 0, or one of these. */
enum {
    REFINE_FREE = -1, /* neither on the path nor a cone */
    REFINE_CONE = -2  /* a cone that the path has not reached */
};

/* Halves the edges with marked[edge] != 0. *parent [refined->n_triangles]: the triangle that each came from. Both
 * are new objects for the caller to free; on failure both are NULL. O(n). Errors: ORB_OUT_OF_MEMORY,
 * ORB_BAD_ARGUMENT when the new mesh would be too large for 32-bit numbers, and mesh_create's. */
orb_status refine_edges(const orb_mesh *mesh, const uint8_t *marked /* [n_edges] */, orb_mesh **refined,
                        int32_t **parent, orb_error *error);

/* Marks the edges whose midpoints are room for the path's next segment: those that have an end on the path or on a
 * cone and are not edges of the path. With all of them halved, a path from the last vertex to any cone that is not
 * reached yet, free but for its ends, exists on every sphere-like mesh; and the midpoints that it visits suffice
 * (both proved in refine.c). */
void refine_mark(const orb_mesh *mesh, const int32_t *place /* [n_vertices] */, uint8_t *marked /* [n_edges] */);

#endif
