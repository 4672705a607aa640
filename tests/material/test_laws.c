/* Every law through the conformance suite: one line each (a few for different parameters). */
#include "../conformance/law_suite.h"

#define ELASTIC(E, nu)                              \
  2,                                                \
  {                                                 \
    {(char *)"young", E}, { (char *)"poisson", nu } \
  }

#define J2(E, nu, sigma_Y, H)                                                                                    \
  4,                                                                                                             \
  {                                                                                                              \
    {(char *)"young", E}, {(char *)"poisson", nu}, {(char *)"yield_stress", sigma_Y}, { (char *)"hardening", H } \
  }

#define MOHR_COULOMB(E, nu, phi, psi, c)                                                                              \
  5,                                                                                                                  \
  {                                                                                                                   \
    {(char *)"young", E}, {(char *)"poisson", nu}, {(char *)"friction_angle", phi}, {(char *)"dilatancy_angle", psi}, \
    {                                                                                                                 \
      (char *)"cohesion", c                                                                                           \
    }                                                                                                                 \
  }

#define CUT_OFF(E, nu, phi, psi, c, T)                                                                                \
  6,                                                                                                                  \
  {                                                                                                                   \
    {(char *)"young", E}, {(char *)"poisson", nu}, {(char *)"friction_angle", phi}, {(char *)"dilatancy_angle", psi}, \
      {(char *)"cohesion", c},                                                                                        \
    {                                                                                                                 \
      (char *)"tension_cutoff", T                                                                                     \
    }                                                                                                                 \
  }

#define REMEMBERS(E, nu, phi, psi, c, memory)                                                                         \
  6,                                                                                                                  \
  {                                                                                                                   \
    {(char *)"young", E}, {(char *)"poisson", nu}, {(char *)"friction_angle", phi}, {(char *)"dilatancy_angle", psi}, \
      {(char *)"cohesion", c},                                                                                        \
    {                                                                                                                 \
      (char *)"opening_memory", memory                                                                                \
    }                                                                                                                 \
  }

#define DRUCKER_PRAGER(E, nu, phi, psi, c, T, match)                                                                  \
  7,                                                                                                                  \
  {                                                                                                                   \
    {(char *)"young", E}, {(char *)"poisson", nu}, {(char *)"friction_angle", phi}, {(char *)"dilatancy_angle", psi}, \
      {(char *)"cohesion", c}, {(char *)"tension_cutoff", T},                                                         \
    {                                                                                                                 \
      (char *)"match", match                                                                                          \
    }                                                                                                                 \
  }

/* From (phi, psi, c) over those of the peak to a share of it, at the strains peak and residual. */
#define SOFTENING(E, nu, phi, psi, c, T, share, peak, residual)                                                       \
  13,                                                                                                                 \
  {                                                                                                                   \
    {(char *)"young", E}, {(char *)"poisson", nu}, {(char *)"friction_angle", phi}, {(char *)"dilatancy_angle", psi}, \
      {(char *)"cohesion", c}, {(char *)"tension_cutoff", T}, {(char *)"residual_friction_angle", (share) * (phi)},   \
      {(char *)"residual_dilatancy_angle", 0.5 * (share) * (psi)}, {(char *)"residual_cohesion", (share) * (c)},      \
      {(char *)"initial_friction_angle", 0.9 * (phi)}, {(char *)"initial_dilatancy_angle", 0.5 * (psi)},              \
      {(char *)"peak_strain", peak},                                                                                  \
    {                                                                                                                 \
      (char *)"residual_strain", residual                                                                             \
    }                                                                                                                 \
  }

/* Mean strains around the points, and the weights 2 and 1 of them. */
#define NONLOCAL(phi, c, share, residual, weight)                                                               \
  9,                                                                                                            \
  {                                                                                                             \
    {(char *)"young", 2e6}, {(char *)"poisson", 0.3}, {(char *)"friction_angle", phi}, {(char *)"cohesion", c}, \
      {(char *)"residual_friction_angle", (share) * (phi)}, {(char *)"residual_cohesion", (share) * (c)},       \
      {(char *)"residual_strain", residual}, {(char *)"nonlocal_length", 1},                                    \
    {                                                                                                           \
      (char *)"nonlocal_weight", weight                                                                         \
    }                                                                                                           \
  }

