/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cut_search.h"

#include <math.h>
#include <stdlib.h>

static void list_edges(cut_search *w) {
    const orb_mesh *mesh = w->mesh;
    for (int32_t e = 0; e < mesh->n_edges; e++)
        w->length[e] = mesh_edge_length(mesh, mesh->edge_halfedge[e]);
    for (int32_t e = 0; e < mesh->n_edges; e++)
        for (int side = 0; side < 2; side++)
            w->first[edge_end(mesh, e, side) + 2]++;
    for (int32_t v = 2; v < mesh->n_vertices + 2; v++)
        w->first[v] += w->first[v - 1];
    for (int32_t e = 0; e < mesh->n_edges; e++)
        for (int side = 0; side < 2; side++)
            w->incident[w->first[edge_end(mesh, e, side) + 1]++] = e;
}

static bool by_border(const cut_search *w, int32_t v) { return w->tree[v] >= 0 && edge_is_border(w->mesh, w->tree[v]); }

/* Of equally near ones those come first that are reached along the boundary: once a path has come to a boundary loop
 * all of that belongs to the tree but one edge, before a second path can come to it. */
static bool comes_before(const cut_search *w, int32_t a, int32_t b) {
    if (w->distance[a] != w->distance[b])
        return w->distance[a] < w->distance[b];
    bool border_a = by_border(w, a), border_b = by_border(w, b);
    return border_a != border_b ? border_a : a < b;
}

static void heap_put(cut_search *w, int32_t slot, int32_t vertex) {
    w->heap[slot] = vertex;
    w->slot[vertex] = slot;
}

static void heap_raise(cut_search *w, int32_t vertex) {
    int32_t slot = w->slot[vertex];
    for (; slot > 0 && comes_before(w, vertex, w->heap[(slot - 1) / 2]); slot = (slot - 1) / 2)
        heap_put(w, slot, w->heap[(slot - 1) / 2]);
    heap_put(w, slot, vertex);
}

static int32_t heap_take(cut_search *w) {
    int32_t first = w->heap[0], last = w->heap[--w->n_heap], slot = 0;
    for (int32_t child = 1; child < w->n_heap; child = 2 * slot + 1) {
        if (child + 1 < w->n_heap && comes_before(w, w->heap[child + 1], w->heap[child]))
            child++;
        if (!comes_before(w, w->heap[child], last))
            break;
        heap_put(w, slot, w->heap[child]);
        slot = child;
    }
    if (w->n_heap > 0)
        heap_put(w, slot, last);
    w->slot[first] = -2;
    return first;
}

void cut_search_grow(cut_search *w, int32_t root) {
    for (int32_t v = 0; v < w->mesh->n_vertices; v++) {
        w->distance[v] = INFINITY;
        w->tree[v] = w->slot[v] = -1;
    }
    w->distance[root] = 0;
    heap_put(w, w->n_heap++, root);
    while (w->n_heap > 0) {
        int32_t v = heap_take(w);
        bool through = v == root || !w->taken || !w->taken[v];
        for (int32_t k = w->first[v]; through && k < w->first[v + 1]; k++) {
            int32_t e = w->incident[k], u = edge_other_end(w->mesh, e, v);
            if (w->slot[u] == -2 || edge_is_inner(w, e))
                continue;
            bool border = edge_is_border(w->mesh, e);
            double d = w->distance[v] + (border ? 0 : w->length[e]);
            bool nearer = d < w->distance[u] || (d == w->distance[u] && border && !by_border(w, u));
            if (w->slot[u] >= 0 && !nearer)
                continue;
            w->distance[u] = d;
            w->tree[u] = e;
            if (w->slot[u] < 0)
                heap_put(w, w->n_heap++, u);
            heap_raise(w, u);
        }
    }
}

bool cut_search_allocate(cut_search *w) {
    size_t n = (size_t)w->mesh->n_vertices + 2, edges = (size_t)w->mesh->n_edges + 1;
    w->length = malloc(edges * sizeof *w->length);
    w->first = calloc(n, sizeof *w->first);
    w->incident = malloc(2 * edges * sizeof *w->incident);
    w->distance = malloc(n * sizeof *w->distance);
    w->tree = malloc(n * sizeof *w->tree);
    w->heap = malloc(n * sizeof *w->heap);
    w->slot = malloc(n * sizeof *w->slot);
    if (!w->length || !w->first || !w->incident || !w->distance || !w->tree || !w->heap || !w->slot)
        return false;
    list_edges(w);
    return true;
}

void cut_search_clear(cut_search *w) {
    free(w->length);
    free(w->first);
    free(w->incident);
    free(w->distance);
    free(w->tree);
    free(w->heap);
    free(w->slot);
}
