/* A load that is raised until nothing more holds (docs/theory.md, "Limit loads"): a prescribed displacement
 * in steps of its own, or forces, whose factor follows from the work that they do. */
#include "model/model_private.h"

static PetscBool is_forces(const Case *c)
{
  return c->analysis.limit.kind == RAISE_GRAVITY || c->analysis.limit.kind == RAISE_LOAD;
}

/* Does the load turn with the surface that it acts on? */
static PetscBool follows(const Case *c)
{
  const LimitSpec *limit = &c->analysis.limit;
  return limit->kind == RAISE_LOAD && c->loads[limit->index].kind == LOAD_PRESSURE;
}

/* The amplitude of what is raised, and where it stands in the case. */
static const Amplitude *raised_amplitude(const Case *c, char path[96])
{
  const LimitSpec *limit = &c->analysis.limit;
  char load[64];
  switch (limit->kind) {
  case RAISE_GRAVITY: snprintf(path, 96, "loads.gravity_amplitude"); return &c->gravity_amplitude;
  case RAISE_LOAD: snprintf(path, 96, "%s.amplitude", case_load_path(c, limit->index, load)); break;
  case RAISE_BOUNDARY: snprintf(path, 96, "boundary[%d].amplitude", (int)limit->index); break;
  case RAISE_WALL: snprintf(path, 96, "walls[%d].motion[0].amplitude", (int)limit->index); break;
  case RAISE_NOTHING: return NULL;
  }
  return limit->kind == RAISE_LOAD ? &c->loads[limit->index].amplitude : &case_raised_motion(c)->amplitude;
}

/* What is raised has a factor of its own. An amplitude that an earlier stage goes by, or that is 1, misleads nobody. */
static void warn_of_amplitude(const Case *c, Diag *diag)
{
  char path[96] = "";
  const Amplitude *a = raised_amplitude(c, path);
  PetscBool other = PETSC_FALSE;
  for (PetscInt i = 0; a && i < a->n; ++i) other |= a->value[i] != 1;
  if (!other || a->since < c->stage) return;
  diag_warning(diag, path, "'%s' is raised from zero to its limit, whatever this says: it has no effect",
               c->analysis.limit.raise);
  diag_hint(diag,
            "the limit is told as a factor of the load, or as the force along the displacement, as given without "
            "an amplitude: leave it out");
}

void raised_start(Model *m, Diag *diag)
{
  const Case *c = m->c;
  const LimitSpec *limit = &c->analysis.limit;
  m->raised = (Raised){.value = NAN};
  if (c->analysis.type != ANALYSIS_LIMIT) return;
  warn_of_amplitude(c, diag);
  if (m->method->clouds)
    diag_error(diag, "analysis.type", "method %s does not raise a load to its limit: mpm and fem do", m->method->name);
  if (limit->kind == RAISE_GRAVITY && case_has_stress(c))
    diag_error(diag, "analysis.limit.raise",
               "gravity is raised from zero, but bodies start with the stress of a weight");
}

void raised_go_on(Model *m, const Model *before)
{
  if (m->c->analysis.type == ANALYSIS_LIMIT) return;
  m->raised.value = before->raised.value;
  m->raised.unfound = before->raised.unfound;
}

#define HARDENING_STRAIN 0.05 /* a mechanism may strain by so much */

/* Slope of the strength of a material that hardens by more than the tolerance until then, Pa. */
static PetscReal hardening_of(const Model *m, PetscInt material)
{
  const Material *of = &m->materials[material];
  PetscReal yield = 0, slope = 0;
  if (of->law->hardens) of->law->hardens(of->parameters, &yield, &slope);
  return slope * HARDENING_STRAIN > m->c->analysis.limit.tolerance * yield ? slope : 0;
}

PetscBool raised_hardens(const Model *m)
{
  PetscBool any = PETSC_FALSE;
  for (PetscInt i = 0; m->c->analysis.type == ANALYSIS_LIMIT && i < m->c->n_materials; ++i)
    any |= hardening_of(m, i) > 0;
  return any;
}

PetscErrorCode RaisedHardening(const Model *m, PetscReal *work)
{
  const Points *points = m->points;
  PetscReal local = 0;

  PetscFunctionBeginUser;
  *work = 0;
  if (!raised_hardens(m)) PetscFunctionReturn(0);
  for (PetscInt p = 0; p < points->n; ++p)
    local +=
      points->real[POINT_VOLUME][p] * hardening_of(m, points->material[p]) * PetscSqr(points->real[POINT_FLOW][p]);
  PetscCall(MPIU_Allreduce(&local, work, 1, MPIU_REAL, MPIU_SUM, m->comm));
  PetscFunctionReturn(0);
}

/* Quadrilaterals that ask what yields in their middle alone. */
static PetscBool is_reduced(const Model *m)
{
  PetscBool reduced = m->grid->type == CELL_QUADRILATERAL && !grid_is_mixed(m->grid);
  for (PetscInt i = 0; i < m->c->n_bodies; ++i) reduced &= m->c->bodies[i].points_per_cell == 1;
  return reduced;
}

