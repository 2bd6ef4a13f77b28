/* Edges of one mesh -> their courses over another. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * An edge is a geodesic of the tile's geometry, so that in each triangle of the target it is straight in the weights of
 * geometry_locate. It is followed from its middle, which is never at a cone, to both ends, from one place of the target to the
 * next: through the inside of a triangle to a side or a corner, or along a side to a corner. A corner within the
 * tolerance of the geodesic is on it, so that what is left to the sides is clear on both sides of each. Ends are where
 * the overlay has the source's vertices. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "pieces.h"
#include "surface_map.h"

static const double rounding = 1e-9, least_rounding = 1e-12; /* a part of the triangle's longest edge, and a length */
static const double on_boundary = 1e-6;                      /* instead of `rounding`, of edges on the boundary */
static const double arrival = 1e-6; /* how far the end may be from where it is known to be, in the same measure */

struct orb_trace {
    int64_t n, room;
    orb_stretch *stretches;
};

/* A way along a geodesic, from its middle to end[1]. */
typedef struct way {
    orb_overlay *overlay;
    orb_trace *trace;
    orb_stretch part; /* the edge and, in `at`, where the geodesic is on it */
    orb_point end[2]; /* on the source's layout */
    double rounding;
    orb_spot place, goal; /* weights are 0 on sides */
    double t;             /* of the place, 0 to 1 from end[0] to end[1] */
    int64_t first;        /* stretch */
    int32_t left_by;      /* the triangle that this is in */
} way;

/* A triangle of the target from the geodesic. */
typedef struct view {
    orb_point corner[3], end[2];
    double longest;
    double off[3]; /* sin_K of the corners' distances from the geodesic, > 0 on its left */
    int side[3];   /* their signs, 0 for corners that are on it */
    double at[3];  /* of these, along it */
} view;

static double cross(double complex a, double complex b) { return cimag(conj(a) * b); }
static double dot(double complex a, double complex b) { return creal(conj(a) * b); }

static double tolerance(double longest, double part) { return fmin(1, longest) * part + least_rounding; }

static void place_corners(const orb_cover *cover, orb_sheet sheet, view *v) {
    const int32_t *copy = cover->target->copies->triangles + 3 * (size_t)sheet.triangle;
    v->longest = 0;
    for (int c = 0; c < 3; c++)
        v->corner[c] = cover->target->placed[copy[c]];
    for (int c = 0; c < 3; c++)
        v->longest = fmax(v->longest, geometry_distance(cover->geometry, v->corner[c], v->corner[(c + 1) % 3]));
}

static orb_point carried(const orb_cover *cover, orb_point p, int32_t element) {
    return element == 0 ? p : isometry_apply(cover->geometry, cover->elements[element], p);
}

static void look(const way *w, orb_sheet sheet, view *v) {
    const orb_cover *cover = &w->overlay->cover;
    const orb_geometry *geometry = cover->geometry;
    place_corners(cover, sheet, v);
    for (int k = 0; k < 2; k++)
        v->end[k] = carried(cover, w->end[k], sheet.element);
    const double complex ahead = geometry_seen(geometry, v->end[0], v->end[1]),
                         back = geometry_seen(geometry, v->end[1], v->end[0]);
    const double most = tolerance(v->longest, w->rounding);
    for (int c = 0; c < 3; c++) {
        const double complex from = geometry_seen(geometry, v->end[0], v->corner[c]),
                             to = geometry_seen(geometry, v->end[1], v->corner[c]);
        const double gone = dot(ahead, from) / modulus(ahead), left = dot(back, to) / modulus(back);
        const bool cone = cover->cone[1][cover->target->mesh->triangles[3 * (size_t)sheet.triangle + (size_t)c]];
        v->off[c] = cross(ahead, from) / modulus(ahead);
        v->side[c] = fabs(v->off[c]) <= most && !cone ? 0 : v->off[c] < 0 ? -1 : 1; /* none goes through a cone */
        v->at[c] = gone / (gone + left);
    }
}

/* --- places ------------------------------------------------------------------------------------------------------ */

static int corner_at(const double weight[3]) {
    for (int c = 0; c < 3; c++)
        if (weight[(c + 1) % 3] == 0 && weight[(c + 2) % 3] == 0)
            return c;
    return -1;
}

/* The corner that faces the side, of a place that is on one and at no corner. */
static int side_at(const double weight[3]) {
    for (int c = 0; c < 3 && corner_at(weight) < 0; c++)
        if (weight[c] == 0)
            return c;
    return -1;
}

