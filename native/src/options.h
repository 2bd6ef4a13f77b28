/* A few sites among which the best are sought, and the spread's form between them. SPDX-License-Identifier:
 * GPL-3.0-or-later */
#ifndef ORB_OPTIONS_H
#define ORB_OPTIONS_H

#include "columns.h"
#include "ground.h"

typedef struct orb_option {
    orb_site site;
    int32_t kind;
    bool fixed;    /* has to be used */
    double linear; /* sum of k_0 over the site */
    double penalty;
} orb_option;

typedef struct orb_options {
    int32_t n, n_fixed; /* the fixed ones come first, the others by kind */
    orb_option *list;   /* [n] */
    double *form;       /* [n*n] sums of k_c(d), c in one site and d in the other */
    int32_t n_kinds;    /* 2 (loops + 1) */
    int32_t *first;     /* [n_kinds + 1] list[first[k]] and on are the free ones of kind k */
} orb_options;

/* count[kind] farthest points of each kind, as far as there are that many, besides the fixed vertices. */
orb_status options_create(const orb_ground *ground, orb_columns *columns, int32_t n_fixed, const int32_t *fixed,
                          const int32_t *count, orb_options **options, orb_error *error);
void options_free(orb_options *options);

#endif
