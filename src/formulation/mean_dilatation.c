/* Mean dilatation: displacements alone, but the points of one cell share its change of volume
 * (docs/theory.md).
 *
 *   f_p = 1 + grad du_p, j_p = det f_p, theta = sum V_p j_p / sum V_p, law: (theta / j_p)^(1/d) f_p
 *   R_I = sum_p V0 (tau - tr tau / d) grad N_I + P Dbar_I,  P = sum_p V0 tr tau / d,
 *   Dbar_I = sum_p v_p grad N_I / sum_p v_p,  v_p = V_p j_p
 *
 * V_p is the volume of the point at the start of the step. In cells that keep their points it is that
 * of the place, V0 det F with the point's own F, so that steps of any number end at the same theta,
 * v / V; points that go from cell to cell have only the volume that they were given, V0 J.
 *
 * theta is needed before the law: batches end where cells end, unless one has more points than a
 * batch, or several materials. */
#include "formulation/kernels/cells.h"
#include "formulation/kernels/mean_dilatation_kernels.h"
#include "formulation/sizes.h"

/* A batch, and the cell that was asked last. */
typedef struct {
  Batch b; /* dF: what the law gets */
  PetscReal f[9 * LAW_BATCH], j[LAW_BATCH];
  PetscReal theta[LAW_BATCH], share[LAW_BATCH]; /* v_p / sum v_p */
  PetscReal D[2][LAW_BATCH];                    /* commit: that of du, at both ends of the step */
  PetscInt group;
  PetscReal volume[2], D_of_cell[2]; /* sum V_p, sum v_p */
} SharedBatch;

/* What one cell gathers; rows over nodes as in mean_dilatation_kernels.h. */
typedef struct {
  CellWork cell;
  PetscReal D[3 * CELL_MAX_NODES], left[3 * CELL_MAX_NODES], right[3 * CELL_MAX_NODES];
  PetscReal pressure, bulk; /* P, and sum V0 bulk */
  PetscReal whole;          /* with a tangent: P, known before its points */
} SharedWork;

KERNEL PetscReal volume_at_start(const WeakFormInput *in, PetscInt p)
{
  const PetscReal volume = in->points->real[POINT_VOLUME][p];
  PetscReal F[9];
  if (!in->carried) return volume * in->points->real[POINT_J][p];
  point_F(in->points, p, F);
  return volume * tensor_det(F);
}

KERNEL void point_increment(const int dim, const int nn, const PetscBool hoop, const WeakFormInput *in, PetscInt group,
                            PetscInt p, const PetscReal *du, PetscReal *f)
{
  const PetscReal *N = support_values(nn, in, group, p);
  increment_rows(dim, nn, in->support->dN + (N - in->support->N) * dim, du, f);
  if (hoop) f[8] += node_mean(nn, N, 2, du) / *point_real(in->points, POINT_X, p);
}

/* f and j of the cell's points in the batch, and the cell's sums, unless a batch before has found
 * them (and overwritten what they come from, in a commit). */
KERNEL void cell_increments(const int dim, const int nn, const PetscBool hoop, const PetscBool commit,
                            const WeakFormInput *in, PetscInt group, SharedBatch *s)
{
  const PetscInt *start = in->support->point_start + group;
  const PetscBool known = group == s->group;
  PetscReal du[3 * CELL_MAX_NODES], f[9], inverse[9], *volume = s->volume, *D = s->D_of_cell;
  cell_motion(dim, nn, in, group, du);
  if (!known) volume[0] = volume[1] = D[0] = D[1] = 0;
  for (PetscInt p = start[0]; p < start[1]; ++p) {
    const PetscInt k = p - s->b.first;
    const PetscBool here = k >= 0 && k < s->b.n;
    if (known && !here) continue;
    point_increment(dim, nn, hoop, in, group, p, du, f);
    const PetscReal before = volume_at_start(in, p), j = tensor_det(f);
    if (!known) volume[0] += before, volume[1] += before * j;
    if (!known && commit) {
      tensor_inverse(f, inverse);
      D[0] += before * (f[0] + f[4] + f[8] - 3);
      D[1] += before * j * (3 - inverse[0] - inverse[4] - inverse[8]);
    }
    if (!here) continue;
    for (int i = 0; i < 9; ++i) s->f[9 * k + i] = f[i];
    s->j[k] = j;
    s->share[k] = before * j;
  }
  for (int end = 0; !known && commit && end < 2; ++end) D[end] /= volume[end];
  s->group = group;
}

