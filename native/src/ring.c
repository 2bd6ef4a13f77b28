/* The kernel of a ring, by clipping. SPDX-License-Identifier: GPL-3.0-or-later */
#include "ring.h"

#include <stdlib.h>
#include <string.h>

#include "vector3.h"

typedef struct plane_point {
    double x, y;
} plane_point;

/* a x + b y + c is the distance from an edge's line, positive on its left */
typedef struct line {
    double a, b, c;
} line;

struct orb_ring {
    const orb_mesh *mesh;
    int32_t valence; /* the greatest */
    line *lines;     /* [valence] */
    int32_t capacity;
    plane_point *polygon[2]; /* [capacity] each */
};

/* The tangent plane about which a ring is projected. */
typedef struct tangent {
    double centre[3], e1[3], e2[3], radius;
} tangent;

orb_status ring_create(const orb_mesh *mesh, orb_ring **result, orb_error *error) {
    *result = NULL;
    orb_ring *ring = calloc(1, sizeof *ring);
    if (!ring)
        return error_memory(error);
    ring->mesh = mesh;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        int32_t first = mesh->vertex_halfedge[v], h = first, n = 0;
        if (first < 0)
            continue;
        do {
            n++;
            h = ring_next(mesh, h);
        } while (h != first);
        ring->valence = n > ring->valence ? n : ring->valence;
    }
    ring->capacity = 2 * (ring->valence + 8);
    ring->lines = malloc(((size_t)ring->valence + 1) * sizeof *ring->lines);
    for (int i = 0; i < 2; i++)
        ring->polygon[i] = malloc((size_t)ring->capacity * sizeof(plane_point));
    if (!ring->lines || !ring->polygon[0] || !ring->polygon[1]) {
        ring_free(ring);
        return error_memory(error);
    }
    *result = ring;
    return ORB_OK;
}

void ring_free(orb_ring *ring) {
    if (!ring)
        return;
    free(ring->lines);
    free(ring->polygon[0]);
    free(ring->polygon[1]);
    free(ring);
}

/* Centre: the middle of the ring, or, of one that reaches around the sphere, the direction of its area vector. */
static bool ring_tangent(const orb_mesh *mesh, const double *positions, int32_t vertex, tangent *frame) {
    double middle[3] = {0, 0, 0}, area[3] = {0, 0, 0};
    int32_t first = mesh->vertex_halfedge[vertex], h = first, n = 0;
    do {
        const double *a = positions + 3 * (int64_t)halfedge_to(mesh, h);
        const double *b = positions + 3 * (int64_t)halfedge_to(mesh, halfedge_next(h));
        double normal[3];
        vector_cross(a, b, normal);
        for (int k = 0; k < 3; k++) {
            middle[k] += a[k];
            area[k] += normal[k];
        }
        n++;
        h = ring_next(mesh, h);
    } while (h != first);
    memcpy(frame->centre, vector_length(middle) > 0.5 * n ? middle : area, sizeof frame->centre);
    if (!vector_normalize(frame->centre))
        return false;
    int axis = fabs(frame->centre[0]) < 0.6 ? 0 : 1;
    double other[3] = {axis == 0, axis == 1, 0};
    vector_cross(frame->centre, other, frame->e1);
    vector_normalize(frame->e1);
    vector_cross(frame->centre, frame->e1, frame->e2);
    frame->radius = 0;
    do {
        double reach[3];
        vector_subtract(positions + 3 * (int64_t)halfedge_to(mesh, h), frame->centre, reach);
        frame->radius = fmax(frame->radius, vector_length(reach));
        h = ring_next(mesh, h);
    } while (h != first);
    return frame->radius > 0;
}

