/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "surface.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "boundary.h"
#include "picks.h"
#include "refine.h"

/* --- is the mesh the signature's surface? ---------------------------------------------------------------------- */

static orb_status error_open(const orb_mesh *mesh, int32_t n_mirrors, const char *name, orb_error *error) {
    orb_found open = {0};
    for (int32_t e = 0; e < mesh->n_edges; e++) {
        const int32_t h = mesh->edge_halfedge[e];
        if (mesh->twin[h] < 0)
            found_add_edge(&open, halfedge_from(mesh, h), halfedge_to(mesh, h));
    }
    if (mesh->n_boundary_loops < n_mirrors)
        return error_set_elements(error, ORB_BOUNDARY, ORB_EDGE, open.elements, open.entries, open.found,
                                  "%s has %d %s but the mesh has %d boundary %s: open it, or take a signature with "
                                  "fewer *",
                                  name, (int)n_mirrors, n_mirrors == 1 ? "mirror" : "mirrors",
                                  (int)mesh->n_boundary_loops, mesh->n_boundary_loops == 1 ? "loop" : "loops");
    if (n_mirrors == 0)
        return error_set_elements(error, ORB_BOUNDARY, ORB_EDGE, open.elements, open.entries, open.found,
                                  "the mesh is open: %d %s with %lld edges in all, first %d-%d: close them "
                                  "(Mesh > Clean Up > Fill Holes, or select a hole's edges and press Alt+F), have "
                                  "them filled for the computation, or take a signature with a * for each",
                                  (int)mesh->n_boundary_loops, mesh->n_boundary_loops == 1 ? "hole" : "holes",
                                  (long long)open.found, (int)open.elements[0], (int)open.elements[1]);
    return error_set_elements(error, ORB_BOUNDARY, ORB_EDGE, open.elements, open.entries, open.found,
                              "%s has %d %s but the mesh has %d boundary loops with %lld edges in all, first %d-%d: "
                              "close the others, or have them filled for the computation or made mirrors",
                              name, (int)n_mirrors, n_mirrors == 1 ? "mirror" : "mirrors",
                              (int)mesh->n_boundary_loops, (long long)open.found, (int)open.elements[0],
                              (int)open.elements[1]);
}

static void say_genus(bool orientable, int32_t genus, char *out, size_t room) {
    if (orientable && genus == 0)
        snprintf(out, room, "no handle");
    else if (orientable)
        snprintf(out, room, "%d %s", (int)genus, genus == 1 ? "handle or tunnel" : "handles or tunnels");
    else
        snprintf(out, room, "one side only, as with %d %s", (int)genus, genus == 1 ? "cross-cap" : "cross-caps");
}

/* `s` may be NULL: a disk. */
static orb_status require_genus(const orb_mesh *mesh, const orb_signature *s, orb_error *error) {
    int32_t handles = s ? s->n_handles : 0, crosscaps = s ? s->n_crosscaps : 0;
    bool orientable = crosscaps == 0;
    int32_t genus = orientable ? handles : crosscaps + 2 * handles;
    if (mesh->orientable == orientable && mesh->genus == genus)
        return ORB_OK;
    char wanted[64], found[64];
    say_genus(orientable, genus, wanted, sizeof wanted);
    say_genus(mesh->orientable, mesh->genus, found, sizeof found);
    return error_set(error, ORB_WRONG_GENUS,
                     "%s needs a surface with %s, but the mesh has %s (Euler characteristic %d): take a signature with "
                     "as many o or x, or remesh it",
                     s ? s->text : "a polygon", wanted, found, (int)mesh->euler);
}

/* --- which boundary loops are mirrors, which are holes ----------------------------------------------------------- */

typedef struct loop_rank {
    int32_t loop, picks;
    double length;
} loop_rank;

static int mirrors_first(const void *a, const void *b) {
    const loop_rank *x = a, *y = b;
    if ((x->picks > 0) != (y->picks > 0))
        return x->picks > 0 ? -1 : 1;
    if (x->length != y->length)
        return x->length > y->length ? -1 : 1;
    return x->loop - y->loop;
}

/* closed[n_loops]: those that are left when the loops with picks, then the longest ones, have become mirrors. */
static orb_status choose_holes(const orb_mesh *mesh, const orb_boundary *boundary, int32_t n_mirrors,
                               const orb_request *request, bool *closed, orb_error *error) {
    loop_rank *rank = malloc(((size_t)boundary->n_loops + 1) * sizeof *rank);
    if (!rank)
        return error_memory(error);
    for (int32_t l = 0; l < boundary->n_loops; l++)
        rank[l] = (loop_rank){l, 0, boundary_length(mesh, boundary, l)};
    for (int32_t i = 0; i < request->n_cones; i++) {
        int32_t loop = boundary_loop_of(boundary, request->cones[i]);
        if (loop >= 0)
            rank[loop].picks++;
    }
    qsort(rank, (size_t)boundary->n_loops, sizeof *rank, mirrors_first);
    for (int32_t l = 0; l < boundary->n_loops; l++)
        closed[rank[l].loop] = l >= n_mirrors;
    free(rank);
    return ORB_OK;
}