/* dF of point k, and what it has of its cell; PETSC_FALSE if one of them is inside out. */
KERNEL PetscBool share_volume(const int dim, const PetscBool hoop, const PetscBool commit, PetscInt k, SharedBatch *s)
{
  const PetscBool plane = sharing_directions(dim, hoop) == 2;
  PetscReal *dF = s->b.dF + 9 * k;
  if (!(s->j[k] > 0) || !(s->volume[1] > 0)) return PETSC_FALSE;
  s->theta[k] = s->volume[1] / s->volume[0];
  s->share[k] /= s->volume[1];
  for (int end = 0; commit && end < 2; ++end) s->D[end][k] = s->D_of_cell[end];
  const PetscReal ratio = s->theta[k] / s->j[k], scale = plane ? PetscSqrtReal(ratio) : cbrt(ratio);
  for (int i = 0; i < 9; ++i) dF[i] = scale * s->f[9 * k + i];
  if (plane) dF[8] = s->f[9 * k + 8];
  return PETSC_TRUE;
}

KERNEL LawStatus shared_update(const int dim, const int nn, const PetscBool hoop, const PetscBool commit,
                               const WeakFormInput *in, PetscBool tangent, SharedBatch *s)
{
  PetscInt group = s->b.group;
  for (PetscInt k = 0, end; k < s->b.n; k = end) {
    while (s->b.first + k >= in->support->point_start[group + 1]) ++group;
    end = PetscMin(s->b.n, in->support->point_start[group + 1] - s->b.first);
    cell_increments(dim, nn, hoop, commit, in, group, s);
    for (PetscInt i = k; i < end; ++i)
      if (!share_volume(dim, hoop, commit, i, s)) return LAW_INVERTED;
  }
  return batch_law(in, tangent, &s->b);
}

/* As batch_begin; commit: the new state will be asked for. */
static void shared_begin(const SupportRun *run, const Support *support, PetscBool commit, SharedBatch *s)
{
  batch_begin(run, support, commit, &s->b);
  s->group = -1;
}

/* The next points of one material, of whole cells where that can be. */
static PetscBool shared_next(const WeakFormInput *in, SharedBatch *s)
{
  const PetscInt *start = in->support->point_start;
  Batch *b = &s->b;
  PetscInt whole = 0;
  if (!batch_next(in, b)) return PETSC_FALSE;
  for (PetscInt g = b->group, end = b->first + b->n; start[g] < end && start[g + 1] <= end; ++g)
    whole = start[g + 1] - b->first;
  if (whole > 0) b->n = whole;
  return PETSC_TRUE;
}

/* sum V0 tr tau / d of points first .. first + n - 1 of the batch */
KERNEL PetscReal pressure_of(const int dim, const PetscBool hoop, const WeakFormInput *in, const Batch *b,
                             PetscInt first, PetscInt n)
{
  PetscReal sum = 0;
  for (PetscInt k = first; k < first + n; ++k)
    sum += in->points->real[POINT_VOLUME][b->first + k] * mean_stress(dim, hoop, b->s.tau + 6 * k);
  return sum;
}

/* P of a cell that no batch has as a whole. */
KERNEL PetscReal cell_pressure(const int dim, const int nn, const PetscBool hoop, const WeakFormInput *in,
                               PetscInt group)
{
  const SupportRun alone = {.nodes = nn, .first = group, .end = group + 1};
  PetscReal sum = 0;
  SharedBatch s;
  shared_begin(&alone, in->support, PETSC_FALSE, &s);
  while (shared_next(in, &s)) {
    if (shared_update(dim, nn, hoop, PETSC_FALSE, in, PETSC_FALSE, &s) != LAW_OK) return 0; /* its batch will tell */
    sum += pressure_of(dim, hoop, in, &s.b, 0, s.b.n);
  }
  return sum;
}

KERNEL void shared_load(const int dim, const int nn, const WeakFormInput *in, PetscInt group, SharedWork *w)
{
  cell_load(dim, nn, in, group, &w->cell);
  for (int i = 0; i < dim * row_width(nn); ++i) w->D[i] = w->left[i] = w->right[i] = 0;
  w->pressure = w->bulk = w->whole = 0;
}

