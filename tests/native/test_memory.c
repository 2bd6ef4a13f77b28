/* Every allocation of a whole run fails once. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Linked with --wrap=malloc and so on (native/Makefile), so that CHOLMOD's allocations count too. A run must end with
 * ORB_OUT_OF_MEMORY, or with success where the memory was dispensable; the sanitizers see to it that nothing leaks. */
#include <math.h>
#include <stdlib.h>

#include "check.h"
#include "failing.h"
#include "orbifold_cones.h"
#include "orbifold_maps.h"
#include "surfaces.h"

/* Embeds, reads the UVs and, on the sphere, the whole sphere. */
static orb_status use_everything(const sample_mesh *mesh, const orb_request *request, double *room) {
    orb_mesh_arrays arrays = sample_arrays(mesh);
    orb_embedding *embedding = NULL;
    orb_error error;
    orb_status status = orb_embed(&arrays, request, &embedding, &error);
    CHECK((status == ORB_OK) == (embedding != NULL));
    orb_report report = {0};
    if (status == ORB_OK) {
        orb_embedding_report(embedding, &report);
        status = orb_uv(embedding, ORB_CHART_DEFAULT, room, NULL, &error);
    }
    if (status == ORB_OK && report.orbifold_euler > 0 && report.boundary_loops == report.filled_holes)
        status = orb_whole_sphere(embedding, room, NULL, &error);
    orb_embedding_free(embedding);
    return status;
}

static orb_status embeds(const sample_mesh *mesh, const void *request, double *room) {
    return use_everything(mesh, request, room);
}

/* The same with a prepared mesh. */
static orb_status prepares(const sample_mesh *mesh, const void *request, double *room) {
    orb_mesh_arrays arrays = sample_arrays(mesh);
    orb_request with = *(const orb_request *)request;
    orb_prepared *prepared = NULL;
    orb_error error;
    orb_status status = orb_prepare(&arrays, &prepared, &error);
    CHECK((status == ORB_OK) == (prepared != NULL));
    with.prepared = prepared;
    if (status == ORB_OK)
        status = use_everything(mesh, &with, room);
    orb_prepared_free(prepared);
    return status;
}

/* Embeds twice and maps from one to the other. */
static orb_status maps(const sample_mesh *mesh, const void *request, double *room) {
    orb_mesh_arrays arrays = sample_arrays(mesh);
    orb_embedding *a = NULL, *b = NULL;
    orb_map_distortion distortion;
    orb_error error;
    const orb_request *asked = request;
    int32_t *triangles = (int32_t *)(room + 3 * (size_t)mesh->n_vertices), sequence[8];
    orb_request other = *asked;
    other.weights = ORB_WEIGHTS_UNIFORM;
    orb_status status = orb_embed(&arrays, asked, &a, &error);
    if (status == ORB_OK)
        status = orb_embed(&arrays, &other, &b, &error);
    if (status == ORB_OK)
        status = orb_surface_map(a, b, 0, NULL, NULL, triangles, room, NULL, &error);
    if (status == ORB_OK)
        status = orb_surface_map_distortion(a, b, NULL, NULL, &distortion, &error);
    orb_trace *trace = NULL;
    if (status == ORB_OK)
        status = orb_surface_map_trace(a, b, 2, (int32_t[]){0, 4}, &trace, &error);
    orb_trace_free(trace);
    if (status == ORB_OK)
        status = orb_landmark_sequence(&arrays, asked->n_cones, asked->cones, NULL, sequence, &error);
    orb_embedding_free(a);
    orb_embedding_free(b);
    return status;
}

/* Suggests cones, and predicts what the first ones do. */
static orb_status suggests(const sample_mesh *mesh, const void *request, double *room) {
    orb_mesh_arrays arrays = sample_arrays(mesh);
    orb_suggestions *suggestions = NULL;
    orb_error error;
    orb_status status = orb_suggest_cones(&arrays, request, &suggestions, &error);
    CHECK((status == ORB_OK) == (suggestions != NULL));
    if (status == ORB_OK) {
        const orb_suggestion made = orb_suggestions_view(suggestions, 0);
        orb_request predicted = orb_request_default();
        predicted.signature = made.signature;
        predicted.n_cones = made.n_cones;
        predicted.cones = made.cones;
        predicted.holes = ((const orb_suggest_request *)request)->holes;
        status = orb_predict(&arrays, &predicted, room, room + 1, &error);
    }
    orb_suggestions_free(suggestions);
    return status;
}

