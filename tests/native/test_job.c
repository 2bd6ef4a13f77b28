/* job.c on its own: it is compiled into this file with stand-ins for orb_embed, orb_suggest_cones and orb_predict that
 * stop where a test wants them to, so that every order of events between the two threads can be had. The real pipeline
 * as a job is tested in tests/core/test_job.py. SPDX-License-Identifier: GPL-3.0-or-later */
#define orb_embed fake_embed
#define orb_embedding_free fake_embedding_free
#define orb_suggest_cones fake_suggest_cones
#define orb_suggestions_free fake_suggestions_free
#define orb_predict fake_predict
#define orb_job_start tested_job_start
#define orb_job_start_suggest tested_job_start_suggest
#define orb_job_finish_suggest tested_job_finish_suggest
#define orb_job_start_predict tested_job_start_predict
#define orb_job_finish_predict tested_job_finish_predict
#define orb_job_poll tested_job_poll
#define orb_job_cancel tested_job_cancel
#define orb_job_finish tested_job_finish

#include <stdlib.h>

static int allocations_left = -1; /* before the next one fails; -1: none does */

static void *counted_malloc(size_t size) {
    return allocations_left == 0 ? NULL : (allocations_left -= allocations_left > 0, malloc(size));
}

static void *counted_calloc(size_t count, size_t size) {
    return allocations_left == 0 ? NULL : (allocations_left -= allocations_left > 0, calloc(count, size));
}

#define malloc counted_malloc
#define calloc counted_calloc
#include "../../native/src/job.c"
#undef malloc
#undef calloc

#include "check.h"

#include <semaphore.h>
#include <stdatomic.h>

struct orb_embedding {
    double first_vertex, last_weight;
    int32_t last_index, last_cone, last_order;
    char signature[16];
    bool signals_blocked, faults_open;
};

/* The stand-in and the test meet here. */
static struct {
    sem_t inside, leave; /* posted when the stand-in has begun; awaited before it ends */
    bool waits, fails;
    const char *stage;
    double fraction, second_fraction;
    sem_t over; /* posted when the stand-in is about to return */
    orb_status given;
} fake;
static atomic_int freed; /* embeddings and suggestions; apart from the above: a detached thread may free one late */

static void fake_reset(void) {
    memset(&fake, 0, sizeof fake);
    sem_init(&fake.inside, 0, 0);
    sem_init(&fake.leave, 0, 0);
    sem_init(&fake.over, 0, 0);
    fake.stage = "solve";
    fake.fraction = 0.25;
    fake.second_fraction = 0.5;
}

static bool is_blocked(int signal_number) {
    sigset_t now;
    sigemptyset(&now);
    pthread_sigmask(SIG_SETMASK, NULL, &now);
    return sigismember(&now, signal_number) == 1;
}

orb_status fake_embed(const orb_mesh_arrays *mesh, const orb_request *request, orb_embedding **embedding,
                      orb_error *error) {
    bool go_on = request->progress(fake.stage, fake.fraction, request->user);
    sem_post(&fake.inside);
    if (fake.waits)
        while (sem_wait(&fake.leave))
            ;
    go_on = request->progress(fake.stage, fake.second_fraction, request->user) && go_on;
    orb_embedding *made = calloc(1, sizeof *made);
    if (!made) {
        fake.given = error_memory(error);
    } else if (fake.fails) {
        free(made);
        made = NULL;
        int32_t edge[2] = {3, 4};
        fake.given = error_set_elements(error, ORB_BOUNDARY, ORB_EDGE, edge, 2, 1, "an edge");
    } else if (!go_on) {
        free(made);
        made = NULL;
        fake.given = error_set(error, ORB_CANCELLED, "cancelled");
    } else {
        made->first_vertex = mesh->vertices[0];
        made->last_index = mesh->triangles[3 * mesh->n_triangles - 1];
        made->last_cone = request->cones[request->n_cones - 1];
        made->last_order = request->orders ? request->orders[request->n_cones - 1] : -1;
        made->last_weight = request->edge_weights ? request->edge_weights[3 * request->n_edge_weights - 1] : -1;
        memcpy(made->signature, request->signature, strlen(request->signature) + 1);
        made->signals_blocked = is_blocked(SIGINT) && is_blocked(SIGALRM) && is_blocked(SIGTERM);
        made->faults_open = !is_blocked(SIGSEGV) && !is_blocked(SIGFPE);
        fake.given = ORB_OK;
    }
    *embedding = made;
    orb_status given = fake.given;
    sem_post(&fake.over);
    return given;
}