KERNEL void shared_store(const int dim, const int nn, const WeakFormInput *in, PetscInt group, PetscInt slot,
                         SharedWork *w, WeakFormOutput *out)
{
  const PetscReal bulk = w->bulk - w->pressure;
  for (int a = 0; a < dim; ++a) row_add(nn, w->pressure, w->D + a * row_width(nn), w->cell.f + a * row_width(nn));
  if (wants_tangent(out)) add_shared_stiffness(dim, nn, in->symmetric, w->D, w->left, w->right, bulk, w->cell.K);
  cell_store(dim, nn, in, group, slot, &w->cell, out);
}

/* Gradients, forces and mass of a point of the batch; m: what its stiffness takes (NULL: none is
 * asked for). */
KERNEL void add_point(const int dim, const int nn, const PetscBool hoop, const WeakFormInput *in, const SharedBatch *s,
                      PetscInt k, PetscInt group, PetscReal *g, MeanModuli *m, SharedWork *w)
{
  static const PetscReal unit[6] = {1, 1, 1, 0, 0, 0};
  const PetscInt p = s->b.first + k;
  const PetscReal *N = support_values(nn, in, group, p), *tau = s->b.s.tau + 6 * k;
  const PetscReal volume = in->points->real[POINT_VOLUME][p], mean = mean_stress(dim, hoop, tau);
  const PetscReal radius = hoop ? *point_real(in->points, POINT_X, p) : 0;
  PetscReal deviator[6], values[CELL_MAX_NODES];
  for (int i = 0; i < 6; ++i) deviator[i] = tau[i] - unit[i] * mean;
  row_load(nn, 1, N, values);
  current_gradients(dim, nn, hoop, in->support->dN + (N - in->support->N) * dim, values, radius, s->f + 9 * k, g);
  add_internal_force(dim, nn, hoop, g, deviator, volume, w->cell.f);
  add_internal_force(dim, nn, hoop, g, unit, s->share[k], w->D);
  add_mass(nn, values, in->points->real[POINT_MASS][p], in->lumping ? in->lumping[group] : 0, w->cell.M);
  w->pressure += volume * mean;
  if (!m) return;
  mean_moduli(dim, hoop, tau, s->b.s.c + 36 * k, w->whole * s->share[k] / volume, m);
  add_internal_force(dim, nn, hoop, g, m->left, volume, w->left);
  add_internal_force(dim, nn, hoop, g, m->right, volume, w->right);
  w->bulk += volume * m->bulk;
}

/* Points first .. first + n - 1 of the batch, all of one cell, at most RUN_POINTS. */
KERNEL void add_points(const int dim, const int nn, const PetscBool hoop, const WeakFormInput *in, PetscBool tangent,
                       const SharedBatch *s, PetscInt first, PetscInt n, PetscInt group, SharedWork *w)
{
  MeanModuli moduli[RUN_POINTS];
  PointRun run;
  run.n = (int)n;
  for (int i = 0; i < n; ++i) {
    add_point(dim, nn, hoop, in, s, first + i, group, run.g[i], tangent ? &moduli[i] : NULL, w);
    run.tau[i] = moduli[i].tau;
    run.c[i] = moduli[i].c;
    run.volume[i] = in->points->real[POINT_VOLUME][s->b.first + first + i];
  }
  if (tangent && in->symmetric) add_stiffness(dim, nn, hoop, PETSC_TRUE, &run, w->cell.K);
  else if (tangent) add_stiffness(dim, nn, hoop, PETSC_FALSE, &run, w->cell.K);
}

/* Points of the batch from its k-th on, as many as are of this cell. */
KERNEL PetscInt add_cell(const int dim, const int nn, const PetscBool hoop, const WeakFormInput *in, PetscBool tangent,
                         const SharedBatch *s, PetscInt k, PetscInt group, SharedWork *w)
{
  const PetscInt *start = in->support->point_start + group;
  const PetscInt here = PetscMin(s->b.n - k, start[1] - (s->b.first + k));
  if (tangent && here == start[1] - start[0]) w->whole = pressure_of(dim, hoop, in, &s->b, k, here);
  else if (tangent && s->b.first + k == start[0]) w->whole = cell_pressure(dim, nn, hoop, in, group);
  for (PetscInt first = k; first < k + here; first += RUN_POINTS)
    add_points(dim, nn, hoop, in, tangent, s, first, PetscMin(RUN_POINTS, k + here - first), group, w);
  return here;
}

