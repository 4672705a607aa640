/* Bodies on rigid walls, in every method, against what mechanics says of rigid bodies: momentum that
 * the wall gives, how a block slides, that it rests, and what it weighs. */
#include "case_builder.h"

typedef struct {
  const char *method, *basis;
  CellType cell;
  PetscReal friction;
  const char *scheme, *transfer;
  PetscBool lumped, grains;
  PetscReal adhesion;
} Block;

static NamedValue grains[] = {
  {"young", 1e6}, {"poisson", 0.3}, {"friction_angle", 30}, {"dilatancy_angle", 0}, {"cohesion", 0}};

#define SLOPE (PETSC_PI / 6)

static int up_of(const Block *r) { return r->cell == CELL_HEXAHEDRON ? 2 : 1; }

/* A block of 1 x 0.5 (x 0.5) m stands on a wall, half a cell above a line of the grid. */
static Model *standing(Bench *b, const Block *r, PetscReal slope, PetscBool dynamic, WallSpec *wall)
{
  const int up = up_of(r);
  bench_init(b, r->method, r->cell, 0);
  bench_grid(b, (PetscReal[]){0.125, 0.25, 0}, (PetscReal[]){3.125, 1.5, 1}, 0.25);
  bench_box(b, 0, (PetscReal[]){0.625, 0.5, 0.25}, (PetscReal[]){1.625, 1, 0.75});
  if (dynamic) bench_dynamic(b, 1, 5e-3);
  b->c.analysis.scheme = (char *)r->scheme;
  b->c.analysis.transfer = (char *)r->transfer;
  if (r->scheme && !strcmp(r->scheme, "bossak")) {
    b->c.analysis.bossak = -0.3;
    b->c.analysis.beta = 1.3 * 1.3 / 4;
    b->c.analysis.gamma = 0.8;
  }
  if (r->lumped) b->c.analysis.mass = MASS_LUMPED;
  b->c.basis = (BasisSpec){
    .kind = r->basis, .gamma = 1.8, .effective_radius = 1, .radius = 2, .max_radius = 3.5, .condition = 50, .gap = 2};
  if (r->grains)
    b->material =
      (MaterialSpec){.name = "rubber", .law = "mohr-coulomb", .density = 1000, .n_parameters = 5, .parameters = grains};
  b->c.linear = LINEAR_AUTO;
  b->c.newton = (NewtonSpec){.residual = 1e-11, .increment = 1e-12, .max_iterations = 25, .ease = 6};
  b->c.stabilisation.curvature = 0.1;
  b->c.gravity[0] = 9.81 * PetscSinReal(slope);
  b->c.gravity[up] = -9.81 * PetscCosReal(slope);
  *wall = (WallSpec){.name = (char *)"floor",
                     .shape = {.kind = SHAPE_HALF_SPACE},
                     .contact = r->friction + r->adhesion > 0 ? CONTACT_FRICTION : CONTACT_FRICTIONLESS,
                     .friction = r->friction,
                     .adhesion = r->adhesion};
  wall->shape.point[up] = up == 2 ? 0.25 : 0.5;
  wall->shape.normal[up] = 1;
  b->c.n_walls = 1;
  b->c.walls = wall;
  return bench_model(b, PETSC_COMM_WORLD);
}

static PetscReal measure(Model *m, const char *kind, const char *word, PetscInt component)
{
  return model_wall(m, "floor", kind, word, component);
}

/* Impulses of the wall are the change of momentum; their ratio is the friction; the block is as fast as
 * a rigid one, but for the waves in it; it is not in the wall; no energy is made. Steps of changing length. */
