/* Laws whose stress depends on principal logarithmic elastic strains: what they share, eight points
 * side by side (docs/theory.md, "Laws").
 *
 *   b^e trial = f b^e f^T,  eps_A = ln lambda_A,  tau_A(eps),  c from d tau_A / d eps_B (principal.h)
 *
 * A law gives the return in these strains alone; state: b^e first, then scalars of its own. */
#pragma once
#include "material/algebra/principal.h"
#include "material/algebra/principal_lanes.h"
#include "material/algebra/shape.h"

#define HENCKY_SCALARS 3 /* most numbers of a state beside b^e */

/* b^e before the flow, and what the spectral decomposition gave. */
typedef struct {
  Lanes b[6], stretch2[3], strain[3], basis[36], det;
  LaneBits finite; /* is b of use? */
} HenckyTrial;

LANES_INLINE void hencky_push_by(const Lanes f[9], const Lanes old[6], HenckyTrial *t)
{
  lanes_det(f, &t->det);
  lanes_push_forward(f, old, t->b);
}

LANES_INLINE void hencky_push(PetscInt n, const PetscReal *dF, const Lanes old[6], HenckyTrial *t)
{
  Lanes f[9];
  lanes_load(9, n, dF, f);
  hencky_push_by(f, old, t);
}

/* What is no tensor of finite size becomes 1. */
LANES_INLINE void hencky_check(HenckyTrial *t)
{
  const Lanes one = (Lanes){0} + 1.0, none = {0};
  Lanes size, sum = none;
  for (int k = 0; k < 6; ++k) {
    lanes_abs(&t->b[k], &size);
    sum += size;
  }
  t->finite = (sum * sum <= PETSC_MAX_REAL) & (t->det <= PETSC_MAX_REAL) & (t->det > 0.0);
  for (int k = 0; k < 6; ++k) lanes_select(&t->finite, &t->b[k], k < 3 ? &one : &none, &t->b[k]);
}

LANES_INLINE void hencky_axes(HenckyTrial *t)
{
  Lanes v[9];
  lanes_sym_eigen(t->b, t->stretch2, v);
  lanes_principal_basis(v, t->basis);
}

LANES_INLINE void hencky_strains(HenckyTrial *t)
{
  t->finite &= t->stretch2[2] > 0.0; /* lost to rounding: stretches 1e8 apart */
  for (int a = 0; a < 3; ++a) {
    lanes_log_near(&t->stretch2[a], &t->strain[a]);
    t->strain[a] *= 0.5;
  }
}

LANES_INLINE void hencky_spectrum(HenckyTrial *t)
{
  hencky_check(t);
  hencky_axes(t);
  hencky_strains(t);
}

/* The same for what needs no tangent: of the basis only n_1 n_1 and n_3 n_3, and in closed form, whose errors are some
 * 1e-16 of the largest stretch; where that is more than a few times the smallest, by axes. */
LANES_INLINE void hencky_projections(HenckyTrial *t)
{
  HenckyTrial turned;
  hencky_check(t);
  lanes_sym_projections(t->b, t->stretch2, t->basis, t->basis + 12);
  const LaneBits apart = ~(t->stretch2[2] > 0.1 * t->stretch2[0]);
  if (lanes_any(&apart)) {
    for (int k = 0; k < 6; ++k) turned.b[k] = t->b[k];
    hencky_axes(&turned);
    for (int a = 0; a < 3; ++a) lanes_select(&apart, &turned.stretch2[a], &t->stretch2[a], &t->stretch2[a]);
    for (int k = 0; k < 6; ++k) lanes_select(&apart, &turned.basis[k], &t->basis[k], &t->basis[k]);
    for (int k = 12; k < 18; ++k) lanes_select(&apart, &turned.basis[k], &t->basis[k], &t->basis[k]);
  }
  hencky_strains(t);
}

