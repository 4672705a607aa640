/* The states of a picture: from their files to balls on the page. */
#include <math.h>
#include <string.h>
#include "picture/scene/scene.h"
#include "picture/raster/spacing.h"

/* Bodies with an outline of their own; more are drawn as one. */
enum { MOST_PARTS = 16 };

/* Copy the points that have a place; a run that broke may hold others. */
static void take_points(PlotScene *scene, PlotFrame *f, PetscInt n, const PetscReal *x, const PlotScalar *scalar,
                        PetscInt components, const PetscReal *data)
{
  PetscBool first = PETSC_TRUE;
  for (PetscInt k = 0; k < scene->n_frames; ++k)
    if (scene->frames[k].n > 0) first = PETSC_FALSE;
  for (PetscInt i = 0; i < n; ++i) {
    const PetscReal *p = x + 3 * i;
    if (!plot_has_place(p)) continue;
    for (int d = 0; d < 3; ++d) {
      scene->box_min[d] = first ? p[d] : PetscMin(scene->box_min[d], p[d]);
      scene->box_max[d] = first ? p[d] : PetscMax(scene->box_max[d], p[d]);
    }
    first = PETSC_FALSE;
    memcpy(f->x + 3 * f->n, p, 3 * sizeof *p);
    f->value[f->n++] = plot_scalar_value(scalar, components, data + (size_t)i * (size_t)components);
  }
}

/* The box about both sides of the axis, and about the circle where the body is turned. */
static void turn_box(PlotScene *scene)
{
  const PetscReal radius = PetscMax(scene->box_max[0], -scene->box_min[0]);
  for (int d = 0; d < 3; d += 2) {
    if (!(d ? scene->turned : scene->mirrored)) continue;
    scene->box_min[d] = -radius, scene->box_max[d] = radius;
  }
}

/* In the plane, and of mpm in space: where the points of the frame began. Points without a place have none there
 * either. */
static PetscErrorCode TakeFirst(VtkFile *file, const PlotScene *scene, PetscInt n, const PetscReal *x, PlotFrame *f)
{
  const PetscInt sides = scene->mirrored ? 2 : 1;
  char reason[256];
  PetscReal *u;

  PetscFunctionBeginUser;
  if (!scene->walled || (scene->walled->kinematics->dim != 2 && strcmp(scene->walled->method, "mpm") != 0))
    PetscFunctionReturn(0);
  PetscCall(PlotReadDisplacement(file, &u, reason));
  if (!u) PetscCall(PlotOriginDisplacement(&scene->origin, file, x, &u));
  if (!u) PetscFunctionReturn(0);
  PetscCall(PetscMalloc2(3 * (size_t)(sides * n), &f->first, sides * n, &f->first_radius));
  for (PetscInt side = 0; side < sides; ++side)
    for (PetscInt i = 0; i < n; ++i) {
      if (!plot_has_place(x + 3 * i)) continue;
      PetscReal *at = f->first + 3 * f->n_first++;
      for (int d = 0; d < 3; ++d) at[d] = x[3 * i + d] - u[3 * i + d];
      if (side) at[0] = -at[0];
    }
  PetscCall(PetscFree(u));
  PetscFunctionReturn(0);
}

/* The other side of the axis. */
static void mirror_points(PlotFrame *f)
{
  const PetscInt n = f->n;
  for (PetscInt i = 0; i < n; ++i, ++f->n) {
    const PetscReal *p = f->x + 3 * i;
    f->x[3 * f->n] = -p[0], f->x[3 * f->n + 1] = p[1], f->x[3 * f->n + 2] = p[2];
    f->value[f->n] = f->value[i];
  }
}

/* Whose points are; NULL, if nobody wrote it. */
static PetscErrorCode ReadBodies(VtkFile *file, PetscReal **body)
{
  const VtkFieldInfo *fields;
  const PetscInt n = vtk_read_fields(file, &fields);
  char reason[256];

  PetscFunctionBeginUser;
  *body = NULL;
  for (PetscInt i = 0; i < n && !*body; ++i)
    if (!strcmp(fields[i].name, "body") && VtkReadField(file, &fields[i], body, reason)) *body = NULL;
  PetscFunctionReturn(0);
}

/* Of bodies between which there are interfaces: on both sides of the axis, if so. */
static PetscErrorCode TakeParts(VtkFile *file, const PlotScene *scene, PetscInt n, const PetscReal *x, PlotFrame *f)
{
  const Case *c = scene->walled;
  PetscReal *body;

  PetscFunctionBeginUser;
  if (!c || !c->n_interfaces || c->n_bodies > MOST_PARTS) PetscFunctionReturn(0);
  PetscCall(ReadBodies(file, &body));
  if (!body) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(f->n, &f->part));
  for (PetscInt k = 0; k < f->n;)
    for (PetscInt i = 0; i < n; ++i)
      if (plot_has_place(x + 3 * i)) f->part[k++] = (unsigned char)PetscMax(0, PetscMin(body[i], c->n_bodies - 1));
  f->n_parts = c->n_bodies;
  PetscCall(PetscFree(body));
  PetscFunctionReturn(0);
}

