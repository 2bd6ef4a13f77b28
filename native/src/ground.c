/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "ground.h"

#include <math.h>
#include <stdlib.h>

#include "triangle.h"

/* A quarter of the given weights, as the form is a quarter of the variance of log area. */
static orb_status weigh(orb_ground *ground, int32_t n_given, const double *keep_away, orb_error *error) {
    const orb_mesh *mesh = ground->mesh;
    orb_found wrong = {0};
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        const double weight = v >= n_given ? INFINITY : keep_away ? keep_away[v] : 0;
        if (!(weight >= 0))
            found_add(&wrong, v);
        ground->penalty[v] = mesh->vertex_halfedge[v] < 0 ? INFINITY : 0.25 * weight;
    }
    if (wrong.found > 0)
        return error_set_elements(error, ORB_BAD_WEIGHT, ORB_VERTEX, wrong.elements, wrong.entries, wrong.found,
                                  "%lld keep-away %s negative or not a number, first at vertex %d: give zero or more",
                                  (long long)wrong.found, wrong.found == 1 ? "weight is" : "weights are",
                                  (int)wrong.elements[0]);
    return ORB_OK;
}

orb_status ground_create(const orb_mesh *mesh, int32_t n_given, const double *keep_away, int32_t n_fixed,
                         const int32_t *fixed, orb_ground **result, orb_error *error) {
    const size_t n = (size_t)mesh->n_vertices + 1;
    orb_ground *ground = *result = calloc(1, sizeof *ground);
    if (!ground)
        return error_memory(error);
    ground->mesh = mesh;
    ground->penalty = malloc(n * sizeof *ground->penalty);
    ground->fixed = calloc(n, sizeof *ground->fixed);
    if (!ground->penalty || !ground->fixed)
        return error_memory(error);
    orb_status status = boundary_list(mesh, &ground->boundary, error);
    if (status == ORB_OK)
        status = weigh(ground, n_given, keep_away, error);
    if (status != ORB_OK)
        return status;
    for (int32_t k = 0; k < n_fixed; k++) {
        ground->fixed[fixed[k]] = true;
        ground->penalty[fixed[k]] = 0;
    }
    for (int32_t t = 0; t < mesh->n_triangles; t++) { /* by square roots, which are of the size of the lengths */
        const triangle_shape shape = triangle_measure(mesh, t);
        ground->size = hypot(ground->size, sqrt(0.5 * shape.double_area) / shape.scale);
    }
    return ORB_OK;
}

void ground_free(orb_ground *ground) {
    if (!ground)
        return;
    boundary_free(ground->boundary);
    free(ground->penalty);
    free(ground->fixed);
    free(ground);
}

bool ground_place(const orb_ground *ground, int32_t kind, int32_t vertex, orb_site *site) {
    const int32_t loop = ground_kind_loop(kind);
    const bool pair = ground_kind_is_pair(kind);
    const orb_reflection *reflection = ground->reflection;
    if (!(ground->penalty[vertex] < INFINITY) || boundary_loop_of(ground->boundary, vertex) != loop)
        return false;
    const int32_t image = reflection ? reflection->image[vertex] : vertex;
    *site = (orb_site){pair ? 2 : 1, {vertex, image}};
    if (image < 0 || (image != vertex) != pair)
        return false;
    return !pair || (ground->penalty[image] < INFINITY && boundary_loop_of(ground->boundary, image) == loop);
}

double ground_penalty(const orb_ground *ground, const orb_site *site) {
    double sum = 0;
    for (int32_t k = 0; k < site->n; k++)
        sum += ground->penalty[site->vertex[k]];
    return sum;
}
