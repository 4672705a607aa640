/* Numbers taken from the model: tracers, extents, sums over points, energies, reactions. */
#include "model/model_private.h"
#include "model/measure/surface.h"

const char *measure_unit(const MeasureSpec *s)
{
  switch (s->kind) {
  case MEASURE_DISPLACEMENT:
  case MEASURE_POSITION:
  case MEASURE_SURFACE_FRONT:
  case MEASURE_SURFACE_HEIGHT:
  case MEASURE_EXTENT: return "m";
  case MEASURE_VELOCITY: return "m/s";
  case MEASURE_OUTSIDE_MASS:
  case MEASURE_MASS: return "kg";
  case MEASURE_OUTSIDE_MOMENTUM:
  case MEASURE_MOMENTUM: return "kg m/s";
  case MEASURE_ANGULAR_MOMENTUM: return "kg m2/s";
  case MEASURE_SPIN: return "rad/s";
  case MEASURE_KINETIC_ENERGY:
  case MEASURE_ELASTIC_ENERGY:
  case MEASURE_DISSIPATED_ENERGY:
  case MEASURE_DAMPED_ENERGY:
  case MEASURE_TRANSFER_ENERGY:
  case MEASURE_OUTSIDE_ENERGY:
  case MEASURE_EXTERNAL_WORK: return "J";
  case MEASURE_SURFACE_SLOPE: return "deg";
  case MEASURE_RUN_OUT_TIME: return "s";
  case MEASURE_OUTSIDE_REMOVED:
  case MEASURE_OUTSIDE_HELD:
  case MEASURE_ROUGHNESS:
  case MEASURE_ENERGY_BALANCE: return "";
  case MEASURE_REACTION: return "N";
  }
  return "";
}

static PetscErrorCode Sum(const Model *m, PetscReal local, PetscReal *value)
{
  PetscFunctionBeginUser;
  PetscCall(MPIU_Allreduce(&local, value, 1, MPIU_REAL, MPI_SUM, m->comm));
  PetscFunctionReturn(0);
}

static PetscErrorCode TracerValue(const Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  const PointReal field = s->kind == MEASURE_DISPLACEMENT ? POINT_U : POINT_V;
  PetscReal local = 0, x[3];

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->tracers->n; ++p) {
    if (m->tracers->body[p] != index) continue;
    point_place(m->tracers, p, x);
    local = s->kind == MEASURE_POSITION ? x[s->component] : point_real(m->tracers, field, p)[s->component];
  }
  PetscCall(Sum(m, local, value)); /* one rank holds it */
  if (m->memory[index].ended > 0) *value = NAN;
  PetscFunctionReturn(0);
}

static PetscInt body_index(const Case *c, const char *name)
{
  for (PetscInt b = 0; name && b < c->n_bodies; ++b)
    if (!strcmp(c->bodies[b].name, name)) return b;
  return -1;
}

/* Mass of the body in equal parts of [low, high] along an axis (sign -1: turned round); what is less than `low` counts to the first, what is more
 * than `high` to none. */
#define EXTENT_PARTS 64
static PetscErrorCode MassAlong(const Model *m, const MeasureSpec *s, PetscReal sign, PetscReal low, PetscReal high,
                                PetscReal mass[EXTENT_PARTS])
{
  const PetscInt body = body_index(m->c, s->body);
  PetscReal local[EXTENT_PARTS] = {0};

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal at = (sign * point_real(m->points, POINT_X, p)[s->component] - low) / (high - low) * EXTENT_PARTS;
    if ((body >= 0 && m->points->body[p] != body) || at > EXTENT_PARTS) continue;
    local[PetscMin(EXTENT_PARTS - 1, (int)PetscMax(0, at))] += m->points->real[POINT_MASS][p];
  }
  PetscCall(MPIU_Allreduce(local, mass, EXTENT_PARTS, MPIU_REAL, MPIU_SUM, m->comm));
  PetscFunctionReturn(0);
}

/* The place within which all but a share of the mass lies: as good as the farthest point for a front, without its chance. Each round finds the
 * part that holds it. */
static PetscErrorCode InnerExtent(const Model *m, const MeasureSpec *s, PetscReal sign, PetscReal *farthest)
{
  PetscReal low = sign > 0 ? m->grid->min[s->component] : -m->grid->max[s->component], high = *farthest;
  PetscReal mass[EXTENT_PARTS], total = 0, outside = 0;

  PetscFunctionBeginUser;
  for (int round = 0; round < 6 && high > low; ++round) {
    const PetscReal part = (high - low) / EXTENT_PARTS;
    int k = EXTENT_PARTS - 1;
    PetscCall(MassAlong(m, s, sign, low, high, mass));
    for (int i = 0; i < EXTENT_PARTS && !round; ++i) total += mass[i];
    while (k > 0 && outside + mass[k] <= s->beyond * total * (1 + 1e-12)) outside += mass[k--];
    high = low + (PetscReal)(k + 1) * part;
    low += (PetscReal)k * part;
  }
  *farthest = high;
  PetscFunctionReturn(0);
}

