/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "polygon.h"

#include <math.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;
static const double off_model = 1e-6; /* how far a corner may be from its model, relative to its size squared */

static orb_status refuse(orb_error *error, int32_t corner, const char *why) {
    return error_set(error, ORB_BAD_ARGUMENT, "corner %d of the polygon %s", (int)corner, why);
}

/* Circumradius of the regular polygon when none is asked for: unit area in the plane, 1 in the hyperbolic plane, 60
 * degrees on the sphere. */
static double default_radius(int curvature, int32_t n) {
    if (curvature == 0)
        return sqrt(2 / (n * sin(2 * pi / n)));
    return curvature < 0 ? 1 : pi / 3;
}

static orb_status place_regular(const orb_polygon *polygon, orb_point *corners, orb_error *error) {
    int32_t n = polygon->n_corners;
    double radius = polygon->radius;
    if (!(radius >= 0) || !isfinite(radius) || (polygon->curvature > 0 && !(radius < pi / 2)))
        return error_set(error, ORB_BAD_ARGUMENT, "the polygon's radius is %g: make it positive%s, or 0 for the default",
                         radius, polygon->curvature > 0 ? " and less than pi / 2" : "");
    if (radius == 0)
        radius = default_radius(polygon->curvature, n);
    const orb_geometry *geometry = geometry_of_curvature(polygon->curvature);
    for (int32_t i = 0; i < n; i++) {
        double direction = -pi / 2 + (2 * i + 1) * pi / n;
        corners[i] = geometry_exp(geometry, point_of(0), radius * CMPLX(cos(direction), sin(direction)));
    }
    return ORB_OK;
}

static orb_status place_given(const orb_polygon *polygon, orb_point *corners, orb_error *error) {
    for (int32_t i = 0; i < polygon->n_corners; i++) {
        const double *x = polygon->corners + 3 * (size_t)i;
        double K = polygon->curvature, size = x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
        double off = K == 0 ? x[2] - 1 : x[0] * x[0] + x[1] * x[1] + K * x[2] * x[2] - K;
        if (!(fabs(off) < off_model * (1 + size)) || (K < 0 && !(x[2] > 0)))
            return refuse(error, i, "is not a point of the geometry's model: give (x, y, 1), a unit vector, or "
                                    "x x + y y - z z = -1 with z > 0");
        if (K > 0 && !(x[2] > 0))
            return refuse(error, i, "is not in the upper hemisphere: turn or shrink the polygon");
        corners[i] = point_of(K == 0 ? CMPLX(x[0], x[1]) / 2 : CMPLX(x[0], x[1]) / (1 + x[2]));
    }
    return ORB_OK;
}

static bool turns_left(const orb_geometry *geometry, orb_point p, orb_point q, orb_point r) {
    double complex s = geometry_toward(geometry, p, q), t = geometry_toward(geometry, p, r);
    return cimag(conj(s) * t) > 1e-12 * cabs(s) * cabs(t);
}

static orb_status require_convex(int curvature, int32_t n, const orb_point *corners, orb_error *error) {
    const orb_geometry *geometry = geometry_of_curvature(curvature);
    for (int32_t i = 0; i < n; i++) {
        orb_point p = corners[i], q = corners[(i + 1) % n];
        for (int32_t k = 2; k < n; k++)
            if (!turns_left(geometry, p, q, corners[(i + k) % n]))
                return refuse(error, (i + k) % n,
                              "is not to the left of every side: give a strictly convex polygon, counter-clockwise");
        if (curvature > 0 && !turns_left(geometry, p, q, point_of(0)))
            return refuse(error, i, "starts a side that does not have (0, 0, 1) on its left: turn the polygon so that "
                                    "this point is inside");
    }
    return ORB_OK;
}

orb_status polygon_create(const orb_polygon *polygon, orb_tile **tile, orb_error *error) {
    *tile = NULL;
    if (polygon->curvature < -1 || polygon->curvature > 1)
        return error_set(error, ORB_BAD_ARGUMENT, "the polygon's curvature is %d: choose 1, 0 or -1",
                         (int)polygon->curvature);
    orb_point *corners = malloc((size_t)polygon->n_corners * sizeof *corners);
    if (!corners)
        return error_memory(error);
    orb_status status = (polygon->corners ? place_given : place_regular)(polygon, corners, error);
    if (status == ORB_OK)
        status = require_convex(polygon->curvature, polygon->n_corners, corners, error);
    if (status == ORB_OK)
        status = tile_of_polygon(polygon->curvature, polygon->n_corners, corners, tile, error);
    free(corners);
    return status;
}
