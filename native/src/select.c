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
