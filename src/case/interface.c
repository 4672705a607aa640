/* Which bodies share a velocity field, and which meet at an interface. */
#include <string.h>
#include "case/case.h"

static PetscBool is_named(const Case *c, const InterfaceSpec *s, int which, PetscInt body)
{
  return c->bodies[body].name && which < s->n_between && !strcmp(s->between[which], c->bodies[body].name);
}

PetscInt case_interface(const Case *c, PetscInt a, PetscInt b, PetscBool *first)
{
  for (PetscInt k = 0; k < c->n_interfaces; ++k) {
    const InterfaceSpec *s = c->interfaces + k;
    *first = is_named(c, s, 0, a);
    if (*first ? is_named(c, s, 1, b) : is_named(c, s, 0, b) && is_named(c, s, 1, a)) return k;
  }
  return -1;
}

PetscInt case_body(const Case *c, const char *name)
{
  PetscInt body = 0;
  while (strcmp(c->bodies[body].name, name)) ++body;
  return body;
}

PetscInt case_field(const Case *c, PetscInt body)
{
  PetscInt field = 0;
  PetscBool first;
  for (PetscInt other = 0; other < body; ++other) {
    if (case_interface(c, body, other, &first) < 0 || case_field(c, other) != field) continue;
    ++field;
    other = -1; /* those before may have this one */
  }
  return field;
}

PetscInt case_fields(const Case *c)
{
  PetscInt most = 0;
  for (PetscInt b = 0; b < c->n_bodies; ++b) most = PetscMax(most, case_field(c, b));
  return most + 1;
}

PetscBool case_takes_field(const Case *c, const MotionSpec *entry, PetscInt field)
{
  for (PetscInt i = 0; i < entry->n_bodies; ++i)
    if (case_field(c, case_body(c, entry->bodies[i])) == field) return PETSC_TRUE;
  return (PetscBool)!entry->n_bodies;
}
