/* Shortest edge path between two vertices through free ones. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_SHORTEST_H
#define ORB_SHORTEST_H

#include "mesh.h"

/* What a search knows of a vertex. */
typedef struct shortest_node {
    double distance;  /* from the start, in this round */
    double remaining; /* at least so far from the end */
    int32_t previous; /* the vertex before it */
    int32_t round;    /* the search that last reached it; all else here is stale unless it is the present one */
    int32_t slot;     /* where it is in the heap; -1 once it is settled */
} shortest_node;

typedef struct shortest_entry {
    double key; /* distance + remaining */
    int32_t vertex;
} shortest_entry;

/* Room for searches on meshes of at most `capacity` vertices; start from {0}. */
typedef struct shortest_search {
    int32_t round, n_heap;
    shortest_node *nodes; /* [capacity] */
    shortest_entry *heap; /* [capacity] */
} shortest_search;

/* Returns false when out of memory; what was there before is freed in any case. */
bool shortest_allocate(shortest_search *search, int32_t capacity);
void shortest_clear(shortest_search *search);

/* The shortest path between two used vertices of a closed mesh through vertices with place[v] == free_place; false if
 * there is none. Walk it from `to` back by search->nodes[].previous. This is Dijkstra's algorithm on lengths reduced
 * by the straight distance to the end (A*), O(v log v) in the v vertices that it visits; of equally promising
 * vertices the one with the smaller number comes first, so that the path depends on the arguments only. */
bool shortest_find(shortest_search *search, const orb_mesh *mesh, const int32_t *place, int32_t free_place,
                   int32_t from, int32_t to);

/* distance[v] = min(distance[v], length of the shortest edge path from `from` to v), on any mesh, for all v. It visits those
 * whose distance falls and their neighbours only. */
void shortest_lower(shortest_search *search, const orb_mesh *mesh, int32_t from, double *distance);

#endif
