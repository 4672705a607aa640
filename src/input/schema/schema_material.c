/* Materials: which keys are allowed depends on the law, and any two elastic constants are accepted. */
#include <math.h>
#include <string.h>
#include "input/schema/schema.h"
#include "material/elasticity.h"

SchemaEntry SchemaLawEntry(const void *law_parameter)
{
  const LawParameter *p = law_parameter;
  const PetscBool bounded = p->min > -PETSC_MAX_REAL || p->max < PETSC_MAX_REAL;
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
                       .required = PetscIsNanReal(p->fallback)};
}

static const LawParameter *FindParameter(const Law *law, const char *key)
{
  for (const LawParameter *p = law->parameters; p && p->name; ++p)
    if (!strcmp(p->name, key)) return p;
  return NULL;
}

static const SchemaEntry *FindElastic(const char *key)
{
  for (const SchemaEntry *e = schema_elastic; e->key; ++e)
    if (!strcmp(e->key, key)) return e;
  return NULL;
}

/* `bulk: inf`: the one number that may be infinite. */
static PetscBool IsInfinite(const YamlNode *node)
{
  const char *text = node->kind == YAML_SCALAR && node->plain ? node->text : "";
  return !strcmp(node->key, "bulk") && (!strcmp(text, "inf") || !strcmp(text, ".inf"));
}

