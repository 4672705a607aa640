/* Sliding begins: in that step, too, a wall or another body rubs with friction times what it bears, and times the step
 * what it gives is the change of momentum, its force at the start included. What begins to push at once has the force
 * of the wave, and what begins to be accelerated that of its mass. */
#include "case_builder.h"

#define FRICTION 0.3
#define WEIGHT (500 * 9.81) /* of the block, N */
#define STARTS 0.05         /* s, when the belt does */

typedef struct {
  const char *method, *basis, *scheme;
  PetscReal step;
  PetscBool on_body; /* the block lies on another one, not on a wall */
} Begins;

static const Begins kinds[] = {
  {"mpm", "gimp", NULL, 1e-2, PETSC_FALSE},     {"mpm", "cell", NULL, 2e-3, PETSC_FALSE},
  {"mpm", "gimp", "bossak", 1e-2, PETSC_FALSE}, {"fem", "cell", NULL, 1e-2, PETSC_FALSE},
  {"fem", "cell", "bossak", 2e-3, PETSC_FALSE}, {"mpm", "gimp", "midpoint", 1e-2, PETSC_FALSE},
  {"mpm", "gimp", NULL, 1e-2, PETSC_TRUE},
};

/* What the bench holds by address. */
typedef struct {
  WallSpec wall;
  MotionSpec belt;
  InterfaceSpec joint;
  PetscReal time[3], factor[3];
} Parts;

static char *between[] = {"body", "base"};

static void settings(Bench *b, const Begins *r)
{
  bench_init(b, r->method, CELL_QUADRILATERAL, 0);
  bench_grid(b, (PetscReal[]){-1, -0.5, 0}, (PetscReal[]){3, 1, 0}, 0.125);
  bench_box(b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 0.5, 0});
  bench_dynamic(b, 1, r->step);
  b->c.analysis.scheme = (char *)r->scheme;
  if (r->scheme && !strcmp(r->scheme, "bossak")) {
    b->c.analysis.bossak = -0.2;
    b->c.analysis.beta = 1.2 * 1.2 / 4;
    b->c.analysis.gamma = 0.7;
  }
  b->c.basis = (BasisSpec){.kind = r->basis};
  b->c.newton = (NewtonSpec){.residual = 1e-11, .increment = 1e-12, .max_iterations = 25, .ease = 6};
  b->c.linear = LINEAR_AUTO;
  b->constants[0].value = 1e8;
  b->body[0].has_k0 = PETSC_TRUE;
  b->body[0].k0 = 0.43;
  b->c.gravity[1] = -9.81;
}

static void put_wall(Bench *b, Parts *parts)
{
  parts->wall = (WallSpec){
    .name = (char *)"floor", .shape = {.kind = SHAPE_HALF_SPACE}, .contact = CONTACT_FRICTION, .friction = FRICTION};
  parts->wall.shape.normal[1] = 1;
  b->c.n_walls = 1;
  b->c.walls = &parts->wall;
}

static void put_body(Bench *b, Parts *parts)
{
  b->body[1] = b->body[0];
  b->body[1].name = (char *)"base";
  b->body[1].velocity[0] = 0;
  b->c.n_bodies = 2;
  bench_box(b, 1, (PetscReal[]){-1, -0.5, 0}, (PetscReal[]){3, 0, 0});
  bench_motion(b, 1, -0.5, MOTION_FIXED, 3);
  bench_motion(b, 0, -1, MOTION_FIXED, 1);
  bench_motion(b, 0, 3, MOTION_FIXED, 1);
  parts->joint = (InterfaceSpec){
    .name = (char *)"joint", .n_between = 2, .between = between, .contact = CONTACT_FRICTION, .friction = FRICTION};
  b->c.n_interfaces = 1;
  b->c.interfaces = &parts->joint;
}

static PetscReal force_of(Model *m, const Begins *r, PetscInt component)
{
  const MeasureSpec s = {.kind = (char *)(r->on_body ? "interface_force" : "wall_force"),
                         .component = component,
                         .wall = (char *)(r->on_body ? NULL : "floor"),
                         .interface = (char *)(r->on_body ? "joint" : NULL)};
  PetscReal value;
  CALL(ModelMeasure(m, &s, 0, &value));
  return value;
}

static PetscReal momentum_of(Model *m, PetscInt component)
{
  const MeasureSpec s = {.kind = (char *)"momentum", .component = component, .body = (char *)"body"};
  PetscReal value;
  CALL(ModelMeasure(m, &s, 0, &value));
  return value;
}

/* Steps until `end`: is what the partner gives the change of momentum, and rubs it with no more than its friction,
 * with all of it if it slides? */
