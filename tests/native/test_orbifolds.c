/* Every family of orbifolds through the public interface: under the sanitizers too. SPDX-License-Identifier:
 * GPL-3.0-or-later */
#include "check.h"
#include "orbifold.h"
#include "surfaces.h"

enum { MOST = 64 };

/* The boundary's edges, sides[h] == 1 of half-edge h. */
static bool *border_sides(const sample_mesh *mesh) {
    const int32_t n = 3 * mesh->n_triangles;
    int32_t *edge = sample_allocate((size_t)n, sizeof *edge), *sides = sample_allocate((size_t)n, sizeof *sides);
    bool *border = sample_allocate((size_t)n, sizeof *border);
    sample_edges(mesh, edge, sides);
    for (int32_t h = 0; h < n; h++)
        border[h] = sides[edge[h]] == 1;
    free(sides);
    free(edge);
    return border;
}

/* The loop through a boundary vertex, whichever way the triangles run; marks it and returns its length. */
static int32_t walk_loop(const sample_mesh *mesh, const bool *border, int32_t start, bool *seen, int32_t *loop) {
    int32_t n = 0, last = -1;
    for (int32_t at = start; n == 0 || at != start;) {
        int32_t next = -1;
        seen[loop[n++] = at] = true;
        for (int32_t h = 0; h < 3 * mesh->n_triangles && next < 0; h++) {
            const int32_t a = mesh->triangles[h], b = mesh->triangles[h % 3 == 2 ? h - 2 : h + 1];
            if (border[h] && (a == at || b == at) && a + b - at != last)
                next = a + b - at;
        }
        last = at, at = next;
    }
    return n;
}

/* Cones far apart, then for each * its corners, evenly by edges; *marked[] are the vertices picked or on the boundary. */
static int32_t pick(const sample_mesh *mesh, const char *signature, int32_t n_interior, int32_t *picked) {
    int32_t n = n_interior, *loop = sample_allocate((size_t)mesh->n_vertices, sizeof *loop);
    bool *border = border_sides(mesh), *seen = sample_allocate((size_t)mesh->n_vertices, sizeof *seen);
    for (const char *star = strchr(signature, '*'); star; star = strchr(star + 1, '*')) {
        int32_t start = -1;
        for (int32_t h = 0; h < 3 * mesh->n_triangles && start < 0; h++)
            if (border[h] && !seen[mesh->triangles[h]])
                start = mesh->triangles[h];
        const int32_t length = walk_loop(mesh, border, start, seen, loop);
        const int32_t corners = (int32_t)strspn(star + 1, "0123456789");
        for (int32_t i = 0; i < corners; i++)
            picked[n++] = loop[i * length / corners];
    }
    for (int32_t i = 0; i < n_interior; i++) {
        bool any = false;
        for (int32_t v = 0; v < mesh->n_vertices; v++)
            any = any || seen[v];
        seen[0] = seen[0] || !any;
        seen[picked[i] = sample_farthest(mesh, seen)] = true;
    }
    free(seen);
    free(border);
    free(loop);
    return n;
}

static void check_embeds(const char *signature) {
    orb_signature_info info;
    orb_error error = {0};
    orb_embedding *embedding = NULL;
    int32_t picked[MOST];
    REQUIRE(orb_signature_read(signature, &info, NULL, 0, &error) == ORB_OK);
    sample_mesh mesh = sample_surface(info.n_handles, info.n_crosscaps, info.n_mirrors);
    orb_mesh_arrays arrays = sample_arrays(&mesh);
    orb_request request = orb_request_default();
    request.signature = signature;
    request.n_cones = pick(&mesh, signature, info.n_interior, picked);
    request.cones = picked;
    CHECK(request.n_cones == info.n_cones);
    const orb_status status = orb_embed(&arrays, &request, &embedding, &error);
    if (status != ORB_OK)
        CHECK_FAILED("%s: %s, %s", signature, orb_status_name(status), error.message);
    if (status == ORB_OK) {
        orb_report report;
        orb_view view;
        orb_embedding_report(embedding, &report);
        orb_embedding_view(embedding, &view);
        CHECK(report.flipped == 0 && report.seam_residual < 1e-7 && report.angle_residual < 1e-6);
        CHECK_NEAR(report.orbifold_euler, info.euler, 1e-14);
        CHECK(report.genus == info.n_handles + info.n_crosscaps && report.boundary_loops == info.n_mirrors);
        CHECK(report.orientable == (info.n_crosscaps == 0));
        CHECK(view.n_input_triangles == mesh.n_triangles && strcmp(view.geometry, info.geometry) == 0);
        for (int32_t i = 0; i < view.n_cones; i++)
            CHECK(view.mirrors[i] == (i >= info.n_interior));
        double *uv = sample_allocate(6 * (size_t)view.n_triangles, sizeof *uv);
        CHECK(orb_uv(embedding, ORB_CHART_DEFAULT, uv, NULL, &error) == ORB_OK);
        for (int32_t i = 0; i < 6 * view.n_triangles; i++)
            CHECK(isfinite(uv[i]));
        for (int32_t i = 0; i < 3 * view.n_input_triangles; i++) { /* the input's vertices come first */
            const int32_t corner = view.input_corners[i];
            CHECK(corner >= 0 && corner < 3 * view.n_triangles && view.triangles[corner] == mesh.triangles[i]);
        }
        free(uv);
    }
    orb_embedding_free(embedding);
    sample_free(&mesh);
}

#define CHECK_ALL(...)                                                                                                 \
    do {                                                                                                               \
        static const char *const all[] = {__VA_ARGS__};                                                                \
        for (size_t i = 0; i < sizeof all / sizeof *all; i++)                                                          \
            check_embeds(all[i]);                                                                                      \
    } while (0)

TEST(spherical) {
    CHECK_ALL("532", "432", "332", "223", "22", "55", "*532", "*432", "*332", "*222", "*225", "*33", "3*2", "2*2",
              "2*5", "2*", "5*", "2x", "5x");
}

TEST(euclidean) {
    CHECK_ALL("442", "333", "632", "2222", "*442", "*333", "*632", "*2222", "4*2", "3*3", "2*22", "22*", "22x", "**",
              "*x", "xx", "o");
}

TEST(hyperbolic) {
    CHECK_ALL("237", "22222", "*237", "*22222", "5*3", "3*22", "22*2", "23*4", "2**", "**2", "*2*2", "***", "23x",
              "*2x", "2*x", "xxx", "*xx", "o2", "o33", "o*", "oo", "ooo");
}
