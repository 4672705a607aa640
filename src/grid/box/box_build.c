/* Box grids by arithmetic: every rank fills its own block of voxels and needs no message to know
 * the rest.
 *
 * A lattice node belongs to the rank of the voxel above it (the last one at the upper end of an
 * axis), the centre of a crossed voxel to that of its voxel. A rank numbers its own lattice nodes
 * lexicographically, then its centres; ghosts follow in the same order. The sides are the sets left right (x), bottom
 * top (y), and in 3D front (lowest z) and back (highest z). */
#include "grid/box/box.h"

const char *box_side_name(PetscInt axis, int high)
{
  static const char *const names[3][2] = {{"left", "right"}, {"bottom", "top"}, {"front", "back"}};
  return names[axis][high];
}

/* The rank and the local number there of a lattice node. */
static PetscSFNode lattice_owner(const GridBox *box, const PetscInt ijk[LATTICE])
{
  PetscInt voxel[LATTICE];
  PetscSFNode node;
  for (int d = 0; d < LATTICE; ++d) voxel[d] = PetscMin(ijk[d], box->counts[d] - 1);
  node.rank = box_owner(box, voxel);
  const VoxelBlock owned = box_owned_nodes(box, box->block + node.rank);
  node.index = block_index(&owned, ijk);
  return node;
}

/* Voxels between these nodes: the rank's own, and those of its halo. */
static VoxelBlock voxels_between(const GridBox *box, const VoxelBlock *nodes)
{
  VoxelBlock voxels = box->block[box->rank];
  const PetscInt some = block_size(&voxels) > 0;
  for (PetscInt d = 0; some && d < box->dim; ++d) {
    voxels.lo[d] = nodes->lo[d];
    voxels.hi[d] = nodes->hi[d] - 1;
  }
  return voxels;
}

static PetscErrorCode CountNodes(Grid *grid, const VoxelBlock *nodes)
{
  const GridBox *box = grid->box;

  PetscFunctionBeginUser;
  const VoxelBlock *voxels = box->block + box->rank, owned = box_owned_nodes(box, voxels);
  const VoxelBlock wide = voxels_between(box, nodes);
  grid->n_owned = box->first_node[box->rank + 1] - box->first_node[box->rank];
  grid->n_nodes = grid->n_owned + block_size(nodes) - block_size(&owned);
  if (box_has_centres(box)) grid->n_nodes += block_size(&wide) - block_size(voxels);
  grid->n_nodes_global = box->first_node[box->size];
  PetscCall(PetscMalloc1(grid->n_nodes * grid->dim, &grid->x));
  PetscCall(PetscMalloc1(grid->n_nodes, &grid->global_node));
  PetscFunctionReturn(0);
}

static void place_centre(Grid *grid, const PetscInt ijk[LATTICE], PetscInt number, PetscInt node)
{
  const GridBox *box = grid->box;
  grid->global_node[node] = number;
  for (PetscInt d = 0; d < grid->dim; ++d)
    grid->x[node * grid->dim + d] = 0.5 * (box->line[d][ijk[d]] + box->line[d][ijk[d] + 1]);
}

/* Centres of crossed voxels of the halo, which other ranks have; ghosts from *ghost on. */
static void place_centres_beyond(Grid *grid, const VoxelBlock *nodes, PetscInt *ghost, PetscInt *leaf,
                                 PetscSFNode *root)
{
  const GridBox *box = grid->box;
  const VoxelBlock wide = voxels_between(box, nodes);
  PetscInt ijk[LATTICE];
  for (PetscBool more = block_first(&wide, ijk); more; more = block_next(&wide, ijk)) {
    if (block_has(box->block + box->rank, ijk)) continue;
    const PetscMPIInt rank = box_owner(box, ijk);
    const VoxelBlock owned = box_owned_nodes(box, box->block + rank);
    root[*ghost] = (PetscSFNode){.rank = rank, .index = block_size(&owned) + block_index(box->block + rank, ijk)};
    leaf[*ghost] = grid->n_owned + *ghost;
    place_centre(grid, ijk, box->first_node[rank] + root[*ghost].index, leaf[*ghost]);
    ++*ghost;
  }
}

/* Number, place and tie the lattice nodes; lattice[] gets the local number of each member of the
 * node block. */
static PetscErrorCode PlaceLattice(Grid *grid, const VoxelBlock *nodes, PetscInt *lattice)
{
  const GridBox *box = grid->box;
  const VoxelBlock owned = box_owned_nodes(box, box->block + box->rank);
  PetscInt own = 0, ghost = 0, ijk[LATTICE], *leaf;
  PetscSFNode *root;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(grid->n_nodes - grid->n_owned, &leaf));
  PetscCall(PetscMalloc1(grid->n_nodes - grid->n_owned, &root));
  for (PetscBool more = block_first(nodes, ijk); more; more = block_next(nodes, ijk)) {
    const PetscBool mine = block_has(&owned, ijk);
    const PetscInt node = mine ? own++ : grid->n_owned + ghost;
    *lattice++ = node;
    for (PetscInt d = 0; d < grid->dim; ++d) grid->x[node * grid->dim + d] = box->line[d][ijk[d]];
    if (mine) {
      grid->global_node[node] = box->first_node[box->rank] + node;
      continue;
    }
    root[ghost] = lattice_owner(box, ijk);
    leaf[ghost] = node;
    grid->global_node[node] = box->first_node[root[ghost].rank] + root[ghost].index;
    ++ghost;
  }
  if (box_has_centres(box)) place_centres_beyond(grid, nodes, &ghost, leaf, root);
  PetscCall(PetscSFCreate(grid->comm, &grid->node_sf));
  PetscCall(PetscSFSetGraph(grid->node_sf, grid->n_owned, ghost, leaf, PETSC_OWN_POINTER, root, PETSC_OWN_POINTER));
  PetscFunctionReturn(0);
}

