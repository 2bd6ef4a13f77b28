/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "distortion.h"

#include <math.h>
#include <stdlib.h>

#include "certificate.h"
#include "select.h"
#include "triangle.h"
#include "vector3.h"

typedef struct affine {
    double area;         /* on the mesh, scaled; 0: none to speak of, and then all else is unset */
    double tile_area;    /* in the geometry */
    double complex a, b; /* the map y -> a y + b conj(y) from a plane holding the triangle, scaled */
    double determinant;  /* |a|^2 - |b|^2, which for thin triangles is lost in the difference */
} affine;

/* The power of two that brings the largest side along an axis to about 1. Nothing that is measured here depends on
 * the mesh's unit, and squares of very large or small coordinates would overflow or vanish. */
static double unit_scale(const orb_mesh *mesh) {
    double largest = 0;
    for (int32_t h = 0; h < 3 * mesh->n_triangles; h++)
        for (int k = 0; k < 3; k++) /* halves, so that the difference cannot overflow */
            largest = fmax(largest, fabs(0.5 * mesh->vertices[3 * (size_t)halfedge_to(mesh, h) + (size_t)k] -
                                         0.5 * mesh->vertices[3 * (size_t)halfedge_from(mesh, h) + (size_t)k]));
    return largest > 0 ? ldexp(0.5, largest < 0x1p-1000 ? 1000 : -ilogb(largest)) : 1;
}

/* The triangle's corners counted from the one where its image has the least rounding error. */
static affine triangle_map(const orb_embedding *embedding, double scale, int32_t t) {
    const orb_geometry *geometry = embedding->tile->geometry;
    triangle_shape shape = triangle_measure(embedding->mesh, t);
    if (shape.double_area == 0)
        return (affine){0};
    orb_point p[3];
    for (int c = 0; c < 3; c++)
        p[c] = embedding->placed[embedding->copies->triangles[3 * t + c]];
    double sine;
    int c = certificate_corner(geometry, p, &sine), next = (c + 1) % 3, last = (c + 2) % 3;
    double unit = scale / shape.scale, area = shape.double_area / 2, length = shape.length[c];
    double along = -vector_dot(shape.edge[c], shape.edge[last]) / length;
    double complex from[2] = {unit * length, unit * CMPLX(along, 2 * area / length)};
    double complex to[2] = {geometry_log(geometry, p[c], p[next]), geometry_log(geometry, p[c], p[last])};
    affine map = {.area = unit * unit * area};
    map.tile_area = geometry_triangle_area(geometry, geometry_toward(geometry, p[c], p[next]),
                                           geometry_toward(geometry, p[c], p[last]));
    double complex divisor = CMPLX(0, -4 * map.area);
    map.a = (to[0] * conj(from[1]) - to[1] * conj(from[0])) / divisor;
    map.b = (to[1] * from[0] - to[0] * from[1]) / divisor;
    map.determinant = cimag(conj(to[0]) * to[1]) / (2 * map.area);
    return map;
}

void distortion_covariance(const orb_embedding *embedding, double covariance[3]) {
    double scale = unit_scale(embedding->mesh);
    covariance[0] = covariance[1] = covariance[2] = 0;
    for (int32_t t = 0; t < embedding->mesh->n_triangles; t++) {
        affine map = triangle_map(embedding, scale, t);
        double complex x = map.a + map.b, y = CMPLX(0, 1) * (map.a - map.b); /* the columns of J */
        covariance[0] += map.area * (creal(x) * creal(x) + creal(y) * creal(y));
        covariance[1] += map.area * (creal(x) * cimag(x) + creal(y) * cimag(y));
        covariance[2] += map.area * (cimag(x) * cimag(x) + cimag(y) * cimag(y));
    }
}

orb_status distortion_measure(orb_embedding *embedding, orb_error *error) {
    int32_t m = embedding->mesh->n_triangles, used = 0;
    select_item *conformal = malloc(((size_t)m + 1) * sizeof *conformal);
    if (!conformal)
        return error_memory(error);
    double unit = unit_scale(embedding->mesh);
    double area = 0, tile_area = 0, mean = 0, worst = 1, log_mean = 0, log_square = 0, stretch = 0, squeeze = 0;
    for (int32_t t = 0; t < m; t++) {
        affine map = triangle_map(embedding, unit, t);
        if (!(map.area > 0))
            continue;
        double large = modulus(map.a) + modulus(map.b), small = map.determinant / large;
        double ratio = fmax(1, large / small), scale = log(map.tile_area / map.area);
        area += map.area;
        tile_area += map.tile_area;
        mean += map.area * ratio;
        worst = fmax(worst, ratio);
        log_mean += map.area * scale;
        log_square += map.area * scale * scale;
        stretch += map.area * (large * large + small * small);
        squeeze += map.area * (1 / (large * large) + 1 / (small * small));
        conformal[used++] = (select_item){ratio, map.area};
    }
    orb_report *report = &embedding->report;
    if (area > 0) {
        double relative = tile_area / area;
        report->quasi_conformal_mean = mean / area;
        report->quasi_conformal_median = select_weighted(conformal, used, area / 2);
        report->quasi_conformal_max = worst;
        report->log_area_std = sqrt(fmax(0, log_square / area - pow(log_mean / area, 2)));
        report->symmetric_dirichlet = (stretch / relative + squeeze * relative) / (4 * area);
    }
    free(conformal);
    return ORB_OK;
}

double distortion_spread(const orb_embedding *embedding) {
    const double unit = unit_scale(embedding->mesh);
    double area = 0, mean = 0, square = 0;
    for (int32_t t = 0; t < embedding->mesh->n_triangles; t++) {
        const affine map = triangle_map(embedding, unit, t);
        if (!(map.area > 0))
            continue;
        const double large = modulus(map.a) + modulus(map.b), logs[2] = {log(large), log(map.determinant / large)};
        area += map.area;
        for (int k = 0; k < 2; k++) {
            mean += map.area * logs[k] / 2;
            square += map.area * logs[k] * logs[k] / 2;
        }
    }
    return area > 0 ? 2 * sqrt(fmax(0, square / area - pow(mean / area, 2))) : 0;
}
