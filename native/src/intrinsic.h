/* Weights on edges that the mesh does not have. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Conformal weights are cotangents of the metric that the orbifold asks for (metric.h), Delaunay weights those of the
 * mesh's own, on the intrinsic Delaunay triangulation (delaunay.h). That triangulation is embedded, by Tutte's theorem;
 * a few triangles of the mesh may be flipped in it. Their edges are then kept from being flipped away, and all is
 * solved again, so that these triangles are among those that the theorem speaks of; in the last resort every edge is
 * kept (docs/mathematics.md, section 9). */
#ifndef ORB_INTRINSIC_H
#define ORB_INTRINSIC_H

#include "embedding.h"
#include "problem.h"

typedef struct orb_intrinsic {
    double *original; /* [n_edges] the mesh's lengths, the longest around 1 */
    double *lengths;  /* [n_edges] of the metric whose cotangents are taken */
    bool *special;    /* [n_vertices] some element of the group fixes it */
    uint8_t *keep;    /* [n_edges] is not flipped */
    int32_t *ends;    /* [n_edges*2] the edges, in copies */
    double *weights;  /* [n_edges] */
    int64_t n_clamped, n_flips;
    int32_t *mirror;           /* [n_vertices] the side whose mirror it slides on; -1 */
    orb_isometry *reflections; /* [sides of the tile] */
    orb_copies *base;          /* the copies of the mesh's corners, without those that flips add */
} orb_intrinsic;

/* `problem` says which vertices slide on mirrors. Takes embedding->copies over. `conformal`: the orbifold's metric; a
 * fixed polygon has none, and gets the mesh's. */
orb_status intrinsic_create(orb_embedding *embedding, const orb_problem *problem, bool conformal,
                            orb_intrinsic **intrinsic, orb_error *error);
void intrinsic_free(orb_intrinsic *intrinsic);

/* Flips what may be flipped, from the start, and hands edges and weights to the problem. embedding->copies becomes the
 * mesh's copies and the added ones. */
orb_status intrinsic_triangulate(orb_intrinsic *intrinsic, orb_embedding *embedding, double clamp, orb_problem *problem,
                                 orb_error *error);

/* Keeps the edges of flipped triangles [n_triangles] and of their neighbours (which saves a round). True if that
 * changes anything. */
bool intrinsic_keep(orb_intrinsic *intrinsic, const orb_mesh *mesh, const bool *flipped);
void intrinsic_keep_all(orb_intrinsic *intrinsic, const orb_mesh *mesh);

/* embedding->copies without the added ones, and embedding->weights: NULL unless the edges are the mesh's. */
void intrinsic_finish(const orb_intrinsic *intrinsic, orb_embedding *embedding);

#endif
