/* One point of several laws on the paths of laboratories, against closed forms. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
/* cmocka wants those before it */
#include <cmocka.h>
#include "element/element_spec.h"
#include "material/algebra/invariants.h"

#define RAD (PETSC_PI / 180)

static void material(const char *law, PetscInt n, const NamedValue *values, Material *m)
{
  MaterialSpec spec = {.name = (char *)"sample",
                       .law = (char *)law,
                       .density = 1000,
                       .n_parameters = n,
                       .parameters = (NamedValue *)values};
  Case c = {.n_materials = 1, .materials = &spec};
  Diag *diag;
  if (DiagCreate(&diag) || MaterialResolve(&c, 0, diag, m)) fail();
  if (diag_errors(diag)) {
    (void)DiagFlush(diag, stderr);
    fail();
  }
  if (DiagDestroy(&diag)) fail();
}

#define MATERIAL(m, law, ...)                                               \
  do {                                                                      \
    const NamedValue values[] = {__VA_ARGS__};                              \
    material(law, (PetscInt)(sizeof values / sizeof values[0]), values, m); \
  } while (0)
#define VALUE(name, number) \
  {                         \
    (char *)(name), number  \
  }

static void sand(PetscReal young, PetscReal phi, PetscReal psi, PetscReal cohesion, Material *m)
{
  MATERIAL(m, "mohr-coulomb", VALUE("young", young), VALUE("poisson", 0.25), VALUE("friction_angle", phi),
           VALUE("dilatancy_angle", psi), VALUE("cohesion", cohesion), VALUE("tension_cutoff", 1e300),
           VALUE("opening_memory", 0));
}

static DrivePoint begin(Material *m, PetscReal pressure)
{
  const PetscReal stress[6] = {-pressure, -pressure, -pressure};
  DrivePoint point;
  assert_true(drive_start(&point, m, stress, 0));
  for (int k = 0; k < 3; ++k) assert_true(fabs(point.stress[k] + pressure) <= 1e-12 * pressure);
  return point;
}

static const ElementTest *test_of(const char *name)
{
  for (int i = 0; element_tests[i]; ++i)
    if (!strcmp(element_tests[i]->name, name)) return element_tests[i];
  fail();
  return NULL;
}

/* Lead the point there in so many increments; the residuals of the last are in *report. */
static void lead(DrivePoint *point, const ElementStage *stage, DriveReport *report)
{
  PetscReal first[6], last[6], from[6], to[6];
  DriveControl control;
  element_stage(stage, point, &control, first, last);
  memcpy(from, first, sizeof from);
  for (PetscInt i = 1; i <= stage->steps; ++i) {
    for (int k = 0; k < 6; ++k) to[k] = first[k] + (PetscReal)i / (PetscReal)stage->steps * (last[k] - first[k]);
    memset(report, 0, sizeof *report);
    if (!drive_advance(point, &control, from, to, report))
      fail_msg("stuck in increment %d at %g", (int)i, (double)report->reached);
    memcpy(from, to, sizeof from);
  }
}

static DrivePoint tested(Material *m, PetscReal pressure, const char *test, PetscReal to, PetscBool undrained,
                         PetscInt steps)
{
  const ElementStage stage = {.test = test_of(test), .to = to, .undrained = undrained, .steps = steps};
  DrivePoint point = begin(m, pressure);
  DriveReport report;
  lead(&point, &stage, &report);
  return point;
}

static void near(const char *what, PetscReal value, PetscReal expected, PetscReal tolerance)
{
  if (!(fabs(value - expected) <= tolerance * fabs(expected)))
    fail_msg("%s is %.17g, expected %.17g within %.1g", what, (double)value, (double)expected, (double)tolerance);
}

static PetscReal volume_of(const DrivePoint *p) { return exp(p->strain[0] + p->strain[1] + p->strain[2]); }

