/* A force acts at its place by the functions by which the field is measured there: its work is the force times the way
 * of a tracer that starts where it does, and what a force at A does at B is what it does at A from B. */
#include "case_builder.h"
#include "model/model_private.h"

typedef struct {
  const char *what, *basis;
  const Kinematics *kinematics;
  PetscReal max[3];   /* of the body: where it ends in its cells */
  PetscReal at[2][3]; /* places of forces and tracers */
} Places;

static const Places places[] = {
  {"a plane body", "bspline", &kinematics_plane_strain, {1, 1, 0}, {{0.47, 0.61, 0}, {0.83, 0.37, 0}}},
  {"the same with gimp", "gimp", &kinematics_plane_strain, {1, 1, 0}, {{0.47, 0.61, 0}, {0.83, 0.37, 0}}},
  {"its corner and surface", "bspline", &kinematics_plane_strain, {1, 1, 0}, {{1, 1, 0}, {0.6, 1, 0}}},
  {"a cut one", "bspline", &kinematics_plane_strain, {0.89, 1.02, 0}, {{0.88, 1.01, 0}, {0.4, 0.13, 0}}},
  {"one with nodes that follow", "bspline", &kinematics_plane_strain, {1.001, 1.002, 0}, {{1, 1, 0}, {0.9, 0.5, 0}}},
  {"a ring", "bspline", &kinematics_axisymmetric, {1, 1.03, 0}, {{0.95, 0.97, 0}, {0.13, 0.61, 0}}},
  {"a solid", "bspline", &kinematics_3d, {1, 0.93, 1}, {{0.97, 0.9, 0.47}, {0.31, 0.57, 0.83}}},
  {"the same with gimp", "gimp", &kinematics_3d, {1, 0.93, 1}, {{0.97, 0.9, 0.47}, {0.31, 0.57, 0.83}}},
};

/* A body on a floor, with a force at one of two places and tracers at both. */
static void set_up(Bench *b, const Places *k, int at, const PetscReal force[3])
{
  const PetscInt dim = k->kinematics->dim;
  bench_init(b, "mpm", dim == 3 ? CELL_HEXAHEDRON : CELL_QUADRILATERAL, 0);
  b->c.kinematics = k->kinematics;
  bench_grid(b, (PetscReal[]){0, 0, 0}, (PetscReal[]){1.5, 1.5, 1.5}, 0.25);
  bench_box(b, 0, (PetscReal[]){0, 0, 0}, k->max);
  b->c.basis.kind = k->basis;
  bench_motion(b, 1, 0, MOTION_FIXED, 7);
  b->load[b->c.n_loads++] = (LoadSpec){
    .kind = LOAD_POINT, .at = {k->at[at][0], k->at[at][1], k->at[at][2]}, .value = {force[0], force[1], force[2]}};
  for (int t = 0; t < 2; ++t)
    for (PetscInt d = 0; d < dim; ++d) bench_tracer(b, "displacement", d, k->at[t][0], k->at[t][1], k->at[t][2]);
}

/* Of the tracer at a place along a force. */
static PetscReal way(Model *m, const Bench *b, int at, const PetscReal force[3])
{
  PetscReal sum = 0, u;
  for (PetscInt d = 0; d < m->dim; ++d) {
    const PetscInt k = at * m->dim + d;
    CALL(ModelMeasure(m, b->measure + k, k, &u));
    sum += force[d] * u;
  }
  return sum;
}

/* Twelve times what is linear in a force of what it does at the other place along the force there: its squares fall out
 * of opposites, its cubes of the double. */
static PetscReal does_there(const Places *k, int at, const PetscReal force[2][3])
{
  static const PetscReal times[] = {1, -1, 2, -2}, weight[] = {8, -8, -1, 1};
  PetscReal sum = 0;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(times); ++i) {
    Bench b;
    set_up(&b, k, at, (PetscReal[]){times[i] * force[at][0], times[i] * force[at][1], times[i] * force[at][2]});
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    model_step(m, 1);
    sum += weight[i] * way(m, &b, 1 - at, force[1 - at]);
    CALL(ModelDestroy(&m));
    bench_end(&b);
  }
  return sum;
}

static void test_reciprocity(void **state)
{
  const PetscReal force[2][3] = {{3, -4, 2}, {1, 5, -3}};
  (void)state;
  EACH_OF (k, places) {
    const PetscReal there = does_there(places + k, 0, force), back = does_there(places + k, 1, force);
    PetscPrintf(PETSC_COMM_WORLD, "%s: %.12g and %.12g J\n", places[k].what, (double)there, (double)back);
    CHECK_CLOSE(back, there, 1e-9 * PetscAbsReal(there));
  }
}

/* Many steps that carry both across cells. */
static void test_work(void **state)
{
  const PetscReal force[3] = {4000, -9000, 3000};
  (void)state;
  EACH_OF (k, places) {
    PetscReal along = 0, work = 0;
    Bench b;
    set_up(&b, places + k, 0, force);
    b.c.analysis.step = b.c.analysis.largest = 0.25;
    static PetscReal time[] = {0, 1}, rise[] = {0, 1};
    b.load[0].amplitude = (Amplitude){.n = 2, .time = time, .value = rise};
    b.c.newton.residual = 1e-9;
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    while (m->time < 1 - 1e-9) {
      const PetscReal t0 = m->time, before = way(m, &b, 0, force);
      model_step(m, 1 - m->time);
      work += 0.5 * (t0 + m->time) * (way(m, &b, 0, force) - before);
    }
    along = model_sum(m, "energy: external", 0);
    PetscPrintf(PETSC_COMM_WORLD, "%s: %.12g and %.12g J\n", places[k].what, (double)along, (double)work);
    CHECK_CLOSE(work, along, 1e-9 * PetscAbsReal(along));
    CALL(ModelDestroy(&m));
    bench_end(&b);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_reciprocity), cmocka_unit_test(test_work)};
  return run_model_tests(argc, argv, tests);
}
