/* The quotient by the group, centring and mending. SPDX-License-Identifier: GPL-3.0-or-later */
#include <complex.h>
#include <stdlib.h>

#include "check.h"
#include "embedding.h"
#include "mend.h"
#include "meshes.h"
#include "quotient.h"
#include "random.h"
#include "tiles.h"
#include "whole_sphere.h"

static const double pi = 3.14159265358979323846;

static double complex complex_of(double x, double y) { return x + y * I; }

static const struct {
    int32_t k, orders[3];
} spheres[] = {
    {2, {2, 2}},    {2, {3, 3}},     {2, {5, 5}},     {2, {12, 12}},   {3, {2, 2, 2}}, {3, {2, 2, 3}}, {3, {2, 3, 2}},
    {3, {3, 2, 2}}, {3, {2, 2, 12}}, {3, {2, 12, 2}}, {3, {12, 2, 2}}, {3, {3, 3, 2}}, {3, {3, 2, 3}}, {3, {2, 3, 3}},
    {3, {4, 3, 2}}, {3, {4, 2, 3}},  {3, {3, 4, 2}},  {3, {3, 2, 4}},  {3, {2, 3, 4}}, {3, {2, 4, 3}}, {3, {5, 3, 2}},
    {3, {5, 2, 3}}, {3, {3, 5, 2}},  {3, {3, 2, 5}},  {3, {2, 3, 5}},  {3, {2, 5, 3}},
};
enum { N_SPHERES = sizeof spheres / sizeof *spheres };

static double complex value(orb_ratio f) { return f.zero / f.pole; }

/* The sine of half the angle between two values. */
static double apart(orb_ratio f, orb_ratio g) { return cabs(f.zero * g.pole - f.pole * g.zero); }

static orb_point random_point(random_state *state) {
    double x = 3 * random_unit(state) - 1.5;
    return point_of(complex_of(x, 3 * random_unit(state) - 1.5));
}

TEST(quotient_is_invariant) {
    for (int i = 0; i < N_SPHERES; i++) {
        orb_tile *tile = NULL;
        orb_quotient *quotient = NULL;
        orb_error error;
        random_state state = {1};
        REQUIRE(tile_of_cones(1, spheres[i].k, spheres[i].orders, &tile, &error) == ORB_OK);
        REQUIRE(quotient_create(tile, &quotient, &error) == ORB_OK);
        for (int n = 0; n < 200; n++) {
            orb_point p = random_point(&state);
            orb_ratio f = quotient_evaluate(quotient, p);
            CHECK_NEAR(cabs(f.zero) * cabs(f.zero) + cabs(f.pole) * cabs(f.pole), 1, 1e-12);
            CHECK_NEAR(cabs(f.zero - f.pole - f.one), 0, 1e-12);
            for (int32_t s = 0; s < tile->word->n_sides; s++) {
                orb_point q = isometry_apply(tile->geometry, tile->pairings[s], p);
                CHECK_NEAR(apart(f, quotient_evaluate(quotient, q)), 0, 1e-11);
            }
        }
        quotient_free(quotient);
        tile_free(tile);
    }
}

/* Degree: f takes each value once on the tile. Its winding along a small circle about a cone is the cone's order. */
static double winding(const orb_quotient *quotient, orb_point centre, int32_t form) {
    double turns = 0;
    double complex last = 0;
    for (int n = 0; n <= 400; n++) {
        orb_point p = {centre.z, centre.low + 1e-4 * cexp(2 * pi / 400 * n * I)};
        orb_ratio f = quotient_evaluate(quotient, p);
        double complex w = form == 0 ? f.zero / f.pole : form == 1 ? f.pole / f.zero : f.one / f.pole;
        if (n > 0)
            turns += carg(w / last) / (2 * pi);
        last = w;
    }
    return turns;
}

TEST(cones_go_to_zero_infinity_and_one) {
    for (int i = 0; i < N_SPHERES; i++) {
        orb_tile *tile = NULL;
        orb_quotient *quotient = NULL;
        orb_error error;
        REQUIRE(tile_of_cones(1, spheres[i].k, spheres[i].orders, &tile, &error) == ORB_OK);
        REQUIRE(quotient_create(tile, &quotient, &error) == ORB_OK);
        for (int32_t c = 0; c < tile->word->n_sides; c++) {
            int32_t cone = c < tile->word->n_nodes ? c : tile->word->n_sides - c;
            orb_ratio f = quotient_evaluate(quotient, tile->corners[c]);
            double complex small = cone == 0 ? f.zero : cone == 1 ? f.pole : f.one;
            CHECK(small == 0);
            CHECK_NEAR(winding(quotient, tile->corners[c], cone), spheres[i].orders[cone], 1e-9);
        }
        quotient_free(quotient);
        tile_free(tile);
    }
}

