/* The meshfree method as a whole: uniform deformation on random clouds in both bases, constraints
 * that hold where shape functions do not interpolate, reactions, free flight, turning, contact, and
 * the same answers on one rank and on many, also when nodes and points change their ranks. */
#include "case_builder.h"
#include "clouds.h"
#include "method/gmm/gmm.h"

static void gmm_init(Bench *b, const BasisSpec *basis, CellType cell, PetscReal size)
{
  bench_init(b, "gmm", cell, 0);
  bench_grid(b, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 1, 1}, size);
  b->c.basis = *basis;
}

/* --- uniform deformation --- */
static void affine_motion(void *context, const PetscReal *x, PetscReal t0, PetscReal t1, PetscReal *increment)
{
  static const PetscReal H[9] = {0.12, 0.15, -0.06, -0.08, -0.1, 0.11, 0.05, -0.09, 0.2};
  const PetscInt dim = *(const PetscInt *)context;
  PetscReal F0[9], F1[9];
  for (int i = 0; i < 9; ++i) {
    const PetscBool inside = i / 3 < dim && i % 3 < dim;
    F0[i] = (i % 4 == 0) + (inside ? t0 * H[i] : 0);
    F1[i] = (i % 4 == 0) + (inside ? t1 * H[i] : 0);
  }
  affine_increment(dim, F0, F1, x, increment);
}

/* Error of F against the uniform one of time t: root of the mean square over all components and the
 * volume. */
static PetscReal gradient_error(const Model *m, PetscReal t)
{
  PetscReal sum[2] = {0, 0}, corner[3], F[9];
  for (PetscInt p = 0; p < m->points->n; ++p) {
    point_F(m->points, p, F);
    for (PetscInt j = 0; j < m->dim; ++j) {
      const PetscReal unit[3] = {j == 0, j == 1, j == 2};
      PetscInt dim = m->dim;
      affine_motion(&dim, unit, 0, t, corner);
      for (PetscInt i = 0; i < m->dim; ++i)
        sum[0] += m->points->real[POINT_VOLUME][p] * PetscSqr(F[3 * i + j] - (i == j) - corner[i]);
    }
    sum[1] += m->points->real[POINT_VOLUME][p];
  }
  CALL(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, m->comm));
  return PetscSqrtReal(sum[0] / sum[1]);
}

/* All nodes prescribed: F is exact at every point. (Only the boundary prescribed:
 * test_gmm_quadrature.) */
static PetscReal patch(const BasisSpec *basis, CellType cell, PetscInt points_per_cell)
{
  Bench b;
  gmm_init(&b, basis, cell, cell >= CELL_TETRAHEDRON ? 0.25 : 0.125);
  bench_distort(&b, 0.2, 2, (PetscReal[]){0, 1});
  b.body[0].points_per_cell = points_per_cell;
  MotionSpec *motion = bench_motion(&b, -1, 0, MOTION_FIXED, 7);
  motion->on.has_shape = PETSC_TRUE;
  motion->on.shape = (Shape){.kind = SHAPE_BOX, .min = {-1, -1, -1}, .max = {2, 2, 2}};
  /* linear functions have their own values as coefficients */
  b.c.basis.essential = ESSENTIAL_DIRECT;
  b.c.analysis.step = b.c.analysis.largest = 0.5;
  b.c.newton.residual = 1e-10;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  m->boundary->field = affine_motion;
  m->boundary->field_context = &m->dim;
  for (int s = 0; s < 2; ++s) CHECK(model_step(m, 1).cuts == 0, "the step was halved");
  const PetscReal off = gradient_error(m, 1);
  PetscPrintf(PETSC_COMM_WORLD, "%s, cell %d: F off by %.3g\n", basis->kind, (int)cell, (double)off);
  CALL(ModelDestroy(&m));
  bench_end(&b);
  return off;
}

