/* mesh.c, mesh_arrays.c and error.c. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * mesh.c is compiled into this file under other names, so that any of its allocations can be made to fail. */
#define mesh_create tested_mesh_create
#define mesh_free tested_mesh_free
#define mesh_require_connected tested_mesh_require_connected
#define mesh_orient tested_mesh_orient
#define orientation_check tested_orientation_check
#define mesh_find_boundary tested_mesh_find_boundary
#define mesh_edge_length tested_mesh_edge_length
#define mesh_triangle_area tested_mesh_triangle_area

#include <stdlib.h>

static int allocations_left = -1; /* before all others fail; -1: none does */

static void *counted_malloc(size_t size) {
    return allocations_left == 0 ? NULL : (allocations_left -= allocations_left > 0, malloc(size));
}

static void *counted_calloc(size_t count, size_t size) {
    return allocations_left == 0 ? NULL : (allocations_left -= allocations_left > 0, calloc(count, size));
}

#define malloc counted_malloc
#define calloc counted_calloc
#include "../../native/src/mesh.c"
#include "../../native/src/orientation.c"
#undef malloc
#undef calloc

#include "check.h"
#include "meshes.h"


/* Makes the half-edges, checks that they fit the triangles and each other, and the counts; frees the sample. */
static void check_mesh(sample_mesh sample, int32_t components, int32_t loops, int32_t genus) {
    const orb_mesh_arrays arrays = sample_arrays(&sample);
    orb_mesh *mesh = NULL;
    orb_error error = {0};
    const orb_status status = mesh_create(&arrays, &mesh, &error);
    CHECK(status == ORB_OK && mesh);
    if (!mesh) {
        sample_free(&sample);
        return;
    }
    CHECK(mesh->n_components == components);
    CHECK(mesh->n_boundary_loops == loops);
    CHECK(mesh->genus == genus);
    CHECK(mesh->euler == mesh->n_used_vertices - mesh->n_edges + mesh->n_triangles);
    CHECK(mesh->euler == 2 * components - 2 * genus - loops);
    bool twins = true, edges = true, vertices = true, sorted = true;
    for (int32_t h = 0; h < 3 * mesh->n_triangles; h++) {
        const int32_t g = mesh->twin[h], e = mesh->edge[h], on_edge = mesh->edge_halfedge[e];
        twins = twins &&
                (g < 0 || (mesh->twin[g] == h && mesh->edge[g] == e && halfedge_from(mesh, g) == halfedge_to(mesh, h) &&
                           halfedge_to(mesh, g) == halfedge_from(mesh, h)));
        edges = edges && (on_edge == h || on_edge == g);
    }
    for (int32_t e = 1; e < mesh->n_edges; e++) {
        const int32_t g = mesh->edge_halfedge[e - 1], h = mesh->edge_halfedge[e];
        const int32_t a = halfedge_from(mesh, g), b = halfedge_to(mesh, g), c = halfedge_from(mesh, h),
                      d = halfedge_to(mesh, h);
        const int32_t before = a < b ? a : b, here = c < d ? c : d;
        sorted = sorted && (before < here || (before == here && (a < b ? b : a) < (c < d ? d : c)));
    }
    int32_t used = 0;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        const int32_t h = mesh->vertex_halfedge[v];
        if (h < 0)
            continue;
        used++;
        vertices = vertices && halfedge_from(mesh, h) == v;
    }
    CHECK(twins);
    CHECK(edges);
    CHECK(sorted);
    CHECK(vertices);
    CHECK(used == mesh->n_used_vertices);
    CHECK(memcmp(mesh->vertices, sample.vertices, 3 * (size_t)sample.n_vertices * sizeof(double)) == 0);
    CHECK(memcmp(mesh->triangles, sample.triangles, 3 * (size_t)sample.n_triangles * sizeof(int32_t)) == 0);
    mesh_free(mesh);
    sample_free(&sample);
}

/* The error that mesh_create gives; frees the sample. */
static orb_error failure_of(sample_mesh sample) {
    const orb_mesh_arrays arrays = sample_arrays(&sample);
    orb_mesh *mesh = NULL;
    orb_error error = {0};
    const orb_status status = mesh_create(&arrays, &mesh, &error);
    CHECK(status == error.status);
    CHECK(status != ORB_OK && !mesh);
    CHECK(mesh_create(&arrays, &mesh, NULL) == status); /* without a record */
    mesh_free(mesh);
    sample_free(&sample);
    return error;
}

