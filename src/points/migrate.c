/* Messages between ranks: who holds a position, and the points themselves. All traffic is among
 * neighbours. */
#include "base/exchange.h"
#include "points/migrate.h"
#include "points/fields.h"

/* Which ranks each leaver asks: rank[start[i] .. start[i+1]). */
typedef struct {
  PetscInt *start;
  PetscMPIInt *rank;
  PetscInt *per_rank; /* questions for each rank */
} Questions;

static PetscInt candidates(const Leavers *l, PetscInt i, const Points *points, const Grid *grid, PetscMPIInt size,
                           PetscMPIInt *ranks)
{
  const PetscReal *x = point_real(points, POINT_X, l->point[i]);
  if (l->owner[i] != -1 || !position_is_finite(points->dim, x)) return 0;
  return grid_candidates(grid, x, size, ranks);
}

static PetscErrorCode QuestionsCreate(const Leavers *l, const Points *points, const Grid *grid, PetscMPIInt size,
                                      Questions *q)
{
  PetscMPIInt *ranks;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(size, &ranks));
  PetscCall(PetscMalloc1(l->n + 1, &q->start));
  PetscCall(PetscCalloc1(size, &q->per_rank));
  q->start[0] = 0;
  for (PetscInt i = 0; i < l->n; ++i) q->start[i + 1] = q->start[i] + candidates(l, i, points, grid, size, ranks);
  PetscCall(PetscMalloc1(q->start[l->n], &q->rank));
  for (PetscInt i = 0; i < l->n; ++i) {
    const PetscInt n = candidates(l, i, points, grid, size, ranks);
    for (PetscInt k = 0; k < n; ++k) {
      q->rank[q->start[i] + k] = ranks[k];
      ++q->per_rank[ranks[k]];
    }
  }
  PetscCall(PetscFree(ranks));
  PetscFunctionReturn(0);
}

static PetscErrorCode QuestionsDestroy(Questions *q)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(q->start));
  PetscCall(PetscFree(q->rank));
  PetscCall(PetscFree(q->per_rank));
  PetscFunctionReturn(0);
}

/* place[k]: where question k stands in the messages; x gets its position there. */
static PetscErrorCode FillQuestions(const Leavers *l, const Points *points, const Questions *q, const PetscMPIInt *slot,
                                    const Exchange *e, PetscInt *place, PetscReal *x)
{
  const PetscInt dim = points->dim;
  PetscInt *next;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(e->n_to + 1, &next));
  PetscCall(PetscArraycpy(next, e->to_start, e->n_to + 1));
  for (PetscInt i = 0; i < l->n; ++i) {
    for (PetscInt k = q->start[i]; k < q->start[i + 1]; ++k) {
      place[k] = next[slot[q->rank[k]]]++;
      memcpy(x + place[k] * dim, point_real(points, POINT_X, l->point[i]), sizeof *x * (size_t)dim);
    }
  }
  PetscCall(PetscFree(next));
  PetscFunctionReturn(0);
}

/* Send the questions, answer those of others: yes[place] tells whether the rank asked holds the
 * position. */
static PetscErrorCode Ask(const Exchange *e, const Grid *grid, PetscReal *x, char *yes)
{
  const PetscInt n_asked = e->from_start[e->n_from], dim = grid->dim;
  PetscReal *asked, xi[3];
  char *answer;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2((size_t)(n_asked * dim), &asked, n_asked, &answer));
  PetscCall(ExchangeItems(e, sizeof *x * (size_t)dim, PETSC_FALSE, (char *)x, (char *)asked));
  for (PetscInt k = 0; k < n_asked; ++k) answer[k] = grid_locate(grid, asked + k * dim, -1, xi) >= 0;
  PetscCall(ExchangeItems(e, 1, PETSC_TRUE, answer, yes));
  PetscCall(PetscFree2(asked, answer));
  PetscFunctionReturn(0);
}

static void choose_owners(const Leavers *l, const Questions *q, const PetscInt *place, const char *yes)
{
  for (PetscInt i = 0; i < l->n; ++i) {
    for (PetscInt k = q->start[i]; k < q->start[i + 1]; ++k) {
      const PetscMPIInt rank = q->rank[k];
      if (yes[place[k]] && (l->owner[i] < 0 || rank < l->owner[i])) l->owner[i] = rank;
    }
  }
}

PetscErrorCode LeaversFindOwners(const Leavers *leavers, const Points *points, const Grid *grid)
{
  PetscMPIInt size, *slot;
  PetscInt *place;
  PetscReal *x;
  char *yes;
  Questions q;
  Exchange e;
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(grid->comm, &size));
  if (size == 1) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(size, &slot));
  PetscCall(QuestionsCreate(leavers, points, grid, size, &q));
  PetscCall(ExchangeCreate(grid->comm, size, q.per_rank, slot, &e));
  const PetscInt n = q.start[leavers->n];
  PetscCall(PetscMalloc3(n, &place, (size_t)(n * points->dim), &x, n, &yes));
  PetscCall(FillQuestions(leavers, points, &q, slot, &e, place, x));
  PetscCall(Ask(&e, grid, x, yes));
  choose_owners(leavers, &q, place, yes);
  PetscCall(PetscFree3(place, x, yes));
  PetscCall(ExchangeDestroy(&e));
  PetscCall(QuestionsDestroy(&q));
  PetscCall(PetscFree(slot));
  PetscFunctionReturn(0);
}

