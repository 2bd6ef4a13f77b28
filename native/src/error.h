/* The caller's error record, filled. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_ERROR_H
#define ORB_ERROR_H

#include "orbifold.h"

/* Clears the record, writes the status and the sentence, and returns the status: `return error_set(error, ...)`.
 * `error` may be NULL. The format is printf's. */
__attribute__((format(printf, 3, 4))) orb_status error_set(orb_error *error, orb_status status, const char *format,
                                                           ...);

/* As error_set, and names the elements: `entries` int32 (an edge takes two), of which the first ORB_MAX_ELEMENTS are
 * kept in the order given; `found` counts the offending elements in all. */
__attribute__((format(printf, 7, 8))) orb_status error_set_elements(orb_error *error, orb_status status,
                                                                    orb_element element, const int32_t *elements,
                                                                    int32_t entries, int64_t found, const char *format,
                                                                    ...);

/* Elements found at fault, in any sequence: the least ORB_MAX_ELEMENTS entries are kept, ascending (edges by lower
 * vertex, then higher), and all are counted. Start from {0}; use one record for one kind of element. */
typedef struct orb_found {
    int32_t entries; /* used in `elements`; an edge takes two */
    int32_t elements[ORB_MAX_ELEMENTS];
    int64_t found;
} orb_found;
void found_add(orb_found *found, int32_t element);
void found_add_edge(orb_found *found, int32_t vertex, int32_t other);

/* "out of memory" with its status; the usual last line of a failed allocation. */
orb_status error_memory(orb_error *error);

#endif