static PetscErrorCode Smooth(VtkFile *file, const PlotScene *scene, PetscInt n, const PetscReal *x, PetscInt components,
                             PetscReal *data)
{
  PetscReal *body;

  PetscFunctionBeginUser;
  PetscCall(ReadBodies(file, &body));
  PetscCall(PlotSmooth(scene->walled ? scene->walled->kinematics->dim : 3, n, x, body, components, data));
  PetscCall(PetscFree(body));
  PetscFunctionReturn(0);
}

/* Where walls are that move by what acts on them. */
static PetscErrorCode TakeWalls(const VtkFile *file, const PlotScene *scene, PlotFrame *f)
{
  const PetscInt n = scene->walled && scene->walls ? walls_with_mass(scene->walled) : 0;

  PetscFunctionBeginUser;
  if (!n) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(12 * n, &f->walls));
  if (!vtk_read_frames(file, n, f->walls)) PetscCall(PetscFree(f->walls));
  PetscFunctionReturn(0);
}

PetscErrorCode PlotFrameRead(VtkFile *file, const VtkFieldInfo *field, const PlotScalar *scalar, PlotScene *scene,
                             char reason[256])
{
  const PetscInt n = vtk_read_points(file), most = n * (scene->mirrored ? 2 : 1);
  PlotFrame *f = &scene->frames[scene->n_frames];
  PetscReal *x, *data;

  PetscFunctionBeginUser;
  if (VtkReadCoordinates(file, &x, reason)) PetscFunctionReturn(0);
  if (VtkReadField(file, field, &data, reason) == 0) {
    PetscCall(PetscMalloc3(3 * (size_t)most, &f->x, most, &f->value, most, &f->radius));
    if (scene->smooth && !scene->named) PetscCall(Smooth(file, scene, n, x, field->components, data));
    take_points(scene, f, n, x, scalar, field->components, data);
    if (scene->arrows && field->components == 3 && scene->walled && scene->walled->kinematics->dim == 2)
      PetscCall(PlotFrameArrows(n, x, field->components, data, f));
    if (scene->mirrored) mirror_points(f);
    PetscCall(TakeFirst(file, scene, n, x, f));
    PetscCall(TakeParts(file, scene, n, x, f));
    PetscCall(TakeWalls(file, scene, f));
    f->stage = vtk_read_stage(file);
    ++scene->n_frames;
    PetscCall(PetscFree(data));
  }
  PetscCall(PetscFree(x));
  PetscFunctionReturn(0);
}

/* Do neighbours stay neighbours, as far as the case tells? */
static PetscBool is_elastic(const Case *c)
{
  for (PetscInt k = 0; c && k < c->n_materials; ++k)
    if (strncmp(c->materials[k].law, "neo-hookean", 11) != 0) return PETSC_FALSE;
  return c != NULL;
}

/* How far apart points of the frame may be and still be one body: as far as two of them were in the first frame, since
 * flow draws them apart; half of that in elastic bodies, which keep the corners between them, unless they are
 * stretched. */
static PetscErrorCode ChooseGap(PlotScene *scene, PlotFrame *f)
{
  PetscReal far;

  PetscFunctionBeginUser;
  if (!f->n) PetscFunctionReturn(0);
  if (f == scene->frames) PetscCall(PlotQuantile(f->n, f->radius, 0.5, &scene->gap));
  PetscCall(PlotQuantile(f->n, f->radius, 0.9, &far));
  f->gap = (is_elastic(scene->walled) && far <= 1.2 * scene->gap ? 1 : 2) * scene->gap;
  PetscFunctionReturn(0);
}

