/* Generalised interpolation: the linear functions of a box's cells, averaged over each point's
 * domain, a box about the point whose half lengths l follow the deformation (docs/theory.md,
 * "Smooth shape functions").
 *
 * Along an axis a point sees the node j next to it and one on each side. With s from there, only
 * the kink of the linear functions at j can lie in the domain, as long as that reaches no further
 * than half a cell; if it does, |s| < l and
 *
 *   N_(j-1) = (l - s)^2 / (4 l h-),  N_(j+1) = (l + s)^2 / (4 l h+),  N_j = 1 - both,
 *
 * else the linear functions themselves count. At an end of the box the field goes on as it comes,
 * so that there is no kink: functions of inner nodes vanish there, and prescribed motion is exact.
 */
#include "support/products.h"

/* A kink nearer to the domain's end than this part of a cell counts as outside: domains that end at
 * a node, as those of whole cells do, must not reach beyond it by a last digit. */
#define SLIVER 1e-10

/* Of the cell alone. */
static LineFunctions line_in_cell(const PetscReal *line, PetscInt i, PetscReal x, PetscReal l)
{
  LineFunctions f = linear_functions(line, i, x);
  for (PetscInt k = 0; k < 2; ++k) f.lean[k] = f.dN[k] * l * l / 3;
  return f;
}

/* At x in cell i of n, with half length l. moment and lean: means of (x - x_p) dN and (x - x_p) S over the domain, so
 * that over a ring slopes are those of r dN / r_p and uniform stress is balanced. */
LineFunctions gimp_line(const PetscReal *line, PetscInt i, PetscInt n, PetscReal x, PetscReal l)
{
  const PetscInt j = nearest_line(line, i, x);
  const PetscReal s = x - line[j];
  if (j == 0 || j == n || PetscAbsReal(s) > l - SLIVER * (line[i + 1] - line[i])) return line_in_cell(line, i, x, l);
  const PetscReal below = line[j] - line[j - 1], above = line[j + 1] - line[j];
  const PetscReal first = (l - s) / (2 * l), last = (l + s) / (2 * l), moment = (l * l - s * s) / (4 * l);
  const PetscReal a = 0.5 * first * (l - s) / below, b = 0.5 * last * (l + s) / above;
  const PetscReal odd = l * l / 6, even = (s * l - s * s * s / (3 * l)) / 4;
  const PetscReal low = (even - odd) / below, high = (even + odd) / above;
  return (LineFunctions){.first = j - 1,
                         .n = 3,
                         .N = {a, 1 - a - b, b},
                         .dN = {-first / below, first / below - last / above, last / above},
                         .moment = {moment / below, -moment / below - moment / above, moment / above},
                         .lean = {low, -low - high, high}};
}

PetscInt gimp_functions(const GridBox *box, PetscBool hoop, const Points *points, PetscInt p, const ProductPlace *place,
                        PetscInt *node, PetscReal *N, PetscReal *dN)
{
  const PetscReal *x = point_real(points, POINT_X, p);
  PetscReal l[3] = {0};
  LineFunctions f[3];
  product_domain(points, p, place->size, l);
  for (PetscInt d = 0; d < box->dim; ++d) f[d] = gimp_line(box->line[d], place->ijk[d], box->counts[d], x[d], l[d]);
  return product_functions(box, place, hoop ? x[0] : 0, f, node, N, dN);
}

/* Of means whose domain has a kink of the linear functions in it: second differences of these between its ends. */
static void line_bends(const LineFunctions *f, const PetscReal *line, PetscReal x, PetscReal l, PetscReal bend[3])
{
  const PetscReal up = (x + l - line[f->first + 1]) / (line[f->first + 2] - line[f->first + 1]),
                  down = (line[f->first + 1] - x + l) / (line[f->first + 1] - line[f->first]);
  const PetscReal ends[3] = {down, 2 - up - down, up};
  for (int k = 0; k < 3; ++k) bend[k] = (ends[k] - 2 * f->N[k]) / (l * l);
}

