/* Loads on the surface of a body whose points have domains: the functions that these see are means over them, so the
 * force of a uniform stress at a node is the integral of the node's linear function over the surface of all domains.
 * Loads balance it to the last digit only if they are integrated as well. So a carrier stands for a piece of the
 * surface, x + s e (+ t e'), and N are means over the box with its second moments along the axes, as those of points
 * are; of a ring by the radius (docs/theory.md, "Pieces of a surface").
 *
 * Pieces beside each other have the ends of their edges in common. These move with the linear functions at the ends,
 * so that they stay in common: dN . e is half the difference of the functions between them, behind dN stands their
 * mean, M. */
#include "support/products.h"

/* What is less than this of one is round-off. */
#define NOTHING 1e-14

/* Of the nodes first .. first + n - 1 along an axis: means over the piece, and the functions at ends of edges, forwards
 * and backwards. */
typedef struct {
  PetscInt first, n, next; /* the node next to the piece, among these */
  PetscReal N[3], dN[3], end[2][2][3];
} Axis;

typedef struct {
  PetscInt dim;
  PetscReal part[2];    /* of each edge, that these nodes know */
  PetscReal dual[2][3]; /* of the edges: dual . edge is 1 for the same one, 0 for the other */
  const PetscReal *x, *edge;
  Axis axis[3];
} Piece;

/* Half length along the axis of the box with the piece's second moments; no more than half a cell. */
static PetscReal half_length(const Piece *p, PetscInt d, PetscReal size)
{
  PetscReal square = 0;
  for (PetscInt k = 0; k + 1 < p->dim; ++k) square += PetscSqr(p->edge[k * p->dim + d]);
  return PetscMin(PetscSqrtReal(square), 0.5 * size);
}

static void find_means(const GridBox *box, const ProductPlace *place, PetscBool hoop, PetscInt d, Piece *p)
{
  const PetscReal *line = box->line[d], l = half_length(p, d, place->size[d]);
  const PetscInt i = place->ijk[d], j = nearest_line(line, i, p->x[d]);
  LineFunctions f = gimp_line(line, i, box->counts[d], p->x[d], l);
  Axis *a = p->axis + d;
  a->first = PetscMax(j - 1, 0);
  a->n = PetscMin(j + 1, box->counts[d]) - a->first + 1;
  a->next = j - a->first;
  for (PetscInt k = 0; hoop && d == 0 && k < f.n; ++k) f.N[k] += p->x[0] > 0 ? f.lean[k] / p->x[0] : 0;
  for (PetscInt k = 0; k < 3; ++k) a->N[k] = a->dN[k] = 0;
  for (PetscInt k = 0; k < f.n; ++k) {
    a->N[f.first - a->first + k] = f.N[k];
    a->dN[f.first - a->first + k] = f.dN[k];
  }
}

/* As much of an edge as lies among nodes that its piece knows; at the ends of the box the field goes on. */
static void find_part(const GridBox *box, PetscInt k, Piece *p)
{
  p->part[k] = 1;
  for (PetscInt d = 0; d < p->dim; ++d) {
    const PetscReal e = PetscAbsReal(p->edge[k * p->dim + d]);
    const PetscInt last = p->axis[d].first + p->axis[d].n - 1;
    if (p->axis[d].first > 0) p->part[k] = PetscMin(p->part[k], (p->x[d] - box->line[d][p->axis[d].first]) / e);
    if (last < box->counts[d]) p->part[k] = PetscMin(p->part[k], (box->line[d][last] - p->x[d]) / e);
  }
}

static void linear_at(const PetscReal *line, const Axis *a, PetscReal x, PetscReal N[3])
{
  PetscInt i = x < line[a->first + a->next] ? a->next - 1 : a->next;
  i = PetscMax(0, PetscMin(i, a->n - 2));
  const LineFunctions f = linear_functions(line, a->first + i, x);
  for (PetscInt k = 0; k < 3; ++k) N[k] = k == i ? f.N[0] : k == i + 1 ? f.N[1] : 0;
}

static PetscReal dot(PetscInt dim, const PetscReal *a, const PetscReal *b)
{
  PetscReal sum = 0;
  for (PetscInt d = 0; d < dim; ++d) sum += a[d] * b[d];
  return sum;
}

/* Edges of no length, those of forces at points, have none. */
static void find_duals(Piece *p)
{
  const PetscInt dim = p->dim;
  const PetscReal *e = p->edge, aa = dot(dim, e, e), bb = dim == 3 ? dot(3, e + 3, e + 3) : 1,
                  ab = dim == 3 ? dot(3, e, e + 3) : 0, det = aa * bb - ab * ab;
  for (PetscInt d = 0; d < dim; ++d) {
    p->dual[0][d] = det > 0 ? (bb * e[d] - (dim == 3 ? ab * e[3 + d] : 0)) / det : 0;
    p->dual[1][d] = det > 0 && dim == 3 ? (aa * e[3 + d] - ab * e[d]) / det : 0;
  }
}

