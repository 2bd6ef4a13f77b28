/* Reproducible random numbers for tests. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef RANDOM_H
#define RANDOM_H

#include <stdint.h>

typedef struct random_state {
    uint64_t word;
} random_state;

/* Uniform in [0, 1); Steele, Lea and Flood 2014 (splitmix64). */
static inline double random_unit(random_state *state) {
    uint64_t z = (state->word += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) / 9007199254740992.0;
}

static inline int32_t random_below(random_state *state, int32_t n) { return (int32_t)(random_unit(state) * n); }

#endif