/* Sets surface->plain; takes the input over. */
static orb_status close_holes(orb_surface *surface, orb_mesh *input, const orb_boundary *boundary, const bool *closed,
                              orb_error *error) {
    for (int32_t l = 0; l < boundary->n_loops; l++)
        surface->n_closed += closed[l];
    surface->plain = input;
    if (surface->n_closed == 0)
        return ORB_OK;
    orb_status status = boundary_close(input, boundary, closed, &surface->plain, error);
    mesh_free(input);
    return status;
}

/* --- chords ------------------------------------------------------------------------------------------------------ */

/* side[2 * place]: the mirror sides before and after each boundary vertex; the same but at corners. */
static void number_sides(const orb_surface *surface, const orb_boundary *boundary, bool *corner, int32_t *side) {
    int32_t sides = 0;
    for (int32_t k = 0; k < surface->n_marks; k++)
        if (surface->mirror[k])
            corner[surface->vertex[k]] = true;
    for (int32_t l = 0; l < boundary->n_loops; l++) {
        int32_t begin = boundary->start[l], n = boundary->start[l + 1] - begin, first = 0;
        while (first < n && !corner[boundary->vertex[begin + first]])
            first++;
        for (int32_t i = 0; i < n; i++) { /* from a corner once round */
            int32_t place = begin + (first + i) % n;
            bool is_corner = corner[boundary->vertex[place]];
            side[2 * place] = sides;
            sides += is_corner && i > 0;
            side[2 * place + 1] = sides;
        }
        if (first < n)
            side[2 * (begin + first % n)] = sides;
        sides++;
    }
}

static bool is_chord(const orb_mesh *mesh, const orb_boundary *boundary, const int32_t *side, int32_t edge) {
    int32_t h = mesh->edge_halfedge[edge];
    int32_t a = boundary->place[halfedge_from(mesh, h)], b = boundary->place[halfedge_to(mesh, h)];
    if (mesh->twin[h] < 0 || a < 0 || b < 0)
        return false;
    return side[2 * a] == side[2 * b] || side[2 * a] == side[2 * b + 1] || side[2 * a + 1] == side[2 * b] ||
           side[2 * a + 1] == side[2 * b + 1];
}

/* marked[n_edges] */
static orb_status mark_chords(orb_surface *surface, const uint8_t *halve, uint8_t *marked, orb_error *error) {
    const orb_mesh *mesh = surface->plain;
    orb_boundary *boundary = NULL;
    orb_status status = boundary_list(mesh, &boundary, error);
    if (status != ORB_OK)
        return status;
    bool *corner = calloc((size_t)mesh->n_vertices + 1, sizeof *corner);
    int32_t *side = malloc((2 * (size_t)boundary->start[boundary->n_loops] + 1) * sizeof *side);
    if (corner && side) {
        number_sides(surface, boundary, corner, side);
        for (int32_t e = 0; e < mesh->n_edges; e++) {
            marked[e] = (!halve || halve[e]) && is_chord(mesh, boundary, side, e);
            surface->n_halved += marked[e];
        }
    } else {
        status = error_memory(error);
    }
    free(corner);
    free(side);
    boundary_free(boundary);
    return status;
}

static orb_status halve_chords(orb_surface *surface, const uint8_t *halve, orb_error *error) {
    surface->mesh = surface->plain;
    if (surface->plain->n_boundary_loops == 0)
        return ORB_OK;
    uint8_t *marked = malloc((size_t)surface->plain->n_edges + 1);
    orb_status status = marked ? mark_chords(surface, halve, marked, error) : error_memory(error);
    if (status != ORB_OK || surface->n_halved == 0)
        goto done;
    surface->halved = malloc((size_t)surface->n_halved * sizeof *surface->halved);
    if (!surface->halved) {
        status = error_memory(error);
        goto done;
    }
    for (int32_t e = 0, k = 0; e < surface->plain->n_edges; e++)
        if (marked[e])
            surface->halved[k++] = e;
    surface->mesh = NULL;
    status = refine_edges(surface->plain, marked, &surface->mesh, &surface->parent, error);
done:
    free(marked);
    return status;
}

/* --- a fixed boundary -------------------------------------------------------------------------------------------- */

