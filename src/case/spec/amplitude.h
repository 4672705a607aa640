/* A factor that changes with time. */
#pragma once
#include "case/kinematics/kinematics.h"

/* A function of time, linear between its entries and constant outside them. n = 0: not given. */
typedef struct {
  PetscInt n;
  PetscReal *time, *value;
  PetscInt since;     /* stage of the case whose words brought it, */
  PetscBool repeated; /* by a later one, whose case this is, in the same words */
  PetscReal origin;   /* when that began, s: times count from there */
} Amplitude;

/* Value at time t; `fallback` if the amplitude was not given. */
PetscReal amplitude_value(const Amplitude *amplitude, PetscReal t, PetscReal fallback);
/* Integral over [0, t], for prescribed velocities. */
PetscReal amplitude_integral(const Amplitude *amplitude, PetscReal t, PetscReal fallback);
/* The first point later than t; its n: there is none. */
PetscInt amplitude_behind(const Amplitude *amplitude, PetscReal t);
/* The largest size of its values. */
PetscReal amplitude_size(const Amplitude *amplitude);
