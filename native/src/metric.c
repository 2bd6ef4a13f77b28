/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "metric.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cholesky.h"
#include "sides.h"

static const double pi = 3.14159265358979323846;
enum { MOST_HALVINGS = 6 };

/* Everything that follows from a choice of u. */
typedef struct state {
    double *u;         /* [n_vertices] */
    double *lengths;   /* [n_edges] */
    double *area;      /* [n_vertices] a third of the triangles around, as a part of the whole */
    double *excess;    /* [n_vertices] angle around the vertex minus the wanted one */
    double *cotangent; /* [n_triangles*3] of the angle that a half-edge faces */
    double total;      /* area */
    double residual;
    int32_t n_unscaled;
} state;

typedef struct solver {
    const orb_mesh *mesh;
    const double *lengths, *angles;
    double euler;
    state now, next;
    orb_pattern pattern;
    int64_t *slot;  /* [n_edges] */
    int32_t *order; /* [n_vertices] */
    double *values; /* [entries of the pattern] */
    double *right;  /* [n_vertices] */
    orb_cholesky *cholesky;
    int32_t pinned; /* a vertex that is used */
} solver;

void metric_lengths(const orb_mesh *mesh, double *lengths) {
    double longest = 0;
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        lengths[e] = mesh_edge_length(mesh, mesh->edge_halfedge[e]);
        longest = fmax(longest, lengths[e]);
    }
    if (!(longest > 0) || !isfinite(longest))
        return;
    const int exponent = ilogb(longest), half = exponent / 2; /* 2^1074 would not be a double */
    for (int32_t e = 0; e < mesh->n_edges; e++)
        lengths[e] = ldexp(ldexp(lengths[e], -half), half - exponent);
}

/* ------------------------------------------------------------------------------------------------------- memory */

static bool state_allocate(state *s, const orb_mesh *mesh) {
    const size_t n = (size_t)mesh->n_vertices + 1;
    s->u = calloc(n, sizeof *s->u);
    s->lengths = malloc(((size_t)mesh->n_edges + 1) * sizeof *s->lengths);
    s->area = malloc(n * sizeof *s->area);
    s->excess = malloc(n * sizeof *s->excess);
    s->cotangent = malloc((3 * (size_t)mesh->n_triangles + 1) * sizeof *s->cotangent);
    return s->u && s->lengths && s->area && s->excess && s->cotangent;
}

static void state_free(state *s) {
    free(s->u);
    free(s->lengths);
    free(s->area);
    free(s->excess);
    free(s->cotangent);
}

static void solver_free(solver *work) {
    state_free(&work->now);
    state_free(&work->next);
    pattern_clear(&work->pattern);
    free(work->slot);
    free(work->order);
    free(work->values);
    free(work->right);
    cholesky_free(work->cholesky);
}

/* The Laplacian's pattern, ordered and analysed. */
static orb_status analyze(solver *work, orb_error *error) {
    const orb_mesh *mesh = work->mesh;
    int32_t *ends = malloc((2 * (size_t)mesh->n_edges + 1) * sizeof *ends);
    work->slot = malloc(((size_t)mesh->n_edges + 1) * sizeof *work->slot);
    work->order = malloc(((size_t)mesh->n_vertices + 1) * sizeof *work->order);
    work->right = malloc(((size_t)mesh->n_vertices + 1) * sizeof *work->right);
    orb_status status = error_memory(error);
    if (!ends || !work->slot || !work->order || !work->right)
        goto done;
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        ends[2 * e] = halfedge_from(mesh, mesh->edge_halfedge[e]);
        ends[2 * e + 1] = halfedge_to(mesh, mesh->edge_halfedge[e]);
    }
    status = pattern_of_pairs(mesh->n_vertices, mesh->n_edges, ends, &work->pattern, work->slot, error);
    if (status != ORB_OK)
        goto done;
    work->values = malloc((size_t)work->pattern.column[mesh->n_vertices] * sizeof *work->values + 1);
    if (!work->values) {
        status = error_memory(error);
        goto done;
    }
    status = cholesky_order(&work->pattern, ORDERING_AMD, work->order, error);
    if (status == ORB_OK)
        status = cholesky_analyze(&work->pattern, work->order, false, &work->cholesky, error);
done:
    free(ends);
    return status;
}

/* ---------------------------------------------------------------------------------------------- angles and areas */

/* One triangle's angles, cotangents and twice its area. Where the scaled lengths make no triangle, the angles are those
 * that it had when it became flat, pi, 0 and 0 (which keeps Newton's problem convex: Springborn, Schroeder and Pinkall
 * 2008, section 3.1), and the rest is of the mesh's own shape, or, where that is none, an equilateral one's. */
static bool measure(const double scaled[3], const double original[3], double angle[3], double cotangent[3],
                    double *area) {
    *area = sides_double_area(scaled);
    if (sides_angles(scaled, angle, cotangent))
        return true;
    double squares[2] = {0, 0};
    int longest = 0;
    for (int c = 0; c < 3; c++) {
        squares[0] += original[c] * original[c];
        squares[1] += scaled[c] * scaled[c];
        if (scaled[c] > scaled[longest])
            longest = c;
    }
    if (sides_angles(original, angle, cotangent)) {
        *area = sides_double_area(original) * squares[1] / squares[0];
    } else {
        cotangent[0] = cotangent[1] = cotangent[2] = 1 / sqrt(3);
        *area = squares[1] / 3 * sqrt(3) / 2;
    }
    for (int c = 0; c < 3; c++)
        angle[c] = c == longest ? pi : 0;
    return false;
}