void raised_advise(const Model *m, Diag *diag)
{
  const GridSpec *grid = &m->c->grid;
  if (m->c->analysis.type != ANALYSIS_LIMIT || m->formulation->pressure || m->formulation->cells) return;
  if (!materials_yield(m->c->n_materials, m->materials)) return;
  const PetscBool crossed = grid->kind == GRID_BOX && grid->cell == CELL_TRIANGLE && grid->diagonal == DIAGONAL_CROSSED;
  if (crossed || is_reduced(m)) return; /* these do not lock */
  diag_warning(diag, "formulation",
               "with displacements as the only unknowns what yields without a change of volume locks: the limit load "
               "comes out too large, or there is none");
  diag_hint(diag,
            "`formulation: mixed` and `mean-dilatation` do not lock, nor do triangles with `diagonal: crossed`, "
            "nor quadrilaterals with `points_per_cell: 1`");
}

PetscReal raised_time(const Model *m, PetscReal t)
{
  const PetscReal end = m->c->analysis.end;
  if (!m->raised.rising || !is_forces(m->c)) return t;
  return end + (t > m->time ? m->raised.border.factor : m->raised.factor);
}

/* Nodal forces of the load for a factor of 1, in the frames of the nodes. */
static PetscErrorCode NodalLoad(Model *m, PetscReal *load)
{
  const PetscReal end = m->c->analysis.end;
  const PetscInt dofs = m->grid->n_nodes * m->dim;
  NodalScene scene = nodal_scene(m, m->time, m->nodes->du);
  PetscReal g[3], *none, local[3] = {0, 0, 0}, sum[3];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(dofs, &none));
  scene.t = end;
  PetscCall(NodalForcesExternal(&m->forces, &scene, follows(m->c), none));
  scene.t = end + 1;
  PetscCall(NodalForcesExternal(&m->forces, &scene, follows(m->c), load));
  gravity_at(m->c, end + 1, g);
  for (PetscInt i = 0; i < dofs; ++i) {
    const PetscBool weighs = m->c->analysis.limit.kind == RAISE_GRAVITY && m->nodes->touched[i / m->dim];
    load[i] += (weighs ? m->nodes->mass[i / m->dim] * g[i % m->dim] : 0) - none[i];
    if (i < m->grid->n_owned * m->dim) local[i % m->dim] += load[i];
  }
  PetscCall(PetscFree(none));
  PetscCall(MPIU_Allreduce(local, sum, 3, MPIU_REAL, MPI_SUM, m->comm));
  m->raised.resultant = PetscSqrtReal(PetscSqr(sum[0]) + PetscSqr(sum[1]) + PetscSqr(sum[2]));
  frames_turn(&m->boundary->frames, m->dim, load);
  PetscFunctionReturn(0);
}

PetscErrorCode RaisedPrepare(Model *m, PetscReal dt, StepProblem *p)
{
  Raised *r = &m->raised;

  PetscFunctionBeginUser;
  if (!r->rising || !is_forces(m->c)) PetscFunctionReturn(0);
  PetscCall(PetscFree(r->nodal));
  PetscCall(PetscCalloc1(m->grid->n_nodes * m->dim, &r->nodal));
  PetscCall(NodalLoad(m, r->nodal));
  r->border = (LoadBorder){.load = r->nodal,
                           .start = r->factor,
                           .factor = r->factor,
                           .work = r->unit > 0 ? r->unit * dt : dt,
                           .unit = r->unit,
                           .lacks = 1,
                           .follows = follows(m->c),
                           .time = m->c->analysis.end};
  p->border = &r->border;
  PetscFunctionReturn(0);
}

/* Force of the boundary, or of the wall, on the material along its prescribed displacement, and how far that has
 * come. */
static PetscErrorCode LookAtMotion(Model *m)
{
  const LimitSpec *limit = &m->c->analysis.limit;
  const MotionSpec *motion = case_raised_motion(m->c);
  PetscReal sum[3], square = 0;

  PetscFunctionBeginUser;
  if (limit->kind == RAISE_WALL) PetscCall(PetscArraycpy(sum, m->contact->wall[limit->index].mean.force, 3));
  else PetscCall(ModelReaction(m, limit->index, sum));
  for (PetscInt d = 0; d < m->dim; ++d) square += PetscSqr(motion->value[d]);
  m->raised.load = 0;
  for (PetscInt d = 0; d < m->dim && square > 0; ++d)
    m->raised.load += sum[d] * motion->value[d] / PetscSqrtReal(square);
  m->raised.displacement = PetscSqrtReal(square) * (m->time - m->c->analysis.end);
  PetscFunctionReturn(0);
}

PetscErrorCode RaisedBegin(Model *m)
{
  PetscFunctionBeginUser;
  step_control_start(&m->control, m->c->analysis.limit.step); /* how loads came on says nothing of it */
  if (!is_forces(m->c)) PetscCall(LookAtMotion(m));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelRaise(Model *m, PetscReal control, StepReport *report)
{
  Raised *r = &m->raised;

  PetscFunctionBeginUser;
  r->rising = PETSC_TRUE;
  m->control.next = control;
  PetscCall(ModelStep(m, control, report));
  PetscCall(PetscFree(r->nodal));
  if (report->outcome != STEP_ACCEPTED && report->outcome != STEP_POINTS_LOST) PetscFunctionReturn(0);
  if (is_forces(m->c)) {
    r->load = r->factor = r->border.factor;
    r->unit = r->border.unit;
    if (r->resultant > 0) r->displacement += r->border.work / r->resultant;
  } else PetscCall(LookAtMotion(m));
  PetscFunctionReturn(0);
}
