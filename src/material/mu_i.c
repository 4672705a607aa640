/* Dense granular matter whose friction grows with the rate of shear (docs/theory.md, "The mu(I) law"; Jop,
 * Forterre and Pouliquen 2006): Hencky's energy, a circular cone with its apex at no stress, flow without a
 * change of volume.
 *
 *   P = -tr tau / 3,  R = sqrt(s : s / 2),  gamma = sqrt(2 d eps^p : d eps^p) in a step of dt,
 *   R = mu(I) P where it flows,  mu = mu_s + (mu_2 - mu_s) I / (I_0 + I),  I = gamma / dt d sqrt(rho_s / P)
 *
 * The return R = R_tr - G gamma meets that where, with e = R_tr - mu_s P and k = d sqrt(rho_s) / dt,
 *
 *   (e - G gamma) (I_0 sqrt(P) + k gamma) = (mu_2 - mu_s) P k gamma,
 *
 * a quadratic equation whose roots have opposite signs. Endless steps (k = 0, statics) leave R = mu_s P, and what
 * is pulled falls apart. */
#include <math.h>
#include <string.h>
#include "material/algebra/meridian.h"

enum { STATIC, LIMIT, NUMBER, SIZE, GRAINS, GIVEN };

/* Packed. RATE: k; STILL: 1 where no time passes, and nothing flows. */
enum { MU_BULK, MU_SHEAR, MU_STATIC, MU_MORE, MU_NUMBER, MU_LENGTH, MU_RATE, MU_STILL, MU_NOISE };

/* Of points with the pressure P > 0 and the trial R: what is left of R, with derivatives by P and R. */
typedef struct {
  Lanes left, by_P, by_R;
} Flow;

/* gamma from the quadratic, by the form of its root that loses no digits. */
LANES_INLINE void flow(const PetscReal *q, const Lanes *P, const Lanes *R, Flow *f)
{
  const PetscReal G = q[MU_SHEAR], k = q[MU_RATE];
  const Lanes tiny = (Lanes){0} + 1e-300, excess = *R - q[MU_STATIC] * *P;
  Lanes root = {0}, square = {0}, slope; /* set, as compilers want to see that elements are */
  lanes_sqrt(P, &root);
  const Lanes still = q[MU_NUMBER] * root, b = G * still + k * (q[MU_MORE] * *P - excess);
  const Lanes inside = b * b + 4.0 * G * k * excess * still;
  lanes_sqrt(&inside, &square);
  const LaneBits falls = b < 0.0;
  const Lanes far = (square - b) / (2.0 * G * k + tiny), near = 2.0 * excess * still / (b + square + tiny);
  Lanes gamma;
  lanes_select(&falls, &far, &near, &gamma);
  const Lanes more = excess - G * gamma; /* R - mu_s P */
  slope = 2.0 * G * k * gamma + b + tiny;
  const Lanes by_e = (k * gamma + still) / slope;
  const Lanes by_P = -(k * q[MU_MORE] * gamma - q[MU_NUMBER] * more / (2.0 * root + tiny)) / slope;
  f->left = *R - G * gamma;
  f->by_R = 1.0 - G * by_e;
  f->by_P = -G * (by_P - q[MU_STATIC] * by_e);
}

/* Grains that are pulled come apart, others flow. */
LANES_INLINE void fall_back(const PetscReal *q, const Lanes *p, const Lanes *R, Meridian *left, LaneBits *plastic)
{
  const Lanes none = {0}, one = none + 1.0;
  Lanes size, P;
  Flow f;
  lanes_abs(p, &size);
  const Lanes noise = q[MU_NOISE] + 8.0 * PETSC_MACHINE_EPSILON * (*R + size);
  const LaneBits opens = *p > noise, presses = *p<0.0, still = none + q[MU_STILL]> 0.0;
  lanes_select(&presses, &size, &none, &P);
  const LaneBits shears = ~opens & ~still & (*R - q[MU_STATIC] * P > noise);
  *plastic = shears | opens;
  *left = (Meridian){*p, one, one, none, none, one};
  if (!lanes_any(plastic)) return;
  flow(q, &P, R, &f);
  const Meridian flows = {*p, f.left / (*R + 1e-300), one, none, -f.by_P, f.by_R}, apart = {.p = none};
  meridian_take(&shears, &flows, left);
  meridian_take(&opens, &apart, left);
}

LANES_INLINE void mu_i(const PetscReal *q, PetscBool moduli, const Lanes e[3], const Lanes *before, Lanes *after,
                       HenckyReturn *r)
{
  MeridianTrial trial;
  Meridian left;
  meridian_trial(q[MU_BULK], q[MU_SHEAR], e, &trial);
  fall_back(q, &trial.p, &trial.R, &left, &r->plastic);
  meridian_finish(q[MU_BULK], q[MU_SHEAR], moduli, &trial, &left, before, after, r);
}

