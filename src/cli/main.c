/* talus: dispatch to the subcommands. PETSc's options (single dash) go to PETSc, the rest to the
 * subcommand. */
#include <ctype.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/process/memory.h"
#include "base/process/mpi_end.h"
#include "base/process/start.h"
#include "base/process/threads.h"
#include "cli/cli.h"

static const struct Command {
  const char *name, *help;
  PetscErrorCode (*run)(int argc, char **argv, int *exit_code);
} commands[] = {
  {"run", "run a case file", CliRun},
  {"check", "validate a case file and print what was understood", CliCheck},
  {"list", "what there is: laws, methods, cells, measures, fields", CliList},
  {"schema", "the reference of the case file: text, Markdown, JSON Schema", CliSchema},
  {"verify", "run a verification case and compare with its reference", CliVerify},
  {"sweep", "run a case over values of its keys: a table and pictures", CliSweep},
  {"calibrate", "which parameters give what was measured: a region", CliCalibrate},
  {"element", "one material point on a path: triaxial, oedometer, shear", CliElement},
  {"plot", "pictures of a run", CliPlot},
  {"version", "versions of talus and of its libraries (also --version)", CliVersion},
  {NULL, NULL, NULL},
};

static void print_help(FILE *out)
{
  if (!cli_prints()) return;
  fprintf(out,
          "talus - implicit large-deformation solver for granular matter and solids\n\n"
          "usage: talus COMMAND ... [PETSc options]\n       mpiexec -n N talus COMMAND ...\n\ncommands:\n");
  for (const struct Command *command = commands; command->name; ++command)
    fprintf(out, "  %-10s %s\n", command->name, command->help);
  fprintf(
    out,
    "\n`talus COMMAND --help` tells more. Options with a single dash are PETSc's: -snes_monitor, -ksp_view, "
    "-log_view.\n"
    "Root, as in a container, tells Open MPI's mpiexec by OMPI_ALLOW_RUN_AS_ROOT=1 and "
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1\nin the environment that it may start.\n"
    "Exit codes: 0 done, 1 the solver gave up, 2 bad input or usage, 3 a verification fell outside its tolerance.\n");
  fflush(out);
}

static PetscErrorCode UnknownCommand(const char *word, int *exit_code)
{
  const char *names[sizeof(commands) / sizeof(commands[0])] = {NULL}, *nearest;
  char hint[200] = "see talus --help";

  PetscFunctionBeginUser;
  for (int i = 0; commands[i].name; ++i) names[i] = commands[i].name;
  nearest = diag_nearest(word, names);
  if (nearest) snprintf(hint, sizeof(hint), "did you mean 'talus %s'?", nearest);
  else if (strstr(word, ".yaml")) snprintf(hint, sizeof(hint), "to run a case: talus run %.120s", word);
  PetscCall(CliUsageError(exit_code, hint, "'%s' is no command", word));
  PetscFunctionReturn(0);
}

static PetscErrorCode Dispatch(int argc, char **argv, int *exit_code)
{
  const char *word = argc > 1 ? argv[1] : NULL;
  const struct Command *command = commands;

  PetscFunctionBeginUser;
  if (!word) {
    print_help(stderr);
    *exit_code = CLI_BAD_INPUT;
    PetscFunctionReturn(0);
  }
  if (!strcmp(word, "--help") || !strcmp(word, "-h") || !strcmp(word, "help")) {
    print_help(stdout);
    PetscFunctionReturn(0);
  }
  if (!strcmp(word, "--version")) word = "version";
  while (command->name && strcmp(command->name, word)) ++command;
  if (command->name) PetscCall((*command->run)(argc - 1, argv + 1, exit_code));
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

static PetscBool is_command(const char *word)
{
  for (const struct Command *command = commands; command->name; ++command)
    if (!strcmp(command->name, word)) return PETSC_TRUE;
  return PETSC_FALSE;
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
    if (option || (value && is_value(argv[i]) && !(*n_own == 1 && is_command(argv[i])))) petsc[(*n_petsc)++] = argv[i];
    else own[(*n_own)++] = argv[i];
    value = option;
  }
  own[*n_own] = petsc[*n_petsc] = NULL;
}

/* `-out runs/a` would vanish in PETSc's option table without a word. */
static const char *single_dash_mistake(int n, char **petsc)
{
  static const char *const ours[] = {"set",  "out",      "quiet", "force", "resume", "log",  "trust", "full",
                                     "json", "markdown", "over",  "name",  "jobs",   "test", "to",    NULL};
  for (int i = 1; i < n; ++i)
    for (int k = 0; ours[k]; ++k)
      if (petsc[i][0] == '-' && !strcmp(petsc[i] + 1, ours[k])) return ours[k];
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
  if (PetscFinalize()) exit_code = CLI_GAVE_UP;
  return exit_code;
}

int main(int argc, char **argv)
{
  if (mpi_begin(&argc, &argv)) return CLI_GAVE_UP;
  char **own = calloc((size_t)argc + 1, sizeof(char *)), **petsc = calloc((size_t)argc + 1, sizeof(char *));
  const int exit_code = own && petsc ? run_program(argc, argv, own, petsc) : CLI_GAVE_UP;
  free(own);
  free(petsc);
  mpi_end(exit_code);
}
