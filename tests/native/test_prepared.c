/* Embeddings with what a mesh has prepared, against those without. SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>

#include "check.h"
#include "embedding.h"
#include "embed.h"
#include "surfaces.h"

/* Both ways, and the greatest distance between images of one copy. */
static double difference(const sample_mesh *mesh, const orb_prepared *prepared, const orb_request *request) {
    const orb_mesh_arrays arrays = sample_arrays(mesh);
    orb_embedding *plain = NULL, *fast = NULL;
    orb_request with = *request;
    orb_error error;
    double gap = INFINITY;
    with.prepared = prepared;
    CHECK(orb_embed(&arrays, request, &plain, &error) == ORB_OK);
    CHECK(orb_embed(NULL, &with, &fast, &error) == ORB_OK);
    if (plain && fast && plain->copies->n_copies == fast->copies->n_copies) {
        gap = 0;
        for (int32_t u = 0; u < plain->copies->n_copies; u++)
            gap = fmax(gap, geometry_distance(plain->tile->geometry, plain->placed[u], fast->placed[u]));
        CHECK(plain->report.clamped_weights == fast->report.clamped_weights);
        CHECK_NEAR(fast->report.quasi_conformal_median, plain->report.quasi_conformal_median, 1e-9);
    }
    orb_embedding_free(plain);
    orb_embedding_free(fast);
    return gap;
}

static void try_all(sample_mesh mesh, int n_requests, const orb_request *requests) {
    const orb_mesh_arrays arrays = sample_arrays(&mesh);
    orb_prepared *prepared = NULL;
    orb_error error;
    REQUIRE(orb_prepare(&arrays, &prepared, &error) == ORB_OK);
    for (int k = 0; k < n_requests; k++)
        CHECK_NEAR(difference(&mesh, prepared, requests + k), 0, 1e-9);
    orb_prepared_free(prepared);
    sample_free(&mesh);
}

static orb_request asking(const char *signature, int32_t k, const int32_t *cones, orb_weights weights) {
    orb_request request = orb_request_default();
    request.signature = signature;
    request.n_cones = k;
    request.cones = cones;
    request.weights = weights;
    return request;
}

TEST(spheres_of_all_geometries_and_weights) {
    const int32_t cones[7] = {0, 14, 30, 100, 75, 55, 121};
    sample_mesh mesh = sample_icosphere(2);
    orb_request requests[12];
    int n = 0;
    sample_roughen(&mesh, 0.05, 1);
    for (int weights = ORB_WEIGHTS_COTANGENT; weights <= ORB_WEIGHTS_DELAUNAY; weights++)
        if (weights != ORB_WEIGHTS_GIVEN)
            requests[n++] = asking("442", 3, cones, (orb_weights)weights);
    requests[n++] = asking("333", 3, cones + 2, ORB_WEIGHTS_COTANGENT);
    requests[n++] = asking("2222", 4, cones, ORB_WEIGHTS_COTANGENT);
    requests[n++] = asking("432", 3, cones, ORB_WEIGHTS_COTANGENT);
    requests[n++] = asking("33", 2, cones, ORB_WEIGHTS_COTANGENT);
    requests[n++] = asking("237", 3, cones, ORB_WEIGHTS_COTANGENT);
    requests[n++] = asking("2222222", 7, cones, ORB_WEIGHTS_COTANGENT);
    requests[n] = asking("442", 3, cones, ORB_WEIGHTS_COTANGENT);
    requests[n++].clamp = 0.7; /* most are raised */
    try_all(mesh, n, requests);
}

TEST(surfaces_with_borders_and_handles) {
    const orb_request mirrors[2] = {asking("*442", 3, (int32_t[]){1, 3, 6}, ORB_WEIGHTS_COTANGENT),
                                    asking("3*2", 2, (int32_t[]){0, 4}, ORB_WEIGHTS_COTANGENT)};
    const orb_request torus = asking("o", 0, NULL, ORB_WEIGHTS_COTANGENT);
    const orb_request twisted = asking("*x", 0, NULL, ORB_WEIGHTS_COTANGENT);
    try_all(sample_fan(7), 2, mirrors); /* chords are halved there */
    try_all(sample_torus(9, 7, 3, 1), 1, &torus);
    try_all(sample_band(9, true), 1, &twisted);
}

