/* Strength divided by a factor (docs/theory.md, "Factor of safety"): which materials, walls and interfaces take part,
 * and a step to the equilibrium with another factor. */
#include "model/model_private.h"

/* Is the strength of material i divided? */
static PetscBool material_is_reduced(const Model *m, PetscInt i)
{
  return (PetscBool)(m->materials[i].law->reduce && case_reduces_material(m->c, i));
}

/* Is the friction of body b on a wall, or in an interface, divided? Of a joint, too, of which one side keeps its own
 * strength: a pile's, or a wall's, in soil that may fail. */
static PetscBool contact_is_reduced(const Model *m, PetscInt partner, PetscInt b)
{
  const Case *c = m->c;
  if (partner < c->n_walls) return case_reduces(c, &c->bodies[b]);
  const InterfaceSpec *s = &c->interfaces[partner - c->n_walls];
  return (PetscBool)(case_reduces(c, &c->bodies[case_body(c, s->between[0])]) ||
                     case_reduces(c, &c->bodies[case_body(c, s->between[1])]));
}

void strength_of_contact(Model *m)
{
  const PetscInt n = m->c->n_bodies;
  for (PetscInt i = 0; m->contact && i < m->contact->n_partners * n; ++i)
    m->contact->divisor[i] = contact_is_reduced(m, i / n, i % n) ? m->strength.factor : 1;
}

void strength_set(Model *m, PetscReal factor)
{
  m->strength.factor = factor;
  strength_of_contact(m);
  for (PetscInt i = 0; i < m->c->n_materials; ++i)
    if (material_is_reduced(m, i)) material_reduce(&m->materials[i], factor);
}

/* Does body b rub where that is divided? Of what cannot fail itself, as a block on a ramp, that is all there is. */
static PetscBool rubs(const Model *m, PetscInt b)
{
  const Case *c = m->c;
  PetscBool any = PETSC_FALSE;
  for (PetscInt k = 0; k < c->n_walls; ++k)
    any |= c->walls[k].contact == CONTACT_FRICTION && contact_meets_body(c, k, b);
  for (PetscInt k = 0; k < c->n_interfaces; ++k)
    for (int side = 0; side < 2; ++side)
      any |= c->interfaces[k].contact == CONTACT_FRICTION && case_body(c, c->interfaces[k].between[side]) == b;
  return any;
}

/* A body that keeps its strength cannot share its material with one that does not. */
static void check_body(const Model *m, PetscInt b, Diag *diag)
{
  const Case *c = m->c;
  const BodySpec *body = &c->bodies[b];
  const PetscBool reduced = case_reduces(c, body);
  char path[256];
  for (PetscInt i = 0; i < c->n_materials; ++i) {
    if (strcmp(body->material, c->materials[i].name)) continue;
    const Law *law = m->materials[i].law;
    snprintf(path, sizeof path, "materials.%s.law", c->materials[i].name);
    if (reduced && !law->reduce && (law->yields || !rubs(m, b))) {
      diag_error(diag, path, "the law %s of '%s' has no strength that could be divided by a factor of safety",
                 law->name, body->name);
      diag_hint(diag, "name the bodies that may fail: %s: {bodies: [...]}",
                c->analysis.type == ANALYSIS_FACTOR ? "analysis.reduction" : "strength");
    }
    snprintf(path, sizeof path, "bodies[%d].material", (int)b);
    if (!reduced && material_is_reduced(m, i))
      diag_error(diag, path, "'%s' is to keep its strength, but its material '%s' is that of a body that is reduced",
                 body->name, body->material);
  }
}

