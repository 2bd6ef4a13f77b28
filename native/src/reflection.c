/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * A vertex and its image agree in every direction along the plane. So the vertices are sorted by one such coordinate, and
 * the image of a vertex is sought from its own place in this list outwards, until that coordinate alone is farther away
 * than the best so far. */
#include "reflection.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double nearest_edge = 0.25, nearest_size = 1e-3; /* tolerances of images */
enum { SAMPLE = 64, MOST_SWEEPS = 30 };

typedef struct ranked {
    double along;
    int32_t vertex;
} ranked;

typedef struct finder {
    const orb_mesh *mesh;
    double *points; /* [n_vertices*3] moved by -origin and divided by unit, so that no square overflows */
    double origin[3], unit;
    double centre[3], size; /* of the points; the size squared */
    double *tolerance;      /* [n_vertices] squared */
    ranked *ranks;          /* [n_used_vertices] */
} finder;

static int by_place(const void *a, const void *b) {
    const ranked *x = a, *y = b;
    if (x->along != y->along)
        return x->along < y->along ? -1 : 1;
    return (x->vertex > y->vertex) - (x->vertex < y->vertex);
}

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static const double *point(const finder *f, int32_t v) { return f->points + 3 * (size_t)v; }

static void normalise(finder *f) {
    const orb_mesh *mesh = f->mesh;
    const double *origin = mesh->vertices + 3 * (size_t)mesh->triangles[0];
    double largest = 0;
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        for (int c = 0; c < 3 && mesh->vertex_halfedge[v] >= 0;
             c++) /* halves, so that the difference cannot overflow */
            largest = fmax(largest, fabs(0.5 * mesh->vertices[3 * (size_t)v + (size_t)c] - 0.5 * origin[c]));
    f->unit = largest > 0 ? ldexp(1, ilogb(largest) < -1000 ? -1000 : ilogb(largest)) : 1;
    memcpy(f->origin, origin, sizeof f->origin);
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        for (int c = 0; c < 3; c++)
            f->points[3 * (size_t)v + (size_t)c] =
                mesh->vertices[3 * (size_t)v + (size_t)c] / f->unit - origin[c] / f->unit;
}

/* --- nearest vertices -------------------------------------------------------------------------------------------- */

/* Sorts the vertices along a direction of the plane in which no grid has two alike. */
static void rank_along(finder *f, const double normal[3], double direction[3]) {
    const double skew[3] = {0.8191, 0.4673, 0.3327};
    double height = dot(skew, normal);
    if (fabs(height) > 0.95) { /* nearly orthogonal: another one */
        for (int c = 0; c < 3; c++)
            direction[c] = skew[(c + 1) % 3] * (c == 1 ? -1 : 1);
        height = dot(direction, normal);
    } else {
        memcpy(direction, skew, sizeof skew);
    }
    for (int c = 0; c < 3; c++)
        direction[c] -= height * normal[c];
    const double length = sqrt(dot(direction, direction));
    for (int c = 0; c < 3; c++)
        direction[c] /= length;
    int32_t n = 0;
    for (int32_t v = 0; v < f->mesh->n_vertices; v++)
        if (f->mesh->vertex_halfedge[v] >= 0)
            f->ranks[n++] = (ranked){dot(direction, point(f, v)), v};
    qsort(f->ranks, (size_t)n, sizeof *f->ranks, by_place);
}

