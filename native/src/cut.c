/* Shortest edge paths through the cones, and the disk that is left. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The paths are found one after the other; when one is blocked, the mesh is refined round the path so far and the
 * search goes on there (refine.h). Then the disk follows from turning round each vertex of the path. */
#include "cut.h"

#include <stdlib.h>
#include <string.h>

#include "refine.h"

/* Dijkstra's algorithm with a binary heap that knows where each vertex is. Nothing is reset between two searches
 * but the heap: what a search has not reached has another round in `reached`. */
typedef struct search {
    double *distance;  /* [n] from the start, in this round */
    int32_t *previous; /* [n] the vertex before it */
    int32_t *reached;  /* [n] the round that last reached it */
    int32_t *slot;     /* [n] where it is in the heap; -1 once it is settled */
    int32_t *heap;     /* [n] vertices */
    int32_t n_heap, round;
} search;

typedef struct cutter {
    const orb_mesh *mesh;  /* the input mesh or `refined` */
    orb_mesh *refined;
    int32_t *refined_from; /* as in orb_disk */
    int32_t n_cones;
    const int32_t *cones;  /* [n_cones] */
    int32_t *corner;       /* [n_cones] the cones' places on the path */
    int32_t n_path;
    int32_t *path;         /* [n] vertices, of which n_path are used */
    int32_t *place;        /* [n] as in refine.h */
    search search;
} cutter;

static void search_clear(search *s)
{
    free(s->distance);
    free(s->previous);
    free(s->reached);
    free(s->slot);
    free(s->heap);
    *s = (search){0};
}

static bool search_allocate(search *s, int32_t n_vertices)
{
    size_t n = (size_t)n_vertices;
    search_clear(s);
    s->distance = malloc(n * sizeof *s->distance);
    s->previous = malloc(n * sizeof *s->previous);
    s->reached = calloc(n, sizeof *s->reached);
    s->slot = malloc(n * sizeof *s->slot);
    s->heap = malloc(n * sizeof *s->heap);
    return s->distance && s->previous && s->reached && s->slot && s->heap;
}

/* Nearer first; equally near: the smaller number, so that the cut does not depend on the heap's history. */
static bool search_before(const search *s, int32_t u, int32_t v)
{
    return s->distance[u] < s->distance[v] || (s->distance[u] == s->distance[v] && u < v);
}

static void heap_put(search *s, int32_t slot, int32_t vertex)
{
    s->heap[slot] = vertex;
    s->slot[vertex] = slot;
}

static void heap_raise(search *s, int32_t slot)
{
    int32_t vertex = s->heap[slot];
    while (slot > 0 && search_before(s, vertex, s->heap[(slot - 1) / 2])) {
        heap_put(s, slot, s->heap[(slot - 1) / 2]);
        slot = (slot - 1) / 2;
    }
    heap_put(s, slot, vertex);
}

static int32_t heap_take(search *s)
{
    int32_t first = s->heap[0], vertex = s->heap[--s->n_heap], slot = 0;
    int64_t child;
    while ((child = 2 * (int64_t)slot + 1) < s->n_heap) {
        if (child + 1 < s->n_heap && search_before(s, s->heap[child + 1], s->heap[child]))
            child++;
        if (!search_before(s, s->heap[child], vertex))
            break;
        heap_put(s, slot, s->heap[child]);
        slot = (int32_t)child;
    }
    if (s->n_heap > 0)
        heap_put(s, slot, vertex);
    s->slot[first] = -1;
    return first;
}

static void search_reach(search *s, int32_t vertex, int32_t previous, double distance)
{
    if (s->reached[vertex] != s->round) {
        s->reached[vertex] = s->round;
        s->distance[vertex] = distance;
        s->previous[vertex] = previous;
        heap_put(s, s->n_heap, vertex);
        heap_raise(s, s->n_heap++);
    } else if (s->slot[vertex] >= 0 && distance < s->distance[vertex]) {
        s->distance[vertex] = distance;
        s->previous[vertex] = previous;
        heap_raise(s, s->slot[vertex]);
    }
}

/* The shortest path between two vertices through free ones, into s->previous; false if there is none. */
static bool search_run(search *s, const orb_mesh *mesh, const int32_t *place, int32_t from, int32_t to)
{
    s->round++;
    s->n_heap = 0;
    search_reach(s, from, -1, 0.0);
    while (s->n_heap > 0) {
        int32_t vertex = heap_take(s);
        if (vertex == to)
            return true;
        int32_t h = mesh->vertex_halfedge[vertex];
        do {
            int32_t next = halfedge_to(mesh, h);
            if (place[next] == REFINE_FREE || next == to)
                search_reach(s, next, vertex, s->distance[vertex] + mesh_edge_length(mesh, h));
            h = mesh->twin[halfedge_previous(h)];
        } while (h != mesh->vertex_halfedge[vertex]);
    }
    return false;
}

