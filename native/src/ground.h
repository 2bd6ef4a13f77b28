/* Where cones may be. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A site is a vertex, or, on a mesh with a mirror plane, a vertex on the plane or a pair of mirror images. Places are of
 * kinds: inside the surface or on one boundary loop, single or a pair. */
#ifndef ORB_GROUND_H
#define ORB_GROUND_H

#include "boundary.h"
#include "reflection.h"

typedef struct orb_ground {
    const orb_mesh *mesh;
    orb_boundary *boundary;
    double *penalty;                  /* [n_vertices] of a cone there, a quarter of squared log area; infinite: never */
    bool *fixed;                      /* [n_vertices] a cone of every suggestion */
    const orb_reflection *reflection; /* NULL: none */
    double size;                      /* square root of the area */
} orb_ground;

typedef struct orb_site {
    int32_t n; /* 1, or 2 for a pair */
    int32_t vertex[2];
} orb_site;

static inline int32_t ground_kind(int32_t loop, bool pair) { return 2 * (loop + 1) + pair; }
static inline int32_t ground_kind_loop(int32_t kind) { return kind / 2 - 1; }
static inline bool ground_kind_is_pair(int32_t kind) { return kind % 2 == 1; }

/* keep_away [n_given] (may be NULL) is that of orb_suggest_request, for the first vertices; later ones, of filled holes, are
 * never cones. `fixed` has been checked. Errors:
 * ORB_BAD_WEIGHT, ORB_OUT_OF_MEMORY. */
orb_status ground_create(const orb_mesh *mesh, int32_t n_given, const double *keep_away, int32_t n_fixed,
                         const int32_t *fixed, orb_ground **ground, orb_error *error);
void ground_free(orb_ground *ground);

/* The site of a kind that a vertex stands for; false if it is none, or not a free one. */
bool ground_place(const orb_ground *ground, int32_t kind, int32_t vertex, orb_site *site);

double ground_penalty(const orb_ground *ground, const orb_site *site);

#endif
