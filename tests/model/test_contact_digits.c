/* The last digits of a constant do not choose among answers of contact: what goes with its wall is not rubbed, and a
 * body that has touched is as stiff as another by round-off. */
#include "case_builder.h"

static PetscReal measure(Model *m, const char *kind, const char *word, PetscInt component)
{
  return model_wall(m, "floor", kind, word, component);
}

/* A block of rubber, 1 x 0.75 m, on a floor that rubs. */
static void on_floor(Bench *b, const char *method, const char *basis, WallSpec *floor)
{
  const PetscReal left = strcmp(method, "fem") ? -0.25 : 0;
  bench_init(b, method, CELL_QUADRILATERAL, 0);
  bench_grid(b, (PetscReal[]){left, 0, 0}, (PetscReal[]){1 - left, 0.75 - left, 0}, 0.25);
  bench_box(b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 0.75, 0});
  b->c.basis = (BasisSpec){.kind = basis};
  b->c.linear = LINEAR_AUTO;
  b->c.newton = (NewtonSpec){.residual = 1e-11, .increment = 1e-12, .max_iterations = 25, .ease = 6};
  b->material.density = 1900;
  *floor = (WallSpec){.name = (char *)"floor",
                      .shape = {.kind = SHAPE_HALF_SPACE, .normal = {0, 1}},
                      .contact = CONTACT_FRICTION,
                      .friction = 0.3};
  b->c.n_walls = 1;
  b->c.walls = floor;
}

/* Pushed aside by a tenth of its weight, parts of its base stick and others slide. How the top moves aside, and the
 * work of friction. */
static void push(const char *method, const char *basis, PetscReal more, PetscReal found[2])
{
  Bench b;
  WallSpec floor;
  on_floor(&b, method, basis, &floor);
  b.constants[0].value = 3e5 * (1 + more);
  b.c.gravity[0] = 0.3, b.c.gravity[1] = -3;
  bench_tracer(&b, "displacement", 0, 0.9, 0.7, 0);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (int k = 0; k < 2; ++k) model_step(m, 0.5);
  CALL(ModelMeasure(m, m->c->measures, 0, found));
  found[1] = measure(m, "contact", "sliding", 0);
  CALL(ModelDestroy(&m));
}

static void test_pushed(void **state)
{
  static const char *const ways[][2] = {{"fem", "cell"}, {"mpm", "gimp"}};
  (void)state;
  EACH_OF (k, ways) {
    PetscReal first[2], found[2], off[2] = {0, 0};
    push(ways[k][0], ways[k][1], 0, first);
    for (int i = 1; i <= 24; ++i) {
      push(ways[k][0], ways[k][1], (i % 2 ? -1e-14 : 1e-14) * i * i, found);
      for (int j = 0; j < 2; ++j) off[j] = PetscMax(off[j], PetscAbsReal(found[j] - first[j]));
    }
    PetscPrintf(PETSC_COMM_WORLD, "%s: aside %.9g m, by digits %.2g, friction %.9g J, %.2g\n", ways[k][0],
                (double)first[0], (double)off[0], (double)first[1], (double)off[1]);
    CHECK_CLOSE(off[0], 0, 1e-8 * PetscAbsReal(first[0]));
    CHECK_CLOSE(off[1], 0, 1e-8 * PetscAbsReal(first[1]));
  }
}

/* It comes down on a floor that goes along with it but for the last digits: what rubs is alike on both sides, and there
 * is no force along the floor. */
static void test_goes_along(void **state)
{
  static const PetscBool lumped[] = {PETSC_TRUE, PETSC_FALSE};
  MotionSpec along = {.kind = MOTION_VELOCITY, .component = {1, 1, 1}, .value = {0.3 * (1 + 2e-15), 0.2, 0}};
  (void)state;
  EACH_OF (k, lumped) {
    Bench b;
    WallSpec floor;
    on_floor(&b, "fem", "cell", &floor);
    floor.n_motions = 1, floor.motions = &along;
    b.body[0].velocity[0] = 0.3, b.body[0].velocity[1] = -0.4;
    bench_dynamic(&b, 1, 0.01);
    if (lumped[k]) b.c.analysis.mass = MASS_LUMPED;
    Model *m = bench_model(&b, PETSC_COMM_WORLD);
    for (int step = 0; step < 4; ++step) {
      model_step(m, 0.01);
      const PetscReal across = measure(m, "wall_force", NULL, 0), weight = measure(m, "wall_force", NULL, 1);
      PetscPrintf(PETSC_COMM_WORLD, "goes along, lumped %d: %.3g of %.6g N\n", lumped[k], (double)across,
                  (double)weight);
      CHECK(weight > 1e4 && PetscAbsReal(across) < 1e-6 * weight, "%g N along the floor", (double)across);
    }
    CALL(ModelDestroy(&m));
  }
}

/* A modulus that changes in its last digits in every step is one that does not: how far a point is from its surface,
 * and how much of it it stands for, are those of the strain that there is, not of all that the stress was given
 * anew. */
static void settle(const char *method, const char *basis, PetscBool changes, PetscReal found[2])
{
  PetscReal time[] = {0, 1}, value[] = {1, 1 + 1e-6};
  NamedAmplitude amplitude = {.name = (char *)"young", .amplitude = {.n = 2, .time = time, .value = value}};
  Bench b;
  WallSpec floor;
  on_floor(&b, method, basis, &floor);
  b.constants[0].value = 3e5;
  b.c.gravity[1] = -10;
  if (changes) b.material.n_amplitudes = 1, b.material.amplitudes = &amplitude;
  b.c.analysis.step = b.c.analysis.largest = 0.025;
  bench_tracer(&b, "displacement", 1, 0.5, 0.7, 0);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  while (m->time < 1 - 1e-9) model_step(m, 1 - m->time);
  CALL(ModelMeasure(m, m->c->measures, 0, found));
  found[1] = measure(m, "contact", "area", 0);
  CALL(ModelDestroy(&m));
}

static void test_ages(void **state)
{
  static const char *const ways[][2] = {{"fem", "cell"}, {"mpm", "gimp"}};
  (void)state;
  EACH_OF (k, ways) {
    PetscReal kept[2], changed[2];
    settle(ways[k][0], ways[k][1], PETSC_FALSE, kept);
    settle(ways[k][0], ways[k][1], PETSC_TRUE, changed);
    PetscPrintf(PETSC_COMM_WORLD, "%s: settles by %.9g and %.9g m, area %.9g and %.9g m\n", ways[k][0], (double)kept[0],
                (double)changed[0], (double)kept[1], (double)changed[1]);
    for (int i = 0; i < 2; ++i) CHECK_CLOSE(changed[i], kept[i], 1e-5 * PetscAbsReal(kept[i]));
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_pushed), cmocka_unit_test(test_goes_along),
                                     cmocka_unit_test(test_ages)};
  return run_model_group(argc, argv, tests, PETSC_STATIC_ARRAY_LENGTH(tests));
}
