#include "case/case.h"
#include <string.h>
#include "case/terrain/relief.h"

static PetscErrorCode AmplitudeClear(Amplitude *amplitude)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(amplitude->time));
  PetscCall(PetscFree(amplitude->value));
  PetscFunctionReturn(0);
}

static PetscErrorCode ShapeClear(Shape *shape)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < shape->n_children; ++i) PetscCall(ShapeClear(&shape->children[i]));
  PetscCall(PetscFree(shape->children));
  PetscCall(PetscFree(shape->vertices));
  PetscCall(ReliefDestroy(&shape->relief));
  PetscCall(PetscFree(shape->file));
  PetscCall(PetscFree(shape->group));
  PetscFunctionReturn(0);
}

static PetscErrorCode SelectorClear(Selector *on)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(on->boundary));
  PetscCall(PetscFree(on->body));
  PetscCall(ShapeClear(&on->shape));
  PetscFunctionReturn(0);
}

static PetscErrorCode NamedValuesClear(PetscInt n, NamedValue **values)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; ++i) PetscCall(PetscFree((*values)[i].name));
  PetscCall(PetscFree(*values));
  PetscFunctionReturn(0);
}

static PetscErrorCode AmplitudesClear(PetscInt n, NamedAmplitude **amplitudes)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; ++i) {
    PetscCall(PetscFree((*amplitudes)[i].name));
    PetscCall(PetscFree((*amplitudes)[i].amplitude.time));
    PetscCall(PetscFree((*amplitudes)[i].amplitude.value));
  }
  PetscCall(PetscFree(*amplitudes));
  PetscFunctionReturn(0);
}

static PetscErrorCode StringsClear(PetscInt n, char ***strings)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; ++i) PetscCall(PetscFree((*strings)[i]));
  PetscCall(PetscFree(*strings));
  PetscFunctionReturn(0);
}

static PetscErrorCode BodiesClear(Case *c)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < c->n_bodies; ++i) {
    BodySpec *body = &c->bodies[i];
    PetscCall(PetscFree(body->name));
    PetscCall(PetscFree(body->material));
    PetscCall(PetscFree(body->region));
    PetscCall(PetscFree(body->mesh));
    for (int k = 0; k < 6; ++k) PetscCall(PetscFree(body->stress[k]));
    PetscCall(ShapeClear(&body->shape));
  }
  PetscCall(PetscFree(c->bodies));
  PetscFunctionReturn(0);
}

static PetscErrorCode MaterialsClear(Case *c)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < c->n_materials; ++i) {
    PetscCall(PetscFree(c->materials[i].name));
    PetscCall(PetscFree(c->materials[i].law));
    PetscCall(NamedValuesClear(c->materials[i].n_parameters, &c->materials[i].parameters));
    PetscCall(AmplitudesClear(c->materials[i].n_amplitudes, &c->materials[i].amplitudes));
  }
  PetscCall(PetscFree(c->materials));
  PetscFunctionReturn(0);
}

static PetscErrorCode BoundaryAndLoadsClear(Case *c)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < c->n_boundary; ++i) {
    PetscCall(SelectorClear(&c->boundary[i].on));
    PetscCall(AmplitudeClear(&c->boundary[i].amplitude));
    PetscCall(StringsClear(c->boundary[i].n_bodies, &c->boundary[i].bodies));
    PetscCall(PetscFree(c->boundary[i].name));
  }
  PetscCall(PetscFree(c->boundary));
  for (PetscInt i = 0; i < case_acting_loads(c); ++i) {
    PetscCall(PetscFree(c->loads[i].name));
    PetscCall(PetscFree(c->loads[i].factor));
    PetscCall(SelectorClear(&c->loads[i].on));
    PetscCall(AmplitudeClear(&c->loads[i].amplitude));
  }
  PetscCall(PetscFree(c->loads));
  PetscCall(AmplitudeClear(&c->gravity_amplitude));
  PetscFunctionReturn(0);
}

static PetscErrorCode WallsClear(Case *c)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < c->n_walls; ++i) {
    WallSpec *wall = &c->walls[i];
    PetscCall(PetscFree(wall->name));
    PetscCall(ShapeClear(&wall->shape));
    for (PetscInt k = 0; k < wall->n_motions; ++k) PetscCall(AmplitudeClear(&wall->motions[k].amplitude));
    PetscCall(PetscFree(wall->motions));
    PetscCall(AmplitudeClear(&wall->mass.amplitude));
    PetscCall(StringsClear(wall->n_bodies, &wall->bodies));
  }
  PetscCall(PetscFree(c->walls));
  PetscFunctionReturn(0);
}

static PetscErrorCode InterfacesClear(Case *c)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < c->n_interfaces; ++i) {
    PetscCall(PetscFree(c->interfaces[i].name));
    PetscCall(StringsClear(c->interfaces[i].n_between, &c->interfaces[i].between));
  }
  PetscCall(PetscFree(c->interfaces));
  PetscFunctionReturn(0);
}

