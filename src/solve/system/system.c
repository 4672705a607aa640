#include "solve/blocks/blocks.h"
#include "solve/blocks/projection.h"
#include "solve/system/forms/assembled.h"
#include "solve/system/forms/gathered.h"

PetscErrorCode SystemCreate(MPI_Comm comm, PetscInt dim, PetscInt block, System **system)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(system));
  (*system)->comm = comm;
  (*system)->dim = dim;
  (*system)->block = block;
  PetscFunctionReturn(0);
}

static PetscErrorCode SystemFreeMatrix(System *s)
{
  PetscFunctionBeginUser;
  PetscCall(MatDestroy(&s->matrix));
  PetscCall(BlocksDestroy(&s->blocks));
  PetscCall(AssembledDestroy(&s->assembled));
  PetscCall(GatheredDestroy(&s->gathered));
  PetscFunctionReturn(0);
}

static PetscErrorCode SystemFreePattern(System *s)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(s->active));
  PetscCall(PetscFree(s->number));
  PetscCall(PetscFree(s->row));
  PetscCall(PetscFree(s->row_start));
  PetscCall(PetscFree(s->column));
  PetscCall(PetscFree(s->diagonal));
  PetscCall(PetscFree(s->matter));
  PetscCall(PetscFree(s->values));
  PetscCall(PetscFree(s->singles));
  s->single = PETSC_FALSE;
  s->n_cuts = 0;
  PetscCall(SystemFreeMatrix(s));
  PetscFunctionReturn(0);
}

PetscErrorCode SystemDestroy(System **system)
{
  PetscFunctionBeginUser;
  if (!*system) PetscFunctionReturn(0);
  PetscCall(SystemFreePattern(*system));
  PetscCall(SystemFreeSlots(*system));
  PetscCall(PetscFree((*system)->cut));
  PetscCall(PetscFree((*system)->turned));
  PetscCall(PetscFree(*system));
  PetscFunctionReturn(0);
}

/* A node carries unknowns if a cell of any rank holds it. */
static PetscErrorCode SystemNumber(System *s, const Grid *grid, PetscInt n_entries, const PetscInt *node)
{
  PetscReal *used;
  PetscInt first = 0;

  PetscFunctionBeginUser;
  s->n_nodes = grid->n_nodes;
  PetscCall(PetscCalloc1(s->n_nodes, &used));
  for (PetscInt i = 0; i < n_entries; ++i) used[node[i]] = 1;
  PetscCall(GridSumToOwners(grid, 1, used));
  s->n_active = 0;
  for (PetscInt i = 0; i < grid->n_owned; ++i) s->n_active += used[i] > 0;
  PetscCall(PetscMalloc1(s->n_active, &s->active));
  PetscCall(PetscMalloc1(s->n_nodes, &s->number));
  PetscCallMPI(MPI_Exscan(&s->n_active, &first, 1, MPIU_INT, MPI_SUM, s->comm));
  PetscCall(MPIU_Allreduce(&s->n_active, &s->n_active_global, 1, MPIU_INT, MPI_SUM, s->comm));
  PetscCall(MPIU_Allreduce(&s->n_active, &s->n_active_least, 1, MPIU_INT, MPI_MIN, s->comm));
  for (PetscInt i = 0, k = 0; i < grid->n_owned; ++i) {
    s->number[i] = used[i] > 0 ? first + k : -1;
    if (used[i] > 0) s->active[k++] = i;
    used[i] = (PetscReal)s->number[i];
  }
  PetscCall(GridToGhosts(grid, 1, used));
  for (PetscInt i = grid->n_owned; i < s->n_nodes; ++i) s->number[i] = (PetscInt)used[i];
  PetscCall(PetscFree(used));
  PetscFunctionReturn(0);
}

/* Groups around each local row: CSR of group numbers. */
static PetscErrorCode RowGroups(const System *s, const NodeGroups *groups, PetscInt **start, PetscInt **group)
{
  const PetscInt n = groups->start[groups->n];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(s->n_rows + 1, start));
  PetscCall(PetscMalloc1(n, group));
  for (PetscInt i = 0; i < n; ++i) ++(*start)[s->row[groups->node[i]] + 1];
  for (PetscInt r = 0; r < s->n_rows; ++r) (*start)[r + 1] += (*start)[r];
  for (PetscInt g = 0; g < groups->n; ++g)
    for (PetscInt i = groups->start[g]; i < groups->start[g + 1]; ++i)
      (*group)[(*start)[s->row[groups->node[i]]]++] = g;
  for (PetscInt r = s->n_rows; r > 0; --r) (*start)[r] = (*start)[r - 1];
  (*start)[0] = 0;
  PetscFunctionReturn(0);
}

