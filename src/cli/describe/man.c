/* talus(1): one page for all commands. */
#include "cli/describe/describe.h"
#include "talus_version.h"

/* Text for troff: no character of it is a request or a hyphen that could be something else. */
static void man_words(FILE *out, const char *text)
{
  for (const char *c = text; *c; ++c) {
    const PetscBool first = c == text || c[-1] == '\n';
    if (first && (*c == '.' || *c == '\'')) fputs("\\&", out);
    if (*c == '-') fputs("\\-", out);
    else if (*c == '\\') fputs("\\e", out);
    else if (!(first && *c == '\n')) fputc(*c, out);
  }
}

static void man_string(FILE *out, const char *text)
{
  man_words(out, text);
  fputc('\n', out);
}

/* Lines as they stand. */
static void man_lines(FILE *out, const char *text)
{
  fputs(".PP\n.EX\n", out);
  man_string(out, text);
  fputs(".EE\n", out);
}

static void man_option(FILE *out, const CliOption *option)
{
  fprintf(out, ".TP\n\\fB\\-\\-%s\\fR \\fI", option->name);
  if (option->value) man_words(out, option->value);
  fputs("\\fR\n", out);
  man_string(out, option->help);
}

static void man_command(FILE *out, const CliCommand *command)
{
  const CliUsage *usage = command->usage;
  fprintf(out, ".SS talus %s\n", command->name);
  man_string(out, command->help);
  man_lines(out, usage->usage);
  fputs(".PP\n", out);
  man_string(out, usage->help);
  for (const CliOption *option = usage->options; option && option->name; ++option) man_option(out, option);
  if (!usage->examples) return;
  fputs(".PP\nExamples:\n", out);
  man_lines(out, usage->examples);
}

void describe_man(FILE *out)
{
  fprintf(out,
          ".\\\" Written by talus help --man from its tables of options.\n"
          ".TH TALUS 1 \"\" \"talus %s\" \"User Commands\"\n.SH NAME\ntalus \\- %s\n",
          TALUS_VERSION, CLI_WHAT_IT_IS);
  fputs(
    ".SH SYNOPSIS\n.B talus\n.I COMMAND\n\\&... [PETSc options]\n.br\n.B mpiexec \\-n\n.I N\n.B talus\n.I "
    "COMMAND\n\\&...\n"
    ".SH DESCRIPTION\n",
    out);
  man_string(
    out,
    "talus computes how granular matter and solids deform and flow, by the material point method (mpm), updated "
    "Lagrangian finite elements (fem) and a Galerkin meshfree method (gmm), implicitly in time.\nA case is a YAML "
    "file; a run is a folder with states, histories of measures, a log and checkpoints.\nEvery key of the case "
    "file is told by talus schema.");
  man_lines(out, "talus init slump\ntalus run slump/case.yaml\ntalus plot runs/slump");
  fputs(".SH COMMANDS\n", out);
  for (const CliCommand *command = cli_commands; command->name; ++command) man_command(out, command);
  for (const CliNote *note = cli_notes; note->heading; ++note) {
    fprintf(out, ".SH %s\n", note->heading);
    man_string(out, note->text);
  }
  fputs(".SH ENVIRONMENT\n.TP\n.B TALUS_CASES\n", out);
  man_string(out, "Where talus init looks for cases to copy, instead of share/talus/cases beside the program.");
  fputs(".TP\n.B PETSC_OPTIONS\n", out);
  man_string(out, "More options of PETSc.");
  fputs(".SH SEE ALSO\n.BR gmsh (1),\n.BR gnuplot (1),\n.BR mpiexec (1)\n", out);
}
