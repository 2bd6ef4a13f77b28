/* Untangling a map onto the sphere. SPDX-License-Identifier: GPL-3.0-or-later */
#include "mend.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

#include "ring.h"
#include "rounding.h"
#include "vector3.h"

static const double pi = 3.14159265358979323846;

/* --------------------------------------------------------------------------------------------- orientation */

bool mend_oriented(const double p[3], const double q[3], const double r[3]) {
    /* From the corner between the two shorter edges, whose differences have the most digits. */
    double pq[3], qr[3], rp[3], normal[3];
    vector_subtract(q, p, pq);
    vector_subtract(r, q, qr);
    vector_subtract(p, r, rp);
    double a = vector_length(qr), b = vector_length(rp), c = vector_length(pq), size = b * c;
    const double *corner = p, *from = rp, *to = pq;
    if (b >= a && b >= c)
        corner = q, from = pq, to = qr, size = a * c;
    else if (c >= a && c >= b)
        corner = r, from = qr, to = rp, size = a * b;
    vector_cross(from, to, normal); /* twice the area vector, whichever the corner */
    return vector_dot(corner, normal) > 16 * DBL_EPSILON * size * vector_length(corner);
}

double mend_degree(const orb_mesh *mesh, const double *positions) {
    double sum = 0;
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        const int32_t *v = mesh->triangles + 3 * (int64_t)t;
        const double *p = positions + 3 * (int64_t)v[0], *q = positions + 3 * (int64_t)v[1],
                     *r = positions + 3 * (int64_t)v[2];
        double pq[3], pr[3], normal[3];
        vector_subtract(q, p, pq);
        vector_subtract(r, p, pr);
        vector_cross(pq, pr, normal);
        sum += 2 * atan2(vector_dot(p, normal), 1 + vector_dot(p, q) + vector_dot(q, r) + vector_dot(r, p));
    }
    return sum / (4 * pi);
}

/* ------------------------------------------------------------------------------------------------ regions */

typedef struct mender {
    const orb_mesh *mesh;
    double *positions, *backup; /* [n_vertices*3] */
    orb_ring *ring;
    int32_t *depth; /* [n_vertices] 0: outside the region; else rings from its border, inwards, from 1 */
    int32_t *queue; /* [n_vertices] vertices of the region, outer ones first */
    int32_t *other; /* [n_vertices] */
    int32_t n_queue;
    double work; /* done so far, in moves of one vertex */
} mender;

/* Not positively oriented; or, `as_float`, not so once it is rounded. */
static bool is_bad(const mender *m, int32_t triangle, bool as_float) {
    const double *x[3];
    double corner[3][3];
    for (int c = 0; c < 3; c++) {
        x[c] = m->positions + 3 * (int64_t)m->mesh->triangles[3 * (int64_t)triangle + c];
        for (int k = 0; k < 3 && as_float; k++)
            corner[c][k] = rounding_to_float(x[c][k]);
    }
    return !mend_oriented(x[0], x[1], x[2]) || (as_float && !mend_oriented(corner[0], corner[1], corner[2]));
}

static int64_t count_bad(const mender *m, bool as_float) {
    int64_t bad = 0;
    for (int32_t t = 0; t < m->mesh->n_triangles; t++)
        bad += is_bad(m, t, as_float);
    return bad;
}

/* Puts on the queue the neighbours of queue[begin .. end) whose depth is `from`, and gives them the depth `to`. */
static int32_t spread(mender *m, int32_t *queue, int32_t begin, int32_t end, int32_t n, int32_t from, int32_t to) {
    for (; begin < end; begin++) {
        int32_t first = m->mesh->vertex_halfedge[queue[begin]], h = first;
        do {
            int32_t v = halfedge_to(m->mesh, h);
            if (m->depth[v] == from) {
                m->depth[v] = to;
                queue[n++] = v;
            }
            h = ring_next(m->mesh, h);
        } while (h != first);
    }
    return n;
}

