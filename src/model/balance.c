/* Shares the grid among the ranks anew when the material has moved so far that some of them do most
 * of the work.
 *
 * What decides are counts of points and cells, not seconds: the same run does the same on any day,
 * and a resumed run what the first would have done. */
#include "model/model_private.h"

/* a new partition keeps at most this share of what exceeds a perfect one, or is not made */
#define WORTH 0.75
/* what exceeds the last partition's own imbalance by so much is a reason for another try */
#define WORSENED 1.25
/* steps after which even an imbalance that could not be cured is looked at again */
#define RETRY_AFTER 50

PetscReal cell_work(CellType type)
{
  static const PetscReal work[] = {
    [CELL_TRIANGLE] = 1.2, [CELL_QUADRILATERAL] = 2.5, [CELL_TETRAHEDRON] = 1.5, [CELL_HEXAHEDRON] = 9.5};
  return work[type];
}

/* {sum, largest} of pairs, in one call. */
/* NOLINTNEXTLINE(readability-non-const-parameter): MPI's own signature */
static void MPIAPI sum_and_largest(void *in, void *inout, PetscMPIInt *n, MPI_Datatype *type)
{
  const PetscReal *more = in;
  PetscReal *so_far = inout;
  (void)type;
  for (PetscMPIInt i = 0; i < *n; ++i, more += 2, so_far += 2) {
    so_far[0] += more[0];
    so_far[1] = PetscMax(so_far[1], more[1]);
  }
}

/* Largest share of the work over the mean. */
static PetscErrorCode MeasureImbalance(const Model *m, PetscReal *imbalance)
{
  const PetscReal mine = (PetscReal)m->points->n + cell_work(m->grid->type) * (PetscReal)m->space->support->n_groups;
  const PetscReal pair[2] = {mine, mine};
  PetscReal all[2];
  PetscMPIInt size;
  MPI_Datatype type;
  MPI_Op op;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(m->comm, &size));
  PetscCallMPI(MPI_Type_contiguous(2, MPIU_REAL, &type));
  PetscCallMPI(MPI_Type_commit(&type));
  PetscCallMPI(MPI_Op_create(sum_and_largest, 1, &op));
  PetscCallMPI(MPI_Allreduce(pair, all, 1, type, op, m->comm));
  PetscCallMPI(MPI_Op_free(&op));
  PetscCallMPI(MPI_Type_free(&type));
  *imbalance = all[0] > 0 ? all[1] * (PetscReal)size / all[0] : 1;
  PetscFunctionReturn(0);
}

/* Is it time to try? Not before the first step: nodes start from accelerations of their own, which
 * points do not carry. */
static PetscBool is_due(const Model *m)
{
  const Balance *b = &m->balance;
  if (m->step == 0) return PETSC_FALSE;
  if (b->imbalance <= m->c->parallel.imbalance) return PETSC_FALSE;
  if (b->reached == 0 || m->step - b->tried >= RETRY_AFTER) return PETSC_TRUE;
  return b->imbalance > 1 + WORSENED * (b->reached - 1);
}

static void weigh_cells(const Model *m, PetscReal *weight)
{
  const Support *s = m->space->support;
  const PetscReal cell = cell_work(m->grid->type);
  for (PetscInt c = 0; c < m->grid->n_cells; ++c) weight[c] = 0;
  for (PetscInt g = 0; g < s->n_groups; ++g)
    weight[m->points->cell[s->point_start[g]]] = cell + (PetscReal)(s->point_start[g + 1] - s->point_start[g]);
}

PetscErrorCode ModelRegrid(Model *m, Grid *grid, PetscInt *moved)
{
  Tables *kept;
  char reason[256] = "";

  PetscFunctionBeginUser;
  PetscCall(TablesCreate(&kept));
  PetscCall(NodalFieldsToTables(m->nodes, PETSC_FALSE, PETSC_TRUE, kept));
  PetscCall(ForcesToTables(m, kept));
  *moved = 0;
  PetscCall(PointsRepartition(m->points, m->grid, grid, moved));
  PetscInt followers = 0;
  PetscCall(PointsRepartition(m->tracers, m->grid, grid, &followers));
  PetscCall(LoadsRegrid(m->loads, m->grid, grid, m->points));
  PetscCall(BoundaryRegrid(&m->boundary, grid, m->points));
  PetscCall(ModelDestroyFields(m));
  PetscCall(GridDestroy(&m->grid));
  m->grid = grid;
  PetscCall(ModelCreateFields(m)); /* no cell is enabled: the next step makes the system anew */
  PetscCall(ForcesCreate(m, NULL));
  PetscCall(NodalFieldsFromTables(m->nodes, PETSC_FALSE, kept, reason));
  PetscCall(ForcesFromTables(m, kept, reason));
  PetscCheck(!reason[0], m->comm, PETSC_ERR_PLIB, "%s", reason);
  PetscCall(TablesDestroy(&kept));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelBalance(Model *m, StepReport *report)
{
  Balance *b = &m->balance;
  PetscReal *weight;
  PetscInt moved;
  PetscMPIInt size;
  Grid *grid;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(m->comm, &size));
  if (size == 1 || !m->method->restores_grid) PetscFunctionReturn(0);
  PetscCall(MeasureImbalance(m, &b->imbalance));
  b->largest = PetscMax(b->largest, b->imbalance);
  if (m->c->parallel.imbalance <= 0 || !is_due(m)) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(m->grid->n_cells, &weight));
  weigh_cells(m, weight);
  PetscCall(GridRepartition(m->grid, weight, 1 + WORTH * (b->imbalance - 1), &b->reached, &grid));
  PetscCall(PetscFree(weight));
  b->tried = m->step;
  if (!grid) {
    b->reached = b->imbalance;
    PetscFunctionReturn(0);
  }
  PetscCall(ModelRegrid(m, grid, &moved));
  PetscCall(ModelInitialise(m));
  PetscCall(MPIU_Allreduce(&moved, &report->moved, 1, MPIU_INT, MPI_SUM, m->comm));
  report->imbalance = b->imbalance;
  b->imbalance = b->reached;
  ++b->repartitions;
  PetscFunctionReturn(0);
}
