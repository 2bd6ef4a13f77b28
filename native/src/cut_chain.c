/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cut_chain.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cut_search.h"

typedef struct chain {
    cut_search search;
    const orb_marks *marks;
    uint8_t *cut;
    int32_t n_loops, joined; /* loops of the boundary; how many the path has met */
    int32_t *loop;           /* [n_vertices] that a vertex is on; -1: inside, or its loop is joined */
    bool *border, *marked;   /* [n_vertices] */
    bool *taken;             /* [n_vertices] border, marked or on the path */
    bool *leave, *arrive;    /* [n_vertices] where the next segment may begin, if it begins on a mirror, and end */
} chain;

static bool chain_allocate(chain *c, const orb_mesh *mesh) {
    const size_t n = (size_t)mesh->n_vertices + 1;
    c->loop = malloc(n * sizeof *c->loop);
    c->border = calloc(n, sizeof *c->border);
    c->marked = calloc(n, sizeof *c->marked);
    c->taken = calloc(n, sizeof *c->taken);
    c->leave = calloc(n, sizeof *c->leave);
    c->arrive = calloc(n, sizeof *c->arrive);
    c->search.taken = c->taken;
    return cut_search_allocate(&c->search) && c->loop && c->border && c->marked && c->taken && c->leave && c->arrive;
}

static void chain_free(chain *c) {
    cut_search_clear(&c->search);
    free(c->loop);
    free(c->border);
    free(c->marked);
    free(c->taken);
    free(c->leave);
    free(c->arrive);
}

static int32_t next_on_boundary(const orb_mesh *mesh, int32_t v) { return halfedge_to(mesh, mesh->vertex_halfedge[v]); }

static void list_loops(chain *c) {
    const orb_mesh *mesh = c->search.mesh;
    mesh_find_boundary(mesh, c->border);
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        c->loop[v] = -1;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        if (!c->border[v] || c->loop[v] >= 0)
            continue;
        for (int32_t u = v; c->loop[u] < 0; u = next_on_boundary(mesh, u))
            c->loop[u] = c->n_loops;
        c->n_loops++;
    }
    for (int32_t k = 0; k < c->marks->n; k++)
        c->marked[c->marks->vertex[k]] = true;
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        c->taken[v] = c->border[v] || c->marked[v];
}

/* set[v]: the vertices after this one along the boundary, as far as the next corner or all the way round. The last of
 * them, or -1. */
static int32_t mark_after(const chain *c, int32_t vertex, bool *set) {
    const orb_mesh *mesh = c->search.mesh;
    int32_t last = -1;
    memset(set, 0, (size_t)mesh->n_vertices * sizeof *set);
    for (int32_t v = next_on_boundary(mesh, vertex); v != vertex && !c->marked[v]; v = next_on_boundary(mesh, v)) {
        set[v] = true;
        last = v;
    }
    return last;
}

/* set[v]: where the path may meet the next mirror: within a side of it, or anywhere on all that have no corners. */
static void mark_next_mirror(const chain *c, bool *set) {
    const int32_t n = c->search.mesh->n_vertices;
    int32_t k = 0;
    while (k < c->marks->n && c->loop[c->marks->vertex[k]] < 0)
        k++;
    const int32_t corner = k < c->marks->n ? c->marks->vertex[k] : -1;
    const int32_t last = corner >= 0 ? mark_after(c, corner, set) : -1;
    if (last >= 0) { /* if there are more, one is left for leaving */
        set[last] = next_on_boundary(c->search.mesh, corner) == last;
        return;
    }
    for (int32_t v = 0; v < n; v++)
        set[v] = corner >= 0 ? c->loop[v] == c->loop[corner] : c->loop[v] >= 0;
}

static void join_loop(chain *c, int32_t vertex) {
    const int32_t loop = c->loop[vertex];
    for (int32_t v = 0; v < c->search.mesh->n_vertices; v++)
        c->loop[v] = c->loop[v] == loop ? -1 : c->loop[v];
    c->joined++;
}

