/* Flipped triangles of a map onto the sphere, mended. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_MEND_H
#define ORB_MEND_H

#include "mesh.h"

/* Whether p, q, r run counter-clockwise seen from outside, det(p, q, r) > 0, beyond any rounding of this test. */
bool mend_oriented(const double p[3], const double q[3], const double r[3]);

/* Sum of the signed solid angles of the triangles over 4 pi: the degree, an integer up to rounding. */
double mend_degree(const orb_mesh *mesh, const double *positions);

/* Moves vertices of positions[n_vertices*3] (unit vectors; those of isolated vertices are not looked at) until every
 * triangle is positively oriented, and stays so when the coordinates are rounded to float, as far as that can be had.
 *
 * A vertex goes to the point that is farthest from the lines through the edges of its ring, on their left (a linear
 * programme in the plane of the gnomonic projection; Freitag and Plassmann 2000): this is inside the ring's kernel,
 * if there is one. First the vertices of flipped triangles move, then more and more rings around them, which makes
 * room. Vertices far from any flip stay. *mended: triangles that were flipped on entry. Errors: ORB_OUT_OF_MEMORY;
 * ORB_CERTIFICATE_FAILED, naming the triangles that are still flipped, or if the degree is not one. */
orb_status mend_sphere(const orb_mesh *mesh, double *positions, int64_t *mended, orb_error *error);

#endif
