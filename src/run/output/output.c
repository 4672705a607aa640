#include "run/output/output_private.h"
#include <unistd.h>
#include "base/count.h"
#include "case/fields.h"
#include "grid/cloud/cloud.h"
#include "material/algebra/invariants.h"
#include "output/directory/run_dir_files.h"

#define NOT_WRITTEN (-2) /* bytes of a file that a state does not have: another stage of the run has it */

/* Files of one state: of its points and, if the case asks, of its grid. */
typedef struct {
  FileSeal points, grid;
} StateSeals;

struct Output {
  const char *folder;
  PetscInt count, capacity; /* states written */
  StateSeals *seals;        /* of each */
  PetscBool grid;           /* do states have files of the grid? */
  PetscReal *x0;            /* node positions at the start */
  PetscInt resumed;         /* step at which a resumed run began; -1: none */
};

PetscErrorCode OutputCreate(const Model *m, const char *folder, Output **output)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(output));
  (*output)->folder = folder;
  (*output)->grid = m->c->output.grid;
  (*output)->resumed = -1;
  PetscCall(PetscMalloc1(count_numbers(m->grid->n_nodes, m->dim), &(*output)->x0));
  PetscCall(PetscArraycpy((*output)->x0, m->grid->x, count_numbers(m->grid->n_nodes, m->dim)));
  PetscFunctionReturn(0);
}

void output_set_folder(Output *output, const char *folder) { output->folder = folder; }

void output_resumed_at(Output *output, PetscInt step) { output->resumed = step; }

static void state_file(const char *name, PetscInt number, char file[64])
{
  snprintf(file, 64, "%s_%06d.hdf", name, (int)number);
}

