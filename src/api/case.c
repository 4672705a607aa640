/* Cases: from a file to a handle, and what they ask for. */
#include <string.h>
#include "api/api.h"

static PetscErrorCode Close(TalusCase **c)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree((*c)->factors));
  PetscCall(CaseDestroy(&(*c)->c));
  PetscCall(DiagDestroy(&(*c)->diag));
  PetscCall(PetscCommDestroy(&(*c)->comm));
  PetscCall(PetscFree(*c));
  PetscFunctionReturn(0);
}

/* text NULL: that of the file. */
static PetscErrorCode Open(MPI_Comm comm, const char *file, const char *text, PetscInt n_set, const char *const *set,
                           TalusCase **c, char **messages)
{
  TalusCase *opened;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&opened));
  PetscCall(DiagCreate(&opened->diag));
  PetscCall(PetscCommDuplicate(comm, &opened->comm, NULL));
  if (text) PetscCall(CaseReadText(file, strlen(text), text, n_set, set, opened->diag, &opened->c));
  else PetscCall(CaseRead(opened->comm, file, n_set, set, opened->diag, &opened->c));
  PetscCall(TalusTell(opened->comm, opened->diag, messages));
  if (opened->c) PetscCall(PetscCalloc1(opened->c->n_loads, &opened->factors));
  if (opened->c) *c = opened;
  else PetscCall(Close(&opened));
  PetscFunctionReturn(0);
}

static int open_checked(MPI_Comm comm, const char *file, const char *text, int n_set, const char *const *set,
                        TalusCase **c, char **messages)
{
  if (messages) *messages = NULL;
  if (!c) return TALUS_ERROR_ARGUMENT;
  *c = NULL;
  if (!talus_is_running()) return TALUS_ERROR_STATE;
  if (comm == MPI_COMM_NULL || !file || n_set < 0 || (n_set > 0 && !set)) return TALUS_ERROR_ARGUMENT;
  for (int i = 0; i < n_set; ++i)
    if (!set[i]) return TALUS_ERROR_ARGUMENT;
  const int error = TALUS_CALL(Open(comm, file, text, n_set, set, c, messages));
  if (error) return error;
  return *c ? TALUS_OK : TALUS_ERROR_INPUT;
}

int TalusCaseOpen(MPI_Comm comm, const char *file, int n_set, const char *const *set, TalusCase **c, char **messages)
{
  return open_checked(comm, file, NULL, n_set, set, c, messages);
}

int TalusCaseParse(MPI_Comm comm, const char *file, const char *text, int n_set, const char *const *set, TalusCase **c,
                   char **messages)
{
  return open_checked(comm, text ? file : NULL, text, n_set, set, c, messages);
}

int TalusCaseClose(TalusCase **c)
{
  if (!c || !*c) return TALUS_OK;
  if (!talus_is_running()) return TALUS_ERROR_STATE;
  return (*c)->busy ? TALUS_ERROR_BUSY : TALUS_CALL(Close(c));
}

int TalusCaseTrust(TalusCase *c)
{
  if (!c) return TALUS_ERROR_ARGUMENT;
  c->c->grid.trusted = PETSC_TRUE;
  return TALUS_OK;
}

static PetscErrorCode Text(const Case *c, char **text)
{
  char *yaml;

  PetscFunctionBeginUser;
  PetscCall(CaseToYaml(c, &yaml));
  *text = strdup(yaml); /* the C library's memory, as TalusTextFree takes it */
  PetscCall(PetscFree(yaml));
  PetscCheck(*text, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for a case in words");
  PetscFunctionReturn(0);
}

int TalusCaseText(const TalusCase *c, char **text)
{
  if (!c || !text) return TALUS_ERROR_ARGUMENT;
  return talus_is_running() ? TALUS_CALL(Text(c->c, text)) : TALUS_ERROR_STATE;
}

int TalusCaseSetBodyForces(TalusCase *c, TalusBodyForces force, void *context)
{
  if (!c) return TALUS_ERROR_ARGUMENT;
  c->force = (TalusForce){force, context};
  return TALUS_OK;
}

PetscInt talus_load_index(const Case *c, const char *load)
{
  char path[64];
  for (PetscInt k = 0; k < c->n_loads; ++k)
    if (!strcmp(case_load_path(c, k, path) + strlen("loads."), load)) return k;
  return -1;
}

int TalusCaseSetLoadFactors(TalusCase *c, const char *load, TalusLoadFactors factors, void *context)
{
  if (!c || !load) return TALUS_ERROR_ARGUMENT;
  const PetscInt k = talus_load_index(c->c, load);
  if (k < 0) return TALUS_ERROR_UNKNOWN;
  c->factors[k] = (TalusFactors){factors, context};
  return TALUS_OK;
}

int TalusCaseSetProgress(TalusCase *c, TalusProgress progress, void *context)
{
  if (!c) return TALUS_ERROR_ARGUMENT;
  c->progress = progress;
  c->progress_context = context;
  return TALUS_OK;
}

int TalusCaseCountMeasures(const TalusCase *c, int *n)
{
  if (!c || !n) return TALUS_ERROR_ARGUMENT;
  *n = (int)case_columns(c->c);
  return TALUS_OK;
}

int TalusCaseMeasureName(const TalusCase *c, int i, const char **name, const char **unit)
{
  if (!c || i < 0 || i >= case_columns(c->c)) return TALUS_ERROR_ARGUMENT;
  if (name) *name = case_column(c->c, i)->name;
  if (unit) *unit = measure_unit(case_column(c->c, i));
  return TALUS_OK;
}

PetscInt talus_measure_index(const Case *c, const char *name)
{
  for (PetscInt i = 0; i < c->n_measures; ++i)
    if (!strcmp(c->measures[i].name, name)) return i;
  return -1;
}
