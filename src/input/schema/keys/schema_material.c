/* Materials: which keys are allowed depends on the law, and any two elastic constants are
 * accepted. */
#include <math.h>
#include <string.h>
#include "input/schema/schema.h"
#include "material/elasticity.h"

SchemaEntry schema_law_entry(const void *law_parameter)
{
  const LawParameter *p = law_parameter;
  const PetscBool bounded = p->min > -PETSC_MAX_REAL || p->max < PETSC_MAX_REAL;
  if (p->words)
    return (SchemaEntry){.key = p->name, .type = TYPE_WORD, .help = p->help, .registry = (const void *const *)p->words};
  return (SchemaEntry){.key = p->name,
                       .type = TYPE_NUMBER,
                       .unit = p->unit,
                       .help = p->help,
                       .min = p->min,
                       .max = p->max,
                       .bounded = bounded,
                       .min_open = p->min_open,
                       .max_open = p->max_open,
                       .endless = p->fallback >= 1e300,
                       .offset = offsetof(NamedValue, value),
                       .note = p->absent,
                       .required = PetscIsNanReal(p->fallback) && !p->absent};
}

static const LawParameter *find_parameter(const Law *law, const char *key)
{
  for (const LawParameter *p = law->parameters; p && p->name; ++p)
    if (!strcmp(p->name, key)) return p;
  return NULL;
}

SchemaEntry schema_elastic(PetscInt i)
{
  if (i >= ELASTIC_CONSTANTS) return (SchemaEntry){.key = NULL};
  const ElasticConstant *c = &elastic_constants[i];
  return (SchemaEntry){.key = c->name,
                       .type = TYPE_NUMBER,
                       .unit = c->unit,
                       .help = c->help,
                       .min = c->min,
                       /* included: poisson: 0.5 is for the mixed formulation to judge */
                       .max = c->max,
                       .bounded = isfinite(c->min),
                       .min_open = PETSC_TRUE,
                       .offset = offsetof(NamedValue, value)};
}

/* The number of a constant, or of its word: NAN after a mistake. */
static PetscErrorCode ReadConstant(SchemaReader *r, const SchemaEntry *entry, const YamlNode *node, PetscReal *value)
{
  int word = -1;

  PetscFunctionBeginUser;
  *value = NAN;
  if (entry->type == TYPE_WORD) {
    PetscCall(SchemaReadWord(r, entry, node, &word));
    if (word >= 0) *value = word;
  } else if (!schema_number(r, entry, node, value)) *value = NAN;
  PetscFunctionReturn(0);
}

/* `bulk: inf`: the one number that may be infinite. */
static PetscBool is_infinite(const YamlNode *node)
{
  const char *text = node->kind == YAML_SCALAR && node->plain ? node->text : "";
  return !strcmp(node->key, "bulk") && (!strcmp(text, "inf") || !strcmp(text, ".inf"));
}

static PetscBool parse_constant(const YamlNode *node, PetscReal *value)
{
  if (!is_infinite(node)) return schema_parse_number(node, value);
  *value = INFINITY;
  return PETSC_TRUE;
}

static PetscErrorCode Add(MaterialSpec *material, const char *name, PetscReal value)
{
  NamedValue *last;

  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((size_t)(material->n_parameters + 1) * sizeof(NamedValue), &material->parameters));
  last = &material->parameters[material->n_parameters++];
  PetscCall(PetscStrallocpy(name, &last->name));
  last->value = value;
  PetscFunctionReturn(0);
}

/* Without a law nobody knows which keys it has: those that every material has are told alone. */
static void unknown_key(SchemaReader *r, const Law *law, const YamlNode *mapping, YamlNode *node)
{
  const char *words[LAW_MAX_PARAMETERS + ELASTIC_CONSTANTS + 8] = {"law", "density", "amplitude"};
  char path[512];
  PetscInt n = 3;
  for (int k = 0; law && !law->elastic && k < ELASTIC_CONSTANTS; ++k) words[n++] = elastic_constants[k].name;
  for (const LawParameter *p = law ? law->parameters : NULL;
       p && p->name && n < LAW_MAX_PARAMETERS + ELASTIC_CONSTANTS + 7; ++p)
    words[n++] = p->name;
  node->meant = schema_meant(node->key, n, words);
  if (!law && !node->meant) return;
  SchemaKeyError(r, node, "key '%s' of %s is not known", node->key, yaml_path(mapping, path, sizeof(path)));
  if (!schema_hint_key(r, node, n, words)) schema_hint_words(r, node->key, n, words);
}

