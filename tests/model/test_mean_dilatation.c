/* Cells whose points share one change of volume, over many steps: fem has the volume of each cell to
 * round-off and forgets the steps, energies close, Newton converges quadratically, and a bar of mpm
 * whose points pass from cell to cell does not lock. */
#include "axisymmetric.h"

#define NEARLY 0.495

static const CellType solid[] = {CELL_QUADRILATERAL, CELL_HEXAHEDRON};

/* A block of nearly incompressible rubber, 1 m on 0.25, held at its foot; the top goes aside by 0.35 m
 * and down by 0.1 m. */
static void sheared(Bench *b, CellType cell, PetscBool rings, PetscInt steps, PetscReal poisson)
{
  static NamedValue value[2];
  bench_init(b, "fem", cell, 0);
  if (rings) b->c.kinematics = &kinematics_axisymmetric;
  b->c.formulation = "mean-dilatation";
  value[0] = (NamedValue){"young", 1e6};
  value[1] = (NamedValue){"poisson", poisson};
  b->material.parameters = value;
  bench_grid(b, (PetscReal[]){rings ? 0.5 : 0, 0, 0}, (PetscReal[]){rings ? 0.75 : 0.25, 1, 0.25}, 0.125);
  bench_box(b, 0, (PetscReal[]){rings ? 0.5 : 0, 0, 0}, (PetscReal[]){rings ? 0.75 : 0.25, 1, 0.25});
  b->c.analysis.step = b->c.analysis.largest = 1 / (PetscReal)steps;
  bench_motion(b, 1, 0, MOTION_FIXED, 7);
  MotionSpec *top = bench_motion(b, 1, 1, MOTION_DISPLACEMENT, 7);
  top->value[0] = rings ? 0.15 : 0.35;
  top->value[1] = -0.1;
  b->measure[b->c.n_measures++] = (MeasureSpec){.name = "force", .kind = "reaction", .component = 0, .boundary = 1};
}

/* --- fem: the volume that a cell has --- */

/* Area of a quadrilateral; of rings the volume of the section's revolution. */
static PetscReal quadrilateral(const PetscInt *node, const PetscReal *x, PetscBool rings)
{
  PetscReal sum = 0;
  for (int i = 0; i < 4; ++i) {
    const PetscReal *a = x + 2 * node[i], *b = x + 2 * node[(i + 1) % 4];
    const PetscReal cross = a[0] * b[1] - b[0] * a[1];
    sum += rings ? PETSC_PI / 3 * (a[0] + b[0]) * cross : 0.5 * cross;
  }
  return sum;
}

/* J of all points of a cell is its volume over that at the start, in however many steps, and the force
 * on the top does not know them. */
static void test_volume(void **state)
{
  (void)state;
  EACH_VARIANT (rings, 2) {
    PetscReal force[3];
    static const PetscInt steps[3] = {10, 20, 30};
    for (int k = 0; k < 3; ++k) {
      Bench b;
      sheared(&b, CELL_QUADRILATERAL, rings, steps[k], NEARLY);
      Model *m = bench_model(&b, PETSC_COMM_WORLD);
      PetscReal *X = node_places(m), worst = 0, spread = 0;
      run_through(m);
      for (PetscInt p = 0; p < m->points->n; ++p) {
        const PetscInt *node = m->grid->cell_node + 4 * m->points->cell[p];
        PetscReal F[9];
        point_F(m->points, p, F);
        const PetscReal ratio = quadrilateral(node, m->grid->x, rings) / quadrilateral(node, X, rings);
        worst = PetscMax(worst, PetscAbsReal(m->points->real[POINT_J][p] / ratio - 1));
        spread = PetscMax(spread, PetscAbsReal(tensor_det(F) / ratio - 1));
      }
      /* with four points a ring's volume is integrated up to r^2 times bilinear: exactly */
      CHECK(model_max(m, worst) <= 1e-12, "a volume is off by %g", (double)worst);
      CHECK(model_max(m, spread) > 0.02, "all points of a cell strain alike: %g", (double)spread);
      CALL(ModelMeasure(m, &b.measure[0], 0, &force[k]));
      CALL(PetscFree(X));
      CALL(ModelDestroy(&m));
    }
    for (int k = 0; k < 2; ++k) CHECK_CLOSE(force[k], force[2], 1e-9 * PetscAbsReal(force[2]));
  }
}