static PetscErrorCode MeasuresClear(Case *c)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < c->n_measures; ++i) {
    PetscCall(PetscFree(c->measures[i].name));
    PetscCall(PetscFree(c->measures[i].kind));
    PetscCall(PetscFree(c->measures[i].word));
    PetscCall(PetscFree(c->measures[i].body));
    PetscCall(PetscFree(c->measures[i].wall));
    PetscCall(PetscFree(c->measures[i].interface));
    PetscCall(ShapeClear(&c->measures[i].in));
  }
  PetscCall(PetscFree(c->measures));
  PetscFunctionReturn(0);
}

static PetscErrorCode StagesClear(Case *c)
{
  PetscFunctionBeginUser;
  PetscCall(StringsClear(c->strength.n_bodies, &c->strength.bodies));
  PetscCall(PetscFree(c->initial.run));
  PetscCall(PetscFree(c->initial.stage));
  for (PetscInt k = 0; k < c->n_stages; ++k) {
    PetscCall(PetscFree(c->stages[k].name));
    PetscCall(PetscFree(c->stages[k].text));
    if (c->stage_case) PetscCall(CaseDestroy(&c->stage_case[k]));
  }
  PetscCall(PetscFree(c->stages));
  PetscCall(PetscFree(c->stage_case));
  PetscCall(PetscFree(c->columns));
  PetscFunctionReturn(0);
}

PetscErrorCode CaseAddFile(Case *c, const char *key, const char *path)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < c->n_files; ++k)
    if (!strcmp(c->files[k].path, path)) PetscFunctionReturn(0);
  PetscCall(PetscRealloc((size_t)(c->n_files + 1) * sizeof(CaseFile), &c->files));
  CaseFile *file = &c->files[c->n_files++];
  PetscCall(PetscStrallocpy(key, &file->key));
  PetscCall(PetscStrallocpy(path, &file->path));
  PetscFunctionReturn(0);
}

static PetscErrorCode FilesClear(Case *c)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < c->n_files; ++k) {
    PetscCall(PetscFree(c->files[k].key));
    PetscCall(PetscFree(c->files[k].path));
  }
  PetscCall(PetscFree(c->files));
  PetscFunctionReturn(0);
}

PetscErrorCode CaseDestroy(Case **c)
{
  PetscFunctionBeginUser;
  if (!*c) PetscFunctionReturn(0);
  PetscCall(StagesClear(*c));
  PetscCall(PetscFree((*c)->file));
  PetscCall(PetscFree((*c)->folder));
  PetscCall(PetscFree((*c)->title));
  PetscCall(PetscFree((*c)->method));
  PetscCall(PetscFree((*c)->formulation));
  PetscCall(PetscFree((*c)->analysis.scheme));
  PetscCall(PetscFree((*c)->analysis.transfer));
  for (PetscInt i = 0; i < (*c)->analysis.n_until; ++i) PetscCall(PetscFree((*c)->analysis.until[i].measure));
  PetscCall(PetscFree((*c)->analysis.until));
  PetscCall(PetscFree((*c)->analysis.limit.raise));
  PetscCall(StringsClear((*c)->analysis.reduction.n_bodies, &(*c)->analysis.reduction.bodies));
  PetscCall(PetscFree((*c)->grid.mesh));
  PetscCall(NamedValuesClear((*c)->grid.n_parameters, &(*c)->grid.parameters));
  PetscCall(BodiesClear(*c));
  PetscCall(MaterialsClear(*c));
  PetscCall(BoundaryAndLoadsClear(*c));
  PetscCall(WallsClear(*c));
  PetscCall(InterfacesClear(*c));
  PetscCall(MeasuresClear(*c));
  PetscCall(StringsClear((*c)->output.n_fields, &(*c)->output.fields));
  PetscCall(StringsClear((*c)->n_petsc, &(*c)->petsc));
  PetscCall(FilesClear(*c));
  PetscCall(PetscFree(*c));
  PetscFunctionReturn(0);
}

PetscBool case_is_mixed(const Case *c) { return c->formulation && !strcmp(c->formulation, "mixed"); }