static void test_patch(void **state)
{
  static const BasisSpec *const bases[] = {&usual_lme, &usual_mls};
  (void)state;
  for (int k = 0; k < 2; ++k) {
    static const PetscInt points[] = {3, 4, 4, 8};
    for (CellType cell = CELL_TRIANGLE; cell <= CELL_HEXAHEDRON; ++cell)
      CHECK(patch(bases[k], cell, points[cell]) <= 1e-13, "F is not uniform");
  }
}

/* --- constraints --- */
/* A block hangs from its upper side, which moves; wide supports, so that no node's unknown is the
 * displacement of its place. A tracer on that side moves as prescribed, and the reaction is the
 * weight. */
static void hang(const BasisSpec *basis, CellType cell)
{
  Bench b;
  PetscReal moved, reaction[2];
  gmm_init(&b, basis, cell, cell >= CELL_TETRAHEDRON ? 0.25 : 0.125);
  MotionSpec *motion = bench_motion(&b, 1, 1, MOTION_DISPLACEMENT, 7);
  motion->value[0] = 0.03, motion->value[1] = 0.05;
  b.c.gravity[1] = -9.81;
  b.c.newton.residual = 1e-11;
  bench_tracer(&b, "displacement", 1, 0.5, 1, 0.5);
  for (int d = 0; d < 2; ++d) b.measure[b.c.n_measures++] = (MeasureSpec){.kind = "reaction", .component = d};
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  CHECK(model_step(m, 1).cuts == 0, "the step was halved");
  CALL(ModelMeasure(m, &b.measure[0], 0, &moved));
  for (int d = 0; d < 2; ++d) CALL(ModelMeasure(m, &b.measure[1 + d], 1 + d, &reaction[d]));
  PetscPrintf(PETSC_COMM_WORLD, "%s, cell %d: tracer off by %.3g, reaction by %.3g and %.3g\n", basis->kind, (int)cell,
              (double)(moved - 0.05), (double)reaction[0] / 9810, (double)reaction[1] / 9810 - 1);
  CHECK_CLOSE(moved, 0.05, 1e-12);
  CHECK_CLOSE(reaction[0], 0, 1e-6 * 9810);
  CHECK_CLOSE(reaction[1], 9810, 1e-6 * 9810);
  CALL(ModelDestroy(&m));
}

static void test_hang(void **state)
{
  BasisSpec lme = usual_lme;
  (void)state;
  lme.essential = ESSENTIAL_CONSTRAINTS;
  for (CellType cell = CELL_TRIANGLE; cell <= CELL_HEXAHEDRON; ++cell)
    EACH_VARIANT (k, 2) hang(k ? &usual_mls : &usual_lme, cell);
  hang(&lme, CELL_QUADRILATERAL);
}

/* A side of the grid is held across itself to beyond what material reaches. Along it nothing holds those nodes, and
 * nothing moves them: they take nothing of the weight. */
static void test_beyond(void **state)
{
  (void)state;
  EACH_VARIANT (k, 2) {
    PetscReal reaction[3];
    Bench b;
    gmm_init(&b, k ? &usual_mls : &usual_lme, CELL_QUADRILATERAL, 0.25);
    b.c.basis.essential = ESSENTIAL_CONSTRAINTS;
    b.body[0].shape.max[1] = 0.5;
    MotionSpec *top = bench_motion(&b, 1, 0.5, MOTION_FIXED, 3);
    top->on.max[1] = 0.75;
    bench_motion(&b, 0, 0, MOTION_FIXED, 1);
    b.c.gravity[1] = -9.81;
    b.c.newton.residual = 1e-11;
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    CHECK(model_step(m, 1).cuts == 0, "the step was halved");
    CALL(BoundarySum(m->boundary, m->grid, 0, m->nodes->reaction, reaction));
    CHECK_CLOSE(reaction[1], 4905, 1e-7 * 4905);
    CALL(ModelDestroy(&m));
  }
}

