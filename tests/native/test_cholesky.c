/* Factorisations against residuals. SPDX-License-Identifier: GPL-3.0-or-later */
#include <complex.h>
#include <stdlib.h>

#include "check.h"
#include "cholesky.h"
#include "random.h"

enum { N = 60, ENTRIES = N * (N + 1) / 2 };

typedef struct example {
    orb_pattern pattern;
    double complex values[ENTRIES]; /* diagonally dominant; real ones use the real parts */
    double complex right[2 * N];
    int32_t order[N];
} example;

static void fill(example *e) {
    random_state state = {3};
    int64_t filled = 0;
    e->pattern = (orb_pattern){N, malloc((N + 1) * sizeof(int64_t)), malloc(ENTRIES * sizeof(int32_t))};
    for (int32_t j = 0; j < N; j++) {
        e->pattern.column[j] = filled;
        for (int32_t i = j; i < N; i++)
            if (i == j || random_unit(&state) < 0.1) {
                e->values[filled] = i == j ? N : random_unit(&state) - 0.5 + I * (random_unit(&state) - 0.5);
                e->pattern.row[filled++] = i;
            }
    }
    e->pattern.column[N] = filled;
    for (int i = 0; i < 2 * N; i++)
        e->right[i] = random_unit(&state) + I * random_unit(&state);
}

static double residual(const example *e, const double complex *x, const double complex *b) {
    double complex product[N] = {0};
    double worst = 0;
    for (int32_t j = 0; j < N; j++)
        for (int64_t k = e->pattern.column[j]; k < e->pattern.column[j + 1]; k++) {
            int32_t i = e->pattern.row[k];
            product[i] += e->values[k] * x[j];
            if (i != j)
                product[j] += conj(e->values[k]) * x[i];
        }
    for (int i = 0; i < N; i++)
        worst = fmax(worst, cabs(product[i] - b[i]));
    return worst;
}

static void solve_each_way(bool is_complex, bool wide, orb_ordering ordering) {
    example e;
    orb_error error;
    orb_cholesky *cholesky = NULL;
    bool positive = false;
    fill(&e);
    double real_values[ENTRIES], real_right[2 * N];
    for (int64_t k = 0; k < e.pattern.column[N]; k++)
        real_values[k] = creal(e.values[k]);
    for (int i = 0; i < 2 * N; i++)
        real_right[i] = creal(e.right[i]);
    CHECK(cholesky_order(&e.pattern, ordering, e.order, &error) == ORB_OK);
    int32_t seen[N] = {0};
    for (int k = 0; k < N; k++)
        seen[e.order[k]]++;
    for (int k = 0; k < N; k++)
        CHECK(seen[k] == 1);
    CHECK((wide ? cholesky_analyze_wide : cholesky_analyze)(&e.pattern, e.order, is_complex, &cholesky, &error) ==
          ORB_OK);
    REQUIRE(cholesky != NULL);
    double complex x[2 * N], b[2 * N];
    for (int round = 0; round < 2; round++) { /* the second time with other values */
        CHECK(cholesky_factor(cholesky, is_complex ? (double *)e.values : real_values, &positive, &error) == ORB_OK);
        CHECK(positive);
        if (is_complex) {
            CHECK(cholesky_solve(cholesky, (double *)e.right, 2, (double *)x, &error) == ORB_OK);
        } else {
            double y[2 * N];
            CHECK(cholesky_solve(cholesky, real_right, 2, y, &error) == ORB_OK);
            for (int i = 0; i < 2 * N; i++)
                x[i] = y[i];
        }
        for (int64_t k = 0; !is_complex && k < e.pattern.column[N]; k++)
            e.values[k] = real_values[k];
        for (int i = 0; i < 2 * N; i++)
            b[i] = is_complex ? e.right[i] : real_right[i];
        CHECK_NEAR(residual(&e, x, b), 0, 1e-13);
        CHECK_NEAR(residual(&e, x + N, b + N), 0, 1e-13);
        for (int64_t k = 0; k < e.pattern.column[N]; k++) {
            e.values[k] *= 1.5;
            real_values[k] *= 1.5;
        }
    }
    CHECK(cholesky_nonzeros(cholesky) >= e.pattern.column[N]);
    real_values[e.pattern.column[N / 2]] = -1;
    e.values[e.pattern.column[N / 2]] = -1;
    CHECK(cholesky_factor(cholesky, is_complex ? (double *)e.values : real_values, &positive, &error) == ORB_OK);
    CHECK(!positive);
    cholesky_free(cholesky);
    pattern_clear(&e.pattern);
}

TEST(real_and_complex_narrow_and_wide_amd_and_metis) {
    for (int way = 0; way < 8; way++)
        solve_each_way(way & 1, way & 2, way & 4 ? ORDERING_METIS : ORDERING_AMD);
}