/* The local nodes of a voxel's corners, by their codes, and of its centre. */
static void voxel_nodes(const Grid *grid, const VoxelBlock *nodes, const PetscInt *lattice, const PetscInt ijk[LATTICE],
                        PetscInt first_centre, PetscInt local[VOXEL_CENTRE + 1])
{
  const GridBox *box = grid->box;
  for (PetscInt code = 0; code < 1 << grid->dim; ++code) {
    const PetscInt corner[LATTICE] = {ijk[0] + (code & 1), ijk[1] + (code >> 1 & 1), ijk[2] + (code >> 2 & 1), ijk[3]};
    local[code] = lattice[block_index(nodes, corner)];
  }
  local[VOXEL_CENTRE] = first_centre + block_index(box->block + box->rank, ijk);
}

static void fill_cells(Grid *grid, const VoxelBlock *nodes, const PetscInt *lattice)
{
  const GridBox *box = grid->box;
  const VoxelBlock *voxels = box->block + box->rank, owned = box_owned_nodes(box, voxels);
  const VoxelBlock all = box_voxels(box);
  const PetscInt nn = grid->nodes_per_cell, n_sub = box->pattern[0].n_cells;
  const PetscBool centres = box_has_centres(box);
  PetscInt ijk[LATTICE], local[VOXEL_CENTRE + 1], cell = 0;
  for (PetscBool more = block_first(voxels, ijk); more; more = block_next(voxels, ijk)) {
    const VoxelPattern *pattern = box_pattern(box, ijk);
    voxel_nodes(grid, nodes, lattice, ijk, block_size(&owned), local);
    if (centres) place_centre(grid, ijk, box->first_node[box->rank] + local[VOXEL_CENTRE], local[VOXEL_CENTRE]);
    for (PetscInt s = 0; s < n_sub; ++s, ++cell) {
      for (PetscInt i = 0; i < nn; ++i) grid->cell_node[cell * nn + i] = local[pattern->code[s][i]];
      grid->global_cell[cell] = block_index(&all, ijk) * n_sub + s;
    }
  }
}

/* Does this face of a cell lie on the voxel's lower (0) or upper (1) side of the axis? */
static PetscBool face_on_side(const Cell *cell, const PetscInt *code, PetscInt face, PetscInt axis, PetscInt upper)
{
  for (PetscInt i = 0; i < cell->face_nodes; ++i) {
    const PetscInt at = code[cell->face[face][i]];
    if (at == VOXEL_CENTRE || (at >> axis & 1) != upper) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

static void voxel_side_faces(const Grid *grid, const PetscInt ijk[LATTICE], PetscInt axis, PetscInt upper, GridSet *set)
{
  const GridBox *box = grid->box;
  const Cell *cell = cells + grid->type;
  const VoxelPattern *pattern = box_pattern(box, ijk);
  const PetscInt first = block_index(box->block + box->rank, ijk) * pattern->n_cells;
  for (PetscInt s = 0; s < pattern->n_cells; ++s)
    for (PetscInt f = 0; f < cell->faces; ++f) {
      if (!face_on_side(cell, pattern->code[s], f, axis, upper)) continue;
      set->face_cell[set->n_faces] = first + s;
      set->face_side[set->n_faces++] = f;
    }
}

/* The part of a block that lies at the given end of the axis; empty if it does not reach it. `end`
 * is the last index there. */
static VoxelBlock end_slab(VoxelBlock block, PetscInt axis, PetscInt end)
{
  block.lo[axis] = PetscMax(block.lo[axis], end);
  block.hi[axis] = PetscMax(block.lo[axis], PetscMin(block.hi[axis], end + 1));
  return block;
}

static PetscErrorCode SideFaces(const Grid *grid, PetscInt axis, PetscInt upper, GridSet *set)
{
  const GridBox *box = grid->box;
  const VoxelBlock slab = end_slab(box->block[box->rank], axis, upper ? box->counts[axis] - 1 : 0);
  const PetscInt most = 2 * block_size(&slab); /* a voxel's side has one face or two */
  PetscInt ijk[LATTICE];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(most, &set->face_cell));
  PetscCall(PetscMalloc1(most, &set->face_side));
  for (PetscBool more = block_first(&slab, ijk); more; more = block_next(&slab, ijk))
    voxel_side_faces(grid, ijk, axis, upper, set);
  PetscFunctionReturn(0);
}

static PetscErrorCode SideNodes(const Grid *grid, const VoxelBlock *nodes, const PetscInt *lattice, PetscInt axis,
                                PetscInt upper, GridSet *set)
{
  const VoxelBlock slab = end_slab(*nodes, axis, upper ? grid->box->counts[axis] : 0);
  PetscInt ijk[LATTICE];

  PetscFunctionBeginUser;
  if (!block_size(nodes) || !block_size(&slab)) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(block_size(&slab), &set->nodes));
  for (PetscBool more = block_first(&slab, ijk); more; more = block_next(&slab, ijk))
    set->nodes[set->n_nodes++] = lattice[block_index(nodes, ijk)];
  PetscCall(PetscSortInt(set->n_nodes, set->nodes));
  PetscFunctionReturn(0);
}

