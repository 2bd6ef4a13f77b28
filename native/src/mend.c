/* Untangling a map onto the sphere. SPDX-License-Identifier: GPL-3.0-or-later */
#include "mend.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "rounding.h"

static const double pi = 3.14159265358979323846;

/* ------------------------------------------------------------------------------------------------- vectors */

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
static double length(const double a[3]) { return sqrt(dot(a, a)); }

static void cross(const double a[3], const double b[3], double c[3]) {
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}

static void subtract(const double a[3], const double b[3], double c[3]) {
    for (int k = 0; k < 3; k++)
        c[k] = a[k] - b[k];
}

static bool normalize(double a[3]) {
    double size = length(a);
    for (int k = 0; k < 3 && size > 0; k++)
        a[k] /= size;
    return size > 0;
}

/* --------------------------------------------------------------------------------------------- orientation */

bool mend_oriented(const double p[3], const double q[3], const double r[3]) {
    /* From the corner between the two shorter edges, whose differences have the most digits. */
    double pq[3], qr[3], rp[3], normal[3];
    subtract(q, p, pq);
    subtract(r, q, qr);
    subtract(p, r, rp);
    double a = length(qr), b = length(rp), c = length(pq);
    const double *corner = p, *from = rp, *to = pq;
    double size = b * c;
    if (b >= a && b >= c)
        corner = q, from = pq, to = qr, size = a * c;
    else if (c >= a && c >= b)
        corner = r, from = qr, to = rp, size = a * b;
    cross(from, to, normal); /* twice the area vector, whichever the corner */
    return dot(corner, normal) > 16 * DBL_EPSILON * size * length(corner);
}

double mend_degree(const orb_mesh *mesh, const double *positions) {
    double sum = 0;
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        const int32_t *v = mesh->triangles + 3 * (int64_t)t;
        const double *p = positions + 3 * (int64_t)v[0], *q = positions + 3 * (int64_t)v[1],
                     *r = positions + 3 * (int64_t)v[2];
        double pq[3], pr[3], normal[3];
        subtract(q, p, pq);
        subtract(r, p, pr);
        cross(pq, pr, normal);
        sum += 2 * atan2(dot(p, normal), 1 + dot(p, q) + dot(q, r) + dot(r, p));
    }
    return sum / (4 * pi);
}

/* -------------------------------------------------------------------------------------------- one vertex */

typedef struct plane_point {
    double x, y;
} plane_point;

/* a x + b y + c is the distance from an edge's line, positive on its left */
typedef struct line {
    double a, b, c;
} line;

typedef struct mender {
    const orb_mesh *mesh;
    double *positions;
    bool *marked;             /* [n_vertices] */
    int32_t *queue;           /* [n_vertices] vertices to move, by rings */
    int32_t n_queue;
    double *backup;           /* [n_vertices*3] positions of the vertices on the queue */
    line *lines;              /* [valence] */
    plane_point *polygon[2];  /* [capacity] each */
    int32_t capacity;
    int64_t moves;
} mender;

/* The tangent plane about which a ring is projected. */
typedef struct tangent {
    double centre[3], e1[3], e2[3], radius;
} tangent;

/* The half-edge after h counter-clockwise around the vertex that both leave. */
static int32_t next_around(const orb_mesh *mesh, int32_t h) { return mesh->twin[halfedge_previous(h)]; }

/* Centre: the middle of the ring, or, of one that reaches around the sphere, the direction of its area vector. */
static bool ring_tangent(const mender *m, int32_t vertex, tangent *frame) {
    double middle[3] = {0, 0, 0}, area[3] = {0, 0, 0};
    int32_t first = m->mesh->vertex_halfedge[vertex], h = first, n = 0;
    do {
        const double *a = m->positions + 3 * (int64_t)halfedge_to(m->mesh, h);
        const double *b = m->positions + 3 * (int64_t)halfedge_to(m->mesh, halfedge_next(h));
        double normal[3];
        cross(a, b, normal);
        for (int k = 0; k < 3; k++) {
            middle[k] += a[k];
            area[k] += normal[k];
        }
        n++;
        h = next_around(m->mesh, h);
    } while (h != first);
    memcpy(frame->centre, length(middle) > 0.5 * n ? middle : area, sizeof frame->centre);
    if (!normalize(frame->centre))
        return false;
    int axis = fabs(frame->centre[0]) < 0.6 ? 0 : 1;
    double other[3] = {axis == 0, axis == 1, 0};
    cross(frame->centre, other, frame->e1);
    normalize(frame->e1);
    cross(frame->centre, frame->e1, frame->e2);
    frame->radius = 0;
    do {
        double reach[3];
        subtract(m->positions + 3 * (int64_t)halfedge_to(m->mesh, h), frame->centre, reach);
        frame->radius = fmax(frame->radius, length(reach));
        h = next_around(m->mesh, h);
    } while (h != first);
    return frame->radius > 0;
}

