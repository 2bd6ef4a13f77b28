/* Triangle arrays -> half-edges. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The half-edges are sorted by their edge (two counting sorts), so that the half-edges of one edge lie side by side;
 * every check and every link is then one pass over the arrays. */
#include "mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "orientation.h"

/* A half-edge with one end of its edge, for sorting. */
typedef struct side {
    int32_t vertex, halfedge;
} side;

/* What mesh_create needs only while it runs. */
typedef struct workspace {
    side *sorted;   /* [n_triangles*3] by the lower, then the higher vertex of the edge; `vertex` is the higher one */
    int32_t *end;   /* [n_vertices] one past the last of `sorted` that has this lower vertex */
    int32_t *spare; /* [n_vertices] */
} workspace;

static int32_t opposite_vertex(const orb_mesh *mesh, int32_t h) { return mesh->triangles[halfedge_previous(h)]; }

/* --- sorting and linking the half-edges ----------------------------------------------------------------------- */

/* Turns counts of keys 0 ... n - 1 into the place of each key's first item. */
static void counts_to_places(int32_t *count, int32_t n) {
    int32_t place = 0;
    for (int32_t i = 0; i < n; i++) {
        const int32_t here = count[i];
        count[i] = place;
        place += here;
    }
}

/* Two stable counting sorts, the less significant key first. A key's place, moved on with each of its items, ends as
 * one past the last of them. The first sort's result lies in mesh->edge and mesh->twin, which are not in use yet:
 * fresh memory would cost as much time as the sort. */
static void sort_halfedges(orb_mesh *mesh, workspace *work) {
    const int32_t n = 3 * mesh->n_triangles;
    int32_t *high_place = work->spare, *low_place = work->end, *by_high_low = mesh->edge, *by_high = mesh->twin;
    memset(high_place, 0, (size_t)mesh->n_vertices * sizeof *high_place);
    memset(low_place, 0, (size_t)mesh->n_vertices * sizeof *low_place);
    for (int32_t h = 0; h < n; h++) {
        const int32_t a = halfedge_from(mesh, h), b = halfedge_to(mesh, h);
        low_place[a < b ? a : b]++;
        high_place[a < b ? b : a]++;
    }
    counts_to_places(high_place, mesh->n_vertices);
    counts_to_places(low_place, mesh->n_vertices);
    for (int32_t h = 0; h < n; h++) {
        const int32_t a = halfedge_from(mesh, h), b = halfedge_to(mesh, h);
        const int32_t place = high_place[a < b ? b : a]++;
        by_high[place] = h;
        by_high_low[place] = a < b ? a : b;
    }
    for (int32_t high = 0, i = 0; high < mesh->n_vertices; high++)
        for (; i < high_place[high]; i++)
            work->sorted[low_place[by_high_low[i]]++] = (side){high, by_high[i]};
}

/* One past the last half-edge on the edge of sorted[begin]; *low, at first 0, is moved on to its lower vertex. */
static int32_t edge_end(const workspace *work, int32_t begin, int32_t *low) {
    while (work->end[*low] <= begin)
        ++*low;
    int32_t end = begin + 1;
    while (end < work->end[*low] && work->sorted[end].vertex == work->sorted[begin].vertex)
        end++;
    return end;
}

/* A triangle that stands on an edge, by its third vertex. */
typedef struct standing {
    int32_t apex, triangle;
} standing;

static int compare_standing(const void *left, const void *right) {
    const standing *a = left, *b = right;
    if (a->apex != b->apex)
        return a->apex < b->apex ? -1 : 1;
    return (a->triangle > b->triangle) - (a->triangle < b->triangle);
}

/* Adds the triangles on one edge that repeat another one, of those that have the edge between their two lower
 * vertices (so that each pair is met on one edge only). */
