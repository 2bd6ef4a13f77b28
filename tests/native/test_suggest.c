/* orbifold_cones.h: suggested cones and predictions, from C. What the cones are worth is judged in tests/core.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <pthread.h>
#include <stdlib.h>
#include <time.h>

#include "check.h"
#include "distortion.h"
#include "orbifold_cones.h"
#include "surfaces.h"

static orb_suggest_request asking(int32_t n, const char *const *signatures) {
    return (orb_suggest_request){.n_signatures = n, .signatures = signatures};
}

static orb_status suggest(const sample_mesh *mesh, const orb_suggest_request *request, orb_suggestions **suggestions,
                          orb_error *error) {
    orb_mesh_arrays arrays = sample_arrays(mesh);
    return orb_suggest_cones(&arrays, request, suggestions, error);
}

/* A sphere that is longer than wide, and rough. */
static sample_mesh egg(int level) {
    sample_mesh mesh = sample_icosphere(level);
    sample_roughen(&mesh, 0.02, 5);
    for (int32_t v = 0; v < mesh.n_vertices; v++) {
        double *p = mesh.vertices + 3 * v;
        p[0] *= 1 + 0.3 * p[1];
        p[1] *= 2;
    }
    return mesh;
}

/* Marks the vertices on the boundary; free it. */
static bool *border_of(const sample_mesh *mesh) {
    const size_t n = 3 * (size_t)mesh->n_triangles;
    int32_t *edge = sample_allocate(n, sizeof *edge), *sides = sample_allocate(n, sizeof *sides);
    bool *border = sample_allocate((size_t)mesh->n_vertices, sizeof *border);
    sample_edges(mesh, edge, sides);
    for (int32_t h = 0; h < 3 * mesh->n_triangles; h++)
        if (sides[edge[h]] == 1)
            border[mesh->triangles[h]] = border[mesh->triangles[h % 3 == 2 ? h - 2 : h + 1]] = true;
    free(edge), free(sides);
    return border;
}

/* The spread of log area, or, of a suggestion that was measured, what it is ranked by. */
static double measured(const sample_mesh *mesh, const orb_suggestion *made, orb_status *status) {
    orb_mesh_arrays arrays = sample_arrays(mesh);
    orb_request request = orb_request_default();
    request.signature = made->signature;
    request.n_cones = made->n_cones;
    request.cones = made->cones;
    orb_embedding *embedding = NULL;
    orb_error error = {0};
    orb_report report = {0};
    *status = orb_embed(&arrays, &request, &embedding, &error);
    if (*status == ORB_OK)
        orb_embedding_report(embedding, &report);
    const double spread = made->measured && embedding ? distortion_spread(embedding) : report.log_area_std;
    CHECK(*status != ORB_OK || spread >= report.log_area_std * (1 - 1e-9));
    orb_embedding_free(embedding);
    return spread;
}

static double predicted(const sample_mesh *mesh, const orb_suggestion *made) {
    orb_mesh_arrays arrays = sample_arrays(mesh);
    orb_request request = orb_request_default();
    request.signature = made->signature;
    request.n_cones = made->n_cones;
    request.cones = made->cones;
    request.orders = made->orders;
    double spread = -1;
    orb_error error = {0};
    CHECK(orb_predict(&arrays, &request, &spread, NULL, &error) == ORB_OK);
    return spread;
}

