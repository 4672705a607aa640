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
  {SPACE("") "formulation: mixed\n", "cell", "cell, since gimp, the default of mpm, takes 4 times"},
  {SPACE("") "stages: [{name: one}]\n", "gimp", "gimp, the default of mpm;"},
  {FLYING, "gimp", "gimp, the default of mpm;"},
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

#define YIELDS                                                                                                       \
  "  soil: {law: mohr-coulomb, density: 1, young: 1, poisson: 0, friction_angle: 30, dilatancy_angle: 0, cohesion: " \
  "1}\n"
#define WALL(contact) "walls: [{name: w, shape: {half-space: {point: [0, 0], normal: [0, 1]}}, contact: " contact "}]\n"
#define EXPLICIT(rest)                                                                     \
  "kinematics: plane-strain\nmethod: mpm\nanalysis: {type: explicit, step: 1, end: 2" rest \
  "}\n" PLAIN_GRID PLAIN_BODIES PLAIN_MATERIALS

/* What conserves most where nothing takes energy anyway. */
static const struct {
  const char *text, *name, *told;
} transferred[] = {
  {MOVING("mpm", ""), "consistent", "consistent, the default where no law yields and nothing rubs; scheme midpoint"},
  {MOVING("mpm", "") "basis: cell\n", "consistent",
   "consistent, the default where no law yields and nothing rubs; scheme newmark"},
  {MOVING("mpm", "") "basis: bspline\n", "consistent",
   "consistent, the default where no law yields and nothing rubs; scheme midpoint"},
  {FLYING, "consistent", "consistent, the default where no law yields and nothing rubs; scheme midpoint"},
  {MOVING("mpm", "") YIELDS, "thesis", "thesis, the default where a law yields; scheme newmark"},
  {MOVING("mpm", "") WALL("frictionless"), "consistent", "consistent, the default"},
  {MOVING("mpm", "") WALL("friction, friction: 0.1"), "thesis", "thesis, the default with friction; scheme newmark"},
  {MOVING("mpm", "") "basis: bspline\n" WALL("friction, friction: 0.1"), "consistent",
   "consistent, the default where no law yields; scheme midpoint"},
  /* pressures and damped schemes have no forces in the middle of a step; with functions of cells they need none */
  {MOVING("mpm", ", bossak: -0.1"), "thesis", "thesis; consistent, which keeps more energy, goes with scheme midpoint"},
  {MOVING("mpm", ", gamma: 0.6, beta: 0.4"), "thesis", "thesis; consistent, which"},
  {MOVING("mpm", ", scheme: newmark"), "thesis", "thesis; consistent, which"},
  {MOVING("mpm", "") "formulation: mixed\n", "thesis", "thesis; consistent, which"},
  {MOVING("mpm", ", bossak: -0.1") "basis: cell\n", "consistent", "consistent, the default"},
  {MOVING("mpm", ", keep_velocity: true"), "thesis", "thesis"},
  {MOVING("mpm", ", transfer: thesis"), "thesis", "thesis; scheme newmark"},
  {MOVING("fem", ""), "thesis", ""},
  {MOVING("gmm", ""), "thesis", ""},
  {PLAIN, "thesis", ""},
  {EXPLICIT(""), "consistent", "consistent, the default where no law yields; scheme explicit"},
  {EXPLICIT(", update: usl"), "thesis", "thesis"},
  {EXPLICIT("") YIELDS, "thesis", "thesis, the default where a law yields"},
};

static void Transferred(void **state)
{
  char told[256];
  (void)state;
  for (size_t i = 0; i < sizeof transferred / sizeof transferred[0]; ++i) {
    Case *c = read_good(transferred[i].text);
    if (!method_tell_transfer(method_find(c->method), c, sizeof told, told)) told[0] = 0;
    if (strcmp(c->analysis.transfer, transferred[i].name) ||
        strncmp(told, transferred[i].told, strlen(transferred[i].told)))
      fail_msg("%s\nhas transfer %s (%s)", transferred[i].text, c->analysis.transfer, told);
    assert_int_equal(CaseDestroy(&c), 0);
  }
}