/* Near a cone, the small one of the three is c t^n (1 + O(t)): with its digits, far below the rounding of the rest. */
TEST(quotient_keeps_its_digits_near_the_cones) {
    for (int i = 0; i < N_SPHERES; i++) {
        orb_tile *tile = NULL;
        orb_quotient *quotient = NULL;
        orb_error error;
        REQUIRE(tile_of_cones(1, spheres[i].k, spheres[i].orders, &tile, &error) == ORB_OK);
        REQUIRE(quotient_create(tile, &quotient, &error) == ORB_OK);
        for (int32_t c = 0; c < tile->word->n_nodes; c++) {
            double complex step = 1e-12 * cexp(0.7 * I), small[2];
            for (int k = 0; k < 2; k++) {
                orb_point p = geometry_exp(tile->geometry, tile->corners[c], (k + 1) * step);
                orb_ratio f = quotient_evaluate(quotient, p);
                small[k] = c == 0 ? f.zero / f.pole : c == 1 ? f.pole / f.zero : f.one / f.pole;
            }
            CHECK_NEAR(cabs(small[1] / small[0] / pow(2, spheres[i].orders[c]) - 1), 0, 1e-10);
        }
        quotient_free(quotient);
        tile_free(tile);
    }
}

/* Two cones: f = z^N up to the position of the poles, which the tile has at 1 and -1. */
TEST(quotient_by_a_rotation_is_a_power) {
    for (int32_t order = 2; order < 3000; order = 3 * order + 1) {
        orb_tile *tile = NULL;
        orb_quotient *quotient = NULL;
        orb_error error;
        random_state state = {1};
        REQUIRE(tile_of_cones(1, 2, (int32_t[]){order, order}, &tile, &error) == ORB_OK);
        REQUIRE(quotient_create(tile, &quotient, &error) == ORB_OK);
        double complex z1 = tile->corners[0].z, z2 = tile->corners[1].z;
        double complex unit = value(quotient_evaluate(quotient, point_of(0))) / cpow((0 - z1) / (0 - z2), order);
        for (int n = 0; n < 100; n++) {
            double complex z = random_point(&state).z / order;
            double complex power = cpow((z - z1) / (z - z2), order);
            CHECK_NEAR(cabs(value(quotient_evaluate(quotient, point_of(z))) / (unit * power) - 1), 0, 1e-14 * order);
        }
        quotient_free(quotient);
        tile_free(tile);
    }
}

TEST(quotient_of_many_copies_does_not_overflow) {
    orb_tile *tile = NULL;
    orb_quotient *quotient = NULL;
    orb_error error;
    REQUIRE(tile_of_cones(1, 3, (int32_t[]){2, 3000, 2}, &tile, &error) == ORB_OK);
    REQUIRE(quotient_create(tile, &quotient, &error) == ORB_OK);
    orb_point p = point_of(1e-4 + 0.5e-3 * I);
    orb_ratio f = quotient_evaluate(quotient, p);
    CHECK_NEAR(cabs(f.zero - f.pole - f.one), 0, 1e-9);
    CHECK_NEAR(apart(f, quotient_evaluate(quotient, isometry_apply(tile->geometry, tile->pairings[1], p))), 0, 1e-9);
    f = quotient_evaluate(quotient, point_of(0.9 * I));
    CHECK(isfinite(cabs(f.zero)) && isfinite(cabs(f.one)) && cabs(f.pole) < 1e-9);
    quotient_free(quotient);
    tile_free(tile);
}

TEST(only_spherical_tiles_have_a_quotient) {
    orb_tile *tile = NULL;
    orb_quotient *quotient = NULL;
    orb_error error;
    REQUIRE(tile_of_cones(0, 3, (int32_t[]){3, 3, 3}, &tile, &error) == ORB_OK);
    CHECK(quotient_create(tile, &quotient, &error) == ORB_BAD_ARGUMENT && !quotient);
    tile_free(tile);
}

