/* The tractions along a wall in one state: a picture over a coordinate, and a table. */
#include <string.h>
#include "base/text.h"
#include "input/case_file.h"
#include "output/directory/run_dir_files.h"
#include "output/vtk/vtk_read.h"
#include "output/vtk/vtk_series.h"
#include "picture/curves/runs.h"
#include "picture/figure.h"
#include "picture/plot.h"
#include "wall/wall.h"

/* What touches the wall, in the order of the coordinate along which it reaches farthest; of that coordinate, what the
 * wall and all bodies share (span[0] >= span[1]: not known). */
typedef struct {
  PetscInt n, along;
  PetscReal span[2];
  PetscReal *x, *pressure, *shear; /* n x 3, n, n x 3 */
} Profile;

static PetscErrorCode FreeProfile(Profile *p)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(p->x));
  PetscCall(PetscFree(p->pressure));
  PetscCall(PetscFree(p->shear));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadNamed(VtkFile *file, const char *name, PetscReal **data, char reason[256])
{
  const VtkFieldInfo *fields;
  const PetscInt n = vtk_read_fields(file, &fields);

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; ++i) {
    if (strcmp(fields[i].name, name)) continue;
    const PetscErrorCode code = VtkReadField(file, &fields[i], data, reason);
    PetscFunctionReturn(code);
  }
  snprintf(reason, 256, "it has no field '%s'", name);
  PetscFunctionReturn(PETSC_ERR_FILE_UNEXPECTED);
}

/* Keep what belongs to the wall. */
static void choose(Profile *p, PetscInt n, const PetscReal *wall, PetscInt index)
{
  for (PetscInt i = 0; i < n; ++i) {
    if ((PetscInt)wall[i] != index) continue;
    for (int d = 0; d < 3; ++d) {
      p->x[3 * p->n + d] = p->x[3 * i + d];
      p->shear[3 * p->n + d] = p->shear[3 * i + d];
    }
    p->pressure[p->n++] = p->pressure[i];
  }
}

static PetscErrorCode SortAlong(Profile *p)
{
  PetscReal low[3] = {PETSC_MAX_REAL, PETSC_MAX_REAL, PETSC_MAX_REAL},
            high[3] = {-PETSC_MAX_REAL, -PETSC_MAX_REAL, -PETSC_MAX_REAL};
  PetscReal *key;
  PetscInt *order;
  Profile sorted = {.n = p->n};

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < 3 * p->n; ++i) {
    low[i % 3] = PetscMin(low[i % 3], p->x[i]);
    high[i % 3] = PetscMax(high[i % 3], p->x[i]);
  }
  for (int d = 1; d < 3; ++d)
    if (high[d] - low[d] > high[sorted.along] - low[sorted.along]) sorted.along = d;
  PetscCall(PetscMalloc2(p->n, &key, p->n, &order));
  PetscCall(PetscMalloc1(3 * p->n, &sorted.x));
  PetscCall(PetscMalloc1(p->n, &sorted.pressure));
  PetscCall(PetscMalloc1(3 * p->n, &sorted.shear));
  for (PetscInt i = 0; i < p->n; ++i) key[i] = p->x[3 * i + sorted.along], order[i] = i;
  PetscCall(PetscSortRealWithArrayInt(p->n, key, order));
  for (PetscInt i = 0; i < p->n; ++i) {
    PetscCall(PetscArraycpy(sorted.x + 3 * i, p->x + 3 * order[i], 3));
    PetscCall(PetscArraycpy(sorted.shear + 3 * i, p->shear + 3 * order[i], 3));
    sorted.pressure[i] = p->pressure[order[i]];
  }
  PetscCall(PetscFree2(key, order));
  PetscCall(FreeProfile(p));
  *p = sorted;
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadProfile(const char *path, PetscInt wall, Profile *p, char reason[256])
{
  PetscReal *walls = NULL;
  VtkFile *file;

  PetscFunctionBeginUser;
  *p = (Profile){0};
  PetscErrorCode code = VtkReadOpen(path, &file, reason);
  if (code) PetscFunctionReturn(code);
  code = VtkReadCoordinates(file, &p->x, reason);
  if (!code) code = ReadNamed(file, "pressure", &p->pressure, reason);
  if (!code) code = ReadNamed(file, "shear", &p->shear, reason);
  if (!code) code = ReadNamed(file, "wall", &walls, reason);
  if (!code) choose(p, vtk_read_points(file), walls, wall);
  PetscCall(PetscFree(walls));
  PetscCall(VtkReadClose(&file));
  if (code) PetscCall(FreeProfile(p));
  else PetscCall(SortAlong(p));
  PetscFunctionReturn(code);
}

