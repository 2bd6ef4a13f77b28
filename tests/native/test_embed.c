/* The whole way: closed forms, independence of the cut, errors. SPDX-License-Identifier: GPL-3.0-or-later */
#include <complex.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "embed.h"

static const double pi = 3.14159265358979323846;

/* Largest relative difference between a triangle's edge lengths on the tile and `expected`, one per half-edge. */
static double length_gap(const orb_embedding *embedding, const double *expected, double scale) {
    double gap = 0;
    for (int32_t h = 0; h < 3 * embedding->mesh->n_triangles; h++) {
        orb_point p = embedding->placed[embedding->copies->triangles[h]];
        orb_point q = embedding->placed[embedding->copies->triangles[halfedge_next(h)]];
        double difference = fabs(geometry_distance(embedding->tile->geometry, p, q) - scale * expected[h]);
        if (!(difference <= gap))
            gap = difference;
    }
    return gap;
}

static double *lengths_of(const orb_embedding *embedding, bool on_tile) {
    const orb_mesh *mesh = embedding->mesh;
    double *lengths = malloc(3 * (size_t)mesh->n_triangles * sizeof *lengths);
    for (int32_t h = 0; h < 3 * mesh->n_triangles; h++)
        lengths[h] =
            on_tile ? geometry_distance(embedding->tile->geometry, embedding->placed[embedding->copies->triangles[h]],
                                        embedding->placed[embedding->copies->triangles[halfedge_next(h)]])
                    : mesh_edge_length(mesh, h);
    return lengths;
}

/* A flat pillow with its cones at its corners is already the orbifold. */
static void check_pillow(sample_mesh mesh, const char *signature, int32_t k) {
    int32_t cones[] = {0, 1, 2, 3};
    orb_embedding *embedding = NULL;
    orb_error error;
    CHECK(embed(&mesh, signature, k, cones, 1e-13, &embedding, &error) == ORB_OK);
    if (embedding) {
        double area = 0, *lengths = lengths_of(embedding, false);
        for (int32_t t = 0; t < mesh.n_triangles; t++)
            area += mesh_triangle_area(embedding->mesh, t);
        CHECK_NEAR(length_gap(embedding, lengths, 1 / sqrt(area)), 0, 1e-10);
        CHECK_NEAR(embedding->report.quasi_conformal_max, 1, 1e-8);
        CHECK_NEAR(embedding->report.energy, 1, 1e-9); /* half the Dirichlet energy of an isometry is its area */
        CHECK(embedding->report.iterations == 1);
        free(lengths);
    } else {
        printf("     %s: %s\n", signature, error.message);
    }
    orb_embedding_free(embedding);
    sample_free(&mesh);
}

TEST(flat_pillows_reproduce_themselves) {
    check_pillow(sample_pillow_triangle(pi / 4, pi / 4, 6), "442", 3);
    check_pillow(sample_pillow_triangle(pi / 3, pi / 3, 6), "333", 3);
    check_pillow(sample_pillow_triangle(pi / 6, pi / 3, 6), "632", 3);
    check_pillow(sample_pillow_rectangle(1, 1, 7, 9), "2222", 4);
    check_pillow(sample_pillow_rectangle(3, 1, 12, 5), "2222", 4);
}

/* The same weights on a stretched mesh: the shortest paths run elsewhere, but any two paths through three cones are
 * homotopic, so the embedding is the same (2015, figure 4; 2017, figure 13). */
static void check_two_cuts(const char *signature, double *energy) {
    random_state state = {99};
    sample_mesh mesh = sample_icosphere(4), stretched = sample_icosphere(4);
    int32_t cones[3], different = 0;
    pick_cones(&state, mesh.n_vertices, 3, cones);
    for (int32_t v = 0; v < mesh.n_vertices; v++)
        stretched.vertices[3 * v] *= 1 + 40 * fabs(stretched.vertices[3 * v + 1]);
    orb_embedding *first = NULL, *second = NULL;
    orb_error error;
    CHECK(embed(&mesh, signature, 3, cones, 0.01, &first, &error) == ORB_OK);
    REQUIRE(first != NULL);
    orb_mesh_arrays arrays = sample_arrays(&stretched);
    orb_request request = orb_request_default();
    request.signature = signature;
    request.n_cones = 3;
    request.cones = cones;
    request.weights = ORB_WEIGHTS_GIVEN;
    request.edge_weights = first->edge_weights;
    request.n_edge_weights = first->mesh->n_edges;
    CHECK(orb_embed(&arrays, &request, &second, &error) == ORB_OK);
    REQUIRE(second != NULL);
    for (int32_t i = 0; i < first->n_seams; i++) {
        bool shared = false;
        for (int32_t j = 0; j < second->n_seams; j++)
            shared = shared || (first->seams[2 * i] == second->seams[2 * j] &&
                                first->seams[2 * i + 1] == second->seams[2 * j + 1]);
        different += !shared;
    }
    CHECK(different > 3); /* or the test shows nothing */
    double *lengths = lengths_of(first, true);
    CHECK_NEAR(length_gap(second, lengths, 1), 0, 1e-9);
    energy[0] = first->report.energy;
    energy[1] = second->report.energy;
    free(lengths);
    orb_embedding_free(first);
    orb_embedding_free(second);
    sample_free(&mesh);
    sample_free(&stretched);
}

