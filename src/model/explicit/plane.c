/* The walks of points.c in the plane, over boxes whose points find their nodes by arithmetic. The four nodes of
 * a cell stand side by side in a register, and points of a cell follow each other between laps: a cell's nodes are
 * fetched once for all of them, and what they give to the nodes is summed before it is brought there. */
#include <string.h>
#include "model/explicit/explicit.h"

#define KERNEL static inline __attribute__((always_inline))

/* A number of each node of a cell, or four of a point. */
typedef PetscReal Four __attribute__((vector_size(4 * sizeof(PetscReal))));

static const Four slope[2] = {{-1, 1, -1, 1}, {-1, -1, 1, 1}}, begin[2] = {{1, 0, 1, 0}, {1, 1, 0, 0}};

/* the same anywhere in memory */
typedef Four FourAnywhere __attribute__((aligned(sizeof(PetscReal)), may_alias));

#define FOUR(at) (*(FourAnywhere *)(at))

KERNEL PetscReal total(const Four *a) { return ((*a)[0] + (*a)[1]) + ((*a)[2] + (*a)[3]); }

/* The cell that x stands in and where, from its first node, both in [0, 1]; beyond the box, its last cell. */
KERNEL PetscInt cell_of(const Lattice *l, const PetscReal *x, PetscReal at[2])
{
  PetscInt first = 0;
  for (int d = 0; d < 2; ++d) {
    const PetscReal s = (x[d] - l->origin[d]) * l->per_length[d];
    const PetscInt i = PetscMin((PetscInt)(s > 0 ? s : 0), l->most[d]);
    at[d] = s - (PetscReal)i;
    first += i * l->stride[d];
  }
  return first;
}

/* Shape functions along each axis. */
KERNEL void along(const PetscReal at[2], Four N[2])
{
  for (int d = 0; d < 2; ++d) N[d] = begin[d] + at[d] * slope[d];
}

/* n numbers of each node of the cell go to the nodes; the sums start anew. */
KERNEL void bring(const int n, const Lattice *l, PetscInt cell, Four *sum, PetscReal *nodes)
{
  for (int k = 0; k < 4 && cell >= 0; ++k) {
    PetscReal *to = nodes + l->number[cell + l->corner[k]] * n;
    for (int i = 0; i < n; ++i) to[i] += sum[i][k];
  }
  for (int i = 0; i < n; ++i) sum[i] = (Four){0};
}

/* f_I = - V_0 tau grad N_I, with gradients where the point is now. */
KERNEL void gather(const PetscBool hoop, const Points *points, Explicit *e)
{
  const Lattice l = e->lattice;
  const Four rise[2] = {slope[0] * l.per_length[0], slope[1] * l.per_length[1]};
  Four sum[5] = {{0}}, N[2];
  PetscReal at[2];
  PetscInt cell = -1;
  for (PetscInt p = 0; p < points->n; ++p) {
    const PetscReal *x = point_real(points, POINT_X, p), *v = point_real(points, POINT_V, p);
    const PetscReal mass = points->real[POINT_MASS][p];
    const Four tau = -points->real[POINT_VOLUME][p] * FOUR(point_real(points, POINT_TAU, p));
    const PetscInt now = cell_of(&l, x, at);
    if (now != cell) bring(5, &l, cell, sum, e->sum);
    cell = now;
    along(at, N);
    const Four weight = N[0] * N[1], dx = rise[0] * N[1], dy = rise[1] * N[0];
    sum[0] += mass * weight;
    sum[1] += mass * v[0] * weight;
    sum[2] += mass * v[1] * weight;
    sum[3] += tau[0] * dx + tau[3] * dy;
    sum[4] += tau[3] * dx + tau[1] * dy;
    if (hoop) sum[3] += tau[2] / x[0] * weight;
  }
  bring(5, &l, cell, sum, e->sum);
}

/* Of the cell's nodes: velocity and gain, row by row. */
KERNEL void fetch_motion(const Explicit *e, const Lattice *l, PetscInt cell, Four motion[4])
{
  for (int k = 0; k < 4; ++k) motion[k] = FOUR(e->motion + l->number[cell + l->corner[k]] * 4);
}

KERNEL void mean(const Four *N, const Four motion[4], Four *to)
{
  *to = ((*N)[0] * motion[0] + (*N)[1] * motion[1]) + ((*N)[2] * motion[2] + (*N)[3] * motion[3]);
}

void plane_gather(const Model *m, Explicit *e)
{
  if (m->c->kinematics->hoop) gather(PETSC_TRUE, m->points, e);
  else gather(PETSC_FALSE, m->points, e);
}