static void slide(const Block *r)
{
  Bench b;
  WallSpec wall;
  const int up = up_of(r);
  const PetscReal mass = up == 2 ? 250 : 500;
  PetscReal given[3] = {0, 0, 0}, off = 0, deepest = 0, adhered = 0;
  Energies e;
  Model *m = standing(&b, r, SLOPE, PETSC_TRUE, &wall);
  for (PetscInt k = 0; m->time < 0.3; ++k) {
    const PetscReal before = m->time;
    model_step(m, k % 3 == 1 ? 2e-3 : 5e-3);
    for (PetscInt d = 0; d < m->dim; ++d) {
      given[d] += (m->time - before) * measure(m, "wall_force", NULL, d);
      off = PetscMax(off, PetscAbsReal(given[d] + mass * b.c.gravity[d] * m->time - model_sum(m, "momentum", d)));
    }
    deepest = PetscMax(deepest, measure(m, "contact", "penetration", 0));
    adhered += (m->time - before) * r->adhesion * measure(m, "contact", "area", 0);
  }
  CALL(ModelEnergies(m, &e));
  const PetscReal rubs = r->friction + adhered / given[up]; /* what hops adheres while it is down */
  const PetscReal speed = 9.81 * (PetscSinReal(SLOPE) - r->friction * PetscCosReal(SLOPE)) * m->time - adhered / mass;
  const PetscReal found = model_sum(m, "momentum", 0) / mass, ratio = -given[0] / given[up];
  PetscPrintf(PETSC_COMM_WORLD,
              "%s %s cell %d mu %g %s %s: impulse off %.2g of %.4g, ratio %.6g, speed %.6g of %.6g, "
              "%.2g m deep, transfer %.3g of %.6g J\n",
              r->method, r->basis, (int)r->cell, (double)r->friction, r->scheme ? r->scheme : "",
              r->transfer ? r->transfer : "", (double)off, (double)given[up], (double)ratio, (double)found,
              (double)speed, (double)deepest, (double)e.transfer, (double)e.external);
  CHECK(off <= 1e-8 * given[up] && given[up] > 500, "impulse off by %g of %g", (double)off, (double)given[up]);
  /* where it sticks for a moment, hopping, there is less */
  CHECK(ratio < rubs + 1e-3 && ratio >= 0.96 * rubs, "ratio %g", (double)ratio);
  CHECK(PetscAbsReal(found - speed) < 0.03 * speed, "speed %g, not %g", (double)found, (double)speed);
  CHECK(deepest <= 1e-4 * 0.25, "it is %g m deep in the wall", (double)deepest);
  CHECK(e.transfer > -0.06 * e.external, "%g J of %g were made", (double)-e.transfer, (double)e.external);
  CHECK(PetscAbsReal(model_sum(m, "energy: balance", 0)) < 1e-6, "open: %g",
        (double)model_sum(m, "energy: balance", 0));
  CALL(ModelDestroy(&m));
}

static void test_slides(void **state)
{
  static const Block blocks[] = {
    {"mpm", "cell", CELL_QUADRILATERAL, 0, NULL, "thesis", PETSC_FALSE, PETSC_FALSE, 0},
    {"mpm", "cell", CELL_QUADRILATERAL, 0.2, NULL, "thesis", PETSC_FALSE, PETSC_FALSE, 0},
    {"mpm", "cell", CELL_QUADRILATERAL, 0.2, NULL, "thesis", PETSC_TRUE, PETSC_FALSE, 0},
    {"mpm", "cell", CELL_TRIANGLE, 0.2, NULL, "thesis", PETSC_FALSE, PETSC_FALSE, 0},
    {"mpm", "cell", CELL_QUADRILATERAL, 0.2, NULL, "consistent", PETSC_FALSE, PETSC_FALSE, 0},
    {"mpm", "cell", CELL_QUADRILATERAL, 0.2, "midpoint", "thesis", PETSC_FALSE, PETSC_FALSE, 0},
    {"mpm", "cell", CELL_QUADRILATERAL, 0.2, "bossak", "thesis", PETSC_FALSE, PETSC_FALSE, 0},
    {"mpm", "gimp", CELL_QUADRILATERAL, 0.2, NULL, "thesis", PETSC_FALSE, PETSC_FALSE, 0},
    {"mpm", "gimp", CELL_QUADRILATERAL, 0.2, NULL, "thesis", PETSC_TRUE, PETSC_FALSE, 0},
    {"mpm", "gimp", CELL_QUADRILATERAL, 0.2, "midpoint", "consistent", PETSC_FALSE, PETSC_FALSE, 0},
    {"mpm", "cell", CELL_QUADRILATERAL, 0.2, NULL, "thesis", PETSC_FALSE, PETSC_FALSE, 500},
    {"fem", "cell", CELL_QUADRILATERAL, 0, NULL, "thesis", PETSC_FALSE, PETSC_FALSE, 1000},
    {"mpm", "cell", CELL_HEXAHEDRON, 0.2, NULL, "thesis", PETSC_FALSE, PETSC_FALSE, 0},
    {"fem", "cell", CELL_QUADRILATERAL, 0, NULL, "thesis", PETSC_FALSE, PETSC_FALSE, 0},
    {"fem", "cell", CELL_QUADRILATERAL, 0.2, NULL, "thesis", PETSC_FALSE, PETSC_FALSE, 0},
    {"fem", "cell", CELL_QUADRILATERAL, 0.2, "bossak", "thesis", PETSC_FALSE, PETSC_FALSE, 0},
    {"gmm", "lme", CELL_QUADRILATERAL, 0.2, NULL, "thesis", PETSC_FALSE, PETSC_FALSE, 0},
    {"gmm", "lme", CELL_QUADRILATERAL, 0.2, "bossak", "thesis", PETSC_FALSE, PETSC_FALSE, 0},
  };
  (void)state;
  EACH_OF (k, blocks) slide(&blocks[k]);
}

