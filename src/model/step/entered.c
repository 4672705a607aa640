/* Parts that no material joins know nothing of each other in a cloud (grid/cloud/matter.h), and go into each other. */
#include "model/model_private.h"

PetscErrorCode NoteEntered(Model *m)
{
  const CloudTally *tally = &m->space->support->tally;
  const PetscInt p = tally->first_entered, dim = m->dim;
  PetscReal first[4] = {0}; /* body, place */
  struct {
    double cell;
    int rank;
  } mine = {PETSC_MAX_REAL, 0}, all; /* of the lowest cell, which any number of ranks agree on */
  PetscInt points = tally->entered;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  if (!m->method->clouds || m->entered.points) PetscFunctionReturn(0);
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &points, 1, MPIU_INT, MPI_SUM, m->comm));
  if (!points) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Comm_rank(m->comm, &rank));
  mine.rank = rank;
  if (tally->entered) {
    mine.cell = (double)m->points->cell[p];
    first[0] = (PetscReal)m->points->body[p];
    for (PetscInt d = 0; d < dim; ++d) first[1 + d] = point_real(m->points, POINT_X, p)[d];
  }
  PetscCallMPI(MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE_INT, MPI_MINLOC, m->comm));
  PetscCallMPI(MPI_Bcast(first, 4, MPIU_REAL, all.rank, m->comm));
  m->entered.points = points;
  m->entered.body = (PetscInt)first[0];
  m->entered.time = m->time;
  for (int d = 0; d < 3; ++d) m->entered.place[d] = first[1 + d];
  PetscFunctionReturn(0);
}
