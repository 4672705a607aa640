/* From a Gmsh file to cells, checked, with their neighbours. On rank 0. */
#include "grid/mesh/file_mesh.h"

/* Gmsh's numbers of the cell types, in the order of CellType. */
static const PetscInt gmsh_code[4] = {2, 3, 4, 5};

/* Which cells does the file have? PETSC_FALSE, with a message, if they cannot make a grid of this
 * dimension. */
static PetscBool choose_types(const MshFile *msh, Grid *grid, const char *path, Diag *diag)
{
  const PetscInt dim = grid->dim;
  PetscInt count[4] = {0, 0, 0, 0};
  for (PetscInt e = 0; e < msh->n_elements; ++e)
    for (int t = 0; t < 4; ++t) count[t] += msh->type[e]->code == gmsh_code[t];
  const PetscInt solid = count[CELL_TETRAHEDRON] + count[CELL_HEXAHEDRON];
  const CellType few = dim == 2 ? CELL_TRIANGLE : CELL_TETRAHEDRON,
                 many = dim == 2 ? CELL_QUADRILATERAL : CELL_HEXAHEDRON;
  if (dim == 2 && solid) {
    diag_error(diag, path, "the mesh is three-dimensional (%lld solid cells), the kinematics two-dimensional",
               (long long)solid);
    return PETSC_FALSE;
  }
  if (!count[few] && !count[many]) {
    diag_error(diag, path, "the mesh has no %s", dim == 2 ? "triangles or quadrilaterals" : "tetrahedra or hexahedra");
    diag_hint(diag, "gmsh saves only what is in a physical group once there is one: is the %s in a group?",
              dim == 2 ? "surface" : "volume");
    return PETSC_FALSE;
  }
  if (dim == 3 && count[few] && count[many]) {
    diag_error(diag, path, "the mesh mixes %lld tetrahedra with %lld hexahedra, which only pyramids could join",
               (long long)count[few], (long long)count[many]);
    diag_hint(diag, "talus mixes triangles and quadrilaterals; volumes must be all of one kind of cells");
    return PETSC_FALSE;
  }
  grid->type = count[many] ? many : few;
  grid->first_type = count[few] ? few : many;
  grid->nodes_per_cell = cells[grid->type].nodes;
  return PETSC_TRUE;
}

/* A cell of few nodes repeats its last one. */
static void pad_nodes(const Grid *grid, PetscInt nodes, PetscInt *node)
{
  for (PetscInt i = nodes; i < grid->nodes_per_cell; ++i) node[i] = node[nodes - 1];
}

/* The cells, each once: version 2 repeats an element for each of its groups. element[k]: the one
 * that cell k of the file first is; cell_of[e]: which of them element e is, or -1. */
static PetscErrorCode CountCells(Grid *grid, const MshFile *msh, PetscInt *cell_of, PetscInt *element)
{
  TupleTable *seen;

  PetscFunctionBeginUser;
  PetscCall(TupleTableCreate(grid->nodes_per_cell, msh->n_elements, &seen));
  for (PetscInt e = 0; e < msh->n_elements; ++e) {
    PetscInt *node = msh->node + MSH_MAX_NODES * e;
    const PetscBool few = msh->type[e]->code == gmsh_code[grid->first_type];
    cell_of[e] = -1;
    if (!few && msh->type[e]->code != gmsh_code[grid->type]) continue;
    pad_nodes(grid, msh->type[e]->nodes, node);
    cell_of[e] = tuple_add(seen, node);
    if (cell_of[e] < grid->n_cells) continue;
    element[grid->n_cells++] = e;
    grid->n_first += few && grid_is_mixed(grid);
  }
  PetscCall(TupleTableDestroy(&seen));
  PetscFunctionReturn(0);
}

/* Those of the lesser kind go first. */
static PetscErrorCode TakeCells(FileMesh *mesh, const MshFile *msh, PetscInt *cell_of, PetscInt *entity_of)
{
  Grid *grid = mesh->grid;
  PetscInt *element, *local, next[2] = {0, 0};

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(msh->n_elements, &element, msh->n_elements, &local));
  PetscCall(CountCells(grid, msh, cell_of, element));
  PetscCall(PetscMalloc1(grid->n_cells * grid->nodes_per_cell, &grid->cell_node));
  PetscCall(PetscMalloc1(grid->n_cells, &grid->global_cell));
  PetscCall(PetscMalloc1(grid->n_cells, &mesh->number));
  grid->n_cells_global = grid->n_cells;
  next[1] = grid->n_first;
  for (PetscInt k = 0; k < grid->n_cells; ++k) {
    const PetscInt e = element[k], cell = local[k] = next[msh->type[e]->code == gmsh_code[grid->type]]++;
    mesh->number[cell] = msh->tag[e];
    entity_of[cell] = msh->entity[e];
    grid->global_cell[cell] = k;
    PetscCall(PetscArraycpy(grid->cell_node + cell * grid->nodes_per_cell, msh->node + MSH_MAX_NODES * e,
                            grid->nodes_per_cell));
  }
  for (PetscInt e = 0; e < msh->n_elements; ++e)
    if (cell_of[e] >= 0) cell_of[e] = local[cell_of[e]];
  PetscCall(PetscFree2(element, local));
  PetscFunctionReturn(0);
}

