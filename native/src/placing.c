/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "placing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double most_sampled = 2.5e6; /* candidates times vertices */
enum { FEWEST_CANDIDATES = 60, MOST_CANDIDATES = 120 };

typedef struct group {
    const orb_mesh *input;
    const orb_suggest_request *request;
    orb_monitor *monitor;
    int32_t n;
    orb_plan **plans; /* [n] */
    const orb_mesh *mesh;
    orb_mesh *closed; /* the mesh with holes filled, if it has any */
    int32_t *loop_of; /* [n_boundary_loops] by mirror */
    orb_ground *ground;
    orb_reflection *reflection;
    orb_spread *spread;
    orb_columns *columns;
    int32_t n_candidates;
    bool symmetric; /* in the reflection */
} group;

static void group_clear(group *g) {
    columns_free(g->columns);
    spread_free(g->spread);
    reflection_free(g->reflection);
    ground_free(g->ground);
    free(g->loop_of);
    mesh_free(g->closed);
}

/* Fills the holes and says which loops are mirrors. */
static orb_status take_mesh(group *g, int32_t n_mirrors, orb_error *error) {
    const orb_mesh *input = g->input;
    const orb_suggest_request *request = g->request;
    g->mesh = input;
    orb_boundary *boundary = NULL;
    bool *close = calloc((size_t)input->n_boundary_loops + 1, sizeof *close);
    int32_t *rank = g->loop_of = malloc(((size_t)input->n_boundary_loops + 1) * sizeof *rank);
    orb_status status = close && rank ? boundary_list(input, &boundary, error) : error_memory(error);
    if (status == ORB_OK)
        status = boundary_rank(input, boundary, request->n_fixed, request->fixed, rank, error);
    if (status == ORB_OK && n_mirrors < input->n_boundary_loops) {
        for (int32_t k = n_mirrors; k < input->n_boundary_loops; k++)
            close[rank[k]] = true;
        status = boundary_close(input, boundary, close, &g->closed, error);
        g->mesh = g->closed;
        boundary_free(boundary);
        boundary = NULL;
        if (status == ORB_OK)
            status = boundary_list(g->mesh, &boundary, error);
        if (status == ORB_OK)
            status = boundary_rank(g->mesh, boundary, request->n_fixed, request->fixed, rank, error);
    }
    boundary_free(boundary);
    free(close);
    return status;
}

/* The mirror plane, unless the fixed cones are not symmetric in it. Corners of several mirrors would have to be. */
static orb_status find_plane(group *g, int32_t n_mirrors, orb_error *error) {
    const orb_suggest_request *request = g->request;
    if (request->symmetry == ORB_SYMMETRY_IGNORE)
        return ORB_OK;
    orb_status status = reflection_find(g->mesh, request->symmetry == ORB_SYMMETRY_PLANE ? request->plane : NULL,
                                        &g->reflection, error);
    bool symmetric = g->reflection && n_mirrors <= 1;
    for (int32_t k = 0; k < request->n_fixed && symmetric; k++) {
        const int32_t image = g->reflection->image[request->fixed[k]];
        symmetric = image >= 0 && g->ground->fixed[image];
    }
    if (!symmetric)
        return status;
    g->ground->reflection = g->reflection;
    g->symmetric = true;
    return status;
}

/* Places for all plans that have none yet, with or without symmetry. */
static orb_status place_plans(group *g, bool symmetric, orb_error *error) {
    const orb_suggest_request *request = g->request;
    const int32_t n_kinds = 2 * (g->ground->boundary->n_loops + 1);
    bool *wanted = calloc((size_t)n_kinds, sizeof *wanted), any = false;
    int32_t *count = calloc((size_t)n_kinds, sizeof *count);
    orb_options *options = NULL;
    orb_status status = wanted && count ? ORB_OK : error_memory(error);
    g->ground->reflection = symmetric ? g->reflection : NULL;
    for (int32_t k = 0; k < g->n && status == ORB_OK; k++)
        if (!g->plans[k]->placed) {
            any = true;
            plan_want(g->plans[k], g->loop_of, symmetric, wanted);
        }
    for (int32_t kind = 0; kind < n_kinds && status == ORB_OK; kind++)
        if (wanted[kind]) /* a pair has two columns */
            count[kind] = !symmetric ? g->n_candidates : g->n_candidates / (ground_kind_is_pair(kind) ? 3 : 2);
    if (status == ORB_OK && any)
        status = options_create(g->ground, g->columns, request->n_fixed, request->fixed, count, &options, error);
    for (int32_t k = 0; k < g->n && status == ORB_OK && any; k++)
        if (!g->plans[k]->placed) {
            status = plan_place(g->plans[k], g->ground, options, g->spread->constant, g->loop_of, symmetric, error);
            if (status == ORB_OK)
                status = monitor_report(g->monitor, "places", 0.4, error);
        }
    options_free(options);
    free(wanted);
    free(count);
    return status;
}

