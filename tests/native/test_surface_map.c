/* Maps from mesh to mesh: identities, inverses, known answers, refusals. SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>

#include "check.h"
#include "embed.h"
#include "orbifold_maps.h"
#include "spread_picks.h"

enum { MOST = 64 };
static const double pi = 3.14159265358979323846;

typedef struct mapped {
    int32_t n, *triangles;
    double *weights; /* [n*3] */
    orb_status status;
    orb_error error;
    orb_map_report report;
} mapped;

static mapped map_from(const orb_embedding *a, const orb_embedding *b, int32_t n, const int32_t *triangles,
                       const double *weights) {
    mapped m = {.n = n};
    m.triangles = sample_allocate((size_t)n, sizeof *m.triangles);
    m.weights = sample_allocate(3 * (size_t)n, sizeof *m.weights);
    m.status =
        orb_surface_map(a, b, triangles ? n : 0, triangles, weights, m.triangles, m.weights, &m.report, &m.error);
    return m;
}

static mapped map_vertices(const orb_embedding *a, const orb_embedding *b) {
    return map_from(a, b, a->surface->n_input_vertices, NULL, NULL);
}

static void mapped_free(mapped *m) {
    free(m->triangles);
    free(m->weights);
}

/* Where point i is in space. */
static void point_of_mapped(const mapped *m, const sample_mesh *mesh, int32_t i, double p[3]) {
    for (int k = 0; k < 3; k++) {
        p[k] = 0;
        for (int c = 0; c < 3; c++)
            p[k] += m->weights[3 * i + c] *
                    mesh->vertices[3 * (size_t)mesh->triangles[3 * (size_t)m->triangles[i] + (size_t)c] + (size_t)k];
    }
}

/* The farthest that a vertex of `from` is from where it went on `mesh`. */
static double farthest(const mapped *m, const sample_mesh *from, const sample_mesh *mesh) {
    double most = 0;
    for (int32_t v = 0; v < m->n; v++) {
        double p[3], square = 0;
        if (m->triangles[v] < 0)
            return INFINITY;
        point_of_mapped(m, mesh, v, p);
        for (int k = 0; k < 3; k++)
            square += (p[k] - from->vertices[3 * v + k]) * (p[k] - from->vertices[3 * v + k]);
        if (!(sqrt(square) <= most))
            most = sqrt(square);
    }
    return most;
}

static void check_weights(const mapped *m) {
    double least = 0, sum = 0;
    for (int32_t i = 0; i < m->n; i++) {
        const double *w = m->weights + 3 * i;
        least = fmin(least, fmin(w[0], fmin(w[1], w[2])));
        sum = fmax(sum, m->triangles[i] >= 0 ? fabs(w[0] + w[1] + w[2] - 1) : 0);
    }
    CHECK(least >= 0);
    CHECK_NEAR(sum, 0, 1e-14);
}

static orb_status embed_along(const sample_mesh *mesh, const char *signature, int32_t n, const int32_t *cones,
                              orb_weights weights, double clamp, orb_embedding **embedding) {
    orb_mesh_arrays arrays = sample_arrays(mesh);
    orb_request request = orb_request_default();
    orb_error error;
    request.signature = signature;
    request.n_cones = n;
    request.cones = cones;
    request.weights = weights;
    request.clamp = clamp;
    request.cut = ORB_CUT_PATH;
    const orb_status status = orb_embed(&arrays, &request, embedding, &error);
    if (status != ORB_OK)
        CHECK_FAILED("%s: %s", signature, error.message);
    return status;
}

/* --- identities, inverses ---------------------------------------------------------------------------------------- */

/* All edges from both sides, on a mesh that is the same or has the same number of triangles: without gaps in `at`, the
 * weights of places, and between stretches on sides. On the mesh itself along sides only. */
