/* Makes the grid of a rank's cells when they have arrived: cells in the order of the file, nodes as in mesh_pack.c (each belongs to the lowest rank
 * that has it, and owners number them in the order of the file). Nothing depends on where they came from. */
#include "grid/directory.h"
#include "grid/mesh/mesh_travel.h"

/* The nodes here, by their numbers in the file. */
typedef struct {
  PetscInt n, *number, *item; /* ascending; item: where it stands in the parcel */
  PetscInt *owner, *local;
} Arrivals;

/* Where a number stands in an ascending list that has it. */
static PetscErrorCode Find(PetscInt number, PetscInt n, const PetscInt *list, PetscInt *at)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFindInt(number, n, list, at));
  PetscCheck(*at >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "number %d of the mesh did not arrive", (int)number);
  PetscFunctionReturn(0);
}

static PetscErrorCode GridLike(const Grid *old, Grid **out)
{
  Grid *grid;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&grid));
  grid->comm = old->comm;
  grid->dim = old->dim;
  grid->type = old->type;
  grid->nodes_per_cell = old->nodes_per_cell;
  grid->n_cells_global = old->n_cells_global;
  grid->n_nodes_global = old->n_nodes_global;
  grid->smallest = old->smallest;
  PetscCall(PetscArraycpy(grid->min, old->min, 3));
  PetscCall(PetscArraycpy(grid->max, old->max, 3));
  grid->n_sets = old->n_sets;
  PetscCall(PetscCalloc1(grid->n_sets, &grid->sets));
  for (PetscInt s = 0; s < grid->n_sets; ++s) PetscCall(PetscStrallocpy(old->sets[s].name, &grid->sets[s].name));
  *out = grid;
  PetscFunctionReturn(0);
}

/* order[c]: the row of local cell c. */
static PetscErrorCode OrderCells(Grid *grid, const MeshParcel *in, PetscInt *order)
{
  const PetscInt width = mesh_row(grid);

  PetscFunctionBeginUser;
  grid->n_cells = in->n_cells;
  PetscCall(PetscMalloc1(grid->n_cells, &grid->global_cell));
  for (PetscInt c = 0; c < grid->n_cells; ++c) {
    grid->global_cell[c] = in->cell[c * width];
    order[c] = c;
  }
  PetscCall(PetscSortIntWithArray(grid->n_cells, grid->global_cell, order));
  PetscFunctionReturn(0);
}

/* Each node once, and whose it is. */
static PetscErrorCode ArrivalsCreate(const Grid *grid, const MeshParcel *in, Arrivals *a)
{
  const PetscInt n = in->n_nodes;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(n, &a->number, n, &a->item, n, &a->owner, n, &a->local));
  for (PetscInt i = 0; i < n; ++i) {
    a->number[i] = (PetscInt)in->node[i].number;
    a->item[i] = i;
  }
  PetscCall(PetscSortIntWithArray(n, a->number, a->item));
  a->n = 0;
  for (PetscInt i = 0; i < n; ++i) {
    if (a->n && a->number[i] == a->number[a->n - 1]) continue;
    a->number[a->n] = a->number[i];
    a->item[a->n++] = a->item[i];
  }
  PetscCall(DirectoryLowest(grid->comm, grid->n_nodes_global, a->n, a->number, a->owner));
  PetscFunctionReturn(0);
}

static PetscErrorCode ArrivalsDestroy(Arrivals *a)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree4(a->number, a->item, a->owner, a->local));
  PetscFunctionReturn(0);
}

