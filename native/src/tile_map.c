/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tile_map.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lattice.h"

static const double same_corner = 1e-8;  /* distance */
static const double same_element = 1e-4; /* of the origin's images, which may lie far out */

orb_point tile_map_point(const orb_tile_map *map, orb_point p) {
    if (map->identity)
        return p;
    if (!map->affine)
        return isometry_apply(map->geometry, map->isometry, p);
    const orb_isometry shift = isometry_inverse(isometry_to_origin(map->geometry, point_of(map->c)));
    return isometry_apply(map->geometry, shift, point_linear(map->a, map->b, p));
}

/* In the plane h has linear part y -> u y, which commutes with the map, or y -> u conj(y), and then
 * a u conj(y) + b conj(u) y = u' conj(a y + b conj(y)), so that u' = u a / conj(a). */
static orb_isometry affine_element(const orb_tile_map *map, orb_isometry h) {
    const orb_geometry *geometry = map->geometry;
    const double complex half = map->a / cabs(map->a);
    orb_isometry turn = {h.reflects ? point_linear(half, 0, h.a) : h.a, point_of(0), h.reflects};
    const orb_point start = tile_map_point(map, point_of(0));
    const orb_point end = tile_map_point(map, isometry_apply(geometry, h, point_of(0)));
    const orb_isometry home = isometry_to_origin(geometry, isometry_apply(geometry, turn, start));
    const orb_isometry away = isometry_inverse(isometry_to_origin(geometry, end));
    return isometry_compose(geometry, away, isometry_compose(geometry, home, turn));
}

orb_isometry tile_map_element(const orb_tile_map *map, orb_isometry h) {
    if (map->identity)
        return h;
    if (map->affine)
        return affine_element(map, h);
    const orb_isometry out = isometry_compose(map->geometry, h, isometry_inverse(map->isometry));
    return isometry_compose(map->geometry, map->isometry, out);
}

/* --- words ------------------------------------------------------------------------------------------------------- */

/* Which pick a corner of the tile is; -1: none. */
static int32_t pick_at(const orb_embedding *embedding, int32_t side) {
    for (int32_t k = 0; k < embedding->surface->n_marks; k++)
        if (embedding->surface->vertex[k] == embedding->corners[side])
            return k;
    return -1;
}

/* All that a word says of a side, whatever side the word begins with. */
typedef struct letter {
    int32_t pick, partner; /* partner: how many sides further on */
    bool same_way;
} letter;

static int compare(letter a, letter b) {
    if (a.pick != b.pick)
        return a.pick < b.pick ? -1 : 1;
    if (a.partner != b.partner)
        return a.partner < b.partner ? -1 : 1;
    return a.same_way - b.same_way;
}

static void spell(const orb_embedding *embedding, letter *letters) {
    const orb_word *word = embedding->tile->word;
    for (int32_t s = 0; s < word->n_sides; s++)
        letters[s] =
            (letter){pick_at(embedding, s), (word->partner[s] - s + word->n_sides) % word->n_sides, word->same_way[s]};
}

/* How the word that begins with letter i compares with that which begins with j of another one. */
static int compare_from(int32_t n, const letter *a, int32_t i, const letter *b, int32_t j) {
    for (int32_t k = 0; k < n; k++) {
        const int order = compare(a[(i + k) % n], b[(j + k) % n]);
        if (order)
            return order;
    }
    return 0;
}

/* Where the word begins if it is to come first in the dictionary; so turns from one word to another one are those to a
 * third one and from there, also where several would do. */
static int32_t first_letter(int32_t n, const letter *letters) {
    int32_t first = 0;
    for (int32_t s = 1; s < n; s++)
        if (compare_from(n, letters, s, letters, first) < 0)
            first = s;
    return first;
}

/* --- tiles ------------------------------------------------------------------------------------------------------- */

/* The affine map that takes corner s of a to corner s + turn of b, by least squares in (z, conj z, 1): with the means
 * taken out, the normal equations of w = a z + b conj(z). */
