/* States of a model as VTKHDF files. */
#pragma once
#include "base/table/table.h"
#include "case/fields.h"
#include "model/model.h"

typedef struct Output Output;

PetscErrorCode OutputCreate(const Model *model, const char *folder, Output **output);
/* For who creates it before there is a directory. */
void output_set_folder(Output *output, const char *folder);
PetscErrorCode OutputDestroy(Output **output);
/* A resumed run stands at this step of the model: the files of contact that it had written there stay. */
void output_resumed_at(Output *output, PetscInt step);
/* Collective. points_NNNNNN.hdf (and grid_NNNNNN.hdf if the case asks) of the present state, and
 * their series. If the file system refuses, *ok is false and reason says why; files written before
 * stay whole. */
PetscErrorCode OutputWrite(Output *output, Model *model, PetscBool *ok, char reason[256]);

/* How many states were written; the next one gets this number. */
PetscInt output_count(const Output *output);

/* Collective. How many states there are, and what tells whether their files are still those that
 * were written. */
PetscErrorCode OutputToTables(const Output *output, Tables *tables);
/* Collective. Go on after the first `count` states; tables of older programs do not know their
 * files. */
PetscErrorCode OutputFromTables(Output *output, const Tables *tables, PetscInt count, char reason[256]);
/* Collective. Files of states that are missing, or not as they were written, go to diag. */
PetscErrorCode OutputCheck(const Output *output, MPI_Comm comm, Diag *diag);

/* A field of this rank's points: n x components numbers, vectors with three components in 2D
 * too. */
PetscErrorCode OutputPointField(const Model *model, const OutputField *field, PetscReal *data);
