/* Times the step a reaction is the impulse of the boundary: also where contact hits within a cell of nodes that are
 * held, and of places that move and let nodes go. */
#include "resumed.h"

typedef struct {
  const char *method, *basis, *scheme;
  PetscBool lumped;
} Kind;

static void settings(Bench *b, const Kind *r, PetscReal step)
{
  bench_dynamic(b, 0.1, step);
  b->c.analysis.scheme = (char *)r->scheme;
  if (r->scheme && !strcmp(r->scheme, "explicit")) {
    b->c.analysis.scheme = NULL;
    b->c.analysis.type = ANALYSIS_EXPLICIT, b->c.analysis.courant = 0.7;
  }
  if (r->scheme && !strcmp(r->scheme, "bossak")) {
    b->c.analysis.bossak = -0.2;
    b->c.analysis.beta = 1.2 * 1.2 / 4;
    b->c.analysis.gamma = 0.7;
  }
  if (r->lumped) b->c.analysis.mass = MASS_LUMPED;
  b->c.basis = (BasisSpec){
    .kind = r->basis, .gamma = 1.8, .effective_radius = 1, .radius = 2, .max_radius = 3.5, .condition = 50, .gap = 2};
  b->c.linear = LINEAR_AUTO;
  b->c.newton = (NewtonSpec){.residual = 1e-11, .increment = 1e-12, .max_iterations = 25, .ease = 6};
}

static PetscReal reaction(Model *m, PetscInt entry)
{
  const MeasureSpec measure = {.kind = "reaction", .component = 1, .boundary = entry};
  PetscReal value;
  CALL(ModelMeasure(m, &measure, 0, &value));
  return value;
}

/* A plate that comes down with 1 m/s meets a layer one cell thick, on a floor that rises where the mesh moves. */
static void test_contact(void **state)
{
  static const Kind kinds[] = {
    {"fem", "cell", NULL, PETSC_FALSE},       {"mpm", "gimp", NULL, PETSC_FALSE},
    {"fem", "cell", "bossak", PETSC_FALSE},   {"mpm", "gimp", "bossak", PETSC_FALSE},
    {"mpm", "cell", NULL, PETSC_FALSE},       {"gmm", "lme", NULL, PETSC_FALSE},
    {"mpm", "gimp", "midpoint", PETSC_FALSE}, {"fem", "cell", NULL, PETSC_TRUE},
  };
  (void)state;
  EACH_OF (k, kinds) {
    const PetscBool grid = !strcmp(kinds[k].method, "mpm");
    MotionSpec falls = {.kind = MOTION_VELOCITY, .component = {0, 1}, .value = {0, -1}};
    WallSpec wall = {.name = (char *)"plate", .shape = {.kind = SHAPE_HALF_SPACE}, .n_motions = 1, .motions = &falls};
    PetscReal given = 0, off = 0;
    Energies e;
    Bench b;
    bench_init(&b, kinds[k].method, CELL_QUADRILATERAL, 0);
    bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, grid ? 1.25 : 0.25, 0}, 0.25);
    bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 0.25, 0});
    settings(&b, kinds + k, 2e-3);
    bench_motion(&b, 1, 0, grid ? MOTION_FIXED : MOTION_VELOCITY, 2)->value[1] = grid ? 0 : 0.05;
    bench_motion(&b, 0, 0, MOTION_FIXED, 1);
    bench_motion(&b, 0, 1, MOTION_FIXED, 1);
    b.body[0].velocity[1] = b.motion[0].value[1];
    wall.shape.point[1] = 0.252, wall.shape.normal[1] = -1;
    b.c.n_walls = 1;
    b.c.walls = &wall;
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    const PetscReal start = model_sum(m, "momentum", 1);
    while (m->time < 0.03) {
      const PetscReal before = m->time;
      model_step(m, 2e-3);
      const PetscReal force = reaction(m, 0) + model_wall(m, "plate", "wall_force", NULL, 1);
      given += (m->time - before) * force;
      off = PetscMax(off, PetscAbsReal(given - model_sum(m, "momentum", 1) + start));
    }
    CALL(ModelEnergies(m, &e));
    PetscPrintf(PETSC_COMM_WORLD, "%s %s %s: impulse off %.2g kg m/s\n", kinds[k].method, kinds[k].basis,
                kinds[k].scheme ? kinds[k].scheme : "", (double)off);
    CHECK(off <= 1e-5, "impulse off by %g kg m/s", (double)off);
    CHECK(model_wall(m, "plate", "wall_force", NULL, 1) < -1e4, "the plate has not met the layer");
    CHECK(PetscAbsReal(model_sum(m, "energy: balance", 0)) < 1e-6, "the balance is open: %g",
          (double)model_sum(m, "energy: balance", 0));
    CALL(ModelDestroy(&m));
  }
}

