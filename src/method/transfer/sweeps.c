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
  PetscCall(PetscFree(c->reached));
  PetscFunctionReturn(0);
}

/* Most of a grid is often empty: nodes that have mass or an equation, and all that other ranks own. Found once:
 * equations only vanish later. */
static PetscErrorCode FindReached(MassSolve *c)
{
  const Grid *grid = c->s->grid;
  const PetscReal *mass = c->s->nodes->mass;

  PetscFunctionBeginUser;
  if (c->reached) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(grid->n_nodes, &c->reached));
  for (PetscInt node = 0; node < grid->n_nodes; ++node) {
    PetscBool reached = node >= grid->n_owned || mass[node] > 0;
    for (PetscInt i = node * c->width; i < (node + 1) * c->width && !reached; ++i) reached = c->inverse[i] > 0;
    if (reached) c->reached[c->n_reached++] = node;
    if (node < grid->n_owned) c->n_reached_owned = c->n_reached;
  }
  PetscFunctionReturn(0);
}

/* Sums over owned nodes of x y z, of velocity and acceleration apart. */
static PetscErrorCode Products(const MassSolve *c, const PetscReal *x, const PetscReal *y, const PetscReal *z,
                               PetscReal sum[MOTIONS])
{
  PetscReal local[MOTIONS] = {0, 0};

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < c->n_reached_owned; ++k)
    for (PetscInt f = 0, i = c->reached[k] * c->width; f < MOTIONS; ++f)
      for (PetscInt d = 0; d < c->dim; ++d, ++i) local[f] += x[i] * y[i] * (z ? z[i] : 1);
  PetscCall(MPIU_Allreduce(local, sum, MOTIONS, MPIU_REAL, MPI_SUM, c->s->grid->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode MassLack(MassSolve *c, PetscReal square[MOTIONS])
{
  PetscFunctionBeginUser;
  PetscCall(FindReached(c));
  PetscCall(Products(c, c->lack, c->lack, c->inverse, square));
  PetscFunctionReturn(0);
}

/* One sweep; lengths of 0 leave a motion alone. */
static PetscErrorCode Sweep(MassSolve *c, const PetscBool done[MOTIONS], PetscReal now[MOTIONS],
                            PetscReal grow[MOTIONS])
{
  PetscReal curvature[MOTIONS], length[MOTIONS], before[MOTIONS];

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < c->n_reached_owned; ++k)
    for (PetscInt f = 0, i = c->reached[k] * c->width; f < MOTIONS; ++f)
      for (PetscInt d = 0; d < c->dim; ++d, ++i)
        c->direction[i] = c->inverse[i] * c->lack[i] + grow[f] * c->direction[i];
  PetscCall(GridToGhosts(c->s->grid, c->width, c->direction));
  PetscCall(c->multiply(c, c->direction));
  PetscCall(Products(c, c->direction, c->product, NULL, curvature));
  for (int f = 0; f < MOTIONS; ++f) length[f] = !done[f] && curvature[f] > 0 ? now[f] / curvature[f] : 0;
  for (PetscInt k = 0; k < c->n_reached; ++k)
    for (PetscInt f = 0, i = c->reached[k] * c->width; f < MOTIONS; ++f)
      for (PetscInt d = 0; d < c->dim; ++d, ++i) {
        c->x[i] += length[f] * c->direction[i];
        c->lack[i] -= length[f] * c->product[i];
      }
  PetscCall(PetscArraycpy(before, now, MOTIONS));
  PetscCall(Products(c, c->lack, c->lack, c->inverse, now));
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
