/* weights.c. SPDX-License-Identifier: GPL-3.0-or-later */
#define weights_compute tested_weights_compute

#include <stdbool.h>
#include <stdlib.h>

static bool allocations_fail;

static void *failing_malloc(size_t size) { return allocations_fail ? NULL : malloc(size); }

static void *failing_calloc(size_t count, size_t size) { return allocations_fail ? NULL : calloc(count, size); }

#define malloc failing_malloc
#define calloc failing_calloc
#include "../../native/src/weights.c"
#undef malloc
#undef calloc

#include "check.h"
#include "meshes.h"

static const double PI = 3.14159265358979323846;

/* A mesh, its weights, and what was said of them. */
typedef struct weighted {
    sample_mesh sample;
    orb_mesh *mesh;
    double *weights;
    int64_t clamped;
    orb_status status;
    orb_error error;
} weighted;

static weighted weigh_as(sample_mesh sample, orb_request request) {
    weighted all = {.sample = sample};
    const orb_mesh_arrays arrays = sample_arrays(&all.sample);
    if (mesh_create(&arrays, &all.mesh, &all.error) != ORB_OK) {
        CHECK_FAILED("%s", all.error.message);
        abort();
    }
    all.weights = sample_allocate((size_t)all.mesh->n_edges, sizeof *all.weights);
    all.status = weights_compute(all.mesh, &request, NULL, all.weights, &all.clamped, &all.error);
    return all;
}

static weighted weigh(sample_mesh sample, orb_weights kind, double clamp) {
    const orb_request request = {.weights = kind, .clamp = clamp};
    return weigh_as(sample, request);
}

static void weighted_free(weighted *all) {
    free(all->weights);
    mesh_free(all->mesh);
    sample_free(&all->sample);
}

static double length_of(const weighted *all, int32_t e) {
    return mesh_edge_length(all->mesh, all->mesh->edge_halfedge[e]);
}

static void check_all(sample_mesh sample, orb_weights kind, double expected) {
    weighted all = weigh(sample, kind, 1e-9);
    CHECK(all.status == ORB_OK && all.clamped == 0);
    for (int32_t e = 0; e < all.mesh->n_edges; e++)
        CHECK_NEAR(all.weights[e], expected, 1e-14 * expected);
    weighted_free(&all);
}

TEST(deltahedra) {
    const double cot60 = 1 / sqrt(3), tan30 = 1 / sqrt(3);
    check_all(sample_tetrahedron(), ORB_WEIGHTS_COTANGENT, cot60);
    check_all(sample_octahedron(), ORB_WEIGHTS_COTANGENT, cot60);
    check_all(sample_icosahedron(), ORB_WEIGHTS_COTANGENT, cot60);
    check_all(sample_tetrahedron(), ORB_WEIGHTS_MEAN_VALUE, 2 * tan30 / sqrt(8));
    check_all(sample_octahedron(), ORB_WEIGHTS_MEAN_VALUE, 2 * tan30 / sqrt(2));
    check_all(sample_icosahedron(), ORB_WEIGHTS_MEAN_VALUE, 2 * tan30 / (4 / sqrt(10 + 2 * sqrt(5))));
    check_all(sample_cube(), ORB_WEIGHTS_UNIFORM, 1);
}

TEST(cube) {
    weighted cot = weigh(sample_cube(), ORB_WEIGHTS_COTANGENT, 0.01);
    weighted mean = weigh(sample_cube(), ORB_WEIGHTS_MEAN_VALUE, 0);
    CHECK(cot.status == ORB_OK && mean.status == ORB_OK);
    CHECK(cot.clamped == 6 && mean.clamped == 0); /* the diagonals: cot 90 degrees, once for each edge */
    for (int32_t e = 0; e < 18; e++) {
        const bool diagonal = length_of(&cot, e) > 2.5;
        CHECK_NEAR(cot.weights[e], diagonal ? 0.01 : 1, 1e-15);
        if (diagonal)
            CHECK_NEAR(mean.weights[e], 2 * tan(PI / 8) / sqrt(8), 1e-15);
        /* other edges: 45 or 90 degrees at each end of each of the two triangles, by how the diagonals run */
        if (!diagonal)
            CHECK_NEAR(mean.weights[e], (tan(PI / 8) + 1) / 2, 1e-15);
    }
    weighted_free(&cot);
    weighted_free(&mean);
}

