/* The three walks over the points of a substep, for any grid and basis. Boxes where points find their nodes by
 * arithmetic have walks of their own, in the plane (plane.c) and in space (space.c). */
#include <math.h>
#include <string.h>
#include "base/math/tensor.h"
#include "model/explicit/explicit.h"

#define KERNEL static inline __attribute__((always_inline))

/* Nodes that a point sees, N and dN there. */
typedef struct {
  PetscInt nn, group;
  const PetscInt *node;
  const PetscReal *N, *dN;
} Sight;

KERNEL void look(const int dim, const Support *w, PetscInt p, Sight *s)
{
  while (p >= w->point_start[s->group + 1]) ++s->group;
  s->nn = support_nodes(w, s->group);
  s->node = w->node + w->node_start[s->group];
  s->N = support_N(w, s->group, p);
  s->dN = w->dN + (s->N - w->N) * dim;
}

/* What the gradient that a point carries adds to the momentum of a node: m N G (x_I - x_p). */
KERNEL void lean(const int dim, const Model *m, PetscInt p, const PetscReal *G, PetscInt node, PetscReal share,
                 PetscReal *momentum)
{
  const PetscReal *x = point_real(m->points, POINT_X, p);
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) momentum[i] += share * G[i * dim + j] * (m->grid->x[node * dim + j] - x[j]);
}

/* Of the plane strain that cannot change, not of the third direction. */
KERNEL PetscReal mean_of(const int dim, const PetscBool hoop, const PetscReal *tau)
{
  return dim == 2 && !hoop ? 0.5 * (tau[0] + tau[1]) : (tau[0] + tau[1] + tau[2]) / 3;
}

/* Mean of Cauchy's mean stress over the points of a group: what force has in place of each one's own where they share
 * their change of volume (docs/theory.md, "Mean dilatation": P / sum v). */
KERNEL PetscReal shared_mean(const int dim, const PetscBool hoop, const Points *points, const PetscInt range[2])
{
  PetscReal all = 0, volume = 0;
  for (PetscInt p = range[0]; p < range[1]; ++p) {
    all += points->real[POINT_VOLUME][p] * mean_of(dim, hoop, point_real(points, POINT_TAU, p));
    volume += points->real[POINT_VOLUME][p] * points->real[POINT_J][p];
  }
  return all / volume;
}

/* - V_0 tau of a point; mean: what its group shares in place of its own mean stress. */
KERNEL void load(const int dim, const PetscBool hoop, const Points *points, PetscInt p, const PetscReal *mean,
                 PetscReal tau[6])
{
  const PetscReal volume = points->real[POINT_VOLUME][p], *stress = point_real(points, POINT_TAU, p);
  const PetscReal more = mean ? points->real[POINT_J][p] * *mean - mean_of(dim, hoop, stress) : 0;
  const int n = dim == 2 ? 4 : 6, axes = dim == 2 && !hoop ? 2 : 3;
  for (int k = 0; k < 6; ++k) tau[k] = k < n ? -volume * stress[k] : 0;
  for (int k = 0; k < axes; ++k) tau[k] -= volume * more;
}

/* f_I = - V_0 tau grad N_I, with gradients where the point is now. */
KERNEL void gather(const int dim, const PetscBool hoop, const Model *m, Explicit *e)
{
  const Points *points = m->points;
  const PetscInt width = 1 + 2 * dim, *start = m->space->support->point_start;
  Sight s = {0};
  PetscReal mean = 0;
  for (PetscInt p = 0; p < points->n; ++p) {
    const PetscReal *v = point_real(points, POINT_V, p), mass = points->real[POINT_MASS][p];
    PetscReal tau[6], G[9] = {0};
    look(dim, m->space->support, p, &s);
    if (e->slopes) slope_at(dim, point_real(points, POINT_SLOPE, p), -explicit_half(e), G);
    if (e->shared && p == start[s.group]) mean = shared_mean(dim, hoop, points, start + s.group);
    load(dim, hoop, points, p, e->shared ? &mean : NULL, tau);
    const PetscReal ring = hoop ? tau[2] / *point_real(points, POINT_X, p) : 0;
    for (PetscInt k = 0; k < s.nn; ++k) {
      PetscReal *sum = e->sum + s.node[k] * width;
      const PetscReal share = mass * s.N[k];
      sum[0] += share;
      if (e->slopes) lean(dim, m, p, G, s.node[k], share, sum + 1);
      for (int d = 0; d < dim; ++d) {
        PetscReal force = hoop && d == 0 ? ring * s.N[k] : 0;
        for (int j = 0; j < dim; ++j) force += tau[voigt_of[d][j]] * s.dN[k * dim + j];
        sum[1 + d] += share * v[d];
        sum[1 + dim + d] += force;
      }
    }
  }
}

