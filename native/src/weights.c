/* One positive weight per edge of a mesh. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Cotangents: Pinkall and Polthier 1993. Mean values: Floater 2003, "Mean value coordinates", eq. 2.1. Both are made
 * of each triangle's three angles, which are looked at once. */
#include "weights.h"

#include <math.h>
#include <stdlib.h>

#include "triangle.h"
#include "vector3.h"

/* cot[c]: cotangent of the angle that lies opposite half-edge c. False, with cot unset, if the area is zero. */
static bool triangle_cotangents(const triangle_shape *shape, double cot[3]) {
    if (shape->double_area == 0)
        return false;
    for (int c = 0; c < 3; c++)
        cot[c] = -vector_dot(shape->edge[(c + 1) % 3], shape->edge[(c + 2) % 3]) / shape->double_area;
    return true;
}

/* part[c][k]: what the triangle adds to the mean-value weight of half-edge c at its start (k = 0) and its end (k = 1),
 * tan(half of the angle there) / length. Infinite or NaN where an angle is pi or a length is zero. */
static void triangle_mean_values(const triangle_shape *shape, double part[3][2]) {
    double tangent[3]; /* of half the angle at corner c */
    for (int c = 0; c < 3; c++) {
        const double lengths = shape->length[c] * shape->length[(c + 2) % 3];
        const double dot = -vector_dot(shape->edge[c], shape->edge[(c + 2) % 3]);
        tangent[c] = dot > 0 ? shape->double_area / (lengths + dot) : (lengths - dot) / shape->double_area;
    }
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < 2; k++)
            part[c][k] = tangent[(c + k) % 3] / shape->length[c] * shape->scale;
}

/* An error that names the triangles of zero area, or of nearly none, on the edges whose weight, or one of their
 * per_edge weights, is not positive and finite. */
static orb_status blame_triangles(const orb_mesh *mesh, const double *weights, int per_edge, orb_error *error) {
    orb_blamed flat = {0}, beside = {0};
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        bool bad = false;
        for (int32_t h = 3 * t; h < 3 * t + 3; h++) {
            const double *weight = weights + (size_t)per_edge * (size_t)mesh->edge[h];
            for (int k = 0; k < per_edge; k++)
                bad = bad || !(weight[k] > 0) || !isfinite(weight[k]);
        }
        if (!bad)
            continue;
        mesh_blame(mesh, t, &beside);
        if (triangle_measure(mesh, t).double_area == 0)
            mesh_blame(mesh, t, &flat);
    }
    const bool any = flat.triangles.found + flat.filling.found > 0;
    return mesh_blame_error(
        error, ORB_ZERO_AREA_TRIANGLE, any ? &flat : &beside, "triangle has no area", "triangles have no area",
        "weights there are not positive and finite; merge their vertices by distance, dissolve them "
        "(Mesh > Clean Up > Degenerate Dissolve), or use other weights");
}

orb_status cotangents_measure(const orb_mesh *mesh, orb_cotangents *cotangents, orb_error *error) {
    cotangents->sum = calloc((size_t)mesh->n_edges + 1, sizeof *cotangents->sum);
    cotangents->n_flat = calloc((size_t)mesh->n_edges + 1, sizeof *cotangents->n_flat);
    if (!cotangents->sum || !cotangents->n_flat) {
        cotangents_clear(cotangents);
        return error_memory(error);
    }
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        const triangle_shape shape = triangle_measure(mesh, t);
        double cot[3];
        const bool has_area = triangle_cotangents(&shape, cot);
        for (int32_t c = 0; c < 3; c++) {
            const int32_t e = mesh->edge[3 * t + c];
            if (has_area)
                cotangents->sum[e] += 0.5 * cot[c];
            else
                cotangents->n_flat[e]++;
        }
    }
    return ORB_OK;
}

void cotangents_clear(orb_cotangents *cotangents) {
    free(cotangents->sum);
    free(cotangents->n_flat);
    *cotangents = (orb_cotangents){0};
}

/* A zero-area triangle adds the clamp. */
static orb_status clamp_cotangents(const orb_mesh *mesh, const orb_cotangents *cotangents, double clamp,
                                   double *weights, int64_t *n_clamped, orb_error *error) {
    bool finite = true;
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        weights[e] = cotangents->sum[e] + cotangents->n_flat[e] * clamp;
        if (!isfinite(weights[e])) {
            finite = false;
            continue;
        }
        const bool low = weights[e] < clamp;
        if (low)
            weights[e] = clamp;
        if (low || cotangents->n_flat[e] > 0)
            ++*n_clamped;
    }
    return finite ? ORB_OK : blame_triangles(mesh, weights, 1, error);
}

