#include "model/state/state.h"
#include "grid/search/directory.h"
#include "model/model_private.h"
#include "model/state/state_private.h"

/* Numbers of the model as a whole: one line each, for writing and reading. */
static const struct {
  const char *name, *unit;
  size_t offset;
} reals[] = {
  {"time", "s", offsetof(Model, time)},
  {"next_step", "s", offsetof(Model, control.next)},
  {"failed_step", "s", offsetof(Model, control.failed)},
  {"external_work", "J", offsetof(Model, external_work)},
  {"boundary_work", "J", offsetof(Model, boundary_work)},
  {"damped_energy", "J", offsetof(Model, damped_energy)},
  {"friction_energy", "J", offsetof(Model, friction_energy)},
  {"numerical_energy", "J", offsetof(Model, numerical_energy)},
  {"held_energy", "J", offsetof(Model, held_energy)},
  {"transfer_energy", "J", offsetof(Model, transfer_energy)},
  {"start_energy", "J", offsetof(Model, start_energy)},
};
static const struct {
  const char *name;
  size_t offset;
} counts[] = {
  {"step", offsetof(Model, step)},
  {"halvings", offsetof(Model, cuts)},
  {"iterations", offsetof(Model, total_iterations)},
  {"control_wait", offsetof(Model, control.wait)},
  {"control_patience", offsetof(Model, control.patience)},
  {"control_since", offsetof(Model, control.since)},
};
/* What the grid must be for the rest to mean anything: numbers of the grid as it was made. */
#define GRID_NUMBERS 9

static void grid_numbers(const Grid *grid, PetscReal number[GRID_NUMBERS])
{
  number[0] = (PetscReal)grid->n_cells_global;
  number[1] = (PetscReal)grid->n_nodes_global;
  number[2] = grid->smallest;
  for (PetscInt d = 0; d < 3; ++d) {
    number[3 + d] = d < grid->dim ? grid->min[d] : 0;
    number[6 + d] = d < grid->dim ? grid->max[d] : 0;
  }
}

static PetscErrorCode WholeToTables(Model *m, Tables *tables)
{
  Table *table;
  Column *column;
  NewtonMemory newton;

  PetscFunctionBeginUser;
  PetscCall(TablesAdd(tables, "model", PETSC_TRUE, 1, &table));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(reals); ++i)
    PetscCall(TableAdd(table, reals[i].name, reals[i].unit, COLUMN_REAL, 1, (char *)m + reals[i].offset, NULL));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(counts); ++i) {
    PetscCall(TableAdd(table, counts[i].name, NULL, COLUMN_INT64, 1, NULL, &column));
    *(PetscInt64 *)column->data = *(PetscInt *)((char *)m + counts[i].offset);
  }
  PetscCall(TableAdd(table, "grid", NULL, COLUMN_REAL, GRID_NUMBERS, NULL, &column));
  grid_numbers(m->grid, column->data);
  newton_get_memory(m->newton, m->system, &newton);
  PetscCall(TableAdd(table, "solver_courant", NULL, COLUMN_REAL, 1, NULL, &column));
  *(PetscReal *)column->data = newton.courant;
  PetscCall(TableAdd(table, "solver_failures", NULL, COLUMN_INT64, 1, NULL, &column));
  *(PetscInt64 *)column->data = newton.failures;
  PetscCall(TableAdd(table, "solver_steps_since", NULL, COLUMN_INT64, 1, NULL, &column));
  *(PetscInt64 *)column->data = newton.since;
  PetscCall(TableAdd(table, "solver_calm", NULL, COLUMN_INT64, 1, NULL, &column));
  *(PetscInt64 *)column->data = newton.calm;
  PetscCall(TablesAdd(tables, "measures", PETSC_TRUE, m->c->n_measures, &table));
  PetscCall(TableAdd(table, "kept", NULL, COLUMN_REAL, MEASURE_KEPT, NULL, &column));
  for (PetscInt k = 0; k < m->c->n_measures; ++k)
    PetscCall(PetscArraycpy((PetscReal *)column->data + k * MEASURE_KEPT, m->memory[k].kept, MEASURE_KEPT));
  PetscCall(TableAdd(table, "row_mean_time_given", NULL, COLUMN_REAL, ROW_MEAN, NULL, &column));
  for (PetscInt k = 0; k < m->c->n_measures; ++k) ((RowMean *)column->data)[k] = m->memory[k].row;
  PetscFunctionReturn(0);
}

