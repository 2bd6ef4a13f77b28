/* orb_embed, orb_suggest_cones and orb_predict on a thread of the library's own. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The job owns copies of everything that the computation reads, and is shared by two holders: the caller (from
 * orb_job_start to orb_job_finish) and the thread. Whoever lets go last frees it. So a cancelled job costs the caller
 * nothing: orb_job_finish detaches the thread and returns, and the thread frees the rest when it next asks for leave
 * to go on, which inside a long factorisation may take seconds. */
#include "error.h"
#include "orbifold_cones.h"
#include "prepared.h"

#include <pthread.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>

/* Ample for the recursions of the orderings; only pages that are touched take memory. */
enum { JOB_STACK_BYTES = 16 * 1024 * 1024, JOB_STAGE_LENGTH = 32, MOST_COPIES = 8 };

typedef enum job_kind { JOB_EMBEDS, JOB_SUGGESTS, JOB_PREDICTS } job_kind;

struct orb_job {
    pthread_t thread;
    /* Read by the thread only, after the start. */
    orb_mesh_arrays mesh;
    orb_prepared *prepared; /* instead of the mesh, or NULL */
    job_kind kind;
    orb_request request;         /* of embeddings and predictions */
    orb_suggest_request suggest; /* of suggestions */
    orb_polygon polygon;
    int32_t n_copies;
    void *copies[MOST_COPIES]; /* of all that the mesh and the request point to */
    /* Under the mutex. */
    pthread_mutex_t mutex;
    pthread_cond_t changed; /* done or cancelled has become true */
    int holders;
    bool done, cancelled;
    char stage[JOB_STAGE_LENGTH];
    double fraction;
    orb_status status;
    orb_embedding *embedding;
    orb_suggestions *suggestions;
    double spread, *scale; /* [mesh.n_vertices] one of the copies */
    orb_error error;
};

/* A copy of the first `count` elements, which the job frees. NULL where there are none (whether that is an error, the
 * computation says) and, with *fine false, when memory runs out. */
static void *job_copy(orb_job *job, const void *source, int64_t count, size_t size, bool *fine) {
    if (!source || count <= 0 || !*fine)
        return NULL;
    void *copy = (uint64_t)count > SIZE_MAX / size ? NULL : malloc((size_t)count * size);
    *fine = copy != NULL;
    if (!copy)
        return NULL;
    memcpy(copy, source, (size_t)count * size);
    job->copies[job->n_copies++] = copy;
    return copy;
}

static void job_free(orb_job *job) {
    if (!job)
        return;
    orb_prepared_free(job->prepared);
    orb_embedding_free(job->embedding);
    orb_suggestions_free(job->suggestions);
    for (int32_t k = 0; k < job->n_copies; k++)
        free(job->copies[k]);
    free(job);
}

/* Called with the mutex held; gives it up. The last holder frees the job. */
static void job_release(orb_job *job) {
    bool last = --job->holders == 0;
    pthread_mutex_unlock(&job->mutex);
    if (!last)
        return;
    pthread_cond_destroy(&job->changed);
    pthread_mutex_destroy(&job->mutex);
    job_free(job);
}

static bool job_progress(const char *stage, double fraction, void *user) {
    orb_job *job = user;
    pthread_mutex_lock(&job->mutex);
    size_t length = 0;
    for (; stage && stage[length] && length < JOB_STAGE_LENGTH - 1; length++)
        job->stage[length] = stage[length];
    job->stage[length] = '\0';
    if (fraction > job->fraction)
        job->fraction = fraction;
    bool go_on = !job->cancelled;
    pthread_mutex_unlock(&job->mutex);
    return go_on;
}

static void *job_run(void *user) {
    orb_job *job = user;
    orb_embedding *embedding = NULL;
    orb_suggestions *suggestions = NULL;
    orb_error error = {0};
    double spread = 0;
    orb_status status = ORB_OK;
    switch (job->kind) {
    case JOB_EMBEDS:
        status = orb_embed(&job->mesh, &job->request, &embedding, &error);
        break;
    case JOB_SUGGESTS:
        status = orb_suggest_cones(&job->mesh, &job->suggest, &suggestions, &error);
        break;
    case JOB_PREDICTS:
        status = orb_predict(&job->mesh, &job->request, &spread, job->scale, &error);
    }

    pthread_mutex_lock(&job->mutex);
    job->status = status;
    job->embedding = embedding;
    job->suggestions = suggestions;
    job->spread = spread;
    job->error = error;
    job->done = true;
    pthread_cond_broadcast(&job->changed);
    job_release(job);
    return NULL;
}

/* A job with a copy of the mesh, if there is one; NULL when memory runs out. */
static orb_job *job_create(job_kind kind, const orb_mesh_arrays *mesh) {
    orb_job *job = calloc(1, sizeof *job);
    if (job)
        job->kind = kind;
    if (!job || !mesh)
        return job;
    bool fine = true;
    job->mesh = *mesh;
    job->mesh.vertices = job_copy(job, mesh->vertices, 3 * (int64_t)mesh->n_vertices, sizeof(double), &fine);
    job->mesh.triangles = job_copy(job, mesh->triangles, 3 * (int64_t)mesh->n_triangles, sizeof(int32_t), &fine);
    if (fine)
        return job;
    job_free(job);
    return NULL;
}

