/* Bonds that a stage brings: walls and interfaces that are bonded from now on hold what touches them as it begins, and
 * walls that were before hold bodies that come. */
#include <string.h>
#include "model/stage/stage_private.h"

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

/* Has anything touched any side of wall k? */
static PetscBool is_touched(const Model *m, PetscInt k)
{
  const PetscInt sides = contact_sides(m->c);
  for (PetscInt p = 0; p < m->points->n; ++p)
    for (PetscInt i = 0; i < sides && contact_meets_body(m->c, k, m->points->body[p]); ++i)
      if ((int)(contact_kept(m->points, p, k, sides, i)[KEPT_STATE] + 0.5) != CONTACT_OPEN) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Collective. held: of each body, are its points bonded to the wall now, as far as they touch? */
static PetscErrorCode BondToWall(Model *m, PetscInt k, const PetscBool *held, Diag *diag)
{
  PetscBool any = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (PetscInt b = 0; b < m->c->n_bodies; ++b) any |= held[b] && contact_meets_body(m->c, k, b);
  if (!any || !wall_comes(m->walls, k, m->time)) PetscFunctionReturn(0);
  for (PetscInt p = 0; p < m->points->n; ++p)
    if (held[m->points->body[p]] && contact_meets_body(m->c, k, m->points->body[p])) bond_to_wall(m, k, p);
  PetscCall(TellUntouched(m, k, is_touched(m, k), diag));
  PetscFunctionReturn(0);
}

PetscErrorCode BondsBegin(Model *m, const Case *from, Diag *diag)
{
  PetscBool *held;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(m->c->n_bodies, &held));
  for (PetscInt k = 0; k < m->c->n_walls; ++k) {
    const WallSpec *wall = m->c->walls + k;
    if (wall->absent || wall->contact != CONTACT_BONDED) continue;
    const PetscBool goes_on = was_bonded(wall, from);
    for (PetscInt b = 0; b < m->c->n_bodies; ++b)
      held[b] = (PetscBool)(!m->c->bodies[b].absent && (!goes_on || body_comes(m->c, from, b)));
    PetscCall(BondToWall(m, k, held, diag));
  }
  PetscCall(PetscFree(held));
  PetscCall(InterfacesBond(m, from));
  PetscFunctionReturn(0);
}
