/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "columns.h"

#include <stdlib.h>

orb_status columns_create(orb_spread *spread, orb_monitor *monitor, orb_columns **result, orb_error *error) {
    orb_columns *columns = calloc(1, sizeof *columns);
    *result = columns;
    if (!columns)
        return error_memory(error);
    *columns = (orb_columns){spread, monitor, calloc((size_t)spread->mesh->n_vertices + 1, sizeof *columns->of)};
    return columns->of ? ORB_OK : error_memory(error);
}

void columns_free(orb_columns *columns) {
    if (!columns)
        return;
    for (int32_t v = 0; columns->of && v < columns->spread->mesh->n_vertices; v++)
        free(columns->of[v]);
    free(columns->of);
    free(columns);
}

/* The next ones that are missing, each once, with room for their columns; returns how many. -1: out of memory. */
static int32_t gather(orb_columns *columns, int32_t n, const int32_t *vertex, int32_t *next,
                      int32_t gathered[SPREAD_BLOCK]) {
    const size_t room = (size_t)columns->spread->mesh->n_vertices + 1;
    int32_t found = 0;
    for (; *next < n && found < SPREAD_BLOCK; ++*next) {
        double **column = columns->of + vertex[*next];
        if (*column)
            continue;
        *column = malloc(room * sizeof **column);
        gathered[found++] = vertex[*next];
        if (!*column)
            return -1;
    }
    return found;
}

orb_status columns_require(orb_columns *columns, int32_t n, const int32_t *vertex, const char *stage, double from,
                           double to, orb_error *error) {
    orb_status status = ORB_OK;
    for (int32_t next = 0; next < n && status == ORB_OK;) {
        int32_t gathered[SPREAD_BLOCK];
        double *column[SPREAD_BLOCK];
        status = monitor_report(columns->monitor, stage, from + (to - from) * next / n, error);
        const int32_t found = status == ORB_OK ? gather(columns, n, vertex, &next, gathered) : 0;
        if (found < 0)
            return error_memory(error);
        for (int32_t k = 0; k < found; k++)
            column[k] = columns->of[gathered[k]];
        if (found > 0)
            status = spread_columns(columns->spread, found, gathered, column, error);
    }
    return status;
}

void columns_keep(orb_columns *columns, const bool *wanted) {
    for (int32_t v = 0; v < columns->spread->mesh->n_vertices; v++)
        if (!wanted[v]) {
            free(columns->of[v]);
            columns->of[v] = NULL;
        }
}