static orb_status blocked(int32_t vertex, orb_error *error) {
    return error_set_elements(
        error, ORB_CUT_BLOCKED, ORB_VERTEX, &vertex, 1, 1,
        "the cut to vertex %d would meet the boundary, itself or another cone whatever way it goes "
        "along edges: subdivide the mesh, or give cones and corners in another sequence",
        (int)vertex);
}

/* One segment: from the cone `from`, or -1: from where `leave` says, to the cone `to`, or -1: to where `arrive` says.
 * ends[2]: where it begins and ends. */
static orb_status add_segment(chain *c, int32_t from, int32_t to, int32_t ends[2], orb_error *error) {
    cut_search *search = &c->search;
    int32_t root = from, end = to, some = -1;
    for (int32_t v = 0; v < search->mesh->n_vertices; v++) {
        c->leave[v] = from < 0 && c->leave[v];
        c->taken[v] = c->taken[v] && !c->leave[v]; /* along the side it costs nothing */
        root = root < 0 && c->leave[v] ? v : root;
    }
    cut_search_grow(search, root);
    for (int32_t v = 0; v < search->mesh->n_vertices && to < 0; v++) {
        some = c->arrive[v] ? v : some;
        if (c->arrive[v] && search->distance[v] < INFINITY && (end < 0 || search->distance[v] < search->distance[end]))
            end = v;
    }
    if (end < 0 || search->distance[end] == INFINITY)
        return blocked(to < 0 ? some : to, error);
    int32_t v = end;
    while (search->tree[v] >= 0 && !c->leave[v]) {
        c->cut[search->tree[v]] = 1;
        c->taken[v] = true;
        v = edge_other_end(search->mesh, search->tree[v], v);
    }
    for (int32_t u = 0; u < search->mesh->n_vertices; u++)
        c->taken[u] = c->taken[u] || c->leave[u];
    ends[0] = v;
    ends[1] = end;
    return ORB_OK;
}

/* The first segment is looked for from its cone. */
static orb_status follow(chain *c, int32_t *base, orb_error *error) {
    int32_t at = -1, ends[2];
    orb_status status = ORB_OK;
    *base = -1;
    for (int32_t k = 0; k < c->marks->n && status == ORB_OK; k++) {
        const int32_t cone = c->marks->vertex[k];
        if (c->border[cone])
            continue;
        if (at >= 0) {
            status = add_segment(c, at, cone, ends, error);
        } else {
            mark_next_mirror(c, c->arrive);
            status = add_segment(c, cone, -1, ends, error);
            if (status == ORB_OK)
                join_loop(c, *base = ends[1]);
        }
        at = cone;
    }
    if (at < 0) {
        int32_t v = 0;
        mark_next_mirror(c, c->leave);
        while (!c->leave[v])
            v++;
        for (int32_t u = 0; u < c->search.mesh->n_vertices; u++) /* of one mirror only */
            c->leave[u] = c->leave[u] && c->loop[u] == c->loop[v];
        join_loop(c, v);
    }
    while (c->joined < c->n_loops && status == ORB_OK) {
        mark_next_mirror(c, c->arrive);
        status = add_segment(c, at, -1, ends, error);
        if (status != ORB_OK)
            break;
        *base = *base < 0 ? ends[0] : *base;
        join_loop(c, ends[1]);
        if (mark_after(c, ends[1], c->leave) < 0)
            c->leave[ends[1]] = true;
        at = -1;
    }
    return status;
}

orb_status cut_chain_find(const orb_mesh *mesh, const int32_t *parent, const orb_marks *marks, uint8_t *cut,
                          int32_t *start, orb_error *error) {
    chain c = {.search = {.mesh = mesh, .parent = parent}, .marks = marks, .cut = cut};
    int32_t base = -1;
    orb_status status = chain_allocate(&c, mesh) ? ORB_OK : error_memory(error);
    if (status == ORB_OK) {
        list_loops(&c);
        for (int32_t e = 0; e < mesh->n_edges; e++)
            cut[e] = edge_is_border(mesh, e);
        status = follow(&c, &base, error);
    }
    if (status == ORB_OK)
        *start = mesh->vertex_halfedge[base];
    chain_free(&c);
    return status;
}
