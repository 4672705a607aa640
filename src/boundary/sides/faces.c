#include "boundary/sides/faces.h"
#include "boundary/sides/cut_sides.h"
#include "boundary/sides/side_keys.h"

/* Position on a face from its own coordinates: edges s in [-1, 1], triangles (s, t) barycentric,
 * quadrilaterals [-1, 1]^2. */
static void face_shape(PetscInt face_nodes, PetscReal s, PetscReal t, PetscReal N[4], PetscReal dN[8])
{
  if (face_nodes == 2) {
    N[0] = (1 - s) / 2, N[1] = (1 + s) / 2;
    dN[0] = -0.5, dN[1] = 0.5, dN[2] = dN[3] = 0;
  } else if (face_nodes == 3) {
    N[0] = 1 - s - t, N[1] = s, N[2] = t;
    dN[0] = -1, dN[1] = 1, dN[2] = 0;
    dN[3] = -1, dN[4] = 0, dN[5] = 1;
  } else {
    const PetscReal a[4] = {-1, 1, 1, -1}, b[4] = {-1, -1, 1, 1};
    for (int i = 0; i < 4; ++i) {
      N[i] = (1 + a[i] * s) * (1 + b[i] * t) / 4;
      dN[i] = a[i] * (1 + b[i] * t) / 4;
      dN[4 + i] = b[i] * (1 + a[i] * s) / 4;
    }
  }
}

/* Length or area per unit of the face's own coordinates, along the normal: nodes of a face turn around the
 * one that leads out. */
static void face_normal(PetscInt dim, PetscInt nf, PetscReal x[4][3], const PetscReal dN[8], PetscReal n[3])
{
  PetscReal u[3] = {0, 0, 0}, v[3] = {0, 0, dim == 2};
  for (PetscInt i = 0; i < nf; ++i)
    for (PetscInt d = 0; d < dim; ++d) {
      u[d] += dN[i] * x[i][d];
      if (dim == 3) v[d] += dN[nf + i] * x[i][d];
    }
  for (int d = 0; d < 3; ++d) n[d] = u[(d + 1) % 3] * v[(d + 2) % 3] - u[(d + 2) % 3] * v[(d + 1) % 3];
}

/* Of a piece `part` of the face's own coordinates long, from its middle. */
static void face_edges(PetscInt dim, PetscInt nf, PetscReal x[4][3], const PetscReal *dN, PetscReal part,
                       PetscReal edge[2][3])
{
  for (PetscInt j = 0; j < 2; ++j)
    for (int d = 0; d < 3; ++d) {
      edge[j][d] = 0;
      for (PetscInt i = 0; d < dim && i < nf; ++i) edge[j][d] += part * dN[j * nf + i] * x[i][d];
    }
}

