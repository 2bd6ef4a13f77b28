/* The boundary loops of a mesh, listed; some of them closed. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_BOUNDARY_H
#define ORB_BOUNDARY_H

#include "mesh.h"

typedef struct orb_boundary {
    int32_t n_loops;
    int32_t *start;    /* [n_loops + 1] the vertices of loop l are vertex[start[l]] ... vertex[start[l + 1] - 1] */
    int32_t *vertex;   /* [start[n_loops]] in the sequence in which they lie on the boundary */
    int32_t *halfedge; /* [start[n_loops]] on the edge from each to the next */
    int32_t *place;    /* [n_vertices] where a vertex is in `vertex`; -1 inside */
} orb_boundary;

orb_status boundary_list(const orb_mesh *mesh, orb_boundary **boundary, orb_error *error);
void boundary_free(orb_boundary *boundary);

/* The loop that a vertex is on; -1 inside. */
int32_t boundary_loop_of(const orb_boundary *boundary, int32_t vertex);
/* Sum of its edges' lengths. */
double boundary_length(const orb_mesh *mesh, const orb_boundary *boundary, int32_t loop);

/* rank[n_loops]: the loops in the sequence in which they become mirrors: those with some of the picked vertices first, then
 * the longest. */
orb_status boundary_rank(const orb_mesh *mesh, const orb_boundary *boundary, int32_t n_picks, const int32_t *picks,
                         int32_t *rank, orb_error *error);

/* A fan of triangles about a new vertex, the mean of the loop's, on each loop with closed[loop]. The new vertices and
 * triangles follow the mesh's own. */
orb_status boundary_close(const orb_mesh *mesh, const orb_boundary *boundary, const bool *closed, orb_mesh **result,
                          orb_error *error);

#endif
