/* Uniform stress between walls, and between bodies, wherever surfaces stand in their cells and whatever steps have led
 * there: what a wall gives to nodes is the integral of their functions over the surface, as stress has it. And a layer
 * that is bonded to both its walls is sheared as far as one likes. */
#include "case_builder.h"

#define YOUNG 1e6
#define PRESSED 0.9 /* of the height of 0.5 m */

typedef struct {
  const char *what, *basis;
  const Kinematics *kinematics;
  PetscReal shift; /* of the grid, down */
  PetscInt steps;
  PetscReal joint; /* height of an interface; 0: one body */
  PetscReal tolerance;
} Patch;

/* Of a step on from a uniform state splines make one of bands, their points being no rule for what is cut. */
static const Patch patches[] = {
  {"gimp, along lines", "gimp", &kinematics_plane_strain, 0, 10, 0, 1e-4},
  {"gimp, across cells", "gimp", &kinematics_plane_strain, 0.03, 10, 0, 1e-4},
  {"gimp, rings", "gimp", &kinematics_axisymmetric, 0.03, 10, 0, 1e-4},
  {"gimp, in space", "gimp", &kinematics_3d, 0.03, 4, 0, 1e-4},
  {"gimp, two bodies", "gimp", &kinematics_plane_strain, 0, 10, 0.2, 1e-4},
  {"gimp, two bodies across cells", "gimp", &kinematics_plane_strain, 0.03, 10, 0.23, 1e-4},
  {"splines, along lines", "bspline", &kinematics_plane_strain, 0, 1, 0, 1e-4},
  {"splines, across cells", "bspline", &kinematics_plane_strain, 0.03, 1, 0, 1e-4},
  {"splines, in space", "bspline", &kinematics_3d, 0, 1, 0, 1e-4},
  {"splines, two bodies", "bspline", &kinematics_plane_strain, 0, 1, 0.2, 1e-4},
};

static void half_space(WallSpec *wall, const char *name, PetscReal at, PetscReal normal)
{
  *wall = (WallSpec){.name = (char *)name, .shape = {.kind = SHAPE_HALF_SPACE}};
  wall->shape.point[1] = at;
  wall->shape.normal[1] = normal;
}

static void set_up(Bench *b, const Patch *k, WallSpec walls[2], MotionSpec *down, InterfaceSpec *joint)
{
  static char *between[] = {(char *)"body", (char *)"upper"};
  const PetscReal wide = 0.4, high = 0.5;
  bench_init(b, "mpm", k->kinematics->dim == 3 ? CELL_HEXAHEDRON : CELL_QUADRILATERAL, 0);
  b->c.kinematics = k->kinematics;
  b->constants[0].value = YOUNG, b->constants[1].value = 0;
  bench_grid(b, (PetscReal[]){0, -0.2 - k->shift, 0}, (PetscReal[]){0.6, 0.7 - k->shift, 0.3}, 0.1);
  b->c.basis.kind = k->basis;
  b->body[0].weights = WEIGHTS_GAUSS;
  bench_box(b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){wide, k->joint > 0 ? k->joint : high, 0.3});
  if (k->joint > 0) {
    b->body[1] = b->body[0];
    b->body[1].name = (char *)"upper";
    bench_box(b, 1, (PetscReal[]){0, k->joint, 0}, (PetscReal[]){wide, high, 0.3});
    b->c.n_bodies = 2;
    *joint = (InterfaceSpec){.name = (char *)"joint", .n_between = 2, .between = between};
    b->c.n_interfaces = 1, b->c.interfaces = joint;
  }
  bench_motion(b, 0, 0, MOTION_FIXED, 1);
  for (int side = 0; side < 2 && k->kinematics->dim == 3; ++side) bench_motion(b, 2, 0.3 * side, MOTION_FIXED, 4);
  half_space(&walls[0], "floor", 0, 1);
  half_space(&walls[1], "plate", high, -1);
  walls[1].n_motions = 1, walls[1].motions = down;
  b->c.n_walls = 2, b->c.walls = walls;
  b->c.analysis.step = b->c.analysis.largest = 1 / (PetscReal)k->steps;
}

/* sigma_yy of all points, by the neo-Hookean law without Poisson's number, mu (lambda^2 - 1) / lambda. */
static void test_uniform(void **state)
{
  const PetscReal expected = 0.5 * YOUNG * (PRESSED * PRESSED - 1) / PRESSED;
  (void)state;
  EACH_OF (i, patches) {
    const Patch *k = patches + i;
    MotionSpec down = {.kind = MOTION_DISPLACEMENT, .value = {0, 0.5 * (PRESSED - 1), 0}};
    InterfaceSpec joint;
    WallSpec walls[2];
    PetscReal off = 0, all, sigma[6];
    Bench b;
    set_up(&b, k, walls, &down, &joint);
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    while (m->time < 1 - 1e-9) model_step(m, 1 - m->time);
    for (PetscInt p = 0; p < m->points->n; ++p) {
      CALL(ModelPointStress(m, p, sigma));
      off = PetscMax(off, PetscAbsReal(sigma[1] / expected - 1));
    }
    MPI_Allreduce(&off, &all, 1, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD);
    PetscPrintf(PETSC_COMM_WORLD, "%s: stress of a point off by %.2g at most\n", k->what, (double)all);
    CHECK(all < k->tolerance, "%s: %g", k->what, (double)all);
    CALL(ModelDestroy(&m));
    bench_end(&b);
  }
}

