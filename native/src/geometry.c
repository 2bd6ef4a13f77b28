/* The three geometries in one chart. SPDX-License-Identifier: GPL-3.0-or-later */
#include "geometry.h"

#include <stddef.h>

#include "double_double.h"

struct orb_geometry {
    int K;
    const char *name;
    orb_chart first_chart, last_chart;
    bool any_start;
    double longest_step;
    double (*tan)(double), (*atan)(double);
};

static double same(double r) { return r; }

static const orb_geometry geometries[] = {
    {-1, "hyperbolic", ORB_CHART_POINCARE, ORB_CHART_KLEIN, false, INFINITY, tanh, atanh},
    {0, "euclidean", ORB_CHART_PERIODIC, ORB_CHART_CONFORMAL, true, INFINITY, same, same},
    {+1, "spherical", ORB_CHART_STEREOGRAPHIC, ORB_CHART_OCTAHEDRAL, false, 0.5, tan, atan},
};

const orb_geometry *geometry_of_curvature(int curvature) { return &geometries[1 + (curvature > 0) - (curvature < 0)]; }
const char *geometry_name(const orb_geometry *geometry) { return geometry->name; }
int geometry_curvature(const orb_geometry *geometry) { return geometry->K; }
orb_chart geometry_first_chart(const orb_geometry *geometry) { return geometry->first_chart; }
orb_chart geometry_last_chart(const orb_geometry *geometry) { return geometry->last_chart; }
bool geometry_any_start(const orb_geometry *geometry) { return geometry->any_start; }
bool geometry_has_translations(const orb_geometry *geometry) { return geometry->K == 0; }
double geometry_longest_step(const orb_geometry *geometry) { return geometry->longest_step; }

/* ---------------------------------------------------------------------------------------- double-double and back */

static ddc wide(orb_point p) { return (ddc){{creal(p.z), creal(p.low)}, {cimag(p.z), cimag(p.low)}}; }

static orb_point narrow(ddc a) { return (orb_point){CMPLX(a.re.hi, a.im.hi), CMPLX(a.re.lo, a.im.lo)}; }

/* K times a */
static ddc curved(const orb_geometry *geometry, ddc a) { return ddc_scale(a, dd_of(geometry->K)); }

/* 1 + K |z|^2, the conformal factor's denominator */
static dd conformal(const orb_geometry *geometry, orb_point p) {
    return dd_add(dd_of(1), dd_multiply(dd_of(geometry->K), ddc_norm(wide(p))));
}

/* the same in double, exact to the last digit: what is left of 1 - |z|^2 far out is all that counts there */
static double conformal_factor(const orb_geometry *geometry, orb_point p) {
    double x = creal(p.z), y = cimag(p.z);
    if (geometry->K >= 0)
        return 1 + geometry->K * (x * x + y * y);
    dd xx = dd_two_product(x, x), yy = dd_two_product(y, y);
    dd s = dd_two_sum(1, -xx.hi), t = dd_two_sum(s.hi, -yy.hi);
    return t.hi + (t.lo + s.lo - xx.lo - yy.lo - 2 * (x * creal(p.low) + y * cimag(p.low)));
}

/* ---------------------------------------------------------------------------------------------------- points */

orb_point point_of(double complex z) { return (orb_point){z, 0}; }
orb_point point_conjugate(orb_point p) { return (orb_point){conj(p.z), conj(p.low)}; }

orb_point point_linear(double complex a, double complex b, orb_point p) {
    ddc z = wide(p);
    return narrow(ddc_add(ddc_multiply(wide(point_of(a)), z), ddc_multiply(wide(point_of(b)), ddc_conjugate(z))));
}

double complex geometry_toward(const orb_geometry *geometry, orb_point p, orb_point q) {
    double complex difference = (q.z - p.z) + (q.low - p.low);
    return difference / (conformal_factor(geometry, p) + geometry->K * conj(p.z) * difference);
}

double complex geometry_seen(const orb_geometry *geometry, orb_point p, orb_point q) {
    const double complex t = geometry_toward(geometry, p, q);
    const double r = modulus(t);
    return 2 / (1 + geometry->K * r * r) * t;
}

/* atan_K(r) / r */
static double atan_ratio(const orb_geometry *geometry, double r) { return r > 0 ? geometry->atan(r) / r : 1; }

double geometry_distance(const orb_geometry *geometry, orb_point p, orb_point q) {
    return 2 * geometry->atan(modulus(geometry_toward(geometry, p, q)));
}

