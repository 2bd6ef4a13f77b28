/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "chords.h"

#include <math.h>
#include <stdlib.h>

#include "boundary.h"

/* side[2 * place]: the mirror sides before and after each boundary vertex; the same but at corners. */
static void number_sides(const orb_boundary *boundary, const bool *corner, int32_t *side) {
    int32_t sides = 0;
    for (int32_t l = 0; l < boundary->n_loops; l++) {
        int32_t begin = boundary->start[l], n = boundary->start[l + 1] - begin, first = 0;
        while (first < n && !corner[boundary->vertex[begin + first]])
            first++;
        for (int32_t i = 0; i < n; i++) { /* from a corner once round */
            int32_t place = begin + (first + i) % n;
            bool is_corner = corner[boundary->vertex[place]];
            side[2 * place] = sides;
            sides += is_corner && i > 0;
            side[2 * place + 1] = sides;
        }
        if (first < n)
            side[2 * (begin + first % n)] = sides;
        sides++;
    }
}

static bool is_chord(const orb_mesh *mesh, const orb_boundary *boundary, const int32_t *side, int32_t edge) {
    int32_t h = mesh->edge_halfedge[edge];
    int32_t a = boundary->place[halfedge_from(mesh, h)], b = boundary->place[halfedge_to(mesh, h)];
    if (mesh->twin[h] < 0 || a < 0 || b < 0)
        return false;
    return side[2 * a] == side[2 * b] || side[2 * a] == side[2 * b + 1] || side[2 * a + 1] == side[2 * b] ||
           side[2 * a + 1] == side[2 * b + 1];
}

orb_status chords_mark(const orb_mesh *mesh, const bool *corner, uint8_t *marked, int32_t *n_chords, orb_error *error) {
    orb_boundary *boundary = NULL;
    *n_chords = 0;
    orb_status status = boundary_list(mesh, &boundary, error);
    if (status != ORB_OK)
        return status;
    int32_t *side = malloc((2 * (size_t)boundary->start[boundary->n_loops] + 1) * sizeof *side);
    if (side) {
        number_sides(boundary, corner, side);
        for (int32_t e = 0; e < mesh->n_edges; e++) {
            marked[e] = is_chord(mesh, boundary, side, e);
            *n_chords += marked[e];
        }
    } else {
        status = error_memory(error);
    }
    free(side);
    boundary_free(boundary);
    return status;
}

/* The edge of a plain triangle with the ends a and b; -1. */
static int32_t plain_edge(const orb_mesh *plain, int32_t triangle, int32_t a, int32_t b) {
    for (int32_t h = 3 * triangle; h < 3 * triangle + 3; h++)
        if ((halfedge_from(plain, h) == a && halfedge_to(plain, h) == b) ||
            (halfedge_from(plain, h) == b && halfedge_to(plain, h) == a))
            return plain->edge[h];
    return -1;
}

/* Half-edge h of the refined mesh within plain triangle `triangle`. */
static double refined_weight(const orb_mesh *plain, const double *plain_weights, const int32_t *halved,
                             int32_t triangle, int32_t a, int32_t b) {
    int32_t n = plain->n_vertices, whole = plain_edge(plain, triangle, a, b), high = a > b ? a : b;
    if (whole >= 0)
        return plain_weights[whole];
    int32_t cut = halved[high - n], g = plain->edge_halfedge[cut], low = a > b ? b : a;
    if (low < n && (low == halfedge_from(plain, g) || low == halfedge_to(plain, g)))
        return 2 * plain_weights[cut];
    const int32_t *edge = plain->edge + 3 * (size_t)triangle;
    return fmin(plain_weights[edge[0]], fmin(plain_weights[edge[1]], plain_weights[edge[2]]));
}

void chords_refine_weights(const orb_mesh *plain, const double *plain_weights, const orb_mesh *refined,
                           const int32_t *parent, const int32_t *halved, double *weights) {
    for (int32_t e = 0; e < refined->n_edges; e++) {
        int32_t h = refined->edge_halfedge[e];
        weights[e] = refined_weight(plain, plain_weights, halved, parent[h / 3], halfedge_from(refined, h),
                                    halfedge_to(refined, h));
    }
}
