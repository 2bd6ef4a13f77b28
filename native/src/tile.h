/* Orders -> a polygon whose sides are glued in pairs. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_TILE_H
#define ORB_TILE_H

#include "geometry.h"
#include "error.h"

/* The tile of a sphere with cones c_1 ... c_k, cut along a path c_1 -> ... -> c_k. Its boundary, counter-clockwise:
 * c_1, ..., c_k on the left bank of the path, then c_(k-1), ..., c_2 on its right bank. Segment s (from 1) of the
 * path joins c_s to c_(s+1); pairing s takes its left bank to its right bank. Pairing 0 is the identity. */
typedef struct orb_tile {
    const orb_geometry *geometry;
    int32_t n_cones;
    int32_t *orders;        /* [n_cones] */
    orb_point *corners;     /* [2*n_cones - 2] counter-clockwise, as above */
    int32_t n_pairings;     /* n_cones: the identity and one for each segment */
    orb_isometry *pairings; /* [n_pairings] */
    double complex *sides;  /* [n_cones-1] the vector along the side c_s c_(s+1) of the left bank, at c_s */
    bool rotates;           /* a free rotation about c_1 (two cones) */
    bool deforms;           /* the tile has an affine modulus, found after the solve (2222) */
} orb_tile;

orb_status tile_create(int curvature, int32_t n_cones, const int32_t *orders, orb_tile **tile, orb_error *error);
void tile_free(orb_tile *tile);

/* Area of the tile: 2 pi |chi| by Gauss and Bonnet, and 1 in the plane. */
double tile_area(const orb_tile *tile, double euler);

#endif
