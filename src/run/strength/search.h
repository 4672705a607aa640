/* Which factor is tried next: always a larger one, from the state of the last that stands. */
#pragma once
#include "case/case.h"

/* What became of a try: Newton's method found an equilibrium that is near, one that is far away, none
 * while some node ran away, none at all. It may lose its way wherever points yield anew, and finds it
 * in a smaller step; so what is lost counts for less than what slides. In pseudo-time something flows that has found
 * none: in a smaller step that may not be so. */
typedef enum { TRY_STANDS, TRY_SLIDES, TRY_RUNS, TRY_LOST, TRY_FLOWS, TRY_N } TryOutcome;

typedef struct {
  PetscReal stable; /* the largest factor with an equilibrium; 0: nothing has yielded yet */
  PetscReal failed; /* the smallest above it that slid or was lost; 0: none */
  PetscReal step;   /* to the next */
  PetscReal over;   /* 1: there is nothing left to try */
} Search;
#define SEARCH_NUMBERS 4

Search search_begin(const ReductionSpec *spec);
/* The next factor; 0: the search is over. */
PetscReal search_next(const Search *search, const ReductionSpec *spec);
/* easy: has Newton's method found it quickly? */
void search_tell(Search *search, const ReductionSpec *spec, PetscReal factor, TryOutcome outcome, PetscBool easy);