static PetscErrorCode TriesToTables(const Model *m, Tables *tables)
{
  const PetscInt64 counts_now[] = {m->tries.again, m->tries.lost};
  Table *table;
  Column *column;

  PetscFunctionBeginUser;
  PetscCall(TablesAdd(tables, "tries", PETSC_TRUE, 1, &table));
  PetscCall(TableAdd(table, "again_lost", NULL, COLUMN_INT64, 2, NULL, &column));
  PetscCall(PetscArraycpy((PetscInt64 *)column->data, counts_now, 2));
  PetscFunctionReturn(0);
}

/* Which partition there is and how it came about; several ranks alone have one. */
static PetscErrorCode BalanceToTables(const Model *m, Tables *tables)
{
  const Balance *b = &m->balance;
  PetscMPIInt size;
  Table *table;
  Column *column;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(m->comm, &size));
  if (size == 1) PetscFunctionReturn(0);
  PetscCall(TablesAdd(tables, "balance", PETSC_TRUE, 1, &table));
  PetscCall(TableAdd(table, "largest", NULL, COLUMN_REAL, 1, (void *)&b->largest, NULL));
  PetscCall(TableAdd(table, "reached", NULL, COLUMN_REAL, 1, (void *)&b->reached, NULL));
  const PetscInt64 memory[] = {size, b->tried, b->repartitions};
  PetscCall(TableAdd(table, "ranks_tried_repartitions", NULL, COLUMN_INT64, 3, NULL, &column));
  for (int i = 0; i < 3; ++i) ((PetscInt64 *)column->data)[i] = memory[i];
  if (b->repartitions || !grid_starts_alike(m->grid)) PetscCall(GridPartitionToTable(m->grid, tables));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelToTables(Model *m, Tables *tables)
{
  PetscFunctionBeginUser;
  PetscCall(ModelInitialise(m));
  PetscCall(WholeToTables(m, tables));
  PetscCall(TriesToTables(m, tables));
  PetscCall(StateAnalysisToTables(m, tables));
  PetscCall(StateLostToTables(m, tables));
  PetscCall(StateListsToTables(m, tables));
  PetscCall(PointsToTable(m->points, m->grid, "points", tables));
  PetscCall(PointsToTable(m->tracers, m->grid, "tracers", tables));
  PetscCall(PointsToTable(m->loads->carriers, m->grid, "carriers", tables));
  PetscCall(ForcesToTables(m, tables));
  if (m->method->clouds) {
    PetscCall(StateCloudToTables(m, tables));
    PetscFunctionReturn(0);
  }
  const PetscBool increments = m->method->restores_grid || guess_follows(m);
  PetscCall(NodalFieldsToTables(m->nodes, !m->method->restores_grid, increments, tables));
  PetscCall(GuessToTables(m, tables));
  PetscCall(LetGoToTables(m, tables));
  PetscCall(BalanceToTables(m, tables));
  PetscCall(CellsToTable(m->grid, m->enabled, "pattern", tables));
  PetscFunctionReturn(0);
}

/* One number of a table that is everywhere. */
static PetscReal real_of(const Table *table, const char *name, char reason[256])
{
  const PetscReal *data = table_data(table, name, COLUMN_REAL, 1, reason);
  return data && table->rows == 1 ? *data : 0;
}

/* A count that a run can have reached, and can go on from; PETSC_MAX_INT stands for never. */
static PetscBool is_count(PetscInt64 value) { return (value >= 0 && value <= 1000000000) || value == PETSC_MAX_INT; }

