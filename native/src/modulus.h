/* The affine freedom of a tile. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The harmonic map for one tile shape is an affine image of that for any other, since the linear parts of 2222's
 * pairings, +1 and -1, commute with every linear map. So the shape is chosen after the solve, by least conformal
 * energy (2015, eq. 13), area weighted. */
#ifndef ORB_MODULUS_H
#define ORB_MODULUS_H

#include "embedding.h"

/* Deforms tile, isometries of the copies and positions alike, keeping the tile's area; true if it did. The copies must
 * be placed, and must be placed anew afterwards. A rigid tile is left alone. */
bool modulus_choose(orb_embedding *embedding);

#endif
