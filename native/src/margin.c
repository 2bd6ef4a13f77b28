/* Texels around the islands of a UV map, from across its seams. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Ring by ring: a texel takes up the walk where one beside it has ended, so that each walk is short. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "coverage.h"
#include "error.h"
#include "texels.h"
#include "unfold.h"

enum { BESIDE = 8, DEPTH = 3 };
static const int32_t beside[BESIDE][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}};

/* A texel that is filled or covered, where the plane is not rolled up. */
typedef struct orb_place {
    int32_t x, y;
    orb_laid laid;
} orb_place;

typedef struct orb_margin {
    orb_image image;
    bool repeats;
    orb_unfold unfold;
    int32_t *covered; /* [texels] the triangle that a texel's middle lies in; -1: none; -2: filled */
    orb_place *ring, *next;
    int64_t n_ring, n_next, room_next;
} orb_margin;

static int32_t wrapped(int32_t value, int32_t size) {
    const int32_t left = value % size;
    return left < 0 ? left + size : left;
}

/* The texel's number; -1: it is not in the image. */
static int64_t texel_of(const orb_margin *margin, int32_t x, int32_t y) {
    const int32_t width = margin->image.width, height = margin->image.height;
    if (!margin->repeats && (x < 0 || y < 0 || x >= width || y >= height))
        return -1;
    return (int64_t)wrapped(y, height) * width + wrapped(x, width);
}

/* --- values ------------------------------------------------------------------------------------------------------- */

/* The image at (u, v), where a triangle lies, between the four texels around. What is not covered of these is taken from
 * where the surface goes on, `depth` times over, and then left out; false: nothing is left. */
static bool look_up(const orb_margin *margin, int32_t triangle, const double uv[2], int depth,
                    float value[MOST_CHANNELS]) {
    const double x = uv[0] * margin->image.width - 0.5, y = uv[1] * margin->image.height - 0.5;
    const double u = x - floor(x), v = y - floor(y);
    double all = 0, sum[MOST_CHANNELS] = {0, 0, 0, 0};
    float own[MOST_CHANNELS];
    if (!(fabs(uv[0]) <= MOST_PERIODS && fabs(uv[1]) <= MOST_PERIODS))
        return false;
    for (int corner = 0; corner < 4; corner++) {
        const int32_t column = (int32_t)floor(x) + (corner & 1), row = (int32_t)floor(y) + corner / 2;
        const double weight = (corner & 1 ? u : 1 - u) * (corner & 2 ? v : 1 - v);
        const int64_t texel = texel_of(margin, column, row);
        bool known = texel >= 0 && margin->covered[texel] >= 0;
        if (known)
            load(&margin->image, (size_t)texel, own);
        if (!known && depth > 0 && weight > 0) {
            const double middle[2] = {(column + 0.5) / margin->image.width, (row + 0.5) / margin->image.height};
            orb_laid laid = {triangle, {{1, 0}, {0, 0}, false}};
            double at[2];
            unfold_walk(&margin->unfold, middle, &laid, at);
            known = look_up(margin, laid.triangle, at, depth - 1, own);
        }
        all += known ? weight : 0;
        for (int c = 0; c < margin->image.channels && known; c++)
            sum[c] += weight * own[c];
    }
    for (int c = 0; c < margin->image.channels && all > 0; c++)
        value[c] = kept(&margin->image, (float)(sum[c] / all));
    return all > 0;
}

/* --- rings -------------------------------------------------------------------------------------------------------- */

static bool push(orb_margin *margin, orb_place place) {
    if (margin->n_next == margin->room_next) {
        const int64_t room = 2 * margin->room_next + 1024;
        orb_place *more = realloc(margin->next, (size_t)room * sizeof *more);
        if (!more)
            return false;
        margin->next = more;
        margin->room_next = room;
    }
    margin->next[margin->n_next++] = place;
    return true;
}

static void turn_over_rings(orb_margin *margin) {
    free(margin->ring);
    margin->ring = margin->next;
    margin->n_ring = margin->n_next;
    margin->next = NULL;
    margin->n_next = margin->room_next = 0;
}

