/* Mohr-Coulomb: the return in principal stresses and the law, against golden numbers and an
 * independent solution. */
#include "../conformance/golden.h"
#include "../reference/mohr_coulomb.h"
#include "base/math/eigen.h"
#include "mc_sample.h"
#include <string.h>

static void assert_near(const char *what, PetscInt n, const PetscReal *value, const PetscReal *expected,
                        PetscReal tolerance)
{
  for (PetscInt k = 0; k < n; ++k)
    if (!(fabs(value[k] - expected[k]) <= tolerance))
      fail_msg("%s, number %d: %.17g, expected %.17g, tolerance %.2g", what, (int)k, value[k], expected[k], tolerance);
}

static const Law *golden_law(struct fy_node *item, PetscReal *packed)
{
  const PetscReal given[5] = {golden_number(item, "phi"), golden_number(item, "psi"), golden_number(item, "c"), 1e300};
  return packed_law("mohr-coulomb", golden_number(item, "E"), golden_number(item, "nu"), given, packed);
}

/* The golden states keep their order, and so does a diagonal b: drive the whole law with it. */
static void check_principal(struct fy_node *item)
{
  const PetscReal unit[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  PetscReal packed[LAW_MAX_PARAMETERS], old[MC_STATE] = {0}, state[MC_STATE], tau[6], c[36], e[3], golden[9], trial[3];
  const Law *law = golden_law(item, packed);
  golden_numbers(item, "eps_e_trial", 3, e);
  for (int a = 0; a < 3; ++a) old[a] = exp(2.0 * e[a]);
  assert_int_equal(law->update(packed, 1, unit, old, state, tau, c), LAW_OK);
  golden_numbers(item, "tau_trial", 3, trial);
  golden_numbers(item, "tau", 3, golden);
  assert_near("tau", 3, tau, golden, 1e-9 * packed_largest(3, trial));
  golden_numbers(item, "eps_e", 3, golden);
  for (int a = 0; a < 3; ++a) e[a] = 0.5 * log(state[a]);
  assert_near("elastic strain", 3, e, golden, 1e-12);
  golden_numbers(item, "D_ep", 9, golden);
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) {
      const PetscReal D = c[6 * a + b] + (a == b ? 2.0 * tau[a] : 0.0);
      /* the golden moduli are differences, good to some 2e-8 of the modulus */
      assert_near("D", 1, &D, &golden[3 * a + b], 2e-8 * (packed[MC_LAMBDA] + packed[MC_MU]));
    }
}

static void check_tensor(struct fy_node *item)
{
  PetscReal packed[LAW_MAX_PARAMETERS], f[9], old[MC_STATE] = {0}, state[MC_STATE], tau[6], c[36], golden[36], trial[3];
  const Law *law = golden_law(item, packed);
  golden_numbers(item, "f", 9, f);
  golden_symmetric(item, "be_n", old);
  assert_int_equal(law->update(packed, 1, f, old, state, tau, c), LAW_OK);
  golden_symmetric(item, "tau", golden);
  golden_numbers(item, "principal_trial_sorted_by_eigh", 3, trial);
  assert_near("tau", 6, tau, golden, 1e-9 * packed_largest(3, trial));
  golden_symmetric(item, "be", golden);
  assert_near("be", 6, state, golden, 1e-12);
  golden_numbers(item, "c_lie_voigt", 36, golden);
  assert_near("c", 36, c, golden, fmax(1e-9 * packed_largest(36, golden), golden_number(item, "fd_uncertainty")));
}

static void test_golden(void **unused)
{
  (void)unused;
  static const char *list[2] = {"/principal", "/tensor"};
  struct fy_document *document = golden_open("mohr_coulomb.json");
  int n[2] = {0};
  for (int k = 0; k < 2; ++k) {
    struct fy_node *cases = fy_node_by_path(fy_document_root(document), list[k], FY_NT, FYNWF_DONT_FOLLOW);
    void *at = NULL;
    for (struct fy_node *item; (item = fy_node_sequence_iterate(cases, &at)); ++n[k])
      k ? check_tensor(item) : check_principal(item);
  }
  assert_int_equal(n[0], 37);
  assert_int_equal(n[1], 23);
  fy_document_destroy(document);
}

#define BATCH 8

static TextbookSoil soil_of(const McSample *s, const PetscReal *p)
{
  const PetscReal rad = PETSC_PI / 180.0;
  return (TextbookSoil){p[MC_LAMBDA],       p[MC_MU],    s->friction * rad,
                        s->dilatancy * rad, s->cohesion, s->cutoff < 1e300 ? s->cutoff : INFINITY,
                        s->memory};
}

/* An increment and an elastic state before it whose trial strains are e, in directions of chance;
 * flat: z stays what it is. */
