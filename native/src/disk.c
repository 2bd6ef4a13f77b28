/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Corners of triangles are one copy where they meet across an edge that is not cut (union-find). The disk's boundary
 * is then followed from half-edge to half-edge: each copy on it is left by exactly one. */
#include "disk.h"

#include <stdlib.h>
#include <string.h>

/* What is needed only while a disk is made. */
typedef struct maker {
    orb_disk *disk;
    const orb_mesh *mesh;
    const uint8_t *cut;
    int32_t *set;      /* [3 triangles] union-find over corners (half-edge h is also the corner that it leaves) */
    int32_t *leaving;  /* [3 triangles] at a copy's root: the boundary half-edge that leaves it; -1 inside */
    int32_t *loop;     /* [n_boundary] half-edges of the boundary */
    int32_t *position; /* [3 triangles] where a half-edge is in `loop` */
    int32_t *valence;  /* [n_vertices] how often the boundary visits it */
    int32_t *order;    /* [n_vertices] of a marked vertex; 0 */
    int32_t *node;     /* [n_vertices] number of a vertex that is a corner's; -1 */
    int32_t *copy;     /* [3 triangles] at a copy's root: its number */
} maker;

static int32_t find(int32_t *set, int32_t corner) {
    while (set[corner] != corner)
        corner = set[corner] = set[set[corner]];
    return corner;
}

static bool maker_allocate(maker *m) {
    size_t corners = 3 * (size_t)m->mesh->n_triangles + 1, n = (size_t)m->mesh->n_vertices + 1;
    m->set = malloc(corners * sizeof(int32_t));
    m->leaving = malloc(corners * sizeof(int32_t));
    m->loop = malloc(corners * sizeof(int32_t));
    m->position = malloc(corners * sizeof(int32_t));
    m->copy = malloc(corners * sizeof(int32_t));
    m->valence = calloc(n, sizeof(int32_t));
    m->order = calloc(n, sizeof(int32_t));
    m->node = malloc(n * sizeof(int32_t));
    return m->set && m->leaving && m->loop && m->position && m->copy && m->valence && m->order && m->node;
}

static void maker_free(maker *m) {
    free(m->set);
    free(m->leaving);
    free(m->loop);
    free(m->position);
    free(m->copy);
    free(m->valence);
    free(m->order);
    free(m->node);
}

static void join_corners(maker *m) {
    const orb_mesh *mesh = m->mesh;
    int32_t n = 3 * mesh->n_triangles;
    for (int32_t h = 0; h < n; h++)
        m->set[h] = h;
    for (int32_t h = 0; h < n; h++) {
        int32_t g = mesh->twin[h];
        if (g < h || m->cut[mesh->edge[h]])
            continue;
        m->set[find(m->set, h)] = find(m->set, halfedge_next(g));
        m->set[find(m->set, halfedge_next(h))] = find(m->set, g);
    }
    for (int32_t h = 0; h < n; h++) {
        m->set[h] = find(m->set, h);
        m->leaving[h] = m->copy[h] = m->position[h] = -1;
    }
    for (int32_t h = 0; h < n; h++)
        if (m->cut[mesh->edge[h]])
            m->leaving[m->set[h]] = h;
}

/* Follows the boundary from `start`; false if it does not come round over all of it. */
static bool follow_boundary(maker *m, int32_t start) {
    int32_t total = 0, n = 0, h = start;
    for (int32_t g = 0; g < 3 * m->mesh->n_triangles; g++) {
        total += m->cut[m->mesh->edge[g]];
        if (h < 0 && m->cut[m->mesh->edge[g]])
            h = start = g;
    }
    if (total == 0)
        return false;
    do {
        m->position[h] = n;
        m->loop[n++] = h;
        m->valence[halfedge_from(m->mesh, h)]++;
        h = m->leaving[m->set[halfedge_next(h)]];
    } while (h >= 0 && n < total && h != start);
    m->disk->n_boundary = n;
    return n == total && h == start;
}

/* A corner of the tile: marked, or where the graph branches, ends or meets the boundary. */
static bool is_node(const maker *m, int32_t v, bool on_boundary) {
    return m->order[v] > 0 || m->valence[v] != (on_boundary ? 1 : 2);
}

/* Turns the loop so that it starts in a corner; the number of corners. */
static int32_t find_corners(maker *m, bool keep_start, const bool *on_boundary) {
    const orb_mesh *mesh = m->mesh;
    int32_t n = m->disk->n_boundary, first = -1, sides = 0;
    for (int32_t i = 0; i < n; i++) {
        int32_t v = halfedge_from(mesh, m->loop[i]);
        if (!is_node(m, v, on_boundary[v]))
            continue;
        sides++;
        if (first < 0)
            first = i;
    }
    if (sides == 0 || (keep_start && first != 0))
        return 0;
    int32_t *turned = m->copy; /* room that is not in use yet */
    for (int32_t i = 0; i < n; i++)
        turned[i] = m->loop[(i + first) % n];
    memcpy(m->loop, turned, (size_t)n * sizeof *turned);
    for (int32_t i = 0; i < n; i++) {
        m->position[m->loop[i]] = i;
        turned[i] = -1;
    }
    return sides;
}