KERNEL void assemble_points(const int dim, const int nn, const PetscBool hoop, const WeakFormInput *in,
                            const SupportRun *run, PetscInt slot, WeakFormOutput *out)
{
  const PetscBool tangent = wants_tangent(out);
  PetscInt group = run->first;
  SharedBatch s;
  SharedWork w;

  shared_load(dim, nn, in, group, &w);
  shared_begin(run, in->support, PETSC_FALSE, &s);
  while (shared_next(in, &s)) {
    const LawStatus status = shared_update(dim, nn, hoop, PETSC_FALSE, in, tangent, &s);
    if (!batch_is_good(&s.b, status, out)) return;
    for (PetscInt k = 0; k < s.b.n;) {
      while (s.b.first + k >= in->support->point_start[group + 1]) {
        shared_store(dim, nn, in, group++, slot, &w, out);
        slot += nn * nn;
        shared_load(dim, nn, in, group, &w);
        if (tangent) cell_prefetch(dim, nn, out->slot + slot, out);
      }
      k += add_cell(dim, nn, hoop, in, tangent, &s, k, group, &w);
    }
  }
  shared_store(dim, nn, in, group, slot, &w, out);
}

/* The work of walk.h's rule, with what the force at either end takes the divergence of du for. */
static PetscReal shared_work(const int dim, const PetscBool hoop, const SharedBatch *s, PetscInt k,
                             const PetscReal old[6])
{
  const PetscReal *f = s->f + 9 * k, *tau = s->b.s.tau + 6 * k;
  PetscReal inverse[9];
  tensor_inverse(f, inverse);
  const PetscReal before = s->D[0][k] - (f[0] + f[4] + f[8] - 3);
  const PetscReal after = s->D[1][k] - (3 - inverse[0] - inverse[4] - inverse[8]);
  return stress_work(f, old, tau) + 0.5 * (mean_stress(dim, hoop, old) * before + mean_stress(dim, hoop, tau) * after);
}

static void commit_batch(const int dim, const PetscBool hoop, const WeakFormInput *in, const SharedBatch *s,
                         Points *points)
{
  for (PetscInt k = 0, p = s->b.first; k < s->b.n; ++k, ++p) {
    PetscReal old[6];
    point_tau(points, p, old);
    points->real[POINT_WORK][p] += points->real[POINT_VOLUME][p] * shared_work(dim, hoop, s, k, old);
    commit_deformation(points, p, s->f + 9 * k, s->theta[k]);
    point_set_tau(points, p, s->b.s.tau + 6 * k);
    batch_commit_state(in, &s->b, k, points);
  }
}

/* Once a step: not compiled for each size. */
static PetscErrorCode MeanDilatationCommit(const WeakFormInput *in, Points *points, LawStatus *status)
{
  const int dim = (int)in->kinematics->dim;
  const PetscBool hoop = in->kinematics->hoop;
  SharedBatch s;

  PetscFunctionBeginUser;
  *status = LAW_OK;
  for (PetscInt r = 0; r < in->support->n_runs; ++r) {
    const SupportRun *run = &in->support->run[r];
    shared_begin(run, in->support, PETSC_TRUE, &s);
    while (shared_next(in, &s)) {
      *status = shared_update(dim, (int)run->nodes, hoop, PETSC_TRUE, in, PETSC_FALSE, &s);
      if (*status != LAW_OK) PetscFunctionReturn(0);
      commit_batch(dim, hoop, in, &s, points);
    }
  }
  PetscFunctionReturn(0);
}

CELL_SIZES(SIZED_ASSEMBLE)

static const SizedKernels kernels[] = {CELL_SIZES(SIZED_ASSEMBLE_ROW){0}};

static PetscErrorCode MeanDilatationAssemble(const WeakFormInput *in, WeakFormOutput *out)
{
  return SizedAssemble(kernels, in, out);
}

const Formulation formulation_mean_dilatation = {
  .name = "mean-dilatation",
  .help = "displacements alone; points of one quadrilateral or hexahedron share its change of volume",
  .cells = PETSC_TRUE,
  .singles = PETSC_TRUE,
  .assemble = MeanDilatationAssemble,
  .commit = MeanDilatationCommit,
};
