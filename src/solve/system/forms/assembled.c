#include "solve/system/forms/assembled.h"

/* Global numbers of the column nodes of an owned row: those of its own pairs and those that arrive, ascending. */
static PetscErrorCode ColumnsOf(const System *s, const SharedRows *h, PetscInt r, PetscInt *n, PetscInt *column)
{
  PetscInt m = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = s->row_start[r]; k < s->row_start[r + 1]; ++k) column[m++] = s->number[s->column[k]];
  for (PetscInt k = h->start[r]; k < h->start[r + 1]; ++k) column[m++] = h->number[k];
  PetscCall(PetscSortRemoveDupsInt(&m, column));
  *n = m;
  PetscFunctionReturn(0);
}

/* The most nodes that a row may have. */
static PetscInt longest_row(const System *s, const SharedRows *h)
{
  PetscInt most = 0;
  for (PetscInt r = 0; r < s->n_active; ++r)
    most = PetscMax(most, s->row_start[r + 1] - s->row_start[r] + h->start[r + 1] - h->start[r]);
  return most;
}

static PetscErrorCode Preallocate(const System *s, const SharedRows *h, PetscInt first, PetscInt *column, Mat matrix)
{
  PetscInt *own, *others, n;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(s->n_active, &own, s->n_active, &others));
  for (PetscInt r = 0; r < s->n_active; ++r) {
    PetscCall(ColumnsOf(s, h, r, &n, column));
    for (PetscInt k = 0; k < n; ++k) own[r] += column[k] >= first && column[k] < first + s->n_active;
    others[r] = n - own[r];
  }
  PetscCall(MatXAIJSetPreallocation(matrix, s->block, own, others, NULL, NULL));
  PetscCall(PetscFree2(own, others));
  PetscFunctionReturn(0);
}

/* All zeros, which makes the pattern. */
static PetscErrorCode FillPattern(const System *s, const SharedRows *h, Mat matrix)
{
  const PetscInt most = longest_row(s, h);
  PetscInt first = 0, n, *column;
  PetscReal *zeros;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(most, &column));
  PetscCall(PetscCalloc1(most * s->block * s->block, &zeros));
  PetscCallMPI(MPI_Exscan(&s->n_active, &first, 1, MPIU_INT, MPI_SUM, s->comm));
  PetscCall(Preallocate(s, h, first, column, matrix));
  PetscCall(MatSetOption(matrix, MAT_NO_OFF_PROC_ENTRIES, PETSC_TRUE));
  for (PetscInt r = 0; r < s->n_active; ++r) {
    const PetscInt row = first + r;
    PetscCall(ColumnsOf(s, h, r, &n, column));
    PetscCall(MatSetValuesBlocked(matrix, 1, &row, n, column, zeros, INSERT_VALUES));
  }
  PetscCall(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
  PetscCall(PetscFree(column));
  PetscCall(PetscFree(zeros));
  PetscFunctionReturn(0);
}

/* One part of a rank's rows: where a block of it begins. */
typedef struct {
  const PetscInt *start, *column;
} Rows;

static PetscErrorCode GetRows(Mat part, Rows *rows)
{
  PetscInt n;
  PetscBool done;
  PetscFunctionBeginUser;
  PetscCall(MatGetRowIJ(part, 0, PETSC_FALSE, PETSC_FALSE, &n, &rows->start, &rows->column, &done));
  PetscCheck(done, PETSC_COMM_SELF, PETSC_ERR_PLIB, "no rows");
  PetscFunctionReturn(0);
}

static PetscErrorCode Find(const Rows *rows, PetscInt row, PetscInt column, PetscInt *place)
{
  PetscInt at;
  PetscFunctionBeginUser;
  PetscCall(PetscFindInt(column, rows->start[row + 1] - rows->start[row], rows->column + rows->start[row], &at));
  *place = rows->start[row] + at;
  PetscFunctionReturn(0);
}

typedef struct {
  Rows own, others;
  PetscInt first, n_outer; /* numbers (not nodes) */
  const PetscInt *outer;   /* of the columns of others, ascending */
} Lookup;

static PetscErrorCode PlaceOf(const System *s, const Lookup *l, PetscInt r, PetscInt node, PetscInt *place)
{
  const PetscInt number = node * s->block, row = r * s->block;
  PetscInt column;

  PetscFunctionBeginUser;
  if (number >= l->first && number < l->first + s->n_active * s->block) {
    PetscCall(Find(&l->own, row, number - l->first, place));
    PetscFunctionReturn(0);
  }
  PetscCall(PetscFindInt(number, l->n_outer, l->outer, &column));
  PetscCall(Find(&l->others, row, column, place));
  *place = -1 - *place;
  PetscFunctionReturn(0);
}

static PetscErrorCode FindPlaces(const System *s, const Lookup *l, Assembled *m)
{
  const PetscInt pairs = s->row_start[s->n_active];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(pairs + m->shared.n_incoming, &m->place));
  for (PetscInt r = 0; r < s->n_active; ++r) {
    for (PetscInt k = s->row_start[r]; k < s->row_start[r + 1]; ++k)
      PetscCall(PlaceOf(s, l, r, s->number[s->column[k]], m->place + k));
    for (PetscInt k = m->shared.start[r]; k < m->shared.start[r + 1]; ++k)
      PetscCall(PlaceOf(s, l, r, m->shared.number[k], m->place + pairs + k));
  }
  PetscFunctionReturn(0);
}

