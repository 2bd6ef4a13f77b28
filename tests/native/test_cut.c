/* The cut disk and the refinement that makes room for it. SPDX-License-Identifier: GPL-3.0-or-later */
#include "check.h"
#include "meshes.h"

#include "cut.h"
#include "picks.h"
#include "refine.h"

static orb_mesh *mesh_of(sample_mesh *sample) {
    orb_mesh *mesh = NULL;
    orb_error error;
    const orb_mesh_arrays arrays = sample_arrays(sample);
    if (mesh_create(&arrays, &mesh, &error) != ORB_OK)
        printf("     %s\n", error.message);
    sample_free(sample);
    return mesh;
}

/* A cut through cones of order 2. */
static orb_status cut_through(const orb_mesh *mesh, int32_t k, const int32_t *cones, orb_disk **disk,
                              orb_error *error) {
    int32_t orders[200];
    for (int32_t i = 0; i < k; i++)
        orders[i] = 2;
    return cut_path(mesh, &(orb_marks){k, cones, orders}, disk, error);
}

/* Numbers that are the same in every run. */
static uint32_t random_below(uint32_t *state, uint32_t n) {
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) % n;
}

/* The first `n_cones` of a random permutation of the mesh's vertices. */
static int32_t *random_cones(int32_t n_vertices, int32_t n_cones, uint32_t seed) {
    int32_t *all = sample_allocate((size_t)n_vertices, sizeof *all);
    for (int32_t v = 0; v < n_vertices; v++)
        all[v] = v;
    for (int32_t i = 0; i < n_cones; i++) {
        const int32_t j = i + (int32_t)random_below(&seed, (uint32_t)(n_vertices - i)), kept = all[i];
        all[i] = all[j];
        all[j] = kept;
    }
    return all;
}

/* --- what every disk must fulfil ------------------------------------------------------------------------------ */

/* The left bank's vertices by segment, the right bank the same backwards, cones at the corners and only there. */
static void check_boundary(const orb_disk *disk, int32_t k, const int32_t *cones) {
    const int32_t n = disk->n_boundary, n_vertices = disk->mesh->n_vertices, *at = disk->corner_at;
    int32_t *met = sample_allocate((size_t)disk->n_copies, sizeof *met), segment = 1, n_sides = 2 * k - 2;
    CHECK(disk->word->n_sides == n_sides && word_is_path(disk->word));
    REQUIRE(n % 2 == 0 && n >= 2 * k - 2);
    CHECK(disk->n_copies == n_vertices + n / 2 - 1);
    CHECK(at[0] == 0 && at[k - 1] == n / 2);
    for (int32_t s = 0; s < 2 * k - 2; s++) {
        REQUIRE(at[s] >= 0 && at[s] < n && (s == 0 || at[s] > at[s - 1]));
        CHECK(disk->copy_vertex[disk->boundary[at[s]]] == cones[s < k ? s : 2 * k - 2 - s]);
    }
    for (int32_t i = 0; i < n; i++)
        CHECK(met[disk->boundary[i]]++ == 0);
    for (int32_t i = 0; i <= n / 2; i++) { /* place on the path */
        const int32_t left = disk->boundary[i];
        CHECK(left >= 0 && left < n_vertices);
        for (int32_t s = 0; s < k; s++)
            CHECK((left == cones[s]) == (at[s] == i));
        if (i == 0 || i == n / 2)
            continue;
        if (i == at[segment])
            segment++;
        const int32_t right = disk->boundary[n - i];
        CHECK(right >= n_vertices);
        CHECK(disk->copy_vertex[right] == left);
        CHECK(disk->place[right].index == (i == at[segment - 1] ? n_sides - segment + 1 : segment - 1));
        CHECK(disk->place[right].kind == (i == at[segment - 1] ? PLACE_CORNER : PLACE_SIDE));
    }
    free(met);
}