/* The nodes that cells use, in the order of the file. node_of: their index in the mesh, or -1. */
static PetscErrorCode TakeNodes(Grid *grid, const MshFile *msh, PetscInt *node_of)
{
  const PetscInt n = grid->n_cells * grid->nodes_per_cell, dim = grid->dim;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < msh->n_nodes; ++k) node_of[k] = -1;
  for (PetscInt k = 0; k < n; ++k) node_of[grid->cell_node[k]] = 0;
  for (PetscInt k = 0; k < msh->n_nodes; ++k)
    if (!node_of[k]) node_of[k] = grid->n_nodes++;
  for (PetscInt k = 0; k < n; ++k) grid->cell_node[k] = node_of[grid->cell_node[k]];
  grid->n_owned = grid->n_nodes_global = grid->n_nodes;
  PetscCall(PetscMalloc1(grid->n_nodes * dim, &grid->x));
  PetscCall(PetscMalloc1(grid->n_nodes, &grid->mesh->file_node));
  for (PetscInt k = 0; k < msh->n_nodes; ++k) {
    if (node_of[k] < 0) continue;
    grid->mesh->file_node[node_of[k]] = node_of[k];
    for (PetscInt d = 0; d < dim; ++d) grid->x[node_of[k] * dim + d] = msh->x[3 * k + d];
  }
  PetscFunctionReturn(0);
}

/* Extent of the mesh, and its shortest edge: neighbouring corners of a face are joined by one in
 * every type of cell. */
static void measure(Grid *grid)
{
  PetscReal bounds[6], x[3 * CELL_MAX_NODES], least = PETSC_MAX_REAL;
  const PetscInt dim = grid->dim;
  box_around(dim, grid->n_nodes, grid->x, bounds);
  for (PetscInt d = 0; d < 3; ++d) grid->min[d] = bounds[d], grid->max[d] = bounds[3 + d];
  for (PetscInt c = 0; c < grid->n_cells; ++c) {
    const Cell *shape = grid_cell(grid, c);
    const PetscInt n = shape->face_nodes;
    grid_cell_x(grid, c, x);
    for (PetscInt k = 0; k < shape->faces * n; ++k) {
      const PetscReal *a = x + shape->face[k / n][k % n] * dim, *b = x + shape->face[k / n][(k + 1) % n] * dim;
      PetscReal square = 0;
      for (PetscInt d = 0; d < dim; ++d) square += (a[d] - b[d]) * (a[d] - b[d]);
      least = PetscMin(least, square);
    }
  }
  grid->smallest = PetscSqrtReal(least);
}

static void check_plane(const Grid *grid, const MshFile *msh, const PetscInt *node_of, const char *path, Diag *diag)
{
  const PetscReal size = PetscMax(grid->max[0] - grid->min[0], grid->max[1] - grid->min[1]);
  for (PetscInt k = 0; k < msh->n_nodes && grid->dim == 2; ++k) {
    if (node_of[k] < 0 || PetscAbsReal(msh->x[3 * k + 2]) <= 1e-9 * size) continue;
    diag_error(diag, path, "the mesh must lie in the plane z = 0, but its node %lld has z = %g",
               (long long)msh->node_tag[k], (double)msh->x[3 * k + 2]);
    return;
  }
}

/* The smallest determinant of the map at the cell's corners, relative to the size of its edges. */
static PetscReal worst_corner(const Grid *grid, PetscInt cell)
{
  const Cell *shape = grid_cell(grid, cell);
  PetscReal x[3 * CELL_MAX_NODES], N[CELL_MAX_NODES], dN[3 * CELL_MAX_NODES], worst = PETSC_MAX_REAL, edge = 0;
  grid_cell_x(grid, cell, x);
  for (PetscInt i = 0; i < shape->nodes; ++i) {
    worst = PetscMin(worst, cell_gradients(grid_cell_type(grid, cell), x, shape->reference[i], N, dN));
    for (PetscInt d = 0; d < grid->dim; ++d) edge = PetscMax(edge, PetscAbsReal(x[i * grid->dim + d] - x[d]));
  }
  return edge > 0 ? worst / PetscPowRealInt(edge, (int)grid->dim) : 0;
}

