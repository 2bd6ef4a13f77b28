/* metric.c, shape.c, laplacian.c and sides.c. SPDX-License-Identifier: GPL-3.0-or-later */
#define metric_create tested_metric_create
#define metric_free tested_metric_free

#include <stdbool.h>
#include <stdlib.h>

static long allocations, failing = -1;

static void *counted_malloc(size_t size) { return allocations++ == failing ? NULL : malloc(size); }

static void *counted_calloc(size_t count, size_t size) { return allocations++ == failing ? NULL : calloc(count, size); }

#define malloc counted_malloc
#define calloc counted_calloc
#include "../../native/src/laplacian.c"
#include "../../native/src/metric.c"
#define pi pi_of_shape
#include "../../native/src/shape.c"
#undef pi
#include "sides.h"
#undef malloc
#undef calloc

#include "check.h"
#include "meshes.h"
#include "random.h"

/* A mesh, lengths for its edges, an angle for each vertex, and the metric made of them. */
typedef struct solved {
    orb_mesh *mesh;
    double *lengths, *angles;
    orb_metric *metric;
    orb_status status;
} solved;

static orb_mesh *mesh_of(sample_mesh sample) {
    orb_mesh *mesh = NULL;
    const orb_mesh_arrays arrays = sample_arrays(&sample);
    if (mesh_create(&arrays, &mesh, NULL) != ORB_OK)
        abort();
    sample_free(&sample);
    return mesh;
}

/* The angles that the mesh has are wanted, so that the metric is the mesh's own but for its curvature. */
static solved prepare(sample_mesh sample) {
    solved all = {.mesh = mesh_of(sample)};
    all.lengths = sample_allocate((size_t)all.mesh->n_edges, sizeof(double));
    all.angles = sample_allocate((size_t)all.mesh->n_vertices, sizeof(double));
    shape_lengths(all.mesh, all.lengths);
    return all;
}

/* Angles around the vertices by the cosine law, which shares nothing with sides.c. */
static void angles_of(const orb_mesh *mesh, const double *lengths, double *angles, double *area) {
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        angles[v] = area[v] = 0;
    for (int32_t t = 0; t < mesh->n_triangles; t++)
        for (int32_t c = 0; c < 3; c++) {
            const double a = lengths[mesh->edge[3 * t + c]], b = lengths[mesh->edge[3 * t + (c + 1) % 3]],
                         d = lengths[mesh->edge[3 * t + (c + 2) % 3]], cosine = (a * a + d * d - b * b) / (2 * a * d);
            angles[mesh->triangles[3 * t + c]] += acos(cosine);
            area[mesh->triangles[3 * t + c]] += a * d * sqrt(1 - cosine * cosine) / 6;
        }
}

static void want_own_angles(solved *all) {
    double *area = sample_allocate((size_t)all->mesh->n_vertices, sizeof *area);
    angles_of(all->mesh, all->lengths, all->angles, area);
    free(area);
}

static void want_cones(solved *all, int32_t k, const int32_t *cones, const int32_t *orders) {
    for (int32_t v = 0; v < all->mesh->n_vertices; v++)
        all->angles[v] = 2 * pi;
    for (int32_t h = 0; h < 3 * all->mesh->n_triangles; h++)
        if (all->mesh->twin[h] < 0)
            all->angles[halfedge_from(all->mesh, h)] = pi;
    for (int32_t i = 0; i < k; i++)
        all->angles[cones[i]] /= orders[i];
}

static double euler_of(const solved *all) {
    double sum = 0;
    for (int32_t v = 0; v < all->mesh->n_vertices; v++)
        sum += all->mesh->vertex_halfedge[v] < 0 ? 0 : all->angles[v];
    return sum / (2 * pi) - 0.5 * all->mesh->n_triangles;
}

static void solve(solved *all, double euler, int32_t steps) {
    orb_error error;
    all->status = metric_create(all->mesh, all->lengths, all->angles, euler, steps, &all->metric, &error);
}

static void solved_free(solved *all) {
    mesh_free(all->mesh);
    free(all->lengths);
    free(all->angles);
    metric_free(all->metric);
}

