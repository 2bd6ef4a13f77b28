/* What orb_embed returns: an embedding and the stages it was made of. SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_EMBEDDING_H
#define ORB_EMBEDDING_H

#include "holonomy.h"
#include "surface.h"
#include "tile.h"

struct orb_embedding {
    orb_surface *surface;
    orb_mesh *mesh; /* the surface's */
    orb_tile *tile; /* after the affine modulus, where there is one */
    int32_t *corners; /* [tile->word->n_sides] the vertex at each corner of the tile; one of a refinement: -1 */
    orb_copies *copies;
    orb_point *position;                   /* [mesh->n_vertices] isolated vertices: the origin */
    orb_point *placed;                     /* [copies->n_copies] position of each copy */
    double *weights;                       /* [mesh->n_edges]; NULL in the end if they live on other edges */
    double *edge_weights;                  /* [mesh->n_edges*3] rows i, j, w_ij for the view; or NULL */
    double *coordinates, *coordinates_low; /* [copies->n_copies*3] for the view */
    int32_t n_seams;
    int32_t *seams;         /* [n_seams*2] */
    int32_t *refined_from;  /* [mesh->n_triangles] for the view; NULL: the triangles are the input's */
    int32_t *input_corners; /* [surface->n_input_triangles*3] for the view */
    int32_t n_generators;
    double *generators; /* [n_generators*9] for the view */
    orb_report report;
};

/* An edge inside whose two triangles lie at different copies of an end. */
bool embedding_is_seam(const orb_embedding *embedding, int32_t edge);

/* Fills what the view and the report still lack once positions are final: coordinates, seams, rows of weights, the
 * mesh's numbers, and the flips that are left when UVs are rounded to float. */
orb_status embedding_finish(orb_embedding *embedding, orb_error *error);

#endif
