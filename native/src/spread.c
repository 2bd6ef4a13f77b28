/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "spread.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "dilation.h"

static const double pi = 3.14159265358979323846;
enum { MOST_STEPS = 16 };                                         /* towards the fixed point */
static const double fixed_point = 3e-4;                           /* relative to u */
static const double least_step = 0.02, most_step = 1.5;           /* of the relaxation */
static const double least_cotangent = 1e-3, most_cotangent = 1e6; /* where the Laplacian is not definite to rounding */

/* --- W and G ----------------------------------------------------------------------------------------------------- */

static double triangle_mean(const orb_mesh *mesh, int32_t t, const double *u) {
    const int32_t *corner = mesh->triangles + 3 * (size_t)t;
    return (u[corner[0]] + u[corner[1]] + u[corner[2]]) / 3;
}

/* result = W u */
static void apply_mass(const orb_spread *spread, const double *u, double *result) {
    const orb_mesh *mesh = spread->mesh;
    memset(result, 0, (size_t)mesh->n_vertices * sizeof *result);
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        const double share = spread->shape.triangle_area[t] * triangle_mean(mesh, t, u) / 3;
        for (int c = 0; c < 3; c++)
            result[mesh->triangles[3 * t + c]] += share;
    }
}

/* u' W u, for u of mean zero. */
static double square(const orb_spread *spread, const double *u) {
    double sum = 0;
    for (int32_t t = 0; t < spread->mesh->n_triangles; t++) {
        const double mean = triangle_mean(spread->mesh, t, u);
        sum += spread->shape.triangle_area[t] * mean * mean;
    }
    return sum;
}

double spread_deviation(const orb_spread *spread, const double *scale) { return 2 * sqrt(square(spread, scale)); }

static double *block_column(const orb_spread *spread, int32_t k) {
    return spread->block + (size_t)k * (size_t)spread->mesh->n_vertices;
}

/* The first n columns of the block, each of sum zero, are replaced by G of them. */
static orb_status solve_block(orb_spread *spread, int32_t n, orb_error *error) {
    const orb_mesh *mesh = spread->mesh;
    orb_status status = laplacian_solve(spread->laplacian, spread->block, n, error);
    for (int32_t k = 0; k < n && status == ORB_OK; k++) {
        double *u = block_column(spread, k), mean = 0;
        for (int32_t v = 0; v < mesh->n_vertices; v++)
            mean += spread->shape.area[v] * u[v];
        for (int32_t v = 0; v < mesh->n_vertices; v++)
            u[v] = mesh->vertex_halfedge[v] < 0 ? 0 : u[v] - mean;
    }
    return status;
}

/* --- once for a mesh --------------------------------------------------------------------------------------------- */

/* Without cones: g_0, k_0 and the constant. */
static orb_status solve_bare(orb_spread *spread, const double *flat, orb_error *error) {
    const orb_mesh *mesh = spread->mesh;
    double sum = 0, *block = spread->block;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        block[v] = mesh->vertex_halfedge[v] < 0 ? 0 : flat[v] - spread->shape.angle[v];
        sum += block[v];
    }
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        block[v] = sum * spread->shape.area[v] - block[v];
    orb_status status = solve_block(spread, 1, error);
    if (status != ORB_OK)
        return status;
    memcpy(spread->bare, block, (size_t)mesh->n_vertices * sizeof *block);
    spread->constant = square(spread, spread->bare);
    apply_mass(spread, spread->bare, block);
    status = solve_block(spread, 1, error);
    memcpy(spread->pull, block, (size_t)mesh->n_vertices * sizeof *block);
    return status;
}

static orb_status factor(orb_spread *spread, orb_error *error) {
    bool positive = false;
    double *cotangent = spread->shape.cotangent;
    orb_status status = laplacian_factor(spread->laplacian, cotangent, spread->shape.area, 0, &positive, error);
    if (status != ORB_OK || positive)
        return status;
    for (int32_t h = 0; h < 3 * spread->mesh->n_triangles; h++)
        cotangent[h] = fmin(fmax(cotangent[h], least_cotangent), most_cotangent);
    status = laplacian_factor(spread->laplacian, cotangent, spread->shape.area, 0, &positive, error);
    if (status == ORB_OK && !positive)
        status = error_set(error, ORB_LINEAR_SOLVER,
                           "the mesh's Laplacian cannot be factored: its triangles are too "
                           "thin");
    return status;
}

