#include "support/products.h"
#include <petscbt.h>
#include "base/math/tensor.h"

#define UNROLLED static inline __attribute__((always_inline))

ProductPlace product_place(const Grid *grid, PetscInt cell)
{
  const GridBox *box = grid->box;
  ProductPlace place = {.size = {0}};
  box_voxel_of(grid, cell, place.ijk);
  box_voxel_size(box, place.ijk, place.size);
  return place;
}

void product_domain(const Points *points, PetscInt p, const PetscReal *size, PetscReal *l)
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

/* In rings: slopes along the radius with those of its own weight, and what functions are in slopes along the others. */
UNROLLED void lean(PetscReal radius, LineFunctions *f, PetscReal leaning[SPLINE_LINE])
{
  for (PetscInt i = 0; i < f->n; ++i) leaning[i] = f->N[i];
  for (PetscInt i = 0; radius > 0 && i < f->n; ++i) {
    f->dN[i] += f->moment[i] / radius;
    leaning[i] += f->lean[i] / radius;
  }
}

/* The nodes of a rank do not count as they stand in space: they are put in order by insertion, as groups of single
 * points want them. Returns the place of the k-th to come. */
UNROLLED PetscInt make_room(const PetscInt dim, PetscInt k, PetscInt here, PetscInt *node, PetscReal *N, PetscReal *dN)
{
  for (; k > 0 && node[k - 1] > here; --k) {
    node[k] = node[k - 1];
    N[k] = N[k - 1];
    for (PetscInt d = 0; d < dim; ++d) dN[k * dim + d] = dN[(k - 1) * dim + d];
  }
  return k;
}

UNROLLED PetscInt functions_of(const PetscInt dim, const GridBox *box, const ProductPlace *place, PetscReal radius,
                               LineFunctions *f, PetscInt *node, PetscReal *N, PetscReal *dN)
{
  PetscInt n = 1, at[3] = {0, 0, 0};
  PetscReal leaning[SPLINE_LINE];
  lean(radius, f, leaning);
  for (PetscInt d = 0; d < dim; ++d) n *= f[d].n;
  for (PetscInt q = 0; q < n; ++q) {
    PetscInt ijk[LATTICE] = {0, 0, 0, place->ijk[LATTICE - 1]};
    PetscReal product = 1, gradient[3];
    for (PetscInt d = 0; d < dim; ++d) {
      ijk[d] = f[d].first + at[d];
      product *= f[d].N[at[d]];
    }
    for (PetscInt d = 0; d < dim; ++d) {
      gradient[d] = f[d].dN[at[d]];
      for (PetscInt e = 0; e < dim; ++e) gradient[d] *= e == d ? 1 : e == 0 ? leaning[at[0]] : f[e].N[at[e]];
    }
    const PetscInt here = box_node(box, ijk), k = make_room(dim, q, here, node, N, dN);
    node[k] = here;
    N[k] = product;
    for (PetscInt d = 0; d < dim; ++d) dN[k * dim + d] = gradient[d];
    for (PetscInt d = 0; d < dim && ++at[d] == f[d].n; ++d) at[d] = 0;
  }
  return n;
}

PetscInt product_functions(const GridBox *box, const ProductPlace *place, PetscReal radius, LineFunctions *f,
                           PetscInt *node, PetscReal *N, PetscReal *dN)
{
  if (box->dim == 2) return functions_of(2, box, place, radius, f, node, N, dN);
  return functions_of(3, box, place, radius, f, node, N, dN);
}

PetscInt product_bends(const GridBox *box, const ProductPlace *place, const LineFunctions *f,
                       const PetscReal along[3][SPLINE_LINE], PetscInt *node, PetscReal *bend)
{
  PetscReal N[PRODUCT_MOST_NODES], dN[3 * PRODUCT_MOST_NODES];
  PetscInt n = 0;
  for (PetscInt d = 0; d < box->dim; ++d) {
    LineFunctions bent[3] = {f[0], f[1], box->dim == 3 ? f[2] : f[1]};
    for (int k = 0; k < SPLINE_LINE; ++k) bent[d].N[k] = along[d][k];
    n = product_functions(box, place, 0, bent, node, N, dN);
    for (PetscInt k = 0; k < n; ++k) bend[k * box->dim + d] = N[k];
  }
  return n;
}

PetscErrorCode ProductsReserve(const Points *points, PetscInt dim, PetscInt line, Support *support)
{
  const PetscInt most = product_nodes(dim, line);
  PetscFunctionBeginUser;
  PetscCall(SupportReserve(support, points->n, most * points->n, most * points->n, dim));
  PetscFunctionReturn(0);
}

void products_end(Support *s, PetscInt n_groups, PetscInt n)
{
  product_group(s, n_groups, n);
  s->n_groups = n_groups;
  s->n_runs = 0;
}

PetscInt nodes_around(const GridBox *box, const PetscInt at[LATTICE], PetscInt below, PetscInt above, PetscInt *node)
{
  VoxelBlock around;
  PetscInt n = 0, ijk[LATTICE];
  for (int d = 0; d < LATTICE; ++d) {
    around.lo[d] = d < box->dim ? PetscMax(at[d] - below, 0) : at[d];
    around.hi[d] = 1 + (d < box->dim ? PetscMin(at[d] + above, box->counts[d]) : at[d]);
  }
  for (PetscBool more = block_first(&around, ijk); more; more = block_next(&around, ijk))
    node[n++] = box_node(box, ijk);
  return n;
}

PetscErrorCode ProductsCouplings(const BasisInput *in, const BasisSites *sites, NodeGroups *groups)
{
  const GridBox *box = in->grid->box;
  PetscInt node[PRODUCT_MOST_NODES], at[LATTICE], cell[LATTICE];
  PetscBT done;

  PetscFunctionBeginUser;
  PetscCall(PetscBTCreate(in->grid->n_nodes, &done));
  for (PetscInt c = 0; c < in->grid->n_cells; ++c) {
    if (!sites->cell[c]) continue;
    box_voxel_of(in->grid, c, cell);
    for (PetscInt corner = 0; corner < 1 << box->dim; ++corner) {
      for (PetscInt d = 0; d < LATTICE; ++d) at[d] = cell[d] + (d < box->dim ? corner >> d & 1 : 0);
      if (!PetscBTLookupSet(done, box_node(box, at)))
        PetscCall(NodeGroupsAdd(groups, nodes_around(box, at, 1, 1, node), node));
    }
  }
  PetscCall(PetscBTDestroy(&done));
  PetscFunctionReturn(0);
}