static void check_courses(const orb_embedding *a, const orb_embedding *b, int32_t n_triangles) {
    int32_t *corners = sample_allocate(3 * (size_t)n_triangles, sizeof *corners), wrong = 0, edge = -1;
    orb_trace *trace = NULL;
    orb_error error;
    for (int32_t h = 0; h < 3 * n_triangles; h++)
        corners[h] = h;
    CHECK(orb_surface_map_trace(a, b, 3 * n_triangles, corners, &trace, &error) == ORB_OK);
    const int64_t n = trace ? orb_trace_count(trace) : 0;
    orb_stretch *stretches = sample_allocate((size_t)n, sizeof *stretches);
    if (trace)
        orb_trace_read(trace, stretches);
    for (int64_t i = 0; i < n; i++) {
        const orb_stretch *s = &stretches[i], *before = s - 1;
        const bool first = s->edge != edge, last = i + 1 == n || s[1].edge != s->edge;
        const double *from = s->barycentric, *to = s->barycentric + 3;
        wrong += first ? s->edge != edge + 1 || s->at[0] != 0 : s->at[0] != before->at[1];
        wrong += !(s->at[1] >= s->at[0]) || (last && s->at[1] != 1);
        for (int c = 0; c < 3; c++)
            wrong += !(from[c] >= 0 && to[c] >= 0 && fabs(to[0] + to[1] + to[2] - 1) < 1e-14);
        if (a == b)
            wrong += !((from[0] == 0 && to[0] == 0) || (from[1] == 0 && to[1] == 0) || (from[2] == 0 && to[2] == 0));
        else if (!first)
            wrong += a->surface->parent || b->surface->parent ? 0 : from[0] != 0 && from[1] != 0 && from[2] != 0;
        edge = s->edge;
    }
    CHECK(edge == 3 * n_triangles - 1);
    CHECK(wrong == 0);
    orb_trace_free(trace);
    free(stretches);
    free(corners);
}

/* A mesh onto itself, its vertices and the middles of its triangles. */
static void check_identity(const char *signature, const sample_mesh *mesh, const orb_embedding *embedding) {
    mapped all = map_vertices(embedding, embedding);
    CHECK(all.status == ORB_OK);
    check_weights(&all);
    CHECK_NEAR(farthest(&all, mesh, mesh), 0, 1e-12);
    int32_t *triangles = sample_allocate((size_t)mesh->n_triangles, sizeof *triangles), elsewhere = 0;
    double *weights = sample_allocate(3 * (size_t)mesh->n_triangles, sizeof *weights), off = 0;
    for (int32_t i = 0; i < 3 * mesh->n_triangles; i++) {
        triangles[i / 3] = i / 3;
        weights[i] = i % 3 == 0 ? 0.5 : 0.25;
    }
    mapped middle = map_from(embedding, embedding, mesh->n_triangles, triangles, weights);
    CHECK(middle.status == ORB_OK);
    for (int32_t i = 0; i < 3 * mesh->n_triangles && middle.status == ORB_OK; i++) {
        elsewhere += middle.triangles[i / 3] != i / 3;
        off = fmax(off, fabs(middle.weights[i] - weights[i]));
    }
    CHECK(elsewhere == 0);
    CHECK_NEAR(off, 0, 1e-10);
    check_courses(embedding, embedding, mesh->n_triangles);
    orb_map_distortion distortion;
    CHECK(orb_surface_map_distortion(embedding, embedding, NULL, NULL, &distortion, NULL) == ORB_OK);
    CHECK(distortion.flipped == 0 && distortion.left_out == 0);
    CHECK_NEAR(distortion.quasi_conformal_max, 1, 1e-6);
    CHECK_NEAR(distortion.log_area_std, 0, 1e-6);
    if (check_failures)
        printf("     %s\n", signature);
    free(triangles);
    free(weights);
    mapped_free(&all);
    mapped_free(&middle);
}

