/* Mohr-Coulomb material in large strains (thesis section 3.3, algorithm 4, appendices A and B):
 *
 *   b^e trial = f b^e f^T,  eps_A = ln lambda_A,  tau = D eps       (Hencky's energy)
 *   f(tau) = k tau_1 - tau_3 - 2 c sqrt k <= 0,  d eps^p = sum gamma dg/dtau,  g = m tau_1 - tau_3
 *
 * The return is that of small strains in the logarithmic principal strains (mohr_coulomb_return.h),
 * the tangent is exact (principal.h). State: b^e and the equivalent plastic strain.
 *
 * A point beyond the apex is left with the elastic strain of the apex: with c = 0 it is
 * stress-free, b^e = I. There the tangent is zero. How far it has opened is not remembered, so that
 * the next compression meets a solid at once; unless `opening_memory` is 1: then omega = ln (V / V
 * of the apex) is kept, trial strains begin with omega / 3, and nothing bears before they have
 * closed it. Of what opens the share `opening_memory` is kept, and of what closes all goes from
 * omega, so that neither depends on the steps. Only what opens in all directions is remembered:
 * volume that shearing takes by dilatancy stays, and so do cracks of the cut-off (CUT_PLANE,
 * CUT_LINE), which have a direction.
 *
 * Cohesion holds on to what opens: with c > 0 the tension of the apex stays until omega is zero
 * again. Its work on the way out comes back on the way in, and counts as stored. */
#include "material/algebra/hencky.h"
#include "material/mohr_coulomb/mohr_coulomb_plane.h"
#include "material/strength.h"

enum { MEMORY = STRENGTH_N };

#define N_STATE MC_STATE

LANES_INLINE void trial_lanes(PetscInt n, const PetscReal *dF, const Lanes before[N_STATE], HenckyTrial *t)
{
  hencky_push(n, dF, before, t);
  mc_with_opening(&before[7], 6, t->b);
  hencky_spectrum(t);
}

/* b^e of the returned stress, equivalent plastic strain and opening. An elastic point keeps its
 * trial b to the last bit. */
LANES_INLINE void state_lanes(const PetscReal *p, const HenckyTrial *t, const Lanes before[N_STATE], const Lanes tau[3],
                              const LaneBits *regions, Lanes state[N_STATE])
{
  const Lanes share = p[MC_LAMBDA] / (3.0 * p[MC_LAMBDA] + 2.0 * p[MC_MU]) * (tau[0] + tau[1] + tau[2]), none = {0};
  const LaneBits plastic = *regions != MC_ELASTIC;
  Lanes stretch2[3], b[6], norm2 = none, flow;
  for (int k = 0; k < 6; ++k) state[k] = t->b[k];
  state[6] = before[6];
  state[7] = none;
  if (!lanes_any(&plastic)) return;
  mc_opening(p, regions, t->strain, tau, &before[7], &state[7]);
  for (int a = 0; a < 3; ++a) {
    const Lanes elastic = (tau[a] - share) / (2.0 * p[MC_MU]), twice = 2.0 * elastic;
    const Lanes plastic_strain = t->strain[a] - elastic - state[7] / 3.0;
    norm2 += plastic_strain * plastic_strain;
    lanes_exp_near(&twice, &stretch2[a]);
  }
  lanes_principal_tensor(stretch2, t->basis, b);
  norm2 /= 1.0 + p[MC_M] * p[MC_M];
  lanes_sqrt(&norm2, &norm2);
  lanes_select(&plastic, &norm2, &none, &flow);
  state[6] += flow;
  for (int k = 0; k < 6; ++k) lanes_select(&plastic, &b[k], &state[k], &state[k]);
}

LANES_INLINE void tangent_lanes(const PetscReal *p, const HenckyTrial *t, const LaneBits *regions, const Lanes tau[3],
                                PetscInt n, PetscReal *c)
{
  Lanes D[9], r[3];
  mc_moduli_lanes(p, regions, D);
  for (int k = 0; k < 3; ++k) {
    const int a = k == 2 ? 0 : k, b = k == 2 ? 2 : k + 1; /* 12, 23, 31 as 13 */
    const Lanes x = t->strain[a] - t->strain[b], rise = tau[a] - tau[b];
    LaneBits elastic = *regions == MC_ELASTIC;
    if (a == 1) elastic |= *regions == MC_CUT_PLANE;
    mc_difference_lanes(p, &elastic, &x, &rise, &r[k]);
  }
  hencky_tangent(t, D, r, tau, n, c);
}

