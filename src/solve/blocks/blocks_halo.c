/* Rows that several ranks assemble, and columns that other ranks own. */
#include "solve/blocks/blocks.h"
#include "solve/system/forms/shared_rows.h"

/* Global numbers -> columns: owned rows, then ghost rows, then nodes that no cell of this rank
 * holds. The numbers of all columns of others are returned in their order. */
static PetscErrorCode LocalColumns(const System *s, PetscInt first, const PetscInt *ghost, PetscInt n_incoming,
                                   PetscInt *column, PetscInt *n_outer, PetscInt **outer)
{
  const PetscInt n = s->n_active, ghosts = s->n_rows - n;
  PetscInt *sorted, *place, *extra, n_extra = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(ghosts, &sorted, ghosts, &place, n_incoming, &extra));
  for (PetscInt g = 0; g < ghosts; ++g) sorted[g] = ghost[g], place[g] = n + g;
  PetscCall(PetscSortIntWithArray(ghosts, sorted, place));
  for (PetscInt k = 0, at; k < n_incoming; ++k) {
    const PetscInt number = column[k];
    if (number >= first && number < first + n) {
      column[k] = number - first;
      continue;
    }
    PetscCall(PetscFindInt(number, ghosts, sorted, &at));
    column[k] = at >= 0 ? place[at] : -1 - number;
    if (at < 0) extra[n_extra++] = number;
  }
  PetscCall(PetscSortRemoveDupsInt(&n_extra, extra));
  for (PetscInt k = 0, at; k < n_incoming; ++k) {
    if (column[k] >= 0) continue;
    PetscCall(PetscFindInt(-1 - column[k], n_extra, extra, &at));
    column[k] = s->n_rows + at;
  }
  *n_outer = ghosts + n_extra;
  PetscCall(PetscMalloc1(*n_outer, outer));
  PetscCall(PetscArraycpy(*outer, ghost, ghosts));
  if (n_extra) PetscCall(PetscArraycpy(*outer + ghosts, extra, n_extra));
  PetscCall(PetscFree3(sorted, place, extra));
  PetscFunctionReturn(0);
}

/* Union of own and incoming columns of each shared row, and the place of every block in it. */
static PetscErrorCode MergeRows(const System *s, const PetscInt *in_start, const PetscInt *in_column, BlocksHalo *h)
{
  PetscInt own = 0, size = 0;

  PetscFunctionBeginUser;
  for (PetscInt r = 0; r < s->n_active; ++r) {
    if (in_start[r + 1] == in_start[r]) continue;
    own += s->row_start[r + 1] - s->row_start[r];
    ++h->n_shared;
  }
  PetscCall(PetscMalloc4(h->n_shared, &h->shared_row, h->n_shared + 1, &h->start, h->n_shared + 1, &h->own_start,
                         own + h->n_incoming, &h->column));
  PetscCall(PetscMalloc2(own, &h->own, h->n_incoming, &h->come));
  own = 0;
  for (PetscInt r = 0, row = 0; r < s->n_active; ++r) {
    const PetscInt pairs = s->row_start[r + 1] - s->row_start[r], come = in_start[r + 1] - in_start[r];
    PetscInt *column = h->column + size, m = pairs + come;
    if (!come) continue;
    h->shared_row[row] = r;
    h->start[row] = size;
    h->own_start[row++] = own;
    for (PetscInt k = 0; k < pairs; ++k) column[k] = s->row[s->column[s->row_start[r] + k]];
    PetscCall(PetscArraycpy(column + pairs, in_column + in_start[r], come));
    PetscCall(PetscSortRemoveDupsInt(&m, column));
    for (PetscInt k = 0, at; k < pairs; ++k) {
      PetscCall(PetscFindInt(s->row[s->column[s->row_start[r] + k]], m, column, &at));
      h->own[own++] = size + at;
    }
    for (PetscInt k = in_start[r], at; k < in_start[r + 1]; ++k) {
      PetscCall(PetscFindInt(in_column[k], m, column, &at));
      h->come[k] = size + at;
    }
    size += m;
  }
  h->start[h->n_shared] = size;
  h->own_start[h->n_shared] = own;
  PetscCall(PetscMalloc2(size * s->dim * s->dim, &h->values, h->n_incoming * s->dim * s->dim, &h->incoming));
  PetscFunctionReturn(0);
}

