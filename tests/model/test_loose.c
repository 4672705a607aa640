/* Grains that remember how far they came apart (`opening_memory`): a column that is torn off its
 * floor and falls back, a block that is pulled open and pushed together. */
#include "case_builder.h"

static NamedValue sand_constants[] = {{"young", 1e6},         {"poisson", 0.3}, {"friction_angle", 31},
                                      {"dilatancy_angle", 0}, {"cohesion", 0},  {"opening_memory", 0}};

static void sand(Bench *b, const char *method, PetscReal width, PetscReal height, PetscReal size, PetscReal memory)
{
  bench_init(b, method, CELL_QUADRILATERAL, 0);
  sand_constants[5].value = memory;
  b->material = (MaterialSpec){
    .name = "sand", .law = "mohr-coulomb", .density = 1500, .n_parameters = 6, .parameters = sand_constants};
  b->body[0].material = "sand";
  bench_grid(b, (PetscReal[]){0, 0, 0}, (PetscReal[]){width, height, 0}, size);
  b->c.newton = (NewtonSpec){.residual = 1e-9, .increment = 1e-10, .max_iterations = 25, .ease = 6};
  b->c.stabilisation = (StabilisationSpec){.stiffness = 1e-6, .mass = 1, .inertia = 0.01};
  b->c.linear = LINEAR_AUTO;
}

/* Undeformed volume and volume as the law sees it, mean height of the mass over all ranks. */
static void volumes(const Model *m, PetscReal *ratio, PetscReal *centre)
{
  PetscReal sum[4] = {0}, all[4];
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal V0 = m->points->real[POINT_VOLUME][p];
    sum[0] += V0;
    sum[1] += V0 * m->points->real[POINT_J][p];
    sum[2] += V0 * point_real(m->points, POINT_X, p)[1];
  }
  CALL(MPI_Allreduce(sum, all, 4, MPIU_REAL, MPI_SUM, m->comm));
  *ratio = all[1] / all[0];
  *centre = all[2] / all[0];
}

/* A column of 2 x 10 cells between smooth walls on a floor that holds it. For 0.03 s gravity lifts
 * it, so that its lowest row opens; then it falls back and comes to rest. Steps see waves pass (a
 * third of a cell in each): the trapezoidal rule makes energy of contact that it cannot see. */
static void lifted(const char *method, PetscReal memory, PetscReal *opened, PetscReal *ratio, PetscReal *centre)
{
  static PetscReal time[] = {0.03, 0.0301}, up[] = {-1, 1};
  const PetscReal h = 0.01, end = ranks_of_world() > 1 ? 0.2 : 0.3; /* mpm has come to rest earlier than fem */
  PetscReal unused;
  Bench b;
  sand(&b, method, 2 * h, 20 * h, h, memory);
  bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){2 * h, 10 * h, 0});
  b.body[0].points_per_cell = 4;
  bench_dynamic(&b, end, 1e-4);
  b.c.analysis.damping = 20;
  bench_motion(&b, 1, 0, MOTION_FIXED, 2);
  bench_motion(&b, 0, 0, MOTION_FIXED, 1);
  bench_motion(&b, 0, 2 * h, MOTION_FIXED, 1);
  b.c.gravity[1] = -9.81;
  b.c.gravity_amplitude = (Amplitude){.n = 2, .time = time, .value = up};
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  while (m->time < 0.03 - 1e-9) model_step(m, 0.03 - m->time);
  volumes(m, opened, &unused);
  while (m->time < end - 1e-9) model_step(m, end - m->time);
  volumes(m, ratio, centre);
  CALL(ModelDestroy(&m));
}

/* At rest the column bears its weight as it would had it never been lifted: J is 1 - rho g H / 2 M,
 * and elastic shortening lowers the middle of its mass by rho g H^2 / 3 M. In mpm rows of points
 * change cells, whose densest row then bears for the others: a fifth of what it is without memory
 * stays open. Without memory it stands on all that opened. */
