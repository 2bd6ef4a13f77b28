/* The cotangent Laplacian of a mesh, factored. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_LAPLACIAN_H
#define ORB_LAPLACIAN_H

#include "cholesky.h"
#include "mesh.h"

typedef struct orb_laplacian {
    const orb_mesh *mesh;
    orb_pattern pattern;
    int64_t *slot;  /* [n_edges] an edge's entry in the pattern */
    double *values; /* [entries of the pattern] */
    orb_cholesky *cholesky;
    int32_t pinned; /* the vertex whose value is zero; -1: none has to be */
} orb_laplacian;

/* Orders and analyses the pattern. The mesh, in one piece, must live as long. */
orb_status laplacian_create(const orb_mesh *mesh, orb_laplacian **laplacian, orb_error *error);
void laplacian_free(orb_laplacian *laplacian);

/* The Laplacian of `cotangent` [n_triangles*3] (shape.h) plus shift * area[n_vertices] on the diagonal. Without a shift
 * it is singular, the constant functions being its kernel: one vertex's row and column become those of the identity,
 * which is exact. Isolated vertices have rows of the identity. *positive: false if it cannot be factored. */
orb_status laplacian_factor(orb_laplacian *laplacian, const double *cotangent, const double *area, double shift,
                            bool *positive, orb_error *error);

/* right[n_right*n_vertices] is replaced by the solutions. Without a shift each right-hand side must sum to zero, and
 * solutions are determined up to a constant. */
orb_status laplacian_solve(orb_laplacian *laplacian, double *right, int32_t n_right, orb_error *error);

#endif