void fake_embedding_free(orb_embedding *embedding) {
    if (embedding)
        freed++;
    free(embedding);
}

struct orb_suggestions {
    double first_vertex, last_away, plane;
    int32_t last_fixed, n_signatures;
    char signatures[2][16];
};

orb_status fake_suggest_cones(const orb_mesh_arrays *mesh, const orb_suggest_request *request,
                              orb_suggestions **suggestions, orb_error *error) {
    bool go_on = request->progress(fake.stage, fake.fraction, request->user);
    sem_post(&fake.inside);
    if (fake.waits)
        while (sem_wait(&fake.leave))
            ;
    go_on = request->progress(fake.stage, fake.second_fraction, request->user) && go_on;
    orb_suggestions *made = NULL;
    if (fake.fails) {
        fake.given = error_set(error, ORB_CONE_COUNT, "too few");
    } else if (!go_on) {
        fake.given = error_set(error, ORB_CANCELLED, "cancelled");
    } else if (!(made = calloc(1, sizeof *made))) {
        fake.given = error_memory(error);
    } else {
        made->first_vertex = mesh->vertices[0];
        made->last_away = request->keep_away ? request->keep_away[mesh->n_vertices - 1] : -1;
        made->last_fixed = request->n_fixed > 0 ? request->fixed[request->n_fixed - 1] : -1;
        made->plane = request->plane[3];
        made->n_signatures = request->n_signatures;
        for (int32_t k = 0; k < request->n_signatures && k < 2; k++)
            memcpy(made->signatures[k], request->signatures[k], strlen(request->signatures[k]) + 1);
        fake.given = ORB_OK;
    }
    *suggestions = made;
    orb_status given = fake.given;
    sem_post(&fake.over);
    return given;
}

void fake_suggestions_free(orb_suggestions *suggestions) {
    if (suggestions)
        freed++;
    free(suggestions);
}

orb_status fake_predict(const orb_mesh_arrays *mesh, const orb_request *request, double *spread, double *scale,
                        orb_error *error) {
    bool go_on = request->progress(fake.stage, fake.fraction, request->user);
    sem_post(&fake.inside);
    if (fake.waits)
        while (sem_wait(&fake.leave))
            ;
    go_on = request->progress(fake.stage, fake.second_fraction, request->user) && go_on;
    *spread = request->cones[request->n_cones - 1];
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        scale[v] = mesh->vertices[3 * v];
    fake.given = !go_on       ? error_set(error, ORB_CANCELLED, "cancelled")
                 : fake.fails ? error_set(error, ORB_CONE_COUNT, "too few")
                              : ORB_OK;
    orb_status given = fake.given;
    sem_post(&fake.over);
    return given;
}

static const double vertices[9] = {7, 0, 0, 1, 0, 0, 0, 1, 0};
static const int32_t triangles[3] = {0, 1, 2}, cones[3] = {5, 6, 9}, orders[3] = {4, 4, 2};
static const double weights[6] = {0, 1, 1, 1, 2, 8};

static orb_status start(orb_job **job, orb_error *error) {
    orb_mesh_arrays mesh = {3, vertices, 1, triangles};
    orb_request request = {.signature = "442",
                           .n_cones = 3,
                           .cones = cones,
                           .orders = orders,
                           .clamp = 0.01,
                           .n_edge_weights = 2,
                           .edge_weights = weights,
                           .weights = ORB_WEIGHTS_GIVEN};
    return orb_job_start(&mesh, &request, job, error);
}

