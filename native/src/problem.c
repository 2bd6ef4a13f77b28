/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "problem.h"

#include <stdlib.h>
#include <string.h>

orb_status problem_create(const orb_mesh *mesh, const orb_copies *copies, const orb_tile *tile, const int32_t *cones,
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
    problem->edges = malloc((size_t)mesh->n_edges * 2 * sizeof(int32_t));
    problem->freedom = malloc((size_t)mesh->n_vertices);
    if (!problem->edges || !problem->freedom) {
        problem_free(problem);
        return error_memory(error);
    }
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        int32_t h = mesh->edge_halfedge[e]; /* both copies of one triangle; the other triangle's are as good */
        problem->edges[2 * e] = copies->triangles[h];
        problem->edges[2 * e + 1] = copies->triangles[halfedge_next(h)];
    }
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        problem->freedom[v] = mesh->vertex_halfedge[v] < 0 ? 0 : 2;
    for (int32_t c = 0; c < tile->n_cones; c++)
        problem->freedom[cones[c]] = 0;
    *result = problem;
    return error_set(error, ORB_OK, "%s", "");
}

void problem_free(orb_problem *problem) {
    if (!problem)
        return;
    free(problem->edges);
    free(problem->freedom);
    free(problem);
}

void problem_hold_rotation(orb_problem *problem, int32_t vertex, orb_point axis) {
    for (int32_t v = 0; v < problem->n_vertices && problem->freedom[vertex] != 2; v++)
        vertex = v;
    if (problem->freedom[vertex] == 2)
        problem->freedom[vertex] = 1;
    problem->toward = axis;
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

double complex problem_direction(const orb_problem *problem, orb_point position) {
    double complex t = geometry_toward(problem->geometry, position, problem->toward);
    return t / cabs(t);
}

/* Leaves of a gradient what the vertex's freedom allows. */
static double complex along_freedom(const orb_problem *problem, int32_t v, orb_point position, double complex g) {
    if (problem->freedom[v] != 1)
        return problem->freedom[v] ? g : 0;
    double complex direction = problem_direction(problem, position);
    return creal(g * conj(direction)) * direction;
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
        gradient[vertex[u]] -= pull * conj(turn[u]) * edge.at_p;
        gradient[vertex[v]] += pull * conj(turn[v]) * edge.at_q;
        scale[vertex[u]] += pull;
        scale[vertex[v]] += pull;
    }
    *relative = 0;
    for (int32_t v = 0; v < problem->n_vertices; v++) {
        gradient[v] = along_freedom(problem, v, position[v], gradient[v]);
        double size = cabs(gradient[v]);
        if (size > *relative * scale[v] || size != size)
            *relative = size / scale[v];
    }
    return energy / 2;
}
