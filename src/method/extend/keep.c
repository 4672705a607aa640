#include "method/extend/keep.h"
#include "method/extend/row.h"

#define ALL -1

Seen seen_by_points(const Discretisation *s) { return (Seen){s->points, s->support, s->grid->dim, NULL}; }
Seen seen_by_carriers(const Discretisation *s)
{
  return (Seen){s->loads->carriers, s->extension->carried, s->loads->slopes, s->loads};
}

PetscBool changes_row(const Discretisation *s, const Seen *seen, PetscInt p)
{
  const Support *w = seen->support;
  if (seen->loads && !carrier_pushes(seen->loads, p)) return PETSC_FALSE;
  for (PetscInt I = w->node_start[p]; I < w->node_start[p + 1]; ++I)
    if (s->extension->ways[w->node[I]] > 0) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* As row_add_way has it: one step on the way, and one more along each of its axes. */
static void add_extent(const GridBox *box, const PetscInt at[LATTICE], const PetscInt step[3], Extent *r)
{
  const PetscInt base[LATTICE] = {at[0] + step[0], at[1] + step[1], at[2] + step[2], at[3]};
  r->unknown |= node_beside(box, at, step) < 0;
  for (PetscInt d = 0; d < box->dim; ++d) {
    PetscInt along[3] = {0, 0, 0};
    along[d] = step[d];
    if (step[d]) r->unknown |= node_beside(box, base, along) < 0;
    r->low[d] = (signed char)PetscMin(r->low[d], PetscMin(step[d], 2 * step[d]));
    r->high[d] = (signed char)PetscMax(r->high[d], PetscMax(step[d], 2 * step[d]));
  }
}

static Extent extent_of(const GridBox *box, const PetscInt at[LATTICE], PetscInt ways)
{
  Extent r = {.low = {2, 2, 2}, .high = {-2, -2, -2}};
  PetscInt step[3];
  for (PetscInt way = 0; way < WAYS; ++way) {
    if (!(ways >> way & 1)) continue;
    way_of(way, step);
    add_extent(box, at, step, &r);
  }
  return r;
}

static PetscErrorCode FindExtents(const Discretisation *s)
{
  Extension *e = s->extension;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(e->extent, s->grid->n_nodes));
  for (PetscInt i = 0; i < s->grid->n_nodes; ++i)
    if (e->ways[i] > 0) e->extent[i] = extent_of(s->grid->box, e->place[i], (PetscInt)e->ways[i]);
  PetscFunctionReturn(0);
}

/* Would all nodes of point p be known to this rank and stand as near together as the system's pattern has them, if
 * there were no followers, or only this one and the others were not there? */
static PetscBool sees_near(const Discretisation *s, const Seen *seen, PetscInt p, PetscInt only)
{
  const Extension *e = s->extension;
  const Support *w = seen->support;
  PetscInt cell[LATTICE], low[3], high[3];
  box_voxel_of(s->grid, seen->points->cell[p], cell);
  for (int d = 0; d < 3; ++d) low[d] = cell[d] + 2, high[d] = cell[d] - 1;
  for (PetscInt I = w->node_start[p]; I < w->node_start[p + 1]; ++I) {
    const PetscInt node = w->node[I];
    if (e->ways[node] > 0 && only != ALL && only != node) continue;
    const Extent *r = e->extent + node;
    if (r->unknown) return PETSC_FALSE;
    for (PetscInt d = 0; d < s->grid->dim; ++d) {
      low[d] = PetscMin(low[d], e->place[node][d] + r->low[d]);
      high[d] = PetscMax(high[d], e->place[node][d] + r->high[d]);
    }
  }
  for (PetscInt d = 0; d < s->grid->dim; ++d)
    if (low[d] < cell[d] - 1 || high[d] > cell[d] + 2 || high[d] - low[d] > s->basis->across) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Marks the followers that point p cannot do without: each whose leaders alone are too far away, all if none is. */
static void mark_seen(const Discretisation *s, const Seen *seen, PetscInt p, PetscReal *needed)
{
  const Support *w = seen->support;
  PetscBool found = PETSC_FALSE;
  for (PetscInt I = w->node_start[p]; I < w->node_start[p + 1]; ++I) {
    if (s->extension->ways[w->node[I]] == 0 || sees_near(s, seen, p, w->node[I])) continue;
    needed[w->node[I]] = 1;
    found = PETSC_TRUE;
  }
  for (PetscInt I = w->node_start[p]; I < w->node_start[p + 1] && !found; ++I) needed[w->node[I]] = 1;
}

/* Marks nodes that must stay: those of points that would see others too far away. */
static void mark_lookers(const Discretisation *s, const Seen *seen, PetscReal *needed)
{
  for (PetscInt p = 0; p < seen->support->n_groups; ++p)
    if (changes_row(s, seen, p) && !sees_near(s, seen, p, ALL)) mark_seen(s, seen, p, needed);
}

/* And those that loads act on by functions of their cells. */
static void mark_loaded(const Discretisation *s, PetscReal *needed)
{
  const Points *carriers = s->loads->carriers;
  const PetscInt nn = s->grid->nodes_per_cell;
  for (PetscInt p = 0; p < carriers->n; ++p)
    for (PetscInt I = 0; carriers->cell[p] >= 0 && carrier_pushes(s->loads, p) && I < nn; ++I)
      needed[s->grid->cell_node[carriers->cell[p] * nn + I]] = 1;
}

static void mark_needed(const Discretisation *s, PetscReal *needed)
{
  const Seen points = seen_by_points(s), carriers = seen_by_carriers(s);
  mark_lookers(s, &points, needed);
  if (s->basis->carries) mark_lookers(s, &carriers, needed);
  else mark_loaded(s, needed);
}

/* *again: have any that were to follow been kept, so that points see others than was thought? */
static PetscErrorCode KeepNeeded(const Discretisation *s, PetscReal *needed, PetscBool *again)
{
  const Grid *grid = s->grid;
  PetscBool here = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(needed, grid->n_nodes));
  mark_needed(s, needed);
  PetscCall(GridSumToOwners(grid, 1, needed));
  PetscCall(GridToGhosts(grid, 1, needed));
  for (PetscInt i = 0; i < grid->n_nodes; ++i) {
    if (!(needed[i] > 0) || s->extension->ways[i] == 0) continue;
    s->extension->ways[i] = 0;
    s->extension->extent[i] = (Extent){.unknown = 0};
    here = PETSC_TRUE;
  }
  PetscCallMPI(MPI_Allreduce(&here, again, 1, MPIU_BOOL, MPI_LOR, grid->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode ExtensionKeep(const Discretisation *s)
{
  PetscReal *needed;
  PetscBool again = PETSC_TRUE;

  PetscFunctionBeginUser;
  PetscCall(FindExtents(s));
  PetscCall(PetscMalloc1(s->grid->n_nodes, &needed));
  while (again) PetscCall(KeepNeeded(s, needed, &again));
  PetscCall(PetscFree(needed));
  PetscFunctionReturn(0);
}