static void set_corner(double weight[3], int corner) {
    for (int c = 0; c < 3; c++)
        weight[c] = c == corner;
}

/* Onto a corner or a side that the spot is within the tolerance of. */
static void snap(const orb_cover *cover, orb_spot *spot) {
    const orb_geometry *geometry = cover->geometry;
    view v;
    place_corners(cover, spot->sheet, &v);
    const orb_point p = geometry_between(geometry, v.corner, spot->weight);
    const double most = tolerance(v.longest, rounding) / 2;
    for (int c = 0; c < 3; c++)
        if (geometry_distance(geometry, p, v.corner[c]) <= most) {
            set_corner(spot->weight, c);
            return;
        }
    for (int c = 0; c < 3; c++) {
        const orb_point *from = &v.corner[(c + 1) % 3], *to = &v.corner[(c + 2) % 3];
        const double complex along = geometry_seen(geometry, *from, *to);
        if (side_at(spot->weight) < 0 && fabs(cross(along, geometry_seen(geometry, *from, p))) <= most * modulus(along))
            spot->weight[c] = 0;
    }
    const double total = spot->weight[0] + spot->weight[1] + spot->weight[2];
    for (int c = 0; c < 3; c++)
        spot->weight[c] /= total;
}

/* The weights of a place in another triangle that it is also in. */
static bool same_place(const orb_mesh *mesh, const orb_spot *spot, int32_t triangle, double weight[3]) {
    memset(weight, 0, 3 * sizeof *weight);
    for (int c = 0; c < 3; c++) {
        bool there = spot->weight[c] == 0;
        for (int k = 0; k < 3 && !there; k++)
            if (mesh->triangles[3 * triangle + k] == mesh->triangles[3 * spot->sheet.triangle + c]) {
                weight[k] = spot->weight[c];
                there = true;
            }
        if (!there)
            return false;
    }
    return spot->sheet.triangle == triangle || corner_at(weight) >= 0 || side_at(weight) >= 0;
}

/* --- stretches --------------------------------------------------------------------------------------------------- */

static orb_status go(way *w, orb_sheet sheet, const double from[3], const double to[3], double t, orb_error *error) {
    orb_trace *trace = w->trace;
    if (trace->n == trace->room) {
        const int64_t room = 2 * trace->room + 64;
        orb_stretch *stretches = realloc(trace->stretches, (size_t)room * sizeof *stretches);
        if (!stretches)
            return error_memory(error);
        trace->stretches = stretches;
        trace->room = room;
    }
    if (trace->n == w->first)
        w->left_by = sheet.triangle;
    orb_stretch *next = &trace->stretches[trace->n++];
    *next = w->part;
    t = fmin(1, fmax(w->t, t));
    next->at[0] = w->part.at[0] + (w->part.at[1] - w->part.at[0]) * w->t;
    next->at[1] = w->part.at[0] + (w->part.at[1] - w->part.at[0]) * t;
    pieces_join(w->overlay->cover.target, sheet.triangle, from, &next->triangle, next->barycentric);
    pieces_join(w->overlay->cover.target, sheet.triangle, to, &next->triangle, next->barycentric + 3);
    w->place.sheet = sheet;
    memcpy(w->place.weight, to, sizeof w->place.weight);
    w->t = t;
    return ORB_OK;
}

static void turn_round(orb_stretch *stretches, int64_t n) {
    for (int64_t i = 0; i < n; i++) {
        orb_stretch *s = &stretches[i], other = *s;
        for (int k = 0; k < 2; k++) {
            s->at[k] = other.at[1 - k];
            memcpy(s->barycentric + 3 * k, other.barycentric + 3 * (1 - k), 3 * sizeof(double));
        }
    }
    for (int64_t i = 0; i < n / 2; i++) {
        const orb_stretch other = stretches[i];
        stretches[i] = stretches[n - 1 - i];
        stretches[n - 1 - i] = other;
    }
}

/* The stretch before number i and that one become one. */
static void join(orb_trace *trace, int64_t i) {
    orb_stretch *before = &trace->stretches[i - 1];
    before->at[1] = before[1].at[1];
    memcpy(before->barycentric + 3, before[1].barycentric + 3, 3 * sizeof(double));
    memmove(before + 1, before + 2, (size_t)(trace->n - i - 1) * sizeof *before);
    trace->n--;
}

/* --- one step ---------------------------------------------------------------------------------------------------- */

/* What may be done in a triangle that the place, with these weights there, is in; *moved: it was done. */
typedef orb_status move(way *w, orb_sheet sheet, const double weight[3], bool *moved, orb_error *error);

