/* From a field of several components to the one number that gives a point its colour. */
#pragma once
#include <petscsys.h>
#include "base/diag/diag.h"

typedef enum { PLOT_COMPONENT, PLOT_MAGNITUDE, PLOT_MISES, PLOT_DEVIATORIC, PLOT_MEAN } PlotReduction;

typedef struct {
  PlotReduction reduction;
  PetscInt component;
  char name[32]; /* "x", "magnitude"; "" for a scalar */
} PlotScalar;

/* Understand the name of a component (NULL: what suits the field): x y z, xx yy zz xy yz zx, a
 * number, magnitude, mean, and mises (sqrt(3/2 s:s)) of a stress, deviatoric (sqrt(2/3 e:e)) of a strain. */
PetscBool plot_scalar_choose(const char *field, PetscInt components, const char *word, Diag *diag, PlotScalar *scalar);
PetscReal plot_scalar_value(const PlotScalar *scalar, PetscInt components, const PetscReal *values);
