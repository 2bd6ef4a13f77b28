/* Flipped triangles of a map onto the sphere, mended. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_MEND_H
#define ORB_MEND_H

#include "mesh.h"

/* Whether p, q, r run counter-clockwise seen from outside, det(p, q, r) > 0, beyond any rounding of this test. */
bool mend_oriented(const double p[3], const double q[3], const double r[3]);

/* Sum of the signed solid angles of the triangles over 4 pi: the degree, an integer up to rounding. */
double mend_degree(const orb_mesh *mesh, const double *positions);

/* Moves vertices of positions[n_vertices*3] (unit vectors; those of isolated vertices are not looked at) until every
 * triangle is positively oriented; then goes on until every triangle is so when the coordinates are rounded to float,
 * or a bound on the work is met (a few seconds for 50,000 vertices).
 *
 * The vertices of flipped triangles go to the middle of their rings (ring.h). Where that does not do, so do more and
 * more rings of vertices around them, and the whole region is tried as a weighted Tutte embedding with its border held.
 * Vertices far from any flip stay. *mended (may be NULL): triangles that were flipped on entry. Errors:
 * ORB_OUT_OF_MEMORY; ORB_CERTIFICATE_FAILED, naming the triangles that are still flipped, or if the degree, which is
 * the sum of the solid angles over 4 pi, is not one. */
orb_status mend_sphere(const orb_mesh *mesh, double *positions, int64_t *mended, orb_error *error);

#endif
