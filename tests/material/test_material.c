/* From the case to a material: elastic constants, ranges, defaults, degrees, and every complaint
 * with its path. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include "material/elasticity.h"
#include "material/mohr_coulomb/mohr_coulomb_softening.h"

static const char *const names[ELASTIC_CONSTANTS] = {"young", "poisson", "bulk", "shear", "lame"};

/* All ten pairs of constants of one solid give the other three back. */
static void round_trip(PetscReal young, PetscReal poisson)
{
  const PetscReal value[2] = {young, poisson};
  PetscReal seed[ELASTIC_CONSTANTS] = {value[0], value[1]};
  Elasticity first;
  assert_true(elasticity_from_two(3u, seed, &first));
  const PetscReal all[ELASTIC_CONSTANTS] = {first.young, first.poisson, first.bulk, first.shear, first.lame};
  for (int i = 0; i < ELASTIC_CONSTANTS; ++i)
    for (int j = i + 1; j < ELASTIC_CONSTANTS; ++j) {
      PetscReal two[ELASTIC_CONSTANTS] = {0};
      Elasticity e;
      two[i] = all[i], two[j] = all[j];
      assert_true(elasticity_from_two(1u << i | 1u << j, two, &e));
      const PetscReal got[ELASTIC_CONSTANTS] = {e.young, e.poisson, e.bulk, e.shear, e.lame};
      for (int k = 0; k < ELASTIC_CONSTANTS; ++k)
        assert_true(fabs(got[k] - all[k]) <= 1e-12 * fmax(fabs(all[k]), k == 1 ? 1.0 : all[0]));
      assert_true(got[i] == all[i] && got[j] == all[j]);
    }
}

static void test_every_pair(void **state)
{
  (void)state;
  round_trip(90e6, 0.25);
  round_trip(210e9, 0.3);
  round_trip(1.0, 0.1);
  round_trip(70.0, -0.3);
}

/* Aluminium in round numbers: K 75, G 25 give E 67.5, nu 0.35, lambda 58.333. */
static void test_known_solid(void **state)
{
  (void)state;
  const PetscReal value[ELASTIC_CONSTANTS] = {0, 0, 75, 25, 0};
  Elasticity e;
  assert_true(elasticity_from_two(1u << 2 | 1u << 3, value, &e));
  assert_true(fabs(e.young - 67.5) < 1e-13 && fabs(e.poisson - 0.35) < 1e-15 && fabs(e.lame - 175.0 / 3.0) < 1e-13);
}

/* nu = 0 must give lambda = 0 exactly, not the rest of a difference. */
static void test_zero_poisson(void **state)
{
  (void)state;
  const PetscReal value[ELASTIC_CONSTANTS] = {90e6, 0};
  Elasticity e;
  assert_true(elasticity_from_two(3u, value, &e));
  assert_true(e.lame == 0.0 && e.shear == 45e6 && e.bulk == 30e6);
}

typedef struct {
  Diag *diag;
  char *text;
  size_t size;
  Material material;
} Outcome;

static void print_path(void *context, const char *path, DiagPlace *place)
{
  (void)context;
  *place = (DiagPlace){.file = path ? path : "case"};
}

/* Resolve one material and keep what was said: the path stands where a file name would. */
static void resolve(const char *law, PetscReal density, PetscInt n, const NamedValue *parameters, Outcome *out)
{
  MaterialSpec spec = {.name = (char *)"rubber",
                       .law = (char *)law,
                       .density = density,
                       .n_parameters = n,
                       .parameters = (NamedValue *)parameters};
  const Case c = {.n_materials = 1, .materials = &spec};
  memset(out, 0, sizeof *out);
  assert_int_equal(DiagCreate(&out->diag), 0);
  assert_int_equal(DiagSetResolver(out->diag, print_path, NULL), 0);
  assert_int_equal(MaterialResolve(&c, 0, out->diag, &out->material), 0);
}

static void finish(Outcome *out, PetscInt errors, const char *path, const char *words)
{
  FILE *stream = open_memstream(&out->text, &out->size);
  assert_int_equal(diag_errors(out->diag), errors);
  assert_int_equal(DiagFlush(out->diag, stream), 0);
  fclose(stream);
  if (path && !strstr(out->text, path)) fail_msg("no '%s' in: %s", path, out->text);
  if (words && !strstr(out->text, words)) fail_msg("no '%s' in: %s", words, out->text);
  free(out->text);
  assert_int_equal(DiagDestroy(&out->diag), 0);
}

#define P(key, number)  \
  {                     \
    (char *)key, number \
  }

