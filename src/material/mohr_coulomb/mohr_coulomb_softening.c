/* Mohr-Coulomb material whose friction, dilatancy and cohesion harden and soften with the plastic
 * shear strain (docs/theory.md, "Laws"): mohr_coulomb.c with the strength of
 * mohr_coulomb_softening.h, implicit in it.
 *
 * A body that softens fails in a band as wide as a cell, whatever its size: the strains of the
 * table are those of a cell of `reference_size`, and a point in a cell of another size h runs
 * through it h / reference_size times as fast, so that the work of failure per area of the band
 * stays the same. */
#include "material/algebra/hencky.h"
#include "material/mohr_coulomb/mohr_coulomb_lanes.h"
#include "material/mohr_coulomb/mohr_coulomb_softening.h"
#include "material/strength.h"

enum {
  RESIDUAL_FRICTION = STRENGTH_N,
  RESIDUAL_DILATANCY,
  RESIDUAL_COHESION,
  INITIAL_FRICTION,
  INITIAL_DILATANCY,
  INITIAL_COHESION,
  PEAK_STRAIN,
  RESIDUAL_STRAIN,
  REFERENCE_SIZE,
  NONLOCAL_LENGTH,
  NONLOCAL_WEIGHT,
  GIVEN
};

/* Scalars of the state. */
enum { KAPPA, SCALE, OFFSET, SCALARS };

#define ALONE (-1.0) /* offset of a point that has heard of no others: its strain is its own */

/* How a point enters the table. With a weight above 1 its own strain takes from a nonlocal one: past the peak it
 * hardens by that within a step, before the peak it would soften. There its strength is that of the step's start. */
static inline SoftScale soft_scale(const PetscReal *q, PetscReal own, PetscReal scale, PetscReal heard)
{
  const PetscReal share = 1.0 - q[SOFT_WEIGHT], x = heard + share * own;
  if (heard < 0.0) return (SoftScale){scale, 0.0};
  return x < q[SOFT_PEAK] ? (SoftScale){0.0, x} : (SoftScale){share, heard};
}

/* One point: what the lanes need of it. */
LANES_INLINE int soften_point(const PetscReal *q, PetscBool moduli, int l, const Lanes e[3], const Lanes *before,
                              Lanes *after, SoftStrength *at, HenckyReturn *r)
{
  const PetscReal strain[3] = {e[0][l], e[1][l], e[2][l]};
  const SoftScale scale = soft_scale(q, before[KAPPA][l], before[SCALE][l], before[OFFSET][l]);
  PetscReal elastic[3], D[9];
  SoftTry t;
  const PetscReal kappa = soft_return(q, before[KAPPA][l], scale, strain, at, &t);
  mc_compliance(at->p, t.tau, elastic);
  after[KAPPA][l] = kappa;
  r->good[l] = isfinite(kappa) ? -1 : 0;
  for (int k = 0; k < 3; ++k) {
    r->tau[k][l] = t.tau[k];
    r->elastic[k][l] = elastic[k];
  }
  if (!moduli) return t.region;
  soft_moduli(q, at, &t, D);
  for (int k = 0; k < 9; ++k) r->D[k][l] = D[k];
  return t.region;
}

LANES_INLINE void soften(const PetscReal *q, PetscBool moduli, const Lanes e[3], const Lanes *before, Lanes *after,
                         HenckyReturn *r)
{
  SoftStrength at = {.x = NAN};
  LaneBits regions;
  after[SCALE] = before[SCALE];
  after[OFFSET] = before[OFFSET];
  for (int l = 0; l < LANES; ++l) regions[l] = soften_point(q, moduli, l, e, before, after, &at, r);
  r->plastic = regions != MC_ELASTIC;
  for (int k = 0; moduli && k < 3; ++k) {
    const int a = k == 2 ? 0 : k, b = k == 2 ? 2 : k + 1;
    const Lanes x = e[a] - e[b], rise = r->tau[a] - r->tau[b];
    LaneBits kept = regions == MC_ELASTIC;
    if (a == 1) kept |= regions == MC_CUT_PLANE;
    mc_difference_lanes(at.p, &kept, &x, &rise, &r->r[k]);
  }
}

HENCKY_UPDATE(soften, SCALARS)
HENCKY_MIXED(SCALARS)

static PetscReal energy(const PetscReal *q, const PetscReal *state)
{
  return hencky_energy(q[SOFT_LAMBDA], q[SOFT_MU], state);
}

