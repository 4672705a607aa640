/* Where the time of a run goes: seconds by phase of a step. */
#pragma once
#include <petsctime.h>

typedef enum {
  /* who has which part of the grid: looked at in every step, and what it takes to share it anew */
  PHASE_REPARTITION,
  PHASE_PATTERN, /* which nodes carry unknowns, sparse pattern, slots of the groups in it */
  PHASE_PREPARE, /* history, first guess, loads */
  PHASE_POINTS,  /* point work with the scatter into the blocks of the tangent */
  PHASE_MATRIX,  /* blocks -> matrix, and its making for a new pattern */
  /* linear solves with the set-up of their preconditioners: factorisations, too */
  PHASE_LINEAR,
  PHASE_NEWTON,     /* Newton's own work with vectors */
  PHASE_COMMIT,     /* state and F of the accepted step */
  PHASE_MOVE,       /* points move, find their cells, change ranks, get sorted */
  PHASE_INITIALISE, /* shape functions, nodal mass and motion */
  PHASE_N
} Phase;

static const char *const phase_names[PHASE_N] = {"repartition", "pattern", "prepare", "points", "matrix",
                                                 "linear",      "newton",  "commit",  "move",   "initialise"};

/* The same for people who read where their time went. */
static const char *const phase_help[PHASE_N] = {
  "sharing the grid anew",       "unknowns, sparse pattern",
  "loads, first guess",          "stress, forces and tangents of the points",
  "tangent into the matrix",     "linear solves",
  "Newton's method beside them", "new state of the points",
  "moving the points",           "shape functions, mass and motion of the nodes"};

/* Charge the time since *clock to a phase and set the clock anew. */
static inline PetscErrorCode PhaseEnd(PetscReal seconds[PHASE_N], Phase phase, PetscLogDouble *clock)
{
  PetscLogDouble now;
  PetscFunctionBeginUser;
  PetscCall(PetscTime(&now));
  seconds[phase] += now - *clock;
  *clock = now;
  PetscFunctionReturn(0);
}