static orb_status find_repeated(const orb_mesh *mesh, const side *sides, int32_t n, orb_found *repeated,
                                orb_error *error) {
    const int32_t high = sides[0].vertex;
    if (n == 2) { /* nearly always; sorting it would cost more than all else here */
        const int32_t h = sides[0].halfedge, g = sides[1].halfedge, apex = opposite_vertex(mesh, h);
        if (apex > high && apex == opposite_vertex(mesh, g))
            found_add(repeated, (h > g ? h : g) / 3);
        return ORB_OK;
    }
    standing *standings = malloc((size_t)n * sizeof *standings);
    if (!standings)
        return error_memory(error);
    size_t kept = 0;
    for (int32_t i = 0; i < n; i++) {
        const int32_t apex = opposite_vertex(mesh, sides[i].halfedge);
        if (apex > high)
            standings[kept++] = (standing){apex, sides[i].halfedge / 3};
    }
    qsort(standings, kept, sizeof *standings, compare_standing);
    for (size_t i = 1; i < kept; i++)
        if (standings[i].apex == standings[i - 1].apex)
            found_add(repeated, standings[i].triangle);
    free(standings);
    return ORB_OK;
}

/* Repeated triangles, edges with more than two triangles. */
static orb_status check_edges(const orb_mesh *mesh, const workspace *work, orb_error *error) {
    orb_found repeated = {0}, crowded = {0};
    for (int32_t begin = 0, low = 0, end; begin < 3 * mesh->n_triangles; begin = end) {
        end = edge_end(work, begin, &low);
        if (end - begin < 2)
            continue;
        const side *sides = work->sorted + begin;
        const orb_status status = find_repeated(mesh, sides, end - begin, &repeated, error);
        if (status != ORB_OK)
            return status;
        if (end - begin > 2)
            found_add_edge(&crowded, low, sides[0].vertex);
    }
    if (repeated.found > 0)
        return error_set_elements(
            error, ORB_REPEATED_TRIANGLE, ORB_TRIANGLE, repeated.elements, repeated.entries, repeated.found,
            "%lld %s the three vertices of another one, first %d: delete the doubled faces", (long long)repeated.found,
            repeated.found == 1 ? "triangle has" : "triangles have", (int)repeated.elements[0]);
    if (crowded.found > 0)
        return error_set_elements(error, ORB_NON_MANIFOLD_EDGE, ORB_EDGE, crowded.elements, crowded.entries,
                                  crowded.found,
                                  "%lld %s more than two triangles, first %d-%d: delete the inner faces or separate "
                                  "the parts that meet there",
                                  (long long)crowded.found, crowded.found == 1 ? "edge has" : "edges have",
                                  (int)crowded.elements[0], (int)crowded.elements[1]);
    return ORB_OK;
}

/* Numbers the edges and pairs their half-edges; at most two lie on each. */
static orb_status link_halfedges(orb_mesh *mesh, const workspace *work, orb_error *error) {
    const int32_t n = 3 * mesh->n_triangles;
    mesh->n_edges = 0;
    for (int32_t begin = 0, low = 0; begin < n; begin = edge_end(work, begin, &low))
        mesh->n_edges++;
    mesh->edge_halfedge = malloc((size_t)mesh->n_edges * sizeof *mesh->edge_halfedge);
    if (!mesh->edge_halfedge)
        return error_memory(error);
    for (int32_t begin = 0, low = 0, e = 0, end; begin < n; begin = end, e++) {
        end = edge_end(work, begin, &low);
        const int32_t h = work->sorted[begin].halfedge, g = end - begin == 2 ? work->sorted[begin + 1].halfedge : -1;
        mesh->edge_halfedge[e] = h;
        mesh->edge[h] = e;
        mesh->twin[h] = g;
        if (g < 0)
            continue;
        mesh->edge[g] = e;
        mesh->twin[g] = h;
    }
    return ORB_OK;
}

void mesh_find_boundary(const orb_mesh *mesh, bool *on_boundary) {
    memset(on_boundary, 0, (size_t)mesh->n_vertices * sizeof *on_boundary);
    for (int32_t h = 0; h < 3 * mesh->n_triangles; h++)
        if (mesh->twin[h] < 0)
            on_boundary[halfedge_from(mesh, h)] = on_boundary[halfedge_to(mesh, h)] = true;
}

