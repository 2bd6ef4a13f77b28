/* Dividing, centring and mending. SPDX-License-Identifier: GPL-3.0-or-later */
#include "whole_sphere.h"

#include <math.h>
#include <stdlib.h>

#include "embedding.h"
#include "mend.h"

/* ------------------------------------------------------------------------------------------------ Möbius maps */

/* a pole + b zero, from the two of pole, zero and one = zero - pole that cancel least. */
static double complex combine(double complex a, double complex b, orb_ratio f) {
    double complex both = a + b;
    double complex terms[3][2] = {{a * f.pole, b * f.zero}, {both * f.pole, b * f.one}, {both * f.zero, -a * f.one}};
    int best = 0;
    double least = INFINITY;
    for (int i = 0; i < 3; i++) {
        double size = cabs(terms[i][0]) + cabs(terms[i][1]);
        if (size < least) {
            least = size;
            best = i;
        }
    }
    return terms[best][0] + terms[best][1];
}

void whole_sphere_point(const orb_moebius *map, orb_ratio value, double x[3]) {
    double complex pole = combine(map->m[0][0], map->m[0][1], value);
    double complex zero = combine(map->m[1][0], map->m[1][1], value);
    double size = hypot(cabs(pole), cabs(zero));
    pole /= size;
    zero /= size;
    double complex product = 2 * conj(pole) * zero;
    x[0] = creal(product);
    x[1] = cimag(product);
    x[2] = (cabs(pole) - cabs(zero)) * (cabs(pole) + cabs(zero));
}

/* The boost by `length` along the unit vector u, which takes points away from u, after `map`:
 * cosh(length / 2) - sinh(length / 2) u . sigma, with Pauli's matrices. */
static void boost(orb_moebius *map, const double u[3], double length) {
    double c = cosh(length / 2), s = sinh(length / 2);
    double complex b[2][2] = {{c - s * u[2], -s * CMPLX(u[0], -u[1])}, {-s * CMPLX(u[0], u[1]), c + s * u[2]}};
    orb_moebius old = *map;
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++)
            map->m[i][j] = b[i][0] * old.m[0][j] + b[i][1] * old.m[1][j];
}

/* -------------------------------------------------------------------------------------------------- centring */

/* In hyperbolic space, of which the sphere is the boundary, the centring point is where the weighted sum of the
 * Busemann functions of the x_v is least; at the centre of the ball that sum has the gradient -sum w x and the
 * Hessian sum w (1 - x x'), and at distance r in direction u the value sum w log(cosh r - sinh r <x, u>). It is
 * convex along geodesics, so Newton's method with backtracking finds the one minimum. */

/* Solves the symmetric positive definite 3 x 3 system by Cramer's rule. */
static void solve3(double H[3][3], const double g[3], double s[3]) {
    double c[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            c[i][j] = H[i1][j1] * H[i2][j2] - H[i1][j2] * H[i2][j1];
        }
    double det = H[0][0] * c[0][0] + H[0][1] * c[0][1] + H[0][2] * c[0][2];
    for (int i = 0; i < 3; i++)
        s[i] = (c[0][i] * g[0] + c[1][i] * g[1] + c[2][i] * g[2]) / det;
}

/* Weighted mean of the points, and Newton's step towards the centring point. */
static double centring_step(int32_t n, const double *weights, double total, const double *x, double mean[3],
                            double step[3]) {
    double H[3][3] = {{0}};
    mean[0] = mean[1] = mean[2] = 0;
    for (int32_t v = 0; v < n; v++)
        for (int i = 0; i < 3; i++) {
            double w = weights[v] / total, xi = x[3 * (int64_t)v + i];
            mean[i] += w * xi;
            for (int j = 0; j < 3; j++)
                H[i][j] += w * ((i == j) - xi * x[3 * (int64_t)v + j]);
        }
    for (int i = 0; i < 3; i++)
        H[i][i] += 1e-9; /* all points on one axis */
    solve3(H, mean, step);
    return sqrt(mean[0] * mean[0] + mean[1] * mean[1] + mean[2] * mean[2]);
}

