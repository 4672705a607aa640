/* Cells that lie in one another, as from two surfaces drawn over each other: each would be filled,
 * and mass counted twice. On rank 0. */
#include "grid/mesh/file_mesh.h"

#define WELL_INSIDE 1e-6 /* of the reference cell: neighbours only touch */

/* Who else holds a position of a cell? */
typedef struct {
  const FileMesh *mesh;
  PetscInt cell, other;
  PetscReal x[3];
} Probe;

/* A BoxVisit: go on until another cell holds the position well inside. */
static PetscBool holds_too(void *context, PetscInt index)
{
  Probe *p = context;
  PetscReal x[3 * CELL_MAX_NODES], xi[3];
  if (index == p->cell) return PETSC_TRUE;
  const CellType type = grid_cell_type(p->mesh->grid, index);
  grid_cell_x(p->mesh->grid, index, x);
  if (!cell_inverse_map(type, x, p->x, xi) || cell_outside(type, xi) > -WELL_INSIDE) return PETSC_TRUE;
  p->other = index;
  return PETSC_FALSE;
}

/* One of the cell's sample positions that another cell has, too? It stays in the probe. */
static PetscBool overlaps(const Grid *grid, const BoxTree *tree, Probe *probe)
{
  static const PetscInt samples[4] = {3, 4, 4, 8};
  const CellType type = grid_cell_type(grid, probe->cell);
  const PetscInt dim = grid->dim;
  PetscReal x[3 * CELL_MAX_NODES], N[CELL_MAX_NODES], dN[3 * CELL_MAX_NODES], xi[8 * 3], weight[8];
  grid_cell_x(grid, probe->cell, x);
  (void)cell_quadrature(type, samples[type], xi, weight);
  for (PetscInt q = 0; q < samples[type] && probe->other < 0; ++q) {
    cell_shape(type, xi + q * dim, N, dN);
    for (PetscInt d = 0; d < 3; ++d) probe->x[d] = 0;
    for (PetscInt i = 0; i < cells[type].nodes * dim; ++i) probe->x[i % dim] += N[i / dim] * x[i];
    box_tree_holding(tree, probe->x, holds_too, probe);
  }
  return probe->other >= 0;
}

static void tell(const FileMesh *mesh, const Probe *first, PetscInt n, const char *path, Diag *diag)
{
  char at[80];
  if (mesh->grid->dim == 3)
    snprintf(at, sizeof at, "(%g, %g, %g)", (double)first->x[0], (double)first->x[1], (double)first->x[2]);
  else snprintf(at, sizeof at, "(%g, %g)", (double)first->x[0], (double)first->x[1]);
  diag_error(
    diag, path,
    "%lld of %lld cells overlap others, so that material there would count twice: elements %lld and %lld share %s",
    (long long)n, (long long)mesh->grid->n_cells, (long long)mesh->number[first->cell],
    (long long)mesh->number[first->other], at);
  diag_hint(diag,
            "are two surfaces or volumes drawn over each other? In a .geo BooleanFragments or `Coherence` parts them");
}

PetscErrorCode FileMeshCheckOverlap(const FileMesh *mesh, const char *path, Diag *diag)
{
  Probe first = {.other = -1};
  PetscInt n = 0;
  BoxTree *tree;

  PetscFunctionBeginUser;
  PetscCall(MeshCellTree(mesh->grid, &tree));
  for (PetscInt c = 0; c < mesh->grid->n_cells; ++c) {
    Probe probe = {.mesh = mesh, .cell = c, .other = -1};
    if (overlaps(mesh->grid, tree, &probe) && !n++) first = probe;
  }
  PetscCall(BoxTreeDestroy(&tree));
  if (n) tell(mesh, &first, n, path, diag);
  PetscFunctionReturn(0);
}
