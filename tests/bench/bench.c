/* Seconds of each stage, and the ratio to the least that any Euclidean solve costs. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The floor is one CHOLMOD analysis, factorisation and solution of the bare complex Laplacian of the same mesh,
 * measured in the same run, before each embedding; of several rounds the fastest counts. Machines differ, ratios hardly.
 * `again` is the whole time with what other embeddings of the mesh have left prepared, as when a cone is moved.
 *
 * The last table is that of cone suggestions, for all usual signatures at once: whole, and without the embeddings of tiles
 * that are not conformal.
 *
 *     bench [ROUNDS [MESHES]]         ../shared/meshes where present, else meshes made here */
#include <complex.h>
#include <stdlib.h>

#include "cholesky.h"
#include "mesh.h"
#include "meshes.h"
#include "monitor.h"
#include "orbifold_cones.h"

enum { MOST_CONES = 10 };

static void give_up(const char *what, const orb_error *error) {
    fprintf(stderr, "bench: %s: %s\n", what, error ? error->message : "out of memory");
    exit(1);
}

/* Analysis, factorisation and solution of the complex graph Laplacian (plus one on a diagonal entry). */
static double floor_seconds(const orb_mesh *mesh) {
    orb_error error;
    size_t edges = (size_t)mesh->n_edges, n = (size_t)mesh->n_vertices;
    int32_t *ends = malloc(2 * edges * sizeof *ends), *order = malloc(n * sizeof *order);
    int64_t *slot = malloc(edges * sizeof *slot);
    orb_pattern pattern = {0};
    orb_cholesky *cholesky = NULL;
    bool positive = false;
    if (!ends || !order || !slot)
        give_up("floor", NULL);
    for (size_t e = 0; e < edges; e++) {
        ends[2 * e] = halfedge_from(mesh, mesh->edge_halfedge[e]);
        ends[2 * e + 1] = halfedge_to(mesh, mesh->edge_halfedge[e]);
    }
    if (pattern_of_pairs(mesh->n_vertices, mesh->n_edges, ends, &pattern, slot, &error) != ORB_OK)
        give_up("floor", &error);
    double complex *values = calloc((size_t)pattern.column[n], sizeof *values);
    double complex *right = calloc(n, sizeof *right);
    if (!values || !right)
        give_up("floor", NULL);
    for (size_t e = 0; e < edges; e++) {
        values[slot[e]] = -1;
        values[pattern.column[ends[2 * e]]] += 1;
        values[pattern.column[ends[2 * e + 1]]] += 1;
    }
    values[0] += 1;
    right[0] = 1;
    double start = monitor_clock();
    if (cholesky_order(&pattern, ORDERING_AMD, order, &error) != ORB_OK ||
        cholesky_analyze(&pattern, order, true, &cholesky, &error) != ORB_OK ||
        cholesky_factor(cholesky, (double *)values, &positive, &error) != ORB_OK || !positive ||
        cholesky_solve(cholesky, (double *)right, 1, (double *)right, &error) != ORB_OK)
        give_up("floor", &error);
    double seconds = monitor_clock() - start;
    cholesky_free(cholesky);
    pattern_clear(&pattern);
    free(ends), free(order), free(slot), free(values), free(right);
    return seconds;
}

/* Vertices far from one another, each the farthest from those before; then put in the sequence of a short walk. */
static void pick_cones(const sample_mesh *mesh, int32_t k, int32_t *cones) {
    double *far = malloc((size_t)mesh->n_vertices * sizeof *far);
    if (!far)
        give_up("cones", NULL);
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        far[v] = 1e300;
    for (int32_t i = -1, last = 0; i < k; i++) {
        int32_t best = 0;
        for (int32_t v = 0; v < mesh->n_vertices; v++) {
            double square = 0;
            for (int c = 0; c < 3; c++) {
                double d = mesh->vertices[3 * v + c] - mesh->vertices[3 * last + c];
                square += d * d;
            }
            far[v] = square < far[v] ? square : far[v];
            best = far[v] > far[best] ? v : best;
        }
        if (i + 1 < k)
            cones[i + 1] = best;
        last = best;
    }
    free(far);
    for (int32_t i = 1; i + 1 < k; i++)
        for (int32_t j = i + 1; j < k; j++) { /* nearest first */
            double square[2] = {0, 0};
            for (int c = 0; c < 3; c++) {
                double here = mesh->vertices[3 * cones[i - 1] + c];
                square[0] += pow(mesh->vertices[3 * cones[i] + c] - here, 2);
                square[1] += pow(mesh->vertices[3 * cones[j] + c] - here, 2);
            }
            if (square[1] < square[0]) {
                int32_t swap = cones[i];
                cones[i] = cones[j];
                cones[j] = swap;
            }
        }
}

