/* Implicit material point method (thesis algorithm 1): a fixed grid, restored after every step. */
#include "method/extend/extend.h"
#include "method/method.h"
#include "method/transfer/loops.h"
#include "method/transfer/mass.h"
#include "method/transfer/transfer.h"
#include "points/split.h"

/* q_I = sum N m v, f_I = sum N m a (eqs. 2.6-2.9), and what the transfer makes of them. Explicit dynamics gathers
 * in its substeps: what nodes get here is only looked at, and solving for it took more time than the substeps. */
static PetscErrorCode Project(Discretisation *s)
{
  const Transfer *transfer = s->c->analysis.type == ANALYSIS_EXPLICIT ? transfers[0] : s->transfer;
  NodalFields *n = s->nodes;
  const PetscInt dofs = s->grid->n_nodes * s->grid->dim;

  PetscFunctionBeginUser;
  mass_rows_forget(s->mass_rows);
  PetscCall(transfer->gather(s));
  PetscCall(PetscArraycpy(n->v, n->v_points, dofs));
  PetscCall(PetscArraycpy(n->a, n->a_points, dofs));
  PetscFunctionReturn(0);
}

/* The least mass of a corner of the cell, beside what it would get if points were spread evenly.
 * Two regular points a direction give each corner a quarter of that in the plane and an eighth in
 * space, wherever they stand: that counts as 1. */
UNROLLED PetscReal emptiest_of(const PetscInt nn, const Support *w, PetscInt g, const PetscReal *point_mass,
                               PetscReal mass)
{
  PetscReal corner[CELL_MAX_NODES] = {0}, least = mass;
  for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p)
    for (PetscInt I = 0; I < nn; ++I) corner[I] += support_N(w, g, p)[I] * point_mass[p];
  for (PetscInt I = 0; I < nn; ++I) least = PetscMin(least, corner[I]);
  return (PetscReal)(nn * nn) * least / mass;
}

static PetscReal emptiest_corner(const Support *w, PetscInt g, const PetscReal *point_mass, PetscReal mass)
{
  return support_nodes(w, g) == 4 ? emptiest_of(4, w, g, point_mass, mass) : emptiest_of(8, w, g, point_mass, mass);
}

/* Of a cell, whose nodes stand where they stood in the last step. */
static PetscReal volume_of(Discretisation *s, PetscInt cell)
{
  PetscReal x[3 * CELL_MAX_NODES];
  if (s->volume[cell] > 0) return s->volume[cell];
  grid_cell_x(s->grid, cell, x);
  return s->volume[cell] = cell_volume_in(s->c->kinematics, grid_cell_type(s->grid, cell), x);
}

static PetscReal length_of(Discretisation *s, PetscInt cell)
{
  PetscReal x[3 * CELL_MAX_NODES];
  if (s->grid->dim == 3) return cbrt(volume_of(s, cell));
  grid_cell_x(s->grid, cell, x);
  return PetscSqrtReal(cell_volume(grid_cell_type(s->grid, cell), x));
}

static PetscErrorCode ReserveStabilisation(Discretisation *s)
{
  PetscFunctionBeginUser;
  if (!s->volume) PetscCall(PetscCalloc1(s->grid->n_cells, &s->volume));
  if (s->support->n_groups <= s->group_capacity) PetscFunctionReturn(0);
  PetscCall(PetscFree(s->lumping));
  PetscCall(PetscFree(s->soft));
  PetscCall(PetscFree(s->tie));
  s->group_capacity = s->support->n_groups + s->support->n_groups / 4;
  PetscCall(PetscMalloc1(s->group_capacity, &s->lumping));
  PetscCall(PetscMalloc1(s->group_capacity, &s->soft));
  PetscCall(PetscMalloc1(s->group_capacity, &s->tie));
  PetscCall(PetscFree(s->pressure_tie));
  if (s->nodes->pressure) PetscCall(PetscMalloc1(s->group_capacity, &s->pressure_tie));
  PetscFunctionReturn(0);
}

/* A cell that its points fill only partly leaves motions of its nodes without stiffness and mass,
 * and so does a quadrilateral or hexahedron whose points stand on a line or at one side, however
 * many they are. In the measure in which it is not full, part of its mass is lumped and its nodes
 * are tied by a weak stiffness and a little inertia (docs/theory.md, "Cells that are not full").
 * Where each point of a cell is a group of its own, they share that. */
static PetscErrorCode Stabilise(Discretisation *s)
{
  const Support *w = s->support;
  const PetscInt dim = s->grid->dim;
  const PetscBool whole = w->n_runs > 0;

  PetscFunctionBeginUser;
  PetscCall(ReserveStabilisation(s));
  for (PetscInt g = 0, end; g < w->n_groups; g = end) {
    const PetscInt cell = s->points->cell[w->point_start[g]];
    PetscReal filled = 0, modulus = 0, shear = 0, mass = 0;
    for (end = g; end < w->n_groups && s->points->cell[w->point_start[end]] == cell; ++end)
      for (PetscInt p = w->point_start[end]; p < w->point_start[end + 1]; ++p) {
        filled += PetscMin(1, s->points->real[POINT_J][p]) * s->points->real[POINT_VOLUME][p];
        mass += s->points->real[POINT_MASS][p];
        modulus = PetscMax(modulus, s->materials[s->points->material[p]].wave_modulus);
        shear = PetscMax(shear, s->materials[s->points->material[p]].elastic.shear);
      }
    const PetscReal volume = volume_of(s, cell), share = 1 / (PetscReal)(end - g);
    const PetscBool hourglass = whole && grid_cell(s->grid, cell)->nodes > dim + 1;
    const PetscReal corner = hourglass ? emptiest_corner(w, g, s->points->real[POINT_MASS], mass) : 1;
    const PetscReal lack = PetscMax(0, 1 - PetscMin(filled / volume, corner));
    const PetscReal size = lack > 0 ? length_of(s, cell) : 1;
    for (PetscInt k = g; k < end; ++k) {
      s->lumping[k] = s->c->analysis.mass == MASS_LUMPED ? 1 : s->c->stabilisation.mass * lack;
      s->tie[k] = whole ? s->c->stabilisation.inertia * lack * mass : 0;
      s->soft[k] = share * s->c->stabilisation.stiffness * lack * modulus * volume / (size * size);
      if (s->pressure_tie) s->pressure_tie[k] = s->c->stabilisation.stiffness * lack * volume / shear;
    }
  }
  PetscFunctionReturn(0);
}

