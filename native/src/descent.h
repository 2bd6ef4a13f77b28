/* From good sites to better ones nearby. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * With u the present log scale, the form's derivative is known at every vertex: moving cone c to d changes the value by
 *     2 s_c (h(d) - h(c)) + s_c^2 |g_d - g_c|_W^2,    h = k_0 + sum_i s_i k_i.
 * The last term, a dipole's, is about e^2 log(1/e) / 4 pi at distance e on a surface of area one. So each cone is offered the
 * best vertex within a radius by this estimate; then its column tells the exact value, and the move is made or the radius
 * halved. All descents run side by side: their columns are solved for in blocks, and many coincide. */
#ifndef ORB_DESCENT_H
#define ORB_DESCENT_H

#include "columns.h"
#include "slots.h"

typedef struct orb_descent {
    int32_t n_slots;
    const orb_slot *slots;
    orb_site *sites; /* [n_slots] in and out */
    bool *pinned;    /* [n_slots] stays where it is */
    double *radius;  /* [n_slots] the first one, in the mesh's unit */
    double value;    /* out: the form's value and the penalties */
    bool close;      /* out: only neighbours are looked at by now */
    bool done;       /* out */
} orb_descent;

orb_status descent_run(const orb_ground *ground, orb_columns *columns, int32_t n, orb_descent *descents,
                       orb_error *error);

#endif