/* place[v] on the path, or -1. */
static int32_t *path_places(const orb_disk *disk) {
    int32_t *place = sample_allocate((size_t)disk->mesh->n_vertices, sizeof *place);
    for (int32_t v = 0; v < disk->mesh->n_vertices; v++)
        place[v] = -1;
    for (int32_t i = 0; i <= disk->n_boundary / 2; i++)
        place[disk->boundary[i]] = i;
    return place;
}

/* Copies agree across every edge but the path's, where the left triangle has the left copies and the right one the
 * right ones; no edge joins two vertices of a segment but those that follow one another. */
static void check_banks(const orb_disk *disk, int32_t k) {
    const orb_mesh *mesh = disk->mesh;
    const int32_t n = disk->n_boundary, last = n / 2;
    int32_t *place = path_places(disk), n_left = 0;
    for (int32_t h = 0; h < 3 * mesh->n_triangles; h++) {
        const int32_t g = mesh->twin[h], from = disk->triangles[h], to = disk->triangles[halfedge_next(h)];
        CHECK(disk->copy_vertex[from] == mesh->triangles[h]);
        const int32_t i = place[halfedge_from(mesh, h)], j = place[halfedge_to(mesh, h)];
        const bool forwards = i >= 0 && j == i + 1, backwards = j >= 0 && i == j + 1;
        if (forwards) { /* the triangle on the left of c_1 -> c_k */
            n_left++;
            CHECK(from == disk->boundary[i] && to == disk->boundary[j]);
            CHECK(disk->triangles[halfedge_next(g)] == disk->boundary[(n - i) % n]);
            CHECK(disk->triangles[g] == (j == last ? disk->boundary[last] : disk->boundary[n - j]));
        } else if (!backwards) {
            CHECK(from == disk->triangles[halfedge_next(g)] && to == disk->triangles[g]);
        }
        for (int32_t s = 0; i >= 0 && j >= 0 && s < k - 1; s++) {
            const int32_t a = disk->corner_at[s], b = disk->corner_at[s + 1];
            CHECK(i < a || i > b || j < a || j > b || forwards || backwards);
        }
    }
    CHECK(n_left == last);
    free(place);
}

/* The triangles in copies are a disk, by mesh_create's own count, and its boundary is the loop that is given. */
static void check_is_disk(const orb_disk *disk) {
    const orb_mesh *mesh = disk->mesh;
    orb_mesh *cut = NULL;
    orb_error error;
    if (disk->n_boundary == 2)
        return; /* an edge between two cones: no loop in the copies */
    double *vertices = sample_allocate(3 * (size_t)disk->n_copies, sizeof *vertices);
    for (int32_t c = 0; c < disk->n_copies; c++)
        memcpy(vertices + 3 * (size_t)c, mesh->vertices + 3 * (size_t)disk->copy_vertex[c], 3 * sizeof *vertices);
    const orb_mesh_arrays arrays = {disk->n_copies, vertices, mesh->n_triangles, disk->triangles};
    const orb_status status = mesh_create(&arrays, &cut, &error);
    free(vertices);
    if (status != ORB_OK)
        printf("     %s\n", error.message);
    REQUIRE(status == ORB_OK);
    CHECK(cut->n_components == 1 && cut->n_boundary_loops == 1 && cut->euler == 1 && cut->genus == 0);
    CHECK(cut->n_used_vertices == mesh->n_used_vertices + disk->n_boundary / 2 - 1);
    for (int32_t i = 0; i < disk->n_boundary; i++) {
        const int32_t h = cut->vertex_halfedge[disk->boundary[i]];
        CHECK(cut->twin[h] == -1); /* its triangle, and so the interior, is on its left */
        CHECK(halfedge_to(cut, h) == disk->boundary[(i + 1) % disk->n_boundary]);
    }
    mesh_free(cut);
}

static void triangle_normal(const orb_mesh *mesh, const int32_t corner[3], double normal[3]) {
    const double *p = mesh->vertices + 3 * (size_t)corner[0], *q = mesh->vertices + 3 * (size_t)corner[1],
                 *r = mesh->vertices + 3 * (size_t)corner[2];
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, l = (i + 2) % 3;
        normal[i] = (q[j] - p[j]) * (r[l] - p[l]) - (q[l] - p[l]) * (r[j] - p[j]);
    }
}

