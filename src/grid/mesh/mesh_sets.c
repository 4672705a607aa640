/* Named sets from physical groups: of cells (regions), of faces and their nodes (boundaries), of
 * nodes alone. On rank 0.
 *
 * Groups of the same name are one set, whatever their dimensions; a group without a name goes by
 * its number. */
#include "grid/mesh/file_mesh.h"

/* Lists grow at every power of two, so that they need not remember how much room they have. */
static PetscErrorCode Append(PetscInt value, PetscInt *n, PetscInt **list)
{
  PetscFunctionBeginUser;
  if (!(*n & (*n - 1))) PetscCall(PetscRealloc((size_t)PetscMax(2 * *n, 1) * sizeof(PetscInt), list));
  (*list)[(*n)++] = value;
  PetscFunctionReturn(0);
}

/* The set of this name, made if there is none. */
static PetscErrorCode FindOrAddSet(Grid *grid, const char *name, PetscInt *set)
{
  PetscFunctionBeginUser;
  for (*set = 0; *set < grid->n_sets; ++*set)
    if (!strcmp(grid->sets[*set].name, name)) PetscFunctionReturn(0);
  PetscCall(PetscRealloc((size_t)(grid->n_sets + 1) * sizeof(GridSet), &grid->sets));
  grid->sets[grid->n_sets] = (GridSet){0};
  PetscCall(PetscStrallocpy(name, &grid->sets[grid->n_sets++].name));
  PetscFunctionReturn(0);
}

static PetscErrorCode GroupSet(Grid *grid, const MshFile *msh, PetscInt dim, PetscInt tag, PetscInt *set)
{
  char number[32];

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < msh->n_names; ++k)
    if (msh->names[k].dim == dim && msh->names[k].tag == tag) {
      PetscCall(FindOrAddSet(grid, msh->names[k].name, set));
      PetscFunctionReturn(0);
    }
  (void)snprintf(number, sizeof number, "%lld", (long long)tag);
  PetscCall(FindOrAddSet(grid, number, set));
  PetscFunctionReturn(0);
}

/* The nodes of an element below the dimension of the cells, as far as cells use them, and its face
 * if it is one. */
static PetscErrorCode AddLowerElement(const Grid *grid, const MshFile *msh, PetscInt e, const PetscInt *node_of,
                                      const TupleTable *faces, const PetscInt *face_at, GridSet *set)
{
  const PetscInt n = msh->type[e]->nodes;
  PetscInt key[MSH_MAX_NODES];
  PetscBool used = PETSC_TRUE;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; ++i) {
    key[i] = node_of[msh->node[MSH_MAX_NODES * e + i]];
    if (key[i] >= 0) PetscCall(Append(key[i], &set->n_nodes, &set->nodes));
    else used = PETSC_FALSE;
  }
  if (!used || msh->type[e]->dim != grid->dim - 1 || n != cells[grid->type].face_nodes) PetscFunctionReturn(0);
  const PetscInt id = tuple_find(faces, key);
  /* Cell and side stay one number until the repeated ones are gone. */
  if (id >= 0) PetscCall(Append(face_at[id], &set->n_faces, &set->face_cell));
  PetscFunctionReturn(0);
}

static PetscErrorCode FinishSet(const Grid *grid, GridSet *set)
{
  const PetscInt n_faces = mesh_faces(grid);

  PetscFunctionBeginUser;
  PetscCall(PetscSortRemoveDupsInt(&set->n_nodes, set->nodes));
  PetscCall(PetscSortRemoveDupsInt(&set->n_faces, set->face_cell));
  PetscCall(PetscSortRemoveDupsInt(&set->n_cells, set->cells));
  PetscCall(PetscMalloc1(set->n_faces, &set->face_side));
  for (PetscInt f = 0; f < set->n_faces; ++f) {
    set->face_side[f] = set->face_cell[f] % n_faces;
    set->face_cell[f] /= n_faces;
  }
  PetscFunctionReturn(0);
}

/* The groups that have a name come first, in the order of the file, even where they are empty. */
PetscErrorCode FileMeshSets(Grid *grid, const MshFile *msh, const PetscInt *node_of, const PetscInt *cell_of,
                            const TupleTable *faces, const PetscInt *face_at)
{
  PetscInt set = 0, dim = -1, group = -1;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < msh->n_names; ++k) PetscCall(FindOrAddSet(grid, msh->names[k].name, &set));
  for (PetscInt k = 0; k < msh->n_marks; ++k) {
    const PetscInt e = msh->mark_element[k];
    if (msh->type[e]->dim != dim || msh->mark_group[k] != group) { /* they come in long runs */
      dim = msh->type[e]->dim, group = msh->mark_group[k];
      PetscCall(GroupSet(grid, msh, dim, group, &set));
    }
    GridSet *s = grid->sets + set;
    if (cell_of[e] >= 0) PetscCall(Append(cell_of[e], &s->n_cells, &s->cells));
    else if (dim < grid->dim) PetscCall(AddLowerElement(grid, msh, e, node_of, faces, face_at, s));
  }
  for (PetscInt s = 0; s < grid->n_sets; ++s) PetscCall(FinishSet(grid, grid->sets + s));
  PetscFunctionReturn(0);
}
