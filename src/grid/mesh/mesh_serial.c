/* From a Gmsh file to cells of one kind, checked, with their neighbours. On rank 0. */
#include "grid/gmsh/msh.h"

/* Gmsh's numbers of the cell types, in the order of CellType. */
static const PetscInt gmsh_code[4] = {2, 3, 4, 5};

/* Which cells does the file have? PETSC_FALSE, with a message, if they cannot make a grid of this
 * dimension. */
static PetscBool choose_type(const MshFile *msh, PetscInt dim, const char *path, Diag *diag, CellType *type)
{
  PetscInt count[4] = {0, 0, 0, 0}, kinds = 0;
  for (PetscInt e = 0; e < msh->n_elements; ++e)
    for (int t = 0; t < 4; ++t) count[t] += msh->type[e]->code == gmsh_code[t];
  const PetscInt solid = count[CELL_TETRAHEDRON] + count[CELL_HEXAHEDRON];
  if (dim == 2 && solid) {
    diag_error(diag, path, "the mesh is three-dimensional (%lld solid cells), the kinematics two-dimensional",
               (long long)solid);
    return PETSC_FALSE;
  }
  for (int t = 0; t < 4; ++t)
    if (cells[t].dim == dim && count[t]) *type = (CellType)t, ++kinds;
  if (kinds == 1) return PETSC_TRUE;
  if (kinds == 0) {
    diag_error(diag, path, "the mesh has no %s", dim == 2 ? "triangles or quadrilaterals" : "tetrahedra or hexahedra");
    diag_hint(diag, "gmsh saves only what is in a physical group once there is one: is the %s in a group?",
              dim == 2 ? "surface" : "volume");
    return PETSC_FALSE;
  }
  const CellType a = dim == 2 ? CELL_TRIANGLE : CELL_TETRAHEDRON, b = dim == 2 ? CELL_QUADRILATERAL : CELL_HEXAHEDRON;
  diag_error(diag, path, "the mesh mixes %lld cells of type %s with %lld of type %s; all must be alike",
             (long long)count[a], cells[a].name, (long long)count[b], cells[b].name);
  if (dim == 2)
    diag_hint(diag,
              "in gmsh: 'Recombine Surface' for all surfaces or for none, Mesh.SubdivisionAlgorithm = 1 for "
              "quadrilaterals only");
  return PETSC_FALSE;
}

/* The cells, each once: version 2 repeats an element for each of its groups. cell_of[e]: the cell
 * that element e is, or -1. */
static PetscErrorCode TakeCells(SerialMesh *mesh, const MshFile *msh, PetscInt *cell_of, PetscInt *entity_of)
{
  const PetscInt nn = cells[mesh->type].nodes;
  TupleTable *seen;

  PetscFunctionBeginUser;
  PetscCall(TupleTableCreate(nn, msh->n_elements, &seen));
  PetscCall(PetscMalloc1(msh->n_elements * nn, &mesh->cell_node));
  PetscCall(PetscMalloc1(msh->n_elements, &mesh->number));
  for (PetscInt e = 0; e < msh->n_elements; ++e) {
    const PetscInt *node = msh->node + MSH_MAX_NODES * e;
    cell_of[e] = -1;
    if (msh->type[e]->code != gmsh_code[mesh->type]) continue;
    const PetscInt cell = cell_of[e] = tuple_add(seen, node);
    if (cell < mesh->n_cells) continue;
    ++mesh->n_cells;
    mesh->number[cell] = msh->tag[e];
    entity_of[cell] = msh->entity[e];
    PetscCall(PetscArraycpy(mesh->cell_node + cell * nn, node, nn));
  }
  PetscCall(TupleTableDestroy(&seen));
  PetscFunctionReturn(0);
}

/* The nodes that cells use, in the order of the file. node_of: their index in the mesh, or -1. */
static PetscErrorCode TakeNodes(SerialMesh *mesh, const MshFile *msh, PetscInt *node_of)
{
  const PetscInt n = mesh->n_cells * cells[mesh->type].nodes;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < msh->n_nodes; ++k) node_of[k] = -1;
  for (PetscInt k = 0; k < n; ++k) node_of[mesh->cell_node[k]] = 0;
  for (PetscInt k = 0; k < msh->n_nodes; ++k)
    if (!node_of[k]) node_of[k] = mesh->n_nodes++;
  for (PetscInt k = 0; k < n; ++k) mesh->cell_node[k] = node_of[mesh->cell_node[k]];
  PetscCall(PetscMalloc1(mesh->n_nodes * mesh->dim, &mesh->x));
  for (PetscInt k = 0; k < msh->n_nodes; ++k)
    for (PetscInt d = 0; d < mesh->dim && node_of[k] >= 0; ++d) mesh->x[node_of[k] * mesh->dim + d] = msh->x[3 * k + d];
  PetscFunctionReturn(0);
}

