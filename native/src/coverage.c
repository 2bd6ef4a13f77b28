/* Triangles -> texels, row by row. SPDX-License-Identifier: GPL-3.0-or-later */
#include "coverage.h"

#include <math.h>
#include <string.h>

static int32_t wrapped(int64_t value, int32_t size) {
    const int32_t left = (int32_t)(value % size);
    return left < 0 ? left + size : left;
}

/* The part of row y, in texels, that lies in a triangle: from *low to *high. */
static void span(const double corner[3][2], double y, double *low, double *high) {
    *low = INFINITY;
    *high = -INFINITY;
    for (int c = 0; c < 3; c++) {
        const double *p = corner[c], *q = corner[(c + 1) % 3];
        if ((p[1] < y && q[1] < y) || (p[1] > y && q[1] > y))
            continue;
        for (int end = 0; end < 2; end++) {
            const double t = p[1] == q[1] ? end : (y - p[1]) / (q[1] - p[1]);
            const double x = p[0] + t * (q[0] - p[0]);
            *low = fmin(*low, x);
            *high = fmax(*high, x);
        }
    }
}

/* What is written, of an image: one of the two arrays. */
typedef struct coverage_canvas {
    int32_t width, height;
    bool repeats;
    uint8_t *covered;
    int32_t *number;
} coverage_canvas;

static void draw(const coverage_canvas *canvas, int32_t triangle, const double corner[3][2]) {
    const double least = fmin(fmin(corner[0][1], corner[1][1]), corner[2][1]);
    const double most = fmax(fmax(corner[0][1], corner[1][1]), corner[2][1]);
    for (int64_t y = (int64_t)ceil(least); y <= (int64_t)floor(most); y++) {
        double low, high;
        span(corner, (double)y, &low, &high);
        if (!(low <= high) || (!canvas->repeats && (y < 0 || y >= canvas->height)))
            continue;
        const size_t row = (size_t)wrapped(y, canvas->height) * (size_t)canvas->width;
        for (int64_t x = (int64_t)ceil(low); x <= (int64_t)floor(high); x++) {
            if (!canvas->repeats && (x < 0 || x >= canvas->width))
                continue;
            if (canvas->covered)
                canvas->covered[row + (size_t)wrapped(x, canvas->width)] = 1;
            else
                canvas->number[row + (size_t)wrapped(x, canvas->width)] = triangle;
        }
    }
}

static void draw_all(const coverage_canvas *canvas, int32_t n_triangles, const double *uv) {
    for (int32_t t = 0; t < n_triangles; t++) {
        double corner[3][2];
        double farthest = 0;
        for (int c = 0; c < 3; c++) {
            const double u = uv[6 * (size_t)t + 2 * (size_t)c], v = uv[6 * (size_t)t + 2 * (size_t)c + 1];
            farthest = isfinite(u + v) ? fmax(farthest, fmax(fabs(u), fabs(v))) : INFINITY;
            corner[c][0] = u * canvas->width - 0.5; /* middles of texels are whole numbers */
            corner[c][1] = v * canvas->height - 0.5;
        }
        if (farthest <= MOST_PERIODS)
            draw(canvas, t, (const double(*)[2])corner);
    }
}

void coverage_mark(int32_t width, int32_t height, int32_t n_triangles, const double *uv, uint8_t *covered) {
    draw_all(&(coverage_canvas){width, height, true, covered, NULL}, n_triangles, uv);
}

void coverage_number(int32_t width, int32_t height, bool repeats, int32_t n_triangles, const double *uv,
                     int32_t *number) {
    for (size_t k = 0; k < (size_t)width * (size_t)height; k++)
        number[k] = -1;
    draw_all(&(coverage_canvas){width, height, repeats, NULL, number}, n_triangles, uv);
}
