/* The mass matrix of a MassSolve by rows of nodes: a number for each pair, since it is the same for every component.
 *
 * A sweep over rows costs what its nodes have neighbours, one over points what these have nodes, twice: with the 16
 * and 64 nodes of smooth functions ten times as much. To sum the rows up costs as much as a few sweeps over points. */
#include "method/transfer/lines.h"
#include "method/transfer/loops.h"

/* Which groups have a node, and as which of theirs. */
typedef struct {
  PetscInt *start, *group, *place;
} Sharers;

static PetscErrorCode SharersCreate(const Support *w, PetscInt n_nodes, Sharers *s)
{
  const PetscInt n = w->node_start[w->n_groups];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n_nodes + 2, &s->start));
  PetscCall(PetscMalloc2(n, &s->group, n, &s->place));
  for (PetscInt i = 0; i < n; ++i) ++s->start[w->node[i] + 2];
  for (PetscInt node = 0; node < n_nodes; ++node) s->start[node + 2] += s->start[node + 1];
  for (PetscInt g = 0; g < w->n_groups; ++g)
    for (PetscInt i = w->node_start[g]; i < w->node_start[g + 1]; ++i) {
      const PetscInt k = s->start[w->node[i] + 1]++;
      s->group[k] = g, s->place[k] = i - w->node_start[g];
    }
  PetscFunctionReturn(0);
}

static PetscErrorCode SharersDestroy(Sharers *s)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(s->start));
  PetscCall(PetscFree2(s->group, s->place));
  PetscFunctionReturn(0);
}

/* row = that of node I in the matrix of group g, from I on: the rest is the image of other rows. */
static void row_of_group(const Discretisation *s, PetscInt g, PetscInt I, PetscReal *row)
{
  const Support *w = s->support;
  const PetscInt nn = support_nodes(w, g);
  const PetscReal tie = mass_tie(s, g), lumping = mass_lumping(s, g), *N = w->N + w->value_start[g];
  PetscReal diagonal = tie;
  for (PetscInt J = I; J < nn; ++J) row[J] = -tie / (PetscReal)nn;
  for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p, N += nn) {
    const PetscReal m = s->points->real[POINT_MASS][p] * N[I], shared = (1 - lumping) * m;
    if (m == 0) continue;
    diagonal += lumping * m;
    for (PetscInt J = I; J < nn; ++J) row[J] += shared * N[J];
  }
  row[I] += diagonal;
}

static PetscErrorCode Reserve(MassPairs *rows, PetscInt n)
{
  PetscFunctionBeginUser;
  if (n <= rows->room) PetscFunctionReturn(0);
  rows->room = PetscMax(n, 2 * rows->room);
  PetscCall(PetscRealloc((size_t)rows->room * sizeof *rows->column, &rows->column));
  PetscCall(PetscRealloc((size_t)rows->room * sizeof *rows->entry, &rows->entry));
  PetscFunctionReturn(0);
}

/* Half the row of a node, itself first, at the end of what there is; `at` tells of each node where the newest row has
 * it. */
static PetscErrorCode AddRow(const Discretisation *s, const Sharers *sharers, PetscInt node, PetscInt *at,
                             MassPairs *rows)
{
  const Support *w = s->support;
  const PetscInt begin = rows->start[node];
  PetscInt end = begin + 1;
  PetscReal row[CLOUD_MAX_NODES];

  PetscFunctionBeginUser;
  PetscCall(Reserve(rows, end));
  at[node] = begin;
  rows->column[begin] = node, rows->entry[begin] = 0;
  for (PetscInt k = sharers->start[node]; k < sharers->start[node + 1]; ++k) {
    const PetscInt g = sharers->group[k], nn = support_nodes(w, g), *J = w->node + w->node_start[g];
    PetscCall(Reserve(rows, end + nn));
    row_of_group(s, g, sharers->place[k], row);
    for (PetscInt j = sharers->place[k]; j < nn; ++j) {
      if (row[j] == 0) continue;
      if (at[J[j]] < begin) {
        at[J[j]] = end;
        rows->column[end] = J[j], rows->entry[end++] = 0;
      }
      rows->entry[at[J[j]]] += row[j];
    }
  }
  rows->start[node + 1] = end;
  PetscFunctionReturn(0);
}

