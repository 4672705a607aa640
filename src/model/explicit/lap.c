/* What happens only between laps: points find their cells and ranks, nodes within their reach are listed, and
 * the next substeps get their length. */
#include "grid/box/box.h"
#include "method/extend/extend.h"
#include "model/explicit/explicit.h"

/* The fastest point may cross this part of a cell in a lap: the others ranks' nodes that it
 * could then see are known. */
#define LAP_TRAVEL 0.4
/* substeps after which the critical one is asked for again */
#define LAP_MOST 50

/* Are there walks for gimp? In space sixty-four nodes around a cell would be no gain. */
static PetscBool is_smooth(const Model *m) { return m->dim == 2 && m->space->basis == basis_find("gimp"); }

/* Does anything act that asks for the nodes of all points? Walls ask for those near them, and carriers of loads look
 * for their own; loads on sides of cells want to know which of these are filled. What rests is of implicit steps alone:
 * a model of those is asked, too, what explicit ones would cost. */
static PetscBool asks_for_all(const Model *m)
{
  for (PetscInt i = 0; i < m->forces.n; ++i) {
    const NodalForce *kind = m->forces.one[i].kind;
    if (m->forces.one[i].data != m->contact && kind != &nodal_force_loads && kind != &nodal_force_pressures &&
        kind != &nodal_force_rest)
      return PETSC_TRUE;
  }
  for (PetscInt k = 0; k < m->c->n_loads; ++k)
    if (m->loads->faces[k].used) return PETSC_TRUE;
  return PETSC_FALSE;
}

static PetscBool is_loaded(const Model *m)
{
  for (PetscInt i = 0; i < m->forces.n; ++i)
    if (m->forces.one[i].data != m->contact) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Only boxes with lines at equal distances, whose functions are linear or those of gimp. */
PetscBool explicit_by_arithmetic(const Model *m)
{
  const GridBox *box = m->grid->box;
  if (!box || asks_for_all(m) || m->formulation->cells || m->c->n_interfaces) return PETSC_FALSE;
  if (m->space->basis->nodes != BASIS_OF_CELLS && !is_smooth(m)) return PETSC_FALSE;
  if (m->grid->nodes_per_cell != (m->dim == 2 ? 4 : 8)) return PETSC_FALSE;
  for (PetscInt d = 0; d < m->dim; ++d)
    if (!(box->per_length[d] > 0)) return PETSC_FALSE;
  for (PetscInt k = 0; k < m->c->n_boundary; ++k)
    if (m->c->boundary[k].moves) return PETSC_FALSE;
  return PETSC_TRUE;
}

static void lattice_of(const Model *m, Lattice *l)
{
  const GridBox *box = m->grid->box;
  PetscInt stride = 1;
  for (PetscInt d = 0; d < m->dim; ++d) {
    const PetscInt nodes = box->nodes.hi[d] - box->nodes.lo[d];
    l->origin[d] = box->line[d][box->nodes.lo[d]];
    l->per_length[d] = box->per_length[d];
    l->size[d] = 1 / box->per_length[d];
    l->most[d] = nodes - 2;
    l->stride[d] = stride;
    stride *= nodes;
    l->end[d][0] = (PetscReal)-box->nodes.lo[d];
    l->end[d][1] = (PetscReal)(box->counts[d] - box->nodes.lo[d]);
  }
  for (int k = 0; k < 8; ++k) {
    l->corner[k] = 0;
    for (PetscInt d = 0; d < m->dim; ++d) l->corner[k] += (k >> d & 1) * l->stride[d];
  }
  l->number = box->lattice;
}

PetscErrorCode ExplicitCreate(const Model *m, Explicit **explicit)
{
  const PetscInt n = m->grid->n_nodes, dim = m->dim;
  Explicit *e;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(explicit));
  e = *explicit;
  e->width = 1 + 2 * dim;
  e->box = explicit_by_arithmetic(m);
  e->smooth = is_smooth(m);
  e->shared = m->formulation->cells;
  PetscCall(SupportCreate(&e->near.support));
  e->as_strained = m->contact || m->space->basis->nodes != BASIS_OF_CELLS;
  e->slopes = m->points->components[POINT_SLOPE] > 0;
  if (e->box) lattice_of(m, &e->lattice);
  /* whole registers are read from the last node on */
  PetscCall(PetscCalloc1(n * e->width + 4, &e->sum));
  PetscCall(PetscCalloc1(n * 2 * dim + 4, &e->motion));
  PetscCall(PetscCalloc1(n * dim + 4, &e->straining));
  PetscCall(PetscCalloc3(n, &e->mark, n, &e->bare, m->c->n_loads ? 3 * n * dim : 0, &e->apart));
  PetscCall(PetscMalloc1(n, &e->active));
  const PetscInt partners = m->contact ? m->contact->n_partners : 0;
  PetscCall(PetscCalloc3(partners, &e->pushed, partners, &e->rubbed, partners, &e->sunk));
  if (m->contact) PetscCall(PetscMalloc1(m->contact->n_rigid, &e->ease));
  if (m->contact) PetscCall(PetscCalloc2(2 * n, &e->springs, n * m->contact->n_partners * dim, &e->surface));
  PetscCall(PetscMalloc1(n * dim, &e->held));
  for (PetscInt k = 0; k < m->c->n_boundary; ++k) e->moved = e->moved || m->c->boundary[k].kind != MOTION_FIXED;
  PetscFunctionReturn(0);
}

