/* How far the points of a step have gone along the table of their strength: the law is implicit, and sees of the table
 * what stands at the end. */
#include "model/model_private.h"

static PetscBool has_table(const Model *m)
{
  for (PetscInt i = 0; i < m->c->n_materials; ++i)
    if (m->materials[i].law->passed) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscErrorCode PassedBegin(const Model *m, PetscReal **before)
{
  const PetscInt numbers = m->points->n * m->points->components[POINT_STATE];

  PetscFunctionBeginUser;
  *before = NULL;
  if (!has_table(m)) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(numbers, before));
  PetscCall(PetscArraycpy(*before, m->points->real[POINT_STATE], numbers));
  PetscFunctionReturn(0);
}

PetscErrorCode PassedEnd(Model *m, PetscReal **before)
{
  const PetscReal *was = *before;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; was && p < m->points->n; ++p, was += m->points->components[POINT_STATE]) {
    const Material *material = &m->materials[m->points->material[p]];
    m->passed = PetscMax(m->passed, material_passed(material, was, point_real(m->points, POINT_STATE, p)));
  }
  PetscCall(PetscFree(*before));
  PetscFunctionReturn(0);
}