static orb_status arrive(way *w, orb_sheet sheet, const double weight[3], bool *moved, orb_error *error) {
    const orb_cover *cover = &w->overlay->cover;
    double there[3];
    view v;
    if (!same_place(cover->target->mesh, &w->goal, sheet.triangle, there))
        return ORB_OK;
    place_corners(cover, sheet, &v);
    const orb_point known = geometry_between(cover->geometry, v.corner, there),
                    end = carried(cover, w->end[1], sheet.element);
    *moved = geometry_distance(cover->geometry, known, end) <= tolerance(v.longest, arrival);
    return *moved ? go(w, sheet, weight, there, 1, error) : ORB_OK;
}

/* To a corner on the geodesic, or by the side that it leaves by. */
static orb_status follow(way *w, orb_sheet sheet, const double weight[3], bool *moved, orb_error *error) {
    const orb_geometry *geometry = w->overlay->cover.geometry;
    double to[3];
    int corner = -1;
    view v;
    look(w, sheet, &v);
    for (int c = 0; c < 3; c++)
        if (v.side[c] == 0 && corner_at(weight) != c && v.at[c] > w->t && (corner < 0 || v.at[c] < v.at[corner]))
            corner = c;
    *moved = corner >= 0;
    if (corner >= 0) {
        set_corner(to, corner);
        return go(w, sheet, weight, to, v.at[corner], error);
    }
    for (int c = 0; c < 3 && !*moved; c++) {
        const int i = (c + 1) % 3, j = (c + 2) % 3;
        if (weight[c] == 0 || v.side[i] >= 0 || v.side[j] <= 0)
            continue;
        const double complex along = geometry_seen(geometry, v.corner[i], v.corner[j]);
        const double before = cross(along, geometry_seen(geometry, v.corner[i], v.end[0])),
                     after = cross(along, geometry_seen(geometry, v.corner[i], v.end[1]));
        to[c] = 0;
        to[j] = v.off[i] / (v.off[i] - v.off[j]);
        to[i] = 1 - to[j];
        *moved = true;
        return go(w, sheet, weight, to, before / (before - after), error);
    }
    return ORB_OK;
}

/* Where the geodesic touches what the place is in, and leaves by no side and no corner ahead: to the corner. */
static orb_status touch(way *w, orb_sheet sheet, const double weight[3], bool *moved, orb_error *error) {
    view v;
    look(w, sheet, &v);
    for (int c = 0; c < 3 && !*moved; c++)
        if (v.side[c] == 0 && weight[c] > 0 && weight[c] < 1) {
            double to[3];
            set_corner(to, c);
            *moved = true;
            return go(w, sheet, weight, to, w->t, error);
        }
    return ORB_OK;
}

/* Tries a move in each triangle that the place is in: one, both beside a side, or all around a corner. */
static orb_status try_around(way *w, move *move, bool *moved, orb_error *error) {
    orb_cover *cover = &w->overlay->cover;
    const orb_mesh *mesh = cover->target->mesh;
    const orb_spot start = w->place;
    const int corner = corner_at(start.weight), side = side_at(start.weight);
    orb_status status = move(w, start.sheet, start.weight, moved, error);
    for (int way_round = 0; way_round < 2 && corner + side > -2; way_round++) {
        orb_sheet sheet = start.sheet;
        const int apex = corner < 0 ? side : (corner + 1 + way_round) % 3;
        int32_t h = 3 * sheet.triangle + (apex + 1) % 3; /* the side that faces it */
        while (status == ORB_OK && !*moved && mesh->twin[h] >= 0) {
            const int32_t g = mesh->twin[h];
            double weight[3];
            status = cover_cross_target(cover, h, &sheet, error);
            if (status != ORB_OK || sheet.triangle == start.sheet.triangle ||
                !same_place(mesh, &start, sheet.triangle, weight))
                break;
            status = move(w, sheet, weight, moved, error);
            if (corner < 0)
                break;
            const int32_t next = halfedge_next(g), at = mesh->triangles[3 * start.sheet.triangle + corner];
            h = halfedge_from(mesh, next) == at || halfedge_to(mesh, next) == at ? next : halfedge_previous(g);
        }
    }
    return status;
}

