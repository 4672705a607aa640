/* What a run has lost on the way is said: in the log when it happens, in the summary, and as
 * warnings at the end. */
#include "run/report/losses.h"
#include "base/text.h"
#include "method/transfer/transfer.h"
#include "model/measure/measure.h"
#include "run/report/sheared.h"
#include "run/report/stretched.h"
#include "run/report/unstable.h"
#include "run/report/sunk.h"
#include "run/report/through.h"

/* share of the energy that came in: about what granular flows lose on usual grids */
#define TRANSFER_ALLOWED 0.05
/* likewise: a tenth of the strain, or a set of about 0.005 of the way */
#define KEPT_ALLOWED 0.01
/* times all that came in */
#define MOTION_ALLOWED 10
/* share of the volume: unevenness of points that have moved through many cells is 0.1 to 0.2 */
#define CROWD_ALLOWED 0.3
/* cells that a loaded surface may move: until points beside it cross to the next one */
#define WAY_ALLOWED 0.5
#define WAY_ALLOWED_YIELDING 0.15 /* a block of four cells that yields beside it bears 6 % too little at 0.2 */

/* Has a count that grew by `more` at least doubled, or passed a power of two? So a thousand points
 * take ten lines, not a thousand. */
static PetscBool is_worth_a_line(PetscReal count, PetscReal more)
{
  PetscReal power = 1;
  while (2 * power <= count) power *= 2;
  return more > 0 && count - more < power;
}

static PetscErrorCode LogOutside(const Model *m, RunDir *dir, const StepReport *report)
{
  const Outside *o = &m->outside;
  const LostPoint *first = &report->first_outside;
  char at[80];

  PetscFunctionBeginUser;
  if (is_worth_a_line(o->removed, (PetscReal)report->removed))
    PetscCall(
      RunDirLog(dir,
                "outside = step %d time = %.9g removed = %d since the start = %.0f mass = %.6g kg, the first of the "
                "step is point %lld at %s m",
                (int)m->step, (double)m->time, (int)report->removed, (double)o->removed, (double)o->mass,
                (long long)first->id, text_position(m->dim, first->x, at)));
  if (is_worth_a_line(o->held, (PetscReal)report->held))
    PetscCall(
      RunDirLog(dir,
                "outside = step %d time = %.9g kept on the boundary = %d times since the start = %.0f, the first of "
                "the step is point %lld at %s m",
                (int)m->step, (double)m->time, (int)report->held, (double)o->held, (long long)first->id,
                text_position(m->dim, first->x, at)));
  PetscFunctionReturn(0);
}

PetscErrorCode LossesLogStep(Model *m, RunDir *dir, const StepReport *report)
{
  char at[80];

  PetscFunctionBeginUser;
  if (m->c->n_measures + m->c->n_loads) PetscCall(ModelInitialise(m)); /* which finds what ended */
  for (PetscInt k = 0; k < m->c->n_measures; ++k)
    if (m->memory[k].ended > 0 && m->memory[k].ended == m->time)
      PetscCall(RunDirLog(
        dir,
        "ended = %s step %d time = %.9g: no node of the grid carries its tracer any more, last at %s m; nan from "
        "now on",
        m->c->measures[k].name, (int)m->step, (double)m->time, text_position(m->dim, m->memory[k].where, at)));
  for (PetscInt k = 0; k < m->c->n_loads; ++k) {
    const LoadMemory *l = &m->load_memory[k];
    if (l->ended > 0 && l->ended == m->time)
      PetscCall(
        RunDirLog(dir,
                  "ended = load %d step %d time = %.9g: the material has left %.0f of its carriers behind, about %s m; "
                  "their force so far is (%.6g, %.6g, %.6g) N at amplitude 1",
                  (int)k, (int)m->step, (double)m->time, (double)l->carriers, text_position(m->dim, l->where, at),
                  (double)l->force[0], (double)l->force[1], (double)l->force[2]));
  }
  PetscCall(LogOutside(m, dir, report));
  PetscFunctionReturn(0);
}

/* Is it, or what came in, more than steps leave open? */
static PetscBool counts(const Model *m, PetscReal energy)
{
  return (PetscBool)(m->most_energy > 0 && PetscMax(m->most_energy, PetscAbsReal(energy)) > energy_unresolved(m));
}

static PetscReal share_of_input(const Model *m, PetscReal energy)
{
  return counts(m, energy) ? energy / m->most_energy : 0;
}

