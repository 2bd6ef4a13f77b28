/* Rational functions that are invariant under a finite rotation group. SPDX-License-Identifier: GPL-3.0-or-later */
#include "quotient.h"

#include <math.h>
#include <stdlib.h>

/* Finding an orbit takes time in its square, and dividing one vertex in the orbit. */
static const int64_t largest_group = 20000;

/* One point of an orbit, z = u / v with |u|^2 + |v|^2 = 1. */
typedef struct root {
    double complex u, v;
    int32_t corner; /* of the tile, if it is one: then z - root is formed from its precise position; else -1 */
} root;

typedef struct form {
    int32_t order, n_roots;
    root *roots;
} form;

/* m 2^e: products over long orbits leave the range of a double */
typedef struct scaled {
    double complex m;
    int64_t e;
} scaled;

struct orb_quotient {
    int32_t n_forms; /* 2 or 3 */
    form forms[3];
    scaled factor[3];
    int32_t n_corners;
    orb_point *corners;
};

static scaled scaled_of(double complex m, int64_t e) {
    int shift = 0;
    frexp(fmax(fabs(creal(m)), fabs(cimag(m))), &shift);
    return (scaled){CMPLX(ldexp(creal(m), -shift), ldexp(cimag(m), -shift)), e + shift};
}

static scaled scaled_multiply(scaled a, scaled b) { return scaled_of(a.m * b.m, a.e + b.e); }
static scaled scaled_divide(scaled a, scaled b) { return scaled_of(a.m / b.m, a.e - b.e); }

static scaled scaled_power(scaled a, int32_t n) {
    scaled power = {1, 0};
    for (; n > 0; n /= 2) {
        if (n % 2)
            power = scaled_multiply(power, a);
        a = scaled_multiply(a, a);
    }
    return power;
}

/* (product over the roots of v z - u)^order */
static scaled form_evaluate(const orb_quotient *quotient, const form *f, orb_point p) {
    scaled product = {1, 0};
    double complex z = p.z + p.low;
    for (int32_t i = 0; i < f->n_roots; i++) {
        const root *r = &f->roots[i];
        double complex factor = r->v * z - r->u;
        if (r->corner >= 0) {
            orb_point corner = quotient->corners[r->corner];
            factor = r->v * ((p.z - corner.z) + (p.low - corner.low));
        }
        product = scaled_multiply(product, scaled_of(factor, 0));
    }
    return scaled_power(product, f->order);
}

/* The sine of half the distance of two points is less than 1e-9. */
static bool same_point(const root *a, const root *b) { return cabs(a->u * b->v - a->v * b->u) < 1e-9; }

static root root_of(double complex u, double complex v) {
    double size = hypot(cabs(u), cabs(v));
    return (root){u / size, v / size, -1};
}

/* The copies of a corner under the group that the side pairings generate: there must be `length`. */
static orb_status find_orbit(const orb_tile *tile, int32_t cone, int64_t length, form *f, orb_error *error) {
    f->order = tile->word->order[cone];
    f->roots = length > 0 ? malloc((size_t)length * sizeof *f->roots) : NULL;
    if (!f->roots)
        return error_memory(error);
    f->roots[0] = root_of(tile->corners[cone].z, 1);
    f->n_roots = 1;
    for (int32_t i = 0; i < f->n_roots; i++)
        for (int32_t s = 0; s < tile->word->n_sides; s++) {
            double complex a = tile->pairings[s].a.z, b = tile->pairings[s].b.z;
            root r = f->roots[i], image = root_of(a * r.u + b * r.v, conj(a) * r.v - conj(b) * r.u);
            bool known = false;
            for (int32_t j = 0; j < f->n_roots && !known; j++)
                known = same_point(&image, &f->roots[j]);
            if (known)
                continue;
            if (f->n_roots == length)
                return error_set(error, ORB_BAD_ARGUMENT, "the tile's side pairings do not generate a finite group");
            f->roots[f->n_roots++] = image;
        }
    if (f->n_roots != length)
        return error_set(error, ORB_BAD_ARGUMENT, "the tile's side pairings do not generate the orbifold's group");
    for (int32_t i = 0; i < f->n_roots; i++)
        for (int32_t c = 0; c < tile->word->n_sides; c++) {
            root corner = root_of(tile->corners[c].z, 1);
            if (same_point(&corner, &f->roots[i])) {
                f->roots[i] = corner;
                f->roots[i].corner = c;
            }
        }
    return ORB_OK;
}