TEST(homotopic_cuts_give_one_embedding) {
    static const char *const all[] = {"442", "333", "632", "432", "532", "332", "22(5)", "237", "334"};
    double energy[2];
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        check_two_cuts(all[i], energy);
}

TEST(rigid_444_has_one_energy_from_two_cuts) {
    double energy[2] = {0, 1};
    check_two_cuts("444", energy);
    CHECK_NEAR(energy[1] / energy[0], 1, 1e-10);
}

TEST(the_plane_takes_one_step) {
    sample_mesh mesh = sample_icosphere(3);
    static const struct {
        const char *signature;
        int32_t k;
    } all[] = {{"442", 3}, {"333", 3}, {"632", 3}, {"2222", 4}};
    random_state state = {5};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        int32_t cones[4];
        orb_embedding *embedding = NULL;
        orb_error error;
        pick_cones(&state, mesh.n_vertices, all[i].k, cones);
        CHECK(embed(&mesh, all[i].signature, all[i].k, cones, 0.01, &embedding, &error) == ORB_OK);
        CHECK(embedding && embedding->report.iterations == 1);
        CHECK(embedding && embedding->report.relative_gradient < 1e-12);
        orb_embedding_free(embedding);
    }
    sample_free(&mesh);
}

TEST(every_solid_and_every_number_of_cones) {
    static const char *const all[] = {"22", "442", "2222", "22222", "222222", "2222222", "22222222"};
    for (int solid = 0; solid < 3; solid++) {
        sample_mesh mesh = solid == 0 ? sample_tetrahedron() : solid == 1 ? sample_octahedron() : sample_cube();
        int32_t cones[8] = {0, 1, 2, 3, 4, 5, 6, 7};
        for (int32_t k = 2; k <= 8 && k <= mesh.n_vertices; k++) {
            orb_embedding *embedding = NULL;
            orb_error error;
            orb_status status = embed(&mesh, all[k - 2], k, cones, 0.01, &embedding, &error);
            bool poles_touch = k == 2 && solid != 1; /* vertices 0 and 1 share an edge, but for the octahedron */
            CHECK(status == (poles_touch ? ORB_BAD_CONE : ORB_OK));
            if (status != ORB_OK && !poles_touch)
                printf("     solid %d with %d cones: %s\n", solid, (int)k, error.message);
            orb_embedding_free(embedding);
        }
        sample_free(&mesh);
    }
}

/* Triangles with no area, or hardly any, on the mesh: whatever is certified is reported in finite numbers. */
TEST(reports_are_finite_numbers) {
    static const struct {
        const char *signature;
        int32_t k;
    } all[] = {{"442", 3}, {"2222", 4}, {"332", 3}, {"33", 2}, {"237", 3}, {"222222", 6}};
    random_state state = {11};
    int32_t certified = 0;
    for (int round = 0; round < 60; round++) {
        sample_mesh mesh = sample_icosphere(2);
        for (int i = 0; i < 4; i++) {
            const int32_t *t = mesh.triangles + 3 * random_below(&state, mesh.n_triangles);
            for (int k = 0; k < 3; k++) /* its second vertex goes midway between the others, or nearly so */
                mesh.vertices[3 * t[1] + k] = (mesh.vertices[3 * t[0] + k] + mesh.vertices[3 * t[2] + k]) / 2 +
                                              (i % 2 ? 1e-14 : 0) * mesh.vertices[3 * t[1] + k];
        }
        sample_scale(&mesh, round % 3 == 0 ? 1e150 : round % 3 == 1 ? 1 : 1e-150);
        int32_t cones[6], kind = round % 6;
        orb_embedding *embedding = NULL;
        orb_error error;
        pick_cones(&state, mesh.n_vertices, all[kind].k, cones);
        if (embed(&mesh, all[kind].signature, all[kind].k, cones, 0.01, &embedding, &error) == ORB_OK) {
            const orb_report *report = &embedding->report;
            certified++;
            CHECK(report->quasi_conformal_median >= 1 && report->quasi_conformal_mean >= 1);
            CHECK(report->quasi_conformal_max >= 1 && isfinite(report->quasi_conformal_max));
            CHECK(isfinite(report->quasi_conformal_mean) && isfinite(report->symmetric_dirichlet));
            CHECK(report->log_area_std > 0 && isfinite(report->log_area_std) && isfinite(report->energy));
        }
        orb_embedding_free(embedding);
        sample_free(&mesh);
    }
    CHECK(certified > 40);
}

