/* The mean stress as an unknown of its own: volumes and energies of states under a pressure that is
 * not theirs. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>
#include "../conformance/random.h"
#include "base/math/tensor.h"
#include "material/pressure.h"

#define CALL(call) assert_int_equal((call), 0)
#define ASSERT_NEAR(a, b, tolerance) assert_true(PetscAbsReal((a) - (b)) <= (tolerance))

static NamedValue constants[8] = {{(char *)"young", 1e6}, {(char *)"poisson", 0.45}};

/* A material of the law, far from yielding. */
static Material mixed_material(const Law *law)
{
  static MaterialSpec spec;
  static const NamedValue more[] = {
    {(char *)"yield_stress", 1e6},  {(char *)"cohesion", 1e6},      {(char *)"friction_angle", 20},
    {(char *)"dilatancy_angle", 5}, {(char *)"residual_strain", 1}, {(char *)"static_friction", 5},
    {(char *)"limit_friction", 6},  {(char *)"grain_size", 1e-3},   {(char *)"grain_density", 2500}};
  PetscInt n = 2;
  Material m;
  Diag *diag;
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(more); ++k)
    for (const LawParameter *p = law->parameters; p->name; ++p)
      if (!strcmp(p->name, more[k].name)) constants[n++] = more[k];
  spec = (MaterialSpec){
    .name = (char *)"m", .law = (char *)law->name, .density = 1, .n_parameters = n, .parameters = constants};
  const Case c = {.formulation = (char *)"mixed", .n_materials = 1, .materials = &spec};
  CALL(DiagCreate(&diag));
  CALL(MaterialResolve(&c, 0, diag, &m));
  assert_int_equal(diag_errors(diag), 0);
  CALL(DiagDestroy(&diag));
  return m;
}

/* Grains without cohesion open under any pull, and forget what they open by. */
static PetscBool bears_tension(const Law *law)
{
  for (const LawParameter *p = law->parameters; p->name; ++p)
    if (!strcmp(p->name, "grain_size")) return PETSC_FALSE;
  return PETSC_TRUE;
}

static void random_increment(Random *random, PetscReal dF[9])
{
  for (int i = 0; i < 9; ++i) dF[i] = (i % 4 == 0) + random_real(random, -0.02, 0.02);
}

/* Lengths times a factor are volumes times its cube, and no other shape. */
static void test_scale(void **state)
{
  Random random = {3};
  (void)state;
  for (const Law *const *law = laws; *law; ++law) {
    if (!(*law)->scale || !(*law)->volume) continue;
    const Material m = mixed_material(*law);
    PetscReal old[LAW_MAX_STATE], now[LAW_MAX_STATE], tau[6], dF[9], before, after;
    law_initial_state(m.law, old);
    random_increment(&random, dF);
    for (int i = 0; i < 9 && !bears_tension(*law); i += 4) dF[i] -= 0.03;
    assert_int_equal(m.law->update(m.parameters, 1, dF, old, now, tau, NULL), LAW_OK);
    m.law->volume(1, now, &before);
    ASSERT_NEAR(before, tensor_det(dF), 1e-12);
    const PetscReal factor = 1.1, shape = now[3] / now[0];
    m.law->scale(1, &factor, now);
    m.law->volume(1, now, &after);
    ASSERT_NEAR(after / before, 1.331, 1e-12);
    ASSERT_NEAR(now[3] / now[0], shape, 1e-14);
  }
}

/* A point keeps the volume of its displacements, whatever the pressure asks for, over several
 * steps. */
static void test_volume_is_kept(void **state)
{
  Random random = {5};
  (void)state;
  for (const Law *const *law = laws; *law; ++law) {
    if (!(*law)->volume) continue;
    const Material m = mixed_material(*law);
    PetscReal old[LAW_MAX_STATE], now[LAW_MAX_STATE], dF[9], J = 1, found;
    PressureStress s;
    law_initial_state(m.law, old);
    for (int step = 0; step < 4; ++step) {
      const PetscReal asked = random_real(&random, -1e5, 1e5), p = bears_tension(*law) ? asked : -fabs(asked);
      random_increment(&random, dF);
      J *= tensor_det(dF);
      assert_int_equal(pressure_update(&m, m.law->update, 1, dF, &p, old, now, PETSC_FALSE, &s), LAW_OK);
      m.law->volume(1, now, &found);
      ASSERT_NEAR(found, J, 1e-12);
      ASSERT_NEAR(s.theta[0], m.volume == VOLUME_LINEAR ? J - 1 : log(J), 1e-12);
      ASSERT_NEAR(s.pressure[0], p, 1e-8 * 1e5);
      ASSERT_NEAR((s.tau[0] + s.tau[1] + s.tau[2]) / 3, m.volume == VOLUME_LINEAR ? J * p : p,
                  m.volume == VOLUME_COUPLED ? 0.05 * 1e6 : 1e-8 * 1e5);
      memcpy(old, now, sizeof old);
    }
  }
}