static void test_resolve(void **state)
{
  (void)state;
  const NamedValue good[] = {P("poisson", 0.25), P("young", 5.0)};
  Outcome out;
  resolve("neo-hookean", 1000, 2, good, &out);
  assert_string_equal(out.material.name, "rubber");
  assert_ptr_equal(out.material.law, law_find("neo-hookean"));
  assert_true(out.material.density == 1000 && out.material.elastic.young == 5.0);
  assert_true(fabs(out.material.wave_modulus - 6.0) < 1e-14); /* lambda = mu = 2 */
  assert_true(fabs(out.material.parameters[0] - 2.0) < 1e-15 && fabs(out.material.parameters[1] - 2.0) < 1e-15);
  finish(&out, 0, NULL, NULL);
}

static void expect(const char *law, PetscReal density, PetscInt n, const NamedValue *parameters, const char *path,
                   const char *words)
{
  Outcome out;
  resolve(law, density, n, parameters, &out);
  finish(&out, 1, path, words);
}

static void test_mistakes(void **state)
{
  (void)state;
  const NamedValue good[] = {P("young", 1), P("poisson", 0.3), P("shear", 1), P("colour", 7)};
  expect("neo-hooke", 1, 2, good, "materials.rubber.law", "neo-hookean");
  expect("zzz", 1, 2, good, "materials.rubber.law", "talus list laws");
  expect(NULL, 1, 2, good, "materials.rubber.law", "no law");
  expect("neo-hookean", 0, 2, good, "materials.rubber.density", "positive");
  expect("neo-hookean", -2, 2, good, "materials.rubber.density", "-2");
  expect("neo-hookean", NAN, 2, good, "materials.rubber.density", "nan");
  expect("neo-hookean", 1, 1, good, "materials.rubber", "has 1 (young)");
  expect("neo-hookean", 1, 0, good, "materials.rubber", "has 0");
  expect("neo-hookean", 1, 3, good, "materials.rubber", "has 3 (young, poisson, shear)");
  const NamedValue unknown[] = {P("young", 1), P("poisson", 0.3), P("poissson", 0.3)};
  expect("neo-hookean", 1, 3, unknown, "materials.rubber.poissson", "did you mean 'poisson'");
}

static void test_bad_constants(void **state)
{
  (void)state;
  const NamedValue half[] = {P("young", 1), P("poisson", 0.5)}, minus_one[] = {P("young", 1), P("poisson", -1)};
  const NamedValue negative[] = {P("young", -1), P("poisson", 0.3)}, zero[] = {P("young", 0), P("poisson", 0.3)};
  const NamedValue nan[] = {P("young", NAN), P("poisson", 0.3)}, infinite[] = {P("young", INFINITY), P("poisson", 0.3)};
  expect("neo-hookean", 1, 2, half, "materials.rubber.poisson", "`formulation: mixed`");
  expect("neo-hookean", 1, 2, minus_one, "materials.rubber.poisson", "between -1 and 0.5");
  expect("neo-hookean", 1, 2, negative, "materials.rubber.young", "positive");
  expect("neo-hookean", 1, 2, zero, "materials.rubber.young", "positive");
  expect("neo-hookean", 1, 2, nan, "materials.rubber.young", "finite");
  expect("neo-hookean", 1, 2, infinite, "materials.rubber.young", "finite");
  const NamedValue stiff[] = {P("young", 10), P("shear", 1)};     /* nu = 4 */
  const NamedValue lame[] = {P("shear", 3), P("lame", -2)};       /* bulk modulus 0 */
  const NamedValue zero_zero[] = {P("poisson", 0), P("lame", 0)}; /* says nothing */
  expect("neo-hookean", 1, 2, stiff, "materials.rubber", "not a stable solid");
  expect("neo-hookean", 1, 2, lame, "materials.rubber", "not a stable solid");
  expect("neo-hookean", 1, 2, zero_zero, "materials.rubber", "not a stable solid");
}

/* All mistakes of a material are told at once. */
static void test_all_mistakes_together(void **state)
{
  (void)state;
  const NamedValue bad[] = {P("young", -1), P("poisson", 0.7), P("wetness", 1)};
  Outcome out;
  resolve("neo-hookean", -1, 3, bad, &out);
  finish(&out, 4, "materials.rubber.wetness", "materials.rubber.young");
}

/* The material after `factor` has the parameters of the other one. */
static void check_reduced(const char *law, PetscReal factor, PetscInt n, const NamedValue *before,
                          const NamedValue *after)
{
  Outcome a, b;
  resolve(law, 1000, n, before, &a);
  resolve(law, 1000, n, after, &b);
  material_reduce(&a.material, factor);
  for (int k = 0; k < LAW_MAX_PARAMETERS; ++k) {
    const PetscReal x = a.material.parameters[k], y = b.material.parameters[k];
    assert_true(x == y || fabs(x - y) <= 1e-14 * fabs(y));
  }
  finish(&a, 0, NULL, NULL);
  finish(&b, 0, NULL, NULL);
}