PetscErrorCode LossesLogEnd(const Model *m, RunDir *dir)
{
  const Outside *o = &m->outside;

  PetscFunctionBeginUser;
  if (o->removed > 0)
    PetscCall(
      RunDirLog(dir,
                "outside: %.0f points of %.6g kg left the grid and were removed between t = %.9g and %.9g s, with %.6g "
                "J and momentum (%.6g, %.6g, %.6g) kg m/s",
                (double)o->removed, (double)o->mass, (double)o->first, (double)o->last, (double)o->energy,
                (double)o->momentum[0], (double)o->momentum[1], (double)o->momentum[2]));
  if (o->held > 0)
    PetscCall(
      RunDirLog(dir,
                "outside: points were kept on the boundary of the grid %.0f times between t = %.9g and %.9g s, at most "
                "%.0f of %.6g kg in a step; that took %.6g J and momentum (%.6g, %.6g, %.6g) kg m/s",
                (double)o->held, (double)o->first, (double)o->last, (double)o->held_most, (double)o->held_most_mass,
                (double)o->energy, (double)o->momentum[0], (double)o->momentum[1], (double)o->momentum[2]));
  if (counts(m, m->transfer_energy))
    PetscCall(RunDirLog(
      dir,
      "transfer = %.6g J between points and grid, %.2g %% of the %.6g J that came in (start, loads, gravity, "
      "prescribed motion)",
      (double)m->transfer_energy, (double)(100 * share_of_input(m, m->transfer_energy)), (double)m->most_energy));
  const PetscReal numerical = share_of_input(m, m->numerical_energy);
  if (PetscAbsReal(numerical) > TRANSFER_ALLOWED)
    PetscCall(RunDirLog(dir, "numerical = %.6g J taken by the damping of the time scheme, %.2g %% of what came in",
                        (double)m->numerical_energy, (double)(100 * numerical)));
  PetscFunctionReturn(0);
}

/* What the transfer has taken. Bossak's scheme lets what touches leave a step with another velocity than impulses then
 * give it: what they take stands there, the same made in the damping, and their sum counts. */
static PetscReal taken_by_transfer(const Model *m)
{
  const PetscReal sum = m->transfer_energy + m->numerical_energy;
  const PetscBool cancels = (PetscBool)(m->contact && PetscAbsReal(sum) < PetscAbsReal(m->transfer_energy));
  return cancels ? sum : m->transfer_energy;
}

/* Statics of points of no extent, where these could have one. */
static PetscBool loses_at_lines(const Model *m)
{
  return (PetscBool)(m->method->restores_grid && case_is_static(&m->c->analysis) && m->grid->box &&
                     !strcmp(m->c->basis.kind, "cell"));
}

/* Clouds that choose their nodes anew have other forces than those that accelerations balanced, and in short steps that
 * rings more often: what damps it best. */
static const char *damps_clouds(const Model *m)
{
  const AnalysisSpec *a = &m->c->analysis;
  if (strcmp(m->c->basis.kind, "lme") != 0) return "`basis: {lme: {}}`, or ";
  if (a->bossak > -0.1) return "`analysis: {bossak: -0.1}`, or ";
  return a->bossak > -0.3 ? "`analysis: {bossak: -0.3}`, or " : "";
}

static void hint_of_clouds(const Model *m, Diag *diag)
{
  diag_hint(diag,
            "clouds that change where material is pressed flat or flows past what holds it make it, and shorter "
            "steps more: %smethods mpm and fem (docs/guide/limits.md)",
            damps_clouds(m));
}

/* Of forces by a table: is there one when that begins? Gravity that bodies begin in balance with does no work then. */
typedef struct {
  const Case *c;
  PetscBool any;
} AtOnce;

static void note_at_once(void *context, const Amplitude *table, TableUse use, const char *path)
{
  AtOnce *found = context;
  (void)path;
  if (table == &found->c->gravity_amplitude && case_starts_with_gravity(found->c)) return;
  found->any |= use == TABLE_FORCE && amplitude_value(table, table->origin, 0) != 0;
}

/* Is a load there at once, in statics? Without a table it grows, but for the weight of walls where bodies begin with
 * theirs. */