bool geometry_is_antipodal(const orb_geometry *geometry, orb_point p, orb_point q) {
    return geometry->K > 0 && !(cabs(geometry_toward(geometry, p, q)) < 1e6);
}

double complex geometry_log(const orb_geometry *geometry, orb_point p, orb_point q) {
    double complex t = geometry_toward(geometry, p, q);
    return 2 * atan_ratio(geometry, modulus(t)) * t;
}

orb_point geometry_exp(const orb_geometry *geometry, orb_point p, double complex v) {
    double length = modulus(v);
    double complex t = length > 0 ? geometry->tan(length / 2) / length * v : 0;
    double complex step = t * conformal_factor(geometry, p) / (1 - geometry->K * conj(p.z) * t);
    dd re = dd_add((dd){creal(p.z), creal(p.low)}, dd_of(creal(step)));
    dd im = dd_add((dd){cimag(p.z), cimag(p.low)}, dd_of(cimag(step)));
    return narrow((ddc){re, im});
}

orb_edge_terms geometry_edge(const orb_geometry *geometry, orb_point p, orb_point q) {
    /* toward p -> q is difference / at_p, and q -> p is -difference / at_q. With r = tan_K(d / 2):
     * tan_K d = 2 r / (1 - K r^2),  sin_K d = 2 r / (1 + K r^2). */
    double complex difference = (q.z - p.z) + (q.low - p.low);
    double complex at_p = conformal_factor(geometry, p) + geometry->K * conj(p.z) * difference;
    double complex at_q = conformal_factor(geometry, q) - geometry->K * conj(q.z) * difference;
    double size = modulus(difference), size_p = modulus(at_p), size_q = modulus(at_q);
    double r = size / size_p, ratio = atan_ratio(geometry, r), bend = geometry->K * r * r;
    orb_edge_terms edge = {2 * r * ratio, 1, 1, ratio * (1 - bend), ratio * (1 + bend)};
    if (size > 0) {
        edge.at_p = conj(at_p) * difference / (size_p * size);
        edge.at_q = conj(at_q) * difference / (size_q * size);
    }
    return edge;
}

double complex geometry_transport(const orb_geometry *geometry, orb_point p, orb_point q) {
    orb_edge_terms edge = geometry_edge(geometry, p, q);
    return edge.at_q * conj(edge.at_p);
}

double geometry_triangle_area(const orb_geometry *geometry, double complex s, double complex t) {
    double complex c = conj(s) * t;
    if (geometry->K == 0)
        return 2 * cimag(c);
    return 2 * atan2(cimag(c), 1 + geometry->K * creal(c)); /* the angle excess, or defect, halved: arg(1 + K c) / K */
}

/* With t = toward(p, corner) = D / d the weights are (1 + K |t_j|^2) Im(conj(t_k) t_l), up to one factor. As
 * |d|^2 + K |D|^2 = (1 + K |p|^2) (1 + K |corner|^2), nothing is divided by a d that may vanish, and nothing cancels.
 * */
void geometry_locate(const orb_geometry *geometry, orb_point p, const orb_point corners[3], double weight[3],
                     double sine[3]) {
    double complex toward[3]; /* D conj(d), that is t |d|^2 */
    double factor = conformal_factor(geometry, p), size[3], total = 0, largest = 0;
    for (int k = 0; k < 3; k++) {
        double complex difference = (corners[k].z - p.z) + (corners[k].low - p.low);
        double complex d = factor + geometry->K * conj(p.z) * difference;
        double scale = modulus(difference), of_d = modulus(d), over = scale > of_d ? scale : of_d;
        toward[k] = difference / over * conj(d / over);
        size[k] = scale / over * (of_d / over);
        weight[k] = conformal_factor(geometry, corners[k]) / (over * over);
    }
    for (int k = 0; k < 3; k++) {
        int next = (k + 1) % 3, last = (k + 2) % 3;
        double cross = cimag(conj(toward[next]) * toward[last]), both = size[next] * size[last];
        sine[k] = both == 0 ? 0 : cross / both; /* what is no number stays none */
        weight[k] *= cross;
        total += weight[k];
        largest = fmax(largest, fabs(weight[k]));
    }
    for (int k = 0; k < 3; k++)
        weight[k] = largest > 0 ? weight[k] / (fabs(total) > 0 ? total : largest) : 0;
}

/* cos_K of the distance */
static double cosine(const orb_geometry *geometry, orb_point p, orb_point q) {
    double r = modulus(geometry_toward(geometry, p, q)), bend = geometry->K * r * r;
    return (1 - bend) / (1 + bend);
}

