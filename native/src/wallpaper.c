/* Motions and a tile -> where each texel comes from. SPDX-License-Identifier: GPL-3.0-or-later */
#include "wallpaper.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bands.h"
#include "coverage.h"
#include "error.h"
#include "texels.h"

enum { CORNERS = 64, AROUND = 2 };
static const double whole_number = 1e-6;               /* what a place in texels may be off one */
static const double stretched = 1.2;                   /* from where on one point does not stand for a texel */
static const double generic[2] = {0.213731, 0.137127}; /* on no centre and no mirror */

/* --- footprints --------------------------------------------------------------------------------------------------- */

static void nearest_kept(const orb_wallpaper *paper, const double at[2], orb_footprint *footprint) {
    const int32_t x = wallpaper_floor(at[0] + 0.5), y = wallpaper_floor(at[1] + 0.5);
    double least = INFINITY;
    for (int32_t row = y - REACH; row <= y + REACH; row++)
        for (int32_t column = x - REACH; column <= x + REACH; column++) {
            const size_t texel = (size_t)wallpaper_wrap(row, paper->height) * (size_t)paper->width +
                                 (size_t)wallpaper_wrap(column, paper->width);
            const double distance = hypot(column - at[0], row - at[1]);
            if (wallpaper_keeps(paper, texel) && distance < least) {
                least = distance;
                *footprint = (orb_footprint){.n = 1, .texel = {texel}, .weight = {1}};
            }
        }
}

/* Adds the kept texels around a point, and for others, `depth` times over, those around the point of the tile that they
 * are a copy of. The weights add up to 1; false: there are none. */
static bool add_parts(const orb_wallpaper *paper, const double at[2], int depth, orb_footprint *footprint) {
    const orb_stencil stencil = wallpaper_stencil(paper, at);
    const int32_t first = footprint->n;
    float sum = 0;
    for (int c = 0; c < 4; c++) {
        const size_t texel = stencil.texel[c];
        const int32_t own = footprint->n;
        const float weight = stencil.weight[c];
        if (weight <= 0)
            continue;
        if (wallpaper_keeps(paper, texel)) {
            footprint->texel[footprint->n] = texel;
            footprint->weight[footprint->n++] = 1;
        } else if (depth > 0 && paper->to_tile[texel] != NO_MOVE) {
            const int32_t x = (int32_t)(texel % (size_t)paper->width), y = (int32_t)(texel / (size_t)paper->width);
            double there[2];
            wallpaper_move(&paper->moves[paper->to_tile[texel]], x, y, there);
            add_parts(paper, there, depth - 1, footprint);
        }
        if (footprint->n == own)
            continue;
        sum += weight;
        for (int32_t k = own; k < footprint->n; k++)
            footprint->weight[k] *= weight;
    }
    for (int32_t k = first; k < footprint->n; k++)
        footprint->weight[k] /= sum;
    return footprint->n > first;
}

void wallpaper_footprint(const orb_wallpaper *paper, const orb_move *move, int32_t x, int32_t y,
                         orb_footprint *footprint) {
    double middle[2];
    int32_t n = 0;
    footprint->n = 0;
    wallpaper_move(move, x, y, middle);
    for (int32_t k = 0; k < move->n_samples; k++) {
        const double at[2] = {middle[0] + move->sample[k][0], middle[1] + move->sample[k][1]};
        n += add_parts(paper, at, DEPTH, footprint);
    }
    if (n == 0)
        nearest_kept(paper, middle, footprint);
    for (int32_t k = 0; k < footprint->n && n > 1; k++)
        footprint->weight[k] /= (float)n;
}

/* --- the tile ----------------------------------------------------------------------------------------------------- */

