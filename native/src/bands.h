/* Rows of an image, by several threads. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_BANDS_H
#define ORB_BANDS_H

#include <stdint.h>

/* Does rows first <= y < last. */
typedef void (*orb_band)(void *user, int32_t first, int32_t last);

/* All rows, once each, by `threads` at most, of which the caller's is one; fewer where the system has no more. */
void bands_run(int32_t n_rows, int32_t threads, orb_band band, void *user);

#endif
