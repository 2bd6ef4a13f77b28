/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "descent.h"

#include <stdlib.h>
#include <string.h>

#include "assignment.h"

static const double pi = 3.14159265358979323846;
static const double worthwhile = 3e-4; /* of the value: what a move must promise */
static const double worth_a_look = 3e-3,
                    cheap = 0.25;     /* at the end: the same of a move to a neighbour, and how much of the
                                                          dipole's estimate is believed there (docs/decisions.md) */
static const double shared = 1.3;     /* a vertex whose column is there, or will be, is as good as one that promises so
                                          many times more: it costs nothing */
static const double most_bytes = 5e8; /* of columns that nobody stands on and that may still be offered */
enum { MOST_ROUNDS = 40 };

typedef struct offer {
    orb_site site;
    double change, distance; /* promised change of the value; how far away */
} offer;

typedef struct walk {
    const orb_ground *ground;
    orb_columns *columns;
    int32_t n;
    orb_descent *descents;
    int32_t *start;  /* [n + 1] of each descent's offers */
    offer *offers;   /* [start[n]] site.n = 0: none */
    int32_t *needed; /* [2 * start[n]] vertices whose columns are */
    int32_t *stamp;  /* [n_vertices] the search that last met a vertex */
    int32_t *queue;  /* [n_vertices] */
    int32_t stamps;
    bool *known; /* [n_vertices] the column is there, or is needed in this round */
} walk;

/* --- the form ---------------------------------------------------------------------------------------------------- */

static double evaluate(const walk *w, const orb_descent *d) {
    double value = w->columns->spread->constant;
    for (int32_t i = 0; i < d->n_slots; i++) {
        const orb_site *p = d->sites + i;
        for (int32_t a = 0; a < p->n; a++) {
            const double *column = w->columns->of[p->vertex[a]];
            double sum = 2 * w->columns->spread->pull[p->vertex[a]];
            for (int32_t j = 0; j < d->n_slots; j++)
                for (int32_t b = 0; b < d->sites[j].n; b++)
                    sum += d->slots[j].charge * column[d->sites[j].vertex[b]];
            value += d->slots[i].charge * sum;
        }
        value += d->pinned[i] ? 0 : ground_penalty(w->ground, p);
    }
    return value;
}

/* h at a site. */
static double slope(const walk *w, const orb_descent *d, const orb_site *p) {
    double sum = 0;
    for (int32_t a = 0; a < p->n; a++) {
        sum += w->columns->spread->pull[p->vertex[a]];
        for (int32_t j = 0; j < d->n_slots; j++)
            for (int32_t b = 0; b < d->sites[j].n; b++)
                sum += d->slots[j].charge * w->columns->of[d->sites[j].vertex[b]][p->vertex[a]];
    }
    return sum;
}

/* --- offers ------------------------------------------------------------------------------------------------------ */

static double distance_between(const orb_mesh *mesh, int32_t a, int32_t b) {
    const double *p = mesh->vertices + 3 * (size_t)a, *q = mesh->vertices + 3 * (size_t)b;
    return hypot(hypot(p[0] - q[0], p[1] - q[1]), p[2] - q[2]);
}

/* |g_d - g_c|_W^2 of a pair of vertices at that distance. */
static double dipole(const walk *w, double distance) {
    const double relative = distance / w->ground->size;
    return relative * relative / (4 * pi) * (0.5 + fmax(log(0.5 / relative), 0));
}

static bool is_taken(const walk *w, const orb_descent *d, int32_t slot, const orb_site *p) {
    for (int32_t j = 0; j < d->n_slots; j++)
        for (int32_t a = 0; a < p->n && j != slot; a++)
            for (int32_t b = 0; b < d->sites[j].n; b++)
                if (d->sites[j].vertex[b] == p->vertex[a])
                    return true;
    for (int32_t a = 0; a < p->n; a++)
        if (w->ground->fixed[p->vertex[a]])
            return true;
    return false;
}

