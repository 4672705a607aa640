/* Packs the parts of a serial mesh, on rank 0.
 *
 * A node belongs to the lowest rank whose cells touch it; each rank numbers its own nodes in the
 * order of the file. */
#include "grid/mesh/mesh_pack.h"

static PetscErrorCode Put(Integers *buffer, PetscInt value)
{
  PetscFunctionBeginUser;
  if (buffer->n == buffer->capacity) {
    buffer->capacity = 2 * buffer->capacity + 4096;
    PetscCall(PetscRealloc((size_t)buffer->capacity * sizeof(PetscInt), &buffer->data));
  }
  buffer->data[buffer->n++] = value;
  PetscFunctionReturn(0);
}

static PetscErrorCode PlanCells(Plan *plan, PetscMPIInt size)
{
  const PetscInt n = plan->mesh->n_cells;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(size + 2, &plan->first_cell));
  PetscCall(PetscMalloc2(n, &plan->order, n, &plan->local_cell));
  for (PetscInt c = 0; c < n; ++c) ++plan->first_cell[plan->owner[c] + 2];
  for (PetscMPIInt r = 0; r < size; ++r) plan->first_cell[r + 2] += plan->first_cell[r + 1];
  for (PetscInt c = 0; c < n; ++c) {
    const PetscInt at = plan->first_cell[plan->owner[c] + 1]++;
    plan->order[at] = c;
  }
  for (PetscMPIInt r = 0; r < size; ++r)
    for (PetscInt at = plan->first_cell[r]; at < plan->first_cell[r + 1]; ++at)
      plan->local_cell[plan->order[at]] = at - plan->first_cell[r];
  PetscFunctionReturn(0);
}

static PetscErrorCode PlanNodes(Plan *plan, PetscMPIInt size)
{
  const SerialMesh *mesh = plan->mesh;
  const PetscInt nn = cells[mesh->type].nodes;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(size + 1, &plan->first_node));
  PetscCall(PetscMalloc4(mesh->n_nodes, &plan->node_owner, mesh->n_nodes, &plan->node_index, mesh->n_nodes,
                         &plan->local_node, mesh->n_nodes, &plan->nodes));
  for (PetscInt k = 0; k < mesh->n_nodes; ++k) plan->node_owner[k] = size, plan->local_node[k] = -1;
  for (PetscInt k = 0; k < mesh->n_cells * nn; ++k) {
    PetscInt *owner = plan->node_owner + mesh->cell_node[k];
    *owner = PetscMin(*owner, plan->owner[k / nn]);
  }
  for (PetscInt k = 0; k < mesh->n_nodes; ++k) plan->node_index[k] = plan->first_node[plan->node_owner[k] + 1]++;
  for (PetscMPIInt r = 0; r < size; ++r) plan->first_node[r + 1] += plan->first_node[r];
  PetscFunctionReturn(0);
}

/* Faces without a neighbour, and their nodes. */
static PetscErrorCode FindOuter(const SerialMesh *mesh, GridSet *outer)
{
  const Cell *shape = cells + mesh->type;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < mesh->n_cells * shape->faces; ++k) outer->n_faces += mesh->neighbour[k] < 0;
  PetscCall(PetscMalloc1(outer->n_faces, &outer->face_cell));
  PetscCall(PetscMalloc1(outer->n_faces, &outer->face_side));
  PetscCall(PetscMalloc1(outer->n_faces * shape->face_nodes, &outer->nodes));
  outer->n_faces = 0;
  for (PetscInt k = 0; k < mesh->n_cells * shape->faces; ++k) {
    if (mesh->neighbour[k] >= 0) continue;
    const PetscInt cell = k / shape->faces, side = k % shape->faces;
    outer->face_cell[outer->n_faces] = cell;
    outer->face_side[outer->n_faces++] = side;
    for (PetscInt i = 0; i < shape->face_nodes; ++i)
      outer->nodes[outer->n_nodes++] = mesh->cell_node[cell * shape->nodes + shape->face[side][i]];
  }
  PetscCall(GridSortUnique(&outer->n_nodes, outer->nodes));
  PetscFunctionReturn(0);
}

