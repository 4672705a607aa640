/* Whole verifications of a small cantilever: right, off, given up, wrongly asked for; on any number
 * of ranks. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
/* cmocka wants those before it */
#include <cmocka.h>
#include "verify/verify.h"

#define OK(call) assert_int_equal((call), 0)

static char root[256]; /* a folder of this test, the same on all ranks */
static PetscMPIInt rank;

static const char reference[] =
  "title: A short beam\n"
  "studies:\n"
  "  tip:\n"
  "    title: The tip\n"
  "    measure: tip\n"
  "    sweep: {name: cell size, symbol: h, unit: m, set: {grid.size: $h}}\n"
  "    series: {fem: {set: {method: fem}}, mpm: {set: {method: mpm}}}\n"
  "    tolerance: 2e-6\n"
  "    source: independent program\n"
  "    rows:\n"
  "      - {at: 0.5, reference: %s}\n"
  "      - {at: 0.25, reference: -0.6539116%s}\n"
  "      - {at: 0.125, reference: -0.6691249, full: true}\n"
  "    exact: {value: -0.674365, order: 2, between: [0.1, 0.3]}\n"
  "    agree: [{series: mpm, with: fem, tolerance: 1e-10}]\n"
  "    limits: {iterations-per-step: 6}\n"
  "    figure: values\n"
  "  again:\n"
  "    title: The same runs\n"
  "    measure: tip\n"
  "    sweep: {name: cell size, symbol: h, set: {grid.size: $h}}\n"
  "    series: {fem: {set: {method: fem}}}\n"
  "    tolerance: 1e-3\n"
  "    source: independent program\n"
  "    rows: [{at: 0.5, reference: -0.6}]\n"
  "  way:\n"
  "    title: Distance from u = 0.1 - 0.8 t + 0.1 t^2, which is -0.6 at the end\n"
  "    measure: tip\n"
  "    course: {constant: 0.1, linear: -0.8, quadratic: 0.1}\n"
  "    sweep: {name: cell size, symbol: h, set: {grid.size: $h}}\n"
  "    series: {mpm: {set: {method: mpm}}}\n"
  "    tolerance: 1e-3\n"
  "    source: independent program\n"
  "    rows: [{at: 0.5, reference: 3.408e-4}]\n"
  "  sampled:\n"
  "    title: The way of u = -0.6 t sampled at 1/4, 1/2, 3/4, 1 s, from a course 0.1 above, halved\n"
  "    measure: tip\n"
  "    course: {constant: 0.1, linear: -0.5996592, every: 0.25, factor: 0.5}\n"
  "    at-most: true\n"
  "    pace: fem\n"
  "    sweep: {name: cell size, symbol: h, set: {grid.size: $h}}\n"
  "    series: {fem: {set: {method: fem}}, mpm: {set: {method: mpm}}}\n"
  "    tolerance: 1e-6\n"
  "    source: independent program\n"
  "    rows: [{at: 0.5, references: {fem: 0.1, mpm: 0.2}}]\n"
  "  later:\n"
  "    title: The same from 1/2 s on, sampled at 3/4 and 1 s\n"
  "    measure: tip\n"
  "    course: {start: 0.5, constant: -0.1998296, linear: -0.5996592, every: 0.25}\n"
  "    sweep: {name: cell size, symbol: h, set: {grid.size: $h}}\n"
  "    series: {mpm: {set: {method: mpm}}}\n"
  "    tolerance: 1e-6\n"
  "    source: independent program\n"
  "    rows: [{at: 0.5, reference: 0.14142136}]\n"
  "  bound:\n"
  "    title: What may be less, but not more\n"
  "    measure: tip\n"
  "    at-most: true\n"
  "    sweep: {name: cell size, symbol: h, set: {grid.size: $h}}\n"
  "    series: {fem: {set: {method: fem}, full: true}}\n"
  "    tolerance: 1e-6\n"
  "    source: independent program\n"
  "    rows: [{at: 0.5, reference: %s}]\n"
  "  moments:\n"
  "    title: Half of the step's way at half of its time, and nothing after its end\n"
  "    measure: tip\n"
  "    moments: true\n"
  "    sweep: {name: time, symbol: t, unit: s, set: {}}\n"
  "    series: {mpm: {set: {method: mpm, grid.size: 0.5}}}\n"
  "    tolerance: 1e-6\n"
  "    source: independent program\n"
  "    rows: [{at: 0.5, reference: -0.2998296}, {at: 1, reference: -0.5996592}, {at: 0, reference: 0}]\n";

