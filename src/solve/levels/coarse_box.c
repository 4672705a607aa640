#include "solve/levels/coarse_box.h"
#include "grid/box/box.h"
#include "solve/system/forms/shared_rows.h"

/* Along an axis: the coarse lines beside a line, and their weights. */
typedef struct {
  PetscInt n, at[2];
  PetscReal weight[2];
} Beside;

static Beside lines_beside(const GridBox *box, PetscInt axis, PetscInt i)
{
  const PetscReal *line = box->line[axis];
  if (i % 2 == 0 || i == box->counts[axis]) return (Beside){1, {i, i}, {1, 0}};
  const PetscReal upper = (line[i] - line[i - 1]) / (line[i + 1] - line[i - 1]);
  return (Beside){2, {i - 1, i + 1}, {1 - upper, upper}};
}

/* An owned node's coarse nodes, as local nodes. */
typedef struct {
  PetscInt n, node[8];
  PetscReal weight[8];
} Parents;

static Parents parents_of(const GridBox *box, PetscInt node)
{
  const VoxelBlock owned = box_owned_nodes(box, box->block + box->rank);
  Parents p = {.n = 0};
  PetscInt at[LATTICE];
  block_at(&owned, node, at);
  const Beside x = lines_beside(box, 0, at[0]), y = lines_beside(box, 1, at[1]), z = lines_beside(box, 2, at[2]);
  for (PetscInt k = 0; k < z.n; ++k)
    for (PetscInt j = 0; j < y.n; ++j)
      for (PetscInt i = 0; i < x.n; ++i, ++p.n) {
        p.node[p.n] = box_node(box, (PetscInt[LATTICE]){x.at[i], y.at[j], z.at[k]});
        p.weight[p.n] = x.weight[i] * y.weight[j] * z.weight[k];
      }
  return p;
}

PetscBool coarse_box_fits(const Grid *grid)
{
  const GridBox *box = grid->box;
  return box && grid->n_fields == 1 && !box_has_centres(box) && (box->size == 1 || box->halo > 0);
}