/* The same surface with vertices elsewhere. */
static void check_there_and_back(const char *signature, const sample_mesh *mesh, int32_t n, const int32_t *picked,
                                 const orb_embedding *embedding) {
    sample_mesh other = sample_from(mesh->n_vertices, mesh->vertices, mesh->n_triangles, mesh->triangles);
    sample_roughen(&other, 0.03, 11);
    orb_embedding *second = NULL;
    if (embed_along(&other, signature, n, picked, ORB_WEIGHTS_UNIFORM, 0.01, &second) == ORB_OK) {
        mapped there = map_vertices(embedding, second), back = {0};
        CHECK(there.status == ORB_OK);
        if (there.status == ORB_OK) {
            back = map_from(second, embedding, there.n, there.triangles, there.weights);
            check_weights(&there);
            CHECK(back.status == ORB_OK);
            CHECK_NEAR(farthest(&back, mesh, mesh), 0, 1e-9);
            for (int32_t k = 0; k < n; k++) { /* landmarks to landmarks */
                double p[3];
                point_of_mapped(&there, &other, picked[k], p);
                CHECK(memcmp(p, other.vertices + 3 * picked[k], sizeof p) == 0);
            }
        }
        check_courses(embedding, second, mesh->n_triangles);
        orb_map_distortion distortion = {0};
        CHECK(orb_surface_map_distortion(embedding, second, NULL, NULL, &distortion, NULL) == ORB_OK);
        CHECK(distortion.flipped == 0);
        CHECK(distortion.quasi_conformal_mean >= 1 && distortion.quasi_conformal_max < 1e6);
        if (check_failures)
            printf("     %s there and back: %s\n", signature, there.error.message);
        mapped_free(&there);
        mapped_free(&back);
    }
    orb_embedding_free(second);
    sample_free(&other);
}

/* Cones in the sequence of a short walk: an erratic one makes limbs that no double precision resolves. */
static void walk_shortly(const sample_mesh *mesh, const char *signature, int32_t n, int32_t *picked) {
    orb_mesh_arrays arrays = sample_arrays(mesh);
    int32_t orders[MOST], sequence[MOST], before[MOST];
    orb_signature_info info;
    CHECK(orb_signature_read(signature, &info, orders, MOST, NULL) == ORB_OK);
    CHECK(orb_landmark_sequence(&arrays, n, picked, orders, sequence, NULL) == ORB_OK);
    memcpy(before, picked, sizeof before);
    for (int32_t k = 0; k < n; k++)
        picked[k] = before[sequence[k]];
}

/* `fixed`: the cut is the same on every mesh. */
static void check_family(const char *signature, bool fixed) {
    orb_signature_info info;
    orb_error error;
    orb_embedding *embedding = NULL;
    int32_t picked[MOST];
    REQUIRE(orb_signature_read(signature, &info, NULL, 0, &error) == ORB_OK);
    sample_mesh mesh = sample_surface(info.n_handles, info.n_crosscaps, info.n_mirrors);
    const int32_t n = pick(&mesh, signature, info.n_interior, picked);
    if (info.n_mirrors + info.n_crosscaps + info.n_handles == 0)
        walk_shortly(&mesh, signature, n, picked);
    if (embed_along(&mesh, signature, n, picked, ORB_WEIGHTS_CONFORMAL, 0.01, &embedding) == ORB_OK) {
        check_identity(signature, &mesh, embedding);
        if (fixed)
            check_there_and_back(signature, &mesh, n, picked, embedding);
    }
    orb_embedding_free(embedding);
    sample_free(&mesh);
}

#define CHECK_ALL(fixed, ...)                                                                                          \
    do {                                                                                                               \
        static const char *const all[] = {__VA_ARGS__};                                                                \
        for (size_t i = 0; i < sizeof all / sizeof *all; i++)                                                          \
            check_family(all[i], fixed);                                                                               \
    } while (0)

TEST(spheres) {
    CHECK_ALL(true, "532", "432", "332", "223", "22", "55", "442", "333", "632", "2222", "237", "22222", "33232323",
              "222222222222222");
}
TEST(disks) {
    CHECK_ALL(true, "*532", "*432", "*332", "*222", "*225", "*33", "3*2", "2*2", "2*5", "2*", "5*", "*442", "*333",
              "*632", "*2222", "4*2", "3*3", "2*22", "22*", "*237", "*22222", "5*3", "3*22", "22*2", "23*4");
}
TEST(other_surfaces) {
    CHECK_ALL(true, "o", "**", "2**", "**2", "*2*2", "23**2", "***", "2*3*4", "*2*2*2");
    CHECK_ALL(false, "2x", "5x", "22x", "*x", "xx", "23x", "*2x", "2*x", "xxx", "*xx", "o2", "o33", "o*", "oo", "ooo");
}

/* --- known answers ----------------------------------------------------------------------------------------------- */

