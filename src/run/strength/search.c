#include "run/strength/search.h"

/* below this share of the first factor nobody looks for one that stands */
#define LEAST (1.0 / 1024)
/* by what became of it: what fails in a step of this share of the tolerance has no equilibrium */
static const PetscReal for_good[TRY_N] = {
  [TRY_SLIDES] = 1, [TRY_RUNS] = 0.25, [TRY_LOST] = 1.0 / 16, [TRY_FLOWS] = 1.0 / 16};
/* what would be left before an end, over the shortest of these: not worth a step of its own */
#define CRUMB 0.25

Search search_begin(const ReductionSpec *spec) { return (Search){.step = spec->from}; }

/* Not beyond the end, and not so near to it that round-off or a crumb is left: there. */
static PetscReal up_to(const Search *s, const ReductionSpec *spec, PetscReal next, PetscReal end)
{
  const PetscReal crumb = CRUMB * for_good[TRY_LOST] * spec->tolerance * s->stable;
  return next > end - crumb ? end : next;
}

PetscReal search_next(const Search *s, const ReductionSpec *spec)
{
  const PetscReal gap = s->failed - s->stable;
  PetscReal next = s->stable + s->step;
  if (s->over > 0 || s->stable >= spec->most) return 0;
  if (s->failed > 0 && gap > spec->tolerance * s->stable) next = PetscMin(next, s->stable + 0.5 * gap);
  else if (s->failed > 0) next = up_to(s, spec, next, s->failed);
  return up_to(s, spec, next, spec->most);
}

static void stands(Search *s, const ReductionSpec *spec, PetscReal factor, PetscBool easy)
{
  const PetscReal taken = factor - s->stable;
  s->step = s->stable == 0 ? spec->step : PetscMin(spec->step, easy ? 2 * taken : taken);
  s->stable = factor;
  if (factor >= s->failed) s->failed = 0; /* tried from farther away it had no equilibrium */
}

void search_tell(Search *s, const ReductionSpec *spec, PetscReal factor, TryOutcome outcome, PetscBool easy)
{
  const PetscReal taken = factor - s->stable;
  const PetscReal least = for_good[outcome] * spec->tolerance * s->stable;
  if (outcome == TRY_STANDS) {
    stands(s, spec, factor, easy);
    return;
  }
  s->failed = factor;
  s->step = 0.5 * taken;
  s->over = taken <= least * (1 + 1e-9) || factor <= LEAST * spec->from;
}
