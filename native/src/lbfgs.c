/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "lbfgs.h"

#include <stdlib.h>
#include <string.h>

orb_status lbfgs_create(int32_t n, orb_lbfgs **result, orb_error *error) {
    *result = NULL;
    orb_lbfgs *memory = calloc(1, sizeof *memory);
    if (!memory)
        return error_memory(error);
    memory->n = n;
    for (int i = 0; i < LBFGS_PAIRS; i++) {
        memory->step[i] = malloc(((size_t)n + 1) * sizeof(double complex));
        memory->change[i] = malloc(((size_t)n + 1) * sizeof(double complex));
        if (!memory->step[i] || !memory->change[i]) {
            lbfgs_free(memory);
            return error_memory(error);
        }
    }
    *result = memory;
    return ORB_OK;
}

void lbfgs_free(orb_lbfgs *memory) {
    if (!memory)
        return;
    for (int i = 0; i < LBFGS_PAIRS; i++) {
        free(memory->step[i]);
        free(memory->change[i]);
    }
    free(memory);
}

void lbfgs_forget(orb_lbfgs *memory) { memory->count = 0; }

double lbfgs_dot(int32_t n, const double complex *a, const double complex *b) {
    double sum = 0;
    for (int32_t i = 0; i < n; i++)
        sum += creal(a[i]) * creal(b[i]) + cimag(a[i]) * cimag(b[i]);
    return sum;
}

static void add(int32_t n, double complex *a, double factor, const double complex *b) {
    for (int32_t i = 0; i < n; i++)
        a[i] += factor * b[i];
}

/* Where the pair of a given age is, 0 being the newest. */
static int32_t slot_of(const orb_lbfgs *memory, int32_t age) {
    return (memory->newest - age + LBFGS_PAIRS) % LBFGS_PAIRS;
}

void lbfgs_before(orb_lbfgs *memory, double complex *vector) {
    for (int32_t age = 0; age < memory->count; age++) {
        int32_t k = slot_of(memory, age);
        memory->weight[k] = lbfgs_dot(memory->n, memory->step[k], vector) / memory->curvature[k];
        add(memory->n, vector, -memory->weight[k], memory->change[k]);
    }
}

void lbfgs_after(orb_lbfgs *memory, double complex *vector) {
    for (int32_t age = memory->count - 1; age >= 0; age--) {
        int32_t k = slot_of(memory, age);
        double b = lbfgs_dot(memory->n, memory->change[k], vector) / memory->curvature[k];
        add(memory->n, vector, memory->weight[k] - b, memory->step[k]);
    }
}

void lbfgs_transport(orb_lbfgs *memory, const double complex *transport) {
    for (int32_t age = 0; age < memory->count; age++) {
        int32_t k = slot_of(memory, age);
        for (int32_t i = 0; i < memory->n; i++) {
            memory->step[k][i] *= transport[i];
            memory->change[k][i] *= transport[i];
        }
    }
}

void lbfgs_remember(orb_lbfgs *memory, const double complex *step, const double complex *old_gradient,
                    const double complex *new_gradient) {
    int32_t next = (memory->newest + 1) % LBFGS_PAIRS;
    for (int32_t i = 0; i < memory->n; i++) {
        memory->step[next][i] = step[i];
        memory->change[next][i] = new_gradient[i] - old_gradient[i];
    }
    double curvature = lbfgs_dot(memory->n, memory->step[next], memory->change[next]);
    if (!(curvature > 0))
        return;
    memory->curvature[next] = curvature;
    memory->newest = next;
    if (memory->count < LBFGS_PAIRS)
        memory->count++;
}
