/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * One construction serves all (docs/mathematics.md, section 4): the polygon with given angles that has an inscribed
 * circle. Everything is written with the curvature K as a number: sin_K^2 = s stands for sin^2 r, r^2 or sinh^2 r, and
 * cos_K r = sqrt(1 - K s). */
#include "tile.h"

#include <math.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

/* The angle at the centre between a corner of half angle `half` and the tangent points beside it: in the right
 * triangle centre, tangent point, corner, cos(half) = cos_K(r) sin(phi). */
static double angle_at_centre(int K, double s, double half) {
    return atan2(cos(half), sqrt(fmax(0, sin(half) * sin(half) - K * s)));
}

static double excess_at_centre(int K, double s, int32_t n, const double *half) {
    double sum = -pi;
    for (int32_t i = 0; i < n; i++)
        sum += angle_at_centre(K, s, half[i]);
    return sum;
}

/* s = sin_K^2 of the inscribed circle's radius, to the last digit, by bisection: the angles at the centre must add up
 * to a full turn; their sum is monotone in s. In the plane any s will do, and `images` polygons get unit area. */
static double inscribed_circle(int K, int32_t n, const double *half, int images) {
    if (K == 0) {
        double sum = 0; /* area of the polygon: r^2 sum of cot(half) */
        for (int32_t i = 0; i < n; i++)
            sum += 1 / tan(half[i]);
        return 1 / (images * sum);
    }
    double low = 0, high = 1;
    if (K > 0) {
        for (int32_t i = 0; i < n; i++) /* the circle must fit into every angle */
            high = fmin(high, sin(half[i]) * sin(half[i]));
    } else {
        while (excess_at_centre(K, high, n, half) > 0)
            high *= 2;
    }
    for (;;) {
        double middle = low + (high - low) / 2;
        if (!(middle > low && middle < high))
            return high;
        if (K * excess_at_centre(K, middle, n, half) < 0)
            low = middle;
        else
            high = middle;
    }
}

/* Corners counter-clockwise about the origin, the inscribed circle's centre, after the tangent point in direction
 * -pi / 2. `touch` [n]: the tangent points of the sides that start in the corners. Returns tan_K(r / 2). */
static double place_corners(const orb_geometry *geometry, int32_t n, const double *half, int images,
                            orb_point *corners, orb_point *touch) {
    int K = geometry_curvature(geometry);
    double s = inscribed_circle(K, n, half, images), cos_r = sqrt(1 - K * s), sin_r = sqrt(s);
    double half_r = sin_r / (1 + cos_r), direction = -pi / 2;
    for (int32_t i = 0; i < n; i++) {
        double phi = angle_at_centre(K, s, half[i]);
        double sin_tau = sin_r / cos_r / tan(half[i]), cos_tau = cos(phi) / sin(half[i]); /* tau: to tangent point */
        double radius = sin_tau / sin(phi) / (1 + cos_r * cos_tau); /* tan_K of half the corner's distance */
        if (half[i] == pi / 2) /* no corner at all, but a point of a straight side; phi is 0 */
            radius = half_r;
        direction += phi;
        corners[i] = point_of(radius * CMPLX(cos(direction), sin(direction)));
        direction += phi;
        touch[i] = point_of(half_r * CMPLX(cos(direction), sin(direction)));
    }
    return half_r;
}

/* The polygon with angles pi / n_i, moved so that its side c_k c_1 is on the real axis, its tangent point at the
 * origin, and doubled over that side. */
static void place_doubled(orb_tile *tile, double *half, orb_point *touch) {
    const orb_geometry *geometry = tile->geometry;
    int32_t k = tile->word->n_nodes, n = tile->word->n_sides;
    for (int32_t i = 0; i < k; i++)
        half[i] = pi / (2.0 * tile->word->order[i]);
    double half_r = place_corners(geometry, k, half, 2, tile->corners, touch);
    orb_isometry down = isometry_to_origin(geometry, point_of(CMPLX(0, -half_r)));
    for (int32_t i = 0; i < k; i++) {
        tile->corners[i] = isometry_apply(geometry, down, tile->corners[i]);
        touch[i] = isometry_apply(geometry, down, touch[i]);
    }
    tile->corners[0] = point_of(creal(tile->corners[0].z));
    tile->corners[k - 1] = point_of(creal(tile->corners[k - 1].z));
    for (int32_t i = k; i < n; i++)
        tile->corners[i] = point_conjugate(tile->corners[n - i]);
    for (int32_t i = k - 1; i < n; i++)
        touch[i] = point_conjugate(touch[n - 1 - i]);
}

/* The ends of a lune are antipodal and give no direction: there, `touch`, a point within the side, does. */
static void glue_sides(orb_tile *tile, const orb_point *touch) {
    const orb_geometry *geometry = tile->geometry;
    const orb_word *word = tile->word;
    for (int32_t s = 0; s < word->n_sides; s++) {
        int32_t partner = word->partner[s], next = word_next(word, s);
        orb_point p = tile->corners[s], q = tile->corners[next];
        orb_point p1 = tile->corners[word_glued_start(word, s)], q1 = tile->corners[word_glued_end(word, s)];
        tile->sides[s] = geometry_log(geometry, p, q);
        if (touch && geometry_is_antipodal(geometry, p, q)) {
            tile->sides[s] = 2 * geometry_log(geometry, p, touch[s]);
            q = touch[s];
            q1 = touch[partner];
        }
        tile->pairings[s] =
            (word->same_way[s] ? isometry_reflection : isometry_pairing)(geometry, p, q, p1, q1);
        tile->lines[s] = isometry_pairing(geometry, point_of(0), point_of(0.5), p, q);
    }
}

