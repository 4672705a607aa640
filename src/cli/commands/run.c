/* talus run: from a case file to a directory of results. */
#include <errno.h>
#include <string.h>
#include <unistd.h>
#include "cli/cli.h"
#include "input/case_file.h"
#include "output/inputs.h"
#include "run/run.h"
#include "verify/verify.h"

static const CliOption options_known[] = {
  {"set", "PATH=VALUE", "change a value of the case, e.g. --set materials.rubber.young=1e6; may be given often"},
  {"out", "DIR", "where the results go; default: runs/<name of the case>"},
  {"force", NULL, "replace a run that is in DIR already"},
  {"resume", "RUN_DIR", "go on with the run in DIR from its newest checkpoint, on any number of ranks; no CASE then"},
  {"quiet", NULL, "nothing on the terminal but errors and warnings"},
  {"log", "FILE", "write the log there instead of to DIR/log.txt"},
  CLI_LAW_OPTIONS,
  {"trust", NULL,
   "let the .geo of the case run programs and write files (Gmsh's SystemCall, Save, ...): only if you know it"},
  {NULL, NULL, NULL},
};

const CliUsage cli_run_usage = {
  .usage = "talus run CASE [options], or talus run --resume RUN_DIR [options]",
  .help =
    "Runs a case file and writes states (.hdf, for ParaView), history.csv and a log into a run directory. Every ten\n"
    "minutes (checkpoint: in the case) and when a signal asks the run to leave (SIGINT, SIGTERM, SIGHUP, SIGUSR1 ...)\n"
    "the whole state is put away there; with --resume a run that was cut off goes on as if nothing had been. Then\n"
    "--set may change checkpoint, newton, linear, parallel, petsc, analysis.smallest and .largest, grid.outside and,\n"
    "in dynamics, analysis.end and .until (stages[N].newton and so on, the end of the last stage alone), and say "
    "where\n"
    "the files of a run are that has moved.\n"
    "If the case has a reference.yaml beside it that knows this very case, the results are compared with it.",
  .examples =
    "talus run cases/cantilever/case.yaml\n"
    "talus run case.yaml --out runs/soft --set materials.rubber.young=1e6 --set grid.size=0.25\n"
    "mpiexec -n 4 talus run case.yaml\n"
    "talus run --resume runs/soft   # go on after a power cut",
  .options = options_known,
  .min_words = 0,
  .max_words = 1,
};

/* What a resumed run may change: how it is solved, not what. */
static const char *const may_change[] = {
  "checkpoint",       "newton",       "linear",         "parallel",     "petsc", "analysis.smallest",
  "analysis.largest", "analysis.end", "analysis.until", "grid.outside", NULL};

/* The last word of a key. */
static const char *last_word(const char *key, int n)
{
  while (n > 0 && key[n - 1] != '.') --n;
  return key + n;
}