TEST(a_group_beyond_measure_is_refused_at_once) {
    orb_tile *tile = NULL;
    orb_quotient *quotient = NULL;
    orb_error error;
    REQUIRE(tile_of_cones(1, 3, (int32_t[]){1000000, 2, 2}, &tile, &error) == ORB_OK);
    CHECK(quotient_create(tile, &quotient, &error) == ORB_UNSUPPORTED_SIGNATURE && !quotient);
    tile_free(tile);
}

/* ------------------------------------------------------------------------------------------------------ centring */

static orb_ratio ratio_of(double complex zero, double complex pole) {
    double size = hypot(cabs(zero), cabs(pole));
    return (orb_ratio){zero / size, pole / size, (zero - pole) / size};
}

/* Points all over the sphere, squeezed towards f = `about` by the factor `squeeze`. */
static void random_cloud(int32_t n, double complex about, double squeeze, orb_ratio *values, double *weights) {
    random_state state = {2};
    for (int32_t v = 0; v < n; v++) {
        double r = sqrt(1 / (1e-6 + random_unit(&state)) - 1), angle = 2 * pi * random_unit(&state);
        values[v] = ratio_of(about + squeeze * r * cexp(I * angle), 1);
        weights[v] = random_unit(&state);
    }
}

static double mean_length(int32_t n, const double *weights, const double *x) {
    double mean[3] = {0}, total = 0;
    for (int32_t v = 0; v < n; v++) {
        total += weights[v];
        for (int k = 0; k < 3; k++)
            mean[k] += weights[v] * x[3 * v + k];
    }
    return sqrt(mean[0] * mean[0] + mean[1] * mean[1] + mean[2] * mean[2]) / total;
}

enum { CLOUD = 500 };

TEST(centring_brings_the_mean_to_the_centre) {
    static orb_ratio values[CLOUD];
    static double weights[CLOUD], x[3 * CLOUD];
    for (int i = 0; i < 12; i++) {
        random_cloud(CLOUD, 0.3 * i * cexp(0.5 * I * i), pow(10, -i / 2.0), values, weights);
        orb_moebius map;
        double left = whole_sphere_centre(CLOUD, values, weights, &map, x);
        CHECK(left < 1e-9);
        CHECK_NEAR(mean_length(CLOUD, weights, x), left, 1e-12);
        for (int v = 0; v < CLOUD; v++)
            CHECK_NEAR(x[3 * v] * x[3 * v] + x[3 * v + 1] * x[3 * v + 1] + x[3 * v + 2] * x[3 * v + 2], 1, 1e-12);
    }
}

/* The value of a point of the sphere: 0 is at (0, 0, 1). */
static orb_ratio ratio_of_point(const double x[3]) {
    return x[2] > 0 ? ratio_of(complex_of(x[0], x[1]), 1 + x[2]) : ratio_of(1 - x[2], complex_of(x[0], -x[1]));
}

static double complex cross_ratio(orb_ratio a, orb_ratio b, orb_ratio c, orb_ratio d) {
    double complex ac = a.zero * c.pole - a.pole * c.zero, bd = b.zero * d.pole - b.pole * d.zero;
    double complex ad = a.zero * d.pole - a.pole * d.zero, bc = b.zero * c.pole - b.pole * c.zero;
    return ac * bd / (ad * bc);
}

TEST(centring_is_a_moebius_map) {
    static orb_ratio values[CLOUD];
    static double weights[CLOUD], x[3 * CLOUD];
    random_cloud(CLOUD, 0.5, 0.1, values, weights);
    orb_moebius map;
    whole_sphere_centre(CLOUD, values, weights, &map, x);
    CHECK_NEAR(cabs(map.m[0][0] * map.m[1][1] - map.m[0][1] * map.m[1][0] - 1), 0, 1e-12);
    for (int v = 0; v + 3 < CLOUD; v++) {
        double complex before = cross_ratio(values[v], values[v + 1], values[v + 2], values[v + 3]);
        double complex after = cross_ratio(ratio_of_point(x + 3 * v), ratio_of_point(x + 3 * v + 3),
                                           ratio_of_point(x + 3 * v + 6), ratio_of_point(x + 3 * v + 9));
        CHECK_NEAR(cabs(after / before - 1), 0, 1e-9);
    }
}

