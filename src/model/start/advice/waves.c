/* Waves of pressure that the mixed formulation slows down: its stabilisation gives way to pressures that vary within
 * cells, as theirs do, like something compressible (docs/theory.md, section 12). */
#include "model/model_private.h"

#define SLOW_SAID 1.05

/* The longest way through a material along an axis, of all ranks, m. */
static PetscErrorCode FindLengths(const Model *m, PetscReal *length)
{
  const PetscInt n = m->c->n_materials, dim = m->dim;
  PetscReal *ends; /* of each material the highest of -x and of x */

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * n * dim, &ends));
  for (PetscInt i = 0; i < 2 * n * dim; ++i) ends[i] = -PETSC_MAX_REAL;
  for (PetscInt p = 0; p < m->points->n; ++p)
    for (PetscInt d = 0; d < dim; ++d) {
      const PetscReal x = point_real(m->points, POINT_X, p)[d];
      PetscReal *end = ends + 2 * (m->points->material[p] * dim + d);
      end[0] = PetscMax(end[0], -x), end[1] = PetscMax(end[1], x);
    }
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, ends, (PetscMPIInt)(2 * n * dim), MPIU_REAL, MPIU_MAX, m->comm));
  for (PetscInt i = 0; i < n; ++i) {
    length[i] = 0;
    for (PetscInt d = 0; d < dim; ++d)
      length[i] = PetscMax(length[i], ends[2 * (i * dim + d)] + ends[2 * (i * dim + d) + 1]);
  }
  PetscCall(PetscFree(ends));
  PetscFunctionReturn(0);
}

/* By how much the period of the longest of them, a quarter of which fits in, is too long. */
static PetscReal slowness(const Model *m, const Material *material, PetscReal length)
{
  const PetscReal stiffer = 1 / (material->compliance * material->elastic.shear);
  const PetscReal wave = PETSC_PI / 2 * m->grid->smallest / length;
  return PetscSqrtReal(1 + m->c->mixed.stabilisation / 12 * stiffer * wave * wave);
}

PetscErrorCode AdviseWaves(const Model *m, Diag *diag)
{
  PetscReal *length;
  char path[256];

  PetscFunctionBeginUser;
  if (!m->formulation->pressure || !m->scheme->inertia) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(m->c->n_materials, &length));
  PetscCall(FindLengths(m, length));
  for (PetscInt i = 0; i < m->c->n_materials; ++i) {
    const Material *material = m->materials + i;
    const PetscReal slow = length[i] > 0 && material->compliance > 0 ? slowness(m, material, length[i]) : 1;
    if (slow < SLOW_SAID) continue;
    PetscSNPrintf(path, sizeof path, "materials.%s", material->name);
    diag_warning(diag, path,
                 "waves of pressure through '%s' take %.3g times as long as they should, and shorter ones longer, "
                 "where it cannot give way sideways: the stabilisation of the pressure is softer than the material",
                 material->name, (double)slow);
    diag_hint(diag,
              "`formulation: mean-dilatation` has them right; smaller cells or less `mixed: {stabilisation: ...}` "
              "come closer (docs/guide/limits.md)");
  }
  PetscCall(PetscFree(length));
  PetscFunctionReturn(0);
}
