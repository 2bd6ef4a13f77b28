/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "intrinsic.h"

#include <stdlib.h>
#include <string.h>

#include "delaunay.h"
#include "metric.h"
#include "shape.h"

enum { NEWTON_STEPS = 2 }; /* more gave nothing (docs/decisions.md) */

/* The angle that the orbifold has around each vertex. */
static orb_status wanted_angles(const orb_embedding *embedding, double **result, orb_error *error) {
    const orb_surface *surface = embedding->surface;
    double *angles = malloc(((size_t)embedding->mesh->n_vertices + 1) * sizeof *angles);
    *result = angles;
    if (!angles || !shape_flat_angles(embedding->mesh, angles))
        return error_memory(error);
    for (int32_t k = 0; k < surface->n_marks; k++)
        angles[surface->vertex[k]] /= surface->order[k];
    return ORB_OK;
}

/* Replaces intrinsic->lengths by those of the orbifold's metric. */
static orb_status take_metric(orb_intrinsic *intrinsic, const orb_embedding *embedding, orb_error *error) {
    const orb_signature *signature = embedding->surface->signature;
    double *angles = NULL;
    orb_metric *metric = NULL;
    orb_status status = wanted_angles(embedding, &angles, error);
    if (status == ORB_OK)
        status = metric_create(embedding->mesh, intrinsic->original, angles,
                               signature->curvature == 0 ? 0 : signature->euler, NEWTON_STEPS, &metric, error);
    if (status == ORB_OK)
        memcpy(intrinsic->lengths, metric->lengths, (size_t)embedding->mesh->n_edges * sizeof *intrinsic->lengths);
    free(angles);
    metric_free(metric);
    return status;
}

/* Which vertices some element of the group fixes, and the reflections of the mirrors. */
static orb_status find_mirrors(orb_intrinsic *intrinsic, const orb_embedding *embedding, const orb_problem *problem,
                               orb_error *error) {
    const orb_mesh *mesh = embedding->mesh;
    const orb_tile *tile = embedding->tile;
    const int32_t sides = tile->word->n_sides;
    intrinsic->mirror = malloc(((size_t)mesh->n_vertices + 1) * sizeof *intrinsic->mirror);
    intrinsic->reflections = malloc(((size_t)sides + 1) * sizeof *intrinsic->reflections);
    if (!intrinsic->mirror || !intrinsic->reflections)
        return error_memory(error);
    memcpy(intrinsic->reflections, tile->pairings, (size_t)sides * sizeof *intrinsic->reflections);
    mesh_find_boundary(mesh, intrinsic->special);
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        const bool slides = intrinsic->special[v] && problem->freedom[v] == 1;
        intrinsic->mirror[v] = slides ? problem->line[v] : -1;
    }
    for (int32_t k = 0; k < embedding->surface->n_marks; k++)
        intrinsic->special[embedding->surface->vertex[k]] = true;
    return ORB_OK;
}

orb_status intrinsic_create(orb_embedding *embedding, const orb_problem *problem, bool conformal,
                            orb_intrinsic **result, orb_error *error) {
    *result = NULL;
    const orb_mesh *mesh = embedding->mesh;
    const size_t n = (size_t)mesh->n_vertices + 1, edges = (size_t)mesh->n_edges + 1;
    orb_intrinsic *intrinsic = calloc(1, sizeof *intrinsic);
    if (!intrinsic)
        return error_memory(error);
    orb_status status = error_memory(error);
    intrinsic->original = malloc(edges * sizeof *intrinsic->original);
    intrinsic->lengths = malloc(edges * sizeof *intrinsic->lengths);
    intrinsic->special = malloc(n);
    intrinsic->keep = calloc(edges, 1);
    intrinsic->ends = malloc(2 * edges * sizeof *intrinsic->ends);
    intrinsic->weights = malloc(edges * sizeof *intrinsic->weights);
    if (!intrinsic->original || !intrinsic->lengths || !intrinsic->special || !intrinsic->keep || !intrinsic->ends ||
        !intrinsic->weights)
        goto done;
    status = find_mirrors(intrinsic, embedding, problem, error);
    if (status != ORB_OK)
        goto done;
    shape_lengths(mesh, intrinsic->original);
    memcpy(intrinsic->lengths, intrinsic->original, (size_t)mesh->n_edges * sizeof *intrinsic->lengths);
    status = conformal && embedding->surface->signature ? take_metric(intrinsic, embedding, error)
                                                        : error_set(error, ORB_OK, "%s", "");
    if (status != ORB_OK)
        goto done;
    intrinsic->base = embedding->copies;
    embedding->copies = NULL;
    *result = intrinsic;
    intrinsic = NULL;
done:
    intrinsic_free(intrinsic);
    return status;
}