/* Owned nodes in the order of the file, ghosts as they come in the cells. */
static PetscErrorCode NumberNodes(Grid *grid, const MeshParcel *in, const PetscInt *order, Arrivals *a)
{
  const PetscInt width = mesh_row(grid), nn = grid->nodes_per_cell;
  PetscMPIInt rank;
  PetscInt at;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(grid->comm, &rank));
  for (PetscInt i = 0; i < a->n; ++i) a->local[i] = a->owner[i] == rank ? grid->n_owned++ : -1;
  grid->n_nodes = grid->n_owned;
  PetscCall(PetscMalloc1(grid->n_cells * nn, &grid->cell_node));
  for (PetscInt k = 0; k < grid->n_cells * nn; ++k) {
    PetscCall(Find(in->cell[order[k / nn] * width + 1 + k % nn], a->n, a->number, &at));
    if (a->local[at] < 0) a->local[at] = grid->n_nodes++;
    grid->cell_node[k] = a->local[at];
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode PlaceNodes(Grid *grid, const MeshParcel *in, const Arrivals *a, PetscInt **file_node)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(grid->n_nodes, file_node));
  PetscCall(PetscMalloc1(grid->n_nodes * grid->dim, &grid->x));
  for (PetscInt i = 0; i < a->n; ++i) {
    (*file_node)[a->local[i]] = a->number[i];
    for (PetscInt d = 0; d < grid->dim; ++d) grid->x[a->local[i] * grid->dim + d] = in->node[a->item[i]].x[d];
  }
  PetscFunctionReturn(0);
}

/* Ties ghosts to their owners, and tells all how owners number them. */
static PetscErrorCode TieNodes(Grid *grid, const PetscInt *file_node)
{
  const PetscInt n = grid->n_nodes - grid->n_owned;
  PetscInt first = 0, *leaf;
  PetscSFNode *root;
  DirectoryPlace *place;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &place));
  PetscCall(PetscMalloc1(n, &leaf));
  PetscCall(PetscMalloc1(n, &root));
  PetscCall(
    DirectoryFind(grid->comm, grid->n_nodes_global, grid->n_owned, file_node, n, file_node + grid->n_owned, place));
  for (PetscInt g = 0; g < n; ++g) {
    leaf[g] = grid->n_owned + g;
    root[g] = (PetscSFNode){.rank = place[g].rank, .index = place[g].index};
  }
  PetscCall(PetscFree(place));
  PetscCall(PetscSFCreate(grid->comm, &grid->node_sf));
  PetscCall(PetscSFSetGraph(grid->node_sf, grid->n_owned, n, leaf, PETSC_OWN_POINTER, root, PETSC_OWN_POINTER));
  PetscCallMPI(MPI_Exscan(&grid->n_owned, &first, 1, MPIU_INT, MPI_SUM, grid->comm));
  PetscCall(PetscMalloc1(grid->n_nodes, &grid->global_node));
  for (PetscInt i = 0; i < grid->n_owned; ++i) grid->global_node[i] = first + i;
  PetscCall(PetscSFBcastBegin(grid->node_sf, MPIU_INT, grid->global_node, grid->global_node, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(grid->node_sf, MPIU_INT, grid->global_node, grid->global_node, MPI_REPLACE));
  PetscFunctionReturn(0);
}

/* Neighbours that are here by their local number, the others by their rank. */
static PetscErrorCode FindNeighbours(const Grid *grid, const MeshParcel *in, const PetscInt *order,
                                     PetscInt **neighbour, PetscInt **far_cell)
{
  const PetscInt width = mesh_row(grid), n_faces = cells[grid->type].faces, n = grid->n_cells * n_faces;
  PetscInt n_far = 0;
  DirectoryPlace *place;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, neighbour));
  for (PetscInt k = 0; k < n; ++k) {
    const PetscInt other = in->cell[order[k / n_faces] * width + 1 + grid->nodes_per_cell + k % n_faces];
    (*neighbour)[k] = -1;
    if (other < 0) continue;
    PetscCall(PetscFindInt(other, grid->n_cells, grid->global_cell, &(*neighbour)[k]));
    if ((*neighbour)[k] < 0) (*neighbour)[k] = -2 - other, ++n_far;
  }
  PetscCall(PetscMalloc1(n_far, far_cell));
  PetscCall(PetscMalloc1(n_far, &place));
  for (PetscInt k = 0, f = 0; k < n; ++k)
    if ((*neighbour)[k] <= -2) (*far_cell)[f++] = -2 - (*neighbour)[k];
  PetscCall(DirectoryFind(grid->comm, grid->n_cells_global, grid->n_cells, grid->global_cell, n_far, *far_cell, place));
  for (PetscInt k = 0, f = 0; k < n; ++k)
    if ((*neighbour)[k] <= -2) (*neighbour)[k] = -2 - place[f++].rank;
  PetscCall(PetscFree(place));
  PetscFunctionReturn(0);
}