TEST(boundary_edges_have_one_triangle) {
    const double corners[] = {0, 0, 0, 3, 0, 0, 0, 4, 0};
    const int32_t one[] = {0, 1, 2};
    weighted cot = weigh(sample_from(3, corners, 1, one), ORB_WEIGHTS_COTANGENT, 0.01);
    weighted mean = weigh(sample_from(3, corners, 1, one), ORB_WEIGHTS_MEAN_VALUE, 0);
    REQUIRE(cot.mesh->n_edges == 3); /* 0-1, 0-2, 1-2: in this order */
    const double cot_expected[3] = {4.0 / 3 / 2, 3.0 / 4 / 2, 0.01}, half_0 = 1, half_1 = 0.5, half_2 = 1.0 / 3;
    const double mean_expected[3] = {(half_0 + half_1) / 2 / 3, (half_0 + half_2) / 2 / 4, (half_1 + half_2) / 2 / 5};
    for (int32_t e = 0; e < 3; e++) {
        CHECK_NEAR(cot.weights[e], cot_expected[e], 1e-15);
        CHECK_NEAR(mean.weights[e], mean_expected[e], 1e-15);
    }
    CHECK(cot.clamped == 1);
    weighted_free(&cot);
    weighted_free(&mean);
}

/* The mesh with its vertices moved in their plane, so that no two triangles are alike. */
static sample_mesh bent(sample_mesh mesh, double amount) {
    for (int32_t v = 0; v < mesh.n_vertices; v++) {
        double *p = mesh.vertices + 3 * (size_t)v;
        const double x = p[0], y = p[1];
        p[0] = x + amount * sin(7 * y + 3 * x);
        p[1] = y + amount * sin(5 * x - 2 * y);
        p[2] = 0.3 * p[0] - 0.7 * p[1] + 2; /* a plane that no axis is parallel to */
    }
    return mesh;
}

/* The largest coordinate of sum_j w_ij (p_j - p_i) over inner vertices, against the largest term. */
static double linear_defect(const weighted *all) {
    const orb_mesh *mesh = all->mesh;
    double *sum = sample_allocate(3 * (size_t)mesh->n_vertices, sizeof *sum), worst = 0, largest = 0;
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        const int32_t h = mesh->edge_halfedge[e], a = halfedge_from(mesh, h), b = halfedge_to(mesh, h);
        for (int32_t k = 0; k < 3; k++) {
            const double term = all->weights[e] * (mesh->vertices[3 * b + k] - mesh->vertices[3 * a + k]);
            sum[3 * a + k] += term, sum[3 * b + k] -= term;
            largest = fmax(largest, fabs(term));
        }
    }
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        if (mesh->twin[mesh->vertex_halfedge[v]] >= 0)
            for (int32_t k = 0; k < 3; k++)
                worst = fmax(worst, fabs(sum[3 * v + k]));
    free(sum);
    return worst / largest;
}

TEST(cotangents_reproduce_linear_functions) {
    const double corners[] = {0, 0, 0, 8, 0, 0, 4, 8 * sqrt(0.75), 0}; /* bent: unequal triangles, all acute */
    const int32_t one[] = {0, 1, 2};
    sample_mesh coarse = sample_from(3, corners, 1, one), fine = sample_refined(&coarse, 8);
    sample_free(&coarse);
    weighted all = weigh(bent(fine, 0.04), ORB_WEIGHTS_COTANGENT, 1e-300);
    CHECK(all.status == ORB_OK && all.clamped == 0);
    CHECK_NEAR(linear_defect(&all), 0, 1e-13);
    weighted_free(&all);
}

