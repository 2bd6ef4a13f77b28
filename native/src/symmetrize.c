/* An image -> one that a wallpaper group leaves as it is. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Where copies differ from what follows from the tile the tile becomes their mean, or what was painted on them; then all
 * copies follow from the tile. In an image that is invariant already nothing differs: it stays as it is, to the bit. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bands.h"
#include "error.h"
#include "texels.h"
#include "wallpaper.h"

enum { MARGIN = 12 };
static const float enough = 1e-3f; /* of a texel that is painted: then it is */

/* A part of a row, from a column on and around the image. */
typedef struct orb_strip {
    int32_t row, column, length;
    size_t first; /* number of its first texel of the tile, of all strips */
} orb_strip;

typedef struct orb_painting {
    const orb_wallpaper *paper;
    orb_image image;
    const uint8_t *painted; /* [texels] or NULL: all */
    int32_t area[4];        /* where that counts: column, row, width, height */
    uint8_t *differs;       /* [area] what is painted there from what follows from the tile; NULL: all moves are whole,
                               so that this is one texel */
    orb_strip *strips;      /* of all that may change, box by box: boxes may overlap, so their turns come one by one */
    int32_t n_boxes, *box;  /* [n_boxes + 1] the first strip of each */
    const orb_strip *turn;  /* the first strip of the box whose turn it is */
    float *changed;         /* [n_changed][channels] the texels of the tile in strips */
    size_t n_changed;
    uint8_t *touched; /* [texels] of the tile, that something was painted on, or on a copy; NULL: all are */
} orb_painting;

/* The loops below, compiled for each kind of image: `kind` is the image without size. */
#define OF_EACH_KIND(loop)                                                                                             \
    static void loop(void *user, int32_t first, int32_t last) {                                                        \
        const orb_painting *work = user;                                                                               \
        orb_image kind = work->image;                                                                                  \
        if (kind.channels != 4)                                                                                        \
            loop##_of(work, first, last, kind);                                                                        \
        else if (kind.texel == ORB_TEXEL_UINT8)                                                                        \
            loop##_of(work, first, last, (orb_image){0, 0, 4, ORB_TEXEL_UINT8, kind.pixels});                          \
        else if (kind.texel == ORB_TEXEL_UINT16)                                                                       \
            loop##_of(work, first, last, (orb_image){0, 0, 4, ORB_TEXEL_UINT16, kind.pixels});                         \
        else                                                                                                           \
            loop##_of(work, first, last, (orb_image){0, 0, 4, ORB_TEXEL_FLOAT, kind.pixels});                          \
    }

/* --- texels ------------------------------------------------------------------------------------------------------- */

static inline size_t texel_at(const orb_wallpaper *paper, int32_t row, int32_t column) {
    return (size_t)row * (size_t)paper->width + (size_t)column;
}

static inline size_t strip_texel(const orb_wallpaper *paper, const orb_strip *strip, int32_t k) {
    return texel_at(paper, strip->row, wallpaper_wrap(strip->column + k, paper->width));
}

