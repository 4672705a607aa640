/* Loads on the surface of bodies whose points have domains, in many steps: material crosses cells, and what is
 * homogeneous stays so to the tolerance of Newton's method, corners and all, pulled and pressed, in the plane, in rings
 * and in space, in statics and when it has come to rest. The answers are those of the law, solved here. */
#include "case_builder.h"
#include "model/model_private.h"

static const PetscInt counts[] = {10, 100};

/* On several ranks the first of them alone, and larger cells: material crosses their sides in both. */
static PetscInt few(void) { return ranks_of_world() > 1 ? 1 : 2; }
static PetscReal wide(PetscReal h) { return ranks_of_world() > 1 && h >= 0.1 ? (h > 0.2 ? 2 : 2.5) * h : h; }

static PetscReal kirchhoff(PetscReal J, PetscReal stretch)
{
  const PetscReal E = 1e6, nu = 0.3, mu = E / (2 * (1 + nu)), lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
  return lambda * log(J) + mu * (stretch * stretch - 1);
}

/* The stretch across, of `across` axes alike, at which nothing pulls there. */
static PetscReal stretch_across(PetscReal along, PetscInt across)
{
  PetscReal low = 0.1, high = 10;
  for (int k = 0; k < 200; ++k) {
    const PetscReal a = 0.5 * (low + high);
    if (kirchhoff(along * pow(a, (double)across), a) < 0) low = a;
    else high = a;
  }
  return low;
}

/* The stretch along a dead traction per undeformed area. */
static PetscReal stretch_along(PetscReal traction, PetscInt across)
{
  PetscReal low = 0.2, high = 5;
  for (int k = 0; k < 200; ++k) {
    const PetscReal a = 0.5 * (low + high), J = a * pow(stretch_across(a, across), (double)across);
    if (kirchhoff(J, a) / a < traction) low = a;
    else high = a;
  }
  return low;
}

/* The stretch of all of `axes` alike under p. */
static PetscReal stretch_under(PetscReal p, PetscInt axes)
{
  PetscReal low = 0.3, high = 2;
  for (int k = 0; k < 200; ++k) {
    const PetscReal a = 0.5 * (low + high), J = pow(a, (double)axes);
    if (kirchhoff(J, a) / J < -p) low = a;
    else high = a;
  }
  return low;
}

/* A block from the origin to (size), between planes of symmetry. */
static void block(Bench *b, const Kinematics *kinematics, const PetscReal size[3], PetscReal h)
{
  const PetscInt dim = kinematics->dim;
  bench_init(b, "mpm", dim == 3 ? CELL_HEXAHEDRON : CELL_QUADRILATERAL, 0);
  b->c.kinematics = kinematics;
  b->c.basis.kind = "gimp";
  bench_grid(b, (PetscReal[]){0, 0, 0}, (PetscReal[]){1.5, 2, 1.5}, h);
  bench_box(b, 0, (PetscReal[]){0, 0, 0}, size);
  for (int d = kinematics->hoop; d < dim; ++d) bench_motion(b, d, 0, MOTION_FIXED, 1u << d);
}

static LoadSpec *load_side(Bench *b, LoadKind kind, int axis, PetscReal at, const PetscReal value[3])
{
  LoadSpec *load = bench_traction(b, axis, at, "body", value[0], value[1], value[2]);
  load->kind = kind;
  return load;
}

/* From 0 at the start to all of it at the end. */
static void in_steps(Bench *b, PetscInt n)
{
  static PetscReal time[] = {0, 1}, value[] = {0, 1};
  for (PetscInt k = 0; k < b->c.n_loads; ++k) b->load[k].amplitude = (Amplitude){.n = 2, .time = time, .value = value};
  b->c.analysis.step = b->c.analysis.largest = 1 / (PetscReal)n;
  b->c.analysis.smallest = b->c.analysis.step / 4;
}

/* How far points and carriers are from where the stretches put them. */
static PetscReal far_from(const Model *m, const Points *points, const PetscReal stretch[3])
{
  PetscReal off = 0;
  for (PetscInt p = 0; p < points->n; ++p) {
    PetscReal x[3];
    point_place(points, p, x);
    for (PetscInt d = 0; d < m->dim; ++d)
      off = PetscMax(off, PetscAbsReal(x[d] - stretch[d] * (x[d] - point_real(points, POINT_U, p)[d])));
  }
  return model_max(m, off);
}

/* What the carriers push with at amplitude 1. */
static PetscReal pushed(const Model *m, PetscInt axis)
{
  PetscReal local = 0, sum;
  for (PetscInt p = 0; p < m->loads->carriers->n; ++p) local += point_real(m->loads->carriers, POINT_FORCE, p)[axis];
  CALL(MPI_Allreduce(&local, &sum, 1, MPIU_REAL, MPI_SUM, m->comm));
  return sum;
}