static PetscReal signed_volume(const Grid *grid, PetscInt cell)
{
  PetscReal x[3 * CELL_MAX_NODES];
  grid_cell_x(grid, cell, x);
  return cell_volume(grid_cell_type(grid, cell), x);
}

/* The same cell seen from the other side. */
static void turn_cell(CellType type, PetscInt *node)
{
  static const PetscInt swaps[4][2][2] = {{{1, 2}, {0, 0}}, {{1, 3}, {0, 0}}, {{1, 2}, {0, 0}}, {{1, 3}, {5, 7}}};
  for (int s = 0; s < 2; ++s) {
    const PetscInt a = swaps[type][s][0], b = swaps[type][s][1], other = node[a];
    node[a] = node[b];
    node[b] = other;
  }
}

/* A surface drawn clockwise gives clockwise cells, all of them: nothing is wrong with those but
 * their order of nodes. */
static PetscErrorCode TurnEntities(Grid *grid, const PetscInt *entity_of)
{
  PetscInt n = grid->n_cells, *entity;
  PetscBool *positive;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &entity));
  PetscCall(PetscArraycpy(entity, entity_of, n));
  PetscCall(PetscSortRemoveDupsInt(&n, entity));
  PetscCall(PetscCalloc1(n, &positive));
  for (int turn = 0; turn < 2; ++turn)
    for (PetscInt c = 0; c < grid->n_cells; ++c) {
      PetscInt at, *node = grid->cell_node + c * grid->nodes_per_cell;
      PetscCall(PetscFindInt(entity_of[c], n, entity, &at));
      if (turn && !positive[at]) {
        turn_cell(grid_cell_type(grid, c), node);
        pad_nodes(grid, grid_cell(grid, c)->nodes, node);
      } else if (!turn && signed_volume(grid, c) >= 0) positive[at] = PETSC_TRUE;
    }
  PetscCall(PetscFree(entity));
  PetscCall(PetscFree(positive));
  PetscFunctionReturn(0);
}

static void check_volumes(const FileMesh *mesh, const char *path, Diag *diag)
{
  PetscInt bad = 0;
  size_t used = 0;
  char list[128] = "";
  for (PetscInt c = 0; c < mesh->grid->n_cells; ++c) {
    if (worst_corner(mesh->grid, c) > 1e-12) continue;
    if (++bad > 5) continue;
    used +=
      (size_t)snprintf(list + used, sizeof list - used, "%s%lld", bad > 1 ? ", " : "", (long long)mesh->number[c]);
  }
  if (!bad) return;
  diag_error(diag, path, "%lld of %lld cells are inverted or have no volume: element%s %s%s", (long long)bad,
             (long long)mesh->grid->n_cells, bad > 1 ? "s" : "", list, bad > 5 ? ", ..." : "");
  diag_hint(
    diag,
    "gmsh's Tools > Statistics and Plugin(AnalyseMeshQuality) show them; a finer or better shaped mesh is needed");
}

/* Let cells find each other through their faces. face_at: where each face of the table was first
 * seen. */
static PetscErrorCode FindNeighbours(const FileMesh *mesh, TupleTable *faces, PetscInt *face_at, const char *path,
                                     Diag *diag)
{
  const Grid *grid = mesh->grid;
  const PetscInt n_faces = mesh_faces(grid);
  PetscInt *neighbour;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(grid->n_cells * n_faces, &neighbour));
  grid->mesh->neighbour = neighbour;
  for (PetscInt k = 0; k < grid->n_cells * n_faces; ++k) {
    const PetscInt cell = k / n_faces, side = k % n_faces, *node = grid->cell_node + cell * grid->nodes_per_cell;
    const Cell *shape = grid_cell(grid, cell);
    PetscInt key[4];
    neighbour[k] = -1;
    if (side >= shape->faces) continue;
    for (PetscInt i = 0; i < shape->face_nodes; ++i) key[i] = node[shape->face[side][i]];
    const PetscInt before = tuple_count(faces), id = tuple_add(faces, key);
    if (id == before) {
      face_at[id] = k;
      continue;
    }
    const PetscInt other = face_at[id] / n_faces;
    if (neighbour[face_at[id]] >= 0) {
      diag_error(diag, path, "three cells share one face: elements %lld, %lld and %lld overlap",
                 (long long)mesh->number[other], (long long)mesh->number[neighbour[face_at[id]]],
                 (long long)mesh->number[cell]);
      PetscFunctionReturn(0);
    }
    neighbour[k] = other;
    neighbour[face_at[id]] = cell;
  }
  PetscFunctionReturn(0);
}

