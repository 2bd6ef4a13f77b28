/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "monitor.h"

#include <time.h>

orb_status monitor_report(orb_monitor *monitor, const char *stage, double fraction, orb_error *error) {
    if (fraction > monitor->reached)
        monitor->reached = fraction < 1 ? fraction : 1;
    if (monitor->progress && !monitor->progress(stage, monitor->reached, monitor->user))
        return error_set(error, ORB_CANCELLED, "cancelled");
    return ORB_OK;
}

double monitor_clock(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}
