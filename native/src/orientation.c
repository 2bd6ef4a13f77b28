/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "orientation.h"

#include <stdlib.h>
#include <string.h>

static bool runs_same_way(const orb_mesh *mesh, int32_t h) {
    return mesh->twin[h] >= 0 && halfedge_from(mesh, h) == halfedge_from(mesh, mesh->twin[h]);
}

/* turned[n_triangles]: which triangles to turn over so that neighbours agree across the edges that are not cut (`cut`
 * may be NULL); false if they cannot. `stack` [n_triangles]. */
static bool flood_orientation(const orb_mesh *mesh, const uint8_t *cut, int8_t *turned, int32_t *stack) {
    bool agree = true;
    memset(turned, -1, (size_t)mesh->n_triangles);
    for (int32_t seed = 0; seed < mesh->n_triangles; seed++) {
        if (turned[seed] >= 0)
            continue;
        int32_t height = 0;
        turned[seed] = 0;
        stack[height++] = seed;
        while (height > 0) {
            int32_t t = stack[--height];
            for (int32_t h = 3 * t; h < 3 * t + 3; h++) {
                int32_t g = mesh->twin[h];
                if (g < 0 || (cut && cut[mesh->edge[h]]))
                    continue;
                int8_t want = turned[t] ^ runs_same_way(mesh, h);
                agree = agree && (turned[g / 3] < 0 || turned[g / 3] == want);
                if (turned[g / 3] >= 0)
                    continue;
                turned[g / 3] = want;
                stack[height++] = g / 3;
            }
        }
    }
    return agree;
}

static orb_status flood(const orb_mesh *mesh, const uint8_t *cut, int8_t **turned, bool *agree, orb_error *error) {
    *turned = malloc((size_t)mesh->n_triangles + 1);
    int32_t *stack = malloc(((size_t)mesh->n_triangles + 1) * sizeof *stack);
    orb_status status = *turned && stack ? ORB_OK : error_memory(error);
    if (status == ORB_OK)
        *agree = flood_orientation(mesh, cut, *turned, stack);
    free(stack);
    return status;
}

orb_status orientation_check(orb_mesh *mesh, orb_error *error) {
    orb_found disagreeing = {0};
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        int32_t h = mesh->edge_halfedge[e];
        if (runs_same_way(mesh, h))
            found_add_edge(&disagreeing, halfedge_from(mesh, h), halfedge_to(mesh, h));
    }
    mesh->orientable = true;
    if (disagreeing.found == 0)
        return ORB_OK;
    int8_t *turned = NULL;
    orb_status status = flood(mesh, NULL, &turned, &mesh->orientable, error);
    free(turned);
    if (status != ORB_OK || !mesh->orientable)
        return status;
    return error_set_elements(error, ORB_INCONSISTENT_ORIENTATION, ORB_EDGE, disagreeing.elements, disagreeing.entries,
                              disagreeing.found,
                              "%lld %s two triangles that face opposite ways, first %d-%d: select all and use "
                              "Mesh > Normals > Recalculate Outside",
                              (long long)disagreeing.found, disagreeing.found == 1 ? "edge joins" : "edges join",
                              (int)disagreeing.elements[0], (int)disagreeing.elements[1]);
}

/* Half-edge h of a triangle that was turned over. */
static int32_t turned_halfedge(const int8_t *turned, int32_t h) {
    return h >= 0 && turned[h / 3] ? 3 * (h / 3) + 2 - h % 3 : h;
}

static void swap(int32_t *a, int32_t *b) {
    int32_t c = *a;
    *a = *b;
    *b = c;
}

orb_status mesh_orient(orb_mesh *mesh, const uint8_t *cut, orb_error *error) {
    if (mesh->orientable)
        return ORB_OK;
    int8_t *turned = NULL;
    bool agree = true;
    orb_status status = flood(mesh, cut, &turned, &agree, error);
    if (status != ORB_OK)
        goto done;
    if (!agree) {
        status = error_set(error, ORB_CUT_BLOCKED, "the cut leaves a surface that is not orientable");
        goto done;
    }
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        if (!turned[t])
            continue;
        swap(&mesh->triangles[3 * t + 1], &mesh->triangles[3 * t + 2]);
        swap(&mesh->twin[3 * t], &mesh->twin[3 * t + 2]);
        swap(&mesh->edge[3 * t], &mesh->edge[3 * t + 2]);
    }
    for (int32_t h = 0; h < 3 * mesh->n_triangles; h++)
        mesh->twin[h] = turned_halfedge(turned, mesh->twin[h]);
    for (int32_t e = 0; e < mesh->n_edges; e++)
        mesh->edge_halfedge[e] = turned_halfedge(turned, mesh->edge_halfedge[e]);
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        int32_t h = mesh->vertex_halfedge[v];
        if (h >= 0 && turned[h / 3] && h % 3 != 0)
            mesh->vertex_halfedge[v] = 3 * (h / 3) + 3 - h % 3;
    }
done:
    free(turned);
    return status;
}
