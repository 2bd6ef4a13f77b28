/* Generators of a wallpaper group -> its motions, up to periods. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_MOTIONS_H
#define ORB_MOTIONS_H

#include "orbifold.h"

/* Affine, (u, v) -> (a u + b v + c, d u + e v + f). */
typedef struct orb_motion {
    double a, b, c, d, e, f;
} orb_motion;

orb_motion motion_product(orb_motion first, orb_motion then);

/* The elements that differ by more than whole periods, the identity first; *motions to be freed. Errors:
 * ORB_BAD_ARGUMENT (the group has no such periods, or numbers are none), ORB_OUT_OF_MEMORY. */
orb_status motions_of(int32_t n_generators, const double *generators, int32_t *n_motions, orb_motion **motions,
                      orb_error *error);

#endif
