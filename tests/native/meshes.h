/* Meshes for the C tests. SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Each function hands over a sample_mesh that sample_free releases; closed ones are oriented outwards. Memory that
 * runs out aborts the test program. sample_read takes a file of ../shared/meshes and fails if it is not there:
 *
 *     sample_mesh mesh;
 *     if (!sample_read(&mesh, "spot.obj")) SKIP("no ../shared/meshes/spot.obj");
 *     const orb_mesh_arrays arrays = sample_arrays(&mesh);
 *     ...
 *     sample_free(&mesh); */
#ifndef MESHES_H
#define MESHES_H

#include "orbifold.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct sample_mesh {
    int32_t n_vertices, n_triangles;
    double *vertices;   /* [n_vertices*3] */
    int32_t *triangles; /* [n_triangles*3] */
} sample_mesh;

static inline orb_mesh_arrays sample_arrays(const sample_mesh *mesh) {
    return (orb_mesh_arrays){mesh->n_vertices, mesh->vertices, mesh->n_triangles, mesh->triangles};
}

static inline void sample_free(sample_mesh *mesh) {
    free(mesh->vertices);
    free(mesh->triangles);
    *mesh = (sample_mesh){0};
}

static inline void *sample_allocate(size_t count, size_t size) {
    void *memory = calloc(count ? count : 1, size);
    if (!memory)
        abort();
    return memory;
}

static inline sample_mesh sample_new(int32_t n_vertices, int32_t n_triangles) {
    return (sample_mesh){n_vertices, n_triangles, sample_allocate(3 * (size_t)n_vertices, sizeof(double)),
                         sample_allocate(3 * (size_t)n_triangles, sizeof(int32_t))};
}

/* A mesh with these numbers: vertices[n*3], triangles[m*3]. */
static inline sample_mesh sample_from(int32_t n, const double *vertices, int32_t m, const int32_t *triangles) {
    sample_mesh mesh = sample_new(n, m);
    memcpy(mesh.vertices, vertices, 3 * (size_t)n * sizeof *vertices);
    memcpy(mesh.triangles, triangles, 3 * (size_t)m * sizeof *triangles);
    return mesh;
}

static inline void sample_scale(sample_mesh *mesh, double factor) {
    for (size_t i = 0; i < 3 * (size_t)mesh->n_vertices; i++)
        mesh->vertices[i] *= factor;
}

/* Exchanges the numbers of two vertices. */
static inline void sample_swap_vertices(sample_mesh *mesh, int32_t a, int32_t b) {
    for (int k = 0; k < 3; k++) {
        const double kept = mesh->vertices[3 * (size_t)a + (size_t)k];
        mesh->vertices[3 * (size_t)a + (size_t)k] = mesh->vertices[3 * (size_t)b + (size_t)k];
        mesh->vertices[3 * (size_t)b + (size_t)k] = kept;
    }
    for (size_t i = 0; i < 3 * (size_t)mesh->n_triangles; i++)
        mesh->triangles[i] = mesh->triangles[i] == a ? b : mesh->triangles[i] == b ? a : mesh->triangles[i];
}

/* --- Platonic solids ------------------------------------------------------------------------------------------ */

static inline sample_mesh sample_tetrahedron(void) /* edges of 2 sqrt(2) */
{
    const double vertices[] = {1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1};
    const int32_t triangles[] = {0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2};
    return sample_from(4, vertices, 4, triangles);
}

static inline sample_mesh sample_octahedron(void) /* edges of sqrt(2); vertices +x, -x, +y, -y, +z, -z */
{
    const double vertices[] = {1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};
    const int32_t triangles[] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
    return sample_from(6, vertices, 8, triangles);
}

/* Edges of 2; vertex 4 z + 2 y + x of the corner (x, y, z) in {0, 1}; each side has one diagonal. */
static inline sample_mesh sample_cube(void) {
    const double vertices[] = {-1, -1, -1, 1, -1, -1, -1, 1, -1, 1, 1, -1, -1, -1, 1, 1, -1, 1, -1, 1, 1, 1, 1, 1};
    const int32_t triangles[] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
    return sample_from(8, vertices, 12, triangles);
}

