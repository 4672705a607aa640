/* Points as a table, and back on any number of ranks: every field of points/fields.h, the cell by
 * its number in the whole grid. */
#include "base/count.h"
#include "grid/cloud/cloud.h"
#include "grid/search/directory.h"
#include "points/fields.h"
#include "points/migrate.h"
#include "points/onto.h"

static const struct {
  const char *name, *unit;
} reals[POINT_N_REAL] = {
  [POINT_X] = {"position", "m"},
  [POINT_U] = {"displacement", "m"},
  [POINT_V] = {"velocity", "m/s"},
  [POINT_A] = {"acceleration", "m/s2"},
  [POINT_MASS] = {"mass", "kg"},
  [POINT_VOLUME] = {"undeformed_volume", "m3"},
  [POINT_F] = {"deformation_gradient", NULL},
  [POINT_J] = {"volume_ratio", NULL},
  [POINT_TAU] = {"kirchhoff_stress", "Pa"},
  [POINT_WORK] = {"stress_work", "J"},
  [POINT_XI] = {"cell_position", NULL},
  [POINT_STATE] = {"state", NULL},
  [POINT_PRESSURE] = {"pressure", "Pa"},
  [POINT_FORCE] = {"force", "N"},
  [POINT_EDGE] = {"edge", "m"},
  [POINT_LEAN] = {"lean", "m"},
  [POINT_OVERHANG] = {"overhang", "m"},
  [POINT_DOMAIN] = {"domain", "m"},
  [POINT_SLOPE] = {"slope", NULL},
  [POINT_REACH] = {"reach", "m"},
  [POINT_CORNER] = {"corner", "m"},
  [POINT_BESIDE] = {"beside", NULL},
  [POINT_FACE] = {"face", "m2"},
  [POINT_CONTACT] = {"contact", "N"},
  [POINT_FIELD] = {"velocity_field", NULL},
  [POINT_SPACING] = {"spacing", "m"},
  [POINT_CARRIED] = {"carried", "m"},
  [POINT_FLOW] = {"flow", ""},
  [POINT_MECHANISM] = {"mechanism", "m/s"},
};

/* Points of a cloud remember the cell of their birth by this number already. */
static PetscInt global_cell(const Grid *grid, PetscInt cell)
{
  return cell < 0 || grid->cloud ? cell : grid->global_cell[cell];
}

PetscErrorCode PointsToTable(const Points *points, const Grid *grid, const char *name, Tables *tables)
{
  Table *table;
  Column *cell, *body, *material;

  PetscFunctionBeginUser;
  PetscCall(TablesAdd(tables, name, PETSC_FALSE, points->n, &table));
  PetscCall(TableAdd(table, "id", NULL, COLUMN_INT64, 1, points->n ? points->id : NULL, NULL));
  PetscCall(TableAdd(table, "cell", NULL, COLUMN_INT64, 1, NULL, &cell));
  PetscCall(TableAdd(table, "body", NULL, COLUMN_INT32, 1, NULL, &body));
  PetscCall(TableAdd(table, "material", NULL, COLUMN_INT32, 1, NULL, &material));
  for (PetscInt p = 0; p < points->n; ++p) {
    ((PetscInt64 *)cell->data)[p] = global_cell(grid, points->cell[p]);
    ((int32_t *)body->data)[p] = (int32_t)points->body[p];
    ((int32_t *)material->data)[p] = (int32_t)points->material[p];
  }
  for (int f = 0; f < POINT_N_REAL; ++f)
    if (points->components[f])
      PetscCall(TableAdd(table, reals[f].name, reals[f].unit, COLUMN_REAL, points->components[f],
                         points->n ? points->real[f] : NULL, NULL));
  PetscFunctionReturn(0);
}

/* In the checkpoints of older programs followers could not leave the grid, and points did not know the sides that they
 * stand beside. */
static PetscBool is_absent(const Table *table, int field)
{
  const PetscBool newer = (PetscBool)(field == POINT_OVERHANG || field == POINT_BESIDE);
  for (PetscInt k = 0; k < table->n && newer; ++k)
    if (!strcmp(table->column[k].name, reals[field].name)) return PETSC_FALSE;
  return newer;
}

/* This rank's rows of the table behind those in points; cells are still those of the whole grid. No
 * index is trusted. */
