/* Several threads may use the library at once, each with its own objects: the factorisation, whose BLAS has buffers
 * that all threads share, gives each of them what it gives one alone. SPDX-License-Identifier: GPL-3.0-or-later */
#include "check.h"
#include "cholesky.h"

#include <pthread.h>
#include <stdlib.h>

enum { N = 64, THREADS = 4, ROUNDS = 20000 };

/* A full matrix, so that nearly all of the work is in BLAS. */
typedef struct problem {
    int64_t column[N + 1];
    int32_t row[N * (N + 1) / 2], permutation[N];
    double value[N * (N + 1) / 2], b[N], x[N];
    orb_cholesky *cholesky;
    int wrong;
    orb_status status;
} problem;

static void problem_fill(problem *p) {
    int64_t k = 0;
    for (int32_t j = 0; j < N; j++) {
        p->column[j] = k;
        p->permutation[j] = j;
        p->b[j] = cos(j);
        for (int32_t i = j; i < N; i++, k++) {
            p->row[k] = i;
            p->value[k] = i == j ? N : sin(12.9898 * i + 78.233 * j);
        }
    }
    p->column[N] = k;
}

static orb_status solve(orb_cholesky *cholesky, const problem *p, double *x) {
    bool positive = false;
    orb_status status = cholesky_factor(cholesky, p->value, &positive, NULL);
    if (status == ORB_OK)
        status = positive ? cholesky_solve(cholesky, p->b, 1, x, NULL) : ORB_LINEAR_SOLVER;
    return status;
}

static void *solve_again_and_again(void *user) {
    problem *p = user;
    for (int round = 0; round < ROUNDS && p->status == ORB_OK; round++) {
        double x[N];
        p->status = solve(p->cholesky, p, x);
        p->wrong += memcmp(x, p->x, sizeof x) != 0;
    }
    return NULL;
}

static orb_status solve_alone(problem *p) {
    problem_fill(p);
    orb_pattern pattern = {N, p->column, p->row};
    orb_status status = cholesky_analyze(&pattern, p->permutation, false, &p->cholesky, NULL);
    return status == ORB_OK ? solve(p->cholesky, p, p->x) : status;
}

TEST(threads_factorise_side_by_side) {
    problem *problems = calloc(THREADS, sizeof *problems);
    pthread_t threads[THREADS];
    int started = 0;
    REQUIRE(problems != NULL);
    for (int i = 0; i < THREADS; i++)
        problems[i].status = solve_alone(&problems[i]);
    while (started < THREADS && pthread_create(&threads[started], NULL, solve_again_and_again, &problems[started]) == 0)
        started++;
    for (int i = 0; i < started; i++)
        pthread_join(threads[i], NULL);
    CHECK(started == THREADS);
    for (int i = 0; i < started; i++) {
        CHECK(problems[i].status == ORB_OK);
        CHECK(problems[i].wrong == 0);
    }
    for (int i = 0; i < THREADS; i++)
        cholesky_free(problems[i].cholesky);
    free(problems);
}