static orb_status walk(way *w, orb_error *error) {
    const int64_t most = 4 * (int64_t)w->overlay->cover.target->mesh->n_triangles + 1000;
    static move *const moves[] = {arrive, follow, touch};
    for (int64_t step = 0; step < most; step++) {
        bool moved = false;
        for (int k = 0; k < 3 && !moved; k++) {
            orb_status status = try_around(w, moves[k], &moved, error);
            if (status != ORB_OK || (moved && k == 0))
                return status;
        }
        if (!moved)
            break;
    }
    return error_set(error, ORB_POINT_NOT_FOUND,
                     "the course of an edge of the first mesh over the second one was lost: are there triangles of "
                     "either that have no area?");
}

/* --- edges ------------------------------------------------------------------------------------------------------- */

/* A side of the embedded source, from both sides of its middle. */
static orb_status trace_part(orb_overlay *overlay, int32_t edge, orb_side_part part, orb_trace *trace,
                             orb_error *error) {
    const orb_embedding *source = overlay->cover.source;
    const orb_mesh *mesh = source->mesh;
    const int end[2] = {part.from, part.to};
    const int32_t h = 3 * part.piece + ((part.from + 1) % 3 == part.to ? part.from : part.to);
    double weight[3] = {0};
    orb_spot middle;
    weight[part.from] = weight[part.to] = 0.5;
    orb_status status = overlay_locate(overlay, part.piece, weight, &middle, error);
    if (status != ORB_OK)
        return status;
    snap(&overlay->cover, &middle);
    way w[2]; /* to the first end, turned round, and to the last one */
    for (int k = 0; k < 2 && status == ORB_OK; k++) {
        w[k] = (way){.overlay = overlay, .trace = trace, .place = middle, .t = 0.5, .first = trace->n};
        w[k].part = (orb_stretch){.edge = edge, .at = {part.at[1 - k], part.at[k]}};
        w[k].rounding = mesh->twin[h] < 0 ? on_boundary : rounding;
        w[k].goal = overlay->spot[mesh->triangles[3 * part.piece + end[k]]];
        snap(&overlay->cover, &w[k].goal);
        for (int i = 0; i < 2; i++)
            w[k].end[i] = overlay->cover.placed[source->copies->triangles[3 * part.piece + end[i == k]]];
        status = walk(&w[k], error);
        if (k == 0)
            turn_round(trace->stretches + w[0].first, trace->n - w[0].first);
    }
    if (status == ORB_OK && corner_at(middle.weight) < 0 && w[0].left_by == w[1].left_by)
        join(trace, w[1].first);
    return status;
}

static orb_status trace_all(orb_overlay *overlay, int32_t n_edges, const int32_t *corners, orb_trace *trace,
                            orb_error *error) {
    orb_status status = ORB_OK;
    for (int32_t i = 0; i < n_edges && status == ORB_OK; i++) {
        orb_side_part parts[2];
        const int n = pieces_of_side(overlay->cover.source, corners[i], parts);
        for (int k = 0; k < n && status == ORB_OK; k++)
            status = trace_part(overlay, i, parts[k], trace, error);
    }
    return status;
}

orb_status orb_surface_map_trace(const orb_embedding *source, const orb_embedding *target, int32_t n_edges,
                                 const int32_t *corners, orb_trace **trace, orb_error *error) {
    if (trace)
        *trace = NULL;
    if (!source || !target || !trace || n_edges < 0 || (n_edges > 0 && !corners))
        return error_set(error, ORB_BAD_ARGUMENT,
                         "orb_surface_map_trace needs two embeddings, edges, and a place for its result");
    for (int32_t i = 0; i < n_edges; i++)
        if (corners[i] < 0 || corners[i] / 3 >= source->surface->n_input_triangles)
            return error_set(error, ORB_BAD_ARGUMENT,
                             "edge %d begins at the corner %d, which the first mesh does not have", (int)i,
                             (int)corners[i]);
    orb_trace *made = calloc(1, sizeof *made);
    if (!made)
        return error_memory(error);
    orb_overlay overlay;
    orb_status status = overlay_create(source, target, &overlay, error);
    if (status == ORB_OK)
        status = trace_all(&overlay, n_edges, corners, made, error);
    overlay_clear(&overlay);
    if (status != ORB_OK) {
        orb_trace_free(made);
        return status;
    }
    *trace = made;
    return error_set(error, ORB_OK, "%s", "");
}

void orb_trace_free(orb_trace *trace) {
    if (!trace)
        return;
    free(trace->stretches);
    free(trace);
}

int64_t orb_trace_count(const orb_trace *trace) { return trace->n; }

void orb_trace_read(const orb_trace *trace, orb_stretch *stretches) {
    if (trace->n > 0)
        memcpy(stretches, trace->stretches, (size_t)trace->n * sizeof *stretches);
}