/* Faces without a neighbour, and their nodes. */
static PetscErrorCode FindOuter(Grid *grid)
{
  const PetscInt n_faces = mesh_faces(grid);
  GridSet *outer = &grid->outer;

  PetscFunctionBeginUser;
  for (int fill = 0; fill < 2; ++fill) {
    if (fill) {
      PetscCall(PetscMalloc1(outer->n_faces, &outer->face_cell));
      PetscCall(PetscMalloc1(outer->n_faces, &outer->face_side));
      PetscCall(PetscMalloc1(outer->n_faces * cells[grid->type].face_nodes, &outer->nodes));
      outer->n_faces = 0;
    }
    for (PetscInt k = 0; k < grid->n_cells * n_faces; ++k) {
      const PetscInt cell = k / n_faces, side = k % n_faces;
      const Cell *shape = grid_cell(grid, cell);
      if (side >= shape->faces || grid->mesh->neighbour[k] >= 0) continue;
      for (PetscInt i = 0; fill && i < shape->face_nodes; ++i)
        outer->nodes[outer->n_nodes++] = grid->cell_node[cell * grid->nodes_per_cell + shape->face[side][i]];
      if (fill) outer->face_cell[outer->n_faces] = cell, outer->face_side[outer->n_faces] = side;
      ++outer->n_faces;
    }
  }
  PetscCall(PetscSortRemoveDupsInt(&outer->n_nodes, outer->nodes));
  PetscFunctionReturn(0);
}

static PetscErrorCode ConnectMesh(const FileMesh *mesh, const MshFile *msh, const PetscInt *node_of,
                                  const PetscInt *cell_of, const char *path, Diag *diag)
{
  Grid *grid = mesh->grid;
  const PetscInt errors = diag_errors(diag), n = grid->n_cells * mesh_faces(grid);
  TupleTable *faces;
  PetscInt *face_at;

  PetscFunctionBeginUser;
  PetscCall(TupleTableCreate(cells[grid->type].face_nodes, n, &faces));
  PetscCall(PetscMalloc1(n, &face_at));
  PetscCall(FindNeighbours(mesh, faces, face_at, path, diag));
  if (diag_errors(diag) == errors) {
    PetscCall(FileMeshSets(grid, msh, node_of, cell_of, faces, face_at));
    PetscCall(FileMeshTellStrays(grid, msh, node_of, faces, path, diag));
    PetscCall(FindOuter(grid));
  }
  PetscCall(TupleTableDestroy(&faces));
  PetscCall(PetscFree(face_at));
  PetscFunctionReturn(0);
}

PetscErrorCode FileMeshFill(FileMesh *mesh, const MshFile *msh, const char *path, Diag *diag)
{
  const PetscInt errors = diag_errors(diag);
  PetscInt *node_of, *cell_of, *entity_of;
  Grid *grid = mesh->grid;

  PetscFunctionBeginUser;
  if (!choose_types(msh, grid, path, diag)) PetscFunctionReturn(0);
  PetscCall(PetscMalloc3(msh->n_nodes, &node_of, msh->n_elements, &cell_of, msh->n_elements, &entity_of));
  PetscCall(TakeCells(mesh, msh, cell_of, entity_of));
  PetscCall(TakeNodes(grid, msh, node_of));
  measure(grid);
  check_plane(grid, msh, node_of, path, diag);
  if (diag_errors(diag) == errors) {
    PetscCall(TurnEntities(grid, entity_of));
    check_volumes(mesh, path, diag);
  }
  if (diag_errors(diag) == errors) PetscCall(ConnectMesh(mesh, msh, node_of, cell_of, path, diag));
  if (diag_errors(diag) == errors) PetscCall(FileMeshCheckOverlap(mesh, path, diag));
  PetscCall(PetscFree3(node_of, cell_of, entity_of));
  PetscFunctionReturn(0);
}

PetscErrorCode FileMeshCreate(MPI_Comm comm, const GridOps *ops, PetscInt dim, FileMesh *mesh)
{
  PetscFunctionBeginUser;
  *mesh = (FileMesh){0};
  PetscCall(PetscNew(&mesh->grid));
  PetscCall(PetscNew(&mesh->grid->mesh));
  mesh->grid->comm = comm;
  mesh->grid->ops = ops;
  mesh->grid->dim = dim;
  PetscFunctionReturn(0);
}

PetscErrorCode FileMeshDestroy(FileMesh *mesh)
{
  PetscFunctionBeginUser;
  PetscCall(GridDestroy(&mesh->grid));
  PetscCall(PetscFree(mesh->number));
  PetscFunctionReturn(0);
}
