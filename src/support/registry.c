/* All bases, from the list in bases.inc. */
#include <string.h>
#include "support/basis.h"

#define BASIS(x, keys, text) extern const Basis basis_##x;
#include "support/bases.inc"
#undef BASIS

const BasisName basis_names[] = {
#define BASIS(x, keys, text) {#x, text, &basis_##x},
#include "support/bases.inc"
#undef BASIS
  {NULL, NULL, NULL},
};

const Basis *basis_find(const char *name)
{
  for (const BasisName *b = basis_names; b->name; ++b)
    if (!strcmp(b->name, name ? name : "cell")) return b->basis;
  return NULL;
}

PetscBool basis_needs_constraints(const BasisSpec *spec)
{
  return spec->essential == ESSENTIAL_CONSTRAINTS ||
         (spec->essential == ESSENTIAL_AUTO && !basis_find(spec->kind)->holds_boundary);
}