/* Diameter of the set of nodes, along its longest axis. */
static PetscReal mesh_size(const SerialMesh *mesh)
{
  PetscReal size = 0;
  for (PetscInt d = 0; d < mesh->dim; ++d) {
    PetscReal min = PETSC_MAX_REAL, max = -PETSC_MAX_REAL;
    for (PetscInt k = 0; k < mesh->n_nodes; ++k) {
      min = PetscMin(min, mesh->x[k * mesh->dim + d]);
      max = PetscMax(max, mesh->x[k * mesh->dim + d]);
    }
    size = PetscMax(size, max - min);
  }
  return size;
}

static void check_plane(const SerialMesh *mesh, const MshFile *msh, const PetscInt *node_of, const char *path,
                        Diag *diag)
{
  const PetscReal tolerance = 1e-9 * mesh_size(mesh);
  for (PetscInt k = 0; k < msh->n_nodes && mesh->dim == 2; ++k) {
    if (node_of[k] < 0 || PetscAbsReal(msh->x[3 * k + 2]) <= tolerance) continue;
    diag_error(diag, path, "the mesh must lie in the plane z = 0, but its node %lld has z = %g",
               (long long)msh->node_tag[k], (double)msh->x[3 * k + 2]);
    return;
  }
}

static void serial_cell_x(const SerialMesh *mesh, PetscInt cell, PetscReal *x)
{
  const PetscInt nn = cells[mesh->type].nodes, dim = mesh->dim;
  for (PetscInt i = 0; i < nn; ++i)
    for (PetscInt d = 0; d < dim; ++d) x[i * dim + d] = mesh->x[mesh->cell_node[cell * nn + i] * dim + d];
}

/* The smallest determinant of the map at the cell's corners, relative to the size of its edges. */
static PetscReal worst_corner(const SerialMesh *mesh, PetscInt cell)
{
  const Cell *shape = cells + mesh->type;
  PetscReal x[3 * CELL_MAX_NODES], N[CELL_MAX_NODES], dN[3 * CELL_MAX_NODES], worst = PETSC_MAX_REAL, edge = 0;
  serial_cell_x(mesh, cell, x);
  for (PetscInt i = 0; i < shape->nodes; ++i) {
    worst = PetscMin(worst, cell_gradients(mesh->type, x, shape->reference[i], N, dN));
    for (PetscInt d = 0; d < mesh->dim; ++d) edge = PetscMax(edge, PetscAbsReal(x[i * mesh->dim + d] - x[d]));
  }
  return edge > 0 ? worst / PetscPowRealInt(edge, (int)mesh->dim) : 0;
}

static PetscReal signed_volume(const SerialMesh *mesh, PetscInt cell)
{
  PetscReal x[3 * CELL_MAX_NODES];
  serial_cell_x(mesh, cell, x);
  return cell_volume(mesh->type, x);
}

/* The same cell seen from the other side. */
static void turn_cell(CellType type, PetscInt *node)
{
  static const PetscInt swaps[4][2][2] = {{{1, 2}, {0, 0}}, {{1, 3}, {0, 0}}, {{1, 2}, {0, 0}}, {{1, 3}, {5, 7}}};
  for (int s = 0; s < 2; ++s) {
    const PetscInt a = swaps[type][s][0], b = swaps[type][s][1], keep = node[a];
    node[a] = node[b];
    node[b] = keep;
  }
}

/* A surface drawn clockwise gives clockwise cells, all of them: nothing is wrong with those but
 * their order of nodes. */
static PetscErrorCode TurnEntities(SerialMesh *mesh, const PetscInt *entity_of)
{
  PetscInt n = mesh->n_cells, *entity;
  PetscBool *positive;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &entity));
  PetscCall(PetscArraycpy(entity, entity_of, n));
  PetscCall(PetscSortRemoveDupsInt(&n, entity));
  PetscCall(PetscCalloc1(n, &positive));
  for (int turn = 0; turn < 2; ++turn)
    for (PetscInt c = 0; c < mesh->n_cells; ++c) {
      PetscInt at;
      PetscCall(PetscFindInt(entity_of[c], n, entity, &at));
      if (turn && !positive[at]) turn_cell(mesh->type, mesh->cell_node + c * cells[mesh->type].nodes);
      else if (!turn && signed_volume(mesh, c) >= 0) positive[at] = PETSC_TRUE;
    }
  PetscCall(PetscFree(entity));
  PetscCall(PetscFree(positive));
  PetscFunctionReturn(0);
}

static void check_volumes(const SerialMesh *mesh, const char *path, Diag *diag)
{
  PetscInt bad = 0;
  size_t used = 0;
  char list[128] = "";
  for (PetscInt c = 0; c < mesh->n_cells; ++c) {
    if (worst_corner(mesh, c) > 1e-12) continue;
    if (++bad > 5) continue;
    used +=
      (size_t)snprintf(list + used, sizeof list - used, "%s%lld", bad > 1 ? ", " : "", (long long)mesh->number[c]);
  }
  if (!bad) return;
  diag_error(diag, path, "%lld of %lld cells are inverted or have no volume: element%s %s%s", (long long)bad,
             (long long)mesh->n_cells, bad > 1 ? "s" : "", list, bad > 5 ? ", ..." : "");
  diag_hint(
    diag,
    "gmsh's Tools > Statistics and Plugin(AnalyseMeshQuality) show them; a finer or better shaped mesh is needed");
}

