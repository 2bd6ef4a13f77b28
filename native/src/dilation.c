/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dilation.h"

#include <math.h>
#include <stdlib.h>

#include "shape.h"

enum { SAMPLES = 24, HALVINGS = 40 };
static const double pi = 3.14159265358979323846, golden = 0.6180339887498949;

bool dilation_is_free(const orb_signature *s) {
    return s && s->curvature > 0 && s->n_handles + s->n_crosscaps == 0 &&
           ((s->n_cones == 2 && s->n_mirrors == 0) || (s->n_cones == 0 && s->n_mirrors == 1 && s->n_corners == 2));
}

double dilation_log_cosh(double x) { return fabs(x) + log1p(exp(-2 * fabs(x))) - log(2); }

static double variance(int32_t n, const double *weight, const double *base, const double *height, double shift) {
    double total = 0, mean = 0, square = 0;
    for (int32_t k = 0; k < n; k++) {
        const double value = base[k] - 2 * dilation_log_cosh(height[k] + shift);
        total += weight[k];
        mean += weight[k] * value;
        square += weight[k] * value * value;
    }
    mean /= total;
    return square / total - mean * mean;
}

double dilation_of_least_spread(int32_t n, const double *weight, const double *base, const double *height) {
    double low = INFINITY, high = -INFINITY, best = 0, least = INFINITY;
    for (int32_t k = 0; k < n; k++)
        if (weight[k] > 0) {
            low = fmin(low, -height[k]);
            high = fmax(high, -height[k]);
        }
    if (!(high > low))
        return 0;
    const double step = (high - low) / SAMPLES;
    for (int k = 0; k <= SAMPLES; k++) {
        const double shift = low + k * step, value = variance(n, weight, base, height, shift);
        if (value < least) {
            least = value;
            best = shift;
        }
    }
    double a = best - step, b = best + step, c = b - golden * (b - a), d = a + golden * (b - a);
    double at_c = variance(n, weight, base, height, c), at_d = variance(n, weight, base, height, d);
    for (int k = 0; k < HALVINGS && b - a > 1e-4; k++) {
        if (at_c < at_d) {
            b = d;
            d = c;
            at_d = at_c;
            c = b - golden * (b - a);
            at_c = variance(n, weight, base, height, c);
        } else {
            a = c;
            c = d;
            at_c = at_d;
            d = a + golden * (b - a);
            at_d = variance(n, weight, base, height, d);
        }
    }
    return 0.5 * (a + b);
}

/* --- of an embedding --------------------------------------------------------------------------------------------- */

/* Of each triangle its area on the mesh, log area by which it grows, were it at height 0, and its height, that of the mean
 * distance of its corners from the first cone. */
static void measure(const orb_embedding *embedding, const double *area, double *weight, double *base, double *height) {
    const orb_geometry *geometry = embedding->tile->geometry;
    const orb_point pole = embedding->position[embedding->surface->vertex[0]];
    for (int32_t t = 0; t < embedding->mesh->n_triangles; t++) {
        double distance = 0;
        orb_point p[3];
        for (int c = 0; c < 3; c++) {
            p[c] = embedding->placed[embedding->copies->triangles[3 * t + c]];
            distance += geometry_distance(geometry, pole, p[c]) / 3;
        }
        const double image = geometry_triangle_area(geometry, geometry_toward(geometry, p[0], p[1]),
                                                    geometry_toward(geometry, p[0], p[2]));
        const bool counts = image > 0 && area[t] > 0 && distance > 0 && distance < pi;
        weight[t] = counts ? area[t] : 0;
        height[t] = counts ? log(tan(0.5 * distance)) : 0;
        base[t] = counts ? log(image / area[t]) + 2 * dilation_log_cosh(height[t]) : 0;
    }
}

static void dilate(orb_embedding *embedding, double shift) {
    const orb_geometry *geometry = embedding->tile->geometry;
    const int32_t *pole = embedding->surface->vertex;
    const orb_isometry to_pole = isometry_to_origin(geometry, embedding->position[pole[0]]);
    const orb_isometry back = isometry_inverse(to_pole);
    for (int32_t v = 0; v < embedding->mesh->n_vertices; v++) {
        if (v == pole[0] || v == pole[1] || embedding->mesh->vertex_halfedge[v] < 0)
            continue;
        const orb_point p = isometry_apply(geometry, to_pole, embedding->position[v]);
        embedding->position[v] = isometry_apply(geometry, back, point_linear(exp(shift), 0, p));
    }
}

orb_status dilation_choose(orb_embedding *embedding, orb_error *error) {
    const orb_mesh *mesh = embedding->mesh;
    const size_t room = (size_t)mesh->n_triangles + 1;
    orb_shape shape = {0};
    double *lengths = malloc(((size_t)mesh->n_edges + 1) * sizeof *lengths), *weight = malloc(room * sizeof *weight);
    double *base = malloc(room * sizeof *base), *height = malloc(room * sizeof *height);
    const bool fine = shape_allocate(&shape, mesh) && lengths && weight && base && height;
    if (fine) {
        shape_lengths(mesh, lengths);
        shape_measure(mesh, lengths, lengths, &shape);
        measure(embedding, shape.triangle_area, weight, base, height);
        dilate(embedding, dilation_of_least_spread(mesh->n_triangles, weight, base, height));
    }
    shape_clear(&shape);
    free(lengths);
    free(weight);
    free(base);
    free(height);
    return fine ? ORB_OK : error_memory(error);
}