/* In space, too, steps are forgotten; and the residuals of the last step fall quadratically. */
static void test_steps(void **state)
{
  PetscReal force[2];
  (void)state;
  for (int k = 0; k < 2; ++k) {
    Bench b;
    sheared(&b, CELL_HEXAHEDRON, PETSC_FALSE, k ? 20 : 10, NEARLY);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    StepReport r = {0};
    while (m->time < 1 - 1e-9) r = model_step(m, 1 - m->time);
    const PetscReal *h = r.newton.residual;
    const PetscInt last = r.newton.iterations;
    CHECK(last <= 7, "%d iterations", (int)last);
    CHECK(h[last - 1] > 1e-8 || h[last - 2] > 1e-4, "not quadratic: %g %g %g", (double)h[last - 2], (double)h[last - 1],
          (double)h[last]);
    CALL(ModelMeasure(m, &b.measure[0], 0, &force[k]));
    CALL(ModelDestroy(&m));
  }
  CHECK_CLOSE(force[0], force[1], 1e-9 * PetscAbsReal(force[1]));
}

/* --- energy --- */

/* What all accounts together leave. */
static PetscReal gap(const Energies *e)
{
  return e->external + e->boundary - (e->kinetic + e->elastic + e->dissipated + e->damped + e->transfer);
}

/* A block on a floor is pushed aside and swings: by the trapezoidal rule what forces work at both ends
 * of each step is what points count, though the divergence there is that of the cell. */
static void swings(CellType cell, PetscBool rings)
{
  Bench b;
  Energies e;
  bench_init(&b, "fem", cell, 0);
  if (rings) b.c.kinematics = &kinematics_axisymmetric;
  b.c.formulation = "mean-dilatation";
  b.constants[1].value = 0.45;
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 2, 1}, cell == CELL_HEXAHEDRON ? 0.5 : 0.25);
  bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 2, 1});
  b.body[0].velocity[rings ? 1 : 0] = rings ? -6 : 6;
  bench_dynamic(&b, 1, 0.004);
  bench_motion(&b, 1, 0, MOTION_FIXED, 7);
  b.c.newton.residual = 1e-10;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  model_step(m, 1);
  CALL(ModelEnergies(m, &e));
  const PetscReal start = e.kinetic + e.elastic, off = gap(&e);
  PetscReal largest = 0;
  for (int step = 0; step < 40; ++step) {
    model_step(m, 1);
    CALL(ModelEnergies(m, &e));
    largest = PetscMax(largest, e.elastic);
    CHECK_CLOSE(gap(&e), off, 1e-9 * start);
  }
  CHECK(largest > 0.2 * start, "only %g of the energy is in strains", (double)(largest / start));
  CALL(ModelDestroy(&m));
}

static void test_energy(void **state)
{
  (void)state;
  EACH_OF (k, solid) swings(solid[k], PETSC_FALSE);
  swings(CELL_QUADRILATERAL, PETSC_TRUE);
}

/* --- mpm: points pass from cell to cell --- */

/* Tip of a bar of 4 m by 1 that bends under its weight. What others are compared with is quickly found on one rank, and
 * so each rank finds it for itself (PETSC_COMM_SELF). */