static void write_file(const char *folder, const char *name, const char *text)
{
  char path[512];
  snprintf(path, sizeof path, "%s/%s/%s", root, folder, name);
  FILE *out = fopen(path, "w");
  assert_non_null(out);
  fputs(text, out);
  fclose(out);
}

static PetscBool is_there(const char *path)
{
  char whole[512];
  snprintf(whole, sizeof whole, "%s/%s", root, path);
  return !access(whole, F_OK);
}

static void copy_case(const char *folder)
{
  static char text[8192];
  FILE *in = fopen(TALUS_SOURCE_DIR "/cases/cantilever/case.yaml", "r");
  assert_non_null(in);
  text[fread(text, 1, sizeof text - 1, in)] = '\0';
  fclose(in);
  write_file(folder, "case.yaml", text);
}

/* A folder with the cantilever and a reference; `value` of the first row, `more` keys for the
 * second. */
static void make_case(const char *name, const char *value, const char *more)
{
  char text[4096], path[512];
  if (rank == 0) {
    snprintf(path, sizeof path, "%s/%s", root, name);
    mkdir(path, 0777);
    copy_case(name);
    snprintf(text, sizeof text, reference, value, more, value);
    write_file(name, "reference.yaml", text);
  }
  MPI_Barrier(PETSC_COMM_WORLD);
}

/* Run it; what was printed and complained about is in `text` on rank 0. */
static VerifyOutcome verify(const char *name, VerifyOptions options, char **text)
{
  char folder[512], out[512];
  VerifyOutcome outcome;
  size_t size;
  Diag *diag;
  snprintf(folder, sizeof folder, "%s/%s", root, name);
  snprintf(out, sizeof out, "%s/out-%s", root, name);
  options.folder = folder;
  options.out = out;
  FILE *stream = open_memstream(text, &size);
  OK(DiagCreate(&diag));
  OK(VerifyCase(PETSC_COMM_WORLD, &options, stream, diag, &outcome));
  OK(DiagFlush(diag, stream));
  OK(DiagDestroy(&diag));
  fclose(stream);
  MPI_Barrier(PETSC_COMM_WORLD);
  return outcome;
}

/* Rank 0 printed this. */
#define SAYS(text, part)                                                           \
  do {                                                                             \
    if (rank == 0 && !strstr(text, part)) fail_msg("no '%s' in:\n%s", part, text); \
  } while (0)

static void right_values_pass(void **state)
{
  (void)state;
  char *text;
  make_case("right", "-0.5996592", "");
  assert_int_equal(verify("right", (VerifyOptions){.keep = PETSC_TRUE}, &text), VERIFY_PASSED);
  SAYS(text, "4 of 4 rows pass");
  SAYS(text, "mpm agrees with fem to");
  SAYS(text, "1 of 1 rows pass");
  SAYS(text, "3 of 3 rows pass");
  SAYS(text, "2 of 2 rows pass");
  SAYS(text, "pace");
  SAYS(text, "0.000340813"); /* |tip + 0.6|: one step, so one row after the start */
  assert_true(is_there("out-right/verification.md") && is_there("out-right/tip.png"));
  assert_true(is_there("out-right/tip/mpm/h_0.25/history.csv") &&
              is_there("out-right/tip/mpm/h_0.25/points.hdf.series"));
  assert_false(is_there("out-right/again/fem/h_0.5")); /* ran already */
  free(text);
  assert_int_equal(verify("right", (VerifyOptions){.full = PETSC_TRUE, .only = "tip"}, &text), VERIFY_PASSED);
  SAYS(text, "6 of 6 rows pass");
  SAYS(text, "1.965"); /* the order */
  assert_false(is_there("out-right/tip/mpm/h_0.25/points.hdf.series"));
  assert_true(is_there("out-right/tip/mpm/h_0.25/log.txt"));
  free(text);
}

