#include "calibrate/calibrate_spec.h"
#include <ctype.h>
#include <string.h>
#include "input/case_file.h"

static PetscErrorCode CheckParameter(SchemaReader *r, const YamlNode *mapping, void *target)
{
  const Parameter *p = target;

  PetscFunctionBeginUser;
  if (!(p->high > p->low)) SchemaError(r, yaml_find(mapping, "range"), "the range of %s is empty", p->name);
  PetscFunctionReturn(0);
}

static const SchemaEntry parameter_entries[] = {
  KEY("range", INTERVAL, NULL, "[smallest, largest] that is looked at", REQUIRED, AT(Parameter, low),
      .second = offsetof(Parameter, high)),
  KEY("unit", TEXT, NULL, "its unit", AT(Parameter, unit)),
  KEY("label", TEXT, NULL, "what pictures call it", AT(Parameter, label)),
  {.key = NULL},
};
static const SchemaTable parameter_table = {.name = "parameter",
                                            .help = "What is looked for.",
                                            .entries = parameter_entries,
                                            .check = CheckParameter,
                                            .size = sizeof(Parameter)};

static const SchemaEntry target_entries[] = {
  TAKEN_KEYS(Target, taken),
  KEY("target", NUMBER, NULL, "what the experiment gave, in the unit shown", REQUIRED, AT(Target, value)),
  KEY("uncertainty", NUMBER, NULL, "how far off a run may be", REQUIRED, ABOVE(0), AT(Target, uncertainty)),
  {.key = NULL},
};
static const SchemaTable target_table = {
  .name = "measures", .help = "What was measured.", .entries = target_entries, .size = sizeof(Target)};

static const SchemaEntry instrument_entries[] = {
  KEY("case", TEXT, NULL, "the case, or its folder, from the folder of this file", REQUIRED, AT(Instrument, folder)),
  SET_KEY("set", "values of the case to change; $name is a parameter", Instrument, set),
  SET_KEY("quick", "and those with --quick", Instrument, quick),
  KEY("measures", LIST, NULL, "what was measured", REQUIRED, .table = &target_table, AT(Instrument, targets),
      .count = offsetof(Instrument, n_targets)),
  {.key = NULL},
};
static const SchemaTable instrument_table = {
  .name = "instrument", .help = "A case that has targets.", .entries = instrument_entries, .size = sizeof(Instrument)};

static const SchemaEntry calibration_entries[] = {
  KEY("title", TEXT, NULL, "what is calibrated", REQUIRED, AT(Calibration, title)),
  KEY("parameters", NAMED, NULL, "what is looked for, by name", REQUIRED, .table = &parameter_table,
      AT(Calibration, parameters), .count = offsetof(Calibration, n_parameters)),
  SET_KEY("set", "values to change in the cases of all instruments; $name is a parameter", Calibration, set),
  SET_KEY("quick", "and those with --quick", Calibration, quick),
  KEY("instruments", NAMED, NULL, "cases, by name", REQUIRED, .table = &instrument_table, AT(Calibration, instruments),
      .count = offsetof(Calibration, n_instruments)),
  KEY("points", INTEGER, NULL, "sets of parameters that are run at first; 0: eight for each parameter", .fallback = "0",
      BETWEEN(0, 0.5 * SURROGATE_RUNS), AT(Calibration, points)),
  KEY("rounds", INTEGER, NULL, "how often more are run where the region is not clear", .fallback = "3", BETWEEN(0, 20),
      AT(Calibration, rounds)),
  KEY("batch", INTEGER, NULL, "how many in each round", .fallback = "6", BETWEEN(1, 40), AT(Calibration, batch)),
  KEY("resolve", NUMBER, NULL, "share of the uncertainty below which the surrogate's error is small enough",
      .fallback = "0.3", ABOVE(0), AT(Calibration, resolve)),
  {.key = NULL},
};
static const SchemaTable calibration_table = {
  .name = "calibration", .help = "A calibration.", .entries = calibration_entries, .size = sizeof(Calibration)};

/* Does $name stand in one of the texts? */
static PetscErrorCode IsUsed(const SettingList *set, const char *name, PetscBool *used)
{
  SettingList changed = {0};

  PetscFunctionBeginUser;
  PetscCall(SettingListAppend(&changed, set, name, ""));
  *used = *used || !setting_lists_equal(&changed, set);
  PetscCall(SettingListClear(&changed));
  PetscFunctionReturn(0);
}