TEST(job_copies_what_it_is_given_and_hands_over_the_embedding) {
    fake_reset();
    fake.waits = true;
    double mutable_vertices[9];
    int32_t mutable_triangles[3], mutable_cones[3], mutable_orders[3];
    double mutable_weights[6];
    char signature[] = "442";
    memcpy(mutable_vertices, vertices, sizeof vertices);
    memcpy(mutable_triangles, triangles, sizeof triangles);
    memcpy(mutable_cones, cones, sizeof cones);
    memcpy(mutable_orders, orders, sizeof orders);
    memcpy(mutable_weights, weights, sizeof weights);
    orb_mesh_arrays mesh = {3, mutable_vertices, 1, mutable_triangles};
    orb_request request = {.signature = signature,
                           .n_cones = 3,
                           .cones = mutable_cones,
                           .orders = mutable_orders,
                           .n_edge_weights = 2,
                           .edge_weights = mutable_weights};
    orb_job *job = NULL;
    orb_error error = {0};
    REQUIRE(orb_job_start(&mesh, &request, &job, &error) == ORB_OK);
    memset(mutable_vertices, 0, sizeof mutable_vertices);
    memset(mutable_triangles, 0, sizeof mutable_triangles);
    memset(mutable_cones, 0, sizeof mutable_cones);
    memset(mutable_orders, 0, sizeof mutable_orders);
    memset(mutable_weights, 0, sizeof mutable_weights);
    memset(signature, 0, sizeof signature);
    sem_post(&fake.leave);
    orb_embedding *embedding = NULL;
    REQUIRE(orb_job_finish(job, &embedding, &error) == ORB_OK);
    REQUIRE(embedding != NULL);
    CHECK(embedding->first_vertex == 7 && embedding->last_index == 2 && embedding->last_cone == 9);
    CHECK(embedding->last_order == 2 && embedding->last_weight == 8);
    CHECK(strcmp(embedding->signature, "442") == 0);
    CHECK(embedding->signals_blocked && embedding->faults_open);
    CHECK(!is_blocked(SIGINT) && !is_blocked(SIGALRM));
    orb_embedding_free(embedding);
}

TEST(job_reports_stage_and_a_fraction_that_never_falls) {
    fake_reset();
    fake.waits = true;
    fake.stage = "a stage with a name of more than thirty-one letters";
    fake.second_fraction = 0.125;
    orb_job *job = NULL;
    orb_error error = {0};
    REQUIRE(start(&job, &error) == ORB_OK);
    sem_wait(&fake.inside);
    char stage[JOB_STAGE_LENGTH];
    double fraction = -1;
    CHECK(!orb_job_poll(job, stage, &fraction));
    CHECK(strcmp(stage, "a stage with a name of more tha") == 0);
    CHECK(fraction == 0.25);
    sem_post(&fake.leave);
    while (!orb_job_poll(job, NULL, NULL))
        ;
    CHECK(orb_job_poll(job, NULL, &fraction) && fraction == 0.25);
    orb_embedding *embedding = NULL;
    CHECK(orb_job_finish(job, &embedding, &error) == ORB_OK);
    orb_embedding_free(embedding);
}

TEST(job_hands_over_the_error) {
    fake_reset();
    fake.fails = true;
    orb_job *job = NULL;
    orb_error error = {0};
    orb_embedding *embedding = NULL;
    REQUIRE(start(&job, &error) == ORB_OK);
    CHECK(orb_job_finish(job, &embedding, &error) == ORB_BOUNDARY);
    CHECK(embedding == NULL && error.status == ORB_BOUNDARY && error.elements[0] == 3 && error.n_elements == 2);
    REQUIRE(start(&job, NULL) == ORB_OK);
    CHECK(orb_job_finish(job, NULL, NULL) == ORB_BOUNDARY);
}