/* The part of a convex polygon where normal . p <= offset. */
static int clip(int n, double corner[CORNERS][2], const double normal[2], double offset) {
    double kept[CORNERS][2];
    int n_kept = 0;
    for (int k = 0; k < n && n_kept < CORNERS - 1; k++) {
        const double *p = corner[k], *q = corner[(k + 1) % n];
        const double at_p = normal[0] * p[0] + normal[1] * p[1] - offset;
        const double at_q = normal[0] * q[0] + normal[1] * q[1] - offset;
        if (at_p <= 0)
            memcpy(kept[n_kept++], p, sizeof *kept);
        if ((at_p < 0 && at_q > 0) || (at_p > 0 && at_q < 0)) {
            const double t = at_p / (at_p - at_q);
            kept[n_kept][0] = p[0] + t * (q[0] - p[0]);
            kept[n_kept++][1] = p[1] + t * (q[1] - p[1]);
        }
    }
    memcpy(corner, kept, (size_t)n_kept * sizeof *kept);
    return n_kept;
}

/* The Dirichlet domain of a generic point, in the metric that the motions keep. */
static void mark_domain(const orb_wallpaper *paper, uint8_t *tile) {
    double corner[CORNERS][2] = {{-1, -1}, {2, -1}, {2, 2}, {-1, 2}};
    double metric[3] = {0, 0, 0}, uv[6 * CORNERS];
    int n = 4;
    for (int32_t k = 0; k < paper->order; k++) {
        const orb_motion m = paper->motions[k];
        metric[0] += m.a * m.a + m.d * m.d;
        metric[1] += m.a * m.b + m.d * m.e;
        metric[2] += m.b * m.b + m.e * m.e;
    }
    for (int32_t k = 0; k < paper->order; k++)
        for (int shift = 0; shift < (2 * AROUND + 1) * (2 * AROUND + 1); shift++) {
            const orb_motion m = paper->motions[k];
            const double there[2] = {
                m.a * generic[0] + m.b * generic[1] + m.c + shift % (2 * AROUND + 1) - AROUND,
                m.d * generic[0] + m.e * generic[1] + m.f + shift / (2 * AROUND + 1) - AROUND,
            };
            const double to[2] = {there[0] - generic[0], there[1] - generic[1]};
            const double normal[2] = {metric[0] * to[0] + metric[1] * to[1], metric[1] * to[0] + metric[2] * to[1]};
            const double middle[2] = {(there[0] + generic[0]) / 2, (there[1] + generic[1]) / 2};
            if (hypot(to[0], to[1]) > 1e-9 && n > 0)
                n = clip(n, corner, normal, normal[0] * middle[0] + normal[1] * middle[1]);
        }
    for (int k = 1; k + 1 < n; k++) {
        const double *of[3] = {corner[0], corner[k], corner[k + 1]};
        for (int c = 0; c < 3; c++)
            memcpy(uv + 6 * (k - 1) + 2 * c, of[c], sizeof corner[0]);
    }
    coverage_mark(paper->width, paper->height, n - 2, uv, tile);
}

/* --- where texels come from --------------------------------------------------------------------------------------- */

typedef struct orb_sorting {
    orb_wallpaper *paper;
    uint8_t *tile; /* becomes one texel of those that whole moves take to one another */
} orb_sorting;

/* Whether a texel is the first of those that whole moves take it to, so that one thread looks at them. */
static bool is_first(const orb_wallpaper *paper, int32_t x, int32_t y) {
    const size_t texel = (size_t)y * (size_t)paper->width + (size_t)x;
    for (int32_t k = 1; k < paper->order; k++)
        if (paper->moves[k].whole && wallpaper_moved(paper, &paper->moves[k], x, y) < texel)
            return false;
    return true;
}

static void keep_one(void *user, int32_t first, int32_t last) {
    const orb_sorting *sorting = user;
    const orb_wallpaper *paper = sorting->paper;
    for (int32_t y = first; y < last; y++)
        for (int32_t x = 0; x < paper->width; x++) {
            const size_t texel = (size_t)y * (size_t)paper->width + (size_t)x;
            if (!is_first(paper, x, y))
                continue;
            size_t chosen = sorting->tile[texel] ? texel : SIZE_MAX;
            for (int32_t k = 1; k < paper->order; k++) {
                const size_t other = paper->moves[k].whole ? wallpaper_moved(paper, &paper->moves[k], x, y) : texel;
                if (chosen == SIZE_MAX && sorting->tile[other])
                    chosen = other;
                sorting->tile[other] = 0;
            }
            if (chosen != SIZE_MAX || paper->exact)
                sorting->tile[chosen != SIZE_MAX ? chosen : texel] = 1;
        }
}