static PetscInt count_of(const Table *table, const char *name, char reason[256])
{
  const PetscInt64 *data = table_data(table, name, COLUMN_INT64, 1, reason);
  const PetscInt64 value = data && table->rows == 1 ? *data : 0;
  if (!is_count(value)) snprintf(reason, 256, "%s/%s makes no sense", table->name, name);
  return (PetscInt)value;
}

/* Checkpoints of older programs did not count them. */
static void tries_from_table(Model *m, const Table *table, char reason[256])
{
  const PetscInt64 *kept = table ? table_data(table, "again_lost", COLUMN_INT64, 2, reason) : NULL;
  if (!kept) return;
  if (table->rows != 1 || !is_count(kept[0]) || !is_count(kept[1]))
    snprintf(reason, 256, "%s makes no sense", table->name);
  else m->tries = (Tries){.again = (PetscInt)kept[0], .lost = (PetscInt)kept[1]};
}

static void check_grid(const Model *m, const Table *table, char reason[256])
{
  PetscReal mine[GRID_NUMBERS];
  const PetscReal *kept = table_data(table, "grid", COLUMN_REAL, GRID_NUMBERS, reason);
  if (!kept) return;
  grid_numbers(m->grid, mine);
  for (int i = 0; i < GRID_NUMBERS; ++i)
    if (mine[i] != kept[i]) snprintf(reason, 256, "the grid of the case is not the one of the run");
}

static void whole_from_tables(Model *m, const Table *table, const Table *measures, char reason[256])
{
  if (table->rows != 1) snprintf(reason, 256, "%s has %d rows", table->name, (int)table->rows);
  if (measures->rows != m->c->n_measures) snprintf(reason, 256, "the measures of the case are not those of the run");
  if (reason[0]) return;
  check_grid(m, table, reason);
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(reals); ++i)
    *(PetscReal *)((char *)m + reals[i].offset) = real_of(table, reals[i].name, reason);
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(counts); ++i)
    *(PetscInt *)((char *)m + counts[i].offset) = count_of(table, counts[i].name, reason);
  if (!(m->time >= 0 && m->control.next > 0)) snprintf(reason, 256, "its time or step makes no sense");
  if (m->control.patience > STEP_WAIT_MOST || m->control.wait > STEP_WAIT_MOST || m->step > 1000000000)
    snprintf(reason, 256, "what its steps are chosen by makes no sense");
  const PetscReal *kept = table_data(measures, "kept", COLUMN_REAL, MEASURE_KEPT, reason);
  for (PetscInt k = 0; kept && k < m->c->n_measures * MEASURE_KEPT; ++k)
    m->memory[k / MEASURE_KEPT].kept[k % MEASURE_KEPT] = kept[k];
  const RowMean *row = table_data(measures, "row_mean_time_given", COLUMN_REAL, ROW_MEAN, reason);
  for (PetscInt k = 0; row && k < m->c->n_measures; ++k) m->memory[k].row = row[k];
}

static PetscErrorCode NodesBack(Model *m, const Tables *tables, char reason[256])
{
  PetscFunctionBeginUser;
  PetscCall(NodalFieldsFromTables(m->nodes, !m->method->restores_grid, tables, reason));
  guess_from_tables(m, tables, reason);
  PetscCall(LetGoFromTables(m, tables, reason));
  if (!reason[0]) PetscCall(ForcesFromTables(m, tables, reason));
  if (!reason[0]) PetscCall(CellsFromTable(m->grid, m->enabled, tables_find(tables, "pattern"), reason));
  PetscFunctionReturn(0);
}

static PetscErrorCode PointsBack(Model *m, const Tables *tables, char reason[256])
{
  const Case *c = m->c;

  PetscFunctionBeginUser;
  PetscCall(PointsFromTable(m->points, m->grid, tables_find(tables, "points"), c->n_bodies, c->n_materials, reason));
  if (reason[0]) PetscFunctionReturn(0);
  PetscCall(
    PointsFromTable(m->tracers, m->grid, tables_find(tables, "tracers"), c->n_measures, c->n_materials, reason));
  if (reason[0]) PetscFunctionReturn(0);
  PetscCall(
    PointsFromTable(m->loads->carriers, m->grid, tables_find(tables, "carriers"), c->n_loads, c->n_materials, reason));
  PetscFunctionReturn(0);
}

