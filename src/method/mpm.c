/* Implicit material point method (thesis algorithm 1): a fixed grid, restored after every step. */
#include "method/method.h"

#define UNROLLED static inline __attribute__((always_inline))

/* A loop over the points of each kind of cells, with sizes known to the compiler where that pays;
 * nodes 0: each group has its own. */
#define WITH_SIZES(loop, s)                                                  \
  do {                                                                       \
    const Support *sized = (s)->support;                                     \
    const SupportRun any = {.nodes = 0, .first = 0, .end = sized->n_groups}; \
    const SupportRun *run = sized->n_runs ? sized->run : &any;               \
    for (PetscInt k = 0; k < PetscMax(sized->n_runs, 1); ++k, ++run) {       \
      if ((s)->grid->dim == 2 && run->nodes == 4) loop(2, 4, run, s);        \
      else if ((s)->grid->dim == 3 && run->nodes == 8) loop(3, 8, run, s);   \
      else loop((s)->grid->dim, run->nodes, run, s);                         \
    }                                                                        \
  } while (0)

UNROLLED void gather_motion(const PetscInt dim, const PetscInt fixed_nn, const SupportRun *run, Discretisation *s)
{
  NodalFields *n = s->nodes;
  const Support *w = s->support;
  for (PetscInt g = run->first; g < run->end; ++g) {
    const PetscInt nn = fixed_nn ? fixed_nn : support_nodes(w, g), *node = w->node + w->node_start[g];
    PetscReal momentum[3 * CLOUD_MAX_NODES], force[3 * CLOUD_MAX_NODES];
    for (PetscInt i = 0; i < nn * dim; ++i) momentum[i] = force[i] = 0;
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) {
      const PetscReal *v = point_real(s->points, POINT_V, p), *a = point_real(s->points, POINT_A, p);
      const PetscReal *N = w->N + w->value_start[g] + (p - w->point_start[g]) * nn;
      for (PetscInt I = 0; I < nn; ++I) {
        const PetscReal m = N[I] * s->points->real[POINT_MASS][p];
        for (PetscInt d = 0; d < dim; ++d) {
          momentum[I * dim + d] += m * v[d];
          force[I * dim + d] += m * a[d];
        }
      }
    }
    for (PetscInt I = 0; I < nn; ++I)
      for (PetscInt d = 0; d < dim; ++d) {
        n->v[node[I] * dim + d] += momentum[I * dim + d];
        n->a[node[I] * dim + d] += force[I * dim + d];
      }
  }
}

/* q_I = sum N m v, f_I = sum N m a (eqs. 2.6-2.9). A node so far from all points that its mass
 * vanishes starts at rest: its velocity counts for nothing. */
static PetscErrorCode Project(Discretisation *s)
{
  NodalFields *n = s->nodes;
  const Grid *grid = s->grid;
  const PetscInt dim = grid->dim, dofs = grid->n_nodes * dim;

  PetscFunctionBeginUser;
  PetscCall(DiscretisationMass(s));
  PetscCall(PetscArrayzero(n->v, dofs));
  PetscCall(PetscArrayzero(n->a, dofs));
  WITH_SIZES(gather_motion, s);
  PetscCall(GridSumToOwners(grid, dim, n->v));
  PetscCall(GridSumToOwners(grid, dim, n->a));
  for (PetscInt node = 0; node < grid->n_owned; ++node) {
    if (n->mass[node] == 0) continue;
    const PetscReal inverse = n->mass[node] > 1e-300 ? 1 / n->mass[node] : 0;
    for (PetscInt i = node * dim; i < (node + 1) * dim; ++i) {
      n->v[i] *= inverse;
      n->a[i] *= inverse;
    }
  }
  PetscCall(GridToGhosts(grid, dim, n->v));
  PetscCall(GridToGhosts(grid, dim, n->a));
  PetscCall(PetscArraycpy(n->v_points, n->v, dofs));
  PetscCall(PetscArraycpy(n->a_points, n->a, dofs));
  PetscFunctionReturn(0);
}

/* The least mass of a corner of the cell, beside what it would get if points were spread evenly.
 * Two regular points a direction give each corner a quarter of that in the plane and an eighth in
 * space, wherever they stand: that counts as 1. */
static PetscReal emptiest_corner(const Support *w, PetscInt g, const PetscReal *point_mass, PetscReal mass)
{
  const PetscInt nn = support_nodes(w, g);
  PetscReal corner[CELL_MAX_NODES] = {0}, least = mass;
  for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p)
    for (PetscInt I = 0; I < nn; ++I) corner[I] += support_N(w, g, p)[I] * point_mass[p];
  for (PetscInt I = 0; I < nn; ++I) least = PetscMin(least, corner[I]);
  return (PetscReal)(nn * nn) * least / mass;
}

