/* Walls that move by what acts on them, against mechanics of rigid bodies: free flight, momentum and energy of
 * collisions in every method, equilibrium under load. */
#include "heavy.h"

typedef struct {
  const char *method, *basis, *scheme;
  CellType cell;
  PetscReal friction;
  PetscBool lumped;
  PetscReal size, step; /* of cells and steps, m, s; 0: some */
} Hit;

/* A block of rubber, 1 x 0.5 (x 0.5) m, and a ball above its top. */
static void below_ball(Bench *b, const Hit *h, PetscBool dynamic, WallSpec *wall)
{
  const PetscBool space = h->cell == CELL_HEXAHEDRON;
  bench_init(b, h->method, h->cell, 0);
  bench_grid(b, (PetscReal[]){-1, space ? -0.5 : -1, -0.5}, (PetscReal[]){3, 2, 1},
             h->size > 0                ? h->size
             : strcmp(h->method, "mpm") ? 0.125
                                        : 0.25);
  bench_box(b, 0, (PetscReal[]){0.5, 0, 0}, (PetscReal[]){1.5, 0.5, 0.5});
  if (dynamic) bench_dynamic(b, 1, 5e-3);
  b->c.analysis.scheme = (char *)h->scheme;
  if (h->scheme && !strcmp(h->scheme, "bossak")) {
    b->c.analysis.bossak = -0.3;
    b->c.analysis.beta = 1.3 * 1.3 / 4;
    b->c.analysis.gamma = 0.8;
  }
  if (h->lumped) b->c.analysis.mass = MASS_LUMPED;
  b->c.basis = (BasisSpec){
    .kind = h->basis, .gamma = 1.8, .effective_radius = 1, .radius = 2, .max_radius = 3.5, .condition = 50, .gap = 2};
  b->c.linear = LINEAR_AUTO;
  b->c.newton = (NewtonSpec){.residual = 1e-11, .increment = 1e-12, .max_iterations = 25, .ease = 6};
  b->c.stabilisation.curvature = 0.1;
  heavy_ball(b, space, 2000, h->friction, wall);
}

/* What the ball loses the block gets, in steps of changing length, and no energy is unaccounted for. */
static void hit(const Hit *h)
{
  const PetscBool space = h->cell == CELL_HEXAHEDRON;
  const int up = space ? 2 : 1;
  const PetscReal mass = 2000 * (space ? 4. / 3 * PETSC_PI * 0.027 : PETSC_PI * 0.09);
  Bench b;
  WallSpec wall;
  below_ball(&b, h, PETSC_TRUE, &wall);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  PetscReal off = 0;
  Energies e;
  const PetscReal end = ranks_of_world() > 1 ? 0.06 : 0.1; /* what ranks spoil they spoil in any step */
  for (PetscInt k = 0; m->time < end; ++k) {
    model_step(m, (k % 3 == 1 ? 0.4 : 1) * (h->step > 0 ? h->step : 5e-3));
    for (PetscInt d = 0; d < m->dim; ++d) {
      const PetscReal before = mass * wall.mass.velocity[d];
      off = PetscMax(off, PetscAbsReal(mass * of_ball(m, "wall_velocity", d) + model_sum(m, "momentum", d) - before));
    }
  }
  CALL(ModelEnergies(m, &e));
  const PetscReal balance = model_sum(m, "energy: balance", 0), given = -model_sum(m, "momentum", up);
  PetscPrintf(PETSC_COMM_WORLD,
              "%s %s %s cell %d mu %g: momentum off %.2g of %.6g, balance %.2g, transfer + numerical "
              "%.4g, friction %.4g of %.6g J, spin %.4g\n",
              h->method, h->basis, h->scheme ? h->scheme : "", (int)h->cell, (double)h->friction, (double)off,
              (double)given, (double)balance, (double)(e.transfer + e.numerical), (double)e.friction, (double)e.start,
              (double)of_ball(m, "wall_spin", 1));
  CHECK(off <= 1e-9 * given && given > 100, "momentum off by %g of %g", (double)off, (double)given);
  CHECK(PetscAbsReal(balance) < 1e-6, "open: %g", (double)balance);
  CHECK(e.transfer + e.numerical + e.friction > 0, "%g J were made", (double)-(e.transfer + e.numerical + e.friction));
  if (h->scheme && !strcmp(h->scheme, "midpoint"))
    CHECK(e.numerical == 0, "%g J by a scheme without damping", (double)e.numerical);
  if (h->size > 0) CHECK(e.transfer + e.numerical > 0.01 * e.start, "%g J were made", (double)-e.transfer);
  if (h->friction == 0) CHECK_CLOSE(of_ball(m, "wall_spin", 0), 2, 1e-9);
  else CHECK(PetscAbsReal(of_ball(m, "wall_spin", space ? 1 : 0) - (space ? 0 : 2)) > 0.1, "friction does not turn it");
  CHECK(model_wall(m, "ball", "contact", "penetration", 0) <= 1e-4 * 0.25, "deep in the wall");
  CALL(ModelDestroy(&m));
}

