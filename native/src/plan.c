/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plan.h"

#include <stdlib.h>
#include <string.h>

#include "dilation.h"
#include "tour.h"

enum { LONG_WALK = 4, LUNE_ORDER = 4 };

/* Teichmueller space is a point, or the plane's, of whose lattices the least conformal energy chooses (modulus.h). */
static bool has_conformal_tile(const orb_signature *s) {
    const int32_t euler = 2 - 2 * s->n_handles - s->n_crosscaps - s->n_mirrors;
    return s->curvature >= 0 || -3 * euler + 2 * s->n_cones + s->n_corners == 0;
}

orb_status plan_create(const char *text, orb_signature *signature, orb_plan **result, orb_error *error) {
    orb_plan *plan = *result = calloc(1, sizeof *plan);
    if (!plan) {
        signature_free(signature);
        return error_memory(error);
    }
    plan->signature = signature;
    plan->n_cones = signature->n_cones + signature->n_corners;
    plan->conformal_tile = has_conformal_tile(signature);
    const size_t room = (size_t)plan->n_cones + 1, length = strlen(text) + 1;
    plan->text = malloc(length);
    plan->slots = malloc(room * sizeof *plan->slots);
    plan->sites = malloc(room * sizeof *plan->sites);
    plan->pinned = malloc(room);
    plan->radius = malloc(room * sizeof *plan->radius);
    plan->cones = calloc(room, sizeof *plan->cones);
    plan->charges = malloc(room * sizeof *plan->charges);
    if (!plan->text || !plan->slots || !plan->sites || !plan->pinned || !plan->radius || !plan->cones || !plan->charges)
        return error_memory(error);
    memcpy(plan->text, text, length);
    spread_charges(signature, plan->cones, plan->charges);
    plan->value = INFINITY;
    return ORB_OK;
}

void plan_free(orb_plan *plan) {
    if (!plan)
        return;
    free(plan->text);
    signature_free(plan->signature);
    free(plan->slots);
    free(plan->sites);
    free(plan->pinned);
    free(plan->radius);
    free(plan->cones);
    free(plan->charges);
    free(plan);
}

/* --- cones of one order, and how many of them are pairs ---------------------------------------------------------- */

/* The cones of one order, inside or on one mirror. */
typedef struct crowd {
    int32_t loop, order, n, n_pairs, most_pairs;
    double charge;
} crowd;

/* For a lune of a low order the form with a(u) = a is far off, as the dilation that is free is not in it; the best places are
 * nearly those for a higher order, for the metric without the cones is one cylinder for all. */
static double searched_charge(const orb_plan *plan, int32_t cone) {
    const int32_t order = plan->signature->orders[cone];
    if (order >= LUNE_ORDER || !dilation_is_free(plan->signature))
        return plan->charges[cone];
    return plan->charges[cone] * (1 - 1.0 / LUNE_ORDER) / (1 - 1.0 / order);
}

static bool corners_are_alike(const orb_signature *s, int32_t mirror) {
    for (int32_t i = s->mirror_start[mirror]; i < s->mirror_start[mirror + 1]; i++)
        if (s->orders[i] != s->orders[s->mirror_start[mirror]])
            return false;
    return true;
}

/* In the sequence of the signature; crowds[n_cones]. Corners whose sequence along the mirror matters are crowds of one. */
static int32_t list_crowds(const orb_plan *plan, const int32_t *loop_of, bool symmetric, crowd *crowds) {
    const orb_signature *s = plan->signature;
    int32_t n = 0;
    for (int32_t m = -1; m < s->n_mirrors; m++) {
        const int32_t first = m < 0 ? 0 : s->mirror_start[m];
        const int32_t end = m < 0 ? s->n_cones : s->mirror_start[m + 1];
        const bool sequence = m >= 0 && end - first > 3 && !corners_are_alike(s, m);
        const int32_t own = n;
        for (int32_t i = first; i < end; i++) {
            int32_t c = own;
            while (c < n && (sequence || crowds[c].order != s->orders[i]))
                c++;
            if (c == n)
                crowds[n++] = (crowd){m < 0 ? -1 : loop_of[m], s->orders[i], 0, 0, 0, searched_charge(plan, i)};
            crowds[c].n++;
            crowds[c].most_pairs = symmetric ? crowds[c].n / 2 : 0;
        }
    }
    return n;
}

/* The next way of making pairs; false after the last. */
static bool next_pairs(crowd *crowds, int32_t n) {
    for (int32_t c = 0; c < n; c++) {
        if (crowds[c].n_pairs < crowds[c].most_pairs) {
            crowds[c].n_pairs++;
            return true;
        }
        crowds[c].n_pairs = 0;
    }
    return false;
}

/* Slots of one kind follow one another. */
static int32_t fill_slots(const crowd *crowds, int32_t n, orb_slot *slots) {
    int32_t n_slots = 0;
    for (int32_t first = 0, end; first < n; first = end) {
        for (end = first; end < n && crowds[end].loop == crowds[first].loop; end++)
            ;
        for (int pair = 0; pair < 2; pair++)
            for (int32_t c = first; c < end; c++)
                for (int32_t k = pair ? 0 : 2 * crowds[c].n_pairs; k < (pair ? crowds[c].n_pairs : crowds[c].n); k++)
                    slots[n_slots++] = (orb_slot){crowds[c].order, crowds[c].charge, ground_kind(crowds[c].loop, pair)};
    }
    return n_slots;
}

