/* The columns of the spread's form that are in use. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_COLUMNS_H
#define ORB_COLUMNS_H

#include "monitor.h"
#include "spread.h"

typedef struct orb_columns {
    orb_spread *spread;
    orb_monitor *monitor;
    double **of; /* [n_vertices] k_v where it is known, else NULL */
} orb_columns;

orb_status columns_create(orb_spread *spread, orb_monitor *monitor, orb_columns **columns, orb_error *error);
void columns_free(orb_columns *columns);

/* Computes those of vertex[n] that are not there yet, reporting `stage` between blocks. */
orb_status columns_require(orb_columns *columns, int32_t n, const int32_t *vertex, const char *stage, double from,
                           double to, orb_error *error);

/* Drops all whose vertex is not wanted[n_vertices]. */
void columns_keep(orb_columns *columns, const bool *wanted);

#endif
