/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "farthest.h"

#include <math.h>
#include <stdlib.h>

#include "shortest.h"

/* The eligible vertex farthest from the mean of all used ones; -1: none is eligible. */
static int32_t outermost(const orb_mesh *mesh, const bool *eligible) {
    double mean[3] = {0, 0, 0}, most = -1;
    int32_t found = -1;
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        for (int c = 0; c < 3 && mesh->vertex_halfedge[v] >= 0; c++)
            mean[c] += mesh->vertices[3 * (size_t)v + (size_t)c] / mesh->n_used_vertices;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        double distance = 0;
        for (int c = 0; c < 3; c++)
            distance = hypot(distance, mesh->vertices[3 * (size_t)v + (size_t)c] - mean[c]);
        if (eligible[v] && distance > most) {
            most = distance;
            found = v;
        }
    }
    return found;
}

/* The eligible vertex with the greatest positive distance; -1: none. */
static int32_t farthest(const orb_mesh *mesh, const bool *eligible, const double *distance) {
    int32_t found = -1;
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        if (eligible[v] && distance[v] > 0 && (found < 0 || distance[v] > distance[found]))
            found = v;
    return found;
}

orb_status farthest_points(const orb_mesh *mesh, const bool *eligible, const int32_t *image, int32_t n_start,
                           const int32_t *start, int32_t count, int32_t *points, int32_t *n_points, orb_error *error) {
    *n_points = 0;
    shortest_search search = {0};
    double *distance = malloc(((size_t)mesh->n_vertices + 1) * sizeof *distance);
    orb_status status = error_memory(error);
    if (!distance || !shortest_allocate(&search, mesh->n_vertices))
        goto done;
    status = ORB_OK;
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        distance[v] = INFINITY;
    for (int32_t k = 0; k < n_start; k++)
        shortest_lower(&search, mesh, start[k], distance);
    while (*n_points < count) {
        const bool none = n_start == 0 && *n_points == 0;
        const int32_t next = none ? outermost(mesh, eligible) : farthest(mesh, eligible, distance);
        if (next < 0)
            break;
        points[(*n_points)++] = next;
        shortest_lower(&search, mesh, next, distance);
        if (image && image[next] != next)
            shortest_lower(&search, mesh, image[next], distance);
    }
done:
    shortest_clear(&search);
    free(distance);
    return status;
}