/* Symmetric places move symmetrically. */
static orb_status descend(group *g, bool symmetric, orb_error *error) {
    const double radius = 1.5 * g->ground->size / sqrt(g->n_candidates);
    int32_t n = 0;
    orb_descent *descents = malloc(((size_t)g->n + 1) * sizeof *descents);
    if (!descents)
        return error_memory(error);
    g->ground->reflection = symmetric ? g->reflection : NULL;
    for (int32_t k = 0; k < g->n; k++)
        if (g->plans[k]->placed && g->plans[k]->symmetric == symmetric)
            descents[n++] = plan_descent(g->plans[k], radius);
    orb_status status = n > 0 ? descent_run(g->ground, g->columns, n, descents, error) : ORB_OK;
    free(descents);
    return status;
}

static orb_status predict(group *g, orb_error *error) {
    const size_t room = (size_t)g->mesh->n_vertices + 1;
    double *scale[SPREAD_BLOCK] = {NULL}, *memory = malloc(SPREAD_BLOCK * room * sizeof *memory);
    orb_status status = memory ? ORB_OK : error_memory(error);
    for (int32_t next = 0; next < g->n && status == ORB_OK;) {
        orb_charges charges[SPREAD_BLOCK];
        orb_plan *plans[SPREAD_BLOCK];
        int32_t n = 0;
        for (; next < g->n && n < SPREAD_BLOCK; next++) {
            if (!g->plans[next]->placed)
                continue;
            plans[n] = g->plans[next];
            charges[n] = plan_charges(plans[n]);
            scale[n] = memory + (size_t)n * room;
            n++;
        }
        status = monitor_report(g->monitor, "prediction", 0.8 + 0.05 * next / g->n, error);
        if (status == ORB_OK && n > 0)
            status = spread_scales(g->spread, n, charges, scale, error);
        for (int32_t k = 0; k < n && status == ORB_OK; k++)
            plans[k]->predicted = plans[k]->conformal = spread_deviation(g->spread, scale[k]);
    }
    free(memory);
    return status;
}

static int32_t count_candidates(const group *g) {
    int32_t count = (int32_t)fmin(fmax(most_sampled / g->mesh->n_vertices, FEWEST_CANDIDATES), MOST_CANDIDATES);
    for (int32_t k = 0; k < g->n; k++)
        if (2 * g->plans[k]->n_cones > count)
            count = 2 * g->plans[k]->n_cones;
    return count;
}

static orb_status run(group *g, int32_t n_mirrors, orb_error *error) {
    orb_status status = take_mesh(g, n_mirrors, error);
    if (status == ORB_OK)
        status = ground_create(g->mesh, g->input->n_vertices, g->request->keep_away, g->request->n_fixed,
                               g->request->fixed, &g->ground, error);
    if (status == ORB_OK)
        status = find_plane(g, n_mirrors, error);
    if (status == ORB_OK)
        status = monitor_report(g->monitor, "order", 0.02, error);
    if (status == ORB_OK)
        status = spread_create(g->mesh, &g->spread, error);
    if (status == ORB_OK)
        status = columns_create(g->spread, g->monitor, &g->columns, error);
    if (status == ORB_OK)
        g->n_candidates = count_candidates(g);
    const bool symmetric = status == ORB_OK && g->ground->reflection;
    if (symmetric) {
        status = place_plans(g, true, error);
        if (status == ORB_OK)
            status = descend(g, true, error);
    }
    if (status == ORB_OK)
        status = place_plans(g, false, error);
    if (status == ORB_OK)
        status = descend(g, false, error);
    for (int32_t k = 0; k < g->n && status == ORB_OK; k++)
        if (g->plans[k]->placed)
            status = plan_list_cones(g->plans[k], g->ground, g->loop_of, error);
    return status == ORB_OK ? predict(g, error) : status;
}

orb_status placing_run(const orb_mesh *input, const orb_suggest_request *request, int32_t n_mirrors, int32_t n,
                       orb_plan **plans, orb_monitor *monitor, double plane[4], bool *has_plane, orb_error *error) {
    group g = {.input = input, .request = request, .monitor = monitor, .n = n, .plans = plans};
    const orb_status status = run(&g, n_mirrors, error);
    if (status == ORB_OK && g.symmetric) {
        *has_plane = true;
        memcpy(plane, g.reflection->plane, sizeof g.reflection->plane);
    }
    group_clear(&g);
    return status;
}
