/* Group elements of triangle corners. SPDX-License-Identifier: GPL-3.0-or-later */
#include "holonomy.h"

#include <stdlib.h>
#include <string.h>

/* What two group elements may differ by and still be one: rounding is near 1e-15, different elements of a discrete
 * group that a coarse mesh's pieces meet are far apart. */
static const double same_element = 1e-7;

orb_isometry holonomy_element(const orb_tile *tile, orb_copy_place place) {
    if (place.kind == PLACE_SELF)
        return isometry_identity();
    return (place.kind == PLACE_SIDE ? tile->pairings : tile->elements)[place.index];
}

/* Its number in the list that holonomy_create makes: the identity, the pairings, the corners' elements. */
static int32_t element_number(const orb_tile *tile, orb_copy_place place) {
    if (place.kind == PLACE_SELF)
        return 0;
    return 1 + place.index + (place.kind == PLACE_CORNER ? tile->word->n_sides : 0);
}

/* The work of joining the pieces of refined triangles. */
typedef struct joiner {
    const orb_mesh *mesh;
    const orb_disk *disk;
    const orb_tile *tile;
    orb_copies *copies;
    int32_t room_isometries, room_copies;
    int32_t *next_copy;     /* [room_copies] chain of the copies of one vertex */
    int32_t *cone_of;       /* [mesh->n_vertices] corner number of the tile, or -1 */
    int32_t *element;       /* [disk->mesh->n_triangles] group element of each piece; -1 before it is met */
    int32_t *first, *piece; /* pieces of input triangle t: piece[first[t]] ... piece[first[t + 1] - 1] */
    int32_t *queue;
} joiner;

static orb_status grow(void **array, int32_t *room, int32_t needed, size_t size, orb_error *error) {
    if (needed <= *room)
        return ORB_OK;
    int32_t larger = needed + needed / 2 + 16;
    void *moved = realloc(*array, (size_t)larger * size);
    if (!moved)
        return error_memory(error);
    *array = moved;
    *room = larger;
    return ORB_OK;
}

/* The number of an element that is `outer` after `inner`. */
static orb_status compose(joiner *work, orb_isometry outer, orb_isometry inner, int32_t *number, orb_error *error) {
    orb_copies *copies = work->copies;
    orb_isometry product = isometry_compose(work->tile->geometry, outer, inner);
    for (int32_t i = 0; i < copies->n_isometries; i++)
        if (isometry_same(work->tile->geometry, copies->isometries[i], product, same_element)) {
            *number = i;
            return ORB_OK;
        }
    void *array = copies->isometries;
    orb_status status =
        grow(&array, &work->room_isometries, copies->n_isometries + 1, sizeof *copies->isometries, error);
    copies->isometries = array;
    if (status != ORB_OK)
        return status;
    *number = copies->n_isometries++;
    copies->isometries[*number] = product;
    return ORB_OK;
}

/* The copy of `vertex` at an element; cones are the same copy wherever their position is the same. */
static orb_status find_copy(joiner *work, int32_t vertex, int32_t element, int32_t *number, orb_error *error) {
    orb_copies *copies = work->copies;
    const orb_geometry *geometry = work->tile->geometry;
    int32_t cone = work->cone_of[vertex], last = vertex;
    for (int32_t u = vertex; u >= 0; u = work->next_copy[u]) {
        bool same = copies->isometry[u] == element;
        if (!same && cone >= 0) {
            orb_point p = work->tile->corners[cone];
            orb_point here = isometry_apply(geometry, copies->isometries[copies->isometry[u]], p);
            same = geometry_distance(geometry, here, isometry_apply(geometry, copies->isometries[element], p)) <
                   same_element;
        }
        if (same) {
            *number = u;
            return ORB_OK;
        }
        last = u;
    }
    void *arrays[] = {copies->vertex, copies->isometry, work->next_copy};
    orb_status status = ORB_OK;
    int32_t room = work->room_copies;
    for (int k = 0; k < 3 && status == ORB_OK; k++) {
        room = work->room_copies;
        status = grow(&arrays[k], &room, copies->n_copies + 1, sizeof(int32_t), error);
    }
    copies->vertex = arrays[0];
    copies->isometry = arrays[1];
    work->next_copy = arrays[2];
    if (status != ORB_OK)
        return status;
    work->room_copies = room;
    *number = copies->n_copies++;
    copies->vertex[*number] = vertex;
    copies->isometry[*number] = element;
    work->next_copy[*number] = -1;
    work->next_copy[last] = *number;
    return ORB_OK;
}

