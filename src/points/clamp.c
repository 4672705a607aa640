/* `outside: keep-on-boundary`: points that left the grid go back to the nearest position inside.
 * Followers do not: they only remember it. */
#include "points/migrate.h"

/* A position outside the grid, on its way to the nearest one inside. */
typedef struct {
  PetscReal from[3], to[3];
} Clamp;

/* Which leavers nobody holds, though they are somewhere. */
static PetscInt find_homeless(const Leavers *l, const Points *points, PetscInt *which)
{
  PetscInt n = 0;
  for (PetscInt i = 0; i < l->n; ++i) {
    if (l->owner[i] == -1 && position_is_finite(points->dim, point_real(points, POINT_X, l->point[i]))) which[n++] = i;
  }
  return n;
}

/* Every rank proposes the nearest position that it knows for every homeless point (n_all of them);
 * the nearest of all wins. Few points are homeless, and on a mesh no rank knows the boundary of the
 * others. */
static PetscErrorCode ChooseNearest(const Grid *grid, PetscInt n_all, Clamp *all)
{
  struct {
    double distance;
    int rank;
  } * nearest;
  PetscMPIInt rank;
  PetscReal *to;
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(grid->comm, &rank));
  PetscCall(PetscMalloc2(n_all, &nearest, 3 * (size_t)n_all, &to));
  for (PetscInt k = 0; k < n_all; ++k) {
    PetscReal sum = 0, *x = to + 3 * k;
    for (PetscInt d = 0; d < 3; ++d) x[d] = all[k].from[d];
    grid_clamp(grid, x);
    for (PetscInt d = 0; d < grid->dim; ++d) sum += PetscSqr(x[d] - all[k].from[d]);
    /* a rank without a boundary face leaves x alone, and has nothing to propose */
    nearest[k].distance = sum > 0 ? (double)sum : HUGE_VAL;
    nearest[k].rank = rank;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, nearest, (PetscMPIInt)n_all, MPI_DOUBLE_INT, MPI_MINLOC, grid->comm));
  for (PetscInt k = 0; k < 3 * n_all; ++k)
    if (nearest[k / 3].rank != rank) to[k] = 0;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, to, (PetscMPIInt)(3 * n_all), MPIU_REAL, MPIU_SUM, grid->comm));
  for (PetscInt k = 0; k < 3 * n_all; ++k) all[k / 3].to[k % 3] = to[k];
  PetscCall(PetscFree2(nearest, to));
  PetscFunctionReturn(0);
}

/* Put the point where it is kept, and take away the velocity that leads out: on a box by
 * components, else along the way that it was moved. The displacement follows, so that x - u stays
 * the place where it started. */
static void clamp_point(Points *points, PetscInt p, const Clamp *clamp, PetscBool by_axis)
{
  const PetscInt dim = points->dim;
  PetscReal *x = point_real(points, POINT_X, p), *u = point_real(points, POINT_U, p),
            *v = point_real(points, POINT_V, p);
  PetscReal out[3] = {0, 0, 0}, square = 0, along = 0;
  for (PetscInt d = 0; d < dim; ++d) {
    out[d] = clamp->from[d] - clamp->to[d];
    square += out[d] * out[d];
    along += v[d] * out[d];
    x[d] = clamp->to[d];
    u[d] -= out[d];
  }
  for (PetscInt d = 0; d < dim; ++d) {
    if (by_axis && v[d] * out[d] > 0) v[d] = 0;
    if (!by_axis && along > 0) v[d] -= along / square * out[d];
  }
}

/* A follower goes on outside; the grid carries it at the nearest position that it has. */
static void clamp_follower(Points *points, PetscInt p, const Clamp *clamp)
{
  for (PetscInt d = 0; d < points->dim; ++d) {
    point_real(points, POINT_X, p)[d] = clamp->to[d];
    point_real(points, POINT_OVERHANG, p)[d] = clamp->from[d] - clamp->to[d];
  }
}

/* All ranks' homeless positions on every rank; mine begin at *first. */
static PetscErrorCode GatherHomeless(const Grid *grid, PetscInt n, const Clamp *mine, PetscInt *first, PetscInt *n_all,
                                     Clamp **all)
{
  const int width = (int)(sizeof(Clamp) / sizeof(PetscReal));
  PetscMPIInt size, rank, *count, *start, sent = (PetscMPIInt)n * width;
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(grid->comm, &size));
  PetscCallMPI(MPI_Comm_rank(grid->comm, &rank));
  PetscCall(PetscMalloc2(size, &count, size + 1, &start));
  PetscCallMPI(MPI_Allgather(&sent, 1, MPI_INT, count, 1, MPI_INT, grid->comm));
  start[0] = 0;
  for (PetscMPIInt r = 0; r < size; ++r) start[r + 1] = start[r] + count[r];
  *first = start[rank] / width;
  *n_all = start[size] / width;
  PetscCall(PetscMalloc1(*n_all, all));
  PetscCallMPI(MPI_Allgatherv(mine, sent, MPIU_REAL, *all, count, start, MPIU_REAL, grid->comm));
  PetscCall(PetscFree2(count, start));
  PetscFunctionReturn(0);
}

PetscErrorCode LeaversClamp(const Leavers *l, Points *points, const Grid *grid)
{
  const PetscInt dim = points->dim;
  PetscInt n, first, n_all, *which;
  Clamp *mine, *all;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(l->n, &which, l->n, &mine));
  n = find_homeless(l, points, which);
  for (PetscInt k = 0; k < n; ++k) {
    PetscCall(PetscMemzero(mine + k, sizeof *mine));
    PetscCall(PetscArraycpy(mine[k].from, point_real(points, POINT_X, l->point[which[k]]), dim));
  }
  PetscCall(GatherHomeless(grid, n, mine, &first, &n_all, &all));
  PetscCall(ChooseNearest(grid, n_all, all));
  for (PetscInt k = 0; k < n; ++k) {
    const PetscInt i = which[k], p = l->point[i];
    if (points->components[POINT_OVERHANG]) {
      clamp_follower(points, p, all + first + k);
    } else {
      tally_outside(points, p, 1);
      clamp_point(points, p, all + first + k, grid_is_aligned(grid));
      tally_outside(points, p, -1);
      ++points->outside.held;
      points->outside.held_mass += points->real[POINT_MASS][p];
    }
    points->cell[p] = point_locate(points, p, grid, -1);
    if (points->cell[p] >= 0) l->owner[i] = LEAVER_HERE;
  }
  PetscCall(PetscFree(all));
  PetscCall(PetscFree2(which, mine));
  PetscCall(LeaversFindOwners(l, points, grid));
  PetscFunctionReturn(0);
}
