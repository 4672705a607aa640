#include "method/extend/extend.h"
#include "method/extend/choose.h"
#include "method/extend/row.h"
#include "support/products.h"

#define ALL -1

static PetscErrorCode ExtensionCreate(const Discretisation *s, Extension **extension)
{
  const GridBox *box = s->grid->box;
  const PetscInt n = s->grid->n_nodes, known = box ? block_size(&box->nodes) : 0;
  Extension *e;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&e));
  PetscCall(PetscCalloc5(n, &e->fill, n, &e->loaded, n, &e->leads, n, &e->ways, n, &e->place));
  PetscCall(PetscMalloc3(n, &e->follower, n, &e->listed, n, &e->beside));
  for (PetscInt k = 0; k < known; ++k) e->place[box->lattice[k]] = k;
  PetscCall(SupportCreate(&e->spare));
  PetscCall(SupportCreate(&e->carried));
  PetscCall(SupportCreate(&e->spare_carried));
  PetscCall(SupportCreate(&e->traced));
  *extension = e;
  PetscFunctionReturn(0);
}

PetscErrorCode ExtensionDestroy(Extension **extension)
{
  Extension *e = *extension;

  PetscFunctionBeginUser;
  if (!e) PetscFunctionReturn(0);
  PetscCall(PetscFree5(e->fill, e->loaded, e->leads, e->ways, e->place));
  PetscCall(SupportDestroy(&e->spare));
  PetscCall(SupportDestroy(&e->carried));
  PetscCall(SupportDestroy(&e->spare_carried));
  PetscCall(SupportDestroy(&e->traced));
  PetscCall(PetscFree3(e->follower, e->listed, e->beside));
  PetscCall(PetscFree(*extension));
  PetscFunctionReturn(0);
}

PetscBool extension_works(const Discretisation *s)
{
  const PetscBool implicit = s->c->analysis.type != ANALYSIS_EXPLICIT;
  const PetscBool asked = s->c->stabilisation.follow > 0 || (s->c->n_loads && loads_have_pieces(s->loads));
  return implicit && s->grid->box && !s->nodes->pressure && asked ? PETSC_TRUE : PETSC_FALSE;
}

void place_of(const GridBox *box, const Extension *e, PetscInt node, PetscInt at[3])
{
  const VoxelBlock *all = &box->nodes;
  const PetscInt k = e->place[node], nx = all->hi[0] - all->lo[0], ny = all->hi[1] - all->lo[1];
  at[0] = all->lo[0] + k % nx;
  at[1] = all->lo[1] + k / nx % ny;
  at[2] = all->lo[2] + k / (nx * ny);
}

