#include "run/summary.h"
#include "talus_version.h"

PetscErrorCode SummaryVersion(MPI_Comm comm, RunDir *dir)
{
  char text[2048], petsc[256], mpi[MPI_MAX_LIBRARY_VERSION_STRING];
  PetscMPIInt size;
  int length;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscGetVersion(petsc, sizeof petsc));
  PetscCallMPI(MPI_Get_library_version(mpi, &length));
  PetscCall(PetscSNPrintf(text, sizeof text,
                          "talus = %s\npetsc = %s\nmpi = %s\ncompiler = %s\nbuild = %s\nranks = %d\n", TALUS_VERSION,
                          petsc, mpi, TALUS_COMPILER, TALUS_BUILD_TYPE, (int)size));
  const PetscErrorCode status = RunDirWriteText(dir, "version.txt", text);
  PetscFunctionReturn(status);
}

PetscErrorCode SummaryBegin(Model *m, RunDir *dir)
{
  PetscInt points;
  PetscMPIInt size;

  PetscFunctionBeginUser;
  PetscCall(ModelCountPoints(m, &points));
  PetscCallMPI(MPI_Comm_size(m->comm, &size));
  if (m->c->title) PetscCall(RunDirLog(dir, "title = %s", m->c->title));
  PetscCall(RunDirLog(dir, "method = %s", m->method->name));
  PetscCall(RunDirLog(dir, "cells = %d nodes = %d points = %d ranks = %d", (int)m->grid->n_cells_global,
                      (int)m->grid->n_nodes_global, (int)points, (int)size));
  PetscFunctionReturn(0);
}

PetscErrorCode SummaryEnd(Model *m, RunDir *dir, PetscBool gave_up, PetscReal seconds, const PetscReal *values)
{
  PetscReal phase[PHASE_N], rest = seconds;
  char text[1024];
  size_t end = 0;

  PetscFunctionBeginUser;
  ModelTimes(m, phase);
  PetscCall(RunDirLog(dir, "linear = %s unknowns = %d", NewtonLinearName(m->newton),
                      (int)(m->system->n_active_global * m->dim)));
  for (PetscInt k = 0; k < m->c->n_measures; ++k)
    PetscCall(
      RunDirLog(dir, "%s = %.10g %s", m->c->measures[k].name, (double)values[k], measure_unit(&m->c->measures[k])));
  PetscCall(RunDirLog(dir, "steps = %d iterations = %d halvings = %d seconds = %.3g", (int)m->step,
                      (int)m->total_iterations, (int)m->cuts, (double)seconds));
  PetscCall(PetscSNPrintf(text, sizeof text, "total [s] = %.6g\n", (double)seconds));
  for (int k = 0; k < PHASE_N; ++k) {
    end = strlen(text);
    PetscCall(PetscSNPrintf(text + end, sizeof text - end, "%s [s] = %.6g\n", phase_names[k], (double)phase[k]));
    rest -= phase[k];
  }
  end = strlen(text);
  PetscCall(PetscSNPrintf(text + end, sizeof text - end,
                          "rest [s] = %.6g\nsteps = %d\niterations = %d\nhalvings = %d\npatterns = %d\noutcome = %s\n",
                          (double)rest, (int)m->step, (int)m->total_iterations, (int)m->cuts, (int)m->system->builds,
                          gave_up ? "gave up" : "done"));
  const PetscErrorCode status = RunDirWriteText(dir, "timings.txt", text);
  PetscFunctionReturn(status);
}
