/* Picked vertices -> cones and mirror corners of a signature. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_PICKS_H
#define ORB_PICKS_H

#include "boundary.h"
#include "signature.h"

/* Distinct vertices of the surface; else ORB_BAD_CONE. */
orb_status picks_check(const orb_mesh *mesh, int32_t n, const int32_t *vertex, orb_error *error);

/* order[n], mirror[n]: what each pick is. Picks on a loop are mirror corners unless the loop is filled[loop], all
 * others are cones. Without `given` the cones take the signature's orders in their sequence, and the corners likewise;
 * with it each pick has its own. Round each loop the orders must be those of one mirror, from any of its corners on,
 * either way round. Errors: ORB_CONE_COUNT, ORB_BAD_CONE (a corner inside, a cone on a mirror), ORB_BAD_ORDER. */
orb_status picks_match(const orb_signature *signature, const orb_boundary *boundary, const bool *filled, int32_t n,
                       const int32_t *vertex, const int32_t *given, int32_t *order, bool *mirror, orb_error *error);

/* For a fixed polygon: `count` vertices at equal distances along a loop; or whether the n picks follow one another
 * round it, and *clockwise: against its sequence. Errors: ORB_CONE_COUNT (too few vertices), ORB_BAD_CONE. */
orb_status picks_spread(const orb_mesh *mesh, const orb_boundary *boundary, int32_t loop, int32_t count,
                        int32_t *vertex, orb_error *error);
orb_status picks_follow(const orb_boundary *boundary, int32_t loop, int32_t n, const int32_t *picks, bool *clockwise,
                        orb_error *error);

#endif