/* w_ij as Floater writes it, one direction, from the angles themselves. */
static double one_way(const orb_mesh *mesh, int32_t from, int32_t h) {
    const int32_t a = halfedge_from(mesh, h) == from ? h : halfedge_next(h); /* the corner at `from` */
    const double *p = mesh->vertices + 3 * from, *q = mesh->vertices + 3 * halfedge_to(mesh, a),
                 *r = mesh->vertices + 3 * halfedge_from(mesh, halfedge_previous(a));
    double dot = 0;
    for (int k = 0; k < 3; k++)
        dot += (q[k] - p[k]) * (r[k] - p[k]);
    const double angle = acos(dot / mesh_edge_length(mesh, a) / mesh_edge_length(mesh, halfedge_previous(a)));
    return tan(angle / 2) / mesh_edge_length(mesh, h);
}

TEST(mean_values_against_the_angles) {
    weighted all = weigh(bent(sample_rectangle(2, 1, 6, 5), 0.05), ORB_WEIGHTS_MEAN_VALUE, 0);
    REQUIRE(all.status == ORB_OK);
    for (int32_t e = 0; e < all.mesh->n_edges; e++) {
        const int32_t h = all.mesh->edge_halfedge[e], g = all.mesh->twin[h];
        double expected = 0;
        for (int end = 0; end < 2; end++) {
            const int32_t vertex = end ? halfedge_to(all.mesh, h) : halfedge_from(all.mesh, h);
            expected += one_way(all.mesh, vertex, h) + (g < 0 ? 0 : one_way(all.mesh, vertex, g));
        }
        CHECK_NEAR(all.weights[e], expected / 2, 1e-12 * expected);
    }
    weighted_free(&all);
}

TEST(mean_values_reproduce_linear_functions_of_a_symmetric_mesh) {
    /* In a lattice w_ij = w_ji, and the symmetrised weights keep Floater's linear precision. */
    sample_mesh lattice = sample_rectangle(3, 1.7, 6, 6);
    for (int32_t v = 0; v < lattice.n_vertices; v++)
        lattice.vertices[3 * v] += 0.3 * lattice.vertices[3 * v + 1];
    weighted all = weigh(lattice, ORB_WEIGHTS_MEAN_VALUE, 0);
    REQUIRE(all.status == ORB_OK);
    int32_t tested = 0;
    for (int32_t v = 0; v < all.mesh->n_vertices; v++) { /* not beside the two corners where a diagonal is turned */
        const double x = all.sample.vertices[3 * v] - 0.3 * all.sample.vertices[3 * v + 1],
                     y = all.sample.vertices[3 * v + 1];
        if (x < 0.9 || x > 2.1 || y < 0.5 || y > 1.2)
            continue;
        double sum[3] = {0}, size = 0;
        int32_t h = all.mesh->vertex_halfedge[v];
        const int32_t start = h;
        do {
            for (int32_t k = 0; k < 3; k++) {
                const double to = all.mesh->vertices[3 * halfedge_to(all.mesh, h) + k];
                const double term = all.weights[all.mesh->edge[h]] * (to - all.mesh->vertices[3 * v + k]);
                sum[k] += term, size = fmax(size, fabs(term));
            }
            h = all.mesh->twin[halfedge_previous(h)];
        } while (h != start);
        for (int k = 0; k < 3; k++)
            CHECK_NEAR(sum[k] / size, 0, 1e-14);
        tested++;
    }
    CHECK(tested == 9);
    weighted_free(&all);
}

