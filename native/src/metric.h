/* The conformal metric of a mesh with the curvature of its orbifold. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A vertex's log scale u turns the length of an edge into l exp((u_i + u_j) / 2). Wanted are constant curvature, as
 * much as Gauss and Bonnet say (2 pi chi in all), and a given angle around every vertex: 2 pi, 2 pi / n at a cone, pi
 * on a mirror, pi / n at a mirror's corner (docs/mathematics.md, section 9). On a boundary nothing else has to
 * be said: that is the metric of the mesh doubled along it. */
#ifndef ORB_METRIC_H
#define ORB_METRIC_H

#include "mesh.h"

typedef struct orb_metric {
    double *scale;      /* [n_vertices] u; 0 for isolated vertices */
    double *lengths;    /* [n_edges] scaled */
    double residual[2]; /* of the angles: square root of the sum of squares, at first and in the end */
    int32_t steps;      /* that were taken */
    int32_t n_unscaled; /* triangles whose scaled lengths break the triangle inequality */
} orb_metric;

/* angles[n_vertices]: wanted around each vertex. euler: the orbifold's Euler characteristic chi, exactly 0 if it is
 * flat; it must be sum(angles) / (2 pi) - n_triangles / 2 up to rounding. One Poisson solve, then at most
 * `newton_steps` steps of Newton's method; a step that makes the residual larger is halved, and where that does not
 * help, the metric stays as it is by then. Triangles that break the triangle inequality, or have no area on the mesh,
 * keep their shape (an equilateral one in the second case). `lengths` [n_edges] are those of the mesh. Error:
 * ORB_OUT_OF_MEMORY; the linear solver's. */
orb_status metric_create(const orb_mesh *mesh, const double *lengths, const double *angles, double euler,
                         int32_t newton_steps, orb_metric **metric, orb_error *error);
void metric_free(orb_metric *metric);

#endif
