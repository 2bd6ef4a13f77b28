/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "newton.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lbfgs.h"

static const double gradient_goal = 1e-11;      /* relative gradient at which to stop */
static const double gradient_accepted = 1e-9;   /* the least that counts as converged */
static const double energy_noise = 1e-13;       /* relative: predicted decreases below this are noise */
static const double sufficient_decrease = 1e-4; /* Armijo */
static const double slow = 0.8;                 /* a kept factor is renewed when the gradient falls by less */
enum { MOST_STEPS = 300, MOST_HALVINGS = 40, MOST_STALLS = 2, MOST_FRUITLESS = 40 };

typedef struct minimiser {
    const orb_problem *problem;
    orb_system *system;
    orb_minimum *minimum;
    orb_cholesky *cholesky;
    orb_lbfgs *memory;           /* NULL for real systems */
    int32_t held;                /* the vertex of freedom 1 of a complex system; -1 if there is none */
    double complex *held_column; /* [n_vertices] the held vertex's column of the inverse */
    orb_point *position, *trial; /* [n_vertices] */
    orb_point *placed;           /* [n_copies] */
    double complex *turn;        /* [n_copies] */
    double complex *gradient, *old_gradient, *step, *transport; /* [n_vertices] */
    double *scale;                                              /* [n_vertices] */
    double *rows;                                               /* right-hand side and solution */
    double energy, relative;
} minimiser;

static void minimiser_free(minimiser *work) {
    free(work->trial);
    free(work->placed);
    free(work->turn);
    free(work->gradient);
    free(work->old_gradient);
    free(work->step);
    free(work->transport);
    free(work->held_column);
    free(work->scale);
    free(work->rows);
    lbfgs_free(work->memory);
    cholesky_free(work->cholesky);
}

static orb_status minimiser_allocate(minimiser *work, orb_error *error) {
    size_t n = (size_t)work->problem->n_vertices + 1, copies = (size_t)work->problem->copies->n_copies + 1;
    work->trial = malloc(n * sizeof *work->trial);
    work->placed = malloc(copies * sizeof *work->placed);
    work->turn = malloc(copies * sizeof *work->turn);
    work->gradient = malloc(n * sizeof *work->gradient);
    work->old_gradient = malloc(n * sizeof *work->old_gradient);
    work->step = malloc(n * sizeof *work->step);
    work->transport = malloc(n * sizeof *work->transport);
    work->scale = malloc(n * sizeof *work->scale);
    work->rows = malloc(2 * n * sizeof *work->rows);
    if (!work->trial || !work->placed || !work->turn || !work->gradient || !work->old_gradient || !work->step ||
        !work->transport || !work->scale || !work->rows)
        return error_memory(error);
    work->held = -1;
    if (!work->system->is_complex)
        return ORB_OK;
    work->held = work->problem->held;
    if (work->held >= 0) {
        work->held_column = malloc(n * sizeof *work->held_column);
        if (!work->held_column)
            return error_memory(error);
    }
    return lbfgs_create(work->problem->n_vertices, &work->memory, error);
}

static orb_status analyze(minimiser *work, int32_t n_order, const int32_t *order, orb_error *error) {
    double start = monitor_clock();
    if (work->system->analysis) {
        orb_status status = cholesky_copy(work->system->analysis, &work->cholesky, error);
        work->minimum->seconds_analyze += monitor_clock() - start;
        return status;
    }
    int32_t *rows = malloc(((size_t)work->system->unknown[work->system->n_free] + 1) * sizeof *rows);
    if (!rows)
        return error_memory(error);
    system_spread_order(work->system, n_order, order, rows);
    orb_status status =
        cholesky_analyze(&work->system->pattern, rows, work->system->is_complex, &work->cholesky, error);
    free(rows);
    work->minimum->seconds_analyze += monitor_clock() - start;
    return status;
}

/* Energy, gradient and relative gradient at the current position. */
static void evaluate(minimiser *work) {
    double start = monitor_clock();
    problem_place(work->problem, work->position, work->placed, work->turn);
    work->energy = problem_energy(work->problem, work->placed, work->turn, work->position, work->gradient, work->scale,
                                  &work->relative);
    work->minimum->seconds_assemble += monitor_clock() - start;
}

/* vectors = inverse of the factored matrix times vectors. */
static orb_status apply_inverse(minimiser *work, double complex *vectors, orb_error *error) {
    system_gather(work->system, work->problem, work->position, vectors, work->rows);
    orb_status status = cholesky_solve(work->cholesky, work->rows, 1, work->rows, error);
    if (status == ORB_OK)
        system_scatter(work->system, work->problem, work->position, work->rows, vectors);
    return status;
}