static void check_all(const sample_mesh *mesh, const orb_suggestions *suggestions) {
    bool *border = border_of(mesh);
    double last = 0;
    CHECK(orb_suggestions_count(suggestions) > 0);
    for (int32_t k = 0; k < orb_suggestions_count(suggestions); k++) {
        const orb_suggestion made = orb_suggestions_view(suggestions, k);
        orb_signature_info info;
        orb_error error = {0};
        int32_t orders[16];
        CHECK(orb_signature_read(made.signature, &info, orders, 16, &error) == ORB_OK);
        CHECK(made.n_cones == info.n_cones);
        CHECK(made.predicted >= last && made.conformal >= 0 && isfinite(made.predicted) && isfinite(made.conformal));
        last = made.predicted;
        for (int32_t i = 0; i < made.n_cones; i++) {
            const int32_t c = made.cones[i];
            CHECK(c >= 0 && c < mesh->n_vertices && made.orders[i] == orders[i]);
            if (c >= 0 && c < mesh->n_vertices)
                CHECK(border[c] == (i >= info.n_interior));
            for (int32_t j = 0; j < i; j++)
                CHECK(made.cones[j] != c);
        }
        if (!check_failures && made.n_cones > 0)
            CHECK_NEAR(predicted(mesh, &made), made.conformal, 1e-4 * made.conformal + 1e-7);
        if (!made.measured)
            CHECK_NEAR(made.predicted, made.conformal, 1e-9 * made.conformal);
    }
    free(border);
}

/* --- what comes back --------------------------------------------------------------------------------------------- */

static void check_usual(sample_mesh mesh, const char *one_of_them) {
    orb_suggest_request request = {0};
    orb_suggestions *suggestions = NULL;
    orb_error error = {0};
    const orb_status status = suggest(&mesh, &request, &suggestions, &error);
    CHECK(status == ORB_OK);
    if (status == ORB_OK) {
        bool found = false;
        check_all(&mesh, suggestions);
        for (int32_t k = 0; k < orb_suggestions_count(suggestions); k++) {
            const orb_suggestion made = orb_suggestions_view(suggestions, k);
            found = found || strcmp(made.signature, one_of_them) == 0;
            orb_status embedded = ORB_OK;
            const double spread = check_failures ? 0 : measured(&mesh, &made, &embedded);
            CHECK(embedded == ORB_OK);
            if (made.measured && !check_failures)
                CHECK_NEAR(spread, made.predicted, 1e-9 * spread);
        }
        CHECK(found);
    }
    orb_suggestions_free(suggestions);
    sample_free(&mesh);
}

TEST(usual_suggestions_on_a_sphere_are_sound) { check_usual(egg(2), "442"); }
TEST(usual_suggestions_on_a_disk_are_sound) { check_usual(sample_surface(0, 0, 1), "*442"); }
TEST(usual_suggestions_on_a_rectangle_are_sound) { check_usual(sample_rectangle(1, 1.3, 7, 8), "4*2"); }

/* Flat but for the corners, which are the first vertices: nothing is stretched. */
static void check_corners(sample_mesh mesh, const char *signature, int32_t k) {
    orb_suggest_request request = asking(1, &signature);
    orb_suggestions *suggestions = NULL;
    orb_error error = {0};
    CHECK(suggest(&mesh, &request, &suggestions, &error) == ORB_OK);
    if (suggestions) {
        check_all(&mesh, suggestions);
        CHECK(orb_suggestions_count(suggestions) == 1);
        const orb_suggestion made = orb_suggestions_view(suggestions, 0);
        CHECK(made.n_cones == k && made.predicted < 1e-6 && strcmp(made.signature, signature) == 0);
        for (int32_t i = 0; i < made.n_cones; i++)
            CHECK(made.cones[i] < k);
        orb_status status;
        CHECK(measured(&mesh, &made, &status) < 0.1 && status == ORB_OK);
    }
    orb_suggestions_free(suggestions);
    sample_free(&mesh);
}

TEST(corners_of_pillows_are_found) {
    const double degree = acos(-1) / 180;
    check_corners(sample_pillow_triangle(45 * degree, 45 * degree, 5), "442", 3);
    check_corners(sample_pillow_triangle(60 * degree, 60 * degree, 5), "333", 3);
    check_corners(sample_pillow_triangle(30 * degree, 90 * degree, 5), "632", 3);
    check_corners(sample_pillow_rectangle(1, 1.7, 6, 9), "2222", 4);
}
TEST(corners_of_plane_polygons_are_found) {
    const double degree = acos(-1) / 180;
    check_corners(sample_triangle(45 * degree, 90 * degree, 5), "*442", 3);
    check_corners(sample_triangle(60 * degree, 60 * degree, 5), "*333", 3);
    check_corners(sample_triangle(30 * degree, 60 * degree, 5), "*632", 3);
    check_corners(sample_rectangle(1, 1.7, 6, 9), "*2222", 4);
}

