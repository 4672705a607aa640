/* The fields that `output: fields:` knows: one table for the case file, `talus list fields` and the
 * writers. */
#pragma once
#include <petscsys.h>

typedef struct {
  const char *name, *unit, *help;
  /* 1 scalar, 3 vector, 6 symmetric tensor (Voigt xx yy zz xy yz zx), 9 tensor row by row */
  PetscInt components;
  /* where it lives: material points, nodes of the grid, or both: motion and mass of nodes are their own,
   * all else the mean of the points around them */
  PetscBool points, grid;
} OutputField;

extern const OutputField output_fields[]; /* ended by name = NULL */

/* NULL if there is none of this name. */
const OutputField *output_field_find(const char *name);