static PetscErrorCode ReserveStabilisation(Discretisation *s)
{
  PetscFunctionBeginUser;
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
  PetscReal x[3 * CELL_MAX_NODES];

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
    grid_cell_x(s->grid, cell, x);
    const CellType type = grid_cell_type(s->grid, cell);
    const PetscReal volume = cell_volume_in(s->c->kinematics, type, x), share = 1 / (PetscReal)(end - g);
    const PetscBool hourglass = whole && grid_cell(s->grid, cell)->nodes > dim + 1;
    const PetscReal corner = hourglass ? emptiest_corner(w, g, s->points->real[POINT_MASS], mass) : 1;
    const PetscReal lack = PetscMax(0, 1 - PetscMin(filled / volume, corner));
    const PetscReal size = dim == 2 ? PetscSqrtReal(cell_volume(type, x)) : cbrt(volume);
    for (PetscInt k = g; k < end; ++k) {
      s->lumping[k] = s->c->analysis.mass == MASS_LUMPED ? 1 : s->c->stabilisation.mass * lack;
      s->tie[k] = whole ? s->c->stabilisation.inertia * lack * mass : 0;
      s->soft[k] = share * s->c->stabilisation.stiffness * lack * modulus * volume / (size * size);
      if (s->pressure_tie) s->pressure_tie[k] = s->c->stabilisation.stiffness * lack * volume / shear;
    }
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode MpmInitialise(Discretisation *s)
{
  const BasisInput basis = {.spec = &s->c->basis, .grid = s->grid, .hoop = s->c->kinematics->hoop};

  PetscFunctionBeginUser;
  PetscCall(PointsSort(s->points));
  PetscCall(s->basis->support(&basis, s->points, s->support));
  PetscCall(DiscretisationTouch(s));
  PetscCall(Project(s));
  if (s->nodes->pressure) PetscCall(DiscretisationPressure(s));
  PetscCall(Stabilise(s));
  if (s->basis->domains) PetscCall(DiscretisationCuts(s, s->soft));
  PetscFunctionReturn(0);
}

/* Points take the change of the nodes' velocity, measured from what the points had given them:
 * where the boundary stops a node, it stops its points too (eq. 2.16 as printed would let them keep
 * their velocity for ever; docs/theory.md). Rayleigh damping acts on all motion: on what nodes
 * carry through the balance, on the rest of a point's velocity, which no node sees, here. */
UNROLLED void move_points(const PetscInt dim, const PetscInt fixed_nn, const SupportRun *run, Discretisation *s)
{
  const Support *w = s->support;
  const NodalFields *n = s->nodes;
  for (PetscInt g = run->first; g < run->end; ++g) {
    const PetscInt nn = fixed_nn ? fixed_nn : support_nodes(w, g), *node = w->node + w->node_start[g];
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) {
      const PetscReal *N = w->N + w->value_start[g] + (p - w->point_start[g]) * nn;
      PetscReal *x = point_real(s->points, POINT_X, p), *u = point_real(s->points, POINT_U, p);
      PetscReal *v = point_real(s->points, POINT_V, p), *a = point_real(s->points, POINT_A, p);
      for (PetscInt d = 0; d < dim; ++d) {
        PetscReal move = 0, gain = 0, acceleration = 0, seen = 0;
        for (PetscInt I = 0; I < nn; ++I) {
          const PetscInt i = node[I] * dim + d;
          move += N[I] * n->du[i];
          gain += N[I] * (n->v1[i] - n->v_points[i]);
          acceleration += N[I] * n->a1[i];
          seen += N[I] * n->v_points[i];
        }
        x[d] += move;
        u[d] += move;
        v[d] += gain - s->fade * (v[d] - seen);
        a[d] = acceleration;
      }
    }
  }
}

static PetscErrorCode MpmConvect(Discretisation *s)
{
  LostPoint *ignored;
  PetscInt n_ignored;

  PetscFunctionBeginUser;
  WITH_SIZES(move_points, s);
  PetscCall(DiscretisationMoveCarried(s, s->tracers));
  PetscCall(DiscretisationMoveCarried(s, s->loads->carriers));
  PetscCall(PetscFree(s->lost));
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
  .basis = "cell",
  .restores_grid = PETSC_TRUE,
  .takes_pressure = PETSC_TRUE,
  .initialise = MpmInitialise,
  .convect = MpmConvect,
  .carries = cell_carries,
};
