/* orb_embed on a thread of the library's own. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The job owns copies of everything that the computation reads, and is shared by two holders: the caller (from
 * orb_job_start to orb_job_finish) and the thread. Whoever lets go last frees it. So a cancelled job costs the caller
 * nothing: orb_job_finish detaches the thread and returns, and the thread frees the rest when it next asks for leave
 * to go on, which inside a long factorisation may take seconds. */
#include "error.h"

#include <pthread.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>

/* Ample for the recursions of the orderings; only pages that are touched take memory. */
enum { JOB_STACK_BYTES = 16 * 1024 * 1024, JOB_STAGE_LENGTH = 32 };

struct orb_job {
    pthread_t thread;
    /* Read by the thread only, after the start. */
    orb_mesh_arrays mesh;
    orb_request request;
    double *vertices, *edge_weights, *corners;
    orb_polygon polygon;
    int32_t *triangles, *cones, *orders;
    char *signature;
    /* Under the mutex. */
    pthread_mutex_t mutex;
    pthread_cond_t changed; /* done or cancelled has become true */
    int holders;
    bool done, cancelled;
    char stage[JOB_STAGE_LENGTH];
    double fraction;
    orb_status status;
    orb_embedding *embedding;
    orb_error error;
};

/* *copy = the first `count` elements of source; NULL for no array (orb_embed says whether that is an error). */
static bool job_copy(const void *source, int64_t count, size_t size, void **copy) {
    *copy = NULL;
    if (!source || count <= 0)
        return true;
    if ((uint64_t)count > SIZE_MAX / size)
        return false;
    *copy = malloc((size_t)count * size);
    if (!*copy)
        return false;
    memcpy(*copy, source, (size_t)count * size);
    return true;
}

static void job_free(orb_job *job) {
    if (!job)
        return;
    orb_embedding_free(job->embedding);
    free(job->vertices);
    free(job->triangles);
    free(job->signature);
    free(job->cones);
    free(job->orders);
    free(job->edge_weights);
    free(job->corners);
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
    orb_error error = {0};
    orb_status status = orb_embed(&job->mesh, &job->request, &embedding, &error);

    pthread_mutex_lock(&job->mutex);
    job->status = status;
    job->embedding = embedding;
    job->error = error;
    job->done = true;
    pthread_cond_broadcast(&job->changed);
    job_release(job);
    return NULL;
}

/* A job with copies of the arrays, its mutex not yet made; NULL when memory runs out. */
static orb_job *job_create(const orb_mesh_arrays *mesh, const orb_request *request) {
    orb_job *job = calloc(1, sizeof *job);
    if (!job)
        return NULL;
    void *vertices = NULL, *triangles = NULL, *signature = NULL, *cones = NULL, *orders = NULL, *weights = NULL;
    void *corners = NULL;
    bool copied =
        job_copy(mesh->vertices, 3 * (int64_t)mesh->n_vertices, sizeof *mesh->vertices, &vertices) &&
        job_copy(mesh->triangles, 3 * (int64_t)mesh->n_triangles, sizeof *mesh->triangles, &triangles) &&
        job_copy(request->cones, request->n_cones, sizeof *request->cones, &cones) &&
        job_copy(request->orders, request->n_cones, sizeof *request->orders, &orders) &&
        job_copy(request->edge_weights, 3 * (int64_t)request->n_edge_weights, sizeof *request->edge_weights,
                 &weights) &&
        (!request->polygon || job_copy(request->polygon->corners, 3 * (int64_t)request->polygon->n_corners,
                                       sizeof *request->polygon->corners, &corners)) &&
        (!request->signature || job_copy(request->signature, (int64_t)strlen(request->signature) + 1, 1, &signature));
    job->vertices = vertices;
    job->triangles = triangles;
    job->signature = signature;
    job->cones = cones;
    job->orders = orders;
    job->edge_weights = weights;
    job->corners = corners;
    if (!copied) {
        job_free(job);
        return NULL;
    }
    job->mesh = (orb_mesh_arrays){mesh->n_vertices, job->vertices, mesh->n_triangles, job->triangles};
    job->request = *request;
    job->request.signature = job->signature;
    job->request.cones = job->cones;
    job->request.orders = job->orders;
    job->request.edge_weights = job->edge_weights;
    if (request->polygon) {
        job->polygon = *request->polygon;
        job->polygon.corners = job->corners;
        job->request.polygon = &job->polygon;
    }
    job->request.progress = job_progress;
    job->request.user = job;
    return job;
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

orb_status orb_job_start(const orb_mesh_arrays *mesh, const orb_request *request, orb_job **job, orb_error *error) {
    if (job)
        *job = NULL;
    if (!mesh || !request || !job)
        return error_set(error, ORB_BAD_ARGUMENT, "orb_job_start needs a mesh, a request and a place for the job");
    orb_job *made = job_create(mesh, request);
    if (!made)
        return error_memory(error);
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

orb_status orb_job_finish(orb_job *job, orb_embedding **embedding, orb_error *error) {
    if (embedding)
        *embedding = NULL;
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
    } else {
        if (error)
            *error = job->error;
        if (embedding) {
            *embedding = job->embedding;
            job->embedding = NULL;
        }
    }
    job_release(job);
    /* A thread that is done has let go of the job and only has to return; any other one is left to itself. */
    if (done)
        pthread_join(thread, NULL);
    else
        pthread_detach(thread);
    return status;
}
