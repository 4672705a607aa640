/* What the tries of a search say in the end: the brackets by three signs of failure, the answer, and where it is to be
 * doubted. */
#include "output/directory/run_dir_files.h"
#include "run/strength/strength.h"

#define ALL_DISSIPATED 0.99
#define QUICKENS 5 /* what fails goes so many times as far for what it loses as it did before, */
#define NEARLY_SLIDES (0.1 * STRENGTH_SLIDES) /* and at least so far, of its height for the share that it loses */

static const char unfinished[] = "the search was ended before it was over";

PetscInt strength_stood_before(const StrengthRun *s, PetscInt i)
{
  for (--i; i > 0 && s->tries[i].outcome != TRY_STANDS;) --i;
  return i;
}

void strength_know_bracket(const StrengthRun *s, Model *m)
{
  m->strength.lower = s->search.stable > 0 ? s->search.stable : NAN;
  m->strength.upper = s->search.failed > 0 ? s->search.failed : NAN;
}

/* Does the try tell how far equilibria go, or where there is none? */
typedef PetscBool (*Says)(const StrengthRun *s, PetscInt i);

static PetscBool balances(const StrengthRun *s, PetscInt i)
{
  return s->tries[i].outcome == TRY_STANDS || s->tries[i].outcome == TRY_SLIDES;
}

static PetscBool slides(const StrengthRun *s, PetscInt i)
{
  const TryOutcome outcome = (TryOutcome)s->tries[i].outcome;
  return (PetscBool)(outcome == TRY_SLIDES || outcome == TRY_RUNS || outcome == TRY_FLOWS);
}

static PetscBool stands(const StrengthRun *s, PetscInt i) { return s->tries[i].outcome == TRY_STANDS; }
static PetscBool fails(const StrengthRun *s, PetscInt i) { return !balances(s, i); }

/* The part of the work of loads and gravity since the last stable state that was dissipated; all of it
 * where nothing more is stored. */
static PetscReal share_dissipated(const StrengthRun *s, PetscInt i)
{
  const Try *a = &s->tries[strength_stood_before(s, i)], *b = &s->tries[i];
  return b->work > a->work ? (b->dissipated - a->dissipated) / (b->work - a->work) : 0;
}

static PetscBool stores(const StrengthRun *s, PetscInt i)
{
  return stands(s, i) && (i == 0 || share_dissipated(s, i) < ALL_DISSIPATED);
}

static PetscBool stores_nothing(const StrengthRun *s, PetscInt i) { return stands(s, i) && i > 0 && !stores(s, i); }

/* "by Newton = 1.38 ... 1.39": the largest factor of which one says yes, and the smallest beyond
 * it of which the other says no. */
static PetscErrorCode TellBracket(const StrengthRun *s, const char *by, Says yes, Says no, const char *what,
                                  RunDir *dir)
{
  PetscReal lower = 0, upper = PETSC_MAX_REAL;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < s->n; ++i)
    if (yes(s, i)) lower = PetscMax(lower, s->tries[i].factor);
  for (PetscInt i = 0; i < s->n; ++i)
    if (no(s, i) && s->tries[i].factor > lower) upper = PetscMin(upper, s->tries[i].factor);
  if (upper < PETSC_MAX_REAL)
    PetscCall(RunDirLog(dir, "by %s = %.5g ... %.5g: %s", by, (double)lower, (double)upper, what));
  else PetscCall(RunDirLog(dir, "by %s > %.5g", by, (double)lower));
  PetscFunctionReturn(0);
}

