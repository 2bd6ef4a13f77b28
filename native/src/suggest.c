/* Where to put the cones: the whole way from a mesh to suggestions. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * signatures -> ground -> options -> assignment -> descent -> prediction, for all signatures at once; then the embeddings of
 * those whose tile is not conformal. */
#include "orbifold_cones.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "distortion.h"
#include "picks.h"
#include "plan.h"
#include "surface.h"
#include "topology.h"
#include "usual.h"

static const double most_sampled = 2.5e6; /* candidates times vertices */
/* Where many cones are worth an embedding: the best spread without them, and theirs relative to it. */
static const double large_spread = 1, promising = 0.9;
enum {
    FEWEST_CANDIDATES = 60,
    MOST_CANDIDATES = 120,
    MOST_EMBEDDED = 200000 /* vertices, where nobody asked for a signature that has to be embedded */
};

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

/* --- signatures with so many mirrors: one mesh, one factorisation ------------------------------------------------ */

typedef struct group {
    orb_study *study;
    int32_t n;
    orb_plan **plans; /* [n] */
    const orb_mesh *mesh;
    orb_mesh *closed; /* the mesh with holes filled, if it has any */
    int32_t *loop_of; /* [n_boundary_loops] by mirror */
    orb_ground *ground;
    orb_reflection *reflection;
    orb_spread *spread;
    orb_columns *columns;
    int32_t n_candidates;
} group;

static void group_clear(group *g) {
    columns_free(g->columns);
    spread_free(g->spread);
    reflection_free(g->reflection);
    ground_free(g->ground);
    free(g->loop_of);
    free(g->plans);
    mesh_free(g->closed);
}

/* Fills the holes and says which loops are mirrors. */
static orb_status take_mesh(group *g, int32_t n_mirrors, orb_error *error) {
    const orb_mesh *input = g->study->input;
    const orb_suggest_request *request = g->study->request;
    g->mesh = input;
    orb_boundary *boundary = NULL;
    bool *close = calloc((size_t)input->n_boundary_loops + 1, sizeof *close);
    int32_t *rank = g->loop_of = malloc(((size_t)input->n_boundary_loops + 1) * sizeof *rank);
    orb_status status = close && rank ? boundary_list(input, &boundary, error) : error_memory(error);
    if (status == ORB_OK)
        status = boundary_rank(input, boundary, request->n_fixed, request->fixed, rank, error);
    if (status == ORB_OK && n_mirrors < input->n_boundary_loops) {
        for (int32_t k = n_mirrors; k < input->n_boundary_loops; k++)
            close[rank[k]] = true;
        status = boundary_close(input, boundary, close, &g->closed, error);
        g->mesh = g->closed;
        boundary_free(boundary);
        boundary = NULL;
        if (status == ORB_OK)
            status = boundary_list(g->mesh, &boundary, error);
        if (status == ORB_OK)
            status = boundary_rank(g->mesh, boundary, request->n_fixed, request->fixed, rank, error);
    }
    boundary_free(boundary);
    free(close);
    return status;
}

/* The mirror plane, unless the fixed cones are not symmetric in it. Corners of several mirrors would have to be. */
static orb_status find_plane(group *g, int32_t n_mirrors, orb_error *error) {
    const orb_suggest_request *request = g->study->request;
    if (request->symmetry == ORB_SYMMETRY_IGNORE)
        return ORB_OK;
    orb_status status = reflection_find(g->mesh, request->symmetry == ORB_SYMMETRY_PLANE ? request->plane : NULL,
                                        &g->reflection, error);
    bool symmetric = g->reflection && n_mirrors <= 1;
    for (int32_t k = 0; k < request->n_fixed && symmetric; k++) {
        const int32_t image = g->reflection->image[request->fixed[k]];
        symmetric = image >= 0 && g->ground->fixed[image];
    }
    if (!symmetric)
        return status;
    g->ground->reflection = g->reflection;
    g->study->has_plane = true;
    memcpy(g->study->plane, g->reflection->plane, sizeof g->study->plane);
    return status;
}

/* Places for all plans that have none yet, with or without symmetry. */
static orb_status place_plans(group *g, bool symmetric, orb_error *error) {
    const orb_suggest_request *request = g->study->request;
    const int32_t n_kinds = 2 * (g->ground->boundary->n_loops + 1);
    bool *wanted = calloc((size_t)n_kinds, sizeof *wanted), any = false;
    int32_t *count = calloc((size_t)n_kinds, sizeof *count);
    orb_options *options = NULL;
    orb_status status = wanted && count ? ORB_OK : error_memory(error);
    g->ground->reflection = symmetric ? g->reflection : NULL;
    for (int32_t k = 0; k < g->n && status == ORB_OK; k++)
        if (!g->plans[k]->placed) {
            any = true;
            plan_want(g->plans[k], g->loop_of, symmetric, wanted);
        }
    for (int32_t kind = 0; kind < n_kinds && status == ORB_OK; kind++)
        if (wanted[kind]) /* a pair has two columns */
            count[kind] = !symmetric ? g->n_candidates : g->n_candidates / (ground_kind_is_pair(kind) ? 3 : 2);
    if (status == ORB_OK && any)
        status = options_create(g->ground, g->columns, request->n_fixed, request->fixed, count, &options, error);
    for (int32_t k = 0; k < g->n && status == ORB_OK && any; k++)
        if (!g->plans[k]->placed) {
            status = plan_place(g->plans[k], g->ground, options, g->spread->constant, g->loop_of, symmetric, error);
            if (status == ORB_OK)
                status = monitor_report(&g->study->monitor, "places", 0.4, error);
        }
    options_free(options);
    free(wanted);
    free(count);
    return status;
}

