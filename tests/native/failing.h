/* Allocations that fail on demand. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * For programs linked with --wrap=malloc and so on (native/Makefile), so that those of CHOLMOD and UMFPACK count too. */
#ifndef FAILING_H
#define FAILING_H

#include <stddef.h>

static long allocations, failing = -1; /* so far; the number of the one that fails, -1: none does */

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *old, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *old, size_t size);

void *__wrap_malloc(size_t size) { return allocations++ == failing ? NULL : __real_malloc(size); }
void *__wrap_calloc(size_t count, size_t size) { return allocations++ == failing ? NULL : __real_calloc(count, size); }
void *__wrap_realloc(void *old, size_t size) { return allocations++ == failing ? NULL : __real_realloc(old, size); }

#endif
