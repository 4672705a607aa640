#include "method/extend/extend.h"
#include "method/extend/choose.h"
#include "method/extend/keep.h"
#include "method/extend/row.h"
#include "support/products.h"

static void find_places(const GridBox *box, PetscInt (*place)[LATTICE])
{
  const PetscInt *node = box->lattice;
  PetscInt at[LATTICE];
  for (PetscBool more = block_first(&box->nodes, at); more; more = block_next(&box->nodes, at), ++node)
    for (int d = 0; d < LATTICE; ++d) place[*node][d] = at[d];
}

static PetscErrorCode ExtensionCreate(const Discretisation *s, Extension **extension)
{
  const GridBox *box = s->grid->box;
  const PetscInt n = s->grid->n_nodes;
  Extension *e;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&e));
  PetscCall(
    PetscCalloc7(n, &e->fill, n, &e->lean, n, &e->loaded, n, &e->leads, n, &e->ways, n, &e->place, n, &e->extent));
  PetscCall(PetscMalloc3(n, &e->follower, n, &e->listed, n, &e->beside));
  if (box) find_places(box, e->place);
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
  PetscCall(PetscFree7(e->fill, e->lean, e->loaded, e->leads, e->ways, e->place, e->extent));
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
  return implicit && s->grid->box && !s->nodes->pressure && asked && !s->alone ? PETSC_TRUE : PETSC_FALSE;
}

/* A sum over n nodes once followers are gone; PETSC_FALSE: not all nodes are known to this rank. */
static PetscBool sum_row(const Discretisation *s, PetscInt slopes, PetscInt n, const PetscInt *node, const PetscReal *N,
                         const PetscReal *dN, Row *row)
{
  const Extension *e = s->extension;
  row->n = 0;
  for (PetscInt I = 0; I < n; ++I) {
    const PetscInt ways = (PetscInt)e->ways[node[I]];
    if (!ways) row_add(row, slopes, node[I], 1, N[I], dN + I * slopes);
    else if (!row_add_follower(row, slopes, s->grid->box, e->place[node[I]], ways, N[I], dN + I * slopes))
      return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

static PetscErrorCode Fill(Discretisation *s, PetscReal *fill)
{
  PetscFunctionBeginUser;
  PetscCall(DiscretisationVolumes(s, s->points->real[POINT_J], fill));
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
  for (PetscInt p = 0; p < old->n_groups; ++p) room += changes_row(s, seen, p) ? WAYS : 0;
  PetscCall(SupportReserve(out, old->n_groups, room, room, slopes));
  for (PetscInt p = 0; p < old->n_groups; ++p) {
    const PetscInt from = old->node_start[p], nn = support_nodes(old, p);
    const PetscInt *node = old->node + from;
    const PetscReal *N = old->N + from, *dN = old->dN + from * slopes;
    const PetscBool changes = changes_row(s, seen, p);
    product_group(out, p, n);
    if (changes) (void)sum_row(s, slopes, nn, node, N, dN, &row);
    if (changes) PetscCall(CopyRow(out, slopes, row.n, n, row.node, row.N, row.dN));
    else PetscCall(CopyRow(out, slopes, nn, n, node, N, dN));
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
  const Seen points = seen_by_points(s), carriers = seen_by_carriers(s);
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
  for (PetscInt g = 0; g < w->n_groups; ++g) {
    PetscBool push = PETSC_FALSE;
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) push |= carrier_pushes(s->loads, p);
    for (PetscInt i = w->node_start[g]; push && i < w->node_start[g + 1]; ++i) e->loaded[w->node[i]] = 1;
  }
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
    for (PetscInt k = 0; k < n * s->grid->dim && seen == n; ++k) bend[k] = raw[k];
    return (PetscBool)(seen == n);
  }
  if (!sum_row(s, s->grid->dim, seen, node, none, raw, &row) || row.n != n) return PETSC_FALSE;
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
  PetscCall(ExtensionSpare(s));
  PetscCall(ExtensionKeep(s));
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
