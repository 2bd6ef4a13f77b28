/* CHOLMOD, wrapped. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * CHOLMOD comes twice, with indices of 32 and of 64 bits. The narrow one is faster (docs/decisions.md) and is tried
 * first; where it says that a problem is too large for its indices, the wide one takes over. */
#include "cholesky.h"

#include <cholmod.h>
#include <stdlib.h>
#include <string.h>

/* The two interfaces, under one set of signatures. */
typedef struct interface {
    int (*start)(cholmod_common *);
    int (*finish)(cholmod_common *);
    cholmod_sparse *(*allocate_sparse)(size_t, size_t, size_t, int, int, int, int, cholmod_common *);
    int (*free_sparse)(cholmod_sparse **, cholmod_common *);
    int (*free_dense)(cholmod_dense **, cholmod_common *);
    int (*free_factor)(cholmod_factor **, cholmod_common *);
    cholmod_dense *(*ensure_dense)(cholmod_dense **, size_t, size_t, size_t, int, cholmod_common *);
    int (*factorize)(cholmod_sparse *, cholmod_factor *, cholmod_common *);
    int (*solve2)(int, cholmod_factor *, cholmod_dense *, cholmod_sparse *, cholmod_dense **, cholmod_sparse **,
                  cholmod_dense **, cholmod_dense **, cholmod_common *);
    cholmod_factor *(*analyze)(cholmod_sparse *, void *, cholmod_common *);
    cholmod_factor *(*copy_factor)(cholmod_factor *, cholmod_common *);
    cholmod_sparse *(*copy_sparse)(cholmod_sparse *, cholmod_common *);
    int (*amd)(cholmod_sparse *, void *, cholmod_common *);
    int (*metis)(cholmod_sparse *, void *, cholmod_common *);
    size_t index_size;
} interface;

static cholmod_factor *analyze_narrow(cholmod_sparse *matrix, void *order, cholmod_common *common) {
    return cholmod_analyze_p(matrix, order, NULL, 0, common);
}
static cholmod_factor *analyze_wide(cholmod_sparse *matrix, void *order, cholmod_common *common) {
    return cholmod_l_analyze_p(matrix, order, NULL, 0, common);
}
static int amd_narrow(cholmod_sparse *matrix, void *order, cholmod_common *common) {
    return cholmod_amd(matrix, NULL, 0, order, common);
}
static int amd_wide(cholmod_sparse *matrix, void *order, cholmod_common *common) {
    return cholmod_l_amd(matrix, NULL, 0, order, common);
}
static int metis_narrow(cholmod_sparse *matrix, void *order, cholmod_common *common) {
    return cholmod_metis(matrix, NULL, 0, 1, order, common);
}
static int metis_wide(cholmod_sparse *matrix, void *order, cholmod_common *common) {
    return cholmod_l_metis(matrix, NULL, 0, 1, order, common);
}

static const interface interfaces[2] = {
    {cholmod_start, cholmod_finish, cholmod_allocate_sparse, cholmod_free_sparse, cholmod_free_dense,
     cholmod_free_factor, cholmod_ensure_dense, cholmod_factorize, cholmod_solve2, analyze_narrow, cholmod_copy_factor,
     cholmod_copy_sparse, amd_narrow, metis_narrow, sizeof(int32_t)},
    {cholmod_l_start, cholmod_l_finish, cholmod_l_allocate_sparse, cholmod_l_free_sparse, cholmod_l_free_dense,
     cholmod_l_free_factor, cholmod_l_ensure_dense, cholmod_l_factorize, cholmod_l_solve2, analyze_wide,
     cholmod_l_copy_factor, cholmod_l_copy_sparse, amd_wide, metis_wide, sizeof(SuiteSparse_long)},
};