TEST(size_does_not_matter) {
    const double sizes[] = {1e-300, 1e-160, 1e-12, 1e12, 1e160, 1e300};
    for (int kind = ORB_WEIGHTS_COTANGENT; kind <= ORB_WEIGHTS_MEAN_VALUE; kind++) {
        weighted one = weigh(bent(sample_rectangle(2, 1, 5, 6), 0.05), (orb_weights)kind, 0.01);
        for (int s = 0; s < 6; s++) {
            sample_mesh sample = bent(sample_rectangle(2, 1, 5, 6), 0.05);
            sample_scale(&sample, sizes[s]);
            weighted other = weigh(sample, (orb_weights)kind, 0.01);
            CHECK(other.status == ORB_OK && other.clamped == one.clamped);
            const double unit = kind == ORB_WEIGHTS_COTANGENT ? 1 : sizes[s]; /* mean values are 1 / length */
            for (int32_t e = 0; e < one.mesh->n_edges; e++)
                CHECK_NEAR(other.weights[e] * unit / one.weights[e], 1, 1e-11);
            weighted_free(&other);
        }
        weighted_free(&one);
    }
}

TEST(thin_triangles_keep_their_digits) {
    for (double thin = 1e-2; thin > 1e-12; thin *= 1e-2) {
        const double needle[] = {0, 0, 0, thin, 0, 0, 0, 1, 0}, cap[] = {-1, 0, 0, 1, 0, 0, 0, thin, 0};
        const int32_t one[] = {0, 1, 2};
        weighted all = weigh(sample_from(3, needle, 1, one), ORB_WEIGHTS_COTANGENT, 1e-30);
        CHECK(all.status == ORB_OK);
        CHECK_NEAR(all.weights[0] * thin, 0.5, 1e-15); /* faces the point of the needle */
        CHECK_NEAR(all.weights[1] / thin, 0.5, 1e-15); /* faces the angle that is nearly right */
        weighted_free(&all);
        all = weigh(sample_from(3, cap, 1, one), ORB_WEIGHTS_COTANGENT, 0.01);
        CHECK(all.status == ORB_OK && all.clamped == 1);
        CHECK(all.weights[0] == 0.01); /* faces the obtuse angle */
        CHECK_NEAR(all.weights[1] * thin, 0.5, 1e-15);
        weighted_free(&all);
        all = weigh(sample_from(3, cap, 1, one), ORB_WEIGHTS_MEAN_VALUE, 0);
        CHECK(all.status == ORB_OK);
        const double long_side = sqrt(1 + thin * thin), sharp = thin / (long_side + 1);
        CHECK_NEAR(all.weights[0] / (sharp / 2), 1, 1e-14);
        CHECK_NEAR(all.weights[1] * 2 * long_side / (sharp + 1 / thin), 1, 1e-14); /* pi - 2 atan(thin) */
        weighted_free(&all);
    }
}

TEST(thin_triangles_in_any_direction) {
    const double a[3] = {2.0 / 7, 3.0 / 7, 6.0 / 7}, b[3] = {3.0 / 7, -6.0 / 7, 2.0 / 7}; /* at right angles */
    for (double thin = 1e-2; thin > 1e-12; thin *= 1e-2) {
        for (int turn = 0; turn < 3; turn++) {
            sample_mesh needle = sample_new(3, 1);
            for (int c = 0; c < 3; c++)
                needle.triangles[c] = (c + turn) % 3;
            for (int k = 0; k < 3; k++)
                needle.vertices[3 + k] = thin * a[k], needle.vertices[6 + k] = b[k];
            weighted all = weigh(needle, ORB_WEIGHTS_COTANGENT, 1e-30);
            CHECK(all.status == ORB_OK);
            CHECK_NEAR(all.weights[0] * 2 * thin, 1, 2e-15);
            weighted_free(&all);
        }
    }
}

TEST(an_area_made_by_rounding_is_zero) {
    const int32_t one[] = {0, 1, 2};
    for (int i = 1; i < 200; i++) {
        double line[9] = {0};
        for (int k = 0; k < 3; k++) { /* the vertices at 0, 1 and 3 times a vector */
            line[3 + k] = sin(i + k);
            line[6 + k] = 3 * line[3 + k];
        }
        weighted all = weigh(sample_from(3, line, 1, one), ORB_WEIGHTS_COTANGENT, 0.01);
        CHECK(all.status == ORB_OK && all.clamped == 3);
        for (int e = 0; e < 3; e++)
            CHECK(all.weights[e] == 0.01);
        weighted_free(&all);
    }
}

