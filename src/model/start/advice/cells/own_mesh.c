/* Points of a body's own mesh stand where that has its cells, not where the grid has. Do they add up, at nodes inside
 * the body, to what is there (docs/theory.md, section 78)? */
#include "model/model_private.h"
#include "points/seed/outline.h"
#include "support/basis.h"

#define WITHIN 1e-6 /* of a cell: its corners may lie on the body's surface, and a point may have all of it */
#define LARGE 0.5   /* of the points: with so many larger than their cells nodes have too few, in balance or not */

/* What may be out of balance: limit loads are too low by 1, 3 to 7, 8 to 12 and 10 to 18 % with 0.07, 0.10, 0.17 and
 * 0.26 of it, linear functions; displacements too large by 2, 3, 6 and 12 % with 0.08, 0.12, 0.16 and 0.17, gimp. In
 * dynamics points cross cells anyway. */
#define MOST 0.08
#define MOST_IN_DYNAMICS 0.3

/* Of a node: volume, and along each axis what uniform stress pushes it with, and would if nothing pushed back. */
typedef struct {
  PetscReal volume, push[3], either[3];
} NodeSum;
#define NODE_SUM_NUMBERS 7

/* Of a body: how many points it has, how many stand for more than the cell that they are in, the volume of these cells
 * and theirs; over its inner nodes what their sums are off by, squared. */
typedef struct {
  PetscReal points, large, cells, volume, nodes, more, push;
} OwnPoints;
#define OWN_POINTS_NUMBERS 7

static void add_point(const Model *m, const Support *w, PetscInt g, PetscInt p, NodeSum *sum)
{
  const PetscInt dim = m->dim;
  const PetscReal *N = support_N(w, g, p), *dN = support_dN(w, g, p, dim), volume = m->points->real[POINT_VOLUME][p];
  const PetscReal hoop = m->c->kinematics->hoop ? 1 / point_real(m->points, POINT_X, p)[0] : 0;
  for (PetscInt i = 0; i < support_nodes(w, g); ++i) {
    NodeSum *s = sum + w->node[w->node_start[g] + i];
    s->volume += volume * N[i];
    for (PetscInt d = 0; d < dim; ++d) {
      const PetscReal slope = dN[i * dim + d] + (d ? 0 : hoop * N[i]);
      s->push[d] += volume * slope;
      s->either[d] += volume * PetscAbsReal(slope);
    }
  }
}

/* As the basis sees the points where they are seeded. */
static PetscErrorCode SumPoints(const Model *m, NodeSum *sum)
{
  const BasisInput in = {.spec = &m->c->basis, .grid = m->grid, .hoop = m->c->kinematics->hoop};
  Support *w;

  PetscFunctionBeginUser;
  PetscCall(SupportCreate(&w));
  PetscCall(basis_find(m->c->basis.kind)->support(&in, m->points, w));
  for (PetscInt g = 0; g < w->n_groups; ++g)
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) add_point(m, w, g, p, sum);
  PetscCall(SupportDestroy(&w));
  PetscCall(GridSumToOwners(m->grid, NODE_SUM_NUMBERS, (PetscReal *)sum));
  PetscFunctionReturn(0);
}

static PetscBool has_cell(const Model *m, Overburden *outline, PetscInt body, PetscInt cell)
{
  const PetscInt field = m->grid->n_fields > 1 ? case_field(m->c, body) : 0, nodes = grid_cell(m->grid, cell)->nodes;
  PetscReal x[CELL_MAX_NODES * 3], centre[3], at[3];
  PetscBool holds = (PetscBool)(grid_field_of(m->grid, cell) == field);
  grid_cell_centre(m->grid, cell, centre);
  grid_cell_x(m->grid, cell, x);
  for (PetscInt i = 0; i < nodes && holds; ++i) {
    for (PetscInt d = 0; d < m->dim; ++d) at[d] = x[i * m->dim + d] + WITHIN * (centre[d] - x[i * m->dim + d]);
    holds = overburden_holds(outline, body, at);
  }
  return holds;
}

/* Per owned node the volume that linear functions give it; 0: not all of its cells are the body's, or it is at the
 * grid's boundary. */
static PetscErrorCode FindInner(const Model *m, Overburden *outline, PetscInt body, PetscReal *volume)
{
  const Grid *grid = m->grid;
  PetscReal *beyond, x[CELL_MAX_NODES * 3];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(grid->n_nodes, &beyond));
  PetscCall(PetscArrayzero(volume, grid->n_nodes));
  for (PetscInt c = 0; c < grid->n_cells; ++c) {
    const PetscInt nodes = grid_cell(grid, c)->nodes, *node = grid->cell_node + c * grid->nodes_per_cell;
    const PetscBool has = has_cell(m, outline, body, c);
    grid_cell_x(grid, c, x);
    const PetscReal share = cell_volume_in(m->c->kinematics, grid_cell_type(grid, c), x) / (PetscReal)nodes;
    for (PetscInt i = 0; i < nodes; ++i) {
      beyond[node[i]] += !has;
      volume[node[i]] += share;
    }
  }
  for (PetscInt k = 0; k < grid->outer.n_nodes; ++k) beyond[grid->outer.nodes[k]] += 1;
  PetscCall(GridSumToOwners(grid, 1, beyond));
  PetscCall(GridSumToOwners(grid, 1, volume));
  for (PetscInt I = 0; I < grid->n_owned; ++I)
    if (beyond[I] > 0) volume[I] = 0;
  PetscCall(PetscFree(beyond));
  PetscFunctionReturn(0);
}

