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

/* Below the dimension of the cells by one, as their sides are. */
static PetscBool is_side(const Grid *grid, const MshFile *msh, PetscInt e)
{
  return (PetscBool)(msh->type[e]->dim == grid->dim - 1);
}

/* The face of the table that such an element is; -1: no cell has it. */
static PetscInt face_of(const Grid *grid, const MshFile *msh, PetscInt e, const PetscInt *node_of,
                        const TupleTable *faces)
{
  const PetscInt n = msh->type[e]->nodes;
  PetscInt key[MSH_MAX_NODES];
  if (n != cells[grid->type].face_nodes) return -1;
  for (PetscInt i = 0; i < n; ++i) {
    key[i] = node_of[msh->node[MSH_MAX_NODES * e + i]];
    if (key[i] < 0) return -1;
  }
  return tuple_find(faces, key);
}

/* The nodes of an element below the dimension of the cells, as far as cells use them, and its face
 * if it is one. */
static PetscErrorCode AddLowerElement(const Grid *grid, const MshFile *msh, PetscInt e, const PetscInt *node_of,
                                      const TupleTable *faces, const PetscInt *face_at, GridSet *set)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < msh->type[e]->nodes; ++i) {
    const PetscInt node = node_of[msh->node[MSH_MAX_NODES * e + i]];
    if (node >= 0) PetscCall(Append(node, &set->n_nodes, &set->nodes));
  }
  const PetscInt id = is_side(grid, msh, e) ? face_of(grid, msh, e, node_of, faces) : -1;
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

/* Sides that the file has in a set, those of no cell, and the first of these. */
typedef struct {
  PetscInt n, strays, first;
} Sides;

static void tell_strays(const Grid *grid, const char *name, const MshFile *msh, const Sides *sides, const char *path,
                        Diag *diag)
{
  const PetscInt nodes = msh->type[sides->first]->nodes;
  PetscReal x[3] = {0, 0, 0};
  char at[80];
  for (PetscInt i = 0; i < nodes; ++i)
    for (int d = 0; d < 3; ++d) x[d] += msh->x[3 * msh->node[MSH_MAX_NODES * sides->first + i] + d] / (PetscReal)nodes;
  if (grid->dim == 3) snprintf(at, sizeof at, "(%g, %g, %g)", (double)x[0], (double)x[1], (double)x[2]);
  else snprintf(at, sizeof at, "(%g, %g)", (double)x[0], (double)x[1]);
  diag_warning(diag, path, "no cell has %lld of the %lld sides of '%s', as that around %s: a load on '%s' goes without",
               (long long)sides->strays, (long long)sides->n, name, at, name);
  diag_hint(diag, "a side has the nodes of a cell: mesh it with its cells, and name it after nodes were doubled");
}

/* Of a set without any sides of cells no load is taken. */
PetscErrorCode FileMeshTellStrays(Grid *grid, const MshFile *msh, const PetscInt *node_of, const TupleTable *faces,
                                  const char *path, Diag *diag)
{
  Sides *sides;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(grid->n_sets, &sides));
  for (PetscInt k = 0; k < msh->n_marks; ++k) {
    const PetscInt e = msh->mark_element[k];
    PetscInt set;
    if (!is_side(grid, msh, e)) continue;
    PetscCall(GroupSet(grid, msh, msh->type[e]->dim, msh->mark_group[k], &set));
    ++sides[set].n;
    if (face_of(grid, msh, e, node_of, faces) < 0 && !sides[set].strays++) sides[set].first = e;
  }
  for (PetscInt s = 0; s < grid->n_sets; ++s)
    if (sides[s].strays && sides[s].strays < sides[s].n)
      tell_strays(grid, grid->sets[s].name, msh, sides + s, path, diag);
  PetscCall(PetscFree(sides));
  PetscFunctionReturn(0);
}
