/* The language of sweep.yaml, read through the same tables as a case file. */
#include <string.h>
#include "input/case_file.h"
#include "sweep/sweep_spec.h"

static PetscErrorCode TakePlace(SchemaReader *r, const YamlNode *mapping, void *target)
{
  PetscFunctionBeginUser;
  (void)r;
  ((SweepKey *)target)->node = mapping; /* an axis begins with its key */
  PetscFunctionReturn(0);
}

/* Of a SweepKey, or of a SweepAxis, which begins with one. */
#define KEY_KEYS                                                                                            \
  KEY("key", TEXT, NULL, "path of a key in the case file, as in --set", REQUIRED, AT(SweepKey, key)),       \
    KEY("values", VALUES, NULL, "a list of values, or a range from:to:step", REQUIRED, AT(SweepKey, text)), \
    KEY("quick", VALUES, NULL, "those with --quick", AT(SweepKey, quick)),                                  \
    KEY("label", TEXT, NULL, "what pictures call it", AT(SweepKey, label))

static const SchemaEntry along_entries[] = {KEY_KEYS, {.key = NULL}};
static const SchemaTable along_table = {.name = "along",
                                        .help = "A key that varies along with another.",
                                        .entries = along_entries,
                                        .check = TakePlace,
                                        .size = sizeof(SweepKey)};

static const SchemaEntry axis_entries[] = {
  KEY_KEYS,
  KEY("along", LIST, NULL, "keys that vary along with it: as many values", .table = &along_table, AT(SweepAxis, along),
      .count = offsetof(SweepAxis, n_along)),
  {.key = NULL},
};
static const SchemaTable axis_table = {.name = "over",
                                       .help = "A key and its values.",
                                       .entries = axis_entries,
                                       .check = TakePlace,
                                       .size = sizeof(SweepAxis)};

static const SchemaEntry band_entries[] = {
  KEY("name", TEXT, NULL, "in the legend", REQUIRED, AT(SweepBand, name)),
  KEY("between", INTERVAL, NULL, "[lowest, highest], or one value", REQUIRED, AT(SweepBand, low),
      .second = offsetof(SweepBand, high)),
  {.key = NULL},
};
static const SchemaTable band_table = {
  .name = "band", .help = "What experiments gave.", .entries = band_entries, .size = sizeof(SweepBand)};

static const SchemaEntry measure_entries[] = {
  TAKEN_KEYS(SweepMeasure, taken),
  KEY("bands", LIST, NULL, "ranges of experiments, shaded in the picture", .table = &band_table,
      AT(SweepMeasure, bands), .count = offsetof(SweepMeasure, n_bands)),
  {.key = NULL},
};
static const SchemaTable measure_table = {.name = "measures",
                                          .help = "A number that is taken from each member.",
                                          .entries = measure_entries,
                                          .size = sizeof(SweepMeasure)};

/* The name becomes a folder's. */
static PetscErrorCode CheckSweep(SchemaReader *r, const YamlNode *mapping, void *target)
{
  const char *name = ((SweepSpecification *)target)->name;

  PetscFunctionBeginUser;
  if (!name[0] || name[0] == '.' || strchr(name, '/'))
    SchemaError(r, yaml_find(mapping, "name"), "the name of a sweep is that of a folder: no '/', and no '.' in front");
  PetscFunctionReturn(0);
}

static const SchemaEntry sweep_entries[] = {
  KEY("name", TEXT, NULL, "for --name", REQUIRED, AT(SweepSpecification, name)),
  KEY("title", TEXT, NULL, "what it shows", REQUIRED, AT(SweepSpecification, title)),
  SET_KEY("set", "values of the case file to change in all members", SweepSpecification, set),
  SET_KEY("quick", "and those with --quick", SweepSpecification, quick),
  KEY("over", LIST, NULL, "the keys whose values are combined: the first is the axis of pictures", REQUIRED,
      .table = &axis_table, AT(SweepSpecification, axes), .count = offsetof(SweepSpecification, n_axes)),
  KEY("measures", LIST, NULL, "what is taken; default: all measures of the case at the end", .table = &measure_table,
      AT(SweepSpecification, measures), .count = offsetof(SweepSpecification, n_measures)),
  {.key = NULL},
};
static const SchemaTable sweep_table = {.name = "sweep",
                                        .help = "One sweep.",
                                        .entries = sweep_entries,
                                        .check = CheckSweep,
                                        .size = sizeof(SweepSpecification)};

static const SchemaEntry file_entries[] = {
  KEY("title", TEXT, NULL, "of all", AT(SweepFile, title)),
  KEY("sweeps", LIST, NULL, "sweeps by name", .table = &sweep_table, REQUIRED, AT(SweepFile, sweeps),
      .count = offsetof(SweepFile, n)),
  {.key = NULL},
};
static const SchemaTable file_table = {
  .name = "sweeps", .help = "Sweeps of a case.", .entries = file_entries, .size = sizeof(SweepFile)};

PetscErrorCode SweepFileRead(const char *path, Diag *diag, SweepFile **sweeps)
{
  const PetscInt before = diag_errors(diag);

  PetscFunctionBeginUser;
  PetscCall(PetscNew(sweeps));
  PetscCall(SchemaReadDocument(PETSC_COMM_SELF, path, &file_table, diag, &(*sweeps)->document, *sweeps));
  if (diag_errors(diag) > before) PetscCall(SweepFileDestroy(sweeps));
  PetscFunctionReturn(0);
}

static PetscErrorCode ClearKey(SweepKey *key)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < key->n; ++i) PetscCall(PetscFree(key->value[i]));
  PetscCall(PetscFree(key->value));
  PetscFunctionReturn(0);
}

PetscErrorCode SweepFileDestroy(SweepFile **sweeps)
{
  PetscFunctionBeginUser;
  if (!*sweeps) PetscFunctionReturn(0);
  for (PetscInt s = 0; s < (*sweeps)->n; ++s)
    for (PetscInt a = 0; a < (*sweeps)->sweeps[s].n_axes; ++a) {
      SweepAxis *axis = &(*sweeps)->sweeps[s].axes[a];
      PetscCall(ClearKey(&axis->key));
      for (PetscInt k = 0; k < axis->n_along; ++k) PetscCall(ClearKey(&axis->along[k]));
    }
  PetscCall(SchemaClear(&file_table, *sweeps));
  PetscCall(YamlDestroy(&(*sweeps)->document));
  PetscCall(PetscFree(*sweeps));
  PetscFunctionReturn(0);
}