/* Which share of uniform stress along an axis is not borne, squared; 1 where no point is. */
static PetscReal unborne(const Model *m, const NodeSum *sum)
{
  PetscReal square = 0;
  for (PetscInt d = 0; d < m->dim; ++d)
    square += sum->either[d] > 0 ? PetscSqr(sum->push[d] / sum->either[d]) / (PetscReal)m->dim : 1 / (PetscReal)m->dim;
  return square;
}

static void count_points(const Model *m, PetscInt body, OwnPoints *own)
{
  PetscReal x[CELL_MAX_NODES * 3];
  for (PetscInt p = 0; p < m->points->n; ++p) {
    if (m->points->body[p] != body) continue;
    grid_cell_x(m->grid, m->points->cell[p], x);
    const PetscReal volume = m->points->real[POINT_VOLUME][p],
                    cell = cell_volume_in(m->c->kinematics, grid_cell_type(m->grid, m->points->cell[p]), x);
    own->points += 1;
    own->large += volume > (1 + WITHIN) * cell;
    own->cells += cell;
    own->volume += volume;
  }
}

/* sum: of all nodes. */
static PetscErrorCode Look(const Model *m, Overburden *outline, PetscInt body, const NodeSum *sum, OwnPoints *own)
{
  PetscReal *volume;

  PetscFunctionBeginUser;
  *own = (OwnPoints){0};
  count_points(m, body, own);
  PetscCall(PetscMalloc1(m->grid->n_nodes, &volume));
  PetscCall(FindInner(m, outline, body, volume));
  for (PetscInt I = 0; I < m->grid->n_owned; ++I) {
    if (volume[I] <= 0) continue;
    own->nodes += 1;
    own->more += PetscSqr(sum[I].volume / volume[I] - 1);
    own->push += unborne(m, sum + I);
  }
  PetscCall(PetscFree(volume));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, own, OWN_POINTS_NUMBERS, MPIU_REAL, MPIU_SUM, m->comm));
  PetscFunctionReturn(0);
}

/* The share that is off is told; 0: nothing. */
static PetscReal tell(const Model *m, PetscInt body, const OwnPoints *own, Diag *diag)
{
  const PetscReal most = m->scheme->inertia ? MOST_IN_DYNAMICS : MOST,
                  off = own->nodes > 0 ? PetscSqrtReal(PetscMax(own->more, own->push) / own->nodes) : 0,
                  in_cell = own->cells / own->volume;
  const char *name = m->c->bodies[body].name;
  char path[64];
  PetscSNPrintf(path, sizeof path, "bodies[%d].mesh", (int)body);
  if (own->large > LARGE * own->points)
    diag_warning(diag, path,
                 "points of '%s' are farther apart than the cells of the grid (%.2g in a cell): nothing joins them",
                 name, (double)in_cell);
  else if (off > most)
    diag_warning(diag, path,
                 "points of '%s' stand unevenly in the cells of the grid (%.2g in each): inside it %.0f %% of a "
                 "uniform stress is out of balance, and what it bears and how far it goes may be wrong by as much",
                 name, (double)in_cell, (double)(100 * off));
  else return 0;
  diag_hint(diag,
            "use more points_per_cell, a finer mesh of the body, a coarser grid with lines along those of the "
            "mesh, or `shape` in place of `mesh`");
  return PetscMax(off, most);
}

PetscErrorCode AdviseOwnMeshes(Model *m, const Outline *outline, Diag *diag)
{
  PetscReal up[3] = {0, 0, 0};
  Overburden *inside;
  NodeSum *sum;
  OwnPoints own;

  PetscFunctionBeginUser;
  up[m->dim - 1] = 1;
  PetscCall(OverburdenCreate(m->comm, m->dim, up, 0, m->c->n_bodies, outline, &inside));
  PetscCall(PetscCalloc1(m->grid->n_nodes, &sum));
  PetscCall(SumPoints(m, sum));
  for (PetscInt b = 0; b < m->c->n_bodies; ++b) {
    if (!m->c->bodies[b].mesh || m->c->bodies[b].absent) continue;
    PetscCall(Look(m, inside, b, sum, &own));
    m->uneven = PetscMax(m->uneven, tell(m, b, &own, diag));
  }
  PetscCall(PetscFree(sum));
  PetscCall(OverburdenDestroy(&inside));
  PetscFunctionReturn(0);
}
