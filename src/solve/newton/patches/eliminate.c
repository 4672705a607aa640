#include "solve/newton/patches/eliminate.h"

/* What stands out; the second number is for stiff matter that yields, where points all over a body open and close
 * (StepProblem.stiff): there all nodes may be chosen. */
static const PetscReal stands_out[] = {0.02, 0.01}; /* of the residual's norm */
static const PetscInt most_chosen[] = {64, 4096};   /* nodes that stand out, on a rank, */
static const PetscReal few[] = {0.02, 1};           /* and of all nodes with unknowns */
static const PetscInt most_nodes[] = {128, 1024};   /* of a patch */

#define SKEW 1e-3 /* of the other directions in the order of a patch's nodes */

PetscErrorCode EliminationReset(Elimination *e)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree4(e->own, e->live, e->place, e->force));
  PetscCall(PetscFree4(e->node, e->node_start, e->group, e->group_start));
  *e = (Elimination){0};
  PetscFunctionReturn(0);
}

PetscErrorCode EliminationSetUp(Elimination *e, const StepProblem *p)
{
  const Grid *grid = p->grid;
  const PetscInt n = grid->n_nodes, *degree, dim = grid->dim;

  PetscFunctionBeginUser;
  PetscCall(EliminationReset(e));
  e->dim = dim;
  PetscCall(PetscMalloc4(n, &e->own, n, &e->live, n, &e->place, n * dim, &e->force));
  PetscCall(PetscMalloc4(n, &e->node, n + 1, &e->node_start, grid->n_cells, &e->group, n + 1, &e->group_start));
  PetscCall(PetscSFComputeDegreeBegin(grid->node_sf, &degree));
  PetscCall(PetscSFComputeDegreeEnd(grid->node_sf, &degree));
  for (PetscInt i = 0; i < n; ++i) {
    e->own[i] = i < grid->n_owned && degree[i] == 0;
    e->live[i] = 0;
    e->place[i] = -1;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode EliminationBegin(Elimination *e, const StepProblem *p)
{
  PetscFunctionBeginUser;
  if (!e->live) PetscFunctionReturn(0);
  PetscCall(PetscArrayzero(e->live, p->grid->n_nodes));
  nodal_forces_mark(p->forces, e->live);
  PetscFunctionReturn(0);
}

/* Does it have unknowns that this rank may settle, and is it not chosen yet? */
static PetscBool is_free(const Elimination *e, const StepProblem *p, PetscInt node)
{
  const unsigned char *fixed = p->fixed + node * e->dim;
  PetscBool held = PETSC_TRUE;
  for (PetscInt d = 0; d < e->dim; ++d) held &= fixed[d] != 0;
  return e->own[node] && !e->live[node] && !held && e->place[node] < 0 &&
         !(p->system->frames && frame_of(p->system->frames, node));
}

static void take(Elimination *e, PetscInt node, PetscInt *n)
{
  e->place[node] = *n;
  e->node[(*n)++] = node;
}

/* Nodes that stand out; more than MOST_CHOSEN if there are too many. */
static PetscInt take_outstanding(Elimination *e, const StepProblem *p, const PetscReal *f, PetscReal norm)
{
  const PetscReal least = PetscSqr(stands_out[p->stiff] * norm);
  const PetscInt most =
    (PetscInt)PetscMin(most_chosen[p->stiff], few[p->stiff] * (PetscReal)p->system->n_active_global);
  PetscInt n = 0;
  for (PetscInt k = 0; k < p->system->n_active && n <= most; ++k) {
    PetscReal square = 0;
    for (PetscInt d = 0; d < e->dim; ++d) square += PetscSqr(f[k * e->dim + d]);
    if (square >= least && is_free(e, p, p->system->active[k])) take(e, p->system->active[k], &n);
  }
  return n <= most ? n : -n;
}

static PetscInt take_neighbours(Elimination *e, const StepProblem *p, PetscInt n)
{
  const System *s = p->system;
  for (PetscInt k = 0, chosen = n; k < chosen; ++k) {
    const PetscInt row = s->row[e->node[k]];
    for (PetscInt c = s->row_start[row]; c < s->row_start[row + 1]; ++c)
      if (is_free(e, p, s->column[c])) take(e, s->column[c], &n);
  }
  return n;
}

static PetscInt root_of(PetscInt *up, PetscInt k)
{
  while (up[k] != k) k = up[k] = up[up[k]];
  return k;
}

/* The first chosen node of a group, as a number; -1 if there is none. */
static PetscInt first_of(const Elimination *e, const Support *s, PetscInt g)
{
  for (PetscInt i = s->node_start[g]; i < s->node_start[g + 1]; ++i)
    if (e->place[s->node[i]] >= 0) return e->place[s->node[i]];
  return -1;
}

/* Groups that hold chosen nodes; nodes that share one belong together (up: trees). */
static PetscInt take_groups(Elimination *e, const Support *s, PetscInt *up)
{
  PetscInt n = 0;
  for (PetscInt g = 0; g < s->n_groups; ++g) {
    const PetscInt first = first_of(e, s, g);
    if (first < 0) continue;
    e->group[n++] = g;
    for (PetscInt i = s->node_start[g]; i < s->node_start[g + 1]; ++i)
      if (e->place[s->node[i]] >= 0) up[root_of(up, e->place[s->node[i]])] = root_of(up, first);
  }
  return n;
}

/* Items by their keys 0 .. n_keys - 1, in their order otherwise; start: n_keys + 1. */
static PetscErrorCode SortBy(const PetscInt *key, PetscInt n_keys, PetscInt n, PetscInt *item, PetscInt *start)
{
  PetscInt *sorted;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &sorted));
  PetscCall(PetscArrayzero(start, n_keys + 1));
  for (PetscInt i = 0; i < n; ++i) ++start[key[i] + 1];
  for (PetscInt k = 0; k < n_keys; ++k) start[k + 1] += start[k];
  for (PetscInt i = 0; i < n; ++i) sorted[start[key[i]]++] = item[i];
  for (PetscInt k = n_keys; k > 0; --k) start[k] = start[k - 1];
  start[0] = 0;
  PetscCall(PetscArraycpy(item, sorted, n));
  PetscCall(PetscFree(sorted));
  PetscFunctionReturn(0);
}

