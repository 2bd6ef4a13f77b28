/* balance.c, lu.c, and mean-value weights of their two directions. SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>

#include "balance.h"
#include "check.h"
#include "embed.h"
#include "failing.h"
#include "lu.h"
#include "random.h"
#include "weights.h"

/* --- lu.c ------------------------------------------------------------------------------------------------------- */

TEST(a_matrix_that_is_not_symmetric) {
    /* entries that add up: [4 1 0; -2 3 0.5; 0 7 5] */
    int32_t row[] = {0, 0, 0, 1, 1, 1, 2, 2}, column[] = {0, 0, 1, 0, 1, 2, 1, 2};
    double value[] = {3, 1, 1, -2, 3, 0.5, 7, 5}, b[] = {6, 5.5, 29}, x[3]; /* x = 1, 2, 3 */
    const orb_entries entries = {8, row, column, value};
    orb_error error;
    CHECK(lu_solve(3, &entries, b, x, &error) == ORB_OK);
    for (int i = 0; i < 3; i++)
        CHECK_NEAR(x[i], i + 1, 1e-14);
    value[3] = -12, value[4] = 3, value[5] = 0, value[6] = 0; /* [4 1; -12 3]: still regular */
    CHECK(lu_solve(3, &entries, b, x, &error) == ORB_OK);
    value[4] = -3; /* twice the first row, but for its sign */
    CHECK(lu_solve(3, &entries, b, x, &error) == ORB_LINEAR_SOLVER);
    CHECK(error.status == ORB_LINEAR_SOLVER && strstr(error.message, "singular"));
    CHECK(lu_solve(0, &entries, b, x, &error) == ORB_OK);
}

TEST(a_large_random_system) {
    enum { N = 3000 };
    random_state state = {1};
    int32_t *row = malloc(6 * N * sizeof *row), *column = malloc(6 * N * sizeof *column);
    double *value = malloc(6 * N * sizeof *value), *b = calloc(N, sizeof *b), *x = malloc(N * sizeof *x), worst = 0;
    orb_entries entries = {0, row, column, value};
    for (int32_t k = 0; k < 6 * N; k++) { /* the first N: a diagonal that dominates */
        row[k] = k % N, column[k] = k < N ? k : random_below(&state, N);
        value[k] = k < N ? 10 : random_unit(&state);
        b[row[k]] += value[k] * (column[k] % 7 - 3);
        entries.n_entries++;
    }
    orb_error error;
    CHECK(lu_solve(N, &entries, b, x, &error) == ORB_OK);
    for (int32_t i = 0; i < N; i++)
        worst = fmax(worst, fabs(x[i] - (i % 7 - 3)));
    CHECK_NEAR(worst, 0, 1e-12);
    free(row), free(column), free(value), free(b), free(x);
}

/* --- a mesh in the plane ---------------------------------------------------------------------------------------- */

/* A mesh with copies and, for both ends of each edge, Floater's weights. */
typedef struct planar {
    orb_mesh *mesh;
    orb_copies copies;
    orb_isometry identity;
    int32_t *edges;
    double *weights;
    uint8_t *freedom;
    double complex *direction;
    orb_point *position;
} planar;

static planar planar_of(sample_mesh sample) {
    planar p = {.identity = isometry_identity()};
    const orb_mesh_arrays arrays = sample_arrays(&sample);
    orb_error error;
    if (mesh_create(&arrays, &p.mesh, NULL) != ORB_OK)
        abort();
    const size_t n = (size_t)p.mesh->n_vertices, edges = (size_t)p.mesh->n_edges;
    p.copies = (orb_copies){.n_copies = p.mesh->n_vertices, .n_isometries = 1};
    p.copies.vertex = sample_allocate(n, sizeof(int32_t));
    p.copies.isometry = sample_allocate(n, sizeof(int32_t));
    p.copies.isometries = &p.identity;
    p.edges = sample_allocate(2 * edges, sizeof(int32_t));
    p.weights = sample_allocate(2 * edges, sizeof(double));
    p.freedom = sample_allocate(n, 1);
    p.direction = sample_allocate(n, sizeof *p.direction);
    p.position = sample_allocate(n, sizeof *p.position);
    if (weights_mean_value_both(p.mesh, p.weights, &error) != ORB_OK) {
        CHECK_FAILED("%s", error.message);
        abort();
    }
    for (int32_t v = 0; v < p.mesh->n_vertices; v++) {
        p.copies.vertex[v] = v;
        p.freedom[v] = 2;
        p.position[v] = point_of(CMPLX(sample.vertices[3 * v], sample.vertices[3 * v + 1]));
    }
    for (int32_t e = 0; e < p.mesh->n_edges; e++) {
        p.edges[2 * e] = halfedge_from(p.mesh, p.mesh->edge_halfedge[e]);
        p.edges[2 * e + 1] = halfedge_to(p.mesh, p.mesh->edge_halfedge[e]);
    }
    sample_free(&sample);
    return p;
}