/* A floor that lifts the block at once with half a metre a second, and rubs it on its slope: its work is its velocity
 * times what it bears, impulses too; of a scheme without damping nothing is numerical; nothing is made. */
static void test_lifts(void **state)
{
  static const Block blocks[] = {
    {"mpm", "cell", CELL_QUADRILATERAL, 0.2, NULL, "thesis", PETSC_FALSE, PETSC_FALSE, 0},
    {"mpm", "gimp", CELL_QUADRILATERAL, 0.2, "midpoint", "consistent", PETSC_FALSE, PETSC_FALSE, 0},
    {"mpm", "gimp", CELL_QUADRILATERAL, 0.2, "bossak", "thesis", PETSC_FALSE, PETSC_FALSE, 0},
    {"mpm", "cell", CELL_HEXAHEDRON, 0.2, NULL, "thesis", PETSC_FALSE, PETSC_FALSE, 0},
    {"fem", "cell", CELL_QUADRILATERAL, 0.2, NULL, "thesis", PETSC_FALSE, PETSC_FALSE, 0},
  };
  (void)state;
  EACH_OF (k, blocks) {
    const Block *r = &blocks[k];
    Bench b;
    WallSpec wall;
    Energies e;
    const int up = up_of(r);
    MotionSpec lift = {.kind = MOTION_VELOCITY, .component = {1, 1, 1}};
    lift.value[up] = 0.5;
    CALL(ModelDestroy((Model *[]){standing(&b, r, SLOPE, PETSC_TRUE, &wall)}));
    wall.n_motions = 1;
    wall.motions = &lift;
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    PetscReal work = 0;
    for (PetscReal before = 0; m->time < 0.2; before = m->time) {
      model_step(m, 2e-3);
      work += (m->time - before) * 0.5 * measure(m, "wall_force", NULL, up);
    }
    CALL(ModelEnergies(m, &e));
    const PetscReal lost = e.transfer + e.numerical;
    PetscPrintf(PETSC_COMM_WORLD, "%s %s %s lifted: work %.6g J of %.6g, lost %.4g, of it numerical %.4g\n", r->method,
                r->basis, r->scheme ? r->scheme : "", (double)e.boundary, (double)work, (double)lost,
                (double)e.numerical);
    CHECK_CLOSE(e.boundary, work, 0.02 * work);
    CHECK(lost > -0.01 * work && lost < 0.15 * work, "%g J are lost of %g", (double)lost, (double)work);
    if (!r->scheme || strcmp(r->scheme, "bossak"))
      CHECK(PetscAbsReal(e.numerical) < 1e-9 * work, "numerical: %g J", (double)e.numerical);
    CHECK(PetscAbsReal(model_sum(m, "energy: balance", 0)) < 1e-6, "open");
    CALL(ModelDestroy(&m));
  }
}

#define RISE 100.0 /* m/s2, of a floor that lifts the block from rest on */

/* What the floor bears in the first steps of the block under a gravity of 10 m/s2 beside it: as it rests, or rises with
 * less gravity. held: the floor is a boundary. */
static void bear(const Block *r, PetscBool held, PetscBool rises, PetscInt steps, PetscReal *force)
{
  Bench b;
  WallSpec wall;
  const int up = up_of(r);
  MotionSpec lift = {.kind = MOTION_VELOCITY, .component = {1, 1, 1}};
  lift.value[up] = RISE;
  lift.amplitude = (Amplitude){.n = 2, .time = (PetscReal[]){0, 1}, .value = (PetscReal[]){0, 1}};
  CALL(ModelDestroy((Model *[]){standing(&b, r, 0, PETSC_TRUE, &wall)}));
  b.c.gravity[up] = rises ? RISE - 10 : -10;
  wall.n_motions = rises;
  wall.motions = &lift;
  if (held) b.c.n_walls = 0;
  MotionSpec *floor = held ? bench_motion(&b, up, 0.5, rises ? MOTION_VELOCITY : MOTION_FIXED, 1 << up) : &lift;
  floor->value[up] = RISE;
  floor->amplitude = lift.amplitude;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  const MeasureSpec reaction = {.kind = "reaction", .component = up};
  for (PetscInt s = 0; s < steps; ++s) {
    model_step(m, 5e-3);
    if (held) CALL(ModelMeasure(m, &reaction, 0, force + s));
    else force[s] = measure(m, "wall_force", NULL, up);
  }
  CALL(ModelDestroy(&m));
}