#define CAM_CLAY(M, lambda, kappa, v, G, ocr)                                                   \
  6,                                                                                            \
  {                                                                                             \
    {(char *)"critical_stress_ratio", M}, {(char *)"lambda", lambda}, {(char *)"kappa", kappa}, \
      {(char *)"specific_volume", v}, {(char *)"shear_modulus", G},                             \
    {                                                                                           \
      (char *)"ocr", ocr                                                                        \
    }                                                                                           \
  }

#define MU_I(E, nu, slow, fast, number, size)                                                              \
  7,                                                                                                       \
  {                                                                                                        \
    {(char *)"young", E}, {(char *)"poisson", nu}, {(char *)"static_friction", slow},                      \
      {(char *)"limit_friction", fast}, {(char *)"inertial_number", number}, {(char *)"grain_size", size}, \
    {                                                                                                      \
      (char *)"grain_density", 2500                                                                        \
    }                                                                                                      \
  }

static const LawUnderTest list[] = {
  {"neo-hookean", ELASTIC(90e6, 0.0), .strain = 0.3, .hyperelastic = PETSC_TRUE},
  {"neo-hookean", ELASTIC(70.0, 0.4999), .strain = 0.3, .hyperelastic = PETSC_TRUE},
  {"neo-hookean", ELASTIC(1e6, -0.5), .strain = 0.2, .hyperelastic = PETSC_TRUE},
  {"neo-hookean-split", ELASTIC(200e9, 0.3), .strain = 0.3, .hyperelastic = PETSC_TRUE},
  {"neo-hookean-split", ELASTIC(1.0, 0.49), .strain = 0.3, .hyperelastic = PETSC_TRUE},
  {"neo-hookean-split-log", ELASTIC(200e9, 0.3), .strain = 0.3, .hyperelastic = PETSC_TRUE},
  {"neo-hookean-split-log", ELASTIC(1.0, 0.49), .strain = 0.3, .hyperelastic = PETSC_TRUE},
  {"j2", J2(196.2e9, 0.3, 150e6, 0.0), .strain = 0.3},
  {"j2", J2(206.9e9, 0.29, 450e6, 129e6), .strain = 1e-3},
  {"j2", J2(1.0, 0.49, 0.05, 0.2), .strain = 0.3},
  {"j2-log", J2(196.2e9, 0.3, 150e6, 0.0), .strain = 1e-2},
  {"j2-log", J2(1.0, 0.4999, 0.1, 0.0), .strain = 0.1},
  {"mohr-coulomb", MOHR_COULOMB(1.8e6, 0.3, 25, 0, 5e3), .strain = 0.01},
  {"mohr-coulomb", MOHR_COULOMB(0.84e6, 0.3, 31, 1, 0), .strain = 0.3},
  {"mohr-coulomb", MOHR_COULOMB(1e6, 0.3, 39, 0, 16), .strain = 0.05},
  {"mohr-coulomb", MOHR_COULOMB(5e7, 0.25, 30, 30, 2e4), .strain = 0.3},
  {"mohr-coulomb", MOHR_COULOMB(1e4, 0.495, 0, 0, 100), .strain = 0.3},
  {"mohr-coulomb", MOHR_COULOMB(1e6, -0.3, 45, 10, 1e5), .strain = 0.3},
  {"mohr-coulomb", CUT_OFF(2e6, 0.2, 35, 12, 4e4, 2e4), .strain = 0.1},
  {"mohr-coulomb", CUT_OFF(1e4, 0.4, 0, 0, 100, 0), .strain = 0.1},
  {"mohr-coulomb", CUT_OFF(5e7, 0.25, 30, 30, 2e4, 1e4), .strain = 0.3},
  {"mohr-coulomb", REMEMBERS(0.84e6, 0.3, 31, 1, 0, 1), .strain = 0.3, .not_mixed = PETSC_TRUE},
  {"mohr-coulomb", REMEMBERS(1e6, 0.3, 39, 0, 16, 0.5), .strain = 0.05, .not_mixed = PETSC_TRUE},
  {"mohr-coulomb-softening", SOFTENING(1.8e6, 0.3, 25, 0, 5e3, 1e300, 0.5, 0.02, 0.1), .strain = 0.02, .corners = 0.04},
  {"mohr-coulomb-softening", SOFTENING(0.84e6, 0.3, 40, 10, 0, 1e300, 0.75, 0.1, 0.5), .strain = 0.2},
  {"mohr-coulomb-softening", SOFTENING(1e4, 0.45, 0, 0, 100, 1e300, 0.4, 0, 0.5), .strain = 0.2},
  {"mohr-coulomb-softening", SOFTENING(2e6, 0.2, 35, 12, 4e4, 2e4, 0.6, 0.05, 0.3), .strain = 0.1},
  {"mohr-coulomb-softening", NONLOCAL(30, 2e4, 0.6, 1, 2), .strain = 0.1, .heard = 0.3, .corners = 0.04},
  {"drucker-prager", DRUCKER_PRAGER(1.8e6, 0.3, 25, 0, 5e3, 1e300, 2), .strain = 0.01},
  {"drucker-prager", DRUCKER_PRAGER(0.84e6, 0.3, 31, 1, 0, 1e300, 0), .strain = 0.3},
  {"drucker-prager", DRUCKER_PRAGER(5e7, 0.25, 30, 30, 2e4, 1e300, 1), .strain = 0.3},
  {"drucker-prager", DRUCKER_PRAGER(1e4, 0.495, 0, 0, 100, 1e300, 0), .strain = 0.3},
  {"drucker-prager", DRUCKER_PRAGER(2e6, 0.2, 35, 12, 4e4, 2e4, 2), .strain = 0.1},
  {"drucker-prager", DRUCKER_PRAGER(1e4, 0.4, 0, 0, 100, 20, 0), .strain = 0.1},
  {"modified-cam-clay", CAM_CLAY(1.0, 0.2, 0.05, 2.0, 3e6, 1.0), .strain = 0.02, .pressure = 1e5,
   .not_mixed = PETSC_TRUE, .may_refuse = PETSC_TRUE},
  {"modified-cam-clay", CAM_CLAY(1.2, 0.1, 0.02, 1, 2e6, 2.0), .strain = 0.01, .pressure = 5e4, .not_mixed = PETSC_TRUE,
   .may_refuse = PETSC_TRUE},
  {"modified-cam-clay", CAM_CLAY(0.9, 0.25, 0.05, 2.2, 1e6, 8.0), .strain = 0.03, .pressure = 2e4,
   .not_mixed = PETSC_TRUE, .may_refuse = PETSC_TRUE},
  {"mu-i", MU_I(2e6, 0.3, 0.38, 0.64, 0.3, 1e-3), .strain = 0.1},
  {"mu-i", MU_I(2e6, 0.3, 0.38, 0.64, 0.3, 1e-2), .strain = 0.01, .dt = 1e-3},
  {"mu-i", MU_I(1e5, 0.45, 0.2, 2.0, 0.05, 0.1), .strain = 0.3, .dt = 1e-2},
};

