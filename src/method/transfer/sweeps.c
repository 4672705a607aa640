/* Conjugate gradients for two motions of the nodes at a time. */
#include "method/transfer/mass.h"

PetscErrorCode MassSolveAllocate(const Discretisation *s, MassMultiply multiply, MassSolve *c)
{
  const PetscInt dim = s->grid->dim, width = 2 * dim, size = s->grid->n_nodes * width;

  PetscFunctionBeginUser;
  *c = (MassSolve){.s = s, .dim = dim, .width = width, .size = size, .multiply = multiply};
  PetscCall(PetscCalloc5(size, &c->x, size, &c->lack, size, &c->inverse, size, &c->direction, size, &c->product));
  PetscFunctionReturn(0);
}

PetscErrorCode MassSolveDestroy(MassSolve *c)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree5(c->x, c->lack, c->inverse, c->direction, c->product));
  PetscFunctionReturn(0);
}

/* Sums over owned nodes of x y z, of velocity and acceleration apart. */
static PetscErrorCode Products(const MassSolve *c, const PetscReal *x, const PetscReal *y, const PetscReal *z,
                               PetscReal sum[MOTIONS])
{
  PetscReal local[MOTIONS] = {0, 0};

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < c->s->grid->n_owned * c->width; i += c->dim)
    for (PetscInt d = 0; d < c->dim; ++d) local[(i / c->dim) % MOTIONS] += x[i + d] * y[i + d] * (z ? z[i + d] : 1);
  PetscCall(MPIU_Allreduce(local, sum, MOTIONS, MPIU_REAL, MPI_SUM, c->s->grid->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode MassLack(const MassSolve *c, PetscReal square[MOTIONS])
{
  PetscFunctionBeginUser;
  PetscCall(Products(c, c->lack, c->lack, c->inverse, square));
  PetscFunctionReturn(0);
}

/* One sweep; lengths of 0 leave a motion alone. */
static PetscErrorCode Sweep(MassSolve *c, const PetscBool done[MOTIONS], PetscReal now[MOTIONS],
                            PetscReal grow[MOTIONS])
{
  const PetscInt owned = c->s->grid->n_owned * c->width;
  PetscReal curvature[MOTIONS], length[MOTIONS], before[MOTIONS];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < owned; i += c->dim)
    for (PetscInt d = 0; d < c->dim; ++d)
      c->direction[i + d] = c->inverse[i + d] * c->lack[i + d] + grow[(i / c->dim) % MOTIONS] * c->direction[i + d];
  PetscCall(GridToGhosts(c->s->grid, c->width, c->direction));
  PetscCall(c->multiply(c, c->direction));
  PetscCall(Products(c, c->direction, c->product, NULL, curvature));
  for (int f = 0; f < MOTIONS; ++f) length[f] = !done[f] && curvature[f] > 0 ? now[f] / curvature[f] : 0;
  for (PetscInt i = 0; i < c->size; i += c->dim)
    for (PetscInt d = 0; d < c->dim; ++d) {
      c->x[i + d] += length[(i / c->dim) % MOTIONS] * c->direction[i + d];
      c->lack[i + d] -= length[(i / c->dim) % MOTIONS] * c->product[i + d];
    }
  PetscCall(PetscArraycpy(before, now, MOTIONS));
  PetscCall(MassLack(c, now));
  for (int f = 0; f < MOTIONS; ++f) grow[f] = before[f] > 0 ? now[f] / before[f] : 0;
  PetscFunctionReturn(0);
}

PetscErrorCode MassSolveRun(MassSolve *c, const PetscReal enough[MOTIONS], int sweeps)
{
  PetscReal now[MOTIONS], grow[MOTIONS] = {0, 0};
  PetscBool done[MOTIONS];

  PetscFunctionBeginUser;
  PetscCall(MassLack(c, now));
  PetscCall(PetscArrayzero(c->direction, c->size));
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (int f = 0; f < MOTIONS; ++f) done[f] = now[f] <= enough[f];
    if (done[VELOCITY] && done[ACCELERATION]) break;
    PetscCall(Sweep(c, done, now, grow));
  }
  PetscFunctionReturn(0);
}
