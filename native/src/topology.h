/* Is the mesh the surface that a signature is of? SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef ORB_TOPOLOGY_H
#define ORB_TOPOLOGY_H

#include "mesh.h"
#include "signature.h"

/* As many boundary loops as mirrors, or more where those are wanted for holes; a NULL signature is a disk. Error:
 * ORB_BOUNDARY, naming boundary edges. */
orb_status topology_require_mirrors(const orb_mesh *mesh, const orb_signature *signature, orb_holes holes,
                                    orb_error *error);

/* As many handles or cross-caps; else ORB_WRONG_GENUS. */
orb_status topology_require_genus(const orb_mesh *mesh, const orb_signature *signature, orb_error *error);

static inline int32_t topology_mirrors(const orb_signature *signature) { return signature ? signature->n_mirrors : 1; }

#endif
