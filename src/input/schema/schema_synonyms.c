/* What others call a key, where the names differ too much to be nearest to each other. */
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
};
#define SYNONYMS ((int)(sizeof synonyms / sizeof *synonyms))

/* Of what is not there. */
static const char *const of_water[] = {"water_table",   "water_level",    "water",      "groundwater",  "pore_pressure",
                                       "pore_water",    "porosity",       "saturation", "permeability", "phreatic",
                                       "phreatic_line", "hydraulic_head", NULL};

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

PetscBool schema_hint_synonym(SchemaReader *r, const char *word, PetscInt n, const char *const *words)
{
  for (int k = 0; k < SYNONYMS; ++k) {
    if (!is_word(word, synonyms[k].word) || !is_there(synonyms[k].meant, n, words)) continue;
    diag_hint(r->diag, "it is called `%s` here%s%s", synonyms[k].meant, synonyms[k].how ? ", " : "",
              synonyms[k].how ? synonyms[k].how : "");
    return PETSC_TRUE;
  }
  for (const char *const *water = of_water; *water; ++water) {
    if (strcasecmp(word, *water) != 0) continue;
    diag_hint(r->diag,
              "there is no water in pores: undrained soil is one of total stresses, drained soil has its "
              "weight under buoyancy (docs/guide/limits.md)");
    return PETSC_TRUE;
  }
  return PETSC_FALSE;
}
