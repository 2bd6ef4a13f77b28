/* Images under wallpaper groups: every failed allocation, sizes of all kinds. What comes out is judged in
 * tests/core/test_wallpaper.py. SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>

#include "check.h"
#include "failing.h"
#include "orbifold_images.h"

enum { MOST = 40, LAST = 200 };
static const double turns[6] = {0, -1, 0, 1, 0, 0};
static const double sixths[12] = {0.5, -1.5, 0, 0.5, 0.5, 0, 1, 0, 0.5, 0, 1, 0.5};
static const double triangles[12] = {0, 0, 0.5, 0, 0.5, 0.5, 0, 0, 0.5, 0.5, 0, 0.5};

static float pixels[MOST * MOST * 4], before[MOST * MOST * 4];
static uint8_t painted[MOST * MOST];

static void fill(void) {
    unsigned state = 1;
    for (int k = 0; k < MOST * MOST * 4; k++) {
        state = state * 1664525u + 1013904223u;
        pixels[k] = before[k] = (float)(state >> 8) / 16777216.0f;
        painted[k / 4] = state >> 31;
    }
}

static orb_status made_and_applied(int32_t width, int32_t height, int32_t n, const double *motions, orb_source source,
                                   orb_error *error) {
    const int32_t area[4] = {1 % width, 0, width - 1 % width, height};
    const orb_image image = {width, height, 4, ORB_TEXEL_FLOAT, pixels};
    orb_wallpaper *wallpaper = NULL;
    orb_status status = orb_wallpaper_create(width, height, n, motions, n == 1 ? 2 : 0, n == 1 ? triangles : NULL, 2,
                                             &wallpaper, error);
    if (status == ORB_OK)
        status =
            orb_wallpaper_apply(wallpaper, &image, source, painted, source == ORB_FROM_PAINTED ? area : NULL, 2, error);
    else
        CHECK(!wallpaper);
    orb_wallpaper_free(wallpaper);
    return status;
}

static void fail_each(int32_t n, const double *motions, orb_source source) {
    orb_error error;
    fill();
    for (long number = 0; number < LAST; number++) {
        allocations = 0;
        failing = number;
        orb_status status = made_and_applied(MOST, 30, n, motions, source, &error);
        failing = -1;
        if (status == ORB_OK) {
            CHECK(number > 3 && memcmp(pixels, before, sizeof pixels) != 0);
            return;
        }
        CHECK(status == ORB_OUT_OF_MEMORY && error.message[0]);
        CHECK(memcmp(pixels, before, sizeof pixels) == 0);
    }
    CHECK(!"it comes to an end");
}

TEST(out_of_memory_leaves_the_image_as_it_was) {
    for (int source = ORB_FROM_TILE; source <= ORB_FROM_PAINTED; source++) {
        fail_each(1, turns, (orb_source)source);
        fail_each(2, sixths, (orb_source)source);
    }
}

TEST(out_of_memory_while_seams_are_filled) {
    const int32_t corners[6] = {0, 1, 2, 0, 2, 3};
    const orb_image image = {MOST, MOST, 4, ORB_TEXEL_FLOAT, pixels};
    orb_error error;
    for (long number = 0; number < LAST; number++) {
        allocations = 0;
        failing = number;
        orb_status status = orb_fill_seam_margin(&image, true, 2, corners, triangles, 20, &error);
        failing = -1;
        CHECK(status == ORB_OK ? number > 3 : status == ORB_OUT_OF_MEMORY && error.message[0]);
        if (status == ORB_OK)
            return;
    }
    CHECK(!"it comes to an end");
}

TEST(images_of_all_sizes) {
    orb_error error;
    fill();
    for (int32_t width = 1; width <= MOST; width += width < 6 ? 1 : 11)
        for (int32_t height = 1; height <= MOST; height += height < 6 ? 1 : 13)
            for (int source = ORB_FROM_TILE; source <= ORB_FROM_PAINTED; source++) {
                CHECK(made_and_applied(width, height, 1, turns, (orb_source)source, &error) == ORB_OK);
                CHECK(made_and_applied(width, height, 2, sixths, (orb_source)source, &error) == ORB_OK);
            }
    for (int k = 0; k < MOST * MOST * 4; k++)
        CHECK(pixels[k] >= 0 && pixels[k] <= 1.0001f);
}

TEST(arguments_that_are_none) {
    orb_wallpaper *wallpaper = NULL;
    orb_error error;
    CHECK(orb_wallpaper_create(8, 8, -1, turns, 0, NULL, 1, &wallpaper, &error) == ORB_BAD_ARGUMENT);
    CHECK(orb_wallpaper_create(8, 8, 1, NULL, 0, NULL, 1, &wallpaper, &error) == ORB_BAD_ARGUMENT);
    CHECK(orb_wallpaper_create(8, 8, 1, turns, 1, NULL, 1, &wallpaper, &error) == ORB_BAD_ARGUMENT);
    CHECK(orb_wallpaper_create(8, 8, 1, turns, 0, NULL, 1, NULL, NULL) == ORB_BAD_ARGUMENT);
    REQUIRE(orb_wallpaper_create(8, 8, 1, turns, 0, NULL, 1, &wallpaper, &error) == ORB_OK);
    const orb_image none = {8, 8, 4, ORB_TEXEL_FLOAT, NULL}, image = {8, 8, 4, ORB_TEXEL_FLOAT, pixels};
    CHECK(orb_wallpaper_apply(NULL, &image, ORB_FROM_TILE, NULL, NULL, 1, &error) == ORB_BAD_ARGUMENT);
    CHECK(orb_wallpaper_apply(wallpaper, &none, ORB_FROM_TILE, NULL, NULL, 1, &error) == ORB_BAD_ARGUMENT);
    CHECK(orb_wallpaper_apply(wallpaper, &image, ORB_FROM_PAINTED, NULL, NULL, 1, NULL) == ORB_BAD_ARGUMENT);
    CHECK(orb_wallpaper_look(wallpaper).order == 4 && orb_wallpaper_look(wallpaper).exact);
    orb_wallpaper_free(wallpaper);
    orb_wallpaper_free(NULL);
}
