/* Two tiles -> how one lies on the other. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Corresponding cuts give words that are the same up to where they begin, and so tiles that are the same up to an
 * isometry; tiles of the plane, whose shape is free, up to an affine map (modulus.h). */
#ifndef ORB_TILE_MAP_H
#define ORB_TILE_MAP_H

#include "embedding.h"

typedef struct orb_tile_map {
    const orb_geometry *geometry;
    bool identity;
    bool affine; /* z -> a z + b conj(z) + c, else */
    double complex a, b, c;
    orb_isometry isometry; /* this */
    double residual;       /* the farthest that an image of a corner is from its counterpart */
} orb_tile_map;

/* The cones, in the sequence in which they were picked, must correspond. Where several ways to turn one word onto the
 * other would do, one is chosen so that maps between three meshes agree. Error: ORB_NO_CORRESPONDENCE,
 * ORB_OUT_OF_MEMORY. */
orb_status tile_map_find(const orb_embedding *source, const orb_embedding *target, orb_tile_map *map, orb_error *error);

orb_point tile_map_point(const orb_tile_map *map, orb_point p);
/* map h map^-1, for an h of the source's group */
orb_isometry tile_map_element(const orb_tile_map *map, orb_isometry h);

#endif