static bool fit_affine(const orb_tile *a, const orb_tile *b, int32_t turn, orb_tile_map *map) {
    const int32_t n = a->word->n_sides;
    double complex mean = 0, image = 0, zz = 0, wz = 0, wc = 0;
    double size = 0;
    for (int32_t s = 0; s < n; s++) {
        mean += a->corners[s].z / n;
        image += b->corners[(s + turn) % n].z / n;
    }
    for (int32_t s = 0; s < n; s++) {
        const double complex z = a->corners[s].z - mean, w = b->corners[(s + turn) % n].z - image;
        size += creal(z * conj(z));
        zz += z * z;
        wz += w * conj(z);
        wc += w * z;
    }
    const double determinant = size * size - creal(zz * conj(zz));
    if (!(determinant > 0))
        return false;
    map->affine = true;
    map->a = (wz * size - wc * conj(zz)) / determinant;
    map->b = (wc * size - wz * zz) / determinant;
    map->c = image - map->a * mean - map->b * conj(mean);
    return cabs(map->a) > cabs(map->b);
}

static bool fit(const orb_tile *a, const orb_tile *b, int32_t turn, orb_tile_map *map) {
    const int32_t n = a->word->n_sides;
    *map = (orb_tile_map){.geometry = a->geometry, .identity = turn == 0, .isometry = isometry_identity()};
    for (int32_t s = 0; s < n && map->identity; s++)
        map->identity = a->corners[s].z == b->corners[s].z && a->corners[s].low == b->corners[s].low;
    if (map->identity)
        return true;
    if (geometry_has_translations(a->geometry)) {
        if (!fit_affine(a, b, turn, map))
            return false;
    } else { /* by sides, not corners: the two of a lune are antipodal */
        map->isometry = isometry_compose(a->geometry, b->lines[turn], isometry_inverse(a->lines[0]));
    }
    for (int32_t s = 0; s < n; s++)
        map->residual = fmax(map->residual, geometry_distance(a->geometry, tile_map_point(map, a->corners[s]),
                                                              b->corners[(s + turn) % n]));
    bool same = map->residual < same_corner;
    for (int32_t s = 0; s < n && same && !a->fixed; s++)
        same = isometry_same(a->geometry, tile_map_element(map, a->pairings[s]), b->pairings[(s + turn) % n],
                             same_element);
    return same;
}

/* --- tori -------------------------------------------------------------------------------------------------------- */

static bool is_torus(const orb_embedding *embedding) {
    const orb_signature *s = embedding->surface->signature;
    return s && s->n_handles == 1 && s->n_cones + s->n_mirrors + s->n_crosscaps == 0;
}

/* No landmark says which loop of one torus goes to which of the other one: the shortest translations go to one another,
 * whatever the cuts are. */
static orb_status fit_tori(const orb_tile *a, const orb_tile *b, orb_tile_map *map, orb_error *error) {
    double complex u[2], w[2], axis;
    int rotations;
    *map = (orb_tile_map){.geometry = a->geometry, .affine = true};
    orb_status status = lattice_create(a, u, &rotations, &axis, error);
    if (status == ORB_OK)
        status = lattice_create(b, w, &rotations, &axis, error);
    if (status != ORB_OK)
        return status;
    if (a->word->n_sides == b->word->n_sides && fit(a, b, 0, map) && map->identity)
        return ORB_OK;
    const double complex determinant = u[0] * conj(u[1]) - conj(u[0]) * u[1];
    *map = (orb_tile_map){.geometry = a->geometry, .affine = true};
    map->a = (w[0] * conj(u[1]) - w[1] * conj(u[0])) / determinant;
    map->b = (u[0] * w[1] - u[1] * w[0]) / determinant;
    map->c = b->corners[0].z - map->a * a->corners[0].z - map->b * conj(a->corners[0].z);
    return ORB_OK;
}

/* --- what does not correspond ------------------------------------------------------------------------------------ */

