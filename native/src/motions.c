/* Generators -> a finite group modulo periods. SPDX-License-Identifier: GPL-3.0-or-later */
#include "motions.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"

enum {
    MOST_MOTIONS = 1024,
    PERIODS = 2,
    MOST_FACTOR = 1000
};                               /* a square with that many copies of a tile is no picture of it */
static const double same = 1e-4; /* beside a number with a small denominator it is that number: layouts are rounded */

/* Turns of periods are halves, and centres of turns lie at multiples of 1 / 24 in a layout that has a cone in its
 * corner. */
static double tidy(double value, double parts) {
    const double near = round(value * parts) / parts;
    return fabs(value - near) < same ? near : value;
}

static double fraction(double value) {
    const double left = value - floor(value);
    return left > 1 - 1e-9 ? 0 : left; /* a whole number, rounded down */
}

static orb_motion tidied(orb_motion m) {
    return (orb_motion){tidy(m.a, 2), tidy(m.b, 2), fraction(tidy(m.c, 24)),
                        tidy(m.d, 2), tidy(m.e, 2), fraction(tidy(m.f, 24))};
}

orb_motion motion_product(orb_motion first, orb_motion then) {
    return (orb_motion){
        then.a * first.a + then.b * first.d,          then.a * first.b + then.b * first.e,
        then.a * first.c + then.b * first.f + then.c, then.d * first.a + then.e * first.d,
        then.d * first.b + then.e * first.e,          then.d * first.c + then.e * first.f + then.f,
    };
}

static bool apart(double one, double other) {
    const double difference = fabs(one - other);
    return fmin(difference, fabs(1 - difference)) > same; /* of fractions */
}

static bool equal(orb_motion one, orb_motion other) {
    return fabs(one.a - other.a) < same && fabs(one.b - other.b) < same && fabs(one.d - other.d) < same &&
           fabs(one.e - other.e) < same && !apart(one.c, other.c) && !apart(one.f, other.f);
}

static bool keeps_area(orb_motion m) {
    const double most = fmax(fmax(fabs(m.a), fabs(m.b)), fmax(fabs(m.d), fabs(m.e)));
    return isfinite(m.a + m.b + m.c + m.d + m.e + m.f) && most <= MOST_FACTOR &&
           fabs(fabs(m.a * m.e - m.b * m.d) - 1) < same;
}

/* Elements that differ by a period are one, periods last: these classes go to one another when a generator, or a period,
 * is done before them. */
static orb_status list_classes(int32_t n_moves, const orb_motion *moves, int32_t *n_known, orb_motion *known,
                               orb_error *error) {
    known[0] = (orb_motion){1, 0, 0, 0, 1, 0};
    *n_known = 1;
    for (int32_t k = 0; k < *n_known; k++)
        for (int32_t move = 0; move < n_moves; move++) {
            const orb_motion product = tidied(motion_product(moves[move], known[k]));
            int32_t i = 0;
            while (i < *n_known && !equal(known[i], product))
                i++;
            if (i < *n_known)
                continue;
            if (*n_known == MOST_MOTIONS)
                return error_set(error, ORB_BAD_ARGUMENT,
                                 "the motions do not fit the image's period: the unit square has to be a period of "
                                 "their pattern");
            known[(*n_known)++] = product;
        }
    return ORB_OK;
}

orb_status motions_of(int32_t n_generators, const double *generators, int32_t *n_motions, orb_motion **motions,
                      orb_error *error) {
    orb_motion *moves = malloc(((size_t)n_generators + PERIODS) * sizeof *moves);
    orb_motion *known = malloc(MOST_MOTIONS * sizeof *known);
    orb_status status = moves && known ? ORB_OK : error_memory(error);
    for (int32_t k = 0; status == ORB_OK && k < n_generators; k++) {
        memcpy(&moves[k], generators + 6 * (size_t)k, sizeof moves[k]);
        if (!keeps_area(moves[k]))
            status =
                error_set(error, ORB_BAD_ARGUMENT, "motion %d does not keep areas: it is none of the plane", (int)k);
        else
            moves[k] = tidied(moves[k]);
    }
    if (status == ORB_OK) {
        moves[n_generators] = (orb_motion){1, 0, 1, 0, 1, 0};
        moves[n_generators + 1] = (orb_motion){1, 0, 0, 0, 1, 1};
        status = list_classes(n_generators + PERIODS, moves, n_motions, known, error);
    }
    free(moves);
    if (status != ORB_OK) {
        free(known);
        return status;
    }
    *motions = known;
    return ORB_OK;
}