static PetscBool any_moves(PetscInt n, const MotionSpec *motions)
{
  for (PetscInt k = 0; k < n; ++k)
    if (!motions[k].absent && motions[k].kind != MOTION_FIXED) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Is there anything that strength has to bear? What a stage or a run before has left counts, too. */
static PetscBool is_loaded(const Case *c)
{
  PetscBool loaded = case_acting_loads(c) > 0 || case_has_stress(c) || c->initial.run || c->stage > 0;
  for (PetscInt d = 0; d < 3; ++d)
    if (c->gravity[d] != 0) loaded = PETSC_TRUE;
  for (PetscInt k = 0; k < c->n_walls; ++k)
    if (c->walls[k].has_mass || any_moves(c->walls[k].n_motions, c->walls[k].motions)) loaded = PETSC_TRUE;
  return (PetscBool)(loaded || any_moves(c->n_boundary, c->boundary));
}

static void check_loaded(const Case *c, Diag *diag)
{
  if (is_loaded(c)) return;
  diag_error(diag, "analysis.type",
             "nothing is there that strength would have to bear: no gravity, no load, no prescribed motion, no initial "
             "stress");
  diag_hint(diag, "loads: {gravity: [0, -9.81%s]}", c->kinematics->dim == 2 ? "" : ", 0");
}

/* Measured (docs/theory.md): the first slope of cases/factor-of-safety stands with 1.5 and more. */
static void warn_of_locking(const Model *m, Diag *diag)
{
  const GridSpec *grid = &m->c->grid; /* a point in each square or cube asks for little */
  PetscBool single = (PetscBool)(grid->kind == GRID_BOX && cells[grid->cell].nodes > m->dim + 1);
  for (PetscInt b = 0; b < m->c->n_bodies; ++b) single &= m->c->bodies[b].points_per_cell == 1;
  if (m->formulation->pressure || m->formulation->cells || single) return;
  if (!materials_yield(m->c->n_materials, m->materials)) return;
  diag_warning(diag, "formulation",
               "with displacements as the only unknowns what yields without a change of volume locks: the factor of "
               "safety comes out too large, or nothing fails at all");
  diag_hint(diag, "%s",
            !m->method->takes_pressure ? "mpm and fem take `formulation: mixed`, which does not lock"
            : case_dilates(m->c)
              ? "with a dilatancy angle `formulation: mean-dilatation` locks less, `points_per_cell: 1` least"
              : "`formulation: mixed` does not lock, nor does `mean-dilatation` in quadrilaterals and hexahedra");
}

void strength_start(Model *m, Diag *diag)
{
  m->strength = (Strength){.factor = 1, .lower = NAN, .upper = NAN, .value = NAN};
  const StrengthSpec *given = &m->c->strength;
  const PetscBool seeks = m->c->analysis.type == ANALYSIS_FACTOR,
                  divides = given->factor > 0 || given->beyond_failure > 0;
  const PetscInt before = diag_errors(diag);
  if (!seeks && !divides) return;
  if (seeks) warn_of_locking(m, diag);
  if (seeks) check_loaded(m->c, diag);
  if (seeks && divides)
    diag_error(diag, "strength", "a search for the factor of safety divides the strength itself: it takes no other");
  for (PetscInt b = 0; b < m->c->n_bodies; ++b)
    if (!m->c->bodies[b].absent) check_body(m, b, diag);
  if (diag_errors(diag) > before) return;
  if (seeks) strength_set(m, 0);
  else if (given->factor > 0) strength_set(m, given->factor);
}

void strength_go_on(Model *m, const Model *before, Diag *diag)
{
  const PetscReal beyond = m->c->strength.beyond_failure;
  if (m->c->analysis.type != ANALYSIS_FACTOR) { /* what was found stays known */
    m->strength.lower = before->strength.lower;
    m->strength.upper = before->strength.upper;
    m->strength.value = before->strength.value;
  }
  if (beyond == 0) return;
  if (before->c->analysis.type != ANALYSIS_FACTOR) strength_set(m, before->strength.factor);
  else if (before->strength.upper > 0) strength_set(m, beyond * before->strength.upper);
  else
    diag_error(diag, "strength.beyond_failure",
               "the search before this stage has found no factor that fails: it stands with %g",
               (double)before->strength.lower);
}

static PetscReal increment_of(const Model *m, PetscInt node)
{
  PetscReal square = 0;
  for (PetscInt d = 0; d < m->dim; ++d) square += PetscSqr(m->nodes->du[node * m->dim + d]);
  return PetscSqrtReal(square);
}

PetscErrorCode LargestIncrement(const Model *m, PetscReal *largest)
{
  PetscReal local = 0;

  PetscFunctionBeginUser;
  for (PetscInt node = 0; node < m->grid->n_owned; ++node)
    if (m->system->row[node] >= 0) local = PetscMax(local, increment_of(m, node));
  PetscCall(MPIU_Allreduce(&local, largest, 1, MPIU_REAL, MPIU_MAX, m->comm));
  PetscFunctionReturn(0);
}

#define GOES_ALONG 0.5 /* of the largest increment: with so much a node is of what moves */
#define LEAST_CELLS 2  /* what is lower than so many cells is not resolved */

PetscErrorCode MovingHeight(const Model *m, PetscReal *height)
{
  PetscReal largest, local[2] = {-PETSC_MAX_REAL, -PETSC_MAX_REAL}, all[2]; /* highest, and minus the lowest */
  const PetscInt axis = case_height_axis(m->c);

  PetscFunctionBeginUser;
  PetscCall(LargestIncrement(m, &largest));
  for (PetscInt node = 0; node < m->grid->n_owned; ++node) {
    const PetscReal x = m->grid->x[node * m->dim + axis];
    if (m->system->row[node] < 0 || increment_of(m, node) < GOES_ALONG * largest) continue;
    local[0] = PetscMax(local[0], x);
    local[1] = PetscMax(local[1], -x);
  }
  PetscCall(MPIU_Allreduce(local, all, 2, MPIU_REAL, MPIU_MAX, m->comm));
  *height = PetscMax(all[0] + all[1], LEAST_CELLS * m->grid->smallest);
  PetscFunctionReturn(0);
}

/* What has moved may find another balance whatever the factor is (points of soft soil do, on a grid that is restored;
 * what locks, too). Of two tries from the same state that part of the way is known which does not grow with the
 * factor: it is no slide. */
static PetscReal rests_anew(const Strength *s, PetscReal by, PetscReal moved)
{
  if (!(s->slid_by > by)) return 0;
  return PetscMax(0, (moved * s->slid_by - s->slid * by) / (s->slid_by - by));
}

PetscBool strength_slides(Strength *s, PetscReal moved, StepReport *report)
{
  s->anew = rests_anew(s, s->by, moved);
  if (moved - s->anew <= s->reach) return PETSC_FALSE;
  snprintf(report->leap, sizeof report->leap, "it slides: %.3g m, for %.3g m that what stands moves at most",
           (double)moved, (double)s->reach);
  report->newton.converged = PETSC_FALSE;
  report->newton.reason = report->leap;
  return PETSC_TRUE;
}

PetscErrorCode StrengthJudge(Model *m, StepReport *report)
{
  Strength *s = &m->strength;
  PetscReal moved;

  PetscFunctionBeginUser;
  if (!s->trying) PetscFunctionReturn(0);
  PetscCall(LargestIncrement(m, &moved));
  if (!strength_slides(s, moved, report)) PetscFunctionReturn(0);
  s->slid_by = s->by;
  s->slid = moved;
  PetscFunctionReturn(0);
}

PetscErrorCode ModelTryFactor(Model *m, PetscReal factor, StepReport *report, PetscReal *moved)
{
  const PetscReal stable = m->strength.factor;
  const StepControl control = m->control;
  const PetscInt cuts = m->cuts;

  PetscFunctionBeginUser;
  strength_set(m, factor);
  m->strength.trying = PETSC_TRUE;
  m->strength.by = factor - stable;
  m->control.next = factor - stable;
  PetscCall(ModelStep(m, factor - stable, report));
  m->strength.trying = PETSC_FALSE;
  m->control = control;
  m->cuts = cuts;
  PetscCall(LargestIncrement(m, moved));
  if (report->outcome != STEP_ACCEPTED) strength_set(m, stable);
  else m->strength.slid_by = m->strength.slid = 0;
  PetscFunctionReturn(0);
}
