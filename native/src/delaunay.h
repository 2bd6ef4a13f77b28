/* Intrinsic Delaunay triangulations. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A triangulation of a surface of flat triangles, by edge lengths alone (Bobenko and Springborn 2007; Fisher,
 * Springborn, Schroeder and Bobenko 2007). Edges may join a vertex to itself, and two vertices several times, so
 * nothing is keyed by pairs of vertices. Every triangle corner carries a copy of its vertex (holonomy.h), that is
 * where the corner lies when the triangle is laid out in one piece: where the two sides of an edge show different
 * copies, the neighbour is brought into this triangle's frame before the edge is flipped. So the result is a list of
 * edges between copies, which is all that problem.h needs. */
#ifndef ORB_DELAUNAY_H
#define ORB_DELAUNAY_H

#include "holonomy.h"
#include "mesh.h"

typedef struct orb_delaunay {
    int32_t n_triangles, n_edges;
    int32_t *corners; /* [n_triangles*3] copies */
    int32_t *edges;   /* [n_triangles*3] the edge that a half-edge lies on */
    int32_t *sides;   /* [n_edges*2] the half-edges of an edge; the second one is -1 on the boundary */
    bool *alike;      /* [n_edges] whether these run the same way (where a non-orientable surface closes up) */
    double *lengths;  /* [n_edges] */
    bool *flipped;    /* [n_edges] no longer the input's edge */
    int32_t *across;  /* [n_edges] of an edge on a mirror that faces an obtuse angle: the mirror image of the corner
                         there, to which that corner is joined instead; else -1 */
    int64_t n_flips;
    orb_copies *copies; /* the input's copies first, then those that were added; without triangles */
} orb_delaunay;

/* The mirrors on which vertices slide. */
typedef struct orb_mirrors {
    const int32_t *of; /* [n_vertices] the mirror that the vertex's own copy lies on; -1: none, or several */
    const orb_isometry *reflections; /* by mirror */
} orb_mirrors;

/* The triangulation that the mesh has, with its copies and lengths[n_edges] (longest around 1), flipped until it is
 * Delaunay but for edges marked in keep[n_edges] (may be NULL), edges on the boundary that is no mirror, edges whose
 * two ends are both `special` [n_vertices] and whose two triangles lie in different frames, and those whose flip
 * would leave a vertex that is not special with fewer than three edges. Special is a vertex that some element of the
 * group fixes: a cone, or a vertex on a mirror. Lengths that break the triangle inequality are tolerated: there an
 * edge is flipped as in Ptolemy's theorem. An edge on a mirror is, in the surface doubled there, flipped to one
 * between a vertex and its mirror image; that comes last, and no flip follows it. `mirrors` may be NULL. `copies` are
 * only read. Error: ORB_OUT_OF_MEMORY. */
orb_status delaunay_create(const orb_mesh *mesh, const orb_geometry *geometry, const orb_copies *copies,
                           const double *lengths, const uint8_t *keep, const bool *special, const orb_mirrors *mirrors,
                           orb_delaunay **delaunay, orb_error *error);
void delaunay_free(orb_delaunay *delaunay);

/* Cotangent weights: weights[n_edges] half the sum of the cotangents that face an edge, raised to `clamp` once per edge
 * (*n_clamped counts these), and the edges' ends, ends[n_edges*2], in copies. A triangle that breaks the triangle
 * inequality or has no area takes the cotangents of `original` lengths [n_edges] if it is one of the input's, and
 * else, or if these do not do either, gives its edges the clamp. */
void delaunay_weights(const orb_delaunay *delaunay, const double *original, double clamp, int32_t *ends,
                      double *weights, int64_t *n_clamped);

#endif
