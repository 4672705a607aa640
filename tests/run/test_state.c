/* A model put away in a file and brought back takes the same steps: bit by bit on the same ranks,
 * to round-off on one. */
#include "../model/case_builder.h"
#include "output/checkpoint/checkpoint.h"
#include "model/state/state.h"

static char path[PETSC_MAX_PATH_LEN];

static void put_away(Model *m)
{
  Tables *tables;
  char reason[256];
  CALL(TablesCreate(&tables));
  CALL(ModelToTables(m, tables));
  CALL(CheckpointWrite(m->comm, path, tables, reason));
  CALL(TablesDestroy(&tables));
}

static Model *bring_back(Bench *b, MPI_Comm comm)
{
  Model *m = bench_model(b, comm);
  Tables *tables;
  char reason[256];
  CALL(CheckpointRead(comm, path, &tables, reason));
  CALL(ModelFromTables(m, tables, reason));
  CHECK(!reason[0], "%s", reason);
  CALL(TablesDestroy(&tables));
  return m;
}

static void same_bits(const Points *p, const Points *q, const char *what)
{
  CHECK(p->n == q->n, "%s: %d and %d points", what, (int)p->n, (int)q->n);
  for (int f = 0; f < POINT_N_REAL; ++f)
    CHECK(!p->n || !p->components[f] ||
            !memcmp(p->real[f], q->real[f], sizeof(PetscReal) * (size_t)(p->n * p->components[f])),
          "%s: field %d differs", what, f);
  for (PetscInt i = 0; i < p->n; ++i)
    CHECK(
      p->id[i] == q->id[i] && p->cell[i] == q->cell[i] && p->body[i] == q->body[i] && p->material[i] == q->material[i],
      "%s: point %d is another one", what, (int)i);
}

static void same_models(Model *m, Model *n)
{
  const size_t dofs = (size_t)(m->grid->n_owned * m->dim) * sizeof(PetscReal);
  CALL(ModelInitialise(m));
  CALL(ModelInitialise(n));
  same_bits(m->points, n->points, "points");
  same_bits(m->tracers, n->tracers, "tracers");
  same_bits(m->loads->carriers, n->loads->carriers, "carriers");
  CHECK(!memcmp(m->grid->x, n->grid->x, dofs), "nodes have moved");
  CHECK(!memcmp(m->nodes->v, n->nodes->v, dofs) && !memcmp(m->nodes->a, n->nodes->a, dofs), "nodal motion differs");
  CHECK(!memcmp(m->nodes->reaction, n->nodes->reaction, dofs) && !memcmp(m->nodes->held, n->nodes->held, dofs),
        "reactions differ");
  CHECK(m->time == n->time && m->control.next == n->control.next && m->step == n->step && m->cuts == n->cuts,
        "time or step differ");
  CHECK(m->external_work == n->external_work && m->transfer_energy == n->transfer_energy &&
          m->boundary_work == n->boundary_work && m->damped_energy == n->damped_energy &&
          m->friction_energy == n->friction_energy && m->start_energy == n->start_energy,
        "energies differ");
  for (PetscInt k = 0; k < m->c->n_walls; ++k)
    CHECK(!memcmp(m->contact->wall + k, n->contact->wall + k, sizeof(WallState)), "wall %d differs", (int)k);
  CHECK(m->most_energy == n->most_energy && !memcmp(&m->outside, &n->outside, sizeof m->outside), "losses differ");
  CHECK(m->total_iterations == n->total_iterations, "other iterations");
  CHECK(m->balance.repartitions == n->balance.repartitions && m->balance.reached == n->balance.reached,
        "the grid was shared in another way");
}

static PetscBool on_one_rank(void)
{
  PetscMPIInt size;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  return size == 1;
}

/* How near a model on one rank comes. Multipliers of walls are renewed until gaps are below 1e-5 of a cell,
 * on other ranks perhaps once more: increments differ by so much, velocities by that over the step. */