HENCKY_UPDATE(mu_i, 1)
HENCKY_MIXED(1)

static PetscReal lame(const PetscReal *q) { return q[MU_BULK] - 2.0 / 3.0 * q[MU_SHEAR]; }

static PetscReal energy(const PetscReal *q, const PetscReal *state)
{
  return hencky_energy(lame(q), q[MU_SHEAR], state);
}

static void energies(const PetscReal *q, PetscInt n, PetscInt stride, const PetscReal *state, PetscReal *all)
{
  hencky_energies(lame(q), q[MU_SHEAR], n, stride, state, all);
}

/* PETSC_FALSE where it would flow, or is pulled. */
static PetscBool initial_stress(const PetscReal *q, const PetscReal sigma[6], PetscReal *state)
{
  PetscReal p, R;
  meridian_initial(q[MU_BULK], q[MU_SHEAR], sigma, state, &p, &R);
  const PetscReal noise = q[MU_NOISE] + 8.0 * PETSC_MACHINE_EPSILON * (R + fabs(p));
  return R + q[MU_STATIC] * p <= noise && p <= noise;
}

static PetscBool bear(const PetscReal *q, const PetscReal tau[6], PetscReal *state)
{
  return hencky_bear(lame(q), q[MU_SHEAR], tau, state);
}

static VolumeLaw volume_law(const PetscReal *q)
{
  (void)q;
  return VOLUME_COUPLED;
}

static void prepare(const Elasticity *elastic, const PetscReal *given, PetscReal *q)
{
  q[MU_BULK] = elastic->bulk;
  q[MU_SHEAR] = elastic->shear;
  q[MU_STATIC] = given[STATIC];
  q[MU_MORE] = given[LIMIT] - given[STATIC];
  q[MU_NUMBER] = given[NUMBER];
  q[MU_LENGTH] = given[SIZE] * sqrt(given[GRAINS]);
  q[MU_RATE] = 0.0;
  q[MU_STILL] = 1.0; /* until it is told of a step */
  q[MU_NOISE] = 8.0 * PETSC_MACHINE_EPSILON * (1.0 + given[STATIC]) * (elastic->lame + 2.0 * elastic->shear);
}

static void step(PetscReal time, PetscReal dt, PetscReal *q)
{
  (void)time;
  q[MU_STILL] = dt > 0.0 ? 0.0 : 1.0;
  q[MU_RATE] = dt > 0.0 ? q[MU_LENGTH] / dt : 0.0;
}

/* Both frictions over the factor. */
static void reduce(const PetscReal *given, PetscReal factor, PetscReal *reduced)
{
  memcpy(reduced, given, GIVEN * sizeof *reduced);
  for (int k = STATIC; k <= LIMIT; ++k) reduced[k] = factor > 0.0 ? given[k] / factor : 1e10;
}

static const char *check(const PetscReal *given)
{
  return given[LIMIT] < given[STATIC] ? "the friction of fast flow must not be smaller than that of slow flow" : NULL;
}

static const LawParameter parameters[] = {
  {"static_friction", "", "friction of endlessly slow flow, mu_s: the tangent of its angle in simple shear", 0, 10,
   .fallback = NAN},
  {"limit_friction", "", "friction of the fastest flow, mu_2", 0, 10, .fallback = NAN},
  {"inertial_number", "", "I_0, at which friction is halfway between them", 0, PETSC_MAX_REAL, .min_open = PETSC_TRUE,
   .fallback = 0.279},
  {"grain_size", "m", "diameter of the grains, d", 0, PETSC_MAX_REAL, .min_open = PETSC_TRUE, .fallback = NAN},
  {"grain_density", "kg/m3", "density of a grain, rho_s", 0, PETSC_MAX_REAL, .min_open = PETSC_TRUE, .fallback = NAN},
  {.name = NULL},
};

static const LawField fields[] = {
  HENCKY_FIELDS,
  {.name = NULL},
};

const Law law_mu_i = {
  .name = "mu-i",
  .help = "Hencky solid of grains whose friction grows with the rate of shear, mu(I); no cohesion, no dilatancy",
  .parameters = parameters,
  .fields = fields,
  .n_state = 7,
  .symmetric = PETSC_FALSE,
  .yields = PETSC_TRUE,
  .spares_state = PETSC_TRUE,
  .update = update,
  .march_plane = mu_i_march_plane,
  .march_space = mu_i_march_space,
  .energy = energy,
  .energies = energies,
  .initial_stress = initial_stress,
  .bear = bear,
  .volume = volume,
  .volume_law = volume_law,
  .scale = scale,
  .prepare = prepare,
  .reduce = reduce,
  .check = check,
  .step = step,
  .rate = PETSC_TRUE,
};