void intrinsic_free(orb_intrinsic *intrinsic) {
    if (!intrinsic)
        return;
    free(intrinsic->original);
    free(intrinsic->lengths);
    free(intrinsic->special);
    free(intrinsic->keep);
    free(intrinsic->ends);
    free(intrinsic->weights);
    free(intrinsic->mirror);
    free(intrinsic->reflections);
    holonomy_free(intrinsic->base);
    free(intrinsic);
}

orb_status intrinsic_triangulate(orb_intrinsic *intrinsic, orb_embedding *embedding, double clamp, orb_problem *problem,
                                 orb_error *error) {
    const orb_mesh *mesh = embedding->mesh;
    const size_t bytes = 3 * (size_t)mesh->n_triangles * sizeof(int32_t);
    orb_delaunay *delaunay = NULL;
    const orb_mirrors mirrors = {intrinsic->mirror, intrinsic->reflections};
    int32_t *triangles = malloc(bytes + 1);
    orb_status status = triangles
                            ? delaunay_create(mesh, embedding->tile->geometry, intrinsic->base, intrinsic->lengths,
                                              intrinsic->keep, intrinsic->special, &mirrors, &delaunay, error)
                            : error_memory(error);
    if (status != ORB_OK) {
        free(triangles);
        return status;
    }
    delaunay_weights(delaunay, intrinsic->original, clamp, intrinsic->ends, intrinsic->weights, &intrinsic->n_clamped);
    intrinsic->n_flips = delaunay->n_flips;
    memcpy(triangles, intrinsic->base->triangles, bytes);
    holonomy_free(embedding->copies);
    embedding->copies = delaunay->copies;
    embedding->copies->triangles = triangles;
    delaunay->copies = NULL;
    delaunay_free(delaunay);
    problem_use_edges(problem, embedding->copies, intrinsic->ends, intrinsic->weights);
    return ORB_OK;
}

static bool keep_triangle(orb_intrinsic *intrinsic, const orb_mesh *mesh, int32_t t) {
    bool changed = false;
    for (int32_t h = 3 * t; h < 3 * t + 3; h++) {
        changed = changed || !intrinsic->keep[mesh->edge[h]];
        intrinsic->keep[mesh->edge[h]] = 1;
    }
    return changed;
}

bool intrinsic_keep(orb_intrinsic *intrinsic, const orb_mesh *mesh, const bool *flipped) {
    bool changed = false;
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        if (!flipped[t])
            continue;
        changed |= keep_triangle(intrinsic, mesh, t);
        for (int32_t h = 3 * t; h < 3 * t + 3; h++)
            if (mesh->twin[h] >= 0)
                changed |= keep_triangle(intrinsic, mesh, mesh->twin[h] / 3);
    }
    return changed;
}

void intrinsic_keep_all(orb_intrinsic *intrinsic, const orb_mesh *mesh) {
    memset(intrinsic->keep, 1, (size_t)mesh->n_edges);
}

void intrinsic_finish(const orb_intrinsic *intrinsic, orb_embedding *embedding) {
    embedding->copies->n_copies = intrinsic->base->n_copies;
    embedding->report.clamped_weights = intrinsic->n_clamped;
    if (intrinsic->n_flips == 0) {
        memcpy(embedding->weights, intrinsic->weights, (size_t)embedding->mesh->n_edges * sizeof(double));
        return;
    }
    free(embedding->weights);
    embedding->weights = NULL;
}
