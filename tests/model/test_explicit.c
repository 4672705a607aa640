/* Explicit dynamics: what it keeps to round-off, a bar against the exact solution of the wave equation, the same
 * answers on any number of ranks and after a resumed run, and what it refuses. */
#include "model/explicit/explicit.h"
#include "resumed.h"

static void explicit_case(Bench *b, PetscReal end, PetscReal step)
{
  bench_dynamic(b, end, step);
  b->c.analysis.type = ANALYSIS_EXPLICIT;
  b->c.analysis.courant = 0.5;
  b->c.basis.kind = "cell";
}

/* A block that flies and spins, off the grid's lines: nothing acts on it. */
static void flying(Bench *b, CellType cell, const char *basis, const Kinematics *kinematics)
{
  const PetscReal h = cell == CELL_HEXAHEDRON ? 0.25 : 0.125;
  bench_init(b, "mpm", cell, 0);
  b->c.kinematics = kinematics;
  bench_grid(b, (PetscReal[]){kinematics->hoop ? 0 : -1.03, -1.01, -1.02}, (PetscReal[]){1.97, 1.99, 1.98}, h);
  for (int d = 0; d < kinematics_dim(kinematics); ++d)
    b->c.grid.counts[d] = (PetscInt)((b->c.grid.max[d] - b->c.grid.min[d]) / h + 0.5);
  bench_box(b, 0, (PetscReal[]){kinematics->hoop ? 0.3 : 0, 0, 0}, (PetscReal[]){1, 1, 1});
  explicit_case(b, 0.05, 5e-3);
  b->c.basis.kind = basis;
  b->body[0].velocity[1] = 3;
  if (kinematics->hoop) return;
  b->body[0].velocity[0] = -2;
  b->body[0].spin[2] = 4;
  b->body[0].spin_centre[0] = b->body[0].spin_centre[1] = 0.5;
}

static const struct {
  CellType cell;
  const char *basis;
  const Kinematics *kinematics;
} flights[] = {{CELL_QUADRILATERAL, "cell", &kinematics_plane_strain},
               {CELL_QUADRILATERAL, "gimp", &kinematics_plane_strain},
               {CELL_TRIANGLE, "cell", &kinematics_plane_strain},
               {CELL_QUADRILATERAL, "cell", &kinematics_axisymmetric},
               {CELL_QUADRILATERAL, "gimp", &kinematics_axisymmetric},
               {CELL_HEXAHEDRON, "cell", &kinematics_3d},
               {CELL_HEXAHEDRON, "gimp", &kinematics_3d}};

/* Mass and momentum to round-off, and the balance of energies closes with a small loss in the transfer. */
static void test_flight(void **state)
{
  (void)state;
  EACH_OF (k, flights) {
    Bench b;
    Energies e;
    PetscReal before[3], off = 0;
    flying(&b, flights[k].cell, flights[k].basis, flights[k].kinematics);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    const PetscReal mass = model_sum(m, "mass: total", 0);
    for (int d = 0; d < m->dim; ++d) before[d] = model_sum(m, "momentum", d);
    for (int s = 0; s < 6; ++s) model_step(m, PETSC_MAX_REAL);
    for (int d = b.c.kinematics->hoop; d < m->dim; ++d)
      off = PetscMax(off, PetscAbsReal(model_sum(m, "momentum", d) - before[d]));
    CALL(ModelEnergies(m, &e));
    PetscPrintf(PETSC_COMM_WORLD, "%s %s: momentum off by %.2g, transfer %.3g of %.3g J, %d substeps\n",
                b.c.kinematics->name, flights[k].basis, (double)(off / mass), (double)e.transfer, (double)e.start,
                (int)m->total_iterations);
    CHECK(off <= 1e-11 * mass, "momentum is off by %g", (double)off);
    CHECK_CLOSE(model_sum(m, "mass: total", 0), mass, 1e-12 * mass);
    CHECK_CLOSE(e.kinetic + e.elastic + e.dissipated + e.transfer, e.start, 1e-9 * e.start);
    CHECK(e.transfer > -0.01 * e.start && e.transfer < 0.2 * e.start, "%g of %g J were lost", (double)e.transfer,
          (double)e.start);
    CALL(ModelDestroy(&m));
  }
}