orb_point geometry_between(const orb_geometry *geometry, const orb_point corners[3], const double weight[3]) {
    int base = weight[1] > weight[0] ? 1 : 0;
    base = weight[2] > weight[base] ? 2 : base;
    double complex w = 0;
    double height = 0, square = 0; /* the sum's last coordinate with the base at the origin; <sum, sum> / K */
    for (int k = 0; k < 3; k++) {
        int next = (k + 1) % 3;
        double complex t = geometry_toward(geometry, corners[base], corners[k]);
        double r = modulus(t), bend = geometry->K * r * r;
        w += weight[k] * 2 / (1 + bend) * t;
        height += weight[k] * (1 - bend) / (1 + bend);
        square += weight[k] * (weight[k] + 2 * weight[next] * cosine(geometry, corners[k], corners[next]));
    }
    orb_isometry home = isometry_to_origin(geometry, corners[base]);
    return isometry_apply(geometry, isometry_inverse(home), point_of(w / (height + sqrt(square))));
}

void geometry_slopes(const orb_geometry *geometry, orb_point p, const orb_point corners[3], const double weight[3],
                     double complex slope[3]) {
    double height = 0;
    for (int k = 0; k < 3; k++) {
        double complex t = geometry_toward(geometry, p, corners[k]);
        double r = modulus(t), bend = geometry->K * r * r;
        slope[k] = 2 / (1 + bend) * t;
        height += weight[k] * (1 - bend) / (1 + bend);
    }
    for (int k = 0; k < 3; k++)
        slope[k] /= height;
}

void geometry_coordinates(const orb_geometry *geometry, orb_point p, double value[3], double low[3]) {
    ddc z = wide(p);
    dd factor = conformal(geometry, p);
    dd x[3] = {dd_add(z.re, z.re), dd_add(z.im, z.im), dd_add(dd_of(2), dd_negative(factor))};
    for (int k = 0; k < 3; k++) {
        dd quotient = dd_divide(x[k], factor);
        value[k] = quotient.hi;
        low[k] = quotient.lo;
    }
}

double complex geometry_convex_chart(const orb_geometry *geometry, orb_point p) {
    double x = creal(p.z), y = cimag(p.z);
    return 2 * p.z / (1 + geometry->K * geometry->K * (x * x + y * y));
}

orb_point geometry_from_convex_chart(const orb_geometry *geometry, double complex w) {
    double x = creal(w), y = cimag(w);
    return point_of(w / (1 + sqrt(fmax(0, 1 - geometry->K * geometry->K * (x * x + y * y)))));
}

/* ------------------------------------------------------------------------------------------------- isometries */

orb_isometry isometry_identity(void) { return (orb_isometry){point_of(1), point_of(0), false}; }

static orb_point conjugate_if(bool condition, orb_point p) { return condition ? point_conjugate(p) : p; }

/* Only the ratio of a and b counts: keep |a| within [1, 2) by an exact power of two. */
static orb_isometry scaled(ddc a, ddc b) {
    int exponent = 0;
    frexp(hypot(a.re.hi, a.im.hi), &exponent);
    dd scale = dd_of(ldexp(1, 1 - exponent));
    return (orb_isometry){narrow(ddc_scale(a, scale)), narrow(ddc_scale(b, scale)), false};
}

orb_isometry isometry_compose(const orb_geometry *geometry, orb_isometry outer, orb_isometry inner) {
    /* conj((a z + b) / (conj(a) - K conj(b) z)) is the map of conj(z) with conj(a), conj(b) */
    ddc a1 = wide(outer.a), b1 = wide(outer.b);
    ddc a2 = wide(conjugate_if(outer.reflects, inner.a)), b2 = wide(conjugate_if(outer.reflects, inner.b));
    ddc a = ddc_add(ddc_multiply(a1, a2), curved(geometry, ddc_scale(ddc_multiply(b1, ddc_conjugate(b2)), dd_of(-1))));
    ddc b = ddc_add(ddc_multiply(a1, b2), ddc_multiply(b1, ddc_conjugate(a2)));
    orb_isometry product = scaled(a, b);
    product.reflects = outer.reflects != inner.reflects;
    return product;
}

orb_isometry isometry_inverse(orb_isometry h) {
    orb_point b = conjugate_if(h.reflects, h.b);
    return (orb_isometry){conjugate_if(!h.reflects, h.a), {-b.z, -b.low}, h.reflects};
}