static PetscReal nearness(const Bench *b, PointReal f)
{
  const PetscReal gap = 1e-5 * 0.125, dt = b->c.analysis.step;
  if (!b->c.n_walls)
    return f == POINT_A ? 1e-10 / dt : 1e-9; /* accelerations: what velocities differ by, over a step */
  return f == POINT_V ? 2 * gap / dt : f == POINT_A ? 4 * gap / (dt * dt) : 10 * gap;
}

/* bits: does the solver promise the same bits on several ranks? Returns the model that was brought
 * back, after its steps. */
static Model *check(Bench *b, PetscInt before, PetscInt after, PetscBool bits)
{
  Model *whole = bench_model(b, PETSC_COMM_WORLD);
  for (PetscInt k = 0; k < before; ++k) model_step(whole, PETSC_MAX_REAL);
  CHECK((whole->damped_energy != 0) == (b->c.analysis.damping > 0), "%g J damped", (double)whole->damped_energy);
  put_away(whole);
  Model *again = bring_back(b, PETSC_COMM_WORLD), *alone = bring_back(b, PETSC_COMM_SELF);
  same_models(whole, again);
  for (PetscInt k = 0; k < after; ++k) {
    model_step(whole, PETSC_MAX_REAL);
    CALL(ModelInitialise(whole)); /* to ask for nodal fields between steps changes nothing */
    model_step(again, PETSC_MAX_REAL);
    model_step(alone, PETSC_MAX_REAL);
  }
  if (bits) same_models(whole, again);
  for (int f = 0; f < POINT_TAU; ++f) {
    const PetscReal off = points_difference(whole, alone, (PointReal)f);
    CHECK(off <= nearness(b, (PointReal)f), "alone, field %d is off by %g", f, (double)off);
  }
  CALL(ModelDestroy(&whole));
  CALL(ModelDestroy(&alone));
  return again;
}

static void check_only(Bench *b, PetscInt before, PetscInt after, PetscBool bits)
{
  Model *m = check(b, before, after, bits);
  CALL(ModelDestroy(&m));
}

/* A body that falls, turns and crosses from rank to rank, with a load that it carries and a
 * tracer. */
static void flying(const char *method, CellType cell, PetscReal size, PetscBool mesh)
{
  static const PetscReal plane[] = {0, 0.5, 1, 1.5, 2, 3};
  Bench b;
  bench_init(&b, method, cell, 0);
  if (strcmp(method, "fem")) {
    bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){3, 2, 2}, size);
    bench_box(&b, 0, (PetscReal[]){0.5, 0.5, 0.5}, (PetscReal[]){1.5, 1, 1});
  } else {
    bench_grid(&b, (PetscReal[]){0.5, 0.5, 0.5}, (PetscReal[]){1.5, 1, 1}, size);
    bench_box(&b, 0, (PetscReal[]){0.5, 0.5, 0.5}, (PetscReal[]){1.5, 1, 1});
  }
  bench_dynamic(&b, 1, 2e-3);
  b.c.linear = LINEAR_ITERATIVE;
  b.body[0].velocity[0] = 5;
  b.body[0].spin[2] = 3;
  b.c.gravity[1] = -9.81;
  b.c.analysis.damping = 0.7;
  bench_traction(&b, 0, 1.5, strcmp(method, "fem") ? "body" : NULL, 1e3, 2e3, 0);
  bench_tracer(&b, "displacement", 1, 1.4, 0.9, 0.9);
  if (!strcmp(method, "fem")) bench_motion(&b, 0, 0.5, MOTION_FIXED, 7);
  if (mesh) bench_distort(&b, 0.1, 6, plane);
  check_only(&b, 7, 6, PETSC_TRUE);
  bench_end(&b);
}

static void test_mpm_2d(void **state)
{
  (void)state;
  flying("mpm", CELL_QUADRILATERAL, 0.125, PETSC_FALSE);
  flying("mpm", CELL_TRIANGLE, 0.25, PETSC_FALSE);
}

