/* The critical substep, by a bound of the highest frequency (docs/theory.md, section 30).
 *
 * A point in the middle of its cell gives the strain of the cell's axes a frequency of at most
 *
 *   omega^2 = 4 / rho_0 * the largest eigenvalue of (c_aabb + tau_aa delta_ab) / (h_a h_b),
 *
 * with the tangent c of its law against Kirchhoff stress; waves ride on the point, and the cell is that of the grid,
 * which stays as it is. That eigenvalue is below the trace, which is a wave along each axis at a time, and below the
 * largest sum of a row, which for a cube of an isotropic material it is. */
#include "grid/box/box.h"
#include "model/explicit/explicit.h"

typedef struct {
  int axes;       /* along which cells strain */
  PetscReal h[3]; /* the smallest side along each, m */
  PetscReal sum;  /* of 1 / h^2, 1/m2 */
  PetscBool box;  /* are cells rectangles or bricks? */
} Sides;

/* Of a cell of any shape, 1/m2: n times the sum of the squares of its gradients over four, which for bricks is that of
 * 1 / h^2. Slanted and pointed cells have more than their sides tell. */
static PetscReal sum_of_cell(const Grid *grid, PetscInt cell)
{
  const CellType type = grid_cell_type(grid, cell);
  const Cell *kind = grid_cell(grid, cell);
  PetscReal x[3 * CELL_MAX_NODES], middle[3] = {0, 0, 0}, N[CELL_MAX_NODES], dN[3 * CELL_MAX_NODES], sum = 0;
  for (PetscInt I = 0; I < kind->nodes; ++I)
    for (PetscInt d = 0; d < kind->dim; ++d) middle[d] += kind->reference[I][d] / (PetscReal)kind->nodes;
  grid_cell_x(grid, cell, x);
  (void)cell_gradients(type, x, middle, N, dN);
  for (PetscInt i = 0; i < kind->nodes * kind->dim; ++i) sum += dN[i] * dN[i];
  return 0.25 * (PetscReal)kind->nodes * sum;
}

static void sides_of_box(const GridBox *box, PetscInt dim, Sides *sides)
{
  sides->box = PETSC_TRUE;
  for (PetscInt d = 0; d < dim; ++d) {
    sides->h[d] = PETSC_MAX_REAL;
    for (PetscInt i = 0; i < box->counts[d]; ++i)
      sides->h[d] = PetscMin(sides->h[d], box->line[d][i + 1] - box->line[d][i]);
    sides->sum += 1 / PetscSqr(sides->h[d]);
  }
}

static PetscErrorCode FindSides(const Model *m, Sides *sides)
{
  const Grid *grid = m->grid;
  PetscReal most = 0;

  PetscFunctionBeginUser;
  *sides = (Sides){.axes = kinematics_is_plane(m->c->kinematics) ? 2 : 3};
  if (grid->box && grid->nodes_per_cell == (m->dim == 2 ? 4 : 8)) {
    sides_of_box(grid->box, m->dim, sides);
    PetscFunctionReturn(0);
  }
  for (PetscInt cell = 0; cell < grid->n_cells; ++cell) most = PetscMax(most, sum_of_cell(grid, cell));
  PetscCall(MPIU_Allreduce(&most, &sides->sum, 1, MPIU_REAL, MPIU_MAX, m->comm));
  PetscFunctionReturn(0);
}

/* The largest sum of a row, 1/s2: of the law as it is now, and not below that of its elasticity. */
static PetscReal largest_row(const Material *material, const Sides *sides, const PetscReal tau[6],
                             const PetscReal c[36])
{
  const PetscReal across = material->wave_modulus - 2 * material->elastic.shear;
  PetscReal largest = 0;
  for (int a = 0; a < sides->axes; ++a) {
    PetscReal now = 0, elastic = 0;
    for (int b = 0; b < sides->axes; ++b) {
      const PetscReal area = sides->h[a] * sides->h[b];
      now += PetscAbsReal(c[6 * a + b]) / area;
      elastic += (a == b ? material->wave_modulus : PetscAbsReal(across)) / area;
    }
    largest = PetscMax(largest, PetscMax(now, elastic) + PetscMax(tau[a], 0) / PetscSqr(sides->h[a]));
  }
  return largest / material->density;
}

