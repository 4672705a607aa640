/* Keys of rigid walls, and of interfaces between bodies. */
#include "input/schema/keys/schema_keys.h"

/* The law of what meets, of walls and interfaces alike. */
#define CONTACT_KEYS(spec, law_words)                                                                            \
  KEY("contact", WORD, NULL, "law of the interface", .words = law_words,                                         \
      .note = "friction if `friction`, `friction_angle` or `adhesion` is given, else frictionless",              \
      AT(spec, contact)),                                                                                        \
    KEY("friction", NUMBER, NULL, "coefficient of friction, the tangent of its angle", .note = "0", AT_LEAST(0), \
        AT(spec, friction)),                                                                                     \
    KEY("friction_angle", NUMBER, "deg", "the angle instead", .bounded = PETSC_TRUE, .min = 0, .max = 90,        \
        .max_open = PETSC_TRUE, INPUT_ONLY, AT(spec, friction), GIVEN(spec, by_angle)),                          \
    KEY("adhesion", NUMBER, "N/m2",                                                                              \
        "tangential stress that contact bears beside friction; at most 20 times the pressure", .fallback = "0",  \
        AT_LEAST(0), AT(spec, adhesion))

static const SchemaWord contact_words[] = {
  {"frictionless", CONTACT_FRICTIONLESS, "material slides along the wall and leaves it freely"},
  {"friction", CONTACT_FRICTION, "Coulomb: it slides where the tangential force reaches friction times the normal one"},
  {"stick", CONTACT_STICK, "it does not slide while in contact, and leaves the wall freely"},
  {"bonded", CONTACT_BONDED, "what is in contact at the start, or as the stage that brings it begins, stays there"},
  {NULL, 0, NULL},
};

static const SchemaEntry wall_motion_entries[] = {
  KEY("displacement", TABLE, NULL, "displacement from the start, or from that of the stage that brings the wall",
      .table = &schema_components, TAG(MOTION_DISPLACEMENT)),
  KEY("velocity", TABLE, NULL, "velocity", .table = &schema_components, TAG(MOTION_VELOCITY)),
  KEY("rotation", TABLE, NULL, "rotation about a point that stays", .table = &schema_rotation, TAG(MOTION_ROTATION),
      TURNS),
  KEY("amplitude", AMPLITUDE, NULL, "factor over time: [[time, factor], ...], linear between",
      .note = "1, or time / end for a displacement in statics", AT(MotionSpec, amplitude)),
  {.key = NULL},
};
static const SchemaTable wall_motion = {.name = "motion of a wall",
                                        .help = "A translation or a rotation of what those before it have made.",
                                        .entries = wall_motion_entries,
                                        .groups = schema_one_tag,
                                        .size = sizeof(MotionSpec),
                                        .tag_offset = offsetof(MotionSpec, kind),
                                        .check = SchemaCheckWallMotion};

static const SchemaWord free_words[] = {
  {"x", 0, "along x"}, {"y", 1, "along y"}, {"z", 2, "along z"}, {"rotation", 3, "about its centre"}, {NULL, 0, NULL},
};

static const SchemaEntry mass_entries[] = {
  KEY("density", NUMBER, "kg/m3", "of the shape, filled", ABOVE(0), AT(WallMassSpec, density),
      GIVEN(WallMassSpec, has_density)),
  KEY("mass", NUMBER, "kg", "the mass instead; in plane strain of a metre of depth, in axisymmetry of the whole ring",
      ABOVE(0), AT(WallMassSpec, total), GIVEN(WallMassSpec, has_total)),
  KEY("centre", VECTOR, "m",
      "centre of mass at the start; of unions, differences and what has no volume nobody knows it",
      .note = "that of the shape", AT(WallMassSpec, centre), GIVEN(WallMassSpec, has_centre)),
  KEY("inertia", SPIN, "kg m2", "moments of inertia about the centre: one in the plane, of the three axes in space",
      .note = "those of the shape", TURNS, AT(WallMassSpec, inertia), GIVEN(WallMassSpec, has_inertia)),
  KEY("gravity", BOOLEAN, NULL, "does `loads: gravity` act on it?", .fallback = "true", AT(WallMassSpec, gravity)),
  KEY("velocity", VECTOR, "m/s", "of the centre at the start", .note = "0", AT(WallMassSpec, velocity),
      GIVEN(WallMassSpec, has_velocity)),
  KEY("spin", SPIN, "rad/s", "at the start", .note = "0", TURNS, AT(WallMassSpec, spin), GIVEN(WallMassSpec, has_spin)),
  KEY("free", FLAGS, NULL, "how it may move", .note = "all: [x, y, z, rotation], in axisymmetry [y]",
      .words = free_words, AT(WallMassSpec, free)),
  KEY("force", VECTOR, "N", "at its centre, besides gravity", .note = "0", AT(WallMassSpec, force)),
  KEY("torque", SPIN, "N m", "besides", .note = "0", TURNS, AT(WallMassSpec, torque)),
  KEY("amplitude", AMPLITUDE, NULL, "of force and torque, a factor over time",
      .note = "time / end in statics, 1 in dynamics", AT(WallMassSpec, amplitude)),
  {.key = NULL},
};
static const SchemaGroup mass_groups[] = {{GROUP_ONE, {"density", "mass", NULL}}, {GROUP_NONE, {NULL}}};
static const SchemaTable wall_mass = {.name = "mass of a wall",
                                      .help = "A wall that moves by what acts on it: contact, weight, a load.",
                                      .entries = mass_entries,
                                      .groups = mass_groups,
                                      .size = sizeof(WallMassSpec),
                                      .check = SchemaCheckWallMass};