static PetscBool ParseConstant(const YamlNode *node, PetscReal *value)
{
  if (!IsInfinite(node)) return SchemaParseNumber(node, value);
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

static void UnknownKey(SchemaReader *r, const Law *law, const YamlNode *mapping, const YamlNode *node)
{
  const char *words[LAW_MAX_PARAMETERS + ELASTIC_CONSTANTS + 8] = {"law", "density"};
  char path[512];
  PetscInt n = 2;
  for (const SchemaEntry *e = schema_elastic; e->key; ++e) words[n++] = e->key;
  for (const LawParameter *p = law ? law->parameters : NULL;
       p && p->name && n < LAW_MAX_PARAMETERS + ELASTIC_CONSTANTS + 7; ++p)
    words[n++] = p->name;
  SchemaKeyError(r, node, "key '%s' of %s is not known", node->key, YamlPath(mapping, path, sizeof(path)));
  SchemaHintWords(r, node->key, n, words);
}

static PetscErrorCode ReadConstants(SchemaReader *r, const Law *law, const YamlNode *mapping, MaterialSpec *material)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < mapping->n; ++i) {
    const YamlNode *node = mapping->child[i];
    const LawParameter *p = law ? FindParameter(law, node->key) : NULL;
    const SchemaEntry *elastic = FindElastic(node->key);
    PetscReal value;
    if (!strcmp(node->key, "law") || !strcmp(node->key, "density")) continue;
    if (p || elastic) {
      const SchemaEntry entry = p ? SchemaLawEntry(p) : *elastic;
      if (IsInfinite(node)) PetscCall(Add(material, node->key, INFINITY));
      else if (SchemaNumber(r, &entry, node, &value)) PetscCall(Add(material, node->key, value));
    } else if (law) UnknownKey(r, law, mapping, node); /* without a law nobody knows which keys it has */
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode FillParameters(SchemaReader *r, const Law *law, const YamlNode *mapping, MaterialSpec *material)
{
  char path[512], expected[300];

  PetscFunctionBeginUser;
  for (const LawParameter *p = law->parameters; p && p->name; ++p) {
    const SchemaEntry entry = SchemaLawEntry(p);
    if (YamlFind(mapping, p->name)) continue;
    if (!entry.required) PetscCall(Add(material, p->name, p->fallback));
    else {
      SchemaKeyError(r, mapping, "key '%s' of %s is missing; the law %s needs it", p->name,
                     YamlPath(mapping, path, sizeof(path)), law->name);
      DiagHint(r->diag, "%s: %s (%s)", p->name, p->help, SchemaExpected(&entry, r->dim, expected, sizeof(expected)));
    }
  }
  PetscFunctionReturn(0);
}

static void Incompressible(SchemaReader *r, const YamlNode *node)
{
  char path[512];
  SchemaError(r, node,
              "%s: %s cannot be solved for displacements alone: the material cannot change its volume, "
              "so the pressure is an unknown of its own",
              YamlPath(node, path, sizeof(path)),
              strcmp(node->key, "bulk") ? "Poisson's ratio 0.5" : "an infinite bulk modulus");
  DiagHint(r->diag, "`formulation: mixed` allows it; otherwise stay below, for example at poisson: 0.49");
}

static void CheckPair(SchemaReader *r, const YamlNode *mapping, int first, int second)
{
  const char *a_name = schema_elastic[first].key, *b_name = schema_elastic[second].key;
  const YamlNode *a_node = YamlFind(mapping, a_name), *b_node = YamlFind(mapping, b_name);
  PetscReal value[ELASTIC_CONSTANTS] = {0};
  const unsigned given = 1u << first | 1u << second;
  Elasticity all;
  char path[512];
  if (!ParseConstant(a_node, &value[first]) || !ParseConstant(b_node, &value[second])) return;
  const YamlNode *poisson = YamlFind(mapping, "poisson"), *bulk = YamlFind(mapping, "bulk");
  const PetscBool half = poisson && value[poisson == a_node ? first : second] == 0.5;
  const PetscBool mixed = case_is_mixed(r->c);
  if (!mixed && (half || (bulk && IsInfinite(bulk)))) Incompressible(r, half ? poisson : bulk);
  else if (mixed && elasticity_incompressible(given, value, &all)) return;
  else if (!elasticity_from_two(given, value, &all))
    SchemaError(r, b_node, "%s: no stable elastic material has %s = %g together with %s = %g",
                YamlPath(mapping, path, sizeof(path)), a_name, (double)value[first], b_name, (double)value[second]);
}

static PetscErrorCode CheckElastic(SchemaReader *r, const YamlNode *mapping)
{
  int given[ELASTIC_CONSTANTS], n = 0;
  char path[512];

  PetscFunctionBeginUser;
  for (int k = 0; schema_elastic[k].key; ++k)
    if (YamlFind(mapping, schema_elastic[k].key)) given[n++] = k;
  if (n == 2) CheckPair(r, mapping, given[0], given[1]);
  else if (n > 2)
    SchemaKeyError(r, YamlFind(mapping, schema_elastic[given[2]].key),
                   "%s has %d elastic constants; exactly two must be given", YamlPath(mapping, path, sizeof(path)), n);
  else {
    SchemaKeyError(r, mapping, "%s needs two elastic constants, it has %s", YamlPath(mapping, path, sizeof(path)),
                   n ? "one" : "none");
    DiagHint(r->diag, "any two of: young [Pa], poisson, bulk [Pa], shear [Pa], lame [Pa]");
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaOpenMaterial(SchemaReader *r, const YamlNode *mapping, void *target)
{
  MaterialSpec *material = target;
  const Law *law = material->law ? LawFind(material->law) : NULL;

  PetscFunctionBeginUser;
  PetscCall(ReadConstants(r, law, mapping, material));
  if (!law) PetscFunctionReturn(0);
  PetscCall(FillParameters(r, law, mapping, material));
  PetscCall(CheckElastic(r, mapping));
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaWriteMaterial(FILE *out, int indent, const Case *c, const void *source)
{
  const MaterialSpec *material = source;
  const Law *law = LawFind(material->law);

  PetscFunctionBeginUser;
  (void)c;
  for (PetscInt i = 0; i < material->n_parameters; ++i) {
    const NamedValue *value = &material->parameters[i];
    const LawParameter *p = law ? FindParameter(law, value->name) : NULL;
    const SchemaEntry *elastic = FindElastic(value->name);
    const char *unit = p ? p->unit : elastic ? elastic->unit : NULL;
    fprintf(out, "%*s%s: ", indent, "", value->name);
    SchemaWriteReal(out, value->value);
    fprintf(out, unit && unit[0] ? "  # %s\n" : "\n", unit);
  }
  PetscFunctionReturn(0);
}
