/* What points without an extent lose from step to step as bodies bend and sway: of the stiffness that the stress gives
 * them, over that of their material (docs/theory.md, section 97). */
#include "model/model_private.h"

/* Do points span all axes? Of their moments the determinant, over that of points as far apart along each. */
#define FLAT 1e-4
/* Volumes that no elastic body has; points of a cell that came from afar by different ways seem to. */
#define GROWN 10.0
/* Cells that points come by on the average, beyond which so many have crossed lines that little is lost. */
#define WAY_MOST 0.25
/* It takes as long as a twentieth of a step in the plane: looked at in the first steps, and then in each so many. */
#define EVERY 8

/* What the gradient of all displacement since the start needs: F, 9 a point, where `known`. */
typedef struct {
  PetscReal *F;
  PetscBool *known;
} Gradients;

/* Of one step. */
typedef struct {
  Sway of;
  PetscReal volume, way; /* way: its square, m2, times volume */
} StepSums;

static PetscBool is_lost(const Model *m)
{
  const AnalysisType type = m->c->analysis.type;
  if (m->step > EVERY && m->step % EVERY) return PETSC_FALSE;
  if (!m->method->restores_grid || m->space->basis->nodes != BASIS_OF_CELLS) return PETSC_FALSE;
  if (type == ANALYSIS_FACTOR || type == ANALYSIS_LIMIT || m->initial.seeking) return PETSC_FALSE;
  return (PetscBool)!materials_yield(m->c->n_materials, m->materials);
}

/* Means of a field over points first .. end - 1. */
static void mean_of(const Points *points, PointReal field, PetscInt first, PetscInt end, PetscReal mean[3])
{
  PetscReal volume = 0;
  for (PetscInt d = 0; d < 3; ++d) mean[d] = 0;
  for (PetscInt p = first; p < end; ++p) {
    volume += points->real[POINT_VOLUME][p];
    for (PetscInt d = 0; d < points->dim; ++d)
      mean[d] += points->real[POINT_VOLUME][p] * point_real(points, field, p)[d];
  }
  for (PetscInt d = 0; d < points->dim; ++d) mean[d] /= volume;
}

/* Sum of volume, what a field differs by from its mean, and the same of places. */
static void moment_of(const Points *points, PointReal field, PetscInt first, PetscInt end, PetscReal moment[9])
{
  PetscReal mean[3], middle[3];
  mean_of(points, field, first, end, mean);
  mean_of(points, POINT_X, first, end, middle);
  for (int i = 0; i < 9; ++i) moment[i] = 0;
  for (PetscInt p = first; p < end; ++p)
    for (PetscInt i = 0; i < points->dim; ++i)
      for (PetscInt j = 0; j < points->dim; ++j)
        moment[3 * i + j] += points->real[POINT_VOLUME][p] * (point_real(points, field, p)[i] - mean[i]) *
                             (point_real(points, POINT_X, p)[j] - middle[j]);
}

/* The linear field nearest to the points' displacements, as F since the start: that of the points' own begins with what
 * an initial stress needs. PETSC_FALSE: they do not tell. */
static PetscBool find_gradient(const Model *m, PetscInt first, PetscInt end, PetscReal F[9])
{
  PetscReal places[9], way[9], inverse[9], H[9], mean[3], middle[3], size = 0, cube = 1;
  moment_of(m->points, POINT_X, first, end, places);
  moment_of(m->points, POINT_U, first, end, way);
  for (PetscInt d = 0; d < m->dim; ++d) size += places[4 * d] / (PetscReal)m->dim;
  for (PetscInt d = m->dim; d < 3; ++d) places[4 * d] = size;
  for (int d = 0; d < 3; ++d) cube *= size;
  if (end - first <= m->dim || !(tensor_det(places) > FLAT * cube)) return PETSC_FALSE;
  tensor_inverse(places, inverse);
  tensor_multiply(way, inverse, H);
  if (m->c->kinematics->hoop) {
    mean_of(m->points, POINT_X, first, end, middle);
    mean_of(m->points, POINT_U, first, end, mean);
    H[8] = mean[0] / middle[0];
  }
  for (int i = 0; i < 9; ++i) H[i] = (i % 4 == 0) - H[i]; /* they stand where they are now */
  const PetscReal shrunk = tensor_inverse(H, F);
  return (PetscBool)(shrunk > 1 / GROWN && shrunk < GROWN);
}

