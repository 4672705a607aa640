/* Makes the grid of a rank's cells when they have arrived: cells in the order of the file, those of
 * the lesser kind first. A node belongs to the lowest rank that has it; owners number theirs in the
 * order of the file. Nothing depends on where they came from. */
#include "grid/search/directory.h"
#include "grid/mesh/mesh_part.h"

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
  grid->ops = old->ops;
  grid->comm = old->comm;
  grid->dim = old->dim;
  grid->type = old->type;
  grid->first_type = old->first_type;
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
static PetscErrorCode OrderCells(Grid *grid, const MeshPart *in, PetscInt *order)
{
  /* where a row has its last node */
  const PetscInt width = mesh_row(grid), last = grid->nodes_per_cell;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  grid->n_cells = in->n_cells;
  PetscCall(PetscMalloc1(grid->n_cells, &grid->global_cell));
  for (int full = 0; full < 2; ++full) {
    for (PetscInt c = 0; c < grid->n_cells; ++c)
      if ((in->cell[c * width + last] >= 0) == full) order[n++] = c;
    if (!full) grid->n_first = n;
  }
  for (PetscInt c = 0; c < n; ++c) grid->global_cell[c] = in->cell[order[c] * width];
  PetscCall(PetscSortIntWithArray(grid->n_first, grid->global_cell, order));
  PetscCall(PetscSortIntWithArray(n - grid->n_first, grid->global_cell + grid->n_first, order + grid->n_first));
  PetscFunctionReturn(0);
}

/* The local cell of a number; -1: it is not here. */
static PetscErrorCode FindCell(const Grid *grid, PetscInt number, PetscInt *cell)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFindInt(number, grid->n_first, grid->global_cell, cell));
  if (*cell >= 0) PetscFunctionReturn(0);
  PetscCall(PetscFindInt(number, grid->n_cells - grid->n_first, grid->global_cell + grid->n_first, cell));
  *cell = *cell < 0 ? -1 : *cell + grid->n_first;
  PetscFunctionReturn(0);
}

/* Each node once, and whose it is. */
static PetscErrorCode ArrivalsCreate(const Grid *grid, const MeshPart *in, Arrivals *a)
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
static PetscErrorCode NumberNodes(Grid *grid, const MeshPart *in, const PetscInt *order, Arrivals *a)
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
    const PetscInt number = in->cell[order[k / nn] * width + 1 + k % nn];
    if (number < 0) { /* a cell of the lesser kind */
      grid->cell_node[k] = grid->cell_node[k - 1];
      continue;
    }
    PetscCall(Find(number, a->n, a->number, &at));
    if (a->local[at] < 0) a->local[at] = grid->n_nodes++;
    grid->cell_node[k] = a->local[at];
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode PlaceNodes(Grid *grid, const MeshPart *in, const Arrivals *a)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(grid->n_nodes, &grid->mesh->file_node));
  PetscCall(PetscMalloc1(grid->n_nodes * grid->dim, &grid->x));
  for (PetscInt i = 0; i < a->n; ++i) {
    grid->mesh->file_node[a->local[i]] = a->number[i];
    for (PetscInt d = 0; d < grid->dim; ++d) grid->x[a->local[i] * grid->dim + d] = in->node[a->item[i]].x[d];
  }
  PetscFunctionReturn(0);
}

static PetscBool is_outer(const Grid *grid, const MeshPart *in, PetscInt row, PetscInt cell)
{
  const PetscInt *beyond = in->cell + row * mesh_row(grid) + 1 + grid->nodes_per_cell;
  for (PetscInt f = 0; f < grid_cell(grid, cell)->faces; ++f)
    if (beyond[f] < 0) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Numbers in the file of the nodes of cells at the outer boundary, of all ranks. */
static PetscErrorCode SurfaceNodes(const Grid *grid, const MeshPart *in, const PetscInt *order, PetscInt *n,
                                   PetscInt **number)
{
  const PetscInt nn = grid->nodes_per_cell;
  PetscMPIInt size, mine, *count, *start;
  PetscInt *own, n_own = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(grid->comm, &size));
  PetscCall(PetscMalloc3(grid->n_cells * nn, &own, size, &count, size + 1, &start));
  for (PetscInt c = 0; c < grid->n_cells; ++c)
    for (PetscInt i = 0; i < nn && is_outer(grid, in, order[c], c); ++i)
      own[n_own++] = grid->mesh->file_node[grid->cell_node[c * nn + i]];
  PetscCall(PetscSortRemoveDupsInt(&n_own, own));
  PetscCall(PetscMPIIntCast(n_own, &mine));
  PetscCallMPI(MPI_Allgather(&mine, 1, MPI_INT, count, 1, MPI_INT, grid->comm));
  start[0] = 0;
  for (PetscMPIInt r = 0; r < size; ++r) start[r + 1] = start[r] + count[r];
  *n = start[size];
  PetscCall(PetscMalloc1(*n, number));
  PetscCallMPI(MPI_Allgatherv(own, mine, MPIU_INT, *number, count, start, MPIU_INT, grid->comm));
  PetscCall(PetscSortRemoveDupsInt(n, *number));
  PetscCall(PetscFree3(own, count, start));
  PetscFunctionReturn(0);
}