/* A floor that accelerates from the start on bears what one does that stands, under as much more gravity. */
static void test_rises(void **state)
{
  static const Block blocks[] = {
    {"fem", "cell", CELL_QUADRILATERAL, 0, NULL, "thesis", PETSC_FALSE, PETSC_FALSE, 0},
    {"fem", "cell", CELL_QUADRILATERAL, 0, NULL, "thesis", PETSC_TRUE, PETSC_FALSE, 0},
    {"fem", "cell", CELL_QUADRILATERAL, 0, "bossak", "thesis", PETSC_FALSE, PETSC_FALSE, 0},
    {"gmm", "lme", CELL_QUADRILATERAL, 0, NULL, "thesis", PETSC_FALSE, PETSC_FALSE, 0},
  };
  PetscReal rests[3], rises[3];
  (void)state;
  for (int held = 0; held < 2; ++held)
    EACH_OF (k, blocks) {
      bear(&blocks[k], (PetscBool)held, PETSC_FALSE, 3, rests);
      bear(&blocks[k], (PetscBool)held, PETSC_TRUE, 3, rises);
      for (int s = 0; s < 3; ++s) CHECK_CLOSE(rises[s], rests[s], 1e-5 * 5000);
    }
}

/* Steeper friction than the slope: the block stays where it is, in statics. The floor bears its weight. */
static void rest(const Block *r)
{
  Bench b;
  WallSpec wall;
  const int up = up_of(r);
  const PetscReal weight = 9.81 * (up == 2 ? 250 : 500);
  Model *m = standing(&b, r, SLOPE, PETSC_FALSE, &wall);
  while (m->time < 1 - 1e-9) model_step(m, 0.25);
  const PetscReal normal = measure(m, "wall_force", NULL, up), along = measure(m, "wall_force", NULL, 0);
  PetscPrintf(PETSC_COMM_WORLD, "%s %s cell %d at rest: %.12g and %.12g N, %.2g m deep, %d iterations\n", r->method,
              r->basis, (int)r->cell, (double)normal, (double)along, (double)measure(m, "contact", "penetration", 0),
              (int)m->total_iterations);
  CHECK(PetscAbsReal(normal - weight * PetscCosReal(SLOPE)) < 1e-8 * weight, "normal force %g", (double)normal);
  CHECK(PetscAbsReal(along + weight * PetscSinReal(SLOPE)) < 1e-8 * weight, "shear force %g", (double)along);
  CHECK(measure(m, "contact", "penetration", 0) < 1e-4 * 0.25, "deep in the wall");
  CALL(ModelDestroy(&m));
}

static void test_rests(void **state)
{
  static const Block blocks[] = {
    {"mpm", "cell", CELL_QUADRILATERAL, 0.8, NULL, "thesis", PETSC_FALSE, PETSC_FALSE, 0},
    {"mpm", "gimp", CELL_QUADRILATERAL, 0.8, NULL, "thesis", PETSC_FALSE, PETSC_FALSE, 0},
    {"mpm", "cell", CELL_HEXAHEDRON, 0.8, NULL, "thesis", PETSC_FALSE, PETSC_FALSE, 0},
    {"fem", "cell", CELL_QUADRILATERAL, 0.8, NULL, "thesis", PETSC_FALSE, PETSC_FALSE, 0},
    {"gmm", "lme", CELL_QUADRILATERAL, 0.8, NULL, "thesis", PETSC_FALSE, PETSC_FALSE, 0},
  };
  (void)state;
  EACH_OF (k, blocks) rest(&blocks[k]);
}

/* Grains run out over a floor: gaps are measured by what moves (solve/contact), up to 5e-4 of a cell, and what the wall
 * gives is all the momentum that there is. */
