#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "cli/cli.h"

PetscBool cli_prints(void)
{
  PetscMPIInt rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  return rank == 0;
}

PetscErrorCode CliUsageError(int *exit_code, const char *hint, const char *format, ...)
{
  va_list arguments;

  PetscFunctionBeginUser;
  *exit_code = CLI_BAD_INPUT;
  if (!cli_prints()) PetscFunctionReturn(0);
  fputs("error: ", stderr);
  va_start(arguments, format);
  vfprintf(stderr, format, arguments);
  va_end(arguments);
  fputc('\n', stderr);
  if (hint) fprintf(stderr, "  hint: %s\n", hint);
  PetscFunctionReturn(0);
}

static const CliOption *find_option(const CliUsage *usage, const char *name, size_t length)
{
  for (const CliOption *option = usage->options; option && option->name; ++option)
    if (strlen(option->name) == length && !strncmp(option->name, name, length)) return option;
  return NULL;
}

static PetscErrorCode UnknownOption(const CliUsage *usage, const char *text, int *exit_code)
{
  const char *names[64] = {NULL}, *nearest;
  char word[80], hint[120];
  int n = 0;

  PetscFunctionBeginUser;
  for (const CliOption *option = usage->options; option && option->name && n < 62; ++option) names[n++] = option->name;
  names[n] = "help";
  snprintf(word, sizeof(word), "%.*s", (int)strcspn(text + 2, "="), text + 2);
  nearest = diag_nearest(word, names);
  snprintf(hint, sizeof(hint), nearest ? "did you mean --%s?" : "see --help", nearest);
  PetscCall(CliUsageError(exit_code, hint, "option --%s is not known", word));
  PetscFunctionReturn(0);
}

/* Take the option at argv[*i]; *ok is false if something is wrong with it. */
static PetscErrorCode TakeOption(const CliUsage *usage, int argc, char **argv, int *i, CliArguments *a, PetscBool *ok,
                                 int *exit_code)
{
  const char *text = argv[*i], *equals = strchr(text, '=');
  const size_t length = equals ? (size_t)(equals - text - 2) : strlen(text) - 2;
  const CliOption *option = find_option(usage, text + 2, length);

  PetscFunctionBeginUser;
  *ok = PETSC_FALSE;
  if (!option) PetscCall(UnknownOption(usage, text, exit_code));
  else if (!option->value && equals)
    PetscCall(CliUsageError(exit_code, NULL, "option --%s takes no value", option->name));
  else if (option->value && !equals && *i + 1 >= argc)
    PetscCall(
      CliUsageError(exit_code, NULL, "option --%s needs a value: --%s %s", option->name, option->name, option->value));
  else if (a->n_options == CLI_MAX_ARGUMENTS)
    PetscCall(CliUsageError(exit_code, NULL, "there are more than %d options", CLI_MAX_ARGUMENTS));
  else {
    a->names[a->n_options] = option->name;
    a->values[a->n_options++] = !option->value ? "" : equals ? equals + 1 : argv[++*i];
    *ok = PETSC_TRUE;
  }
  PetscFunctionReturn(0);
}

/* What the usage calls the word after `n`: CASE of "talus run CASE [options]". */
static const char *missing_word(const char *usage, int n, char word[64])
{
  for (n += 2; n > 0 && *usage; --n) usage += strcspn(usage, " "), usage += strspn(usage, " ");
  snprintf(word, 64, "%.*s", (int)strcspn(usage, " "), usage);
  return word;
}

static PetscErrorCode CheckWords(const CliUsage *usage, const CliArguments *a, PetscBool *ok, int *exit_code)
{
  char hint[200], word[64], before[64];

  PetscFunctionBeginUser;
  snprintf(hint, sizeof(hint), "usage: %.180s", usage->usage);
  *ok = a->n_words >= usage->min_words && a->n_words <= usage->max_words;
  if (a->n_words < usage->min_words) {
    snprintf(hint, sizeof(hint), "usage: %.100s (options of PETSc go to the end: they take the word behind them)",
             usage->usage);
    const PetscBool another = a->n_words && !strcmp(missing_word(usage->usage, a->n_words, word),
                                                    missing_word(usage->usage, a->n_words - 1, before));
    PetscCall(CliUsageError(exit_code, hint, "there is no %s%s on the command line", another ? "second " : "",
                            missing_word(usage->usage, a->n_words, word)));
  } else if (!*ok) PetscCall(CliUsageError(exit_code, hint, "'%s' is one word too many", a->words[usage->max_words]));
  PetscFunctionReturn(0);
}

PetscErrorCode CliParse(const CliUsage *usage, int argc, char **argv, CliArguments *arguments, PetscBool *go_on,
                        int *exit_code)
{
  PetscFunctionBeginUser;
  memset(arguments, 0, sizeof(*arguments));
  *go_on = PETSC_FALSE;
  *exit_code = CLI_DONE;
  for (int i = 1; i < argc; ++i)
    if (!strcmp(argv[i], "--help") || !strcmp(argv[i], "-h")) {
      cli_print_usage(stdout, usage);
      PetscFunctionReturn(0);
    }
  for (int i = 1; i < argc; ++i) {
    PetscBool ok = PETSC_TRUE;
    if (!strncmp(argv[i], "--", 2) && argv[i][2])
      PetscCall(TakeOption(usage, argc, argv, &i, arguments, &ok, exit_code));
    else if (arguments->n_words < CLI_MAX_ARGUMENTS) arguments->words[arguments->n_words++] = argv[i];
    if (!ok) PetscFunctionReturn(0);
  }
  PetscCall(CheckWords(usage, arguments, go_on, exit_code));
  if (*go_on) PetscCall(CliLoadLaws(arguments, go_on, exit_code));
  PetscFunctionReturn(0);
}

const char *cli_value(const CliArguments *arguments, const char *name)
{
  for (int i = arguments->n_options; i-- > 0;)
    if (!strcmp(arguments->names[i], name)) return arguments->values[i];
  return NULL;
}

PetscBool cli_flag(const CliArguments *arguments, const char *name) { return cli_value(arguments, name) != NULL; }

PetscInt cli_values(const CliArguments *arguments, const char *name, const char **values)
{
  PetscInt n = 0;
  for (int i = 0; i < arguments->n_options; ++i)
    if (!strcmp(arguments->names[i], name)) values[n++] = arguments->values[i];
  return n;
}

PetscErrorCode CliOneOf(const char *option, const char *word, const char *const *words, PetscBool *ok, int *exit_code)
{
  char hint[160];

  PetscFunctionBeginUser;
  for (int k = 0; words[k]; ++k)
    if (!word || !strcmp(word, words[k])) PetscFunctionReturn(0);
  const char *nearest = diag_nearest(word, words);
  snprintf(hint, sizeof hint, "did you mean %s?", nearest ? nearest : "");
  PetscCall(CliUsageError(exit_code, nearest ? hint : NULL, "--%s has no '%s': see --help", option, word));
  *ok = PETSC_FALSE;
  PetscFunctionReturn(0);
}