/* Bodies meet where other ranks have their cells: the nodes of those become ghosts without cells. */
static PetscErrorCode KnowSurface(Grid *grid, const MeshPart *in, const PetscInt *order, const Arrivals *a)
{
  PetscInt n, *number, at;

  PetscFunctionBeginUser;
  PetscCall(SurfaceNodes(grid, in, order, &n, &number));
  PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)(grid->n_nodes + n), &grid->mesh->file_node));
  for (PetscInt i = 0; i < n; ++i) {
    PetscCall(PetscFindInt(number[i], a->n, a->number, &at));
    if (at < 0) grid->mesh->file_node[grid->n_nodes++] = number[i];
  }
  PetscCall(PetscRealloc(sizeof(PetscReal) * (size_t)(grid->n_nodes * grid->dim), &grid->x));
  PetscCall(PetscFree(number));
  PetscFunctionReturn(0);
}

/* Ties ghosts to their owners, and tells all how owners number them. */
static PetscErrorCode TieNodes(Grid *grid)
{
  const PetscInt n = grid->n_nodes - grid->n_owned, *file_node = grid->mesh->file_node;
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
static PetscErrorCode FindNeighbours(Grid *grid, const MeshPart *in, const PetscInt *order)
{
  const PetscInt width = mesh_row(grid), n_faces = mesh_faces(grid), n = grid->n_cells * n_faces;
  PetscInt n_far = 0, *neighbour, *far_cell;
  DirectoryPlace *place;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &neighbour));
  for (PetscInt k = 0; k < n; ++k) {
    const PetscInt other = in->cell[order[k / n_faces] * width + 1 + grid->nodes_per_cell + k % n_faces];
    neighbour[k] = -1;
    if (other < 0) continue;
    PetscCall(FindCell(grid, other, &neighbour[k]));
    if (neighbour[k] < 0) neighbour[k] = -2 - other, ++n_far;
  }
  PetscCall(PetscMalloc1(n_far, &far_cell));
  PetscCall(PetscMalloc1(n_far, &place));
  for (PetscInt k = 0, f = 0; k < n; ++k)
    if (neighbour[k] <= -2) far_cell[f++] = -2 - neighbour[k];
  PetscCall(DirectoryFind(grid->comm, grid->n_cells_global, grid->n_cells, grid->global_cell, n_far, far_cell, place));
  for (PetscInt k = 0, f = 0; k < n; ++k)
    if (neighbour[k] <= -2) neighbour[k] = -2 - place[f++].rank;
  PetscCall(PetscFree(place));
  grid->mesh->neighbour = neighbour;
  grid->mesh->far_cell = far_cell;
  PetscFunctionReturn(0);
}

static PetscErrorCode SetRoom(const Grid *grid, const MeshPart *in, GridSet **set)
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

/* A node comes once from each rank that sent it. Cell and side of a face are one number until they
 * are sorted. */
static PetscErrorCode SortSet(const Grid *grid, GridSet *set)
{
  const PetscInt n_faces = mesh_faces(grid);

  PetscFunctionBeginUser;
  PetscCall(PetscSortRemoveDupsInt(&set->n_nodes, set->nodes));
  PetscCall(PetscSortInt(set->n_faces, set->face_cell));
  PetscCall(PetscSortInt(set->n_cells, set->cells));
  for (PetscInt f = 0; f < set->n_faces; ++f) {
    set->face_side[f] = set->face_cell[f] % n_faces;
    set->face_cell[f] /= n_faces;
  }
  PetscFunctionReturn(0);
}

