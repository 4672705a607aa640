/* Grains that came apart and are remembered: how far they opened, that nothing bears before it has
 * closed, and that it then is as if they had never come apart. In space, in the plane and in rings,
 * with cohesion and without. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>
#include "base/math/eigen.h"
#include "mc_sample.h"

typedef enum { SPACE, PLANE, RING, KINDS } Kind;

typedef struct {
  const Law *law;
  Kind kind;
  PetscReal p[LAW_MAX_PARAMETERS], state[MC_STATE], tau[6], c[36];
} Grain;

static Grain grain_at_rest(Kind kind, PetscReal friction, PetscReal dilatancy, PetscReal cohesion, PetscReal memory)
{
  const McSample sample = {"grains", 1e6, 0.3, friction, dilatancy, cohesion, 1e300, memory};
  Grain g = {.kind = kind};
  g.law = mc_sample_pack(&sample, g.p);
  law_initial_state(g.law, g.state);
  return g;
}

static void move(Grain *g, const PetscReal dF[9])
{
  const LawUpdate update[KINDS] = {g->law->update, g->law->update_plane, g->law->update_hoop};
  PetscReal old[MC_STATE];
  memcpy(old, g->state, sizeof old);
  assert_int_equal(update[g->kind](g->p, 1, dF, old, g->state, g->tau, g->c), LAW_OK);
}

static PetscReal apex_of(const Grain *g) { return g->p[MC_Q] / (g->p[MC_K] - 1.0); }

/* ln J at which nothing is open: the volume that the tension of the apex holds. */
static PetscReal apex_volume(const Grain *g) { return 3.0 * apex_of(g) / (3.0 * g->p[MC_LAMBDA] + 2.0 * g->p[MC_MU]); }

static void assert_near(const char *what, PetscReal value, PetscReal expected, PetscReal tolerance)
{
  if (!(fabs(value - expected) <= tolerance))
    fail_msg("%s: %.17g, expected %.17g within %.2g", what, value, expected, tolerance);
}

/* The tension of the apex in all directions, and a tangent that knows no change of it. */
static void assert_bears_nothing(const Grain *g)
{
  for (int k = 0; k < 6; ++k) {
    assert_near("stress while open", g->tau[k], k < 3 ? apex_of(g) : 0.0, 1e-9);
    const PetscReal turns = k < 3 ? -2.0 : -1.0;
    if (g->kind == SPACE) assert_near("tangent while open", g->c[7 * k], turns * apex_of(g), 1e-9);
  }
}

/* An increment of volume exp(volume) with shears of chance, of the kind's components. */
static void random_step(Random *random, Kind kind, PetscReal volume, PetscReal shear, PetscReal f[9])
{
  for (int k = 0; k < 9; ++k) {
    const PetscBool moves = kind == SPACE || k < 2 || k == 3 || k == 4 || (kind == RING && k == 8);
    f[k] = (k % 4 == 0) + (moves ? shear * random_real(random, -1, 1) : 0.0);
  }
  const PetscReal scale = pow(exp(volume) / tensor_det(f), kind == PLANE ? 0.5 : 1.0 / 3.0);
  for (int k = 0; k < 9; ++k)
    if (kind != PLANE || k != 8) f[k] *= scale;
}

/* Compression that bears, far from isotropic, with a turn in the plane. */
static void compress(Kind kind, PetscReal f[9])
{
  const PetscReal c = cos(0.3), s = sin(0.3),
                  u[9] = {0.9992, 1e-4, 0, 1e-4, 0.9996, 0, 0, 0, kind == PLANE ? 1 : 0.9994};
  const PetscReal turn[9] = {c, -s, 0, s, c, 0, 0, 0, 1};
  tensor_multiply(turn, u, f);
}

/* Opened to 1.2 times its volume in steps of chance and closed in others, a grain is where it began;
 * what comes then gives the stress that it gives at once. */
