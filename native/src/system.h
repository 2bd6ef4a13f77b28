/* The Hessian of the energy as a sparse matrix. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Seen as a map of complex numbers, a 2 x 2 block is y -> alpha y + beta conj(y). Two matrices are assembled from the
 * same terms (docs/mathematics.md, section 3):
 *
 *   complex  alpha alone: the complex-linear part, Hermitian n x n. In the plane that is the whole Hessian; elsewhere
 *            beta is what is not conformal in the map, and averages out over a vertex's edges.
 *   real     the exact Hessian, one to two rows a vertex. */
#ifndef ORB_SYSTEM_H
#define ORB_SYSTEM_H

#include "cholesky.h"
#include "prepared.h"
#include "problem.h"

typedef enum orb_hessian {
    HESSIAN_EXACT,   /* C and S as they are */
    HESSIAN_POSITIVE /* both replaced by their mean: never indefinite */
} orb_hessian;

typedef struct orb_system {
    bool is_complex;
    int32_t n_free;               /* vertices that have rows: those that move */
    int32_t *free_vertex;         /* [n_free] */
    int32_t *free_index;          /* [n_vertices] -1: no row */
    orb_pattern blocks;           /* between moving vertices */
    int64_t *slot;                /* [n_edges] entry of `blocks` for the edge's mixed block; -1 if an end is fixed */
    int32_t *unknown;             /* [n_free+1] first row of each vertex; for complex systems the index itself */
    int64_t *first;               /* real: [2*entries] where in `values` each block's first and second column begin */
    orb_pattern pattern;          /* of the matrix itself; for complex systems that of the blocks (shared) */
    double complex *alpha, *beta; /* [entries of blocks] */
    double *values;               /* what cholesky_factor wants */
    const orb_cholesky *analysis; /* of the pattern, where it is known already (borrowed); else NULL */
} orb_system;

/* `prepared` (may be NULL): of the mesh whose edges are the problem's, in their sequence. A complex system then has its
 * pattern, in which a fixed vertex has a row to itself. */
orb_status system_create(const orb_problem *problem, bool is_complex, const orb_prepared *prepared, orb_system **system,
                         orb_error *error);
void system_free(orb_system *system);

/* A fill-reducing ordering of the vertices: order[n_free]. */
orb_status system_find_order(const orb_system *system, orb_ordering ordering, int32_t *order, orb_error *error);

/* An ordering of (at least) the vertices that have rows, spread over these: rows[unknown[n_free]]. */
void system_spread_order(const orb_system *system, int32_t n_order, const int32_t *order, int32_t *rows);

void system_assemble(orb_system *system, const orb_problem *problem, const orb_point *position, const orb_point *placed,
                     const double complex *turn, orb_hessian hessian);

/* Between complex numbers per vertex (n_vertices) and the rows of the system. */
void system_gather(const orb_system *system, const orb_problem *problem, const orb_point *position,
                   const double complex *vectors, double *rows);
void system_scatter(const orb_system *system, const orb_problem *problem, const orb_point *position, const double *rows,
                    double complex *vectors);

#endif