static void scale_lengths(const solver *work, state *s) {
    const orb_mesh *mesh = work->mesh;
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        s->excess[v] = exp(0.5 * s->u[v]);
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        const int32_t h = mesh->edge_halfedge[e];
        s->lengths[e] = work->lengths[e] * s->excess[halfedge_from(mesh, h)] * s->excess[halfedge_to(mesh, h)];
    }
}

/* All of the state from its u. */
static void evaluate(const solver *work, state *s) {
    const orb_mesh *mesh = work->mesh;
    scale_lengths(work, s);
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        s->area[v] = 0;
        s->excess[v] = mesh->vertex_halfedge[v] < 0 ? 0 : -work->angles[v];
    }
    s->total = s->residual = 0;
    s->n_unscaled = 0;
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        double scaled[3], original[3], angle[3], area;
        for (int c = 0; c < 3; c++) {
            scaled[c] = s->lengths[mesh->edge[3 * t + c]];
            original[c] = work->lengths[mesh->edge[3 * t + c]];
        }
        s->n_unscaled += !measure(scaled, original, angle, s->cotangent + 3 * (size_t)t, &area);
        s->total += area;
        for (int c = 0; c < 3; c++) { /* side c faces the corner before it */
            const int32_t facing = mesh->triangles[3 * t + (c + 2) % 3];
            s->excess[facing] += angle[c];
            s->area[facing] += area / 3;
        }
    }
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        s->area[v] /= s->total;
        const double rest = 2 * pi * work->euler * s->area[v] + s->excess[v];
        s->residual += rest * rest;
    }
    s->residual = sqrt(s->residual);
}

/* ---------------------------------------------------------------------------------------------------- one solve */

/* The cotangent Laplacian of the state, plus shift * area on the diagonal. Without a shift it is singular, the constant
 * functions being its kernel: the pinned vertex's row and column become those of the identity, which is exact. */
static void assemble(solver *work, double shift) {
    const orb_mesh *mesh = work->mesh;
    const orb_pattern *pattern = &work->pattern;
    memset(work->values, 0, (size_t)pattern->column[pattern->n] * sizeof *work->values);
    for (int32_t h = 0; h < 3 * mesh->n_triangles; h++) {
        const int32_t a = halfedge_from(mesh, h), b = halfedge_to(mesh, h);
        const double weight = 0.5 * work->now.cotangent[h];
        const bool pinned = shift == 0 && (a == work->pinned || b == work->pinned);
        work->values[pattern->column[a]] += weight;
        work->values[pattern->column[b]] += weight;
        if (!pinned)
            work->values[work->slot[mesh->edge[h]]] -= weight;
    }
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        if ((shift == 0 && v == work->pinned) || mesh->vertex_halfedge[v] < 0)
            work->values[pattern->column[v]] = 1;
        else
            work->values[pattern->column[v]] += shift * work->now.area[v];
        work->right[v] = 2 * pi * work->euler * work->now.area[v] + work->now.excess[v];
    }
    if (shift == 0)
        work->right[work->pinned] = 0;
}

/* next.u = now.u + factor * right, with the area's mean of u kept at zero. */
static void move(solver *work, double factor) {
    const orb_mesh *mesh = work->mesh;
    double mean = 0;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        work->next.u[v] = work->now.u[v] + factor * work->right[v];
        mean += work->now.area[v] * work->next.u[v];
    }
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        work->next.u[v] = mesh->vertex_halfedge[v] < 0 ? 0 : work->next.u[v] - mean;
    evaluate(work, &work->next);
}

/* One step from now; *taken if it made the residual smaller. */
static orb_status step(solver *work, double shift, bool *taken, orb_error *error) {
    bool positive = false;
    *taken = false;
    assemble(work, shift);
    orb_status status = cholesky_factor(work->cholesky, work->values, &positive, error);
    if (status != ORB_OK || !positive)
        return status;
    status = cholesky_solve(work->cholesky, work->right, 1, work->right, error);
    double factor = 1;
    for (int halvings = 0; status == ORB_OK && halvings <= MOST_HALVINGS && !*taken; halvings++, factor /= 2) {
        move(work, factor);
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
    metric->n_unscaled = work->now.n_unscaled;
    *result = metric;
    return error_set(error, ORB_OK, "%s", "");
}

orb_status metric_create(const orb_mesh *mesh, const double *lengths, const double *angles, double euler,
                         int32_t newton_steps, orb_metric **metric, orb_error *error) {
    *metric = NULL;
    solver work = {.mesh = mesh, .lengths = lengths, .angles = angles, .euler = euler};
    orb_status status = error_memory(error);
    if (!state_allocate(&work.now, mesh) || !state_allocate(&work.next, mesh))
        goto done;
    status = analyze(&work, error);
    if (status != ORB_OK)
        goto done;
    work.pinned = mesh->triangles[0];
    evaluate(&work, &work.now);
    const double first = work.now.residual;
    int32_t steps = 0;
    bool taken = isfinite(first);
    while (taken && steps <= newton_steps) {
        status = step(&work, euler < 0 && steps > 0 ? -4 * pi * euler : 0, &taken, error);
        if (status != ORB_OK)
            goto done;
        steps += taken;
    }
    status = hand_over(&work, first, steps, metric, error);
done:
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
