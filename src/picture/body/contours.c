/* Contours of bodies of whole cells. The cells are those that seeding takes: of a region, and those whose middle is
 * in the body's shape. */
#include "picture/body/contours.h"
#include <math.h>
#include "grid/grid.h"
#include "method/method.h"
#include "points/points.h"
#include "points/seed/outline.h"

enum { MOST_STRIPS = 4096 };
#define MOST_CELLS 1e6 /* of a box: a picture need not wait for more */
#define AXIS 1e-6      /* of a cell: nearer to it is on it */

static PetscInt strip_at(const Contour *c, PetscReal y)
{
  return (PetscInt)PetscMin(PetscMax(floor((y - c->bottom) / c->height), 0), (PetscReal)(c->n_strips - 1));
}

static void strips_of(const Contour *c, const PetscReal *edge, PetscInt *from, PetscInt *to)
{
  *from = strip_at(c, PetscMin(edge[1], edge[3]));
  *to = strip_at(c, PetscMax(edge[1], edge[3]));
}

PetscErrorCode ContourCreate(PetscInt n, PetscReal (*edge)[4], Contour *c)
{
  PetscReal top = -PETSC_MAX_REAL;
  PetscInt from, to;

  PetscFunctionBeginUser;
  *c = (Contour){.n = n, .edge = edge, .n_strips = PetscMin(PetscMax(n, 1), MOST_STRIPS), .bottom = PETSC_MAX_REAL};
  for (PetscInt i = 0; i < 2 * n; ++i) {
    const PetscReal y = edge[i / 2][1 + 2 * (i % 2)];
    c->bottom = PetscMin(c->bottom, y), top = PetscMax(top, y);
  }
  c->height = n && top > c->bottom ? (top - c->bottom) / (PetscReal)c->n_strips : 1;
  PetscCall(PetscCalloc1(c->n_strips + 2, &c->start));
  for (int pass = 0; pass < 2; ++pass) {
    for (PetscInt i = 0; i < n; ++i) {
      strips_of(c, edge[i], &from, &to);
      for (PetscInt k = from; k <= to; ++k) {
        if (pass) c->item[c->start[k + 1]++] = i;
        else ++c->start[k + 2];
      }
    }
    if (pass) break;
    for (PetscInt k = 0; k < c->n_strips; ++k) c->start[k + 2] += c->start[k + 1];
    PetscCall(PetscMalloc1(c->start[c->n_strips + 1], &c->item));
  }
  PetscFunctionReturn(0);
}

/* A ray towards larger x crosses the surface of what holds its beginning an odd number of times. */
PetscBool contour_holds(const Contour *c, const PetscReal *x)
{
  PetscBool in = PETSC_FALSE;
  if (!c->n || x[1] < c->bottom) return PETSC_FALSE;
  const PetscInt strip = strip_at(c, x[1]);
  for (PetscInt k = c->start[strip]; k < c->start[strip + 1]; ++k) {
    const PetscReal *e = c->edge[c->item[k]];
    if ((e[1] > x[1]) == (e[3] > x[1])) continue;
    if (x[0] < e[0] + (x[1] - e[1]) / (e[3] - e[1]) * (e[2] - e[0])) in = !in;
  }
  return in;
}

static PetscReal distance_to(const PetscReal *e, const PetscReal *x)
{
  const PetscReal t[2] = {e[2] - e[0], e[3] - e[1]}, r[2] = {x[0] - e[0], x[1] - e[1]};
  const PetscReal square = t[0] * t[0] + t[1] * t[1], along = square > 0 ? (r[0] * t[0] + r[1] * t[1]) / square : 0;
  const PetscReal s = PetscMin(PetscMax(along, 0), 1);
  return hypot(r[0] - s * t[0], r[1] - s * t[1]);
}

PetscBool contour_near(const Contour *c, const PetscReal *x, PetscReal distance)
{
  if (!c->n) return PETSC_FALSE;
  const PetscInt from = strip_at(c, x[1] - distance), to = strip_at(c, x[1] + distance);
  for (PetscInt k = c->start[from]; k < c->start[to + 1]; ++k)
    if (distance_to(c->edge[c->item[k]], x) < distance) return PETSC_TRUE;
  return PETSC_FALSE;
}

static PetscBool fills_shape(const Case *c, const BodySpec *body)
{
  return body_fills_shape(body, method_find(c->method)->restores_grid);
}