/* Of a long run every `step`-th allocation only. */
static void fail_each_in(orb_status (*run)(const sample_mesh *, const void *, double *), sample_mesh mesh,
                         const void *request, long step) {
    double *room = calloc(6 * (size_t)mesh.n_triangles + 3 * (size_t)mesh.n_vertices + 1, sizeof *room);
    CHECK(run(&mesh, request, room) == ORB_OK);
    long survived = 0, reported = 0;
    for (long n = 0;; n += step) {
        allocations = 0;
        failing = n;
        orb_status status = run(&mesh, request, room);
        failing = -1;
        if (allocations <= n)
            break; /* the run ended before its n-th allocation */
        CHECK(status == ORB_OK || status == ORB_OUT_OF_MEMORY);
        survived += status == ORB_OK;
        reported += status == ORB_OUT_OF_MEMORY;
        if (check_failures)
            break;
    }
    CHECK(reported * step > 50);
    CHECK(survived * 4 < reported);
    free(room);
    sample_free(&mesh);
}

static void fail_each_of(sample_mesh mesh, orb_request request) { fail_each_in(embeds, mesh, &request, 1); }

static orb_request asking(const char *signature, int32_t k, const int32_t *cones) {
    orb_request request = orb_request_default();
    request.signature = signature;
    request.n_cones = k;
    request.cones = cones;
    request.weights = ORB_WEIGHTS_COTANGENT;
    return request;
}

static void fail_each(sample_mesh mesh, const char *signature, int32_t k, const int32_t *cones) {
    fail_each_of(mesh, asking(signature, k, cones));
}

TEST(out_of_memory_in_the_plane) { fail_each(sample_icosphere(1), "442", 3, (int32_t[]){0, 14, 30}); }
TEST(out_of_memory_with_a_prepared_mesh) {
    const orb_request request = asking("432", 3, (int32_t[]){0, 14, 30});
    fail_each_in(prepares, sample_icosphere(1), &request, 1);
}
TEST(out_of_memory_with_a_modulus) { fail_each(sample_icosphere(1), "2222", 4, (int32_t[]){0, 14, 30, 3}); }
TEST(out_of_memory_on_the_sphere) { fail_each(sample_icosphere(1), "432", 3, (int32_t[]){0, 14, 30}); }
TEST(out_of_memory_with_two_cones) { fail_each(sample_icosphere(1), "33", 2, (int32_t[]){0, 30}); }
TEST(out_of_memory_in_the_hyperbolic_plane) { fail_each(sample_icosphere(1), "237", 3, (int32_t[]){0, 14, 30}); }
TEST(out_of_memory_on_a_refined_mesh) { fail_each(sample_cube(), "22222", 5, (int32_t[]){0, 6, 1, 7, 2}); }

/* A disk, a band and a projective plane: mirrors that vertices slide along, chords that are halved, gluings that
 * reflect, holes that are filled. */
TEST(out_of_memory_with_mirrors) { fail_each(sample_fan(7), "*442", 3, (int32_t[]){1, 3, 6}); }
TEST(out_of_memory_with_a_cone_and_a_corner) { fail_each(sample_fan(7), "3*2", 2, (int32_t[]){0, 4}); }
TEST(out_of_memory_on_an_annulus) { fail_each(sample_band(7, false), "**", 0, (int32_t[]){0}); }
TEST(out_of_memory_on_a_moebius_band) { fail_each(sample_band(7, true), "*x", 0, (int32_t[]){0}); }
TEST(out_of_memory_on_a_torus) { fail_each(sample_torus(5, 4, 3, 1), "o", 0, (int32_t[]){0}); }
TEST(out_of_memory_with_a_hole) {
    sample_mesh open = sample_icosphere(1);
    open.n_triangles -= 1;
    orb_request request = asking("432", 3, (int32_t[]){0, 14, 30});
    request.holes = ORB_HOLES_FILL;
    fail_each_of(open, request);
}

TEST(out_of_memory_while_mapping) {
    orb_request request = asking("22222", 5, (int32_t[]){0, 6, 1, 7, 2});
    request.cut = ORB_CUT_PATH;
    fail_each_in(maps, sample_cube(), &request, 1);
    request = asking("22222", 5, (int32_t[]){0, 3, 14, 30, 35});
    request.cut = ORB_CUT_PATH;
    fail_each_in(maps, sample_icosphere(1), &request, 1);
    request = asking("4*2", 2, (int32_t[]){9, 0});
    request.cut = ORB_CUT_PATH;
    fail_each_in(maps, sample_rectangle(1, 1.3, 3, 3), &request, 1);
    request = asking("2**", 1, (int32_t[]){4});
    request.cut = ORB_CUT_PATH;
    fail_each_in(maps, sample_band(7, false), &request, 1);
    request = asking("o", 0, NULL);
    fail_each_in(maps, sample_torus(5, 4, 3, 1), &request, 1);
}

static sample_mesh sum_of(sample_mesh a, sample_mesh b) {
    sample_mesh sum = sample_sum(&a, 0, &b, 0);
    sample_free(&b);
    sample_free(&a);
    return sum;
}

