/* Prescribed nodes of a grid that is restored stay where they are, and what they push passes them: the material beside
 * them is moved, and strained, at its old place. Forces are wrong by a fifth after most of a cell, more on finer grids,
 * and nothing else tells. */
#include "case/motion.h"
#include "model/model_private.h"

#define PASSES 0.1   /* of a cell, the way that is told of: 2 % of the force of a bar that is pressed */
#define LOOKS 64     /* between start and end */
#define NO_DEPTH 0.5 /* of a cell */

/* How far the place reaches along an axis, m; < 0: it is not known, or has no end there. */
static PetscReal depth_of(const Selector *on, PetscInt axis)
{
  for (int high = 0; high < 2 && on->boundary; ++high)
    if (!strcmp(on->boundary, box_side_name(axis, high))) return 0;
  return on->has[axis] && !on->has_shape ? on->max[axis] - on->min[axis] : -1;
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

static void advise_along(const Model *m, PetscInt k, PetscInt axis, Diag *diag)
{
  const MotionSpec *motion = m->c->boundary + k;
  const PetscReal depth = depth_of(&motion->on, axis), way = way_of(m, motion, axis) / m->grid->smallest;
  char path[64];
  if (depth < 0 || depth > NO_DEPTH * m->grid->smallest || way <= PASSES) return;
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

void advise_passing(const Model *m, Diag *diag)
{
  if (!m->method->restores_grid) return;
  for (PetscInt k = 0; k < m->c->n_boundary; ++k) {
    const MotionSpec *motion = m->c->boundary + k;
    if (motion->absent || (motion->kind != MOTION_DISPLACEMENT && motion->kind != MOTION_VELOCITY)) continue;
    for (PetscInt d = 0; d < m->dim; ++d)
      if (motion->component[d]) advise_along(m, k, d, diag);
  }
}