/* Embeds once; *best keeps the report of the fastest. */
static void embed_timed(const char *name, const orb_mesh_arrays *arrays, const orb_request *request, orb_report *best) {
    orb_error error;
    orb_embedding *embedding = NULL;
    orb_report report;
    if (orb_embed(arrays, request, &embedding, &error) != ORB_OK)
        give_up(name, &error);
    orb_embedding_report(embedding, &report);
    if (report.seconds_total < best->seconds_total)
        *best = report;
    orb_embedding_free(embedding);
}

static void run_cones(const char *name, const sample_mesh *mesh, const char *signature, int32_t k, const int32_t *cones,
                      int rounds) {
    orb_error error;
    orb_mesh_arrays arrays = sample_arrays(mesh);
    orb_request request = orb_request_default();
    request.weights = ORB_WEIGHTS_COTANGENT;
    request.signature = signature;
    request.n_cones = k;
    request.cones = cones;
    orb_mesh *topology = NULL;
    orb_prepared *prepared = NULL;
    if (mesh_create(&arrays, &topology, &error) != ORB_OK || orb_prepare(&arrays, &prepared, &error) != ORB_OK)
        give_up(name, &error);
    double least = 1e300;
    orb_report best = {.seconds_total = 1e300}, again = best;
    for (int round = 0; round < rounds; round++) {
        least = fmin(least, floor_seconds(topology));
        request.prepared = NULL;
        embed_timed(name, &arrays, &request, &best);
        request.prepared = prepared;
        embed_timed(name, &arrays, &request, &again);
    }
    mesh_free(topology);
    orb_prepared_free(prepared);
    printf("%-12s %8d %-8s %5d %7.3f %6.3f %6.3f %7.3f %8.3f %7.3f %6.3f %6.3f %7.3f %7.3f %7.3f %7.3f %6.1f\n", name,
           (int)mesh->n_vertices, signature, (int)best.iterations, best.seconds_topology, best.seconds_cut,
           best.seconds_tile, best.seconds_initial, best.seconds_assemble, best.seconds_analyze, best.seconds_factor,
           best.seconds_solve, best.seconds_certify, best.seconds_total, again.seconds_total, least,
           best.seconds_total / least);
    fflush(stdout);
}

static void run(const char *name, const sample_mesh *mesh, const char *signature, int32_t k, int rounds) {
    int32_t cones[MOST_CONES];
    pick_cones(mesh, k, cones);
    run_cones(name, mesh, signature, k, cones, rounds);
}

/* Disks, a torus, genus 3: surfaces of ../shared/meshes that are no spheres. */
static void run_surface(const char *name, const char *signature, int32_t k, const int32_t *cones, int rounds) {
    sample_mesh mesh;
    if (!sample_read(&mesh, name))
        return;
    run_cones(name, &mesh, signature, k, cones, rounds);
    sample_free(&mesh);
}

typedef struct watch {
    double start, search; /* when it began, and seconds until the first embedding */
} watch;

static bool look(const char *stage, double fraction, void *user) {
    watch *w = user;
    (void)fraction;
    if (w->search < 0 && strcmp(stage, "embedding") == 0)
        w->search = monitor_clock() - w->start;
    return true;
}

