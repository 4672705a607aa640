/* Segments and triangles become a surface that can be asked: pseudonormals, rims, a tree of
 * boxes. */
#include "wall/facets/facets.h"
#include <math.h>

static PetscErrorCode FacetsCreate(PetscInt dim, PetscInt n, PetscInt n_vertices, PetscInt n_edges, Facets **facets)
{
  Facets *f;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&f));
  f->dim = dim, f->n = n, f->n_vertices = n_vertices, f->n_edges = n_edges;
  PetscCall(PetscCalloc1(n, &f->corner));
  PetscCall(PetscCalloc1(n, &f->normal));
  PetscCall(PetscCalloc1(n, &f->vertex));
  PetscCall(PetscCalloc1(n, &f->edge));
  PetscCall(PetscCalloc1(n_vertices, &f->vertex_normal));
  PetscCall(PetscCalloc1(n_vertices, &f->vertex_rim));
  PetscCall(PetscCalloc1(n_edges, &f->edge_normal));
  PetscCall(PetscCalloc1(n_edges, &f->edge_rim));
  *facets = f;
  PetscFunctionReturn(0);
}

PetscErrorCode FacetsDestroy(Facets **facets)
{
  Facets *f = *facets;

  PetscFunctionBeginUser;
  if (!f) PetscFunctionReturn(0);
  PetscCall(PetscFree(f->corner));
  PetscCall(PetscFree(f->normal));
  PetscCall(PetscFree(f->vertex));
  PetscCall(PetscFree(f->edge));
  PetscCall(PetscFree(f->vertex_normal));
  PetscCall(PetscFree(f->vertex_rim));
  PetscCall(PetscFree(f->edge_normal));
  PetscCall(PetscFree(f->edge_rim));
  PetscCall(BoxTreeDestroy(&f->tree));
  PetscCall(FarFieldDestroy(&f->far));
  PetscCall(PetscFree(*facets));
  PetscFunctionReturn(0);
}

static PetscErrorCode PlantTree(Facets *f)
{
  PetscReal(*bounds)[6];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(f->n, &bounds));
  for (int d = 0; d < 3; ++d) f->bounds[d] = PETSC_MAX_REAL, f->bounds[d + 3] = -PETSC_MAX_REAL;
  for (PetscInt i = 0; i < f->n; ++i) {
    box_around(3, f->dim, (const PetscReal *)f->corner[i], bounds[i]);
    for (int d = 0; d < 3; ++d) {
      f->bounds[d] = PetscMin(f->bounds[d], bounds[i][d]);
      f->bounds[d + 3] = PetscMax(f->bounds[d + 3], bounds[i][d + 3]);
    }
  }
  PetscCall(BoxTreeCreate(f->n, bounds, &f->tree));
  PetscFunctionReturn(0);
}

