/* Walls in axisymmetry, and with pressures as unknowns: bodies pressed evenly between walls, whose
 * forces are known in closed form, cylinders that stand by their weight or fall, and the tangent of
 * contact by differences. */
#include "axisymmetric.h"
#include "model/model_private.h"

#define YOUNG 1e6
/* m: gaps of 1e-5 of a cell of 0.25 m remain at each wall, and forces rise a little faster than the way. */
#define GAPS 1e-5
#define AREA 1e-3 /* likewise, of surfaces, where points hang at none of their edges */

/* --- pressed evenly --- */
typedef struct {
  const char *method, *formulation;
  CellType cell;
  const Kinematics *kinematics;
  PetscReal poisson;
  PetscReal shorter;  /* of a height of 1, m */
  PetscBool confined; /* by a wall at x = 1; else its sides are free */
} Press;

/* Principal Cauchy stresses of the neo-Hookean law, written down again. */
static void stress_of(PetscReal nu, const PetscReal stretch[3], PetscReal sigma[3])
{
  const PetscReal mu = YOUNG / (2 * (1 + nu)), lambda = YOUNG * nu / ((1 + nu) * (1 - 2 * nu));
  const PetscReal J = stretch[0] * stretch[1] * stretch[2];
  for (int d = 0; d < 3; ++d) sigma[d] = (lambda * log(J) + mu * (stretch[d] * stretch[d] - 1)) / J;
}

/* The stretch of the sides at which they bear nothing, or none. */
static void stretches(const Press *t, PetscReal stretch[3])
{
  PetscReal low = 1, high = 2, sigma[3];
  stretch[1] = 1 - t->shorter;
  for (int k = 0; k < 100; ++k) {
    const PetscReal side = t->confined ? 1 : (low + high) / 2;
    stretch[0] = side;
    stretch[2] = kinematics_is_plane(t->kinematics) ? 1 : side;
    stress_of(t->poisson, stretch, sigma);
    *(sigma[0] < 0 ? &low : &high) = side;
  }
}

static void add_wall(WallSpec *wall, const char *name, int axis, PetscReal at, PetscReal normal)
{
  *wall = (WallSpec){.name = (char *)name, .shape = {.kind = SHAPE_HALF_SPACE}};
  wall->shape.point[axis] = at;
  wall->shape.normal[axis] = normal;
}

/* Surfaces and torques are those of the end of the step. */
static void check_surfaces(Model *m, const Press *t, PetscReal area, PetscReal height)
{
  const PetscReal round = t->kinematics->hoop ? 2 * PETSC_PI : 1, off = t->cell == CELL_TRIANGLE ? 0.05 : AREA;
  CHECK_CLOSE(model_wall(m, "floor", "contact", "area", 0), area, off * area);
  CHECK_CLOSE(model_wall(m, "plate", "contact", "area", 0), area, off * area);
  if (t->confined) CHECK_CLOSE(model_wall(m, "side", "contact", "area", 0), round * height, off * round * height);
  if (!t->confined || t->kinematics->hoop) return;
  const PetscReal torque = -model_wall(m, "side", "wall_force", NULL, 0) * height / 2;
  CHECK_CLOSE(model_wall(m, "side", "wall_torque", NULL, 2), torque, 1e-3 * torque);
}

