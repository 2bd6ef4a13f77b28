/* Conway's notation -> orders, Euler characteristic, curvature. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_SIGNATURE_H
#define ORB_SIGNATURE_H

#include "error.h"

typedef struct orb_signature {
    int32_t n_cones;   /* orders before the first mirror */
    int32_t n_corners; /* orders after it */
    int32_t n_mirrors, n_crosscaps, n_handles;
    int32_t *orders;       /* [n_cones + n_corners] */
    int32_t *mirror_start; /* [n_mirrors + 1] the corners of mirror m are orders[mirror_start[m]] and on */
    int32_t curvature;     /* sign of the Euler characteristic, from exact integers */
    double euler;
    char *text; /* normalised: "442", "22(12)", "3*22" */
} orb_signature;

/* Errors: ORB_BAD_SIGNATURE with the position, ORB_BAD_ORDER, ORB_BAD_ORBIFOLD (MN or *MN with M != N, N or *N). */
orb_status signature_parse(const char *text, orb_signature **signature, orb_error *error);
void signature_free(orb_signature *signature);

static inline int32_t signature_corners(const orb_signature *s, int32_t mirror) {
    return s->mirror_start[mirror + 1] - s->mirror_start[mirror];
}

/* All but the sphere, the hemisphere * and the projective plane x without cones, which nothing holds in place. */
bool signature_is_supported(const orb_signature *signature);
/* ORB_UNSUPPORTED_SIGNATURE, saying so. */
orb_status signature_refuse(const orb_signature *signature, orb_error *error);

/* The same with `extra` more mirrors without corners. */
orb_status signature_with_mirrors(const orb_signature *signature, int32_t extra, orb_signature **result,
                                  orb_error *error);

#endif