static inline sample_mesh sample_icosahedron(void) /* in the unit sphere */
{
    const double g = (1 + sqrt(5.0)) / 2;
    const double vertices[] = {-1, g,  0,  1, g, 0,  -1, -g, 0,  1, -g, 0, 0,  -1, g,  0,  1, g,
                               0,  -1, -g, 0, 1, -g, g,  0,  -1, g, 0,  1, -g, 0,  -1, -g, 0, 1};
    const int32_t triangles[] = {0, 11, 5,  0, 5,  1, 0, 1, 7, 0, 7,  10, 0, 10, 11, 1, 5, 9, 5, 11,
                                 4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3,  9,  4, 3,  4,  2, 3, 2, 6, 3,
                                 6, 8,  3,  8, 9,  4, 9, 5, 2, 4, 11, 6,  2, 10, 8,  6, 7, 9, 8, 1};
    sample_mesh mesh = sample_from(12, vertices, 20, triangles);
    sample_scale(&mesh, 1 / sqrt(1 + g * g));
    return mesh;
}

/* --- refinement ----------------------------------------------------------------------------------------------- */

/* A side of a triangle, for sorting: half-edge 3 t + c runs from corner c to corner c + 1. */
typedef struct sample_side {
    int32_t low, high, halfedge;
} sample_side;

static inline int sample_compare_sides(const void *left, const void *right) {
    const sample_side *a = left, *b = right;
    if (a->low != b->low)
        return a->low < b->low ? -1 : 1;
    if (a->high != b->high)
        return a->high < b->high ? -1 : 1;
    return (a->halfedge > b->halfedge) - (a->halfedge < b->halfedge);
}

/* The edge of each half-edge, edge[n_triangles*3], and the half-edges on each edge, sides[n_triangles*3] (room for as
 * many edges as there are half-edges; may be NULL). Returns the number of edges. */
static inline int32_t sample_edges(const sample_mesh *mesh, int32_t *edge, int32_t *sides) {
    const int32_t n = 3 * mesh->n_triangles;
    sample_side *sorted = sample_allocate((size_t)n, sizeof *sorted);
    for (int32_t h = 0; h < n; h++) {
        const int32_t a = mesh->triangles[h], b = mesh->triangles[h % 3 == 2 ? h - 2 : h + 1];
        sorted[h] = (sample_side){a < b ? a : b, a < b ? b : a, h};
    }
    qsort(sorted, (size_t)n, sizeof *sorted, sample_compare_sides);
    int32_t n_edges = 0;
    for (int32_t i = 0; i < n; i++) {
        const bool first = i == 0 || sorted[i].low != sorted[i - 1].low || sorted[i].high != sorted[i - 1].high;
        if (first && sides)
            sides[n_edges] = 0;
        if (first)
            n_edges++;
        edge[sorted[i].halfedge] = n_edges - 1;
        if (sides)
            sides[n_edges - 1]++;
    }
    free(sorted);
    return n_edges;
}

