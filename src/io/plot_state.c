#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <string.h>
#include "io/figure.h"
#include "io/plot.h"
#include "io/plot_field.h"
#include "io/plot_scene.h"
#include "io/plot_spacing.h"
#include "io/run_dir_files.h"
#include "io/vtk_read.h"
#include "io/vtk_series.h"

PetscBool plot_folder(const char *run, Diag *diag)
{
  char folder[FILE_PATH];
  snprintf(folder, sizeof folder, "%s/pictures", run);
  const int error = file_make_folders(folder);
  if (error) DiagError(diag, NULL, "cannot create the folder '%s': %s", folder, strerror(error));
  return error ? PETSC_FALSE : PETSC_TRUE;
}

void plot_file_name(char *name)
{
  for (char *c = name; *c; ++c)
    if (!isalnum((unsigned char)*c) && *c != '-' && *c != '.') *c = '_';
}

/* The state to draw: the last, or the nearest to the time asked for. */
static PetscErrorCode FindState(const PlotOptions *options, Diag *diag, VtkState *state, PetscBool *found)
{
  VtkSeries series;
  PetscInt best;

  PetscFunctionBeginUser;
  PetscCall(VtkSeriesRead(options->run, "points", &series));
  *found = series.n > 0 ? PETSC_TRUE : PETSC_FALSE;
  if (!*found) DiagError(diag, NULL, "there is no state of a run in '%s' (no points.hdf.series)", options->run);
  best = series.n - 1;
  for (PetscInt i = 0; options->at_time && i < series.n; ++i)
    if (fabs(series.states[i].time - options->time) < fabs(series.states[best].time - options->time)) best = i;
  if (*found) *state = series.states[best];
  if (*found && options->at_time &&
      fabs(state->time - options->time) > 1e-9 * PetscMax(fabs(options->time), fabs(state->time)))
    DiagWarning(diag, NULL, "there is no state at %.9g s: the nearest is drawn, at %.9g s", (double)options->time,
                (double)state->time);
  PetscCall(VtkSeriesFree(&series));
  PetscFunctionReturn(0);
}

/* Complain about a field that is not there, with the nearest name and all others. */
static PetscErrorCode NoSuchField(PetscInt n, const VtkFieldInfo *fields, const char *name, Diag *diag)
{
  const char **names, *nearest;
  char list[512] = "";
  size_t used = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n + 1, &names));
  for (PetscInt i = 0; i < n; ++i) {
    names[i] = fields[i].name;
    if (used < sizeof list)
      used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", i ? ", " : "", fields[i].name);
  }
  nearest = DiagNearest(name, names);
  DiagError(diag, NULL, "the run has no field '%s'", name);
  if (nearest) DiagHint(diag, "did you mean '%s'? It has: %s", nearest, list);
  else DiagHint(diag, "it has: %s", list);
  PetscCall(PetscFree(names));
  PetscFunctionReturn(0);
}

/* The field asked for; without one the displacement, else the first that is more than a number of the
 * point. */
static PetscErrorCode FindField(const VtkFile *file, const char *name, Diag *diag, const VtkFieldInfo **field)
{
  const VtkFieldInfo *fields;
  const PetscInt n = VtkReadFields(file, &fields);
  const char *wanted = name ? name : "displacement";

  PetscFunctionBeginUser;
  *field = NULL;
  for (PetscInt i = 0; i < n && !*field; ++i)
    if (!strcmp(fields[i].name, wanted)) *field = &fields[i];
  for (PetscInt i = 0; i < n && !*field && !name; ++i)
    if (strcmp(fields[i].name, "id")) *field = &fields[i];
  if (*field) PetscFunctionReturn(0);
  if (name) PetscCall(NoSuchField(n, fields, name, diag));
  else DiagError(diag, NULL, "the run has no field to draw");
  PetscFunctionReturn(0);
}

/* Copy the points that have a place; a run that broke may hold others. */
static void TakePoints(PlotScene *scene, PetscInt n, const PetscReal *x, const PlotScalar *scalar, PetscInt components,
                       const PetscReal *data)
{
  scene->n = 0;
  for (PetscInt i = 0; i < n; ++i) {
    const PetscReal *p = x + 3 * i;
    if (!(fabs(p[0]) < 1e30 && fabs(p[1]) < 1e30 && fabs(p[2]) < 1e30)) continue;
    for (int d = 0; d < 3; ++d) {
      scene->box_min[d] = scene->n ? PetscMin(scene->box_min[d], p[d]) : p[d];
      scene->box_max[d] = scene->n ? PetscMax(scene->box_max[d], p[d]) : p[d];
    }
    memcpy(scene->x + 3 * scene->n, p, 3 * sizeof *p);
    scene->value[scene->n++] = plot_scalar_value(scalar, components, data + i * components);
  }
  const PetscReal wide = PetscMax(scene->box_max[0] - scene->box_min[0], scene->box_max[1] - scene->box_min[1]);
  scene->dim = scene->box_max[2] - scene->box_min[2] > 1e-9 * wide ? 3 : 2;
}

