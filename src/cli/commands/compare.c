/* talus compare: how far are the histories of runs apart? */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "cli/cli.h"
#include "picture/compare/compare.h"
#include "picture/plot.h"

static const CliOption options_known[] = {
  {"measure", "NAME", "compare this one; again for more (default: all that the runs have in common)"},
  {"tolerance", "R", "the exit code is 3 if a relative difference is larger, for example 1e-6, or a run lacks values"},
  {"legend", "names|keys",
   "runs by their names, or by the keys in which their cases differ (default: keys, where there are two at most)"},
  {"format", "png|svg|pdf", "of the pictures (default: png)"},
  {"out", "DIR", "where tables and pictures go (default: runs/compare/<names of the runs>)"},
  {NULL, NULL, NULL},
};

const CliUsage cli_compare_usage = {
  .usage = "talus compare RUN_DIR RUN_DIR [RUN_DIR...] [options]",
  .help =
    "Sets the histories of runs beside that of the first one: a table of the largest differences, when they are and\n"
    "how large beside the largest value of the first run, the keys in which the resolved cases differ (one line for\n"
    "a table such as an amplitude), and a picture of each measure. Runs may have other steps: between its rows a\n"
    "history is taken as linear, and the differences are those at all times of both within the time that they have\n"
    "in common. Rows of forces in dynamics are means since the row before: these are compared as means over the rows\n"
    "of the coarser history, and formulas of them as what those rows would have. Those of energies (in J) are relative "
    "to the largest energy of both runs, and those of a balance,\n"
    "which is a share, stand as they are: what is round-off of something larger counts as that. A value that one\n"
    "run has there and another has not (nan) is a difference, too; what a search finds once is compared whenever it\n"
    "was found. The tables are written as differences.csv and keys.csv, too.",
  .examples =
    "talus compare runs/coarse runs/fine\n"
    "talus compare runs/before runs/after --measure tip --tolerance 1e-6   # for scripts: exit code 3 if they differ",
  .options = options_known,
  .min_words = 2,
  .max_words = PLOT_MAX_CURVES,
};

static void say(const char *path)
{
  const char *ending = strrchr(path, '.');
  printf("%s = %s\n", ending && !strcmp(ending, ".csv") ? "table" : "picture", path);
}

static PetscErrorCode Understand(const CliArguments *arguments, PetscReal *tolerance, PetscBool *ok, int *exit_code)
{
  const char *text = cli_value(arguments, "tolerance");
  char *end = NULL;

  PetscFunctionBeginUser;
  *tolerance = text ? (PetscReal)strtod(text, &end) : INFINITY;
  if (text && (end == text || *end || !(*tolerance >= 0) || PetscIsInfReal(*tolerance))) {
    PetscCall(CliUsageError(exit_code, "for example --tolerance 1e-6", "--tolerance wants a number, not '%s'", text));
    *ok = PETSC_FALSE;
  }
  if (*ok) PetscCall(CliOneOf("legend", cli_value(arguments, "legend"), plot_legends, ok, exit_code));
  if (*ok) PetscCall(CliOneOf("format", cli_value(arguments, "format"), plot_formats, ok, exit_code));
  PetscFunctionReturn(0);
}

static PetscErrorCode Compare(const CliArguments *arguments, PetscReal tolerance, int *exit_code)
{
  const char *measures[CLI_MAX_ARGUMENTS];
  const CompareOptions options = {.n_runs = arguments->n_words,
                                  .runs = arguments->words,
                                  .n_measures = cli_values(arguments, "measure", measures),
                                  .measures = measures,
                                  .out = cli_value(arguments, "out"),
                                  .legend = cli_value(arguments, "legend"),
                                  .format = cli_value(arguments, "format")};
  PetscReal worst;
  Diag *diag;

  PetscFunctionBeginUser;
  PetscCall(DiagCreate(&diag));
  PetscCall(CompareRuns(&options, stdout, diag, say, &worst));
  *exit_code = diag_errors(diag) ? CLI_BAD_INPUT : worst > tolerance ? CLI_OUT_OF_TOLERANCE : CLI_DONE;
  if (*exit_code == CLI_OUT_OF_TOLERANCE)
    printf("largest relative difference = %.3g, above %.3g\n", (double)worst, (double)tolerance);
  PetscCall(DiagFlush(diag, stderr));
  PetscCall(DiagDestroy(&diag));
  PetscFunctionReturn(0);
}

PetscErrorCode CliCompare(int argc, char **argv, int *exit_code)
{
  CliArguments arguments;
  PetscReal tolerance;
  PetscBool go_on;

  PetscFunctionBeginUser;
  PetscCall(CliParse(&cli_compare_usage, argc, argv, &arguments, &go_on, exit_code));
  if (go_on) PetscCall(Understand(&arguments, &tolerance, &go_on, exit_code));
  if (!go_on) PetscFunctionReturn(0);
  /* one process compares, the others learn how it went */
  if (cli_prints()) PetscCall(Compare(&arguments, tolerance, exit_code));
  PetscCallMPI(MPI_Bcast(exit_code, 1, MPI_INT, 0, PETSC_COMM_WORLD));
  PetscFunctionReturn(0);
}