static const Kind moving[] = {
  {"mpm", "gimp", NULL, PETSC_FALSE},       {"mpm", "cell", NULL, PETSC_FALSE},
  {"mpm", "gimp", "bossak", PETSC_FALSE},   {"mpm", "cell", "explicit", PETSC_FALSE},
  {"mpm", "gimp", "midpoint", PETSC_FALSE}, {"mpm", "gimp", "explicit", PETSC_FALSE},
};

/* The floor of a block is a place that goes down, or turns away. */
static Model *moves(Bench *b, const Kind *r, PetscBool turns)
{
  bench_init(b, r->method, CELL_QUADRILATERAL, 0);
  bench_grid(b, (PetscReal[]){-1, -1, 0}, (PetscReal[]){2, 2, 0}, 0.125);
  bench_box(b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 1, 0});
  settings(b, r, 1e-3);
  MotionSpec *floor = bench_motion(b, 1, 0, turns ? MOTION_ROTATION : MOTION_VELOCITY, turns ? 3 : 2);
  floor->on.min[1] = -1, floor->on.max[1] = 0.13;
  floor->moves = PETSC_TRUE;
  floor->value[1] = -1;
  floor->rate = -1;
  floor->centre[0] = -0.5;
  return bench_model(b, PETSC_COMM_WORLD);
}

static void test_moves(void **state)
{
  (void)state;
  EACH_OF (k, moving) {
    Bench b;
    PetscReal given = 0, off = 0;
    Model *m = moves(&b, moving + k, k % 2);
    while (m->time < 0.03) {
      const PetscReal before = m->time;
      model_step(m, 1e-3);
      given += (m->time - before) * reaction(m, 0);
      off = PetscMax(off, PetscAbsReal(given - model_sum(m, "momentum", 1)));
    }
    PetscPrintf(PETSC_COMM_WORLD, "%s %s: impulse off %.2g of %g kg m/s\n", moving[k].basis,
                moving[k].scheme ? moving[k].scheme : "", (double)off, (double)given);
    CHECK(off <= 1e-5, "impulse off by %g kg m/s", (double)off);
    CHECK(given < -100, "nothing moves");
    CALL(ModelDestroy(&m));
  }
}

/* The work of a floor that moves is its reaction times its motion, whatever points bring to its nodes. */
static void test_works(void **state)
{
  static const Kind kinds[] = {{"mpm", "gimp", NULL, PETSC_FALSE},       {"mpm", "cell", NULL, PETSC_FALSE},
                               {"gmm", "lme", NULL, PETSC_FALSE},        {"fem", "cell", NULL, PETSC_FALSE},
                               {"mpm", "gimp", "midpoint", PETSC_FALSE}, {"mpm", "cell", "explicit", PETSC_FALSE}};
  (void)state;
  EACH_OF (k, kinds) {
    const PetscBool grid = !strcmp(kinds[k].method, "mpm");
    PetscReal work = 0;
    Energies e;
    Bench b;
    bench_init(&b, kinds[k].method, CELL_QUADRILATERAL, 0);
    bench_grid(&b, (PetscReal[]){0, grid ? -1 : 0, 0}, (PetscReal[]){1, grid ? 2 : 1, 0}, 0.125);
    bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 1, 0});
    settings(&b, kinds + k, 1e-3);
    MotionSpec *floor = bench_motion(&b, 1, 0, MOTION_VELOCITY, 2);
    if (grid) floor->on.min[1] = -1, floor->on.max[1] = 0.13;
    floor->value[1] = -1;
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    while (m->time < 0.05) {
      const PetscReal before = m->time;
      model_step(m, 1e-3);
      work -= (m->time - before) * reaction(m, 0);
    }
    CALL(ModelEnergies(m, &e));
    CHECK(work > 100, "no work is done");
    CHECK_CLOSE(e.boundary, work, 1e-9 * work);
    CHECK(PetscAbsReal(model_sum(m, "energy: balance", 0)) < 1e-6, "the balance is open");
    CALL(ModelDestroy(&m));
  }
}

/* What nodes that were let go gave is not forgotten by a run that is put away just then. */
static void test_resumed(void **state)
{
  (void)state;
  for (int first = 5; first < 8; ++first) {
    const Kind *kind = moving + (first == 6 ? 2 : 0); /* with Bossak's alpha it echoes */
    Bench b, same;
    Model *m = moves(&b, kind, PETSC_FALSE), *again = moves(&same, kind, PETSC_FALSE);
    for (int step = 0; step < first; ++step) model_step(m, 1e-3);
    model_take_up(m, again);
    for (int step = 0; step < 3; ++step) {
      models_go_on(m, again, 1);
      CHECK_CLOSE(reaction(m, 0), reaction(again, 0), 0);
    }
    CALL(ModelDestroy(&m));
    CALL(ModelDestroy(&again));
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_contact), cmocka_unit_test(test_moves),
                                     cmocka_unit_test(test_works), cmocka_unit_test(test_resumed)};
  return run_model_group(argc, argv, tests, PETSC_STATIC_ARRAY_LENGTH(tests));
}
