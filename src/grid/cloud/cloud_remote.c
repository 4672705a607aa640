/* Which nodes of other ranks a rank may need: everybody says in which box its points look for
 * nodes, and gets those inside. */
#include "base/exchange.h"
#include "grid/cloud/cloud.h"

/* A node in flight. */
typedef struct {
  PetscReal x[3], start[3];
  PetscInt64 index, field;
} Flight;

static PetscBool in_box(PetscInt dim, const PetscReal *x, const PetscReal box[6])
{
  for (PetscInt d = 0; d < dim; ++d)
    if (x[d] < box[d] || x[d] > box[3 + d]) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Calls per_rank[r] += 1 for each own node in the box of r, or writes the nodes in the order of the
 * messages. */
static void list_nodes(const Grid *grid, PetscMPIInt rank, PetscMPIInt size, PetscReal (*box)[6], PetscInt *per_rank,
                       const PetscMPIInt *slot, PetscInt *next, Flight *out)
{
  for (PetscInt i = 0; i < grid->n_owned; ++i) {
    if (cloud_is_twin(grid, i)) continue;
    for (PetscMPIInt r = 0; r < size; ++r) {
      if (r == rank || !in_box(grid->dim, grid->x + i * grid->dim, box[r])) continue;
      if (!out) {
        ++per_rank[r];
        continue;
      }
      Flight *c = &out[next[slot[r]]++];
      *c = (Flight){.index = i, .field = cloud_motion(grid, i)};
      for (PetscInt d = 0; d < grid->dim; ++d) {
        c->x[d] = grid->x[i * grid->dim + d];
        c->start[d] = cloud_start(grid, i, d);
      }
    }
  }
}

static PetscErrorCode Receive(const Grid *grid, const Exchange *e, const Flight *in, RemoteNodes *remote)
{
  PetscFunctionBeginUser;
  const PetscInt n = remote->n = e->from_start[e->n_from];
  PetscCall(PetscMalloc5(n, &remote->rank, n, &remote->index, n, &remote->field, n * grid->dim, &remote->x,
                         n * grid->dim, &remote->start));
  for (PetscMPIInt m = 0; m < e->n_from; ++m)
    for (PetscInt k = e->from_start[m]; k < e->from_start[m + 1]; ++k) {
      remote->rank[k] = e->from[m];
      remote->index[k] = (PetscInt)in[k].index;
      remote->field[k] = (PetscInt)in[k].field;
      for (PetscInt d = 0; d < grid->dim; ++d) {
        remote->x[k * grid->dim + d] = in[k].x[d];
        remote->start[k * grid->dim + d] = in[k].start[d];
      }
    }
  PetscFunctionReturn(0);
}

PetscErrorCode GridCloudRemote(const Grid *grid, const PetscReal box[6], RemoteNodes *remote)
{
  PetscMPIInt rank, size, *slot;
  PetscReal(*boxes)[6];
  PetscInt *per_rank, *next;
  Flight *out, *in;
  Exchange e;

  PetscFunctionBeginUser;
  *remote = (RemoteNodes){0};
  PetscCallMPI(MPI_Comm_rank(grid->comm, &rank));
  PetscCallMPI(MPI_Comm_size(grid->comm, &size));
  if (size == 1) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(size, &boxes));
  PetscCallMPI(MPI_Allgather(box, 6, MPIU_REAL, boxes, 6, MPIU_REAL, grid->comm));
  PetscCall(PetscMalloc1(size, &slot));
  PetscCall(PetscCalloc1(size, &per_rank));
  list_nodes(grid, rank, size, boxes, per_rank, NULL, NULL, NULL);
  PetscCall(ExchangeCreate(grid->comm, size, per_rank, slot, &e));
  PetscCall(PetscMalloc3(e.to_start[e.n_to], &out, e.from_start[e.n_from], &in, e.n_to + 1, &next));
  PetscCall(PetscArraycpy(next, e.to_start, e.n_to + 1));
  if (e.n_to) list_nodes(grid, rank, size, boxes, per_rank, slot, next, out);
  PetscCall(ExchangeItems(&e, sizeof *out, PETSC_FALSE, (char *)out, (char *)in));
  PetscCall(Receive(grid, &e, in, remote));
  PetscCall(PetscFree3(out, in, next));
  PetscCall(ExchangeDestroy(&e));
  PetscCall(PetscFree(boxes));
  PetscCall(PetscFree(slot));
  PetscCall(PetscFree(per_rank));
  PetscFunctionReturn(0);
}

PetscErrorCode GridCloudRemoteDestroy(RemoteNodes *remote)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree5(remote->rank, remote->index, remote->field, remote->x, remote->start));
  remote->n = 0;
  PetscFunctionReturn(0);
}

/* Both lists ascend. */
void cloud_find_ghosts(const Grid *grid, const RemoteNodes *remote, PetscInt *local)
{
  const GridCloud *c = grid->cloud;
  const PetscInt n_ghosts = grid->n_nodes - grid->n_owned;
  for (PetscInt k = 0, g = 0; k < remote->n; ++k) {
    const PetscMPIInt rank = remote->rank[k];
    const PetscInt index = remote->index[k];
    while (g < n_ghosts && (c->ghost_rank[g] < rank || (c->ghost_rank[g] == rank && c->ghost_index[g] < index))) ++g;
    const PetscBool found = g < n_ghosts && c->ghost_rank[g] == rank && c->ghost_index[g] == index;
    local[k] = found ? grid->n_owned + g : -1;
  }
}