/* Lays the pieces of one input triangle out in the frame of its first piece. */
static orb_status join_pieces(joiner *work, int32_t triangle, orb_error *error) {
    const orb_mesh *mesh = work->disk->mesh;
    int32_t head = 0, tail = 0;
    work->queue[tail++] = work->piece[work->first[triangle]];
    work->element[work->queue[0]] = 0;
    while (head < tail) {
        int32_t t = work->queue[head++];
        for (int32_t h = 3 * t; h < 3 * t + 3; h++) {
            int32_t other = mesh->twin[h] / 3, s = work->disk->side[h];
            if (work->disk->refined_from[other] != triangle || work->element[other] >= 0)
                continue;
            work->element[other] = work->element[t];
            if (s >= 0) {
                /* Continuity, k x = k' g_s x, where this side is at k and its partner at k' g_s. */
                orb_isometry pairing = isometry_inverse(work->tile->pairings[s]);
                orb_isometry here = work->copies->isometries[work->element[t]];
                orb_status status = compose(work, here, pairing, &work->element[other], error);
                if (status != ORB_OK)
                    return status;
            }
            work->queue[tail++] = other;
        }
    }
    return ORB_OK;
}

/* The copies at the corners of one input triangle. */
static orb_status place_triangle(joiner *work, int32_t triangle, orb_error *error) {
    const orb_disk *disk = work->disk;
    orb_status status = join_pieces(work, triangle, error);
    for (int32_t c = 0; c < 3 && status == ORB_OK; c++) {
        int32_t vertex = work->mesh->triangles[3 * triangle + c], element = -1;
        for (int32_t i = work->first[triangle]; i < work->first[triangle + 1] && element < 0; i++)
            for (int32_t h = 3 * work->piece[i]; h < 3 * work->piece[i] + 3; h++) {
                if (disk->mesh->triangles[h] != vertex)
                    continue;
                orb_isometry bank = holonomy_element(work->tile, disk->place[disk->triangles[h]]);
                orb_isometry piece = work->copies->isometries[work->element[h / 3]];
                status = compose(work, piece, bank, &element, error);
                break;
            }
        if (status == ORB_OK)
            status = find_copy(work, vertex, element, &work->copies->triangles[3 * triangle + c], error);
    }
    return status;
}

static orb_status joiner_allocate(joiner *work, orb_error *error) {
    size_t n = (size_t)work->mesh->n_vertices, m = (size_t)work->mesh->n_triangles;
    size_t pieces = (size_t)work->disk->mesh->n_triangles;
    work->next_copy = malloc((n + 1) * sizeof(int32_t));
    work->cone_of = malloc((n + 1) * sizeof(int32_t));
    work->element = malloc(pieces * sizeof(int32_t));
    work->first = calloc(m + 1, sizeof(int32_t));
    work->piece = malloc(pieces * sizeof(int32_t));
    work->queue = malloc(pieces * sizeof(int32_t));
    if (!work->next_copy || !work->cone_of || !work->element || !work->first || !work->piece || !work->queue)
        return error_memory(error);
    for (size_t v = 0; v < n; v++)
        work->next_copy[v] = work->cone_of[v] = -1;
    for (int32_t s = 0; s < work->tile->word->n_sides; s++) {
        int32_t u = work->disk->boundary[work->disk->corner_at[s]];
        if (work->tile->word->order[work->tile->word->node[s]] > 1 && work->disk->place[u].kind == PLACE_SELF)
            work->cone_of[work->disk->copy_vertex[u]] = s;
    }
    for (size_t t = 0; t < pieces; t++) {
        work->element[t] = -1;
        work->first[work->disk->refined_from[t] + 1]++;
    }
    for (size_t t = 0; t < m; t++)
        work->first[t + 1] += work->first[t];
    for (size_t t = 0; t < pieces; t++) /* fill each bucket; `first` ends up one bucket on */
        work->piece[work->first[work->disk->refined_from[t]]++] = (int32_t)t;
    for (size_t t = m; t > 0; t--)
        work->first[t] = work->first[t - 1];
    work->first[0] = 0;
    return ORB_OK;
}

