#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <string.h>
#include <sys/stat.h>
#include "picture/plot.h"
#include "picture/scene/scene.h"
#include "picture/scene/stage.h"
#include "picture/walls/walls.h"
#include "picture/revolution/revolution.h"
#include "output/directory/run_dir_files.h"
#include "output/vtk/vtk_series.h"

PetscBool plot_folder(const char *run, Diag *diag)
{
  char folder[FILE_PATH];
  snprintf(folder, sizeof folder, "%s/pictures", run);
  struct stat info;
  const int error = file_make_folders(folder);
  const PetscBool link = !error && !lstat(folder, &info) && S_ISLNK(info.st_mode);
  if (error) diag_error(diag, NULL, "cannot create the folder '%s': %s", folder, strerror(error));
  if (link) diag_error(diag, NULL, "'%s' is a link: the pictures would go elsewhere", folder);
  return !(error || link);
}

const char *const plot_formats[] = {"png", "svg", "pdf", NULL}, *const plot_films[] = {"gif", "mp4", NULL};

const char *plot_ending(const char *format) { return format ? format : "png"; }

void plot_file_name(char *name)
{
  for (char *c = name; *c; ++c)
    if (!isalnum((unsigned char)*c) && *c != '-' && *c != '.') *c = '_';
}

/* The state nearest to a time, with a word if it is not near. */
static VtkState state_nearest(const VtkSeries *series, PetscReal time, Diag *diag)
{
  PetscInt best = 0;
  for (PetscInt i = 1; i < series->n; ++i)
    if (fabs(series->states[i].time - time) < fabs(series->states[best].time - time)) best = i;
  const PetscReal found = series->states[best].time;
  if (fabs(found - time) > 1e-9 * PetscMax(fabs(time), fabs(found)))
    diag_warning(diag, NULL, "there is no state at %.9g s: the nearest is drawn, at %.9g s", (double)time,
                 (double)found);
  return series->states[best];
}

/* The states to draw: the last, all, or the nearest to the times asked for. */
static PetscErrorCode FindStates(const PlotOptions *options, Diag *diag, PetscInt *n, VtkState *states)
{
  VtkSeries series;
  PetscInt empty;

  PetscFunctionBeginUser;
  *n = 0;
  PetscCall(PlotSeriesRead(options, diag, &series, &empty));
  if (diag_errors(diag)) PetscFunctionReturn(0);
  if (series.n + empty == 0)
    diag_error(diag, NULL, "there is no state of a run in '%s' (no points.hdf.series)", options->run);
  else if (options->all_times && series.n > PLOT_MAX_STATES) {
    diag_error(diag, NULL, "the run has %d states, a picture holds %d at most", (int)series.n, PLOT_MAX_STATES);
    diag_hint(diag, "name some: --time 0,%g,%g", (double)series.states[series.n / 2].time,
              (double)series.states[series.n - 1].time);
  } else if (options->all_times)
    for (; *n < series.n; ++*n) states[*n] = series.states[*n];
  else if (options->even) {
    const PetscInt most = series.n < 3 ? 0 : PetscMin(options->even, series.n);
    for (; *n < most; ++*n) states[*n] = series.states[*n * (series.n - 1) / (most - 1)];
  } else
    for (; series.n > 0 && *n < options->n_times; ++*n) states[*n] = state_nearest(&series, options->times[*n], diag);
  if (series.n > 0 && !options->all_times && !options->even && *n == 0) states[(*n)++] = series.states[series.n - 1];
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
  nearest = diag_nearest(name, names);
  diag_error(diag, NULL, "the run has no field '%s'", name);
  if (nearest) diag_hint(diag, "did you mean '%s'? It has: %s", nearest, list);
  else diag_hint(diag, "it has: %s", list);
  PetscCall(PetscFree(names));
  PetscFunctionReturn(0);
}

/* The field asked for; without one the displacement, else the first that is more than a number of
 * the point. */