/* The options: the paper's rule (at least six nodes, more while the condition is bad) and sets of
 * polynomials; what is not part of it is refused. */
static void test_options(void **state)
{
  BasisSpec nearest[2] = {usual_mls, usual_lme}, mls = usual_mls;
  Bench b;
  (void)state;
  for (int k = 0; k < 2; ++k) {
    nearest[k].choice = 1;
    nearest[k].radius = 1.41421356;
    nearest[k].minimum = 6;
    hang(&nearest[k], CELL_QUADRILATERAL);
  }
  for (int order = 1; order <= 2; ++order) {
    mls.order = order;
    hang(&mls, CELL_QUADRILATERAL);
  }
  mls.order = 0;
  mls.weight = WEIGHT_CUBIC_SPLINE;
  mls.effective_radius = 2;
  hang(&mls, CELL_QUADRILATERAL);
  gmm_init(&b, &usual_lme, CELL_QUADRILATERAL, 0.25);
  b.c.formulation = "mixed";
  bench_refused(&b, PETSC_COMM_WORLD, "formulation", "method gmm, which takes displacement");
}

/* --- free bodies --- */
/* A block that flies and spins: mass and momentum to round-off, angular momentum and energy as in
 * fem. */
static void fly(const BasisSpec *basis, CellType cell, PetscReal size, PetscReal bound)
{
  Bench b;
  gmm_init(&b, basis, cell, size);
  bench_box(&b, 0, (PetscReal[]){0.25, 0.25, 0.25}, (PetscReal[]){0.75, 0.75, 0.75});
  bench_dynamic(&b, 1, 0.002);
  b.body[0].velocity[0] = 2;
  b.body[0].velocity[1] = -1;
  b.body[0].spin[2] = 12;
  b.body[0].spin_centre[0] = b.body[0].spin_centre[1] = 0.5;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  const PetscReal mass = model_sum(m, "mass: total", 0),
                  p0[2] = {model_sum(m, "momentum", 0), model_sum(m, "momentum", 1)};
  const PetscReal L0 = model_sum(m, "angular_momentum", 2), E0 = model_sum(m, "energy: kinetic", 0);
  PetscReal p_drift = 0;
  while (m->time < 0.1 - 1e-9) {
    CHECK(model_step(m, 0.002).cuts == 0, "a step was halved");
    for (int d = 0; d < 2; ++d) p_drift = PetscMax(p_drift, PetscAbsReal(model_sum(m, "momentum", d) - p0[d]));
  }
  const PetscReal L = model_sum(m, "angular_momentum", 2) / L0 - 1;
  const PetscReal E = (model_sum(m, "energy: kinetic", 0) + model_sum(m, "energy: elastic", 0)) / E0 - 1;
  PetscPrintf(PETSC_COMM_WORLD, "%s, cell %d: drift of momentum %.3g, angular momentum %.3g, energy %.3g\n",
              basis->kind, (int)cell, (double)(p_drift / (mass * 2)), (double)L, (double)E);
  CHECK_CLOSE(model_sum(m, "mass: total", 0), mass, 1e-14 * mass);
  CHECK(p_drift <= bound * mass * 2, "momentum drifts by %g", (double)(p_drift / (mass * 2)));
  CHECK(PetscAbsReal(L) <= 0.01 && PetscAbsReal(E) <= 0.02, "angular momentum %g, energy %g", (double)L, (double)E);
  CALL(ModelDestroy(&m));
}

static void test_fly(void **state)
{
  (void)state;
  fly(&usual_lme, CELL_QUADRILATERAL, 0.125, 1e-10);
  fly(&usual_mls, CELL_QUADRILATERAL, 0.125, 1e-10);
  fly(&usual_lme, CELL_TRIANGLE, 0.125, 1e-10);
  fly(&usual_lme, CELL_HEXAHEDRON, 0.25, 1e-10);
}

