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
#include "base/math/tensor.h"
#include "grid/box/box.h"
#include "support/basis.h"

/* A kink nearer to the domain's end than this part of a cell counts as outside: domains that end at
 * a node, as those of whole cells do, must not reach beyond it by a last digit. */
#define SLIVER 1e-10

/* Nodes first .. first + n - 1 along an axis. moment: mean of (x - x_p) dN. */
typedef struct {
  PetscInt first, n;
  PetscReal N[3], dN[3], moment[3];
} LineFunctions;

static LineFunctions linear_functions(const PetscReal *line, PetscInt i, PetscReal x)
{
  const PetscReal h = line[i + 1] - line[i], t = (x - line[i]) / h;
  return (LineFunctions){.first = i, .n = 2, .N = {1 - t, t}, .dN = {-1 / h, 1 / h}};
}

/* At x in cell i of n, with half length l. */
static LineFunctions line_functions(const PetscReal *line, PetscInt i, PetscInt n, PetscReal x, PetscReal l)
{
  const PetscInt j = x - line[i] < line[i + 1] - x ? i : i + 1;
  const PetscReal s = x - line[j];
  if (j == 0 || j == n || PetscAbsReal(s) > l - SLIVER * (line[i + 1] - line[i])) return linear_functions(line, i, x);
  const PetscReal below = line[j] - line[j - 1], above = line[j + 1] - line[j];
  const PetscReal first = (l - s) / (2 * l), last = (l + s) / (2 * l), moment = (l * l - s * s) / (4 * l);
  const PetscReal a = 0.5 * first * (l - s) / below, b = 0.5 * last * (l + s) / above;
  return (LineFunctions){.first = j - 1,
                         .n = 3,
                         .N = {a, 1 - a - b, b},
                         .dN = {-first / below, first / below - last / above, last / above},
                         .moment = {moment / below, -moment / below - moment / above, moment / above}};
}

/* Half lengths of the box with the second moments of the point's domain, that F has made a
 * parallelogram of the one at the start: l_d^2 = sum_k F_dk^2 L_k^2. No more than half a cell. */
static void domain_now(const Points *points, PetscInt p, const PetscReal *size, PetscReal *l)
{
  const PetscInt dim = points->dim;
  const PetscReal *start = point_real(points, POINT_DOMAIN, p);
  PetscReal F[9];
  point_F(points, p, F);
  for (PetscInt d = 0; d < dim; ++d) {
    PetscReal square = 0;
    for (PetscInt k = 0; k < dim; ++k) square += PetscSqr(F[3 * d + k] * start[k]);
    const PetscReal length = PetscSqrtReal(square);
    l[d] = length < 0.5 * size[d] ? length : 0.5 * size[d];
  }
}

/* A ring weighs what lies farther out more: with dN = mean of r dN / r_p uniform stress is balanced
 * over it. */
static void weigh_ring(PetscReal radius, LineFunctions *f)
{
  for (PetscInt i = 0; i < f->n; ++i) f->dN[i] += f->moment[i] / radius;
}

/* What a point sees along each axis; returns how many nodes that are together. field: whose they are. */
static PetscInt axis_functions(const BasisInput *in, const Points *points, PetscInt p, LineFunctions f[3],
                               PetscInt *field)
{
  const GridBox *box = in->grid->box;
  const PetscReal *x = point_real(points, POINT_X, p);
  PetscInt ijk[3], n = 1;
  PetscReal size[3] = {0}, l[3] = {0};
  box_voxel_of(in->grid, points->cell[p], ijk);
  *field = box->dim == 2 ? ijk[2] : 0;
  for (PetscInt d = 0; d < box->dim; ++d) size[d] = box->line[d][ijk[d] + 1] - box->line[d][ijk[d]];
  domain_now(points, p, size, l);
  for (PetscInt d = 0; d < box->dim; ++d) {
    f[d] = line_functions(box->line[d], ijk[d], box->counts[d], x[d], l[d]);
    n *= f[d].n;
  }
  if (in->hoop) weigh_ring(x[0], &f[0]);
  return n;
}

