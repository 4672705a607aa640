/* Cells whose points do not sum up gradients exactly: a uniform stress is none there. */
#include "base/math/vector.h"
#include "base/text.h"
#include "model/model_private.h"

/* Largest over smallest volume of a point of gmm. Triangles of Gmsh of one size have up to 2.5, and scatter by 4 %. */
#define UNEVEN 3
/* Length over width of cells from which on a beam is off by more than with fem (docs/guide/limits.md). */
#define FLAT_LME 4
#define FLAT_MLS 2.5
#define STIFFER 3 /* Stresses beside a seam are off by a fifth. */
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

/* How many times as long as wide: of a triangle by its height above the longest side, of tetrahedra nobody asks. */
static PetscReal flatness_of(const Grid *grid, PetscInt k)
{
  const Cell *cell = grid_cell(grid, k);
  const PetscInt dim = grid->dim;
  PetscReal x[3 * CELL_MAX_NODES], longest = 0, shortest = PETSC_MAX_REAL;
  grid_cell_x(grid, k, x);
  if (cell->nodes == dim + 1) {
    for (PetscInt i = 0; i < 3; ++i) {
      const PetscReal *a = x + i * dim, *b = x + (i + 1) % 3 * dim;
      longest = PetscMax(longest, PetscSqr(a[0] - b[0]) + PetscSqr(a[1] - b[1]));
    }
    return dim == 3 ? 1 : longest / (2 * cell_volume(grid_cell_type(grid, k), x));
  }
  for (PetscInt axis = 0; axis < dim; ++axis) {
    PetscReal side[3] = {0, 0, 0};
    for (PetscInt i = 0; i < cell->nodes; ++i)
      for (PetscInt d = 0; d < dim; ++d) side[d] += cell->reference[i][axis] * x[i * dim + d];
    const PetscReal length = PetscSqrtReal(vector_dot(side, side));
    longest = PetscMax(longest, length);
    shortest = PetscMin(shortest, length);
  }
  return longest / shortest;
}

/* Clouds are round, and in flat cells they reach along few of the long sides, or none. */
static PetscErrorCode AdviseFlat(const Model *m, PetscInt b, Diag *diag)
{
  const PetscBool lme = (PetscBool)(basis_find(m->c->basis.kind) == basis_find("lme"));
  struct {
    double flat;
    int rank;
  } worst = {1, 0};
  PetscReal place[3] = {0, 0, 0};
  PetscMPIInt rank;
  char path[64], at[80];

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(m->comm, &rank));
  worst.rank = rank;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    if (m->points->body[p] != b) continue;
    const PetscReal flat = flatness_of(m->grid, m->points->cell[p]);
    if (flat <= worst.flat * (1 + 1e-9)) continue;
    worst.flat = (double)flat;
    grid_cell_centre(m->grid, m->points->cell[p], place);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_DOUBLE_INT, MPI_MAXLOC, m->comm));
  if (worst.flat < (lme || cells[m->grid->type].nodes == m->dim + 1 ? FLAT_LME : FLAT_MLS) * (1 - 1e-6))
    PetscFunctionReturn(0);
  PetscCallMPI(MPI_Bcast(place, 3, MPIU_REAL, worst.rank, m->comm));
  PetscSNPrintf(path, sizeof path, "bodies[%d]", (int)b);
  diag_warning(diag, path,
               "its cells are up to %.3g times as long as wide, as at %s m: clouds of gmm are round, and have too few "
               "nodes along the long side",
               worst.flat, text_position(m->dim, place, at));
  diag_hint(diag,
            "a beam bent by a force was off by 1 %% with 5:1, 26 %% with 6:1 (lme), 9 %% with 3:1, 32 %% with 5:1 "
            "(mls), beyond that nothing resists: cells as long as wide, or fem");
  PetscFunctionReturn(0);
}

/* Stiffness of a body as it begins, Pa. */
static PetscReal stiffness_of(const Model *m, PetscInt b)
{
  PetscInt i = 0;
  while (strcmp(m->c->bodies[b].material, m->c->materials[i].name)) ++i;
  return m->materials[i].wave_modulus;
}

/* Clouds reach over a seam, and a strain that leaps there is smeared over both sides. */
static PetscErrorCode AdviseSeams(const Model *m, Diag *diag)
{
  const PetscInt n = m->c->n_bodies;
  int *share;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n * n, &share));
  PetscCall(SharingPairs(m, share));
  for (PetscInt b = 0; b < n; ++b)
    for (PetscInt a = 0; a < b; ++a) {
      const PetscReal ratio = stiffness_of(m, a) / stiffness_of(m, b), times = PetscMax(ratio, 1 / ratio);
      char path[64];
      if (!(share[a * n + b] || share[b * n + a]) || case_field(m->c, a) != case_field(m->c, b) || times <= STIFFER)
        continue;
      PetscSNPrintf(path, sizeof path, "bodies[%d]", (int)b);
      diag_warning(diag, path,
                   "'%s' and '%s' share nodes, and one is %.3g times as stiff: clouds of gmm reach over the seam, and "
                   "stresses on its two sides come out wrong",
                   m->c->bodies[a].name, m->c->bodies[b].name, (double)times);
      diag_hint(diag, "- {name: ..., between: [%s, %s], contact: bonded} in `interfaces` gives each nodes of its own",
                m->c->bodies[a].name, m->c->bodies[b].name);
    }
  PetscCall(PetscFree(share));
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
    if (m->method->clouds) PetscCall(AdviseFlat(m, b, diag));
    if (stays && m->method->restores_grid && !grid_is_aligned(m->grid)) PetscCall(AdviseWeights(m, b, diag));
  }
  if (m->method->clouds) PetscCall(AdviseSeams(m, diag));
  PetscFunctionReturn(0);
}
