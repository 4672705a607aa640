/* A point of a law from a library: what talus does before and behind the library's own function
 * (docs/theory.md, "Laws of one's own").
 *
 * A law of strains gets eps = ln b^tr / 2 and gives tau and D = d tau / d eps. With n_A the
 * directions of b^tr and x = eps_A - eps_B a rate of deformation d strains it by
 *
 *   eps' = M : d,  M_AAAA = 1,  M_ABAB = x coth x,   c : d = D : M : d - d tau - tau d. */
#include "base/math/svd.h"
#include "material/plugin/plugin.h"
#include "material/algebra/principal.h"

#define DIFFERENCE 1e-6 /* strain, to both sides */

static PetscBool all_finite(PetscInt n, const PetscReal *v)
{
  for (PetscInt k = 0; k < n; ++k)
    if (!isfinite(v[k])) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* c := rate - d tau - tau d, where rate is d tau by strain rates of Voigt (engineering shear). */
static void subtract_turns(const PetscReal tau[6], PetscReal *c)
{
  PetscReal t[9];
  sym_to_full(tau, t);
  for (int k = 0; k < 6; ++k)
    for (int m = 0; m < 6; ++m) {
      const int i = voigt_row[m], j = voigt_column[m], a = voigt_row[k], b = voigt_column[k];
      PetscReal turn = 0.0; /* (d t + t d)_ij with d = (e_a e_b + e_b e_a) / 2 */
      turn += (i == a ? t[3 * b + j] : 0.0) + (i == b ? t[3 * a + j] : 0.0);
      turn += (j == b ? t[3 * i + a] : 0.0) + (j == a ? t[3 * i + b] : 0.0);
      c[6 * m + k] -= 0.5 * turn;
    }
}

/* What differences leave of an asymmetry that the law says it has not. */
static void symmetrise(const Plugin *g, PetscReal *c)
{
  for (int i = 0; i < 6 && g->user.flags & TALUS_LAW_SYMMETRIC; ++i)
    for (int j = 0; j < i; ++j) c[6 * i + j] = c[6 * j + i] = 0.5 * (c[6 * i + j] + c[6 * j + i]);
}

static LawStatus gradient_call(const Plugin *g, const PetscReal *q, const PetscReal dF[9], const PetscReal *old,
                               PetscReal *state, PetscReal tau[6], PetscReal *c)
{
  const TalusLawStep step = {q[0], q[1]};
  if (g->umat.call) return umat_point(&g->umat, q + PLUGIN_STEP, q[0], q[1], dF, old, state, tau, c);
  if (g->user.update(q + PLUGIN_STEP, &step, dF, old, state, tau, c)) return LAW_NOT_CONVERGED;
  return all_finite(6, tau) ? LAW_OK : LAW_NOT_FINITE;
}

/* Stress by central differences in the six directions of straining. */
static LawStatus gradient_differences(const Plugin *g, const PetscReal *q, const PetscReal dF[9], const PetscReal *old,
                                      PetscReal *c)
{
  PetscReal state[LAW_MAX_STATE], tau[2][6];
  for (int k = 0; k < 6; ++k) {
    for (int side = 0; side < 2; ++side) {
      PetscReal more[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, f[9];
      const PetscReal h = side ? -0.5 * DIFFERENCE : 0.5 * DIFFERENCE;
      more[3 * voigt_row[k] + voigt_column[k]] += h;
      more[3 * voigt_column[k] + voigt_row[k]] += h;
      tensor_multiply(more, dF, f);
      const LawStatus status = gradient_call(g, q, f, old, state, tau[side], NULL);
      if (status != LAW_OK) return status;
    }
    for (int m = 0; m < 6; ++m) c[6 * m + k] = (tau[0][m] - tau[1][m]) / (2.0 * DIFFERENCE);
  }
  return LAW_OK;
}

LawStatus plugin_gradient_point(const Plugin *g, const PetscReal *q, const PetscReal dF[9], const PetscReal *old,
                                PetscReal *state, PetscReal tau[6], PetscReal *c)
{
  const PetscBool gives = (g->user.flags & TALUS_LAW_TANGENT) != 0;
  LawStatus status = gradient_call(g, q, dF, old, state, tau, gives ? c : NULL);
  if (status != LAW_OK || !c || gives) return status;
  status = gradient_differences(g, q, dF, old, c);
  subtract_turns(tau, c);
  symmetrise(g, c);
  return status;
}

static LawStatus strain_call(const Plugin *g, const PetscReal *q, const PetscReal strain[6], const PetscReal *old,
                             PetscReal *state, PetscReal tau[6], PetscReal elastic[6], PetscReal *D)
{
  const TalusLawStep step = {q[0], q[1]};
  for (int k = 0; k < 6; ++k) elastic[k] = strain[k];
  if (g->user.update_strain(q + PLUGIN_STEP, &step, strain, old, state, tau, elastic, D)) return LAW_NOT_CONVERGED;
  return all_finite(6, tau) && all_finite(6, elastic) ? LAW_OK : LAW_NOT_FINITE;
}

/* d tau / d strain, the law's own or by differences. */
static LawStatus strain_slopes(const Plugin *g, const PetscReal *q, const PetscReal strain[6], const PetscReal *old,
                               PetscReal D[36])
{
  PetscReal state[LAW_MAX_STATE], elastic[6], tau[2][6];
  for (int k = 0; k < 6; ++k) {
    for (int side = 0; side < 2; ++side) {
      PetscReal moved[6];
      for (int m = 0; m < 6; ++m) moved[m] = strain[m];
      moved[k] += (side ? -1.0 : 1.0) * (k < 3 ? 1.0 : 0.5) * DIFFERENCE;
      const LawStatus status = strain_call(g, q, moved, old, state, tau[side], elastic, NULL);
      if (status != LAW_OK) return status;
    }
    for (int m = 0; m < 6; ++m) D[6 * m + k] = (tau[0][m] - tau[1][m]) / (2.0 * DIFFERENCE);
  }
  return LAW_OK;
}

/* M: engineering strain rates of ln b / 2 by those of deformation. */
static void strain_of_rate(const PetscReal strain[3], const PetscReal basis[36], PetscReal M[36])
{
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      PetscReal sum = 0.0;
      for (int a = 0; a < 3; ++a) {
        const PetscReal x = strain[a] - strain[(a + 1) % 3], coth = x == 0.0 ? 1.0 : x / tanh(x);
        sum += basis[6 * a + i] * basis[6 * a + j] + 0.5 * coth * basis[6 * (a + 3) + i] * basis[6 * (a + 3) + j];
      }
      M[6 * i + j] = (i < 3 ? 1.0 : 2.0) * sum;
    }
}

static LawStatus strain_tangent(const Plugin *g, const PetscReal *q, const PetscReal trial[6],
                                const PetscReal principal[3], const PetscReal basis[36], const PetscReal *old,
                                const PetscReal tau[6], PetscReal D[36], PetscReal *c)
{
  PetscReal M[36];
  if (!(g->user.flags & TALUS_LAW_TANGENT)) {
    const LawStatus status = strain_slopes(g, q, trial, old, D);
    if (status != LAW_OK) return status;
  }
  strain_of_rate(principal, basis, M);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      PetscReal sum = 0.0;
      for (int k = 0; k < 6; ++k) sum += D[6 * i + k] * M[6 * k + j];
      c[6 * i + j] = sum;
    }
  subtract_turns(tau, c);
  if (!(g->user.flags & TALUS_LAW_TANGENT)) symmetrise(g, c);
  return all_finite(36, c) ? LAW_OK : LAW_NOT_FINITE;
}

