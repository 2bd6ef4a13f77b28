/* Conformal and Delaunay weights, from the mesh to the certificate. SPDX-License-Identifier: GPL-3.0-or-later */
#include "check.h"
#include "embed.h"

static const double PI = 3.14159265358979323846;

/* Moves vertices off the boundary within the plane z = 0, by up to `amount`. */
static void jitter(sample_mesh *disk, double amount) {
    orb_mesh *mesh = NULL;
    const orb_mesh_arrays arrays = sample_arrays(disk);
    if (mesh_create(&arrays, &mesh, NULL) != ORB_OK)
        abort();
    bool *border = sample_allocate((size_t)disk->n_vertices, sizeof *border);
    mesh_find_boundary(mesh, border);
    random_state state = {4};
    for (int32_t v = 0; v < disk->n_vertices; v++)
        for (int k = 0; k < 2; k++)
            disk->vertices[3 * v + k] += border[v] ? 0 : amount * (random_unit(&state) - 0.5);
    free(border);
    mesh_free(mesh);
}

static sample_mesh rough_triangle(double angle_0, double angle_1, int32_t n) {
    sample_mesh disk = sample_triangle(angle_0, angle_1, n);
    jitter(&disk, 0.15 / n);
    return disk;
}

static sample_mesh doubled(sample_mesh disk) {
    sample_mesh pillow = sample_doubled(&disk);
    sample_free(&disk);
    return pillow;
}

/* Inversion in a sphere: l_ij becomes l_ij / (|p_i| |p_j|), so that the meshes are discretely conformally equivalent
 * (Bobenko, Pinkall and Springborn 2015, section 2). */
static sample_mesh inverted(sample_mesh mesh, double x, double y, double z) {
    for (int32_t v = 0; v < mesh.n_vertices; v++) {
        double *p = mesh.vertices + 3 * (size_t)v;
        p[0] -= x, p[1] -= y, p[2] -= z;
        const double square = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
        for (int k = 0; k < 3; k++)
            p[k] /= square;
    }
    return mesh;
}

typedef struct outcome {
    orb_status status;
    orb_report report;
    bool has_weights;
    int32_t n_triangles, n_copies;
    double *length; /* [n_triangles*3] of the sides on the tile */
} outcome;

static outcome run(const sample_mesh *mesh, const char *signature, int32_t k, const int32_t *cones, orb_weights kind,
                   double clamp) {
    outcome out = {0};
    const orb_mesh_arrays arrays = sample_arrays(mesh);
    orb_request request = orb_request_default();
    request.signature = signature;
    request.n_cones = k;
    request.cones = cones;
    request.weights = kind;
    request.clamp = clamp;
    orb_embedding *embedding = NULL;
    orb_error error;
    out.status = orb_embed(&arrays, &request, &embedding, &error);
    if (out.status != ORB_OK) {
        CHECK_FAILED("%s %s", signature, error.message);
        return out;
    }
    orb_view view;
    orb_embedding_view(embedding, &view);
    orb_embedding_report(embedding, &out.report);
    out.has_weights = view.weights != NULL;
    out.n_triangles = view.n_triangles;
    out.n_copies = view.n_copies;
    out.length = sample_allocate(3 * (size_t)view.n_triangles, sizeof *out.length);
    for (int32_t h = 0; h < 3 * view.n_triangles; h++) {
        const int32_t u = view.cut_triangles[h], v = view.cut_triangles[h % 3 == 2 ? h - 2 : h + 1];
        CHECK(u < view.n_copies && view.cut_to_vertex[u] == view.triangles[h]);
        out.length[h] =
            hypot(view.embedding[3 * u] - view.embedding[3 * v], view.embedding[3 * u + 1] - view.embedding[3 * v + 1]);
    }
    orb_embedding_free(embedding);
    return out;
}

/* A flat orbifold is its own harmonic image once its own cotangents are used as they are: an intrinsic Delaunay
 * triangulation has no negative ones, whatever the mesh. Clamped cotangents of the mesh's edges do not do. */
static void check_isometry(sample_mesh mesh, const char *signature, int32_t k) {
    const int32_t corners[] = {0, 1, 2, 3};
    const orb_weights kinds[] = {ORB_WEIGHTS_DELAUNAY, ORB_WEIGHTS_CONFORMAL};
    for (int i = 0; i < 2; i++) {
        outcome out = run(&mesh, signature, k, corners, kinds[i], 1e-11);
        CHECK_NEAR(out.report.energy, 1, 1e-8);
        CHECK_NEAR(out.report.quasi_conformal_max, 1, 1e-6);
        CHECK_NEAR(out.report.log_area_std, 0, 1e-6);
        CHECK(!out.has_weights);
        free(out.length);
    }
    outcome plain = run(&mesh, signature, k, corners, ORB_WEIGHTS_COTANGENT, 0.01);
    CHECK(plain.report.quasi_conformal_max > 1.05 && plain.has_weights);
    free(plain.length);
    sample_free(&mesh);
}

