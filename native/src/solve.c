/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solve.h"

#include <stdlib.h>
#include <string.h>

#include "balance.h"
#include "certificate.h"
#include "dilation.h"
#include "distortion.h"
#include "initial.h"
#include "modulus.h"
#include "weights.h"

enum {
    MOST_ROUNDS = 8,      /* of solving and mending */
    MANY_VERTICES = 40000 /* of a real system: from here on METIS's ordering saves more than it costs */
};

/* Without symmetry there is no energy, so a plane is needed, where the balance of forces is a linear system; and the
 * forces add up to nothing only if something takes up the rest, a cone, a corner or a fixed boundary. */
static orb_status check_exact_mean_values(const orb_embedding *embedding, orb_error *error) {
    const orb_signature *signature = embedding->surface->signature;
    if (!geometry_has_translations(embedding->tile->geometry))
        return error_set(error, ORB_BAD_ARGUMENT,
                         "exact mean-value weights are not symmetric and need a plane, but %s is %s: take mean-value "
                         "weights, which are the symmetrised ones",
                         signature ? signature->text : "the polygon", geometry_name(embedding->tile->geometry));
    if (signature && embedding->surface->n_marks == 0)
        return error_set(error, ORB_BAD_ARGUMENT,
                         "exact mean-value weights are not symmetric and need a cone or a corner, but %s has none: "
                         "take mean-value weights, which are the symmetrised ones",
                         signature->text);
    return ORB_OK;
}

orb_status solve_find_weights(orb_workshop *work, orb_error *error) {
    const orb_request *request = work->request;
    const bool conformal = request->weights == ORB_WEIGHTS_CONFORMAL;
    if (request->weights == ORB_WEIGHTS_MEAN_VALUE_EXACT)
        return check_exact_mean_values(work->embedding, error);
    if (!conformal && request->weights != ORB_WEIGHTS_DELAUNAY)
        return ORB_OK;
    orb_status status = intrinsic_create(work->embedding, work->problem, conformal, &work->intrinsic, error);
    if (status == ORB_OK)
        status = intrinsic_triangulate(work->intrinsic, work->embedding, request->clamp, work->problem, error);
    return status;
}

static orb_status find_order(orb_workshop *work, const orb_prepared *prepared, orb_error *error) {
    const bool slow = !work->system->is_complex && work->system->n_free > MANY_VERTICES, known = prepared && !slow;
    work->n_order = known ? prepared->mesh->n_used_vertices : work->system->n_free;
    work->order = malloc(((size_t)work->n_order + 1) * sizeof *work->order);
    if (!work->order)
        return error_memory(error);
    if (!known)
        return system_find_order(work->system, slow ? ORDERING_METIS : ORDERING_AMD, work->order, error);
    memcpy(work->order, prepared->order, (size_t)work->n_order * sizeof *work->order);
    return ORB_OK;
}

/* The matrix's pattern and its ordering, which the initial guess shares. */
orb_status solve_set_up(orb_workshop *work, orb_error *error) {
    double start = monitor_clock();
    /* An ordering for the mesh's edges serves the intrinsic ones badly: seven times the fill on david. */
    const orb_prepared *prepared = work->intrinsic ? NULL : work->embedding->surface->prepared;
    orb_status status = system_create(work->problem, problem_is_complex(work->problem), prepared, &work->system, error);
    if (status != ORB_OK)
        return status;
    double built = monitor_clock();
    if (!work->order) /* else it is that of nearly the same edges */
        status = find_order(work, prepared, error);
    work->embedding->report.seconds_assemble += built - start;
    work->embedding->report.seconds_analyze += monitor_clock() - built;
    return status;
}

/* Weights for the disk's own mesh: the same, unless it was refined. */
static orb_status start_on_disk(orb_workshop *work, orb_point *start, orb_error *error) {
    const orb_disk *disk = work->disk;
    const bool same = !work->intrinsic; /* the ordering is one of the mesh's edges */
    if (!disk->refined)
        return initial_embed(disk, work->embedding->tile, work->embedding->weights, same ? work->order : NULL,
                             same ? work->n_order : 0, start, error);
    double *weights = malloc(((size_t)disk->mesh->n_edges + 1) * sizeof *weights);
    if (!weights)
        return error_memory(error);
    for (int32_t e = 0; e < disk->mesh->n_edges; e++)
        weights[e] = 1;
    orb_status status = initial_embed(disk, work->embedding->tile, weights, NULL, 0, start, error);
    free(weights);
    return status;
}