/* tan 45 deg over the root of 3 is tan 30 deg, and no more dilates. */
static void test_reduced(void **state)
{
  const PetscReal f = sqrt(3.0);
  (void)state;
#define SOIL(phi, psi, c, T)                                                                                   \
  {                                                                                                            \
    P("young", 1e6), P("poisson", 0.3), P("friction_angle", phi), P("dilatancy_angle", psi), P("cohesion", c), \
      P("tension_cutoff", T)                                                                                   \
  }
  const NamedValue soil[] = SOIL(45, 40, 100 * f, 10 * f), weaker[] = SOIL(30, 30, 100, 10);
  const NamedValue little[] = SOIL(45, 5, 100 * f, 10 * f), as_little[] = SOIL(30, 5, 100, 10);
#define SOFT(phi, psi, c, residual)                                                                             \
  {                                                                                                             \
    P("young", 1e6), P("poisson", 0.25), P("friction_angle", phi), P("dilatancy_angle", psi), P("cohesion", c), \
      P("residual_friction_angle", phi), P("residual_dilatancy_angle", psi), P("residual_cohesion", residual),  \
      P("residual_strain", 0.1)                                                                                 \
  }
  const NamedValue soft[] = SOFT(45, 40, 100 * f, 50 * f), as_soft[] = SOFT(30, 30, 100, 50);
  const NamedValue steel[] = {P("young", 2e11), P("poisson", 0.3), P("yield_stress", 2e8), P("hardening", 4e9)};
  const NamedValue softer[] = {P("young", 2e11), P("poisson", 0.3), P("yield_stress", 1e8), P("hardening", 2e9)};
  check_reduced("mohr-coulomb", f, 6, soil, weaker);
  check_reduced("mohr-coulomb", f, 6, little, as_little);
  check_reduced("mohr-coulomb", 1, 6, soil, soil);
  check_reduced("j2", 2, 4, steel, softer);
  check_reduced("drucker-prager", f, 6, soil, weaker);
  check_reduced("drucker-prager", f, 6, little, as_little);
  check_reduced("mohr-coulomb-softening", f, 9, soft, as_soft);
  check_reduced("mohr-coulomb-softening", 1, 9, soft, soft);
}

/* With factor 0 nothing yields: stress is Hooke's in the logarithmic strain. */
static void check_endless(const char *law, PetscInt n, const NamedValue *clay)
{
  const PetscReal stretch = 1.01, dF[9] = {1 / stretch, 0, 0, 0, stretch, 0, 0, 0, 1};
  PetscReal old[LAW_MAX_STATE], now[LAW_MAX_STATE], tau[6];
  Outcome out;
  resolve(law, 1000, n, clay, &out);
  material_reduce(&out.material, 0);
  law_initial_state(out.material.law, old);
  assert_int_equal(out.material.law->update(out.material.parameters, 1, dF, old, now, tau, NULL), LAW_OK);
  assert_true(fabs(tau[1] - 8e5 * log(stretch)) < 1e-6); /* 2 mu = 8e5 */
  finish(&out, 0, NULL, NULL);
}

static void test_endless(void **state)
{
  const NamedValue clay[] = {P("young", 1e6), P("poisson", 0.25), P("friction_angle", 20), P("cohesion", 1),
                             P("residual_strain", 0.1)};
  (void)state;
  check_endless("mohr-coulomb", 4, clay);
  check_endless("drucker-prager", 4, clay);
  check_endless("mohr-coulomb-softening", 5, clay);
}

/* Keys that may be left out count as those of the peak; what contradicts itself is refused. */
static void test_left_out(void **state)
{
  const NamedValue soil[] = {P("young", 1e6),   P("poisson", 0.25),        P("friction_angle", 20),
                             P("cohesion", 10), P("residual_strain", 0.1), P("peak_strain", 0.2)};
  Outcome out;
  (void)state;
  resolve("mohr-coulomb-softening", 1000, 5, soil, &out);
  assert_true(isnan(out.material.given[6]) && out.material.parameters[SOFT_COHESION + 2] == 10);
  finish(&out, 0, NULL, NULL);
  resolve("mohr-coulomb-softening", 1000, 6, soil, &out);
  finish(&out, 1, "materials.rubber", "residual_strain must be larger than peak_strain");
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_every_pair),
    cmocka_unit_test(test_known_solid),
    cmocka_unit_test(test_zero_poisson),
    cmocka_unit_test(test_resolve),
    cmocka_unit_test(test_mistakes),
    cmocka_unit_test(test_bad_constants),
    cmocka_unit_test(test_all_mistakes_together),
    cmocka_unit_test(test_reduced),
    cmocka_unit_test(test_endless),
    cmocka_unit_test(test_left_out),
  };
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  for (int i = 0; i < ELASTIC_CONSTANTS; ++i)
    if (strcmp(names[i], elastic_constants[i].name)) return 1;
  const int failures = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failures;
}
