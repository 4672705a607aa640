/* Tractions, pressures and forces. */
#pragma once
#include "case/spec/motion.h"

typedef enum { LOAD_TRACTION, LOAD_POINT, LOAD_PRESSURE, LOAD_KINDS } LoadKind;

typedef struct {
  char *name; /* NULL if it has none */
  LoadKind kind;
  Selector on;        /* traction, pressure: boundary faces of the grid, or of a body (carried by it) */
  PetscReal at[3];    /* point load: the material position at the start */
  PetscReal value[3]; /* N/m2 of undeformed boundary, or N; pressure: value[0], N/m2 of the present one */
  Amplitude amplitude;
  char *factor; /* a formula of LoadPlace that multiplies the value; NULL: 1 */
  /* 0, or the number of a later stage in which it begins: till then its carriers go with the material, and push
   * nothing. Strings are that stage's. Such loads stand behind all others. */
  PetscInt waits;
} LoadSpec;

/* A load of 0 pushes nothing, whatever its factors: what it stands on is as free as any other surface. */
static inline PetscBool load_pushes(const LoadSpec *load)
{
  return (PetscBool)(load->value[0] != 0 || load->value[1] != 0 || load->value[2] != 0);
}

/* What the formula of a load may name: x y z, where the material is when the step begins, X Y Z, where
 * it was undeformed (m), and t, s. */
typedef struct {
  PetscInt dim;
  const PetscReal *X, *x;
  PetscReal t;
} LoadPlace;

/* Of a Formula whose context is a LoadPlace. */
PetscErrorCode LoadPlaceValue(void *place, const char *name, PetscBool *known, PetscReal *value);
