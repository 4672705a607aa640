/* Momentum over a change of clouds. Points carry the velocity and the acceleration that the field
 * had at their place; in new clouds the same coefficients are another field. So nodes take the
 * motion that comes nearest to that of the points, in the sense of kinetic energy:
 *
 *   sum_p m_p |v_p - sum_I N_I v_I|^2 -> min    over all nodes whose motion is not prescribed,
 *
 * which cannot gain energy. What prescribed nodes keep from being met is their impulse; the little
 * that conjugate gradients leave over goes to the nodes by mass, so that the momentum is the
 * points' to round-off (docs/theory.md, "Reactions"). */
#include "method/gmm.h"

#define ENOUGH 0.3   /* of what was lacking may be left over */
#define NOTHING 1e-3 /* of the motion itself may lack */
#define LIGHT 0.5    /* of the mass of the nodes around: what has less waits for the rest */
#define MAX_SWEEPS 30

enum { VELOCITY, ACCELERATION, MOTIONS };

/* Nodal arrays: n_nodes x (2 dim), velocity and acceleration of a node behind each other. */
typedef struct {
  const Discretisation *s;
  PetscInt dim, width, size; /* 2 dim, n_nodes x 2 dim */
  /* motion, what it lacks of the points' momenta, conjugate gradients */
  PetscReal *x, *lack, *direction, *product;
  /* of the mass matrix's diagonal; its inverse, 0 where motion is prescribed */
  PetscReal *bound, *inverse;
} Carry;

#define UNROLLED static inline __attribute__((always_inline))

/* A loop over points with the dimension known to the compiler. */
#define WITH_DIM(loop, c, ...)                  \
  do {                                          \
    if ((c)->dim == 2) loop(2, c, __VA_ARGS__); \
    else loop(3, c, __VA_ARGS__);               \
  } while (0)

/* sum_I += N_I m_p (share u_p - sum_J N_J x_J) */
UNROLLED void gather(const PetscInt dim, const Carry *c, PetscReal share, const PetscReal *x, PetscReal *sum)
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

/* What x lacks of the points' motion (share 1), or the product of the mass matrix with x, negative
 * (0). */
static PetscErrorCode Gather(const Carry *c, PetscReal share, const PetscReal *x, PetscReal *sum)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(sum, c->size));
  WITH_DIM(gather, c, share, x, sum);
  PetscCall(GridSumToOwners(c->s->grid, c->width, sum));
  PetscFunctionReturn(0);
}

/* Of each node: the sum of its row of the mass matrix without signs, over which no eigenvalue is
 * larger than 1, and the mass of the nodes around it, times that sum. */
static PetscErrorCode BoundOfMass(const Carry *c)
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
      c->bound[2 * node[I]] += m * PetscAbsReal(N[I]) * all;
      c->bound[2 * node[I] + 1] += m * PetscAbsReal(N[I]) * around;
    }
  }
  PetscCall(GridSumToOwners(c->s->grid, 2, c->bound));
  PetscFunctionReturn(0);
}

static PetscErrorCode CarryCreate(const Discretisation *s, Carry *c)
{
  const PetscInt n = s->grid->n_nodes, dim = s->grid->dim, width = 2 * dim, size = n * width;

  PetscFunctionBeginUser;
  *c = (Carry){.s = s, .dim = dim, .width = width, .size = size};
  PetscCall(PetscMalloc2(size, &c->x, size, &c->lack));
  PetscCall(PetscCalloc4(size, &c->direction, size, &c->product, size, &c->inverse, 2 * n, &c->bound));
  PetscCall(BoundOfMass(c));
  for (PetscInt node = 0, i = 0; node < n; ++node)
    for (PetscInt d = 0; d < dim; ++d, ++i) {
      const PetscReal bound = c->bound[2 * node], around = c->bound[2 * node + 1];
      const PetscBool counts = bound > 0 && s->nodes->mass[node] * bound > LIGHT * around;
      const PetscReal inverse = counts && !s->boundary->fixed[i] ? 1 / bound : 0;
      c->x[node * width + d] = s->nodes->v[i];
      c->x[node * width + dim + d] = s->nodes->a[i];
      c->inverse[node * width + d] = c->inverse[node * width + dim + d] = inverse;
    }
  PetscFunctionReturn(0);
}

