/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pattern.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

typedef struct entry {
    int32_t row, pair;
} entry;

static int by_row(const void *a, const void *b) {
    int32_t x = ((const entry *)a)->row, y = ((const entry *)b)->row;
    return (x > y) - (x < y);
}

static bool is_entry(const int32_t *ends) { return ends[0] >= 0 && ends[1] >= 0 && ends[0] != ends[1]; }
static int32_t low_end(const int32_t *ends) { return ends[0] < ends[1] ? ends[0] : ends[1]; }

orb_status pattern_of_pairs(int32_t n, int32_t n_pairs, const int32_t *ends, orb_pattern *pattern, int64_t *slot,
                            orb_error *error) {
    size_t columns = (size_t)n, pairs = (size_t)n_pairs;
    orb_status status = error_memory(error);
    int64_t *start = calloc(columns + 2, sizeof *start);
    entry *entries = malloc((pairs + 1) * sizeof *entries);
    pattern->n = n;
    pattern->column = malloc((columns + 1) * sizeof *pattern->column);
    pattern->row = malloc((columns + pairs + 1) * sizeof *pattern->row);
    if (!start || !entries || !pattern->column || !pattern->row)
        goto done;
    for (size_t k = 0; k < pairs; k++)
        if (is_entry(ends + 2 * k))
            start[low_end(ends + 2 * k) + 2]++;
    for (size_t j = 2; j < columns + 2; j++) /* start[j + 1]: where column j begins; it moves on while it is filled */
        start[j] += start[j - 1];
    for (size_t k = 0; k < pairs; k++) {
        const int32_t *pair = ends + 2 * k;
        slot[k] = -1;
        if (is_entry(pair))
            entries[start[low_end(pair) + 1]++] = (entry){pair[0] < pair[1] ? pair[1] : pair[0], (int32_t)k};
    }
    int64_t filled = 0;
    for (size_t j = 0; j < columns; j++) {
        pattern->column[j] = filled;
        pattern->row[filled++] = (int32_t)j;
        qsort(entries + start[j], (size_t)(start[j + 1] - start[j]), sizeof *entries, by_row);
        for (int64_t k = start[j]; k < start[j + 1]; k++) {
            if (pattern->row[filled - 1] != entries[k].row)
                pattern->row[filled++] = entries[k].row;
            slot[entries[k].pair] = filled - 1;
        }
    }
    pattern->column[columns] = filled;
    status = ORB_OK;
done:
    free(start);
    free(entries);
    return status;
}

orb_status pattern_copy(const orb_pattern *pattern, orb_pattern *copy, orb_error *error) {
    size_t columns = (size_t)pattern->n + 1, entries = (size_t)pattern->column[pattern->n];
    *copy =
        (orb_pattern){pattern->n, malloc(columns * sizeof *copy->column), malloc((entries + 1) * sizeof *copy->row)};
    if (!copy->column || !copy->row) {
        pattern_clear(copy);
        return error_memory(error);
    }
    memcpy(copy->column, pattern->column, columns * sizeof *copy->column);
    memcpy(copy->row, pattern->row, entries * sizeof *copy->row);
    return ORB_OK;
}

void pattern_clear(orb_pattern *pattern) {
    free(pattern->column);
    free(pattern->row);
    *pattern = (orb_pattern){0};
}