static PetscBool acts_at_once(const Model *m)
{
  AtOnce found = {.c = m->c};
  if (!case_is_static(&m->c->analysis)) return PETSC_FALSE;
  case_visit_tables(m->c, note_at_once, &found);
  for (PetscInt k = 0; k < m->c->n_walls; ++k)
    found.any |= m->c->walls[k].has_mass && !m->c->walls[k].absent && case_starts_with_gravity(m->c);
  return found.any;
}

/* What came in should be out again when nothing acts. */
static PetscBool keeps(const Model *m) { return (PetscBool)(share_of_input(m, m->kept_energy) > KEPT_ALLOWED); }

/* Of elastic statics whose functions are made anew where material is. */
static const char hint_of_cycles[] =
  "functions that are made anew in every step do not give back all that they took, and bodies that loads come to and "
  "go from keep more each time: shorter steps lessen it, method fem gives all back (docs/guide/limits.md)";

static PetscBool is_moved_anew(const Model *m)
{
  const PetscBool anew = (PetscBool)(m->method->restores_grid || m->method->clouds);
  return (PetscBool)(anew && case_is_static(&m->c->analysis) && !materials_yield(m->c->n_materials, m->materials));
}

/* Of what was at rest and nothing acts on: no share of that tells. */
static void warn_of_made(const Model *m, PetscReal taken, Diag *diag)
{
  if (m->most_energy > 0 || !(-taken > energy_unresolved(m))) return;
  diag_warning(diag, NULL,
               "the transfer between points and grid gave %.4g J, and no energy had come in: the run made it",
               (double)-taken);
  diag_hint(diag, "measure {energy: transfer} shows when (docs/theory.md, Energy)");
}

static void hint_of_statics_at_once(const Model *m, Diag *diag)
{
  diag_hint(diag,
            "a load that is there at once works twice what the body stores in statics, and the half of it stands "
            "here; what was found is right. Without an amplitude it grows over the steps%s",
            m->contact ? ". What contact that opens, closes or slides has in it, shorter steps lessen" : "");
}

/* Of the transfer that stands for points and nodes of implicit dynamics; PETSC_FALSE: none. */
static PetscBool hint_of_scheme(const Model *m, PetscReal share, Diag *diag)
{
  const PetscBool implicit = (PetscBool)(m->method->restores_grid && m->c->analysis.type == ANALYSIS_DYNAMIC);
  if (!implicit || m->space->transfer != transfers[0]) return PETSC_FALSE;
  if (!materials_yield(m->c->n_materials, m->materials))
    diag_hint(
      diag,
      m->formulation->pressure
        ? "elastic bodies keep it with `analysis: {transfer: consistent}` (docs/theory.md, Energy)"
        : "elastic bodies keep it with `analysis: {transfer: consistent, scheme: midpoint}` (docs/theory.md, Energy)");
  else if (share < 0)
    diag_hint(diag,
              "steps much shorter than a wave takes through a cell make it: longer ones, or `analysis: {transfer: "
              "consistent}` (docs/guide/limits.md)");
  return (PetscBool)(share < 0 || !materials_yield(m->c->n_materials, m->materials));
}

/* PETSC_FALSE: none. */
static PetscBool hint_of_contact(const Model *m, Diag *diag)
{
  const PetscBool sprung = (PetscBool)(m->c->analysis.type == ANALYSIS_EXPLICIT);
  if (!m->contact || (!sprung && m->method->restores_grid)) return PETSC_FALSE;
  diag_hint(diag, "%s",
            sprung
              ? "springs of what touches store a part of it, and their dashpots take what swings until it rests; "
                "smaller cells lessen it; measure {energy: transfer} shows when (docs/theory.md, section 34)"
              : "steps in which contact opens, closes or begins to slide count its work by the mean of their ends: "
                "shorter ones lessen it; measure {energy: transfer} shows when (docs/theory.md, Energy)");
  return PETSC_TRUE;
}

static void hint_of_grid(const Model *m, Diag *diag)
{
  const PetscBool meet = (PetscBool)(m->contact || m->c->n_bodies > 1);
  if (loses_at_lines(m))
    diag_hint(diag,
              "points that cross lines of the grid lose it, more of them with smaller cells and steps: `basis: "
              "{gimp: {}}` (docs/guide/choose.md)");
  else if (!is_moved_anew(m) || meet)
    diag_hint(diag,
              "smaller cells%s and smaller steps lessen it; measure {energy: transfer} shows when (docs/theory.md, "
              "Energy)",
              meet ? " where bodies meet" : "");
  else if (!keeps(m)) diag_hint(diag, "%s", hint_of_cycles); /* which that says */
}

