/* Mesh + request -> the surface that is embedded, and its features. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Checks that the mesh is of the signature's topology and finds the role of each pick. Holes are closed and chords
 * halved where need is, so that all that follows sees an ordinary surface. */
#ifndef ORB_SURFACE_H
#define ORB_SURFACE_H

#include "disk.h"

typedef struct orb_surface {
    orb_signature *signature; /* with a * for each hole that is a mirror; NULL for a fixed boundary */
    orb_mesh *plain;          /* the input, its holes closed */
    orb_mesh *mesh;           /* the same with chords halved; may be `plain` itself */
    int32_t *parent;          /* [mesh->n_triangles] the plain triangle that each lies in; NULL if mesh is plain */
    int32_t *halved;          /* [n_halved] edges of `plain`, ascending: their midpoints follow its vertices */
    int32_t n_halved, n_closed;
    int32_t n_input_vertices, n_input_triangles;
    int32_t *input_triangles; /* [n_input_triangles*3] as given */
    int32_t n_marks;
    int32_t *vertex, *order; /* [n_marks] cones and corners as they were picked */
    bool *mirror;            /* [n_marks] it is a mirror corner */
    orb_cut cut;
    orb_report about; /* what the report says of the input */
    const orb_prepared
        *prepared; /* the request's, while it runs, if the mesh has just the edges of the input; or NULL */
} orb_surface;

/* `halve` [plain->n_edges] (may be NULL): the chords to halve, at most. A chord is an edge inside that joins two
 * vertices of one mirror side: it would lie flat on the mirror.
 * Errors: mesh_create's; ORB_SEVERAL_COMPONENTS, ORB_BOUNDARY, ORB_WRONG_GENUS where the mesh is not the signature's
 * surface; ORB_CONE_COUNT, ORB_BAD_CONE, ORB_BAD_ORDER where the picks are not its features. */
orb_status surface_create(const orb_mesh_arrays *arrays, const orb_request *request, const uint8_t *halve,
                          orb_surface **surface, orb_error *error);
void surface_free(orb_surface *surface);

/* The request's own weights for surface->mesh: weights[n_edges]. Error: weights_compute's, and ORB_BAD_ARGUMENT where
 * holes were closed. */
orb_status surface_given_weights(const orb_surface *surface, const orb_request *request, double *weights,
                                 orb_error *error);

static inline orb_marks surface_marks(const orb_surface *surface) {
    return (orb_marks){surface->n_marks, surface->vertex, surface->order};
}

#endif
