/* What walls do to the material, and bodies to each other. */
#include <string.h>
#include "model/measure/measure.h"

static const WallState *wall_of(const Model *m, const MeasureSpec *s)
{
  PetscInt k = 0;
  if (measure_number(s)->of == OF_INTERFACE) {
    while (strcmp(m->c->interfaces[k].name, s->interface)) ++k;
    return m->contact->wall + m->c->n_walls + k;
  }
  while (strcmp(m->c->walls[k].name, s->wall)) ++k; /* the schema has found it */
  return m->contact->wall + k;
}

static PetscErrorCode Force(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  (void)index;
  PetscFunctionBeginUser;
  *value = wall_of(m, s)->mean.force[s->component];
  PetscFunctionReturn(0);
}

static PetscErrorCode Torque(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  const ContactSum *mean = &wall_of(m, s)->mean;
  const PetscInt k = m->dim == 2 ? 2 : s->component, i = (k + 1) % 3, j = (k + 2) % 3;

  (void)index;
  PetscFunctionBeginUser;
  *value = mean->torque[k];
  if (s->has_about) *value -= s->about[i] * mean->force[j] - s->about[j] * mean->force[i];
  PetscFunctionReturn(0);
}

enum { PENETRATION, SLIDING, AREA };

static PetscErrorCode Contacts(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  const WallState *wall = wall_of(m, s);
  const PetscReal values[] = {[PENETRATION] = wall->deepest, [SLIDING] = wall->friction, [AREA] = wall->area};

  (void)index;
  PetscFunctionBeginUser;
  *value = values[measure_number(s)->which];
  PetscFunctionReturn(0);
}

static const MeasureNumber *const words[] = {
  WORD("penetration", "how deep material is in the wall, at most", .unit = "m", .of = OF_WALL, .value = Contacts,
       .which = PENETRATION),
  WORD("sliding", "work of friction along the wall since the start", .unit = "J", .of = OF_WALL, .value = Contacts,
       .which = SLIDING),
  WORD("area", "of the surface in contact: a length in the plane", .unit = "m2", .of = OF_WALL, .value = Contacts,
       .which = AREA),
  NULL,
};

static const MeasureNumber *const between[] = {
  WORD("penetration", "how deep one body is in the other, at most", .unit = "m", .of = OF_INTERFACE, .value = Contacts,
       .which = PENETRATION),
  WORD("sliding", "work of friction between the bodies since the start", .unit = "J", .of = OF_INTERFACE,
       .value = Contacts, .which = SLIDING),
  WORD("area", "of the first body's surface in contact: a length in the plane", .unit = "m2", .of = OF_INTERFACE,
       .value = Contacts, .which = AREA),
  NULL,
};

const Measure measure_interface_force = {
  .key = "interface_force",
  .number = {.unit = "N",
             .help = "force of the second body of an interface on the first; in dynamics its mean over the step, so "
                     "that times the step it is the impulse",
             .of = OF_INTERFACE,
             .value = Force}};
const Measure measure_interface = {
  .key = "interface", .takes = MEASURE_WORD, .number = {.help = "contact between two bodies"}, .words = between};
const Measure measure_wall_force = {
  .key = "wall_force",
  .number = {.unit = "N",
             .help = "force of a wall on the material; in dynamics its mean over the step, so that times the step it "
                     "is the impulse",
             .of = OF_WALL,
             .value = Force}};
const Measure measure_wall_torque = {
  .key = "wall_torque",
  .takes = MEASURE_SPIN_AXIS,
  .number = {.unit = "N m",
             .help = "torque of a wall on the material about the origin, or `about` a centre; its mean like that of "
                     "the force",
             .of = OF_WALL,
             .may_about = PETSC_TRUE,
             .value = Torque}};
const Measure measure_contact = {
  .key = "contact", .takes = MEASURE_WORD, .number = {.help = "contact with a wall"}, .words = words};
