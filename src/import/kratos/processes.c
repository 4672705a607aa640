/* The processes of ProjectParameters.json: what holds, pushes and starts the material. */
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/formula.h"
#include "case/case.h"
#include "import/kratos/project.h"

typedef PetscErrorCode ReadProcess(KratosProject *p, const YamlNode *process, const YamlNode *parameters);

static PetscErrorCode Add(KratosProject *p, KratosKind kind, const YamlNode *parameters, KratosAction **action)
{
  const YamlNode *named = yaml_find(parameters, "model_part_name");

  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((size_t)(p->n_actions + 1) * sizeof(KratosAction), &p->actions));
  *action = &p->actions[p->n_actions++];
  **action = (KratosAction){.kind = kind};
  snprintf((*action)->part, KRATOS_NAME, "%s", kratos_part(kratos_text(parameters, "model_part_name")));
  kratos_name((*action)->part, (*action)->name);
  if (!mdpa_part(p->grid, (*action)->part))
    kratos_refuse(&p->parameters, named ? named : parameters,
                  "%s has no model part '%s': only parts of the grid are held and loaded", p->grid->file,
                  (*action)->part);
  PetscFunctionReturn(0);
}

/* Only what acts all the time is read: from the start, or before, to "End", or beyond. */
static void check_interval(KratosProject *p, const YamlNode *parameters)
{
  const YamlNode *interval = yaml_find(parameters, "interval");
  if (!interval || interval->kind != YAML_SEQUENCE || interval->n != 2) return;
  const char *from = interval->child[0]->text, *to = interval->child[1]->text;
  const PetscBool ends = to && strcmp(to, "End") && strtod(to, NULL) < p->start + p->end * (1 - 1e-12);
  if (ends || !from || strtod(from, NULL) > p->start)
    kratos_refuse(&p->parameters, interval, "what begins or ends within the run is not read");
}

static PetscErrorCode ReadHeld(KratosProject *p, const YamlNode *process, const YamlNode *parameters)
{
  const char *variable = kratos_text(parameters, "variable_name");
  const YamlNode *constrained = yaml_find(parameters, "constrained"), *value = yaml_find(parameters, "value");
  KratosAction *a;

  PetscFunctionBeginUser;
  if (strcmp(variable, "DISPLACEMENT")) {
    kratos_refuse(&p->parameters, process, "prescribed %s is not read, only DISPLACEMENT",
                  variable[0] ? variable : "what?");
    PetscFunctionReturn(0);
  }
  check_interval(p, parameters);
  PetscCall(Add(p, KRATOS_HELD, parameters, &a));
  (void)kratos_vector(&p->parameters, parameters, "value", a->value);
  for (PetscInt d = 0; d < p->dim; ++d) {
    const YamlNode *held =
      constrained && constrained->kind == YAML_SEQUENCE && d < constrained->n ? constrained->child[d] : constrained;
    const PetscBool given = !value || value->kind != YAML_SEQUENCE || d >= value->n || !yaml_is_null(value->child[d]);
    a->set[d] = given && (!held || !held->text || strcmp(held->text, "false"));
  }
  PetscFunctionReturn(0);
}

static PetscBool is_of_name(char c) { return (PetscBool)(isalnum((unsigned char)c) || c == '_'); }

/* A formula of Kratos as one of talus: a power is ^ for **, and the time t, which begins with 0, is less by the start.
 * PETSC_FALSE: it is too long. */
static PetscBool translate(const KratosProject *p, const char *text, char factor[KRATOS_NAME])
{
  char time[40] = "t";
  size_t n = 0;
  if (p->start != 0) snprintf(time, sizeof time, "(t + %.15g)", (double)p->start);
  for (const char *c = text; *c && n < KRATOS_NAME; ++c) {
    const PetscBool power = c[0] == '*' && c[1] == '*';
    const PetscBool now = *c == 't' && !is_of_name(c[1]) && (c == text || !is_of_name(c[-1]));
    n += (size_t)snprintf(factor + n, KRATOS_NAME - n, "%.*s", now ? 39 : 1, now ? time : power ? "^" : c);
    c += power;
  }
  return n < KRATOS_NAME;
}

