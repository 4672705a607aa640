/* What a run says of itself at its start and its end. What the disk refuses comes back as PETSC_ERR_FILE_WRITE, without a trace. */
#pragma once
#include "io/run_dir.h"
#include "model/model.h"

/* version.txt */
PetscErrorCode SummaryVersion(MPI_Comm comm, RunDir *dir);
/* Sizes of the model, logged. Collective. */
PetscErrorCode SummaryBegin(Model *model, RunDir *dir);
/* Measures and timings, logged and in timings.txt. Collective. */
PetscErrorCode SummaryEnd(Model *model, RunDir *dir, PetscBool gave_up, PetscReal seconds, const PetscReal *values);