static void test_hits(void **state)
{
  static const Hit hits[] = {
    {"mpm", "cell", NULL, CELL_QUADRILATERAL, 0, PETSC_FALSE, 0, 0},
    {"mpm", "gimp", NULL, CELL_QUADRILATERAL, 0.3, PETSC_FALSE, 0, 0},
    {"mpm", "gimp", NULL, CELL_QUADRILATERAL, 0.3, PETSC_TRUE, 0, 0},
    {"mpm", "gimp", "midpoint", CELL_QUADRILATERAL, 0.3, PETSC_FALSE, 0, 0},
    {"mpm", "gimp", "bossak", CELL_QUADRILATERAL, 0.3, PETSC_FALSE, 0, 0},
    {"mpm", "cell", NULL, CELL_HEXAHEDRON, 0.3, PETSC_FALSE, 0, 0},
    {"fem", "cell", NULL, CELL_QUADRILATERAL, 0.3, PETSC_FALSE, 0, 0},
    {"fem", "cell", "bossak", CELL_QUADRILATERAL, 0.3, PETSC_FALSE, 0, 0},
    {"gmm", "lme", NULL, CELL_QUADRILATERAL, 0.3, PETSC_FALSE, 0, 0},
    /* over two cells: the nodes that stop are half of all */
    {"fem", "cell", NULL, CELL_QUADRILATERAL, 0.3, PETSC_FALSE, 0.25, 1e-3},
    {"fem", "cell", NULL, CELL_QUADRILATERAL, 0, PETSC_FALSE, 0.25, 1e-3},
    {"fem", "cell", "bossak", CELL_QUADRILATERAL, 0.3, PETSC_FALSE, 0.25, 1e-3},
  };
  (void)state;
  EACH_OF (k, hits) hit(&hits[k]);
}

/* Momentum that the forces make in dt which the last step has left out of balance, at most. */
static PetscReal left_over(const Model *m, PetscReal dt)
{
  const NodalFields *n = m->nodes;
  PetscReal local = 0, sum;
  for (PetscInt node = 0; node < m->grid->n_owned; ++node)
    for (PetscInt d = 0, i = node * m->dim; d < m->dim && n->touched[node]; ++d, ++i)
      local += n->fixed[i] ? 0 : dt * PetscAbsReal(n->force[i]);
  CALL(MPI_Allreduce(&local, &sum, 1, MPIU_REAL, MPIU_SUM, m->comm));
  return sum;
}

/* A ball from above, a box whose corners go into the block from below, and a union whose inertia is given: what they
 * lose the block gets, and no energy is made. */
