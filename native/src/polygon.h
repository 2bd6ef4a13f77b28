/* A request's polygon -> a fixed tile. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_POLYGON_H
#define ORB_POLYGON_H

#include "tile.h"

/* The corners as asked, or regular about the model's centre, one of them straight down's right neighbour. Error:
 * ORB_BAD_ARGUMENT where the polygon is not strictly convex and counter-clockwise, a corner is not on its model, or, on
 * the sphere, the polygon does not lie in the upper hemisphere with (0, 0, 1) inside. */
orb_status polygon_create(const orb_polygon *polygon, orb_tile **tile, orb_error *error);

#endif
