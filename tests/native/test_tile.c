/* Every tile passes Poincare's conditions; spherical groups close. SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>

#include "check.h"
#include "signature.h"
#include "tile.h"

static const double pi = 3.14159265358979323846;

static orb_tile *make_tile(const char *text, double *euler) {
    orb_error error;
    orb_signature *signature = NULL;
    orb_tile *tile = NULL;
    if (signature_parse(text, &signature, &error) != ORB_OK)
        return NULL;
    *euler = signature->euler;
    tile_create(signature->curvature, signature->n_cones, signature->orders, &tile, &error);
    signature_free(signature);
    return tile;
}

/* The angle inside the tile at corner j, by its neighbours. */
static double corner_angle(const orb_tile *tile, int32_t j) {
    int32_t n = 2 * tile->n_cones - 2;
    double complex next = geometry_toward(tile->geometry, tile->corners[j], tile->corners[(j + 1) % n]);
    double complex previous = geometry_toward(tile->geometry, tile->corners[j], tile->corners[(j + n - 1) % n]);
    double angle = carg(previous * conj(next));
    return angle > 0 ? angle : angle + 2 * pi;
}

static double polygon_area(const orb_tile *tile) {
    double area = 0;
    for (int32_t j = 1; j + 1 < 2 * tile->n_cones - 2; j++)
        area +=
            geometry_triangle_area(tile->geometry, geometry_toward(tile->geometry, tile->corners[0], tile->corners[j]),
                                   geometry_toward(tile->geometry, tile->corners[0], tile->corners[j + 1]));
    return area;
}

static void check_poincare(const char *text) {
    double euler;
    orb_tile *tile = make_tile(text, &euler);
    REQUIRE(tile != NULL);
    int32_t k = tile->n_cones;
    const orb_geometry *geometry = tile->geometry;
    for (int32_t s = 1; s < k; s++) { /* a pairing takes the left bank's side to the right bank's */
        orb_point p = tile->corners[s - 1], q = tile->corners[s];
        orb_point p1 = point_conjugate(p), q1 = point_conjugate(q);
        CHECK_NEAR(geometry_distance(geometry, isometry_apply(geometry, tile->pairings[s], p), p1), 0, 1e-13);
        CHECK_NEAR(geometry_distance(geometry, isometry_apply(geometry, tile->pairings[s], q), q1), 0, 1e-13);
        CHECK_NEAR(cabs(tile->sides[s - 1]), geometry_distance(geometry, p, q), 1e-13);
    }
    for (int32_t i = 0; i < k; i++) { /* angles of the copies of one cone add up to 2 pi / n */
        bool end = i == 0 || i == k - 1;
        double sum = corner_angle(tile, i) + (end ? 0 : corner_angle(tile, 2 * k - 2 - i));
        CHECK_NEAR(sum, 2 * pi / tile->orders[i], 1e-12);
    }
    orb_isometry turn = isometry_identity(); /* g_s = R_1 ... R_s, and R_1 ... R_k closes */
    for (int32_t i = 0; i < k; i++) {
        orb_isometry home = isometry_to_origin(geometry, tile->corners[i]);
        orb_isometry rotation =
            isometry_compose(geometry, isometry_rotation_about_origin(2 * pi / tile->orders[i]), home);
        turn = isometry_compose(geometry, turn, isometry_compose(geometry, isometry_inverse(home), rotation));
        if (i + 1 < k)
            CHECK(isometry_same(geometry, turn, tile->pairings[i + 1], 1e-9));
    }
    CHECK(isometry_same(geometry, turn, isometry_identity(), 1e-9));
    CHECK_NEAR(polygon_area(tile) / tile_area(tile, euler), 1, 1e-11);
    tile_free(tile);
}

TEST(euclidean_tiles) {
    check_poincare("442");
    check_poincare("244");
    check_poincare("333");
    check_poincare("632");
    check_poincare("2222");
}

TEST(spherical_tiles) {
    static const char *const all[] = {"532", "432", "332", "222", "223", "22(5)", "22(12)", "22(100)", "2(40)2", "235"};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        check_poincare(all[i]);
}

TEST(hyperbolic_tiles) {
    static const char *const all[] = {"237",        "334",   "444",  "22222",        "2222222222",
                                      "2223",       "34567", "9876", "(50)(50)(50)", "(1000)(1000)(1000)",
                                      "2(70)2(80)3"};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        check_poincare(all[i]);
}

/* The poles of a lune are antipodal, so its angles cannot be read from its corners: from its sides instead. */
TEST(lunes) {
    for (int32_t n = 2; n < 40; n++) {
        int32_t orders[] = {n, n};
        orb_tile *tile = NULL;
        orb_error error;
        REQUIRE(tile_create(1, 2, orders, &tile, &error) == ORB_OK);
        CHECK(tile->rotates);
        CHECK_NEAR(creal(tile->corners[0].z), 1, 1e-14);
        CHECK_NEAR(creal(tile->corners[1].z), -1, 1e-14);
        CHECK_NEAR(cabs(tile->sides[0]), pi, 1e-12);
        double up = carg(-tile->sides[0]); /* the lune opens to both sides of the real axis, which is its middle */
        CHECK_NEAR(2 * fabs(up), 2 * pi / n, 1e-12);
        orb_isometry home = isometry_to_origin(tile->geometry, tile->corners[0]);
        orb_isometry turn = isometry_compose(tile->geometry, isometry_rotation_about_origin(2 * pi / n), home);
        turn = isometry_compose(tile->geometry, isometry_inverse(home), turn);
        CHECK(isometry_same(tile->geometry, turn, tile->pairings[1], 1e-12));
        tile_free(tile);
    }
}

/* The number of different elements that words in the pairings make. */
static int32_t group_order(const orb_tile *tile, int32_t limit) {
    orb_isometry *elements = malloc((size_t)limit * sizeof *elements);
    int32_t found = 1;
    elements[0] = isometry_identity();
    for (int32_t done = 0; done < found && found < limit; done++)
        for (int32_t s = 1; s < tile->n_pairings && found < limit; s++) {
            orb_isometry next = isometry_compose(tile->geometry, tile->pairings[s], elements[done]);
            bool known = false;
            for (int32_t i = 0; i < found && !known; i++) { /* g(0) may be at infinity: compare by g^-1 h */
                orb_isometry quotient = isometry_compose(tile->geometry, isometry_inverse(elements[i]), next);
                known = isometry_same(tile->geometry, quotient, isometry_identity(), 1e-8);
            }
            if (!known)
                elements[found++] = next;
        }
    free(elements);
    return found;
}

TEST(spherical_groups_close_with_their_orders) {
    static const struct {
        const char *text;
        int32_t order;
    } all[] = {{"532", 60},    {"432", 24}, {"332", 12}, {"222", 4},      {"22(7)", 14},
               {"2(12)2", 24}, {"22", 2},   {"77", 7},   {"(12)(12)", 12}};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        double euler;
        orb_tile *tile = make_tile(all[i].text, &euler);
        REQUIRE(tile != NULL);
        CHECK(group_order(tile, 200) == all[i].order);
        CHECK_NEAR(2 / euler, all[i].order, 1e-12);
        tile_free(tile);
    }
}
