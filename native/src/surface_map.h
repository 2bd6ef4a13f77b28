/* Two embeddings -> where each point of one is on the other. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_SURFACE_MAP_H
#define ORB_SURFACE_MAP_H

#include "cover.h"
#include "orbifold_maps.h"

/* The source laid over the target: what all points start from. */
typedef struct orb_overlay {
    orb_cover cover;
    orb_sheet *sheet; /* [source triangles] near each of them */
    orb_spot *spot;   /* [source vertices]; of isolated ones sheet.triangle is -1 */
    int32_t *queue;
} orb_overlay;

/* Locates the source's vertices, each from a neighbour's triangle. Errors: tile_map_find's, ORB_POINT_NOT_FOUND,
 * ORB_OUT_OF_MEMORY. overlay_clear in any case. */
orb_status overlay_create(const orb_embedding *source, const orb_embedding *target, orb_overlay *overlay,
                          orb_error *error);
void overlay_clear(orb_overlay *overlay);

/* A point with these weights in a triangle of the source. Errors: the same. */
orb_status overlay_locate(orb_overlay *overlay, int32_t triangle, const double weight[3], orb_spot *spot,
                          orb_error *error);

#endif