TEST(job_cancelled_within_a_long_factorisation_is_finished_at_once) {
    fake_reset();
    fake.waits = true;
    orb_job *job = NULL;
    orb_error error = {0};
    orb_embedding *embedding = NULL;
    REQUIRE(start(&job, &error) == ORB_OK);
    sem_wait(&fake.inside);
    orb_job_cancel(job);
    CHECK(orb_job_poll(job, NULL, NULL));
    CHECK(orb_job_finish(job, &embedding, &error) == ORB_CANCELLED); /* the other thread still waits */
    CHECK(embedding == NULL && error.status == ORB_CANCELLED);
    /* The thread lives on, with copies of its own, and hears of it when it asks. */
    sem_post(&fake.leave);
    sem_wait(&fake.over);
    CHECK(fake.given == ORB_CANCELLED);
}

TEST(job_cancelled_after_it_was_done_frees_the_embedding) {
    fake_reset();
    int before = freed;
    orb_job *job = NULL;
    orb_error error = {0};
    orb_embedding *embedding = NULL;
    REQUIRE(start(&job, &error) == ORB_OK);
    while (!orb_job_poll(job, NULL, NULL))
        ;
    orb_job_cancel(job);
    CHECK(orb_job_finish(job, &embedding, &error) == ORB_CANCELLED);
    CHECK(embedding == NULL);
    CHECK(freed == before + 1);
}

static void *cancel_soon(void *job) {
    struct timespec while_finish_waits = {0, 20 * 1000 * 1000};
    nanosleep(&while_finish_waits, NULL);
    orb_job_cancel(job);
    return NULL;
}

TEST(job_cancelled_from_another_thread_wakes_the_one_that_waits) {
    fake_reset();
    fake.waits = true;
    orb_job *job = NULL;
    orb_error error = {0};
    orb_embedding *embedding = NULL;
    pthread_t other;
    REQUIRE(start(&job, &error) == ORB_OK);
    sem_wait(&fake.inside);
    REQUIRE(pthread_create(&other, NULL, cancel_soon, job) == 0);
    CHECK(orb_job_finish(job, &embedding, &error) == ORB_CANCELLED);
    pthread_join(other, NULL);
    sem_post(&fake.leave);
    sem_wait(&fake.over);
}

TEST(job_survives_every_race_between_cancel_and_the_end) {
    for (int round = 0; round < 300; round++) {
        fake_reset();
        orb_job *job = NULL;
        orb_error error = {0};
        orb_embedding *embedding = NULL;
        REQUIRE(start(&job, &error) == ORB_OK);
        for (volatile int spin = 0; spin < round * 200; spin++)
            ;
        orb_job_cancel(job);
        CHECK(orb_job_finish(job, &embedding, &error) == ORB_CANCELLED && embedding == NULL);
        sem_wait(&fake.over);
    }
}

TEST(job_survives_failed_allocations) {
    fake_reset();
    int failures = 0;
    for (int allowed = 0;; allowed++) {
        orb_job *job = NULL;
        orb_error error = {0};
        allocations_left = allowed;
        orb_status status = start(&job, &error);
        allocations_left = -1;
        if (status == ORB_OK) {
            orb_embedding *embedding = NULL;
            CHECK(orb_job_finish(job, &embedding, &error) == ORB_OK);
            orb_embedding_free(embedding);
            break;
        }
        CHECK(status == ORB_OUT_OF_MEMORY && error.status == ORB_OUT_OF_MEMORY && job == NULL);
        failures++;
    }
    CHECK(failures == 7); /* the job and its six arrays */
}

TEST(job_without_arguments_is_refused) {
    orb_job *job = NULL;
    orb_error error = {0};
    orb_mesh_arrays mesh = {3, vertices, 1, triangles};
    orb_request request = {0};
    CHECK(orb_job_start(NULL, &request, &job, &error) == ORB_BAD_ARGUMENT);
    CHECK(orb_job_start(&mesh, NULL, &job, &error) == ORB_BAD_ARGUMENT && error.status == ORB_BAD_ARGUMENT);
    CHECK(orb_job_start(&mesh, &request, NULL, &error) == ORB_BAD_ARGUMENT);
    CHECK(orb_job_poll(NULL, NULL, NULL));
    orb_job_cancel(NULL);
    CHECK(orb_job_finish(NULL, NULL, &error) == ORB_BAD_ARGUMENT);
}

