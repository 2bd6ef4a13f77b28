/* Halving of marked edges; room for a path. SPDX-License-Identifier: GPL-3.0-or-later */
#include "refine.h"

#include <stdlib.h>
#include <string.h>

/* Writes the pieces of triangle v with the midpoints m (of v0 v1, v1 v2, v2 v0; -1 where the edge stays), and
 * returns how many. Which diagonal halves a quadrangle concerns this triangle alone. */
static int32_t split_triangle(const int32_t v[3], const int32_t m[3], int32_t *pieces) {
    int32_t n_marked = (m[0] >= 0) + (m[1] >= 0) + (m[2] >= 0);
    if (n_marked == 0) {
        memcpy(pieces, v, 3 * sizeof *pieces);
        return 1;
    }
    if (n_marked == 3) {
        const int32_t four[12] = {v[0], m[0], m[2], m[0], v[1], m[1], m[2], m[1], v[2], m[0], m[1], m[2]};
        memcpy(pieces, four, sizeof four);
        return 4;
    }
    /* Turn the triangle so that its odd edge out, the marked or the unmarked one, is first. */
    int32_t odd = 0;
    while ((m[odd] >= 0) != (n_marked == 1))
        odd++;
    int32_t a = v[odd], b = v[(odd + 1) % 3], c = v[(odd + 2) % 3];
    int32_t ab = m[odd], bc = m[(odd + 1) % 3], ca = m[(odd + 2) % 3];
    if (n_marked == 1) {
        const int32_t two[6] = {a, ab, c, ab, b, c};
        memcpy(pieces, two, sizeof two);
        return 2;
    }
    const int32_t three[9] = {bc, c, ca, a, b, bc, a, bc, ca};
    memcpy(pieces, three, sizeof three);
    return 3;
}

/* midpoint[edge]: the new vertex, or -1. Returns the number of vertices in all; it fits, for a mesh has at most
 * INT32_MAX / 3 vertices and INT32_MAX / 2 edges. */
static int32_t number_midpoints(const orb_mesh *mesh, const uint8_t *marked, int32_t *midpoint) {
    int32_t n_vertices = mesh->n_vertices;
    for (int32_t e = 0; e < mesh->n_edges; e++)
        midpoint[e] = marked[e] ? n_vertices++ : -1;
    return n_vertices;
}

static void place_midpoints(const orb_mesh *mesh, const int32_t *midpoint, double *vertices) {
    memcpy(vertices, mesh->vertices, (size_t)mesh->n_vertices * 3 * sizeof *vertices);
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        if (midpoint[e] < 0)
            continue;
        const double *a = mesh->vertices + 3 * (size_t)halfedge_from(mesh, mesh->edge_halfedge[e]);
        const double *b = mesh->vertices + 3 * (size_t)halfedge_to(mesh, mesh->edge_halfedge[e]);
        for (int i = 0; i < 3; i++) /* each halved first: the sum of two finite numbers need not be finite */
            vertices[3 * (size_t)midpoint[e] + i] = 0.5 * a[i] + 0.5 * b[i];
    }
}

orb_status refine_edges(const orb_mesh *mesh, const uint8_t *marked, orb_mesh **refined, int32_t **parent,
                        orb_error *error) {
    orb_status status = ORB_OK;
    double *vertices = NULL;
    int32_t *triangles = NULL, *from = NULL;
    *refined = NULL;
    *parent = NULL;

    int32_t *midpoint = malloc((size_t)mesh->n_edges * sizeof *midpoint + 1);
    if (!midpoint) {
        status = error_memory(error);
        goto done;
    }
    int32_t n_vertices = number_midpoints(mesh, marked, midpoint);
    int64_t n_triangles = mesh->n_triangles;
    for (int32_t h = 0; h < 3 * mesh->n_triangles; h++)
        n_triangles += midpoint[mesh->edge[h]] >= 0;
    if (n_vertices > INT32_MAX / 3 || n_triangles > INT32_MAX / 3) {
        status = error_set(error, ORB_BAD_ARGUMENT,
                           "the cut has no room between these cones, and the mesh is too large to be refined round "
                           "it (%d vertices, %lld triangles): use fewer cones",
                           (int)n_vertices, (long long)n_triangles);
        goto done;
    }
    vertices = malloc((size_t)n_vertices * 3 * sizeof *vertices + 1);
    triangles = malloc((size_t)n_triangles * 3 * sizeof *triangles + 1);
    from = malloc((size_t)n_triangles * sizeof *from + 1);
    if (!vertices || !triangles || !from) {
        status = error_memory(error);
        goto done;
    }
    place_midpoints(mesh, midpoint, vertices);
    int32_t n_pieces = 0;
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        const int32_t *edge = mesh->edge + 3 * (size_t)t;
        const int32_t m[3] = {midpoint[edge[0]], midpoint[edge[1]], midpoint[edge[2]]};
        int32_t n = split_triangle(mesh->triangles + 3 * (size_t)t, m, triangles + 3 * (size_t)n_pieces);
        for (int32_t i = 0; i < n; i++)
            from[n_pieces++] = t;
    }
    orb_mesh_arrays arrays = {n_vertices, vertices, (int32_t)n_triangles, triangles};
    status = mesh_create(&arrays, refined, error);
    if (status == ORB_OK) {
        *parent = from;
        from = NULL;
    }
done:
    free(midpoint);
    free(vertices);
    free(triangles);
    free(from);
    return status;
}

/* Why the next segment exists once the marked edges are halved. Let A be the vertices of the path and the cones; let
 * the mesh be a triangulated sphere (mesh_create has seen to it that no two edges and no two triangles have the same
 * vertices).
 *
 * (1) In the refined mesh two vertices of A are adjacent only if they follow one another on the path: every other
 *     edge between two of them was halved, and every new edge has a midpoint, which is not in A, at one end. Nor do
 *     three of them span a triangle: its edges would be three edges of a path that visits no vertex twice. So the
 *     full subcomplex on A (all simplices with all their vertices in A) is an arc, the path, and single points.
 * (2) Such a set, a disjoint union of compact contractible ones, does not separate the sphere (Alexander duality).
 * (3) What is left when a full subcomplex is taken out of a triangulated space retracts onto the full subcomplex on
 *     the remaining vertices: in each simplex, push away from the face in A. So the free vertices, together with
 *     the edges between them, are a connected graph.
 * (4) The path's last vertex has at least three edges of which at most one is the path's, and a cone off the path
 *     has none of these: by (1) all their other neighbours are free. Nothing else is needed for a path from the one
 *     to the other through free vertices.
 *
 * Why its own midpoints suffice. Let S be such a path that is also chordless: no edge of the refined mesh joins two
 * of its vertices that do not follow one another. Halve only the edges whose midpoints S visits; then each edge of S
 * still exists. If it is an edge of the input or one half of such an edge, this is clear. Else it lies within a
 * triangle abc of the input and joins two midpoints, or one midpoint, say of bc, to a. Two midpoints of a triangle
 * are adjacent wherever both are there. From bc's midpoint to a there is an edge if no other edge of abc is halved;
 * and none is, as its midpoint would be adjacent to both a and bc's midpoint: a chord of S one way or the other. */
void refine_mark(const orb_mesh *mesh, const int32_t *place, uint8_t *marked) {
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        int32_t a = place[halfedge_from(mesh, mesh->edge_halfedge[e])];
        int32_t b = place[halfedge_to(mesh, mesh->edge_halfedge[e])];
        bool on_path = a >= 0 && b >= 0 && (a - b == 1 || b - a == 1);
        marked[e] = (a != REFINE_FREE || b != REFINE_FREE) && !on_path;
    }
}
