/* Charts and lattices: closed forms, periods, orientation. SPDX-License-Identifier: GPL-3.0-or-later */
#include <complex.h>
#include <stdlib.h>

#include "check.h"
#include "embedding.h"
#include "lattice.h"
#include "layout.h"
#include "tiles.h"

static double uniform(unsigned *state) {
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) / 16777216.0;
}

static double complex complex_of(double x, double y) { return x + y * I; }

/* An embedding that has only what a layout reads: a tile and a strip of triangles with corners of their own. */
typedef struct sample {
    orb_embedding embedding;
    orb_mesh mesh;
    orb_copies copies;
    int32_t n;
    double *uv;
} sample;

static int sample_create(sample *s, int curvature, int32_t k, const int32_t *orders, int32_t n) {
    memset(s, 0, sizeof *s);
    orb_error error;
    if (tile_of_cones(curvature, k, orders, &s->embedding.tile, &error) != ORB_OK)
        return 0;
    s->n = n;
    s->mesh.n_triangles = n;
    s->copies.n_copies = 3 * n;
    s->copies.triangles = malloc((size_t)(3 * n) * sizeof(int32_t));
    s->embedding.placed = malloc((size_t)(3 * n) * sizeof(orb_point));
    s->uv = malloc((size_t)(6 * n) * sizeof(double));
    for (int32_t i = 0; i < 3 * n; i++)
        s->copies.triangles[i] = i;
    s->embedding.mesh = &s->mesh;
    s->embedding.copies = &s->copies;
    return 1;
}

static void sample_free(sample *s) {
    tile_free(s->embedding.tile);
    free(s->copies.triangles);
    free(s->embedding.placed);
    free(s->uv);
}

/* Small positive triangles within the disk of radius `radius` about 0. */
static void sample_disk(sample *s, double radius, double size) {
    unsigned state = 7;
    for (int32_t t = 0; t < s->n; t++) {
        double complex z = radius * sqrt(uniform(&state)) * cexp(6.283185307179586 * I * uniform(&state));
        double complex side = size * cexp(6.283185307179586 * I * uniform(&state));
        for (int c = 0; c < 3; c++)
            s->embedding.placed[3 * t + c] = point_of(z + side * cexp(2 * 3.141592653589793 / 3 * I * c));
    }
}

static const struct {
    int32_t k, orders[4];
} planes[] = {
    {3, {4, 4, 2}}, {3, {4, 2, 4}}, {3, {2, 4, 4}}, {3, {3, 3, 3}}, {3, {6, 3, 2}},    {3, {6, 2, 3}},
    {3, {3, 6, 2}}, {3, {3, 2, 6}}, {3, {2, 6, 3}}, {3, {2, 3, 6}}, {4, {2, 2, 2, 2}},
};
enum { N_PLANES = sizeof planes / sizeof *planes };

/* The area of the tile in the coordinate 2 z. */
static double double_area(const orb_tile *tile) {
    int32_t n = tile->word->n_sides;
    double sum = 0;
    for (int32_t i = 0; i < n; i++)
        sum += 2 * cimag(conj(tile->corners[i].z) * tile->corners[(i + 1) % n].z);
    return sum;
}

/* The tile's corners and pairings under z -> x + (shear + stretch i) y, which commutes with half turns. */
static void deform(orb_tile *tile, double shear, double stretch) {
    int32_t n = tile->word->n_sides;
    for (int32_t i = 0; i < n; i++) {
        double complex z = tile->corners[i].z;
        tile->corners[i] = point_of(complex_of(creal(z) + shear * cimag(z), stretch * cimag(z)));
    }
    for (int32_t s = 0; s < n; s++)
        tile->pairings[s] = isometry_pairing(tile->geometry, tile->corners[s], tile->corners[(s + 1) % n],
                                             tile->corners[word_glued_start(tile->word, s)],
                                             tile->corners[word_glued_end(tile->word, s)]);
}

