/* Thick tubes and shells opened from inside, from radius 1 to 2 m: exactly incompressible ones, and
 * the load under which plastic ones give way, against closed forms. A shell sees radius, axis and
 * hoop at once. */
#include "axisymmetric.h"

typedef struct {
  const char *law;
  PetscInt n; /* parameters */
  NamedValue value[5];
} Matter;

#define V(name, number)  \
  {                      \
    (char *)name, number \
  }

typedef enum { TUBE, SHELL } Form;

typedef struct {
  Form form;
  PetscReal opened; /* radius of the inside at t = 1 */
} Opening;

static PetscReal radius_of(Form form, const PetscReal *x)
{
  return form == TUBE ? x[0] : PetscSqrtReal(x[0] * x[0] + x[1] * x[1]);
}

static PetscReal inside(const Opening *o, PetscReal t) { return 1 + t * (o->opened - 1); }

/* Outwards on the inside; symmetry planes and axis stay. */
static void open_up(void *context, const PetscReal *x, PetscReal t0, PetscReal t1, PetscReal *increment)
{
  const Opening *o = context;
  const PetscReal r = radius_of(o->form, x), r0 = inside(o, t0);
  const PetscBool on = PetscAbsReal(r - r0) < 1e-6 * r0;
  for (int d = 0; d < 2; ++d) increment[d] = on && (d == 0 || o->form == SHELL) ? (inside(o, t1) - r0) * x[d] / r : 0;
}

/* A quarter of a circle of (radius - 1, angle over a right one). */
static void bend(void *context, PetscInt dim, PetscReal size, PetscReal *x)
{
  const PetscReal r = 1 + x[0], angle = PETSC_PI / 2 * x[1];
  (void)context, (void)dim, (void)size;
  x[0] = x[1] == 1 ? 0 : r * PetscCosReal(angle);
  x[1] = x[1] == 0 ? 0 : r * PetscSinReal(angle);
}

static void use_matter(Bench *b, const Matter *matter, const char *formulation)
{
  b->material.law = (char *)matter->law;
  b->material.n_parameters = matter->n;
  b->material.parameters = (NamedValue *)matter->value;
  b->c.formulation = (char *)formulation;
  b->c.mixed.stabilisation = 2;
}

/* n cells over the wall. */
static void wall(Bench *b, Form form, PetscInt n)
{
  if (form == TUBE) {
    tube(b, "fem", CELL_QUADRILATERAL, 1, 2, 1. / (PetscReal)n, n);
    tube_moved(b, 1, 0, 1, 0);
    tube_moved(b, 1, 1. / (PetscReal)n, 1, 0);
    bench_motion(b, 0, 1, MOTION_FIXED, 1);
    return;
  }
  bench_init(b, "fem", CELL_QUADRILATERAL, n);
  b->c.kinematics = &kinematics_axisymmetric;
  static Shape part[] = {{.kind = SHAPE_BOX, .max = {2, 2, 0}}, {.kind = SHAPE_BALL, .radius = 1}};
  b->body[0].shape = (Shape){.kind = SHAPE_DIFFERENCE, .n_children = 2, .children = part};
  bench_mesh(b, bend, NULL);
  bench_motion(b, 1, 0, MOTION_FIXED, 2);
  MotionSpec *m = bench_motion(b, -1, 0, MOTION_FIXED, 3);
  m->on.has_shape = PETSC_TRUE;
  m->on.shape = (Shape){.kind = SHAPE_BALL, .radius = 1 + 1e-6};
}

/* Pressure inside now: the work of the forces there in opening by a unit, over the area. */
static PetscReal pressure(const Model *m, PetscReal height, const Opening *o)
{
  const PetscReal r = inside(o, m->time), area = 2 * PETSC_PI * r * (o->form == TUBE ? height : r);
  PetscReal local = 0, sum;
  for (PetscInt i = 0; i < m->grid->n_owned; ++i) {
    const PetscReal *x = m->grid->x + 2 * i, *f = m->nodes->reaction + 2 * i;
    if (PetscAbsReal(radius_of(o->form, x) - r) > 1e-6) continue;
    local += o->form == TUBE ? f[0] : (f[0] * x[0] + f[1] * x[1]) / r;
  }
  CALL(MPI_Allreduce(&local, &sum, 1, MPIU_REAL, MPIU_SUM, m->comm));
  return sum / area;
}

typedef struct {
  PetscReal pressure, outside[2]; /* Pa; radius of the outside at the equator and the pole, m */
} Opened;

