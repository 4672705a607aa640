/* Cells whose points do not sum up gradients exactly: a uniform stress is none there. */
#include "model/model_private.h"

/* Largest over smallest volume of a point of gmm. Triangles of Gmsh of one size have up to 2.5, and scatter by 4 %. */
#define UNEVEN 3
#define SKEW 0.05 /* |x0 - x1 + x2 - x3| of a quadrilateral over the root of its area */

/* Points of these rules have the same share of a cell each. */
static PetscBool has_equal_shares(PetscInt points_per_cell)
{
  return points_per_cell == 1 || points_per_cell == 3 || points_per_cell == 4 || points_per_cell == 8;
}

/* Nodes of gmm are where cells were, and the room that a point has is theirs: in rings what it has of their section. */
static PetscErrorCode AdviseUneven(const Model *m, PetscInt b, Diag *diag)
{
  const Points *points = m->points;
  PetscReal range[2] = {-PETSC_MAX_REAL, 0}; /* -smallest, largest */
  char path[64];

  PetscFunctionBeginUser;
  if (!has_equal_shares(m->c->bodies[b].points_per_cell)) PetscFunctionReturn(0);
  for (PetscInt p = 0; p < points->n; ++p) {
    if (points->body[p] != b) continue;
    const PetscReal room =
      points->real[POINT_VOLUME][p] / kinematics_weight(m->c->kinematics, *point_real(points, POINT_X, p));
    range[0] = PetscMax(range[0], -room);
    range[1] = PetscMax(range[1], room);
  }
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, range, 2, MPIU_REAL, MPI_MAX, m->comm));
  if (range[1] <= -UNEVEN * range[0]) PetscFunctionReturn(0);
  PetscSNPrintf(path, sizeof path, "bodies[%d]", (int)b);
  diag_warning(diag, path,
               "nodes of gmm at uneven distances: its points have from %.3g to %.3g m%d, and a uniform stress scatters "
               "from one to the next",
               (double)-range[0], (double)range[1], (int)m->dim);
  diag_hint(
    diag,
    "by 4 to 60 %%, means by 1 to 4 %%: cells of one size and shape lessen it, and fem is exact on the same mesh");
  PetscFunctionReturn(0);
}

/* How far a cell is from a parallelogram; of a hexahedron its bottom and its top. */
static PetscReal skew_of(const Grid *grid, PetscInt cell)
{
  const PetscInt *node = grid->cell_node + cell * grid->nodes_per_cell, dim = grid->dim;
  PetscReal worst = 0;
  for (PetscInt face = 0; face < (dim == 3 ? 2 : 1); ++face) {
    const PetscReal *x[4];
    PetscReal square = 0, sides = 0;
    for (PetscInt i = 0; i < 4; ++i) x[i] = grid->x + node[4 * face + i] * dim;
    for (PetscInt d = 0; d < dim; ++d) {
      square += PetscSqr(x[0][d] - x[1][d] + x[2][d] - x[3][d]);
      sides += PetscSqr(x[2][d] - x[0][d]) + PetscSqr(x[3][d] - x[1][d]);
    }
    worst = PetscMax(worst, PetscSqrtReal(square / (0.25 * sides)));
  }
  return worst;
}

/* Equal shares of a cell are those of the Gauss rule in a parallelogram alone. */
static PetscErrorCode AdviseWeights(const Model *m, PetscInt b, Diag *diag)
{
  const Points *points = m->points;
  PetscReal worst = 0;
  char path[64];

  PetscFunctionBeginUser;
  if (m->c->bodies[b].weights == WEIGHTS_GAUSS || m->grid->nodes_per_cell != (m->dim == 3 ? 8 : 4))
    PetscFunctionReturn(0);
  for (PetscInt p = 0; p < points->n; ++p)
    if (points->body[p] == b && points->cell[p] >= m->grid->n_first)
      worst = PetscMax(worst, skew_of(m->grid, points->cell[p]));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &worst, 1, MPIU_REAL, MPI_MAX, m->comm));
  if (worst < SKEW) PetscFunctionReturn(0);
  PetscSNPrintf(path, sizeof path, "bodies[%d]", (int)b);
  diag_warning(diag, path,
               "points share skew cells equally: a uniform stress is wrong by several per cent at single points");
  diag_hint(
    diag,
    "`weights: gauss` is exact as long as the points stay in their cells; in parallelograms equal shares are, too");
  PetscFunctionReturn(0);
}

PetscErrorCode AdviseCells(const Model *m, Diag *diag)
{
  PetscFunctionBeginUser;
  /* what flows through its cells has no share that is right */
  const PetscBool stays = case_is_static(&m->c->analysis);
  for (PetscInt b = 0; b < m->c->n_bodies; ++b) {
    if (m->method->clouds) PetscCall(AdviseUneven(m, b, diag));
    else if (stays && m->method->restores_grid && !grid_is_aligned(m->grid)) PetscCall(AdviseWeights(m, b, diag));
  }
  PetscFunctionReturn(0);
}
