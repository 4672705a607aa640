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
#include "material/principal.h"
#include "material/principal_lanes.h"
#include "material/shape.h"

enum { FRICTION, DILATANCY, COHESION, CUTOFF };

#define N_STATE 7 /* b^e, equivalent plastic strain */
#define NO_CUTOFF 1e300

/* What the spectral decomposition of eight points gave. */
typedef struct {
  Lanes b[6], stretch2[3], strain[3], basis[36];
  Lanes det, flow; /* of the increment; equivalent plastic strain so far */
  LaneBits finite; /* is b of use? */
} Trial;

LANES_INLINE void trial_lanes(PetscInt n, const PetscReal *dF, const PetscReal *old, Trial *t)
{
  const Lanes one = (Lanes){0} + 1.0, none = {0};
  Lanes f[9], before[N_STATE], v[9], size, sum = none;
  lanes_load(9, n, dF, f);
  lanes_load(N_STATE, n, old, before);
  t->flow = before[6];
  lanes_det(f, &t->det);
  lanes_push_forward(f, before, t->b);
  for (int k = 0; k < 6; ++k) {
    lanes_abs(&t->b[k], &size);
    sum += size;
  }
  t->finite = (sum * sum <= PETSC_MAX_REAL) & (t->det <= PETSC_MAX_REAL) & (t->det > 0.0);
  for (int k = 0; k < 6; ++k) lanes_select(&t->finite, &t->b[k], k < 3 ? &one : &none, &t->b[k]);
  lanes_sym_eigen(t->b, t->stretch2, v);
  t->finite &= t->stretch2[2] > 0.0; /* lost to rounding: stretches 1e8 apart */
  for (int a = 0; a < 3; ++a) {
    lanes_log(&t->stretch2[a], &t->strain[a]);
    t->strain[a] *= 0.5;
  }
  lanes_principal_basis(v, t->basis);
}

/* Stresses on the surface or inside. Most points that flow are on the shear plane: that return is made here, others point by point. */
LANES_INLINE void return_lanes(const PetscReal *p, const Lanes e[3], Lanes tau[3], LaneBits *regions)
{
  const Lanes volume = p[MC_LAMBDA] * (e[0] + e[1] + e[2]);
  Lanes size[2], t[3];
  for (int k = 0; k < 3; ++k) tau[k] = volume + 2.0 * p[MC_MU] * e[k];
  lanes_abs(&tau[0], &size[0]);
  lanes_abs(&tau[2], &size[1]);
  const Lanes noise = p[MC_NOISE] + 4.0 * PETSC_MACHINE_EPSILON * (p[MC_K] * size[0] + size[1] + p[MC_Q]);
  const Lanes f = p[MC_K] * tau[0] - tau[2] - p[MC_Q];
  const LaneBits shear = f > noise, beyond = shear | (tau[0] - p[MC_CUT] > noise);
  *regions = beyond & 0;
  if (!lanes_any(&beyond)) return;
  for (int k = 0; k < 3; ++k) t[k] = tau[k] - f * p[MC_R0 + k];
  const LaneBits plane = shear & (t[0] >= t[1]) & (t[1] >= t[2]) & (t[0] <= p[MC_CUT]), others = beyond & ~plane;
  for (int k = 0; k < 3; ++k) lanes_select(&plane, &t[k], &tau[k], &tau[k]);
  *regions = plane & MC_PLANE;
  if (!lanes_any(&others)) return;
  for (int l = 0; l < LANES; ++l) {
    if (!others[l]) continue;
    PetscReal one[3];
    (*regions)[l] = mc_return(p, (PetscReal[3]){e[0][l], e[1][l], e[2][l]}, one);
    for (int k = 0; k < 3; ++k) tau[k][l] = one[k];
  }
}

/* b^e of the returned stress. An elastic point keeps its trial b to the last bit. */
LANES_INLINE void state_lanes(const PetscReal *p, const Trial *t, const Lanes tau[3], const LaneBits *regions,
                              Lanes state[6], Lanes *flow)
{
  const Lanes share = p[MC_LAMBDA] / (3.0 * p[MC_LAMBDA] + 2.0 * p[MC_MU]) * (tau[0] + tau[1] + tau[2]), none = {0};
  const LaneBits plastic = *regions != MC_ELASTIC;
  Lanes stretch2[3], b[6], norm2 = none;
  for (int k = 0; k < 6; ++k) state[k] = t->b[k];
  *flow = none;
  if (!lanes_any(&plastic)) return;
  for (int a = 0; a < 3; ++a) {
    const Lanes elastic = (tau[a] - share) / (2.0 * p[MC_MU]), twice = 2.0 * elastic;
    norm2 += (t->strain[a] - elastic) * (t->strain[a] - elastic);
    lanes_exp(&twice, &stretch2[a]);
  }
  lanes_principal_tensor(stretch2, t->basis, b);
  norm2 /= 1.0 + p[MC_M] * p[MC_M];
  lanes_sqrt(&norm2, &norm2);
  lanes_select(&plastic, &norm2, &none, flow);
  for (int k = 0; k < 6; ++k) lanes_select(&plastic, &b[k], &state[k], &state[k]);
}

