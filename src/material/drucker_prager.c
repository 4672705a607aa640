/* Drucker-Prager material in large strains (docs/theory.md, "Laws"): Hencky's energy, a circular
 * cone in the space of Kirchhoff stresses that meets Mohr-Coulomb's pyramid where `match` says, a
 * non-associated flow, and a largest mean tension.
 *
 *   p = tr tau / 3,  R = sqrt(s : s / 2),  f = R + eta p - xi c <= 0,  p <= T <= xi c / eta
 *   d eps^p = gamma (s / 2R + etabar I / 3)                on the cone
 *
 *   CONE    p = p_tr - K etabar gamma, R = R_tr - mu gamma, gamma = f_tr / (mu + K eta etabar)
 *   CAP     p = T, the shear stress as it is
 *   CORNER  p = T, R = xi c - eta T: with T = xi c / eta the apex, where R = 0
 *
 * All three keep the direction of s. At the corner the flow is one of both surfaces; with etabar
 * = 0 no flow of the cone leads to the apex, which is then the return by definition, as of
 * Mohr-Coulomb. */
#include "material/algebra/meridian.h"
#include "material/strength.h"

enum { MATCH = STRENGTH_N, GIVEN };

/* Packed. */
enum { DP_BULK, DP_MU, DP_ETA, DP_ETABAR, DP_XI_C, DP_CAP, DP_CORNER, DP_NOISE };

enum { MATCH_COMPRESSION, MATCH_EXTENSION, MATCH_PLANE_STRAIN };

LANES_INLINE void fall_back(const PetscReal *q, const Lanes *p, const Lanes *R, Meridian *m, LaneBits *plastic)
{
  const Lanes none = {0}, one = none + 1.0, T = none + q[DP_CAP];
  const PetscReal K = q[DP_BULK], mu = q[DP_MU], a = 1.0 / (mu + K * q[DP_ETA] * q[DP_ETABAR]);
  const Lanes f = *R + q[DP_ETA] * *p - q[DP_XI_C];
  Lanes size;
  lanes_abs(p, &size);
  const Lanes noise = q[DP_NOISE] + 8.0 * PETSC_MACHINE_EPSILON * (*R + size + q[DP_XI_C]);
  const LaneBits shears = f > noise, opens = *p - T > noise;
  *plastic = shears | opens;
  *m = (Meridian){*p, one, one, none, none, one};
  if (!lanes_any(plastic)) return;
  const Lanes safe = *R + 1e-300, p_cone = *p - K * q[DP_ETABAR] * a * f;
  const Meridian cone = {p_cone,
                         (*R - mu * a * f) / safe,
                         none + (1.0 - K * q[DP_ETA] * q[DP_ETABAR] * a),
                         none - K * q[DP_ETABAR] * a,
                         none - mu * q[DP_ETA] * a,
                         none + (1.0 - mu * a)};
  const Meridian cap = {T, one, none, none, none, one}, corner = {T, q[DP_CORNER] / safe, none, none, none, none};
  const LaneBits beyond = (opens & ~shears) | (shears & (p_cone > T)), capped = beyond & (*R < q[DP_CORNER]);
  meridian_take(&shears, &cone, m);
  meridian_take(&beyond, &corner, m);
  meridian_take(&capped, &cap, m);
}

LANES_INLINE void drucker_prager(const PetscReal *q, PetscBool moduli, const Lanes e[3], const Lanes *before,
                                 Lanes *after, HenckyReturn *r)
{
  MeridianTrial trial;
  Meridian left;
  meridian_trial(q[DP_BULK], q[DP_MU], e, &trial);
  fall_back(q, &trial.p, &trial.R, &left, &r->plastic);
  meridian_finish(q[DP_BULK], q[DP_MU], moduli, &trial, &left, before, after, r);
}

HENCKY_UPDATE(drucker_prager, 1)
HENCKY_MIXED(1)

static PetscReal lame(const PetscReal *q) { return q[DP_BULK] - 2.0 / 3.0 * q[DP_MU]; }

static PetscReal energy(const PetscReal *q, const PetscReal *state) { return hencky_energy(lame(q), q[DP_MU], state); }

static void energies(const PetscReal *q, PetscInt n, PetscInt stride, const PetscReal *state, PetscReal *all)
{
  hencky_energies(lame(q), q[DP_MU], n, stride, state, all);
}

/* PETSC_FALSE outside the yield surface. */
static PetscBool initial_stress(const PetscReal *q, const PetscReal sigma[6], PetscReal *state)
{
  PetscReal p, R;
  meridian_initial(q[DP_BULK], q[DP_MU], sigma, state, &p, &R);
  const PetscReal noise = q[DP_NOISE] + 8.0 * PETSC_MACHINE_EPSILON * (R + fabs(p) + q[DP_XI_C]);
  return R + q[DP_ETA] * p - q[DP_XI_C] <= noise && p - q[DP_CAP] <= noise;
}

static PetscBool bear(const PetscReal *q, const PetscReal tau[6], PetscReal *state)
{
  return hencky_bear(lame(q), q[DP_MU], tau, state);
}

/* Without friction, dilatancy and cut-off (von Mises) the flow neither feels the pressure nor
 * changes the volume. */