static void energies(const PetscReal *q, PetscInt n, PetscInt stride, const PetscReal *state, PetscReal *all)
{
  hencky_energies(q[SOFT_LAMBDA], q[SOFT_MU], n, stride, state, all);
}

/* PETSC_FALSE outside the yield surface of the start. */
static PetscBool initial_stress(const PetscReal *q, const PetscReal sigma[6], PetscReal *state)
{
  SoftStrength at = {.x = NAN};
  PetscReal tau[3];
  hencky_stress(q[SOFT_LAMBDA], q[SOFT_MU], sigma, tau, state);
  state[6 + KAPPA] = 0.0;
  state[6 + SCALE] = 1.0;
  state[6 + OFFSET] = ALONE;
  soft_strength(q, 0.0, &at);
  const PetscReal noise = mc_noise(at.p, tau);
  return mc_yield(at.p, tau) <= noise && tau[0] - at.p[MC_CUT] <= noise;
}

static PetscBool bear(const PetscReal *q, const PetscReal tau[6], PetscReal *state)
{
  return hencky_bear(q[SOFT_LAMBDA], q[SOFT_MU], tau, state);
}

static void size(const PetscReal *q, PetscReal h, PetscReal *state)
{
  state[6 + SCALE] = q[SOFT_SIZE] > 0.0 ? h / q[SOFT_SIZE] : 1.0;
}

/* The offset of a nonlocal strain follows by a step. */
static PetscReal passed(const PetscReal *q, const PetscReal *before, const PetscReal *state)
{
  const PetscReal strain[3] = {0.0, q[SOFT_PEAK], q[SOFT_RESIDUAL]}, heard = before[6 + OFFSET],
                  own = before[6 + KAPPA];
  const PetscReal scale = heard < 0.0 ? before[6 + SCALE] : 1.0, way = scale * (state[6 + KAPPA] - own);
  const PetscReal from = heard < 0.0 ? scale * own : heard + (1.0 - q[SOFT_WEIGHT]) * own;
  PetscReal most = 0.0;
  for (int k = 0; k < 2; ++k) {
    PetscBool changes = PETSC_FALSE;
    for (int column = SOFT_PHI; column < SOFT_PEAK; column += 3) changes |= q[column + k] != q[column + k + 1];
    if (changes && way > 0.0 && from < strain[k + 1] && from + way > strain[k])
      most = fmax(most, way / (strain[k + 1] - strain[k]));
  }
  return most;
}

static PetscReal reach(const PetscReal *q) { return q[SOFT_LENGTH]; }

static void hear(const PetscReal *q, PetscReal mean, PetscReal *state) { state[6 + OFFSET] = q[SOFT_WEIGHT] * mean; }

/* Its strength changes: never apart from the pressure, but without friction, dilatancy and
 * cut-off. */
static VolumeLaw volume_law(const PetscReal *q)
{
  for (int k = 0; k < 6; ++k)
    if (q[SOFT_PHI + k] != 0.0) return VOLUME_COUPLED;
  return q[SOFT_CUT] == INFINITY ? VOLUME_LOG : VOLUME_COUPLED;
}

static PetscReal or_peak(PetscReal value, PetscReal peak) { return isnan(value) ? peak : value; }

static void column(PetscReal initial, PetscReal peak, PetscReal residual, PetscReal *at)
{
  at[0] = or_peak(initial, peak);
  at[1] = peak;
  at[2] = or_peak(residual, peak);
}

static void prepare(const Elasticity *elastic, const PetscReal *given, PetscReal *q)
{
  q[SOFT_LAMBDA] = elastic->lame;
  q[SOFT_MU] = elastic->shear;
  column(given[INITIAL_FRICTION], given[FRICTION], given[RESIDUAL_FRICTION], q + SOFT_PHI);
  column(given[INITIAL_DILATANCY], given[DILATANCY], given[RESIDUAL_DILATANCY], q + SOFT_PSI);
  column(given[INITIAL_COHESION], given[COHESION], given[RESIDUAL_COHESION], q + SOFT_COHESION);
  q[SOFT_PEAK] = given[PEAK_STRAIN];
  q[SOFT_RESIDUAL] = given[RESIDUAL_STRAIN];
  q[SOFT_CUT] = given[CUTOFF] < NO_CUTOFF ? given[CUTOFF] : INFINITY;
  q[SOFT_SIZE] = given[REFERENCE_SIZE];
  q[SOFT_LENGTH] = given[NONLOCAL_LENGTH];
  q[SOFT_WEIGHT] = given[NONLOCAL_WEIGHT];
}

