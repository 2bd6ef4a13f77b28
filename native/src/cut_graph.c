/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cut_graph.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cut_search.h"

typedef struct candidate {
    double length; /* of the loop that the edge closes */
    int32_t edge;
} candidate;

typedef struct worker {
    cut_search search;
    uint8_t *cut;
    int32_t *set; /* [n_triangles] union-find */
    candidate *candidates;
} worker;

static void worker_free(worker *w) {
    cut_search_clear(&w->search);
    free(w->set);
    free(w->candidates);
}

static bool worker_allocate(worker *w) {
    w->set = malloc(((size_t)w->search.mesh->n_triangles + 1) * sizeof *w->set);
    w->candidates = malloc(((size_t)w->search.mesh->n_edges + 1) * sizeof *w->candidates);
    return cut_search_allocate(&w->search) && w->set && w->candidates;
}

/* --- the tree of triangles that avoids it ----------------------------------------------------------------------- */

static int32_t find(int32_t *set, int32_t t) {
    while (set[t] != t)
        t = set[t] = set[set[t]];
    return t;
}

/* Joins the triangles on both sides of the edge; false if they were joined. */
static bool join(worker *w, int32_t edge) {
    int32_t h = w->search.mesh->edge_halfedge[edge];
    int32_t a = find(w->set, h / 3), b = find(w->set, w->search.mesh->twin[h] / 3);
    w->set[a] = b;
    return a != b;
}

static int longest_first(const void *a, const void *b) {
    const candidate *x = a, *y = b;
    if (x->length != y->length)
        return x->length < y->length ? 1 : -1;
    return (x->edge > y->edge) - (x->edge < y->edge);
}

/* Marks as cut what the tree of triangles does not cross: it crosses the edges with the longest loops. */
static void grow_cotree(worker *w) {
    const orb_mesh *mesh = w->search.mesh;
    int32_t n = 0;
    if (mesh->euler == 2) { /* a sphere: beside a tree of vertices there is one of triangles, which crosses all else */
        memset(w->cut, 0, (size_t)mesh->n_edges);
        for (int32_t v = 0; v < mesh->n_vertices; v++)
            if (w->search.tree[v] >= 0)
                w->cut[w->search.tree[v]] = 1;
        return;
    }
    for (int32_t t = 0; t < mesh->n_triangles; t++)
        w->set[t] = t;
    memset(w->cut, 1, (size_t)mesh->n_edges);
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        int32_t a = edge_end(mesh, e, 0), b = edge_end(mesh, e, 1);
        if (edge_is_inner(&w->search, e)) {
            join(w, e);
            w->cut[e] = 0;
        } else if (!edge_is_border(mesh, e) && w->search.tree[a] != e && w->search.tree[b] != e) {
            w->candidates[n++] = (candidate){w->search.distance[a] + w->search.distance[b] + w->search.length[e], e};
        }
    }
    bool simply_connected = mesh->euler + mesh->n_boundary_loops == 2; /* every loop bounds: no need to sort */
    if (!simply_connected)
        qsort(w->candidates, (size_t)n, sizeof *w->candidates, longest_first);
    for (int32_t k = 0; k < n; k++)
        if (join(w, w->candidates[k].edge))
            w->cut[w->candidates[k].edge] = 0;
}

/* Takes loose ends away; `slot` counts the cut edges at a vertex, `heap` is a stack. */
static void prune(worker *w, int32_t n_cones, const int32_t *cones) {
    const orb_mesh *mesh = w->search.mesh;
    int32_t *degree = w->search.slot, height = 0;
    memset(degree, 0, (size_t)mesh->n_vertices * sizeof *degree);
    for (int32_t e = 0; e < mesh->n_edges; e++)
        for (int side = 0; side < 2; side++)
            degree[edge_end(mesh, e, side)] += w->cut[e];
    for (int32_t c = 0; c < n_cones; c++)
        degree[cones[c]] += 2; /* never loose */
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        if (degree[v] == 1)
            w->search.heap[height++] = v;
    while (height > 0) {
        int32_t v = w->search.heap[--height];
        if (degree[v] != 1)
            continue;
        for (int32_t k = w->search.first[v]; k < w->search.first[v + 1]; k++) {
            int32_t e = w->search.incident[k], u = edge_other_end(mesh, e, v);
            if (!w->cut[e])
                continue;
            w->cut[e] = 0;
            degree[v]--;
            if (--degree[u] == 1)
                w->search.heap[height++] = u;
        }
    }
}

static int32_t find_root(const orb_mesh *mesh, int32_t n_cones, const int32_t *cones) {
    for (int32_t e = 0; e < mesh->n_edges && mesh->n_boundary_loops > 0; e++)
        if (edge_is_border(mesh, e))
            return edge_end(mesh, e, 0);
    return n_cones > 0 ? cones[0] : mesh->triangles[0];
}

static double cut_length(const worker *w) {
    double length = 0;
    for (int32_t e = 0; e < w->search.mesh->n_edges; e++)
        length += w->cut[e] ? w->search.length[e] : 0;
    return length;
}

/* The vertex that is farthest from all roots so far; nearest[n_vertices] is how far. */
static int32_t next_root(const worker *w, double *nearest) {
    int32_t farthest = w->search.mesh->triangles[0];
    for (int32_t v = 0; v < w->search.mesh->n_vertices; v++) {
        nearest[v] = fmin(nearest[v], w->search.mesh->vertex_halfedge[v] < 0 ? 0 : w->search.distance[v]);
        farthest = nearest[v] > nearest[farthest] ? v : farthest;
    }
    return farthest;
}

/* w->cut from the best of several roots, all over the surface. */
static orb_status try_roots(worker *w, int32_t root, int32_t n_roots, int32_t n_cones, const int32_t *cones,
                            orb_error *error) {
    double *nearest = malloc(((size_t)w->search.mesh->n_vertices + 1) * sizeof *nearest), shortest = INFINITY;
    uint8_t *best = malloc((size_t)w->search.mesh->n_edges + 1);
    orb_status status = nearest && best ? ORB_OK : error_memory(error);
    for (int32_t v = 0; v < w->search.mesh->n_vertices && status == ORB_OK; v++)
        nearest[v] = INFINITY;
    for (int32_t k = 0; k < n_roots && status == ORB_OK; k++) {
        cut_search_grow(&w->search, root);
        grow_cotree(w);
        root = next_root(w, nearest);
        prune(w, n_cones, cones);
        double length = cut_length(w);
        if (k == 0 || length < shortest) {
            shortest = length;
            memcpy(best, w->cut, (size_t)w->search.mesh->n_edges);
        }
    }
    if (status == ORB_OK)
        memcpy(w->cut, best, (size_t)w->search.mesh->n_edges);
    free(nearest);
    free(best);
    return status;
}

orb_status cut_graph_find(const orb_mesh *mesh, const int32_t *parent, int32_t n_cones, const int32_t *cones,
                          uint8_t *cut, orb_error *error) {
    enum { ROOTS = 12 };
    worker w = {.search = {.mesh = mesh, .parent = parent}, .cut = cut};
    bool one = mesh->n_boundary_loops > 0 || n_cones == 1 || n_cones == 2; /* the boundary; loops through a cone */
    orb_status status = error_memory(error);
    if (worker_allocate(&w))
        status = try_roots(&w, find_root(mesh, n_cones, cones), one ? 1 : ROOTS, n_cones, cones, error);
    worker_free(&w);
    return status;
}
