/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "options.h"

#include <stdlib.h>

#include "farthest.h"

/* Up to `count` free sites of a kind, appended to the list. */
static orb_status sample(const orb_ground *ground, int32_t kind, int32_t n_fixed, const int32_t *fixed, int32_t count,
                         orb_options *options, orb_error *error) {
    const orb_mesh *mesh = ground->mesh;
    orb_site site;
    int32_t n_found = 0;
    bool *eligible = calloc((size_t)mesh->n_vertices + 1, sizeof *eligible);
    int32_t *found = malloc(((size_t)count + 1) * sizeof *found);
    orb_option *list = realloc(options->list, (size_t)(options->n + count + 1) * sizeof *list);
    orb_status status = error_memory(error);
    if (list)
        options->list = list;
    if (!eligible || !found || !list)
        goto done;
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        eligible[v] = !ground->fixed[v] && ground_place(ground, kind, v, &site);
    status = farthest_points(mesh, eligible, ground->reflection ? ground->reflection->image : NULL, n_fixed, fixed,
                             count, found, &n_found, error);
    for (int32_t k = 0; k < n_found && status == ORB_OK; k++)
        if (ground_place(ground, kind, found[k], &site))
            options->list[options->n++] = (orb_option){site, kind, false, 0, ground_penalty(ground, &site)};
done:
    free(eligible);
    free(found);
    return status;
}

/* The fixed vertices as sites; one of a pair takes the other with it. */
static orb_status list_fixed(const orb_ground *ground, int32_t n_fixed, const int32_t *fixed, orb_options *options,
                             orb_error *error) {
    options->list = malloc(((size_t)n_fixed + 1) * sizeof *options->list);
    if (!options->list)
        return error_memory(error);
    for (int32_t k = 0; k < n_fixed; k++) {
        orb_site site = {0};
        const int32_t loop = boundary_loop_of(ground->boundary, fixed[k]);
        for (int pair = 0; pair < 2; pair++)
            if (ground_place(ground, ground_kind(loop, pair), fixed[k], &site) &&
                (!pair || fixed[k] == site.vertex[0]) && (!pair || site.vertex[0] < site.vertex[1]))
                options->list[options->n++] = (orb_option){site, ground_kind(loop, pair), true, 0, 0};
    }
    options->n_fixed = options->n;
    return ORB_OK;
}

static orb_status fill_form(orb_columns *columns, orb_options *options, orb_error *error) {
    const size_t n = (size_t)options->n;
    int32_t *vertex = malloc((2 * n + 1) * sizeof *vertex), n_vertices = 0;
    options->form = calloc(n * n + 1, sizeof *options->form);
    orb_status status = vertex && options->form ? ORB_OK : error_memory(error);
    for (size_t i = 0; i < n && status == ORB_OK; i++)
        for (int32_t a = 0; a < options->list[i].site.n; a++)
            vertex[n_vertices++] = options->list[i].site.vertex[a];
    if (status == ORB_OK)
        status = columns_require(columns, n_vertices, vertex, "candidates", 0.1, 0.4, error);
    for (size_t i = 0; i < n && status == ORB_OK; i++) {
        orb_option *option = options->list + i;
        for (int32_t a = 0; a < option->site.n; a++) {
            const double *column = columns->of[option->site.vertex[a]];
            option->linear += columns->spread->pull[option->site.vertex[a]];
            for (size_t j = 0; j < n; j++)
                for (int32_t b = 0; b < options->list[j].site.n; b++)
                    options->form[i * n + j] += column[options->list[j].site.vertex[b]];
        }
    }
    free(vertex);
    return status;
}

orb_status options_create(const orb_ground *ground, orb_columns *columns, int32_t n_fixed, const int32_t *fixed,
                          const int32_t *count, orb_options **result, orb_error *error) {
    orb_options *options = *result = calloc(1, sizeof *options);
    if (!options)
        return error_memory(error);
    options->n_kinds = 2 * (ground->boundary->n_loops + 1);
    options->first = malloc(((size_t)options->n_kinds + 1) * sizeof *options->first);
    if (!options->first)
        return error_memory(error);
    orb_status status = list_fixed(ground, n_fixed, fixed, options, error);
    for (int32_t kind = 0; kind < options->n_kinds && status == ORB_OK; kind++) {
        options->first[kind] = options->n;
        if (count[kind] > 0)
            status = sample(ground, kind, n_fixed, fixed, count[kind], options, error);
    }
    options->first[options->n_kinds] = options->n;
    return status == ORB_OK ? fill_form(columns, options, error) : status;
}

void options_free(orb_options *options) {
    if (!options)
        return;
    free(options->list);
    free(options->form);
    free(options->first);
    free(options);
}
