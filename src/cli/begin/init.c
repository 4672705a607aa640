/* talus init: a case to begin with. Nothing that is there is ever changed. */
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include "base/file.h"
#include "cli/begin/installed.h"
#include "cli/cli.h"
#include "first_case.h" /* first_case.yaml as a string, written by CMake */

static const CliOption options[] = {
  {"like", "INSTALLED", "a copy of this case of those that came with talus, with all its files"},
  {"list", NULL, "what these are; makes nothing"},
  {NULL, NULL, NULL},
};

const CliUsage cli_init_usage = {
  .usage = "talus init NAME [options]",
  .help =
    "Makes the folder NAME with a case.yaml that runs in some seconds, every line of it explained: sand that slumps.\n"
    "With --like a case that came with talus is copied instead. What is there already is left alone.",
  .examples = "talus init slump\ntalus init --list\ntalus init embankment --like slope",
  .options = options,
  .min_words = 0,
  .max_words = 1,
};

/* The title of a case file, without reading the rest of it. */
static void read_title(const char *file, char title[160])
{
  char line[400];
  FILE *in = fopen(file, "r");
  title[0] = '\0';
  while (in && !title[0] && fgets(line, sizeof line, in))
    if (sscanf(line, "title: %159[^\n#]", title) != 1) title[0] = '\0';
  if (in) fclose(in);
  for (size_t n = strlen(title); n && title[n - 1] == ' '; --n) title[n - 1] = '\0';
}

static PetscErrorCode List(int *exit_code)
{
  char folder[PETSC_MAX_PATH_LEN], file[PETSC_MAX_PATH_LEN + 160], name[128], title[160];

  PetscFunctionBeginUser;
  if (!installed_folder(folder)) {
    PetscCall(CliUsageError(exit_code, "TALUS_CASES may name their folder", "there are no cases in '%s'", folder));
    PetscFunctionReturn(0);
  }
  for (int i = 0; installed_case(i, name); ++i) {
    snprintf(file, sizeof file, "%s/%s/case.yaml", folder, name);
    read_title(file, title);
    printf("%-24s %s\n", name, title);
  }
  PetscFunctionReturn(0);
}

/* Bytes into a file that is not there yet; NULL or the reason why not. */
static const char *write_new(const char *path, const char *bytes, size_t length)
{
  FILE *out = fopen(path, "wbx");
  if (!out) return strerror(errno);
  const PetscBool good = fwrite(bytes, 1, length, out) == length;
  return fclose(out) || !good ? strerror(errno) : NULL;
}

/* All plain files of a folder into another; a case has no folders within. `file`: the one that
 * failed. */
static PetscErrorCode CopyFolder(const char *from, const char *to, char file[PETSC_MAX_PATH_LEN], const char **why)
{
  char target[PETSC_MAX_PATH_LEN], *bytes;
  struct dirent *entry;
  struct stat info;
  size_t length;
  DIR *folder;

  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(file, from, PETSC_MAX_PATH_LEN));
  folder = opendir(from);
  *why = folder ? NULL : strerror(errno);
  while (folder && !*why && (entry = readdir(folder))) {
    snprintf(file, PETSC_MAX_PATH_LEN, "%.3000s/%.255s", from, entry->d_name);
    snprintf(target, sizeof target, "%.3000s/%.255s", to, entry->d_name);
    if (stat(file, &info) || !S_ISREG(info.st_mode)) continue;
    PetscCall(FileLoad(file, &bytes, &length, why));
    if (!*why) *why = write_new(target, bytes, length);
    PetscCall(PetscFree(bytes));
  }
  if (folder) closedir(folder);
  PetscFunctionReturn(0);
}

/* What a shell would take apart stands in quotes. */
static const char *shell_quote(const char *path)
{
  static const char *const plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
  if (!path[strspn(path, plain)]) return "";
  return strchr(path, '\'') ? "\"" : "'";
}

