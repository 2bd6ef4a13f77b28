/* Points of the input mesh <-> points of the mesh that was embedded. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Where chords were halved, an input triangle is embedded in pieces, and a filled hole is no part of the input. On each
 * piece a point of the input is the same linear combination of the corners in space. */
#ifndef ORB_PIECES_H
#define ORB_PIECES_H

#include "embedding.h"

/* The embedded triangle in which a point of an input triangle lies, and its weights there. */
void pieces_find(const orb_embedding *embedding, int32_t triangle, const double barycentric[3], int32_t *piece,
                 double weight[3]);

/* And back; in a filled hole *triangle is -1 and barycentric zero. */
void pieces_join(const orb_embedding *embedding, int32_t piece, const double weight[3], int32_t *triangle,
                 double barycentric[3]);

#endif