/* --- vertices ------------------------------------------------------------------------------------------------- */

/* Gives each vertex its half-edge and checks that turning around it meets all of its triangles. `corners`
 * [n_vertices] is overwritten. */
static orb_status link_vertices(orb_mesh *mesh, int32_t *corners, orb_error *error) {
    const int32_t n = 3 * mesh->n_triangles;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        mesh->vertex_halfedge[v] = -1;
        corners[v] = 0;
    }
    for (int32_t h = 0; h < n; h++) {
        const int32_t v = halfedge_from(mesh, h), known = mesh->vertex_halfedge[v];
        const bool at_end = mesh->twin[h] < 0 || mesh->twin[halfedge_previous(h)] < 0;
        if (corners[v]++ == 0 || mesh->twin[h] < 0 || (at_end && mesh->twin[known] >= 0))
            mesh->vertex_halfedge[v] = h;
    }
    orb_found pinched = {0};
    mesh->n_used_vertices = 0;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        const int32_t start = mesh->vertex_halfedge[v];
        if (start < 0)
            continue;
        mesh->n_used_vertices++;
        int32_t met = 1;
        orb_turn turn = mesh_turn_start(mesh, v);
        while (mesh_turn(mesh, &turn) && turn.corner != start)
            met++;
        if (met != corners[v])
            found_add(&pinched, v);
    }
    if (pinched.found == 0)
        return ORB_OK;
    return error_set_elements(
        error, ORB_NON_MANIFOLD_VERTEX, ORB_VERTEX, pinched.elements, pinched.entries, pinched.found,
        "%lld %s parts of the surface that touch in that point only, first %d: rip it (V) or "
        "join the parts along an edge",
        (long long)pinched.found, pinched.found == 1 ? "vertex joins" : "vertices join", (int)pinched.elements[0]);
}

/* --- counts --------------------------------------------------------------------------------------------------- */

/* Floods over the triangles; adds the lowest vertex of each component to `lowest`. */
static orb_status find_components(const orb_mesh *mesh, orb_found *lowest, orb_error *error) {
    bool *seen = calloc((size_t)mesh->n_triangles, sizeof *seen);
    int32_t *stack = malloc((size_t)mesh->n_triangles * sizeof *stack);
    orb_status status = ORB_OK;
    if (!seen || !stack) {
        status = error_memory(error);
        goto done;
    }
    for (int32_t seed = 0; seed < mesh->n_triangles; seed++) {
        if (seen[seed])
            continue;
        int32_t height = 0, least = INT32_MAX;
        stack[height++] = seed;
        seen[seed] = true;
        while (height > 0) {
            const int32_t t = stack[--height];
            for (int32_t h = 3 * t; h < 3 * t + 3; h++) {
                if (mesh->triangles[h] < least)
                    least = mesh->triangles[h];
                if (mesh->twin[h] < 0 || seen[mesh->twin[h] / 3])
                    continue;
                seen[mesh->twin[h] / 3] = true;
                stack[height++] = mesh->twin[h] / 3;
            }
        }
        found_add(lowest, least);
    }
done:
    free(seen);
    free(stack);
    return status;
}

/* `seen` [n_vertices] is overwritten. */
static int32_t count_boundary_loops(const orb_mesh *mesh, int32_t *seen) {
    int32_t loops = 0;
    memset(seen, 0, (size_t)mesh->n_vertices * sizeof *seen);
    for (int32_t h = 0; h < 3 * mesh->n_triangles; h++) {
        int32_t v = halfedge_from(mesh, h);
        if (mesh->twin[h] >= 0 || seen[v])
            continue;
        loops++;
        for (int32_t g = h; !seen[v]; g = mesh_follow_boundary(mesh, g, &v))
            seen[v] = 1;
    }
    return loops;
}