/* Barycentric coordinates of p in a triangle with that normal; how far p is off its plane, over its size. */
static double barycentric(const orb_mesh *mesh, int32_t triangle, const double *p, double coordinate[3]) {
    const int32_t *corner = mesh->triangles + 3 * (size_t)triangle;
    double normal[3], square = 0, off = 0;
    triangle_normal(mesh, corner, normal);
    for (int i = 0; i < 3; i++)
        square += normal[i] * normal[i];
    for (int c = 0; c < 3; c++) {
        const double *q = mesh->vertices + 3 * (size_t)corner[(c + 1) % 3],
                     *r = mesh->vertices + 3 * (size_t)corner[(c + 2) % 3];
        coordinate[c] = 0;
        for (int i = 0; i < 3; i++) {
            const int j = (i + 1) % 3, l = (i + 2) % 3;
            coordinate[c] += normal[i] * ((q[j] - p[j]) * (r[l] - p[l]) - (q[l] - p[l]) * (r[j] - p[j])) / square;
        }
    }
    for (int i = 0; i < 3; i++)
        off += normal[i] * (p[i] - mesh->vertices[3 * (size_t)corner[0] + (size_t)i]);
    return fabs(off) / pow(square, 0.75);
}

/* `parent` [fine->n_triangles]: each fine triangle lies in its parent, the same way round, and their areas add up. */
static void check_refinement(const orb_mesh *mesh, const orb_mesh *fine, const int32_t *parent) {
    double *area = sample_allocate((size_t)mesh->n_triangles, sizeof *area);
    REQUIRE(fine->n_vertices >= mesh->n_vertices);
    CHECK(memcmp(fine->vertices, mesh->vertices, 3 * (size_t)mesh->n_vertices * sizeof(double)) == 0);
    CHECK(fine->n_components == 1 && fine->n_boundary_loops == 0 && fine->genus == 0);
    CHECK(fine->n_used_vertices - mesh->n_used_vertices == fine->n_vertices - mesh->n_vertices);
    for (int32_t t = 0; t < fine->n_triangles; t++) {
        REQUIRE(parent[t] >= 0 && parent[t] < mesh->n_triangles);
        double fine_normal[3], normal[3], product = 0;
        triangle_normal(fine, fine->triangles + 3 * (size_t)t, fine_normal);
        triangle_normal(mesh, mesh->triangles + 3 * (size_t)parent[t], normal);
        for (int i = 0; i < 3; i++)
            product += fine_normal[i] * normal[i];
        CHECK(product > 0);
        for (int c = 0; c < 3; c++) {
            double b[3];
            const int32_t v = fine->triangles[3 * t + c];
            CHECK_NEAR(barycentric(mesh, parent[t], fine->vertices + 3 * (size_t)v, b), 0, 1e-12);
            for (int i = 0; i < 3; i++)
                CHECK(b[i] >= -1e-12 && b[i] <= 1 + 1e-12);
        }
        area[parent[t]] += mesh_triangle_area(fine, t);
    }
    for (int32_t t = 0; t < mesh->n_triangles; t++)
        CHECK_NEAR(area[t] / mesh_triangle_area(mesh, t), 1, 1e-12);
    free(area);
}

static void check_disk(const orb_mesh *mesh, const orb_disk *disk, int32_t k, const int32_t *cones) {
    REQUIRE((disk->refined != NULL) == (disk->mesh != mesh));
    REQUIRE((disk->refined != NULL) == (disk->refined_from != NULL));
    for (int32_t v = 0; v < disk->mesh->n_vertices; v++)
        CHECK(disk->copy_vertex[v] == v && disk->place[v].kind == PLACE_SELF);
    check_boundary(disk, k, cones);
    check_banks(disk, k);
    check_is_disk(disk);
    if (disk->refined)
        check_refinement(mesh, disk->refined, disk->refined_from);
}