PetscErrorCode PlanCreate(Plan *plan, const SerialMesh *mesh, const PetscInt *owner, PetscMPIInt size)
{
  PetscFunctionBeginUser;
  *plan = (Plan){.mesh = mesh, .owner = owner};
  PetscCall(PlanCells(plan, size));
  PetscCall(PlanNodes(plan, size));
  PetscCall(FindOuter(mesh, &plan->outer));
  PetscFunctionReturn(0);
}

PetscErrorCode PlanDestroy(Plan *plan)
{
  PetscFunctionBeginUser;
  PetscCall(GridSetDestroy(&plan->outer));
  PetscCall(PetscFree(plan->first_cell));
  PetscCall(PetscFree2(plan->order, plan->local_cell));
  PetscCall(PetscFree(plan->first_node));
  PetscCall(PetscFree4(plan->node_owner, plan->node_index, plan->local_node, plan->nodes));
  PetscFunctionReturn(0);
}

/* Nodes of the rank's cells: those it owns by their number, the ghosts as they come. */
static void list_nodes(Plan *plan, PetscMPIInt rank)
{
  const SerialMesh *mesh = plan->mesh;
  const PetscInt nn = cells[mesh->type].nodes;
  plan->n_nodes = plan->first_node[rank + 1] - plan->first_node[rank];
  for (PetscInt c = plan->first_cell[rank]; c < plan->first_cell[rank + 1]; ++c)
    for (PetscInt i = 0; i < nn; ++i) {
      const PetscInt node = mesh->cell_node[plan->order[c] * nn + i];
      if (plan->local_node[node] >= 0) continue;
      const PetscInt local = plan->node_owner[node] == rank ? plan->node_index[node] : plan->n_nodes++;
      plan->local_node[node] = local;
      plan->nodes[local] = node;
    }
}

static void forget_nodes(Plan *plan)
{
  for (PetscInt k = 0; k < plan->n_nodes; ++k) plan->local_node[plan->nodes[k]] = -1;
}

static PetscErrorCode PackCells(const Plan *plan, PetscMPIInt rank, Integers *buffer)
{
  const SerialMesh *mesh = plan->mesh;
  const Cell *shape = cells + mesh->type;
  const PetscInt first = plan->first_cell[rank], last = plan->first_cell[rank + 1];

  PetscFunctionBeginUser;
  for (PetscInt c = first; c < last; ++c)
    for (PetscInt i = 0; i < shape->nodes; ++i)
      PetscCall(Put(buffer, plan->local_node[mesh->cell_node[plan->order[c] * shape->nodes + i]]));
  for (PetscInt c = first; c < last; ++c) PetscCall(Put(buffer, plan->order[c]));
  for (PetscInt c = first; c < last; ++c)
    for (PetscInt f = 0; f < shape->faces; ++f) {
      const PetscInt other = mesh->neighbour[plan->order[c] * shape->faces + f];
      PetscInt value = other;
      if (other >= 0) value = plan->owner[other] == rank ? plan->local_cell[other] : -2 - plan->owner[other];
      PetscCall(Put(buffer, value));
    }
  PetscFunctionReturn(0);
}

/* Cells of other ranks beyond the rank's faces, with their number before them. */
static PetscErrorCode PackFarCells(const Plan *plan, PetscMPIInt rank, Integers *buffer)
{
  const PetscInt n_faces = cells[plan->mesh->type].faces, at = buffer->n;

  PetscFunctionBeginUser;
  PetscCall(Put(buffer, 0));
  for (PetscInt c = plan->first_cell[rank]; c < plan->first_cell[rank + 1]; ++c)
    for (PetscInt f = 0; f < n_faces; ++f) {
      const PetscInt other = plan->mesh->neighbour[plan->order[c] * n_faces + f];
      if (other >= 0 && plan->owner[other] != rank) PetscCall(Put(buffer, other));
    }
  buffer->data[at] = buffer->n - at - 1;
  PetscFunctionReturn(0);
}

