/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "select.h"

double select_kth(double *numbers, int32_t n, int32_t k) {
    int32_t low = 0, high = n - 1;
    if (n <= 0)
        return 0;
    while (low < high) {
        double pivot = numbers[low + (high - low) / 2];
        int32_t i = low, j = high;
        while (i <= j) {
            while (numbers[i] < pivot)
                i++;
            while (pivot < numbers[j])
                j--;
            if (i <= j) {
                double swap = numbers[i];
                numbers[i++] = numbers[j];
                numbers[j--] = swap;
            }
        }
        if (k <= j)
            high = j;
        else if (k >= i)
            low = i;
        else
            break;
    }
    return numbers[k];
}

double select_weighted(select_item *items, int32_t n, double weight) {
    int32_t low = 0, high = n - 1;
    double pivot = 0;
    while (low <= high) { /* what lies before `low` has less than `weight` in all, and that was subtracted */
        pivot = items[low + (high - low) / 2].value;
        double smaller = 0, equal = 0;
        int32_t i = low, j = high;
        while (i <= j) {
            while (items[i].value < pivot)
                i++;
            while (pivot < items[j].value)
                j--;
            if (i <= j) {
                select_item swap = items[i];
                items[i++] = items[j];
                items[j--] = swap;
            }
        }
        for (int32_t k = low; k <= j; k++)
            smaller += items[k].weight;
        for (int32_t k = j + 1; k < i; k++)
            equal += items[k].weight;
        if (smaller >= weight) {
            high = j;
        } else if (smaller + equal >= weight) {
            break;
        } else {
            weight -= smaller + equal;
            low = i;
        }
    }
    return pivot;
}
