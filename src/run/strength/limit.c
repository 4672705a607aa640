#include "run/strength/limit.h"
#include "base/text.h"
#include "output/directory/run_dir_files.h"
#include "run/report/warn/warn.h"
#include "run/strength/strength.h"

#define GROWTH 1.5 /* of a step that was taken as it was */
/* of the way that lies behind: the largest step, so that the second half of it has some */
#define SHARE 0.15
/* a load that has fallen so many tolerances below its largest does not come back */
#define FALLEN 4
/* Steps that have become so small, of the way that lies behind, will not double it; after so many of them it is asked
 * whether a mechanism flows already, which stores no more than this share of the load's work. */
#define TINY 1e-3
#define CREPT 50
#define STORED 0.1
/* A load that a mechanism carries and that grows from one doubled displacement to the next by ever more, but by no more
 * than this, is past its knee: what yields gets no stiffer, and what is left is the change of shape. */
#define CREEPS 0.05
/* A load that still rises by these shares of what hardening explains is no limit. Below, a bar that is pulled is within
 * 0.54 % of its largest load, exp(-0.1) / 0.9, whatever it hardens by; above, more than half of the rise is of other
 * causes, of which the rule of a doubled displacement knows. */
#define HARDENS 0.1
#define HARDENS_MOST 2

PetscErrorCode LimitRunDestroy(LimitRun *s)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(s->rows));
  PetscFunctionReturn(0);
}

PetscBool limit_goes_on(const LimitRun *s) { return s->outcome == LIMIT_RISES; }

static PetscErrorCode Append(LimitRun *s, const LimitRow *row)
{
  PetscFunctionBeginUser;
  if (s->n == s->capacity) {
    s->capacity = PetscMax(64, 2 * s->capacity);
    PetscCall(PetscRealloc((size_t)s->capacity * sizeof *s->rows, &s->rows));
  }
  s->rows[s->n++] = *row;
  PetscFunctionReturn(0);
}

/* What the model tells of itself where it stands. */
static PetscErrorCode Look(LimitRun *s, Model *m, const StepReport *report)
{
  LimitRow row = {.control = m->time - m->c->analysis.end,
                  .load = m->raised.load,
                  .displacement = m->raised.displacement,
                  .iterations = (PetscReal)report->newton.iterations};
  Energies energies;

  PetscFunctionBeginUser;
  PetscCall(LargestDisplacement(m, &row.largest));
  PetscCall(ModelEnergies(m, &energies));
  row.stored = energies.elastic;
  row.dissipated = energies.dissipated;
  if (s->n) {
    const LimitRow *before = &s->rows[s->n - 1];
    const PetscReal force = case_raises_displacement(m->c) ? 1 : m->raised.resultant;
    const PetscReal way = row.displacement - before->displacement;
    PetscReal hardened;
    row.work = before->work + 0.5 * force * (before->load + row.load) * way;
    PetscCall(RaisedHardening(m, &hardened));
    s->rises = hardened > 0 ? force * (row.load - before->load) * way / hardened : 0;
  }
  PetscCall(Append(s, &row));
  PetscFunctionReturn(0);
}

PetscErrorCode LimitBegin(LimitRun *s, Model *m)
{
  const StepReport none = {0};

  PetscFunctionBeginUser;
  s->step = m->c->analysis.limit.step;
  PetscCall(RaisedBegin(m));
  PetscCall(Look(s, m, &none));
  PetscFunctionReturn(0);
}

/* Along the displacement: that of a wall which goes away from what presses on it is below zero all the time. 0: no load
 * has stood. */
static PetscReal largest_load(const LimitRun *s)
{
  PetscReal most = s->n > 1 ? s->rows[1].load : 0;
  for (PetscInt i = 2; i < s->n; ++i) most = PetscMax(most, s->rows[i].load);
  return most;
}

/* What a change of load is measured by. */
static PetscReal size_of_loads(const LimitRun *s)
{
  PetscReal most = 0;
  for (PetscInt i = 0; i < s->n; ++i) most = PetscMax(most, PetscAbsReal(s->rows[i].load));
  return most;
}

/* What its growth is measured by: how far it has come from what there was to begin with, as the weight on a pipe that
 * is pulled up, to which the first hair's breadth adds next to nothing. */
static PetscReal size_of_rise(const LimitRun *s)
{
  PetscReal most = 0;
  for (PetscInt i = 1; i < s->n; ++i) most = PetscMax(most, PetscAbsReal(s->rows[i].load - s->rows[0].load));
  return most;
}