static PetscErrorCode SetRoom(const Grid *grid, const MeshParcel *in, GridSet **set)
{
  PetscInt(*count)[3];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc(sizeof *count * (size_t)(grid->n_sets + 1), &count));
  for (PetscInt i = 0; i < in->n_members; ++i) ++count[in->member[i].set][in->member[i].kind];
  for (PetscInt s = 0; s <= grid->n_sets; ++s) {
    PetscCall(PetscMalloc1(count[s][MEMBER_NODE], &set[s]->nodes));
    PetscCall(PetscMalloc1(count[s][MEMBER_FACE], &set[s]->face_cell));
    PetscCall(PetscMalloc1(count[s][MEMBER_FACE], &set[s]->face_side));
    PetscCall(PetscMalloc1(count[s][MEMBER_CELL], &set[s]->cells));
  }
  PetscCall(PetscFree(count));
  PetscFunctionReturn(0);
}

/* A node comes once from each rank that sent it. Cell and side of a face are one number until they are sorted. */
static PetscErrorCode SortSet(const Grid *grid, GridSet *set)
{
  const PetscInt n_faces = cells[grid->type].faces;

  PetscFunctionBeginUser;
  PetscCall(GridSortUnique(&set->n_nodes, set->nodes));
  PetscCall(PetscSortInt(set->n_faces, set->face_cell));
  PetscCall(PetscSortInt(set->n_cells, set->cells));
  for (PetscInt f = 0; f < set->n_faces; ++f) {
    set->face_side[f] = set->face_cell[f] % n_faces;
    set->face_cell[f] /= n_faces;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode FillSets(Grid *grid, const MeshParcel *in, const Arrivals *a)
{
  const PetscInt n_faces = cells[grid->type].faces;
  GridSet **set;
  PetscInt at;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(grid->n_sets + 1, &set));
  for (PetscInt s = 0; s <= grid->n_sets; ++s) set[s] = s < grid->n_sets ? grid->sets + s : &grid->outer;
  PetscCall(SetRoom(grid, in, set));
  for (PetscInt i = 0; i < in->n_members; ++i) {
    const MeshMember *m = in->member + i;
    GridSet *s = set[m->set];
    if (m->kind == MEMBER_NODE) {
      PetscCall(Find(m->number, a->n, a->number, &at));
      s->nodes[s->n_nodes++] = a->local[at];
      continue;
    }
    PetscCall(Find(m->number, grid->n_cells, grid->global_cell, &at));
    if (m->kind == MEMBER_FACE) s->face_cell[s->n_faces++] = at * n_faces + m->side;
    else s->cells[s->n_cells++] = at;
  }
  for (PetscInt s = 0; s <= grid->n_sets; ++s) PetscCall(SortSet(grid, set[s]));
  PetscCall(PetscFree(set));
  PetscFunctionReturn(0);
}

PetscErrorCode MeshSettle(const Grid *old, const MeshParcel *in, Grid **out)
{
  PetscInt *order, *neighbour, *far_cell, *file_node;
  Arrivals a;
  Grid *grid = NULL;

  PetscFunctionBeginUser;
  PetscCall(GridLike(old, &grid));
  PetscCall(PetscMalloc1(in->n_cells, &order));
  PetscCall(OrderCells(grid, in, order));
  PetscCall(ArrivalsCreate(grid, in, &a));
  PetscCall(NumberNodes(grid, in, order, &a));
  PetscCall(PlaceNodes(grid, in, &a, &file_node));
  PetscCall(TieNodes(grid, file_node));
  PetscCall(FindNeighbours(grid, in, order, &neighbour, &far_cell));
  PetscCall(FillSets(grid, in, &a));
  PetscCall(ArrivalsDestroy(&a));
  PetscCall(PetscFree(order));
  PetscCall(GridBinsCreate(grid, neighbour, far_cell, file_node));
  PetscCall(GridFinish(grid));
  *out = grid;
  PetscFunctionReturn(0);
}