static PetscErrorCode DataTypes(PetscInt dim, BlocksHalo *h)
{
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Type_contiguous((PetscMPIInt)block_stride((int)dim), MPI_FLOAT, &h->vector));
  PetscCallMPI(MPI_Type_contiguous((PetscMPIInt)(dim * dim), MPI_FLOAT, &h->block));
  PetscCallMPI(MPI_Type_contiguous((PetscMPIInt)(dim * dim), MPI_FLOAT, &h->scale));
  PetscCallMPI(MPI_Type_commit(&h->vector));
  PetscCallMPI(MPI_Type_commit(&h->block));
  PetscCallMPI(MPI_Type_commit(&h->scale));
  PetscFunctionReturn(0);
}

PetscErrorCode BlocksHaloCreate(const System *s, PetscInt *n_columns, BlocksHalo **halo)
{
  const PetscInt n = s->n_active;
  PetscInt first, n_outer = 0, *ghost, *outer;
  PetscLayout layout;
  SharedRows shared;
  BlocksHalo *h;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&h));
  PetscCall(DataTypes(s->dim, h));
  PetscCall(PetscLayoutCreateFromSizes(s->comm, n, PETSC_DETERMINE, 1, &layout));
  PetscCall(PetscLayoutGetRange(layout, &first, NULL));
  PetscCall(SharedRowsCreate(s, &shared, &ghost));
  h->n_incoming = shared.n_incoming;
  h->pairs = shared.pairs;
  PetscCall(PetscObjectReference((PetscObject)h->pairs));
  PetscCall(LocalColumns(s, first, ghost, h->n_incoming, shared.number, &n_outer, &outer));
  PetscCall(PetscSFCreate(s->comm, &h->columns));
  PetscCall(PetscSFSetGraphLayout(h->columns, layout, n_outer, NULL, PETSC_COPY_VALUES, outer));
  PetscCall(MergeRows(s, shared.start, shared.number, h));
  *n_columns = n + n_outer;
  *halo = h;
  PetscCall(SharedRowsDestroy(&shared));
  PetscCall(PetscLayoutDestroy(&layout));
  PetscCall(PetscFree(ghost));
  PetscCall(PetscFree(outer));
  PetscFunctionReturn(0);
}

PetscErrorCode BlocksHaloDestroy(BlocksHalo **halo)
{
  BlocksHalo *h = *halo;

  PetscFunctionBeginUser;
  if (!h) PetscFunctionReturn(0);
  PetscCall(PetscSFDestroy(&h->columns));
  PetscCall(PetscSFDestroy(&h->pairs));
  PetscCallMPI(MPI_Type_free(&h->vector));
  PetscCallMPI(MPI_Type_free(&h->block));
  PetscCallMPI(MPI_Type_free(&h->scale));
  PetscCall(PetscFree4(h->shared_row, h->start, h->own_start, h->column));
  PetscCall(PetscFree2(h->own, h->come));
  PetscCall(PetscFree2(h->values, h->incoming));
  PetscCall(PetscFree(*halo));
  PetscFunctionReturn(0);
}

static inline float number_at(const System *s, PetscInt i) { return s->singles ? s->singles[i] : (float)s->values[i]; }

PetscErrorCode BlocksHaloSum(BlocksHalo *h, const System *s)
{
  const PetscInt bs = s->dim * s->dim, first = s->row_start[s->n_active] * bs, n = s->row_start[s->n_rows] * bs - first;
  const float *ghosts = s->singles ? s->singles + first : NULL;
  float *copy = NULL;

  PetscFunctionBeginUser;
  if (!ghosts) PetscCall(PetscMalloc1(n, &copy));
  for (PetscInt i = 0; i < n && copy; ++i) copy[i] = (float)s->values[first + i];
  if (!ghosts) ghosts = copy;
  PetscCall(PetscSFReduceBegin(h->pairs, h->block, ghosts, h->incoming, MPI_REPLACE));
  PetscCall(PetscArrayzero(h->values, h->start[h->n_shared] * bs));
  for (PetscInt k = 0; k < h->n_shared; ++k) {
    PetscInt own = s->row_start[h->shared_row[k]] * bs;
    for (PetscInt j = h->own_start[k]; j < h->own_start[k + 1]; ++j)
      for (PetscInt i = 0; i < bs; ++i) h->values[h->own[j] * bs + i] += number_at(s, own++);
  }
  PetscCall(PetscSFReduceEnd(h->pairs, h->block, ghosts, h->incoming, MPI_REPLACE));
  PetscCall(PetscFree(copy));
  for (PetscInt k = 0; k < h->n_incoming; ++k)
    for (PetscInt i = 0; i < bs; ++i) h->values[h->come[k] * bs + i] += h->incoming[k * bs + i];
  PetscFunctionReturn(0);
}
