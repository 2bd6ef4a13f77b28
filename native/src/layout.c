/* Charts of the three geometries. SPDX-License-Identifier: GPL-3.0-or-later */
#include "layout.h"

#include <math.h>
#include <stddef.h>

#include "embedding.h"
#include "lattice.h"
#include "rounding.h"

static const double pi = 3.14159265358979323846;

/* What a chart needs to know beside the point. */
typedef struct chart_frame {
    const orb_geometry *geometry;
    orb_cell cell;       /* periodic */
    double complex east; /* equirectangular: direction of the equator at the origin */
} chart_frame;

typedef enum chart_finish {
    FINISH_NOTHING,
    FINISH_SHIFT, /* by whole numbers: the bounding box's centre comes into [0, 1)^2 */
    FINISH_FIT    /* uniform scale and shift: the bounding box fills [0, 1]^2 in one direction, centred */
} chart_finish;

typedef struct chart_row {
    orb_chart chart;
    const char *name;
    orb_status (*prepare)(const orb_embedding *embedding, chart_frame *frame, orb_error *error); /* may be NULL */
    double complex (*map)(const chart_frame *frame, orb_point p);                                /* u + i v */
    void (*corners)(double complex uv[3]); /* joins the corners of a triangle; may be NULL */
    chart_finish finish;
} chart_row;

static double complex map_plain(const chart_frame *frame, orb_point p) {
    (void)frame;
    return p.z + p.low;
}

/* ----------------------------------------------------------------------------------------------------- plane */

static orb_status prepare_periodic(const orb_embedding *embedding, chart_frame *frame, orb_error *error) {
    return lattice_cell(embedding->tile, &frame->cell, error);
}

static double complex map_periodic(const chart_frame *frame, orb_point p) {
    return lattice_coordinates(&frame->cell, p);
}

/* ---------------------------------------------------------------------------------------------------- sphere */

enum { AXES = 16 };

/* The poles lie a quarter turn from the tile's middle (the chart's origin): of AXES directions of the axis the one
 * that keeps farthest from the layout. If that one touches a pole all the same (a tile as large as a hemisphere), the
 * axis goes through the first cone, so that a pole falls on a vertex and not into a triangle. */
static orb_status prepare_equirectangular(const orb_embedding *embedding, chart_frame *frame, orb_error *error) {
    (void)error;
    const orb_copies *copies = embedding->copies;
    double height[AXES] = {0}; /* greatest sine of a latitude */
    for (int64_t k = 0; k < 3 * (int64_t)embedding->mesh->n_triangles; k++) {
        double complex z = embedding->placed[copies->triangles[k]].z;
        double complex w = 2 * z / (1 + creal(z) * creal(z) + cimag(z) * cimag(z));
        for (int i = 0; i < AXES; i++) {
            double angle = pi * i / AXES;
            height[i] = fmax(height[i], fabs(cimag(w * CMPLX(cos(angle), -sin(angle)))));
        }
    }
    int best = 0;
    for (int i = 1; i < AXES; i++)
        if (height[i] < height[best] - 1e-6)
            best = i;
    double complex cone = embedding->tile->corners[0].z;
    frame->east = CMPLX(cos(pi * best / AXES), sin(pi * best / AXES));
    if (height[best] > sin(85 * pi / 180) && cabs(cone) > 0)
        frame->east = CMPLX(0, -1) * cone / cabs(cone);
    return ORB_OK;
}

/* A pole has no longitude: NAN stands for it until the triangle's other corners are known. */
static double complex map_equirectangular(const chart_frame *frame, orb_point p) {
    double complex z = (p.z + p.low) * conj(frame->east);
    double x = 2 * creal(z), y = 2 * cimag(z), front = 1 - creal(z) * creal(z) - cimag(z) * cimag(z);
    double radius = hypot(x, front);
    double longitude = radius > 1e-12 * (fabs(y) + radius) ? atan2(x, front) / (2 * pi) + 0.5 : NAN;
    return CMPLX(longitude, atan2(y, radius) / pi + 0.5);
}

/* Brings the corners to one side of the date line, that of the first of them with a longitude, and sets a corner at a
 * pole midway between the others. */
static void join_longitudes(double complex uv[3]) {
    int first = isnan(creal(uv[0])) ? 1 : 0;
    for (int c = 0; c < 3; c++)
        if (!isnan(creal(uv[c])))
            uv[c] -= round(creal(uv[c]) - creal(uv[first]));
    for (int c = 0; c < 3; c++)
        if (isnan(creal(uv[c])))
            uv[c] = CMPLX((creal(uv[(c + 1) % 3]) + creal(uv[(c + 2) % 3])) / 2, cimag(uv[c]));
}

/* The octahedron |x| + |y| + |n| = 1 with the tile's middle at n = 1, its lower half folded out over the four
 * edges of the upper one. */
static double complex map_octahedral(const chart_frame *frame, orb_point p) {
    (void)frame;
    double complex z = p.z + p.low;
    double x = 2 * creal(z), y = 2 * cimag(z), n = 1 - creal(z) * creal(z) - cimag(z) * cimag(z);
    double sum = fabs(x) + fabs(y) + fabs(n), a = x / sum, b = y / sum;
    double u = n >= 0 ? a : copysign(1 - fabs(b), a), v = n >= 0 ? b : copysign(1 - fabs(a), b);
    return CMPLX((u + 1) / 2, (v + 1) / 2);
}

/* ------------------------------------------------------------------------------------------------ hyperbolic */

static double complex map_poincare(const chart_frame *frame, orb_point p) {
    (void)frame;
    return CMPLX((creal(p.z) + creal(p.low) + 1) / 2, (cimag(p.z) + cimag(p.low) + 1) / 2);
}