/* Two meshes of one flat surface, which the embeddings reproduce: points go to where they are. */
static void check_same_place(sample_mesh a, sample_mesh b, const char *signature, int32_t n) {
    static const int32_t cones[] = {0, 1, 2, 3};
    orb_embedding *first = NULL, *second = NULL;
    if (embed_along(&a, signature, n, cones, ORB_WEIGHTS_COTANGENT, 1e-13, &first) == ORB_OK &&
        embed_along(&b, signature, n, cones, ORB_WEIGHTS_COTANGENT, 1e-13, &second) == ORB_OK) {
        mapped m = map_vertices(first, second);
        orb_map_distortion distortion;
        CHECK(m.status == ORB_OK);
        CHECK_NEAR(farthest(&m, &a, &b), 0, 1e-9);
        CHECK(orb_surface_map_distortion(first, second, NULL, NULL, &distortion, NULL) == ORB_OK);
        CHECK_NEAR(distortion.quasi_conformal_max, 1, 1e-6);
        CHECK_NEAR(distortion.log_area_mean, 0, 1e-7);
        if (check_failures)
            printf("     %s\n", signature);
        mapped_free(&m);
    }
    orb_embedding_free(first);
    orb_embedding_free(second);
    sample_free(&a);
    sample_free(&b);
}

TEST(flat_surfaces_are_mapped_to_where_they_are) {
    check_same_place(sample_pillow_triangle(pi / 4, pi / 4, 6), sample_pillow_triangle(pi / 4, pi / 4, 7), "442", 3);
    check_same_place(sample_pillow_triangle(pi / 6, pi / 3, 4), sample_pillow_triangle(pi / 6, pi / 3, 12), "632", 3);
    check_same_place(sample_pillow_rectangle(3, 1, 12, 5), sample_pillow_rectangle(3, 1, 7, 6), "2222", 4);
    check_same_place(sample_triangle(pi / 4, pi / 4, 6), sample_triangle(pi / 4, pi / 4, 5), "*442", 3);
    check_same_place(sample_rectangle(2, 1, 8, 5), sample_rectangle(2, 1, 6, 9), "*2222", 4);
}

TEST(an_affine_map_between_rectangles) {
    static const int32_t corners[] = {0, 1, 2, 3};
    sample_mesh a = sample_rectangle(1, 1, 6, 6), b = sample_rectangle(3, 1, 8, 5);
    orb_embedding *first = NULL, *second = NULL;
    CHECK(embed_along(&a, "*2222", 4, corners, ORB_WEIGHTS_COTANGENT, 1e-13, &first) == ORB_OK);
    CHECK(embed_along(&b, "*2222", 4, corners, ORB_WEIGHTS_COTANGENT, 1e-13, &second) == ORB_OK);
    mapped m = map_vertices(first, second);
    for (int32_t v = 0; v < a.n_vertices; v++)
        a.vertices[3 * v] *= 3;
    CHECK_NEAR(farthest(&m, &a, &b), 0, 1e-9);
    mapped_free(&m);
    orb_embedding_free(first);
    orb_embedding_free(second);
    sample_free(&a);
    sample_free(&b);
}

/* Points of one mirror go onto the other mesh's, exactly. */
TEST(mirrors_go_to_mirrors) {
    static const char *const all[] = {"*442", "*22222", "4*2", "*532"};
    sample_mesh mesh = sample_surface(0, 0, 1), fine = sample_refined(&mesh, 2);
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        orb_signature_info info;
        orb_error error;
        int32_t picked[MOST];
        orb_embedding *a = NULL, *b = NULL;
        REQUIRE(orb_signature_read(all[i], &info, NULL, 0, &error) == ORB_OK);
        const int32_t n = pick(&mesh, all[i], info.n_interior, picked);
        CHECK(embed_along(&mesh, all[i], n, picked, ORB_WEIGHTS_COTANGENT, 0.01, &a) == ORB_OK);
        CHECK(embed_along(&fine, all[i], n, picked, ORB_WEIGHTS_MEAN_VALUE, 0.01, &b) == ORB_OK);
        mapped m = map_vertices(b, a);
        CHECK(m.status == ORB_OK);
        bool *border = border_sides(&mesh), *of_fine = border_sides(&fine);
        int32_t inside = 0, seen = 0;
        for (int32_t h = 0; h < 3 * fine.n_triangles && m.status == ORB_OK; h++) {
            if (!of_fine[h])
                continue;
            const int32_t v = fine.triangles[h], t = m.triangles[v];
            bool on_mirror = false;
            for (int c = 0; c < 3; c++) { /* on an edge of the mirror, or at one of its ends */
                on_mirror = on_mirror || (border[3 * t + c] && m.weights[3 * v + (c + 2) % 3] == 0);
                for (int32_t g = 0; g < 3 * mesh.n_triangles && m.weights[3 * v + c] == 1; g++)
                    on_mirror = on_mirror || (border[g] && mesh.triangles[g] == mesh.triangles[3 * t + c]);
            }
            inside += !on_mirror;
            seen++;
        }
        CHECK(inside == 0 && seen > 10);
        free(border);
        free(of_fine);
        mapped_free(&m);
        orb_embedding_free(a);
        orb_embedding_free(b);
    }
    sample_free(&mesh);
    sample_free(&fine);
}