static void joiner_free(joiner *work) {
    free(work->next_copy);
    free(work->cone_of);
    free(work->element);
    free(work->first);
    free(work->piece);
    free(work->queue);
}

/* `copies` holds the vertices themselves and the tile's pairings; adds what the refined disk's triangles need. */
static orb_status join_refined(const orb_mesh *mesh, const orb_disk *disk, const orb_tile *tile, orb_copies *copies,
                               orb_error *error) {
    joiner work = {.mesh = mesh, .disk = disk, .tile = tile, .copies = copies};
    work.room_copies = copies->n_copies;
    work.room_isometries = copies->n_isometries;
    orb_status status = joiner_allocate(&work, error);
    for (int32_t t = 0; t < mesh->n_triangles && status == ORB_OK; t++)
        status = place_triangle(&work, t, error);
    joiner_free(&work);
    return status;
}

orb_status holonomy_create(const orb_mesh *mesh, const orb_disk *disk, const orb_tile *tile, orb_copies **result,
                           orb_error *error) {
    *result = NULL;
    orb_status status = error_memory(error);
    size_t sides = (size_t)tile->word->n_sides, corners = 3 * (size_t)mesh->n_triangles;
    orb_copies *copies = calloc(1, sizeof *copies);
    if (!copies)
        return status;
    copies->n_copies = disk->refined ? mesh->n_vertices : disk->n_copies;
    copies->n_isometries = 1 + 2 * tile->word->n_sides;
    copies->vertex = malloc(((size_t)copies->n_copies + 1) * sizeof(int32_t));
    copies->isometry = malloc(((size_t)copies->n_copies + 1) * sizeof(int32_t));
    copies->triangles = malloc(corners * sizeof(int32_t));
    copies->isometries = malloc((1 + 2 * sides) * sizeof *copies->isometries);
    if (!copies->vertex || !copies->isometry || !copies->triangles || !copies->isometries)
        goto done;
    copies->isometries[0] = isometry_identity();
    memcpy(copies->isometries + 1, tile->pairings, sides * sizeof *copies->isometries);
    memcpy(copies->isometries + 1 + sides, tile->elements, sides * sizeof *copies->isometries);
    for (int32_t u = 0; u < copies->n_copies; u++) {
        copies->vertex[u] = disk->refined ? u : disk->copy_vertex[u];
        copies->isometry[u] = disk->refined ? 0 : element_number(tile, disk->place[u]);
    }
    if (disk->refined) {
        status = join_refined(mesh, disk, tile, copies, error);
        if (status != ORB_OK)
            goto done;
    } else {
        memcpy(copies->triangles, disk->triangles, corners * sizeof(int32_t));
    }
    status = error_set(error, ORB_OK, "%s", "");
    *result = copies;
    copies = NULL;
done:
    holonomy_free(copies);
    return status;
}

void holonomy_free(orb_copies *copies) {
    if (!copies)
        return;
    free(copies->vertex);
    free(copies->isometry);
    free(copies->triangles);
    free(copies->isometries);
    free(copies);
}