static PetscErrorCode Fill(const char *name, const char *like, int *exit_code)
{
  char folder[PETSC_MAX_PATH_LEN], from[PETSC_MAX_PATH_LEN], file[PETSC_MAX_PATH_LEN], title[160];
  const char *why;

  PetscFunctionBeginUser;
  snprintf(file, sizeof file, "%.4000s/case.yaml", name);
  if (like) {
    (void)installed_folder(folder);
    snprintf(from, sizeof from, "%.3900s/%.100s", folder, like);
    PetscCall(CopyFolder(from, name, file, &why));
  } else why = write_new(file, first_case, sizeof(first_case) - 1);
  if (why) {
    PetscCall(CliUsageError(exit_code, NULL, "'%s' cannot be copied to '%s': %s", file, name, why));
    PetscFunctionReturn(0);
  }
  snprintf(file, sizeof file, "%.4000s/case.yaml", name);
  read_title(file, title);
  const char *last = strrchr(name, '/') ? strrchr(name, '/') + 1 : name, *quote = shell_quote(name);
  printf("%s: %s\n  talus check %s%s%s\n  talus run %s%s%s\n  talus plot %sruns/%s%s\n", file, title, quote, file,
         quote, quote, file, quote, quote, last, quote);
  PetscFunctionReturn(0);
}

/* Is there such a case? If not that has been said. */
static PetscErrorCode CheckLike(const char *like, PetscBool *ok, int *exit_code)
{
  const char *names[129] = {NULL}, *nearest;
  char name[128][128], hint[200] = "talus init --list says what there is", folder[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  *ok = PETSC_FALSE;
  for (int i = 0; !*ok && i < 128 && installed_case(i, name[i]); ++i) {
    names[i] = name[i];
    *ok = !strcmp(name[i], like);
  }
  if (*ok) PetscFunctionReturn(0);
  (void)installed_folder(folder);
  if ((nearest = diag_nearest(like, names))) snprintf(hint, sizeof hint, "did you mean '%s'?", nearest);
  PetscCall(CliUsageError(exit_code, hint, "there is no case '%s' in %s", like, folder));
  PetscFunctionReturn(0);
}

static PetscErrorCode Init(char *name, const char *like, int *exit_code)
{
  PetscBool ok = PETSC_TRUE;

  PetscFunctionBeginUser;
  for (size_t n = strlen(name); n > 1 && name[n - 1] == '/'; --n) name[n - 1] = '\0';
  if (like) PetscCall(CheckLike(like, &ok, exit_code));
  if (!ok) PetscFunctionReturn(0);
  if (!mkdir(name, 0777)) PetscCall(Fill(name, like, exit_code));
  else if (errno == EEXIST) PetscCall(CliUsageError(exit_code, "choose another name", "'%s' is there already", name));
  else PetscCall(CliUsageError(exit_code, NULL, "the folder '%s' cannot be made: %s", name, strerror(errno)));
  PetscFunctionReturn(0);
}

PetscErrorCode CliInit(int argc, char **argv, int *exit_code)
{
  CliArguments arguments;
  PetscBool go_on;

  PetscFunctionBeginUser;
  PetscCall(CliParse(&cli_init_usage, argc, argv, &arguments, &go_on, exit_code));
  if (!go_on) PetscFunctionReturn(0);
  const PetscBool list = cli_flag(&arguments, "list");
  if (list == (arguments.n_words > 0) || (list && cli_flag(&arguments, "like")))
    PetscCall(CliUsageError(exit_code, "talus init NAME, or talus init --list",
                            list ? "--list stands alone" : "there is no NAME on the command line"));
  else if (cli_prints() && list) PetscCall(List(exit_code));
  else if (cli_prints()) PetscCall(Init((char *)arguments.words[0], cli_value(&arguments, "like"), exit_code));
  fflush(stdout);
  PetscCallMPI(MPI_Bcast(exit_code, 1, MPI_INT, 0, PETSC_COMM_WORLD));
  PetscFunctionReturn(0);
}