/* A scheme that damps where nobody asked for it is told. */
static void SchemeTold(void **state)
{
  static const struct {
    const char *text, *told;
  } damped[] = {
    {MOVING("gmm", "") YIELDS, "bossak, alpha -0.1, the default of gmm where a law yields"},
    {MOVING("gmm", ""), NULL},
    {MOVING("gmm", ", bossak: -0.1") YIELDS, NULL},
    {MOVING("gmm", ", scheme: newmark") YIELDS, NULL},
    {MOVING("fem", "") YIELDS, NULL},
  };
  char told[256];
  (void)state;
  for (size_t i = 0; i < sizeof damped / sizeof damped[0]; ++i) {
    Case *c = read_good(damped[i].text);
    const PetscBool tells = method_tell_scheme(method_find(c->method), c, sizeof told, told);
    if (tells != (damped[i].told != NULL) || (tells && strncmp(told, damped[i].told, strlen(damped[i].told))))
      fail_msg("%s\ntells %s", damped[i].text, tells ? told : "nothing");
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
  ASSERT_NEAR(c->stabilisation.mass, 0.3, 0);
  assert_int_equal(CaseDestroy(&c), 0);
}

#define SOIL_PLAIN                                                                                            \
  PLAIN_TOP PLAIN_GRID PLAIN_BODIES                                                                           \
    "materials:\n  rubber: {law: mohr-coulomb, density: 2000, young: 1e7, poisson: 0.3, friction_angle: 30, " \
    "dilatancy_angle: 0, cohesion: 1e3}\n"

/* What yields in clouds is damped, unless the case says how time goes; a resolved case reads back to the same. */
static void Damped(void **state)
{
#define CLOUDS(method, type, rest)                                                                \
  "kinematics: plane-strain\nmethod: " method "\nanalysis: {type: " type ", step: 1, end: 2" rest \
  "}\n" PLAIN_GRID PLAIN_BODIES
#define SOIL "materials: {rubber: {law: j2, density: 2000, young: 1e7, poisson: 0.3, yield_stress: 1e3}}\n"
  static const struct {
    const char *text;
    PetscReal bossak, gamma;
  } damped[] = {
    {CLOUDS("gmm", "dynamic", "") SOIL, -0.1, 0.6},
    {CLOUDS("gmm", "dynamic", "") PLAIN_MATERIALS, 0, 0.5},
    {CLOUDS("fem", "dynamic", "") SOIL, 0, 0.5},
    {CLOUDS("gmm", "static", "") SOIL, 0, 0.5},
    {CLOUDS("gmm", "dynamic", ", bossak: 0") SOIL, 0, 0.5},
    {CLOUDS("gmm", "dynamic", ", bossak: -0.3") SOIL, -0.3, 0.8},
    {CLOUDS("gmm", "dynamic", ", scheme: newmark") SOIL, 0, 0.5},
    {CLOUDS("gmm", "dynamic", ", gamma: 0.55") SOIL, 0, 0.55},
  };
  char *text;
  (void)state;
  for (size_t i = 0; i < sizeof damped / sizeof damped[0]; ++i) {
    Case *c = read_good(damped[i].text);
    for (int again = 0; again < 2; ++again) {
      ASSERT_NEAR(c->analysis.bossak, damped[i].bossak, 1e-14);
      ASSERT_NEAR(c->analysis.gamma, damped[i].gamma, 1e-14);
      assert_int_equal(CaseToYaml(c, &text), 0);
      assert_int_equal(CaseDestroy(&c), 0);
      c = read_good(text);
      PetscFree(text);
    }
    assert_int_equal(CaseDestroy(&c), 0);
  }
}

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
  ASSERT_NEAR(c->stabilisation.follow, 0.3, 0);
  assert_int_equal(CaseDestroy(&c), 0);
  c = read_good(MOVING("mpm", ", transfer: thesis"));
  ASSERT_NEAR(c->stabilisation.follow, 0, 0);
  assert_int_equal(CaseDestroy(&c), 0);
  c = read_good(PLAIN "stages:\n  - {name: stands}\n  - {name: swings, analysis: {type: dynamic, step: 1, end: 2}}\n");
  assert_int_equal(c->n_stages, 2);
  for (PetscInt k = 0; k < 2; ++k) ASSERT_NEAR(c->stage_case[k]->stabilisation.follow, 0.02, 0);
  assert_int_equal(CaseDestroy(&c), 0);
}

/* Keys that have no effect are named, each where it stands, those that say what is so anyway are not; a stage that
 * takes them over wants them all. */
