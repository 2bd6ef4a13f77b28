/* Every vertex in the weighted mean of its neighbours. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * In the plane the weights need not be symmetric: with w_ij != w_ji there is no energy, but still one linear system,
 *
 *     sum over edges at i of w_ij (h_i^-1 h_j x_j - x_i) = 0        (Floater 2003; docs/mathematics.md, sections 2, 6)
 *
 * with a solution that is unique as soon as some vertex is fixed, and a bijection for the same reason as with an
 * energy (Floater 2003, One-to-one piecewise linear mappings over triangulations). */
#ifndef ORB_BALANCE_H
#define ORB_BALANCE_H

#include "holonomy.h"

typedef struct orb_balance {
    const orb_geometry *geometry; /* the plane */
    const orb_copies *copies;
    int32_t n_vertices, n_edges;
    const int32_t *edges;            /* [n_edges*2] copies */
    const double *weights;           /* [n_edges*2] for the vertex at an edge's first end, and at its second */
    const uint8_t *freedom;          /* [n_vertices] 2: free; 1: slides along `direction`; 0: fixed */
    const double complex *direction; /* [n_vertices] unit vectors; may be NULL where nothing slides */
} orb_balance;

/* position[n_vertices]: in, where fixed vertices are, and a point of each line that a vertex slides on; out, all of
 * them. On failure it is as it was. *relative (may be NULL): the largest force on a vertex that is left, against the
 * sum of the forces' sizes there. Errors: ORB_BAD_ARGUMENT if nothing is fixed; the linear solver's. */
orb_status balance_solve(const orb_balance *balance, orb_point *position, double *relative, orb_error *error);

#endif
