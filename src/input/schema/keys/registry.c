/* What the case file may name because a registry lists it: the bases of support/bases.inc. */
#include "input/schema/keys/schema_keys.h"

const SchemaEntry schema_bases[] = {
#define BASIS(x, keys, text) KEY(#x, TABLE, NULL, text, .table = &schema_keys_##keys),
#include "support/bases.inc"
#undef BASIS
  {.key = NULL},
};

const SchemaGroup schema_basis_groups[] = {
  {GROUP_AT_MOST_ONE,
   {
#define BASIS(x, keys, text) #x,
#include "support/bases.inc"
#undef BASIS
     NULL}},
  {GROUP_NONE, {NULL}},
};