/* Cuts and checks; whether the mesh was refined. */
static bool cut_and_check(const orb_mesh *mesh, int32_t k, const int32_t *cones) {
    orb_disk *disk = NULL, *again = NULL;
    orb_error error = {0};
    const orb_status status = cut_through(mesh, k, cones, &disk, &error);
    CHECK(status == ORB_OK);
    if (status != ORB_OK)
        return printf("     %s\n", error.message), false;
    check_disk(mesh, disk, k, cones);
    CHECK(cut_through(mesh, k, cones, &again, &error) == ORB_OK);
    CHECK(again && again->n_boundary == disk->n_boundary &&
          memcmp(again->boundary, disk->boundary, (size_t)disk->n_boundary * sizeof(int32_t)) == 0);
    const bool refined = disk->refined != NULL;
    disk_free(again);
    disk_free(disk);
    return refined;
}

static void cut_randomly(sample_mesh *sample, int32_t least, int32_t most, uint32_t seeds) {
    orb_mesh *mesh = mesh_of(sample);
    REQUIRE(mesh != NULL);
    for (int32_t k = least; k <= most; k++) {
        for (uint32_t seed = 1; seed <= seeds; seed++) {
            int32_t *cones = random_cones(mesh->n_vertices, k, seed * 100 + (uint32_t)k);
            cut_and_check(mesh, k, cones);
            free(cones);
        }
    }
    mesh_free(mesh);
}

/* --- the tests ------------------------------------------------------------------------------------------------ */

TEST(cuts_icospheres_through_random_cones) {
    for (int level = 2; level <= 4; level++) {
        sample_mesh sphere = sample_icosphere(level);
        cut_randomly(&sphere, 2, 12, 3);
    }
}

TEST(cuts_platonic_solids_through_any_of_their_vertices) {
    sample_mesh tetrahedron = sample_tetrahedron(), octahedron = sample_octahedron(), cube = sample_cube(),
                icosahedron = sample_icosahedron();
    cut_randomly(&tetrahedron, 2, 4, 10);
    cut_randomly(&octahedron, 2, 6, 20);
    cut_randomly(&cube, 2, 8, 20);
    cut_randomly(&icosahedron, 2, 12, 10);
}

TEST(cuts_a_flat_pillow) {
    sample_mesh pillow = sample_pillow_rectangle(2, 1, 8, 5);
    orb_mesh *mesh = mesh_of(&pillow);
    const int32_t cones[] = {0, 1, 2, 3};
    REQUIRE(mesh != NULL);
    cut_and_check(mesh, 4, cones);
    mesh_free(mesh);
}

TEST(goes_on_past_two_adjacent_cones) {
    sample_mesh sphere = sample_icosphere(1);
    orb_mesh *mesh = mesh_of(&sphere);
    orb_disk *disk = NULL;
    REQUIRE(mesh != NULL);
    const int32_t cones[] = {halfedge_from(mesh, 7), halfedge_to(mesh, 7)};
    REQUIRE(cut_through(mesh, 2, cones, &disk, NULL) == ORB_OK);
    check_disk(mesh, disk, 2, cones);
    CHECK(disk->n_boundary == 2 && disk->boundary[0] == cones[0] && disk->boundary[1] == cones[1]);
    CHECK(disk->corner_at[0] == 0 && disk->corner_at[1] == 1);
    CHECK(disk->n_copies == mesh->n_vertices);
    CHECK(memcmp(disk->triangles, mesh->triangles, 3 * (size_t)mesh->n_triangles * sizeof(int32_t)) == 0);
    disk_free(disk);
    mesh_free(mesh);
}