/* UV is an affine function of position that keeps orientation; every product of pairings without rotation moves it by
 * whole numbers (in the rectangle of two cells: by whole numbers or by halves in both); no smaller period is there. */
static void check_cell(const orb_tile *tile, double *shear) {
    orb_error error;
    orb_cell cell;
    REQUIRE(lattice_cell(tile, &cell, &error) == ORB_OK);
    double complex basis[2], axis;
    int rotations;
    REQUIRE(lattice_create(tile, basis, &rotations, &axis, &error) == ORB_OK);
    CHECK(axis == 0);
    int32_t top = 0;
    for (int32_t i = 0; i < tile->word->n_nodes; i++)
        top = tile->word->order[i] > top ? tile->word->order[i] : top;
    CHECK(rotations == top);
    int cells = top % 3 == 0 ? 2 : 1;
    double area = cimag(conj(cell.side[0]) * cell.side[1]);
    /* the lattice's cell holds as many tiles as there are rotations */
    CHECK_NEAR(area / (cells * rotations * double_area(tile)), 1, 1e-11);
    CHECK_NEAR(cimag(conj(basis[0]) * basis[1]) / (rotations * double_area(tile)), 1, 1e-11);
    for (int i = 0; i < 2; i++) { /* the cell's sides are translations */
        double complex b0 = basis[0], b1 = basis[1], side = cell.side[i];
        double det = cimag(conj(b0) * b1), x = cimag(conj(side) * b1) / det, y = cimag(conj(b0) * side) / det;
        CHECK_NEAR(x, round(x), 1e-10);
        CHECK_NEAR(y, round(y), 1e-10);
    }
    unsigned state = 3;
    int found = 0;
    for (int word = 0; word < 4000; word++) {
        orb_isometry g = isometry_identity();
        for (int letter = 0; letter < 6; letter++) {
            int s = (int)(uniform(&state) * tile->word->n_sides);
            orb_isometry h = tile->pairings[s];
            g = isometry_compose(tile->geometry, uniform(&state) < 0.5 ? h : isometry_inverse(h), g);
        }
        if (cabs(isometry_turn(tile->geometry, g, point_of(0)) - 1) > 1e-6)
            continue;
        orb_point p = point_of(complex_of(uniform(&state), uniform(&state)));
        double complex move =
            lattice_coordinates(&cell, isometry_apply(tile->geometry, g, p)) - lattice_coordinates(&cell, p);
        double halves = cells == 2 ? 2 : 1, u = halves * creal(move), v = halves * cimag(move);
        CHECK_NEAR(u, round(u), 1e-8);
        CHECK_NEAR(v, round(v), 1e-8);
        CHECK(cells == 1 || fmod(fabs(round(u) + round(v)), 2) == 0);
        found++;
    }
    CHECK(found > 100);
    *shear = creal(cell.side[1] / cell.side[0]);
}

TEST(lattice_of_every_plane_signature) {
    for (int i = 0; i < N_PLANES; i++) {
        orb_tile *tile = NULL;
        orb_error error;
        REQUIRE(tile_of_cones(0, planes[i].k, planes[i].orders, &tile, &error) == ORB_OK);
        double shear = 0;
        check_cell(tile, &shear);
        CHECK_NEAR(shear, 0, 1e-12); /* right angles, 2222 included: its tile before the affine step is a rectangle */
        tile_free(tile);
    }
}

