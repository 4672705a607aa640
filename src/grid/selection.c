/* Nodes and faces by a selector: coordinate ranges, a named boundary, a shape; all given must hold.
 *
 * A selector is judged by positions and by sets that know their ghosts, so all ranks agree on a
 * shared node. */
#include "grid/grid.h"

static PetscBool has_range(const Selector *on) { return on->has[0] || on->has[1] || on->has[2]; }

/* Does the position satisfy the ranges and the shape? */
static PetscBool takes_position(const Grid *grid, const Selector *on, PetscReal tolerance, const PetscReal *x)
{
  for (PetscInt d = 0; d < grid->dim; ++d)
    if (on->has[d] && (x[d] < on->min[d] - tolerance || x[d] > on->max[d] + tolerance)) return PETSC_FALSE;
  return !on->has_shape || shape_contains(&on->shape, grid->dim, x, tolerance);
}

static PetscReal selection_tolerance(const Grid *grid)
{
  PetscReal size = 0;
  for (PetscInt d = 0; d < grid->dim; ++d) size = PetscMax(size, grid->max[d] - grid->min[d]);
  return 1e-9 * size;
}

PetscBool grid_takes(const Grid *grid, const Selector *on, const PetscReal *x)
{
  return takes_position(grid, on, selection_tolerance(grid), x);
}

/* The set whose nodes and faces are looked at. A place in space chooses among `all`, where that is
 * given, and else on the outer boundary. An unknown name selects nothing. */
static const GridSet *base_set(const Grid *grid, const Selector *on, const GridSet *all, const GridSet *nothing)
{
  if (on->boundary) {
    const GridSet *set = grid_find_set(grid, on->boundary);
    return set ? set : nothing;
  }
  return all && (has_range(on) || on->has_shape) ? all : &grid->outer;
}

PetscErrorCode GridSelectNodes(const Grid *grid, const Selector *on, PetscInt *n, PetscInt **nodes)
{
  /* all: without a list, the number is the node */
  const GridSet nothing = {0}, all = {.n_nodes = grid->n_nodes};
  const GridSet *set = base_set(grid, on, &all, &nothing);
  const PetscReal tolerance = selection_tolerance(grid);

  PetscFunctionBeginUser;
  *n = 0;
  PetscCall(PetscMalloc1(set->n_nodes, nodes));
  for (PetscInt k = 0; k < set->n_nodes; ++k) {
    const PetscInt node = set->nodes ? set->nodes[k] : k;
    if (takes_position(grid, on, tolerance, grid->x + node * grid->dim)) (*nodes)[(*n)++] = node;
  }
  PetscCall(PetscSortInt(*n, *nodes));
  PetscFunctionReturn(0);
}

/* A face is taken if all its nodes are. */
static PetscBool takes_face(const Grid *grid, const Selector *on, PetscReal tolerance, PetscInt cell, PetscInt side)
{
  const Cell *shape = grid_cell(grid, cell);
  const PetscInt *node = grid->cell_node + cell * grid->nodes_per_cell;
  for (PetscInt i = 0; i < shape->face_nodes; ++i)
    if (!takes_position(grid, on, tolerance, grid->x + node[shape->face[side][i]] * grid->dim)) return PETSC_FALSE;
  return PETSC_TRUE;
}

PetscErrorCode GridSelectFaces(const Grid *grid, const Selector *on, PetscInt *n, PetscInt **cell, PetscInt **side)
{
  const GridSet nothing = {0};
  const GridSet *set = base_set(grid, on, NULL, &nothing);
  const PetscReal tolerance = selection_tolerance(grid);

  PetscFunctionBeginUser;
  *n = 0;
  PetscCall(PetscMalloc1(set->n_faces, cell));
  PetscCall(PetscMalloc1(set->n_faces, side));
  for (PetscInt f = 0; f < set->n_faces; ++f) {
    if (!takes_face(grid, on, tolerance, set->face_cell[f], set->face_side[f])) continue;
    (*cell)[*n] = set->face_cell[f];
    (*side)[(*n)++] = set->face_side[f];
  }
  PetscFunctionReturn(0);
}
