#include "solve/blocks/projection.h"
#include "solve/blocks/block_kernels.h"

/* of its neighbours' diagonal: from 1e-4 to 1e-1 the preconditioner is as good */
#define WEAKEST 1e-3

/* Entries of C in the making: the rows of one rank, or of all. */
typedef struct {
  PetscInt n, *row, *dof; /* dof: global number */
  PetscReal *N;
} Entries;

static PetscErrorCode EntriesCreate(PetscInt n, Entries *e)
{
  PetscFunctionBeginUser;
  e->n = 0;
  PetscCall(PetscMalloc3(n, &e->row, n, &e->dof, n, &e->N));
  PetscFunctionReturn(0);
}

static PetscErrorCode EntriesDestroy(Entries *e)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(e->row, e->dof, e->N));
  PetscFunctionReturn(0);
}

/* The first global number of this rank's nodes. */
static PetscInt first_number(const System *s) { return s->n_active ? s->number[s->active[0]] : 0; }

/* Rows of this rank, counted from 0, and where their multipliers stand. */
static PetscErrorCode OwnRows(Projection *p, const Constraints *c, const unsigned char *fixed, Entries *e)
{
  const System *s = p->system;
  const PetscInt dim = s->dim, first = first_number(s);

  PetscFunctionBeginUser;
  PetscCall(EntriesCreate(c->start[c->n] * dim, e));
  PetscCall(PetscMalloc1(c->n * dim, &p->twin));
  for (PetscInt k = 0; k < c->n; ++k)
    for (PetscInt d = 0; d < dim; ++d) {
      if (fixed[c->twin[k] * dim + d]) continue;
      for (PetscInt i = c->start[k]; i < c->start[k + 1]; ++i) {
        if (fixed[c->node[i] * dim + d]) continue;
        e->row[e->n] = p->n_own;
        e->dof[e->n] = s->number[c->node[i]] * dim + d;
        e->N[e->n++] = c->N[i * dim + d];
      }
      p->held[c->twin[k] * dim + d] = 1;
      p->twin[p->n_own++] = (s->number[c->twin[k]] - first) * dim + d;
    }
  PetscFunctionReturn(0);
}

/* The entries of all ranks, on all ranks, with rows numbered through. */
static PetscErrorCode GatherEntries(Projection *p, Entries *own, Entries *all)
{
  PetscMPIInt size, n = (PetscMPIInt)own->n, *count, *start, total = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(p->comm, &size));
  PetscCallMPI(MPI_Exscan(&p->n_own, &p->first, 1, MPIU_INT, MPI_SUM, p->comm));
  PetscCall(MPIU_Allreduce(&p->n_own, &p->m, 1, MPIU_INT, MPI_SUM, p->comm));
  for (PetscInt i = 0; i < own->n; ++i) own->row[i] += p->first;
  PetscCall(PetscMalloc2(size, &count, size, &start));
  PetscCallMPI(MPI_Allgather(&n, 1, MPI_INT, count, 1, MPI_INT, p->comm));
  for (PetscMPIInt r = 0; r < size; ++r) start[r] = total, total += count[r];
  PetscCall(EntriesCreate(total, all));
  all->n = total;
  PetscCallMPI(MPI_Allgatherv(own->row, n, MPIU_INT, all->row, count, start, MPIU_INT, p->comm));
  PetscCallMPI(MPI_Allgatherv(own->dof, n, MPIU_INT, all->dof, count, start, MPIU_INT, p->comm));
  PetscCallMPI(MPI_Allgatherv(own->N, n, MPIU_REAL, all->N, count, start, MPIU_REAL, p->comm));
  PetscCall(PetscFree2(count, start));
  PetscFunctionReturn(0);
}

/* Columns of C from its entries. */
static PetscErrorCode SortColumns(Projection *p, const Entries *all)
{
  const System *s = p->system;
  const PetscInt first = first_number(s) * s->dim, end = first + s->n_active * s->dim;
  PetscInt *order;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(all->n, &order));
  for (PetscInt i = 0; i < all->n; ++i) order[i] = i;
  PetscCall(PetscSortIntWithPermutation(all->n, all->dof, order));
  PetscCall(PetscMalloc1(all->n + 1, &p->start));
  PetscCall(PetscMalloc3(all->n, &p->row, all->n, &p->N, all->n, &p->place));
  PetscCall(PetscMalloc2(all->n, &p->inverse, all->n, &p->shift));
  for (PetscInt i = 0; i < all->n; ++i) {
    const PetscInt dof = all->dof[order[i]];
    if (i == 0 || dof != all->dof[order[i - 1]]) {
      p->place[p->n_dofs] = dof >= first && dof < end ? dof - first : -1;
      p->start[p->n_dofs++] = i;
    }
    p->row[i] = all->row[order[i]];
    p->N[i] = all->N[order[i]];
  }
  p->start[p->n_dofs] = all->n;
  PetscCall(PetscFree(order));
  PetscFunctionReturn(0);
}

