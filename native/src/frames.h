/* Copies that are made as triangles move from frame to frame. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_FRAMES_H
#define ORB_FRAMES_H

#include "holonomy.h"

typedef struct orb_frames orb_frames;

/* Starts from the given copies, which are only read; their triangles are not taken over. */
orb_status frames_create(const orb_geometry *geometry, const orb_copies *copies, int32_t n_vertices,
                         orb_frames **frames, orb_error *error);
void frames_free(orb_frames *frames);

/* The copies so far. They are the caller's to free (holonomy_free), after `frames`. */
orb_copies *frames_copies(orb_frames *frames);

/* `here` and `there` are copies of one vertex, which no element of the group fixes. *carried: the copy of `copy`'s
 * vertex that lies to `here` as `copy` lies to `there`, at element(here) element(there)^-1 element(copy). */
orb_status frames_carry(orb_frames *frames, int32_t here, int32_t there, int32_t copy, int32_t *carried,
                        orb_error *error);

/* *reflected: `copy` reflected in the mirror through `here`, whose vertex's own copy lies on the line of
 * `reflection`. */
orb_status frames_reflect(orb_frames *frames, int32_t here, orb_isometry reflection, int32_t copy, int32_t *reflected,
                          orb_error *error);

#endif