/* Factors the Hessian at the current position; where it is indefinite, its positive part. */
static orb_status factor(minimiser *work, orb_error *error) {
    bool positive = false;
    for (int hessian = HESSIAN_EXACT; hessian <= HESSIAN_POSITIVE && !positive; hessian++) {
        double start = monitor_clock();
        system_assemble(work->system, work->problem, work->position, work->placed, work->turn, (orb_hessian)hessian);
        double assembled = monitor_clock();
        orb_status status = cholesky_factor(work->cholesky, work->system->values, &positive, error);
        if (status != ORB_OK)
            return status;
        work->minimum->factorisations++;
        work->minimum->seconds_assemble += assembled - start;
        work->minimum->seconds_factor += monitor_clock() - assembled;
    }
    work->minimum->factor_nonzeros = cholesky_nonzeros(work->cholesky);
    if (!positive)
        return error_set(error, ORB_NOT_CONVERGED,
                         "the Hessian is not positive definite: weights or coordinates are of too different size");
    if (work->held < 0)
        return ORB_OK;
    memset(work->held_column, 0, (size_t)work->problem->n_vertices * sizeof *work->held_column);
    work->held_column[work->held] = 1;
    return apply_inverse(work, work->held_column, error);
}

/* A complex system knows no vertex that moves along a line: the move across it, i e with e the line's direction, is
 * taken out by a Lagrange multiplier. The inverse is complex-linear, so one column of it serves every direction. */
static void hold(minimiser *work, double complex *vectors) {
    if (work->held < 0)
        return;
    double complex across = CMPLX(0, 1) * problem_direction(work->problem, work->held, work->position[work->held]);
    double multiplier = creal(conj(across) * vectors[work->held]) / creal(work->held_column[work->held]);
    for (int32_t v = 0; v < work->problem->n_vertices; v++)
        vectors[v] -= multiplier * across * work->held_column[v];
}

/* work->step = -(inverse Hessian) gradient; *slope = <gradient, step>. */
static orb_status find_step(minimiser *work, double *slope, orb_error *error) {
    double start = monitor_clock();
    int32_t n = work->problem->n_vertices;
    for (int32_t v = 0; v < n; v++)
        work->step[v] = -work->gradient[v];
    if (work->memory)
        lbfgs_before(work->memory, work->step);
    orb_status status = apply_inverse(work, work->step, error);
    if (status != ORB_OK)
        return status;
    hold(work, work->step);
    if (work->memory)
        lbfgs_after(work->memory, work->step);
    *slope = lbfgs_dot(n, work->gradient, work->step);
    work->minimum->seconds_solve += monitor_clock() - start;
    return ORB_OK;
}

/* Moves to exp(factor * step); the old position stays in `trial`. */
static void move(minimiser *work, double factor) {
    orb_point *from = work->trial;
    work->trial = work->position;
    for (int32_t v = 0; v < work->problem->n_vertices; v++) {
        from[v] = work->step[v] == 0 ? work->trial[v]
                                     : geometry_exp(work->problem->geometry, work->trial[v], factor * work->step[v]);
        if (work->problem->freedom[v] == 1)
            from[v] = problem_onto_line(work->problem, v, from[v]);
    }
    work->position = from;
}

static void move_back(minimiser *work) {
    orb_point *swap = work->trial;
    work->trial = work->position;
    work->position = swap;
}

/* Whether the decrease that a step promises is below what differences of energies can show. */
static bool is_noise(const minimiser *work, double slope) { return -slope < energy_noise * work->energy; }

/* Halves the step until the energy falls enough; in the noise, the full step. Afterwards position and gradient are the
 * new point's, trial and old_gradient the old one's; *taken is the scale used, 0 when no step helps and nothing
 * moved. */
static void line_search(minimiser *work, double slope, double *taken) {
    double longest = 0, before = work->energy;
    for (int32_t v = 0; v < work->problem->n_vertices; v++)
        longest = fmax(longest, modulus(work->step[v]));
    double cap = geometry_longest_step(work->problem->geometry), scale = longest > cap ? cap / longest : 1;
    bool noise = is_noise(work, slope);
    double complex *swap = work->old_gradient;
    work->old_gradient = work->gradient;
    work->gradient = swap;
    for (int halvings = 0; halvings < MOST_HALVINGS; halvings++, scale /= 2) {
        move(work, scale);
        evaluate(work);
        if (noise || work->energy <= before + sufficient_decrease * scale * slope) {
            *taken = scale;
            return;
        }
        move_back(work);
    }
    *taken = 0;
    evaluate(work);
}

/* The pair of the step just taken goes into the memory, all in the new point's frames. */
static void learn(minimiser *work, double taken) {
    double start = monitor_clock();
    for (int32_t v = 0; v < work->problem->n_vertices; v++) {
        work->transport[v] = geometry_transport(work->problem->geometry, work->trial[v], work->position[v]);
        work->step[v] *= taken * work->transport[v];
        work->old_gradient[v] *= work->transport[v];
    }
    lbfgs_transport(work->memory, work->transport);
    lbfgs_remember(work->memory, work->step, work->old_gradient, work->gradient);
    work->minimum->seconds_solve += monitor_clock() - start;
}

