/* Tiles of spheres with cones. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * One construction serves all of them (docs/mathematics.md, section 4): the polygon with angles pi / n_i that has an
 * inscribed circle, doubled over its side c_k c_1. Everything is written with the curvature K as a number:
 * sin_K^2 = s stands for sin^2 r, r^2 or sinh^2 r, and cos_K r = sqrt(1 - K s). */
#include "tile.h"

#include <math.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

/* The angle at the centre between a corner of half angle `half` and the tangent points beside it: in the right
 * triangle centre, tangent point, corner, cos(half) = cos_K(r) sin(phi). */
static double angle_at_centre(int K, double s, double half) {
    return atan2(cos(half), sqrt(fmax(0, sin(half) * sin(half) - K * s)));
}

static double excess_at_centre(int K, double s, int32_t k, const int32_t *orders) {
    double sum = -pi;
    for (int32_t i = 0; i < k; i++)
        sum += angle_at_centre(K, s, pi / (2 * orders[i]));
    return sum;
}

/* s = sin_K^2 of the inscribed circle's radius, to the last digit, by bisection: the angles at the centre must add up
 * to a full turn; their sum is monotone in s. In the plane any s will do, and the tile gets unit area. */
static double inscribed_circle(int K, int32_t k, const int32_t *orders) {
    if (K == 0) {
        double sum = 0; /* area of the doubled polygon: 2 r^2 sum of cot(half) */
        for (int32_t i = 0; i < k; i++)
            sum += 1 / tan(pi / (2 * orders[i]));
        return 1 / (2 * sum);
    }
    double low = 0, high = 1;
    if (K > 0) {
        for (int32_t i = 0; i < k; i++) /* the circle must fit into every angle */
            high = fmin(high, pow(sin(pi / (2 * orders[i])), 2));
    } else {
        while (excess_at_centre(K, high, k, orders) > 0)
            high *= 2;
    }
    for (;;) {
        double middle = low + (high - low) / 2;
        if (!(middle > low && middle < high))
            return high;
        if (K * excess_at_centre(K, middle, k, orders) < 0)
            low = middle;
        else
            high = middle;
    }
}

/* Corners c_1 ... c_k counter-clockwise in the closed upper half plane, c_k and c_1 on the real axis left and right of
 * the origin, which is where the inscribed circle touches the side c_k c_1. `touch` [k]: the tangent points of the
 * sides c_i c_(i+1). */
static void place_corners(const orb_geometry *geometry, int32_t k, const int32_t *orders, orb_point *corners,
                          orb_point *touch) {
    int K = geometry_curvature(geometry);
    double s = inscribed_circle(K, k, orders), cos_r = sqrt(1 - K * s), sin_r = sqrt(s);
    double half_r = sin_r / (1 + cos_r), direction = -pi / 2; /* half_r = tan_K(r / 2) */
    orb_isometry down = isometry_to_origin(geometry, point_of(CMPLX(0, -half_r)));
    for (int32_t i = 0; i < k; i++) {
        double half = pi / (2 * orders[i]), phi = angle_at_centre(K, s, half);
        double sin_tau = sin_r / cos_r / tan(half), cos_tau = cos(phi) / sin(half); /* tau: corner to tangent point */
        double radius = sin_tau / sin(phi) / (1 + cos_r * cos_tau); /* tan_K of half the corner's distance */
        direction += phi;
        corners[i] = isometry_apply(geometry, down, point_of(radius * CMPLX(cos(direction), sin(direction))));
        direction += phi;
        touch[i] = isometry_apply(geometry, down, point_of(half_r * CMPLX(cos(direction), sin(direction))));
    }
    corners[0] = point_of(creal(corners[0].z));
    corners[k - 1] = point_of(creal(corners[k - 1].z));
}

orb_status tile_create(int curvature, int32_t n_cones, const int32_t *orders, orb_tile **result, orb_error *error) {
    *result = NULL;
    size_t k = (size_t)n_cones;
    orb_status status = error_memory(error);
    orb_point *touch = malloc(k * sizeof *touch);
    orb_tile *tile = calloc(1, sizeof *tile);
    if (!tile || !touch)
        goto done;
    tile->geometry = geometry_of_curvature(curvature);
    tile->n_cones = tile->n_pairings = n_cones;
    tile->rotates = n_cones == 2;
    tile->deforms = curvature == 0 && n_cones == 4;
    tile->orders = malloc(k * sizeof *tile->orders);
    tile->corners = malloc((2 * k - 2) * sizeof *tile->corners);
    tile->pairings = malloc(k * sizeof *tile->pairings);
    tile->sides = malloc(k * sizeof *tile->sides);
    if (!tile->orders || !tile->corners || !tile->pairings || !tile->sides)
        goto done;
    for (size_t i = 0; i < k; i++)
        tile->orders[i] = orders[i];
    place_corners(tile->geometry, n_cones, orders, tile->corners, touch);
    for (size_t i = 1; i + 1 < k; i++)
        tile->corners[2 * k - 2 - i] = point_conjugate(tile->corners[i]);
    tile->pairings[0] = isometry_identity();
    for (size_t s = 1; s < k; s++) {
        /* The poles of a lune are antipodal and give no direction: there, the tangent point of the side does. */
        orb_point p = tile->corners[s - 1], q = k > 2 ? tile->corners[s] : touch[s - 1];
        tile->sides[s - 1] = (k > 2 ? 1 : 2) * geometry_log(tile->geometry, p, q);
        tile->pairings[s] = isometry_pairing(tile->geometry, p, q, point_conjugate(p), point_conjugate(q));
    }
    status = error_set(error, ORB_OK, "%s", "");
    *result = tile;
    tile = NULL;
done:
    free(touch);
    tile_free(tile);
    return status;
}

void tile_free(orb_tile *tile) {
    if (!tile)
        return;
    free(tile->orders);
    free(tile->corners);
    free(tile->pairings);
    free(tile->sides);
    free(tile);
}

double tile_area(const orb_tile *tile, double euler) {
    int K = geometry_curvature(tile->geometry);
    return K == 0 ? 1 : 2 * pi * euler * K;
}
