/* Maps from one surface to another. SPDX-License-Identifier: GPL-3.0-or-later
 *
 *     request.signature = "2222222";  request.cut = ORB_CUT_PATH;  ... one sequence of landmarks for both meshes
 *     orb_embed(&mesh_a, &request, &a, &error);
 *     request.cones = landmarks_b;  orb_embed(&mesh_b, &request, &b, &error);
 *     orb_surface_map(a, b, 0, NULL, NULL, triangles, barycentric, NULL, &error);
 *
 * Two embeddings in one orbifold compose to a map of one mesh onto the other: continuous, bijective, without seams, and
 * it takes each cone, a landmark, to the other mesh's cone in the same place of the sequence (docs/mathematics.md,
 * section 10; 2015, section 6.2; 2016, section 7). Several meshes embedded alike have maps between any two, and these
 * are consistent: b -> c after a -> b is a -> c.
 *
 * In what way the map winds around the landmarks, its homotopy class, follows from the cuts: they go to one another.
 * For up to three cones on a sphere, and a disk between mirrors with one cone or none, there is but one way. */
#ifndef ORBIFOLD_MAPS_H
#define ORBIFOLD_MAPS_H
#include "orbifold.h"
#ifdef __cplusplus
extern "C" {
#endif

typedef struct orb_map_report {
    int64_t steps;            /* sides of the target's triangles that were crossed on the way */
    int32_t elements;         /* of the group that were met */
    int32_t in_holes;         /* points that the target has in a filled hole */
    double landmark_residual; /* the farthest that corresponding corners of the two tiles lie from each other, once the
                                 tiles are mapped onto one another; the map takes landmarks to landmarks exactly */
} orb_map_report;

/* Where the source's points go: triangles[n_points] of the target's input mesh and barycentric[n_points*3], which are
 * >= 0 and add up to 1. n_points 0 and both arrays NULL: all vertices of the source's input, in their sequence. Else
 * point i is in the input triangle point_triangles[i] of the source, with point_barycentric[3*i ...]. Isolated
 * vertices, points in the triangle -1, and points that go to a filled hole of the target, get the triangle -1 and
 * zeros. Where a triangle's edges were halved, the map is piecewise what it is elsewhere on whole triangles. O(source +
 * target + points). `report` may be NULL. Errors: ORB_NO_CORRESPONDENCE says what to do; ORB_BAD_ARGUMENT (a triangle
 * out of range, weights below 0 or that do not add up to 1); ORB_POINT_NOT_FOUND. */
ORB_API orb_status orb_surface_map(const orb_embedding *source, const orb_embedding *target, int32_t n_points,
                                   const int32_t *point_triangles, const double *point_barycentric, int32_t *triangles,
                                   double *barycentric, orb_map_report *report, orb_error *error);

/* The map's differential from mesh to mesh in the middle of each input triangle of the source (where edges were
 * halved, of a piece of it). */
typedef struct orb_map_distortion {
    double quasi_conformal_mean, quasi_conformal_max; /* ratio of its singular values, area weighted on the source */
    double log_area_mean, log_area_std; /* of the logarithm of its determinant, area weighted on the source */
    int64_t flipped;  /* where the determinant is not positive: none, as both embeddings are certified */
    int64_t left_out; /* triangles without area, here or there, or that go to a filled hole */
} orb_map_distortion;

/* Either array [source's input triangles] may be NULL: the ratio of singular values, and the logarithm of the
 * determinant; 0 where it was left out. Errors: as of orb_surface_map. */
ORB_API orb_status orb_surface_map_distortion(const orb_embedding *source, const orb_embedding *target,
                                              double *quasi_conformal, double *log_area, orb_map_distortion *distortion,
                                              orb_error *error);

/* A part of the course of an edge of the source over the target, that is straight within one triangle of the target's
 * input (where its edges were halved, within a piece of it). */
typedef struct orb_stretch {
    int32_t edge;          /* number among those that were asked for */
    int32_t triangle;      /* of the target's input; -1, and weights 0, in a filled hole */
    double at[2];          /* of both ends along the edge, 0 at its first end to 1 */
    double barycentric[6]; /* of both ends in that triangle, exactly 0 on its sides and exactly 1 at its corners */
} orb_stretch;

/* Where edges of the source's input go: edge i from the input corner corners[i] (3 t + c) to the next one of its
 * triangle. The stretches of an edge are in turn, each begins where the one before ends, and between stretches the
 * course is on a side of the target, or at a corner of it: what passes by a corner within rounding goes through it. The
 * course is where orb_surface_map has the edge's points. Errors: as of orb_surface_map. */
typedef struct orb_trace orb_trace;
ORB_API orb_status orb_surface_map_trace(const orb_embedding *source, const orb_embedding *target, int32_t n_edges,
                                         const int32_t *corners, orb_trace **trace, orb_error *error);
ORB_API void orb_trace_free(orb_trace *trace);
ORB_API int64_t orb_trace_count(const orb_trace *trace);
/* Copies all to stretches[orb_trace_count]. */
ORB_API void orb_trace_read(const orb_trace *trace, orb_stretch *stretches);

/* sequence[n]: the numbers of the landmarks in the sequence of a short walk along edges (2016, section 7), for the
 * cones of every mesh with these landmarks. Landmarks change places only with those of the same order; orders NULL:
 * with all. Errors: mesh_create's, ORB_SEVERAL_COMPONENTS, ORB_BAD_CONE. */
ORB_API orb_status orb_landmark_sequence(const orb_mesh_arrays *mesh, int32_t n, const int32_t *landmarks,
                                         const int32_t *orders, int32_t *sequence, orb_error *error);

#ifdef __cplusplus
}
#endif
#endif