/* The lines of the ring's edges in the frame, in units of its radius; edges without length give none. */
static int32_t ring_lines(orb_ring *ring, const double *positions, int32_t vertex, const tangent *frame) {
    int32_t first = ring->mesh->vertex_halfedge[vertex], h = first, n = 0;
    do {
        const double *a = positions + 3 * (int64_t)halfedge_to(ring->mesh, h);
        const double *b = positions + 3 * (int64_t)halfedge_to(ring->mesh, halfedge_next(h));
        double edge[3], normal[3], from[3];
        vector_subtract(b, a, edge);
        vector_cross(a, edge, normal);
        if (vector_normalize(normal)) {
            vector_subtract(frame->centre, a, from);
            ring->lines[n++] = (line){vector_dot(normal, frame->e1), vector_dot(normal, frame->e2),
                                      vector_dot(normal, from) / frame->radius};
        }
        h = ring_next(ring->mesh, h);
    } while (h != first);
    return n;
}

static double least_distance(const orb_ring *ring, int32_t n_lines, plane_point p) {
    double least = INFINITY;
    for (int32_t i = 0; i < n_lines; i++)
        least = fmin(least, ring->lines[i].a * p.x + ring->lines[i].b * p.y + ring->lines[i].c);
    return least;
}

/* The part of a box around the ring whose distance from every line is at least `margin`: whether it is there, and if
 * so the mean of its corners. */
static bool kernel(orb_ring *ring, int32_t n_lines, double margin, plane_point *inside) {
    static const plane_point box[4] = {{-4, -4}, {4, -4}, {4, 4}, {-4, 4}};
    plane_point *from = ring->polygon[0], *to = ring->polygon[1];
    memcpy(from, box, sizeof box);
    int32_t n = 4;
    for (int32_t i = 0; i < n_lines && n > 0; i++) {
        const line *l = &ring->lines[i];
        int32_t n_to = 0;
        if (2 * n > ring->capacity) /* rounding can give a sliver more corners than a convex polygon has */
            return false;
        double last = l->a * from[n - 1].x + l->b * from[n - 1].y + l->c - margin;
        for (int32_t j = 0; j < n; j++) {
            double here = l->a * from[j].x + l->b * from[j].y + l->c - margin;
            if ((here < 0) != (last < 0)) {
                plane_point p = from[j > 0 ? j - 1 : n - 1], q = from[j];
                double t = last / (last - here);
                to[n_to++] = (plane_point){p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)};
            }
            if (here >= 0)
                to[n_to++] = from[j];
            last = here;
        }
        plane_point *swap = from;
        from = to;
        to = swap;
        n = n_to;
    }
    *inside = (plane_point){0, 0};
    for (int32_t j = 0; j < n; j++) {
        inside->x += from[j].x / n;
        inside->y += from[j].y / n;
    }
    return n > 0;
}

bool ring_centre(orb_ring *ring, double *positions, int32_t vertex) {
    tangent frame;
    if (!ring_tangent(ring->mesh, positions, vertex, &frame))
        return false;
    int32_t n_lines = ring_lines(ring, positions, vertex, &frame);
    if (n_lines == 0)
        return false;
    double *x = positions + 3 * (int64_t)vertex, from[3], to[3];
    vector_subtract(x, frame.centre, from);
    double up = vector_dot(x, frame.centre);
    plane_point old = {vector_dot(from, frame.e1) / frame.radius, vector_dot(from, frame.e2) / frame.radius};
    if (up > 0)
        old = (plane_point){old.x / up, old.y / up};
    double before = up > 0 ? least_distance(ring, n_lines, old) : -INFINITY;
    plane_point best = {0, 0}, p;
    double low = least_distance(ring, n_lines, best), high = 8;
    for (int step = 0; step < 24; step++) {
        double margin = low + (high - low) / 2;
        if (kernel(ring, n_lines, margin, &p)) {
            low = margin;
            best = p;
        } else {
            high = margin;
        }
    }
    if (!(least_distance(ring, n_lines, best) > before + 1e-3 * fabs(before)))
        return false;
    for (int k = 0; k < 3; k++)
        to[k] = frame.centre[k] + frame.radius * (best.x * frame.e1[k] + best.y * frame.e2[k]);
    vector_normalize(to);
    memcpy(x, to, sizeof to);
    return true;
}