static void excursion(Kind kind, PetscReal dilatancy, PetscReal cohesion)
{
  Random random = {11};
  Grain direct = grain_at_rest(kind, 31, dilatancy, cohesion, 1), g = direct;
  PetscReal f[9], open = 0, largest = 0;
  for (int step = 0; step < 40; ++step) {
    const PetscReal volume = (step < 20 ? 1 : -1) * log(1.2) / 20;
    random_step(&random, kind, volume, 0.02, f);
    if (step == 39) { /* the last one to where the apex begins, of the same shape as far as z may move */
      const PetscReal last = pow(exp(apex_volume(&g) - open), kind == PLANE ? 0.5 : 1.0 / 3.0);
      for (int k = 0; k < 9; ++k) f[k] = (k % 4 == 0) * (kind == PLANE && k == 8 ? 1 : last);
    }
    move(&g, f);
    open += log(tensor_det(f));
    largest = fmax(largest, g.state[7]);
    assert_near("opening", g.state[7], fmax(0, open - apex_volume(&g)), 1e-13);
    if (step < 39) assert_bears_nothing(&g);
  }
  assert_near("largest opening", largest, log(1.2) - apex_volume(&g), 1e-13);
  /* both go on from the apex, one of them for the first time */
  const PetscReal stretch = exp(apex_volume(&g) / 3.0), modulus = g.p[MC_LAMBDA] + 2.0 * g.p[MC_MU];
  for (int k = 0; k < 6; ++k) direct.state[k] = k < 3 ? stretch * stretch : 0.0;
  compress(kind, f);
  move(&g, f);
  move(&direct, f);
  assert_true(g.tau[0] < -100);
  for (int k = 0; k < 6; ++k) assert_near("stress after it", g.tau[k], direct.tau[k], 1e-14 * modulus);
  for (int k = 0; k < 6; ++k) assert_near("elastic strain after it", g.state[k], direct.state[k], 1e-14);
  assert_near("opening after it", g.state[7], 0, 0);
}

static void test_excursion(void **unused)
{
  (void)unused;
  for (Kind kind = SPACE; kind < KINDS; ++kind)
    for (int k = 0; k < 4; ++k) /* in the plane the last step shears, which must not dilate */
      if (kind != PLANE || k % 2 == 0) excursion(kind, k % 2 ? 1 : 0, k / 2 ? 500 : 0);
}

/* One increment from far open to compressed is the way without opening, to rounding. */
static void test_closing_at_once(void **unused)
{
  (void)unused;
  for (Kind kind = SPACE; kind < KINDS; ++kind) {
    Grain g = grain_at_rest(kind, 31, 1, 0, 1), direct = g;
    PetscReal in[9], out[9] = {0}, both[9];
    const PetscReal s = kind == SPACE ? 1.2 : 1.0; /* only what opens alike in all directions leaves no shape */
    compress(kind, in);
    for (int k = 0; k < 9; k += 4) out[k] = s;
    move(&g, out);
    for (int k = 0; k < 9; ++k) both[k] = in[k] / s;
    move(&g, both);
    move(&direct, in);
    for (int k = 0; k < 6; ++k) assert_near("stress", g.tau[k], direct.tau[k], 1e-9);
    for (int k = 0; k < 36; ++k) assert_near("tangent", g.c[k], direct.c[k], 1e-5);
  }
}

/* Half of what opens is kept and all that closes is taken from it, in one step or in many. */
static void test_steps_do_not_count(void **unused)
{
  (void)unused;
  static const PetscReal way[] = {0.3, -0.1, 0.2, -0.2}, expected[] = {0.15, 0.05, 0.15, 0};
  for (int n = 1; n < 200; n *= 7) {
    Grain g = grain_at_rest(SPACE, 31, 0, 0, 0.5);
    for (int k = 0; k < 4; ++k) {
      for (int step = 0; step < n; ++step) {
        const PetscReal s = exp(way[k] / (3 * n));
        move(&g, (PetscReal[9]){s, 0, 0, 0, s, 0, 0, 0, s});
      }
      assert_near("opening", g.state[7], expected[k], 1e-12);
    }
    assert_true(g.tau[0] < -1e4); /* 0.05 too much */
  }
}