/* tau = lambda ln J + mu (stretch^2 - 1), and D ln stretch; K0 = nu / (1 - nu) where strains are small. */
static void test_oedometer(void **state)
{
  const PetscReal nu = 0.3, E = 1e6, mu = E / (2 * (1 + nu)), lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
  Material m;
  (void)state;
  MATERIAL(&m, "neo-hookean", VALUE("young", E), VALUE("poisson", nu));
  DrivePoint p = tested(&m, 0, "oedometer", 0.5, PETSC_FALSE, 3);
  const PetscReal J = exp(-0.5);
  near("axial stress", p.stress[1], (lambda * -0.5 + mu * (J * J - 1)) / J, 1e-12);
  near("lateral stress", p.stress[0], lambda * -0.5 / J, 1e-12);
  p = tested(&m, 0, "oedometer", 1e-7, PETSC_FALSE, 1);
  near("K0", p.stress[2] / p.stress[1], nu / (1 - nu), 1e-6);

  MATERIAL(&m, "mohr-coulomb", VALUE("young", E), VALUE("poisson", nu), VALUE("friction_angle", 0),
           VALUE("dilatancy_angle", 0), VALUE("cohesion", 1e12), VALUE("tension_cutoff", 1e300),
           VALUE("opening_memory", 0));
  p = tested(&m, 0, "oedometer", 0.5, PETSC_FALSE, 3);
  near("axial stress of Hencky", p.stress[1], (lambda + 2 * mu) * -0.5 / J, 1e-12);
  near("lateral stress of Hencky", p.stress[0], lambda * -0.5 / J, 1e-12);
}

/* Hencky, one stress: tau = E ln stretch, and the others shrink by nu. */
static void test_uniaxial(void **state)
{
  const ElementStage pull = {.stress = {{0, 2e5}, {PETSC_FALSE, PETSC_TRUE}}, .steps = 1};
  const PetscReal E = 1e6, nu = 0.3;
  DriveReport report;
  Material m;
  (void)state;
  MATERIAL(&m, "mohr-coulomb", VALUE("young", E), VALUE("poisson", nu), VALUE("friction_angle", 0),
           VALUE("dilatancy_angle", 0), VALUE("cohesion", 1e12), VALUE("tension_cutoff", 1e300),
           VALUE("opening_memory", 0));
  DrivePoint p = begin(&m, 0);
  lead(&p, &pull, &report);
  near("lateral strain", p.strain[0], -nu * p.strain[1], 1e-9);
  near("stress", 2e5 * volume_of(&p), E * p.strain[1], 1e-9);
}

/* The surface is one of Kirchhoff's stress: k P + 2 c sqrt(k) / J. */
static void test_mohr_coulomb(void **state)
{
  const PetscReal phi = 35, c = 5e3, P = 100e3, k = (1 + sin(phi * RAD)) / (1 - sin(phi * RAD));
  Material m;
  (void)state;
  sand(50e6, phi, 5, c, &m);
  DrivePoint p = tested(&m, P, "triaxial", 0.05, PETSC_FALSE, 20);
  near("peak", -p.stress[1], k * P + 2 * c * sqrt(k) / (p.J * volume_of(&p)), 1e-9);
  near("confinement", -p.stress[2], P, 1e-9);
  p = tested(&m, P, "triaxial", -0.05, PETSC_FALSE, 20);
  near("extension", P, k * -p.stress[1] + 2 * c * sqrt(k) / (p.J * volume_of(&p)), 1e-9);
  sand(50e6, phi, 5, 0, &m);
  p = tested(&m, P, "triaxial", 0.05, PETSC_FALSE, 20);
  near("without cohesion", -p.stress[1], k * P, 1e-9);
  near("mobilised", stress_mobilised_friction(p.stress), phi * RAD, 1e-9);
}

/* Without dilatancy p' stays where the volume does: s_u = q / 2 = 3 sin phi / (3 - sin phi) p' in
 * compression, with 3 + sin phi in extension; the pore pressure is what total and effective p differ
 * by. Without friction s_u = c. */
static void test_undrained(void **state)
{
  const PetscReal s = sin(30 * RAD), P = 100e3;
  Material m;
  (void)state;
  sand(50e6, 30, 0, 0, &m);
  DrivePoint p = tested(&m, P, "triaxial", 0.05, PETSC_TRUE, 25);
  near("s_u", 0.5 * stress_deviatoric(p.stress), 3 * s / (3 - s) * P, 1e-9);
  near("pore pressure", p.pore, 2 * s / (3 - s) * P, 1e-9);
  near("total stress", p.stress[0] - p.pore, -P, 1e-9);
  assert_true(fabs(log(volume_of(&p))) < 1e-12);
  p = tested(&m, P, "triaxial", -0.05, PETSC_TRUE, 25);
  near("s_u in extension", 0.5 * stress_deviatoric(p.stress), 3 * s / (3 + s) * P, 1e-9);
  sand(50e6, 0, 0, 20e3, &m);
  p = tested(&m, P, "triaxial", 0.05, PETSC_TRUE, 25);
  near("s_u of Tresca", 0.5 * stress_deviatoric(p.stress) * p.J, 20e3, 1e-9);
}