/* The last row at which no more than this share of the last displacement lay behind; 0: there is none. */
static PetscInt row_at(const LimitRun *s, PetscReal share)
{
  const PetscReal far = share * s->rows[s->n - 1].displacement;
  PetscInt i = s->n - 1;
  while (i > 0 && s->rows[i].displacement > far) --i;
  return i;
}

/* By how much the load grew while the displacement doubled, over its rise; 1 as long as there is no half. */
static PetscReal growth(const LimitRun *s)
{
  const PetscReal size = size_of_rise(s);
  const PetscInt half = row_at(s, 0.5);
  return half > 0 && size > 0 ? (largest_load(s) - s->rows[half].load) / size : 1;
}

/* Between two rows next to nothing of the load's work was stored. */
static PetscBool flows(const LimitRow *a, const LimitRow *b)
{
  const PetscReal work = b->work - a->work;
  return (PetscBool)(work > 0 && PetscAbsReal(b->stored - a->stored) <= STORED * work);
}

/* Has the load passed its knee? The one of half the displacement is then what was to be found. */
static PetscBool creeps_on(const LimitRun *s)
{
  const PetscInt half = row_at(s, 0.5), quarter = row_at(s, 0.25);
  if (quarter < 1 || growth(s) > CREEPS || !flows(&s->rows[half], &s->rows[s->n - 1])) return PETSC_FALSE;
  return (PetscBool)(s->rows[s->n - 1].load - s->rows[half].load >= s->rows[half].load - s->rows[quarter].load);
}

/* Where steps are tiny: what the load would grow by, over its rise, while the displacement doubles, if it went on as
 * in the last of them. It will grow by less, since what yields more and more gets no stiffer. 1: no answer. */
static PetscReal creep(const LimitRun *s)
{
  if (s->n <= CREPT) return 1;
  const LimitRow *b = &s->rows[s->n - 1], *a = b - CREPT;
  const PetscReal way = b->displacement - a->displacement, size = size_of_rise(s);
  if (b->control - a->control > CREPT * TINY * b->control || way <= 0 || size <= 0 || !flows(a, b)) return 1;
  return (b->load - a->load) / way * b->displacement / size;
}

static PetscBool rises_as_it_hardens(const LimitRun *s)
{
  return (PetscBool)(s->rises > HARDENS && s->rises < HARDENS_MOST);
}

/* Where the search ends: what there was to begin with may be all that it bears. */
static LimitOutcome ends(const LimitRun *s, const LimitSpec *spec)
{
  return size_of_rise(s) <= spec->tolerance * size_of_loads(s) ? LIMIT_HOLDS : LIMIT_MOST;
}

static LimitOutcome judge(const LimitRun *s, const LimitSpec *spec, PetscBool forces, PetscBool hardens)
{
  const LimitRow *last = &s->rows[s->n - 1];
  const PetscReal most = largest_load(s);
  if (growth(s) <= spec->tolerance && !rises_as_it_hardens(s)) return LIMIT_HOLDS;
  if (last->load < most - FALLEN * spec->tolerance * size_of_loads(s)) return LIMIT_FALLS;
  if (creep(s) <= spec->tolerance) return LIMIT_FLOWS;
  if (!hardens && creeps_on(s)) return LIMIT_CREEPS;
  if (s->n > spec->steps) return LIMIT_LONG;
  return (forces ? most : last->control * (1 + 1e-9)) >= spec->most ? ends(s, spec) : LIMIT_RISES;
}

/* A size that Newton's method failed with is left alone for a while, as in other runs (step_control.h). */
static void choose_step(LimitRun *s, const LimitSpec *spec, const StepControl *control, const StepReport *report)
{
  const PetscReal came = s->rows[s->n - 1].control;
  s->step = PetscMin((report->cuts ? 1 : GROWTH) * report->dt, PetscMax(spec->step, SHARE * came));
  if (control->failed < PETSC_MAX_REAL) s->step = PetscMin(s->step, PetscMax(0.75 * control->failed, report->dt));
}

PetscErrorCode LimitStep(LimitRun *s, Model *m, RunDir *dir, StepReport *report)
{
  const LimitSpec *spec = &m->c->analysis.limit;
  const PetscBool forces = !case_raises_displacement(m->c);
  PetscReal step = s->step;

  PetscFunctionBeginUser;
  if (!forces) step = PetscMin(step, spec->most - s->rows[s->n - 1].control);
  PetscCall(ModelRaise(m, step, report));
  if (report->outcome == STEP_INTERRUPTED || report->outcome == STEP_POINTS_LOST) PetscFunctionReturn(0);
  if (report->outcome != STEP_ACCEPTED) {
    s->outcome = LIMIT_LOST;
    PetscCall(
      RunDirLog(dir, "lost = no equilibrium with a step of %.3g (%s)", (double)report->dt, report->newton.reason));
    PetscFunctionReturn(0);
  }
  PetscCall(Look(s, m, report));
  choose_step(s, spec, &m->control, report);
  s->outcome = (PetscReal)judge(s, spec, forces, raised_hardens(m));
  PetscCall(RunDirLog(dir, "load = %.6g displacement = %.4g m iterations = %d", (double)m->raised.load,
                      (double)m->raised.displacement, (int)report->newton.iterations));
  PetscFunctionReturn(0);
}

