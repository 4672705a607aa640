/* Messages of other ranks travel to rank 0 as one block of bytes: a header of integers, then the
 * strings. */
#include "base/diag/diag_impl.h"
#include <stdlib.h>
#include <string.h>

typedef struct {
  DiagMessage message; /* its strings follow */
  int length[4];       /* of file, text, message, hint; -1: NULL */
} PackedHead;

static void pack(const DiagMessage *m, FILE *out)
{
  const char *const strings[4] = {m->file, m->text, m->message, m->hint};
  PackedHead head = {.message = *m};
  for (int k = 0; k < 4; ++k) head.length[k] = strings[k] ? (int)strlen(strings[k]) : -1;
  fwrite(&head, sizeof head, 1, out);
  for (int k = 0; k < 4; ++k)
    if (strings[k]) fputs(strings[k], out);
}

static PetscBool same_text(const char *a, const char *b) { return !strcmp(a ? a : "", b ? b : ""); }

static PetscBool reduce_known(const Diag *diag, const DiagMessage *m)
{
  for (PetscInt i = 0; i < diag->n; ++i) {
    const DiagMessage *k = &diag->messages[i];
    if (k->severity == m->severity && k->line == m->line && k->column == m->column && same_text(k->file, m->file) &&
        same_text(k->message, m->message))
      return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

static void unpack(Diag *diag, const char *p, const char *end)
{
  while (p < end) {
    PackedHead head;
    char *strings[4] = {NULL, NULL, NULL, NULL};
    memcpy(&head, p, sizeof(head));
    p += sizeof(head);
    for (int k = 0; k < 4; ++k) {
      if (head.length[k] < 0) continue;
      strings[k] = strndup(p, (size_t)head.length[k]);
      p += head.length[k];
    }
    DiagMessage m = head.message;
    m.file = strings[0], m.text = strings[1], m.message = strings[2], m.hint = strings[3];
    if (reduce_known(diag, &m)) diag_message_clear(&m);
    else diag_append(diag, &m);
  }
}

/* Twins that rank 0 itself recorded (the same mistake met twice). */
static void remove_twins(Diag *diag)
{
  const PetscInt n = diag->n;
  diag->n = diag->shown[0] = diag->shown[1] = 0;
  diag->errors = diag->more[1];
  diag->warnings = diag->more[0];
  for (PetscInt i = 0; i < n; ++i) {
    DiagMessage m = diag->messages[i];
    if (reduce_known(diag, &m)) diag_message_clear(&m);
    else diag_append(diag, &m);
  }
}

static PetscErrorCode Gather(MPI_Comm comm, PetscMPIInt rank, PetscMPIInt ranks, Diag *diag)
{
  int size, total = 0, *sizes, *offsets;
  char *mine = NULL, *all;
  size_t bytes = 0;
  FILE *out = open_memstream(&mine, &bytes);

  PetscFunctionBeginUser;
  PetscCheck(out, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for messages");
  /* rank 0 has its own already */
  for (PetscInt i = 0; rank && i < diag->n; ++i) pack(&diag->messages[i], out);
  PetscCheck(!fclose(out), PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for messages");
  size = (int)bytes;
  PetscCall(PetscCalloc2(ranks, &sizes, ranks, &offsets));
  PetscCallMPI(MPI_Gather(&size, 1, MPI_INT, sizes, 1, MPI_INT, 0, comm));
  for (PetscMPIInt r = 0; r < ranks; ++r) {
    offsets[r] = total;
    total += sizes[r];
  }
  PetscCall(PetscMalloc1(total, &all));
  PetscCallMPI(MPI_Gatherv(mine, size, MPI_CHAR, all, sizes, offsets, MPI_CHAR, 0, comm));
  if (rank == 0) unpack(diag, all, all + total);
  PetscCall(PetscFree(all));
  PetscCall(PetscFree2(sizes, offsets));
  free(mine);
  PetscFunctionReturn(0);
}

PetscErrorCode DiagReduce(MPI_Comm comm, Diag *diag, PetscInt *errors)
{
  PetscMPIInt rank, ranks;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &ranks));
  diag->printer = rank == 0;
  if (rank == 0) remove_twins(diag);
  if (ranks > 1) PetscCall(Gather(comm, rank, ranks, diag));
  if (rank > 0) {
    for (PetscInt i = 0; i < diag->n; ++i) diag_message_clear(&diag->messages[i]);
    /* the counts stay: what happened here is still known here */
    diag->n = diag->shown[0] = diag->shown[1] = 0;
  }
  *errors = diag->errors;
  PetscCallMPI(MPI_Bcast(errors, 1, MPIU_INT, 0, comm));
  PetscFunctionReturn(0);
}
