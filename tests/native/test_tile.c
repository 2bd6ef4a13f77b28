/* Every tile passes Poincare's conditions; spherical groups close. SPDX-License-Identifier: GPL-3.0-or-later */
#include <complex.h>
#include <stdlib.h>

#include "check.h"
#include "tiles.h"

static const double pi = 3.14159265358979323846;

static orb_tile *make_tile(const char *text, double *euler) {
    orb_error error = {0};
    orb_signature *signature = NULL;
    orb_word *word = NULL;
    orb_tile *tile = NULL;
    if (signature_parse(text, &signature, &error) == ORB_OK && word_of_signature(signature, &word, &error) == ORB_OK) {
        *euler = signature->euler;
        tile_create(word, signature->curvature, &tile, &error);
    }
    if (!tile)
        printf("     %s: %s\n", text, error.message);
    word_free(word);
    signature_free(signature);
    return tile;
}

/* The direction in which side s leaves its first corner, and that in which it arrives, seen back from its end. */
static double complex leaving(const orb_tile *tile, int32_t s) { return tile->sides[s] / cabs(tile->sides[s]); }

static double complex arriving(const orb_tile *tile, int32_t s) {
    orb_point end = geometry_exp(tile->geometry, tile->corners[s], tile->sides[s]);
    orb_point near = geometry_exp(tile->geometry, tile->corners[s], 0.5 * tile->sides[s]);
    double complex t = geometry_toward(tile->geometry, end, near);
    return t / cabs(t);
}

/* The angle inside the tile at corner c, by its two sides. */
static double corner_angle(const orb_tile *tile, int32_t c) {
    double angle = carg(arriving(tile, word_previous(tile->word, c)) * conj(leaving(tile, c)));
    return angle > 1e-9 ? angle : angle + 2 * pi;
}

/* Point `share` of the way along side s. */
static orb_point along(const orb_tile *tile, int32_t s, double share) {
    return geometry_exp(tile->geometry, tile->corners[s], share * tile->sides[s]);
}

static void check_sides(const orb_tile *tile) {
    const orb_geometry *geometry = tile->geometry;
    const orb_word *word = tile->word;
    for (int32_t s = 0; s < word->n_sides; s++) {
        int32_t t = word->partner[s];
        CHECK(word->partner[t] == s && word->same_way[t] == word->same_way[s]);
        CHECK(tile->pairings[s].reflects == word->same_way[s]);
        CHECK_NEAR(geometry_distance(geometry, along(tile, s, 1), tile->corners[word_next(word, s)]), 0, 1e-12);
        CHECK_NEAR(cabs(tile->sides[s]), cabs(tile->sides[t]), 1e-12);
        for (int k = 0; k <= 4; k++) { /* the pairing takes each point of the side to its partner's, as glued */
            double share = k / 4.0;
            orb_point image = isometry_apply(geometry, tile->pairings[s], along(tile, s, share));
            orb_point wanted = along(tile, t, word->same_way[s] ? share : 1 - share);
            CHECK_NEAR(geometry_distance(geometry, image, wanted), 0, 2e-12);
        }
        /* the tile goes to the other side of the partner */
        orb_point inside = geometry_exp(geometry, along(tile, s, 0.5), 0);
        inside =
            geometry_exp(geometry, inside, 1e-3 * CMPLX(0, 1) * geometry_log(geometry, inside, along(tile, s, 0.6)));
        orb_point image = isometry_apply(geometry, tile->pairings[s], inside), middle = along(tile, t, 0.5);
        double complex forwards = geometry_log(geometry, middle, along(tile, t, 0.6));
        CHECK(cimag(conj(forwards) * geometry_log(geometry, middle, image)) < 0);
        /* the line of the side */
        orb_point on = isometry_apply(geometry, isometry_inverse(tile->lines[s]), along(tile, s, 0.3));
        CHECK_NEAR(cimag(on.z), 0, 1e-12);
    }
}

/* Angles of a node's copies add up; its elements take the first of them to the others. */
static void check_nodes(const orb_tile *tile) {
    const orb_word *word = tile->word;
    for (int32_t n = 0; n < word->n_nodes; n++) {
        double sum = 0;
        for (int32_t c = 0; c < word->n_sides; c++) {
            if (word->node[c] != n)
                continue;
            double angle = corner_angle(tile, c);
            CHECK_NEAR(angle, word_angle(word, c), 1e-9);
            sum += angle;
            orb_point image = isometry_apply(tile->geometry, tile->elements[c], tile->corners[word->first[n]]);
            CHECK_NEAR(geometry_distance(tile->geometry, image, tile->corners[c]), 0, 1e-11);
        }
        CHECK_NEAR(sum, (word->on_mirror[n] ? pi : 2 * pi) / word->order[n], 1e-9);
    }
}