/* Both walls bear stress times area, in axisymmetry of full circles, and what confines bears the rest. */
static void press(const Press *t)
{
  Bench b;
  WallSpec walls[3];
  MotionSpec down = {.kind = MOTION_DISPLACEMENT, .value = {0, -t->shorter, 0}};
  PetscReal stretch[3], sigma[3];
  const PetscBool is_mpm = !strcmp(t->method, "mpm"), is_3d = t->cell >= CELL_TETRAHEDRON;
  const PetscReal round = t->kinematics->hoop ? PETSC_PI : 1;
  bench_init(&b, t->method, t->cell, 0);
  b.c.kinematics = t->kinematics;
  b.c.formulation = (char *)t->formulation;
  b.c.mixed.stabilisation = 8;
  b.constants[1].value = t->poisson;
  b.c.newton.residual = 1e-8; /* as usual, and gaps with it */
  bench_grid(&b, (PetscReal[]){0, is_mpm ? -0.5 : 0, 0}, (PetscReal[]){is_mpm ? 1.5 : 1, is_mpm ? 1.5 : 1, 1}, 0.25);
  b.body[0].weights = WEIGHTS_GAUSS;
  if (!is_mpm) b.c.analysis.step = b.c.analysis.largest = 0.5;
  if (!t->kinematics->hoop) bench_motion(&b, 0, 0, MOTION_FIXED, 1);
  if (is_3d) bench_motion(&b, 2, 0, MOTION_FIXED, 4);
  add_wall(&walls[0], "floor", 1, 0, 1);
  add_wall(&walls[1], "plate", 1, 1, -1);
  add_wall(&walls[2], "side", 0, 1, -1);
  walls[1].n_motions = 1, walls[1].motions = &down;
  b.c.n_walls = t->confined ? 3 : 2;
  b.c.walls = walls;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  const PetscInt iterations = run_through(m);
  const PetscReal gaps = GAPS / t->shorter;
  stretches(t, stretch);
  stress_of(t->poisson, stretch, sigma);
  const PetscReal area = round * stretch[0] * (is_3d || t->kinematics->hoop ? stretch[2] : 1);
  const PetscReal around = t->confined ? (t->kinematics->hoop ? 2 * PETSC_PI : 1) * stretch[1] * sigma[0] : 0;
  const PetscReal floor = model_wall(m, "floor", "wall_force", NULL, 1),
                  plate = model_wall(m, "plate", "wall_force", NULL, 1),
                  side = t->confined ? model_wall(m, "side", "wall_force", NULL, 0) : 0;
  PetscPrintf(PETSC_COMM_WORLD, "%s %s %s cell %d nu %g: floor %.9g of %.9g N, side %.9g of %.9g, %d iterations\n",
              t->method, t->formulation, t->kinematics->name, (int)t->cell, (double)t->poisson, (double)floor,
              (double)(-sigma[1] * area), (double)side, (double)around, (int)iterations);
  CHECK_CLOSE(floor, -sigma[1] * area, gaps * -sigma[1] * area);
  CHECK_CLOSE(plate, -floor, 1e-9 * floor);
  CHECK_CLOSE(side, around, gaps * -around);
  CHECK(iterations <= 14, "%d iterations", (int)iterations);
  check_surfaces(m, t, area, stretch[1]);
  CALL(ModelDestroy(&m));
}

static void test_press(void **state)
{
  static const Press presses[] = {
    {"fem", "displacement", CELL_QUADRILATERAL, &kinematics_plane_strain, 0.3, 0.1, PETSC_FALSE},
    {"fem", "displacement", CELL_QUADRILATERAL, &kinematics_axisymmetric, 0.3, 0.1, PETSC_FALSE},
    {"fem", "displacement", CELL_TRIANGLE, &kinematics_axisymmetric, 0.3, 0.1, PETSC_FALSE},
    {"mpm", "displacement", CELL_QUADRILATERAL, &kinematics_axisymmetric, 0.3, 0.1, PETSC_FALSE},
    {"fem", "displacement", CELL_QUADRILATERAL, &kinematics_axisymmetric, 0.3, 0.1, PETSC_TRUE},
    {"mpm", "displacement", CELL_QUADRILATERAL, &kinematics_axisymmetric, 0.3, 0.1, PETSC_TRUE},
    {"fem", "mixed", CELL_QUADRILATERAL, &kinematics_plane_strain, 0.4999, 0.1, PETSC_FALSE},
    {"fem", "mixed", CELL_TRIANGLE, &kinematics_plane_strain, 0.4999, 0.1, PETSC_FALSE},
    {"mpm", "mixed", CELL_TRIANGLE, &kinematics_plane_strain, 0.4999, 0.1, PETSC_FALSE},
    {"mpm", "mixed", CELL_QUADRILATERAL, &kinematics_plane_strain, 0.4999, 0.1, PETSC_FALSE},
    {"fem", "mixed", CELL_QUADRILATERAL, &kinematics_axisymmetric, 0.4999, 0.1, PETSC_FALSE},
    {"mpm", "mixed", CELL_QUADRILATERAL, &kinematics_axisymmetric, 0.4999, 0.1, PETSC_FALSE},
    {"fem", "mixed", CELL_QUADRILATERAL, &kinematics_axisymmetric, 0.4, 0.1, PETSC_TRUE},
    {"fem", "mixed", CELL_QUADRILATERAL, &kinematics_axisymmetric, 0.49, 0.1, PETSC_TRUE},
    {"mpm", "mixed", CELL_QUADRILATERAL, &kinematics_plane_strain, 0.49, 0.1, PETSC_TRUE},
    {"fem", "mixed", CELL_QUADRILATERAL, &kinematics_plane_strain, 0.499, 0.05, PETSC_TRUE},
    {"fem", "mean-dilatation", CELL_QUADRILATERAL, &kinematics_plane_strain, 0.499, 0.05, PETSC_TRUE},
    {"fem", "mean-dilatation", CELL_QUADRILATERAL, &kinematics_axisymmetric, 0.4999, 0.1, PETSC_FALSE},
    {"fem", "mixed", CELL_HEXAHEDRON, &kinematics_3d, 0.4999, 0.1, PETSC_FALSE},
    {"mpm", "mixed", CELL_HEXAHEDRON, &kinematics_3d, 0.4999, 0.1, PETSC_FALSE},
    {"fem", "mixed", CELL_TETRAHEDRON, &kinematics_3d, 0.4999, 0.1, PETSC_FALSE},
  };
  (void)state;
  EACH_OF (k, presses) press(&presses[k]);
}