TEST(puts_the_left_bank_on_the_left) {
    /* On the octahedron +x, +y, -x: walking so and seen from outside (+z up), +z is on the left, -z on the right. */
    sample_mesh octahedron = sample_octahedron();
    orb_mesh *mesh = mesh_of(&octahedron);
    orb_disk *disk = NULL;
    const int32_t cones[] = {0, 2, 1};
    REQUIRE(mesh != NULL);
    REQUIRE(cut_through(mesh, 3, cones, &disk, NULL) == ORB_OK);
    const int32_t boundary[] = {0, 2, 1, 6}, corners[] = {0, 1, 2, 3};
    REQUIRE(disk->n_boundary == 4 && disk->n_copies == 7);
    CHECK(memcmp(disk->boundary, boundary, sizeof boundary) == 0);
    CHECK(memcmp(disk->corner_at, corners, sizeof corners) == 0);
    CHECK(disk->copy_vertex[6] == 2 && disk->place[6].kind == PLACE_CORNER && disk->place[6].index == 3);
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        bool below = false;
        for (int c = 0; c < 3; c++)
            below = below || mesh->triangles[3 * t + c] == 5;
        for (int c = 0; c < 3; c++)
            if (mesh->triangles[3 * t + c] == 2)
                CHECK(disk->triangles[3 * t + c] == (below ? 6 : 2));
    }
    disk_free(disk);
    mesh_free(mesh);
}

/* Bellman and Ford: length of the shortest path between two vertices that avoids the ones marked. */
static double shortest_length(const orb_mesh *mesh, const bool *avoid, int32_t from, int32_t to) {
    double *distance = sample_allocate((size_t)mesh->n_vertices, sizeof *distance);
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        distance[v] = v == from ? 0 : INFINITY;
    for (bool changed = true; changed;) {
        changed = false;
        for (int32_t h = 0; h < 3 * mesh->n_triangles; h++) {
            const int32_t a = halfedge_from(mesh, h), b = halfedge_to(mesh, h);
            const double length = distance[a] + mesh_edge_length(mesh, h);
            if ((avoid[a] && a != from) || (avoid[b] && b != to) || !(length < distance[b]))
                continue;
            distance[b] = length;
            changed = true;
        }
    }
    const double length = distance[to];
    free(distance);
    return length;
}

static double point_distance(const double *p, const double *q) {
    return sqrt(pow(q[0] - p[0], 2) + pow(q[1] - p[1], 2) + pow(q[2] - p[2], 2));
}

TEST(takes_the_shortest_paths) {
    sample_mesh sphere = sample_icosphere(4);
    uint32_t state = 5;
    for (int32_t i = 0; i < 3 * sphere.n_vertices; i++) /* no two paths equally long; and far from straight */
        sphere.vertices[i] *= 1 + 1e-3 * random_below(&state, 1000);
    orb_mesh *mesh = mesh_of(&sphere);
    REQUIRE(mesh != NULL);
    for (uint32_t seed = 1; seed <= 5; seed++) {
        enum { K = 5 };
        int32_t *cones = random_cones(mesh->n_vertices, K, seed);
        bool *avoid = sample_allocate((size_t)mesh->n_vertices, sizeof *avoid);
        orb_disk *disk = NULL;
        for (int32_t s = 0; s < K; s++)
            avoid[cones[s]] = true;
        REQUIRE(cut_through(mesh, K, cones, &disk, NULL) == ORB_OK);
        CHECK(disk->refined == NULL);
        for (int32_t s = 0; s < K - 1; s++) {
            double length = 0;
            const double least = shortest_length(mesh, avoid, cones[s], cones[s + 1]);
            for (int32_t i = disk->corner_at[s]; i < disk->corner_at[s + 1]; i++) {
                length +=
                    point_distance(mesh->vertices + 3 * disk->boundary[i], mesh->vertices + 3 * disk->boundary[i + 1]);
                avoid[disk->boundary[i]] = true;
            }
            CHECK_NEAR(length, least, 1e-12);
        }
        disk_free(disk);
        free(avoid);
        free(cones);
    }
    mesh_free(mesh);
}

