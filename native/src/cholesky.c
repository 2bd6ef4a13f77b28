/* CHOLMOD, wrapped. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The int64 interface throughout: measured within noise of the int32 one, and it has no size at which it ends. */
#include "cholesky.h"

#include <cholmod.h>
#include <stdlib.h>
#include <string.h>

struct orb_cholesky {
    cholmod_common common;
    cholmod_sparse *matrix; /* the pattern, with room for values */
    cholmod_factor *factor;
    cholmod_dense *solution, *work_y, *work_e; /* kept between solves */
    bool is_complex;
};

static orb_status translate(const cholmod_common *common, orb_error *error) {
    if (common->status == CHOLMOD_OUT_OF_MEMORY || common->status == CHOLMOD_TOO_LARGE)
        return error_memory(error);
    return error_set(error, ORB_LINEAR_SOLVER, "CHOLMOD failed with status %d", common->status);
}

static void start(cholmod_common *common) {
    cholmod_l_start(common);
    common->print = 0;
    common->try_catch = 1; /* no messages through an error handler: the status is looked at */
}

static cholmod_sparse *copy_pattern(const orb_pattern *pattern, int xtype, cholmod_common *common) {
    size_t n = (size_t)pattern->n, entries = (size_t)pattern->column[n];
    cholmod_sparse *matrix = cholmod_l_allocate_sparse(n, n, entries, 1, 1, -1, xtype, common);
    if (!matrix)
        return NULL;
    SuiteSparse_long *column = matrix->p, *row = matrix->i;
    for (size_t j = 0; j <= n; j++)
        column[j] = pattern->column[j];
    for (size_t e = 0; e < entries; e++)
        row[e] = pattern->row[e];
    return matrix;
}

orb_status cholesky_order(const orb_pattern *pattern, orb_ordering ordering, int32_t *permutation, orb_error *error) {
    cholmod_common common;
    start(&common);
    size_t n = (size_t)pattern->n;
    orb_status status = ORB_OK;
    SuiteSparse_long *order = malloc((n + 1) * sizeof *order);
    cholmod_sparse *matrix = copy_pattern(pattern, CHOLMOD_PATTERN, &common);
    if (!order || !matrix) {
        status = error_memory(error);
        goto done;
    }
    int fine = ordering == ORDERING_METIS ? cholmod_l_metis(matrix, NULL, 0, 1, order, &common)
                                          : cholmod_l_amd(matrix, NULL, 0, order, &common);
    if (!fine || common.status < 0) {
        status = translate(&common, error);
        goto done;
    }
    for (size_t k = 0; k < n; k++)
        permutation[k] = (int32_t)order[k];
done:
    free(order);
    cholmod_l_free_sparse(&matrix, &common);
    cholmod_l_finish(&common);
    return status;
}

orb_status cholesky_analyze(const orb_pattern *pattern, const int32_t *permutation, bool is_complex,
                            orb_cholesky **result, orb_error *error) {
    *result = NULL;
    size_t n = (size_t)pattern->n;
    SuiteSparse_long *order = malloc((n + 1) * sizeof *order);
    orb_cholesky *cholesky = calloc(1, sizeof *cholesky);
    orb_status status = error_memory(error);
    if (!cholesky) {
        free(order);
        return status;
    }
    cholmod_common *common = &cholesky->common;
    start(common);
    if (!order)
        goto done;
    common->supernodal = CHOLMOD_SUPERNODAL;
    common->nmethods = 1;
    common->method[0].ordering = CHOLMOD_GIVEN;
    common->postorder = 1;
    cholesky->is_complex = is_complex;
    for (size_t k = 0; k < n; k++)
        order[k] = permutation[k];
    cholesky->matrix = copy_pattern(pattern, is_complex ? CHOLMOD_COMPLEX : CHOLMOD_REAL, common);
    if (cholesky->matrix)
        cholesky->factor = cholmod_l_analyze_p(cholesky->matrix, order, NULL, 0, common);
    if (!cholesky->factor || common->status < 0) {
        status = translate(common, error);
        goto done;
    }
    status = error_set(error, ORB_OK, "%s", "");
    *result = cholesky;
    cholesky = NULL;
done:
    free(order);
    cholesky_free(cholesky);
    return status;
}

orb_status cholesky_factor(orb_cholesky *cholesky, const double *values, bool *positive, orb_error *error) {
    cholmod_common *common = &cholesky->common;
    cholmod_sparse *matrix = cholesky->matrix;
    SuiteSparse_long entries = ((SuiteSparse_long *)matrix->p)[matrix->ncol];
    memcpy(matrix->x, values, (size_t)entries * (cholesky->is_complex ? 2 : 1) * sizeof(double));
    *positive = false;
    cholmod_l_factorize(matrix, cholesky->factor, common);
    if (common->status == CHOLMOD_NOT_POSDEF)
        return ORB_OK;
    if (common->status != CHOLMOD_OK)
        return translate(common, error);
    *positive = true;
    return ORB_OK;
}

orb_status cholesky_solve(orb_cholesky *cholesky, const double *b, int32_t n_right, double *x, orb_error *error) {
    cholmod_common *common = &cholesky->common;
    size_t n = cholesky->factor->n, parts = cholesky->is_complex ? 2 : 1;
    cholmod_dense right = {.nrow = n, .ncol = (size_t)n_right, .nzmax = n * (size_t)n_right, .d = n,
                           .x = (void *)(uintptr_t)b, .xtype = cholesky->is_complex ? CHOLMOD_COMPLEX : CHOLMOD_REAL,
                           .dtype = CHOLMOD_DOUBLE};
    int xtype = right.xtype;
    /* cholmod_l_solve2 would make these itself, but forgets that the first failed when the second does not. */
    if (!cholmod_l_ensure_dense(&cholesky->work_y, n, (size_t)n_right, n, xtype, common) ||
        !cholmod_l_ensure_dense(&cholesky->work_e, (size_t)n_right, cholesky->factor->maxesize, (size_t)n_right, xtype,
                                common))
        return translate(common, error);
    if (!cholmod_l_solve2(CHOLMOD_A, cholesky->factor, &right, NULL, &cholesky->solution, NULL, &cholesky->work_y,
                          &cholesky->work_e, common))
        return translate(common, error);
    memcpy(x, cholesky->solution->x, n * (size_t)n_right * parts * sizeof(double));
    return ORB_OK;
}

int64_t cholesky_nonzeros(const orb_cholesky *cholesky) { return (int64_t)cholesky->common.lnz; }

void cholesky_free(orb_cholesky *cholesky) {
    if (!cholesky)
        return;
    cholmod_common *common = &cholesky->common;
    cholmod_l_free_dense(&cholesky->solution, common);
    cholmod_l_free_dense(&cholesky->work_y, common);
    cholmod_l_free_dense(&cholesky->work_e, common);
    cholmod_l_free_factor(&cholesky->factor, common);
    cholmod_l_free_sparse(&cholesky->matrix, common);
    cholmod_l_finish(common);
    free(cholesky);
}
