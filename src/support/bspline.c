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

/* A point that stood for more than this of a cell to each side at the start, for a whole one as a rule, sees splines at
 * its place: with means, nodes would have motions that strain no point. */
#define WIDE 0.375

/* Do splines end along axis d at the node with these voxel lines? */
static PetscBool ends_here(const BasisInput *in, const PetscInt at[LATTICE], PetscInt d)
{
  const GridBox *box = in->grid->box;
  if (at[d] == 0 || at[d] == box->counts[d]) return PETSC_TRUE;
  return in->rim && in->rim[box_node(box, at)] >> d & 1;
}

/* At x, next to node j. */
static LineFunctions spline_functions(const PetscReal *line, PetscInt j, PetscReal x)
{
  const PetscReal h = line[j + 1] - line[j], s = (x - line[j]) / h;
  return (LineFunctions){.first = j - 1,
                         .n = 3,
                         .N = {0.5 * PetscSqr(0.5 - s), 0.75 - s * s, 0.5 * PetscSqr(0.5 + s)},
                         .dN = {(s - 0.5) / h, -2 * s / h, (s + 0.5) / h}};
}

/* Those at x that hold next to node at[d], in cell i or, past a side of the box, as they go on from there. */
static LineFunctions functions_next_to(const BasisInput *in, const PetscInt at[LATTICE], PetscInt d, PetscInt i,
                                       PetscReal x)
{
  const GridBox *box = in->grid->box;
  if (!ends_here(in, at, d)) return spline_functions(box->line[d], at[d], x);
  return linear_functions(box->line[d], PetscMax(0, PetscMin(i, box->counts[d] - 1)), x);
}

/* How functions bend, of three or, where they are linear, of two nodes. */
static PetscReal second_difference(const LineFunctions *f, PetscInt k, PetscReal h)
{
  return f->n == 3 ? (k == 1 ? -2 : 1) / (h * h) : 0;
}

/* At a place: of carriers, tracers and points that stand for much. Of rings whose points have parts of 2 l along the
 * radius the sum of r dN + N is the integral with moment = N'' l^2 / 2, as long as these lie between knots. */
static LineFunctions functions_at(const BasisInput *in, const ProductPlace *place, const PetscInt at[LATTICE],
                                  PetscInt d, PetscReal x, PetscReal l)
{
  const PetscReal beyond = x - in->grid->box->line[d][at[d]] - 0.5 * place->size[d];
  const PetscBool bends = (in->hoop && d == 0) || beyond < -ON_KNOT * place->size[d];
  if (!bends) return linear_functions(in->grid->box->line[d], place->ijk[d], x);
  LineFunctions f = functions_next_to(in, at, d, place->ijk[d], x);
  for (PetscInt k = 0; k < f.n; ++k) f.moment[k] = 0.5 * second_difference(&f, k, place->size[d]) * l * l;
  return f;
}

/* To means over a domain about x of functions f, which hold in a part of it, so long of all and `half` to both sides
 * of its middle. */
static void add_part(const LineFunctions *f, PetscReal weight, PetscReal middle, PetscReal half, PetscReal h,
                     LineFunctions *mean)
{
  for (PetscInt k = 0; k < f->n; ++k) {
    const PetscInt q = f->first + k - mean->first;
    const PetscReal bend = second_difference(f, k, h) * half * half;
    mean->N[q] += weight * (f->N[k] + bend / 6);
    mean->dN[q] += weight * f->dN[k];
    mean->moment[q] += weight * (middle * f->dN[k] + bend / 3);
    mean->n = PetscMax(mean->n, q + 1);
  }
}

/* Means over l to both sides of x, no more than half a cell: half cell by half cell, in which functions are quadratic,
 * slivers with what is beside them. */
static LineFunctions functions_over(const BasisInput *in, const ProductPlace *place, const PetscInt around[LATTICE],
                                    PetscInt d, PetscReal x, PetscReal l)
{
  const PetscReal h = place->size[d], start = in->grid->box->line[d][place->ijk[d]], end = x + l;
  LineFunctions mean = {.first = PETSC_MAX_INT};
  PetscReal from = x - l;
  for (PetscInt k = -1; k <= 2; ++k) {
    PetscReal to = PetscMin(start + 0.5 * (PetscReal)(k + 1) * h, end);
    if (end - to < ON_KNOT * h) to = end;
    if (to - from < ON_KNOT * h) continue;
    PetscInt at[LATTICE];
    for (PetscInt e = 0; e < LATTICE; ++e) at[e] = around[e];
    at[d] = place->ijk[d] + (k > 0);
    const PetscReal middle = 0.5 * (from + to);
    const LineFunctions f = functions_next_to(in, at, d, place->ijk[d] + (k + 2) / 2 - 1, middle);
    mean.first = PetscMin(mean.first, f.first);
    add_part(&f, (to - from) / (2 * l), middle - x, 0.5 * (to - from), h, &mean);
    from = to;
  }
  return mean;
}

