/* Which nodes follow, and whom. */
#pragma once
#include "method/extend/extend.h"

/* Collective. ways of the extension, on all copies, from its fill. What points see may still be too far apart. */
PetscErrorCode ChooseWays(const Discretisation *space, Extension *extension);
