#include "run/summary.h"
#include <stdlib.h>
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
                          "talus = %s\nsources = %s\npetsc = %s\nmpi = %s\ncompiler = %s\nbuild = %s\nranks = %d\n",
                          TALUS_VERSION, TALUS_GIT_DESCRIBE, petsc, mpi, TALUS_COMPILER, TALUS_BUILD_TYPE, (int)size));
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

/* How evenly several ranks shared the work, and what keeping it so has cost. */
static PetscErrorCode LogBalance(const Model *m, RunDir *dir, PetscReal seconds)
{
  const Balance *b = &m->balance;

  PetscFunctionBeginUser;
  if (b->imbalance == 0) PetscFunctionReturn(0); /* one rank, or nothing moves between them */
  PetscCall(RunDirLog(dir, "imbalance = %.3f largest = %.3f repartitions = %d seconds = %.3g", (double)b->imbalance,
                      (double)b->largest, (int)b->repartitions, (double)seconds));
  PetscFunctionReturn(0);
}

PetscErrorCode SummaryEnd(Model *m, RunDir *dir, const RunSummary *summary, const PetscReal *values)
{
  const PetscReal seconds = summary->seconds;
  PetscReal phase[PHASE_N], rest = seconds;
  char text[1024];
  size_t end = 0;

  PetscFunctionBeginUser;
  ModelTimes(m, phase);
  PetscCall(RunDirLog(dir, "linear = %s unknowns = %d", NewtonLinearName(m->newton),
                      (int)(m->system->n_active_global * m->system->block)));
  for (PetscInt k = 0; k < m->c->n_measures; ++k)
    PetscCall(
      RunDirLog(dir, "%s = %.10g %s", m->c->measures[k].name, (double)values[k], measure_unit(&m->c->measures[k])));
  PetscCall(RunDirLog(dir, "steps = %d iterations = %d halvings = %d seconds = %.3g", (int)summary->steps,
                      (int)summary->iterations, (int)summary->halvings, (double)seconds));
  PetscCall(LogBalance(m, dir, phase[PHASE_REPARTITION]));
  PetscCall(PetscSNPrintf(text, sizeof text, "total [s] = %.6g\n", (double)seconds));
  for (int k = 0; k < PHASE_N; ++k) {
    end = strlen(text);
    PetscCall(PetscSNPrintf(text + end, sizeof text - end, "%s [s] = %.6g\n", phase_names[k], (double)phase[k]));
    rest -= phase[k];
  }
  end = strlen(text);
  PetscCall(
    PetscSNPrintf(text + end, sizeof text - end,
                  "rest [s] = %.6g\nsteps = %d\niterations = %d\nmost iterations in a step = %d\nhalvings = %d\n"
                  "patterns = %d\nrepartitions = %d\nlargest imbalance = %.3f\noutcome = %s\n",
                  (double)rest, (int)summary->steps, (int)summary->iterations, (int)summary->iterations_per_step,
                  (int)summary->halvings, (int)m->system->builds, (int)m->balance.repartitions,
                  (double)PetscMax(m->balance.largest, 1), summary->reason[0] ? "gave up" : "done"));
  const PetscErrorCode status = RunDirWriteText(dir, "timings.txt", text);
  PetscFunctionReturn(status);
}

void summary_read(const char *folder, RunSummary *summary)
{
  char path[PETSC_MAX_PATH_LEN], line[256];
  char *end;
  PetscSNPrintf(path, sizeof path, "%s/timings.txt", folder);
  *summary = (RunSummary){0};
  FILE *in = fopen(path, "r");
  while (in && fgets(line, sizeof line, in)) {
    const char *equals = strstr(line, " = ");
    const double value = equals ? strtod(equals + 3, &end) : 0;
    if (!equals || end == equals + 3) continue;
    const size_t n = (size_t)(equals - line);
    if (!strncmp(line, "total [s]", n)) summary->seconds = value;
    else if (!strncmp(line, "steps", n)) summary->steps = (PetscInt)value;
    else if (!strncmp(line, "iterations", n)) summary->iterations = (PetscInt)value;
    else if (!strncmp(line, "most iterations in a step", n)) summary->iterations_per_step = (PetscInt)value;
    else if (!strncmp(line, "halvings", n)) summary->halvings = (PetscInt)value;
  }
  if (in) fclose(in);
}
