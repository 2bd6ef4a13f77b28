/* The whole way from mesh arrays to a certified embedding. SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "certificate.h"
#include "cut.h"
#include "distortion.h"
#include "embedding.h"
#include "polygon.h"
#include "prepared.h"
#include "solve.h"
#include "weights.h"

const char *orb_version(void) { return "0.2.0"; }

orb_request orb_request_default(void) { return (orb_request){.weights = ORB_WEIGHTS_CONFORMAL, .clamp = 0.01}; }

/* Mesh, signature and picks: everything that can be wrong before any work is done. */
static orb_status read_input(orb_workshop *work, const orb_mesh_arrays *arrays, orb_error *error) {
    orb_embedding *embedding = work->embedding;
    orb_status status = surface_create(arrays, work->request, work->halve, &embedding->surface, error);
    if (status != ORB_OK)
        return status;
    embedding->mesh = embedding->surface->mesh;
    embedding->report = embedding->surface->about;
    embedding->weights = malloc(((size_t)embedding->mesh->n_edges + 1) * sizeof *embedding->weights);
    if (!embedding->weights)
        return error_memory(error);
    if (work->request->weights == ORB_WEIGHTS_GIVEN)
        return surface_given_weights(embedding->surface, work->request, embedding->weights, error);
    const orb_prepared *prepared = embedding->surface->prepared;
    return weights_compute(embedding->mesh, work->request, prepared ? &prepared->cotangents : NULL, embedding->weights,
                           &embedding->report.clamped_weights, error);
}

/* Two cones or corners of a lune are antipodal: an edge between them would be no one geodesic. */
static orb_status refuse_edge_between_poles(const orb_workshop *work, orb_error *error) {
    const orb_embedding *embedding = work->embedding;
    const orb_mesh *mesh = embedding->mesh;
    const orb_surface *surface = embedding->surface;
    if (surface->n_marks != 2)
        return ORB_OK;
    const int32_t *poles = surface->vertex, *place = work->disk->boundary, *at = work->disk->corner_at;
    if (work->disk->word->n_sides != 2 || place[at[0]] == place[at[1]])
        return ORB_OK;
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        int32_t h = mesh->edge_halfedge[e], a = halfedge_from(mesh, h), b = halfedge_to(mesh, h);
        if ((a == poles[0] && b == poles[1]) || (a == poles[1] && b == poles[0]))
            return error_set_elements(error, ORB_BAD_CONE, ORB_VERTEX, poles, 2, 2,
                                      "the cones %d and %d of %s are neighbours, and go to opposite poles: pick cones "
                                      "that share no edge, or subdivide the mesh",
                                      (int)poles[0], (int)poles[1], surface->signature->text);
    }
    return ORB_OK;
}

static orb_status list_corners(orb_workshop *work, orb_error *error) {
    const orb_disk *disk = work->disk;
    int32_t *corners = work->embedding->corners = malloc(((size_t)disk->word->n_sides + 1) * sizeof *corners);
    if (!corners)
        return error_memory(error);
    for (int32_t s = 0; s < disk->word->n_sides; s++) {
        const int32_t vertex = disk->copy_vertex[disk->boundary[disk->corner_at[s]]];
        corners[s] = vertex < work->embedding->mesh->n_vertices ? vertex : -1;
    }
    return ORB_OK;
}

static orb_status cut_and_glue(orb_workshop *work, orb_error *error) {
    orb_embedding *embedding = work->embedding;
    orb_report *report = &embedding->report;
    const orb_signature *signature = embedding->surface->signature;
    double start = monitor_clock();
    orb_marks marks = surface_marks(embedding->surface);
    orb_status status = cut_open(embedding->mesh, signature, embedding->surface->cut, embedding->surface->parent,
                                 &marks, &work->disk, error);
    report->seconds_cut = monitor_clock() - start;
    if (status != ORB_OK)
        return status;
    start = monitor_clock();
    status = signature ? tile_create(work->disk->word, signature->curvature, &embedding->tile, error)
                       : polygon_create(work->request->polygon, &embedding->tile, error);
    if (status == ORB_OK)
        status = list_corners(work, error);
    if (status == ORB_OK)
        status = refuse_edge_between_poles(work, error);
    if (status == ORB_OK)
        status = holonomy_create(embedding->mesh, work->disk, embedding->tile, &embedding->copies, error);
    if (status == ORB_OK)
        status = problem_create(embedding->mesh, embedding->copies, work->disk, embedding->tile, embedding->weights,
                                &work->problem, error);
    if (status == ORB_OK)
        status = solve_find_weights(work, error);
    if (status == ORB_OK)
        report->orbifold_euler = signature ? signature->euler : 0;
    report->seconds_tile = monitor_clock() - start;
    return status;
}

