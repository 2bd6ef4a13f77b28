/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "certificate.h"

#include <math.h>
#include <stdlib.h>

#include "select.h"
#include "triangle.h"

static const double pi = 3.14159265358979323846;
static const double seam_tolerance = 1e-8;  /* of the edge, or the median edge */
static const double angle_tolerance = 1e-7; /* radians */
static const double area_tolerance = 1e-7;  /* relative */
static const double plain_sine = 0.5;       /* so far from 0 that its sign, too, is far from rounding */

/* The sine of a triangle's angle at its corner k. */
static double sine_at(const orb_geometry *geometry, const orb_point corners[3], int k) {
    double complex s = geometry_toward(geometry, corners[k], corners[(k + 1) % 3]);
    double complex t = geometry_toward(geometry, corners[k], corners[(k + 2) % 3]);
    double size = modulus(s) * modulus(t);
    return size > 0 ? cimag(conj(s) * t) / size : 0;
}

int certificate_corner(const orb_geometry *geometry, const orb_point corners[3], double *sine) {
    int corner = 0;
    *sine = sine_at(geometry, corners, 0);
    for (int k = 1; k < 3 && !(fabs(*sine) > plain_sine); k++) {
        double other = sine_at(geometry, corners, k);
        if (fabs(other) > fabs(*sine)) {
            *sine = other;
            corner = k;
        }
    }
    return corner;
}

static void triangle_corners(const orb_embedding *embedding, int32_t t, orb_point corners[3]) {
    for (int c = 0; c < 3; c++)
        corners[c] = embedding->placed[embedding->copies->triangles[3 * (size_t)t + (size_t)c]];
}

static bool is_flipped(const orb_embedding *embedding, int32_t t) {
    orb_point corners[3];
    double sine;
    triangle_corners(embedding, t, corners);
    certificate_corner(embedding->tile->geometry, corners, &sine);
    return !(sine > 0);
}

int64_t certificate_find_flipped(const orb_embedding *embedding, bool *flipped) {
    int64_t count = 0;
    for (int32_t t = 0; t < embedding->mesh->n_triangles; t++) {
        flipped[t] = is_flipped(embedding, t);
        count += flipped[t];
    }
    return count;
}

static orb_status check_orientation(orb_embedding *embedding, orb_error *error) {
    orb_blamed blamed = {0};
    int64_t flipped = 0, without_area = 0;
    for (int32_t t = 0; t < embedding->mesh->n_triangles; t++) {
        if (!is_flipped(embedding, t))
            continue;
        mesh_blame(embedding->mesh, t, &blamed);
        flipped++;
        without_area += triangle_measure(embedding->mesh, t).double_area == 0;
    }
    embedding->report.flipped = flipped;
    if (flipped == 0)
        return ORB_OK;
    if (flipped == without_area)
        return mesh_blame_error(error, ORB_ZERO_AREA_TRIANGLE, &blamed, "triangle without area stays flat on the tile",
                                "triangles without area stay flat on the tile", "dissolve degenerate faces");
    return mesh_blame_error(error, ORB_CERTIFICATE_FAILED, &blamed, "triangle is flipped on the tile",
                            "triangles are flipped on the tile",
                            "pick a cone near it, put many cones in the sequence of a short walk, or raise the clamp");
}

/* An edge's length as the triangle of this half-edge has it. */
static double length_in_triangle(const orb_embedding *embedding, int32_t h) {
    const int32_t *triangles = embedding->copies->triangles;
    return geometry_distance(embedding->tile->geometry, embedding->placed[triangles[h]],
                             embedding->placed[triangles[halfedge_next(h)]]);
}

/* Both copies of every seam edge have one length, relative to the edge itself or the median one, whichever is longer.
 * Elsewhere both are the same two points. */
