/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "modulus.h"

#include <math.h>

#include "distortion.h"

static const double longest_tile = 1e7;

/* y -> a y + b conj(y) */
typedef struct linear {
    double complex a, b;
} linear;

static orb_point deformed(linear map, orb_point p) { return point_linear(map.a, map.b, p); }

/* An isometry of the plane whose linear part is +1 or -1: that commutes with the map, so only its translation, the
 * image of the origin, is deformed. */
static orb_isometry deformed_isometry(const orb_geometry *geometry, linear map, orb_isometry h) {
    orb_point shift = deformed(map, isometry_apply(geometry, h, point_of(0)));
    orb_isometry turn = {h.a, point_of(0)};
    return isometry_compose(geometry, isometry_inverse(isometry_to_origin(geometry, shift)), turn);
}

/* The eigenvector of eq. 13 in closed form. With M the sum of area J J', m = trace(M) / 2, A the image's area and
 * nu = M11 - M22 + 2 i M12, the conformal energy of y -> a y + b conj(y) is
 *     |a|^2 (m - A) + |b|^2 (m + A) + Re(a conj(b) nu),
 * a Hermitian form in (a, b); rotations do not change it, so a may be real. Slivers can ask for a tile of any length;
 * past 1e7 times its width the image's area would lose the digits that the certificate wants. */
static linear least_conformal(const double covariance[3], double area) {
    double complex nu = CMPLX(covariance[0] - covariance[2], 2 * covariance[1]);
    double half = fmin(cabs(nu) / 2, longest_tile * area), sum = area + hypot(area, half), b = half / sum;
    double shrink = sqrt(sum / (2 * area)); /* 1 / sqrt(1 - b^2): keeps the area */
    linear map = {shrink, half > 0 ? -shrink * b * nu / cabs(nu) : 0};
    return map;
}

bool modulus_choose(orb_embedding *embedding) {
    orb_tile *tile = embedding->tile;
    orb_copies *copies = embedding->copies;
    if (!tile->deforms)
        return false;
    double covariance[3];
    distortion_covariance(embedding, covariance);
    linear map = least_conformal(covariance, tile_area(tile, embedding->signature->euler));
    for (int32_t j = 0; j < 2 * tile->n_cones - 2; j++)
        tile->corners[j] = deformed(map, tile->corners[j]);
    for (int32_t s = 0; s + 1 < tile->n_cones; s++) {
        tile->pairings[s + 1] = deformed_isometry(tile->geometry, map, tile->pairings[s + 1]);
        tile->sides[s] = map.a * tile->sides[s] + map.b * conj(tile->sides[s]);
    }
    for (int32_t i = 0; i < copies->n_isometries; i++)
        copies->isometries[i] = deformed_isometry(tile->geometry, map, copies->isometries[i]);
    for (int32_t v = 0; v < embedding->mesh->n_vertices; v++)
        embedding->position[v] = deformed(map, embedding->position[v]);
    return true;
}