static PetscBool is_parameter(const Calibration *c, const char *name, size_t length)
{
  for (PetscInt p = 0; p < c->n_parameters; ++p)
    if (strlen(c->parameters[p].name) == length && !strncmp(c->parameters[p].name, name, length)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* $mu where there is no mu: what a case is told would be the text. */
static PetscErrorCode CheckNames(const Calibration *c, const YamlNode *node, Diag *diag)
{
  const char **names;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; node && i < node->n; ++i) PetscCall(CheckNames(c, node->child[i], diag));
  for (const char *at = node && node->text ? strchr(node->text, '$') : NULL; at; at = strchr(at + 1, '$')) {
    size_t length = 0;
    while (isalnum((unsigned char)at[1 + length]) || at[1 + length] == '_') ++length;
    if (!length || is_parameter(c, at + 1, length)) continue;
    PetscCall(PetscCalloc1(c->n_parameters + 1, &names));
    for (PetscInt p = 0; p < c->n_parameters; ++p) names[p] = c->parameters[p].name;
    yaml_error(c->document, diag, node, PETSC_FALSE, "there is no parameter '%.*s'", (int)length, at + 1);
    diag_hint_names(diag, "", names);
    PetscCall(PetscFree(names));
  }
  PetscFunctionReturn(0);
}

/* What is set for all instruments, or for one. */
static PetscErrorCode CheckSettings(const Calibration *c, const YamlNode *of, Diag *diag)
{
  PetscFunctionBeginUser;
  PetscCall(CheckNames(c, yaml_find(of, "set"), diag));
  PetscCall(CheckNames(c, yaml_find(of, "quick"), diag));
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckUse(const Calibration *c, Diag *diag)
{
  const YamlNode *parameters = yaml_find(c->document->root, "parameters"),
                 *instruments = yaml_find(c->document->root, "instruments");

  PetscFunctionBeginUser;
  PetscCall(CheckSettings(c, c->document->root, diag));
  for (PetscInt i = 0; i < instruments->n; ++i) PetscCall(CheckSettings(c, instruments->child[i], diag));
  if (c->n_parameters > SURROGATE_MOST)
    yaml_error(c->document, diag, parameters, PETSC_TRUE, "there are more than %d parameters", SURROGATE_MOST);
  for (PetscInt p = 0; p < c->n_parameters; ++p) {
    const char *name = c->parameters[p].name;
    PetscBool used = PETSC_FALSE;
    PetscCall(IsUsed(&c->set, name, &used));
    for (PetscInt i = 0; i < c->n_instruments; ++i) PetscCall(IsUsed(&c->instruments[i].set, name, &used));
    if (used) continue;
    yaml_error(c->document, diag, parameters->child[p], PETSC_TRUE, "the parameter %s changes nothing", name);
    diag_hint(diag, "name the key that it is: set: {materials.sugar.friction_angle: $%s}", name);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode TakenSideBySide(Instrument *instrument)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(instrument->n_targets, &instrument->taken));
  for (PetscInt k = 0; k < instrument->n_targets; ++k) instrument->taken[k] = instrument->targets[k].taken;
  PetscFunctionReturn(0);
}

PetscErrorCode CalibrationRead(const char *file, Diag *diag, Calibration **calibration)
{
  const PetscInt before = diag_errors(diag);
  Calibration *c;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(calibration));
  c = *calibration;
  PetscCall(SchemaReadDocument(PETSC_COMM_SELF, file, &calibration_table, diag, &c->document, c));
  if (diag_errors(diag) == before) PetscCall(CheckUse(c, diag));
  for (PetscInt i = 0; i < c->n_instruments; ++i) PetscCall(TakenSideBySide(&c->instruments[i]));
  if (!c->points) c->points = 8 * c->n_parameters;
  c->points = PetscMax(c->points, c->n_parameters + 6);
  if (diag_errors(diag) > before) PetscCall(CalibrationDestroy(calibration));
  PetscFunctionReturn(0);
}

PetscErrorCode CalibrationDestroy(Calibration **calibration)
{
  PetscFunctionBeginUser;
  if (!*calibration) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < (*calibration)->n_instruments; ++i)
    PetscCall(PetscFree((*calibration)->instruments[i].taken));
  PetscCall(SchemaClear(&calibration_table, *calibration));
  PetscCall(YamlDestroy(&(*calibration)->document));
  PetscCall(PetscFree(*calibration));
  PetscFunctionReturn(0);
}
