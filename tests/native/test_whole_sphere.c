/* The quotient by the group, centring and mending. SPDX-License-Identifier: GPL-3.0-or-later */
#include <complex.h>
#include <stdlib.h>

#include "check.h"
#include "embedding.h"
#include "quotient.h"

static double uniform(unsigned *state) {
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) / 16777216.0;
}

static double complex complex_of(double x, double y) { return x + y * I; }

static const struct {
    int32_t k, orders[3];
} spheres[] = {
    {2, {2, 2}},    {2, {3, 3}},    {2, {5, 5}},    {2, {12, 12}},  {3, {2, 2, 2}}, {3, {2, 2, 3}}, {3, {2, 3, 2}},
    {3, {3, 2, 2}}, {3, {2, 2, 12}}, {3, {2, 12, 2}}, {3, {12, 2, 2}}, {3, {3, 3, 2}}, {3, {3, 2, 3}}, {3, {2, 3, 3}},
    {3, {4, 3, 2}}, {3, {4, 2, 3}}, {3, {3, 4, 2}}, {3, {3, 2, 4}}, {3, {2, 3, 4}}, {3, {2, 4, 3}}, {3, {5, 3, 2}},
    {3, {5, 2, 3}}, {3, {3, 5, 2}}, {3, {3, 2, 5}}, {3, {2, 3, 5}}, {3, {2, 5, 3}},
};
enum { N_SPHERES = sizeof spheres / sizeof *spheres };

static double complex value(orb_ratio f) { return f.zero / f.pole; }

/* The sine of half the angle between two values. */
static double apart(orb_ratio f, orb_ratio g) { return cabs(f.zero * g.pole - f.pole * g.zero); }

static orb_point random_point(unsigned *state) {
    return point_of(complex_of(3 * uniform(state) - 1.5, 3 * uniform(state) - 1.5));
}

TEST(quotient_is_invariant) {
    for (int i = 0; i < N_SPHERES; i++) {
        orb_tile *tile = NULL;
        orb_quotient *quotient = NULL;
        orb_error error;
        unsigned state = 1;
        REQUIRE(tile_create(1, spheres[i].k, spheres[i].orders, &tile, &error) == ORB_OK);
        REQUIRE(quotient_create(tile, &quotient, &error) == ORB_OK);
        for (int n = 0; n < 200; n++) {
            orb_point p = random_point(&state);
            orb_ratio f = quotient_evaluate(quotient, p);
            CHECK_NEAR(cabs(f.zero) * cabs(f.zero) + cabs(f.pole) * cabs(f.pole), 1, 1e-12);
            CHECK_NEAR(cabs(f.zero - f.pole - f.one), 0, 1e-12);
            for (int32_t s = 1; s < tile->n_pairings; s++) {
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
        orb_point p = {centre.z, centre.low + 1e-4 * cexp(2 * 3.141592653589793 / 400 * n * I)};
        orb_ratio f = quotient_evaluate(quotient, p);
        double complex w = form == 0 ? f.zero / f.pole : form == 1 ? f.pole / f.zero : f.one / f.pole;
        if (n > 0)
            turns += carg(w / last) / (2 * 3.141592653589793);
        last = w;
    }
    return turns;
}

TEST(cones_go_to_zero_infinity_and_one) {
    for (int i = 0; i < N_SPHERES; i++) {
        orb_tile *tile = NULL;
        orb_quotient *quotient = NULL;
        orb_error error;
        REQUIRE(tile_create(1, spheres[i].k, spheres[i].orders, &tile, &error) == ORB_OK);
        REQUIRE(quotient_create(tile, &quotient, &error) == ORB_OK);
        for (int32_t c = 0; c < 2 * tile->n_cones - 2; c++) {
            int32_t cone = c < tile->n_cones ? c : 2 * tile->n_cones - 2 - c;
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
        REQUIRE(tile_create(1, spheres[i].k, spheres[i].orders, &tile, &error) == ORB_OK);
        REQUIRE(quotient_create(tile, &quotient, &error) == ORB_OK);
        for (int32_t c = 0; c < tile->n_cones; c++) {
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
        unsigned state = 1;
        REQUIRE(tile_create(1, 2, (int32_t[]){order, order}, &tile, &error) == ORB_OK);
        REQUIRE(quotient_create(tile, &quotient, &error) == ORB_OK);
        double complex z1 = tile->corners[0].z, z2 = tile->corners[1].z;
        double complex unit = value(quotient_evaluate(quotient, point_of(0))) / cpow((0 - z1) / (0 - z2), order);
        for (int n = 0; n < 100; n++) {
            double complex z = complex_of(uniform(&state) - 0.5, uniform(&state) - 0.5) * 2 / order;
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
    REQUIRE(tile_create(1, 3, (int32_t[]){2, 3000, 2}, &tile, &error) == ORB_OK);
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
    REQUIRE(tile_create(0, 3, (int32_t[]){3, 3, 3}, &tile, &error) == ORB_OK);
    CHECK(quotient_create(tile, &quotient, &error) == ORB_BAD_ARGUMENT && !quotient);
    tile_free(tile);
}
