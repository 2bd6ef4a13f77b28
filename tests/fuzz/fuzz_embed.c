/* Bytes -> a mesh, nearly good or any triangles, an orbifold, picks -> an embedding, and what can be done with one.
 * SPDX-License-Identifier: GPL-3.0-or-later
 *
 * It traps where a result is not what its header says. docs/building.md says how it is run. */
#include "bytes.h"
#include "orbifold_cones.h"
#include "orbifold_maps.h"
#include "surfaces.h"

enum { MOST_CONES = 10, MOST_SIGNATURE = 12, MOST_POINTS = 20, MOST_FACES = 40, CHARTS = ORB_CHART_KLEIN + 1 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void must(bool holds) {
    if (!holds)
        abort();
}

/* --- meshes ------------------------------------------------------------------------------------------------------- */

static sample_mesh any_triangles(fuzz_bytes *bytes) {
    sample_mesh mesh = sample_new(fuzz_below(bytes, MOST_POINTS), fuzz_below(bytes, MOST_FACES));
    for (int32_t k = 0; k < 3 * mesh.n_vertices; k++)
        mesh.vertices[k] = fuzz_number(bytes);
    for (int32_t k = 0; k < 3 * mesh.n_triangles; k++)
        mesh.triangles[k] = fuzz_below(bytes, mesh.n_vertices + 1);
    return mesh;
}

static sample_mesh good_mesh(fuzz_bytes *bytes) {
    switch (fuzz_below(bytes, 12)) {
    case 0:
        return any_triangles(bytes);
    case 1:
        return sample_tetrahedron();
    case 2:
        return sample_octahedron();
    case 3:
        return sample_cube();
    case 4:
        return sample_icosahedron();
    case 5:
        return sample_rectangle(1, 1.5, 3, 2);
    case 6:
        return sample_torus(5, 4, 1, 0.4);
    case 7:
        return sample_fan(7);
    case 8:
        return sample_band(7, true);
    case 9:
        return sample_projective_plane(0);
    case 10:
        return sample_icosphere(1);
    default:
        return sample_pillow_rectangle(1, 2, 2, 3);
    }
}

/* One defect after the other, or none; the arrays stay as large. */
static void spoil(sample_mesh *mesh, fuzz_bytes *bytes) {
    const int32_t n = mesh->n_vertices, m = mesh->n_triangles;
    for (int32_t left = fuzz_below(bytes, 5); left > 0 && n > 0 && m > 0; left--)
        switch (fuzz_below(bytes, 7)) {
        case 0:
            mesh->vertices[fuzz_below(bytes, 3 * n)] = fuzz_number(bytes);
            break;
        case 1:
            mesh->triangles[fuzz_below(bytes, 3 * m)] = fuzz_below(bytes, n + 2) - 1;
            break;
        case 2: { /* turned over */
            int32_t *triangle = mesh->triangles + 3 * fuzz_below(bytes, m), first = triangle[0];
            triangle[0] = triangle[1];
            triangle[1] = first;
            break;
        }
        case 3: /* a hole: the last triangle takes the place of another */
            if (mesh->n_triangles > 1) {
                mesh->n_triangles--;
                memcpy(mesh->triangles + 3 * fuzz_below(bytes, mesh->n_triangles),
                       mesh->triangles + 3 * mesh->n_triangles, 3 * sizeof *mesh->triangles);
            }
            break;
        case 4: { /* two points in one place */
            const int32_t a = fuzz_below(bytes, n), b = fuzz_below(bytes, n);
            memmove(mesh->vertices + 3 * a, mesh->vertices + 3 * b, 3 * sizeof *mesh->vertices);
            break;
        }
        case 5: { /* two vertices made one */
            const int32_t a = fuzz_below(bytes, n), b = fuzz_below(bytes, n);
            for (int32_t k = 0; k < 3 * mesh->n_triangles; k++)
                mesh->triangles[k] = mesh->triangles[k] == a ? b : mesh->triangles[k];
            break;
        }
        default:
            sample_scale(mesh, fuzz_number(bytes));
        }
}

/* --- requests ----------------------------------------------------------------------------------------------------- */

static const char *const known[] = {"442", "333",   "632",    "2222", "432", "532",  "22",  "33",
                                    "237", "22222", "*442",   "4*2",  "22*", "*632", "o",   "22x",
                                    "xx",  "**",    "222222", "2*22", "3*",  "*",    "ooo", "x"};

static void read_signature(fuzz_bytes *bytes, char signature[MOST_SIGNATURE + 1]) {
    static const char letters[] = "2345679*xo(),10 2";
    const int32_t kind = fuzz_below(bytes, 40);
    memset(signature, 0, MOST_SIGNATURE + 1);
    if (kind < (int32_t)(sizeof known / sizeof *known)) {
        strncpy(signature, known[kind], MOST_SIGNATURE);
        return;
    }
    for (int32_t k = 0, n = fuzz_below(bytes, MOST_SIGNATURE); k < n; k++)
        signature[k] = kind < 39 ? letters[fuzz_below(bytes, (int32_t)sizeof letters - 1)] : (char)fuzz_byte(bytes);
}

typedef struct asked {
    char signature[MOST_SIGNATURE + 1];
    int32_t cones[MOST_CONES], orders[MOST_CONES];
    double weights[9];
    orb_polygon polygon;
    orb_request request;
} asked;

static void read_request(fuzz_bytes *bytes, int32_t n_vertices, asked *it) {
    it->request = orb_request_default();
    read_signature(bytes, it->signature);
    it->request.signature = it->signature;
    it->request.weights = (orb_weights)fuzz_below(bytes, ORB_WEIGHTS_MEAN_VALUE_EXACT + 2);
    it->request.holes = (orb_holes)fuzz_below(bytes, ORB_HOLES_MIRROR + 2);
    it->request.cut = (orb_cut)fuzz_below(bytes, 2);
    const uint8_t more = fuzz_byte(bytes);
    if (more & 1)
        it->request.clamp = fuzz_number(bytes);
    if (more & 2) {
        it->polygon = (orb_polygon){.curvature = fuzz_below(bytes, 4) - 1, .n_corners = fuzz_below(bytes, 8)};
        it->polygon.radius = fuzz_number(bytes);
        it->request.polygon = &it->polygon;
    }
    orb_signature_info info = {0};
    int32_t wanted = fuzz_below(bytes, MOST_CONES);
    if (!(more & 4) && orb_signature_read(it->signature, &info, NULL, 0, NULL) == ORB_OK && info.n_cones <= MOST_CONES)
        wanted = info.n_cones;
    it->request.n_cones = wanted;
    it->request.cones = it->cones;
    for (int32_t k = 0; k < wanted; k++)
        it->cones[k] = more & 8 ? fuzz_below(bytes, n_vertices + 2) - 1 : fuzz_below(bytes, n_vertices);
    if (more & 16) {
        for (int32_t k = 0; k < wanted; k++)
            it->orders[k] = fuzz_below(bytes, 9);
        it->request.orders = it->orders;
    }
    if (it->request.weights == ORB_WEIGHTS_GIVEN) {
        for (int k = 0; k < 9; k++)
            it->weights[k] = k % 3 == 2 ? fuzz_number(bytes) : fuzz_below(bytes, n_vertices + 1);
        it->request.edge_weights = it->weights;
        it->request.n_edge_weights = fuzz_below(bytes, 4);
    }
}

/* --- what the header promises -------------------------------------------------------------------------------------- */

static void check_error(const orb_error *error, orb_status status, const sample_mesh *mesh) {
    must(status == error->status && error->message[0] && memchr(error->message, 0, sizeof error->message));
    must(error->n_elements >= 0 && error->n_elements <= ORB_MAX_ELEMENTS);
    if (status == ORB_INDEX_OUT_OF_RANGE || status == ORB_BAD_CONE || status == ORB_BAD_WEIGHT)
        return; /* they may name what is not there: that is the fault */
    for (int32_t k = 0; k < error->n_elements; k++)
        must(error->elements[k] >= 0 &&
             (error->element == ORB_CHARACTER ||
              error->elements[k] < (error->element == ORB_TRIANGLE ? mesh->n_triangles : mesh->n_vertices)));
}

static void check_embedding(const orb_embedding *embedding, const sample_mesh *mesh) {
    orb_report report;
    orb_error error;
    orb_embedding_report(embedding, &report);
    must(report.flipped == 0 && report.seam_residual < 1e-6 && report.angle_residual < 1e-6);
    must(isfinite(report.energy) && report.vertices == mesh->n_vertices);
    orb_view view;
    orb_embedding_view(embedding, &view);
    double *numbers = sample_allocate(6 * (size_t)view.n_triangles + 3 * (size_t)view.n_vertices, sizeof *numbers);
    for (int chart = 0; chart < CHARTS; chart++) {
        int64_t flipped = 0;
        if (orb_uv(embedding, (orb_chart)chart, numbers, &flipped, &error) != ORB_OK)
            continue;
        for (int32_t k = 0; k < 6 * view.n_triangles; k++)
            must(isfinite(numbers[k]) || chart == ORB_CHART_STEREOGRAPHIC);
    }
    orb_whole_sphere(embedding, numbers, NULL, &error);
    int32_t *triangles = sample_allocate((size_t)mesh->n_vertices, sizeof *triangles);
    if (orb_surface_map(embedding, embedding, 0, NULL, NULL, triangles, numbers, NULL, &error) == ORB_OK)
        for (int32_t v = 0; v < mesh->n_vertices; v++)
            must(triangles[v] >= -1 && triangles[v] < mesh->n_triangles);
    free(triangles);
    free(numbers);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    fuzz_bytes bytes = {data, size};
    sample_mesh mesh = good_mesh(&bytes);
    spoil(&mesh, &bytes);
    const orb_mesh_arrays arrays = sample_arrays(&mesh);
    asked it = {0};
    orb_embedding *embedding = NULL;
    orb_error error = {0};
    read_request(&bytes, mesh.n_vertices, &it);
    const orb_status status = orb_embed(&arrays, &it.request, &embedding, &error);
    must((status == ORB_OK) == (embedding != NULL));
    if (status == ORB_OK)
        check_embedding(embedding, &mesh);
    else
        check_error(&error, status, &mesh);
    orb_embedding_free(embedding);
    if (fuzz_below(&bytes, 16) == 15) { /* slower */
        const char *const signatures[] = {it.signature};
        const orb_suggest_request request = {.n_signatures = 1, .signatures = signatures, .holes = it.request.holes};
        orb_suggestions *suggestions = NULL;
        const orb_status found = orb_suggest_cones(&arrays, &request, &suggestions, &error);
        must((found == ORB_OK) == (suggestions != NULL));
        if (found != ORB_OK)
            check_error(&error, found, &mesh);
        orb_suggestions_free(suggestions);
    }
    sample_free(&mesh);
    return 0;
}