/* How much of a texel a move takes onto the tile. */
static float share(const orb_sorting *sorting, int32_t move, int32_t x, int32_t y) {
    const orb_wallpaper *paper = sorting->paper;
    double at[2];
    if (paper->moves[move].whole)
        return sorting->tile[wallpaper_moved(paper, &paper->moves[move], x, y)];
    wallpaper_move(&paper->moves[move], x, y, at);
    const orb_stencil stencil = wallpaper_stencil(paper, at);
    float sum = 0;
    for (int c = 0; c < 4; c++)
        sum += stencil.weight[c] * sorting->tile[stencil.texel[c]];
    return sum;
}

/* How far from the tile a move takes a texel, within REACH; else infinite. */
static double gap(const orb_sorting *sorting, int32_t move, int32_t x, int32_t y) {
    const orb_wallpaper *paper = sorting->paper;
    double at[2], least = INFINITY;
    wallpaper_move(&paper->moves[move], x, y, at);
    const int32_t column = wallpaper_floor(at[0] + 0.5), row = wallpaper_floor(at[1] + 0.5);
    for (int32_t j = row - REACH; j <= row + REACH; j++)
        for (int32_t i = column - REACH; i <= column + REACH; i++) {
            const size_t texel = (size_t)wallpaper_wrap(j, paper->height) * (size_t)paper->width +
                                 (size_t)wallpaper_wrap(i, paper->width);
            if (sorting->tile[texel])
                least = fmin(least, hypot(i - at[0], j - at[1]));
        }
    return least;
}

/* The move that takes a texel onto the tile, most of it if not all. The tip of a tile may have no texel's middle: then
 * the one that takes it nearest. */
static uint16_t best_move(const orb_sorting *sorting, int32_t x, int32_t y) {
    const orb_wallpaper *paper = sorting->paper;
    uint16_t best = NO_MOVE;
    float most = 0;
    double least = INFINITY;
    for (int32_t k = 1; k < paper->order; k++) {
        const float own = share(sorting, k, x, y);
        if (own > most) {
            most = own;
            best = (uint16_t)k;
        }
    }
    for (int32_t k = 1; k < paper->order && most == 0; k++) {
        const double own = gap(sorting, k, x, y);
        if (own < least) {
            least = own;
            best = (uint16_t)k;
        }
    }
    return best;
}

static void find_moves(void *user, int32_t first, int32_t last) {
    const orb_sorting *sorting = user;
    const orb_wallpaper *paper = sorting->paper;
    uint16_t move = 1;
    for (int32_t y = first; y < last; y++)
        for (int32_t x = 0; x < paper->width; x++) {
            const size_t texel = (size_t)y * (size_t)paper->width + (size_t)x;
            if (sorting->tile[texel]) {
                paper->to_tile[texel] = 0;
                continue;
            }
            if (move == NO_MOVE || move >= paper->order || share(sorting, move, x, y) < 0.9999f)
                move = best_move(sorting, x, y); /* else that of the texel before */
            paper->to_tile[texel] = move;
        }
}

/* A texel is taken to a parallelogram: how much it is stretched along the direction in which that is most. */
static void place_samples(orb_move *move) {
    const orb_motion m = move->between;
    const double along = m.a * m.a + m.d * m.d, across = m.b * m.b + m.e * m.e, skew = m.a * m.b + m.d * m.e;
    const double half = (along + across) / 2, spread = hypot((along - across) / 2, skew);
    const double turn = atan2(skew, (along - across) / 2) / 2, length = sqrt(half + spread);
    const double x = cos(turn) / 4, y = sin(turn) / 4;
    move->n_samples = length > stretched ? 2 : 1;
    for (int k = 0; k < move->n_samples && length > stretched; k++) {
        move->sample[k][0] = (k ? 1 : -1) * (m.a * x + m.b * y);
        move->sample[k][1] = (k ? 1 : -1) * (m.d * x + m.e * y);
    }
}