static NewtonMemory newton_memory(const Table *table, char reason[256])
{
  return (NewtonMemory){.courant = real_of(table, "solver_courant", reason),
                        .failures = count_of(table, "solver_failures", reason),
                        .since = count_of(table, "solver_steps_since", reason),
                        .calm = (PetscBool)(count_of(table, "solver_calm", reason) != 0)};
}

/* The partition as it was, where the ranks are as many; others share the grid as a new run does,
 * and anew if that is not good. */
static PetscErrorCode BalanceBack(Model *m, const Tables *tables, char reason[256])
{
  const Table *table = tables_find(tables, "balance"), *partition = tables_find(tables, "partition");
  Balance *b = &m->balance;
  PetscMPIInt size;
  PetscInt moved;
  Grid *grid;

  PetscFunctionBeginUser;
  if (!table) PetscFunctionReturn(0);
  const PetscInt64 *memory = table_data(table, "ranks_tried_repartitions", COLUMN_INT64, 3, reason);
  b->largest = real_of(table, "largest", reason);
  if (reason[0] || table->rows != 1) PetscFunctionReturn(0);
  if (!(memory[1] >= 0 && memory[1] <= m->step && is_count(memory[2])))
    snprintf(reason, 256, "%s makes no sense", table->name);
  if (reason[0]) PetscFunctionReturn(0);
  b->repartitions = (PetscInt)memory[2];
  PetscCallMPI(MPI_Comm_size(m->comm, &size));
  if (memory[0] != size) PetscFunctionReturn(0);
  b->reached = real_of(table, "reached", reason);
  b->tried = (PetscInt)memory[1];
  if (!partition || reason[0]) PetscFunctionReturn(0);
  PetscCall(GridFromPartition(m->grid, partition, &grid, reason));
  if (reason[0]) PetscFunctionReturn(0);
  PetscCall(ModelRegrid(m, grid, &moved));
  PetscCall(ModelInitialise(m)); /* what fem makes once, of points and nodes at the start */
  PetscFunctionReturn(0);
}

/* The pattern is that of the enabled cells, and the solver is chosen as it was. */
static PetscErrorCode SolverBack(Model *m, const Table *table, char reason[256])
{
  PetscInt local = 0, any;
  NewtonMemory newton = newton_memory(table, reason);

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < m->grid->n_cells; ++c) local += m->enabled[c];
  PetscCall(MPIU_Allreduce(&local, &any, 1, MPIU_INT, MPI_SUM, m->comm));
  if (any) PetscCall(ModelEnable(m));
  newton_set_memory(m->newton, m->system, &newton);
  PetscFunctionReturn(0);
}

/* All ranks know the same tables. */
static void check_tables(const Model *m, const Tables *tables, char reason[256])
{
  static const char *const always[] = {"model", "measures", "points", "tracers", "carriers", "pattern"};
  static const char *const of_cells[] = {"boundary", "nodes"}, *const of_clouds[] = {"nodes", "ghosts", "cloud",
                                                                                     "parts"};
  for (int i = 0; i < 6; ++i)
    if (!tables_find(tables, always[i])) snprintf(reason, 256, "%s is missing", always[i]);
  for (int i = 0; !m->method->clouds && i < (m->method->restores_grid ? 1 : 2); ++i)
    if (!tables_find(tables, of_cells[i])) snprintf(reason, 256, "%s is missing", of_cells[i]);
  for (int i = 0; m->method->clouds && i < 4; ++i)
    if (!tables_find(tables, of_clouds[i])) snprintf(reason, 256, "%s is missing", of_clouds[i]);
}

