/* Nodes that a place which moves (boundary: `moves`) has let go are of no entry any more, but what it gave them is its
 * own: the force of the step that has ended, if somebody asks for it later, and that which the scheme remembers, and
 * which acts on in the step that begins (docs/theory.md, "Places that move"). */
#include "model/model_private.h"

static PetscBool has_moving_places(const Case *c)
{
  for (PetscInt k = 0; k < c->n_boundary; ++k)
    if (c->boundary[k].moves) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Of owned dofs that `entry` prescribed until now, to three numbers of each entry, those of the first one at `sum`. */
static void take(Model *m, const PetscInt *entry, PetscReal *force, PetscReal *sum)
{
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i) {
    if (entry[i] < 0 || entry[i] >= m->c->n_boundary || m->boundary->fixed[i]) continue;
    sum[entry[i] * LET_GO_NUMBERS + i % m->dim] += force[i];
    force[i] = 0;
  }
}

PetscErrorCode ModelMovePlaces(Model *m, PetscReal t)
{
  const PetscInt n = m->c->n_boundary, dofs = m->grid->n_nodes * m->dim;
  PetscInt *entry;
  LetGo *sum;

  PetscFunctionBeginUser;
  if (!has_moving_places(m->c)) PetscFunctionReturn(0);
  if (!m->let_go) PetscCall(PetscCalloc1(n, &m->let_go));
  PetscCall(PetscMalloc1(dofs, &entry));
  PetscCall(PetscCalloc1(n, &sum));
  PetscCall(PetscArraycpy(entry, m->boundary->entry, dofs));
  PetscCall(BoundaryMove(m->boundary, m->grid, t));
  take(m, entry, m->nodes->reaction, sum->reaction);
  take(m, entry, m->nodes->rate, sum->rate);
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, sum, (PetscMPIInt)(n * LET_GO_NUMBERS), MPIU_REAL, MPI_SUM, m->comm));
  for (PetscInt k = 0; k < n; ++k)
    for (int d = 0; d < 3; ++d) {
      m->let_go[k].reaction[d] += sum[k].reaction[d];
      m->let_go[k].rate[d] += sum[k].rate[d];
    }
  PetscCall(PetscFree(entry));
  PetscCall(PetscFree(sum));
  PetscFunctionReturn(0);
}

void let_go_settle(Model *m, const TimeWeights *w)
{
  for (PetscInt k = 0; m->let_go && k < m->c->n_boundary; ++k)
    for (int d = 0; d < 3; ++d) {
      const PetscReal before = m->let_go[k].rate[d], echo = -w->lag * before / (1 - w->lag);
      m->let_go[k].reaction[d] = (1 - w->mean) * before + w->mean * echo;
      m->let_go[k].rate[d] = echo;
    }
}

PetscErrorCode ModelReaction(const Model *m, PetscInt entry, PetscReal sum[3])
{
  PetscFunctionBeginUser;
  PetscCall(BoundarySum(m->boundary, m->grid, entry, m->nodes->reaction, sum));
  for (int d = 0; d < 3 && m->let_go; ++d) sum[d] += m->let_go[entry].reaction[d];
  PetscFunctionReturn(0);
}

PetscErrorCode LetGoToTables(const Model *m, Tables *tables)
{
  Table *table;

  PetscFunctionBeginUser;
  if (!m->let_go) PetscFunctionReturn(0);
  PetscCall(TablesAdd(tables, "let_go", PETSC_TRUE, m->c->n_boundary, &table));
  PetscCall(TableAdd(table, "force", "N", COLUMN_REAL, LET_GO_NUMBERS, m->let_go, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode LetGoFromTables(Model *m, const Tables *tables, char reason[256])
{
  const Table *table = tables_find(tables, "let_go");
  const PetscInt n = m->c->n_boundary;

  PetscFunctionBeginUser;
  if (!table || !has_moving_places(m->c)) PetscFunctionReturn(0); /* older programs had none */
  const PetscReal *force = table_data(table, "force", COLUMN_REAL, LET_GO_NUMBERS, reason);
  if (!force || reason[0]) PetscFunctionReturn(0);
  if (table->rows != n) snprintf(reason, 256, "%s has %d rows", table->name, (int)table->rows);
  if (reason[0]) PetscFunctionReturn(0);
  if (!m->let_go) PetscCall(PetscCalloc1(n, &m->let_go));
  PetscCall(PetscMemcpy(m->let_go, force, (size_t)n * sizeof *m->let_go));
  PetscFunctionReturn(0);
}
