/* talus completion: what makes a shell complete. */
#include <string.h>
#include "cli/describe/describe.h"

const CliUsage cli_completion_usage = {
  .usage = "talus completion bash|zsh|fish",
  .help =
    "Prints what makes a shell complete commands, options and their values, case files and run folders.\n"
    "`make install` and the Debian package put it where the shells look by themselves.",
  .examples =
    "source <(talus completion bash)   # for this shell, in bash; or in ~/.bashrc\n"
    "talus completion zsh > ~/.zfunc/_talus   # a folder of fpath\n"
    "talus completion fish > ~/.config/fish/completions/talus.fish",
  .min_words = 1,
  .max_words = 1,
};

static const struct {
  const char *name;
  void (*describe)(FILE *out);
} shells[] = {{"bash", describe_bash}, {"zsh", describe_zsh}, {"fish", describe_fish}, {NULL, NULL}};

PetscErrorCode CliCompletion(int argc, char **argv, int *exit_code)
{
  CliArguments arguments;
  PetscBool go_on;
  int shell = 0;

  PetscFunctionBeginUser;
  PetscCall(CliParse(&cli_completion_usage, argc, argv, &arguments, &go_on, exit_code));
  if (!go_on) PetscFunctionReturn(0);
  while (shells[shell].name && strcmp(shells[shell].name, arguments.words[0])) ++shell;
  if (!shells[shell].name)
    PetscCall(CliUsageError(exit_code, "bash, zsh or fish", "'%s' is no shell that is known", arguments.words[0]));
  else if (cli_prints()) shells[shell].describe(stdout);
  fflush(stdout);
  PetscFunctionReturn(0);
}
