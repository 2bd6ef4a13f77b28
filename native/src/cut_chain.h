/* A surface without handles, with borders -> edges of a path that cuts it open to one disk.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_CUT_CHAIN_H
#define ORB_CUT_CHAIN_H

#include "disk.h"

/* Overwrites cut[n_edges]: 1 on the boundary and on the edges of a path, which is the same for all meshes of an
 * orbifold but for the way it takes: from the mirror of the first corner that was picked through the cones in turn to
 * the other mirrors, those with corners in the sequence of these, then the nearest. It meets a mirror within the side
 * that follows its first corner, where that is nearest, and leaves it on the same side further on. Where a side has no
 * vertex that is free, another one will do, and other meshes may have other words. *start: the half-edge along the
 * boundary that leaves the path's first vertex. The mesh is oriented, with boundary and no handles; `parent` as in
 * cut_graph.h. ORB_CUT_BLOCKED names the cone, or a vertex of the mirror, that no path along edges reaches. O(k n log
 * n). */
orb_status cut_chain_find(const orb_mesh *mesh, const int32_t *parent, const orb_marks *marks, uint8_t *cut,
                          int32_t *start, orb_error *error);

#endif