/* Symmetric places move symmetrically. */
static orb_status descend(group *g, bool symmetric, orb_error *error) {
    const double radius = 1.5 * g->ground->size / sqrt(g->n_candidates);
    int32_t n = 0;
    orb_descent *descents = malloc(((size_t)g->n + 1) * sizeof *descents);
    if (!descents)
        return error_memory(error);
    g->ground->reflection = symmetric ? g->reflection : NULL;
    for (int32_t k = 0; k < g->n; k++)
        if (g->plans[k]->placed && g->plans[k]->symmetric == symmetric)
            descents[n++] = plan_descent(g->plans[k], radius);
    orb_status status = n > 0 ? descent_run(g->ground, g->columns, n, descents, error) : ORB_OK;
    free(descents);
    return status;
}

static orb_status predict(group *g, orb_error *error) {
    const size_t room = (size_t)g->mesh->n_vertices + 1;
    double *scale[SPREAD_BLOCK] = {NULL}, *memory = malloc(SPREAD_BLOCK * room * sizeof *memory);
    orb_status status = memory ? ORB_OK : error_memory(error);
    for (int32_t next = 0; next < g->n && status == ORB_OK;) {
        orb_charges charges[SPREAD_BLOCK];
        orb_plan *plans[SPREAD_BLOCK];
        int32_t n = 0;
        for (; next < g->n && n < SPREAD_BLOCK; next++) {
            if (!g->plans[next]->placed)
                continue;
            plans[n] = g->plans[next];
            charges[n] = plan_charges(plans[n]);
            scale[n] = memory + (size_t)n * room;
            n++;
        }
        status = monitor_report(&g->study->monitor, "prediction", 0.8 + 0.05 * next / g->n, error);
        if (status == ORB_OK && n > 0)
            status = spread_scales(g->spread, n, charges, scale, error);
        for (int32_t k = 0; k < n && status == ORB_OK; k++)
            plans[k]->predicted = plans[k]->conformal = spread_deviation(g->spread, scale[k]);
    }
    free(memory);
    return status;
}

static int32_t count_candidates(const group *g) {
    int32_t count = (int32_t)fmin(fmax(most_sampled / g->mesh->n_vertices, FEWEST_CANDIDATES), MOST_CANDIDATES);
    for (int32_t k = 0; k < g->n; k++)
        if (2 * g->plans[k]->n_cones > count)
            count = 2 * g->plans[k]->n_cones;
    return count;
}

static orb_status run_group(group *g, int32_t n_mirrors, orb_error *error) {
    orb_study *study = g->study;
    orb_status status = take_mesh(g, n_mirrors, error);
    if (status == ORB_OK)
        status = ground_create(g->mesh, study->input->n_vertices, study->request->keep_away, study->request->n_fixed,
                               study->request->fixed, &g->ground, error);
    if (status == ORB_OK)
        status = find_plane(g, n_mirrors, error);
    if (status == ORB_OK)
        status = monitor_report(&study->monitor, "order", 0.02, error);
    if (status == ORB_OK)
        status = spread_create(g->mesh, &g->spread, error);
    if (status == ORB_OK)
        status = columns_create(g->spread, &study->monitor, &g->columns, error);
    if (status == ORB_OK)
        g->n_candidates = count_candidates(g);
    const bool symmetric = status == ORB_OK && g->ground->reflection;
    if (symmetric) {
        status = place_plans(g, true, error);
        if (status == ORB_OK)
            status = descend(g, true, error);
    }
    if (status == ORB_OK)
        status = place_plans(g, false, error);
    if (status == ORB_OK)
        status = descend(g, false, error);
    for (int32_t k = 0; k < g->n && status == ORB_OK; k++)
        if (g->plans[k]->placed)
            status = plan_list_cones(g->plans[k], g->ground, g->loop_of, error);
    return status == ORB_OK ? predict(g, error) : status;
}

static orb_status run_groups(orb_study *study, orb_error *error) {
    orb_status status = ORB_OK;
    for (int32_t mirrors = 0; mirrors <= study->input->n_boundary_loops && status == ORB_OK; mirrors++) {
        group g = {.study = study, .plans = malloc(((size_t)study->n + 1) * sizeof *g.plans)};
        status = g.plans ? ORB_OK : error_memory(error);
        for (int32_t k = 0; k < study->n && status == ORB_OK; k++)
            if (study->plans[k]->signature->n_mirrors == mirrors && study->plans[k]->n_cones >= study->request->n_fixed)
                g.plans[g.n++] = study->plans[k];
        if (g.n > 0)
            status = run_group(&g, mirrors, error);
        group_clear(&g);
    }
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

static int best_first(const void *a, const void *b) {
    const orb_plan *x = *(orb_plan *const *)a, *y = *(orb_plan *const *)b;
    if (x->placed != y->placed)
        return x->placed ? -1 : 1;
    return x->placed ? (x->predicted > y->predicted) - (x->predicted < y->predicted) : 0;
}

/* Stable, so that of equally good ones the first in the list comes first. */
static void sort_plans(orb_study *study) {
    for (int32_t i = 1; i < study->n; i++)
        for (int32_t j = i; j > 0 && best_first(&study->plans[j], &study->plans[j - 1]) < 0; j--) {
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