TEST(nothing_is_kept_of_the_arguments_and_nothing_is_written_to_them) {
    sample_mesh mesh = egg(2), before = egg(2);
    const int32_t n = mesh.n_vertices;
    int32_t fixed[1] = {20};
    double *away = sample_allocate((size_t)n, sizeof *away);
    away[3] = INFINITY, away[50] = 2;
    char text[] = "(4)42";
    const char *signatures[1] = {text};
    orb_suggest_request request = asking(1, signatures);
    request.n_fixed = 1, request.fixed = fixed, request.keep_away = away;
    orb_suggestions *suggestions = NULL;
    orb_error error = {0};
    REQUIRE(suggest(&mesh, &request, &suggestions, &error) == ORB_OK);
    CHECK(memcmp(mesh.vertices, before.vertices, 3 * (size_t)n * sizeof(double)) == 0);
    CHECK(memcmp(mesh.triangles, before.triangles, 3 * (size_t)mesh.n_triangles * sizeof(int32_t)) == 0);
    CHECK(fixed[0] == 20 && isinf(away[3]) && away[50] == 2 && away[0] == 0 && strcmp(text, "(4)42") == 0);
    sample_free(&mesh), free(away);
    memset(text, 'x', 5);
    check_all(&before, suggestions);
    const orb_suggestion made = orb_suggestions_view(suggestions, 0);
    CHECK(strcmp(made.signature, "(4)42") == 0);
    CHECK(made.cones[0] == 20 || made.cones[1] == 20 || made.cones[2] == 20);
    orb_suggestions_free(suggestions);
    sample_free(&before);
}

TEST(a_number_that_is_none_gives_zeros) {
    sample_mesh mesh = egg(1);
    const char *signature = "442";
    orb_suggest_request request = asking(1, &signature);
    orb_suggestions *suggestions = NULL;
    orb_error error = {0};
    REQUIRE(suggest(&mesh, &request, &suggestions, &error) == ORB_OK);
    CHECK(orb_suggestions_count(suggestions) == 1);
    for (int32_t number = -1; number <= 1; number += 2) {
        const orb_suggestion none = orb_suggestions_view(suggestions, number);
        CHECK(!none.signature && none.n_cones == 0 && !none.cones && !none.orders && none.predicted == 0);
        CHECK(none.conformal == 0 && !none.measured && !none.symmetric);
    }
    const orb_suggestion none = orb_suggestions_view(NULL, 0);
    CHECK(!none.signature && none.n_cones == 0 && !none.cones);
    CHECK(orb_suggestions_count(NULL) == 0);
    double plane[4];
    CHECK(!orb_suggestions_plane(NULL, plane));
    orb_suggestions_free(NULL);
    orb_suggestions_free(suggestions);
    sample_free(&mesh);
}

