/* The laws for soils against golden numbers (the rate equations integrated by
 * tests/golden/soils.py) and against closed forms of triaxial tests, led by Newton's method with
 * the laws' own tangent. */
#include "../conformance/golden.h"
#include "base/math/tensor.h"
#include "material/law.h"
#include <string.h>

#define CALL(call) assert_int_equal((call), 0)
#define MOST 16

static void assert_near(const char *what, PetscReal value, PetscReal expected, PetscReal tolerance)
{
  if (!(fabs(value - expected) <= tolerance))
    fail_msg("%s: %.12g, expected %.12g within %.2g", what, value, expected, tolerance);
}

/* A material of a law, with as many names as values. */
static Material soil(const char *law, PetscInt n, const NamedValue *value)
{
  MaterialSpec spec = {
    .name = (char *)"soil", .law = (char *)law, .density = 2000, .n_parameters = n, .parameters = (NamedValue *)value};
  const Case c = {.n_materials = 1, .materials = &spec, .formulation = (char *)"displacement"};
  Material m;
  Diag *diag;
  CALL(DiagCreate(&diag));
  CALL(MaterialResolve(&c, 0, diag, &m));
  if (diag_errors(diag)) (void)DiagFlush(diag, stderr);
  assert_int_equal(diag_errors(diag), 0);
  CALL(DiagDestroy(&diag));
  return m;
}

/* One material point. */
typedef struct {
  Material m;
  PetscReal state[LAW_MAX_STATE], tau[6], c[36], J;
} Point;

static void start(Point *p, PetscReal pressure)
{
  const PetscReal sigma[6] = {-pressure, -pressure, -pressure, 0, 0, 0};
  memset(p->state, 0, sizeof p->state);
  law_initial_state(p->m.law, p->state);
  p->J = 1;
  if (pressure > 0) assert_true(p->m.law->initial_stress(p->m.parameters, sigma, p->state));
  for (int k = 0; k < 6; ++k) p->tau[k] = k < 3 ? -pressure : 0;
}

/* Logarithmic strains along fixed axes; the new state goes to `state` alone. */
static void stretch(Point *p, const PetscReal e[3], PetscReal *state)
{
  const PetscReal f[9] = {exp(e[0]), 0, 0, 0, exp(e[1]), 0, 0, 0, exp(e[2])};
  assert_int_equal(p->m.law->update(p->m.parameters, 1, f, p->state, state, p->tau, p->c), LAW_OK);
}

static void advance(Point *p, const PetscReal e[3])
{
  PetscReal state[LAW_MAX_STATE];
  stretch(p, e, state);
  memcpy(p->state, state, sizeof state);
  p->J *= exp(e[0] + e[1] + e[2]);
}

/* e[2] given, e[0] and e[1] such that both lateral Kirchhoff stresses are those wanted (e[1] only
 * if `both`). The tangent is exact, so that Newton's last step falls quadratically. */
static void lead(Point *p, PetscReal axial, PetscReal lateral, PetscBool both)
{
  PetscReal e[3] = {0, 0, axial}, state[LAW_MAX_STATE], miss[2], before = INFINITY;
  const PetscReal scale = fabs(p->tau[2]) + 1;
  for (int iteration = 0; iteration < 40; ++iteration) {
    stretch(p, e, state);
    miss[0] = p->tau[0] - lateral;
    miss[1] = both ? p->tau[1] - lateral : 0;
    const PetscReal size = fmax(fabs(miss[0]), fabs(miss[1])) / scale;
    if (before < 1e-4) assert_true(size < 1e-9 + 1e4 * before * before);
    if (size < 1e-12) break;
    assert_true(iteration < 39);
    before = size;
    /* d tau = c : d + 2 tau d */
    const PetscReal a = p->c[0] + 2 * p->tau[0], b = both ? p->c[1] : 0, c = both ? p->c[6] : 0;
    const PetscReal d = both ? p->c[7] + 2 * p->tau[1] : 1, det = a * d - b * c;
    e[0] -= (miss[0] * d - miss[1] * b) / det;
    e[1] -= (miss[1] * a - miss[0] * c) / det;
  }
  advance(p, e);
}

/* Stresses and the law's own number at the ends of a path in n steps a segment. */
static PetscInt follow(Point *p, PetscInt segments, const PetscReal *path, int n, PetscReal *ends)
{
  for (PetscInt s = 0; s < segments; ++s) {
    const PetscReal e[3] = {path[3 * s] / n, path[3 * s + 1] / n, path[3 * s + 2] / n};
    for (int k = 0; k < n; ++k) advance(p, e);
    for (int k = 0; k < 3; ++k) ends[4 * s + k] = p->tau[k];
    ends[4 * s + 3] = p->state[6];
  }
  return 4 * segments;
}

