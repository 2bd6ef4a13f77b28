/* What is asked of the arrays before half-edges are built on them. SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh.h"

#include <math.h>
#include <stddef.h>

static orb_status check_arguments(const orb_mesh_arrays *arrays, orb_error *error) {
    if (!arrays)
        return error_set(error, ORB_BAD_ARGUMENT, "the mesh is a null pointer: hand over its arrays");
    if (arrays->n_vertices < 0 || arrays->n_triangles < 0)
        return error_set(error, ORB_BAD_ARGUMENT, "the mesh has %d vertices and %d triangles: no count may be negative",
                         (int)arrays->n_vertices, (int)arrays->n_triangles);
    if (arrays->n_triangles == 0)
        return error_set(error, ORB_BAD_ARGUMENT, "the mesh has no triangles: give its surface faces");
    if (!arrays->triangles || (!arrays->vertices && arrays->n_vertices > 0))
        return error_set(error, ORB_BAD_ARGUMENT, "the array of %s is a null pointer: hand over both arrays",
                         arrays->triangles ? "vertices" : "triangles");
    if (arrays->n_triangles > INT32_MAX / 3 || arrays->n_vertices > INT32_MAX / 3)
        return error_set(error, ORB_BAD_ARGUMENT,
                         "the mesh has %d vertices and %d triangles, of each at most %d can be counted: decimate it",
                         (int)arrays->n_vertices, (int)arrays->n_triangles, (int)(INT32_MAX / 3));
    return ORB_OK;
}

static orb_status check_coordinates(const orb_mesh_arrays *arrays, orb_error *error) {
    orb_found bad = {0};
    for (int32_t v = 0; v < arrays->n_vertices; v++) {
        const double *p = arrays->vertices + 3 * (size_t)v;
        if (!isfinite(p[0]) || !isfinite(p[1]) || !isfinite(p[2]))
            found_add(&bad, v);
    }
    if (bad.found == 0)
        return ORB_OK;
    return error_set_elements(error, ORB_NON_FINITE, ORB_VERTEX, bad.elements, bad.entries, bad.found,
                              "%lld %s a coordinate that is not a finite number, first %d: delete them, or undo the "
                              "modifier or shape key that made them",
                              (long long)bad.found, bad.found == 1 ? "vertex has" : "vertices have",
                              (int)bad.elements[0]);
}

static orb_status check_indices(const orb_mesh_arrays *arrays, orb_error *error) {
    orb_found outside = {0}, degenerate = {0};
    for (int32_t t = 0; t < arrays->n_triangles; t++) {
        const int32_t *corner = arrays->triangles + 3 * (size_t)t;
        bool inside = true;
        for (int c = 0; c < 3; c++)
            inside = inside && corner[c] >= 0 && corner[c] < arrays->n_vertices;
        if (!inside)
            found_add(&outside, t);
        if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0])
            found_add(&degenerate, t);
    }
    if (outside.found > 0) {
        const int32_t *corner = arrays->triangles + 3 * (size_t)outside.elements[0];
        return error_set_elements(
            error, ORB_INDEX_OUT_OF_RANGE, ORB_TRIANGLE, outside.elements, outside.entries, outside.found,
            "%lld %s a vertex that is not there, first %d with vertices %d, %d, %d: indices "
            "run from 0 to %d, so correct the triangle array",
            (long long)outside.found, outside.found == 1 ? "triangle names" : "triangles name",
            (int)outside.elements[0], (int)corner[0], (int)corner[1], (int)corner[2], (int)arrays->n_vertices - 1);
    }
    if (degenerate.found > 0) {
        const int32_t *corner = arrays->triangles + 3 * (size_t)degenerate.elements[0];
        return error_set_elements(
            error, ORB_DEGENERATE_TRIANGLE, ORB_TRIANGLE, degenerate.elements, degenerate.entries, degenerate.found,
            "%lld %s the same vertex twice, first %d with vertices %d, %d, %d: delete them "
            "(Mesh > Clean Up > Degenerate Dissolve)",
            (long long)degenerate.found, degenerate.found == 1 ? "triangle uses" : "triangles use",
            (int)degenerate.elements[0], (int)corner[0], (int)corner[1], (int)corner[2]);
    }
    return ORB_OK;
}

orb_status mesh_check_arrays(const orb_mesh_arrays *arrays, orb_error *error) {
    orb_status status = check_arguments(arrays, error);
    if (status == ORB_OK)
        status = check_coordinates(arrays, error);
    if (status == ORB_OK)
        status = check_indices(arrays, error);
    return status;
}
