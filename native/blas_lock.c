/* OpenBLAS built without threads hands out its work buffers without a lock: two threads of the program that are both
 * in BLAS can get the same buffer, and wrong numbers (seen with Debian's 0.3.21; tests/native/test_threads.c). The
 * linker puts these two functions in between (--wrap). They hold the lock while a buffer is handed over, not while
 * it is worked with. SPDX-License-Identifier: GPL-3.0-or-later */
#include <pthread.h>

/* The names are the linker's. */
void *__real_blas_memory_alloc(int position);
void __real_blas_memory_free(void *buffer);
void *__wrap_blas_memory_alloc(int position);
void __wrap_blas_memory_free(void *buffer);

/* OpenBLAS's buffers belong to the process, and so does their lock. */
static pthread_mutex_t buffers = PTHREAD_MUTEX_INITIALIZER;

void *__wrap_blas_memory_alloc(int position)
{
    pthread_mutex_lock(&buffers);
    void *buffer = __real_blas_memory_alloc(position);
    pthread_mutex_unlock(&buffers);
    return buffer;
}

void __wrap_blas_memory_free(void *buffer)
{
    pthread_mutex_lock(&buffers);
    __real_blas_memory_free(buffer);
    pthread_mutex_unlock(&buffers);
}