/* Nodes of a patch along its longer side, so that those which couple stand close to each other. */
static PetscErrorCode SortAlong(const Elimination *e, const StepProblem *p, PetscInt n, PetscInt *node)
{
  const PetscReal *x = p->grid->x;
  PetscReal low[3], high[3], *key;
  PetscInt longest = 0;

  PetscFunctionBeginUser;
  for (PetscInt d = 0; d < e->dim; ++d) {
    low[d] = PETSC_MAX_REAL;
    high[d] = -PETSC_MAX_REAL;
    for (PetscInt k = 0; k < n; ++k) {
      low[d] = PetscMin(low[d], x[node[k] * e->dim + d]);
      high[d] = PetscMax(high[d], x[node[k] * e->dim + d]);
    }
    if (high[d] - low[d] > high[longest] - low[longest]) longest = d;
  }
  PetscCall(PetscSortInt(n, node)); /* whatever came first: ties, if there are any, stand in one order */
  PetscCall(PetscMalloc1(n, &key));
  for (PetscInt k = 0; k < n; ++k) {
    key[k] = 0;
    for (PetscInt d = 0; d < e->dim; ++d) key[k] += (d == longest ? 1 : SKEW) * x[node[k] * e->dim + d];
  }
  PetscCall(PetscSortRealWithArrayInt(n, key, node));
  PetscCall(PetscFree(key));
  PetscFunctionReturn(0);
}

/* The n chosen nodes and their groups, patch by patch. */
static PetscErrorCode Divide(Elimination *e, const StepProblem *p, PetscInt n)
{
  const Support *s = p->in.support;
  PetscInt *up, *patch, *key;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &up, n, &patch));
  for (PetscInt k = 0; k < n; ++k) up[k] = k;
  const PetscInt n_groups = take_groups(e, s, up);
  PetscCall(PetscMalloc1(n_groups, &key));
  for (PetscInt k = 0; k < n; ++k)
    if (up[k] == k) patch[k] = e->n_patches++;
  for (PetscInt k = 0; k < n; ++k)
    if (up[k] != k) patch[k] = patch[root_of(up, k)];
  for (PetscInt k = 0; k < n_groups; ++k) key[k] = patch[first_of(e, s, e->group[k])];
  for (PetscInt k = 0; k < n; ++k) e->place[e->node[k]] = -1;
  PetscCall(SortBy(patch, e->n_patches, n, e->node, e->node_start));
  for (PetscInt k = 0; k < e->n_patches; ++k)
    PetscCall(SortAlong(e, p, e->node_start[k + 1] - e->node_start[k], e->node + e->node_start[k]));
  PetscCall(SortBy(key, e->n_patches, n_groups, e->group, e->group_start));
  PetscCall(PetscFree2(up, patch));
  PetscCall(PetscFree(key));
  PetscFunctionReturn(0);
}

PetscErrorCode EliminationChoose(Elimination *e, const StepProblem *p, const PetscReal *f, PetscReal norm)
{
  PetscFunctionBeginUser;
  e->n_patches = 0;
  const PetscInt n = take_outstanding(e, p, f, norm);
  if (n > 0) PetscCall(Divide(e, p, take_neighbours(e, p, n)));
  for (PetscInt k = 0; k < -n; ++k) e->place[e->node[k]] = -1;
  const PetscBool some = e->n_patches > 0;
  PetscCall(MPIU_Allreduce(&some, &e->any, 1, MPIU_BOOL, MPI_LOR, p->grid->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode EliminationApply(Elimination *e, const StepProblem *p, PetscReal enough)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < e->n_patches; ++k) {
    const Patch patch = {.n = e->node_start[k + 1] - e->node_start[k],
                         .node = e->node + e->node_start[k],
                         .n_groups = e->group_start[k + 1] - e->group_start[k],
                         .group = e->group + e->group_start[k]};
    if (patch.n <= most_nodes[p->stiff]) PetscCall(PatchSolve(p, &patch, enough, e->place, e->force));
  }
  PetscFunctionReturn(0);
}