static void test_flows(void **state)
{
  static const Block heaps[] = {
    {"mpm", "cell", CELL_QUADRILATERAL, 0, NULL, "thesis", PETSC_TRUE, PETSC_TRUE, 0},
    {"mpm", "cell", CELL_QUADRILATERAL, 0.6, NULL, "thesis", PETSC_TRUE, PETSC_TRUE, 0},
    {"mpm", "gimp", CELL_QUADRILATERAL, 0.6, "newmark", "thesis", PETSC_TRUE, PETSC_TRUE, 0},
  };
  (void)state;
  EACH_OF (k, heaps) {
    PetscReal given = 0, off = 0, deepest = 0;
    Bench b;
    WallSpec wall;
    Model *m = standing(&b, heaps + k, 0, PETSC_TRUE, &wall);
    while (m->time < 0.3) {
      const PetscReal before = m->time;
      model_step(m, 5e-3);
      given += (m->time - before) * measure(m, "wall_force", NULL, 1);
      off = PetscMax(off, PetscAbsReal(given + 500 * b.c.gravity[1] * m->time - model_sum(m, "momentum", 1)));
      deepest = PetscMax(deepest, measure(m, "contact", "penetration", 0));
    }
    CHECK(off <= 1e-8 * given && given > 500, "impulse off by %g of %g", (double)off, (double)given);
    CHECK(deepest <= 6e-4 * 0.25, "it is %g m deep in the wall", (double)deepest);
    CHECK(PetscAbsReal(model_sum(m, "energy: balance", 0)) < 1e-6, "the balance is open");
    bench_end(&b);
    CALL(ModelDestroy(&m));
  }
}

/* A wall through the middle of the block. */
static void test_through(void **state)
{
  static const Block block = {"mpm", "cell", CELL_QUADRILATERAL, 0.8, NULL, "thesis", PETSC_FALSE, PETSC_FALSE, 0};
  Bench b;
  WallSpec wall;
  (void)state;
  Model *m = standing(&b, &block, 0, PETSC_FALSE, &wall);
  CALL(ModelDestroy(&m));
  wall.shape.point[1] = 0.7;
  bench_refused(&b, PETSC_COMM_WORLD, "walls[0]", "goes through a body");
}

