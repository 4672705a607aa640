/* Cells that lie side by side and share no nodes, as from two surfaces that were drawn beside each
 * other: nothing joins them, unless they are of two bodies that meet at an interface. A slit may be meant, so it is a
 * warning. On rank 0. */
#include "grid/mesh/file_mesh.h"

#define ONE_PLACE 1e-4 /* of the smallest edge: who wants a gap makes a wider one */

typedef struct {
  const Grid *grid;
  const Case *c;
  PetscInt *body;        /* of each node; NULL: no bodies meet */
  PetscInt pairs, first; /* first: the node of lowest number that has another at its place */
} Torn;

static PetscBool at_one_place(const Grid *grid, PetscInt a, PetscInt b)
{
  const PetscReal *x = grid->x + a * grid->dim, *y = grid->x + b * grid->dim;
  PetscReal square = 0;
  for (PetscInt d = 0; d < grid->dim; ++d) square += (x[d] - y[d]) * (x[d] - y[d]);
  return square <= PetscSqr(ONE_PLACE * grid->smallest);
}

/* Nodes in their order along a line that hardly any two of them share a plane across: only
 * neighbours there can be near each other. */
static PetscErrorCode SortAlongLine(const Grid *grid, PetscInt n, PetscReal *along, PetscInt *node)
{
  static const PetscReal line[3] = {0.7548776662, 0.5698402910, 0.3247179572};

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < n; ++k) {
    along[k] = 0;
    for (PetscInt d = 0; d < grid->dim; ++d) along[k] += line[d] * grid->x[node[k] * grid->dim + d];
  }
  PetscCall(PetscSortRealWithArrayInt(n, along, node));
  PetscFunctionReturn(0);
}

#define NONE (-1)
#define SEVERAL (-2)

/* Bodies that fill a region: of each node that whose cells alone have it. */
static PetscErrorCode FindBodies(Torn *torn)
{
  const Grid *grid = torn->grid;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(grid->n_nodes, &torn->body));
  for (PetscInt i = 0; i < grid->n_nodes; ++i) torn->body[i] = NONE;
  for (PetscInt b = 0; b < torn->c->n_bodies; ++b) {
    const char *region = torn->c->bodies[b].region;
    const GridSet *set = region ? grid_find_set(grid, region) : NULL;
    for (PetscInt k = 0; set && k < set->n_cells; ++k)
      for (PetscInt i = 0; i < grid->nodes_per_cell; ++i) {
        PetscInt *body = torn->body + grid->cell_node[set->cells[k] * grid->nodes_per_cell + i];
        *body = *body == NONE || *body == b ? b : SEVERAL;
      }
  }
  PetscFunctionReturn(0);
}

static PetscBool meet(const Torn *torn, PetscInt i, PetscInt j)
{
  PetscBool first;
  if (!torn->body || torn->body[i] < 0 || torn->body[j] < 0) return PETSC_FALSE;
  return (PetscBool)(case_interface(torn->c, torn->body[i], torn->body[j], &first) >= 0);
}

static void count_pairs(Torn *torn, PetscInt n, const PetscReal *along, const PetscInt *node)
{
  const PetscReal reach = ONE_PLACE * torn->grid->smallest;
  for (PetscInt k = 0; k < n; ++k)
    for (PetscInt j = k + 1; j < n && along[j] - along[k] <= reach; ++j) {
      const PetscInt lower = PetscMin(node[k], node[j]);
      if (!at_one_place(torn->grid, node[k], node[j]) || meet(torn, node[k], node[j])) continue;
      if (!torn->pairs++ || lower < torn->first) torn->first = lower;
    }
}

static void tell(const Torn *torn, const char *path, Diag *diag)
{
  const PetscReal *x = torn->grid->x + torn->first * torn->grid->dim;
  char at[80];
  if (torn->grid->dim == 3) snprintf(at, sizeof at, "(%g, %g, %g)", (double)x[0], (double)x[1], (double)x[2]);
  else snprintf(at, sizeof at, "(%g, %g)", (double)x[0], (double)x[1]);
  diag_warning(diag, path,
               "nothing joins the cells of this mesh where %lld pair%s of nodes stand%s at one place, as at %s",
               (long long)torn->pairs, torn->pairs == 1 ? "" : "s", torn->pairs == 1 ? "s" : "", at);
  diag_hint(diag,
            "surfaces that touch share their line: `Coherence;` in a .geo, or Gmsh's Remove duplicate nodes. A slit "
            "that is meant is one; bodies of two regions that are to meet there need `interfaces`");
}

PetscErrorCode FileMeshTellTorn(const FileMesh *mesh, const Case *c, const char *path, Diag *diag)
{
  const GridSet *outer = &mesh->grid->outer; /* what is torn has sides without a neighbour */
  Torn torn = {.grid = mesh->grid, .c = c};
  PetscReal *along;
  PetscInt *node;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(outer->n_nodes, &along, outer->n_nodes, &node));
  PetscCall(PetscArraycpy(node, outer->nodes, outer->n_nodes));
  if (c && c->n_interfaces) PetscCall(FindBodies(&torn));
  PetscCall(SortAlongLine(mesh->grid, outer->n_nodes, along, node));
  count_pairs(&torn, outer->n_nodes, along, node);
  PetscCall(PetscFree2(along, node));
  PetscCall(PetscFree(torn.body));
  if (torn.pairs) tell(&torn, path, diag);
  PetscFunctionReturn(0);
}