/* Of ghosts without cells nobody has sent which sets they are in: their owners tell. */
static PetscErrorCode KnowMembers(const Grid *grid, GridSet *set)
{
  PetscReal *member;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(grid->n_nodes, &member));
  for (PetscInt k = 0; k < set->n_nodes; ++k) member[set->nodes[k]] = 1;
  PetscCall(GridToGhosts(grid, 1, member));
  set->n_nodes = 0;
  PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)grid->n_nodes, &set->nodes));
  for (PetscInt i = 0; i < grid->n_nodes; ++i)
    if (member[i] > 0) set->nodes[set->n_nodes++] = i;
  PetscCall(PetscFree(member));
  PetscFunctionReturn(0);
}

static PetscErrorCode FillSets(Grid *grid, const MeshPart *in, const Arrivals *a)
{
  const PetscInt n_faces = mesh_faces(grid);
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
    PetscCall(FindCell(grid, m->number, &at));
    PetscCheck(at >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "cell %d of a set did not arrive", (int)m->number);
    if (m->kind == MEMBER_FACE) s->face_cell[s->n_faces++] = at * n_faces + m->side;
    else s->cells[s->n_cells++] = at;
  }
  for (PetscInt s = 0; s <= grid->n_sets; ++s) {
    PetscCall(SortSet(grid, set[s]));
    if (grid->mesh->knows_surface) PetscCall(KnowMembers(grid, set[s]));
  }
  PetscCall(PetscFree(set));
  PetscFunctionReturn(0);
}

/* The search trees, for the nodes where they are. */
static PetscErrorCode SearchTrees(Grid *grid)
{
  PetscReal size = 0, far = 0; /* coordinates of maps are rounded by more than the mesh is */

  PetscFunctionBeginUser;
  for (PetscInt d = 0; d < grid->dim; ++d) {
    size = PetscMax(size, grid->max[d] - grid->min[d]);
    far = PetscMax(far, PetscMax(PetscAbsReal(grid->min[d]), PetscAbsReal(grid->max[d])));
  }
  grid->mesh->tolerance = PetscMax(1e-10, (2e-12 * size + 1e-14 * far) / grid->smallest);
  PetscCall(MeshCellTree(grid, &grid->mesh->cell_tree));
  PetscCall(MeshFaceTree(grid, &grid->mesh->face_tree));
  PetscFunctionReturn(0);
}

static PetscErrorCode Build(Grid *grid, const MeshPart *in, PetscBool knows_surface)
{
  PetscInt *order;
  Arrivals a;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&grid->mesh));
  PetscCall(PetscMalloc1(in->n_cells, &order));
  PetscCall(OrderCells(grid, in, order));
  PetscCall(ArrivalsCreate(grid, in, &a));
  PetscCall(NumberNodes(grid, in, order, &a));
  PetscCall(PlaceNodes(grid, in, &a));
  grid->mesh->knows_surface = knows_surface;
  if (knows_surface) PetscCall(KnowSurface(grid, in, order, &a));
  PetscCall(TieNodes(grid));
  if (knows_surface) PetscCall(GridToGhosts(grid, grid->dim, grid->x));
  PetscCall(FindNeighbours(grid, in, order));
  PetscCall(FillSets(grid, in, &a));
  PetscCall(ArrivalsDestroy(&a));
  PetscCall(PetscFree(order));
  PetscCall(SearchTrees(grid));
  PetscCall(GridFinish(grid));
  PetscFunctionReturn(0);
}

static PetscErrorCode Remake(const Grid *old, const PetscMPIInt *owner, PetscBool knows_surface, Grid **grid)
{
  MeshPart part;

  PetscFunctionBeginUser;
  PetscCall(MeshSend(old, owner, &part));
  PetscCall(GridLike(old, grid));
  PetscCall(Build(*grid, &part, knows_surface));
  PetscCall(MeshPartDestroy(&part));
  PetscFunctionReturn(0);
}

PetscErrorCode MeshFromOwners(const Grid *old, const PetscMPIInt *owner, Grid **grid)
{
  PetscFunctionBeginUser;
  PetscCall(Remake(old, owner, old->mesh->knows_surface, grid));
  PetscFunctionReturn(0);
}

PetscErrorCode MeshWiden(const Grid *old, PetscInt layers, Grid **grid)
{
  PetscMPIInt rank, *owner;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(old->comm, &rank));
  PetscCall(PetscMalloc1(old->n_cells, &owner));
  for (PetscInt c = 0; c < old->n_cells; ++c) owner[c] = rank;
  PetscCall(Remake(old, owner, (PetscBool)(layers > 0), grid));
  PetscCall(PetscFree(owner));
  PetscFunctionReturn(0);
}