PetscErrorCode LimitWrite(const LimitRun *s, const Model *m, RunDir *dir)
{
  TextStream stream;
  char *text, number[32];

  PetscFunctionBeginUser;
  PetscCall(TextOpen(&stream));
  fprintf(stream.out, "control,load [%s],displacement [m],iterations,largest [m],stored [J],dissipated [J],work [J]\n",
          case_raises_displacement(m->c) ? "N" : "");
  for (PetscInt i = 0; i < s->n; ++i)
    for (int k = 0; k < LIMIT_NUMBERS; ++k) {
      file_format_real(((const PetscReal *)&s->rows[i])[k], number);
      fprintf(stream.out, "%s%s", number, k + 1 < LIMIT_NUMBERS ? "," : "\n");
    }
  PetscCall(TextClose(&stream, &text));
  const PetscErrorCode status = RunDirWriteText(dir, "limit.csv", text);
  PetscCall(PetscFree(text));
  PetscFunctionReturn(status);
}

/* What a load that rose until the end would come to while the displacement doubles, if it went on as in the last steps:
 * load curves of what yields are concave, so that the limit lies below. */
static PetscReal load_ahead(const LimitRun *s)
{
  const LimitRow *b = &s->rows[s->n - 1], *a = &s->rows[PetscMax(0, s->n - 1 - CREPT)];
  const PetscReal way = b->displacement - a->displacement;
  return b->load + (way > 0 ? (b->load - a->load) / way * b->displacement : 0);
}

/* What lies beyond a load that has not come to rest. */
static PetscErrorCode TellBeyond(const LimitRun *s, RunDir *dir)
{
  const LimitOutcome outcome = (LimitOutcome)s->outcome;

  PetscFunctionBeginUser;
  if (outcome == LIMIT_CREEPS)
    PetscCall(RunDirLog(
      dir,
      "by creep = a mechanism flows, and what the load still gains, more in each doubling, is of the change of "
      "shape (less with a larger `young`), or of cells that lock where it dilates: the limit is the "
      "load at half the displacement, for %.6g at its end",
      (double)s->rows[s->n - 1].load));
  if (outcome == LIMIT_LONG)
    PetscCall(RunDirLog(dir,
                        "by bracket = between %.6g and %.6g, which it would come to if it went on as in the last steps",
                        (double)largest_load(s), (double)load_ahead(s)));
  PetscFunctionReturn(0);
}

static PetscErrorCode TellLoad(const LimitRun *s, RunDir *dir)
{
  static const char *const why[LIMIT_N] = {
    [LIMIT_RISES] = "it still rises",
    [LIMIT_HOLDS] = "it holds",
    [LIMIT_FALLS] = "it falls",
    [LIMIT_MOST] = "it still rises where the search was to end (analysis.limit.most)",
    [LIMIT_LOST] = "Newton's method lost its way",
    [LIMIT_CREEPS] = "it creeps on",
    [LIMIT_LONG] = "it still rises after as many steps as the search may take (analysis.limit.steps)",
  };
  const LimitOutcome outcome = (LimitOutcome)s->outcome;

  PetscFunctionBeginUser;
  if (outcome == LIMIT_FLOWS)
    PetscCall(RunDirLog(dir,
                        "by load = it holds: as in the last %d steps, which are tiny, it would grow by %.2g %% while "
                        "the displacement doubles",
                        CREPT, 100 * (double)creep(s)));
  else
    PetscCall(RunDirLog(dir, "by load = %s: it grew by %.2g %% while the displacement doubled", why[outcome],
                        100 * (double)growth(s)));
  PetscCall(TellBeyond(s, dir));
  if (s->rises > HARDENS)
    PetscCall(RunDirLog(dir,
                        "by hardening = its last rise was %.2g times what materials hardened by: with that it may go "
                        "on rising, without `hardening` there is a limit",
                        (double)s->rises));
  PetscFunctionReturn(0);
}

/* Share of the load's work in the last step that was stored: nothing where a mechanism has formed. */
static PetscReal share_stored(const LimitRun *s)
{
  const LimitRow *a = &s->rows[PetscMax(0, s->n - 2)], *b = &s->rows[s->n - 1];
  return b->work > a->work ? (b->stored - a->stored) / (b->work - a->work) : 0;
}

