/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cover.h"

#include <stdlib.h>
#include <string.h>

enum { PATIENT = 64 }; /* steps by the best edge; later ones by any, as walks through odd triangles may go round */

static const double touching = 1e-14; /* sine below which a point is on an edge */
/* What a point may be off by: a part of the triangle's longest edge, and a length, for cones have no more digits. */
static const double rounding = 1e-9, least_rounding = 1e-12;
static const double inner_part = 0.25; /* of the tile's inscribed circle */

/* --- elements ---------------------------------------------------------------------------------------------------- */

static uint32_t hash(int32_t element, int32_t kind, int32_t from, int32_t to) {
    uint64_t z = ((uint64_t)(uint32_t)element << 32 | (uint32_t)from) * 0x9e3779b97f4a7c15u;
    z ^= ((uint64_t)(uint32_t)to << 32 | (uint32_t)kind) * 0xbf58476d1ce4e5b9u;
    return (uint32_t)((z ^ (z >> 31)) * 0x94d049bb133111ebu >> 32);
}

/* Where the product is, or would be. */
static cover_product *product_slot(cover_product *products, int32_t room, cover_product key) {
    uint32_t at = hash(key.element, key.kind, key.from, key.to) % (uint32_t)room;
    while (products[at].element >= 0 && (products[at].element != key.element || products[at].kind != key.kind ||
                                         products[at].from != key.from || products[at].to != key.to))
        at = (at + 1) % (uint32_t)room;
    return &products[at];
}

static orb_status grow_products(orb_cover *cover, orb_error *error) {
    if (2 * cover->n_products < cover->room_products)
        return ORB_OK;
    const int32_t room = 4 * cover->room_products + 256;
    cover_product *products = malloc((size_t)room * sizeof *products);
    if (!products)
        return error_memory(error);
    for (int32_t k = 0; k < room; k++)
        products[k].element = -1;
    for (int32_t k = 0; k < cover->room_products; k++)
        if (cover->products[k].element >= 0)
            *product_slot(products, room, cover->products[k]) = cover->products[k];
    free(cover->products);
    cover->products = products;
    cover->room_products = room;
    return ORB_OK;
}

/* The number of an element that may be new. */
static orb_status find_element(orb_cover *cover, orb_isometry h, int32_t *number, orb_error *error) {
    const orb_point image = isometry_apply(cover->geometry, h, point_of(0));
    for (*number = 0; *number < cover->n_elements; ++*number)
        if (geometry_distance(cover->geometry, cover->images[*number], image) < cover->apart &&
            cover->elements[*number].reflects == h.reflects)
            return ORB_OK;
    if (cover->n_elements == cover->room_elements) {
        const size_t room = 2 * (size_t)cover->room_elements + 32;
        orb_isometry *elements = realloc(cover->elements, room * sizeof *elements);
        cover->elements = elements ? elements : cover->elements;
        orb_point *images = realloc(cover->images, room * sizeof *images);
        cover->images = images ? images : cover->images;
        if (!elements || !images)
            return error_memory(error);
        cover->room_elements = (int32_t)room;
    }
    cover->elements[cover->n_elements] = h;
    cover->images[cover->n_elements++] = image;
    return ORB_OK;
}

/* --- seams ------------------------------------------------------------------------------------------------------- */

typedef struct seam {
    int32_t copy[2], other[2]; /* of both ends on this side and on the other one */
    bool same_way;
} seam;

static seam seam_at(const orb_embedding *embedding, int32_t h) {
    const orb_mesh *mesh = embedding->mesh;
    const int32_t *copy = embedding->copies->triangles, g = mesh->twin[h];
    const bool same = halfedge_from(mesh, h) == halfedge_from(mesh, g);
    const int32_t start = same ? g : halfedge_next(g), end = same ? halfedge_next(g) : g;
    return (seam){{copy[h], copy[halfedge_next(h)]}, {copy[start], copy[end]}, same};
}

/* The element that takes this side's layout to that of the other side; its key is known. */
static orb_isometry seam_element(const orb_embedding *embedding, seam s, int32_t end) {
    const orb_copies *copies = embedding->copies;
    const orb_geometry *geometry = embedding->tile->geometry;
    const orb_point *placed = embedding->placed;
    if (end < 0) /* an edge between two cones, which is long */
        return (s.same_way ? isometry_reflection : isometry_pairing)(geometry, placed[s.copy[0]], placed[s.copy[1]],
                                                                     placed[s.other[0]], placed[s.other[1]]);
    const orb_isometry here = copies->isometries[copies->isometry[s.copy[end]]];
    const orb_isometry there = copies->isometries[copies->isometry[s.other[end]]];
    return isometry_compose(geometry, there, isometry_inverse(here));
}