/* known: of this mesh, or NULL */
static orb_status cotangent_weights(const orb_mesh *mesh, const orb_cotangents *known, double clamp, double *weights,
                                    int64_t *n_clamped, orb_error *error) {
    if (!(clamp > 0) || !isfinite(clamp))
        return error_set(error, ORB_BAD_ARGUMENT,
                         "the least cotangent weight is %g: make it positive and finite, such as 0.01", clamp);
    if (known)
        return clamp_cotangents(mesh, known, clamp, weights, n_clamped, error);
    orb_cotangents measured = {0};
    orb_status status = cotangents_measure(mesh, &measured, error);
    if (status == ORB_OK)
        status = clamp_cotangents(mesh, &measured, clamp, weights, n_clamped, error);
    cotangents_clear(&measured);
    return status;
}

orb_status weights_mean_value_both(const orb_mesh *mesh, double *weights, orb_error *error) {
    for (int32_t k = 0; k < 2 * mesh->n_edges; k++)
        weights[k] = 0;
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        const triangle_shape shape = triangle_measure(mesh, t);
        double part[3][2];
        triangle_mean_values(&shape, part);
        for (int32_t c = 0; c < 3; c++) {
            const int32_t h = 3 * t + c, e = mesh->edge[h];
            const int32_t turned = halfedge_from(mesh, h) != halfedge_from(mesh, mesh->edge_halfedge[e]);
            weights[2 * e + turned] += part[c][0];
            weights[2 * e + !turned] += part[c][1];
        }
    }
    for (int32_t k = 0; k < 2 * mesh->n_edges; k++)
        if (!(weights[k] > 0) || !isfinite(weights[k]))
            return blame_triangles(mesh, weights, 2, error);
    return ORB_OK;
}

static orb_status mean_value_weights(const orb_mesh *mesh, double *weights, orb_error *error) {
    double *both = malloc((2 * (size_t)mesh->n_edges + 1) * sizeof *both);
    if (!both)
        return error_memory(error);
    const orb_status status = weights_mean_value_both(mesh, both, error);
    for (int32_t e = 0; e < mesh->n_edges && status == ORB_OK; e++)
        weights[e] = 0.5 * (both[2 * e] + both[2 * e + 1]);
    free(both);
    return status;
}

/* --- weights given by the caller ------------------------------------------------------------------------------ */

static const double NOT_GIVEN = -1, BLAMED = -2; /* in place of a weight, while rows are read */

/* The rows' faults, each kind apart. */
typedef struct row_faults {
    int64_t no_vertices; /* rows whose first two numbers are not vertices */
    int32_t first_row;   /* the first of them */
    orb_found no_edge, bad, twice, missing;
} row_faults;

/* The edges, to be found by their vertices. */
typedef struct edge_table {
    int32_t *first; /* [n_vertices + 1] first[v] ... first[v + 1] - 1 are the edges whose lower vertex is v */
    int32_t *high;  /* [n_edges] the higher vertex, ascending within each of these ranges */
} edge_table;

static void edge_table_fill(const orb_mesh *mesh, edge_table *table) {
    int32_t v = 0;
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        const int32_t h = mesh->edge_halfedge[e], a = halfedge_from(mesh, h), b = halfedge_to(mesh, h);
        while (v <= (a < b ? a : b))
            table->first[v++] = e;
        table->high[e] = a < b ? b : a;
    }
    while (v <= mesh->n_vertices)
        table->first[v++] = mesh->n_edges;
}

/* The edge between two vertices, by bisection; -1 if there is none. */
static int32_t edge_between(const edge_table *table, int32_t a, int32_t b) {
    const int32_t low = a < b ? a : b, high = a < b ? b : a;
    int32_t begin = table->first[low], end = table->first[low + 1];
    while (begin < end) {
        const int32_t middle = begin + (end - begin) / 2;
        if (table->high[middle] == high)
            return middle;
        if (table->high[middle] < high)
            begin = middle + 1;
        else
            end = middle;
    }
    return -1;
}

static bool is_vertex(const orb_mesh *mesh, double number) {
    return number >= 0 && number < mesh->n_vertices && number == floor(number);
}

