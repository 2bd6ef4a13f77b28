/* UMFPACK, wrapped. SPDX-License-Identifier: GPL-3.0-or-later */
#include "lu.h"

#include <stdlib.h>
#include <umfpack.h>

static orb_status translate(int status, orb_error *error) {
    if (status == UMFPACK_OK)
        return error_set(error, ORB_OK, "%s", "");
    if (status == UMFPACK_ERROR_out_of_memory)
        return error_memory(error);
    if (status == UMFPACK_WARNING_singular_matrix)
        return error_set(error, ORB_LINEAR_SOLVER, "the matrix of the linear system is singular");
    return error_set(error, ORB_LINEAR_SOLVER, "UMFPACK failed with status %d", status);
}

/* Factors and solves a matrix by columns. */
static int factor_and_solve(int32_t n, const int32_t *column, const int32_t *row, const double *value, const double *b,
                            double *x) {
    double control[UMFPACK_CONTROL];
    void *symbolic = NULL, *numeric = NULL;
    umfpack_di_defaults(control);
    control[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_SYMMETRIC;
    control[UMFPACK_ORDERING] = UMFPACK_ORDERING_AMD;
    int status = umfpack_di_symbolic(n, n, column, row, value, &symbolic, control, NULL);
    if (status == UMFPACK_OK)
        status = umfpack_di_numeric(column, row, value, symbolic, &numeric, control, NULL);
    if (status == UMFPACK_OK)
        status = umfpack_di_solve(UMFPACK_A, column, row, value, x, b, numeric, control, NULL);
    umfpack_di_free_symbolic(&symbolic);
    umfpack_di_free_numeric(&numeric);
    return status;
}

orb_status lu_solve(int32_t n, const orb_entries *entries, const double *b, double *x, orb_error *error) {
    if (n == 0)
        return error_set(error, ORB_OK, "%s", "");
    const size_t room = (size_t)entries->n_entries + 1;
    int32_t *column = malloc(((size_t)n + 1) * sizeof *column), *row = malloc(room * sizeof *row);
    double *value = malloc(room * sizeof *value);
    int status = UMFPACK_ERROR_out_of_memory;
    if (column && row && value)
        status = umfpack_di_triplet_to_col(n, n, entries->n_entries, entries->row, entries->column, entries->value,
                                           column, row, value, NULL);
    if (status == UMFPACK_OK)
        status = factor_and_solve(n, column, row, value, b, x);
    free(column);
    free(row);
    free(value);
    return translate(status, error);
}
