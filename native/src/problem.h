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
    uint8_t *freedom;      /* [n_vertices] 2: free; 1: on its line; 0: fixed */
    int32_t *line;         /* [n_vertices] of freedom 1: the entry of `lines` */
    int32_t n_lines;
    orb_isometry *lines; /* [n_lines] takes the real axis to the geodesic */
    int32_t n_sliding;   /* vertices of freedom 1 */
    bool reflects;       /* some copy is a mirror image of its vertex */
    int32_t held;        /* a vertex whose line problem_aim sets; -1 */
    orb_point axis;      /* of the rotation that this holds */
} orb_problem;

/* Borrows copies and weights. Cones, corners, isolated vertices and a fixed polygon's boundary are fixed; vertices on a
 * mirror slide along it. What moves freely all the same, a rotation or translations that commute with the whole group,
 * is taken out exactly, by taking one vertex's freedom along it. */
orb_status problem_create(const orb_mesh *mesh, const orb_copies *copies, const orb_disk *disk, const orb_tile *tile,
                          const double *weights, orb_problem **problem, orb_error *error);
void problem_free(orb_problem *problem);

/* Other edges, as many, between these copies (borrowed, as the weights are), whose first ones are those of before. */
void problem_use_edges(orb_problem *problem, const orb_copies *copies, const int32_t *edges, const double *weights);

/* Whether the Hessian's complex-linear part can stand for it: nothing is reflected and nothing slides, but perhaps the
 * vertex that holds a rotation. */
bool problem_is_complex(const orb_problem *problem);

/* Where the starting point is known: the vertex that holds a rotation gets its meridian. */
void problem_aim(orb_problem *problem, const orb_point *position);

/* placed[n_copies]: where each copy is; turn[n_copies]: the phase of its frame against its vertex's. */
void problem_place(const orb_problem *problem, const orb_point *position, orb_point *placed, double complex *turn);

/* A tangent vector at copy u, whose frame is turned by `turn`, in the frame of its vertex. */
double complex problem_pull(const orb_problem *problem, int32_t u, double complex turn, double complex vector);

/* The energy; gradient[n_vertices] (zero where fixed, along the line where freedom is 1; may be NULL) and
 * *relative = max over vertices of |g_v| / sum_j w_vj d_vj, scale free; scale[n_vertices] is room for the sums. */
double problem_energy(const orb_problem *problem, const orb_point *placed, const double complex *turn,
                      const orb_point *position, double complex *gradient, double *scale, double *relative);

/* Sum over the edges of w (q - p) (q - p)', [m11, m12, m22], in the plane's usual coordinates. */
void problem_covariance(const orb_problem *problem, const orb_point *placed, double covariance[3]);

/* The direction that a vertex of freedom 1 may move in, and the point of its line that is nearest. */
double complex problem_direction(const orb_problem *problem, int32_t vertex, orb_point position);
orb_point problem_onto_line(const orb_problem *problem, int32_t vertex, orb_point position);

#endif