/* c of n points from D_AB = d tau_A / d eps_B and the divided differences r of 12, 23, 13. */
LANES_INLINE void hencky_tangent(const HenckyTrial *t, const Lanes D[9], const Lanes r[3], const Lanes tau[3],
                                 PetscInt n, PetscReal *c)
{
  Lanes shear[3], all[36], coth;
  for (int k = 0; k < 3; ++k) {
    const int a = k == 2 ? 0 : k, b = k == 2 ? 2 : k + 1; /* 12, 23, 31 as 13 */
    const Lanes x = t->strain[a] - t->strain[b];
    lanes_principal_coth(&x, &t->stretch2[a], &t->stretch2[b], &coth);
    shear[k] = 0.5 * (r[k] * coth - tau[a] - tau[b]);
  }
  lanes_principal_tangent(D, tau, shear, t->basis, all);
  lanes_store(36, n, all, c);
}

/* Points that failed keep their state and carry no stress. `good`: those that did not. */
static inline LawStatus hencky_give_up(int n_state, const LaneBits *good, const LaneBits *finite, const Lanes *det,
                                       PetscInt n, const PetscReal *old, PetscReal *state, PetscReal *tau, PetscReal *c)
{
  LawStatus worst = LAW_OK;
  for (PetscInt l = 0; l < PetscMin(n, LANES); ++l) {
    if ((*good)[l]) continue;
    const LawStatus bad = (*det)[l] <= 0.0 ? LAW_INVERTED : LAW_NOT_FINITE,
                    status = (*finite)[l] ? LAW_NOT_CONVERGED : bad;
    worst = PetscMax(worst, status);
    for (int k = 0; state && k < n_state; ++k) state[l * n_state + k] = old[l * n_state + k];
    for (int k = 0; k < 6; ++k) tau[l * 6 + k] = 0.0;
    for (int k = 0; c && k < 36; ++k) c[l * 36 + k] = 0.0;
  }
  return worst;
}

/* What a return gives, in principal axes. */
typedef struct {
  Lanes tau[3], elastic[3]; /* Kirchhoff stresses, elastic strains after it */
  Lanes D[9], r[3];         /* only if moduli are wanted */
  LaneBits plastic, good;
} HenckyReturn;

/* Strains (falling) and the state's scalars before and after. */
typedef void (*HenckyLaw)(const PetscReal *parameters, PetscBool moduli, const Lanes strain[3], const Lanes *before,
                          Lanes *after, HenckyReturn *r);

/* An elastic point keeps its trial b to the last bit. */
LANES_INLINE void hencky_state(const HenckyTrial *t, const HenckyReturn *r, Lanes b[6])
{
  Lanes stretch2[3], flown[6];
  for (int k = 0; k < 6; ++k) b[k] = t->b[k];
  if (!lanes_any(&r->plastic)) return;
  for (int a = 0; a < 3; ++a) {
    const Lanes twice = 2.0 * r->elastic[a];
    lanes_exp_near(&twice, &stretch2[a]);
  }
  lanes_principal_tensor(stretch2, t->basis, flown);
  for (int k = 0; k < 6; ++k) lanes_select(&r->plastic, &flown[k], &b[k], &b[k]);
}

/* The update of eight points by a law whose state has `scalars` numbers beside b^e; to be inlined
 * with a law known to the compiler. */
LANES_INLINE LawStatus hencky_update(HenckyLaw law, int scalars, const PetscReal *p, PetscInt n, const PetscReal *dF,
                                     const PetscReal *old, PetscReal *state, PetscReal *tau, PetscReal *c)
{
  Lanes before[6 + HENCKY_SCALARS], now[6 + HENCKY_SCALARS], stress[6];
  HenckyTrial t;
  HenckyReturn r;
  lanes_load(6 + scalars, n, old, before);
  hencky_push(n, dF, before, &t);
  hencky_spectrum(&t);
  law(p, c != NULL, t.strain, before + 6, now + 6, &r);
  lanes_principal_tensor(r.tau, t.basis, stress);
  if (state) {
    hencky_state(&t, &r, now);
    lanes_store(6 + scalars, n, now, state);
  }
  lanes_store(6, n, stress, tau);
  if (c) hencky_tangent(&t, r.D, r.r, r.tau, n, c);
  const LaneBits good = t.finite & r.good, bad = ~good;
  return lanes_any(&bad) ? hencky_give_up(6 + scalars, &good, &t.finite, &t.det, n, old, state, tau, c) : LAW_OK;
}