/* A block that turns while it flies goes on turning, and rings no more than it is strained. */
static void test_turns(void **state)
{
  (void)state;
  EACH_OF (k, flights) {
    Bench b;
    Energies e;
    if (flights[k].kinematics->hoop) continue;
    flying(&b, flights[k].cell, flights[k].basis, flights[k].kinematics);
    b.c.analysis.transfer = (char *)"consistent";
    b.body[0].velocity[0] = b.body[0].velocity[1] = -1;
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    const PetscReal before = model_sum(m, "spin", 2);
    while (m->time < 0.6) model_step(m, 0.02);
    CALL(ModelEnergies(m, &e));
    PetscPrintf(PETSC_COMM_WORLD, "%s %s: spin %.5g of %.5g, transfer %.3g, elastic %.3g of %.4g J\n",
                b.c.kinematics->name, flights[k].basis, (double)model_sum(m, "spin", 2), (double)before,
                (double)e.transfer, (double)e.elastic, (double)e.start);
    CHECK_CLOSE(model_sum(m, "spin", 2), before, 0.006 * before);
    CHECK(e.elastic < 0.003 * e.start, "it rings with %g J", (double)e.elastic);
    CALL(ModelDestroy(&m));
  }
}

/* Damping takes turning as it takes flight. */
static void test_turns_damped(void **state)
{
  (void)state;
  EACH_OF (k, flights) {
    Bench b;
    if (flights[k].kinematics->hoop) continue;
    flying(&b, flights[k].cell, flights[k].basis, flights[k].kinematics);
    b.c.analysis.transfer = (char *)"consistent";
    b.c.analysis.damping = 5;
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    const PetscReal spin = model_sum(m, "spin", 2), momentum = model_sum(m, "momentum", 0);
    while (m->time < 0.2) model_step(m, 0.02);
    const PetscReal left = PetscExpReal(-5 * m->time);
    PetscPrintf(PETSC_COMM_WORLD, "%s %s: %.5g of its spin is left, %.5g of momentum, of %.5g\n", b.c.kinematics->name,
                flights[k].basis, (double)(model_sum(m, "spin", 2) / spin),
                (double)(model_sum(m, "momentum", 0) / momentum), (double)left);
    CHECK_CLOSE(model_sum(m, "momentum", 0), left * momentum, 1e-9 * PetscAbsReal(momentum));
    CHECK_CLOSE(model_sum(m, "spin", 2), left * spin, 0.03 * left * spin);
    CALL(ModelDestroy(&m));
  }
}

/* An elastic bar of length 1 m between smooth walls runs into its floor: it stays there for 2 L / c, which
 * presses with rho c v, and leaves with -v. The grid's lines are not the bar's. */
typedef struct {
  PetscReal stress, impulse, velocity, transfer;
} Bounce;

