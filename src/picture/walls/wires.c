/* Walls in space: lines where their surface ends, has an edge, or turns away from the eye; faces between them. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "picture/walls/walls.h"
#include "wall/facets/mesh.h"

/* Pieces of what is curved are at most so much of the longest side of the box. */
#define FINENESS (1. / 24)
/* Cosine of the angle between pieces that makes an edge: 32 degrees. */
#define EDGE 0.85

/* A side of a piece: its ends in the order of their coordinates, rounded so that those of neighbours are the same, and
 * the normal of the piece on the page. */
typedef struct {
  long key[6];
  PetscReal end[6], normal[3];
} Side;

static int compare_keys(const void *a, const void *b)
{
  const Side *x = a, *y = b;
  for (int k = 0; k < 6; ++k)
    if (x->key[k] != y->key[k]) return x->key[k] < y->key[k] ? -1 : 1;
  return 0;
}

static void set_side(const PetscReal *a, const PetscReal *b, PetscReal size, const PetscReal normal[3], Side *side)
{
  PetscInt order = 0;
  long key[2][3];
  for (int d = 0; d < 3; ++d) key[0][d] = lround(a[d] / (1e-6 * size)), key[1][d] = lround(b[d] / (1e-6 * size));
  for (int d = 0; d < 3 && !order; ++d) order = (key[0][d] > key[1][d]) - (key[0][d] < key[1][d]);
  for (int d = 0; d < 3; ++d) {
    side->key[d] = key[order > 0][d], side->key[3 + d] = key[order <= 0][d];
    side->end[d] = a[d], side->end[3 + d] = b[d];
    side->normal[d] = normal[d];
  }
}

/* Normal of a piece as the eye sees it: right, up, towards. PETSC_FALSE for one without an area, as there are at the
 * middle of the ends of cylinders. */
static PetscBool piece_normal(const PlotScene *scene, const PetscReal *corner, PetscReal size, PetscReal n[3])
{
  PetscReal at[3][3], u[3], v[3], length = 0;
  for (int k = 0; k < 3; ++k) plot_project(scene, corner + 3 * k, at[k]);
  for (int d = 0; d < 3; ++d) u[d] = at[1][d] - at[0][d], v[d] = at[2][d] - at[0][d];
  for (int d = 0; d < 3; ++d) {
    n[d] = u[(d + 1) % 3] * v[(d + 2) % 3] - u[(d + 2) % 3] * v[(d + 1) % 3];
    length += n[d] * n[d];
  }
  for (int d = 0; d < 3; ++d) n[d] /= PetscMax(sqrt(length), 1e-300);
  return sqrt(length) > 1e-12 * size * size;
}

/* Sides between the i-th and the one before `next` are the same: is a line there? */
static PetscBool is_drawn(const Side *side, PetscInt n)
{
  PetscReal cosine = 0;
  if (n != 2) return PETSC_TRUE;
  for (int d = 0; d < 3; ++d) cosine += side[0].normal[d] * side[1].normal[d];
  return fabs(cosine) < EDGE || side[0].normal[2] * side[1].normal[2] * (cosine < 0 ? -1 : 1) < 0;
}

/* What is seen of the walls: the box of all and a little beside it, for a floor that bodies stand on. */
static void view_of(const PlotScene *scene, PetscReal min[3], PetscReal max[3], WallView *view)
{
  PetscReal longest = 0;
  for (int d = 0; d < 3; ++d) longest = PetscMax(longest, scene->box_max[d] - scene->box_min[d]);
  for (int d = 0; d < 3; ++d) min[d] = scene->box_min[d] - 0.02 * longest, max[d] = scene->box_max[d] + 0.02 * longest;
  *view = (WallView){.min = min, .max = max, .size = FINENESS * longest};
}

PetscReal walls_beside(const PlotScene *scene, const WallView *view, int d)
{
  return d == scene->up ? 0 : 0.3 / FINENESS * view->size;
}

/* The part of a line from end to end + 3 that is in view. PETSC_FALSE: none is. */
static PetscBool clip(const PlotScene *scene, const WallView *view, PetscReal end[6])
{
  PetscReal from = 0, to = 1, way[3];
  for (int d = 0; d < 3; ++d) {
    const PetscReal beside = walls_beside(scene, view, d);
    const PetscReal low = view->min[d] - beside - end[d], high = view->max[d] + beside - end[d];
    way[d] = end[3 + d] - end[d];
    if (way[d] == 0 && (low > 0 || high < 0)) return PETSC_FALSE;
    if (way[d] == 0) continue;
    from = PetscMax(from, PetscMin(low / way[d], high / way[d]));
    to = PetscMin(to, PetscMax(low / way[d], high / way[d]));
  }
  for (int d = 0; d < 3; ++d) end[3 + d] = end[d] + to * way[d], end[d] += from * way[d];
  return (PetscBool)(from < to);
}

static PetscErrorCode TakeLines(const PlotScene *scene, const WallMesh *mesh, const WallView *view, PlotFrame *f)
{
  const PetscReal size = view->size / FINENESS;
  Side *sides;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(3 * mesh->n, &sides));
  for (PetscInt i = 0; i < mesh->n; ++i) {
    PetscReal normal[3];
    if (!piece_normal(scene, mesh->x + 9 * i, size, normal)) continue;
    for (int k = 0; k < 3; ++k)
      set_side(mesh->x + 9 * i + 3 * k, mesh->x + 9 * i + 3 * ((k + 1) % 3), size, normal, &sides[n++]);
  }
  qsort(sides, (size_t)n, sizeof *sides, compare_keys);
  PetscCall(PetscMalloc1(18 * (size_t)mesh->n, &f->line));
  for (PetscInt i = 0, next; i < n; i = next) {
    for (next = i + 1; next < n && !compare_keys(&sides[next], &sides[i]);) ++next;
    if (!is_drawn(sides + i, next - i) || !clip(scene, view, sides[i].end)) continue;
    plot_project(scene, sides[i].end, f->line + 6 * f->n_lines);
    plot_project(scene, sides[i].end + 3, f->line + 6 * f->n_lines + 3);
    ++f->n_lines;
  }
  PetscCall(PetscFree(sides));
  PetscFunctionReturn(0);
}

PetscErrorCode PlotWallsLines(PlotScene *scene)
{
  PetscReal min[3], max[3];
  WallView view;

  PetscFunctionBeginUser;
  if (!scene->walls || scene->dim != 3 || scene->turned) PetscFunctionReturn(0);
  view_of(scene, min, max, &view);
  for (PetscInt k = 0; k < scene->n_frames; ++k) {
    PlotFrame *f = &scene->frames[k];
    WallMesh mesh = {.dim = 3};
    if (f->walls) walls_put_frames(scene->walls, f->walls);
    for (PetscInt w = 0; w < scene->walled->n_walls; ++w)
      if (wall_stands(scene->walls, w, f->time)) PetscCall(WallMeshAdd(scene->walls, w, f->time, &view, &mesh));
    PetscCall(TakeLines(scene, &mesh, &view, f));
    PetscCall(PlotWallsFaces(scene, &mesh, &view, f));
    PetscCall(WallMeshFree(&mesh));
  }
  PetscFunctionReturn(0);
}