/* A body is as large as its balls. */
PetscErrorCode PlotFramesShape(PlotScene *scene)
{
  const PetscReal wide = PetscMax(scene->box_max[0] - scene->box_min[0], scene->box_max[1] - scene->box_min[1]);
  PetscReal largest = 0, shown[3];

  PetscFunctionBeginUser;
  scene->dim = !scene->turned && scene->box_max[2] - scene->box_min[2] > 1e-9 * wide ? 3 : 2;
  for (PetscInt k = 0; k < scene->n_frames; ++k) {
    PlotFrame *f = &scene->frames[k];
    PetscCall(PlotSpacing(scene->dim, f->n, f->x, f->radius));
    PetscCall(ChooseGap(scene, f));
    for (PetscInt i = 0; i < f->n; ++i) {
      largest = PetscMax(largest, f->radius[i]);
      plot_project(scene, f->x + 3 * i, shown);
      memcpy(f->x + 3 * i, shown, sizeof shown);
    }
    for (PetscInt i = 0; i < 3 * f->n_triangles; ++i) {
      plot_project(scene, f->corner + 3 * i, shown);
      memcpy(f->corner + 3 * i, shown, sizeof shown);
    }
  }
  for (PetscInt k = 0; k < scene->n_frames && scene->dim == 3; ++k) {
    PlotFrame *f = &scene->frames[k];
    if (!f->n || !f->first) continue;
    PetscCall(PlotSpacing(3, f->n_first, f->first, f->first_radius));
    PetscCall(PlotShapes(scene->walled, scene->contours, f));
  }
  scene->gap *= 2; /* from point to point */
  for (int d = 0; d < scene->dim; ++d) scene->box_min[d] -= 0.9 * largest, scene->box_max[d] += 0.9 * largest;
  if (scene->dim == 2) PetscCall(PlotFirstShape(scene));
  if (scene->turned) scene->dim = 3;
  turn_box(scene);
  PetscFunctionReturn(0);
}

/* Lines between a cell's corners in the order of VTK; n pairs. */
static PetscInt cell_lines(int vtk_type, const int **pairs)
{
  static const int polygon[] = {0, 1, 1, 2, 2, 3, 3, 0}, triangle[] = {0, 1, 1, 2, 2, 0};
  *pairs = vtk_type == 9 ? polygon : triangle;
  return vtk_type == 9 ? 4 : vtk_type == 5 ? 3 : 0;
}

/* Lines of cells in the plane, all whose ends have a place; on both sides of the axis, if so. */
static PetscErrorCode TakeLines(const VtkCells *cells, const PetscReal *x, PetscInt sides, PlotFrame *f)
{
  const int *pairs;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(sides * 16 * (size_t)cells->n, &f->edges));
  for (PetscInt c = 0; c < cells->n; ++c)
    for (PetscInt k = 0, lines = cell_lines(cells->type[c], &pairs); k < lines; ++k) {
      const PetscInt *node = cells->node + cells->start[c];
      const PetscReal *a = x + 3 * node[pairs[2 * k]], *b = x + 3 * node[pairs[2 * k + 1]];
      PetscReal *edge = f->edges + 4 * (size_t)f->n_edges;
      if (!plot_has_place(a) || !plot_has_place(b)) continue;
      edge[0] = a[0], edge[1] = a[1], edge[2] = b[0], edge[3] = b[1];
      ++f->n_edges;
    }
  for (PetscInt i = 0, n = sides > 1 ? f->n_edges : 0; i < n; ++i, ++f->n_edges)
    for (int k = 0; k < 4; ++k) f->edges[4 * f->n_edges + k] = (k % 2 ? 1 : -1) * f->edges[4 * i + k];
  PetscFunctionReturn(0);
}

PetscErrorCode PlotFrameGrid(VtkFile *file, PlotScene *scene, PlotFrame *f, char reason[256])
{
  const PetscInt points = vtk_read_points(file);
  VtkCells cells;
  PetscReal *x;

  PetscFunctionBeginUser;
  if (VtkReadCoordinates(file, &x, reason)) PetscFunctionReturn(0);
  if (VtkReadTopology(file, &cells, reason) == 0) {
    for (PetscInt i = 0; i < points; ++i)
      for (int d = 0; d < scene->dim && plot_has_place(x + 3 * i); ++d) {
        scene->box_min[d] = PetscMin(scene->box_min[d], x[3 * i + d]);
        scene->box_max[d] = PetscMax(scene->box_max[d], x[3 * i + d]);
      }
    turn_box(scene);
    if (scene->dim == 2) PetscCall(TakeLines(&cells, x, scene->mirrored ? 2 : 1, f));
    PetscCall(VtkCellsFree(&cells));
  }
  PetscCall(PetscFree(x));
  PetscFunctionReturn(0);
}

PetscErrorCode PlotFramesFree(PlotScene *scene)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < scene->n_frames; ++k) {
    PlotFrame *f = &scene->frames[k];
    PetscCall(PetscFree3(f->x, f->value, f->radius));
    PetscCall(PetscFree3(f->corner, f->corner_value, f->side));
    PetscCall(PetscFree2(f->first, f->first_radius));
    PetscCall(PetscFree(f->walls));
    PetscCall(PetscFree(f->first_corner));
    PetscCall(PetscFree(f->part));
    PetscCall(PetscFree3(f->shape, f->knows, f->back));
    PetscCall(PetscFree(f->there));
    PetscCall(PetscFree(f->line));
    PetscCall(PetscFree2(f->face, f->face_of));
    PetscCall(PetscFree(f->edges));
    PetscCall(PetscFree(f->arrow));
  }
  PetscFunctionReturn(0);
}
