#include "grid/cloud/cloud.h"
#include "base/exchange.h"
#include "grid/grid_ops.h"

/* Up to so many times the mean spacing, or as much less, nodes count as equally far apart: those of cells that Gmsh
 * made of one size. */
#define ALIKE 1.3

PetscErrorCode GridCloudFollow(const Grid *grid, CloudField field)
{
  GridCloud *c = grid->cloud;

  PetscFunctionBeginUser;
  PetscCheck(c->n_fields < CLOUD_MAX_FIELDS, PETSC_COMM_SELF, PETSC_ERR_PLIB, "too many arrays follow the nodes");
  c->field[c->n_fields++] = field;
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(Grid *grid)
{
  GridCloud **cloud = &grid->cloud;

  PetscFunctionBeginUser;
  PetscCall(PetscFree((*cloud)->id));
  PetscCall(PetscFree((*cloud)->around));
  PetscCall(PetscFree((*cloud)->x0));
  PetscCall(PetscFree((*cloud)->obstacle));
  PetscCall(PetscFree((*cloud)->motion));
  PetscCall(CloudMatterDestroy(&(*cloud)->matter));
  PetscCall(PetscFree((*cloud)->ghost_rank));
  PetscCall(PetscFree((*cloud)->ghost_index));
  PetscCall(PetscFree(*cloud));
  PetscFunctionReturn(0);
}

/* Of the square or cube that a cell is, half of which a triangle is and a sixth a tetrahedron. */
static PetscReal block_volume(const Grid *grid, PetscInt cell)
{
  static const PetscReal share[] = {2, 1, 6, 1}; /* cells to a square or a cube */
  PetscReal x[3 * CELL_MAX_NODES];
  grid_cell_x(grid, cell, x);
  return share[grid_cell_type(grid, cell)] * cell_volume(grid_cell_type(grid, cell), x);
}

PetscErrorCode GridSpacing(const Grid *grid, PetscInt n, const PetscInt *cell, PetscReal *spacing)
{
  PetscReal sum[2] = {0, (PetscReal)n};

  PetscFunctionBeginUser;
  *spacing = grid->smallest;
  if (grid_cells_alike(grid)) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < n; ++k) sum[0] += block_volume(grid, cell[k]);
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, grid->comm));
  if (sum[1] > 0) *spacing = PetscPowReal(sum[0] / sum[1], 1 / (PetscReal)grid->dim);
  PetscFunctionReturn(0);
}

/* What counts as spacing where it is so many (as a logarithm) times the mean: the mean within ALIKE, what it is beyond
 * the square of that, and between both without a step. Over the mean. */
static PetscReal spacing_counted(PetscReal times)
{
  const PetscReal off = PetscAbsReal(times), counts = PetscMin(off, 2 * (off - PetscLogReal(ALIKE)));
  if (counts <= 0) return 1;
  return PetscExpReal(times > 0 ? counts : -counts);
}

PetscErrorCode GridSpacingAround(const Grid *mesh, PetscReal spacing, PetscReal **around)
{
  const PetscInt nn = mesh->nodes_per_cell;
  PetscReal *sum;
  PetscBool uneven = PETSC_FALSE;

  PetscFunctionBeginUser;
  *around = NULL;
  if (grid_cells_alike(mesh)) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(2 * mesh->n_nodes, &sum));
  for (PetscInt k = 0; k < mesh->n_cells; ++k) {
    const PetscReal times = PetscLogReal(block_volume(mesh, k)) / mesh->dim - PetscLogReal(spacing);
    for (PetscInt I = 0; I < nn; ++I) {
      sum[2 * mesh->cell_node[k * nn + I]] += times;
      sum[2 * mesh->cell_node[k * nn + I] + 1] += 1;
    }
  }
  PetscCall(GridSumToOwners(mesh, 2, sum));
  PetscCall(GridToGhosts(mesh, 2, sum));
  PetscCall(PetscMalloc1(mesh->n_nodes, around));
  for (PetscInt i = 0; i < mesh->n_nodes; ++i) {
    const PetscReal counts = sum[2 * i + 1] > 0 ? spacing_counted(sum[2 * i] / sum[2 * i + 1]) : 1;
    (*around)[i] = counts * spacing;
    if (counts != 1) uneven = PETSC_TRUE;
  }
  PetscCall(PetscFree(sum));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &uneven, 1, MPIU_BOOL, MPI_LOR, mesh->comm));
  if (!uneven) PetscCall(PetscFree(*around));
  PetscFunctionReturn(0);
}

