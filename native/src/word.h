/* How the sides of a polygon are glued. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A surface cut open along a graph is a disk; the edges of the graph are the disk's sides, and its nodes the disk's
 * corners. A side is glued to another one (a ... a^-1, or a ... a where orientation is reversed) or is a mirror, which
 * is a side glued to itself by a reflection. The word alone gives the tile (docs/mathematics.md, section 4). */
#ifndef ORB_WORD_H
#define ORB_WORD_H

#include <stdbool.h>

#include "signature.h"

typedef struct orb_word {
    int32_t n_sides, n_nodes;
    int32_t *node;    /* [n_sides] the node that corner s is a copy of; side s runs from corner s to s + 1 */
    int32_t *partner; /* [n_sides] the side that s is glued to; s itself: a mirror */
    bool *same_way;   /* [n_sides] both run the same way round, so that gluing reverses orientation; true of mirrors */
    int32_t *order;   /* [n_nodes] of a cone or mirror corner; 1: neither */
    int32_t *valence; /* [n_nodes] how many corners are its copies */
    int32_t *first;   /* [n_nodes] the corner that stands for it: the lowest one, on a mirror one beside a mirror */
    bool *on_mirror;  /* [n_nodes] */
} orb_word;

/* Room for a word, to be filled in (node, partner, same_way, order) and completed by word_finish. */
orb_status word_create(int32_t n_sides, int32_t n_nodes, orb_word **word, orb_error *error);
void word_finish(orb_word *word);
void word_free(orb_word *word);
orb_status word_copy(const orb_word *word, orb_word **copy, orb_error *error);

static inline int32_t word_next(const orb_word *word, int32_t side) { return (side + 1) % word->n_sides; }
static inline int32_t word_previous(const orb_word *word, int32_t side) {
    return (side + word->n_sides - 1) % word->n_sides;
}
static inline bool word_is_mirror(const orb_word *word, int32_t side) { return word->partner[side] == side; }

/* The corner on the other side of the gluing: where corner `side` (the start of the side) or the one after it goes. */
int32_t word_glued_start(const orb_word *word, int32_t side);
int32_t word_glued_end(const orb_word *word, int32_t side);

/* The angle that the tile has at a corner: 2 pi / (order valence), pi / (order valence) on a mirror. */
double word_angle(const orb_word *word, int32_t corner);

/* A sphere cut along a path through its cones in turn: nodes 0 ... k - 1 at corners 0 ... k - 1, then k - 2 ... 1. */
orb_status word_of_cones(int32_t n_cones, const int32_t *orders, orb_word **word, orb_error *error);
bool word_is_path(const orb_word *word);

/* The simplest cut of a signature's orbifold: a sphere along a path; else arcs and loops from a corner or point of the
 * first mirror, from the first cone, or from an ordinary point. ORB_UNSUPPORTED_SIGNATURE for *, x and a plain
 * sphere. */
orb_status word_of_signature(const orb_signature *signature, orb_word **word, orb_error *error);

#endif