/* --- contact --- */
/* A block falls on a row of fixed nodes, which is not in its clouds from the start: it comes to
 * rest before it reaches them and jumps back, and what its momentum changes is the impulse of
 * reaction and gravity. */
static void contact(const BasisSpec *basis)
{
  Bench b;
  PetscReal impulse = 0, force, last = 0, lowest = 1, momentum = 0;
  gmm_init(&b, basis, CELL_QUADRILATERAL, 0.125);
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){2, 1, 1}, 0.125);
  bench_box(&b, 0, (PetscReal[]){0.5, 0.25, 0}, (PetscReal[]){1.25, 0.75, 1});
  bench_dynamic(&b, 1, 0.002);
  b.body[0].velocity[1] = -0.5;
  b.c.gravity[1] = -9.81;
  b.c.newton.residual = 1e-10;
  bench_motion(&b, 1, 0, MOTION_FIXED, 7);
  b.measure[b.c.n_measures++] = (MeasureSpec){.name = "reaction", .kind = "reaction", .component = 1};
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  const PetscReal mass = model_sum(m, "mass: total", 0), before = model_sum(m, "momentum", 1);
  for (int s = 0; s < 120; ++s) {
    const StepReport r = model_step(m, 0.002);
    CALL(ModelMeasure(m, &b.measure[0], 0, &force));
    impulse += r.dt * (0.5 * (force + last) - mass * 9.81);
    last = force;
    momentum = model_sum(m, "momentum", 1);
    const MeasureSpec low = {.kind = "extent", .component = 1};
    CALL(ModelMeasure(m, &low, 0, &force));
    lowest = PetscMin(lowest, force);
  }
  PetscPrintf(PETSC_COMM_WORLD, "contact, %s: lowest point at %.3g m, velocity %.3g m/s, momentum off by %.2g\n",
              basis->kind, (double)lowest, (double)(momentum / mass), (double)((momentum - before - impulse) / before));
  CHECK(lowest > 0.02, "the block is in the floor");
  CHECK(momentum > 0, "the block does not jump back");
  CHECK(PetscAbsReal(momentum - before - impulse) <= 0.02 * PetscAbsReal(before), "momentum %g, impulse %g",
        (double)(momentum - before), (double)impulse);
  CALL(ModelDestroy(&m));
}

static void test_contact(void **state)
{
  (void)state;
  contact(&usual_lme);
  contact(&usual_mls);
}

/* --- bodies that hang on an obstacle --- */
static PetscInt warnings_at(PetscReal bottom)
{
  Bench b;
  Diag *diag;
  Model *m = NULL;
  gmm_init(&b, &usual_lme, CELL_QUADRILATERAL, 0.125);
  bench_dynamic(&b, 1, 0.01);
  b.c.gravity[1] = -10;
  bench_box(&b, 0, (PetscReal[]){0.25, bottom, 0}, (PetscReal[]){0.75, bottom + 0.25, 1});
  bench_motion(&b, 1, 0, MOTION_FIXED, 7);
  CALL(DiagCreate(&diag));
  CALL(ModelCreate(PETSC_COMM_WORLD, &b.c, diag, &m));
  CHECK(m, "the case was refused");
  const PetscInt warnings = diag_warnings(diag);
  CALL(ModelDestroy(&m));
  CALL(DiagDestroy(&diag));
  return warnings;
}

/* Clouds reach two spacings: a body one above the floor sticks to it from the start, and that is
 * told; one that stands on it or flies is not. */
static void test_obstacles(void **state)
{
  const PetscReal bottoms[] = {0, 0.125, 0.25, 0.375};
  PetscMPIInt rank;
  (void)state;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  for (int k = 0; k < 4; ++k) {
    const PetscInt n = warnings_at(bottoms[k]);
    CHECK(rank || n == (k == 1), "%d warnings", (int)n);
  }
}