/* Each triangle in n^2 congruent ones. The old vertices keep their numbers. */
static inline sample_mesh sample_refined(const sample_mesh *mesh, int32_t n) {
    int32_t *edge = sample_allocate(3 * (size_t)mesh->n_triangles, sizeof *edge);
    const int32_t n_edges = sample_edges(mesh, edge, NULL), inner = (n - 1) * (n - 2) / 2;
    const int32_t on_edges = mesh->n_vertices, inside = on_edges + n_edges * (n - 1);
    sample_mesh fine = sample_new(inside + mesh->n_triangles * inner, mesh->n_triangles * n * n);
    int32_t *grid = sample_allocate((size_t)(n + 1) * (size_t)(n + 1), sizeof *grid), made = 0;
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        const int32_t *corner = mesh->triangles + 3 * (size_t)t;
        int32_t next = inside + t * inner;
        for (int32_t i = 0; i <= n; i++) { /* the point (k corner 0 + i corner 1 + j corner 2) / n */
            for (int32_t j = 0; i + j <= n; j++) {
                const int32_t k = n - i - j, part[3] = {k, i, j};
                int32_t v = -1;
                for (int c = 0; c < 3; c++) {
                    const int32_t d = (c + 1) % 3, e = edge[3 * t + c];
                    if (part[c] == n)
                        v = corner[c];
                    if (part[c] > 0 && part[d] > 0 && part[3 - c - d] == 0) /* counted from the lower vertex */
                        v = on_edges + e * (n - 1) + (corner[c] < corner[d] ? part[d] : part[c]) - 1;
                }
                if (v < 0)
                    v = next++;
                grid[i * (n + 1) + j] = v;
                for (int x = 0; x < 3; x++)
                    fine.vertices[3 * (size_t)v + (size_t)x] = (k * mesh->vertices[3 * (size_t)corner[0] + (size_t)x] +
                                                                i * mesh->vertices[3 * (size_t)corner[1] + (size_t)x] +
                                                                j * mesh->vertices[3 * (size_t)corner[2] + (size_t)x]) /
                                                               n;
            }
        }
        for (int32_t i = 0; i < n; i++) {
            for (int32_t j = 0; i + j < n; j++) {
                const int32_t at = i * (n + 1) + j, right = at + n + 1, up = at + 1;
                int32_t *out = fine.triangles + 3 * (size_t)made++;
                out[0] = grid[at], out[1] = grid[right], out[2] = grid[up];
                if (i + j + 1 >= n)
                    continue;
                out = fine.triangles + 3 * (size_t)made++;
                out[0] = grid[right], out[1] = grid[right + 1], out[2] = grid[up];
            }
        }
    }
    free(grid);
    free(edge);
    return fine;
}

/* Unit sphere with 10 4^level + 2 vertices; the first 12 are the icosahedron's. */
static inline sample_mesh sample_icosphere(int level) {
    sample_mesh mesh = sample_icosahedron();
    for (int i = 0; i < level; i++) {
        sample_mesh fine = sample_refined(&mesh, 2);
        sample_free(&mesh);
        mesh = fine;
        for (int32_t v = 0; v < mesh.n_vertices; v++) {
            double *p = mesh.vertices + 3 * (size_t)v;
            const double length = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
            for (int k = 0; k < 3; k++)
                p[k] /= length;
        }
    }
    return mesh;
}

/* --- flat pillows, torus -------------------------------------------------------------------------------------- */

/* Two copies of a disk glued along its boundary, the second one reversed. The disk's vertices keep their numbers; the
 * second copy's inner vertices follow. No inner edge may join two boundary vertices. */
static inline sample_mesh sample_doubled(const sample_mesh *disk) {
    const size_t m3 = 3 * (size_t)disk->n_triangles;
    int32_t *edge = sample_allocate(m3, sizeof *edge), *sides = sample_allocate(m3, sizeof *sides);
    int32_t *copy = sample_allocate((size_t)disk->n_vertices, sizeof *copy), n = disk->n_vertices;
    sample_edges(disk, edge, sides);
    for (int32_t v = 0; v < disk->n_vertices; v++)
        copy[v] = -1;
    for (int32_t h = 0; h < 3 * disk->n_triangles; h++) {
        if (sides[edge[h]] != 1)
            continue;
        const int32_t a = disk->triangles[h], b = disk->triangles[h % 3 == 2 ? h - 2 : h + 1];
        copy[a] = a, copy[b] = b;
    }
    for (int32_t v = 0; v < disk->n_vertices; v++)
        if (copy[v] < 0)
            copy[v] = n++;
    sample_mesh pillow = sample_new(n, 2 * disk->n_triangles);
    memcpy(pillow.triangles, disk->triangles, m3 * sizeof *pillow.triangles);
    for (int32_t v = 0; v < disk->n_vertices; v++) {
        memcpy(pillow.vertices + 3 * (size_t)v, disk->vertices + 3 * (size_t)v, 3 * sizeof(double));
        memcpy(pillow.vertices + 3 * (size_t)copy[v], disk->vertices + 3 * (size_t)v, 3 * sizeof(double));
    }
    for (size_t i = 0; i < m3; i += 3)
        for (size_t c = 0; c < 3; c++)
            pillow.triangles[m3 + i + c] = copy[disk->triangles[i + 2 - c]];
    free(edge);
    free(sides);
    free(copy);
    return pillow;
}

