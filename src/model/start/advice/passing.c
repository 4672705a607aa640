/* Prescribed nodes of a grid that is restored stay where they are, and what they push passes them: the material beside
 * them is moved, and strained, at its old place. Forces are wrong by a fifth after most of a cell, more on finer grids,
 * and nothing else tells. */
#include "case/motion.h"
#include "model/model_private.h"

#define PASSES 0.1   /* of a cell, the way that is told of: 2 % of the force of a bar that is pressed */
#define LOOKS 64     /* between start and end */
#define NO_DEPTH 0.5 /* of a cell */

/* Where material is at the start, m. */
typedef struct {
  PetscReal low[3], high[3];
} Extent;

static PetscErrorCode FindExtent(const Model *m, Extent *e)
{
  PetscReal local[6], all[6];

  PetscFunctionBeginUser;
  for (int i = 0; i < 6; ++i) local[i] = -PETSC_MAX_REAL;
  for (PetscInt p = 0; p < m->points->n; ++p)
    for (PetscInt d = 0; d < m->dim; ++d) {
      const PetscReal x = point_real(m->points, POINT_X, p)[d];
      local[d] = PetscMax(local[d], -x);
      local[3 + d] = PetscMax(local[3 + d], x);
    }
  PetscCall(MPIU_Allreduce(local, all, 6, MPIU_REAL, MPIU_MAX, m->comm));
  for (int d = 0; d < 3; ++d) e->low[d] = -all[d], e->high[d] = all[3 + d];
  PetscFunctionReturn(0);
}

/* How far the place reaches into the material along an axis, m: it may go on beyond it on one side. < 0: it does on
 * both, or on none, or is not known. */
static PetscReal depth_of(const Model *m, const Selector *on, PetscInt axis, const Extent *e)
{
  const PetscBool box = (PetscBool)(on->has_shape && on->shape.kind == SHAPE_BOX);
  const PetscReal min = box ? on->shape.min[axis] : on->min[axis], max = box ? on->shape.max[axis] : on->max[axis];
  for (int high = 0; high < 2 && on->boundary; ++high)
    if (!strcmp(on->boundary, box_side_name(axis, high))) return 0;
  if (!box && (on->has_shape || !on->has[axis])) return -1;
  if (max - min <= NO_DEPTH * m->grid->smallest) return max - min;
  if ((min < e->low[axis]) == (max > e->high[axis])) return -1;
  return PetscMax(0, min < e->low[axis] ? max - e->low[axis] : e->high[axis] - min);
}

/* The farthest that the entry goes along an axis until the end, m. */
static PetscReal way_of(const Model *m, const MotionSpec *motion, PetscInt axis)
{
  const PetscReal nowhere[3] = {0, 0, 0}, start = m->time, span = m->c->analysis.end - start;
  PetscReal most = 0;
  for (int k = 1; k <= LOOKS; ++k)
    most = PetscMax(most, PetscAbsReal(motion_increment(m->c, motion, nowhere, axis, start, start + k * span / LOOKS)));
  return most;
}

static void advise_along(const Model *m, PetscInt k, PetscInt axis, const Extent *extent, Diag *diag)
{
  const MotionSpec *motion = m->c->boundary + k;
  const PetscReal depth = depth_of(m, &motion->on, axis, extent), way = way_of(m, motion, axis) / m->grid->smallest;
  char path[64];
  if (depth < 0 || way <= PASSES || (motion->moves && depth > NO_DEPTH * m->grid->smallest)) return;
  snprintf(path, sizeof path, "boundary[%d].%s", (int)k,
           motion->moves                     ? "moves"
           : motion->kind == MOTION_VELOCITY ? "velocity"
                                             : "displacement");
  if (motion->moves) {
    diag_warning(diag, path,
                 "this place has no depth along %c: when it has moved, no node lies in it, and nothing is held",
                 "xyz"[axis]);
    diag_hint(diag,
              "let it reach a cell into the material, or take a wall, which needs no nodes: contact: bonded or stick");
    return;
  }
  diag_warning(diag, path,
               "material is moved by %.2g cells along %c, and the nodes that move it stay where they are: it passes "
               "them, and forces and stresses beside them are wrong, on finer grids more",
               (double)way, "xyz"[axis]);
  diag_hint(diag, "a wall goes along: walls: [{shape: ..., contact: bonded or stick, motion: [...]}]; so does fem");
}

/* What is nowhere beside material moves none; bodies of later stages may come there. */
static PetscErrorCode MovesNothing(const Model *m, PetscInt entry, PetscBool *nothing)
{
  PetscInt count[2];

  PetscFunctionBeginUser;
  PetscCall(ModelCountPrescribed(m, entry, count));
  *nothing = (PetscBool)(count[1] == 0 && !m->c->staged && !m->c->boundary[entry].moves);
  PetscFunctionReturn(0);
}

PetscErrorCode AdvisePassing(const Model *m, Diag *diag)
{
  PetscBool nothing = PETSC_FALSE;
  Extent extent;

  PetscFunctionBeginUser;
  if (!m->method->restores_grid) PetscFunctionReturn(0);
  PetscCall(FindExtent(m, &extent));
  for (PetscInt k = 0; k < m->c->n_boundary; ++k) {
    const MotionSpec *motion = m->c->boundary + k;
    if (motion->absent || (motion->kind != MOTION_DISPLACEMENT && motion->kind != MOTION_VELOCITY)) continue;
    PetscCall(MovesNothing(m, k, &nothing));
    if (nothing) continue;
    for (PetscInt d = 0; d < m->dim; ++d)
      if (motion->component[d]) advise_along(m, k, d, &extent, diag);
  }
  PetscFunctionReturn(0);
}
