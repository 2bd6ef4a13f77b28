/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "system.h"

#include <stdlib.h>
#include <string.h>

/* Rows that a moving vertex has. */
static int32_t rows_of(const orb_system *system, int32_t free_index) {
    return system->unknown[free_index + 1] - system->unknown[free_index];
}

static orb_status number_vertices(const orb_problem *problem, const orb_prepared *prepared, orb_system *system,
                                  orb_error *error) {
    size_t n = (size_t)problem->n_vertices;
    system->free_index = malloc((n + 1) * sizeof(int32_t));
    system->free_vertex = malloc((n + 1) * sizeof(int32_t));
    system->unknown = malloc((n + 2) * sizeof(int32_t));
    if (!system->free_index || !system->free_vertex || !system->unknown)
        return error_memory(error);
    int32_t rows = 0;
    for (int32_t v = 0; v < problem->n_vertices; v++) {
        const bool has_row = prepared ? prepared->mesh->vertex_halfedge[v] >= 0 : problem->freedom[v] > 0;
        system->free_index[v] = has_row ? system->n_free : -1;
        if (!has_row)
            continue;
        system->free_vertex[system->n_free] = v;
        system->unknown[system->n_free++] = rows;
        rows += system->is_complex ? 1 : problem->freedom[v];
    }
    system->unknown[system->n_free] = rows;
    return ORB_OK;
}

static orb_status build_blocks(const orb_problem *problem, orb_system *system, orb_error *error) {
    size_t edges = (size_t)problem->n_edges;
    int32_t *ends = malloc((2 * edges + 1) * sizeof *ends);
    system->slot = malloc((edges + 1) * sizeof *system->slot);
    if (!ends || !system->slot) {
        free(ends);
        return error_memory(error);
    }
    for (size_t k = 0; k < 2 * edges; k++)
        ends[k] = system->free_index[problem->copies->vertex[problem->edges[k]]];
    orb_status status = pattern_of_pairs(system->n_free, problem->n_edges, ends, &system->blocks, system->slot, error);
    free(ends);
    return status;
}

/* The same, known already. What is between a fixed vertex and others has no slot: its row is its own. */
static orb_status copy_blocks(const orb_problem *problem, const orb_prepared *prepared, orb_system *system,
                              orb_error *error) {
    size_t edges = (size_t)problem->n_edges;
    orb_status status = pattern_copy(&prepared->blocks, &system->blocks, error);
    system->slot = malloc((edges + 1) * sizeof *system->slot);
    if (status != ORB_OK || !system->slot)
        return error_memory(error);
    for (size_t e = 0; e < edges; e++) {
        const int32_t *ends = problem->edges + 2 * e, *vertex = problem->copies->vertex;
        bool both = problem->freedom[vertex[ends[0]]] && problem->freedom[vertex[ends[1]]];
        system->slot[e] = both ? prepared->slot[e] : -1;
    }
    system->analysis = prepared->analysis;
    return ORB_OK;
}

/* Real systems: every block becomes one to two rows of one to two columns; below the diagonal only. */
static orb_status expand_pattern(orb_system *system, orb_error *error) {
    const orb_pattern *blocks = &system->blocks;
    int64_t entries = blocks->column[blocks->n], filled = 0;
    int32_t rows = system->unknown[system->n_free];
    system->pattern.n = rows;
    system->pattern.column = malloc(((size_t)rows + 1) * sizeof(int64_t));
    system->pattern.row = malloc((size_t)(4 * entries + 1) * sizeof(int32_t));
    system->first = malloc((size_t)(2 * entries + 1) * sizeof(int64_t));
    if (!system->pattern.column || !system->pattern.row || !system->first)
        return error_memory(error);
    for (int32_t j = 0; j < system->n_free; j++)
        for (int32_t b = 0; b < rows_of(system, j); b++) {
            system->pattern.column[system->unknown[j] + b] = filled;
            for (int64_t k = blocks->column[j]; k < blocks->column[j + 1]; k++) {
                int32_t i = blocks->row[k], skip = i == j ? b : 0;
                system->first[2 * k + b] = filled - skip; /* row a of column b stands at first + a */
                for (int32_t a = skip; a < rows_of(system, i); a++)
                    system->pattern.row[filled++] = system->unknown[i] + a;
            }
        }
    system->pattern.column[rows] = filled;
    return ORB_OK;
}

