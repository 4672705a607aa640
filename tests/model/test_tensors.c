/* Stress and strain as measures: uniform and linear fields put on the points by hand, at places of the
 * material and over parts of it. */
#include "case_builder.h"
#include "clouds.h"

/* Cauchy stress, Pa: linear in x, y, z. */
static void field(const PetscReal *x, PetscInt dim, PetscReal sigma[6])
{
  const PetscReal z = dim == 3 ? x[2] : 0;
  sigma[0] = -100 + 30 * x[0] - 20 * x[1] + 7 * z;
  sigma[1] = -200 + 10 * x[0] + 50 * x[1] - 11 * z;
  sigma[2] = -150 - 40 * x[1];
  sigma[3] = 20 + 15 * x[0];
  sigma[4] = dim == 3 ? 5 - 3 * x[1] : 0;
  sigma[5] = dim == 3 ? -4 + 2 * z : 0;
}

static void put_stress(Model *m)
{
  const PetscReal J = 1.25;
  PetscReal tau[6];
  for (PetscInt p = 0; p < m->points->n; ++p) {
    field(point_real(m->points, POINT_X, p), m->dim, tau);
    for (int k = 0; k < 6; ++k) tau[k] *= J;
    m->points->real[POINT_J][p] = J;
    point_set_tau(m->points, p, tau);
  }
}

static PetscReal measure(Model *m, const MeasureSpec *spec, PetscInt index)
{
  PetscReal value;
  CALL(ModelMeasure(m, spec, index, &value));
  return value;
}

#define N_PLACES 4
/* inside, at a side, in a corner, between points */
static const PetscReal places[N_PLACES][3] = {{0.5, 0.5, 0.5}, {1, 0.3, 0.7}, {0, 0, 0}, {0.61, 0.87, 0.13}};

static void check_places(const char *method, CellType cell)
{
  static const char *const words[] = {"xx", "yy", "zz", "xy", "yz", "zx"};
  PetscReal sigma[6];
  Bench b;
  bench_init(&b, method, cell, cell < CELL_TETRAHEDRON ? 6 : 4);
  if (!strcmp(method, "gmm")) b.c.basis = usual_lme;
  bench_motion(&b, 1, 0, MOTION_FIXED, 7);
  for (int k = 0; k < N_PLACES; ++k) {
    MeasureSpec *s = bench_tracer(&b, "stress", 0, places[k][0], places[k][1], places[k][2]);
    s->word = (char *)"xx";
    s->has_tracer = PETSC_TRUE;
  }
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  put_stress(m);
  for (int k = 0; k < N_PLACES; ++k) {
    field(places[k], m->dim, sigma);
    for (int i = 0; i < 6; ++i) {
      MeasureSpec s = b.measure[k];
      s.word = (char *)words[i];
      CHECK_CLOSE(measure(m, &s, k), sigma[i], 1e-9);
    }
  }
  CALL(ModelDestroy(&m));
}

static void test_places(void **state)
{
  (void)state;
  check_places("mpm", CELL_QUADRILATERAL);
  check_places("fem", CELL_TRIANGLE);
  check_places("fem", CELL_QUADRILATERAL);
  check_places("mpm", CELL_HEXAHEDRON);
  check_places("fem", CELL_TETRAHEDRON);
  check_places("gmm", CELL_QUADRILATERAL); /* whose points are in no cell */
  check_places("gmm", CELL_TRIANGLE);
  check_places("gmm", CELL_HEXAHEDRON);
}

/* Of a linear field that of the middle; of a shape its own middle. */
static void test_means(void **state)
{
  const PetscReal middle[3] = {0.5, 0.5}, left[3] = {0.375, 0.5};
  PetscReal sigma[6];
  Bench b;
  (void)state;
  bench_init(&b, "fem", CELL_QUADRILATERAL, 4);
  bench_motion(&b, 1, 0, MOTION_FIXED, 7);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  put_stress(m);
  field(middle, 2, sigma);
  const MeasureSpec whole = {.kind = "stress", .word = "yy", .body = "body"};
  CHECK_CLOSE(measure(m, &whole, 0), sigma[1], 1e-10);
  MeasureSpec half = {.kind = "stress", .word = "xx", .has_in = PETSC_TRUE};
  half.in = (Shape){.kind = SHAPE_BOX, .min = {0.125, 0, 0}, .max = {0.625, 1, 1}}; /* even in points */
  field(left, 2, sigma);
  CHECK_CLOSE(measure(m, &half, 0), sigma[0], 1e-10);
  CALL(ModelDestroy(&m));
}

/* Axes turned by 30 degrees from (-50, -90), out of the plane -70: p 70, q by its definition, sin phi
 * = 40 / 140. */
static void test_invariants(void **state)
{
  const PetscReal a = PETSC_PI / 6, mean = -70, radius = 20;
  const PetscReal sigma[6] = {mean + radius * cos(2 * a), mean - radius * cos(2 * a), -70, radius * sin(2 * a)};
  const struct {
    const char *word;
    PetscReal value;
  } wanted[] = {{"p", 70},        {"q", sqrt(3) * 20}, {"mobilised_friction", asin(2. / 7) * 180 / PETSC_PI},
                {"sigma_1", -50}, {"sigma_2", -70},    {"sigma_3", -90}};
  Bench b;
  (void)state;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 2);
  bench_motion(&b, 1, 0, MOTION_FIXED, 7);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (PetscInt p = 0; p < m->points->n; ++p) point_set_tau(m->points, p, sigma);
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(wanted); ++k) {
    const MeasureSpec s = {.kind = "stress", .word = (char *)wanted[k].word};
    CHECK_CLOSE(measure(m, &s, 0), wanted[k].value, 1e-10);
  }
  CALL(ModelDestroy(&m));
}

/* Simple shear F = I + g e_x e_y: principal stretches with l - 1/l = g, axes at atan(l). */
static void test_strain(void **state)
{
  const PetscReal g = 0.8, l = 0.5 * (g + sqrt(g * g + 4)), F[9] = {1, g, 0, 0, 1, 0, 0, 0, 1};
  const PetscReal c = l / sqrt(1 + l * l), s = 1 / sqrt(1 + l * l), e = log(l);
  const struct {
    const char *word;
    PetscReal value;
  } wanted[] = {{"xx", e * (c * c - s * s)},
                {"yy", e * (s * s - c * c)},
                {"zz", 0},
                {"xy", 2 * e * c * s},
                {"volumetric", 0},
                {"deviatoric", 2 / sqrt(3) * e},
                {"eps_1", e},
                {"eps_2", 0},
                {"eps_3", -e}};
  Bench b;
  (void)state;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 2);
  bench_motion(&b, 1, 0, MOTION_FIXED, 7);
  MeasureSpec *tracer = bench_tracer(&b, "strain", 0, 0.3, 0.4, 0);
  tracer->word = (char *)"xy";
  tracer->has_tracer = PETSC_TRUE;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  for (PetscInt p = 0; p < m->points->n; ++p) point_set_F(m->points, p, F);
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(wanted); ++k) {
    const MeasureSpec spec = {.kind = "strain", .word = (char *)wanted[k].word};
    CHECK_CLOSE(measure(m, &spec, 0), wanted[k].value, 1e-12);
  }
  CHECK_CLOSE(measure(m, tracer, 0), 2 * e * c * s, 1e-12);
  CALL(ModelDestroy(&m));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_places), cmocka_unit_test(test_means),
                                     cmocka_unit_test(test_invariants), cmocka_unit_test(test_strain)};
  return run_model_tests(argc, argv, tests);
}
