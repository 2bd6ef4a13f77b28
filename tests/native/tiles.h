/* Tiles for tests. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef TILES_H
#define TILES_H

#include "tile.h"

/* The tile of a sphere with these cones, cut along a path through them. */
static inline orb_status tile_of_cones(int curvature, int32_t k, const int32_t *orders, orb_tile **tile,
                                       orb_error *error) {
    orb_word *word = NULL;
    orb_status status = word_of_cones(k, orders, &word, error);
    if (status == ORB_OK)
        status = tile_create(word, curvature, tile, error);
    word_free(word);
    return status;
}

#endif