/* A triangle of the plane z = 0 with these angles (radians) at its corners, which are vertices 0, 1, 2 (at (0, 0),
 * (1, 0) and above), counter-clockwise; the third angle is what is left of pi. Joining the centre of the inscribed
 * circle to the corners and to the points where the circle touches gives six right triangles, each cut into n^2. So
 * all cotangent weights of the doubled triangle are positive or zero: those along the hypotenuses are zero up to
 * rounding, which a clamp at 1e-13 leaves as good as zero. */
static inline sample_mesh sample_triangle(double angle_0, double angle_1, int32_t n) {
    const double side = sin(angle_1) / sin(angle_0 + angle_1); /* corner 0 to corner 2 */
    const double corners[3][2] = {{0, 0}, {1, 0}, {side * cos(angle_0), side * sin(angle_0)}};
    double length[3], coarse[7][3] = {{0}}, perimeter = 0; /* corners, touching points, centre */
    for (int c = 0; c < 3; c++) {
        const double *p = corners[c], *q = corners[(c + 1) % 3];
        perimeter += length[c] = hypot(q[0] - p[0], q[1] - p[1]);
    }
    int32_t triangles[18];
    for (int c = 0; c < 3; c++) {
        const int next = (c + 1) % 3;
        const double tangent = (0.5 * perimeter - length[next]) / length[c]; /* from corner c to the touching point */
        for (int k = 0; k < 2; k++) {
            coarse[c][k] = corners[c][k];
            coarse[3 + c][k] = (1 - tangent) * corners[c][k] + tangent * corners[next][k];
            coarse[6][k] += length[next] * corners[c][k] / perimeter;
        }
        const int32_t two[6] = {c, 3 + c, 6, 3 + c, next, 6};
        memcpy(triangles + 6 * c, two, sizeof two);
    }
    sample_mesh star = sample_from(7, coarse[0], 6, triangles), mesh = sample_refined(&star, n);
    sample_free(&star);
    return mesh;
}

static inline sample_mesh sample_pillow_triangle(double angle_0, double angle_1, int32_t n) {
    sample_mesh disk = sample_triangle(angle_0, angle_1, n), pillow = sample_doubled(&disk);
    sample_free(&disk);
    return pillow;
}

/* A rectangle of the plane z = 0 in nx by ny cells (each at least 2) of two triangles; the corners (0, 0), (width, 0),
 * (width, height), (0, height) are vertices 0, 1, 2, 3. The diagonals have weight zero up to rounding, as above. */
