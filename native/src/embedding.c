/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "embedding.h"

#include <stdlib.h>

void orb_embedding_free(orb_embedding *embedding) {
    if (!embedding)
        return;
    mesh_free(embedding->mesh);
    signature_free(embedding->signature);
    tile_free(embedding->tile);
    holonomy_free(embedding->copies);
    free(embedding->cones);
    free(embedding->position);
    free(embedding->placed);
    free(embedding->weights);
    free(embedding->edge_weights);
    free(embedding->coordinates);
    free(embedding->coordinates_low);
    free(embedding->seams);
    free(embedding);
}

/* Edges whose two triangles lie at different copies of an end. */
static void find_seams(orb_embedding *embedding) {
    const orb_mesh *mesh = embedding->mesh;
    const int32_t *triangles = embedding->copies->triangles;
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        int32_t h = mesh->edge_halfedge[e], twin = mesh->twin[h];
        if (triangles[h] == triangles[halfedge_next(twin)] && triangles[halfedge_next(h)] == triangles[twin])
            continue;
        int32_t *seam = embedding->seams + 2 * (size_t)embedding->n_seams++;
        seam[0] = halfedge_from(mesh, h);
        seam[1] = halfedge_to(mesh, h);
    }
}

static void describe_mesh(orb_embedding *embedding) {
    const orb_mesh *mesh = embedding->mesh;
    orb_report *report = &embedding->report;
    report->vertices = mesh->n_vertices;
    report->triangles = mesh->n_triangles;
    report->components = mesh->n_components;
    report->euler = mesh->euler;
    report->boundary_loops = mesh->n_boundary_loops;
    report->genus = mesh->genus;
    report->orbifold_euler = embedding->signature->euler;
}

static orb_status count_float_flips(orb_embedding *embedding, orb_error *error) {
    double *uv = malloc((size_t)embedding->mesh->n_triangles * 6 * sizeof *uv);
    if (!uv)
        return error_memory(error);
    orb_status status = orb_uv(embedding, ORB_CHART_DEFAULT, uv, &embedding->report.flipped_float32, error);
    free(uv);
    return status;
}

orb_status embedding_finish(orb_embedding *embedding, orb_error *error) {
    const orb_mesh *mesh = embedding->mesh;
    const orb_copies *copies = embedding->copies;
    size_t n = (size_t)copies->n_copies, edges = (size_t)mesh->n_edges;
    embedding->coordinates = malloc((3 * n + 1) * sizeof *embedding->coordinates);
    embedding->coordinates_low = malloc((3 * n + 1) * sizeof *embedding->coordinates_low);
    embedding->edge_weights = malloc((3 * edges + 1) * sizeof *embedding->edge_weights);
    embedding->seams = malloc((2 * edges + 1) * sizeof *embedding->seams);
    if (!embedding->coordinates || !embedding->coordinates_low || !embedding->edge_weights || !embedding->seams)
        return error_memory(error);
    for (size_t u = 0; u < n; u++)
        geometry_coordinates(embedding->tile->geometry, embedding->placed[u], embedding->coordinates + 3 * u,
                             embedding->coordinates_low + 3 * u);
    for (size_t e = 0; e < edges; e++) {
        embedding->edge_weights[3 * e] = halfedge_from(mesh, mesh->edge_halfedge[e]);
        embedding->edge_weights[3 * e + 1] = halfedge_to(mesh, mesh->edge_halfedge[e]);
        embedding->edge_weights[3 * e + 2] = embedding->weights[e];
    }
    find_seams(embedding);
    if (embedding->n_seams > 0) { /* the room was for the worst case */
        int32_t *fitted = realloc(embedding->seams, 2 * (size_t)embedding->n_seams * sizeof *fitted);
        embedding->seams = fitted ? fitted : embedding->seams;
    }
    describe_mesh(embedding);
    return count_float_flips(embedding, error);
}

void orb_embedding_view(const orb_embedding *embedding, orb_view *view) {
    *view = (orb_view){.n_vertices = embedding->mesh->n_vertices,
                       .n_triangles = embedding->mesh->n_triangles,
                       .n_copies = embedding->copies->n_copies,
                       .n_cones = embedding->tile->n_cones,
                       .n_edges = embedding->mesh->n_edges,
                       .n_seams = embedding->n_seams,
                       .cut_triangles = embedding->copies->triangles,
                       .cut_to_vertex = embedding->copies->vertex,
                       .embedding = embedding->coordinates,
                       .embedding_low = embedding->coordinates_low,
                       .cones = embedding->cones,
                       .orders = embedding->tile->orders,
                       .weights = embedding->edge_weights,
                       .seams = embedding->seams,
                       .signature = embedding->signature->text,
                       .geometry = geometry_name(embedding->tile->geometry)};
}

void orb_embedding_report(const orb_embedding *embedding, orb_report *report) { *report = embedding->report; }