static const GridOps grid_cloud = {.Destroy = Destroy};

/* Numbers that hang on the set of owned nodes. */
static PetscErrorCode CountOwned(Grid *grid)
{
  PetscInt first = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Exscan(&grid->n_owned, &first, 1, MPIU_INT, MPI_SUM, grid->comm));
  PetscCall(MPIU_Allreduce(&grid->n_owned, &grid->n_nodes_global, 1, MPIU_INT, MPI_SUM, grid->comm));
  for (PetscInt i = 0; i < grid->n_owned; ++i) grid->global_node[i] = first + i;
  PetscFunctionReturn(0);
}

/* The exchange between owners and ghosts. */
static PetscErrorCode Connect(Grid *grid)
{
  const PetscInt n = grid->n_nodes - grid->n_owned;
  PetscInt *leaf;
  PetscSFNode *root;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &leaf));
  PetscCall(PetscMalloc1(n, &root));
  for (PetscInt k = 0; k < n; ++k) {
    leaf[k] = grid->n_owned + k;
    root[k] = (PetscSFNode){.rank = grid->cloud->ghost_rank[k], .index = grid->cloud->ghost_index[k]};
  }
  PetscCall(PetscSFDestroy(&grid->node_sf));
  PetscCall(PetscSFCreate(grid->comm, &grid->node_sf));
  PetscCall(PetscSFSetGraph(grid->node_sf, grid->n_owned, n, leaf, PETSC_OWN_POINTER, root, PETSC_OWN_POINTER));
  PetscCall(PetscSFSetUp(grid->node_sf));
  PetscCall(PetscSFBcastBegin(grid->node_sf, MPIU_INT, grid->global_node, grid->global_node, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(grid->node_sf, MPIU_INT, grid->global_node, grid->global_node, MPI_REPLACE));
  PetscCall(PetscSFBcastBegin(grid->node_sf, MPIU_INT, grid->cloud->id, grid->cloud->id, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(grid->node_sf, MPIU_INT, grid->cloud->id, grid->cloud->id, MPI_REPLACE));
  PetscFunctionReturn(0);
}

/* How often a node of the mesh comes, twins aside. */
static PetscInt copies_of(const CloudSource *source, PetscInt i)
{
  if (!source->marked[i]) return 0;
  return source->motion && source->motion[i] < 0 ? source->n_motions : 1;
}

/* Nodes, and then twins, those of one field behind those of the one before where they come more than once. */
static void populate(const Grid *mesh, const CloudSource *source, Grid *g)
{
  const PetscInt dim = mesh->dim, all = mesh->n_nodes_global;
  GridCloud *c = g->cloud;
  PetscInt n = 0;
  for (int second = 0; second < 2; ++second)
    for (PetscInt k = 0; k < source->n_motions; ++k)
      for (PetscInt i = 0; i < mesh->n_owned; ++i) {
        if (k >= copies_of(source, i) || (second && !source->twin[i])) continue;
        c->id[n] = mesh->global_node[i] + k * all + (second ? c->first_twin : 0);
        c->obstacle[n] = source->marked[i] == CLOUD_OBSTACLE;
        if (c->around) c->around[n] = source->around[i];
        if (c->motion) c->motion[n] = (PetscReal)(source->motion[i] < 0 ? k : source->motion[i]);
        for (PetscInt d = 0; d < dim; ++d) g->x[n * dim + d] = c->x0[n * dim + d] = mesh->x[i * dim + d];
        ++n;
      }
}

/* Its arrays, and those that follow its nodes. */
static PetscErrorCode Allocate(Grid *g, PetscBool uneven)
{
  GridCloud *c = g->cloud;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(g->n_nodes * g->dim, &g->x));
  PetscCall(PetscMalloc1(g->n_nodes * g->dim, &c->x0));
  PetscCall(PetscMalloc1(g->n_nodes, &c->obstacle));
  PetscCall(PetscMalloc1(g->n_nodes, &c->id));
  PetscCall(PetscMalloc1(g->n_nodes, &g->global_node));
  PetscCall(GridCloudFollow(g, (CloudField){&g->x, g->dim, "position", "m", PETSC_FALSE}));
  PetscCall(GridCloudFollow(g, (CloudField){&c->x0, g->dim, "position_at_start", "m", PETSC_FALSE}));
  PetscCall(GridCloudFollow(g, (CloudField){&c->obstacle, 1, "obstacle", NULL, PETSC_FALSE}));
  if (uneven) {
    PetscCall(PetscMalloc1(g->n_nodes, &c->around));
    PetscCall(GridCloudFollow(g, (CloudField){&c->around, 1, "spacing", "m", PETSC_FALSE}));
  }
  if (c->n_motions == 1) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(g->n_nodes, &c->motion));
  PetscCall(GridCloudFollow(g, (CloudField){&c->motion, 1, "velocity_field", NULL, PETSC_FALSE}));
  PetscFunctionReturn(0);
}

