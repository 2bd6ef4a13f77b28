/* Real and complex numbers as unevaluated sums of two doubles. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * About 31 decimal digits, by the error-free transformations of Dekker 1971 and Knuth. Needs -ffp-contract=off and no
 * -ffast-math. Only what geometry.c uses is here. */
#ifndef ORB_DOUBLE_DOUBLE_H
#define ORB_DOUBLE_DOUBLE_H

#include <complex.h>
#include <math.h>

typedef struct dd {
    double hi, lo;
} dd;

/* a + b exactly, when |a| >= |b| */
static inline dd dd_quick_sum(double a, double b) {
    double s = a + b;
    return (dd){s, b - (s - a)};
}

/* a + b exactly */
static inline dd dd_two_sum(double a, double b) {
    double s = a + b, v = s - a;
    return (dd){s, (a - (s - v)) + (b - v)};
}

/* a * b exactly (Veltkamp's split; no overflow for the magnitudes of a bounded chart) */
static inline dd dd_two_product(double a, double b) {
    double p = a * b, c = 134217729.0 * a, d = 134217729.0 * b; /* 2^27 + 1 */
    double a_hi = c - (c - a), a_lo = a - a_hi, b_hi = d - (d - b), b_lo = b - b_hi;
    return (dd){p, ((a_hi * b_hi - p) + a_hi * b_lo + a_lo * b_hi) + a_lo * b_lo};
}

static inline dd dd_of(double a) { return (dd){a, 0}; }
static inline dd dd_negative(dd a) { return (dd){-a.hi, -a.lo}; }

static inline dd dd_add(dd a, dd b) {
    dd s = dd_two_sum(a.hi, b.hi), t = dd_two_sum(a.lo, b.lo);
    s = dd_quick_sum(s.hi, s.lo + t.hi);
    return dd_quick_sum(s.hi, s.lo + t.lo);
}

static inline dd dd_multiply(dd a, dd b) {
    dd p = dd_two_product(a.hi, b.hi);
    return dd_quick_sum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
}

static inline dd dd_divide(dd a, dd b) {
    double q = a.hi / b.hi;
    dd rest = dd_add(a, dd_negative(dd_multiply(dd_of(q), b)));
    double q2 = rest.hi / b.hi;
    rest = dd_add(rest, dd_negative(dd_multiply(dd_of(q2), b)));
    return dd_add(dd_quick_sum(q, q2), dd_of(rest.hi / b.hi));
}

static inline dd dd_sqrt(dd a) {
    if (!(a.hi > 0))
        return dd_of(0);
    double x = sqrt(a.hi);
    dd rest = dd_add(a, dd_negative(dd_two_product(x, x)));
    return dd_quick_sum(x, rest.hi / (2 * x));
}

/* A complex number, value and low part. */
typedef struct ddc {
    dd re, im;
} ddc;

static inline ddc ddc_conjugate(ddc a) { return (ddc){a.re, dd_negative(a.im)}; }
static inline ddc ddc_add(ddc a, ddc b) { return (ddc){dd_add(a.re, b.re), dd_add(a.im, b.im)}; }
static inline ddc ddc_scale(ddc a, dd s) { return (ddc){dd_multiply(a.re, s), dd_multiply(a.im, s)}; }
static inline dd ddc_norm(ddc a) { return dd_add(dd_multiply(a.re, a.re), dd_multiply(a.im, a.im)); }

static inline ddc ddc_multiply(ddc a, ddc b) {
    return (ddc){dd_add(dd_multiply(a.re, b.re), dd_negative(dd_multiply(a.im, b.im))),
                 dd_add(dd_multiply(a.re, b.im), dd_multiply(a.im, b.re))};
}

static inline ddc ddc_divide(ddc a, ddc b) {
    ddc n = ddc_multiply(a, ddc_conjugate(b));
    dd s = ddc_norm(b);
    return (ddc){dd_divide(n.re, s), dd_divide(n.im, s)};
}

#endif
