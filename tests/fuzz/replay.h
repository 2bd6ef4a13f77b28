/* A kept corpus, a line of hexadecimal digits for each input, through a fuzzer's target. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef REPLAY_H
#define REPLAY_H

#include <stdio.h>

#include "bytes.h"
#include "check.h"

/* The file is tests/fuzz/NAME of the checkout; the program may run in the checkout or in a folder of it. */
static inline void replay(const char *name, int (*target)(const uint8_t *data, size_t size)) {
    static const char *const folders[] = {"tests/fuzz/", "../tests/fuzz/", "../../tests/fuzz/"};
    static char line[4096];
    static uint8_t data[sizeof line / 2];
    FILE *file = NULL;
    int inputs = 0;
    for (size_t k = 0; k < sizeof folders / sizeof *folders && !file; k++) {
        char path[256];
        snprintf(path, sizeof path, "%s%s", folders[k], name);
        file = fopen(path, "r");
    }
    REQUIRE(file);
    while (fgets(line, sizeof line, file)) {
        size_t size = 0;
        unsigned byte;
        while (sscanf(line + 2 * size, "%2x", &byte) == 1)
            data[size++] = (uint8_t)byte;
        target(data, size);
        inputs++;
    }
    fclose(file);
    CHECK(inputs > 100);
}

#endif
