/* Sparse linear systems that are not symmetric. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The only door to UMFPACK. */
#ifndef ORB_LU_H
#define ORB_LU_H

#include "error.h"

/* Entries of a matrix in any sequence; those in the same place add up. */
typedef struct orb_entries {
    int32_t n_entries;
    int32_t *row, *column; /* [n_entries] */
    double *value;         /* [n_entries] */
} orb_entries;

/* Solves A x = b for the n x n matrix A of these entries; x[n] must not be b[n]. Meant for patterns that are nearly
 * symmetric. Errors: ORB_LINEAR_SOLVER if the matrix is singular, ORB_OUT_OF_MEMORY. */
orb_status lu_solve(int32_t n, const orb_entries *entries, const double *b, double *x, orb_error *error);

#endif