/* The same in place and without moduli (material/law.h). */
LANES_INLINE LawStatus hencky_march(HenckyLaw law, int scalars, const PetscBool plane, const PetscReal *p, PetscInt n,
                                    const LawMarch *march)
{
  Lanes f[9], before[6 + HENCKY_SCALARS], now[6 + HENCKY_SCALARS], stress[6];
  HenckyTrial t;
  HenckyReturn r;
  lanes_march_dF(plane, march, f);
  lanes_load_apart(6 + scalars, march->stride, n, march->state, before);
  hencky_push_by(f, before, &t);
  hencky_projections(&t);
  law(p, PETSC_FALSE, t.strain, before + 6, now + 6, &r);
  lanes_principal_tensor(r.tau, t.basis, stress);
  hencky_state(&t, &r, now);
  lanes_store_apart(6 + scalars, march->stride, n, now, march->state);
  lanes_march_tau(plane, stress, march);
  const LaneBits good = t.finite & r.good, bad = ~good;
  if (!lanes_any(&bad)) return LAW_OK;
  return lanes_halt(6 + scalars, plane ? 4 : 6, &good, &t.finite, &t.det, n, before, march);
}

/* The functions of a law made of it: update_lanes for eight points, update for n; and its marches. */
#define HENCKY_UPDATE(law, scalars)                                                                                \
  LANES_INLINE LawStatus update_lanes(const PetscReal *p, PetscInt n, const PetscReal *dF, const PetscReal *old,   \
                                      PetscReal *state, PetscReal *tau, PetscReal *c)                              \
  {                                                                                                                \
    return hencky_update(law, scalars, p, n, dF, old, state, tau, c);                                              \
  }                                                                                                                \
  static LawStatus update(const PetscReal *parameters, PetscInt n, const PetscReal *dF, const PetscReal *old,      \
                          PetscReal *state, PetscReal *tau, PetscReal *c)                                          \
  {                                                                                                                \
    return lanes_update(update_lanes, 6 + (scalars), parameters, n, dF, old, state, tau, c);                       \
  }                                                                                                                \
  LANES_INLINE LawStatus law##_march(const PetscBool plane, const PetscReal *p, PetscInt n, const LawMarch *march) \
  {                                                                                                                \
    return hencky_march(law, scalars, plane, p, n, march);                                                         \
  }                                                                                                                \
  LANES_MARCHES(law)

/* The first of its stored fields. */
#define HENCKY_FIELDS                                                                  \
  {"elastic_strain", "", "elastic left Cauchy-Green tensor b", 6, {1, 1, 1, 0, 0, 0}}, \
  {                                                                                    \
    "equivalent_plastic_strain", "", "accumulated sqrt(2/3) |dev d eps^p|", 1, { 0 }   \
  }

/* What the mixed formulation asks of it, where the bulk modulus is a constant. */
#define HENCKY_MIXED(scalars)                                                                                       \
  static void volume(PetscInt n, const PetscReal *state, PetscReal *J) { volume_of_b(n, 6 + (scalars), state, J); } \
  static void scale(PetscInt n, const PetscReal *factor, PetscReal *state) { scale_b(n, 6 + (scalars), factor, state); }

/* Hooke's law between these strains and stresses: stored energy, J/m3. */
static inline PetscReal hencky_energy(PetscReal lambda, PetscReal mu, const PetscReal b[6])
{
  PetscReal stretch2[3], trace = 0.0, norm2 = 0.0;
  sym_eigenvalues(b, stretch2);
  for (int a = 0; a < 3; ++a) {
    const PetscReal e = 0.5 * log(stretch2[a]);
    trace += e;
    norm2 += e * e;
  }
  return 0.5 * lambda * trace * trace + mu * norm2;
}

/* The same of eight points, without axes: sums of powers of b - 1 follow each other by its invariants (Newton's
 * identities), and
 *
 *   sum ln(1 + x) = sum_k (-1)^(k+1) / k sum x^k,  sum ln^2(1 + x) = sum_k 2 (-1)^k H_(k-1) / k sum x^k
 *
 * have all digits after twelve terms where every |x| < 1/32. */