TEST(flat_pillows_are_met_exactly) {
    check_isometry(doubled(rough_triangle(PI / 4, PI / 4, 6)), "442", 3);
    check_isometry(doubled(rough_triangle(PI / 3, PI / 3, 6)), "333", 3);
    check_isometry(doubled(rough_triangle(PI / 6, PI / 3, 7)), "632", 3);
    sample_mesh rectangle = sample_rectangle(2, 1, 9, 6);
    jitter(&rectangle, 0.12);
    check_isometry(doubled(rectangle), "2222", 4);
}

TEST(flat_disks_are_met_exactly) {
    check_isometry(rough_triangle(PI / 4, PI / 4, 6), "*442", 3);
    check_isometry(rough_triangle(PI / 3, PI / 3, 6), "*333", 3);
    check_isometry(rough_triangle(PI / 6, PI / 3, 7), "*632", 3);
}

/* What inversion does to the lengths, the metric undoes. */
TEST(inversion_makes_no_difference) {
    const struct {
        bool pillow;
        const char *signature;
    } cases[] = {{true, "442"}, {false, "*442"}};
    for (int i = 0; i < 2; i++) {
        sample_mesh flat = rough_triangle(PI / 4, PI / 4, 6);
        flat = cases[i].pillow ? doubled(flat) : flat;
        sample_mesh round =
            inverted(sample_from(flat.n_vertices, flat.vertices, flat.n_triangles, flat.triangles), 0.3, 0.4, 0.5);
        const int32_t corners[] = {0, 1, 2};
        outcome one = run(&flat, cases[i].signature, 3, corners, ORB_WEIGHTS_CONFORMAL, 1e-11);
        outcome two = run(&round, cases[i].signature, 3, corners, ORB_WEIGHTS_CONFORMAL, 1e-11);
        outcome other = run(&round, cases[i].signature, 3, corners, ORB_WEIGHTS_DELAUNAY, 1e-11);
        double worst = 0, worst_other = 0;
        for (int32_t h = 0; h < 3 * one.n_triangles && one.length && two.length && other.length; h++) {
            worst = fmax(worst, fabs(two.length[h] / one.length[h] - 1));
            worst_other = fmax(worst_other, fabs(other.length[h] / one.length[h] - 1));
        }
        CHECK_NEAR(worst, 0, 1e-10);
        CHECK(worst_other > 0.02);
        free(one.length), free(two.length), free(other.length);
        sample_free(&flat);
        sample_free(&round);
    }
}

/* Every geometry and topology ends with a certificate, and conformal weights come nearer to a conformal map. */
TEST(certified_and_better_on_many_surfaces) {
    const struct {
        const char *signature;
        int32_t k, cones[7];
    } cases[] = {{"432", 3, {0, 40, 90}},
                 {"237", 3, {0, 40, 90}},
                 {"222222", 6, {0, 40, 90, 100, 120, 150}},
                 {"33", 2, {0, 90}},
                 {"2222", 4, {0, 40, 90, 11}}};
    for (int i = 0; i < 5; i++) {
        sample_mesh mesh = sample_icosphere(3);
        random_state state = {9};
        for (int32_t v = 0; v < mesh.n_vertices; v++)
            for (int k = 0; k < 3; k++)
                mesh.vertices[3 * v + k] *= 1 + 0.3 * random_unit(&state);
        outcome plain = run(&mesh, cases[i].signature, cases[i].k, cases[i].cones, ORB_WEIGHTS_COTANGENT, 0.01);
        outcome conformal = run(&mesh, cases[i].signature, cases[i].k, cases[i].cones, ORB_WEIGHTS_CONFORMAL, 0.01);
        outcome delaunay = run(&mesh, cases[i].signature, cases[i].k, cases[i].cones, ORB_WEIGHTS_DELAUNAY, 0.01);
        CHECK(conformal.report.quasi_conformal_median < plain.report.quasi_conformal_median);
        CHECK(conformal.report.clamped_weights * 4 < plain.report.clamped_weights);
        CHECK(conformal.n_copies == plain.n_copies && delaunay.n_copies == plain.n_copies);
        CHECK(delaunay.report.relative_gradient < 1e-9);
        if (cases[i].k == 2) /* the free dilation is chosen for the areas: away from the minimum, no weights to show */
            CHECK(!conformal.has_weights);
        else
            CHECK(conformal.report.relative_gradient < 1e-9);
        free(plain.length), free(conformal.length), free(delaunay.length);
        sample_free(&mesh);
    }
}

