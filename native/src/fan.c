/* The triangles around a vertex. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Gives mesh_turn and its kin (mesh.h), which need no orientation. */
#include "mesh.h"

orb_turn mesh_turn_start(const orb_mesh *mesh, int32_t vertex) {
    int32_t h = mesh->vertex_halfedge[vertex];
    return (orb_turn){h, mesh->twin[h] >= 0 && mesh->twin[halfedge_previous(h)] < 0};
}

void mesh_fan_ends(const orb_mesh *mesh, int32_t vertex, int32_t ends[2]) {
    orb_turn turn = mesh_turn_start(mesh, vertex);
    ends[0] = turn.clockwise ? halfedge_previous(turn.corner) : turn.corner;
    while (mesh_turn(mesh, &turn))
        ;
    ends[1] = turn.clockwise ? turn.corner : halfedge_previous(turn.corner);
}

bool mesh_turn(const orb_mesh *mesh, orb_turn *turn) {
    int32_t crossed = turn->clockwise ? turn->corner : halfedge_previous(turn->corner), g = mesh->twin[crossed];
    if (g < 0)
        return false;
    bool leaves = halfedge_from(mesh, g) == halfedge_from(mesh, turn->corner); /* the vertex is where g starts */
    turn->corner = leaves ? g : halfedge_next(g);
    turn->clockwise = !leaves;
    return true;
}

int32_t mesh_follow_boundary(const orb_mesh *mesh, int32_t halfedge, int32_t *vertex) {
    int32_t ends[2];
    *vertex = halfedge_from(mesh, halfedge) == *vertex ? halfedge_to(mesh, halfedge) : halfedge_from(mesh, halfedge);
    mesh_fan_ends(mesh, *vertex, ends);
    return ends[0] == halfedge ? ends[1] : ends[0];
}
