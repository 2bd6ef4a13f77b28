/* The whole way from mesh arrays to a certified embedding. SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "certificate.h"
#include "cut.h"
#include "distortion.h"
#include "embedding.h"
#include "initial.h"
#include "intrinsic.h"
#include "modulus.h"
#include "monitor.h"
#include "newton.h"
#include "polygon.h"
#include "weights.h"

enum { MOST_ROUNDS = 8 }; /* of solving and mending */

/* What is needed on the way and not afterwards. */
typedef struct workshop {
    const orb_request *request;
    const uint8_t *halve; /* chords to halve, or NULL: all */
    orb_embedding *embedding;
    orb_disk *disk;
    orb_problem *problem;
    orb_intrinsic *intrinsic; /* for weights on other edges than the mesh's */
    orb_system *system;
    int32_t *order; /* [system->n_free] of the system's blocks */
    orb_monitor monitor;
} workshop;

const char *orb_version(void) { return "0.1.0"; }

orb_request orb_request_default(void) { return (orb_request){.weights = ORB_WEIGHTS_COTANGENT, .clamp = 0.01}; }

/* Mesh, signature and picks: everything that can be wrong before any work is done. */
static orb_status read_input(workshop *work, const orb_mesh_arrays *arrays, orb_error *error) {
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
    return weights_compute(embedding->mesh, work->request, embedding->weights, &embedding->report.clamped_weights,
                           error);
}

static bool is_sphere(const orb_signature *s) { return s && !s->n_mirrors && !s->n_crosscaps && !s->n_handles; }

/* Half of the disk's circumference. */
static double cut_length(const orb_disk *disk) {
    double length = 0;
    for (int32_t h = 0; h < 3 * disk->mesh->n_triangles; h++)
        length += disk->side[h] >= 0 ? mesh_edge_length(disk->mesh, h) / 2 : 0;
    return length;
}

/* A sphere with cones is cut along the path in which they were picked, every other surface along a graph. A tile of the
 * hyperbolic plane may be any polygon with the right angles: there, a path through many cones, or one that is blocked or
 * erratic, much longer than a graph, gives way to that (docs/decisions.md). */
static orb_status cut(workshop *work, orb_error *error) {
    static const double erratic = 1.5;
    enum { MOST_ON_PATH = 12 };
    const orb_surface *surface = work->embedding->surface;
    const orb_signature *signature = surface->signature;
    orb_marks marks = surface_marks(surface);
    orb_disk *graph = NULL;
    if (!is_sphere(signature))
        return cut_surface(surface->mesh, surface->parent, &marks, signature ? -1 : 0, &work->disk, error);
    bool free_tile = signature->curvature < 0 && marks.n > 3, many = free_tile && marks.n > MOST_ON_PATH;
    orb_status status = many ? ORB_CUT_BLOCKED : cut_path(surface->mesh, &marks, &work->disk, error);
    if (!free_tile || (status != ORB_OK && status != ORB_CUT_BLOCKED))
        return status;
    status = cut_surface(surface->mesh, NULL, &marks, -1, &graph, error);
    if (status == ORB_OK && (!work->disk || cut_length(work->disk) > erratic * cut_length(graph))) {
        disk_free(work->disk);
        work->disk = graph;
        return status;
    }
    disk_free(graph);
    return status;
}

