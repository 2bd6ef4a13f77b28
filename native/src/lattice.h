/* The translations of a plane group, and the cell that a repeating image fills.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_LATTICE_H
#define ORB_LATTICE_H

#include "tile.h"

/* Coordinates here are the plane's usual ones, w = 2 z (geometry.h). The cell is the parallelogram at `origin`, the
 * first of the cones (and corners) of greatest order, spanned by side[0] and side[1], counter-clockwise:
 *     a fourfold centre:              the square that spans the lattice of translations
 *     a three- or sixfold centre:     the rectangle 1 : sqrt(3), two cells of the lattice
 *     else, mirrors or glides:        the rectangle along them, one or (*x, 2*22) two cells
 *     else (2222, o):                 a reduced basis of the lattice, which is the one of least shear
 * Of those that the rotations make equal, side[0] is the one that points most to the right. */
typedef struct orb_cell {
    orb_point origin; /* z of the cone */
    double complex side[2];
} orb_cell;

/* Generators of the translation lattice of the group that the tile's side pairings generate, by Schreier's lemma,
 * reduced to a basis of shortest vectors, counter-clockwise; *rotations: the order of the rotation parts; *axis: the
 * direction of a mirror or glide, 0 without one. Error: ORB_BAD_ARGUMENT if the pairings are not those of one of the 17
 * plane groups. */
orb_status lattice_create(const orb_tile *tile, double complex basis[2], int *rotations, double complex *axis,
                          orb_error *error);

orb_status lattice_cell(const orb_tile *tile, orb_cell *cell, orb_error *error);

/* Coordinates u + i v of a point in the cell's basis; the origin is 0. */
double complex lattice_coordinates(const orb_cell *cell, orb_point p);

#endif