/* Slivers pull the modulus of 2222 towards an endless tile: it stays one whose area is right. */
TEST(slivers_do_not_spoil_the_modulus) {
    random_state state = {3};
    for (int round = 0; round < 40; round++) {
        sample_mesh mesh = sample_icosphere(1);
        for (int32_t k = 0; k < 3 * mesh.n_vertices; k++)
            mesh.vertices[k] += 1000; /* rounds what follows at 1e-13 */
        for (int i = 0; i < 5; i++) {
            const int32_t *t = mesh.triangles + 3 * random_below(&state, mesh.n_triangles);
            for (int k = 0; k < 3; k++)
                mesh.vertices[3 * t[1] + k] = (mesh.vertices[3 * t[0] + k] + mesh.vertices[3 * t[2] + k]) / 2;
        }
        int32_t cones[4];
        orb_embedding *embedding = NULL;
        orb_error error;
        orb_mesh_arrays arrays = sample_arrays(&mesh);
        orb_request request = orb_request_default();
        request.signature = "2222";
        request.n_cones = 4;
        request.cones = cones;
        request.weights = ORB_WEIGHTS_UNIFORM;
        pick_cones(&state, mesh.n_vertices, 4, cones);
        CHECK(orb_embed(&arrays, &request, &embedding, &error) == ORB_OK);
        orb_embedding_free(embedding);
        sample_free(&mesh);
    }
}

/* Sizes say nothing where all vertices coincide, or are too far apart for a double; a cut runs on all the same. */
TEST(a_cut_without_a_length) {
    static const struct {
        const char *signature;
        int32_t k;
    } all[] = {{"33", 2}, {"332", 3}, {"444", 3}};
    static const double sizes[] = {0, 1e-200, 1e200, 1e308};
    for (int kind = 0; kind < 3; kind++)
        for (int i = 0; i < 4; i++) {
            sample_mesh mesh = sample_icosphere(2);
            sample_scale(&mesh, sizes[i]);
            int32_t cones[] = {0, 1, 2};
            orb_embedding *embedding = NULL;
            orb_error error;
            CHECK(embed(&mesh, all[kind].signature, all[kind].k, cones, 0.01, &embedding, &error) == ORB_OK);
            orb_embedding_free(embedding);
            sample_free(&mesh);
        }
}

/* A tube of triangles around, closed by a vertex at either end: vertices 3 i, 3 i + 1, 3 i + 2 are ring i. */
static sample_mesh tube(int32_t n_rings) {
    sample_mesh mesh = sample_new(3 * n_rings + 2, 6 * n_rings);
    int32_t first = 3 * n_rings, last = first + 1, m = 0;
    for (int32_t v = 0; v < 3 * n_rings; v++) {
        double angle = 2 * pi * (v % 3) / 3, point[3] = {cos(angle), sin(angle), v / 3};
        memcpy(mesh.vertices + 3 * v, point, sizeof point);
    }
    memcpy(mesh.vertices + 3 * first, (double[]){0, 0, -1}, 3 * sizeof(double));
    memcpy(mesh.vertices + 3 * last, (double[]){0, 0, n_rings}, 3 * sizeof(double));
    for (int32_t i = 0; i < n_rings; i++)
        for (int32_t j = 0; j < 3; j++) {
            int32_t a = 3 * i + j, b = 3 * i + (j + 1) % 3;
            bool ends = i == n_rings - 1;
            int32_t lower[3] = {a, b, ends ? last : b + 3}, upper[3] = {a, b + 3, a + 3}, cap[3] = {first, b, a};
            memcpy(mesh.triangles + 3 * m++, lower, sizeof lower);
            if (!ends)
                memcpy(mesh.triangles + 3 * m++, upper, sizeof upper);
            if (i == 0)
                memcpy(mesh.triangles + 3 * m++, cap, sizeof cap);
        }
    CHECK(m == mesh.n_triangles);
    return mesh;
}

