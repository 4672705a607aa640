/* Equilibria in which nothing stays: a column that is pressed by more than it bears, and was found straight. Newton's
 * method finds them as well as others, and the length of a step decides which. */
#include "run/report/warn/warn.h"

void warn_of_unstable(const Model *m, Diag *diag)
{
  const PetscBool still = (PetscBool)(m->unstable.last >= m->time);
  if (!m->unstable.ways) return;
  diag_warning(diag, "analysis.type",
               "%s t = %g s the equilibrium that was found is one in which nothing stays: its stiffness is negative in "
               "%d way%s, as that of a column which is pressed by more than it bears and still stands straight",
               still && m->unstable.first < m->unstable.last ? "from" : "at", (double)m->unstable.first,
               (int)m->unstable.ways, m->unstable.ways > 1 ? "s" : "");
  diag_hint(diag,
            "shorter steps follow what bends, if a small force or an uneven shape says to which side; "
            "`type: dynamic` shows where it goes (docs/guide/limits.md)");
}
