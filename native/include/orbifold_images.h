/* Images that a group of the plane leaves as they are. SPDX-License-Identifier: GPL-3.0-or-later
 *
 *     orb_wallpaper *wallpaper = NULL;
 *     orb_wallpaper_create(4096, 4096, 3, motions, n_triangles, uv, 2, &wallpaper, &error);
 *     orb_wallpaper_apply(wallpaper, &image, ORB_FROM_TILE, NULL, NULL, 2, &error);
 *     orb_wallpaper_free(wallpaper);
 *
 * An image is one period of a pattern: the unit square, which repeats. The group moves each texel to its copies. Of the
 * texels one tile of the group is kept, the others follow from it: a texel that a motion takes to the middle of another
 * one is that one, to the bit, and any other is interpolated between those of the tile. So an image that has been made
 * invariant stays as it is when it is made so again, in any way (docs/mathematics.md, section 11). */
#ifndef ORBIFOLD_IMAGES_H
#define ORBIFOLD_IMAGES_H
#include "orbifold.h"
#ifdef __cplusplus
extern "C" {
#endif

typedef enum orb_texel { ORB_TEXEL_UINT8 = 0, ORB_TEXEL_UINT16, ORB_TEXEL_FLOAT } orb_texel;

typedef struct orb_image {
    int32_t width, height, channels;
    orb_texel texel;
    void *pixels; /* [height][width][channels], the first row at v = 0 */
} orb_image;

typedef struct orb_wallpaper orb_wallpaper; /* of images of one size; any number of threads may share it */

/* The group of `n_motions` affine maps of the square, motions[6*n_motions]: (u, v) -> (m0 u + m1 v + m2, m3 u + m4 v +
 * m5), and of its periods. The tile: `uv` [n_triangles*6], anywhere in the plane, as the layout of an embedding has it;
 * n_triangles 0: one that is convex. Where the triangles are no tile, copies that they leave out are filled up, and of
 * several that they cover one is taken. Errors: ORB_BAD_ARGUMENT (a size below 1 or above 32768, numbers that are none,
 * motions that do not fit the period), ORB_OUT_OF_MEMORY. */
ORB_API orb_status orb_wallpaper_create(int32_t width, int32_t height, int32_t n_motions, const double *motions,
                                        int32_t n_triangles, const double *uv, int32_t threads,
                                        orb_wallpaper **wallpaper, orb_error *error);
ORB_API void orb_wallpaper_free(orb_wallpaper *wallpaper);

typedef struct orb_wallpaper_view {
    int32_t order;           /* copies of a texel in the image, itself included */
    bool exact;              /* all motions take texels to texels */
    const double *motions;   /* [6*order] in (u, v), the identity first */
    const uint16_t *to_tile; /* [height][width] the motion that takes the texel onto the tile; 0: it is kept; 65535: it
                                stays alone, at the tip of a tile thinner than a texel */
} orb_wallpaper_view;
ORB_API orb_wallpaper_view orb_wallpaper_look(const orb_wallpaper *wallpaper);

typedef enum orb_source {
    ORB_FROM_TILE = 0, /* copies become what the tile has */
    ORB_FROM_ALL,      /* all copies become their mean */
    ORB_FROM_PAINTED   /* copies become what was painted on the one of them on which most was; others stay */
} orb_source;

/* Makes the image invariant, in place. painted [height][width]: how much, 0: not at all; NULL unless ORB_FROM_PAINTED. area: x,
 * y, width, height of the part that is looked at for what has been painted, for the time in proportion to it; NULL: all.
 * `threads` at most. Errors: ORB_BAD_ARGUMENT (another size, channels below 1 or above 4, an area that is not in the
 * image), ORB_OUT_OF_MEMORY; then the image is as it was. */
ORB_API orb_status orb_wallpaper_apply(const orb_wallpaper *wallpaper, const orb_image *image, orb_source source,
                                       const uint8_t *painted, const int32_t area[4], int32_t threads,
                                       orb_error *error);

/* Fills the texels around the islands of any UV map, `texels` far, for filters and mipmaps that read beyond them: with
 * what the image has where the surface goes on, across seams, each triangle laid against the one before it by a
 * similarity. For the layout of an orbifold of the plane that is the group. At borders the colour beside them. The
 * islands stay as they are. triangles [3*n_triangles] vertices of the mesh, which say what is across an edge; uv
 * [6*n_triangles]; `repeats`: the image does, and islands may lie anywhere. Errors: ORB_BAD_ARGUMENT, and
 * ORB_OUT_OF_MEMORY, after which a part is filled. */
ORB_API orb_status orb_fill_seam_margin(const orb_image *image, bool repeats, int32_t n_triangles,
                                        const int32_t *triangles, const double *uv, int32_t texels, orb_error *error);

#ifdef __cplusplus
}
#endif
#endif