static void check_elements(const orb_error *error, orb_status status, orb_element element, int64_t found, int32_t n,
                           const int32_t *elements) {
    if (error->status != status)
        CHECK_FAILED("%s, not %s", orb_status_name(error->status), orb_status_name(status));
    CHECK(error->element == element);
    CHECK(error->n_found == found);
    CHECK(error->n_elements == n);
    if (error->n_elements == n)
        CHECK(memcmp(error->elements, elements, (size_t)n * sizeof *elements) == 0);
    CHECK(strlen(error->message) > 20 && strchr(error->message, ':'));
}
#define CHECK_ELEMENTS(error, status, element, found, ...)                                                             \
    check_elements(&(error), status, element, found, (int32_t)(sizeof((int32_t[]){__VA_ARGS__}) / sizeof(int32_t)),    \
                   (int32_t[]){__VA_ARGS__})

static sample_mesh joined(sample_mesh a, sample_mesh b) /* side by side; frees both */
{
    sample_mesh both = sample_new(a.n_vertices + b.n_vertices, a.n_triangles + b.n_triangles);
    memcpy(both.vertices, a.vertices, 3 * (size_t)a.n_vertices * sizeof(double));
    memcpy(both.vertices + 3 * (size_t)a.n_vertices, b.vertices, 3 * (size_t)b.n_vertices * sizeof(double));
    for (int32_t i = 0; i < 3 * a.n_triangles; i++)
        both.triangles[i] = a.triangles[i];
    for (int32_t i = 0; i < 3 * b.n_triangles; i++)
        both.triangles[3 * a.n_triangles + i] = b.triangles[i] + a.n_vertices;
    sample_free(&a);
    sample_free(&b);
    return both;
}

TEST(closed_meshes) {
    check_mesh(sample_tetrahedron(), 1, 0, 0);
    check_mesh(sample_octahedron(), 1, 0, 0);
    check_mesh(sample_cube(), 1, 0, 0);
    check_mesh(sample_icosphere(3), 1, 0, 0);
    check_mesh(sample_torus(12, 7, 3, 1), 1, 0, 1);
    check_mesh(sample_pillow_triangle(0.5, 2, 4), 1, 0, 0);
    check_mesh(sample_pillow_rectangle(2, 1, 2, 3), 1, 0, 0);
}

TEST(open_meshes) {
    const double corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const int32_t one[] = {2, 0, 1};
    check_mesh(sample_from(3, corners, 1, one), 1, 1, 0);
    check_mesh(sample_triangle(1, 0.7, 5), 1, 1, 0);
    sample_mesh tube = sample_torus(12, 7, 3, 1);
    tube.n_triangles -= 14; /* the last step round the long way */
    check_mesh(tube, 1, 2, 0);
    sample_mesh holed = sample_torus(12, 7, 3, 1);
    holed.n_triangles -= 1;
    check_mesh(holed, 1, 1, 1);
}

TEST(several_components_and_isolated_vertices_are_counted) {
    check_mesh(joined(sample_torus(5, 4, 3, 1), joined(sample_octahedron(), sample_triangle(1, 1, 2))), 3, 1, 1);
    sample_mesh isolated = sample_new(3, 0);
    check_mesh(joined(isolated, joined(sample_tetrahedron(), sample_new(2, 0))), 1, 0, 0);
}

TEST(turning_round_a_vertex_meets_its_fan) {
    sample_mesh sample = sample_rectangle(1, 1, 4, 5);
    const orb_mesh_arrays arrays = sample_arrays(&sample);
    orb_mesh *mesh = NULL;
    REQUIRE(mesh_create(&arrays, &mesh, NULL) == ORB_OK);
    int32_t met = 0, starts = 0;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        const int32_t start = mesh->vertex_halfedge[v];
        const bool border = sample.vertices[3 * v] == 0 || sample.vertices[3 * v] == 1 ||
                            sample.vertices[3 * v + 1] == 0 || sample.vertices[3 * v + 1] == 1;
        starts += border && mesh->twin[start] < 0;
        CHECK(border == (mesh->twin[start] < 0));
        int32_t h = start;
        do {
            CHECK(halfedge_from(mesh, h) == v);
            met++;
            h = mesh->twin[halfedge_previous(h)];
        } while (h >= 0 && h != start);
        CHECK((h < 0) == border);
    }
    CHECK(met == 3 * mesh->n_triangles);
    CHECK(starts == 18);
    mesh_free(mesh);
    sample_free(&sample);
}

