/* A sphere divided by the group of its orbifold. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The quotient of the sphere by a rotation group is a sphere again, and the map a rational function f of the chart's
 * z: it has its zeros at the copies of the first cone, its poles at those of the second and the value 1 at those of
 * the third, each as many times as the cone's order says (Klein 1884; docs/mathematics.md, section 7). So, up to
 * constants, f, 1/f and f - 1 are quotients of three products over the cones' orbits,
 *
 *     A(z) = prod (z - root)^n_1,    D(z) = prod (z - root)^n_2,    E(z) = prod (z - root)^n_3,
 *
 * each with full relative precision near its roots, in whatever position and sequence the cones are. Two cones: A and D
 * only, f = z^N when they lie at 0 and infinity. */
#ifndef ORB_QUOTIENT_H
#define ORB_QUOTIENT_H

#include "tile.h"

typedef struct orb_quotient orb_quotient;

/* A value of f as zero : pole with |zero|^2 + |pole|^2 = 1, and one = zero - pole: f = zero / pole, f - 1 = one / pole.
 * Only one of the three is small, and that one has lost no digits (with two cones `one` is merely the difference). */
typedef struct orb_ratio {
    double complex zero, pole, one;
} orb_ratio;

/* Error: ORB_BAD_ARGUMENT if the tile is not spherical. The time is that of the orbits' length squared (62 points in
 * all for 532, 2 N + 2 for 22N). */
orb_status quotient_create(const orb_tile *tile, orb_quotient **quotient, orb_error *error);
void quotient_free(orb_quotient *quotient);

orb_ratio quotient_evaluate(const orb_quotient *quotient, orb_point p);

#endif