static void random_increment(Random *random, const PetscReal *p, PetscBool flat, const PetscReal e[3], PetscReal f[9],
                             PetscReal old[MC_STATE])
{
  PetscReal q[9], diagonal[6] = {0}, trial[6], back[9];
  for (int k = 0; k < 9; ++k) f[k] = (k % 4 == 0) + random_real(random, -0.1, 0.1);
  random_rotation(random, q);
  if (flat) {
    const PetscReal angle = random_real(random, 0, 7), c = cos(angle), s = sin(angle);
    const PetscReal turn[9] = {c, -s, 0, s, c, 0, 0, 0, 1};
    memcpy(q, turn, sizeof turn);
    f[2] = f[5] = f[6] = f[7] = 0.0, f[8] = 1.0;
  }
  const int shift = (int)random_real(random, 0, 3); /* which of them stands along z? */
  for (int k = 0; k < 3; ++k) diagonal[k] = exp(2.0 * e[(k + shift) % 3]);
  sym_push_forward(q, diagonal, trial);
  tensor_inverse(f, back);
  sym_push_forward(back, trial, old);
  old[6] = random_real(random, 0, 1);
  mc_sample_opening(random, p, old);
}

/* One point of the textbook against what the law made of it. */
static int compare_textbook(const McSample *sample, const PetscReal *p, const PetscReal f[9],
                            const PetscReal old[MC_STATE], const PetscReal state[MC_STATE], const PetscReal tau[6])
{
  const TextbookSoil soil = soil_of(sample, p);
  double F[3][3], b[3][3], full[9], stress[3][3], plastic = old[6], opening = old[7];
  memcpy(F, f, sizeof F);
  sym_to_full(old, full);
  memcpy(b, full, sizeof b);
  const int region = textbook_update(&soil, F, b, &plastic, &opening, stress);
  PetscReal strain = 1e-4; /* b starts from 1: strains below this have fewer digits */
  for (int k = 0; k < 6; ++k) strain = fmax(strain, fabs(state[k] - (k < 3)));
  const PetscReal size = packed_largest(6, tau) + p[MC_Q] + (p[MC_LAMBDA] + 2.0 * p[MC_MU]) * strain;
  for (int k = 0; k < 6; ++k) {
    const int i = voigt_row[k], j = voigt_column[k];
    if (!(fabs(tau[k] - stress[i][j]) <= 1e-10 * size && fabs(state[k] - b[i][j]) <= 1e-10))
      fail_msg("%s, %s, component %d: stress %.17g, not %.17g; b %.17g, not %.17g", sample->name,
               textbook_regions[region].name, k, tau[k], stress[i][j], state[k], b[i][j]);
  }
  if (!(fabs(state[6] - plastic) <= 1e-10))
    fail_msg("%s: plastic strain %.17g, not %.17g", sample->name, state[6], plastic);
  if (!(fabs(state[7] - opening) <= 1e-10))
    fail_msg("%s, %s: opening %.17g, not %.17g", sample->name, textbook_regions[region].name, state[7], opening);
  return region;
}

/* Can the return of this soil end there? A face of tension that is cut off takes the place of the
 * apex. */
static PetscBool reaches(const PetscReal *p, int region)
{
  const PetscBool cut = isfinite(p[MC_CUT]) != 0;
  if (region == TEXTBOOK_APEX) return !cut && p[MC_K] > 1.0;
  for (int s = 0; s < textbook_regions[region].n; ++s)
    if (textbook_regions[region].plane[s] >= TENSION_1) return cut;
  return PETSC_TRUE;
}

/* The law, for eight points at once and in the plane, against the textbook's. */
static void test_against_textbook(void **unused)
{
  (void)unused;
  Random random = {2019};
  for (int m = 0; m < MC_SAMPLES; ++m) {
    PetscReal p[LAW_MAX_PARAMETERS], e[3], f[9 * BATCH], old[MC_STATE * BATCH], state[MC_STATE * BATCH], tau[6 * BATCH];
    int count[TEXTBOOK_REGIONS] = {0};
    const Law *law = mc_sample_pack(&mc_samples[m], p);
    for (int s = 0; s < 1400; ++s) {
      const PetscBool flat = s % 3 == 0;
      for (int k = 0; k < BATCH; ++k) {
        mc_sample_trial(&random, mc_sample_strain(p, mc_samples[m].young), e);
        random_increment(&random, p, flat, e, f + 9 * k, old + MC_STATE * k);
      }
      assert_int_equal((flat ? law->update_plane : law->update)(p, BATCH, f, old, state, tau, NULL), LAW_OK);
      for (int k = 0; k < BATCH; ++k)
        ++count[compare_textbook(&mc_samples[m], p, f + 9 * k, old + MC_STATE * k, state + MC_STATE * k, tau + 6 * k)];
    }
    for (int r = 0; r < TEXTBOOK_REGIONS; ++r) {
      if (getenv("TALUS_TEST_PRINT"))
        print_message("%s, %s: %d\n", mc_samples[m].name, textbook_regions[r].name, count[r]);
      if (reaches(p, r) && count[r] < 20)
        fail_msg("%s: %s has been met %d times", mc_samples[m].name, textbook_regions[r].name, count[r]);
    }
  }
}