orb_status system_create(const orb_problem *problem, bool is_complex, const orb_prepared *prepared, orb_system **result,
                         orb_error *error) {
    *result = NULL;
    orb_system *system = calloc(1, sizeof *system);
    if (!system)
        return error_memory(error);
    system->is_complex = is_complex;
    if (!is_complex)
        prepared = NULL;
    orb_status status = number_vertices(problem, prepared, system, error);
    if (status == ORB_OK)
        status = prepared ? copy_blocks(problem, prepared, system, error) : build_blocks(problem, system, error);
    if (status == ORB_OK && !is_complex)
        status = expand_pattern(system, error);
    if (status != ORB_OK)
        goto done;
    size_t entries = (size_t)system->blocks.column[system->n_free];
    system->alpha = malloc((entries + 1) * sizeof *system->alpha);
    system->beta = is_complex ? NULL : malloc((entries + 1) * sizeof *system->beta);
    if (is_complex)
        system->pattern = system->blocks;
    else
        system->values = malloc((size_t)(system->pattern.column[system->pattern.n] + 1) * sizeof(double));
    if (!system->alpha || (!is_complex && (!system->beta || !system->values))) {
        status = error_memory(error);
        goto done;
    }
    if (is_complex)
        system->values = (double *)system->alpha; /* interleaved, as CHOLMOD wants it */
    *result = system;
    system = NULL;
    status = error_set(error, ORB_OK, "%s", "");
done:
    system_free(system);
    return status;
}

void system_free(orb_system *system) {
    if (!system)
        return;
    if (!system->is_complex) {
        pattern_clear(&system->pattern);
        free(system->values);
    }
    free(system->free_vertex);
    free(system->free_index);
    pattern_clear(&system->blocks);
    free(system->slot);
    free(system->unknown);
    free(system->first);
    free(system->alpha);
    free(system->beta);
    free(system);
}

orb_status system_find_order(const orb_system *system, orb_ordering ordering, int32_t *order, orb_error *error) {
    orb_status status = cholesky_order(&system->blocks, ordering, order, error);
    for (int32_t k = 0; k < system->n_free && status == ORB_OK; k++)
        order[k] = system->free_vertex[order[k]];
    return status;
}

void system_spread_order(const orb_system *system, int32_t n_order, const int32_t *order, int32_t *rows) {
    int32_t filled = 0;
    for (int32_t k = 0; k < n_order; k++) {
        int32_t i = system->free_index[order[k]];
        for (int32_t a = i < 0 ? 0 : system->unknown[i]; i >= 0 && a < system->unknown[i + 1]; a++)
            rows[filled++] = a;
    }
}

/* One edge's four blocks, its directions at p and q in the vertices' own frames; where one of the two is mirrored, so
 * is the sense of the perpendiculars, and S changes its sign. At p: w ((1 + C)/2 y + (1 - C)/2 a_p^2 conj y), likewise
 * at q; mixed, from q to p: -w ((1 + S)/2 a_p conj(a_q) y + (1 - S)/2 a_p a_q conj y). */
static void add_edge(orb_system *system, const orb_problem *problem, int32_t e, orb_edge_terms edge,
                     const double complex *turn) {
    int32_t u = problem->edges[2 * e], v = problem->edges[2 * e + 1];
    int32_t i = system->free_index[problem->copies->vertex[u]], j = system->free_index[problem->copies->vertex[v]];
    double w = problem->weights[e];
    double complex p = problem_pull(problem, u, turn[u], edge.at_p), q = problem_pull(problem, v, turn[v], edge.at_q);
    const orb_copies *copies = problem->copies;
    if (copies->isometries[copies->isometry[u]].reflects != copies->isometries[copies->isometry[v]].reflects)
        edge.S = -edge.S;
    double own = w * (1 + edge.C) / 2, own_bar = w * (1 - edge.C) / 2;
    double complex mixed = -w * (1 + edge.S) / 2 * p * conj(q), mixed_bar = -w * (1 - edge.S) / 2 * p * q;
    if (i >= 0)
        system->alpha[system->blocks.column[i]] += own;
    if (j >= 0)
        system->alpha[system->blocks.column[j]] += own;
    if (i >= 0 && i == j) /* an edge between two copies of one vertex */
        system->alpha[system->blocks.column[i]] += 2 * creal(mixed);
    if (system->slot[e] >= 0)
        system->alpha[system->slot[e]] += i > j ? mixed : conj(mixed);
    if (system->is_complex)
        return;
    if (i >= 0)
        system->beta[system->blocks.column[i]] += own_bar * p * p;
    if (j >= 0)
        system->beta[system->blocks.column[j]] += own_bar * q * q;
    if (i >= 0 && i == j)
        system->beta[system->blocks.column[i]] += 2 * mixed_bar;
    if (system->slot[e] >= 0)
        system->beta[system->slot[e]] += mixed_bar;
}

