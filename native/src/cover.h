/* Walking in the universal cover of an embedding. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A sheet is a triangle and the group element that takes the source's layout to where that triangle is laid out. Across
 * a seam the element changes. A product of elements that was met before is that element to the last digit, so that
 * going round by different ways does not add up rounding. */
#ifndef ORB_COVER_H
#define ORB_COVER_H

#include "tile_map.h"

typedef struct orb_sheet {
    int32_t triangle, element;
} orb_sheet;

/* A point of the target. */
typedef struct orb_spot {
    orb_sheet sheet;
    double weight[3]; /* geometry_locate's, >= 0 */
} orb_spot;

/* A product that is known. */
typedef struct cover_product {
    int32_t element, kind, from, to; /* element -1: free */
    int32_t product;
} cover_product;

typedef struct orb_cover {
    const orb_embedding *source, *target;
    const orb_geometry *geometry;
    orb_tile_map map;
    double apart; /* elements that move the origin to within this of one another are one */
    int32_t n_elements, room_elements;
    orb_isometry *elements; /* elements[0] is the identity */
    orb_point *images;      /* [n_elements] of the origin */
    int32_t n_products, room_products;
    cover_product *products; /* [room_products], hashed */
    bool *cone[2];           /* [n_vertices] of source and target: inside, so that a copy's element is one of several */
    bool *border[2];         /* [n_vertices] on the boundary */
    orb_point *placed;       /* [source copies] on the target's tile */
    int64_t steps;           /* sides that walks crossed */
} orb_cover;

/* Errors: tile_map_find's. cover_clear in any case. */
orb_status cover_create(const orb_embedding *source, const orb_embedding *target, orb_cover *cover, orb_error *error);
void cover_clear(orb_cover *cover);

/* From a sheet on the source's triangle h / 3 to that of the triangle across h: only the element changes. */
orb_status cover_cross_source(orb_cover *cover, int32_t h, int32_t *element, orb_error *error);

/* From a sheet on the target's triangle h / 3 to the triangle across h, which is not on the boundary. */
orb_status cover_cross_target(orb_cover *cover, int32_t h, orb_sheet *sheet, orb_error *error);

/* Walks from spot->sheet to the triangle that p, on the source's layout in that sheet, lies in. *found: false if there
 * is none, beyond rounding. p goes onto the target's boundary where `boundary`. Error: ORB_OUT_OF_MEMORY. */
orb_status cover_walk(orb_cover *cover, orb_point p, bool boundary, orb_spot *spot, bool *found, orb_error *error);

#endif