TEST(holes_and_vertices_on_their_own) {
    sample_mesh ball = sample_icosphere(2), mesh = sample_new(ball.n_vertices + 1, ball.n_triangles - 1);
    memcpy(mesh.vertices, ball.vertices, 3 * (size_t)ball.n_vertices * sizeof *mesh.vertices);
    memcpy(mesh.triangles, ball.triangles, 3 * (size_t)mesh.n_triangles * sizeof *mesh.triangles);
    sample_free(&ball);
    orb_request request = asking("432", 3, (int32_t[]){0, 14, 30}, ORB_WEIGHTS_COTANGENT);
    request.holes = ORB_HOLES_FILL;
    try_all(mesh, 1, &request);
}

TEST(a_polygon_that_runs_the_other_way) {
    const orb_polygon square = {.curvature = 0, .n_corners = 4};
    orb_request request = asking(NULL, 4, (int32_t[]){1, 6, 4, 2}, ORB_WEIGHTS_COTANGENT);
    request.polygon = &square;
    try_all(sample_fan(7), 1, &request);
}

TEST(triangles_without_area) {
    sample_mesh mesh = sample_icosphere(2);
    for (int k = 0; k < 3; k++) /* one edge has no length */
        mesh.vertices[3 * mesh.triangles[0] + k] = mesh.vertices[3 * mesh.triangles[1] + k];
    const orb_request request = asking("442", 3, (int32_t[]){20, 55, 90}, ORB_WEIGHTS_COTANGENT);
    try_all(mesh, 1, &request);
}

TEST(it_outlives_its_holder_in_a_job) {
    sample_mesh mesh = sample_icosphere(3);
    const orb_mesh_arrays arrays = sample_arrays(&mesh);
    const int32_t cones[3] = {0, 14, 30};
    orb_request request = asking("432", 3, cones, ORB_WEIGHTS_COTANGENT);
    orb_prepared *prepared = NULL;
    orb_job *jobs[3] = {NULL};
    orb_error error;
    REQUIRE(orb_prepare(&arrays, &prepared, &error) == ORB_OK);
    request.prepared = prepared;
    for (int k = 0; k < 3; k++) /* side by side */
        REQUIRE(orb_job_start(NULL, &request, &jobs[k], &error) == ORB_OK);
    orb_prepared_free(prepared);
    sample_free(&mesh);
    orb_job_cancel(jobs[2]);
    for (int k = 0; k < 3; k++) {
        orb_embedding *embedding = NULL;
        CHECK(orb_job_finish(jobs[k], &embedding, &error) == (k == 2 ? ORB_CANCELLED : ORB_OK));
        CHECK((embedding == NULL) == (k == 2));
        orb_embedding_free(embedding);
    }
}

TEST(what_is_wrong_with_a_mesh_is_said_at_once) {
    sample_mesh mesh = sample_icosphere(1);
    const orb_mesh_arrays arrays = sample_arrays(&mesh);
    orb_prepared *prepared = NULL;
    orb_error error;
    CHECK(orb_prepare(NULL, &prepared, &error) == ORB_BAD_ARGUMENT);
    CHECK(orb_prepare(&arrays, NULL, &error) == ORB_BAD_ARGUMENT);
    mesh.vertices[4] = NAN;
    CHECK(orb_prepare(&arrays, &prepared, &error) == ORB_NON_FINITE && prepared == NULL);
    CHECK(error.elements[0] == 1);
    orb_embedding *embedding = NULL;
    orb_request request = asking("442", 3, (int32_t[]){0, 1, 2}, ORB_WEIGHTS_COTANGENT);
    CHECK(orb_embed(NULL, &request, &embedding, &error) == ORB_BAD_ARGUMENT);
    orb_prepared_free(NULL);
    sample_free(&mesh);
}