/* The modulus of the fastest wave along an axis. */
static PetscReal stiffest(const Material *material, int axes, const PetscReal tau[6], const PetscReal c[36])
{
  PetscReal most = material->wave_modulus;
  for (int a = 0; a < axes; ++a)
    most = PetscMax(most, PetscMax(c[7 * a], material->wave_modulus) + PetscMax(tau[a], 0));
  return most;
}

/* Points off the middle of their cells bring higher frequencies, at nodes that they hardly reach. `musl` bears them;
 * `usl` does not, nor do grains beside springs of walls, nor what is near an axis: there the trace is kept. */
static PetscBool trusts_rows(const Model *m, const Sides *sides)
{
  return (PetscBool)(sides->box && m->c->analysis.update == EXPLICIT_MUSL && !m->c->kinematics->hoop && !m->contact);
}

/* Of a point, 1/s: half of the highest frequency as the trace bounds it, and the better of both bounds. */
static void frequencies(const Model *m, const Sides *sides, const Material *material, const PetscReal tau[6],
                        const PetscReal c[36], PetscReal *trace, PetscReal *least)
{
  const PetscReal square = stiffest(material, sides->axes, tau, c) / material->density * sides->sum;
  const PetscReal row = trusts_rows(m, sides) ? largest_row(material, sides, tau, c) : square;
  *trace = PetscSqrtReal(square);
  *least = PetscSqrtReal(PetscMin(row, square));
}

/* Of n points of one material. Point by point, for ranks not to matter. */
static void tangents(const Model *m, PetscInt first, PetscInt n, PetscReal *tau, PetscReal *c)
{
  static const PetscReal one[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const Material *material = &m->materials[m->points->material[first]];
  const PetscInt n_state = material->law->n_state, stride = m->points->components[POINT_STATE];
  PetscReal dF[9 * LAW_BATCH], old[LAW_MAX_STATE * LAW_BATCH], state[LAW_MAX_STATE * LAW_BATCH];
  for (PetscInt k = 0; k < n; ++k) {
    for (int i = 0; i < 9; ++i) dF[9 * k + i] = one[i];
    for (PetscInt s = 0; s < n_state; ++s)
      old[k * n_state + s] = m->points->real[POINT_STATE][(first + k) * stride + s];
  }
  law_update_in(material->law, m->c->kinematics)(material->parameters, n, dF, old, state, tau, c);
}

PetscErrorCode ExplicitCritical(const Model *m, PetscReal *critical, PetscReal *crossing, PetscReal *fastest)
{
  PetscReal tau[6 * LAW_BATCH], c[36 * LAW_BATCH], local[3] = {0, 0, 0}, all[3], trace, least;
  Sides sides;

  PetscFunctionBeginUser;
  PetscCall(FindSides(m, &sides));
  for (PetscInt p = 0, n; p < m->points->n; p += n) {
    n = batch_points(m, p);
    tangents(m, p, n, tau, c);
    for (PetscInt k = 0; k < n; ++k) {
      const PetscReal *v = point_real(m->points, POINT_V, p + k);
      PetscReal square = 0;
      for (PetscInt d = 0; d < m->dim; ++d) square += v[d] * v[d];
      const PetscReal speed = PetscSqrtReal(square), riding = speed * PetscSqrtReal(sides.sum);
      frequencies(m, &sides, &m->materials[m->points->material[p]], tau + 6 * k, c + 36 * k, &trace, &least);
      local[0] = PetscMax(local[0], least + riding);
      local[1] = PetscMax(local[1], trace + riding);
      local[2] = PetscMax(local[2], speed);
    }
  }
  PetscCall(MPIU_Allreduce(local, all, 3, MPIU_REAL, MPIU_MAX, m->comm));
  *critical = all[0] > 0 ? 1 / all[0] : PETSC_MAX_REAL;
  *crossing = all[1] > 0 ? 1 / all[1] : PETSC_MAX_REAL;
  *fastest = all[2];
  PetscFunctionReturn(0);
}