static const char *check(const PetscReal *given)
{
  PetscReal q[SOFT_N];
  prepare(&(Elasticity){.shear = 1.0}, given, q);
  for (int k = 0; k < 3; ++k)
    if (q[SOFT_PSI + k] > q[SOFT_PHI + k])
      return "the dilatancy angle must not be larger than the friction angle: initially, at the peak and at the end";
  if (given[NONLOCAL_LENGTH] > 0.0 && given[REFERENCE_SIZE] > 0.0)
    return "nonlocal_length and reference_size are two ways to the same end: give one of them";
  return given[RESIDUAL_STRAIN] <= given[PEAK_STRAIN] ? "residual_strain must be larger than peak_strain" : NULL;
}

/* All strengths of the table over the factor. */
static void reduce(const PetscReal *given, PetscReal factor, PetscReal *reduced)
{
  strength_reduce(GIVEN, given, factor, reduced);
  if (factor == 1.0) return;
  for (int k = RESIDUAL_FRICTION; k < PEAK_STRAIN; k += 3) {
    for (int i = 0; i < 3; ++i) reduced[k + i] = or_peak(given[k + i], given[FRICTION + i]);
    strength_divide(factor, &reduced[k], &reduced[k + 1], &reduced[k + 2]);
  }
}

#define ANGLE(name, help, ...)                                    \
  {                                                               \
    name, "deg", help, 0, 90, .max_open = PETSC_TRUE, __VA_ARGS__ \
  }

static const LawParameter parameters[] = {
  STRENGTH_PARAMETERS,
  {"tension_cutoff", "Pa", "largest principal tension; 1e300: none but the apex", 0, PETSC_MAX_REAL,
   .fallback = NO_CUTOFF},
  ANGLE("residual_friction_angle", "angle of friction that is left", .fallback = NAN, .absent = "friction_angle"),
  ANGLE("residual_dilatancy_angle", "dilatancy angle that is left", .fallback = 0),
  {"residual_cohesion", "Pa", "cohesion that is left", 0, PETSC_MAX_REAL, .fallback = NAN, .absent = "cohesion"},
  ANGLE("initial_friction_angle", "angle of friction before any flow", .fallback = NAN, .absent = "friction_angle"),
  ANGLE("initial_dilatancy_angle", "dilatancy angle before any flow", .fallback = NAN, .absent = "dilatancy_angle"),
  {"initial_cohesion", "Pa", "cohesion before any flow", 0, PETSC_MAX_REAL, .fallback = NAN, .absent = "cohesion"},
  {"peak_strain", "", "plastic strain at which friction_angle, dilatancy_angle and cohesion are reached", 0,
   PETSC_MAX_REAL, .fallback = 0},
  {"residual_strain", "", "plastic strain from which on the residual values hold", 0, PETSC_MAX_REAL,
   .min_open = PETSC_TRUE, .fallback = NAN},
  {"reference_size", "m", "size of the cells for which both strains hold; 0: they hold in all, and depend on the mesh",
   0, PETSC_MAX_REAL, .fallback = 0},
  {"nonlocal_length", "m",
   "radius around a point over which its plastic strain is averaged, on any mesh; 0: none. Four cells or more", 0,
   PETSC_MAX_REAL, .fallback = 0},
  {"nonlocal_weight", "", "share m of the mean in the strain that softens, 1 - m being that of the point itself", 1, 10,
   .fallback = 2},
  {.name = NULL},
};

static const LawField fields[] = {
  HENCKY_FIELDS,
  {"softening_scale", "", "size of the point's cell over reference_size", 1, {1}},
  {"softening_offset",
   "",
   "nonlocal_weight times the mean plastic strain around the point; -1: it is alone",
   1,
   {ALONE}},
  {.name = NULL},
};

const Law law_mohr_coulomb_softening = {
  .name = "mohr-coulomb-softening",
  .help = "mohr-coulomb with friction, dilatancy and cohesion that change with the plastic shear strain",
  .parameters = parameters,
  .fields = fields,
  .n_state = 6 + SCALARS,
  .symmetric = PETSC_FALSE,
  .yields = PETSC_TRUE,
  .spares_state = PETSC_TRUE,
  .update = update,
  .march_plane = soften_march_plane,
  .march_space = soften_march_space,
  .energy = energy,
  .energies = energies,
  .initial_stress = initial_stress,
  .bear = bear,
  .size = size,
  .followed = 6 + KAPPA,
  .passed = passed,
  .reach = reach,
  .hear = hear,
  .volume = volume,
  .volume_law = volume_law,
  .scale = scale,
  .prepare = prepare,
  .reduce = reduce,
  .check = check,
};