static Bounce bounce(PetscInt n, ExplicitUpdate update, const char *basis)
{
  const PetscReal c = PetscSqrtReal(1e6 * 0.7 / (1.3 * 0.4) / 1000), v = 1e-3 * c, h = 1. / (PetscReal)n;
  const MeasureSpec reaction = {.kind = "reaction", .component = 1};
  Bench b;
  Energies e;
  Bounce r = {0};
  PetscReal force;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 0);
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){2 * h, 1.5, 0}, h);
  bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){2 * h, 1, 0});
  explicit_case(&b, 3 / c, 0.05 / c);
  b.c.basis.kind = basis;
  b.c.analysis.update = update;
  b.body[0].velocity[1] = -v;
  bench_motion(&b, 1, 0, MOTION_FIXED, 2);
  bench_motion(&b, 0, 0, MOTION_FIXED, 1);
  bench_motion(&b, 0, 2 * h, MOTION_FIXED, 1);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (int s = 0; s < 40; ++s) {
    model_step(m, PETSC_MAX_REAL);
    CALL(ModelMeasure(m, &reaction, 0, &force));
    r.impulse += 0.05 / c * force / (2 * h);
    if (s >= 10 && s < 30) r.stress += force / (20 * 2 * h);
  }
  r.stress /= 1000 * c * v;
  r.impulse /= 2 * 1000 * v;
  r.velocity = model_sum(m, "momentum", 1) / (1000 * 2 * h * v);
  CALL(ModelEnergies(m, &e));
  r.transfer = e.transfer / e.start;
  CALL(ModelDestroy(&m));
  return r;
}

/* Dispersion spreads a front over h (L / h)^(1/3): what the impulse lacks at 2 L / c shrinks like h^(2/3). */
static void test_bounce(void **state)
{
  static const char *const bases[] = {"cell", "gimp"};
  (void)state;
  for (int k = 0; k < 2; ++k) {
    const Bounce coarse = bounce(20, EXPLICIT_MUSL, bases[k]), fine = bounce(40, EXPLICIT_MUSL, bases[k]);
    PetscPrintf(PETSC_COMM_WORLD, "%s: stress %.4f %.4f, impulse until 2 L / c %.4f %.4f, transfer %.3g %.3g\n",
                bases[k], (double)coarse.stress, (double)fine.stress, (double)coarse.impulse, (double)fine.impulse,
                (double)coarse.transfer, (double)fine.transfer);
    CHECK_CLOSE(coarse.stress, 1, 0.002);
    CHECK_CLOSE(fine.stress, 1, 0.002);
    CHECK_CLOSE((1 - fine.impulse) / (1 - coarse.impulse), pow(2, -2. / 3), 0.05);
    CHECK_CLOSE(coarse.velocity, 2 * coarse.impulse - 1, 1e-6);
    CHECK(1 - fine.impulse < 0.025 && fine.transfer < 0.025, "%g of the energy was lost", (double)fine.transfer);
  }
  const Bounce usl = bounce(20, EXPLICIT_USL, "cell");
  CHECK_CLOSE(usl.stress, 1, 0.002);
}

/* A block that falls on its floor, with a tracer, a traction and a floor that moves. */
static void falling(Bench *b, CellType cell, PetscBool loaded)
{
  const PetscReal h = cell == CELL_HEXAHEDRON ? 0.25 : 0.125;
  bench_init(b, "mpm", cell, 0);
  bench_grid(b, (PetscReal[]){-0.5, 0, -0.5}, (PetscReal[]){1.5, 2, 1.5}, h);
  bench_box(b, 0, (PetscReal[]){0, 0.25, 0}, (PetscReal[]){1, 1.25, 1});
  explicit_case(b, 1, 5e-3);
  b->c.gravity[1] = -9.81;
  b->c.analysis.damping = 0.5;
  b->c.analysis.transfer = (char *)(loaded ? "thesis" : "consistent");
  b->body[0].velocity[0] = 4;
  b->body[0].velocity[1] = -5;
  bench_motion(b, 1, 0, MOTION_VELOCITY, 7)->value[0] = 0.5;
  bench_tracer(b, "displacement", 1, 0.9, 1.2, 0.5);
  if (loaded) bench_traction(b, 1, 1.25, "body", 300, -1000, 0);
}

