/* The cotangents of an intrinsic triangulation. SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "delaunay.h"
#include "sides.h"

/* The cotangents that a triangle's half-edges face; false if it has none. */
static bool triangle_cotangents(const orb_delaunay *d, const double *original, int32_t t, double cotangent[3]) {
    double length[3], before[3], angle[3];
    bool is_input = true;
    for (int c = 0; c < 3; c++) {
        const int32_t e = d->edges[3 * t + c];
        length[c] = d->lengths[e];
        before[c] = original[e];
        is_input = is_input && !d->flipped[e];
    }
    return sides_angles(length, angle, cotangent) || (is_input && sides_angles(before, angle, cotangent));
}

/* Three parts, one for each side of a triangle, half a cotangent each; where side c is flipped across a mirror, those
 * of the halves of p r' r and q r r' that lie here, p and q being the ends of side c and r' the mirror image of the
 * corner r across. With a and b the angles at p and q these are tan(a) / 2 for p r, tan(b) / 2 for q r, and half of
 * the double's (cot 2a + cot 2b) / 2 for r r'. (No two sides of a triangle are flipped so: only one angle is obtuse.)
 * */
static void triangle_parts(const orb_delaunay *d, int32_t t, const double cotangent[3], double part[3]) {
    for (int c = 0; c < 3; c++)
        part[c] = 0.5 * cotangent[c];
    for (int c = 0; c < 3; c++) {
        if (d->across[d->edges[3 * t + c]] < 0)
            continue;
        const int next = (c + 1) % 3, previous = (c + 2) % 3; /* facing p and q */
        const double at_p = cotangent[next], at_q = cotangent[previous];
        part[next] = 0.5 / at_q;
        part[previous] = 0.5 / at_p;
        part[c] = 0.125 * (at_p - 1 / at_p + at_q - 1 / at_q);
    }
}

void delaunay_weights(const orb_delaunay *d, const double *original, double clamp, int32_t *ends, double *weights,
                      int64_t *n_clamped) {
    *n_clamped = 0;
    for (int32_t e = 0; e < d->n_edges; e++) {
        ends[2 * e] = d->corners[d->sides[2 * e]];
        ends[2 * e + 1] = d->corners[halfedge_next(d->sides[2 * e])];
        if (d->across[e] >= 0) {
            ends[2 * e] = d->corners[halfedge_previous(d->sides[2 * e])];
            ends[2 * e + 1] = d->across[e];
        }
        weights[e] = 0;
    }
    for (int32_t t = 0; t < d->n_triangles; t++) {
        double cotangent[3], part[3];
        if (!triangle_cotangents(d, original, t, cotangent))
            continue;
        triangle_parts(d, t, cotangent, part);
        for (int c = 0; c < 3; c++)
            weights[d->edges[3 * t + c]] += part[c];
    }
    for (int32_t e = 0; e < d->n_edges; e++)
        if (!(weights[e] >= clamp)) {
            weights[e] = clamp;
            ++*n_clamped;
        }
}
