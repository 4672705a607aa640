/* Packs the cells of a mesh by the ranks that they go to, and sends them: no rank sees more than its old part and its new one. */
#include "base/exchange.h"
#include "grid/mesh/mesh_travel.h"

/* What goes where. */
typedef struct {
  const Grid *grid;
  const PetscMPIInt *owner;
  PetscMPIInt size;
  PetscInt *first, *order;                 /* cells in the order of their ranks */
  PetscInt *beyond;                        /* n_cells x faces: number of the cell beyond, -1 outside */
  PetscInt *mark;                          /* per node: the last message that it was put into */
  PetscInt *n_cells, *n_nodes, *n_members; /* per rank */
} Luggage;

static void sort_cells(Luggage *l)
{
  const PetscInt n = l->grid->n_cells;
  for (PetscInt c = 0; c < n; ++c) ++l->n_cells[l->owner[c]];
  for (PetscMPIInt r = 0; r < l->size; ++r) l->first[r + 1] = l->first[r] + l->n_cells[r];
  for (PetscInt c = 0; c < n; ++c) l->order[l->first[l->owner[c]]++] = c;
  for (PetscMPIInt r = l->size; r > 0; --r) l->first[r] = l->first[r - 1];
  l->first[0] = 0;
}

/* Neighbours by numbers that hold on every rank. */
static void name_neighbours(Luggage *l)
{
  const Grid *grid = l->grid;
  const PetscInt n = grid->n_cells * cells[grid->type].faces, *far_cell = grid->bins->far_cell;
  for (PetscInt k = 0; k < n; ++k) {
    const PetscInt other = grid->bins->neighbour[k];
    l->beyond[k] = other >= 0 ? grid->global_cell[other] : other == -1 ? -1 : *far_cell++;
  }
}

static PetscErrorCode LuggageCreate(const Grid *grid, const PetscMPIInt *owner, Luggage *l)
{
  const PetscInt n = grid->n_cells;

  PetscFunctionBeginUser;
  *l = (Luggage){.grid = grid, .owner = owner};
  PetscCallMPI(MPI_Comm_size(grid->comm, &l->size));
  PetscCall(PetscMalloc3(n, &l->order, n * cells[grid->type].faces, &l->beyond, grid->n_nodes, &l->mark));
  PetscCall(PetscCalloc4(l->size + 1, &l->first, l->size, &l->n_cells, l->size, &l->n_nodes, l->size, &l->n_members));
  for (PetscInt i = 0; i < grid->n_nodes; ++i) l->mark[i] = -1;
  sort_cells(l);
  name_neighbours(l);
  PetscFunctionReturn(0);
}

static PetscErrorCode LuggageDestroy(Luggage *l)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(l->order, l->beyond, l->mark));
  PetscCall(PetscFree4(l->first, l->n_cells, l->n_nodes, l->n_members));
  PetscFunctionReturn(0);
}

static void pack_cell(const Luggage *l, PetscInt cell, PetscInt *row)
{
  const Grid *grid = l->grid;
  const PetscInt nn = grid->nodes_per_cell, n_faces = cells[grid->type].faces;
  *row++ = grid->global_cell[cell];
  for (PetscInt i = 0; i < nn; ++i) *row++ = grid->bins->file_node[grid->cell_node[cell * nn + i]];
  for (PetscInt f = 0; f < n_faces; ++f) *row++ = l->beyond[cell * n_faces + f];
}

static MeshNode pack_node(const Grid *grid, PetscInt node)
{
  MeshNode out = {.number = grid->bins->file_node[node]};
  for (PetscInt d = 0; d < grid->dim; ++d) out.x[d] = grid->x[node * grid->dim + d];
  return out;
}

/* Nodes of the cells that go to a rank, each once; returns how many, and writes them where `out` is given. */
static PetscInt list_nodes(const Luggage *l, PetscMPIInt rank, PetscInt message, MeshNode *out)
{
  const PetscInt nn = l->grid->nodes_per_cell;
  PetscInt n = 0;
  for (PetscInt k = l->first[rank] * nn; k < l->first[rank + 1] * nn; ++k) {
    const PetscInt node = l->grid->cell_node[l->order[k / nn] * nn + k % nn];
    if (l->mark[node] == message) continue;
    l->mark[node] = message;
    if (out) out[n] = pack_node(l->grid, node);
    ++n;
  }
  return n;
}