/* Neighbouring strains have neighbouring stresses, also across every border between regions. */
static void test_continuity(void **unused)
{
  (void)unused;
  Random random = {4};
  for (int m = 0; m < MC_SAMPLES; ++m) {
    PetscReal p[LAW_MAX_PARAMETERS], a[3], b[3], ta[3], tb[3];
    mc_sample_pack(&mc_samples[m], p);
    const PetscReal scale = mc_sample_strain(p, mc_samples[m].young), modulus = p[MC_LAMBDA] + 2.0 * p[MC_MU];
    for (int s = 0; s < 20000; ++s) {
      mc_sample_trial(&random, scale, a);
      mc_sample_trial(&random, scale, b);
      McRegion ra = mc_return(p, a, ta), rb = mc_return(p, b, tb);
      /* come to a border between the two */
      for (int halved = 0; halved < 60 && ra != rb; ++halved) {
        PetscReal middle[3], tau[3];
        for (int k = 0; k < 3; ++k) middle[k] = 0.5 * (a[k] + b[k]);
        const McRegion region = mc_return(p, middle, tau);
        const PetscBool left = region == ra;
        memcpy(left ? a : b, middle, sizeof middle);
        memcpy(left ? ta : tb, tau, sizeof tau);
        if (!left) rb = region;
      }
      PetscReal apart = 0.0;
      for (int k = 0; k < 3; ++k) apart = fmax(apart, fabs(a[k] - b[k]));
      for (int k = 0; k < 3; ++k)
        if (!(fabs(ta[k] - tb[k]) <= 20 * p[MC_K] * modulus * (apart + 1e-14 * (1 + packed_largest(3, a)))))
          fail_msg("%s: a jump between regions %d and %d", mc_samples[m].name, (int)ra, (int)rb);
    }
  }
}

