/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "assignment.h"

#include <stdlib.h>
#include <string.h>

static const double most_choices = 3e7; /* that are all tried: a tenth of a second */
enum { MOST_FIXINGS = 2000, STARTS = 12, MOST_PASSES = 50 };

typedef struct search {
    const orb_ground *ground;
    const orb_options *options;
    int32_t n_slots;
    const orb_slot *slots;
    double constant;
    bool *used;      /* [options->n] */
    int32_t *pinned; /* [n_slots] the fixed option of a slot; -1: free */
    int32_t *choice; /* [n_slots] that is being tried */
    double *linear;  /* [(n_slots + 1) * options->n] by depth: linear terms of each option given the slots before */
    orb_site *sites; /* [n_slots] */
    int32_t *best;   /* [n_slots] the caller's */
    double best_value;
    int32_t n_fixings; /* ways of giving the fixed options to slots that were tried */
    bool ordered;      /* the sequence of corners matters */
} search;

/* --- sequence of corners ----------------------------------------------------------------------------------------- */

typedef struct corner {
    int32_t place, order;
} corner;

static int by_place(const void *a, const void *b) {
    return (((const corner *)a)->place > ((const corner *)b)->place) -
           (((const corner *)a)->place < ((const corner *)b)->place);
}

/* Equal up to where one starts and which way it runs. */
static bool same_cycle(int32_t n, const corner *a, const orb_slot *b) {
    for (int32_t start = 0; start < n; start++)
        for (int32_t way = -1; way <= 1; way += 2) {
            int32_t k = 0;
            while (k < n && a[(start + way * k + n) % n].order == b[k].order)
                k++;
            if (k == n)
                return true;
        }
    return false;
}

bool assignment_in_sequence(const orb_ground *ground, int32_t n_slots, const orb_slot *slots, const orb_site *sites) {
    enum { AT_ONCE = 256 };
    corner few[AT_ONCE], *corners = n_slots <= AT_ONCE ? few : malloc((size_t)n_slots * sizeof *corners);
    bool fits = corners != NULL;
    for (int32_t i = 0, j; i < n_slots && fits; i = j) {
        j = i;
        while (j < n_slots && slots[j].kind == slots[i].kind) {
            const int32_t place = ground->boundary->place[sites[j].vertex[0]];
            corners[j - i] = (corner){place, slots[j].order};
            j++;
        }
        if (ground_kind_loop(slots[i].kind) < 0 || ground_kind_is_pair(slots[i].kind))
            continue; /* pairs are only made of corners whose sequence does not matter */
        qsort(corners, (size_t)(j - i), sizeof *corners, by_place);
        fits = same_cycle(j - i, corners, slots + i);
    }
    if (corners != few)
        free(corners);
    return fits;
}

/* Three corners are in any sequence, and so are equal ones. */
static bool sequence_matters(int32_t n_slots, const orb_slot *slots) {
    for (int32_t i = 0; i < n_slots; i++) {
        int32_t n = 0;
        bool mixed = false;
        for (int32_t j = 0; j < n_slots; j++)
            if (slots[j].kind == slots[i].kind && ground_kind_loop(slots[i].kind) >= 0) {
                mixed = mixed || slots[j].order != slots[i].order;
                n++;
            }
        if (mixed && n > 3)
            return true;
    }
    return false;
}

static bool in_sequence(search *s, const int32_t *choice) {
    if (!s->ordered)
        return true;
    for (int32_t i = 0; i < s->n_slots; i++)
        s->sites[i] = s->options->list[choice[i]].site;
    return assignment_in_sequence(s->ground, s->n_slots, s->slots, s->sites);
}

/* --- values ------------------------------------------------------------------------------------------------------ */

static double form(const search *s, int32_t a, int32_t b) {
    return s->options->form[(size_t)a * (size_t)s->options->n + (size_t)b];
}

static double value_of(const search *s, const int32_t *choice) {
    double value = s->constant;
    for (int32_t i = 0; i < s->n_slots; i++) {
        const orb_option *option = s->options->list + choice[i];
        double sum = 2 * option->linear;
        for (int32_t j = 0; j < s->n_slots; j++)
            sum += s->slots[j].charge * form(s, choice[i], choice[j]);
        value += s->slots[i].charge * sum + option->penalty;
    }
    return value;
}

static void options_for(const search *s, int32_t slot, int32_t *first, int32_t *end) {
    *first = s->options->first[s->slots[slot].kind];
    *end = s->options->first[s->slots[slot].kind + 1];
    if (s->pinned[slot] >= 0) {
        *first = s->pinned[slot];
        *end = *first + 1;
    }
}