static const SchemaEntry wall_entries[] = {
  KEY("name", NAME, NULL, "how `measures` and messages call it", REQUIRED, AT(WallSpec, name)),
  KEY("shape", TABLE, NULL, "where the wall is", .table = &schema_wall_shape, REQUIRED, AT(WallSpec, shape)),
  KEY("inside", BOOLEAN, NULL, "a container: material is inside the shape, the wall is all around it",
      .fallback = "false", AT(WallSpec, inside)),
  KEY("thickness", NUMBER, "m", "of a line, arc, disk or open surface, with round ends", .fallback = "0", AT_LEAST(0),
      AT(WallSpec, thickness)),
  KEY("motion", LIST, NULL,
      "how it moves; each entry moves what those before it have made: [rotation about its own "
      "centre, then velocity] rolls",
      .table = &wall_motion, AT(WallSpec, motions), .count = offsetof(WallSpec, n_motions)),
  KEY("mass", TABLE, NULL, "the wall moves by what acts on it, in place of `motion`", .table = &wall_mass,
      AT(WallSpec, mass), GIVEN(WallSpec, has_mass)),
  KEY("from", NUMBER, "s", "it stands only after this time, if it is not 0; a step ends there", .fallback = "0",
      AT_LEAST(0), AT(WallSpec, from)),
  KEY("until", NUMBER, "s", "and up to this one, where a step ends, too: a gate that vanishes", .note = "for ever",
      ABOVE(0), AT(WallSpec, until), GIVEN(WallSpec, has_until)),
  KEY("bodies", REFERENCES, NULL, "names of the bodies that meet it", .note = "all", .target = "bodies",
      AT(WallSpec, bodies), .count = offsetof(WallSpec, n_bodies)),
  CONTACT_KEYS(WallSpec, contact_words),
  KEY("absent", BOOLEAN, NULL,
      "of a case with stages: it is not there, until one of them says that it is; and from one on that says it is not",
      .fallback = "false", AT(WallSpec, absent), STAGED),
  {.key = NULL},
};
static const SchemaGroup wall_groups[] = {{GROUP_AT_MOST_ONE, {"friction", "friction_angle", NULL}},
                                          {GROUP_NONE, {NULL}}};
const SchemaTable schema_wall = {.name = "wall",
                                 .help = "A rigid body that material meets anywhere in the grid.",
                                 .entries = wall_entries,
                                 .groups = wall_groups,
                                 .size = sizeof(WallSpec),
                                 .check = SchemaCheckWall};

PetscErrorCode SchemaCheckWallMotion(SchemaReader *r, const YamlNode *mapping, void *target)
{
  const MotionSpec *m = target;
  const YamlNode *moves = yaml_find(mapping, m->kind == MOTION_VELOCITY ? "velocity" : "displacement");
  const YamlNode *x = yaml_find(moves, "x");
  char path[512];

  PetscFunctionBeginUser;
  PetscCall(SchemaCheckMotion(r, mapping, target));
  if (r->hoop && m->kind != MOTION_ROTATION && m->value[0] != 0)
    SchemaError(r, x, "%s: x is the radius, and a rigid ring keeps its own", yaml_path(x, path, sizeof(path)));
  PetscFunctionReturn(0);
}

static void check_contact(SchemaReader *r, const YamlNode *mapping, ContactKind *contact, PetscReal *friction,
                          PetscReal adhesion, const char *path)
{
  if (yaml_find(mapping, "friction_angle")) *friction = tan(*friction * PETSC_PI / 180);
  const PetscBool rubs = *friction > 0 || adhesion > 0;
  if (!yaml_find(mapping, "contact")) *contact = rubs ? CONTACT_FRICTION : CONTACT_FRICTIONLESS;
  else if (*contact != CONTACT_FRICTION && rubs)
    SchemaError(r, yaml_find(mapping, "contact"),
                "%s: friction and adhesion mean something with `contact: friction` alone", path);
}