/* The leavers' points in the order of the messages, packed message by message. */
static PetscErrorCode PackLeavers(const Leavers *l, const Points *points, const PetscMPIInt *slot, const Exchange *e,
                                  char *buffer)
{
  const size_t bytes = points_bytes(points);
  PetscInt *next, *order;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(e->n_to + 1, &next, e->to_start[e->n_to], &order));
  PetscCall(PetscArraycpy(next, e->to_start, e->n_to + 1));
  for (PetscInt i = 0; i < l->n; ++i)
    if (l->owner[i] >= 0) order[next[slot[l->owner[i]]]++] = l->point[i];
  for (PetscMPIInt m = 0; m < e->n_to; ++m) {
    points_pack(points, e->to_count[m], order + e->to_start[m], buffer + bytes * (size_t)e->to_start[m]);
  }
  PetscCall(PetscFree2(next, order));
  PetscFunctionReturn(0);
}

PetscErrorCode LeaversSend(const Leavers *leavers, const Points *points, const Grid *grid, Arrivals *arrivals)
{
  const size_t bytes = points_bytes(points);
  PetscMPIInt size, *slot;
  PetscInt *per_rank;
  char *buffer;
  Exchange e;
  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(arrivals, sizeof *arrivals));
  PetscCallMPI(MPI_Comm_size(grid->comm, &size));
  if (size == 1) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(size, &slot));
  PetscCall(PetscCalloc1(size, &per_rank));
  for (PetscInt i = 0; i < leavers->n; ++i)
    if (leavers->owner[i] >= 0) ++per_rank[leavers->owner[i]];
  PetscCall(ExchangeCreate(grid->comm, size, per_rank, slot, &e));
  arrivals->n = e.from_start[e.n_from];
  arrivals->n_messages = e.n_from;
  PetscCall(PetscMalloc1(bytes * (size_t)e.to_start[e.n_to], &buffer));
  PetscCall(PetscMalloc1(bytes * (size_t)arrivals->n, &arrivals->data));
  PetscCall(PetscMalloc1(e.n_from, &arrivals->count));
  PetscCall(PetscArraycpy(arrivals->count, e.from_count, e.n_from));
  PetscCall(PackLeavers(leavers, points, slot, &e, buffer));
  PetscCall(ExchangeItems(&e, bytes, PETSC_FALSE, buffer, arrivals->data));
  PetscCall(PetscFree(buffer));
  PetscCall(PetscFree(per_rank));
  PetscCall(PetscFree(slot));
  PetscCall(ExchangeDestroy(&e));
  PetscFunctionReturn(0);
}

/* Append all messages; their memory goes. */
static PetscErrorCode AppendArrivals(Arrivals *arrivals, Points *points)
{
  const char *data = arrivals->data;
  PetscFunctionBeginUser;
  PetscCall(PointsReserveMore(points, arrivals->n));
  for (PetscInt m = 0; m < arrivals->n_messages; ++m) {
    PetscCall(PointsUnpack(points, arrivals->count[m], data));
    data += points_bytes(points) * (size_t)arrivals->count[m];
  }
  PetscCall(PetscFree(arrivals->data));
  PetscCall(PetscFree(arrivals->count));
  PetscFunctionReturn(0);
}

PetscErrorCode LeaversMove(const Leavers *leavers, Points *points, const Grid *grid, const PetscBool *gone)
{
  PetscMPIInt size;
  Arrivals arrivals;
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(grid->comm, &size));
  if (size == 1) PetscFunctionReturn(0); /* all are here */
  PetscCall(LeaversSend(leavers, points, grid, &arrivals));
  PetscCall(PointsCompact(points, gone));
  PetscCall(AppendArrivals(&arrivals, points));
  PetscFunctionReturn(0);
}

PetscErrorCode ArrivalsUnpack(Arrivals *arrivals, Points *points, const Grid *grid)
{
  const PetscInt first = points->n;
  PetscFunctionBeginUser;
  PetscCall(AppendArrivals(arrivals, points));
  for (PetscInt p = first; p < points->n; ++p) {
    points->cell[p] = point_locate(points, p, grid, -1);
    PetscCheck(points->cell[p] >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB,
               "a point arrived that this rank had claimed, and is not here");
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PointsTransfer(Points *points, const Grid *grid, const PetscMPIInt *owner)
{
  Leavers leavers = {0};
  Arrivals arrivals;
  PetscBool *drop;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(grid->comm, &rank));
  PetscCall(PetscMalloc3(points->n, &leavers.point, points->n, &leavers.owner, points->n, &drop));
  for (PetscInt p = 0; p < points->n; ++p) {
    drop[p] = owner[p] != rank;
    if (!drop[p]) continue;
    leavers.point[leavers.n] = p;
    leavers.owner[leavers.n++] = owner[p];
  }
  PetscCall(LeaversSend(&leavers, points, grid, &arrivals));
  PetscCall(PointsCompact(points, drop));
  PetscCall(AppendArrivals(&arrivals, points));
  PetscCall(PetscFree3(leavers.point, leavers.owner, drop));
  PetscFunctionReturn(0);
}
