/* All that changes by a table over time, and where these tables turn. */
#include <string.h>
#include "base/formula.h"
#include "case/case.h"

#define ROUNDING 1e-9 /* of a time: times are sums */
#define PASSED 0.05   /* of the largest value: by so much a table goes beyond what it is at both ends of a step */

static void visit_motion(const Case *c, const MotionSpec *m, const char *path, TableVisit visit, void *context)
{
  const TableUse use = m->kind == MOTION_DISPLACEMENT ? TABLE_PLACE : TABLE_SPEED;
  if (m->absent || m->kind == MOTION_FIXED || !m->amplitude.n || case_raises(c, &m->amplitude)) return;
  visit(context, &m->amplitude, use, path);
}

static void visit_wall(const Case *c, PetscInt k, TableVisit visit, void *context)
{
  const WallSpec *wall = c->walls + k;
  char path[96];
  for (PetscInt i = 0; i < wall->n_motions && !wall->absent; ++i) {
    snprintf(path, sizeof path, "walls[%d].motion[%d].amplitude", (int)k, (int)i);
    visit_motion(c, wall->motions + i, path, visit, context);
  }
  if (!wall->has_mass || wall->absent || !wall->mass.amplitude.n) return;
  snprintf(path, sizeof path, "walls[%d].mass.amplitude", (int)k);
  visit(context, &wall->mass.amplitude, TABLE_FORCE, path);
}

/* Is any body there made of it? */
static PetscBool is_used(const Case *c, const MaterialSpec *m)
{
  for (PetscInt b = 0; b < c->n_bodies; ++b)
    if (!c->bodies[b].absent && !strcmp(c->bodies[b].material, m->name)) return PETSC_TRUE;
  return PETSC_FALSE;
}

static void visit_material(const Case *c, const MaterialSpec *m, TableVisit visit, void *context)
{
  char path[256];
  for (PetscInt k = 0; k < m->n_amplitudes && is_used(c, m); ++k) {
    snprintf(path, sizeof path, "materials.%s.amplitude.%s", m->name, m->amplitudes[k].name);
    if (m->amplitudes[k].amplitude.n) visit(context, &m->amplitudes[k].amplitude, TABLE_PARAMETER, path);
  }
}

void case_visit_tables(const Case *c, TableVisit visit, void *context)
{
  const PetscReal *g = c->gravity;
  char path[96], load[64];
  if (c->gravity_amplitude.n && (g[0] != 0 || g[1] != 0 || g[2] != 0) && !case_raises(c, &c->gravity_amplitude))
    visit(context, &c->gravity_amplitude, TABLE_FORCE, "loads.gravity_amplitude");
  for (PetscInt k = 0; k < c->n_loads; ++k) {
    snprintf(path, sizeof path, "%s.amplitude", case_load_path(c, k, load));
    if (c->loads[k].amplitude.n && !case_raises(c, &c->loads[k].amplitude))
      visit(context, &c->loads[k].amplitude, TABLE_FORCE, path);
  }
  for (PetscInt k = 0; k < c->n_boundary; ++k) {
    snprintf(path, sizeof path, "boundary[%d].amplitude", (int)k);
    visit_motion(c, c->boundary + k, path, visit, context);
  }
  for (PetscInt k = 0; k < c->n_walls; ++k) visit_wall(c, k, visit, context);
  for (PetscInt i = 0; i < c->n_materials; ++i) visit_material(c, c->materials + i, visit, context);
}

/* Does the formula name t? Names begin with a letter, and go on with digits, too. */
static PetscBool names_t(const char *formula)
{
  for (const char *at = formula; *at;) {
    const size_t length = strspn(at, FORMULA_LETTERS);
    if (length == 1 && *at == 't') return PETSC_TRUE;
    at += PetscMax(length, 1);
  }
  return PETSC_FALSE;
}

