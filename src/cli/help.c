/* talus help, and what --help prints. */
#include <stdio.h>
#include <string.h>
#include "cli/cli.h"
#include "cli/describe/describe.h"

const CliNote cli_notes[] = {
  {"OPTIONS OF PETSC", "Options with a single dash are PETSc's: -snes_monitor, -ksp_view, -log_view."},
  {"SEVERAL RANKS",
   "Root, as in a container, tells Open MPI's mpiexec by OMPI_ALLOW_RUN_AS_ROOT=1 and "
   "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1\nin the environment that it may start."},
  {"EXIT STATUS",
   "Exit codes: 0 done, 1 the solver gave up, 2 bad input or usage, 3 a verification fell outside its tolerance."},
  {NULL, NULL},
};

static const CliOption options[] = {
  {"man", NULL, "the manual page in troff, as `make install` puts it beside the program"},
  {NULL, NULL, NULL},
};

const CliUsage cli_help_usage = {
  .usage = "talus help [COMMAND] [--man]",
  .help = "Prints what commands there are, or what `talus COMMAND --help` prints.",
  .examples = "talus help run\ntalus help --man | man -l -   # the manual of a talus that is not installed",
  .options = options,
  .max_words = 1,
};

void cli_print_overview(FILE *out)
{
  if (!cli_prints()) return;
  fprintf(out,
          "talus - %s\n\n"
          "usage: talus COMMAND ... [PETSc options]\n       mpiexec -n N talus COMMAND ...\n\ncommands:\n",
          CLI_WHAT_IT_IS);
  for (const CliCommand *command = cli_commands; command->name; ++command)
    fprintf(out, "  %-10s %s\n", command->name, command->help);
  fprintf(out,
          "\nA beginning: talus init slump, talus run slump/case.yaml, talus plot runs/slump.\n"
          "`talus COMMAND --help` tells more, `talus help --man | man -l -` all of it.\n");
  for (const CliNote *note = cli_notes; note->heading; ++note) fprintf(out, "%s\n", note->text);
  fflush(out);
}

void cli_print_usage(FILE *out, const CliUsage *usage)
{
  char left[64];
  if (!cli_prints()) return;
  fprintf(out, "usage: %s\n\n%s\n\noptions:\n", usage->usage, usage->help);
  for (const CliOption *option = usage->options; option && option->name; ++option) {
    snprintf(left, sizeof(left), "--%s %s", option->name, option->value ? option->value : "");
    fprintf(out, "  %-30s %s\n", left, option->help);
  }
  fprintf(out, "  %-30s %s\n", "--help", "show this");
  for (const char *line = usage->examples; line && *line; line += strcspn(line, "\n"), line += *line == '\n')
    fprintf(out, "%s  %.*s\n", line == usage->examples ? "\nexamples:\n" : "", (int)strcspn(line, "\n"), line);
  fflush(out);
}

PetscErrorCode CliHelp(int argc, char **argv, int *exit_code)
{
  CliArguments arguments;
  const CliCommand *command = NULL;
  PetscBool go_on;

  PetscFunctionBeginUser;
  PetscCall(CliParse(&cli_help_usage, argc, argv, &arguments, &go_on, exit_code));
  if (!go_on) PetscFunctionReturn(0);
  if (arguments.n_words) command = cli_find_command(arguments.words[0]);
  if (arguments.n_words && !command)
    PetscCall(CliUsageError(exit_code, "talus help lists them", "'%s' is no command", arguments.words[0]));
  else if (cli_flag(&arguments, "man") && cli_prints()) describe_man(stdout);
  else if (command) cli_print_usage(stdout, command->usage);
  else cli_print_overview(stdout);
  fflush(stdout);
  PetscFunctionReturn(0);
}
