/* Tile + cut disk -> where the minimiser starts. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Tutte's embedding of the disk: its boundary goes to the tile's, by arc length, and the interior follows with the
 * given weights in the chart in which the tile is convex (orthographic for the sphere, Klein for the hyperbolic
 * plane: 2017, section 4.2; 2016, section 5). */
#ifndef ORB_INITIAL_H
#define ORB_INITIAL_H

#include "holonomy.h"

/* The boundary alone, all else at the origin: enough where the energy is quadratic. */
orb_status initial_boundary(const orb_disk *disk, const orb_tile *tile, orb_point *position /* [disk vertices] */,
                            orb_error *error);

/* weights[disk->mesh->n_edges] > 0. `vertex_order` [n_order]: a fill-reducing ordering of (at least) the disk's inner
 * vertices; NULL: one is computed. */
orb_status initial_embed(const orb_disk *disk, const orb_tile *tile, const double *weights, const int32_t *vertex_order,
                         int32_t n_order, orb_point *position, orb_error *error);

#endif