static void wrong_values_fail(void **state)
{
  (void)state;
  char *text;
  make_case("off", "-0.5996", "");
  assert_int_equal(verify("off", (VerifyOptions){.only = "tip"}, &text), VERIFY_OFF);
  SAYS(text, "FAIL");
  SAYS(text, "off the reference, allowed 2e-06");
  SAYS(text, "2 of 4 rows pass");
  free(text);
  make_case("above", "-0.7", "");
  assert_int_equal(verify("above", (VerifyOptions){.only = "bound", .full = PETSC_TRUE}, &text), VERIFY_OFF);
  SAYS(text, "above the bound, allowed 1e-06");
  SAYS(text, "0 of 1 rows pass");
  free(text);
}

/* Compare what `run` holds with the references of `name`. */
static VerifyOutcome compare(const char *name, const char *run, PetscInt *n, char **text)
{
  char folder[512], path[512];
  VerifyOutcome outcome;
  size_t size;
  Diag *diag;
  snprintf(folder, sizeof folder, "%s/%s", root, name);
  snprintf(path, sizeof path, "%s/%s", root, run);
  const VerifyOptions options = {.folder = folder, .run = path};
  FILE *stream = open_memstream(text, &size);
  OK(DiagCreate(&diag));
  OK(VerifyRun(PETSC_COMM_WORLD, &options, stream, diag, n, &outcome));
  OK(DiagFlush(diag, stream));
  OK(DiagDestroy(&diag));
  fclose(stream);
  return outcome;
}

/* A run knows its rows by its case, in whatever study and series they stand. */
static void a_run_is_compared_with_its_rows(void **state)
{
  (void)state;
  PetscInt n;
  char *text;
  make_case("known", "-0.5996592", "");
  assert_int_equal(verify("known", (VerifyOptions){.full = PETSC_TRUE}, &text), VERIFY_PASSED);
  free(text);
  assert_int_equal(compare("known", "out-known/tip/mpm/h_0.5", &n, &text), VERIFY_PASSED);
  assert_int_equal(n, 7); /* tip, way, sampled, later and three moments */
  SAYS(text, "7 of 7 within what is allowed");
  SAYS(text, "nothing after its end, at 0.5 s");
  SAYS(text, "-0.29983");
  SAYS(text, "-0.599659");
  SAYS(text, "0.00034081");
  SAYS(text, "limit");
  free(text);
  assert_int_equal(compare("known", "out-known/tip/fem/h_0.125", &n, &text), VERIFY_PASSED);
  assert_int_equal(n, 1); /* a row of --full */
  free(text);
  make_case("other", "-0.5996", ", set: {materials.rubber.poisson: 0.1}");
  assert_int_equal(compare("other", "out-known/tip/fem/h_0.5", &n, &text), VERIFY_OFF);
  assert_int_equal(n, 4); /* tip, again, sampled and bound */
  SAYS(text, "off the reference, allowed 2e-06");
  SAYS(text, "3 of 4 within what is allowed");
  free(text);
  assert_int_equal(compare("other", "out-known/tip/fem/h_0.25", &n, &text), VERIFY_PASSED);
  assert_int_equal(n, 0); /* its row has another material */
  free(text);
  make_case("kept", "-0.5996592", ", set: {checkpoint.minutes: 1, linear: direct, title: Same, output.every: end}");
  assert_int_equal(compare("kept", "out-known/tip/fem/h_0.25", &n, &text), VERIFY_PASSED);
  assert_int_equal(n, 1); /* its row differs in what changes no result */
  free(text);
}

