#include <string.h>
#include "method/time/time_scheme.h"

#define TIME_SCHEME(x) extern const TimeScheme time_scheme_##x;
#include "method/time/time_schemes.inc"
#undef TIME_SCHEME

const TimeScheme *const time_schemes[] = {
#define TIME_SCHEME(x) &time_scheme_##x,
#include "method/time/time_schemes.inc"
#undef TIME_SCHEME
  NULL};

const TimeScheme *time_scheme_of(const AnalysisSpec *a)
{
  if (a->type == ANALYSIS_EXPLICIT) return &time_scheme_explicit;
  const char *usual = a->bossak != 0 ? "bossak" : "newmark";
  const char *name = case_is_static(a) ? "static" : a->scheme ? a->scheme : usual;
  for (PetscInt i = 0; time_schemes[i]; ++i)
    if (!strcmp(time_schemes[i]->name, name)) return time_schemes[i];
  return NULL;
}
