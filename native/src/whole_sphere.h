/* A spherical embedding -> one point of the sphere for each vertex. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Gives orb_whole_sphere (orbifold.h): quotient.h divides by the group, this file spreads the area by a Möbius map,
 * and mend.h puts the last triangles right. */
#ifndef ORB_WHOLE_SPHERE_H
#define ORB_WHOLE_SPHERE_H

#include "error.h"
#include "quotient.h"

/* A Möbius map f -> (m[1][0] + m[1][1] f) / (m[0][0] + m[0][1] f), a matrix of determinant one on (pole, zero). */
typedef struct orb_moebius {
    double complex m[2][2];
} orb_moebius;

/* The unit vector of a value after a Möbius map; 0 is at (0, 0, 1), as in geometry_coordinates. */
void whole_sphere_point(const orb_moebius *map, orb_ratio value, double x[3]);

/* The Möbius map, unique up to rotations, after which the weighted mean of the points is the sphere's centre; writes
 * it and the points, x[n*3]. Where no map does that (a point with half of the weight) it stops on the way there.
 * Returns the length of the mean that is left. `weights`: >= 0, not all 0; points without weight are mapped along. */
double whole_sphere_centre(int32_t n, const orb_ratio *values, const double *weights, orb_moebius *map, double *x);

#endif
