#include "import/import.h"
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include "base/text.h"
#include "import/kratos/project.h"

static PetscErrorCode WriteText(const char *folder, const char *name, const char *text)
{
  char path[PETSC_MAX_PATH_LEN];
  FILE *out;

  PetscFunctionBeginUser;
  snprintf(path, sizeof path, "%.4000s/%s", folder, name);
  PetscCheck((out = fopen(path, "w")), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s cannot be written: %s", path,
             strerror(errno));
  fputs(text, out);
  const PetscBool bad = ferror(out) != 0;
  PetscCheck(!fclose(out) && !bad, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "%s cannot be written", path);
  PetscFunctionReturn(0);
}

/* All files into a folder that was just made. `texts`: case, measures, reference. */
static PetscErrorCode WriteFolder(const KratosProject *p, const char *folder, char *const texts[3], PetscInt n_compared)
{
  char path[PETSC_MAX_PATH_LEN];
  TextStream stream;
  char *both;

  PetscFunctionBeginUser;
  PetscCall(TextOpen(&stream));
  fputs(texts[0], stream.out);
  if (n_compared) fprintf(stream.out, "measures:\n%s", texts[1]);
  PetscCall(TextClose(&stream, &both));
  PetscCall(WriteText(folder, "case.yaml", both));
  PetscCall(PetscFree(both));
  if (n_compared) PetscCall(WriteText(folder, "reference.yaml", texts[2]));
  snprintf(path, sizeof path, "%.4000s/grid.msh", folder);
  PetscCall(KratosWriteGrid(p, path));
  snprintf(path, sizeof path, "%.4000s/body.msh", folder);
  PetscCall(KratosWriteBody(p, path));
  PetscFunctionReturn(0);
}

/* Everything in memory first: a project that cannot be imported leaves no folder behind. */
static PetscErrorCode Write(const KratosProject *p, const char *out, char folder[PETSC_MAX_PATH_LEN])
{
  TextStream streams[3];
  char *texts[3];
  PetscInt n_compared = 0;

  PetscFunctionBeginUser;
  for (int i = 0; i < 3; ++i) PetscCall(TextOpen(&streams[i]));
  PetscCall(KratosWriteCase(p, streams[0].out));
  PetscCall(KratosWriteReference(p, streams[1].out, streams[2].out, &n_compared));
  for (int i = 0; i < 3; ++i) PetscCall(TextClose(&streams[i], &texts[i]));
  if (diag_errors(p->diag)) folder[0] = '\0';
  else if (snprintf(folder, PETSC_MAX_PATH_LEN, "%.4000s", out ? out : p->name), mkdir(folder, 0777)) {
    diag_error(p->diag, NULL, "the folder '%s' cannot be made: %s", folder, strerror(errno));
    folder[0] = '\0';
  } else PetscCall(WriteFolder(p, folder, texts, n_compared));
  for (int i = 0; i < 3; ++i) PetscCall(PetscFree(texts[i]));
  PetscFunctionReturn(0);
}

PetscErrorCode ImportKratos(const char *path, const char *out, Diag *diag, char folder[PETSC_MAX_PATH_LEN])
{
  KratosProject project;

  PetscFunctionBeginUser;
  folder[0] = '\0';
  PetscCall(KratosRead(path, diag, &project));
  if (!diag_errors(diag)) PetscCall(Write(&project, out, folder));
  PetscCall(KratosClear(&project));
  PetscFunctionReturn(0);
}
