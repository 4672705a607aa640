/* Momentum over a change of clouds. Points carry the velocity and the acceleration that the field
 * had at their place; in new clouds the same coefficients are another field. So nodes take the
 * motion that comes nearest to that of the points, in the sense of kinetic energy:
 *
 *   sum_p m_p |v_p - sum_I N_I v_I|^2 -> min    over all nodes whose motion is not prescribed,
 *
 * which cannot gain energy. What prescribed nodes keep from being met is their impulse; the little
 * that conjugate gradients leave over goes to the nodes by mass, so that the momentum is the
 * points' to round-off (docs/theory.md, "Reactions"). */
#include "method/gmm/gmm.h"
#include "method/transfer/mass.h"

#define ENOUGH 0.3   /* of what was lacking may be left over */
#define NOTHING 1e-3 /* of the motion itself may lack */
#define LIGHT 0.5    /* of the mass of the nodes around: what has less waits for the rest */
#define MAX_SWEEPS 30

#define UNROLLED static inline __attribute__((always_inline))

/* A loop over points with the dimension known to the compiler. */
#define WITH_DIM(loop, c, ...)                  \
  do {                                          \
    if ((c)->dim == 2) loop(2, c, __VA_ARGS__); \
    else loop(3, c, __VA_ARGS__);               \
  } while (0)

/* sum_I += N_I m_p (share u_p - sum_J N_J x_J) */
UNROLLED void gather(const PetscInt dim, const MassSolve *c, PetscReal share, const PetscReal *x, PetscReal *sum)
{
  const Support *w = c->s->support;
  for (PetscInt p = 0; p < w->n_groups; ++p) {
    const PetscInt nn = support_nodes(w, p), *node = w->node + w->node_start[p];
    const PetscReal *N = w->N + w->value_start[p], m = c->s->points->real[POINT_MASS][p];
    PetscReal u[6];
    for (PetscInt d = 0; d < dim; ++d) {
      u[d] = share * c->s->points->real[POINT_V][p * dim + d];
      u[dim + d] = share * c->s->points->real[POINT_A][p * dim + d];
    }
    for (PetscInt I = 0; I < nn; ++I)
      for (PetscInt k = 0; k < 2 * dim; ++k) u[k] -= N[I] * x[node[I] * 2 * dim + k];
    for (PetscInt I = 0; I < nn; ++I)
      for (PetscInt k = 0; k < 2 * dim; ++k) sum[node[I] * 2 * dim + k] += N[I] * m * u[k];
  }
}

/* What x lacks of the points' motion. */
static PetscErrorCode Lack(MassSolve *c)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(c->lack, c->size));
  WITH_DIM(gather, c, 1, c->x, c->lack);
  PetscCall(GridSumToOwners(c->s->grid, c->width, c->lack));
  PetscFunctionReturn(0);
}

static PetscErrorCode Multiply(MassSolve *c, PetscReal *x)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(c->product, c->size));
  WITH_DIM(gather, c, 0, x, c->product);
  PetscCall(GridSumToOwners(c->s->grid, c->width, c->product));
  for (PetscInt i = 0; i < c->s->grid->n_owned * c->width; ++i) c->product[i] = -c->product[i];
  PetscFunctionReturn(0);
}

/* Of each node: the sum of its row of the mass matrix without signs, over which no eigenvalue is
 * larger than 1, and the mass of the nodes around it, times that sum. */
static PetscErrorCode BoundOfMass(const MassSolve *c, PetscReal *bounds)
{
  const Support *w = c->s->support;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < w->n_groups; ++p) {
    const PetscInt nn = support_nodes(w, p), *node = w->node + w->node_start[p];
    const PetscReal *N = w->N + w->value_start[p], m = c->s->points->real[POINT_MASS][p];
    PetscReal all = 0, around = 0;
    for (PetscInt I = 0; I < nn; ++I) {
      all += PetscAbsReal(N[I]);
      around += PetscAbsReal(N[I]) * PetscMax(0, c->s->nodes->mass[node[I]]);
    }
    for (PetscInt I = 0; I < nn; ++I) {
      bounds[2 * node[I]] += m * PetscAbsReal(N[I]) * all;
      bounds[2 * node[I] + 1] += m * PetscAbsReal(N[I]) * around;
    }
  }
  PetscCall(GridSumToOwners(c->s->grid, 2, bounds));
  PetscFunctionReturn(0);
}