static void what_is_no_whole_run_is_not_compared(void **state)
{
  (void)state;
  PetscInt n;
  char *text;
  make_case("short", "-0.5996592", ", set: {newton.max_iterations: 1, analysis.smallest: 0.4}");
  assert_int_equal(verify("short", (VerifyOptions){.only = "tip"}, &text), VERIFY_GAVE_UP);
  free(text);
  assert_int_equal(compare("short", "out-short/tip/fem/h_0.25", &n, &text), VERIFY_BAD_INPUT);
  SAYS(text, "ended at 0 s, before its 1 s: there is nothing to compare");
  free(text);
  assert_int_equal(compare("short", "short/nowhere", &n, &text), VERIFY_BAD_INPUT);
  SAYS(text, "is no run directory");
  free(text);
}

static void remove_file(const char *path)
{
  char whole[512];
  snprintf(whole, sizeof whole, "%s/%s", root, path);
  if (rank == 0) assert_int_equal(unlink(whole), 0);
  MPI_Barrier(PETSC_COMM_WORLD);
}

/* What is finished is taken over with its numbers; what has no end, or another case, is run. */
static void a_verification_goes_on(void **state)
{
  (void)state;
  char *text;
  make_case("more", "-0.5996592", "");
  assert_int_equal(verify("more", (VerifyOptions){.only = "tip"}, &text), VERIFY_PASSED);
  free(text);
  assert_int_equal(verify("more", (VerifyOptions){.only = "way", .resume = PETSC_TRUE}, &text), VERIFY_PASSED);
  free(text);
  remove_file("out-more/tip/mpm/h_0.5/timings.txt"); /* a later study has this run, too */
  /* marks: runs that are done again would write these files */
  remove_file("out-more/tip/fem/h_0.5/log.txt");
  remove_file("out-more/tip/mpm/h_0.5/log.txt");
  remove_file("out-more/way/mpm/h_0.5/log.txt");
  remove_file("out-more/tip/mpm/h_0.25/timings.txt"); /* was cut off */
  make_case("more", "-0.5996592", ", sets: {fem: {materials.rubber.poisson: 0.1}}");
  assert_int_equal(verify("more", (VerifyOptions){.resume = PETSC_TRUE}, &text), VERIFY_OFF);
  /* that of fem is another case now, with which mpm no longer agrees */
  SAYS(text, "2 of 4 rows pass");
  SAYS(text, "0.000340813"); /* of a study that shares a run taken over */
  free(text);
  assert_false(is_there("out-more/tip/fem/h_0.5/log.txt") || is_there("out-more/tip/mpm/h_0.5/log.txt") ||
               is_there("out-more/way/mpm/h_0.5/log.txt"));
  assert_true(is_there("out-more/tip/mpm/h_0.25/timings.txt"));
  make_case("more", "-0.5996592", "");
  assert_int_equal(verify("more", (VerifyOptions){.resume = PETSC_TRUE, .only = "tip"}, &text), VERIFY_PASSED);
  free(text);
  assert_int_equal(verify("more", (VerifyOptions){.only = "tip"}, &text), VERIFY_PASSED);
  assert_true(is_there("out-more/tip/fem/h_0.5/log.txt")); /* without --resume all is run */
  free(text);
}

