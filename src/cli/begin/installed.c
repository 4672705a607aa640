#include "cli/begin/installed.h"
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static PetscBool is_folder(const char *path)
{
  struct stat info;
  return !stat(path, &info) && S_ISDIR(info.st_mode);
}

PetscBool installed_folder(char folder[PETSC_MAX_PATH_LEN])
{
  static const char *const places[] = {"../share/talus/cases", "../cases", NULL}; /* installed; in a source tree */
  const char *asked = getenv("TALUS_CASES");
  char program[PETSC_MAX_PATH_LEN];

  if (asked) {
    snprintf(folder, PETSC_MAX_PATH_LEN, "%s", asked);
    return is_folder(folder);
  }
  const ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
  program[PetscMax(length, 0)] = '\0';
  char *slash = strrchr(program, '/');
  if (slash) *slash = '\0';
  for (int i = 0; places[i]; ++i) {
    snprintf(folder, PETSC_MAX_PATH_LEN, "%.4000s/%s", program, places[i]);
    if (is_folder(folder)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

static int is_case(const struct dirent *entry)
{
  char folder[PETSC_MAX_PATH_LEN], path[PETSC_MAX_PATH_LEN + 300];
  if (entry->d_name[0] == '.' || strlen(entry->d_name) >= 128) return 0;
  (void)installed_folder(folder);
  snprintf(path, sizeof path, "%s/%s/case.yaml", folder, entry->d_name);
  return access(path, R_OK) == 0;
}

PetscBool installed_case(int i, char name[128])
{
  char folder[PETSC_MAX_PATH_LEN];
  struct dirent **entries;

  name[0] = '\0';
  const int n = installed_folder(folder) ? scandir(folder, &entries, is_case, alphasort) : -1;
  for (int k = 0; k < n; ++k) {
    if (k == i) snprintf(name, 128, "%.127s", entries[k]->d_name);
    free(entries[k]);
  }
  if (n >= 0) free(entries);
  return name[0] != '\0';
}