/* Closed; vertices 0, 1, 2 of triangle 0 are on a line. */
static sample_mesh with_flat_triangle(void) {
    const double vertices[] = {0, 0, 0, 1, 0, 0, 2, 0, 0, 1, 1, 0, 1, -1, 0.5, 1, 0, 3};
    const int32_t triangles[] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 4, 0, 3, 5, 3, 2, 5, 2, 4, 5, 4, 0, 5};
    return sample_from(6, vertices, 8, triangles);
}

TEST(zero_area_takes_the_clamp) {
    weighted all = weigh(with_flat_triangle(), ORB_WEIGHTS_COTANGENT, 0.01);
    CHECK(all.status == ORB_OK);
    int64_t raised = 0;
    for (int32_t e = 0; e < all.mesh->n_edges; e++) {
        CHECK(all.weights[e] >= 0.01 && isfinite(all.weights[e]));
        const int32_t h = all.mesh->edge_halfedge[e], g = all.mesh->twin[h];
        if (h / 3 == 0 || g / 3 == 0) {
            const int32_t other = h / 3 == 0 ? g : h;
            double p[3], q[3], cross, dot = 0;
            const double *apex = all.mesh->vertices + 3 * halfedge_from(all.mesh, halfedge_previous(other));
            for (int k = 0; k < 3; k++) {
                p[k] = all.mesh->vertices[3 * halfedge_from(all.mesh, h) + k] - apex[k];
                q[k] = all.mesh->vertices[3 * halfedge_to(all.mesh, h) + k] - apex[k];
                dot += p[k] * q[k];
            }
            cross = 2 * mesh_triangle_area(all.mesh, other / 3);
            CHECK_NEAR(all.weights[e], fmax(0.01, 0.01 + 0.5 * dot / cross), 1e-15);
            raised++;
        }
    }
    CHECK(raised == 3 && all.clamped >= 3);
    weighted_free(&all);
}

TEST(zero_area_has_no_mean_values) {
    weighted all = weigh(with_flat_triangle(), ORB_WEIGHTS_MEAN_VALUE, 0);
    CHECK(all.status == ORB_ZERO_AREA_TRIANGLE && all.error.element == ORB_TRIANGLE);
    CHECK(all.error.n_found == 1 && all.error.n_elements == 1 && all.error.elements[0] == 0);
    weighted_free(&all);
}

TEST(a_mesh_in_one_point) {
    sample_mesh sample = sample_octahedron();
    sample_scale(&sample, 0);
    weighted all = weigh(sample, ORB_WEIGHTS_COTANGENT, 0.01);
    CHECK(all.status == ORB_OK && all.clamped == 12);
    for (int32_t e = 0; e < 12; e++)
        CHECK_NEAR(all.weights[e], 0.02, 1e-17);
    const orb_request mean = {.weights = ORB_WEIGHTS_MEAN_VALUE};
    CHECK(weights_compute(all.mesh, &mean, NULL, all.weights, NULL, &all.error) == ORB_ZERO_AREA_TRIANGLE);
    CHECK(all.error.n_found == 8 && all.error.elements[7] == 7);
    weighted_free(&all);
}

TEST(the_clamp_counts_edges) {
    for (double clamp = 0.001; clamp < 2; clamp *= 3) {
        weighted all = weigh(bent(sample_rectangle(1, 1, 8, 8), 0.03), ORB_WEIGHTS_COTANGENT, clamp);
        int64_t at_clamp = 0;
        for (int32_t e = 0; e < all.mesh->n_edges; e++)
            at_clamp += all.weights[e] == clamp;
        CHECK(all.status == ORB_OK && all.clamped == at_clamp && at_clamp > 0);
        weighted_free(&all);
    }
}

