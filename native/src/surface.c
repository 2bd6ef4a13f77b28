/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "surface.h"

#include <stdlib.h>
#include <string.h>

#include "boundary.h"
#include "chords.h"
#include "picks.h"
#include "prepared.h"
#include "refine.h"
#include "topology.h"
#include "weights.h"

/* --- which boundary loops are mirrors, which are holes ----------------------------------------------------------- */

/* closed[n_loops]: those that are left when the first ones have become mirrors. */
static orb_status choose_holes(const orb_mesh *mesh, const orb_boundary *boundary, int32_t n_mirrors,
                               const orb_request *request, bool *closed, orb_error *error) {
    int32_t *rank = malloc(((size_t)boundary->n_loops + 1) * sizeof *rank);
    orb_status status =
        rank ? boundary_rank(mesh, boundary, request->n_cones, request->cones, rank, error) : error_memory(error);
    for (int32_t l = 0; l < boundary->n_loops && status == ORB_OK; l++)
        closed[rank[l]] = l >= n_mirrors;
    free(rank);
    return status;
}

/* Sets surface->plain; takes the input over. */
static orb_status close_holes(orb_surface *surface, orb_mesh *input, const orb_boundary *boundary, const bool *closed,
                              orb_error *error) {
    for (int32_t l = 0; l < boundary->n_loops; l++)
        surface->n_closed += closed[l];
    surface->plain = input;
    if (surface->n_closed == 0)
        return ORB_OK;
    orb_status status = boundary_close(input, boundary, closed, &surface->plain, error);
    mesh_free(input);
    return status;
}

/* --- chords ------------------------------------------------------------------------------------------------------ */

static orb_status halve_chords(orb_surface *surface, const uint8_t *halve, orb_error *error) {
    surface->mesh = surface->plain;
    if (surface->plain->n_boundary_loops == 0)
        return ORB_OK;
    const orb_mesh *plain = surface->plain;
    uint8_t *marked = malloc((size_t)plain->n_edges + 1);
    bool *corner = calloc((size_t)plain->n_vertices + 1, sizeof *corner);
    orb_status status = marked && corner ? ORB_OK : error_memory(error);
    for (int32_t k = 0; k < surface->n_marks && status == ORB_OK; k++)
        corner[surface->vertex[k]] = surface->mirror[k];
    if (status == ORB_OK)
        status = chords_mark(plain, corner, marked, &surface->n_halved, error);
    for (int32_t e = 0; e < plain->n_edges && halve && status == ORB_OK; e++)
        if (marked[e] && !halve[e]) {
            marked[e] = 0;
            surface->n_halved--;
        }
    if (status != ORB_OK || surface->n_halved == 0)
        goto done;
    surface->halved = malloc((size_t)surface->n_halved * sizeof *surface->halved);
    if (!surface->halved) {
        status = error_memory(error);
        goto done;
    }
    for (int32_t e = 0, k = 0; e < plain->n_edges; e++)
        if (marked[e])
            surface->halved[k++] = e;
    surface->mesh = NULL;
    status = refine_edges(surface->plain, marked, &surface->mesh, &surface->parent, error);
done:
    free(corner);
    free(marked);
    return status;
}

/* --- a fixed boundary -------------------------------------------------------------------------------------------- */

/* The mesh seen from its other side. */
static orb_status turn_over(orb_mesh **mesh, orb_error *error) {
    orb_mesh *turned = NULL;
    for (int32_t t = 0; t < (*mesh)->n_triangles; t++) {
        int32_t *corner = (*mesh)->triangles + 3 * (size_t)t, second = corner[1];
        corner[1] = corner[2];
        corner[2] = second;
    }
    orb_mesh_arrays arrays = {(*mesh)->n_vertices, (*mesh)->vertices, (*mesh)->n_triangles, (*mesh)->triangles};
    orb_status status = mesh_create(&arrays, &turned, error);
    mesh_free(*mesh);
    *mesh = turned;
    return status;
}

static orb_status find_polygon_corners(orb_surface *surface, const orb_mesh *mesh, const orb_boundary *boundary,
                                       const bool *closed, const orb_request *request, bool *clockwise,
                                       orb_error *error) {
    int32_t loop = 0, n = surface->n_marks;
    while (closed[loop])
        loop++;
    for (int32_t i = 0; i < n; i++) {
        surface->order[i] = 1;
        surface->mirror[i] = true;
    }
    if (request->n_cones == 0)
        return picks_spread(mesh, boundary, loop, n, surface->vertex, error);
    if (request->n_cones != n)
        return error_set(error, ORB_CONE_COUNT, "the polygon has %d corners but %d vertices were picked", (int)n,
                         (int)request->n_cones);
    memcpy(surface->vertex, request->cones, (size_t)n * sizeof *surface->vertex);
    return picks_follow(boundary, loop, n, request->cones, clockwise, error);
}