static void test_several(void **state)
{
  static const Hit ways[] = {{"fem", "cell", NULL, CELL_QUADRILATERAL, 0.3, PETSC_FALSE, 0.125, 2e-3},
                             {"mpm", "gimp", NULL, CELL_QUADRILATERAL, 0.3, PETSC_FALSE, 0.125, 5e-3}};
  (void)state;
  EACH_OF (k, ways) {
    const PetscReal mass[3] = {2000 * PETSC_PI * 0.09, 2000 * 0.05, 200};
    PetscReal off = 0, left = 0, before[2] = {0, 0};
    Bench b;
    WallSpec wall[3];
    Energies e;
    below_ball(&b, &ways[k], PETSC_TRUE, wall);
    wall[1] = wall[2] = wall[0];
    wall[1].name = (char *)"box", wall[1].mass.velocity[1] = 3;
    wall[1].shape = (Shape){.kind = SHAPE_BOX, .min = {0.8481, -0.21}, .max = {1.0981, -0.01}};
    Shape parts[2] = {wall[0].shape, wall[0].shape};
    parts[0].centre[0] = 1.3, parts[1].centre[0] = 1.45;
    for (int i = 0; i < 2; ++i) parts[i].radius = 0.1, parts[i].centre[1] = -0.11;
    wall[2].name = (char *)"two", wall[2].shape = (Shape){.kind = SHAPE_UNION, .n_children = 2, .children = parts};
    wall[2].mass.has_density = PETSC_FALSE, wall[2].mass.has_total = PETSC_TRUE, wall[2].mass.total = mass[2],
    wall[2].mass.velocity[1] = 1;
    wall[2].mass.has_centre = wall[2].mass.has_inertia = PETSC_TRUE;
    wall[2].mass.centre[0] = 1.375, wall[2].mass.centre[1] = -0.11, wall[2].mass.inertia[2] = 2;
    b.c.n_walls = 3, b.c.walls = wall;
    b.c.newton.residual = 1e-13, b.c.newton.increment = 1e-15; /* what Newton's method leaves is momentum */
    for (int i = 0; i < 3; ++i)
      for (int d = 0; d < 2; ++d) before[d] += mass[i] * wall[i].mass.velocity[d];
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    while (m->time < 0.05) {
      PetscReal now[2] = {model_sum(m, "momentum", 0), model_sum(m, "momentum", 1)};
      for (int i = 0; i < 3; ++i)
        for (int d = 0; d < 2; ++d) now[d] += mass[i] * model_wall(m, wall[i].name, "wall_velocity", NULL, d);
      for (int d = 0; d < 2; ++d) off = PetscMax(off, PetscAbsReal(now[d] - before[d]));
      const PetscReal time = m->time;
      model_step(m, ways[k].step);
      left += left_over(m, m->time - time);
    }
    CALL(ModelEnergies(m, &e));
    PetscPrintf(PETSC_COMM_WORLD,
                "%s, three walls: momentum off %.2g of %.2g left over, transfer %.4g, friction %.4g of %.6g J\n",
                ways[k].method, (double)off, (double)left, (double)e.transfer, (double)e.friction, (double)e.start);
    CHECK(off < left + 1e-9, "momentum off by %g", (double)off); /* 1e-12 of what they bring */
    CHECK(left < 1e-5, "Newton's method has left %g", (double)left);
    CHECK(PetscAbsReal(model_sum(m, "energy: balance", 0)) < 1e-6, "energy is lost");
    CHECK(e.transfer > 0, "%g J were made", (double)-e.transfer);
    for (int i = 0; i < 3; ++i)
      CHECK(PetscAbsReal(model_wall(m, wall[i].name, "wall_velocity", NULL, 1) - wall[i].mass.velocity[1]) > 0.01, "%s",
            wall[i].name);
    CALL(ModelDestroy(&m));
  }
}