TEST(pillows_need_no_clamp_but_for_zeros) {
    const double angles[][2] = {{PI / 2, PI / 4}, {PI / 3, PI / 3}, {PI / 6, PI / 3}, {0.4, 2}};
    for (int i = 0; i < 5; i++) {
        weighted all =
            weigh(i == 4 ? sample_pillow_rectangle(2, 1, 6, 4) : sample_pillow_triangle(angles[i][0], angles[i][1], 5),
                  ORB_WEIGHTS_COTANGENT, 1e-13);
        CHECK(all.status == ORB_OK);
        for (int32_t e = 0; e < all.mesh->n_edges; e++)
            CHECK(all.weights[e] < 2e-13 || all.weights[e] > 0.05);
        /* a wrong sign would show as a sum that does not vanish; inside a copy the sums are those of a flat disk */
        double *sum = sample_allocate(2 * (size_t)all.mesh->n_vertices, sizeof *sum), worst = 0;
        for (int32_t h = 0; h < 3 * all.mesh->n_triangles / 2; h++) { /* the first copy's half-edges */
            const int32_t a = halfedge_from(all.mesh, h), b = halfedge_to(all.mesh, h);
            for (int32_t k = 0; k < 2; k++) {
                const double term =
                    all.weights[all.mesh->edge[h]] * (all.mesh->vertices[3 * b + k] - all.mesh->vertices[3 * a + k]);
                sum[2 * a + k] += term;
            }
        }
        for (int32_t v = 0; v < all.mesh->n_vertices; v++) {
            bool inner = true, used = false; /* all round in the first copy */
            int32_t h = all.mesh->vertex_halfedge[v];
            const int32_t start = h;
            do {
                inner = inner && h < 3 * all.mesh->n_triangles / 2;
                used = true;
                h = all.mesh->twin[halfedge_previous(h)];
            } while (h != start);
            if (inner && used)
                worst = fmax(worst, fmax(fabs(sum[2 * v]), fabs(sum[2 * v + 1])));
        }
        CHECK_NEAR(worst, 0, 1e-12);
        free(sum);
        weighted_free(&all);
    }
}

/* --- given weights ---------------------------------------------------------------------------------------------- */

enum { ROWS = 18 };

/* The cube's edges in another order, every second one backwards; the weight tells the edge. */
static void cube_rows(double rows[3 * ROWS]) {
    sample_mesh cube = sample_cube();
    const orb_mesh_arrays arrays = sample_arrays(&cube);
    orb_mesh *mesh = NULL;
    if (mesh_create(&arrays, &mesh, NULL) != ORB_OK)
        abort();
    for (int32_t e = 0; e < ROWS; e++) {
        const int32_t h = mesh->edge_halfedge[e], r = e * 7 % ROWS;
        rows[3 * r] = e % 2 ? halfedge_from(mesh, h) : halfedge_to(mesh, h);
        rows[3 * r + 1] = e % 2 ? halfedge_to(mesh, h) : halfedge_from(mesh, h);
        rows[3 * r + 2] = 0.5 + e;
    }
    mesh_free(mesh);
    sample_free(&cube);
}

static weighted weigh_given(const double *rows, int32_t n) {
    const orb_request request = {.weights = ORB_WEIGHTS_GIVEN, .n_edge_weights = n, .edge_weights = rows};
    return weigh_as(sample_cube(), request);
}

TEST(given_rows_in_any_sequence) {
    double rows[3 * ROWS];
    cube_rows(rows);
    weighted all = weigh_given(rows, ROWS);
    CHECK(all.status == ORB_OK && all.clamped == 0);
    for (int32_t e = 0; e < ROWS; e++)
        CHECK(all.weights[e] == 0.5 + e);
    weighted_free(&all);
}

static void check_rows(const double *rows, int32_t n, int64_t found, int32_t a, int32_t b) {
    weighted all = weigh_given(rows, n);
    CHECK(all.status == ORB_BAD_WEIGHT && all.error.status == ORB_BAD_WEIGHT);
    CHECK(all.error.element == (a < 0 ? ORB_NOTHING : ORB_EDGE) && all.error.n_found == found);
    CHECK(a < 0 || (all.error.elements[0] == a && all.error.elements[1] == b));
    CHECK(strchr(all.error.message, ':'));
    weighted_free(&all);
}

