/* Shortest edge paths through the cones, and the disk that is left. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The paths are found one after the other; when one is blocked, the mesh is refined where the path has to squeeze
 * through (refine.h). Then the disk follows from turning round each vertex of the path. */
#include "cut.h"

#include <stdlib.h>
#include <string.h>

#include "refine.h"
#include "shortest.h"

/* Cones in an erratic sequence make a cut whose length grows exponentially with their number, as each segment follows
 * the windings of the ones before. So a mesh may grow to twice its size, or by this many vertices if that is more;
 * a few cones on a coarse mesh need a few dozen. */
static const int32_t least_room = 50000;

typedef struct cutter {
    const orb_mesh *mesh; /* the input mesh or `refined` */
    orb_mesh *refined;
    int32_t *refined_from; /* as in orb_disk */
    int32_t most_vertices; /* that a refined mesh may have */
    int32_t n_cones;
    const int32_t *cones; /* [n_cones] */
    int32_t *corner;      /* [n_cones] the cones' places on the path */
    int32_t n_path;
    int32_t *path;  /* [n] vertices, of which n_path are used; n: of the largest mesh so far, at least */
    int32_t *place; /* [n] as in refine.h */
    shortest_search search;
} cutter;

/* Appends the path that was found to the path so far, which ends in its first vertex. */
static void path_append(cutter *c, int32_t from, int32_t to) {
    int32_t n_new = 0;
    for (int32_t v = to; v != from; v = c->search.nodes[v].previous)
        n_new++;
    int32_t place = c->n_path + n_new;
    for (int32_t v = to; v != from; v = c->search.nodes[v].previous) {
        c->path[--place] = v;
        c->place[v] = place;
    }
    c->n_path += n_new;
}

/* Where the triangle inequality holds strictly, no edge joins two vertices of a segment that do not follow one
 * another: it would be shorter. Where it does not (triangles without area), such an edge, or a triangle with two
 * edges on the segment, would be flat once the segment is a side of a convex tile; so these are taken out by going
 * from each vertex at once to the last one of the segment that is next to it. */
static void path_shorten(cutter *c, int32_t first) {
    const orb_mesh *mesh = c->mesh;
    int32_t end = c->n_path, kept = first;
    for (int32_t at = first; at + 1 < end; kept++) {
        int32_t furthest = at, start = mesh->vertex_halfedge[c->path[at]], h = start;
        do {
            int32_t place = c->place[halfedge_to(mesh, h)];
            if (place > furthest)
                furthest = place;
            h = mesh->twin[halfedge_previous(h)];
        } while (h != start);
        for (int32_t i = at + 1; i < furthest; i++)
            c->place[c->path[i]] = REFINE_FREE;
        at = furthest;
        c->path[kept + 1] = c->path[at];
    }
    c->n_path = kept + 1;
    for (int32_t i = first; i < c->n_path; i++)
        c->place[c->path[i]] = i;
}

/* Room for meshes of so many vertices; those from `before` on are new. */
static bool cutter_allocate(cutter *c, int32_t before, int32_t n_vertices) {
    int32_t *path = realloc(c->path, (size_t)n_vertices * sizeof *path);
    if (path)
        c->path = path;
    int32_t *place = realloc(c->place, (size_t)n_vertices * sizeof *place);
    if (place)
        c->place = place;
    if (!path || !place)
        return false;
    for (int32_t v = before; v < n_vertices; v++)
        c->place[v] = REFINE_FREE;
    return shortest_allocate(&c->search, n_vertices);
}

/* Finds the segment and appends it; false if there is none. */
static bool find_direct(cutter *c, int32_t from, int32_t to) {
    if (!shortest_find(&c->search, c->mesh, c->place, REFINE_FREE, from, to))
        return false;
    int32_t first = c->n_path - 1;
    path_append(c, from, to);
    path_shorten(c, first);
    return true;
}

/* The segment was found with all marked edges halved, and midpoints are numbered in the sequence of the edges: keeps
 * the marks of those that it visits, and gives these the numbers that they have without the others. Returns the
 * number of vertices with these. */
static int32_t keep_visited(cutter *c, uint8_t *marked) {
    int32_t midpoint = c->mesh->n_vertices, kept = midpoint;
    for (int32_t e = 0; e < c->mesh->n_edges; e++) {
        if (!marked[e])
            continue;
        int32_t place = c->place[midpoint];
        c->place[midpoint++] = REFINE_FREE;
        marked[e] = place >= 0;
        if (place < 0)
            continue;
        c->path[place] = kept;
        c->place[kept++] = place;
    }
    return kept;
}