/* Half of the weight on one point: there is no centre; the rest must come out finite and on the sphere all the same. */
TEST(centring_survives_a_heavy_point) {
    static orb_ratio values[CLOUD];
    static double weights[CLOUD], x[3 * CLOUD];
    random_cloud(CLOUD, 0, 1, values, weights);
    weights[7] = 10 * CLOUD;
    orb_moebius map;
    double left = whole_sphere_centre(CLOUD, values, weights, &map, x);
    CHECK(isfinite(left) && left > 0.5);
    for (int v = 0; v < CLOUD; v++)
        CHECK_NEAR(x[3 * v] * x[3 * v] + x[3 * v + 1] * x[3 * v + 1] + x[3 * v + 2] * x[3 * v + 2], 1, 1e-12);
}

/* Points within 1e-20 of each of the three cones' values, blown up: what was small keeps its digits. */
TEST(moebius_maps_keep_the_digits_near_the_cones) {
    double tiny = 1e-20, big = 1e10;
    orb_ratio near_zero = {tiny, 1, -1}, near_pole = {1, tiny, 1}, near_one = {sqrt(0.5), sqrt(0.5), tiny};
    double complex at = sqrt(0.5);
    orb_moebius at_zero = {{{1 / big, 0}, {0, big}}}, at_pole = {{{big, 0}, {0, 1 / big}}};
    orb_moebius at_one = {{{at / big, at / big}, {-at * big, at * big}}}; /* f - 1 over f + 1 */
    double x[3];
    whole_sphere_point(&at_zero, near_zero, x);
    CHECK_NEAR(x[0], 1, 1e-14); /* big^2 tiny = 1 */
    whole_sphere_point(&at_pole, near_pole, x);
    CHECK_NEAR(x[0], 1, 1e-14);
    whole_sphere_point(&at_one, near_one, x); /* (at tiny big) / (2 at^2 / big) */
    CHECK_NEAR(x[0] / (1 + x[2]), sqrt(0.5) * tiny * big * big, 1e-14);
}

/* ------------------------------------------------------------------------------------------------------- mending */

/* Triangles with det(p, q, r) <= 0, in long double, of the positions or of their float values. */
static int32_t count_flips(const sample_mesh *mesh, const double *x, bool as_float) {
    int32_t flips = 0;
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        long double d[3][3];
        for (int c = 0; c < 3; c++)
            for (int k = 0; k < 3; k++) {
                double value = x[3 * mesh->triangles[3 * t + c] + k];
                volatile float stored = (float)value;
                d[c][k] = as_float ? (long double)stored : (long double)value;
            }
        for (int c = 1; c < 3; c++)
            for (int k = 0; k < 3; k++)
                d[c][k] -= d[0][k];
        long double det = 0;
        for (int k = 0, l = 1, m = 2; k < 3; l = m, m = k, k++)
            det += d[0][k] * (d[1][l] * d[2][m] - d[1][m] * d[2][l]);
        flips += !(det > 0);
    }
    return flips;
}

static double *copy_positions(const sample_mesh *mesh) {
    double *x = malloc(3 * (size_t)mesh->n_vertices * sizeof *x);
    memcpy(x, mesh->vertices, 3 * (size_t)mesh->n_vertices * sizeof *x);
    return x;
}

static void normalise(double x[3]) {
    double size = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    for (int k = 0; k < 3; k++)
        x[k] /= size;
}

/* An icosphere, mapped to itself but for the cap within `angle` of the axis (0.3, 0.5, ...), where a point at angle a
 * goes to the angle angle * exp(rate (a / angle - 1)) (rate 0: stays), and every coordinate is off by up to noise. */
static double *squeezed_cap(const sample_mesh *mesh, double angle, double rate, double noise, int32_t every) {
    double axis[3] = {0.3, 0.5, 0.81}, *x = copy_positions(mesh);
    random_state state = {5};
    normalise(axis);
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        double *p = x + 3 * v, along = p[0] * axis[0] + p[1] * axis[1] + p[2] * axis[2], side[3], from = acos(along);
        if (from > angle || v % every)
            continue;
        double to = rate > 0 ? angle * exp(rate * (from / angle - 1)) : from;
        for (int k = 0; k < 3; k++)
            side[k] = p[k] - along * axis[k];
        normalise(side);
        for (int k = 0; k < 3; k++)
            p[k] = cos(to) * axis[k] + sin(to) * side[k] + noise * (2 * random_unit(&state) - 1);
        normalise(p);
    }
    return x;
}

