/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "initial.h"

#include <math.h>
#include <stdlib.h>

#include "cholesky.h"

static double step_length(const orb_disk *disk, int32_t at) {
    const double *p = disk->mesh->vertices + 3 * (size_t)disk->copy_vertex[disk->boundary[at]];
    const double *q = disk->mesh->vertices + 3 * (size_t)disk->copy_vertex[disk->boundary[(at + 1) % disk->n_boundary]];
    return hypot(hypot(q[0] - p[0], q[1] - p[1]), q[2] - p[2]); /* no square leaves the range of doubles */
}

static int32_t side_end(const orb_disk *disk, int32_t s) {
    return s + 1 < disk->word->n_sides ? disk->corner_at[s + 1] : disk->n_boundary;
}

/* How far along side s each of its vertices i goes, share[i - disk->corner_at[s]] of [0, 1): by arc length, but apart
 * even where vertices coincide. */
static void divide_side(const orb_disk *disk, int32_t s, double *share) {
    static const double least = 1e-6; /* step, of the mean one */
    int32_t first = disk->corner_at[s], n = side_end(disk, s) - first;
    double total = 0, along = 0;
    for (int32_t i = 0; i < n; i++)
        total += step_length(disk, first + i);
    bool even = !(total > 0) || !isfinite(total);
    double shortest = even ? 1 : least * total / n;
    for (int32_t i = 0; i < n; i++) {
        share[i] = along;
        along += even ? 1 : fmax(shortest, step_length(disk, first + i));
    }
    for (int32_t i = 0; i < n; i++)
        share[i] /= along;
}

/* Each vertex of the boundary where its own copy is; share: room for [n_boundary]. */
static void place_boundary(const orb_disk *disk, const orb_tile *tile, double *share, orb_point *position) {
    for (int32_t v = 0; v < disk->mesh->n_vertices; v++)
        position[v] = point_of(0);
    for (int32_t s = 0; s < tile->word->n_sides; s++) {
        divide_side(disk, s, share);
        for (int32_t i = disk->corner_at[s]; i < side_end(disk, s); i++) {
            int32_t u = disk->boundary[i];
            double complex along = share[i - disk->corner_at[s]] * tile->sides[s];
            if (disk->place[u].kind == PLACE_SELF)
                position[disk->copy_vertex[u]] = geometry_exp(tile->geometry, tile->corners[s], along);
        }
    }
}

orb_status initial_boundary(const orb_disk *disk, const orb_tile *tile, orb_point *position, orb_error *error) {
    double *share = malloc(((size_t)disk->n_boundary + 1) * sizeof *share);
    if (!share)
        return error_memory(error);
    place_boundary(disk, tile, share, position);
    free(share);
    return ORB_OK;
}

/* chart[n_copies]: the boundary's copies. */
static void chart_boundary(const orb_disk *disk, const orb_tile *tile, const orb_point *position,
                           double complex *chart) {
    for (int32_t i = 0; i < disk->n_boundary; i++) {
        int32_t u = disk->boundary[i];
        orb_isometry element = holonomy_element(tile, disk->place[u]);
        orb_point p = isometry_apply(tile->geometry, element, position[disk->copy_vertex[u]]);
        chart[u] = geometry_convex_chart(tile->geometry, p);
    }
}

/* The Laplacian of the disk's inner vertices, and what the boundary contributes. */
typedef struct laplacian {
    int32_t n;
    int32_t *index; /* [n_copies] row of an inner copy; -1 on the boundary */
    int32_t *ends;  /* [n_edges*2] copies of each edge */
    int64_t *slot;  /* [n_edges] */
    int32_t *order; /* [n] */
    orb_pattern pattern;
    double *values, *right; /* right: [2*n] x then y */
} laplacian;

static void laplacian_clear(laplacian *system) {
    free(system->index);
    free(system->ends);
    free(system->slot);
    free(system->order);
    free(system->values);
    free(system->right);
    pattern_clear(&system->pattern);
}

