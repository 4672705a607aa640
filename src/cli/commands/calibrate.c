/* talus calibrate: which parameters give what was measured? */
#include <stdlib.h>
#include <string.h>
#include "calibrate/calibrate.h"
#include "cli/cli.h"

static const CliOption options_known[] = {
  {"out", "DIR", "where runs, tables, pictures and report go; default: runs/calibrate/<name of the file>"},
  {"jobs", "N", "how many runs at a time; default: as many as there are cores"},
  {"quick", NULL, "with the settings for that"},
  {"force", NULL, "run all again, also what is done"},
  {"keep", NULL, "keep the states (.hdf) of runs that are done"},
  {"dry", NULL, "only read all cases, and say how many runs there would be at first"},
  CLI_LAW_OPTIONS,
  {"trust", NULL,
   "let the .geo of a case run programs and write files (Gmsh's SystemCall, Save, ...): only if you know it"},
  {NULL, NULL, NULL},
};

const CliUsage cli_calibrate_usage = {
  .usage = "talus calibrate FILE [options]",
  .help =
    "Looks for the parameters of a material with which the cases of FILE (instruments) give what was measured: as a\n"
    "region, with the errors of its own predictions, and not as a point. Says which parameters are not determined,\n"
    "and confirms the best point by a run. The same command again goes on. The exit code is 3 if there is no such\n"
    "region, or its best point is not confirmed. docs/calibrate.md tells the language of the file.",
  .examples =
    "talus calibrate cases/sugar/S1.yaml --dry   # how many runs?\ntalus calibrate cases/sugar/S1.yaml --quick",
  .options = options_known,
  .min_words = 1,
  .max_words = 1,
};

PetscErrorCode CliCalibrate(int argc, char **argv, int *exit_code)
{
  CliArguments arguments;
  CalibrateOutcome outcome;
  PetscBool go_on;
  Diag *diag;

  PetscFunctionBeginUser;
  PetscCall(CliParse(&cli_calibrate_usage, argc, argv, &arguments, &go_on, exit_code));
  if (go_on) PetscCall(CliCheckJobs(&arguments, &go_on, exit_code));
  if (!go_on) PetscFunctionReturn(0);
  const CalibrateOptions options = {
    .file = arguments.words[0],
    .out = cli_value(&arguments, "out"),
    .jobs = cli_jobs(&arguments),
    .quick = cli_flag(&arguments, "quick"),
    .force = cli_flag(&arguments, "force"),
    .keep = cli_flag(&arguments, "keep"),
    .dry = cli_flag(&arguments, "dry"),
    .trust = cli_flag(&arguments, "trust"),
  };
  PetscCall(DiagCreate(&diag));
  PetscCall(CalibrateFile(&options, stdout, diag, &outcome));
  PetscCall(DiagFlush(diag, stderr));
  PetscCall(DiagDestroy(&diag));
  *exit_code = (int)outcome;
  PetscFunctionReturn(0);
}