/* Across half-edge h of source (0) or target (1): *element after it. */
static orb_status cross(orb_cover *cover, int which, int32_t h, int32_t *element, orb_error *error) {
    const orb_embedding *embedding = which ? cover->target : cover->source;
    const seam s = seam_at(embedding, h);
    if (s.copy[0] == s.other[0] && s.copy[1] == s.other[1])
        return ORB_OK;
    const int32_t *vertex = embedding->copies->vertex, *isometry = embedding->copies->isometry;
    const int32_t end = !cover->cone[which][vertex[s.copy[0]]] ? 0 : !cover->cone[which][vertex[s.copy[1]]] ? 1 : -1;
    cover_product key = {*element, which, end < 0 ? -1 - h : isometry[s.copy[end]],
                         end < 0 ? 0 : isometry[s.other[end]], 0};
    orb_status status = grow_products(cover, error);
    if (status != ORB_OK)
        return status;
    cover_product *known = product_slot(cover->products, cover->room_products, key);
    if (known->element < 0) {
        const orb_isometry step = seam_element(embedding, s, end);
        const orb_isometry before = cover->elements[*element];
        const orb_isometry product =
            which ? isometry_compose(cover->geometry, step, before)
                  : isometry_compose(cover->geometry, before, isometry_inverse(tile_map_element(&cover->map, step)));
        status = find_element(cover, product, &key.product, error);
        if (status != ORB_OK)
            return status;
        *known = key;
        cover->n_products++;
    }
    *element = known->product;
    return ORB_OK;
}

orb_status cover_cross_source(orb_cover *cover, int32_t h, int32_t *element, orb_error *error) {
    return cross(cover, 0, h, element, error);
}

orb_status cover_cross_target(orb_cover *cover, int32_t h, orb_sheet *sheet, orb_error *error) {
    sheet->triangle = cover->target->mesh->twin[h] / 3;
    return cross(cover, 1, h, &sheet->element, error);
}

/* --- walking ----------------------------------------------------------------------------------------------------- */

/* A point in a triangle of the target. */
typedef struct sight {
    orb_point p, corner[3];
    double weight[3], sine[3];
} sight;

static void look(const orb_cover *cover, orb_point p, orb_sheet sheet, sight *s) {
    const int32_t *copy = cover->target->copies->triangles + 3 * (size_t)sheet.triangle;
    s->p = sheet.element == 0 ? p : isometry_apply(cover->geometry, cover->elements[sheet.element], p);
    for (int c = 0; c < 3; c++)
        s->corner[c] = cover->target->placed[copy[c]];
    geometry_locate(cover->geometry, s->p, s->corner, s->weight, s->sine);
}

/* How far the point is from the edge that faces corner c. */
static double distance_from(const orb_cover *cover, const sight *s, int c) {
    const orb_point *p = &s->corner[(c + 1) % 3], *q = &s->corner[(c + 2) % 3];
    const double complex along = geometry_toward(cover->geometry, *p, *q),
                         to = geometry_toward(cover->geometry, *p, s->p);
    const double length = modulus(along);
    return length > 0 ? 2 * fabs(cimag(conj(along) * to)) / length : 2 * modulus(to);
}

static double tolerance(const orb_cover *cover, const sight *s) {
    double longest = 0;
    for (int c = 0; c < 3; c++)
        longest = fmax(longest, geometry_distance(cover->geometry, s->corner[c], s->corner[(c + 1) % 3]));
    return fmin(1, longest) * rounding + least_rounding;
}

/* The point goes onto the triangle: weights below zero become zero. */
static void settle(sight *s, orb_sheet sheet, orb_spot *spot) {
    double total = 0;
    for (int c = 0; c < 3; c++)
        total += spot->weight[c] = s->weight[c] > 0 && s->sine[c] > 0 ? s->weight[c] : 0;
    if (!(total > 0)) /* at a corner: the weights of all others vanish */
        for (int c = 0; c < 3; c++)
            total += spot->weight[c] = fmax(0, s->weight[c]);
    for (int c = 0; c < 3; c++)
        spot->weight[c] /= total;
    spot->sheet = sheet;
}

/* A point of the source's boundary onto the target's: the edge of this triangle that it is on, or the corner. */
static bool settle_on_boundary(const orb_cover *cover, orb_spot *spot, const sight *s) {
    const orb_mesh *mesh = cover->target->mesh;
    const int32_t first = 3 * spot->sheet.triangle;
    int best = -1, corner = 0;
    for (int c = 0; c < 3; c++) {
        corner = spot->weight[c] > spot->weight[corner] ? c : corner;
        if (mesh->twin[first + (c + 1) % 3] < 0 &&
            (best < 0 || distance_from(cover, s, c) < distance_from(cover, s, best)))
            best = c;
    }
    if (best >= 0 && distance_from(cover, s, best) < tolerance(cover, s)) {
        const double rest = 1 - spot->weight[best];
        spot->weight[best] = 0;
        for (int c = 0; c < 3; c++)
            spot->weight[c] /= rest;
        return rest > 0;
    }
    if (!cover->border[1][mesh->triangles[first + corner]] ||
        !(geometry_distance(cover->geometry, s->p, s->corner[corner]) < tolerance(cover, s)))
        return false;
    for (int c = 0; c < 3; c++)
        spot->weight[c] = c == corner;
    return true;
}