/* What a texel that is not of the tile is by the tile, where it goes to the inside of the tile, as nearly all do. */
ALWAYS_INLINE bool follow_inside(const orb_wallpaper *paper, orb_image image, const orb_move *move, int32_t x,
                                 int32_t y, float value[MOST_CHANNELS]) {
    const uint32_t last_column = (uint32_t)paper->width - 1, last_row = (uint32_t)paper->height - 1;
    double middle[2];
    float sum[MOST_CHANNELS] = {0, 0, 0, 0};
    wallpaper_move(move, x, y, middle);
    for (int32_t k = 0; k < move->n_samples; k++) {
        const double at[2] = {middle[0] + move->sample[k][0], middle[1] + move->sample[k][1]};
        const int32_t left = wallpaper_floor(at[0]), below = wallpaper_floor(at[1]);
        const uint32_t column = (uint32_t)wallpaper_wrap(left, paper->width);
        const uint32_t row = (uint32_t)wallpaper_wrap(below, paper->height);
        const size_t texel = (size_t)row * (size_t)paper->width + column, above = texel + (size_t)paper->width;
        const float u = (float)(at[0] - left), v = (float)(at[1] - below);
        float corner[4][MOST_CHANNELS];
        uint32_t pair[2];
        if (column == last_column || row == last_row)
            return false;
        memcpy(pair, paper->to_tile + texel, sizeof pair[0]);
        memcpy(pair + 1, paper->to_tile + above, sizeof pair[1]);
        if (pair[0] | pair[1])
            return false;
        load(&image, texel, corner[0]);
        load(&image, texel + 1, corner[1]);
        load(&image, above, corner[2]);
        load(&image, above + 1, corner[3]);
        for (int c = 0; c < image.channels; c++) {
            const float lower = corner[0][c] + u * (corner[1][c] - corner[0][c]);
            const float upper = corner[2][c] + u * (corner[3][c] - corner[2][c]);
            sum[c] += lower + v * (upper - lower);
        }
    }
    for (int c = 0; c < image.channels; c++)
        value[c] = kept(&image, move->n_samples > 1 ? sum[c] / (float)move->n_samples : sum[c]);
    return true;
}

/* What any texel that is not of the tile is by the tile; false: the tile is not near. */
ALWAYS_INLINE bool follow(const orb_wallpaper *paper, orb_image image, const orb_move *move, int32_t x, int32_t y,
                          float value[MOST_CHANNELS]) {
    orb_footprint footprint;
    float one[MOST_CHANNELS], sum[MOST_CHANNELS] = {0, 0, 0, 0};
    if (follow_inside(paper, image, move, x, y, value))
        return true;
    wallpaper_footprint(paper, move, x, y, &footprint);
    for (int32_t k = 0; k < footprint.n; k++) {
        load(&image, footprint.texel[k], one);
        for (int c = 0; c < image.channels; c++)
            sum[c] += footprint.weight[k] * one[c];
    }
    for (int c = 0; c < image.channels; c++)
        value[c] = kept(&image, sum[c]);
    return footprint.n > 0;
}

/* --- from copies to the tile -------------------------------------------------------------------------------------- */

/* The number in the area of a texel that counts as painted, or -1. */
static inline int64_t painted_at(const orb_painting *work, size_t texel) {
    const orb_wallpaper *paper = work->paper;
    if (!work->painted)
        return (int64_t)texel;
    if (!work->painted[texel])
        return -1;
    const int32_t column = (int32_t)(texel % (size_t)paper->width) - work->area[0];
    const int32_t row = (int32_t)(texel / (size_t)paper->width) - work->area[1];
    const bool inside = column >= 0 && row >= 0 && column < work->area[2] && row < work->area[3];
    return inside ? (int64_t)row * work->area[2] + column : -1;
}

ALWAYS_INLINE bool equal(orb_image image, const float one[MOST_CHANNELS], const float other[MOST_CHANNELS]) {
    bool same = true;
    for (int c = 0; c < image.channels; c++)
        same = same && one[c] == other[c];
    return same;
}

ALWAYS_INLINE void find_differences_of(const orb_painting *work, int32_t first, int32_t last, orb_image image) {
    const orb_wallpaper *paper = work->paper;
    for (int32_t y = first; y < last; y++)
        for (int32_t x = 0; x < work->area[2]; x++) {
            const int32_t row = work->area[1] + y, column = work->area[0] + x;
            const size_t texel = texel_at(paper, row, column);
            uint8_t *differs = work->differs + (size_t)y * (size_t)work->area[2] + (size_t)x;
            float own[MOST_CHANNELS], follows[MOST_CHANNELS];
            *differs = 0;
            if (painted_at(work, texel) < 0 || paper->to_tile[texel] == 0 || paper->to_tile[texel] == NO_MOVE)
                continue;
            const orb_move *move = &paper->moves[paper->to_tile[texel]];
            load(&image, texel, own);
            *differs = follow(paper, image, move, column, row, follows) && !equal(image, own, follows);
        }
}
OF_EACH_KIND(find_differences)