/* exp(2 strain) */
static void strain_to_b(const PetscReal strain[6], PetscReal b[6])
{
  PetscReal value[3], v[9], basis[36];
  sym_eigen(strain, value, v);
  principal_basis(v, basis);
  for (int a = 0; a < 3; ++a) value[a] = exp(2.0 * value[a]);
  principal_tensor(value, basis, b);
}

void plugin_strain_of(const PetscReal b[6], PetscReal strain[6])
{
  PetscReal value[3], v[9], basis[36];
  sym_eigen(b, value, v);
  principal_basis(v, basis);
  for (int a = 0; a < 3; ++a) value[a] = 0.5 * log(value[a]);
  principal_tensor(value, basis, strain);
}

LawStatus plugin_strain_point(const Plugin *g, const PetscReal *q, const PetscReal dF[9], const PetscReal *old,
                              PetscReal *state, PetscReal tau[6], PetscReal *c)
{
  PetscReal b[6], principal[3], v[9], basis[36], strain[6], elastic[6], D[36], size = 0.0;
  sym_push_forward(dF, old, b);
  for (int k = 0; k < 6; ++k) size += fabs(b[k]);
  if (!(size * size <= PETSC_MAX_REAL)) return LAW_NOT_FINITE;
  sym_eigen(b, principal, v);
  if (!(principal[2] > 0.0)) return LAW_NOT_FINITE; /* lost to rounding */
  for (int a = 0; a < 3; ++a) principal[a] = 0.5 * log(principal[a]);
  principal_basis(v, basis);
  principal_tensor(principal, basis, strain);
  PetscBool flows = PETSC_FALSE;
  const PetscBool gives = c && g->user.flags & TALUS_LAW_TANGENT;
  const LawStatus status = strain_call(g, q, strain, old + 6, state + 6, tau, elastic, gives ? D : NULL);
  if (status != LAW_OK) return status;
  for (int k = 0; k < 6; ++k) flows |= elastic[k] != strain[k];
  if (flows) strain_to_b(elastic, state);
  else memcpy(state, b, sizeof b); /* to the last bit */
  return c ? strain_tangent(g, q, strain, principal, basis, old + 6, tau, D, c) : LAW_OK;
}