/* Shrinks the lengths by exp(-(u_i + u_j) / 2) for a random u of this size. */
static void disguise(solved *all, double *u, double size) {
    random_state state = {7};
    for (int32_t v = 0; v < all->mesh->n_vertices; v++)
        u[v] = size * (random_unit(&state) - 0.5);
    for (int32_t e = 0; e < all->mesh->n_edges; e++) {
        const int32_t h = all->mesh->edge_halfedge[e];
        all->lengths[e] *= exp(-0.5 * (u[halfedge_from(all->mesh, h)] + u[halfedge_to(all->mesh, h)]));
    }
}

/* Flat metrics are determined by their angles (Bobenko, Pinkall and Springborn 2015, theorem 3.1.1): a disguised one
 * is found again, up to a constant. */
static void find_again(sample_mesh sample, double size) {
    solved all = prepare(sample);
    double *u = sample_allocate((size_t)all.mesh->n_vertices, sizeof *u);
    want_own_angles(&all);
    CHECK_NEAR(euler_of(&all), 0, 1e-10);
    double *true_lengths = sample_allocate((size_t)all.mesh->n_edges, sizeof *u);
    memcpy(true_lengths, all.lengths, (size_t)all.mesh->n_edges * sizeof *u);
    disguise(&all, u, size);
    solve(&all, 0, 20);
    REQUIRE(all.status == ORB_OK);
    CHECK(all.metric->steps > 2 && all.metric->n_unscaled == 0);
    CHECK(all.metric->residual[0] > 0.1 && all.metric->residual[1] < 1e-11);
    const double shift = all.metric->scale[0] - u[0];
    double worst = 0, worst_length = 0;
    for (int32_t v = 0; v < all.mesh->n_vertices; v++)
        worst = fmax(worst, fabs(all.metric->scale[v] - u[v] - shift));
    for (int32_t e = 0; e < all.mesh->n_edges; e++)
        worst_length = fmax(worst_length, fabs(all.metric->lengths[e] / true_lengths[e] / exp(shift) - 1));
    CHECK_NEAR(worst, 0, 1e-9);
    CHECK_NEAR(worst_length, 0, 1e-9);
    free(true_lengths);
    free(u);
    solved_free(&all);
}

TEST(a_disguised_flat_metric_is_found_again) {
    find_again(sample_pillow_triangle(pi / 3, pi / 3, 6), 0.6);
    find_again(sample_pillow_rectangle(2, 1, 7, 5), 0.6);
    find_again(sample_triangle(pi / 2, pi / 4, 6), 0.6); /* a disk */
    find_again(sample_torus(24, 18, 3, 1), 0.5);         /* its own angles add up to what a flat torus has */
    find_again(sample_icosphere(2), 0.6);                /* curved by its vertices alone */
}

/* What is asked for is there: 2 pi chi a + (angles around) = angles wanted, at every vertex. */
static void check_equation(sample_mesh sample, int32_t k, const int32_t *cones, const int32_t *orders, double euler) {
    solved all = prepare(sample);
    const size_t n = (size_t)all.mesh->n_vertices;
    double *angles = sample_allocate(n, sizeof *angles), *area = sample_allocate(n, sizeof *area), total = 0;
    want_cones(&all, k, cones, orders);
    CHECK_NEAR(euler_of(&all), euler, 1e-10);
    solve(&all, euler, 60);
    REQUIRE(all.status == ORB_OK);
    CHECK(all.metric->n_unscaled == 0);
    angles_of(all.mesh, all.metric->lengths, angles, area);
    for (int32_t v = 0; v < all.mesh->n_vertices; v++)
        total += area[v];
    double worst = 0;
    for (int32_t v = 0; v < all.mesh->n_vertices; v++)
        worst = fmax(worst, fabs(2 * pi * euler * area[v] / total + angles[v] - all.angles[v]));
    CHECK_NEAR(worst, 0, 1e-9);
    for (int32_t e = 0; e < all.mesh->n_edges; e++) {
        const int32_t h = all.mesh->edge_halfedge[e];
        const double sum = all.metric->scale[halfedge_from(all.mesh, h)] + all.metric->scale[halfedge_to(all.mesh, h)];
        CHECK_NEAR(all.metric->lengths[e] / all.lengths[e] / exp(0.5 * sum), 1, 1e-13);
    }
    free(angles);
    free(area);
    solved_free(&all);
}