/* The matrix as it is stored, and where each pair goes in it. */
static PetscErrorCode LookUp(const System *s, Assembled *m, Mat matrix)
{
  PetscMPIInt ranks;
  Lookup l = {.first = 0};

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(s->comm, &ranks));
  m->own = matrix;
  if (ranks > 1) {
    PetscCall(MatMPIAIJGetSeqAIJ(matrix, &m->own, &m->others, &l.outer));
    PetscCall(MatGetSize(m->others, NULL, &l.n_outer));
    PetscCall(GetRows(m->others, &l.others));
  }
  PetscCall(MatGetOwnershipRange(matrix, &l.first, NULL));
  PetscCall(GetRows(m->own, &l.own));
  PetscCall(FindPlaces(s, &l, m));
  PetscFunctionReturn(0);
}

PetscErrorCode AssembledCreate(const System *s, Assembled **assembled, Mat *matrix)
{
  const PetscInt n = s->n_active * s->block, numbers = s->block * s->block;
  Assembled *m;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&m));
  PetscCall(SharedRowsCreate(s, &m->shared, NULL));
  PetscCall(PetscMalloc1(m->shared.n_incoming * numbers, &m->incoming));
  PetscCallMPI(MPI_Type_contiguous((PetscMPIInt)numbers, MPIU_REAL, &m->pair));
  PetscCallMPI(MPI_Type_commit(&m->pair));
  PetscCall(MatCreate(s->comm, matrix));
  PetscCall(MatSetSizes(*matrix, n, n, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetBlockSize(*matrix, s->block));
  PetscCall(MatSetType(*matrix, MATAIJ));
  PetscCall(FillPattern(s, &m->shared, *matrix));
  PetscCall(LookUp(s, m, *matrix));
  *assembled = m;
  PetscFunctionReturn(0);
}

PetscErrorCode AssembledDestroy(Assembled **assembled)
{
  Assembled *m = *assembled;

  PetscFunctionBeginUser;
  if (!m) PetscFunctionReturn(0);
  PetscCall(SharedRowsDestroy(&m->shared));
  PetscCallMPI(MPI_Type_free(&m->pair));
  PetscCall(PetscFree(m->incoming));
  PetscCall(PetscFree(m->place));
  PetscCall(PetscFree(*assembled));
  PetscFunctionReturn(0);
}

/* Values of both parts, and the length of their rows. */
typedef struct {
  PetscReal *own, *others;
  const PetscInt *own_start, *others_start;
} Target;

/* Write a block, or add to it. */
static inline __attribute__((always_inline)) void put(const Target *t, const int size, PetscInt r, PetscInt place,
                                                      const PetscReal *v, const PetscBool add)
{
  const PetscInt *start = (place < 0 ? t->others_start : t->own_start) + r * size;
  PetscReal *to = place < 0 ? t->others - 1 - place : t->own + place;
  for (int a = 0; a < size; ++a, to += start[1] - start[0])
    for (int b = 0; b < size; ++b) to[b] = v[a * size + b] + (add ? to[b] : 0);
}

/* Rows that others assemble too may have pairs that only others know. */
static void zero_rows(const Target *t, PetscInt first, PetscInt end)
{
  for (PetscInt k = t->own_start[first]; k < t->own_start[end]; ++k) t->own[k] = 0;
  for (PetscInt k = t->others ? t->others_start[first] : 0; t->others && k < t->others_start[end]; ++k)
    t->others[k] = 0;
}

static inline __attribute__((always_inline)) void fill(const Assembled *m, const System *s, const Target *t,
                                                       const int size)
{
  const PetscInt bs = size * size, pairs = s->row_start[s->n_active];
  const SharedRows *h = &m->shared;
  for (PetscInt r = 0; r < s->n_active; ++r) {
    if (h->start[r + 1] > h->start[r]) zero_rows(t, r * size, (r + 1) * size);
    for (PetscInt k = s->row_start[r]; k < s->row_start[r + 1]; ++k)
      put(t, size, r, m->place[k], s->values + k * bs, PETSC_FALSE);
    for (PetscInt k = h->start[r]; k < h->start[r + 1]; ++k)
      put(t, size, r, m->place[pairs + k], m->incoming + k * bs, PETSC_TRUE);
  }
}

PetscErrorCode AssembledFill(Assembled *m, const System *s, Mat matrix)
{
  const PetscReal *ghosts = s->values + s->row_start[s->n_active] * s->block * s->block;
  Target t = {NULL, NULL, NULL, NULL};
  Rows own, others;

  PetscFunctionBeginUser;
  PetscCall(PetscSFReduceBegin(m->shared.pairs, m->pair, ghosts, m->incoming, MPI_REPLACE));
  PetscCall(PetscSFReduceEnd(m->shared.pairs, m->pair, ghosts, m->incoming, MPI_REPLACE));
  PetscCall(GetRows(m->own, &own));
  PetscCall(MatSeqAIJGetArray(m->own, &t.own));
  t.own_start = own.start;
  if (m->others) {
    PetscCall(GetRows(m->others, &others));
    PetscCall(MatSeqAIJGetArray(m->others, &t.others));
    t.others_start = others.start;
  }
  if (s->block == 2) fill(m, s, &t, 2);
  else if (s->block == 3) fill(m, s, &t, 3);
  else fill(m, s, &t, 4);
  PetscCall(MatSeqAIJRestoreArray(m->own, &t.own));
  if (m->others) PetscCall(MatSeqAIJRestoreArray(m->others, &t.others));
  PetscCall(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}
