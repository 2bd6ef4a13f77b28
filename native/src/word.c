/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "word.h"

#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

orb_status word_create(int32_t n_sides, int32_t n_nodes, orb_word **result, orb_error *error) {
    *result = NULL;
    orb_word *word = calloc(1, sizeof *word);
    if (!word)
        return error_memory(error);
    size_t sides = (size_t)n_sides + 1, nodes = (size_t)n_nodes + 1;
    word->n_sides = n_sides;
    word->n_nodes = n_nodes;
    word->node = calloc(sides, sizeof *word->node);
    word->partner = calloc(sides, sizeof *word->partner);
    word->same_way = calloc(sides, sizeof *word->same_way);
    word->order = calloc(nodes, sizeof *word->order);
    word->valence = calloc(nodes, sizeof *word->valence);
    word->first = calloc(nodes, sizeof *word->first);
    word->on_mirror = calloc(nodes, sizeof *word->on_mirror);
    if (!word->node || !word->partner || !word->same_way || !word->order || !word->valence || !word->first ||
        !word->on_mirror) {
        word_free(word);
        return error_memory(error);
    }
    *result = word;
    return ORB_OK;
}

void word_finish(orb_word *word) {
    for (int32_t n = 0; n < word->n_nodes; n++) {
        word->valence[n] = 0;
        word->first[n] = -1;
        word->on_mirror[n] = false;
    }
    for (int32_t s = 0; s < word->n_sides; s++) {
        int32_t n = word->node[s];
        bool beside = word_is_mirror(word, s) || word_is_mirror(word, word_previous(word, s));
        if (word->first[n] < 0 || (beside && !word->on_mirror[n]))
            word->first[n] = s;
        word->valence[n]++;
        word->on_mirror[n] = word->on_mirror[n] || beside;
    }
}

void word_free(orb_word *word) {
    if (!word)
        return;
    free(word->node);
    free(word->partner);
    free(word->same_way);
    free(word->order);
    free(word->valence);
    free(word->first);
    free(word->on_mirror);
    free(word);
}

orb_status word_copy(const orb_word *word, orb_word **copy, orb_error *error) {
    orb_status status = word_create(word->n_sides, word->n_nodes, copy, error);
    if (status != ORB_OK)
        return status;
    size_t sides = (size_t)word->n_sides, nodes = (size_t)word->n_nodes;
    memcpy((*copy)->node, word->node, sides * sizeof *word->node);
    memcpy((*copy)->partner, word->partner, sides * sizeof *word->partner);
    memcpy((*copy)->same_way, word->same_way, sides * sizeof *word->same_way);
    memcpy((*copy)->order, word->order, nodes * sizeof *word->order);
    word_finish(*copy);
    return ORB_OK;
}

int32_t word_glued_start(const orb_word *word, int32_t side) {
    int32_t partner = word->partner[side];
    return word->same_way[side] ? partner : word_next(word, partner);
}

int32_t word_glued_end(const orb_word *word, int32_t side) {
    int32_t partner = word->partner[side];
    return word->same_way[side] ? word_next(word, partner) : partner;
}

double word_angle(const orb_word *word, int32_t corner) {
    int32_t n = word->node[corner];
    return (word->on_mirror[n] ? pi : 2 * pi) / ((double)word->order[n] * word->valence[n]);
}

orb_status word_of_cones(int32_t n_cones, const int32_t *orders, orb_word **result, orb_error *error) {
    int32_t n_sides = 2 * n_cones - 2;
    orb_status status = word_create(n_sides, n_cones, result, error);
    if (status != ORB_OK)
        return status;
    orb_word *word = *result;
    for (int32_t s = 0; s < n_sides; s++) {
        word->node[s] = s < n_cones ? s : n_sides - s;
        word->partner[s] = n_sides - 1 - s;
    }
    memcpy(word->order, orders, (size_t)n_cones * sizeof *orders);
    word_finish(word);
    return ORB_OK;
}