static PetscErrorCode CloudBack(Model *m, Tables *tables, char reason[256])
{
  PetscBool home;
  const Table *model = tables_find(tables, "model");

  PetscFunctionBeginUser;
  NewtonMemory newton = newton_memory(model, reason);
  PetscCall(StateCloudNodes(m, tables, &home, reason));
  if (!reason[0]) PetscCall(PointsBack(m, tables, reason));
  if (!reason[0]) PetscCall(StateCloudSettle(m, tables, home, reason));
  if (!reason[0]) PetscCall(ForcesFromTables(m, tables, reason));
  if (!reason[0]) newton_set_memory(m->newton, m->system, &newton);
  PetscFunctionReturn(0);
}

PetscErrorCode ModelFromTables(Model *m, Tables *tables, char reason[256])
{
  PetscFunctionBeginUser;
  reason[0] = 0;
  check_tables(m, tables, reason);
  if (reason[0]) PetscFunctionReturn(0);
  whole_from_tables(m, tables_find(tables, "model"), tables_find(tables, "measures"), reason);
  tries_from_table(m, tables_find(tables, "tries"), reason);
  PetscCall(StateAnalysisFromTables(m, tables, reason));
  state_lost_from_tables(m, tables, reason);
  PetscCall(StateListsFromTables(m, tables, reason));
  PetscCall(ReasonShare(m->comm, reason));
  if (m->method->clouds && !reason[0]) {
    PetscCall(CloudBack(m, tables, reason));
    PetscFunctionReturn(0);
  }
  if (!reason[0]) PetscCall(BalanceBack(m, tables, reason));
  if (!reason[0]) PetscCall(PointsBack(m, tables, reason));
  if (!reason[0]) PetscCall(NodesBack(m, tables, reason));
  if (reason[0]) PetscFunctionReturn(0);
  PetscCall(PointsSort(m->points));
  PetscCall(SolverBack(m, tables_find(tables, "model"), reason));
  PetscCall(ReasonShare(m->comm, reason));
  m->space->present = PETSC_FALSE;
  if (!reason[0]) PetscCall(ModelInitialise(m));
  if (!reason[0] && !m->method->restores_grid)
    PetscCall(DiscretisationMass(m->space)); /* of the points that came back */
  PetscFunctionReturn(0);
}

/* Steps are chosen anew in every stage. */
static PetscBool is_of_control(size_t offset)
{
  return offset >= offsetof(Model, control) && offset < offsetof(Model, control) + sizeof(StepControl);
}

PetscErrorCode StateGoOn(Model *m, const Tables *tables, char reason[256])
{
  const Table *table = tables_find(tables, "model"), *measures = tables_find(tables, "measures");

  PetscFunctionBeginUser;
  if (measures->rows != m->c->n_measures) snprintf(reason, 256, "the measures are others");
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(reals) && !reason[0]; ++i)
    if (!is_of_control(reals[i].offset))
      *(PetscReal *)((char *)m + reals[i].offset) = real_of(table, reals[i].name, reason);
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(counts) && !reason[0]; ++i)
    if (!is_of_control(counts[i].offset))
      *(PetscInt *)((char *)m + counts[i].offset) = count_of(table, counts[i].name, reason);
  if (reason[0]) PetscFunctionReturn(0);
  const PetscReal *kept = table_data(measures, "kept", COLUMN_REAL, MEASURE_KEPT, reason);
  for (PetscInt k = 0; kept && k < m->c->n_measures * MEASURE_KEPT; ++k)
    m->memory[k / MEASURE_KEPT].kept[k % MEASURE_KEPT] = kept[k];
  tries_from_table(m, tables_find(tables, "tries"), reason);
  state_initial_from_tables(m, tables, reason);
  state_lost_from_tables(m, tables, reason);
  PetscCall(StateListsFromTables(m, tables, reason));
  PetscFunctionReturn(0);
}

void state_check_grid(const Model *m, const Tables *tables, char reason[256])
{
  const Table *table = tables_find(tables, "model");
  if (table) check_grid(m, table, reason);
  else snprintf(reason, 256, "model is missing");
}