PetscBool case_has_timed_factor(const Case *c)
{
  for (PetscInt k = 0; k < case_acting_loads(c); ++k)
    if (c->loads[k].factor && names_t(c->loads[k].factor)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* The first point of the table later than t, but for rounding; a->n: there is none. */
static PetscInt first_behind(const Amplitude *a, PetscReal t)
{
  return amplitude_behind(a, t + ROUNDING * PetscAbsReal(t));
}

/* Of the piece that ends at point i; before the first and behind the last nothing changes. */
static PetscReal slope(const Amplitude *a, PetscInt i)
{
  return i > 0 && i < a->n ? (a->value[i] - a->value[i - 1]) / (a->time[i] - a->time[i - 1]) : 0;
}

static PetscBool is_corner(const Amplitude *a, PetscInt i)
{
  const PetscReal before = slope(a, i), after = slope(a, i + 1);
  return (PetscBool)(PetscAbsReal(after - before) > ROUNDING * (PetscAbsReal(before) + PetscAbsReal(after)));
}

/* What is asked of all tables: a time, and what is found. */
typedef struct {
  PetscReal t, until, corner;
  PetscBool begins;
  const AnalysisSpec *analysis;
} Sought;

static void seek_corner(void *context, const Amplitude *a, TableUse use, const char *path)
{
  Sought *s = context;
  PetscInt i = first_behind(a, s->t);
  (void)use, (void)path;
  while (i < a->n && !is_corner(a, i)) ++i;
  if (i < a->n) s->corner = PetscMin(s->corner, a->origin + a->time[i]);
}

PetscReal case_corner_after(const Case *c, PetscReal t)
{
  Sought s = {.t = t, .corner = PETSC_MAX_REAL};
  case_visit_tables(c, seek_corner, &s);
  return s.corner;
}

PetscBool case_counts_at_ends(const AnalysisSpec *a, TableUse use)
{
  return (PetscBool)(use == TABLE_PLACE || use == TABLE_PARAMETER || (use == TABLE_FORCE && case_is_static(a)));
}

static void seek_peak(void *context, const Amplitude *a, TableUse use, const char *path)
{
  Sought *s = context;
  const PetscReal allowed = PASSED * amplitude_size(a), first = amplitude_value(a, s->t, 1);
  (void)path;
  if (!case_counts_at_ends(s->analysis, use)) return;
  for (PetscInt i = first_behind(a, s->t); i < a->n && a->origin + a->time[i] < s->until; ++i) {
    const PetscReal last = amplitude_value(a, s->until, 1), v = a->value[i];
    if (v > PetscMax(first, last) + allowed || v < PetscMin(first, last) - allowed) s->until = a->origin + a->time[i];
  }
}

PetscReal case_peak_within(const Case *c, PetscReal t, PetscReal until)
{
  Sought s = {.t = t, .until = until, .analysis = &c->analysis};
  do { /* what ends at one peak may go over another, which lay within the ends before */
    until = s.until;
    case_visit_tables(c, seek_peak, &s);
  } while (s.until < until);
  return s.until;
}

/* It stood still up to a point that is not before t, and changes from there on. */
static void seek_begin(void *context, const Amplitude *a, TableUse use, const char *path)
{
  Sought *s = context;
  (void)use, (void)path;
  const PetscInt first = first_behind(a, s->t), last = first_behind(a, s->until);
  for (PetscInt i = PetscMax(0, first - 1); i < last; ++i) {
    const PetscBool before = (PetscBool)(a->origin + a->time[i] < s->t - ROUNDING * PetscAbsReal(s->t));
    if (!before && slope(a, i) == 0 && slope(a, i + 1) != 0) s->begins = PETSC_TRUE;
  }
}

PetscBool case_begins_within(const Case *c, PetscReal t, PetscReal until)
{
  Sought s = {.t = t, .until = until};
  case_visit_tables(c, seek_begin, &s);
  return s.begins;
}
