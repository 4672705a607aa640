/* Completion for zsh: a function of _arguments for each command. */
#include "cli/describe/describe.h"
#include "cli/describe/values.h"

/* What is special within '...[help]:message:action'; the quote itself is a curly one there. */
static void zsh_text(FILE *out, const char *text)
{
  for (; *text; ++text)
    if (*text == '\'') fputs("\xe2\x80\x99", out);
    else {
      const char one[2] = {*text, 0};
      value_escaped(out, one, "[]:\\");
    }
}

/* ":MESSAGE:ACTION" */
static void zsh_value(FILE *out, const char *name)
{
  static const char *const actions[] = {
    [VALUE_NONE] = "( )",         [VALUE_KEYS] = "_talus_keys",    [VALUE_CASE] = "_files -g \"*.y(a|)ml\"",
    [VALUE_RUN] = "_directories", [VALUE_FOLDER] = "_directories", [VALUE_FILE] = "_files"};
  char word[128];
  fputc(':', out);
  zsh_text(out, name);
  fputc(':', out);
  if (value_kind(name) != VALUE_WORDS) {
    fputs(value_kind(name) == VALUE_NONE ? " " : actions[value_kind(name)], out);
    return;
  }
  fputc('(', out);
  for (int i = 0; value_word(name, i, word); ++i) fprintf(out, "%s%s", i ? " " : "", word);
  fputc(')', out);
}

static void zsh_command(FILE *out, const CliCommand *command)
{
  char name[128];
  fprintf(out, "_talus_%s() {\n  _arguments \\\n", command->name);
  for (const CliOption *o = command->usage->options; o && o->name; ++o) {
    fprintf(out, "    '*--%s%s[", o->name, o->value ? "=" : "");
    zsh_text(out, o->help);
    fputc(']', out);
    if (o->value) zsh_value(out, o->value);
    fputs("' \\\n", out);
  }
  for (int i = 0; i < command->usage->max_words && value_of_word(command->usage, i, name); ++i) {
    fprintf(out, "    '%d", i + 1);
    zsh_value(out, name);
    fputs("' \\\n", out);
  }
  fputs("    '--help[show the help of this command]'\n}\n\n", out);
}

void describe_zsh(FILE *out)
{
  char word[128];
  fputs(
    "#compdef talus\n# Written by `talus completion zsh` from the tables of options.\n\n"
    "_talus_keys() {\n  local -a keys=(\n",
    out);
  for (int i = 0; value_word("PATH=VALUE", i, word); ++i) fprintf(out, "    '%s'\n", word);
  fputs("  )\n  compadd -S '' -a keys\n}\n\n", out);
  for (const CliCommand *command = cli_commands; command->name; ++command) zsh_command(out, command);
  fputs("_talus() {\n  local -a commands=(\n", out);
  for (const CliCommand *command = cli_commands; command->name; ++command) {
    fprintf(out, "    '%s:", command->name);
    zsh_text(out, command->help);
    fputs("'\n", out);
  }
  fputs(
    "  )\n  if (( CURRENT == 2 )); then\n    _describe command commands\n  else\n"
    "    shift words\n    (( CURRENT-- ))\n    (( $+functions[_talus_$words[1]] )) && _talus_$words[1]\n  fi\n}\n\n"
    "if [[ $funcstack[1] == _talus ]]; then _talus \"$@\"; else compdef _talus talus; fi\n",
    out);
}
