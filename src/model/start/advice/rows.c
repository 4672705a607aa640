/* A history of the end alone, whose numbers of forces are means over the whole run: its user may mean the last step. */
#include "model/measure/measure.h"
#include "model/model_private.h"

PetscErrorCode AdviseRows(const Model *m, Diag *diag)
{
  const Case *c = m->c;
  PetscBool is;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; c->output.history == 0 && k < c->n_measures; ++k) {
    PetscCall(MeasureRowIsMean(c, k, &is));
    if (!is) continue;
    diag_warning(diag, "output.history", "its row at the end has of '%s' the mean over all steps", c->measures[k].name);
    diag_hint(diag, "what it is in the last step stands in the log: ask for more rows, or for a `mean` in a window");
    break;
  }
  PetscFunctionReturn(0);
}
