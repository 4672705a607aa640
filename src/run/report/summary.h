/* What a run says of itself at its start and its end. What the disk refuses comes back as
 * PETSC_ERR_FILE_WRITE, without a trace. */
#pragma once
#include "output/directory/run_dir.h"
#include "model/model.h"
#include "run/run.h"

/* version.txt */
PetscErrorCode SummaryVersion(MPI_Comm comm, RunDir *dir);
/* Sizes of the model, logged. Collective. */
PetscErrorCode SummaryBegin(Model *model, RunDir *dir);
/* Measures, of which `values` are those of the last step, and timings, logged and in timings.txt. Collective. */
PetscErrorCode SummaryEnd(Model *model, RunDir *dir, const RunSummary *summary, const PetscReal *values);
/* The numbers of timings.txt again; what is not there is 0. */
void summary_read(const char *folder, RunSummary *summary);
