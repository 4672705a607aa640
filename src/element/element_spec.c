#include "element/element_spec.h"
#include <string.h>
#include "input/case_file.h"
#include "input/schema/keys/schema_keys.h"

static const SchemaEntry material_entries[] = {
  KEY("law", WORD_TEXT, NULL, "the constitutive law, see `talus list laws`", .registry = (const void *const *)laws,
      REQUIRED, AT(MaterialSpec, law)),
  KEY("density", NUMBER, "kg/m3", "as in a case; a point has no use for it", .fallback = "1000", ABOVE(0),
      AT(MaterialSpec, density)),
  {.key = NULL},
};
static PetscErrorCode ClearMaterial(void *target)
{
  MaterialSpec *m = target;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < m->n_parameters; ++i) PetscCall(PetscFree(m->parameters[i].name));
  PetscCall(PetscFree(m->parameters));
  PetscCall(PetscFree(m->law));
  PetscFunctionReturn(0);
}

static PetscErrorCode OpenMaterial(SchemaReader *r, const YamlNode *mapping, void *target)
{
  const YamlNode *amplitude = yaml_find(mapping, "amplitude");

  PetscFunctionBeginUser;
  if (amplitude) SchemaKeyError(r, amplitude, "a path has no time, with which constants could change");
  PetscCall(SchemaOpenMaterial(r, mapping, target));
  PetscFunctionReturn(0);
}

static const SchemaTable material_table = {.name = "material",
                                           .help = "A law with its constants.",
                                           .entries = material_entries,
                                           .open = OpenMaterial,
                                           .clear = ClearMaterial};

#define COMPONENT(name, unit, k) \
  KEY(name, NUMBER, unit, "component " name, AT(ElementComponents, value[k]), GIVEN(ElementComponents, given[k]))
#define COMPONENTS(unit)                                                                                  \
  COMPONENT("xx", unit, 0), COMPONENT("yy", unit, 1), COMPONENT("zz", unit, 2), COMPONENT("xy", unit, 3), \
    COMPONENT("yz", unit, 4), COMPONENT("zx", unit, 5),                                                   \
  {                                                                                                       \
    .key = NULL                                                                                           \
  }
static const SchemaEntry strain_entries[] = {COMPONENTS("")};
static const SchemaTable strain_table = {.name = "strain",
                                         .help = "Logarithmic strains, lengthening positive; xy, yz, zx: tangents.",
                                         .entries = strain_entries};
static const SchemaEntry stress_entries[] = {COMPONENTS("Pa")};
static const SchemaTable stress_table = {
  .name = "stress", .help = "Cauchy stresses, tension positive.", .entries = stress_entries};

static const SchemaEntry start_entries[] = {
  KEY("pressure", NUMBER, "Pa", "effective pressure from all sides, compression positive",
      AT(ElementSpec, start.value[0]), GIVEN(ElementSpec, start.given[0])),
  KEY("stress", TABLE, NULL, "or effective Cauchy stresses, tension positive; what is not named is 0",
      .table = &stress_table, AT(ElementSpec, start)),
  KEY("pore_pressure", NUMBER, "Pa", "pressure of the water", .fallback = "0", AT(ElementSpec, pore)),
  {.key = NULL},
};

static PetscErrorCode CheckStart(SchemaReader *r, const YamlNode *mapping, void *target)
{
  ElementSpec *spec = target;

  PetscFunctionBeginUser;
  (void)r;
  for (int k = 0; k < 3 && yaml_find(mapping, "pressure"); ++k)
    schema_parse_number(yaml_find(mapping, "pressure"), &spec->start.value[k]), spec->start.value[k] *= -1;
  PetscFunctionReturn(0);
}

static const SchemaGroup start_groups[] = {{GROUP_AT_MOST_ONE, {"pressure", "stress", NULL}}, {GROUP_NONE, {NULL}}};
static const SchemaTable start_table = {.name = "start",
                                        .help = "The stress that the point begins with, undeformed.",
                                        .entries = start_entries,
                                        .groups = start_groups,
                                        .check = CheckStart};

/* Nothing prescribed takes time, or is no part of a path. */
static PetscBool does_nothing(const ElementStage *s)
{
  for (int k = 0; k < 6; ++k)
    if (s->strain.given[k] || s->stress.given[k]) return PETSC_FALSE;
  return !s->test && s->seconds == 0;
}