/* Appends the path that was found to the path so far, which ends in its first vertex. */
static void path_append(cutter *c, int32_t from, int32_t to)
{
    int32_t n_new = 0;
    for (int32_t v = to; v != from; v = c->search.previous[v])
        n_new++;
    int32_t place = c->n_path + n_new;
    for (int32_t v = to; v != from; v = c->search.previous[v]) {
        c->path[--place] = v;
        c->place[v] = place;
    }
    c->n_path += n_new;
}

/* Where the triangle inequality holds strictly, no edge joins two vertices of a segment that do not follow one
 * another: it would be shorter. Where it does not (triangles without area), such an edge, or a triangle with two
 * edges on the segment, would be flat once the segment is a side of a convex tile; so these are taken out by going
 * from each vertex at once to the last one of the segment that is next to it. */
static void path_shorten(cutter *c, int32_t first)
{
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

/* Room for the vertices of c->mesh, of which the first `before` are there already. */
static bool cutter_allocate(cutter *c, int32_t before)
{
    size_t n = (size_t)c->mesh->n_vertices;
    int32_t *path = realloc(c->path, n * sizeof *path);
    if (path)
        c->path = path;
    int32_t *place = realloc(c->place, n * sizeof *place);
    if (place)
        c->place = place;
    if (!path || !place)
        return false;
    for (int32_t v = before; v < c->mesh->n_vertices; v++)
        c->place[v] = REFINE_FREE;
    return search_allocate(&c->search, c->mesh->n_vertices);
}

static orb_status cutter_refine(cutter *c, orb_error *error)
{
    orb_mesh *refined;
    int32_t *from;
    orb_status status = refine_around(c->mesh, c->place, &refined, &from, error);
    if (status != ORB_OK)
        return status;
    if (c->refined_from)
        for (int32_t t = 0; t < refined->n_triangles; t++)
            from[t] = c->refined_from[from[t]];
    int32_t before = c->mesh->n_vertices;
    free(c->refined_from);
    mesh_free(c->refined);
    c->refined_from = from;
    c->refined = refined;
    c->mesh = refined;
    return cutter_allocate(c, before) ? ORB_OK : error_memory(error);
}

static orb_status find_segment(cutter *c, int32_t from, int32_t to, orb_error *error)
{
    bool found = search_run(&c->search, c->mesh, c->place, from, to);
    if (!found) {
        orb_status status = cutter_refine(c, error);
        if (status != ORB_OK)
            return status;
        found = search_run(&c->search, c->mesh, c->place, from, to);
    }
    if (!found) {
        const int32_t ends[2] = {from, to};
        return error_set_elements(error, ORB_CUT_BLOCKED, ORB_VERTEX, ends, 2, 2,
                                  "no path along edges joins the cones at vertices %d and %d without meeting the cut "
                                  "or another cone: pick other vertices or give the cones in another sequence",
                                  (int)from, (int)to);
    }
    int32_t first = c->n_path - 1;
    path_append(c, from, to);
    path_shorten(c, first);
    return ORB_OK;
}

static orb_status find_path(cutter *c, orb_error *error)
{
    c->corner = malloc((size_t)c->n_cones * sizeof *c->corner);
    if (!c->corner || !cutter_allocate(c, 0))
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
static void disk_open(orb_disk *disk, const cutter *c, int32_t i, int32_t copy)
{
    const orb_mesh *mesh = c->mesh;
    int32_t h = mesh->vertex_halfedge[c->path[i]];
    while (halfedge_to(mesh, h) != c->path[i - 1])
        h = mesh->twin[halfedge_previous(h)];
    while (halfedge_to(mesh, h) != c->path[i + 1]) {
        disk->triangles[h] = copy;
        h = mesh->twin[halfedge_previous(h)];
    }
}

static bool disk_allocate(orb_disk *disk, const cutter *c)
{
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
static void disk_fill(orb_disk *disk, const cutter *c)
{
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

static orb_status disk_create(cutter *c, orb_disk **disk, orb_error *error)
{
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

static orb_status bad_cones(const orb_found *found, orb_error *error, const char *what)
{
    return error_set_elements(error, ORB_BAD_CONE, ORB_VERTEX, found->elements, found->entries, found->found,
                              "the cone at vertex %d %s", (int)found->elements[0], what);
}

static orb_status check_cones(const orb_mesh *mesh, int32_t n_cones, const int32_t *cones, orb_error *error)
{
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

orb_status cut_create(const orb_mesh *mesh, int32_t n_cones, const int32_t *cones, orb_disk **disk, orb_error *error)
{
    *disk = NULL;
    orb_status status = check_cones(mesh, n_cones, cones, error);
    if (status != ORB_OK)
        return status;
    cutter c = {.mesh = mesh, .n_cones = n_cones, .cones = cones};
    status = find_path(&c, error);
    if (status == ORB_OK)
        status = disk_create(&c, disk, error);
    mesh_free(c.refined);
    free(c.refined_from);
    free(c.corner);
    free(c.path);
    free(c.place);
    search_clear(&c.search);
    return status;
}

void cut_free(orb_disk *disk)
{
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
