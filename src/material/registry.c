/* All laws, from the list in laws.inc. */
#include "material/law.h"
#include <string.h>

#define LAW(x) extern const Law law_##x;
#include "material/laws.inc"
#undef LAW

#define LAW(x) +1
enum {
  HOUSE = 0
#include "material/laws.inc"
};
#undef LAW

const Law *laws[HOUSE + LAW_MAX_LOADED + 1] = {
#define LAW(x) &law_##x,
#include "material/laws.inc"
#undef LAW
};

const Law *law_find(const char *name)
{
  for (const Law **law = laws; *law; ++law)
    if (name && !strcmp((*law)->name, name)) return *law;
  return NULL;
}

const char *law_status_text(LawStatus status)
{
  switch (status) {
  case LAW_OK: break;
  case LAW_INVERTED: return "a point was turned inside out";
  case LAW_NOT_CONVERGED: return "the law of a point did not converge";
  case LAW_NOT_FINITE: return "the stress of a point was not finite";
  }
  return NULL;
}

void law_register(const Law *law)
{
  int n = 0;
  while (laws[n]) ++n;
  if (n < HOUSE + LAW_MAX_LOADED) laws[n] = law;
}

void law_initial_state(const Law *law, PetscReal *state)
{
  for (const LawField *field = law->fields; field->name; ++field)
    for (PetscInt k = 0; k < field->components; ++k) *state++ = field->initial[k];
}
