/* Stages of a case, and the time at which each begins. */
#include <string.h>
#include "case/case.h"

PetscInt case_stages(const Case *c) { return PetscMax(1, c->n_stages); }

const Case *case_stage(const Case *c, PetscInt k) { return c->n_stages ? c->stage_case[k] : c; }

PetscBool case_goes_on(const Case *c) { return c->stage > 0 || c->initial.run ? PETSC_TRUE : PETSC_FALSE; }

static void shift_motion(MotionSpec *m, const PetscReal *start) { m->amplitude.origin = start[m->amplitude.since]; }

static void shift_wall(WallSpec *w, const PetscReal *start)
{
  for (PetscInt k = 0; k < w->n_motions; ++k) shift_motion(&w->motions[k], start);
  w->mass.amplitude.origin = start[w->mass.amplitude.since];
  if (w->from > 0) w->from += start[w->since];
  w->until += start[w->since];
}

static void shift_material(MaterialSpec *m, const PetscReal *start)
{
  for (PetscInt k = 0; k < m->n_amplitudes; ++k)
    m->amplitudes[k].amplitude.origin = start[m->amplitudes[k].amplitude.since];
}

static void shift_window(MeasureSpec *m, const PetscReal *start)
{
  if (m->window[0] == m->window[1]) return; /* of the last so many seconds, wherever these are */
  for (int k = 0; k < 2; ++k) m->window[k] += start[m->since];
}

void case_begin(Case *c, const PetscReal *start)
{
  c->start = start[c->stage];
  c->analysis.end += c->start;
  for (PetscInt k = 0; k < c->analysis.n_until; ++k) c->analysis.until[k].after += c->start;
  for (PetscInt k = 0; k < c->n_boundary; ++k) shift_motion(&c->boundary[k], start);
  for (PetscInt k = 0; k < c->n_walls; ++k) shift_wall(&c->walls[k], start);
  for (PetscInt k = 0; k < c->n_materials; ++k) shift_material(&c->materials[k], start);
  for (PetscInt k = 0; k < c->n_loads; ++k) c->loads[k].amplitude.origin = start[c->loads[k].amplitude.since];
  for (PetscInt k = 0; k < c->n_measures; ++k) shift_window(&c->measures[k], start);
  c->gravity_amplitude.origin = start[c->gravity_amplitude.since];
}

/* The body of that name, if it is there. */
static const BodySpec *body_there(const Case *c, const char *name)
{
  for (const BodySpec *b = c->bodies; b < c->bodies + c->n_bodies; ++b)
    if (!strcmp(b->name, name)) return b->absent ? NULL : b;
  return NULL;
}

/* Is it there, and not any more in a later stage? */
static PetscBool leaves(const Case *c, PetscInt stage, const BodySpec *body)
{
  for (PetscInt k = stage + 1; k < c->n_stages && !body->absent; ++k)
    if (!body_there(c->stage_case[k], body->name)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Has it no velocity, or none of the stage before? */
static PetscBool begins(const Case *c, PetscInt stage, const BodySpec *body)
{
  if (!stage || body->absent) return PETSC_FALSE;
  const Case *before = c->stage_case[stage - 1];
  const StageSpec *spec = c->stage_case[stage]->spec;
  if (case_is_static(&before->analysis) || (spec && spec->reset.velocity)) return PETSC_TRUE;
  return (PetscBool)!body_there(before, body->name);
}

static PetscBool waits(const Case *c, PetscInt stage, const WallSpec *w)
{
  for (PetscInt k = stage + 1; k < c->n_stages; ++k) {
    const Case *now = c->stage_case[k];
    for (const BodySpec *b = now->bodies; b < now->bodies + now->n_bodies; ++b)
      if (!b->absent && case_wall_meets(w, b->name) && !body_there(c->stage_case[k - 1], b->name)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

void case_tell_changes(Case *c)
{
  for (PetscInt k = 0; k < c->n_stages; ++k) {
    Case *now = c->stage_case[k];
    for (BodySpec *b = now->bodies; b < now->bodies + now->n_bodies; ++b) {
      b->leaves = leaves(c, k, b);
      b->begins = begins(c, k, b);
    }
    for (WallSpec *w = now->walls; w < now->walls + now->n_walls; ++w) w->waits = waits(c, k, w);
  }
}