/* Points of a cell stand together, those of a body among them as well. */
static void find_gradients(const Model *m, Gradients *g)
{
  const Points *points = m->points;
  for (PetscInt p = 0, end; p < points->n; p = end) {
    PetscReal F[9];
    for (end = p + 1; end < points->n; ++end)
      if (points->cell[end] != points->cell[p] || points->body[end] != points->body[p]) break;
    const PetscBool known = (PetscBool)(points->cell[p] >= 0 && find_gradient(m, p, end, F));
    for (PetscInt k = p; k < end; ++k) {
      g->known[k] = known;
      for (int i = 0; known && i < 9; ++i) g->F[9 * k + i] = F[i];
    }
  }
}

/* Inverse of the mean of each body, 9 each. */
static PetscErrorCode MeansOfBodies(const Model *m, const Gradients *g, PetscReal *inverse)
{
  const PetscInt n = m->c->n_bodies;
  PetscReal *sum;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(10 * n, &sum));
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal volume = g->known[p] ? m->points->real[POINT_VOLUME][p] : 0;
    PetscReal *mean = sum + 10 * m->points->body[p];
    mean[9] += volume;
    for (int i = 0; g->known[p] && i < 9; ++i) mean[i] += volume * g->F[9 * p + i];
  }
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, sum, 10 * n, MPIU_REAL, MPI_SUM, m->comm));
  for (PetscInt b = 0; b < n; ++b) {
    for (int i = 0; i < 9 && sum[10 * b + 9] > 0; ++i) sum[10 * b + i] /= sum[10 * b + 9];
    const PetscBool sound = (PetscBool)(tensor_det(sum + 10 * b) > 1 / GROWN);
    if (sound) tensor_inverse(sum + 10 * b, inverse + 9 * b);
    for (int i = 0; i < 9 && !sound; ++i) inverse[9 * b + i] = i % 4 == 0; /* rolled up, or not there */
  }
  PetscCall(PetscFree(sum));
  PetscFunctionReturn(0);
}

/* Between lines bilinear functions lose the second derivatives along an axis alone, linear ones all. */
static PetscBool loses_all(const Model *m, PetscInt p)
{
  const CellType type = grid_cell_type(m->grid, m->points->cell[p]);
  return (PetscBool)(type == CELL_TRIANGLE || type == CELL_TETRAHEDRON);
}

/* Of motion along axis j: (A tau A)_jj. */
static PetscReal lost_along(const PetscReal tau[6], const PetscReal A[9], int j, PetscBool all)
{
  PetscReal sum = 0;
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i)
      if (all || k == j) sum += A[3 * j + k] * tau[voigt_of[k][i]] * A[3 * i + j];
  return sum;
}

/* What the weight and the inertia of point p, which has come by u, do to that; loads: m (g - a), N. */
static PetscReal loaded_along(const Model *m, PetscInt p, const PetscReal *g, const PetscReal A[9], int j,
                              PetscBool all)
{
  const PetscReal *a = point_real(m->points, POINT_A, p);
  PetscReal sum = 0;
  for (PetscInt i = 0; i < m->dim; ++i)
    if (all || i == j) sum += (g[i] - (m->scheme->inertia ? a[i] : 0)) * A[3 * i + j];
  return j < m->dim ? m->points->real[POINT_MASS][p] * point_real(m->points, POINT_U, p)[j] * sum : 0;
}

/* What a point has strained and bears. */
typedef struct {
  PetscReal volume, tau[6];
  PetscReal E[9],
    bears[9];    /* Green's strain, which knows of no turn, and the stress of that alone: where volumes hardly
                               change, as if they were softer */
  PetscBool all; /* see loses_all */
} Borne;

static Borne borne_by(const Model *m, PetscInt p, const PetscReal A[9])
{
  const Material *material = &m->materials[m->points->material[p]];
  const PetscReal shear = material->elastic.shear, across = material_sheared(material) - 2 * shear;
  Borne b = {.volume = m->points->real[POINT_VOLUME][p], .all = loses_all(m, p)};
  point_tau(m->points, p, b.tau);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      b.E[3 * i + j] = 0.5 * (A[3 * i + j] + A[3 * j + i] + A[i] * A[j] + A[3 + i] * A[3 + j] + A[6 + i] * A[6 + j]);
  const PetscReal pressure = across * (b.E[0] + b.E[4] + b.E[8]);
  for (int i = 0; i < 9; ++i) b.bears[i] = 2 * shear * b.E[i] + (i % 4 == 0 ? pressure : 0);
  return b;
}