/* The tangent vectors that a vertex's rows stand for. */
static void basis_of(const orb_system *system, const orb_problem *problem, const orb_point *position,
                     int32_t free_index, double complex basis[2]) {
    int32_t v = system->free_vertex[free_index];
    basis[0] = problem->freedom[v] == 1 ? problem_direction(problem, v, position[v]) : 1;
    basis[1] = CMPLX(0, 1);
}

void system_assemble(orb_system *system, const orb_problem *problem, const orb_point *position, const orb_point *placed,
                     const double complex *turn, orb_hessian hessian) {
    size_t entries = (size_t)system->blocks.column[system->n_free];
    memset(system->alpha, 0, entries * sizeof *system->alpha);
    if (!system->is_complex)
        memset(system->beta, 0, entries * sizeof *system->beta);
    for (int32_t e = 0; e < problem->n_edges; e++) {
        const int32_t *uv = problem->edges + 2 * e;
        orb_edge_terms edge = geometry_edge(problem->geometry, placed[uv[0]], placed[uv[1]]);
        if (hessian == HESSIAN_POSITIVE)
            edge.C = edge.S = (edge.C + edge.S) / 2;
        add_edge(system, problem, e, edge, turn);
    }
    for (int32_t j = 0; j < system->n_free; j++)
        if (!problem->freedom[system->free_vertex[j]])
            system->alpha[system->blocks.column[j]] = 1;
    if (system->is_complex)
        return;
    for (int32_t j = 0; j < system->n_free; j++) {
        double complex column[2], row[2];
        basis_of(system, problem, position, j, column);
        for (int64_t k = system->blocks.column[j]; k < system->blocks.column[j + 1]; k++) {
            int32_t i = system->blocks.row[k];
            basis_of(system, problem, position, i, row);
            for (int32_t b = 0; b < rows_of(system, j); b++) {
                double complex image = system->alpha[k] * column[b] + system->beta[k] * conj(column[b]);
                for (int32_t a = i == j ? b : 0; a < rows_of(system, i); a++)
                    system->values[system->first[2 * k + b] + a] = creal(conj(row[a]) * image);
            }
        }
    }
}

void system_gather(const orb_system *system, const orb_problem *problem, const orb_point *position,
                   const double complex *vectors, double *rows) {
    for (int32_t j = 0; j < system->n_free; j++) {
        double complex basis[2], y = vectors[system->free_vertex[j]];
        if (system->is_complex) {
            rows[2 * j] = creal(y);
            rows[2 * j + 1] = cimag(y);
            continue;
        }
        basis_of(system, problem, position, j, basis);
        for (int32_t a = 0; a < rows_of(system, j); a++)
            rows[system->unknown[j] + a] = creal(conj(basis[a]) * y);
    }
}

void system_scatter(const orb_system *system, const orb_problem *problem, const orb_point *position, const double *rows,
                    double complex *vectors) {
    memset(vectors, 0, (size_t)problem->n_vertices * sizeof *vectors);
    for (int32_t j = 0; j < system->n_free; j++) {
        double complex basis[2], y = 0;
        if (system->is_complex) {
            y = CMPLX(rows[2 * j], rows[2 * j + 1]);
        } else {
            basis_of(system, problem, position, j, basis);
            for (int32_t a = 0; a < rows_of(system, j); a++)
                y += rows[system->unknown[j] + a] * basis[a];
        }
        vectors[system->free_vertex[j]] = y;
    }
}