/* ----------------------------------------------------------------------------------------------------------------- */

static orb_status allocate_marks(orb_surface *surface, const orb_request *request, orb_error *error) {
    surface->n_marks = request->polygon ? request->polygon->n_corners : request->n_cones;
    size_t n = (size_t)surface->n_marks + 1;
    surface->vertex = malloc(n * sizeof *surface->vertex);
    surface->order = malloc(n * sizeof *surface->order);
    surface->mirror = malloc(n * sizeof *surface->mirror);
    if (!surface->vertex || !surface->order || !surface->mirror)
        return error_memory(error);
    if (!request->polygon && request->n_cones > 0)
        memcpy(surface->vertex, request->cones, (size_t)request->n_cones * sizeof *surface->vertex);
    return ORB_OK;
}

/* Holes, mirrors, cones and corners of the input; sets surface->plain. */
static orb_status find_features(orb_surface *surface, orb_mesh **input, const orb_request *request, orb_error *error) {
    orb_boundary *boundary = NULL;
    orb_mesh *mesh = *input;
    bool *closed = NULL, clockwise = false;
    int32_t extra = mesh->n_boundary_loops - topology_mirrors(surface->signature);
    orb_status status = topology_require_mirrors(mesh, surface->signature, request->holes, error);
    if (status != ORB_OK)
        return status;
    if (extra > 0 && request->holes == ORB_HOLES_MIRROR && surface->signature) {
        orb_signature *more = NULL;
        status = signature_with_mirrors(surface->signature, extra, &more, error);
        if (status != ORB_OK)
            return status;
        signature_free(surface->signature);
        surface->signature = more;
    }
    status = topology_require_genus(mesh, surface->signature, error);
    if (status == ORB_OK)
        status = picks_check(mesh, request->n_cones, request->cones, error);
    if (status == ORB_OK)
        status = boundary_list(mesh, &boundary, error);
    if (status != ORB_OK)
        goto done;
    closed = calloc((size_t)boundary->n_loops + 1, sizeof *closed);
    status = closed ? choose_holes(mesh, boundary, topology_mirrors(surface->signature), request, closed, error)
                    : error_memory(error);
    if (status != ORB_OK)
        goto done;
    if (surface->signature)
        status = picks_match(surface->signature, boundary, closed, surface->n_marks, surface->vertex, request->orders,
                             surface->order, surface->mirror, error);
    else
        status = find_polygon_corners(surface, mesh, boundary, closed, request, &clockwise, error);
    if (status != ORB_OK)
        goto done;
    *input = NULL;
    status = close_holes(surface, mesh, boundary, closed, error);
    if (status == ORB_OK && clockwise)
        status = turn_over(&surface->plain, error);
done:
    free(closed);
    boundary_free(boundary);
    return status;
}

static orb_status read_request(orb_surface *surface, const orb_request *request, orb_error *error) {
    if (request->polygon && request->polygon->n_corners < 3)
        return error_set(error, ORB_BAD_ARGUMENT, "a polygon has three corners at least, here are %d",
                         (int)request->polygon->n_corners);
    if (request->holes < ORB_HOLES_REFUSE || request->holes > ORB_HOLES_MIRROR)
        return error_set(error, ORB_BAD_ARGUMENT, "what to do with holes is %d: choose refuse, fill or mirror",
                         (int)request->holes);
    if (request->cut < ORB_CUT_AUTOMATIC || request->cut > ORB_CUT_PATH)
        return error_set(error, ORB_BAD_ARGUMENT, "the cut is %d: choose automatic or path", (int)request->cut);
    surface->cut = request->cut;
    orb_status status = request->polygon ? ORB_OK : signature_parse(request->signature, &surface->signature, error);
    if (status == ORB_OK && surface->signature && !signature_is_supported(surface->signature))
        status = signature_refuse(surface->signature, error);
    const orb_signature *s = surface->signature;
    if (status == ORB_OK && s && s->n_cones + s->n_corners != request->n_cones)
        return error_set(error, ORB_CONE_COUNT, "%s has %d %s but %d vertices were picked", s->text,
                         (int)(s->n_cones + s->n_corners), s->n_corners ? "cones and corners" : "cones",
                         (int)request->n_cones);
    return status;
}