static void test_column_falls_back(void **state)
{
  static const char *method[] = {"fem", "mpm"};
  const PetscReal H = 0.1, M = 1e6 * 0.7 / (1.3 * 0.4), weight = 1500 * 9.81;
  PetscMPIInt ranks;
  (void)state;
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  for (int k = ranks > 1; k < 2; ++k) { /* of ranks mpm tells enough */
    PetscReal opened[2], ratio[2], centre[2];
    for (int memory = 0; memory < 2; ++memory)
      lifted(method[k], memory, &opened[memory], &ratio[memory], &centre[memory]);
    PetscPrintf(PETSC_COMM_WORLD, "%s: opened to %.3f, at rest %.5f, centre %.5f m; without memory %.5f, %.5f m\n",
                method[k], (double)opened[1], (double)ratio[1], (double)centre[1], (double)ratio[0], (double)centre[0]);
    CHECK(opened[1] > 1.02, "%s: nothing came apart", method[k]);
    const PetscReal dense = 1 - weight * H / (2 * M), low = H / 2 - weight * H * H / (3 * M);
    CHECK(ratio[0] > 1.05 && centre[0] > 1.1 * low, "%s: without memory it is no looser", method[k]);
    CHECK_CLOSE(ratio[1], dense, k == 0 ? 2e-4 : 0.2 * (ratio[0] - dense));
    CHECK_CLOSE(centre[1], low, k == 0 ? 2e-4 * H : 0.2 * (centre[0] - low));
  }
}

/* All shrinks towards the origin, along y half as fast. */
static void press(void *context, const PetscReal *x, PetscReal t0, PetscReal t1, PetscReal *increment)
{
  (void)context;
  for (int d = 0; d < 2; ++d) increment[d] = x[d] * expm1((d ? -2 : -4) * (t1 - t0));
}

/* A block of loose grains, each open by another amount (0 to 0.02), is pressed together by its edge.
 * Nothing bears at first, then one after the other does. Newton meets grains that close in every
 * step, and its residuals fall quadratically. */
static void test_newton(void **state)
{
  Bench b;
  PetscInt squared = 0, bearing = 0;
  (void)state;
  sand(&b, "fem", 0.1, 0.1, 0.1 / 6, 1);
  bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){0.1, 0.1, 0});
  bench_dynamic(&b, 1, 2e-4);
  bench_motion(&b, -1, 0, MOTION_FIXED, 3);
  b.c.newton.residual = 1e-10;
  b.c.newton.increment = 0;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  m->boundary->field = press;
  for (PetscInt p = 0; p < m->points->n; ++p)
    point_real(m->points, POINT_STATE, p)[7] = 0.02 * fmod(0.618 * (PetscReal)m->points->id[p], 1);
  for (PetscInt i = 0; i < m->grid->n_nodes * 2; ++i) m->nodes->v[i] = (i % 2 ? -2 : -4) * m->grid->x[i];
  for (int step = 0; step < 25; ++step) {
    const StepReport r = model_step(m, 1);
    PetscBool is = PETSC_FALSE;
    CHECK(r.cuts == 0 && r.newton.iterations <= 8, "step %d: %d iterations", step, (int)r.newton.iterations);
    for (PetscInt i = 0; i < r.newton.iterations; ++i) {
      const PetscReal now = r.newton.residual[i], next = r.newton.residual[i + 1];
      is |= now < 2e-2 && now > 1e-7 && next <= PetscMax(30 * now * now, 1e-11);
    }
    bearing += r.newton.iterations > 2;
    squared += is && r.newton.iterations > 2;
  }
  PetscReal open = 0;
  for (PetscInt p = 0; p < m->points->n; ++p) open = PetscMax(open, point_real(m->points, POINT_STATE, p)[7]);
  CHECK_CLOSE(model_max(m, open), 0, 0);
  CHECK(bearing >= 10 && squared == bearing, "%d of %d steps quadratic", (int)squared, (int)bearing);
  CALL(ModelDestroy(&m));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_column_falls_back),
    cmocka_unit_test(test_newton),
  };
  return run_model_tests_in_turns(argc, argv, tests);
}
