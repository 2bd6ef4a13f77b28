/* What all embeddings of one mesh have in common. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * When only cones, orders or the signature change, the half-edges, the cotangents, the pattern of the Hessian, its
 * ordering and its symbolic factor stay. Nothing in here changes once it is made, so that threads may share it. */
#ifndef ORB_PREPARED_H
#define ORB_PREPARED_H

#include <stdatomic.h>

#include "cholesky.h"
#include "mesh.h"
#include "weights.h"

struct orb_prepared {
    atomic_int holders;
    orb_mesh *mesh;
    orb_cotangents cotangents;
    orb_pattern blocks; /* of the complex Hessian with a row for each vertex that is not isolated */
    int64_t *slot;      /* [mesh->n_edges] of each edge's entry in it */
    int32_t *order;     /* [mesh->n_used_vertices] vertices, fill-reducing */
    orb_cholesky *analysis;
};

/* One more holder; orb_prepared_free is how each lets go. */
orb_prepared *prepared_hold(const orb_prepared *prepared);

#endif
