/* Bodies that come, in the cells of a mesh that has moved: they fill them as they are now, undeformed
 * (docs/theory.md, "Stages"). Their points were seeded in the cells as they were drawn, and there stand nodes that are
 * theirs alone: what was in those cells last may have left them anywhere. */
#include "model/stage/stage_private.h"

#define FLATTEST 0.01 /* of a cell's volume anywhere in it: below that it is as good as turned inside out */

static void nodes_of(const Grid *grid, const PetscReal *all, PetscInt cell, PetscReal *x)
{
  const PetscInt nn = grid->nodes_per_cell, dim = grid->dim, *node = grid->cell_node + cell * nn;
  for (PetscInt i = 0; i < nn * dim; ++i) x[i] = all[node[i / dim] * dim + i % dim];
}

/* dx/dX at xi of a cell whose nodes have gone from X to x; returns its determinant. */
static PetscReal map_between(CellType type, PetscInt dim, const PetscReal *X, const PetscReal *x, const PetscReal *xi,
                             PetscReal G[9])
{
  PetscReal N[CELL_MAX_NODES], dN[CELL_MAX_NODES * 3];
  (void)cell_gradients(type, X, xi, N, dN);
  for (int k = 0; k < 9; ++k) G[k] = dim == 2 && k == 8;
  for (PetscInt i = 0; i < cells[type].nodes; ++i)
    for (PetscInt k = 0; k < dim * dim; ++k) G[k / dim * 3 + k % dim] += x[i * dim + k / dim] * dN[i * dim + k % dim];
  return tensor_det(G);
}

/* The smallest share of its volume that the cell has anywhere: at its nodes. */
static PetscReal flattest(CellType type, PetscInt dim, const PetscReal *X, const PetscReal *x)
{
  PetscReal least = PETSC_MAX_REAL, G[9];
  for (PetscInt i = 0; i < cells[type].nodes; ++i)
    least = PetscMin(least, map_between(type, dim, X, x, cells[type].reference[i], G));
  return least;
}

/* Normals of sides, of which the sum is as long as it was: that of one side, and of sides that turn together, is
 * exact. */
static void carry_normals(PetscInt dim, const PetscReal inverse[9], PetscReal *beside)
{
  PetscReal was[3] = {0}, before = 0, now = 0;
  for (PetscInt d = 0; d < dim; ++d) was[d] = beside[d], before += PetscSqr(was[d]);
  for (PetscInt d = 0; d < dim; ++d) {
    beside[d] = inverse[d] * was[0] + inverse[3 + d] * was[1] + inverse[6 + d] * was[2];
    now += PetscSqr(beside[d]);
  }
  for (PetscInt d = 0; d < dim && before > 0; ++d) beside[d] *= PetscSqrtReal(before / now);
}

/* Vectors to the surface, and areas of it, go with the matter that was drawn. */
static void carry_surface(Points *points, PetscInt p, const PetscReal G[9], PetscReal J)
{
  const PetscInt dim = points->dim;
  PetscReal *corner = point_real(points, POINT_CORNER, p), *face = point_real(points, POINT_FACE, p);
  PetscReal inverse[9], was[3] = {0}, area[3] = {0}, before = 0, now = 0;
  (void)tensor_inverse(G, inverse);
  for (PetscInt d = 0; d < points->components[POINT_CORNER]; ++d) was[d] = corner[d], before += PetscSqr(corner[d]);
  for (PetscInt d = 0; d < points->components[POINT_FACE]; ++d) area[d] = face[d];
  for (PetscInt d = 0; d < points->components[POINT_CORNER]; ++d) {
    corner[d] = G[3 * d] * was[0] + G[3 * d + 1] * was[1] + G[3 * d + 2] * was[2];
    now += PetscSqr(corner[d]);
  }
  for (PetscInt d = 0; d < points->components[POINT_FACE]; ++d)
    face[d] = J * (inverse[d] * area[0] + inverse[3 + d] * area[1] + inverse[6 + d] * area[2]);
  carry_normals(points->components[POINT_BESIDE], inverse, point_real(points, POINT_BESIDE, p));
  for (PetscInt d = 0; d < points->components[POINT_REACH]; ++d)
    point_real(points, POINT_REACH, p)[d] *=
      before > 0 ? PetscSqrtReal(now / before) : PetscPowReal(J, 1 / (PetscReal)dim);
}

/* Place, volume and mass of a point in its cell, which stands at x and was drawn at X. */
static void settle_point(const Model *m, PetscInt p, CellType type, const PetscReal *X, const PetscReal *x)
{
  Points *points = m->points;
  const PetscReal *xi = point_real(points, POINT_XI, p);
  PetscReal *place = point_real(points, POINT_X, p), G[9];
  const PetscReal J = map_between(type, m->dim, X, x, xi, G), radius = place[0];
  cell_position(type, x, xi, place);
  const PetscReal ratio =
    J * kinematics_weight(m->c->kinematics, place[0]) / kinematics_weight(m->c->kinematics, radius);
  points->real[POINT_VOLUME][p] *= ratio;
  points->real[POINT_MASS][p] *= ratio;
  points->real[POINT_WORK][p] *= ratio;
  carry_surface(points, p, G, J);
}