void plane_gain(const Model *m, Explicit *e)
{
  const Points *points = m->points;
  const Lattice l = e->lattice;
  const PetscBool again = m->c->analysis.update == EXPLICIT_MUSL;
  const PetscReal per_second = 1 / e->kick, kept = 1 - e->fade, lost = 0.5 * e->fade * (2 - e->fade);
  Four sum[2] = {{0}}, motion[4] = {{0}}, N[2];
  PetscReal at[2], damped = 0;
  PetscInt cell = -1;
  for (PetscInt p = 0; p < points->n; ++p) {
    PetscReal *v = point_real(points, POINT_V, p), *a = point_real(points, POINT_A, p);
    const PetscReal mass = points->real[POINT_MASS][p];
    const PetscInt now = cell_of(&l, point_real(points, POINT_X, p), at);
    if (now != cell) {
      if (again) bring(2, &l, cell, sum, e->straining);
      fetch_motion(e, &l, now, motion);
    }
    cell = now;
    along(at, N);
    const Four weight = N[0] * N[1];
    Four gained;
    mean(&weight, motion, &gained);
    damped += lost * mass * (v[0] * v[0] + v[1] * v[1]);
    for (int d = 0; d < 2; ++d) {
      v[d] = kept * v[d] + gained[2 + d];
      a[d] = gained[2 + d] * per_second;
      sum[d] += mass * v[d] * weight;
    }
  }
  if (again) bring(2, &l, cell, sum, e->straining);
  e->damped += damped;
}

/* What strains the points of a cell: gradient = constant + bilinear {y, y, x, x}, of rows xx yx xy yy. */
typedef struct {
  Four motion[4], constant, bilinear, first; /* first: component x of the nodes' velocities */
} Flow;

KERNEL void fetch_flow(const Explicit *e, const Lattice *l, PetscInt cell, Flow *f)
{
  const Four per_length = {l->per_length[0], l->per_length[0], l->per_length[1], l->per_length[1]};
  const PetscReal *v[4];
  fetch_motion(e, l, cell, f->motion);
  for (int k = 0; k < 4; ++k) v[k] = e->straining + l->number[cell + l->corner[k]] * 2;
  for (int d = 0; d < 2; ++d) {
    const PetscReal twist = (v[3][d] - v[2][d]) - (v[1][d] - v[0][d]);
    f->constant[d] = v[1][d] - v[0][d];
    f->constant[2 + d] = v[2][d] - v[0][d];
    f->bilinear[d] = f->bilinear[2 + d] = twist;
  }
  f->constant *= e->dt * per_length;
  f->bilinear *= e->dt * per_length;
  f->first = (Four){v[0][0], v[1][0], v[2][0], v[3][0]};
}

/* F, J, stress and its work, as `keep` of points.c has them; strain: dF - 1 of xx yx xy yy, ring: of zz. */
KERNEL void keep(Points *points, PetscInt p, const Four *strain, PetscReal ring, const PetscReal *new_tau)
{
  PetscReal *F = point_real(points, POINT_F, p), *stress = point_real(points, POINT_TAU, p);
  const Four A = *strain, f = FOUR(F), old = FOUR(stress), tau = FOUR(new_tau);
  const Four left = {A[0], A[0], A[1], A[1]}, right = {A[2], A[2], A[3], A[3]};
  const Four upper = {f[0], f[1], f[0], f[1]}, lower = {f[2], f[3], f[2], f[3]};
  const Four new_F = f + left * upper + right * lower;
  const PetscReal across = A[1] * A[2], shear = A[1] + A[2];
  const Four sum = {A[0], A[3], ring, shear};
  const Four square = {A[0] * A[0] + across, A[3] * A[3] + across, ring * ring, (A[0] + A[3]) * shear};
  FOUR(F) = new_F;
  F[4] += ring * F[4];
  points->real[POINT_J][p] *= ((1 + A[0]) * (1 + A[3]) - across) * (1 + ring);
  FOUR(stress) = tau;
  const Four work = old * sum + tau * (sum - square);
  points->real[POINT_WORK][p] += 0.5 * points->real[POINT_VOLUME][p] * total(&work);
}

KERNEL void strain(const PetscBool hoop, const Model *m, Explicit *e)
{
  Points *points = m->points;
  const Lattice l = e->lattice;
  Flow flow = {0};
  Strained b;
  Four A[LAW_BATCH], N[2], move;
  PetscReal at[2], ring[LAW_BATCH] = {0};
  PetscInt cell = -1;
  for (PetscInt first = 0, n; first < points->n; first += n) {
    for (n = 0; n < LAW_BATCH && first + n < points->n; ++n) {
      if (points->material[first + n] != points->material[first]) break;
      PetscReal *x = point_real(points, POINT_X, first + n), *u = point_real(points, POINT_U, first + n);
      const PetscInt now = cell_of(&l, x, at);
      if (now != cell) fetch_flow(e, &l, now, &flow);
      cell = now;
      along(at, N);
      A[n] = flow.constant + flow.bilinear * (Four){at[1], at[1], at[0], at[0]};
      const Four weight = N[0] * N[1], share = weight * flow.first;
      if (hoop) ring[n] = e->dt * total(&share) / x[0];
      const PetscReal dF[9] = {1 + A[n][0], A[n][2], 0, A[n][1], 1 + A[n][3], 0, 0, 0, 1 + ring[n]};
      memcpy(b.dF + 9 * n, dF, sizeof dF);
      mean(&weight, flow.motion, &move);
      move *= e->dt;
      for (int d = 0; d < 2; ++d) {
        x[d] += move[d];
        u[d] += move[d];
      }
    }
    const LawStatus status = points_stress(m, first, n, &b);
    e->status = PetscMax(e->status, status);
    for (PetscInt k = 0; k < n; ++k) keep(points, first + k, &A[k], ring[k], b.tau + 6 * k);
  }
}

void plane_strain(const Model *m, Explicit *e)
{
  if (m->c->kinematics->hoop) strain(PETSC_TRUE, m, e);
  else strain(PETSC_FALSE, m, e);
}
