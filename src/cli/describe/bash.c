/* Completion for bash: functions that never change stand here as text, and a table of what stands
 * where is written between them. */
#include "cli/describe/describe.h"
#include "cli/describe/values.h"

static const char bash_head[] =
  "# Completion of talus for bash; written by `talus completion bash` from its tables of options.\n"
  "_talus_files() { # TEST WORD: folders, and what passes the test, as `-o filenames` wants them\n"
  "  local name\n"
  "  compopt -o filenames 2>/dev/null\n"
  "  while IFS= read -r name; do\n"
  "    case $1 in\n"
  "      case) if [[ -f $name/case.yaml ]]; then COMPREPLY+=(\"$name/case.yaml\")\n"
  "            elif [[ -d $name || $name == *.yaml || $name == *.yml ]]; then COMPREPLY+=(\"$name\"); fi ;;\n"
  "      run | folder) [[ -d $name ]] && COMPREPLY+=(\"$name\") ;;\n"
  "      *) COMPREPLY+=(\"$name\") ;;\n"
  "    esac\n"
  "  done < <(compgen -f -- \"$2\")\n"
  "  # a folder that holds no case or run is on the way to one: no blank behind it\n"
  "  if [[ ${#COMPREPLY[@]} -eq 1 && -d ${COMPREPLY[0]} && ! -e ${COMPREPLY[0]}/history.csv ]]; then\n"
  "    compopt -o nospace 2>/dev/null\n"
  "  fi\n"
  "}\n\n";

static const char bash_tail[] =
  "_talus() {\n"
  "  local -a words=()\n"
  "  local i token last joined= command= count=-1 option= value prefix= strip kind\n"
  "  COMPREPLY=()\n"
  "  for ((i = 0; i <= COMP_CWORD; ++i)); do # readline has cut words at = and :\n"
  "    token=${COMP_WORDS[i]}\n"
  "    if [[ $i -gt 0 && ( -n $joined || $token == [=:]* ) ]]; then words[${#words[@]}-1]+=$token; else "
  "words+=(\"$token\"); fi\n"
  "    joined=\n"
  "    [[ $token == [=:] ]] && joined=1\n"
  "  done\n"
  "  last=${COMP_WORDS[COMP_CWORD]}\n"
  "  [[ $last == [=:] ]] && last=\n"
  "  value=${words[${#words[@]}-1]}\n"
  "  strip=${value%\"$last\"}\n"
  "  for ((i = 1; i < ${#words[@]} - 1; ++i)); do # how many words that are no options stand before\n"
  "    token=${words[i]}\n"
  "    option=\n"
  "    if [[ -z $command ]]; then [[ $token == -* ]] || command=$token count=0\n"
  "    elif [[ $token == --*=* ]]; then :\n"
  "    elif [[ $token == --* ]]; then\n"
  "      _talus_kind \"$command\" \"$token\"\n"
  "      if [[ $kind != flag ]]; then option=$token; ((++i)); fi\n"
  "    elif [[ $token != -* ]]; then ((++count)); fi\n"
  "  done\n"
  "  ((i == ${#words[@]} - 1)) && option= # the value of the last option is there already\n"
  "  if [[ -z $command ]]; then command=talus count=0\n"
  "  elif [[ -z $option && $value == --*=* ]]; then option=${value%%=*} prefix=$option= value=${value#*=}; fi\n"
  "  if [[ -z $option && $value == -* ]]; then kind=words; _talus_options \"$command\"\n"
  "  else _talus_kind \"$command\" \"${option:-$count}\"; fi\n"
  "  case $kind in\n"
  "    words) COMPREPLY=($(compgen -W \"$list\" -- \"$value\")) ;;\n"
  "    keys) COMPREPLY=($(compgen -W \"$list\" -- \"$value\")); [[ ${COMPREPLY[0]} == *= ]] && compopt -o nospace "
  "2>/dev/null ;;\n"
  "    none | flag) return ;;\n"
  "    *) _talus_files \"$kind\" \"$value\" ;;\n"
  "  esac\n"
  "  for i in \"${!COMPREPLY[@]}\"; do COMPREPLY[i]=$prefix${COMPREPLY[i]}; COMPREPLY[i]=${COMPREPLY[i]#\"$strip\"}; "
  "done\n"
  "}\n"
  "complete -F _talus talus\n";

static const char *const kinds[] = {
  [VALUE_NONE] = "none", [VALUE_WORDS] = "words",   [VALUE_KEYS] = "keys", [VALUE_CASE] = "case",
  [VALUE_RUN] = "run",   [VALUE_FOLDER] = "folder", [VALUE_FILE] = "file"};

/* "    'run --out') kind=folder ;;" */
static void bash_value(FILE *out, const char *command, const char *where, const char *name)
{
  const ValueKind kind = value_kind(name);
  char word[128];
  fprintf(out, "    '%s %s') kind=%s", command, where, kinds[kind]);
  if (kind == VALUE_KEYS) fputs(" list=$_talus_keys", out);
  else if (kind == VALUE_WORDS) {
    fputs(" list='", out);
    for (int i = 0; value_word(name, i, word); ++i) fprintf(out, "%s%s", i ? " " : "", word);
    fputc('\'', out);
  }
  fputs(" ;;\n", out);
}

static void bash_command(FILE *out, const CliCommand *command)
{
  char name[128], where[80];
  for (int i = 0; i < command->usage->max_words && value_of_word(command->usage, i, name); ++i) {
    snprintf(where, sizeof where, "%d", i);
    bash_value(out, command->name, where, name);
  }
  for (const CliOption *o = command->usage->options; o && o->name; ++o) {
    snprintf(where, sizeof where, "--%s", o->name);
    if (o->value) bash_value(out, command->name, where, o->value);
    else fprintf(out, "    '%s %s') kind=flag ;;\n", command->name, where);
  }
}

static void bash_options(FILE *out)
{
  fputs("_talus_options() { # COMMAND: its options in $list\n  case $1 in\n    talus) list='--help --version' ;;\n",
        out);
  for (const CliCommand *command = cli_commands; command->name; ++command) {
    fprintf(out, "    %s) list='--help", command->name);
    for (const CliOption *o = command->usage->options; o && o->name; ++o) fprintf(out, " --%s", o->name);
    fputs("' ;;\n", out);
  }
  fputs("    *) list= ;;\n  esac\n}\n\n", out);
}

void describe_bash(FILE *out)
{
  char word[128];
  fputs(bash_head, out);
  fputs("_talus_keys='", out);
  for (int i = 0; value_word("PATH=VALUE", i, word); ++i) fprintf(out, "%s%s", i ? " " : "", word);
  fputs(
    "'\n\n_talus_kind() { # COMMAND OPTION-OR-NUMBER: what stands there, in $kind, its words in $list\n"
    "  case \"$1 $2\" in\n",
    out);
  bash_value(out, "talus", "0", "COMMAND");
  for (const CliCommand *command = cli_commands; command->name; ++command) bash_command(out, command);
  fputs("    *' --help') kind=flag ;;\n    *) kind=none ;;\n  esac\n}\n\n", out);
  bash_options(out);
  fputs(bash_tail, out);
}
