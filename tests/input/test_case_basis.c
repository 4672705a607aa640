/* The basis of a case that names none: averaged functions wherever they can be had. */
#include "test_case.h"
#include "method/method.h"

#define GRID(rest) "grid: {box: {min: [0, 0], max: [4, 2]}, counts: [8, 4]" rest "}\n"
#define PLANE(rest)    \
  PLAIN_TOP GRID(rest) \
  PLAIN_BODIES PLAIN_MATERIALS
#define MESH PLAIN_TOP "grid: {mesh: a.geo}\nbodies: [{name: a, region: a, points_per_cell: 4, material: rubber}]\n"
#define RINGS \
  "kinematics: axisymmetric\nmethod: mpm\nanalysis: {type: static}\n" PLAIN_GRID PLAIN_BODIES PLAIN_MATERIALS
#define SPACE(rest)                                              \
  "kinematics: 3d\nmethod: mpm\nanalysis: {type: static}\n"      \
  "grid: {box: {min: [0, 0, 0], max: [1, 1, 1]}, size: 0.5" rest \
  "}\n"                                                          \
  "bodies: [{name: a, shape: {box: {min: [0, 0, 0], max: [1, 1, 1]}}, material: rubber}]\n" PLAIN_MATERIALS
#define FLYING                                                                \
  "kinematics: 3d\nmethod: mpm\nanalysis: {type: dynamic, step: 1, end: 2}\n" \
  "grid: {box: {min: [0, 0, 0], max: [1, 1, 1]}, size: 0.5}\n"                \
  "bodies: [{name: a, shape: {box: {min: [0, 0, 0], max: [1, 1, 1]}}, material: rubber}]\n" PLAIN_MATERIALS
#define MOVING(method, rest)                                                                     \
  "kinematics: plane-strain\nmethod: " method "\nanalysis: {type: dynamic, step: 1, end: 2" rest \
  "}\n" PLAIN_GRID PLAIN_BODIES PLAIN_MATERIALS

static const struct {
  const char *text, *kind, *told;
} cases[] = {
  {PLAIN, "gimp", "gimp, the default of mpm; basis: {cell: {}} is the thesis's"},
  {PLAIN "basis: {}\n", "gimp", "gimp, the default of mpm;"},
  {PLAIN "formulation: mixed\n", "gimp", "gimp, the default of mpm;"},
  {SPACE(""), "gimp", "gimp, the default of mpm;"},
  {SPACE("") "formulation: mixed\n", "cell", "cell, since gimp, the default of mpm, takes 2 to 5 times"},
  {SPACE("") "stages: [{name: one}]\n", "cell", "cell, since gimp, the default of mpm, takes 2 to 5 times"},
  {FLYING, "cell", "cell, since gimp, the default of mpm, takes 2 to 5 times"},
  {RINGS, "gimp", "gimp, the default of mpm;"},
  {PLAIN "basis: {cell: {}}\n", "cell", "cell"},
  {PLAIN "basis: {gimp: {}}\n", "gimp", "gimp"},
  {PLAIN "basis: gimp\n", "gimp", "gimp"},
  {PLAIN "basis: 'cell'\n", "cell", "cell"},
  {PLAIN "basis: gimp\nstages: [{name: one}]\n", "gimp", "gimp"},
  /* grids */
  {PLANE(", cell: triangle"), "cell", "cell, since gimp, the default of mpm, needs a box of quadrilaterals"},
  {SPACE(", cell: tetrahedron"), "cell", "cell, since gimp, the default of mpm, needs a box of quadrilaterals"},
  {MESH PLAIN_MATERIALS, "cell", "cell, since gimp, the default of mpm, needs a box of quadrilaterals"},
  {PLANE(", grading: {x: 128}"), "gimp", "gimp, the default of mpm;"}, /* 2 from cell to cell */
  {PLANE(", grading: {x: 129}"), "cell", "cell, since gimp, the default of mpm, needs a box that is not graded"},
  {PLANE(", grading: {y: 0.124}"), "cell", "cell, since gimp, the default of mpm, needs a box that is not graded"},
  /* formulations */
  {PLAIN "formulation: mean-dilatation\n", "cell", "cell, since gimp, the default of mpm, has no cells whose points"},
  /* transfers and time schemes */
  {MOVING("mpm", ", bossak: -0.1"), "gimp", "gimp, the default of mpm;"},
  {MOVING("mpm", ", keep_velocity: true"), "gimp", "gimp, the default of mpm;"},
  {MOVING("mpm", ", transfer: consistent"), "gimp", "gimp, the default of mpm;"},
  {MOVING("mpm", ", transfer: consistent, scheme: midpoint"), "gimp", "gimp, the default of mpm;"},
  {MOVING("mpm", ", transfer: consistent, scheme: newmark"), "cell",
   "cell, since gimp, the default of mpm, takes another"},
  {MOVING("mpm", ", transfer: consistent, bossak: -0.1"), "cell",
   "cell, since gimp, the default of mpm, takes another"},
  {MOVING("mpm", ", transfer: consistent") "formulation: mixed\n", "cell",
   "cell, since gimp, the default of mpm, takes another transfer, or displacements alone and scheme midpoint"},
  /* other methods */
  {MOVING("fem", ""), "cell", "cell, the default of fem"},
  {MOVING("gmm", ""), "lme", "lme, the default of gmm"},
};

static void Chosen(void **state)
{
  char told[256];
  (void)state;
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
    Case *c = read_good(cases[i].text);
    method_tell_basis(method_find(c->method), c, sizeof told, told);
    if (strcmp(c->basis.kind, cases[i].kind) || strncmp(told, cases[i].told, strlen(cases[i].told)))
      fail_msg("%s\nhas %s (%s)", cases[i].text, c->basis.kind, told);
    assert_int_equal(CaseDestroy(&c), 0);
  }
}