/* Colours from the smallest to the largest value, or as asked for; in a unit that suits. */
static void ChooseColours(PlotScene *scene, const PlotOptions *options, const char *unit, const char *what)
{
  char prefixed[64];
  scene->low = PETSC_MAX_REAL, scene->high = -PETSC_MAX_REAL;
  for (PetscInt i = 0; i < scene->n; ++i)
    if (fabs(scene->value[i]) < 1e300)
      scene->low = PetscMin(scene->low, scene->value[i]), scene->high = PetscMax(scene->high, scene->value[i]);
  if (scene->low > scene->high) scene->low = 0, scene->high = 1;
  if (options->has_range) scene->low = options->range[0], scene->high = options->range[1];
  const PetscReal factor = figure_unit(unit, PetscMax(fabs(scene->low), fabs(scene->high)), prefixed);
  for (PetscInt i = 0; i < scene->n; ++i) scene->value[i] *= factor;
  scene->low *= factor, scene->high *= factor;
  const PetscReal middle = 0.5 * (scene->low + scene->high), least = middle != 0 ? 1e-6 * fabs(middle) : 1e-12;
  if (scene->high - scene->low < least) scene->low = middle - least, scene->high = middle + least;
  if (prefixed[0]) snprintf(scene->label, sizeof scene->label, "%.60s [%s]", what, prefixed);
  else snprintf(scene->label, sizeof scene->label, "%.60s", what);
}

/* Lines between a cell's corners in the order of VTK; n pairs. */
static PetscInt CellLines(int vtk_type, const int **pairs)
{
  static const int polygon[] = {0, 1, 1, 2, 2, 3, 3, 0}, triangle[] = {0, 1, 1, 2, 2, 0};
  *pairs = vtk_type == 9 ? polygon : triangle;
  return vtk_type == 9 ? 4 : vtk_type == 5 ? 3 : 0;
}

static PetscErrorCode TakeGridLines(PlotScene *scene, VtkFile *file)
{
  const PetscInt n = VtkReadCells(file), points = VtkReadPoints(file);
  PetscInt *start, *node;
  PetscReal *x;
  const int *pairs;
  int *type;

  PetscFunctionBeginUser;
  PetscCall(VtkReadCoordinates(file, &x));
  PetscCall(VtkReadTopology(file, &start, &node, &type));
  for (PetscInt i = 0; i < points; ++i)
    for (int d = 0; d < scene->dim; ++d) {
      scene->box_min[d] = PetscMin(scene->box_min[d], x[3 * i + d]);
      scene->box_max[d] = PetscMax(scene->box_max[d], x[3 * i + d]);
    }
  PetscCall(PetscMalloc1(scene->dim == 2 ? 16 * (size_t)n : 0, &scene->edges));
  for (PetscInt c = 0; c < n && scene->dim == 2; ++c)
    for (PetscInt k = 0, lines = CellLines(type[c], &pairs); k < lines; ++k) {
      const PetscReal *a = x + 3 * node[start[c] + pairs[2 * k]], *b = x + 3 * node[start[c] + pairs[2 * k + 1]];
      PetscReal *edge = scene->edges + 4 * scene->n_edges++;
      edge[0] = a[0], edge[1] = a[1], edge[2] = b[0], edge[3] = b[1];
    }
  PetscCall(PetscFree(x));
  PetscCall(PetscFree(start));
  PetscCall(PetscFree(node));
  PetscCall(PetscFree(type));
  PetscFunctionReturn(0);
}

/* grid_000012.hdf beside points_000012.hdf; without one, the grid is left out with a word. */
static PetscErrorCode AddGrid(PlotScene *scene, const PlotOptions *options, const VtkState *state, Diag *diag)
{
  char path[FILE_PATH], reason[256];
  const char *number = strchr(state->file, '_');
  VtkFile *file;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/grid%s", options->run, number ? number : ".hdf"));
  if (VtkReadOpen(path, &file, reason)) {
    DiagWarning(diag, NULL, "the grid is not drawn: '%s': %s", path, reason);
    PetscFunctionReturn(0);
  }
  PetscCall(TakeGridLines(scene, file));
  PetscCall(VtkReadClose(&file));
  PetscFunctionReturn(0);
}