static Piece find_piece(const BasisInput *in, const Points *carriers, PetscInt c, const ProductPlace *place)
{
  const GridBox *box = in->grid->box;
  Piece p = {.dim = box->dim, .x = point_real(carriers, POINT_X, c), .edge = point_real(carriers, POINT_EDGE, c)};
  for (PetscInt d = 0; d < p.dim; ++d) find_means(box, place, in->hoop, d, &p);
  for (PetscInt k = 0; k + 1 < p.dim; ++k) {
    find_part(box, k, &p);
    for (PetscInt d = 0; d < p.dim; ++d)
      for (int back = 0; back < 2; ++back)
        linear_at(box->line[d], &p.axis[d], p.x[d] + (back ? -1 : 1) * p.part[k] * p.edge[k * p.dim + d],
                  p.axis[d].end[k][back]);
  }
  find_duals(&p);
  return p;
}

/* N, and behind dN the mean of N at the ends, of the node at these places along the axes; PETSC_FALSE: the piece does
 * not see it. */
static PetscBool see(const Piece *p, const PetscInt at[3], PetscReal *N, PetscReal dN[4])
{
  const PetscInt dim = p->dim, edges = dim - 1;
  PetscReal largest = 0, change[2];
  *N = 1;
  dN[dim] = 0;
  for (PetscInt d = 0; d < dim; ++d) *N *= p->axis[d].N[at[d]];
  for (PetscInt d = 0; d < dim; ++d) {
    dN[d] = p->axis[d].dN[at[d]];
    for (PetscInt e = 0; e < dim; ++e) dN[d] *= e == d ? 1 : p->axis[e].N[at[e]];
  }
  for (PetscInt k = 0; k < edges; ++k) {
    PetscReal end[2] = {1, 1};
    for (int back = 0; back < 2; ++back) {
      for (PetscInt d = 0; d < dim; ++d) end[back] *= p->axis[d].end[k][back][at[d]];
      largest = PetscMax(largest, PetscAbsReal(end[back]));
      dN[dim] += end[back] / (PetscReal)(2 * edges);
    }
    change[k] = (end[0] - end[1]) / (2 * p->part[k]) - dot(dim, dN, p->edge + k * dim);
  }
  for (PetscInt k = 0; k < edges; ++k)
    for (PetscInt d = 0; d < dim; ++d) dN[d] += change[k] * p->dual[k][d];
  return (PetscBool)(largest > NOTHING || PetscAbsReal(*N) > NOTHING);
}

/* Behind those that the support has. Nodes ascend. */
static PetscInt add_piece(const GridBox *box, const ProductPlace *place, const Piece *p, PetscInt *node, PetscReal *N,
                          PetscReal *dN)
{
  const PetscInt width = p->dim + 1;
  PetscInt n = 0, all = 1, at[3] = {0, 0, 0};
  for (PetscInt d = 0; d < p->dim; ++d) all *= p->axis[d].n;
  for (PetscInt q = 0; q < all; ++q) {
    PetscInt ijk[LATTICE] = {0, 0, 0, place->ijk[LATTICE - 1]}, k = n;
    PetscReal here, slopes[4];
    for (PetscInt d = 0; d < p->dim; ++d) ijk[d] = p->axis[d].first + at[d];
    if (see(p, at, &here, slopes)) {
      const PetscInt which = box_node(box, ijk);
      for (; k > 0 && node[k - 1] > which; --k) {
        node[k] = node[k - 1];
        N[k] = N[k - 1];
        for (PetscInt d = 0; d < width; ++d) dN[k * width + d] = dN[(k - 1) * width + d];
      }
      node[k] = which;
      N[k] = here;
      for (PetscInt d = 0; d < width; ++d) dN[k * width + d] = slopes[d];
      ++n;
    }
    for (PetscInt d = 0; d < p->dim && ++at[d] == p->axis[d].n; ++d) at[d] = 0;
  }
  return n;
}

PetscErrorCode PiecesSupport(const BasisInput *in, const Points *carriers, Support *s)
{
  const GridBox *box = in->grid->box;
  const PetscInt most = product_nodes(box->dim, GIMP_LINE) * carriers->n;
  PetscInt n = 0, c = 0;

  PetscFunctionBeginUser;
  PetscCall(SupportReserve(s, carriers->n, most, most, box->dim + 1));
  for (; c < carriers->n && carriers->cell[c] >= 0; ++c) {
    const ProductPlace place = product_place(in->grid, carriers->cell[c]);
    const Piece piece = find_piece(in, carriers, c, &place);
    product_group(s, c, n);
    n += add_piece(box, &place, &piece, s->node + n, s->N + n, s->dN + n * (box->dim + 1));
  }
  products_end(s, c, n);
  PetscFunctionReturn(0);
}
