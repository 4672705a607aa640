/* --set path.to.key=value. */
#include "test_case.h"

static Case *ReadSet(const char *set, char **said) { return read_bytes(PLAIN, strlen(PLAIN), 1, &set, said); }

static Case *Good(const char *set)
{
  char *said;
  Case *c = ReadSet(set, &said);
  if (!c) fail_msg("%s: %s", set, said);
  free(said);
  return c;
}

static void Replace(void **state)
{
  Case *c = Good("materials.rubber.young=2e6");
  (void)state;
  ASSERT_NEAR(c->materials[0].parameters[0].value, 2e6, 0);
  CaseDestroy(&c);
  c = Good("bodies[0].shape.box.max=[1, 0.5]");
  ASSERT_NEAR(c->bodies[0].shape.max[1], 0.5, 0);
  CaseDestroy(&c);
  c = Good("bodies[0].shape.box.max[0]=1.5");
  ASSERT_NEAR(c->bodies[0].shape.max[0], 1.5, 0);
  ASSERT_NEAR(c->bodies[0].shape.max[1], 1, 0);
  CaseDestroy(&c);
  c = Good("bodies[0].shape={circle: {centre: [1, 1], radius: 0.5}}");
  assert_int_equal(c->bodies[0].shape.kind, SHAPE_BALL);
  CaseDestroy(&c);
}

static void Create(void **state)
{
  Case *c = Good("newton.max_iterations=7");
  (void)state;
  assert_int_equal(c->newton.max_iterations, 7);
  CaseDestroy(&c);
  c = Good("boundary[0]={on: {x: 0}, fix: [x]}");
  assert_int_equal(c->n_boundary, 1);
  CaseDestroy(&c);
  c = Good("bodies[1]={name: two, shape: {box: {min: [2, 0], max: [3, 1]}}, material: rubber}");
  assert_int_equal(c->n_bodies, 2);
  CaseDestroy(&c);
  c = Good("materials.steel={law: neo-hookean, density: 7850, young: 2e11, poisson: 0.3}");
  assert_int_equal(c->n_materials, 2);
  CaseDestroy(&c);
  c = Good("petsc.ksp_type=cg");
  assert_string_equal(c->petsc[0], "-ksp_type cg");
  CaseDestroy(&c);
  c = Good("title=a = b");
  assert_string_equal(c->title, "a = b");
  CaseDestroy(&c);
}

/* A word is the mapping that it stands for, wherever it comes from, and takes keys as that does. */
static void Spelled(void **state)
{
  const char text[] = PLAIN "basis: cell\n", *const set[] = {"basis=gimp", "basis.gimp.split=0.5"};
  char *said;
  Case *c = Good("basis=bspline");
  (void)state;
  assert_string_equal(c->basis.kind, "bspline");
  CaseDestroy(&c);
  c = read_bytes(text, strlen(text), 2, set, &said);
  if (!c) fail_msg("%s", said);
  assert_string_equal(c->basis.kind, "gimp");
  ASSERT_NEAR(c->basis.split, 0.5, 0);
  free(said);
  CaseDestroy(&c);
}

/* Later ones win, and see what earlier ones made. */
static void InOrder(void **state)
{
  const char *const set[] = {"newton={ease: 1}", "newton.ease=2", "newton.ease=3"};
  char *said;
  Case *c = read_bytes(PLAIN, strlen(PLAIN), 3, set, &said);
  (void)state;
  assert_non_null(c);
  assert_int_equal(c->newton.ease, 3);
  free(said);
  CaseDestroy(&c);
}

/* A key of the file that --set replaces can no longer be wrong. */
static void Repairs(void **state)
{
  const char text[] = PLAIN "linear: nonsense\n", *const set[] = {"linear=direct"};
  char *said;
  Case *c = read_bytes(text, strlen(text), 1, set, &said);
  (void)state;
  assert_non_null(c);
  free(said);
  CaseDestroy(&c);
}

