#include "solve/system/forms/shared_rows.h"

/* Ghost rows stand behind the owned ones: row n + g. Which node is theirs, as a global number? */
static PetscErrorCode GhostNumbers(const System *s, PetscInt **number)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->n_rows - s->n_active, number));
  for (PetscInt i = 0; i < s->n_nodes; ++i)
    if (s->row[i] >= s->n_active) (*number)[s->row[i] - s->n_active] = s->number[i];
  PetscFunctionReturn(0);
}

/* Which incoming pairs belong to each owned row (in_start), and where this rank's ghost rows begin
 * at their owner. */
static PetscErrorCode Offsets(const System *s, PetscSF rows, PetscInt **in_start, PetscInt *remote)
{
  const PetscInt n = s->n_active, ghosts = s->n_rows - n, *degree;
  PetscInt *count, *arriving, *start, copies = 0, total = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscSFComputeDegreeBegin(rows, &degree));
  PetscCall(PetscSFComputeDegreeEnd(rows, &degree));
  for (PetscInt r = 0; r < n; ++r) copies += degree[r];
  PetscCall(PetscMalloc2(ghosts, &count, copies, &arriving));
  PetscCall(PetscMalloc1(n + 1, &start));
  for (PetscInt g = 0; g < ghosts; ++g) count[g] = s->row_start[n + g + 1] - s->row_start[n + g];
  PetscCall(PetscSFGatherBegin(rows, MPIU_INT, count, arriving));
  PetscCall(PetscSFGatherEnd(rows, MPIU_INT, count, arriving));
  for (PetscInt r = 0, k = 0; r < n; ++r) {
    start[r] = total;
    for (PetscInt c = 0; c < degree[r]; ++c, ++k) {
      const PetscInt pairs = arriving[k];
      arriving[k] = total;
      total += pairs;
    }
  }
  start[n] = total;
  PetscCall(PetscSFScatterBegin(rows, MPIU_INT, arriving, remote));
  PetscCall(PetscSFScatterEnd(rows, MPIU_INT, arriving, remote));
  PetscCall(PetscFree2(count, arriving));
  *in_start = start;
  PetscFunctionReturn(0);
}

static PetscErrorCode PairForest(const System *s, const PetscInt *owner, const PetscInt *remote, PetscInt n_incoming,
                                 PetscSF *sf)
{
  const PetscInt n = s->n_active, first = s->row_start[n], pairs = s->row_start[s->n_rows] - first;
  PetscSFNode *root;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(pairs, &root));
  for (PetscInt g = 0; g < s->n_rows - n; ++g)
    for (PetscInt k = s->row_start[n + g], j = 0; k < s->row_start[n + g + 1]; ++k, ++j)
      root[k - first] = (PetscSFNode){.rank = owner[g], .index = remote[g] + j};
  PetscCall(PetscSFCreate(s->comm, sf));
  PetscCall(PetscSFSetGraph(*sf, n_incoming, pairs, NULL, PETSC_OWN_POINTER, root, PETSC_OWN_POINTER));
  PetscFunctionReturn(0);
}

/* Global numbers of the incoming pairs' columns. */
static PetscErrorCode IncomingNumbers(const System *s, PetscSF pairs, PetscInt n_incoming, PetscInt **number)
{
  const PetscInt first = s->row_start[s->n_active], n = s->row_start[s->n_rows] - first;
  PetscInt *mine;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &mine));
  PetscCall(PetscMalloc1(n_incoming, number));
  for (PetscInt k = 0; k < n; ++k) mine[k] = s->number[s->column[first + k]];
  PetscCall(PetscSFReduceBegin(pairs, MPIU_INT, mine, *number, MPI_REPLACE));
  PetscCall(PetscSFReduceEnd(pairs, MPIU_INT, mine, *number, MPI_REPLACE));
  PetscCall(PetscFree(mine));
  PetscFunctionReturn(0);
}

/* Owners of the ghost rows, and where these begin among what arrives there. */
static PetscErrorCode Owners(const System *s, const PetscInt *ghost, PetscInt *owner, PetscInt *remote, SharedRows *h)
{
  const PetscInt n = s->n_active, ghosts = s->n_rows - n;
  PetscLayout layout;
  PetscMPIInt rank;
  PetscSF rows;

  PetscFunctionBeginUser;
  PetscCall(PetscLayoutCreateFromSizes(s->comm, n, PETSC_DETERMINE, 1, &layout));
  PetscCall(PetscSFCreate(s->comm, &rows));
  PetscCall(PetscSFSetRankOrder(rows, PETSC_TRUE)); /* the same sums in every run */
  PetscCall(PetscSFSetGraphLayout(rows, layout, ghosts, NULL, PETSC_COPY_VALUES, ghost));
  for (PetscInt g = 0; g < ghosts; ++g) {
    PetscCall(PetscLayoutFindOwner(layout, ghost[g], &rank));
    owner[g] = rank;
  }
  PetscCall(Offsets(s, rows, &h->start, remote));
  h->n_incoming = h->start[n];
  PetscCall(PetscSFDestroy(&rows));
  PetscCall(PetscLayoutDestroy(&layout));
  PetscFunctionReturn(0);
}

PetscErrorCode SharedRowsCreate(const System *s, SharedRows *h, PetscInt **ghost)
{
  const PetscInt ghosts = s->n_rows - s->n_active;
  PetscInt *number, *owner, *remote;

  PetscFunctionBeginUser;
  PetscCall(GhostNumbers(s, &number));
  PetscCall(PetscMalloc2(ghosts, &owner, ghosts, &remote));
  PetscCall(Owners(s, number, owner, remote, h));
  PetscCall(PairForest(s, owner, remote, h->n_incoming, &h->pairs));
  PetscCall(IncomingNumbers(s, h->pairs, h->n_incoming, &h->number));
  PetscCall(PetscFree2(owner, remote));
  if (ghost) *ghost = number;
  else PetscCall(PetscFree(number));
  PetscFunctionReturn(0);
}

PetscErrorCode SharedRowsDestroy(SharedRows *h)
{
  PetscFunctionBeginUser;
  PetscCall(PetscSFDestroy(&h->pairs));
  PetscCall(PetscFree(h->start));
  PetscCall(PetscFree(h->number));
  PetscFunctionReturn(0);
}

PetscErrorCode GhostRows(const System *s, PetscSF *rows)
{
  PetscMPIInt ranks;
  PetscLayout layout;
  PetscInt *number;

  PetscFunctionBeginUser;
  *rows = NULL;
  PetscCallMPI(MPI_Comm_size(s->comm, &ranks));
  if (ranks == 1) PetscFunctionReturn(0);
  PetscCall(GhostNumbers(s, &number));
  PetscCall(PetscLayoutCreateFromSizes(s->comm, s->n_active, PETSC_DETERMINE, 1, &layout));
  PetscCall(PetscSFCreate(s->comm, rows));
  PetscCall(PetscSFSetRankOrder(*rows, PETSC_TRUE)); /* the same sums in every run */
  PetscCall(PetscSFSetGraphLayout(*rows, layout, s->n_rows - s->n_active, NULL, PETSC_COPY_VALUES, number));
  PetscCall(PetscLayoutDestroy(&layout));
  PetscCall(PetscFree(number));
  PetscFunctionReturn(0);
}
