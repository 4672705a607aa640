#include "base/names.h"
#include <string.h>
#include "base/hash.h"

/* The slot of the name, or the empty one that it would take. */
static struct NameSlot *names_slot(Names *names, const char *name)
{
  const uint64_t mask = (uint64_t)names->capacity - 1;
  uint64_t at = hash_text(name) & mask;
  while (++names->steps, names->slots[at].name && strcmp(names->slots[at].name, name)) at = (at + 1) & mask;
  return &names->slots[at];
}

PetscInt names_find(Names *names, const char *name)
{
  const struct NameSlot *slot = names->n ? names_slot(names, name) : NULL;
  return slot && slot->name ? slot->number : -1;
}

static PetscErrorCode Grow(Names *names)
{
  struct NameSlot *old = names->slots;
  const PetscInt n = names->capacity;

  PetscFunctionBeginUser;
  names->capacity = n ? 2 * n : 16;
  PetscCall(PetscCalloc1(names->capacity, &names->slots));
  for (PetscInt i = 0; i < n; ++i)
    if (old[i].name) *names_slot(names, old[i].name) = old[i];
  PetscCall(PetscFree(old));
  PetscFunctionReturn(0);
}

PetscErrorCode NamesSet(Names *names, const char *name, PetscInt number)
{
  PetscFunctionBeginUser;
  if (names->n >= names->capacity / 2) PetscCall(Grow(names));
  struct NameSlot *slot = names_slot(names, name);
  names->n += slot->name ? 0 : 1;
  *slot = (struct NameSlot){name, number};
  PetscFunctionReturn(0);
}

PetscErrorCode NamesFree(Names *names)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(names->slots));
  *names = (Names){0};
  PetscFunctionReturn(0);
}