static Opened opened(Form form, const Matter *matter, const char *formulation, PetscInt n, PetscReal to, PetscInt steps)
{
  Bench b;
  Opening o = {form, to};
  Opened result = {0};
  wall(&b, form, n);
  use_matter(&b, matter, formulation);
  b.c.analysis.step = b.c.analysis.largest = 1 / (PetscReal)steps;
  b.c.newton.residual = 1e-10;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  PetscReal *X = node_places(m);
  m->boundary->field = open_up;
  m->boundary->field_context = &o;
  const PetscInt most = run_through(m);
  CHECK(most <= 6, "%s: %d iterations in a step", matter->law, (int)most);
  result.pressure = pressure(m, 1. / (PetscReal)n, &o);
  result.outside[0] = moved_to(m, X, 2, 0, 0);
  if (form == SHELL) result.outside[1] = moved_to(m, X, 0, 2, 1);
  CALL(PetscFree(X));
  CALL(ModelDestroy(&m));
  bench_end(&b);
  return result;
}

/* --- exactly incompressible --- */

/* p over the shear modulus between stretches la inside and lb outside. */
static PetscReal rubber_pressure(Form form, PetscReal la, PetscReal lb)
{
  if (form == TUBE) return PetscLogReal(la / lb) + (1 / PetscSqr(lb) - 1 / PetscSqr(la)) / 2;
  return 2 / lb + 1 / (2 * PetscPowRealInt(lb, 4)) - 2 / la - 1 / (2 * PetscPowRealInt(la, 4));
}

static void test_incompressible(void **state)
{
  static const Matter rubber = {"neo-hookean-split", 2, {V("shear", 1e6), V("poisson", 0.5)}};
  static const struct {
    Form form;
    PetscReal la, outside, pressure;
  } row[] = {{TUBE, 1.1, 2.0518285, 0.1315623},  {TUBE, 1.5, 2.2912878, 0.4282284},  {TUBE, 2, 2.6457513, 0.5740536},
             {SHELL, 1.1, 2.0272114, 0.2871548}, {SHELL, 1.5, 2.1810353, 0.7554331}, {SHELL, 2, 2.4662121, 0.8069266}};
  (void)state;
  for (size_t k = 0; k < sizeof row / sizeof *row; ++k) {
    PetscReal error[2], out[2][2];
    const PetscReal exact = rubber_pressure(row[k].form, row[k].la, row[k].outside / 2);
    for (int fine = 0; fine < 2; ++fine) {
      const Opened o = opened(row[k].form, &rubber, "mixed", fine ? 16 : 8, row[k].la, 5);
      error[fine] = o.pressure / 1e6 / exact - 1;
      for (int side = 0; side < 2; ++side) out[fine][side] = o.outside[side] - row[k].outside;
    }
    CHECK_CLOSE(exact, row[k].pressure, 2e-7);
    CHECK(PetscAbsReal(error[1]) < 2.5e-3, "%d: pressure off by %g", (int)k, (double)error[1]);
    CHECK(order_of(error[0], error[1]) > 1.6, "%d: order %g", (int)k, (double)order_of(error[0], error[1]));
    CHECK_CLOSE(out[1][0], 0, row[k].form == TUBE ? 6e-8 : 7e-5);
    if (row[k].form == TUBE) continue; /* whose volume fixes the radius outside; a shell has a pole */
    CHECK_CLOSE(out[1][1], 0, 2e-3);
    CHECK(order_of(out[0][0], out[1][0]) > 1.9, "order %g", (double)order_of(out[0][0], out[1][0]));
    CHECK(order_of(out[0][1], out[1][1]) > 1.2, "order %g", (double)order_of(out[0][1], out[1][1]));
  }
}

/* A solid of nu = 0.4999 whose cells share their volume: between it and the exactly incompressible
 * one are 2e-4 of the radius outside and less than 1e-3 of the pressure. */
static void test_nearly_incompressible(void **state)
{
  static const Matter rubber = {"neo-hookean-split", 2, {V("shear", 1e6), V("poisson", 0.4999)}};
  static const struct {
    Form form;
    PetscReal la, outside;
  } row[] = {{TUBE, 1.5, 2.2912878}, {TUBE, 2, 2.6457513}, {SHELL, 1.5, 2.1810353}, {SHELL, 2, 2.4662121}};
  (void)state;
  for (size_t k = 0; k < sizeof row / sizeof *row; ++k) {
    const PetscReal exact = rubber_pressure(row[k].form, row[k].la, row[k].outside / 2);
    PetscReal error[2];
    for (int fine = 0; fine < 2; ++fine) {
      const Opened o = opened(row[k].form, &rubber, "mean-dilatation", fine ? 16 : 8, row[k].la, 10);
      error[fine] = o.pressure / 1e6 / exact - 1;
      for (int side = 0; fine && side <= (row[k].form == SHELL); ++side)
        CHECK_CLOSE(o.outside[side], row[k].outside, side ? 2e-3 : 2e-4);
    }
    if (row[k].form == TUBE) CHECK(PetscAbsReal(error[1]) < 5e-4, "pressure off by %g", (double)error[1]);
    else CHECK(order_of(error[0], error[1]) > 1.8, "%g, then %g", (double)error[0], (double)error[1]);
    CHECK(PetscAbsReal(error[1]) < 2.5e-3, "pressure off by %g", (double)error[1]);
  }
}

