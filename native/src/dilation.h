/* The dilation that two opposite cones leave free. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * On a sphere with two cones NN, or a lune *NN, the conformal map is unique only up to z -> e^s z in the chart that has the
 * two at 0 and infinity; at height log |z| it scales areas by (cosh(height) / cosh(height + s))^2. */
#ifndef ORB_DILATION_H
#define ORB_DILATION_H

#include "embedding.h"

bool dilation_is_free(const orb_signature *signature);

/* log cosh x, for any x. */
double dilation_log_cosh(double x);

/* s for which the weighted variance of base - 2 log cosh(height + s) is least; arrays [n], weights >= 0. */
double dilation_of_least_spread(int32_t n, const double *weight, const double *base, const double *height);

/* Moves embedding->position by the dilation of least spread of log area; one must be free. The copies have to be placed
 * anew. Error: ORB_OUT_OF_MEMORY. */
orb_status dilation_choose(orb_embedding *embedding, orb_error *error);

#endif
