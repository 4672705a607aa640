#include "run/strength/strength.h"
#include "base/text.h"
#include "output/directory/run_dir_files.h"

#define CLOSE 0.25      /* of the tolerance: what slides in so short a step slides */
#define SLIDES_FAR 0.01 /* so many of its own heights what moves goes, */
#define SLIDES_TRIES 3  /* in so many tries at least, before it is called so; */
#define LOW (1.0 / 3)   /* if it is no higher than that of all that is there */
#define EASY 8          /* Newton's iterations after which the next step is larger */

static const char *const outcome_words[TRY_N] = {"stands", "slides", "runs", "lost", "flows"};

PetscErrorCode StrengthRunDestroy(StrengthRun *s)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(s->tries));
  PetscFunctionReturn(0);
}

static PetscErrorCode Append(StrengthRun *s, const Try *try)
{
  PetscFunctionBeginUser;
  if (s->n == s->capacity) {
    s->capacity = PetscMax(16, 2 * s->capacity);
    PetscCall(PetscRealloc((size_t)s->capacity * sizeof *s->tries, &s->tries));
  }
  s->tries[s->n++] = *try;
  PetscFunctionReturn(0);
}

PetscErrorCode LargestDisplacement(const Model *m, PetscReal *largest)
{
  PetscReal local = 0;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    PetscReal square = 0;
    for (PetscInt d = 0; d < m->dim; ++d) square += PetscSqr(point_real(m->points, POINT_U, p)[d]);
    local = PetscMax(local, square);
  }
  PetscCall(MPIU_Allreduce(&local, largest, 1, MPIU_REAL, MPIU_MAX, m->comm));
  *largest = PetscSqrtReal(*largest);
  PetscFunctionReturn(0);
}

/* What the model tells of itself where it stands. */
static PetscErrorCode Look(Model *m, Try *try)
{
  Energies energies;

  PetscFunctionBeginUser;
  PetscCall(LargestDisplacement(m, &try->displacement));
  if (try->factor > 0) PetscCall(MovingHeight(m, &try->height));
  PetscCall(ModelEnergies(m, &energies));
  try->dissipated = energies.dissipated + energies.friction;
  try->work = energies.external;
  PetscFunctionReturn(0);
}

/* Of the material at the start of the search, along the axis that gravity is nearest to. */
static PetscErrorCode Height(const Model *m, PetscReal *height)
{
  PetscReal low = PETSC_MAX_REAL, high = -PETSC_MAX_REAL, all[2];
  const PetscInt axis = case_height_axis(m->c);

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal x = point_real(m->points, POINT_X, p)[axis];
    low = PetscMin(low, x);
    high = PetscMax(high, x);
  }
  PetscReal local[2] = {-low, high};
  PetscCall(MPIU_Allreduce(local, all, 2, MPIU_REAL, MPIU_MAX, m->comm));
  *height = all[0] + all[1];
  PetscFunctionReturn(0);
}

PetscErrorCode StrengthBegin(StrengthRun *s, Model *m)
{
  Try try = {.outcome = TRY_STANDS};

  PetscFunctionBeginUser;
  s->search = search_begin(&m->c->analysis.reduction);
  PetscCall(Height(m, &s->height));
  PetscCall(Look(m, &try));
  PetscCall(Append(s, &try));
  PetscFunctionReturn(0);
}

static PetscErrorCode Tell(const Try *try, const char *reason, RunDir *dir)
{
  PetscFunctionBeginUser;
  if (try->outcome == TRY_STANDS)
    PetscCall(RunDirLog(dir, "factor = %.5g stands iterations = %d displacement = %.4g m dissipated = %.3g J",
                        (double)try->factor, (int)try->iterations, (double)try->displacement, (double)try->dissipated));
  else
    PetscCall(RunDirLog(dir, "factor = %.5g %s iterations = %d (%s)", (double)try->factor,
                        outcome_words[(TryOutcome)try->outcome], (int)try->iterations, reason));
  PetscFunctionReturn(0);
}

/* What yields first moves at once as far as it has to, in a body that stands, too. So the first factor is tried from
 * where nothing yields, and if the body goes far then a larger one as well: does it go farther by what slides? */
static PetscErrorCode TryLarger(const StrengthRun *s, Model *m, Try *try, StepReport *report)
{
  const PetscReal more = m->c->analysis.reduction.tolerance * try->factor;
  const StepReport first = *report;
  Try larger = *try;

  PetscFunctionBeginUser;
  larger.factor += more;
  m->strength.reach = try->moved + STRENGTH_SLIDES * s->height * strength_share(more, larger.factor);
  PetscCall(ModelTryFactor(m, larger.factor, report, &larger.moved));
  if (report->outcome == STEP_ACCEPTED) *try = larger;
  else if (report->outcome == STEP_TOO_SMALL) *report = first;
  PetscFunctionReturn(0);
}

