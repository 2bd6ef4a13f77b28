/* A fuzzer's bytes, one after the other, zeros after the last. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef BYTES_H
#define BYTES_H

#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

typedef struct fuzz_bytes {
    const uint8_t *at;
    size_t left;
} fuzz_bytes;

static inline uint8_t fuzz_byte(fuzz_bytes *bytes) { return bytes->left ? (bytes->left--, *bytes->at++) : 0; }

/* 0 <= . < limit, which is at most 65536. */
static inline int32_t fuzz_below(fuzz_bytes *bytes, int32_t limit) {
    int32_t value = fuzz_byte(bytes);
    if (limit > 256)
        value = 256 * value + fuzz_byte(bytes);
    return limit > 0 ? value % limit : 0;
}

/* Small numbers, and some that are hard to bear. */
static inline double fuzz_number(fuzz_bytes *bytes) {
    static const double hard[] = {0, -0.0, 1, 1e300, 1e-300, 1e12, 1e-12, -1e154, 5e-324, 1e-9};
    const uint8_t kind = fuzz_byte(bytes);
    if (kind < 10)
        return hard[kind];
    if (kind == 10)
        return (double)__builtin_nanf("");
    if (kind == 11)
        return (double)__builtin_inff();
    if (kind == 12) { /* any */
        double value;
        uint8_t raw[sizeof value];
        for (size_t k = 0; k < sizeof raw; k++)
            raw[k] = fuzz_byte(bytes);
        memcpy(&value, raw, sizeof value);
        return value;
    }
    return (kind - 134 + fuzz_byte(bytes) / 256.0) / 61;
}

#endif