static void warn_of_transfer(const Model *m, Diag *diag)
{
  const PetscReal taken = taken_by_transfer(m), share = share_of_input(m, taken);
  if (!m->method->restores_grid && m->c->staged && case_is_static(&m->c->analysis)) return; /* of what went away */
  warn_of_made(m, taken, diag);
  if (PetscAbsReal(share) <= TRANSFER_ALLOWED) return;
  diag_warning(
    diag, NULL,
    "%s %s %.2g %% of the energy that came in (%.4g of %.4g J): an energy balance near 0 does "
    "not show it",
    m->method->restores_grid ? "the transfer between points and grid" : "the transfer to what stops or holds it",
    share > 0 ? "took" : "gave", (double)(100 * PetscAbsReal(share)), (double)PetscAbsReal(taken),
    (double)m->most_energy);
  if (m->method->clouds && share < 0) hint_of_clouds(m, diag);
  else if (!m->method->restores_grid && acts_at_once(m) && share > 0) hint_of_statics_at_once(m, diag);
  else if (!hint_of_scheme(m, share, diag) && !hint_of_contact(m, diag)) hint_of_grid(m, diag);
}

/* Elastic bodies give all back; those that have snapped through to another shape do not, and are few. */
static void warn_of_kept(const Model *m, Diag *diag)
{
  if (!keeps(m)) return;
  diag_warning(diag, NULL,
               "elastic bodies kept %.2g %% of the energy that came in (%.4g of %.4g J) when nothing acted on them any "
               "more",
               (double)(100 * share_of_input(m, m->kept_energy)), (double)m->kept_energy, (double)m->most_energy);
  if (is_moved_anew(m)) diag_hint(diag, "%s", hint_of_cycles);
  else diag_hint(diag, "bodies that have snapped through to another shape do; others do not");
}

/* Where steps leave open more than came in the transfer means nothing, and motion alone tells what was made. */
static PetscErrorCode WarnOfRunaway(Model *m, Diag *diag)
{
  Energies e;

  PetscFunctionBeginUser;
  PetscCall(ModelEnergies(m, &e));
  if (case_is_static(&m->c->analysis) || !(m->most_energy > m->least_energy)) PetscFunctionReturn(0);
  if (!(e.kinetic > MOTION_ALLOWED * m->most_energy)) PetscFunctionReturn(0);
  if (share_of_input(m, taken_by_transfer(m)) < -TRANSFER_ALLOWED) PetscFunctionReturn(0); /* which says it */
  diag_warning(diag, NULL, "what moves has %.2g times all the energy that came in (%.4g of %.4g J): the run made it",
               (double)(e.kinetic / m->most_energy), (double)e.kinetic, (double)m->most_energy);
  if (m->method->clouds) hint_of_clouds(m, diag);
  else diag_hint(diag, "measure {energy: kinetic} shows when; shorter steps, or smaller cells there");
  PetscFunctionReturn(0);
}

/* Stress that acts at the end of a step and not at its start, or the other way round, has half its
 * work over the whole step: on what comes apart within a step, more than had been stored. */
static PetscErrorCode WarnOfGain(Model *m, Diag *diag)
{
  Energies e;

  PetscFunctionBeginUser;
  PetscCall(ModelEnergies(m, &e));
  const PetscReal share = share_of_input(m, -e.dissipated);
  if (case_is_static(&m->c->analysis) || !(share > TRANSFER_ALLOWED)) PetscFunctionReturn(0);
  diag_warning(diag, NULL, "stresses gave %.4g J more than had been put into them, %.2g %% of the %.4g J that came in",
               (double)-e.dissipated, (double)(100 * share), (double)m->most_energy);
  diag_hint(
    diag, "%s",
    m->c->analysis.type == ANALYSIS_EXPLICIT
      ? "shorter substeps (`analysis: {courant: 0.4}`), or `basis: gimp` where points hang on a corner of a cell"
      : "steps must see an impact: no longer than a wave takes through a cell, size / sqrt((lambda + 2 mu) / "
        "density), or with `analysis: {bossak: -0.3}` (docs/theory.md, Energy)");
  PetscFunctionReturn(0);
}

