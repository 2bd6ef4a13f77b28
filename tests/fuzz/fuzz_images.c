/* Bytes -> motions, a tile, an image -> symmetric images and seam margins. SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "bytes.h"
#include "orbifold_images.h"

enum { MOST_SIDE = 12, MOST_MOTIONS = 3, MOST_FACES = 12, MOST_POINTS = 9 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static const double motions[][6] = {
    {-1, 0, 0, 0, -1, 0},     {0, -1, 0, 1, 0, 0},      {-0.5, -1.5, 0, 0.5, -0.5, 0}, {0.5, -1.5, 0, 0.5, 0.5, 0},
    {1, 0, 0.5, 0, 1, 0.5},   {1, 0, 0, 0, -1, 0},      {1, 0, 0.5, 0, -1, 0},         {0, 1, 0, 1, 0, 0},
    {-1, 0, 0.5, 0, 1, 0.25}, {1, 0, 1.0 / 3, 0, 1, 0},
};

static double coordinate(fuzz_bytes *bytes) {
    const uint8_t kind = fuzz_byte(bytes);
    return kind < 250 ? kind / 125.0 - 0.5 : fuzz_number(bytes);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static uint8_t pixels[MOST_SIDE * MOST_SIDE * 4 * sizeof(float)], again[sizeof pixels],
        painted[MOST_SIDE * MOST_SIDE];
    fuzz_bytes bytes = {data, size};
    orb_image image = {1 + fuzz_below(&bytes, MOST_SIDE), 1 + fuzz_below(&bytes, MOST_SIDE), 1 + fuzz_below(&bytes, 4),
                       (orb_texel)fuzz_below(&bytes, 3), pixels};
    double chosen[6 * MOST_MOTIONS], uv[6 * MOST_FACES];
    int32_t triangles[3 * MOST_FACES];
    const int32_t n_motions = fuzz_below(&bytes, MOST_MOTIONS + 1), n_faces = fuzz_below(&bytes, MOST_FACES + 1);
    for (int32_t k = 0; k < n_motions; k++) {
        const int32_t kind = fuzz_below(&bytes, 12);
        for (int entry = 0; entry < 6; entry++)
            chosen[6 * k + entry] = kind < 10 ? motions[kind][entry] : fuzz_number(&bytes);
    }
    for (int32_t k = 0; k < 6 * n_faces; k++)
        uv[k] = coordinate(&bytes);
    for (int32_t k = 0; k < 3 * n_faces; k++)
        triangles[k] = fuzz_below(&bytes, MOST_POINTS);
    const int32_t area[4] = {fuzz_below(&bytes, image.width), fuzz_below(&bytes, image.height),
                             1 + fuzz_below(&bytes, 6), 1 + fuzz_below(&bytes, 6)};
    const orb_source source = (orb_source)fuzz_below(&bytes, 3);
    const uint8_t seed = fuzz_byte(&bytes);
    for (size_t k = 0; k < sizeof pixels; k++)
        pixels[k] = (uint8_t)((k * 2654435761u + seed) >> 13);
    if (image.texel == ORB_TEXEL_FLOAT)
        for (size_t k = 0; k < sizeof pixels / sizeof(float); k++)
            ((float *)(void *)pixels)[k] = (float)(k * 40503u % 1024) / 1024;
    for (size_t k = 0; k < sizeof painted; k++)
        painted[k] = k * 40503u % 7 == seed % 7;
    orb_wallpaper *wallpaper = NULL;
    if (orb_wallpaper_create(image.width, image.height, n_motions, chosen, seed & 1 ? n_faces : 0, uv, 1, &wallpaper,
                             NULL) == ORB_OK &&
        orb_wallpaper_apply(wallpaper, &image, source, painted, seed & 2 ? area : NULL, 1, NULL) == ORB_OK &&
        source != ORB_FROM_PAINTED) {
        memcpy(again, pixels, sizeof pixels);
        if (orb_wallpaper_apply(wallpaper, &image, seed & 4 ? ORB_FROM_ALL : ORB_FROM_TILE, NULL, NULL, 1, NULL) !=
                ORB_OK ||
            memcmp(again, pixels, sizeof pixels) != 0)
            abort(); /* what is invariant stays as it is */
    }
    orb_wallpaper_free(wallpaper);
    orb_fill_seam_margin(&image, seed & 8, n_faces, triangles, uv, fuzz_below(&bytes, 30), NULL);
    return 0;
}
