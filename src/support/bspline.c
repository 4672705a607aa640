/* Quadratic B-splines of the nodes of a box of equal cells (docs/theory.md, "Quadratic B-splines").
 *
 * Along an axis the knots are the middles of the cells, so that each node has a function of its own, its
 * coefficient belongs to its place, and a point sees the node next to it and one on each side: with
 * s = (x - x_j) / h from there
 *
 *   N_(j-1) = (1/2 - s)^2 / 2,  N_j = 3/4 - s^2,  N_(j+1) = (1/2 + s)^2 / 2.
 *
 * At an end of the box the field goes on as it comes: between the end and the middle of its cell it is linear,
 * functions of inner nodes vanish on the end, and prescribed motion is exact there. So it is where a place inside
 * is held, on both sides of the line of nodes at which it ends. */
#include "support/products.h"

/* So near a knot, of a cell, a point stands on it, as the middle of three in a cell does, whatever round-off says: it
 * sees two nodes, since one more on either side has nothing there. In rings these have second derivatives, which jump
 * at knots, and it belongs to the node before it. */
#define ON_KNOT 1e-10

/* Do splines end along axis d at the node with these voxel lines? */
static PetscBool ends_here(const BasisInput *in, const PetscInt at[LATTICE], PetscInt d)
{
  const GridBox *box = in->grid->box;
  if (at[d] == 0 || at[d] == box->counts[d]) return PETSC_TRUE;
  return in->rim && in->rim[box_node(box, at)] >> d & 1;
}

/* At x, next to node j. Of a ring whose points have parts of 2 l along the radius the sum of r dN + N is the
 * integral with moment = N'' l^2 / 2, as long as these lie between knots. */
static LineFunctions spline_functions(const PetscReal *line, PetscInt j, PetscReal x, PetscReal l)
{
  const PetscReal h = line[j + 1] - line[j], s = (x - line[j]) / h, m = 0.5 * PetscSqr(l / h);
  return (LineFunctions){.first = j - 1,
                         .n = 3,
                         .N = {0.5 * PetscSqr(0.5 - s), 0.75 - s * s, 0.5 * PetscSqr(0.5 + s)},
                         .dN = {(s - 0.5) / h, -2 * s / h, (s + 0.5) / h},
                         .moment = {m, -2 * m, m}};
}

/* What the point sees along each axis. */
static void axis_functions(const BasisInput *in, const Points *points, PetscInt p, const ProductPlace *place,
                           LineFunctions f[3])
{
  const GridBox *box = in->grid->box;
  const PetscReal *x = point_real(points, POINT_X, p);
  PetscReal l[3] = {0};
  PetscInt at[LATTICE] = {0, 0, 0, place->ijk[LATTICE - 1]};
  for (PetscInt d = 0; d < box->dim; ++d)
    at[d] = nearest_line(box->line[d], place->ijk[d], x[d] - ON_KNOT * place->size[d]);
  if (in->hoop) product_domain(points, p, place->size, l);
  for (PetscInt d = 0; d < box->dim; ++d) {
    const PetscReal beyond = x[d] - box->line[d][at[d]] - 0.5 * place->size[d];
    const PetscBool bends = (in->hoop && d == 0) || beyond < -ON_KNOT * place->size[d];
    f[d] = bends && !ends_here(in, at, d) ? spline_functions(box->line[d], at[d], x[d], l[d])
                                          : linear_functions(box->line[d], place->ijk[d], x[d]);
  }
}

static PetscErrorCode BsplineSupport(const BasisInput *in, const Points *points, Support *s)
{
  const GridBox *box = in->grid->box;
  ProductPlace place = {.size = {0}};
  LineFunctions f[3];
  PetscInt n = 0, p = 0;

  PetscFunctionBeginUser;
  PetscCall(ProductsReserve(points, box->dim, s));
  for (; p < points->n && points->cell[p] >= 0; ++p) {
    if (!p || points->cell[p] != points->cell[p - 1]) place = product_place(in->grid, points->cell[p]);
    const PetscReal radius = in->hoop ? point_real(points, POINT_X, p)[0] : 0;
    axis_functions(in, points, p, &place, f);
    product_group(s, p, n);
    n += product_functions(box, &place, radius, f, s->node + n, s->N + n, s->dN + n * box->dim);
  }
  products_end(s, p, n);
  PetscFunctionReturn(0);
}

static PetscInt bspline_bends(const BasisInput *in, const Points *points, PetscInt p, PetscInt *node, PetscReal *bend)
{
  const ProductPlace place = product_place(in->grid, points->cell[p]);
  LineFunctions f[3];
  PetscReal along[3][3] = {{0}};
  axis_functions(in, points, p, &place, f);
  for (PetscInt d = 0; d < in->grid->dim; ++d)
    for (int k = 0; k < 3 && f[d].n == 3; ++k) along[d][k] = (k == 1 ? -2 : 1) / PetscSqr(place.size[d]);
  return product_bends(in->grid->box, &place, f, along, node, bend);
}

static const char *bspline_misfit(const GridSpec *grid)
{
  const PetscInt dim = cells[grid->cell].dim;
  if (grid->kind != GRID_BOX || (grid->cell != CELL_QUADRILATERAL && grid->cell != CELL_HEXAHEDRON))
    return "needs a box of quadrilaterals or hexahedra";
  for (PetscInt d = 0; d < dim; ++d)
    if (grid->counts[d] > 1 && grid->grading[d] > 0 && grid->grading[d] != 1)
      return "needs a box without grading: its splines are those of equal cells, gimp takes others";
  return NULL;
}

const Basis basis_bspline = {
  .nodes = BASIS_OF_GRID,
  .halo = 1,
  .domains = PETSC_TRUE,
  .ends_at_held = PETSC_TRUE,
  .holds_boundary = PETSC_TRUE,
  .carries = PETSC_TRUE,
  .has_places = PETSC_TRUE,
  .misfit = bspline_misfit,
  .support = BsplineSupport,
  .bends = bspline_bends,
  .couplings = ProductsCouplings,
};