static LawStatus give_up(const LaneBits *finite, const Lanes *det, PetscInt n, const PetscReal *old, PetscReal *state,
                         PetscReal *tau, PetscReal *c)
{
  return hencky_give_up(N_STATE, finite, finite, det, n, old, state, tau, c);
}

LANES_INLINE LawStatus update_lanes(const PetscReal *p, PetscInt n, const PetscReal *dF, const PetscReal *old,
                                    PetscReal *state, PetscReal *tau, PetscReal *c)
{
  Lanes before[N_STATE], principal[3], now[N_STATE], stress[6];
  LaneBits regions;
  HenckyTrial t;
  lanes_load(N_STATE, n, old, before);
  trial_lanes(n, dF, before, &t);
  mc_return_lanes(p, t.strain, principal, &regions);
  lanes_principal_tensor(principal, t.basis, stress);
  if (state) {
    state_lanes(p, &t, before, principal, &regions, now);
    lanes_store(N_STATE, n, now, state);
  }
  lanes_store(6, n, stress, tau);
  if (c) tangent_lanes(p, &t, &regions, principal, n, c);
  const LaneBits bad = ~t.finite;
  return lanes_any(&bad) ? give_up(&t.finite, &t.det, n, old, state, tau, c) : LAW_OK;
}

static LawStatus update(const PetscReal *parameters, PetscInt n, const PetscReal *dF, const PetscReal *old,
                        PetscReal *state, PetscReal *tau, PetscReal *c)
{
  return lanes_update(update_lanes, N_STATE, parameters, n, dF, old, state, tau, c);
}

/* Moduli of 11, 22, 33 and 12 where 36 components stand for each point; no row of 33 in the plane. */
LANES_INLINE void store_plane(const PetscBool hoop, PetscInt n, Lanes moduli[16], PetscReal *c)
{
  for (int first = 0; first < 16; first += LANES) lanes_transpose(moduli + first);
  for (int l = 0; l < PetscMin(n, LANES); ++l)
    for (int i = 0; i < 4; ++i) {
      const PetscReal *row = (const PetscReal *)&moduli[4 * i / LANES * LANES + l] + 4 * i % LANES;
      if (hoop || i != 2) __builtin_memcpy(c + 36 * l + 6 * i, row, 4 * sizeof *c);
    }
}

LANES_INLINE LawStatus update_in_plane(const PetscBool hoop, const PetscReal *p, PetscInt n, const PetscReal *dF,
                                       const PetscReal *old, PetscReal *state, PetscReal *tau, PetscReal *c)
{
  Lanes f[9], before[N_STATE], now[N_STATE], principal[3], stress[6] = {{0}}, moduli[16];
  LaneBits regions;
  PlaneTrial t;
  lanes_load(N_STATE, n, old, before);
  lanes_load(9, n, dF, f);
  const Lanes in_plane[5] = {f[0], f[1], f[3], f[4], f[8]};
  if (!mc_plane_trial(hoop, in_plane, before, &t)) return update(p, PetscMin(n, LANES), dF, old, state, tau, c);
  mc_plane_return(p, &t, principal, &regions);
  mc_plane_tensor(&t, principal, stress);
  if (state) {
    now[6] = before[6];
    now[7] = before[7];
    mc_plane_state(p, &t, principal, &regions, now);
    lanes_store(N_STATE, n, now, state);
  }
  lanes_store(6, n, stress, tau);
  if (c) {
    mc_plane_moduli(hoop, p, &t, &regions, principal, moduli);
    store_plane(hoop, n, moduli, c);
  }
  const LaneBits bad = ~t.finite;
  return lanes_any(&bad) ? give_up(&t.finite, &t.det, n, old, state, tau, c) : LAW_OK;
}

