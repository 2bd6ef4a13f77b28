/* Where to put the cones: the whole way from a mesh to suggestions. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * signatures -> their cones (placing.h) -> the embeddings of those whose tile is not conformal -> the best first. */
#include "orbifold_cones.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "distortion.h"
#include "picks.h"
#include "placing.h"
#include "topology.h"
#include "usual.h"

/* Where many cones are worth an embedding: the best spread without them, and theirs relative to it. */
static const double large_spread = 1, promising = 0.9;
enum { MOST_EMBEDDED = 200000 }; /* vertices, where nobody asked for a signature that has to be embedded */

struct orb_suggestions {
    int32_t n;
    orb_plan **plans; /* [n] */
    bool has_plane;
    double plane[4];
};

typedef struct orb_study {
    const orb_mesh_arrays *arrays;
    const orb_suggest_request *request;
    orb_monitor monitor;
    orb_mesh *input;
    int32_t n;
    orb_plan **plans; /* [n] in the sequence of the request */
    bool has_plane;
    double plane[4];
    orb_error failure; /* of the last embedding that was to be measured */
} orb_study;

/* --- signatures -------------------------------------------------------------------------------------------------- */

static orb_status add_plan(orb_study *study, const char *text, bool sure, orb_error *error) {
    orb_signature *signature = NULL;
    orb_status status = signature_parse(text, &signature, error);
    if (status == ORB_OK && !signature_is_supported(signature))
        status = signature_refuse(signature, error);
    if (status == ORB_OK)
        status = topology_require_mirrors(study->input, signature, study->request->holes, error);
    if (status == ORB_OK)
        status = topology_require_genus(study->input, signature, error);
    const int32_t extra = status == ORB_OK ? study->input->n_boundary_loops - signature->n_mirrors : 0;
    if (extra > 0 && study->request->holes == ORB_HOLES_MIRROR) {
        orb_signature *more = NULL;
        status = signature_with_mirrors(signature, extra, &more, error);
        signature_free(signature);
        signature = more;
    }
    if (status != ORB_OK) {
        signature_free(signature);
        return status;
    }
    status = plan_create(text, signature, &study->plans[study->n], error);
    if (study->plans[study->n])
        study->plans[study->n++]->sure = sure;
    return status;
}

/* Drops those of the sphere and the hyperbolic plane, if others are left. */
static void keep_flat(orb_study *study) {
    int32_t n_flat = 0, n = study->n;
    for (int32_t k = 0; k < n; k++)
        n_flat += study->plans[k]->signature->curvature == 0;
    if (n_flat == 0)
        return;
    study->n = 0;
    for (int32_t k = 0; k < n; k++)
        if (study->plans[k]->signature->curvature == 0)
            study->plans[study->n++] = study->plans[k];
        else
            plan_free(study->plans[k]);
}

static orb_status list_signatures(orb_study *study, orb_error *error) {
    const orb_suggest_request *request = study->request;
    const bool filled = request->holes == ORB_HOLES_FILL;
    const orb_usual usual = usual_signatures(study->input, filled ? 0 : study->input->n_boundary_loops);
    const int32_t n = request->n_signatures > 0 ? request->n_signatures : usual.n;
    orb_status status = ORB_OK;
    if (n == 0)
        return error_set(error, ORB_WRONG_GENUS,
                         "no signature is usual for a mesh with so many handles and holes: ask for one");
    study->plans = calloc((size_t)n, sizeof *study->plans);
    if (!study->plans)
        return error_memory(error);
    for (int32_t k = 0; k < n && status == ORB_OK; k++)
        if (request->n_signatures > 0)
            status = add_plan(study, request->signatures[k], true, error);
        else if (k < usual.n_sure || study->input->n_vertices <= MOST_EMBEDDED)
            status = add_plan(study, usual.text[k], k < usual.n_sure, error);
    if (request->n_signatures == 0 && request->flat)
        keep_flat(study);
    return status;
}

/* --- one mesh and one factorisation for all signatures with so many mirrors ---------------------------------------- */

