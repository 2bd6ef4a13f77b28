/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "problem.h"

#include <stdlib.h>
#include <string.h>

static const double same_direction = 1e-9;

static void find_reflections(orb_problem *problem) {
    for (int32_t u = 0; u < problem->copies->n_copies; u++)
        problem->reflects = problem->reflects || problem->copies->isometries[problem->copies->isometry[u]].reflects;
}

/* Edges, in copies of one of their triangles; the other triangle's are as good. */
static void list_edges(orb_problem *problem, const orb_mesh *mesh) {
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        int32_t h = mesh->edge_halfedge[e];
        problem->edges[2 * e] = problem->copies->triangles[h];
        problem->edges[2 * e + 1] = problem->copies->triangles[halfedge_next(h)];
    }
    find_reflections(problem);
}

static void slide(orb_problem *problem, int32_t vertex, int32_t line) {
    problem->freedom[vertex] = 1;
    problem->line[vertex] = line;
    problem->n_sliding++;
}

static void fix(orb_problem *problem, int32_t vertex) {
    problem->n_sliding -= problem->freedom[vertex] == 1;
    problem->freedom[vertex] = 0;
}

/* What the disk's boundary allows each vertex. Vertices of a refinement (copies beyond the mesh's) do not count. */
static void find_freedoms(orb_problem *problem, const orb_mesh *mesh, const orb_disk *disk, const orb_tile *tile) {
    const orb_word *word = tile->word;
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        problem->freedom[v] = mesh->vertex_halfedge[v] < 0 ? 0 : 2;
    for (int32_t s = 0; s < word->n_sides; s++) {
        int32_t end = s + 1 < word->n_sides ? disk->corner_at[s + 1] : disk->n_boundary, node = word->node[s];
        for (int32_t i = disk->corner_at[s] + 1; i < end && word_is_mirror(word, s); i++)
            slide(problem, disk->copy_vertex[disk->boundary[i]], s);
        int32_t corner = disk->copy_vertex[disk->boundary[disk->corner_at[s]]];
        if (word->order[node] > 1 || tile->fixed)
            problem->freedom[corner] = 0;
        else if (word->on_mirror[node] && word->first[node] == s)
            slide(problem, corner, word_is_mirror(word, s) ? s : word_previous(word, s));
    }
    if (tile->fixed)
        for (int32_t i = 0; i < disk->n_boundary; i++)
            fix(problem, disk->copy_vertex[disk->boundary[i]]);
}

/* --- free motions ------------------------------------------------------------------------------------------------ */

/* The plane's translations that commute with the group: how many dimensions, and the direction of a single one. */
static int free_translations(const orb_tile *tile, double complex *direction) {
    int dimensions = 2;
    double complex axis = 0; /* the square of the reflections' direction */
    for (int32_t s = 0; s < tile->word->n_sides; s++) {
        double complex a = tile->pairings[s].a.z, linear = a / conj(a);
        if (!tile->pairings[s].reflects) {
            if (cabs(linear - 1) > same_direction)
                return 0;
        } else if (dimensions == 1 && cabs(linear - axis) > same_direction) {
            return 0;
        } else {
            dimensions = 1;
            axis = linear;
        }
    }
    *direction = csqrt(axis);
    return dimensions;
}

/* The cone about which the whole group turns; -1. A rotation commutes with what fixes its axis point by point, or turns
 * it round and reflects. */
static int32_t free_rotation(const orb_tile *tile) {
    const orb_word *word = tile->word;
    for (int32_t n = 0; n < word->n_nodes; n++) {
        if (word->order[n] == 1 || word->on_mirror[n])
            continue;
        bool commutes = true;
        for (int32_t s = 0; s < word->n_sides && commutes; s++) {
            orb_point p = tile->corners[word->first[n]], q = isometry_apply(tile->geometry, tile->pairings[s], p);
            commutes = tile->pairings[s].reflects ? geometry_is_antipodal(tile->geometry, p, q)
                                                  : geometry_distance(tile->geometry, p, q) < same_direction;
        }
        if (commutes)
            return word->first[n];
    }
    return -1;
}

/* A vertex that the first corner of a node on a mirror stands for, and that slides; -1. */
static int32_t sliding_corner(const orb_problem *problem, const orb_disk *disk, const orb_tile *tile) {
    for (int32_t n = 0; n < tile->word->n_nodes; n++) {
        int32_t v = disk->copy_vertex[disk->boundary[disk->corner_at[tile->word->first[n]]]];
        if (problem->freedom[v] == 1)
            return v;
    }
    return -1;
}