/* Pairs of nodes in the same group, an upper bound of the number of columns. */
static PetscInt count_pairs(const NodeGroups *groups)
{
  PetscInt pairs = 0;
  for (PetscInt g = 0; g < groups->n; ++g) {
    const PetscInt nn = groups->start[g + 1] - groups->start[g];
    pairs += nn * nn;
  }
  return pairs;
}

static PetscErrorCode SystemPattern(System *s, const NodeGroups *groups)
{
  const PetscInt n = groups->start[groups->n], bound = count_pairs(groups);
  PetscInt *start, *group, *mark, *rows, size = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->n_nodes, &s->row));
  for (PetscInt i = 0; i < s->n_nodes; ++i) s->row[i] = -1;
  for (PetscInt i = 0; i < n; ++i) s->row[groups->node[i]] = 0;
  /* owned, even if only others' groups hold it */
  for (PetscInt k = 0; k < s->n_active; ++k) s->row[s->active[k]] = 0;
  s->n_rows = 0;
  for (PetscInt i = 0; i < s->n_nodes; ++i)
    if (s->row[i] == 0) s->row[i] = s->n_rows++;
  PetscCall(RowGroups(s, groups, &start, &group));
  PetscCall(PetscMalloc1(s->n_rows, &rows));
  for (PetscInt i = 0; i < s->n_nodes; ++i)
    if (s->row[i] >= 0) rows[s->row[i]] = i;
  PetscCall(PetscMalloc1(s->n_nodes, &mark));
  for (PetscInt i = 0; i < s->n_nodes; ++i) mark[i] = -1;
  PetscCall(PetscMalloc1(bound + s->n_rows, &s->column)); /* an upper bound, trimmed below */
  PetscCall(PetscMalloc1(s->n_rows + 1, &s->row_start));
  PetscCall(PetscMalloc1(s->n_rows, &s->diagonal));
  for (PetscInt r = 0; r < s->n_rows; ++r) {
    s->row_start[r] = size;
    mark[rows[r]] = r;
    s->column[size++] = rows[r];
    for (PetscInt k = start[r]; k < start[r + 1]; ++k)
      for (PetscInt i = groups->start[group[k]]; i < groups->start[group[k] + 1]; ++i) {
        const PetscInt node = groups->node[i];
        if (mark[node] == r) continue;
        mark[node] = r;
        s->column[size++] = node;
      }
    PetscCall(PetscSortInt(size - s->row_start[r], s->column + s->row_start[r]));
    for (PetscInt k = s->row_start[r]; k < size; ++k)
      if (s->column[k] == rows[r]) s->diagonal[r] = k;
  }
  s->row_start[s->n_rows] = size;
  s->n_pairs_global = (PetscReal)size;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &s->n_pairs_global, 1, MPIU_REAL, MPI_SUM, s->comm));
  PetscCall(PetscRealloc((size_t)size * sizeof(PetscInt), &s->column));
  PetscCall(PetscCalloc1(size * s->block * s->block + SYSTEM_PADDING, &s->values));
  PetscCall(PetscFree(start));
  PetscCall(PetscFree(group));
  PetscCall(PetscFree(mark));
  PetscCall(PetscFree(rows));
  PetscFunctionReturn(0);
}

static PetscInt system_numbers(const System *s) { return s->row_start[s->n_rows] * s->block * s->block; }

static PetscErrorCode MultiplyBlocks(Mat matrix, Vec x, Vec y)
{
  Blocks *blocks;

  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(matrix, &blocks));
  PetscCall(BlocksMultiply(blocks, x, y));
  PetscFunctionReturn(0);
}

/* A matrix that is nothing but what it does. */
static PetscErrorCode ShellMatrix(System *s, void *context, void (*multiply)(void))
{
  const PetscInt n = s->n_active * s->dim;

  PetscFunctionBeginUser;
  PetscCall(MatCreateShell(s->comm, n, n, PETSC_DETERMINE, PETSC_DETERMINE, context, &s->matrix));
  PetscCall(MatShellSetOperation(s->matrix, MATOP_MULT, multiply));
  PetscFunctionReturn(0);
}

static PetscErrorCode BlockMatrix(System *s, PetscBool symmetric)
{
  PetscFunctionBeginUser;
  PetscCall(BlocksCreate(s, symmetric, &s->blocks));
  PetscCall(ShellMatrix(s, s->blocks, (void (*)(void))MultiplyBlocks));
  PetscFunctionReturn(0);
}