/* The resolved case names what was chosen: it reads back to the same, and nothing is left to choose. */
static void Written(void **state)
{
  char *text, *again, block[64];
  (void)state;
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
    Case *first = read_good(cases[i].text), *second;
    assert_int_equal(CaseToYaml(first, &text), 0);
    snprintf(block, sizeof block, "\nbasis:\n  %s:", cases[i].kind);
    if (!strstr(text, block)) fail_msg("%s\ndoes not write its basis:\n%s", cases[i].text, text);
    second = read_good(text);
    assert_string_equal(second->basis.kind, first->basis.kind);
    assert_false(second->basis.by_default);
    assert_int_equal(CaseToYaml(second, &again), 0);
    assert_string_equal(text, again);
    PetscFree(text);
    PetscFree(again);
    assert_int_equal(CaseDestroy(&first), 0);
    assert_int_equal(CaseDestroy(&second), 0);
  }
}

/* Points with domains and the transfer that asks for it take the midpoint rule and no lumped mass,
 * named or not. */
static void Midpoint(void **state)
{
  Case *c = read_good(MOVING("mpm", ", transfer: consistent"));
  (void)state;
  assert_string_equal(c->analysis.scheme, "midpoint");
  ASSERT_NEAR(c->stabilisation.mass, 0, 0);
  ASSERT_NEAR(c->stabilisation.curvature, 0.1, 0);
  assert_int_equal(CaseDestroy(&c), 0);
  c = read_good(MOVING("mpm", ", transfer: consistent, bossak: -0.1"));
  assert_null(c->analysis.scheme);
  ASSERT_NEAR(c->stabilisation.mass, 0.1, 0);
  assert_int_equal(CaseDestroy(&c), 0);
}

#define SOIL_PLAIN                                                                                            \
  PLAIN_TOP PLAIN_GRID PLAIN_BODIES                                                                           \
    "materials:\n  rubber: {law: mohr-coulomb, density: 2000, young: 1e7, poisson: 0.3, friction_angle: 30, " \
    "dilatancy_angle: 0, cohesion: 1e3}\n"

/* Nodes follow others in statics, more of them where a law yields, and in all stages of a case, that they belong to the
 * same nodes. */
static void Followers(void **state)
{
  Case *c = read_good(PLAIN);
  (void)state;
  ASSERT_NEAR(c->stabilisation.follow, 0.02, 0);
  ASSERT_NEAR(c->stabilisation.curvature, 1e-3, 0);
  assert_int_equal(CaseDestroy(&c), 0);
  c = read_good(SOIL_PLAIN);
  ASSERT_NEAR(c->stabilisation.follow, 0.1, 0);
  ASSERT_NEAR(c->stabilisation.curvature, 1e-4, 0);
  assert_int_equal(CaseDestroy(&c), 0);
  c = read_good(MOVING("mpm", ""));
  ASSERT_NEAR(c->stabilisation.follow, 0, 0);
  assert_int_equal(CaseDestroy(&c), 0);
  c = read_good(PLAIN "stages:\n  - {name: stands}\n  - {name: swings, analysis: {type: dynamic, step: 1, end: 2}}\n");
  assert_int_equal(c->n_stages, 2);
  for (PetscInt k = 0; k < 2; ++k) ASSERT_NEAR(c->stage_case[k]->stabilisation.follow, 0.02, 0);
  assert_int_equal(CaseDestroy(&c), 0);
}

/* Keys of dynamics in statics are named, those that say what is so anyway are not; a dynamic stage wants them all. */
static void Idle(void **state)
{
#define BEAM(more)                                                                                       \
  PLAIN_GRID "bodies:\n  - {name: beam, shape: {box: {min: [0, 0], max: [2, 1]}}, material: rubber" more \
             "}\n" PLAIN_MATERIALS
#define HEAD(more) "kinematics: plane-strain\nmethod: mpm\nanalysis: {type: static, end: 1, step: 0.1" more "}\n"
  static const struct {
    const char *text, *words;
  } idle[] = {
    {HEAD(", damping: 2, scheme: bossak, bossak: -0.1, mass: lumped") BEAM(", velocity: [1, 0]"),
     "nothing here is dynamic: analysis.damping, analysis.bossak, analysis.scheme, analysis.mass, bodies[0].velocity"},
    {HEAD(", beta: 0.3, gamma: 0.6, transfer: consistent, keep_velocity: true") BEAM(", spin: 2"),
     "analysis.beta, analysis.gamma, analysis.transfer, analysis.keep_velocity, bodies[0].spin"},
    {HEAD(", damping: 0, beta: 0.25, mass: consistent, transfer: thesis") BEAM(", velocity: [0, 0]"), NULL},
    {HEAD(", damping: 2")
       BEAM(", velocity: [1, 0]") "stages: [{name: a}, {name: b, analysis: {type: dynamic, end: 1, step: 0.1}}]\n",
     NULL},
  };
  (void)state;
  for (size_t k = 0; k < sizeof idle / sizeof idle[0]; ++k) {
    char *said;
    Case *c = read_text(idle[k].text, &said);
    if (!c) fail_msg("%s", said);
    if (idle[k].words ? !strstr(said, idle[k].words) : !!strstr(said, "dynamic")) fail_msg("case %d: %s", (int)k, said);
    free(said);
    CaseDestroy(&c);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Chosen), cmocka_unit_test(Written), cmocka_unit_test(Midpoint),
                                     cmocka_unit_test(Followers), cmocka_unit_test(Idle)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
