/* The ring of triangles around one vertex of a map onto the sphere. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_RING_H
#define ORB_RING_H

#include "mesh.h"

/* Room for the rings of one mesh. */
typedef struct orb_ring orb_ring;

orb_status ring_create(const orb_mesh *mesh, orb_ring **ring, orb_error *error);
void ring_free(orb_ring *ring);

/* Moves a vertex of positions[n_vertices*3] to the point that is farthest from the lines through the edges of its ring,
 * on their left: a linear programme in the plane of the gnomonic projection (Freitag and Plassmann 2000). The point is
 * inside the ring's kernel, if there is one; if there is none, it is the one least outside. False: the vertex is as
 * good as there. Triangles that are positively oriented all around a vertex remain so. */
bool ring_centre(orb_ring *ring, double *positions, int32_t vertex);

/* The half-edge after h counter-clockwise around the vertex that both leave (closed meshes). */
static inline int32_t ring_next(const orb_mesh *mesh, int32_t h) { return mesh->twin[halfedge_previous(h)]; }

#endif
