/* Cells that lie in one another, as from two surfaces drawn over each other: each would be filled, and mass counted twice. On rank 0. */
#include "grid/gmsh/msh.h"

#define WELL_INSIDE 1e-6 /* of the reference cell: neighbours only touch */

/* Who else holds a position of a cell? */
typedef struct {
  const SerialMesh *mesh;
  PetscInt cell, other;
  PetscReal x[3];
} Probe;

static void cell_nodes(const SerialMesh *mesh, PetscInt cell, PetscReal *x)
{
  const PetscInt nn = cells[mesh->type].nodes, dim = mesh->dim;
  for (PetscInt i = 0; i < nn * dim; ++i) x[i] = mesh->x[mesh->cell_node[cell * nn + i / dim] * dim + i % dim];
}

static PetscErrorCode BoundCells(const SerialMesh *mesh, BoxTree **tree)
{
  PetscReal(*bounds)[6], x[3 * CELL_MAX_NODES];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc(sizeof *bounds * (size_t)mesh->n_cells, &bounds));
  for (PetscInt c = 0; c < mesh->n_cells; ++c) {
    cell_nodes(mesh, c, x);
    for (PetscInt i = 0; i < cells[mesh->type].nodes * mesh->dim; ++i) {
      const PetscInt d = i % mesh->dim;
      bounds[c][d] = i < mesh->dim ? x[i] : PetscMin(bounds[c][d], x[i]);
      bounds[c][d + 3] = i < mesh->dim ? x[i] : PetscMax(bounds[c][d + 3], x[i]);
    }
  }
  PetscCall(BoxTreeCreate(mesh->n_cells, bounds, tree));
  PetscFunctionReturn(0);
}

/* A BoxVisit: go on until another cell holds the position well inside. */
static PetscBool holds_too(void *context, PetscInt index)
{
  Probe *p = context;
  PetscReal x[3 * CELL_MAX_NODES], xi[3];
  if (index == p->cell) return PETSC_TRUE;
  cell_nodes(p->mesh, index, x);
  if (!cell_inverse_map(p->mesh->type, x, p->x, xi) || cell_outside(p->mesh->type, xi) > -WELL_INSIDE)
    return PETSC_TRUE;
  p->other = index;
  return PETSC_FALSE;
}

/* One of the cell's sample positions that another cell has, too? It stays in the probe. */
static PetscBool overlaps(const SerialMesh *mesh, const BoxTree *tree, PetscInt n, const PetscReal *xi, Probe *probe)
{
  const PetscInt dim = mesh->dim;
  PetscReal x[3 * CELL_MAX_NODES], N[CELL_MAX_NODES], dN[3 * CELL_MAX_NODES];
  cell_nodes(mesh, probe->cell, x);
  for (PetscInt q = 0; q < n && probe->other < 0; ++q) {
    cell_shape(mesh->type, xi + q * dim, N, dN);
    for (PetscInt d = 0; d < 3; ++d) probe->x[d] = 0;
    for (PetscInt i = 0; i < cells[mesh->type].nodes * dim; ++i) probe->x[i % dim] += N[i / dim] * x[i];
    box_tree_holding(tree, probe->x, holds_too, probe);
  }
  return probe->other >= 0;
}

static void tell(const SerialMesh *mesh, const Probe *first, PetscInt n, const char *path, Diag *diag)
{
  char at[80];
  if (mesh->dim == 3)
    snprintf(at, sizeof at, "(%g, %g, %g)", (double)first->x[0], (double)first->x[1], (double)first->x[2]);
  else snprintf(at, sizeof at, "(%g, %g)", (double)first->x[0], (double)first->x[1]);
  diag_error(
    diag, path,
    "%lld of %lld cells overlap others, so that material there would count twice: elements %lld and %lld share %s",
    (long long)n, (long long)mesh->n_cells, (long long)mesh->number[first->cell], (long long)mesh->number[first->other],
    at);
  diag_hint(diag,
            "are two surfaces or volumes drawn over each other? In a .geo BooleanFragments or `Coherence` parts them");
}

PetscErrorCode SerialMeshCheckOverlap(const SerialMesh *mesh, const char *path, Diag *diag)
{
  static const PetscInt samples[4] = {3, 4, 4, 8};
  PetscReal xi[8 * 3], weight[8];
  Probe first = {.other = -1};
  PetscInt n = 0;
  BoxTree *tree;

  PetscFunctionBeginUser;
  (void)cell_quadrature(mesh->type, samples[mesh->type], xi, weight);
  PetscCall(BoundCells(mesh, &tree));
  for (PetscInt c = 0; c < mesh->n_cells; ++c) {
    Probe probe = {.mesh = mesh, .cell = c, .other = -1};
    if (overlaps(mesh, tree, samples[mesh->type], xi, &probe) && !n++) first = probe;
  }
  PetscCall(BoxTreeDestroy(&tree));
  if (n) tell(mesh, &first, n, path, diag);
  PetscFunctionReturn(0);
}
