/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "triangle.h"

#include <float.h>
#include <stddef.h>

#include "vector3.h"

triangle_shape triangle_measure(const orb_mesh *mesh, int32_t triangle) {
    triangle_shape shape = {0};
    double largest = 0;
    for (int c = 0; c < 3; c++) {
        const double *p = mesh->vertices + 3 * (size_t)mesh->triangles[3 * (size_t)triangle + (size_t)c];
        const double *q = mesh->vertices + 3 * (size_t)mesh->triangles[3 * (size_t)triangle + (size_t)((c + 1) % 3)];
        for (int k = 0; k < 3; k++) {
            shape.edge[c][k] = 0.5 * q[k] - 0.5 * p[k]; /* halves, so that the difference cannot overflow */
            largest = fmax(largest, fabs(shape.edge[c][k]));
        }
    }
    if (largest == 0)
        return shape;
    const int exponent = ilogb(largest);
    const double factor = ldexp(1, exponent > -1000 ? -exponent : 1000); /* 2^1074 would not be a double */
    shape.scale = 0.5 * factor;
    int longest = 0;
    for (int c = 0; c < 3; c++) {
        for (int k = 0; k < 3; k++)
            shape.edge[c][k] *= factor;
        shape.length[c] = vector_length(shape.edge[c]);
        if (shape.length[c] > shape.length[longest])
            longest = c;
    }
    /* Of the three cross products that of the two shorter edges has the least rounding error. */
    const double *u = shape.edge[(longest + 1) % 3], *v = shape.edge[(longest + 2) % 3];
    double cross[3];
    vector_cross(u, v, cross);
    const double area = vector_length(cross);
    const double noise = 4 * DBL_EPSILON * shape.length[(longest + 1) % 3] * shape.length[(longest + 2) % 3];
    shape.double_area = area > noise ? area : 0;
    return shape;
}