static PetscErrorCode PackNodes(const Plan *plan, PetscMPIInt rank, Integers *buffer)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < plan->n_nodes; ++k) PetscCall(Put(buffer, plan->nodes[k]));
  for (PetscInt k = 0; k < plan->n_nodes; ++k) {
    const PetscInt node = plan->nodes[k];
    PetscCall(Put(buffer, plan->first_node[plan->node_owner[node]] + plan->node_index[node]));
  }
  for (PetscInt k = plan->first_node[rank + 1] - plan->first_node[rank]; k < plan->n_nodes; ++k) {
    PetscCall(Put(buffer, plan->node_owner[plan->nodes[k]]));
    PetscCall(Put(buffer, plan->node_index[plan->nodes[k]]));
  }
  PetscFunctionReturn(0);
}

/* A list with its length before it: values go through `local`, those that are not on this rank are
 * left out. */
static PetscErrorCode PackSet(const Plan *plan, PetscMPIInt rank, const GridSet *set, Integers *buffer)
{
  PetscInt at = buffer->n;

  PetscFunctionBeginUser;
  PetscCall(Put(buffer, 0));
  for (PetscInt k = 0; k < set->n_nodes; ++k)
    if (plan->local_node[set->nodes[k]] >= 0) PetscCall(Put(buffer, plan->local_node[set->nodes[k]]));
  buffer->data[at] = buffer->n - at - 1;
  for (int side = 0; side < 2; ++side) {
    at = buffer->n;
    PetscCall(Put(buffer, 0));
    for (PetscInt f = 0; f < set->n_faces; ++f)
      if (plan->owner[set->face_cell[f]] == rank)
        PetscCall(Put(buffer, side ? set->face_side[f] : plan->local_cell[set->face_cell[f]]));
    buffer->data[at] = buffer->n - at - 1;
  }
  at = buffer->n;
  PetscCall(Put(buffer, 0));
  for (PetscInt k = 0; k < set->n_cells; ++k)
    if (plan->owner[set->cells[k]] == rank) PetscCall(Put(buffer, plan->local_cell[set->cells[k]]));
  buffer->data[at] = buffer->n - at - 1;
  PetscFunctionReturn(0);
}

PetscErrorCode PlanPack(Plan *plan, PetscMPIInt rank, PetscInt head[HEAD_N], Integers *buffer, PetscReal **x)
{
  const SerialMesh *mesh = plan->mesh;

  PetscFunctionBeginUser;
  buffer->n = buffer->read = 0;
  list_nodes(plan, rank);
  PetscCall(PackCells(plan, rank, buffer));
  PetscCall(PackFarCells(plan, rank, buffer));
  PetscCall(PackNodes(plan, rank, buffer));
  for (PetscInt s = 0; s < mesh->n_sets; ++s) PetscCall(PackSet(plan, rank, mesh->sets + s, buffer));
  PetscCall(PackSet(plan, rank, &plan->outer, buffer));
  PetscCall(PetscMalloc1(plan->n_nodes * mesh->dim, x));
  for (PetscInt k = 0; k < plan->n_nodes; ++k)
    for (PetscInt d = 0; d < mesh->dim; ++d) (*x)[k * mesh->dim + d] = mesh->x[plan->nodes[k] * mesh->dim + d];
  head[HEAD_CELLS] = plan->first_cell[rank + 1] - plan->first_cell[rank];
  head[HEAD_OWNED] = plan->first_node[rank + 1] - plan->first_node[rank];
  head[HEAD_NODES] = plan->n_nodes;
  head[HEAD_INTEGERS] = buffer->n;
  forget_nodes(plan);
  PetscFunctionReturn(0);
}
