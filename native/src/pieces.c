/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pieces.h"

#include <math.h>
#include <stddef.h>

/* The input triangle that a piece lies in; -1: a filled hole. */
static int32_t input_of(const orb_surface *surface, int32_t piece) {
    const int32_t plain = surface->parent ? surface->parent[piece] : piece;
    return plain < surface->n_input_triangles ? plain : -1;
}

/* barycentric[3*c ...]: corner c of the piece in its input triangle. Midpoints follow the plain mesh's vertices. */
static void corners_in_input(const orb_embedding *embedding, int32_t piece, int32_t triangle, double barycentric[9]) {
    const orb_surface *surface = embedding->surface;
    const orb_mesh *plain = surface->plain;
    for (int c = 0; c < 3; c++) {
        const int32_t v = embedding->mesh->triangles[3 * (size_t)piece + (size_t)c];
        int32_t end[2] = {v, v};
        if (v >= plain->n_vertices) {
            const int32_t h = plain->edge_halfedge[surface->halved[v - plain->n_vertices]];
            end[0] = halfedge_from(plain, h);
            end[1] = halfedge_to(plain, h);
        }
        for (int k = 0; k < 3; k++) {
            const int32_t u = surface->input_triangles[3 * (size_t)triangle + (size_t)k];
            barycentric[3 * c + k] = 0.5 * (u == end[0]) + 0.5 * (u == end[1]);
        }
    }
}

/* weight: of the point in the triangle of the three corners. The corners are at least 1/4 of the triangle. */
static void solve(const double corner[9], const double point[3], double weight[3]) {
    double total = 0;
    for (int c = 0; c < 3; c++) {
        const double *p = corner + 3 * ((c + 1) % 3), *q = corner + 3 * ((c + 2) % 3);
        weight[c] = point[0] * (p[1] * q[2] - p[2] * q[1]) + point[1] * (p[2] * q[0] - p[0] * q[2]) +
                    point[2] * (p[0] * q[1] - p[1] * q[0]);
        total += weight[c];
    }
    for (int c = 0; c < 3; c++)
        weight[c] /= total;
}

static int32_t first_piece(const orb_embedding *embedding, int32_t triangle) {
    const orb_surface *surface = embedding->surface;
    int32_t first = embedding->input_corners[3 * (size_t)triangle] / 3;
    while (surface->parent && first > 0 && input_of(surface, first - 1) == triangle)
        first--;
    return first;
}

void pieces_find(const orb_embedding *embedding, int32_t triangle, const double barycentric[3], int32_t *piece,
                 double weight[3]) {
    const orb_surface *surface = embedding->surface;
    double best = -INFINITY, corner[9], trial[3];
    for (int32_t t = first_piece(embedding, triangle);
         t < embedding->mesh->n_triangles && input_of(surface, t) == triangle; t++) {
        corners_in_input(embedding, t, triangle, corner);
        solve(corner, barycentric, trial);
        const double least = fmin(trial[0], fmin(trial[1], trial[2]));
        if (least <= best)
            continue;
        best = least;
        *piece = t;
        for (int c = 0; c < 3; c++)
            weight[c] = fmax(0, trial[c]);
    }
}

void pieces_join(const orb_embedding *embedding, int32_t piece, const double weight[3], int32_t *triangle,
                 double barycentric[3]) {
    double corner[9] = {0};
    *triangle = input_of(embedding->surface, piece);
    if (*triangle >= 0)
        corners_in_input(embedding, piece, *triangle, corner);
    for (int k = 0; k < 3; k++)
        barycentric[k] = weight[0] * corner[k] + weight[1] * corner[3 + k] + weight[2] * corner[6 + k];
}

int pieces_of_side(const orb_embedding *embedding, int32_t corner, orb_side_part parts[2]) {
    const orb_surface *surface = embedding->surface;
    const int32_t triangle = corner / 3;
    const int end = (corner + 1 - 3 * triangle) % 3, apart = (end + 1) % 3;
    int n = 0;
    for (int32_t t = first_piece(embedding, triangle);
         t < embedding->mesh->n_triangles && input_of(surface, t) == triangle; t++) {
        double place[9];
        corners_in_input(embedding, t, triangle, place);
        for (int c = 0; c < 3 && n < 2; c++) {
            const int next = (c + 1) % 3;
            if (place[3 * c + apart] != 0 || place[3 * next + apart] != 0)
                continue;
            const bool turned = place[3 * c + end] > place[3 * next + end];
            const int from = turned ? next : c, to = turned ? c : next;
            parts[n++] = (orb_side_part){t, from, to, {place[3 * from + end], place[3 * to + end]}};
        }
    }
    if (n == 2 && parts[0].at[0] > parts[1].at[0]) {
        const orb_side_part last = parts[0];
        parts[0] = parts[1];
        parts[1] = last;
    }
    return n;
}
