/* Nodes that domains of points hardly reach: a body that ends anywhere in a cell cuts off as little of
 * their functions as it likes (docs/theory.md, "Smooth shape functions"). */
#include "method/extend/extend.h"

/* Of half its share of the cells, what such a node has at most. */
#define HARDLY_REACHED 0.02

/* Points of equal volume that do not fix a node by themselves, and how much it is held then. */
#define FEW 1.5
#define LONELY 0.01

/* A node's share of the cells, all of which stand still: once for all steps. */
static PetscErrorCode WholeVolumes(Discretisation *s)
{
  const Grid *grid = s->grid;
  PetscReal x[3 * CELL_MAX_NODES], share[CELL_MAX_NODES];

  PetscFunctionBeginUser;
  if (s->whole) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(grid->n_nodes + 1, &s->whole)); /* not NULL without nodes either: all ranks come here once */
  for (PetscInt c = 0; c < grid->n_cells; ++c) {
    const PetscInt nn = grid_cell(grid, c)->nodes, *node = grid->cell_node + c * grid->nodes_per_cell;
    grid_cell_x(grid, c, x);
    cell_shares_in(s->c->kinematics, grid_cell_type(grid, c), x, share);
    for (PetscInt I = 0; I < nn; ++I) s->whole[node[I]] += share[I];
  }
  PetscCall(GridSumToOwners(grid, 1, s->whole));
  PetscCall(GridToGhosts(grid, 1, s->whole));
  PetscFunctionReturn(0);
}

PetscErrorCode DiscretisationVolumes(Discretisation *s, const PetscReal *ratio, PetscReal *volume)
{
  const Support *w = s->support;

  PetscFunctionBeginUser;
  PetscCall(WholeVolumes(s));
  PetscCall(PetscArrayzero(volume, s->grid->n_nodes));
  for (PetscInt g = 0; g < w->n_groups; ++g)
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) {
      const PetscReal V = (ratio ? ratio[p] : 1) * s->points->real[POINT_VOLUME][p];
      for (PetscInt I = 0; I < support_nodes(w, g); ++I)
        volume[w->node[w->node_start[g] + I]] += support_N(w, g, p)[I] * V;
    }
  PetscCall(GridSumToOwners(s->grid, 1, volume));
  PetscCall(GridToGhosts(s->grid, 1, volume));
  PetscFunctionReturn(0);
}

/* Nodes that are less than half full are held; where some follow, those alone that hardly any material reaches and no
 * others lead. What swings or yields wants the rest held, too: Newton's method takes up to a third more iterations
 * without. */
static PetscReal held_below(const Discretisation *s)
{
  if (!extension_works(s) || s->c->stabilisation.follow == 0 || s->c->analysis.type == ANALYSIS_DYNAMIC) return 1;
  if (materials_yield(s->c->n_materials, s->materials)) return 1;
  return PetscMin(HARDLY_REACHED, s->c->stabilisation.follow);
}

/* Nodes beside each other that see the same one point could move so that it does not strain: a node whose volume is
 * that of FEW points or less has at most 1 - LONELY of what is enough, and so is held a little. The volume is that
 * of what the points see now: `fill` has it from before nodes followed others. */
static PetscErrorCode TakeFromLonely(const Discretisation *s, PetscReal *reached)
{
  const Support *w = s->support;
  PetscReal *sum; /* of what each point is of a node's volume, and of its square */

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(2 * s->grid->n_nodes, &sum));
  for (PetscInt g = 0; g < w->n_groups; ++g)
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p)
      for (PetscInt I = 0; I < support_nodes(w, g); ++I) {
        const PetscReal V = support_N(w, g, p)[I] * s->points->real[POINT_VOLUME][p];
        PetscReal *at = sum + 2 * w->node[w->node_start[g] + I];
        at[0] += V, at[1] += V * V;
      }
  PetscCall(GridSumToOwners(s->grid, 2, sum));
  PetscCall(GridToGhosts(s->grid, 2, sum));
  for (PetscInt i = 0; i < s->grid->n_nodes; ++i)
    if (PetscSqr(sum[2 * i]) < FEW * sum[2 * i + 1]) reached[i] = PetscMin(reached[i], 1 - LONELY);
  PetscCall(PetscFree(sum));
  PetscFunctionReturn(0);
}

PetscErrorCode DiscretisationCuts(Discretisation *s)
{
  const Support *w = s->support;
  const PetscReal enough = held_below(s);
  PetscReal *reached; /* what a node has of it */

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->grid->n_nodes, &reached));
  for (PetscInt i = 0; i < s->grid->n_nodes; ++i) reached[i] = s->extension->fill[i] / enough;
  if (enough < 1) PetscCall(TakeFromLonely(s, reached));
  for (PetscInt g = 0; g < w->n_groups; ++g) {
    const PetscInt p = w->point_start[g], nn = support_nodes(w, g), *node = w->node + w->node_start[g];
    PetscReal filled = 1, square = 0;
    for (PetscInt I = 0; I < nn; ++I) filled = PetscMin(filled, reached[node[I]]);
    for (PetscInt i = 0; i < nn * s->grid->dim; ++i) square += PetscSqr((w->dN + w->value_start[g] * s->grid->dim)[i]);
    const Material *material = &s->materials[s->points->material[p]];
    const PetscReal share = s->c->stabilisation.curvature * (1 - filled) * s->points->real[POINT_VOLUME][p];
    s->soft[g] = share * material->wave_modulus * square / (PetscReal)nn;
    if (s->pressure_tie) s->pressure_tie[g] = share / material->elastic.shear;
  }
  PetscCall(PetscFree(reached));
  PetscFunctionReturn(0);
}