static PetscBool write_table(const Profile *p, const char *path, Diag *diag)
{
  FILE *out = fopen(path, "w");
  int wrong = !out;
  if (out) {
    fputs("x [m],y [m],z [m],pressure [Pa],shear x [Pa],shear y [Pa],shear z [Pa]\n", out);
    for (PetscInt i = 0; i < p->n; ++i) {
      const double x[] = {p->x[3 * i],     p->x[3 * i + 1],     p->x[3 * i + 2],    p->pressure[i],
                          p->shear[3 * i], p->shear[3 * i + 1], p->shear[3 * i + 2]};
      for (int k = 0; k < 7; ++k) fprintf(out, "%s%.9g", k ? "," : "", x[k]);
      fputc('\n', out);
    }
    wrong = ferror(out);
    wrong |= fclose(out);
  }
  if (wrong) diag_error(diag, NULL, "cannot write '%s'", path);
  return !wrong;
}

/* Pressure, and shear: along the coordinate in the plane, its size in space. */
static PetscErrorCode DrawProfile(const Profile *p, PetscBool space, const char *title, const char *png, Diag *diag,
                                  PetscBool *done)
{
  PetscReal *x, *value[2], largest = 0;
  char unit[64], label[TEXT_LABEL], axis[] = "x [m]";

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(p->n, &x, p->n, &value[0], p->n, &value[1]));
  for (PetscInt i = 0; i < p->n; ++i) {
    const PetscReal *s = p->shear + 3 * i, size = PetscSqrtReal(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]);
    x[i] = p->x[3 * i + p->along];
    value[0][i] = p->pressure[i];
    value[1][i] = space || s[p->along] > 0 ? size : -size;
    largest = PetscMax(largest, PetscMax(PetscAbsReal(value[0][i]), size));
  }
  const PetscReal factor = figure_unit("Pa", largest, unit);
  for (PetscInt i = 0; i < 2 * p->n; ++i) value[i / p->n][i % p->n] *= factor;
  text_with_unit("traction", unit, label);
  axis[0] = "xyz"[p->along];
  const FigureStyle style = space ? FIGURE_DOTS : FIGURE_LINE_MARKS;
  const FigureSeries series[] = {{.name = "pressure", .style = style, .n = p->n, .x = x, .y = value[0]},
                                 {.name = "shear", .style = style, .n = p->n, .x = x, .y = value[1]}};
  const Figure figure = {.title = title,
                         .x_label = axis,
                         .y_label = label,
                         .from = p->span[0],
                         .to = p->span[1],
                         .n_series = 2,
                         .series = series};
  PetscCall(FigureWrite(&figure, png, diag, done));
  PetscCall(PetscFree3(x, value[0], value[1]));
  PetscFunctionReturn(0);
}

/* How far points reach along the axis, in the state of that time. */
static PetscErrorCode PointsSpan(const char *run, PetscReal time, PetscInt along, PetscReal span[2])
{
  char path[FILE_PATH + 256], reason[256];
  VtkSeries series;
  VtkFile *file;
  PetscReal *x;

  PetscFunctionBeginUser;
  if (VtkSeriesRead(run, "points", &series, reason)) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < series.n; ++k) {
    if (series.states[k].time != time) continue;
    PetscCall(PetscSNPrintf(path, sizeof path, "%s/%s", run, series.states[k].file));
    if (VtkReadOpen(path, &file, reason)) break;
    if (!VtkReadCoordinates(file, &x, reason)) {
      for (PetscInt i = 0; i < vtk_read_points(file); ++i) {
        span[0] = PetscMin(span[0], x[3 * i + along]);
        span[1] = PetscMax(span[1], x[3 * i + along]);
      }
      PetscCall(PetscFree(x));
    }
    PetscCall(VtkReadClose(&file));
    break;
  }
  PetscCall(VtkSeriesFree(&series));
  PetscFunctionReturn(0);
}