/* On a plane that slides the stress lies on the surface; the elastic strain turns its axes by c / G. */
static void test_simple_shear(void **state)
{
  const PetscReal c = 20e3, G = 5e10 / 2.5;
  Material m;
  (void)state;
  sand(5e10, 0, 0, c, &m);
  DrivePoint p = tested(&m, 100e3, "simple-shear", 0.2, PETSC_FALSE, 50);
  const PetscReal half = 0.5 * (p.stress[0] - p.stress[1]);
  near("radius", hypot(half, p.stress[3]), c, 2 * 100e3 / 5e10);
  near("shear", p.stress[3], c, 4 * c / G);
  near("normal stress", p.stress[1], -100e3, 1e-9);
  sand(50e6, 30, 0, 0, &m);
  p = tested(&m, 100e3, "simple-shear", 0.2, PETSC_FALSE, 50);
  near("mobilised", stress_mobilised_friction(p.stress), 30 * RAD, 1e-9);
}

/* Plane strain, all strain plastic: -(d eps_1 + d eps_3) / (d eps_1 - d eps_3) = sin psi. */
static void test_dilation(void **state)
{
  const ElementStage shear = {.test = test_of("biaxial"), .to = 0.01, .steps = 5};
  const ElementStage more = {.test = test_of("biaxial"), .to = 0.02, .steps = 5};
  DriveReport report;
  Material m;
  (void)state;
  sand(1e12, 35, 12, 0, &m);
  DrivePoint p = begin(&m, 100e3), before;
  lead(&p, &shear, &report);
  before = p;
  lead(&p, &more, &report);
  const PetscReal x = p.strain[0] - before.strain[0], y = p.strain[1] - before.strain[1];
  near("sin psi", (x + y) / (x - y), sin(12 * RAD), 1e-5);
  near("work", -p.stress[1] / -p.stress[0], (1 + sin(35 * RAD)) / (1 - sin(35 * RAD)), 1e-9);
}

/* One stress: J sigma = sigma_Y + H alpha, and E H / (E + H) is its slope over the strain. */
static void test_hardening(void **state)
{
  const PetscReal E = 2e11, H = 1e9, yield = 2e8;
  const ElementStage pull[2] = {{.strain = {{0, 0.01}, {PETSC_FALSE, PETSC_TRUE}}, .steps = 200},
                                {.strain = {{0, 0.01}, {PETSC_FALSE, PETSC_TRUE}}, .steps = 200}};
  PetscReal tau[2];
  DriveReport report;
  Material m;
  (void)state;
  MATERIAL(&m, "j2", VALUE("young", E), VALUE("poisson", 0.3), VALUE("yield_stress", yield), VALUE("hardening", H));
  DrivePoint p = begin(&m, 0);
  for (int k = 0; k < 2; ++k) {
    lead(&p, &pull[k], &report);
    tau[k] = p.stress[1] * volume_of(&p);
    near("yield stress", tau[k], yield + H * p.state[7], 1e-9);
    near("plastic strain", p.state[7], p.strain[1] - tau[k] / E, 1e-3);
  }
  near("slope", (tau[1] - tau[0]) / 0.01, E * H / (E + H), 1e-3);
}

/* What is elastic knows no path: in one increment or in many, and back to nothing. */
static void test_path(void **state)
{
  const ElementStage ways[2] = {{.stress = {{-3e5, -2e5, -1e5, 2e5, 1e5, -1e5}, {1, 1, 1, 1, 1, 1}}, .steps = 1},
                                {.stress = {{-3e5, -2e5, -1e5, 2e5, 1e5, -1e5}, {1, 1, 1, 1, 1, 1}}, .steps = 17}};
  const ElementStage back = {.stress = {{0}, {1, 1, 1, 1, 1, 1}}, .steps = 4};
  DrivePoint ends[2];
  DriveReport report;
  Material m;
  (void)state;
  MATERIAL(&m, "neo-hookean", VALUE("young", 1e6), VALUE("poisson", 0.3));
  for (int k = 0; k < 2; ++k) {
    ends[k] = begin(&m, 0);
    lead(&ends[k], &ways[k], &report);
  }
  for (int k = 0; k < 6; ++k) near("strain", ends[1].strain[k], ends[0].strain[k], 1e-8);
  lead(&ends[0], &back, &report);
  for (int k = 0; k < 6; ++k) assert_true(fabs(ends[0].strain[k]) < 1e-8);
}