TEST(the_mirror_plane_is_handed_over) {
    sample_mesh mesh = sample_icosphere(2);
    for (int32_t v = 0; v < mesh.n_vertices; v++) { /* symmetric in x = 3 only */
        double *p = mesh.vertices + 3 * v;
        p[1] *= 1.5 + 0.3 * p[2];
        p[2] += 0.2 * p[1];
        p[0] += 3;
    }
    const char *signature = "442";
    orb_suggest_request request = asking(1, &signature);
    for (int way = 0; way < 3; way++) {
        orb_suggestions *suggestions = NULL;
        orb_error error = {0};
        double plane[4] = {0};
        request.symmetry = way == 0 ? ORB_SYMMETRY_DETECT : way == 1 ? ORB_SYMMETRY_PLANE : ORB_SYMMETRY_IGNORE;
        request.plane[0] = -2, request.plane[3] = -6;
        REQUIRE(suggest(&mesh, &request, &suggestions, &error) == ORB_OK);
        const bool found = orb_suggestions_plane(suggestions, plane);
        CHECK(found == (way < 2) && orb_suggestions_view(suggestions, 0).symmetric == found);
        if (found) {
            CHECK(fabs(plane[0]) > 1e-9);
            CHECK_NEAR(plane[1] / plane[0], 0, 1e-6);
            CHECK_NEAR(plane[2] / plane[0], 0, 1e-6);
            CHECK_NEAR(plane[3] / plane[0], 3, 1e-6);
        }
        CHECK(orb_suggestions_plane(suggestions, NULL) == found);
        orb_suggestions_free(suggestions);
    }
    sample_free(&mesh);
}

TEST(predictions_fill_what_is_asked_for) {
    sample_mesh mesh = egg(2);
    orb_mesh_arrays arrays = sample_arrays(&mesh);
    const int32_t cones[3] = {0, 40, 90};
    orb_request request = orb_request_default();
    request.signature = "432", request.n_cones = 3, request.cones = cones;
    double spread = -1, alone = -1, *scale = sample_allocate((size_t)mesh.n_vertices, sizeof *scale);
    orb_error error = {0};
    CHECK(orb_predict(&arrays, &request, &spread, scale, &error) == ORB_OK);
    CHECK(orb_predict(&arrays, &request, &alone, NULL, &error) == ORB_OK && alone == spread && spread > 0);
    CHECK(orb_predict(&arrays, &request, NULL, scale, NULL) == ORB_OK);
    CHECK(orb_predict(&arrays, &request, NULL, NULL, &error) == ORB_OK);
    double least = 0, most = 0;
    for (int32_t v = 0; v < mesh.n_vertices; v++)
        least = fmin(least, scale[v]), most = fmax(most, scale[v]);
    CHECK(least < 0 && most > 0 && most < 10);
    CHECK(orb_predict(NULL, &request, &spread, scale, &error) == ORB_BAD_ARGUMENT);
    CHECK(orb_predict(&arrays, NULL, &spread, scale, &error) == ORB_BAD_ARGUMENT);
    request.signature = NULL;
    CHECK(orb_predict(&arrays, &request, &spread, scale, &error) != ORB_OK && error.message[0]);
    request.signature = "432", request.cones = NULL;
    CHECK(orb_predict(&arrays, &request, &spread, scale, &error) != ORB_OK && error.message[0]);
    request.cones = cones, request.n_cones = -3;
    CHECK(orb_predict(&arrays, &request, &spread, scale, &error) != ORB_OK && error.message[0]);
    free(scale);
    sample_free(&mesh);
}

/* --- refusals ---------------------------------------------------------------------------------------------------- */

static void check_refused(const orb_mesh_arrays *arrays, const orb_suggest_request *request, orb_status wanted) {
    orb_suggestions *suggestions = (orb_suggestions *)1; /* is overwritten */
    orb_error error = {0};
    const orb_status status = orb_suggest_cones(arrays, request, &suggestions, &error);
    CHECK(status == wanted && error.status == status && suggestions == NULL && error.message[0]);
    if (status != wanted)
        printf("     %s, not %s: %s\n", orb_status_name(status), orb_status_name(wanted), error.message);
    CHECK(orb_suggest_cones(arrays, request, &suggestions, NULL) == status && suggestions == NULL);
}