static void test_ranks(void **state)
{
  static const PointReal fields[] = {POINT_X, POINT_V, POINT_F, POINT_TAU, POINT_STATE};
  (void)state;
  for (int k = 0; k < 3; ++k) {
    Bench b;
    PetscReal v[2];
    falling(&b, k == 2 ? CELL_HEXAHEDRON : CELL_QUADRILATERAL, k == 1);
    Model *together = bench_model(&b, PETSC_COMM_WORLD), *alone = bench_model(&b, PETSC_COMM_SELF);
    for (int s = 0; s < 12; ++s) {
      model_step(together, PETSC_MAX_REAL);
      model_step(alone, PETSC_MAX_REAL);
    }
    for (size_t f = 0; f < PETSC_STATIC_ARRAY_LENGTH(fields); ++f) {
      const PetscReal off = points_difference(together, alone, fields[f]);
      CHECK(off <= (fields[f] == POINT_TAU ? 1e-2 : 1e-8), "field %d is off by %g", (int)fields[f], (double)off);
    }
    CALL(ModelMeasure(together, &b.measure[0], 0, &v[0]));
    CALL(ModelMeasure(alone, &b.measure[0], 0, &v[1]));
    CHECK_CLOSE(v[0], v[1], 1e-9);
    CHECK(v[0] < -0.2, "the tracer moved by %g", (double)v[0]);
    CALL(ModelDestroy(&together));
    CALL(ModelDestroy(&alone));
  }
}

/* Mass that doubles weighs twice as much in the end, and all energy is told. */
static void test_ages(void **state)
{
  PetscReal time[] = {0, 0.05}, value[] = {1, 2};
  NamedAmplitude amplitude = {.name = (char *)"density", .amplitude = {.n = 2, .time = time, .value = value}};
  Bench b;
  (void)state;
  flying(&b, CELL_QUADRILATERAL, "cell", &kinematics_plane_strain);
  b.material.n_amplitudes = 1;
  b.material.amplitudes = &amplitude;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  const PetscReal mass = model_sum(m, "mass: total", 0), momentum = model_sum(m, "momentum", 1);
  for (int s = 0; s < 12; ++s) model_step(m, PETSC_MAX_REAL);
  CHECK_CLOSE(model_sum(m, "mass: total", 0), 2 * mass, 1e-9 * mass);
  CHECK_CLOSE(model_sum(m, "momentum", 1), 2 * momentum, 1e-9 * momentum);
  CHECK(PetscAbsReal(model_sum(m, "energy: balance", 0)) < 1e-12, "open");
  CALL(ModelDestroy(&m));
}

/* Largest difference of points that have changed ranks alike. */
static PetscReal points_apart(const Model *a, const Model *b, PointReal field)
{
  PetscReal most = 0;
  CHECK(a->points->n == b->points->n, "points differ");
  for (PetscInt p = 0; p < a->points->n; ++p) {
    CHECK(a->points->id[p] == b->points->id[p], "points stand in another order");
    for (PetscInt i = 0; i < a->points->components[field]; ++i)
      most = PetscMax(most, PetscAbsReal(point_real(a->points, field, p)[i] - point_real(b->points, field, p)[i]));
  }
  return model_max(a, most);
}

/* Walks by cells against those over any grid, in which every substep finds its functions anew: grains under rubber
 * that fall on their floor; points in numbers that no register divides. */
typedef struct {
  CellType cell;
  const Kinematics *kinematics;
  ExplicitUpdate update;
  const char *transfer, *basis;
} Walk;