static void keep_if_better(search *s, double value, const int32_t *choice) {
    if (!(value < s->best_value) || !in_sequence(s, choice))
        return;
    s->best_value = value;
    memcpy(s->best, choice, (size_t)s->n_slots * sizeof *choice);
}

/* --- few slots: all choices -------------------------------------------------------------------------------------- */

/* Alike and both free: one sequence of the two is enough. */
static bool repeats(const search *s, int32_t slot) {
    return slot > 0 && s->pinned[slot] < 0 && s->pinned[slot - 1] < 0 &&
           slots_alike(s->slots + slot, s->slots + slot - 1);
}

static void try_all(search *s, int32_t depth, double value) {
    const orb_options *options = s->options;
    const double *linear = s->linear + (size_t)depth * (size_t)options->n, charge = s->slots[depth].charge;
    int32_t first, end;
    options_for(s, depth, &first, &end);
    if (repeats(s, depth))
        first = s->choice[depth - 1] + 1;
    for (int32_t o = first; o < end; o++) {
        if (s->used[o])
            continue;
        const double with = value + charge * (2 * linear[o] + charge * form(s, o, o)) + options->list[o].penalty;
        if (depth == s->n_slots - 1) {
            if (with < s->best_value) {
                s->choice[depth] = o;
                keep_if_better(s, with, s->choice);
            }
            continue;
        }
        double *next = s->linear + (size_t)(depth + 1) * (size_t)options->n;
        const double *row = options->form + (size_t)o * (size_t)options->n;
        for (int32_t p = 0; p < options->n; p++)
            next[p] = linear[p] + charge * row[p];
        s->choice[depth] = o;
        s->used[o] = true;
        try_all(s, depth + 1, with);
        s->used[o] = false;
    }
}

static double count_choices(const search *s) {
    double count = 1;
    int32_t alike = 1;
    for (int32_t i = 0; i < s->n_slots; i++) {
        int32_t first, end;
        options_for(s, i, &first, &end);
        alike = repeats(s, i) ? alike + 1 : 1;
        count *= (double)(end - first) / alike;
    }
    return count;
}

/* --- many slots: greedily, then exchanges ------------------------------------------------------------------------ */

/* The best free option of a slot, given the options of the others in s->choice (-1: none yet). */
static int32_t best_option(search *s, int32_t slot) {
    int32_t first, end, best = -1;
    double least = INFINITY;
    options_for(s, slot, &first, &end);
    for (int32_t o = first; o < end; o++) {
        if (s->used[o])
            continue;
        double sum = 2 * s->options->list[o].linear + s->slots[slot].charge * form(s, o, o);
        for (int32_t j = 0; j < s->n_slots; j++)
            if (j != slot && s->choice[j] >= 0)
                sum += 2 * s->slots[j].charge * form(s, o, s->choice[j]);
        const double value = s->slots[slot].charge * sum + s->options->list[o].penalty;
        if (value < least) {
            const int32_t before = s->choice[slot];
            bool complete = s->ordered;
            s->choice[slot] = o;
            for (int32_t j = 0; j < s->n_slots; j++)
                complete = complete && s->choice[j] >= 0;
            if (!complete || in_sequence(s, s->choice)) {
                least = value;
                best = o;
            }
            s->choice[slot] = before;
        }
    }
    return best;
}

static void take(search *s, int32_t slot, int32_t option) {
    if (s->choice[slot] >= 0)
        s->used[s->choice[slot]] = false;
    s->choice[slot] = option;
    if (option >= 0)
        s->used[option] = true;
}

static void exchange_two(search *s, int32_t i, int32_t j) {
    const int32_t choice = s->choice[i], pinned = s->pinned[i];
    s->choice[i] = s->choice[j];
    s->pinned[i] = s->pinned[j];
    s->choice[j] = choice;
    s->pinned[j] = pinned;
}

/* Corners in the sequence in which they lie along their loop, so that the orders are in theirs. */
static bool put_in_sequence(search *s) {
    for (int32_t i = 0; i < s->n_slots; i++)
        for (int32_t j = i + 1; j < s->n_slots; j++) {
            const int32_t *place = s->ground->boundary->place;
            const int32_t a = s->choice[i], b = s->choice[j];
            if (s->slots[i].kind != s->slots[j].kind || ground_kind_loop(s->slots[i].kind) < 0)
                continue;
            if (place[s->options->list[a].site.vertex[0]] > place[s->options->list[b].site.vertex[0]]) {
                exchange_two(s, i, j);
            }
        }
    return in_sequence(s, s->choice);
}