static int32_t first_from(const finder *f, double along) {
    int32_t low = 0, high = f->mesh->n_used_vertices;
    while (low < high) {
        const int32_t middle = low + (high - low) / 2;
        if (f->ranks[middle].along < along)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* The vertex nearest to a point, if its squared distance is at most `within`; else -1. Of equally near ones the lowest. */
static int32_t nearest(const finder *f, const double where[3], const double direction[3], double within) {
    const double along = dot(where, direction);
    int32_t right = first_from(f, along), left = right - 1, found = -1;
    double best = within;
    for (bool more = true; more;) {
        more = false;
        for (int side = 0; side < 2; side++) {
            const int32_t at = side ? left : right;
            if (at < 0 || at >= f->mesh->n_used_vertices)
                continue;
            const double gap = f->ranks[at].along - along;
            if (gap * gap > best)
                continue;
            more = true;
            if (side)
                left--;
            else
                right++;
            const int32_t v = f->ranks[at].vertex;
            double square = 0;
            for (int c = 0; c < 3; c++)
                square += (point(f, v)[c] - where[c]) * (point(f, v)[c] - where[c]);
            if (square < best || (square == best && (found < 0 || v < found))) {
                best = square;
                found = v;
            }
        }
    }
    return found;
}

static void reflect(const double p[3], const double plane[4], double image[3]) {
    const double height = dot(p, plane) - plane[3];
    for (int c = 0; c < 3; c++)
        image[c] = p[c] - 2 * height * plane[c];
}

static int32_t image_of(const finder *f, int32_t v, const double plane[4], const double direction[3], bool exact) {
    double where[3];
    reflect(point(f, v), plane, where);
    return nearest(f, where, direction, exact ? f->tolerance[v] : INFINITY);
}

/* --- planes ------------------------------------------------------------------------------------------------------ */

static double triangle_area(const finder *f, int32_t t) {
    const int32_t *corner = f->mesh->triangles + 3 * (size_t)t;
    const double *a = point(f, corner[0]), *b = point(f, corner[1]), *c = point(f, corner[2]);
    double square = 0;
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        const double part = (b[i] - a[i]) * (c[j] - a[j]) - (b[j] - a[j]) * (c[i] - a[i]);
        square += part * part;
    }
    return 0.5 * sqrt(square);
}

static void triangle_middle(const finder *f, int32_t t, double middle[3]) {
    for (int c = 0; c < 3; c++) {
        middle[c] = 0;
        for (int32_t h = 3 * t; h < 3 * t + 3; h++)
            middle[c] += point(f, halfedge_from(f->mesh, h))[c] / 3;
    }
}

/* Centre and second moments of area, size, and how far off an image may be. */
static void measure(finder *f, double moments[3][3]) {
    const orb_mesh *mesh = f->mesh;
    double total = 0, middle[3];
    memset(moments, 0, 9 * sizeof moments[0][0]);
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        const double area = triangle_area(f, t);
        triangle_middle(f, t, middle);
        total += area;
        for (int c = 0; c < 3; c++)
            f->centre[c] += area * middle[c];
    }
    for (int c = 0; c < 3; c++)
        f->centre[c] = total > 0 ? f->centre[c] / total : 0;
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        const double area = triangle_area(f, t);
        triangle_middle(f, t, middle);
        for (int c = 0; c < 3; c++)
            for (int d = 0; d < 3; d++)
                moments[c][d] += area * (middle[c] - f->centre[c]) * (middle[d] - f->centre[d]);
    }
    f->size = 0;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        f->tolerance[v] = INFINITY;
        double offset[3];
        for (int c = 0; c < 3; c++)
            offset[c] = point(f, v)[c] - f->centre[c];
        if (mesh->vertex_halfedge[v] >= 0)
            f->size = fmax(f->size, dot(offset, offset));
    }
    for (int32_t h = 0; h < 3 * mesh->n_triangles; h++) {
        const double *p = point(f, halfedge_from(mesh, h)), *q = point(f, halfedge_to(mesh, h));
        const double length = nearest_edge * hypot(hypot(p[0] - q[0], p[1] - q[1]), p[2] - q[2]);
        for (int end = 0; end < 2; end++) {
            double *tolerance = f->tolerance + (end ? halfedge_to(mesh, h) : halfedge_from(mesh, h));
            *tolerance = fmin(*tolerance, fmin(length * length, nearest_size * nearest_size * f->size));
        }
    }
}

/* Jacobi's method: the columns of `axes` become the eigenvectors of a symmetric matrix. */
static void principal_axes(double matrix[3][3], double axes[3][3]) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            axes[i][j] = i == j;
    for (int sweep = 0; sweep < MOST_SWEEPS; sweep++)
        for (int p = 0; p < 2; p++)
            for (int q = p + 1; q < 3; q++) {
                if (matrix[p][q] == 0)
                    continue;
                const double angle = 0.5 * atan2(2 * matrix[p][q], matrix[q][q] - matrix[p][p]);
                const double c = cos(angle), s = sin(angle);
                for (int k = 0; k < 3; k++) {
                    const double x = matrix[k][p], y = matrix[k][q];
                    matrix[k][p] = c * x - s * y;
                    matrix[k][q] = s * x + c * y;
                }
                for (int k = 0; k < 3; k++) {
                    const double x = matrix[p][k], y = matrix[q][k];
                    matrix[p][k] = c * x - s * y;
                    matrix[q][k] = s * x + c * y;
                    const double u = axes[k][p], w = axes[k][q];
                    axes[k][p] = c * u - s * w;
                    axes[k][q] = s * u + c * w;
                }
            }
}