/* The mesh with the marked edges halved takes the place of the one that is cut. */
static orb_status cutter_refine(cutter *c, const uint8_t *marked, orb_error *error) {
    orb_mesh *refined;
    int32_t *parent;
    orb_status status = refine_edges(c->mesh, marked, &refined, &parent, error);
    if (status != ORB_OK)
        return status;
    if (c->refined_from)
        for (int32_t t = 0; t < refined->n_triangles; t++)
            parent[t] = c->refined_from[parent[t]];
    free(c->refined_from);
    mesh_free(c->refined);
    c->refined_from = parent;
    c->refined = refined;
    c->mesh = refined;
    return ORB_OK;
}

static orb_status blocked(int32_t from, int32_t to, orb_error *error, const char *why) {
    const int32_t ends[2] = {from, to};
    return error_set_elements(error, ORB_CUT_BLOCKED, ORB_VERTEX, ends, 2, 2,
                              "the cut from the cone at vertex %d to the one at vertex %d %s", (int)from, (int)to, why);
}

/* The same where the segment is blocked: it is searched for with every edge halved that is in its way, and then the
 * mesh is refined where it passes (refine.c proves that both work). */
static orb_status find_refined(cutter *c, int32_t from, int32_t to, bool *found, orb_error *error) {
    const orb_mesh *mesh = c->mesh;
    orb_mesh *wide = NULL;
    int32_t *parent = NULL, first = c->n_path - 1;
    orb_status status = ORB_OK;
    uint8_t *marked = malloc((size_t)mesh->n_edges);
    if (!marked)
        return error_memory(error);
    refine_mark(mesh, c->place, marked);
    if ((status = refine_edges(mesh, marked, &wide, &parent, error)) != ORB_OK)
        goto done;
    if (!cutter_allocate(c, mesh->n_vertices, wide->n_vertices)) {
        status = error_memory(error);
        goto done;
    }
    c->mesh = wide;
    *found = find_direct(c, from, to);
    c->mesh = mesh;
    if (!*found)
        goto done;
    if (keep_visited(c, marked) <= c->most_vertices) {
        status = cutter_refine(c, marked, error);
        if (status == ORB_OK)
            path_shorten(c, first); /* with fewer midpoints there are edges that were not there with all of them */
    } else {
        status = blocked(from, to, error,
                         "winds round earlier cones so often that the mesh would have to be refined beyond measure: "
                         "give the cones in a sequence in which each is near the one before");
    }
done:
    free(marked);
    free(parent);
    mesh_free(wide);
    return status;
}

static orb_status find_segment(cutter *c, int32_t from, int32_t to, orb_error *error) {
    bool found = find_direct(c, from, to);
    if (!found) {
        orb_status status = find_refined(c, from, to, &found, error);
        if (status != ORB_OK)
            return status;
    }
    return found ? ORB_OK
                 : blocked(from, to, error,
                           "would meet the cut or another cone whatever way it goes along edges: pick other "
                           "vertices "
                           "or give the cones in another sequence");
}

static orb_status find_path(cutter *c, orb_error *error) {
    c->corner = malloc((size_t)c->n_cones * sizeof *c->corner);
    if (!c->corner || !cutter_allocate(c, 0, c->mesh->n_vertices))
        return error_memory(error);
    for (int32_t s = 0; s < c->n_cones; s++)
        c->place[c->cones[s]] = REFINE_CONE;
    c->path[0] = c->cones[0];
    c->place[c->cones[0]] = 0;
    c->corner[0] = 0;
    c->n_path = 1;
    for (int32_t s = 1; s < c->n_cones; s++) {
        orb_status status = find_segment(c, c->cones[s - 1], c->cones[s], error);
        if (status != ORB_OK)
            return status;
        c->corner[s] = c->n_path - 1;
    }
    return ORB_OK;
}

/* Gives the right bank's copy of path vertex i to the triangles on the right: counter-clockwise round the vertex,
 * those from the edge back along the path up to the edge onwards. (Half-edge h is also the corner that it leaves.) */
static void disk_open(orb_disk *disk, const cutter *c, int32_t i, int32_t copy) {
    const orb_mesh *mesh = c->mesh;
    int32_t h = mesh->vertex_halfedge[c->path[i]];
    while (halfedge_to(mesh, h) != c->path[i - 1])
        h = mesh->twin[halfedge_previous(h)];
    while (halfedge_to(mesh, h) != c->path[i + 1]) {
        disk->triangles[h] = copy;
        h = mesh->twin[halfedge_previous(h)];
    }
}

static bool disk_allocate(orb_disk *disk, const cutter *c) {
    disk->n_copies = c->mesh->n_vertices + c->n_path - 2;
    disk->n_boundary = 2 * c->n_path - 2;
    disk->copy_vertex = malloc((size_t)disk->n_copies * sizeof *disk->copy_vertex);
    disk->copy_pairing = calloc((size_t)disk->n_copies, sizeof *disk->copy_pairing);
    disk->triangles = malloc((size_t)c->mesh->n_triangles * 3 * sizeof *disk->triangles);
    disk->boundary = malloc((size_t)disk->n_boundary * sizeof *disk->boundary);
    disk->corner_at = malloc((2 * (size_t)c->n_cones - 2) * sizeof *disk->corner_at);
    return disk->copy_vertex && disk->copy_pairing && disk->triangles && disk->boundary && disk->corner_at;
}