TEST(given_rows_that_are_wrong) {
    double rows[3 * ROWS + 6], good[3 * ROWS];
    cube_rows(good);
    const double bad[] = {0, -1, NAN, INFINITY};
    for (int i = 0; i < 4; i++) {
        memcpy(rows, good, sizeof good);
        rows[3 * 4 + 2] = bad[i];
        const int32_t a = (int32_t)fmin(rows[12], rows[13]), b = (int32_t)fmax(rows[12], rows[13]);
        check_rows(rows, ROWS, 1, a, b);
    }
    const double no_vertex[] = {-1, 8, 0.5, NAN, INFINITY, 1e300};
    for (int i = 0; i < 6; i++) {
        memcpy(rows, good, sizeof good);
        rows[3 * 2 + 1] = no_vertex[i];
        check_rows(rows, ROWS, 0, -1, -1);
    }
    memcpy(rows, good, sizeof good);
    rows[0] = 0, rows[1] = 7; /* a diagonal of space */
    check_rows(rows, ROWS, 1, 0, 7);
    rows[0] = rows[1] = 3; /* no edge at all */
    check_rows(rows, ROWS, 1, 3, 3);

    memcpy(rows, good, sizeof good); /* one edge twice, the other way round */
    rows[3 * ROWS] = rows[1], rows[3 * ROWS + 1] = rows[0], rows[3 * ROWS + 2] = 1;
    check_rows(rows, ROWS + 1, 1, (int32_t)fmin(rows[0], rows[1]), (int32_t)fmax(rows[0], rows[1]));
    memcpy(rows + 3 * ROWS + 3, rows, 3 * sizeof *rows); /* and a third time: still one edge */
    check_rows(rows, ROWS + 2, 1, (int32_t)fmin(rows[0], rows[1]), (int32_t)fmax(rows[0], rows[1]));

    check_rows(good + 3, ROWS - 1, 1, (int32_t)fmin(good[0], good[1]), (int32_t)fmax(good[0], good[1]));
    check_rows(good, 0, ROWS, 0, 1);
}

TEST(bad_requests) {
    const double clamps[] = {0, -0.01, NAN, INFINITY};
    for (int i = 0; i < 4; i++) {
        weighted all = weigh(sample_cube(), ORB_WEIGHTS_COTANGENT, clamps[i]);
        CHECK(all.status == ORB_BAD_ARGUMENT);
        weighted_free(&all);
    }
    weighted all = weigh(sample_cube(), (orb_weights)17, 0.01);
    CHECK(all.status == ORB_BAD_ARGUMENT);
    weighted_free(&all);
    all = weigh_given(NULL, 18);
    CHECK(all.status == ORB_BAD_ARGUMENT);
    weighted_free(&all);
}

TEST(failed_allocations_are_reported) {
    weighted all = weigh(sample_cube(), ORB_WEIGHTS_UNIFORM, 0.01);
    double rows[3 * ROWS];
    cube_rows(rows);
    const orb_request cot = {.weights = ORB_WEIGHTS_COTANGENT, .clamp = 0.01};
    const orb_request given = {.weights = ORB_WEIGHTS_GIVEN, .n_edge_weights = ROWS, .edge_weights = rows};
    allocations_fail = true;
    CHECK(weights_compute(all.mesh, &cot, NULL, all.weights, NULL, &all.error) == ORB_OUT_OF_MEMORY);
    CHECK(weights_compute(all.mesh, &given, NULL, all.weights, NULL, &all.error) == ORB_OUT_OF_MEMORY);
    allocations_fail = false;
    CHECK(weights_compute(all.mesh, &given, NULL, all.weights, NULL, &all.error) == ORB_OK);
    weighted_free(&all);
}
