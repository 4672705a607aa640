/* Which cells' nodes carry unknowns: those that hold material, and rings around them that let the
 * pattern live for a while. */
#include "model/model_private.h"

static void flag_occupied(const Model *m, unsigned char *cell)
{
  const Support *w = m->space->support;
  for (PetscInt c = 0; c < m->grid->n_cells; ++c) cell[c] = 0;
  for (PetscInt g = 0; g < w->n_groups; ++g) cell[m->points->cell[w->point_start[g]]] = 1;
}

/* Add all cells that share a node with a flagged one, on any rank. */
static PetscErrorCode AddRing(const Model *m, unsigned char *cell)
{
  const Grid *grid = m->grid;
  const PetscInt nn = grid->nodes_per_cell;
  PetscReal *near;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(grid->n_nodes, &near));
  for (PetscInt i = 0; i < grid->n_cells * nn; ++i)
    if (cell[i / nn]) near[grid->cell_node[i]] = 1;
  PetscCall(GridSumToOwners(grid, 1, near));
  PetscCall(GridToGhosts(grid, 1, near));
  for (PetscInt i = 0; i < grid->n_cells * nn; ++i)
    if (near[grid->cell_node[i]] > 0) cell[i / nn] = 1;
  PetscCall(PetscFree(near));
  PetscFunctionReturn(0);
}

/* The system still fits if every occupied cell is enabled, and not too many enabled cells are
 * empty. */
static PetscErrorCode StillFits(const Model *m, const unsigned char *occupied, PetscBool *fits)
{
  PetscInt local[3] = {0, 0, 0}, all[3];

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < m->grid->n_cells; ++c) {
    local[0] += occupied[c] && !m->enabled[c];
    local[1] += occupied[c];
    local[2] += m->enabled[c];
  }
  PetscCall(MPIU_Allreduce(local, all, 3, MPIU_INT, MPI_SUM, m->comm));
  *fits = m->system->builds && !all[0] && all[2] <= 3 * all[1] + 200;
  PetscFunctionReturn(0);
}

/* Rings of empty cells cost less than the patterns that they save while they add a tenth of the
 * cells at most; the first one is always there, since without it a moving body would need a new
 * pattern at every step. */
static PetscErrorCode AddRings(const Model *m, const unsigned char *occupied, unsigned char *cell)
{
  PetscInt local[2], all[2];

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < 8; ++k) {
    PetscCall(AddRing(m, cell));
    local[0] = local[1] = 0;
    for (PetscInt c = 0; c < m->grid->n_cells; ++c) {
      local[0] += occupied[c];
      local[1] += cell[c];
    }
    PetscCall(MPIU_Allreduce(local, all, 2, MPIU_INT, MPI_SUM, m->comm));
    const PetscInt per_ring = (all[1] - all[0]) / (k + 1);
    if (10 * (all[1] + per_ring) > 11 * all[0]) break;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ModelEnable(Model *m)
{
  const NodalScene scene = nodal_scene(m, m->time, m->nodes->du);
  const BasisInput basis = {.spec = &m->c->basis, .grid = m->grid};
  const BasisSites sites = {.cell = m->enabled};
  NodeGroups groups;

  PetscFunctionBeginUser;
  PetscCall(NodeGroupsCreate(m->space->support->n_groups, &groups));
  if (m->method->couplings) PetscCall(m->method->couplings(m->space, &groups));
  else PetscCall(m->space->basis->couplings(&basis, &sites, &groups));
  PetscCall(NodalForcesCouple(&m->forces, &scene, &groups));
  PetscCall(SystemBuild(m->system, m->grid, &groups));
  PetscCall(NodeGroupsDestroy(&groups));
  PetscFunctionReturn(0);
}

/* Slots of all groups and nodal forces; `complete` is false if the system lacks a pair of them on
 * any rank. Enabled cells couple all that their points can, clouds what they did when they were asked. */
static PetscErrorCode FindSlots(Model *m, PetscBool *complete)
{
  PetscBool here = PETSC_TRUE;

  PetscFunctionBeginUser;
  if (m->method->clouds) PetscCall(SystemSlots(m->system, m->space->support, &here));
  else system_slots_later(m->system, m->space->support);
  here = here && nodal_forces_find_slots(&m->forces, m->system);
  PetscCallMPI(MPI_Allreduce(&here, complete, 1, MPIU_BOOL, MPI_LAND, m->comm));
  PetscFunctionReturn(0);
}

/* Clouds change from step to step: the system lasts until a pair of nodes meets that it does not
 * couple, or nodes changed their ranks. */
static PetscErrorCode ActivateClouds(Model *m)
{
  PetscBool complete = PETSC_FALSE;

  PetscFunctionBeginUser;
  if (m->system->builds && m->layouts == m->grid->cloud->layouts) PetscCall(FindSlots(m, &complete));
  m->layouts = m->grid->cloud->layouts;
  if (!complete) {
    /* of nodes that may lose their unknowns */
    PetscCall(PetscArrayzero(m->nodes->force, m->grid->n_nodes * m->dim));
    PetscCall(ModelEnable(m));
    PetscCall(FindSlots(m, &complete));
    PetscCheck(complete, m->comm, PETSC_ERR_PLIB, "the system lacks couplings that it was built for");
  }
  PetscCall(MPIU_Allreduce(&m->space->constraints->n, &m->n_constraints, 1, MPIU_INT, MPI_SUM, m->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelActivate(Model *m)
{
  const AnalysisSpec *analysis = &m->c->analysis;
  unsigned char *occupied;
  PetscBool fits = PETSC_FALSE, complete;

  PetscFunctionBeginUser;
  PetscCall(ModelInitialise(m));
  const NodalScene scene = nodal_scene(m, m->time, m->nodes->du);
  PetscCall(NodalForcesBegin(&m->forces, &scene));
  if (m->method->clouds) {
    PetscCall(ActivateClouds(m));
    PetscFunctionReturn(0);
  }
  PetscCall(PetscMalloc1(m->grid->n_cells, &occupied));
  flag_occupied(m, occupied);
  PetscCall(StillFits(m, occupied, &fits));
  if (!fits) {
    PetscCall(PetscArraycpy(m->enabled, occupied, m->grid->n_cells));
    if (m->method->restores_grid && analysis->step < analysis->end) PetscCall(AddRings(m, occupied, m->enabled));
    PetscCall(ModelEnable(m));
  }
  PetscCall(PetscFree(occupied));
  PetscCall(FindSlots(m, &complete));
  if (complete) PetscFunctionReturn(0);
  PetscCall(ModelEnable(m)); /* nodal forces have met other nodes */
  PetscCall(FindSlots(m, &complete));
  PetscCheck(complete, m->comm, PETSC_ERR_PLIB, "nodal forces couple nodes that they did not announce");
  PetscFunctionReturn(0);
}
