/* The mass matrix of a MassSolve by rows of nodes: a number for each pair, since it is the same for every component.
 *
 * A sweep over rows costs what its nodes have neighbours, one over points what these have nodes, twice: with the 16
 * and 64 nodes of smooth functions ten times as much. To sum the rows up costs as much as a few sweeps over points. */
#include "method/transfer/mass.h"
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

/* row = that of node I in the matrix of group g. */
static void row_of_group(const Discretisation *s, PetscInt g, PetscInt I, PetscReal *row)
{
  const Support *w = s->support;
  const PetscInt nn = support_nodes(w, g);
  const PetscReal tie = mass_tie(s, g), lumping = mass_lumping(s, g), *N = w->N + w->value_start[g];
  PetscReal diagonal = tie;
  for (PetscInt J = 0; J < nn; ++J) row[J] = -tie / (PetscReal)nn;
  for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p, N += nn) {
    const PetscReal m = s->points->real[POINT_MASS][p] * N[I], shared = (1 - lumping) * m;
    if (m == 0) continue;
    diagonal += lumping * m;
    for (PetscInt J = 0; J < nn; ++J) row[J] += shared * N[J];
  }
  row[I] += diagonal;
}

static PetscErrorCode Reserve(MassRows *rows, PetscInt n)
{
  PetscFunctionBeginUser;
  if (n <= rows->room) PetscFunctionReturn(0);
  rows->room = PetscMax(n, 2 * rows->room);
  PetscCall(PetscRealloc((size_t)rows->room * sizeof *rows->column, &rows->column));
  PetscCall(PetscRealloc((size_t)rows->room * sizeof *rows->entry, &rows->entry));
  PetscFunctionReturn(0);
}

/* The row of a node, at the end of what there is; `at` tells of each node where the newest row has it. */
static PetscErrorCode AddRow(const Discretisation *s, const Sharers *sharers, PetscInt node, PetscInt *at,
                             MassRows *rows)
{
  const Support *w = s->support;
  const PetscInt begin = rows->start[node];
  PetscInt end = begin;
  PetscReal row[CLOUD_MAX_NODES];

  PetscFunctionBeginUser;
  for (PetscInt k = sharers->start[node]; k < sharers->start[node + 1]; ++k) {
    const PetscInt g = sharers->group[k], nn = support_nodes(w, g), *J = w->node + w->node_start[g];
    PetscCall(Reserve(rows, end + nn));
    row_of_group(s, g, sharers->place[k], row);
    for (PetscInt j = 0; j < nn; ++j) {
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

static PetscErrorCode ReserveNodes(MassRows *rows, PetscInt n)
{
  PetscFunctionBeginUser;
  if (n <= rows->nodes && rows->start) PetscFunctionReturn(0);
  rows->nodes = n;
  PetscCall(PetscFree(rows->start));
  PetscCall(PetscMalloc1(n + 1, &rows->start));
  PetscFunctionReturn(0);
}

PetscErrorCode MassRowsUpdate(const Discretisation *s, MassRows **rows)
{
  const PetscInt n = s->grid->n_nodes;
  Sharers sharers;
  PetscInt *at;

  PetscFunctionBeginUser;
  if (!*rows) PetscCall(PetscNew(rows));
  PetscCall(ReserveNodes(*rows, n));
  (*rows)->start[0] = 0;
  PetscCall(PetscMalloc1(n, &at));
  for (PetscInt node = 0; node < n; ++node) at[node] = -1;
  PetscCall(SharersCreate(s->support, n, &sharers));
  for (PetscInt node = 0; node < n; ++node) PetscCall(AddRow(s, &sharers, node, at, *rows));
  PetscCall(SharersDestroy(&sharers));
  PetscCall(PetscFree(at));
  (*rows)->known = PETSC_TRUE;
  PetscFunctionReturn(0);
}

void mass_rows_forget(MassRows *rows)
{
  if (rows) rows->known = PETSC_FALSE;
}

PetscErrorCode MassRowsDestroy(MassRows **rows)
{
  PetscFunctionBeginUser;
  if (!*rows) PetscFunctionReturn(0);
  PetscCall(PetscFree((*rows)->start));
  PetscCall(PetscFree((*rows)->column));
  PetscCall(PetscFree((*rows)->entry));
  PetscCall(PetscFree(*rows));
  PetscFunctionReturn(0);
}

/* By registers: the compiler would multiply number by number. */
UNROLLED void multiply(const PetscInt width, const PetscInt parts, const MassSolve *c, const PetscReal *x)
{
  const MassRows *rows = c->rows;
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