/* sum w log(cosh r - sinh r <x, u>), with 1 - <x, u> = |x - u|^2 / 2 so that nothing cancels */
static double busemann(int32_t n, const double *weights, double total, const double *x, const double u[3], double r) {
    double sum = 0;
    for (int32_t v = 0; v < n; v++) {
        double a = x[3 * (int64_t)v] - u[0], b = x[3 * (int64_t)v + 1] - u[1], c = x[3 * (int64_t)v + 2] - u[2];
        if (weights[v] > 0)
            sum += weights[v] / total * log(exp(-r) + sinh(r) * (a * a + b * b + c * c) / 2);
    }
    return sum;
}

double whole_sphere_centre(int32_t n, const orb_ratio *values, const double *weights, orb_moebius *map, double *x) {
    double total = 0, left = 0;
    *map = (orb_moebius){{{1, 0}, {0, 1}}};
    for (int32_t v = 0; v < n; v++)
        total += weights[v];
    for (int step = 0;; step++) {
        double mean[3], s[3], u[3];
        for (int32_t v = 0; v < n; v++)
            whole_sphere_point(map, values[v], x + 3 * (int64_t)v);
        left = centring_step(n, weights, total, x, mean, s);
        double length = sqrt(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]);
        /* Beyond 1e8 (a patch of 1e-16 blown up to the sphere's size) there are no digits left to spread. */
        if (step == 60 || !(left > 1e-13) || !isfinite(length) || cabs(map->m[0][0]) + cabs(map->m[1][1]) > 1e8)
            return left;
        for (int i = 0; i < 3; i++)
            u[i] = s[i] / length;
        double slope = mean[0] * u[0] + mean[1] * u[1] + mean[2] * u[2];
        length = fmin(length, 2);
        while (length > 1e-15 && !(busemann(n, weights, total, x, u, length) < -1e-4 * slope * length))
            length /= 2;
        if (!(length > 1e-15)) /* as good as rounding lets it be */
            return left;
        boost(map, u, length);
    }
}

/* ----------------------------------------------------------------------------------------------- whole sphere */

/* A third of the area of each triangle to each of its corners. */
static void lump_areas(const orb_mesh *mesh, double *weights) {
    double total = 0;
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        weights[v] = 0;
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        double area = mesh_triangle_area(mesh, t);
        total += area;
        for (int c = 0; c < 3; c++)
            weights[mesh->triangles[3 * (int64_t)t + c]] += area;
    }
    for (int32_t v = 0; v < mesh->n_vertices && !(total > 0 && isfinite(total)); v++)
        weights[v] = mesh->vertex_halfedge[v] >= 0; /* no areas to go by */
}

ORB_API orb_status orb_whole_sphere(const orb_embedding *embedding, double *positions, int64_t *mended,
                                    orb_error *error) {
    if (!embedding || !positions)
        return error_set(error, ORB_BAD_ARGUMENT, "%s is missing: pass one",
                         positions ? "the embedding" : "the array of positions");
    const orb_mesh *mesh = embedding->mesh;
    size_t n = (size_t)mesh->n_vertices;
    orb_quotient *quotient = NULL;
    orb_moebius map;
    double *weights = malloc(n * sizeof *weights), *x = malloc(3 * n * sizeof *x);
    orb_ratio *values = malloc(n * sizeof *values);
    orb_status status = error_memory(error);
    if (weights && x && values)
        status = quotient_create(embedding->tile, &quotient, error);
    if (status != ORB_OK)
        goto done;
    for (size_t v = 0; v < n; v++)
        values[v] = quotient_evaluate(quotient, embedding->position[v]);
    lump_areas(mesh, weights);
    whole_sphere_centre(mesh->n_vertices, values, weights, &map, x);
    status = mend_sphere(mesh, x, mended, error);
    for (size_t k = 0; status == ORB_OK && k < 3 * n; k++)
        positions[k] = mesh->vertex_halfedge[k / 3] >= 0 ? x[k] : 0;
done:
    quotient_free(quotient);
    free(weights);
    free(x);
    free(values);
    return status;
}
