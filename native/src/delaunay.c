/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "delaunay.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "frames.h"
#include "sides.h"

static const double margin = 1e-12; /* sine of the angle by which an edge must fail before it is flipped */
enum { FLIPS_PER_EDGE = 20 };       /* after these many rounding must be going round in circles */

/* The two triangles on an edge: p -> q -> r on this side, q -> p -> s on the other one. */
typedef struct quad {
    double pq, qr, rp, ps, sq; /* lengths */
    double area[2], dot[2];    /* of pqr and qps; |.| |.| cos of the angles at r and s */
} quad;

typedef struct flipper {
    orb_delaunay *result;
    orb_frames *frames;
    const uint8_t *keep;
    const bool *special;
    int32_t *degree; /* [n_vertices] edge ends at a vertex */
    int32_t *spared; /* [n_vertices] edges on a mirror that were given up there */
    int32_t *stack;  /* [n_edges] edges that may have to be flipped */
    bool *stacked;   /* [n_edges] */
    int32_t height;
} flipper;

/* ------------------------------------------------------------------------------------------------------ geometry */

static quad measure(const orb_delaunay *d, int32_t e) {
    const int32_t h = d->sides[2 * e], g = d->sides[2 * e + 1];
    int32_t gn = halfedge_next(g), gp = halfedge_previous(g);
    if (d->alike[e]) { /* the other triangle, seen from behind */
        const int32_t swap = gn;
        gn = gp;
        gp = swap;
    }
    quad q = {.pq = d->lengths[e],
              .qr = d->lengths[d->edges[halfedge_next(h)]],
              .rp = d->lengths[d->edges[halfedge_previous(h)]],
              .ps = d->lengths[d->edges[gn]],
              .sq = d->lengths[d->edges[gp]]};
    const double here[3] = {q.pq, q.qr, q.rp}, there[3] = {q.pq, q.ps, q.sq};
    q.area[0] = sides_double_area(here);
    q.area[1] = sides_double_area(there);
    q.dot[0] = sides_dot(here, 0);
    q.dot[1] = sides_dot(there, 0);
    return q;
}

/* Whether the angles that face the edge add up to more than pi: sin(r + s) < 0. A triangle without area has angles pi,
 * 0 and 0. */
static bool is_too_long(const quad *q) {
    if (q->area[0] > 0 && q->area[1] > 0)
        return q->dot[0] * q->area[1] + q->dot[1] * q->area[0] < -margin * (q->qr * q->rp) * (q->ps * q->sq);
    const bool open[2] = {q->area[0] == 0 && q->dot[0] < 0, q->area[1] == 0 && q->dot[1] < 0};
    const bool shut[2] = {q->area[0] == 0 && q->dot[0] >= 0, q->area[1] == 0 && q->dot[1] >= 0};
    return (open[0] && !shut[1]) || (open[1] && !shut[0]);
}

/* The length of the other diagonal, r to s; false if it would not cross p to q. With p at 0 and q at (|pq|, 0), r is at
 * (x0, y0) and s at (x1, -y1). */
static bool other_diagonal(const quad *q, double *length) {
    const double rounding = 1 + margin;
    if (!(q->pq > 0))
        return false;
    if (q->pq > (q->qr + q->rp) * rounding || q->pq > (q->ps + q->sq) * rounding) { /* Ptolemy */
        *length = (q->qr * q->ps + q->rp * q->sq) / q->pq;
        return *length > 0 && isfinite(*length);
    }
    const double y0 = q->area[0] / q->pq, y1 = q->area[1] / q->pq;
    const double x0 = 0.5 * (q->pq + (q->rp - q->qr) * ((q->rp + q->qr) / q->pq));
    const double x1 = 0.5 * (q->pq + (q->ps - q->sq) * ((q->ps + q->sq) / q->pq));
    const double across = (x0 * y1 + x1 * y0) / (y0 + y1);
    *length = hypot(x0 - x1, y0 + y1);
    return across > margin * q->pq && across < (1 - margin) * q->pq;
}

/* ------------------------------------------------------------------------------------------------------ topology */

/* Where in `sides` a half-edge stands. */
static int32_t side_of(const orb_delaunay *d, int32_t h) {
    const int32_t e = d->edges[h];
    return d->sides[2 * e] == h ? 2 * e : 2 * e + 1;
}