/* A brick that tumbles in free fall keeps its moment of momentum and energy, and falls as a point does. */
static void test_flies(void **state)
{
  static const Hit far = {"mpm", "cell", NULL, CELL_HEXAHEDRON, 0, PETSC_FALSE, 0, 0};
  PetscReal L[3], found[3], v[3];
  Bench b;
  WallSpec wall;
  (void)state;
  below_ball(&b, &far, PETSC_TRUE, &wall);
  const PetscReal energy = spinning_box(&wall, L);
  b.c.gravity[2] = -9.81;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (PetscInt k = 0; m->time < 0.28; ++k) model_step(m, k % 3 == 1 ? 0.02 : 0.05);
  const RigidWall *ball = m->contact->rigid;
  const PetscReal t = m->time, fallen = -2 * t - 9.81 / 2 * t * t, turned = ball->now.turned[1];
  CHECK_CLOSE(of_ball(m, "wall_position", 2), 3 + fallen, 1e-12);
  CHECK_CLOSE(of_ball(m, "wall_position", 0), 2 + 0.5 * t, 1e-12);
  CHECK_CLOSE(of_ball(m, "wall_velocity", 2), -2 - 9.81 * t, 1e-12);
  for (int d = 0; d < 3; ++d) CHECK_CLOSE(ball->now.L[d], L[d], 1e-12 * L[1]);
  for (int d = 0; d < 3; ++d) found[d] = of_ball(m, "wall_spin", d), v[d] = of_ball(m, "wall_velocity", d);
  PetscReal now = 0;
  for (int d = 0; d < 3; ++d) now += 0.5 * (found[d] * ball->now.L[d] + BOX_MASS * v[d] * v[d]);
  PetscPrintf(PETSC_COMM_WORLD, "it has turned by %.4g, energy off by %.2g of %.6g J\n", (double)turned,
              (double)(now - energy + BOX_MASS * 9.81 * fallen), (double)energy);
  CHECK_CLOSE(now, energy - BOX_MASS * 9.81 * fallen, 1e-10 * energy);
  CHECK(PetscAbsReal(found[0] - 1) > 0.1, "it does not tumble");
  CALL(ModelDestroy(&m));
}

/* A ball that nothing touches turns by its spin times the time, in the plane and about any axis, however far in a
 * step. */
static void test_turns(void **state)
{
  static const Hit ways[] = {{"mpm", "cell", NULL, CELL_QUADRILATERAL, 0, PETSC_FALSE, 0, 0},
                             {"mpm", "gimp", "midpoint", CELL_QUADRILATERAL, 0, PETSC_FALSE, 0, 0},
                             {"mpm", "cell", NULL, CELL_HEXAHEDRON, 0, PETSC_FALSE, 0, 0}};
  (void)state;
  EACH_OF (k, ways) {
    const PetscBool space = ways[k].cell == CELL_HEXAHEDRON;
    const PetscReal spin[3] = {space ? 2 : 0, space ? 10 : 0, space ? -5 : 10};
    Bench b;
    WallSpec wall;
    below_ball(&b, &ways[k], PETSC_TRUE, &wall);
    wall.shape.centre[space ? 2 : 1] = 1.5;
    for (int d = 0; d < 3; ++d) wall.mass.velocity[d] = 0, wall.mass.spin[d] = spin[d];
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    while (m->time < 0.4) model_step(m, m->time > 0.15 ? 0.12 : 0.04);
    const RigidState *now = &m->contact->rigid->now;
    PetscReal along = 0, square = 0;
    for (int d = 0; d < 3; ++d) {
      CHECK_CLOSE(now->turned[d], spin[d] * m->time, 1e-12);
      along += now->R[4 * d], square += PetscSqr(spin[d]);
    }
    CHECK_CLOSE(along, 1 + 2 * PetscCosReal(PetscSqrtReal(square) * m->time), 1e-12);
    CALL(ModelDestroy(&m));
  }
}

/* In statics a footing, with an inclined load at its centre, stands on the block: forces in balance, and their
 * moment. */