bool word_is_path(const orb_word *word) {
    if (word->n_sides != 2 * word->n_nodes - 2)
        return false;
    for (int32_t s = 0; s < word->n_sides; s++)
        if (word->partner[s] != word->n_sides - 1 - s || word->same_way[s] ||
            word->node[s] != (s < word->n_nodes ? s : word->n_sides - s))
            return false;
    return true;
}

/* A word that is being written from its first side on. */
typedef struct writer {
    orb_word *word;
    int32_t side, node; /* how many are written */
} writer;

static int32_t write_node(writer *w, int32_t order) {
    w->word->order[w->node] = order;
    return w->node++;
}

/* A side that starts in `node`. Glued to an earlier side, or, -1, a mirror until it is glued. */
static int32_t write_side(writer *w, int32_t node, int32_t partner, bool same_way) {
    int32_t side = w->side++;
    w->word->node[side] = node;
    w->word->partner[side] = partner < 0 ? side : partner;
    w->word->same_way[side] = partner < 0 || same_way;
    if (partner >= 0) {
        w->word->partner[partner] = side;
        w->word->same_way[partner] = same_way;
    }
    return side;
}

/* The sides of a mirror with these corners, from `node` once round back to it. */
static void write_mirror(writer *w, int32_t node, int32_t n_corners, const int32_t *orders, bool at_corner) {
    write_side(w, node, -1, false);
    for (int32_t i = at_corner; i < n_corners; i++)
        write_side(w, write_node(w, orders[i]), -1, false);
}

/* Everything but the first mirror or cone, as a flower of arcs and loops about `root`. */
static void write_flower(writer *w, const orb_signature *s, int32_t root, int32_t first_cone, int32_t first_mirror) {
    for (int32_t i = first_cone; i < s->n_cones; i++) {
        int32_t arc = write_side(w, root, -1, false);
        write_side(w, write_node(w, s->orders[i]), arc, false);
    }
    for (int32_t m = first_mirror; m < s->n_mirrors; m++) {
        int32_t arc = write_side(w, root, -1, false), n = signature_corners(s, m);
        const int32_t *orders = s->orders + s->mirror_start[m];
        int32_t end = write_node(w, n > 0 ? orders[0] : 1);
        write_mirror(w, end, n, orders, n > 0);
        write_side(w, end, arc, false);
    }
    for (int32_t i = 0; i < s->n_handles; i++) {
        int32_t a = write_side(w, root, -1, false), b = write_side(w, root, -1, false);
        write_side(w, root, a, false);
        write_side(w, root, b, false);
    }
    for (int32_t i = 0; i < s->n_crosscaps; i++)
        write_side(w, root, write_side(w, root, -1, false), true);
}

orb_status word_of_signature(const orb_signature *s, orb_word **result, orb_error *error) {
    *result = NULL;
    if (!signature_is_supported(s))
        return signature_refuse(s, error);
    if (s->n_mirrors == 0 && s->n_handles == 0 && s->n_crosscaps == 0)
        return word_of_cones(s->n_cones, s->orders, result, error);
    int32_t most = 2 * (s->n_cones + s->n_crosscaps) + 4 * s->n_handles + 3 * s->n_mirrors + s->n_corners;
    writer w = {0};
    orb_status status = word_create(most, s->n_cones + s->n_corners + s->n_mirrors + 1, &w.word, error);
    if (status != ORB_OK)
        return status;
    if (s->n_mirrors > 0) {
        int32_t n = signature_corners(s, 0), root = write_node(&w, n > 0 ? s->orders[s->mirror_start[0]] : 1);
        write_mirror(&w, root, n, s->orders + s->mirror_start[0], n > 0);
        write_flower(&w, s, root, 0, 1);
    } else {
        bool cone = s->n_cones > 0;
        write_flower(&w, s, write_node(&w, cone ? s->orders[0] : 1), cone, 0);
    }
    w.word->n_sides = w.side;
    w.word->n_nodes = w.node;
    word_finish(w.word);
    *result = w.word;
    return ORB_OK;
}
