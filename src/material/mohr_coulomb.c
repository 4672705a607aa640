/* Mohr-Coulomb material in large strains (thesis section 3.3, algorithm 4, appendices A and B):
 *
 *   b^e trial = f b^e f^T,  eps_A = ln lambda_A,  tau = D eps       (Hencky's energy)
 *   f(tau) = k tau_1 - tau_3 - 2 c sqrt k <= 0,  d eps^p = sum gamma dg/dtau,  g = m tau_1 - tau_3
 *
 * The return is that of small strains in the logarithmic principal strains (mohr_coulomb_return.h), the tangent is exact
 * (principal.h). State: b^e and the equivalent plastic strain.
 *
 * A point beyond the apex is left with the elastic strain of the apex: with c = 0 it is stress-free, b^e = I. How far it
 * has opened is not remembered, so that the next compression meets a solid at once. There the tangent is zero. */
#include "material/mohr_coulomb_return.h"
#include "material/law.h"
#include "material/principal.h"
#include "material/shape.h"

enum { FRICTION, DILATANCY, COHESION, CUTOFF };

#define N_STATE 7 /* b^e, equivalent plastic strain */
#define NO_CUTOFF 1e300

/* What the spectral decomposition of one point gave. */
typedef struct {
  PetscReal b[6], stretch2[3], strain[3], v[9], basis[36];
} Trial;

static LawStatus trial_state(const PetscReal dF[9], const PetscReal *old, Trial *t)
{
  const PetscReal det = tensor_det(dF);
  PetscReal sum = 0.0;
  if (det <= 0.0) return LAW_INVERTED;
  sym_push_forward(dF, old, t->b);
  for (int k = 0; k < 6; ++k) sum += fabs(t->b[k]);
  if (!isfinite(det) || !isfinite(sum * sum)) return LAW_NOT_FINITE;
  sym_eigen(t->b, t->stretch2, t->v);
  if (!(t->stretch2[2] > 0.0)) return LAW_NOT_FINITE; /* lost to rounding: stretches 1e8 apart */
  for (int a = 0; a < 3; ++a) t->strain[a] = 0.5 * log(t->stretch2[a]);
  principal_basis(t->v, t->basis);
  return LAW_OK;
}

/* b^e of the returned stress. An elastic point keeps its trial b to the last bit. */
static void plastic_state(const PetscReal *p, const Trial *t, const PetscReal tau[3], const PetscReal *old,
                          PetscReal *state)
{
  PetscReal elastic[3], stretch2[3], norm2 = 0.0;
  mc_compliance(p, tau, elastic);
  for (int a = 0; a < 3; ++a) {
    norm2 += (t->strain[a] - elastic[a]) * (t->strain[a] - elastic[a]);
    stretch2[a] = exp(2.0 * elastic[a]);
  }
  principal_tensor(stretch2, t->basis, state);
  state[6] = old[6] + sqrt(norm2 / (1.0 + p[MC_M] * p[MC_M]));
}

static void tangent(const PetscReal *p, const Trial *t, McRegion region, const PetscReal tau[3], PetscReal *c)
{
  PetscReal D[9], shear[3];
  mc_moduli(p, region, D);
  for (int k = 0; k < 3; ++k) {
    const int a = k == 2 ? 0 : k, b = k == 2 ? 2 : k + 1; /* 12, 23, 31 as 13 */
    const PetscReal x = t->strain[a] - t->strain[b];
    const PetscReal r = mc_difference(p, region, t->strain, tau, a, b);
    shear[k] = 0.5 * (r * principal_coth(x, t->stretch2[a], t->stretch2[b]) - tau[a] - tau[b]);
  }
  principal_tangent(D, tau, shear, t->basis, c);
}

static LawStatus update_point(const PetscReal *p, const PetscReal *dF, const PetscReal *old, PetscReal *state,
                              PetscReal *tau, PetscReal *c)
{
  Trial t;
  PetscReal principal[3];
  const LawStatus status = trial_state(dF, old, &t);
  if (status != LAW_OK) return status;
  const McRegion region = mc_return(p, t.strain, principal);
  if (region == MC_ELASTIC) {
    for (int k = 0; k < 6; ++k) state[k] = t.b[k];
    state[6] = old[6];
  } else plastic_state(p, &t, principal, old, state);
  principal_tensor(principal, t.basis, tau);
  if (c) tangent(p, &t, region, principal, c);
  return LAW_OK;
}

/* A point that failed keeps its state and carries no stress. */
static void give_up(const PetscReal *old, PetscReal *state, PetscReal *tau, PetscReal *c)
{
  for (int k = 0; k < N_STATE; ++k) state[k] = old[k];
  for (int k = 0; k < 6; ++k) tau[k] = 0.0;
  for (int k = 0; c && k < 36; ++k) c[k] = 0.0;
}

static LawStatus update(const PetscReal *parameters, PetscInt n, const PetscReal *dF, const PetscReal *old,
                        PetscReal *state, PetscReal *tau, PetscReal *c)
{
  LawStatus worst = LAW_OK;
  for (PetscInt i = 0; i < n; ++i) {
    PetscReal *ci = c ? c + 36 * i : NULL;
    const LawStatus status =
      update_point(parameters, dF + 9 * i, old + N_STATE * i, state + N_STATE * i, tau + 6 * i, ci);
    if (status != LAW_OK) give_up(old + N_STATE * i, state + N_STATE * i, tau + 6 * i, ci);
    worst = PetscMax(worst, status);
  }
  return worst;
}