/* `count` vertices of the loop at equal distances along it. */
static orb_status spread_corners(const orb_mesh *mesh, const orb_boundary *boundary, int32_t loop, int32_t count,
                                 int32_t *vertex, orb_error *error) {
    int32_t begin = boundary->start[loop], n = boundary->start[loop + 1] - begin, chosen = 0;
    if (n < count)
        return error_set(error, ORB_CONE_COUNT, "the polygon has %d corners but the boundary only %d vertices",
                         (int)count, (int)n);
    double along = 0, total = boundary_length(mesh, boundary, loop);
    for (int32_t i = 0; i < n && chosen < count; i++) { /* not so late that too few vertices are left */
        if (!(along < total * chosen / count) || n - i == count - chosen)
            vertex[chosen++] = boundary->vertex[begin + i];
        along += mesh_edge_length(mesh, boundary->halfedge[begin + i]);
    }
    return ORB_OK;
}

typedef struct placed_pick {
    int32_t place, vertex;
} placed_pick;

static int by_place(const void *a, const void *b) {
    return ((const placed_pick *)a)->place - ((const placed_pick *)b)->place;
}

/* The picks in the sequence of the boundary, from the first one on. */
static orb_status sort_corners(const orb_boundary *boundary, int32_t loop, int32_t n, const int32_t *picks,
                               int32_t *vertex, orb_error *error) {
    placed_pick *sorted = malloc(((size_t)n + 1) * sizeof *sorted);
    int32_t first = 0;
    if (!sorted)
        return error_memory(error);
    for (int32_t i = 0; i < n; i++) {
        sorted[i] = (placed_pick){boundary->place[picks[i]], picks[i]};
        if (boundary_loop_of(boundary, picks[i]) != loop) {
            free(sorted);
            return error_set_elements(error, ORB_BAD_CONE, ORB_VERTEX, &picks[i], 1, 1,
                                      "vertex %d is not on the boundary that goes to the polygon: pick corners there",
                                      (int)picks[i]);
        }
    }
    qsort(sorted, (size_t)n, sizeof *sorted, by_place);
    while (sorted[first].vertex != picks[0])
        first++;
    for (int32_t i = 0; i < n; i++)
        vertex[i] = sorted[(first + i) % n].vertex;
    free(sorted);
    return ORB_OK;
}

static orb_status find_polygon_corners(orb_surface *surface, const orb_mesh *mesh, const orb_boundary *boundary,
                                       const bool *closed, const orb_request *request, orb_error *error) {
    int32_t loop = 0, n = surface->n_marks;
    while (closed[loop])
        loop++;
    for (int32_t i = 0; i < n; i++) {
        surface->order[i] = 1;
        surface->mirror[i] = true;
    }
    if (request->n_cones == 0)
        return spread_corners(mesh, boundary, loop, n, surface->vertex, error);
    if (request->n_cones != n)
        return error_set(error, ORB_CONE_COUNT, "the polygon has %d corners but %d vertices were picked", (int)n,
                         (int)request->n_cones);
    return sort_corners(boundary, loop, n, request->cones, surface->vertex, error);
}

/* ----------------------------------------------------------------------------------------------------------------- */

static orb_status allocate_marks(orb_surface *surface, const orb_request *request, orb_error *error) {
    surface->n_marks = request->polygon ? request->polygon->n_corners : request->n_cones;
    size_t n = (size_t)surface->n_marks + 1;
    surface->vertex = malloc(n * sizeof *surface->vertex);
    surface->order = malloc(n * sizeof *surface->order);
    surface->mirror = malloc(n * sizeof *surface->mirror);
    if (!surface->vertex || !surface->order || !surface->mirror)
        return error_memory(error);
    if (!request->polygon && request->n_cones > 0)
        memcpy(surface->vertex, request->cones, (size_t)request->n_cones * sizeof *surface->vertex);
    return ORB_OK;
}