static PetscErrorCode CarryDestroy(Carry *c)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(c->x, c->lack));
  PetscCall(PetscFree4(c->direction, c->product, c->inverse, c->bound));
  PetscFunctionReturn(0);
}

/* Two sums over owned nodes of x y z, of velocity and acceleration apart. */
static PetscErrorCode Products(const Carry *c, const PetscReal *x, const PetscReal *y, const PetscReal *z,
                               PetscReal sum[MOTIONS])
{
  PetscReal local[MOTIONS] = {0, 0};

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < c->s->grid->n_owned * c->width; i += c->dim)
    for (PetscInt d = 0; d < c->dim; ++d) local[(i / c->dim) % MOTIONS] += x[i + d] * y[i + d] * (z ? z[i + d] : 1);
  PetscCall(MPIU_Allreduce(local, sum, MOTIONS, MPIU_REAL, MPI_SUM, c->s->grid->comm));
  PetscFunctionReturn(0);
}

/* One sweep of conjugate gradients; lengths of 0 leave a motion alone. */
static PetscErrorCode Sweep(const Carry *c, const PetscBool done[MOTIONS], PetscReal now[MOTIONS],
                            PetscReal grow[MOTIONS])
{
  PetscReal curvature[MOTIONS], length[MOTIONS], before[MOTIONS];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < c->s->grid->n_owned * c->width; i += c->dim)
    for (PetscInt d = 0; d < c->dim; ++d)
      c->direction[i + d] = c->inverse[i + d] * c->lack[i + d] + grow[(i / c->dim) % MOTIONS] * c->direction[i + d];
  PetscCall(GridToGhosts(c->s->grid, c->width, c->direction));
  PetscCall(Gather(c, 0, c->direction, c->product));
  PetscCall(Products(c, c->direction, c->product, NULL, curvature));
  for (int f = 0; f < MOTIONS; ++f) length[f] = !done[f] && curvature[f] < 0 ? -now[f] / curvature[f] : 0;
  for (PetscInt i = 0; i < c->size; i += c->dim)
    for (PetscInt d = 0; d < c->dim; ++d) {
      c->x[i + d] += length[(i / c->dim) % MOTIONS] * c->direction[i + d];
      c->lack[i + d] += length[(i / c->dim) % MOTIONS] * c->product[i + d];
    }
  PetscCall(PetscArraycpy(before, now, MOTIONS));
  PetscCall(Products(c, c->lack, c->lack, c->inverse, now));
  for (int f = 0; f < MOTIONS; ++f) grow[f] = before[f] > 0 ? now[f] / before[f] : 0;
  PetscFunctionReturn(0);
}

/* Twice the kinetic energy of the points, and the same of their accelerations. */
static PetscErrorCode Whole(const Carry *c, PetscReal whole[MOTIONS])
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

static PetscErrorCode Project(const Carry *c)
{
  PetscReal now[MOTIONS], start[MOTIONS], whole[MOTIONS], grow[MOTIONS] = {0, 0};
  PetscBool done[MOTIONS];
  int sweep = 0;

  PetscFunctionBeginUser;
  PetscCall(Gather(c, 1, c->x, c->lack));
  PetscCall(Products(c, c->lack, c->lack, c->inverse, start));
  PetscCall(PetscArraycpy(now, start, MOTIONS));
  PetscCall(Whole(c, whole));
  do {
    for (int f = 0; f < MOTIONS; ++f)
      done[f] = now[f] <= PetscSqr(ENOUGH) * start[f] || now[f] <= PetscSqr(NOTHING) * whole[f];
    if (done[VELOCITY] && done[ACCELERATION]) break;
    PetscCall(Sweep(c, done, now, grow));
  } while (++sweep < MAX_SWEEPS);
  PetscFunctionReturn(0);
}

/* What the points still lack goes to the nodes of their clouds in proportion to weight and mass,
 * which never divides by a small mass. */
static PetscErrorCode Share(const Carry *c)
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
  Carry c;

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
  PetscCall(CarryDestroy(&c));
  PetscCall(GridToGhosts(s->grid, dim, n->v));
  PetscCall(GridToGhosts(s->grid, dim, n->a));
  PetscFunctionReturn(0);
}
