/* Conway's notation. SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>

#include "check.h"
#include "picks.h"

static void check_read(const char *text, int curvature, double euler, int32_t n_cones, bool supported) {
    orb_signature_info info;
    orb_error error;
    REQUIRE(orb_signature_read(text, &info, NULL, 0, &error) == ORB_OK);
    CHECK(info.curvature == curvature);
    CHECK_NEAR(info.euler, euler, 1e-15);
    CHECK(info.n_cones == n_cones);
    CHECK(info.supported == supported);
}

TEST(euler_characteristic_and_geometry) {
    check_read("442", 0, 0, 3, true);
    check_read("333", 0, 0, 3, true);
    check_read("632", 0, 0, 3, true);
    check_read("2222", 0, 0, 4, true);
    check_read("432", 1, 1.0 / 12, 3, true);
    check_read("532", 1, 1.0 / 30, 3, true);
    check_read("22(12)", 1, 1.0 / 12, 3, true);
    check_read("77", 1, 2.0 / 7, 2, true);
    check_read("237", -1, -1.0 / 42, 3, true);
    check_read("22222", -1, -0.5, 5, true);
    check_read("*237", -1, -1.0 / 84, 3, true);
    check_read("4*2", 0, 0, 2, true);
    check_read("o", 0, 0, 0, true);
    check_read("**", 0, 0, 0, true);
    check_read("*", 1, 1, 0, false);
    check_read("x", 1, 1, 0, false);
    check_read("22x", 0, 0, 2, true);
    check_read("(999983)(999979)2", -1, (1.0 / 999983 + 1.0 / 999979 - 0.5) / 2 * 2, 3, true);
    check_read("*22222222", -1, -1, 8, true);
}

TEST(orders_are_handed_out) {
    orb_signature_info info;
    orb_error error;
    int32_t orders[3] = {0, 0, 0};
    REQUIRE(orb_signature_read("22(123)", &info, orders, 3, &error) == ORB_OK);
    CHECK(orders[0] == 2 && orders[1] == 2 && orders[2] == 123);
    orders[1] = 7;
    REQUIRE(orb_signature_read("345", &info, orders, 1, &error) == ORB_OK);
    CHECK(orders[0] == 3 && orders[1] == 7);
}

static void check_refused(const char *text, orb_status status, int32_t position) {
    orb_signature_info info;
    orb_error error;
    CHECK(orb_signature_read(text, &info, NULL, 0, &error) == status);
    CHECK(error.status == status && error.message[0]);
    if (position >= 0)
        CHECK(error.n_elements == 1 && error.elements[0] == position && error.element == ORB_CHARACTER);
}

TEST(what_does_not_parse_names_the_position) {
    check_refused("", ORB_BAD_SIGNATURE, 0);
    check_refused("44a", ORB_BAD_SIGNATURE, 2);
    check_refused("22(12", ORB_BAD_SIGNATURE, 5);
    check_refused("22()", ORB_BAD_SIGNATURE, 3);
    check_refused("4)2", ORB_BAD_SIGNATURE, 1);
    check_refused("2x2", ORB_BAD_SIGNATURE, 2);
    check_refused("22(99999999999)", ORB_BAD_SIGNATURE, 2);
    check_refused("432\xc3\x97", ORB_BAD_SIGNATURE, 3);
}

TEST(orders_below_two) {
    check_refused("412", ORB_BAD_ORDER, 1);
    check_refused("0", ORB_BAD_ORDER, 0);
    check_refused("33(1)", ORB_BAD_ORDER, 3);
}

TEST(orbifolds_that_do_not_exist) {
    check_refused("5", ORB_BAD_ORBIFOLD, -1);
    check_refused("23", ORB_BAD_ORBIFOLD, -1);
    check_refused("*23", ORB_BAD_ORBIFOLD, -1);
    check_refused("*4", ORB_BAD_ORBIFOLD, -1);
}

/* The signature that an error advises is one that parses as meant. */
TEST(advice_puts_long_orders_in_parentheses) {
    orb_signature *signature = NULL;
    orb_error error;
    CHECK(signature_parse("(12)3", &signature, &error) == ORB_BAD_ORBIFOLD && strstr(error.message, "(12)(12)"));
    CHECK(signature_parse("(12)", &signature, &error) == ORB_BAD_ORBIFOLD && strstr(error.message, "(12)(12)"));
    CHECK(signature_parse("53", &signature, &error) == ORB_BAD_ORBIFOLD && strstr(error.message, "55"));
}

