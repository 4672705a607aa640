#include "method/method.h"

#define METHOD(symbol) extern const Method symbol;
#include "method/methods.inc"
#undef METHOD

const Method *const methods[] = {
#define METHOD(symbol) &symbol,
#include "method/methods.inc"
#undef METHOD
  NULL};

const Method *method_find(const char *name)
{
  for (PetscInt i = 0; methods[i]; ++i)
    if (!strcmp(methods[i]->name, name)) return methods[i];
  return NULL;
}
