/* A drum that is not closed: a turning line of a mesh's boundary that begins and ends. Powder that
 * is carried past its end meets an edge of the grid that nothing holds. */
#include "base/text.h"
#include "model/model_private.h"

/* Half edges of the line at every node: one where it ends. */
static PetscErrorCode CountEdges(const Grid *grid, const GridSet *line, PetscReal *edges)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(edges, grid->n_nodes));
  for (PetscInt f = 0; f < line->n_faces; ++f) {
    const PetscInt c = line->face_cell[f];
    const Cell *cell = grid_cell(grid, c);
    for (PetscInt i = 0; i < cell->face_nodes; ++i)
      edges[grid->cell_node[c * grid->nodes_per_cell + cell->face[line->face_side[f]][i]]] += 1;
  }
  PetscCall(GridSumToOwners(grid, 1, edges));
  PetscFunctionReturn(0);
}

/* Ends of the line over all ranks, and where the first two of them in the grid's order are. */
static PetscErrorCode FindEnds(const Grid *grid, const GridSet *line, PetscInt *n, PetscReal end[2][2])
{
  PetscReal *edges;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(grid->n_nodes, &edges));
  PetscCall(CountEdges(grid, line, edges));
  PetscInt local = 0, after = -1;
  for (PetscInt i = 0; i < grid->n_owned; ++i) local += edges[i] == 1;
  PetscCall(MPIU_Allreduce(&local, n, 1, MPIU_INT, MPI_SUM, grid->comm));
  for (PetscInt k = 0; k < 2 && k < *n; ++k) {
    PetscInt here = PETSC_MAX_INT, next;
    PetscReal mine[2] = {0, 0};
    for (PetscInt i = 0; i < grid->n_owned; ++i) {
      if (edges[i] != 1 || grid->global_node[i] <= after || grid->global_node[i] >= here) continue;
      here = grid->global_node[i];
      PetscCall(PetscArraycpy(mine, grid->x + i * grid->dim, 2));
    }
    PetscCall(MPIU_Allreduce(&here, &next, 1, MPIU_INT, MPI_MIN, grid->comm));
    if (here != next) mine[0] = mine[1] = 0;
    PetscCall(MPIU_Allreduce(mine, end[k], 2, MPIU_REAL, MPIU_SUM, grid->comm));
    after = next;
  }
  PetscCall(PetscFree(edges));
  PetscFunctionReturn(0);
}

PetscErrorCode AdviseOpenDrum(const Model *m, Diag *diag)
{
  PetscFunctionBeginUser;
  if (m->dim != 2 || !m->method->restores_grid || !m->grid->mesh) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < m->c->n_boundary; ++k) {
    const MotionSpec *motion = &m->c->boundary[k];
    const GridSet *line = motion->on.boundary ? grid_find_set(m->grid, motion->on.boundary) : NULL;
    PetscReal end[2][2];
    PetscInt n;
    char path[64], from[80], to[80];
    if (motion->kind != MOTION_ROTATION || motion->moves || !line) continue;
    PetscCall(FindEnds(m->grid, line, &n, end));
    if (n < 2) continue;
    snprintf(path, sizeof path, "boundary[%d].on.boundary", (int)k);
    diag_warning(diag, path, "'%s' turns but is not closed: it ends at %s and %s m, and nothing holds what goes past",
                 motion->on.boundary, text_position(2, end[0], from), text_position(2, end[1], to));
    diag_hint(diag, "let the physical group hold every line of the drum's rim");
  }
  PetscFunctionReturn(0);
}