TEST(holes_and_loose_vertices_are_nowhere) {
    static const int32_t cones[] = {0, 14, 30};
    sample_mesh closed = sample_icosphere(2), open = sample_icosphere(2);
    open.n_triangles -= 1;
    closed.n_vertices += 1; /* isolated */
    closed.vertices = realloc(closed.vertices, 3 * (size_t)closed.n_vertices * sizeof(double));
    REQUIRE(closed.vertices);
    memset(closed.vertices + 3 * (size_t)closed.n_vertices - 3, 0, 3 * sizeof(double));
    orb_embedding *a = NULL, *b = NULL;
    orb_error error;
    orb_mesh_arrays arrays = sample_arrays(&open);
    orb_request request = orb_request_default();
    request.signature = "442";
    request.n_cones = 3;
    request.cones = cones;
    request.holes = ORB_HOLES_FILL;
    CHECK(orb_embed(&arrays, &request, &b, &error) == ORB_OK);
    CHECK(embed_along(&closed, "442", 3, cones, ORB_WEIGHTS_CONFORMAL, 0.01, &a) == ORB_OK);
    const int32_t where = closed.n_triangles - 1;
    const double middle[3] = {1.0 / 3, 1.0 / 3, 1.0 / 3};
    mapped m = map_from(a, b, 1, &where, middle), all = map_vertices(a, b), other = map_vertices(b, a);
    CHECK(m.status == ORB_OK && m.triangles[0] == -1 && m.weights[0] == 0 && m.report.in_holes == 1);
    CHECK(all.status == ORB_OK && all.triangles[all.n - 1] == -1 && all.report.in_holes <= 3);
    CHECK(other.status == ORB_OK && other.report.in_holes == 0);
    orb_map_distortion distortion;
    CHECK(orb_surface_map_distortion(a, b, NULL, NULL, &distortion, NULL) == ORB_OK && distortion.left_out == 1);
    mapped none = map_from(a, b, 1, &(int32_t){-1}, middle);
    CHECK(none.status == ORB_OK && none.triangles[0] == -1 && none.report.in_holes == 0);
    mapped_free(&none);
    mapped_free(&m);
    mapped_free(&all);
    mapped_free(&other);
    orb_embedding_free(a);
    orb_embedding_free(b);
    sample_free(&open);
    sample_free(&closed);
}

/* A disk on a polygon whose boundary does not move. */
TEST(polygons) {
    sample_mesh a = sample_rectangle(1, 1, 6, 7), b = sample_rectangle(1, 1, 5, 4);
    static const int32_t corners[] = {0, 1, 2, 3};
    for (int curvature = -1; curvature <= 1; curvature++) {
        orb_request request = orb_request_default();
        request.polygon = &(orb_polygon){.curvature = curvature, .n_corners = 4};
        request.cones = corners;
        request.n_cones = 4;
        orb_embedding *first = NULL, *second = NULL;
        orb_error error;
        orb_mesh_arrays of_a = sample_arrays(&a), of_b = sample_arrays(&b);
        CHECK(orb_embed(&of_a, &request, &first, &error) == ORB_OK);
        CHECK(orb_embed(&of_b, &request, &second, &error) == ORB_OK);
        mapped there = map_vertices(first, second);
        CHECK(there.status == ORB_OK);
        mapped back = map_from(second, first, there.n, there.triangles, there.weights);
        CHECK(back.status == ORB_OK);
        CHECK_NEAR(farthest(&back, &a, &a), 0, 1e-10);
        CHECK_NEAR(farthest(&there, &a, &b), 0, 0.3);
        mapped_free(&there);
        mapped_free(&back);
        orb_embedding_free(first);
        orb_embedding_free(second);
    }
    sample_free(&a);
    sample_free(&b);
}

