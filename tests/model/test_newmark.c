/* Time integration on the first axial mode of a bar, against the exact motion of the same mesh.
 *
 * With linear elements of equal length and consistent mass, nodal values sin(k x), k = pi / 2, are
 * a mode of a bar of length 1 fixed at x = 0, with omega^2 = 6 E / (rho h^2) (1 - cos kh) / (2 +
 * cos kh), and with lumped mass 2 E / (rho h^2) (1 - cos kh). nu = 0 and no motion along y make the
 * strip of quadrilaterals that bar. */
#include "case_builder.h"

enum { CELLS = 16 };

typedef struct {
  PetscReal end;    /* periods */
  PetscInt steps;   /* per period */
  PetscReal strain; /* largest */
  PetscReal bossak, damping;
  MassMatrix mass;
  PetscBool middle; /* by the midpoint rule, in mpm, whose points stand at the Gauss points: the same matrices */
  /* out: of the tip at the end; at the first step and at the end */
  PetscReal displacement, energy[2];
} Run;

static PetscReal frequency(MassMatrix mass)
{
  const PetscReal h = 1.0 / CELLS, c = cos(PETSC_PI / 2 * h), stiffness = 1e6 / (1000 * h * h) * (1 - c);
  return PetscSqrtReal(mass == MASS_LUMPED ? 2 * stiffness : 6 * stiffness / (2 + c));
}

static PetscReal energy_of(Model *m) { return model_sum(m, "energy: kinetic", 0) + model_sum(m, "energy: elastic", 0); }

/* The field of the mode's nodal velocities, at points too. */
static void set_velocity(Model *m, PetscReal largest)
{
  for (PetscInt i = 0; i < m->grid->n_nodes; ++i) m->nodes->v[2 * i] = largest * sin(PETSC_PI / 2 * m->grid->x[2 * i]);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal x = CELLS * point_real(m->points, POINT_X, p)[0], cell = floor(x);
    point_real(m->points, POINT_V, p)[0] = largest * ((cell + 1 - x) * sin(PETSC_PI / 2 * cell / CELLS) +
                                                      (x - cell) * sin(PETSC_PI / 2 * (cell + 1) / CELLS));
  }
  m->space->present = PETSC_FALSE;
}

/* Starts from rest position with the velocity of the mode. */
static void run_bar(Run *r)
{
  Bench b;
  const PetscReal omega = frequency(r->mass), period = 2 * PETSC_PI / omega, amplitude = r->strain / (PETSC_PI / 2),
                  dt = period / (PetscReal)r->steps;
  const PetscInt steps = (PetscInt)(r->end * (PetscReal)r->steps + 0.5);
  bench_init(&b, r->middle ? "mpm" : "fem", CELL_QUADRILATERAL, 0);
  b.constants[1].value = 0;
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 1.0 / CELLS, 0}, 1.0 / CELLS);
  bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 1.0 / CELLS, 0});
  bench_dynamic(&b, r->end * period, dt);
  b.c.analysis.bossak = r->bossak;
  b.c.analysis.damping = r->damping;
  b.c.analysis.mass = r->mass;
  if (r->middle) {
    b.c.analysis.scheme = (char *)"midpoint";
    b.c.analysis.transfer = (char *)"consistent";
    b.c.stabilisation.mass = 0;
  }
  if (r->bossak < 0) {
    b.c.analysis.beta = PetscSqr(1 - r->bossak) / 4;
    b.c.analysis.gamma = 0.5 - r->bossak;
  }
  bench_motion(&b, 0, 0, MOTION_FIXED, 1);
  MotionSpec *all = bench_motion(&b, 1, 0, MOTION_FIXED, 2);
  all->on.max[1] = 1;
  bench_tracer(&b, "displacement", 0, 1, 0, 0);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  set_velocity(m, amplitude * omega);
  for (PetscInt s = 0; s < steps; ++s) {
    CHECK(model_step(m, dt).cuts == 0, "a step was halved");
    if (s == 0) r->energy[0] = energy_of(m);
  }
  r->energy[1] = energy_of(m);
  CALL(ModelMeasure(m, &b.measure[0], 0, &r->displacement));
  r->displacement /= amplitude;
  CALL(ModelDestroy(&m));
}

/* After one period the tip is back at zero; what it lacks is the error of the phase. */
static void test_second_order(void **state)
{
  PetscReal last = 0;
  (void)state;
  for (PetscInt k = 0, steps = 20; k < 3; ++k, steps *= 2) {
    Run r = {.end = 1, .steps = steps, .strain = 1e-6};
    run_bar(&r);
    const PetscReal error = PetscAbsReal(r.displacement), order = k ? log2(last / error) : 2;
    PetscPrintf(PETSC_COMM_WORLD, "%d steps a period: error %.4e, order %.3f\n", (int)steps, (double)error,
                (double)order);
    CHECK(PetscAbsReal(order - 2) < 0.1, "order %g", (double)order);
    last = error;
  }
}

/* The period of the trapezoidal rule is known: tan(omega' dt / 2) = omega dt / 2, and the
 * midpoint rule's is the same. */