/* Cells of the grid that are the body's. */
static PetscErrorCode Choose(const Case *c, PetscInt b, const Grid *grid, PetscInt *n, PetscInt **chosen)
{
  const BodySpec *body = &c->bodies[b];
  const PetscBool cut = fills_shape(c, body), box = (PetscBool)(grid->box != NULL);
  const GridSet *set = body->region ? grid_find_set(grid, body->region) : NULL;
  PetscReal centre[3] = {0, 0, 0};

  PetscFunctionBeginUser;
  *n = 0;
  PetscCall(PetscMalloc1(grid->n_cells, chosen));
  for (PetscInt k = 0; k < (body->region ? set ? set->n_cells : 0 : grid->n_cells); ++k) {
    const PetscInt cell = set ? set->cells[k] : k;
    if (box && grid_field_of(grid, cell) != case_field(c, b)) continue;
    grid_cell_centre(grid, cell, centre);
    if (cut || !body->has_shape || shape_contains(&body->shape, 2, centre, 0)) (*chosen)[(*n)++] = cell;
  }
  PetscFunctionReturn(0);
}

/* Edges on the axis of rings bound nothing. */
static PetscErrorCode TakeContour(const Case *c, PetscInt b, const Grid *grid, Contour *contour)
{
  Outline outline = {0};
  PetscInt n, *chosen, kept = 0;
  PetscReal(*edge)[4];

  PetscFunctionBeginUser;
  PetscCall(Choose(c, b, grid, &n, &chosen));
  PetscCall(OutlineAdd(&outline, grid, n, chosen, 0, 0));
  PetscCall(PetscMalloc1(outline.n, &edge));
  for (PetscInt i = 0; i < outline.n; ++i) {
    const PetscReal *x = outline.face[i].x;
    if (c->kinematics->hoop && PetscMax(x[0], x[2]) <= AXIS * grid->smallest) continue;
    PetscCall(PetscArraycpy(edge[kept], x, 4));
    ++kept;
  }
  PetscCall(ContourCreate(kept, edge, contour));
  PetscCall(OutlineClear(&outline));
  PetscCall(PetscFree(chosen));
  PetscFunctionReturn(0);
}

/* A mesh as it lies there, or without a file the box; without a word if that cannot be made. */
static PetscErrorCode ReadGrid(const Case *c, char *file, PetscReal scale, Grid **grid)
{
  GridSpec spec = c->grid;
  Diag *diag;

  PetscFunctionBeginUser;
  PetscCall(DiagCreate(&diag));
  spec.kind = GRID_MESH;
  spec.mesh = file;
  spec.mesh_scale = scale;
  if (file) PetscCall(GridCreateMesh(PETSC_COMM_SELF, &spec, 2, "grid.mesh", NULL, NULL, diag, grid));
  else if (c->grid.counts[0] * c->grid.counts[1] <= MOST_CELLS)
    PetscCall(GridCreate(PETSC_COMM_SELF, c, NULL, NULL, diag, grid));
  PetscCall(DiagDestroy(&diag));
  PetscFunctionReturn(0);
}

PetscErrorCode PlotContoursCreate(const Case *c, PlotContours **contours)
{
  const char *read = NULL;
  PetscReal read_scale = 0;
  Grid *grid = NULL;

  PetscFunctionBeginUser;
  *contours = NULL;
  if (!c || c->kinematics->dim != 2) PetscFunctionReturn(0);
  PetscCall(PetscNew(contours));
  (*contours)->n = c->n_bodies;
  PetscCall(PetscCalloc1(c->n_bodies, &(*contours)->body));
  for (PetscInt b = 0; b < c->n_bodies; ++b) {
    const BodySpec *body = &c->bodies[b];
    char *file = body->mesh ? body->mesh : c->grid.mesh;
    const PetscReal scale = body->mesh ? body->mesh_scale : c->grid.mesh_scale;
    if (fills_shape(c, body) && !body->mesh && !body->region) continue;
    if (!read || strcmp(read, file ? file : "") != 0 ||
        read_scale != scale) { /* bodies of one mesh stand side by side */
      PetscCall(GridDestroy(&grid));
      PetscCall(ReadGrid(c, file, scale, &grid));
      read = file ? file : "", read_scale = scale;
    }
    if (grid) PetscCall(TakeContour(c, b, grid, &(*contours)->body[b]));
  }
  PetscCall(GridDestroy(&grid));
  PetscFunctionReturn(0);
}

PetscErrorCode PlotContoursDestroy(PlotContours **contours)
{
  PetscFunctionBeginUser;
  if (!*contours) PetscFunctionReturn(0);
  for (PetscInt b = 0; b < (*contours)->n; ++b) {
    PetscCall(PetscFree((*contours)->body[b].edge));
    PetscCall(PetscFree((*contours)->body[b].start));
    PetscCall(PetscFree((*contours)->body[b].item));
  }
  PetscCall(PetscFree((*contours)->body));
  PetscCall(PetscFree(*contours));
  PetscFunctionReturn(0);
}