orb_status solve_start(orb_workshop *work, orb_error *error) {
    orb_embedding *embedding = work->embedding;
    double began = monitor_clock();
    orb_status status = error_memory(error);
    size_t n = (size_t)embedding->mesh->n_vertices;
    orb_point *start = malloc(((size_t)work->disk->mesh->n_vertices + 1) * sizeof *start);
    embedding->position = malloc((n + 1) * sizeof *embedding->position);
    if (!start || !embedding->position)
        goto done;
    if (geometry_any_start(embedding->tile->geometry)) {
        status = initial_boundary(work->disk, embedding->tile, start, error);
    } else {
        status = start_on_disk(work, start, error);
    }
    if (status == ORB_OK) {
        memcpy(embedding->position, start, n * sizeof *start);
        problem_aim(work->problem, embedding->position);
    }
done:
    free(start);
    embedding->report.seconds_initial = monitor_clock() - began;
    return status;
}

static orb_status run_minimiser(orb_workshop *work, orb_minimum *minimum, orb_error *error) {
    orb_report *report = &work->embedding->report;
    orb_status status = newton_minimise(work->problem, work->system, work->n_order, work->order,
                                        work->embedding->position, minimum, &work->monitor, error);
    report->seconds_assemble += minimum->seconds_assemble;
    report->seconds_analyze += minimum->seconds_analyze;
    report->seconds_factor += minimum->seconds_factor;
    report->seconds_solve += minimum->seconds_solve;
    return status;
}

/* The fast way, and where it stagnates, the exact Hessian from the same start. */
static orb_status find_minimum(orb_workshop *work, orb_minimum *minimum, orb_error *error) {
    orb_status status = run_minimiser(work, minimum, error);
    if (status != ORB_NOT_CONVERGED || !work->system->is_complex)
        return status;
    system_free(work->system);
    work->system = NULL;
    status = system_create(work->problem, false, NULL, &work->system, error);
    return status == ORB_OK ? run_minimiser(work, minimum, error) : status;
}

