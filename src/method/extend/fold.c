/* Followers of nodes whose points go on to see them: what is summed there is handed to those that lead, and the motion
 * of these is handed back. N + E N of a point is linear in N, so sums over points are those of functions without
 * followers (extend.c) to round-off, and no walk over points knows of it: explicit dynamics, where a node has a lumped
 * mass and no row of a matrix. */
#include "method/extend/choose.h"
#include "method/extend/row.h"

#define KEEPS 0.7 /* of its mass: no less is left to a node that leads */
/* The same in implicit steps, where followers stay if it would be less: nobody follows in part there. With half of it
 * three cells of a full body would have no followers in space. */
#define LEAVES 0.25

/* The row of a follower on one of its ways whose first leader this rank owns: it alone knows all of a row. */
static PetscBool owned_row(const Discretisation *s, PetscInt follower, PetscInt way, Row *row)
{
  const Extension *e = s->extension;
  const PetscInt ways = (PetscInt)e->ways[follower], *here = e->place[follower];
  const PetscReal none = 0, share = 1 / (PetscReal)ways_many(ways);
  PetscInt step[3];
  row->n = 0;
  way_of(way, step);
  const PetscInt base = ways >> way & 1 ? node_beside(s->grid->box, here, step) : -1;
  if (base < 0 || base >= s->grid->n_owned) return PETSC_FALSE;
  return row_add_way(row, 0, s->grid->box, here, step, e->by_mass ? e->lean : NULL, share, 1, &none);
}

/* Numbers of the rows of all followers. back: from leaders to followers (`at`, in the order of the list), else the
 * other way. */
static void pass(const Discretisation *s, PetscBool back, PetscInt n, PetscReal *at, PetscReal *field)
{
  const Extension *e = s->extension;
  Row row;
  for (PetscInt k = 0; k < e->n_followers; ++k)
    for (PetscInt way = 0; way < WAYS; ++way) {
      if (!owned_row(s, e->follower[k], way, &row)) continue;
      for (PetscInt I = 0; I < row.n; ++I)
        for (PetscInt d = 0; d < n; ++d)
          if (back) at[k * n + d] += row.N[I] * field[row.node[I] * n + d];
          else field[row.node[I] * n + d] += row.N[I] * at[k * n + d];
    }
}

/* What ranks have added to the sums that owners know, and what these then know, on all copies. */
static PetscErrorCode Exchange(const Grid *grid, PetscInt n, PetscReal *field)
{
  PetscFunctionBeginUser;
  PetscCall(GridSumToOwners(grid, n, field));
  PetscCall(GridToGhosts(grid, n, field));
  PetscFunctionReturn(0);
}

static void clear_ghosts(const Grid *grid, PetscInt n, PetscReal *field)
{
  for (PetscInt i = grid->n_owned * n; i < grid->n_nodes * n; ++i) field[i] = 0;
}

PetscErrorCode ExtensionGive(const Discretisation *s, PetscInt n, PetscReal *sum)
{
  const Extension *e = s->extension;
  PetscReal *given;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(e->n_followers * n, &given));
  for (PetscInt k = 0; k < e->n_followers; ++k)
    for (PetscInt d = 0; d < n; ++d) {
      given[k * n + d] = sum[e->follower[k] * n + d];
      sum[e->follower[k] * n + d] = 0;
    }
  clear_ghosts(s->grid, n, sum);
  pass(s, PETSC_FALSE, n, given, sum);
  PetscCall(Exchange(s->grid, n, sum));
  PetscCall(PetscFree(given));
  PetscFunctionReturn(0);
}

PetscErrorCode ExtensionTake(const Discretisation *s, PetscInt n, PetscReal *field)
{
  const Extension *e = s->extension;
  PetscReal *taken;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(e->n_followers * n, &taken));
  pass(s, PETSC_TRUE, n, taken, field);
  clear_ghosts(s->grid, n, field);
  for (PetscInt k = 0; k < e->n_followers; ++k)
    for (PetscInt d = 0; d < n; ++d) field[e->follower[k] * n + d] = taken[k * n + d];
  PetscCall(Exchange(s->grid, n, field));
  PetscCall(PetscFree(taken));
  PetscFunctionReturn(0);
}

PetscErrorCode ExtensionList(const Discretisation *s, PetscInt n, const PetscInt *among, PetscBool *any)
{
  Extension *e = s->extension;

  PetscFunctionBeginUser;
  e->n_followers = 0;
  for (PetscInt k = 0; k < n; ++k) {
    const PetscInt node = among ? among[k] : k;
    if (e->ways[node] > 0) e->follower[e->n_followers++] = node;
  }
  const PetscBool here = (PetscBool)(e->n_followers > 0);
  PetscCallMPI(MPI_Allreduce(&here, any, 1, MPIU_BOOL, MPI_LOR, s->grid->comm));
  PetscFunctionReturn(0);
}