/* Does the program say that the wall cuts into the body, if that is so by this share of a cell? */
static PetscBool tells_dent(const Block *block, PetscReal share)
{
  Bench b;
  WallSpec wall;
  Diag *diag;
  Model *m = standing(&b, block, 0, PETSC_FALSE, &wall);
  char *text = NULL;
  size_t size;
  FILE *out = open_memstream(&text, &size);
  CALL(ModelDestroy(&m));
  wall.shape.point[1] += share * 0.25;
  CALL(DiagCreate(&diag));
  CALL(DiagSetResolver(diag, show_path, NULL));
  CALL(ModelCreate(PETSC_COMM_WORLD, &b.c, diag, &m));
  CHECK(m, "the case was refused");
  CALL(DiagFlush(diag, out));
  fclose(out);
  int told = strstr(text, "walls[0]") && strstr(text, "cuts into a body at the start");
  MPI_Bcast(&told, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  free(text);
  CALL(DiagDestroy(&diag));
  CALL(ModelDestroy(&m));
  return (PetscBool)told;
}

/* A mesh that a wall cuts is taken to be made to fit it: by a hundredth of a cell or more that is said. Points of mpm
 * do not know better. */
static void test_dent(void **state)
{
  static const Block fem = {"fem", "cell", CELL_QUADRILATERAL, 0.8, NULL, "thesis", PETSC_FALSE, PETSC_FALSE, 0},
                     mpm = {"mpm", "cell", CELL_QUADRILATERAL, 0.8, NULL, "thesis", PETSC_FALSE, PETSC_FALSE, 0};
  (void)state;
  CHECK(!tells_dent(&fem, 0) && !tells_dent(&fem, 0.005), "there is no dent worth a word");
  CHECK(tells_dent(&fem, 0.02), "a dent of 0.02 of a cell is not told");
  CHECK(!tells_dent(&mpm, 0.02), "mpm has no such dents");
}

/* Along a ball that does not rub no work is lost, whichever way it looks at what it pushes aside. */
static void test_smooth(void **state)
{
  MotionSpec aside = {.kind = MOTION_DISPLACEMENT, .component = {1, 1, 1}, .value = {0.1, -0.1, 0}};
  WallSpec wall = {.name = (char *)"floor",
                   .shape = {.kind = SHAPE_BALL, .centre = {0.5, 1.4, 0}, .radius = 0.4},
                   .n_motions = 1,
                   .motions = &aside};
  Energies e;
  Bench b;
  (void)state;
  bench_init(&b, "fem", CELL_QUADRILATERAL, 8);
  bench_motion(&b, 1, 0, MOTION_FIXED, 3);
  b.c.newton.increment = 1e-9;
  b.c.n_walls = 1;
  b.c.walls = &wall;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  while (m->time < 1 - 1e-9) model_step(m, 0.25);
  CALL(ModelEnergies(m, &e));
  PetscPrintf(PETSC_COMM_WORLD, "smooth ball: %.6g J of work, %.3g of friction, %.3g of transfer\n", (double)e.boundary,
              (double)e.friction, (double)e.transfer);
  CHECK_CLOSE(measure(m, "contact", "sliding", 0), 0, 0);
  CHECK_CLOSE(e.friction, 0, 0);
  CHECK(PetscAbsReal(e.transfer) < 5e-3 * e.boundary, "%g J of %g", (double)e.transfer, (double)e.boundary);
  CALL(ModelDestroy(&m));
}

/* A block that goes round in a smooth drum (in space a bowl), which stands or turns about its centre. */
static Model *in_drum(Bench *b, const Block *r, MotionSpec *turning, WallSpec *wall)
{
  const PetscReal half = 0.125, radius = PetscSqrtReal(1 + (up_of(r) == 2 ? 2 : 1) * half * half);
  bench_init(b, r->method, r->cell, 0);
  bench_grid(b, (PetscReal[]){-1.25, -1.25, -0.25}, (PetscReal[]){1.25, 1.25, 0.25}, half);
  bench_box(b, 0, (PetscReal[]){-half, -1, -half}, (PetscReal[]){half, -0.75, half});
  bench_dynamic(b, 1, 0.01);
  b->c.analysis.scheme = (char *)r->scheme;
  b->c.analysis.transfer = (char *)r->transfer;
  b->body[0].spin[2] = 3;
  b->c.newton = (NewtonSpec){.residual = 1e-11, .increment = 1e-12, .max_iterations = 25, .ease = 6};
  b->c.basis = (BasisSpec){
    .kind = r->basis, .gamma = 1.8, .effective_radius = 1, .radius = 2, .max_radius = 3.5, .condition = 50, .gap = 2};
  b->c.stabilisation.curvature = 0.1;
  *wall = (WallSpec){.name = (char *)"floor",
                     .shape = {.kind = SHAPE_BALL, .radius = radius},
                     .inside = PETSC_TRUE,
                     .n_motions = turning != NULL,
                     .motions = turning};
  b->c.n_walls = 1;
  b->c.walls = wall;
  return bench_model(b, PETSC_COMM_WORLD);
}

/* What does not rub has no torque about the centre, and a drum that turns does no work; steps of changing length. */
static void go_round(const Block *r, PetscBool turns)
{
  MotionSpec turning = {.kind = MOTION_ROTATION, .axis = {0, 0, 1}, .rate = 3};
  Energies e;
  Bench b;
  WallSpec wall;
  PetscReal given = 0;
  Model *m = in_drum(&b, r, turns ? &turning : NULL, &wall);
  const PetscReal before = model_sum(m, "angular_momentum", 2);
  for (PetscInt k = 0; m->time < 0.15; ++k) {
    const PetscReal start = m->time;
    model_step(m, k % 3 == 1 ? 5e-3 : 1e-2);
    given += (m->time - start) * measure(m, "wall_torque", NULL, 2);
  }
  CALL(ModelEnergies(m, &e));
  const PetscReal left = model_sum(m, "angular_momentum", 2) / before;
  PetscPrintf(PETSC_COMM_WORLD, "%s cell %d in a drum%s: spin %.9f, torque %.2g, work %.2g, transfer %.2g of %.4g J\n",
              r->method, (int)r->cell, turns ? " that turns" : "", (double)left, (double)(given / before),
              (double)e.boundary, (double)e.transfer, (double)e.start);
  CHECK_CLOSE(given / before, 0, 2e-5);
  CHECK_CLOSE(left, 1, 1e-4);
  CHECK_CLOSE(e.boundary, 0, 5e-4 * e.start);
  CALL(ModelDestroy(&m));
}

static void test_round(void **state)
{
  static const Block blocks[] = {
    {"mpm", "cell", CELL_QUADRILATERAL, 0, "midpoint", "consistent", PETSC_FALSE, PETSC_FALSE, 0},
    {"fem", "cell", CELL_QUADRILATERAL, 0, NULL, "thesis", PETSC_FALSE, PETSC_FALSE, 0},
    {"gmm", "lme", CELL_QUADRILATERAL, 0, NULL, "thesis", PETSC_FALSE, PETSC_FALSE, 0},
    {"fem", "cell", CELL_HEXAHEDRON, 0, NULL, "thesis", PETSC_FALSE, PETSC_FALSE, 0},
  };
  (void)state;
  EACH_OF (k, blocks) go_round(&blocks[k], (PetscBool)(k % 2));
}

/* What of a body is left of a cell at its edge, far narrower than a row of points is high, stands on the floor like
 * all others, wherever the edge is. */
static void test_narrow(void **state)
{
  static const PetscReal edges[] = {0.53, 0.51, 0.6};
  (void)state;
  EACH_OF (k, edges) {
    Bench b;
    WallSpec wall = {.name = (char *)"floor", .shape = {.kind = SHAPE_HALF_SPACE, .normal = {0, 1}}};
    bench_init(&b, "mpm", CELL_QUADRILATERAL, 0);
    bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){3, 1, 0}, 0.125);
    bench_box(&b, 0, (PetscReal[]){edges[k], 0, 0}, (PetscReal[]){edges[k] + 2, 0.5, 0});
    bench_motion(&b, 0, 1.5, MOTION_FIXED, 1);
    b.constants[0].value = 1e9, b.constants[1].value = 0;
    b.c.gravity[1] = -10;
    b.c.n_walls = 1;
    b.c.walls = &wall;
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    for (int step = 0; step < 3; ++step) model_step(m, 1. / 3);
    CHECK_CLOSE(measure(m, "contact", "area", 0), 2, 1e-4);
    CALL(ModelDestroy(&m));
  }
}

