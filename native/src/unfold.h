/* Triangles of a UV map, and what lies across their edges, seams too. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_UNFOLD_H
#define ORB_UNFOLD_H

#include "orbifold.h"

/* z -> a z + b, or a conj(z) + b, of the plane of (u, v). */
typedef struct orb_similarity {
    double a[2], b[2];
    bool turned_over;
} orb_similarity;

typedef struct orb_unfold {
    int32_t n_triangles;
    const double *uv; /* [n_triangles][3][2] */
    int32_t *across;  /* [3 * n_triangles] the corner, of all, with which the edge that begins at a corner begins on its
                         other side; -1: on a border */
    bool *reversed;   /* [3 * n_triangles] seen from there, it runs the other way, as it does between triangles that are
                         oriented alike */
} orb_unfold;

/* `triangles` [3*n_triangles]: vertices of the mesh. Edges of more than two triangles count as borders. unfold_clear in
 * any case. Error: ORB_OUT_OF_MEMORY. */
orb_status unfold_create(int32_t n_triangles, const int32_t *triangles, const double *uv, orb_unfold *unfold,
                         orb_error *error);
void unfold_clear(orb_unfold *unfold);

/* A triangle, laid out by a similarity of its UVs. */
typedef struct orb_laid {
    int32_t triangle;
    orb_similarity by;
} orb_laid;

/* From where a triangle is laid out to the triangle in which a point (u, v) lies, across edges that share both ends, each
 * laid against the one before: *at is where it is in that triangle's own UVs. At a border, at triangles without area, and
 * after many steps the walk ends: at the point of the last triangle that is next to it. */
void unfold_walk(const orb_unfold *unfold, const double point[2], orb_laid *laid, double at[2]);

#endif
