/* Which nodes follow, and whom. */
#pragma once
#include "method/extend/extend.h"

/* Collective. ways of the extension, on all copies, from its fill. What points see may still be too far apart. */
PetscErrorCode ChooseWays(const Discretisation *space, Extension *extension);
/* The same among these nodes: n that may follow, and those beside them that may lead. leads and ways of all others are
 * 0. */
PetscErrorCode ChooseWaysAmong(const Discretisation *space, Extension *extension, PetscInt n_leaders,
                               const PetscInt *leader, PetscInt n, const PetscInt *node);
/* Does a load act on a node that has too little to bear it by itself? It cannot stay. */
PetscBool node_needs_lead(const Extension *extension, PetscInt node);
