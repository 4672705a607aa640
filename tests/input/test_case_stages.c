/* What a stage makes of lists: loads are replaced as a whole; bodies, boundary, walls and interfaces entry by entry. */
#include "test_case.h"

#define LOADED                                                                                       \
  PLAIN                                                                                              \
  "boundary: [{name: b, on: {boundary: bottom}, fix: [y]}, {on: {boundary: left}, fix: [x]}]\n"      \
  "walls: [{name: w, shape: {half-space: {point: [0, 0], normal: [0, 1]}}},\n"                       \
  "  {name: v, shape: {half-space: {point: [4, 0], normal: [-1, 0]}}}]\n"                            \
  "loads:\n  tractions: [{name: p, on: {body: beam, y: 1}, value: [0, -1]},\n"                       \
  "    {name: q, on: {body: beam, x: 2}, value: [-2, 0]}]\n"                                         \
  "  pressures: [{name: r, on: {body: beam, y: 1}, value: 3}, {on: {body: beam, x: 2}, value: 4}]\n" \
  "  points: [{name: s, at: [1, 0.5], force: [0, -5]}, {name: t, at: [1.5, 0.5], force: [0, -6]}]\n" \
  "measures: {m: {mass: total}, n: {energy: balance}}\nstages:\n  - {name: one}\n"

/* The second of two loads of each kind, named or not, and what it says. */
#define LATER "  - {name: two, loads: {%s}}\n"
static const struct {
  const char *list;
  PetscInt n;
  PetscReal sum; /* of all values, by magnitude */
} lists[] = {
  {"gravity: [0, -10]", 6, 21},
  {"tractions: [{name: q, on: {body: beam, x: 2}, value: [-2, 0]}]", 5, 20},
  {"tractions: [{on: {body: beam, x: 2}, value: [-2, 0]}]", 5, 20},
  {"tractions: []", 4, 18},
  {"pressures: [{name: r, on: {body: beam, y: 1}, value: 7}]", 5, 21},
  {"points: [{name: t, at: [1.5, 0.5], force: [0, -6]}]", 5, 16},
  {"points: [{name: t, at: [1.5, 0.5], force: [0, -6]}], tractions: []", 3, 13},
};

static void Loads(void **state)
{
  char text[4000];
  (void)state;
  for (size_t i = 0; i < sizeof lists / sizeof *lists; ++i) {
    snprintf(text, sizeof text, LOADED LATER, lists[i].list);
    Case *c = read_good(text);
    const Case *two = c->stage_case[1];
    PetscReal sum = 0;
    for (PetscInt k = 0; k < two->n_loads; ++k)
      sum += PetscAbsReal(two->loads[k].value[0]) + PetscAbsReal(two->loads[k].value[1]);
    if (two->n_loads != lists[i].n || PetscAbsReal(sum - lists[i].sum) > 1e-12)
      fail_msg("%s: %d loads, %g", lists[i].list, (int)two->n_loads, (double)sum);
    assert_int_equal(CaseDestroy(&c), 0);
  }
}

/* What goes on is as old as it was, though its list is another one. */
static void Ages(void **state)
{
  char text[4000];
  (void)state;
  snprintf(
    text, sizeof text, LOADED LATER,
    "tractions: [{name: q, on: {body: beam, x: 2}, value: [-2, 0]}, {name: p, on: {body: beam, y: 1}, value: [0, "
    "-9]}]");
  Case *c = read_good(text);
  assert_int_equal(c->stage_case[1]->loads[0].amplitude.since, 0);
  assert_int_equal(c->stage_case[1]->loads[1].amplitude.since, 1);
  assert_int_equal(CaseDestroy(&c), 0);
}

static void Entries(void **state)
{
  static const struct {
    const char *list;
    PetscInt boundary, walls, measures;
  } entries[] = {
    {"boundary: [{on: {boundary: right}, fix: [x]}]", 3, 2, 2}, /* behind the others, without a name, too */
    {"boundary: [{on: {boundary: left}, fix: [x]}]", 2, 2, 2},  /* is there */
    {"boundary: [{name: b, on: {boundary: bottom}, fix: [x, y]}]", 2, 2, 2},
    {"boundary: []", 0, 2, 2},
    {"walls: [{name: w, shape: {half-space: {point: [0, 0], normal: [0, 1]}}, contact: stick}]", 2, 2, 2},
    {"measures: {m: {mass: total}}", 2, 2, 2},
    {"measures: {m: {absent: true}}", 2, 2, 1},
  };
  char text[4000];
  (void)state;
  for (size_t i = 0; i < sizeof entries / sizeof *entries; ++i) {
    snprintf(text, sizeof text, LOADED "  - {name: two, %s}\n", entries[i].list);
    Case *c = read_good(text);
    const Case *two = c->stage_case[1];
    if (two->n_boundary != entries[i].boundary || two->n_walls != entries[i].walls ||
        two->n_measures != entries[i].measures)
      fail_msg("%s: %d, %d, %d", entries[i].list, (int)two->n_boundary, (int)two->n_walls, (int)two->n_measures);
    assert_int_equal(CaseDestroy(&c), 0);
  }
}