static PetscErrorCode FindField(const VtkFile *file, const char *name, Diag *diag, const VtkFieldInfo **field)
{
  const VtkFieldInfo *fields;
  const PetscInt n = vtk_read_fields(file, &fields);
  const char *wanted = name ? name : "displacement";

  PetscFunctionBeginUser;
  *field = NULL;
  for (PetscInt i = 0; i < n && !*field; ++i)
    if (!strcmp(fields[i].name, wanted)) *field = &fields[i];
  for (PetscInt i = 0; i < n && !*field && !name; ++i)
    if (strcmp(fields[i].name, "id")) *field = &fields[i];
  if (*field) PetscFunctionReturn(0);
  if (name) PetscCall(NoSuchField(n, fields, name, diag));
  else diag_error(diag, NULL, "the run has no field to draw");
  PetscFunctionReturn(0);
}

static void cannot_read(Diag *diag, const char *path, const char *reason)
{
  diag_error(diag, NULL, "cannot read '%s': %s", path, reason);
  diag_hint(diag, "--time chooses other states; the same run with --force writes all of them anew");
}

/* grid_000012.hdf beside points_000012.hdf; NULL, with the reason, if it cannot be read, and without one if there is
 * none. */
static PetscErrorCode OpenGrid(const char *run, const VtkState *state, VtkFile **file, Diag *diag)
{
  char path[FILE_PATH + VTK_SERIES_NAME], name[VTK_SERIES_NAME + 8], reason[256];
  const char *number = strchr(state->file, '_');

  PetscFunctionBeginUser;
  *file = NULL;
  snprintf(name, sizeof name, "grid%s", number ? number : ".hdf");
  if (!file_exists(run, name)) PetscFunctionReturn(0);
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/%s", run, name));
  if (VtkReadOpen(path, file, reason)) {
    *file = NULL;
    cannot_read(diag, path, reason);
  }
  PetscFunctionReturn(0);
}

/* The grid's lines; without a file of it they are left out with a word. */
static PetscErrorCode AddGrid(PlotScene *scene, PlotFrame *frame, const char *run, const VtkState *state, Diag *diag)
{
  char reason[256] = "";
  VtkFile *file;

  PetscFunctionBeginUser;
  if (frame->n_triangles) PetscFunctionReturn(0); /* cells have their lines */
  PetscCall(OpenGrid(run, state, &file, diag));
  if (file) {
    PetscCall(PlotFrameGrid(file, scene, frame, reason));
    PetscCall(VtkReadClose(&file));
  } else if (!diag_errors(diag))
    diag_warning(diag, NULL, "the grid is not drawn: '%s' has no file of it at %g s", run, (double)state->time);
  if (reason[0]) cannot_read(diag, "the grid", reason);
  PetscFunctionReturn(0);
}

static void name_subject(PlotSubject *s, PetscBool smooth)
{
  const PlotScalar *scalar = &s->scalar;
  if (scalar->reduction >= PLOT_MISES) snprintf(s->words, sizeof s->words, "%s %s", scalar->name, s->field.name);
  else snprintf(s->words, sizeof s->words, "%s%s%s", s->field.name, scalar->name[0] ? " " : "", scalar->name);
  for (char *c = s->words; *c; ++c)
    if (*c == '_') *c = ' ';
  if (smooth && !plot_has_names(s->field.name))
    snprintf(s->words + strlen(s->words), sizeof s->words - strlen(s->words), ", smoothed");
}

/* The cells of fem, which are the body itself; points, where there is no file of them. */
static PetscErrorCode AddMesh(const PlotOptions *options, const VtkState *state, const PlotSubject *subject,
                              PlotScene *scene, Diag *diag)
{
  const Case *c = scene->walled;
  PlotFrame *frame = &scene->frames[scene->n_frames - 1];
  char reason[256] = "";
  VtkFile *file;

  PetscFunctionBeginUser;
  if (!c || strcmp(c->method, "fem") != 0) PetscFunctionReturn(0);
  PetscCall(OpenGrid(options->run, state, &file, diag));
  if (!file) PetscFunctionReturn(0);
  PetscCall(PlotFrameMesh(file, c->kinematics->dim, &subject->field, &subject->scalar, scene, frame, reason));
  PetscCall(VtkReadClose(&file));
  if (reason[0]) cannot_read(diag, "the grid", reason);
  PetscFunctionReturn(0);
}