TEST(missing_arguments_are_refused) {
    sample_mesh mesh = egg(1);
    const orb_mesh_arrays arrays = sample_arrays(&mesh);
    const char *signature = "442", *const none[1] = {NULL};
    orb_suggest_request request = asking(1, &signature);
    orb_error error = {0};
    check_refused(NULL, &request, ORB_BAD_ARGUMENT);
    check_refused(&arrays, NULL, ORB_BAD_ARGUMENT);
    CHECK(orb_suggest_cones(&arrays, &request, NULL, &error) == ORB_BAD_ARGUMENT && error.message[0]);
    request = asking(1, NULL);
    check_refused(&arrays, &request, ORB_BAD_ARGUMENT);
    request = asking(1, none);
    check_refused(&arrays, &request, ORB_BAD_ARGUMENT);
    request = asking(-1, &signature);
    check_refused(&arrays, &request, ORB_BAD_ARGUMENT);
    request = asking(1, &signature);
    request.n_fixed = 1;
    check_refused(&arrays, &request, ORB_BAD_ARGUMENT);
    request.n_fixed = -1;
    check_refused(&arrays, &request, ORB_BAD_ARGUMENT);
    request = asking(1, &signature);
    request.holes = (orb_holes)77;
    check_refused(&arrays, &request, ORB_BAD_ARGUMENT);
    request = asking(1, &signature);
    request.symmetry = (orb_symmetry)77;
    check_refused(&arrays, &request, ORB_BAD_ARGUMENT);
    request.symmetry = ORB_SYMMETRY_PLANE; /* all zeros */
    check_refused(&arrays, &request, ORB_BAD_ARGUMENT);
    request = asking(1, &signature);
    const orb_mesh_arrays holes[] = {{mesh.n_vertices, NULL, mesh.n_triangles, mesh.triangles},
                                     {mesh.n_vertices, mesh.vertices, mesh.n_triangles, NULL},
                                     {-1, mesh.vertices, mesh.n_triangles, mesh.triangles},
                                     {mesh.n_vertices, mesh.vertices, -1, mesh.triangles},
                                     {0, mesh.vertices, 0, mesh.triangles}};
    for (size_t k = 0; k < sizeof holes / sizeof *holes; k++)
        check_refused(&holes[k], &request, ORB_BAD_ARGUMENT);
    sample_free(&mesh);
}

TEST(bad_requests_are_refused) {
    sample_mesh mesh = egg(1), open = egg(1), torus = sample_torus(6, 5, 2, 1);
    open.n_triangles--;
    const orb_mesh_arrays arrays = sample_arrays(&mesh), hole = sample_arrays(&open), ring = sample_arrays(&torus);
    const char *const good[2] = {"442", "432"}, *const bad[2] = {"442", "4-2"}, *const many[1] = {"22222222"};
    orb_suggest_request request = asking(2, bad);
    check_refused(&arrays, &request, ORB_BAD_SIGNATURE);
    request = asking(2, good);
    check_refused(&hole, &request, ORB_BOUNDARY);
    check_refused(&ring, &request, ORB_WRONG_GENUS);
    const int32_t fixed[4] = {0, 5, 7, 9}, twice[2] = {3, 3}, beyond[1] = {mesh.n_vertices};
    request.n_fixed = 4, request.fixed = fixed;
    check_refused(&arrays, &request, ORB_CONE_COUNT);
    request.n_fixed = 2, request.fixed = twice;
    check_refused(&arrays, &request, ORB_BAD_CONE);
    request.n_fixed = 1, request.fixed = beyond;
    check_refused(&arrays, &request, ORB_BAD_CONE);
    request = asking(2, good);
    double *away = sample_allocate((size_t)mesh.n_vertices, sizeof *away);
    request.keep_away = away;
    away[4] = -1;
    check_refused(&arrays, &request, ORB_BAD_WEIGHT);
    away[4] = NAN;
    check_refused(&arrays, &request, ORB_BAD_WEIGHT);
    sample_mesh small = sample_tetrahedron();
    const orb_mesh_arrays four = sample_arrays(&small);
    request = asking(1, many);
    check_refused(&four, &request, ORB_CONE_COUNT);
    free(away);
    sample_free(&small), sample_free(&torus), sample_free(&open), sample_free(&mesh);
}

