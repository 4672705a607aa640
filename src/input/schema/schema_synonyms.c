/* What others call a key or a word, where the names differ too much to be nearest to each other. */
#include <string.h>
#include <strings.h>
#include "input/schema/schema.h"

static const struct {
  const char *word, *meant;
  const char *how; /* what else there is to it; NULL: nothing */
} synonyms[] = {
  {"E", "young", NULL},
  {"youngs_modulus", "young", NULL},
  {"elastic_modulus", "young", NULL},
  {"modulus", "young", NULL},
  {"nu", "poisson", NULL},
  {"G", "shear", NULL},
  {"K", "bulk", NULL},
  {"rho", "density", NULL},
  {"unit_weight", "density", "in kg/m3: the unit weight in N/m3 over 9.81"},
  {"phi", "friction_angle", NULL},
  {"psi", "dilatancy_angle", NULL},
  {"c", "cohesion", NULL},
  {"c_u", "cohesion", "beside `friction_angle: 0`"},
  {"cu", "cohesion", "beside `friction_angle: 0`"},
  {"su", "cohesion", "beside `friction_angle: 0`"},
  {"undrained_strength", "cohesion", "beside `friction_angle: 0`"},
  {"undrained_shear_strength", "cohesion", "beside `friction_angle: 0`"},
  {"implicit", "dynamic", "and without inertia `static`; both are implicit"},
};

/* Of what is not there. */
#define NO_WATER                                                                                      \
  "there is no water in pores: undrained soil is one of total stresses, drained soil has its weight " \
  "under buoyancy (docs/guide/limits.md)"
#define NO_PLANE_STRESS "there is no plane stress: a thin plate is a body of `3d`"
static const struct {
  const char *word, *instead;
} absent[] = {
  {"water_table", NO_WATER},
  {"water_level", NO_WATER},
  {"water", NO_WATER},
  {"groundwater", NO_WATER},
  {"pore_pressure", NO_WATER},
  {"pore_water", NO_WATER},
  {"porosity", NO_WATER},
  {"saturation", NO_WATER},
  {"permeability", NO_WATER},
  {"phreatic", NO_WATER},
  {"phreatic_line", NO_WATER},
  {"hydraulic_head", NO_WATER},
  {"plane-stress", NO_PLANE_STRESS},
  {"plane_stress", NO_PLANE_STRESS},
};

static PetscBool is_there(const char *word, PetscInt n, const char *const *words)
{
  for (PetscInt i = 0; i < n; ++i)
    if (!strcmp(word, words[i])) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* A single letter is another one than its capital: G, g. */
static PetscBool is_word(const char *word, const char *other)
{
  return (PetscBool)(word[1] ? !strcasecmp(word, other) : !strcmp(word, other));
}

/* Index of what others call one of these n words, -1: they do not. */
static int synonym_of(const char *word, PetscInt n, const char *const *words)
{
  for (int k = 0; k < (int)PETSC_STATIC_ARRAY_LENGTH(synonyms); ++k)
    if (is_word(word, synonyms[k].word) && is_there(synonyms[k].meant, n, words)) return k;
  return -1;
}

PetscBool schema_hint_synonym(SchemaReader *r, const char *word, PetscInt n, const char *const *words)
{
  const int k = synonym_of(word, n, words);
  if (k >= 0)
    diag_hint(r->diag, "it is called `%s` here%s%s", synonyms[k].meant, synonyms[k].how ? ", " : "",
              synonyms[k].how ? synonyms[k].how : "");
  for (size_t i = 0; k < 0 && i < PETSC_STATIC_ARRAY_LENGTH(absent); ++i) {
    if (strcasecmp(word, absent[i].word) != 0) continue;
    diag_hint(r->diag, "%s", absent[i].instead);
    return PETSC_TRUE;
  }
  return (PetscBool)(k >= 0);
}

/* `poisson: 0,3` within braces is a key `poisson` and a key `3` with nothing behind it. */
static PetscBool hint_point(SchemaReader *r, const YamlNode *node)
{
  const YamlNode *before = node->index ? node->parent->child[node->index - 1] : NULL;
  PetscInt whole;
  if (!yaml_is_null(node) || node->key[strspn(node->key, "0123456789")]) return PETSC_FALSE;
  if (!schema_parse_integer(before, &whole)) return PETSC_FALSE;
  diag_hint(r->diag, "decimals follow a point: %s: %s.%s", before->key, before->text, node->key);
  return PETSC_TRUE;
}

PetscBool schema_hint_key(SchemaReader *r, const YamlNode *node, PetscInt n, const char *const *words)
{
  return (PetscBool)(hint_point(r, node) || schema_hint_synonym(r, node->key, n, words));
}

const char *schema_meant(const char *word, PetscInt n, const char *const *words)
{
  const int k = synonym_of(word, n, words);
  return k >= 0 ? synonyms[k].meant : diag_nearest(word, words);
}

PetscBool schema_is_meant(const YamlNode *mapping, const char *key)
{
  for (PetscInt i = 0; i < mapping->n; ++i)
    if (mapping->child[i]->meant && !strcmp(mapping->child[i]->meant, key)) return PETSC_TRUE;
  return PETSC_FALSE;
}