/* Did the body slide with the smallest factor that fails? */
static PetscBool slid(const StrengthRun *s)
{
  for (PetscInt i = 1; i < s->n; ++i)
    if (s->tries[i].outcome == TRY_SLIDES && s->tries[i].factor == s->search.failed) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* How far the body goes, of its height, for what share of its strength it loses, in a try that stands. */
static PetscReal pace(const StrengthRun *s, PetscInt i)
{
  const Try *before = &s->tries[strength_stood_before(s, i)], *now = &s->tries[i];
  const PetscReal share = strength_share(now->factor - before->factor, now->factor);
  return (now->displacement - before->displacement) / (s->height * share);
}

/* Did it flow in pseudo-time, in the smallest of steps? */
static PetscBool flowed(const StrengthRun *s)
{
  for (PetscInt i = 1; i < s->n; ++i)
    if (s->tries[i].outcome == TRY_FLOWS && s->tries[i].factor == s->search.failed) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Did the body go ever faster, and with the smallest factor that fails run away? */
static PetscBool ran(const StrengthRun *s)
{
  PetscReal slowest = PETSC_MAX_REAL, last = 0;
  PetscBool runs = PETSC_FALSE;
  for (PetscInt i = 1; i < s->n; ++i) {
    if (stands(s, i)) last = pace(s, i), slowest = PetscMin(slowest, last);
    if (s->tries[i].factor == s->search.failed) runs = s->tries[i].outcome == TRY_RUNS;
  }
  return (PetscBool)(runs && last > PetscMax(NEARLY_SLIDES, QUICKENS * slowest));
}

/* Newton's method gave up where nothing ran away or slid, and what stood before neither moved as if it were to slide
 * nor dissipated all work. What is lost by itself may run away, or move, in the smallest of steps. */
static PetscBool is_doubtful(const StrengthRun *s)
{
  const PetscInt last = strength_stood_before(s, s->n - 1);
  PetscBool lost = PETSC_FALSE, flows = PETSC_FALSE;
  for (PetscInt i = 1; i < s->n; ++i) {
    if (s->tries[i].outcome == TRY_LOST && s->tries[i].factor >= s->search.failed) lost = PETSC_TRUE;
    if (stands(s, i)) flows = stores_nothing(s, i);
  }
  if (!lost || last == 0 || slid(s) || ran(s) || flowed(s)) return PETSC_FALSE;
  const PetscInt before = strength_stood_before(s, last);
  const PetscReal taken = strength_share(s->tries[last].factor - s->tries[before].factor, s->tries[last].factor);
  return (PetscBool)(!flows || s->tries[last].moved < NEARLY_SLIDES * s->height * taken);
}

PetscErrorCode StrengthTellUneven(const Model *m, RunDir *dir)
{
  PetscFunctionBeginUser;
  if (m->uneven > 0)
    PetscCall(
      RunDirLog(dir,
                "warning = what is told is unsafe: points stand unevenly in cells, %.0f %% of a uniform stress is "
                "out of balance",
                (double)(100 * m->uneven)));
  PetscFunctionReturn(0);
}

static PetscErrorCode TellAnswer(const StrengthRun *s, const Model *m, RunDir *dir)
{
  const ReductionSpec *spec = &m->c->analysis.reduction;
  const PetscReal stable = s->search.stable, failed = s->search.failed;
  const int digits = (int)PetscMax(2, PetscCeilReal(-PetscLog10Real(failed - stable)));

  PetscFunctionBeginUser;
  PetscCall(TellBracket(s, "Newton", balances, fails, "beyond it no equilibrium is found", dir));
  PetscCall(TellBracket(s, "displacement", stands, slides, "beyond it the body slides", dir));
  PetscCall(TellBracket(s, "energy", stores, stores_nothing, "beyond it 99 % of the work is dissipated", dir));
  if (failed <= spec->from)
    PetscCall(
      RunDirLog(dir, "warning = it does not stand with a factor of %.4g: sought downwards", (double)spec->from));
  if (m->strength.lost) {
    PetscCall(RunDirLog(dir,
                        "warning = Newton's method lost its way before anything slid: no factor is found, it is "
                        "larger (another mesh, formulation, points_per_cell, dilatancy angle, or a larger "
                        "Poisson's ratio tells)"));
    PetscCall(RunDirLog(dir, "factor of safety > %.4g", (double)stable));
    PetscFunctionReturn(0);
  }
  PetscCall(RunDirLog(dir, "factor of safety = %.*f (%.*f ... %.*f)", digits, (double)m->strength.value, digits,
                      (double)stable, digits, (double)failed));
  PetscFunctionReturn(0);
}

PetscErrorCode StrengthEnd(const StrengthRun *s, Model *m, RunDir *dir)
{
  const PetscReal stable = s->search.stable, failed = s->search.failed;
  const PetscBool over = search_next(&s->search, &m->c->analysis.reduction) == 0;

  PetscFunctionBeginUser;
  strength_know_bracket(s, m);
  PetscCall(StrengthTellUneven(m, dir));
  if (failed == 0)
    PetscCall(RunDirLog(dir, "factor of safety > %.4g: %s", (double)stable,
                        over ? "it stands with the largest factor that was asked for" : unfinished));
  else if (stable == 0)
    PetscCall(RunDirLog(dir, "factor of safety < %.4g: %s", (double)failed,
                        over ? "it does not stand, however strong" : unfinished));
  else {
    m->strength.lost = is_doubtful(s);
    if (m->strength.lost) m->strength.upper = NAN;
    else m->strength.value = 0.5 * (stable + failed);
    PetscCall(TellAnswer(s, m, dir));
  }
  PetscFunctionReturn(0);
}