/* --- progress, jobs, threads ------------------------------------------------------------------------------------- */

typedef struct asked {
    int calls, allowed;
    double last;
    bool fell;
} asked;

static bool count_calls(const char *stage, double fraction, void *user) {
    asked *a = user;
    a->fell = a->fell || fraction < a->last || fraction < 0 || fraction > 1 || !stage;
    a->last = fraction;
    return a->calls++ < a->allowed;
}

TEST(cancelled_at_every_call_of_progress) {
    sample_mesh mesh = egg(2);
    const char *const signatures[] = {"442", "22222", "432"};
    orb_suggest_request request = asking(3, signatures);
    int calls = 1;
    for (int allowed = 0; allowed <= calls; allowed++) {
        asked a = {.allowed = allowed < calls ? allowed : 1 << 30};
        request.progress = count_calls, request.user = &a;
        orb_suggestions *suggestions = NULL;
        orb_error error = {0};
        const orb_status status = suggest(&mesh, &request, &suggestions, &error);
        CHECK(!a.fell);
        if (allowed < a.calls) {
            CHECK(status == ORB_CANCELLED && !suggestions && error.status == ORB_CANCELLED);
            CHECK(a.calls == allowed + 1);
        } else {
            CHECK(status == ORB_OK);
        }
        orb_suggestions_free(suggestions);
        if (check_failures)
            break;
        if (allowed == 0) { /* how many there are */
            asked all = {.allowed = 1 << 30};
            request.user = &all;
            CHECK(suggest(&mesh, &request, &suggestions, &error) == ORB_OK);
            orb_suggestions_free(suggestions);
            calls = all.calls;
            CHECK(calls > 3);
        }
    }
    sample_free(&mesh);
}

static bool same(const orb_suggestions *a, const orb_suggestions *b) {
    if (orb_suggestions_count(a) != orb_suggestions_count(b))
        return false;
    for (int32_t k = 0; k < orb_suggestions_count(a); k++) {
        const orb_suggestion p = orb_suggestions_view(a, k), q = orb_suggestions_view(b, k);
        const size_t n = (size_t)p.n_cones * sizeof *p.cones;
        if (strcmp(p.signature, q.signature) != 0 || p.n_cones != q.n_cones || p.predicted != q.predicted ||
            p.conformal != q.conformal || p.measured != q.measured || p.symmetric != q.symmetric ||
            (n && (memcmp(p.cones, q.cones, n) != 0 || memcmp(p.orders, q.orders, n) != 0)))
            return false;
    }
    return true;
}

TEST(a_job_copies_what_it_is_given_and_gives_what_the_call_gives) {
    sample_mesh mesh = egg(2), theirs = egg(2);
    char text[2][8] = {"442", "2222"};
    const char *signatures[2] = {text[0], text[1]};
    int32_t fixed[1] = {20};
    double *away = sample_allocate((size_t)mesh.n_vertices, sizeof *away);
    away[20] = 1, away[40] = INFINITY;
    orb_suggest_request request = asking(2, signatures);
    request.n_fixed = 1, request.fixed = fixed, request.keep_away = away;
    orb_suggestions *called = NULL, *finished = NULL;
    orb_error error = {0};
    REQUIRE(suggest(&mesh, &request, &called, &error) == ORB_OK);
    orb_mesh_arrays arrays = sample_arrays(&theirs);
    orb_job *job = NULL;
    REQUIRE(orb_job_start_suggest(&arrays, &request, &job, &error) == ORB_OK);
    memset(theirs.vertices, 0, 3 * (size_t)theirs.n_vertices * sizeof(double));
    memset(theirs.triangles, 0, 3 * (size_t)theirs.n_triangles * sizeof(int32_t));
    memset(text, 0, sizeof text), memset(away, 0, (size_t)mesh.n_vertices * sizeof *away);
    signatures[0] = signatures[1] = NULL, fixed[0] = -1;
    while (!orb_job_poll(job, NULL, NULL))
        nanosleep(&(struct timespec){0, 1000000}, NULL);
    CHECK(orb_job_finish_suggest(job, &finished, &error) == ORB_OK);
    CHECK(same(called, finished));
    orb_suggestions_free(called), orb_suggestions_free(finished);
    free(away);
    sample_free(&theirs), sample_free(&mesh);
}