static PetscErrorCode CheckStage(SchemaReader *r, const YamlNode *mapping, void *target)
{
  const ElementStage *s = target;
  char path[512];

  PetscFunctionBeginUser;
  yaml_path(mapping, path, sizeof path);
  for (int k = 0; k < 2 && s->test; ++k) {
    const YamlNode *other = yaml_find(mapping, k ? "stress" : "strain");
    if (other) SchemaKeyError(r, other, "%s: the test says which components are prescribed", path);
  }
  if (s->test && !s->has_to) SchemaKeyError(r, mapping, "key 'to' of %s is missing: %s", path, s->test->help);
  if (does_nothing(s)) {
    SchemaKeyError(r, mapping, "%s changes nothing: no component is prescribed", path);
    diag_hint(r->diag, "strain: {yy: -0.01}; to wait, as laws with rates can, give `seconds`");
  }
  for (int k = 0; k < 6; ++k)
    if (s->strain.given[k] && s->stress.given[k])
      SchemaKeyError(r, yaml_find(mapping, "stress"), "%s prescribes strain and stress of one component", path);
  PetscFunctionReturn(0);
}

static const SchemaEntry stage_entries[] = {
  KEY("test", MEMBER, NULL, "a test of the laboratory", .registry = (const void *const *)element_tests,
      AT(ElementStage, test)),
  KEY("to", NUMBER, NULL, "where the test goes", .with = "test", AT(ElementStage, to), GIVEN(ElementStage, has_to)),
  KEY("strain", TABLE, NULL,
      "instead of a test: changes of strain in this stage, lengthening positive; shears that are not named stay as "
      "they are",
      .table = &strain_table, AT(ElementStage, strain)),
  KEY("stress", TABLE, NULL,
      "instead of a test: total Cauchy stresses at the end, tension positive; normal stresses that are not named stay",
      .table = &stress_table, AT(ElementStage, stress)),
  KEY("relative", BOOLEAN, NULL, "`to` and stresses count from the beginning of the stage", .fallback = "false",
      AT(ElementStage, relative)),
  KEY("undrained", BOOLEAN, NULL, "the volume stays, and a pore pressure takes what that asks for", .fallback = "false",
      AT(ElementStage, undrained)),
  KEY("steps", INTEGER, NULL, "increments, each a row of the table", .fallback = "100", BETWEEN(1, 1e6),
      AT(ElementStage, steps)),
  KEY("seconds", NUMBER, "s", "time that this part takes, for laws that know of rates",
      .note = "endless, without rates", ABOVE(0), AT(ElementStage, seconds)),
  {.key = NULL},
};
static const SchemaGroup stage_groups[] = {{GROUP_AT_LEAST_ONE, {"test", "strain", "stress", NULL}},
                                           {GROUP_NONE, {NULL}}};
static const SchemaTable stage_table = {.name = "path",
                                        .help = "A part of the path.",
                                        .entries = stage_entries,
                                        .groups = stage_groups,
                                        .check = CheckStage,
                                        .size = sizeof(ElementStage)};

static const SchemaEntry element_entries[] = {
  KEY("title", TEXT, NULL, "a line for people", .fallback = "", AT(ElementSpec, title)),
  KEY("material", TABLE, NULL, "a law with its constants, as in a case", REQUIRED, .table = &material_table,
      AT(ElementSpec, own)),
  KEY("start", TABLE, NULL, "stress at the start", .table = &start_table, ALWAYS),
  KEY("path", LIST, NULL, "what the point is led through, part by part", REQUIRED, .table = &stage_table,
      AT(ElementSpec, stages), .count = offsetof(ElementSpec, n_stages)),
  {.key = NULL},
};
static const SchemaTable element_table = {.name = "element", .help = "A path.", .entries = element_entries};

/* --- reading --- */
/* Paths of a case's materials where there is one, that of the file. */
static void resolve(void *document, const char *path, DiagPlace *place)
{
  const char *prefix = "materials.";
  yaml_resolve(document, path && !strncmp(path, prefix, strlen(prefix)) ? path + strlen(prefix) : path, place);
}