static orb_status number_interior(const orb_disk *disk, laplacian *system, orb_error *error) {
    const orb_mesh *mesh = disk->mesh;
    size_t copies = (size_t)disk->n_copies, edges = (size_t)mesh->n_edges, n = (size_t)mesh->n_vertices;
    system->index = malloc((copies + 1) * sizeof *system->index);
    system->ends = malloc((2 * edges + 1) * sizeof *system->ends);
    system->slot = malloc((edges + 1) * sizeof *system->slot);
    system->order = malloc((n + 1) * sizeof *system->order);
    system->right = calloc(2 * n + 1, sizeof *system->right);
    if (!system->index || !system->ends || !system->slot || !system->order || !system->right)
        return error_memory(error);
    for (int32_t u = 0; u < disk->n_copies; u++)
        system->index[u] = u < mesh->n_vertices && mesh->vertex_halfedge[u] >= 0 ? 0 : -1;
    for (int32_t i = 0; i < disk->n_boundary; i++)
        system->index[disk->boundary[i]] = -1;
    for (int32_t u = 0; u < disk->n_copies; u++)
        if (system->index[u] == 0)
            system->index[u] = system->n++;
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        int32_t h = mesh->edge_halfedge[e];
        system->ends[2 * e] = disk->triangles[h];
        system->ends[2 * e + 1] = disk->triangles[halfedge_next(h)];
    }
    return ORB_OK;
}

static orb_status build_laplacian(const orb_disk *disk, const double *weights, const double complex *chart,
                                  laplacian *system, orb_error *error) {
    int32_t edges = disk->mesh->n_edges, n = system->n;
    for (int32_t k = 0; k < 2 * edges; k++) /* to rows; the boundary copies keep their number, negative */
        system->ends[k] = system->index[system->ends[k]] < 0 ? -1 - system->ends[k] : system->index[system->ends[k]];
    orb_status status = pattern_of_pairs(n, edges, system->ends, &system->pattern, system->slot, error);
    if (status != ORB_OK)
        return status;
    system->values = calloc((size_t)system->pattern.column[n] + 1, sizeof *system->values);
    if (!system->values)
        return error_memory(error);
    for (int32_t e = 0; e < edges; e++) {
        if (system->slot[e] >= 0)
            system->values[system->slot[e]] -= weights[e];
        for (int side = 0; side < 2; side++) {
            int32_t row = system->ends[2 * e + side], other = system->ends[2 * e + 1 - side];
            if (row < 0)
                continue;
            system->values[system->pattern.column[row]] += weights[e];
            if (other < 0) {
                system->right[row] += weights[e] * creal(chart[-1 - other]);
                system->right[n + row] += weights[e] * cimag(chart[-1 - other]);
            }
        }
    }
    return ORB_OK;
}

static orb_status solve_laplacian(laplacian *system, const int32_t *vertex_order, int32_t n_order, orb_error *error) {
    orb_cholesky *cholesky = NULL;
    bool positive = false;
    int32_t filled = 0;
    orb_status status = ORB_OK;
    for (int32_t k = 0; vertex_order && k < n_order; k++)
        if (system->index[vertex_order[k]] >= 0)
            system->order[filled++] = system->index[vertex_order[k]];
    if (filled != system->n)
        status = cholesky_order(&system->pattern, ORDERING_AMD, system->order, error);
    if (status == ORB_OK)
        status = cholesky_analyze(&system->pattern, system->order, false, &cholesky, error);
    if (status == ORB_OK)
        status = cholesky_factor(cholesky, system->values, &positive, error);
    if (status == ORB_OK && !positive)
        status = error_set(error, ORB_NOT_CONVERGED, "the weights are of too different size for a first embedding");
    if (status == ORB_OK)
        status = cholesky_solve(cholesky, system->right, 2, system->right, error);
    cholesky_free(cholesky);
    return status;
}

orb_status initial_embed(const orb_disk *disk, const orb_tile *tile, const double *weights, const int32_t *vertex_order,
                         int32_t n_order, orb_point *position, orb_error *error) {
    laplacian system = {0};
    double complex *chart = malloc(((size_t)disk->n_copies + 1) * sizeof *chart);
    orb_status status = chart ? number_interior(disk, &system, error) : error_memory(error);
    if (status == ORB_OK)
        status = initial_boundary(disk, tile, position, error);
    if (status != ORB_OK)
        goto done;
    chart_boundary(disk, tile, position, chart);
    if (system.n == 0)
        goto done;
    status = build_laplacian(disk, weights, chart, &system, error);
    if (status == ORB_OK)
        status = solve_laplacian(&system, vertex_order, n_order, error);
    if (status != ORB_OK)
        goto done;
    for (int32_t u = 0; u < disk->n_copies; u++) {
        int32_t row = system.index[u];
        if (row >= 0)
            position[u] =
                geometry_from_convex_chart(tile->geometry, CMPLX(system.right[row], system.right[system.n + row]));
    }
done:
    free(chart);
    laplacian_clear(&system);
    return status;
}