static void test_mpm_3d(void **state)
{
  (void)state;
  flying("mpm", CELL_HEXAHEDRON, 0.25, PETSC_FALSE);
}

/* A block that leaves the part of its rank: the grid is shared anew before the checkpoint and after
 * it. */
static void leaving(PetscBool mesh)
{
  static const PetscReal plane[] = {0, 0.5, 1, 1.5, 4};
  Bench b;
  PetscMPIInt size;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 0);
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){4, 1, 1}, 0.125);
  bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){1.5, 0.5, 1});
  bench_dynamic(&b, 1, 0.01);
  bench_motion(&b, 1, 0, MOTION_FIXED, 2);
  bench_traction(&b, 0, 1.5, "body", -1e3, 2e3, 0);
  bench_tracer(&b, "displacement", 1, 1.4, 0.4, 0);
  b.c.linear = LINEAR_ITERATIVE;
  b.body[0].velocity[0] = 10;
  b.c.parallel.imbalance = 1.2;
  if (mesh) bench_distort(&b, 0.15, 5, plane);
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  Model *m = check(&b, 9, 8, PETSC_TRUE);
  CHECK(size == 1 || m->balance.repartitions > 2, "shared anew only %d times", (int)m->balance.repartitions);
  CALL(ModelDestroy(&m));
  bench_end(&b);
}

static void test_repartition(void **state)
{
  (void)state;
  leaving(PETSC_FALSE);
  leaving(PETSC_TRUE);
}

static void test_fem(void **state)
{
  (void)state;
  flying("fem", CELL_QUADRILATERAL, 0.125, PETSC_FALSE);
  flying("fem", CELL_HEXAHEDRON, 0.25, PETSC_FALSE);
}

/* Sand that flies apart and remembers by how much: what is open goes on closing. */
static void test_opening(void **state)
{
  static NamedValue sand[] = {{"young", 1e6},         {"poisson", 0.3}, {"friction_angle", 31},
                              {"dilatancy_angle", 0}, {"cohesion", 0},  {"opening_memory", 1}};
  Bench b;
  PetscReal open = 0;
  (void)state;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 0);
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){2, 1.5, 1}, 0.125);
  bench_box(&b, 0, (PetscReal[]){0.5, 0.25, 0}, (PetscReal[]){1.5, 0.75, 1});
  b.material =
    (MaterialSpec){.name = "rubber", .law = "mohr-coulomb", .density = 1500, .n_parameters = 6, .parameters = sand};
  bench_dynamic(&b, 1, 2e-3);
  bench_motion(&b, 1, 0, MOTION_FIXED, 3);
  b.c.linear = LINEAR_ITERATIVE;
  b.c.newton.residual = 1e-9;
  b.body[0].spin[2] = 6;
  b.body[0].velocity[1] = -4;
  b.c.gravity[1] = -9.81;
  Model *m = check(&b, 40, 6, PETSC_TRUE);
  for (PetscInt p = 0; p < m->points->n; ++p) open = PetscMax(open, point_real(m->points, POINT_STATE, p)[7]);
  CHECK(model_max(m, open) > 0.01, "nothing is open");
  CALL(ModelDestroy(&m));
}

/* --- given up --- */
static int assemblies; /* until somebody asks */

static PetscBool somebody_asks(void)
{
  PetscMPIInt rank, size;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  return --assemblies < 0 && rank == size - 1;
}

/* A step that is given up between two iterations leaves the model as it was, and the run that goes
 * on from there is the one that was not interrupted. */