/* Steps to the end; the reaction of the plane across y, and all else that must be. */
static Model *check(Bench *b, const char *name, const PetscReal stretch[3], PetscReal force, PetscReal tolerance)
{
  Model *m = bench_model(b, PETSC_COMM_WORLD);
  PetscReal reaction[3];
  while (m->time < b->c.analysis.end - 1e-9) model_step(m, b->c.analysis.end - m->time);
  const PetscReal points = far_from(m, m->points, stretch), carriers = far_from(m, m->loads->carriers, stretch);
  CALL(BoundarySum(m->boundary, m->grid, m->c->kinematics->hoop ? 0 : 1, m->nodes->reaction, reaction));
  PetscPrintf(PETSC_COMM_WORLD, "%s: points off %.2g m, carriers %.2g, force %.9g of %.9g, reaction %.9g, %d steps\n",
              name, (double)points, (double)carriers, (double)pushed(m, 1), (double)force, (double)reaction[1],
              (int)m->step);
  CHECK(points < tolerance, "%s: points off by %g m", name, (double)points);
  CHECK(carriers < tolerance, "%s: carriers off by %g m", name, (double)carriers);
  CHECK_CLOSE(pushed(m, 1), force, PetscMax(1e-9, 4 * tolerance) * PetscAbsReal(force));
  if (m->c->analysis.type != ANALYSIS_DYNAMIC) CHECK_CLOSE(reaction[1], -force, 4 * tolerance * PetscAbsReal(force));
  return m;
}

static void check_alone(Bench *b, const char *name, const PetscReal stretch[3], PetscReal force, PetscReal tolerance)
{
  Model *m = check(b, name, stretch, force, tolerance);
  CALL(ModelDestroy(&m));
}

/* A dead traction on the upper side. */
static void pulled(const Kinematics *kinematics, PetscReal h, PetscReal traction, PetscInt steps)
{
  const PetscInt dim = kinematics->dim;
  const PetscInt sides = kinematics->hoop ? 2 : dim - 1;
  const PetscReal along = stretch_along(traction, sides), across = stretch_across(along, sides);
  char name[64];
  Bench b;
  block(&b, kinematics, (PetscReal[]){1, 1, 1}, h);
  load_side(&b, LOAD_TRACTION, 1, 1, (PetscReal[]){0, traction, 0});
  in_steps(&b, steps);
  PetscSNPrintf(name, sizeof name, "pulled, %s", kinematics->name);
  check_alone(&b, name, (PetscReal[]){across, along, across}, kinematics->hoop ? PETSC_PI * traction : traction, 1e-11);
}

static void test_pulled(void **state)
{
  (void)state;
  for (PetscInt k = 0; k < few(); ++k) {
    pulled(&kinematics_plane_strain, wide(0.1), 3e5, counts[k]);
    pulled(&kinematics_plane_strain, wide(0.1), -3e5, counts[k]);
  }
  pulled(&kinematics_axisymmetric, wide(0.1), -3e5, 10);
  pulled(&kinematics_3d, wide(0.25), 3e5, 10);
  pulled(&kinematics_3d, wide(0.25), -3e5, 10);
}

/* A pressure on the sides that are free; p < 0 pulls. */
static void pressed(const Kinematics *kinematics, PetscReal h, PetscReal p, PetscInt steps)
{
  const PetscInt dim = kinematics->dim;
  const PetscReal a = stretch_under(p, kinematics->hoop ? 3 : dim), pi = PETSC_PI;
  char name[64];
  Bench b;
  block(&b, kinematics, (PetscReal[]){1, 1, 1}, h);
  for (int d = 0; d < dim; ++d) load_side(&b, LOAD_PRESSURE, d, 1, (PetscReal[]){p, 0, 0});
  in_steps(&b, steps);
  PetscSNPrintf(name, sizeof name, "pressed, %s", kinematics->name);
  check_alone(&b, name, (PetscReal[]){a, a, a}, -p * (kinematics->hoop ? pi * a * a : pow(a, dim - 1)), 1e-11);
}

static void test_pressed(void **state)
{
  (void)state;
  for (PetscInt k = 0; k < few(); ++k) {
    pressed(&kinematics_plane_strain, wide(0.1), 2e5, counts[k]);
    pressed(&kinematics_plane_strain, wide(0.1), -1e5, counts[k]);
    pressed(&kinematics_axisymmetric, wide(0.1), 3e5, counts[k]);
  }
  pressed(&kinematics_3d, wide(0.25), 3e5, 10);
}

