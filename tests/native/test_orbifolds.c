/* Every family of orbifolds through the public interface: under the sanitizers too. SPDX-License-Identifier:
 * GPL-3.0-or-later */
#include "check.h"
#include "orbifold.h"
#include "spread_picks.h"

enum { MOST = 64 };

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