static void given_up(Bench *b, int steps)
{
  StepReport report;
  Model *whole = bench_model(b, PETSC_COMM_WORLD), *cut = bench_model(b, PETSC_COMM_WORLD);
  for (int k = 0; k < steps; ++k) {
    model_step(whole, PETSC_MAX_REAL);
    model_step(cut, PETSC_MAX_REAL);
  }
  assemblies = 1;
  cut->asked = somebody_asks;
  CALL(ModelStep(cut, PETSC_MAX_REAL, &report));
  CHECK(report.outcome == STEP_INTERRUPTED, "the step goes on, %d", (int)report.outcome);
  same_models(whole, cut);
  put_away(cut);
  Model *again = bring_back(b, PETSC_COMM_WORLD);
  for (int k = 0; k < 3; ++k) {
    model_step(whole, PETSC_MAX_REAL);
    CALL(ModelInitialise(whole)); /* to ask for nodal fields between steps changes nothing */
    model_step(again, PETSC_MAX_REAL);
  }
  same_models(whole, again);
  CALL(ModelDestroy(&whole));
  CALL(ModelDestroy(&cut));
  CALL(ModelDestroy(&again));
}

/* A block, or a ring with pressures as unknowns, thrown on a wall that rubs: what acts at each point goes
 * on, and what the wall has given. */
static void test_walls(void **state)
{
  static const char *const names[] = {"mpm", "fem", "gmm", "mpm"};
  (void)state;
  for (int k = 0; k < 4; ++k) {
    Bench b;
    WallSpec wall = {.name = (char *)"floor", .contact = CONTACT_FRICTION, .friction = 0.3};
    wall.shape = (Shape){.kind = SHAPE_HALF_SPACE, .point = {0, 0.2, 0}, .normal = {0.1, 1, 0}};
    bench_init(&b, names[k], CELL_QUADRILATERAL, 0);
    bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){2, 1.5, 1}, 0.125);
    bench_box(&b, 0, (PetscReal[]){0.25, 0.25, 0.25}, (PetscReal[]){0.75, 0.75, 0.75});
    if (k == 2)
      b.c.basis = (BasisSpec){.kind = "lme", .gamma = 1.8, .radius = 2, .max_radius = 3.5, .condition = 50, .gap = 2};
    if (k == 3) {
      b.c.kinematics = &kinematics_axisymmetric;
      b.c.formulation = (char *)"mixed";
      b.c.mixed.stabilisation = 8;
    }
    bench_dynamic(&b, 1, 4e-3);
    b.c.linear = k < 3 ? LINEAR_ITERATIVE : LINEAR_DIRECT;
    b.body[0].velocity[0] = 1.5;
    b.body[0].velocity[1] = -4;
    b.c.gravity[1] = -9.81;
    b.c.n_walls = 1;
    b.c.walls = &wall;
    const PetscBool bits = k < 3 || on_one_rank();
    Model *m = check(&b, 7, 5, bits);
    CHECK(m->friction_energy > 1, "it did not rub on the wall: %g J", (double)m->friction_energy);
    CALL(ModelDestroy(&m));
    if (bits) given_up(&b, 7);
  }
}

/* A mesh is shared in another way each time that a process reads it. */
static void test_mesh(void **state)
{
  (void)state;
  flying("mpm", CELL_TRIANGLE, 0.25, PETSC_TRUE);
  flying("fem", CELL_QUADRILATERAL, 0.125, PETSC_TRUE);
}

/* A block with a spin, thrown on a floor: ghosts, the pattern and constraints come and go; with a
 * tracer and a carried load. */
static void thrown(const char *kind, LinearChoice linear, CellType cell, PetscReal size)
{
  Bench b;
  bench_init(&b, "gmm", cell, 0);
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){2, 1.5, 1}, size);
  bench_box(&b, 0, (PetscReal[]){0.25, 0.25, 0.25}, (PetscReal[]){0.75, 0.75, 0.75});
  b.c.basis = (BasisSpec){.kind = kind,
                          .gamma = strcmp(kind, "lme") ? 0 : 1.8,
                          .effective_radius = strcmp(kind, "lme") ? 1 : 0,
                          .radius = 2,
                          .max_radius = 3.5,
                          .condition = 50,
                          .gap = 2};
  bench_dynamic(&b, 1, 4e-3);
  b.c.linear = linear;
  b.body[0].velocity[0] = 1.5;
  b.body[0].velocity[1] = -4;
  b.body[0].spin[2] = 2;
  b.c.gravity[1] = -9.81;
  bench_motion(&b, 1, 0, MOTION_FIXED, 7);
  bench_traction(&b, 0, 0.75, "body", 100, 0, 0);
  bench_tracer(&b, "position", 0, 0.5, 0.5, 0.5);
  for (PetscInt before = 1; before <= 13; before += 6)
    check_only(&b, before, 6, linear == LINEAR_ITERATIVE || on_one_rank());
}