static void test_stands(void **state)
{
  static const Hit ways[] = {{"mpm", "gimp", NULL, CELL_QUADRILATERAL, 0.5, PETSC_FALSE, 0, 0},
                             {"fem", "cell", NULL, CELL_QUADRILATERAL, 0.5, PETSC_FALSE, 0, 0},
                             {"gmm", "lme", NULL, CELL_QUADRILATERAL, 0.5, PETSC_FALSE, 0, 0}};
  (void)state;
  EACH_OF (k, ways) {
    Bench b;
    WallSpec wall;
    below_ball(&b, &ways[k], PETSC_FALSE, &wall);
    wall.shape = (Shape){.kind = SHAPE_BOX, .min = {0.73, 0.5}, .max = {1.23, 0.8}};
    for (int d = 0; d < 3; ++d) wall.mass.velocity[d] = wall.mass.spin[d] = 0;
    wall.mass.force[0] = 600, wall.mass.force[1] = -9000;
    b.c.gravity[1] = -9.81;
    bench_motion(&b, 1, 0, MOTION_FIXED, 3);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    while (m->time < 1 - 1e-9) model_step(m, 0.25);
    const PetscReal weight = 9000 + 9.81 * 2000 * 0.15, x = of_ball(m, "wall_position", 0),
                    y = of_ball(m, "wall_position", 1);
    PetscPrintf(PETSC_COMM_WORLD, "%s: %.10g and %.10g N, settled %.4g m, turned %.4g, %d iterations, %d cuts\n",
                ways[k].method, (double)of_ball(m, "wall_force", 0), (double)of_ball(m, "wall_force", 1),
                (double)(0.65 - y), (double)of_ball(m, "wall_angle", 2), (int)m->total_iterations, (int)m->cuts);
    CHECK_CLOSE(of_ball(m, "wall_force", 1), -weight, 1e-8 * weight);
    CHECK_CLOSE(of_ball(m, "wall_force", 0), 600, 1e-8 * weight);
    CHECK(y < 0.65 && x > 0.98, "it has not moved: %g, %g", (double)x, (double)y);
    const PetscReal torque = m->contact->rigid->contact[5]; /* about its centre */
    CHECK(PetscAbsReal(torque) < 1e-8 * weight, "a torque of %g N m is left", (double)torque);
    CHECK(m->cuts == 0, "%d steps were halved", (int)m->cuts);
    CALL(ModelDestroy(&m));
  }
}

/* The same footing above the block, by a cell or by less, so that it is seen: no increment balances its weight, and the
 * report says why. */
static void floats(PetscReal foot)
{
  static const Hit any = {"fem", "cell", NULL, CELL_QUADRILATERAL, 0.5, PETSC_FALSE, 0, 0};
  Bench b;
  WallSpec wall;
  StepReport report;
  below_ball(&b, &any, PETSC_FALSE, &wall);
  wall.shape = (Shape){.kind = SHAPE_BOX, .min = {0.73, foot}, .max = {1.23, foot + 0.3}};
  for (int d = 0; d < 3; ++d) wall.mass.velocity[d] = wall.mass.spin[d] = 0;
  b.c.gravity[1] = -9.81;
  bench_motion(&b, 1, 0, MOTION_FIXED, 3);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  CALL(ModelStep(m, 0.25, &report));
  CHECK(report.outcome != STEP_ACCEPTED, "it hangs in the air");
  CHECK(strstr(report.newton.reason, "the wall with mass 'ball' touches nothing"), "%s", report.newton.reason);
  CALL(ModelDestroy(&m));
}

static void test_floats(void **state)
{
  (void)state;
  floats(0.8);
  floats(0.55);
}

/* Smooth and round, or a plate in space: nothing resists that they turn, or that the plate goes along the block, so
 * they do not. Their angles were round-off over round-off, and the plate was thrown out of the grid. Pushed along the
 * block, or turned, they have no equilibrium, and the report says which way. */
typedef struct {
  Hit hit;
  PetscBool plate;
  const char *pushed; /* along x, or turned about the last axis */
} Smooth;

static void rests(const Smooth *way)
{
  const int up = way->hit.cell == CELL_HEXAHEDRON ? 2 : 1;
  Bench b;
  WallSpec wall;
  StepReport report = {0};
  below_ball(&b, &way->hit, PETSC_FALSE, &wall);
  wall.shape.centre[up] = 0.795;
  if (way->plate) wall.shape = (Shape){.kind = SHAPE_BOX, .min = {0.4, -0.1, 0.5}, .max = {1.6, 0.6, 0.7}};
  for (int d = 0; d < 3; ++d) wall.mass.velocity[d] = wall.mass.spin[d] = 0;
  wall.mass.force[up] = -100;
  if (way->pushed && way->plate) wall.mass.force[0] = 10;
  else if (way->pushed) wall.mass.torque[2] = 10;
  b.c.newton.residual = 1e-8;
  bench_motion(&b, up, 0, MOTION_FIXED, 7);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  while (!way->pushed && m->time < 1 - 1e-9) model_step(m, 0.5);
  if (way->pushed) CALL(ModelStep(m, 0.5, &report));
  const RigidState *now = &m->contact->rigid->now;
  PetscPrintf(PETSC_COMM_WORLD, "%s %d smooth: moved %.2g %.2g %.2g, turned %.2g %.2g %.2g, %d cuts. %s\n",
              way->hit.method, (int)way->plate, (double)now->moved[0], (double)now->moved[1], (double)now->moved[2],
              (double)now->turned[0], (double)now->turned[1], (double)now->turned[2], (int)m->cuts,
              report.newton.reason ? report.newton.reason : "");
  if (way->pushed) {
    CHECK(report.outcome != STEP_ACCEPTED, "something holds it");
    CHECK(strstr(report.newton.reason, way->pushed), "%s", report.newton.reason);
  } else {
    CHECK_CLOSE(of_ball(m, "wall_force", up), -100, 1e-6);
    CHECK(m->cuts == 0, "%d steps were halved", (int)m->cuts);
    for (int d = 0; d < 3; ++d) CHECK_CLOSE(now->turned[d], 0, way->plate && d < 2 ? 1e-3 : 1e-9);
  }
  CALL(ModelDestroy(&m));
}

