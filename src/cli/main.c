/* talus: dispatch to the subcommands. PETSc's options (single dash) go to PETSc, the rest to the
 * subcommand. */
#include <ctype.h>
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/process/blas.h"
#include "base/process/memory.h"
#include "base/process/mpi_end.h"
#include "base/process/start.h"
#include "cli/cli.h"

const CliCommand cli_commands[] = {
  {"run", "run a case file", CliRun, &cli_run_usage},
  {"check", "validate a case file and print what was understood", CliCheck, &cli_check_usage},
  {"init", "a first case to begin with, or a copy of an installed one", CliInit, &cli_init_usage},
  {"import", "a case from a project of another program: Kratos", CliImport, &cli_import_usage},
  {"list", "what there is: laws, methods, cells, measures, fields", CliList, &cli_list_usage},
  {"schema", "the reference of the case file: text, Markdown, JSON Schema", CliSchema, &cli_schema_usage},
  {"verify", "run a verification case and compare with its reference", CliVerify, &cli_verify_usage},
  {"sweep", "run a case over values of its keys: a table and pictures", CliSweep, &cli_sweep_usage},
  {"calibrate", "which parameters give what was measured: a region", CliCalibrate, &cli_calibrate_usage},
  {"element", "one material point on a path: triaxial, oedometer, shear", CliElement, &cli_element_usage},
  {"plot", "pictures of a run, histories of several", CliPlot, &cli_plot_usage},
  {"compare", "how far the histories of runs are apart, and in which keys", CliCompare, &cli_compare_usage},
  {"version", "versions of talus and of its libraries (also --version)", CliVersion, &cli_version_usage},
  {"completion", "what makes a shell complete: bash, zsh or fish", CliCompletion, &cli_completion_usage},
  {"help", "this, or the help of a command; the man page", CliHelp, &cli_help_usage},
  {NULL, NULL, NULL, NULL},
};

const CliCommand *cli_find_command(const char *name)
{
  for (const CliCommand *command = cli_commands; command->name; ++command)
    if (!strcmp(command->name, name)) return command;
  return NULL;
}

static PetscErrorCode UnknownCommand(const char *word, int *exit_code)
{
  const char *names[sizeof(cli_commands) / sizeof(cli_commands[0])] = {NULL}, *nearest;
  char hint[200] = "see talus --help";

  PetscFunctionBeginUser;
  for (int i = 0; cli_commands[i].name; ++i) names[i] = cli_commands[i].name;
  nearest = diag_nearest(word, names);
  if (nearest) snprintf(hint, sizeof(hint), "did you mean 'talus %s'?", nearest);
  else if (strstr(word, ".yaml")) snprintf(hint, sizeof(hint), "to run a case: talus run %.120s", word);
  PetscCall(CliUsageError(exit_code, hint, "'%s' is no command", word));
  PetscFunctionReturn(0);
}

static PetscErrorCode Dispatch(int argc, char **argv, int *exit_code)
{
  const char *word = argc > 1 ? argv[1] : NULL;

  PetscFunctionBeginUser;
  if (!word) {
    cli_print_overview(stderr);
    *exit_code = CLI_BAD_INPUT;
    PetscFunctionReturn(0);
  }
  if (!strcmp(word, "--help") || !strcmp(word, "-h")) {
    cli_print_overview(stdout);
    PetscFunctionReturn(0);
  }
  if (!strcmp(word, "--version")) word = "version";
  const CliCommand *command = cli_find_command(word);
  if (command) PetscCall((*command->run)(argc - 1, argv + 1, exit_code));
  else if (word[0] == '-')
    PetscCall(CliUsageError(exit_code, "the command comes first, see talus --help", "'%s' is no command", word));
  else PetscCall(UnknownCommand(word, exit_code));
  PetscFunctionReturn(0);
}

static PetscBool is_petsc_option(const char *word)
{
  return word[0] == '-' && isalpha((unsigned char)word[1]) && strcmp(word, "-h");
}

/* Does the word behind a PETSc option belong to it? PETSc's own rule: yes, unless it is an
 * option. */
static PetscBool is_value(const char *word)
{
  return word[0] != '-' || isdigit((unsigned char)word[1]) || word[1] == '.';
}

/* Share argv out; the first word that is a command is never a value, so that `talus -snes_monitor
 * run` works. Both arrays keep argv[0] and end with NULL. */