TEST(bad_arguments) {
    sample_mesh cube = sample_cube();
    orb_mesh *mesh = NULL;
    orb_error error = {0};
    orb_mesh_arrays arrays = sample_arrays(&cube);
    CHECK(mesh_create(NULL, &mesh, &error) == ORB_BAD_ARGUMENT);
    arrays.triangles = NULL;
    CHECK(mesh_create(&arrays, &mesh, &error) == ORB_BAD_ARGUMENT && strstr(error.message, "triangles"));
    arrays = sample_arrays(&cube);
    arrays.vertices = NULL;
    CHECK(mesh_create(&arrays, &mesh, &error) == ORB_BAD_ARGUMENT && strstr(error.message, "vertices"));
    arrays = sample_arrays(&cube);
    arrays.n_vertices = -1;
    CHECK(mesh_create(&arrays, &mesh, &error) == ORB_BAD_ARGUMENT);
    arrays = sample_arrays(&cube);
    arrays.n_triangles = 0;
    CHECK(mesh_create(&arrays, &mesh, &error) == ORB_BAD_ARGUMENT);
    arrays.n_triangles = INT32_MAX / 3 + 1;
    CHECK(mesh_create(&arrays, &mesh, &error) == ORB_BAD_ARGUMENT);
    arrays = sample_arrays(&cube);
    arrays.n_vertices = INT32_MAX / 3 + 1;
    CHECK(mesh_create(&arrays, &mesh, &error) == ORB_BAD_ARGUMENT);
    CHECK(error.element == ORB_NOTHING && error.n_elements == 0 && !mesh);
    sample_free(&cube);
}

TEST(coordinates_that_are_not_finite) {
    sample_mesh mesh = joined(sample_icosphere(1), sample_new(1, 0));
    mesh.vertices[3 * 7 + 2] = NAN;
    mesh.vertices[3 * 3] = -INFINITY;
    mesh.vertices[3 * 42 + 1] = NAN; /* the isolated one */
    const orb_error error = failure_of(mesh);
    CHECK_ELEMENTS(error, ORB_NON_FINITE, ORB_VERTEX, 3, 3, 7, 42);
}

TEST(sixteen_elements_are_named_and_all_are_counted) {
    sample_mesh mesh = sample_icosphere(1);
    for (int32_t v = 4; v < 42; v++)
        mesh.vertices[3 * v + 1] = NAN;
    const orb_error error = failure_of(mesh);
    CHECK_ELEMENTS(error, ORB_NON_FINITE, ORB_VERTEX, 38, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19);
    CHECK(strncmp(error.message, "38 vertices have", 16) == 0);
}

TEST(indices_out_of_range) {
    sample_mesh mesh = sample_cube();
    mesh.triangles[3 * 4 + 1] = 8;
    mesh.triangles[3 * 9] = -1;
    const orb_error error = failure_of(mesh);
    CHECK_ELEMENTS(error, ORB_INDEX_OUT_OF_RANGE, ORB_TRIANGLE, 2, 4, 9);
}

TEST(degenerate_triangles) {
    sample_mesh mesh = sample_cube();
    mesh.triangles[3 * 2 + 1] = mesh.triangles[3 * 2 + 2];
    mesh.triangles[3 * 5] = mesh.triangles[3 * 5 + 2];
    const orb_error error = failure_of(mesh);
    CHECK_ELEMENTS(error, ORB_DEGENERATE_TRIANGLE, ORB_TRIANGLE, 2, 2, 5);
}

/* A cube and one triangle more. */
static sample_mesh cube_and(int32_t a, int32_t b, int32_t c) {
    const double corners[] = {5, 0, 0};
    const int32_t extra[] = {a, b, c};
    sample_mesh cube = sample_cube(), mesh = sample_new(9, 13);
    memcpy(mesh.vertices, cube.vertices, 24 * sizeof(double));
    memcpy(mesh.vertices + 24, corners, sizeof corners);
    memcpy(mesh.triangles, cube.triangles, 36 * sizeof(int32_t));
    memcpy(mesh.triangles + 36, extra, sizeof extra);
    sample_free(&cube);
    return mesh;
}