orb_status spread_create(const orb_mesh *mesh, orb_spread **result, orb_error *error) {
    *result = NULL;
    const size_t n = (size_t)mesh->n_vertices + 1;
    orb_status status = error_memory(error);
    orb_spread *spread = calloc(1, sizeof *spread);
    double *lengths = malloc(((size_t)mesh->n_edges + 1) * sizeof *lengths);
    double *flat = malloc(n * sizeof *flat);
    if (!spread || !lengths || !flat || !shape_flat_angles(mesh, flat))
        goto done;
    spread->mesh = mesh;
    spread->bare = malloc(n * sizeof *spread->bare);
    spread->pull = malloc(n * sizeof *spread->pull);
    spread->block = malloc(SPREAD_BLOCK * n * sizeof *spread->block);
    if (!shape_allocate(&spread->shape, mesh) || !spread->bare || !spread->pull || !spread->block)
        goto done;
    shape_lengths(mesh, lengths);
    shape_measure(mesh, lengths, lengths, &spread->shape);
    status = laplacian_create(mesh, &spread->laplacian, error);
    if (status == ORB_OK)
        status = factor(spread, error);
    if (status == ORB_OK)
        status = solve_bare(spread, flat, error);
done:
    free(lengths);
    free(flat);
    if (status == ORB_OK)
        *result = spread;
    else
        spread_free(spread);
    return status;
}

void spread_free(orb_spread *spread) {
    if (!spread)
        return;
    shape_clear(&spread->shape);
    laplacian_free(spread->laplacian);
    free(spread->bare);
    free(spread->pull);
    free(spread->block);
    free(spread);
}

/* --- columns of the form ----------------------------------------------------------------------------------------- */

orb_status spread_columns(orb_spread *spread, int32_t n, const int32_t *vertex, double *const *column,
                          orb_error *error) {
    const size_t bytes = (size_t)spread->mesh->n_vertices * sizeof **column;
    for (int32_t k = 0; k < n; k++) {
        double *right = block_column(spread, k);
        for (int32_t v = 0; v < spread->mesh->n_vertices; v++)
            right[v] = -spread->shape.area[v];
        right[vertex[k]] += 1;
    }
    orb_status status = solve_block(spread, n, error);
    for (int32_t k = 0; k < n && status == ORB_OK; k++) {
        apply_mass(spread, block_column(spread, k), column[k]);
        memcpy(block_column(spread, k), column[k], bytes);
    }
    if (status == ORB_OK)
        status = solve_block(spread, n, error);
    for (int32_t k = 0; k < n && status == ORB_OK; k++)
        memcpy(column[k], block_column(spread, k), bytes);
    return status;
}

orb_charges spread_charges(const orb_signature *signature, const int32_t *vertex, double *charge) {
    const int32_t n = signature->n_cones + signature->n_corners;
    for (int32_t i = 0; i < n; i++)
        charge[i] = (i < signature->n_cones ? 2 : 1) * pi * (1 - 1.0 / signature->orders[i]);
    const double euler = signature->curvature == 0 ? 0 : signature->euler;
    const double lune = dilation_is_free(signature) ? (signature->n_cones > 0 ? 2 : 1) * pi / signature->orders[0] : 0;
    return (orb_charges){n, vertex, charge, euler, lune};
}

/* --- the fixed point --------------------------------------------------------------------------------------------- */

/* One choice of cones on its way. */
typedef struct relaxation {
    double *start;    /* [n_vertices] u for a(u) = a */
    double *previous; /* [n_vertices] the last step's residual */
    double step;      /* of the relaxation */
    bool first, done;
} relaxation;

/* right = 2 pi chi (a(u) - a) */
static void scaled_areas(const orb_spread *spread, double euler, const double *u, double *right) {
    const int32_t n = spread->mesh->n_vertices;
    const double *area = spread->shape.area;
    double most = -INFINITY, total = 0;
    for (int32_t v = 0; v < n; v++)
        if (area[v] > 0)
            most = fmax(most, u[v]);
    for (int32_t v = 0; v < n; v++) {
        right[v] = area[v] * exp(2 * fmin(u[v] - most, 0));
        total += right[v];
    }
    for (int32_t v = 0; v < n; v++)
        right[v] = 2 * pi * euler * (right[v] / total - area[v]);
}

/* u += step * residual, where residual = start + image - u, and the step is Aitken's, as Irons and Tuck (1969) have it for
 * vectors. It is bounded, as two cones leave a dilation free, along which there is nothing to hold it. */
static void relax(const orb_spread *spread, relaxation *one, const double *image, double *u) {
    const double *area = spread->shape.area;
    double size = 0, rest = 0, turn = 0, change = 0;
    for (int32_t v = 0; v < spread->mesh->n_vertices; v++) {
        const double residual = one->start[v] + image[v] - u[v], difference = residual - one->previous[v];
        size += area[v] * u[v] * u[v];
        rest += area[v] * residual * residual;
        turn += area[v] * one->previous[v] * difference;
        change += area[v] * difference * difference;
        one->previous[v] = residual;
    }
    one->done = !(rest > fixed_point * fixed_point * size);
    if (!one->first && change > 0)
        one->step = fmin(fmax(-one->step * turn / change, least_step), most_step);
    one->first = false;
    for (int32_t v = 0; v < spread->mesh->n_vertices && rest < INFINITY; v++)
        u[v] += one->step * one->previous[v];
}

