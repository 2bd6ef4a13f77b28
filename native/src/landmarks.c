/* The sequence of landmarks for all meshes that have them. SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>

#include "orbifold_maps.h"
#include "picks.h"
#include "tour.h"

static orb_status shorten(const orb_mesh *mesh, int32_t n, const int32_t *landmarks, const int32_t *orders,
                          int32_t *sequence, orb_error *error) {
    int32_t *vertex = malloc(((size_t)n + 1) * sizeof *vertex), *order = calloc((size_t)n + 1, sizeof *order);
    int32_t *number = malloc(((size_t)mesh->n_vertices + 1) * sizeof *number);
    orb_status status = vertex && order && number ? ORB_OK : error_memory(error);
    for (int32_t k = 0; k < n && status == ORB_OK; k++) {
        vertex[k] = landmarks[k];
        order[k] = orders ? orders[k] : 0;
        number[landmarks[k]] = k;
    }
    if (status == ORB_OK)
        status = tour_shorten(mesh, n, vertex, order, error);
    for (int32_t k = 0; k < n && status == ORB_OK; k++)
        sequence[k] = number[vertex[k]];
    free(vertex);
    free(order);
    free(number);
    return status;
}

orb_status orb_landmark_sequence(const orb_mesh_arrays *arrays, int32_t n, const int32_t *landmarks,
                                 const int32_t *orders, int32_t *sequence, orb_error *error) {
    if (!arrays || n < 0 || (n > 0 && (!landmarks || !sequence)))
        return error_set(error, ORB_BAD_ARGUMENT, "orb_landmark_sequence needs a mesh, landmarks and room for them");
    orb_mesh *mesh = NULL;
    orb_status status = mesh_create(arrays, &mesh, error);
    if (status == ORB_OK)
        status = mesh_require_connected(mesh, error);
    if (status == ORB_OK)
        status = picks_check(mesh, n, landmarks, error);
    if (status == ORB_OK && n > 0)
        status = shorten(mesh, n, landmarks, orders, sequence, error);
    mesh_free(mesh);
    return status == ORB_OK ? error_set(error, ORB_OK, "%s", "") : status;
}