/* Of the nodes of a list, those that loads act on, and all around these once, marked in `leads` meanwhile. */
static PetscInt list_around(const Discretisation *s, Extension *e, PetscInt n, const PetscInt *active, PetscInt *beside)
{
  PetscInt step[3], found = 0;
  e->n_listed = 0;
  for (PetscInt k = 0; k < n; ++k) {
    if (!(e->loaded[active[k]] > 0)) continue;
    e->listed[e->n_listed++] = active[k];
    const PetscInt *at = e->place[active[k]];
    for (PetscInt way = 0; way < WAYS; ++way) {
      way_of(way, step);
      const PetscInt node = s->grid->dim == 3 || !step[2] ? node_beside(s->grid->box, at, step) : -1;
      if (node < 0 || e->leads[node] != 0) continue;
      e->leads[node] = -1;
      beside[found++] = node;
    }
  }
  for (PetscInt k = 0; k < found; ++k) e->leads[beside[k]] = 0;
  return found;
}

/* taken += what followers take from the nodes behind, of so much as each has of its own; on all copies. */
static PetscErrorCode SumTaken(const Discretisation *s, PetscInt stride, const PetscReal *mass, PetscReal *taken)
{
  const Extension *e = s->extension;
  Row row;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < e->n_followers; ++k)
    for (PetscInt way = 0; way < WAYS; ++way) {
      if (!owned_row(s, e->follower[k], way, &row)) continue;
      for (PetscInt I = 0; I < row.n; ++I)
        if (row.N[I] < 0) taken[row.node[I]] -= row.N[I] * mass[e->follower[k] * stride];
    }
  PetscCall(Exchange(s->grid, 1, taken));
  PetscFunctionReturn(0);
}

/* The linear way takes mass from the node behind. Where several followers take from one, as at a slanting or pointed
 * end, it could be left with none, and any force would throw it away: it gives them as much of its slope as leaves it
 * enough. */
static PetscErrorCode SpareLeaders(const Discretisation *s, PetscInt n, const PetscInt *active, PetscInt stride,
                                   const PetscReal *mass)
{
  Extension *e = s->extension;
  PetscReal *taken;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(s->grid->n_nodes, &taken));
  PetscCall(SumTaken(s, stride, mass, taken));
  for (PetscInt k = 0; k < n; ++k) {
    const PetscReal most = (1 - KEEPS) * mass[active[k] * stride];
    if (active[k] < s->grid->n_owned && taken[active[k]] > most) e->lean[active[k]] = most / taken[active[k]];
  }
  PetscCall(GridToGhosts(s->grid, 1, e->lean));
  PetscCall(PetscFree(taken));
  PetscFunctionReturn(0);
}

PetscErrorCode ExtensionSpare(const Discretisation *s)
{
  const PetscInt n = s->grid->n_nodes;
  Extension *e = s->extension;
  PetscReal *volume, *taken, *stays;
  PetscBool any;
  Row row;

  PetscFunctionBeginUser;
  PetscCall(ExtensionList(s, n, NULL, &any));
  if (!any) PetscFunctionReturn(0);
  PetscCall(PetscCalloc3(n, &volume, n, &taken, n, &stays));
  for (PetscInt i = 0; i < n; ++i) volume[i] = e->fill[i] * s->whole[i];
  PetscCall(SumTaken(s, 1, volume, taken));
  for (PetscInt k = 0; k < e->n_followers; ++k)
    for (PetscInt way = 0; way < WAYS; ++way) {
      if (!owned_row(s, e->follower[k], way, &row)) continue;
      for (PetscInt I = 0; I < row.n; ++I)
        if (row.N[I] < 0 && taken[row.node[I]] > (1 - LEAVES) * volume[row.node[I]]) stays[e->follower[k]] = 1;
    }
  PetscCall(Exchange(s->grid, 1, stays));
  for (PetscInt i = 0; i < n; ++i)
    if (stays[i] > 0 && !node_needs_lead(e, i)) e->ways[i] = 0;
  PetscCall(PetscFree3(volume, taken, stays));
  PetscFunctionReturn(0);
}

PetscErrorCode ExtensionByMass(Discretisation *s, PetscInt n, const PetscInt *active, PetscInt stride,
                               const PetscReal *mass, PetscBool *any)
{
  Extension *e = s->extension;

  PetscFunctionBeginUser;
  e->by_mass = PETSC_TRUE;
  PetscCall(PetscArrayzero(e->leads, s->grid->n_nodes));
  PetscCall(PetscArrayzero(e->ways, s->grid->n_nodes));
  PetscCall(PetscArrayzero(e->fill, s->grid->n_nodes));
  for (PetscInt i = 0; i < s->grid->n_nodes; ++i) e->lean[i] = 1;
  for (PetscInt k = 0; k < n; ++k) e->fill[active[k]] = mass[active[k] * stride] / s->whole[active[k]];
  PetscCall(ExtensionLoaded(s));
  const PetscInt leaders = list_around(s, e, n, active, e->beside);
  PetscCall(ChooseWaysAmong(s, e, leaders, e->beside, e->n_listed, e->listed));
  PetscCall(ExtensionList(s, e->n_listed, e->listed, any));
  if (*any) PetscCall(SpareLeaders(s, n, active, stride, mass));
  PetscFunctionReturn(0);
}