static orb_status describe(orb_surface *surface, const orb_mesh *mesh, orb_error *error) {
    size_t bytes = 3 * (size_t)mesh->n_triangles * sizeof *surface->input_triangles;
    surface->n_input_vertices = mesh->n_vertices;
    surface->n_input_triangles = mesh->n_triangles;
    surface->input_triangles = malloc(bytes);
    if (!surface->input_triangles)
        return error_memory(error);
    memcpy(surface->input_triangles, mesh->triangles, bytes);
    surface->about = (orb_report){.vertices = mesh->n_vertices,
                                  .triangles = mesh->n_triangles,
                                  .components = mesh->n_components,
                                  .euler = mesh->euler,
                                  .boundary_loops = mesh->n_boundary_loops,
                                  .genus = mesh->genus,
                                  .orientable = mesh->orientable};
    return ORB_OK;
}

/* What the user's mesh has in the place of each triangle, for errors. */
static orb_status note_origins(orb_surface *surface, orb_error *error) {
    if (surface->n_closed == 0 && surface->n_halved == 0)
        return ORB_OK;
    const int32_t n = surface->mesh->n_triangles;
    surface->mesh->origin = malloc((size_t)n * sizeof *surface->mesh->origin);
    if (!surface->mesh->origin)
        return error_memory(error);
    for (int32_t t = 0; t < n; t++) {
        const int32_t plain = surface->parent ? surface->parent[t] : t;
        surface->mesh->origin[t] = plain < surface->n_input_triangles ? plain : -1;
    }
    return ORB_OK;
}

orb_status surface_create(const orb_mesh_arrays *arrays, const orb_request *request, const uint8_t *halve,
                          orb_surface **result, orb_error *error) {
    *result = NULL;
    orb_mesh *input = NULL;
    orb_surface *surface = calloc(1, sizeof *surface);
    orb_status status = surface ? read_request(surface, request, error) : error_memory(error);
    if (status == ORB_OK)
        status =
            request->prepared ? mesh_copy(request->prepared->mesh, &input, error) : mesh_create(arrays, &input, error);
    if (status == ORB_OK)
        status = mesh_require_connected(input, error);
    if (status == ORB_OK)
        status = describe(surface, input, error);
    if (status == ORB_OK)
        status = allocate_marks(surface, request, error);
    if (status == ORB_OK)
        status = find_features(surface, &input, request, error);
    if (status == ORB_OK)
        status = halve_chords(surface, halve, error);
    if (status == ORB_OK)
        status = note_origins(surface, error);
    mesh_free(input);
    if (status != ORB_OK) {
        surface_free(surface);
        return status;
    }
    surface->about.filled_holes = surface->n_closed;
    surface->about.refined_edges = surface->n_halved;
    surface->prepared = surface->n_closed == 0 && surface->n_halved == 0 ? request->prepared : NULL;
    *result = surface;
    return ORB_OK;
}

orb_status surface_given_weights(const orb_surface *surface, const orb_request *request, double *weights,
                                 orb_error *error) {
    if (surface->n_closed > 0)
        return error_set(
            error, ORB_BAD_ARGUMENT,
            "weights are given for the mesh's edges, but %d filled %s new ones: fill them in the mesh first",
            (int)surface->n_closed, surface->n_closed == 1 ? "hole has" : "holes have");
    if (surface->mesh == surface->plain)
        return weights_compute(surface->mesh, request, NULL, weights, NULL, error);
    double *plain = malloc(((size_t)surface->plain->n_edges + 1) * sizeof *plain);
    orb_status status =
        plain ? weights_compute(surface->plain, request, NULL, plain, NULL, error) : error_memory(error);
    if (status == ORB_OK)
        chords_refine_weights(surface->plain, plain, surface->mesh, surface->parent, surface->halved, weights);
    free(plain);
    return status;
}

void surface_free(orb_surface *surface) {
    if (!surface)
        return;
    signature_free(surface->signature);
    if (surface->mesh != surface->plain)
        mesh_free(surface->mesh);
    mesh_free(surface->plain);
    free(surface->parent);
    free(surface->halved);
    free(surface->input_triangles);
    free(surface->vertex);
    free(surface->order);
    free(surface->mirror);
    free(surface);
}