/* A block is pushed along a side that is held across itself: what nodes of that side are before it have next to no mass
 * when it comes to them, and must not be flung off. It made twenty times its energy within 30 steps. */
static void test_along(void **state)
{
  Bench b;
  Energies e;
  (void)state;
  gmm_init(&b, &usual_lme, CELL_QUADRILATERAL, 0);
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){1.5, 5, 1}, 0.25);
  bench_box(&b, 0, (PetscReal[]){0, 3.5, 0}, (PetscReal[]){1, 4.5, 1});
  b.constants[0].value = 1e7;
  bench_motion(&b, 0, 0, MOTION_FIXED, 1);
  bench_traction(&b, 1, 4.5, "body", 0, -1e4, 0);
  bench_dynamic(&b, 0.4, 0.01);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (int step = 0; step < 40; ++step) CHECK(model_step(m, 0.01).cuts == 0, "step %d was halved", step);
  CALL(ModelEnergies(m, &e));
  PetscPrintf(PETSC_COMM_WORLD, "along a side: %.6g kg m/s, %.3g J elastic, %.3g in transfer of %.6g\n",
              (double)model_sum(m, "momentum", 1), (double)e.elastic, (double)e.transfer, (double)e.external);
  CHECK_CLOSE(model_sum(m, "momentum", 1), -1e4 * 0.4, 1e-6);
  CHECK(e.elastic < 1e-2 * e.external && PetscAbsReal(e.transfer) < 1e-3 * e.external, "it shakes");
  CALL(ModelDestroy(&m));
}

/* Spacings between the nearest two nodes that a rank knows. */
static PetscReal nearest_nodes(const Model *m)
{
  const Grid *grid = m->grid;
  PetscReal nearest = PETSC_MAX_REAL;
  for (PetscInt i = 0; i < grid->n_owned; ++i)
    for (PetscInt k = 0; k < grid->n_nodes; ++k) {
      const PetscReal *x = grid->x + i * 2, *y = grid->x + k * 2;
      if (k == i || cloud_is_twin(grid, i) || cloud_is_twin(grid, k)) continue;
      nearest = PetscMin(nearest, PetscHypotReal(x[0] - y[0], x[1] - y[1]));
    }
  CALL(MPI_Allreduce(MPI_IN_PLACE, &nearest, 1, MPIU_REAL, MPI_MIN, m->comm));
  return nearest / grid->cloud->spacing;
}

/* A heap spreads over the floor: its nodes come upon those of the floor and keep off them (it takes
 * a few steps to push aside several that crowd), no step fails, ranks agree, and on one rank the
 * iterative solver never gives way to the direct one. */
static void heap(const BasisSpec *basis)
{
  Bench b;
  PetscReal nearest = 1;
  PetscMPIInt ranks;
  NamedValue values[] = {
    {"young", 3e5}, {"poisson", 0.3}, {"cohesion", 600}, {"friction_angle", 25}, {"dilatancy_angle", 0}};
  gmm_init(&b, basis, CELL_QUADRILATERAL, 0.125);
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){2, 1, 1}, 0.125);
  bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){0.5, 0.75, 1});
  b.c.basis.essential = ESSENTIAL_CONSTRAINTS;
  b.c.linear = LINEAR_AUTO;
  b.material.law = "mohr-coulomb";
  b.material.parameters = values;
  b.material.n_parameters = 5;
  b.c.gravity[1] = -9.81;
  bench_dynamic(&b, 1, 0.004);
  bench_motion(&b, 1, 0, MOTION_FIXED, 3);
  bench_motion(&b, 0, 0, MOTION_FIXED, 1);
  b.c.newton.residual = 1e-10;
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  Model *m = bench_model(&b, PETSC_COMM_WORLD), *alone = ranks > 1 ? bench_model(&b, PETSC_COMM_SELF) : NULL;
  const int steps = ranks > 1 ? 75 : 150; /* what ranks spoil they spoil in any step */
  for (int step = 0; step < steps; ++step) {
    CHECK(model_step(m, 0.004).cuts == 0, "step %d was halved", step);
    if (alone) model_step(alone, 0.004);
    CHECK(ranks > 1 || strstr(newton_linear_name(m->newton), "BiCGStab"), "step %d: %s", step,
          newton_linear_name(m->newton));
    nearest = PetscMin(nearest, nearest_nodes(m));
  }
  const PetscReal apart = alone ? points_difference(m, alone, POINT_X) : 0;
  PetscPrintf(PETSC_COMM_WORLD, "heap, %s: nodes %g spacings apart, points within %.2g m of those on one rank\n",
              basis->kind, (double)nearest, (double)apart);
  CHECK(apart < 1e-9, "ranks differ by %g m", (double)apart);
  CHECK(nearest > 0.2, "%g spacings between nodes", (double)nearest);
  if (alone) CALL(ModelDestroy(&alone));
  CALL(ModelDestroy(&m));
}