/* What copies of a texel of the tile say of it. */
typedef struct orb_sum {
    float value[MOST_CHANNELS], weight;
    bool differs;
} orb_sum;

ALWAYS_INLINE void add_painted(const orb_painting *work, orb_image image, size_t texel, float weight,
                               const float own[MOST_CHANNELS], orb_sum *sum) {
    const int64_t number = weight > 0 ? painted_at(work, texel) : -1;
    float value[MOST_CHANNELS];
    if (number < 0)
        return;
    load(&image, texel, value);
    sum->differs = sum->differs || (work->differs ? work->differs[number] != 0 : !equal(image, value, own));
    sum->weight += weight;
    for (int c = 0; c < image.channels; c++)
        sum->value[c] += weight * value[c];
}

/* The sum of what is painted of a texel of the tile and of its copies. What is painted on the tile itself comes first,
 * for painting spills a little over its border. */
ALWAYS_INLINE orb_sum painted_of(const orb_painting *work, orb_image image, int32_t x, int32_t y,
                                 const float own[MOST_CHANNELS]) {
    const orb_wallpaper *paper = work->paper;
    orb_sum sum = {{0, 0, 0, 0}, 0, false};
    add_painted(work, image, texel_at(paper, y, x), 1, own, &sum);
    sum.differs = false;
    if (sum.weight > 0 && work->painted)
        return sum;
    for (int32_t k = 1; k < paper->order; k++) {
        const orb_move *move = &paper->moves[k];
        double at[2];
        if (move->whole) {
            add_painted(work, image, wallpaper_moved(paper, move, x, y), 1, own, &sum);
            continue;
        }
        wallpaper_move(move, x, y, at);
        const orb_stencil stencil = wallpaper_stencil(paper, at);
        for (int c = 0; c < 4; c++)
            add_painted(work, image, stencil.texel[c], stencil.weight[c], own, &sum);
    }
    return sum;
}

ALWAYS_INLINE void change_tile_of(const orb_painting *work, int32_t first, int32_t last, orb_image image) {
    const orb_wallpaper *paper = work->paper;
    for (const orb_strip *strip = work->turn + first; strip < work->turn + last; strip++) {
        float *changed = work->changed + strip->first * (size_t)image.channels;
        for (int32_t k = 0; k < strip->length; k++) {
            const int32_t column = wallpaper_wrap(strip->column + k, paper->width);
            const size_t texel = texel_at(paper, strip->row, column);
            float own[MOST_CHANNELS];
            if (!wallpaper_keeps(paper, texel))
                continue;
            load(&image, texel, own);
            const orb_sum sum = painted_of(work, image, column, strip->row, own);
            const float all = fmaxf(sum.weight, 1); /* where less than a texel is painted the rest is as it was */
            for (int c = 0; c < image.channels; c++) {
                const float mean = (sum.value[c] + (all - sum.weight) * own[c]) / all;
                *changed++ = sum.differs ? kept(&image, mean) : own[c];
            }
            if (work->touched && sum.weight > enough)
                work->touched[texel] = 1;
        }
    }
}
OF_EACH_KIND(change_tile)

ALWAYS_INLINE void write_tile_of(const orb_painting *work, int32_t first, int32_t last, orb_image image) {
    for (const orb_strip *strip = work->turn + first; strip < work->turn + last; strip++) {
        const float *changed = work->changed + strip->first * (size_t)image.channels;
        for (int32_t k = 0; k < strip->length; k++) {
            const size_t texel = strip_texel(work->paper, strip, k);
            if (work->paper->to_tile[texel] != 0)
                continue;
            store(&image, texel, changed);
            changed += image.channels;
        }
    }
}
OF_EACH_KIND(write_tile)