/* Volume of this rank's points, and what of it is more than their cells hold, m3. */
static PetscErrorCode AddCrowd(const Model *m, PetscReal sum[2])
{
  const Grid *grid = m->grid;
  PetscReal x[CELL_MAX_NODES * 3], *filled;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(grid->n_cells, &filled));
  for (PetscInt p = 0; p < m->points->n; ++p) /* what has just left the grid is in none */
    if (m->points->cell[p] >= 0)
      filled[m->points->cell[p]] += m->points->real[POINT_J][p] * m->points->real[POINT_VOLUME][p];
  for (PetscInt cell = 0; cell < grid->n_cells; ++cell) {
    if (filled[cell] <= 0) continue;
    grid_cell_x(grid, cell, x);
    sum[0] += filled[cell];
    sum[1] += PetscMax(0, filled[cell] - cell_volume_in(m->c->kinematics, grid_cell_type(grid, cell), x));
  }
  PetscCall(PetscFree(filled));
  PetscFunctionReturn(0);
}

/* Points have no size of their own: where flow brings them together the material fills less room than its
 * laws believe, and nothing else tells. */
static PetscErrorCode WarnOfCrowd(const Model *m, Diag *diag)
{
  PetscReal local[2] = {0, 0}, sum[2];

  PetscFunctionBeginUser;
  if (!m->method->restores_grid) PetscFunctionReturn(0);
  PetscCall(AddCrowd(m, local));
  PetscCall(MPIU_Allreduce(local, sum, 2, MPIU_REAL, MPI_SUM, m->comm));
  if (!(sum[1] > CROWD_ALLOWED * sum[0])) PetscFunctionReturn(0);
  diag_warning(diag, NULL, "points have come together: %.2g %% of the material's volume is more than its cells hold",
               (double)(100 * sum[1] / sum[0]));
  diag_hint(diag,
            "heights and densities are no longer those of the material; finer cells, or more points a cell, lessen it; "
            "grains with `opening_memory`: `stabilisation: {room: true}`");
  PetscFunctionReturn(0);
}

/* Does stress stand where loads on a surface are borne? Not where these are points, and see what points of no extent
 * do, nor in the mixed formulation, whose nodes at corners follow nobody. */
static PetscBool bears_where_loaded(const Model *m)
{
  return (PetscBool)(loads_have_pieces(m->loads) && !case_is_mixed(m->c));
}

/* One that is loaded now. */
static PetscBool is_surface(const LoadSpec *load) { return (PetscBool)(load->kind != LOAD_POINT && !load->waits); }

/* Of the carriers of surfaces: how far the farthest has come, in cells. */
static PetscReal way_of_carriers(const Model *m)
{
  const Points *carriers = m->loads->carriers;
  PetscReal most = 0;
  for (PetscInt p = 0; p < carriers->n; ++p)
    for (PetscInt d = 0; d < m->dim && is_surface(m->c->loads + carriers->body[p]); ++d)
      most = PetscMax(most, PetscAbsReal(point_real(carriers, POINT_U, p)[d]) / m->grid->smallest);
  return most;
}

PetscErrorCode LoadsMoved(const Model *m, PetscReal *moved)
{
  const PetscBool yields = materials_yield(m->c->n_materials, m->materials);
  PetscReal local, most;

  PetscFunctionBeginUser;
  *moved = 0;
  if (!m->method->restores_grid || bears_where_loaded(m)) PetscFunctionReturn(0);
  local = way_of_carriers(m);
  PetscCall(MPIU_Allreduce(&local, &most, 1, MPIU_REAL, MPIU_MAX, m->comm));
  if (most > (yields ? WAY_ALLOWED_YIELDING : WAY_ALLOWED)) *moved = most;
  PetscFunctionReturn(0);
}

static PetscErrorCode WarnOfMovedLoads(const Model *m, Diag *diag)
{
  PetscReal most;

  PetscFunctionBeginUser;
  PetscCall(LoadsMoved(m, &most));
  if (!most) PetscFunctionReturn(0);
  diag_warning(diag, "loads", "a loaded surface has moved by %.2g cells: with %s", (double)most,
               loads_have_pieces(m->loads)
                 ? "the mixed formulation stresses of points beside it may be wrong by a tenth of the load"
                 : "these shape functions corners and stresses beside it may be wrong by several per cent, with "
                   "linear ones by any amount");
  diag_hint(diag, "%s, or compare with fem (docs/theory.md, section 67)",
            case_is_mixed(m->c) ? "`formulation: displacement`" : "`basis: {gimp: {}}` on a box");
  PetscFunctionReturn(0);
}

