/* The best sites for the slots, among the options. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_ASSIGNMENT_H
#define ORB_ASSIGNMENT_H

#include "options.h"
#include "slots.h"

/* choice[n_slots]: the option of each slot, all different, every fixed one used, with the least value: the form plus the
 * penalties. Few slots: all choices are tried; many: greedily from several starts, then exchanged one by one and in pairs
 * until nothing is gained. `slots` of one kind are in the sequence in which a mirror's corners must lie along its loop, up
 * to where it starts and its direction. *value is infinite if there is no choice. Error: ORB_OUT_OF_MEMORY. */
orb_status assignment_find(const orb_ground *ground, const orb_options *options, double constant, int32_t n_slots,
                           const orb_slot *slots, int32_t *choice, double *value, orb_error *error);

/* Whether sites[n_slots] respect the sequence of corners along the loops. */
bool assignment_in_sequence(const orb_ground *ground, int32_t n_slots, const orb_slot *slots, const orb_site *sites);

#endif
