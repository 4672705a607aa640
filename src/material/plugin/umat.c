/* A step of a UMAT (docs/theory.md, "Laws of one's own"). With dF = dR dU, dU = sum lambda_A N_A
 * N_A and n_A = dR N_A:
 *
 *   sigma_0 = dR sigma dR^T,  d eps = sum ln lambda_A n_A n_A,  sigma_1, D = UMAT(sigma_0, d eps)
 *
 * An isotropic subroutine so gives dR g(sigma, ln dU) dR^T, objective for any step, and with x =
 * ln lambda_A - ln lambda_B the rate by d is
 *
 *   sigma' - w sigma + sigma w = k sigma - sigma k + D : e,
 *   k_AB = -tanh(x / 2) d_AB,  e_AB = d_AB x / sinh x
 *
 * and c : d = tr d tau + J (...) - d tau - tau d. */
#include "material/plugin/umat.h"
#include <math.h>
#include <string.h>
#include "material/algebra/principal.h"

enum { STRESS = 0, STRAIN = 6, GRADIENT = 12 };

/* Place of Voigt components (xx yy zz xy yz zx) in the subroutine's order (11 22 33 12 13 23). */
static const int place[6] = {0, 1, 2, 3, 5, 4};

/* dF by its polar decomposition. */
typedef struct {
  PetscReal R[9], log_stretch[3], v[9], basis[36], increment[6]; /* v: n_A; increment: d eps */
} Polar;

static void polar_of(const PetscReal dF[9], Polar *p)
{
  static const PetscReal unit[6] = {1, 1, 1, 0, 0, 0};
  PetscReal b[6], stretch2[3], inverse[3], t[6], V[9];
  sym_push_forward(dF, unit, b); /* dV^2 */
  sym_eigen(b, stretch2, p->v);
  principal_basis(p->v, p->basis);
  for (int a = 0; a < 3; ++a) {
    p->log_stretch[a] = 0.5 * log(stretch2[a]);
    inverse[a] = 1.0 / sqrt(stretch2[a]);
  }
  principal_tensor(p->log_stretch, p->basis, p->increment);
  principal_tensor(inverse, p->basis, t);
  sym_to_full(t, V);
  tensor_multiply(V, dF, p->R); /* dR = dV^-1 dF */
}

/* Symmetric tensors of talus as the subroutine has them, with shears times `shear`, and back. */
static void to_umat(const PetscReal s[6], PetscReal shear, double out[6])
{
  for (int k = 0; k < 6; ++k) out[place[k]] = (k < 3 ? 1.0 : shear) * s[k];
}

static void from_umat(const double in[6], PetscReal s[6])
{
  for (int k = 0; k < 6; ++k) s[k] = in[place[k]];
}

/* Fortran has its matrices column by column. */
static void to_columns(const PetscReal a[9], double out[9])
{
  for (int k = 0; k < 9; ++k) out[k] = a[3 * (k % 3) + k / 3];
}

/* What the subroutine reads and writes. */
typedef struct {
  double stress[6], ddsdde[36], stran[6], dstran[6], drot[9], f0[9], f1[9], coords[3], time[2], dt, pnewdt;
} Call;

static PetscBool run(const Umat *u, const double *props, double *statev, Call *call)
{
  const int three = 3, six = 6, one = 1;
  double energies[3] = {0}, zero = 0.0, none[6] = {0}, more[6] = {0}, fields[3] = {0}, celent = 1.0;
  u->call(call->stress, statev, call->ddsdde, &energies[0], &energies[1], &energies[2], &zero, none, more, &zero,
          call->stran, call->dstran, call->time, &call->dt, fields, fields, fields, fields, u->name, &three, &three,
          &six, &u->n_statev, props, &u->n_props, call->coords, call->drot, &call->pnewdt, &celent, call->f0, call->f1,
          &one, &one, &one, &one, &one, &one, sizeof u->name);
  return call->pnewdt >= 1.0;
}

/* e for the unit rate of Voigt component j (engineering shear): its tensor components. */
static void strain_rate(const Polar *p, int j, PetscReal e[6])
{
  memset(e, 0, 6 * sizeof *e);
  for (int a = 0; a < 3; ++a) {
    const PetscReal x = p->log_stretch[a] - p->log_stretch[(a + 1) % 3], *both = p->basis + 6 * (a + 3);
    const PetscReal e_ab = 0.5 * both[j] * (x == 0.0 ? 1.0 : x / sinh(x));
    for (int m = 0; m < 6; ++m) e[m] += p->basis[6 * a + j] * p->basis[6 * a + m] + e_ab * both[m];
  }
}