PetscErrorCode OutputKeep(const Output *o, const Model *m, const char *name, PetscBool *kept, PetscBool *ok,
                          char reason[256])
{
  char file[64], path[PETSC_MAX_PATH_LEN];
  PetscInt there;

  PetscFunctionBeginUser;
  state_file(name, o->count, file);
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/%s", o->folder, file));
  there = m->step == o->resumed && !access(path, R_OK);
  PetscCallMPI(MPI_Bcast(&there, 1, MPIU_INT, 0, m->comm));
  *kept = (PetscBool)there;
  if (there && VtkSeriesAppend(m->comm, o->folder, name, file, m->time, reason)) *ok = PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode OutputDestroy(Output **output)
{
  PetscFunctionBeginUser;
  if (!*output) PetscFunctionReturn(0);
  PetscCall(PetscFree((*output)->x0));
  PetscCall(PetscFree((*output)->seals));
  PetscCall(PetscFree(*output));
  PetscFunctionReturn(0);
}

/* Copy n x dim into n x 3. */
static void widen(PetscInt n, PetscInt dim, const PetscReal *from, PetscReal *to)
{
  for (PetscInt i = 0; i < n; ++i, from += dim, to += 3)
    for (PetscInt d = 0; d < 3; ++d) to[d] = d < dim ? from[d] : 0;
}

/* Invariants of the stress; PETSC_FALSE if the field is none. */
static PetscBool stress_number(const char *name, const PetscReal sigma[6], PetscReal *out)
{
  if (!strcmp(name, "pressure")) *out = stress_pressure(sigma);
  else if (!strcmp(name, "mises")) *out = stress_deviatoric(sigma);
  else if (!strcmp(name, "mobilised_friction")) *out = stress_mobilised_friction(sigma) * 180 / PETSC_PI;
  else return PETSC_FALSE;
  return PETSC_TRUE;
}

static PetscBool is_strain(const char *name) { return !strcmp(name, "strain") || !strcmp(name, "deviatoric_strain"); }

static void strain_numbers(const Points *points, PetscInt p, const char *name, PetscReal *out)
{
  PetscReal F[9], strain[6];
  point_F(points, p, F);
  strain_logarithmic(F, strain);
  if (strcmp(name, "strain") != 0) *out = strain_deviatoric(strain);
  else
    for (int k = 0; k < 6; ++k) out[k] = strain[k];
}

/* One field of one point, n numbers. */
static PetscErrorCode PointValue(const Model *m, PetscInt p, const char *name, PetscInt n, PetscReal *out)
{
  const Points *points = m->points;
  PetscReal sigma[6], F[9];

  PetscFunctionBeginUser;
  const PetscReal volume = points->real[POINT_J][p] * points->real[POINT_VOLUME][p];
  PetscCall(ModelPointStress(m, p, sigma));
  if (!strcmp(name, "stress")) PetscCall(PetscArraycpy(out, sigma, 6));
  else if (stress_number(name, sigma, out)) PetscFunctionReturn(0);
  else if (is_strain(name)) strain_numbers(points, p, name, out);
  else if (!strcmp(name, "volume_strain")) *out = PetscLogReal(points->real[POINT_J][p]);
  else if (!strcmp(name, "deformation_gradient")) {
    point_F(points, p, F);
    PetscCall(PetscArraycpy(out, F, 9));
  } else if (!strcmp(name, "mass")) *out = points->real[POINT_MASS][p];
  else if (!strcmp(name, "volume")) *out = volume;
  else if (!strcmp(name, "plastic_increment"))
    *out = points->components[POINT_FLOW] ? points->real[POINT_FLOW][p] : 0; /* kept where it is written */
  else if (!strcmp(name, "contact_force")) contact_force_on(m, p, out);
  else if (!strcmp(name, "density")) *out = points->real[POINT_MASS][p] / volume;
  else if (!strcmp(name, "energy")) *out = model_point_energy(m, p);
  else if (!strcmp(name, "body")) *out = (PetscReal)points->body[p];
  else if (!strcmp(name, "material")) *out = (PetscReal)points->material[p];
  else {
    const PetscReal *state = model_state_field(m, p, name);
    for (PetscInt k = 0; k < n; ++k) out[k] = state ? state[k] : 0;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode OutputPointField(const Model *m, const OutputField *field, PetscReal *data)
{
  const PetscInt n = m->points->n, k = field->components;

  PetscFunctionBeginUser;
  if (!strcmp(field->name, "displacement")) widen(n, m->dim, m->points->real[POINT_U], data);
  else if (!strcmp(field->name, "velocity")) widen(n, m->dim, m->points->real[POINT_V], data);
  else if (!strcmp(field->name, "mechanism") && m->points->components[POINT_MECHANISM])
    widen(n, m->dim, m->points->real[POINT_MECHANISM], data);
  else if (!strcmp(field->name, "acceleration")) widen(n, m->dim, m->points->real[POINT_A], data);
  else
    for (PetscInt p = 0; p < n; ++p) PetscCall(PointValue(m, p, field->name, k, data + count_numbers(p, k)));
  PetscFunctionReturn(0);
}

/* Rank 0 looks at the file that has just been written, all know its seal. */
static PetscErrorCode Seal(MPI_Comm comm, const char *path, FileSeal *seal)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (!rank && file_seal(path, seal))
    *seal = (FileSeal){.bytes = -1}; /* what cannot be read now is for the resumed run to tell */
  PetscCallMPI(MPI_Bcast(seal, (PetscMPIInt)sizeof *seal, MPI_BYTE, 0, comm));
  PetscFunctionReturn(0);
}

/* Put the file in place and enter it in its series. */
PetscErrorCode OutputState(Output *o, MPI_Comm comm, const char *name, const VtkData *data, FileSeal *seal,
                           PetscBool *ok, char reason[256])
{
  char file[64], path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  state_file(name, o->count, file);
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/%s", o->folder, file));
  PetscErrorCode code = VtkWrite(comm, path, data, reason);
  if (!code) {
    code = VtkSeriesAppend(comm, o->folder, name, file, data->time, reason);
    if (code) unlink(path); /* a state that no series names would be found by nobody */
  }
  if (code) *ok = PETSC_FALSE;
  else if (seal) PetscCall(Seal(comm, path, seal));
  PetscFunctionReturn(0);
}

static PetscErrorCode WritePoints(Output *o, Model *m, PetscBool *ok, char reason[256])
{
  const PetscInt n_frames = walls_with_mass(m->c);
  VtkField fields[OUTPUT_FIELDS_MOST];
  PetscReal *data[OUTPUT_FIELDS_MOST], *x, *frames;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(12 * n_frames, &frames));
  if (n_frames) walls_get_frames(m->walls, frames);
  PetscCall(PetscMalloc1(count_numbers(m->points->n, 3), &x));
  widen(m->points->n, m->dim, m->points->real[POINT_X], x);
  for (const OutputField *f = output_fields; f->name; ++f) {
    if (!f->points || !strcmp(f->name, "id") || !case_writes(m->c, f->name)) continue;
    PetscCall(PetscMalloc1(count_numbers(m->points->n, f->components), &data[n]));
    PetscCall(OutputPointField(m, f, data[n]));
    fields[n] = (VtkField){.name = f->name, .unit = f->unit, .components = f->components, .data = data[n]};
    ++n;
  }
  const VtkData vtk = {.n_points = m->points->n,
                       .x = x,
                       .n_cells = m->points->n,
                       .nodes_per_cell = 1,
                       .vtk_type = 1,
                       .n_point_fields = n,
                       .point_fields = fields,
                       .point_id = m->points->id,
                       .time = m->time,
                       .stage = m->c->staged ? m->c->stage + 1 : 0,
                       .n_frames = n_frames,
                       .frames = frames};
  PetscCall(OutputState(o, m->comm, "points", &vtk, &o->seals[o->count].points, ok, reason));
  for (PetscInt f = 0; f < n; ++f) PetscCall(PetscFree(data[f]));
  PetscCall(PetscFree(x));
  PetscCall(PetscFree(frames));
  PetscFunctionReturn(0);
}

/* Mean over the points that a node sees, by mass. What a restored grid took from them by the matrix of
 * the balance is nothing to look at: nodes that they hardly reach may have any motion, 1e20 m/s of which
 * no point sees anything. */
static PetscErrorCode MeanByMass(const Model *m, int field, PetscReal *u)
{
  const PetscInt dim = m->dim, dofs = m->grid->n_nodes * dim;
  const Support *w = m->space->support;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(u, dofs));
  for (PetscInt g = 0; g < w->n_groups; ++g) {
    const PetscInt nn = support_nodes(w, g), *node = w->node + w->node_start[g];
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p)
      for (PetscInt i = 0; i < nn * dim; ++i)
        u[node[i / dim] * dim + i % dim] +=
          support_N(w, g, p)[i / dim] * m->points->real[POINT_MASS][p] * point_real(m->points, field, p)[i % dim];
  }
  PetscCall(GridSumToOwners(m->grid, dim, u));
  PetscCall(GridToGhosts(m->grid, dim, u));
  for (PetscInt i = 0; i < dofs; ++i) u[i] = m->nodes->mass[i / dim] > 1e-300 ? u[i] / m->nodes->mass[i / dim] : 0;
  PetscFunctionReturn(0);
}