static orb_balance balance_of(const planar *p) {
    return (orb_balance){.geometry = geometry_of_curvature(0),
                         .copies = &p->copies,
                         .n_vertices = p->mesh->n_vertices,
                         .n_edges = p->mesh->n_edges,
                         .edges = p->edges,
                         .weights = p->weights,
                         .freedom = p->freedom,
                         .direction = p->direction};
}

static void planar_free(planar *p) {
    mesh_free(p->mesh);
    free(p->copies.vertex);
    free(p->copies.isometry);
    free(p->edges);
    free(p->weights);
    free(p->freedom);
    free(p->direction);
    free(p->position);
}

static sample_mesh bent_rectangle(void) {
    sample_mesh mesh = sample_rectangle(2, 1, 9, 7);
    for (int32_t v = 0; v < mesh.n_vertices; v++) { /* inner vertices move, and slide along the sides */
        double *p = mesh.vertices + 3 * (size_t)v;
        const double x = p[0], y = p[1];
        p[0] = x + 0.04 * sin(acos(-1) * x / 2) * cos(5 * y + 2 * x);
        p[1] = y + 0.04 * sin(acos(-1) * y) * sin(7 * x - 3 * y);
    }
    return mesh;
}

/* Mean-value coordinates reproduce linear functions exactly (Floater 2003, theorem 1): a flat mesh whose boundary is
 * held, or slides along its sides, comes back vertex for vertex. The symmetrised weights do not do that. */
static double come_back(bool slide, bool symmetrise) {
    planar p = planar_of(bent_rectangle());
    orb_point *before = sample_allocate((size_t)p.mesh->n_vertices, sizeof *before);
    memcpy(before, p.position, (size_t)p.mesh->n_vertices * sizeof *before);
    for (int32_t v = 0; v < p.mesh->n_vertices; v++) {
        const double x = creal(before[v].z), y = cimag(before[v].z);
        const bool upright = x < 1e-12 || x > 2 - 1e-12, level = y < 1e-12 || y > 1 - 1e-12;
        p.freedom[v] = (uint8_t)(upright && level ? 0 : upright || level ? slide : 2);
        p.direction[v] = upright ? CMPLX(0, -1) : 1;
        if (p.freedom[v] == 2)
            p.position[v] = point_of(0.3);
        if (p.freedom[v] == 1)
            p.position[v] = point_of(before[v].z + 0.1 * p.direction[v]);
    }
    for (int32_t e = 0; e < p.mesh->n_edges && symmetrise; e++)
        p.weights[2 * e] = p.weights[2 * e + 1] = (p.weights[2 * e] + p.weights[2 * e + 1]) / 2;
    const orb_balance balance = balance_of(&p);
    orb_error error;
    double relative = 1, worst = 0;
    CHECK(balance_solve(&balance, p.position, &relative, &error) == ORB_OK);
    CHECK(relative < 1e-12);
    for (int32_t v = 0; v < p.mesh->n_vertices; v++)
        worst = fmax(worst, cabs(p.position[v].z - before[v].z));
    free(before);
    planar_free(&p);
    return worst;
}

TEST(linear_precision) {
    CHECK_NEAR(come_back(false, false), 0, 1e-13);
    CHECK_NEAR(come_back(true, false), 0, 1e-13);
    CHECK(come_back(false, true) > 1e-3);
}

