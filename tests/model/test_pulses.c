/* Amplitudes that do more within a step than steps see: told before the first one, and nothing else is. */
#include "case_builder.h"

#define STEP 2e-3

typedef struct {
  PetscInt n;
  PetscReal time[6], value[6];
  const char *words, *statics; /* NULL: nothing is lost */
} Kind;

#define PEAK "it goes to 1 at t = "

static const Kind kinds[] = {
  {5, {0, 0.0993, 0.0996, 0.0999, 1}, {0, 0, 1, 0, 0}, "its integral is 0.0003 s, and steps take 0 s for it", PEAK},
  {5, {0, 0.0997, 0.1, 0.1003, 1}, {0, 0, 1, 0, 0}, "its integral is 0.0003 s, and steps take 0.002 s for it", NULL},
  {6, {0, 0.0981, 0.0982, 0.0991, 0.0992, 1}, {0, 0, 1, 1, 0, 0}, "steps take 0 s for it", PEAK},
  {5, {0, 0.097, 0.099, 0.101, 1}, {0, 0, 1, 0, 0}, NULL, PEAK},          /* sides as long as a step */
  {3, {0, 0.007, 0.02}, {0, 1, 0}, NULL, PEAK "0.007 s and back within"}, /* sides of many steps */
  {6, {0.001, 0.003, 0.005, 0.007, 0.009, 0.011}, {0.588, 0.809, 0.951, 1, 0.951, 0.809}, NULL, NULL}, /* a sine */
  {4, {0, 0.0993, 0.0994, 1}, {0, 0, 1, 1}, NULL, NULL},                                               /* a jump */
  {5, {0, 0.05, 0.0503, 0.0506, 0.1}, {0, 0.5, 0.503, 0.506, 1}, NULL, NULL}                           /* on a line */
};

/* A block with a traction of that amplitude. */
static void block(Bench *b, const char *method, const Kind *k)
{
  bench_init(b, method, CELL_QUADRILATERAL, 2);
  bench_dynamic(b, 0.2, STEP);
  bench_motion(b, 1, 0, MOTION_FIXED, 3);
  LoadSpec *load = bench_traction(b, 1, 1, "body", 0, -1000, 0);
  load->amplitude = (Amplitude){.n = k->n, .time = (PetscReal *)k->time, .value = (PetscReal *)k->value};
}

static void test_loads(void **state)
{
  (void)state;
  EACH_OF (k, kinds) {
    Bench b;
    block(&b, k % 2 ? "fem" : "mpm", kinds + k);
    bench_warned(&b, PETSC_COMM_WORLD, "loads.tractions[0].amplitude", kinds[k].words);
    b.c.analysis.type = ANALYSIS_STATIC;
    bench_warned(&b, PETSC_COMM_WORLD, "loads.tractions[0].amplitude", kinds[k].statics);
  }
}

/* What steps make of all of it: sides shorter than a step, a step apart and more. In steps that may grow its corners
 * are ends of steps, but for those that lie closer together than `step`, and for what the first two steps, which have
 * not grown, go over. */
static void test_sums(void **state)
{
  static const struct {
    Kind kind;
    PetscReal largest;
  } sums[] = {
    {{5,
      {0, 0.0072, 0.0076, 0.011, 0.0114},
      {0, 0, 1, 1, 0},
      "its integral over the run is 0.0038 s, and steps of 0.002 s take 0.004 s",
      NULL},
     STEP},
    {{5, {0, 0.021, 0.0230, 0.031, 0.033}, {0, 0, 1, 1, 0}, NULL, NULL}, STEP},
    {{5, {0, 0.021, 0.0232, 0.031, 0.0333}, {0, 0, 1, 1, 0}, NULL, NULL}, 50 * STEP},
    {{5, {0, 0.021, 0.0212, 0.0233, 0.0235}, {0, 0, 1, 1, 0}, "its integral", NULL}, 50 * STEP},
    {{5, {0, 0.0503, 0.0507, 0.0511, 0.2}, {0, 0, 1, 0, 0}, "is 0.0004 s, and steps take 0 s", NULL}, 50 * STEP},
    {{3, {0, 0.0021, 0.0022}, {1, 1, 0}, "is 0.00215 s, and steps of 0.002 s take 0.003 s", NULL}, 50 * STEP},
    {{3, {0, 0.0301, 0.0302}, {1, 1, 0}, NULL, NULL}, 50 * STEP},
  };
  (void)state;
  EACH_OF (k, sums) {
    Bench b;
    block(&b, "fem", &sums[k].kind);
    b.c.analysis.largest = sums[k].largest;
    bench_warned(&b, PETSC_COMM_WORLD, "loads.tractions[0].amplitude", sums[k].kind.words);
  }
}

/* A record twice as close as steps: what swings to both sides makes up for itself within three steps, to 4 %, and is
 * not told; what swings to one side is, over the whole run. */