static void test_rests(void **state)
{
  static const Smooth ways[] = {
    {{"fem", "cell", NULL, CELL_QUADRILATERAL, 0, PETSC_FALSE, 0, 0}, PETSC_FALSE, NULL},

    {{"mpm", "gimp", NULL, CELL_QUADRILATERAL, 0, PETSC_FALSE, 0.125, 0}, PETSC_FALSE, NULL},
    {{"fem", "cell", NULL, CELL_HEXAHEDRON, 0, PETSC_FALSE, 0.125, 0}, PETSC_FALSE, NULL},
    {{"fem", "cell", NULL, CELL_HEXAHEDRON, 0, PETSC_FALSE, 0.25, 0}, PETSC_TRUE, NULL},
    {{"fem", "cell", NULL, CELL_QUADRILATERAL, 0, PETSC_FALSE, 0, 0},
     PETSC_FALSE,
     "a torque about z acts on the wall with mass 'ball'"},
    {{"fem", "cell", NULL, CELL_HEXAHEDRON, 0, PETSC_FALSE, 0.25, 0},
     PETSC_TRUE,
     "a force along x acts on the wall with mass 'ball'"},
  };
  (void)state;
  EACH_OF (k, ways) rests(&ways[k]);
}

/* A smooth plate whose load is off the middle of the block tilts, and stays where it is: it went to where the middle is
 * below the load, which is an equilibrium on its head. */
static void test_tilts(void **state)
{
  static const Hit any = {"fem", "cell", NULL, CELL_HEXAHEDRON, 0, PETSC_FALSE, 0.25, 0};
  Bench b;
  WallSpec wall;
  (void)state;
  below_ball(&b, &any, PETSC_FALSE, &wall);
  wall.shape = (Shape){.kind = SHAPE_BOX, .min = {0.4, -0.05, 0.5}, .max = {1.6, 0.65, 0.7}};
  for (int d = 0; d < 3; ++d) wall.mass.velocity[d] = wall.mass.spin[d] = 0;
  wall.mass.force[2] = -100;
  b.c.newton.residual = 1e-8;
  bench_motion(&b, 2, 0, MOTION_FIXED, 7);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  while (m->time < 1 - 1e-9) model_step(m, 0.5);
  const RigidState *now = &m->contact->rigid->now;
  PetscPrintf(PETSC_COMM_WORLD, "a plate that tilts: moved %.2g %.2g %.2g, turned %.2g %.2g %.2g, force %.8g\n",
              (double)now->moved[0], (double)now->moved[1], (double)now->moved[2], (double)now->turned[0],
              (double)now->turned[1], (double)now->turned[2], (double)of_ball(m, "wall_force", 2));
  CHECK(now->turned[0] < -1e-5, "it does not tilt");
  for (int d = 0; d < 2; ++d) CHECK_CLOSE(now->moved[d], 0, 1e-6);
  CHECK_CLOSE(of_ball(m, "wall_force", 2), -100, 1e-4);
  CALL(ModelDestroy(&m));
}

