/* Threads that each take a band of rows. SPDX-License-Identifier: GPL-3.0-or-later */
#include "bands.h"

#include <pthread.h>
#include <stdbool.h>

enum { MOST_THREADS = 16, LEAST_ROWS = 16 };

typedef struct band_task {
    pthread_t thread;
    orb_band band;
    void *user;
    int32_t first, last;
    bool running;
} band_task;

static void *band_thread(void *user) {
    band_task *task = user;
    task->band(task->user, task->first, task->last);
    return NULL;
}

void bands_run(int32_t n_rows, int32_t threads, orb_band band, void *user) {
    band_task task[MOST_THREADS];
    int32_t n = n_rows / LEAST_ROWS;
    n = n < threads ? n : threads;
    n = n < MOST_THREADS ? n : MOST_THREADS;
    n = n > 1 ? n : 1;
    for (int32_t k = 0; k < n; k++) {
        const int32_t first = (int32_t)((int64_t)n_rows * k / n), last = (int32_t)((int64_t)n_rows * (k + 1) / n);
        task[k] = (band_task){.band = band, .user = user, .first = first, .last = last};
        task[k].running = k > 0 && pthread_create(&task[k].thread, NULL, band_thread, &task[k]) == 0;
    }
    for (int32_t k = 0; k < n; k++)
        if (!task[k].running)
            band(user, task[k].first, task[k].last);
    for (int32_t k = 0; k < n; k++)
        if (task[k].running)
            pthread_join(task[k].thread, NULL);
}