/* Products over the axes. The nodes of a rank do not count as they stand in space: they are put in
 * order by insertion, as groups of single points want them. */
static void point_functions(const GridBox *box, const LineFunctions f[3], PetscInt field, PetscInt n, PetscInt *node,
                            PetscReal *N, PetscReal *dN)
{
  const PetscInt dim = box->dim;
  for (PetscInt q = 0; q < n; ++q) {
    PetscInt at[3], ijk[3] = {0, 0, field}, k = q;
    PetscReal product = 1, gradient[3];
    for (PetscInt d = 0, rest = q; d < dim; rest /= f[d++].n) {
      at[d] = rest % f[d].n;
      ijk[d] = f[d].first + at[d];
      product *= f[d].N[at[d]];
    }
    for (PetscInt d = 0; d < dim; ++d) {
      gradient[d] = f[d].dN[at[d]];
      for (PetscInt e = 0; e < dim; ++e) gradient[d] *= e == d ? 1 : f[e].N[at[e]];
    }
    const PetscInt here = box_node(box, ijk);
    for (; k > 0 && node[k - 1] > here; --k) {
      node[k] = node[k - 1];
      N[k] = N[k - 1];
      for (PetscInt d = 0; d < dim; ++d) dN[k * dim + d] = dN[(k - 1) * dim + d];
    }
    node[k] = here;
    N[k] = product;
    for (PetscInt d = 0; d < dim; ++d) dN[k * dim + d] = gradient[d];
  }
}

static PetscErrorCode GimpSupport(const BasisInput *in, const Points *points, Support *s)
{
  const PetscInt dim = in->grid->dim, most = dim == 2 ? 9 : 27;
  LineFunctions f[3];
  PetscInt n = 0, p = 0, field;

  PetscFunctionBeginUser;
  PetscCheck(points->components[POINT_DOMAIN] == dim, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "points without domains");
  PetscCall(SupportReserve(s, points->n, most * points->n, most * points->n, dim));
  for (; p < points->n && points->cell[p] >= 0; ++p) {
    const PetscInt nn = axis_functions(in, points, p, f, &field);
    s->point_start[p] = p;
    s->node_start[p] = s->value_start[p] = n;
    point_functions(in->grid->box, f, field, nn, s->node + n, s->N + n, s->dN + n * dim);
    n += nn;
  }
  s->n_groups = s->point_start[p] = p;
  s->node_start[p] = s->value_start[p] = n;
  s->n_runs = 0;
  PetscFunctionReturn(0);
}

/* A point anywhere in a cell sees the cell's nodes and those around them. */
static PetscErrorCode GimpCouplings(const BasisInput *in, const BasisSites *sites, NodeGroups *groups)
{
  const GridBox *box = in->grid->box;
  PetscInt node[64], lo[3] = {0, 0, 0}, hi[3] = {0, 0, 0}, ijk[3];

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < in->grid->n_cells; ++c) {
    PetscInt n = 0;
    if (!sites->cell[c]) continue;
    box_voxel_of(in->grid, c, ijk);
    lo[2] = hi[2] = ijk[2];
    for (PetscInt d = 0; d < box->dim; ++d) {
      lo[d] = PetscMax(ijk[d] - 1, 0);
      hi[d] = PetscMin(ijk[d] + 2, box->counts[d]);
    }
    for (ijk[2] = lo[2]; ijk[2] <= hi[2]; ++ijk[2])
      for (ijk[1] = lo[1]; ijk[1] <= hi[1]; ++ijk[1])
        for (ijk[0] = lo[0]; ijk[0] <= hi[0]; ++ijk[0]) node[n++] = box_node(box, ijk);
    PetscCall(NodeGroupsAdd(groups, n, node));
  }
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
  .domains = PETSC_TRUE,
  .holds_boundary = PETSC_TRUE,
  .misfit = gimp_misfit,
  .support = GimpSupport,
  .couplings = GimpCouplings,
};