/* What is stored of volume is p^2 / 2K where the law keeps it apart from shape; where it does not,
 * what the law stores at exp(p / K). */
static void test_energy(void **state)
{
  const PetscReal bulk = 1e6 / (3 * (1 - 0.9)), pressures[] = {-2e5, -1e4, 0, 3e4, 1e5};
  Random random = {7};
  (void)state;
  for (const Law *const *law = laws; *law; ++law) {
    if (!(*law)->volume) continue;
    const Material m = mixed_material(*law);
    PetscReal old[LAW_MAX_STATE], now[LAW_MAX_STATE], tau[6], dF[9], J;
    law_initial_state(m.law, old);
    random_increment(&random, dF);
    assert_int_equal(m.law->update(m.parameters, 1, dF, old, now, tau, NULL), LAW_OK);
    m.law->volume(1, now, &J);
    const PetscReal none = pressure_energy(&m, now, 0);
    for (int k = 0; k < 5; ++k) {
      const PetscReal p = pressures[k], energy = pressure_energy(&m, now, p);
      if (m.volume != VOLUME_COUPLED) ASSERT_NEAR(energy - none, p * p / (2 * bulk), 1e-12 * bulk);
      else {
        PetscReal there[LAW_MAX_STATE];
        for (PetscInt i = 0; i < m.law->n_state; ++i) there[i] = now[i];
        for (int i = 0; i < 6; ++i) there[i] *= pow(exp(p / bulk) / J, 2. / 3);
        ASSERT_NEAR(energy, m.law->energy(m.parameters, there), 1e-12 * bulk);
      }
    }
  }
}

/* Pressures that vary inside a cell are held by 1 / G; of what has flowed at points that move through cells by its
 * shape over its stress, but by no more than MOST_SOFTENED / G. */
static void test_softness(void **state)
{
  const PetscReal tau[6] = {2e5, -1e5, -1e5}, none[6] = {0}; /* q = 3e5 */
  const char *const methods[] = {"fem", "mpm"};
  Diag *diag;
  (void)state;
  assert_int_equal(mixed_material(law_find("j2-log")).flow, 0);
  CALL(DiagCreate(&diag));
  for (int k = 0; k < 2; ++k) {
    MaterialSpec spec = {.name = (char *)"m", .law = (char *)"j2-log", .density = 1};
    NamedValue given[] = {{(char *)"young", 1e6}, {(char *)"poisson", 0.25}, {(char *)"yield_stress", 3e5}};
    spec.n_parameters = 3, spec.parameters = given;
    const Case c = {.method = (char *)methods[k], .formulation = (char *)"mixed", .n_materials = 1, .materials = &spec};
    PetscReal s[LAW_MAX_STATE];
    Material m;
    CALL(MaterialResolve(&c, 0, diag, &m));
    law_initial_state(m.law, s);
    ASSERT_NEAR(pressure_softness(&m, s, tau) * 4e5, 1, 1e-14); /* G */
    assert_true((m.flow > 0) == k);
    if (!m.flow) continue;
    s[m.flow - 1] = 0.5;
    ASSERT_NEAR(pressure_softness(&m, s, tau) * 4e5, 1 + 4e5 * 3 * 0.5 / 3e5, 1e-14);
    ASSERT_NEAR(pressure_softness(&m, s, none) * 4e5, MOST_SOFTENED, 1e-13);
  }
  CALL(DiagDestroy(&diag));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_scale), cmocka_unit_test(test_volume_is_kept),
                                     cmocka_unit_test(test_energy), cmocka_unit_test(test_softness)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failed;
}
