/* One positive weight per edge of a mesh. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_WEIGHTS_H
#define ORB_WEIGHTS_H

#include "mesh.h"

/* The sum over an edge's triangles of half the cotangent opposite, where the triangle has an area, and the number of
 * those that have none. */
typedef struct orb_cotangents {
    double *sum;     /* [n_edges] */
    uint8_t *n_flat; /* [n_edges] */
} orb_cotangents;

orb_status cotangents_measure(const orb_mesh *mesh, orb_cotangents *cotangents, orb_error *error);
void cotangents_clear(orb_cotangents *cotangents);

/* Fills weights[mesh->n_edges] as the request asks: cotangent (cot a + cot b) / 2 with anything below `clamp`
 * raised to it once per edge (*n_clamped counts these; may be NULL), mean-value symmetrised (unit 1 / length), uniform,
 * or the rows given (which must name every edge once, in either direction). Kinds that live on other edges, or are not
 * symmetric, have a stand-in here, which serves to start from: cotangents, and symmetrised mean values.
 * Zero-area triangles (an area that rounding alone could have made): their cotangents are infinite or undefined;
 * such an edge gets the clamp from that triangle (counted) so that the weights stay finite. Mean-value weights have
 * no such stand-in. Where a weight is not finite and positive all the same: ORB_ZERO_AREA_TRIANGLE, naming the
 * triangles. `known`: this mesh's cotangents, or NULL. Other errors: ORB_BAD_ARGUMENT (kind, clamp, null rows),
 * ORB_BAD_WEIGHT, ORB_OUT_OF_MEMORY. */
orb_status weights_compute(const orb_mesh *mesh, const orb_request *request, const orb_cotangents *known,
                           double *weights, int64_t *n_clamped, orb_error *error);

/* Mean-value weights as they stand, not symmetric: weights[mesh->n_edges*2], for each edge the weight at the vertex
 * that edge_halfedge leaves, then that at the other one. Errors: ORB_ZERO_AREA_TRIANGLE, as above. */
orb_status weights_mean_value_both(const orb_mesh *mesh, double *weights, orb_error *error);

#endif