/* A cell that has no room for what comes. */
typedef struct {
  PetscReal left, moved; /* flattest; its node that has moved farthest, m */
  PetscReal where[3];    /* its middle as it was drawn, m */
  PetscInt body;
} Flattened;

static void look_at(const Model *m, PetscInt p, CellType type, const PetscReal *X, const PetscReal *x, Flattened *worst)
{
  const PetscInt n = cells[type].nodes;
  const PetscReal left = flattest(type, m->dim, X, x);
  if (left >= worst->left) return;
  *worst = (Flattened){.left = left, .body = m->points->body[p]};
  for (PetscInt i = 0; i < n; ++i) {
    PetscReal square = 0;
    for (PetscInt d = 0; d < m->dim; ++d) {
      square += PetscSqr(x[i * m->dim + d] - X[i * m->dim + d]);
      worst->where[d] += X[i * m->dim + d] / (PetscReal)n;
    }
    worst->moved = PetscMax(worst->moved, PetscSqrtReal(square));
  }
}

/* The worst of all ranks, which all of them tell. */
static PetscErrorCode Refuse(const Model *m, Flattened *worst, Diag *diag)
{
  const PetscReal *x = worst->where;
  PetscReal least;
  PetscMPIInt rank, mine, first;
  char path[64], place[96];

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(m->comm, &rank));
  PetscCall(MPIU_Allreduce(&worst->left, &least, 1, MPIU_REAL, MPIU_MIN, m->comm));
  if (least > FLATTEST) PetscFunctionReturn(0);
  mine = worst->left == least ? rank : PETSC_MPI_INT_MAX;
  PetscCallMPI(MPI_Allreduce(&mine, &first, 1, MPI_INT, MPI_MIN, m->comm));
  PetscCallMPI(MPI_Bcast(worst, (PetscMPIInt)sizeof *worst, MPI_BYTE, first, m->comm));
  PetscCall(PetscSNPrintf(path, sizeof path, "bodies[%d].shape", (int)worst->body));
  if (m->dim == 2) snprintf(place, sizeof place, "(%g, %g)", (double)x[0], (double)x[1]);
  else snprintf(place, sizeof place, "(%g, %g, %g)", (double)x[0], (double)x[1], (double)x[2]);
  diag_error(diag, path,
             "there is no room left for '%s' in its cell at %s m: what it stands on has moved by up to %.3g m there, "
             "and has turned the cell inside out",
             m->c->bodies[worst->body].name, place, (double)worst->moved);
  diag_hint(diag,
            "take larger cells there, bring the body before its ground has moved so far, or let it be mpm, "
            "whose shapes begin anywhere");
  PetscFunctionReturn(0);
}

/* Nodes of cells in which nothing goes on stand where they were drawn. */
static PetscErrorCode NodesReturn(Model *m, const Case *from, const PetscReal *drawn)
{
  const Grid *grid = m->grid;
  const PetscInt dim = m->dim, nn = grid->nodes_per_cell;
  PetscReal *stays; /* n_nodes: more than 0 where something goes on */

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(grid->n_nodes, &stays));
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscInt cell = m->points->cell[p];
    if (cell < 0 || body_comes(m->c, from, m->points->body[p])) continue;
    for (PetscInt i = 0; i < nn; ++i) stays[grid->cell_node[cell * nn + i]] = 1;
  }
  PetscCall(GridSumToOwners(grid, 1, stays));
  PetscCall(GridToGhosts(grid, 1, stays));
  for (PetscInt node = 0; node < grid->n_nodes; ++node) {
    if (stays[node] > 0) continue;
    for (PetscInt d = 0; d < dim; ++d) grid->x[node * dim + d] = drawn[node * dim + d];
  }
  PetscCall(PetscFree(stays));
  PetscFunctionReturn(0);
}

PetscErrorCode BodiesArrive(Model *m, const Case *from, const PetscReal *drawn, Diag *diag)
{
  PetscReal X[CELL_MAX_NODES * 3], x[CELL_MAX_NODES * 3];
  Flattened worst = {.left = PETSC_MAX_REAL};

  PetscFunctionBeginUser;
  PetscCall(NodesReturn(m, from, drawn));
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscInt cell = m->points->cell[p];
    if (cell < 0 || !body_comes(m->c, from, m->points->body[p])) continue;
    const CellType type = grid_cell_type(m->grid, cell);
    nodes_of(m->grid, drawn, cell, X);
    nodes_of(m->grid, m->grid->x, cell, x);
    look_at(m, p, type, X, x, &worst);
    if (worst.left > FLATTEST) settle_point(m, p, type, X, x);
  }
  PetscCall(Refuse(m, &worst, diag));
  PetscFunctionReturn(0);
}
