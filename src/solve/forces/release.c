#include "solve/forces/release.h"
#include "grid/cloud/cloud.h"
#include "grid/search/directory.h"

typedef struct {
  PetscReal *force;
} Release;

PetscReal release_share(const Case *c, PetscReal t)
{
  return c->release > 0 ? PetscMax(0, 1 - (case_time(c, t) - c->start) / c->release) : 0;
}

static PetscErrorCode Create(const NodalScene *scene, Diag *diag, void **data)
{
  Release *r;

  (void)diag;
  PetscFunctionBeginUser;
  if (!case_goes_on(scene->c) || scene->c->release <= 0) PetscFunctionReturn(0);
  const PetscInt dim = scene->grid->dim;
  PetscCall(PetscNew(&r));
  PetscCall(PetscCalloc1(scene->grid->n_nodes * dim + 1, &r->force)); /* never NULL: ranks without nodes take part */
  if (scene->grid->cloud)
    PetscCall(GridCloudFollow(scene->grid, (CloudField){&r->force, dim, "release", "N", PETSC_TRUE}));
  *data = r;
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(void **data)
{
  Release *r = *data;

  PetscFunctionBeginUser;
  PetscCall(PetscFree(r->force));
  PetscCall(PetscFree(*data));
  PetscFunctionReturn(0);
}

/* A node that the material has left behind needs no hold. */
static PetscErrorCode Assemble(void *data, const NodalScene *scene, const NodalOutput *out)
{
  const Release *r = data;
  const PetscInt dim = scene->grid->dim;
  const PetscReal share = release_share(scene->c, scene->t);

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < scene->grid->n_owned * dim && share > 0; ++i)
    if (scene->touched[i / dim]) out->force[i] -= share * r->force[i];
  PetscFunctionReturn(0);
}

static PetscErrorCode ToTables(const void *data, const NodalScene *scene, Tables *tables)
{
  const Release *r = data;
  const PetscInt dim = scene->grid->dim;
  const NodalField field = {"force", "N", dim, r->force};
  unsigned char *take;

  PetscFunctionBeginUser;
  if (scene->grid->cloud) PetscFunctionReturn(0); /* they follow its nodes */
  PetscCall(PetscCalloc1(scene->grid->n_nodes, &take));
  for (PetscInt i = 0; i < scene->grid->n_nodes * dim; ++i) take[i / dim] |= r->force[i] != 0;
  PetscCall(NodesToTable(scene->grid, take, 1, &field, "release", tables));
  PetscCall(PetscFree(take));
  PetscFunctionReturn(0);
}

static PetscErrorCode FromTables(void *data, const NodalScene *scene, const Tables *tables, char reason[256])
{
  const Release *r = data;
  const NodalField field = {"force", "N", scene->grid->dim, r->force};
  const Table *table = tables_find(tables, "release");

  PetscFunctionBeginUser;
  if (table && !scene->grid->cloud) PetscCall(NodesFromTable(scene->grid, PETSC_FALSE, 1, &field, table, reason));
  PetscFunctionReturn(0);
}

const NodalForce nodal_force_release = {
  .name = "release",
  .help = "what was out of balance when a stage began, fading",
  .dead = PETSC_TRUE,
  .create = Create,
  .destroy = Destroy,
  .assemble = Assemble,
  .to_tables = ToTables,
  .from_tables = FromTables,
};

PetscReal *release_forces(const NodalForces *forces)
{
  for (PetscInt k = 0; k < forces->n; ++k)
    if (forces->one[k].kind == &nodal_force_release) return ((Release *)forces->one[k].data)->force;
  return NULL;
}