static PetscErrorCode ReadFile(const ElementOptions *o, Diag *diag, ElementSpec *spec)
{
  Case c = {.n_materials = 1, .materials = &spec->own};
  char *bytes, reason[256], file[PETSC_MAX_PATH_LEN];
  const DiagPlace whole = {.file = file, .width = 1};
  size_t size = 0;

  PetscFunctionBeginUser;
  case_file_path(o->file, file); /* of a folder the case, which then is told from a path */
  PetscCall(FileReadEverywhere(PETSC_COMM_SELF, file, &size, &bytes, reason));
  if (reason[0]) diag_at(diag, DIAG_ERROR, &whole, "%s", reason);
  else PetscCall(YamlCreate(file, bytes, size, diag, &spec->document));
  PetscCall(PetscFree(bytes));
  if (!spec->document) PetscFunctionReturn(0);
  PetscCall(DiagSetResolver(diag, resolve, spec->document));
  for (PetscInt i = 0; i < o->n_set; ++i) PetscCall(YamlSet(spec->document, o->set[i], diag));
  const YamlNode *root = spec->document->root;
  if (!root || diag_errors(diag)) PetscFunctionReturn(0);
  if (root->kind != YAML_MAPPING || yaml_find(root, "bodies")) {
    yaml_error(spec->document, diag, root, PETSC_FALSE, "this is %s, and no path of a material point",
               root->kind == YAML_MAPPING ? "a case" : "no mapping of keys");
    diag_hint(diag, "of the material of a case: --test triaxial --confining 100e3 --to 0.1");
    PetscFunctionReturn(0);
  }
  SchemaReader reader = {.document = spec->document, .diag = diag, .c = &c};
  PetscCall(SchemaReadTable(&reader, &element_table, root, spec));
  spec->own.name = (char *)"material";
  if (!diag_errors(diag)) PetscCall(MaterialResolve(&c, 0, diag, &spec->material));
  PetscCall(DiagSetResolver(diag, NULL, NULL));
  PetscFunctionReturn(0);
}

/* Does a file tell its path, as no case does? Whatever is wrong with it is told by who reads it. */
static PetscErrorCode TellsPath(const char *file, PetscBool *tells)
{
  YamlDocument *document = NULL;
  char *bytes, reason[256];
  Diag *ignored;
  size_t size;

  PetscFunctionBeginUser;
  *tells = PETSC_FALSE;
  PetscCall(FileReadEverywhere(PETSC_COMM_SELF, file, &size, &bytes, reason));
  if (!reason[0]) {
    PetscCall(DiagCreate(&ignored));
    PetscCall(YamlCreate(file, bytes, size, ignored, &document));
    *tells = yaml_find(document->root, "path") && !yaml_find(document->root, "bodies") ? PETSC_TRUE : PETSC_FALSE;
    PetscCall(YamlDestroy(&document));
    PetscCall(DiagDestroy(&ignored));
  }
  PetscCall(PetscFree(bytes));
  PetscFunctionReturn(0);
}

static PetscErrorCode ChooseMaterial(const ElementOptions *o, Diag *diag, ElementSpec *spec)
{
  const Case *c = case_stage(spec->c, 0);
  const char **names;
  PetscInt chosen = -1;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(c->n_materials + 1, &names));
  for (PetscInt m = 0; m < c->n_materials; ++m) {
    names[m] = c->materials[m].name;
    if (o->material ? !strcmp(o->material, names[m]) : c->n_materials == 1) chosen = m;
  }
  if (chosen >= 0) PetscCall(ElementMaterial(c, chosen, diag, spec));
  else {
    if (o->material) diag_error(diag, NULL, "the case has no material '%s'", o->material);
    else diag_error(diag, NULL, "which of the materials of the case? --material chooses one");
    diag_hint_names(diag, o->material ? o->material : "", names);
  }
  PetscCall(PetscFree(names));
  PetscFunctionReturn(0);
}