static void test_gmm(void **state)
{
  (void)state;
  thrown("lme", LINEAR_ITERATIVE, CELL_QUADRILATERAL, 0.125);
  thrown("lme", LINEAR_DIRECT, CELL_TRIANGLE, 0.125);
  thrown("mls", LINEAR_AUTO, CELL_QUADRILATERAL, 0.125);
  thrown("lme", LINEAR_ITERATIVE, CELL_HEXAHEDRON, 0.25);
}

/* Sand that flies apart, of which places know how much: what they told its points is taken back, too. */
static void sand_given_up(void)
{
  NamedValue sand[] = {{(char *)"young", 1e6},
                       {(char *)"poisson", 0.25},
                       {(char *)"friction_angle", 30},
                       {(char *)"cohesion", 0},
                       {(char *)"opening_memory", 1}};
  Bench b;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 8);
  b.material.law = (char *)"mohr-coulomb";
  b.material.n_parameters = 5;
  b.material.parameters = sand;
  bench_box(&b, 0, (PetscReal[]){0.25, 0, 0.25}, (PetscReal[]){0.75, 0.5, 0.75});
  b.body[0].spin[2] = 5;
  b.c.stabilisation.room = PETSC_TRUE;
  b.c.gravity[1] = -100;
  b.c.linear = LINEAR_ITERATIVE;
  b.c.newton.residual = 1e-12;
  bench_motion(&b, 1, 0, MOTION_FIXED, 3);
  bench_dynamic(&b, 1, 1e-2);
  given_up(&b, 3);
}

static void test_given_up(void **state)
{
  static const char *const methods_[] = {"mpm", "fem", "gmm"};
  (void)state;
  /* the last: constraints, which take a direct solver */
  for (int k = 0; k < (on_one_rank() ? 4 : 3); ++k) {
    Bench b;
    bench_init(&b, methods_[PetscMin(k, 2)], CELL_QUADRILATERAL, 8);
    if (k == 3)
      b.c.basis =
        (BasisSpec){.kind = "mls", .effective_radius = 1, .radius = 2, .max_radius = 3.5, .condition = 50, .gap = 2};
    if (k == 2)
      b.c.basis = (BasisSpec){.kind = "lme", .gamma = 1.8, .radius = 2, .max_radius = 3.5, .condition = 50, .gap = 2};
    bench_motion(&b, 1, 0, MOTION_FIXED, 3);
    b.c.gravity[1] = -100;
    bench_dynamic(&b, 1, 1e-2);
    b.c.linear = k == 3 ? LINEAR_AUTO : LINEAR_ITERATIVE;
    b.c.newton.residual = 1e-12;
    given_up(&b, 3);
  }
  sand_given_up();
}

/* Domains of points travel, and the ranks' parts have a halo. */
static void travels(const char *basis)
{
  Bench b;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 0);
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){2, 1.5, 1}, 0.125);
  bench_box(&b, 0, (PetscReal[]){0.25, 0.25, 0.25}, (PetscReal[]){0.75, 0.75, 0.75});
  b.c.basis.kind = basis;
  bench_dynamic(&b, 1, 4e-3);
  b.c.linear = LINEAR_ITERATIVE;
  b.body[0].velocity[0] = 1.5;
  b.body[0].velocity[1] = -4;
  b.body[0].spin[2] = 2;
  b.c.gravity[1] = -9.81;
  bench_motion(&b, 1, 0, MOTION_FIXED, 7);
  bench_traction(&b, 0, 0.75, "body", 100, 0, 0);
  bench_tracer(&b, "position", 0, 0.5, 0.5, 0.5);
  for (PetscInt before = 1; before <= 13; before += 6) check_only(&b, before, 6, PETSC_TRUE);
}