/* A bar that is bonded to a wall which can turn about its middle falls as a pendulum, by Newmark's rule: what the wall
 * gains is the torque that it is told to have given, and the angle that of the ordinary differential equation. The
 * wall had its torques from where forces ended and the bar from half-way: 29 % less, and 1.7 % of the angle. */
static void test_carries(void **state)
{
  const PetscReal inertia = 4000 * 0.25 * 0.5 * (0.25 * 0.25 + 0.5 * 0.5) / 12, end = 0.5, step = 0.01;
  WallSpec wall = {.name = (char *)"ball",
                   .shape = {.kind = SHAPE_BOX, .min = {-0.125, -0.25}, .max = {0.125, 0.25}},
                   .contact = CONTACT_BONDED,
                   .has_mass = PETSC_TRUE,
                   .mass = {.has_density = PETSC_TRUE, .density = 4000, .free = {[3] = PETSC_TRUE}}};
  PetscReal given = 0;
  Bench b;
  (void)state;
  bench_init(&b, "fem", CELL_QUADRILATERAL, 0);
  bench_grid(&b, (PetscReal[]){0.125, -0.125, 0}, (PetscReal[]){1, 0.125, 1}, 0.125);
  bench_box(&b, 0, (PetscReal[]){0.125, -0.125, 0}, (PetscReal[]){1, 0.125, 1});
  b.constants[0].value = 2e7;
  b.c.gravity[1] = -10;
  b.c.n_walls = 1, b.c.walls = &wall;
  bench_dynamic(&b, end, step);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  while (m->time < end - 1e-9) {
    const PetscReal before = m->time;
    model_step(m, step);
    given -= (m->time - before) * of_ball(m, "wall_torque", 0);
  }
  PetscPrintf(PETSC_COMM_WORLD, "a wall that turns: %.8g N m s for %.8g, angle %.6g\n",
              (double)(inertia * of_ball(m, "wall_spin", 0)), (double)given, (double)of_ball(m, "wall_angle", 0));
  CHECK_CLOSE(inertia * of_ball(m, "wall_spin", 0), given, 1e-5 * PetscAbsReal(given));
  CHECK_CLOSE(of_ball(m, "wall_angle", 0), -1.4630, 2e-3);
  CALL(ModelDestroy(&m));
}

/* A couple turns a plate that is bonded to the end of a bar, and turns it back, in statics: what is bonded goes round
 * with it, and nothing stays of it. By theta across the lever it was pinched by theta^2 / 2 in each step. */
static void test_grips(void **state)
{
  static const Hit ways[] = {{"fem", "cell", NULL, CELL_QUADRILATERAL, 0, PETSC_FALSE, 0, 0},
                             {"mpm", "bspline", NULL, CELL_QUADRILATERAL, 0, PETSC_FALSE, 0, 0},
                             {"fem", "cell", NULL, CELL_HEXAHEDRON, 0, PETSC_FALSE, 0, 0}};
  static PetscReal time[] = {0, 1, 2}, share[] = {0, 1, 0};
  (void)state;
  EACH_OF (k, ways) {
    const PetscBool fem = !strcmp(ways[k].method, "fem");
    const PetscReal beside = fem ? 0 : 0.75;
    Bench b;
    WallSpec wall = {.name = (char *)"ball",
                     .shape = {.kind = SHAPE_BOX, .min = {2, -1, -1}, .max = {3, 1, 1}},
                     .contact = CONTACT_BONDED,
                     .has_mass = PETSC_TRUE};
    wall.mass = (WallMassSpec){.has_total = PETSC_TRUE, .total = 1, .torque = {0, 0, 1e4}, .free = {1, 1, 1, 1}};
    wall.mass.amplitude = (Amplitude){.n = 3, .time = time, .value = share};
    bench_init(&b, ways[k].method, ways[k].cell, 0);
    bench_grid(&b, (PetscReal[]){0, -0.5 - beside, 0}, (PetscReal[]){2 + beside, 0.5 + beside, 0.5}, 0.25);
    bench_box(&b, 0, (PetscReal[]){0, -0.5, 0}, (PetscReal[]){2, 0.5, 0.5});
    b.c.basis.kind = ways[k].basis;
    b.constants[1].value = 0;
    b.c.newton.residual = 1e-9;
    b.c.n_walls = 1, b.c.walls = &wall;
    bench_motion(&b, 0, 0, MOTION_FIXED, 7);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    PetscReal most = 0;
    while (m->time < 2 - 1e-9) {
      model_step(m, 0.05);
      most = PetscMax(most, model_sum(m, "energy: elastic", 0));
    }
    const PetscReal left = model_sum(m, "energy: elastic", 0), angle = of_ball(m, "wall_angle", 2);
    PetscPrintf(PETSC_COMM_WORLD, "%s: %.4g J, then %.4g J and %.3g rad\n", ways[k].method, (double)most, (double)left,
                (double)angle);
    CHECK(most > 500 && left < 1e-5 * most, "%g J are left of %g", (double)left, (double)most);
    CHECK_CLOSE(angle, 0, 1e-4);
    CALL(ModelDestroy(&m));
  }
}

