/* A short walk through cones. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_TOUR_H
#define ORB_TOUR_H

#include "mesh.h"

/* Permutes vertex[n] among those of equal order[n], so that the walk from the first to the last along shortest edge paths is
 * short: the nearest next one, then exchanges and reversals while they gain. O(n) searches of the mesh. Error:
 * ORB_OUT_OF_MEMORY. */
orb_status tour_shorten(const orb_mesh *mesh, int32_t n, int32_t *vertex, const int32_t *order, orb_error *error);

#endif
