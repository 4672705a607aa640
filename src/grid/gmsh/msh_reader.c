/* Room for what is read, and the elements that talus knows. */
#include "grid/gmsh/msh_reader.h"

static const MshType types[] = {{"line", 1, 1, 2},
                                {"triangle", 2, 2, 3},
                                {"quadrilateral", 3, 2, 4},
                                {"tetrahedron", 4, 3, 4},
                                {"hexahedron", 5, 3, 8},
                                {"point", 15, 0, 1},
                                {"prism", 6, 3, 0},
                                {"pyramid", 7, 3, 0},
                                {"second-order line", 8, 1, 0},
                                {"second-order triangle", 9, 2, 0},
                                {"second-order quadrilateral", 10, 2, 0},
                                {"second-order tetrahedron", 11, 3, 0},
                                {"second-order hexahedron", 12, 3, 0},
                                {"second-order quadrilateral", 16, 2, 0},
                                {"second-order hexahedron", 17, 3, 0},
                                {NULL, 0, 0, 0}};

PetscErrorCode MshAddMark(MshFile *msh, PetscInt element, PetscInt64 group)
{
  PetscFunctionBeginUser;
  if (msh->n_marks == msh->mark_capacity) {
    msh->mark_capacity = 2 * msh->mark_capacity + 1024;
    PetscCall(PetscRealloc((size_t)msh->mark_capacity * sizeof(PetscInt), &msh->mark_element));
    PetscCall(PetscRealloc((size_t)msh->mark_capacity * sizeof(PetscInt), &msh->mark_group));
  }
  msh->mark_element[msh->n_marks] = element;
  /* A negative group says that the entity is used with the opposite direction. */
  msh->mark_group[msh->n_marks++] = (PetscInt)(group < 0 ? -group : group);
  PetscFunctionReturn(0);
}

const MshType *msh_type(MshReader *r, PetscInt64 code, PetscInt64 element)
{
  for (const MshType *t = types; t->name; ++t) {
    if (t->code != code) continue;
    if (!t->nodes)
      msh_fail(r,
               "element %lld is a %s; talus reads first-order points, lines, triangles, quadrilaterals, tetrahedra and "
               "hexahedra%s",
               (long long)element, t->name,
               strncmp(t->name, "second", 6) ? "" : ": mesh with Mesh.ElementOrder = 1 (gmsh -order 1)");
    return t;
  }
  msh_fail(r, "element %lld is of Gmsh's type %lld, which talus does not read", (long long)element, (long long)code);
  return NULL;
}

PetscErrorCode MshAllocateNodes(MshReader *r, PetscInt n)
{
  MshFile *msh = r->msh;

  PetscFunctionBeginUser;
  if (r->has_nodes) msh_fail(r, "there are two $Nodes sections");
  if (r->failed) PetscFunctionReturn(0);
  r->has_nodes = PETSC_TRUE;
  msh->n_nodes = n;
  PetscCall(PetscMalloc1(n, &msh->node_tag));
  PetscCall(PetscMalloc1(3 * (size_t)n, &msh->x));
  PetscFunctionReturn(0);
}

PetscErrorCode MshAllocateElements(MshReader *r, PetscInt n)
{
  MshFile *msh = r->msh;

  PetscFunctionBeginUser;
  if (r->has_elements) msh_fail(r, "there are two $Elements sections");
  if (r->failed) PetscFunctionReturn(0);
  r->has_elements = PETSC_TRUE;
  msh->n_elements = n;
  PetscCall(PetscMalloc1(n, &msh->type));
  PetscCall(PetscMalloc1(n, &msh->tag));
  PetscCall(PetscMalloc1(n, &msh->entity));
  PetscCall(PetscMalloc1(MSH_MAX_NODES * (size_t)n, &msh->node));
  PetscFunctionReturn(0);
}

void msh_position(MshReader *r, PetscInt node)
{
  for (int d = 0; d < 3; ++d) r->msh->x[3 * node + d] = msh_real(r);
}