static void test_suite(void **state)
{
  (void)state;
  for (size_t i = 0; i < sizeof list / sizeof list[0]; ++i) law_suite_run(&list[i]);
}

/* No law is forgotten here. */
static void test_every_law_is_listed(void **state)
{
  (void)state;
  for (const Law *const *law = laws; *law; ++law) {
    PetscBool found = PETSC_FALSE;
    for (size_t i = 0; i < sizeof list / sizeof list[0]; ++i)
      if (!strcmp(list[i].law, (*law)->name)) found = PETSC_TRUE;
    if (!found) fail_msg("%s has not been through the conformance suite", (*law)->name);
  }
}

/* What `talus list laws` and the case reader rely on. */
static void test_registry(void **state)
{
  (void)state;
  assert_null(law_find("no-such-law"));
  assert_null(law_find(NULL));
  for (const Law *const *law = laws; *law; ++law) {
    PetscInt n_state = 0, n_parameters = 0;
    assert_ptr_equal(law_find((*law)->name), *law);
    assert_true((*law)->help && strlen((*law)->help) > 10);
    for (const LawField *field = (*law)->fields; field->name; ++field) n_state += field->components;
    for (const LawParameter *p = (*law)->parameters; p->name; ++p, ++n_parameters)
      assert_true(p->help && p->unit && p->min < p->max);
    assert_int_equal(n_state, (*law)->n_state);
    assert_true(n_state <= LAW_MAX_STATE && n_parameters <= LAW_MAX_PARAMETERS);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_suite),
    cmocka_unit_test(test_every_law_is_listed),
    cmocka_unit_test(test_registry),
  };
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failures = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failures;
}
