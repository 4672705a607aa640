/* A bed of springs: each node of one boundary of the mesh stands on the ground by a spring of its
 * own, along the last axis; or, on one rank, all of them stand on a plate that lies on these
 * springs and does not tilt, so that each feels the mean and all are coupled.
 *
 *   petsc: {springs_on: bottom, springs_stiffness: 1e5, springs_plate: true}    # N/m each
 */
#include "grid/search/directory.h"
#include "solve/forces/nodal_force.h"

typedef struct {
  PetscInt n, *node;
  PetscReal stiffness;
  PetscBool plate;
  PetscReal *stretch; /* n_nodes: at the start of the step, m */
} Springs;

static PetscErrorCode Create(const NodalScene *scene, Diag *diag, void **data)
{
  char place[64];
  PetscBool asked;
  Springs *s;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsGetString(NULL, NULL, "-springs_on", place, sizeof place, &asked));
  if (!asked) PetscFunctionReturn(0);
  PetscCall(PetscNew(&s));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-springs_stiffness", &s->stiffness, NULL));
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-springs_plate", &s->plate, NULL));
  PetscCall(GridSelectNodes(scene->grid, &(Selector){.boundary = place}, &s->n, &s->node));
  PetscCall(PetscCalloc1(scene->grid->n_nodes, &s->stretch));
  if (diag && !grid_find_set(scene->grid, place)) diag_error(diag, "petsc", "no boundary '%s' for springs", place);
  *data = s;
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(void **data)
{
  Springs *s = *data;

  PetscFunctionBeginUser;
  PetscCall(PetscFree(s->node));
  PetscCall(PetscFree(s->stretch));
  PetscCall(PetscFree(*data));
  PetscFunctionReturn(0);
}

static void hold(const void *data, const NodalScene *scene, unsigned char *held)
{
  const Springs *s = data;
  for (PetscInt k = 0; k < s->n; ++k) held[(s->node[k] + 1) * scene->grid->dim - 1] = 1;
}

static PetscErrorCode Couple(const void *data, const NodalScene *scene, NodeGroups *groups)
{
  const Springs *s = data;

  (void)scene;
  PetscFunctionBeginUser;
  if (s->plate) PetscCall(NodeGroupsAdd(groups, s->n, s->node));
  PetscFunctionReturn(0);
}

/* What the spring of node k feels, and which others feel with it. */
static PetscReal stretch_of(const Springs *s, const NodalScene *scene, PetscInt k, PetscInt *first, PetscInt *last)
{
  PetscReal sum = 0;
  *first = s->plate ? 0 : k;
  *last = s->plate ? s->n - 1 : k;
  for (PetscInt i = *first; i <= *last; ++i)
    sum += s->stretch[s->node[i]] + scene->du[(s->node[i] + 1) * scene->grid->dim - 1];
  return sum / (PetscReal)(*last - *first + 1);
}

static PetscErrorCode Assemble(void *data, const NodalScene *scene, const NodalOutput *out)
{
  const Springs *s = data;
  const PetscInt dim = scene->grid->dim;
  PetscInt first, last;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < s->n; ++k) {
    const PetscInt node = s->node[k], i = (node + 1) * dim - 1;
    if (node >= scene->grid->n_owned) continue;
    out->force[i] += s->stiffness * stretch_of(s, scene, k, &first, &last);
    for (PetscInt j = first; j <= last && out->system; ++j)
      nodal_add_tangent(out, dim, system_pair(out->system, node, s->node[j]), i, (s->node[j] + 1) * dim - 1,
                        s->stiffness / (PetscReal)(last - first + 1));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Commit(void *data, const NodalScene *scene)
{
  const Springs *s = data;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < s->n; ++k) s->stretch[s->node[k]] += scene->du[(s->node[k] + 1) * scene->grid->dim - 1];
  PetscFunctionReturn(0);
}

static PetscErrorCode ToTables(const void *data, const NodalScene *scene, Tables *tables)
{
  const NodalField field = {"stretch", "m", 1, ((const Springs *)data)->stretch};

  PetscFunctionBeginUser;
  PetscCall(NodesToTable(scene->grid, NULL, 1, &field, "springs", tables));
  PetscFunctionReturn(0);
}

static PetscErrorCode FromTables(void *data, const NodalScene *scene, const Tables *tables, char reason[256])
{
  const NodalField field = {"stretch", "m", 1, ((Springs *)data)->stretch};

  PetscFunctionBeginUser;
  PetscCall(NodesFromTable(scene->grid, PETSC_TRUE, 1, &field, tables_find(tables, "springs"), reason));
  PetscFunctionReturn(0);
}

const NodalForce nodal_force_springs = {
  .name = "springs",
  .help = "a spring to the ground at each node of a boundary",
  .create = Create,
  .destroy = Destroy,
  .hold = hold,
  .couple = Couple,
  .assemble = Assemble,
  .commit = Commit,
  .to_tables = ToTables,
  .from_tables = FromTables,
};
