/* The texels of an image under a wallpaper group: which are kept, and where the others come from.
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_WALLPAPER_H
#define ORB_WALLPAPER_H

#include <stddef.h>

#include "motions.h"
#include "orbifold_images.h"

enum { NO_MOVE = 0xFFFF, MOST_SAMPLES = 2, DEPTH = 2, MOST_PARTS = MOST_SAMPLES * 4 * 4 * 4, REACH = 3 };

/* A motion between middles of texels, which are whole numbers. */
typedef struct orb_move {
    orb_motion between;
    bool whole;                     /* it takes texels to texels, */
    int32_t texels[6];              /* by the same numbers as `between` has */
    int32_t n_samples;              /* points of a texel that stand for it: one, or where it is stretched two */
    double sample[MOST_SAMPLES][2]; /* where they go from where its middle goes */
} orb_move;

struct orb_wallpaper {
    int32_t width, height, order;
    bool exact;
    orb_motion *motions; /* [order] of the unit square, the identity first */
    orb_move *moves;     /* [order] */
    uint16_t *to_tile;   /* [height*width] the move that takes the texel onto the tile; 0: there it is; NO_MOVE */
};

static inline bool wallpaper_keeps(const orb_wallpaper *paper, size_t texel) { return paper->to_tile[texel] == 0; }

/* Any whole number, not too far away -> the one of the image. */
static inline int32_t wallpaper_wrap(int32_t value, int32_t size) {
    if ((uint32_t)value < (uint32_t)size)
        return value;
    const int32_t left = value % size;
    return left < 0 ? left + size : left;
}

/* Where a move takes a texel. */
static inline void wallpaper_move(const orb_move *move, int32_t x, int32_t y, double to[2]) {
    const orb_motion *m = &move->between;
    to[0] = m->a * x + m->b * y + m->c;
    to[1] = m->d * x + m->e * y + m->f;
}

/* To which texel a whole move takes a texel. */
static inline size_t wallpaper_moved(const orb_wallpaper *paper, const orb_move *move, int32_t x, int32_t y) {
    const int32_t *m = move->texels;
    const int32_t column = wallpaper_wrap(m[0] * x + m[1] * y + m[2], paper->width);
    const int32_t row = wallpaper_wrap(m[3] * x + m[4] * y + m[5], paper->height);
    return (size_t)row * (size_t)paper->width + (size_t)column;
}

/* The four texels around a point between middles of texels, and their parts of it. */
typedef struct orb_stencil {
    size_t texel[4];
    float weight[4];
} orb_stencil;

static inline int32_t wallpaper_floor(double value) {
    const int32_t cut = (int32_t)value;
    return cut - (value < cut);
}

static inline orb_stencil wallpaper_stencil(const orb_wallpaper *paper, const double at[2]) {
    const int32_t x = wallpaper_floor(at[0]), y = wallpaper_floor(at[1]);
    const float u = (float)(at[0] - x), v = (float)(at[1] - y);
    const size_t left = (size_t)wallpaper_wrap(x, paper->width), right = (size_t)wallpaper_wrap(x + 1, paper->width);
    const size_t below = (size_t)wallpaper_wrap(y, paper->height) * (size_t)paper->width;
    const size_t above = (size_t)wallpaper_wrap(y + 1, paper->height) * (size_t)paper->width;
    return (orb_stencil){{below + left, below + right, above + left, above + right},
                         {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v}};
}

/* Of a texel that a move takes onto the tile, the parts of the tile's texels; where it takes it to none, the nearest of
 * them, within REACH, and else n is 0. The weights add up to 1. */
typedef struct orb_footprint {
    int32_t n;
    size_t texel[MOST_PARTS];
    float weight[MOST_PARTS];
} orb_footprint;
void wallpaper_footprint(const orb_wallpaper *paper, const orb_move *move, int32_t x, int32_t y,
                         orb_footprint *footprint);

#endif