static void consider(const walk *w, const orb_descent *d, int32_t slot, int32_t vertex, double from, offer *best) {
    orb_site p;
    const orb_site *now = d->sites + slot;
    if (!ground_place(w->ground, d->slots[slot].kind, vertex, &p) || is_taken(w, d, slot, &p))
        return;
    const double distance = distance_between(w->ground->mesh, now->vertex[0], vertex), charge = d->slots[slot].charge;
    const double cost = charge * charge * p.n * dipole(w, distance) * (d->close ? cheap : 1);
    double change =
        2 * charge * (slope(w, d, &p) - from) + cost + ground_penalty(w->ground, &p) - ground_penalty(w->ground, now);
    if (change < 0 && w->known[vertex])
        change *= shared;
    if (change < best->change)
        *best = (offer){p, change, distance};
}

/* The best site for a slot within its radius, over edges from where it is. */
static offer find_offer(walk *w, const orb_descent *d, int32_t slot) {
    const orb_mesh *mesh = w->ground->mesh;
    const int32_t centre = d->sites[slot].vertex[0];
    const double from = slope(w, d, d->sites + slot);
    offer best = {.change = -(d->close ? worth_a_look : worthwhile) * fabs(d->value)};
    int32_t head = 0, tail = 0;
    w->stamps++;
    w->queue[tail++] = centre;
    w->stamp[centre] = w->stamps;
    while (head < tail) {
        const int32_t vertex = w->queue[head++];
        orb_turn turn = mesh_turn_start(mesh, vertex);
        const int32_t first = turn.corner;
        if (vertex != centre)
            consider(w, d, slot, vertex, from, &best);
        do {
            const int32_t ends[2] = {halfedge_to(mesh, turn.corner),
                                     halfedge_from(mesh, halfedge_previous(turn.corner))};
            for (int k = 0; k < 2; k++)
                if (w->stamp[ends[k]] != w->stamps && distance_between(mesh, centre, ends[k]) <= d->radius[slot]) {
                    w->stamp[ends[k]] = w->stamps;
                    w->queue[tail++] = ends[k];
                }
        } while (mesh_turn(mesh, &turn) && turn.corner != first);
    }
    return best;
}

/* --- rounds ------------------------------------------------------------------------------------------------------ */

/* Columns of all sites of the descents that go on, and of what they are offered. */
static orb_status require(walk *w, bool offers, double fraction, orb_error *error) {
    int32_t n = 0;
    for (int32_t k = 0; k < w->n; k++)
        for (int32_t i = 0; i < w->descents[k].n_slots && !w->descents[k].done; i++) {
            const orb_site *p = offers ? &w->offers[w->start[k] + i].site : w->descents[k].sites + i;
            for (int32_t a = 0; a < p->n; a++)
                w->needed[n++] = p->vertex[a];
        }
    return columns_require(w->columns, n, w->needed, "places", fraction, fraction, error);
}

static void drop_columns(walk *w, bool *wanted) {
    const int32_t n_vertices = w->ground->mesh->n_vertices;
    double bytes = 0;
    for (int32_t v = 0; v < n_vertices; v++) {
        w->known[v] = w->columns->of[v] != NULL;
        bytes += w->known[v] ? (double)n_vertices * sizeof **w->columns->of : 0;
    }
    if (bytes <= most_bytes)
        return;
    memset(wanted, 0, (size_t)n_vertices);
    for (int32_t k = 0; k < w->n; k++)
        for (int32_t i = 0; i < w->descents[k].n_slots && !w->descents[k].done; i++)
            for (int32_t a = 0; a < w->descents[k].sites[i].n; a++)
                wanted[w->descents[k].sites[i].vertex[a]] = true;
    columns_keep(w->columns, wanted);
    memcpy(w->known, wanted, (size_t)n_vertices);
}

