#include "points/seed/outline.h"

static PetscErrorCode Append(Outline *outline, const OutlineFace *face)
{
  PetscFunctionBeginUser;
  if (outline->n == outline->capacity) {
    outline->capacity = PetscMax(64, 2 * outline->capacity);
    PetscCall(PetscRealloc((size_t)outline->capacity * sizeof *outline->face, &outline->face));
  }
  outline->face[outline->n++] = *face;
  PetscFunctionReturn(0);
}

PetscErrorCode OutlineClear(Outline *outline)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(outline->face));
  PetscCall(PetscFree(outline->shape));
  *outline = (Outline){0};
  PetscFunctionReturn(0);
}

PetscErrorCode OutlineShape(Outline *outline, PetscInt n_bodies, PetscInt body, const Shape *shape)
{
  PetscFunctionBeginUser;
  if (!outline->shape) PetscCall(PetscCalloc1(n_bodies, &outline->shape));
  outline->n_bodies = n_bodies;
  outline->shape[body] = shape;
  PetscFunctionReturn(0);
}

static PetscBool is_before(const PetscReal *a, const PetscReal *b)
{
  for (int d = 0; d < 3; ++d)
    if (a[d] != b[d]) return a[d] < b[d];
  return PETSC_FALSE;
}

/* The diagonal by which a quadrilateral is cut starts at its first corner in the order of space:
 * both of its cells find the same one. */
static PetscInt first_corner(PetscReal x[4][3])
{
  PetscInt first = 0;
  for (PetscInt i = 1; i < 4; ++i)
    if (is_before(x[i], x[first])) first = i;
  return first;
}

static PetscErrorCode AddFace(Outline *outline, const Grid *source, PetscInt cell, PetscInt side, OutlineFace face)
{
  const Cell *type = grid_cell(source, cell);
  const PetscInt *node = source->cell_node + cell * source->nodes_per_cell, dim = source->dim;
  PetscReal x[4][3];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < type->face_nodes; ++i)
    for (PetscInt d = 0; d < 3; ++d) x[i][d] = d < dim ? source->x[node[type->face[side][i]] * dim + d] : 0;
  const PetscInt first = type->face_nodes == 4 ? first_corner(x) : 0, pieces = type->face_nodes == 4 ? 2 : 1;
  for (PetscInt k = 0; k < pieces; ++k) {
    const PetscInt corner[3] = {first, (first + 1 + k) % type->face_nodes, (first + 2 + k) % type->face_nodes};
    for (PetscInt i = 0; i < dim; ++i)
      for (PetscInt d = 0; d < dim; ++d) face.x[i * dim + d] = x[corner[i]][d];
    PetscCall(Append(outline, &face));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode OutlineAdd(Outline *outline, const Grid *source, PetscInt n_cells, const PetscInt *chosen, PetscInt body,
                          PetscReal density)
{
  const OutlineFace face = {.body = body, .density = density};
  unsigned char *outer;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n_cells * CELL_MOST_SIDES, &outer));
  PetscCall(OutlineSides(source, n_cells, chosen, outer));
  for (PetscInt k = 0; k < n_cells * CELL_MOST_SIDES; ++k)
    if (outer[k]) PetscCall(AddFace(outline, source, chosen[k / CELL_MOST_SIDES], k % CELL_MOST_SIDES, face));
  PetscCall(PetscFree(outer));
  PetscFunctionReturn(0);
}