PetscBool case_has_contact(const Case *c, ContactKind kind)
{
  for (PetscInt k = 0; k < c->n_walls; ++k)
    if (c->walls[k].contact == kind) return PETSC_TRUE;
  for (PetscInt k = 0; k < c->n_interfaces; ++k)
    if (c->interfaces[k].contact == kind) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscBool case_dilates(const Case *c)
{
  for (PetscInt m = 0; m < c->n_materials; ++m)
    for (PetscInt k = 0; k < c->materials[m].n_parameters; ++k)
      if (strstr(c->materials[m].parameters[k].name, "dilatancy") && c->materials[m].parameters[k].value > 0)
        return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscBool case_reduces(const Case *c, const BodySpec *body)
{
  const PetscBool seeks = c->analysis.type == ANALYSIS_FACTOR;
  const PetscInt n = seeks ? c->analysis.reduction.n_bodies : c->strength.n_bodies;
  char *const *bodies = seeks ? c->analysis.reduction.bodies : c->strength.bodies;
  for (PetscInt k = 0; k < n; ++k)
    if (!strcmp(bodies[k], body->name)) return PETSC_TRUE;
  return n == 0;
}

PetscBool case_reduces_material(const Case *c, PetscInt i)
{
  for (PetscInt b = 0; b < c->n_bodies; ++b)
    if (!c->bodies[b].absent && case_reduces(c, &c->bodies[b]) && !strcmp(c->bodies[b].material, c->materials[i].name))
      return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscReal analysis_usual_beta(const AnalysisSpec *a) { return 0.25 * (1 - a->bossak) * (1 - a->bossak); }
PetscReal analysis_usual_gamma(const AnalysisSpec *a) { return 0.5 - a->bossak; }

PetscBool analysis_tunes_newmark(const AnalysisSpec *a)
{
  return (PetscBool)(PetscAbsReal(a->beta - analysis_usual_beta(a)) > 1e-12 ||
                     PetscAbsReal(a->gamma - analysis_usual_gamma(a)) > 1e-12);
}

PetscBool case_is_static(const AnalysisSpec *analysis)
{
  return analysis->type != ANALYSIS_DYNAMIC && analysis->type != ANALYSIS_EXPLICIT;
}

/* What strains by nodes of little mass shakes there, and less in short substeps. */
static PetscReal usual_of(const AnalysisSpec *analysis) { return analysis->update == EXPLICIT_USL ? 0.3 : 0.8; }

/* Of what `musl` does. */
static PetscReal bears(const AnalysisSpec *analysis) { return usual_of(analysis) / 0.8; }

/* Half a layer of cells between a spring and the next cell has omega^2 = 2 (1 + stiffness) c^2 / h^2. */
PetscReal case_courant(const AnalysisSpec *analysis)
{
  const PetscReal usual = analysis->courant > 0 ? analysis->courant : usual_of(analysis);
  return PetscMin(usual, bears(analysis) * PetscSqrtReal(2 / (1 + analysis->contact / CONTACT_MARGIN)));
}

PetscReal case_courant_of_musl(const AnalysisSpec *analysis) { return case_courant(analysis) / bears(analysis); }

PetscBool case_seeks(const AnalysisSpec *analysis)
{
  return analysis->type == ANALYSIS_FACTOR || analysis->type == ANALYSIS_LIMIT;
}

PetscReal case_time(const Case *c, PetscReal t) { return case_seeks(&c->analysis) ? PetscMin(t, c->analysis.end) : t; }

PetscBool case_writes(const Case *c, const char *field)
{
  if (c->n_interfaces && !strcmp(field, "body")) return PETSC_TRUE; /* pictures keep them apart */
  for (PetscInt f = 0; f < c->output.n_fields; ++f)
    if (!strcmp(c->output.fields[f], field)) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscInt case_height_axis(const Case *c)
{
  const PetscInt dim = kinematics_dim(c->kinematics);
  PetscInt axis = dim - 1;
  for (PetscInt d = 0; d < dim; ++d)
    if (PetscAbsReal(c->gravity[d]) > PetscAbsReal(c->gravity[axis])) axis = d;
  return axis;
}

PetscBool body_has_stress(const BodySpec *body) { return body->has_k0 || body->has_stress; }

PetscBool case_has_stress(const Case *c)
{
  for (PetscInt b = 0; b < c->n_bodies; ++b)
    if (body_has_stress(&c->bodies[b]) && !c->bodies[b].absent) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscBool case_equilibrates(const Case *c)
{
  return (PetscBool)(c->initial.equilibrium > EQUILIBRIUM_NONE && c->stage == 0);
}

PetscBool case_starts_with_gravity(const Case *c)
{
  return case_has_stress(c) || c->initial.equilibrium > EQUILIBRIUM_NONE || (c->initial.run && c->stage == 0);
}

const char *case_load_path(const Case *c, PetscInt k, char path[64])
{
  static const char *const lists[LOAD_KINDS] = {
    [LOAD_TRACTION] = "tractions", [LOAD_POINT] = "points", [LOAD_PRESSURE] = "pressures"};
  PetscInt i = 0;
  for (PetscInt j = 0; j < k; ++j) i += c->loads[j].kind == c->loads[k].kind;
  snprintf(path, 64, "loads.%s[%d]", lists[c->loads[k].kind], (int)i);
  return path;
}

PetscInt case_acting_loads(const Case *c)
{
  PetscInt n = c->n_loads;
  while (n > 0 && c->loads[n - 1].waits) --n;
  return n;
}

PetscBool case_load_follows(const Case *c)
{
  for (PetscInt k = 0; k < case_acting_loads(c); ++k)
    if (c->loads[k].kind == LOAD_PRESSURE && load_pushes(c->loads + k)) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscBool case_wall_meets(const WallSpec *wall, const char *body)
{
  for (PetscInt i = 0; i < wall->n_bodies; ++i)
    if (!strcmp(wall->bodies[i], body)) return PETSC_TRUE;
  return !wall->n_bodies;
}
