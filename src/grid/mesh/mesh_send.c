/* Packs the cells of a mesh by the ranks that they go to, and sends them: no rank sees more than
 * its old part and its new one. */
#include "base/exchange.h"
#include "grid/mesh/mesh_part.h"

/* What goes where. */
typedef struct {
  const Grid *grid;
  const PetscMPIInt *owner;
  PetscMPIInt size;
  PetscInt *first, *order; /* cells in the order of their ranks */
  /* n_cells x faces: number of the cell beyond, -1 outside */
  PetscInt *beyond;
  PetscInt *mark;                          /* per node: the last message that it was put into */
  PetscInt *n_cells, *n_nodes, *n_members; /* per rank */
} SendPlan;

static void sort_cells(SendPlan *p)
{
  const PetscInt n = p->grid->n_cells;
  for (PetscInt c = 0; c < n; ++c) ++p->n_cells[p->owner[c]];
  for (PetscMPIInt r = 0; r < p->size; ++r) p->first[r + 1] = p->first[r] + p->n_cells[r];
  for (PetscInt c = 0; c < n; ++c) p->order[p->first[p->owner[c]]++] = c;
  for (PetscMPIInt r = p->size; r > 0; --r) p->first[r] = p->first[r - 1];
  p->first[0] = 0;
}

/* Neighbours by numbers that hold on every rank. */
static void name_neighbours(SendPlan *p)
{
  const Grid *grid = p->grid;
  const PetscInt n = grid->n_cells * mesh_faces(grid), *far_cell = grid->mesh->far_cell;
  for (PetscInt k = 0; k < n; ++k) {
    const PetscInt other = grid->mesh->neighbour[k];
    p->beyond[k] = other >= 0 ? grid->global_cell[other] : other == -1 ? -1 : *far_cell++;
  }
}

static PetscErrorCode SendPlanCreate(const Grid *grid, const PetscMPIInt *owner, SendPlan *p)
{
  const PetscInt n = grid->n_cells;

  PetscFunctionBeginUser;
  *p = (SendPlan){.grid = grid, .owner = owner};
  PetscCallMPI(MPI_Comm_size(grid->comm, &p->size));
  PetscCall(PetscMalloc3(n, &p->order, n * mesh_faces(grid), &p->beyond, grid->n_nodes, &p->mark));
  PetscCall(PetscCalloc4(p->size + 1, &p->first, p->size, &p->n_cells, p->size, &p->n_nodes, p->size, &p->n_members));
  for (PetscInt i = 0; i < grid->n_nodes; ++i) p->mark[i] = -1;
  sort_cells(p);
  name_neighbours(p);
  PetscFunctionReturn(0);
}

static PetscErrorCode SendPlanDestroy(SendPlan *p)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(p->order, p->beyond, p->mark));
  PetscCall(PetscFree4(p->first, p->n_cells, p->n_nodes, p->n_members));
  PetscFunctionReturn(0);
}

static void pack_cell(const SendPlan *p, PetscInt cell, PetscInt *row)
{
  const Grid *grid = p->grid;
  const PetscInt nn = grid->nodes_per_cell, n_faces = mesh_faces(grid);
  *row++ = grid->global_cell[cell];
  for (PetscInt i = 0; i < nn; ++i)
    *row++ = i < grid_cell(grid, cell)->nodes ? grid->mesh->file_node[grid->cell_node[cell * nn + i]] : -1;
  for (PetscInt f = 0; f < n_faces; ++f) *row++ = p->beyond[cell * n_faces + f];
}

static MeshNode pack_node(const Grid *grid, PetscInt node)
{
  MeshNode out = {.number = grid->mesh->file_node[node]};
  for (PetscInt d = 0; d < grid->dim; ++d) out.x[d] = grid->x[node * grid->dim + d];
  return out;
}

/* Nodes of the cells that go to a rank, each once; returns how many, and writes them where `out` is
 * given. */
static PetscInt list_nodes(const SendPlan *p, PetscMPIInt rank, PetscInt message, MeshNode *out)
{
  const PetscInt nn = p->grid->nodes_per_cell;
  PetscInt n = 0;
  for (PetscInt k = p->first[rank] * nn; k < p->first[rank + 1] * nn; ++k) {
    const PetscInt node = p->grid->cell_node[p->order[k / nn] * nn + k % nn];
    if (p->mark[node] == message) continue;
    p->mark[node] = message;
    if (out) out[n] = pack_node(p->grid, node);
    ++n;
  }
  return n;
}

