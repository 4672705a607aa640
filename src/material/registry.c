/* All laws, from the list in laws.inc. */
#include "material/law.h"
#include <string.h>

#define LAW(x) extern const Law law_##x;
#include "material/laws.inc"
#undef LAW

const Law *const laws[] = {
#define LAW(x) &law_##x,
#include "material/laws.inc"
#undef LAW
  NULL,
};

const Law *law_find(const char *name)
{
  for (const Law *const *law = laws; *law; ++law)
    if (name && !strcmp((*law)->name, name)) return *law;
  return NULL;
}

void law_initial_state(const Law *law, PetscReal *state)
{
  for (const LawField *field = law->fields; field->name; ++field)
    for (PetscInt k = 0; k < field->components; ++k) *state++ = field->initial[k];
}
