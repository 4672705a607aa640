#include "method/nodal_fields.h"
#include "grid/cloud/cloud.h"
#include "grid/search/directory.h"

/* Of which table a field is in checkpoints. Fields of no table are made anew in every step. */
typedef enum { KEPT_NOWHERE, KEPT_MOTION, KEPT_BOUNDARY, KEPT_INCREMENTS, KEPT_N } Kept;

static const char *const table_names[KEPT_N] = {
  [KEPT_MOTION] = "nodes", [KEPT_BOUNDARY] = "boundary", [KEPT_INCREMENTS] = "increments"};

/* Clouds let the motion of their nodes and forces of the boundary follow. */
static PetscBool follows(Kept kept) { return kept == KEPT_MOTION || kept == KEPT_BOUNDARY; }

typedef struct {
  size_t offset;
  Kept kept;
  const char *name, *unit;
  PetscBool scalar, mixed; /* one component; only where the pressure is an unknown */
} FieldKind;

#define FIELD(member, ...)                     \
  {                                            \
    offsetof(NodalFields, member), __VA_ARGS__ \
  }
#define SCRATCH(member) FIELD(member, KEPT_NOWHERE, NULL, NULL, PETSC_FALSE, PETSC_FALSE)

static const FieldKind kinds[] = {
  FIELD(mass, KEPT_NOWHERE, NULL, NULL, PETSC_TRUE, PETSC_FALSE),
  FIELD(v, KEPT_MOTION, "velocity", "m/s", PETSC_FALSE, PETSC_FALSE),
  FIELD(a, KEPT_MOTION, "acceleration", "m/s2", PETSC_FALSE, PETSC_FALSE),
  SCRATCH(v_points),
  SCRATCH(a_points),
  SCRATCH(v_mean),
  SCRATCH(impulse),
  SCRATCH(lost_force),
  SCRATCH(v_start),
  SCRATCH(a_start),
  SCRATCH(echo_start),
  SCRATCH(v_first),
  SCRATCH(a_first),
  SCRATCH(v1),
  SCRATCH(a1),
  SCRATCH(du),
  FIELD(previous, KEPT_INCREMENTS, "increment", "m", PETSC_FALSE, PETSC_FALSE),
  SCRATCH(prescribed),
  SCRATCH(history),
  SCRATCH(force),
  SCRATCH(external),
  FIELD(reaction, KEPT_BOUNDARY, "reaction", "N", PETSC_FALSE, PETSC_FALSE),
  FIELD(held, KEPT_BOUNDARY, "held", "N", PETSC_FALSE, PETSC_FALSE),
  FIELD(rate, KEPT_BOUNDARY, "rate", "N", PETSC_FALSE, PETSC_FALSE),
  FIELD(echo, KEPT_MOTION, "echo", "m/s2", PETSC_FALSE, PETSC_FALSE),
  FIELD(pressure, KEPT_MOTION, "pressure", "Pa", PETSC_TRUE, PETSC_TRUE),
  FIELD(scaled_pressure, KEPT_NOWHERE, NULL, NULL, PETSC_TRUE, PETSC_TRUE),
  FIELD(volume, KEPT_NOWHERE, NULL, NULL, PETSC_TRUE, PETSC_TRUE),
};
#define KINDS PETSC_STATIC_ARRAY_LENGTH(kinds)

static PetscReal **values_of(NodalFields *nodes, const FieldKind *k)
{
  return (PetscReal **)(void *)((char *)nodes + k->offset);
}

static PetscInt components_of(const NodalFields *nodes, const FieldKind *k) { return k->scalar ? 1 : nodes->grid->dim; }

static PetscErrorCode FlagsCreate(NodalFields *nodes)
{
  const PetscInt n = nodes->grid->n_nodes, dofs = n * nodes->grid->dim;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n, &nodes->touched));
  PetscCall(PetscCalloc1(n, &nodes->idle));
  PetscCall(PetscCalloc1(dofs, &nodes->dof));
  PetscCall(PetscCalloc1(dofs, &nodes->fixed));
  nodes->layouts = nodes->grid->cloud ? nodes->grid->cloud->layouts : 0;
  PetscFunctionReturn(0);
}

static PetscErrorCode FlagsDestroy(NodalFields *nodes)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(nodes->touched));
  PetscCall(PetscFree(nodes->idle));
  PetscCall(PetscFree(nodes->dof));
  PetscCall(PetscFree(nodes->fixed));
  PetscFunctionReturn(0);
}