static bool take_request(orb_job *job, const orb_request *request) {
    bool fine = true;
    orb_request *own = &job->request;
    *own = *request;
    own->prepared = job->prepared = prepared_hold(request->prepared);
    if (request->signature)
        own->signature = job_copy(job, request->signature, (int64_t)strlen(request->signature) + 1, 1, &fine);
    own->cones = job_copy(job, request->cones, request->n_cones, sizeof(int32_t), &fine);
    own->orders = job_copy(job, request->orders, request->n_cones, sizeof(int32_t), &fine);
    own->edge_weights =
        job_copy(job, request->edge_weights, 3 * (int64_t)request->n_edge_weights, sizeof(double), &fine);
    if (request->polygon) {
        job->polygon = *request->polygon;
        job->polygon.corners =
            job_copy(job, job->polygon.corners, 3 * (int64_t)job->polygon.n_corners, sizeof(double), &fine);
        own->polygon = &job->polygon;
    }
    own->progress = job_progress;
    own->user = job;
    return fine;
}

/* The signatures' texts in one piece, the pointers to them in another. */
static bool take_signatures(orb_job *job, const orb_suggest_request *request) {
    bool fine = true;
    size_t length = 0;
    if (!request->signatures || request->n_signatures <= 0)
        return true;
    for (int32_t k = 0; k < request->n_signatures; k++)
        length += request->signatures[k] ? strlen(request->signatures[k]) + 1 : 0;
    const char **list = job_copy(job, request->signatures, request->n_signatures, sizeof *request->signatures, &fine);
    char *texts = malloc(length + 1);
    if (!fine || !texts) {
        free(texts);
        return false;
    }
    job->copies[job->n_copies++] = texts;
    for (int32_t k = 0; k < request->n_signatures; k++) {
        if (!list[k])
            continue;
        const size_t bytes = strlen(list[k]) + 1;
        list[k] = memcpy(texts, list[k], bytes);
        texts += bytes;
    }
    job->suggest.signatures = list;
    return true;
}

static bool take_suggest_request(orb_job *job, const orb_suggest_request *request) {
    bool fine = true;
    orb_suggest_request *own = &job->suggest;
    *own = *request;
    own->fixed = job_copy(job, request->fixed, request->n_fixed, sizeof(int32_t), &fine);
    own->keep_away = job_copy(job, request->keep_away, job->mesh.n_vertices, sizeof(double), &fine);
    own->progress = job_progress;
    own->user = job;
    return fine && take_signatures(job, request);
}

/* Starts the thread with every signal blocked except those that are its own faults, so that a signal to the process
 * (an interrupt, a timer) is handled by a thread of the caller's, and a crash handler still sees a crash. */
static int job_spawn(orb_job *job) {
    static const int faults[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTRAP, SIGABRT, SIGSYS};
    sigset_t blocked, before;
    sigfillset(&blocked);
    for (size_t k = 0; k < sizeof faults / sizeof *faults; k++)
        sigdelset(&blocked, faults[k]);

    pthread_attr_t attributes;
    int fault = pthread_attr_init(&attributes);
    if (fault)
        return fault;
    fault = pthread_attr_setstacksize(&attributes, JOB_STACK_BYTES);
    if (!fault)
        fault = pthread_sigmask(SIG_SETMASK, &blocked, &before);
    if (!fault) {
        fault = pthread_create(&job->thread, &attributes, job_run, job);
        pthread_sigmask(SIG_SETMASK, &before, NULL);
    }
    pthread_attr_destroy(&attributes);
    return fault;
}

/* Starts a job that has all that it needs; frees it if that fails. */
static orb_status job_start(orb_job *made, orb_job **job, orb_error *error) {
    if (pthread_mutex_init(&made->mutex, NULL)) {
        job_free(made);
        return error_memory(error);
    }
    if (pthread_cond_init(&made->changed, NULL)) {
        pthread_mutex_destroy(&made->mutex);
        job_free(made);
        return error_memory(error);
    }
    made->holders = 2;
    if (job_spawn(made)) { /* EAGAIN: the system lacks the resources for another thread */
        pthread_cond_destroy(&made->changed);
        pthread_mutex_destroy(&made->mutex);
        job_free(made);
        return error_memory(error);
    }
    *job = made;
    return ORB_OK;
}

orb_status orb_job_start(const orb_mesh_arrays *mesh, const orb_request *request, orb_job **job, orb_error *error) {
    if (job)
        *job = NULL;
    if (!request || (!mesh && !request->prepared) || !job)
        return error_set(error, ORB_BAD_ARGUMENT, "orb_job_start needs a mesh, a request and a place for the job");
    orb_job *made = job_create(JOB_EMBEDS, request->prepared ? NULL : mesh);
    if (made && take_request(made, request))
        return job_start(made, job, error);
    job_free(made);
    return error_memory(error);
}

