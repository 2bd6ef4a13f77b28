/* Edges that would lie flat on a mirror. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A chord is an edge inside that joins two vertices of one mirror side. Where it can be drawn aside to the mirror, it
 * is mapped onto it, and what lies between has no area. Halved, its midpoint is free to move away. */
#ifndef ORB_CHORDS_H
#define ORB_CHORDS_H

#include "mesh.h"

/* marked[n_edges]: 1 for each chord; `corner` [n_vertices]: the vertices where one mirror side ends and the next one
 * begins. Returns the count through *n_chords. */
orb_status chords_mark(const orb_mesh *mesh, const bool *corner, uint8_t *marked, int32_t *n_chords, orb_error *error);

/* Weights of a refined mesh from those of the mesh it came from: half an edge pulls twice as much, and a new edge as
 * much as the weakest edge of its triangle. `parent` and `halved` as in orb_surface. */
void chords_refine_weights(const orb_mesh *plain, const double *plain_weights, const orb_mesh *refined,
                           const int32_t *parent, const int32_t *halved, double *weights);

#endif
