/* Walls and what touches them, as states that stand beside those of the points. */
#include "run/output/output_private.h"
#include "wall/facets/mesh.h"

/* Pieces of a wall are at most so much of the longest side of the grid. */
#define FINENESS (1. / 48)

static PetscErrorCode MeshOfAll(const Model *m, WallMesh *mesh)
{
  PetscReal longest = 0;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  *mesh = (WallMesh){.dim = m->dim};
  PetscCallMPI(MPI_Comm_rank(m->comm, &rank));
  for (PetscInt d = 0; d < m->dim; ++d) longest = PetscMax(longest, m->grid->max[d] - m->grid->min[d]);
  const WallView view = {.min = m->grid->min, .max = m->grid->max, .size = FINENESS * longest};
  for (PetscInt k = 0; k < m->c->n_walls && !rank; ++k)
    if (wall_stands(m->walls, k, m->time) || wall_comes(m->walls, k, m->time))
      PetscCall(WallMeshAdd(m->walls, k, m->time, &view, mesh));
  PetscFunctionReturn(0);
}

PetscErrorCode OutputWalls(Output *o, const Model *m, PetscBool *ok, char reason[256])
{
  WallMesh mesh;

  PetscFunctionBeginUser;
  PetscCall(MeshOfAll(m, &mesh));
  const VtkField wall = {.name = "wall", .components = 1, .data = mesh.wall};
  const VtkData data = {.n_points = m->dim * mesh.n,
                        .x = mesh.x,
                        .n_cells = mesh.n,
                        .connectivity = mesh.node,
                        .nodes_per_cell = m->dim,
                        .vtk_type = m->dim == 2 ? 3 : 5, /* a line, a triangle */
                        .n_cell_fields = 1,
                        .cell_fields = &wall,
                        .time = m->time};
  PetscCall(OutputState(o, m->comm, "walls", &data, NULL, ok, reason));
  PetscCall(WallMeshFree(&mesh));
  PetscFunctionReturn(0);
}

/* One number or vector after another: pressure, section, wall; normal, shear, position. */
enum { NUMBERS = 3, VECTORS = 3 };

static PetscErrorCode Gather(const Model *m, PetscInt *n, PetscReal *numbers[NUMBERS], PetscReal *vectors[VECTORS])
{
  const PetscInt room = m->contact->n;
  PetscInt count;

  PetscFunctionBeginUser;
  for (int i = 0; i < NUMBERS; ++i) PetscCall(PetscMalloc1(room, &numbers[i]));
  for (int i = 0; i < VECTORS; ++i) PetscCall(PetscMalloc1(3 * room, &vectors[i]));
  *n = 0;
  for (PetscInt k = 0; k < m->c->n_walls; ++k) {
    ContactTraction *t;
    PetscCall(ModelTractions(m, k, &count, &t));
    for (PetscInt i = 0; i < count; ++i, ++*n) {
      numbers[0][*n] = t[i].pressure, numbers[1][*n] = t[i].section, numbers[2][*n] = (PetscReal)k;
      for (int d = 0; d < 3; ++d) {
        vectors[0][3 * *n + d] = t[i].normal[d];
        vectors[1][3 * *n + d] = t[i].shear[d];
        vectors[2][3 * *n + d] = t[i].x[d];
      }
    }
    PetscCall(PetscFree(t));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode OutputContact(Output *o, const Model *m, PetscBool *ok, char reason[256])
{
  PetscReal *numbers[NUMBERS], *vectors[VECTORS];
  PetscInt n = 0;
  PetscBool kept;

  PetscFunctionBeginUser;
  PetscCall(OutputKeep(o, m, "contact", &kept, ok, reason));
  if (kept) PetscFunctionReturn(0);
  PetscCall(Gather(m, &n, numbers, vectors));
  const VtkField fields[] = {
    {.name = "pressure", .unit = "Pa", .components = 1, .data = numbers[0]},
    {.name = "shear", .unit = "Pa", .components = 3, .data = vectors[1]},
    {.name = "normal", .components = 3, .data = vectors[0]},
    {.name = "section", .unit = "m2", .components = 1, .data = numbers[1]},
    {.name = "wall", .components = 1, .data = numbers[2]},
  };
  const VtkData data = {.n_points = n,
                        .x = vectors[2],
                        .n_cells = n,
                        .nodes_per_cell = 1,
                        .vtk_type = 1,
                        .n_point_fields = (PetscInt)PETSC_STATIC_ARRAY_LENGTH(fields),
                        .point_fields = fields,
                        .time = m->time};
  PetscCall(OutputState(o, m->comm, "contact", &data, NULL, ok, reason));
  for (int i = 0; i < NUMBERS; ++i) PetscCall(PetscFree(numbers[i]));
  for (int i = 0; i < VECTORS; ++i) PetscCall(PetscFree(vectors[i]));
  PetscFunctionReturn(0);
}
