/* What holds the material of a project? */
#include <math.h>
#include "import/kratos/project.h"

/* Do three of the nodes span a triangle (in space), two a line (in the plane), or is there one (rings)? */
static PetscBool spans(const KratosProject *p, const MdpaIds *nodes)
{
  const PetscReal *first = NULL, *second = NULL;
  for (PetscInt k = 0; k < nodes->n; ++k) {
    const PetscInt node = mdpa_node(p->grid, nodes->id[k]);
    if (node < 0) continue;
    const PetscReal *x = p->grid->x[node];
    PetscReal a[3] = {0, 0, 0}, b[3] = {0, 0, 0}, cross = 0, a2 = 0, b2 = 0;
    if (p->axisymmetric) return PETSC_TRUE;
    for (int d = 0; d < 3; ++d) {
      a[d] = first ? x[d] - first[d] : 0;
      b[d] = second ? second[d] - first[d] : 0;
      a2 += a[d] * a[d];
      b2 += b[d] * b[d];
    }
    for (int d = 0; d < 3; ++d) cross += PetscSqr(a[d] * b[(d + 1) % 3] - a[(d + 1) % 3] * b[d]);
    if (second && cross > 1e-12 * a2 * b2) return PETSC_TRUE;
    if (!first) first = x;
    else if (!second && a2 > 0) {
      if (p->dim == 2) return PETSC_TRUE;
      second = x;
    }
  }
  return PETSC_FALSE;
}

PetscBool kratos_is_held(const KratosProject *p)
{
  for (PetscInt i = 0; i < p->n_actions; ++i) {
    const KratosAction *a = &p->actions[i];
    PetscBool all = a->kind == KRATOS_HELD;
    for (PetscInt d = p->axisymmetric ? 1 : 0; d < p->dim; ++d) all = all && a->set[d];
    if (all && spans(p, &mdpa_part(p->grid, a->part)->nodes)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}
