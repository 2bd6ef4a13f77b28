/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "metric.h"

#include <math.h>
#include <stdlib.h>

#include "laplacian.h"
#include "shape.h"

static const double pi = 3.14159265358979323846;
enum { MOST_HALVINGS = 6 };

/* Everything that follows from a choice of u. */
typedef struct state {
    double *u;       /* [n_vertices] */
    double *lengths; /* [n_edges] */
    orb_shape shape;
    double residual;
} state;

typedef struct solver {
    const orb_mesh *mesh;
    const double *lengths, *angles;
    double euler;
    state now, next;
    double *factor; /* [n_vertices] exp(u / 2) */
    orb_laplacian *laplacian;
} solver;

/* ------------------------------------------------------------------------------------------------------- memory */

static bool state_allocate(state *s, const orb_mesh *mesh) {
    s->u = calloc((size_t)mesh->n_vertices + 1, sizeof *s->u);
    s->lengths = malloc(((size_t)mesh->n_edges + 1) * sizeof *s->lengths);
    return shape_allocate(&s->shape, mesh) && s->u && s->lengths;
}

static void state_free(state *s) {
    free(s->u);
    free(s->lengths);
    shape_clear(&s->shape);
}

static void solver_free(solver *work) {
    state_free(&work->now);
    state_free(&work->next);
    free(work->factor);
    laplacian_free(work->laplacian);
}

/* ---------------------------------------------------------------------------------------------- angles and areas */

static void scale_lengths(const solver *work, state *s) {
    const orb_mesh *mesh = work->mesh;
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        work->factor[v] = exp(0.5 * s->u[v]);
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        const int32_t h = mesh->edge_halfedge[e];
        s->lengths[e] = work->lengths[e] * work->factor[halfedge_from(mesh, h)] * work->factor[halfedge_to(mesh, h)];
    }
}

/* What is missing at a vertex: the angle beyond the wanted one, and its share of the curvature. */
static double missing(const solver *work, const state *s, int32_t v) {
    const double excess = work->mesh->vertex_halfedge[v] < 0 ? 0 : s->shape.angle[v] - work->angles[v];
    return 2 * pi * work->euler * s->shape.area[v] + excess;
}

/* All of the state from its u. */
static void evaluate(const solver *work, state *s) {
    scale_lengths(work, s);
    shape_measure(work->mesh, s->lengths, work->lengths, &s->shape);
    s->residual = 0;
    for (int32_t v = 0; v < work->mesh->n_vertices; v++) {
        const double rest = missing(work, s, v);
        s->residual += rest * rest;
    }
    s->residual = sqrt(s->residual);
}

/* ---------------------------------------------------------------------------------------------------- one solve */

/* next.u = now.u + factor * direction, with the area's mean of u kept at zero. */
static void move(solver *work, const double *direction, double factor) {
    const orb_mesh *mesh = work->mesh;
    double mean = 0;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        work->next.u[v] = work->now.u[v] + factor * direction[v];
        mean += work->now.shape.area[v] * work->next.u[v];
    }
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        work->next.u[v] = mesh->vertex_halfedge[v] < 0 ? 0 : work->next.u[v] - mean;
    evaluate(work, &work->next);
}

/* One step from now; *taken if it made the residual smaller. */
static orb_status step(solver *work, double shift, double *direction, bool *taken, orb_error *error) {
    bool positive = false;
    const orb_shape *shape = &work->now.shape;
    *taken = false;
    orb_status status = laplacian_factor(work->laplacian, shape->cotangent, shape->area, shift, &positive, error);
    if (status != ORB_OK || !positive)
        return status;
    for (int32_t v = 0; v < work->mesh->n_vertices; v++)
        direction[v] = missing(work, &work->now, v);
    status = laplacian_solve(work->laplacian, direction, 1, error);
    double factor = 1;
    for (int halvings = 0; status == ORB_OK && halvings <= MOST_HALVINGS && !*taken; halvings++, factor /= 2) {
        move(work, direction, factor);
        *taken = work->next.residual < work->now.residual;
    }
    if (*taken) {
        const state swap = work->now;
        work->now = work->next;
        work->next = swap;
    }
    return status;
}

/* Hands the state's arrays over. */
static orb_status hand_over(solver *work, double first, int32_t steps, orb_metric **result, orb_error *error) {
    orb_metric *metric = calloc(1, sizeof *metric);
    if (!metric)
        return error_memory(error);
    metric->scale = work->now.u;
    metric->lengths = work->now.lengths;
    work->now.u = work->now.lengths = NULL;
    metric->residual[0] = first;
    metric->residual[1] = work->now.residual;
    metric->steps = steps;
    metric->n_unscaled = work->now.shape.n_flat;
    *result = metric;
    return error_set(error, ORB_OK, "%s", "");
}

orb_status metric_create(const orb_mesh *mesh, const double *lengths, const double *angles, double euler,
                         int32_t newton_steps, orb_metric **metric, orb_error *error) {
    *metric = NULL;
    solver work = {.mesh = mesh, .lengths = lengths, .angles = angles, .euler = euler};
    orb_status status = error_memory(error);
    work.factor = malloc(((size_t)mesh->n_vertices + 1) * sizeof *work.factor);
    double *direction = malloc(((size_t)mesh->n_vertices + 1) * sizeof *direction);
    bool room = state_allocate(&work.now, mesh);
    room = state_allocate(&work.next, mesh) && room && work.factor && direction;
    if (!room)
        goto done;
    status = laplacian_create(mesh, &work.laplacian, error);
    if (status != ORB_OK)
        goto done;
    evaluate(&work, &work.now);
    const double first = work.now.residual;
    int32_t steps = 0;
    bool taken = isfinite(first);
    while (taken && steps <= newton_steps) {
        status = step(&work, euler < 0 && steps > 0 ? -4 * pi * euler : 0, direction, &taken, error);
        if (status != ORB_OK)
            goto done;
        steps += taken;
    }
    status = hand_over(&work, first, steps, metric, error);
done:
    free(direction);
    solver_free(&work);
    return status;
}

void metric_free(orb_metric *metric) {
    if (!metric)
        return;
    free(metric->scale);
    free(metric->lengths);
    free(metric);
}