static PetscReal tip(MPI_Comm comm, const char *method, const char *formulation, PetscInt steps)
{
  Bench b;
  PetscReal value;
  bench_init(&b, method, CELL_QUADRILATERAL, 0);
  const PetscBool fem = !strcmp(method, "fem");
  b.c.formulation = (char *)formulation;
  b.constants[0].value = 2e6;
  b.constants[1].value = 0.499;
  bench_grid(&b, (PetscReal[]){0, fem ? 0 : -1.5, 0}, (PetscReal[]){fem ? 4 : 4.5, fem ? 1 : 1.5, 0}, 0.125);
  bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){4, 1, 0});
  b.c.gravity[1] = -2;
  b.c.analysis.step = b.c.analysis.largest = 1 / (PetscReal)steps;
  bench_motion(&b, 0, 0, MOTION_FIXED, 3);
  bench_tracer(&b, "displacement", 1, 4, 0.5, 0);
  Model *m = bench_model(&b, comm);
  run_through(m);
  CALL(ModelMeasure(m, &b.measure[0], 0, &value));
  CALL(ModelDestroy(&m));
  return value;
}

/* The bar of the grid that moves with it is a little off by mpm, 1.5 % in 40 steps; with displacements
 * alone it is twice as stiff. */
static void test_bar(void **state)
{
  const PetscReal fem = tip(PETSC_COMM_WORLD, "fem", "mean-dilatation", 10),
                  shared = tip(PETSC_COMM_WORLD, "mpm", "mean-dilatation", 40);
  (void)state;
  CHECK_CLOSE(shared, fem, 0.02 * -fem);
  CHECK(tip(PETSC_COMM_SELF, "mpm", "displacement", 40) > 0.5 * fem, "it does not lock");
}

/* --- explicit dynamics --- */

/* Way of the top of a block on a floor under a weight that acts aside, or of a cylinder under its own. */
static PetscReal pushed(MPI_Comm comm, const char *method, const char *formulation, CellType cell, PetscBool rings,
                        PetscReal h)
{
  const PetscBool fem = !strcmp(method, "fem");
  const int up = cell == CELL_HEXAHEDRON ? 2 : 1;
  Bench b;
  PetscReal value, min[3] = {0, 0, 0}, max[3] = {1, 1, 1};
  bench_init(&b, method, cell, 0);
  if (rings) b.c.kinematics = &kinematics_axisymmetric;
  b.c.formulation = (char *)formulation;
  b.constants[1].value = 0.499;
  bench_box(&b, 0, min, (PetscReal[]){1, up == 2 ? 0.5 : 2, 2});
  max[1] = up == 2 ? 0.5 : 2, max[2] = 2;
  for (int d = 0; !fem && d <= up; ++d) {
    if (d < up && !rings) min[d] -= 0.5;
    max[d] += 0.5;
  }
  bench_grid(&b, min, max, h);
  bench_dynamic(&b, 1, fem ? 2.5e-3 : 5e-3);
  b.c.basis.kind = "cell";
  b.c.analysis.type = fem ? ANALYSIS_DYNAMIC : ANALYSIS_EXPLICIT;
  b.c.analysis.courant = 0.8;
  b.c.analysis.transfer = (char *)(fem ? "thesis" : "consistent");
  b.c.gravity[rings ? 1 : 0] = -20;
  bench_motion(&b, up, 0, MOTION_FIXED, rings ? 2 : 7);
  if (rings) bench_motion(&b, 0, 0, MOTION_FIXED, 1);
  bench_tracer(&b, "displacement", rings ? 1 : 0, 0.5, up == 2 ? 0.25 : 2, 2);
  Model *m = bench_model(&b, comm);
  while (m->time < 0.15 - 1e-9) model_step(m, PETSC_MAX_REAL);
  CALL(ModelMeasure(m, &b.measure[0], 0, &value));
  CHECK(fem || PetscAbsReal(model_sum(m, "energy: balance", 0)) < 1e-12, "open");
  CALL(ModelDestroy(&m));
  return value;
}

/* Against implicit finite elements of the same formulation, which share no line with it but the laws: what is left
 * falls with the square of the cells, and displacements alone are farther off. */