/* --- suggestions ------------------------------------------------------------------------------------------------- */

static orb_status start_suggest(char (*text)[8], const char **signatures, int32_t *fixed, double *away, orb_job **job,
                                orb_error *error) {
    strcpy(text[0], "442"), strcpy(text[1], "22(12)");
    signatures[0] = text[0], signatures[1] = text[1];
    fixed[0] = 1, fixed[1] = 2;
    away[0] = 0, away[1] = 1, away[2] = 5;
    orb_mesh_arrays mesh = {3, vertices, 1, triangles};
    orb_suggest_request request = {.n_signatures = 2,
                                   .signatures = signatures,
                                   .n_fixed = 2,
                                   .fixed = fixed,
                                   .keep_away = away,
                                   .plane = {0, 0, 1, 4}};
    return orb_job_start_suggest(&mesh, &request, job, error);
}

TEST(job_copies_what_suggestions_need) {
    fake_reset();
    fake.waits = true;
    char text[2][8];
    const char *signatures[2];
    int32_t fixed[2];
    double away[3];
    orb_job *job = NULL;
    orb_error error = {0};
    orb_suggestions *made = NULL;
    REQUIRE(start_suggest(text, signatures, fixed, away, &job, &error) == ORB_OK);
    memset(text, 0, sizeof text), memset(signatures, 0, sizeof signatures);
    memset(fixed, 0, sizeof fixed), memset(away, 0, sizeof away);
    sem_post(&fake.leave);
    REQUIRE(orb_job_finish_suggest(job, &made, &error) == ORB_OK && made);
    CHECK(made->first_vertex == 7 && made->last_away == 5 && made->last_fixed == 2 && made->plane == 4);
    CHECK(made->n_signatures == 2 && !strcmp(made->signatures[0], "442") && !strcmp(made->signatures[1], "22(12)"));
    fake_suggestions_free(made);
}

TEST(job_of_suggestions_is_cancelled_and_cleaned_up) {
    char text[2][8];
    const char *signatures[2];
    int32_t fixed[2];
    double away[3];
    orb_job *job = NULL;
    orb_error error = {0};
    orb_suggestions *made = NULL;
    fake_reset();
    fake.waits = true; /* within a long search */
    REQUIRE(start_suggest(text, signatures, fixed, away, &job, &error) == ORB_OK);
    sem_wait(&fake.inside);
    orb_job_cancel(job);
    CHECK(orb_job_finish_suggest(job, &made, &error) == ORB_CANCELLED && !made); /* the other thread still waits */
    sem_post(&fake.leave);
    sem_wait(&fake.over);
    CHECK(fake.given == ORB_CANCELLED);
    fake_reset(); /* after it was done, and when nobody takes what there is */
    for (int cancels = 1; cancels >= 0; cancels--) {
        int freed_before = freed;
        REQUIRE(start_suggest(text, signatures, fixed, away, &job, &error) == ORB_OK);
        while (!orb_job_poll(job, NULL, NULL))
            ;
        if (cancels)
            orb_job_cancel(job);
        CHECK(orb_job_finish_suggest(job, NULL, &error) == (cancels ? ORB_CANCELLED : ORB_OK));
        CHECK(freed == freed_before + 1);
    }
    fake_reset();
    fake.fails = true;
    REQUIRE(start_suggest(text, signatures, fixed, away, &job, &error) == ORB_OK);
    CHECK(orb_job_finish_suggest(job, &made, &error) == ORB_CONE_COUNT && !made && !strcmp(error.message, "too few"));
}