/* Nodes, N and dN of the points; which of them follow others. */
static PetscErrorCode See(Discretisation *s)
{
  BasisInput basis = {.spec = &s->c->basis, .grid = s->grid, .hoop = s->c->kinematics->hoop};

  PetscFunctionBeginUser;
  if (s->basis->ends_at_held) {
    if (!s->rim) PetscCall(PetscMalloc1(s->grid->n_nodes, &s->rim));
    PetscCall(BoundaryRims(s->boundary, s->grid, s->rim));
    basis.rim = s->rim;
  }
  PetscCall(s->basis->support(&basis, s->points, s->support));
  if (s->basis->domains) PetscCall(DiscretisationExtend(s, &basis));
  PetscFunctionReturn(0);
}

static PetscErrorCode MpmInitialise(Discretisation *s)
{
  PetscFunctionBeginUser;
  PetscCall(PointsSort(s->points));
  PetscCall(See(s));
  PetscCall(DiscretisationTouch(s));
  PetscCall(DiscretisationMass(s));
  PetscCall(Stabilise(s));
  if (s->basis->domains) PetscCall(DiscretisationCuts(s));
  PetscCall(Project(s));
  if (s->nodes->pressure) PetscCall(DiscretisationPressure(s));
  PetscFunctionReturn(0);
}

UNROLLED void move_points(const PetscInt dim, const PetscInt fixed_nn, const SupportRun *run, Discretisation *s)
{
  const Support *w = s->support;
  for (PetscInt g = run->first; g < run->end; ++g) {
    const PetscInt nn = fixed_nn ? fixed_nn : support_nodes(w, g), *node = w->node + w->node_start[g];
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) {
      const PetscReal *N = w->N + w->value_start[g] + (p - w->point_start[g]) * nn;
      PetscReal *x = point_real(s->points, POINT_X, p), *u = point_real(s->points, POINT_U, p);
      for (PetscInt d = 0; d < dim; ++d) {
        PetscReal move = 0;
        for (PetscInt I = 0; I < nn; ++I) move += N[I] * s->nodes->du[node[I] * dim + d];
        x[d] += move;
        u[d] += move;
      }
    }
  }
}

static PetscErrorCode MpmHold(Discretisation *s)
{
  PetscFunctionBeginUser;
  PetscCall(s->transfer->hold(s));
  PetscFunctionReturn(0);
}

/* What is stretched gets more points, before they are located. */
static PetscErrorCode Split(Discretisation *s)
{
  PetscBool *opens;
  PetscInt n;

  PetscFunctionBeginUser;
  if (s->c->basis.split == 0) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(s->c->n_materials, &opens));
  for (PetscInt i = 0; i < s->c->n_materials; ++i) opens[i] = s->materials[i].law->yields;
  const SplitRule rule = {.cells = s->c->basis.split, .hoop = s->c->kinematics->hoop, .opens = opens};
  PetscCall(PointsSplit(s->points, s->grid, &rule, &n));
  PetscCall(PetscFree(opens));
  PetscFunctionReturn(0);
}

static PetscErrorCode MpmConvect(Discretisation *s)
{
  LostPoint *ignored;
  PetscInt n_ignored;

  PetscFunctionBeginUser;
  PetscCall(s->transfer->give(s));
  WITH_SIZES(move_points, s, s);
  PetscCall(DiscretisationMoveCarried(s, s->tracers));
  PetscCall(DiscretisationMoveCarried(s, s->loads->carriers));
  PetscCall(PetscFree(s->lost));
  PetscCall(Split(s));
  PetscCall(PointsRelocate(s->points, s->grid, s->c->grid.outside, &s->n_lost, &s->lost));
  PetscCall(PointsRelocate(s->tracers, s->grid, OUTSIDE_KEEP, &n_ignored, &ignored));
  PetscCall(PetscFree(ignored));
  PetscCall(PointsRelocate(s->loads->carriers, s->grid, OUTSIDE_KEEP, &n_ignored, &ignored));
  PetscCall(PetscFree(ignored));
  PetscFunctionReturn(0);
}

const Method method_mpm = {
  .name = "mpm",
  .help = "material point method: points carry the material through a fixed grid",
  .bases = {"gimp", "cell"},
  .restores_grid = PETSC_TRUE,
  .takes_pressure = PETSC_TRUE,
  .initialise = MpmInitialise,
  .hold = MpmHold,
  .convect = MpmConvect,
  .carries = cell_carries,
};