static void test_exact_phase(void **state)
{
  Run r = {.end = 1, .steps = 20, .strain = 1e-6},
      lumped = {.end = 1, .steps = 20, .strain = 1e-6, .mass = MASS_LUMPED},
      middle = {.end = 1, .steps = 20, .strain = 1e-6, .middle = PETSC_TRUE};
  (void)state;
  const PetscReal slowed = 2 * atan(PETSC_PI / 20) * 20;
  run_bar(&r);
  CHECK_CLOSE(r.displacement, sin(slowed), 1e-5);
  run_bar(&lumped);
  CHECK_CLOSE(lumped.displacement, sin(slowed), 1e-5);
  run_bar(&middle);
  CHECK_CLOSE(middle.displacement, sin(slowed), 1e-5);
}

static void test_energy(void **state)
{
  Run r = {.end = 5, .steps = 20, .strain = 3e-5};
  (void)state;
  run_bar(&r);
  CHECK_CLOSE(r.energy[1], r.energy[0], 1e-6 * r.energy[0]);
}

static void test_bossak(void **state)
{
  Run r = {.end = 5, .steps = 20, .strain = 3e-5, .bossak = -0.1};
  (void)state;
  run_bar(&r);
  CHECK(r.energy[1] < 0.999 * r.energy[0] && r.energy[1] > 0.8 * r.energy[0], "energy %g of %g", (double)r.energy[1],
        (double)r.energy[0]);
  Run coarse = {.end = 5, .steps = 5, .strain = 3e-5, .bossak = -0.1};
  run_bar(&coarse); /* long steps are damped more */
  CHECK(coarse.energy[1] / coarse.energy[0] < 0.9 * r.energy[1] / r.energy[0], "energy %g of %g",
        (double)coarse.energy[1], (double)coarse.energy[0]);
}

/* Bossak stays second order. */
static void test_bossak_order(void **state)
{
  PetscReal last = 0, order = 2;
  (void)state;
  for (PetscInt k = 0, steps = 40; k < 3; ++k, steps *= 2) {
    Run r = {.end = 1, .steps = steps, .strain = 1e-6, .bossak = -0.1};
    run_bar(&r);
    if (k) order = log2(last / PetscAbsReal(r.displacement));
    last = PetscAbsReal(r.displacement);
  }
  CHECK(PetscAbsReal(order - 2) < 0.1, "order %g", (double)order);
}

/* Damping c = alpha M: the amplitude falls with exp(-alpha t / 2), the energy (mean over a cycle)
 * with its square. */
static void test_rayleigh(void **state)
{
  const PetscReal period = 2 * PETSC_PI / frequency(MASS_CONSISTENT), alpha = 2;
  (void)state;
  for (int k = 0; k < 2; ++k) {
    Run r = {.end = 4.25, .steps = 40, .strain = 3e-5, .damping = alpha, .middle = k == 1};
    run_bar(&r); /* a quarter period further the displacement has its maximum */
    CHECK_CLOSE(r.displacement, exp(-alpha * 4.25 * period / 2), 0.01 * exp(-alpha * 4.25 * period / 2));
  }
}

/* A load that is there from the start: the nodes of fem begin with the accelerations of their mass matrix, and the
 * first step loses nothing. */
static void test_sudden(void **state)
{
  (void)state;
  EACH_CELL(cell, CELL_HEXAHEDRON)
  {
    Bench b;
    bench_init(&b, "fem", cell, 4);
    bench_dynamic(&b, 1, 1e-3);
    b.c.newton.residual = 1e-10;
    bench_motion(&b, 1, 0, MOTION_FIXED, 7);
    bench_traction(&b, 1, 1, NULL, 300, -1000, 0);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    model_step(m, 1e-3);
    const PetscReal balance = model_sum(m, "energy: balance", 0);
    CHECK(PetscAbsReal(balance) <= 1e-7, "the first step lost %g of the energy", (double)balance);
    CALL(ModelDestroy(&m));
  }
}

/* What is moved at a steady speed and then held still stands still, and the account closes: fem with both masses. */
static void test_stopped(void **state)
{
  static PetscReal time[] = {0, 0.1, 1}, way[] = {0, 1, 1};
  (void)state;
  for (int lumped = 0; lumped < 2; ++lumped) EACH_CELL(cell, CELL_HEXAHEDRON)
    {
      Bench b;
      bench_init(&b, "fem", cell, 4);
      bench_dynamic(&b, 0.2, 0.01);
      b.c.newton.residual = 1e-10;
      b.c.analysis.mass = lumped ? MASS_LUMPED : MASS_CONSISTENT;
      MotionSpec *end = bench_motion(&b, 0, 0, MOTION_DISPLACEMENT, 7);
      end->value[0] = 0.02;
      end->amplitude = (Amplitude){.n = 3, .time = time, .value = way};
      Model *m = bench_model(&b, PETSC_COMM_WORLD);
      while (m->time < 0.2 - 1e-9) {
        model_step(m, 0.01);
        for (PetscInt node = 0; node < m->grid->n_nodes; ++node) {
          const PetscInt i = node * m->dim;
          if (m->boundary->fixed[i]) CHECK_CLOSE(m->nodes->v[i], m->time < 0.1 + 1e-9 ? 0.2 : 0, 1e-12);
        }
      }
      CHECK_CLOSE(model_sum(m, "energy: balance", 0), 0, 1e-7);
      CALL(ModelDestroy(&m));
    }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_second_order), cmocka_unit_test(test_exact_phase),  cmocka_unit_test(test_energy),
    cmocka_unit_test(test_bossak),       cmocka_unit_test(test_bossak_order), cmocka_unit_test(test_rayleigh),
    cmocka_unit_test(test_sudden),       cmocka_unit_test(test_stopped),
  };
  return run_model_tests(argc, argv, tests);
}
