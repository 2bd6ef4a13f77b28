/* Angles, areas and cotangents of all triangles from the lengths of edges. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_SHAPE_H
#define ORB_SHAPE_H

#include "mesh.h"

typedef struct orb_shape {
    double *triangle_area; /* [n_triangles] as a part of the whole */
    double *area;          /* [n_vertices] a third of the triangles around, as a part of the whole */
    double *angle;         /* [n_vertices] around each vertex */
    double *cotangent;     /* [n_triangles*3] of the angle that a half-edge faces */
    int32_t n_flat;        /* triangles whose lengths break the triangle inequality, or make no area */
} orb_shape;

/* Lengths of the mesh's edges, times a power of two that brings the longest into [1, 2). */
void shape_lengths(const orb_mesh *mesh, double *lengths /* [n_edges] */);

/* Returns false when out of memory; shape_clear in any case. */
bool shape_allocate(orb_shape *shape, const orb_mesh *mesh);
void shape_clear(orb_shape *shape);

/* Where the lengths make no triangle, the angles are those that it had when it became flat, pi, 0 and 0 (which keeps
 * Newton's problem convex: Springborn, Schroeder and Pinkall 2008, section 3.1), and the rest is of the shape that
 * `original` [n_edges] says, or, where that is none, an equilateral one's. */
void shape_measure(const orb_mesh *mesh, const double *lengths, const double *original, orb_shape *shape);

/* What a flat surface has around each vertex, angles[n_vertices]: 2 pi, on a boundary pi. False: out of memory. */
bool shape_flat_angles(const orb_mesh *mesh, double *angles);

#endif