static orb_status check_features(const orb_embedding *source, const orb_embedding *target, orb_error *error) {
    const orb_surface *a = source->surface, *b = target->surface;
    if (source->tile->fixed != target->tile->fixed)
        return error_set(error, ORB_NO_CORRESPONDENCE,
                         "one mesh is on an orbifold and the other on a fixed polygon: embed both alike");
    if (source->tile->geometry != target->tile->geometry ||
        (a->signature && strcmp(a->signature->text, b->signature->text) != 0))
        return error_set(error, ORB_NO_CORRESPONDENCE,
                         "one mesh is on %s and the other on %s: embed both on one orbifold",
                         a->signature ? a->signature->text : "one polygon",
                         a->signature ? b->signature->text : "one of another geometry");
    if (a->n_marks != b->n_marks)
        return error_set(error, ORB_NO_CORRESPONDENCE, "one polygon has %d corners and the other %d: embed both on one",
                         (int)a->n_marks, (int)b->n_marks);
    for (int32_t k = 0; k < a->n_marks; k++)
        if (a->order[k] != b->order[k] || a->mirror[k] != b->mirror[k])
            return error_set_elements(
                error, ORB_NO_CORRESPONDENCE, ORB_VERTEX, &a->vertex[k], 1, 1,
                "landmark %d has order %d on one mesh (vertex %d) and %d on the other (vertex %d): "
                "give the cones of both in one sequence with one sequence of orders",
                (int)k, (int)a->order[k], (int)a->vertex[k], (int)b->order[k], (int)b->vertex[k]);
    return ORB_OK;
}

static orb_status refuse_words(const orb_embedding *source, const orb_embedding *target, bool tiles_differ,
                               orb_error *error) {
    const orb_signature *s = source->surface->signature;
    if (!s)
        return error_set(error, ORB_NO_CORRESPONDENCE, "the two meshes are on different polygons: embed both on one");
    if (tiles_differ)
        return error_set(error, ORB_NO_CORRESPONDENCE, "the two tiles of %s have different shapes", s->text);
    if (s->n_crosscaps + s->n_handles > 0)
        return error_set(
            error, ORB_NO_CORRESPONDENCE,
            "the two meshes of %s are cut open along graphs that do not correspond, since shortest paths "
            "decide how they run: place cones and corners more alike, or choose an orbifold without handles "
            "and cross-caps",
            s->text);
    if ((source->surface->cut != ORB_CUT_PATH || target->surface->cut != ORB_CUT_PATH) &&
        (s->n_cones > 0 || s->n_mirrors > 1))
        return error_set(error, ORB_NO_CORRESPONDENCE,
                         "the two meshes are cut open differently, at least one of them along a graph instead of the "
                         "path through its cones in turn: embed both with the cut 'path'");
    return error_set(
        error, ORB_NO_CORRESPONDENCE,
        "the corners follow one another round one mesh as they do not round the other, or have no vertex "
        "between them on one: give them in one sequence, counter-clockwise as seen from outside on both or "
        "on neither");
}

orb_status tile_map_find(const orb_embedding *source, const orb_embedding *target, orb_tile_map *map,
                         orb_error *error) {
    const orb_word *a = source->tile->word, *b = target->tile->word;
    orb_status status = check_features(source, target, error);
    if (status != ORB_OK)
        return status;
    if (is_torus(source))
        return fit_tori(source->tile, target->tile, map, error);
    if (a->n_sides != b->n_sides || a->n_nodes != b->n_nodes)
        return refuse_words(source, target, false, error);
    const int32_t n = a->n_sides;
    letter *from = malloc((2 * (size_t)n + 1) * sizeof *from), *to = from + n;
    if (!from)
        return error_memory(error);
    spell(source, from);
    spell(target, to);
    const int32_t start = first_letter(n, from), end = first_letter(n, to);
    const bool same = compare_from(n, from, start, to, end) == 0;
    free(from);
    if (!same || !fit(source->tile, target->tile, (end - start + n) % n, map))
        return refuse_words(source, target, same, error);
    return ORB_OK;
}