/* One step. Sets *stuck when none lowers the energy. */
static orb_status advance(minimiser *work, bool *stuck, orb_error *error) {
    double slope, taken = 0;
    orb_status status = find_step(work, &slope, error);
    if (status != ORB_OK)
        return status;
    int32_t *count = is_noise(work, slope) ? &work->minimum->refinements : &work->minimum->iterations;
    if (slope < 0) /* not NaN */
        line_search(work, slope, &taken);
    *stuck = taken == 0;
    *count += !*stuck;
    if (!*stuck && work->memory)
        learn(work, taken);
    return ORB_OK;
}

static orb_status iterate(minimiser *work, orb_monitor *monitor, orb_error *error) {
    bool renew = true;
    double first = work->relative, best = work->relative;
    int stalls = 0, fruitless = 0; /* steps, and refinements, since the gradient last halved */
    while (work->relative > gradient_goal && work->minimum->iterations < MOST_STEPS && stalls <= MOST_STALLS &&
           fruitless <= MOST_FRUITLESS) {
        double done = log(first / work->relative) / log(first / gradient_goal);
        orb_status status = monitor_report(monitor, "minimise", 0.3 + 0.6 * fmax(0, fmin(1, done)), error);
        if (status == ORB_OK && renew)
            status = factor(work, error);
        bool stuck = false, fresh = renew;
        int32_t refinements = work->minimum->refinements;
        double before = work->relative;
        if (status == ORB_OK)
            status = advance(work, &stuck, error);
        if (status != ORB_OK)
            return status;
        if (stuck && fresh)
            break;
        /* Below the noise, pairs of differences are mostly rounding, and may mislead. */
        bool refined = work->minimum->refinements > refinements;
        fruitless = work->relative < 0.5 * best ? 0 : fruitless + refined;
        if ((stuck || (refined && fruitless % 8 == 7)) && work->memory)
            lbfgs_forget(work->memory);
        renew = stuck || !work->memory || (work->relative > slow * before && work->relative > gradient_accepted);
        stalls = work->relative < 0.5 * best ? 0 : stalls + (work->relative < gradient_accepted);
        best = fmin(best, work->relative);
    }
    return ORB_OK;
}

/* Names the vertex where the forces balance least: where a limb without a cone shrinks to nothing on the tile, that is
 * in it. */
static orb_status error_not_converged(const minimiser *work, orb_error *error) {
    int32_t worst = 0;
    double most = 0;
    for (int32_t v = 0; v < work->problem->n_vertices; v++) {
        double share = work->scale[v] > 0 ? modulus(work->gradient[v]) / work->scale[v] : 0;
        if (share > most) {
            most = share;
            worst = v;
        }
    }
    return error_set_elements(error, ORB_NOT_CONVERGED, ORB_VERTEX, &worst, 1, 1,
                              "not converged: after %d steps the pull of the edges at vertex %d is out of balance by "
                              "%.1e of itself: pick a cone near it",
                              (int)(work->minimum->iterations + work->minimum->refinements), (int)worst,
                              work->relative);
}

/* Names the vertices where the first embedding has no gradient to go by. */
static orb_status error_bad_start(const minimiser *work, orb_error *error) {
    orb_found found = {0};
    for (int32_t v = 0; v < work->problem->n_vertices; v++)
        if (work->problem->freedom[v] &&
            !(modulus(work->gradient[v]) <= 2 * work->scale[v] && isfinite(work->scale[v])))
            found_add(&found, v);
    return error_set_elements(error, ORB_NOT_CONVERGED, ORB_VERTEX, found.elements, found.entries, found.found,
                              "the first embedding is not finite at %lld %s, first %d: take lower orders, other "
                              "weights or other cones",
                              (long long)found.found, found.found == 1 ? "vertex" : "vertices",
                              found.found ? (int)found.elements[0] : -1);
}

orb_status newton_minimise(const orb_problem *problem, orb_system *system, int32_t n_order, const int32_t *order,
                           orb_point *position, orb_minimum *minimum, orb_monitor *monitor, orb_error *error) {
    *minimum = (orb_minimum){0};
    minimiser work = {.problem = problem, .system = system, .minimum = minimum};
    orb_status status = minimiser_allocate(&work, error);
    size_t bytes = (size_t)problem->n_vertices * sizeof *position;
    work.position = malloc(bytes + sizeof *position);
    if (!work.position)
        status = error_memory(error);
    if (status != ORB_OK)
        goto done;
    memcpy(work.position, position, bytes);
    status = analyze(&work, n_order, order, error);
    if (status != ORB_OK)
        goto done;
    evaluate(&work);
    if (!isfinite(work.relative) || !isfinite(work.energy)) {
        status = error_bad_start(&work, error);
        goto done;
    }
    if (system->n_free > 0)
        status = iterate(&work, monitor, error);
    if (status != ORB_OK)
        goto done;
    minimum->energy = work.energy;
    minimum->relative_gradient = work.relative;
    if (!(work.relative <= gradient_accepted))
        status = error_not_converged(&work, error);
    else
        memcpy(position, work.position, bytes);
done:
    free(work.position);
    minimiser_free(&work);
    return status;
}
