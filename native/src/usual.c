/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "usual.h"

#include <stdio.h>
#include <string.h>

enum { MOST_ORDER = 12, MOST_LUNE = 6 }; /* lunes get no better with their order */

static void add(orb_usual *usual, const char *text) {
    if (usual->n < USUAL_MOST)
        snprintf(usual->text[usual->n++], USUAL_TEXT, "%s", text);
}

/* A family: the pattern with every N replaced by each order from 2 to `most`. */
static void add_family(orb_usual *usual, const char *pattern, int most) {
    for (int order = 2; order <= most; order++) {
        char text[USUAL_TEXT] = "", digits[8];
        snprintf(digits, sizeof digits, order < 10 ? "%d" : "(%d)", order);
        for (const char *p = pattern; *p; p++) {
            const size_t used = strlen(text);
            snprintf(text + used, sizeof text - used, "%.*s", *p == 'N' ? (int)strlen(digits) : 1,
                     *p == 'N' ? digits : p);
        }
        add(usual, text);
    }
}

static void add_all(orb_usual *usual, const char *const *texts) {
    for (; *texts; texts++)
        add(usual, *texts);
}

static void add_sphere(orb_usual *usual) {
    static const char *const few[] = {"442", "333", "632", "2222", "432", "532", "332", "237", "334", "444", NULL};
    static const char *const many[] = {"22222", "222222", "22222222", NULL};
    add_all(usual, few);
    add_family(usual, "22N", MOST_ORDER);
    add_family(usual, "NN", MOST_LUNE);
    usual->n_sure = usual->n;
    add_all(usual, many);
}

static void add_disk(orb_usual *usual) {
    static const char *const few[] = {"*442", "*333", "*632", "*2222", "*432", "*532", "*332", "*237",
                                      "*334", "*444", "4*2",  "3*3",   "2*22", "22*",  "3*2",  NULL};
    add_all(usual, few);
    add_family(usual, "*22N", MOST_ORDER);
    add_family(usual, "*NN", MOST_LUNE);
    add_family(usual, "2*N", MOST_ORDER);
    add_family(usual, "N*", MOST_ORDER);
    usual->n_sure = usual->n;
}

orb_usual usual_signatures(const orb_mesh *mesh, int32_t n_mirrors) {
    orb_usual usual = {0};
    const int32_t symbols = mesh->genus + n_mirrors;
    if (mesh->orientable && mesh->genus == 0 && n_mirrors <= 1) {
        (n_mirrors == 0 ? add_sphere : add_disk)(&usual);
    } else if (!mesh->orientable && mesh->genus == 1 && n_mirrors == 0) {
        add(&usual, "22x");
        add_family(&usual, "Nx", MOST_ORDER);
        usual.n_sure = usual.n;
    } else if (symbols < USUAL_TEXT) { /* no cones are needed */
        char text[USUAL_TEXT] = "";
        memset(text, mesh->orientable ? 'o' : '*', (size_t)symbols);
        if (mesh->orientable)
            memset(text + mesh->genus, '*', (size_t)n_mirrors);
        else
            memset(text + n_mirrors, 'x', (size_t)mesh->genus);
        add(&usual, text);
        usual.n_sure = usual.n;
    }
    return usual;
}
