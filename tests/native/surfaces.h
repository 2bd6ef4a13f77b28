/* Surfaces of any topology for the C tests. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Built by sums of a sphere, tori and projective planes, and by taking out rings of triangles; vertices are moved at
 * random, so that weights are generic. Where the surface lies in space, and whether it crosses itself, does not
 * matter. */
#ifndef SURFACES_H
#define SURFACES_H

#include "meshes.h"
#include "random.h"

/* Without the triangles marked in gone[n_triangles], and without vertices that no other uses. */
static inline sample_mesh sample_without(const sample_mesh *mesh, const bool *gone) {
    int32_t *number = sample_allocate((size_t)mesh->n_vertices, sizeof *number), n = 0, m = 0;
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        for (int c = 0; c < 3 && !gone[t]; c++)
            number[mesh->triangles[3 * (size_t)t + (size_t)c]] = 1;
        m += !gone[t];
    }
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        number[v] = number[v] ? n++ : -1;
    sample_mesh rest = sample_new(n, m);
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        if (number[v] >= 0)
            memcpy(rest.vertices + 3 * (size_t)number[v], mesh->vertices + 3 * (size_t)v, 3 * sizeof(double));
    int32_t *out = rest.triangles;
    for (int32_t t = 0; t < mesh->n_triangles; t++)
        for (int c = 0; c < 3 && !gone[t]; c++)
            *out++ = number[mesh->triangles[3 * (size_t)t + (size_t)c]];
    free(number);
    return rest;
}

/* With a hole: without all triangles within `rings` of a vertex. */
static inline sample_mesh sample_punctured(const sample_mesh *mesh, int32_t vertex, int rings) {
    bool *inside = sample_allocate((size_t)mesh->n_vertices, sizeof *inside);
    bool *gone = sample_allocate((size_t)mesh->n_triangles, sizeof *gone);
    inside[vertex] = true;
    for (int ring = 0; ring < rings; ring++) {
        for (int32_t t = 0; t < mesh->n_triangles; t++) {
            const int32_t *corner = mesh->triangles + 3 * (size_t)t;
            gone[t] = inside[corner[0]] || inside[corner[1]] || inside[corner[2]];
        }
        for (int32_t t = 0; t < mesh->n_triangles; t++)
            for (int c = 0; c < 3 && gone[t]; c++)
                inside[mesh->triangles[3 * (size_t)t + (size_t)c]] = true;
    }
    sample_mesh rest = sample_without(mesh, gone);
    free(gone);
    free(inside);
    return rest;
}

/* The connected sum: triangle s of a and triangle t of b are taken out and their corners glued, b moved there. */
static inline sample_mesh sample_sum(const sample_mesh *a, int32_t s, const sample_mesh *b, int32_t t) {
    sample_mesh sum = sample_new(a->n_vertices + b->n_vertices, a->n_triangles + b->n_triangles);
    const int32_t *on_a = a->triangles + 3 * (size_t)s, *on_b = b->triangles + 3 * (size_t)t;
    double shift[3] = {0};
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < 3; k++)
            shift[k] +=
                (a->vertices[3 * (size_t)on_a[c] + (size_t)k] - b->vertices[3 * (size_t)on_b[c] + (size_t)k]) / 3;
    memcpy(sum.vertices, a->vertices, 3 * (size_t)a->n_vertices * sizeof(double));
    memcpy(sum.triangles, a->triangles, 3 * (size_t)a->n_triangles * sizeof(int32_t));
    for (size_t i = 0; i < 3 * (size_t)b->n_vertices; i++)
        sum.vertices[3 * (size_t)a->n_vertices + i] = b->vertices[i] + shift[i % 3];
    for (size_t i = 0; i < 3 * (size_t)b->n_triangles; i++) {
        int32_t v = b->triangles[i] + a->n_vertices;
        for (int c = 0; c < 3; c++)
            if (b->triangles[i] == on_b[c])
                v = on_a[(3 - c) % 3]; /* the other way round */
        sum.triangles[3 * (size_t)a->n_triangles + i] = v;
    }
    bool *gone = sample_allocate((size_t)sum.n_triangles, sizeof *gone);
    gone[s] = gone[a->n_triangles + t] = true;
    sample_mesh glued = sample_without(&sum, gone);
    free(gone);
    sample_free(&sum);
    return glued;
}