/* Where the copies are. */
static orb_status place_copies(orb_workshop *work, orb_error *error) {
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
static orb_status keep_edges(orb_workshop *work, const bool *flipped, int round, orb_error *error) {
    orb_embedding *embedding = work->embedding;
    bool changed = intrinsic_keep(work->intrinsic, embedding->mesh, flipped);
    if (!changed || round + 2 >= MOST_ROUNDS) {
        intrinsic_keep_all(work->intrinsic, embedding->mesh);
        free(work->order);
        work->order = NULL;
    }
    double start = monitor_clock();
    orb_status status = intrinsic_triangulate(work->intrinsic, embedding, work->request->clamp, work->problem, error);
    embedding->report.seconds_tile += monitor_clock() - start;
    system_free(work->system);
    work->system = NULL;
    return status == ORB_OK ? solve_set_up(work, error) : status;
}

/* The triangles to mend: those that are flipped, or, where the minimiser got stuck, those around the vertex that it
 * named. */
static orb_status find_faults(orb_workshop *work, const orb_error *stuck, bool *faults, int64_t *n, orb_error *error) {
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
static orb_status find_mended_minimum(orb_workshop *work, orb_minimum *minimum, orb_error *error) {
    bool *faults = malloc(((size_t)work->embedding->mesh->n_triangles + 1) * sizeof *faults);
    orb_status status = faults ? ORB_OK : error_memory(error);
    for (int round = 0; status == ORB_OK; round++) {
        orb_error stuck = {0};
        int64_t n_faults = 0;
        if (work->intrinsic->n_flips == 0) {
            status = find_minimum(work, minimum, error);
            break;
        }
        status = run_minimiser(work, minimum, &stuck);
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

/* Mean-value weights as they stand: no energy, one linear system. */
static orb_status find_balance(orb_workshop *work, orb_minimum *minimum, orb_error *error) {
    const orb_problem *problem = work->problem;
    orb_point *position = work->embedding->position;
    double *both = malloc((2 * (size_t)problem->n_edges + 1) * sizeof *both);
    double complex *direction = malloc(((size_t)problem->n_vertices + 1) * sizeof *direction);
    orb_status status =
        both && direction ? weights_mean_value_both(work->embedding->mesh, both, error) : error_memory(error);
    if (status == ORB_OK) {
        for (int32_t v = 0; v < problem->n_vertices; v++)
            direction[v] = problem->freedom[v] == 1 ? problem_direction(problem, v, position[v]) : 1;
        const orb_balance balance = {problem->geometry, problem->copies, problem->n_vertices,
                                     problem->n_edges,  problem->edges,  both,
                                     problem->freedom,  direction};
        *minimum = (orb_minimum){.iterations = 1};
        status = balance_solve(&balance, position, &minimum->relative_gradient, error);
    }
    free(both);
    free(direction);
    return status;
}

static orb_status find_solution(orb_workshop *work, orb_minimum *minimum, orb_error *error) {
    if (work->intrinsic)
        return find_mended_minimum(work, minimum, error);
    if (work->request->weights == ORB_WEIGHTS_MEAN_VALUE_EXACT)
        return find_balance(work, minimum, error);
    return find_minimum(work, minimum, error);
}

/* The shape of the tile, where it has a choice, by the least conformal energy. */
static void choose_modulus(orb_workshop *work) {
    double covariance[3] = {1, 0, 1};
    if (!geometry_has_translations(work->embedding->tile->geometry))
        ;                                                 /* rigid */
    else if (work->request->weights == ORB_WEIGHTS_GIVEN) /* they say what the metric is */
        problem_covariance(work->problem, work->embedding->placed, covariance);
    else
        distortion_covariance(work->embedding, covariance);
    modulus_choose(work->embedding, covariance);
    modulus_report(work->embedding);
}

/* How far the positions are from a minimum of the energy. */
static orb_status measure_gradient(orb_workshop *work, double *relative, orb_error *error) {
    const orb_embedding *embedding = work->embedding;
    const size_t n = (size_t)embedding->mesh->n_vertices + 1;
    double complex *turn = malloc(((size_t)embedding->copies->n_copies + 1) * sizeof *turn);
    double complex *gradient = malloc(n * sizeof *gradient);
    double *scale = malloc(n * sizeof *scale);
    const bool fine = turn && gradient && scale;
    if (fine) {
        problem_place(work->problem, embedding->position, embedding->placed, turn);
        problem_energy(work->problem, embedding->placed, turn, embedding->position, gradient, scale, relative);
    }
    free(turn);
    free(gradient);
    free(scale);
    return fine ? ORB_OK : error_memory(error);
}

/* Where a dilation is free, conformal energy does not feel it, and the discrete one only by its error: so conformal weights
 * leave it to the spread of area. If that flips a triangle, the minimum stays as it is. */
static orb_status choose_dilation(orb_workshop *work, double *relative_gradient, orb_error *error) {
    orb_embedding *embedding = work->embedding;
    const size_t bytes = ((size_t)embedding->mesh->n_vertices + 1) * sizeof *embedding->position;
    orb_point *before = malloc(bytes);
    bool *flipped = malloc((size_t)embedding->mesh->n_triangles + 1);
    orb_status status = before && flipped ? ORB_OK : error_memory(error);
    if (status == ORB_OK) {
        memcpy(before, embedding->position, bytes - sizeof *before);
        status = dilation_choose(embedding, error);
    }
    if (status == ORB_OK)
        status = place_copies(work, error);
    work->dilated = status == ORB_OK && certificate_find_flipped(embedding, flipped) == 0;
    if (work->dilated) {
        status = measure_gradient(work, relative_gradient, error);
    } else if (status == ORB_OK) {
        memcpy(embedding->position, before, bytes - sizeof *before);
        status = place_copies(work, error);
    }
    free(before);
    free(flipped);
    return status;
}

/* The view shows weights of the mesh's edges only, symmetric ones, and where the positions are their minimum. */
static void leave_weights(orb_workshop *work) {
    if (work->intrinsic)
        intrinsic_finish(work->intrinsic, work->embedding);
    if (work->request->weights == ORB_WEIGHTS_MEAN_VALUE_EXACT || work->dilated) {
        free(work->embedding->weights);
        work->embedding->weights = NULL;
    }
}

/* The minimiser, the affine modulus, and the energy of what came out. */
orb_status solve_minimise(orb_workshop *work, orb_error *error) {
    orb_embedding *embedding = work->embedding;
    orb_report *report = &embedding->report;
    orb_minimum minimum;
    orb_status status = find_solution(work, &minimum, error);
    if (status == ORB_OK)
        status = place_copies(work, error);
    if (status != ORB_OK)
        return status;
    choose_modulus(work);
    if (report->n_moduli > 0)
        status = place_copies(work, error);
    if (status == ORB_OK && work->request->weights == ORB_WEIGHTS_CONFORMAL &&
        dilation_is_free(embedding->surface->signature))
        status = choose_dilation(work, &minimum.relative_gradient, error);
    if (status != ORB_OK)
        return status;
    report->energy = problem_energy(work->problem, embedding->placed, NULL, NULL, NULL, NULL, NULL);
    report->iterations = minimum.iterations;
    report->relative_gradient = minimum.relative_gradient;
    report->factor_nonzeros = minimum.factor_nonzeros;
    leave_weights(work);
    return ORB_OK;
}
