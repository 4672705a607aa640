/* What holds a boundary. */
#include "model/measure/measure.h"
#include "model/model_private.h"

static PetscErrorCode Reaction(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  PetscReal sum[3];

  (void)index;
  PetscFunctionBeginUser;
  PetscCall(ModelReaction(m, s->boundary, sum));
  *value = sum[s->component];
  PetscFunctionReturn(0);
}

const Measure measure_reaction = {
  .key = "reaction",
  .number = {
    .unit = "N",
    .help =
      "force that holds a boundary, of the components that it prescribes; one that several entries prescribe at a node "
      "they share is that of the plane side across its axis, else of the first of them, so that entries add up; in "
      "dynamics its mean over the step, so that "
      "times the step it is the impulse; "
      "in axisymmetry y is the whole axial force, x the radial one added up round the circle, which has no "
      "resultant but does the work",
    .of = OF_BOUNDARY,
    .over_step = PETSC_TRUE,
    .value = Reaction}};