static orb_status run_to_fixed_points(orb_spread *spread, int32_t n, const orb_charges *charges, relaxation *all,
                                      double *const *scale, orb_error *error) {
    orb_status status = ORB_OK;
    for (int step = 0; step < MOST_STEPS && status == ORB_OK; step++) {
        int32_t n_active = 0;
        for (int32_t k = 0; k < n; k++)
            if (!all[k].done)
                scaled_areas(spread, charges[k].euler, scale[k], block_column(spread, n_active++));
        if (n_active == 0)
            break;
        status = solve_block(spread, n_active, error);
        n_active = 0;
        for (int32_t k = 0; k < n && status == ORB_OK; k++)
            if (!all[k].done)
                relax(spread, all + k, block_column(spread, n_active++), scale[k]);
    }
    return status;
}

/* u for a(u) = a. */
static orb_status solve_linear(orb_spread *spread, int32_t n, const orb_charges *charges, double *const *scale,
                               orb_error *error) {
    for (int32_t k = 0; k < n; k++) {
        double *right = block_column(spread, k), sum = 0;
        for (int32_t i = 0; i < charges[k].n; i++)
            sum += charges[k].charge[i];
        for (int32_t v = 0; v < spread->mesh->n_vertices; v++)
            right[v] = -sum * spread->shape.area[v];
        for (int32_t i = 0; i < charges[k].n; i++)
            right[charges[k].vertex[i]] += charges[k].charge[i];
    }
    orb_status status = solve_block(spread, n, error);
    for (int32_t k = 0; k < n && status == ORB_OK; k++)
        for (int32_t v = 0; v < spread->mesh->n_vertices; v++)
            scale[k][v] = spread->bare[v] + block_column(spread, k)[v];
    return status;
}

/* --- lunes ------------------------------------------------------------------------------------------------------- */

/* Without its two cones the surface is a cylinder, flat in the metric e^2v |dx|^2 where the cones have all the curvature, and
 * its height is a harmonic function; u = v - log cosh(height + s) for any s (dilation.h). */
static orb_status scale_lune(orb_spread *spread, const orb_charges *charges, double *scale, orb_error *error) {
    const int32_t n = spread->mesh->n_vertices;
    const double *area = spread->shape.area;
    double *flat = block_column(spread, 0), *height = block_column(spread, 1), *base = block_column(spread, 2);
    const bool mirrored = spread->mesh->n_boundary_loops > 0;
    for (int32_t v = 0; v < n; v++) {
        flat[v] = -2 * (mirrored ? pi : 2 * pi) * area[v];
        height[v] = 0;
    }
    for (int32_t end = 0; end < 2; end++) {
        flat[charges->vertex[end]] += mirrored ? pi : 2 * pi;
        height[charges->vertex[end]] += end ? -charges->lune : charges->lune;
    }
    orb_status status = solve_block(spread, 2, error);
    if (status != ORB_OK)
        return status;
    for (int32_t v = 0; v < n; v++)
        base[v] = 2 * (spread->bare[v] + flat[v]);
    const double shift = dilation_of_least_spread(n, area, base, height);
    double mean = 0;
    for (int32_t v = 0; v < n; v++) {
        scale[v] = 0.5 * base[v] - dilation_log_cosh(height[v] + shift);
        mean += area[v] * scale[v];
    }
    for (int32_t v = 0; v < n; v++)
        scale[v] = spread->mesh->vertex_halfedge[v] < 0 ? 0 : scale[v] - mean;
    return ORB_OK;
}

orb_status spread_scales(orb_spread *spread, int32_t n, const orb_charges *charges, double *const *scale,
                         orb_error *error) {
    relaxation all[SPREAD_BLOCK] = {{0}};
    const size_t room = (size_t)spread->mesh->n_vertices + 1;
    orb_status status = ORB_OK;
    for (int32_t k = 0; k < n && status == ORB_OK; k++) {
        all[k] = (relaxation){NULL, NULL, 1, true, charges[k].euler == 0 || charges[k].lune > 0};
        if (all[k].done)
            continue;
        all[k].start = malloc(room * sizeof *all[k].start);
        all[k].previous = calloc(room, sizeof *all[k].previous);
        if (!all[k].start || !all[k].previous)
            status = error_memory(error);
    }
    if (status == ORB_OK)
        status = solve_linear(spread, n, charges, scale, error);
    for (int32_t k = 0; k < n && status == ORB_OK; k++)
        if (!all[k].done)
            memcpy(all[k].start, scale[k], (size_t)spread->mesh->n_vertices * sizeof *all[k].start);
    if (status == ORB_OK)
        status = run_to_fixed_points(spread, n, charges, all, scale, error);
    for (int32_t k = 0; k < n && status == ORB_OK; k++)
        if (charges[k].lune > 0)
            status = scale_lune(spread, charges + k, scale[k], error);
    for (int32_t k = 0; k < n; k++) {
        free(all[k].start);
        free(all[k].previous);
    }
    return status;
}
