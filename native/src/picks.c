/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picks.h"

#include <stdlib.h>
#include <string.h>

static orb_status bad_picks(const orb_found *found, orb_error *error, const char *what) {
    return error_set_elements(error, ORB_BAD_CONE, ORB_VERTEX, found->elements, found->entries, found->found,
                              "the cone at vertex %d %s", (int)found->elements[0], what);
}

orb_status picks_check(const orb_mesh *mesh, int32_t n, const int32_t *vertex, orb_error *error) {
    orb_found outside = {0}, isolated = {0}, repeated = {0};
    uint8_t *times = calloc((size_t)mesh->n_vertices + 1, sizeof *times); /* 2 stands for more, too */
    if (!times)
        return error_memory(error);
    for (int32_t s = 0; s < n; s++) {
        int32_t v = vertex[s];
        if (v < 0 || v >= mesh->n_vertices)
            found_add(&outside, v);
        else if (mesh->vertex_halfedge[v] < 0)
            found_add(&isolated, v);
        else if (times[v] < 2 && ++times[v] == 2)
            found_add(&repeated, v);
    }
    free(times);
    if (outside.found > 0)
        return bad_picks(&outside, error, "does not exist: pick a vertex of this mesh");
    if (isolated.found > 0)
        return bad_picks(&isolated, error, "belongs to no triangle: pick a vertex of the surface");
    if (repeated.found > 0)
        return bad_picks(&repeated, error, "is given more than once: pick another vertex for each further cone");
    return ORB_OK;
}

static int ascending(const void *a, const void *b) {
    int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

static bool same_set(int32_t n, int32_t *a, int32_t *b) {
    qsort(a, (size_t)n, sizeof *a, ascending);
    qsort(b, (size_t)n, sizeof *b, ascending);
    return memcmp(a, b, (size_t)n * sizeof *a) == 0;
}

/* Whether b is a from some entry on, forwards or backwards. */
static bool same_cycle(int32_t n, const int32_t *a, const int32_t *b) {
    for (int32_t shift = 0; shift < n; shift++)
        for (int way = -1; way <= 1; way += 2) {
            int32_t i = 0;
            while (i < n && a[i] == b[(((int64_t)shift + way * (int64_t)i) % n + n) % n])
                i++;
            if (i == n)
                return true;
        }
    return n == 0;
}

typedef struct corner {
    int32_t place, pick;
} corner;

static int by_place(const void *a, const void *b) { return ascending(a, b); }

static orb_status error_count(const orb_signature *s, int32_t n_cones, int32_t n_corners, int32_t first_cone,
                              orb_error *error) {
    int32_t picked = n_cones + n_corners, wanted = s->n_cones + s->n_corners;
    if (picked != wanted)
        return error_set(error, ORB_CONE_COUNT, "%s has %d %s but %d vertices were picked", s->text, (int)wanted,
                         s->n_corners ? "cones and corners" : "cones", (int)picked);
    return error_set_elements(error, ORB_BAD_CONE, ORB_VERTEX, &first_cone, 1, 1,
                              "%s has %d cones inside and %d corners on mirrors, but %d of the picked vertices are "
                              "inside and %d on the boundary, vertex %d among those %s: pick it %s",
                              s->text, (int)s->n_cones, (int)s->n_corners, (int)n_cones, (int)n_corners,
                              (int)first_cone, n_cones > s->n_cones ? "inside" : "on the boundary",
                              n_cones > s->n_cones ? "on the boundary" : "inside");
}

/* The corners of each loop against the signature's mirrors. `room` [n + n_mirrors]. */
static orb_status match_loops(const orb_signature *s, const orb_boundary *boundary, const corner *corners, int32_t n,
                              const int32_t *vertex, const int32_t *order, int32_t *room, orb_error *error) {
    int32_t *round = room, *used = room + n;
    memset(used, 0, (size_t)s->n_mirrors * sizeof *used);
    for (int32_t begin = 0, end = 0; begin < n; begin = end) {
        int32_t first = vertex[corners[begin].pick], loop = boundary_loop_of(boundary, first), m = 0;
        for (; end < n && corners[end].place < boundary->start[loop + 1]; end++)
            round[end - begin] = order[corners[end].pick];
        while (m < s->n_mirrors && (used[m] || signature_corners(s, m) != end - begin ||
                                    !same_cycle(end - begin, round, s->orders + s->mirror_start[m])))
            m++;
        if (m == s->n_mirrors)
            return error_set_elements(error, ORB_BAD_ORDER, ORB_VERTEX, &first, 1, 1,
                                      "the %d corners on the boundary of vertex %d do not follow one another as on a "
                                      "mirror of %s: pick each mirror's corners in turn round one boundary",
                                      (int)(end - begin), (int)first, s->text);
        used[m] = 1;
    }
    return ORB_OK;
}

/* Cones and corners apart, corners by their place on the boundary; then orders. */
static orb_status match(const orb_signature *s, const orb_boundary *boundary, int32_t n, const int32_t *vertex,
                        const int32_t *given, int32_t *order, const bool *mirror, corner *corners, int32_t *room,
                        orb_error *error) {
    int32_t n_cones = 0, n_corners = 0, first[2] = {-1, -1};
    for (int32_t i = 0; i < n; i++) {
        if (first[mirror[i]] < 0)
            first[mirror[i]] = vertex[i];
        int32_t number = mirror[i] ? s->n_cones + n_corners : n_cones;
        if (mirror[i])
            corners[n_corners++] = (corner){boundary->place[vertex[i]], i};
        else
            n_cones++;
        order[i] = given ? given[i] : number < s->n_cones + s->n_corners ? s->orders[number] : 0;
    }
    if (n_cones != s->n_cones || n_corners != s->n_corners)
        return error_count(s, n_cones, n_corners, first[n_cones <= s->n_cones], error);
    int32_t *cones = room + n + s->n_mirrors, filled = 0;
    for (int32_t i = 0; i < n; i++)
        if (!mirror[i])
            cones[filled++] = order[i];
    memcpy(cones + n, s->orders, (size_t)n_cones * sizeof *cones);
    if (!same_set(n_cones, cones, cones + n))
        return error_set(error, ORB_BAD_ORDER, "the orders given are not those of %s in another sequence", s->text);
    qsort(corners, (size_t)n_corners, sizeof *corners, by_place);
    return match_loops(s, boundary, corners, n_corners, vertex, order, room, error);
}

orb_status picks_match(const orb_signature *signature, const orb_boundary *boundary, const bool *filled, int32_t n,
                       const int32_t *vertex, const int32_t *given, int32_t *order, bool *mirror, orb_error *error) {
    size_t size = (size_t)n + 1;
    corner *corners = malloc(size * sizeof *corners);
    int32_t *room = malloc((4 * size + (size_t)signature->n_mirrors) * sizeof *room);
    orb_status status = error_memory(error);
    if (corners && room) {
        for (int32_t i = 0; i < n; i++) {
            int32_t loop = boundary_loop_of(boundary, vertex[i]);
            mirror[i] = loop >= 0 && !filled[loop];
        }
        status = match(signature, boundary, n, vertex, given, order, mirror, corners, room, error);
    }
    free(corners);
    free(room);
    return status;
}