/* Newton for tau(eps) = J stress, J = exp tr eps of Cauchy's and 1 of Kirchhoff's. */
PetscBool plugin_strain_stress(const Plugin *g, const PetscReal *q, PetscBool cauchy, const PetscReal stress[6],
                               PetscReal *state)
{
  PetscReal strain[6] = {0}, tau[6], elastic[6], D[36], r[6], dx[6], size, flow = 0.0;
  PetscReal own[LAW_MAX_STATE];
  for (int iteration = 0; iteration < 60; ++iteration) {
    const PetscReal J = cauchy ? exp(strain[0] + strain[1] + strain[2]) : 1.0;
    if (strain_call(g, q, strain, state + 6, own, tau, elastic, g->user.flags & TALUS_LAW_TANGENT ? D : NULL))
      return PETSC_FALSE;
    if (!(g->user.flags & TALUS_LAW_TANGENT) && strain_slopes(g, q, strain, state + 6, D)) return PETSC_FALSE;
    for (int i = 0; i < 6; ++i) {
      r[i] = J * stress[i] - tau[i];
      for (int j = 0; cauchy && j < 3; ++j) D[6 * i + j] -= J * stress[i];
    }
    svd_solve(6, 1e-12, D, r, dx);
    size = flow = 0.0;
    for (int k = 0; k < 6; ++k) {
      flow = PetscMax(flow, fabs(elastic[k] - strain[k]));
      strain[k] += (k < 3 ? 1.0 : 0.5) * dx[k];
      size = PetscMax(size, fabs(dx[k]));
    }
    if (size <= 1e-15) break;
  }
  if (!(size <= 1e-13) || flow > 1e-12) return PETSC_FALSE;
  strain_to_b(strain, state);
  return PETSC_TRUE;
}