/* The whole outer boundary from the sides. */
static PetscErrorCode FillOuter(Grid *grid)
{
  GridSet *outer = &grid->outer;
  PetscInt n_nodes = 0, n_faces = 0;

  PetscFunctionBeginUser;
  for (PetscInt s = 0; s < grid->n_sets; ++s) n_nodes += grid->sets[s].n_nodes, n_faces += grid->sets[s].n_faces;
  PetscCall(PetscMalloc1(n_nodes, &outer->nodes));
  PetscCall(PetscMalloc1(n_faces, &outer->face_cell));
  PetscCall(PetscMalloc1(n_faces, &outer->face_side));
  for (PetscInt s = 0; s < grid->n_sets; ++s) {
    const GridSet *set = grid->sets + s;
    PetscCall(PetscArraycpy(outer->nodes + outer->n_nodes, set->nodes, set->n_nodes));
    PetscCall(PetscArraycpy(outer->face_cell + outer->n_faces, set->face_cell, set->n_faces));
    PetscCall(PetscArraycpy(outer->face_side + outer->n_faces, set->face_side, set->n_faces));
    outer->n_nodes += set->n_nodes;
    outer->n_faces += set->n_faces;
  }
  PetscCall(PetscSortRemoveDupsInt(&outer->n_nodes, outer->nodes));
  PetscFunctionReturn(0);
}

static PetscErrorCode FillSides(Grid *grid, const VoxelBlock *nodes, const PetscInt *lattice)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(2 * grid->dim, &grid->sets));
  for (PetscInt axis = 0; axis < grid->dim; ++axis)
    for (PetscInt upper = 0; upper < 2; ++upper) {
      GridSet *set = grid->sets + grid->n_sets++;
      PetscCall(PetscStrallocpy(box_side_name(axis, upper), &set->name));
      PetscCall(SideNodes(grid, nodes, lattice, axis, upper, set));
      PetscCall(SideFaces(grid, axis, upper, set));
    }
  PetscCall(FillOuter(grid));
  PetscFunctionReturn(0);
}

static PetscErrorCode FillBox(Grid *grid)
{
  GridBox *box = grid->box;
  const VoxelBlock *voxels = box->block + box->rank, nodes = box_nodes(box, voxels);

  PetscFunctionBeginUser;
  grid->n_cells = block_size(voxels) * box->pattern[0].n_cells;
  PetscCall(PetscMalloc1(grid->n_cells * grid->nodes_per_cell, &grid->cell_node));
  PetscCall(PetscMalloc1(grid->n_cells, &grid->global_cell));
  PetscCall(CountNodes(grid, &nodes));
  PetscCall(PetscMalloc1(block_size(&nodes), &box->lattice));
  box->nodes = nodes;
  PetscCall(PlaceLattice(grid, &nodes, box->lattice));
  fill_cells(grid, &nodes, box->lattice);
  PetscCall(FillSides(grid, &nodes, box->lattice));
  PetscFunctionReturn(0);
}

static void box_extent(Grid *grid)
{
  grid->smallest = PETSC_MAX_REAL;
  for (PetscInt d = 0; d < grid->dim; ++d) {
    const PetscReal *line = grid->box->line[d];
    const PetscInt n = grid->box->counts[d];
    grid->min[d] = line[0];
    grid->max[d] = line[n];
    for (PetscInt i = 0; i < n; ++i) grid->smallest = PetscMin(grid->smallest, line[i + 1] - line[i]);
  }
}

PetscErrorCode BoxBuild(MPI_Comm comm, const GridOps *ops, CellType type, GridBox *box, Grid **out)
{
  Grid *grid;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&grid));
  grid->comm = comm;
  grid->dim = box->dim;
  grid->type = grid->first_type = type;
  grid->nodes_per_cell = cells[type].nodes;
  grid->n_fields = box->counts[LATTICE - 1];
  grid->ops = ops;
  grid->box = box;
  const VoxelBlock all = box_voxels(box);
  grid->n_cells_global = box->pattern[0].n_cells * block_size(&all);
  box_extent(grid);
  PetscCall(FillBox(grid));
  PetscCall(GridFinish(grid));
  *out = grid;
  PetscFunctionReturn(0);
}