TEST(repeated_triangles) {
    for (int turn = 0; turn < 3; turn++) { /* triangle 2 is 4, 5, 7 */
        const int32_t corner[] = {4, 5, 7};
        const int32_t a = corner[turn], b = corner[(turn + 1) % 3], c = corner[(turn + 2) % 3];
        const orb_error same = failure_of(cube_and(a, b, c)), reversed = failure_of(cube_and(c, b, a));
        CHECK_ELEMENTS(same, ORB_REPEATED_TRIANGLE, ORB_TRIANGLE, 1, 12);
        CHECK_ELEMENTS(reversed, ORB_REPEATED_TRIANGLE, ORB_TRIANGLE, 1, 12);
    }
    const double corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const int32_t both_sides[] = {0, 1, 2, 2, 1, 0};
    const orb_error leaf = failure_of(sample_from(3, corners, 2, both_sides));
    CHECK_ELEMENTS(leaf, ORB_REPEATED_TRIANGLE, ORB_TRIANGLE, 1, 1);
    sample_mesh cube = sample_cube(), twice = sample_new(8, 24); /* a whole mesh twice, the second time backwards */
    memcpy(twice.vertices, cube.vertices, 24 * sizeof(double));
    for (int i = 0; i < 36; i++)
        twice.triangles[i] = twice.triangles[71 - i] = cube.triangles[i];
    sample_free(&cube);
    const orb_error doubled = failure_of(twice);
    CHECK_ELEMENTS(doubled, ORB_REPEATED_TRIANGLE, ORB_TRIANGLE, 12, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23);
}

TEST(non_manifold_edges) {
    const orb_error error = failure_of(cube_and(1, 5, 8));
    CHECK_ELEMENTS(error, ORB_NON_MANIFOLD_EDGE, ORB_EDGE, 1, 1, 5);
    CHECK(strstr(error.message, "1 edge has more than two triangles, first 1-5"));
    const orb_error wall = failure_of(cube_and(6, 5, 0)); /* inside: on the edge 0-5, 0-6 and a diagonal of space */
    CHECK_ELEMENTS(wall, ORB_NON_MANIFOLD_EDGE, ORB_EDGE, 2, 0, 5, 0, 6);
}

TEST(a_fan_of_many_triangles_on_one_edge) {
    enum { N = 100000 };
    sample_mesh book = sample_new(N + 2, N);
    for (int32_t t = 0; t < N; t++) {
        book.triangles[3 * t] = N + 1;
        book.triangles[3 * t + 1] = N;
        book.triangles[3 * t + 2] = t;
    }
    const orb_error error = failure_of(book);
    CHECK_ELEMENTS(error, ORB_NON_MANIFOLD_EDGE, ORB_EDGE, 1, N, N + 1);
}

TEST(inconsistent_orientation) {
    sample_mesh mesh = sample_cube(); /* triangle 2 is 4, 5, 7 */
    mesh.triangles[6] = 5;
    mesh.triangles[7] = 4;
    const orb_error error = failure_of(mesh);
    CHECK_ELEMENTS(error, ORB_INCONSISTENT_ORIENTATION, ORB_EDGE, 3, 4, 5, 4, 7, 5, 7);
}

TEST(non_manifold_vertices) {
    sample_mesh mesh = joined(sample_octahedron(), sample_cube()); /* they meet in 3, twice in all */
    for (int i = 24; i < 60; i++)
        mesh.triangles[i] = mesh.triangles[i] == 6 ? 3 : mesh.triangles[i] == 13 ? 5 : mesh.triangles[i];
    const orb_error error = failure_of(mesh);
    CHECK_ELEMENTS(error, ORB_NON_MANIFOLD_VERTEX, ORB_VERTEX, 2, 3, 5);
    const double corners[15] = {0};
    const int32_t bow[] = {0, 1, 2, 0, 3, 4};
    const orb_error open = failure_of(sample_from(5, corners, 2, bow));
    CHECK_ELEMENTS(open, ORB_NON_MANIFOLD_VERTEX, ORB_VERTEX, 1, 0);
    const int32_t closed_and_open[] = {0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2, 0, 4, 5};
    const double more[18] = {0};
    const orb_error mixed = failure_of(sample_from(6, more, 5, closed_and_open));
    CHECK_ELEMENTS(mixed, ORB_NON_MANIFOLD_VERTEX, ORB_VERTEX, 1, 0);
}

