/* Two embeddings on one tile -> triangles and barycentric coordinates. SPDX-License-Identifier: GPL-3.0-or-later */
#include "surface_map.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "pieces.h"

static const double off_triangle = 1e-6; /* what weights that are given may be below 0, or their sum beside 1 */

/* --- vertices ---------------------------------------------------------------------------------------------------- */

/* Landmarks go to landmarks, to the last digit. */
static void pin_landmarks(orb_overlay *overlay) {
    const orb_surface *a = overlay->cover.source->surface, *b = overlay->cover.target->surface;
    for (int32_t k = 0; k < a->n_marks; k++) {
        const int32_t h = b->mesh->vertex_halfedge[b->vertex[k]];
        overlay->spot[a->vertex[k]] = (orb_spot){{h / 3, 0}, {h % 3 == 0, h % 3 == 1, h % 3 == 2}};
    }
}

static orb_status not_found(const orb_overlay *overlay, int32_t vertex, orb_error *error) {
    const bool given = vertex >= 0 && vertex < overlay->cover.source->surface->n_input_vertices;
    if (!given)
        return error_set(error, ORB_POINT_NOT_FOUND,
                         "no triangle of the second mesh was found for a point of the first one that is no vertex");
    return error_set_elements(error, ORB_POINT_NOT_FOUND, ORB_VERTEX, &vertex, 1, 1,
                              "no triangle of the second mesh was found for vertex %d of the first one", (int)vertex);
}

/* From triangle to triangle over the source: each starts where its neighbour was found. */
static orb_status spread(orb_overlay *overlay, orb_error *error) {
    orb_cover *cover = &overlay->cover;
    const orb_mesh *mesh = cover->source->mesh;
    const int32_t *copy = cover->source->copies->triangles;
    int32_t head = 0, tail = 0;
    overlay->sheet[0] = (orb_sheet){0, 0};
    overlay->queue[tail++] = 0;
    while (head < tail) {
        const int32_t t = overlay->queue[head++];
        orb_sheet *sheet = &overlay->sheet[t];
        for (int32_t h = 3 * t; h < 3 * t + 3; h++) {
            const int32_t v = mesh->triangles[h];
            orb_spot spot = {.sheet = *sheet};
            bool found = false;
            if (overlay->spot[v].sheet.triangle >= 0)
                continue;
            orb_status status = cover_walk(cover, cover->placed[copy[h]], cover->border[0][v], &spot, &found, error);
            if (status != ORB_OK || !found)
                return status != ORB_OK ? status : not_found(overlay, v, error);
            overlay->spot[v] = spot;
            *sheet = spot.sheet;
        }
        for (int32_t h = 3 * t; h < 3 * t + 3; h++) {
            const int32_t other = mesh->twin[h] / 3;
            if (mesh->twin[h] < 0 || overlay->sheet[other].triangle >= 0)
                continue;
            overlay->sheet[other] = *sheet;
            orb_status status = cover_cross_source(cover, h, &overlay->sheet[other].element, error);
            if (status != ORB_OK)
                return status;
            overlay->queue[tail++] = other;
        }
    }
    return ORB_OK;
}

orb_status overlay_create(const orb_embedding *source, const orb_embedding *target, orb_overlay *overlay,
                          orb_error *error) {
    *overlay = (orb_overlay){0};
    orb_status status = cover_create(source, target, &overlay->cover, error);
    if (status != ORB_OK)
        return status;
    const size_t n = (size_t)source->mesh->n_vertices, m = (size_t)source->mesh->n_triangles;
    overlay->sheet = malloc((m + 1) * sizeof *overlay->sheet);
    overlay->spot = malloc((n + 1) * sizeof *overlay->spot);
    overlay->queue = malloc((m + 1) * sizeof *overlay->queue);
    if (!overlay->sheet || !overlay->spot || !overlay->queue)
        return error_memory(error);
    for (size_t t = 0; t < m; t++)
        overlay->sheet[t].triangle = -1;
    for (size_t v = 0; v < n; v++)
        overlay->spot[v] = (orb_spot){{-1, 0}, {0, 0, 0}};
    pin_landmarks(overlay);
    return spread(overlay, error);
}

void overlay_clear(orb_overlay *overlay) {
    cover_clear(&overlay->cover);
    free(overlay->sheet);
    free(overlay->spot);
    free(overlay->queue);
    *overlay = (orb_overlay){0};
}

/* --- points ------------------------------------------------------------------------------------------------------ */

