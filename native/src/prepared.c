/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "prepared.h"

#include <stdlib.h>

/* The pattern's rows are the vertices that are not isolated, in their sequence: row[n_vertices], and vertex[rows]. */
static void number_rows(const orb_mesh *mesh, int32_t *row, int32_t *vertex) {
    int32_t n = 0;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        row[v] = mesh->vertex_halfedge[v] < 0 ? -1 : n;
        if (row[v] >= 0)
            vertex[n++] = v;
    }
}

static orb_status analyze(orb_prepared *made, orb_error *error) {
    const orb_mesh *mesh = made->mesh;
    const size_t n = (size_t)mesh->n_vertices, edges = (size_t)mesh->n_edges;
    orb_status status = error_memory(error);
    int32_t *row = malloc((n + 1) * sizeof *row), *vertex = malloc((n + 1) * sizeof *vertex);
    int32_t *ends = malloc((2 * edges + 1) * sizeof *ends);
    made->slot = malloc((edges + 1) * sizeof *made->slot);
    made->order = malloc((n + 1) * sizeof *made->order);
    if (!row || !vertex || !ends || !made->slot || !made->order)
        goto done;
    number_rows(mesh, row, vertex);
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        ends[2 * e] = row[halfedge_from(mesh, mesh->edge_halfedge[e])];
        ends[2 * e + 1] = row[halfedge_to(mesh, mesh->edge_halfedge[e])];
    }
    status = pattern_of_pairs(mesh->n_used_vertices, mesh->n_edges, ends, &made->blocks, made->slot, error);
    if (status == ORB_OK)
        status = cholesky_order(&made->blocks, ORDERING_AMD, made->order, error);
    if (status == ORB_OK)
        status = cholesky_analyze(&made->blocks, made->order, true, &made->analysis, error);
    for (int32_t k = 0; k < mesh->n_used_vertices && status == ORB_OK; k++)
        made->order[k] = vertex[made->order[k]];
done:
    free(row);
    free(vertex);
    free(ends);
    return status;
}

orb_status orb_prepare(const orb_mesh_arrays *mesh, orb_prepared **prepared, orb_error *error) {
    if (prepared)
        *prepared = NULL;
    if (!mesh || !prepared)
        return error_set(error, ORB_BAD_ARGUMENT, "orb_prepare needs a mesh and a place for its result");
    orb_prepared *made = calloc(1, sizeof *made);
    if (!made)
        return error_memory(error);
    atomic_init(&made->holders, 1);
    orb_status status = mesh_create(mesh, &made->mesh, error);
    if (status == ORB_OK)
        status = mesh_require_connected(made->mesh, error);
    if (status == ORB_OK)
        status = cotangents_measure(made->mesh, &made->cotangents, error);
    if (status == ORB_OK)
        status = analyze(made, error);
    if (status != ORB_OK) {
        orb_prepared_free(made);
        return status;
    }
    *prepared = made;
    return error_set(error, ORB_OK, "%s", "");
}

orb_prepared *prepared_hold(const orb_prepared *prepared) {
    orb_prepared *held = (orb_prepared *)prepared; /* counting holders changes nothing that they see */
    if (held)
        atomic_fetch_add(&held->holders, 1);
    return held;
}

void orb_prepared_free(orb_prepared *prepared) {
    if (!prepared || atomic_fetch_sub(&prepared->holders, 1) > 1)
        return;
    mesh_free(prepared->mesh);
    cotangents_clear(&prepared->cotangents);
    pattern_clear(&prepared->blocks);
    free(prepared->slot);
    free(prepared->order);
    cholesky_free(prepared->analysis);
    free(prepared);
}