/* --- from the tile to the copies ---------------------------------------------------------------------------------- */

/* Whether a copy follows from something that was painted on. */
static bool is_touched(const orb_painting *work, const orb_move *move, int32_t x, int32_t y) {
    orb_footprint footprint;
    if (!work->touched)
        return true;
    wallpaper_footprint(work->paper, move, x, y, &footprint);
    for (int32_t k = 0; k < footprint.n; k++)
        if (work->touched[footprint.texel[k]])
            return true;
    return false;
}

ALWAYS_INLINE void write_copies_of(const orb_painting *work, int32_t first, int32_t last, orb_image image) {
    const orb_wallpaper *paper = work->paper;
    const size_t bytes = texel_bytes(&image);
    char *pixels = image.pixels;
    for (const orb_strip *strip = work->turn + first; strip < work->turn + last; strip++)
        for (int32_t k = 0; k < strip->length; k++) {
            const int32_t column = wallpaper_wrap(strip->column + k, paper->width);
            const size_t texel = texel_at(paper, strip->row, column);
            const uint16_t number = paper->to_tile[texel];
            float value[MOST_CHANNELS];
            if (number == 0 || number == NO_MOVE)
                continue;
            const orb_move *move = &paper->moves[number];
            const size_t source = move->whole ? wallpaper_moved(paper, move, column, strip->row) : texel;
            if (wallpaper_keeps(paper, source)) {
                if (!work->touched || work->touched[source])
                    memcpy(pixels + texel * bytes, pixels + source * bytes, bytes);
                continue;
            }
            if (is_touched(work, move, column, strip->row) && follow(paper, image, move, column, strip->row, value))
                store(&image, texel, value);
        }
}
OF_EACH_KIND(write_copies)

/* --- what may change ---------------------------------------------------------------------------------------------- */

/* The rows and columns that a move takes the area to, in *box as column, row, width, height. */
static void moved_area(const orb_painting *work, int32_t move, int32_t box[4]) {
    const orb_wallpaper *paper = work->paper;
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int corner = 0; corner < 4; corner++) {
        double at[2];
        wallpaper_move(&paper->moves[move], work->area[0] + (corner & 1 ? work->area[2] - 1 : 0),
                       work->area[1] + (corner & 2 ? work->area[3] - 1 : 0), at);
        for (int axis = 0; axis < 2; axis++) {
            low[axis] = fmin(low[axis], at[axis]);
            high[axis] = fmax(high[axis], at[axis]);
        }
    }
    const int32_t size[2] = {paper->width, paper->height};
    for (int axis = 0; axis < 2; axis++) {
        const double from = floor(low[axis]) - MARGIN, length = ceil(high[axis]) + MARGIN + 1 - from;
        const bool all = length >= size[axis];
        box[axis] = all ? 0 : wallpaper_wrap((int32_t)from, size[axis]);
        box[2 + axis] = all ? size[axis] : (int32_t)length;
    }
}

/* Strips of the moved areas. An area under the inverse of a move is one under another move. */
static orb_status list_strips(orb_painting *work, orb_error *error) {
    const orb_wallpaper *paper = work->paper;
    const bool whole = work->area[2] == paper->width && work->area[3] == paper->height;
    int64_t n = 0;
    int32_t box[4], n_strips = 0;
    work->n_boxes = whole ? 1 : paper->order;
    for (int32_t move = 0; move < work->n_boxes; move++) {
        moved_area(work, move, box);
        n += box[3];
    }
    work->strips = n < INT32_MAX ? malloc(((size_t)n + 1) * sizeof *work->strips) : NULL;
    work->box = malloc(((size_t)work->n_boxes + 1) * sizeof *work->box);
    if (!work->strips || !work->box)
        return error_memory(error);
    for (int32_t move = 0; move < work->n_boxes; move++) {
        moved_area(work, move, box);
        work->box[move] = n_strips;
        for (int32_t row = 0; row < box[3]; row++) {
            const orb_strip strip = {wallpaper_wrap(box[1] + row, paper->height), box[0], box[2], work->n_changed};
            for (int32_t k = 0; k < strip.length; k++)
                work->n_changed += wallpaper_keeps(paper, strip_texel(paper, &strip, k));
            work->strips[n_strips++] = strip;
        }
    }
    work->box[work->n_boxes] = n_strips;
    return ORB_OK;
}

