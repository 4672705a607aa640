/* On which side of an open wall a point is. Springs of explicit dynamics let it sink in by more than it is thick: it
 * stands beyond the surface then, and asked anew it would be pushed on. So it keeps the side that it came from. */
#include "solve/contact/contact.h"

#define ASTRAY 0.05 /* of a cell: that far from where it was to go it stands before another part of the wall */

/* What p keeps of the wall where that has a side; NULL: it knows of none. */
static PetscReal *side_kept(const Contact *s, const Points *points, PetscInt p, PetscInt k)
{
  for (PetscInt j = 0; j < s->sides; ++j) {
    PetscReal *kept = contact_kept(points, p, k, s->sides, j);
    if (kept[KEPT_SIDE(s->dim)] != 0) return kept;
  }
  return NULL;
}

/* The distance of p on that side, below 0 beyond the wall; over its rim it is not beyond it. PETSC_FALSE: far away. */
static PetscBool look_from(const Contact *s, const NodalScene *scene, PetscInt p, PetscInt k, int side, PetscReal *gap)
{
  const PetscReal *x = point_real(scene->points, POINT_X, p);
  WallPlace place;
  const PetscBool near =
    wall_near(s->walls, k, scene->t, x, s->near + contact_farthest(scene->points, p), side, &place);
  *gap = near ? place.gap : 0;
  return near;
}

int contact_side(const Contact *s, const NodalScene *scene, PetscInt p, PetscInt k)
{
  const int side = wall_side(s->walls, k, scene->t, point_real(scene->points, POINT_X, p));
  const PetscReal *kept = side ? side_kept(s, scene->points, p, k) : NULL;
  PetscReal gap;
  if (!kept || kept[KEPT_SIDE(s->dim)] * side > 0 || !look_from(s, scene, p, k, -side, &gap)) return side;
  return PetscAbsReal(gap - kept[KEPT_DISTANCE(s->dim)]) <= ASTRAY * s->length ? -side : side;
}

void contact_note_crossing(Contact *s, const NodalScene *scene, PetscInt p, PetscInt k, int side, PetscInt n)
{
  PetscReal *kept = scene->c->analysis.type == ANALYSIS_EXPLICIT ? side_kept(s, scene->points, p, k) : NULL;
  PetscReal gap;
  if (!kept || kept[KEPT_DISTANCE(s->dim)] >= 0 || !wall_comes(s->walls, k, scene->t)) return;
  if (n > 0 && (kept[KEPT_SIDE(s->dim)] * side >= 0 || !look_from(s, scene, p, k, -side, &gap) || gap >= 0)) return;
  s->crosses[k] += scene->points->real[POINT_MASS][p];
  for (PetscInt j = 0; j < s->sides; ++j) contact_kept(scene->points, p, k, s->sides, j)[KEPT_SIDE(s->dim)] = 0;
}