static PetscErrorCode ExtentValue(const Model *m, const MeasureSpec *s, PetscReal *value)
{
  const PetscInt body = body_index(m->c, s->body);
  const PetscReal sign = s->maximum ? 1 : -1;
  PetscReal local = -PETSC_MAX_REAL, largest;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    if (body >= 0 && m->points->body[p] != body) continue;
    local = PetscMax(local, sign * point_real(m->points, POINT_X, p)[s->component]);
  }
  PetscCall(MPIU_Allreduce(&local, &largest, 1, MPIU_REAL, MPIU_MAX, m->comm));
  if (s->beyond > 0 && largest > -PETSC_MAX_REAL) PetscCall(InnerExtent(m, s, sign, &largest));
  *value = largest > -PETSC_MAX_REAL ? sign * largest : NAN; /* no point, no place */
  PetscFunctionReturn(0);
}

static PetscReal stored_energy(const Model *m, PetscInt p)
{
  return m->points->real[POINT_VOLUME][p] * model_point_energy(m, p);
}

/* Contribution of one point to a sum. */
static PetscReal point_term(const Model *m, const MeasureSpec *s, PetscInt p)
{
  const PetscReal mass = m->points->real[POINT_MASS][p];
  const PetscReal *x = point_real(m->points, POINT_X, p), *v = point_real(m->points, POINT_V, p);
  const PetscInt i = (s->component + 1) % 3, j = (s->component + 2) % 3;
  PetscReal square = 0;

  switch (s->kind) {
  case MEASURE_MASS: return mass;
  case MEASURE_MOMENTUM: return mass * v[s->component];
  case MEASURE_ANGULAR_MOMENTUM:
    if (m->dim == 2) return mass * (x[0] * v[1] - x[1] * v[0]);
    return mass * (x[i] * v[j] - x[j] * v[i]);
  case MEASURE_KINETIC_ENERGY:
    for (PetscInt d = 0; d < m->dim; ++d) square += v[d] * v[d];
    return 0.5 * mass * square;
  case MEASURE_ELASTIC_ENERGY: return stored_energy(m, p);
  case MEASURE_DISSIPATED_ENERGY: return m->points->real[POINT_WORK][p] - stored_energy(m, p);
  default: return 0;
  }
}

static PetscErrorCode PointSum(const Model *m, const MeasureSpec *s, PetscReal *value)
{
  const PetscInt body = body_index(m->c, s->body);
  PetscReal sum[2] = {0, 0}; /* the last: points */

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    if (body >= 0 && m->points->body[p] != body) continue;
    sum[0] += point_term(m, s, p);
    sum[1] += 1;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, m->comm));
  *value = body >= 0 && sum[1] == 0 && s->kind != MEASURE_MASS
             ? NAN
             : sum[0]; /* of a body that is gone only its mass is known: 0 */
  PetscFunctionReturn(0);
}

/* Angular momentum over inertia about an axis through the centre of mass. */
static PetscErrorCode SpinValue(const Model *m, const MeasureSpec *s, PetscReal *value)
{
  const PetscInt body = body_index(m->c, s->body), dim = m->dim;
  const PetscInt i = dim == 2 ? 0 : (s->component + 1) % 3, j = dim == 2 ? 1 : (s->component + 2) % 3;
  PetscReal q[7] = {0, 0, 0, 0, 0, 0, 0}; /* mass, first moments, momenta, angular momentum, second moment */

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    if (body >= 0 && m->points->body[p] != body) continue;
    const PetscReal mass = m->points->real[POINT_MASS][p];
    const PetscReal *x = point_real(m->points, POINT_X, p), *v = point_real(m->points, POINT_V, p);
    const PetscReal add[7] = {1, x[i], x[j], v[i], v[j], x[i] * v[j] - x[j] * v[i], x[i] * x[i] + x[j] * x[j]};
    for (int k = 0; k < 7; ++k) q[k] += mass * add[k];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, q, 7, MPIU_REAL, MPI_SUM, m->comm));
  const PetscReal momentum = q[5] - (q[1] * q[4] - q[2] * q[3]) / q[0];
  const PetscReal inertia = q[6] - (q[1] * q[1] + q[2] * q[2]) / q[0];
  *value = inertia > 0 ? momentum / inertia : q[0] > 0 ? 0 : NAN;
  PetscFunctionReturn(0);
}

static PetscBool is_flat(const SurfaceProfile *profile)
{
  for (PetscInt i = 0; i < profile->n; ++i)
    if (profile->height[i] != 0) return PETSC_FALSE;
  return PETSC_TRUE;
}

static PetscErrorCode SurfaceValue(const Model *m, const MeasureSpec *s, PetscReal *value)
{
  SurfaceProfile profile;

  PetscFunctionBeginUser;
  PetscCall(SurfaceProfileCreate(m, body_index(m->c, s->body), &profile));
  if (is_flat(&profile)) *value = NAN; /* there is no body */
  else if (s->kind == MEASURE_SURFACE_HEIGHT) *value = surface_height(&profile, s->at);
  else if (s->kind == MEASURE_SURFACE_SLOPE) *value = surface_slope(&profile) * 180 / PETSC_PI;
  else *value = surface_front(&profile);
  PetscCall(SurfaceProfileDestroy(&profile));
  PetscFunctionReturn(0);
}