static PetscErrorCode MultiplyGathered(Mat matrix, Vec x, Vec y)
{
  Gathered *gathered;

  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(matrix, &gathered));
  PetscCall(GatheredMultiply(gathered, x, y));
  PetscFunctionReturn(0);
}

static PetscErrorCode DiagonalGathered(Mat matrix, Vec diagonal)
{
  Gathered *gathered;

  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(matrix, &gathered));
  PetscCall(GatheredDiagonal(gathered, diagonal));
  PetscFunctionReturn(0);
}

static PetscErrorCode GatheredMatrix(System *s, PetscBool symmetric)
{
  PetscFunctionBeginUser;
  PetscCall(GatheredCreate(s, symmetric, &s->gathered));
  PetscCall(ShellMatrix(s, s->gathered, (void (*)(void))MultiplyGathered));
  PetscCall(MatShellSetOperation(s->matrix, MATOP_GET_DIAGONAL, (void (*)(void))DiagonalGathered));
  PetscFunctionReturn(0);
}

PetscErrorCode SystemUse(System *s, SystemForm form, PetscBool symmetric)
{
  PetscFunctionBeginUser;
  if (!s->matrix || s->form != form || (s->blocks && s->blocks->symmetric != symmetric) ||
      (s->gathered && s->gathered->symmetric != symmetric)) {
    PetscCall(SystemFreeMatrix(s));
    s->form = form;
    if (form == SYSTEM_BLOCKS) PetscCall(BlockMatrix(s, symmetric));
    else if (form == SYSTEM_GATHERED) PetscCall(GatheredMatrix(s, symmetric));
    else PetscCall(AssembledCreate(s, &s->assembled, &s->matrix));
    PetscCall(SystemGather(s, PETSC_FALSE));
  }
  if (symmetric) PetscCall(MatSetOption(s->matrix, MAT_SYMMETRIC, PETSC_TRUE));
  PetscFunctionReturn(0);
}

PetscErrorCode SystemGather(System *s, PetscBool single)
{
  PetscFunctionBeginUser;
  for (PetscInt r = 0; s->matter && r < s->n_rows; ++r) s->matter[r] = PetscMin(s->matter[r], ROW_LEFT);
  s->single = single && s->blocks;
  if (s->single) PetscCall(PetscFree(s->values));
  else if (!s->values) PetscCall(PetscCalloc1(system_numbers(s) + SYSTEM_PADDING, &s->values));
  if (s->blocks && !s->singles) PetscCall(PetscCalloc1(system_numbers(s), &s->singles));
  PetscFunctionReturn(0);
}

PetscErrorCode SystemBuild(System *s, const Grid *grid, const NodeGroups *groups)
{
  PetscFunctionBeginUser;
  PetscCall(SystemFreePattern(s));
  PetscCall(SystemNumber(s, grid, groups->start[groups->n], groups->node));
  PetscCall(SystemPattern(s, groups));
  ++s->builds;
  PetscFunctionReturn(0);
}

/* Place of the pair (row of node I, node J) in the pattern. Rows are so short that counting the
 * columns before J, without a branch, is faster than bisection. */
static inline PetscInt pair_slot(const System *s, PetscInt I, PetscInt J)
{
  const PetscInt row = s->row[I], end = s->row_start[row + 1];
  PetscInt slot = s->row_start[row];
  for (PetscInt k = slot; k < end; ++k) slot += s->column[k] < J;
  return slot;
}

PetscErrorCode SystemSlots(System *s, const Support *support, PetscBool *complete)
{
  PetscInt size = 0;

  PetscFunctionBeginUser;
  s->later = NULL;
  if (!support->n_runs) {
    PetscCall(SystemCloudSlots(s, support, PETSC_FALSE, complete));
    PetscFunctionReturn(0);
  }
  for (const SupportRun *r = support->run; r < support->run + support->n_runs; ++r)
    size += (r->end - r->first) * r->nodes * r->nodes;
  PetscCall(SystemReserveSlots(s, size));
  PetscInt *slot = s->slot;
  for (const SupportRun *r = support->run; r < support->run + support->n_runs; ++r)
    for (PetscInt g = r->first, nn = r->nodes; g < r->end; ++g, slot += nn * nn) {
      const PetscInt *node = support->node + support->node_start[g];
      for (PetscInt I = 0; I < nn; ++I)
        for (PetscInt J = 0; J < nn; ++J) slot[I * nn + J] = pair_slot(s, node[I], node[J]);
    }
  if (complete) *complete = PETSC_TRUE;
  PetscFunctionReturn(0);
}

