/* Triangle arrays -> half-edges. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Half-edge 3 t + c runs from corner c to corner c + 1 (mod 3) of triangle t; so a triangle's corner and the
 * half-edge that leaves it have one number. */
#ifndef ORB_MESH_H
#define ORB_MESH_H

#include <stdbool.h>

#include "error.h"

typedef struct orb_mesh {
    int32_t n_vertices, n_triangles, n_edges;
    double *vertices;         /* [n_vertices*3] a copy of the input */
    int32_t *triangles;       /* [n_triangles*3] a copy of the input */
    int32_t *twin;            /* [n_triangles*3] the opposite half-edge; -1 on the boundary. On a surface that is not
                                  orientable, some of them run the same way */
    int32_t *edge;            /* [n_triangles*3] the edge that a half-edge lies on */
    int32_t *edge_halfedge;   /* [n_edges] one half-edge of each edge; edges are numbered in the order of their lower
                                  vertex, then their higher vertex */
    int32_t *vertex_halfedge; /* [n_vertices] a half-edge leaving the vertex (on a boundary: the one from which
                                  turning counter-clockwise meets the whole fan; where the surface is not orientable,
                                  one at an end of the fan); -1 if isolated */
    int32_t *origin;          /* [n_triangles] the triangle of the user's mesh that each lies in, -1 in a filled hole;
                                 NULL: they are the user's */
    int32_t n_used_vertices;  /* vertices that are not isolated */
    int32_t n_components;     /* of triangles joined by edges; isolated vertices do not count */
    int32_t n_boundary_loops;
    int32_t euler;   /* used vertices - edges + triangles */
    bool orientable; /* all components are */
    int32_t genus;   /* handles of the surface with its boundary loops closed, over all components; if it is not
                        orientable, cross-caps */
} orb_mesh;

static inline int32_t halfedge_next(int32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
static inline int32_t halfedge_previous(int32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }
/* A vertex's triangles are met by turning from one to the next around it. */
typedef struct orb_turn {
    int32_t corner; /* the triangle's corner at the vertex */
    bool clockwise; /* as seen in that triangle */
} orb_turn;

/* Triangles at fault, as the user's mesh has them, and vertices of those that are none of its own. */
typedef struct orb_blamed {
    orb_found triangles, filling;
} orb_blamed;
void mesh_blame(const orb_mesh *mesh, int32_t triangle, orb_blamed *blamed);

/* The status with `what` is wrong with so many triangles, of which the first is named: "3 triangles WHAT, first triangle 7"
 * and then `advice`. */
orb_status mesh_blame_error(orb_error *error, orb_status status, const orb_blamed *blamed, const char *one,
                            const char *many, const char *advice);

static inline int32_t halfedge_from(const orb_mesh *mesh, int32_t h) { return mesh->triangles[h]; }
static inline int32_t halfedge_to(const orb_mesh *mesh, int32_t h) { return mesh->triangles[halfedge_next(h)]; }

/* One that meets all of a used vertex's triangles: where it starts, and the boundary half-edges at both ends of the fan
 * of a vertex on the boundary. */
orb_turn mesh_turn_start(const orb_mesh *mesh, int32_t vertex);
void mesh_fan_ends(const orb_mesh *mesh, int32_t vertex, int32_t ends[2]);

/* From a boundary half-edge one of whose ends is *vertex to the next one along the boundary; *vertex becomes the end
 * that both share. */
int32_t mesh_follow_boundary(const orb_mesh *mesh, int32_t halfedge, int32_t *vertex);

/* Turns on to the next triangle; false (and *turn unchanged) at the boundary. */
bool mesh_turn(const orb_mesh *mesh, orb_turn *turn);

/* The part of mesh_create's checks that needs no half-edges: arguments and counts, finite coordinates (of isolated
 * vertices too), index range, triangles that use a vertex twice. */
orb_status mesh_check_arrays(const orb_mesh_arrays *arrays, orb_error *error);

/* Reads and checks the arrays: finite coordinates, indices, manifold edges and vertices, orientation. Components,
 * boundary and genus are counted, not judged. O(n). The first kind of defect is reported, in this order: those of
 * mesh_check_arrays, ORB_REPEATED_TRIANGLE (the repetitions are named, not the first one), ORB_NON_MANIFOLD_EDGE,
 * ORB_INCONSISTENT_ORIENTATION (of a surface that could be oriented), ORB_NON_MANIFOLD_VERTEX. On failure *mesh is
 * NULL and nothing is left allocated. */
orb_status mesh_create(const orb_mesh_arrays *arrays, orb_mesh **mesh, orb_error *error);
orb_status mesh_copy(const orb_mesh *mesh, orb_mesh **copy, orb_error *error);
void mesh_free(orb_mesh *mesh);

/* One component, else ORB_SEVERAL_COMPONENTS. */
orb_status mesh_require_connected(const orb_mesh *mesh, orb_error *error);

/* Turns triangles over, so that neighbours across edges that are not cut[n_edges] face the same way; the first triangle
 * of each part stays. The caller's cut makes that possible. Edges keep their numbers; O(n). */
orb_status mesh_orient(orb_mesh *mesh, const uint8_t *cut, orb_error *error);

/* On or off the boundary: on_boundary[n_vertices]. */
void mesh_find_boundary(const orb_mesh *mesh, bool *on_boundary);

double mesh_edge_length(const orb_mesh *mesh, int32_t halfedge);
double mesh_triangle_area(const orb_mesh *mesh, int32_t triangle);

#endif
