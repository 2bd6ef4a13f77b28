/* Mesh + cut edges -> the disk that is left, and its boundary word. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_DISK_H
#define ORB_DISK_H

#include "mesh.h"
#include "word.h"

/* Where a copy lies: at an element of the group applied to its vertex. */
typedef enum orb_place {
    PLACE_SELF,   /* the identity */
    PLACE_SIDE,   /* the pairing of side `index` of the tile: this copy is on that side's partner */
    PLACE_CORNER, /* the element of corner `index` of the tile */
} orb_place;

typedef struct orb_copy_place {
    orb_place kind;
    int32_t index;
} orb_copy_place;

typedef struct orb_disk {
    const orb_mesh *mesh;  /* the mesh that was cut; its first vertices are the input's */
    orb_mesh *refined;     /* the same, when it is not the input mesh (owned); else NULL */
    int32_t *refined_from; /* [mesh->n_triangles] the input triangle that each lies in; NULL unless refined */
    orb_word *word;
    int32_t n_copies;
    int32_t *copy_vertex;  /* [n_copies]; copy v < mesh->n_vertices is vertex v itself */
    orb_copy_place *place; /* [n_copies] */
    int32_t *triangles;    /* [mesh->n_triangles*3] in copies */
    int32_t n_boundary;    /* of the disk's boundary loop */
    int32_t *boundary;     /* [n_boundary] copies, counter-clockwise from corner 0 */
    int32_t *corner_at;    /* [word->n_sides] where in `boundary` the corners are, ascending from 0 */
    int32_t *side;         /* [mesh->n_triangles*3] the side that a half-edge lies on; -1 inside */
} orb_disk;

/* Vertices with a role: cones inside, mirror corners on the boundary. */
typedef struct orb_marks {
    int32_t n;
    const int32_t *vertex, *order; /* [n] distinct vertices, orders >= 2 */
} orb_marks;

/* cut[n_edges]: as cut_graph_find leaves it, the boundary included. The mesh must be oriented alike wherever it is not
 * cut (mesh_orient). The corners are the marked vertices and the vertices where the graph branches or ends. `start`: a
 * half-edge of the disk's boundary that leaves corner 0, or -1: the first there is. Error: ORB_CUT_BLOCKED if what is
 * left is not a disk or has no corner. O(n). */
orb_status disk_create(const orb_mesh *mesh, const uint8_t *cut, int32_t start, const orb_marks *marks,
                       orb_disk **disk, orb_error *error);
void disk_free(orb_disk *disk);

#endif