/* The field of points that says how a node moves; -1: the name is of something else. */
static int motion_field(const char *name)
{
  if (!strcmp(name, "displacement")) return POINT_U;
  if (!strcmp(name, "velocity")) return POINT_V;
  return strcmp(name, "acceleration") != 0 ? -1 : POINT_A;
}

/* Motion of nodes: their own where the mesh moves, the points' mean where it does not. */
static PetscErrorCode NodalMotion(const Output *o, const Model *m, int field, PetscReal *data)
{
  const PetscInt dofs = m->grid->n_nodes * m->dim;
  const PetscReal *x0 = m->grid->cloud ? m->grid->cloud->x0 : m->drawn ? m->drawn : o->x0;
  PetscReal *u;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(dofs, &u));
  if (m->method->restores_grid) PetscCall(MeanByMass(m, field, u));
  else if (field == POINT_U)
    for (PetscInt i = 0; i < dofs; ++i) u[i] = m->grid->x[i] - x0[i];
  else PetscCall(PetscArraycpy(u, field == POINT_V ? m->nodes->v : m->nodes->a, dofs));
  widen(m->grid->n_nodes, m->dim, u, data);
  PetscCall(PetscFree(u));
  PetscFunctionReturn(0);
}

/* What nodes know by themselves; of all else they have the mean of the points. */
static PetscErrorCode GridField(const Output *o, const Model *m, const OutputField *field, PetscReal **data)
{
  const PetscInt n = m->grid->n_nodes;
  const int motion = motion_field(field->name);
  PetscReal *u;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(count_numbers(n, field->components), data));
  if (motion >= 0) PetscCall(NodalMotion(o, m, motion, *data));
  else if (!strcmp(field->name, "mass")) PetscCall(PetscArraycpy(*data, m->nodes->mass, n));
  else if (!strcmp(field->name, "pressure") && m->nodes->scaled_pressure)
    for (PetscInt i = 0; i < n; ++i) (*data)[i] = -m->nodes->pressure[i];
  else {
    PetscCall(PetscMalloc1(count_numbers(m->points->n, field->components), &u));
    PetscCall(OutputPointField(m, field, u));
    PetscCall(OutputNodalAverage(m, field->components, u, *data));
    PetscCall(PetscFree(u));
  }
  PetscFunctionReturn(0);
}

