/* Start and end, errors in words, texts. */
#include <limits.h>
#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include "api/api.h"
#include "base/process/start.h"
#include "base/process/blas.h"
#include "case/fields.h"
#include "talus_version.h"

const char *TalusVersion(void) { return TALUS_VERSION; }

const char *talus_error_string(int error)
{
  switch (error) {
  case TALUS_OK: return "done";
  case TALUS_ERROR_ARGUMENT: return "an argument is NULL, out of range, or too small to hold the result";
  case TALUS_ERROR_STATE: return "TalusInitialize is missing, or was called twice or after TalusFinalize";
  case TALUS_ERROR_INPUT: return "the case has mistakes, or the run directory cannot be used";
  case TALUS_ERROR_UNKNOWN: return "there is no measure or field of this name";
  case TALUS_ERROR_OUTPUT: return "a result could not be written";
  case TALUS_ERROR_MEMORY: return "no memory";
  case TALUS_ERROR_INTERNAL: return "a fault of talus or of a library";
  case TALUS_ERROR_BUSY: return "a model or a run is at work: a function that it asks cannot step, change or close it";
  default: return "no error code of talus";
  }
}

static int code_of(PetscErrorCode code)
{
  switch (code) {
  case 0: return TALUS_OK;
  case 1: /* so PETSc 3.18 says that it has no memory for an object */
  case PETSC_ERR_MEM: return TALUS_ERROR_MEMORY;
  case PETSC_ERR_FILE_OPEN:
  case PETSC_ERR_FILE_WRITE: return TALUS_ERROR_OUTPUT;
  default: return TALUS_ERROR_INTERNAL;
  }
}

/* The caller's while a call is at work: a function that it asks may call again. */
static _Thread_local locale_t callers;
static _Thread_local int depth;

void talus_enter(void)
{
  if (!depth++) callers = uselocale(newlocale(LC_ALL_MASK, "C", (locale_t)0));
}

int talus_leave(PetscErrorCode code)
{
  if (!--depth) uselocale(callers);
  return code_of(code);
}

PetscBool talus_is_running(void)
{
  PetscBool started = PETSC_FALSE, ended = PETSC_FALSE;
  if (PetscInitialized(&started) || PetscFinalized(&ended)) return PETSC_FALSE;
  return started && !ended;
}

int TalusInitialize(int *argc, char ***argv)
{
  PetscBool started, ended;
  if (PetscInitialized(&started) || PetscFinalized(&ended) || started || ended) return TALUS_ERROR_STATE;
  threads_one_per_rank();
  return TALUS_CALL(StartPetsc(argc, argv));
}

int TalusFinalize(void)
{
  if (!talus_is_running()) return TALUS_ERROR_STATE;
  return TALUS_CALL(PetscFinalize());
}

int TalusRanks(MPI_Comm comm, int *rank, int *size)
{
  PetscMPIInt r, s;
  if (!talus_is_running()) return TALUS_ERROR_STATE;
  if (comm == MPI_COMM_NULL) return TALUS_ERROR_ARGUMENT;
  if (MPI_Comm_rank(comm, &r) || MPI_Comm_size(comm, &s)) return TALUS_ERROR_INTERNAL;
  if (rank) *rank = r;
  if (size) *size = s;
  return TALUS_OK;
}

void TalusTextFree(char **text)
{
  if (!text) return;
  free(*text);
  *text = NULL;
}

/* The first rank's text for all ranks; NULL if it is empty. `text` is the C library's memory. */
static PetscErrorCode ShareText(MPI_Comm comm, char **text, size_t length)
{
  unsigned long long n = length;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(&n, 1, MPI_UNSIGNED_LONG_LONG, 0, comm));
  PetscCheck(n < INT_MAX, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "messages too long to be sent");
  if (n != length || !n) TalusTextFree(text);
  if (!n) PetscFunctionReturn(0);
  if (!*text) *text = calloc(n + 1, 1);
  PetscCheck(*text, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for messages");
  PetscCallMPI(MPI_Bcast(*text, (PetscMPIInt)n, MPI_CHAR, 0, comm));
  PetscFunctionReturn(0);
}

PetscErrorCode TalusTell(MPI_Comm comm, Diag *diag, char **messages)
{
  PetscInt errors;
  size_t length = 0;

  PetscFunctionBeginUser;
  PetscCall(DiagReduce(comm, diag, &errors));
  if (!messages) {
    PetscCall(DiagFlush(diag, stderr));
    PetscFunctionReturn(0);
  }
  *messages = NULL;
  FILE *out = open_memstream(messages, &length);
  PetscCheck(out, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for messages");
  PetscCall(DiagFlush(diag, out));
  fclose(out);
  PetscCall(ShareText(comm, messages, length));
  PetscFunctionReturn(0);
}

int TalusField(int i, const char **name, const char **unit, int *components)
{
  PetscInt k = 0;
  while (k < i && output_fields[k].name) ++k;
  if (i < 0 || !output_fields[k].name) return TALUS_ERROR_ARGUMENT;
  if (name) *name = output_fields[k].name;
  if (unit) *unit = output_fields[k].unit;
  if (components) *components = output_fields[k].points ? (int)output_fields[k].components : 0;
  return TALUS_OK;
}
