/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_SELECT_H
#define ORB_SELECT_H

#include <stdint.h>

/* The k-th smallest of n numbers, k from 0; reorders them (Hoare 1961). Linear on average. 0 for n = 0. */
double select_kth(double *numbers, int32_t n, int32_t k);

typedef struct select_item {
    double value, weight;
} select_item;

/* The smallest value that, with all below it, has at least this weight (the median, for half of all); reorders the
 * items. Linear on average. 0 for n = 0. */
double select_weighted(select_item *items, int32_t n, double weight);

#endif