static VolumeLaw volume_law(const PetscReal *q)
{
  return q[DP_ETA] == 0.0 && q[DP_ETABAR] == 0.0 && q[DP_CAP] == INFINITY ? VOLUME_LOG : VOLUME_COUPLED;
}

static PetscBool associated(const PetscReal *q) { return q[DP_ETA] == q[DP_ETABAR]; }

/* Slope of the cone through the edges of Mohr-Coulomb's pyramid in compression (-1) or extension
 * (1); times cot phi: its xi. */
static PetscReal edge_slope(PetscReal angle, PetscReal side)
{
  return 6.0 * sin(angle) / (sqrt(3.0) * (3.0 + side * sin(angle)));
}

/* The cones of phi and psi. In plane strain flow goes on with s_zz = -2/3 etabar R, and there the
 * cone is to have Mohr-Coulomb's limit and its dilatancy. */
static void cones(const PetscReal *given, PetscReal *eta, PetscReal *etabar, PetscReal *xi)
{
  const PetscReal s = sin(given[FRICTION]), d = sin(given[DILATANCY]), c = cos(given[FRICTION]);
  const PetscReal side = given[MATCH] == MATCH_EXTENSION ? 1.0 : -1.0;
  if (given[MATCH] == MATCH_PLANE_STRAIN) {
    *etabar = d / sqrt(1.0 + d * d / 3.0);
    const PetscReal both = sqrt(1.0 - *etabar * *etabar / 3.0) + s * *etabar / 3.0;
    *eta = s / both;
    *xi = c / both;
  } else {
    *etabar = edge_slope(given[DILATANCY], side);
    *eta = edge_slope(given[FRICTION], side);
    *xi = 6.0 * c / (sqrt(3.0) * (3.0 + side * s));
  }
}

/* That limit of any cone, by the same s_zz (docs/theory.md): R (1 - eta etabar / 3) + eta p = xi c of the plane's p,
 * whose circle has the radius R sqrt(1 - etabar^2 / 3). */
static void in_plane(const PetscReal *given, PetscReal strength[2])
{
  PetscReal eta, etabar, xi;
  cones(given, &eta, &etabar, &xi);
  const PetscReal longer = sqrt(1.0 - etabar * etabar / 3.0) / (1.0 - eta * etabar / 3.0);
  strength[0] = asin(PetscMin(eta * longer, 1.0));
  strength[1] = xi * longer * given[COHESION] / cos(strength[0]);
}

static void prepare(const Elasticity *elastic, const PetscReal *given, PetscReal *q)
{
  PetscReal xi;
  q[DP_BULK] = elastic->bulk;
  q[DP_MU] = elastic->shear;
  cones(given, &q[DP_ETA], &q[DP_ETABAR], &xi);
  q[DP_XI_C] = xi * given[COHESION];
  const PetscReal apex = q[DP_ETA] > 0.0 ? q[DP_XI_C] / q[DP_ETA] : INFINITY;
  const PetscBool cut = given[CUTOFF] < NO_CUTOFF && given[CUTOFF] < apex ? PETSC_TRUE : PETSC_FALSE;
  q[DP_CAP] = cut ? given[CUTOFF] : apex;
  q[DP_CORNER] = cut ? q[DP_XI_C] - q[DP_ETA] * given[CUTOFF] : 0.0;
  q[DP_NOISE] = 8.0 * PETSC_MACHINE_EPSILON * (1.0 + q[DP_ETA]) * (elastic->lame + 2.0 * elastic->shear);
}

static void reduce(const PetscReal *given, PetscReal factor, PetscReal *reduced)
{
  strength_reduce(GIVEN, given, factor, reduced);
}

static const LawWord compression = {"compression", "triaxial compression: the outer edges of the pyramid"};
static const LawWord extension = {"extension", "triaxial extension: its inner edges"};
static const LawWord plane_strain = {"plane-strain",
                                     "the limit of plane strain, with the dilatancy angle that is given"};
static const LawWord *const matches[] = {&compression, &extension, &plane_strain, NULL};

static const LawParameter parameters[] = {
  STRENGTH_PARAMETERS,
  {"tension_cutoff", "Pa", "largest mean tension; 1e300: none but the apex", 0, PETSC_MAX_REAL, .fallback = NO_CUTOFF},
  {"match", "", "where the cone has the strength of Mohr-Coulomb: in plane strain take `plane-strain`", 0, 2,
   .fallback = MATCH_COMPRESSION, .words = matches},
  {.name = NULL},
};

static const LawField fields[] = {
  HENCKY_FIELDS,
  {.name = NULL},
};

const Law law_drucker_prager = {
  .name = "drucker-prager",
  .help = "Hencky solid with Drucker-Prager plasticity, non-associated, a cone that meets Mohr-Coulomb's pyramid",
  .parameters = parameters,
  .fields = fields,
  .n_state = 7,
  .associated = associated,
  .yields = PETSC_TRUE,
  .spares_state = PETSC_TRUE,
  .update = update,
  .march_plane = drucker_prager_march_plane,
  .march_space = drucker_prager_march_space,
  .energy = energy,
  .energies = energies,
  .initial_stress = initial_stress,
  .bear = bear,
  .volume = volume,
  .volume_law = volume_law,
  .scale = scale,
  .prepare = prepare,
  .reduce = reduce,
  .in_plane = in_plane,
  .check = strength_check,
};