void system_slots_later(System *s, const Support *support) { s->later = support; }

PetscErrorCode SystemWantSlots(System *s, PetscBool half)
{
  PetscBool complete;

  PetscFunctionBeginUser;
  if (!s->later) PetscFunctionReturn(0);
  if (half && !s->later->n_runs) PetscCall(SystemCloudSlots(s, s->later, PETSC_TRUE, &complete));
  else PetscCall(SystemSlots(s, s->later, &complete));
  s->later = NULL;
  PetscCheck(complete, PETSC_COMM_SELF, PETSC_ERR_PLIB, "points couple nodes that their basis did not announce");
  PetscFunctionReturn(0);
}

PetscErrorCode SystemZero(System *s)
{
  PetscFunctionBeginUser;
  if (s->single) PetscCall(PetscArrayzero(s->singles, system_numbers(s)));
  else PetscCall(PetscArrayzero(s->values, system_numbers(s)));
  PetscFunctionReturn(0);
}

PetscErrorCode SystemZeroHalf(System *s)
{
  const PetscInt size = s->block * s->block;

  PetscFunctionBeginUser;
  for (PetscInt r = 0; r < s->n_rows; ++r) {
    const PetscBool empty = s->matter && s->matter[r] == ROW_EMPTY; /* but for its diagonal */
    const size_t first = (size_t)s->diagonal[r] * (size_t)size;
    const PetscInt n = empty ? size : (s->row_start[r + 1] - s->diagonal[r]) * size;
    if (s->matter && s->matter[r] == ROW_LEFT) s->matter[r] = ROW_EMPTY;
    if (s->single) PetscCall(PetscArrayzero(s->singles + first, n));
    else PetscCall(PetscArrayzero(s->values + first, n));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SystemZeroNodes(const System *s, PetscReal *nodes)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < s->n_nodes; ++i)
    if (s->row[i] >= 0)
      for (PetscInt d = 0; d < s->dim; ++d) nodes[i * s->dim + d] = 0;
  PetscFunctionReturn(0);
}

PetscErrorCode SystemToMatrix(System *s)
{
  PetscFunctionBeginUser;
  if (!s->matrix) PetscCall(SystemUse(s, SYSTEM_ASSEMBLED, PETSC_FALSE));
  system_cut(s);
  if (s->blocks) {
    for (PetscInt i = 0; !s->single && i < system_numbers(s); ++i) s->singles[i] = (float)s->values[i];
    if (s->blocks->projection) projection_strengthen(s->blocks->projection);
  }
  PetscCall(SystemCloseCuts(s));
  if (s->blocks) PetscCall(BlocksFill(s->blocks, s));
  else if (s->gathered) PetscCall(GatheredFill(s->gathered, s->matrix));
  else PetscCall(AssembledFill(s->assembled, s, s->matrix));
  PetscFunctionReturn(0);
}

PetscErrorCode SystemCreateVec(const System *s, Vec *x)
{
  PetscFunctionBeginUser;
  PetscCall(VecCreateMPI(s->comm, s->n_active * s->block, PETSC_DETERMINE, x));
  PetscFunctionReturn(0);
}

PetscErrorCode SystemToNodes(const System *s, const Grid *grid, Vec x, PetscInt first, PetscInt n, PetscReal *nodes)
{
  const PetscReal *v;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(nodes, s->n_nodes * n));
  PetscCall(VecGetArrayRead(x, &v));
  for (PetscInt k = 0; k < s->n_active; ++k)
    for (PetscInt a = 0; a < n; ++a) nodes[s->active[k] * n + a] = v[k * s->block + first + a];
  PetscCall(VecRestoreArrayRead(x, &v));
  PetscCall(GridToGhosts(grid, n, nodes));
  PetscFunctionReturn(0);
}

PetscErrorCode SystemFromNodes(const System *s, const PetscReal *nodes, PetscInt first, PetscInt n, Vec x)
{
  PetscReal *v;

  PetscFunctionBeginUser;
  PetscCall(VecGetArray(x, &v));
  for (PetscInt k = 0; k < s->n_active; ++k)
    for (PetscInt a = 0; a < n; ++a) v[k * s->block + first + a] = nodes[s->active[k] * n + a];
  PetscCall(VecRestoreArray(x, &v));
  PetscFunctionReturn(0);
}