/* The projective plane: the icosphere's antipodal vertices are one. Level at least 1. */
static inline sample_mesh sample_projective_plane(int level) {
    sample_mesh sphere = sample_icosphere(level);
    int32_t *kept = sample_allocate((size_t)sphere.n_vertices, sizeof *kept);
    bool *gone = sample_allocate((size_t)sphere.n_triangles, sizeof *gone);
    for (int32_t v = 0; v < sphere.n_vertices; v++)
        for (int32_t u = kept[v] = v; u >= 0; u--) {
            const double *p = sphere.vertices + 3 * (size_t)v, *q = sphere.vertices + 3 * (size_t)u;
            if (fabs(p[0] + q[0]) + fabs(p[1] + q[1]) + fabs(p[2] + q[2]) < 1e-9)
                kept[v] = u;
        }
    for (int32_t t = 0; t < sphere.n_triangles; t++) {
        int32_t *corner = sphere.triangles + 3 * (size_t)t;
        for (int c = 0; c < 3; c++)
            corner[c] = kept[corner[c]];
        for (int32_t u = 0; u < t; u++) { /* its antipode */
            const int32_t *other = sphere.triangles + 3 * (size_t)u;
            int shared = 0;
            for (int c = 0; c < 9; c++)
                shared += corner[c / 3] == other[c % 3];
            gone[t] = gone[t] || shared == 3;
        }
    }
    sample_mesh plane = sample_without(&sphere, gone);
    for (int32_t v = 0; v < plane.n_vertices; v++) { /* Steiner's surface */
        double *p = plane.vertices + 3 * (size_t)v, x = p[0], y = p[1], z = p[2];
        p[0] = y * z, p[1] = x * z, p[2] = x * y;
    }
    free(gone);
    free(kept);
    sample_free(&sphere);
    return plane;
}

/* Every vertex moved by up to `amount` in each direction. */
static inline void sample_roughen(sample_mesh *mesh, double amount, uint64_t seed) {
    random_state state = {seed};
    for (size_t i = 0; i < 3 * (size_t)mesh->n_vertices; i++)
        mesh->vertices[i] += amount * (2 * random_unit(&state) - 1);
}

/* The vertex farthest from those marked, by edges; ties go to the lowest. marked[n_vertices] is not empty. */
static inline int32_t sample_farthest(const sample_mesh *mesh, const bool *marked) {
    int32_t *ring = sample_allocate((size_t)mesh->n_vertices, sizeof *ring), farthest = 0;
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        ring[v] = marked[v] ? 0 : INT32_MAX - 1;
    for (bool changed = true; changed;) {
        changed = false;
        for (int32_t h = 0; h < 3 * mesh->n_triangles; h++) {
            const int32_t a = mesh->triangles[h], b = mesh->triangles[h % 3 == 2 ? h - 2 : h + 1];
            if (ring[a] > ring[b] + 1)
                ring[a] = ring[b] + 1, changed = true;
            if (ring[b] > ring[a] + 1)
                ring[b] = ring[a] + 1, changed = true;
        }
    }
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        if (ring[v] < INT32_MAX - 1 && ring[v] > ring[farthest])
            farthest = v;
    free(ring);
    return farthest;
}

/* A sphere with these handles, cross-caps and holes. */
static inline sample_mesh sample_surface(int handles, int crosscaps, int holes) {
    sample_mesh mesh = sample_icosphere(2);
    sample_roughen(&mesh, 0.02, 7);
    for (int i = 0; i < handles + crosscaps; i++) {
        sample_mesh part = i < handles ? sample_torus(7, 6, 0.5, 0.25) : sample_projective_plane(2);
        sample_roughen(&part, 0.01, (uint64_t)i);
        sample_mesh sum = sample_sum(&mesh, 31 * i, &part, 5);
        sample_free(&part);
        sample_free(&mesh);
        mesh = sum;
    }
    bool *marked = sample_allocate((size_t)mesh.n_vertices, sizeof *marked);
    for (int i = 0; i < holes; i++) {
        memset(marked, 0, (size_t)mesh.n_vertices * sizeof *marked);
        int32_t *edge = sample_allocate(3 * (size_t)mesh.n_triangles, sizeof *edge);
        int32_t *sides = sample_allocate(3 * (size_t)mesh.n_triangles, sizeof *sides);
        sample_edges(&mesh, edge, sides);
        for (int32_t h = 0; h < 3 * mesh.n_triangles; h++)
            if (sides[edge[h]] == 1)
                marked[mesh.triangles[h]] = marked[mesh.triangles[h % 3 == 2 ? h - 2 : h + 1]] = true;
        free(sides);
        free(edge);
        if (i == 0)
            marked[0] = true;
        sample_mesh rest = sample_punctured(&mesh, sample_farthest(&mesh, marked), 2);
        sample_free(&mesh);
        mesh = rest;
    }
    free(marked);
    return mesh;
}

#endif