/* A load that falls because its surface leaves the cells whose stress bore it: nobody knows what it would have come
 * to. */
static PetscErrorCode DoubtFall(const LimitRun *s, Model *m, RunDir *dir, PetscBool *doubted)
{
  PetscReal moved = 0;

  PetscFunctionBeginUser;
  if ((LimitOutcome)s->outcome == LIMIT_FALLS) PetscCall(LoadsMoved(m, &moved));
  *doubted = (PetscBool)(moved > 0);
  if (*doubted)
    PetscCall(RunDirLog(dir,
                        "by grid = the loaded surface had moved by %.2g cells when the load fell: these functions make "
                        "loads fall there, whatever the material bears",
                        (double)moved));
  PetscFunctionReturn(0);
}

/* What the search says the load is. */
static PetscReal load_told(const LimitRun *s)
{
  return (LimitOutcome)s->outcome == LIMIT_CREEPS ? s->rows[row_at(s, 0.5)].load : largest_load(s);
}

static PetscBool has_ended(LimitOutcome outcome)
{
  return (PetscBool)(outcome == LIMIT_HOLDS || outcome == LIMIT_FALLS || outcome == LIMIT_FLOWS ||
                     outcome == LIMIT_CREEPS);
}

PetscErrorCode LimitEnd(const LimitRun *s, Model *m, RunDir *dir)
{
  const LimitSpec *spec = &m->c->analysis.limit;
  const PetscReal load = load_told(s);
  PetscBool doubted;

  PetscFunctionBeginUser;
  PetscCall(TellLoad(s, dir));
  PetscCall(DoubtFall(s, m, dir, &doubted));
  const PetscBool found = (PetscBool)(has_ended((LimitOutcome)s->outcome) && !doubted);
  const char *what = found ? "limit load" : "largest load that was reached";
  m->raised.unfound = !found;
  m->raised.value = found || load != 0 ? load : NAN;
  PetscCall(StrengthTellUneven(m, dir));
  PetscCall(RunDirLog(dir, "by energy = %.1f %% of the load's last work was stored", 100 * (double)share_stored(s)));
  if (!found && !PetscIsNanReal(m->raised.value))
    PetscCall(RunDirLog(dir, "warning = no limit was found: the load is the largest that was reached"));
  else if (!found)
    PetscCall(RunDirLog(dir,
                        "warning = no limit was found: with a first increment of %g nothing stands, or the search "
                        "lost its way at once (analysis.limit.step)",
                        (double)spec->step));
  if (case_raises_displacement(m->c))
    PetscCall(RunDirLog(dir, "%s = %.6g N along the displacement of '%s'", what, (double)load, spec->raise));
  else PetscCall(RunDirLog(dir, "%s = %.6g times '%s'", what, (double)load, spec->raise));
  PetscFunctionReturn(0);
}

PetscErrorCode LimitToTables(const LimitRun *s, Tables *tables)
{
  Table *table;

  PetscFunctionBeginUser;
  if (!s->n) PetscFunctionReturn(0);
  PetscCall(TablesAdd(tables, "limit", PETSC_TRUE, 1, &table));
  PetscCall(TableAdd(table, "search", NULL, COLUMN_REAL, LIMIT_SEARCH, (void *)&s->step, NULL));
  PetscCall(TablesAdd(tables, "limit_rows", PETSC_TRUE, s->n, &table));
  PetscCall(TableAdd(table, "numbers", NULL, COLUMN_REAL, LIMIT_NUMBERS, (void *)s->rows, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode LimitFromTables(LimitRun *s, const Tables *tables, char reason[256])
{
  const Table *whole = tables_find(tables, "limit"), *rows = tables_find(tables, "limit_rows");

  PetscFunctionBeginUser;
  if (!whole || !rows || reason[0]) PetscFunctionReturn(0);
  const PetscReal *search = table_data(whole, "search", COLUMN_REAL, LIMIT_SEARCH, reason);
  const PetscReal *numbers = table_data(rows, "numbers", COLUMN_REAL, LIMIT_NUMBERS, reason);
  if (reason[0]) PetscFunctionReturn(0);
  if (whole->rows != 1 || rows->rows < 1 || !(search[0] > 0) || !(search[1] >= 0 && search[1] < LIMIT_N)) {
    snprintf(reason, 256, "limit makes no sense");
    PetscFunctionReturn(0);
  }
  s->step = search[0];
  s->outcome = search[1];
  s->rises = search[2];
  for (PetscInt i = 0; i < rows->rows; ++i) PetscCall(Append(s, (const LimitRow *)numbers + i));
  PetscFunctionReturn(0);
}