TEST(lattice_of_sheared_2222_is_reduced) {
    for (int i = 0; i < 60; i++) {
        int32_t orders[4] = {2, 2, 2, 2};
        orb_tile *tile = NULL;
        orb_error error;
        REQUIRE(tile_of_cones(0, 4, orders, &tile, &error) == ORB_OK);
        deform(tile, 0.37 * i - 5, i % 2 ? 0.2 + 0.1 * i : 3);
        double shear = 0;
        check_cell(tile, &shear);
        orb_cell cell;
        REQUIRE(lattice_cell(tile, &cell, &error) == ORB_OK);
        double complex tau = cell.side[1] / cell.side[0]; /* or -1 / tau: reduced, either way round */
        if (cabs(tau) < 1)
            tau = -1 / tau;
        CHECK(fabs(creal(tau)) <= 0.5 + 1e-12 && cimag(tau) >= sqrt(0.75) - 1e-12);
        for (int32_t c = 0; c < 6; c++) { /* the cones are the half periods */
            double complex uv = 2 * lattice_coordinates(&cell, tile->corners[c]);
            CHECK_NEAR(creal(uv), round(creal(uv)), 1e-9);
            CHECK_NEAR(cimag(uv), round(cimag(uv)), 1e-9);
        }
        tile_free(tile);
    }
}

/* The sides of the cell under the group: a rotation must take the grid of n x n texel centres to itself. */
TEST(texels_meet_texels_in_442_and_2222) {
    for (int i = 0; i < N_PLANES; i++) {
        if (planes[i].orders[0] % 3 == 0 || planes[i].orders[1] % 3 == 0 || planes[i].orders[2] % 3 == 0)
            continue;
        orb_tile *tile = NULL;
        orb_error error;
        REQUIRE(tile_of_cones(0, planes[i].k, planes[i].orders, &tile, &error) == ORB_OK);
        if (tile->word->n_nodes == 4)
            deform(tile, 0.4, 1.7);
        orb_cell cell;
        REQUIRE(lattice_cell(tile, &cell, &error) == ORB_OK);
        for (int32_t c = 0; c < tile->word->n_nodes; c++)
            if (tile->word->order[c] == 4 || tile->word->n_nodes == 4) {
                double complex uv = 2 * lattice_coordinates(&cell, tile->corners[c]);
                CHECK_NEAR(creal(uv), round(creal(uv)), 1e-12);
                CHECK_NEAR(cimag(uv), round(cimag(uv)), 1e-12);
            }
        for (int n = 2; n <= 64; n *= 2)
            for (int32_t s = 0; s < tile->word->n_sides; s++) {
                double complex texel = complex_of(1.5, 0.5 + n / 2) / n; /* its centre in UV, then in z */
                double complex z = cell.origin.z + (creal(texel) * cell.side[0] + cimag(texel) * cell.side[1]) / 2;
                orb_point q = isometry_apply(tile->geometry, tile->pairings[s], point_of(z));
                double complex uv = n * lattice_coordinates(&cell, q) - complex_of(0.5, 0.5);
                CHECK_NEAR(creal(uv), round(creal(uv)), 1e-9);
                CHECK_NEAR(cimag(uv), round(cimag(uv)), 1e-9);
            }
        tile_free(tile);
    }
}

TEST(periodic_layout_is_affine_and_near_the_unit_square) {
    for (int i = 0; i < N_PLANES; i++) {
        sample s;
        REQUIRE(sample_create(&s, 0, planes[i].k, planes[i].orders, 200));
        sample_disk(&s, 0.3, 1e-3);
        orb_error error;
        int64_t flipped = -1;
        orb_cell cell;
        REQUIRE(orb_uv(&s.embedding, ORB_CHART_DEFAULT, s.uv, &flipped, &error) == ORB_OK);
        REQUIRE(lattice_cell(s.embedding.tile, &cell, &error) == ORB_OK);
        CHECK(flipped == 0);
        double low[2] = {9, 9}, high[2] = {-9, -9};
        for (int32_t k = 0; k < 3 * s.n; k++) {
            double complex base = lattice_coordinates(&cell, s.embedding.placed[k]);
            double u = s.uv[2 * k] - creal(base), v = s.uv[2 * k + 1] - cimag(base);
            CHECK_NEAR(u, round(s.uv[0] - creal(lattice_coordinates(&cell, s.embedding.placed[0]))), 1e-12);
            CHECK_NEAR(v, round(s.uv[1] - cimag(lattice_coordinates(&cell, s.embedding.placed[0]))), 1e-12);
            for (int j = 0; j < 2; j++) {
                low[j] = fmin(low[j], s.uv[2 * k + j]);
                high[j] = fmax(high[j], s.uv[2 * k + j]);
            }
        }
        for (int j = 0; j < 2; j++)
            CHECK(low[j] + high[j] >= 0 && low[j] + high[j] < 2);
        sample_free(&s);
    }
}