/* A: as the body has come. */
static void add_whole(const Model *m, PetscInt p, const PetscReal *g, const PetscReal A[9], Sway *sum)
{
  const Borne b = borne_by(m, p, A);
  for (int j = 0; j < 3; ++j) {
    const PetscReal lost = b.volume * lost_along(b.tau, A, j, b.all) - loaded_along(m, p, g, A, j, b.all);
    sum->lost += lost;
    sum->along[j].lost += lost;
    for (int k = 0; k < 3; ++k) {
      sum->strained += b.volume * b.bears[3 * j + k] * b.E[3 * j + k];
      sum->along[j].work += b.volume * b.bears[3 * j + k] * A[3 * j + k];
    }
  }
}

/* A: what it has done besides turning and stretching as a whole. */
static void add_apart(const Model *m, PetscInt p, const PetscReal A[9], Sway *sum)
{
  const Borne b = borne_by(m, p, A);
  for (int j = 0; j < 3; ++j) {
    sum->lost_apart += b.volume * lost_along(b.tau, A, j, b.all);
    for (int k = 0; k < 3; ++k) {
      sum->strained_apart += b.volume * b.bears[3 * j + k] * b.E[3 * j + k];
      sum->along[j].spin += b.volume * PetscSqr(0.5 * (A[3 * j + k] - A[3 * k + j]));
      sum->along[j].strain += b.volume * PetscSqr(b.E[3 * j + k]);
    }
  }
}

static void add_points(const Model *m, const Gradients *found, const PetscReal *inverse, StepSums *sum)
{
  PetscReal g[3];
  gravity_at(m->c, m->time, g);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    PetscReal whole[9], apart[9];
    sum->volume += m->points->real[POINT_VOLUME][p];
    for (PetscInt d = 0; d < m->dim; ++d)
      sum->way += m->points->real[POINT_VOLUME][p] * PetscSqr(point_real(m->points, POINT_U, p)[d]);
    if (!found->known[p]) continue;
    tensor_multiply(found->F + 9 * p, inverse + 9 * m->points->body[p], apart);
    for (int i = 0; i < 9; ++i) whole[i] = found->F[9 * p + i] - (i % 4 == 0);
    for (int i = 0; i < 9; ++i) apart[i] -= i % 4 == 0;
    add_whole(m, p, g, whole, &sum->of);
    add_apart(m, p, apart, &sum->of);
  }
}

/* What is lost has one sign in a step, and may have another in the next. */
static void add_step(const Model *m, StepSums *step, Sway *to)
{
  const PetscBool loses = (PetscBool)(step->way < PetscSqr(WAY_MOST * m->grid->smallest) * step->volume);
  step->of.steps = 1;
  step->of.lost = loses ? PetscAbsReal(step->of.lost) : 0;
  step->of.lost_apart = loses ? PetscAbsReal(step->of.lost_apart) : 0;
  for (int j = 0; j < 3; ++j) step->of.along[j].lost = loses ? PetscAbsReal(step->of.along[j].lost) : 0;
  for (size_t k = 0; k < SWAY_NUMBERS; ++k) ((PetscReal *)to)[k] += ((const PetscReal *)&step->of)[k];
}

PetscErrorCode NoteSway(Model *m)
{
  StepSums local = {0}, sum;
  PetscReal *inverse;
  Gradients found;

  PetscFunctionBeginUser;
  if (!is_lost(m)) PetscFunctionReturn(0);
  PetscCall(PetscMalloc3(9 * m->points->n, &found.F, m->points->n, &found.known, 9 * m->c->n_bodies, &inverse));
  find_gradients(m, &found);
  PetscCall(MeansOfBodies(m, &found, inverse));
  add_points(m, &found, inverse, &local);
  PetscCall(MPIU_Allreduce(&local, &sum, SWAY_NUMBERS + 2, MPIU_REAL, MPI_SUM, m->comm));
  add_step(m, &sum, &m->sway);
  PetscCall(PetscFree3(found.F, found.known, inverse));
  PetscFunctionReturn(0);
}