/* Half the rows. */
static PetscErrorCode SumHalf(const Discretisation *s, MassPairs *half)
{
  const PetscInt n = s->grid->n_nodes;
  Sharers sharers;
  PetscInt *at;

  PetscFunctionBeginUser;
  if (!half->start) PetscCall(PetscMalloc1(n + 1, &half->start));
  half->start[0] = 0;
  PetscCall(PetscMalloc1(n, &at));
  for (PetscInt node = 0; node < n; ++node) at[node] = -1;
  PetscCall(SharersCreate(s->support, n, &sharers));
  for (PetscInt node = 0; node < n; ++node) PetscCall(AddRow(s, &sharers, node, at, half));
  PetscCall(SharersDestroy(&sharers));
  PetscCall(PetscFree(at));
  PetscFunctionReturn(0);
}

static void put(MassPairs *whole, PetscInt k, PetscInt column, PetscReal entry)
{
  whole->column[k] = column;
  whole->entry[k] = entry;
}

/* Each pair in the rows of both its nodes. */
static PetscErrorCode Unfold(const MassPairs *half, PetscInt n, MassPairs *whole)
{
  PetscFunctionBeginUser;
  if (!whole->start) PetscCall(PetscMalloc1(n + 1, &whole->start));
  PetscCall(PetscArrayzero(whole->start, n + 1));
  PetscInt *next = whole->start + 1; /* of a row: where its next entry goes; at last where it ends */
  for (PetscInt node = 0; node < n; ++node)
    for (PetscInt k = half->start[node]; k < half->start[node + 1]; ++k) {
      if (node + 1 < n) next[node + 1] += 1;
      if (k > half->start[node] && half->column[k] + 1 < n) next[half->column[k] + 1] += 1;
    }
  for (PetscInt node = 1; node < n; ++node) next[node] += next[node - 1];
  PetscCall(Reserve(whole, 2 * half->start[n] - n));
  for (PetscInt node = 0; node < n; ++node)
    for (PetscInt k = half->start[node]; k < half->start[node + 1]; ++k) {
      const PetscInt other = half->column[k];
      put(whole, next[node]++, other, half->entry[k]);
      if (other != node) put(whole, next[other]++, node, half->entry[k]);
    }
  PetscFunctionReturn(0);
}

PetscErrorCode MassRowsUpdate(const Discretisation *s, MassRows **rows)
{
  PetscFunctionBeginUser;
  if (!*rows) PetscCall(PetscNew(rows));
  PetscCall(SumHalf(s, &(*rows)->half));
  PetscCall(Unfold(&(*rows)->half, s->grid->n_nodes, &(*rows)->whole));
  if (mass_lines_work(s)) {
    if (!(*rows)->lines) PetscCall(MassLinesCreate(s->grid, &(*rows)->lines));
    PetscCall(MassLinesUpdate(s->grid, &(*rows)->half, (*rows)->lines));
  }
  (*rows)->known = PETSC_TRUE;
  PetscFunctionReturn(0);
}

void mass_rows_forget(MassRows *rows)
{
  if (rows) rows->known = PETSC_FALSE;
}

static PetscErrorCode Free(MassPairs *pairs)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(pairs->start));
  PetscCall(PetscFree(pairs->column));
  PetscCall(PetscFree(pairs->entry));
  PetscFunctionReturn(0);
}

PetscErrorCode MassRowsDestroy(MassRows **rows)
{
  PetscFunctionBeginUser;
  if (!*rows) PetscFunctionReturn(0);
  PetscCall(MassLinesDestroy(&(*rows)->lines));
  PetscCall(Free(&(*rows)->half));
  PetscCall(Free(&(*rows)->whole));
  PetscCall(PetscFree(*rows));
  PetscFunctionReturn(0);
}

/* By registers: the compiler would multiply number by number. */
UNROLLED void multiply(const PetscInt width, const PetscInt parts, const MassSolve *c, const PetscReal *x)
{
  const MassPairs *rows = &c->rows->whole;
  for (PetscInt i = 0; i < c->n_reached; ++i) {
    const PetscInt node = c->reached[i];
    Four sum[2] = {{0, 0, 0, 0}, {0, 0, 0, 0}};
    for (PetscInt k = rows->start[node]; k < rows->start[node + 1]; ++k)
      for (PetscInt part = 0; part < parts; ++part)
        sum[part] += rows->entry[k] * take(part, width, x + rows->column[k] * width);
    for (PetscInt d = 0; d < width; ++d) c->product[node * width + d] = sum[d / 4][d % 4];
  }
}

void mass_rows_multiply(const MassSolve *c, const PetscReal *x)
{
  if (c->width == 4) multiply(4, 1, c, x);
  else if (c->alone) multiply(6, 1, c, x);
  else multiply(6, 2, c, x);
}