orb_status overlay_locate(orb_overlay *overlay, int32_t triangle, const double weight[3], orb_spot *spot,
                          orb_error *error) {
    orb_cover *cover = &overlay->cover;
    const orb_mesh *mesh = cover->source->mesh;
    const int32_t *copy = cover->source->copies->triangles + 3 * (size_t)triangle;
    orb_point corner[3];
    bool boundary = false, found = false;
    for (int c = 0; c < 3; c++) {
        const bool alone = weight[(c + 1) % 3] == 0 && weight[(c + 2) % 3] == 0;
        if (alone) {
            *spot = overlay->spot[mesh->triangles[3 * (size_t)triangle + (size_t)c]];
            return ORB_OK;
        }
        boundary = boundary || (weight[c] == 0 && mesh->twin[3 * triangle + (c + 1) % 3] < 0);
        corner[c] = cover->placed[copy[c]];
    }
    spot->sheet = overlay->sheet[triangle];
    orb_status status =
        cover_walk(cover, geometry_between(cover->geometry, corner, weight), boundary, spot, &found, error);
    return status != ORB_OK || found ? status : not_found(overlay, -1, error);
}

static orb_status check_points(const orb_embedding *source, int32_t n, const int32_t *triangles,
                               const double *barycentric, orb_error *error) {
    for (int32_t i = 0; i < n; i++) {
        const double *b = barycentric + 3 * (size_t)i;
        if (triangles[i] < -1 || triangles[i] >= source->surface->n_input_triangles)
            return error_set(error, ORB_BAD_ARGUMENT,
                             "point %d is in the triangle %d, which the first mesh does not have", (int)i,
                             (int)triangles[i]);
        if (triangles[i] >= 0 &&
            !(fmin(b[0], fmin(b[1], b[2])) > -off_triangle && fabs(b[0] + b[1] + b[2] - 1) < off_triangle))
            return error_set(
                error, ORB_BAD_ARGUMENT,
                "point %d has the barycentric coordinates %g, %g, %g: give three that are not negative and "
                "add up to 1",
                (int)i, b[0], b[1], b[2]);
    }
    return ORB_OK;
}

/* The point that was given, or vertex i of the input. */
static orb_status locate(orb_overlay *overlay, int32_t i, const int32_t *triangles, const double *barycentric,
                         orb_spot *spot, orb_error *error) {
    const orb_embedding *source = overlay->cover.source;
    *spot = (orb_spot){{-1, 0}, {0, 0, 0}};
    if (!triangles) {
        *spot = overlay->spot[i];
        return ORB_OK;
    }
    if (triangles[i] < 0)
        return ORB_OK;
    int32_t piece = 0;
    double given[3], weight[3] = {0};
    for (int c = 0; c < 3; c++)
        given[c] = fmax(0, barycentric[3 * (size_t)i + (size_t)c]);
    pieces_find(source, triangles[i], given, &piece, weight);
    const double total = weight[0] + weight[1] + weight[2];
    for (int c = 0; c < 3; c++)
        weight[c] /= total;
    return overlay_locate(overlay, piece, weight, spot, error);
}

orb_status orb_surface_map(const orb_embedding *source, const orb_embedding *target, int32_t n_points,
                           const int32_t *point_triangles, const double *point_barycentric, int32_t *triangles,
                           double *barycentric, orb_map_report *report, orb_error *error) {
    const bool all = !point_triangles && !point_barycentric && n_points == 0;
    if (!source || !target || !triangles || !barycentric || n_points < 0 ||
        (!all && (!point_triangles || !point_barycentric)))
        return error_set(error, ORB_BAD_ARGUMENT,
                         "orb_surface_map needs two embeddings, points or none at all, and places for its results");
    orb_status status = check_points(source, n_points, point_triangles, point_barycentric, error);
    if (status != ORB_OK)
        return status;
    orb_overlay overlay;
    status = overlay_create(source, target, &overlay, error);
    const int32_t n = all ? source->surface->n_input_vertices : n_points;
    int32_t in_holes = 0;
    for (int32_t i = 0; i < n && status == ORB_OK; i++) {
        orb_spot spot;
        status = locate(&overlay, i, point_triangles, point_barycentric, &spot, error);
        triangles[i] = -1;
        memset(barycentric + 3 * (size_t)i, 0, 3 * sizeof *barycentric);
        if (status != ORB_OK || spot.sheet.triangle < 0)
            continue;
        pieces_join(target, spot.sheet.triangle, spot.weight, &triangles[i], barycentric + 3 * (size_t)i);
        in_holes += triangles[i] < 0;
    }
    if (report)
        *report = (orb_map_report){overlay.cover.steps, overlay.cover.n_elements, in_holes, overlay.cover.map.residual};
    overlay_clear(&overlay);
    return status == ORB_OK ? error_set(error, ORB_OK, "%s", "") : status;
}