/* The second would take the place of the first. */
static void Names(void **state)
{
  static const char *const twice[] = {
    "boundary: [{name: n, on: {boundary: left}, fix: [x]}, {name: n, on: {boundary: right}, fix: [x]}]",
    "walls: [{name: w, contact: stick}, {name: w, contact: frictionless}]"};
  char text[4000], *said;
  (void)state;
  for (size_t i = 0; i < sizeof twice / sizeof *twice; ++i) {
    snprintf(text, sizeof text, LOADED "  - {name: two, %s}\n", twice[i]);
    assert_null(read_text(text, &said));
    if (!strstr(said, "is taken by stages[1].")) fail_msg("%s", said);
    free(said);
  }
}

/* The clock goes on through stages: steps that it cannot tell any more are refused, those that it rounds are told. */
static void Clock(void **state)
{
  static const struct {
    const char *step, *says;
    PetscBool taken;
  } steps[] = {
    {"1e-3", NULL, PETSC_TRUE}, {"1e-4", "warning: steps of", PETSC_TRUE}, {"1e-6", "error: steps of", PETSC_FALSE}};
  char text[4000], *said;
  (void)state;
  for (size_t i = 0; i < sizeof steps / sizeof *steps; ++i) {
    snprintf(text, sizeof text,
             PLAIN
             "stages:\n  - {name: one, analysis: {end: 9e5}}\n"
             "  - {name: two, analysis: {type: dynamic, end: 0.2, step: %s}}\n",
             steps[i].step);
    Case *c = read_text(text, &said);
    const char *told = strstr(said, steps[i].says ? steps[i].says : "clock");
    if ((c != NULL) != steps[i].taken || (told != NULL) != (steps[i].says != NULL))
      fail_msg("%s: %s", steps[i].step, said);
    free(said);
    if (c) assert_int_equal(CaseDestroy(&c), 0);
  }
}

/* Whose motion begins with a stage: who comes, and who has stood still; and which walls wait for whom. */
static void Begins(void **state)
{
  const PetscBool begins[6][2] = {{0, 0}, {0, 1}, {0, 0},
                                  {1, 1}, {0, 0}, {1, 1}}; /* of beam and late, stage by stage */
  const PetscBool waits[6][2] = {{1, 0}};                  /* of the wall for all, and of that for beam */
  (void)state;
  const char *text = PLAIN_TOP PLAIN_GRID PLAIN_BODIES
    "  - {name: late, shape: {box: {min: [3, 0], max: [4, 1]}}, material: rubber, absent: true}\n" PLAIN_MATERIALS
    "walls: [{name: w, shape: {half-space: {point: [0, 0], normal: [0, 1]}}},\n"
    "  {name: v, shape: {half-space: {point: [0, 0], normal: [0, 1]}}, bodies: [beam]}]\n"
    "stages:\n  - {name: one, analysis: {type: dynamic, end: 1, step: 0.1}}\n"
    "  - {name: two, bodies: [{name: late, absent: false}]}\n"
    "  - {name: three, analysis: {type: static, end: 1, steps: 1}}\n"
    "  - {name: four, analysis: {type: dynamic, end: 1, step: 0.1}}\n  - {name: five}\n"
    "  - {name: six, reset: [velocity]}\n";
  Case *c = read_good(text);
  for (PetscInt k = 0; k < 6; ++k)
    for (PetscInt b = 0; b < 2; ++b) {
      assert_int_equal(c->stage_case[k]->bodies[b].begins, begins[k][b]);
      assert_int_equal(c->stage_case[k]->walls[b].waits, waits[k][b]);
    }
  assert_int_equal(CaseDestroy(&c), 0);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Loads), cmocka_unit_test(Ages),  cmocka_unit_test(Entries),
                                     cmocka_unit_test(Names), cmocka_unit_test(Clock), cmocka_unit_test(Begins)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