/* A table says which of its rows another program computed. */
static void other_programs_are_named(void **state)
{
  (void)state;
  char *text, path[512], line[512], head[2048] = "";
  make_case("older", "-0.5996592", "");
  assert_int_equal(verify("older", (VerifyOptions){.only = "tip"}, &text), VERIFY_PASSED);
  free(text);
  MPI_Barrier(PETSC_COMM_WORLD);
  if (rank == 0) {
    int ranks;
    MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
    snprintf(line, sizeof line, "talus = 0.0.9\nsources = abcdef0\nranks = %d\n", ranks);
    write_file("out-older", "tip/fem/h_0.5/version.txt", line);
    write_file("out-older", "tip/mpm/h_0.5/version.txt", "talus = 0.0.9\nsources = abcdef1\nranks = 77\n");
  }
  MPI_Barrier(PETSC_COMM_WORLD);
  assert_int_equal(verify("older", (VerifyOptions){.resume = PETSC_TRUE, .only = "tip"}, &text), VERIFY_PASSED);
  free(text);
  if (rank != 0) return;
  snprintf(path, sizeof path, "%s/out-older/verification.md", root);
  FILE *in = fopen(path, "r");
  assert_non_null(in);
  head[fread(head, 1, sizeof head - 1, in)] = '\0';
  fclose(in);
  SAYS(head, "1 of its rows were computed before, with abcdef0.");
  assert_null(strstr(head, "abcdef1")); /* on other ranks: run again */
}

static void a_run_that_gives_up_is_told(void **state)
{
  (void)state;
  char *text;
  make_case("hard", "-0.5996592", ", set: {newton.max_iterations: 1, analysis.smallest: 0.4}");
  assert_int_equal(verify("hard", (VerifyOptions){.only = "tip"}, &text), VERIFY_GAVE_UP);
  SAYS(text, "the run gave up, see");
  SAYS(text, "2 of 4 rows pass");
  free(text);
}

static void bad_input_runs_nothing(void **state)
{
  (void)state;
  char *text;
  make_case("bad", "-0.5996592", ", set: {materials.rubber.young: -1}");
  assert_int_equal(verify("bad", (VerifyOptions){.full = PETSC_TRUE}, &text), VERIFY_BAD_INPUT);
  SAYS(text, "--set materials.rubber.young=-1");
  SAYS(text, "reference.yaml:12:9: error: the case of this row cannot be read (study tip, series fem, h = 0.25)");
  assert_false(is_there("out-bad"));
  free(text);
  assert_int_equal(verify("bad", (VerifyOptions){.only = "tap"}, &text), VERIFY_BAD_INPUT);
  SAYS(text, "did you mean 'tip'?");
  free(text);
  assert_int_equal(verify("nowhere", (VerifyOptions){.full = PETSC_FALSE}, &text), VERIFY_BAD_INPUT);
  SAYS(text, "there is no such file");
  free(text);
  assert_int_equal(verify("bad", (VerifyOptions){.record = PETSC_TRUE}, &text), VERIFY_BAD_INPUT);
  SAYS(text, "cannot record in");
  free(text);
}

static int make_root(void **state)
{
  (void)state;
  const char *base = getenv("TMPDIR");
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  snprintf(root, sizeof root, "%s/talus-verify-XXXXXX", base ? base : "/tmp");
  if (rank == 0 && !mkdtemp(root)) return 1;
  MPI_Bcast(root, sizeof root, MPI_CHAR, 0, PETSC_COMM_WORLD);
  return 0;
}

static int remove_root(void **state)
{
  char command[300];
  (void)state;
  MPI_Barrier(PETSC_COMM_WORLD);
  snprintf(command, sizeof command, "rm -r '%s'", root);
  return rank == 0 ? system(command) : 0;
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(right_values_pass),
    cmocka_unit_test(wrong_values_fail),
    cmocka_unit_test(a_run_that_gives_up_is_told),
    cmocka_unit_test(bad_input_runs_nothing),
    cmocka_unit_test(a_run_is_compared_with_its_rows),
    cmocka_unit_test(a_verification_goes_on),
    cmocka_unit_test(other_programs_are_named),
    cmocka_unit_test(what_is_no_whole_run_is_not_compared),
  };
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, make_root, remove_root);
  return PetscFinalize() || failed;
}