/* Collective. Of all nodes. */
static PetscErrorCode FindWidest(Grid *g)
{
  GridCloud *c = g->cloud;

  PetscFunctionBeginUser;
  c->widest = c->spacing;
  for (PetscInt i = 0; i < g->n_owned && c->around; ++i) c->widest = PetscMax(c->widest, c->around[i]);
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &c->widest, 1, MPIU_REAL, MPIU_MAX, g->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode GridCreateCloud(const Grid *mesh, const CloudSource *source, Grid **cloud)
{
  Grid *g;
  PetscMPIInt size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(mesh->comm, &size));
  PetscCall(PetscNew(&g));
  PetscCall(PetscNew(&g->cloud));
  g->ops = &grid_cloud;
  g->comm = mesh->comm;
  g->dim = mesh->dim;
  g->type = g->first_type = mesh->type;
  g->smallest = mesh->smallest;
  PetscCall(PetscArraycpy(g->min, mesh->min, 3));
  PetscCall(PetscArraycpy(g->max, mesh->max, 3));
  for (PetscInt i = 0; i < mesh->n_owned; ++i) g->n_owned += copies_of(source, i) * (1 + (source->twin[i] != 0));
  g->n_nodes = g->n_owned;
  g->cloud->n_motions = source->n_motions;
  g->cloud->first_twin = source->n_motions * mesh->n_nodes_global;
  g->cloud->spacing = source->spacing;
  g->cloud->n_cells_left = mesh->n_cells_global;
  PetscCall(Allocate(g, (PetscBool)(source->around != NULL)));
  populate(mesh, source, g);
  PetscCall(FindWidest(g));
  PetscCall(CountOwned(g));
  PetscCall(Connect(g));
  *cloud = g;
  PetscFunctionReturn(0);
}

/* Arrays get the new size, owned contents stay. */
static PetscErrorCode Resize(Grid *grid, PetscInt n_nodes)
{
  GridCloud *c = grid->cloud;
  PetscReal *data;

  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < c->n_fields; ++f) {
    const PetscInt k = c->field[f].components;
    PetscCall(PetscCalloc1(n_nodes * k, &data));
    if (c->field[f].name) PetscCall(PetscArraycpy(data, *c->field[f].data, grid->n_owned * k));
    PetscCall(PetscFree(*c->field[f].data));
    *c->field[f].data = data;
  }
  PetscCall(PetscRealloc((size_t)n_nodes * sizeof *c->id, &c->id));
  PetscCall(PetscRealloc((size_t)n_nodes * sizeof *grid->global_node, &grid->global_node));
  grid->n_nodes = n_nodes;
  PetscFunctionReturn(0);
}

PetscErrorCode GridCloudSetGhosts(Grid *grid, const RemoteNodes *remote, const PetscBool *use)
{
  GridCloud *c = grid->cloud;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < remote->n; ++k) n += use[k];
  PetscCall(Resize(grid, grid->n_owned + n));
  PetscCall(PetscFree(c->ghost_rank));
  PetscCall(PetscFree(c->ghost_index));
  PetscCall(PetscMalloc1(n, &c->ghost_rank));
  PetscCall(PetscMalloc1(n, &c->ghost_index));
  for (PetscInt k = 0, g = 0; k < remote->n; ++k)
    if (use[k]) {
      c->ghost_rank[g] = remote->rank[k];
      c->ghost_index[g++] = remote->index[k];
    }
  PetscCall(Connect(grid));
  for (PetscInt f = 0; f < c->n_fields; ++f)
    if (c->field[f].name) PetscCall(GridToGhosts(grid, c->field[f].components, *c->field[f].data));
  ++c->layouts;
  PetscFunctionReturn(0);
}

static PetscInt kept_components(const GridCloud *c)
{
  PetscInt sum = 0;
  for (PetscInt f = 0; f < c->n_fields; ++f) sum += c->field[f].name ? c->field[f].components : 0;
  return sum;
}

