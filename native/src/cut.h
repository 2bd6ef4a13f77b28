/* Mesh + cones and corners -> a disk. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_CUT_H
#define ORB_CUT_H

#include "disk.h"

/* A sphere-like mesh cut open along the path c_1 -> ... -> c_k, k >= 2. The disk's boundary starts in c_1 and runs
 * along the path's left bank to c_k, then along the right bank back. Paths are shortest by edge length (Dijkstra) and
 * avoid one another and the other cones. Where a path is blocked the mesh is refined along it, so that there always is
 * one; ORB_CUT_BLOCKED names two cones whose path winds so much that this would more than double the mesh (and add
 * more than 50,000 vertices). The refinement serves to say which way round the cones the cut runs and to start the
 * minimiser, and never reaches the result (holonomy.h). No edge of disk->mesh joins two vertices of one segment that
 * do not follow one another. If k is 2 and the cones are adjacent, the boundary is c_1, c_2, and triangles on both
 * sides of the edge have the same copies. */
orb_status cut_path(const orb_mesh *mesh, const orb_marks *cones, orb_disk **disk, orb_error *error);

/* Any surface in one piece cut open along a graph (cut_graph.h). A mesh that is not orientable is turned over,
 * triangle by triangle, so that the disk is oriented. `parent` [n_triangles]: see cut_graph_find; may be NULL.
 * `first`: a mark on the boundary of an orientable mesh that becomes corner 0; -1: any. */
orb_status cut_surface(orb_mesh *mesh, const int32_t *parent, const orb_marks *marks, int32_t first, orb_disk **disk,
                       orb_error *error);

/* The cut that a signature's orbifold gets; NULL: a polygon's disk, whose first mark becomes corner 0. A sphere with
 * cones is cut along the path in which they were picked, every other surface along a graph; and as a tile of the
 * hyperbolic plane may be any polygon with the right angles, a sphere with many cones there, too (docs/decisions.md).
 * Where `cut` asks for a path there is no graph but with handles or cross-caps (cut_chain.h). `parent`: as in
 * cut_surface. */
orb_status cut_open(orb_mesh *mesh, const orb_signature *signature, orb_cut cut, const int32_t *parent,
                    const orb_marks *marks, orb_disk **disk, orb_error *error);

#endif
