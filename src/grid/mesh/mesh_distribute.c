/* Hands the parts of a serial mesh to their ranks: rank 0 packs one part after the other into a
 * message of integers and one of positions, and unpacks its own like everyone else. */
#include "grid/mesh/mesh_pack.h"

enum { TAG_HEAD = 71, TAG_INTEGERS, TAG_POSITIONS };

/* What every rank must know beforehand. */
typedef struct {
  PetscInt dim, type, n_cells, n_nodes, n_sets, names; /* names: bytes of all names with their ends */
} Common;

static PetscErrorCode Take(Integers *buffer, PetscInt n, PetscInt **values)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, values));
  PetscCall(PetscArraycpy(*values, buffer->data + buffer->read, n));
  buffer->read += n;
  PetscFunctionReturn(0);
}

static PetscErrorCode TakeList(Integers *buffer, PetscInt *n, PetscInt **values)
{
  PetscFunctionBeginUser;
  *n = buffer->data[buffer->read++];
  PetscCall(Take(buffer, *n, values));
  PetscFunctionReturn(0);
}

static PetscErrorCode SendPart(MPI_Comm comm, PetscMPIInt rank, const PetscInt head[HEAD_N], const Integers *buffer,
                               const PetscReal *x, PetscInt n_x)
{
  PetscMPIInt n_integers, n_positions;

  PetscFunctionBeginUser;
  PetscCall(PetscMPIIntCast(buffer->n, &n_integers));
  PetscCall(PetscMPIIntCast(n_x, &n_positions));
  PetscCallMPI(MPI_Send(head, HEAD_N, MPIU_INT, rank, TAG_HEAD, comm));
  PetscCallMPI(MPI_Send(buffer->data, n_integers, MPIU_INT, rank, TAG_INTEGERS, comm));
  PetscCallMPI(MPI_Send(x, n_positions, MPIU_REAL, rank, TAG_POSITIONS, comm));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReceivePart(MPI_Comm comm, PetscInt dim, PetscInt head[HEAD_N], Integers *buffer, PetscReal **x)
{
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Recv(head, HEAD_N, MPIU_INT, 0, TAG_HEAD, comm, MPI_STATUS_IGNORE));
  buffer->n = head[HEAD_INTEGERS];
  PetscCall(PetscMalloc1(buffer->n, &buffer->data));
  PetscCall(PetscMalloc1(head[HEAD_NODES] * dim, x));
  PetscCallMPI(MPI_Recv(buffer->data, (PetscMPIInt)buffer->n, MPIU_INT, 0, TAG_INTEGERS, comm, MPI_STATUS_IGNORE));
  PetscCallMPI(
    MPI_Recv(*x, (PetscMPIInt)(head[HEAD_NODES] * dim), MPIU_REAL, 0, TAG_POSITIONS, comm, MPI_STATUS_IGNORE));
  PetscFunctionReturn(0);
}

static PetscErrorCode UnpackSet(Integers *buffer, GridSet *set)
{
  PetscFunctionBeginUser;
  PetscCall(TakeList(buffer, &set->n_nodes, &set->nodes));
  PetscCall(TakeList(buffer, &set->n_faces, &set->face_cell));
  PetscCall(TakeList(buffer, &set->n_faces, &set->face_side));
  PetscCall(TakeList(buffer, &set->n_cells, &set->cells));
  PetscCall(PetscSortInt(set->n_nodes, set->nodes));
  PetscFunctionReturn(0);
}

static PetscErrorCode UnpackGhosts(Grid *grid, Integers *buffer)
{
  const PetscInt n = grid->n_nodes - grid->n_owned;
  PetscInt *leaf;
  PetscSFNode *root;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &leaf));
  PetscCall(PetscMalloc1(n, &root));
  for (PetscInt g = 0; g < n; ++g) {
    leaf[g] = grid->n_owned + g;
    root[g].rank = buffer->data[buffer->read++];
    root[g].index = buffer->data[buffer->read++];
  }
  PetscCall(PetscSFCreate(grid->comm, &grid->node_sf));
  PetscCall(PetscSFSetGraph(grid->node_sf, grid->n_owned, n, leaf, PETSC_OWN_POINTER, root, PETSC_OWN_POINTER));
  PetscFunctionReturn(0);
}

static PetscErrorCode Unpack(Grid *grid, const PetscInt head[HEAD_N], const char *names, Integers *buffer, PetscReal *x)
{
  PetscInt *neighbour, *far_cell, *file_node, n_far;

  PetscFunctionBeginUser;
  grid->n_cells = head[HEAD_CELLS];
  grid->n_owned = head[HEAD_OWNED];
  grid->n_nodes = head[HEAD_NODES];
  grid->x = x;
  PetscCall(Take(buffer, grid->n_cells * grid->nodes_per_cell, &grid->cell_node));
  PetscCall(Take(buffer, grid->n_cells, &grid->global_cell));
  PetscCall(Take(buffer, grid->n_cells * cells[grid->type].faces, &neighbour));
  PetscCall(TakeList(buffer, &n_far, &far_cell));
  PetscCall(Take(buffer, grid->n_nodes, &file_node));
  PetscCall(Take(buffer, grid->n_nodes, &grid->global_node));
  PetscCall(UnpackGhosts(grid, buffer));
  PetscCall(PetscCalloc1(grid->n_sets, &grid->sets));
  for (PetscInt s = 0; s < grid->n_sets; ++s) {
    PetscCall(UnpackSet(buffer, grid->sets + s));
    PetscCall(PetscStrallocpy(names, &grid->sets[s].name));
    names += strlen(names) + 1;
  }
  PetscCall(UnpackSet(buffer, &grid->outer));
  PetscCall(GridBinsCreate(grid, neighbour, far_cell, file_node));
  PetscFunctionReturn(0);
}