/* All that is kept of a node <-> one row of numbers; its id stands last. */
static void pack_node(const Grid *grid, PetscInt node, PetscReal *row)
{
  const GridCloud *c = grid->cloud;
  for (PetscInt f = 0; f < c->n_fields; ++f)
    for (PetscInt k = 0; c->field[f].name && k < c->field[f].components; ++k)
      *row++ = (*c->field[f].data)[node * c->field[f].components + k];
  *row = (PetscReal)c->id[node];
}

static void unpack_node(Grid *grid, PetscInt node, const PetscReal *row)
{
  GridCloud *c = grid->cloud;
  for (PetscInt f = 0; f < c->n_fields; ++f)
    for (PetscInt k = 0; c->field[f].name && k < c->field[f].components; ++k)
      (*c->field[f].data)[node * c->field[f].components + k] = *row++;
  c->id[node] = (PetscInt)*row;
}

/* Room for n owned nodes alone. */
static PetscErrorCode Empty(Grid *grid, PetscInt n)
{
  PetscFunctionBeginUser;
  grid->n_owned = 0;
  PetscCall(Resize(grid, n));
  grid->n_owned = n;
  PetscCall(PetscFree(grid->cloud->ghost_rank));
  PetscCall(PetscFree(grid->cloud->ghost_index));
  PetscFunctionReturn(0);
}

PetscErrorCode GridCloudReplace(Grid *grid, PetscInt n_owned, const PetscInt *id)
{
  PetscFunctionBeginUser;
  PetscCall(Empty(grid, n_owned));
  PetscCall(PetscArraycpy(grid->cloud->id, id, n_owned));
  PetscCall(CountOwned(grid));
  PetscCall(Connect(grid));
  ++grid->cloud->layouts;
  PetscFunctionReturn(0);
}

/* Rows of the nodes that stay, then of those that come, then resize and write them back. */
static PetscErrorCode Settle(Grid *grid, const PetscMPIInt *owner, PetscMPIInt rank, PetscInt n_in, const PetscReal *in)
{
  const PetscInt width = kept_components(grid->cloud) + 1;
  PetscReal *stay;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(grid->n_owned * width, &stay));
  for (PetscInt i = 0; i < grid->n_owned; ++i)
    if (owner[i] == rank) pack_node(grid, i, stay + n++ * width);
  PetscCall(Empty(grid, n + n_in));
  for (PetscInt i = 0; i < n; ++i) unpack_node(grid, i, stay + i * width);
  for (PetscInt i = 0; i < n_in; ++i) unpack_node(grid, n + i, in + i * width);
  PetscCall(PetscFree(stay));
  PetscCall(CountOwned(grid));
  PetscCall(Connect(grid));
  ++grid->cloud->layouts;
  PetscFunctionReturn(0);
}

PetscErrorCode GridCloudMigrate(Grid *grid, const PetscMPIInt *owner)
{
  const PetscInt width = kept_components(grid->cloud) + 1;
  PetscMPIInt rank, size, *slot;
  PetscInt *per_rank, *next;
  PetscReal *out, *in;
  Exchange e;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(grid->comm, &rank));
  PetscCallMPI(MPI_Comm_size(grid->comm, &size));
  PetscCall(PetscMalloc1(size, &slot));
  PetscCall(PetscCalloc1(size, &per_rank));
  for (PetscInt i = 0; i < grid->n_owned; ++i) per_rank[owner[i]] += owner[i] != rank;
  PetscCall(ExchangeCreate(grid->comm, size, per_rank, slot, &e));
  PetscCall(PetscMalloc1(e.to_start[e.n_to] * width, &out));
  PetscCall(PetscMalloc1(e.from_start[e.n_from] * width, &in));
  PetscCall(PetscMalloc1(e.n_to + 1, &next));
  PetscCall(PetscArraycpy(next, e.to_start, e.n_to + 1));
  for (PetscInt i = 0; i < grid->n_owned; ++i)
    if (owner[i] != rank) pack_node(grid, i, out + next[slot[owner[i]]]++ * width);
  PetscCall(ExchangeItems(&e, (size_t)width * sizeof *out, PETSC_FALSE, (char *)out, (char *)in));
  PetscCall(Settle(grid, owner, rank, e.from_start[e.n_from], in));
  PetscCall(ExchangeDestroy(&e));
  PetscCall(PetscFree(out));
  PetscCall(PetscFree(in));
  PetscCall(PetscFree(next));
  PetscCall(PetscFree(slot));
  PetscCall(PetscFree(per_rank));
  PetscFunctionReturn(0);
}