static PetscErrorCode ReadConstants(SchemaReader *r, const Law *law, const YamlNode *mapping, MaterialSpec *material)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < mapping->n; ++i) {
    YamlNode *node = mapping->child[i];
    const LawParameter *p = law ? find_parameter(law, node->key) : NULL;
    const int elastic = elastic_index(node->key);
    PetscReal value;
    if (!strcmp(node->key, "law") || !strcmp(node->key, "density") || !strcmp(node->key, "amplitude")) continue;
    if (p || (elastic >= 0 && !(law && law->elastic))) {
      const SchemaEntry entry = p ? schema_law_entry(p) : schema_elastic(elastic);
      if (is_infinite(node)) PetscCall(Add(material, node->key, INFINITY));
      else {
        PetscCall(ReadConstant(r, &entry, node, &value));
        if (!PetscIsNanReal(value)) PetscCall(Add(material, node->key, value));
      }
    } else unknown_key(r, law, mapping, node);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode FillParameters(SchemaReader *r, const Law *law, const YamlNode *mapping, MaterialSpec *material)
{
  char path[512], expected[300];

  PetscFunctionBeginUser;
  for (const LawParameter *p = law->parameters; p && p->name; ++p) {
    const SchemaEntry entry = schema_law_entry(p);
    if (yaml_find(mapping, p->name) || schema_is_meant(mapping, p->name)) continue;
    if (p->absent) continue;
    if (!entry.required) PetscCall(Add(material, p->name, p->fallback));
    else {
      SchemaKeyError(r, mapping, "key '%s' of %s is missing; the law %s needs it", p->name,
                     yaml_path(mapping, path, sizeof(path)), law->name);
      diag_hint(r->diag, "%s: %s (%s)", p->name, p->help, schema_expected(&entry, r->dim, expected, sizeof(expected)));
    }
  }
  PetscFunctionReturn(0);
}

static void incompressible(SchemaReader *r, const YamlNode *node)
{
  char path[512];
  SchemaError(r, node,
              "%s: %s cannot be solved for displacements alone: the material cannot change its volume, "
              "so the pressure is an unknown of its own",
              yaml_path(node, path, sizeof(path)),
              strcmp(node->key, "bulk") ? "Poisson's ratio 0.5" : "an infinite bulk modulus");
  diag_hint(r->diag, "`formulation: mixed` allows it; otherwise stay below, for example at poisson: 0.49");
}

static void check_pair(SchemaReader *r, const YamlNode *mapping, int first, int second)
{
  const char *a_name = elastic_constants[first].name, *b_name = elastic_constants[second].name;
  const YamlNode *a_node = yaml_find(mapping, a_name), *b_node = yaml_find(mapping, b_name);
  PetscReal value[ELASTIC_CONSTANTS] = {0};
  const unsigned given = 1u << first | 1u << second;
  Elasticity all;
  char path[512];
  if (!parse_constant(a_node, &value[first]) || !parse_constant(b_node, &value[second])) return;
  const YamlNode *poisson = yaml_find(mapping, "poisson"), *bulk = yaml_find(mapping, "bulk");
  const PetscBool half = poisson && value[poisson == a_node ? first : second] == 0.5;
  const PetscBool mixed = case_is_mixed(r->c);
  if (!mixed && (half || (bulk && is_infinite(bulk)))) incompressible(r, half ? poisson : bulk);
  else if (mixed && elasticity_incompressible(given, value, &all)) return;
  else if (!elasticity_from_two(given, value, &all))
    SchemaError(r, b_node, "%s: no stable elastic material has %s = %g together with %s = %g",
                yaml_path(mapping, path, sizeof(path)), a_name, (double)value[first], b_name, (double)value[second]);
}

static PetscErrorCode CheckElastic(SchemaReader *r, const YamlNode *mapping)
{
  PetscBool meant = PETSC_FALSE;
  int given[ELASTIC_CONSTANTS], n = 0;
  char path[512];

  PetscFunctionBeginUser;
  for (int k = 0; k < ELASTIC_CONSTANTS; ++k) {
    const char *name = elastic_constants[k].name;
    if (yaml_find(mapping, name)) given[n++] = k;
    else meant |= schema_is_meant(mapping, name);
  }
  if (n == 2) check_pair(r, mapping, given[0], given[1]);
  else if (n > 2)
    SchemaKeyError(r, yaml_find(mapping, elastic_constants[given[2]].name),
                   "%s has %d elastic constants; exactly two must be given", yaml_path(mapping, path, sizeof(path)), n);
  else if (!meant) {
    SchemaKeyError(r, mapping, "%s needs two elastic constants, it has %s", yaml_path(mapping, path, sizeof(path)),
                   n ? "one" : "none");
    diag_hint(r->diag, "any two of: %s", elastic_list(ELASTIC_ALL, path, sizeof(path)));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaOpenMaterial(SchemaReader *r, const YamlNode *mapping, void *target)
{
  MaterialSpec *material = target;
  const Law *law = material->law ? law_find(material->law) : NULL;

  PetscFunctionBeginUser;
  PetscCall(ReadConstants(r, law, mapping, material));
  if (!law) PetscFunctionReturn(0);
  PetscCall(FillParameters(r, law, mapping, material));
  if (!law->elastic) PetscCall(CheckElastic(r, mapping));
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaWriteMaterial(FILE *out, int indent, const Case *c, const void *source)
{
  const MaterialSpec *material = source;
  const Law *law = law_find(material->law);

  PetscFunctionBeginUser;
  (void)c;
  for (PetscInt i = 0; i < material->n_parameters; ++i) {
    const NamedValue *value = &material->parameters[i];
    const LawParameter *p = law ? find_parameter(law, value->name) : NULL;
    const int elastic = elastic_index(value->name);
    const char *unit = p ? p->unit : elastic >= 0 ? elastic_constants[elastic].unit : NULL;
    fprintf(out, "%*s%s: ", indent, "", value->name);
    if (p && p->words) fputs(p->words[(int)value->value]->word, out);
    else schema_write_real(out, value->value);
    fprintf(out, unit && unit[0] ? "  # %s\n" : "\n", unit);
  }
  PetscFunctionReturn(0);
}
