/* Limited-memory BFGS on tangent vectors. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Nocedal 1980; pairs (step, change of gradient) are carried along by parallel transport. The first approximation of
 * the inverse Hessian is the caller's. */
#ifndef ORB_LBFGS_H
#define ORB_LBFGS_H

#include <complex.h>

#include "error.h"

enum { LBFGS_PAIRS = 5 };

typedef struct orb_lbfgs {
    int32_t n;             /* tangent vectors have n complex entries */
    int32_t count, newest; /* pairs kept, and where the newest is */
    double complex *step[LBFGS_PAIRS], *change[LBFGS_PAIRS];
    double curvature[LBFGS_PAIRS]; /* <step, change> > 0 */
    double weight[LBFGS_PAIRS];    /* scratch between the two halves of the recursion */
} orb_lbfgs;

orb_status lbfgs_create(int32_t n, orb_lbfgs **memory, orb_error *error);
void lbfgs_free(orb_lbfgs *memory);
void lbfgs_forget(orb_lbfgs *memory);

/* The two halves of the recursion; between them the caller applies the first approximation. From the newest pair to
 * the oldest, then from the oldest to the newest. */
void lbfgs_before(orb_lbfgs *memory, double complex *vector);
void lbfgs_after(orb_lbfgs *memory, double complex *vector);

/* Turns all that is kept into the frames of the new point: transport[n] are phases. */
void lbfgs_transport(orb_lbfgs *memory, const double complex *transport);

/* Keeps a pair, dropping the oldest; refused where <step, change> is not positive. */
void lbfgs_remember(orb_lbfgs *memory, const double complex *step, const double complex *old_gradient,
                    const double complex *new_gradient);

/* Re <a, b> */
double lbfgs_dot(int32_t n, const double complex *a, const double complex *b);

#endif