TEST(job_of_suggestions_survives_failed_allocations) {
    fake_reset();
    int failures = 0;
    for (int allowed = 0; allowed < 100; allowed++) {
        char text[2][8];
        const char *signatures[2];
        int32_t fixed[2];
        double away[3];
        orb_job *job = NULL;
        orb_error error = {0};
        allocations_left = allowed;
        orb_status status = start_suggest(text, signatures, fixed, away, &job, &error);
        allocations_left = -1;
        if (status == ORB_OK) {
            orb_suggestions *made = NULL;
            CHECK(orb_job_finish_suggest(job, &made, &error) == ORB_OK && made);
            fake_suggestions_free(made);
            break;
        }
        CHECK(status == ORB_OUT_OF_MEMORY && error.status == ORB_OUT_OF_MEMORY && job == NULL);
        failures++;
    }
    CHECK(failures == 7); /* the job, two arrays of the mesh, fixed, keep_away, the list of signatures, their texts */
}

/* --- predictions, and jobs of one kind that are finished as another --------------------------------------------- */

static orb_status start_predict(orb_job **job, orb_error *error) {
    orb_mesh_arrays mesh = {3, vertices, 1, triangles};
    orb_request request = {.signature = "442", .n_cones = 3, .cones = cones};
    return orb_job_start_predict(&mesh, &request, job, error);
}

TEST(job_of_a_prediction) {
    double spread = 0, scale[3] = {0};
    orb_job *job = NULL;
    orb_error error = {0};
    fake_reset();
    REQUIRE(start_predict(&job, &error) == ORB_OK);
    CHECK(orb_job_finish_predict(job, &spread, scale, &error) == ORB_OK);
    CHECK(spread == 9 && scale[0] == 7 && scale[1] == 1 && scale[2] == 0);
    fake_reset();
    fake.fails = true;
    REQUIRE(start_predict(&job, &error) == ORB_OK);
    CHECK(orb_job_finish_predict(job, NULL, NULL, &error) == ORB_CONE_COUNT && !strcmp(error.message, "too few"));
    fake_reset();
    fake.waits = true;
    REQUIRE(start_predict(&job, &error) == ORB_OK);
    sem_wait(&fake.inside);
    orb_job_cancel(job);
    spread = 5;
    CHECK(orb_job_finish_predict(job, &spread, scale, &error) == ORB_CANCELLED && spread == 5);
    sem_post(&fake.leave);
    sem_wait(&fake.over);
    CHECK(fake.given == ORB_CANCELLED);
}

TEST(job_of_a_prediction_survives_failed_allocations) {
    fake_reset();
    int failures = 0;
    for (int allowed = 0; allowed < 100; allowed++) {
        orb_job *job = NULL;
        orb_error error = {0};
        allocations_left = allowed;
        orb_status status = start_predict(&job, &error);
        allocations_left = -1;
        if (status == ORB_OK) {
            CHECK(orb_job_finish_predict(job, NULL, NULL, &error) == ORB_OK);
            break;
        }
        CHECK(status == ORB_OUT_OF_MEMORY && error.status == ORB_OUT_OF_MEMORY && job == NULL);
        failures++;
    }
    CHECK(failures == 6); /* the job, two arrays of the mesh, the signature, the cones, room for the scale */
}

TEST(job_finished_as_another_kind_says_which_it_is) {
    orb_job *job = NULL;
    orb_error error = {0};
    double spread = 0;
    orb_embedding *embedding = NULL;
    int before = freed;
    fake_reset();
    REQUIRE(start(&job, &error) == ORB_OK);
    CHECK(orb_job_finish_predict(job, &spread, NULL, &error) == ORB_BAD_ARGUMENT);
    CHECK(strstr(error.message, "orb_job_finish") && freed == before + 1);
    REQUIRE(start_predict(&job, &error) == ORB_OK);
    CHECK(orb_job_finish(job, &embedding, &error) == ORB_BAD_ARGUMENT && !embedding);
    CHECK(strstr(error.message, "orb_job_finish_predict"));
}