static void Mistakes(void **state)
{
  static const char *const bad[][2] = {
    {"materials.rubber.yung=1",
     "--set materials.rubber.yung=1: error: key 'yung' of materials.rubber is not known\n  hint: did you mean "
     "'young'?"},
    {"materials.ruber.young=1",
     "--set materials.ruber.young=1: error: there is no 'ruber' in materials\n  hint: did you mean 'rubber'? There "
     "are: "
     "rubber\n"},
    {"materials.rubber={young: 1}", "error: key 'law' of materials.rubber is missing"},
    {"measures.tip.of.tracer=[0, 0]",
     "--set measures.tip.of.tracer=[0, 0]: error: there is no 'tip' in measures\n  hint: there are no names\n"},
    {"measures.tip={displacment: x, of: {tracer: [0, 0]}}",
     "error: key 'displacment' of measures.tip is not known\n  hint: did you mean 'displacement'?"},
    {"analysis.type=implicit", "hint: it is called `dynamic` here"},
    {"kinematics=plane-stress", "hint: there is no plane stress"},
    {"newton.ease=many", "--set newton.ease=many: error: newton.ease must be a whole number >= 0, not 'many'"},
    {"newton.ease=", "not empty"},
    {"newton", "there is no '='"},
    {"=3", "there is no key before '='"},
    {"bodies[4].name=x", "--set bodies[4].name=x: error: bodies has 1 entries, so there is no [4]"},
    {"bodies.name=x",
     "bodies is a list, it has no keys\n  hint: name an entry of the list by its number: bodies[0] is "
     "'beam'"},
    {"bodies.beam.shape.box.max=[1, 1]",
     "bodies is a list, it has no keys\n  hint: bodies is a list, and 'beam' is "
     "bodies[0]"},
    {"materials[0]=x",
     "materials is a mapping of keys, it has no numbered entries\n  hint: name one of its keys: "
     "materials.rubber"},
    {"basis=gmp", "--set basis=gmp: error: key 'gmp' of basis is not known\n  hint: did you mean 'gimp'?"},
    {"method.x=1", "method is a single value, it has no keys"},
    {"a..b=1", "this is no path to a key"},
    {"a[x]=1", "this is no path to a key"},
    {"newton.=1", "this is no path to a key"},
    {"newton={a: [", "--set newton={a: [: error: syntax"},
    {"newton={ease: 1, ease: 2}", "stands twice"},
    {"title=\xff", "is no text in UTF-8"},
  };
  (void)state;
  for (size_t i = 0; i < sizeof(bad) / sizeof(bad[0]); ++i) {
    char *said;
    Case *c = ReadSet(bad[i][0], &said);
    if (c) fail_msg("%s: was taken for good", bad[i][0]);
    if (!strstr(said, bad[i][1])) fail_msg("%s: no '%s' in:\n%s", bad[i][0], bad[i][1], said);
    free(said);
  }
}

/* Paths of other rooms find their line; what came by --set is named so; a missing key shows its
 * parent. */
static void Resolve(void **state)
{
  const char *const set[] = {"newton.ease=3", "grid.size=1", "bodies[0].shape.box={min: [1, 0], max: [3, 1]}"};
  char name[64], *text = NULL;
  size_t size;
  Diag *diag;
  Case *c;
  (void)state;
  write_case(PLAIN, strlen(PLAIN), name);
  DiagCreate(&diag);
  assert_int_equal(CaseRead(PETSC_COMM_WORLD, name, 3, set, diag, &c), 0);
  unlink(name);
  diag_error(diag, "grid.box.min", "box");
  diag_error(diag, "grid", "in part");
  diag_error(diag, "bodies[0].shape", "all of it");
  diag_error(diag, "materials.rubber.young", "value");
  diag_error(diag, "bodies[0].region", "absent");
  diag_error(diag, "newton.ease", "argument");
  diag_error(diag, NULL, "whole");
  FILE *out = open_memstream(&text, &size);
  DiagFlush(diag, out);
  fclose(out);
  assert_non_null(strstr(text, ":4:14: error: box\n"));
  assert_non_null(strstr(text,
                         ":4:1: error: in part\n  grid: {box: {min: [0, 0], max: [4, 2]}, size: 0.5}  # --set "
                         "grid.size=1\n  ^~~~\n"));
  assert_non_null(strstr(text, "--set bodies[0].shape.box={min: [1, 0], max: [3, 1]}: error: all of it\n"));
  assert_non_null(
    strstr(text, ":8:52: error: value\n    rubber: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}\n"));
  assert_non_null(strstr(text, ":6:5: error: absent\n"));
  assert_non_null(strstr(text, "--set newton.ease=3: error: argument\n"));
  assert_non_null(strstr(text, ": error: whole\n"));
  free(text);
  DiagDestroy(&diag);
  CaseDestroy(&c);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Replace), cmocka_unit_test(Create),  cmocka_unit_test(InOrder),
                                     cmocka_unit_test(Spelled), cmocka_unit_test(Repairs), cmocka_unit_test(Mistakes),
                                     cmocka_unit_test(Resolve)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