static inline sample_mesh sample_rectangle(double width, double height, int32_t nx, int32_t ny) {
    sample_mesh mesh = sample_new((nx + 1) * (ny + 1), 2 * nx * ny);
    for (int32_t y = 0; y <= ny; y++) {
        for (int32_t x = 0; x <= nx; x++) {
            double *p = mesh.vertices + 3 * (size_t)(y * (nx + 1) + x);
            p[0] = width * x / nx, p[1] = height * y / ny;
        }
    }
    for (int32_t y = 0; y < ny; y++) {
        for (int32_t x = 0; x < nx; x++) {
            const int32_t a = y * (nx + 1) + x, b = a + 1, c = b + nx + 1, d = c - 1;
            const bool falling = (x == 0 && y == ny - 1) || (x == nx - 1 && y == 0); /* through the corner, so that no
                                                                                     edge cuts the corner off */
            const int32_t rise[6] = {a, b, c, a, c, d}, fall[6] = {a, b, d, b, c, d};
            memcpy(mesh.triangles + 6 * (size_t)(y * nx + x), falling ? fall : rise, sizeof rise);
        }
    }
    sample_swap_vertices(&mesh, 1, nx); /* no corner's number is in the way of the next one: nx, ny >= 2 */
    sample_swap_vertices(&mesh, 2, (ny + 1) * (nx + 1) - 1);
    sample_swap_vertices(&mesh, 3, ny * (nx + 1));
    return mesh;
}

static inline sample_mesh sample_pillow_rectangle(double width, double height, int32_t nx, int32_t ny) {
    sample_mesh disk = sample_rectangle(width, height, nx, ny), pillow = sample_doubled(&disk);
    sample_free(&disk);
    return pillow;
}

/* Around the z axis, n times round the long way and m times the short way (each at least 3). */
static inline sample_mesh sample_torus(int32_t n, int32_t m, double radius, double tube) {
    const double turn = 2 * acos(-1);
    sample_mesh mesh = sample_new(n * m, 2 * n * m);
    for (int32_t i = 0; i < n; i++) {
        for (int32_t j = 0; j < m; j++) {
            double *p = mesh.vertices + 3 * (size_t)(i * m + j);
            const double across = radius + tube * cos(turn * j / m);
            p[0] = across * cos(turn * i / n), p[1] = across * sin(turn * i / n), p[2] = tube * sin(turn * j / m);
            const int32_t a = i * m + j, b = (i + 1) % n * m + j, c = (i + 1) % n * m + (j + 1) % m,
                          d = i * m + (j + 1) % m, two[6] = {a, b, c, a, c, d};
            memcpy(mesh.triangles + 6 * (size_t)a, two, sizeof two);
        }
    }
    return mesh;
}

/* --- files ---------------------------------------------------------------------------------------------------- */

static inline void sample_append_vertex(sample_mesh *mesh, const double point[3]) {
    const size_t n = (size_t)mesh->n_vertices++; /* the room doubles at powers of two */
    if ((n & (n - 1)) == 0)
        mesh->vertices = realloc(mesh->vertices, (n ? 6 * n : 3) * sizeof *mesh->vertices);
    if (!mesh->vertices)
        abort();
    memcpy(mesh->vertices + 3 * n, point, 3 * sizeof *point);
}

static inline void sample_append_triangle(sample_mesh *mesh, int32_t a, int32_t b, int32_t c) {
    const size_t n = (size_t)mesh->n_triangles++;
    if ((n & (n - 1)) == 0)
        mesh->triangles = realloc(mesh->triangles, (n ? 6 * n : 3) * sizeof *mesh->triangles);
    if (!mesh->triangles)
        abort();
    mesh->triangles[3 * n] = a, mesh->triangles[3 * n + 1] = b, mesh->triangles[3 * n + 2] = c;
}

/* "1/5/2 7/6/2 ..." or "0 6 ..." as a fan of triangles; `base` is the number of the first vertex; at most `limit`
 * numbers are read. */
static inline void sample_append_polygon(sample_mesh *mesh, const char *text, long base, long limit) {
    long first = 0, last = 0, count = 0;
    for (char *end; count < limit; text = end) {
        const long number = strtol(text, &end, 10) - base;
        if (end == text)
            break;
        end += strcspn(end, " \t\r\n");
        if (count == 0)
            first = number;
        if (count > 1)
            sample_append_triangle(mesh, (int32_t)first, (int32_t)last, (int32_t)number);
        last = number, count++;
    }
}