TEST(curvature_and_angles_are_those_wanted) {
    const int32_t cones[] = {0, 40, 90};
    check_equation(sample_icosphere(3), 3, cones, (int32_t[]){4, 4, 2}, 0);
    check_equation(sample_icosphere(3), 3, cones, (int32_t[]){4, 3, 2}, 2.0 / 24);
    check_equation(sample_icosphere(3), 3, cones, (int32_t[]){2, 3, 7}, -1.0 / 42);
    check_equation(sample_torus(20, 15, 3, 1), 0, NULL, NULL, 0);
    check_equation(sample_torus(20, 15, 3, 1), 2, cones, (int32_t[]){2, 3}, -7.0 / 6);
    check_equation(sample_rectangle(2, 1, 8, 8), 4, (int32_t[]){0, 1, 2, 3}, (int32_t[]){2, 2, 2, 2}, 0);
    check_equation(sample_triangle(1, 1, 6), 3, (int32_t[]){0, 1, 2}, (int32_t[]){2, 3, 7}, -1.0 / 84);
    check_equation(sample_triangle(1, 1, 6), 3, (int32_t[]){0, 1, 2}, (int32_t[]){2, 3, 4}, 1.0 / 24);
    check_equation(sample_triangle(1, 1, 6), 4, (int32_t[]){6, 0, 1, 2}, (int32_t[]){2, 3, 3, 3}, -0.5); /* 2*333 */
}

/* A disk's metric is that of its double, halved. */
TEST(a_disk_is_half_of_its_double) {
    sample_mesh disk = sample_triangle(1, 1.2, 6);
    for (int32_t v = 0; v < disk.n_vertices; v++)
        disk.vertices[3 * v + 2] = 0.3 * sin(3 * disk.vertices[3 * v]) * disk.vertices[3 * v + 1];
    const double eulers[] = {0, -1.0 / 84, 1.0 / 24};
    for (int i = 0; i < 3; i++) {
        const int32_t cones[] = {0, 1, 2}, orders[] = {2, 3, (int32_t[]){6, 7, 4}[i]};
        solved one = prepare(sample_from(disk.n_vertices, disk.vertices, disk.n_triangles, disk.triangles));
        solved two = prepare(sample_doubled(&disk));
        want_cones(&one, 3, cones, orders);
        want_cones(&two, 3, cones, orders);
        solve(&one, eulers[i], 40);
        solve(&two, 2 * eulers[i], 40);
        REQUIRE(one.status == ORB_OK && two.status == ORB_OK);
        const double shift = one.metric->scale[0] - two.metric->scale[0];
        double worst = 0, spread = 0;
        for (int32_t v = 0; v < one.mesh->n_vertices; v++) {
            worst = fmax(worst, fabs(one.metric->scale[v] - two.metric->scale[v] - shift));
            spread = fmax(spread, fabs(one.metric->scale[v]));
        }
        CHECK_NEAR(worst, 0, 1e-8);
        CHECK(spread > 0.5);
        solved_free(&one);
        solved_free(&two);
    }
    sample_free(&disk);
}

TEST(more_steps_come_nearer) {
    double before = INFINITY;
    for (int32_t steps = 0; steps < 4; steps++) {
        solved all = prepare(sample_icosphere(4));
        want_cones(&all, 3, (int32_t[]){0, 40, 90}, (int32_t[]){2, 3, 7});
        solve(&all, -1.0 / 42, steps);
        REQUIRE(all.status == ORB_OK);
        CHECK(all.metric->steps == steps + 1);
        CHECK(all.metric->residual[1] < 0.7 * before);
        before = all.metric->residual[1];
        solved_free(&all);
    }
}