static void layers(Bench *b, MaterialSpec materials[2], const Walk *walk, int loads)
{
  static NamedValue grains[] = {
    {"young", 1e6}, {"poisson", 0.3}, {"friction_angle", 30}, {"dilatancy_angle", 5}, {"cohesion", 0}};
  const PetscBool space = walk->cell == CELL_HEXAHEDRON, hoop = walk->kinematics->hoop;
  const PetscReal h = space ? 0.25 : 0.125, start = hoop ? 2 * h : 0, end = start + (space ? 3 : 5) * h;
  falling(b, walk->cell, PETSC_FALSE);
  b->c.n_measures = 0;
  b->motion[0].component[0] = !hoop;
  b->c.kinematics = walk->kinematics;
  b->c.analysis.update = walk->update;
  b->c.analysis.transfer = (char *)walk->transfer;
  b->c.basis.kind = walk->basis;
  b->c.grid.min[0] = hoop ? 0 : -2 * h;
  b->c.grid.counts[0] = (PetscInt)((b->c.grid.max[0] - b->c.grid.min[0]) / h + 0.5);
  materials[0] = b->material;
  materials[1] =
    (MaterialSpec){.name = "grains", .law = "mohr-coulomb", .density = 2000, .n_parameters = 5, .parameters = grains};
  b->c.materials = materials;
  b->c.n_materials = b->c.n_bodies = 2;
  b->body[0].points_per_cell = space ? 27 : 9;
  b->body[1] = b->body[0];
  b->body[1].name = "below";
  b->body[1].material = "grains";
  bench_box(b, 0, (PetscReal[]){start, 4 * h, 0}, (PetscReal[]){end, 5 * h, 3 * h});
  bench_box(b, 1, (PetscReal[]){start, 0, 0}, (PetscReal[]){end, 4 * h, 3 * h});
  for (int k = 0; k < loads; ++k)
    bench_traction(b, 1, 5 * h, "body", 300, -1000, 0)->kind = k ? LOAD_PRESSURE : LOAD_TRACTION;
}

static void test_walks(void **state)
{
  static const Walk walks[] = {{CELL_QUADRILATERAL, &kinematics_plane_strain, EXPLICIT_MUSL, NULL, "cell"},
                               {CELL_QUADRILATERAL, &kinematics_plane_strain, EXPLICIT_USL, NULL, "cell"},
                               {CELL_QUADRILATERAL, &kinematics_axisymmetric, EXPLICIT_MUSL, NULL, "cell"},
                               {CELL_HEXAHEDRON, &kinematics_3d, EXPLICIT_MUSL, NULL, "cell"},
                               {CELL_QUADRILATERAL, &kinematics_plane_strain, EXPLICIT_MUSL, "consistent", "cell"},
                               {CELL_QUADRILATERAL, &kinematics_axisymmetric, EXPLICIT_MUSL, "consistent", "cell"},
                               {CELL_HEXAHEDRON, &kinematics_3d, EXPLICIT_MUSL, "consistent", "cell"},
                               {CELL_QUADRILATERAL, &kinematics_plane_strain, EXPLICIT_MUSL, NULL, "gimp"},
                               {CELL_QUADRILATERAL, &kinematics_plane_strain, EXPLICIT_USL, NULL, "gimp"},
                               {CELL_QUADRILATERAL, &kinematics_plane_strain, EXPLICIT_MUSL, "consistent", "gimp"},
                               {CELL_QUADRILATERAL, &kinematics_axisymmetric, EXPLICIT_USL, NULL, "gimp"},
                               {CELL_QUADRILATERAL, &kinematics_axisymmetric, EXPLICIT_MUSL, "consistent", "gimp"}};
  static const struct {
    PointReal field;
    PetscReal noise;
  } fields[] = {{POINT_X, 1e-14}, {POINT_U, 1e-14},  {POINT_V, 1e-12},    {POINT_A, 1e-9},      {POINT_F, 1e-13},
                {POINT_J, 1e-13}, {POINT_TAU, 1e-7}, {POINT_WORK, 1e-11}, {POINT_STATE, 1e-13}, {POINT_SLOPE, 1e-11}};
  (void)state;
  EACH_OF (k, walks) {
    MaterialSpec materials[2];
    Bench b;
    layers(&b, materials, &walks[k], (int)k % 3); /* none, a traction, a traction and a pressure */
    Model *fast = bench_model(&b, PETSC_COMM_WORLD), *plain = bench_model(&b, PETSC_COMM_WORLD);
    CALL(ExplicitCreate(plain, &plain->explicit));
    plain->explicit->box = PETSC_FALSE;
    for (int s = 0; s < 10; ++s) {
      model_step(fast, PETSC_MAX_REAL);
      model_step(plain, PETSC_MAX_REAL);
    }
    CHECK(fast->explicit->box && fast->total_iterations == plain->total_iterations, "other substeps");
    PetscPrintf(PETSC_COMM_WORLD, "%s %s, %d substeps:", walks[k].basis, b.c.kinematics->name,
                (int)fast->total_iterations);
    for (size_t f = 0; f < PETSC_STATIC_ARRAY_LENGTH(fields); ++f) {
      const PetscReal off = points_apart(fast, plain, fields[f].field);
      PetscPrintf(PETSC_COMM_WORLD, " %.2g", (double)off);
      CHECK(off <= fields[f].noise, "field %d is off by %g", (int)fields[f].field, (double)off);
    }
    PetscPrintf(PETSC_COMM_WORLD, "\n");
    CHECK_CLOSE(fast->transfer_energy, plain->transfer_energy, 1e-10 + 1e-13 * PetscAbsReal(plain->transfer_energy));
    CALL(ModelDestroy(&fast));
    CALL(ModelDestroy(&plain));
  }
}