/* Did what moved in try i, which stands, go as far as what slides, by its own height? */
static PetscBool goes_on(const StrengthRun *s, PetscInt i)
{
  const Try *before = s->tries + strength_stood_before(s, i), *now = s->tries + i;
  if (now->height > LOW * s->height) return PETSC_FALSE;
  return (PetscBool)(now->moved - now->anew >
                     STRENGTH_SLIDES * now->height * strength_share(now->factor - before->factor, now->factor));
}

/* Is the slide of so many tries, after the one that stood, a long one? */
static PetscBool is_long(const StrengthRun *s, PetscInt stood, PetscInt tries)
{
  const Try *last = s->tries + s->n - 1;
  return (PetscBool)(tries >= SLIDES_TRIES &&
                     last->displacement - s->tries[stood].displacement > SLIDES_FAR * last->height);
}

/* What is low beside all that is there slides, and rests again, by less than that would: a step of a metre on 16
 * m of ground crept 1.6 m for a factor of one, up to nine. Each try of that stands. So where what moves has gone on by
 * its own height in all tries of a long slide, it has been sliding since the first of them. */
static PetscErrorCode SeeLongSlide(StrengthRun *s, RunDir *dir)
{
  const Try *last = s->tries + s->n - 1;
  PetscInt first = s->n - 1, tries = 0;

  PetscFunctionBeginUser;
  if (last->outcome != TRY_STANDS) PetscFunctionReturn(0);
  for (PetscInt i = first; i > 1 && s->tries[strength_stood_before(s, i)].factor > 0 && goes_on(s, i);
       i = strength_stood_before(s, i))
    first = i, ++tries;
  const PetscInt stood = strength_stood_before(s, first);
  if (!is_long(s, stood, tries)) PetscFunctionReturn(0);
  PetscCall(RunDirLog(dir,
                      "factor = %.5g and beyond slides: %.3g m up to %.5g, and what moves is %.3g m high; the state is "
                      "that of the last",
                      (double)s->tries[first].factor, (double)(last->displacement - s->tries[stood].displacement),
                      (double)last->factor, (double)last->height));
  s->search.stable = s->tries[stood].factor;
  s->search.failed = s->tries[first].factor;
  s->search.over = 1;
  for (PetscInt i = first; i < s->n; ++i)
    if (s->tries[i].outcome == TRY_STANDS) s->tries[i].outcome = TRY_SLIDES;
  PetscFunctionReturn(0);
}

/* *counts: has it an outcome, and was not cut off? */
static PetscErrorCode TryOnce(const StrengthRun *s, Model *m, Try *try, StepReport *report, PetscBool *counts)
{
  PetscFunctionBeginUser;
  m->strength.anew = 0;
  m->strength.reach =
    STRENGTH_SLIDES * s->height *
    strength_share(PetscMin(try->factor - s->search.stable, m->c->analysis.reduction.tolerance * try->factor),
                   try->factor);
  PetscCall(ModelTryFactor(m, try->factor, report, &try->moved));
  if (report->leap[0] && s->search.stable == 0) PetscCall(TryLarger(s, m, try, report));
  *counts = (PetscBool)(report->outcome != STEP_INTERRUPTED && report->outcome != STEP_POINTS_LOST);
  if (!*counts) PetscFunctionReturn(0);
  try->outcome = (PetscReal)(report->outcome == STEP_ACCEPTED ? TRY_STANDS
                             : report->flows                  ? TRY_FLOWS
                             : report->leap[0]                ? TRY_SLIDES
                             : try->moved > m->strength.reach ? TRY_RUNS
                                                              : TRY_LOST);
  try->iterations = (PetscReal)report->newton.iterations;
  try->anew = m->strength.anew;
  PetscCall(Look(m, try));
  PetscFunctionReturn(0);
}

static PetscErrorCode Keep(StrengthRun *s, const Try *try, const char *reason, RunDir *dir)
{
  PetscFunctionBeginUser;
  PetscCall(Append(s, try));
  PetscCall(Tell(try, reason, dir));
  PetscFunctionReturn(0);
}

/* What slides is tried again with half the step, from the same state: only what of its way grows with the factor is a
 * slide (model/analysis/strength.c). *try: that of half the step. */
static PetscErrorCode TryHalf(StrengthRun *s, Model *m, RunDir *dir, Try *try, StepReport *report, PetscBool *counts)
{
  const ReductionSpec *spec = &m->c->analysis.reduction;
  const PetscReal reach = m->strength.reach;
  const Try whole = *try;
  char reason[sizeof report->leap];

  PetscFunctionBeginUser;
  snprintf(reason, sizeof reason, "%s", report->newton.reason);
  *try = (Try){.factor = 0.5 * (s->search.stable + whole.factor)};
  PetscCall(TryOnce(s, m, try, report, counts));
  if (!*counts) PetscFunctionReturn(0);
  PetscCall(Keep(s, &whole, reason, dir));
  if (try->outcome != TRY_STANDS || 2 * (whole.moved - try->moved) > reach)
    search_tell(&s->search, spec, whole.factor, TRY_SLIDES, PETSC_FALSE);
  else if (whole.factor >= s->search.failed) s->search.failed = 0; /* tried from farther away it slid */
  PetscFunctionReturn(0);
}