/* The residual of an iteration is a constant times the square of the one before it. */
static void quadratic(const char *what, const DriveReport *r)
{
  PetscInt checked = 0;
  for (PetscInt i = 2; i < r->n; ++i) {
    /* far from the answer nothing is promised, at it there is rounding */
    if (r->residual[i - 1] > 1e7 || r->residual[i - 1] < 1e3) continue;
    ++checked;
    const PetscReal constant = r->residual[i] / (r->residual[i - 1] * r->residual[i - 1]);
    if (!(constant < 1e-4 || r->residual[i] < 10))
      fail_msg("%s: residual %g after %g", what, (double)r->residual[i], (double)r->residual[i - 1]);
  }
  if (r->n > 8 || !checked) fail_msg("%s: %d iterations, %d of them looked at", what, (int)r->n, (int)checked);
}

static void test_quadratic(void **state)
{
  const ElementStage shear = {.stress = {{-1e5, -2e5, -1e5, 3e5}, {1, 1, 1, 1}}, .steps = 1};
  const ElementStage flow = {.test = test_of("simple-shear"), .to = 0.1, .steps = 2};
  const ElementStage metal = {.strain = {{0, 0, 0, 0.05}, {0, 0, 0, 1}}, .steps = 2};
  DriveReport report;
  DrivePoint p;
  Material m;
  (void)state;
  MATERIAL(&m, "neo-hookean", VALUE("young", 1e6), VALUE("poisson", 0.3));
  p = begin(&m, 0);
  lead(&p, &shear, &report);
  quadratic("neo-hookean", &report);
  sand(50e6, 30, 5, 5e3, &m);
  p = begin(&m, 100e3);
  lead(&p, &flow, &report);
  quadratic("mohr-coulomb", &report);
  MATERIAL(&m, "j2", VALUE("young", 2e9), VALUE("poisson", 0.3), VALUE("yield_stress", 2e7), VALUE("hardening", 1e8));
  p = begin(&m, 0);
  lead(&p, &metal, &report);
  quadratic("j2", &report);
}

/* A flow whose direction turns is followed to first order in the increment. */
static void test_order(void **state)
{
  PetscReal shear[4];
  Material m;
  (void)state;
  sand(50e6, 30, 5, 0, &m);
  for (int k = 0; k < 4; ++k) shear[k] = tested(&m, 100e3, "simple-shear", 0.02, PETSC_FALSE, 40 << k).stress[3];
  for (int k = 0; k < 2; ++k) {
    const PetscReal ratio = (shear[k + 1] - shear[k]) / (shear[k + 2] - shear[k + 1]);
    if (!(ratio > 1.9 && ratio < 2.1)) fail_msg("halved increments: %g times nearer", (double)ratio);
  }
}

/* More than the point can carry: the way ends where the strength does, and not before. */
static void test_limit(void **state)
{
  const PetscReal P = 100e3, k = 3; /* of 30 degrees */
  const DriveControl control = {.stress = {1, 1, 1}};
  const PetscReal from[6] = {-P, -P, -P}, to[6] = {-P, -6 * P, -P};
  DriveReport report = {0};
  Material m;
  (void)state;
  sand(50e6, 30, 0, 0, &m);
  DrivePoint p = begin(&m, P);
  assert_false(drive_advance(&p, &control, from, to, &report));
  near("carried", -p.stress[1], k * P, 5e-3);
  assert_true(-p.stress[1] <= k * P);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_oedometer), cmocka_unit_test(test_uniaxial),     cmocka_unit_test(test_mohr_coulomb),
    cmocka_unit_test(test_undrained), cmocka_unit_test(test_simple_shear), cmocka_unit_test(test_dilation),
    cmocka_unit_test(test_hardening), cmocka_unit_test(test_path),         cmocka_unit_test(test_quadratic),
    cmocka_unit_test(test_order),     cmocka_unit_test(test_limit),
  };
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