/* The next frame of the scene. A mistake leaves the scene as it is. */
static PetscErrorCode AddFrame(const PlotOptions *options, const VtkState *state, PlotSubject *subject,
                               PlotScene *scene, Diag *diag)
{
  char path[FILE_PATH + VTK_SERIES_NAME], reason[256];
  const VtkFieldInfo *field;
  VtkFile *file;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/%s", options->run, state->file));
  if (VtkReadOpen(path, &file, reason)) {
    cannot_read(diag, path, reason);
    PetscFunctionReturn(0);
  }
  PetscCall(FindField(file, options->field, diag, &field));
  if (field && plot_scalar_choose(field->name, field->components, options->component, diag, &subject->scalar)) {
    subject->field = *field;
    name_subject(subject, options->smooth);
    scene->named = plot_has_names(field->name);
    PetscCall(PlotFrameRead(file, field, &subject->scalar, scene, reason));
    if (reason[0]) cannot_read(diag, path, reason);
    else if (scene->frames[scene->n_frames - 1].n == 0)
      diag_error(diag, NULL, "the state at %.9g s has no points", (double)state->time);
    else PetscCall(AddMesh(options, state, subject, scene, diag));
  }
  PetscCall(VtkReadClose(&file));
  PetscFunctionReturn(0);
}

/* The axis along which gravity is largest; z without any. */
static PetscInt against_gravity(const Case *c)
{
  PetscInt up = 2;
  for (PetscInt d = 1; c && d >= 0; --d)
    if (PetscAbsReal(c->gravity[d]) > PetscAbsReal(c->gravity[up])) up = d;
  return up;
}

/* The whole section of a body of revolution, unless half of it is asked for; its axis points up. */
static PetscErrorCode FindKind(const PlotOptions *options, Diag *diag, PlotScene *scene)
{
  PetscFunctionBeginUser;
  PetscCall(PlotIsRevolution(options->run, &scene->revolution));
  scene->mirrored = scene->revolution && !options->half;
  scene->turned = scene->revolution && options->turned;
  scene->up = scene->turned ? 1 : options->up >= 0 ? options->up : against_gravity(scene->walled);
  if (!scene->revolution && (options->half || options->turned))
    diag_error(diag, NULL, "'%s' is no axisymmetric run: there is nothing to %s", options->run,
               options->turned ? "turn" : "halve");
  PetscFunctionReturn(0);
}

/* When it was; where strength is divided the factor, which goes on from the end of the loads. */
static void say_when(const PlotOptions *options, const PlotScene *scene, PetscReal time, PetscInt number, char text[64])
{
  const PetscReal end = scene->walled ? scene->walled->analysis.end : 1;
  char stage[64];
  if (plot_stage_at(options->run, time, number, stage)) snprintf(text, 64, "%.40s, t = %.6g s", stage, (double)time);
  else if (time > end && file_exists(options->run, "factor.csv")) snprintf(text, 64, "F = %.5g", (double)(time - end));
  else snprintf(text, 64, "t = %.6g s", (double)time);
}

PetscErrorCode PlotSceneFree(PlotScene *scene)
{
  PetscFunctionBeginUser;
  if (!scene->borrowed) PetscCall(PlotContoursDestroy(&scene->contours));
  PetscCall(PlotWallsClose(scene));
  PetscCall(PlotOriginFree(&scene->origin));
  PetscCall(PlotFramesFree(scene));
  PetscFunctionReturn(0);
}

