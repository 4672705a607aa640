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

PetscBool method_takes(const Method *method, const Basis *basis)
{
  if (method->couplings) return basis->nodes == BASIS_OF_CLOUD;
  return basis->nodes == BASIS_OF_CELLS || (basis->nodes == BASIS_OF_GRID && method->restores_grid);
}