static PetscErrorCode TakeRows(Points *points, const Table *table, PetscInt n_cells, PetscInt n_bodies,
                               PetscInt n_materials, char reason[256])
{
  const PetscInt n = (PetscInt)table->rows, components = 1;
  const PetscInt64 *id = table_data(table, "id", COLUMN_INT64, components, reason),
                   *cell = table_data(table, "cell", COLUMN_INT64, components, reason);
  const int32_t *body = table_data(table, "body", COLUMN_INT32, components, reason),
                *material = table_data(table, "material", COLUMN_INT32, components, reason);

  PetscFunctionBeginUser;
  if (reason[0]) PetscFunctionReturn(0);
  PetscCall(PointsReserve(points, n));
  for (PetscInt p = 0; p < n; ++p) {
    if (cell[p] < -1 || cell[p] >= n_cells || body[p] < 0 || body[p] >= n_bodies || material[p] < 0 ||
        material[p] >= n_materials)
      snprintf(reason, 256, "%s: point %lld is in a cell or of a body that the case does not have", table->name,
               (long long)id[p]);
    points->id[p] = id[p];
    points->cell[p] = (PetscInt)cell[p];
    points->body[p] = body[p];
    points->material[p] = material[p];
  }
  for (int f = 0; f < POINT_N_REAL; ++f) {
    const PetscInt width = points->components[f];
    if (width && is_absent(table, f)) {
      if (n) PetscCall(PetscArrayzero(points->real[f], n * width));
      continue;
    }
    const PetscReal *data = width ? table_data(table, reals[f].name, COLUMN_REAL, width, reason) : NULL;
    if (data && n) PetscCall(PetscArraycpy(points->real[f], data, count_numbers(n, width)));
  }
  points->n = n;
  PetscFunctionReturn(0);
}

/* Width of a column of reals, 0 if there is none of the name. */
static PetscInt find_width(const Table *table, const char *name)
{
  for (PetscInt k = 0; k < table->n; ++k)
    if (!strcmp(table->column[k].name, name) && table->column[k].type == COLUMN_REAL)
      return table->column[k].components;
  return 0;
}

/* Rows row[0 .. n) of one field, as wide as they fit. */
static void take_field(Points *points, int f, const Table *table, PetscInt n, const PetscInt *row, char reason[256])
{
  const PetscInt width = points->components[f], has = find_width(table, reals[f].name), both = PetscMin(width, has);
  const PetscReal *data = has ? table_data(table, reals[f].name, COLUMN_REAL, has, reason) : NULL;
  for (PetscInt p = 0; p < n; ++p)
    for (PetscInt i = 0; i < width; ++i) {
      PetscReal *to = points->real[f] + (size_t)p * (size_t)width + i;
      *to = data && i < both ? data[(size_t)row[p] * (size_t)has + (size_t)i] : 0;
    }
}

/* Rows whose bodies are still there; no index is trusted. */
static PetscErrorCode TakeChanged(Points *points, const Table *table, PetscInt n_cells, const PointsChange *change,
                                  char reason[256])
{
  const PetscInt64 *id = table_data(table, "id", COLUMN_INT64, 1, reason),
                   *cell = table_data(table, "cell", COLUMN_INT64, 1, reason);
  const int32_t *body = table_data(table, "body", COLUMN_INT32, 1, reason),
                *material = table_data(table, "material", COLUMN_INT32, 1, reason);
  PetscInt n = 0, *row;

  PetscFunctionBeginUser;
  if (reason[0]) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(table->rows, &row));
  for (PetscInt r = 0; r < table->rows && !reason[0]; ++r) {
    if (cell[r] < -1 || cell[r] >= n_cells || body[r] < 0 || body[r] >= change->n_bodies || material[r] < 0 ||
        material[r] >= change->n_materials)
      snprintf(reason, 256, "%s: point %lld is in a cell or of a body that the case does not have", table->name,
               (long long)id[r]);
    else if (change->body[body[r]] >= 0) row[n++] = r;
  }
  points->n = 0;
  PetscCall(PointsReserve(points, n));
  for (PetscInt p = 0; p < n; ++p) {
    points->id[p] = id[row[p]];
    points->cell[p] = (PetscInt)cell[row[p]];
    points->body[p] = change->body[body[row[p]]];
    points->material[p] = material[row[p]];
  }
  for (int f = 0; f < POINT_N_REAL; ++f) take_field(points, f, table, n, row, reason);
  points->n = n;
  PetscCall(PetscFree(row));
  PetscFunctionReturn(0);
}

