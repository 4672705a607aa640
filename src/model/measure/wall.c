/* What walls do to the material, and bodies to each other. */
#include <math.h>
#include <string.h>
#include "base/math/vector.h"
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

/* Of a wall with mass; one without any has no such motion: nan. */
static const RigidWall *rigid_of_measure(const Model *m, const MeasureSpec *s)
{
  return rigid_of(m->contact->rigid, m->contact->n_rigid, (PetscInt)(wall_of(m, s) - m->contact->wall));
}

static PetscErrorCode Position(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  const RigidWall *b = rigid_of_measure(m, s);

  (void)index;
  PetscFunctionBeginUser;
  *value = b ? b->body.centre[s->component] + b->now.moved[s->component] : NAN;
  PetscFunctionReturn(0);
}

static PetscErrorCode Velocity(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  const RigidWall *b = rigid_of_measure(m, s);

  (void)index;
  PetscFunctionBeginUser;
  *value = b ? b->now.v[s->component] : NAN;
  PetscFunctionReturn(0);
}

static PetscErrorCode Angle(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  const RigidWall *b = rigid_of_measure(m, s);

  (void)index;
  PetscFunctionBeginUser;
  *value = b ? b->now.turned[m->dim == 2 ? 2 : s->component] : NAN;
  PetscFunctionReturn(0);
}

static PetscErrorCode Spin(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  static const PetscReal nowhere[3] = {0, 0, 0};
  const RigidWall *b = rigid_of_measure(m, s);
  const PetscInt k = m->dim == 2 ? 2 : s->component;
  PetscReal arm[3] = {0, 0, 0}, v[3], still[3];

  (void)index;
  PetscFunctionBeginUser;
  *value = NAN;
  if (!b) PetscFunctionReturn(0);
  arm[(k + 1) % 3] = 1; /* which goes along the axis behind it by the spin about k */
  rigid_velocity(b, arm, v);
  rigid_velocity(b, nowhere, still);
  *value = v[(k + 2) % 3] - still[(k + 2) % 3];
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

/* What a point of a wall bears, N. How points share the force of a node is theirs alone, and that of the few in a shape
 * says little: there it is the traction of the nodes on their surface. All together have the same of both. */
static void force_of(const MeasureSpec *s, const ContactTraction *t, PetscReal *along, PetscReal across[3])
{
  *along = s->has_in ? t->pressure * t->section : vector_dot(t->force, t->normal);
  for (int d = 0; d < 3; ++d) across[d] = s->has_in ? t->shear[d] * t->section : t->force[d] - *along * t->normal[d];
}

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
    PetscReal along, across[3];
    if (s->has_in && !shape_contains(&s->in, m->dim, t[k].x, 0)) continue;
    force_of(s, t + k, &along, across);
    sum[0] += t[k].section, sum[1] += along;
    for (int d = 0; d < 3; ++d) sum[2 + d] += across[d];
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

  (void)dt;
  PetscFunctionBeginUser;
  if (!measure_number(s)->in) PetscFunctionReturn(0);
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

#define TRACTION(word, what, number)                                                                  \
  WORD(word, what, .unit = "Pa", .of = OF_WALL, .value = Traction, .which = number, .in = PETSC_TRUE, \
       .over_step = PETSC_TRUE)

static const MeasureNumber *const words[] = {
  WORD("penetration", "how deep material is in the wall, at most", .unit = "m", .of = OF_WALL, .value = Contacts,
       .which = PENETRATION),
  WORD("sliding", "work of friction along the wall since the start", .unit = "J", .of = OF_WALL, .value = Contacts,
       .which = SLIDING),
  WORD("area", "of the surface in contact: in the plane that of a metre of thickness", .unit = "m2", .of = OF_WALL,
       .value = Contacts, .which = AREA),
  TRACTION("pressure", "mean of the normal traction over what touches the wall (in a shape); 0 where nothing does",
           PRESSURE),
  TRACTION("peak_pressure", "the largest normal traction, of values smoothed over a cell", PEAK),
  TRACTION("shear", "size of the mean tangential traction: opposite directions cancel, as under what turns on its end",
           SHEAR),
  NULL,
};

static const MeasureNumber *const between[] = {
  WORD("penetration", "how deep one body is in the other, at most", .unit = "m", .of = OF_INTERFACE, .value = Contacts,
       .which = PENETRATION),
  WORD("sliding", "work of friction between the bodies since the start", .unit = "J", .of = OF_INTERFACE,
       .value = Contacts, .which = SLIDING),
  WORD("area", "of the surface in contact: in the plane that of a metre of thickness", .unit = "m2", .of = OF_INTERFACE,
       .value = Contacts, .which = AREA),
  NULL,
};

const Measure measure_interface_force = {
  .key = "interface_force",
  .number = {.unit = "N",
             .help = "force of the second body of an interface on the first; in dynamics its mean over the step, so "
                     "that times the step it is the impulse",
             .of = OF_INTERFACE,
             .over_step = PETSC_TRUE,
             .value = Force}};
const Measure measure_interface = {
  .key = "interface", .takes = MEASURE_WORD, .number = {.help = "contact between two bodies"}, .words = between};
const Measure measure_wall_force = {
  .key = "wall_force",
  .number = {.unit = "N",
             .help = "force of a wall on the material; in dynamics its mean over the step, so that times the step it "
                     "is the impulse",
             .of = OF_WALL,
             .over_step = PETSC_TRUE,
             .value = Force}};
const Measure measure_wall_torque = {
  .key = "wall_torque",
  .takes = MEASURE_SPIN_AXIS,
  .number = {.unit = "N m",
             .help = "torque of a wall on the material about the origin, or `about` a centre; its mean like that of "
                     "the force",
             .of = OF_WALL,
             .may_about = PETSC_TRUE,
             .over_step = PETSC_TRUE,
             .value = Torque}};
const Measure measure_contact = {.key = "contact",
                                 .takes = MEASURE_WORD,
                                 .number = {.help = "contact with a wall"},
                                 .words = words,
                                 .remember = RememberTraction};
const Measure measure_wall_position = {
  .key = "wall_position",
  .number = {.unit = "m", .help = "centre of mass of a wall that has `mass`", .of = OF_WALL, .value = Position}};
const Measure measure_wall_velocity = {
  .key = "wall_velocity",
  .number = {
    .unit = "m/s", .help = "velocity of the centre of a wall that has `mass`", .of = OF_WALL, .value = Velocity}};
const Measure measure_wall_angle = {
  .key = "wall_angle",
  .takes = MEASURE_SPIN_AXIS,
  .number = {.unit = "rad",
             .help = "by which a wall that has `mass` has turned since the start: in space the sum of its steps",
             .of = OF_WALL,
             .value = Angle}};
const Measure measure_wall_spin = {
  .key = "wall_spin",
  .takes = MEASURE_SPIN_AXIS,
  .number = {.unit = "rad/s", .help = "angular velocity of a wall that has `mass`", .of = OF_WALL, .value = Spin}};