static orb_move between_texels(orb_motion m, int32_t width, int32_t height) {
    const double w = width, h = height;
    const double entry[6] = {m.a,         m.b * w / h, w * (m.c + m.a / (2 * w) + m.b / (2 * h)) - 0.5,
                             m.d * h / w, m.e,         h * (m.f + m.d / (2 * w) + m.e / (2 * h)) - 0.5};
    orb_move move = {.whole = true};
    memcpy(&move.between, entry, sizeof move.between);
    for (int k = 0; k < 6; k++) {
        move.whole = move.whole && fabs(entry[k] - round(entry[k])) < whole_number;
        move.texels[k] = (int32_t)lround(entry[k]);
    }
    place_samples(&move);
    return move;
}

static orb_status prepare(orb_wallpaper *paper, int32_t n_triangles, const double *uv, int32_t threads,
                          orb_error *error) {
    const size_t n = (size_t)paper->width * (size_t)paper->height, order = (size_t)paper->order;
    uint8_t *tile = calloc(n, 1);
    paper->moves = malloc(order * sizeof *paper->moves);
    paper->to_tile = malloc(n * sizeof *paper->to_tile);
    if (!tile || !paper->moves || !paper->to_tile) {
        free(tile);
        return error_memory(error);
    }
    paper->exact = true;
    for (size_t k = 0; k < order; k++) {
        paper->moves[k] = between_texels(paper->motions[k], paper->width, paper->height);
        paper->exact = paper->exact && paper->moves[k].whole;
    }
    if (n_triangles > 0)
        coverage_mark(paper->width, paper->height, n_triangles, uv, tile);
    else
        mark_domain(paper, tile);
    orb_sorting sorting = {paper, tile};
    bands_run(paper->height, threads, keep_one, &sorting);
    bands_run(paper->height, threads, find_moves, &sorting);
    free(tile);
    return ORB_OK;
}

orb_status orb_wallpaper_create(int32_t width, int32_t height, int32_t n_motions, const double *motions,
                                int32_t n_triangles, const double *uv, int32_t threads, orb_wallpaper **wallpaper,
                                orb_error *error) {
    if (!wallpaper || n_motions < 0 || (n_motions > 0 && !motions) || n_triangles < 0 || (n_triangles > 0 && !uv))
        return error_set(error, ORB_BAD_ARGUMENT, "a count is negative, or an array is missing");
    *wallpaper = NULL;
    if (width < 1 || height < 1 || width > MOST_SIDE || height > MOST_SIDE)
        return error_set(error, ORB_BAD_ARGUMENT, "an image of %d x %d texels: a side has 1 to %d", (int)width,
                         (int)height, MOST_SIDE);
    orb_wallpaper *paper = calloc(1, sizeof *paper);
    if (!paper)
        return error_memory(error);
    paper->width = width;
    paper->height = height;
    orb_status status = motions_of(n_motions, motions, &paper->order, &paper->motions, error);
    if (status == ORB_OK)
        status = prepare(paper, n_triangles, uv, threads, error);
    if (status != ORB_OK) {
        orb_wallpaper_free(paper);
        return status;
    }
    *wallpaper = paper;
    return error_set(error, ORB_OK, "%s", "");
}

void orb_wallpaper_free(orb_wallpaper *wallpaper) {
    if (!wallpaper)
        return;
    free(wallpaper->motions);
    free(wallpaper->moves);
    free(wallpaper->to_tile);
    free(wallpaper);
}

orb_wallpaper_view orb_wallpaper_look(const orb_wallpaper *wallpaper) {
    return (orb_wallpaper_view){wallpaper->order, wallpaper->exact, &wallpaper->motions->a, wallpaper->to_tile};
}