static void go(Model *m, const Begins *r, PetscReal end, PetscBool slides)
{
  while (m->time < end - 1e-9) {
    const PetscReal before[2] = {momentum_of(m, 0), momentum_of(m, 1)}, t = m->time;
    model_step(m, PetscMin(r->step, end - t));
    const PetscReal along = PetscAbsReal(force_of(m, r, 0)), bears = force_of(m, r, 1), dt = m->time - t;
    CHECK_CLOSE(momentum_of(m, 0) - before[0], dt * force_of(m, r, 0), 1e-7 * dt * WEIGHT);
    CHECK_CLOSE(momentum_of(m, 1) - before[1], dt * (bears - WEIGHT), 1e-7 * dt * WEIGHT);
    CHECK(along <= (FRICTION + 1e-6) * bears, "%s %s %s rubs with %g of %g at %g s", r->method, r->basis,
          r->scheme ? r->scheme : "", (double)along, (double)bears, (double)m->time);
    CHECK(!slides || along >= (FRICTION - 1e-4) * bears, "%s %s %s rubs with %g of %g at %g s", r->method, r->basis,
          r->scheme ? r->scheme : "", (double)along, (double)bears, (double)m->time);
  }
}

/* A block that its weight has strained slides with 2 m/s from the start. */
static void test_at_once(void **state)
{
  (void)state;
  EACH_OF (k, kinds) {
    Bench b;
    Parts parts;
    Energies e;
    settings(&b, kinds + k);
    b.body[0].velocity[0] = 2;
    if (kinds[k].on_body) put_body(&b, &parts);
    else put_wall(&b, &parts);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    go(m, kinds + k, 5 * kinds[k].step, PETSC_TRUE);
    const PetscReal speed = 2 - FRICTION * 9.81 * m->time;
    CALL(ModelEnergies(m, &e));
    CHECK_CLOSE(momentum_of(m, 0), 500 * speed, 1); /* waves of its own bear it, too */
    CHECK_CLOSE(e.friction, 0.5 * 500 * (4 - PetscSqr(speed)), 0.02 * e.friction);
    CALL(ModelDestroy(&m));
  }
}

/* It rests on a belt that starts with 3 m/s. */
static void test_belt(void **state)
{
  (void)state;
  EACH_OF (k, kinds) {
    Bench b;
    Parts parts = {.time = {0, STARTS, STARTS + 1e-4}, .factor = {0, 0, 1}};
    if (kinds[k].on_body) continue;
    settings(&b, kinds + k);
    put_wall(&b, &parts);
    parts.belt = (MotionSpec){.kind = MOTION_VELOCITY, .component = {1}, .value = {-3}};
    parts.belt.amplitude = (Amplitude){.n = 3, .time = parts.time, .value = parts.factor};
    parts.wall.n_motions = 1;
    parts.wall.motions = &parts.belt;
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    go(m, kinds + k, STARTS, PETSC_FALSE);
    go(m, kinds + k, STARTS + 5 * kinds[k].step, PETSC_TRUE);
    CHECK_CLOSE(momentum_of(m, 0), -FRICTION * WEIGHT * 5 * kinds[k].step, 1);
    CHECK(PetscAbsReal(model_sum(m, "energy: balance", 0)) < 1e-6, "the balance is open");
    CALL(ModelDestroy(&m));
  }
}

/* It rests on a table that shakes, sticks, and slides where friction bears no more. */
static void test_table(void **state)
{
  (void)state;
  EACH_OF (k, kinds) {
    Bench b;
    Parts parts = {.time = {0, STARTS, 3 * STARTS}, .factor = {0, 0.1, 0.5}}; /* 2 m/s2, then 4 */
    if (kinds[k].on_body) continue;
    settings(&b, kinds + k);
    put_wall(&b, &parts);
    parts.belt = (MotionSpec){.kind = MOTION_VELOCITY, .component = {1}, .value = {1}};
    parts.belt.amplitude = (Amplitude){.n = 3, .time = parts.time, .value = parts.factor};
    parts.wall.n_motions = 1;
    parts.wall.motions = &parts.belt;
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    go(m, kinds + k, STARTS, PETSC_FALSE);
    CHECK_CLOSE(momentum_of(m, 0), 500 * 0.1, 3);
    go(m, kinds + k, 3 * STARTS, PETSC_FALSE);
    CHECK_CLOSE(momentum_of(m, 0), 500 * 0.1 + FRICTION * WEIGHT * 2 * STARTS, 3);
    CALL(ModelDestroy(&m));
  }
}

/* A plate that pushes a bar with SPEED, at once or from a corner of its table on: by the midpoint rule, too, its force
 * is that of the wave, and does not swing between twice that and nothing (docs/theory.md, "Walls"). */
#define SPEED 0.01
#define CORNER 0.02 /* s */

typedef struct {
  ContactKind contact;
  PetscReal start;
  PetscBool late; /* with a corner, else from the start of the run on */
} Plate;

static const Plate plates[] = {{CONTACT_FRICTIONLESS, 0, PETSC_FALSE},
                               {CONTACT_FRICTIONLESS, CORNER, PETSC_TRUE},
                               {CONTACT_STICK, CORNER, PETSC_TRUE},
                               {CONTACT_BONDED, CORNER, PETSC_TRUE}};

