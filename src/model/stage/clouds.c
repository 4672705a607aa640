/* What a cloud cannot do from one stage to the next: its nodes are found once, where the cells were. */
#include "grid/cloud/cloud.h"
#include "model/stage/stage_private.h"

/* A number of a place, to be summed in any order, over any ranks: the numbers of nodes depend on these. */
static uint64_t sign_of(const PetscReal *x, PetscInt dim)
{
  uint64_t sign = 1, bits;
  for (PetscInt d = 0; d < dim; ++d) {
    const PetscReal place = x[d] + 0.0; /* -0 is 0 */
    memcpy(&bits, &place, sizeof bits);
    sign = (sign ^ bits) * 0x9e3779b97f4a7c15u;
    sign ^= sign >> 29;
  }
  return sign;
}

/* The sum over the nodes of each entry of the boundary. */
static void add_signs(PetscInt n, PetscInt entries, PetscInt dim, const PetscReal *x0, const PetscReal *member,
                      uint64_t *sign)
{
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt k = 0; k < entries; ++k)
      if (member[i * entries + k] > 0) sign[k] += sign_of(x0 + i * dim, dim);
}

/* *same: are the nodes of every entry of the boundary those that the tables know? */
static PetscErrorCode SameNodes(const Model *m, const Tables *tables, PetscBool *same, char reason[256])
{
  const PetscInt entries = m->c->n_boundary + (m->c->kinematics->hoop ? 1 : 0), dim = m->dim;
  const Table *nodes = tables_find(tables, "nodes");
  char others[256] = "";
  const PetscReal *x0 = table_data(nodes, "position_at_start", COLUMN_REAL, dim, reason);
  const PetscReal *member = entries ? table_data(nodes, "member", COLUMN_REAL, entries, others) : NULL;
  uint64_t *sign;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(2 * entries, &sign));
  if (x0 && member) add_signs((PetscInt)nodes->rows, entries, dim, x0, member, sign);
  add_signs(m->grid->n_owned, entries, dim, m->grid->cloud->x0, m->boundary->member, sign + entries);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sign, (PetscMPIInt)(2 * entries), MPI_UINT64_T, MPI_SUM, m->comm));
  *same = others[0] ? PETSC_FALSE : PETSC_TRUE;
  for (PetscInt k = 0; k < entries; ++k)
    if (sign[k] != sign[entries + k]) *same = PETSC_FALSE;
  PetscCall(PetscFree(sign));
  PetscFunctionReturn(0);
}

static PetscInt body_of(const Case *c, const char *name)
{
  for (PetscInt b = 0; b < c->n_bodies; ++b)
    if (!strcmp(c->bodies[b].name, name) && !c->bodies[b].absent) return b;
  return -1;
}

static void check_bodies(const Case *c, const Case *from, Diag *diag)
{
  for (int side = 0; side < 2; ++side) {
    const Case *here = side ? c : from, *there = side ? from : c;
    for (PetscInt b = 0; b < here->n_bodies; ++b) {
      const char *name = here->bodies[b].name;
      if (here->bodies[b].absent || body_of(there, name) >= 0) continue;
      diag_error(diag, "bodies", "'%s' %s: bodies of method gmm neither come nor go, since its nodes are theirs", name,
                 side ? "was not there before" : "is gone");
      diag_hint(diag, "mpm and fem take bodies away and place them");
      return;
    }
  }
}

/* A follower is born in a cell. */
static void check_tracers(const Case *c, const Case *from, Diag *diag)
{
  char path[512];
  for (PetscInt k = 0; k < c->n_measures; ++k) {
    if (!c->measures[k].has_tracer || measure_before(c, k, from) >= 0) continue;
    snprintf(path, sizeof path, "measures.%s.of.tracer", c->measures[k].name);
    diag_error(diag, path, "tracers of method gmm begin where the body does, in the first stage");
    diag_hint(diag, c->stage ? "name the measure at the top of the file"
                             : "a run that begins with the state of another one has none: make it a stage of that run, "
                               "or leave the measure out");
  }
}

static PetscInt entries_there(const Case *c)
{
  PetscInt n = 0;
  for (PetscInt k = 0; k < c->n_boundary; ++k) n += !c->boundary[k].absent;
  return n;
}

static void tell_nodes(Diag *diag)
{
  diag_error(diag, "boundary", "nodes of method gmm are held or free for good, and these are others than before");
  diag_hint(diag, "motions, and what of them is fixed, may change; mpm and fem let nodes come and go");
}

void clouds_check(const Case *c, const Case *from, Diag *diag)
{
  check_bodies(c, from, diag);
  check_tracers(c, from, diag);
  if (entries_there(c) != entries_there(from)) tell_nodes(diag);
}

PetscErrorCode CheckCloud(const Model *m, const Tables *tables, Diag *diag, char reason[256])
{
  PetscBool same;

  PetscFunctionBeginUser;
  if (!tables_find(tables, "cloud")) PetscFunctionReturn(0); /* of another method, which is told elsewhere */
  PetscCall(SameNodes(m, tables, &same, reason));
  if (!same) tell_nodes(diag);
  PetscFunctionReturn(0);
}