/* A modulus that is a formula. Does nothing with a number. */
static PetscErrorCode ReadFormula(KratosProject *p, const YamlNode *modulus, char factor[KRATOS_NAME])
{
  const PetscReal origin[3] = {0, 0, 0};
  LoadPlace place = {.dim = p->dim, .X = origin, .x = origin};
  Formula formula = {.value = LoadPlaceValue, .context = &place, .at = factor};
  PetscReal value;
  char *end;

  PetscFunctionBeginUser;
  factor[0] = '\0';
  if (!modulus || modulus->kind != YAML_SCALAR || (strtod(modulus->text, &end), !*end)) PetscFunctionReturn(0);
  const PetscBool fits = translate(p, modulus->text, factor);
  if (fits) PetscCall(FormulaValue(&formula, &value));
  if (fits && !formula.wrong) PetscFunctionReturn(0);
  if (!fits) kratos_refuse(&p->parameters, modulus, "a formula of so many letters is not read");
  else
    kratos_refuse(&p->parameters, modulus, "the formula '%s' is not read from '%s' on", modulus->text, formula.wrong);
  strcpy(factor, "1"); /* told */
  PetscFunctionReturn(0);
}

/* A direction as it stands, which may be no unit vector. */
static void read_direction(KratosProject *p, const YamlNode *parameters, PetscReal modulus, PetscReal value[3])
{
  (void)kratos_vector(&p->parameters, parameters, "direction", value);
  if (modulus != 0 && value[0] == 0 && value[1] == 0 && value[2] == 0)
    kratos_refuse(&p->parameters, parameters, "a direction of three numbers, not all 0, is expected");
}

/* Gravity and velocities: Kratos multiplies the direction by the modulus as it stands. */
static void read_product(KratosProject *p, const YamlNode *parameters, PetscReal value[3])
{
  const PetscReal modulus = kratos_number(&p->parameters, parameters, "modulus", 1);
  read_direction(p, parameters, modulus, value);
  for (int d = 0; d < 3; ++d) value[d] *= modulus;
}

/* Loads: Kratos divides the direction by its length. With a formula for its modulus it is the direction alone. */
static void read_directed(KratosProject *p, const YamlNode *parameters, const char *factor, PetscReal value[3])
{
  const PetscReal modulus = factor[0] ? 1 : kratos_number(&p->parameters, parameters, "modulus", 0);
  read_direction(p, parameters, modulus, value);
  const PetscReal length = sqrt(value[0] * value[0] + value[1] * value[1] + value[2] * value[2]);
  for (int d = 0; d < 3 && length > 0; ++d) value[d] *= modulus / length;
}

