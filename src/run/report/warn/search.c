/* Searches that found nothing: for a limit load, for a factor of safety. */
#include "run/report/warn/warn.h"

static void warn_of_no_limit(const Model *m, Diag *diag)
{
  if (!m->raised.unfound) return;
  diag_warning(diag, "analysis.limit.raise", "no limit was found: %s",
               isnan(m->raised.value) ? "the search lost its way before any load stood"
                                      : "what is told is the largest load that was reached");
}

static void warn_of_no_factor(const Model *m, Diag *diag)
{
  if (!m->strength.lost) return;
  diag_warning(
    diag, "analysis.type",
    "no factor of safety was found, it is larger than %.4g: Newton's method lost its way before anything slid",
    (double)m->strength.lower);
}

void warn_of_search(const Model *m, Diag *diag)
{
  warn_of_no_limit(m, diag);
  warn_of_no_factor(m, diag);
}