KERNEL void gain(const int dim, const Model *m, Explicit *e)
{
  const Points *points = m->points;
  const PetscBool again = m->c->analysis.update == EXPLICIT_MUSL;
  const PetscReal per_second = 1 / e->act, *fading = e->fading;
  PetscReal damped = 0;
  Sight s = {0};
  for (PetscInt p = 0; p < points->n; ++p) {
    PetscReal *v = point_real(points, POINT_V, p), *a = point_real(points, POINT_A, p), felt[6] = {0};
    const PetscReal mass = points->real[POINT_MASS][p], *gained = felt + dim;
    PetscReal G[9] = {0};
    look(dim, m->space->support, p, &s);
    if (again && e->slopes) slope_at(dim, point_real(points, POINT_SLOPE, p), explicit_half(e), G);
    for (PetscInt k = 0; k < s.nn; ++k)
      for (int d = 0; d < 2 * dim; ++d) felt[d] += s.N[k] * e->motion[s.node[k] * 2 * dim + d];
    for (int d = 0; d < dim; ++d) {
      damped += mass * (v[d] * (fading[0] * v[d] + fading[1] * gained[d]) + fading[2] * gained[d] * gained[d]);
      v[d] += gained[d] - e->fade * v[d];
      v[d] += e->unseen * (felt[d] - v[d]);
      a[d] = gained[d] * per_second;
    }
    for (PetscInt k = 0; again && k < s.nn; ++k) {
      PetscReal *momentum = e->straining + s.node[k] * dim;
      for (int d = 0; d < dim; ++d) momentum[d] += mass * s.N[k] * v[d];
      if (e->slopes) lean(dim, m, p, G, s.node[k], mass * s.N[k], momentum);
    }
  }
  e->damped += damped;
}

KERNEL void strain_point(const int dim, const PetscBool hoop, const Model *m, const Explicit *e, const Sight *s,
                         PetscInt p, PetscReal *dF, PetscReal *move)
{
  PetscReal L[9] = {0}, ring = 0;
  for (int d = 0; d < dim; ++d) move[d] = 0;
  for (PetscInt k = 0; k < s->nn; ++k) {
    const PetscReal *v = e->straining + s->node[k] * dim, *now = explicit_way(e, dim, s->node[k]);
    for (int d = 0; d < dim; ++d) {
      for (int j = 0; j < dim; ++j) L[3 * d + j] += v[d] * s->dN[k * dim + j];
      move[d] += s->N[k] * now[d];
    }
    if (hoop) ring += s->N[k] * v[0];
  }
  if (hoop) L[8] = ring / *point_real(m->points, POINT_X, p);
  for (int i = 0; i < 9; ++i) dF[i] = (i % 4 == 0) + e->dt * L[i];
  for (int d = 0; d < dim; ++d) move[d] *= e->dt;
}

/* theta of a group: what its points' volumes grow by together. */
KERNEL PetscReal shared_growth(const int dim, const PetscBool hoop, const Model *m, const Explicit *e,
                               const PetscInt range[2], Sight s)
{
  PetscReal before = 0, after = 0, dF[9], move[3];
  for (PetscInt p = range[0]; p < range[1]; ++p) {
    const PetscReal volume = m->points->real[POINT_VOLUME][p] * m->points->real[POINT_J][p];
    look(dim, m->space->support, p, &s);
    strain_point(dim, hoop, m, e, &s, p, dF, move);
    before += volume;
    after += volume * tensor_det(dF);
  }
  return after / before;
}

/* One call of the law's. dF: of the points; given: what the law gets, other than that where they share their change of
 * volume, growth. */
typedef struct {
  PetscReal dF[9 * LAW_BATCH], given[9 * LAW_BATCH], growth[LAW_BATCH], move[3 * LAW_BATCH];
  PetscReal old[LAW_MAX_STATE * LAW_BATCH], state[LAW_MAX_STATE * LAW_BATCH], tau[6 * LAW_BATCH];
} Strained;

static LawStatus points_stress(const Model *m, PetscInt first, PetscInt n, Strained *b)
{
  const Material *material = &m->materials[m->points->material[first]];
  const PetscInt n_state = material->law->n_state, stride = m->points->components[POINT_STATE];
  PetscReal *state = m->points->real[POINT_STATE] + first * stride;
  const PetscReal *old = state;
  if (stride != n_state) {
    for (PetscInt k = 0; k < n * n_state; ++k) b->old[k] = state[k / n_state * stride + k % n_state];
    old = b->old;
  }
  const LawUpdate update = law_update_in(material->law, m->c->kinematics);
  const LawStatus status = update(material->parameters, n, b->given, old, b->state, b->tau, NULL);
  if (stride == n_state) memcpy(state, b->state, (size_t)(n * n_state) * sizeof *state);
  else
    for (PetscInt k = 0; k < n * n_state; ++k) state[k / n_state * stride + k % n_state] = b->state[k];
  return status;
}

/* F, J, stress and its work, with A = dF - 1 and A - A^2 for 1 - dF^-1 in the trapezoidal rule of stress_work
 * (formulation/walk.h): a substep is so short that A^3 is beyond the digits of the work. */
