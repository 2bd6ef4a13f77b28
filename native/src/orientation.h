/* Do neighbouring triangles face the same way? SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Gives mesh_orient (mesh.h), too. */
#ifndef ORB_ORIENTATION_H
#define ORB_ORIENTATION_H

#include "mesh.h"

/* Sets mesh->orientable of a mesh whose half-edges are linked. Neighbours that face opposite ways are an error where
 * the surface has two sides: ORB_INCONSISTENT_ORIENTATION. */
orb_status orientation_check(orb_mesh *mesh, orb_error *error);

#endif