static void check_golden(struct fy_node *item)
{
  struct fy_node *given = fy_node_mapping_lookup_by_string(item, "given", FY_NT), *path, *ends;
  NamedValue value[MOST];
  PetscReal pressure = 0, seconds = 0, strain[MOST], golden[MOST * 2], coarse[MOST * 2], fine[MOST * 2];
  PetscInt n = 0;
  void *at = NULL;
  for (struct fy_node_pair *pair; (pair = fy_node_mapping_iterate(given, &at));) {
    const PetscReal number = strtod(fy_node_get_scalar0(fy_node_pair_value(pair)), NULL);
    if (!strcmp(fy_node_get_scalar0(fy_node_pair_key(pair)), "pressure")) pressure = number;
    else if (!strcmp(fy_node_get_scalar0(fy_node_pair_key(pair)), "seconds")) seconds = number;
    else value[n++] = (NamedValue){(char *)fy_node_get_scalar0(fy_node_pair_key(pair)), number};
  }
  path = fy_node_mapping_lookup_by_string(item, "path", FY_NT);
  ends = fy_node_mapping_lookup_by_string(item, "ends", FY_NT);
  const PetscInt segments = golden_flatten(path, MOST, strain) / 3;
  assert_int_equal(golden_flatten(ends, 2 * MOST, golden), 4 * segments);
  Point p = {.m = soil(golden_text(item, "law"), n, value)};
  start(&p, pressure);
  materials_step(1, &p.m, 0, seconds / 400, PETSC_TRUE);
  follow(&p, segments, strain, 400, coarse);
  start(&p, pressure);
  materials_step(1, &p.m, 0, seconds / 800, PETSC_TRUE);
  follow(&p, segments, strain, 800, fine);
  for (PetscInt k = 0; k < 4 * segments; ++k) { /* a return is of first order: extrapolated */
    const PetscReal scale = fabs(golden[k]) + (k % 4 == 3 ? 1e-3 : 1e3);
    assert_near("golden, 800 steps", fine[k], golden[k], 5e-3 * scale);
    assert_near("golden, extrapolated", 2 * fine[k] - coarse[k], golden[k], 2e-5 * scale);
  }
}

static void test_golden(void **unused)
{
  struct fy_document *document = golden_open("soils.json");
  struct fy_node *cases = fy_node_by_path(fy_document_root(document), "/cases", FY_NT, FYNWF_DONT_FOLLOW);
  void *at = NULL;
  int n = 0;
  (void)unused;
  for (struct fy_node *item; (item = fy_node_sequence_iterate(cases, &at)); ++n) check_golden(item);
  assert_int_equal(n, 8);
  fy_document_destroy(document);
}

static Material cone(PetscReal phi, PetscReal psi, PetscReal c, int match)
{
  const NamedValue value[] = {{(char *)"young", 2e7},          {(char *)"poisson", 0.3},
                              {(char *)"friction_angle", phi}, {(char *)"dilatancy_angle", psi},
                              {(char *)"cohesion", c},         {(char *)"match", match}};
  return soil("drucker-prager", 6, value);
}

/* Mohr-Coulomb: (s1 - s3) / 2 = c cos phi - (s1 + s3) / 2 sin phi, of the two given. */
static PetscReal mohr_coulomb(PetscReal phi, PetscReal c, PetscReal a, PetscReal b)
{
  const PetscReal s = sin(phi * PETSC_PI / 180), cosine = cos(phi * PETSC_PI / 180);
  return 0.5 * fabs(a - b) - c * cosine + 0.5 * (a + b) * s;
}

/* Each cone has Mohr-Coulomb's strength where it says so: in triaxial compression and extension
 * at once, in plane strain once the flow goes on. */
static void test_matches(void **unused)
{
  (void)unused;
  for (int match = 0; match < 3; ++match)
    for (int psi = 0; psi <= 30; psi += 10) {
      const PetscReal c = 5e3, lateral = -1e5;
      Point p = {.m = cone(30, psi, c, match)};
      start(&p, 1e5);
      for (int k = 0; k < 300; ++k) lead(&p, match == 1 ? 1e-4 : -1e-3, lateral, match < 2);
      assert_near("limit of a match", mohr_coulomb(30, c, p.tau[0], p.tau[2]), 0, 1e-6 * fabs(p.tau[2]));
    }
}