PetscErrorCode ExplicitDestroy(Explicit **explicit)
{
  Explicit *e = *explicit;

  PetscFunctionBeginUser;
  if (!e) PetscFunctionReturn(0);
  PetscCall(PetscFree(e->sum));
  PetscCall(PetscFree(e->motion));
  PetscCall(PetscFree(e->straining));
  PetscCall(PetscFree2(e->springs, e->surface));
  PetscCall(PetscFree3(e->mark, e->bare, e->apart));
  PetscCall(PetscFree(e->active));
  PetscCall(PetscFree(e->held));
  PetscCall(PetscFree(e->near.point));
  PetscCall(SupportDestroy(&e->near.support));
  PetscCall(PetscFree3(e->pushed, e->rubbed, e->sunk));
  PetscCall(PetscFree(e->ease));
  PetscCall(PetscFree(*explicit));
  PetscFunctionReturn(0);
}

/* The nodes that points of a cell see and those around them, as far as this rank knows them. */
static void mark_around(const Model *m, PetscInt cell, PetscReal *mark)
{
  const GridBox *box = m->grid->box;
  const PetscInt around = 1 + m->space->basis->halo;
  VoxelBlock near = box->nodes;
  PetscInt ijk[LATTICE];
  box_voxel_of(m->grid, cell, ijk);
  for (PetscInt d = 0; d < m->dim; ++d) {
    near.lo[d] = PetscMax(ijk[d] - around, near.lo[d]);
    near.hi[d] = PetscMin(ijk[d] + 2 + around, near.hi[d]);
  }
  for (PetscBool more = block_first(&near, ijk); more; more = block_next(&near, ijk)) mark[box_node(box, ijk)] = 1;
}

/* And those that pieces of a loaded surface see. */
static void mark_carried(const Model *m, PetscReal *mark)
{
  const Support *w = m->loads->support;
  for (PetscInt i = 0; w && w->n_groups && i < w->node_start[w->n_groups]; ++i) mark[w->node[i]] = 1;
}

static PetscErrorCode ListActive(Model *m, Explicit *e)
{
  const PetscInt n = m->grid->n_nodes;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(e->mark, n));
  if (e->box) PetscCall(PetscArrayzero(m->nodes->touched, n)); /* each substep says it of the active ones */
  for (PetscInt p = 0, last = -1; e->box && p < m->points->n; ++p) {
    if (m->points->cell[p] >= 0 && m->points->cell[p] != last) mark_around(m, m->points->cell[p], e->mark);
    last = m->points->cell[p];
  }
  for (PetscInt i = 0; i < n && !e->box; ++i) e->mark[i] = m->nodes->touched[i];
  if (!e->box && loads_have_pieces(m->loads)) mark_carried(m, e->mark);
  PetscCall(NodesShare(m, 1, e->mark));
  e->n_active = 0;
  for (PetscInt i = 0; i < n; ++i)
    if (e->mark[i] > 0) e->active[e->n_active++] = i;
  PetscFunctionReturn(0);
}

