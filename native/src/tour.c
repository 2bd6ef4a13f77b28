/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tour.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "shortest.h"

enum { MOST_PASSES = 100 };

typedef struct tour {
    int32_t n;
    const int32_t *order;   /* [n] */
    const double *distance; /* [n*n] */
    int32_t *stop;          /* [n] which vertex comes when */
    int32_t *trial;         /* [n] */
} tour;

static double length(const tour *t, const int32_t *stop) {
    double sum = 0;
    for (int32_t k = 0; k + 1 < t->n; k++)
        sum += t->distance[(size_t)stop[k] * (size_t)t->n + (size_t)stop[k + 1]];
    return sum;
}

static bool keeps_orders(const tour *t, const int32_t *stop) {
    for (int32_t k = 0; k < t->n; k++)
        if (t->order[stop[k]] != t->order[k])
            return false;
    return true;
}

/* Takes the trial if it is allowed and shorter. */
static bool improve(tour *t) {
    const double now = length(t, t->stop);
    if (!keeps_orders(t, t->trial) || !(length(t, t->trial) < now - 1e-9 * now))
        return false;
    memcpy(t->stop, t->trial, (size_t)t->n * sizeof *t->stop);
    return true;
}

static bool exchange_and_reverse(tour *t) {
    const size_t bytes = (size_t)t->n * sizeof *t->stop;
    bool gained = false;
    for (int32_t i = 0; i < t->n; i++)
        for (int32_t j = i + 1; j < t->n; j++) {
            memcpy(t->trial, t->stop, bytes);
            t->trial[i] = t->stop[j];
            t->trial[j] = t->stop[i];
            gained = improve(t) || gained;
            for (int32_t k = i; k <= j; k++)
                t->trial[k] = t->stop[i + j - k];
            memcpy(t->trial, t->stop, (size_t)i * sizeof *t->stop);
            memcpy(t->trial + j + 1, t->stop + j + 1, (size_t)(t->n - j - 1) * sizeof *t->stop);
            gained = improve(t) || gained;
        }
    return gained;
}

/* From each stop that may be the first to the nearest one that may be next; the shortest of these walks. */
static void start_greedily(tour *t) {
    double least = INFINITY;
    for (int32_t first = 0; first < t->n; first++) {
        if (t->order[first] != t->order[0])
            continue;
        int32_t *walk = t->trial;
        walk[0] = first;
        for (int32_t k = 1; k < t->n; k++) {
            int32_t best = -1;
            for (int32_t s = 0; s < t->n; s++) {
                bool free = t->order[s] == t->order[k];
                for (int32_t j = 0; j < k; j++)
                    free = free && walk[j] != s;
                const double *from = t->distance + (size_t)walk[k - 1] * (size_t)t->n;
                if (free && (best < 0 || from[s] < from[best]))
                    best = s;
            }
            walk[k] = best;
        }
        if (length(t, walk) < least) {
            least = length(t, walk);
            memcpy(t->stop, walk, (size_t)t->n * sizeof *walk);
        }
    }
}

static bool measure(const orb_mesh *mesh, int32_t n, const int32_t *vertex, double *distance) {
    shortest_search search = {0};
    double *from = malloc(((size_t)mesh->n_vertices + 1) * sizeof *from);
    const bool room = shortest_allocate(&search, mesh->n_vertices) && from;
    for (int32_t k = 0; k < n && room; k++) {
        for (int32_t v = 0; v < mesh->n_vertices; v++)
            from[v] = INFINITY;
        shortest_lower(&search, mesh, vertex[k], from);
        for (int32_t j = 0; j < n; j++)
            distance[(size_t)k * (size_t)n + (size_t)j] = from[vertex[j]];
    }
    shortest_clear(&search);
    free(from);
    return room;
}

orb_status tour_shorten(const orb_mesh *mesh, int32_t n, int32_t *vertex, const int32_t *order, orb_error *error) {
    const size_t room = (size_t)n + 1;
    double *distance = malloc(room * room * sizeof *distance);
    int32_t *before = malloc(room * sizeof *before);
    tour t = {n, order, distance, malloc(room * sizeof *t.stop), malloc(room * sizeof *t.trial)};
    const bool fine = distance && before && t.stop && t.trial && measure(mesh, n, vertex, distance);
    if (fine) {
        memcpy(before, vertex, (size_t)n * sizeof *before);
        for (int32_t k = 0; k < n; k++)
            t.stop[k] = k;
        start_greedily(&t);
        for (int pass = 0; pass < MOST_PASSES && exchange_and_reverse(&t); pass++)
            ;
        for (int32_t k = 0; k < n; k++)
            vertex[k] = before[t.stop[k]];
    }
    free(distance);
    free(before);
    free(t.stop);
    free(t.trial);
    return fine ? ORB_OK : error_memory(error);
}