static void check_mended(int level, double angle, double rate, double noise, int32_t every) {
    sample_mesh sphere = sample_icosphere(level);
    orb_mesh_arrays arrays = sample_arrays(&sphere);
    orb_mesh *mesh = NULL;
    orb_error error;
    REQUIRE(mesh_create(&arrays, &mesh, &error) == ORB_OK);
    double *x = squeezed_cap(&sphere, angle, rate, noise, every);
    int32_t before = count_flips(&sphere, x, false), before_float = count_flips(&sphere, x, true);
    int64_t mended = -1;
    CHECK(before_float > 0);
    CHECK(mend_sphere(mesh, x, &mended, &error) == ORB_OK);
    CHECK(mended >= before); /* what rounding leaves undecided counts as flipped */
    CHECK(count_flips(&sphere, x, false) == 0);
    CHECK(count_flips(&sphere, x, true) == 0);
    CHECK_NEAR(mend_degree(mesh, x), 1, 1e-9);
    free(x);
    mesh_free(mesh);
    sample_free(&sphere);
}

TEST(mending_single_vertices) { check_mended(4, 4, 0, 0.2, 20); }
TEST(mending_a_crumpled_patch) { check_mended(5, 0.5, 0, 1, 1); }
TEST(mending_a_limb_squeezed_below_float) { check_mended(5, 1.05, 20, 0, 1); }
TEST(mending_a_limb_squeezed_below_double) { check_mended(5, 1.05, 40, 0, 1); }
TEST(mending_a_patch_that_is_one_point) { check_mended(5, 0.6, 1e3, 0, 1); }

TEST(mending_leaves_what_is_good) {
    sample_mesh sphere = sample_icosphere(4);
    orb_mesh_arrays arrays = sample_arrays(&sphere);
    orb_mesh *mesh = NULL;
    orb_error error;
    REQUIRE(mesh_create(&arrays, &mesh, &error) == ORB_OK);
    double *x = squeezed_cap(&sphere, 0.2, 0, 0.3, 1);
    int64_t mended = -1;
    CHECK(count_flips(&sphere, x, false) > 0);
    CHECK(mend_sphere(mesh, x, &mended, &error) == ORB_OK && mended > 0);
    int32_t moved = 0;
    for (int32_t v = 0; v < sphere.n_vertices; v++)
        moved += memcmp(x + 3 * v, sphere.vertices + 3 * v, 3 * sizeof(double)) != 0;
    CHECK(moved < sphere.n_vertices / 8);
    memcpy(x, sphere.vertices, 3 * (size_t)sphere.n_vertices * sizeof *x);
    CHECK(mend_sphere(mesh, x, &mended, &error) == ORB_OK && mended == 0);
    CHECK(memcmp(x, sphere.vertices, 3 * (size_t)sphere.n_vertices * sizeof *x) == 0);
    free(x);
    mesh_free(mesh);
    sample_free(&sphere);
}

/* Every triangle positive, but twice around: z^2 on a double pyramid over a twelve-sided polygon. */
TEST(a_double_cover_is_refused) {
    sample_mesh sphere = sample_new(14, 24);
    sphere.vertices[3 * 12 + 2] = 1;
    sphere.vertices[3 * 13 + 2] = -1;
    for (int32_t i = 0; i < 12; i++) {
        int32_t two[6] = {i, (i + 1) % 12, 12, (i + 1) % 12, i, 13};
        sphere.vertices[3 * i] = cos(pi / 6 * i);
        sphere.vertices[3 * i + 1] = sin(pi / 6 * i);
        memcpy(sphere.triangles + 6 * i, two, sizeof two);
    }
    orb_mesh_arrays arrays = sample_arrays(&sphere);
    orb_mesh *mesh = NULL;
    orb_error error;
    REQUIRE(mesh_create(&arrays, &mesh, &error) == ORB_OK);
    double *x = copy_positions(&sphere);
    for (int32_t v = 0; v < sphere.n_vertices; v++) {
        double *p = x + 3 * v, turn = 2 * atan2(p[1], p[0]), radius = hypot(p[0], p[1]);
        p[0] = radius * cos(turn);
        p[1] = radius * sin(turn);
        normalise(p);
    }
    CHECK(count_flips(&sphere, x, false) == 0);
    CHECK_NEAR(mend_degree(mesh, x), 2, 1e-9);
    CHECK(mend_sphere(mesh, x, NULL, &error) == ORB_CERTIFICATE_FAILED);
    free(x);
    mesh_free(mesh);
    sample_free(&sphere);
}

/* ------------------------------------------------------------------------------------------------- the whole way */