/* --- between walls on all sides --- */
typedef struct {
  const char *method;
  CellType cell;
  PetscInt counts[3]; /* cells of the unit square or cube */
  PetscReal grading;
} Boxed;

/* Cells of any shape stand on all walls: the plate's is the stress of confined compression. */
static void box(const Boxed *t)
{
  const char *const names[] = {"left", "right", "floor", "plate", "front", "back"};
  MotionSpec down = {.kind = MOTION_DISPLACEMENT};
  PetscReal stretch[3] = {1, 1, 1}, sigma[3];
  WallSpec walls[6];
  Bench b;
  bench_init(&b, t->method, t->cell, 0);
  const PetscInt dim = kinematics_dim(b.c.kinematics);
  const PetscBool is_mpm = !strcmp(t->method, "mpm");
  for (PetscInt d = 0; d < dim; ++d) b.c.grid.counts[d] = t->counts[d] * (is_mpm ? 2 : 1);
  for (PetscInt d = 0; d < dim; ++d) b.c.grid.min[d] = is_mpm ? -0.5 : 0, b.c.grid.max[d] = is_mpm ? 1.5 : 1;
  b.c.grid.grading[0] = t->grading;
  for (int k = 0; k < 2 * (int)dim; ++k) add_wall(&walls[k], names[k], k / 2, k % 2, k % 2 ? -1 : 1);
  down.value[1] = -0.01;
  walls[3].n_motions = 1, walls[3].motions = &down;
  b.c.n_walls = 2 * dim;
  b.c.walls = walls;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  run_through(m);
  stretch[1] = 0.99;
  stress_of(0.3, stretch, sigma);
  const PetscReal plate = model_wall(m, "plate", "wall_force", NULL, 1),
                  side = model_wall(m, "right", "wall_force", NULL, 0),
                  area = model_wall(m, "right", "contact", "area", 0);
  PetscPrintf(PETSC_COMM_WORLD, "%s cell %d between walls: plate %.9g of %.9g N, side %.9g of %.9g, area %.9g\n",
              t->method, (int)t->cell, (double)plate, (double)sigma[1], (double)side, (double)(0.99 * sigma[0]),
              (double)area);
  CHECK_CLOSE(plate, sigma[1], -2e-3 * sigma[1]);
  CHECK_CLOSE(side, 0.99 * sigma[0], -2e-3 * sigma[0]);
  CHECK_CLOSE(area, 0.99, AREA);
  CALL(ModelDestroy(&m));
}

static void test_boxed(void **state)
{
  static const Boxed cases[] = {
    {"fem", CELL_QUADRILATERAL, {4, 8}, 1},  {"fem", CELL_QUADRILATERAL, {4, 3}, 3},
    {"mpm", CELL_QUADRILATERAL, {4, 10}, 1}, {"fem", CELL_HEXAHEDRON, {4, 2, 3}, 2},
    {"mpm", CELL_HEXAHEDRON, {4, 2, 2}, 1},
  };
  (void)state;
  EACH_OF (k, cases) box(&cases[k]);
}

/* --- by their weight --- */
typedef struct {
  const char *method, *basis, *formulation;
  PetscReal friction;
} Cylinder;