/* Constants that make f - 1 = E / D exactly where f = A / D: f(c_3) = 1 and f(c_1) = 0. */
static void find_factors(orb_quotient *quotient) {
    for (int i = 0; i < 3; i++)
        quotient->factor[i] = (scaled){1, 0};
    if (quotient->n_forms < 3)
        return;
    const form *f = quotient->forms;
    orb_point c1 = quotient->corners[0], c3 = quotient->corners[2];
    quotient->factor[0] = scaled_divide((scaled){1, 0}, form_evaluate(quotient, &f[0], c3));
    quotient->factor[1] = scaled_divide((scaled){1, 0}, form_evaluate(quotient, &f[1], c3));
    scaled d = scaled_multiply(quotient->factor[1], form_evaluate(quotient, &f[1], c1));
    d.m = -d.m;
    quotient->factor[2] = scaled_divide(d, form_evaluate(quotient, &f[2], c1));
}

orb_status quotient_create(const orb_tile *tile, orb_quotient **result, orb_error *error) {
    *result = NULL;
    double euler = 2; /* of the orbifold: the group has 2 / euler elements */
    for (int32_t i = 0; i < tile->word->n_nodes; i++)
        euler -= 1 - 1.0 / tile->word->order[i];
    if (!word_is_path(tile->word) || tile->fixed || tile->word->n_nodes > 3 || !(euler > 0))
        return error_set(error, ORB_BAD_ARGUMENT,
                         "only a spherical orbifold has the whole sphere as its quotient: "
                         "choose a signature such as 33, 225, 332, 432 or 532");
    if (tile->word->n_nodes == 3 && llround(2 / euler) > largest_group)
        return error_set(error, ORB_UNSUPPORTED_SIGNATURE,
                         "the group has %.0f elements, too many to divide the whole sphere by: take orders of at most "
                         "%d, or split the mesh along the seam",
                         2 / euler, (int)(largest_group / 2));
    orb_status status = error_memory(error);
    orb_quotient *quotient = calloc(1, sizeof *quotient);
    if (!quotient)
        return status;
    quotient->n_forms = tile->word->n_nodes;
    quotient->n_corners = tile->word->n_sides;
    quotient->corners = malloc((size_t)quotient->n_corners * sizeof *quotient->corners);
    if (!quotient->corners)
        goto done;
    for (int32_t c = 0; c < quotient->n_corners; c++)
        quotient->corners[c] = tile->corners[c];
    for (int32_t i = 0; i < tile->word->n_nodes; i++) {
        int64_t length = llround(2 / euler / tile->word->order[i]);
        status = find_orbit(tile, i, length, &quotient->forms[i], error);
        if (status != ORB_OK)
            goto done;
    }
    find_factors(quotient);
    *result = quotient;
    quotient = NULL;
    status = error_set(error, ORB_OK, "%s", "");
done:
    quotient_free(quotient);
    return status;
}

void quotient_free(orb_quotient *quotient) {
    if (!quotient)
        return;
    for (int i = 0; i < 3; i++)
        free(quotient->forms[i].roots);
    free(quotient->corners);
    free(quotient);
}

orb_ratio quotient_evaluate(const orb_quotient *quotient, orb_point p) {
    scaled value[3] = {{0, 0}, {0, 0}, {0, 0}};
    for (int32_t i = 0; i < quotient->n_forms; i++)
        value[i] = scaled_multiply(quotient->factor[i], form_evaluate(quotient, &quotient->forms[i], p));
    int64_t e = value[0].m == 0 || (value[1].m != 0 && value[1].e > value[0].e) ? value[1].e : value[0].e;
    double complex w[3];
    for (int i = 0; i < 3; i++) {
        int shift = (int)fmax(-1200, (double)(value[i].e - e)); /* below, it is 0; far above 0 none of them is */
        w[i] = CMPLX(ldexp(creal(value[i].m), shift), ldexp(cimag(value[i].m), shift));
    }
    double size = hypot(cabs(w[0]), cabs(w[1]));
    orb_ratio ratio = {w[0] / size, w[1] / size, w[2] / size};
    if (quotient->n_forms == 2)
        ratio.one = ratio.zero - ratio.pole;
    return ratio;
}
