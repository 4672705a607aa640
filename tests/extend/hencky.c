/* A law from outside the house: Hencky's solid, linear between the logarithmic strains and the
 * Kirchhoff stress (thesis 3.99),
 *
 *   tau_A = K ln J + 2 mu (eps_A - ln J / 3),   eps_A = ln lambda_A
 *
 * one point at a time. Its file, and a line in more_laws.inc, are all that a law is. */
#include "material/law.h"
#include "material/algebra/principal.h"
#include "material/algebra/shape.h"

enum { BULK, SHEAR };

/* c_AABB = K - 2 mu / 3 + 2 (mu - tau_A) delta_AB, and the shears of material/algebra/principal.h with r =
 * 2 mu. */
static void tangent(const PetscReal *parameters, const PetscReal strain[3], const PetscReal tau[3],
                    const PetscReal basis[36], PetscReal *c)
{
  const PetscReal mu = parameters[SHEAR], lambda = parameters[BULK] - 2.0 / 3.0 * mu;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      c[6 * i + j] = i < 3 && j < 3 ? lambda : 0.0;
      for (int a = 0; a < 3; ++a) {
        const int b = (a + 1) % 3;
        const PetscReal x = strain[a] - strain[b], x_coth_x = x == 0.0 ? 1.0 : x / tanh(x);
        c[6 * i + j] += 2.0 * (mu - tau[a]) * basis[6 * a + i] * basis[6 * a + j];
        c[6 * i + j] += 0.5 * (2.0 * mu * x_coth_x - tau[a] - tau[b]) * basis[6 * (a + 3) + i] * basis[6 * (a + 3) + j];
      }
    }
}

static LawStatus update_point(const PetscReal *parameters, const PetscReal *dF, const PetscReal *old, PetscReal *b,
                              PetscReal *tau, PetscReal *c)
{
  PetscReal stretch2[3], v[9], basis[36], strain[3], stress[3], sum = 0.0;
  sym_push_forward(dF, old, b);
  for (int k = 0; k < 6; ++k) sum += fabs(b[k]), tau[k] = 0.0;
  if (tensor_det(dF) <= 0.0) return LAW_INVERTED;
  if (!(sum * sum <= PETSC_MAX_REAL)) return LAW_NOT_FINITE;
  sym_eigen(b, stretch2, v);
  if (!(stretch2[2] > 0.0)) return LAW_NOT_FINITE;
  for (int a = 0; a < 3; ++a) strain[a] = 0.5 * log(stretch2[a]);
  const PetscReal log_J = strain[0] + strain[1] + strain[2];
  for (int a = 0; a < 3; ++a)
    stress[a] = parameters[BULK] * log_J + 2.0 * parameters[SHEAR] * (strain[a] - log_J / 3.0);
  principal_basis(v, basis);
  principal_tensor(stress, basis, tau);
  if (c) tangent(parameters, strain, stress, basis, c);
  return LAW_OK;
}

static LawStatus update(const PetscReal *parameters, PetscInt n, const PetscReal *dF, const PetscReal *old,
                        PetscReal *state, PetscReal *tau, PetscReal *c)
{
  LawStatus worst = LAW_OK;
  for (PetscInt p = 0; p < n; ++p) {
    const LawStatus status =
      update_point(parameters, dF + 9 * p, old + 6 * p, state + 6 * p, tau + 6 * p, c ? c + 36 * p : NULL);
    worst = PetscMax(worst, status);
  }
  return worst;
}

static PetscReal energy(const PetscReal *parameters, const PetscReal *b)
{
  PetscReal stretch2[3], v[9], sum = 0.0;
  sym_eigen(b, stretch2, v);
  const PetscReal log_J = 0.5 * log(sym_det(b));
  for (int a = 0; a < 3; ++a) sum += pow(0.5 * log(stretch2[a]) - log_J / 3.0, 2);
  return 0.5 * parameters[BULK] * log_J * log_J + parameters[SHEAR] * sum;
}

/* tau = J sigma with ln J = tr tau / 3 K, and Hooke's law turned round. */
static PetscBool initial_stress(const PetscReal *parameters, const PetscReal sigma[6], PetscReal *b)
{
  const PetscReal mean = (sigma[0] + sigma[1] + sigma[2]) / 3.0;
  const PetscReal J = volume_from_pressure(VOLUME_LOG, parameters[BULK], mean);
  PetscReal s[3], v[9], basis[36];
  if (!(J > 0.0)) return PETSC_FALSE;
  sym_eigen(sigma, s, v);
  for (int a = 0; a < 3; ++a) s[a] = exp(2.0 * (log(J) / 3.0 + J * (s[a] - mean) / (2.0 * parameters[SHEAR])));
  principal_basis(v, basis);
  principal_tensor(s, basis, b);
  return PETSC_TRUE;
}

static void prepare(const Elasticity *elastic, const PetscReal *given, PetscReal *packed)
{
  (void)given;
  packed[BULK] = elastic->bulk;
  packed[SHEAR] = elastic->shear;
}

static void volume(PetscInt n, const PetscReal *state, PetscReal *J) { volume_of_b(n, 6, state, J); }

static VolumeLaw volume_law(const PetscReal *parameters)
{
  (void)parameters;
  return VOLUME_LOG;
}

const Law law_hencky = {
  .name = "hencky",
  .help = "Hencky's solid, linear in logarithmic strains",
  .parameters = (const LawParameter[]){{.name = NULL}},
  .fields = (const LawField[]){{"elastic_strain", "", "elastic left Cauchy-Green tensor b", 6, {1, 1, 1, 0, 0, 0}},
                               {.name = NULL}},
  .n_state = 6,
  .symmetric = PETSC_TRUE,
  .update = update,
  .energy = energy,
  .initial_stress = initial_stress,
  .volume = volume,
  .volume_law = volume_law,
  .prepare = prepare,
};
