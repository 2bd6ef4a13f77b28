/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cut_graph.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct candidate {
    double length; /* of the loop that the edge closes */
    int32_t edge;
} candidate;

typedef struct worker {
    const orb_mesh *mesh;
    const int32_t *parent;
    uint8_t *cut;
    double *length;            /* [n_edges] */
    int32_t *first, *incident; /* the edges at vertex v: incident[first[v]] ... incident[first[v + 1] - 1] */
    double *distance;          /* [n_vertices] */
    int32_t *tree;             /* [n_vertices] the edge towards the root; -1 */
    int32_t *heap, *slot;      /* [n_vertices] */
    int32_t n_heap;
    const bool *taken; /* [n_vertices] vertices that paths may end in but not go through; NULL: none */
    int32_t *set;      /* [n_triangles] union-find */
    candidate *candidates;
} worker;

static void worker_free(worker *w) {
    free(w->length);
    free(w->first);
    free(w->incident);
    free(w->distance);
    free(w->tree);
    free(w->heap);
    free(w->slot);
    free(w->set);
    free(w->candidates);
}

static bool worker_allocate(worker *w) {
    size_t n = (size_t)w->mesh->n_vertices + 2, edges = (size_t)w->mesh->n_edges + 1;
    w->length = malloc(edges * sizeof *w->length);
    w->first = calloc(n, sizeof *w->first);
    w->incident = malloc(2 * edges * sizeof *w->incident);
    w->distance = malloc(n * sizeof *w->distance);
    w->tree = malloc(n * sizeof *w->tree);
    w->heap = malloc(n * sizeof *w->heap);
    w->slot = malloc(n * sizeof *w->slot);
    w->set = malloc(((size_t)w->mesh->n_triangles + 1) * sizeof *w->set);
    w->candidates = malloc(edges * sizeof *w->candidates);
    return w->length && w->first && w->incident && w->distance && w->tree && w->heap && w->slot && w->set &&
           w->candidates;
}

static int32_t edge_end(const orb_mesh *mesh, int32_t edge, int side) {
    int32_t h = mesh->edge_halfedge[edge];
    return side ? halfedge_to(mesh, h) : halfedge_from(mesh, h);
}

static bool is_border(const orb_mesh *mesh, int32_t edge) { return mesh->twin[mesh->edge_halfedge[edge]] < 0; }

/* Within one triangle of which both sides are parts: neither cut nor walked along. */
static bool is_inner(const worker *w, int32_t edge) {
    int32_t h = w->mesh->edge_halfedge[edge], g = w->mesh->twin[h];
    return w->parent && g >= 0 && w->parent[h / 3] >= 0 && w->parent[h / 3] == w->parent[g / 3];
}

