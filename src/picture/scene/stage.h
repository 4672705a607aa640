/* Stages in pictures. */
#pragma once
#include <petscsys.h>

/* The name of the stage that a state of this time belongs to; PETSC_FALSE: the run has no stages. */
PetscBool plot_stage_at(const char *run, PetscReal time, char name[64]);