static orb_status report_faults(const row_faults *faults, const orb_request *request, const orb_mesh *mesh,
                                orb_error *error) {
    if (faults->no_vertices > 0) {
        const double *row = request->edge_weights + 3 * (size_t)faults->first_row;
        return error_set(error, ORB_BAD_WEIGHT,
                         "%lld %s not begin with two vertices of 0 to %d, first row %d (%g, %g, %g): give rows i, j, "
                         "w_ij of this mesh",
                         (long long)faults->no_vertices,
                         faults->no_vertices == 1 ? "row of edge weights does" : "rows of edge weights do",
                         (int)mesh->n_vertices - 1, (int)faults->first_row, row[0], row[1], row[2]);
    }
    const struct {
        const orb_found *found;
        const char *one, *many, *advice;
    } kinds[] = {
        {&faults->no_edge, "weight is given for a pair of vertices that is not an edge",
         "weights are given for pairs of vertices that are not edges", "leave these rows out"},
        {&faults->bad, "edge has a weight that is not positive and finite",
         "edges have weights that are not positive and finite", "give each a positive number"},
        {&faults->twice, "edge has more than one weight", "edges have more than one weight",
         "give each edge one row, in one of its directions"},
        {&faults->missing, "edge has no weight", "edges have no weight", "give every edge of the mesh a row"},
    };
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        const orb_found *found = kinds[k].found;
        if (found->found > 0)
            return error_set_elements(error, ORB_BAD_WEIGHT, ORB_EDGE, found->elements, found->entries, found->found,
                                      "%lld %s, first %d-%d: %s", (long long)found->found,
                                      found->found == 1 ? kinds[k].one : kinds[k].many, (int)found->elements[0],
                                      (int)found->elements[1], kinds[k].advice);
    }
    return ORB_OK;
}

static void read_row(const orb_mesh *mesh, const edge_table *table, const double *row, int32_t row_number,
                     double *weights, row_faults *faults) {
    if (!is_vertex(mesh, row[0]) || !is_vertex(mesh, row[1])) {
        if (faults->no_vertices++ == 0)
            faults->first_row = row_number;
        return;
    }
    const int32_t i = (int32_t)row[0], j = (int32_t)row[1], e = edge_between(table, i, j);
    if (e < 0) {
        found_add_edge(&faults->no_edge, i, j);
    } else if (weights[e] == NOT_GIVEN) {
        const bool good = row[2] > 0 && isfinite(row[2]);
        weights[e] = good ? row[2] : BLAMED;
        if (!good)
            found_add_edge(&faults->bad, i, j);
    } else if (weights[e] != BLAMED) {
        weights[e] = BLAMED;
        found_add_edge(&faults->twice, i, j);
    }
}

static orb_status given_weights(const orb_mesh *mesh, const orb_request *request, double *weights, orb_error *error) {
    if (request->n_edge_weights < 0 || (request->n_edge_weights > 0 && !request->edge_weights))
        return error_set(error, ORB_BAD_ARGUMENT,
                         "the array of edge weights is a null pointer or its count is negative: give rows i, j, w_ij");
    edge_table table = {malloc(((size_t)mesh->n_vertices + 1) * sizeof *table.first),
                        malloc((size_t)mesh->n_edges * sizeof *table.high)};
    row_faults faults = {0};
    orb_status status = ORB_OK;
    if (!table.first || !table.high) {
        status = error_memory(error);
        goto done;
    }
    edge_table_fill(mesh, &table);
    for (int32_t e = 0; e < mesh->n_edges; e++)
        weights[e] = NOT_GIVEN;
    for (int32_t r = 0; r < request->n_edge_weights; r++)
        read_row(mesh, &table, request->edge_weights + 3 * (size_t)r, r, weights, &faults);
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        const int32_t h = mesh->edge_halfedge[e];
        if (weights[e] == NOT_GIVEN)
            found_add_edge(&faults.missing, halfedge_from(mesh, h), halfedge_to(mesh, h));
    }
    status = report_faults(&faults, request, mesh, error);
done:
    free(table.first);
    free(table.high);
    return status;
}

orb_status weights_compute(const orb_mesh *mesh, const orb_request *request, const orb_cotangents *known,
                           double *weights, int64_t *n_clamped, orb_error *error) {
    int64_t counted = 0;
    orb_status status = ORB_OK;
    switch (request->weights) {
    case ORB_WEIGHTS_COTANGENT:
    case ORB_WEIGHTS_CONFORMAL:
    case ORB_WEIGHTS_DELAUNAY:
        status = cotangent_weights(mesh, known, request->clamp, weights, &counted, error);
        break;
    case ORB_WEIGHTS_MEAN_VALUE:
    case ORB_WEIGHTS_MEAN_VALUE_EXACT:
        status = mean_value_weights(mesh, weights, error);
        break;
    case ORB_WEIGHTS_UNIFORM:
        for (int32_t e = 0; e < mesh->n_edges; e++)
            weights[e] = 1;
        break;
    case ORB_WEIGHTS_GIVEN:
        status = given_weights(mesh, request, weights, error);
        break;
    default:
        status =
            error_set(error, ORB_BAD_ARGUMENT,
                      "the kind of weights is %d: choose cotangent, mean-value, uniform, given, conformal or Delaunay",
                      (int)request->weights);
    }
    if (n_clamped)
        *n_clamped = counted;
    return status;
}
