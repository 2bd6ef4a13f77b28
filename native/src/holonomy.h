/* Cut disk + side pairings -> the copies of the input mesh's vertices. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Every triangle corner of the input mesh gets a group element: where that corner lies when the triangle is laid
 * out in one piece. For a disk cut along the mesh's own edges this is the disk itself; for a refined disk the
 * pieces of a triangle are joined across the cut. Everything after this file knows copies only, not the cut. */
#ifndef ORB_HOLONOMY_H
#define ORB_HOLONOMY_H

#include "disk.h"
#include "tile.h"

typedef struct orb_copies {
    int32_t n_copies;
    int32_t *vertex;    /* [n_copies]; copy v < n_vertices is vertex v itself (isometry 0) */
    int32_t *isometry;  /* [n_copies] the copy lies at isometries[isometry[u]] applied to its vertex */
    int32_t *triangles; /* [n_triangles*3] in copies */
    int32_t n_isometries;
    orb_isometry *isometries; /* isometries[0] is the identity */
} orb_copies;

/* The group element at which a copy of the disk lies. */
orb_isometry holonomy_element(const orb_tile *tile, orb_copy_place place);

orb_status holonomy_create(const orb_mesh *mesh, const orb_disk *disk, const orb_tile *tile, orb_copies **copies,
                           orb_error *error);
void holonomy_free(orb_copies *copies);

#endif
