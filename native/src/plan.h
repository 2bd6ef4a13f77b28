/* One signature on its way to its cones. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_PLAN_H
#define ORB_PLAN_H

#include "assignment.h"
#include "descent.h"
#include "signature.h"

typedef struct orb_plan {
    char *text;               /* as asked for */
    orb_signature *signature; /* with a * for each hole that is a mirror */
    bool sure;                /* tried whatever it costs */
    bool conformal_tile;      /* the tile's shape is the conformal one: it has no other, or it is chosen so */
    bool symmetric;           /* its sites are of a mesh's mirror plane */
    bool placed;
    int32_t n_slots; /* of the best ones so far, */
    orb_slot *slots; /* [n_cones] grouped by kind, */
    orb_site *sites; /* [n_cones] where they are, */
    double value;    /* and the form there with the penalties */
    bool *pinned;    /* [n_cones] the site is a fixed one */
    double *radius;  /* [n_cones] */
    int32_t n_cones;
    int32_t *cones;  /* [n_cones] in the signature's sequence */
    double *charges; /* [n_cones] */
    double conformal, predicted;
    bool measured;
} orb_plan;

/* signature is taken over, also on failure. */
orb_status plan_create(const char *text, orb_signature *signature, orb_plan **plan, orb_error *error);
void plan_free(orb_plan *plan);

/* Adds to wanted[kind] where the cones may have to be; loop_of[mirror]: the loops that are its mirrors. */
void plan_want(const orb_plan *plan, const int32_t *loop_of, bool symmetric, bool *wanted);

/* The best sites among the options; plan->placed says if there are any. Of cones of one order some may be pairs of mirror
 * images; all ways of choosing how many are tried. */
orb_status plan_place(orb_plan *plan, const orb_ground *ground, const orb_options *options, double constant,
                      const int32_t *loop_of, bool symmetric, orb_error *error);

orb_descent plan_descent(orb_plan *plan, double radius);

/* Places -> cones in the signature's sequence, mirror corners as they follow along the boundary. */
orb_status plan_list_cones(orb_plan *plan, const orb_ground *ground, const int32_t *loop_of, orb_error *error);

/* On a sphere, whose cut runs through the cones in turn, four or more are put into the sequence of a short walk. */
orb_status plan_shorten_walk(orb_plan *plan, const orb_mesh *mesh, orb_error *error);

orb_charges plan_charges(const orb_plan *plan);

#endif