static orb_status run_groups(orb_study *study, orb_error *error) {
    orb_plan **plans = malloc(((size_t)study->n + 1) * sizeof *plans);
    orb_status status = plans ? ORB_OK : error_memory(error);
    for (int32_t mirrors = 0; mirrors <= study->input->n_boundary_loops && status == ORB_OK; mirrors++) {
        int32_t n = 0;
        for (int32_t k = 0; k < study->n; k++)
            if (study->plans[k]->signature->n_mirrors == mirrors && study->plans[k]->n_cones >= study->request->n_fixed)
                plans[n++] = study->plans[k];
        if (n > 0)
            status = placing_run(study->input, study->request, mirrors, n, plans, &study->monitor, study->plane,
                                 &study->has_plane, error);
    }
    free(plans);
    return status;
}

/* --- tiles that are not conformal -------------------------------------------------------------------------------- */

/* A part of the progress, for an embedding. */
typedef struct part {
    orb_monitor *monitor;
    double from, to;
} part;

static bool report_part(const char *stage, double fraction, void *user) {
    const part *p = user;
    (void)stage;
    return monitor_report(p->monitor, "embedding", p->from + (p->to - p->from) * fraction, NULL) == ORB_OK;
}

/* The embedding's distortion; a plan whose embedding fails loses its places. */
static orb_status measure(orb_study *study, orb_plan *plan, part *progress, orb_error *error) {
    orb_embedding *embedding = NULL;
    orb_request request = orb_request_default();
    request.signature = plan->text;
    request.n_cones = plan->n_cones;
    request.cones = plan->cones;
    request.holes = study->request->holes;
    request.progress = report_part;
    request.user = progress;
    const orb_status status = orb_embed(study->arrays, &request, &embedding, &study->failure);
    if (status == ORB_CANCELLED || status == ORB_OUT_OF_MEMORY)
        return error_set(error, status, "%s", study->failure.message);
    plan->placed = status == ORB_OK;
    if (status == ORB_OK) {
        plan->predicted = distortion_spread(embedding);
        plan->measured = true;
    }
    orb_embedding_free(embedding);
    return ORB_OK;
}

static orb_status measure_plans(orb_study *study, orb_error *error) {
    double best = INFINITY;
    int32_t n = 0, done = 0;
    for (int32_t k = 0; k < study->n; k++)
        if (study->plans[k]->placed && study->plans[k]->conformal_tile)
            best = fmin(best, study->plans[k]->predicted);
    for (int32_t k = 0; k < study->n; k++) {
        orb_plan *plan = study->plans[k];
        const bool helps = best > large_spread && plan->conformal < promising * best;
        plan->placed = plan->placed && (plan->conformal_tile || plan->sure || helps);
        n += plan->placed && !plan->conformal_tile;
    }
    orb_status status = ORB_OK;
    for (int32_t k = 0; k < study->n && status == ORB_OK; k++)
        if (study->plans[k]->placed)
            status = plan_shorten_walk(study->plans[k], study->input, error);
    for (int32_t k = 0; k < study->n && status == ORB_OK; k++)
        if (study->plans[k]->placed && !study->plans[k]->conformal_tile) {
            part progress = {&study->monitor, 0.85 + 0.15 * done / n, 0.85 + 0.15 * (done + 1) / n};
            status = measure(study, study->plans[k], &progress, error);
            done++;
        }
    return status;
}

/* --- result ------------------------------------------------------------------------------------------------------ */

static bool is_better(const orb_plan *a, const orb_plan *b) {
    return a->placed && (!b->placed || a->predicted < b->predicted);
}

/* Stable, so that of equally good ones the first in the list comes first. */
static void sort_plans(orb_study *study) {
    for (int32_t i = 1; i < study->n; i++)
        for (int32_t j = i; j > 0 && is_better(study->plans[j], study->plans[j - 1]); j--) {
            orb_plan *swap = study->plans[j];
            study->plans[j] = study->plans[j - 1];
            study->plans[j - 1] = swap;
        }
}

static orb_status explain_nothing(const orb_study *study, orb_error *error) {
    const orb_suggest_request *request = study->request;
    if (study->failure.status != ORB_OK) {
        if (error)
            *error = study->failure;
        return study->failure.status;
    }
    if (request->n_fixed > 0)
        return error_set_elements(error, ORB_CONE_COUNT, ORB_VERTEX, request->fixed, request->n_fixed, request->n_fixed,
                                  "none of the signatures has a cone or corner for each of the %d fixed vertices, and "
                                  "places for the others: fix fewer, or ask for another signature",
                                  (int)request->n_fixed);
    return error_set(error, ORB_CONE_COUNT,
                     "none of the signatures finds a vertex for each of its cones and corners: "
                     "subdivide the mesh, or keep cones away from fewer vertices");
}