/* In plane strain each of them comes to the strength that it says it has there. */
static void test_in_plane(void **unused)
{
  (void)unused;
  for (int match = 0; match < 3; ++match)
    for (int psi = 0; psi <= 30; psi += 15) {
      PetscReal strength[2];
      Point p = {.m = cone(30, psi, 5e3, match)};
      p.m.law->in_plane(p.m.given, strength);
      start(&p, 1e5);
      for (int k = 0; k < 300; ++k) lead(&p, -1e-3, -1e5, PETSC_FALSE);
      const PetscReal left = mohr_coulomb(strength[0] * 180 / PETSC_PI, strength[1], p.tau[0], p.tau[2]);
      assert_near("limit in plane strain", left, 0, 1e-6 * fabs(p.tau[2]));
      if (match == 2) assert_near("angle", strength[0], PETSC_PI / 6, 1e-12);
      if (match == 2) assert_near("cohesion", strength[1], 5e3, 1e-8);
    }
}

/* In triaxial compression and extension q is that of the peak, as c and phi give it. */
static void test_peaks(void **unused)
{
  const PetscReal s = 0.5, cosine = sqrt(0.75), c = 5e3, sigma = 1e5; /* phi = 30 */
  (void)unused;
  Point p = {.m = cone(30, 0, c, 0)};
  start(&p, sigma);
  for (int k = 0; k < 50; ++k) lead(&p, -1e-3, -sigma, PETSC_TRUE);
  assert_near("compression", p.tau[0] - p.tau[2], (2 * c * cosine + 2 * sigma * s) / (1 - s), 1e-6 * sigma);
  p.m = cone(30, 0, c, 1);
  start(&p, sigma);
  for (int k = 0; k < 50; ++k) lead(&p, 1e-3, -sigma, PETSC_TRUE);
  assert_near("extension", p.tau[2] - p.tau[0], (2 * c * cosine + 2 * sigma * s) / (1 + s), 1e-6 * sigma);
}

static void test_softened(void **unused)
{
  const NamedValue value[] = {
    {(char *)"young", 2e7},           {(char *)"poisson", 0.3},      {(char *)"friction_angle", 35},
    {(char *)"dilatancy_angle", 5},   {(char *)"cohesion", 1e4},     {(char *)"residual_friction_angle", 25},
    {(char *)"residual_cohesion", 0}, {(char *)"peak_strain", 0.01}, {(char *)"residual_strain", 0.05}};
  PetscReal most = -INFINITY;
  (void)unused;
  for (int size = 0; size < 2; ++size) { /* twice the size: through it in half the strain */
    Point p = {.m = soil("mohr-coulomb-softening", 9, value)};
    start(&p, 1e5);
    if (size) p.state[7] = 2;
    PetscReal at_residual = NAN, peak = 0;
    for (int k = 0; k < 1000; ++k) {
      lead(&p, -2e-4, -1e5, PETSC_FALSE);
      peak = fmax(peak, p.tau[0] - p.tau[2]);
      if (isnan(at_residual) && p.state[6] * (size ? 2 : 1) >= 0.05) at_residual = p.state[6];
    }
    assert_near("residual", mohr_coulomb(25, 0, p.tau[0], p.tau[2]), 0, 1e-6 * 1e5);
    assert_near("strain of the residual", at_residual, size ? 0.025 : 0.05, 1e-3);
    most = fmax(most, peak);
  }
  const PetscReal s = sin(35 * PETSC_PI / 180);
  assert_near("peak", most, (2e4 * cos(35 * PETSC_PI / 180) + 2e5 * s) / (1 - s), 1e-4 * most);
}

/* Pulled alike along all axes nothing shears: kappa stays 0, and the stress is that of the apex of the start, c cot phi,
 * however steeply it would harden. */
static void test_softening_opens(void **unused)
{
  (void)unused;
  for (int angle = 1; angle < 30; ++angle) {
    const NamedValue value[] = {{(char *)"young", 1e6},          {(char *)"poisson", 0.3},
                                {(char *)"friction_angle", 30},  {(char *)"cohesion", 2e4},
                                {(char *)"peak_strain", 0.02},   {(char *)"initial_friction_angle", angle},
                                {(char *)"residual_strain", 0.2}};
    Point p = {.m = soil("mohr-coulomb-softening", 7, value)};
    start(&p, 0);
    for (int k = 0; k < 200; ++k) {
      const PetscReal e = 0.0061 + 1e-4 * k;
      advance(&p, (PetscReal[3]){e, e, e});
      const PetscReal apex = 2e4 / tan(angle * PETSC_PI / 180), bulk = 1e6 / 1.2 * log(p.J);
      for (int i = 0; i < 3; ++i) assert_near("apex", p.tau[i], fmin(apex, bulk), 1e-9 * apex);
      assert_near("kappa", p.state[6], 0, 1e-15);
    }
  }
}