/* Every point to the rank that has its cell; a lost one stays where it is. */
static PetscErrorCode SendHome(Points *points, const Grid *grid, const char *name, char reason[256])
{
  const PetscInt n = points->n;
  DirectoryPlace *place;
  Leavers leavers = {.n = n};
  PetscBool *gone;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n, &place, n, &gone, n, &leavers.point));
  PetscCall(PetscMalloc1(n, &leavers.owner));
  PetscCall(DirectoryFind(grid->comm, grid->n_cells_global, grid->n_cells, grid->global_cell, n, points->cell, place));
  for (PetscInt p = 0; p < n; ++p) {
    if (points->cell[p] >= 0 && place[p].rank < 0)
      snprintf(reason, 256, "%s: no rank has cell %d", name, (int)points->cell[p]);
    points->cell[p] = place[p].index;
    leavers.point[p] = p;
    leavers.owner[p] = (PetscMPIInt)place[p].rank;
    gone[p] = place[p].rank >= 0;
  }
  PetscCall(ReasonShare(grid->comm, reason));
  if (!reason[0]) PetscCall(LeaversMove(&leavers, points, grid, gone));
  PetscCall(PetscFree(leavers.owner));
  PetscCall(PetscFree3(place, gone, leavers.point));
  PetscFunctionReturn(0);
}

/* Points of a cloud know the cells that it left, and which rank they are on is told by its parts. */
static PetscInt cells_of(const Grid *grid) { return grid->cloud ? grid->cloud->n_cells_left : grid->n_cells_global; }

PetscErrorCode PointsFromTable(Points *points, const Grid *grid, const Table *table, PetscInt n_bodies,
                               PetscInt n_materials, char reason[256])
{
  PetscFunctionBeginUser;
  PetscCall(TakeRows(points, table, cells_of(grid), n_bodies, n_materials, reason));
  PetscCall(ReasonShare(grid->comm, reason));
  if (!reason[0] && !grid->cloud) PetscCall(SendHome(points, grid, table->name, reason));
  PetscFunctionReturn(0);
}

PetscErrorCode PointsTake(Points *points, const Grid *grid, const Table *table, const PointsChange *change,
                          char reason[256])
{
  PetscFunctionBeginUser;
  PetscCall(TakeChanged(points, table, cells_of(grid), change, reason));
  PetscCall(ReasonShare(grid->comm, reason));
  if (!reason[0] && !grid->cloud) PetscCall(SendHome(points, grid, table->name, reason));
  PetscFunctionReturn(0);
}

PetscErrorCode PointsTakeOnto(Points *points, const Grid *grid, const Table *table, const PointsChange *change,
                              char reason[256])
{
  LostPoint *lost = NULL;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCall(TakeChanged(points, table, PETSC_MAX_INT, change, reason));
  PetscCall(ReasonShare(grid->comm, reason));
  if (reason[0]) PetscFunctionReturn(0);
  for (PetscInt p = 0; p < points->n; ++p) points->cell[p] = -1;
  PetscCall(PointsRelocate(points, grid, OUTSIDE_STOP, &n, &lost));
  if (n)
    snprintf(reason, 256, "%d of its points are outside of the grid, as is the one at (%g, %g, %g) m", (int)n,
             (double)lost->x[0], (double)lost->x[1], (double)lost->x[2]);
  PetscCall(PetscFree(lost));
  PetscFunctionReturn(0);
}

PetscErrorCode PointsSetState(Points *points, PetscInt n_state)
{
  const PetscInt before = points->components[POINT_STATE], both = PetscMin(before, n_state);
  PetscReal *state;

  PetscFunctionBeginUser;
  if (before == n_state) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(count_numbers(PetscMax(points->capacity, 1), n_state), &state));
  for (PetscInt p = 0; p < points->n; ++p)
    PetscCall(PetscArraycpy(state + count_numbers(p, n_state), point_real(points, POINT_STATE, p), both));
  PetscCall(PetscFree(points->real[POINT_STATE]));
  points->real[POINT_STATE] = state;
  points->components[POINT_STATE] = n_state;
  PetscFunctionReturn(0);
}

PetscErrorCode PointsCopy(const Points *points, const PetscBool *take, Points *to)
{
  PetscInt n = 0, *index;
  char *buffer;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(points->n, &index));
  for (PetscInt p = 0; p < points->n; ++p)
    if (take[p]) index[n++] = p;
  PetscCall(PetscMalloc1((size_t)n * points_bytes(points), &buffer));
  points_pack(points, n, index, buffer);
  PetscCall(PointsUnpack(to, n, buffer));
  PetscCall(PetscFree(buffer));
  PetscCall(PetscFree(index));
  PetscFunctionReturn(0);
}