/* Turns over the triangle of half-edge g, which stays where it is but runs the other way. */
static void turn_over(orb_delaunay *d, int32_t g) {
    const int32_t next = halfedge_next(g), previous = halfedge_previous(g);
    const int32_t at_next = side_of(d, next), at_previous = side_of(d, previous);
    const int32_t corner = d->corners[g], edge = d->edges[next];
    d->corners[g] = d->corners[next];
    d->corners[next] = corner;
    d->edges[next] = d->edges[previous];
    d->edges[previous] = edge;
    d->sides[at_next] = previous;
    d->sides[at_previous] = next;
    for (int c = 0; c < 3; c++) { /* an edge with both of its sides here changes twice */
        const int32_t e = d->edges[g - g % 3 + c];
        d->alike[e] = !d->alike[e];
    }
}

/* Makes the other triangle on edge e run against this one, and show the same copies along it. */
static orb_status align(flipper *work, int32_t e, orb_error *error) {
    orb_delaunay *d = work->result;
    const int32_t h = d->sides[2 * e], g = d->sides[2 * e + 1];
    const int32_t from = d->alike[e] ? g : halfedge_next(g), to = d->alike[e] ? halfedge_next(g) : g;
    const int32_t apex = halfedge_previous(g), hn = halfedge_next(h);
    const bool by_from = !work->special[d->copies->vertex[d->corners[h]]];
    int32_t copy = d->corners[apex];
    if (d->corners[h] != d->corners[from] || d->corners[hn] != d->corners[to]) {
        const int32_t here = by_from ? d->corners[h] : d->corners[hn];
        const int32_t there = by_from ? d->corners[from] : d->corners[to];
        orb_status status = frames_carry(work->frames, here, there, d->corners[apex], &copy, error);
        if (status != ORB_OK)
            return status;
    }
    if (d->alike[e])
        turn_over(d, g);
    d->corners[g] = d->corners[hn];
    d->corners[halfedge_next(g)] = d->corners[h];
    d->corners[apex] = copy;
    return ORB_OK;
}

/* Replaces p -> q by s -> r: the triangles become s r p and r s q. */
static void flip(orb_delaunay *d, int32_t e, double length) {
    const int32_t h = d->sides[2 * e], g = d->sides[2 * e + 1];
    const int32_t hn = halfedge_next(h), hp = halfedge_previous(h), gn = halfedge_next(g), gp = halfedge_previous(g);
    const int32_t p = d->corners[h], q = d->corners[g], r = d->corners[hp], s = d->corners[gp];
    const int32_t from[4] = {hp, gn, gp, hn}, to[4] = {hn, hp, gn, gp}; /* rp, ps, sq, qr */
    int32_t edge[4], side[4];
    for (int k = 0; k < 4; k++) {
        edge[k] = d->edges[from[k]];
        side[k] = side_of(d, from[k]);
    }
    for (int k = 0; k < 4; k++) {
        d->edges[to[k]] = edge[k];
        d->sides[side[k]] = to[k];
    }
    d->corners[h] = s;
    d->corners[hn] = r;
    d->corners[hp] = p;
    d->corners[g] = r;
    d->corners[gn] = s;
    d->corners[gp] = q;
    d->lengths[e] = length;
    d->flipped[e] = true;
    d->n_flips++;
}

/* ------------------------------------------------------------------------------------------------------ the loop */

static void push(flipper *work, int32_t e) {
    if (work->stacked[e])
        return;
    work->stacked[e] = true;
    work->stack[work->height++] = e;
}

/* The vertices of an edge inside, and those across it. */
static void ends_of(const orb_delaunay *d, int32_t e, int32_t *p, int32_t *q, int32_t *r, int32_t *s) {
    const int32_t h = d->sides[2 * e], g = d->sides[2 * e + 1], *vertex = d->copies->vertex;
    *p = vertex[d->corners[h]];
    *q = vertex[d->corners[halfedge_next(h)]];
    *r = vertex[d->corners[halfedge_previous(h)]];
    *s = vertex[d->corners[halfedge_previous(g)]];
}

/* Whether the two triangles on an edge show the same copies along it, run against one another: then they lie in one
 * frame, whatever fixes the edge's ends. */
