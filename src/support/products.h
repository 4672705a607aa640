/* Shape functions of a box that are products of functions along its axes: what gimp and bspline have in common. */
#pragma once
#include "grid/box/box.h"
#include "support/basis.h"

/* Nodes along an axis, of gimp at most, of splines at most, and in space of these. */
#define GIMP_LINE 3
#define SPLINE_LINE 4
#define PRODUCT_MOST_NODES 64

/* Nodes first .. first + n - 1 along an axis. What rings add, times the radius: moment to dN, lean to the N that slopes
 * along the other axis have as a factor. */
typedef struct {
  PetscInt first, n;
  PetscReal N[SPLINE_LINE], dN[SPLINE_LINE], moment[SPLINE_LINE], lean[SPLINE_LINE];
} LineFunctions;

/* Where a point is: the voxel of its cell, and the cell's lengths. */
typedef struct {
  PetscInt ijk[LATTICE];
  PetscReal size[3];
} ProductPlace;

/* Of the cell i alone, at x. */
static inline LineFunctions linear_functions(const PetscReal *line, PetscInt i, PetscReal x)
{
  const PetscReal h = line[i + 1] - line[i], t = (x - line[i]) / h;
  return (LineFunctions){.first = i, .n = 2, .N = {1 - t, t}, .dN = {-1 / h, 1 / h}};
}

/* The node of the cell i next to x. */
static inline PetscInt nearest_line(const PetscReal *line, PetscInt i, PetscReal x)
{
  return x - line[i] < line[i + 1] - x ? i : i + 1;
}

ProductPlace product_place(const Grid *grid, PetscInt cell);
/* Half lengths (dim) of the box with the second moments of the point's domain, that F has made a
 * parallelogram of the one at the start: l_d^2 = sum_k F_dk^2 L_k^2. No more than half a cell. */
void product_domain(const Points *points, PetscInt p, const PetscReal *size, PetscReal *l);
/* The nodes of a point, ascending, with N and dN, nn x dim; returns how many. A ring weighs what lies
 * farther out more: at radius > 0, dN = dN + moment / radius along x, and along y N = N + lean / radius counts. */
PetscInt product_functions(const GridBox *box, const ProductPlace *place, PetscReal radius, LineFunctions *f,
                           PetscInt *node, PetscReal *N, PetscReal *dN);
/* Basis.bends of products: `along` are second derivatives along each axis of what its functions are. */
PetscInt product_bends(const GridBox *box, const ProductPlace *place, const LineFunctions *f,
                       const PetscReal along[3][SPLINE_LINE], PetscInt *node, PetscReal *bend);
/* gimp.c. Those of point p, wherever its cell has been left. */
PetscInt gimp_functions(const GridBox *box, PetscBool hoop, const Points *points, PetscInt p, const ProductPlace *place,
                        PetscInt *node, PetscReal *N, PetscReal *dN);
/* gimp.c. The linear functions of a box along axis line, averaged over so much to both sides of x, in cell i of n. */
LineFunctions gimp_line(const PetscReal *line, PetscInt i, PetscInt n, PetscReal x, PetscReal l);
/* pieces.c; Basis.carry. */
PetscErrorCode PiecesSupport(const BasisInput *in, const Points *carriers, Support *support);
/* In a box, with so many along an axis. */
static inline PetscInt product_nodes(PetscInt dim, PetscInt line)
{
  return dim == 2 ? line * line : line * line * line;
}

/* Room for groups of single points, which then come one after the other, with at most so many nodes along an axis. */
PetscErrorCode ProductsReserve(const Points *points, PetscInt dim, PetscInt line, Support *support);
/* Point p, whose functions stand behind the n numbers that there are, has nn of them. */
static inline void product_group(Support *s, PetscInt p, PetscInt n)
{
  s->point_start[p] = p;
  s->node_start[p] = s->value_start[p] = n;
}
/* No more points: n_groups of them have n numbers. */
void products_end(Support *support, PetscInt n_groups, PetscInt n);
/* The nodes from so many lines below one to so many above it, itself among them; of the sides of the box there are
 * fewer. */
PetscInt nodes_around(const GridBox *box, const PetscInt at[LATTICE], PetscInt below, PetscInt above, PetscInt *node);
/* Basis.couplings of gimp: a point sees the nodes around the corner of its cell next to it, never farther apart
 * than two cells. */
PetscErrorCode ProductsCouplings(const BasisInput *in, const BasisSites *sites, NodeGroups *groups);
