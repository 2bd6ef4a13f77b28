/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "shape.h"

#include <math.h>
#include <stdlib.h>

#include "sides.h"

static const double pi = 3.14159265358979323846;

void shape_lengths(const orb_mesh *mesh, double *lengths) {
    double longest = 0;
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        lengths[e] = mesh_edge_length(mesh, mesh->edge_halfedge[e]);
        longest = fmax(longest, lengths[e]);
    }
    if (!(longest > 0) || !isfinite(longest))
        return;
    const int exponent = ilogb(longest), half = exponent / 2; /* 2^1074 would not be a double */
    for (int32_t e = 0; e < mesh->n_edges; e++)
        lengths[e] = ldexp(ldexp(lengths[e], -half), half - exponent);
}

bool shape_allocate(orb_shape *shape, const orb_mesh *mesh) {
    const size_t n = (size_t)mesh->n_vertices + 1, m = (size_t)mesh->n_triangles + 1;
    shape->triangle_area = malloc(m * sizeof *shape->triangle_area);
    shape->area = malloc(n * sizeof *shape->area);
    shape->angle = malloc(n * sizeof *shape->angle);
    shape->cotangent = malloc(3 * m * sizeof *shape->cotangent);
    return shape->triangle_area && shape->area && shape->angle && shape->cotangent;
}

void shape_clear(orb_shape *shape) {
    free(shape->triangle_area);
    free(shape->area);
    free(shape->angle);
    free(shape->cotangent);
    *shape = (orb_shape){0};
}

/* One triangle's angles, cotangents and twice its area; false if its lengths make none. */
static bool measure(const double length[3], const double original[3], double angle[3], double cotangent[3],
                    double *area) {
    *area = sides_double_area(length);
    if (sides_angles(length, angle, cotangent))
        return true;
    double squares[2] = {0, 0};
    int longest = 0;
    for (int c = 0; c < 3; c++) {
        squares[0] += original[c] * original[c];
        squares[1] += length[c] * length[c];
        if (length[c] > length[longest])
            longest = c;
    }
    if (sides_angles(original, angle, cotangent)) {
        *area = sides_double_area(original) * squares[1] / squares[0];
    } else {
        cotangent[0] = cotangent[1] = cotangent[2] = 1 / sqrt(3);
        *area = squares[1] / 3 * sqrt(3) / 2;
    }
    for (int c = 0; c < 3; c++)
        angle[c] = c == longest ? pi : 0;
    return false;
}

void shape_measure(const orb_mesh *mesh, const double *lengths, const double *original, orb_shape *shape) {
    double total = 0;
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        shape->area[v] = shape->angle[v] = 0;
    shape->n_flat = 0;
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        double length[3], first[3], angle[3], *area = shape->triangle_area + t;
        for (int c = 0; c < 3; c++) {
            length[c] = lengths[mesh->edge[3 * t + c]];
            first[c] = original[mesh->edge[3 * t + c]];
        }
        shape->n_flat += !measure(length, first, angle, shape->cotangent + 3 * (size_t)t, area);
        total += *area;
        for (int c = 0; c < 3; c++) { /* side c faces the corner before it */
            const int32_t facing = mesh->triangles[3 * t + (c + 2) % 3];
            shape->angle[facing] += angle[c];
            shape->area[facing] += *area / 3;
        }
    }
    for (int32_t t = 0; t < mesh->n_triangles; t++)
        shape->triangle_area[t] /= total;
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        shape->area[v] /= total;
}

bool shape_flat_angles(const orb_mesh *mesh, double *angles) {
    bool *border = malloc((size_t)mesh->n_vertices + 1);
    if (!border)
        return false;
    mesh_find_boundary(mesh, border);
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        angles[v] = border[v] ? pi : 2 * pi;
    free(border);
    return true;
}