static void test_explicit(void **state)
{
  static const struct {
    CellType cell;
    PetscBool rings;
    PetscReal h, off;
  } all[] = {{CELL_QUADRILATERAL, PETSC_FALSE, 0.25, 0.08},
             {CELL_QUADRILATERAL, PETSC_FALSE, 0.125, 0.025},
             {CELL_QUADRILATERAL, PETSC_TRUE, 0.125, 0.025},
             {CELL_HEXAHEDRON, PETSC_FALSE, 0.25, 0.08}};
  (void)state;
  EACH_OF (k, all) {
    const PetscReal fem = pushed(PETSC_COMM_SELF, "fem", "mean-dilatation", all[k].cell, all[k].rings, all[k].h);
    const PetscReal shared = pushed(PETSC_COMM_WORLD, "mpm", "mean-dilatation", all[k].cell, all[k].rings, all[k].h);
    const PetscReal locked = pushed(PETSC_COMM_SELF, "mpm", "displacement", all[k].cell, all[k].rings, all[k].h);
    PetscPrintf(PETSC_COMM_WORLD, "cell %d, h %g: %.6g, fem %.6g; displacements %.6g\n", (int)all[k].cell,
                (double)all[k].h, (double)shared, (double)fem, (double)locked);
    CHECK_CLOSE(shared, fem, all[k].off * PetscAbsReal(fem));
    CHECK(PetscAbsReal(shared - fem) < 0.8 * PetscAbsReal(locked - fem), "no better than displacements");
  }
}

/* A block under its own weight whose sides are let go: pressures differ within cells, and the first kick is that of the
 * implicit force, which shares them. */
static void test_kick(void **state)
{
  (void)state;
  EACH_VARIANT (rings, 2) {
    Model *m[2];
    PetscReal fastest = 0;
    for (int implicit = 0; implicit < 2; ++implicit) {
      Bench b;
      bench_init(&b, "mpm", CELL_QUADRILATERAL, 0);
      if (rings) b.c.kinematics = &kinematics_axisymmetric;
      b.c.formulation = "mean-dilatation";
      bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){1.5, 1.5, 0}, 0.25);
      bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 1, 0});
      bench_dynamic(&b, 1, 1e-6);
      b.c.basis.kind = "cell";
      b.c.analysis.mass = MASS_LUMPED;
      b.c.analysis.courant = 0.5;
      if (!implicit) b.c.analysis.type = ANALYSIS_EXPLICIT;
      b.c.analysis.transfer = (char *)"thesis";
      b.body[0].has_k0 = PETSC_TRUE;
      b.body[0].k0 = 1;
      b.c.gravity[1] = -9.81;
      bench_motion(&b, 1, 0, MOTION_FIXED, 2);
      bench_motion(&b, 0, 0, MOTION_FIXED, 1);
      m[implicit] = bench_model(&b, PETSC_COMM_WORLD);
      model_step(m[implicit], PETSC_MAX_REAL);
    }
    for (PetscInt i = 0; i < 2 * m[0]->points->n; ++i)
      fastest = PetscMax(fastest, PetscAbsReal(m[0]->points->real[POINT_V][i]));
    fastest = model_max(m[0], fastest);
    for (PetscInt i = 0; i < 2 * m[0]->points->n; ++i)
      CHECK_CLOSE(m[0]->points->real[POINT_V][i], m[1]->points->real[POINT_V][i], 1e-4 * fastest);
    CHECK(fastest > 1e-6, "nothing pushes");
    CALL(ModelDestroy(&m[0]));
    CALL(ModelDestroy(&m[1]));
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_volume), cmocka_unit_test(test_steps),    cmocka_unit_test(test_energy),
    cmocka_unit_test(test_bar),    cmocka_unit_test(test_explicit), cmocka_unit_test(test_kick),
  };
  return run_model_tests_in_turns(argc, argv, tests);
}
