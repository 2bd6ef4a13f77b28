/* From a problem to its solution. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_SOLVE_H
#define ORB_SOLVE_H

#include "embedding.h"
#include "intrinsic.h"
#include "monitor.h"
#include "newton.h"

/* What is needed on the way and not afterwards. */
typedef struct orb_workshop {
    const orb_request *request;
    const uint8_t *halve; /* chords to halve, or NULL: all */
    orb_embedding *embedding;
    orb_disk *disk;
    orb_problem *problem;
    orb_intrinsic *intrinsic; /* for weights on other edges than the mesh's */
    orb_system *system;
    int32_t n_order;
    int32_t *order; /* [n_order] at least all vertices that move, fill-reducing */
    bool dilated;   /* away from the minimum (dilation.h) */
    orb_monitor monitor;
} orb_workshop;

/* Whether the request's weights suit the geometry; and conformal and Delaunay weights' own edges. The problem must be
 * there; it takes the edges. */
orb_status solve_find_weights(orb_workshop *work, orb_error *error);

/* The matrix's pattern and its ordering, which the starting point shares. */
orb_status solve_set_up(orb_workshop *work, orb_error *error);

/* embedding->position, to start from. */
orb_status solve_start(orb_workshop *work, orb_error *error);

/* The minimiser, mending, the affine modulus; positions, placed copies, and what the report says of them. */
orb_status solve_minimise(orb_workshop *work, orb_error *error);

#endif
