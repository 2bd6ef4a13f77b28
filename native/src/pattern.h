/* Pairs of unknowns -> the lower triangle of a symmetric matrix. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_PATTERN_H
#define ORB_PATTERN_H

#include "error.h"

/* By columns, row indices ascending, the diagonal entry first in its column. */
typedef struct orb_pattern {
    int64_t n;
    int64_t *column; /* [n+1] */
    int32_t *row;    /* [column[n]] row >= column */
} orb_pattern;

/* ends[n_pairs*2]: two unknowns in [0, n), or negative for none. slot[n_pairs]: the entry below the diagonal that a
 * pair belongs to (pairs of the same two unknowns share one); -1 where an end is none or both are the same. */
orb_status pattern_of_pairs(int32_t n, int32_t n_pairs, const int32_t *ends, orb_pattern *pattern, int64_t *slot,
                            orb_error *error);
orb_status pattern_copy(const orb_pattern *pattern, orb_pattern *copy, orb_error *error);
void pattern_clear(orb_pattern *pattern);

#endif