/* Radius 0.5, height 0.5 m, on a wall. */
static Model *standing(Bench *b, const Cylinder *t, PetscBool dynamic, WallSpec *wall)
{
  bench_init(b, t->method, CELL_QUADRILATERAL, 0);
  b->c.kinematics = &kinematics_axisymmetric;
  b->c.formulation = (char *)t->formulation;
  b->c.mixed.stabilisation = 8;
  bench_grid(b, (PetscReal[]){0, 0.125, 0}, (PetscReal[]){1, 1.125, 1}, 0.125);
  bench_box(b, 0, (PetscReal[]){0, 0.25, 0}, (PetscReal[]){0.5, 0.75, 0});
  if (dynamic) bench_dynamic(b, 1, 4e-3);
  b->c.basis = (BasisSpec){
    .kind = t->basis, .gamma = 1.8, .effective_radius = 1, .radius = 2, .max_radius = 3.5, .condition = 50, .gap = 2};
  b->c.linear = LINEAR_AUTO;
  b->c.newton = (NewtonSpec){.residual = 1e-11, .increment = 1e-12, .max_iterations = 25, .ease = 6};
  b->c.stabilisation.curvature = 0.1;
  b->c.gravity[1] = -9.81;
  add_wall(wall, "floor", 1, 0.25, 1);
  wall->contact = t->friction > 0 ? CONTACT_FRICTION : CONTACT_FRICTIONLESS;
  wall->friction = t->friction;
  b->c.n_walls = 1;
  b->c.walls = wall;
  return bench_model(b, PETSC_COMM_WORLD);
}

static const Cylinder cylinders[] = {
  {"mpm", "cell", "displacement", 0},   {"mpm", "cell", "displacement", 0.3}, {"mpm", "gimp", "displacement", 0.3},
  {"fem", "cell", "displacement", 0.3}, {"gmm", "lme", "displacement", 0.3},  {"mpm", "cell", "mixed", 0.3},
  {"fem", "cell", "mixed", 0},
};

/* The floor bears the weight of the whole cylinder. */
static void test_stands(void **state)
{
  (void)state;
  EACH_OF (k, cylinders) {
    Bench b;
    WallSpec wall;
    const Cylinder *t = &cylinders[k];
    Model *m = standing(&b, t, PETSC_FALSE, &wall);
    const PetscReal weight = 9.81 * 1000 * PETSC_PI / 8;
    while (m->time < 1 - 1e-9) model_step(m, 0.5);
    const PetscReal force = model_wall(m, "floor", "wall_force", NULL, 1);
    PetscPrintf(PETSC_COMM_WORLD, "%s %s %s mu %g: %.12g N of %.12g, %d iterations\n", t->method, t->basis,
                t->formulation, (double)t->friction, (double)force, (double)weight, (int)m->total_iterations);
    CHECK_CLOSE(force, weight, 1e-8 * weight);
    CALL(ModelDestroy(&m));
  }
}

/* Gravity at once: it bounces by its stress. Impulses of the floor are the change of momentum. */
static void test_falls(void **state)
{
  (void)state;
  EACH_OF (k, cylinders) {
    Bench b;
    WallSpec wall;
    Energies e;
    const Cylinder *t = &cylinders[k];
    PetscReal given = 0, off = 0;
    Model *m = standing(&b, t, PETSC_TRUE, &wall);
    const PetscReal mass = 1000 * PETSC_PI / 8;
    for (PetscInt i = 0; i < 30; ++i) {
      const PetscReal before = m->time;
      model_step(m, i % 3 == 1 ? 2e-3 : 4e-3);
      given += (m->time - before) * model_wall(m, "floor", "wall_force", NULL, 1);
      off = PetscMax(off, PetscAbsReal(given - 9.81 * mass * m->time - model_sum(m, "momentum", 1)));
    }
    CALL(ModelEnergies(m, &e));
    PetscPrintf(PETSC_COMM_WORLD, "%s %s %s mu %g: impulse off %.2g of %.4g, transfer %.3g of %.4g J\n", t->method,
                t->basis, t->formulation, (double)t->friction, (double)off, (double)given, (double)e.transfer,
                (double)e.elastic);
    CHECK(off <= 1e-8 * given && given > 300, "impulse off by %g of %g", (double)off, (double)given);
    CHECK(e.friction >= 0 && (e.friction > 0) == (t->friction > 0), "friction took %g J", (double)e.friction);
    CHECK(model_wall(m, "floor", "contact", "penetration", 0) <= 1e-4 * 0.125, "it is deep in the wall");
    CALL(ModelDestroy(&m));
  }
}

/* --- tangent --- */
/* What a node gets must not depend on the rank. */
static PetscReal noise(const Model *m, PetscInt i, PetscInt seed)
{
  Random random = {(uint64_t)(m->grid->global_node[i / m->dim] * 64 + (i % m->dim) * 8 + seed)};
  for (int k = 0; k < 3; ++k) (void)random_bits(&random);
  return random_real(&random, -1, 1);
}