TEST(prefers_an_edge_to_a_flat_detour) {
    /* A tetrahedron with a vertex of valence three on its edge 0-1: the detour over it is shorter by rounding. */
    double vertices[] = {0, 0, 0, 1, 0, 0, 0.3, 0, 0, 0.5, 1, 0, 0.5, 0, 1};
    const int32_t triangles[] = {0, 1, 2, 1, 3, 2, 3, 0, 2, 1, 0, 4, 3, 1, 4, 0, 3, 4};
    uint32_t state = 1;
    bool shorter = false;
    for (int tries = 0; tries < 1000 && !shorter; tries++) {
        for (int x = 0; x < 3; x++) {
            vertices[3 + x] = 1 + 1e-3 * random_below(&state, 1000);
            vertices[6 + x] = 0.3 * vertices[3 + x];
        }
        shorter = point_distance(vertices, vertices + 6) + point_distance(vertices + 6, vertices + 3) <
                  point_distance(vertices, vertices + 3);
    }
    REQUIRE(shorter);
    sample_mesh sample = sample_from(5, vertices, 6, triangles);
    orb_mesh *mesh = mesh_of(&sample);
    REQUIRE(mesh != NULL);
    orb_disk *disk = NULL;
    const int32_t cones[] = {0, 1, 3};
    REQUIRE(cut_through(mesh, 3, cones, &disk, NULL) == ORB_OK);
    CHECK(disk->n_boundary == 4 && disk->boundary[0] == 0 && disk->boundary[1] == 1 && disk->boundary[2] == 3);
    check_disk(mesh, disk, 3, cones);
    disk_free(disk);
    mesh_free(mesh);
}

TEST(refines_where_cones_block_the_way) {
    sample_mesh sample = sample_octahedron();
    orb_mesh *octahedron = mesh_of(&sample);
    sample = sample_cube();
    orb_mesh *cube = mesh_of(&sample);
    sample = sample_icosphere(1);
    orb_mesh *sphere = mesh_of(&sample);
    REQUIRE(octahedron && cube && sphere);
    const int32_t opposite[] = {0, 1, 2, 3, 4, 5}; /* each next cone is opposite to, or cut off from, the last one */
    CHECK(cut_and_check(octahedron, 6, opposite));
    const int32_t antipodes[] = {0, 7, 1, 6, 2, 5, 3, 4};
    CHECK(cut_and_check(cube, 8, antipodes));
    for (uint32_t seed = 1; seed <= 3; seed++) { /* more than half of the vertices, in an erratic sequence */
        int32_t *cones = random_cones(sphere->n_vertices, 24, seed);
        CHECK(cut_and_check(sphere, 24, cones));
        free(cones);
    }
    mesh_free(octahedron);
    mesh_free(cube);
    mesh_free(sphere);
}

TEST(leaves_fine_meshes_alone) {
    sample_mesh sample = sample_icosphere(4);
    orb_mesh *mesh = mesh_of(&sample);
    REQUIRE(mesh != NULL);
    for (uint32_t seed = 1; seed <= 10; seed++) {
        int32_t *cones = random_cones(mesh->n_vertices, 3, seed);
        CHECK(!cut_and_check(mesh, 3, cones));
        free(cones);
    }
    mesh_free(mesh);
}

TEST(refuses_a_cut_that_winds_without_end) {
    sample_mesh sample = sample_icosphere(3);
    orb_mesh *mesh = mesh_of(&sample);
    REQUIRE(mesh != NULL);
    int32_t *cones = random_cones(mesh->n_vertices, 200, 1);
    orb_error error = {0};
    orb_disk *disk = NULL;
    CHECK(cut_through(mesh, 200, cones, &disk, &error) == ORB_CUT_BLOCKED);
    CHECK(disk == NULL && error.element == ORB_VERTEX && error.n_elements == 2);
    int32_t first = 0;
    while (first < 198 && cones[first] != error.elements[0])
        first++;
    CHECK(cones[first] == error.elements[0] && cones[first + 1] == error.elements[1]);
    free(cones);
    mesh_free(mesh);
}

