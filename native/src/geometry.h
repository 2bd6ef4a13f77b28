/* The sphere, the plane and the hyperbolic plane, written once. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A point is a complex number z in the chart whose metric is 2 |dz| / (1 + K |z|^2): stereographic projection for
 * K = 1, half the usual coordinate for K = 0, the Poincaré disk for K = -1. Every orientation-preserving isometry is
 * z -> (a z + b) / (conj(a) - K conj(b) z) in all three, every other one the same of conj(z), and the translation that
 * takes p to the origin is z -> (z - p) / (1 + K conj(p) z). So K enters as a number, and nobody but this file, tile.c
 * and polygon.c looks at it.
 *
 * Points and isometries carry double-double precision (value + low part), since in the hyperbolic plane all of the
 * digits that tell far points apart lie at the end of z. Differences of points are then formed to full double
 * precision, and everything after that is done in double (docs/mathematics.md, Precision).
 *
 * A tangent vector at z is a complex number too, in the frame that the chart gives; its modulus is its length. */
#ifndef ORB_GEOMETRY_H
#define ORB_GEOMETRY_H

#include <complex.h>
#include <math.h>
#include <stdbool.h>

#include "orbifold.h"

#ifndef CMPLX /* C11 has it; glibc hides it from clang */
#define CMPLX(x, y) __builtin_complex((double)(x), (double)(y))
#endif

typedef struct orb_geometry orb_geometry;

typedef struct orb_point {
    double complex z, low; /* the point is z + low */
} orb_point;

/* z -> (a z + b) / (conj(a) - K conj(b) z), or the same of conj(z) */
typedef struct orb_isometry {
    orb_point a, b;
    bool reflects; /* reverses orientation: of conj(z) */
} orb_isometry;

/* curvature > 0, 0, < 0: sphere, plane, hyperbolic plane. A constant; never freed. */
const orb_geometry *geometry_of_curvature(int curvature);
const char *geometry_name(const orb_geometry *geometry);
/* K, for tile.c only. */
int geometry_curvature(const orb_geometry *geometry);
/* The flat charts of a layout run from the first, the default, to the last. */
orb_chart geometry_first_chart(const orb_geometry *geometry);
orb_chart geometry_last_chart(const orb_geometry *geometry);

/* --- how the minimiser treats the geometry (one row of a table each, docs/decisions.md) --- */
/* The energy is quadratic: any starting point will do, so none is computed. */
bool geometry_any_start(const orb_geometry *geometry);
/* What may move without changing any edge: translations, or rotations about an axis. */
bool geometry_has_translations(const orb_geometry *geometry);
/* The longest step of a vertex that the minimiser may try; infinite where the energy is convex. */
double geometry_longest_step(const orb_geometry *geometry);

/* |a| without hypot's care for the ends of the exponent range, which a bounded chart does not meet. */
static inline double modulus(double complex a) { return sqrt(creal(a) * creal(a) + cimag(a) * cimag(a)); }

/* --- points --- */
orb_point point_of(double complex z);
orb_point point_conjugate(orb_point p);
/* a p + b conj(p), to full precision */
orb_point point_linear(double complex a, double complex b, orb_point p);

/* t: where q goes when p is moved to the origin; direction from p to q, |t| = tan_K(distance / 2). */
double complex geometry_toward(const orb_geometry *geometry, orb_point p, orb_point q);
/* The first two coordinates of q (docs/mathematics.md, section 1) when p is moved to the origin: linear along
 * geodesics, up to one factor for all q. */
double complex geometry_seen(const orb_geometry *geometry, orb_point p, orb_point q);
double geometry_distance(const orb_geometry *geometry, orb_point p, orb_point q);
/* Whether the two are so nearly opposite on the sphere that they determine no geodesic. */
bool geometry_is_antipodal(const orb_geometry *geometry, orb_point p, orb_point q);
double complex geometry_log(const orb_geometry *geometry, orb_point p, orb_point q);
orb_point geometry_exp(const orb_geometry *geometry, orb_point p, double complex v);
/* The phase by which parallel transport along the geodesic p -> q turns a vector's frame coordinates. */
double complex geometry_transport(const orb_geometry *geometry, orb_point p, orb_point q);

/* One edge of the energy 1/2 w d(p, q)^2 (docs/mathematics.md, section 3). */
typedef struct orb_edge_terms {
    double distance;
    double complex at_p, at_q; /* unit direction p -> q, at p and carried on to q */
    double C, S;               /* d / tan d, d / sin d and their likes */
} orb_edge_terms;
orb_edge_terms geometry_edge(const orb_geometry *geometry, orb_point p, orb_point q);

/* Signed area of the geodesic triangle 0, s, t, where s and t are `toward` vectors from its first corner. */
double geometry_triangle_area(const orb_geometry *geometry, double complex s, double complex t);

/* --- geodesic triangles, in whose interior a point is the sum of weights times the corners' model coordinates, made a
 * point again. Isometries act linearly on these, so the weights are the same in all images, and on both sides of an
 * edge. --- */

/* Of p: weight[3] that add up to 1, and sine[3] of the angle at which p sees the edge that faces each corner: negative
 * where p is beyond it. Of points far away, as opposite ones on the sphere, only the signs count. */
void geometry_locate(const orb_geometry *geometry, orb_point p, const orb_point corners[3], double weight[3],
                     double sine[3]);
/* And back. */
orb_point geometry_between(const orb_geometry *geometry, const orb_point corners[3], const double weight[3]);
/* How p, which has these weights, moves with each of them, in the frame at p. */
void geometry_slopes(const orb_geometry *geometry, orb_point p, const orb_point corners[3], const double weight[3],
                     double complex slope[3]);

/* The three coordinates of docs/mathematics.md, section 1: (2x, 2y, 1 - K|z|^2) / (1 + K|z|^2), as value + low. */
void geometry_coordinates(const orb_geometry *geometry, orb_point p, double value[3], double low[3]);

/* The chart in which a convex tile is a convex region of the plane (orthographic; identity; Klein), and back. */
double complex geometry_convex_chart(const orb_geometry *geometry, orb_point p);
orb_point geometry_from_convex_chart(const orb_geometry *geometry, double complex w);

/* --- isometries --- */
orb_isometry isometry_identity(void);
/* first `inner`, then `outer` */
orb_isometry isometry_compose(const orb_geometry *geometry, orb_isometry outer, orb_isometry inner);
orb_isometry isometry_inverse(orb_isometry h);
orb_point isometry_apply(const orb_geometry *geometry, orb_isometry h, orb_point p);
/* the phase by which h turns the frame at p: a vector v goes to turn v, or turn conj(v) if h reflects */
double complex isometry_turn(const orb_geometry *geometry, orb_isometry h, orb_point p);
/* p -> origin without rotation */
orb_isometry isometry_to_origin(const orb_geometry *geometry, orb_point p);
orb_isometry isometry_rotation_about_origin(double angle);
/* the one that takes p to p1 and the direction of q to that of q1, keeping orientation or reversing it */
orb_isometry isometry_pairing(const orb_geometry *geometry, orb_point p, orb_point q, orb_point p1, orb_point q1);
orb_isometry isometry_reflection(const orb_geometry *geometry, orb_point p, orb_point q, orb_point p1, orb_point q1);
/* its matrix, by rows, on the coordinates of geometry_coordinates */
void isometry_matrix(const orb_geometry *geometry, orb_isometry h, double matrix[9]);
/* whether the two move the origin to within `tolerance` of one another and turn it alike */
bool isometry_same(const orb_geometry *geometry, orb_isometry g, orb_isometry h, double tolerance);

#endif