/* --- limit loads --- */

/* Of a wall whose radii stand in this ratio: cohesion 1, m = 1 in a tube and 2 in a shell. In a
 * tube the axial stress lies between the other two, in a shell there are two hoops: dilatancy does
 * not count in either. */
static PetscReal limit_of(Form form, PetscReal friction, PetscReal ratio)
{
  const PetscReal m = form == TUBE ? 1 : 2, N = (1 + PetscSinReal(friction)) / (1 - PetscSinReal(friction));
  if (friction == 0) return 2 * m * PetscLogReal(ratio);
  return (PetscPowReal(ratio, m * (N - 1) / N) - 1) / PetscTanReal(friction);
}

static void test_limit_loads(void **state)
{
  static const Matter j2 = {"j2", 3, {V("young", 1e5), V("poisson", 0.49), V("yield_stress", 1.7320508075688772)}};
  static const Matter clay = {
    "mohr-coulomb", 4, {V("young", 1e5), V("poisson", 0.49), V("friction_angle", 0), V("cohesion", 1)}};
  static const Matter sand[] = {
    {"mohr-coulomb", 4, {V("young", 1e5), V("poisson", 0.3), V("friction_angle", 30), V("cohesion", 1)}},
    {"mohr-coulomb",
     5,
     {V("young", 1e5), V("poisson", 0.3), V("friction_angle", 30), V("cohesion", 1), V("dilatancy_angle", 10)}}};
  const struct {
    const Matter *matter;
    const char *formulation;
    Form form;
    PetscReal friction, within; /* 16 cells over the wall */
  } row[] = {{&j2, "mixed", TUBE, 0, 2.5e-3},
             {&j2, "mean-dilatation", TUBE, 0, 2.5e-3},
             {&clay, "mean-dilatation", TUBE, 0, 2.5e-3},
             {&clay, "mean-dilatation", SHELL, 0, 2.5e-3},
             {&sand[0], "mean-dilatation", TUBE, PETSC_PI / 6, 2.5e-3},
             {&sand[0], "mean-dilatation", SHELL, PETSC_PI / 6, 2.5e-3},
             {&clay, "mixed", TUBE, 0, 2.5e-3},
             {&clay, "mixed", SHELL, 0, 2.5e-3},
             {&sand[0], "mixed", TUBE, PETSC_PI / 6, 2.5e-3},
             {&sand[0], "displacement", TUBE, PETSC_PI / 6, 1.1e-2},
             {&sand[1], "displacement", TUBE, PETSC_PI / 6, 4e-3},
             {&sand[0], "mixed", SHELL, PETSC_PI / 6, 2.5e-3},
             {&sand[0], "displacement", SHELL, PETSC_PI / 6, 1.1e-2},
             {&sand[1], "displacement", SHELL, PETSC_PI / 6, 1.1e-2}};
  (void)state;
  for (size_t k = 0; k < sizeof row / sizeof *row; ++k) {
    PetscReal error[2];
    for (int fine = 0; fine < 2; ++fine) {
      const PetscReal to = 1 + 5e-4;
      const Opened o = opened(row[k].form, row[k].matter, row[k].formulation, fine ? 16 : 8, to, 20);
      error[fine] = o.pressure / limit_of(row[k].form, row[k].friction, o.outside[0] / to) - 1;
    }
    const PetscReal order = order_of(error[0], error[1]);
    CHECK(PetscAbsReal(error[1]) < row[k].within, "%s, %s: off by %g", row[k].matter->law, row[k].formulation,
          (double)error[1]);
    CHECK(order > (row[k].within < 5e-3 ? 1.8 : 1), "%s, %s: order %g", row[k].matter->law, row[k].formulation,
          (double)order);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_incompressible),
                                     cmocka_unit_test(test_nearly_incompressible), cmocka_unit_test(test_limit_loads)};
  return run_model_tests(argc, argv, tests);
}