/* Put away and taken up again: the same bits. */
static void test_resumed(void **state)
{
  Bench b;
  (void)state;
  falling(&b, CELL_QUADRILATERAL, PETSC_FALSE);
  Model *m = bench_model(&b, PETSC_COMM_WORLD), *again = bench_model(&b, PETSC_COMM_WORLD);
  for (int s = 0; s < 4; ++s) model_step(m, PETSC_MAX_REAL);
  model_take_up(m, again);
  models_go_on(m, again, 4);
  CALL(ModelDestroy(&m));
  CALL(ModelDestroy(&again));
}

/* A block that turns under a pressure on one of its sides: the push turns with it. */
static void test_pressed(void **state)
{
  static const CellType cell[] = {CELL_QUADRILATERAL, CELL_TRIANGLE};
  const PetscReal rate = 0.5 * PETSC_PI / 0.4, push = 1000;
  (void)state;
  for (int k = 0; k < 2; ++k) {
    Bench b;
    bench_init(&b, "mpm", cell[k], 0);
    bench_grid(&b, (PetscReal[]){-1, -1, 0}, (PetscReal[]){2, 2, 0}, 0.125);
    bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 1, 0});
    explicit_case(&b, 1, 5e-3);
    b.c.analysis.transfer = (char *)"consistent";
    b.body[0].spin[2] = rate;
    b.body[0].spin_centre[0] = b.body[0].spin_centre[1] = 0.5;
    bench_traction(&b, 0, 1, "body", push, 0, 0)->kind = LOAD_PRESSURE;
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    while (m->time < 0.4 - 1e-9) model_step(m, PETSC_MAX_REAL);
    for (PetscInt d = 0; d < 2; ++d) CHECK_CLOSE(model_sum(m, "momentum", d), -push / rate, 0.02 * push / rate);
    CHECK(m->explicit->box == (cell[k] == CELL_QUADRILATERAL), "in laps");
    CHECK(PetscAbsReal(model_sum(m, "energy: balance", 0)) < 1e-12, "open");
    CALL(ModelDestroy(&m));
  }
}

/* A cylinder is pulled at its side, which lies on a line of the grid and is drawn into cells that points do not reach
 * yet: forces stay with it, and its motion is that of implicit steps. */
