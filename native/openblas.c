/* Two things that Debian's OpenBLAS (0.3.21, serial) lacks. The linker puts these functions in between (--wrap); the
 * names are its own. SPDX-License-Identifier: GPL-3.0-or-later */
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

/* --- a lock ------------------------------------------------------------------------------------------------------
 * Built without threads it hands out its work buffers without a lock: two threads of the program that are both in BLAS
 * can get the same buffer, and wrong numbers (tests/native/test_threads.c). The lock is held while a buffer is handed
 * over, not while it is worked with. Buffers belong to the process, and so does their lock. */

void *__real_blas_memory_alloc(int position);
void __real_blas_memory_free(void *buffer);
void *__wrap_blas_memory_alloc(int position);
void __wrap_blas_memory_free(void *buffer);

static pthread_mutex_t buffers = PTHREAD_MUTEX_INITIALIZER;

void *__wrap_blas_memory_alloc(int position) {
    pthread_mutex_lock(&buffers);
    void *buffer = __real_blas_memory_alloc(position);
    pthread_mutex_unlock(&buffers);
    return buffer;
}

void __wrap_blas_memory_free(void *buffer) {
    pthread_mutex_lock(&buffers);
    __real_blas_memory_free(buffer);
    pthread_mutex_unlock(&buffers);
}

/* --- the kernels for this processor ------------------------------------------------------------------------------
 * On a processor that is newer than itself it takes kernels of 2004 (PRESCOTT). When it asks whether the user has named
 * a processor, it is told one with the same instructions; it asks once, as the library is loaded. */

char *__real_getenv(const char *name);
char *__wrap_getenv(const char *name);

char *__wrap_getenv(const char *name) {
    char *value = __real_getenv(name);
#if defined(__x86_64__)
    static char wide[] = "SkylakeX", narrow[] = "Haswell";
    if (value || strcmp(name, "OPENBLAS_CORETYPE") != 0)
        return value;
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
        return wide;
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
        return narrow;
#endif
    return value;
}