static orb_status count_topology(orb_mesh *mesh, const workspace *work, orb_error *error) {
    orb_found components = {0};
    const orb_status status = find_components(mesh, &components, error);
    if (status != ORB_OK)
        return status;
    mesh->n_components = (int32_t)components.found;
    mesh->n_boundary_loops = count_boundary_loops(mesh, work->spare);
    mesh->euler = mesh->n_used_vertices - mesh->n_edges + mesh->n_triangles;
    int32_t missing = 2 * mesh->n_components - mesh->euler - mesh->n_boundary_loops;
    mesh->genus = mesh->orientable ? missing / 2 : missing;
    return ORB_OK;
}

/* --- the module's functions ----------------------------------------------------------------------------------- */

static orb_status copy_arrays(const orb_mesh_arrays *arrays, orb_mesh *mesh, orb_error *error) {
    const size_t n = (size_t)arrays->n_vertices, m3 = 3 * (size_t)arrays->n_triangles;
    mesh->n_vertices = arrays->n_vertices;
    mesh->n_triangles = arrays->n_triangles;
    mesh->vertices = malloc(3 * n * sizeof *mesh->vertices);
    mesh->triangles = malloc(m3 * sizeof *mesh->triangles);
    mesh->twin = malloc(m3 * sizeof *mesh->twin);
    mesh->edge = malloc(m3 * sizeof *mesh->edge);
    mesh->vertex_halfedge = malloc(n * sizeof *mesh->vertex_halfedge);
    if (!mesh->vertices || !mesh->triangles || !mesh->twin || !mesh->edge || !mesh->vertex_halfedge)
        return error_memory(error);
    memcpy(mesh->vertices, arrays->vertices, 3 * n * sizeof *mesh->vertices);
    memcpy(mesh->triangles, arrays->triangles, m3 * sizeof *mesh->triangles);
    return ORB_OK;
}

orb_status mesh_create(const orb_mesh_arrays *arrays, orb_mesh **mesh, orb_error *error) {
    workspace work = {0};
    orb_mesh *made = NULL;
    *mesh = NULL;
    orb_status status = mesh_check_arrays(arrays, error);
    if (status != ORB_OK)
        return status;

    made = calloc(1, sizeof *made);
    const size_t n = (size_t)arrays->n_vertices, m3 = 3 * (size_t)arrays->n_triangles;
    work.sorted = malloc(m3 * sizeof *work.sorted);
    work.end = malloc(n * sizeof *work.end);
    work.spare = malloc(n * sizeof *work.spare);
    if (!made || !work.sorted || !work.end || !work.spare) {
        status = error_memory(error);
        goto done;
    }
    if ((status = copy_arrays(arrays, made, error)) != ORB_OK)
        goto done;
    sort_halfedges(made, &work);
    if ((status = check_edges(made, &work, error)) != ORB_OK)
        goto done;
    if ((status = link_halfedges(made, &work, error)) != ORB_OK)
        goto done;
    if ((status = orientation_check(made, error)) != ORB_OK)
        goto done;
    if ((status = link_vertices(made, work.spare, error)) != ORB_OK)
        goto done;
    if ((status = count_topology(made, &work, error)) != ORB_OK)
        goto done;
    *mesh = made;
    made = NULL;
done:
    free(work.sorted);
    free(work.end);
    free(work.spare);
    mesh_free(made);
    return status;
}

static void *duplicate(const void *array, int64_t count, size_t size, bool *fine) {
    void *copy = malloc((size_t)count * size + 1);
    *fine = *fine && copy;
    return copy ? memcpy(copy, array, (size_t)count * size) : NULL;
}

orb_status mesh_copy(const orb_mesh *mesh, orb_mesh **result, orb_error *error) {
    const int64_t n = mesh->n_vertices, m3 = 3 * (int64_t)mesh->n_triangles;
    bool fine = true;
    orb_mesh *copy = duplicate(mesh, 1, sizeof *mesh, &fine);
    *result = copy;
    if (!copy)
        return error_memory(error);
    copy->vertices = duplicate(mesh->vertices, 3 * n, sizeof *copy->vertices, &fine);
    copy->triangles = duplicate(mesh->triangles, m3, sizeof *copy->triangles, &fine);
    copy->twin = duplicate(mesh->twin, m3, sizeof *copy->twin, &fine);
    copy->edge = duplicate(mesh->edge, m3, sizeof *copy->edge, &fine);
    copy->edge_halfedge = duplicate(mesh->edge_halfedge, mesh->n_edges, sizeof *copy->edge_halfedge, &fine);
    copy->vertex_halfedge = duplicate(mesh->vertex_halfedge, n, sizeof *copy->vertex_halfedge, &fine);
    copy->origin = mesh->origin ? duplicate(mesh->origin, mesh->n_triangles, sizeof *copy->origin, &fine) : NULL;
    if (fine)
        return ORB_OK;
    mesh_free(copy);
    *result = NULL;
    return error_memory(error);
}