/* Of bodies that are drawn by their points, and have a beginning. */
static PetscErrorCode TakeContours(const PlotOptions *options, PlotScene *scene)
{
  PetscBool wanted = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < scene->n_frames; ++k)
    if (scene->frames[k].n && scene->frames[k].n_first) wanted = PETSC_TRUE;
  scene->contours = options->contours, scene->borrowed = (PetscBool)(options->contours != NULL);
  if (wanted && !scene->borrowed) PetscCall(PlotContoursCreate(scene->walled, &scene->contours));
  PetscFunctionReturn(0);
}

PetscErrorCode PlotSceneFill(const PlotOptions *options, PetscInt n, const VtkState *states, PlotSubject *subject,
                             Diag *diag, PlotScene *scene)
{
  PetscFunctionBeginUser;
  PetscCall(PlotWallsOpen(options->run, diag, scene));
  PetscCall(FindKind(options, diag, scene));
  if (scene->walled && !case_writes(scene->walled, "displacement"))
    PetscCall(PlotOriginRead(options->run, &scene->origin));
  scene->grid = options->grid;
  scene->arrows = options->arrows;
  scene->smooth = options->smooth;
  scene->bare = options->bare;
  scene->columns = options->columns;
  for (PetscInt k = 0; k < n && !diag_errors(diag); ++k) {
    PetscCall(AddFrame(options, &states[k], subject, scene, diag));
    char *title = scene->frames[k].title, when[64];
    scene->frames[k].time = states[k].time;
    say_when(options, scene, states[k].time, scene->frames[k].stage, when);
    if (n == 1) snprintf(title, 256, "%.160s at %s", subject->words, when);
    else snprintf(title, 256, "%s", when);
  }
  if (diag_errors(diag)) PetscFunctionReturn(0);
  plot_scale_arrows(scene, options);
  plot_choose_colours(scene, options, subject->field.unit, subject->words);
  PetscCall(TakeContours(options, scene));
  PetscCall(PlotFramesShape(scene));
  plot_walls_extend(scene);
  PetscCall(PlotWallsLines(scene));
  for (PetscInt k = 0; k < n && options->grid; ++k)
    PetscCall(AddGrid(scene, &scene->frames[k], options->run, &states[k], diag));
  PetscFunctionReturn(0);
}

/* state_displacement_magnitude_000012.png; states_displacement_magnitude.png for several. */
void plot_picture_name(const PlotOptions *options, const char *kind, PetscInt n, const VtkState *state,
                       const PlotSubject *subject, char *path)
{
  char name[256];
  const PlotScalar *scalar = &subject->scalar;
  const char *number = n == 1 ? strchr(state->file, '_') : NULL;
  const int digits = number ? (int)strcspn(number, ".") : 0;
  snprintf(name, sizeof name, "%s_%.120s%s%.30s%s%.*s.%s", kind, subject->field.name, scalar->name[0] ? "_" : "",
           scalar->name, options->turned ? "_turned" : "", PetscMin(digits, 13), number ? number : "",
           plot_ending(options->format));
  plot_file_name(name);
  if (options->out) snprintf(path, PETSC_MAX_PATH_LEN, "%s", options->out);
  else snprintf(path, PETSC_MAX_PATH_LEN, "%s/pictures/%s", options->run, name);
}

PetscErrorCode PlotState(const PlotOptions *options, Diag *diag, char picture[PETSC_MAX_PATH_LEN])
{
  VtkState states[PLOT_MAX_STATES];
  PlotSubject subject;
  PlotScene scene = {0};
  PetscBool done = PETSC_FALSE;
  PetscInt n;

  PetscFunctionBeginUser;
  picture[0] = 0;
  PetscCall(FindStates(options, diag, &n, states));
  if (n == 0) PetscFunctionReturn(0);
  PetscCall(PlotSceneFill(options, n, states, &subject, diag, &scene));
  if (!diag_errors(diag) && (options->out || plot_folder(options->run, diag))) {
    plot_picture_name(options, n == 1 ? "state" : "states", n, states, &subject, picture);
    PetscCall(PlotDraw(&scene, options->width, options->height, picture, diag, &done));
  }
  if (!done) picture[0] = 0;
  PetscCall(PlotSceneFree(&scene));
  PetscFunctionReturn(0);
}