/* Does PATH=VALUE say where a file of the run is now? Its contents are compared later. */
static PetscBool says_where(const char *set, const Inputs *inputs)
{
  const int n = (int)strcspn(set, "=");
  const char *word = last_word(set, n);
  const size_t length = (size_t)(set + n - word);
  for (PetscInt k = 0; k < inputs->n; ++k) {
    const char *key = inputs->input[k].key, *own = last_word(key, (int)strlen(key));
    if (!strchr(key, ',') && strlen(own) == length && !strncmp(own, word, length)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* What stands behind "stages[N]." */
static const char *key_in_stage(const char *set)
{
  int n = 0;
  (void)sscanf(set, "stages[%*d].%n", &n);
  return set + n;
}

/* PATH=VALUE names one of these, of the case or of a stage, or a key below it. */
static PetscBool may_change_on_resume(const char *set)
{
  const char *key = key_in_stage(set);
  for (int i = 0; may_change[i]; ++i) {
    const size_t n = strlen(may_change[i]);
    if (!strncmp(key, may_change[i], n) && (key[n] == '=' || key[n] == '.')) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

static PetscErrorCode SayWhatMayChange(const char *set, int *exit_code)
{
  char list[256] = "", hint[512];

  PetscFunctionBeginUser;
  for (int i = 0; may_change[i]; ++i) {
    const size_t used = strlen(list);
    snprintf(list + used, sizeof list - used, "%s%s", i ? ", " : "", may_change[i]);
  }
  snprintf(
    hint, sizeof hint,
    "it may change %s (ends in dynamics alone), these of stages (stages[N].newton; the end of the last one), and "
    "where files are; for all else start a new run: talus run DIR/case.yaml --out ANOTHER --set ...",
    list);
  PetscCall(CliUsageError(exit_code, hint, "a resumed run cannot change %.*s", (int)strcspn(set, "="), set));
  PetscFunctionReturn(0);
}

/* runs/cantilever for cases/cantilever/case.yaml and for cantilever.yaml. */
static void default_out(const char *file, char *out, size_t size)
{
  char name[PETSC_MAX_PATH_LEN], *base, *dot;
  PetscStrncpy(name, file, sizeof name);
  base = strrchr(name, '/') ? strrchr(name, '/') + 1 : name;
  if (!strcmp(base, "case.yaml") && base > name) {
    base[-1] = '\0';
    base = strrchr(name, '/') ? strrchr(name, '/') + 1 : name;
  } else if ((dot = strrchr(base, '.')) && dot > base) *dot = '\0';
  PetscSNPrintf(out, size, "runs/%s", base);
}

/* Beside the references of the case, if it has any. Whatever they say, the run is done. */
static PetscErrorCode Compare(const char *file, const char *out)
{
  char folder[PETSC_MAX_PATH_LEN], reference[PETSC_MAX_PATH_LEN + 16];
  const char *slash = strrchr(file, '/');
  const VerifyOptions options = {.folder = folder, .run = out};
  VerifyOutcome outcome;
  PetscMPIInt there;
  PetscInt n;
  Diag *diag;

  PetscFunctionBeginUser;
  if (strcmp(slash ? slash + 1 : file, "case.yaml")) PetscFunctionReturn(0);
  snprintf(folder, sizeof folder, "%.*s", slash ? PetscMax((int)(slash - file), 1) : 1, slash ? file : ".");
  snprintf(reference, sizeof reference, "%s/reference.yaml", folder);
  there = access(reference, F_OK) == 0;
  PetscCallMPI(MPI_Bcast(&there, 1, MPI_INT, 0, PETSC_COMM_WORLD));
  if (!there) PetscFunctionReturn(0);
  PetscCall(DiagCreate(&diag));
  PetscCall(VerifyRun(PETSC_COMM_WORLD, &options, stdout, diag, &n, &outcome));
  PetscCall(DiagFlush(diag, stderr));
  PetscCall(DiagDestroy(&diag));
  PetscFunctionReturn(0);
}

/* Is there anything to resume in the folder? */
static PetscBool has_run(const char *folder)
{
  char file[PETSC_MAX_PATH_LEN];
  PetscSNPrintf(file, sizeof file, "%s/case.yaml", folder);
  return (PetscBool)!access(file, R_OK);
}

/* CASE or --resume, and what may stand beside it; *ok is false after a complaint. No run there is told later. */
static PetscErrorCode CheckArguments(const CliArguments *a, PetscInt n_set, const char *const *set, PetscBool *ok,
                                     int *exit_code)
{
  const char *folder = cli_value(a, "resume");
  Inputs inputs = {0};

  PetscFunctionBeginUser;
  *ok = PETSC_FALSE;
  if (folder) PetscCall(InputsRead(folder, &inputs));
  if (!folder && !a->n_words)
    PetscCall(CliUsageError(exit_code,
                            "usage: talus run CASE [options] (options of PETSc go to the end: they take the "
                            "word behind them)",
                            "there is no CASE on the command line"));
  else if (folder && (a->n_words || cli_flag(a, "out") || cli_flag(a, "force")))
    PetscCall(CliUsageError(exit_code, "talus run --resume DIR",
                            "--resume goes on in DIR with the case that is there: CASE, --out and --force make no "
                            "sense beside it"));
  else *ok = PETSC_TRUE;
  for (PetscInt i = 0; folder && has_run(folder) && *ok && i < n_set; ++i) {
    if (may_change_on_resume(set[i]) || says_where(set[i], &inputs)) continue;
    PetscCall(SayWhatMayChange(set[i], exit_code));
    *ok = PETSC_FALSE;
  }
  PetscCall(InputsClear(&inputs));
  PetscFunctionReturn(0);
}

/* The case: the file given, or the one that the run to be resumed has kept. */
static void choose_files(const CliArguments *a, char file[PETSC_MAX_PATH_LEN], char out[PETSC_MAX_PATH_LEN])
{
  const char *folder = cli_value(a, "resume"), *asked = cli_value(a, "out");
  if (folder) {
    PetscSNPrintf(file, PETSC_MAX_PATH_LEN, "%s/case.yaml", folder);
    PetscStrncpy(out, folder, PETSC_MAX_PATH_LEN);
  } else {
    PetscStrncpy(file, a->words[0], PETSC_MAX_PATH_LEN);
    if (asked) PetscStrncpy(out, asked, PETSC_MAX_PATH_LEN);
    else default_out(file, out, PETSC_MAX_PATH_LEN);
  }
}

/* Files that the run in the folder has read and that are not there any more may have moved with it. */
static PetscErrorCode HintMoved(const char *folder, Diag *diag)
{
  Inputs inputs;

  PetscFunctionBeginUser;
  PetscCall(InputsRead(folder, &inputs));
  for (const Input *i = inputs.input; i < inputs.input + inputs.n; ++i) {
    if (strchr(i->key, ',') || !access(i->path, F_OK) || !strcmp(i->key, "initial.run")) continue;
    diag_hint(diag, "where it has moved, say where it is (from the folder of the run): --set %s=PATH", i->key);
    break;
  }
  PetscCall(InputsClear(&inputs));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadAndRun(const CliArguments *a, PetscInt n_set, const char *const *set, int *exit_code)
{
  char file[PETSC_MAX_PATH_LEN], out[PETSC_MAX_PATH_LEN];
  RunResult result = RUN_BAD_INPUT;
  RunSummary summary = {0};
  Diag *diag;
  Case *c = NULL;

  PetscFunctionBeginUser;
  choose_files(a, file, out);
  PetscCall(DiagCreate(&diag));
  if (cli_flag(a, "resume") && !has_run(out)) {
    diag_error(diag, NULL, "there is no run to resume in '%s': %s: %s", out, file, strerror(errno));
    diag_hint(diag, "a run that was cut off before it began is started again, with --force");
  } else PetscCall(CaseRead(PETSC_COMM_WORLD, file, n_set, set, diag, &c));
  if (c) {
    c->grid.trusted = cli_flag(a, "trust");
    const RunOptions run = {.out = out,
                            .resume = cli_flag(a, "resume"),
                            .force = cli_flag(a, "force"),
                            .quiet = cli_flag(a, "quiet"),
                            .log = cli_value(a, "log"),
                            .warnings = stderr,
                            .summary = &summary};
    PetscCall(RunCase(PETSC_COMM_WORLD, c, &run, diag, NULL, &result));
    if (cli_flag(a, "resume") && result == RUN_BAD_INPUT) PetscCall(HintMoved(out, diag));
    if (summary.reason[0]) diag_error(diag, NULL, "%s", summary.reason);
    if (summary.resumable)
      diag_hint(diag, "talus run --resume %s goes on from step %d", out, (int)summary.checkpoint_step);
  }
  PetscCall(DiagFlush(diag, stderr));
  if (result == RUN_DONE && !cli_flag(a, "quiet")) PetscCall(Compare(file, out));
  *exit_code = (int)result;
  PetscCall(CaseDestroy(&c));
  PetscCall(DiagDestroy(&diag));
  PetscFunctionReturn(0);
}

PetscErrorCode CliRun(int argc, char **argv, int *exit_code)
{
  CliArguments arguments;
  PetscBool go_on;
  const char *set[CLI_MAX_ARGUMENTS];

  PetscFunctionBeginUser;
  PetscCall(CliParse(&cli_run_usage, argc, argv, &arguments, &go_on, exit_code));
  if (!go_on) PetscFunctionReturn(0);
  const PetscInt n_set = cli_values(&arguments, "set", set);
  PetscCall(CheckArguments(&arguments, n_set, set, &go_on, exit_code));
  if (go_on) PetscCall(ReadAndRun(&arguments, n_set, set, exit_code));
  PetscFunctionReturn(0);
}
