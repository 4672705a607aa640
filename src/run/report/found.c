/* A run directory that is there: is it of this case, and what came out of it?
 *
 * A case is known in full (every key with its value), and so is that of a run, which keeps it as
 * case.yaml. Where both say the same, whatever was typed to get there, the run is a run of that
 * case. Keys that came later have their defaults in an older run; if that names no basis, it had that of
 * the cell. */
#include "run/report/found.h"
#include <stdlib.h>
#include <string.h>
#include "input/case_file.h"
#include "output/directory/run_dir_files.h"
#include "output/inputs.h"

/* Top-level keys on which no result depends, but for round-off. */
static PetscBool is_idle(const char *line)
{
  static const char *const keys[] = {"title:", "output:", "checkpoint:", "linear:", "petsc:", NULL};
  for (int k = 0; keys[k]; ++k)
    if (!strncmp(line, keys[k], strlen(keys[k]))) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Take these keys, with the lines that belong to them, out of a resolved case. */
static void drop_idle(char *text)
{
  char *to = text;
  PetscBool idle = PETSC_FALSE;
  for (const char *line = text; *line;) {
    const size_t n = strcspn(line, "\n"), length = line[n] ? n + 1 : n;
    if (line[0] != ' ' && line[0] != '-') idle = is_idle(line);
    if (!idle) memmove(to, line, length), to += length;
    line += length;
  }
  *to = '\0';
}

PetscErrorCode FoundCase(MPI_Comm comm, const char *folder, char **text, char reason[256])
{
  static const char *const cell = "basis={cell: {}}";
  char file[PETSC_MAX_PATH_LEN];
  size_t size;
  Diag *ignored;
  Case *c = NULL;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(file, sizeof file, "%s/case.yaml", folder));
  PetscCall(FileReadEverywhere(comm, file, &size, text, reason));
  if (reason[0]) PetscFunctionReturn(0);
  (*text)[size] = '\0';
  const PetscBool named = strstr(*text, "\nbasis:") != NULL;
  PetscCall(PetscFree(*text));
  PetscCall(DiagCreate(&ignored));
  PetscCall(CaseRead(comm, file, named ? 0 : 1, &cell, ignored, &c));
  if (c) {
    PetscCall(CaseToYaml(c, text));
    drop_idle(*text);
  } else PetscCall(PetscStrncpy(reason, "is no case", 256));
  PetscCall(CaseDestroy(&c));
  PetscCall(DiagDestroy(&ignored));
  PetscFunctionReturn(0);
}

PetscErrorCode FoundIsCase(const Case *c, const char *text, PetscBool *is)
{
  char *own;

  PetscFunctionBeginUser;
  PetscCall(CaseToYaml(c, &own));
  drop_idle(own);
  *is = !strcmp(own, text);
  PetscCall(PetscFree(own));
  PetscFunctionReturn(0);
}

PetscErrorCode FoundChanged(MPI_Comm comm, const char *folder, const Case *resumed, char file[PETSC_MAX_PATH_LEN])
{
  Inputs inputs = {0};
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  file[0] = '\0';
  if (!rank) PetscCall(InputsRead(folder, &inputs));
  if (resumed) inputs_move(&inputs, resumed);
  for (PetscInt k = 0; k < inputs.n && !file[0]; ++k)
    if ((!resumed || !input_is_run(&inputs.input[k])) && input_changed(&inputs.input[k]))
      PetscCall(PetscStrncpy(file, inputs.input[k].path, PETSC_MAX_PATH_LEN));
  PetscCall(InputsClear(&inputs));
  PetscCallMPI(MPI_Bcast(file, PETSC_MAX_PATH_LEN, MPI_CHAR, 0, comm));
  PetscFunctionReturn(0);
}

void found_word(const char *folder, const char *name, const char *key, char word[64])
{
  char path[PETSC_MAX_PATH_LEN], line[256];
  const size_t n = strlen(key);
  word[0] = '\0';
  PetscSNPrintf(path, sizeof path, "%s/%s", folder, name);
  FILE *in = file_open_read(path);
  while (in && !word[0] && fgets(line, sizeof line, in)) {
    if (strncmp(line, key, n) || strncmp(line + n, " = ", 3)) continue;
    line[strcspn(line, "\n")] = '\0';
    PetscStrncpy(word, line + n + 3, 64);
  }
  if (in) fclose(in);
}

void found_last_step(const char *folder, const char *measure, PetscReal *value)
{
  char key[256], word[64];
  PetscSNPrintf(key, sizeof key, "%s in the last step", measure);
  found_word(folder, "timings.txt", key, word);
  if (word[0]) *value = (PetscReal)strtod(word, NULL);
}
