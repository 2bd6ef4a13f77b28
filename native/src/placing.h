/* One mesh, many signatures: the cones of all of them, and what they cost. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * ground -> options -> assignment -> descent -> prediction, in step for all plans, so that they share one factorisation and
 * the columns of the form. */
#ifndef ORB_PLACING_H
#define ORB_PLACING_H

#include "orbifold_cones.h"
#include "plan.h"

/* The plans' signatures have n_mirrors mirrors, holes that become mirrors included; all other boundary loops are filled.
 * Sets placed, symmetric, cones, conformal and predicted of each plan. *has_plane becomes true, and plane is filled in, where
 * sites are symmetric. The request's fixed vertices have been checked. Errors: ground_create's, reflection_find's;
 * ORB_CANCELLED, ORB_OUT_OF_MEMORY, ORB_LINEAR_SOLVER. */
orb_status placing_run(const orb_mesh *input, const orb_suggest_request *request, int32_t n_mirrors, int32_t n,
                       orb_plan **plans, orb_monitor *monitor, double plane[4], bool *has_plane, orb_error *error);

#endif