/* Where a wall stands beside a body and feels nothing, a curve has nothing: the axis shows it. */
static PetscErrorCode FindSpan(const PlotOptions *options, PetscInt wall, PetscReal time, Profile *p)
{
  PetscReal points[2] = {PETSC_MAX_REAL, -PETSC_MAX_REAL}, min[3], max[3];
  Walls *walls = NULL;
  Case *c;
  Diag *own;

  PetscFunctionBeginUser;
  PetscCall(DiagCreate(&own));
  PetscCall(CaseReadKept(PETSC_COMM_SELF, options->run, &c));
  if (c) PetscCall(WallsCreate(c, own, &walls));
  if (walls) {
    PetscCall(PointsSpan(options->run, time, p->along, points));
    wall_bounds(walls, wall, time, min, max);
    p->span[0] = PetscMax(points[0], min[p->along]);
    p->span[1] = PetscMin(points[1], max[p->along]);
  }
  PetscCall(WallsDestroy(&walls));
  PetscCall(CaseDestroy(&c));
  PetscCall(DiagDestroy(&own));
  PetscFunctionReturn(0);
}

/* The index of a wall of the run's case by its name; -1 and a complaint if it has none. */
static PetscErrorCode FindWall(const PlotOptions *options, Diag *diag, PetscInt *index, PetscBool *space)
{
  const char **names, *nearest;
  Case *c;

  PetscFunctionBeginUser;
  *index = -1;
  PetscCall(CaseReadKept(PETSC_COMM_SELF, options->run, &c));
  PetscCall(PetscCalloc1(c ? c->n_walls + 1 : 1, &names));
  for (PetscInt k = 0; c && k < c->n_walls; ++k) {
    names[k] = c->walls[k].name;
    if (!strcmp(names[k], options->profile)) *index = k;
  }
  *space = c && c->kinematics->dim == 3;
  if (*index < 0) {
    diag_error(diag, NULL, "the run '%s' has no wall '%s'", options->run, options->profile);
    if ((nearest = diag_nearest(options->profile, names))) diag_hint(diag, "did you mean '%s'?", nearest);
  }
  PetscCall(PetscFree(names));
  PetscCall(CaseDestroy(&c));
  PetscFunctionReturn(0);
}

/* The state nearest to the first time that was asked for, or the last. */
static PetscErrorCode FindFile(const PlotOptions *options, Diag *diag, VtkState *state, PetscBool *found)
{
  VtkSeries series;
  char reason[256];

  PetscFunctionBeginUser;
  *found = PETSC_FALSE;
  if (VtkSeriesRead(options->run, "contact", &series, reason) || series.n == 0) {
    diag_error(diag, NULL, "the run '%s' has no contact.hdf.series: it has no walls, or `output: {walls: false}`",
               options->run);
    PetscFunctionReturn(0);
  }
  *state = series.states[series.n - 1];
  for (PetscInt k = 0; k < series.n && options->n_times; ++k)
    if (PetscAbsReal(series.states[k].time - options->times[0]) < PetscAbsReal(state->time - options->times[0]))
      *state = series.states[k];
  *found = PETSC_TRUE;
  PetscCall(VtkSeriesFree(&series));
  PetscFunctionReturn(0);
}

PetscErrorCode PlotProfile(const PlotOptions *options, Diag *diag, void (*said)(const char *path))
{
  char path[FILE_PATH + 256], name[192], title[256], reason[256];
  PetscInt wall;
  PetscBool space, found, done = PETSC_FALSE;
  VtkState state;
  Profile p;

  PetscFunctionBeginUser;
  PetscCall(FindWall(options, diag, &wall, &space));
  if (wall < 0) PetscFunctionReturn(0);
  PetscCall(FindFile(options, diag, &state, &found));
  if (!found) PetscFunctionReturn(0);
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/%s", options->run, state.file));
  if (ReadProfile(path, wall, &p, reason)) {
    diag_error(diag, NULL, "cannot read '%s': %s", path, reason);
    PetscFunctionReturn(0);
  }
  snprintf(name, sizeof name, "profile_%.150s", options->profile);
  plot_file_name(name);
  snprintf(title, sizeof title, "%.150s at t = %.6g s", options->profile, (double)state.time);
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/pictures/%s.csv", options->run, name));
  if (!p.n) diag_error(diag, NULL, "nothing touches the wall '%s' at %g s", options->profile, (double)state.time);
  else if (plot_folder(options->run, diag) && write_table(&p, path, diag)) {
    PetscCall(FindSpan(options, wall, state.time, &p));
    said(path);
    PetscCall(PetscSNPrintf(path, sizeof path, "%s/pictures/%s.%s", options->run, name, plot_ending(options->format)));
    PetscCall(DrawProfile(&p, space, title, options->out ? options->out : path, diag, &done));
    if (done) said(options->out ? options->out : path);
  }
  PetscCall(FreeProfile(&p));
  PetscFunctionReturn(0);
}
