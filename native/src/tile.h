/* Boundary word -> a polygon whose sides are glued by isometries. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_TILE_H
#define ORB_TILE_H

#include "geometry.h"
#include "word.h"

/* Corner s is where side s starts; counter-clockwise. Pairing s takes side s to its partner and the tile to the other
 * side of that; a mirror's is the reflection in it. */
typedef struct orb_tile {
    const orb_geometry *geometry;
    orb_word *word;
    orb_point *corners;      /* [n_sides] */
    double complex *sides;   /* [n_sides] the vector along side s, at corner s */
    orb_isometry *pairings;  /* [n_sides] */
    orb_isometry *lines;     /* [n_sides] takes the real axis to the geodesic of side s, the origin to corner s */
    orb_isometry *elements;  /* [n_sides] corner s is this element's image of its node's first corner */
    double area;             /* 2 pi |chi| (Gauss and Bonnet), 1 in the plane; of a fixed polygon its own */
    bool fixed;              /* a polygon whose boundary does not move, no orbifold's tile */
} orb_tile;

/* The polygon with the word's angles that has an inscribed circle, about the origin; a sphere cut along a path gets
 * the polygon with angles pi / n_i doubled (2016, section 4). Exists and is unique for all words of good orbifolds of
 * the sphere, up to scale in the plane, and in the hyperbolic plane (docs/mathematics.md, section 4). */
orb_status tile_create(const orb_word *word, int curvature, orb_tile **tile, orb_error *error);

/* A convex polygon with these corners, counter-clockwise, whose boundary does not move: every side is fixed. */
orb_status tile_of_polygon(int curvature, int32_t n, const orb_point *corners, orb_tile **tile, orb_error *error);

void tile_free(orb_tile *tile);

/* Interior angle at a corner, of the word's or, for a fixed polygon, its own. */
double tile_angle(const orb_tile *tile, int32_t corner);

#endif
