/* Sphere-like mesh + cones -> a disk, cut open along the path c_1 -> ... -> c_k.
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The disk lives on the input mesh, or, where its edges leave no room for the paths (a coarse mesh), on a mesh
 * refined along them; the refinement serves to say which way round the cones the cut runs and to start the
 * minimiser, and never reaches the result (holonomy.h). */
#ifndef ORB_CUT_H
#define ORB_CUT_H

#include "mesh.h"

typedef struct orb_disk {
    const orb_mesh *mesh;  /* the mesh that was cut; its first vertices are the input's */
    orb_mesh *refined;     /* the same, when it is not the input mesh (owned); else NULL */
    int32_t *refined_from; /* [mesh->n_triangles] the input triangle that each lies in; NULL unless refined */
    int32_t n_copies;
    int32_t *copy_vertex;  /* [n_copies]; copy v < mesh->n_vertices is vertex v itself, on the left bank if cut */
    int32_t *copy_pairing; /* [n_copies] 0, or s: this copy lies at pairing s of the tile applied to its vertex */
    int32_t *triangles;    /* [mesh->n_triangles*3] in copies */
    int32_t n_boundary;    /* of the disk's boundary loop */
    int32_t *boundary;     /* [n_boundary] copies, counter-clockwise from c_1: left bank to c_k, right bank back */
    int32_t *corner_at;    /* [2*n_cones - 2] where in `boundary` the tile's corners are, ascending from 0 */
} orb_disk;

/* Paths are shortest by edge length (Dijkstra) and avoid one another and the other cones. `cones` [n_cones >= 2] are
 * distinct used vertices of a sphere-like mesh; else ORB_BAD_CONE, or what mesh_require_sphere says. Where a path is
 * blocked the mesh is refined along it, so that there always is one; ORB_CUT_BLOCKED names two cones whose path winds
 * so much that this would more than double the mesh (and add more than 50,000 vertices). No edge of disk->mesh joins
 * two vertices of one segment that do not follow one another. If n_cones is 2 and the cones are adjacent, the boundary
 * is c_1, c_2, and triangles on both sides of the edge have the same copies. */
orb_status cut_create(const orb_mesh *mesh, int32_t n_cones, const int32_t *cones, orb_disk **disk, orb_error *error);
void cut_free(orb_disk *disk);

#endif
