/* Densities that change with time. */
#pragma once
#include "case/case.h"

/* Do any, so that nodes have other masses after each step? */
PetscBool weight_changes(const Case *c);