/* Not given: all that there is. */
PetscErrorCode SchemaCheckWallMass(SchemaReader *r, const YamlNode *mapping, void *target)
{
  WallMassSpec *m = target;
  const YamlNode *given = yaml_find(mapping, "free");
  const PetscBool can[] = {!r->hoop, PETSC_TRUE, r->dim == 3, !r->hoop};
  char path[512];

  PetscFunctionBeginUser;
  for (int k = 0; k < 4 && r->dim; ++k) {
    if (given && m->free[k] && !can[k])
      SchemaError(r, given, "%s: '%s' is no motion that a rigid wall has in these kinematics",
                  yaml_path(given, path, sizeof path), free_words[k].word);
    if (!given) m->free[k] = can[k];
    const PetscReal start = k < 3 ? m->velocity[k] : fabs(m->spin[0]) + fabs(m->spin[1]) + fabs(m->spin[2]);
    const YamlNode *moves = yaml_find(mapping, k < 3 ? "velocity" : "spin");
    if (!m->free[k] && start != 0)
      SchemaError(r, moves, "%s: it moves at the start as it is not free to (`free`: %s)",
                  yaml_path(moves, path, sizeof path), free_words[k].word);
  }
  const YamlNode *inertia = yaml_find(mapping, "inertia");
  for (int d = r->dim == 2 ? 2 : 0; d < 3 && inertia; ++d)
    if (m->inertia[d] <= 0) SchemaError(r, inertia, "%s must be > 0", yaml_path(inertia, path, sizeof path));
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaCheckWall(SchemaReader *r, const YamlNode *mapping, void *target)
{
  WallSpec *w = target;
  const PetscBool solid = shape_is_solid(&w->shape);
  char path[512];

  PetscFunctionBeginUser;
  yaml_path(mapping, path, sizeof(path));
  if (w->inside && !solid) {
    SchemaError(r, yaml_find(mapping, "inside"), "%s.inside: the shape of this wall has no inside", path);
    diag_hint(r->diag, "a line, an arc, a disk and an open surface are thin: material may be on both of their sides");
  }
  if (w->thickness > 0 && solid)
    SchemaError(r, yaml_find(mapping, "thickness"), "%s.thickness: a shape that has an inside is as thick as it is",
                path);
  if (w->has_mass && w->n_motions)
    SchemaError(r, yaml_find(mapping, "motion"),
                "%s.motion: a wall with `mass` moves by what acts on it, and by nothing else", path);
  if (w->has_until && w->until <= w->from)
    SchemaError(r, yaml_find(mapping, "until"), "%s.until must be later than `from`, %g s", path, (double)w->from);
  check_contact(r, mapping, &w->contact, &w->friction, w->adhesion, path);
  PetscFunctionReturn(0);
}

/* --- interfaces --- */
static const SchemaWord interface_words[] = {
  {"frictionless", CONTACT_FRICTIONLESS, "the bodies slide along each other and part freely"},
  {"friction", CONTACT_FRICTION,
   "Coulomb: they slide where the tangential force reaches friction times the normal one"},
  {"stick", CONTACT_STICK, "they do not slide while in contact, and part freely"},
  {"bonded", CONTACT_BONDED, "what is in contact at the start, or as the stage that brings it begins, stays together"},
  {NULL, 0, NULL},
};

static const SchemaEntry interface_entries[] = {
  KEY("name", NAME, NULL, "how `measures` and messages call it", REQUIRED, AT(InterfaceSpec, name)),
  KEY("between", REFERENCES, NULL,
      "the names of two bodies; the surface of the first is kept out of that of the second", REQUIRED,
      .target = "bodies", AT(InterfaceSpec, between), .count = offsetof(InterfaceSpec, n_between)),
  CONTACT_KEYS(InterfaceSpec, interface_words),
  {.key = NULL},
};
const SchemaTable schema_interface = {
  .name = "interface",
  .help =
    "Two bodies that meet, each with a velocity field of its own; without an interface they stick where they "
    "share nodes.",
  .entries = interface_entries,
  .groups = wall_groups,
  .size = sizeof(InterfaceSpec),
  .check = SchemaCheckInterface};

PetscErrorCode SchemaCheckInterface(SchemaReader *r, const YamlNode *mapping, void *target)
{
  InterfaceSpec *s = target;
  const YamlNode *between = yaml_find(mapping, "between");
  char path[512];

  PetscFunctionBeginUser;
  yaml_path(mapping, path, sizeof(path));
  if (s->n_between != 2) SchemaError(r, between, "%s.between must name two bodies, not %d", path, (int)s->n_between);
  else if (!strcmp(s->between[0], s->between[1]))
    SchemaError(r, between, "%s.between: '%s' cannot meet itself", path, s->between[0]);
  check_contact(r, mapping, &s->contact, &s->friction, s->adhesion, path);
  PetscFunctionReturn(0);
}