/* A thousand steps of free flight, sheared all the way: the opening is ln J, and flow is shear. */
static void test_flight(void **unused)
{
  (void)unused;
  for (Kind kind = SPACE; kind < KINDS; ++kind) {
    Random random = {12};
    Grain g = grain_at_rest(kind, 44, 3, 0, 1);
    PetscReal f[9], open = 0.1;
    random_step(&random, kind, open, 0, f);
    move(&g, f);
    const PetscReal first = g.state[6];
    if (kind == SPACE) assert_near("opening alike in all directions is no flow", first, 0, 1e-15);
    for (int step = 0; step < 1000; ++step) {
      random_step(&random, kind, 1e-3 * random_real(&random, -1, 1.5), 0.01, f);
      move(&g, f);
      open += log(tensor_det(f));
    }
    assert_near("opening", g.state[7], open, 1e-12);
    assert_true(g.state[6] - first > 1 && g.state[6] - first < 10);
  }
}

/* The work on cohesion comes back: over any way while open the stress works into what is stored. */
static void test_energy(void **unused)
{
  (void)unused;
  for (int half = 0; half < 2; ++half) {
    Grain g = grain_at_rest(SPACE, 31, 0, 500, half ? 0.5 : 1);
    const PetscReal natural = g.law->energy(g.p, g.state), kink = 1e-4 * apex_of(&g); /* of a trapezoid */
    PetscReal work = 0;
    for (int step = 0; step < 4000; ++step) {
      const PetscReal rate = (step < 2000 ? 1 : half ? -0.5 : -1) * 1e-4, s = exp(rate / 3), before = g.tau[0];
      move(&g, (PetscReal[9]){s, 0, 0, 0, s, 0, 0, 0, s});
      work += 0.5 * (before + g.tau[0]) * rate;
      const PetscReal stored = g.law->energy(g.p, g.state) - natural;
      assert_true(stored <= work + kink && (half || stored >= work - kink));
    }
    assert_near("half of the opening is lost", work - (g.law->energy(g.p, g.state) - natural),
                half ? 0.5 * (0.2 - apex_volume(&g)) * apex_of(&g) : 0, kink);
  }
}

/* Without memory the state says so, whatever happened. */
static void test_without(void **unused)
{
  (void)unused;
  Random random = {13};
  for (Kind kind = SPACE; kind < KINDS; ++kind) {
    Grain g = grain_at_rest(kind, 31, 1, 16, 0);
    for (int step = 0; step < 100; ++step) {
      PetscReal f[9];
      random_step(&random, kind, random_real(&random, -1e-3, 1e-2), 0.01, f);
      move(&g, f);
      assert_true(g.state[7] == 0);
    }
  }
}

/* The mixed formulation refuses it, at its key. */
static void test_mixed(void **unused)
{
  (void)unused;
  NamedValue value[] = {{(char *)"young", 1e6},
                        {(char *)"poisson", 0.3},
                        {(char *)"friction_angle", 30},
                        {(char *)"cohesion", 0},
                        {(char *)"opening_memory", 0}};
  MaterialSpec spec = {
    .name = (char *)"sand", .law = (char *)"mohr-coulomb", .density = 1.0, .n_parameters = 5, .parameters = value};
  Case c = {.n_materials = 1, .materials = &spec};
  Material material;
  for (int mixed = 0; mixed < 2; ++mixed)
    for (int memory = 0; memory < 2; ++memory) {
      Diag *diag = NULL;
      c.formulation = (char *)(mixed ? "mixed" : "displacement");
      value[4].value = memory;
      assert_int_equal(DiagCreate(&diag), 0);
      assert_int_equal(MaterialResolve(&c, 0, diag, &material), 0);
      assert_int_equal(diag_errors(diag), mixed && memory);
      assert_int_equal(DiagDestroy(&diag), 0);
    }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_excursion), cmocka_unit_test(test_closing_at_once), cmocka_unit_test(test_steps_do_not_count),
    cmocka_unit_test(test_flight),    cmocka_unit_test(test_energy),          cmocka_unit_test(test_without),
    cmocka_unit_test(test_mixed),
  };
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failures = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failures;
}
