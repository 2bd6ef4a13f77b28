/* The tile of a signature's simplest cut, for drawings. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Gives orb_signature_tile (orbifold.h). */
#include <stddef.h>

#include "tile.h"

/* One more point, if there is room for it. */
static void add_point(const orb_tile *tile, orb_point p, bool mirror, double *points, bool *mirrors, int32_t capacity,
                      int32_t *n) {
    double low[3];
    if (*n < capacity) {
        geometry_coordinates(tile->geometry, p, points + 3 * (size_t)*n, low);
        mirrors[*n] = mirror;
    }
    ++*n;
}

orb_status orb_signature_tile(const char *text, double *points, bool *mirrors, int32_t capacity, int32_t *n_corners,
                              orb_error *error) {
    if (!n_corners || capacity < 0 || (capacity > 0 && (!points || !mirrors)))
        return error_set(error, ORB_BAD_ARGUMENT, "orb_signature_tile needs arrays to fill and a place for the count");
    orb_signature *signature = NULL;
    orb_word *word = NULL;
    orb_tile *tile = NULL;
    orb_status status = signature_parse(text, &signature, error);
    if (status == ORB_OK)
        status = word_of_signature(signature, &word, error);
    if (status == ORB_OK)
        status = tile_create(word, signature->curvature, &tile, error);
    int32_t n = 0;
    for (int32_t c = 0; status == ORB_OK && c < word->n_sides; c++) {
        bool mirror = word_is_mirror(word, c);
        orb_point p = tile->corners[c], q = tile->corners[word_next(word, c)];
        add_point(tile, p, mirror, points, mirrors, capacity, &n);
        if (geometry_is_antipodal(tile->geometry, p, q))
            add_point(tile, geometry_exp(tile->geometry, p, tile->sides[c] / 2), mirror, points, mirrors, capacity, &n);
    }
    *n_corners = n;
    tile_free(tile);
    word_free(word);
    signature_free(signature);
    return status;
}