/* A few vertices spread over the mesh have their images. */
static bool seems_symmetric(const finder *f, const double plane[4], const double direction[3]) {
    const int32_t n = f->mesh->n_used_vertices, step = n / SAMPLE + 1;
    for (int32_t k = 0; k < n; k += step)
        if (image_of(f, f->ranks[k].vertex, plane, direction, true) < 0)
            return false;
    return true;
}

/* The plane among the points: a x + b y + c z = d of x = origin + unit * point. */
static void local_plane(const finder *f, const double plane[4], double local[4]) {
    memcpy(local, plane, 3 * sizeof *local);
    local[3] = plane[3] / f->unit;
    for (int c = 0; c < 3; c++)
        local[3] -= plane[c] * (f->origin[c] / f->unit);
}

/* Fills in the images; false, for an exact plane, if some vertex has none. */
static bool find_images(finder *f, orb_reflection *reflection, bool exact) {
    const orb_mesh *mesh = f->mesh;
    int32_t *image = reflection->image;
    double direction[3], plane[4];
    local_plane(f, reflection->plane, plane);
    rank_along(f, plane, direction);
    if (exact && !seems_symmetric(f, plane, direction))
        return false;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        image[v] = mesh->vertex_halfedge[v] < 0 ? -1 : image_of(f, v, plane, direction, exact);
        if (exact && mesh->vertex_halfedge[v] >= 0 && image[v] < 0)
            return false;
    }
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        const bool mutual = image[v] >= 0 && image[image[v]] == v;
        if (!mutual && image[v] >= 0 && exact)
            return false;
    }
    for (int32_t v = 0; v < mesh->n_vertices; v++) /* a chain of one-sided images loses its head first */
        if (image[v] >= 0 && image[image[v]] != v)
            image[v] = -1;
    return true;
}

static bool take_plane(const double given[4], orb_reflection *reflection) {
    const double length = hypot(hypot(given[0], given[1]), given[2]);
    for (int c = 0; c < 4; c++)
        reflection->plane[c] = given[c] / length;
    return length > 0 && isfinite(length) && isfinite(reflection->plane[3]);
}

static bool detect(finder *f, double moments[3][3], orb_reflection *reflection) {
    double axes[3][3];
    principal_axes(moments, axes);
    for (int k = 0; k < 6; k++) {
        for (int c = 0; c < 3; c++)
            reflection->plane[c] = k < 3 ? c == k : axes[c][k - 3];
        reflection->plane[3] = 0;
        for (int c = 0; c < 3; c++)
            reflection->plane[3] += reflection->plane[c] * (f->origin[c] + f->unit * f->centre[c]);
        if (find_images(f, reflection, true))
            return true;
    }
    return false;
}

orb_status reflection_find(const orb_mesh *mesh, const double *plane, orb_reflection **result, orb_error *error) {
    *result = NULL;
    const size_t n = (size_t)mesh->n_vertices + 1;
    finder f = {.mesh = mesh, .tolerance = malloc(n * sizeof *f.tolerance), .ranks = malloc(n * sizeof *f.ranks)};
    f.points = malloc(3 * n * sizeof *f.points);
    orb_reflection *reflection = calloc(1, sizeof *reflection);
    orb_status status = error_memory(error);
    bool found = false;
    if (reflection)
        reflection->image = malloc(n * sizeof *reflection->image);
    if (!f.points || !f.tolerance || !f.ranks || !reflection || !reflection->image)
        goto done;
    status = ORB_OK;
    if (plane && !take_plane(plane, reflection)) {
        status = error_set(error, ORB_BAD_ARGUMENT, "the mirror plane's normal (%g, %g, %g) is not a direction",
                           plane[0], plane[1], plane[2]);
        goto done;
    }
    double moments[3][3];
    normalise(&f);
    measure(&f, moments);
    found = plane ? find_images(&f, reflection, false) : detect(&f, moments, reflection);
done:
    free(f.points);
    free(f.tolerance);
    free(f.ranks);
    if (found)
        *result = reflection;
    else
        reflection_free(reflection);
    return status;
}

void reflection_free(orb_reflection *reflection) {
    if (!reflection)
        return;
    free(reflection->image);
    free(reflection);
}
