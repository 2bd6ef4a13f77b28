/* The caller's error record, filled. SPDX-License-Identifier: GPL-3.0-or-later */
#include "error.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

const char *orb_status_name(orb_status status) {
#define NAME(constant)                                                                                                 \
    case constant:                                                                                                     \
        return #constant
    switch (status) {
        NAME(ORB_OK);
        NAME(ORB_OUT_OF_MEMORY);
        NAME(ORB_CANCELLED);
        NAME(ORB_BAD_ARGUMENT);
        NAME(ORB_NON_FINITE);
        NAME(ORB_INDEX_OUT_OF_RANGE);
        NAME(ORB_DEGENERATE_TRIANGLE);
        NAME(ORB_REPEATED_TRIANGLE);
        NAME(ORB_NON_MANIFOLD_EDGE);
        NAME(ORB_NON_MANIFOLD_VERTEX);
        NAME(ORB_INCONSISTENT_ORIENTATION);
        NAME(ORB_SEVERAL_COMPONENTS);
        NAME(ORB_BOUNDARY);
        NAME(ORB_WRONG_GENUS);
        NAME(ORB_ZERO_AREA_TRIANGLE);
        NAME(ORB_BAD_SIGNATURE);
        NAME(ORB_BAD_ORDER);
        NAME(ORB_BAD_ORBIFOLD);
        NAME(ORB_UNSUPPORTED_SIGNATURE);
        NAME(ORB_CONE_COUNT);
        NAME(ORB_BAD_CONE);
        NAME(ORB_BAD_WEIGHT);
        NAME(ORB_CUT_BLOCKED);
        NAME(ORB_NOT_CONVERGED);
        NAME(ORB_CERTIFICATE_FAILED);
        NAME(ORB_LINEAR_SOLVER);
        NAME(ORB_NO_CORRESPONDENCE);
        NAME(ORB_POINT_NOT_FOUND);
    }
#undef NAME
    return "ORB_UNKNOWN_STATUS";
}

/* Writes the sentence. One that is too long loses its end, but never half a UTF-8 character, so that it can still
 * be decoded. */
static void write_message(orb_error *error, const char *format, va_list arguments) {
    const int needed = vsnprintf(error->message, sizeof error->message, format, arguments);
    if (needed < 0) {
        error->message[0] = '\0';
        return;
    }
    if ((size_t)needed < sizeof error->message)
        return;
    size_t end = strlen(error->message), start = end;
    while (start > 0 && ((unsigned char)error->message[start - 1] & 0xC0u) == 0x80u)
        start--;
    if (start == 0 || (unsigned char)error->message[start - 1] < 0x80u)
        return; /* it ends on an ASCII character */
    const unsigned char lead = (unsigned char)error->message[start - 1];
    const size_t length = lead >= 0xF0u ? 4 : lead >= 0xE0u ? 3 : 2;
    if (end - (start - 1) < length)
        error->message[start - 1] = '\0';
}

orb_status error_set(orb_error *error, orb_status status, const char *format, ...) {
    if (!error)
        return status;
    memset(error, 0, sizeof *error);
    error->status = status;
    va_list arguments;
    va_start(arguments, format);
    write_message(error, format, arguments);
    va_end(arguments);
    return status;
}

orb_status error_set_elements(orb_error *error, orb_status status, orb_element element, const int32_t *elements,
                              int32_t entries, int64_t found, const char *format, ...) {
    if (!error)
        return status;
    memset(error, 0, sizeof *error);
    error->status = status;
    error->element = element;
    error->n_elements = entries < ORB_MAX_ELEMENTS ? entries : ORB_MAX_ELEMENTS;
    error->n_found = found;
    for (int32_t i = 0; i < error->n_elements; i++)
        error->elements[i] = elements[i];
    va_list arguments;
    va_start(arguments, format);
    write_message(error, format, arguments);
    va_end(arguments);
    return status;
}

orb_status error_memory(orb_error *error) {
    return error_set(error, ORB_OUT_OF_MEMORY, "out of memory: close other programs or use a coarser mesh");
}

/* Inserts `width` entries into the ascending list of groups of that width, dropping the last group if it is full. */
static void found_insert(orb_found *found, const int32_t *group, int32_t width) {
    found->found++;
    int32_t at = found->entries;
    while (at > 0) {
        const int32_t *before = found->elements + at - width;
        if (before[0] < group[0] || (before[0] == group[0] && before[width - 1] <= group[width - 1]))
            break;
        at -= width;
    }
    if (at >= ORB_MAX_ELEMENTS)
        return;
    if (found->entries < ORB_MAX_ELEMENTS)
        found->entries += width;
    for (int32_t i = found->entries - 1; i >= at + width; i--)
        found->elements[i] = found->elements[i - width];
    for (int32_t i = 0; i < width; i++)
        found->elements[at + i] = group[i];
}

void found_add(orb_found *found, int32_t element) { found_insert(found, &element, 1); }

void found_add_edge(orb_found *found, int32_t vertex, int32_t other) {
    const int32_t edge[2] = {vertex < other ? vertex : other, vertex < other ? other : vertex};
    found_insert(found, edge, 2);
}