struct orb_cholesky {
    const interface *call;
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

static void start(const interface *call, cholmod_common *common) {
    call->start(common);
    common->print = 0;
    common->try_catch = 1; /* no messages through an error handler: the status is looked at */
}

/* Index k of an array of the interface's integers. */
static void put(const interface *call, void *array, size_t k, int64_t value) {
    if (call->index_size == sizeof(int32_t))
        ((int32_t *)array)[k] = (int32_t)value;
    else
        ((SuiteSparse_long *)array)[k] = value;
}

static cholmod_sparse *copy_pattern(const interface *call, const orb_pattern *pattern, int xtype,
                                    cholmod_common *common) {
    size_t n = (size_t)pattern->n, entries = (size_t)pattern->column[n];
    cholmod_sparse *matrix = call->allocate_sparse(n, n, entries, 1, 1, -1, xtype, common);
    if (!matrix)
        return NULL;
    for (size_t j = 0; j <= n; j++)
        put(call, matrix->p, j, pattern->column[j]);
    for (size_t e = 0; e < entries; e++)
        put(call, matrix->i, e, pattern->row[e]);
    return matrix;
}

/* *too_large: the interface's indices do not suffice. */
static orb_status order_with(const interface *call, const orb_pattern *pattern, orb_ordering ordering,
                             int32_t *permutation, bool *too_large, orb_error *error) {
    cholmod_common common;
    start(call, &common);
    size_t n = (size_t)pattern->n;
    orb_status status = error_memory(error);
    void *order = malloc((n + 1) * call->index_size);
    cholmod_sparse *matrix = copy_pattern(call, pattern, CHOLMOD_PATTERN, &common);
    if (order && matrix) {
        int fine = (ordering == ORDERING_METIS ? call->metis : call->amd)(matrix, order, &common);
        status = fine && common.status >= 0 ? ORB_OK : translate(&common, error);
    }
    *too_large = common.status == CHOLMOD_TOO_LARGE;
    for (size_t k = 0; k < n && status == ORB_OK; k++)
        permutation[k] =
            call->index_size == sizeof(int32_t) ? ((int32_t *)order)[k] : (int32_t)((SuiteSparse_long *)order)[k];
    free(order);
    call->free_sparse(&matrix, &common);
    call->finish(&common);
    return status;
}

orb_status cholesky_order(const orb_pattern *pattern, orb_ordering ordering, int32_t *permutation, orb_error *error) {
    bool too_large = false;
    orb_status status = order_with(&interfaces[0], pattern, ordering, permutation, &too_large, error);
    return too_large ? order_with(&interfaces[1], pattern, ordering, permutation, &too_large, error) : status;
}

static orb_status analyze_with(const interface *call, const orb_pattern *pattern, const int32_t *permutation,
                               bool is_complex, orb_cholesky **result, bool *too_large, orb_error *error) {
    size_t n = (size_t)pattern->n;
    void *order = malloc((n + 1) * call->index_size);
    orb_cholesky *cholesky = calloc(1, sizeof *cholesky);
    orb_status status = error_memory(error);
    if (!cholesky) {
        free(order);
        return status;
    }
    cholmod_common *common = &cholesky->common;
    cholesky->call = call;
    cholesky->is_complex = is_complex;
    start(call, common);
    if (!order)
        goto done;
    common->supernodal = CHOLMOD_SUPERNODAL;
    common->nmethods = 1;
    common->method[0].ordering = CHOLMOD_GIVEN;
    common->postorder = 1;
    for (size_t k = 0; k < n; k++)
        put(call, order, k, permutation[k]);
    cholesky->matrix = copy_pattern(call, pattern, is_complex ? CHOLMOD_COMPLEX : CHOLMOD_REAL, common);
    if (cholesky->matrix)
        cholesky->factor = call->analyze(cholesky->matrix, order, common);
    *too_large = common->status == CHOLMOD_TOO_LARGE;
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

orb_status cholesky_analyze(const orb_pattern *pattern, const int32_t *permutation, bool is_complex,
                            orb_cholesky **result, orb_error *error) {
    bool too_large = false;
    *result = NULL;
    orb_status status = analyze_with(&interfaces[0], pattern, permutation, is_complex, result, &too_large, error);
    return too_large ? cholesky_analyze_wide(pattern, permutation, is_complex, result, error) : status;
}

orb_status cholesky_analyze_wide(const orb_pattern *pattern, const int32_t *permutation, bool is_complex,
                                 orb_cholesky **result, orb_error *error) {
    bool too_large = false;
    *result = NULL;
    return analyze_with(&interfaces[1], pattern, permutation, is_complex, result, &too_large, error);
}

orb_status cholesky_copy(const orb_cholesky *analysis, orb_cholesky **result, orb_error *error) {
    const interface *call = analysis->call;
    *result = NULL;
    orb_cholesky *cholesky = calloc(1, sizeof *cholesky);
    if (!cholesky)
        return error_memory(error);
    cholesky->call = call;
    cholesky->is_complex = analysis->is_complex;
    start(call, &cholesky->common);
    cholesky->common.supernodal = CHOLMOD_SUPERNODAL;
    cholesky->common.lnz = analysis->common.lnz;
    cholesky->matrix = call->copy_sparse(analysis->matrix, &cholesky->common);
    if (cholesky->matrix) /* each call sets the status anew */
        cholesky->factor = call->copy_factor(analysis->factor, &cholesky->common);
    if (!cholesky->matrix || !cholesky->factor) {
        orb_status status = translate(&cholesky->common, error);
        cholesky_free(cholesky);
        return status;
    }
    *result = cholesky;
    return ORB_OK;
}

orb_status cholesky_factor(orb_cholesky *cholesky, const double *values, bool *positive, orb_error *error) {
    cholmod_common *common = &cholesky->common;
    cholmod_sparse *matrix = cholesky->matrix;
    memcpy(matrix->x, values, matrix->nzmax * (cholesky->is_complex ? 2 : 1) * sizeof(double));
    *positive = false;
    cholesky->call->factorize(matrix, cholesky->factor, common);
    if (common->status == CHOLMOD_NOT_POSDEF)
        return ORB_OK;
    if (common->status != CHOLMOD_OK)
        return translate(common, error);
    *positive = true;
    return ORB_OK;
}

orb_status cholesky_solve(orb_cholesky *cholesky, const double *b, int32_t n_right, double *x, orb_error *error) {
    const interface *call = cholesky->call;
    cholmod_common *common = &cholesky->common;
    size_t n = cholesky->factor->n, columns = (size_t)n_right, parts = cholesky->is_complex ? 2 : 1;
    int xtype = cholesky->is_complex ? CHOLMOD_COMPLEX : CHOLMOD_REAL;
    cholmod_dense right = {.nrow = n,
                           .ncol = columns,
                           .nzmax = n * columns,
                           .d = n,
                           .x = (void *)(uintptr_t)b,
                           .xtype = xtype,
                           .dtype = CHOLMOD_DOUBLE};
    /* solve2 would make these itself, but forgets that the first failed when the second does not. */
    if (!call->ensure_dense(&cholesky->work_y, n, columns, n, xtype, common) ||
        !call->ensure_dense(&cholesky->work_e, columns, cholesky->factor->maxesize, columns, xtype, common) ||
        !call->solve2(CHOLMOD_A, cholesky->factor, &right, NULL, &cholesky->solution, NULL, &cholesky->work_y,
                      &cholesky->work_e, common))
        return translate(common, error);
    memcpy(x, cholesky->solution->x, n * columns * parts * sizeof(double));
    return ORB_OK;
}

int64_t cholesky_nonzeros(const orb_cholesky *cholesky) { return (int64_t)cholesky->common.lnz; }

void cholesky_free(orb_cholesky *cholesky) {
    if (!cholesky)
        return;
    cholmod_common *common = &cholesky->common;
    cholesky->call->free_dense(&cholesky->solution, common);
    cholesky->call->free_dense(&cholesky->work_y, common);
    cholesky->call->free_dense(&cholesky->work_e, common);
    cholesky->call->free_factor(&cholesky->factor, common);
    cholesky->call->free_sparse(&cholesky->matrix, common);
    cholesky->call->finish(common);
    free(cholesky);
}
