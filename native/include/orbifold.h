/* Orbifold UV: bijective, seamless maps of a triangle mesh onto an orbifold of the sphere, the plane or the
 * hyperbolic plane. SPDX-License-Identifier: GPL-3.0-or-later
 *     orb_embedding *embedding = NULL;
 *     orb_error error = {0};
 *     orb_mesh_arrays mesh = {n, vertices, m, triangles};
 *     orb_request request = orb_request_default();
 *     request.signature = "442";  request.n_cones = 3;  request.cones = cones;
 *     if (orb_embed(&mesh, &request, &embedding, &error) != ORB_OK) ... error.message, error.elements
 *     orb_uv(embedding, ORB_CHART_DEFAULT, uv, NULL, &error);
 *     orb_embedding_free(embedding);
 *
 * An embedding is handed out only after it passed the certificate (docs/mathematics.md, section 5): every triangle
 * positively oriented, both sides of every seam equally long, the angles around every vertex those of the
 * orbifold, and the orbifold's area. These four make the map a bijection.
 *
 * The library keeps no global state but one lock around BLAS, prints nothing, never exits and never writes to an
 * array that it reads; the caller's arrays are not needed after a call returns. Functions may be called from several
 * threads at once as long as each has its own objects. Angles are in radians; vertices and triangles count from 0. */