/* By triangles from the inscribed circle's centre or, doubled, from the middle of the axis: the origin. */
static double polygon_area(const orb_tile *tile) {
    double area = 0;
    for (int32_t s = 0; s < tile->word->n_sides; s++)
        for (int k = 0; k < 8; k++)
            area += geometry_triangle_area(tile->geometry, along(tile, s, k / 8.0).z, along(tile, s, (k + 1) / 8.0).z);
    return area;
}

static void check_poincare(const char *text) {
    double euler = 0;
    orb_tile *tile = make_tile(text, &euler);
    REQUIRE(tile != NULL);
    int K = (euler > 1e-12) - (euler < -1e-12);
    CHECK_NEAR(polygon_area(tile) / tile->area, 1, 1e-10);
    CHECK_NEAR(tile->area, K ? 2 * pi * fabs(euler) : 1, 1e-9);
    check_sides(tile);
    check_nodes(tile);
    if (check_failures)
        printf("     in %s\n", text);
    tile_free(tile);
}

TEST(the_17_plane_orbifolds) {
    static const char *const all[] = {"442", "244", "333",  "632", "2222", "*442", "*333", "*632", "*2222",
                                      "4*2", "3*3", "2*22", "22*", "22x",  "**",   "*x",   "xx",   "o"};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        check_poincare(all[i]);
}

TEST(the_14_families_of_the_sphere) {
    static const char *const all[] = {"532",    "432", "332", "222", "223",  "22(5)", "22(12)", "22(100)", "2(40)2",
                                      "235",    "22",  "33",  "55",  "*532", "*432",  "*332",   "*222",    "*223",
                                      "*22(5)", "*22", "*33", "*55", "3*2",  "2*2",   "2*3",    "2*5",     "2*",
                                      "3*",     "5*",  "2x",  "3x",  "5x",   "(40)*", "(40)x",  "2*(40)"};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        check_poincare(all[i]);
}

TEST(hyperbolic_tiles) {
    static const char *const all[] = {
        "237",          "334",         "444",  "22222", "2222222222", "2223",         "34567", "9876",
        "(50)(50)(50)", "2(70)2(80)3", "*237", "*334",  "5*3",        "2*222",        "33*22", "oo",
        "ooo",          "o2",          "o34",  "***",   "2**",        "**2",          "*22*3", "xxx",
        "*xx",          "3x",          "22xx", "o*",    "o3*2",       "2222*3333*22", "oox",   "23*45*67xx"};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        if (strcmp(all[i], "3x")) /* spherical */
            check_poincare(all[i]);
}

/* g_s = R_1 ... R_s, and R_1 ... R_k closes. */
TEST(a_path_pairs_by_products_of_rotations) {
    static const char *const all[] = {"442", "2222", "532", "237", "34567", "2(70)2(80)3"};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        double euler;
        orb_tile *tile = make_tile(all[i], &euler);
        REQUIRE(tile != NULL);
        int32_t k = tile->word->n_nodes;
        orb_isometry turn = isometry_identity();
        for (int32_t c = 0; c < k; c++) {
            orb_isometry home = isometry_to_origin(tile->geometry, tile->corners[c]);
            orb_isometry rotation =
                isometry_compose(tile->geometry, isometry_rotation_about_origin(2 * pi / tile->word->order[c]), home);
            turn = isometry_compose(tile->geometry, turn,
                                    isometry_compose(tile->geometry, isometry_inverse(home), rotation));
            if (c + 1 < k)
                CHECK(isometry_same(tile->geometry, turn, tile->pairings[c], 1e-9));
        }
        CHECK(isometry_same(tile->geometry, turn, isometry_identity(), 1e-9));
        tile_free(tile);
    }
}

/* The number of different elements that words in the pairings make. */
static int32_t group_order(const orb_tile *tile, int32_t limit) {
    orb_isometry *elements = malloc((size_t)limit * sizeof *elements);
    int32_t found = 1;
    elements[0] = isometry_identity();
    for (int32_t done = 0; done < found && found < limit; done++)
        for (int32_t s = 0; s < tile->word->n_sides && found < limit; s++) {
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
    } all[] = {{"532", 60},  {"432", 24}, {"332", 12},      {"222", 4},    {"22(7)", 14}, {"2(12)2", 24},
               {"22", 2},    {"77", 7},   {"(12)(12)", 12}, {"*532", 120}, {"*432", 48},  {"*332", 24},
               {"*225", 20}, {"*22", 4},  {"*55", 10},      {"3*2", 24},   {"2*2", 8},    {"2*5", 20},
               {"2*", 4},    {"5*", 10},  {"2x", 4},        {"3x", 6},     {"5x", 10}};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        double euler;
        orb_tile *tile = make_tile(all[i].text, &euler);
        REQUIRE(tile != NULL);
        CHECK(group_order(tile, 200) == all[i].order);
        CHECK_NEAR(2 / euler, all[i].order, 1e-12);
        tile_free(tile);
    }
}