static void Idle(void **state)
{
#define BEAM(more)                                                                                       \
  PLAIN_GRID "bodies:\n  - {name: beam, shape: {box: {min: [0, 0], max: [2, 1]}}, material: rubber" more \
             "}\n" PLAIN_MATERIALS
#define HEAD(method, type, more) \
  "kinematics: plane-strain\nmethod: " method "\nanalysis: {type: " type ", end: 1, step: 0.1" more "}\n"
#define STILL(more) HEAD("mpm", "static", more)
#define SWING(more) HEAD("mpm", "dynamic", more)
#define QUICK(more) HEAD("mpm", "explicit", more)
#define FOLLOWS "kinematics: plane-strain\nmethod: fem\nanalysis: {type: dynamic, end: 1, step: 0.1}\n"
#define ABOVE "{name: lid, shape: {box: {min: [0, 1], max: [2, 2]}}, mass: {mass: 1"
#define LID "walls:\n  - " ABOVE
#define THEN "stages: [{name: a}, {name: b, analysis: {type: dynamic, end: 1, step: 0.1}"
#define STABLE "stabilisation: {stiffness: 1e-5, curvature: 0.3, follow: 0.3, mass: 0.3, inertia: 0.3}\n"
  static const struct {
    const char *text, *set, *keys[8];
  } idle[] = {
    {STILL(", damping: 2, scheme: bossak, bossak: -0.1, mass: lumped") BEAM(", velocity: [1, 0]"),
     NULL,
     {"analysis.damping", "analysis.scheme", "analysis.bossak", "analysis.mass", "bodies[0].velocity"}},
    {STILL(", beta: 0.3, gamma: 0.6, transfer: consistent, keep_velocity: true") BEAM(", spin: 2"),
     NULL,
     {"analysis.beta", "analysis.gamma", "analysis.transfer", "analysis.keep_velocity", "bodies[0].spin"}},
    {STILL(", damping: 0, bossak: 0, beta: 0.25, mass: consistent, transfer: thesis") BEAM(", velocity: [0, 0]"),
     NULL,
     {NULL}},
    {STILL(", courant: 0.5, update: usl") BEAM(""), NULL, {"analysis.courant", "analysis.update"}},
    {STILL("") BEAM("") STABLE, NULL, {"stabilisation.stiffness", "stabilisation.mass", "stabilisation.inertia"}},
    {STILL("") BEAM("") "boundary: [{on: {x: 0}, fix: [x, y], amplitude: [[0, 1], [1, 0]]}]\n"
                        "initial: {reset_displacement: true}\nmixed: {stabilisation: 3}\n",
     NULL,
     {"boundary[0].amplitude", "initial.reset_displacement", "mixed.stabilisation"}},
    {SWING(", beta: 0.3, gamma: 0.6, scheme: midpoint") BEAM(""), NULL, {"analysis.beta", "analysis.gamma"}},
    {SWING(", beta: 0.3, gamma: 0.6") BEAM(", velocity: [1, 0]") STABLE "newton: {ease: 3}\n",
     NULL,
     {"stabilisation.stiffness", "stabilisation.inertia"}},
    {SWING("") BEAM("") "basis: cell\n" STABLE, NULL, {"stabilisation.curvature", "stabilisation.follow"}},
    {FOLLOWS BEAM("") STABLE,
     NULL,
     {"stabilisation.stiffness", "stabilisation.curvature", "stabilisation.follow", "stabilisation.mass",
      "stabilisation.inertia"}},
    {QUICK(", beta: 0.3, gamma: 0.8, mass: lumped, travel: 0.1, smallest: 1e-3, largest: 0.2") BEAM(""),
     NULL,
     {"analysis.beta", "analysis.gamma", "analysis.mass", "analysis.travel", "analysis.smallest", "analysis.largest"}},
    {QUICK("") BEAM("") STABLE "newton: {residual: 1e-3, ease: 6}\nlinear: direct\n",
     NULL,
     {"newton.residual", "linear", "stabilisation.stiffness", "stabilisation.curvature", "stabilisation.follow",
      "stabilisation.mass", "stabilisation.inertia"}},
    {QUICK(", courant: 0.5, update: usl, transfer: thesis, damping: 1") BEAM(""), NULL, {NULL}},
    /* what was written for another choice than a series made; and what comes with that choice, or after it */
    {STILL(", courant: 0.5") BEAM("") "newton: {residual: 1e-3}\n", "analysis.type=explicit", {NULL}},
    {QUICK(", contact_stiffness: 5") BEAM(""), NULL, {"analysis.contact_stiffness"}},
    {QUICK("") BEAM("") "newton: {residual: 1e-3}\n", "newton.increment=1e-3", {"newton.residual", "newton.increment"}},
    /* a stage that says its type says all of its analysis */
    {STILL("") BEAM("") STABLE "stages: [{name: a}, {name: b, analysis: {type: dynamic, end: 1, step: 0.1}}]\n",
     NULL,
     {"stabilisation.stiffness", "stabilisation.inertia"}},
    /* a body moves as it is told when it comes: in statics it does not, and has nothing left for a later stage */
    {STILL("")
       BEAM(", velocity: [1, 0]") "stages: [{name: a}, {name: b, analysis: {type: dynamic, end: 1, step: 0.1}}]\n",
     NULL,
     {"bodies[0].velocity"}},
    {STILL("") BEAM(", velocity: [1, 0], absent: true") "stages: [{name: a}, {name: b, analysis: {type: dynamic, end: "
                                                        "1, step: 0.1}, bodies: [{name: beam, absent: false}]}]\n",
     NULL,
     {NULL}},
    /* so does a wall with mass, whose motion a later stage may say */
    {STILL("") BEAM("") LID ", velocity: [1, 0], spin: 2}}\n" THEN "}]\n",
     NULL,
     {"walls[0].mass.velocity", "walls[0].mass.spin"}},
    {STILL("") BEAM("") LID "}}\n" THEN ", walls: [" ABOVE ", velocity: [1, 0], spin: 2}}]}]\n", NULL, {NULL}},
    {STILL("") BEAM("") LID ", velocity: [1, 0], spin: 2}, absent: true}\n" THEN
                            ", walls: [{name: lid, absent: false}]}]\n",
     NULL,
     {NULL}},
    {STILL(", damping: 2") BEAM(
       "") "stages: [{name: a}, {name: b, analysis: {type: dynamic, end: 1, step: 0.1, damping: 2, courant: 0.5}}]\n",
     NULL,
     {"analysis.damping", "analysis.courant"}},
  };
  (void)state;
  for (size_t k = 0; k < sizeof idle / sizeof idle[0]; ++k) {
    char *said, line[128];
    int n = 0, told = 0;
    Case *c = read_bytes(idle[k].text, strlen(idle[k].text), idle[k].set != NULL, &idle[k].set, &said);
    if (!c) fail_msg("%s", said);
    for (const char *const *key = idle[k].keys; *key; ++key, ++n) {
      snprintf(line, sizeof line, " warning: %s has no effect here: ", *key);
      if (!strstr(said, line)) fail_msg("case %d: no %s in: %s", (int)k, *key, said);
    }
    for (const char *at = said; (at = strstr(at, "has no effect here")); ++at) ++told;
    if (told != n || strstr(said, "small enough steps")) fail_msg("case %d, %d for %d: %s", (int)k, told, n, said);
    if (!k && !strstr(said, "F:3:54: warning: analysis.damping has no effect here: statics has no inertia"))
      fail_msg("%s", said);
    free(said);
    CaseDestroy(&c);
  }
}