/* The region: the vertices of bad triangles and `rings` rings of vertices around them. */
static void find_region(mender *m, bool as_float, int32_t rings) {
    enum { OUTSIDE = 0, INSIDE = -1 };
    int32_t n = 0, border = 0;
    memset(m->depth, 0, (size_t)m->mesh->n_vertices * sizeof *m->depth);
    for (int32_t t = 0; t < m->mesh->n_triangles; t++)
        for (int c = 0; c < 3 && is_bad(m, t, as_float); c++) {
            int32_t v = m->mesh->triangles[3 * (int64_t)t + c];
            if (m->depth[v] == OUTSIDE)
                m->other[n++] = v;
            m->depth[v] = INSIDE;
        }
    for (int32_t begin = 0; rings > 0 && begin < n; rings--) {
        int32_t end = n;
        n = spread(m, m->other, begin, end, n, OUTSIDE, INSIDE);
        begin = end;
    }
    /* Depths: first the vertices with a neighbour outside, then inwards; all alike if nothing is outside. */
    for (int32_t i = 0; i < n; i++) {
        int32_t first = m->mesh->vertex_halfedge[m->other[i]], h = first;
        do {
            if (m->depth[halfedge_to(m->mesh, h)] == OUTSIDE && m->depth[m->other[i]] == INSIDE) {
                m->depth[m->other[i]] = 1;
                m->queue[border++] = m->other[i];
            }
            h = ring_next(m->mesh, h);
        } while (h != first);
    }
    m->n_queue = border;
    for (int32_t begin = 0, depth = 2; begin < m->n_queue; depth++) {
        int32_t end = m->n_queue;
        m->n_queue = spread(m, m->queue, begin, end, end, INSIDE, depth);
        begin = end;
    }
    for (int32_t i = 0; i < n; i++)
        if (m->depth[m->other[i]] == INSIDE) {
            m->depth[m->other[i]] = 1;
            m->queue[m->n_queue++] = m->other[i];
        }
}

/* ------------------------------------------------------------------------------------------------- moving */

/* Moves every vertex of the region to the middle of its ring, inwards. */
static int32_t sweep(mender *m) {
    int32_t moved = 0;
    for (int32_t i = 0; i < m->n_queue; i++)
        moved += ring_centre(m->ring, m->positions, m->queue[i]);
    m->work += m->n_queue;
    return moved;
}

/* Tutte's embedding of the region, as nearly as a sphere allows, by over-relaxation: every vertex to a weighted mean of
 * its neighbours. Edges along a ring count less than those across, since it is the tension along the rings that makes
 * a limb shrink exponentially with its length. */
static void smooth(mender *m) {
    static const double along = 0.02;
    int32_t depth = m->depth[m->queue[m->n_queue - 1]], passes = 40 + 6 * depth;
    for (int32_t pass = 0; pass < passes; pass++) {
        double omega = pass < passes - 20 ? 1.7 : 1;
        for (int32_t i = 0; i < m->n_queue; i++) {
            int32_t vertex = m->queue[i], first = m->mesh->vertex_halfedge[vertex], h = first;
            double mean[3] = {0, 0, 0}, sum = 0, *x = m->positions + 3 * (int64_t)vertex;
            do {
                int32_t v = halfedge_to(m->mesh, h);
                double w = m->depth[v] == m->depth[vertex] ? along : 1;
                for (int k = 0; k < 3; k++)
                    mean[k] += w * m->positions[3 * (int64_t)v + k];
                sum += w;
                h = ring_next(m->mesh, h);
            } while (h != first);
            for (int k = 0; k < 3; k++)
                mean[k] = x[k] + omega * (mean[k] / sum - x[k]);
            if (vector_normalize(mean))
                memcpy(x, mean, sizeof mean);
        }
    }
    m->work += 0.02 * m->n_queue * passes;
}

/* Moves the vertices of flipped triangles and a few rings around them, until none is flipped or it does not help. */
static bool unflip(mender *m) {
    for (int32_t i = 0; i < 12; i++) {
        find_region(m, false, i / 2);
        if (m->n_queue == 0)
            return true;
        for (int k = 0; k < 4 && sweep(m) > 0; k++)
            ;
    }
    return false;
}