/* Nodes, sides and how they are glued. */
static orb_status write_word(maker *m, int32_t n_sides, const bool *on_boundary, orb_error *error) {
    orb_disk *disk = m->disk;
    const orb_mesh *mesh = m->mesh;
    orb_status status = word_create(n_sides, n_sides, &disk->word, error);
    disk->corner_at = malloc(((size_t)n_sides + 1) * sizeof *disk->corner_at);
    if (status != ORB_OK || !disk->corner_at)
        return error_memory(error);
    orb_word *word = disk->word;
    int32_t side = -1, nodes = 0;
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        m->node[v] = -1;
    for (int32_t i = 0; i < disk->n_boundary; i++) {
        int32_t v = halfedge_from(mesh, m->loop[i]);
        if (is_node(m, v, on_boundary[v])) {
            if (m->node[v] < 0) {
                word->order[nodes] = m->order[v] > 0 ? m->order[v] : 1;
                m->node[v] = nodes++;
            }
            word->node[++side] = m->node[v];
            disk->corner_at[side] = i;
        }
        disk->side[m->loop[i]] = side;
    }
    word->n_nodes = nodes;
    for (int32_t s = 0; s < n_sides; s++) {
        int32_t h = m->loop[disk->corner_at[s]], g = mesh->twin[h];
        word->partner[s] = g < 0 ? s : disk->side[g];
        word->same_way[s] = g < 0 || halfedge_from(mesh, h) == halfedge_from(mesh, g);
    }
    word_finish(word);
    return ORB_OK;
}

/* Where copy i of the boundary lies, i on side s, or at its start. */
static orb_copy_place place_of(const maker *m, int32_t i, int32_t s) {
    const orb_word *word = m->disk->word;
    if (m->disk->corner_at[s] == i) {
        bool itself = word->first[word->node[s]] == s;
        return (orb_copy_place){itself ? PLACE_SELF : PLACE_CORNER, s};
    }
    bool itself = word->partner[s] >= s;
    return (orb_copy_place){itself ? PLACE_SELF : PLACE_SIDE, word->partner[s]};
}

/* Numbers the copies: that which lies at the identity takes its vertex's number, the others follow from the boundary's
 * end to its start. */
static orb_status number_copies(maker *m, orb_error *error) {
    orb_disk *disk = m->disk;
    const orb_mesh *mesh = m->mesh;
    size_t most = (size_t)mesh->n_vertices + (size_t)disk->n_boundary, n_boundary = (size_t)disk->n_boundary;
    disk->copy_vertex = malloc((most + 1) * sizeof *disk->copy_vertex);
    disk->place = calloc(most + 1, sizeof *disk->place);
    disk->boundary = malloc((n_boundary + 1) * sizeof *disk->boundary);
    if (!disk->copy_vertex || !disk->place || !disk->boundary)
        return error_memory(error);
    disk->n_copies = mesh->n_vertices;
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        disk->copy_vertex[v] = v;
    for (int32_t i = disk->n_boundary - 1; i >= 0; i--) {
        int32_t h = m->loop[i], v = halfedge_from(mesh, h);
        orb_copy_place place = place_of(m, i, disk->side[h]);
        int32_t number = place.kind == PLACE_SELF ? v : disk->n_copies++;
        disk->copy_vertex[number] = v;
        disk->place[number] = place;
        m->copy[m->set[h]] = disk->boundary[i] = number;
    }
    for (int32_t h = 0; h < 3 * mesh->n_triangles; h++) {
        int32_t copy = m->copy[m->set[h]];
        disk->triangles[h] = copy < 0 ? halfedge_from(mesh, h) : copy;
    }
    return ORB_OK;
}

static orb_status fill(maker *m, int32_t start, const orb_marks *marks, orb_error *error) {
    orb_disk *disk = m->disk;
    const orb_mesh *mesh = m->mesh;
    size_t corners = 3 * (size_t)mesh->n_triangles;
    disk->mesh = mesh;
    disk->triangles = malloc((corners + 1) * sizeof *disk->triangles);
    disk->side = malloc((corners + 1) * sizeof *disk->side);
    bool *on_boundary = calloc((size_t)mesh->n_vertices + 1, sizeof *on_boundary);
    orb_status status = ORB_OK;
    if (!maker_allocate(m) || !disk->triangles || !disk->side || !on_boundary) {
        status = error_memory(error);
        goto done;
    }
    for (int32_t h = 0; h < 3 * mesh->n_triangles; h++) {
        disk->side[h] = -1;
        if (mesh->twin[h] < 0)
            on_boundary[halfedge_from(mesh, h)] = on_boundary[halfedge_to(mesh, h)] = true;
    }
    for (int32_t k = 0; k < marks->n; k++)
        m->order[marks->vertex[k]] = marks->order[k];
    join_corners(m);
    int32_t n_sides = follow_boundary(m, start) ? find_corners(m, start >= 0, on_boundary) : 0;
    if (n_sides == 0) {
        status = error_set(error, ORB_CUT_BLOCKED, "the cut through the cones does not leave a disk with corners");
        goto done;
    }
    status = write_word(m, n_sides, on_boundary, error);
    if (status == ORB_OK)
        status = number_copies(m, error);
done:
    free(on_boundary);
    return status;
}

orb_status disk_create(const orb_mesh *mesh, const uint8_t *cut, int32_t start, const orb_marks *marks,
                       orb_disk **result, orb_error *error) {
    *result = NULL;
    maker m = {.disk = calloc(1, sizeof *m.disk), .mesh = mesh, .cut = cut};
    if (!m.disk)
        return error_memory(error);
    orb_status status = fill(&m, start, marks, error);
    maker_free(&m);
    if (status == ORB_OK)
        *result = m.disk;
    else
        disk_free(m.disk);
    return status;
}

void disk_free(orb_disk *disk) {
    if (!disk)
        return;
    mesh_free(disk->refined);
    free(disk->refined_from);
    word_free(disk->word);
    free(disk->copy_vertex);
    free(disk->place);
    free(disk->triangles);
    free(disk->boundary);
    free(disk->corner_at);
    free(disk->side);
    free(disk);
}
