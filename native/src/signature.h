/* Conway's notation -> orders, Euler characteristic, curvature. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_SIGNATURE_H
#define ORB_SIGNATURE_H

#include "error.h"

typedef struct orb_signature {
    int32_t n_cones;   /* orders before the first mirror */
    int32_t n_corners; /* orders after it */
    int32_t n_mirrors, n_crosscaps, n_handles;
    int32_t *orders;   /* [n_cones + n_corners] */
    int32_t curvature; /* sign of the Euler characteristic, from exact integers */
    double euler;
    char *text; /* normalised: "442", "22(12)" */
} orb_signature;

/* Errors: ORB_BAD_SIGNATURE with the position, ORB_BAD_ORDER, ORB_BAD_ORBIFOLD (MN with M != N, or one cone). */
orb_status signature_parse(const char *text, orb_signature **signature, orb_error *error);
void signature_free(orb_signature *signature);

/* A sphere with cones and nothing else: what this version embeds. */
bool signature_is_supported(const orb_signature *signature);

/* The orders of the cones as they were picked: `orders` (may be NULL: the signature's own sequence) must be a
 * permutation of the signature's. Errors: ORB_UNSUPPORTED_SIGNATURE, ORB_CONE_COUNT, ORB_BAD_ORDER. */
orb_status signature_match(const orb_signature *signature, int32_t n_cones, const int32_t *orders,
                           int32_t *matched /* [n_cones] */, orb_error *error);

#endif
