/* J2 plasticity in large strains (thesis section 3.2, algorithm 3): radial return on the
 * volume-preserving elastic left Cauchy-Green tensor bbar, with linear isotropic hardening.
 *
 *   tau = q I + s,  q = J U'(J),  s = mu dev bbar
 *   f   = |s| - sqrt(2/3) (sigma_Y + H alpha) <= 0
 *   c   = c_vol + (1 - beta1) c_dev - 2 mubar n x (beta3 n + beta4 dev n^2)     (thesis 3.93, not
 *   symmetrised)
 *
 * with mubar = mu tr bbar / 3 and c_dev = 2 mubar (I_sym - I x I / 3) - 2/3 |s| (n x I + I x n) of
 * the trial state. State: bbar, J, alpha. What is kept of bbar beside s is its determinant, 1, and not its
 * trace as in the thesis, with which the shear modulus mu tr bbar / 3 would grow by 1 + 2/3 alpha sigma_Y / mu.
 * Volumetric laws as in neo_hookean_split.c: j2 with p = K (J - 1), j2-log with p = K ln J / J. */
#include "material/algebra/volume.h"

enum { YIELD = SPLIT_N, HARDENING };

#define N_STATE 8 /* bbar, J, alpha */

/* |s| of a deviator, and 1 / |s| (0 for 0). */
LANES_INLINE void norm_of(const Lanes s[6], Lanes *norm, Lanes *inverse)
{
  const Lanes norm2 = s[0] * s[0] + s[1] * s[1] + s[2] * s[2] + 2.0 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]);
  lanes_sqrt(&norm2, norm);
  const LaneBits some = *norm > 0.0;
  const Lanes full = 1.0 / *norm, none = {0};
  lanes_select(&some, &full, &none, inverse);
}

/* Plastic multiplier, and x = 1 / (1 + H / 3 mubar) where there is flow (else 0). Rounding does not
 * flow. */
LANES_INLINE void flow_of(const PetscReal *parameters, const Lanes *norm, const Lanes *mubar, const Lanes *alpha,
                          Lanes *gamma, Lanes *x)
{
  const PetscReal H = parameters[HARDENING], root = sqrt(2.0 / 3.0);
  const Lanes f = *norm - root * (parameters[YIELD] + H * *alpha);
  const Lanes slope = *mubar / (*mubar + H / 3.0), full = 0.5 * f / *mubar * slope, none = {0};
  const LaneBits plastic = f > 16.0 * PETSC_MACHINE_EPSILON * *mubar;
  lanes_select(&plastic, &full, &none, gamma);
  lanes_select(&plastic, &slope, &none, x);
}

/* Where there is flow, the isotropic part x of bbar that has, with its deviator d, the determinant 1: x^3 - j2 x + j3
 * is convex above its largest root, and the trace of before leads to a larger one, so that Newton comes down to it. A
 * lane stands still once it is there, whatever its neighbours do. */
LANES_INLINE void keep_volume(const Lanes *flow, const Lanes *mean, Lanes bbar[6])
{
  Lanes d[6], j3, x = *mean;
  for (int k = 0; k < 6; ++k) d[k] = bbar[k] - (k < 3 ? x : 0.0 * x);
  const Lanes j2 = 0.5 * (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) + d[3] * d[3] + d[4] * d[4] + d[5] * d[5];
  lanes_sym_det(d, &j3);
  LaneBits active = *flow > 0.0;
  for (int iteration = 0; iteration < 50 && lanes_any(&active); ++iteration) {
    const Lanes x2 = x * x, next = x - (x2 * x - j2 * x + j3 - 1.0) / (3.0 * x2 - j2), way = x - next;
    lanes_select(&active, &next, &x, &x);
    active &= way > 4.0 * PETSC_MACHINE_EPSILON * x;
  }
  for (int k = 0; k < 3; ++k) bbar[k] += x - *mean;
}

/* c = a I x I + 2 g I_sym + r (n x I + I x n) + n x w of one point. */
LANES_INLINE void tangent_point(const PetscReal point[15], PetscReal *c)
{
  const PetscReal *n = point, *w = point + 6, a = point[12], g = point[13], r = point[14];
  PetscReal row[6];
  for (int k = 0; k < 6; ++k) row[k] = w[k] + (k < 3 ? r : 0.0);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      const PetscReal identity = i < 3 ? r * n[j] + (j < 3 ? a : 0.0) : 0.0;
      c[6 * i + j] = n[i] * row[j] + identity + (i == j ? (i < 3 ? 2.0 * g : g) : 0.0);
    }
}