TEST(any_size) {
    const double sizes[] = {1e-320, 1e-300, 1e-9, 1e9, 1e300};
    solved one = prepare(sample_rectangle(2, 1, 5, 6));
    for (int i = 0; i < 5; i++) {
        sample_mesh sample = sample_rectangle(2, 1, 5, 6);
        sample_scale(&sample, sizes[i]);
        solved other = prepare(sample);
        double longest = 0;
        for (int32_t e = 0; e < one.mesh->n_edges; e++) {
            longest = fmax(longest, other.lengths[e]);
            const double ratio = other.lengths[e] / one.lengths[e] * (one.lengths[0] / other.lengths[0]);
            CHECK_NEAR(ratio, 1, sizes[i] < 1e-310 ? 1e-2 : 1e-14); /* denormal numbers have few digits */
        }
        CHECK(longest >= 1 && longest < 2);
        solved_free(&other);
    }
    solved_free(&one);
}

TEST(flat_triangles_and_points) {
    const double vertices[] = {0, 0, 0, 1, 0, 0, 2, 0, 0, 1, 1, 0, 1, -1, 0.5, 1, 0, 3, 9, 9, 9};
    const int32_t triangles[] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 4, 0, 3, 5, 3, 2, 5, 2, 4, 5, 4, 0, 5};
    for (int scale = 0; scale < 2; scale++) { /* then all in one point */
        sample_mesh sample = sample_from(7, vertices, 8, triangles);
        sample_scale(&sample, 1 - scale);
        solved all = prepare(sample);
        want_cones(&all, 3, (int32_t[]){3, 4, 5}, (int32_t[]){4, 4, 2});
        solve(&all, 0, 2);
        CHECK(all.status == ORB_OK && all.metric->scale[6] == 0);
        CHECK(all.metric->n_unscaled == (scale ? 8 : 0)); /* the flat one has got an area */
        for (int32_t e = 0; e < all.mesh->n_edges; e++)
            CHECK(isfinite(all.metric->lengths[e]));
        solved_free(&all);
    }
}

TEST(sides) {
    double angle[3], cotangent[3];
    CHECK(sides_angles((double[]){3, 4, 5}, angle, cotangent));
    CHECK_NEAR(angle[0], atan2(3, 4), 1e-15);
    CHECK_NEAR(angle[1], atan2(4, 3), 1e-15);
    CHECK_NEAR(angle[2], pi / 2, 1e-15);
    CHECK_NEAR(cotangent[0], 4.0 / 3, 1e-15);
    CHECK_NEAR(cotangent[2], 0, 1e-15);
    for (double thin = 1e-1; thin > 1e-13; thin /= 10) { /* needles: cot = 1 / (2 thin) up to thin */
        CHECK(sides_angles((double[]){1, 1, thin}, angle, cotangent));
        CHECK_NEAR(angle[2] / (2 * asin(thin / 2)), 1, 1e-15);
        CHECK_NEAR(cotangent[2] * tan(2 * asin(thin / 2)), 1, 1e-14);
        CHECK_NEAR(cotangent[0] * 2 / thin, 1, 2 * thin * thin + 1e-14);
    }
    CHECK(!sides_angles((double[]){1, 2, 3}, angle, cotangent));
    CHECK(!sides_angles((double[]){5, 1, 3}, angle, cotangent));
    CHECK(!sides_angles((double[]){0, 0, 0}, angle, cotangent));
    CHECK(!sides_angles((double[]){0.1, 0.2, 0.1 + 0.2}, angle, cotangent));
}

TEST(failed_allocations_are_reported) {
    solved all = prepare(sample_icosphere(1));
    want_cones(&all, 3, (int32_t[]){0, 20, 30}, (int32_t[]){4, 4, 2});
    orb_error error;
    long reported = 0;
    for (long n = 0;; n++) {
        allocations = 0;
        failing = n;
        orb_metric *metric = (orb_metric *)&all;
        const orb_status status = metric_create(all.mesh, all.lengths, all.angles, 0, 2, &metric, &error);
        failing = -1;
        CHECK((status == ORB_OK) == (metric != NULL));
        CHECK(status == ORB_OK || status == ORB_OUT_OF_MEMORY);
        metric_free(metric);
        if (allocations <= n)
            break;
        reported += status == ORB_OUT_OF_MEMORY;
    }
    CHECK(reported >= 14);
    solved_free(&all);
}
