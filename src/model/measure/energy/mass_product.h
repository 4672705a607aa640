/* Products of nodal fields with the mass matrix of the step. */
#pragma once
#include "model/model.h"

/* Sum of two nodal arrays (n_nodes x dim) with factors. */
typedef struct {
  const PetscReal *x[2];
  PetscReal factor[2];
} NodalField;

/* The sum u M w over this rank's points: cells that are not full have part of their mass lumped, and are tied. */
PetscReal mass_product(const Model *model, NodalField u, NodalField w);