/* k sigma - sigma k for that rate: k is antisymmetric, so the second is the first, transposed. */
static void turn_rate(const Polar *p, int j, const PetscReal sigma[6], PetscReal turn[6])
{
  PetscReal k[9] = {0}, full[9], product[9];
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3;
    const PetscReal x = p->log_stretch[a] - p->log_stretch[b];
    const PetscReal size = -tanh(0.5 * x) * 0.5 * p->basis[6 * (a + 3) + j];
    for (int m = 0; m < 9; ++m) {
      const int row = 3 * (m / 3), column = 3 * (m % 3);
      k[m] += size * (p->v[row + a] * p->v[column + b] - p->v[row + b] * p->v[column + a]);
    }
  }
  sym_to_full(sigma, full);
  tensor_multiply(k, full, product);
  for (int m = 0; m < 6; ++m)
    turn[m] = product[3 * voigt_row[m] + voigt_column[m]] + product[3 * voigt_column[m] + voigt_row[m]];
}

/* d tau + tau d for that rate. */
static void convect_rate(int j, const PetscReal tau[6], PetscReal out[6])
{
  PetscReal t[9], d[9] = {0}, product[9];
  d[3 * voigt_row[j] + voigt_column[j]] += 0.5;
  d[3 * voigt_column[j] + voigt_row[j]] += 0.5;
  sym_to_full(tau, t);
  tensor_multiply(d, t, product);
  for (int m = 0; m < 6; ++m)
    out[m] = product[3 * voigt_row[m] + voigt_column[m]] + product[3 * voigt_column[m] + voigt_row[m]];
}

static void tangent(const Polar *p, const Call *call, PetscReal J, const PetscReal sigma[6], const PetscReal tau[6],
                    PetscReal *c)
{
  for (int j = 0; j < 6; ++j) {
    PetscReal e[6], turn[6], convected[6];
    double strain[6];
    strain_rate(p, j, e);
    turn_rate(p, j, sigma, turn);
    convect_rate(j, tau, convected);
    to_umat(e, 2.0, strain);
    for (int i = 0; i < 6; ++i) {
      PetscReal rate = 0.0;
      for (int m = 0; m < 6; ++m) rate += call->ddsdde[6 * m + place[i]] * strain[m];
      c[6 * i + j] = (j < 3 ? tau[i] : 0.0) + J * (turn[i] + rate) - convected[i];
    }
  }
}

/* Everything that the subroutine is told. */
static void tell(const Polar *p, PetscReal time, PetscReal dt, const PetscReal *old, const PetscReal F[9], Call *call)
{
  PetscReal turned[6];
  sym_push_forward(p->R, old + STRESS, turned);
  to_umat(turned, 1.0, call->stress);
  sym_push_forward(p->R, old + STRAIN, turned);
  to_umat(turned, 2.0, call->stran);
  to_umat(p->increment, 2.0, call->dstran);
  to_columns(p->R, call->drot);
  to_columns(old + GRADIENT, call->f0);
  to_columns(F, call->f1);
  memcpy(call->coords, old + UMAT_PLACE, sizeof call->coords);
  call->time[0] = call->time[1] = time;
  call->dt = dt;
  call->pnewdt = 1.0;
}

void umat_begin(const Umat *u, const PetscReal x[3], PetscReal *state)
{
  const int three = 3, one = 1;
  memcpy(state + UMAT_PLACE, x, 3 * sizeof *state);
  if (!u->begin) return;
  memset(state + UMAT_KEPT, 0, (size_t)u->n_statev * sizeof *state);
  u->begin(state + UMAT_KEPT, x, &u->n_statev, &three, &one, &one, &one, &one);
}

LawStatus umat_point(const Umat *u, const PetscReal *props, PetscReal time, PetscReal dt, const PetscReal dF[9],
                     const PetscReal *old, PetscReal *state, PetscReal tau[6], PetscReal *c)
{
  Polar p;
  Call call = {.dt = 0};
  PetscReal F[9], sigma[6], turned[6], sum = 0.0;
  polar_of(dF, &p);
  tensor_multiply(dF, old + GRADIENT, F);
  const PetscReal J = tensor_det(F);
  tell(&p, time, dt, old, F, &call);
  memcpy(state + UMAT_KEPT, old + UMAT_KEPT, (size_t)u->n_statev * sizeof *state);
  if (!isfinite(p.log_stretch[0] + p.log_stretch[1] + p.log_stretch[2])) return LAW_NOT_FINITE;
  if (!run(u, props, state + UMAT_KEPT, &call)) return LAW_NOT_CONVERGED;
  from_umat(call.stress, sigma);
  sym_push_forward(p.R, old + STRAIN, turned);
  for (int k = 0; k < 6; ++k) {
    state[STRESS + k] = sigma[k];
    state[STRAIN + k] = turned[k] + p.increment[k];
    tau[k] = J * sigma[k];
    sum += fabs(tau[k]);
  }
  memcpy(state + GRADIENT, F, sizeof F);
  memcpy(state + UMAT_PLACE, old + UMAT_PLACE, 3 * sizeof *state);
  if (!isfinite(sum)) return LAW_NOT_FINITE;
  if (c) tangent(&p, &call, J, sigma, tau, c);
  return LAW_OK;
}
