/* How far to go along a Newton direction. */
#pragma once
#include <petscsnes.h>

/* Line.enough: what most steps take, and what those of matter that yields everywhere do (StepProblem.stiff, weaker) */
#define ENOUGH 0.8
#define ENOUGH_STIFF 0.5

/* The way from a place along a direction: x - lambda y. */
typedef struct {
  /* |F| there, infinite or NaN where a law fails, and y . F: the work that is left along y */
  PetscErrorCode (*evaluate)(void *context, PetscReal lambda, PetscReal *norm, PetscReal *slope);
  void *context;
  PetscReal enough;              /* share of the work along the direction that may be left */
  PetscBool wary;                /* where the work has grown, does the search go back? */
  PetscReal lambda, norm, slope; /* the last place tried; norm and slope infinite where the law fails */
} Line;

PetscErrorCode LineTry(Line *line, PetscReal lambda);
/* After a first try: a bracketed secant on the slope, unless little enough work is left there; slope0 and norm0
 * are those at lambda = 0. norm stays infinite if the law fails wherever it was tried. */
PetscErrorCode LineShorten(Line *line, PetscReal slope0, PetscReal norm0);

/* What a search remembers from one iteration of a step to the next. */
typedef struct {
  PetscReal enough; /* Line.enough */
  PetscBool wary;   /* Line.wary; and is the first direction of a step shortened as the others are? */
  PetscReal best;   /* smallest residual of this step */
  PetscInt stale;   /* iterations since it was met */
  PetscInt block;   /* unknowns per node of which the last is a pressure; 0: none is */
  /* Collective; NULL: nothing. From the residual where a direction starts, and its norm; and what is
   * done to every place along it before the residual there is taken. */
  PetscErrorCode (*choose)(void *context, PetscInt iteration, Vec f, PetscReal norm);
  PetscErrorCode (*settle)(void *context, Vec x);
  /* Another unknown beside x: NULL, or all three. Collective: the direction y from x may be changed; then
   * each place along it is told, and at last the length that is taken. */
  PetscErrorCode (*begin)(void *context, Vec x, Vec y);
  void (*place)(void *context, PetscReal length);
  void (*end)(void *context, PetscReal length);
  /* work along the direction that is not in its vectors; NULL: none */
  PetscReal (*beside)(void *context);
  void *context;
} LineSearchMemory;

/* For SNESLineSearchShellSetUserFunc, with a LineSearchMemory as context. The first direction of a
 * step is taken in full, unless a point would be turned inside out: from rest a good iteration lets
 * the residual grow by two orders before it falls. Later directions are shortened (a bracketed
 * secant on y . F) if too much work along the direction is left. Plastic points can also hand the
 * iteration back and forth between two sides of their yield surface, each full step passing that
 * test: after three iterations without progress half steps are taken. */
PetscErrorCode LineSearchDescend(SNESLineSearch search, void *memory);
