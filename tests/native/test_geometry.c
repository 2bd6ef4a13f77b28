/* One property list for the three geometries. SPDX-License-Identifier: GPL-3.0-or-later */
#include <complex.h>

#include "check.h"
#include "geometry.h"
#include "random.h"

static const double pi = 3.14159265358979323846;

static double complex random_in_disk(random_state *state, double radius) {
    return radius * sqrt(random_unit(state)) * cexp(2 * pi * I * random_unit(state));
}

static orb_isometry random_isometry(const orb_geometry *geometry, random_state *state) {
    orb_isometry away = isometry_inverse(isometry_to_origin(geometry, point_of(random_in_disk(state, 0.7))));
    return isometry_compose(geometry, away, isometry_rotation_about_origin(2 * pi * random_unit(state)));
}

/* <a, b> = ax bx + ay by + K az bz of the three-coordinate models. */
static double chord(const orb_geometry *geometry, orb_point p, orb_point q) {
    double a[3], b[3], low[3];
    geometry_coordinates(geometry, p, a, low);
    geometry_coordinates(geometry, q, b, low);
    double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return sqrt(x * x + y * y + geometry_curvature(geometry) * z * z);
}

static void each_geometry(void (*check)(const orb_geometry *, random_state *)) {
    for (int K = -1; K <= 1; K++) {
        random_state state = {12345};
        for (int i = 0; i < 200; i++)
            check(geometry_of_curvature(K), &state);
    }
}

static void exp_inverts_log(const orb_geometry *geometry, random_state *state) {
    orb_point p = point_of(random_in_disk(state, 0.8)), q = point_of(random_in_disk(state, 0.8));
    orb_point back = geometry_exp(geometry, p, geometry_log(geometry, p, q));
    CHECK_NEAR(geometry_distance(geometry, q, back), 0, 1e-13);
    CHECK_NEAR(cabs(geometry_log(geometry, p, q)), geometry_distance(geometry, p, q), 1e-13);
}
TEST(exponential_inverts_logarithm) { each_geometry(exp_inverts_log); }

static void distance_is_the_models(const orb_geometry *geometry, random_state *state) {
    orb_point p = point_of(random_in_disk(state, 0.8)), q = point_of(random_in_disk(state, 0.8));
    double c = chord(geometry, p, q), d = geometry_distance(geometry, p, q);
    double expected = geometry_curvature(geometry) > 0   ? 2 * asin(c / 2)
                      : geometry_curvature(geometry) < 0 ? 2 * asinh(c / 2)
                                                         : c;
    CHECK_NEAR(d, expected, 1e-12);
    CHECK_NEAR(geometry_distance(geometry, q, p), d, 1e-14);
}
TEST(distance_is_that_of_sphere_plane_and_hyperboloid) { each_geometry(distance_is_the_models); }

static void isometries_keep(const orb_geometry *geometry, random_state *state) {
    orb_point p = point_of(random_in_disk(state, 0.6)), q = point_of(random_in_disk(state, 0.6));
    orb_isometry g = random_isometry(geometry, state), h = random_isometry(geometry, state);
    orb_point gp = isometry_apply(geometry, g, p), gq = isometry_apply(geometry, g, q);
    double d = geometry_distance(geometry, p, q);
    CHECK_NEAR(geometry_distance(geometry, gp, gq), d, 1e-12);
    /* the frame turns with the derivative: logarithms go to logarithms */
    double complex moved = isometry_turn(geometry, g, p) * geometry_log(geometry, p, q);
    CHECK_NEAR(cabs(moved - geometry_log(geometry, gp, gq)), 0, 1e-12);
    orb_point composed = isometry_apply(geometry, isometry_compose(geometry, g, h), p);
    orb_point in_turn = isometry_apply(geometry, g, isometry_apply(geometry, h, p));
    CHECK_NEAR(geometry_distance(geometry, composed, in_turn), 0, 1e-12);
    orb_point back = isometry_apply(geometry, isometry_inverse(g), gp);
    CHECK_NEAR(geometry_distance(geometry, back, p), 0, 1e-13);
    CHECK(isometry_same(geometry, isometry_compose(geometry, g, isometry_inverse(g)), isometry_identity(), 1e-13));
    CHECK(!isometry_same(geometry, g, h, 1e-6));
}
TEST(isometries_keep_distances_and_turn_frames) { each_geometry(isometries_keep); }