#define V 2.1
#define M 1.1

static Material clay(PetscReal ocr)
{
  const NamedValue value[] = {
    {(char *)"critical_stress_ratio", M}, {(char *)"lambda", 0.2},        {(char *)"kappa", 0.04},
    {(char *)"specific_volume", V},       {(char *)"shear_modulus", 4e6}, {(char *)"ocr", ocr}};
  return soil("modified-cam-clay", 6, value);
}

/* Isotropic compression and swelling: ln v falls with ln p (of Cauchy) by lambda / v0 and kappa /
 * v0. */
static void test_lines(void **unused)
{
  Point p = {.m = clay(2)};
  PetscReal pressure[4], J[4];
  (void)unused;
  start(&p, 1e5);
  for (int part = 0; part < 3; ++part)
    for (int k = 0; k < 20; ++k) {
      const PetscReal e = part < 2 ? -0.002 : 0.0005;
      advance(&p, (PetscReal[3]){e, e, e});
      pressure[part] = -p.tau[0] / p.J;
      J[part] = p.J;
    }
  assert_near("virgin line", log(J[1] / J[0]), -0.2 / V * log(pressure[1] / pressure[0]), 1e-12);
  assert_near("swelling line", log(J[2] / J[1]), -0.04 / V * log(pressure[2] / pressure[1]), 1e-12);
  /* and both meet at p_c = ocr p */
  const PetscReal meet = log(J[0]) + 0.2 / V * log(pressure[0] / 2e5) + 0.04 / V * log(2.);
  assert_near("preconsolidation", meet, 0, 5e-3); /* Kirchhoff's p_c: J of the way there */
}

/* Drained: ends at q = M p, p = 3 p0 / (3 - M), p_c = 2 p. */
static void test_drained(void **unused)
{
  (void)unused;
  for (int ocr = 1; ocr <= 8; ocr *= 8) {
    Point p = {.m = clay(ocr)};
    PetscReal peak = 0;
    start(&p, 1e5);
    for (int k = 0; k < 4000; ++k) {
      lead(&p, -1e-3, -1e5, PETSC_TRUE);
      peak = fmax(peak, p.tau[0] - p.tau[2]);
    }
    const PetscReal mean = 3e5 / (3 - M);
    assert_near("critical q", p.tau[0] - p.tau[2], M * mean, 1e-4 * mean);
    assert_near("critical p_c", p.state[6], 2 * mean, 1e-3 * mean);
    assert_true(ocr == 1 ? peak < 1.0001 * M * mean : peak > 1.5 * M * mean); /* dry clay has a peak */
  }
}

/* Undrained: s_u = M p0 / 2 (ocr / 2)^(1 - kappa / lambda), slopes by Kirchhoff's pressure. */
static void test_undrained(void **unused)
{
  const PetscReal lambda = 0.2 / V / (1 - 0.2 / V), kappa = 0.04 / V / (1 - 0.04 / V);
  (void)unused;
  for (int ocr = 1; ocr <= 8; ocr *= 2) {
    Point p = {.m = clay(ocr)};
    start(&p, 1e5);
    for (int k = 0; k < 3000; ++k) advance(&p, (PetscReal[3]){5e-4, 5e-4, -1e-3});
    assert_near("undrained strength", 0.5 * (p.tau[0] - p.tau[2]), 0.5 * M * 1e5 * pow(ocr / 2., 1 - kappa / lambda),
                1e-4 * 1e5);
  }
}

/* Where nothing presses there is no state, and an update without one says so. */
static void test_no_pressure(void **unused)
{
  const PetscReal none[6] = {0}, f[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  PetscReal state[LAW_MAX_STATE], now[LAW_MAX_STATE], tau[6];
  const Material m = clay(1);
  (void)unused;
  assert_false(m.law->initial_stress(m.parameters, none, state));
  law_initial_state(m.law, state);
  assert_int_equal(m.law->update(m.parameters, 1, f, state, now, tau, NULL), LAW_NOT_CONVERGED);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_golden),      cmocka_unit_test(test_matches),  cmocka_unit_test(test_in_plane),
    cmocka_unit_test(test_peaks),       cmocka_unit_test(test_softened), cmocka_unit_test(test_softening_opens),
    cmocka_unit_test(test_lines),       cmocka_unit_test(test_drained),  cmocka_unit_test(test_undrained),
    cmocka_unit_test(test_no_pressure),
  };
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failures = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failures;
}