/* --- many landmarks ---------------------------------------------------------------------------------------------- */

static int32_t count_roughly(const mapped *m, const sample_mesh *from, const sample_mesh *to, double reach) {
    int32_t far = 0;
    for (int32_t v = 0; v < m->n; v++) {
        double p[3], square = 0;
        point_of_mapped(m, to, v, p);
        for (int k = 0; k < 3; k++)
            square += (p[k] - from->vertices[3 * v + k]) * (p[k] - from->vertices[3 * v + k]);
        far += !(square < reach * reach);
    }
    return far;
}

TEST(random_landmarks_on_nearly_the_same_sphere) {
    random_state state = {2026};
    sample_mesh a = sample_icosphere(3), b = sample_icosphere(3);
    orb_mesh_arrays arrays = sample_arrays(&a);
    sample_roughen(&b, 0.02, 5);
    for (int round = 0; round < 20; round++) {
        static const int32_t counts[] = {4, 5, 7, 12, 30, 50};
        const int32_t n = counts[round % 6];
        int32_t cones[MOST], sequence[MOST], walk[MOST];
        char signature[MOST + 1] = {0};
        memset(signature, '2', (size_t)n);
        orb_embedding *first = NULL, *second = NULL;
        orb_error error;
        pick_cones(&state, a.n_vertices, n, cones);
        REQUIRE(orb_landmark_sequence(&arrays, n, cones, NULL, sequence, &error) == ORB_OK);
        for (int32_t k = 0; k < n; k++)
            walk[k] = cones[sequence[k]];
        REQUIRE(embed_along(&a, signature, n, walk, ORB_WEIGHTS_COTANGENT, 0.01, &first) == ORB_OK);
        REQUIRE(embed_along(&b, signature, n, walk, ORB_WEIGHTS_UNIFORM, 0.01, &second) == ORB_OK);
        mapped there = map_vertices(first, second);
        CHECK(there.status == ORB_OK);
        mapped back = map_from(second, first, there.n, there.triangles, there.weights);
        CHECK_NEAR(farthest(&back, &a, &a), 0, 1e-9);
        CHECK(count_roughly(&there, &a, &b, 0.6) == 0); /* it winds round no landmark */
        mapped_free(&there);
        mapped_free(&back);
        orb_embedding_free(first);
        orb_embedding_free(second);
    }
    sample_free(&a);
    sample_free(&b);
}

TEST(three_meshes_agree) {
    static const int32_t cones[] = {0, 5, 2, 9, 3};
    sample_mesh mesh[3] = {sample_icosphere(2), sample_icosphere(3), sample_icosphere(2)};
    orb_embedding *embedding[3] = {NULL};
    for (int i = 0; i < 3; i++) {
        sample_roughen(&mesh[i], 0.02, (uint64_t)i);
        REQUIRE(embed_along(&mesh[i], "22222", 5, cones, ORB_WEIGHTS_COTANGENT, 0.01, &embedding[i]) == ORB_OK);
    }
    mapped there = map_vertices(embedding[0], embedding[1]), direct = map_vertices(embedding[0], embedding[2]);
    mapped on = map_from(embedding[1], embedding[2], there.n, there.triangles, there.weights);
    double gap = 0;
    for (int32_t v = 0; v < there.n; v++) {
        double p[3], q[3];
        point_of_mapped(&on, &mesh[2], v, p);
        point_of_mapped(&direct, &mesh[2], v, q);
        for (int k = 0; k < 3; k++)
            gap = fmax(gap, fabs(p[k] - q[k]));
    }
    CHECK_NEAR(gap, 0, 1e-11);
    mapped_free(&there);
    mapped_free(&direct);
    mapped_free(&on);
    for (int i = 0; i < 3; i++) {
        orb_embedding_free(embedding[i]);
        sample_free(&mesh[i]);
    }
}

/* --- what has no map --------------------------------------------------------------------------------------------- */

static void check_refused(const orb_embedding *a, const orb_embedding *b, const char *word) {
    mapped m = map_vertices(a, b);
    CHECK(m.status == ORB_NO_CORRESPONDENCE);
    CHECK(strstr(m.error.message, word) != NULL);
    if (check_failures)
        printf("     %s\n", m.error.message);
    mapped_free(&m);
}

