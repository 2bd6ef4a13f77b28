/* The signatures that are tried where none is asked for. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_USUAL_H
#define ORB_USUAL_H

#include "mesh.h"

enum { USUAL_TEXT = 32, USUAL_MOST = 64 };

typedef struct orb_usual {
    int32_t n, n_sure; /* the first ones; the others have many hyperbolic cones, and are worth their
                                            cost only where they promise more */
    char text[USUAL_MOST][USUAL_TEXT];
} orb_usual;

/* For a surface of the mesh's genus with so many mirrors. Sphere and disk: triangle groups, rectangles, and on a disk those
 * with cones inside. Other surfaces: what has the fewest cones. n = 0: handles or holes are too many to write down. */
orb_usual usual_signatures(const orb_mesh *mesh, int32_t n_mirrors);

#endif