/* The lines of the ring's edges in the frame, in units of its radius; edges without length give none. */
static int32_t ring_lines(mender *m, int32_t vertex, const tangent *frame) {
    int32_t first = m->mesh->vertex_halfedge[vertex], h = first, n = 0;
    do {
        const double *a = m->positions + 3 * (int64_t)halfedge_to(m->mesh, h);
        const double *b = m->positions + 3 * (int64_t)halfedge_to(m->mesh, halfedge_next(h));
        double edge[3], normal[3], from[3];
        subtract(b, a, edge);
        cross(a, edge, normal);
        if (normalize(normal)) {
            subtract(frame->centre, a, from);
            m->lines[n++] = (line){dot(normal, frame->e1), dot(normal, frame->e2), dot(normal, from) / frame->radius};
        }
        h = next_around(m->mesh, h);
    } while (h != first);
    return n;
}

static double least_distance(const mender *m, int32_t n_lines, plane_point p) {
    double least = INFINITY;
    for (int32_t i = 0; i < n_lines; i++)
        least = fmin(least, m->lines[i].a * p.x + m->lines[i].b * p.y + m->lines[i].c);
    return least;
}

/* The part of a box around the ring whose distance from every line is at least `margin`: whether it is there, and if
 * so the mean of its corners. */