/* Seconds of the usual suggestions, and their ratio to the floor. */
static void run_suggestions(const char *name, const sample_mesh *mesh, int rounds) {
    orb_error error;
    orb_mesh_arrays arrays = sample_arrays(mesh);
    orb_mesh *topology = NULL;
    if (mesh_create(&arrays, &topology, &error) != ORB_OK)
        give_up(name, &error);
    double least = 1e300, total = 1e300, search = 1e300;
    orb_suggestions *suggestions = NULL;
    for (int round = 0; round < rounds; round++) {
        orb_suggestions_free(suggestions);
        least = fmin(least, floor_seconds(topology));
        watch w = {monitor_clock(), -1};
        orb_suggest_request request = {.progress = look, .user = &w};
        if (orb_suggest_cones(&arrays, &request, &suggestions, &error) != ORB_OK)
            give_up(name, &error);
        const double seconds = monitor_clock() - w.start;
        total = fmin(total, seconds);
        search = fmin(search, w.search < 0 ? seconds : w.search);
    }
    mesh_free(topology);
    const orb_suggestion best = orb_suggestions_view(suggestions, 0);
    printf("%-12s %8d %6d %-10s %7.3f %8.3f %8.3f %7.3f %6.1f\n", name, (int)mesh->n_vertices,
           (int)orb_suggestions_count(suggestions), best.signature, best.predicted, search, total, least,
           total / least);
    fflush(stdout);
    orb_suggestions_free(suggestions);
}

/* Refined until it has at least `least` vertices. */
static void refine_to(sample_mesh *mesh, int32_t least) {
    while (mesh->n_vertices < least) {
        sample_mesh finer = sample_refined(mesh, 2);
        sample_free(mesh);
        *mesh = finer;
    }
}

int main(int argc, char **argv) {
    static const struct {
        const char *name;
        int32_t least, level;
    } meshes[] = {
        {"david.obj", 0, 6}, {"nefertiti.obj", 0, 6}, {"armadillo.obj", 150000, 7}, {"armadillo.obj", 600000, 8}};
    static const struct {
        const char *signature;
        int32_t k;
    } orbifolds[] = {{"442", 3}, {"2222", 4}, {"432", 3}, {"55", 2}, {"237", 3}, {"2222222", 7}};
    int rounds = argc > 1 ? atoi(argv[1]) : 3;
    int largest = argc > 2 ? atoi(argv[2]) : 3;
    printf("%-12s %8s %-8s %5s %7s %6s %6s %7s %8s %7s %6s %6s %7s %7s %7s %7s %6s\n", "mesh", "vertices", "orbifold",
           "steps", "topol.", "cut", "tile", "initial", "assemble", "analyze", "factor", "solve", "certify", "total",
           "again", "floor", "ratio");
    for (int i = 0; i < largest && i < 4; i++) {
        sample_mesh mesh;
        bool shared = sample_read(&mesh, meshes[i].name);
        if (!shared)
            mesh = sample_icosphere(meshes[i].level);
        refine_to(&mesh, meshes[i].least);
        for (size_t j = 0; j < sizeof orbifolds / sizeof *orbifolds; j++)
            run(shared ? meshes[i].name : "icosphere", &mesh, orbifolds[j].signature, orbifolds[j].k,
                rounds > 0 ? rounds : 1);
        sample_free(&mesh);
    }
    static const struct {
        const char *name, *signature;
        int32_t k, cones[3];
    } surfaces[] = {{"camelhead.off", "*442", 3, {5307, 8619, 3265}},
                    {"camelhead.off", "*432", 3, {5307, 8619, 3265}},
                    {"camelhead.off", "*237", 3, {5307, 8619, 3265}},
                    {"kitten.obj", "o", 0, {0}},
                    {"three_holes.off", "ooo", 0, {0}}};
    for (size_t i = 0; i < sizeof surfaces / sizeof *surfaces; i++)
        run_surface(surfaces[i].name, surfaces[i].signature, surfaces[i].k, surfaces[i].cones, rounds);
    printf("\n%-12s %8s %6s %-10s %7s %8s %8s %7s %6s\n", "mesh", "vertices", "signs.", "best", "spread", "search",
           "total", "floor", "ratio");
    for (int i = 0; i < largest && i < 4; i++) {
        sample_mesh mesh;
        if (!sample_read(&mesh, meshes[i].name))
            mesh = sample_icosphere(meshes[i].level);
        refine_to(&mesh, meshes[i].least);
        run_suggestions(meshes[i].name, &mesh, mesh.n_vertices > 100000 || rounds < 1 ? 1 : rounds);
        sample_free(&mesh);
    }
    sample_mesh disk;
    if (sample_read(&disk, "camelhead.off"))
        run_suggestions("camelhead.off", &disk, rounds > 0 ? rounds : 1);
    sample_free(&disk);
    return 0;
}