/* All arrays of the disk, from the path. */
static void disk_fill(orb_disk *disk, const cutter *c) {
    const orb_mesh *mesh = c->mesh;
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        disk->copy_vertex[v] = v;
    memcpy(disk->triangles, mesh->triangles, (size_t)mesh->n_triangles * 3 * sizeof *disk->triangles);
    memcpy(disk->boundary, c->path, (size_t)c->n_path * sizeof *disk->boundary);
    int32_t segment = 1; /* the one that starts in or before path vertex i */
    for (int32_t i = 1; i < c->n_path - 1; i++) {
        int32_t copy = mesh->n_vertices + i - 1;
        if (i == c->corner[segment])
            segment++;
        disk->copy_vertex[copy] = c->path[i];
        disk->copy_pairing[copy] = segment;
        disk->boundary[disk->n_boundary - i] = copy;
        disk_open(disk, c, i, copy);
    }
    for (int32_t s = 0; s < c->n_cones; s++)
        disk->corner_at[s] = c->corner[s];
    for (int32_t s = 1; s < c->n_cones - 1; s++)
        disk->corner_at[2 * c->n_cones - 2 - s] = disk->n_boundary - c->corner[s];
}

static orb_status disk_create(cutter *c, orb_disk **disk, orb_error *error) {
    orb_disk *made = calloc(1, sizeof *made);
    if (!made || !disk_allocate(made, c)) {
        cut_free(made);
        return error_memory(error);
    }
    made->mesh = c->mesh;
    made->refined = c->refined;
    made->refined_from = c->refined_from;
    c->refined = NULL;
    c->refined_from = NULL;
    disk_fill(made, c);
    *disk = made;
    return ORB_OK;
}

static orb_status bad_cones(const orb_found *found, orb_error *error, const char *what) {
    return error_set_elements(error, ORB_BAD_CONE, ORB_VERTEX, found->elements, found->entries, found->found,
                              "the cone at vertex %d %s", (int)found->elements[0], what);
}

static orb_status check_cones(const orb_mesh *mesh, int32_t n_cones, const int32_t *cones, orb_error *error) {
    orb_found outside = {0}, isolated = {0}, repeated = {0};
    orb_status status = mesh_require_sphere(mesh, error);
    if (status != ORB_OK)
        return status;
    if (n_cones < 2)
        return error_set(error, ORB_BAD_CONE, "a cut joins two cones at least, here are %d: add a cone", (int)n_cones);
    uint8_t *times = calloc((size_t)mesh->n_vertices, sizeof *times); /* 2 stands for more, too */
    if (!times)
        return error_memory(error);
    for (int32_t s = 0; s < n_cones; s++) {
        int32_t v = cones[s];
        if (v < 0 || v >= mesh->n_vertices)
            found_add(&outside, v);
        else if (mesh->vertex_halfedge[v] < 0)
            found_add(&isolated, v);
        else if (times[v] < 2 && ++times[v] == 2)
            found_add(&repeated, v);
    }
    free(times);
    if (outside.found > 0)
        return bad_cones(&outside, error, "does not exist: pick a vertex of this mesh");
    if (isolated.found > 0)
        return bad_cones(&isolated, error, "belongs to no triangle: pick a vertex of the surface");
    if (repeated.found > 0)
        return bad_cones(&repeated, error, "is given more than once: pick another vertex for each further cone");
    return ORB_OK;
}

orb_status cut_create(const orb_mesh *mesh, int32_t n_cones, const int32_t *cones, orb_disk **disk, orb_error *error) {
    *disk = NULL;
    orb_status status = check_cones(mesh, n_cones, cones, error);
    if (status != ORB_OK)
        return status;
    cutter c = {.mesh = mesh, .n_cones = n_cones, .cones = cones};
    c.most_vertices = mesh->n_vertices + (mesh->n_vertices > least_room ? mesh->n_vertices : least_room);
    status = find_path(&c, error);
    if (status == ORB_OK)
        status = disk_create(&c, disk, error);
    mesh_free(c.refined);
    free(c.refined_from);
    free(c.corner);
    free(c.path);
    free(c.place);
    shortest_clear(&c.search);
    return status;
}

void cut_free(orb_disk *disk) {
    if (!disk)
        return;
    mesh_free(disk->refined);
    free(disk->refined_from);
    free(disk->copy_vertex);
    free(disk->copy_pairing);
    free(disk->triangles);
    free(disk->boundary);
    free(disk->corner_at);
    free(disk);
}