static PetscBool all_held(PetscInt dim, const unsigned char *held)
{
  for (PetscInt d = 0; d < dim; ++d)
    if (!held[d]) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Global numbers of the coarse nodes (n_nodes), -1: not needed; how many this rank owns. */
static PetscErrorCode NumberCoarse(const System *s, const Grid *grid, const unsigned char *fixed, PetscReal *number,
                                   PetscInt *n)
{
  PetscInt first = 0, k = 0;

  PetscFunctionBeginUser;
  for (PetscInt a = 0; a < s->n_active; ++a) {
    const Parents p = parents_of(grid->box, s->active[a]);
    const PetscBool still = all_held(s->dim, fixed + s->active[a] * s->dim);
    for (PetscInt i = 0; i < p.n && !still; ++i) number[p.node[i]] = 1;
  }
  PetscCall(GridSumToOwners(grid, 1, number));
  for (PetscInt i = 0; i < grid->n_owned; ++i) k += number[i] > 0;
  *n = k;
  PetscCallMPI(MPI_Exscan(n, &first, 1, MPIU_INT, MPI_SUM, s->comm));
  for (PetscInt i = 0; i < grid->n_owned; ++i) number[i] = number[i] > 0 ? (PetscReal)first++ : -1;
  PetscCall(GridToGhosts(grid, 1, number));
  PetscFunctionReturn(0);
}

static PetscErrorCode CoarseMotions(MPI_Comm comm, const Grid *grid, const PetscReal *number, PetscInt n,
                                    MatNullSpace *motions)
{
  const PetscInt dim = grid->dim;
  Vec places;
  PetscReal *v;

  PetscFunctionBeginUser;
  PetscCall(VecCreateMPI(comm, dim * n, PETSC_DETERMINE, &places));
  PetscCall(VecSetBlockSize(places, dim));
  PetscCall(VecGetArrayWrite(places, &v));
  for (PetscInt i = 0; i < grid->n_owned; ++i)
    for (PetscInt d = 0; d < dim && number[i] >= 0; ++d) *v++ = grid->x[i * dim + d];
  v -= dim * n;
  PetscCall(VecRestoreArrayWrite(places, &v));
  PetscCall(MatNullSpaceCreateRigidBody(places, motions));
  PetscCall(VecDestroy(&places));
  PetscFunctionReturn(0);
}

/* Rows of one node: a coarse displacement's components in the frame of the node, and nothing where it is held. */
static PetscErrorCode FillRows(const System *s, PetscInt a, const CoarseBox *c, const unsigned char *held,
                               PetscInt first)
{
  const PetscReal *w = s->frames ? frame_of(s->frames, s->active[a]) : NULL;
  const PetscInt dim = s->dim;

  PetscFunctionBeginUser;
  for (PetscInt i = a * c->width; i < (a + 1) * c->width; ++i) {
    if (c->parent[i] < 0) continue;
    for (PetscInt b = 0; b < dim; ++b) {
      PetscReal v[3] = {0, 0, 0};
      v[b] = c->weight[i];
      if (w) frame_turn(dim, w, v);
      for (PetscInt d = 0; d < dim; ++d)
        if ((d == b || w) && !held[d])
          PetscCall(MatSetValue(c->interpolation, first + dim * a + d, dim * c->parent[i] + b, v[d], INSERT_VALUES));
    }
  }
  PetscFunctionReturn(0);
}

/* Coarse nodes of each owned row: global numbers, -1: none; and their weights. */
static void find_parents(const System *s, const Grid *grid, const unsigned char *fixed, const PetscReal *number,
                         CoarseBox *c)
{
  for (PetscInt a = 0; a < s->n_active; ++a) {
    const Parents p = parents_of(grid->box, s->active[a]);
    const PetscBool still = all_held(s->dim, fixed + s->active[a] * s->dim);
    for (PetscInt i = 0; i < c->width; ++i) {
      const PetscBool counts = (PetscBool)(i < p.n && !still);
      c->parent[a * c->width + i] = counts ? (PetscInt)number[p.node[i]] : -1;
      c->weight[a * c->width + i] = counts ? p.weight[i] : 0;
    }
  }
}

/* The owners of ghost rows tell their coarse nodes. */
static PetscErrorCode TellParents(const System *s, CoarseBox *c)
{
  const PetscInt first = s->n_active * c->width;
  MPI_Datatype parents, weights;
  PetscSF rows;

  PetscFunctionBeginUser;
  PetscCall(GhostRows(s, &rows));
  if (!rows) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Type_contiguous((PetscMPIInt)c->width, MPIU_INT, &parents));
  PetscCallMPI(MPI_Type_contiguous((PetscMPIInt)c->width, MPIU_REAL, &weights));
  PetscCallMPI(MPI_Type_commit(&parents));
  PetscCallMPI(MPI_Type_commit(&weights));
  PetscCall(PetscSFBcastBegin(rows, parents, c->parent, c->parent + first, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(rows, parents, c->parent, c->parent + first, MPI_REPLACE));
  PetscCall(PetscSFBcastBegin(rows, weights, c->weight, c->weight + first, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(rows, weights, c->weight, c->weight + first, MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&parents));
  PetscCallMPI(MPI_Type_free(&weights));
  PetscCall(PetscSFDestroy(&rows));
  PetscFunctionReturn(0);
}

static PetscErrorCode Interpolation(const System *s, const unsigned char *fixed, CoarseBox *c)
{
  const PetscInt dim = s->dim, most = dim * c->width; /* entries of a row, where a frame turns */
  PetscInt first;

  PetscFunctionBeginUser;
  PetscCall(MatCreateAIJ(s->comm, dim * s->n_active, dim * c->n, PETSC_DETERMINE, PETSC_DETERMINE, most, NULL, most,
                         NULL, &c->interpolation));
  PetscCall(MatGetOwnershipRange(c->interpolation, &first, NULL));
  for (PetscInt a = 0; a < s->n_active; ++a) PetscCall(FillRows(s, a, c, fixed + dim * s->active[a], first));
  PetscCall(MatAssemblyBegin(c->interpolation, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(c->interpolation, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

PetscErrorCode CoarseBoxCreate(const System *s, const Grid *grid, const unsigned char *fixed, CoarseBox **box)
{
  PetscReal *number;
  CoarseBox *c;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&c));
  c->width = 1 << s->dim;
  PetscCall(PetscMalloc2(s->n_rows * c->width, &c->parent, s->n_rows * c->width, &c->weight));
  PetscCall(PetscCalloc1(grid->n_nodes, &number));
  PetscCall(NumberCoarse(s, grid, fixed, number, &c->n));
  find_parents(s, grid, fixed, number, c);
  PetscCall(TellParents(s, c));
  PetscCall(Interpolation(s, fixed, c));
  PetscCall(CoarseMotions(s->comm, grid, number, c->n, &c->motions));
  PetscCall(PetscFree(number));
  *box = c;
  PetscFunctionReturn(0);
}

PetscErrorCode CoarseBoxDestroy(CoarseBox **box)
{
  CoarseBox *c = *box;

  PetscFunctionBeginUser;
  if (!c) PetscFunctionReturn(0);
  PetscCall(MatDestroy(&c->interpolation));
  PetscCall(MatNullSpaceDestroy(&c->motions));
  PetscCall(PetscFree2(c->parent, c->weight));
  PetscCall(PetscFree(*box));
  PetscFunctionReturn(0);
}