/* The edge to leave by, as the corner that it faces; -1: none, the point is here; -2: only beyond a mirror. */
static int way_out(const orb_mesh *mesh, const sight *s, orb_sheet sheet, int64_t step) {
    int best = -1;
    bool beyond = false;
    for (int k = 0; k < 3; k++) {
        const int c = step > PATIENT ? (int)((k + (step * 2654435761u >> 7)) % 3) : k;
        if (s->sine[c] >= -touching)
            continue;
        if (mesh->twin[3 * sheet.triangle + (c + 1) % 3] < 0) {
            beyond = true;
        } else if (best < 0 || (step <= PATIENT && s->sine[c] < s->sine[best])) {
            best = c;
        }
    }
    return best >= 0 ? best : beyond ? -2 : -1;
}

/* Whether the point is in the triangle but for rounding. */
static bool nearly_inside(const orb_cover *cover, const sight *s) {
    const double most = tolerance(cover, s);
    for (int c = 0; c < 3; c++)
        if (!(s->sine[c] >= -touching) && !(distance_from(cover, s, c) < most)) /* also of what is no number */
            return false;
    return true;
}

orb_status cover_walk(orb_cover *cover, orb_point p, bool boundary, orb_spot *spot, bool *found, orb_error *error) {
    const orb_mesh *mesh = cover->target->mesh;
    const int64_t most = 4 * (int64_t)mesh->n_triangles + 1000;
    orb_sheet sheet = spot->sheet;
    sight s;
    *found = false;
    for (int64_t step = 0; step < most; step++, cover->steps++) {
        look(cover, p, sheet, &s);
        const int out = way_out(mesh, &s, sheet, step);
        if (out < 0 || (step > PATIENT && nearly_inside(cover, &s))) {
            *found = nearly_inside(cover, &s);
            break;
        }
        const int32_t h = 3 * sheet.triangle + (out + 1) % 3;
        orb_status status = cover_cross_target(cover, h, &sheet, error);
        if (status != ORB_OK)
            return status;
    }
    if (!*found)
        return ORB_OK;
    settle(&s, sheet, spot);
    if (boundary)
        *found = settle_on_boundary(cover, spot, &s);
    return ORB_OK;
}

/* --- set up ------------------------------------------------------------------------------------------------------ */

/* A part of the radius of a disk about the origin that lies in the tile: y is sin_K of the distance from the x axis. */
static double inner_radius(const orb_tile *tile) {
    double least = 1;
    for (int32_t s = 0; s < tile->word->n_sides; s++) {
        double value[3], low[3];
        const orb_isometry home = isometry_inverse(tile->lines[s]);
        geometry_coordinates(tile->geometry, isometry_apply(tile->geometry, home, point_of(0)), value, low);
        least = fmin(least, fabs(value[1]));
    }
    return inner_part * least;
}

static bool list_vertices(const orb_embedding *embedding, bool **cone, bool **border) {
    const size_t n = (size_t)embedding->mesh->n_vertices + 1;
    *cone = calloc(n, sizeof **cone);
    *border = calloc(n, sizeof **border);
    if (!*cone || !*border)
        return false;
    mesh_find_boundary(embedding->mesh, *border);
    for (int32_t k = 0; k < embedding->surface->n_marks; k++)
        (*cone)[embedding->surface->vertex[k]] = !embedding->surface->mirror[k];
    return true;
}

orb_status cover_create(const orb_embedding *source, const orb_embedding *target, orb_cover *cover, orb_error *error) {
    *cover = (orb_cover){.source = source, .target = target, .geometry = target->tile->geometry};
    orb_status status = tile_map_find(source, target, &cover->map, error);
    if (status != ORB_OK)
        return status;
    const int32_t n = source->copies->n_copies;
    cover->apart = inner_radius(target->tile);
    cover->placed = malloc(((size_t)n + 1) * sizeof *cover->placed);
    if (!list_vertices(source, &cover->cone[0], &cover->border[0]) ||
        !list_vertices(target, &cover->cone[1], &cover->border[1]) || !cover->placed)
        return error_memory(error);
    for (int32_t u = 0; u < n; u++)
        cover->placed[u] = tile_map_point(&cover->map, source->placed[u]);
    int32_t identity;
    return find_element(cover, isometry_identity(), &identity, error);
}

void cover_clear(orb_cover *cover) {
    free(cover->elements);
    free(cover->images);
    free(cover->products);
    for (int which = 0; which < 2; which++) {
        free(cover->cone[which]);
        free(cover->border[which]);
    }
    free(cover->placed);
    *cover = (orb_cover){0};
}