void mesh_free(orb_mesh *mesh) {
    if (!mesh)
        return;
    free(mesh->vertices);
    free(mesh->triangles);
    free(mesh->twin);
    free(mesh->edge);
    free(mesh->edge_halfedge);
    free(mesh->vertex_halfedge);
    free(mesh->origin);
    free(mesh);
}

void mesh_blame(const orb_mesh *mesh, int32_t triangle, orb_blamed *blamed) {
    const int32_t origin = mesh->origin ? mesh->origin[triangle] : triangle;
    if (origin >= 0)
        found_add(&blamed->triangles, origin);
    else
        found_add(&blamed->filling, mesh->triangles[3 * (size_t)triangle]);
}

orb_status mesh_blame_error(orb_error *error, orb_status status, const orb_blamed *blamed, const char *one,
                            const char *many, const char *advice) {
    const orb_found *found = &blamed->triangles;
    if (found->found > 0)
        return error_set_elements(error, status, ORB_TRIANGLE, found->elements, found->entries, found->found,
                                  "%lld %s, first triangle %d: %s", (long long)found->found,
                                  found->found == 1 ? one : many, (int)found->elements[0], advice);
    found = &blamed->filling;
    return error_set_elements(
        error, status, ORB_VERTEX, found->elements, found->entries, found->found,
        "of the filling of a hole %lld %s, the first at vertex %d: fill the hole in the mesh, or %s",
        (long long)found->found, found->found == 1 ? one : many, (int)found->elements[0], advice);
}

orb_status mesh_require_connected(const orb_mesh *mesh, orb_error *error) {
    if (mesh->n_components == 1)
        return ORB_OK;
    orb_found lowest = {0};
    const orb_status status = find_components(mesh, &lowest, error);
    if (status != ORB_OK)
        return status;
    return error_set_elements(error, ORB_SEVERAL_COMPONENTS, ORB_VERTEX, lowest.elements, lowest.entries, lowest.found,
                              "the mesh has %d separate parts, for example those of vertices %d and %d: separate "
                              "them into objects (P) or delete the loose ones",
                              (int)mesh->n_components, (int)lowest.elements[0], (int)lowest.elements[1]);
}

/* Length of a vector; hypot only where the squares leave the range of doubles. */
static double length3(double x, double y, double z) {
    const double squares = x * x + y * y + z * z;
    return squares > 1e-280 && squares < 1e300 ? sqrt(squares) : hypot(hypot(x, y), z);
}

double mesh_edge_length(const orb_mesh *mesh, int32_t halfedge) {
    const double *p = mesh->vertices + 3 * (size_t)halfedge_from(mesh, halfedge);
    const double *q = mesh->vertices + 3 * (size_t)halfedge_to(mesh, halfedge);
    return length3(q[0] - p[0], q[1] - p[1], q[2] - p[2]);
}

double mesh_triangle_area(const orb_mesh *mesh, int32_t triangle) {
    const int32_t *corner = mesh->triangles + 3 * (size_t)triangle;
    const double *p = mesh->vertices + 3 * (size_t)corner[0];
    const double *q = mesh->vertices + 3 * (size_t)corner[1];
    const double *r = mesh->vertices + 3 * (size_t)corner[2];
    const double u[3] = {q[0] - p[0], q[1] - p[1], q[2] - p[2]}, v[3] = {r[0] - p[0], r[1] - p[1], r[2] - p[2]};
    return 0.5 * length3(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
}
