/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "boundary.h"

#include <stdlib.h>
#include <string.h>

orb_status boundary_list(const orb_mesh *mesh, orb_boundary **result, orb_error *error) {
    *result = NULL;
    size_t n = (size_t)mesh->n_vertices + 1;
    orb_boundary *boundary = calloc(1, sizeof *boundary);
    if (!boundary)
        return error_memory(error);
    boundary->start = malloc(((size_t)mesh->n_boundary_loops + 1) * sizeof(int32_t));
    boundary->vertex = malloc(n * sizeof(int32_t));
    boundary->halfedge = malloc(n * sizeof(int32_t));
    boundary->place = malloc(n * sizeof(int32_t));
    if (!boundary->start || !boundary->vertex || !boundary->halfedge || !boundary->place) {
        boundary_free(boundary);
        return error_memory(error);
    }
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        boundary->place[v] = -1;
    int32_t filled = 0;
    for (int32_t h = 0; h < 3 * mesh->n_triangles; h++) {
        int32_t v = halfedge_from(mesh, h);
        if (mesh->twin[h] >= 0 || boundary->place[v] >= 0)
            continue;
        boundary->start[boundary->n_loops++] = filled;
        for (int32_t g = h; boundary->place[v] < 0; g = mesh_follow_boundary(mesh, g, &v)) {
            boundary->place[v] = filled;
            boundary->halfedge[filled] = g;
            boundary->vertex[filled++] = v;
        }
    }
    boundary->start[boundary->n_loops] = filled;
    *result = boundary;
    return ORB_OK;
}

void boundary_free(orb_boundary *boundary) {
    if (!boundary)
        return;
    free(boundary->start);
    free(boundary->vertex);
    free(boundary->halfedge);
    free(boundary->place);
    free(boundary);
}

int32_t boundary_loop_of(const orb_boundary *boundary, int32_t vertex) {
    int32_t loop = 0;
    if (boundary->place[vertex] < 0)
        return -1;
    while (boundary->start[loop + 1] <= boundary->place[vertex])
        loop++;
    return loop;
}

double boundary_length(const orb_mesh *mesh, const orb_boundary *boundary, int32_t loop) {
    double length = 0;
    for (int32_t i = boundary->start[loop]; i < boundary->start[loop + 1]; i++)
        length += mesh_edge_length(mesh, boundary->halfedge[i]);
    return length;
}

static void add_fan(const orb_mesh *mesh, const orb_boundary *boundary, int32_t loop, int32_t centre, double *vertices,
                    int32_t *triangles, int32_t *filled) {
    int32_t first = boundary->start[loop], n = boundary->start[loop + 1] - first;
    for (int32_t i = first; i < first + n; i++) {
        int32_t h = boundary->halfedge[i];
        const int32_t fan[3] = {halfedge_to(mesh, h), halfedge_from(mesh, h), centre};
        memcpy(triangles + 3 * (size_t)(*filled)++, fan, sizeof fan);
        for (int k = 0; k < 3; k++)
            vertices[3 * (size_t)centre + (size_t)k] += mesh->vertices[3 * (size_t)boundary->vertex[i] + (size_t)k] / n;
    }
}

orb_status boundary_close(const orb_mesh *mesh, const orb_boundary *boundary, const bool *closed, orb_mesh **result,
                          orb_error *error) {
    *result = NULL;
    int64_t n = mesh->n_vertices, m = mesh->n_triangles;
    for (int32_t l = 0; l < boundary->n_loops; l++) {
        n += closed[l];
        m += closed[l] ? boundary->start[l + 1] - boundary->start[l] : 0;
    }
    if (m > INT32_MAX / 3 || n > INT32_MAX / 3)
        return error_set(error, ORB_BAD_ARGUMENT, "the mesh is too large for its holes to be filled: fill them first");
    double *vertices = calloc(3 * (size_t)n, sizeof *vertices);
    int32_t *triangles = malloc(3 * (size_t)m * sizeof *triangles), filled = mesh->n_triangles;
    orb_status status = vertices && triangles ? ORB_OK : error_memory(error);
    if (status == ORB_OK) {
        memcpy(vertices, mesh->vertices, 3 * (size_t)mesh->n_vertices * sizeof *vertices);
        memcpy(triangles, mesh->triangles, 3 * (size_t)mesh->n_triangles * sizeof *triangles);
        for (int32_t l = 0, centre = mesh->n_vertices; l < boundary->n_loops; l++)
            if (closed[l])
                add_fan(mesh, boundary, l, centre++, vertices, triangles, &filled);
        orb_mesh_arrays arrays = {(int32_t)n, vertices, (int32_t)m, triangles};
        status = mesh_create(&arrays, result, error);
    }
    free(vertices);
    free(triangles);
    return status;
}

/* ------------------------------------------------------------------------------------------------------- ranking */

typedef struct ranked_loop {
    int32_t loop, picks;
    double length;
} ranked_loop;

static int mirrors_first(const void *a, const void *b) {
    const ranked_loop *x = a, *y = b;
    if ((x->picks > 0) != (y->picks > 0))
        return x->picks > 0 ? -1 : 1;
    if (x->length != y->length)
        return x->length > y->length ? -1 : 1;
    return x->loop - y->loop;
}

orb_status boundary_rank(const orb_mesh *mesh, const orb_boundary *boundary, int32_t n_picks, const int32_t *picks,
                         int32_t *rank, orb_error *error) {
    ranked_loop *loops = malloc(((size_t)boundary->n_loops + 1) * sizeof *loops);
    if (!loops)
        return error_memory(error);
    for (int32_t l = 0; l < boundary->n_loops; l++)
        loops[l] = (ranked_loop){l, 0, boundary_length(mesh, boundary, l)};
    for (int32_t i = 0; i < n_picks; i++) {
        const int32_t loop = boundary_loop_of(boundary, picks[i]);
        if (loop >= 0)
            loops[loop].picks++;
    }
    qsort(loops, (size_t)boundary->n_loops, sizeof *loops, mirrors_first);
    for (int32_t l = 0; l < boundary->n_loops; l++)
        rank[l] = loops[l].loop;
    free(loops);
    return ORB_OK;
}