/* Nobody knows the mass of half of space. */
static void test_endless(void **state)
{
  static const Hit any = {"mpm", "cell", NULL, CELL_QUADRILATERAL, 0, PETSC_FALSE, 0, 0};
  Bench b;
  WallSpec wall;
  (void)state;
  below_ball(&b, &any, PETSC_TRUE, &wall);
  wall.shape = (Shape){.kind = SHAPE_HALF_SPACE, .point = {0, -1}, .normal = {0, 1}};
  bench_refused(&b, PETSC_COMM_WORLD, "walls[0].mass", "cannot be computed from its shape");
}

/* Of a union nobody knows the centre: where one asks for its position it is to be given. */
static void test_centreless(void **state)
{
  static const Hit any = {"mpm", "cell", NULL, CELL_QUADRILATERAL, 0, PETSC_FALSE, 0, 0};
  Bench b;
  WallSpec wall;
  (void)state;
  below_ball(&b, &any, PETSC_TRUE, &wall);
  Shape parts[2] = {wall.shape, wall.shape};
  parts[0].centre[0] += 0.2;
  wall.shape = (Shape){.kind = SHAPE_UNION, .n_children = 2, .children = parts};
  wall.mass.free[3] = PETSC_FALSE;
  wall.mass.has_density = PETSC_FALSE, wall.mass.has_total = PETSC_TRUE, wall.mass.total = 10;
  b.measure[b.c.n_measures++] = (MeasureSpec){.name = "y", .kind = (char *)"wall_position", .wall = wall.name};
  bench_refused(&b, PETSC_COMM_WORLD, "walls[0].mass", "the centre of mass of wall 'ball' cannot be computed");
  wall.mass.has_centre = PETSC_TRUE, wall.mass.centre[0] = 1.1, wall.mass.centre[1] = 0.9;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  CHECK_CLOSE(of_ball(m, "wall_position", 0), 1.1, 1e-14);
  CHECK_CLOSE(of_ball(m, "wall_position", 1), 0.9, 1e-14);
  CALL(ModelDestroy(&m));
}

static void test_comes_and_goes(void **state)
{
  static const Hit ways[] = {{"mpm", "cell", NULL, CELL_QUADRILATERAL, 0, PETSC_FALSE, 0, 0},
                             {"fem", "cell", NULL, CELL_QUADRILATERAL, 0, PETSC_FALSE, 0, 0}};
  (void)state;
  EACH_OF (k, ways) {
    Bench b;
    WallSpec wall;
    below_ball(&b, &ways[k], PETSC_TRUE, &wall);
    heavy_comes_and_goes(&b, &wall);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_hits),           cmocka_unit_test(test_several),    cmocka_unit_test(test_flies),
    cmocka_unit_test(test_turns),          cmocka_unit_test(test_stands),     cmocka_unit_test(test_floats),
    cmocka_unit_test(test_endless),        cmocka_unit_test(test_centreless), cmocka_unit_test(test_carries),
    cmocka_unit_test(test_rests),          cmocka_unit_test(test_tilts),      cmocka_unit_test(test_grips),
    cmocka_unit_test(test_comes_and_goes),
  };
  return run_model_tests_in_turns(argc, argv, tests);
}