static orb_status hand_over(orb_study *study, orb_suggestions **result, orb_error *error) {
    sort_plans(study);
    int32_t n = 0;
    while (n < study->n && study->plans[n]->placed)
        n++;
    if (n == 0)
        return explain_nothing(study, error);
    orb_suggestions *suggestions = *result = calloc(1, sizeof *suggestions);
    if (!suggestions)
        return error_memory(error);
    for (int32_t k = n; k < study->n; k++)
        plan_free(study->plans[k]);
    *suggestions = (orb_suggestions){n, study->plans, study->has_plane, {0}};
    memcpy(suggestions->plane, study->plane, sizeof suggestions->plane);
    study->plans = NULL;
    return error_set(error, ORB_OK, "%s", "");
}

static orb_status check_request(const orb_mesh_arrays *mesh, const orb_suggest_request *request, orb_error *error) {
    if (!mesh || !request || request->n_fixed < 0 || (request->n_fixed > 0 && !request->fixed) ||
        request->n_signatures < 0 || (request->n_signatures > 0 && !request->signatures))
        return error_set(error, ORB_BAD_ARGUMENT, "orb_suggest_cones needs a mesh, a request and its arrays");
    if (request->holes < ORB_HOLES_REFUSE || request->holes > ORB_HOLES_MIRROR)
        return error_set(error, ORB_BAD_ARGUMENT, "what to do with holes is %d: choose refuse, fill or mirror",
                         (int)request->holes);
    if (request->symmetry < ORB_SYMMETRY_DETECT || request->symmetry > ORB_SYMMETRY_PLANE)
        return error_set(error, ORB_BAD_ARGUMENT, "the kind of symmetry is %d: choose detect, ignore or plane",
                         (int)request->symmetry);
    return ORB_OK;
}

orb_status orb_suggest_cones(const orb_mesh_arrays *mesh, const orb_suggest_request *request, orb_suggestions **result,
                             orb_error *error) {
    if (!result)
        return error_set(error, ORB_BAD_ARGUMENT, "orb_suggest_cones needs a place for its result");
    *result = NULL;
    orb_status status = check_request(mesh, request, error);
    if (status != ORB_OK)
        return status;
    orb_study study = {.arrays = mesh, .request = request, .monitor = {request->progress, request->user, 0}};
    status = monitor_report(&study.monitor, "topology", 0, error);
    if (status == ORB_OK)
        status = mesh_create(mesh, &study.input, error);
    if (status == ORB_OK)
        status = mesh_require_connected(study.input, error);
    if (status == ORB_OK)
        status = picks_check(study.input, request->n_fixed, request->fixed, error);
    if (status == ORB_OK)
        status = list_signatures(&study, error);
    if (status == ORB_OK)
        status = run_groups(&study, error);
    if (status == ORB_OK)
        status = measure_plans(&study, error);
    if (status == ORB_OK)
        status = monitor_report(&study.monitor, "done", 1, error);
    if (status == ORB_OK)
        status = hand_over(&study, result, error);
    for (int32_t k = 0; study.plans && k < study.n; k++)
        plan_free(study.plans[k]);
    free(study.plans);
    mesh_free(study.input);
    return status;
}

void orb_suggestions_free(orb_suggestions *suggestions) {
    if (!suggestions)
        return;
    for (int32_t k = 0; k < suggestions->n; k++)
        plan_free(suggestions->plans[k]);
    free(suggestions->plans);
    free(suggestions);
}

int32_t orb_suggestions_count(const orb_suggestions *suggestions) { return suggestions ? suggestions->n : 0; }

orb_suggestion orb_suggestions_view(const orb_suggestions *suggestions, int32_t number) {
    if (!suggestions || number < 0 || number >= suggestions->n)
        return (orb_suggestion){0};
    const orb_plan *plan = suggestions->plans[number];
    return (orb_suggestion){plan->text,      plan->n_cones,   plan->cones,    plan->signature->orders,
                            plan->predicted, plan->conformal, plan->measured, plan->symmetric};
}

bool orb_suggestions_plane(const orb_suggestions *suggestions, double plane[4]) {
    const bool has = suggestions && suggestions->has_plane;
    if (has && plane)
        memcpy(plane, suggestions->plane, sizeof suggestions->plane);
    return has;
}