static void test_heap(void **state)
{
  (void)state;
  EACH_VARIANT (k, 2) heap(k ? &usual_mls : &usual_lme);
}

/* --- ranks --- */
static const struct {
  PointReal field;
  const char *name;
} fields[] = {{POINT_X, "x"}, {POINT_U, "u"}, {POINT_V, "v"}, {POINT_F, "F"}, {POINT_STATE, "state"}};

/* `cut`: after how many steps nodes and points get new ranks. */
static void run_both(Bench *b, PetscInt steps, PetscInt cut)
{
  Model *together = bench_model(b, PETSC_COMM_WORLD), *alone = bench_model(b, PETSC_COMM_SELF);
  PetscReal v[2];
  for (PetscInt s = 0; s < steps; ++s) {
    if (s == cut) {
      CALL(GmmRedistribute(together->space));
      CALL(together->method->initialise(together->space));
    }
    const StepReport r = model_step(together, PETSC_MAX_REAL), q = model_step(alone, PETSC_MAX_REAL);
    CHECK(r.cuts == q.cuts && r.dt == q.dt, "steps of %g and %g s", (double)r.dt, (double)q.dt);
  }
  for (size_t k = 0; k < sizeof fields / sizeof *fields; ++k) {
    const PetscReal off = points_difference(together, alone, fields[k].field);
    CHECK(off <= 1e-9, "%s, cell %d: %s is off by %g", b->c.basis.kind, (int)b->c.grid.cell, fields[k].name,
          (double)off);
  }
  for (PetscInt k = 0; k < b->c.n_measures; ++k) {
    CALL(ModelMeasure(together, &b->measure[k], k, &v[0]));
    CALL(ModelMeasure(alone, &b->measure[k], k, &v[1]));
    CHECK_CLOSE(v[0], v[1], 1e-9 * (1 + PetscAbsReal(v[1])));
  }
  CHECK_CLOSE(model_sum(together, "energy: external", 0), model_sum(alone, "energy: external", 0), 1e-8);
  CALL(ModelDestroy(&together));
  CALL(ModelDestroy(&alone));
}

/* A bar held at one end, under gravity, a traction, a point force. */
static void bar(const BasisSpec *basis, CellType cell, PetscReal size)
{
  Bench b;
  gmm_init(&b, basis, cell, size);
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){4, 1, 1}, size);
  bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){4, 1, 1});
  b.c.gravity[1] = -0.5;
  b.c.analysis.step = b.c.analysis.largest = 0.25;
  bench_motion(&b, 0, 0, MOTION_FIXED, 7);
  bench_traction(&b, 0, 4, "body", 300, -100, 0);
  bench_traction(&b, 1, 1, NULL, 0, -50, 0);
  b.load[b.c.n_loads++] = (LoadSpec){.kind = LOAD_POINT, .at = {2, 0.5, 0.5}, .value = {0, -100, 0}};
  bench_tracer(&b, "displacement", 1, 4, 0.5, 0.5);
  b.measure[b.c.n_measures++] = (MeasureSpec){.name = "reaction", .kind = "reaction", .component = 1};
  run_both(&b, 4, 2);
}