static void test_pulled(void **state)
{
  static const char *const bases[] = {"cell", "gimp", "bspline"};
  (void)state;
  for (int k = 0; k < 3; ++k) {
    PetscReal far[2], work[2];
    for (int implicit = 0; implicit < 2; ++implicit) {
      Bench b;
      Energies e;
      bench_init(&b, "mpm", CELL_QUADRILATERAL, 0);
      b.c.kinematics = &kinematics_axisymmetric;
      bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){1.5, 1.5, 0}, 0.125);
      bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 1, 0});
      explicit_case(&b, 1, implicit ? 1e-3 : 4e-3);
      if (implicit) b.c.analysis.type = ANALYSIS_DYNAMIC, b.c.analysis.scheme = (char *)"midpoint";
      b.c.basis.kind = bases[k];
      b.c.analysis.transfer = (char *)"consistent";
      bench_motion(&b, 1, 0, MOTION_FIXED, 2);
      bench_motion(&b, 0, 0, MOTION_FIXED, 1);
      bench_traction(&b, 0, 1, "body", 2e4, 0, 0);
      bench_tracer(&b, "displacement", 0, 0.9, 0.6, 0);
      Model *m = bench_model(&b, PETSC_COMM_WORLD);
      while (m->time < 0.04 - 1e-9) model_step(m, PETSC_MAX_REAL);
      CALL(ModelMeasure(m, &b.measure[0], 0, &far[implicit]));
      CALL(ModelEnergies(m, &e));
      work[implicit] = e.external;
      CALL(ModelDestroy(&m));
    }
    PetscPrintf(PETSC_COMM_WORLD, "%s: pulled by %.5g m with %.5g J, implicitly %.5g m, %.5g J\n", bases[k],
                (double)far[0], (double)work[0], (double)far[1], (double)work[1]);
    CHECK_CLOSE(far[0], far[1], 0.05 * far[1]);
    CHECK(work[0] > 0.9 * work[1] && work[0] < 1.5 * work[1], "%g J of work, not %g", (double)work[0], (double)work[1]);
  }
}

#define SHAKEN 0.02 /* s */
static void ramp(void *context, PetscInt n, const PetscReal *X, const PetscReal *x, PetscReal t, PetscReal *b)
{
  (void)context;
  (void)X;
  (void)x;
  for (PetscInt i = 0; i < n; ++i) b[3 * i] = 3 * t / SHAKEN, b[3 * i + 1] = -10 * t / SHAKEN;
}

/* A block that stands on held nodes under gravity that grows, or under the same as a body force: work, J, motion, m. */
static void shake(const char *basis, CellType cell, ExplicitUpdate update, PetscBool force, PetscReal found[2])
{
  Bench b;
  Energies e;
  bench_init(&b, "mpm", cell, 0);
  bench_grid(&b, (PetscReal[]){-1, 0, -1}, (PetscReal[]){2, 2, 2}, 0.25);
  explicit_case(&b, SHAKEN, 2e-3);
  b.c.basis.kind = basis;
  b.c.analysis.update = update;
  for (int d = 0; d < 2 && !force; ++d) b.c.gravity[d] = d ? -10 : 3;
  b.c.gravity_amplitude = (Amplitude){.n = 2, .time = (PetscReal[]){0, SHAKEN}, .value = (PetscReal[]){0, 1}};
  bench_motion(&b, 1, 0, MOTION_FIXED, 7);
  bench_tracer(&b, "displacement", 1, 0.5, 0.9, 0.5);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  if (force) CALL(ModelSetBodyForce(m, ramp, NULL));
  while (m->time < SHAKEN - 1e-9) model_step(m, PETSC_MAX_REAL);
  CALL(ModelEnergies(m, &e));
  CALL(ModelMeasure(m, &b.measure[0], 0, &found[1]));
  found[0] = e.external;
  CALL(ModelDestroy(&m));
}

