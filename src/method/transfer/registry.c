#include <string.h>
#include "method/transfer/transfer.h"

#define TRANSFER(x) extern const Transfer transfer_##x;
#include "method/transfer/transfers.inc"
#undef TRANSFER

const Transfer *const transfers[] = {
#define TRANSFER(x) &transfer_##x,
#include "method/transfer/transfers.inc"
#undef TRANSFER
  NULL};

const Transfer *transfer_find(const char *name)
{
  for (PetscInt i = 0; transfers[i]; ++i)
    if (!name || !strcmp(transfers[i]->name, name)) return transfers[i];
  return NULL;
}