static void test_gimp(void **state)
{
  (void)state;
  travels("gimp");
  travels("bspline");
}

/* Statics in steps with factorisations, whose bits depend on the arrival of messages where there
 * are several ranks. */
static void test_static(void **state)
{
  Bench b;
  (void)state;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 0);
  bench_grid(&b, (PetscReal[]){0, -1, 0}, (PetscReal[]){4.5, 1.5, 1}, 0.25);
  bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){4, 1, 1});
  bench_motion(&b, 0, 0, MOTION_FIXED, 3);
  b.c.gravity[1] = -1;
  b.c.analysis.step = b.c.analysis.largest = 0.2;
  b.c.analysis.smallest = 0.01;
  check_only(&b, 2, 2, on_one_rank());
  bench_motion(&b, 0, 4, MOTION_DISPLACEMENT, 1)->value[0] = 0.1;
  b.c.method = (char *)"fem";
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){4, 1, 1}, 0.25);
  check_only(&b, 2, 2, on_one_rank());
}

/* After the first step, which starts from accelerations of its own. */
static void test_at_start(void **state)
{
  Bench b;
  (void)state;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 4);
  bench_motion(&b, 1, 0, MOTION_FIXED, 3);
  b.c.gravity[1] = -1;
  bench_dynamic(&b, 1, 1e-2);
  b.c.linear = LINEAR_ITERATIVE;
  check_only(&b, 1, 3, PETSC_TRUE);
}

/* Tables of another model are refused, on all ranks and without harm. */
static void test_other_model(void **state)
{
  Bench b;
  Tables *tables;
  char reason[256];
  (void)state;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 8);
  bench_motion(&b, 1, 0, MOTION_FIXED, 7); /* statics wants it held */
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  put_away(m);
  CALL(ModelDestroy(&m));
  for (int k = 0; k < 3; ++k) {
    bench_init(&b, k == 1 ? "fem" : "mpm", CELL_QUADRILATERAL, k == 0 ? 4 : 8);
    bench_motion(&b, 1, 0, MOTION_FIXED, 7);
    if (k == 2) bench_tracer(&b, "displacement", 1, 0.4, 0.9, 0.9);
    m = bench_model(&b, PETSC_COMM_WORLD);
    CALL(CheckpointRead(PETSC_COMM_WORLD, path, &tables, reason));
    CALL(ModelFromTables(m, tables, reason));
    CHECK(strstr(reason, k == 0   ? "the grid of the case is not the one of the run"
                         : k == 1 ? "nodes is missing"
                                  : "the measures of the case are not those of the run"),
          "%d: %s", k, reason);
    CALL(TablesDestroy(&tables));
    CALL(ModelDestroy(&m));
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_mpm_2d),  cmocka_unit_test(test_mpm_3d),   cmocka_unit_test(test_repartition),
    cmocka_unit_test(test_fem),     cmocka_unit_test(test_opening),  cmocka_unit_test(test_walls),
    cmocka_unit_test(test_mesh),    cmocka_unit_test(test_gimp),     cmocka_unit_test(test_gmm),
    cmocka_unit_test(test_static),  cmocka_unit_test(test_at_start), cmocka_unit_test(test_other_model),
    cmocka_unit_test(test_given_up)};
  PetscMPIInt rank;
  int pid;
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  pid = (int)getpid();
  MPI_Bcast(&pid, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  snprintf(path, sizeof path, "%s/talus-state-%d.h5", getenv("TMPDIR") ? getenv("TMPDIR") : "/tmp", pid);
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  if (!rank) unlink(path);
  return PetscFinalize() || failed;
}