static void warn_of_followers(const Model *m, Diag *diag)
{
  char path[256], at[80];
  for (PetscInt k = 0; k < m->c->n_measures; ++k) {
    const MeasureMemory *memory = &m->memory[k];
    if (memory->ended <= 0) continue;
    snprintf(path, sizeof path, "measures.%s.of.tracer", m->c->measures[k].name);
    diag_warning(diag, path,
                 "'%s' is empty (nan) from t = %g s on: no node of the grid carries its tracer, last at %s m",
                 m->c->measures[k].name, (double)memory->ended, text_position(m->dim, memory->where, at));
    diag_hint(diag, "a tracer ends where the material around it has gone, or a cell beyond the edge of the grid");
  }
  for (PetscInt k = 0; k < m->c->n_loads; ++k)
    if (m->load_memory[k].ended > 0)
      diag_warning(
        diag, "loads",
        "the material has left %.0f carriers of load %d behind, the last at t = %g s about %s m: their force is gone",
        (double)m->load_memory[k].carriers, (int)k, (double)m->load_memory[k].ended,
        text_position(m->dim, m->load_memory[k].where, at));
}

/* Of a law from a library. */
static PetscBool lacks_energy(const Model *m)
{
  for (PetscInt i = 0; i < m->c->n_materials; ++i)
    if (!m->materials[i].law->energy) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Is there anything of what it sums up, or takes the mean of? */
static PetscErrorCode SumsAnything(const Model *m, const MeasureSpec *measure, PetscBool *any)
{
  const PetscBool tensor = (PetscBool)(!strcmp(measure->kind, "stress") || !strcmp(measure->kind, "strain"));
  const PetscInt body = measure_body(m, measure);
  PetscInt n = 0;

  PetscFunctionBeginUser;
  *any = PETSC_FALSE;
  if (!measure_number(measure)->sum && !tensor) PetscFunctionReturn(0);
  for (PetscInt p = 0; p < m->points->n; ++p) n += measure_share(m, measure, body, p) > 0;
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &n, 1, MPIU_INT, MPI_SUM, m->comm));
  *any = (PetscBool)(n > 0);
  PetscFunctionReturn(0);
}

static const char *why_no_limit(const Model *m)
{
  if (m->raised.unfound) return "the search for it has found none";
  return m->c->analysis.type == ANALYSIS_LIMIT ? "the search for it was not over" : "no limit load was sought";
}

/* any: is there something of what it sums up? */
static const char *why_empty(const Model *m, const MeasureSpec *measure, PetscBool any)
{
  if (!strcmp(measure->kind, "limit_load")) return why_no_limit(m);
  if (measure_has_window(measure)) return "too few steps with a value reach into its window";
  if (measure_find(measure->kind)->events) return "none of what it counts is over";
  if (!strcmp(measure->kind, "formula")) return "its formula has no value there, or a measure in it has none";
  if (!strcmp(measure->kind, "initial")) return "no equilibrium was sought before the first step";
  if (!strncmp(measure->kind, "wall_", 5)) return "a wall without `mass` has no motion of its own";
  if (!strcmp(measure->kind, "energy") && lacks_energy(m)) return "the law of a material tells no energy";
  if (any) return "what it measures is there, and deformed beyond what numbers hold";
  return "no point is left of what it measures";
}

static void warn_of_infinite(const MeasureSpec *measure, PetscReal value, Diag *diag)
{
  char path[256];
  if (!PetscIsInfReal(value)) return;
  snprintf(path, sizeof path, "measures.%s", measure->name);
  diag_warning(diag, path, "'%s' is infinite at the end: its formula divides by nothing, or grows beyond all numbers",
               measure->name);
}

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

/* Plastic flow that took so many times what is stored is no settling, but something that has failed. */
#define FAILED 100

/* Does a law get stronger as it flows, so that it may flow on and on? */
static PetscBool grows_stronger(const Model *m)
{
  PetscReal yield, slope = 0;
  for (PetscInt i = 0; i < m->c->n_materials && slope <= 0; ++i)
    if (m->materials[i].law->hardens) m->materials[i].law->hardens(m->materials[i].parameters, &yield, &slope);
  return (PetscBool)(slope > 0);
}

