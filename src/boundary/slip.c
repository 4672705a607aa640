#include "boundary/slip.h"
#include "case/motion.h"

#define ALONG_AXIS 1e-14   /* a direction that leaves its axis by no more is that axis */
#define CONTRADICTION 1e-9 /* share of a motion that may go through a wall */

/* What is left of a direction beside the axes that other entries hold and directions found before;
 * is it one of its own? What differs by less than the angle of a corner is not. */
static PetscBool rest_of(PetscInt dim, const unsigned char *held, PetscInt n, const PetscReal *found,
                         const PetscReal *direction, PetscReal *rest)
{
  const PetscReal least = PetscSinReal(WALL_CORNER);
  PetscReal square = 0;
  for (PetscInt d = 0; d < dim; ++d) rest[d] = held[d] ? 0 : direction[d];
  for (PetscInt k = 0; k < n; ++k) {
    PetscReal along = 0;
    for (PetscInt d = 0; d < dim; ++d) along += rest[d] * found[3 * k + d];
    for (PetscInt d = 0; d < dim; ++d) rest[d] -= along * found[3 * k + d];
  }
  for (PetscInt d = 0; d < dim; ++d) square += rest[d] * rest[d];
  if (square < least * least) return PETSC_FALSE;
  for (PetscInt d = 0; d < dim; ++d) rest[d] /= PetscSqrtReal(square);
  return PETSC_TRUE;
}

/* The axis, of those that nobody holds, that a direction is nearest to. */
static PetscInt nearest_axis(PetscInt dim, const unsigned char *held, const PetscReal *direction)
{
  PetscInt axis = -1;
  for (PetscInt d = 0; d < dim; ++d)
    if (!held[d] && (axis < 0 || PetscAbsReal(direction[d]) > PetscAbsReal(direction[axis]) * (1 + 1e-9))) axis = d;
  return axis;
}

static PetscBool is_axis(PetscInt dim, PetscInt axis, const PetscReal *direction)
{
  PetscReal beside = 0;
  for (PetscInt d = 0; d < dim; ++d)
    if (d != axis) beside += direction[d] * direction[d];
  return beside <= ALONG_AXIS * ALONG_AXIS;
}

static void hold(Boundary *b, PetscInt dof, PetscInt entry)
{
  if (b->fixed[dof]) return;
  b->fixed[dof] = 1;
  b->entry[dof] = entry;
}

/* One direction that is held beside axes that others hold: it takes the place of an axis. Two in
 * space: the way that is left does, and the two other axes of the frame are held. More: nothing is
 * free. */
static PetscErrorCode MarkNode(Boundary *b, const WallNode *wall)
{
  const PetscInt dim = b->dim, first = wall->node * dim;
  const unsigned char *held = b->fixed + first;
  PetscReal found[9] = {0}, way[3] = {0, 0, 0};
  PetscInt n = 0, others = 0;

  PetscFunctionBeginUser;
  for (PetscInt d = 0; d < dim; ++d) others += held[d];
  for (PetscInt k = 0; k < wall->n && others + n < dim; ++k)
    n += rest_of(dim, held, n, found, wall->direction + 3 * k, found + 3 * n);
  if (!n) PetscFunctionReturn(0);
  if (others + n == dim) {
    for (PetscInt d = 0; d < dim; ++d) hold(b, first + d, wall->entry);
    PetscFunctionReturn(0);
  }
  for (int d = 0; d < 3; ++d) /* of two: the direction across both */
    way[d] =
      n == 1 ? found[d] : found[(d + 1) % 3] * found[3 + (d + 2) % 3] - found[(d + 2) % 3] * found[3 + (d + 1) % 3];
  const PetscInt axis = nearest_axis(dim, held, way);
  if (!is_axis(dim, axis, way)) PetscCall(FramesAdd(&b->frames, dim, wall->node, axis, way));
  for (PetscInt d = 0; d < dim; ++d)
    if ((d == axis) == (n == 1)) hold(b, first + d, wall->entry);
  PetscFunctionReturn(0);
}

/* Does a motion that other entries prescribe at the node go through its walls? At some instants. */
static PetscBool goes_through(const Boundary *b, const Grid *grid, const WallNode *wall, PetscInt *entry)
{
  static const PetscReal part[] = {0.0101, 0.1, 0.37, 0.5, 0.77, 1};
  const PetscReal *x = grid->x + wall->node * b->dim;
  for (PetscInt k = 0; k < 6 * wall->n; ++k) {
    PetscReal through = 0, size = 0;
    for (PetscInt d = 0, i = wall->node * b->dim; d < b->dim; ++d, ++i) {
      if (!b->fixed[i] || b->entry[i] == boundary_axis(b)) continue;
      const PetscReal t = part[k % 6] * b->c->analysis.end;
      const PetscReal move = motion_increment(b->c, &b->c->boundary[b->entry[i]], x, d, 0, t);
      if (move != 0) *entry = b->entry[i];
      through += move * wall->direction[3 * (k / 6) + d];
      size += PetscAbsReal(move);
    }
    if (PetscAbsReal(through) > CONTRADICTION * size) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

static void report(const WallNode *wall, PetscInt entry, const char *at, Diag *diag)
{
  char path[64];
  PetscSNPrintf(path, sizeof path, "boundary[%d].fix", (int)wall->entry);
  diag_error(
    diag, path,
    "boundary[%d] contradicts boundary[%d]: it lets the node at %s slide along its wall, which the other moves "
    "it through",
    (int)wall->entry, (int)entry, at);
  diag_hint(diag, "leave the node out of one of the two selections");
}

PetscErrorCode SlipMark(Boundary *b, const Grid *grid, Diag *diag)
{
  PetscBool reported = !diag;
  PetscInt entry = -1;
  char at[64];

  PetscFunctionBeginUser;
  PetscCall(FramesClear(&b->frames, b->n_nodes));
  for (PetscInt k = 0; k < b->n_walls; ++k) {
    const WallNode *wall = b->walls + k;
    if (!reported && goes_through(b, grid, wall, &entry)) {
      boundary_place(b->dim, grid->x + wall->node * b->dim, at);
      report(wall, entry, at, diag);
      reported = PETSC_TRUE;
    }
    PetscCall(MarkNode(b, wall));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SlipCheck(const Boundary *b, const Grid *grid, Diag *diag)
{
  PetscInt lowest = -1;
  char path[64], at[64];

  PetscFunctionBeginUser;
  for (PetscInt k = b->n_walls - 1; k >= 0; --k)
    if (!b->walls[k].n && b->walls[k].node < grid->n_owned) lowest = k;
  if (lowest < 0) PetscFunctionReturn(0);
  const WallNode *wall = b->walls + lowest;
  PetscCall(PetscSNPrintf(path, sizeof path, "boundary[%d].fix", (int)wall->entry));
  boundary_place(b->dim, grid->x + wall->node * b->dim, at);
  diag_error(diag, path,
             "boundary[%d] selects the node at %s, but no side of the grid's boundary there: it has no normal",
             (int)wall->entry, at);
  diag_hint(diag, "select whole sides, by boundary: name or by a shape that takes all their nodes");
  PetscFunctionReturn(0);
}