static void normalise(PetscReal v[3])
{
  const PetscReal length = PetscSqrtReal(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  for (int d = 0; d < 3 && length > 0; ++d) v[d] /= length;
}

static void add_scaled(PetscReal factor, const PetscReal a[3], PetscReal sum[3])
{
  for (int d = 0; d < 3; ++d) sum[d] += factor * a[d];
}

static PetscReal signed_area(PetscInt n, const PetscReal *v)
{
  PetscReal area = 0;
  for (PetscInt i = 0, j = n - 1; i < n; j = i++) area += 0.5 * (v[2 * j] * v[2 * i + 1] - v[2 * i] * v[2 * j + 1]);
  return area;
}

/* Segments from vertex[first[i]] to vertex[last[i]], without those of no length or on the axis. */
static PetscInt choose_segments(PetscInt n, const PetscReal *v, PetscBool closed, PetscBool axis, PetscInt (*ends)[2])
{
  const PetscBool clockwise = closed && signed_area(n, v) < 0;
  PetscInt count = 0, from = 0;
  for (PetscInt i = 1; i < n + (closed ? 1 : 0); ++i) {
    const PetscInt to = i % n;
    const PetscReal *a = v + 2 * from, *b = v + 2 * to;
    if (a[0] == b[0] && a[1] == b[1]) continue;
    ends[count][0] = clockwise ? to : from;
    ends[count][1] = clockwise ? from : to;
    count += !(axis && a[0] <= 0 && b[0] <= 0);
    from = to;
  }
  return count;
}

/* Corners where one segment ends alone are a rim; on an axis of symmetry its mirror image goes
 * on. */
static void finish_corners(Facets *f, const PetscReal *v, const PetscInt *met, PetscBool axis)
{
  for (PetscInt k = 0; k < f->n_vertices; ++k) {
    const PetscBool mirrored = axis && v[2 * k] <= 0;
    f->vertex_rim[k] = met[k] == 1 && !mirrored;
    if (mirrored) f->vertex_normal[k][0] = 0;
    normalise(f->vertex_normal[k]);
  }
}

PetscErrorCode FacetsOfLine(PetscInt n, const PetscReal *v, PetscBool closed, PetscBool axis, Facets **facets)
{
  PetscInt(*ends)[2], *met;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(n, &ends, n, &met));
  const PetscInt count = choose_segments(n, v, closed, axis, ends);
  PetscCall(FacetsCreate(2, count, n, 0, facets));
  for (PetscInt i = 0; i < count; ++i) {
    Facets *f = *facets;
    for (int k = 0; k < 2; ++k) {
      f->vertex[i][k] = ends[i][k];
      for (int d = 0; d < 2; ++d) f->corner[i][k][d] = v[2 * ends[i][k] + d];
      ++met[ends[i][k]];
    }
    f->normal[i][0] = f->corner[i][1][1] - f->corner[i][0][1];
    f->normal[i][1] = f->corner[i][0][0] - f->corner[i][1][0];
    normalise(f->normal[i]);
    for (int k = 0; k < 2; ++k) add_scaled(1, f->normal[i], f->vertex_normal[ends[i][k]]);
  }
  finish_corners(*facets, v, met, axis);
  PetscCall(PetscFree2(ends, met));
  PetscCall(PlantTree(*facets));
  PetscFunctionReturn(0);
}

/* The angle of a triangle at corner k. */
static PetscReal corner_angle(const PetscReal corner[3][3], int k)
{
  PetscReal a[3], b[3], cross[3], along = 0, across = 0;
  for (int d = 0; d < 3; ++d) {
    a[d] = corner[(k + 1) % 3][d] - corner[k][d];
    b[d] = corner[(k + 2) % 3][d] - corner[k][d];
    along += a[d] * b[d];
  }
  for (int d = 0; d < 3; ++d) {
    cross[d] = a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3];
    across += cross[d] * cross[d];
  }
  return atan2(PetscSqrtReal(across), along);
}

static void take_triangle(Facets *f, PetscInt i, const PetscReal *x, const PetscInt vertex[3], const PetscInt edge[3],
                          const PetscReal normal[3], PetscInt *met)
{
  for (int k = 0; k < 3; ++k) {
    f->vertex[i][k] = vertex[k];
    f->edge[i][k] = edge[k];
    f->normal[i][k] = normal[k];
    for (int d = 0; d < 3; ++d) f->corner[i][k][d] = x[3 * vertex[k] + d];
  }
  for (int k = 0; k < 3; ++k) {
    add_scaled(corner_angle((const PetscReal(*)[3])f->corner[i], k), normal, f->vertex_normal[vertex[k]]);
    add_scaled(1, normal, f->edge_normal[edge[k]]);
    ++met[edge[k]];
  }
}

PetscErrorCode FacetsOfTriangles(PetscInt n_vertices, const PetscReal *x, PetscInt n, PetscInt (*vertex)[3],
                                 PetscInt n_edges, PetscInt (*edge)[3], PetscReal (*normal)[3], Facets **facets)
{
  PetscInt *met;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n_edges, &met));
  PetscCall(FacetsCreate(3, n, n_vertices, n_edges, facets));
  Facets *f = *facets;
  for (PetscInt i = 0; i < n; ++i) take_triangle(f, i, x, vertex[i], edge[i], normal[i], met);
  for (PetscInt i = 0; i < n; ++i)
    for (int k = 0; k < 3; ++k) {
      if (met[edge[i][k]] != 1) continue;
      f->edge_rim[edge[i][k]] = PETSC_TRUE;
      f->vertex_rim[vertex[i][k]] = f->vertex_rim[vertex[i][(k + 1) % 3]] = PETSC_TRUE;
    }
  for (PetscInt k = 0; k < n_vertices; ++k) normalise(f->vertex_normal[k]);
  for (PetscInt k = 0; k < n_edges; ++k) normalise(f->edge_normal[k]);
  PetscCall(PetscFree(met));
  PetscCall(PlantTree(f));
  PetscCall(FarFieldCreate(f));
  PetscFunctionReturn(0);
}