void plan_want(const orb_plan *plan, const int32_t *loop_of, bool symmetric, bool *wanted) {
    const orb_signature *s = plan->signature;
    for (int32_t m = -1; m < s->n_mirrors; m++) {
        if ((m < 0 ? s->n_cones : signature_corners(s, m)) == 0)
            continue;
        const int32_t loop = m < 0 ? -1 : loop_of[m];
        wanted[ground_kind(loop, false)] = true;
        wanted[ground_kind(loop, true)] = wanted[ground_kind(loop, true)] || symmetric;
    }
}

orb_status plan_place(orb_plan *plan, const orb_ground *ground, const orb_options *options, double constant,
                      const int32_t *loop_of, bool symmetric, orb_error *error) {
    const size_t room = (size_t)plan->n_cones + 1;
    crowd *crowds = malloc(room * sizeof *crowds);
    orb_slot *slots = malloc(room * sizeof *slots);
    int32_t *choice = malloc(room * sizeof *choice);
    orb_status status = crowds && slots && choice ? ORB_OK : error_memory(error);
    const int32_t n = status == ORB_OK ? list_crowds(plan, loop_of, symmetric, crowds) : 0;
    for (bool more = status == ORB_OK; more && status == ORB_OK; more = next_pairs(crowds, n)) {
        double value = INFINITY;
        const int32_t n_slots = fill_slots(crowds, n, slots);
        status = assignment_find(ground, options, constant, n_slots, slots, choice, &value, error);
        if (status != ORB_OK || !(value < plan->value))
            continue;
        plan->placed = true;
        plan->symmetric = symmetric;
        plan->value = value;
        plan->n_slots = n_slots;
        memcpy(plan->slots, slots, (size_t)n_slots * sizeof *slots);
        for (int32_t i = 0; i < n_slots; i++) {
            plan->sites[i] = options->list[choice[i]].site;
            plan->pinned[i] = options->list[choice[i]].fixed;
        }
    }
    free(crowds);
    free(slots);
    free(choice);
    return status;
}

orb_descent plan_descent(orb_plan *plan, double radius) {
    for (int32_t i = 0; i < plan->n_slots; i++)
        plan->radius[i] = radius;
    return (orb_descent){plan->n_slots, plan->slots, plan->sites, plan->pinned, plan->radius, 0, false, false};
}

/* --- the signature's sequence ------------------------------------------------------------------------------------ */

/* A cone or corner that has its vertex. */
typedef struct settled {
    int32_t vertex, order, along;
} settled;

static int by_place(const void *a, const void *b) {
    return (((const settled *)a)->along > ((const settled *)b)->along) -
           (((const settled *)a)->along < ((const settled *)b)->along);
}

/* Those of one loop, -1: inside. Returns how many. */
static int32_t collect(const orb_plan *plan, const orb_ground *ground, int32_t loop, settled *found) {
    int32_t n = 0;
    for (int32_t i = 0; i < plan->n_slots; i++)
        for (int32_t a = 0; a < plan->sites[i].n && ground_kind_loop(plan->slots[i].kind) == loop; a++) {
            const int32_t v = plan->sites[i].vertex[a];
            found[n++] = (settled){v, plan->slots[i].order, ground->boundary->place[v]};
        }
    return n;
}

/* cones[k]: the next one not yet taken with the k-th order. */
static void hand_out(int32_t n, settled *found, const int32_t *orders, int32_t *cones) {
    for (int32_t k = 0; k < n; k++) {
        int32_t j = 0;
        while (j < n - 1 && found[j].order != orders[k])
            j++;
        cones[k] = found[j].vertex;
        found[j].order = -1;
    }
}

/* The same along a loop, from the start and in the direction in which the orders agree. */
static void hand_out_in_turn(int32_t n, settled *found, const int32_t *orders, int32_t *cones) {
    qsort(found, (size_t)n, sizeof *found, by_place);
    for (int32_t start = 0; start < n; start++)
        for (int32_t way = 1; way >= -1; way -= 2) {
            int32_t k = 0;
            while (k < n && found[(start + way * k + n) % n].order == orders[k])
                k++;
            if (k < n)
                continue;
            for (k = 0; k < n; k++)
                cones[k] = found[(start + way * k + n) % n].vertex;
            return;
        }
}

orb_status plan_list_cones(orb_plan *plan, const orb_ground *ground, const int32_t *loop_of, orb_error *error) {
    const orb_signature *s = plan->signature;
    settled *found = malloc(((size_t)plan->n_cones + 1) * sizeof *found);
    if (!found)
        return error_memory(error);
    hand_out(collect(plan, ground, -1, found), found, s->orders, plan->cones);
    for (int32_t m = 0; m < s->n_mirrors; m++) {
        const int32_t first = s->mirror_start[m];
        hand_out_in_turn(collect(plan, ground, loop_of[m], found), found, s->orders + first, plan->cones + first);
    }
    free(found);
    return ORB_OK;
}

orb_status plan_shorten_walk(orb_plan *plan, const orb_mesh *mesh, orb_error *error) {
    const orb_signature *s = plan->signature;
    if (plan->n_cones < LONG_WALK || s->n_mirrors + s->n_crosscaps + s->n_handles > 0)
        return ORB_OK;
    return tour_shorten(mesh, plan->n_cones, plan->cones, s->orders, error);
}

orb_charges plan_charges(const orb_plan *plan) { return spread_charges(plan->signature, plan->cones, plan->charges); }