static PetscErrorCode ReadLoad(KratosProject *p, const YamlNode *process, const YamlNode *parameters)
{
  const char *variable = kratos_text(parameters, "variable_name");
  const PetscBool point = !strcmp(variable, "POINT_LOAD");
  KratosAction *a;

  PetscFunctionBeginUser;
  if (!point && strcmp(variable, "LINE_LOAD") && strcmp(variable, "SURFACE_LOAD")) {
    kratos_refuse(&p->parameters, process, "a load by %s is not read, only POINT_LOAD, LINE_LOAD and SURFACE_LOAD",
                  variable);
    PetscFunctionReturn(0);
  }
  check_interval(p, parameters);
  PetscCall(Add(p, point ? KRATOS_POINT_LOAD : KRATOS_LINE_LOAD, parameters, &a));
  PetscCall(ReadFormula(p, yaml_find(parameters, "modulus"), a->factor));
  read_directed(p, parameters, a->factor, a->value);
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadSlip(KratosProject *p, const YamlNode *process, const YamlNode *parameters)
{
  KratosAction *a;

  PetscFunctionBeginUser;
  (void)process;
  if (kratos_number(&p->parameters, parameters, "friction_coefficient", 0) > 0 ||
      kratos_number(&p->parameters, parameters, "tangential_penalty_coefficient", 0) > 0)
    kratos_refuse(&p->parameters, parameters, "friction along a slip boundary is not read; talus has it for walls:");
  PetscCall(Add(p, KRATOS_SLIP, parameters, &a));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadGravity(KratosProject *p, const YamlNode *process, const YamlNode *parameters)
{
  PetscFunctionBeginUser;
  (void)process;
  read_product(p, parameters, p->gravity);
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadVelocity(KratosProject *p, const YamlNode *process, const YamlNode *parameters)
{
  const char *part = kratos_part(kratos_text(parameters, "model_part_name"));
  PetscReal velocity[3];
  PetscBool found = PETSC_FALSE;

  PetscFunctionBeginUser;
  read_product(p, parameters, velocity);
  for (PetscInt b = 0; b < p->n_bodies; ++b) {
    if (strcmp(p->bodies[b].part, part) && strcmp(part, "MPM_Material")) continue;
    for (int d = 0; d < 3; ++d) p->bodies[b].velocity[d] = velocity[d];
    found = PETSC_TRUE;
  }
  if (!found) kratos_refuse(&p->parameters, process, "no material has the model part '%s'", part);
  PetscFunctionReturn(0);
}

static PetscErrorCode AddCheck(KratosProject *p, const YamlNode *parameters, PetscBool points)
{
  KratosCheck *check;

  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((size_t)(p->n_checks + 1) * sizeof(KratosCheck), &p->checks));
  check = &p->checks[p->n_checks++];
  *check = (KratosCheck){.variables = yaml_find(parameters, "check_variables"), .points = points};
  kratos_path(p, kratos_text(parameters, "input_file_name"), "", check->file);
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadPointCheck(KratosProject *p, const YamlNode *process, const YamlNode *parameters)
{
  (void)process;
  return AddCheck(p, parameters, PETSC_TRUE);
}

static PetscErrorCode ReadNodeCheck(KratosProject *p, const YamlNode *process, const YamlNode *parameters)
{
  (void)process;
  return AddCheck(p, parameters, PETSC_FALSE);
}

/* What the run writes is talus's own affair. */
static PetscErrorCode LeaveOut(KratosProject *p, const YamlNode *process, const YamlNode *parameters)
{
  (void)p, (void)process, (void)parameters;
  return 0;
}

static const struct {
  const char *module;
  ReadProcess *read;
} known[] = {
  {"assign_vector_variable_process", ReadHeld},
  {"assign_vector_by_direction_to_condition_process", ReadLoad},
  {"apply_mpm_slip_boundary_process", ReadSlip},
  {"assign_gravity_to_particle_process", ReadGravity},
  {"assign_gravity_to_material_point_process", ReadGravity},
  {"assign_initial_velocity_to_particle_process", ReadVelocity},
  {"assign_initial_velocity_to_material_point_process", ReadVelocity},
  {"particle_from_json_check_result_process", ReadPointCheck},
  {"mpm_from_json_check_result_process", ReadPointCheck},
  {"from_json_check_result_process", ReadNodeCheck},
  {"particle_json_output_process", LeaveOut},
  {"mpm_json_output_process", LeaveOut},
  {"json_output_process", LeaveOut},
  {"particle_gid_output_process", LeaveOut},
  {"mpm_gid_output_process", LeaveOut},
  {"gid_output_process", LeaveOut},
  {"particle_vtk_output_process", LeaveOut},
  {"mpm_vtk_output_process", LeaveOut},
  {"vtk_output_process", LeaveOut},
  {NULL, NULL},
};

static PetscErrorCode ReadOne(KratosProject *p, const YamlNode *process)
{
  const char *module = kratos_text(process, "python_module");
  const YamlNode *parameters = yaml_find(process, "Parameters");
  int i = 0;

  PetscFunctionBeginUser;
  while (known[i].module && strcmp(known[i].module, module)) ++i;
  if (!known[i].module) {
    const YamlNode *named = yaml_find(process, "python_module");
    kratos_refuse(&p->parameters, named ? named : process, "talus has nothing for the process '%s'", module);
  } else if (!parameters) kratos_refuse(&p->parameters, process, "a process has no Parameters");
  else PetscCall((*known[i].read)(p, process, parameters));
  PetscFunctionReturn(0);
}

PetscErrorCode KratosReadProcesses(KratosProject *p)
{
  const YamlNode *all = yaml_find(p->parameters.document->root, "processes");

  PetscFunctionBeginUser;
  for (PetscInt i = 0; all && i < all->n; ++i)
    for (PetscInt k = 0; k < all->child[i]->n; ++k) PetscCall(ReadOne(p, all->child[i]->child[k]));
  PetscFunctionReturn(0);
}
