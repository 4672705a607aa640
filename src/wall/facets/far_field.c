/* A lattice of signed distances in the box around a surface. Distances change by no more than one
 * metre a metre: a lattice point tells at once that x is far from the surface, and on which side,
 * or how far a search for the nearest facet has to go. */
#include "wall/facets/facets.h"
#include <math.h>

struct FarField {
  PetscReal min[3], cell;
  PetscInt n[3];
  float *gap; /* at the centres of the cells */
};

#define MOST_CELLS 32 /* along the longest edge: 0.1 s for a surface of 100,000 triangles */

PetscErrorCode FarFieldCreate(Facets *f)
{
  struct FarField *far;
  WallPlace place;
  PetscReal longest = 0;
  size_t at = 0;

  PetscFunctionBeginUser;
  for (int d = 0; d < 3; ++d) longest = PetscMax(longest, f->bounds[d + 3] - f->bounds[d]);
  const PetscReal along = PetscMin(PetscMax(PetscSqrtReal((PetscReal)f->n) / 2, 4), MOST_CELLS);
  PetscCall(PetscNew(&far));
  far->cell = longest / along;
  for (int d = 0; d < 3; ++d) {
    far->min[d] = f->bounds[d];
    far->n[d] = PetscMax(1, (PetscInt)ceil((f->bounds[d + 3] - f->bounds[d]) / far->cell));
  }
  PetscCall(PetscMalloc1((size_t)far->n[0] * (size_t)far->n[1] * (size_t)far->n[2], &far->gap));
  PetscReal last = PETSC_MAX_REAL;
  for (PetscInt k = 0; k < far->n[2]; ++k)
    for (PetscInt j = 0; j < far->n[1]; ++j)
      for (PetscInt i = 0; i < far->n[0]; ++i) {
        const PetscReal x[3] = {far->min[0] + (i + 0.5) * far->cell, far->min[1] + (j + 0.5) * far->cell,
                                far->min[2] + (k + 0.5) * far->cell};
        /* the neighbour before says how far to look */
        facets_search(f, x, i ? 1.001 * (last + far->cell) : PETSC_MAX_REAL, &place);
        last = PetscAbsReal(place.gap);
        far->gap[at++] = (float)place.gap;
      }
  f->far = far;
  PetscFunctionReturn(0);
}

PetscErrorCode FarFieldDestroy(struct FarField **far)
{
  PetscFunctionBeginUser;
  if (*far) PetscCall(PetscFree((*far)->gap));
  PetscCall(PetscFree(*far));
  PetscFunctionReturn(0);
}

PetscBool far_field_at(const struct FarField *far, const PetscReal x[3], PetscReal *gap, PetscReal *away)
{
  PetscInt cell[3];
  PetscReal square = 0;
  for (int d = 0; d < 3; ++d) {
    const PetscReal s = (x[d] - far->min[d]) / far->cell;
    if (!(s >= 0 && s < (PetscReal)far->n[d])) return PETSC_FALSE;
    cell[d] = (PetscInt)s;
    square += PetscSqr((s - (PetscReal)cell[d] - 0.5) * far->cell);
  }
  *gap =
    (PetscReal)far->gap[((size_t)cell[2] * (size_t)far->n[1] + (size_t)cell[1]) * (size_t)far->n[0] + (size_t)cell[0]];
  *away = PetscSqrtReal(square) + 1e-6 * PetscAbsReal(*gap); /* single precision keeps 6e-8 */
  return PETSC_TRUE;
}
