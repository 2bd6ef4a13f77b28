/* Embeddings for tests. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef EMBED_H
#define EMBED_H

#include "cut.h"
#include "embedding.h"
#include "meshes.h"
#include "problem.h"
#include "random.h"

static inline orb_status embed(const sample_mesh *mesh, const char *signature, int32_t n_cones, const int32_t *cones,
                               double clamp, orb_embedding **embedding, orb_error *error) {
    orb_mesh_arrays arrays = sample_arrays(mesh);
    orb_request request = orb_request_default();
    request.signature = signature;
    request.n_cones = n_cones;
    request.cones = cones;
    request.weights = ORB_WEIGHTS_COTANGENT;
    request.clamp = clamp;
    return orb_embed(&arrays, &request, embedding, error);
}

/* Distinct random vertices. */
static inline void pick_cones(random_state *state, int32_t n_vertices, int32_t k, int32_t *cones) {
    for (int32_t i = 0; i < k; i++) {
        bool taken = true;
        while (taken) {
            cones[i] = random_below(state, n_vertices);
            taken = false;
            for (int32_t j = 0; j < i; j++)
                taken = taken || cones[j] == cones[i];
        }
    }
}

/* The problem that an embedding solved, set up once more; it borrows the embedding's arrays. */
static inline orb_status problem_of(orb_embedding *embedding, orb_problem **problem, orb_error *error) {
    orb_disk *disk = NULL;
    orb_marks marks = surface_marks(embedding->surface);
    orb_status status =
        cut_open(embedding->mesh, embedding->surface->signature, embedding->surface->cut, embedding->surface->parent,
                 &marks, &disk, error);
    if (status == ORB_OK)
        status = problem_create(embedding->mesh, embedding->copies, disk, embedding->tile, embedding->weights, problem,
                                error);
    if (status == ORB_OK)
        problem_aim(*problem, embedding->position);
    disk_free(disk);
    return status;
}

#endif