/* The body is as large as its balls, and seen from where the eye is. */
static PetscErrorCode ShapeBody(PlotScene *scene)
{
  PetscReal largest = 0, shown[3];

  PetscFunctionBeginUser;
  PetscCall(PlotSpacing(scene->dim, scene->n, scene->x, scene->radius));
  for (PetscInt i = 0; i < scene->n; ++i) {
    largest = PetscMax(largest, scene->radius[i]);
    plot_project(scene, scene->x + 3 * i, shown);
    memcpy(scene->x + 3 * i, shown, sizeof shown);
  }
  for (int d = 0; d < scene->dim; ++d) scene->box_min[d] -= 0.9 * largest, scene->box_max[d] += 0.9 * largest;
  PetscFunctionReturn(0);
}

/* Everything of the picture but its place on the page. */
static PetscErrorCode FillScene(const PlotOptions *options, VtkFile *file, const VtkState *state,
                                const VtkFieldInfo *field, const PlotScalar *scalar, Diag *diag, PlotScene *scene)
{
  const PetscInt n = VtkReadPoints(file);
  PetscReal *x, *data;
  char what[192];

  PetscFunctionBeginUser;
  scene->up = options->up;
  PetscCall(VtkReadCoordinates(file, &x));
  PetscCall(VtkReadField(file, field->name, &data));
  PetscCall(PetscMalloc3(3 * (size_t)n, &scene->x, n, &scene->value, n, &scene->radius));
  TakePoints(scene, n, x, scalar, field->components, data);
  PetscCall(PetscFree(x));
  PetscCall(PetscFree(data));
  if (scalar->reduction == PLOT_MISES || scalar->reduction == PLOT_MEAN)
    snprintf(what, sizeof what, "%s %s", scalar->name, field->name);
  else snprintf(what, sizeof what, "%s%s%s", field->name, scalar->name[0] ? " " : "", scalar->name);
  for (char *c = what; *c; ++c)
    if (*c == '_') *c = ' ';
  snprintf(scene->title, sizeof scene->title, "%s at t = %.6g s", what, (double)state->time);
  ChooseColours(scene, options, field->unit, what);
  PetscCall(ShapeBody(scene));
  if (options->grid) PetscCall(AddGrid(scene, options, state, diag));
  PetscFunctionReturn(0);
}

/* state_displacement_magnitude_000012.png */
static void PictureName(const PlotOptions *options, const VtkState *state, const char *field, const PlotScalar *scalar,
                        char *path)
{
  char name[256];
  const char *number = strchr(state->file, '_');
  const int digits = number ? (int)strcspn(number + 1, ".") : 0;
  snprintf(name, sizeof name, "state_%.120s%s%.30s_%.*s.png", field, scalar->name[0] ? "_" : "", scalar->name,
           PetscMin(digits, 12), number ? number + 1 : "");
  plot_file_name(name);
  if (options->out) snprintf(path, PETSC_MAX_PATH_LEN, "%s", options->out);
  else snprintf(path, PETSC_MAX_PATH_LEN, "%s/pictures/%s", options->run, name);
}

static PetscErrorCode DrawFile(const PlotOptions *options, VtkFile *file, const VtkState *state, Diag *diag,
                               char *picture)
{
  const VtkFieldInfo *field;
  PlotScene scene = {0};
  PlotScalar scalar;
  PetscBool done = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(FindField(file, options->field, diag, &field));
  if (!field || !plot_scalar_choose(field->name, field->components, options->component, diag, &scalar))
    PetscFunctionReturn(0);
  PetscCall(FillScene(options, file, state, field, &scalar, diag, &scene));
  if (scene.n == 0) DiagError(diag, NULL, "the state at %.9g s has no points", (double)state->time);
  if (scene.n > 0 && (options->out || plot_folder(options->run, diag))) {
    PictureName(options, state, field->name, &scalar, picture);
    PetscCall(PlotDraw(&scene, options->width, options->height, picture, diag, &done));
  }
  if (!done) picture[0] = 0;
  PetscCall(PetscFree3(scene.x, scene.value, scene.radius));
  PetscCall(PetscFree(scene.edges));
  PetscFunctionReturn(0);
}

PetscErrorCode PlotState(const PlotOptions *options, Diag *diag, char picture[PETSC_MAX_PATH_LEN])
{
  char path[FILE_PATH + VTK_SERIES_NAME], reason[256];
  VtkState state;
  VtkFile *file;
  PetscBool found = PETSC_FALSE;

  PetscFunctionBeginUser;
  picture[0] = 0;
  PetscCall(FindState(options, diag, &state, &found));
  if (!found) PetscFunctionReturn(0);
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/%s", options->run, state.file));
  if (VtkReadOpen(path, &file, reason)) {
    DiagError(diag, NULL, "cannot read '%s': %s", path, reason);
    PetscFunctionReturn(0);
  }
  PetscCall(DrawFile(options, file, &state, diag, picture));
  PetscCall(VtkReadClose(&file));
  PetscFunctionReturn(0);
}
