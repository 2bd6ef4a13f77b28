/* The tile of a signature's simplest cut, for drawings. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Gives orb_signature_tile (orbifold.h). */
#include <string.h>

#include "tile.h"

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
    if (status == ORB_OK)
        *n_corners = word->n_sides;
    for (int32_t s = 0; status == ORB_OK && s < word->n_sides && s < capacity; s++) {
        double low[3];
        geometry_coordinates(tile->geometry, tile->corners[s], points + 3 * (size_t)s, low);
        mirrors[s] = word_is_mirror(word, s);
    }
    tile_free(tile);
    word_free(word);
    signature_free(signature);
    return status;
}
