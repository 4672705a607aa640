/* A bed of springs: each node of one boundary of the mesh stands on the ground by a spring of its own, along the last axis.
 *
 *   petsc: {springs_on: bottom, springs_stiffness: 1e5}    # N/m each
 */
#include "grid/directory.h"
#include "solve/forces/nodal_force.h"

typedef struct {
  PetscInt n, *node;
  PetscReal stiffness;
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

static PetscErrorCode Assemble(void *data, const NodalScene *scene, const NodalOutput *out)
{
  const Springs *s = data;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < s->n; ++k) {
    const PetscInt node = s->node[k], i = (node + 1) * scene->grid->dim - 1;
    if (node >= scene->grid->n_owned) continue;
    out->force[i] += s->stiffness * (s->stretch[node] + scene->du[i]);
    if (out->system) nodal_add_tangent(out, scene->grid->dim, system_pair(out->system, node, node), i, i, s->stiffness);
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
  .assemble = Assemble,
  .commit = Commit,
  .to_tables = ToTables,
  .from_tables = FromTables,
};
