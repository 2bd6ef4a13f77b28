/* Shortest edge paths through the cones, and the disk that is left. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The paths are found one after the other; when one is blocked, the mesh is refined where the path has to squeeze
 * through (refine.h). Then the disk follows from turning round each vertex of the path. */
#include "cut.h"

#include <stdlib.h>
#include <string.h>

#include "cut_chain.h"
#include "cut_graph.h"
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

/* The edges of the path; *start: the half-edge that sets out along its left bank. */
static void mark_path(const cutter *c, uint8_t *cut, int32_t *start) {
    const orb_mesh *mesh = c->mesh;
    for (int32_t i = 0; i + 1 < c->n_path; i++) {
        int32_t h = mesh->vertex_halfedge[c->path[i]];
        while (halfedge_to(mesh, h) != c->path[i + 1])
            h = mesh->twin[halfedge_previous(h)];
        cut[mesh->edge[h]] = 1;
        if (i == 0)
            *start = h;
    }
}

static orb_status open_path(cutter *c, const orb_marks *cones, orb_disk **disk, orb_error *error) {
    int32_t start = -1;
    uint8_t *cut = calloc((size_t)c->mesh->n_edges + 1, sizeof *cut);
    if (!cut)
        return error_memory(error);
    mark_path(c, cut, &start);
    orb_status status = disk_create(c->mesh, cut, start, cones, disk, error);
    free(cut);
    if (status != ORB_OK)
        return status;
    (*disk)->refined = c->refined;
    (*disk)->refined_from = c->refined_from;
    c->refined = NULL;
    c->refined_from = NULL;
    return ORB_OK;
}

orb_status cut_path(const orb_mesh *mesh, const orb_marks *cones, orb_disk **disk, orb_error *error) {
    *disk = NULL;
    cutter c = {.mesh = mesh, .n_cones = cones->n, .cones = cones->vertex};
    c.most_vertices = mesh->n_vertices + (mesh->n_vertices > least_room ? mesh->n_vertices : least_room);
    orb_status status = find_path(&c, error);
    if (status == ORB_OK)
        status = open_path(&c, cones, disk, error);
    mesh_free(c.refined);
    free(c.refined_from);
    free(c.corner);
    free(c.path);
    free(c.place);
    shortest_clear(&c.search);
    return status;
}

orb_status cut_surface(orb_mesh *mesh, const int32_t *parent, const orb_marks *marks, int32_t first, orb_disk **disk,
                       orb_error *error) {
    *disk = NULL;
    uint8_t *cut = malloc((size_t)mesh->n_edges + 1);
    if (!cut)
        return error_memory(error);
    orb_status status = cut_graph_find(mesh, parent, marks->n, marks->vertex, cut, error);
    if (status == ORB_OK)
        status = mesh_orient(mesh, cut, error);
    if (status == ORB_OK)
        status =
            disk_create(mesh, cut, first < 0 ? -1 : mesh->vertex_halfedge[marks->vertex[first]], marks, disk, error);
    free(cut);
    return status;
}

/* A surface with borders along a path through cones and mirrors in turn. */
static orb_status cut_borders(const orb_mesh *mesh, const int32_t *parent, const orb_marks *marks, orb_disk **disk,
                              orb_error *error) {
    int32_t start = -1;
    uint8_t *cut = malloc((size_t)mesh->n_edges + 1);
    orb_status status = cut ? cut_chain_find(mesh, parent, marks, cut, &start, error) : error_memory(error);
    if (status == ORB_OK)
        status = disk_create(mesh, cut, start, marks, disk, error);
    free(cut);
    return status;
}

/* Half of the disk's circumference. */
static double cut_length(const orb_disk *disk) {
    double length = 0;
    for (int32_t h = 0; h < 3 * disk->mesh->n_triangles; h++)
        length += disk->side[h] >= 0 ? mesh_edge_length(disk->mesh, h) / 2 : 0;
    return length;
}

/* A path through many cones, or one that is blocked or erratic, much longer than a graph, gives way to that. */
static orb_status path_or_graph(orb_mesh *mesh, const orb_marks *marks, orb_disk **disk, orb_error *error) {
    static const double erratic = 1.5;
    enum { MOST_ON_PATH = 12 };
    orb_disk *path = NULL;
    orb_status status = marks->n > MOST_ON_PATH ? ORB_CUT_BLOCKED : cut_path(mesh, marks, &path, error);
    if (status != ORB_OK && status != ORB_CUT_BLOCKED)
        return status;
    status = cut_surface(mesh, NULL, marks, -1, disk, error);
    if (path && (status != ORB_OK || !(cut_length(path) > erratic * cut_length(*disk)))) {
        disk_free(*disk);
        *disk = path;
        return ORB_OK;
    }
    disk_free(path);
    return status;
}

orb_status cut_open(orb_mesh *mesh, const orb_signature *signature, orb_cut cut, const int32_t *parent,
                    const orb_marks *marks, orb_disk **disk, orb_error *error) {
    *disk = NULL;
    bool planar = signature && !signature->n_crosscaps && !signature->n_handles;
    bool sphere = planar && signature->n_mirrors == 0;
    if (planar && cut == ORB_CUT_PATH && signature->n_mirrors > (signature->n_cones == 0))
        return cut_borders(mesh, parent, marks, disk, error);
    if (!sphere)
        return cut_surface(mesh, parent, marks, signature ? -1 : 0, disk, error);
    if (signature->curvature < 0 && marks->n > 3 && cut == ORB_CUT_AUTOMATIC)
        return path_or_graph(mesh, marks, disk, error);
    return cut_path(mesh, marks, disk, error);
}
