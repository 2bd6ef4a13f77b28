/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "laplacian.h"

#include <stdlib.h>
#include <string.h>

enum { MANY_VERTICES = 100000 }; /* from here on METIS's ordering saves more than it costs (docs/decisions.md) */

orb_status laplacian_create(const orb_mesh *mesh, orb_laplacian **result, orb_error *error) {
    *result = NULL;
    orb_status status = error_memory(error);
    orb_laplacian *laplacian = calloc(1, sizeof *laplacian);
    int32_t *ends = malloc((2 * (size_t)mesh->n_edges + 1) * sizeof *ends);
    int32_t *order = malloc(((size_t)mesh->n_vertices + 1) * sizeof *order);
    if (!laplacian || !ends || !order)
        goto done;
    laplacian->mesh = mesh;
    laplacian->slot = malloc(((size_t)mesh->n_edges + 1) * sizeof *laplacian->slot);
    if (!laplacian->slot)
        goto done;
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        ends[2 * e] = halfedge_from(mesh, mesh->edge_halfedge[e]);
        ends[2 * e + 1] = halfedge_to(mesh, mesh->edge_halfedge[e]);
    }
    status = pattern_of_pairs(mesh->n_vertices, mesh->n_edges, ends, &laplacian->pattern, laplacian->slot, error);
    if (status != ORB_OK)
        goto done;
    laplacian->values = malloc((size_t)laplacian->pattern.column[mesh->n_vertices] * sizeof *laplacian->values + 1);
    status = laplacian->values ? ORB_OK : error_memory(error);
    if (status == ORB_OK)
        status = cholesky_order(&laplacian->pattern, mesh->n_vertices > MANY_VERTICES ? ORDERING_METIS : ORDERING_AMD,
                                order, error);
    if (status == ORB_OK)
        status = cholesky_analyze(&laplacian->pattern, order, false, &laplacian->cholesky, error);
done:
    free(ends);
    free(order);
    if (status == ORB_OK)
        *result = laplacian;
    else
        laplacian_free(laplacian);
    return status;
}

void laplacian_free(orb_laplacian *laplacian) {
    if (!laplacian)
        return;
    pattern_clear(&laplacian->pattern);
    free(laplacian->slot);
    free(laplacian->values);
    cholesky_free(laplacian->cholesky);
    free(laplacian);
}

orb_status laplacian_factor(orb_laplacian *laplacian, const double *cotangent, const double *area, double shift,
                            bool *positive, orb_error *error) {
    const orb_mesh *mesh = laplacian->mesh;
    const int64_t *column = laplacian->pattern.column;
    double *values = laplacian->values;
    laplacian->pinned = shift == 0 ? mesh->triangles[0] : -1;
    memset(values, 0, (size_t)column[mesh->n_vertices] * sizeof *values);
    for (int32_t h = 0; h < 3 * mesh->n_triangles; h++) {
        const int32_t a = halfedge_from(mesh, h), b = halfedge_to(mesh, h);
        const double weight = 0.5 * cotangent[h];
        values[column[a]] += weight;
        values[column[b]] += weight;
        if (a != laplacian->pinned && b != laplacian->pinned)
            values[laplacian->slot[mesh->edge[h]]] -= weight;
    }
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        if (v == laplacian->pinned || mesh->vertex_halfedge[v] < 0)
            values[column[v]] = 1;
        else
            values[column[v]] += shift * area[v];
    }
    return cholesky_factor(laplacian->cholesky, values, positive, error);
}

orb_status laplacian_solve(orb_laplacian *laplacian, double *right, int32_t n_right, orb_error *error) {
    for (int32_t k = 0; k < n_right && laplacian->pinned >= 0; k++)
        right[(size_t)k * (size_t)laplacian->mesh->n_vertices + (size_t)laplacian->pinned] = 0;
    return cholesky_solve(laplacian->cholesky, right, n_right, right, error);
}