KERNEL void keep(const int dim, Points *points, PetscInt p, const Strained *b, PetscInt at)
{
  const int n = dim == 2 ? 4 : 6;
  const PetscReal *dF = b->dF + 9 * at, *given = b->given + 9 * at, *tau = b->tau + 6 * at;
  PetscReal *F = point_real(points, POINT_F, p), *old = point_real(points, POINT_TAU, p), A[9], new_F[9], work = 0;
  for (int i = 0; i < 9; ++i) A[i] = given[i] - (i % 4 == 0);
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) {
      PetscReal square = 0, sum = 0;
      for (int k = 0; k < dim; ++k) {
        square += A[3 * i + k] * A[3 * k + j];
        sum += dF[3 * i + k] * F[dim * k + j];
      }
      const int voigt = voigt_of[i][j];
      work += old[voigt] * A[3 * i + j] + tau[voigt] * (A[3 * i + j] - square);
      new_F[dim * i + j] = sum;
    }
  if (dim == 2) {
    work += old[2] * A[8] + tau[2] * (A[8] - A[8] * A[8]);
    new_F[4] = dF[8] * F[4];
  }
  points->real[POINT_J][p] *= b->growth[at];
  for (int i = 0; i < (dim == 2 ? 5 : 9); ++i) F[i] = new_F[i];
  for (int k = 0; k < n; ++k) old[k] = tau[k];
  points->real[POINT_WORK][p] += 0.5 * points->real[POINT_VOLUME][p] * work;
}

KERNEL void follow(const int dim, const Explicit *e, Points *points, PetscInt p, const PetscReal dF[9])
{
  PetscReal A[3][3];
  for (int i = 0; i < 9; ++i) A[i / 3][i % 3] = dF[i] - (i % 4 == 0);
  slope_follow(dim, e, A, point_real(points, POINT_SLOPE, p));
}

/* What the law gets for point p, the k-th of the batch: of its group it is told the change of volume. */
KERNEL void give(const int dim, const PetscBool hoop, const Explicit *e, PetscReal growth, Strained *b, PetscInt k)
{
  const PetscReal *dF = b->dF + 9 * k, own = tensor_det(dF);
  const PetscBool flat = dim == 2 && !hoop;
  PetscReal *given = b->given + 9 * k, by = 1;
  if (e->shared && own > 0) by = flat ? PetscSqrtReal(growth / own) : cbrt(growth / own);
  for (int i = 0; i < 9; ++i) given[i] = (flat && i == 8 ? 1 : by) * dF[i];
  b->growth[k] = e->shared ? growth : own;
}

KERNEL void strain(const int dim, const PetscBool hoop, const Model *m, Explicit *e)
{
  Points *points = m->points;
  const PetscInt *start = m->space->support->point_start;
  PetscReal growth = 1;
  Sight s = {0};
  Strained b;
  for (PetscInt first = 0, n; first < points->n; first += n) {
    for (n = 0; n < LAW_BATCH && first + n < points->n; ++n) {
      if (points->material[first + n] != points->material[first]) break;
      look(dim, m->space->support, first + n, &s);
      strain_point(dim, hoop, m, e, &s, first + n, b.dF + 9 * n, b.move + 3 * n);
      if (e->shared && first + n == start[s.group]) growth = shared_growth(dim, hoop, m, e, start + s.group, s);
      give(dim, hoop, e, growth, &b, n);
    }
    const LawStatus status = points_stress(m, first, n, &b);
    e->status = PetscMax(e->status, status);
    for (PetscInt k = 0, p = first; k < n; ++k, ++p) {
      keep(dim, points, p, &b, k);
      for (int d = 0; d < dim; ++d) {
        point_real(points, POINT_X, p)[d] += b.move[3 * k + d];
        point_real(points, POINT_U, p)[d] += b.move[3 * k + d];
      }
      if (e->slopes) follow(dim, e, points, p, b.dF + 9 * k);
    }
  }
}

void points_gather(const Model *m, Explicit *e)
{
  if (e->box && m->dim == 3) space_gather(m, e);
  else if (e->box && e->smooth) smooth_gather(m, e);
  else if (e->box) plane_gather(m, e);
  else if (m->dim == 3) gather(3, PETSC_FALSE, m, e);
  else if (m->c->kinematics->hoop) gather(2, PETSC_TRUE, m, e);
  else gather(2, PETSC_FALSE, m, e);
}

void points_gain(const Model *m, Explicit *e)
{
  if (e->box && m->dim == 3) space_gain(m, e);
  else if (e->box && e->smooth) smooth_gain(m, e);
  else if (e->box) plane_gain(m, e);
  else if (m->dim == 3) gain(3, m, e);
  else gain(2, m, e);
}

void points_strain(const Model *m, Explicit *e)
{
  if (e->box && m->dim == 3) space_strain(m, e);
  else if (e->box && e->smooth) smooth_strain(m, e);
  else if (e->box) plane_strain(m, e);
  else if (m->dim == 3) strain(3, PETSC_FALSE, m, e);
  else if (m->c->kinematics->hoop) strain(2, PETSC_TRUE, m, e);
  else strain(2, PETSC_FALSE, m, e);
}