/* Let cells find each other through their faces. face_at: where each face of the table was first
 * seen. */
static PetscErrorCode FindNeighbours(SerialMesh *mesh, TupleTable *faces, PetscInt *face_at, const char *path,
                                     Diag *diag)
{
  const Cell *shape = cells + mesh->type;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->n_cells * shape->faces, &mesh->neighbour));
  for (PetscInt k = 0; k < mesh->n_cells * shape->faces; ++k) {
    const PetscInt cell = k / shape->faces, *node = mesh->cell_node + cell * shape->nodes,
                   *face = shape->face[k % shape->faces];
    PetscInt key[4];
    for (PetscInt i = 0; i < shape->face_nodes; ++i) key[i] = node[face[i]];
    const PetscInt before = tuple_count(faces), id = tuple_add(faces, key);
    mesh->neighbour[k] = -1;
    if (id == before) {
      face_at[id] = k;
      continue;
    }
    if (mesh->neighbour[face_at[id]] >= 0) {
      const PetscInt other = face_at[id] / shape->faces;
      diag_error(diag, path, "three cells share one face: elements %lld, %lld and %lld overlap",
                 (long long)mesh->number[other], (long long)mesh->number[mesh->neighbour[face_at[id]]],
                 (long long)mesh->number[cell]);
      PetscFunctionReturn(0);
    }
    mesh->neighbour[k] = face_at[id] / shape->faces;
    mesh->neighbour[face_at[id]] = cell;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ConnectMesh(SerialMesh *mesh, const MshFile *msh, const PetscInt *node_of,
                                  const PetscInt *cell_of, const char *path, Diag *diag)
{
  const Cell *shape = cells + mesh->type;
  const PetscInt errors = diag_errors(diag);
  TupleTable *faces;
  PetscInt *face_at;

  PetscFunctionBeginUser;
  PetscCall(TupleTableCreate(shape->face_nodes, mesh->n_cells * shape->faces, &faces));
  PetscCall(PetscMalloc1(mesh->n_cells * shape->faces, &face_at));
  PetscCall(FindNeighbours(mesh, faces, face_at, path, diag));
  if (diag_errors(diag) == errors) PetscCall(SerialMeshSets(mesh, msh, node_of, cell_of, faces, face_at));
  PetscCall(TupleTableDestroy(&faces));
  PetscCall(PetscFree(face_at));
  PetscFunctionReturn(0);
}

PetscErrorCode SerialMeshCreate(const MshFile *msh, PetscInt dim, const char *path, Diag *diag, SerialMesh **out)
{
  const PetscInt errors = diag_errors(diag);
  PetscInt *node_of, *cell_of, *entity_of;
  SerialMesh *mesh;
  CellType type;

  PetscFunctionBeginUser;
  *out = NULL;
  if (!choose_type(msh, dim, path, diag, &type)) PetscFunctionReturn(0);
  PetscCall(PetscNew(&mesh));
  mesh->dim = dim;
  mesh->type = type;
  PetscCall(PetscMalloc3(msh->n_nodes, &node_of, msh->n_elements, &cell_of, msh->n_elements, &entity_of));
  PetscCall(TakeCells(mesh, msh, cell_of, entity_of));
  PetscCall(TakeNodes(mesh, msh, node_of));
  check_plane(mesh, msh, node_of, path, diag);
  if (diag_errors(diag) == errors) {
    PetscCall(TurnEntities(mesh, entity_of));
    check_volumes(mesh, path, diag);
  }
  if (diag_errors(diag) == errors) PetscCall(ConnectMesh(mesh, msh, node_of, cell_of, path, diag));
  if (diag_errors(diag) == errors) PetscCall(SerialMeshCheckOverlap(mesh, path, diag));
  PetscCall(PetscFree3(node_of, cell_of, entity_of));
  if (diag_errors(diag) != errors) PetscCall(SerialMeshDestroy(&mesh));
  *out = mesh;
  PetscFunctionReturn(0);
}

PetscErrorCode SerialMeshDestroy(SerialMesh **mesh)
{
  PetscFunctionBeginUser;
  if (!*mesh) PetscFunctionReturn(0);
  for (PetscInt s = 0; s < (*mesh)->n_sets; ++s) PetscCall(GridSetDestroy((*mesh)->sets + s));
  PetscCall(PetscFree((*mesh)->sets));
  PetscCall(PetscFree((*mesh)->cell_node));
  PetscCall(PetscFree((*mesh)->number));
  PetscCall(PetscFree((*mesh)->x));
  PetscCall(PetscFree((*mesh)->neighbour));
  PetscCall(PetscFree(*mesh));
  PetscFunctionReturn(0);
}
