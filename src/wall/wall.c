#include "wall/wall.h"

struct Walls {
  const Case *c;
};

PetscErrorCode WallsCreate(const Case *c, Diag *diag, Walls **walls)
{
  (void)diag;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(walls));
  (*walls)->c = c;
  PetscFunctionReturn(0);
}

PetscErrorCode WallsDestroy(Walls **walls)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(*walls));
  PetscFunctionReturn(0);
}

PetscBool wall_near(const Walls *walls, PetscInt k, PetscReal t, const PetscReal *x, PetscReal within, int side,
                    WallPlace *place)
{
  const WallSpec *w = walls->c->walls + k;
  const Shape *s = &w->shape;
  const PetscInt dim = walls->c->kinematics->dim;
  PetscReal gap = 0, length = 0;
  (void)t, (void)side;
  for (PetscInt d = 0; d < dim; ++d) length += s->normal[d] * s->normal[d];
  length = (w->inside ? -1 : 1) * PetscSqrtReal(length);
  for (PetscInt d = 0; d < dim; ++d) gap += (x[d] - s->point[d]) * s->normal[d] / length;
  if (gap > within) return PETSC_FALSE;
  *place = (WallPlace){.gap = gap};
  for (PetscInt d = 0; d < dim; ++d) place->normal[d] = s->normal[d] / length;
  return PETSC_TRUE;
}

int wall_side(const Walls *walls, PetscInt k, PetscReal t, const PetscReal *x)
{
  (void)walls, (void)k, (void)t, (void)x;
  return 0;
}

void wall_motion(const Walls *walls, PetscInt k, PetscReal t0, PetscReal t1, const PetscReal *x, PetscReal increment[3])
{
  (void)walls, (void)k, (void)t0, (void)t1, (void)x;
  for (int d = 0; d < 3; ++d) increment[d] = 0;
}