/* Swaps the sites of two slots of a kind where that gains. */
static bool swap_pairs(search *s) {
    bool gained = false;
    for (int32_t i = 0; i < s->n_slots; i++)
        for (int32_t j = i + 1; j < s->n_slots; j++) {
            if (s->slots[i].kind != s->slots[j].kind || s->slots[i].order == s->slots[j].order)
                continue;
            const double before = value_of(s, s->choice);
            exchange_two(s, i, j);
            if (value_of(s, s->choice) < before - 1e-12 * fabs(before) && in_sequence(s, s->choice))
                gained = true;
            else
                exchange_two(s, i, j);
        }
    return gained;
}

static bool exchange(search *s) {
    bool gained = swap_pairs(s);
    for (int32_t i = 0; i < s->n_slots; i++) {
        const int32_t before = s->choice[i];
        const double value = value_of(s, s->choice);
        if (s->pinned[i] >= 0)
            continue;
        s->used[before] = false;
        const int32_t best = best_option(s, i);
        s->used[before] = true;
        if (best < 0 || best == before)
            continue;
        take(s, i, best);
        if (value_of(s, s->choice) < value - 1e-12 * fabs(value))
            gained = true;
        else
            take(s, i, before);
    }
    return gained;
}

/* From a start that has one free slot's option given; the others follow greedily. */
static void try_from(search *s, int32_t start) {
    bool given = false, complete = true;
    memset(s->used, 0, (size_t)s->options->n * sizeof *s->used);
    for (int32_t i = 0; i < s->n_slots; i++) {
        s->choice[i] = -1;
        take(s, i, s->pinned[i]);
    }
    for (int32_t i = 0; i < s->n_slots && complete; i++) {
        int32_t first, end;
        if (s->choice[i] >= 0)
            continue;
        options_for(s, i, &first, &end);
        const bool whole = s->ordered;
        s->ordered = false; /* until all corners are there */
        const int32_t option = given || first + start >= end ? best_option(s, i) : first + start;
        s->ordered = whole;
        given = true;
        take(s, i, option);
        complete = option >= 0;
    }
    if (!complete || (s->ordered && !put_in_sequence(s)))
        return;
    for (int pass = 0; pass < MOST_PASSES && exchange(s); pass++)
        ;
    keep_if_better(s, value_of(s, s->choice), s->choice);
}

/* --- fixed sites ------------------------------------------------------------------------------------------------ */

static void search_free(search *s) {
    if (count_choices(s) <= most_choices) {
        for (int32_t o = 0; o < s->options->n; o++) {
            s->linear[o] = s->options->list[o].linear;
            s->used[o] = false;
        }
        try_all(s, 0, s->constant);
        return;
    }
    for (int32_t start = 0; start < STARTS; start++)
        try_from(s, start);
}

/* Gives fixed option f and the following to slots in every way that makes a difference, then searches for the rest. */
static void pin_from(search *s, int32_t f) {
    if (s->n_fixings >= MOST_FIXINGS)
        return;
    if (f == s->options->n_fixed) {
        s->n_fixings++;
        search_free(s);
        return;
    }
    for (int32_t i = 0; i < s->n_slots; i++) {
        bool first = s->pinned[i] < 0 && s->slots[i].kind == s->options->list[f].kind;
        for (int32_t j = 0; j < i && first && !s->ordered; j++) /* alike slots are filled from the first one on */
            first = s->pinned[j] >= 0 || !slots_alike(s->slots + i, s->slots + j);
        if (!first)
            continue;
        s->pinned[i] = f;
        pin_from(s, f + 1);
        for (int32_t j = 0; j < s->n_slots; j++) /* swaps may have moved it */
            if (s->pinned[j] == f)
                s->pinned[j] = -1;
    }
}

orb_status assignment_find(const orb_ground *ground, const orb_options *options, double constant, int32_t n_slots,
                           const orb_slot *slots, int32_t *choice, double *value, orb_error *error) {
    const size_t n = (size_t)options->n + 1, k = (size_t)n_slots + 1;
    search s = {.ground = ground, .options = options, .n_slots = n_slots, .slots = slots, .constant = constant};
    s.best = choice;
    s.best_value = INFINITY;
    s.used = calloc(n, sizeof *s.used);
    s.pinned = malloc(k * sizeof *s.pinned);
    s.choice = malloc(k * sizeof *s.choice);
    s.linear = malloc(k * n * sizeof *s.linear);
    s.sites = malloc(k * sizeof *s.sites);
    s.ordered = sequence_matters(n_slots, slots);
    const bool room = s.used && s.pinned && s.choice && s.linear && s.sites;
    for (int32_t i = 0; i < n_slots && room; i++)
        s.pinned[i] = -1;
    if (room && n_slots == 0)
        s.best_value = options->n_fixed == 0 ? constant : INFINITY;
    else if (room)
        pin_from(&s, 0);
    *value = s.best_value;
    free(s.used);
    free(s.pinned);
    free(s.choice);
    free(s.linear);
    free(s.sites);
    return room ? ORB_OK : error_memory(error);
}