/* conj(a) - K conj(b) z */
static ddc denominator(const orb_geometry *geometry, orb_isometry h, ddc z) {
    ddc bz = ddc_multiply(ddc_conjugate(wide(h.b)), z);
    return ddc_add(ddc_conjugate(wide(h.a)), curved(geometry, ddc_scale(bz, dd_of(-1))));
}

orb_point isometry_apply(const orb_geometry *geometry, orb_isometry h, orb_point p) {
    ddc z = wide(conjugate_if(h.reflects, p));
    return narrow(ddc_divide(ddc_add(ddc_multiply(wide(h.a), z), wide(h.b)), denominator(geometry, h, z)));
}

double complex isometry_turn(const orb_geometry *geometry, orb_isometry h, orb_point p) {
    double complex q = conj(narrow(denominator(geometry, h, wide(conjugate_if(h.reflects, p)))).z), unit = q / cabs(q);
    return unit * unit;
}

orb_isometry isometry_to_origin(const orb_geometry *geometry, orb_point p) {
    (void)geometry; /* z -> (z - p) / (1 + K conj(p) z) in all three */
    return (orb_isometry){point_of(1), {-p.z, -p.low}, false};
}

orb_isometry isometry_rotation_about_origin(double angle) {
    return (orb_isometry){point_of(CMPLX(cos(angle / 2), sin(angle / 2))), point_of(0), false};
}

/* The rotation about the origin that takes the direction of s to that of t: a is on the bisector. */
static orb_isometry rotation_between(orb_point s, orb_point t) {
    ddc turn = ddc_multiply(wide(t), ddc_conjugate(wide(s)));
    dd size = dd_sqrt(ddc_norm(turn));
    ddc a = turn;
    if (turn.re.hi >= 0) {
        a.re = dd_add(turn.re, size);
    } else { /* i (|u| - u), for directions nearly opposite */
        a.re = turn.im;
        a.im = dd_add(size, dd_negative(turn.re));
    }
    return scaled(a, (ddc){dd_of(0), dd_of(0)});
}

orb_isometry isometry_pairing(const orb_geometry *geometry, orb_point p, orb_point q, orb_point p1, orb_point q1) {
    orb_isometry home = isometry_to_origin(geometry, p), home1 = isometry_to_origin(geometry, p1);
    orb_isometry turn = rotation_between(isometry_apply(geometry, home, q), isometry_apply(geometry, home1, q1));
    return isometry_compose(geometry, isometry_inverse(home1), isometry_compose(geometry, turn, home));
}

orb_isometry isometry_reflection(const orb_geometry *geometry, orb_point p, orb_point q, orb_point p1, orb_point q1) {
    orb_isometry h = isometry_pairing(geometry, point_conjugate(p), point_conjugate(q), p1, q1);
    h.reflects = true;
    return h;
}

/* With w = x + i y and t the coordinates, and n = |a|^2 + K |b|^2:
 *     w -> (a^2 w - K b^2 conj(w) + 2 a b t) / n,   t -> ((|a|^2 - K |b|^2) t - 2 K Re(a conj(b) w)) / n */
void isometry_matrix(const orb_geometry *geometry, orb_isometry h, double matrix[9]) {
    int K = geometry->K;
    double complex a = h.a.z + h.a.low, b = h.b.z + h.b.low;
    double aa = creal(a * conj(a)), bb = creal(b * conj(b)), n = aa + K * bb;
    for (int column = 0; column < 3; column++) {
        double complex w = column == 0 ? 1 : column == 1 ? CMPLX(0, h.reflects ? -1 : 1) : 0;
        double t = column == 2;
        double complex image = (a * a * w - K * b * b * conj(w) + 2 * t * a * b) / n;
        matrix[column] = creal(image);
        matrix[3 + column] = cimag(image);
        matrix[6 + column] = ((aa - K * bb) * t - 2 * K * creal(a * conj(b) * w)) / n;
    }
}

bool isometry_same(const orb_geometry *geometry, orb_isometry g, orb_isometry h, double tolerance) {
    orb_point origin = point_of(0), g0 = isometry_apply(geometry, g, origin), h0 = isometry_apply(geometry, h, origin);
    double complex turn = isometry_turn(geometry, g, origin) - isometry_turn(geometry, h, origin);
    return g.reflects == h.reflects && geometry_distance(geometry, g0, h0) <= tolerance && cabs(turn) <= tolerance;
}
