#include "formulation/formulation.h"
#include <string.h>

const Formulation *const formulations[] = {
#define FORMULATION(symbol) &symbol,
#include "formulation/formulations.inc"
#undef FORMULATION
  NULL};

const Formulation *formulation_find(const char *name)
{
  for (PetscInt i = 0; formulations[i]; ++i)
    if (!strcmp(formulations[i]->name, name)) return formulations[i];
  return NULL;
}
