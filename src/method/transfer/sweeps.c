/* Conjugate gradients for two motions of the nodes at a time. */
#include "method/transfer/lines.h"
#include "method/transfer/loops.h"

/* loop(dim, ...) with the dimension known to the compiler. */
#define WITH_DIM(loop, dim, ...)          \
  do {                                    \
    if ((dim) == 2) loop(2, __VA_ARGS__); \
    else loop(3, __VA_ARGS__);            \
  } while (0)

PetscErrorCode MassSolveAllocate(const Discretisation *s, MassMultiply multiply, MassSolve *c)
{
  const PetscInt dim = s->grid->dim, width = 2 * dim, size = s->grid->n_nodes * width;

  PetscFunctionBeginUser;
  *c = (MassSolve){.s = s, .dim = dim, .width = width, .size = size, .multiply = multiply};
  PetscCall(PetscCalloc6(size, &c->x, size, &c->lack, size, &c->inverse, size, &c->direction, size, &c->product, size,
                         &c->aim));
  PetscFunctionReturn(0);
}

PetscErrorCode MassSolveDestroy(MassSolve *c)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree6(c->x, c->lack, c->inverse, c->direction, c->product, c->aim));
  PetscCall(PetscFree(c->reached));
  if (!c->kept) PetscCall(MassRowsDestroy(&c->rows));
  PetscFunctionReturn(0);
}

/* Most of a grid is often empty: nodes that have mass or an equation, and all that other ranks own. Found once:
 * equations only vanish later. */
PetscErrorCode MassSolveReach(MassSolve *c)
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

void mass_clear(const MassSolve *c, PetscReal *x)
{
  for (PetscInt k = 0; k < c->n_reached; ++k)
    for (PetscInt i = c->reached[k] * c->width; i < (c->reached[k] + 1) * c->width; ++i) x[i] = 0;
}

/* += sums over owned nodes of x y z, of velocity and acceleration apart; z NULL: 1. */
UNROLLED void add_products(const PetscInt dim, const MassSolve *c, const PetscReal *x, const PetscReal *y,
                           const PetscReal *z, PetscReal sum[MOTIONS])
{
  PetscReal part[2 * 3] = {0, 0, 0, 0, 0, 0};
  for (PetscInt k = 0; k < c->n_reached_owned; ++k) {
    const PetscInt first = c->reached[k] * 2 * dim;
    for (PetscInt i = 0; i < 2 * dim; ++i) part[i] += x[first + i] * y[first + i] * (z ? z[first + i] : 1);
  }
  for (PetscInt i = 0; i < 2 * dim; ++i) sum[i / dim] += part[i];
}

