/* Trees of shortest paths over a mesh that is to be cut. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_CUT_SEARCH_H
#define ORB_CUT_SEARCH_H

#include "mesh.h"

typedef struct cut_search {
    const orb_mesh *mesh;
    const int32_t *parent;     /* [n_triangles] or NULL: no edge between two triangles with the same parent is used */
    double *length;            /* [n_edges] */
    int32_t *first, *incident; /* the edges at vertex v: incident[first[v]] ... incident[first[v + 1] - 1] */
    double *distance;          /* [n_vertices] from the root */
    int32_t *tree;             /* [n_vertices] the edge towards the root; -1 */
    int32_t *heap, *slot;      /* [n_vertices] */
    int32_t n_heap;
    const bool *taken; /* [n_vertices] vertices that paths may end in but not go through; NULL: none */
} cut_search;

/* Lists the edges and those at each vertex; false when out of memory. Start from mesh, parent, taken and zeros. */
bool cut_search_allocate(cut_search *search);
void cut_search_clear(cut_search *search);

/* Dijkstra's tree of paths along edges; those of the boundary are cut in any case, and cost nothing. */
void cut_search_grow(cut_search *search, int32_t root);

static inline int32_t edge_end(const orb_mesh *mesh, int32_t edge, int side) {
    int32_t h = mesh->edge_halfedge[edge];
    return side ? halfedge_to(mesh, h) : halfedge_from(mesh, h);
}
static inline int32_t edge_other_end(const orb_mesh *mesh, int32_t edge, int32_t end) {
    return edge_end(mesh, edge, edge_end(mesh, edge, 0) == end);
}
static inline bool edge_is_border(const orb_mesh *mesh, int32_t edge) {
    return mesh->twin[mesh->edge_halfedge[edge]] < 0;
}

/* Within one triangle of which both sides are parts: neither cut nor walked along. */
static inline bool edge_is_inner(const cut_search *search, int32_t edge) {
    int32_t h = search->mesh->edge_halfedge[edge], g = search->mesh->twin[h];
    const int32_t *parent = search->parent;
    return parent && g >= 0 && parent[h / 3] >= 0 && parent[h / 3] == parent[g / 3];
}

#endif
