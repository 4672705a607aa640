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

enum { PRESSURE, PEAK, SHEAR };

/* Mean pressure, largest pressure, and mean of the shear traction as a vector, of what touches the wall in the shape
 * of the measure. */
static PetscErrorCode Tractions(const Model *m, const MeasureSpec *s, PetscReal values[3])
{
  PetscReal sum[5] = {0, 0, 0, 0, 0}, peak = 0; /* surface, force along the normal and across it */
  ContactTraction *t;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(ModelTractions(m, (PetscInt)(wall_of(m, s) - m->contact->wall), &n, &t));
  for (PetscInt k = 0; k < n; ++k) {
    PetscReal along = 0;
    if (s->has_in && !shape_contains(&s->in, m->dim, t[k].x, 0)) continue;
    for (int d = 0; d < 3; ++d) along += t[k].force[d] * t[k].normal[d];
    sum[0] += t[k].section, sum[1] += along;
    for (int d = 0; d < 3; ++d) sum[2 + d] += t[k].force[d] - along * t[k].normal[d];
    peak = PetscMax(peak, t[k].pressure);
  }
  PetscCall(PetscFree(t));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, sum, 5, MPIU_REAL, MPI_SUM, m->comm));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &peak, 1, MPIU_REAL, MPI_MAX, m->comm));
  const PetscReal across = PetscSqrtReal(sum[2] * sum[2] + sum[3] * sum[3] + sum[4] * sum[4]);
  values[PRESSURE] = sum[0] > 0 ? sum[1] / sum[0] : 0;
  values[PEAK] = peak;
  values[SHEAR] = sum[0] > 0 ? across / sum[0] : 0;
  PetscFunctionReturn(0);
}

/* A resumed run has the numbers before its next step, too. */
static PetscErrorCode RememberTraction(Model *m, const MeasureSpec *s, PetscReal dt, PetscReal kept[MEASURE_KEPT])
{
  PetscReal values[3];

  PetscFunctionBeginUser;
  if (!dt || !measure_number(s)->in) PetscFunctionReturn(0);
  PetscCall(Tractions(m, s, values));
  kept[0] = values[measure_number(s)->which];
  PetscFunctionReturn(0);
}

static PetscErrorCode Traction(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  (void)s;
  PetscFunctionBeginUser;
  *value = m->memory[index].kept[0];
  PetscFunctionReturn(0);
}

#define TRACTION(word, what, number) \
  WORD(word, what, .unit = "Pa", .of = OF_WALL, .value = Traction, .which = number, .in = PETSC_TRUE)

static const MeasureNumber *const words[] = {
  WORD("penetration", "how deep material is in the wall, at most", .unit = "m", .of = OF_WALL, .value = Contacts,
       .which = PENETRATION),
  WORD("sliding", "work of friction along the wall since the start", .unit = "J", .of = OF_WALL, .value = Contacts,
       .which = SLIDING),
  WORD("area", "of the surface in contact: a length in the plane", .unit = "m2", .of = OF_WALL, .value = Contacts,
       .which = AREA),
  TRACTION("pressure", "mean of the normal traction over what touches the wall (in a shape); 0 where nothing does",
           PRESSURE),
  TRACTION("peak_pressure", "the largest normal traction, of values smoothed over a cell", PEAK),
  TRACTION("shear", "the mean of the tangential traction, its size", SHEAR),
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
const Measure measure_contact = {.key = "contact",
                                 .takes = MEASURE_WORD,
                                 .number = {.help = "contact with a wall"},
                                 .words = words,
                                 .remember = RememberTraction};