/* Trial norm, direction, mubar; multiplier and x: everything that c needs. */
typedef struct {
  Lanes q, dq, norm, n[6], mubar, gamma, x;
} Return;

LANES_INLINE void tangent_lanes(const Return *t, PetscInt count, PetscReal *c)
{
  const Lanes *n = t->n, ratio = t->norm / t->mubar;
  const Lanes beta1 = ratio * 0.0 + 2.0 * t->mubar * t->gamma / (t->norm + 1e-300);
  const Lanes beta3 = t->x - beta1 + (2.0 / 3.0) * (1.0 - t->x) * ratio * t->gamma;
  const Lanes beta4 = (t->x - beta1) * ratio, u = (1.0 - beta1) * t->mubar;
  PetscReal point[LANES * 15];
  Lanes all[15], n2[6];
  n2[0] = n[0] * n[0] + n[3] * n[3] + n[5] * n[5];
  n2[1] = n[3] * n[3] + n[1] * n[1] + n[4] * n[4];
  n2[2] = n[5] * n[5] + n[4] * n[4] + n[2] * n[2];
  n2[3] = n[0] * n[3] + n[3] * n[1] + n[5] * n[4];
  n2[4] = n[3] * n[5] + n[1] * n[4] + n[4] * n[2];
  n2[5] = n[5] * n[0] + n[4] * n[3] + n[2] * n[5];
  const Lanes mean = (n2[0] + n2[1] + n2[2]) / 3.0;
  for (int k = 0; k < 6; ++k) {
    all[k] = n[k];
    all[6 + k] = -2.0 * t->mubar * (beta3 * n[k] + beta4 * (k < 3 ? n2[k] - mean : n2[k]));
  }
  all[12] = t->dq - (2.0 / 3.0) * u;
  all[13] = u - t->q;
  all[14] = (-2.0 / 3.0) * (1.0 - beta1) * t->norm;
  lanes_store(15, LANES, all, point);
  for (PetscInt l = 0; l < count; ++l) tangent_point(point + 15 * l, c + 36 * l);
}

LANES_INLINE LawStatus update_lanes(const PetscReal *parameters, PetscInt n, const PetscReal *dF, const PetscReal *old,
                                    PetscReal *state, PetscReal *tau, PetscReal *c)
{
  const PetscReal mu = parameters[SPLIT_SHEAR];
  Lanes f[9], now[N_STATE], b[6], s[6], t[7], det_f, root, inverse;
  Return r;
  lanes_load(9, n, dF, f);
  lanes_load(N_STATE, n, old, now);
  lanes_push_forward(f, now, b);
  lanes_det(f, &det_f);
  lanes_cbrt(&det_f, &root);
  now[6] *= det_f;
  volume_lanes(parameters, &now[6], &r.q, &r.dq);
  for (int k = 0; k < 6; ++k) b[k] /= root * root;
  const Lanes mean = (b[0] + b[1] + b[2]) / 3.0;
  r.mubar = mu * mean;
  for (int k = 0; k < 6; ++k) s[k] = mu * (k < 3 ? b[k] - mean : b[k]);
  norm_of(s, &r.norm, &inverse);
  flow_of(parameters, &r.norm, &r.mubar, &now[7], &r.gamma, &r.x);
  for (int k = 0; k < 6; ++k) {
    r.n[k] = s[k] * inverse;
    const Lanes back = 2.0 * r.mubar * r.gamma * r.n[k];
    now[k] = b[k] - back / mu;
    t[k] = s[k] - back + (k < 3 ? r.q : 0.0 * r.q);
  }
  keep_volume(&r.gamma, &mean, now);
  now[7] += sqrt(2.0 / 3.0) * r.gamma;
  lanes_store(N_STATE, n, now, state);
  lanes_store(6, n, t, tau);
  if (c) tangent_lanes(&r, n < LANES ? n : LANES, c);
  t[6] = r.dq + r.mubar;
  return lanes_status(&det_f, 7, t);
}

static LawStatus update(const PetscReal *parameters, PetscInt n, const PetscReal *dF, const PetscReal *old,
                        PetscReal *state, PetscReal *tau, PetscReal *c)
{
  return lanes_update(update_lanes, N_STATE, parameters, n, dF, old, state, tau, c);
}

static PetscReal energy(const PetscReal *parameters, const PetscReal *state)
{
  const PetscReal shape = state[0] + state[1] + state[2] - 3.0;
  return volume_energy(split_volume(parameters), parameters[SPLIT_BULK], state[6]) +
         0.5 * parameters[SPLIT_SHEAR] * shape;
}