static void list_edges(worker *w) {
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

/* --- shortest paths from the root ------------------------------------------------------------------------------ */

static bool by_border(const worker *w, int32_t v) { return w->tree[v] >= 0 && is_border(w->mesh, w->tree[v]); }

/* Of equally near ones those come first that are reached along the boundary: once a path has come to a boundary loop
 * all of that belongs to the tree but one edge, before a second path can come to it. */
static bool comes_before(const worker *w, int32_t a, int32_t b) {
    if (w->distance[a] != w->distance[b])
        return w->distance[a] < w->distance[b];
    bool border_a = by_border(w, a), border_b = by_border(w, b);
    return border_a != border_b ? border_a : a < b;
}

static void heap_put(worker *w, int32_t slot, int32_t vertex) {
    w->heap[slot] = vertex;
    w->slot[vertex] = slot;
}

static void heap_raise(worker *w, int32_t vertex) {
    int32_t slot = w->slot[vertex];
    for (; slot > 0 && comes_before(w, vertex, w->heap[(slot - 1) / 2]); slot = (slot - 1) / 2)
        heap_put(w, slot, w->heap[(slot - 1) / 2]);
    heap_put(w, slot, vertex);
}

static int32_t heap_take(worker *w) {
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

/* Dijkstra's tree; the boundary is cut in any case, and costs nothing. */
static void grow_tree(worker *w, int32_t root) {
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
            int32_t e = w->incident[k], a = edge_end(w->mesh, e, 0), u = a == v ? edge_end(w->mesh, e, 1) : a;
            if (w->slot[u] == -2 || is_inner(w, e))
                continue;
            bool border = is_border(w->mesh, e);
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

/* --- the tree of triangles that avoids it ----------------------------------------------------------------------- */

static int32_t find(int32_t *set, int32_t t) {
    while (set[t] != t)
        t = set[t] = set[set[t]];
    return t;
}

/* Joins the triangles on both sides of the edge; false if they were joined. */
static bool join(worker *w, int32_t edge) {
    int32_t h = w->mesh->edge_halfedge[edge];
    int32_t a = find(w->set, h / 3), b = find(w->set, w->mesh->twin[h] / 3);
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
    const orb_mesh *mesh = w->mesh;
    int32_t n = 0;
    if (mesh->euler == 2) { /* a sphere: beside a tree of vertices there is one of triangles, which crosses all else */
        memset(w->cut, 0, (size_t)mesh->n_edges);
        for (int32_t v = 0; v < mesh->n_vertices; v++)
            if (w->tree[v] >= 0)
                w->cut[w->tree[v]] = 1;
        return;
    }
    for (int32_t t = 0; t < mesh->n_triangles; t++)
        w->set[t] = t;
    memset(w->cut, 1, (size_t)mesh->n_edges);
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        int32_t a = edge_end(mesh, e, 0), b = edge_end(mesh, e, 1);
        if (is_inner(w, e)) {
            join(w, e);
            w->cut[e] = 0;
        } else if (!is_border(mesh, e) && w->tree[a] != e && w->tree[b] != e) {
            w->candidates[n++] = (candidate){w->distance[a] + w->distance[b] + w->length[e], e};
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
    const orb_mesh *mesh = w->mesh;
    int32_t *degree = w->slot, height = 0;
    memset(degree, 0, (size_t)mesh->n_vertices * sizeof *degree);
    for (int32_t e = 0; e < mesh->n_edges; e++)
        for (int side = 0; side < 2; side++)
            degree[edge_end(mesh, e, side)] += w->cut[e];
    for (int32_t c = 0; c < n_cones; c++)
        degree[cones[c]] += 2; /* never loose */
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        if (degree[v] == 1)
            w->heap[height++] = v;
    while (height > 0) {
        int32_t v = w->heap[--height];
        if (degree[v] != 1)
            continue;
        for (int32_t k = w->first[v]; k < w->first[v + 1]; k++) {
            int32_t e = w->incident[k], a = edge_end(mesh, e, 0), u = a == v ? edge_end(mesh, e, 1) : a;
            if (!w->cut[e])
                continue;
            w->cut[e] = 0;
            degree[v]--;
            if (--degree[u] == 1)
                w->heap[height++] = u;
        }
    }
}

static int32_t find_root(const orb_mesh *mesh, int32_t n_cones, const int32_t *cones) {
    for (int32_t e = 0; e < mesh->n_edges && mesh->n_boundary_loops > 0; e++)
        if (is_border(mesh, e))
            return edge_end(mesh, e, 0);
    return n_cones > 0 ? cones[0] : mesh->triangles[0];
}

static double cut_length(const worker *w) {
    double length = 0;
    for (int32_t e = 0; e < w->mesh->n_edges; e++)
        length += w->cut[e] ? w->length[e] : 0;
    return length;
}

/* The vertex that is farthest from all roots so far; nearest[n_vertices] is how far. */
static int32_t next_root(const worker *w, double *nearest) {
    int32_t farthest = w->mesh->triangles[0];
    for (int32_t v = 0; v < w->mesh->n_vertices; v++) {
        nearest[v] = fmin(nearest[v], w->mesh->vertex_halfedge[v] < 0 ? 0 : w->distance[v]);
        farthest = nearest[v] > nearest[farthest] ? v : farthest;
    }
    return farthest;
}

/* w->cut from the best of several roots, all over the surface. */
static orb_status try_roots(worker *w, int32_t root, int32_t n_roots, int32_t n_cones, const int32_t *cones,
                            orb_error *error) {
    double *nearest = malloc(((size_t)w->mesh->n_vertices + 1) * sizeof *nearest), shortest = INFINITY;
    uint8_t *best = malloc((size_t)w->mesh->n_edges + 1);
    orb_status status = nearest && best ? ORB_OK : error_memory(error);
    for (int32_t v = 0; v < w->mesh->n_vertices && status == ORB_OK; v++)
        nearest[v] = INFINITY;
    for (int32_t k = 0; k < n_roots && status == ORB_OK; k++) {
        grow_tree(w, root);
        grow_cotree(w);
        root = next_root(w, nearest);
        prune(w, n_cones, cones);
        double length = cut_length(w);
        if (k == 0 || length < shortest) {
            shortest = length;
            memcpy(best, w->cut, (size_t)w->mesh->n_edges);
        }
    }
    if (status == ORB_OK)
        memcpy(w->cut, best, (size_t)w->mesh->n_edges);
    free(nearest);
    free(best);
    return status;
}

orb_status cut_graph_find(const orb_mesh *mesh, const int32_t *parent, int32_t n_cones, const int32_t *cones,
                          uint8_t *cut, orb_error *error) {
    enum { ROOTS = 12 };
    worker w = {.mesh = mesh, .parent = parent, .cut = cut};
    bool one = mesh->n_boundary_loops > 0 || n_cones == 1 || n_cones == 2; /* the boundary; loops through a cone */
    orb_status status = error_memory(error);
    if (worker_allocate(&w)) {
        list_edges(&w);
        status = try_roots(&w, find_root(mesh, n_cones, cones), one ? 1 : ROOTS, n_cones, cones, error);
    }
    worker_free(&w);
    return status;
}

/* --- a disk along one path --------------------------------------------------------------------------------------- */

/* Cuts along the tree from `to` back to its root. */
static void cut_back(worker *w, int32_t to, bool *taken) {
    for (int32_t v = to; w->tree[v] >= 0;) {
        const int32_t e = w->tree[v], a = edge_end(w->mesh, e, 0);
        w->cut[e] = 1;
        taken[v] = true;
        v = a == v ? edge_end(w->mesh, e, 1) : a;
    }
}

/* Of the vertices with foot[v], the nearest. */
static int32_t nearest_foot(const worker *w, const bool *foot) {
    int32_t nearest = -1;
    for (int32_t v = 0; v < w->mesh->n_vertices; v++)
        if (foot[v] && w->distance[v] < INFINITY && (nearest < 0 || w->distance[v] < w->distance[nearest]))
            nearest = v;
    return nearest;
}

/* foot[v]: whether v is within the side that follows the first of the marks on the boundary, or without one on the
 * boundary at all. */
static void find_feet(const orb_mesh *mesh, const orb_marks *marks, const bool *border, const bool *taken, bool *foot) {
    int32_t first = 0;
    while (first < marks->n && !border[marks->vertex[first]])
        first++;
    memcpy(foot, border, (size_t)mesh->n_vertices * sizeof *foot);
    if (first == marks->n)
        return;
    memset(foot, 0, (size_t)mesh->n_vertices * sizeof *foot);
    int32_t v = marks->vertex[first];
    for (v = halfedge_to(mesh, mesh->vertex_halfedge[v]); !taken[v]; v = halfedge_to(mesh, mesh->vertex_halfedge[v]))
        foot[v] = true;
}

/* `from` -1: from the boundary. */
static orb_status no_path(int32_t from, int32_t to, orb_error *error) {
    const int32_t ends[2] = {to, from};
    return error_set_elements(
        error, ORB_CUT_BLOCKED, ORB_VERTEX, ends, from < 0 ? 1 : 2, from < 0 ? 1 : 2,
        "the cut to the cone at vertex %d would meet the boundary, itself or another cone whatever "
        "way it goes along edges: subdivide the mesh, or give the cones in another sequence",
        (int)to);
}

/* *base: where the path leaves the boundary. `border`, `taken` (the marks), `foot` [n_vertices] */
static orb_status cut_along(worker *w, const orb_marks *marks, const bool *border, bool *taken, const bool *foot,
                            int32_t *base, orb_error *error) {
    int32_t at = -1;
    for (int32_t v = 0; v < w->mesh->n_vertices; v++)
        taken[v] = taken[v] || border[v];
    for (int32_t k = 0; k < marks->n; k++) {
        int32_t to = marks->vertex[k], end = to;
        if (border[to])
            continue;
        grow_tree(w, at < 0 ? to : at);
        if (at < 0) {
            end = nearest_foot(w, foot);
            *base = end = end < 0 ? nearest_foot(w, border) : end; /* a side may be one edge: then from anywhere */
        }
        if (end < 0 || w->distance[end] == INFINITY)
            return no_path(at, to, error);
        cut_back(w, end, taken);
        at = to;
    }
    return ORB_OK;
}

orb_status cut_graph_path(const orb_mesh *mesh, const int32_t *parent, const orb_marks *marks, uint8_t *cut,
                          int32_t *start, orb_error *error) {
    const size_t n = (size_t)mesh->n_vertices + 1;
    bool *border = calloc(n, sizeof *border), *taken = calloc(n, sizeof *taken), *foot = calloc(n, sizeof *foot);
    worker w = {.mesh = mesh, .parent = parent, .cut = cut, .taken = taken};
    int32_t base = -1;
    orb_status status = border && taken && foot && worker_allocate(&w) ? ORB_OK : error_memory(error);
    if (status == ORB_OK) {
        list_incident_edges(&w);
        mesh_find_boundary(mesh, border);
        for (int32_t k = 0; k < marks->n; k++)
            taken[marks->vertex[k]] = true;
        find_feet(mesh, marks, border, taken, foot);
        for (int32_t e = 0; e < mesh->n_edges; e++)
            cut[e] = is_border(mesh, e);
        status = cut_along(&w, marks, border, taken, foot, &base, error);
    }
    if (status == ORB_OK)
        *start = mesh->vertex_halfedge[base];
    worker_free(&w);
    free(border);
    free(taken);
    free(foot);
    return status;
}
