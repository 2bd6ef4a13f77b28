/* The cones of a signature as slots to be filled with sites. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_SLOTS_H
#define ORB_SLOTS_H

#include <math.h>

#include "ground.h"

typedef struct orb_slot {
    int32_t order;
    double charge; /* of each of its cones: 2 pi (1 - 1/n), on a mirror half as much */
    int32_t kind;  /* of its site */
} orb_slot;

/* Slots of one kind and order can be exchanged. */
static inline bool slots_alike(const orb_slot *a, const orb_slot *b) {
    return a->order == b->order && a->kind == b->kind;
}

#endif
