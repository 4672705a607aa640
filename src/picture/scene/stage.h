/* Stages in pictures. */
#pragma once
#include <petscsys.h>

/* The name of the stage that a state belongs to: the one of this number, from 1 on, or, where its file does not tell
 * (0), of this time; PETSC_FALSE: the run has no stages. */
PetscBool plot_stage_at(const char *run, PetscReal time, PetscInt number, char name[64]);