/* The pattern of S: rows that share a column. */
static PetscErrorCode CreateSchur(Projection *p)
{
  PetscInt *i, *j, n = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < p->n_dofs; ++k) p->n_pairs += PetscSqr(p->start[k + 1] - p->start[k]);
  PetscCall(PetscMalloc1(p->n_pairs, &p->pair));
  PetscCall(PetscMalloc2(p->n_pairs, &i, p->n_pairs, &j));
  for (PetscInt k = 0; k < p->n_dofs; ++k)
    for (PetscInt a = p->start[k]; a < p->start[k + 1]; ++a)
      for (PetscInt b = p->start[k]; b < p->start[k + 1]; ++b, ++n) i[n] = p->row[a], j[n] = p->row[b];
  PetscCall(MatCreate(PETSC_COMM_SELF, &p->S));
  PetscCall(MatSetSizes(p->S, p->m, p->m, p->m, p->m));
  PetscCall(MatSetType(p->S, MATSEQAIJ));
  PetscCall(MatSetPreallocationCOO(p->S, p->n_pairs, i, j));
  PetscCall(MatSetOption(p->S, MAT_SPD, PETSC_TRUE));
  PetscCall(PetscFree2(i, j));
  PetscCall(PetscMalloc2(p->m, &p->t, p->m, &p->lambda));
  PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, p->m, p->t, &p->b));
  PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, p->m, p->lambda, &p->x));
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionCreate(const System *system, const Grid *grid, const Constraints *constraints,
                                const unsigned char *fixed, Projection **projection)
{
  const PetscInt dofs = grid->n_nodes * grid->dim;
  Projection *p;
  Entries own, all;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&p));
  p->comm = system->comm;
  p->system = system;
  p->grid = grid;
  p->scale = constraints->scale;
  PetscCall(PetscMalloc1(dofs, &p->held));
  PetscCall(PetscArraycpy(p->held, fixed, dofs));
  for (int k = 0; k < 2; ++k) PetscCall(PetscCalloc1(dofs, &p->nodes[k]));
  PetscCall(OwnRows(p, constraints, fixed, &own));
  PetscCall(GatherEntries(p, &own, &all));
  PetscCall(SortColumns(p, &all));
  PetscCall(CreateSchur(p));
  PetscCall(EntriesDestroy(&own));
  PetscCall(EntriesDestroy(&all));
  *projection = p;
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionDestroy(Projection **projection)
{
  Projection *p = *projection;

  PetscFunctionBeginUser;
  if (!p) PetscFunctionReturn(0);
  PetscCall(PetscFree(p->held));
  PetscCall(PetscFree(p->twin));
  PetscCall(PetscFree(p->start));
  PetscCall(PetscFree3(p->row, p->N, p->place));
  PetscCall(PetscFree2(p->inverse, p->shift));
  PetscCall(PetscFree(p->pair));
  PetscCall(MatDestroy(&p->S));
  PetscCall(MatDestroy(&p->factor));
  PetscCall(VecDestroy(&p->b));
  PetscCall(VecDestroy(&p->x));
  PetscCall(PetscFree2(p->t, p->lambda));
  for (int k = 0; k < 2; ++k) PetscCall(PetscFree(p->nodes[k]));
  PetscCall(PetscFree(*projection));
  PetscFunctionReturn(0);
}

/* The diagonal of K where C has a column, in p->inverse. */
static PetscErrorCode FetchDiagonal(Projection *p)
{
  const System *s = p->system;
  const PetscInt dim = s->dim;
  PetscReal *diagonal = p->nodes[0];

  PetscFunctionBeginUser;
  for (PetscInt node = 0; node < s->n_nodes; ++node)
    for (PetscInt d = 0; d < dim; ++d)
      diagonal[node * dim + d] = s->row[node] < 0 ? 0 : s->values[(s->diagonal[s->row[node]] * dim + d) * dim + d];
  PetscCall(GridSumToOwners(p->grid, dim, diagonal));
  for (PetscInt k = 0; k < p->n_dofs; ++k)
    p->inverse[k] = p->place[k] < 0 ? 0 : diagonal[s->active[p->place[k] / dim] * dim + p->place[k] % dim];
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, p->inverse, (PetscMPIInt)p->n_dofs, MPIU_REAL, MPI_SUM, p->comm));
  PetscFunctionReturn(0);
}