static orb_status check_seams(orb_embedding *embedding, orb_error *error) {
    const orb_mesh *mesh = embedding->mesh;
    double *lengths = malloc(((size_t)mesh->n_edges + 1) * sizeof *lengths), gap = 0;
    if (!lengths)
        return error_memory(error);
    for (int32_t e = 0; e < mesh->n_edges; e++)
        lengths[e] = length_in_triangle(embedding, mesh->edge_halfedge[e]);
    double median = select_kth(lengths, mesh->n_edges, mesh->n_edges / 2);
    free(lengths);
    int32_t worst[2] = {0, 0};
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        int32_t h = mesh->edge_halfedge[e];
        if (!embedding_is_seam(embedding, e))
            continue;
        double side = length_in_triangle(embedding, h), other = length_in_triangle(embedding, mesh->twin[h]);
        double difference = fabs(side - other) / fmax(median, side);
        if (difference > gap || difference != difference) {
            gap = difference;
            worst[0] = halfedge_from(mesh, h);
            worst[1] = halfedge_to(mesh, h);
        }
    }
    embedding->report.seam_residual = gap;
    if (embedding->report.seam_residual < seam_tolerance)
        return ORB_OK;
    return error_set_elements(error, ORB_CERTIFICATE_FAILED, ORB_EDGE, worst, 2, 1,
                              "the two sides of the seam edge %d-%d differ by %.1e of an edge: put the cones in the "
                              "sequence of a short walk, or pick other ones",
                              (int)worst[0], (int)worst[1], embedding->report.seam_residual);
}

/* What a cone's or corner's angles lack to 2 pi, or to pi on the boundary. */
static double missing_angle(const orb_embedding *embedding, int32_t mark, const bool *border) {
    double full = border[embedding->surface->vertex[mark]] ? pi : 2 * pi;
    if (embedding->tile->fixed)
        return full - tile_angle(embedding->tile, mark);
    return full - full / embedding->surface->order[mark];
}

/* The vertex itself, or for one of a refinement one of the user's triangle that it lies in. */
static int32_t input_vertex_near(const orb_embedding *embedding, int32_t vertex) {
    const orb_surface *surface = embedding->surface;
    if (vertex < surface->n_input_vertices)
        return vertex;
    const int32_t triangle = embedding->mesh->origin[embedding->mesh->vertex_halfedge[vertex] / 3];
    return surface->input_triangles[triangle >= 0 ? 3 * (size_t)triangle : 0];
}

/* Angle sums at the vertices, and the area of all triangles. */
static orb_status check_angles(orb_embedding *embedding, double *area, orb_error *error) {
    const orb_mesh *mesh = embedding->mesh;
    const orb_geometry *geometry = embedding->tile->geometry;
    double *sum = calloc((size_t)mesh->n_vertices + 1, sizeof *sum);
    bool *border = malloc((size_t)mesh->n_vertices + 1);
    if (!sum || !border) {
        free(sum);
        free(border);
        return error_memory(error);
    }
    mesh_find_boundary(mesh, border);
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        orb_point corners[3];
        triangle_corners(embedding, t, corners);
        for (int c = 0; c < 3; c++) {
            double complex s = geometry_toward(geometry, corners[c], corners[(c + 1) % 3]);
            double complex r = geometry_toward(geometry, corners[c], corners[(c + 2) % 3]);
            double complex turn = conj(s) * r;
            sum[mesh->triangles[3 * t + c]] += atan2(cimag(turn), creal(turn));
            if (c == 0)
                *area += geometry_triangle_area(geometry, s, r);
        }
    }
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        sum[v] -= mesh->vertex_halfedge[v] < 0 ? 0 : border[v] ? pi : 2 * pi;
    for (int32_t k = 0; k < embedding->surface->n_marks; k++)
        sum[embedding->surface->vertex[k]] += missing_angle(embedding, k, border);
    int32_t worst = 0;
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        if (fabs(sum[v]) > fabs(sum[worst]) || sum[v] != sum[v])
            worst = v;
    embedding->report.angle_residual = fabs(sum[worst]);
    free(sum);
    free(border);
    if (embedding->report.angle_residual < angle_tolerance)
        return ORB_OK;
    worst = input_vertex_near(embedding, worst);
    return error_set_elements(
        error, ORB_CERTIFICATE_FAILED, ORB_VERTEX, &worst, 1, 1,
        "the angles around vertex %d are off by %.1e: dissolve degenerate faces near it, or pick a "
        "cone near it",
        (int)worst, embedding->report.angle_residual);
}

orb_status certificate_check(orb_embedding *embedding, orb_error *error) {
    double area = 0;
    orb_status status = check_orientation(embedding, error);
    if (status == ORB_OK)
        status = check_seams(embedding, error);
    if (status == ORB_OK)
        status = check_angles(embedding, &area, error);
    if (status != ORB_OK)
        return status;
    double expected = embedding->tile->area;
    embedding->report.area_residual = fabs(area - expected) / expected;
    if (embedding->report.area_residual < area_tolerance)
        return ORB_OK;
    return error_set(error, ORB_CERTIFICATE_FAILED,
                     "the triangles' area is off by %.1e of the orbifold's: dissolve degenerate faces, or pick other "
                     "cones",
                     embedding->report.area_residual);
}