static PetscReal energy(const PetscReal *p, const PetscReal *b)
{
  PetscReal stretch2[3], v[9], trace = 0.0, norm2 = 0.0;
  sym_eigen(b, stretch2, v);
  for (int a = 0; a < 3; ++a) {
    const PetscReal e = 0.5 * log(stretch2[a]);
    trace += e;
    norm2 += e * e;
  }
  return 0.5 * p[MC_LAMBDA] * trace * trace + p[MC_MU] * norm2;
}

/* tau = J sigma with ln J = tr tau / 3K; PETSC_FALSE outside the yield surface. */
static PetscBool initial_stress(const PetscReal *p, const PetscReal sigma[6], PetscReal *state)
{
  const PetscReal bulk = p[MC_LAMBDA] + 2.0 / 3.0 * p[MC_MU];
  const PetscReal J = volume_from_pressure(VOLUME_LOG, bulk, (sigma[0] + sigma[1] + sigma[2]) / 3.0);
  PetscReal tau[3], e[3], v[9], basis[36];
  sym_eigen(sigma, tau, v);
  for (int a = 0; a < 3; ++a) tau[a] *= J;
  const PetscReal noise = mc_noise(p, tau);
  if (!(mc_yield(p, tau) <= noise && tau[0] - p[MC_CUT] <= noise)) return PETSC_FALSE;
  principal_basis(v, basis);
  mc_compliance(p, tau, e);
  for (int a = 0; a < 3; ++a) e[a] = exp(2.0 * e[a]);
  principal_tensor(e, basis, state);
  state[6] = 0.0;
  return PETSC_TRUE;
}

static void volume(PetscInt n, const PetscReal *state, PetscReal *J) { volume_of_b(n, N_STATE, state, J); }

static void scale(PetscInt n, const PetscReal *factor, PetscReal *state) { scale_b(n, N_STATE, factor, state); }

/* Without friction, dilatancy and cut-off (Tresca) the flow neither feels the pressure nor changes the volume. */
static VolumeLaw volume_law(const PetscReal *p)
{
  return p[MC_K] == 1.0 && p[MC_M] == 1.0 && p[MC_CUT] == INFINITY ? VOLUME_LOG : VOLUME_COUPLED;
}

static void prepare(const Elasticity *elastic, const PetscReal *given, PetscReal *p)
{
  const PetscReal lambda = elastic->lame, mu = elastic->shear;
  const PetscReal s = sin(given[FRICTION]), d = sin(given[DILATANCY]);
  const PetscReal k = (1.0 + s) / (1.0 - s), m = (1.0 + d) / (1.0 - d);
  const PetscReal r[3] = {lambda * (m - 1.0) + 2.0 * mu * m, lambda * (m - 1.0), lambda * (m - 1.0) - 2.0 * mu};
  p[MC_LAMBDA] = lambda;
  p[MC_MU] = mu;
  p[MC_K] = k;
  p[MC_M] = m;
  p[MC_Q] = 2.0 * given[COHESION] * sqrt(k);
  p[MC_CUT] = given[CUTOFF] < NO_CUTOFF && (k - 1.0) * given[CUTOFF] < p[MC_Q] ? given[CUTOFF] : INFINITY;
  for (int i = 0; i < 3; ++i) p[MC_R0 + i] = r[i] / (k * r[0] - r[2]);
  p[MC_NOISE] = 4.0 * PETSC_MACHINE_EPSILON * (k + 1.0) * (lambda + 2.0 * mu);
}

/* More dilatancy than friction would gain energy by shearing. */
static const char *check(const PetscReal *given)
{
  return given[DILATANCY] > given[FRICTION] ? "the dilatancy angle must not be larger than the friction angle" : NULL;
}

static const LawParameter parameters[] = {
  {.name = "friction_angle",
   .unit = "deg",
   .help = "angle of internal friction",
   .min = 0,
   .max = 90,
   .max_open = PETSC_TRUE,
   .fallback = NAN},
  {.name = "dilatancy_angle",
   .unit = "deg",
   .help = "dilatancy angle, at most the friction angle",
   .min = 0,
   .max = 90,
   .max_open = PETSC_TRUE,
   .fallback = 0},
  {.name = "cohesion", .unit = "Pa", .help = "cohesion", .min = 0, .max = PETSC_MAX_REAL, .fallback = NAN},
  {.name = "tension_cutoff",
   .unit = "Pa",
   .help = "largest principal tension; 1e300: none but the apex",
   .min = 0,
   .max = PETSC_MAX_REAL,
   .fallback = NO_CUTOFF},
  {.name = NULL},
};

static const LawField fields[] = {
  {"elastic_strain", "", "elastic left Cauchy-Green tensor b", 6, {1, 1, 1, 0, 0, 0}},
  {"equivalent_plastic_strain", "", "sum of |d eps^p| / sqrt(1 + m^2)", 1, {0}},
  {.name = NULL},
};

const Law law_mohr_coulomb = {
  .name = "mohr-coulomb",
  .help = "Hencky solid with Mohr-Coulomb plasticity, non-associated, with tension cut-off if wished",
  .parameters = parameters,
  .fields = fields,
  .n_state = N_STATE,
  .symmetric = PETSC_FALSE,
  .yields = PETSC_TRUE,
  .update = update,
  .energy = energy,
  .initial_stress = initial_stress,
  .volume = volume,
  .volume_law = volume_law,
  .scale = scale,
  .prepare = prepare,
  .check = check,
};