TEST(weights_of_both_directions) {
    planar p = planar_of(bent_rectangle());
    double *mean = sample_allocate((size_t)p.mesh->n_edges, sizeof *mean);
    const orb_request request = {.weights = ORB_WEIGHTS_MEAN_VALUE};
    orb_error error;
    CHECK(weights_compute(p.mesh, &request, NULL, mean, NULL, &error) == ORB_OK);
    int32_t differ = 0;
    for (int32_t e = 0; e < p.mesh->n_edges; e++) {
        CHECK_NEAR((p.weights[2 * e] + p.weights[2 * e + 1]) / 2 / mean[e], 1, 1e-14);
        differ += fabs(p.weights[2 * e] / p.weights[2 * e + 1] - 1) > 1e-2;
    }
    CHECK(differ > p.mesh->n_edges / 2);
    free(mean);
    planar_free(&p);
}

TEST(nothing_is_fixed) {
    planar p = planar_of(bent_rectangle());
    const orb_balance balance = balance_of(&p);
    orb_error error;
    const double complex kept = p.position[7].z;
    CHECK(balance_solve(&balance, p.position, NULL, &error) == ORB_BAD_ARGUMENT);
    CHECK(p.position[7].z == kept);
    planar_free(&p);
}

/* With symmetric weights the balance is the minimum of the energy. */
TEST(symmetric_weights_minimise) {
    const struct {
        const char *signature;
        int32_t k, cones[4];
    } cases[] = {{"442", 3, {0, 40, 90}}, {"632", 3, {7, 77, 150}}};
    for (int i = 0; i < 2; i++) {
        sample_mesh sample = sample_icosphere(2);
        orb_embedding *embedding = NULL;
        orb_error error;
        REQUIRE(embed(&sample, cases[i].signature, cases[i].k, cases[i].cones, 0.01, &embedding, &error) == ORB_OK);
        const orb_mesh *mesh = embedding->mesh;
        double *both = sample_allocate(2 * (size_t)mesh->n_edges, sizeof *both), worst = 0;
        int32_t *edges = sample_allocate(2 * (size_t)mesh->n_edges, sizeof *edges);
        uint8_t *freedom = sample_allocate((size_t)mesh->n_vertices, 1);
        for (int32_t e = 0; e < mesh->n_edges; e++) {
            const int32_t h = mesh->edge_halfedge[e];
            edges[2 * e] = embedding->copies->triangles[h];
            edges[2 * e + 1] = embedding->copies->triangles[halfedge_next(h)];
            both[2 * e] = both[2 * e + 1] = embedding->weights[e];
        }
        memset(freedom, 2, (size_t)mesh->n_vertices);
        for (int32_t k = 0; k < cases[i].k; k++)
            freedom[cases[i].cones[k]] = 0;
        const orb_balance balance = {.geometry = embedding->tile->geometry,
                                     .copies = embedding->copies,
                                     .n_vertices = mesh->n_vertices,
                                     .n_edges = mesh->n_edges,
                                     .edges = edges,
                                     .weights = both,
                                     .freedom = freedom};
        orb_point *position = sample_allocate((size_t)mesh->n_vertices, sizeof *position);
        for (int32_t v = 0; v < mesh->n_vertices; v++)
            position[v] = freedom[v] ? point_of(CMPLX(0.1, 0.2)) : embedding->position[v];
        CHECK(balance_solve(&balance, position, NULL, &error) == ORB_OK);
        for (int32_t v = 0; v < mesh->n_vertices; v++)
            worst = fmax(worst, cabs(position[v].z - embedding->position[v].z));
        CHECK_NEAR(worst, 0, 1e-12);
        free(position);
        free(both);
        free(edges);
        free(freedom);
        orb_embedding_free(embedding);
        sample_free(&sample);
    }
}

TEST(failed_allocations_are_reported) {
    planar p = planar_of(bent_rectangle());
    for (int32_t v = 0; v < 4; v++)
        p.freedom[v] = 0;
    const orb_balance balance = balance_of(&p);
    const orb_point kept = p.position[40];
    long reported = 0;
    for (long n = 0;; n++) {
        orb_error error;
        double relative;
        allocations = 0;
        failing = n;
        const orb_status status = balance_solve(&balance, p.position, &relative, &error);
        failing = -1;
        if (allocations <= n) {
            CHECK(status == ORB_OK);
            break;
        }
        CHECK(status == ORB_OK || status == ORB_OUT_OF_MEMORY);
        CHECK((status == ORB_OK) != (p.position[40].z == kept.z));
        p.position[40] = kept;
        reported += status == ORB_OUT_OF_MEMORY;
    }
    CHECK(reported > 15);
    planar_free(&p);
}