static Model *pushed(Bench *b, Parts *parts, const Plate *plate)
{
  settings(b, &(Begins){"mpm", "gimp", "midpoint", 2e-3, PETSC_FALSE});
  bench_box(b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){2, 0.125, 0});
  b->constants[0].value = 1e6, b->constants[1].value = 0;
  b->body[0].has_k0 = PETSC_FALSE;
  b->c.gravity[1] = 0;
  b->c.analysis.transfer = (char *)"consistent";
  put_wall(b, parts);
  parts->wall.contact = plate->contact;
  parts->wall.shape.normal[0] = 1, parts->wall.shape.normal[1] = 0;
  *parts = (Parts){.wall = parts->wall, .time = {0, CORNER, CORNER + 1}, .factor = {0, 0, 1}};
  parts->belt = (MotionSpec){.kind = plate->late ? MOTION_DISPLACEMENT : MOTION_VELOCITY, .component = {1}};
  parts->belt.value[0] = SPEED;
  if (plate->late) parts->belt.amplitude = (Amplitude){.n = 3, .time = parts->time, .value = parts->factor};
  parts->wall.n_motions = 1;
  parts->wall.motions = &parts->belt;
  return bench_model(b, PETSC_COMM_WORLD);
}

static void test_plate(void **state)
{
  (void)state;
  EACH_OF (k, plates) {
    const PetscReal wave = SPEED * PetscSqrtReal(1e6 * 1000) * 0.125;
    Bench b;
    Parts parts;
    Energies e;
    Model *m = pushed(&b, &parts, plates + k);
    PetscReal given = 0, lowest = wave, highest = wave;
    for (int step = 1; m->time < plates[k].start + 0.04; ++step) {
      model_step(m, 2e-3);
      const PetscReal force = model_wall(m, "floor", "wall_force", NULL, 0);
      given += 2e-3 * force;
      if (m->time < plates[k].start + 0.019) continue; /* the bar's front of cells has its own first steps */
      lowest = PetscMin(lowest, force);
      highest = PetscMax(highest, force);
    }
    CALL(ModelEnergies(m, &e));
    PetscPrintf(PETSC_COMM_WORLD, "contact %d from %g s: %.4f to %.4f of %.4f N\n", (int)plates[k].contact,
                (double)plates[k].start, (double)lowest, (double)highest, (double)wave);
    CHECK(lowest > 0.93 * wave && highest < 1.07 * wave, "%g to %g N", (double)lowest, (double)highest);
    CHECK_CLOSE(model_sum(m, "momentum", 0), given, 1e-9);
    CHECK_CLOSE(e.boundary, SPEED * given, 1e-9 * given);
    CHECK(PetscAbsReal(model_sum(m, "energy: balance", 0)) < 1e-12, "the balance is open");
    CALL(ModelDestroy(&m));
  }
}

/* Explicitly, too, what a boundary accelerates has its velocity at the end of a step, and takes the force that a weight
 * takes that is as large. */
static PetscReal held_up(PetscReal moves)
{
  const MeasureSpec reaction = {.kind = "reaction", .component = 1};
  const PetscReal pull = 5;
  PetscReal force = 0;
  Bench b;
  settings(&b, &(Begins){"mpm", "gimp", NULL, 2e-3, PETSC_FALSE});
  Parts parts = {.time = {0, 1}, .factor = {0, 1}};
  b.c.analysis.type = ANALYSIS_EXPLICIT;
  b.c.analysis.end = 2e-3;
  b.constants[0].value = 1e6, b.constants[1].value = 0;
  b.body[0].has_k0 = PETSC_FALSE;
  b.c.gravity[1] = (moves - 1) * pull;
  MotionSpec *motion = bench_motion(&b, 1, 0, MOTION_VELOCITY, 3);
  motion->value[1] = moves * pull;
  motion->amplitude = (Amplitude){.n = 2, .time = parts.time, .value = parts.factor};
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  model_step(m, 2e-3);
  CALL(ModelMeasure(m, &reaction, 0, &force));
  CALL(ModelDestroy(&m));
  return force;
}

static void test_explicit_boundary(void **state)
{
  (void)state;
  const PetscReal moved = held_up(1), weighs = held_up(0);
  PetscPrintf(PETSC_COMM_WORLD, "explicit: %.4f N accelerate, %.4f N bear\n", (double)moved, (double)weighs);
  CHECK_CLOSE(moved, weighs, 1e-3 * weighs);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_at_once), cmocka_unit_test(test_belt),
                                     cmocka_unit_test(test_table), cmocka_unit_test(test_plate),
                                     cmocka_unit_test(test_explicit_boundary)};
  return run_model_group(argc, argv, tests, PETSC_STATIC_ARRAY_LENGTH(tests));
}