static orb_status certify(orb_workshop *work, orb_error *error) {
    double start = monitor_clock();
    orb_embedding *embedding = work->embedding;
    orb_status status = certificate_check(embedding, error);
    if (status == ORB_OK)
        status = distortion_measure(embedding, error);
    if (status == ORB_OK)
        status = embedding_finish(embedding, error);
    embedding->report.seconds_certify = monitor_clock() - start;
    return status;
}

static orb_status run_stages(orb_workshop *work, const orb_mesh_arrays *arrays, orb_error *error) {
    double start = monitor_clock();
    orb_status status = monitor_report(&work->monitor, "topology", 0, error);
    if (status == ORB_OK)
        status = read_input(work, arrays, error);
    work->embedding->report.seconds_topology = monitor_clock() - start;
    if (status == ORB_OK)
        status = monitor_report(&work->monitor, "cut", 0.05, error);
    if (status == ORB_OK)
        status = cut_and_glue(work, error);
    if (status == ORB_OK)
        status = monitor_report(&work->monitor, "order", 0.1, error);
    if (status == ORB_OK)
        status = solve_set_up(work, error);
    if (status == ORB_OK)
        status = monitor_report(&work->monitor, "start", 0.2, error);
    if (status == ORB_OK)
        status = solve_start(work, error);
    if (status == ORB_OK)
        status = monitor_report(&work->monitor, "minimise", 0.3, error);
    if (status == ORB_OK)
        status = solve_minimise(work, error);
    if (status == ORB_OK)
        status = monitor_report(&work->monitor, "certify", 0.9, error);
    if (status == ORB_OK)
        status = certify(work, error);
    if (status == ORB_OK)
        status = monitor_report(&work->monitor, "done", 1, error);
    work->embedding->report.seconds_total = monitor_clock() - start;
    return status;
}

/* One embedding, with the chords halved that `halve` allows (NULL: all). */
static orb_status embed_once(const orb_mesh_arrays *mesh, const orb_request *request, const uint8_t *halve,
                             orb_embedding **result, orb_error *error) {
    orb_workshop work = {.request = request, .halve = halve, .monitor = {request->progress, request->user, 0}};
    work.embedding = calloc(1, sizeof *work.embedding);
    orb_status status = work.embedding ? run_stages(&work, mesh, error) : error_memory(error);
    if (status == ORB_OK)
        work.embedding->surface->prepared = NULL; /* borrowed for the time of this call */
    free(work.order);
    system_free(work.system);
    problem_free(work.problem);
    intrinsic_free(work.intrinsic);
    disk_free(work.disk);
    *result = work.embedding;
    if (status != ORB_OK) {
        orb_embedding_free(work.embedding);
        *result = NULL;
    }
    return status;
}

/* needed[plain edges]: the halved chords without which a triangle would be flat, or nearly. All corners of a plain
 * triangle lie in one piece of the layout (cut_graph.h). Returns how many could have stayed whole. */
static int32_t count_needless(const orb_embedding *embedding, uint8_t *needed) {
    static const double flat = 1e-3; /* sine of the greatest angle */
    const orb_surface *surface = embedding->surface;
    const orb_mesh *mesh = embedding->mesh, *plain = surface->plain;
    const int32_t *copy = embedding->copies->triangles;
    int32_t needless = surface->n_halved;
    memset(needed, 0, (size_t)plain->n_edges);
    for (int32_t t = 0; t < mesh->n_triangles;) {
        int32_t p = surface->parent[t], pieces = t;
        orb_point corner[3] = {{0}};
        for (; t < mesh->n_triangles && surface->parent[t] == p; t++)
            for (int32_t h = 3 * t; h < 3 * t + 3; h++)
                for (int c = 0; c < 3; c++)
                    if (mesh->triangles[h] == plain->triangles[3 * p + c])
                        corner[c] = embedding->placed[copy[h]];
        if (t - pieces == 1)
            continue;
        /* A triangle that was turned over with its pieces is as good. */
        double sine;
        certificate_corner(embedding->tile->geometry, corner, &sine);
        if (fabs(sine) > flat)
            continue;
        for (int32_t h = 3 * p; h < 3 * p + 3; h++)
            needed[plain->edge[h]] = 1;
    }
    for (int32_t k = 0; k < surface->n_halved; k++)
        needless -= needed[surface->halved[k]];
    return needless;
}

