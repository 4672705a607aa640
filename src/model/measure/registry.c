/* All measures, from the list in measures.inc. */
#include "model/measure/measure.h"
#include <string.h>

#define MEASURE(x) extern const Measure measure_##x;
#include "model/measure/measures.inc"
#undef MEASURE

const Measure *const measures[] = {
#define MEASURE(x) &measure_##x,
#include "model/measure/measures.inc"
#undef MEASURE
  NULL};

const Measure *measure_find(const char *key)
{
  for (PetscInt k = 0; key && measures[k]; ++k)
    if (!strcmp(measures[k]->key, key)) return measures[k];
  return NULL;
}

const MeasureNumber *measure_number(const MeasureSpec *s)
{
  const Measure *measure = measure_find(s->kind);
  for (const MeasureNumber *const *w = measure->words; w && *w; ++w)
    if (!strcmp((*w)->word, s->word)) return *w;
  return &measure->number;
}

const char *measure_unit(const MeasureSpec *s)
{
  const char *own = measure_number(s)->unit, *unit = own ? own : measure_find(s->kind)->number.unit;
  return s->has_rate ? rate_unit(unit) : unit;
}