TEST(the_first_kind_of_defect_is_reported) {
    sample_mesh mesh = cube_and(4, 5, 7); /* repeated, crowded edges */
    mesh.triangles[3] = 3;
    mesh.triangles[4] = 0; /* and turned round */
    CHECK(failure_of(mesh).status == ORB_REPEATED_TRIANGLE);
    mesh = cube_and(1, 5, 8);
    mesh.triangles[3] = 3;
    mesh.triangles[4] = 0;
    CHECK(failure_of(mesh).status == ORB_NON_MANIFOLD_EDGE);
    mesh = cube_and(4, 4, 9);
    CHECK(failure_of(mesh).status == ORB_INDEX_OUT_OF_RANGE);
    mesh = cube_and(4, 4, 9);
    mesh.vertices[0] = NAN;
    CHECK(failure_of(mesh).status == ORB_NON_FINITE);
}

static orb_error parts_failure(sample_mesh sample) {
    const orb_mesh_arrays arrays = sample_arrays(&sample);
    orb_mesh *mesh = NULL;
    orb_error error = {0};
    CHECK(mesh_create(&arrays, &mesh, &error) == ORB_OK);
    if (mesh)
        CHECK(mesh_require_connected(mesh, &error) == error.status);
    if (mesh)
        CHECK(mesh_require_connected(mesh, NULL) == error.status);
    mesh_free(mesh);
    sample_free(&sample);
    return error;
}

TEST(what_is_not_in_one_piece) {
    CHECK(parts_failure(sample_icosphere(2)).status == ORB_OK);
    CHECK(parts_failure(joined(sample_new(2, 0), sample_cube())).status == ORB_OK);
    const orb_error parts = parts_failure(joined(sample_cube(), joined(sample_new(1, 0), sample_octahedron())));
    CHECK_ELEMENTS(parts, ORB_SEVERAL_COMPONENTS, ORB_VERTEX, 2, 0, 9);
}

TEST(lengths_and_areas) {
    const double sizes[] = {1e-200, 1e-12, 1, 1e12, 1e150};
    for (int s = 0; s < 5; s++) {
        sample_mesh sample = sample_tetrahedron();
        sample_scale(&sample, sizes[s]);
        const orb_mesh_arrays arrays = sample_arrays(&sample);
        orb_mesh *mesh = NULL;
        REQUIRE(mesh_create(&arrays, &mesh, NULL) == ORB_OK);
        for (int32_t h = 0; h < 12; h++)
            CHECK_NEAR(mesh_edge_length(mesh, h) / sizes[s], sqrt(8), 1e-14);
        if (sizes[s] > 1e-150) /* its square is a double */
            for (int32_t t = 0; t < 4; t++)
                CHECK_NEAR(mesh_triangle_area(mesh, t) / sizes[s] / sizes[s], 2 * sqrt(3), 1e-14);
        mesh_free(mesh);
        sample_free(&sample);
    }
}

TEST(every_failed_allocation_is_reported) {
    sample_mesh sample = joined(sample_icosphere(1), sample_cube());
    const orb_mesh_arrays arrays = sample_arrays(&sample);
    orb_status status = ORB_OUT_OF_MEMORY;
    int failed = 0;
    for (; status == ORB_OUT_OF_MEMORY && failed < 100; failed++) {
        orb_mesh *mesh = NULL;
        orb_error error = {0};
        allocations_left = failed;
        status = mesh_create(&arrays, &mesh, &error);
        CHECK((status == ORB_OK) == (mesh != NULL) && error.status == status);
        if (mesh) {
            allocations_left = 0;
            CHECK(mesh_require_connected(mesh, &error) == ORB_OUT_OF_MEMORY);
        }
        allocations_left = -1;
        mesh_free(mesh);
    }
    CHECK(status == ORB_OK);
    CHECK(failed == 13); /* twelve allocations, each failed once */
    sample_free(&sample);
    mesh_free(NULL);
}

/* Vertices of high degree, numbered to suit nobody: two poles and a belt. A step that takes n times the degree would
 * be seen by the time limit of the whole program. */
