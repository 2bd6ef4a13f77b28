/* Dijkstra's algorithm, towards one vertex or all. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The heap knows where each vertex is in it, and nothing is reset between two searches, so that a search costs what
 * it visits and not what the mesh has. */
#include "shortest.h"

#include <math.h>
#include <stdlib.h>

void shortest_clear(shortest_search *search) {
    free(search->nodes);
    free(search->heap);
    *search = (shortest_search){0};
}

bool shortest_allocate(shortest_search *search, int32_t capacity) {
    shortest_clear(search);
    search->nodes = calloc((size_t)capacity, sizeof *search->nodes);
    search->heap = malloc((size_t)capacity * sizeof *search->heap);
    return search->nodes && search->heap;
}

static bool entry_before(shortest_entry a, shortest_entry b) {
    return a.key < b.key || (a.key == b.key && a.vertex < b.vertex);
}

static void heap_put(shortest_search *search, int32_t slot, shortest_entry entry) {
    search->heap[slot] = entry;
    search->nodes[entry.vertex].slot = slot;
}

/* Puts the entry into the free slot or above it. */
static void heap_raise(shortest_search *search, int32_t slot, shortest_entry entry) {
    while (slot > 0 && entry_before(entry, search->heap[(slot - 1) / 2])) {
        heap_put(search, slot, search->heap[(slot - 1) / 2]);
        slot = (slot - 1) / 2;
    }
    heap_put(search, slot, entry);
}

static int32_t heap_take(shortest_search *search) {
    int32_t first = search->heap[0].vertex, n = --search->n_heap, slot = 0;
    shortest_entry entry = search->heap[n];
    for (int32_t child = 1; child < n; child = 2 * slot + 1) { /* no overflow: a mesh has at most 2^31 / 3 vertices */
        if (child + 1 < n && entry_before(search->heap[child + 1], search->heap[child]))
            child++;
        if (!entry_before(search->heap[child], entry))
            break;
        heap_put(search, slot, search->heap[child]);
        slot = child;
    }
    if (n > 0)
        heap_put(search, slot, entry);
    search->nodes[first].slot = -1;
    return first;
}

/* A lower bound of the distance along edges; where the squares overflow, zero is one. */
static double straight_distance(const orb_mesh *mesh, int32_t a, int32_t b) {
    const double *p = mesh->vertices + 3 * (size_t)a, *q = mesh->vertices + 3 * (size_t)b;
    double x = q[0] - p[0], y = q[1] - p[1], z = q[2] - p[2];
    double distance = sqrt(x * x + y * y + z * z);
    return isfinite(distance) ? distance : 0.0;
}

static void reach(shortest_search *search, const orb_mesh *mesh, int32_t to, int32_t vertex, int32_t previous,
                  double distance) {
    shortest_node *node = search->nodes + vertex;
    if (node->round != search->round) {
        node->round = search->round;
        node->remaining = straight_distance(mesh, vertex, to);
        node->slot = search->n_heap++;
    } else if (node->slot < 0 || !(distance < node->distance)) {
        return;
    }
    node->distance = distance;
    node->previous = previous;
    heap_raise(search, node->slot, (shortest_entry){distance + node->remaining, vertex});
}

bool shortest_find(shortest_search *search, const orb_mesh *mesh, const int32_t *place, int32_t free_place,
                   int32_t from, int32_t to) {
    search->round++;
    search->n_heap = 0;
    reach(search, mesh, to, from, -1, 0.0);
    while (search->n_heap > 0) {
        int32_t vertex = heap_take(search), start = mesh->vertex_halfedge[vertex], h = start;
        if (vertex == to)
            return true;
        do {
            int32_t next = halfedge_to(mesh, h);
            if (place[next] == free_place || next == to)
                reach(search, mesh, to, next, vertex, search->nodes[vertex].distance + mesh_edge_length(mesh, h));
            h = mesh->twin[halfedge_previous(h)];
        } while (h != start);
    }
    return false;
}

static void lower(shortest_search *search, int32_t vertex, double length, double *distance) {
    shortest_node *node = search->nodes + vertex;
    if (!(length < distance[vertex]))
        return;
    if (node->round != search->round) {
        node->round = search->round;
        node->slot = search->n_heap++;
    }
    distance[vertex] = length;
    heap_raise(search, node->slot, (shortest_entry){length, vertex});
}

void shortest_lower(shortest_search *search, const orb_mesh *mesh, int32_t from, double *distance) {
    search->round++;
    search->n_heap = 0;
    lower(search, from, 0, distance);
    while (search->n_heap > 0) {
        const int32_t vertex = heap_take(search);
        orb_turn turn = mesh_turn_start(mesh, vertex);
        const int32_t start = turn.corner;
        do {
            const int32_t out = turn.corner, in = halfedge_previous(out);
            lower(search, halfedge_to(mesh, out), distance[vertex] + mesh_edge_length(mesh, out), distance);
            lower(search, halfedge_from(mesh, in), distance[vertex] + mesh_edge_length(mesh, in), distance);
        } while (mesh_turn(mesh, &turn) && turn.corner != start);
    }
}