#ifndef ORBIFOLD_H
#define ORBIFOLD_H
#include <stdbool.h>
#include <stdint.h>
#ifdef __cplusplus
extern "C" {
#endif
#ifdef _WIN32
#define ORB_API __declspec(dllexport)
#else
#define ORB_API __attribute__((visibility("default")))
#endif
typedef enum orb_status {
    ORB_OK = 0,
    ORB_OUT_OF_MEMORY,
    ORB_CANCELLED,
    ORB_BAD_ARGUMENT,             /* a null array, a negative count, an unknown chart or kind of weights */
    ORB_NON_FINITE,               /* a coordinate that is not a finite number; elements: vertices */
    ORB_INDEX_OUT_OF_RANGE,       /* a triangle names a vertex that is not there; elements: triangles */
    ORB_DEGENERATE_TRIANGLE,      /* a triangle names a vertex twice; elements: triangles */
    ORB_REPEATED_TRIANGLE,        /* two triangles on the same three vertices; elements: triangles */
    ORB_NON_MANIFOLD_EDGE,        /* more than two triangles on an edge; elements: its two vertices, pairwise */
    ORB_NON_MANIFOLD_VERTEX,      /* triangles around a vertex are more than one fan; elements: vertices */
    ORB_INCONSISTENT_ORIENTATION, /* orientable, but two triangles run through an edge the same way; elements: edges */
    ORB_SEVERAL_COMPONENTS,       /* elements: one vertex of each component */
    ORB_BOUNDARY,                 /* boundary loops are not as many as the signature's mirrors; elements: edges */
    ORB_WRONG_GENUS,              /* handles or cross-caps are not the signature's */
    ORB_ZERO_AREA_TRIANGLE,       /* makes a weight infinite or the certificate fail; elements: triangles */
    ORB_BAD_SIGNATURE,            /* does not parse; elements[0]: position in the string */
    ORB_BAD_ORDER,                /* an order below 2, or orders that are not the signature's */
    ORB_BAD_ORBIFOLD,             /* MN with M != N, or one cone: no surface has this orbifold as a quotient */
    ORB_UNSUPPORTED_SIGNATURE,    /* good, but not one that this version embeds, or divides the whole sphere by */
    ORB_CONE_COUNT,               /* the signature has another number of cones than were given */
    ORB_BAD_CONE,                 /* given twice, out of range, isolated, inside where a corner should be; vertices */
    ORB_BAD_WEIGHT,               /* a given weight is not positive and finite, or an edge has none; elements: edges */
    ORB_CUT_BLOCKED,              /* no path joins two cones, within bounds; elements: the two vertices */
    ORB_NOT_CONVERGED,            /* elements: vertices, where any stand out */
    ORB_CERTIFICATE_FAILED,       /* elements: flipped triangles, or the vertices whose angles are wrong */
    ORB_LINEAR_SOLVER,            /* CHOLMOD reported a fault that is none of the above */
    ORB_NO_CORRESPONDENCE,        /* two embeddings whose tiles or cones do not match; elements: the source's cones */
    ORB_POINT_NOT_FOUND           /* the target has no triangle at a point; elements: the source's vertices, or none */
} orb_status;

ORB_API const char *orb_status_name(orb_status status); /* "ORB_OK", "ORB_OUT_OF_MEMORY", ...; never NULL */

typedef enum orb_element { ORB_NOTHING = 0, ORB_VERTEX, ORB_EDGE, ORB_TRIANGLE, ORB_CHARACTER } orb_element;
enum { ORB_MAX_ELEMENTS = 16 };

/* What went wrong, for a person: one sentence, and where. An edge takes two entries (its vertices). */
typedef struct orb_error {
    orb_status status;
    orb_element element;                /* what the entries of `elements` are */
    int32_t n_elements;                 /* entries used, at most ORB_MAX_ELEMENTS */
    int32_t elements[ORB_MAX_ELEMENTS]; /* the first ones, ascending */
    int64_t n_found;                    /* how many there are in all (edges count once) */
    char message[320];
} orb_error;

/* A triangle mesh in one piece, with or without boundary, of any genus; consistently oriented where it is orientable.
 * Vertices that no triangle uses are tolerated. */
typedef struct orb_mesh_arrays {
    int32_t n_vertices;
    const double *vertices; /* [n_vertices*3] */
    int32_t n_triangles;
    const int32_t *triangles; /* [n_triangles*3] */
} orb_mesh_arrays;

typedef enum orb_weights {
    ORB_WEIGHTS_COTANGENT = 0,   /* (cot a + cot b) / 2, clamped from below once per edge */
    ORB_WEIGHTS_MEAN_VALUE,      /* Floater 2003, symmetrised: (w_ij + w_ji) / 2 */
    ORB_WEIGHTS_UNIFORM,         /* 1 */
    ORB_WEIGHTS_GIVEN,           /* edge_weights of the request */
    ORB_WEIGHTS_CONFORMAL,       /* cotangents of the target's own metric, intrinsic Delaunay, then mended */
    ORB_WEIGHTS_DELAUNAY,        /* cotangents of the mesh's metric on its intrinsic Delaunay triangulation */
    ORB_WEIGHTS_MEAN_VALUE_EXACT /* Floater 2003 as it stands, not symmetric: plane only */
} orb_weights;

/* What to do with boundary loops beyond the signature's mirrors: those without picked corners, shortest first. */
typedef enum orb_holes {
    ORB_HOLES_REFUSE = 0, /* ORB_BOUNDARY */
    ORB_HOLES_FILL,       /* close them for the computation; the result has refined_from -1 there */
    ORB_HOLES_MIRROR      /* add a * to the signature for each */
} orb_holes;

/* Which sides the tile gets. Two embeddings have a surface map (orbifold_maps.h) where their cuts correspond. */
typedef enum orb_cut {
    ORB_CUT_AUTOMATIC = 0, /* a path, or where that is long and the tile may be another polygon, a graph */
    ORB_CUT_PATH           /* surfaces without handles and cross-caps: through the cones in turn, however long that is,
                              from the mirror whose corner was picked first, and on to the other mirrors; the same word
                              for every mesh. Other surfaces have graphs as ever */
} orb_cut;

/* Instead of an orbifold: the boundary of a disk goes to a convex polygon, by arc length, and stays there (Tutte 1963;
 * Floater 2003; theorem 1 of 2016 and 2017). */
typedef struct orb_polygon {
    int32_t curvature;     /* +1, 0, -1 */
    int32_t n_corners;     /* >= 3 */
    const double *corners; /* [n_corners*3] points of the geometry's model, counter-clockwise; NULL: regular */
    double radius;         /* of the regular one, in the geometry; 0: as large as suits it */
} orb_polygon; /* the request's cones are the mesh's vertices that go to the corners, in turn; none: spread evenly */

/* Called now and then from the thread that computes; return false to cancel. `fraction` in [0, 1] never falls. */
typedef bool (*orb_progress)(const char *stage, double fraction, void *user);

/* What all embeddings of one mesh share: its half-edges, cotangents, the ordering and the symbolic factor. For many
 * requests on one mesh, as while a cone is moved. Several threads may use it at once, and it may be freed while jobs
 * still do. Errors: those of the mesh. */
typedef struct orb_prepared orb_prepared;
ORB_API orb_status orb_prepare(const orb_mesh_arrays *mesh, orb_prepared **prepared, orb_error *error);
ORB_API void orb_prepared_free(orb_prepared *prepared);

typedef struct orb_request {
    const char *signature; /* Conway's notation: "442", "22(12)", "*632", "4*2", "**", "22x", "ooo", "3*22" */
    int32_t n_cones;
    const int32_t *cones;  /* [n_cones] vertices of cones and mirror corners, in the signature's order; a sphere's cut
                              runs through its cones in turn; corners may start anywhere and run either way round */
    const int32_t *orders; /* [n_cones] order of each, a permutation of the signature's; NULL: as it stands */
    orb_holes holes;
    orb_cut cut;
    const orb_polygon *polygon; /* not NULL: a fixed boundary, and no signature */
    orb_weights weights;
    double clamp;                 /* least cotangent weight, > 0 */
    int32_t n_edge_weights;       /* for ORB_WEIGHTS_GIVEN: one row for each edge of the mesh, in any sequence */
    const double *edge_weights;   /* [n_edge_weights*3] rows i, j, w_ij > 0 */
    const orb_prepared *prepared; /* of the mesh, which then may be NULL and is not looked at; or NULL */
    orb_progress progress;        /* may be NULL */
    void *user;                   /* its last argument */
} orb_request;

ORB_API orb_request orb_request_default(void); /* conformal weights, none below 0.01; all else zero */
enum { ORB_MAX_SIGNATURE = 4096 };             /* characters */
typedef struct orb_signature_info {
    int32_t curvature;    /* +1 spherical, 0 Euclidean, -1 hyperbolic */
    const char *geometry; /* "spherical", "euclidean", "hyperbolic" */
    double euler;         /* Euler characteristic of the orbifold */
    int32_t n_cones;      /* cones and mirror corners */
    bool supported;       /* whether orb_embed takes it */
    int32_t n_interior;   /* of n_cones, those that are cones: the first ones */
    int32_t n_mirrors, n_crosscaps, n_handles;
} orb_signature_info;

/* Errors: ORB_BAD_SIGNATURE (elements[0]: position), ORB_BAD_ORDER, ORB_BAD_ORBIFOLD. `orders` may be NULL or have
 * room for `capacity` entries, of which the first min(n_cones, capacity) are written. */
ORB_API orb_status orb_signature_read(const char *signature, orb_signature_info *info, int32_t *orders,
                                      int32_t capacity, orb_error *error);

/* The polygon of a signature's simplest cut, for drawings: points[capacity*3] of the geometry's model, of which the
 * first min(*n_corners, capacity) are written, counter-clockwise, and for each side whether it is a mirror. A side
 * between antipodal corners is given in two halves. */
ORB_API orb_status orb_signature_tile(const char *signature, double *points, bool *mirrors, int32_t capacity,
                                      int32_t *n_corners, orb_error *error);

/* The whole pipeline: topology, weights, cut, tile, initial guess, minimisation, certificate. On success
 * *embedding is a new object; on failure it is NULL. */
typedef struct orb_embedding orb_embedding;
ORB_API orb_status orb_embed(const orb_mesh_arrays *mesh, const orb_request *request, orb_embedding **embedding,
                             orb_error *error);
ORB_API void orb_embedding_free(orb_embedding *embedding);

/* What an embedding holds; the arrays live as long as it does. A copy of a vertex is one of the images that a
 * vertex has because the mesh was cut; copy v for v < n_vertices is the vertex itself. */
typedef struct orb_view {
    int32_t n_vertices, n_triangles, n_copies, n_cones, n_edges, n_seams, n_input_triangles;
    const double *vertices;        /* [n_vertices*3] the input's come first; then those of refined edges and holes */
    const int32_t *triangles;      /* [n_triangles*3] refined where need was, oriented alike within the layout */
    const int32_t *refined_from;   /* [n_triangles] the input triangle that each lies in, -1 in a filled hole; NULL:
                                      the triangles are the input's (though perhaps turned over) */
    const int32_t *input_corners;  /* [n_input_triangles*3] where each corner of the input is in `triangles` */
    const int32_t *cut_triangles;  /* [n_triangles*3] the mesh's triangles, in copies */
    const int32_t *cut_to_vertex;  /* [n_copies] */
    const double *embedding;       /* [n_copies*3] (x, y, 1), unit sphere, or upper sheet of the hyperboloid */
    const double *embedding_low;   /* [n_copies*3] what double precision cut off: the point is the sum of the two */
    const int32_t *cones, *orders; /* [n_cones] */
    const bool *mirrors;           /* [n_cones] whether it is a mirror corner */
    const double *weights;         /* [n_edges*3] rows i, j, w_ij as used; NULL where they live on other edges or are
                                      not symmetric */
    int32_t n_generators;          /* isometries that generate the group: 3 x 3 matrices, by rows */
    const double *generators;      /* [n_generators*9] on the model's coordinates; the mirrors' reflections too */
    const int32_t *seams;          /* [n_seams*2] edges of the mesh across which the layout is not continuous */
    const char *signature, *geometry;
} orb_view;
ORB_API void orb_embedding_view(const orb_embedding *embedding, orb_view *view);

/* Measures of an embedding. Lengths and areas on the tile are those of the geometry. The measures of distortion leave
 * out triangles without area, and are 0 where no other is left. */
typedef struct orb_report {
    int32_t vertices, triangles, components, euler, boundary_loops, genus; /* of the input; cross-caps if not */
    bool orientable;                                                       /* orientable */
    int32_t filled_holes, refined_edges; /* holes closed, and edges halved, for the computation */
    double orbifold_euler;
    int32_t n_moduli;   /* dimensions of the family of flat orbifolds from which the least conformal energy chose */
    double modulus[2];  /* shape of the lattice of translations, second over first of a reduced basis (plane only) */
    int32_t iterations; /* steps of the minimiser */
    double energy;      /* 1/2 sum over glued edges of w_ij d_ij^2 */
    double relative_gradient; /* max over vertices of |g_v| / sum_j w_vj d_vj */
    int64_t clamped_weights, factor_nonzeros;
    int64_t flipped, flipped_float32;     /* the second: UVs of the default chart rounded to float */
    double seam_residual;                 /* relative to the edge or the median edge, whichever is longer */
    double angle_residual, area_residual; /* radians; relative (0 in the plane) */
    double quasi_conformal_mean, quasi_conformal_median, quasi_conformal_max; /* area weighted on the mesh */
    double log_area_std;        /* area-weighted standard deviation of log(area on the tile / area on the mesh) */
    double symmetric_dirichlet; /* area-weighted mean of (s1^2 + s2^2 + 1/s1^2 + 1/s2^2) / 4, both areas scaled to 1 */
    double seconds_topology, seconds_cut, seconds_tile, seconds_initial, seconds_assemble, seconds_analyze,
        seconds_factor, seconds_solve, seconds_certify, seconds_total;
} orb_report;
ORB_API void orb_embedding_report(const orb_embedding *embedding, orb_report *report);

typedef enum orb_chart {
    ORB_CHART_DEFAULT = 0,     /* periodic, stereographic or Poincaré, after the geometry */
    ORB_CHART_PERIODIC,        /* plane: a lattice of translations becomes the unit square's */
    ORB_CHART_CONFORMAL,       /* plane: no shear, the tile fills the unit square */
    ORB_CHART_STEREOGRAPHIC,   /* sphere, from the point opposite to the tile's centre */
    ORB_CHART_EQUIRECTANGULAR, /* sphere: longitude and latitude */
    ORB_CHART_OCTAHEDRAL,      /* sphere unfolded to the unit square */
    ORB_CHART_POINCARE,        /* hyperbolic: conformal disk */
    ORB_CHART_KLEIN            /* hyperbolic: straight geodesics */
} orb_chart;

/* Texture coordinates per triangle corner, uv[n_triangles*3*2]. *flipped_float32 (may be NULL): how many triangles are
 * not positively oriented once these are rounded to float. Error: ORB_BAD_ARGUMENT for a chart of another geometry. */
ORB_API orb_status orb_uv(const orb_embedding *embedding, orb_chart chart, double *uv, int64_t *flipped_float32,
                          orb_error *error);

/* One point of the unit sphere for each vertex, positions[n_vertices*3]: a spherical embedding divided by its group
 * and centred (docs/mathematics.md, section 7), so that a closed mesh needs no cut. Certified: every triangle is
 * positively oriented and the degree is one. *mended (may be NULL): triangles that the division had flipped and that
 * were mended. Isolated vertices get the origin. */
ORB_API orb_status orb_whole_sphere(const orb_embedding *embedding, double *positions, int64_t *mended,
                                    orb_error *error);

/* The same as orb_embed on a thread of the library's own. The arrays of mesh and request are copied; the request's
 * progress is not called: poll instead. */
typedef struct orb_job orb_job;
ORB_API orb_status orb_job_start(const orb_mesh_arrays *mesh, const orb_request *request, orb_job **job,
                                 orb_error *error);
/* True once the job is done (or cancelled). stage[32] and fraction may be NULL. */
ORB_API bool orb_job_poll(orb_job *job, char *stage, double *fraction);
/* Asks the job to stop; finishing it then returns ORB_CANCELLED at once, at any size of mesh. */
ORB_API void orb_job_cancel(orb_job *job);
/* Waits, hands over the embedding (or the error), and frees the job, which may be NULL. */
ORB_API orb_status orb_job_finish(orb_job *job, orb_embedding **embedding, orb_error *error);

ORB_API const char *orb_version(void); /* "0.2.0" */

#ifdef __cplusplus
}
#endif
#endif
