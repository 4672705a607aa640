/* Completion for fish: a line for each option. */
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

static void fish_command(FILE *out, const CliCommand *command)
{
  char name[128];
  fprintf(out, "complete -c talus -n __fish_use_subcommand -a %s -d '", command->name);
  value_escaped(out, command->help, "'\\");
  fputs("'\n", out);
  for (int i = 0; i < command->usage->max_words && value_of_word(command->usage, i, name); ++i) {
    if (value_kind(name) == VALUE_NONE) continue;
    fprintf(out, "complete -c talus -n '__fish_seen_subcommand_from %s'", command->name);
    fish_value(out, name, "");
    fputc('\n', out);
  }
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
    "complete -c talus -f\ncomplete -c talus -l help -d 'show the help of the command'\n"
    "complete -c talus -n __fish_use_subcommand -l version -d 'versions of talus and of its libraries'\n",
    out);
  for (const CliCommand *command = cli_commands; command->name; ++command) fish_command(out, command);
}
