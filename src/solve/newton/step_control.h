/* How large the next step is. It grows after easy steps, up to `largest`; it remembers at which
 * size Newton failed and does not go there again at once; and where points flow through a grid none
 * of them may travel too far in a step. */
#pragma once
#include "case/case.h"

#define STEP_WAIT 5       /* accepted steps before a size that failed is tried again */
#define STEP_WAIT_MOST 80 /* the same after failures that follow each other */

typedef struct {
  PetscReal next;           /* the step to try, s */
  PetscReal failed;         /* the smallest step that failed lately, s; PETSC_MAX_REAL if none */
  PetscInt wait;            /* accepted steps until that is forgotten */
  PetscInt patience, since; /* what `wait` started from; accepted steps since the last failure */
} StepControl;

/* What a step was like that Newton solved. */
typedef struct {
  PetscReal dt;        /* s */
  PetscInt iterations; /* of the try that converged */
  PetscBool shortened; /* by the caller (an output was due), not by the control */
  PetscBool returning; /* it was, to come back to the times asked for */
  /* a step in which the fastest point goes as far as it may, s; PETSC_MAX_REAL if nothing flows */
  PetscReal reach;
} StepTaken;

void step_control_start(StepControl *control, PetscReal step);
/* Newton failed with dt: the step to try instead. */
PetscReal step_control_cut(StepControl *control, PetscReal dt);
/* After a step was halved or ended elsewhere: how long the next one may be at most, so that steps which are no longer
 * than analysis->step come back to the times that it counts, in parts that are alike. came: since these times began,
 * s. PETSC_MAX_REAL: as long as it likes. */
PetscReal step_control_return(const StepControl *control, const AnalysisSpec *analysis, PetscReal came);
/* Newton solved the step: chooses `next`. Never takes it below analysis->step for the sake of
 * iterations or reach. */
void step_control_accept(StepControl *control, const AnalysisSpec *analysis, PetscInt ease, const StepTaken *taken);