/* Sweeps over the region a few times, or smooths it. For the sake of floats alone (`as_float`) nothing may be left
 * flipped that was not, and smoothing must leave fewer bad triangles than there were: else it is taken back. */
static bool improve(mender *m, bool as_float, bool smoothly, int64_t bad) {
    size_t size = 3 * (size_t)m->mesh->n_vertices * sizeof(double);
    memcpy(m->backup, m->positions, size);
    if (smoothly)
        smooth(m);
    for (int i = 0; i < 4 && !smoothly && sweep(m) > 0; i++)
        ;
    bool good = !as_float || (count_bad(m, false) < bad / 4 + 16 && unflip(m));
    if (good && smoothly)
        good = count_bad(m, as_float) < bad;
    if (!good)
        memcpy(m->positions, m->backup, size);
    return good;
}

/* Moves the vertices of bad triangles, and where that does not do, more and more rings around them, until none is bad
 * or the work is more than `budget` moves. Returns how many triangles are still bad. */
static int64_t untangle(mender *m, bool as_float, double budget) {
    int32_t rings = 0;
    int64_t least = INT64_MAX;
    double end = m->work + budget;
    for (;;) {
        int64_t bad = count_bad(m, as_float);
        if (bad == 0 || m->work >= end)
            return bad;
        bool stuck = bad >= least - least / 8;
        if (stuck && as_float && rings > 15) /* for a float not the whole sphere */
            rings = 0;
        else if (stuck && rings < m->mesh->n_vertices)
            rings = 2 * rings + 1;
        else if (!stuck && bad < least / 2 && least < INT64_MAX)
            rings /= 2;
        least = bad < least ? bad : least;
        find_region(m, as_float, rings);
        if (stuck && improve(m, as_float, true, bad)) {
            least = INT64_MAX;
            continue;
        }
        find_region(m, as_float, rings); /* what was tried has left another one */
        improve(m, as_float, false, bad);
    }
}

static orb_status error_flipped(const mender *m, orb_error *error) {
    orb_blamed blamed = {0};
    for (int32_t t = 0; t < m->mesh->n_triangles; t++)
        if (is_bad(m, t, false))
            mesh_blame(m->mesh, t, &blamed);
    return mesh_blame_error(error, ORB_CERTIFICATE_FAILED, &blamed,
                            "triangle of the map onto the whole sphere is flipped and could not be mended",
                            "triangles of the map onto the whole sphere are flipped and could not be mended",
                            "pick a cone nearer to them, or split the mesh along the seam");
}

orb_status mend_sphere(const orb_mesh *mesh, double *positions, int64_t *mended, orb_error *error) {
    size_t n = (size_t)mesh->n_vertices;
    mender m = {.mesh = mesh, .positions = positions};
    orb_status status = ring_create(mesh, &m.ring, error);
    if (status != ORB_OK)
        goto done;
    m.backup = malloc((3 * n + 1) * sizeof *m.backup);
    m.depth = malloc((n + 1) * sizeof *m.depth);
    m.queue = malloc((n + 1) * sizeof *m.queue);
    m.other = malloc((n + 1) * sizeof *m.other);
    if (!m.backup || !m.depth || !m.queue || !m.other) {
        status = error_memory(error);
        goto done;
    }
    if (mended)
        *mended = count_bad(&m, false);
    if (untangle(&m, false, 50.0 * (double)n + 100000) > 0) {
        status = error_flipped(&m, error);
        goto done;
    }
    untangle(&m, true, 5.0 * (double)n + 50000);
    if (count_bad(&m, false) > 0) {
        status = error_flipped(&m, error);
        goto done;
    }
    double degree = mend_degree(mesh, positions);
    status = !(fabs(degree - 1) < 1e-6)
                 ? error_set(error, ORB_CERTIFICATE_FAILED,
                             "the map onto the whole sphere covers it %.3g times instead of once: pick other cones, "
                             "or split the mesh along the seam",
                             degree)
                 : error_set(error, ORB_OK, "%s", "");
done:
    ring_free(m.ring);
    free(m.backup);
    free(m.depth);
    free(m.queue);
    free(m.other);
    return status;
}