LANES_INLINE void hencky_energy_lanes(PetscReal lambda, PetscReal mu, const Lanes b[6], Lanes *energy)
{
  const Lanes x = b[0] - 1.0, y = b[1] - 1.0, z = b[2] - 1.0, xy = b[3] * b[3], yz = b[4] * b[4], zx = b[5] * b[5];
  const Lanes e1 = x + y + z, e2 = x * y + y * z + z * x - xy - yz - zx;
  const Lanes e3 = x * (y * z - yz) - b[3] * (b[3] * z - b[4] * b[5]) + b[5] * (b[3] * b[4] - y * b[5]);
  const Lanes p2 = x * x + y * y + z * z + 2.0 * (xy + yz + zx);
  Lanes last[3] = {e1, p2, e1 * p2 - e2 * e1 + 3.0 * e3}, trace = e1 - 0.5 * p2, norm2 = p2;
  PetscReal harmonic = 1.5;
  for (int k = 3; k <= 12; ++k) {
    const PetscReal sign = k % 2 ? 1.0 : -1.0;
    trace += (sign / k) * last[2];
    norm2 -= (2.0 * sign * harmonic / k) * last[2];
    harmonic += 1.0 / k;
    const Lanes next = e1 * last[2] - e2 * last[1] + e3 * last[0];
    last[0] = last[1];
    last[1] = last[2];
    last[2] = next;
  }
  trace *= 0.5;
  *energy = 0.5 * lambda * trace * trace + 0.25 * mu * norm2;
  const LaneBits far = ~(p2 < 0x1p-10);
  for (int l = 0; lanes_any(&far) && l < LANES; ++l)
    if (far[l])
      (*energy)[l] = hencky_energy(lambda, mu, (PetscReal[6]){b[0][l], b[1][l], b[2][l], b[3][l], b[4][l], b[5][l]});
}

/* As Law.energies. */
static inline void hencky_energies(PetscReal lambda, PetscReal mu, PetscInt n, PetscInt stride, const PetscReal *state,
                                   PetscReal *energy)
{
  for (PetscInt first = 0; first < n; first += LANES) {
    Lanes b[8], one; /* as many numbers of each at once as there are, if they are enough to be turned */
    lanes_load_apart(stride < LANES ? 6 : PetscMax(6, LANES), stride, PetscMin(n - first, LANES),
                     state + first * stride, b);
    hencky_energy_lanes(lambda, mu, b, &one);
    for (int l = 0; l < PetscMin(n - first, LANES); ++l) energy[first + l] = one[l];
  }
}

/* b^e that carries the principal Kirchhoff stresses tau with axes v. */
static inline void hencky_elastic(PetscReal lambda, PetscReal mu, const PetscReal tau[3], const PetscReal v[9],
                                  PetscReal b[6])
{
  const PetscReal share = lambda / (3.0 * (lambda + 2.0 / 3.0 * mu)) * (tau[0] + tau[1] + tau[2]);
  PetscReal stretch2[3], basis[36];
  principal_basis(v, basis);
  for (int a = 0; a < 3; ++a) stretch2[a] = exp((tau[a] - share) / mu);
  principal_tensor(stretch2, basis, b);
}

/* The same of any axes, as Law.bear. */
static inline PetscBool hencky_bear(PetscReal lambda, PetscReal mu, const PetscReal tau[6], PetscReal b[6])
{
  PetscReal principal[3], v[9];
  sym_eigen(tau, principal, v);
  hencky_elastic(lambda, mu, principal, v, b);
  return (PetscBool)(b[0] > 0.0 && isfinite(b[0] + b[1] + b[2]));
}

/* Principal tau = J sigma with ln J = tr tau / 3K (NAN if there is none), and b^e that carries
 * it. */
static inline void hencky_stress(PetscReal lambda, PetscReal mu, const PetscReal sigma[6], PetscReal tau[3],
                                 PetscReal b[6])
{
  const PetscReal bulk = lambda + 2.0 / 3.0 * mu, mean = (sigma[0] + sigma[1] + sigma[2]) / 3.0;
  const PetscReal J = volume_from_pressure(VOLUME_LOG, bulk, mean);
  PetscReal v[9];
  sym_eigen(sigma, tau, v);
  for (int a = 0; a < 3; ++a) tau[a] *= J;
  hencky_elastic(lambda, mu, tau, v, b);
}