/* Two blocks of 8 x 3 cells, or one of 8 x 8 (one), and a line between that is so many cells thick. */
static void parted(Bench *b, const char *method, PetscReal at, PetscReal thick, PetscBool one, WallSpec *wall)
{
  static PetscReal line[4] = {-0.5, 0, 1.5, 0};
  const PetscReal h = 0.125, low = at - thick * h / 2, high = at + thick * h / 2;
  bench_init(b, method, CELL_QUADRILATERAL, 0);
  bench_grid(b, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 1, 0}, h);
  bench_dynamic(b, 1, 0.01);
  line[1] = line[3] = at;
  *wall = (WallSpec){.name = (char *)"sheet", .shape = {.kind = SHAPE_LINE, .vertices = line, .n_vertices = 2}};
  wall->thickness = thick * h;
  b->c.n_walls = 1;
  b->c.walls = wall;
  if (one) return;
  b->c.n_bodies = 2;
  b->body[1] = b->body[0];
  b->body[1].name = "other";
  bench_box(b, 0, (PetscReal[]){0, low - 3 * h, 0}, (PetscReal[]){1, low, 0});
  bench_box(b, 1, (PetscReal[]){0, high, 0}, (PetscReal[]){1, high + 3 * h, 0});
}

/* Nodes that reach through a wall are told of, by their number on any ranks, and only these. */
static void test_astride(void **state)
{
  (void)state;
  static const struct {
    const char *method, *words;
    PetscReal at, thick;
    PetscBool one;
  } said[] = {{"mpm", "'body' and 'other' on its two sides stick to each other by 18 nodes", 0.53, 0, PETSC_FALSE},
              {"mpm", "'body' and 'other' on its two sides stick to each other by 9 nodes", 0.5, 0, PETSC_FALSE},
              {"fem", "'body' and 'other' on its two sides stick to each other by 9 nodes", 0.5, 0, PETSC_FALSE},
              {"mpm", "what of 'body' is on its two sides sticks to itself by 9 nodes", 0.5, 0, PETSC_TRUE},
              {"mpm", NULL, 0.5, 2, PETSC_FALSE}};
  InterfaceSpec slide = {.name = (char *)"slide", .n_between = 2, .between = (char *[]){"body", "other"}};
  WallSpec wall;
  Bench b;
  EACH_OF (k, said) {
    parted(&b, said[k].method, said[k].at, said[k].thick, said[k].one, &wall);
    bench_warned(&b, PETSC_COMM_WORLD, "walls[0]", said[k].words);
  }
  parted(&b, "mpm", 0.53, 0, PETSC_FALSE, &wall);
  b.c.n_interfaces = 1;
  b.c.interfaces = &slide;
  bench_warned(&b, PETSC_COMM_WORLD, "walls[0]", NULL);
  /* both sides of a slot meet what is in it: that is not on both sides of a wall */
  parted(&b, "mpm", 0.5, 0, PETSC_TRUE, &wall);
  wall = (WallSpec){.name = (char *)"slot", .shape = {.kind = SHAPE_BOX, .min = {0.5, 0.125}, .max = {0.625, 0.875}}};
  wall.inside = PETSC_TRUE;
  bench_box(&b, 0, wall.shape.min, wall.shape.max);
  bench_warned(&b, PETSC_COMM_WORLD, "walls[0]", NULL);
}