static bool kernel(mender *m, int32_t n_lines, double margin, plane_point *inside) {
    static const plane_point box[4] = {{-4, -4}, {4, -4}, {4, 4}, {-4, 4}};
    plane_point *from = m->polygon[0], *to = m->polygon[1];
    memcpy(from, box, sizeof box);
    int32_t n = 4;
    for (int32_t i = 0; i < n_lines && n > 0; i++) {
        const line *l = &m->lines[i];
        int32_t n_to = 0;
        if (2 * n > m->capacity) /* rounding can give a sliver more corners than a convex polygon has */
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

/* Moves a vertex to the point farthest inside its ring. False: it is there already, or there is no better one. */
static bool move_vertex(mender *m, int32_t vertex) {
    tangent frame;
    m->moves++;
    if (!ring_tangent(m, vertex, &frame))
        return false;
    int32_t n_lines = ring_lines(m, vertex, &frame);
    if (n_lines == 0)
        return false;
    double *x = m->positions + 3 * (int64_t)vertex, from[3];
    subtract(x, frame.centre, from);
    double up = dot(x, frame.centre);
    plane_point old = {dot(from, frame.e1) / frame.radius, dot(from, frame.e2) / frame.radius};
    if (up > 0)
        old = (plane_point){old.x / up, old.y / up};
    double before = up > 0 ? least_distance(m, n_lines, old) : -INFINITY;
    plane_point best = {0, 0}, p;
    double low = least_distance(m, n_lines, best), high = 8;
    for (int step = 0; step < 30; step++) {
        double margin = low + (high - low) / 2;
        if (kernel(m, n_lines, margin, &p)) {
            low = margin;
            best = p;
        } else {
            high = margin;
        }
    }
    if (!(least_distance(m, n_lines, best) > before + 1e-3 * fabs(before)))
        return false;
    double to[3];
    for (int k = 0; k < 3; k++)
        to[k] = frame.centre[k] + frame.radius * (best.x * frame.e1[k] + best.y * frame.e2[k]);
    normalize(to);
    memcpy(x, to, sizeof to);
    return true;
}

/* ------------------------------------------------------------------------------------------------ regions */

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

/* Puts the vertices of bad triangles on the queue, and `rings` rings of vertices around them; returns how many
 * triangles are bad. */
static int64_t collect(mender *m, bool as_float, int32_t rings) {
    int64_t bad = 0;
    m->n_queue = 0;
    memset(m->marked, 0, (size_t)m->mesh->n_vertices * sizeof *m->marked);
    for (int32_t t = 0; t < m->mesh->n_triangles; t++) {
        if (!is_bad(m, t, as_float))
            continue;
        bad++;
        for (int c = 0; c < 3; c++) {
            int32_t v = m->mesh->triangles[3 * (int64_t)t + c];
            if (!m->marked[v])
                m->queue[m->n_queue++] = v;
            m->marked[v] = true;
        }
    }
    for (int32_t begin = 0; rings > 0 && begin < m->n_queue; rings--) {
        int32_t end = m->n_queue;
        for (; begin < end; begin++) {
            int32_t first = m->mesh->vertex_halfedge[m->queue[begin]], h = first;
            do {
                int32_t v = halfedge_to(m->mesh, h);
                if (!m->marked[v])
                    m->queue[m->n_queue++] = v;
                m->marked[v] = true;
                h = next_around(m->mesh, h);
            } while (h != first);
        }
    }
    return bad;
}

/* One pass over the queue and one back; how many vertices moved. */
static int32_t sweep(mender *m) {
    int32_t moved = 0;
    for (int32_t i = 0; i < m->n_queue; i++)
        moved += move_vertex(m, m->queue[i]);
    for (int32_t i = m->n_queue - 1; i >= 0; i--)
        moved += move_vertex(m, m->queue[i]);
    return moved;
}

/* Sends every vertex of the queue to the mean of its neighbours, over and over: with what lies around held, a crumpled
 * patch becomes Tutte's embedding, as nearly as the sphere allows. If that does not leave fewer bad triangles (and
 * none flipped, if none was), takes it back. */
static bool smooth(mender *m, bool as_float, int64_t bad, int32_t rings) {
    for (int32_t i = 0; i < m->n_queue; i++)
        memcpy(m->backup + 3 * (int64_t)i, m->positions + 3 * (int64_t)m->queue[i], 3 * sizeof(double));
    for (int32_t pass = 0; pass < 20 * (rings + 2); pass++)
        for (int32_t i = 0; i < m->n_queue; i++) {
            int32_t first = m->mesh->vertex_halfedge[m->queue[i]], h = first;
            double mean[3] = {0, 0, 0};
            do {
                const double *a = m->positions + 3 * (int64_t)halfedge_to(m->mesh, h);
                for (int k = 0; k < 3; k++)
                    mean[k] += a[k];
                h = next_around(m->mesh, h);
            } while (h != first);
            if (normalize(mean))
                memcpy(m->positions + 3 * (int64_t)m->queue[i], mean, sizeof mean);
        }
    if (count_bad(m, as_float) < bad && (!as_float || count_bad(m, false) == 0))
        return true;
    for (int32_t i = 0; i < m->n_queue; i++)
        memcpy(m->positions + 3 * (int64_t)m->queue[i], m->backup + 3 * (int64_t)i, 3 * sizeof(double));
    return false;
}

/* Moves the vertices of bad triangles, and with every failure more rings around them, until none is bad or `budget`
 * moves are spent. Returns how many triangles are still bad. */
static int64_t untangle(mender *m, bool as_float, int64_t budget) {
    int32_t rings = 0;
    int64_t least = INT64_MAX, end = m->moves + budget;
    for (;;) {
        int64_t bad = collect(m, as_float, rings);
        if (bad == 0 || m->moves >= end)
            return bad;
        if (bad < least - least / 8) {
            least = bad;
        } else if (smooth(m, as_float, bad, rings)) {
            m->moves += m->n_queue;
            least = INT64_MAX;
            continue;
        } else {
            rings += 1 + rings / 2;
        }
        for (int i = 0; i < 4 && sweep(m) > 0; i++)
            ;
    }
}

static void mender_free(mender *m) {
    free(m->marked);
    free(m->queue);
    free(m->backup);
    free(m->lines);
    free(m->polygon[0]);
    free(m->polygon[1]);
}

static orb_status mender_create(const orb_mesh *mesh, double *positions, mender *m, orb_error *error) {
    *m = (mender){.mesh = mesh, .positions = positions};
    int32_t valence = 0;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        int32_t first = mesh->vertex_halfedge[v], h = first, n = 0;
        if (first < 0)
            continue;
        do {
            n++;
            h = next_around(mesh, h);
        } while (h != first);
        valence = n > valence ? n : valence;
    }
    m->capacity = 2 * (valence + 8);
    m->marked = malloc((size_t)mesh->n_vertices * sizeof *m->marked);
    m->queue = malloc((size_t)mesh->n_vertices * sizeof *m->queue);
    m->backup = malloc((size_t)mesh->n_vertices * 3 * sizeof *m->backup);
    m->lines = malloc((size_t)valence * sizeof *m->lines);
    m->polygon[0] = malloc((size_t)m->capacity * sizeof(plane_point));
    m->polygon[1] = malloc((size_t)m->capacity * sizeof(plane_point));
    if (!m->marked || !m->queue || !m->backup || !m->lines || !m->polygon[0] || !m->polygon[1])
        return error_memory(error);
    return ORB_OK;
}

static orb_status error_flipped(const mender *m, orb_error *error) {
    orb_found found = {0};
    for (int32_t t = 0; t < m->mesh->n_triangles; t++)
        if (is_bad(m, t, false))
            found_add(&found, t);
    return error_set_elements(error, ORB_CERTIFICATE_FAILED, ORB_TRIANGLE, found.elements, found.entries, found.found,
                              "%lld triangles of the map onto the whole sphere are flipped and could not be mended: "
                              "move a cone nearer to them, or split the mesh along the seam.",
                              (long long)found.found);
}

orb_status mend_sphere(const orb_mesh *mesh, double *positions, int64_t *mended, orb_error *error) {
    mender m;
    orb_status status = mender_create(mesh, positions, &m, error);
    if (status != ORB_OK)
        goto done;
    int64_t flipped = collect(&m, false, 0), n = mesh->n_vertices;
    if (mended)
        *mended = flipped;
    if (untangle(&m, false, 100 * n + 100000) > 0) {
        status = error_flipped(&m, error);
        goto done;
    }
    untangle(&m, true, 20 * n + 100000);
    double degree = mend_degree(mesh, positions);
    status = !(fabs(degree - 1) < 1e-6)
                 ? error_set(error, ORB_CERTIFICATE_FAILED,
                             "The map onto the whole sphere covers it %.3g times instead of once: pick other cones.",
                             degree)
                 : error_set(error, ORB_OK, "%s", "");
done:
    mender_free(&m);
    return status;
}
