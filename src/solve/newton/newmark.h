/* Newmark's method with Bossak's alpha and mass-proportional Rayleigh damping (thesis eqs. 2.10-2.13).
 *
 *   a1 = (du - dt v) / (beta dt^2) - (1 / (2 beta) - 1) a        v1 = v + dt ((1 - gamma) a + gamma a1)
 *
 * Balance of momentum holds with the effective acceleration (1 - alpha) a1 + alpha a + damping v1 = c0 du + h. */
#pragma once
#include "case/case.h"

typedef struct {
  PetscReal beta, gamma, bossak, damping, dt;
} Newmark;

static inline Newmark newmark_of(const AnalysisSpec *a, PetscReal dt)
{
  return (Newmark){.beta = a->beta, .gamma = a->gamma, .bossak = a->bossak, .damping = a->damping, .dt = dt};
}

/* c0: derivative of the effective acceleration with respect to du, 1/s2. */
static inline PetscReal newmark_inertia(const Newmark *n)
{
  return (1 - n->bossak) / (n->beta * n->dt * n->dt) + n->damping * n->gamma / (n->beta * n->dt);
}

/* New acceleration of one component. */
static inline PetscReal newmark_acceleration(const Newmark *n, PetscReal du, PetscReal v, PetscReal a)
{
  return (du - n->dt * v) / (n->beta * n->dt * n->dt) - (0.5 / n->beta - 1) * a;
}

static inline PetscReal newmark_velocity(const Newmark *n, PetscReal v, PetscReal a, PetscReal a1)
{
  return v + n->dt * ((1 - n->gamma) * a + n->gamma * a1);
}

/* h: effective acceleration for du = 0, m/s2. */
static inline PetscReal newmark_history(const Newmark *n, PetscReal v, PetscReal a)
{
  const PetscReal a1 = newmark_acceleration(n, 0, v, a);
  return (1 - n->bossak) * a1 + n->bossak * a + n->damping * newmark_velocity(n, v, a, a1);
}

/* First guess: acceleration stays. */
static inline PetscReal newmark_guess(const Newmark *n, PetscReal v, PetscReal a)
{
  return n->dt * (v + 0.5 * n->dt * a);
}
