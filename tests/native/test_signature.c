/* Conway's notation. SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>

#include "check.h"
#include "signature.h"

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
    check_read("*237", -1, -1.0 / 84, 3, false);
    check_read("4*2", 0, 0, 2, false);
    check_read("o", 0, 0, 0, false);
    check_read("**", 0, 0, 0, false);
    check_read("22x", 0, 0, 2, false);
    check_read("(999983)(999979)2", -1, (1.0 / 999983 + 1.0 / 999979 - 0.5) / 2 * 2, 3, true);
    check_read("*22222222", -1, -1, 8, false);
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

static orb_status match(const char *text, int32_t n, const int32_t *orders, int32_t *matched) {
    orb_signature *signature = NULL;
    orb_error error;
    orb_status status = signature_parse(text, &signature, &error);
    if (status == ORB_OK)
        status = signature_match(signature, n, orders, matched, &error);
    signature_free(signature);
    return status;
}

TEST(cones_are_matched_with_orders) {
    int32_t matched[4], turned[] = {2, 3, 4}, wrong[] = {2, 3, 3};
    CHECK(match("432", 3, NULL, matched) == ORB_OK && matched[0] == 4 && matched[2] == 2);
    CHECK(match("432", 3, turned, matched) == ORB_OK && matched[0] == 2 && matched[2] == 4);
    CHECK(match("432", 3, wrong, matched) == ORB_BAD_ORDER);
    CHECK(match("432", 4, NULL, matched) == ORB_CONE_COUNT);
    CHECK(match("*432", 3, NULL, matched) == ORB_UNSUPPORTED_SIGNATURE);
}
