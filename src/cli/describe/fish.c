/* Completion for fish: a line for each option. */
#include <string.h>
#include "cli/describe/describe.h"
#include "cli/describe/values.h"

/* " -x -a '...'": what the value may be. */
static void fish_value(FILE *out, const char *name, const char *exclusive)
{
  const ValueKind kind = value_kind(name);
  char word[128];
  if (kind == VALUE_FILE) fputs(*exclusive ? " -r -F" : " -F", out);
  else if (kind == VALUE_CASE) fprintf(out, "%s -a '(__fish_complete_suffix .yaml)'", exclusive);
  else if (kind == VALUE_RUN || kind == VALUE_FOLDER)
    fprintf(out, "%s -a '(__fish_complete_directories (commandline -ct))'", exclusive);
  else fputs(exclusive, out);
  if (kind != VALUE_WORDS && kind != VALUE_KEYS) return;
  fputs(" -a '", out);
  for (int i = 0; value_word(name, i, word); ++i) fprintf(out, "%s%s", i ? " " : "", word);
  fputc('\'', out);
}

/* The words of a command: those that are alike stand anywhere, others in their place (options
 * have no words behind them there: "--out DIR" would count as one). */
static void fish_words(FILE *out, const CliCommand *command)
{
  char first[128], name[128];
  PetscBool alike = PETSC_TRUE;
  const int most = command->usage->max_words;
  for (int i = 0; i < most && value_of_word(command->usage, i, name); ++i)
    if (i == 0) snprintf(first, sizeof first, "%s", name);
    else alike = alike && !strcmp(first, name);
  for (int i = 0; i < (alike ? PetscMin(most, 1) : most) && value_of_word(command->usage, i, name); ++i) {
    if (value_kind(name) == VALUE_NONE) continue;
    if (alike) fprintf(out, "complete -c talus -n '__fish_seen_subcommand_from %s'", command->name);
    else fprintf(out, "complete -c talus -n '__talus_word %s %d'", command->name, i + 1);
    fish_value(out, name, "");
    fputc('\n', out);
  }
}

static void fish_command(FILE *out, const CliCommand *command)
{
  fprintf(out, "complete -c talus -n __fish_use_subcommand -a %s -d '", command->name);
  value_escaped(out, command->help, "'\\");
  fputs("'\n", out);
  fish_words(out, command);
  for (const CliOption *o = command->usage->options; o && o->name; ++o) {
    fprintf(out, "complete -c talus -n '__fish_seen_subcommand_from %s' -l %s", command->name, o->name);
    if (o->value) fish_value(out, o->value, " -x");
    fputs(" -d '", out);
    value_escaped(out, o->help, "'\\");
    fputs("'\n", out);
  }
}

void describe_fish(FILE *out)
{
  fputs(
    "# Completion of talus for fish; written by `talus completion fish` from its tables of options.\n"
    "function __talus_word\n  set -l words (commandline -opc | string match -v -- '-*')\n"
    "  test (count $words) -eq (math $argv[2] + 1) -a \"$words[2]\" = $argv[1]\nend\n"
    "complete -c talus -f\ncomplete -c talus -l help -d 'show the help of the command'\n"
    "complete -c talus -n __fish_use_subcommand -l version -d 'versions of talus and of its libraries'\n",
    out);
  for (const CliCommand *command = cli_commands; command->name; ++command) fish_command(out, command);
}
