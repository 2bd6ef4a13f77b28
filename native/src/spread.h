/* Cones -> log scale of the conformal map, and its spread. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * With L the cotangent Laplacian, K the angle defects (on a boundary from pi), a the vertices' areas (in all 1) and s_c the
 * curvature of cone c, the log scale u of the conformal map solves L u = 2 pi chi a(u) + sum_c s_c delta_c - K, where a(u)
 * is the area after scaling (docs/mathematics.md, section 8). With a(u) = a it is linear: u = g_0 + sum_c s_c g_c, g_c =
 * G (delta_c - a), g_0 = G (sum(K) a - K), where G inverts L and gives functions of mean zero. A triangle's log area grows
 * by twice the mean of u over its corners. So a quarter of the area-weighted variance of log area is the quadratic form
 *     F = u' W u = g_0' W g_0 + 2 sum_c s_c k_0(c) + sum_cd s_c s_d k_c(d),    k_c = G W g_c,
 * W being the mass matrix of the triangles' means. Everything there is to know of a vertex c is its column k_c. */
#ifndef ORB_SPREAD_H
#define ORB_SPREAD_H

#include "laplacian.h"
#include "shape.h"
#include "signature.h"

typedef struct orb_spread {
    const orb_mesh *mesh;
    orb_shape shape;
    orb_laplacian *laplacian;
    double *bare;    /* [n_vertices] g_0: u without cones */
    double *pull;    /* [n_vertices] k_0 */
    double constant; /* g_0' W g_0 */
    double *block;   /* [SPREAD_BLOCK*n_vertices] */
} orb_spread;

enum { SPREAD_BLOCK = 16 }; /* right-hand sides at once: a third of the time of one by one (docs/decisions.md) */

/* The mesh, in one piece, must live as long. */
orb_status spread_create(const orb_mesh *mesh, orb_spread **spread, orb_error *error);
void spread_free(orb_spread *spread);

/* column[i][n_vertices] = k_c for c = vertex[i], i < n <= SPREAD_BLOCK. */
orb_status spread_columns(orb_spread *spread, int32_t n, const int32_t *vertex, double *const *column,
                          orb_error *error);

/* Cones with their curvature: 2 pi (1 - 1/n), half as much for a mirror's corner. */
typedef struct orb_charges {
    int32_t n;
    const int32_t *vertex; /* [n] */
    const double *charge;  /* [n] */
    double euler;          /* of the orbifold, exactly 0 if it is flat */
    double lune;           /* where the two leave a dilation free, the angle between the meridians; else 0 */
} orb_charges;

/* Of a signature whose cones and corners are at vertex[n], in its sequence; charge[n] is filled in. */
orb_charges spread_charges(const orb_signature *signature, const int32_t *vertex, double *charge);

/* u of n <= SPREAD_BLOCK choices of cones, scale[i][n_vertices], 0 at isolated vertices and of mean zero, with a(u) at its
 * fixed point; where that is not reached, the last u stands. Of the maps onto a lune, the one with the least spread. */
orb_status spread_scales(orb_spread *spread, int32_t n, const orb_charges *charges, double *const *scale,
                         orb_error *error);

/* Standard deviation of log area. */
double spread_deviation(const orb_spread *spread, const double *scale);

#endif