/* A node that a point's support has just reached has a diagonal many powers of ten below its
 * neighbours', and plastic flow leaves it of any sign: no preconditioner stands that. There such a
 * diagonal is raised to WEAKEST of the largest that shares a row with it. */
static void strengthen_weak(Projection *p)
{
  PetscReal *largest = p->t; /* of each row */
  for (PetscInt k = 0; k < p->m; ++k) largest[k] = 0;
  for (PetscInt k = 0; k < p->n_dofs; ++k)
    for (PetscInt a = p->start[k]; a < p->start[k + 1]; ++a)
      largest[p->row[a]] = PetscMax(largest[p->row[a]], PetscAbsReal(p->inverse[k]));
  for (PetscInt k = 0; k < p->n_dofs; ++k) {
    PetscReal least = 0;
    for (PetscInt a = p->start[k]; a < p->start[k + 1]; ++a) least = PetscMax(least, WEAKEST * largest[p->row[a]]);
    p->shift[k] = PetscAbsReal(p->inverse[k]) < least ? least - p->inverse[k] : 0;
    p->inverse[k] += p->shift[k];
  }
}

void projection_strengthen(const Projection *p)
{
  const System *s = p->system;
  for (PetscInt k = 0; k < p->n_dofs; ++k) {
    if (p->place[k] < 0 || p->shift[k] == 0) continue;
    const PetscInt d = p->place[k] % s->dim, row = s->row[s->active[p->place[k] / s->dim]];
    s->singles[(s->diagonal[row] * s->dim + d) * s->dim + d] += (float)p->shift[k];
  }
}

void projection_weaken(const Projection *p, const PetscReal *z, PetscReal *q)
{
  for (PetscInt k = 0; k < p->n_dofs; ++k)
    if (p->place[k] >= 0) q[p->place[k]] -= p->shift[k] * z[p->place[k]];
}

/* 1 / |D| where C has a column: D weighs the projection, and every positive weight makes one.
 * Plastic flow leaves some of D negative. */
static void invert_diagonal(Projection *p)
{
  for (PetscInt k = 0; k < p->n_dofs; ++k) {
    p->inverse[k] = 1 / PetscAbsReal(p->inverse[k]);
    if (!(p->inverse[k] > 0) || PetscIsInfReal(p->inverse[k])) p->singular = PETSC_TRUE;
  }
}

PetscErrorCode ProjectionFactor(Projection *p)
{
  IS rows, columns;
  MatFactorInfo info;
  MatFactorError error;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  p->singular = PETSC_FALSE;
  PetscCall(FetchDiagonal(p));
  strengthen_weak(p);
  invert_diagonal(p);
  if (p->singular || p->m == 0) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < p->n_dofs; ++k)
    for (PetscInt a = p->start[k]; a < p->start[k + 1]; ++a)
      for (PetscInt b = p->start[k]; b < p->start[k + 1]; ++b) p->pair[n++] = p->N[a] * p->N[b] * p->inverse[k];
  PetscCall(MatSetValuesCOO(p->S, p->pair, INSERT_VALUES));
  PetscCall(MatFactorInfoInitialize(&info));
  if (!p->factor) {
    PetscCall(MatGetOrdering(p->S, MATORDERINGND, &rows, &columns));
    PetscCall(MatGetFactor(p->S, MATSOLVERPETSC, MAT_FACTOR_CHOLESKY, &p->factor));
    PetscCall(MatCholeskyFactorSymbolic(p->factor, p->S, rows, &info));
    PetscCall(ISDestroy(&rows));
    PetscCall(ISDestroy(&columns));
  }
  PetscCall(MatCholeskyFactorNumeric(p->factor, p->S, &info));
  PetscCall(MatFactorGetError(p->factor, &error));
  p->singular = error != MAT_FACTOR_NOERROR;
  PetscFunctionReturn(0);
}