static inline void sample_read_obj(sample_mesh *mesh, FILE *file) {
    char line[4096];
    while (fgets(line, sizeof line, file)) {
        double p[3];
        if (sscanf(line, "v %lf %lf %lf", p, p + 1, p + 2) == 3)
            sample_append_vertex(mesh, p);
        if (line[0] == 'f' && line[1] == ' ')
            sample_append_polygon(mesh, line + 2, 1, 4096);
    }
}

static inline void sample_read_off(sample_mesh *mesh, FILE *file) {
    char line[4096];
    long n = -1, m = 0;
    while (fgets(line, sizeof line, file)) {
        double p[3];
        const char *text = line + strspn(line, " \t\r\n");
        if (*text == '\0' || *text == '#' || strncmp(text, "OFF", 3) == 0)
            continue;
        if (n < 0) {
            if (sscanf(text, "%ld %ld", &n, &m) != 2)
                return;
        } else if (mesh->n_vertices < n) {
            if (sscanf(text, "%lf %lf %lf", p, p + 1, p + 2) == 3)
                sample_append_vertex(mesh, p);
        } else if (m-- > 0) {
            char *end;
            const long count = strtol(text, &end, 10);
            sample_append_polygon(mesh, end, 0, count);
        }
    }
}

/* A .obj or .off file of the folder ../shared/meshes beside the checkout; the program may run in the checkout or in a
 * folder of it. Polygons become fans of triangles. False, with an empty mesh, if the file is not there. */
static inline bool sample_read(sample_mesh *mesh, const char *name) {
    FILE *file = NULL;
    const char *folders[] = {"../shared/meshes/", "../../shared/meshes/", "../../../shared/meshes/"};
    *mesh = (sample_mesh){0};
    for (size_t i = 0; !file && i < sizeof folders / sizeof *folders; i++) {
        char path[512];
        snprintf(path, sizeof path, "%s%s", folders[i], name);
        file = fopen(path, "r");
    }
    if (!file)
        return false;
    (strstr(name, ".off") ? sample_read_off : sample_read_obj)(mesh, file);
    fclose(file);
    return true;
}

/* A disk: vertex 0 in the middle of n others. */
static inline sample_mesh sample_fan(int32_t n) {
    sample_mesh mesh = sample_new(n + 1, n);
    for (int32_t i = 0; i < n; i++) {
        double angle = 2 * 3.14159265358979323846 * i / n;
        mesh.vertices[3 * i + 3] = cos(angle);
        mesh.vertices[3 * i + 4] = sin(angle);
        mesh.triangles[3 * i + 1] = 1 + i;
        mesh.triangles[3 * i + 2] = 1 + (i + 1) % n;
    }
    return mesh;
}

/* A band of n quadrangles, halved, three vertices wide; twisted: a Möbius band. */
static inline sample_mesh sample_band(int32_t n, bool twisted) {
    sample_mesh mesh = sample_new(3 * n, 4 * n);
    for (int32_t i = 0; i < n; i++)
        for (int32_t j = 0; j < 3; j++) {
            double angle = 2 * 3.14159265358979323846 * i / n, lean = twisted ? angle / 2 : 0, x = 0.3 * (j - 1);
            double *p = mesh.vertices + 3 * (3 * i + j);
            p[0] = (1 + x * cos(lean)) * cos(angle);
            p[1] = (1 + x * cos(lean)) * sin(angle);
            p[2] = x * sin(lean) + (twisted ? 0 : x);
        }
    for (int32_t i = 0; i < n; i++)
        for (int32_t j = 0; j < 2; j++) {
            bool flips = twisted && i == n - 1;
            int32_t next = (i + 1) % n, a = 3 * i + j, b = 3 * i + j + 1;
            int32_t c = 3 * next + (flips ? 2 - j : j), d = 3 * next + (flips ? 1 - j : j + 1);
            int32_t *t = mesh.triangles + 3 * (4 * i + 2 * j);
            t[0] = a, t[1] = c, t[2] = d, t[3] = a, t[4] = d, t[5] = b;
        }
    return mesh;
}

#endif