TEST(refusals_say_what_to_do) {
    static const int32_t cones[] = {0, 14, 30, 3, 7, 22, 55, 60}, swapped[] = {14, 0, 30};
    sample_mesh mesh = sample_icosphere(2);
    orb_mesh_arrays arrays = sample_arrays(&mesh);
    orb_embedding *a = NULL, *b = NULL, *c = NULL, *path = NULL, *graph = NULL;
    orb_error error;
    REQUIRE(embed_along(&mesh, "442", 3, cones, ORB_WEIGHTS_COTANGENT, 0.01, &a) == ORB_OK);
    REQUIRE(embed_along(&mesh, "333", 3, cones, ORB_WEIGHTS_COTANGENT, 0.01, &b) == ORB_OK);
    check_refused(a, b, "one orbifold");
    orb_request request = orb_request_default();
    request.signature = "442";
    request.n_cones = 3;
    request.cones = swapped;
    request.orders = (int32_t[]){4, 2, 4};
    REQUIRE(orb_embed(&arrays, &request, &c, &error) == ORB_OK);
    check_refused(a, c, "one sequence");
    REQUIRE(embed_along(&mesh, "22222222", 8, cones, ORB_WEIGHTS_COTANGENT, 0.01, &path) == ORB_OK);
    CHECK(embed(&mesh, "22222222", 8, cones, 0.01, &graph, &error) == ORB_OK);
    check_refused(path, graph, "'path'");
    mapped m = map_from(a, a, 1, &(int32_t){100000}, (double[]){1, 0, 0});
    CHECK(m.status == ORB_BAD_ARGUMENT);
    mapped_free(&m);
    m = map_from(a, a, 1, &(int32_t){0}, (double[]){1, 1, 0});
    CHECK(m.status == ORB_BAD_ARGUMENT);
    mapped_free(&m);
    CHECK(orb_surface_map(a, NULL, 0, NULL, NULL, NULL, NULL, NULL, &error) == ORB_BAD_ARGUMENT);
    CHECK(orb_surface_map_distortion(a, NULL, NULL, NULL, NULL, &error) == ORB_BAD_ARGUMENT);
    CHECK(orb_landmark_sequence(&arrays, 2, (int32_t[]){3, 3}, NULL, (int32_t[2]){0}, &error) == ORB_BAD_CONE);
    CHECK(orb_landmark_sequence(NULL, 0, NULL, NULL, NULL, &error) == ORB_BAD_ARGUMENT);
    orb_embedding_free(a);
    orb_embedding_free(b);
    orb_embedding_free(c);
    orb_embedding_free(path);
    orb_embedding_free(graph);
    sample_free(&mesh);
}

/* What is nowhere on the target is named, not put where it is not. */
TEST(points_that_are_not_found_are_named) {
    static const int32_t corners[] = {0, 1, 2};
    sample_mesh mesh = sample_triangle(pi / 4, pi / 4, 4);
    orb_embedding *a = NULL, *b = NULL;
    REQUIRE(embed_along(&mesh, "*442", 3, corners, ORB_WEIGHTS_COTANGENT, 0.01, &a) == ORB_OK);
    REQUIRE(embed_along(&mesh, "*442", 3, corners, ORB_WEIGHTS_COTANGENT, 0.01, &b) == ORB_OK);
    bool *border = border_sides(&mesh);
    int32_t on_mirror = 0, inside = 3;
    while (!border[on_mirror] || mesh.triangles[on_mirror] < 3)
        on_mirror++;
    on_mirror = mesh.triangles[on_mirror];
    for (int32_t h = 0; h < 3 * mesh.n_triangles; h++)
        if (border[h] && mesh.triangles[h] == inside) {
            inside++;
            h = -1;
        }
    const struct {
        int32_t vertex;
        double complex place;
    } wrong[] = {{on_mirror, 10}, {inside, 10}, {inside, NAN}, {on_mirror, b->placed[inside].z}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        const orb_point kept = a->placed[wrong[i].vertex];
        a->placed[wrong[i].vertex] = point_of(wrong[i].place);
        mapped m = map_vertices(a, b);
        CHECK(m.status == ORB_POINT_NOT_FOUND);
        CHECK(m.error.element == ORB_VERTEX && m.error.n_elements == 1 && m.error.elements[0] == wrong[i].vertex);
        mapped_free(&m);
        a->placed[wrong[i].vertex] = kept;
    }
    free(border);
    orb_embedding_free(a);
    orb_embedding_free(b);
    sample_free(&mesh);
}