TEST(without_a_flip_the_weights_are_the_mesh_s) {
    sample_mesh mesh = sample_icosphere(2);
    outcome out = run(&mesh, "442", 3, (int32_t[]){0, 40, 90}, ORB_WEIGHTS_DELAUNAY, 0.01);
    outcome plain = run(&mesh, "442", 3, (int32_t[]){0, 40, 90}, ORB_WEIGHTS_COTANGENT, 0.01);
    CHECK(out.has_weights);
    for (int32_t h = 0; h < 3 * out.n_triangles; h++)
        CHECK_NEAR(out.length[h] / plain.length[h], 1, 1e-10);
    free(out.length), free(plain.length);
    sample_free(&mesh);
}

/* A scan with slivers: triangles of the mesh come out flipped at first and are mended. */
TEST(a_scan_is_mended) {
    sample_mesh mesh;
    if (!sample_read(&mesh, "david.obj"))
        SKIP("no ../shared/meshes/david.obj");
    outcome out = run(&mesh, "442", 3, (int32_t[]){1000, 12000, 20000}, ORB_WEIGHTS_CONFORMAL, 0.01);
    CHECK(out.report.flipped == 0 && !out.has_weights);
    CHECK(out.report.quasi_conformal_median < 1.05);
    free(out.length);
    sample_free(&mesh);
}

/* --- exact mean values, and what the message says --------------------------------------------------------------- */

static orb_status refused(const sample_mesh *mesh, const char *signature, int32_t k, orb_weights kind,
                          const char *word) {
    const orb_mesh_arrays arrays = sample_arrays(mesh);
    orb_request request = orb_request_default();
    request.signature = signature;
    request.n_cones = k;
    request.cones = (int32_t[]){0, 40, 90};
    request.weights = kind;
    orb_embedding *embedding = NULL;
    orb_error error;
    const orb_status status = orb_embed(&arrays, &request, &embedding, &error);
    CHECK(!embedding && strstr(error.message, word));
    orb_embedding_free(embedding);
    return status;
}

TEST(exact_mean_values_need_a_plane_and_a_cone) {
    sample_mesh sphere = sample_icosphere(2), torus = sample_torus(8, 6, 3, 1);
    CHECK(refused(&sphere, "432", 3, ORB_WEIGHTS_MEAN_VALUE_EXACT, "spherical") == ORB_BAD_ARGUMENT);
    CHECK(refused(&sphere, "237", 3, ORB_WEIGHTS_MEAN_VALUE_EXACT, "hyperbolic") == ORB_BAD_ARGUMENT);
    CHECK(refused(&torus, "o", 0, ORB_WEIGHTS_MEAN_VALUE_EXACT, "cone") == ORB_BAD_ARGUMENT);
    sample_free(&torus);
    sample_free(&sphere);
}

/* Mean-value coordinates have linear precision: a flat orbifold is met exactly by them too. */
TEST(exact_mean_values_meet_flat_surfaces) {
    const int32_t corners[] = {0, 1, 2};
    sample_mesh disk = rough_triangle(PI / 4, PI / 4, 6), pillow = sample_doubled(&disk);
    for (int i = 0; i < 2; i++) {
        const sample_mesh *mesh = i ? &pillow : &disk;
        outcome out = run(mesh, i ? "442" : "*442", 3, corners, ORB_WEIGHTS_MEAN_VALUE_EXACT, 0.01);
        outcome symmetrised = run(mesh, i ? "442" : "*442", 3, corners, ORB_WEIGHTS_MEAN_VALUE, 0.01);
        CHECK_NEAR(out.report.quasi_conformal_max, 1, 1e-9);
        CHECK(symmetrised.report.quasi_conformal_max > 1.02);
        CHECK(!out.has_weights && symmetrised.has_weights);
        CHECK(out.report.relative_gradient < 1e-12);
        free(out.length), free(symmetrised.length);
    }
    sample_free(&pillow);
    sample_free(&disk);
}

/* The message names weights that were tried and do it. */
TEST(the_message_says_which_weights_pass) {
    const double vertices[] = {0, 0, 0, 1, 0, 0, 2, 0, 0, 1, 1, 0, 1, -1, 0.5, 1, 0, 3};
    const int32_t triangles[] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 4, 0, 3, 5, 3, 2, 5, 2, 4, 5, 4, 0, 5};
    sample_mesh mesh = sample_from(6, vertices, 8, triangles);
    const orb_mesh_arrays arrays = sample_arrays(&mesh);
    orb_request request = orb_request_default();
    request.signature = "442";
    request.n_cones = 3;
    request.cones = (int32_t[]){3, 4, 5};
    request.weights = ORB_WEIGHTS_MEAN_VALUE; /* there are none for a triangle without area */
    orb_embedding *embedding = NULL;
    orb_error error;
    CHECK(orb_embed(&arrays, &request, &embedding, &error) == ORB_ZERO_AREA_TRIANGLE && !embedding);
    CHECK(strstr(error.message, "; cotangent weights embed it"));
    request.weights = ORB_WEIGHTS_COTANGENT;
    CHECK(orb_embed(&arrays, &request, &embedding, NULL) == ORB_OK);
    orb_embedding_free(embedding);
    sample_free(&mesh);
}
