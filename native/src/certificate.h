/* Proof that a result is a bijection onto its orbifold. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * docs/mathematics.md, section 5: positive triangles, equal lengths across every seam, the orbifold's angle around
 * every vertex, the orbifold's area. It looks at the positions of the copies alone, not at how they were found. */
#ifndef ORB_CERTIFICATE_H
#define ORB_CERTIFICATE_H

#include "embedding.h"

/* Fills flipped, seam_residual, angle_residual and area_residual of embedding->report and decides. Error:
 * ORB_CERTIFICATE_FAILED, naming triangles or vertices; ORB_ZERO_AREA_TRIANGLE when all of the flipped triangles have
 * no area on the mesh. */
orb_status certificate_check(orb_embedding *embedding, orb_error *error);

/* Which triangles are not positively oriented, flipped[mesh->n_triangles]; returns how many. */
int64_t certificate_find_flipped(const orb_embedding *embedding, bool *flipped);

/* The corner of a geodesic triangle whose edges are most nearly orthogonal, or one that is good enough, and the sine of
 * its angle. The triangle's orientation, its sign, has the least rounding error there. */
int certificate_corner(const orb_geometry *geometry, const orb_point corners[3], double *sine);

#endif