static bool in_one_frame(const orb_delaunay *d, int32_t e) {
    const int32_t h = d->sides[2 * e], g = d->sides[2 * e + 1];
    return !d->alike[e] && d->corners[h] == d->corners[halfedge_next(g)] &&
           d->corners[halfedge_next(h)] == d->corners[g];
}

static bool may_flip(const flipper *work, int32_t e) {
    const orb_delaunay *d = work->result;
    const int32_t h = d->sides[2 * e], g = d->sides[2 * e + 1];
    if (g < 0 || g / 3 == h / 3 || (work->keep && work->keep[e]))
        return false;
    int32_t p, q, r, s;
    ends_of(d, e, &p, &q, &r, &s);
    if (work->special[p] && work->special[q] && !in_one_frame(d, e))
        return false;
    const int32_t lost = p == q ? 2 : 1; /* with fewer than three edges a free vertex would lie on its neighbours */
    return (work->special[p] || work->degree[p] - lost >= 3) && (work->special[q] || work->degree[q] - lost >= 3);
}

/* The flip, and the degrees that it changes. */
static void flip_counted(flipper *work, int32_t e, double length) {
    int32_t p, q, r, s;
    ends_of(work->result, e, &p, &q, &r, &s);
    work->degree[p]--;
    work->degree[q]--;
    work->degree[r]++;
    work->degree[s]++;
    flip(work->result, e, length);
}

static orb_status flip_all(flipper *work, orb_error *error) {
    orb_delaunay *d = work->result;
    const int64_t most = (int64_t)FLIPS_PER_EDGE * d->n_edges;
    for (int32_t e = d->n_edges; e-- > 0;)
        push(work, e);
    while (work->height > 0 && d->n_flips < most) {
        const int32_t e = work->stack[--work->height];
        work->stacked[e] = false;
        if (!may_flip(work, e))
            continue;
        const quad around = measure(d, e);
        double length;
        if (!is_too_long(&around) || !other_diagonal(&around, &length))
            continue;
        orb_status status = align(work, e, error);
        if (status != ORB_OK)
            return status;
        flip_counted(work, e, length);
        for (int k = 0; k < 2; k++) {
            push(work, d->edges[halfedge_next(d->sides[2 * e + k])]);
            push(work, d->edges[halfedge_previous(d->sides[2 * e + k])]);
        }
    }
    return ORB_OK;
}

/* ------------------------------------------------------------------------------------------------------- mirrors */

/* Whether a vertex on the boundary is left with three edges in the doubled surface, when one on the mirror goes, or is
 * a corner, which stays where it is. */
static bool can_spare(const flipper *work, const orb_mirrors *mirrors, int32_t vertex) {
    const int32_t inside = work->degree[vertex] - 2, on_mirror = 2 - work->spared[vertex];
    return mirrors->of[vertex] < 0 || 2 * inside + on_mirror - 1 >= 3;
}

/* Joins corners to their mirror images where they lie across an edge on a mirror from an obtuse angle. */
static orb_status flip_across_mirrors(flipper *work, const orb_mirrors *mirrors, orb_error *error) {
    orb_delaunay *d = work->result;
    const int32_t *vertex = d->copies->vertex;
    orb_status status = ORB_OK;
    for (int32_t e = 0; e < d->n_edges && status == ORB_OK; e++) {
        const int32_t h = d->sides[2 * e], next = halfedge_next(h), apex = d->corners[halfedge_previous(h)];
        if (d->sides[2 * e + 1] >= 0 || (work->keep && work->keep[e]) || work->special[vertex[apex]])
            continue;
        const double length[3] = {d->lengths[e], d->lengths[d->edges[next]],
                                  d->lengths[d->edges[halfedge_previous(h)]]};
        const int32_t p = vertex[d->corners[h]], q = vertex[d->corners[next]];
        const int32_t here = mirrors->of[p] >= 0 ? h : next, mirror = mirrors->of[here == h ? p : q];
        if (mirror < 0 || !(sides_double_area(length) > 0) || sides_dot(length, 0) >= 0 ||
            !can_spare(work, mirrors, p) || !can_spare(work, mirrors, q))
            continue;
        status =
            frames_reflect(work->frames, d->corners[here], mirrors->reflections[mirror], apex, &d->across[e], error);
        vertex = d->copies->vertex;
        work->spared[p]++;
        work->spared[q]++;
        d->n_flips++;
    }
    return status;
}