/* uv is a similarity of z that keeps orientation and fills the unit square in one direction. */
static void check_conformal(sample *s, orb_chart chart) {
    orb_error error;
    int64_t flipped = -1;
    REQUIRE(orb_uv(&s->embedding, chart, s->uv, &flipped, &error) == ORB_OK);
    CHECK(flipped == 0);
    double low[2] = {9, 9}, high[2] = {-9, -9};
    double complex z0 = s->embedding.placed[0].z, w0 = complex_of(s->uv[0], s->uv[1]);
    double scale = creal((complex_of(s->uv[2], s->uv[3]) - w0) / (s->embedding.placed[1].z - z0));
    CHECK(scale > 0);
    for (int32_t k = 0; k < 3 * s->n; k++) {
        double complex w = complex_of(s->uv[2 * k], s->uv[2 * k + 1]);
        CHECK_NEAR(cabs(w - w0 - scale * (s->embedding.placed[k].z - z0)), 0, 1e-11);
        for (int j = 0; j < 2; j++) {
            low[j] = fmin(low[j], s->uv[2 * k + j]);
            high[j] = fmax(high[j], s->uv[2 * k + j]);
        }
    }
    CHECK_NEAR(fmax(high[0] - low[0], high[1] - low[1]), 1, 1e-14);
    for (int j = 0; j < 2; j++) {
        CHECK(low[j] >= 0 && high[j] <= 1);
        CHECK_NEAR(low[j] + high[j], 1, 1e-14);
    }
}

TEST(conformal_and_stereographic_fit_the_square) {
    sample s;
    REQUIRE(sample_create(&s, 0, 3, (int32_t[]){3, 3, 3}, 300));
    sample_disk(&s, 1.3, 1e-2);
    check_conformal(&s, ORB_CHART_CONFORMAL);
    sample_free(&s);
    REQUIRE(sample_create(&s, 1, 3, (int32_t[]){4, 3, 2}, 300));
    sample_disk(&s, 0.8, 1e-2);
    check_conformal(&s, ORB_CHART_STEREOGRAPHIC);
    check_conformal(&s, ORB_CHART_DEFAULT);
    sample_free(&s);
}

/* The point of the sphere, or the hyperboloid, of a z. */
static void coordinates(double complex z, double K, double x[3]) {
    double r = creal(z) * creal(z) + cimag(z) * cimag(z);
    x[0] = 2 * creal(z) / (1 + K * r);
    x[1] = 2 * cimag(z) / (1 + K * r);
    x[2] = (1 - K * r) / (1 + K * r);
}

TEST(equirectangular_inverts) {
    sample s;
    REQUIRE(sample_create(&s, 1, 3, (int32_t[]){2, 2, 2}, 500));
    sample_disk(&s, 0.7, 1e-3);
    orb_error error;
    int64_t flipped = -1;
    REQUIRE(orb_uv(&s.embedding, ORB_CHART_EQUIRECTANGULAR, s.uv, &flipped, &error) == ORB_OK);
    CHECK(flipped == 0);
    double angle = NAN; /* of the turn about the middle of the tile: the same for all points */
    for (int32_t k = 0; k < 3 * s.n; k++) {
        double pi = 3.141592653589793;
        double longitude = (s.uv[2 * k] - 0.5) * 2 * pi, latitude = (s.uv[2 * k + 1] - 0.5) * pi;
        double x[3], y[3] = {cos(latitude) * sin(longitude), sin(latitude), cos(latitude) * cos(longitude)};
        coordinates(s.embedding.placed[k].z, 1, x);
        if (isnan(angle))
            angle = atan2(x[1], x[0]) - atan2(y[1], y[0]);
        CHECK_NEAR(y[2], x[2], 1e-13);
        CHECK_NEAR(y[0] * cos(angle) - y[1] * sin(angle), x[0], 1e-12);
        CHECK_NEAR(y[0] * sin(angle) + y[1] * cos(angle), x[1], 1e-12);
    }
    sample_free(&s);
}

