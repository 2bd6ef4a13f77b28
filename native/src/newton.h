/* Minimises the energy of a problem. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * One loop for the three geometries. A step solves with a Cholesky factor of the Hessian and is taken along geodesics,
 * shortened until the energy falls. With a complex system the factor is that of the Hessian's complex-linear part
 * (system.h), kept over many steps, and limited-memory BFGS supplies the rest; in the plane that part is the whole
 * Hessian and the first step is exact. With a real system the exact Hessian is factored at each step: slower, and what
 * the first is checked against. */
#ifndef ORB_NEWTON_H
#define ORB_NEWTON_H

#include "monitor.h"
#include "system.h"

typedef struct orb_minimum {
    int32_t iterations;  /* steps that lowered the energy by more than its rounding */
    int32_t refinements; /* steps after those, for the last digits of the gradient */
    int32_t factorisations;
    double energy, relative_gradient;
    int64_t factor_nonzeros;
    double seconds_assemble, seconds_analyze, seconds_factor, seconds_solve;
} orb_minimum;

/* `position` [n_vertices] holds the start and receives the minimiser; fixed vertices stay. `order` [n_order]
 * is a fill-reducing ordering of at least the vertices that have rows. On failure `position` is as it was.
 * Errors: ORB_NOT_CONVERGED, ORB_CANCELLED, and the linear solver's. */
orb_status newton_minimise(const orb_problem *problem, orb_system *system, int32_t n_order, const int32_t *order,
                           orb_point *position, orb_minimum *minimum, orb_monitor *monitor, orb_error *error);

#endif