/* One of the materials of a case, in a test. */
static PetscErrorCode ReadCase(const ElementOptions *o, Diag *diag, ElementSpec *s)
{
  char file[PETSC_MAX_PATH_LEN];
  PetscBool path;

  PetscFunctionBeginUser;
  PetscCall(ElementWords(o, diag, s));
  case_file_path(o->file, file);
  PetscCall(TellsPath(file, &path));
  if (path) {
    const DiagPlace whole = {.file = file, .width = 1};
    diag_at(diag, DIAG_ERROR, &whole, "this file tells its path by itself: --test is for the material of a case");
    diag_hint(diag, "leave --test out, and what belongs to it");
  }
  if (!diag_errors(diag)) PetscCall(CaseReadToTest(file, o->n_set, o->set, diag, &s->c));
  if (s->c) PetscCall(ChooseMaterial(o, diag, s));
  PetscFunctionReturn(0);
}

/* A mixed case may have what a point with nothing but its deformation cannot. */
static void check_bulk(const ElementSpec *spec, Diag *diag)
{
  if (diag_errors(diag) || isfinite(spec->material.elastic.bulk)) return;
  diag_error(diag, NULL, "the material %s is exactly incompressible: its pressure is no matter of its strains",
             spec->material.name);
  diag_hint(diag, "give it a volume that changes a little (poisson: 0.49), and drive it undrained");
}

/* Is it per cent? Of a logarithmic strain of 1 a third of the length is left. */
static void check_strain(const char *where, PetscReal strain, Diag *diag)
{
  if (PetscAbsReal(strain) <= 1) return;
  diag_warning(diag, NULL, "%s goes to a logarithmic strain of %g: to %.2g times the length", where, (double)strain,
               (double)PetscExpReal(strain));
  diag_hint(diag, "strains are no per cent: 5 %% is 0.05");
}

static void check_strains(const ElementSpec *spec, Diag *diag)
{
  char where[96];
  for (PetscInt i = 0; i < spec->n_stages && !diag_errors(diag); ++i) {
    const ElementStage *s = &spec->stages[i];
    const PetscBool lengthens = (PetscBool)(s->test && s->test->component < 3 && !s->test->isotropic);
    snprintf(where, sizeof where, "part %d of the path, %.60s,", (int)i + 1, s->test ? s->test->name : "strain");
    if (lengthens) check_strain(where, s->test->sign * s->to, diag);
    for (int k = 0; k < 3 && !s->test; ++k)
      if (s->strain.given[k]) check_strain(where, s->strain.value[k], diag);
  }
}

/* Of a case: which case, material and test, and what else the case says of the point. */
static PetscErrorCode NameIt(const ElementOptions *o, ElementSpec *s)
{
  char text[512], divided[48] = "", cell[48] = "";

  PetscFunctionBeginUser;
  if (s->title && s->title[0]) PetscFunctionReturn(0);
  if (s->divided > 0) snprintf(divided, sizeof divided, ", strength divided by %.6g", (double)s->divided);
  if (s->cell > 0) snprintf(cell, sizeof cell, ", in a cell of %.4g m", (double)s->cell);
  if (s->c)
    snprintf(text, sizeof text, "%s: %s, %s%s%s%s", s->c->title && s->c->title[0] ? s->c->title : o->file,
             s->material.name, o->test, o->undrained ? ", undrained" : "", divided, cell);
  else snprintf(text, sizeof text, "%s", o->file);
  PetscCall(PetscFree(s->title));
  PetscCall(PetscStrallocpy(text, &s->title));
  PetscFunctionReturn(0);
}

PetscErrorCode ElementRead(const ElementOptions *o, Diag *diag, ElementSpec **spec)
{
  ElementSpec *s;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *spec = s;
  if (o->test) PetscCall(ReadCase(o, diag, s));
  else PetscCall(ReadFile(o, diag, s));
  check_bulk(s, diag);
  check_strains(s, diag);
  if (!diag_errors(diag)) PetscCall(NameIt(o, s));
  if (diag_errors(diag)) PetscCall(ElementSpecDestroy(spec));
  PetscFunctionReturn(0);
}

PetscErrorCode ElementSpecDestroy(ElementSpec **spec)
{
  PetscFunctionBeginUser;
  if (!*spec) PetscFunctionReturn(0);
  PetscCall(SchemaClear(&element_table, *spec));
  PetscCall(YamlDestroy(&(*spec)->document));
  PetscCall(CaseDestroy(&(*spec)->c));
  PetscCall(PetscFree(*spec));
  PetscFunctionReturn(0);
}
