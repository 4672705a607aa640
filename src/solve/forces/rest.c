/* What holds nodes that points hardly reach (formulation/holding.h) acts against the increments of one
 * step and is forgotten with it, so that a body in balance would be out of balance in the next step. While
 * everything rests these forces are remembered on the nodes: they balance themselves, in sum and in torque, as
 * long as all of them stay where they were (docs/theory.md, "What rests stays at rest with smooth functions"). */
#include "formulation/holding.h"
#include "grid/search/directory.h"
#include "solve/forces/nodal_force.h"
#include "support/basis.h"

/* Motion of a point in a step, in cells, or change of its F, up to which everything rests. */
#define AT_REST 1e-3

typedef struct {
  PetscReal *force; /* n_nodes x dim, N, of owned nodes */
} Rest;

static PetscErrorCode Create(const NodalScene *scene, Diag *diag, void **data)
{
  const AnalysisType type = scene->c->analysis.type;
  Rest *r;

  (void)diag;
  PetscFunctionBeginUser;
  if (!basis_find(scene->c->basis.kind)->domains) PetscFunctionReturn(0);
  if (type != ANALYSIS_STATIC && type != ANALYSIS_DYNAMIC) PetscFunctionReturn(0);
  PetscCall(PetscNew(&r));
  PetscCall(PetscCalloc1(scene->grid->n_nodes * scene->grid->dim, &r->force));
  *data = r;
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(void **data)
{
  Rest *r = *data;

  PetscFunctionBeginUser;
  PetscCall(PetscFree(r->force));
  PetscCall(PetscFree(*data));
  PetscFunctionReturn(0);
}

/* The material has left a node that a force was remembered on: the rest would be a force on the body. */
static PetscErrorCode Begin(void *data, const NodalScene *scene)
{
  const Rest *r = data;
  const PetscInt dim = scene->grid->dim, n = scene->grid->n_owned;
  PetscInt left = 0, any;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n * dim; ++i) left |= r->force[i] != 0 && !scene->touched[i / dim];
  PetscCall(MPIU_Allreduce(&left, &any, 1, MPIU_INT, MPI_MAX, scene->grid->comm));
  if (any) PetscCall(PetscArrayzero(r->force, n * dim));
  PetscFunctionReturn(0);
}

static PetscErrorCode Assemble(void *data, const NodalScene *scene, const NodalOutput *out)
{
  const Rest *r = data;
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < scene->grid->n_owned * scene->grid->dim; ++i) out->force[i] += r->force[i];
  PetscFunctionReturn(0);
}

/* The farthest that the material at a point has moved, in cells, or the most that its F has changed by. */
static PetscReal motion_of(const NodalScene *scene, PetscInt p)
{
  const Support *w = scene->support;
  const PetscInt dim = scene->grid->dim, nn = support_nodes(w, p), *node = w->node + w->node_start[p];
  const PetscReal *N = support_N(w, p, p), *dN = support_dN(w, p, p, dim);
  PetscReal most = 0;
  for (PetscInt d = 0; d < dim; ++d) {
    PetscReal sum[4] = {0};
    for (PetscInt I = 0; I < nn; ++I) {
      const PetscReal du = scene->du[node[I] * dim + d];
      sum[3] += N[I] * du / scene->grid->smallest;
      for (PetscInt j = 0; j < dim; ++j) sum[j] += dN[I * dim + j] * du;
    }
    for (int j = 0; j < 4; ++j) most = PetscMax(most, PetscAbsReal(sum[j]));
  }
  return most;
}

/* The forces of this step's increments. */
static PetscErrorCode Hold(const NodalScene *scene, PetscReal *force)
{
  const WeakFormInput in = {
    .support = scene->support, .soft = scene->soft, .du = scene->du, .x = scene->grid->x, .lattice = PETSC_TRUE};

  PetscFunctionBeginUser;
  holding_forces(&in, scene->grid->dim, force);
  PetscCall(GridSumToOwners(scene->grid, scene->grid->dim, force));
  PetscFunctionReturn(0);
}

static PetscErrorCode Commit(void *data, const NodalScene *scene)
{
  const Rest *r = data;
  const PetscInt dofs = scene->grid->n_nodes * scene->grid->dim;
  PetscReal most = 0, of_all, *force;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < scene->support->n_groups && most <= AT_REST; ++p) most = PetscMax(most, motion_of(scene, p));
  PetscCall(MPIU_Allreduce(&most, &of_all, 1, MPIU_REAL, MPIU_MAX, scene->grid->comm));
  if (of_all > AT_REST) {
    PetscCall(PetscArrayzero(r->force, dofs));
    PetscFunctionReturn(0);
  }
  PetscCall(PetscCalloc1(dofs, &force));
  PetscCall(Hold(scene, force));
  for (PetscInt i = 0; i < scene->grid->n_owned * scene->grid->dim; ++i) r->force[i] += force[i];
  PetscCall(PetscFree(force));
  PetscFunctionReturn(0);
}

static PetscErrorCode ToTables(const void *data, const NodalScene *scene, Tables *tables)
{
  const Rest *r = data;
  const PetscInt dim = scene->grid->dim;
  const NodalField field = {"force", "N", dim, r->force};
  unsigned char *take;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(scene->grid->n_nodes, &take));
  for (PetscInt i = 0; i < scene->grid->n_owned * dim; ++i) take[i / dim] |= r->force[i] != 0;
  PetscCall(NodesToTable(scene->grid, take, 1, &field, "rest", tables));
  PetscCall(PetscFree(take));
  PetscFunctionReturn(0);
}

static PetscErrorCode FromTables(void *data, const NodalScene *scene, const Tables *tables, char reason[256])
{
  const Rest *r = data;
  const NodalField field = {"force", "N", scene->grid->dim, r->force};
  const Table *table = tables_find(tables, "rest");

  PetscFunctionBeginUser;
  if (table) PetscCall(NodesFromTable(scene->grid, PETSC_FALSE, 1, &field, table, reason));
  PetscFunctionReturn(0);
}

const NodalForce nodal_force_rest = {
  .name = "rest",
  .help = "what held hardly reached nodes, while everything rests",
  .dead = PETSC_TRUE,
  .apart = PETSC_TRUE,
  .create = Create,
  .destroy = Destroy,
  .begin = Begin,
  .assemble = Assemble,
  .commit = Commit,
  .to_tables = ToTables,
  .from_tables = FromTables,
};