/* PETSC_FALSE outside the yield surface. */
static PetscBool initial_stress(const PetscReal *parameters, const PetscReal sigma[6], PetscReal *state)
{
  const PetscReal mean = (sigma[0] + sigma[1] + sigma[2]) / 3.0, mu = parameters[SPLIT_SHEAR];
  const PetscReal J = volume_from_pressure(split_volume(parameters), parameters[SPLIT_BULK], mean);
  PetscReal norm2 = 0.0;
  for (int k = 0; k < 6; ++k) norm2 += (k < 3 ? 1.0 : 2.0) * pow(sigma[k] - (k < 3 ? mean : 0.0), 2);
  if (!(J * sqrt(norm2) <= sqrt(2.0 / 3.0) * parameters[YIELD] + 16.0 * PETSC_MACHINE_EPSILON * mu)) return PETSC_FALSE;
  state[6] = J;
  state[7] = 0.0;
  return shape_from_stress(mu, J, sigma, state);
}

static PetscBool bear(const PetscReal *parameters, const PetscReal tau[6], PetscReal *state)
{
  const PetscReal mean = (tau[0] + tau[1] + tau[2]) / 3.0;
  state[6] = volume_from_kirchhoff(split_volume(parameters), parameters[SPLIT_BULK], mean, state[6]);
  return state[6] > 0.0 && shape_from_stress(parameters[SPLIT_SHEAR], 1.0, tau, state);
}

static void prepare_linear(const Elasticity *elastic, const PetscReal *given, PetscReal *packed)
{
  split_prepare(VOLUME_LINEAR, elastic, packed);
  packed[YIELD] = given[0];
  packed[HARDENING] = given[1];
}

static void prepare_log(const Elasticity *elastic, const PetscReal *given, PetscReal *packed)
{
  prepare_linear(elastic, given, packed);
  packed[SPLIT_VOLUME] = VOLUME_LOG;
}

/* The yield stress at any strain over the factor. */
static void reduce(const PetscReal *given, PetscReal factor, PetscReal *reduced)
{
  reduced[0] = factor > 0.0 ? given[0] / factor : 1e30;
  reduced[1] = factor > 0.0 ? given[1] / factor : 0.0;
}

static void hardens(const PetscReal *parameters, PetscReal *yield, PetscReal *slope)
{
  *yield = parameters[YIELD];
  *slope = parameters[HARDENING];
}

static void volume(PetscInt n, const PetscReal *state, PetscReal *J)
{
  for (PetscInt p = 0; p < n; ++p) J[p] = state[p * N_STATE + 6];
}

static void scale(PetscInt n, const PetscReal *factor, PetscReal *state)
{
  for (PetscInt p = 0; p < n; ++p) state[p * N_STATE + 6] *= factor[p] * factor[p] * factor[p];
}

static const LawParameter parameters[] = {
  {"yield_stress", "Pa", "stress at which a tension test yields", 0, PETSC_MAX_REAL, .min_open = PETSC_TRUE,
   .fallback = NAN},
  {"hardening", "Pa", "linear isotropic hardening modulus", 0, PETSC_MAX_REAL, .fallback = 0},
  {.name = NULL},
};

static const LawField fields[] = {
  {"elastic_shape", "", "volume-preserving elastic left Cauchy-Green tensor", 6, {1, 1, 1, 0, 0, 0}},
  {"volume_ratio", "", "J, current over undeformed volume", 1, {1}},
  {"equivalent_plastic_strain", "", "accumulated sqrt(2/3) |d eps^p|", 1, {0}},
  {.name = NULL},
};

#define J2(...)                                                                                                     \
  {                                                                                                                 \
    .parameters = parameters, .fields = fields, .n_state = N_STATE, .yields = PETSC_TRUE, .update = update,         \
    .energy = energy, .initial_stress = initial_stress, .bear = bear, .volume = volume, .volume_law = split_volume, \
    .scale = scale, .reduce = reduce, .hardens = hardens, __VA_ARGS__                                               \
  }

const Law law_j2 = J2(.name = "j2", .prepare = prepare_linear,
                      .help = "J2 (von Mises) plasticity, linear isotropic hardening, p = K (J - 1)");
const Law law_j2_log = J2(.name = "j2-log", .prepare = prepare_log,
                          .help = "J2 (von Mises) plasticity, linear isotropic hardening, p = K ln J / J");