TEST(jobs_end_in_every_way) {
    sample_mesh mesh = egg(3), open = egg(1);
    open.n_triangles--;
    orb_mesh_arrays arrays = sample_arrays(&mesh), hole = sample_arrays(&open);
    const char *signature = "442";
    orb_suggest_request request = {0}, one = asking(1, &signature);
    orb_error error = {0};
    orb_job *job = NULL;
    orb_suggestions *suggestions = NULL;
    for (int i = 0; i < 6; i++) { /* cancelled early and late */
        REQUIRE(orb_job_start_suggest(&arrays, &request, &job, &error) == ORB_OK);
        nanosleep(&(struct timespec){0, 3000000L * i * i}, NULL);
        orb_job_cancel(job);
        CHECK(orb_job_poll(job, NULL, NULL));
        CHECK(orb_job_finish_suggest(job, &suggestions, &error) == ORB_CANCELLED && !suggestions);
    }
    REQUIRE(orb_job_start_suggest(&hole, &one, &job, &error) == ORB_OK);
    CHECK(orb_job_finish_suggest(job, &suggestions, &error) == ORB_BOUNDARY && error.n_elements > 0 && !suggestions);
    REQUIRE(orb_job_start_suggest(&arrays, &one, &job, NULL) == ORB_OK); /* nobody wants the result */
    CHECK(orb_job_finish_suggest(job, NULL, NULL) == ORB_OK);
    REQUIRE(orb_job_start_suggest(&arrays, &one, &job, NULL) == ORB_OK); /* the wrong kind of end: no embedding */
    orb_embedding *embedding = (orb_embedding *)1;
    orb_job_finish(job, &embedding, &error);
    CHECK(embedding == NULL);
    CHECK(orb_job_start_suggest(NULL, &one, &job, &error) == ORB_BAD_ARGUMENT && !job);
    CHECK(orb_job_start_suggest(&arrays, NULL, &job, &error) == ORB_BAD_ARGUMENT && !job);
    CHECK(orb_job_start_suggest(&arrays, &one, NULL, &error) == ORB_BAD_ARGUMENT);
    CHECK(orb_job_finish_suggest(NULL, &suggestions, &error) == ORB_BAD_ARGUMENT);
    sample_free(&open), sample_free(&mesh);
}

enum { THREADS = 4 };

typedef struct worker {
    const sample_mesh *mesh;
    orb_suggestions *suggestions;
    orb_status status;
} worker;

static void *work(void *user) {
    worker *w = user;
    orb_suggest_request request = {0};
    orb_error error = {0};
    w->status = suggest(w->mesh, &request, &w->suggestions, &error);
    return NULL;
}

TEST(threads_give_what_one_alone_gives) {
    sample_mesh mesh = egg(2);
    worker alone = {.mesh = &mesh}, workers[THREADS];
    pthread_t threads[THREADS];
    work(&alone);
    CHECK(alone.status == ORB_OK);
    for (int i = 0; i < THREADS; i++) {
        workers[i] = (worker){.mesh = &mesh};
        REQUIRE(pthread_create(&threads[i], NULL, work, &workers[i]) == 0);
    }
    for (int i = 0; i < THREADS; i++)
        pthread_join(threads[i], NULL);
    for (int i = 0; i < THREADS; i++) {
        CHECK(workers[i].status == ORB_OK && same(alone.suggestions, workers[i].suggestions));
        orb_suggestions_free(workers[i].suggestions);
    }
    orb_suggestions_free(alone.suggestions);
    sample_free(&mesh);
}