/* Where a covered texel is, of all places that are it, so that it lies in its triangle. */
static int32_t unrolled(int32_t place, int32_t size, const double *uv, int axis) {
    double low = fmin(fmin(uv[axis], uv[2 + axis]), uv[4 + axis]) * size - 0.5;
    return place + size * (int32_t)ceil((low - place) / size - 1e-9);
}

/* Covered texels with one beside them that is not. */
static bool first_ring(orb_margin *margin) {
    const int32_t width = margin->image.width, height = margin->image.height;
    for (int32_t y = 0; y < height; y++)
        for (int32_t x = 0; x < width; x++) {
            const int32_t triangle = margin->covered[(int64_t)y * width + x];
            bool inner = true;
            for (int k = 0; k < BESIDE && triangle >= 0 && inner; k++) {
                const int64_t texel = texel_of(margin, x + beside[k][0], y + beside[k][1]);
                inner = texel < 0 || margin->covered[texel] >= 0;
            }
            if (triangle < 0 || inner)
                continue;
            const double *uv = margin->unfold.uv + 6 * (size_t)triangle;
            orb_place place = {
                unrolled(x, width, uv, 0), unrolled(y, height, uv, 1), {triangle, {{1, 0}, {0, 0}, false}}};
            if (!push(margin, place))
                return false;
        }
    turn_over_rings(margin);
    return true;
}

static bool fill_beside(orb_margin *margin, const orb_place *from) {
    for (int k = 0; k < BESIDE; k++) {
        orb_place place = {from->x + beside[k][0], from->y + beside[k][1], from->laid};
        const int64_t texel = texel_of(margin, place.x, place.y);
        const double point[2] = {(place.x + 0.5) / margin->image.width, (place.y + 0.5) / margin->image.height};
        double at[2];
        float value[MOST_CHANNELS];
        if (texel < 0 || margin->covered[texel] != -1)
            continue;
        unfold_walk(&margin->unfold, point, &place.laid, at);
        if (!look_up(margin, place.laid.triangle, at, DEPTH, value))
            continue;
        margin->covered[texel] = -2;
        store(&margin->image, (size_t)texel, value);
        if (!push(margin, place))
            return false;
    }
    return true;
}

static bool fill_rings(orb_margin *margin, int32_t texels) {
    for (int32_t ring = 0; ring < texels && margin->n_ring > 0; ring++) {
        for (int64_t k = 0; k < margin->n_ring; k++)
            if (!fill_beside(margin, &margin->ring[k]))
                return false;
        turn_over_rings(margin);
    }
    return true;
}

static orb_status check(const orb_image *image, int32_t n_triangles, const int32_t *triangles, const double *uv,
                        int32_t texels, orb_error *error) {
    if (!image_is_one(image))
        return error_set(error, ORB_BAD_ARGUMENT, IMAGE_IS_NONE, MOST_CHANNELS, MOST_SIDE);
    if (n_triangles < 0 || n_triangles > INT32_MAX / 3 || (n_triangles > 0 && (!triangles || !uv)) || texels < 0)
        return error_set(error, ORB_BAD_ARGUMENT, "a count is negative, or an array is missing");
    return ORB_OK;
}

orb_status orb_fill_seam_margin(const orb_image *image, bool repeats, int32_t n_triangles, const int32_t *triangles,
                                const double *uv, int32_t texels, orb_error *error) {
    orb_status status = check(image, n_triangles, triangles, uv, texels, error);
    if (status != ORB_OK)
        return status;
    const size_t n = (size_t)image->width * (size_t)image->height;
    orb_margin margin = {.image = *image, .repeats = repeats, .covered = malloc(n * sizeof *margin.covered)};
    status = margin.covered ? unfold_create(n_triangles, triangles, uv, &margin.unfold, error) : error_memory(error);
    if (status == ORB_OK) {
        coverage_number(image->width, image->height, repeats, n_triangles, uv, margin.covered);
        if (!first_ring(&margin) || !fill_rings(&margin, texels))
            status = error_memory(error);
    }
    unfold_clear(&margin.unfold);
    free(margin.covered);
    free(margin.ring);
    free(margin.next);
    return status == ORB_OK ? error_set(error, ORB_OK, "%s", "") : status;
}