static void do_strips(orb_painting *work, int32_t threads, orb_band band) {
    for (int32_t k = 0; k < work->n_boxes; k++) {
        work->turn = work->strips + work->box[k];
        bands_run(work->box[k + 1] - work->box[k], threads, band, work);
    }
}

static orb_status gather(orb_painting *work, int32_t threads, orb_error *error) {
    const orb_wallpaper *paper = work->paper;
    const size_t channels = (size_t)work->image.channels, area = (size_t)work->area[2] * (size_t)work->area[3];
    work->differs = paper->exact ? NULL : malloc(area);
    work->changed = malloc((work->n_changed * channels + 1) * sizeof *work->changed);
    if (work->painted)
        work->touched = calloc((size_t)paper->width * (size_t)paper->height, 1);
    if ((!work->differs && !paper->exact) || !work->changed || (work->painted && !work->touched))
        return error_memory(error);
    if (work->differs)
        bands_run(work->area[3], threads, find_differences, work);
    do_strips(work, threads, change_tile);
    do_strips(work, threads, write_tile);
    return ORB_OK;
}

static orb_status check(const orb_wallpaper *paper, const orb_image *image, orb_source source, const uint8_t *painted,
                        const int32_t area[4], orb_error *error) {
    if (!paper || source < ORB_FROM_TILE || source > ORB_FROM_PAINTED || (source == ORB_FROM_PAINTED && !painted))
        return error_set(error, ORB_BAD_ARGUMENT, "there is no such source, or what is painted is missing");
    if (!image_is_one(image))
        return error_set(error, ORB_BAD_ARGUMENT, IMAGE_IS_NONE, MOST_CHANNELS, MOST_SIDE);
    if (image->width != paper->width || image->height != paper->height)
        return error_set(error, ORB_BAD_ARGUMENT, "the image has %d x %d texels, and was expected to have %d x %d",
                         (int)image->width, (int)image->height, (int)paper->width, (int)paper->height);
    if (area && (area[0] < 0 || area[1] < 0 || area[2] < 1 || area[3] < 1 || area[2] > image->width - area[0] ||
                 area[3] > image->height - area[1]))
        return error_set(error, ORB_BAD_ARGUMENT, "the area is not in the image, or there is nothing in it");
    return ORB_OK;
}

orb_status orb_wallpaper_apply(const orb_wallpaper *wallpaper, const orb_image *image, orb_source source,
                               const uint8_t *painted, const int32_t area[4], int32_t threads, orb_error *error) {
    orb_status status = check(wallpaper, image, source, painted, area, error);
    if (status != ORB_OK)
        return status;
    orb_painting work = {.paper = wallpaper,
                         .image = *image,
                         .painted = source == ORB_FROM_PAINTED ? painted : NULL,
                         .area = {0, 0, image->width, image->height}};
    if (area && work.painted)
        memcpy(work.area, area, sizeof work.area);
    status = list_strips(&work, error);
    if (status == ORB_OK && source != ORB_FROM_TILE)
        status = gather(&work, threads, error);
    if (status == ORB_OK)
        do_strips(&work, threads, write_copies);
    free(work.strips);
    free(work.box);
    free(work.differs);
    free(work.changed);
    free(work.touched);
    return status == ORB_OK ? error_set(error, ORB_OK, "%s", "") : status;
}
