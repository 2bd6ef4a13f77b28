/* How far an embedding is from an isometry. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_DISTORTION_H
#define ORB_DISTORTION_H

#include "embedding.h"

/* Fills the distortion of embedding->report, with finite numbers. A triangle's map is the affine one to its image under
 * the logarithm at the corner where the image's edges are most nearly orthogonal; its area on the tile is that of the
 * geometry. Triangles without area on the mesh (triangle.h) do not count. */
orb_status distortion_measure(orb_embedding *embedding, orb_error *error);

/* Sum over the triangles of area times J J', J the affine map of a triangle to its image: [m11, m12, m22]. */
void distortion_covariance(const orb_embedding *embedding, double covariance[3]);

/* Twice the area-weighted standard deviation of the logarithms of the singular values: for a conformal map that is the
 * spread of log area, and for any other one more than that, by the quasi-conformal error. */
double distortion_spread(const orb_embedding *embedding);

#endif