static PetscErrorCode CarryCreate(const Discretisation *s, MassSolve *c)
{
  const PetscInt n = s->grid->n_nodes, dim = s->grid->dim, width = 2 * dim;
  PetscReal *bounds;

  PetscFunctionBeginUser;
  PetscCall(MassSolveAllocate(s, Multiply, c));
  PetscCall(PetscCalloc1(2 * n, &bounds));
  PetscCall(BoundOfMass(c, bounds));
  for (PetscInt node = 0, i = 0; node < n; ++node)
    for (PetscInt d = 0; d < dim; ++d, ++i) {
      const PetscReal bound = bounds[2 * node], around = bounds[2 * node + 1];
      const PetscBool counts = bound > 0 && s->nodes->mass[node] * bound > LIGHT * around;
      const PetscReal inverse = counts && !s->boundary->fixed[i] ? 1 / bound : 0;
      c->x[node * width + d] = s->nodes->v[i];
      c->x[node * width + dim + d] = s->nodes->a[i];
      c->inverse[node * width + d] = c->inverse[node * width + dim + d] = inverse;
    }
  PetscCall(PetscFree(bounds));
  PetscFunctionReturn(0);
}

/* Twice the kinetic energy of the points, and the same of their accelerations. */
static PetscErrorCode Whole(const MassSolve *c, PetscReal whole[MOTIONS])
{
  const Points *points = c->s->points;
  PetscReal local[MOTIONS] = {0, 0};

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < points->n * c->dim; ++i) {
    local[VELOCITY] += points->real[POINT_MASS][i / c->dim] * PetscSqr(points->real[POINT_V][i]);
    local[ACCELERATION] += points->real[POINT_MASS][i / c->dim] * PetscSqr(points->real[POINT_A][i]);
  }
  PetscCall(MPIU_Allreduce(local, whole, MOTIONS, MPIU_REAL, MPI_SUM, c->s->grid->comm));
  PetscFunctionReturn(0);
}

static PetscErrorCode Project(MassSolve *c)
{
  PetscReal start[MOTIONS], whole[MOTIONS], enough[MOTIONS];

  PetscFunctionBeginUser;
  PetscCall(Lack(c));
  PetscCall(MassLack(c, start));
  PetscCall(Whole(c, whole));
  for (int f = 0; f < MOTIONS; ++f) enough[f] = PetscMax(PetscSqr(ENOUGH) * start[f], PetscSqr(NOTHING) * whole[f]);
  PetscCall(MassSolveRun(c, enough, MAX_SWEEPS));
  PetscFunctionReturn(0);
}

/* What the points still lack goes to the nodes of their clouds in proportion to weight and mass,
 * which never divides by a small mass. */
static PetscErrorCode Share(const MassSolve *c)
{
  const Support *w = c->s->support;
  PetscReal u[6];

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(c->lack, c->size));
  for (PetscInt p = 0; p < w->n_groups; ++p) {
    const PetscInt nn = support_nodes(w, p), *node = w->node + w->node_start[p];
    const PetscReal *N = w->N + w->value_start[p];
    PetscReal mass = 0;
    for (PetscInt d = 0; d < c->dim; ++d) {
      u[d] = point_real(c->s->points, POINT_V, p)[d];
      u[c->dim + d] = point_real(c->s->points, POINT_A, p)[d];
    }
    for (PetscInt I = 0; I < nn; ++I) {
      mass += PetscAbsReal(N[I]) * PetscMax(0, c->s->nodes->mass[node[I]]);
      for (PetscInt k = 0; k < c->width; ++k) u[k] -= N[I] * c->x[node[I] * c->width + k];
    }
    for (PetscInt I = 0; I < nn && mass > 0; ++I) {
      const PetscReal share = PetscAbsReal(N[I]) * PetscMax(0, c->s->nodes->mass[node[I]]) / mass;
      for (PetscInt k = 0; k < c->width; ++k)
        c->lack[node[I] * c->width + k] += share * c->s->points->real[POINT_MASS][p] * u[k];
    }
  }
  PetscCall(GridSumToOwners(c->s->grid, c->width, c->lack));
  PetscFunctionReturn(0);
}

PetscErrorCode GmmCarry(Discretisation *s)
{
  NodalFields *n = s->nodes;
  const PetscInt dim = s->grid->dim;
  MassSolve c;

  PetscFunctionBeginUser;
  PetscCall(CarryCreate(s, &c));
  PetscCall(Project(&c));
  PetscCall(Share(&c));
  for (PetscInt i = 0; i < s->grid->n_owned * dim; ++i) {
    const PetscInt k = i / dim * 2 * dim + i % dim;
    const PetscReal inverse = n->mass[i / dim] > 0 ? 1 / n->mass[i / dim] : 0;
    n->v_points[i] = c.x[k] + inverse * c.lack[k];
    n->a_points[i] = c.x[k + dim] + inverse * c.lack[k + dim];
    if (s->boundary->fixed[i]) continue;
    n->v[i] = n->v_points[i];
    n->a[i] = n->a_points[i];
  }
  PetscCall(MassSolveDestroy(&c));
  PetscCall(GridToGhosts(s->grid, dim, n->v_points));
  PetscCall(GridToGhosts(s->grid, dim, n->a_points));
  PetscCall(GridToGhosts(s->grid, dim, n->v));
  PetscCall(GridToGhosts(s->grid, dim, n->a));
  PetscFunctionReturn(0);
}
