/* All that the minimiser sees: edges between copies, and how freely each vertex moves.
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 *     E(x) = 1/2 sum over edges of w d(h_u x_o(u), h_v x_o(v))^2        (docs/mathematics.md, section 2)
 *
 * Tangent vectors of a vertex are complex numbers in the frame of the vertex itself; a copy's frame is turned. */
#ifndef ORB_PROBLEM_H
#define ORB_PROBLEM_H

#include "holonomy.h"

typedef struct orb_problem {
    const orb_geometry *geometry;
    const orb_copies *copies;
    int32_t n_vertices, n_edges;
    int32_t *edges;        /* [n_edges*2] copies */
    const double *weights; /* [n_edges] */
    uint8_t *freedom;      /* [n_vertices] 2: free; 1: on the geodesic through `toward`; 0: fixed */
    orb_point toward;      /* where vertices of freedom 1 look */
} orb_problem;

/* Borrows copies and weights. Cones and isolated vertices are fixed. */
orb_status problem_create(const orb_mesh *mesh, const orb_copies *copies, const orb_tile *tile, const int32_t *cones,
                          const double *weights, orb_problem **problem, orb_error *error);
void problem_free(orb_problem *problem);

/* Takes away a free rotation about `axis`, exactly: from now on `vertex` moves along its meridian only. If that vertex
 * is fixed, the first that is free is taken. */
void problem_hold_rotation(orb_problem *problem, int32_t vertex, orb_point axis);

/* placed[n_copies]: where each copy is; turn[n_copies]: the phase of its frame against its vertex's. */
void problem_place(const orb_problem *problem, const orb_point *position, orb_point *placed, double complex *turn);

/* The energy; gradient[n_vertices] (zero where fixed, along the geodesic where freedom is 1; may be NULL) and
 * *relative = max over vertices of |g_v| / sum_j w_vj d_vj, scale free; scale[n_vertices] is room for the sums. */
double problem_energy(const orb_problem *problem, const orb_point *placed, const double complex *turn,
                      const orb_point *position, double complex *gradient, double *scale, double *relative);

/* The direction that a vertex of freedom 1 may move in. */
double complex problem_direction(const orb_problem *problem, orb_point position);

#endif