static void pairings_take(const orb_geometry *geometry, random_state *state) {
    orb_point p = point_of(random_in_disk(state, 0.6)), q = point_of(random_in_disk(state, 0.6));
    orb_isometry g = random_isometry(geometry, state);
    orb_point p1 = isometry_apply(geometry, g, p), q1 = isometry_apply(geometry, g, q);
    orb_isometry found = isometry_pairing(geometry, p, q, p1, q1);
    CHECK(isometry_same(geometry, found, g, 1e-10));
    CHECK_NEAR(geometry_distance(geometry, isometry_apply(geometry, found, p), p1), 0, 1e-25);
    CHECK_NEAR(geometry_distance(geometry, isometry_apply(geometry, found, q), q1), 0, 1e-13);
}
TEST(a_pairing_is_the_isometry_of_two_points) { each_geometry(pairings_take); }

TEST(a_pairing_may_turn_by_half_a_circle) {
    for (int K = -1; K <= 1; K++) {
        const orb_geometry *geometry = geometry_of_curvature(K);
        for (double angle = pi - 1e-9; angle < pi + 2e-9; angle += 1e-9) {
            orb_point q = point_of(0.5), q1 = point_of(0.5 * cexp(I * angle)), origin = point_of(0);
            orb_isometry g = isometry_pairing(geometry, origin, q, origin, q1);
            CHECK_NEAR(geometry_distance(geometry, isometry_apply(geometry, g, q), q1), 0, 1e-15);
        }
    }
}

/* Derivatives of d^2 / 2 along geodesics, against central differences. */
static void derivatives(const orb_geometry *geometry, random_state *state) {
    orb_point p = point_of(random_in_disk(state, 0.6)), q = point_of(random_in_disk(state, 0.6));
    double complex v = random_in_disk(state, 1), w = random_in_disk(state, 1);
    orb_edge_terms edge = geometry_edge(geometry, p, q);
    double step = 1e-4, value[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double d = geometry_distance(geometry, geometry_exp(geometry, p, (i - 1) * step * v),
                                         geometry_exp(geometry, q, (j - 1) * step * w));
            value[i][j] = d * d / 2;
        }
    double slope_p = (value[2][1] - value[0][1]) / (2 * step), slope_q = (value[1][2] - value[1][0]) / (2 * step);
    double d = edge.distance, along = creal(conj(edge.at_p) * v), across = cimag(conj(edge.at_p) * v);
    double along_q = creal(conj(edge.at_q) * w), across_q = cimag(conj(edge.at_q) * w);
    CHECK_NEAR(slope_p, -d * along, 1e-6);
    CHECK_NEAR(slope_q, d * along_q, 1e-6);
    double second = (value[2][1] - 2 * value[1][1] + value[0][1]) / (step * step);
    CHECK_NEAR(second, along * along + edge.C * across * across, 1e-5 * (1 + edge.C));
    double mixed = (value[2][2] - value[2][0] - value[0][2] + value[0][0]) / (4 * step * step);
    CHECK_NEAR(mixed, -(along * along_q + edge.S * across * across_q), 1e-5 * (1 + edge.S));
}
TEST(gradient_and_hessian_against_finite_differences) { each_geometry(derivatives); }

TEST(short_edges_have_the_planes_hessian) {
    for (int K = -1; K <= 1; K++) {
        const orb_geometry *geometry = geometry_of_curvature(K);
        orb_edge_terms none = geometry_edge(geometry, point_of(0.25), point_of(0.25));
        CHECK(none.distance == 0 && none.C == 1 && none.S == 1);
        orb_edge_terms tiny = geometry_edge(geometry, point_of(0.25), point_of(0.25 + 1e-12));
        CHECK_NEAR(tiny.C, 1, 1e-15);
        CHECK_NEAR(cabs(tiny.at_p), 1, 1e-15);
        CHECK_NEAR(cabs(tiny.at_q - tiny.at_p), 0, 1e-11);
    }
}

/* Area against the angle sum, and its sign. */
static void areas(const orb_geometry *geometry, random_state *state) {
    orb_point p[3];
    for (int c = 0; c < 3; c++)
        p[c] = point_of(random_in_disk(state, 0.6));
    double complex s = geometry_toward(geometry, p[0], p[1]), t = geometry_toward(geometry, p[0], p[2]);
    double area = geometry_triangle_area(geometry, s, t), sum = 0;
    CHECK_NEAR(geometry_triangle_area(geometry, t, s), -area, 1e-14);
    for (int c = 0; c < 3; c++) {
        double complex u = geometry_toward(geometry, p[c], p[(c + 1) % 3]);
        double complex v = geometry_toward(geometry, p[c], p[(c + 2) % 3]);
        sum += carg(conj(u) * v);
    }
    double excess = fabs(sum) - pi;
    CHECK_NEAR(excess, geometry_curvature(geometry) * fabs(area), 1e-11);
    if (geometry_curvature(geometry) == 0)
        CHECK_NEAR(area, 2 * cimag(conj(p[1].z - p[0].z) * (p[2].z - p[0].z)), 1e-14);
}
TEST(area_is_the_angle_excess) { each_geometry(areas); }