/* The work of a body force is that along the way of the points, also where nodes are held. */
static void test_work_of_a_body_force(void **state)
{
  static const struct {
    const char *basis;
    CellType cell;
    ExplicitUpdate update;
  } variants[] = {{"gimp", CELL_QUADRILATERAL, EXPLICIT_MUSL},
                  {"cell", CELL_QUADRILATERAL, EXPLICIT_MUSL},
                  {"cell", CELL_QUADRILATERAL, EXPLICIT_USL},
                  {"bspline", CELL_QUADRILATERAL, EXPLICIT_MUSL},
                  {"gimp", CELL_HEXAHEDRON, EXPLICIT_MUSL}};
  (void)state;
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(variants); ++k) {
    PetscReal weight[2], force[2];
    shake(variants[k].basis, variants[k].cell, variants[k].update, PETSC_FALSE, weight);
    shake(variants[k].basis, variants[k].cell, variants[k].update, PETSC_TRUE, force);
    PetscPrintf(PETSC_COMM_WORLD, "%s: %.8g J and %.8g m by gravity, %.8g J and %.8g m by a force\n", variants[k].basis,
                (double)weight[0], (double)weight[1], (double)force[0], (double)force[1]);
    CHECK_CLOSE(force[1], weight[1], 1e-5 * PetscAbsReal(weight[1]));
    CHECK_CLOSE(force[0], weight[0], 2e-5 * weight[0]);
  }
}

/* A block that flies over the lines of the grid and is pushed from behind: what comes in is what it has then. */
static void test_work_in_flight(void **state)
{
  static const char *const bases[] = {"cell", "gimp", "bspline"};
  (void)state;
  EACH_OF (k, bases) {
    Bench b;
    Energies e;
    bench_init(&b, "mpm", CELL_QUADRILATERAL, 0);
    bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){4, 2, 0}, 0.25);
    bench_box(&b, 0, (PetscReal[]){0.5, 0.5, 0}, (PetscReal[]){1.5, 1.5, 0});
    explicit_case(&b, 1, 2e-3);
    b.c.basis.kind = bases[k];
    b.body[0].velocity[0] = 30;
    bench_traction(&b, 0, 0.5, "body", 2000, 0, 0);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    while (m->time < 0.04 - 1e-9) model_step(m, PETSC_MAX_REAL);
    CALL(ModelEnergies(m, &e));
    const PetscReal exact = 2000 * (30 * 0.04 + 0.5 * 2 * PetscSqr(0.04)); /* of a rigid block, J */
    PetscPrintf(PETSC_COMM_WORLD, "%s: %.8g J for %.8g\n", bases[k], (double)e.external, (double)exact);
    CHECK_CLOSE(e.external, exact, 2e-3 * exact);
    CALL(ModelDestroy(&m));
  }
}

static void test_refused(void **state)
{
  Bench b;
  (void)state;
  bench_init(&b, "fem", CELL_QUADRILATERAL, 4);
  explicit_case(&b, 1, 0.1);
  bench_refused(&b, PETSC_COMM_WORLD, "method", "does not take methods other than mpm");
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 4);
  explicit_case(&b, 1, 0.1);
  b.c.formulation = (char *)"mixed";
  bench_refused(&b, PETSC_COMM_WORLD, "formulation", "the mixed formulation");
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 4);
  explicit_case(&b, 1, 0.1);
  b.c.analysis.transfer = (char *)"consistent";
  b.c.analysis.update = EXPLICIT_USL;
  bench_refused(&b, PETSC_COMM_WORLD, "analysis.update", "does not take transfer consistent");
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_flight),
                                     cmocka_unit_test(test_turns),
                                     cmocka_unit_test(test_turns_damped),
                                     cmocka_unit_test(test_bounce),
                                     cmocka_unit_test(test_ranks),
                                     cmocka_unit_test(test_walks),
                                     cmocka_unit_test(test_resumed),
                                     cmocka_unit_test(test_ages),
                                     cmocka_unit_test(test_pressed),
                                     cmocka_unit_test(test_pulled),
                                     cmocka_unit_test(test_work_of_a_body_force),
                                     cmocka_unit_test(test_work_in_flight),
                                     cmocka_unit_test(test_refused)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