/* Do all of these nodes stand around one corner of the cell, as the system's pattern has it? */
static PetscBool stand_around(const Discretisation *s, const PetscInt cell[3], const Row *row)
{
  PetscInt at[3];
  for (PetscInt d = 0; d < s->grid->dim; ++d) {
    PetscInt low = cell[d] + 2, high = cell[d] - 1;
    for (PetscInt I = 0; I < row->n; ++I) {
      place_of(s->grid->box, s->extension, row->node[I], at);
      low = PetscMin(low, at[d]);
      high = PetscMax(high, at[d]);
    }
    if (low < cell[d] - 1 || high > cell[d] + 2 || high - low > 2) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Points, or carriers of loads, and what they see. */
typedef struct {
  const Points *points;
  const Support *support;
  PetscInt slopes; /* numbers of dN a node */
} Seen;

static Seen points_of(const Discretisation *s) { return (Seen){s->points, s->support, s->grid->dim}; }
static Seen carriers_of(const Discretisation *s)
{
  return (Seen){s->loads->carriers, s->extension->carried, s->loads->slopes};
}

static PetscBool sees_follower(const Discretisation *s, const Support *w, PetscInt p)
{
  for (PetscInt I = w->node_start[p]; I < w->node_start[p + 1]; ++I)
    if (s->extension->ways[w->node[I]] > 0) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* A sum over n nodes once followers are gone, or `only` that one, and the others are not there; PETSC_FALSE: not all
 * nodes are known to this rank. */
static PetscBool sum_row(const Discretisation *s, PetscInt slopes, PetscInt n, const PetscInt *node, const PetscReal *N,
                         const PetscReal *dN, PetscInt only, Row *row)
{
  PetscInt at[3];
  row->n = 0;
  for (PetscInt I = 0; I < n; ++I) {
    const PetscInt ways = (PetscInt)s->extension->ways[node[I]];
    if (ways && only != ALL && only != node[I]) continue;
    place_of(s->grid->box, s->extension, node[I], at);
    if (!ways) row_add(row, slopes, node[I], 1, N[I], dN + I * slopes);
    else if (!row_add_follower(row, slopes, s->grid->box, at, ways, N[I], dN + I * slopes)) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* What point p sees then; PETSC_FALSE if these nodes are farther apart than those of a point may be, too. */
static PetscBool find_row(const Discretisation *s, const Seen *seen, PetscInt p, PetscInt only, Row *row)
{
  const Support *w = seen->support;
  const PetscReal *N = w->N + w->value_start[p], *dN = w->dN + w->value_start[p] * seen->slopes;
  PetscInt at[3];
  if (!sum_row(s, seen->slopes, support_nodes(w, p), w->node + w->node_start[p], N, dN, only, row)) return PETSC_FALSE;
  box_voxel_of(s->grid, seen->points->cell[p], at);
  return stand_around(s, at, row);
}

/* Marks the followers that point p cannot do without: each whose leaders alone are too far away, all if none is. */
static void mark_seen(const Discretisation *s, const Seen *seen, PetscInt p, PetscReal *needed)
{
  const Support *w = seen->support;
  PetscBool found = PETSC_FALSE;
  Row row;
  for (PetscInt I = w->node_start[p]; I < w->node_start[p + 1]; ++I) {
    if (s->extension->ways[w->node[I]] == 0 || find_row(s, seen, p, w->node[I], &row)) continue;
    needed[w->node[I]] = 1;
    found = PETSC_TRUE;
  }
  for (PetscInt I = w->node_start[p]; I < w->node_start[p + 1] && !found; ++I) needed[w->node[I]] = 1;
}

/* Marks nodes that must stay: those of points that would see others too far away. */
static void mark_lookers(const Discretisation *s, const Seen *seen, PetscReal *needed)
{
  Row row;
  for (PetscInt p = 0; p < seen->support->n_groups; ++p)
    if (sees_follower(s, seen->support, p) && !find_row(s, seen, p, ALL, &row)) mark_seen(s, seen, p, needed);
}

/* And those that loads act on by functions of their cells. */
static void mark_loaded(const Discretisation *s, PetscReal *needed)
{
  const Points *carriers = s->loads->carriers;
  const PetscInt nn = s->grid->nodes_per_cell;
  for (PetscInt p = 0; p < carriers->n; ++p)
    for (PetscInt I = 0; carriers->cell[p] >= 0 && I < nn; ++I)
      needed[s->grid->cell_node[carriers->cell[p] * nn + I]] = 1;
}

static void mark_needed(const Discretisation *s, PetscReal *needed)
{
  const Seen points = points_of(s), carriers = carriers_of(s);
  mark_lookers(s, &points, needed);
  if (s->basis->carries) mark_lookers(s, &carriers, needed);
  else mark_loaded(s, needed);
}

/* *again: have any that were to follow been kept, so that points see others than was thought? */
static PetscErrorCode KeepNeeded(const Discretisation *s, PetscBool *again)
{
  const Grid *grid = s->grid;
  PetscReal *needed;
  PetscBool here = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(grid->n_nodes, &needed));
  mark_needed(s, needed);
  PetscCall(GridSumToOwners(grid, 1, needed));
  PetscCall(GridToGhosts(grid, 1, needed));
  for (PetscInt i = 0; i < grid->n_nodes; ++i) {
    if (!(needed[i] > 0) || s->extension->ways[i] == 0) continue;
    s->extension->ways[i] = 0;
    here = PETSC_TRUE;
  }
  PetscCall(PetscFree(needed));
  PetscCallMPI(MPI_Allreduce(&here, again, 1, MPIU_BOOL, MPI_LOR, grid->comm));
  PetscFunctionReturn(0);
}

static PetscErrorCode Fill(Discretisation *s, PetscReal *fill)
{
  PetscFunctionBeginUser;
  PetscCall(DiscretisationVolumes(s, PETSC_TRUE, fill));
  for (PetscInt i = 0; i < s->grid->n_nodes; ++i) fill[i] = fill[i] > 0 ? 2 * fill[i] / s->whole[i] : 0;
  PetscFunctionReturn(0);
}

static PetscErrorCode CopyRow(Support *out, PetscInt slopes, PetscInt n, PetscInt first, const PetscInt *node,
                              const PetscReal *N, const PetscReal *dN)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(out->node + first, node, n));
  PetscCall(PetscArraycpy(out->N + first, N, n));
  PetscCall(PetscArraycpy(out->dN + first * slopes, dN, n * slopes));
  PetscFunctionReturn(0);
}

/* What they see without the nodes that follow. */
static PetscErrorCode Rewrite(const Discretisation *s, const Seen *seen, Support *out)
{
  const PetscInt slopes = seen->slopes;
  const Support *old = seen->support;
  PetscInt room = old->node_start[old->n_groups], n = 0;
  Row row;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < old->n_groups; ++p) room += sees_follower(s, old, p) ? WAYS : 0;
  PetscCall(SupportReserve(out, old->n_groups, room, room, slopes));
  for (PetscInt p = 0; p < old->n_groups; ++p) {
    const PetscInt from = old->node_start[p], nn = support_nodes(old, p);
    const PetscBool changes = sees_follower(s, old, p);
    product_group(out, p, n);
    if (changes) (void)find_row(s, seen, p, ALL, &row);
    if (changes) PetscCall(CopyRow(out, slopes, row.n, n, row.node, row.N, row.dN));
    else PetscCall(CopyRow(out, slopes, nn, n, old->node + from, old->N + from, old->dN + from * slopes));
    n += changes ? row.n : nn;
  }
  products_end(out, old->n_groups, n);
  PetscFunctionReturn(0);
}

static void swap(Support *a, Support *b)
{
  const Support kept = *a;
  *a = *b;
  *b = kept;
}

/* The supports without the nodes that follow take the place of the others. */
static PetscErrorCode RewriteAll(Discretisation *s)
{
  const Seen points = points_of(s), carriers = carriers_of(s);
  Extension *e = s->extension;

  PetscFunctionBeginUser;
  PetscCall(Rewrite(s, &points, e->spare));
  swap(s->support, e->spare);
  if (!s->basis->carries) PetscFunctionReturn(0);
  PetscCall(Rewrite(s, &carriers, e->spare_carried));
  swap(e->carried, e->spare_carried);
  PetscFunctionReturn(0);
}

/* They have no domain, in rings neither. */
static PetscErrorCode SeeAt(const Discretisation *s, const BasisInput *in, Points *places, Support *seen)
{
  const BasisInput plain = {.spec = in->spec, .grid = in->grid, .rim = in->rim};

  PetscFunctionBeginUser;
  PetscCall(PointsSort(places));
  PetscCall(s->basis->support(&plain, places, seen));
  PetscFunctionReturn(0);
}

PetscErrorCode DiscretisationCarry(Discretisation *s, const BasisInput *in)
{
  PetscFunctionBeginUser;
  if (s->basis->has_places) PetscCall(SeeAt(s, in, s->tracers, s->extension->traced));
  if (!s->basis->carries) PetscFunctionReturn(0);
  s->loads->support = s->extension->carried;
  s->loads->slopes = s->basis->carry ? s->grid->dim + 1 : s->grid->dim;
  if (!s->basis->carry) PetscCall(SeeAt(s, in, s->loads->carriers, s->extension->carried));
  else {
    PetscCall(PointsSort(s->loads->carriers));
    PetscCall(s->basis->carry(in, s->loads->carriers, s->extension->carried));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ExtensionLoaded(const Discretisation *s)
{
  Extension *e = s->extension;
  const Support *w = e->carried;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(e->loaded, s->grid->n_nodes));
  if (!s->basis->carry) PetscFunctionReturn(0);
  for (PetscInt i = 0; w->n_groups && i < w->node_start[w->n_groups]; ++i) e->loaded[w->node[i]] = 1;
  PetscCall(GridSumToOwners(s->grid, 1, e->loaded));
  PetscCall(GridToGhosts(s->grid, 1, e->loaded));
  PetscFunctionReturn(0);
}

PetscBool extension_bends(const void *space, PetscInt p, PetscInt n, PetscReal *bend)
{
  const Discretisation *s = space;
  const BasisInput in = {.grid = s->grid, .hoop = s->c->kinematics->hoop, .rim = s->rim};
  const PetscReal none[PRODUCT_MOST_NODES] = {0};
  PetscReal raw[3 * PRODUCT_MOST_NODES];
  PetscInt node[PRODUCT_MOST_NODES];
  Row row;
  if (!s->basis->bends || !s->grid->box || s->points->cell[p] < 0) return PETSC_FALSE;
  const PetscInt seen = s->basis->bends(&in, s->points, p, node, raw);
  if (!s->extension->any) {
    for (PetscInt k = 0; k < n * s->grid->dim; ++k) bend[k] = raw[k];
    return (PetscBool)(seen == n);
  }
  if (!sum_row(s, s->grid->dim, seen, node, none, raw, ALL, &row) || row.n != n) return PETSC_FALSE;
  for (PetscInt k = 0; k < n * s->grid->dim; ++k) bend[k] = row.dN[k];
  return PETSC_TRUE;
}

const Support *followers_see(const Discretisation *s, const Points *followers)
{
  if (!s->extension || !s->basis->has_places) return NULL;
  return followers == s->tracers ? s->extension->traced : followers == s->loads->carriers ? s->loads->support : NULL;
}

PetscErrorCode DiscretisationExtend(Discretisation *s, const BasisInput *in)
{
  PetscBool again = PETSC_TRUE;

  PetscFunctionBeginUser;
  if (!s->extension) PetscCall(ExtensionCreate(s, &s->extension));
  Extension *e = s->extension;
  PetscCheck(e, PETSC_COMM_SELF, PETSC_ERR_PLIB, "no extension");
  PetscCall(DiscretisationCarry(s, in));
  PetscCall(Fill(s, e->fill));
  PetscCall(PetscArrayzero(e->ways, s->grid->n_nodes));
  e->any = PETSC_FALSE;
  if (!extension_works(s)) PetscFunctionReturn(0);
  PetscCall(ExtensionLoaded(s));
  PetscCall(ChooseWays(s, e));
  while (again) PetscCall(KeepNeeded(s, &again));
  PetscCall(ExtensionList(s, s->grid->n_nodes, NULL, &e->any));
  if (e->n_followers) PetscCall(RewriteAll(s));
  PetscFunctionReturn(0);
}

PetscErrorCode DiscretisationFollow(Discretisation *s)
{
  PetscFunctionBeginUser;
  if (!s->extension || !s->extension->any) PetscFunctionReturn(0);
  PetscCall(ExtensionTake(s, s->grid->dim, s->nodes->du));
  PetscCall(ExtensionTake(s, s->grid->dim, s->nodes->v1));
  PetscCall(ExtensionTake(s, s->grid->dim, s->nodes->a1));
  PetscFunctionReturn(0);
}