/* In the middle of the layer. */
static void stress_at(Bench *b, const char *component)
{
  MeasureSpec *s = bench_tracer(b, "stress", 0, 2, 0.25, 0);
  s->word = (char *)component;
  s->has_tracer = PETSC_TRUE;
}

/* Simple shear far from the ends of the layer: sigma_xy = mu gamma, sigma_xx = mu gamma^2. At the ends, where strains
 * change from point to point, more points are bonded than nodes could follow. */
static void test_sheared(void **state)
{
  static const char *const bases[] = {"gimp", "bspline", "cell"};
  const PetscReal gamma = 0.5, mu = 0.5 * YOUNG;
  (void)state;
  EACH_OF (k, bases) {
    MotionSpec along = {.kind = MOTION_DISPLACEMENT, .component = {1, 1, 1}, .value = {0.5 * gamma, 0, 0}};
    WallSpec walls[2];
    PetscReal found[2];
    Bench b;
    bench_init(&b, "mpm", CELL_QUADRILATERAL, 0);
    b.constants[0].value = YOUNG, b.constants[1].value = 0;
    bench_grid(&b, (PetscReal[]){-0.5, -0.1, 0}, (PetscReal[]){4.5, 0.6, 0}, 0.1);
    bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){4, 0.5, 0});
    b.c.basis.kind = bases[k];
    half_space(&walls[0], "floor", 0, 1);
    half_space(&walls[1], "plate", 0.5, -1);
    walls[0].contact = walls[1].contact = CONTACT_BONDED;
    walls[1].n_motions = 1, walls[1].motions = &along;
    b.c.n_walls = 2, b.c.walls = walls;
    b.c.analysis.step = b.c.analysis.largest = 0.1;
    stress_at(&b, "xy");
    stress_at(&b, "xx");
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    PetscInt cuts = 0;
    while (m->time < 1 - 1e-9) cuts += model_step(m, 1 - m->time).cuts;
    for (PetscInt i = 0; i < 2; ++i) CALL(ModelMeasure(m, b.measure + i, i, found + i));
    const PetscReal deepest = PetscMax(model_wall(m, "floor", "contact", "penetration", 0),
                                       model_wall(m, "plate", "contact", "penetration", 0));
    PetscPrintf(PETSC_COMM_WORLD, "%s sheared: %.7g and %.7g Pa of %.7g and %.7g, %.2g m deep\n", bases[k],
                (double)found[0], (double)found[1], (double)(mu * gamma), (double)(mu * gamma * gamma),
                (double)deepest);
    CHECK(cuts == 0, "%d halvings", (int)cuts);
    CHECK_CLOSE(found[0], mu * gamma, 1e-4 * mu * gamma);
    CHECK_CLOSE(found[1], mu * gamma * gamma, 1e-4 * mu * gamma);
    CHECK(deepest < 0.01 * 0.1, "%g m deep", (double)deepest);
    CALL(ModelDestroy(&m));
    bench_end(&b);
  }
}

/* In space each point is known to up to 64 nodes, and contact looks at all of them. */
static void test_stands(void **state)
{
  static const char *const bases[] = {"gimp", "bspline"};
  (void)state;
  EACH_OF (k, bases) {
    const Patch patch = {bases[k], bases[k], &kinematics_3d, 0.03, 3, 0, 0};
    MotionSpec down = {.kind = MOTION_FIXED};
    InterfaceSpec joint;
    WallSpec walls[2];
    Bench b;
    set_up(&b, &patch, walls, &down, &joint);
    b.c.n_walls = 1;
    b.c.gravity[1] = -10;
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    while (m->time < 1 - 1e-9) model_step(m, 1 - m->time);
    const PetscReal weight = 10 * b.material.density * 0.4 * 0.5 * 0.3,
                    borne = model_wall(m, "floor", "wall_force", NULL, 1);
    CHECK_CLOSE(borne, weight, 1e-8 * weight);
    CALL(ModelDestroy(&m));
    bench_end(&b);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_uniform), cmocka_unit_test(test_sheared),
                                     cmocka_unit_test(test_stands)};
  return run_model_tests(argc, argv, tests);
}
