/* What an image's texels are, as numbers. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Inlined, so that a loop over an image whose kind is known when it is compiled asks nothing. */
#ifndef ORB_TEXELS_H
#define ORB_TEXELS_H

#include <stddef.h>

#include "orbifold_images.h"

enum { MOST_CHANNELS = 4, MOST_SIDE = 32768 };
#define ALWAYS_INLINE static inline __attribute__((always_inline))

#define IMAGE_IS_NONE "an image has 1 to %d channels of 8 or 16 bits or floats, and sides of 1 to %d texels"

/* Whether there is an image that these can read: its sides are 1 to MOST_SIDE, its channels 1 to MOST_CHANNELS. */
static inline bool image_is_one(const orb_image *image) {
    return image && image->pixels && image->channels >= 1 && image->channels <= MOST_CHANNELS && image->width >= 1 &&
           image->height >= 1 && image->width <= MOST_SIDE && image->height <= MOST_SIDE &&
           image->texel >= ORB_TEXEL_UINT8 && image->texel <= ORB_TEXEL_FLOAT;
}

ALWAYS_INLINE size_t texel_bytes(const orb_image *image) {
    static const size_t bytes[] = {sizeof(uint8_t), sizeof(uint16_t), sizeof(float)};
    return bytes[image->texel] * (size_t)image->channels;
}

ALWAYS_INLINE void load(const orb_image *image, size_t texel, float value[MOST_CHANNELS]) {
    const size_t at = texel * (size_t)image->channels;
    for (int c = 0; c < image->channels; c++)
        if (image->texel == ORB_TEXEL_FLOAT)
            value[c] = ((const float *)image->pixels)[at + (size_t)c];
        else if (image->texel == ORB_TEXEL_UINT8)
            value[c] = ((const uint8_t *)image->pixels)[at + (size_t)c];
        else
            value[c] = ((const uint16_t *)image->pixels)[at + (size_t)c];
}

/* What the image keeps of a value. */
ALWAYS_INLINE float kept(const orb_image *image, float value) {
    if (image->texel == ORB_TEXEL_FLOAT)
        return value;
    const float most = image->texel == ORB_TEXEL_UINT8 ? UINT8_MAX : UINT16_MAX;
    return (float)(int32_t)((value < 0 ? 0 : value > most ? most : value) + 0.5f);
}

/* Values that `kept` gave. */
ALWAYS_INLINE void store(const orb_image *image, size_t texel, const float value[MOST_CHANNELS]) {
    const size_t at = texel * (size_t)image->channels;
    for (int c = 0; c < image->channels; c++)
        if (image->texel == ORB_TEXEL_FLOAT)
            ((float *)image->pixels)[at + (size_t)c] = value[c];
        else if (image->texel == ORB_TEXEL_UINT8)
            ((uint8_t *)image->pixels)[at + (size_t)c] = (uint8_t)value[c];
        else
            ((uint16_t *)image->pixels)[at + (size_t)c] = (uint16_t)value[c];
}

#endif