static double complex map_klein(const chart_frame *frame, orb_point p) {
    double complex w = geometry_convex_chart(frame->geometry, p);
    return CMPLX((creal(w) + 1) / 2, (cimag(w) + 1) / 2);
}

/* ----------------------------------------------------------------------------------------------------- table */

static const chart_row charts[] = {
    {ORB_CHART_PERIODIC, "periodic", prepare_periodic, map_periodic, NULL, FINISH_SHIFT},
    {ORB_CHART_CONFORMAL, "conformal", NULL, map_plain, NULL, FINISH_FIT},
    {ORB_CHART_STEREOGRAPHIC, "stereographic", NULL, map_plain, NULL, FINISH_FIT},
    {ORB_CHART_EQUIRECTANGULAR, "equirectangular", prepare_equirectangular, map_equirectangular, join_longitudes,
     FINISH_NOTHING},
    {ORB_CHART_OCTAHEDRAL, "octahedral", NULL, map_octahedral, NULL, FINISH_NOTHING},
    {ORB_CHART_POINCARE, "Poincaré", NULL, map_poincare, NULL, FINISH_NOTHING},
    {ORB_CHART_KLEIN, "Klein", NULL, map_klein, NULL, FINISH_NOTHING},
};
enum { N_CHARTS = sizeof charts / sizeof *charts };

static const chart_row *row_of(orb_chart chart) {
    for (int i = 0; i < N_CHARTS; i++)
        if (charts[i].chart == chart)
            return &charts[i];
    return NULL;
}

/* NULL for the chart of another geometry. */
static const chart_row *find_chart(orb_chart chart, const orb_geometry *geometry) {
    orb_chart first = geometry_first_chart(geometry), wanted = chart == ORB_CHART_DEFAULT ? first : chart;
    return wanted >= first && wanted <= geometry_last_chart(geometry) ? row_of(wanted) : NULL;
}

static orb_status error_no_chart(orb_chart chart, const orb_geometry *geometry, orb_error *error) {
    const chart_row *row = row_of(chart);
    const char *fit[N_CHARTS + 1] = {0};
    int n = 0;
    for (int i = 0; i < N_CHARTS; i++)
        if (find_chart(charts[i].chart, geometry))
            fit[n++] = charts[i].name;
    return error_set(error, ORB_BAD_ARGUMENT, "the chart %s%s does not fit a layout that is %s: choose %s%s%s%s%s",
                     row ? "" : "asked for", row ? row->name : "", geometry_name(geometry), fit[0], n > 2 ? ", " : "",
                     n > 2 ? fit[1] : "", n > 1 ? " or " : "", n > 1 ? fit[n - 1] : "");
}

static void finish_uv(chart_finish finish, int64_t n_corners, double *uv) {
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int64_t k = 0; k < 2 * n_corners; k++) {
        low[k % 2] = fmin(low[k % 2], uv[k]);
        high[k % 2] = fmax(high[k % 2], uv[k]);
    }
    double size = fmax(high[0] - low[0], high[1] - low[1]);
    for (int64_t k = 0; k < 2 * n_corners; k++) {
        double middle = low[k % 2] + (high[k % 2] - low[k % 2]) / 2;
        if (finish == FINISH_SHIFT)
            uv[k] -= floor(middle);
        else if (finish == FINISH_FIT) /* clipped: the rounding may leave the square by a last digit */
            uv[k] = fmin(1, fmax(0, 0.5 + (size > 0 ? (uv[k] - middle) / size : 0)));
    }
}

int64_t layout_flipped_float32(int32_t n_triangles, const double *uv) {
    int64_t flipped = 0;
    for (int32_t t = 0; t < n_triangles; t++) {
        double f[6];
        for (int k = 0; k < 6; k++)
            f[k] = rounding_to_float(uv[6 * (int64_t)t + k]);
        flipped += !((f[2] - f[0]) * (f[5] - f[1]) - (f[4] - f[0]) * (f[3] - f[1]) > 0);
    }
    return flipped;
}

ORB_API orb_status orb_uv(const orb_embedding *embedding, orb_chart chart, double *uv, int64_t *flipped_float32,
                          orb_error *error) {
    if (!embedding || !uv)
        return error_set(error, ORB_BAD_ARGUMENT, "%s is missing: pass one", uv ? "the embedding" : "the array uv");
    chart_frame frame = {.geometry = embedding->tile->geometry};
    if (chart == ORB_CHART_DEFAULT && embedding->tile->fixed && geometry_has_translations(frame.geometry))
        chart = ORB_CHART_CONFORMAL; /* a polygon is no tile, and has no period */
    const chart_row *row = find_chart(chart, frame.geometry);
    if (!row)
        return error_no_chart(chart, frame.geometry, error);
    orb_status status = row->prepare ? row->prepare(embedding, &frame, error) : ORB_OK;
    if (status != ORB_OK)
        return status;
    int32_t n_triangles = embedding->mesh->n_triangles;
    for (int32_t t = 0; t < n_triangles; t++) {
        const int32_t *copy = embedding->copies->triangles + 3 * (int64_t)t;
        double complex corner[3];
        for (int c = 0; c < 3; c++)
            corner[c] = row->map(&frame, embedding->placed[copy[c]]);
        if (row->corners)
            row->corners(corner);
        for (int c = 0; c < 3; c++) {
            uv[6 * (int64_t)t + 2 * c] = creal(corner[c]);
            uv[6 * (int64_t)t + 2 * c + 1] = cimag(corner[c]);
        }
    }
    finish_uv(row->finish, 3 * (int64_t)n_triangles, uv);
    if (flipped_float32)
        *flipped_float32 = layout_flipped_float32(n_triangles, uv);
    return error_set(error, ORB_OK, "%s", "");
}