/* A block with a spin thrown on a floor: ghosts change as it deforms and meets nodes that it did
 * not know. */
static void thrown(const BasisSpec *basis, LinearChoice linear)
{
  Bench b;
  gmm_init(&b, basis, CELL_QUADRILATERAL, 0.125);
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){2, 1.5, 1}, 0.125);
  bench_box(&b, 0, (PetscReal[]){0.25, 0.25, 0.25}, (PetscReal[]){0.75, 0.75, 0.75});
  b.body[0].velocity[0] = 1.5;
  b.body[0].velocity[1] = -0.5;
  b.body[0].spin[2] = 2;
  b.body[0].spin_centre[0] = b.body[0].spin_centre[1] = 0.5;
  b.c.gravity[1] = -9.81;
  b.c.linear = linear;
  bench_dynamic(&b, 1, 0.004);
  bench_motion(&b, 1, 0, MOTION_FIXED, 7);
  bench_tracer(&b, "position", 0, 0.5, 0.5, 0.5);
  b.measure[b.c.n_measures++] = (MeasureSpec){.name = "reaction", .kind = "reaction", .component = 1};
  run_both(&b, 60, 20);
}

static void test_ranks(void **state)
{
  (void)state;
  EACH_VARIANT (k, 2) {
    bar(k ? &usual_mls : &usual_lme, CELL_QUADRILATERAL, 0.25);
    bar(k ? &usual_lme : &usual_mls, CELL_TRIANGLE, 0.25);
    bar(k ? &usual_lme : &usual_mls, k ? CELL_HEXAHEDRON : CELL_TETRAHEDRON, 0.5);
    thrown(k ? &usual_mls : &usual_lme, k ? LINEAR_AUTO : LINEAR_DIRECT);
  }
}

/* --- linear solvers --- */
/* Constraints by multipliers in a direct solver's matrix, and by projections in the iterative
 * solver: the same motion, reactions too. */
static void solvers(PetscBool sand)
{
  Bench b;
  Model *m[2];
  PetscReal v[2][2], moved[2];
  gmm_init(&b, &usual_mls, CELL_QUADRILATERAL, 0.125);
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){1.5, 1, 1}, 0.125);
  bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){0.5, 0.75, 1});
  NamedValue values[] = {
    {"young", 1e5}, {"poisson", 0.3}, {"cohesion", 200}, {"friction_angle", 30}, {"dilatancy_angle", 0}};
  if (sand) {
    b.material.law = "mohr-coulomb";
    b.material.parameters = values;
    b.material.n_parameters = 5;
  }
  b.c.gravity[1] = -9.81;
  b.c.newton.residual = 1e-10;
  bench_dynamic(&b, 1, 0.002);
  MotionSpec *floor = bench_motion(&b, 1, 0, MOTION_DISPLACEMENT, 3);
  floor->value[0] = 0.02; /* a floor that glides */
  for (int d = 0; d < 2; ++d) b.measure[b.c.n_measures++] = (MeasureSpec){.kind = "reaction", .component = d};
  for (int k = 0; k < 2; ++k) {
    b.c.linear = k ? LINEAR_DIRECT : LINEAR_AUTO;
    m[k] = bench_model(&b, k ? PETSC_COMM_SELF : PETSC_COMM_WORLD);
    for (int step = 0; step < 25; ++step) CHECK(model_step(m[k], 0.002).cuts == 0, "a step was halved");
    for (int d = 0; d < 2; ++d) CALL(ModelMeasure(m[k], &b.measure[d], d, &v[k][d]));
  }
  moved[0] = points_difference(m[0], m[1], POINT_U);
  moved[1] = PetscHypotReal(v[0][0] - v[1][0], v[0][1] - v[1][1]) / PetscHypotReal(v[1][0], v[1][1]);
  PetscPrintf(PETSC_COMM_WORLD, "%s by %s and by %s: u differs by %.2g m, reactions by %.2g\n",
              sand ? "sand" : "rubber", newton_linear_name(m[0]->newton), newton_linear_name(m[1]->newton),
              (double)moved[0], (double)moved[1]);
  CHECK(strstr(newton_linear_name(m[0]->newton), sand ? "BiCGStab" : "conjugate"), "not the iterative solver");
  CHECK(moved[0] < 1e-8 && moved[1] < 1e-6, "the solvers disagree");
  for (int k = 0; k < 2; ++k) CALL(ModelDestroy(&m[k]));
}