static void test_records(void **state)
{
  PetscReal time[201], value[201];
  const Kind none = {.n = 0};
  (void)state;
  for (int one = 0; one < 2; ++one) {
    Bench b;
    block(&b, "fem", &none);
    for (int i = 0; i < 201; ++i) {
      time[i] = i * STEP / 2;
      value[i] = 0.5 + (i % 2 == 0 ? 0 : one || i % 4 == 1 ? 0.12 : -0.12);
    }
    b.load[0].amplitude = (Amplitude){.n = 201, .time = time, .value = value};
    bench_warned(&b, PETSC_COMM_WORLD, "loads.tractions[0].amplitude",
                 one ? "its integral over the run is 0.112 s, and steps of 0.002 s take 0.1 s" : NULL);
  }
}

/* A factor on a parameter is what it is at the end of a step, in statics and in dynamics. */
static void test_parameters(void **state)
{
  NamedAmplitude soft = {.name = "young"};
  (void)state;
  for (int statics = 0; statics < 2; ++statics) {
    Bench b;
    block(&b, "fem", kinds);
    soft.amplitude = b.load[0].amplitude;
    soft.amplitude.value = (PetscReal[]){1, 1, 0.1, 1, 1};
    b.c.n_loads = 0;
    if (statics) b.c.analysis.type = ANALYSIS_STATIC;
    b.c.materials[0].n_amplitudes = 1;
    b.c.materials[0].amplitudes = &soft;
    bench_warned(&b, PETSC_COMM_WORLD, "amplitude.young", "it goes to 0.1 at t = 0.0996 s and back");
  }
}

/* Displacements are asked for at the ends of steps, velocities are integrated; substeps see what steps do not. */
static void test_motions(void **state)
{
  Bench b;
  (void)state;
  block(&b, "mpm", kinds);
  const Amplitude amplitude = b.load[0].amplitude;
  b.c.n_loads = 0;
  MotionSpec *top = bench_motion(&b, 1, 1, MOTION_DISPLACEMENT, 2);
  top->value[1] = -0.01;
  top->amplitude = amplitude;
  bench_warned(&b, PETSC_COMM_WORLD, "boundary[1].amplitude", "it goes to 1 at t = 0.0996 s and back");
  top->kind = MOTION_VELOCITY;
  bench_warned(&b, PETSC_COMM_WORLD, "boundary[1].amplitude", NULL);
  block(&b, "mpm", kinds);
  b.c.analysis.type = ANALYSIS_EXPLICIT;
  bench_warned(&b, PETSC_COMM_WORLD, "loads.tractions[0].amplitude", "the step of 0.002 s");
  b.constants[0].value = 1e10;
  bench_warned(&b, PETSC_COMM_WORLD, "loads.tractions[0].amplitude", NULL);
}

/* What stands at a place from the start on is there at once in dynamics, and told; what grows, turns or flows is
 * not. */
static void test_jumps(void **state)
{
  static const struct {
    MotionKind kind;
    PetscReal first; /* value of an amplitude at the start; < 0: there is none */
    AnalysisType type;
    const char *path, *words;
  } jumps[] = {
    {MOTION_DISPLACEMENT, -1, ANALYSIS_DYNAMIC, "boundary[1].displacement", "jumps by 0.01 m at the start"},
    {MOTION_DISPLACEMENT, -1, ANALYSIS_EXPLICIT, "boundary[1].displacement", "jumps by 0.01 m at the start"},
    {MOTION_DISPLACEMENT, 0.5, ANALYSIS_DYNAMIC, "boundary[1].amplitude", "jumps by 0.005 m at the start"},
    {MOTION_DISPLACEMENT, 0, ANALYSIS_DYNAMIC, "boundary[1]", NULL},
    {MOTION_DISPLACEMENT, -1, ANALYSIS_STATIC, "boundary[1]", NULL},
    {MOTION_VELOCITY, -1, ANALYSIS_DYNAMIC, "boundary[1]", NULL},
  };
  PetscReal time[2] = {0, 0.2}, value[2] = {0, 1};
  (void)state;
  EACH_OF (k, jumps) {
    Bench b;
    bench_init(&b, jumps[k].type == ANALYSIS_EXPLICIT ? "mpm" : "fem", CELL_QUADRILATERAL, 2);
    bench_dynamic(&b, 0.2, STEP);
    b.c.analysis.type = jumps[k].type;
    bench_motion(&b, 1, 0, MOTION_FIXED, 3);
    MotionSpec *top = bench_motion(&b, 1, 1, jumps[k].kind, 2);
    top->value[1] = -0.01;
    value[0] = jumps[k].first;
    if (jumps[k].first >= 0) top->amplitude = (Amplitude){.n = 2, .time = time, .value = value};
    bench_warned(&b, PETSC_COMM_WORLD, jumps[k].path, jumps[k].words);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_loads),   cmocka_unit_test(test_sums),
                                     cmocka_unit_test(test_records), cmocka_unit_test(test_parameters),
                                     cmocka_unit_test(test_motions), cmocka_unit_test(test_jumps)};
  return run_model_tests(argc, argv, tests);
}
