/* Cones and corners spread over any mesh. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef SPREAD_PICKS_H
#define SPREAD_PICKS_H

#include "surfaces.h"

/* The boundary's edges, sides[h] == 1 of half-edge h. */
static inline bool *border_sides(const sample_mesh *mesh) {
    const int32_t n = 3 * mesh->n_triangles;
    int32_t *edge = sample_allocate((size_t)n, sizeof *edge), *sides = sample_allocate((size_t)n, sizeof *sides);
    bool *border = sample_allocate((size_t)n, sizeof *border);
    sample_edges(mesh, edge, sides);
    for (int32_t h = 0; h < n; h++)
        border[h] = sides[edge[h]] == 1;
    free(sides);
    free(edge);
    return border;
}

/* The loop through a boundary vertex, whichever way the triangles run; marks it and returns its length. */
static inline int32_t walk_loop(const sample_mesh *mesh, const bool *border, int32_t start, bool *seen, int32_t *loop) {
    int32_t n = 0, last = -1;
    for (int32_t at = start; n == 0 || at != start;) {
        int32_t next = -1;
        seen[loop[n++] = at] = true;
        for (int32_t h = 0; h < 3 * mesh->n_triangles && next < 0; h++) {
            const int32_t a = mesh->triangles[h], b = mesh->triangles[h % 3 == 2 ? h - 2 : h + 1];
            if (border[h] && (a == at || b == at) && a + b - at != last)
                next = a + b - at;
        }
        last = at, at = next;
    }
    return n;
}

/* Cones far apart, then for each * its corners, evenly by edges; *marked[] are the vertices picked or on the boundary. */
static inline int32_t pick(const sample_mesh *mesh, const char *signature, int32_t n_interior, int32_t *picked) {
    int32_t n = n_interior, *loop = sample_allocate((size_t)mesh->n_vertices, sizeof *loop);
    bool *border = border_sides(mesh), *seen = sample_allocate((size_t)mesh->n_vertices, sizeof *seen);
    for (const char *star = strchr(signature, '*'); star; star = strchr(star + 1, '*')) {
        int32_t start = -1;
        for (int32_t h = 0; h < 3 * mesh->n_triangles && start < 0; h++)
            if (border[h] && !seen[mesh->triangles[h]])
                start = mesh->triangles[h];
        const int32_t length = walk_loop(mesh, border, start, seen, loop);
        const int32_t corners = (int32_t)strspn(star + 1, "0123456789");
        for (int32_t i = 0; i < corners; i++)
            picked[n++] = loop[i * length / corners];
    }
    for (int32_t i = 0; i < n_interior; i++) {
        bool any = false;
        for (int32_t v = 0; v < mesh->n_vertices; v++)
            any = any || seen[v];
        seen[0] = seen[0] || !any;
        seen[picked[i] = sample_farthest(mesh, seen)] = true;
    }
    free(seen);
    free(border);
    free(loop);
    return n;
}

#endif