/* The local rows of K, those of other ranks' nodes too, which then get their share. */
KERNEL void multiply_rows(const int dim, const System *s, const PetscReal *x, PetscReal *y)
{
  for (PetscInt node = 0; node < s->n_nodes; ++node) {
    PetscReal sum[3] = {0, 0, 0};
    if (s->row[node] < 0) continue;
    for (PetscInt k = s->row_start[s->row[node]]; k < s->row_start[s->row[node] + 1]; ++k) {
      const PetscReal *block = s->values + (size_t)k * dim * dim, *v = x + s->column[k] * dim;
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) sum[i] += block[i * dim + j] * v[j];
    }
    for (int i = 0; i < dim; ++i) y[node * dim + i] = sum[i];
  }
}

PetscErrorCode ProjectionMultiply(Projection *p, const PetscReal *x, PetscReal *y)
{
  const System *s = p->system;
  const PetscInt dim = s->dim;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < s->n_active; ++k)
    for (PetscInt d = 0; d < dim; ++d) p->nodes[0][s->active[k] * dim + d] = x[k * dim + d];
  PetscCall(GridToGhosts(p->grid, dim, p->nodes[0]));
  if (dim == 2) multiply_rows(2, s, p->nodes[0], p->nodes[1]);
  else multiply_rows(3, s, p->nodes[0], p->nodes[1]);
  PetscCall(GridSumToOwners(p->grid, dim, p->nodes[1]));
  for (PetscInt k = 0; k < s->n_active; ++k)
    for (PetscInt d = 0; d < dim; ++d) y[k * dim + d] = p->nodes[1][s->active[k] * dim + d];
  PetscFunctionReturn(0);
}

/* lambda = S^-1 t, t summed over ranks. */
static PetscErrorCode SolveSchur(Projection *p)
{
  PetscFunctionBeginUser;
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, p->t, (PetscMPIInt)p->m, MPIU_REAL, MPI_SUM, p->comm));
  PetscCall(MatSolve(p->factor, p->b, p->x));
  PetscFunctionReturn(0);
}

/* t = C x, or C D^-1 x */
static void gather(Projection *p, PetscBool weighted, const PetscReal *x)
{
  for (PetscInt k = 0; k < p->m; ++k) p->t[k] = 0;
  for (PetscInt k = 0; k < p->n_dofs; ++k) {
    const PetscReal v = p->place[k] < 0 ? 0 : x[p->place[k]] * (weighted ? p->inverse[k] : 1);
    for (PetscInt a = p->start[k]; a < p->start[k + 1] && p->place[k] >= 0; ++a) p->t[p->row[a]] += p->N[a] * v;
  }
}

/* x -= C^T lambda, or D^-1 C^T lambda */
static void scatter(const Projection *p, PetscBool weighted, PetscReal *x)
{
  for (PetscInt k = 0; k < p->n_dofs; ++k) {
    PetscReal sum = 0;
    if (p->place[k] < 0) continue;
    for (PetscInt a = p->start[k]; a < p->start[k + 1]; ++a) sum += p->N[a] * p->lambda[p->row[a]];
    x[p->place[k]] -= sum * (weighted ? p->inverse[k] : 1);
  }
}

PetscErrorCode ProjectionForces(Projection *p, PetscReal *r)
{
  PetscFunctionBeginUser;
  if (p->m == 0) PetscFunctionReturn(0);
  gather(p, PETSC_TRUE, r);
  PetscCall(SolveSchur(p));
  scatter(p, PETSC_FALSE, r);
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionMotion(Projection *p, PetscReal *z)
{
  PetscFunctionBeginUser;
  if (p->m == 0) PetscFunctionReturn(0);
  gather(p, PETSC_FALSE, z);
  PetscCall(SolveSchur(p));
  scatter(p, PETSC_TRUE, z);
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionCloseGaps(Projection *p, const PetscReal *f, PetscReal *y)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(y, p->system->n_active * p->system->dim));
  if (p->m == 0) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < p->m; ++k) p->t[k] = 0;
  for (PetscInt k = 0; k < p->n_own; ++k) p->t[p->first + k] = f[p->twin[k]] / p->scale;
  PetscCall(SolveSchur(p));
  scatter(p, PETSC_TRUE, y);
  PetscFunctionReturn(0);
}

PetscErrorCode ProjectionMultipliers(Projection *p, const PetscReal *r, PetscReal *y)
{
  PetscFunctionBeginUser;
  if (p->m == 0) PetscFunctionReturn(0);
  gather(p, PETSC_TRUE, r);
  PetscCall(SolveSchur(p));
  for (PetscInt k = 0; k < p->n_own; ++k) y[p->twin[k]] = -p->lambda[p->first + k] / p->scale;
  PetscFunctionReturn(0);
}