TEST(out_of_memory_on_a_projective_plane) { fail_each(sample_projective_plane(1), "22x", 2, (int32_t[]){0, 9}); }
TEST(out_of_memory_on_a_klein_bottle) {
    fail_each(sum_of(sample_projective_plane(1), sample_projective_plane(1)), "xx", 0, NULL);
}
TEST(out_of_memory_with_two_handles) {
    fail_each(sum_of(sample_torus(4, 4, 2, 1), sample_torus(4, 4, 2, 1)), "oo", 0, NULL);
}
TEST(out_of_memory_on_a_polygon) {
    orb_request request = orb_request_default();
    request.polygon = &(orb_polygon){.curvature = -1, .n_corners = 5};
    fail_each_of(sample_rectangle(1, 1.3, 4, 5), request);
}

/* Vertices moved out, or in the plane, so that edges must be flipped. */
static sample_mesh rough(sample_mesh mesh, bool flat) {
    random_state state = {9};
    for (int32_t v = flat ? 3 : 0; v < mesh.n_vertices; v++)
        for (int k = 0; k < 3; k++)
            mesh.vertices[3 * v + k] += flat ? 0 : 0.25 * random_unit(&state);
    for (int32_t v = flat ? 6 : 0; v < mesh.n_vertices && flat; v++)
        mesh.vertices[3 * v] *= 1.1 - 0.2 * random_unit(&state);
    return mesh;
}

static void fail_each_with(orb_weights weights, sample_mesh mesh, const char *signature, int32_t n_cones,
                           const int32_t *cones) {
    orb_request request = asking(signature, n_cones, cones);
    request.weights = weights;
    fail_each_of(mesh, request);
}

TEST(out_of_memory_with_conformal_weights) {
    fail_each_with(ORB_WEIGHTS_CONFORMAL, rough(sample_icosphere(1), false), "432", 3, (int32_t[]){0, 14, 30});
    fail_each_with(ORB_WEIGHTS_CONFORMAL, rough(sample_triangle(1, 1, 3), true), "*442", 3, (int32_t[]){0, 1, 2});
    fail_each_with(ORB_WEIGHTS_CONFORMAL, rough(sample_projective_plane(1), false), "22x", 2, (int32_t[]){0, 9});
}
TEST(out_of_memory_with_delaunay_weights) {
    fail_each_with(ORB_WEIGHTS_DELAUNAY, rough(sample_icosphere(1), false), "442", 3, (int32_t[]){0, 14, 30});
}
TEST(out_of_memory_with_exact_mean_values) {
    fail_each_with(ORB_WEIGHTS_MEAN_VALUE_EXACT, sample_icosphere(1), "442", 3, (int32_t[]){0, 14, 30});
}

/* --- suggested cones --------------------------------------------------------------------------------------------- */

static void fail_each_suggesting(sample_mesh mesh, int32_t n, const char *const *signatures,
                                 orb_suggest_request request, long step) {
    request.n_signatures = n;
    request.signatures = signatures;
    fail_each_in(suggests, mesh, &request, step);
}

static sample_mesh small_sphere(void) {
    sample_mesh coarse = sample_octahedron(), fine = sample_refined(&coarse, 2);
    sample_free(&coarse);
    return fine;
}

TEST(out_of_memory_while_suggesting_on_a_sphere) {
    const char *const signatures[] = {"432", "33"};
    fail_each_suggesting(small_sphere(), 2, signatures, (orb_suggest_request){0}, 1);
    fail_each_suggesting(rough(small_sphere(), false), 2, signatures, (orb_suggest_request){0}, 1);
}
TEST(out_of_memory_while_suggesting_cones_that_are_measured) {
    const char *const signatures[] = {"22222"};
    fail_each_suggesting(rough(small_sphere(), false), 1, signatures, (orb_suggest_request){0}, 1);
}
TEST(out_of_memory_while_suggesting_with_wishes) {
    const char *const signatures[] = {"2222"};
    const int32_t fixed[] = {4};
    double away[18] = {[3] = INFINITY, [7] = 0.5};
    orb_suggest_request request = {
        .n_fixed = 1, .fixed = fixed, .keep_away = away, .symmetry = ORB_SYMMETRY_PLANE, .plane = {0, 1, 0, 0}};
    fail_each_suggesting(small_sphere(), 1, signatures, request, 1);
}
TEST(out_of_memory_while_suggesting_on_disks) {
    const char *const signatures[] = {"*442", "4*2"};
    fail_each_suggesting(sample_rectangle(1, 1.3, 3, 3), 2, signatures, (orb_suggest_request){0}, 1);
}
TEST(out_of_memory_while_suggesting_with_holes) {
    const char *const signatures[] = {"442"};
    for (orb_holes holes = ORB_HOLES_FILL; holes <= ORB_HOLES_MIRROR; holes++) {
        sample_mesh open = small_sphere();
        open.n_triangles -= 1;
        fail_each_suggesting(open, 1, signatures, (orb_suggest_request){.holes = holes}, 1);
    }
}
TEST(out_of_memory_while_suggesting_what_is_usual) { /* one allocation in 23 */
    fail_each_suggesting(rough(small_sphere(), false), 0, NULL, (orb_suggest_request){0}, 23);
    fail_each_suggesting(sample_fan(9), 0, NULL, (orb_suggest_request){0}, 23);
}
