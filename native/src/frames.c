/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "frames.h"

#include <stdlib.h>
#include <string.h>

/* What two group elements may differ by and still be one, as in holonomy.c. */
static const double same_element = 1e-7;

struct orb_frames {
    const orb_geometry *geometry;
    orb_copies *copies;
    int32_t *next; /* [room_copies] chain of the copies of one vertex, from the vertex's own */
    int32_t room_copies, room_isometries;
};

static void *grown(void *array, int32_t room, size_t size) { return realloc(array, (size_t)room * size); }

/* Room for one more copy and one more isometry. */
static bool make_room(orb_frames *frames) {
    orb_copies *copies = frames->copies;
    if (copies->n_isometries == frames->room_isometries) {
        const int32_t room = frames->room_isometries + frames->room_isometries / 2 + 16;
        orb_isometry *isometries = grown(copies->isometries, room, sizeof *isometries);
        if (!isometries)
            return false;
        copies->isometries = isometries;
        frames->room_isometries = room;
    }
    if (copies->n_copies < frames->room_copies)
        return true;
    const int32_t room = frames->room_copies + frames->room_copies / 2 + 16;
    int32_t *arrays[3] = {grown(copies->vertex, room, sizeof(int32_t)), NULL, NULL};
    copies->vertex = arrays[0] ? arrays[0] : copies->vertex;
    arrays[1] = grown(copies->isometry, room, sizeof(int32_t));
    copies->isometry = arrays[1] ? arrays[1] : copies->isometry;
    arrays[2] = grown(frames->next, room, sizeof(int32_t));
    frames->next = arrays[2] ? arrays[2] : frames->next;
    if (!arrays[0] || !arrays[1] || !arrays[2])
        return false;
    frames->room_copies = room;
    return true;
}

orb_status frames_create(const orb_geometry *geometry, const orb_copies *copies, int32_t n_vertices,
                         orb_frames **result, orb_error *error) {
    *result = NULL;
    orb_status status = error_memory(error);
    orb_frames *frames = calloc(1, sizeof *frames);
    orb_copies *own = calloc(1, sizeof *own);
    if (!frames || !own) {
        free(frames);
        free(own);
        return status;
    }
    const size_t n = (size_t)copies->n_copies, isometries = (size_t)copies->n_isometries;
    frames->geometry = geometry;
    frames->copies = own;
    frames->room_copies = own->n_copies = copies->n_copies;
    frames->room_isometries = own->n_isometries = copies->n_isometries;
    own->vertex = malloc((n + 1) * sizeof *own->vertex);
    own->isometry = malloc((n + 1) * sizeof *own->isometry);
    own->isometries = malloc((isometries + 1) * sizeof *own->isometries);
    frames->next = malloc((n + 1) * sizeof *frames->next);
    if (!own->vertex || !own->isometry || !own->isometries || !frames->next)
        goto done;
    memcpy(own->vertex, copies->vertex, n * sizeof *own->vertex);
    memcpy(own->isometry, copies->isometry, n * sizeof *own->isometry);
    memcpy(own->isometries, copies->isometries, isometries * sizeof *own->isometries);
    for (int32_t u = 0; u < own->n_copies; u++)
        frames->next[u] = -1;
    for (int32_t u = n_vertices; u < own->n_copies; u++) {
        frames->next[u] = frames->next[own->vertex[u]];
        frames->next[own->vertex[u]] = u;
    }
    *result = frames;
    return ORB_OK;
done:
    holonomy_free(own);
    frames_free(frames);
    return status;
}

void frames_free(orb_frames *frames) {
    if (!frames)
        return;
    free(frames->next);
    free(frames);
}

orb_copies *frames_copies(orb_frames *frames) { return frames->copies; }

/* The copy of `copy`'s vertex at the element `change` after its own. */
static orb_status move_copy(orb_frames *frames, orb_isometry change, int32_t copy, int32_t *moved, orb_error *error) {
    orb_copies *copies = frames->copies;
    const orb_isometry element = isometry_compose(frames->geometry, change, copies->isometries[copies->isometry[copy]]);
    const int32_t vertex = copies->vertex[copy];
    for (int32_t u = vertex; u >= 0; u = frames->next[u])
        if (isometry_same(frames->geometry, copies->isometries[copies->isometry[u]], element, same_element)) {
            *moved = u;
            return ORB_OK;
        }
    if (!make_room(frames))
        return error_memory(error);
    copies->isometries[copies->n_isometries] = element;
    const int32_t made = copies->n_copies++;
    copies->vertex[made] = vertex;
    copies->isometry[made] = copies->n_isometries++;
    frames->next[made] = frames->next[vertex];
    frames->next[vertex] = made;
    *moved = made;
    return ORB_OK;
}

orb_status frames_carry(orb_frames *frames, int32_t here, int32_t there, int32_t copy, int32_t *carried,
                        orb_error *error) {
    const orb_copies *copies = frames->copies;
    *carried = copy;
    if (copies->isometry[here] == copies->isometry[there])
        return ORB_OK;
    const orb_isometry back = isometry_inverse(copies->isometries[copies->isometry[there]]);
    return move_copy(frames, isometry_compose(frames->geometry, copies->isometries[copies->isometry[here]], back), copy,
                     carried, error);
}

orb_status frames_reflect(orb_frames *frames, int32_t here, orb_isometry reflection, int32_t copy, int32_t *reflected,
                          orb_error *error) {
    const orb_isometry element = frames->copies->isometries[frames->copies->isometry[here]];
    const orb_isometry turned = isometry_compose(frames->geometry, element, reflection);
    return move_copy(frames, isometry_compose(frames->geometry, turned, isometry_inverse(element)), copy, reflected,
                     error);
}