/* A band from pole to pole: the axis must turn so that the poles are far away. */
TEST(equirectangular_keeps_off_the_poles) {
    for (int i = 0; i < 12; i++) {
        sample s;
        REQUIRE(sample_create(&s, 1, 3, (int32_t[]){2, 2, 5}, 300));
        unsigned state = 11;
        double complex along = cexp(3.141592653589793 / 12 * i * I);
        for (int32_t t = 0; t < s.n; t++) {
            double complex z = along * complex_of(2.4 * (uniform(&state) - 0.5), 0.3 * (uniform(&state) - 0.5));
            for (int c = 0; c < 3; c++)
                s.embedding.placed[3 * t + c] = point_of(z + 0.02 * cexp(2 * 3.141592653589793 / 3 * I * c));
        }
        orb_error error;
        int64_t flipped = -1;
        REQUIRE(orb_uv(&s.embedding, ORB_CHART_EQUIRECTANGULAR, s.uv, &flipped, &error) == ORB_OK);
        CHECK(flipped == 0);
        for (int32_t k = 0; k < 3 * s.n; k++)
            CHECK(fabs(s.uv[2 * k + 1] - 0.5) < 0.2); /* within 36 degrees of the equator */
        sample_free(&s);
    }
}

/* Triangles all around the point opposite to the middle cross the date line: each must stay in one piece. */
TEST(equirectangular_unwraps_the_date_line) {
    sample s;
    REQUIRE(sample_create(&s, 1, 3, (int32_t[]){4, 3, 2}, 64));
    unsigned state = 5;
    for (int32_t t = 0; t < s.n; t++) {
        double complex z = 20 * cexp(6.283185307179586 * I * uniform(&state));
        if (fabs(cimag(z)) > 18)
            z = 20;
        for (int c = 0; c < 3; c++)
            s.embedding.placed[3 * t + c] = point_of(z * (1 + 0.3 * cexp(2 * 3.141592653589793 / 3 * I * c)));
    }
    orb_error error;
    int64_t flipped = -1;
    REQUIRE(orb_uv(&s.embedding, ORB_CHART_EQUIRECTANGULAR, s.uv, &flipped, &error) == ORB_OK);
    CHECK(flipped == 0);
    for (int32_t t = 0; t < s.n; t++)
        for (int c = 1; c < 3; c++)
            CHECK(fabs(s.uv[6 * t + 2 * c] - s.uv[6 * t]) < 0.5);
    sample_free(&s);
}

