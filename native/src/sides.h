/* A flat triangle by the lengths of its sides. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Side c runs from corner c to corner c + 1, as half-edges do; the angle that it faces is at corner c + 2. */
#ifndef ORB_SIDES_H
#define ORB_SIDES_H

#include <stdbool.h>

/* Twice the area (Kahan 1986, "Miscalculating area and angles of a needle-like triangle"). 0 where the lengths break
 * the triangle inequality, or keep it by no more than their rounding. */
double sides_double_area(const double length[3]);

/* |a| |b| cos of the angle that side c faces, between the two other sides. */
double sides_dot(const double length[3], int c);

/* The three angles (angle[c]: the one that side c faces) and their cotangents. False, with nothing set, if the area is
 * zero. */
bool sides_angles(const double length[3], double angle[3], double cotangent[3]);

#endif
