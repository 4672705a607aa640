/* Any two elastic constants -> all five, by way of Lamé's two (no formula here cancels digits near
 * incompressibility). */
#include "material/elasticity.h"
#include <math.h>
#include <string.h>

const ElasticConstant elastic_constants[ELASTIC_CONSTANTS] = {
  {"young", "Pa", "Young's modulus", 0.0, INFINITY},
  {"poisson", "", "Poisson's ratio", -1.0, 0.5},
  {"bulk", "Pa", "bulk modulus", 0.0, INFINITY},
  {"shear", "Pa", "shear modulus", 0.0, INFINITY},
  {"lame", "Pa", "Lame's first constant", -INFINITY, INFINITY},
};

enum { YOUNG, POISSON, BULK, SHEAR, LAME };
#define PAIR(a, b) (1u << (a) | 1u << (b))

int elastic_index(const char *name)
{
  for (int k = 0; k < ELASTIC_CONSTANTS; ++k)
    if (!strcmp(elastic_constants[k].name, name)) return k;
  return -1;
}

const char *elastic_list(unsigned given, char *text, size_t size)
{
  text[0] = 0;
  for (int k = 0; k < ELASTIC_CONSTANTS; ++k) {
    const size_t used = strlen(text);
    if (given >> k & 1) snprintf(text + used, size - used, "%s%s", used ? ", " : "", elastic_constants[k].name);
  }
  return text;
}

typedef struct {
  PetscReal lame, shear;
} Lame;

static Lame from_young_lame(PetscReal E, PetscReal l)
{
  const PetscReal root = sqrt(E * E + 9.0 * l * l + 2.0 * E * l);
  return (Lame){l, 0.25 * (E - 3.0 * l + root)};
}

static Lame lame_from_two(unsigned given, const PetscReal *value)
{
  const PetscReal E = value[YOUNG], nu = value[POISSON], K = value[BULK], G = value[SHEAR], l = value[LAME];
  switch (given) {
  case PAIR(YOUNG, POISSON): return (Lame){E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), 0.5 * E / (1.0 + nu)};
  case PAIR(YOUNG, BULK): return (Lame){3.0 * K * (3.0 * K - E) / (9.0 * K - E), 3.0 * K * E / (9.0 * K - E)};
  case PAIR(YOUNG, SHEAR): return (Lame){G * (E - 2.0 * G) / (3.0 * G - E), G};
  case PAIR(YOUNG, LAME): return from_young_lame(E, l);
  case PAIR(POISSON, BULK): return (Lame){3.0 * K * nu / (1.0 + nu), 1.5 * K * (1.0 - 2.0 * nu) / (1.0 + nu)};
  case PAIR(POISSON, SHEAR): return (Lame){2.0 * G * nu / (1.0 - 2.0 * nu), G};
  case PAIR(POISSON, LAME): return (Lame){l, 0.5 * l * (1.0 - 2.0 * nu) / nu};
  case PAIR(BULK, SHEAR): return (Lame){K - 2.0 * G / 3.0, G};
  case PAIR(BULK, LAME): return (Lame){l, 1.5 * (K - l)};
  case PAIR(SHEAR, LAME): return (Lame){l, G};
  default: return (Lame){NAN, NAN};
  }
}

PetscBool elasticity_from_two(unsigned given, const PetscReal value[ELASTIC_CONSTANTS], Elasticity *elastic)
{
  const Lame two = lame_from_two(given, value);
  const PetscReal l = two.lame, G = two.shear;
  PetscBool stable = PETSC_TRUE;
  *elastic = (Elasticity){{.young = G * (3.0 * l + 2.0 * G) / (l + G),
                           .poisson = 0.5 * l / (l + G),
                           .bulk = l + 2.0 * G / 3.0,
                           .shear = G,
                           .lame = l}};
  for (int k = 0; k < ELASTIC_CONSTANTS; ++k) {
    if (given >> k & 1) elastic->constant[k] = value[k];
    if (!(elastic->constant[k] > elastic_constants[k].min && elastic->constant[k] < elastic_constants[k].max))
      stable = PETSC_FALSE;
  }
  return stable;
}

PetscBool elasticity_incompressible(unsigned given, const PetscReal value[ELASTIC_CONSTANTS], Elasticity *elastic)
{
  const unsigned volume = given & (1u << POISSON | 1u << BULK), shape = given & (1u << YOUNG | 1u << SHEAR);
  if (volume != 1u << POISSON && volume != 1u << BULK) return PETSC_FALSE;
  if (shape != 1u << YOUNG && shape != 1u << SHEAR) return PETSC_FALSE;
  if (volume == 1u << POISSON ? value[POISSON] != 0.5 : !(value[BULK] == INFINITY)) return PETSC_FALSE;
  const PetscReal G = shape == 1u << SHEAR ? value[SHEAR] : value[YOUNG] / 3.0;
  *elastic = (Elasticity){{shape == 1u << YOUNG ? value[YOUNG] : 3.0 * G, 0.5, INFINITY, G, INFINITY}};
  return G > 0.0 && isfinite(G);
}