PetscErrorCode NodalFieldsCreate(Grid *grid, PetscBool pressure, NodalFields **nodes)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(nodes));
  (*nodes)->grid = grid;
  PetscCall(FlagsCreate(*nodes));
  for (const FieldKind *k = kinds; k < kinds + KINDS; ++k) {
    PetscReal **values = values_of(*nodes, k);
    const PetscInt components = components_of(*nodes, k);
    if (k->mixed && !pressure) continue;
    /* of a rank without nodes, too: NULL is what is no unknown, and no rank may take it for that */
    PetscCall(PetscCalloc1(PetscMax(1, grid->n_nodes * components), values));
    if (!grid->cloud) continue;
    const char *name = follows(k->kept) ? k->name : NULL;
    PetscCall(GridCloudFollow(grid, (CloudField){values, components, name, k->unit, PETSC_FALSE}));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode NodalFieldsDestroy(NodalFields **nodes)
{
  PetscFunctionBeginUser;
  if (!*nodes) PetscFunctionReturn(0);
  PetscCall(FlagsDestroy(*nodes));
  for (const FieldKind *k = kinds; k < kinds + KINDS; ++k) PetscCall(PetscFree(*values_of(*nodes, k)));
  PetscCall(PetscFree(*nodes));
  PetscFunctionReturn(0);
}

PetscErrorCode NodalFlagsFollow(NodalFields *nodes)
{
  PetscFunctionBeginUser;
  if (nodes->layouts == nodes->grid->cloud->layouts) PetscFunctionReturn(0);
  PetscCall(FlagsDestroy(nodes));
  PetscCall(FlagsCreate(nodes));
  PetscFunctionReturn(0);
}

/* The fields of one table; positions are the grid's. */
static PetscInt list_fields(NodalFields *nodes, Kept kept, NodalField list[KINDS])
{
  PetscInt n = 0;
  if (kept == KEPT_MOTION) list[n++] = (NodalField){"position", "m", nodes->grid->dim, nodes->grid->x};
  for (const FieldKind *k = kinds; k < kinds + KINDS; ++k) {
    PetscReal *values = *values_of(nodes, k);
    if (k->kept == kept && values) list[n++] = (NodalField){k->name, k->unit, components_of(nodes, k), values};
  }
  return n;
}

/* Of nodes where one of them is not 0; motion is that of all nodes. */
static PetscErrorCode ToTable(NodalFields *nodes, Kept kept, Tables *tables)
{
  NodalField list[KINDS];
  const PetscInt n = list_fields(nodes, kept, list), n_nodes = nodes->grid->n_nodes;
  unsigned char *take;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n_nodes, &take));
  for (PetscInt f = 0; f < n; ++f)
    for (PetscInt i = 0; i < n_nodes * list[f].components; ++i) take[i / list[f].components] |= list[f].values[i] != 0;
  PetscCall(NodesToTable(nodes->grid, kept == KEPT_MOTION ? NULL : take, n, list, table_names[kept], tables));
  PetscCall(PetscFree(take));
  PetscFunctionReturn(0);
}

PetscErrorCode NodalFieldsToTables(NodalFields *nodes, PetscBool move, PetscBool increments, Tables *tables)
{
  PetscFunctionBeginUser;
  if (move) PetscCall(ToTable(nodes, KEPT_MOTION, tables));
  if (increments) PetscCall(ToTable(nodes, KEPT_INCREMENTS, tables));
  PetscCall(ToTable(nodes, KEPT_BOUNDARY, tables));
  PetscFunctionReturn(0);
}

PetscErrorCode NodalFieldsFromTables(NodalFields *nodes, PetscBool move, const Tables *tables, char reason[256])
{
  const Kept order[] = {KEPT_MOTION, KEPT_INCREMENTS, KEPT_BOUNDARY};
  NodalField list[KINDS];

  PetscFunctionBeginUser;
  for (int k = !move; k < 3 && !reason[0]; ++k) {
    const PetscInt n = list_fields(nodes, order[k], list);
    const Table *table = tables_find(tables, table_names[order[k]]);
    /* nobody asked for them, or older programs: the next step starts from inertia or rest */
    if (!table && order[k] == KEPT_INCREMENTS) continue;
    PetscCall(NodesFromTable(nodes->grid, order[k] == KEPT_MOTION, n, list, table, reason));
  }
  PetscFunctionReturn(0);
}