/* Statics have an equilibrium behind a limit load where what fails stiffens by its change of shape, as a cut that leans
 * on its own foot: nothing else tells that it has failed. What is pushed by its boundary is meant to. */
static PetscErrorCode WarnOfFailed(Model *m, Diag *diag)
{
  Energies e;

  PetscFunctionBeginUser;
  if (m->c->analysis.type != ANALYSIS_STATIC || !PetscIsNanReal(m->raised.value) || grows_stronger(m))
    PetscFunctionReturn(0);
  PetscCall(ModelEnergies(m, &e));
  const PetscBool pushed = (PetscBool)(PetscAbsReal(e.boundary) > 0.01 * PetscAbsReal(e.external));
  if (pushed || e.elastic <= 0 || e.dissipated <= FAILED * e.elastic) PetscFunctionReturn(0);
  diag_warning(
    diag, NULL,
    "plastic flow took %.0f times what is stored: something has failed on the way, and stands only by how far "
    "it went",
    (double)(e.dissipated / e.elastic));
  diag_hint(diag,
            "the load at which it fails is found by `analysis: {type: limit-load}`, and how far a slope is from it "
            "by `factor-of-safety`; a fall has inertia (`type: dynamic`)");
  PetscFunctionReturn(0);
}

static PetscErrorCode WarnOfPassed(const Model *m, Diag *diag)
{
  PetscReal most;

  PetscFunctionBeginUser;
  PetscCall(MPIU_Allreduce(&m->passed, &most, 1, MPIU_REAL, MPIU_MAX, m->comm));
  if (most <= TABLE_PASSED) PetscFunctionReturn(0);
  diag_warning(diag, "analysis.step",
               "a step has taken a point through up to %.2g of a piece of its table of strength (peak_strain, "
               "residual_strain): it has the strength of the end of the step, and never had that between",
               (double)most);
  diag_hint(diag, "the error goes with the step: a tenth of a piece costs 0.3 %% where a whole one costs 3 %%");
  PetscFunctionReturn(0);
}

PetscErrorCode LossesWarn(Model *m, const PetscReal *values, Diag *diag)
{
  char path[256];
  PetscBool any;
  const Outside *o = &m->outside;

  PetscFunctionBeginUser;
  warn_of_followers(m, diag);
  for (PetscInt k = 0; k < m->c->n_measures; ++k) {
    warn_of_infinite(m->c->measures + k, values[k], diag);
    if (!PetscIsNanReal(values[k]) || m->memory[k].ended > 0) continue;
    if (!strcmp(m->c->measures[k].kind, "factor_of_safety")) continue; /* the log says why it has none */
    snprintf(path, sizeof path, "measures.%s", m->c->measures[k].name);
    PetscCall(SumsAnything(m, m->c->measures + k, &any));
    diag_warning(diag, path, "'%s' is empty (nan) at the end: %s", m->c->measures[k].name,
                 why_empty(m, m->c->measures + k, any));
  }
  if (o->removed > 0)
    diag_warning(diag, "grid.outside", "%.0f points of %.4g kg left the grid and were removed", (double)o->removed,
                 (double)o->mass);
  if (o->held > 0)
    diag_warning(diag, "grid.outside",
                 "points that left the grid were kept on its boundary %.0f times, at most %.0f of %.4g kg in a step",
                 (double)o->held, (double)o->held_most, (double)o->held_most_mass);
  warn_of_transfer(m, diag);
  warn_of_kept(m, diag);
  PetscCall(WarnOfRunaway(m, diag));
  PetscCall(WarnOfGain(m, diag));
  PetscCall(WarnOfCrowd(m, diag));
  PetscCall(WarnOfMovedLoads(m, diag));
  PetscCall(WarnOfShear(m, diag));
  PetscCall(WarnOfStretch(m, diag));
  warn_of_entered(m, diag);
  PetscCall(WarnOfPull(m, diag));
  PetscCall(WarnOfPassed(m, diag));
  PetscCall(WarnOfFailed(m, diag));
  PetscCall(AdviseHangs(m, diag));
  astride_tell(m, diag);
  warn_of_sunk(m, PETSC_FALSE, diag);
  warn_of_no_limit(m, diag);
  warn_of_no_factor(m, diag);
  warn_of_unstable(m, diag);
  warn_of_walls_through(m, diag);
  PetscFunctionReturn(0);
}