static orb_status embed(const sample_mesh *mesh, const char *signature, int32_t n_cones, const int32_t *cones,
                        orb_embedding **embedding, orb_error *error) {
    orb_mesh_arrays arrays = sample_arrays(mesh);
    orb_request request = orb_request_default();
    request.signature = signature;
    request.n_cones = n_cones;
    request.cones = cones;
    request.weights = ORB_WEIGHTS_COTANGENT; /* whose rate of convergence is known */
    return orb_embed(&arrays, &request, embedding, error);
}

/* The Möbius map that takes the points y to the points x best: the least singular vector of the equations
 * x ^ M y = 0 on homogeneous coordinates (pole, zero), by inverse iteration on the 4 x 4 normal matrix. */
static orb_moebius fit_moebius(int32_t n, const double *y, const double *x) {
    double complex H[4][5], m[4] = {1, 0.1, 0.2, 1};
    for (int iteration = 0; iteration < 30; iteration++) {
        memset(H, 0, sizeof H);
        for (int32_t v = 0; v < n; v++) {
            orb_ratio a = ratio_of_point(x + 3 * v), b = ratio_of_point(y + 3 * v);
            double complex row[4] = {-a.zero * b.pole, -a.zero * b.zero, a.pole * b.pole, a.pole * b.zero};
            for (int i = 0; i < 4; i++)
                for (int j = 0; j < 4; j++)
                    H[i][j] += conj(row[i]) * row[j] / n;
        }
        for (int i = 0; i < 4; i++) {
            H[i][i] += 1e-13;
            H[i][4] = m[i];
        }
        for (int i = 0; i < 4; i++)
            for (int r = 0; r < 4; r++)
                for (int j = 4; r != i && j >= i; j--)
                    H[r][j] -= H[r][i] / H[i][i] * H[i][j];
        double size = 0;
        for (int i = 0; i < 4; i++) {
            m[i] = H[i][4] / H[i][i];
            size += creal(m[i] * conj(m[i]));
        }
        for (int i = 0; i < 4; i++)
            m[i] /= sqrt(size);
    }
    return (orb_moebius){{{m[0], m[1]}, {m[2], m[3]}}};
}

/* Root mean square distance of the points of the mesh, a sphere, after the best Möbius map from x. */
static double distance_from_moebius(const sample_mesh *sphere, const double *x) {
    orb_moebius map = fit_moebius(sphere->n_vertices, sphere->vertices, x);
    double sum = 0;
    for (int32_t v = 0; v < sphere->n_vertices; v++) {
        double p[3];
        whole_sphere_point(&map, ratio_of_point(sphere->vertices + 3 * v), p);
        for (int k = 0; k < 3; k++)
            sum += (p[k] - x[3 * v + k]) * (p[k] - x[3 * v + k]);
    }
    return sqrt(sum / sphere->n_vertices);
}

static double whole_sphere_error(const char *signature, int32_t n_cones, int level) {
    static const int32_t cones[3] = {0, 5, 8}; /* of the icosahedron's vertices, which every level keeps */
    sample_mesh sphere = sample_icosphere(level);
    orb_embedding *embedding = NULL;
    orb_error error = {0};
    double *x = malloc(3 * (size_t)sphere.n_vertices * sizeof *x), result = NAN;
    int64_t mended = -1;
    if (embed(&sphere, signature, n_cones, cones, &embedding, &error) == ORB_OK &&
        orb_whole_sphere(embedding, x, &mended, &error) == ORB_OK && count_flips(&sphere, x, true) == 0)
        result = distance_from_moebius(&sphere, x);
    else
        printf("     %s on level %d: %s\n", signature, level, error.message);
    orb_embedding_free(embedding);
    free(x);
    sample_free(&sphere);
    return result;
}

/* A conformal map of the sphere to itself is a Möbius map, and that is what embedding and quotient tend to as the
 * edges get shorter. Linear elements cannot follow r^(1/n) at a cone: with n the highest order, the energy, and with
 * it the map, is off by the power 2 / n of the edge length. */