TEST(octahedral_inverts_and_keeps_orientation) {
    sample s;
    REQUIRE(sample_create(&s, 1, 3, (int32_t[]){5, 3, 2}, 2000));
    sample_disk(&s, 0.98, 1e-3);
    orb_error error;
    int64_t flipped = -1;
    REQUIRE(orb_uv(&s.embedding, ORB_CHART_OCTAHEDRAL, s.uv, &flipped, &error) == ORB_OK);
    CHECK(flipped == 0); /* a bend of the octahedron within the upper half flips nothing */
    sample_disk(&s, 5, 1e-3);
    REQUIRE(orb_uv(&s.embedding, ORB_CHART_OCTAHEDRAL, s.uv, &flipped, &error) == ORB_OK);
    for (int32_t k = 0; k < 3 * s.n; k++) {
        double u = 2 * s.uv[2 * k] - 1, v = 2 * s.uv[2 * k + 1] - 1, n = 1 - fabs(u) - fabs(v);
        CHECK(fabs(u) <= 1 && fabs(v) <= 1);
        double a = n >= 0 ? u : copysign(1 - fabs(v), u), b = n >= 0 ? v : copysign(1 - fabs(u), v);
        double x[3], length = sqrt(a * a + b * b + n * n);
        coordinates(s.embedding.placed[k].z, 1, x);
        CHECK_NEAR(a / length, x[0], 1e-13);
        CHECK_NEAR(b / length, x[1], 1e-13);
        CHECK_NEAR(n / length, x[2], 1e-13);
    }
    sample_free(&s);
}

TEST(poincare_and_klein_invert) {
    sample s;
    REQUIRE(sample_create(&s, -1, 3, (int32_t[]){2, 3, 7}, 500));
    sample_disk(&s, 0.99, 1e-3);
    orb_error error;
    int64_t flipped = -1;
    REQUIRE(orb_uv(&s.embedding, ORB_CHART_DEFAULT, s.uv, &flipped, &error) == ORB_OK);
    CHECK(flipped == 0);
    for (int32_t k = 0; k < 3 * s.n; k++)
        CHECK_NEAR(cabs(2 * complex_of(s.uv[2 * k] - 0.5, s.uv[2 * k + 1] - 0.5) - s.embedding.placed[k].z), 0, 1e-15);
    REQUIRE(orb_uv(&s.embedding, ORB_CHART_KLEIN, s.uv, &flipped, &error) == ORB_OK);
    CHECK(flipped == 0);
    for (int32_t k = 0; k < 3 * s.n; k++) { /* Klein's point is the hyperboloid's seen from the origin */
        double x[3];
        coordinates(s.embedding.placed[k].z, -1, x);
        CHECK_NEAR(2 * s.uv[2 * k] - 1, x[0] / x[2], 1e-14);
        CHECK_NEAR(2 * s.uv[2 * k + 1] - 1, x[1] / x[2], 1e-14);
    }
    sample_free(&s);
}

TEST(rounding_to_float_is_counted) {
    double uv[18] = {0, 0, 1, 0, 0, 1, /**/ 0, 0, 0, 1, 1, 0, /**/ 1, 1, 1 + 1e-9, 1, 1, 1 + 1e-9};
    CHECK(layout_flipped_float32(1, uv) == 0);
    CHECK(layout_flipped_float32(3, uv) == 2); /* one turned over, one that float cannot tell from a point */
}

TEST(a_chart_of_another_geometry_is_refused) {
    sample s;
    REQUIRE(sample_create(&s, 1, 3, (int32_t[]){4, 3, 2}, 4));
    sample_disk(&s, 0.5, 1e-2);
    orb_error error;
    CHECK(orb_uv(&s.embedding, ORB_CHART_KLEIN, s.uv, NULL, &error) == ORB_BAD_ARGUMENT);
    CHECK(strstr(error.message, "Klein") && strstr(error.message, "stereographic, equirectangular or octahedral"));
    CHECK(orb_uv(&s.embedding, (orb_chart)99, s.uv, NULL, &error) == ORB_BAD_ARGUMENT);
    CHECK(orb_uv(&s.embedding, ORB_CHART_DEFAULT, NULL, NULL, &error) == ORB_BAD_ARGUMENT);
    CHECK(orb_uv(NULL, ORB_CHART_DEFAULT, s.uv, NULL, &error) == ORB_BAD_ARGUMENT);
    CHECK(orb_uv(&s.embedding, ORB_CHART_DEFAULT, s.uv, NULL, NULL) == ORB_OK);
    sample_free(&s);
}
