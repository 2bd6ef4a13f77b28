/* Surface + cones -> edges that cut it open to one disk. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_CUT_GRAPH_H
#define ORB_CUT_GRAPH_H

#include "mesh.h"

/* cut[n_edges] (overwritten): 1 on the boundary and on the edges of a graph that reaches all cones and whose
 * complement is an open disk; no vertex but a cone is a loose end of it. Tree and cotree (Eppstein 2003) with the
 * greedy loops of Erickson and Whittlesey 2005: arcs are shortest by edge length from the boundary, and on a closed
 * surface from a point, through which the loops are shortest, too: the first of one or two cones, else of a dozen points
 * all over the surface the one with the shortest graph.
 * Works on any surface in one piece, orientable or not. `parent` [n_triangles] (may be NULL): no edge between two
 * triangles with the same parent is cut. O(n log n). */
orb_status cut_graph_find(const orb_mesh *mesh, const int32_t *parent, int32_t n_cones, const int32_t *cones,
                          uint8_t *cut, orb_error *error);

#endif