/* What has come in against where it is now, over the largest of all. */
static PetscErrorCode BalanceValue(Model *m, PetscReal *value)
{
  Energies e;
  PetscReal largest = 0, sum = 0;

  PetscFunctionBeginUser;
  PetscCall(ModelEnergies(m, &e));
  const PetscReal terms[] = {e.kinetic, e.elastic,   e.dissipated, e.damped, e.transfer,
                             e.outside, -e.external, -e.boundary,  -e.start};
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(terms); ++k) {
    sum += terms[k];
    largest = PetscMax(largest, PetscAbsReal(terms[k]));
  }
  *value = largest > 0 ? sum / largest : 0;
  PetscFunctionReturn(0);
}

/* Position of the front, counted outwards. */
static PetscErrorCode FrontValue(const Model *m, const MeasureSpec *s, PetscReal *front)
{
  const MeasureSpec surface = {.kind = MEASURE_SURFACE_FRONT, .body = s->body};

  PetscFunctionBeginUser;
  if (s->front == FRONT_SURFACE) PetscCall(SurfaceValue(m, &surface, front));
  else PetscCall(ExtentValue(m, s, front));
  if (!s->maximum) *front = -*front;
  PetscFunctionReturn(0);
}

PetscErrorCode MeasuresStart(Model *m)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(m->c->n_measures, &m->memory));
  for (PetscInt k = 0; k < m->c->n_measures; ++k)
    if (m->c->measures[k].kind == MEASURE_RUN_OUT_TIME)
      PetscCall(FrontValue(m, &m->c->measures[k], &m->memory[k].front));
  PetscFunctionReturn(0);
}

PetscErrorCode MeasuresRemember(Model *m, PetscReal dt)
{
  PetscReal front;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < m->c->n_measures; ++k) {
    const MeasureSpec *s = &m->c->measures[k];
    if (s->kind != MEASURE_RUN_OUT_TIME) continue;
    PetscCall(FrontValue(m, s, &front));
    if (front - m->memory[k].front > s->speed * dt) m->memory[k].moved = m->time;
    m->memory[k].front = front;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ModelMeasure(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  PetscReal sum[3];

  PetscFunctionBeginUser;
  PetscCall(ModelInitialise(m));
  switch (s->kind) {
  case MEASURE_DISPLACEMENT:
  case MEASURE_POSITION:
  case MEASURE_VELOCITY: PetscCall(TracerValue(m, s, index, value)); break;
  case MEASURE_EXTENT: PetscCall(ExtentValue(m, s, value)); break;
  case MEASURE_EXTERNAL_WORK: *value = m->external_work + m->boundary_work; break;
  case MEASURE_DAMPED_ENERGY: *value = m->damped_energy; break;
  case MEASURE_TRANSFER_ENERGY: *value = m->transfer_energy; break;
  case MEASURE_OUTSIDE_ENERGY: *value = m->outside.energy; break;
  case MEASURE_OUTSIDE_REMOVED: *value = m->outside.removed; break;
  case MEASURE_OUTSIDE_MASS: *value = m->outside.mass; break;
  case MEASURE_OUTSIDE_HELD: *value = m->outside.held_now; break;
  case MEASURE_OUTSIDE_MOMENTUM: *value = m->outside.momentum[s->component]; break;
  case MEASURE_ENERGY_BALANCE: PetscCall(BalanceValue(m, value)); break;
  case MEASURE_SURFACE_FRONT:
  case MEASURE_SURFACE_HEIGHT:
  case MEASURE_SURFACE_SLOPE: PetscCall(SurfaceValue(m, s, value)); break;
  case MEASURE_SPIN: PetscCall(SpinValue(m, s, value)); break;
  case MEASURE_RUN_OUT_TIME: *value = PetscIsNanReal(m->memory[index].front) ? NAN : m->memory[index].moved; break;
  case MEASURE_ROUGHNESS: PetscCall(RoughnessValue(m, value)); break;
  case MEASURE_REACTION:
    PetscCall(BoundarySum(m->boundary, m->grid, s->boundary, m->nodes->reaction, sum));
    *value = sum[s->component];
    break;
  default: PetscCall(PointSum(m, s, value)); break;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ModelCountPoints(const Model *m, PetscInt *n)
{
  PetscFunctionBeginUser;
  PetscCall(MPIU_Allreduce(&m->points->n, n, 1, MPIU_INT, MPI_SUM, m->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelPointStress(const Model *m, PetscInt p, PetscReal sigma[6])
{
  PetscFunctionBeginUser;
  point_tau(m->points, p, sigma);
  for (int k = 0; k < 6; ++k) sigma[k] /= m->points->real[POINT_J][p];
  PetscFunctionReturn(0);
}
