/* Where the grid is held along a line, material stands as on a floor or at a wall: a line is drawn there. */
#include <string.h>
#include "picture/walls/walls.h"

/* A straight part of the boundary: x[axis] = at, from `from` to `to` along the other axis. */
typedef struct {
  int axis;
  PetscReal at, from, to;
} Held;

/* left, right, bottom, top of a box. */
static PetscBool side_of_box(const GridSpec *grid, const char *name, Held *held)
{
  static const char *const names[] = {"left", "right", "bottom", "top"};
  for (int k = 0; k < 4 && grid->kind == GRID_BOX; ++k) {
    if (strcmp(name, names[k]) != 0) continue;
    const int axis = k / 2;
    *held = (Held){axis, k % 2 ? grid->max[axis] : grid->min[axis], grid->min[1 - axis], grid->max[1 - axis]};
    return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Is it a line whose nodes do not move across it? */
static PetscBool is_held(const PlotScene *scene, const MotionSpec *motion, Held *held)
{
  const Case *c = scene->walled;
  const Selector *on = &motion->on;
  if (motion->kind != MOTION_FIXED || on->has_shape || on->body) return PETSC_FALSE;
  if (on->boundary) return side_of_box(&c->grid, on->boundary, held) && motion->component[held->axis];
  for (int axis = 0; axis < 2; ++axis) {
    const int other = 1 - axis;
    if (!on->has[axis] || on->min[axis] != on->max[axis] || !motion->component[axis]) continue;
    if (on->has[other] && on->min[other] == on->max[other]) return PETSC_FALSE; /* a point */
    *held = (Held){axis, on->min[axis], scene->box_min[other], scene->box_max[other]};
    if (on->has[other]) held->from = on->min[other], held->to = on->max[other];
    else if (c->grid.kind == GRID_BOX) held->from = c->grid.min[other], held->to = c->grid.max[other];
    return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

static void draw(FILE *out, const PlotPage *page, const Held *held)
{
  const int along = 1 - held->axis;
  const double from = (double)PetscMax(held->from, page->min[along]), to = (double)PetscMin(held->to, page->max[along]),
               at = (double)held->at;
  if (!(from < to) || held->at < page->min[held->axis] || held->at > page->max[held->axis]) return;
  if (held->axis) fprintf(out, "set arrow from %.9g,%.9g to %.9g,%.9g", from, at, to, at);
  else fprintf(out, "set arrow from %.9g,%.9g to %.9g,%.9g", at, from, at, to);
  fputs(" nohead front lw 1.5 lc rgb '#505050'\n", out);
}

void plot_floor_draw(FILE *out, const PlotScene *scene, const PlotPage *page)
{
  const Case *c = scene->walled;
  if (!c || c->kinematics->dim != 2 || scene->dim != 2 || scene->bare) return;
  for (PetscInt k = 0; k < c->n_boundary; ++k) {
    Held held;
    if (!is_held(scene, &c->boundary[k], &held) || (scene->mirrored && held.axis == 0 && held.at == 0)) continue;
    draw(out, page, &held);
    if (!scene->mirrored) continue;
    if (held.axis) held = (Held){1, held.at, -held.to, -held.from};
    else held.at = -held.at;
    draw(out, page, &held);
  }
}