/* Holes, mirrors, cones and corners of the input; sets surface->plain. */
static orb_status find_features(orb_surface *surface, orb_mesh **input, const orb_request *request, orb_error *error) {
    orb_boundary *boundary = NULL;
    orb_mesh *mesh = *input;
    bool *closed = NULL;
    int32_t n_mirrors = surface->signature ? surface->signature->n_mirrors : 1;
    const char *name = surface->signature ? surface->signature->text : "a polygon";
    int32_t extra = mesh->n_boundary_loops - n_mirrors;
    if (extra < 0 || (extra > 0 && request->holes == ORB_HOLES_REFUSE))
        return error_open(mesh, n_mirrors, name, error);
    orb_status status = ORB_OK;
    if (extra > 0 && request->holes == ORB_HOLES_MIRROR && surface->signature) {
        orb_signature *more = NULL;
        status = signature_with_mirrors(surface->signature, extra, &more, error);
        if (status != ORB_OK)
            return status;
        signature_free(surface->signature);
        surface->signature = more;
        n_mirrors += extra;
    }
    status = require_genus(mesh, surface->signature, error);
    if (status == ORB_OK)
        status = picks_check(mesh, request->n_cones, request->cones, error);
    if (status == ORB_OK)
        status = boundary_list(mesh, &boundary, error);
    if (status != ORB_OK)
        goto done;
    closed = calloc((size_t)boundary->n_loops + 1, sizeof *closed);
    status = closed ? choose_holes(mesh, boundary, n_mirrors, request, closed, error) : error_memory(error);
    if (status != ORB_OK)
        goto done;
    if (surface->signature)
        status = picks_match(surface->signature, boundary, closed, surface->n_marks, surface->vertex, request->orders,
                             surface->order, surface->mirror, error);
    else
        status = find_polygon_corners(surface, mesh, boundary, closed, request, error);
    if (status != ORB_OK)
        goto done;
    *input = NULL;
    status = close_holes(surface, mesh, boundary, closed, error);
done:
    free(closed);
    boundary_free(boundary);
    return status;
}

static orb_status read_request(orb_surface *surface, const orb_request *request, orb_error *error) {
    if (request->polygon && request->polygon->n_corners < 3)
        return error_set(error, ORB_BAD_ARGUMENT, "a polygon has three corners at least, here are %d",
                         (int)request->polygon->n_corners);
    if (request->holes < ORB_HOLES_REFUSE || request->holes > ORB_HOLES_MIRROR)
        return error_set(error, ORB_BAD_ARGUMENT, "what to do with holes is %d: choose refuse, fill or mirror",
                         (int)request->holes);
    orb_status status =
        request->polygon ? ORB_OK : signature_parse(request->signature, &surface->signature, error);
    if (status == ORB_OK && surface->signature && !signature_is_supported(surface->signature))
        status = signature_refuse(surface->signature, error);
    const orb_signature *s = surface->signature;
    if (status == ORB_OK && s && s->n_cones + s->n_corners != request->n_cones)
        return error_set(error, ORB_CONE_COUNT, "%s has %d %s but %d vertices were picked", s->text,
                         (int)(s->n_cones + s->n_corners), s->n_corners ? "cones and corners" : "cones",
                         (int)request->n_cones);
    return status;
}

static orb_status describe(orb_surface *surface, const orb_mesh *mesh, orb_error *error) {
    size_t bytes = 3 * (size_t)mesh->n_triangles * sizeof *surface->input_triangles;
    surface->n_input_vertices = mesh->n_vertices;
    surface->n_input_triangles = mesh->n_triangles;
    surface->input_triangles = malloc(bytes);
    if (!surface->input_triangles)
        return error_memory(error);
    memcpy(surface->input_triangles, mesh->triangles, bytes);
    surface->about = (orb_report){.vertices = mesh->n_vertices,
                                  .triangles = mesh->n_triangles,
                                  .components = mesh->n_components,
                                  .euler = mesh->euler,
                                  .boundary_loops = mesh->n_boundary_loops,
                                  .genus = mesh->genus,
                                  .orientable = mesh->orientable};
    return ORB_OK;
}

orb_status surface_create(const orb_mesh_arrays *arrays, const orb_request *request, const uint8_t *halve,
                          orb_surface **result, orb_error *error) {
    *result = NULL;
    orb_mesh *input = NULL;
    orb_surface *surface = calloc(1, sizeof *surface);
    orb_status status = surface ? read_request(surface, request, error) : error_memory(error);
    if (status == ORB_OK)
        status = mesh_create(arrays, &input, error);
    if (status == ORB_OK)
        status = mesh_require_connected(input, error);
    if (status == ORB_OK)
        status = describe(surface, input, error);
    if (status == ORB_OK)
        status = allocate_marks(surface, request, error);
    if (status == ORB_OK)
        status = find_features(surface, &input, request, error);
    if (status == ORB_OK)
        status = halve_chords(surface, halve, error);
    mesh_free(input);
    if (status != ORB_OK) {
        surface_free(surface);
        return status;
    }
    surface->about.filled_holes = surface->n_closed;
    surface->about.refined_edges = surface->n_halved;
    *result = surface;
    return ORB_OK;
}

void surface_free(orb_surface *surface) {
    if (!surface)
        return;
    signature_free(surface->signature);
    if (surface->mesh != surface->plain)
        mesh_free(surface->mesh);
    mesh_free(surface->plain);
    free(surface->parent);
    free(surface->halved);
    free(surface->input_triangles);
    free(surface->vertex);
    free(surface->order);
    free(surface->mirror);
    free(surface);
}