static void test_solvers(void **state)
{
  (void)state;
  EACH_VARIANT (k, 2) solvers(k);
}

/* --- a given stress --- */
/* A block between rollers, with a stress that these hold, is pressed by a twentieth in two steps: what comes in is
 * what it stores, from the force on that it begins with. */
static void test_given_stress(void **state)
{
  static PetscReal time[] = {0, 1}, value[] = {0, 1};
  const BasisSpec *const bases[] = {&usual_lme, &usual_mls};
  (void)state;
  EACH_VARIANT (k, 2) {
    Energies e;
    PetscReal reaction[3], held[3], work = 0;
    Bench b;
    gmm_init(&b, bases[k], CELL_QUADRILATERAL, 0.25);
    b.body[0].has_stress = PETSC_TRUE;
    b.body[0].stress[0] = b.body[0].stress[2] = (char *)"-3e4";
    b.body[0].stress[1] = (char *)"-5e4";
    for (int d = 0; d < 2; ++d) bench_motion(&b, d, 0, MOTION_FIXED, 1u << d);
    bench_motion(&b, 0, 1, MOTION_FIXED, 1);
    MotionSpec *top = bench_motion(&b, 1, 1, MOTION_DISPLACEMENT, 2);
    top->value[1] = -0.05;
    top->amplitude = (Amplitude){.n = 2, .time = time, .value = value};
    b.c.analysis.step = b.c.analysis.largest = 0.5;
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    for (int step = 0; step <= 2; ++step) {
      if (step) model_step(m, 1);
      CALL(BoundarySum(m->boundary, m->grid, 3, m->nodes->reaction, reaction));
      held[step] = reaction[1];
      work -= step ? 0.5 * (held[step - 1] + held[step]) * 0.025 : 0;
    }
    CALL(ModelEnergies(m, &e));
    PetscPrintf(PETSC_COMM_WORLD, "%s: begins with %.9g N, work %.9g of %.9g J, transfer %.2g\n", bases[k]->kind,
                (double)held[0], (double)e.boundary, (double)work, (double)e.transfer);
    /* as well as points integrate a uniform stress */
    CHECK_CLOSE(held[0], -5e4, (k ? 1e-2 : 2e-4) * 5e4);
    CHECK_CLOSE(e.boundary, work, 1e-9 * work);
    CHECK(fabs(e.transfer) < (k ? 2e-3 : 2e-4) * work, "%g J lost", (double)e.transfer);
    CALL(ModelDestroy(&m));
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_patch),        cmocka_unit_test(test_hang),    cmocka_unit_test(test_options),
    cmocka_unit_test(test_fly),          cmocka_unit_test(test_contact), cmocka_unit_test(test_ranks),
    cmocka_unit_test(test_obstacles),    cmocka_unit_test(test_solvers), cmocka_unit_test(test_heap),
    cmocka_unit_test(test_given_stress), cmocka_unit_test(test_beyond),  cmocka_unit_test(test_along),
  };
  return run_model_tests_in_turns(argc, argv, tests);
}