/* Which of what goes to a rank is in which set; its nodes have been marked. */
static PetscInt list_members(const Luggage *l, PetscMPIInt rank, PetscInt message, MeshMember *out)
{
  const Grid *grid = l->grid;
  PetscInt n = 0;
  for (PetscInt s = 0; s <= grid->n_sets; ++s) {
    const GridSet *set = s < grid->n_sets ? grid->sets + s : &grid->outer;
    for (PetscInt i = 0; i < set->n_nodes; ++i) {
      if (l->mark[set->nodes[i]] != message) continue;
      if (out) out[n] = (MeshMember){s, MEMBER_NODE, grid->bins->file_node[set->nodes[i]], 0};
      ++n;
    }
    for (PetscInt f = 0; f < set->n_faces; ++f) {
      if (l->owner[set->face_cell[f]] != rank) continue;
      if (out) out[n] = (MeshMember){s, MEMBER_FACE, grid->global_cell[set->face_cell[f]], set->face_side[f]};
      ++n;
    }
    for (PetscInt c = 0; c < set->n_cells; ++c) {
      if (l->owner[set->cells[c]] != rank) continue;
      if (out) out[n] = (MeshMember){s, MEMBER_CELL, grid->global_cell[set->cells[c]], 0};
      ++n;
    }
  }
  return n;
}

/* Everything in the order of the ranks. */
static PetscErrorCode Pack(Luggage *l, MeshParcel *out)
{
  const PetscInt width = mesh_row(l->grid);
  MeshNode *node;
  MeshMember *member;

  PetscFunctionBeginUser;
  *out = (MeshParcel){.n_cells = l->grid->n_cells};
  for (PetscMPIInt r = 0; r < l->size; ++r) {
    if (!l->n_cells[r]) continue;
    out->n_nodes += l->n_nodes[r] = list_nodes(l, r, r, NULL);
    out->n_members += l->n_members[r] = list_members(l, r, r, NULL);
  }
  PetscCall(PetscMalloc1(out->n_cells * width, &out->cell));
  PetscCall(PetscMalloc1(out->n_nodes, &out->node));
  PetscCall(PetscMalloc1(out->n_members, &out->member));
  for (PetscInt c = 0; c < out->n_cells; ++c) pack_cell(l, l->order[c], out->cell + c * width);
  node = out->node;
  member = out->member;
  for (PetscMPIInt r = 0; r < l->size; ++r) {
    if (!l->n_cells[r]) continue;
    node += list_nodes(l, r, l->size + r, node);
    member += list_members(l, r, l->size + r, member);
  }
  PetscFunctionReturn(0);
}

/* Items in the order of the ranks that they go to; what comes is to be freed. */
static PetscErrorCode Fly(const Luggage *l, const PetscInt *per_rank, size_t bytes, void *out, PetscInt *n, void *in)
{
  PetscMPIInt *slot;
  Exchange e;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(l->size, &slot));
  PetscCall(ExchangeCreate(l->grid->comm, l->size, per_rank, slot, &e));
  *n = e.from_start[e.n_from];
  PetscCall(PetscMalloc(bytes * (size_t)*n, (void **)in));
  PetscCall(ExchangeItems(&e, bytes, PETSC_FALSE, out, *(char **)in));
  PetscCall(ExchangeDestroy(&e));
  PetscCall(PetscFree(slot));
  PetscFunctionReturn(0);
}

PetscErrorCode MeshParcelDestroy(MeshParcel *parcel)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(parcel->cell));
  PetscCall(PetscFree(parcel->node));
  PetscCall(PetscFree(parcel->member));
  PetscFunctionReturn(0);
}

PetscErrorCode MeshSend(const Grid *grid, const PetscMPIInt *owner, MeshParcel *in)
{
  MeshParcel out;
  Luggage l;

  PetscFunctionBeginUser;
  PetscCall(LuggageCreate(grid, owner, &l));
  PetscCall(Pack(&l, &out));
  PetscCall(Fly(&l, l.n_cells, sizeof *out.cell * (size_t)mesh_row(grid), out.cell, &in->n_cells, &in->cell));
  PetscCall(Fly(&l, l.n_nodes, sizeof *out.node, out.node, &in->n_nodes, &in->node));
  PetscCall(Fly(&l, l.n_members, sizeof *out.member, out.member, &in->n_members, &in->member));
  PetscCall(MeshParcelDestroy(&out));
  PetscCall(LuggageDestroy(&l));
  PetscFunctionReturn(0);
}