/* Both kernels of the plane: the one where z does not strain, and the one where it is a hoop. */
#define PLANE_UPDATE(name, hoop)                                                                                 \
  LANES_INLINE LawStatus name##_lanes(const PetscReal *p, PetscInt n, const PetscReal *dF, const PetscReal *old, \
                                      PetscReal *state, PetscReal *tau, PetscReal *c)                            \
  {                                                                                                              \
    return update_in_plane(hoop, p, n, dF, old, state, tau, c);                                                  \
  }                                                                                                              \
  static LawStatus name(const PetscReal *parameters, PetscInt n, const PetscReal *dF, const PetscReal *old,      \
                        PetscReal *state, PetscReal *tau, PetscReal *c)                                          \
  {                                                                                                              \
    return lanes_update(name##_lanes, N_STATE, parameters, n, dF, old, state, tau, c);                           \
  }

PLANE_UPDATE(update_plane, PETSC_FALSE)
PLANE_UPDATE(update_hoop, PETSC_TRUE)

LANES_INLINE LawStatus march_plane_lanes(const PetscReal *p, PetscInt n, const LawMarch *march)
{
  Lanes f[5], before[N_STATE], now[N_STATE], principal[3], stress[4];
  LaneBits regions;
  PlaneTrial t;
  lanes_load_rows(5, march->dF, f);
  lanes_load_apart(N_STATE, march->stride, n, march->state, before);
  if (!mc_plane_trial(PETSC_TRUE, f, before, &t))
    return march_by_update(update, N_STATE, PETSC_TRUE, p, PetscMin(n, LANES), march);
  mc_plane_return(p, &t, principal, &regions);
  mc_plane_tensor(&t, principal, stress);
  lanes_store_rows(4, stress, march->tau);
  now[6] = before[6];
  now[7] = before[7];
  mc_plane_state(p, &t, principal, &regions, now);
  lanes_store_apart(N_STATE, march->stride, n, now, march->state);
  const LaneBits bad = ~t.finite;
  return lanes_any(&bad) ? lanes_halt(N_STATE, 4, &t.finite, &t.finite, &t.det, n, before, march) : LAW_OK;
}

static LawStatus march_plane(const PetscReal *parameters, PetscInt n, const LawMarch *march)
{
  return lanes_march(march_plane_lanes, parameters, n, march);
}

LANES_INLINE LawStatus march_space_lanes(const PetscReal *p, PetscInt n, const LawMarch *march)
{
  Lanes f[9], before[N_STATE], now[N_STATE], principal[3], stress[6];
  LaneBits regions;
  HenckyTrial t;
  lanes_march_dF(PETSC_FALSE, march, f);
  lanes_load_apart(N_STATE, march->stride, n, march->state, before);
  hencky_push_by(f, before, &t);
  mc_with_opening(&before[7], 6, t.b);
  hencky_projections(&t);
  mc_return_lanes(p, t.strain, principal, &regions);
  lanes_principal_tensor(principal, t.basis, stress);
  lanes_march_tau(PETSC_FALSE, stress, march);
  state_lanes(p, &t, before, principal, &regions, now);
  lanes_store_apart(N_STATE, march->stride, n, now, march->state);
  const LaneBits bad = ~t.finite;
  return lanes_any(&bad) ? lanes_halt(N_STATE, 6, &t.finite, &t.finite, &t.det, n, before, march) : LAW_OK;
}

static LawStatus march_space(const PetscReal *parameters, PetscInt n, const LawMarch *march)
{
  return lanes_march(march_space_lanes, parameters, n, march);
}

/* Tension of the apex, Pa. */
static PetscReal apex(const PetscReal *p) { return p[MC_CUT] < INFINITY ? p[MC_CUT] : p[MC_Q] / (p[MC_K] - 1.0); }

static PetscReal energy(const PetscReal *p, const PetscReal *state)
{
  return hencky_energy(p[MC_LAMBDA], p[MC_MU], state) + (state[7] > 0.0 ? apex(p) * state[7] : 0.0);
}

static void energies(const PetscReal *p, PetscInt n, PetscInt stride, const PetscReal *state, PetscReal *all)
{
  hencky_energies(p[MC_LAMBDA], p[MC_MU], n, stride, state, all);
  for (PetscInt k = 0; k < n; ++k)
    if (state[k * stride + 7] > 0.0) all[k] += apex(p) * state[k * stride + 7];
}

/* PETSC_FALSE outside the yield surface. */
static PetscBool initial_stress(const PetscReal *p, const PetscReal sigma[6], PetscReal *state)
{
  PetscReal tau[3];
  hencky_stress(p[MC_LAMBDA], p[MC_MU], sigma, tau, state);
  state[6] = state[7] = 0.0;
  const PetscReal noise = mc_noise(p, tau);
  return mc_yield(p, tau) <= noise && tau[0] - p[MC_CUT] <= noise;
}

static PetscBool bear(const PetscReal *p, const PetscReal tau[6], PetscReal *state)
{
  return hencky_bear(p[MC_LAMBDA], p[MC_MU], tau, state);
}

static void volume(PetscInt n, const PetscReal *state, PetscReal *J) { volume_of_b(n, N_STATE, state, J); }

static void scale(PetscInt n, const PetscReal *factor, PetscReal *state) { scale_b(n, N_STATE, factor, state); }

/* Without friction, dilatancy and cut-off (Tresca) the flow neither feels the pressure nor changes
 * the volume. */
static VolumeLaw volume_law(const PetscReal *p)
{
  return p[MC_K] == 1.0 && p[MC_M] == 1.0 && p[MC_CUT] == INFINITY ? VOLUME_LOG : VOLUME_COUPLED;
}

/* What opens and is remembered follows no potential. */
static PetscBool associated(const PetscReal *p) { return p[MC_K] == p[MC_M] && p[MC_MEMORY] == 0.0; }

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
  p[MC_MEMORY] = given[MEMORY];
  mc_prepare_lines(p);
  p[MC_NOISE] = 4.0 * PETSC_MACHINE_EPSILON * (k + 1.0) * (lambda + 2.0 * mu);
}

