/* Sparse Cholesky factorisation, real symmetric or complex Hermitian. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The only door to CHOLMOD. Analyse a pattern (the lower triangle) once, factor it with many values, solve many
 * times. */
#ifndef ORB_CHOLESKY_H
#define ORB_CHOLESKY_H

#include "pattern.h"

typedef enum orb_ordering { ORDERING_AMD, ORDERING_METIS } orb_ordering;

typedef struct orb_cholesky orb_cholesky;

/* A fill-reducing ordering of the pattern: permutation[n], permutation[k] is the row that comes k-th. */
orb_status cholesky_order(const orb_pattern *pattern, orb_ordering ordering, int32_t *permutation, orb_error *error);

/* Symbolic analysis with a given ordering (the pattern is only read during the call). Values are real doubles, or,
 * for `is_complex`, double complex. */
orb_status cholesky_analyze(const orb_pattern *pattern, const int32_t *permutation, bool is_complex,
                            orb_cholesky **cholesky, orb_error *error);

/* The same with indices of 64 bits from the start, which cholesky_analyze turns to by itself where it has to. */
orb_status cholesky_analyze_wide(const orb_pattern *pattern, const int32_t *permutation, bool is_complex,
                                 orb_cholesky **cholesky, orb_error *error);

/* Another one with the same analysis, to be factored by itself. */
orb_status cholesky_copy(const orb_cholesky *analysis, orb_cholesky **cholesky, orb_error *error);

/* Numerical factorisation of values[column[n]] (complex: interleaved, twice as many doubles). A matrix that is not
 * positive definite is no error: *positive says so, and the factor cannot be used. */
orb_status cholesky_factor(orb_cholesky *cholesky, const double *values, bool *positive, orb_error *error);

/* Solves for n_right right-hand sides, each n long (complex: interleaved), column after column. x may be b. */
orb_status cholesky_solve(orb_cholesky *cholesky, const double *b, int32_t n_right, double *x, orb_error *error);

int64_t cholesky_nonzeros(const orb_cholesky *cholesky);
void cholesky_free(orb_cholesky *cholesky);

#endif
