/* The minimiser: derivatives, and the exact Hessian as the reference of the complex-linear part.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <complex.h>
#include <stdlib.h>

#include "check.h"
#include "embed.h"
#include "newton.h"

/* Gradient and Hessian of the assembled problem, against finite differences of its energy and gradient. */
static void check_derivatives(const char *signature, int32_t k) {
    random_state state = {7};
    sample_mesh mesh = sample_icosphere(2);
    int32_t cones[5];
    pick_cones(&state, mesh.n_vertices, k, cones);
    orb_embedding *embedding = NULL;
    orb_problem *problem = NULL;
    orb_system *system = NULL;
    orb_error error;
    REQUIRE(embed(&mesh, signature, k, cones, 0.01, &embedding, &error) == ORB_OK);
    REQUIRE(problem_of(embedding, &problem, &error) == ORB_OK);
    REQUIRE(system_create(problem, false, NULL, &system, &error) == ORB_OK);
    size_t n = (size_t)mesh.n_vertices, copies = (size_t)embedding->copies->n_copies;
    double complex *turn = malloc(copies * sizeof *turn), *along = calloc(n, sizeof *along);
    double complex *gradient[3];
    orb_point *moved = malloc(n * sizeof *moved), *placed = malloc(copies * sizeof *placed);
    double *scale = malloc(n * sizeof *scale), *rows = malloc(2 * n * sizeof *rows), relative, energy[3];
    for (size_t v = 0; v < n; v++) { /* start away from the minimum */
        double complex push = 0.05 * (random_unit(&state) - 0.5 + I * (random_unit(&state) - 0.5));
        if (problem->freedom[v] == 2)
            embedding->position[v] = geometry_exp(problem->geometry, embedding->position[v], push);
        along[v] = random_unit(&state) - 0.5 + I * (random_unit(&state) - 0.5);
        if (problem->freedom[v] == 1)
            along[v] = problem_direction(problem, (int32_t)v, embedding->position[v]);
        if (problem->freedom[v] == 0)
            along[v] = 0;
    }
    double step = 1e-5;
    for (int i = 0; i < 3; i++) {
        gradient[i] = malloc(n * sizeof **gradient);
        for (size_t v = 0; v < n; v++)
            moved[v] = geometry_exp(problem->geometry, embedding->position[v], (i - 1) * step * along[v]);
        problem_place(problem, moved, placed, turn);
        energy[i] = problem_energy(problem, placed, turn, moved, gradient[i], scale, &relative);
        if (i != 1)
            for (size_t v = 0; v < n; v++) /* back into the frame at the middle */
                gradient[i][v] *= geometry_transport(problem->geometry, moved[v], embedding->position[v]);
    }
    double slope = 0, curvature = 0, expected = 0;
    for (size_t v = 0; v < n; v++) {
        slope += creal(conj(along[v]) * gradient[1][v]);
        curvature += creal(conj(along[v]) * (gradient[2][v] - gradient[0][v])) / (2 * step);
    }
    CHECK_NEAR((energy[2] - energy[0]) / (2 * step), slope, 1e-6 * (1 + fabs(slope)));
    problem_place(problem, embedding->position, placed, turn);
    system_assemble(system, problem, embedding->position, placed, turn, HESSIAN_EXACT);
    system_gather(system, problem, embedding->position, along, rows);
    for (int64_t j = 0; j < system->pattern.n; j++)
        for (int64_t e = system->pattern.column[j]; e < system->pattern.column[j + 1]; e++)
            expected +=
                (system->pattern.row[e] == j ? 1 : 2) * rows[system->pattern.row[e]] * system->values[e] * rows[j];
    CHECK_NEAR(curvature, expected, 1e-5 * (1 + fabs(expected)));
    for (int i = 0; i < 3; i++)
        free(gradient[i]);
    free(turn), free(along), free(moved), free(placed), free(scale), free(rows);
    system_free(system);
    problem_free(problem);
    orb_embedding_free(embedding);
    sample_free(&mesh);
}

TEST(assembled_derivatives_against_finite_differences) {
    check_derivatives("442", 3);
    check_derivatives("432", 3);
    check_derivatives("237", 3);
    check_derivatives("22222", 5);
    check_derivatives("55", 2);
}

/* Pushes a certified embedding off its minimum and lets a system of the given kind find back. Returns the greatest
 * distance of a vertex from where it was. */
static double way_back(const orb_embedding *embedding, const orb_problem *problem, bool is_complex,
                       orb_minimum *minimum) {
    random_state state = {21};
    orb_error error;
    orb_system *system = NULL;
    orb_monitor monitor = {0};
    size_t n = (size_t)problem->n_vertices;
    orb_point *position = malloc(n * sizeof *position);
    int32_t *order = malloc(n * sizeof *order);
    double gap = INFINITY;
    for (size_t v = 0; v < n; v++) {
        double complex push = 0.02 * (random_unit(&state) - 0.5 + I * (random_unit(&state) - 0.5));
        position[v] = embedding->position[v];
        if (problem->freedom[v] == 2)
            position[v] = geometry_exp(problem->geometry, position[v], push);
    }
    if (system_create(problem, is_complex, NULL, &system, &error) == ORB_OK &&
        system_find_order(system, ORDERING_AMD, order, &error) == ORB_OK &&
        newton_minimise(problem, system, system->n_free, order, position, minimum, &monitor, &error) == ORB_OK) {
        gap = 0;
        for (size_t v = 0; v < n; v++)
            gap = fmax(gap, geometry_distance(problem->geometry, position[v], embedding->position[v]));
    }
    system_free(system);
    free(position);
    free(order);
    return gap;
}

static void check_both_systems(const char *signature, int32_t k) {
    random_state state = {17};
    sample_mesh mesh = sample_icosphere(3);
    int32_t cones[7];
    pick_cones(&state, mesh.n_vertices, k, cones);
    orb_embedding *embedding = NULL;
    orb_problem *problem = NULL;
    orb_error error;
    REQUIRE(embed(&mesh, signature, k, cones, 0.01, &embedding, &error) == ORB_OK);
    REQUIRE(problem_of(embedding, &problem, &error) == ORB_OK);
    orb_minimum exact = {0}, complex_part = {0};
    CHECK_NEAR(way_back(embedding, problem, false, &exact), 0, 1e-9);
    CHECK_NEAR(way_back(embedding, problem, true, &complex_part), 0, 1e-9);
    CHECK_NEAR(exact.energy / complex_part.energy, 1, 1e-12);
    CHECK_NEAR(exact.energy / embedding->report.energy, 1, 1e-12);
    CHECK(exact.iterations > 0 && exact.factorisations >= exact.iterations);
    problem_free(problem);
    orb_embedding_free(embedding);
    sample_free(&mesh);
}

TEST(exact_newton_and_the_complex_part_find_one_minimum) {
    check_both_systems("442", 3);
    check_both_systems("2222", 4);
    check_both_systems("432", 3);
    check_both_systems("22(5)", 3);
    check_both_systems("33", 2);
    check_both_systems("237", 3);
    check_both_systems("22222", 5);
}