/* Which of what goes to a rank is in which set; its nodes have been marked. */
static PetscInt list_members(const SendPlan *p, PetscMPIInt rank, PetscInt message, MeshMember *out)
{
  const Grid *grid = p->grid;
  PetscInt n = 0;
  for (PetscInt s = 0; s <= grid->n_sets; ++s) {
    const GridSet *set = s < grid->n_sets ? grid->sets + s : &grid->outer;
    for (PetscInt i = 0; i < set->n_nodes; ++i) {
      if (p->mark[set->nodes[i]] != message) continue;
      if (out) out[n] = (MeshMember){s, MEMBER_NODE, grid->mesh->file_node[set->nodes[i]], 0};
      ++n;
    }
    for (PetscInt f = 0; f < set->n_faces; ++f) {
      if (p->owner[set->face_cell[f]] != rank) continue;
      if (out) out[n] = (MeshMember){s, MEMBER_FACE, grid->global_cell[set->face_cell[f]], set->face_side[f]};
      ++n;
    }
    for (PetscInt c = 0; c < set->n_cells; ++c) {
      if (p->owner[set->cells[c]] != rank) continue;
      if (out) out[n] = (MeshMember){s, MEMBER_CELL, grid->global_cell[set->cells[c]], 0};
      ++n;
    }
  }
  return n;
}

/* Everything in the order of the ranks. */
static PetscErrorCode Pack(SendPlan *p, MeshPart *out)
{
  const PetscInt width = mesh_row(p->grid);
  MeshNode *node;
  MeshMember *member;

  PetscFunctionBeginUser;
  *out = (MeshPart){.n_cells = p->grid->n_cells};
  for (PetscMPIInt r = 0; r < p->size; ++r) {
    if (!p->n_cells[r]) continue;
    out->n_nodes += p->n_nodes[r] = list_nodes(p, r, r, NULL);
    out->n_members += p->n_members[r] = list_members(p, r, r, NULL);
  }
  PetscCall(PetscMalloc1(out->n_cells * width, &out->cell));
  PetscCall(PetscMalloc1(out->n_nodes, &out->node));
  PetscCall(PetscMalloc1(out->n_members, &out->member));
  for (PetscInt c = 0; c < out->n_cells; ++c) pack_cell(p, p->order[c], out->cell + c * width);
  node = out->node;
  member = out->member;
  for (PetscMPIInt r = 0; r < p->size; ++r) {
    if (!p->n_cells[r]) continue;
    node += list_nodes(p, r, p->size + r, node);
    member += list_members(p, r, p->size + r, member);
  }
  PetscFunctionReturn(0);
}

/* Items in the order of the ranks that they go to; what comes is to be freed. */
static PetscErrorCode SendItems(const SendPlan *p, const PetscInt *per_rank, size_t bytes, void *out, PetscInt *n,
                                void *in)
{
  PetscMPIInt *slot;
  Exchange e;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(p->size, &slot));
  PetscCall(ExchangeCreate(p->grid->comm, p->size, per_rank, slot, &e));
  *n = e.from_start[e.n_from];
  PetscCall(PetscMalloc(bytes * (size_t)*n, (void **)in));
  PetscCall(ExchangeItems(&e, bytes, PETSC_FALSE, out, *(char **)in));
  PetscCall(ExchangeDestroy(&e));
  PetscCall(PetscFree(slot));
  PetscFunctionReturn(0);
}

PetscErrorCode MeshPartDestroy(MeshPart *part)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(part->cell));
  PetscCall(PetscFree(part->node));
  PetscCall(PetscFree(part->member));
  PetscFunctionReturn(0);
}

PetscErrorCode MeshSend(const Grid *grid, const PetscMPIInt *owner, MeshPart *in)
{
  MeshPart out;
  SendPlan p;

  PetscFunctionBeginUser;
  PetscCall(SendPlanCreate(grid, owner, &p));
  PetscCall(Pack(&p, &out));
  PetscCall(SendItems(&p, p.n_cells, sizeof *out.cell * (size_t)mesh_row(grid), out.cell, &in->n_cells, &in->cell));
  PetscCall(SendItems(&p, p.n_nodes, sizeof *out.node, out.node, &in->n_nodes, &in->node));
  PetscCall(SendItems(&p, p.n_members, sizeof *out.member, out.member, &in->n_members, &in->member));
  PetscCall(MeshPartDestroy(&out));
  PetscCall(SendPlanDestroy(&p));
  PetscFunctionReturn(0);
}
