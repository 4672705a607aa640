/* Which way is down? Bodies fall off what was to hold them where names or signs mislead. */
#include "model/model_private.h"

/* Does the entry hold that component of nodes on that side of the box? Of a shape it is
 * believed. */
static PetscBool holds_side(const Grid *grid, const MotionSpec *entry, PetscInt axis, int high)
{
  const PetscReal at = high ? grid->max[axis] : grid->min[axis], slack = 1e-9 * (grid->max[axis] - grid->min[axis]);
  if (!entry->component[axis] && entry->kind != MOTION_ROTATION) return PETSC_FALSE;
  if (entry->on.boundary) return !strcmp(entry->on.boundary, box_side_name(axis, high));
  if (!entry->on.has[axis]) return PETSC_TRUE;
  return at >= entry->on.min[axis] - slack && at <= entry->on.max[axis] + slack;
}

/* A floor by its name, while gravity points elsewhere and nothing is held there. */
static void advise_floor(const Model *m, Diag *diag)
{
  const Case *c = m->c;
  const PetscReal *g = c->gravity;
  PetscInt axis = 0;
  char path[64];
  for (PetscInt d = 1; d < 3; ++d)
    if (PetscAbsReal(g[d]) > PetscAbsReal(g[axis])) axis = d;
  const int high = g[axis] > 0;
  if (m->dim < 3 || m->c->n_walls || !grid_is_aligned(m->grid) || g[axis] == 0 ||
      PetscAbsReal(g[1]) > 1e-6 * PetscAbsReal(g[axis]))
    return;
  for (PetscInt k = 0; k < c->n_boundary; ++k)
    if (holds_side(m->grid, &c->boundary[k], axis, high)) return;
  for (PetscInt k = 0; k < c->n_boundary; ++k) {
    if (!c->boundary[k].on.boundary || strcmp(c->boundary[k].on.boundary, "bottom")) continue;
    PetscSNPrintf(path, sizeof path, "boundary[%d].on.boundary", (int)k);
    diag_warning(diag, path,
                 "'bottom' is the side of the lowest y, but gravity points along %c%c, where nothing is held",
                 high ? '+' : '-', "xyz"[axis]);
    diag_hint(diag, "there the side is called '%s'; or let y be vertical: gravity: [0, -9.81, 0]",
              box_side_name(axis, high));
  }
}

/* Where heights count downwards, something holds there. */
static void advise_upwards(const Model *m, Diag *diag)
{
  const PetscReal *g = m->c->gravity;
  const PetscInt axis = PetscAbsReal(g[m->dim - 1]) > PetscAbsReal(g[1]) ? 2 : 1;
  if (g[axis] <= PetscAbsReal(g[0]) || m->c->n_walls || !grid_is_aligned(m->grid)) return;
  for (PetscInt k = 0; k < m->c->n_boundary; ++k)
    if (holds_side(m->grid, &m->c->boundary[k], axis, 1)) return;
  diag_warning(diag, "loads.gravity", "gravity points along +%c, upwards, where nothing is held", "xyz"[axis]);
  diag_hint(diag, "downwards is `gravity: %s`",
            m->dim == 2 ? "[0, -9.81]"
            : axis == 1 ? "[0, -9.81, 0]"
                        : "[0, 0, -9.81]");
}

void advise_down(const Model *m, Diag *diag)
{
  advise_floor(m, diag);
  advise_upwards(m, diag);
}
