/* Bonds that a stage brings: walls and interfaces that are bonded from now on hold what touches them as it begins. */
#include <string.h>
#include "model/model_private.h"

/* Has the stage before bonded what the wall touches? */
static PetscBool was_bonded(const WallSpec *wall, const Case *from)
{
  for (const WallSpec *w = from->walls; w < from->walls + from->n_walls; ++w)
    if (!strcmp(w->name, wall->name)) return (PetscBool)(!w->absent && w->contact == CONTACT_BONDED);
  return PETSC_FALSE;
}

void contact_bond(const Model *m, PetscInt p, const PetscReal normal[3], PetscReal gap, const PetscReal *was,
                  PetscReal *kept)
{
  const NodalScene scene = nodal_scene(m, m->time, m->nodes->du);
  if ((int)(was[KEPT_STATE] + 0.5) != CONTACT_OPEN) return;
  const PetscReal reach = contact_reach_left(&scene, p, was, normal, gap);
  /* What a spring has left pressed in stands at the surface: as the law was. */
  const PetscReal behind = contact_behind_left(&scene, CONTACT_FRICTIONLESS, was, gap - reach);
  if (gap + behind - reach > CONTACT_HAIR * m->grid->smallest) return;
  const PetscReal let_in = contact_let_in(&scene, was, behind) ? CONTACT_LET_IN : 0;
  kept[KEPT_STATE] = CONTACT_SLIDES + let_in; /* as what was pressed: the step stops it, and no impulse before that */
  kept[KEPT_REACH] = PetscMax(reach, gap + behind);
  kept[KEPT_PASSED(m->dim)] = behind;
  for (PetscInt d = 0; d < m->dim; ++d) kept[KEPT_FORCE + d] = 0;
  kept[KEPT_STAYS(m->dim)] = 0;
  contact_keep_normal(kept, m->dim, contact_sides(m->c), normal);
}

static void bond_to_wall(const Model *m, PetscInt k, PetscInt p)
{
  const PetscReal *x = point_real(m->points, POINT_X, p), *was[WALL_SIDES];
  const int side = wall_side(m->walls, k, m->time, x);
  const PetscReal far = contact_farthest(m->points, p) + CONTACT_HAIR * m->grid->smallest;
  WallPlace place[WALL_SIDES];
  PetscInt slot[WALL_SIDES];
  const PetscInt n = wall_sides(m->walls, k, m->time, x, far, side, place);
  contact_find_slots(m->contact, m->points, p, k, n, place, slot, was);
  for (PetscInt i = 0; i < n; ++i)
    contact_bond(m, p, place[i].normal, place[i].gap, was[i],
                 contact_kept(m->points, p, k, contact_sides(m->c), slot[i]));
}

PetscErrorCode BondsBegin(Model *m, const Case *from)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < m->c->n_walls; ++k) {
    const WallSpec *wall = m->c->walls + k;
    if (wall->absent || wall->contact != CONTACT_BONDED || was_bonded(wall, from)) continue;
    for (PetscInt p = 0; p < m->points->n && wall_comes(m->walls, k, m->time); ++p)
      if (contact_meets_body(m->c, k, m->points->body[p])) bond_to_wall(m, k, p);
  }
  PetscCall(InterfacesBond(m, from));
  PetscFunctionReturn(0);
}