/* Walks round each node from its first corner, across one side after the other. */
static void find_elements(orb_tile *tile, int32_t *queue, bool *known) {
    const orb_word *word = tile->word;
    int32_t head = 0, tail = 0;
    for (int32_t n = 0; n < word->n_nodes; n++) {
        tile->elements[word->first[n]] = isometry_identity();
        known[word->first[n]] = true;
        queue[tail++] = word->first[n];
    }
    while (head < tail) {
        int32_t c = queue[head++], before = word_previous(word, c);
        const int32_t side[2] = {c, before}, to[2] = {word_glued_start(word, c), word_glued_end(word, before)};
        for (int k = 0; k < 2; k++) {
            if (word_is_mirror(word, side[k]) || known[to[k]])
                continue;
            tile->elements[to[k]] =
                isometry_compose(tile->geometry, tile->pairings[side[k]], tile->elements[c]);
            known[to[k]] = true;
            queue[tail++] = to[k];
        }
    }
}

static orb_status glue(orb_tile *tile, const orb_point *touch, orb_error *error) {
    size_t n = (size_t)tile->word->n_sides;
    int32_t *queue = malloc((n + 1) * sizeof *queue);
    bool *known = calloc(n + 1, sizeof *known);
    if (queue && known) {
        glue_sides(tile, touch);
        find_elements(tile, queue, known);
    }
    orb_status status = queue && known ? ORB_OK : error_memory(error);
    free(queue);
    free(known);
    return status;
}

static orb_status tile_allocate(const orb_word *word, int curvature, orb_tile **result, orb_error *error) {
    orb_tile *tile = calloc(1, sizeof *tile);
    *result = tile;
    if (!tile)
        return error_memory(error);
    size_t n = (size_t)word->n_sides + 1;
    tile->geometry = geometry_of_curvature(curvature);
    tile->corners = malloc(n * sizeof *tile->corners);
    tile->sides = malloc(n * sizeof *tile->sides);
    tile->pairings = malloc(n * sizeof *tile->pairings);
    tile->lines = malloc(n * sizeof *tile->lines);
    tile->elements = malloc(n * sizeof *tile->elements);
    if (!tile->corners || !tile->sides || !tile->pairings || !tile->lines || !tile->elements)
        return error_memory(error);
    return word_copy(word, &tile->word, error);
}

/* Gauss and Bonnet: the excess, or defect, of the angles over those of a flat polygon. */
static double area_of_angles(const orb_tile *tile) {
    int32_t n = tile->word->n_sides;
    double sum = -(n - 2) * pi;
    for (int32_t c = 0; c < n; c++)
        sum += tile_angle(tile, c);
    return fabs(sum);
}

double tile_angle(const orb_tile *tile, int32_t corner) {
    if (!tile->fixed)
        return word_angle(tile->word, corner);
    orb_point p = tile->corners[corner];
    double complex next = geometry_toward(tile->geometry, p, tile->corners[word_next(tile->word, corner)]);
    double complex last = geometry_toward(tile->geometry, p, tile->corners[word_previous(tile->word, corner)]);
    return carg(conj(next) * last);
}

orb_status tile_create(const orb_word *word, int curvature, orb_tile **result, orb_error *error) {
    *result = NULL;
    orb_tile *tile = NULL;
    size_t n = (size_t)word->n_sides + 1;
    orb_point *touch = malloc(n * sizeof *touch);
    double *half = calloc(n + (size_t)word->n_nodes, sizeof *half);
    orb_status status = touch && half ? tile_allocate(word, curvature, &tile, error) : error_memory(error);
    if (status != ORB_OK)
        goto done;
    if (word_is_path(word)) {
        place_doubled(tile, half, touch);
    } else {
        for (int32_t c = 0; c < word->n_sides; c++)
            half[c] = word_angle(word, c) / 2;
        place_corners(tile->geometry, word->n_sides, half, 1, tile->corners, touch);
    }
    tile->area = curvature == 0 ? 1 : area_of_angles(tile);
    status = glue(tile, touch, error);
    if (status != ORB_OK)
        goto done;
    *result = tile;
    tile = NULL;
    error_set(error, ORB_OK, "%s", "");
done:
    free(half);
    free(touch);
    tile_free(tile);
    return status;
}

orb_status tile_of_polygon(int curvature, int32_t n, const orb_point *corners, orb_tile **result, orb_error *error) {
    *result = NULL;
    orb_word *word = NULL;
    orb_tile *tile = NULL;
    orb_status status = word_create(n, n, &word, error);
    if (status != ORB_OK)
        return status;
    for (int32_t s = 0; s < n; s++) {
        word->node[s] = word->partner[s] = s;
        word->same_way[s] = true;
        word->order[s] = 1;
    }
    word_finish(word);
    status = tile_allocate(word, curvature, &tile, error);
    word_free(word);
    if (status != ORB_OK)
        goto done;
    tile->fixed = true;
    for (int32_t s = 0; s < n; s++)
        tile->corners[s] = corners[s];
    for (int32_t s = 1; s + 1 < n; s++)
        tile->area += geometry_triangle_area(tile->geometry, geometry_toward(tile->geometry, corners[0], corners[s]),
                                             geometry_toward(tile->geometry, corners[0], corners[s + 1]));
    status = glue(tile, NULL, error);
    if (status != ORB_OK)
        goto done;
    *result = tile;
    tile = NULL;
done:
    tile_free(tile);
    return status;
}

void tile_free(orb_tile *tile) {
    if (!tile)
        return;
    word_free(tile->word);
    free(tile->corners);
    free(tile->sides);
    free(tile->pairings);
    free(tile->lines);
    free(tile->elements);
    free(tile);
}