/* Corners that run the other way round would turn the map over. */
TEST(corners_the_other_way_round_are_refused) {
    sample_mesh mesh = sample_rectangle(1, 1, 5, 5);
    orb_embedding *a = NULL, *b = NULL;
    CHECK(embed_along(&mesh, "*2222", 4, (int32_t[]){0, 1, 2, 3}, ORB_WEIGHTS_COTANGENT, 0.01, &a) == ORB_OK);
    CHECK(embed_along(&mesh, "*2222", 4, (int32_t[]){0, 3, 2, 1}, ORB_WEIGHTS_COTANGENT, 0.01, &b) == ORB_OK);
    check_refused(a, b, "counter-clockwise");
    orb_embedding_free(b);
    b = NULL; /* but another one may be the first */
    CHECK(embed_along(&mesh, "*2222", 4, (int32_t[]){1, 2, 3, 0}, ORB_WEIGHTS_COTANGENT, 0.01, &b) == ORB_OK);
    mapped m = map_vertices(a, b);
    CHECK(m.status == ORB_OK && m.triangles[0] >= 0);
    double p[3];
    point_of_mapped(&m, &mesh, 0, p);
    CHECK(memcmp(p, mesh.vertices + 3 * 1, sizeof p) == 0);
    mapped_free(&m);
    orb_embedding_free(a);
    orb_embedding_free(b);
    sample_free(&mesh);
}

/* --- the authors' pair ------------------------------------------------------------------------------------------- */

TEST(heads) {
    sample_mesh a, b;
    if (!sample_read(&a, "head_max.off"))
        SKIP("no ../shared/meshes/head_max.off");
    if (!sample_read(&b, "head_julius.off")) {
        sample_free(&a);
        SKIP("no ../shared/meshes/head_julius.off");
    }
    /* top, neck, nose, ears, ... : far points of the first, and what is near on the second once both fill one box */
    static const int32_t on_a[] = {18800, 6592, 5309, 1605, 25326, 21318, 26209};
    static const int32_t on_b[] = {12347, 6822, 552, 23766, 20255, 14074, 18511};
    static const struct {
        const char *signature;
        int32_t n, at[7];
        double ratio;
    } all[] = {{"442", 3, {0, 4, 6}, 1.06},
               {"432", 3, {0, 4, 6}, 1.06},
               {"2222", 4, {0, 2, 6, 4}, 1.2},
               {"2222222", 7, {0, 1, 2, 3, 4, 5, 6}, 1.3}};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        int32_t p[7], q[7];
        for (int32_t k = 0; k < all[i].n; k++) {
            p[k] = on_a[all[i].at[k]];
            q[k] = on_b[all[i].at[k]];
        }
        orb_embedding *first = NULL, *second = NULL;
        REQUIRE(embed_along(&a, all[i].signature, all[i].n, p, ORB_WEIGHTS_CONFORMAL, 0.01, &first) == ORB_OK);
        REQUIRE(embed_along(&b, all[i].signature, all[i].n, q, ORB_WEIGHTS_CONFORMAL, 0.01, &second) == ORB_OK);
        mapped there = map_vertices(first, second);
        mapped back = map_from(second, first, there.n, there.triangles, there.weights);
        orb_map_distortion distortion;
        CHECK(there.status == ORB_OK && back.status == ORB_OK);
        CHECK(there.report.steps < 5 * (int64_t)there.n); /* the time is linear; 2.2 for each vertex */
        CHECK_NEAR(farthest(&back, &a, &a), 0, 1e-9);
        CHECK(orb_surface_map_distortion(first, second, NULL, NULL, &distortion, NULL) == ORB_OK);
        CHECK(distortion.flipped == 0 && distortion.quasi_conformal_mean < all[i].ratio);
        mapped_free(&there);
        mapped_free(&back);
        orb_embedding_free(first);
        orb_embedding_free(second);
    }
    sample_free(&a);
    sample_free(&b);
}