/* Rank 0: send every other rank its part; its own comes back in head, buffer and x. */
static PetscErrorCode SendAll(MPI_Comm comm, PetscMPIInt size, const SerialMesh *mesh, const PetscInt *owner,
                              PetscInt head[HEAD_N], Integers *buffer, PetscReal **x)
{
  Plan plan;

  PetscFunctionBeginUser;
  PetscCall(PlanCreate(&plan, mesh, owner, size));
  for (PetscMPIInt r = size - 1; r >= 0; --r) {
    PetscCall(PlanPack(&plan, r, head, buffer, x));
    if (!r) break;
    PetscCall(SendPart(comm, r, head, buffer, *x, head[HEAD_NODES] * mesh->dim));
    PetscCall(PetscFree(*x));
  }
  PetscCall(PlanDestroy(&plan));
  PetscFunctionReturn(0);
}

/* Neighbouring corners of a face are joined by an edge in every type of cell. */
static PetscReal shortest_edge(const SerialMesh *mesh)
{
  const Cell *shape = cells + mesh->type;
  const PetscInt dim = mesh->dim, n = shape->face_nodes;
  PetscReal least = PETSC_MAX_REAL;
  for (PetscInt k = 0; k < mesh->n_cells * shape->faces * n; ++k) {
    const PetscInt *node = mesh->cell_node + k / (shape->faces * n) * shape->nodes,
                   *face = shape->face[k / n % shape->faces];
    const PetscReal *a = mesh->x + node[face[k % n]] * dim, *b = mesh->x + node[face[(k + 1) % n]] * dim;
    PetscReal square = 0;
    for (PetscInt d = 0; d < dim; ++d) square += (a[d] - b[d]) * (a[d] - b[d]);
    least = PetscMin(least, square);
  }
  return PetscSqrtReal(least);
}

/* Extent of the mesh and its shortest edge. */
static PetscErrorCode ShareExtent(const SerialMesh *mesh, Grid *grid)
{
  PetscReal extent[7] = {0};

  PetscFunctionBeginUser;
  if (mesh) {
    for (PetscInt d = 0; d < mesh->dim; ++d) extent[d] = PETSC_MAX_REAL, extent[3 + d] = -PETSC_MAX_REAL;
    for (PetscInt k = 0; k < mesh->n_nodes * mesh->dim; ++k) {
      const PetscInt d = k % mesh->dim;
      extent[d] = PetscMin(extent[d], mesh->x[k]);
      extent[3 + d] = PetscMax(extent[3 + d], mesh->x[k]);
    }
    extent[6] = shortest_edge(mesh);
  }
  PetscCallMPI(MPI_Bcast(extent, 7, MPIU_REAL, 0, grid->comm));
  for (int d = 0; d < 3; ++d) grid->min[d] = extent[d], grid->max[d] = extent[3 + d];
  grid->smallest = extent[6];
  PetscFunctionReturn(0);
}

/* Sizes and names to all. */
static PetscErrorCode ShareCommon(MPI_Comm comm, const SerialMesh *mesh, Common *common, char **names)
{
  PetscMPIInt rank;
  char *at;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (!rank) {
    *common = (Common){mesh->dim, (PetscInt)mesh->type, mesh->n_cells, mesh->n_nodes, mesh->n_sets, 1};
    for (PetscInt s = 0; s < mesh->n_sets; ++s) common->names += (PetscInt)strlen(mesh->sets[s].name) + 1;
  }
  PetscCallMPI(MPI_Bcast(common, (PetscMPIInt)(sizeof *common / sizeof(PetscInt)), MPIU_INT, 0, comm));
  PetscCall(PetscCalloc1(common->names, names));
  at = *names;
  for (PetscInt s = 0; !rank && s < mesh->n_sets; ++s) {
    const size_t n = strlen(mesh->sets[s].name) + 1;
    memcpy(at, mesh->sets[s].name, n);
    at += n;
  }
  PetscCallMPI(MPI_Bcast(*names, (PetscMPIInt)common->names, MPI_CHAR, 0, comm));
  PetscFunctionReturn(0);
}

PetscErrorCode GridDistribute(MPI_Comm comm, const SerialMesh *mesh, const PetscInt *owner, Grid **out)
{
  PetscMPIInt rank, size;
  PetscInt head[HEAD_N];
  Integers buffer = {0};
  Common common;
  PetscReal *x = NULL;
  char *names;
  Grid *grid;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(ShareCommon(comm, mesh, &common, &names));
  PetscCall(PetscNew(&grid));
  grid->comm = comm;
  grid->dim = common.dim;
  grid->type = (CellType)common.type;
  grid->nodes_per_cell = cells[grid->type].nodes;
  grid->n_cells_global = common.n_cells;
  grid->n_nodes_global = common.n_nodes;
  grid->n_sets = common.n_sets;
  PetscCall(ShareExtent(mesh, grid));
  if (rank) PetscCall(ReceivePart(comm, grid->dim, head, &buffer, &x));
  else PetscCall(SendAll(comm, size, mesh, owner, head, &buffer, &x));
  PetscCall(Unpack(grid, head, names, &buffer, x));
  PetscCall(PetscFree(buffer.data));
  PetscCall(PetscFree(names));
  PetscCall(GridFinish(grid));
  *out = grid;
  PetscFunctionReturn(0);
}