static void hold_translations(orb_problem *problem, const orb_disk *disk, const orb_tile *tile) {
    double complex direction = 1;
    int dimensions = free_translations(tile, &direction);
    int32_t sliding = sliding_corner(problem, disk, tile), base = disk->copy_vertex[disk->boundary[0]];
    if (dimensions == 0)
        return;
    if (dimensions == 2 || sliding >= 0) {
        fix(problem, dimensions == 1 ? sliding : base);
        return;
    }
    orb_point at = tile->corners[tile->word->first[tile->word->node[0]]];
    orb_point across = geometry_exp(problem->geometry, at, CMPLX(0, 1) * direction);
    problem->lines[tile->word->n_sides] = isometry_pairing(problem->geometry, point_of(0), point_of(0.5), at, across);
    slide(problem, base, tile->word->n_sides);
}

static void hold_rotation(orb_problem *problem, const orb_mesh *mesh, const orb_disk *disk, const orb_tile *tile) {
    int32_t axis = free_rotation(tile), sliding = sliding_corner(problem, disk, tile);
    if (axis < 0)
        return;
    if (sliding >= 0) {
        fix(problem, sliding);
        return;
    }
    int32_t next = word_next(tile->word, axis), end = next > axis ? disk->corner_at[next] : disk->n_boundary;
    int32_t middle = disk->copy_vertex[disk->boundary[(disk->corner_at[axis] + end) / 2]];
    int32_t vertex = middle < mesh->n_vertices ? middle : 0;
    for (int32_t v = 0; v < mesh->n_vertices && problem->freedom[vertex] != 2; v++)
        vertex = v;
    if (problem->freedom[vertex] != 2)
        return;
    problem->held = vertex;
    problem->axis = tile->corners[axis];
    problem->lines[tile->word->n_sides] = isometry_identity();
    slide(problem, vertex, tile->word->n_sides);
}

void problem_aim(orb_problem *problem, const orb_point *position) {
    if (problem->held >= 0)
        problem->lines[problem->line[problem->held]] =
            isometry_pairing(problem->geometry, point_of(0), point_of(0.5), problem->axis, position[problem->held]);
}

orb_status problem_create(const orb_mesh *mesh, const orb_copies *copies, const orb_disk *disk, const orb_tile *tile,
                          const double *weights, orb_problem **result, orb_error *error) {
    *result = NULL;
    orb_problem *problem = calloc(1, sizeof *problem);
    if (!problem)
        return error_memory(error);
    problem->geometry = tile->geometry;
    problem->copies = copies;
    problem->weights = weights;
    problem->n_vertices = mesh->n_vertices;
    problem->n_edges = mesh->n_edges;
    problem->n_lines = tile->word->n_sides + 1;
    problem->held = -1;
    problem->edges = malloc((size_t)mesh->n_edges * 2 * sizeof(int32_t));
    problem->freedom = malloc((size_t)mesh->n_vertices);
    problem->line = calloc((size_t)mesh->n_vertices, sizeof *problem->line);
    problem->lines = malloc((size_t)problem->n_lines * sizeof *problem->lines);
    if (!problem->edges || !problem->freedom || !problem->line || !problem->lines) {
        problem_free(problem);
        return error_memory(error);
    }
    memcpy(problem->lines, tile->lines, (size_t)tile->word->n_sides * sizeof *problem->lines);
    list_edges(problem, mesh);
    find_freedoms(problem, mesh, disk, tile);
    if (!tile->fixed)
        (geometry_has_translations(tile->geometry) ? hold_translations(problem, disk, tile)
                                                   : hold_rotation(problem, mesh, disk, tile));
    *result = problem;
    return error_set(error, ORB_OK, "%s", "");
}

void problem_free(orb_problem *problem) {
    if (!problem)
        return;
    free(problem->edges);
    free(problem->freedom);
    free(problem->line);
    free(problem->lines);
    free(problem);
}

void problem_use_edges(orb_problem *problem, const orb_copies *copies, const int32_t *edges, const double *weights) {
    memcpy(problem->edges, edges, (size_t)problem->n_edges * 2 * sizeof *edges);
    problem->copies = copies;
    problem->weights = weights;
    find_reflections(problem);
}