static PetscErrorCode Products(const MassSolve *c, const PetscReal *x, const PetscReal *y, const PetscReal *z,
                               PetscReal sum[MOTIONS])
{
  PetscReal local[MOTIONS] = {0, 0};

  PetscFunctionBeginUser;
  if (z) WITH_DIM(add_products, c->dim, c, x, y, z, local);
  else WITH_DIM(add_products, c->dim, c, x, y, NULL, local);
  PetscCall(MPIU_Allreduce(local, sum, MOTIONS, MPIU_REAL, MPI_SUM, c->s->grid->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode MassLack(MassSolve *c, PetscReal square[MOTIONS])
{
  PetscFunctionBeginUser;
  PetscCall(MassSolveReach(c));
  PetscCall(Products(c, c->lack, c->lack, c->inverse, square));
  PetscFunctionReturn(0);
}

/* aim = lack over the diagonal + grow times itself. */
UNROLLED void by_diagonal(const PetscInt dim, const MassSolve *c, const PetscReal grow[MOTIONS], PetscReal *aim)
{
  for (PetscInt k = 0; k < c->n_reached_owned; ++k) {
    const PetscInt first = c->reached[k] * 2 * dim;
    for (PetscInt i = 0; i < 2 * dim; ++i)
      aim[first + i] = c->inverse[first + i] * c->lack[first + i] + grow[i / dim] * aim[first + i];
  }
}

/* direction = aim + grow times itself. */
UNROLLED void turn(const PetscInt dim, MassSolve *c, const PetscReal grow[MOTIONS])
{
  for (PetscInt k = 0; k < c->n_reached_owned; ++k) {
    const PetscInt first = c->reached[k] * 2 * dim;
    for (PetscInt i = 0; i < 2 * dim; ++i)
      c->direction[first + i] = c->aim[first + i] + grow[i / dim] * c->direction[first + i];
  }
}

static void growth(const PetscReal before[MOTIONS], const PetscReal gain[MOTIONS], PetscReal grow[MOTIONS])
{
  for (int f = 0; f < MOTIONS; ++f) grow[f] = before[f] > 0 ? gain[f] / before[f] : 0;
}

/* Where to go next, and how much is gained there: lack . aim; now: MassLack. */
static PetscErrorCode Aim(MassSolve *c, const PetscReal now[MOTIONS], PetscReal gain[MOTIONS])
{
  const PetscReal before[MOTIONS] = {gain[0], gain[1]}, none[MOTIONS] = {0, 0};
  PetscReal grow[MOTIONS];

  PetscFunctionBeginUser;
  if (!c->rows || !c->rows->lines) {
    growth(before, now, grow);
    PetscCall(PetscArraycpy(gain, now, MOTIONS));
    WITH_DIM(by_diagonal, c->dim, c, grow, c->direction);
    PetscFunctionReturn(0);
  }
  WITH_DIM(by_diagonal, c->dim, c, none, c->aim);
  PetscCall(MassLinesAim(c, c->rows->lines, c->product, c->aim));
  PetscCall(Products(c, c->lack, c->aim, NULL, gain));
  growth(before, gain, grow);
  WITH_DIM(turn, c->dim, c, grow);
  PetscFunctionReturn(0);
}

UNROLLED void go(const PetscInt dim, MassSolve *c, const PetscReal length[MOTIONS])
{
  for (PetscInt k = 0; k < c->n_reached; ++k) {
    const PetscInt first = c->reached[k] * 2 * dim;
    for (PetscInt i = 0; i < 2 * dim; ++i) {
      c->x[first + i] += length[i / dim] * c->direction[first + i];
      c->lack[first + i] -= length[i / dim] * c->product[first + i];
    }
  }
}

/* One sweep; lengths of 0 leave a motion alone. */
static PetscErrorCode Sweep(MassSolve *c, const PetscBool done[MOTIONS], const PetscReal now[MOTIONS],
                            PetscReal gain[MOTIONS])
{
  PetscReal curvature[MOTIONS], length[MOTIONS];

  PetscFunctionBeginUser;
  PetscCall(Aim(c, now, gain));
  PetscCall(GridToGhosts(c->s->grid, c->width, c->direction));
  PetscCall(c->multiply(c, c->direction));
  PetscCall(Products(c, c->direction, c->product, NULL, curvature));
  for (int f = 0; f < MOTIONS; ++f) length[f] = !done[f] && curvature[f] > 0 ? gain[f] / curvature[f] : 0;
  WITH_DIM(go, c->dim, c, length);
  PetscFunctionReturn(0);
}

PetscErrorCode MassSolveRun(MassSolve *c, const PetscReal enough[MOTIONS], int sweeps)
{
  PetscReal now[MOTIONS], gain[MOTIONS] = {0, 0};
  PetscBool done[MOTIONS];

  PetscFunctionBeginUser;
  mass_clear(c, c->direction);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    PetscCall(MassLack(c, now));
    for (int f = 0; f < MOTIONS; ++f) done[f] = now[f] <= enough[f];
    if (done[VELOCITY] && done[ACCELERATION]) break;
    if (sweep == 0 && c->prepare) PetscCall(c->prepare(c));
    c->alone = done[ACCELERATION];
    PetscCall(Sweep(c, done, now, gain));
    c->alone = PETSC_FALSE;
  }
  PetscFunctionReturn(0);
}
