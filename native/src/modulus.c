/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "modulus.h"

#include <math.h>

#include "distortion.h"

static const double longest_tile = 1e7;
static const double same_direction = 1e-9;

/* y -> a y + b conj(y) */
typedef struct linear {
    double complex a, b;
} linear;

static orb_point deformed(linear map, orb_point p) { return point_linear(map.a, map.b, p); }

/* The linear part of such an isometry commutes with the map, so only its translation, the image of the origin, is
 * deformed. */
static orb_isometry deformed_isometry(const orb_geometry *geometry, linear map, orb_isometry h) {
    orb_point shift = deformed(map, isometry_apply(geometry, h, point_of(0)));
    orb_isometry turn = {h.a, point_of(0), h.reflects};
    return isometry_compose(geometry, isometry_inverse(isometry_to_origin(geometry, shift)), turn);
}

/* How many dimensions of y -> y + b conj(y) commute with the group; of a single one, *axis is b's direction. */
static int count_moduli(const orb_tile *tile, double complex *axis) {
    int moduli = geometry_has_translations(tile->geometry) && !tile->fixed ? 2 : 0;
    for (int32_t s = 0; s < tile->word->n_sides && moduli > 0; s++) {
        double complex a = tile->pairings[s].a.z, turn = a / conj(a); /* y -> turn y, or turn conj(y) */
        if (!tile->pairings[s].reflects) {
            if (fabs(cimag(turn)) > same_direction)
                return 0;
        } else if (moduli == 2) {
            moduli = 1;
            *axis = turn;
        } else if (fabs(cimag(turn * conj(*axis))) > same_direction) {
            return 0;
        }
    }
    return moduli;
}

/* The eigenvector of eq. 13 in closed form. With M the sum of area J J', m = trace(M) / 2, A the image's area and
 * nu = M11 - M22 + 2 i M12, the conformal energy of y -> a y + b conj(y) is
 *     |a|^2 (m - A) + |b|^2 (m + A) + Re(a conj(b) nu),
 * a Hermitian form in (a, b); rotations do not change it, so a may be real. Slivers can ask for a tile of any length;
 * past 1e7 times its width the image's area would lose the digits that the certificate wants. */
static linear least_conformal(const double covariance[3], double area, int moduli, double complex axis) {
    double complex nu = CMPLX(covariance[0] - covariance[2], 2 * covariance[1]);
    if (moduli == 1)
        nu = creal(conj(axis) * nu) * axis;
    double half = fmin(cabs(nu) / 2, longest_tile * area), sum = area + hypot(area, half), b = half / sum;
    double shrink = sqrt(sum / (2 * area)); /* 1 / sqrt(1 - b^2): keeps the area */
    linear map = {shrink, half > 0 ? -shrink * b * nu / cabs(nu) : 0};
    return map;
}

void modulus_choose(orb_embedding *embedding) {
    orb_tile *tile = embedding->tile;
    orb_copies *copies = embedding->copies;
    const orb_geometry *geometry = tile->geometry;
    double covariance[3];
    double complex axis = 1;
    embedding->report.n_moduli = count_moduli(tile, &axis);
    if (embedding->report.n_moduli == 0)
        return;
    distortion_covariance(embedding, covariance);
    linear map = least_conformal(covariance, tile->area, embedding->report.n_moduli, axis);
    for (int32_t s = 0; s < tile->word->n_sides; s++)
        tile->corners[s] = deformed(map, tile->corners[s]);
    for (int32_t s = 0; s < tile->word->n_sides; s++) {
        orb_point p = tile->corners[s], q = tile->corners[word_next(tile->word, s)];
        tile->sides[s] = geometry_log(geometry, p, q);
        tile->lines[s] = isometry_pairing(geometry, point_of(0), point_of(0.5), p, q);
        tile->pairings[s] = deformed_isometry(geometry, map, tile->pairings[s]);
        tile->elements[s] = deformed_isometry(geometry, map, tile->elements[s]);
    }
    for (int32_t i = 0; i < copies->n_isometries; i++)
        copies->isometries[i] = deformed_isometry(geometry, map, copies->isometries[i]);
    for (int32_t v = 0; v < embedding->mesh->n_vertices; v++)
        embedding->position[v] = deformed(map, embedding->position[v]);
}