/* What swings comes to rest where statics has it. */
static void test_swings(void **state)
{
  const PetscReal traction = 3e5, along = stretch_along(traction, 1), across = stretch_across(along, 1);
  static PetscReal time[] = {0, 1, 2}, value[] = {0, 1, 1};
  Bench b;
  (void)state;
  block(&b, &kinematics_plane_strain, (PetscReal[]){1, 1, 1}, wide(0.1));
  load_side(&b, LOAD_TRACTION, 1, 1, (PetscReal[]){0, traction, 0});
  bench_dynamic(&b, 2, 0.01);
  b.c.analysis.damping = 20;
  b.c.stabilisation.follow = 0;
  b.load[0].amplitude = (Amplitude){.n = 3, .time = time, .value = value};
  check_alone(&b, "swings", (PetscReal[]){across, along, across}, traction, 1e-3);
}

/* The same in explicit steps: mass of what is drawn into new cells begins with nothing. To 1 % of the stretch, and the
 * load stays on the body; work is that of the spring that the body is, and what is lost in the transfer next to
 * none. */
typedef struct {
  const Kinematics *kinematics;
  PetscReal h; /* of a cell */
  LoadKind kind;
  PetscReal load; /* Pa */
  ExplicitUpdate update;
} Explicitly;

static void explicitly(const Explicitly *t)
{
  const Kinematics *kinematics = t->kinematics;
  const PetscReal h = wide(t->h), load = t->load;
  const LoadKind kind = t->kind;
  const ExplicitUpdate update = t->update;
  static PetscReal time[] = {0, 1, 2}, value[] = {0, 1, 1};
  const PetscInt dim = kinematics->dim, sides = kinematics->hoop ? 2 : dim - 1, axes = kinematics->hoop ? 3 : dim;
  const PetscBool pulled = (PetscBool)(kind == LOAD_TRACTION);
  const PetscReal along = pulled ? stretch_along(load, sides) : stretch_under(load, axes);
  const PetscReal across = pulled ? stretch_across(along, sides) : along, pi = PETSC_PI;
  const PetscReal force = pulled ? load : -load * pow(along, sides);
  char name[64];
  Energies e;
  Bench b;
  block(&b, kinematics, (PetscReal[]){1, 1, 1}, h);
  for (int d = pulled ? 1 : 0; d < (pulled ? 2 : dim); ++d)
    load_side(&b, kind, d, 1, (PetscReal[]){pulled ? 0 : load, load, 0});
  bench_dynamic(&b, 2, 0.02);
  b.c.analysis.type = ANALYSIS_EXPLICIT;
  b.c.analysis.update = update;
  /* pulled so far, its second mapping wants short substeps */
  b.c.analysis.courant = update == EXPLICIT_MUSL && fabs(load) > 5e4 ? 0.4 : 0;
  b.c.analysis.damping = 20;
  for (PetscInt k = 0; k < b.c.n_loads; ++k) b.load[k].amplitude = (Amplitude){.n = 3, .time = time, .value = value};
  PetscSNPrintf(name, sizeof name, "explicitly %s, %s", pulled ? "pulled" : "blown up", kinematics->name);
  Model *m = check(&b, name, (PetscReal[]){across, along, across}, kinematics->hoop ? pi * force : force,
                   0.01 * fabs(along - 1));
  CALL(ModelEnergies(m, &e));
  PetscPrintf(PETSC_COMM_WORLD, "  work %.6g J, elastic %.6g, damped %.3g, transfer %.3g\n", (double)e.external,
              (double)e.elastic, (double)e.damped, (double)e.transfer);
  CHECK(fabs(e.transfer) < 0.01 * e.external, "%g J of %g lost", (double)e.transfer, (double)e.external);
  CALL(ModelDestroy(&m));
}

static void test_explicit(void **state)
{
  static const Explicitly runs[] = {
    {&kinematics_plane_strain, 0.0625, LOAD_TRACTION, 8e3, EXPLICIT_MUSL},
    {&kinematics_plane_strain, 0.1, LOAD_TRACTION, 1e5, EXPLICIT_MUSL},
    {&kinematics_plane_strain, 0.1, LOAD_TRACTION, 3e5, EXPLICIT_USL},
    {&kinematics_plane_strain, 0.1, LOAD_TRACTION, -1e5, EXPLICIT_MUSL},
    {&kinematics_plane_strain, 0.1, LOAD_PRESSURE, -1e5, EXPLICIT_MUSL},
    {&kinematics_axisymmetric, 0.1, LOAD_TRACTION, 1e5, EXPLICIT_MUSL},
    {&kinematics_axisymmetric, 0.1, LOAD_PRESSURE, -1e5, EXPLICIT_MUSL},
    {&kinematics_3d, 0.25, LOAD_TRACTION, 1e5, EXPLICIT_MUSL},
    {&kinematics_3d, 0.25, LOAD_PRESSURE, -1e5, EXPLICIT_USL},
  };
  (void)state;
  EACH_OF (k, runs) explicitly(runs + k);
}

/* What turns under a load keeps its spin as it does without: nodes that follow hand on the motion of a field, not that
 * of one place. The load is next to nothing. */