bool problem_is_complex(const orb_problem *problem) {
    return !problem->reflects && problem->n_sliding == (problem->held >= 0);
}

void problem_place(const orb_problem *problem, const orb_point *position, orb_point *placed, double complex *turn) {
    const orb_copies *copies = problem->copies;
    for (int32_t u = 0; u < copies->n_copies; u++) {
        orb_point p = position[copies->vertex[u]];
        orb_isometry h = copies->isometries[copies->isometry[u]];
        bool moved = copies->isometry[u] != 0;
        placed[u] = moved ? isometry_apply(problem->geometry, h, p) : p;
        turn[u] = moved ? isometry_turn(problem->geometry, h, p) : 1;
    }
}

double complex problem_pull(const orb_problem *problem, int32_t u, double complex turn, double complex vector) {
    bool reflects = problem->copies->isometries[problem->copies->isometry[u]].reflects;
    return reflects ? turn * conj(vector) : conj(turn) * vector;
}

/* Where on the real axis the point of the line is that is nearest to a position close to it. */
static orb_point along_line(const orb_problem *problem, orb_isometry line, orb_point position) {
    orb_point x = isometry_apply(problem->geometry, isometry_inverse(line), position);
    return (orb_point){creal(x.z), creal(x.low)};
}

double complex problem_direction(const orb_problem *problem, int32_t vertex, orb_point position) {
    orb_isometry line = problem->lines[problem->line[vertex]];
    return isometry_turn(problem->geometry, line, along_line(problem, line, position));
}

orb_point problem_onto_line(const orb_problem *problem, int32_t vertex, orb_point position) {
    orb_isometry line = problem->lines[problem->line[vertex]];
    return isometry_apply(problem->geometry, line, along_line(problem, line, position));
}

/* Leaves of a gradient what the vertex's freedom allows. */
static double complex along_freedom(const orb_problem *problem, int32_t v, orb_point position, double complex g) {
    if (problem->freedom[v] != 1)
        return problem->freedom[v] ? g : 0;
    double complex direction = problem_direction(problem, v, position);
    return creal(g * conj(direction)) * direction;
}

void problem_covariance(const orb_problem *problem, const orb_point *placed, double covariance[3]) {
    covariance[0] = covariance[1] = covariance[2] = 0;
    for (int32_t e = 0; e < problem->n_edges; e++) {
        double complex d =
            geometry_log(problem->geometry, placed[problem->edges[2 * e]], placed[problem->edges[2 * e + 1]]);
        covariance[0] += problem->weights[e] * creal(d) * creal(d);
        covariance[1] += problem->weights[e] * creal(d) * cimag(d);
        covariance[2] += problem->weights[e] * cimag(d) * cimag(d);
    }
}

double problem_energy(const orb_problem *problem, const orb_point *placed, const double complex *turn,
                      const orb_point *position, double complex *gradient, double *scale, double *relative) {
    double energy = 0;
    const int32_t *vertex = problem->copies->vertex;
    if (!gradient) {
        for (int32_t e = 0; e < problem->n_edges; e++) {
            const int32_t *uv = problem->edges + 2 * e;
            double d = geometry_distance(problem->geometry, placed[uv[0]], placed[uv[1]]);
            energy += problem->weights[e] * d * d;
        }
        return energy / 2;
    }
    memset(gradient, 0, (size_t)problem->n_vertices * sizeof *gradient);
    memset(scale, 0, (size_t)problem->n_vertices * sizeof *scale);
    for (int32_t e = 0; e < problem->n_edges; e++) {
        int32_t u = problem->edges[2 * e], v = problem->edges[2 * e + 1];
        orb_edge_terms edge = geometry_edge(problem->geometry, placed[u], placed[v]);
        double pull = problem->weights[e] * edge.distance;
        energy += pull * edge.distance;
        gradient[vertex[u]] -= pull * problem_pull(problem, u, turn[u], edge.at_p);
        gradient[vertex[v]] += pull * problem_pull(problem, v, turn[v], edge.at_q);
        scale[vertex[u]] += pull;
        scale[vertex[v]] += pull;
    }
    *relative = 0;
    for (int32_t v = 0; v < problem->n_vertices; v++) {
        gradient[v] = along_freedom(problem, v, position[v], gradient[v]);
        double size = modulus(gradient[v]);
        if (size > *relative * scale[v] || size != size)
            *relative = size / scale[v];
    }
    return energy / 2;
}
