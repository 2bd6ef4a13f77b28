/* How a surface map stretches angles and areas. SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "pieces.h"
#include "surface_map.h"

/* A real 2 x 2 matrix by rows. */
typedef struct matrix2 {
    double a, b, c, d;
} matrix2;

static matrix2 times(matrix2 m, matrix2 n) {
    return (matrix2){m.a * n.a + m.b * n.c, m.a * n.b + m.b * n.d, m.c * n.a + m.d * n.c, m.c * n.b + m.d * n.d};
}

static double determinant(matrix2 m) { return m.a * m.d - m.b * m.c; }

static matrix2 inverse(matrix2 m) {
    const double det = determinant(m);
    return (matrix2){m.d / det, -m.b / det, -m.c / det, m.a / det};
}

/* Edges 0 -> 1 and 0 -> 2 of a triangle as columns, in its own plane with the first along the x axis. */
static matrix2 edges_of(const orb_mesh *mesh, int32_t t) {
    const int32_t *v = mesh->triangles + 3 * (size_t)t;
    double e[3], f[3], along = 0, length = 0, size = 0;
    for (int k = 0; k < 3; k++) {
        e[k] = mesh->vertices[3 * (size_t)v[1] + (size_t)k] - mesh->vertices[3 * (size_t)v[0] + (size_t)k];
        f[k] = mesh->vertices[3 * (size_t)v[2] + (size_t)k] - mesh->vertices[3 * (size_t)v[0] + (size_t)k];
        length += e[k] * e[k];
        along += e[k] * f[k];
    }
    const double cross[3] = {e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]};
    for (int k = 0; k < 3; k++)
        size += cross[k] * cross[k];
    length = sqrt(length);
    return (matrix2){length, along / length, 0, sqrt(size) / length};
}

/* The same on the tile, as seen from p, where its differential counts. */
static matrix2 image_edges(const orb_geometry *geometry, orb_point p, const orb_point corner[3],
                           const double weight[3]) {
    double complex slope[3];
    geometry_slopes(geometry, p, corner, weight, slope);
    const double complex s = slope[1] - slope[0], t = slope[2] - slope[0];
    return (matrix2){creal(s), creal(t), cimag(s), cimag(t)};
}

/* The differential in the middle of an input triangle, or of the piece of it that has that; *there: it is defined. */
static orb_status differential(orb_overlay *overlay, int32_t triangle, matrix2 *result, double *area, bool *there,
                               orb_error *error) {
    static const double middle[3] = {1.0 / 3, 1.0 / 3, 1.0 / 3};
    const orb_cover *cover = &overlay->cover;
    const orb_embedding *source = cover->source, *target = cover->target;
    const orb_geometry *geometry = cover->geometry;
    orb_point from[3], to[3];
    double unused[3];
    int32_t piece = 0, input;
    orb_spot spot;
    pieces_find(source, triangle, middle, &piece, unused);
    orb_status status = overlay_locate(overlay, piece, middle, &spot, error);
    if (status != ORB_OK)
        return status;
    pieces_join(target, spot.sheet.triangle, spot.weight, &input, unused);
    for (int c = 0; c < 3; c++) {
        const int32_t u = source->copies->triangles[3 * (size_t)piece + (size_t)c];
        from[c] = isometry_apply(geometry, cover->elements[spot.sheet.element], cover->placed[u]);
        to[c] = target->placed[target->copies->triangles[3 * (size_t)spot.sheet.triangle + (size_t)c]];
    }
    const orb_point p = geometry_between(geometry, from, middle);
    const matrix2 on_source = edges_of(source->mesh, piece), on_target = edges_of(target->mesh, spot.sheet.triangle);
    const matrix2 out = times(image_edges(geometry, p, from, middle), inverse(on_source));
    *result = times(times(on_target, inverse(image_edges(geometry, p, to, spot.weight))), out);
    if (cover->elements[spot.sheet.element].reflects) { /* over a cross-cap: seen from the other side */
        result->a = -result->a;
        result->b = -result->b;
    }
    *area = mesh_triangle_area(source->surface->plain, triangle);
    *there = input >= 0 && determinant(on_source) > 0 && determinant(on_target) > 0;
    return ORB_OK;
}

/* Sums over triangles, weighted by area. */
typedef struct sums {
    double area, ratio, log_area, square;
} sums;

static void count(matrix2 m, double area, sums *sum, orb_map_distortion *all, double *ratio, double *log_area) {
    const double det = determinant(m);
    if (!(det > 0)) {
        all->flipped++;
        return;
    }
    const double half = (m.a * m.a + m.b * m.b + m.c * m.c + m.d * m.d) / (2 * det); /* (ratio + 1 / ratio) / 2 */
    *ratio = half + sqrt(fmax(0, half * half - 1));
    *log_area = log(det);
    all->quasi_conformal_max = fmax(all->quasi_conformal_max, *ratio);
    sum->area += area;
    sum->ratio += area * *ratio;
    sum->log_area += area * *log_area;
    sum->square += area * *log_area * *log_area;
}

static void finish(const sums *sum, orb_map_distortion *all) {
    if (!(sum->area > 0))
        return;
    all->quasi_conformal_mean = sum->ratio / sum->area;
    all->log_area_mean = sum->log_area / sum->area;
    all->log_area_std = sqrt(fmax(0, sum->square / sum->area - all->log_area_mean * all->log_area_mean));
}

orb_status orb_surface_map_distortion(const orb_embedding *source, const orb_embedding *target, double *quasi_conformal,
                                      double *log_area, orb_map_distortion *distortion, orb_error *error) {
    if (!source || !target || !distortion)
        return error_set(error, ORB_BAD_ARGUMENT,
                         "orb_surface_map_distortion needs two embeddings and a place for its "
                         "result");
    *distortion = (orb_map_distortion){0};
    orb_overlay overlay;
    sums sum = {0};
    orb_status status = overlay_create(source, target, &overlay, error);
    for (int32_t t = 0; t < source->surface->n_input_triangles && status == ORB_OK; t++) {
        matrix2 m;
        double area, ratio = 0, log_of_area = 0;
        bool there = false;
        status = differential(&overlay, t, &m, &area, &there, error);
        if (status == ORB_OK && there)
            count(m, area, &sum, distortion, &ratio, &log_of_area);
        distortion->left_out += status == ORB_OK && !there;
        if (quasi_conformal)
            quasi_conformal[t] = ratio;
        if (log_area)
            log_area[t] = log_of_area;
    }
    finish(&sum, distortion);
    overlay_clear(&overlay);
    return status == ORB_OK ? error_set(error, ORB_OK, "%s", "") : status;
}
