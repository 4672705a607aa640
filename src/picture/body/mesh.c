/* Bodies of fem are their cells: filled polygons, coloured by nodes where the mesh has the field, else by the mean of
 * the points of each cell; in space the outer faces alone. */
#include <stdlib.h>
#include <string.h>
#include "picture/body/cells.h"
#include "picture/scene/scene.h"

/* The cells of a state, and their colours. */
typedef struct {
  VtkCells cells;
  PetscReal *x;       /* of the nodes, x 3 */
  PetscReal *at_node; /* NULL: the cells have values */
  PetscReal *of_cell;
  PetscInt *points; /* in each cell */
  PetscReal *u;     /* displacements of the nodes, where the first outline is drawn; NULL */
} Mesh;

/* Values at the nodes, if the grid has such a field. */
static PetscErrorCode ReadNodes(VtkFile *file, const VtkFieldInfo *field, const PlotScalar *scalar, Mesh *mesh)
{
  const VtkFieldInfo *fields;
  const PetscInt n = vtk_read_fields(file, &fields), nodes = vtk_read_points(file);
  PetscReal *data;
  char reason[256];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; ++i) {
    if (strcmp(fields[i].name, field->name) || fields[i].components != field->components) continue;
    if (VtkReadField(file, &fields[i], &data, reason)) PetscFunctionReturn(0);
    PetscCall(PetscMalloc1(nodes, &mesh->at_node));
    for (PetscInt k = 0; k < nodes; ++k)
      mesh->at_node[k] = plot_scalar_value(scalar, field->components, data + k * field->components);
    PetscCall(PetscFree(data));
    break;
  }
  PetscFunctionReturn(0);
}

/* Means of the points in each cell; cells without points are no body. */
static PetscErrorCode CountPoints(const PlotScene *scene, const PlotFrame *f, PetscInt dim, Mesh *mesh)
{
  const PetscInt n = scene->mirrored ? f->n / 2 : f->n;
  PetscInt *cell;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &cell));
  PetscCall(PetscCalloc2(mesh->cells.n, &mesh->of_cell, mesh->cells.n, &mesh->points));
  PetscCall(CellsOfPoints(&mesh->cells, mesh->x, dim, n, f->x, cell));
  for (PetscInt i = 0; i < n; ++i) {
    if (cell[i] < 0) continue;
    mesh->of_cell[cell[i]] += f->value[i];
    ++mesh->points[cell[i]];
  }
  for (PetscInt c = 0; c < mesh->cells.n; ++c)
    if (mesh->points[c]) mesh->of_cell[c] /= (PetscReal)mesh->points[c];
  PetscCall(PetscFree(cell));
  PetscFunctionReturn(0);
}

/* A polygon of a cell that is drawn. */
typedef struct {
  PetscInt node[4], sorted[4], cell; /* node[3] = -1: a triangle */
} Face;

static int compare_numbers(const void *a, const void *b)
{
  const PetscInt x = *(const PetscInt *)a, y = *(const PetscInt *)b;
  return (x > y) - (x < y);
}

static int compare_faces(const void *a, const void *b)
{
  const Face *x = a, *y = b;
  for (int k = 0; k < 4; ++k)
    if (x->sorted[k] != y->sorted[k]) return x->sorted[k] < y->sorted[k] ? -1 : 1;
  return (x->cell > y->cell) - (x->cell < y->cell);
}

static PetscInt cell_face(const VtkCells *cells, PetscInt c, const int corner[4], Face *face)
{
  for (int k = 0; k < 4; ++k)
    face->node[k] = face->sorted[k] = corner[k] < 0 ? -1 : cells->node[cells->start[c] + corner[k]];
  qsort(face->sorted, 4, sizeof *face->sorted, compare_numbers);
  face->cell = c;
  return 1;
}

/* All faces of cells with points; in space those that no two of them share. */
static PetscErrorCode FindFaces(const Mesh *mesh, PetscInt dim, PetscInt *n, Face **faces)
{
  PetscInt all = 0, kept = 0;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < mesh->cells.n; ++c) all += mesh->points[c] ? cell_faces(mesh->cells.type[c]).n : 0;
  PetscCall(PetscMalloc1(all + 1, faces));
  all = 0;
  for (PetscInt c = 0; c < mesh->cells.n; ++c) {
    const CellFaces of = cell_faces(mesh->cells.type[c]);
    for (PetscInt k = 0; k < of.n && mesh->points[c]; ++k)
      all += cell_face(&mesh->cells, c, of.face[k], &(*faces)[all]);
  }
  if (dim == 3) {
    qsort(*faces, (size_t)all, sizeof **faces, compare_faces);
    for (PetscInt i = 0, next; i < all; i = next) {
      for (next = i + 1; next < all && !memcmp((*faces)[next].sorted, (*faces)[i].sorted, sizeof(PetscInt[4]));) ++next;
      if (next == i + 1) (*faces)[kept++] = (*faces)[i];
    }
    all = kept;
  }
  *n = all;
  PetscFunctionReturn(0);
}