static void reduce(const PetscReal *given, PetscReal factor, PetscReal *reduced)
{
  strength_reduce(MEMORY + 1, given, factor, reduced);
}

static const LawParameter parameters[] = {
  STRENGTH_PARAMETERS,
  {"tension_cutoff", "Pa", "largest principal tension; 1e300: none but the apex", 0, PETSC_MAX_REAL,
   .fallback = NO_CUTOFF},
  {"opening_memory", "", "share of an opening that must close before anything bears; 1: grains keep their density", 0,
   1, .fallback = 0, .not_mixed = PETSC_TRUE},
  {.name = NULL},
};

static const LawField fields[] = {
  {"elastic_strain", "", "elastic left Cauchy-Green tensor b", 6, {1, 1, 1, 0, 0, 0}},
  {"equivalent_plastic_strain", "", "sum of |d eps^p| / sqrt(1 + m^2)", 1, {0}},
  {"opening", "", "ln of the volume by which grains are apart, with opening_memory", 1, {0}},
  {.name = NULL},
};

static void room(const PetscReal *p, PetscReal most, PetscReal *state)
{
  (void)p;
  state[7] = PetscMin(state[7], most);
}

const Law law_mohr_coulomb = {
  .name = "mohr-coulomb",
  .help = "Hencky solid with Mohr-Coulomb plasticity, non-associated, with tension cut-off if wished",
  .parameters = parameters,
  .fields = fields,
  .n_state = N_STATE,
  .associated = associated,
  .yields = PETSC_TRUE,
  .spares_state = PETSC_TRUE,
  .room = room,
  .update = update,
  .update_plane = update_plane,
  .update_hoop = update_hoop,
  .march_plane = march_plane,
  .march_space = march_space,
  .energy = energy,
  .energies = energies,
  .initial_stress = initial_stress,
  .bear = bear,
  .volume = volume,
  .volume_law = volume_law,
  .scale = scale,
  .prepare = prepare,
  .reduce = reduce,
  .check = strength_check,
};
