/* What the files that write states share. */
#pragma once
#include "output/seal.h"
#include "output/vtk/vtk.h"
#include "run/output/output.h"

/* Collective. NAME_NNNNNN.hdf with the number of the state that is being written, and its entry in
 * NAME.hdf.series. seal: gets what tells the file's contents; NULL: nobody asks. */
PetscErrorCode OutputState(Output *output, MPI_Comm comm, const char *name, const VtkData *data, FileSeal *seal,
                           PetscBool *ok, char reason[256]);
/* Collective. Right after a run is resumed what a step alone can tell is not known: if the run had written its file
 * NAME_NNNNNN.hdf before it was cut off, that one enters the series (*kept). */
PetscErrorCode OutputKeep(const Output *output, const Model *model, const char *name, PetscBool *kept, PetscBool *ok,
                          char reason[256]);
/* Collective. A field of this rank's points (n x components) as means at the nodes of the grid, ghosts
 * too; 0 where no point is (nodal_average.c). */
PetscErrorCode OutputNodalAverage(const Model *model, PetscInt components, const PetscReal *values, PetscReal *nodes);
/* Collective. Walls that stand, as lines or triangles, and what touches them (output_walls.c). */
PetscErrorCode OutputWalls(Output *output, const Model *model, PetscBool *ok, char reason[256]);
PetscErrorCode OutputContact(Output *output, const Model *model, PetscBool *ok, char reason[256]);