static void add_triangle(const Mesh *mesh, const Face *face, const int corner[3], int sides, PlotFrame *f)
{
  const PetscInt t = f->n_triangles++;
  for (int k = 0; k < 3; ++k) {
    const PetscInt node = face->node[corner[k]];
    memcpy(f->corner + 9 * t + 3 * k, mesh->x + 3 * node, 3 * sizeof(PetscReal));
    for (int d = 0; d < 3 && mesh->u; ++d)
      f->first_corner[9 * t + 3 * k + d] = mesh->x[3 * node + d] - mesh->u[3 * node + d];
    f->corner_value[3 * t + k] = mesh->at_node ? mesh->at_node[node] : mesh->of_cell[face->cell];
  }
  f->side[t] = (unsigned char)sides;
}

static void mirror_corners(PetscReal *corner, PetscInt n)
{
  memcpy(corner + 9 * n, corner, 9 * (size_t)n * sizeof(PetscReal));
  for (PetscInt i = 3 * n; i < 6 * n; ++i) corner[3 * i] = -corner[3 * i];
}

static void mirror_triangles(PlotFrame *f)
{
  const PetscInt n = f->n_triangles;
  mirror_corners(f->corner, n);
  if (f->first_corner) mirror_corners(f->first_corner, n);
  memcpy(f->corner_value + 3 * n, f->corner_value, 3 * (size_t)n * sizeof(PetscReal));
  memcpy(f->side + n, f->side, (size_t)n);
  f->n_triangles *= 2;
}

static PetscErrorCode TakeFaces(PlotScene *scene, const Mesh *mesh, PetscInt n, const Face *faces, PlotFrame *f)
{
  static const int first[3] = {0, 1, 2}, second[3] = {0, 2, 3};
  const size_t room = (size_t)n * 2 * (scene->mirrored ? 2 : 1);

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(9 * room, &f->corner, 3 * room, &f->corner_value, room, &f->side));
  if (mesh->u) PetscCall(PetscMalloc1(9 * room, &f->first_corner));
  for (PetscInt i = 0; i < n; ++i) {
    const PetscBool four = faces[i].node[3] >= 0;
    add_triangle(mesh, &faces[i], first, four ? 1 | 2 : 1 | 2 | 4, f);
    if (four) add_triangle(mesh, &faces[i], second, 2 | 4, f);
    for (int k = 0; k < (four ? 4 : 3); ++k)
      for (int d = 0; d < 3; ++d) {
        const PetscReal x = mesh->x[3 * faces[i].node[k] + d];
        scene->box_min[d] = PetscMin(scene->box_min[d], x);
        scene->box_max[d] = PetscMax(scene->box_max[d], x);
      }
  }
  if (scene->mirrored) mirror_triangles(f);
  PetscFunctionReturn(0);
}

PetscErrorCode PlotFrameMesh(VtkFile *file, PetscInt dim, const VtkFieldInfo *field, const PlotScalar *scalar,
                             PlotScene *scene, PlotFrame *f, char reason[256])
{
  Mesh mesh = {0};
  Face *faces;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  if (VtkReadCoordinates(file, &mesh.x, reason)) PetscFunctionReturn(0);
  if (VtkReadTopology(file, &mesh.cells, reason) == 0) {
    if (!scene->named) PetscCall(ReadNodes(file, field, scalar, &mesh));
    if (f->first) PetscCall(PlotReadDisplacement(file, &mesh.u, reason));
    PetscCall(CountPoints(scene, f, dim, &mesh));
    PetscCall(FindFaces(&mesh, dim, &n, &faces));
    PetscCall(TakeFaces(scene, &mesh, n, faces, f));
    if (n) { /* cells stand for their points */
      f->n = f->n_first = 0;
      PetscCall(PetscFree2(f->first, f->first_radius));
    }
    PetscCall(PetscFree(faces));
    PetscCall(PetscFree(mesh.at_node));
    PetscCall(PetscFree(mesh.u));
    PetscCall(PetscFree2(mesh.of_cell, mesh.points));
    PetscCall(VtkCellsFree(&mesh.cells));
  }
  PetscCall(PetscFree(mesh.x));
  PetscFunctionReturn(0);
}