TEST(halves_any_edges) {
    sample_mesh sample = sample_icosphere(2);
    orb_mesh *mesh = mesh_of(&sample);
    REQUIRE(mesh != NULL);
    uint8_t *marked = sample_allocate((size_t)mesh->n_edges, 1);
    for (uint32_t tenths = 0; tenths <= 10; tenths++) { /* none to all */
        uint32_t state = tenths;
        int32_t n_marked = 0, *parent = NULL;
        orb_mesh *fine = NULL;
        for (int32_t e = 0; e < mesh->n_edges; e++)
            n_marked += marked[e] = random_below(&state, 10) < tenths;
        REQUIRE(refine_edges(mesh, marked, &fine, &parent, NULL) == ORB_OK);
        CHECK(fine->n_vertices == mesh->n_vertices + n_marked);
        CHECK(fine->n_triangles == mesh->n_triangles + 2 * n_marked);
        check_refinement(mesh, fine, parent);
        for (int32_t e = 0, v = mesh->n_vertices; e < mesh->n_edges; e++) {
            const int32_t h = mesh->edge_halfedge[e];
            for (int x = 0; marked[e] && x < 3; x++)
                CHECK(fine->vertices[3 * v + x] == 0.5 * mesh->vertices[3 * halfedge_from(mesh, h) + x] +
                                                       0.5 * mesh->vertices[3 * halfedge_to(mesh, h) + x]);
            v += marked[e];
        }
        mesh_free(fine);
        free(parent);
    }
    free(marked);
    mesh_free(mesh);
}

static void check_refused(const orb_mesh *mesh, int32_t k, const int32_t *cones, int32_t n_elements,
                          const int32_t *elements) {
    orb_error error = {0};
    CHECK(picks_check(mesh, k, cones, &error) == ORB_BAD_CONE);
    CHECK(error.status == ORB_BAD_CONE && error.element == ORB_VERTEX);
    CHECK(error.n_elements == n_elements && error.n_found == n_elements);
    for (int32_t i = 0; i < n_elements; i++)
        CHECK(error.elements[i] == elements[i]);
    CHECK(strlen(error.message) > 20);
}

TEST(names_bad_cones) {
    sample_mesh sample = sample_icosphere(1);
    sample.vertices = realloc(sample.vertices, 3 * (size_t)(sample.n_vertices + 2) * sizeof(double));
    REQUIRE(sample.vertices != NULL);
    for (int i = 0; i < 6; i++)
        sample.vertices[3 * sample.n_vertices + i] = i; /* two isolated vertices, 42 and 43 */
    sample.n_vertices += 2;
    orb_mesh *mesh = mesh_of(&sample);
    REQUIRE(mesh != NULL && mesh->n_vertices == 44);
    check_refused(mesh, 3, (const int32_t[]){3, 44, -1}, 2, (const int32_t[]){-1, 44});
    check_refused(mesh, 4, (const int32_t[]){43, 3, 42, 5}, 2, (const int32_t[]){42, 43});
    check_refused(mesh, 6, (const int32_t[]){9, 3, 9, 4, 3, 9}, 2, (const int32_t[]){3, 9});
    const int32_t good[] = {0, 7, 20};
    CHECK(picks_check(mesh, 3, good, NULL) == ORB_OK);
    cut_and_check(mesh, 3, good); /* isolated vertices are no obstacle */
    mesh_free(mesh);
}

TEST(cuts_every_shared_mesh) {
    const char *names[] = {"spot.obj", "fandisk.off", "bunny.obj"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        sample_mesh sample;
        if (!sample_read(&sample, names[i]))
            SKIP("no ../shared/meshes");
        orb_mesh *mesh = mesh_of(&sample);
        REQUIRE(mesh != NULL);
        for (int32_t k = 2; k <= 12; k += 5) {
            int32_t *cones = random_cones(mesh->n_vertices, k, 1);
            cut_and_check(mesh, k, cones);
            free(cones);
        }
        mesh_free(mesh);
    }
}
