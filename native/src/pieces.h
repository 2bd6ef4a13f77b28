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

/* A side of an input triangle is embedded as one side of a piece, or two. */
typedef struct orb_side_part {
    int32_t piece, from, to; /* the piece, and its corners at both ends */
    double at[2];            /* of these, along the side: 0 at its first corner */
} orb_side_part;

/* The parts of the side that begins with this corner of all corners of the input, in turn. Returns their number. */
int pieces_of_side(const orb_embedding *embedding, int32_t corner, orb_side_part parts[2]);

#endif