/* A limb without a cone shrinks exponentially, to less than two doubles hold: an end, and the vertex named. */
TEST(an_endless_limb_ends) {
    const char *const signatures[] = {"333", "332", "444"};
    for (int i = 0; i < 3; i++)
        for (int32_t rings = 10; rings <= 200; rings += 190) {
            sample_mesh mesh = tube(rings);
            int32_t cones[] = {0, 1, 2};
            orb_embedding *embedding = NULL;
            orb_error error;
            orb_status status = embed(&mesh, signatures[i], 3, cones, 0.01, &embedding, &error);
            if (rings == 10) {
                CHECK(status == ORB_OK);
            } else {
                CHECK(status == ORB_NOT_CONVERGED && embedding == NULL);
                CHECK(error.element == ORB_VERTEX && error.n_elements == 1 && error.elements[0] > 60);
            }
            orb_embedding_free(embedding);
            sample_free(&mesh);
        }
}

TEST(isolated_vertices_are_left_out) {
    sample_mesh mesh = sample_icosphere(2), padded = sample_new(mesh.n_vertices + 2, mesh.n_triangles);
    memcpy(padded.vertices, mesh.vertices, 3 * (size_t)mesh.n_vertices * sizeof(double));
    memcpy(padded.triangles, mesh.triangles, 3 * (size_t)mesh.n_triangles * sizeof(int32_t));
    int32_t cones[] = {0, 20, 40}, isolated[] = {0, 20, mesh.n_vertices};
    orb_embedding *embedding = NULL;
    orb_error error;
    CHECK(embed(&padded, "432", 3, cones, 0.01, &embedding, &error) == ORB_OK);
    orb_embedding_free(embedding);
    CHECK(embed(&padded, "432", 3, isolated, 0.01, &embedding, &error) == ORB_BAD_CONE);
    CHECK(error.n_elements == 1 && error.elements[0] == mesh.n_vertices);
    CHECK(embedding == NULL);
    sample_free(&mesh);
    sample_free(&padded);
}

static bool refuse(const char *stage, double fraction, void *user) {
    (void)stage;
    return fraction < *(double *)user;
}

TEST(a_cancelled_call_leaves_nothing) {
    sample_mesh mesh = sample_icosphere(3);
    orb_mesh_arrays arrays = sample_arrays(&mesh);
    int32_t cones[] = {0, 20, 40};
    for (double at = 0; at < 0.99; at += 0.05) {
        orb_request request = orb_request_default();
        request.signature = "237";
        request.n_cones = 3;
        request.cones = cones;
        request.progress = refuse;
        request.user = &at;
        orb_embedding *embedding = NULL;
        orb_error error;
        CHECK(orb_embed(&arrays, &request, &embedding, &error) == ORB_CANCELLED);
        CHECK(embedding == NULL && error.status == ORB_CANCELLED);
    }
    sample_free(&mesh);
}

TEST(the_callers_mistakes) {
    sample_mesh mesh = sample_icosphere(2);
    orb_embedding *embedding = NULL;
    orb_error error;
    int32_t cones[] = {0, 20, 20, 1000};
    CHECK(embed(&mesh, "432", 3, cones, 0.01, &embedding, &error) == ORB_BAD_CONE);
    CHECK(error.elements[0] == 20);
    CHECK(embed(&mesh, "22", 2, cones + 2, 0.01, &embedding, &error) == ORB_BAD_CONE);
    CHECK(error.elements[0] == 1000);
    CHECK(embed(&mesh, "43", 2, cones, 0.01, &embedding, &error) == ORB_BAD_ORBIFOLD);
    CHECK(embed(&mesh, "432", 2, cones, 0.01, &embedding, &error) == ORB_CONE_COUNT);
    CHECK(embed(&mesh, NULL, 2, cones, 0.01, &embedding, &error) == ORB_BAD_ARGUMENT);
    CHECK(embed(&mesh, "22", 2, cones, 0, &embedding, &error) == ORB_BAD_ARGUMENT);
    CHECK(embed(&mesh, "22", 2, cones, -1, &embedding, &error) == ORB_BAD_ARGUMENT);
    CHECK(orb_embed(NULL, NULL, &embedding, &error) == ORB_BAD_ARGUMENT);
    CHECK(orb_embed(NULL, NULL, NULL, NULL) == ORB_BAD_ARGUMENT);
    sample_free(&mesh);
}