orb_status orb_job_start_suggest(const orb_mesh_arrays *mesh, const orb_suggest_request *request, orb_job **job,
                                 orb_error *error) {
    if (job)
        *job = NULL;
    if (!mesh || !request || !job)
        return error_set(error, ORB_BAD_ARGUMENT,
                         "orb_job_start_suggest needs a mesh, a request and a place for the job");
    orb_job *made = job_create(JOB_SUGGESTS, mesh);
    if (made && take_suggest_request(made, request))
        return job_start(made, job, error);
    job_free(made);
    return error_memory(error);
}

static bool make_room_for_scale(orb_job *job) {
    job->scale = calloc((size_t)(job->mesh.n_vertices > 0 ? job->mesh.n_vertices : 0) + 1, sizeof *job->scale);
    if (job->scale)
        job->copies[job->n_copies++] = job->scale;
    return job->scale != NULL;
}

orb_status orb_job_start_predict(const orb_mesh_arrays *mesh, const orb_request *request, orb_job **job,
                                 orb_error *error) {
    if (job)
        *job = NULL;
    if (!mesh || !request || !job)
        return error_set(error, ORB_BAD_ARGUMENT,
                         "orb_job_start_predict needs a mesh, a request and a place for the job");
    orb_job *made = job_create(JOB_PREDICTS, mesh);
    if (made && take_request(made, request) && make_room_for_scale(made))
        return job_start(made, job, error);
    job_free(made);
    return error_memory(error);
}

bool orb_job_poll(orb_job *job, char *stage, double *fraction) {
    if (stage)
        *stage = '\0';
    if (fraction)
        *fraction = 0;
    if (!job)
        return true;
    pthread_mutex_lock(&job->mutex);
    if (stage)
        memcpy(stage, job->stage, sizeof job->stage);
    if (fraction)
        *fraction = job->fraction;
    bool over = job->done || job->cancelled;
    pthread_mutex_unlock(&job->mutex);
    return over;
}

void orb_job_cancel(orb_job *job) {
    if (!job)
        return;
    pthread_mutex_lock(&job->mutex);
    job->cancelled = true;
    pthread_cond_broadcast(&job->changed);
    pthread_mutex_unlock(&job->mutex);
}

/* Where the caller wants each result; NULL: it does not. */
typedef struct job_results {
    orb_embedding **embedding;
    orb_suggestions **suggestions;
    double *spread, *scale;
} job_results;

/* Called with the mutex held, of a job that is done. */
static void job_hand_over(orb_job *job, const job_results *results) {
    if (results->embedding) {
        *results->embedding = job->embedding;
        job->embedding = NULL;
    }
    if (results->suggestions) {
        *results->suggestions = job->suggestions;
        job->suggestions = NULL;
    }
    if (results->spread)
        *results->spread = job->spread;
    if (results->scale && job->status == ORB_OK)
        memcpy(results->scale, job->scale, (size_t)job->mesh.n_vertices * sizeof *results->scale);
}

/* Waits, hands over what was asked for, and lets go of the job, also where it is of another kind. */
static orb_status job_finish(orb_job *job, job_kind kind, const job_results *results, orb_error *error) {
    static const char *const finishes[] = {"makes an embedding: finish it with orb_job_finish",
                                           "suggests cones: finish it with orb_job_finish_suggest",
                                           "predicts: finish it with orb_job_finish_predict"};
    if (!job)
        return error_set(error, ORB_BAD_ARGUMENT, "there is no job to finish; start one first");
    pthread_mutex_lock(&job->mutex);
    while (!job->done && !job->cancelled)
        pthread_cond_wait(&job->changed, &job->mutex);

    orb_status status = job->status;
    pthread_t thread = job->thread;
    bool done = job->done;
    if (job->cancelled) {
        status = error_set(error, ORB_CANCELLED, "cancelled");
    } else if (job->kind != kind) {
        status = error_set(error, ORB_BAD_ARGUMENT, "the job %s", finishes[job->kind]);
    } else {
        if (error)
            *error = job->error;
        job_hand_over(job, results);
    }
    job_release(job);
    /* A thread that is done has let go of the job and only has to return; any other one is left to itself. */
    if (done)
        pthread_join(thread, NULL);
    else
        pthread_detach(thread);
    return status;
}

orb_status orb_job_finish(orb_job *job, orb_embedding **embedding, orb_error *error) {
    if (embedding)
        *embedding = NULL;
    return job_finish(job, JOB_EMBEDS, &(job_results){.embedding = embedding}, error);
}

orb_status orb_job_finish_suggest(orb_job *job, orb_suggestions **suggestions, orb_error *error) {
    if (suggestions)
        *suggestions = NULL;
    return job_finish(job, JOB_SUGGESTS, &(job_results){.suggestions = suggestions}, error);
}

orb_status orb_job_finish_predict(orb_job *job, double *spread, double *scale, orb_error *error) {
    return job_finish(job, JOB_PREDICTS, &(job_results){.spread = spread, .scale = scale}, error);
}