/* Of rings, the means at the upper and lower end are those over circles. */
static void lean_ends(const GridBox *box, const ProductPlace *place, const LineFunctions *f, PetscReal radius,
                      PetscReal l, const PetscReal along[SPLINE_LINE], PetscReal *bend)
{
  PetscReal ends[2 * PRODUCT_MOST_NODES], whole[3][SPLINE_LINE] = {{0}};
  PetscInt node[PRODUCT_MOST_NODES];
  LineFunctions leans[2] = {f[0], f[1]};
  for (int k = 0; k < 3; ++k) {
    leans[0].N[k] = f[0].lean[k] / radius;
    whole[1][k] = along[k] + 2 * f[1].N[k] / (l * l);
  }
  const PetscInt n = product_bends(box, place, leans, whole, node, ends);
  for (PetscInt k = 0; k < n; ++k) bend[2 * k + 1] += ends[2 * k + 1];
}

static PetscInt gimp_bends(const BasisInput *in, const Points *points, PetscInt p, PetscInt *node, PetscReal *bend)
{
  const GridBox *box = in->grid->box;
  const ProductPlace place = product_place(in->grid, points->cell[p]);
  const PetscReal *x = point_real(points, POINT_X, p);
  PetscReal l[3] = {0}, along[3][SPLINE_LINE] = {{0}};
  LineFunctions f[3];
  product_domain(points, p, place.size, l);
  for (PetscInt d = 0; d < box->dim; ++d) {
    f[d] = gimp_line(box->line[d], place.ijk[d], box->counts[d], x[d], l[d]);
    if (f[d].n == 3) line_bends(&f[d], box->line[d], x[d], l[d], along[d]);
  }
  const PetscInt n = product_bends(box, &place, f, along, node, bend);
  if (in->hoop) lean_ends(box, &place, f, x[0], l[1], along[1], bend);
  return n;
}

static PetscErrorCode GimpSupport(const BasisInput *in, const Points *points, Support *s)
{
  const GridBox *box = in->grid->box;
  const PetscInt dim = box->dim;
  ProductPlace place = {.size = {0}};
  PetscInt n = 0, p = 0;

  PetscFunctionBeginUser;
  PetscCall(ProductsReserve(points, dim, GIMP_LINE, s));
  for (; p < points->n && points->cell[p] >= 0; ++p) {
    if (!p || points->cell[p] != points->cell[p - 1]) place = product_place(in->grid, points->cell[p]);
    product_group(s, p, n);
    n += gimp_functions(box, in->hoop, points, p, &place, s->node + n, s->N + n, s->dN + n * dim);
  }
  products_end(s, p, n);
  PetscFunctionReturn(0);
}

/* With cells more than twice as large as their neighbours a domain could reach two nodes away. */
static PetscBool graded_gently(const GridSpec *grid)
{
  for (PetscInt d = 0; d < cells[grid->cell].dim; ++d) {
    const PetscReal all = grid->grading[d] > 0 ? PetscAbsReal(PetscLogReal(grid->grading[d])) : 0;
    if (grid->counts[d] > 1 && all > PetscLogReal(2) * (PetscReal)(grid->counts[d] - 1) + 1e-9) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

static const char *gimp_misfit(const GridSpec *grid)
{
  if (grid->kind != GRID_BOX || (grid->cell != CELL_QUADRILATERAL && grid->cell != CELL_HEXAHEDRON))
    return "needs a box of quadrilaterals or hexahedra";
  if (!graded_gently(grid))
    return "needs a box that is not graded too steeply: no cell may be more than twice as long as the next";
  return NULL;
}

const Basis basis_gimp = {
  .nodes = BASIS_OF_GRID,
  .halo = 1,
  .across = GIMP_LINE - 1,
  .domains = PETSC_TRUE,
  .holds_boundary = PETSC_TRUE,
  .misfit = gimp_misfit,
  .carries = PETSC_TRUE,
  .support = GimpSupport,
  .bends = gimp_bends,
  .carry = PiecesSupport,
  .couplings = ProductsCouplings,
};
