/* talus sweep: a case over values of its keys. */
#include <stdlib.h>
#include <string.h>
#include "cli/cli.h"
#include "sweep/sweep.h"

static const CliOption options_known[] = {
  {"over", "KEY=VALUES", "a key and its values: from:to:step, or a list a,b,c; may be given often: all combinations"},
  {"along", "KEY=VALUES", "a key that varies along with the --over before it"},
  {"measure", "NAME", "what is taken: NAME (at its end), NAME:max, min, mean, slope, NAME:mean:FROM:TO; default: all"},
  {"band", "NAME=LO:HI", "a range of experiments, shaded in the picture of the --measure before it"},
  {"name", "SWEEP", "a sweep that stands in the case's sweep.yaml (instead of the four above)"},
  {"quick", NULL, "its shorter version"},
  {"set", "PATH=VALUE", "change a value of the case in all members; may be given often"},
  {"out", "DIR", "where members, table and pictures go; default: runs/sweep/<case>[/<name>]"},
  {"jobs", "N", "how many members run at a time; default: as many as there are cores"},
  {"force", NULL, "run all members again, also those that are done"},
  {"keep", NULL, "keep the states (.hdf) of members that are done"},
  {"dry", NULL, "only say which members there would be"},
  CLI_LAW_OPTIONS,
  {"trust", NULL,
   "let the .geo of the case run programs and write files (Gmsh's SystemCall, Save, ...): only if you know it"},
  {NULL, NULL, NULL},
};

const CliUsage cli_sweep_usage = {
  .usage = "talus sweep CASE [options]",
  .help =
    "Runs a case (a file, or its folder) for all combinations of values of some of its keys, as many at a time as\n"
    "there are cores, each in a directory of its own, and puts what came out into one table (sweep.csv) and one\n"
    "picture for each measure: over the first key, a curve for each value of the others. The same command again\n"
    "goes on: members that are done are kept, those that were cut off go on from their checkpoints.\n"
    "The exit code is 1 if a member did not come to its end. docs/sweep.md tells the language of sweep.yaml.",
  .examples =
    "talus sweep cases/cantilever --over materials.rubber.young=50e6:90e6:20e6 --over grid.size=0.25,0.125\n"
    "talus sweep cases/granular-collapse --over materials.grains.friction_angle=20,30,40 --measure front --jobs 2",
  .options = options_known,
  .min_words = 1,
  .max_words = 1,
};

/* The options that say what is swept, in their order. */
static PetscInt take_words(const CliArguments *a, SweepWord *words)
{
  static const char *const names[] = {
    [SWEEP_OVER] = "over", [SWEEP_ALONG] = "along", [SWEEP_MEASURE] = "measure", [SWEEP_BAND] = "band"};
  PetscInt n = 0;
  for (int i = 0; i < a->n_options; ++i)
    for (int kind = 0; kind < 4; ++kind)
      if (!strcmp(a->names[i], names[kind])) words[n++] = (SweepWord){(SweepWordKind)kind, a->values[i]};
  return n;
}

PetscInt cli_jobs(const CliArguments *arguments)
{
  const char *jobs = cli_value(arguments, "jobs");
  return jobs ? (PetscInt)strtol(jobs, NULL, 10) : 0;
}

PetscErrorCode CliCheckJobs(const CliArguments *arguments, PetscBool *ok, int *exit_code)
{
  const char *jobs = cli_value(arguments, "jobs");
  PetscMPIInt size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  *ok = PETSC_FALSE;
  if (size > 1)
    PetscCall(CliUsageError(exit_code, "without mpiexec: --jobs N runs N at a time, each on one rank",
                            "this command is one process, which starts others"));
  else if (jobs && (cli_jobs(arguments) < 1 || jobs[strspn(jobs, "0123456789")]))
    PetscCall(CliUsageError(exit_code, NULL, "--jobs is a number of processes, not '%s'", jobs));
  else *ok = PETSC_TRUE;
  PetscFunctionReturn(0);
}

static PetscErrorCode Check(const CliArguments *a, const SweepOptions *o, PetscBool *ok, int *exit_code)
{
  PetscFunctionBeginUser;
  PetscCall(CliCheckJobs(a, ok, exit_code));
  if (!*ok) PetscFunctionReturn(0);
  *ok = PETSC_FALSE;
  if (o->name && o->n_words)
    PetscCall(CliUsageError(exit_code, "--set changes the case of a sweep by name",
                            "--name takes a sweep from sweep.yaml: no --over, --along, --measure, --band beside it"));
  else if (o->quick && !o->name)
    PetscCall(CliUsageError(exit_code, NULL, "--quick is told by a sweep of sweep.yaml: it needs --name"));
  else *ok = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode CliSweep(int argc, char **argv, int *exit_code)
{
  CliArguments arguments;
  SweepWord words[CLI_MAX_ARGUMENTS];
  const char *set[CLI_MAX_ARGUMENTS];
  SweepOutcome outcome;
  PetscBool go_on;
  Diag *diag;

  PetscFunctionBeginUser;
  PetscCall(CliParse(&cli_sweep_usage, argc, argv, &arguments, &go_on, exit_code));
  if (!go_on) PetscFunctionReturn(0);
  const SweepOptions options = {
    .file = arguments.words[0],
    .name = cli_value(&arguments, "name"),
    .n_words = take_words(&arguments, words),
    .words = words,
    .n_set = cli_values(&arguments, "set", set),
    .set = set,
    .out = cli_value(&arguments, "out"),
    .jobs = cli_jobs(&arguments),
    .quick = cli_flag(&arguments, "quick"),
    .force = cli_flag(&arguments, "force"),
    .keep = cli_flag(&arguments, "keep"),
    .trust = cli_flag(&arguments, "trust"),
    .dry = cli_flag(&arguments, "dry"),
  };
  PetscCall(Check(&arguments, &options, &go_on, exit_code));
  if (!go_on) PetscFunctionReturn(0);
  PetscCall(DiagCreate(&diag));
  PetscCall(SweepCase(&options, stdout, diag, &outcome));
  PetscCall(DiagFlush(diag, stderr));
  PetscCall(DiagDestroy(&diag));
  *exit_code = (int)outcome;
  PetscFunctionReturn(0);
}