/* Points at g to both sides of the middle, in the face's own coordinates. */
static PetscInt face_points(const Kinematics *kinematics, const Grid *grid, PetscInt cell, PetscInt side, PetscReal g,
                            FacePoint *q)
{
  static const PetscReal third[3][2] = {{1. / 6, 1. / 6}, {2. / 3, 1. / 6}, {1. / 6, 2. / 3}};
  const PetscReal square[4][2] = {{-g, -g}, {g, -g}, {g, g}, {-g, g}};
  const Cell *type = grid_cell(grid, cell);
  const PetscInt nf = type->face_nodes, *node = grid->cell_node + cell * grid->nodes_per_cell;
  PetscReal x[4][3], N[4], dN[8];

  for (PetscInt i = 0; i < nf; ++i)
    for (PetscInt d = 0; d < grid->dim; ++d) x[i][d] = grid->x[node[type->face[side][i]] * grid->dim + d];
  for (PetscInt k = 0; k < nf; ++k) {
    const PetscReal s = nf == 2 ? (k ? g : -g) : nf == 3 ? third[k][0] : square[k][0];
    const PetscReal t = nf == 2 ? 0 : nf == 3 ? third[k][1] : square[k][1];
    face_shape(nf, s, t, N, dN);
    for (int d = 0; d < 3; ++d) {
      q[k].x[d] = q[k].xi[d] = 0;
      if (d >= grid->dim) continue;
      for (PetscInt i = 0; i < nf; ++i) {
        q[k].x[d] += N[i] * x[i][d];
        q[k].xi[d] += N[i] * type->reference[type->face[side][i]][d];
      }
    }
    const PetscReal weight = (nf == 3 ? 1. / 6 : 1) * kinematics_weight(kinematics, q[k].x[0]);
    PetscReal *n = q[k].vector;
    face_edges(grid->dim, nf, x, dN, 1 - g, q[k].edge);
    face_normal(grid->dim, nf, x, dN, n);
    for (int d = 0; d < 3; ++d) n[d] *= weight;
    q[k].area = PetscSqrtReal(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  }
  return nf;
}

PetscInt face_quadrature(const Kinematics *kinematics, const Grid *grid, PetscInt cell, PetscInt side, FacePoint *q)
{
  const PetscInt n = face_points(kinematics, grid, cell, side, 0.57735026918962576451, q);
  for (PetscInt k = 0; k < n; ++k)
    for (int d = 0; d < 3; ++d) q[k].edge[0][d] = q[k].edge[1][d] = 0;
  return n;
}

PetscInt face_pieces(const Kinematics *kinematics, const Grid *grid, PetscInt cell, PetscInt side, FacePoint *q)
{
  return face_points(kinematics, grid, cell, side, 0.5, q);
}

static PetscBool face_selected(const Grid *grid, const Selector *on, const PetscInt *node, PetscInt nf,
                               const PetscInt *face)
{
  const PetscReal tolerance = 1e-9 * PetscMax(grid->max[0] - grid->min[0], grid->max[1] - grid->min[1]);
  for (PetscInt i = 0; i < nf; ++i) {
    const PetscReal *x = grid->x + node[face[i]] * grid->dim;
    for (PetscInt d = 0; d < grid->dim; ++d)
      if (on->has[d] && (x[d] < on->min[d] - tolerance || x[d] > on->max[d] + tolerance)) return PETSC_FALSE;
    if (on->has_shape && !shape_contains(&on->shape, grid->dim, x, tolerance)) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

PetscErrorCode BodyFaces(const Grid *grid, const Points *points, PetscInt body, const Selector *on, PetscBool cut,
                         PetscInt *n, PetscInt **cell, PetscInt **side)
{
  PetscBool *inside;
  PetscInt size = 0, n_all, *keys, *all;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(grid->n_cells, &inside));
  for (PetscInt p = 0; p < points->n; ++p)
    if (points->body[p] == body && points->cell[p] >= 0 && !inside[points->cell[p]]) {
      inside[points->cell[p]] = PETSC_TRUE;
      size += grid_cell(grid, points->cell[p])->faces;
    }
  PetscCall(PetscMalloc1(SIDE_KEY * size, &keys));
  PetscCall(PetscMalloc1(size, cell));
  PetscCall(PetscMalloc1(size, side));
  *n = 0;
  for (PetscInt c = 0; c < grid->n_cells; ++c) {
    const Cell *type = grid_cell(grid, c);
    const PetscInt *node = grid->cell_node + c * grid->nodes_per_cell;
    for (PetscInt s = 0; inside[c] && s < type->faces; ++s) {
      if (face_selected(grid, on, node, type->face_nodes, type->face[s]) == cut) continue;
      if (cut && side_share(grid, on, c, s) == 0) continue;
      side_key(grid, c, s, keys + SIDE_KEY * *n);
      (*cell)[*n] = c;
      (*side)[(*n)++] = s;
    }
  }
  PetscCall(SideKeysGather(grid->comm, *n, keys, &n_all, &all));
  PetscInt kept = 0;
  for (PetscInt f = 0; f < *n; ++f) {
    if (side_key_count(n_all, all, keys + SIDE_KEY * f) > 1) continue;
    (*cell)[kept] = (*cell)[f];
    (*side)[kept++] = (*side)[f];
  }
  *n = kept;
  if (on->boundary) PetscCall(SidesNamed(grid, on->boundary, n, *cell, *side));
  PetscCall(PetscFree(all));
  PetscCall(PetscFree(inside));
  PetscCall(PetscFree(keys));
  PetscFunctionReturn(0);
}