/* Weights of a point, the point of these weights, and how it moves with them. */
static void weights(const orb_geometry *geometry, random_state *state) {
    orb_point corner[3], p;
    double given[3], sum = 0, found[3], sine[3], model[3] = {0}, value[3], low[3];
    for (int k = 0; k < 3; k++) {
        corner[k] = point_of(random_in_disk(state, 0.6));
        sum += given[k] = 0.01 + random_unit(state);
    }
    double complex s = geometry_toward(geometry, corner[0], corner[1]);
    double complex t = geometry_toward(geometry, corner[0], corner[2]);
    if (cimag(conj(s) * t) < 0.05 * cabs(s) * cabs(t))
        return; /* clockwise, or a sliver */
    for (int k = 0; k < 3; k++) {
        given[k] /= sum;
        geometry_coordinates(geometry, corner[k], value, low);
        for (int i = 0; i < 3; i++)
            model[i] += given[k] * value[i];
    }
    p = geometry_between(geometry, corner, given);
    geometry_coordinates(geometry, p, value, low);
    CHECK_NEAR(model[0] * value[2] - model[2] * value[0], 0, 1e-12);
    CHECK_NEAR(model[1] * value[2] - model[2] * value[1], 0, 1e-12);
    const orb_isometry h = random_isometry(geometry, state);
    for (int k = 0; k < 3; k++)
        corner[k] = isometry_apply(geometry, h, corner[k]);
    p = isometry_apply(geometry, h, p);
    geometry_locate(geometry, p, corner, found, sine);
    for (int k = 0; k < 3; k++) {
        CHECK_NEAR(found[k], given[k], 1e-11);
        CHECK(sine[k] > 0);
    }
    const double step = 1e-6, moved[3] = {given[0] - step, given[1] + step, given[2]};
    double complex slope[3], by = geometry_log(geometry, p, geometry_between(geometry, corner, moved));
    geometry_slopes(geometry, p, corner, given, slope);
    CHECK_NEAR(cabs(by / step - (slope[1] - slope[0])), 0, 1e-3);
    orb_point beyond = geometry_exp(geometry, p, 1.5 * geometry_log(geometry, p, corner[0]));
    geometry_locate(geometry, beyond, corner, found, sine);
    CHECK(sine[1] < 0 || sine[2] < 0);
    geometry_locate(geometry, corner[1], corner, found, sine);
    CHECK(found[0] == 0 && found[1] == 1 && found[2] == 0);
}
TEST(weights_in_triangles) { each_geometry(weights); }

static void convex_chart(const orb_geometry *geometry, random_state *state) {
    orb_point p = point_of(random_in_disk(state, 0.9));
    orb_point back = geometry_from_convex_chart(geometry, geometry_convex_chart(geometry, p));
    CHECK_NEAR(cabs(back.z - p.z), 0, 1e-14);
}
TEST(convex_chart_and_back) { each_geometry(convex_chart); }

TEST(convex_charts_of_geodesics_bulge_outwards_or_are_straight) {
    for (int K = -1; K <= 1; K++) {
        const orb_geometry *geometry = geometry_of_curvature(K);
        orb_point p = point_of(0.5), q = point_of(0.5 * I);
        orb_point middle = geometry_exp(geometry, p, 0.5 * geometry_log(geometry, p, q));
        double complex a = geometry_convex_chart(geometry, p), b = geometry_convex_chart(geometry, q);
        double outside = cabs(geometry_convex_chart(geometry, middle)) - cabs((a + b) / 2);
        if (K > 0)
            CHECK(outside > 0.01);
        else
            CHECK_NEAR(outside, 0, 1e-15);
    }
}

/* Far out in the hyperbolic plane, neighbours 1e-9 apart at distance 24 from the origin are still told apart. */
TEST(far_points_keep_full_precision) {
    const orb_geometry *geometry = geometry_of_curvature(-1);
    orb_point origin = point_of(0), halfway = geometry_exp(geometry, origin, 12);
    orb_point far = geometry_exp(geometry, halfway, 12 * geometry_transport(geometry, origin, halfway));
    orb_point near = geometry_exp(geometry, far, 1e-9 * cexp(I));
    CHECK_NEAR(geometry_distance(geometry, halfway, far), 12, 1e-9);
    CHECK_NEAR(geometry_distance(geometry, far, near) / 1e-9, 1, 1e-6);
    orb_isometry home = isometry_to_origin(geometry, far);
    CHECK_NEAR(geometry_distance(geometry, isometry_apply(geometry, home, far), origin), 0, 1e-15);
    CHECK_NEAR(geometry_distance(geometry, isometry_apply(geometry, home, near), origin) / 1e-9, 1, 1e-6);
}