PetscErrorCode StrengthTry(StrengthRun *s, Model *m, RunDir *dir, StepReport *report)
{
  const ReductionSpec *spec = &m->c->analysis.reduction;
  Try try = {.factor = search_next(&s->search, spec)};
  PetscBool counts;

  PetscFunctionBeginUser;
  m->strength.slid_by = 0;
  PetscCall(TryOnce(s, m, &try, report, &counts));
  if (counts && try.outcome == TRY_SLIDES && s->search.stable > 0 &&
      try.factor > (1 + CLOSE * spec->tolerance) * s->search.stable)
    PetscCall(TryHalf(s, m, dir, &try, report, &counts));
  if (!counts) PetscFunctionReturn(0);
  PetscCall(Keep(s, &try, report->newton.reason, dir));
  search_tell(&s->search, spec, try.factor, (TryOutcome)try.outcome, report->newton.iterations <= EASY);
  PetscCall(SeeLongSlide(s, dir));
  strength_know_bracket(s, m);
  PetscFunctionReturn(0);
}

PetscErrorCode StrengthWrite(const StrengthRun *s, RunDir *dir)
{
  TextStream stream;
  char *text, number[32];

  PetscFunctionBeginUser;
  PetscCall(TextOpen(&stream));
  fputs("factor,stable,outcome,iterations,increment [m],displacement [m],dissipated [J],work [J]\n", stream.out);
  for (PetscInt i = 0; i < s->n; ++i) {
    const Try *try = &s->tries[i];
    const PetscReal columns[] = {try->moved, try->displacement, try->dissipated, try->work};
    file_format_real(try->factor, number);
    const TryOutcome outcome = (TryOutcome)try->outcome;
    fprintf(stream.out, "%s,%s,%s,%d", number, outcome == TRY_STANDS ? "yes" : "no", outcome_words[outcome],
            (int)try->iterations);
    for (int k = 0; k < 4; ++k) {
      file_format_real(columns[k], number);
      fprintf(stream.out, ",%s", number);
    }
    fputc('\n', stream.out);
  }
  PetscCall(TextClose(&stream, &text));
  const PetscErrorCode status = RunDirWriteText(dir, "factor.csv", text);
  PetscCall(PetscFree(text));
  PetscFunctionReturn(status);
}

PetscErrorCode StrengthToTables(const StrengthRun *s, Tables *tables)
{
  Table *table;

  PetscFunctionBeginUser;
  if (!s->n) PetscFunctionReturn(0);
  PetscCall(TablesAdd(tables, "factor", PETSC_TRUE, 1, &table));
  PetscCall(TableAdd(table, "search", NULL, COLUMN_REAL, SEARCH_NUMBERS, (void *)&s->search, NULL));
  PetscCall(TableAdd(table, "height", "m", COLUMN_REAL, 1, (void *)&s->height, NULL));
  PetscCall(TablesAdd(tables, "factors_tried", PETSC_TRUE, s->n, &table));
  PetscCall(TableAdd(table, "numbers", NULL, COLUMN_REAL, TRY_NUMBERS, (void *)s->tries, NULL));
  PetscFunctionReturn(0);
}

static PetscBool makes_sense(const PetscReal *search, const Table *tries, const PetscReal *numbers)
{
  for (int k = 0; k < SEARCH_NUMBERS; ++k)
    if (!(search[k] >= 0 && search[k] <= PETSC_MAX_REAL)) return PETSC_FALSE;
  for (PetscInt i = 0; i < tries->rows; ++i) {
    const PetscReal outcome = ((const Try *)numbers)[i].outcome;
    if (!(outcome >= 0 && outcome < TRY_N)) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

PetscErrorCode StrengthFromTables(StrengthRun *s, const Tables *tables, char reason[256])
{
  const Table *whole = tables_find(tables, "factor"), *tries = tables_find(tables, "factors_tried");

  PetscFunctionBeginUser;
  if (!whole || !tries || reason[0]) PetscFunctionReturn(0);
  const PetscReal *search = table_data(whole, "search", COLUMN_REAL, SEARCH_NUMBERS, reason);
  const PetscReal *height = table_data(whole, "height", COLUMN_REAL, 1, reason);
  const PetscReal *numbers = table_data(tries, "numbers", COLUMN_REAL, TRY_NUMBERS, reason);
  if (reason[0]) PetscFunctionReturn(0);
  if (whole->rows != 1 || !(*height >= 0) || !makes_sense(search, tries, numbers)) {
    snprintf(reason, 256, "factor makes no sense");
    PetscFunctionReturn(0);
  }
  PetscCall(PetscArraycpy((PetscReal *)&s->search, search, SEARCH_NUMBERS));
  s->height = *height;
  for (PetscInt i = 0; i < tries->rows; ++i) PetscCall(Append(s, (const Try *)numbers + i));
  PetscFunctionReturn(0);
}
