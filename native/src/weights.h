/* One positive weight per edge of a mesh. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_WEIGHTS_H
#define ORB_WEIGHTS_H

#include "mesh.h"

/* Fills weights[mesh->n_edges] as the request asks: cotangent (cot a + cot b) / 2 with anything below `clamp`
 * raised to it once per edge (*n_clamped counts these; may be NULL), mean-value symmetrised, uniform, or the rows
 * given (which must name every edge once). Zero-area triangles: their cotangents are infinite or undefined; such an
 * edge gets the clamp from that triangle (counted) so that the weights stay finite; if a weight is not finite and
 * positive all the same: ORB_ZERO_AREA_TRIANGLE, naming the triangles. */
orb_status weights_compute(const orb_mesh *mesh, const orb_request *request, double *weights, int64_t *n_clamped,
                           orb_error *error);

#endif