/* Forces of the wall where the block has come down on it by half a cell and is a little shaken, and on by h. */
static void forces_at(Model *m, StepProblem *p, PetscReal h, System *system, Vec out)
{
  for (PetscInt i = 0; i < m->grid->n_nodes * m->dim; ++i)
    m->nodes->du[i] = (i % m->dim == 1 ? -0.125 : 0.05) + 0.02 * noise(m, i, 1) + h * noise(m, i, 2);
  CALL(PetscArrayzero(m->nodes->force, m->grid->n_nodes * m->dim));
  const NodalOutput o = {.force = m->nodes->force, .system = system};
  CALL(NodalForcesAssemble(&m->forces, &p->scene, &o));
  CALL(GridSumToOwners(m->grid, m->dim, m->nodes->force));
  CALL(VecSet(out, 0));
  CALL(SystemFromNodes(m->system, m->nodes->force, 0, m->dim, out));
}

/* Of a rough ball, or a rough slope. */
static void check_tangent(const Kinematics *kinematics, const char *formulation, CellType cell, PetscBool round)
{
  Bench b;
  WallSpec wall = {.name = (char *)"wall", .contact = CONTACT_FRICTION, .friction = 0.3};
  StepProblem p;
  Vec x, y, plus, minus;
  PetscReal off, size;
  const PetscReal h = 1e-7;
  bench_init(&b, "fem", cell, 4);
  b.c.kinematics = kinematics;
  b.c.formulation = (char *)formulation;
  b.c.mixed.stabilisation = 8;
  if (round) wall.shape = (Shape){.kind = SHAPE_BALL, .centre = {0, -2, 0}, .radius = 2};
  else wall.shape = (Shape){.kind = SHAPE_HALF_SPACE, .normal = {0.1, 1, 0}};
  b.c.n_walls = 1;
  b.c.walls = &wall;
  bench_motion(&b, 1, 1, MOTION_FIXED, 7);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  CALL(ModelActivate(m));
  mark_fixed(m);
  CALL(PetscArrayzero(m->nodes->fixed, m->grid->n_nodes * m->dim));
  CALL(PrepareStep(m, 1, &p));
  CALL(SystemCreateVec(m->system, &x));
  CALL(VecDuplicate(x, &y));
  CALL(VecDuplicate(x, &plus));
  CALL(VecDuplicate(x, &minus));
  CALL(SystemZero(m->system));
  forces_at(m, &p, 0, m->system, y);
  CALL(SystemPrescribe(m->system, m->nodes->fixed, m->nodes->idle));
  CALL(SystemToMatrix(m->system));
  for (PetscInt i = 0; i < m->grid->n_nodes * m->dim; ++i) m->nodes->force[i] = noise(m, i, 2);
  CALL(VecSet(x, 0));
  CALL(SystemFromNodes(m->system, m->nodes->force, 0, m->dim, x));
  CALL(MatMult(m->system->matrix, x, y));
  forces_at(m, &p, h, NULL, plus);
  forces_at(m, &p, -h, NULL, minus);
  CALL(VecAXPY(plus, -1, minus));
  CALL(VecAXPY(y, -0.5 / h, plus));
  CALL(VecNorm(y, NORM_2, &off));
  CALL(VecNorm(plus, NORM_2, &size));
  CHECK(size > 0 && off <= 1e-6 * size * 0.5 / h, "off by %g of %g", (double)off, (double)(size * 0.5 / h));
  CALL(VecDestroy(&x));
  CALL(VecDestroy(&y));
  CALL(VecDestroy(&plus));
  CALL(VecDestroy(&minus));
  CALL(ModelDestroy(&m));
}

static void test_tangent(void **state)
{
  (void)state;
  for (int round = 0; round < 2; ++round) {
    check_tangent(&kinematics_axisymmetric, "displacement", CELL_QUADRILATERAL, (PetscBool)round);
    check_tangent(&kinematics_axisymmetric, "mixed", CELL_QUADRILATERAL, (PetscBool)round);
    check_tangent(&kinematics_plane_strain, "mixed", CELL_TRIANGLE, (PetscBool)round);
    check_tangent(&kinematics_3d, "mixed", CELL_HEXAHEDRON, (PetscBool)round);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_press), cmocka_unit_test(test_boxed),   cmocka_unit_test(test_stands),
    cmocka_unit_test(test_falls), cmocka_unit_test(test_tangent),
  };
  return run_model_group(argc, argv, tests, PETSC_STATIC_ARRAY_LENGTH(tests));
}
