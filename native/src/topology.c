/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "topology.h"

#include <stdio.h>

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
                              name, (int)n_mirrors, n_mirrors == 1 ? "mirror" : "mirrors", (int)mesh->n_boundary_loops,
                              (long long)open.found, (int)open.elements[0], (int)open.elements[1]);
}

orb_status topology_require_mirrors(const orb_mesh *mesh, const orb_signature *signature, orb_holes holes,
                                    orb_error *error) {
    int32_t n_mirrors = topology_mirrors(signature), extra = mesh->n_boundary_loops - n_mirrors;
    if (extra == 0 || (extra > 0 && holes != ORB_HOLES_REFUSE))
        return ORB_OK;
    return error_open(mesh, n_mirrors, signature ? signature->text : "a polygon", error);
}

static void say_genus(bool orientable, int32_t genus, char *out, size_t room) {
    if (orientable && genus == 0)
        snprintf(out, room, "no handle");
    else if (orientable)
        snprintf(out, room, "%d %s", (int)genus, genus == 1 ? "handle or tunnel" : "handles or tunnels");
    else
        snprintf(out, room, "one side only, as with %d %s", (int)genus, genus == 1 ? "cross-cap" : "cross-caps");
}

orb_status topology_require_genus(const orb_mesh *mesh, const orb_signature *s, orb_error *error) {
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
