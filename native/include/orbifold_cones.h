/* Where to put the cones, and what they will cost. SPDX-License-Identifier: GPL-3.0-or-later
 *
 *     orb_suggestions *suggestions = NULL;
 *     orb_suggest_request request = {0};
 *     if (orb_suggest_cones(&mesh, &request, &suggestions, &error) != ORB_OK) ... error.message, error.elements
 *     orb_suggestion best = orb_suggestions_view(suggestions, 0);
 *     ... orb_embed with best.signature and best.cones ...
 *     orb_suggestions_free(suggestions);
 *
 * A conformal map onto an orbifold stretches the surface by e^u, and the cones alone say what u is: one Poisson equation
 * (docs/mathematics.md, section 8). Cones are placed so that the area-weighted standard deviation of log area, which is
 * 2 u, is least. The same arguments always give the same cones. */
#ifndef ORBIFOLD_CONES_H
#define ORBIFOLD_CONES_H
#include "orbifold.h"
#ifdef __cplusplus
extern "C" {
#endif

typedef enum orb_symmetry {
    ORB_SYMMETRY_DETECT = 0, /* the mesh's mirror plane, if it has one: x, y, z = const or a principal plane */
    ORB_SYMMETRY_IGNORE,
    ORB_SYMMETRY_PLANE /* the request's plane, whether or not the vertices are symmetric */
} orb_symmetry;

typedef struct orb_suggest_request {
    int32_t n_signatures;          /* 0: what is usual for the mesh's topology, docs/mathematics.md, section 8 */
    const char *const *signatures; /* [n_signatures] */
    bool flat; /* of the usual ones only those of the plane, where there are any: an image repeats over their tile */
    int32_t n_fixed;
    const int32_t *fixed;    /* [n_fixed] vertices that are cones (on a mirror: corners) of every suggestion */
    const double *keep_away; /* [n_vertices] >= 0: what a cone there costs, in squared log area; infinite: never there.
                                NULL: zero */
    orb_holes holes;         /* as in orb_request */
    orb_symmetry symmetry;   /* suggestions are their own mirror images, as far as vertices and fixed cones allow */
    double plane[4];         /* a x + b y + c z = d, for ORB_SYMMETRY_PLANE */
    orb_progress progress;   /* may be NULL */
    void *user;              /* its last argument */
} orb_suggest_request;

typedef struct orb_suggestion {
    const char *signature; /* as it was asked for */
    int32_t n_cones;
    const int32_t *cones;  /* [n_cones] in the signature's sequence, as orb_embed takes them */
    const int32_t *orders; /* [n_cones] that sequence */
    double predicted; /* standard deviation of log area of the conformal map, which the embedding will nearly have with
                         conformal weights; if `measured`: twice that of the logarithms of the embedding's singular values,
                         which is the same for a conformal map and counts distorted angles, too */
    double conformal; /* standard deviation of log area of a conformal map with these cones */
    bool measured;  /* four hyperbolic cones and more: the tile is a fixed one that is not conformal, so the cones were
                         chosen by `conformal`, but the suggestion is ranked by the embedding */
    bool symmetric; /* the cones are their own mirror image */
} orb_suggestion;

/* For each signature the best cones, the least `predicted` first. A signature whose embedding has to be measured and
 * fails is left out, as is one with fewer cones than are fixed, unless that leaves nothing. Of the usual signatures,
 * those with many hyperbolic cones are embedded only where the others leave a spread above 1 and they promise less, on meshes
 * of up to 200,000 vertices.
 * Errors: mesh_create's and orb_embed's for a mesh that is not of the signature's topology; ORB_BAD_SIGNATURE and its
 * like; ORB_CONE_COUNT (too few vertices, or too many fixed cones); ORB_BAD_CONE (a fixed one that is not free to be
 * one); ORB_BAD_WEIGHT (keep_away is negative or not a number; vertices); ORB_CANCELLED. */
typedef struct orb_suggestions orb_suggestions;
ORB_API orb_status orb_suggest_cones(const orb_mesh_arrays *mesh, const orb_suggest_request *request,
                                     orb_suggestions **suggestions, orb_error *error);
ORB_API void orb_suggestions_free(orb_suggestions *suggestions);
ORB_API int32_t orb_suggestions_count(const orb_suggestions *suggestions);
/* The arrays live as long as the suggestions do. Zeros for a number that is none. */
ORB_API orb_suggestion orb_suggestions_view(const orb_suggestions *suggestions, int32_t number);
/* The mirror plane a x + b y + c z = d that was given or found; false: none. */
ORB_API bool orb_suggestions_plane(const orb_suggestions *suggestions, double plane[4]);

/* The conformal map's log scale u at each vertex, scale[n_vertices] (0 for isolated vertices; area-weighted mean 0), and
 * the spread of log area that it means, for the signature, cones, orders and holes of a request. Either may be NULL.
 * Errors: those of orb_embed that concern the mesh, the signature and the picks; ORB_CANCELLED. */
ORB_API orb_status orb_predict(const orb_mesh_arrays *mesh, const orb_request *request, double *spread, double *scale,
                               orb_error *error);

/* The same as orb_suggest_cones and orb_predict on a thread of the library's own; poll and cancel as any job. */
ORB_API orb_status orb_job_start_suggest(const orb_mesh_arrays *mesh, const orb_suggest_request *request, orb_job **job,
                                         orb_error *error);
ORB_API orb_status orb_job_finish_suggest(orb_job *job, orb_suggestions **suggestions, orb_error *error);
ORB_API orb_status orb_job_start_predict(const orb_mesh_arrays *mesh, const orb_request *request, orb_job **job,
                                         orb_error *error);
ORB_API orb_status orb_job_finish_predict(orb_job *job, double *spread, double *scale, orb_error *error);

#ifdef __cplusplus
}
#endif
#endif
