/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sides.h"

#include <float.h>
#include <math.h>

static const double pi = 3.14159265358979323846;

double sides_double_area(const double length[3]) {
    double a = length[0], b = length[1], c = length[2], swap;
    if (a < b)
        swap = a, a = b, b = swap;
    if (b < c)
        swap = b, b = c, c = swap;
    if (a < b)
        swap = a, a = b, b = swap;
    const double excess = c - (a - b); /* the parentheses of this and the next line are Kahan's, and matter */
    return excess > 8 * DBL_EPSILON * a ? 0.5 * sqrt((a + (b + c)) * excess * (c + (a - b)) * (a + (b - c))) : 0;
}

double sides_dot(const double length[3], int c) {
    const double a = length[c], b = length[(c + 1) % 3], d = length[(c + 2) % 3];
    /* (b^2 + d^2 - a^2) / 2 without squares that cancel: with the longer of b and d called b,
     * b^2 - a^2 = (b - a) (b + a). */
    return b > d ? 0.5 * ((b - a) * (b + a) + d * d) : 0.5 * ((d - a) * (d + a) + b * b);
}

bool sides_angles(const double length[3], double angle[3], double cotangent[3]) {
    const double area = sides_double_area(length);
    if (!(area > 0))
        return false;
    int longest = length[1] > length[0] ? 1 : 0;
    if (length[2] > length[longest])
        longest = 2;
    for (int c = 0; c < 3; c++) {
        const double dot = sides_dot(length, c);
        angle[c] = atan2(area, dot);
        cotangent[c] = dot / area;
    }
    angle[longest] = pi - angle[(longest + 1) % 3] - angle[(longest + 2) % 3]; /* so that they add up to pi */
    return true;
}
