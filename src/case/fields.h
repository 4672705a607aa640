/* The fields that `output: fields:` knows: one table for the case file, `talus list fields` and the
 * writers. What points of a loaded law keep joins it. */
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

#define OUTPUT_FIELDS_MOST 288
extern const OutputField *const output_fields; /* ended by name = NULL */

/* NULL if there is none of this name. */
const OutputField *output_field_find(const char *name);

/* Add one of a loaded law, whose words stay where they are; a name of talus's own fields goes on meaning those.
 * PETSC_FALSE: one that was added before has this name and another number of components. */
PetscBool output_field_add(const OutputField *field);
