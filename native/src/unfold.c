/* Walking over a UV map, across its seams. SPDX-License-Identifier: GPL-3.0-or-later */
#include "unfold.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>

#include "error.h"

enum { MOST_STEPS = 200 };
static const double beside = 1e-9;  /* what a weight may be below 0 */
static const double joined = 1e-12; /* UVs that are one */

typedef double complex complex_number;

/* --- edges -------------------------------------------------------------------------------------------------------- */

typedef struct edge_end {
    int32_t low, high, corner;
} edge_end;

static int by_ends(const void *one, const void *other) {
    const edge_end *a = one, *b = other;
    if (a->low != b->low)
        return a->low < b->low ? -1 : 1;
    if (a->high != b->high)
        return a->high < b->high ? -1 : 1;
    return (a->corner > b->corner) - (a->corner < b->corner);
}

static int32_t next_corner(int32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

orb_status unfold_create(int32_t n_triangles, const int32_t *triangles, const double *uv, orb_unfold *unfold,
                         orb_error *error) {
    const size_t n = 3 * (size_t)n_triangles;
    edge_end *ends = malloc((n + 1) * sizeof *ends);
    *unfold = (orb_unfold){.n_triangles = n_triangles, .uv = uv};
    unfold->across = malloc((n + 1) * sizeof *unfold->across);
    unfold->reversed = malloc((n + 1) * sizeof *unfold->reversed);
    if (!ends || !unfold->across || !unfold->reversed) {
        free(ends);
        return error_memory(error);
    }
    for (size_t h = 0; h < n; h++) {
        const int32_t a = triangles[h], b = triangles[next_corner((int32_t)h)];
        ends[h] = (edge_end){a < b ? a : b, a < b ? b : a, (int32_t)h};
        unfold->across[h] = -1;
        unfold->reversed[h] = true;
    }
    qsort(ends, n, sizeof *ends, by_ends);
    for (size_t first = 0, last; first < n; first = last) {
        for (last = first + 1; last < n && ends[last].low == ends[first].low && ends[last].high == ends[first].high;)
            last++;
        if (last - first != 2)
            continue;
        const int32_t h = ends[first].corner, k = ends[first + 1].corner;
        unfold->across[h] = k;
        unfold->across[k] = h;
        unfold->reversed[h] = unfold->reversed[k] = triangles[h] != triangles[k];
    }
    free(ends);
    return ORB_OK;
}

void unfold_clear(orb_unfold *unfold) {
    free(unfold->across);
    free(unfold->reversed);
    *unfold = (orb_unfold){0};
}

/* --- similarities ------------------------------------------------------------------------------------------------- */

static complex_number number(const double pair[2]) { return pair[0] + I * pair[1]; }

static void pair_of(complex_number z, double pair[2]) {
    pair[0] = creal(z);
    pair[1] = cimag(z);
}

static complex_number corner_of(const orb_unfold *unfold, int32_t corner) {
    return number(unfold->uv + 2 * (size_t)corner);
}

static complex_number undone(const orb_similarity *by, complex_number z) {
    const complex_number w = (z - number(by->b)) / number(by->a);
    return by->turned_over ? conj(w) : w;
}

/* `by` after the one that takes p to q and p' to q'. */
static orb_similarity after(const orb_similarity *by, bool turned_over, complex_number p, complex_number p_,
                            complex_number q, complex_number q_) {
    complex_number a = turned_over ? (q_ - q) / conj(p_ - p) : (q_ - q) / (p_ - p);
    complex_number b = q - a * (turned_over ? conj(p) : p);
    orb_similarity all = {.turned_over = by->turned_over != turned_over};
    if (by->turned_over) {
        a = conj(a);
        b = conj(b);
    }
    pair_of(number(by->a) * a, all.a);
    pair_of(number(by->a) * b + number(by->b), all.b);
    return all;
}

static double turn(complex_number a, complex_number b) { return cimag(conj(a) * b); }

/* Which side of an edge the third corner of its triangle lies on, in its own UVs. */
static double side_of(const orb_unfold *unfold, int32_t corner) {
    const int32_t end = next_corner(corner);
    const complex_number from = corner_of(unfold, corner);
    return turn(corner_of(unfold, end) - from, corner_of(unfold, next_corner(end)) - from);
}

/* --- the walk ----------------------------------------------------------------------------------------------------- */

/* The triangle across an edge, laid against it; false: there is none, or none that could be laid out. */
static bool cross(const orb_unfold *unfold, int32_t corner, orb_laid *laid) {
    const int32_t other = unfold->across[corner];
    if (other < 0)
        return false;
    const bool reversed = unfold->reversed[corner];
    const int32_t start = reversed ? next_corner(other) : other, end = reversed ? other : next_corner(other);
    const complex_number p = corner_of(unfold, start), p_ = corner_of(unfold, end);
    const complex_number q = corner_of(unfold, corner), q_ = corner_of(unfold, next_corner(corner));
    const double own = side_of(unfold, corner), theirs = reversed ? -side_of(unfold, other) : side_of(unfold, other);
    if (own == 0 || theirs == 0 || !isfinite(own + theirs) || p == p_ || q == q_)
        return false;
    laid->triangle = other / 3;
    if (cabs(p - q) + cabs(p_ - q_) > joined || (own > 0) == (theirs > 0))
        laid->by = after(&laid->by, (own > 0) == (theirs > 0), p, p_, q, q_);
    return true;
}

/* Barycentric coordinates in a triangle's UVs; false: it has no area. */
static bool weights_of(const orb_unfold *unfold, int32_t triangle, complex_number z, double weight[3]) {
    const complex_number a = corner_of(unfold, 3 * triangle), b = corner_of(unfold, 3 * triangle + 1);
    const complex_number c = corner_of(unfold, 3 * triangle + 2);
    const double area = turn(b - a, c - a);
    if (area == 0 || !isfinite(area))
        return false;
    weight[1] = turn(z - a, c - a) / area;
    weight[2] = turn(b - a, z - a) / area;
    weight[0] = 1 - weight[1] - weight[2];
    return true;
}

/* The point of a triangle's sides that is nearest to a point. */
static complex_number beside_triangle(const orb_unfold *unfold, int32_t triangle, complex_number z) {
    complex_number nearest = corner_of(unfold, 3 * triangle);
    for (int32_t corner = 3 * triangle; corner < 3 * triangle + 3; corner++) {
        const complex_number from = corner_of(unfold, corner), along = corner_of(unfold, next_corner(corner)) - from;
        const double length = creal(along) * creal(along) + cimag(along) * cimag(along);
        const double part = length > 0 ? creal(conj(along) * (z - from)) / length : 0;
        const complex_number point = from + fmin(fmax(part, 0), 1) * along;
        if (cabs(z - point) < cabs(z - nearest))
            nearest = point;
    }
    return nearest;
}

void unfold_walk(const orb_unfold *unfold, const double point[2], orb_laid *laid, double at[2]) {
    double weight[3] = {0, 0, 0};
    complex_number z = undone(&laid->by, number(point));
    for (int step = 0; step < MOST_STEPS && weights_of(unfold, laid->triangle, z, weight); step++) {
        int least = weight[1] < weight[0] ? 1 : 0;
        least = weight[2] < weight[least] ? 2 : least;
        /* corner `least` is opposite to the edge that begins at the next one */
        if (weight[least] >= -beside || !cross(unfold, next_corner(3 * laid->triangle + least), laid))
            break;
        z = undone(&laid->by, number(point));
    }
    if (!weights_of(unfold, laid->triangle, z, weight) || fmin(fmin(weight[0], weight[1]), weight[2]) < 0)
        z = beside_triangle(unfold, laid->triangle, z);
    pair_of(z, at);
}
