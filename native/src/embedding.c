/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "embedding.h"

#include <stdlib.h>

void orb_embedding_free(orb_embedding *embedding) {
    if (!embedding)
        return;
    surface_free(embedding->surface);
    tile_free(embedding->tile);
    free(embedding->corners);
    holonomy_free(embedding->copies);
    free(embedding->position);
    free(embedding->placed);
    free(embedding->weights);
    free(embedding->edge_weights);
    free(embedding->coordinates);
    free(embedding->coordinates_low);
    free(embedding->seams);
    free(embedding->refined_from);
    free(embedding->input_corners);
    free(embedding->generators);
    free(embedding);
}

bool embedding_is_seam(const orb_embedding *embedding, int32_t e) {
    const int32_t *triangles = embedding->copies->triangles;
    int32_t h = embedding->mesh->edge_halfedge[e], twin = embedding->mesh->twin[h];
    return twin >= 0 &&
           (triangles[h] != triangles[halfedge_next(twin)] || triangles[halfedge_next(h)] != triangles[twin]);
}

static void find_seams(orb_embedding *embedding) {
    const orb_mesh *mesh = embedding->mesh;
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        int32_t h = mesh->edge_halfedge[e];
        if (!embedding_is_seam(embedding, e))
            continue;
        int32_t *seam = embedding->seams + 2 * (size_t)embedding->n_seams++;
        seam[0] = halfedge_from(mesh, h);
        seam[1] = halfedge_to(mesh, h);
    }
}

/* Where each triangle and each corner of the input is in the mesh that was embedded. */
static orb_status find_input(orb_embedding *embedding, orb_error *error) {
    const orb_surface *surface = embedding->surface;
    const orb_mesh *mesh = embedding->mesh;
    bool same = !surface->parent && surface->n_closed == 0;
    int32_t *from = malloc(((size_t)mesh->n_triangles + 1) * sizeof *from);
    int32_t *corners = malloc((3 * (size_t)surface->n_input_triangles + 1) * sizeof *corners);
    embedding->input_corners = corners;
    embedding->refined_from = from;
    if (!from || !corners)
        return error_memory(error);
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        int32_t plain = surface->parent ? surface->parent[t] : t;
        from[t] = plain < surface->n_input_triangles ? plain : -1;
        for (int32_t h = 3 * t; h < 3 * t + 3 && from[t] >= 0; h++)
            for (int32_t c = 3 * plain; c < 3 * plain + 3; c++)
                if (surface->input_triangles[c] == mesh->triangles[h])
                    corners[c] = h;
    }
    if (same) {
        free(from);
        embedding->refined_from = NULL;
    }
    return ORB_OK;
}

static orb_status list_generators(orb_embedding *embedding, orb_error *error) {
    const orb_tile *tile = embedding->tile;
    embedding->generators = malloc((9 * (size_t)tile->word->n_sides + 1) * sizeof *embedding->generators);
    if (!embedding->generators)
        return error_memory(error);
    for (int32_t s = 0; s < tile->word->n_sides && !tile->fixed; s++)
        if (tile->word->partner[s] >= s)
            isometry_matrix(tile->geometry, tile->pairings[s],
                            embedding->generators + 9 * (size_t)embedding->n_generators++);
    return ORB_OK;
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
    embedding->edge_weights = embedding->weights ? malloc((3 * edges + 1) * sizeof *embedding->edge_weights) : NULL;
    embedding->seams = malloc((2 * edges + 1) * sizeof *embedding->seams);
    if (!embedding->coordinates || !embedding->coordinates_low || !embedding->seams ||
        (embedding->weights && !embedding->edge_weights))
        return error_memory(error);
    for (size_t u = 0; u < n; u++)
        geometry_coordinates(embedding->tile->geometry, embedding->placed[u], embedding->coordinates + 3 * u,
                             embedding->coordinates_low + 3 * u);
    for (size_t e = 0; e < edges && embedding->weights; e++) {
        embedding->edge_weights[3 * e] = halfedge_from(mesh, mesh->edge_halfedge[e]);
        embedding->edge_weights[3 * e + 1] = halfedge_to(mesh, mesh->edge_halfedge[e]);
        embedding->edge_weights[3 * e + 2] = embedding->weights[e];
    }
    find_seams(embedding);
    if (embedding->n_seams > 0) { /* the room was for the worst case */
        int32_t *fitted = realloc(embedding->seams, 2 * (size_t)embedding->n_seams * sizeof *fitted);
        embedding->seams = fitted ? fitted : embedding->seams;
    }
    orb_status status = find_input(embedding, error);
    if (status == ORB_OK)
        status = list_generators(embedding, error);
    return status == ORB_OK ? count_float_flips(embedding, error) : status;
}

void orb_embedding_view(const orb_embedding *embedding, orb_view *view) {
    const orb_surface *surface = embedding->surface;
    *view = (orb_view){.n_vertices = embedding->mesh->n_vertices,
                       .n_triangles = embedding->mesh->n_triangles,
                       .n_copies = embedding->copies->n_copies,
                       .n_cones = surface->n_marks,
                       .n_edges = embedding->mesh->n_edges,
                       .n_seams = embedding->n_seams,
                       .n_input_triangles = surface->n_input_triangles,
                       .vertices = embedding->mesh->vertices,
                       .triangles = embedding->mesh->triangles,
                       .refined_from = embedding->refined_from,
                       .input_corners = embedding->input_corners,
                       .cut_triangles = embedding->copies->triangles,
                       .cut_to_vertex = embedding->copies->vertex,
                       .embedding = embedding->coordinates,
                       .embedding_low = embedding->coordinates_low,
                       .cones = surface->vertex,
                       .orders = surface->order,
                       .mirrors = surface->mirror,
                       .weights = embedding->edge_weights,
                       .n_generators = embedding->n_generators,
                       .generators = embedding->generators,
                       .seams = embedding->seams,
                       .signature = surface->signature ? surface->signature->text : "",
                       .geometry = geometry_name(embedding->tile->geometry)};
}

void orb_embedding_report(const orb_embedding *embedding, orb_report *report) { *report = embedding->report; }