/* A block of 1 x 0.5 m on a wall along a line of the grid, whose weight comes within a tenth of a second. */
static Model *shaken(Bench *b, const Block *r, WallSpec *wall)
{
  static PetscReal time[] = {0, 0.1}, share[] = {0, 1};
  bench_init(b, r->method, r->cell, 0);
  bench_grid(b, (PetscReal[]){0, -0.25, 0}, (PetscReal[]){1.5, 1, 0.25}, 0.125);
  bench_box(b, 0, (PetscReal[]){0.25, 0, 0}, (PetscReal[]){1.25, 0.5, 0.25});
  b->c.basis.kind = r->basis;
  b->c.analysis.transfer = (char *)r->transfer;
  if (r->lumped) b->c.analysis.mass = MASS_LUMPED;
  b->constants[1].value = 0;
  b->c.gravity[1] = -10;
  b->c.gravity_amplitude = (Amplitude){.n = 2, .time = time, .value = share};
  *wall = (WallSpec){.name = (char *)"floor",
                     .shape = {.kind = SHAPE_HALF_SPACE, .normal = {0, 1}},
                     .contact = CONTACT_FRICTION,
                     .friction = r->friction};
  b->c.n_walls = 1, b->c.walls = wall;
  bench_dynamic(b, 2, 4e-3);
  return bench_model(b, PETSC_COMM_WORLD);
}

/* Most that the energy of motion is in 0.3 s. */
static PetscReal liveliest(Model *m)
{
  PetscReal most = 0;
  for (int k = 0; k < 75; ++k) {
    model_step(m, 4e-3);
    most = PetscMax(most, model_sum(m, "energy: kinetic", 0));
  }
  return most;
}

/* It swings, and ever less: nodes remember the wall's force as it was at the step's end, not half a step before it, by
 * which the swing would be driven until the block hops. */
static void test_swings(void **state)
{
  static const Block ways[] = {
    {"mpm", "gimp", CELL_QUADRILATERAL, 0.3, NULL, "thesis", PETSC_FALSE, PETSC_FALSE, 0},
    {"mpm", "cell", CELL_QUADRILATERAL, 0.3, NULL, "thesis", PETSC_FALSE, PETSC_FALSE, 0},
    {"mpm", "cell", CELL_TRIANGLE, 0.3, NULL, "thesis", PETSC_TRUE, PETSC_FALSE, 0},
    {"mpm", "bspline", CELL_QUADRILATERAL, 0.3, NULL, "thesis", PETSC_FALSE, PETSC_FALSE, 0}};
  (void)state;
  EACH_OF (k, ways) {
    Bench b;
    WallSpec wall;
    Model *m = shaken(&b, ways + k, &wall);
    const PetscReal first = liveliest(m), second = liveliest(m), third = liveliest(m);
    PetscPrintf(PETSC_COMM_WORLD, "%s: swings with %.4g, %.4g and %.4g J\n", ways[k].basis, (double)first,
                (double)second, (double)third);
    CHECK(third <= second && second <= first, "it is driven: %g J for %g", (double)third, (double)second);
    CALL(ModelDestroy(&m));
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_slides),  cmocka_unit_test(test_lifts),   cmocka_unit_test(test_rests),
    cmocka_unit_test(test_flows),   cmocka_unit_test(test_through), cmocka_unit_test(test_dent),
    cmocka_unit_test(test_smooth),  cmocka_unit_test(test_round),   cmocka_unit_test(test_narrow),
    cmocka_unit_test(test_astride), cmocka_unit_test(test_rises),   cmocka_unit_test(test_swings),
  };
  return run_model_tests_in_turns(argc, argv, tests);
}