TEST(a_vertex_of_high_degree_costs_no_more) {
    enum { N = 200000, STEP = 77773 };
    sample_mesh sample = sample_new(N + 2, 2 * N);
    for (int32_t i = 0; i < N; i++) {
        const int32_t a = (int32_t)((int64_t)i * STEP % N), b = (int32_t)((int64_t)(i + 1) * STEP % N);
        const int32_t two[6] = {a, b, N, b, a, N + 1};
        memcpy(sample.triangles + 6 * (size_t)i, two, sizeof two);
    }
    check_mesh(sample, 1, 0, 0);
}

TEST(shared_meshes) {
    const struct {
        const char *name;
        int32_t components, loops, genus;
    } known[] = {{"spot.obj", 1, 0, 0},       {"kitten.obj", 1, 0, 1},     {"three_holes.off", 1, 0, 3},
                 {"hemisphere.obj", 1, 1, 0}, {"halftunnel.off", 1, 3, 0}, {"nefertiti.obj", 1, 0, 0}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        sample_mesh sample;
        if (!sample_read(&sample, known[i].name))
            SKIP("a mesh of ../shared/meshes is absent");
        check_mesh(sample, known[i].components, known[i].loops, known[i].genus);
    }
}

TEST(names_of_the_statuses) {
    CHECK(strcmp(orb_status_name(ORB_OK), "ORB_OK") == 0);
    CHECK(strcmp(orb_status_name(ORB_LINEAR_SOLVER), "ORB_LINEAR_SOLVER") == 0);
    CHECK(strcmp(orb_status_name((orb_status)1000), "ORB_UNKNOWN_STATUS") == 0);
    for (int i = 0; i <= ORB_LINEAR_SOLVER; i++)
        CHECK(strcmp(orb_status_name((orb_status)i), "ORB_UNKNOWN_STATUS") != 0);
}

TEST(the_record_is_cleared_and_filled) {
    orb_error error;
    memset(&error, 0x55, sizeof error);
    CHECK(error_set(&error, ORB_CANCELLED, "stopped at %d", 7) == ORB_CANCELLED);
    CHECK(error.status == ORB_CANCELLED && error.element == ORB_NOTHING && error.n_elements == 0 && error.n_found == 0);
    CHECK(strcmp(error.message, "stopped at 7") == 0);
    const int32_t edges[20] = {9, 8, 7, 6};
    CHECK(error_set_elements(&error, ORB_BOUNDARY, ORB_EDGE, edges, 20, 10, "%s", "open") == ORB_BOUNDARY);
    CHECK(error.n_elements == 16 && error.n_found == 10 && error.elements[0] == 9 && error.elements[3] == 6);
    CHECK(error_set(NULL, ORB_CANCELLED, "nobody listens") == ORB_CANCELLED);
    CHECK(error_memory(&error) == ORB_OUT_OF_MEMORY && error.n_elements == 0);
}

TEST(a_long_sentence_ends_between_characters) {
    orb_error error;
    const size_t room = sizeof error.message - 1;
    for (size_t spare = 0; spare < 4; spare++) { /* the three bytes of a euro sign, around the record's end */
        char text[400] = {0};
        memset(text, 'x', room - spare);
        strcat(text, "\xe2\x82\xac and more");
        error_set(&error, ORB_CANCELLED, "%s", text);
        CHECK(strlen(error.message) == (spare < 3 ? room - spare : room));
        CHECK(strncmp(error.message, text, strlen(error.message)) == 0);
    }
}

TEST(found_keeps_the_least_in_order) {
    orb_found found = {0};
    for (int32_t i = 0; i < 100; i++)
        found_add(&found, i * 37 % 100);
    CHECK(found.found == 100 && found.entries == 16);
    for (int32_t i = 0; i < 16; i++)
        CHECK(found.elements[i] == i);
    orb_found edges = {0};
    for (int32_t i = 0; i < 30; i++)
        found_add_edge(&edges, 5 + i * 7 % 30, i % 3);
    CHECK(edges.found == 30 && edges.entries == 16);
    for (int32_t i = 0; i < 8; i++)
        CHECK(edges.elements[2 * i] == 0);
    for (int32_t i = 1; i < 8; i++)
        CHECK(edges.elements[2 * i - 1] < edges.elements[2 * i + 1]);
}
