#include <stdio.h>
#include "cli/cli.h"
#include "input/case_file.h"

static const CliOption options[] = {
  {"json", NULL, "as JSON Schema (draft 2020-12), for the completion of editors"},
  {"markdown", NULL, "as Markdown (docs/case-file.md)"},
  {NULL, NULL, NULL},
};

const CliUsage cli_schema_usage = {
  .usage = "talus schema [--json | --markdown]",
  .help =
    "Prints the reference of the case file: every key with its type, unit, default, range and meaning.\n"
    "For completion in an editor: talus schema --json > talus.schema.json, and in the case file the first line\n"
    "# yaml-language-server: $schema=talus.schema.json",
  .examples = "talus schema | less\ntalus schema --json > talus.schema.json",
  .options = options,
};

PetscErrorCode CliSchema(int argc, char **argv, int *exit_code)
{
  CliArguments arguments;
  PetscBool go_on;

  PetscFunctionBeginUser;
  PetscCall(CliParse(&cli_schema_usage, argc, argv, &arguments, &go_on, exit_code));
  if (!go_on) PetscFunctionReturn(0);
  const PetscBool json = cli_flag(&arguments, "json"), markdown = cli_flag(&arguments, "markdown");
  if (json && markdown) PetscCall(CliUsageError(exit_code, NULL, "choose one of --json and --markdown"));
  else if (cli_prints()) PetscCall(SchemaPrint(stdout, json ? SCHEMA_JSON : markdown ? SCHEMA_MARKDOWN : SCHEMA_TEXT));
  PetscFunctionReturn(0);
}