/* --------------------------------------------------------------------------------------------- making and freeing */

static orb_status start(const orb_mesh *mesh, const orb_copies *copies, const double *lengths, orb_delaunay *d,
                        orb_error *error) {
    const size_t corners = 3 * (size_t)mesh->n_triangles, edges = (size_t)mesh->n_edges;
    d->n_triangles = mesh->n_triangles;
    d->n_edges = mesh->n_edges;
    d->corners = malloc((corners + 1) * sizeof *d->corners);
    d->edges = malloc((corners + 1) * sizeof *d->edges);
    d->sides = malloc((2 * edges + 1) * sizeof *d->sides);
    d->alike = malloc((edges + 1) * sizeof *d->alike);
    d->lengths = malloc((edges + 1) * sizeof *d->lengths);
    d->flipped = calloc(edges + 1, sizeof *d->flipped);
    d->across = malloc((edges + 1) * sizeof *d->across);
    if (!d->corners || !d->edges || !d->sides || !d->alike || !d->lengths || !d->flipped || !d->across)
        return error_memory(error);
    memcpy(d->corners, copies->triangles, corners * sizeof *d->corners);
    memcpy(d->edges, mesh->edge, corners * sizeof *d->edges);
    memcpy(d->lengths, lengths, edges * sizeof *d->lengths);
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        const int32_t h = mesh->edge_halfedge[e], g = mesh->twin[h];
        d->sides[2 * e] = h;
        d->sides[2 * e + 1] = g;
        d->across[e] = -1;
        d->alike[e] = g >= 0 && halfedge_from(mesh, h) == halfedge_from(mesh, g);
    }
    return ORB_OK;
}

orb_status delaunay_create(const orb_mesh *mesh, const orb_geometry *geometry, const orb_copies *copies,
                           const double *lengths, const uint8_t *keep, const bool *special, const orb_mirrors *mirrors,
                           orb_delaunay **result, orb_error *error) {
    *result = NULL;
    orb_delaunay *delaunay = calloc(1, sizeof *delaunay);
    if (!delaunay)
        return error_memory(error);
    flipper work = {.result = delaunay, .keep = keep, .special = special};
    orb_status status = start(mesh, copies, lengths, delaunay, error);
    if (status == ORB_OK)
        status = frames_create(geometry, copies, mesh->n_vertices, &work.frames, error);
    if (status != ORB_OK)
        goto done;
    delaunay->copies = frames_copies(work.frames);
    work.stack = malloc(((size_t)mesh->n_edges + 1) * sizeof *work.stack);
    work.stacked = calloc((size_t)mesh->n_edges + 1, sizeof *work.stacked);
    work.degree = calloc((size_t)mesh->n_vertices + 1, sizeof *work.degree);
    work.spared = calloc((size_t)mesh->n_vertices + 1, sizeof *work.spared);
    if (work.stack && work.stacked && work.degree && work.spared) {
        for (int32_t e = 0; e < mesh->n_edges; e++) {
            work.degree[halfedge_from(mesh, mesh->edge_halfedge[e])]++;
            work.degree[halfedge_to(mesh, mesh->edge_halfedge[e])]++;
        }
        status = flip_all(&work, error);
        if (status == ORB_OK && mirrors)
            status = flip_across_mirrors(&work, mirrors, error);
    } else {
        status = error_memory(error);
    }
    if (status != ORB_OK)
        goto done;
    status = error_set(error, ORB_OK, "%s", "");
    *result = delaunay;
    delaunay = NULL;
done:
    free(work.stack);
    free(work.stacked);
    free(work.degree);
    free(work.spared);
    frames_free(work.frames);
    delaunay_free(delaunay);
    return status;
}

void delaunay_free(orb_delaunay *delaunay) {
    if (!delaunay)
        return;
    free(delaunay->corners);
    free(delaunay->edges);
    free(delaunay->sides);
    free(delaunay->alike);
    free(delaunay->lengths);
    free(delaunay->flipped);
    free(delaunay->across);
    holonomy_free(delaunay->copies);
    free(delaunay);
}