static void list_held(const Model *m, Explicit *e)
{
  e->n_held = 0;
  for (PetscInt k = 0; k < e->n_active; ++k)
    for (PetscInt d = 0; d < m->dim; ++d)
      if (m->boundary->fixed[e->active[k] * m->dim + d]) e->held[e->n_held++] = (Held){.node = e->active[k], .axis = d};
}

/* Supports of the points where they stand. */
static PetscErrorCode See(Model *m, const Explicit *e)
{
  const BasisInput basis = {.spec = &m->c->basis, .grid = m->grid, .hoop = m->c->kinematics->hoop};

  PetscFunctionBeginUser;
  PetscCall(PointsSort(m->points));
  if (e->box) PetscFunctionReturn(0);
  PetscCall(ModelMovePlaces(m, e->time));
  PetscCall(m->space->basis->support(&basis, m->points, m->space->support));
  PetscCall(DiscretisationCarry(m->space, &basis));
  PetscCall(DiscretisationTouch(m->space));
  PetscFunctionReturn(0);
}

static void choose_substeps(const Model *m, PetscReal left, Explicit *e)
{
  const PetscReal courant = case_courant(&m->c->analysis);
  const PetscReal all = PetscCeilReal(left / (courant * heavy_substep(e)) * (1 - 1e-9));
  e->dt = left / PetscMax(all, 1);
  const PetscReal travel = LAP_TRAVEL * m->grid->smallest;
  PetscReal most = PetscMin(all, LAP_MOST);
  const PetscReal fastest = PetscMax(e->fastest, e->rush);
  if (fastest * e->dt * most > travel) most = PetscFloorReal(travel / (fastest * e->dt));
  e->substeps = e->box ? PetscMax((PetscInt)most, 1) : 1;
}

void lap_displace(const Model *m, const Explicit *e, int sign)
{
  const PetscReal *x = m->points->real[POINT_X];
  PetscReal *u = m->points->real[POINT_U];
  for (PetscInt i = 0; e->box && i < m->points->n * m->dim; ++i) u[i] += sign * x[i];
}

PetscErrorCode LapBegin(Model *m, Explicit *e, PetscReal left)
{
  PetscLogDouble clock;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&clock));
  e->loaded = is_loaded(m);
  e->box = e->box && !asks_for_all(m); /* a body force may have come since */
  PetscCall(See(m, e));
  places_step(m);
  if (e->critical == 0 || e->since >= LAP_MOST) {
    PetscCall(PhaseEnd(m->seconds, PHASE_PREPARE, &clock));
    PetscCall(NonlocalStep(m)); /* with a clock of its own */
    PetscCall(PetscTime(&clock));
    PetscCall(ExplicitCritical(m, &e->critical, &e->crossing, &e->fastest));
    e->since = 0;
  }
  heavy_limit(m, e);
  choose_substeps(m, left, e);
  PetscCall(NearFind(m, e));
  PetscCall(ListActive(m, e));
  list_held(m, e);
  lap_displace(m, e, -1);
  PetscCall(PhaseEnd(m->seconds, PHASE_PREPARE, &clock));
  PetscFunctionReturn(0);
}

static PetscErrorCode Relocate(Model *m, StepReport *report)
{
  const StepReport so_far = *report;

  PetscFunctionBeginUser;
  PetscCall(PetscFree(m->space->lost));
  PetscCall(PointsRelocate(m->points, m->grid, m->c->grid.outside, &m->space->n_lost, &m->space->lost));
  PetscCall(OutsideAdd(m, report));
  report->removed += so_far.removed;
  report->held += so_far.held;
  if (so_far.removed + so_far.held) report->first_outside = so_far.first_outside;
  outside_judge(m, report);
  PetscFunctionReturn(0);
}

PetscErrorCode LapEnd(Model *m, StepReport *report)
{
  PetscLogDouble clock;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&clock));
  PetscCall(Relocate(m, report));
  PetscCall(PhaseEnd(m->seconds, PHASE_MOVE, &clock));
  PetscFunctionReturn(0);
}
