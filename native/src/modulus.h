/* The affine freedom of a flat tile. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Linear maps that commute with the linear parts of all side pairings take the harmonic map for one tile to that for
 * another one: all maps where these parts are +1 and -1 (2222, o), stretches along the mirrors or glides where there
 * are reflections with one pair of axes (*2222, 2*22, 22*, 22x, **, *x, xx), else none. So the shape is chosen after
 * the solve, by least conformal energy (2015, eq. 13), area weighted. */
#ifndef ORB_MODULUS_H
#define ORB_MODULUS_H

#include "embedding.h"

/* Deforms tile, isometries of the copies and positions alike, keeping the tile's area; sets report.n_moduli, the real
 * dimensions of the family. The copies must be placed, and must be placed anew afterwards where that is not 0.
 * `covariance`: sum of area J J', J the maps of the triangles: [m11, m12, m22]. */
void modulus_choose(orb_embedding *embedding, const double covariance[3]);

/* The shape of the lattice of translations: report.modulus, 0 where there is none. */
void modulus_report(orb_embedding *embedding);

#endif