/* Half lengths of what the point stands for; 0: it is a place. */
static void half_lengths(const Points *points, PetscInt p, const PetscReal *size, PetscReal l[3])
{
  for (PetscInt d = 0; d < 3; ++d) l[d] = 0;
  if (points->components[POINT_DOMAIN]) product_domain(points, p, size, l);
}

static PetscBool has_means(const Points *points, PetscInt p, const PetscReal *size, PetscInt d)
{
  if (!points->components[POINT_DOMAIN]) return PETSC_FALSE;
  const PetscReal start = point_real(points, POINT_DOMAIN, p)[d];
  return (PetscBool)(start > ON_KNOT * size[d] && start < WIDE * size[d]);
}

static void nodes_next_to(const BasisInput *in, const PetscReal *x, const ProductPlace *place, PetscInt at[LATTICE])
{
  const GridBox *box = in->grid->box;
  for (PetscInt d = 0; d < LATTICE; ++d)
    at[d] = d < box->dim ? nearest_line(box->line[d], place->ijk[d], x[d] - ON_KNOT * place->size[d]) : place->ijk[d];
}

/* What the point sees along each axis. */
static void axis_functions(const BasisInput *in, const Points *points, PetscInt p, const ProductPlace *place,
                           LineFunctions f[3])
{
  const PetscReal *x = point_real(points, POINT_X, p);
  PetscReal l[3] = {0};
  PetscInt at[LATTICE];
  half_lengths(points, p, place->size, l);
  nodes_next_to(in, x, place, at);
  for (PetscInt d = 0; d < 3 && d < in->grid->dim; ++d)
    f[d] = has_means(points, p, place->size, d) ? functions_over(in, place, at, d, x[d], l[d])
                                                : functions_at(in, place, at, d, x[d], l[d]);
}

static PetscErrorCode BsplineSupport(const BasisInput *in, const Points *points, Support *s)
{
  const GridBox *box = in->grid->box;
  ProductPlace place = {.size = {0}};
  LineFunctions f[3];
  PetscInt n = 0, p = 0;

  PetscFunctionBeginUser;
  PetscCall(ProductsReserve(points, box->dim, SPLINE_LINE, s));
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

/* Functions at x, of the nodes of f. */
static void add_functions(const BasisInput *in, const ProductPlace *place, const PetscInt at[LATTICE], PetscInt d,
                          PetscReal x, const LineFunctions *f, PetscReal sum[SPLINE_LINE])
{
  PetscInt i = place->ijk[d], next[LATTICE];
  const PetscReal *line = in->grid->box->line[d];
  for (PetscInt e = 0; e < LATTICE; ++e) next[e] = at[e];
  next[d] = x < line[i] + 0.5 * place->size[d] ? i : i + 1;
  i += x < line[i] ? -1 : x > line[i + 1] ? 1 : 0;
  const LineFunctions g = functions_next_to(in, next, d, i, x);
  for (PetscInt k = 0; k < g.n; ++k)
    if (g.first + k >= f->first && g.first + k < f->first + f->n) sum[g.first + k - f->first] += g.N[k];
}

static PetscInt bspline_bends(const BasisInput *in, const Points *points, PetscInt p, PetscInt *node, PetscReal *bend)
{
  const ProductPlace place = product_place(in->grid, points->cell[p]);
  const PetscReal *x = point_real(points, POINT_X, p);
  LineFunctions f[3];
  PetscReal l[3], along[3][SPLINE_LINE] = {{0}};
  PetscInt at[LATTICE];
  half_lengths(points, p, place.size, l);
  nodes_next_to(in, x, &place, at);
  axis_functions(in, points, p, &place, f);
  for (PetscInt d = 0; d < in->grid->dim; ++d) {
    if (!has_means(points, p, place.size, d)) {
      for (int k = 0; k < f[d].n; ++k) along[d][k] = second_difference(&f[d], k, place.size[d]);
      continue;
    }
    for (int side = -1; side <= 1; side += 2) add_functions(in, &place, at, d, x[d] + side * l[d], &f[d], along[d]);
    for (int k = 0; k < f[d].n; ++k) along[d][k] = (along[d][k] - 2 * f[d].N[k]) / (l[d] * l[d]);
  }
  return product_bends(in->grid->box, &place, f, along, node, bend);
}

/* A point sees the nodes of its cell, and those one farther. */
static PetscErrorCode BsplineCouplings(const BasisInput *in, const BasisSites *sites, NodeGroups *groups)
{
  PetscInt node[PRODUCT_MOST_NODES], cell[LATTICE];

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < in->grid->n_cells; ++c) {
    if (!sites->cell[c]) continue;
    box_voxel_of(in->grid, c, cell);
    PetscCall(NodeGroupsAdd(groups, nodes_around(in->grid->box, cell, 1, 2, node), node));
  }
  PetscFunctionReturn(0);
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
  .across = SPLINE_LINE - 1,
  .domains = PETSC_TRUE,
  .ends_at_held = PETSC_TRUE,
  .holds_boundary = PETSC_TRUE,
  .carries = PETSC_TRUE,
  .has_places = PETSC_TRUE,
  .misfit = bspline_misfit,
  .support = BsplineSupport,
  .bends = bspline_bends,
  .couplings = BsplineCouplings,
};
