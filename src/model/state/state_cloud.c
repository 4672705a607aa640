/* State of a cloud as tables: its nodes, ghosts, and the pattern that the system was made for. On
 * other ranks space is cut anew. */
#include "model/model_private.h"
#include "model/state/state_private.h"

/* Pairs of local nodes that the system couples; none if it no longer fits the nodes, and the next
 * step makes another one. */
static PetscErrorCode PatternToTable(const Model *m, Tables *tables)
{
  const System *s = m->system;
  const PetscBool fits = s->builds && m->layouts == m->grid->cloud->layouts;
  PetscInt rows = 0;
  Table *table;
  Column *column;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < s->n_nodes && fits; ++i)
    for (PetscInt k = s->row[i] < 0 ? 0 : s->row_start[s->row[i]]; s->row[i] >= 0 && k < s->row_start[s->row[i] + 1];
         ++k)
      rows += s->column[k] >= i;
  PetscCall(TablesAdd(tables, "pattern", PETSC_FALSE, rows, &table));
  PetscCall(TableAdd(table, "pair", NULL, COLUMN_INT32, 2, NULL, &column));
  int32_t *pair = column->data;
  for (PetscInt i = 0; i < s->n_nodes && rows; ++i)
    for (PetscInt k = s->row[i] < 0 ? 0 : s->row_start[s->row[i]]; s->row[i] >= 0 && k < s->row_start[s->row[i] + 1];
         ++k)
      if (s->column[k] >= i) {
        *pair++ = (int32_t)i;
        *pair++ = (int32_t)s->column[k];
      }
  PetscFunctionReturn(0);
}

PetscErrorCode StateCloudToTables(const Model *m, Tables *tables)
{
  Table *table;
  Column *column;

  PetscFunctionBeginUser;
  PetscCall(CloudToTables(m->grid, tables));
  PetscCall(PatternToTable(m, tables));
  PetscCall(TablesAdd(tables, "cloud", PETSC_TRUE, 1, &table));
  PetscCall(TableAdd(table, "balanced_ghosts", NULL, COLUMN_INT64, 1, NULL, &column));
  *(PetscInt64 *)column->data = m->grid->cloud->balanced_ghosts;
  PetscCall(PartsToTable(m->comm, tables));
  PetscFunctionReturn(0);
}

/* Each pair is a group. */
static PetscErrorCode Couple(Model *m, PetscInt n, const int32_t *pair)
{
  NodeGroups groups = {.n = n};

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n + 1, &groups.start, 2 * n, &groups.node));
  groups.start[0] = 0;
  for (PetscInt g = 0; g < n; ++g) {
    PetscInt end = groups.start[g];
    groups.node[end++] = pair[2 * g];
    if (pair[2 * g + 1] != pair[2 * g]) groups.node[end++] = pair[2 * g + 1];
    groups.start[g + 1] = end;
  }
  PetscCall(SystemBuild(m->system, m->grid, &groups));
  PetscCall(PetscFree2(groups.start, groups.node));
  PetscFunctionReturn(0);
}

static PetscErrorCode PatternBack(Model *m, const Table *table, char reason[256])
{
  const int32_t *pair = table_data(table, "pair", COLUMN_INT32, 2, reason);
  PetscInt n = (PetscInt)table->rows, any;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; pair && i < 2 * n; ++i)
    if (pair[i] < 0 || pair[i] >= m->grid->n_nodes) snprintf(reason, 256, "pattern/pair: there is no such node");
  PetscCall(ReasonShare(m->comm, reason));
  if (!pair || reason[0]) PetscFunctionReturn(0);
  PetscCall(MPIU_Allreduce(&n, &any, 1, MPIU_INT, MPI_MAX, m->comm));
  if (!any) PetscFunctionReturn(0);
  m->layouts = m->grid->cloud->layouts;
  PetscCall(Couple(m, n, pair));
  PetscFunctionReturn(0);
}

PetscErrorCode StateCloudNodes(Model *m, Tables *tables, PetscBool *home, char reason[256])
{
  PetscFunctionBeginUser;
  PetscCall(PartsTake(m->comm, tables, home, reason));
  if (!reason[0]) PetscCall(CloudFromTables(m->grid, tables, *home, reason));
  PetscFunctionReturn(0);
}

PetscErrorCode StateCloudSettle(Model *m, const Tables *tables, PetscBool home, char reason[256])
{
  const Table *cloud = tables_find(tables, "cloud");
  const PetscInt64 *ghosts = table_data(cloud, "balanced_ghosts", COLUMN_INT64, 1, reason);

  PetscFunctionBeginUser;
  if (ghosts && (cloud->rows != 1 || *ghosts < 0 || *ghosts > PETSC_MAX_INT))
    snprintf(reason, 256, "cloud/balanced_ghosts makes no sense");
  if (!reason[0] && home) PetscCall(PatternBack(m, tables_find(tables, "pattern"), reason));
  if (!reason[0] && !home) PetscCall(m->method->redistribute(m->space));
  if (reason[0]) PetscFunctionReturn(0);
  m->grid->cloud->balanced_ghosts = 0; /* nobody moves before the next step */
  m->space->present = PETSC_FALSE;
  PetscCall(ModelInitialise(m));
  m->grid->cloud->balanced_ghosts = home && ghosts ? (PetscInt)*ghosts : 0;
  PetscFunctionReturn(0);
}