/* From here on only neighbours are offered. */
static void look_close(const walk *w, orb_descent *d) {
    const orb_mesh *mesh = w->ground->mesh;
    d->close = true;
    for (int32_t i = 0; i < d->n_slots; i++) {
        orb_turn turn = mesh_turn_start(mesh, d->sites[i].vertex[0]);
        const int32_t first = turn.corner;
        d->radius[i] = 0;
        do {
            d->radius[i] = fmax(d->radius[i], mesh_edge_length(mesh, turn.corner));
            d->radius[i] = fmax(d->radius[i], mesh_edge_length(mesh, halfedge_previous(turn.corner)));
        } while (mesh_turn(mesh, &turn) && turn.corner != first);
        d->radius[i] *= 1 + 1e-9;
    }
}

static void make_offers(walk *w) {
    for (int32_t k = 0; k < w->n; k++) {
        orb_descent *d = w->descents + k;
        bool any = false;
        for (int32_t i = 0; i < d->n_slots && !d->done; i++) {
            offer *one = w->offers + w->start[k] + i;
            *one = (offer){0};
            if (!d->pinned[i])
                *one = find_offer(w, d, i);
            any = any || one->site.n > 0;
            for (int32_t a = 0; a < one->site.n; a++)
                w->known[one->site.vertex[a]] = true;
        }
        if (!d->done && !any && !d->close)
            look_close(w, d);
        else
            d->done = d->done || !any;
    }
}

/* Takes each slot's offer if the exact value falls. */
static void take_offers(walk *w, int32_t k) {
    orb_descent *d = w->descents + k;
    for (int32_t i = 0; i < d->n_slots; i++) {
        const offer *one = w->offers + w->start[k] + i;
        const orb_site before = d->sites[i];
        if (one->site.n == 0)
            continue;
        bool taken = !is_taken(w, d, i, &one->site);
        d->sites[i] = one->site;
        const double value = evaluate(w, d);
        taken = taken && value < d->value && assignment_in_sequence(w->ground, d->n_slots, d->slots, d->sites);
        if (taken) {
            d->value = value;
        } else {
            d->sites[i] = before;
            d->radius[i] = 0.5 * fmin(d->radius[i], one->distance);
        }
    }
}

static orb_status run_rounds(walk *w, bool *wanted, orb_error *error) {
    orb_status status = require(w, false, 0.4, error);
    for (int32_t k = 0; k < w->n && status == ORB_OK; k++)
        w->descents[k].value = evaluate(w, w->descents + k);
    if (status == ORB_OK)
        drop_columns(w, wanted);
    for (int round = 0; round < MOST_ROUNDS && status == ORB_OK; round++) {
        make_offers(w);
        bool all_done = true;
        for (int32_t k = 0; k < w->n; k++)
            all_done = all_done && w->descents[k].done;
        if (all_done)
            break;
        status = require(w, true, 0.4 + 0.4 * round / (round + 5.0), error);
        for (int32_t k = 0; k < w->n && status == ORB_OK; k++)
            if (!w->descents[k].done)
                take_offers(w, k);
        drop_columns(w, wanted);
    }
    return status;
}

orb_status descent_run(const orb_ground *ground, orb_columns *columns, int32_t n, orb_descent *descents,
                       orb_error *error) {
    const size_t room = (size_t)ground->mesh->n_vertices + 1;
    walk w = {.ground = ground, .columns = columns, .n = n, .descents = descents};
    bool *wanted = malloc(room);
    w.start = calloc((size_t)n + 1, sizeof *w.start);
    w.stamp = calloc(room, sizeof *w.stamp);
    w.queue = malloc(room * sizeof *w.queue);
    w.known = calloc(room, sizeof *w.known);
    orb_status status = error_memory(error);
    if (!wanted || !w.start || !w.stamp || !w.queue || !w.known)
        goto done;
    for (int32_t k = 0; k < n; k++)
        w.start[k + 1] = w.start[k] + descents[k].n_slots;
    w.offers = calloc((size_t)w.start[n] + 1, sizeof *w.offers);
    w.needed = malloc((2 * (size_t)w.start[n] + 1) * sizeof *w.needed);
    if (w.offers && w.needed)
        status = run_rounds(&w, wanted, error);
done:
    free(wanted);
    free(w.start);
    free(w.stamp);
    free(w.queue);
    free(w.known);
    free(w.offers);
    free(w.needed);
    return status;
}