/* On the surface after a plastic step, to rounding; inside before. */
static void test_yield(void **unused)
{
  (void)unused;
  Random random = {5};
  for (int m = 0; m < MC_SAMPLES; ++m) {
    const PetscReal unit[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    PetscReal p[LAW_MAX_PARAMETERS], e[3], q[9], diagonal[6] = {0}, old[MC_STATE], state[MC_STATE], tau[6],
                                                 principal[3], v[9];
    const Law *law = mc_sample_pack(&mc_samples[m], p);
    for (int s = 0; s < 3000; ++s) {
      mc_sample_trial(&random, mc_sample_strain(p, mc_samples[m].young), e);
      random_rotation(&random, q);
      for (int k = 0; k < 3; ++k) diagonal[k] = exp(2.0 * e[k]);
      sym_push_forward(q, diagonal, old);
      old[6] = 0.25;
      mc_sample_opening(&random, p, old);
      assert_int_equal(law->update(p, 1, unit, old, state, tau, NULL), LAW_OK);
      sym_eigen(tau, principal, v);
      const PetscReal f = fmax(mc_yield(p, principal), principal[0] - p[MC_CUT]);
      /* stress scale: what the strains at hand amount to, and the rounding of b, which starts at
       * 1 */
      const PetscReal trial = (p[MC_LAMBDA] + 2.0 * p[MC_MU]) * fmax(packed_largest(3, e), 1e-4);
      assert_true(f <= 1e-10 * (trial + p[MC_Q]));
      assert_true(state[6] >= 0.25);
      if (state[6] > 0.25 + 1e-12) assert_true(fabs(f) <= 1e-10 * (trial + p[MC_Q]) || principal[0] <= 1e-9 * trial);
    }
  }
}

/* A cohesionless point that opens carries nothing, forgets how far it opened, and resists at once
 * when it closes. */
static void test_separation(void **unused)
{
  (void)unused;
  const PetscReal open[9] = {1.1, 0.02, 0, 0, 1.2, 0, 0, 0, 1}, close[9] = {0.999, 0, 0, 0, 0.999, 0, 0, 0, 0.999};
  const PetscReal unit[6] = {1, 1, 1, 0, 0, 0}, none[6] = {0};
  PetscReal p[LAW_MAX_PARAMETERS], old[MC_STATE], state[MC_STATE], tau[6], c[36];
  const Law *law = mc_sample_pack(&mc_samples[1], p);
  law_initial_state(law, old);
  for (int step = 0; step < 50; ++step) {
    assert_int_equal(law->update(p, 1, open, old, state, tau, c), LAW_OK);
    assert_near("stress of a separated point", 6, tau, none, 0.0);
    for (int k = 0; k < 36; ++k) assert_true(c[k] == 0.0);
    assert_near("its elastic strain", 6, state, unit, 0.0);
    assert_true(state[6] > old[6]);
    memcpy(old, state, sizeof old);
  }
  assert_int_equal(law->update(p, 1, close, old, state, tau, c), LAW_OK);
  const PetscReal pressure = (3.0 * p[MC_LAMBDA] + 2.0 * p[MC_MU]) * log(0.999);
  const PetscReal expected[6] = {pressure, pressure, pressure, 0, 0, 0};
  assert_near("stress in contact", 6, tau, expected, 1e-12 * p[MC_LAMBDA]);
  assert_true(state[6] == old[6]);
}

/* Biaxial compression in plane strain: at failure the in-plane stresses stand in the ratio k,
 * nothing flows across the plane, and the flow within it is gamma (m, -1), with gamma for the
 * equivalent plastic strain. */
static void test_plane_strain_failure(void **unused)
{
  (void)unused;
  const PetscReal f[9] = {0.9999, 0, 0, 0, 1.00009, 0, 0, 0, 1}, sigma[6] = {-1e3, -1e3, -1e3, 0, 0, 0};
  PetscReal p[LAW_MAX_PARAMETERS], first[MC_STATE], old[MC_STATE], state[MC_STATE], tau[6];
  const Law *law = mc_sample_pack(&mc_samples[1], p);
  assert_true(law->initial_stress(p, sigma, first));
  memcpy(old, first, sizeof old);
  for (int step = 0; step < 60; ++step) {
    assert_int_equal(law->update(p, 1, f, old, state, tau, NULL), LAW_OK);
    memcpy(old, state, sizeof old);
  }
  const PetscReal ratio = tau[0] / tau[1], gamma = state[6], expected[3] = {-gamma, p[MC_M] * gamma, 0.0};
  PetscReal plastic[3];
  for (int k = 0; k < 3; ++k) plastic[k] = 60 * log(f[4 * k]) - 0.5 * log(state[k] / first[k]);
  assert_true(gamma > 3e-3);
  assert_near("stress ratio", 1, &ratio, &p[MC_K], 1e-9);
  assert_near("flow", 3, plastic, expected, 1e-12);
}

static void test_initial_stress(void **unused)
{
  (void)unused;
  const PetscReal inside[6] = {-50e3, -80e3, -60e3, 5e3, 0, 0}, outside[6] = {-50e3, -300e3, -60e3, 5e3, 0, 0};
  const PetscReal pulled[6] = {4e3, 0, 0, 0, 0, 0};
  PetscReal p[LAW_MAX_PARAMETERS], state[MC_STATE];
  const Law *law = mc_sample_pack(&mc_samples[0], p);
  assert_true(law->initial_stress(p, inside, state));
  assert_false(law->initial_stress(p, outside, state));
  assert_true(law->initial_stress(p, pulled, state));
  mc_sample_pack(&mc_samples[8], p); /* the same with a cut-off at 3 kPa */
  assert_false(law->initial_stress(p, pulled, state));
}

/* More dilatancy than friction is refused, with the material's path. */
static void test_refused(void **unused)
{
  (void)unused;
  NamedValue value[] = {{(char *)"young", 1e6},
                        {(char *)"poisson", 0.3},
                        {(char *)"friction_angle", 30},
                        {(char *)"cohesion", 0},
                        {(char *)"dilatancy_angle", 31}};
  MaterialSpec spec = {
    .name = (char *)"sand", .law = (char *)"mohr-coulomb", .density = 1.0, .n_parameters = 5, .parameters = value};
  const Case c = {.n_materials = 1, .materials = &spec};
  Material material;
  Diag *diag = NULL;
  assert_int_equal(DiagCreate(&diag), 0);
  assert_int_equal(MaterialResolve(&c, 0, diag, &material), 0);
  assert_int_equal(diag_errors(diag), 1);
  value[4].value = 30;
  assert_int_equal(MaterialResolve(&c, 0, diag, &material), 0);
  assert_int_equal(diag_errors(diag), 1);
  assert_true(fabs(material.parameters[MC_K] - 3.0) < 1e-14 && material.parameters[MC_CUT] == INFINITY);
  assert_int_equal(DiagDestroy(&diag), 0);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_golden),         cmocka_unit_test(test_against_textbook),
    cmocka_unit_test(test_continuity),     cmocka_unit_test(test_yield),
    cmocka_unit_test(test_separation),     cmocka_unit_test(test_plane_strain_failure),
    cmocka_unit_test(test_initial_stress), cmocka_unit_test(test_refused),
  };
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failures = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failures;
}