/* A resolved case, which has all keys, says what is so anyway. */
static void Resolved(void **state)
{
  static const char *const texts[] = {PLAIN,
                                      PLAIN "basis: cell\n",
                                      QUICK("") BEAM(""),
                                      SWING("") BEAM(", spin: 2"),
                                      SWING(", transfer: consistent") BEAM(""),
                                      FOLLOWS BEAM(""),
                                      STILL("") BEAM(", k0: 0.5") "loads: {gravity: [0, -10]}\n"};
  (void)state;
  for (size_t k = 0; k < sizeof texts / sizeof texts[0]; ++k) {
    char *said, *resolved;
    Case *c = read_good(texts[k]);
    assert_int_equal(CaseToYaml(c, &resolved), 0);
    assert_int_equal(CaseDestroy(&c), 0);
    c = read_text(resolved, &said);
    if (!c || strstr(said, "has no effect")) fail_msg("case %d: %s", (int)k, said);
    free(said);
    assert_int_equal(PetscFree(resolved), 0);
    assert_int_equal(CaseDestroy(&c), 0);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(Chosen),   cmocka_unit_test(Written),     cmocka_unit_test(Midpoint),
    cmocka_unit_test(Damped),   cmocka_unit_test(Followers),   cmocka_unit_test(Idle),
    cmocka_unit_test(Resolved), cmocka_unit_test(Transferred), cmocka_unit_test(SchemeTold)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