/* Once more without the halvings that turned out to be needless; if that fails, *embedding stays. */
static orb_status drop_needless(const orb_mesh_arrays *mesh, const orb_request *request, orb_embedding **embedding,
                                orb_error *error) {
    const orb_surface *surface = (*embedding)->surface;
    if (surface->n_halved == 0)
        return ORB_OK;
    uint8_t *needed = malloc((size_t)surface->plain->n_edges + 1);
    if (!needed)
        return error_memory(error);
    orb_embedding *better = NULL;
    orb_status status = ORB_OK;
    if (count_needless(*embedding, needed) > 0)
        status = embed_once(mesh, request, needed, &better, error);
    free(needed);
    if (better) {
        orb_embedding_free(*embedding);
        *embedding = better;
    }
    return status == ORB_CANCELLED || status == ORB_OUT_OF_MEMORY ? status : ORB_OK;
}

static bool weights_may_be_to_blame(orb_status status) {
    return status == ORB_CERTIFICATE_FAILED || status == ORB_NOT_CONVERGED || status == ORB_ZERO_AREA_TRIANGLE;
}

/* Adds to the message which other weights do embed the mesh, for they are tried. */
static void advise(const orb_mesh_arrays *mesh, const orb_request *request, orb_error *error) {
    static const struct {
        orb_weights kind;
        const char *name;
    } others[] = {
        {ORB_WEIGHTS_COTANGENT, "cotangent"}, {ORB_WEIGHTS_MEAN_VALUE, "mean-value"}, {ORB_WEIGHTS_UNIFORM, "uniform"}};
    const char *passes = NULL;
    for (size_t k = 0; k < sizeof others / sizeof *others && !passes && error; k++) {
        orb_request other = *request;
        orb_embedding *embedding = NULL;
        other.weights = others[k].kind;
        other.progress = NULL;
        if (other.weights != request->weights && embed_once(mesh, &other, NULL, &embedding, NULL) == ORB_OK)
            passes = others[k].name;
        orb_embedding_free(embedding);
    }
    if (!error)
        return;
    size_t used = strlen(error->message), room = sizeof error->message - used;
    if (passes)
        snprintf(error->message + used, room, "; %s weights embed it", passes);
    else
        snprintf(error->message + used, room, "; nor do other weights embed it");
}

/* Vertices that the computation has added, where it halved edges or filled holes, are none of the user's to look at. */
static void forget_added_vertices(const orb_mesh_arrays *mesh, const orb_request *request, orb_error *error) {
    const int32_t n = request->prepared ? request->prepared->mesh->n_vertices : mesh->n_vertices;
    const int32_t entries = error && error->element == ORB_EDGE ? 2 : 1;
    int32_t kept = 0;
    if (!error || (error->element != ORB_VERTEX && error->element != ORB_EDGE) || error->status == ORB_BAD_CONE ||
        error->status == ORB_INDEX_OUT_OF_RANGE)
        return;
    for (int32_t k = 0; k < error->n_elements; k += entries) {
        if (error->elements[k] >= n || error->elements[k + entries - 1] >= n)
            continue;
        for (int32_t i = 0; i < entries; i++)
            error->elements[kept++] = error->elements[k + i];
    }
    if (kept == error->n_elements)
        return;
    error->n_elements = kept;
    const size_t used = strlen(error->message), room = sizeof error->message - used;
    snprintf(error->message + used, room, " (vertices from %d on were added where edges were halved or holes filled)",
             (int)n);
}

orb_status orb_embed(const orb_mesh_arrays *mesh, const orb_request *request, orb_embedding **result,
                     orb_error *error) {
    if (!result)
        return error_set(error, ORB_BAD_ARGUMENT, "orb_embed needs a place for its result");
    *result = NULL;
    if (!request || (!mesh && !request->prepared) || request->n_cones < 0 || (request->n_cones > 0 && !request->cones))
        return error_set(error, ORB_BAD_ARGUMENT, "orb_embed needs a mesh, a request and its cones");
    orb_status status = embed_once(mesh, request, NULL, result, error);
    if (status == ORB_OK)
        status = drop_needless(mesh, request, result, error);
    if (status == ORB_OK)
        return error_set(error, ORB_OK, "%s", "");
    orb_embedding_free(*result);
    *result = NULL;
    forget_added_vertices(mesh, request, error);
    if (weights_may_be_to_blame(status))
        advise(mesh, request, error);
    return status;
}
