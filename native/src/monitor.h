/* Progress, cancel and time of one run. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_MONITOR_H
#define ORB_MONITOR_H

#include "error.h"

typedef struct orb_monitor {
    orb_progress progress; /* may be NULL */
    void *user;
    double reached; /* the fraction last reported; it never falls */
} orb_monitor;

/* Reports; ORB_CANCELLED if the caller wants no more. */
orb_status monitor_report(orb_monitor *monitor, const char *stage, double fraction, orb_error *error);

/* Seconds since some fixed time. */
double monitor_clock(void);

#endif