/* On the boundary of a triangle fan: vertex 0 inside, 1 ... 6 round it. */
static orb_status match(const char *text, int32_t n, const int32_t *picks, const int32_t *given, int32_t *order,
                        orb_error *error) {
    double vertices[21] = {0};
    int32_t triangles[18];
    for (int32_t i = 0; i < 6; i++) {
        vertices[3 * i + 3] = cos(i * 1.0471975511965976);
        vertices[3 * i + 4] = sin(i * 1.0471975511965976);
        triangles[3 * i] = 0;
        triangles[3 * i + 1] = 1 + i;
        triangles[3 * i + 2] = 1 + (i + 1) % 6;
    }
    orb_mesh_arrays arrays = {7, vertices, 6, triangles};
    orb_mesh *mesh = NULL;
    orb_boundary *boundary = NULL;
    orb_signature *signature = NULL;
    bool mirror[8], filled = false;
    orb_status status = mesh_create(&arrays, &mesh, error);
    if (status == ORB_OK)
        status = boundary_list(mesh, &boundary, error);
    if (status == ORB_OK)
        status = signature_parse(text, &signature, error);
    if (status == ORB_OK)
        status = picks_match(signature, boundary, &filled, n, picks, given, order, mirror, error);
    for (int32_t i = 0; i < n && status == ORB_OK; i++)
        CHECK(mirror[i] == (picks[i] > 0));
    signature_free(signature);
    boundary_free(boundary);
    mesh_free(mesh);
    return status;
}

TEST(picks_are_matched_with_orders) {
    int32_t order[8];
    orb_error error;
    CHECK(match("*432", 3, (int32_t[]){1, 2, 5}, NULL, order, &error) == ORB_OK && order[0] == 4 && order[2] == 2);
    CHECK(match("*432", 3, (int32_t[]){5, 2, 1}, NULL, order, &error) == ORB_OK && order[0] == 4 && order[2] == 2);
    CHECK(match("*432", 3, (int32_t[]){1, 2, 5}, (int32_t[]){2, 3, 4}, order, &error) == ORB_OK && order[0] == 2);
    CHECK(match("*432", 3, (int32_t[]){1, 2, 5}, (int32_t[]){2, 3, 3}, order, &error) == ORB_BAD_ORDER);
    CHECK(match("*432", 4, (int32_t[]){1, 2, 5, 6}, NULL, order, &error) == ORB_CONE_COUNT);
    CHECK(match("*2345", 4, (int32_t[]){4, 6, 1, 2}, NULL, order, &error) == ORB_OK);
    CHECK(match("*2345", 4, (int32_t[]){4, 1, 6, 2}, NULL, order, &error) == ORB_BAD_ORDER);
    CHECK(match("*2345", 4, (int32_t[]){4, 1, 6, 2}, (int32_t[]){2, 4, 3, 5}, order, &error) == ORB_OK);
    CHECK(match("4*2", 2, (int32_t[]){0, 3}, NULL, order, &error) == ORB_OK && order[0] == 4 && order[1] == 2);
    CHECK(match("4*2", 2, (int32_t[]){3, 0}, NULL, order, &error) == ORB_OK && order[0] == 2 && order[1] == 4);
    CHECK(match("4*2", 2, (int32_t[]){3, 4}, NULL, order, &error) == ORB_BAD_CONE && error.elements[0] == 3);
    CHECK(match("*22", 2, (int32_t[]){3, 0}, NULL, order, &error) == ORB_BAD_CONE && error.elements[0] == 0);
}

TEST(mirrors_and_their_corners) {
    orb_signature *s = NULL;
    REQUIRE(signature_parse("o23*45**6xx", &s, NULL) == ORB_OK);
    CHECK(s->n_handles == 1 && s->n_cones == 2 && s->n_mirrors == 3 && s->n_corners == 3 && s->n_crosscaps == 2);
    CHECK(signature_corners(s, 0) == 2 && signature_corners(s, 1) == 0 && signature_corners(s, 2) == 1);
    CHECK(s->orders[s->mirror_start[2]] == 6 && !strcmp(s->text, "o23*45**6xx"));
    orb_signature *more = NULL;
    REQUIRE(signature_with_mirrors(s, 2, &more, NULL) == ORB_OK);
    CHECK(!strcmp(more->text, "o23*45**6**xx") && more->n_mirrors == 5);
    CHECK_NEAR(more->euler, s->euler - 2, 1e-12);
    signature_free(more);
    signature_free(s);
}

TEST(what_nothing_holds_in_place) {
    static const char *const loose[] = {"*", "x"};
    for (int i = 0; i < 2; i++) {
        orb_signature *s = NULL;
        orb_error error;
        REQUIRE(signature_parse(loose[i], &s, NULL) == ORB_OK);
        CHECK(!signature_is_supported(s) && signature_refuse(s, &error) == ORB_UNSUPPORTED_SIGNATURE);
        CHECK(strstr(error.message, "add a cone"));
        signature_free(s);
    }
}