LANES_INLINE void moduli_lanes(const PetscReal *p, const LaneBits *regions, Lanes D[9])
{
  const LaneBits plane = *regions == MC_PLANE, others = *regions > MC_PLANE;
  PetscReal elastic[9], plastic[9];
  mc_moduli(p, MC_ELASTIC, elastic);
  mc_moduli(p, MC_PLANE, plastic);
  for (int k = 0; k < 9; ++k) {
    const Lanes yes = (Lanes){0} + plastic[k], no = (Lanes){0} + elastic[k];
    lanes_select(&plane, &yes, &no, &D[k]);
  }
  if (!lanes_any(&others)) return;
  for (int l = 0; l < LANES; ++l) {
    if (!others[l]) continue;
    mc_moduli(p, (McRegion)(*regions)[l], plastic);
    for (int k = 0; k < 9; ++k) D[k][l] = plastic[k];
  }
}

/* (tau_A - tau_B) / (e_A - e_B) of the pair a < b. Elastic differences keep 2 mu exactly, equal stresses give 0; in
 * between the return only shrinks differences, which bounds what rounding can do to nearly equal strains. */
LANES_INLINE void difference_lanes(const PetscReal *p, const LaneBits *regions, const Lanes e[3], const Lanes tau[3],
                                   int a, int b, Lanes *r)
{
  const Lanes none = {0}, full = none + 2.0 * p[MC_MU], rise = tau[a] - tau[b], x = e[a] - e[b], slope = rise / x;
  const LaneBits equal = rise == 0.0, less = rise < full * x;
  LaneBits elastic = *regions == MC_ELASTIC;
  if (a == 1) elastic |= *regions == MC_CUT_PLANE;
  lanes_select(&less, &slope, &full, r);
  lanes_select(&equal, &none, r, r);
  lanes_select(&elastic, &full, r, r);
}

LANES_INLINE void tangent_lanes(const PetscReal *p, const Trial *t, const LaneBits *regions, const Lanes tau[3],
                                PetscInt n, PetscReal *c)
{
  Lanes D[9], shear[3], all[36], r, coth;
  moduli_lanes(p, regions, D);
  for (int k = 0; k < 3; ++k) {
    const int a = k == 2 ? 0 : k, b = k == 2 ? 2 : k + 1; /* 12, 23, 31 as 13 */
    const Lanes x = t->strain[a] - t->strain[b];
    difference_lanes(p, regions, t->strain, tau, a, b, &r);
    lanes_principal_coth(&x, &t->stretch2[a], &t->stretch2[b], &coth);
    shear[k] = 0.5 * (r * coth - tau[a] - tau[b]);
  }
  lanes_principal_tangent(D, tau, shear, t->basis, all);
  lanes_store(36, n, all, c);
}

/* Points that failed keep their state and carry no stress. */
static LawStatus give_up(const Trial *t, PetscInt n, const PetscReal *old, PetscReal *state, PetscReal *tau,
                         PetscReal *c)
{
  LawStatus worst = LAW_OK;
  for (PetscInt l = 0; l < PetscMin(n, LANES); ++l) {
    if (t->finite[l]) continue;
    const LawStatus status = t->det[l] <= 0.0 ? LAW_INVERTED : LAW_NOT_FINITE;
    worst = PetscMax(worst, status);
    for (int k = 0; k < N_STATE; ++k) state[l * N_STATE + k] = old[l * N_STATE + k];
    for (int k = 0; k < 6; ++k) tau[l * 6 + k] = 0.0;
    for (int k = 0; c && k < 36; ++k) c[l * 36 + k] = 0.0;
  }
  return worst;
}

LANES_INLINE LawStatus update_lanes(const PetscReal *p, PetscInt n, const PetscReal *dF, const PetscReal *old,
                                    PetscReal *state, PetscReal *tau, PetscReal *c)
{
  Lanes principal[3], now[N_STATE], stress[6], flow;
  LaneBits regions;
  Trial t;
  trial_lanes(n, dF, old, &t);
  return_lanes(p, t.strain, principal, &regions);
  state_lanes(p, &t, principal, &regions, now, &flow);
  now[6] = t.flow + flow;
  lanes_principal_tensor(principal, t.basis, stress);
  lanes_store(N_STATE, n, now, state);
  lanes_store(6, n, stress, tau);
  if (c) tangent_lanes(p, &t, &regions, principal, n, c);
  const LaneBits bad = ~t.finite;
  return lanes_any(&bad) ? give_up(&t, n, old, state, tau, c) : LAW_OK;
}

static LawStatus update(const PetscReal *parameters, PetscInt n, const PetscReal *dF, const PetscReal *old,
                        PetscReal *state, PetscReal *tau, PetscReal *c)
{
  LawStatus worst = LAW_OK;
  for (PetscInt i = 0; i < n; i += LANES) {
    const LawStatus status = update_lanes(parameters, n - i, dF + 9 * i, old + N_STATE * i, state + N_STATE * i,
                                          tau + 6 * i, c ? c + 36 * i : NULL);
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