static void test_turns(void **state)
{
  Bench b;
  (void)state;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 0);
  b.c.basis.kind = "gimp";
  bench_grid(&b, (PetscReal[]){-1, -1, 0}, (PetscReal[]){1, 1, 0}, 0.1);
  bench_box(&b, 0, (PetscReal[]){-0.5, -0.5, 0}, (PetscReal[]){0.5, 0.5, 0});
  b.body[0].spin[2] = 5;
  load_side(&b, LOAD_TRACTION, 1, 0.5, (PetscReal[]){0, 1e-9, 0});
  bench_dynamic(&b, 0.5, 0.01);
  b.c.analysis.type = ANALYSIS_EXPLICIT;
  b.c.analysis.transfer = (char *)"consistent";
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  const PetscReal before = model_sum(m, "angular_momentum", 2);
  while (m->time < 0.5 - 1e-9) model_step(m, 0.5 - m->time);
  PetscPrintf(PETSC_COMM_WORLD, "turns: angular momentum %.6g of %.6g\n", (double)model_sum(m, "angular_momentum", 2),
              (double)before);
  CHECK_CLOSE(model_sum(m, "angular_momentum", 2), before, 1e-3 * before);
  CALL(ModelDestroy(&m));
}

/* Off the lines of the grid: parts of cells lack a little at corners (section 40). */
static void test_off_the_lines(void **state)
{
  const PetscReal traction = -3e5, along = stretch_along(traction, 1), across = stretch_across(along, 1);
  Bench b;
  (void)state;
  block(&b, &kinematics_plane_strain, (PetscReal[]){1.03, 0.97, 1}, 0.1);
  load_side(&b, LOAD_TRACTION, 1, 0.97, (PetscReal[]){0, traction, 0});
  in_steps(&b, 40);
  check_alone(&b, "off the lines", (PetscReal[]){across, along, across}, 1.03 * traction, 1e-4);
}

/* A ring under pressure from within, R_a = 1, R_b = 2: to 0.48077 at 150 kPa by the equilibrium of thin rings one
 * within the other (Runge and Kutta's rule). The pressure is that on the arc as it is by then. */
static void test_ring(void **state)
{
  const PetscReal p = 1.5e5;
  PetscReal mean = 0, local[2] = {0, 0}, sum[2];
  Bench b;
  (void)state;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 0);
  b.c.basis.kind = "gimp";
  bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){3, 3, 0}, 0.1);
  Shape part[3] = {
    {.kind = SHAPE_BALL, .radius = 2}, {.kind = SHAPE_BOX, .max = {2, 2, 1}}, {.kind = SHAPE_BALL, .radius = 1}};
  Shape whole[2] = {{.kind = SHAPE_INTERSECTION, .n_children = 2, .children = part}, part[2]};
  b.body[0].shape = (Shape){.kind = SHAPE_DIFFERENCE, .n_children = 2, .children = whole};
  for (int d = 0; d < 2; ++d) bench_motion(&b, d, 0, MOTION_FIXED, 1u << d);
  LoadSpec *load = &b.load[b.c.n_loads++];
  *load = (LoadSpec){.kind = LOAD_PRESSURE, .value = {p}, .on = {.body = (char *)"body", .has_shape = PETSC_TRUE}};
  load->on.shape = (Shape){.kind = SHAPE_BALL, .radius = 1 + 1e-6};
  in_steps(&b, ranks_of_world() > 1 ? 10 : 40);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  while (m->time < 1 - 1e-9) model_step(m, 1 - m->time);
  const Points *carriers = m->loads->carriers;
  for (PetscInt q = 0; q < carriers->n; ++q) {
    PetscReal x[3] = {0, 0, 0};
    point_place(carriers, q, x);
    local[0] += hypot(x[0], x[1]);
    local[1] += 1;
  }
  CALL(MPI_Allreduce(local, sum, 2, MPIU_REAL, MPI_SUM, m->comm));
  mean = sum[0] / sum[1];
  PetscPrintf(PETSC_COMM_WORLD, "ring: to %.6g, pushed with %.9g and %.9g, p r %.9g\n", (double)mean,
              (double)pushed(m, 0), (double)pushed(m, 1), (double)(p * mean));
  CHECK_CLOSE(mean, 1.4807652, 4e-3);
  for (int d = 0; d < 2; ++d) CHECK_CLOSE(pushed(m, d), p * mean, 2e-3 * p * mean);
  CALL(ModelDestroy(&m));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_pulled),   cmocka_unit_test(test_pressed), cmocka_unit_test(test_swings),
    cmocka_unit_test(test_explicit), cmocka_unit_test(test_turns),   cmocka_unit_test(test_off_the_lines),
    cmocka_unit_test(test_ring),
  };
  return run_model_tests_in_turns(argc, argv, tests);
}