static void split(int argc, char **argv, int *n_own, char **own, int *n_petsc, char **petsc)
{
  PetscBool value = PETSC_FALSE; /* the word before was a PETSc option */
  *n_own = *n_petsc = 1;
  own[0] = petsc[0] = argv[0];
  for (int i = 1; i < argc; ++i) {
    const PetscBool option = is_petsc_option(argv[i]);
    if (option || (value && is_value(argv[i]) && !(*n_own == 1 && cli_find_command(argv[i]))))
      petsc[(*n_petsc)++] = argv[i];
    else own[(*n_own)++] = argv[i];
    value = option;
  }
  own[*n_own] = petsc[*n_petsc] = NULL;
}

/* `-out runs/a` would vanish in PETSc's option table without a word. */
static const char *single_dash_mistake(int n, char **petsc)
{
  for (int i = 1; i < n; ++i)
    for (const CliCommand *command = cli_commands; command->name && petsc[i][0] == '-'; ++command)
      for (const CliOption *o = command->usage->options; o && o->name; ++o)
        if (!strcmp(petsc[i] + 1, o->name)) return o->name;
  return NULL;
}

/* own: the words that are no options of PETSc. */
static PetscErrorCode Main(int argc, char **argv, int n_own, char **own, const char *mistake, int *exit_code)
{
  PetscBool same;
  char hint[80];

  PetscFunctionBeginUser;
  PetscCall(CliSameCommand(argc, argv, &same, exit_code));
  if (!same) PetscFunctionReturn(0);
  if (mistake) {
    snprintf(hint, sizeof(hint), "did you mean --%s?", mistake);
    PetscCall(CliUsageError(exit_code, hint, "-%s has a single dash, so it would be an option of PETSc", mistake));
  } else PetscCall(Dispatch(n_own, own, exit_code));
  PetscFunctionReturn(0);
}

/* A file that PETSc would have read by itself is not: its options would be missed in silence. */
static void warn_of_options_file(int n, char **petsc)
{
  char path[PETSC_MAX_PATH_LEN];
  if (!cli_prints() || !start_unread_file(n, petsc, path)[0]) return;
  fprintf(stderr,
          "warning: %s is not read\n  hint: options of PETSc belong on the command line or in $PETSC_OPTIONS; "
          "-options_file %s reads this one\n",
          path, path);
}

/* What is said is all that most commands give. Runs have their directories, and go on where nobody
 * listens. */
static PetscBool says_its_result(int n_own, char **own)
{
  static const char *const long_ones[] = {"run", "sweep", "calibrate"};
  for (int i = 1; i < n_own; ++i)
    if (!strcmp(own[i], "--help") || !strcmp(own[i], "-h")) return PETSC_TRUE;
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(long_ones) && n_own > 1; ++k)
    if (!strcmp(own[1], long_ones[k])) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* A full disk shows when the last of it is written. */
static int check_output(int n_own, char **own, int exit_code)
{
  errno = 0;
  if (!cli_prints() || (!fflush(stdout) && !ferror(stdout))) return exit_code;
  fprintf(stderr, "%s: what is printed could not be written%s%s\n", says_its_result(n_own, own) ? "error" : "warning",
          errno ? ": " : "", errno ? strerror(errno) : "");
  return exit_code == CLI_DONE && says_its_result(n_own, own) ? CLI_GAVE_UP : exit_code;
}

/* own and petsc: room for argc + 1 words each. */
static int run_program(int argc, char **argv, char **own, char **petsc)
{
  char **list = petsc;
  int n_own, n_petsc, exit_code = CLI_DONE;

  split(argc, argv, &n_own, own, &n_petsc, petsc);
  const char *mistake = single_dash_mistake(n_petsc, petsc);
  if (StartPetsc(&n_petsc, &list)) return CLI_BAD_INPUT;
  threads_one_per_rank();
  warn_of_options_file(n_petsc, petsc);
  signal(SIGPIPE, SIG_DFL); /* `talus ... | head` ends quietly */
  /* An internal error on one rank must not leave the others waiting. */
  if (Main(argc, argv, n_own, own, mistake, &exit_code)) MPI_Abort(PETSC_COMM_WORLD, CLI_GAVE_UP);
  exit_code = check_output(n_own, own, exit_code);
  if (PetscFinalize()) exit_code = CLI_GAVE_UP;
  return exit_code;
}

int main(int argc, char **argv)
{
  blas_know_processor();
  if (mpi_begin(&argc, &argv)) return CLI_GAVE_UP;
  char **own = calloc((size_t)argc + 1, sizeof(char *)), **petsc = calloc((size_t)argc + 1, sizeof(char *));
  const int exit_code = own && petsc ? run_program(argc, argv, own, petsc) : CLI_GAVE_UP;
  free(own);
  free(petsc);
  mpi_end(exit_code);
}