TEST(whole_spheres_tend_to_moebius_maps) {
    static const struct {
        const char *signature;
        double order;
    } cases[] = {
        {"22", 2},  {"33", 3},  {"55", 5},  {"222", 2}, {"223", 3}, {"322", 3}, {"252", 5}, {"22(12)", 12}, {"332", 3},
        {"323", 3}, {"233", 3}, {"432", 4}, {"342", 4}, {"234", 4}, {"532", 5}, {"253", 5}, {"325", 5},
    };
    printf("     rms distance from a Möbius map, icospheres of 162, 642, 2562, 10242 vertices\n");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        double gap[6];
        for (int level = 2; level <= 5; level++)
            gap[level] = whole_sphere_error(cases[i].signature, strlen(cases[i].signature) == 2 ? 2 : 3, level);
        printf("     %-7s %.5f %.5f %.5f %.5f\n", cases[i].signature, gap[2], gap[3], gap[4], gap[5]);
        for (int level = 2; level < 5; level++)
            CHECK(gap[level + 1] < gap[level]);
        CHECK(gap[5] / gap[2] < 1.5 * pow(2, -3 * 2 / cases[i].order));
    }
}

/* Solids with a handful of vertices, and a vertex that no triangle uses. */
TEST(coarse_solids_have_a_whole_sphere) {
    static const char *signatures[] = {"222", "235", "332", "432", "532"};
    for (int solid = 0; solid < 4; solid++)
        for (size_t i = 0; i < sizeof signatures / sizeof *signatures; i++) {
            sample_mesh mesh = solid == 0   ? sample_tetrahedron()
                               : solid == 1 ? sample_octahedron()
                               : solid == 2 ? sample_cube()
                                            : sample_icosahedron();
            mesh.vertices = realloc(mesh.vertices, 3 * (size_t)(++mesh.n_vertices) * sizeof(double));
            memset(mesh.vertices + 3 * (mesh.n_vertices - 1), 0, 3 * sizeof(double));
            orb_embedding *embedding = NULL;
            orb_error error = {0};
            double x[3 * 13];
            int64_t mended = -1;
            int32_t n = mesh.n_vertices - 1, cones[3] = {0, 1, 2};
            embed(&mesh, signatures[i], 3, cones, &embedding, &error);
            CHECK(embedding);
            if (!embedding) {
                printf("     solid %d, %s: %s\n", solid, signatures[i], error.message);
            } else {
                CHECK(orb_whole_sphere(embedding, x, &mended, &error) == ORB_OK);
                CHECK(count_flips(&mesh, x, true) == 0);
                CHECK(x[3 * n] == 0 && x[3 * n + 1] == 0 && x[3 * n + 2] == 0);
            }
            orb_embedding_free(embedding);
            sample_free(&mesh);
        }
}

TEST(whole_spheres_of_real_meshes) {
    static const char *names[] = {"spot.obj", "bunny.obj", "david.obj"}, *signatures[] = {"22(12)", "532", "44"};
    for (int i = 0; i < 3; i++) {
        sample_mesh mesh;
        if (!sample_read(&mesh, names[i]))
            SKIP("no ../shared/meshes");
        orb_embedding *embedding = NULL;
        orb_error error = {0};
        int64_t mended = -1;
        double *x = malloc(3 * (size_t)mesh.n_vertices * sizeof *x);
        int32_t cones[3] = {100, 1000, 2000};
        if (embed(&mesh, signatures[i], i == 2 ? 2 : 3, cones, &embedding, &error) != ORB_OK) {
            printf("     %s, %s: %s\n", names[i], signatures[i], error.message);
            CHECK(error.status == ORB_OK);
        } else {
            CHECK(orb_whole_sphere(embedding, x, &mended, &error) == ORB_OK);
            CHECK(count_flips(&mesh, x, false) == 0);
            CHECK(count_flips(&mesh, x, true) == 0);
        }
        orb_embedding_free(embedding);
        free(x);
        sample_free(&mesh);
    }
}

TEST(a_plane_or_nothing_has_no_whole_sphere) {
    sample_mesh mesh = sample_icosahedron();
    orb_embedding *embedding = NULL;
    orb_error error = {0};
    double x[36];
    int32_t cones[3] = {0, 1, 2};
    REQUIRE(embed(&mesh, "333", 3, cones, &embedding, &error) == ORB_OK);
    CHECK(orb_whole_sphere(embedding, x, NULL, &error) == ORB_BAD_ARGUMENT);
    CHECK(orb_whole_sphere(embedding, NULL, NULL, &error) == ORB_BAD_ARGUMENT);
    CHECK(orb_whole_sphere(NULL, x, NULL, NULL) == ORB_BAD_ARGUMENT);
    orb_embedding_free(embedding);
    sample_free(&mesh);
}
