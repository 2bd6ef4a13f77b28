/* What given cones cost. SPDX-License-Identifier: GPL-3.0-or-later */
#include "orbifold_cones.h"

#include <stdlib.h>
#include <string.h>

#include "monitor.h"
#include "spread.h"
#include "surface.h"

static const double pi = 3.14159265358979323846;

/* The picks may be in another sequence than the signature's. */
static orb_charges charges_of(const orb_surface *surface, double *charge) {
    orb_charges charges = spread_charges(surface->signature, surface->vertex, charge);
    for (int32_t k = 0; k < surface->n_marks; k++)
        charge[k] = (surface->mirror[k] ? 1 : 2) * pi * (1 - 1.0 / surface->order[k]);
    return charges;
}

/* u of the surface's own cones and corners, scale[surface->plain->n_vertices]. */
static orb_status find_scale(const orb_surface *surface, orb_monitor *monitor, double *scale, double *spread,
                             orb_error *error) {
    orb_spread *form = NULL;
    double *charge = malloc(((size_t)surface->n_marks + 1) * sizeof *charge);
    orb_status status = charge ? monitor_report(monitor, "factor", 0.3, error) : error_memory(error);
    if (status == ORB_OK)
        status = spread_create(surface->plain, &form, error);
    if (status == ORB_OK)
        status = monitor_report(monitor, "solve", 0.7, error);
    if (status == ORB_OK) {
        const orb_charges charges = charges_of(surface, charge);
        status = spread_scales(form, 1, &charges, &scale, error);
    }
    if (status == ORB_OK && spread)
        *spread = spread_deviation(form, scale);
    spread_free(form);
    free(charge);
    return status;
}

orb_status orb_predict(const orb_mesh_arrays *mesh, const orb_request *request, double *spread, double *scale,
                       orb_error *error) {
    if (!mesh || !request || request->n_cones < 0 || (request->n_cones > 0 && !request->cones) || request->polygon)
        return error_set(error, ORB_BAD_ARGUMENT, "orb_predict needs a mesh, a request with a signature and its cones");
    orb_surface *surface = NULL;
    double *found = NULL;
    orb_monitor monitor = {request->progress, request->user, 0};
    orb_status status = monitor_report(&monitor, "topology", 0, error);
    if (status == ORB_OK)
        status = surface_create(mesh, request, NULL, &surface, error);
    if (status == ORB_OK) {
        found = malloc(((size_t)surface->plain->n_vertices + 1) * sizeof *found);
        status = found ? find_scale(surface, &monitor, found, spread, error) : error_memory(error);
    }
    if (status == ORB_OK && scale)
        memcpy(scale, found, (size_t)mesh->n_vertices * sizeof *scale);
    if (status == ORB_OK)
        error_set(error, ORB_OK, "%s", "");
    surface_free(surface);
    free(found);
    return status;
}
