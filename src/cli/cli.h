/* The command line: a table of subcommands (main.c), one file for each, and one parser of options.
 *
 * A subcommand gets its own arguments: argv[0] is its name, and PETSc's options (single dash) have
 * already gone to PetscInitialize. It runs on every rank of PETSC_COMM_WORLD and sets the exit code
 * that all ranks return. */
#pragma once
#include <petscsys.h>
#include "base/diag/diag.h"

/* Exit codes, the same for every subcommand. */
typedef enum { CLI_DONE = 0, CLI_GAVE_UP = 1, CLI_BAD_INPUT = 2, CLI_OUT_OF_TOLERANCE = 3 } CliExit;

PetscErrorCode CliRun(int argc, char **argv, int *exit_code);
PetscErrorCode CliCheck(int argc, char **argv, int *exit_code);
PetscErrorCode CliList(int argc, char **argv, int *exit_code);
PetscErrorCode CliSchema(int argc, char **argv, int *exit_code);
PetscErrorCode CliVerify(int argc, char **argv, int *exit_code);
PetscErrorCode CliSweep(int argc, char **argv, int *exit_code);
PetscErrorCode CliCalibrate(int argc, char **argv, int *exit_code);
PetscErrorCode CliElement(int argc, char **argv, int *exit_code);
PetscErrorCode CliPlot(int argc, char **argv, int *exit_code);
PetscErrorCode CliCompare(int argc, char **argv, int *exit_code);
PetscErrorCode CliVersion(int argc, char **argv, int *exit_code);
PetscErrorCode CliInit(int argc, char **argv, int *exit_code);
PetscErrorCode CliImport(int argc, char **argv, int *exit_code);
PetscErrorCode CliHelp(int argc, char **argv, int *exit_code);
PetscErrorCode CliCompletion(int argc, char **argv, int *exit_code);

/* An option --name; `value` names what follows it ("DIR"), NULL for a flag. What a shell offers
 * there follows from that name, too (describe/values.h). */
typedef struct {
  const char *name, *value, *help;
} CliOption;

/* How a subcommand is used: what --help, the man page and completion are made from. */
typedef struct {
  const char *usage;        /* "talus run CASE [options]" */
  const char *help;         /* what it does, a sentence or a paragraph */
  const char *examples;     /* lines of commands, each with a comment behind # if it needs one */
  const CliOption *options; /* ended by name = NULL; --help is always there */
  int min_words, max_words; /* how many words that are no options */
} CliUsage;
extern const CliUsage cli_run_usage, cli_check_usage, cli_init_usage, cli_import_usage, cli_list_usage,
  cli_schema_usage, cli_verify_usage, cli_sweep_usage, cli_calibrate_usage, cli_plot_usage, cli_compare_usage,
  cli_element_usage, cli_version_usage, cli_help_usage, cli_completion_usage;

/* A subcommand; the table is in main.c, ended by name = NULL. */
typedef struct {
  const char *name, *help;
  PetscErrorCode (*run)(int argc, char **argv, int *exit_code);
  const CliUsage *usage;
} CliCommand;
extern const CliCommand cli_commands[];
/* NULL if there is none of that name. */
const CliCommand *cli_find_command(const char *name);

#define CLI_MAX_ARGUMENTS 256

/* What was given. Nothing here is copied: the strings belong to argv. */
typedef struct {
  int n_words;
  const char *words[CLI_MAX_ARGUMENTS];
  int n_options;
  const char *names[CLI_MAX_ARGUMENTS];  /* as in CliOption, the same pointer */
  const char *values[CLI_MAX_ARGUMENTS]; /* "" for flags */
} CliArguments;

/* Sort argv into words and options; --name=value and --name value are the same. PETSC_FALSE in
 * *go_on: help was asked for or something is wrong, it has been printed (once), *exit_code is set,
 * and the subcommand returns. */
PetscErrorCode CliParse(const CliUsage *usage, int argc, char **argv, CliArguments *arguments, PetscBool *go_on,
                        int *exit_code);

/* In the options of a command that reads cases. */
#define CLI_LAW_OPTIONS                                                                                          \
  {"law", "NAME=FILE.so",                                                                                        \
   "a law of your own, by the name that the case calls it: docs/plugin.md; may be given often"},                 \
  {                                                                                                              \
    "umat", "NAME=FILE.so,NPROPS,NSTATV", "the same of a subroutine UMAT; its constants are prop_1, prop_2, ..." \
  }
/* Collective. Load what --law and --umat name; *ok is false after a complaint. */
PetscErrorCode CliLoadLaws(const CliArguments *arguments, PetscBool *ok, int *exit_code);

/* Value of the last --name, NULL if it was not given. */
const char *cli_value(const CliArguments *arguments, const char *name);
PetscBool cli_flag(const CliArguments *arguments, const char *name);
/* All values of --name in order (--set); at most CLI_MAX_ARGUMENTS. Returns how many. */
PetscInt cli_values(const CliArguments *arguments, const char *name, const char **values);

/* Print `error: ...` and a hint (or NULL) on rank 0 and set the exit code for bad usage. */
PetscErrorCode CliUsageError(int *exit_code, const char *hint, const char *format, ...) PETSC_ATTRIBUTE_FORMAT(3, 4);
/* Is the word of an option one of these? If not that is printed, with the nearest, and *ok is false; NULL is fine. */
PetscErrorCode CliOneOf(const char *option, const char *word, const char *const *words, PetscBool *ok, int *exit_code);
/* Collective. Were all ranks started with the same words? If not that has been printed, and the
 * exit code is set. */
PetscErrorCode CliSameCommand(int argc, char **argv, PetscBool *same, int *exit_code);
/* The words of a list of `talus list` ("fields"): word i, NULL behind the last. */
const char *cli_list_word(const char *list, int i);
/* On rank 0: what `talus --help` and `talus COMMAND --help` say. */
void cli_print_overview(FILE *out);
void cli_print_usage(FILE *out, const CliUsage *usage);
/* What is true of all commands: a heading (for the man page) and a paragraph; heading NULL ends. */
typedef struct {
  const char *heading, *text;
} CliNote;
extern const CliNote cli_notes[];
/* The number behind --jobs, 0 without it. */
PetscInt cli_jobs(const CliArguments *arguments);
/* Of a command whose runs are processes of their own: --jobs is a number, and nobody started it on
 * several ranks; otherwise that has been printed, and *ok is false. */
PetscErrorCode CliCheckJobs(const CliArguments *arguments, PetscBool *ok, int *exit_code);
/* Is this the rank that prints? */
PetscBool cli_prints(void);