/* Nodes of a cloud, each on its owner, as vertices. */
static PetscErrorCode WriteCloud(const Grid *grid, VtkData *vtk, PetscInt n, VtkField *fields)
{
  PetscInt kept = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < grid->n_owned; ++i) {
    if (cloud_is_twin(grid, i)) continue;
    PetscCall(PetscArraymove((PetscReal *)vtk->x + count_numbers(kept, 3), vtk->x + count_numbers(i, 3), 3));
    for (PetscInt f = 0; f < n; ++f) {
      const PetscInt k = fields[f].components;
      PetscCall(
        PetscArraymove((PetscReal *)fields[f].data + count_numbers(kept, k), fields[f].data + count_numbers(i, k), k));
    }
    ++kept;
  }
  vtk->n_points = vtk->n_cells = kept;
  vtk->connectivity = NULL;
  vtk->nodes_per_cell = 1;
  vtk->vtk_type = 1;
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteGrid(Output *o, Model *m, PetscBool *ok, char reason[256])
{
  const Grid *grid = m->grid;
  VtkField fields[OUTPUT_FIELDS_MOST];
  PetscReal *data[OUTPUT_FIELDS_MOST], *x;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(count_numbers(grid->n_nodes, 3), &x));
  widen(grid->n_nodes, m->dim, grid->x, x);
  for (const OutputField *f = output_fields; f->name; ++f) {
    if (!f->grid || !case_writes(m->c, f->name)) continue;
    PetscCall(GridField(o, m, f, &data[n]));
    fields[n] = (VtkField){.name = f->name, .unit = f->unit, .components = f->components, .data = data[n]};
    ++n;
  }
  VtkData vtk = {.n_points = grid->n_nodes,
                 .x = x,
                 .n_cells = grid->n_cells,
                 .connectivity = grid->cell_node,
                 .nodes_per_cell = grid->nodes_per_cell,
                 .vtk_type = cells[grid->type].vtk_type,
                 .n_first = grid->n_first,
                 .first_nodes = cells[grid->first_type].nodes,
                 .first_type = cells[grid->first_type].vtk_type,
                 .n_point_fields = n,
                 .point_fields = fields,
                 .time = m->time};
  if (grid->cloud) PetscCall(WriteCloud(grid, &vtk, n, fields));
  PetscCall(OutputState(o, m->comm, "grid", &vtk, &o->seals[o->count].grid, ok, reason));
  for (PetscInt f = 0; f < n; ++f) PetscCall(PetscFree(data[f]));
  PetscCall(PetscFree(x));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReserveSeals(Output *o, PetscInt n)
{
  PetscFunctionBeginUser;
  if (n > o->capacity) {
    o->capacity = n + n / 2 + 16;
    PetscCall(PetscRealloc((size_t)o->capacity * sizeof *o->seals, &o->seals));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode OutputWrite(Output *o, Model *m, PetscBool *ok, char reason[256])
{
  PetscFunctionBeginUser;
  *ok = PETSC_TRUE;
  PetscCall(ModelInitialise(m));
  PetscCall(ReserveSeals(o, o->count + 1));
  o->seals[o->count] = (StateSeals){.grid = {.bytes = NOT_WRITTEN}};
  PetscCall(WritePoints(o, m, ok, reason));
  if (*ok && m->c->output.grid) PetscCall(WriteGrid(o, m, ok, reason));
  if (*ok && m->walls && m->c->output.walls) PetscCall(OutputWalls(o, m, ok, reason));
  if (*ok && m->walls && m->c->output.walls) PetscCall(OutputContact(o, m, ok, reason));
  if (*ok) ++o->count;
  PetscFunctionReturn(0);
}

PetscInt output_count(const Output *o) { return o->count; }

/* Four numbers a state: bytes and checksum of its points and of its grid. */
PetscErrorCode OutputToTables(const Output *o, Tables *tables)
{
  Table *table;
  Column *column;

  PetscFunctionBeginUser;
  PetscCall(TablesAdd(tables, "states", PETSC_TRUE, o->count, &table));
  PetscCall(TableAdd(table, "points_grid", NULL, COLUMN_INT64, 4, NULL, &column));
  for (PetscInt k = 0; k < o->count; ++k) {
    const StateSeals *s = &o->seals[k];
    const PetscInt64 numbers[] = {s->points.bytes, s->points.crc, s->grid.bytes, s->grid.crc};
    PetscCall(PetscArraycpy((PetscInt64 *)column->data + 4 * k, numbers, 4));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode OutputFromTables(Output *o, const Tables *tables, PetscInt count, char reason[256])
{
  const Table *table = tables_find(tables, "states");
  const PetscInt64 *n = table ? table_data(table, "points_grid", COLUMN_INT64, 4, reason) : NULL;

  PetscFunctionBeginUser;
  if (table && (table->rows != count || !table->everywhere)) snprintf(reason, 256, "%s makes no sense", table->name);
  if (count < 0 || count > 100000000) snprintf(reason, 256, "its count of states makes no sense");
  if (reason[0]) PetscFunctionReturn(0);
  PetscCall(ReserveSeals(o, count));
  for (PetscInt k = 0; k < count; ++k) {
    o->seals[k].points = (FileSeal){n ? n[4 * k] : -1, n ? n[4 * k + 1] : 0};
    o->seals[k].grid = (FileSeal){n ? n[4 * k + 2] : -1, n ? n[4 * k + 3] : 0};
  }
  o->count = count;
  PetscFunctionReturn(0);
}

/* One file of a state; returns whether something is wrong with it. Only the first few are told one
 * by one. */
static PetscBool check_file(const Output *o, const char *name, PetscInt number, const FileSeal *seal, PetscInt wrong,
                            Diag *diag)
{
  char file[64], path[FILE_PATH], reason[128];
  state_file(name, number, file);
  snprintf(path, sizeof path, "%s/%s", o->folder, file);
  file_check_seal(path, seal, reason);
  if (reason[0] && wrong < 3) diag_error(diag, NULL, "cannot go on after '%s': %s", path, reason);
  return reason[0] != 0;
}

PetscErrorCode OutputCheck(const Output *o, MPI_Comm comm, Diag *diag)
{
  PetscMPIInt rank;
  PetscInt wrong = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  for (PetscInt k = 0; !rank && k < o->count; ++k) {
    wrong += check_file(o, "points", k, &o->seals[k].points, wrong, diag);
    if (o->grid && o->seals[k].grid.bytes != NOT_WRITTEN)
      wrong += check_file(o, "grid", k, &o->seals[k].grid, wrong, diag);
  }
  if (wrong > 3) diag_error(diag, NULL, "%d files of states are missing or damaged in all", (int)wrong);
  if (wrong)
    diag_hint(diag, "put the files back as they were, or start the run again in another directory: --out OTHER");
  PetscFunctionReturn(0);
}