/* Two cones or corners of a lune are antipodal: an edge between them would be no one geodesic. */
static orb_status refuse_edge_between_poles(const workshop *work, orb_error *error) {
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

/* Conformal and Delaunay weights live on edges that the mesh may not have. */
static orb_status find_other_edges(workshop *work, orb_error *error) {
    const orb_request *request = work->request;
    const bool conformal = request->weights == ORB_WEIGHTS_CONFORMAL;
    if (!conformal && request->weights != ORB_WEIGHTS_DELAUNAY)
        return ORB_OK;
    orb_status status = intrinsic_create(work->embedding, conformal, &work->intrinsic, error);
    if (status == ORB_OK)
        status = intrinsic_triangulate(work->intrinsic, work->embedding, request->clamp, work->problem, error);
    return status;
}

static orb_status cut_and_glue(workshop *work, orb_error *error) {
    orb_embedding *embedding = work->embedding;
    orb_report *report = &embedding->report;
    const orb_signature *signature = embedding->surface->signature;
    double start = monitor_clock();
    orb_status status = cut(work, error);
    report->seconds_cut = monitor_clock() - start;
    if (status != ORB_OK)
        return status;
    start = monitor_clock();
    status = signature ? tile_create(work->disk->word, signature->curvature, &embedding->tile, error)
                       : polygon_create(work->request->polygon, &embedding->tile, error);
    if (status == ORB_OK)
        status = refuse_edge_between_poles(work, error);
    if (status == ORB_OK)
        status = holonomy_create(embedding->mesh, work->disk, embedding->tile, &embedding->copies, error);
    if (status == ORB_OK)
        status = problem_create(embedding->mesh, embedding->copies, work->disk, embedding->tile, embedding->weights,
                                &work->problem, error);
    if (status == ORB_OK)
        status = find_other_edges(work, error);
    if (status == ORB_OK)
        report->orbifold_euler = signature ? signature->euler : 0;
    report->seconds_tile = monitor_clock() - start;
    return status;
}

/* The matrix's pattern and its ordering, which the initial guess shares. */
static orb_status set_up_system(workshop *work, orb_error *error) {
    double start = monitor_clock();
    orb_status status = system_create(work->problem, problem_is_complex(work->problem), &work->system, error);
    if (status != ORB_OK)
        return status;
    double built = monitor_clock();
    work->order = malloc(((size_t)work->system->n_free + 1) * sizeof *work->order);
    if (!work->order)
        return error_memory(error);
    status = cholesky_order(&work->system->blocks, ORDERING_AMD, work->order, error);
    work->embedding->report.seconds_assemble += built - start;
    work->embedding->report.seconds_analyze += monitor_clock() - built;
    return status;
}

/* Weights for the disk's own mesh: the same, unless it was refined. */
static orb_status start_on_disk(workshop *work, const int32_t *vertex_order, orb_point *start, orb_error *error) {
    const orb_disk *disk = work->disk;
    const bool same = !work->intrinsic; /* the ordering is one of the mesh's edges */
    if (!disk->refined)
        return initial_embed(disk, work->embedding->tile, work->embedding->weights, same ? vertex_order : NULL,
                             same ? work->system->n_free : 0, start, error);
    double *weights = malloc(((size_t)disk->mesh->n_edges + 1) * sizeof *weights);
    if (!weights)
        return error_memory(error);
    for (int32_t e = 0; e < disk->mesh->n_edges; e++)
        weights[e] = 1;
    orb_status status = initial_embed(disk, work->embedding->tile, weights, NULL, 0, start, error);
    free(weights);
    return status;
}

static orb_status find_start(workshop *work, orb_error *error) {
    orb_embedding *embedding = work->embedding;
    const orb_system *system = work->system;
    double began = monitor_clock();
    orb_status status = error_memory(error);
    size_t n = (size_t)embedding->mesh->n_vertices;
    orb_point *start = malloc(((size_t)work->disk->mesh->n_vertices + 1) * sizeof *start);
    int32_t *vertex_order = malloc(((size_t)system->n_free + 1) * sizeof *vertex_order);
    embedding->position = malloc((n + 1) * sizeof *embedding->position);
    if (!start || !vertex_order || !embedding->position)
        goto done;
    for (int32_t k = 0; k < system->n_free; k++)
        vertex_order[k] = system->free_vertex[work->order[k]];
    if (geometry_any_start(embedding->tile->geometry)) {
        status = initial_boundary(work->disk, embedding->tile, start, error);
    } else {
        status = start_on_disk(work, vertex_order, start, error);
    }
    if (status == ORB_OK) {
        memcpy(embedding->position, start, n * sizeof *start);
        problem_aim(work->problem, embedding->position);
    }
done:
    free(start);
    free(vertex_order);
    embedding->report.seconds_initial = monitor_clock() - began;
    return status;
}

/* The fast way, and where it stagnates, the exact Hessian from the same start. */
static orb_status find_minimum(workshop *work, orb_minimum *minimum, orb_error *error) {
    orb_point *position = work->embedding->position;
    orb_status status =
        newton_minimise(work->problem, work->system, work->order, position, minimum, &work->monitor, error);
    if (status != ORB_NOT_CONVERGED || !work->system->is_complex)
        return status;
    system_free(work->system);
    work->system = NULL;
    status = system_create(work->problem, false, &work->system, error);
    if (status == ORB_OK)
        status = newton_minimise(work->problem, work->system, work->order, position, minimum, &work->monitor, error);
    return status;
}

/* Where the copies are. */
static orb_status place_copies(workshop *work, orb_error *error) {
    orb_embedding *embedding = work->embedding;
    size_t room = (size_t)embedding->copies->n_copies + 1;
    double complex *turn = malloc(room * sizeof *turn);
    free(embedding->placed);
    embedding->placed = malloc(room * sizeof *embedding->placed);
    bool fine = turn && embedding->placed;
    if (fine)
        problem_place(work->problem, embedding->position, embedding->placed, turn);
    free(turn);
    return fine ? ORB_OK : error_memory(error);
}

/* Keeps edges of the mesh from being flipped away where its triangles came out flipped, and sets all up again. */
static orb_status keep_edges(workshop *work, const bool *flipped, int round, orb_error *error) {
    orb_embedding *embedding = work->embedding;
    bool changed = intrinsic_keep(work->intrinsic, embedding->mesh, flipped, round > 1);
    if (!changed || round + 2 >= MOST_ROUNDS)
        intrinsic_keep_all(work->intrinsic, embedding->mesh);
    orb_status status = intrinsic_triangulate(work->intrinsic, embedding, work->request->clamp, work->problem, error);
    system_free(work->system);
    free(work->order);
    work->system = NULL;
    work->order = NULL;
    return status == ORB_OK ? set_up_system(work, error) : status;
}

/* The triangles to mend: those that are flipped, or, where the minimiser got stuck, those around the vertex that it
 * named. */
static orb_status find_faults(workshop *work, const orb_error *stuck, bool *faults, int64_t *n, orb_error *error) {
    const orb_mesh *mesh = work->embedding->mesh;
    orb_status status = ORB_OK;
    if (stuck->status == ORB_OK) {
        status = place_copies(work, error);
        *n = status == ORB_OK ? certificate_find_flipped(work->embedding, faults) : 0;
        return status;
    }
    *n = stuck->n_found;
    memset(faults, 0, (size_t)mesh->n_triangles * sizeof *faults);
    for (int32_t h = 0; h < 3 * mesh->n_triangles && stuck->n_elements > 0; h++)
        faults[h / 3] = faults[h / 3] || mesh->triangles[h] == stuck->elements[0];
    return status;
}

/* Solves, and again until no triangle of the mesh is flipped, or none of its edges. */
static orb_status find_mended_minimum(workshop *work, orb_minimum *minimum, orb_error *error) {
    bool *faults = malloc(((size_t)work->embedding->mesh->n_triangles + 1) * sizeof *faults);
    orb_status status = faults ? ORB_OK : error_memory(error);
    for (int round = 0; status == ORB_OK; round++) {
        orb_error stuck = {0};
        int64_t n_faults = 0;
        if (work->intrinsic->n_flips == 0) {
            status = find_minimum(work, minimum, error);
            break;
        }
        status = newton_minimise(work->problem, work->system, work->order, work->embedding->position, minimum,
                                 &work->monitor, &stuck);
        if (status != ORB_OK && status != ORB_NOT_CONVERGED) {
            if (error)
                *error = stuck;
            break;
        }
        status = find_faults(work, &stuck, faults, &n_faults, error);
        if (status != ORB_OK || (stuck.status == ORB_OK && n_faults == 0))
            break;
        status = keep_edges(work, faults, round, error);
    }
    free(faults);
    return status;
}

/* The minimiser, the affine modulus, and the energy of what came out. */
static orb_status minimise(workshop *work, orb_error *error) {
    orb_embedding *embedding = work->embedding;
    orb_report *report = &embedding->report;
    orb_minimum minimum;
    orb_status status =
        work->intrinsic ? find_mended_minimum(work, &minimum, error) : find_minimum(work, &minimum, error);
    if (status == ORB_OK)
        status = place_copies(work, error);
    if (status != ORB_OK)
        return status;
    double covariance[3] = {1, 0, 1};
    if (!geometry_has_translations(embedding->tile->geometry))
        ;                                                 /* rigid */
    else if (work->request->weights == ORB_WEIGHTS_GIVEN) /* they say what the metric is */
        problem_covariance(work->problem, embedding->placed, covariance);
    else
        distortion_covariance(embedding, covariance);
    modulus_choose(embedding, covariance);
    modulus_report(embedding);
    if (report->n_moduli > 0)
        status = place_copies(work, error);
    if (status != ORB_OK)
        return status;
    report->energy = problem_energy(work->problem, embedding->placed, NULL, NULL, NULL, NULL, NULL);
    report->iterations = minimum.iterations;
    report->relative_gradient = minimum.relative_gradient;
    report->factor_nonzeros = minimum.factor_nonzeros;
    report->seconds_assemble += minimum.seconds_assemble;
    report->seconds_analyze += minimum.seconds_analyze;
    report->seconds_factor = minimum.seconds_factor;
    report->seconds_solve = minimum.seconds_solve;
    if (work->intrinsic)
        intrinsic_finish(work->intrinsic, embedding);
    return ORB_OK;
}

static orb_status certify(workshop *work, orb_error *error) {
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

static orb_status run_stages(workshop *work, const orb_mesh_arrays *arrays, orb_error *error) {
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
        status = set_up_system(work, error);
    if (status == ORB_OK)
        status = monitor_report(&work->monitor, "start", 0.2, error);
    if (status == ORB_OK)
        status = find_start(work, error);
    if (status == ORB_OK)
        status = monitor_report(&work->monitor, "minimise", 0.3, error);
    if (status == ORB_OK)
        status = minimise(work, error);
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
    workshop work = {.request = request, .halve = halve, .monitor = {request->progress, request->user, 0}};
    work.embedding = calloc(1, sizeof *work.embedding);
    orb_status status = work.embedding ? run_stages(&work, mesh, error) : error_memory(error);
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
        if (fabs(certificate_sine(embedding->tile->geometry, corner)) > flat)
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

orb_status orb_embed(const orb_mesh_arrays *mesh, const orb_request *request, orb_embedding **result,
                     orb_error *error) {
    if (!result)
        return error_set(error, ORB_BAD_ARGUMENT, "orb_embed needs a place for its result");
    *result = NULL;
    if (!mesh || !request || request->n_cones < 0 || (request->n_cones > 0 && !request->cones))
        return error_set(error, ORB_BAD_ARGUMENT, "orb_embed needs a mesh, a request and its cones");
    orb_status status = embed_once(mesh, request, NULL, result, error);
    if (status == ORB_OK)
        status = drop_needless(mesh, request, result, error);
    if (status == ORB_OK)
        return error_set(error, ORB_OK, "%s", "");
    orb_embedding_free(*result);
    *result = NULL;
    return status;
}
