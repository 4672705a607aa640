/* Names and their numbers: found in the time of one, however many there are. */
#pragma once
#include <petscsys.h>

typedef struct {
  PetscInt n, capacity; /* capacity: a power of two, more than n */
  struct NameSlot {
    const char *name; /* NULL: empty; else it stays the caller's */
    PetscInt number;
  } * slots;
  PetscInt64 steps; /* slots looked at so far: work that tests can count */
} Names;

/* Number of a name; -1 if it is not there. */
PetscInt names_find(Names *names, const char *name);
/* The name gets this number, also if it had another. */
PetscErrorCode NamesSet(Names *names, const char *name, PetscInt number);
PetscErrorCode NamesFree(Names *names);
