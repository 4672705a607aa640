/* Keys of what acts on the material: prescribed motion and loads. */
#include "base/formula.h"
#include "input/schema/keys/schema_keys.h"

/* --- prescribed motion --- */
static const SchemaEntry component_entries[] = {
  KEY("x", NUMBER, NULL, "along x", AT(MotionSpec, value[0]), GIVEN(MotionSpec, component[0])),
  KEY("y", NUMBER, NULL, "along y", AT(MotionSpec, value[1]), GIVEN(MotionSpec, component[1])),
  KEY("z", NUMBER, NULL, "along z", ONLY_3D, AT(MotionSpec, value[2]), GIVEN(MotionSpec, component[2])),
  {.key = NULL},
};
static const SchemaGroup component_groups[] = {{GROUP_AT_LEAST_ONE, {"x", "y", "z", NULL}}, {GROUP_NONE, {NULL}}};
const SchemaTable schema_components = {
  .name = "components",
  .help = "Prescribed components, in m (displacement) or m/s (velocity); those not named stay free, or 0 of a wall.",
  .entries = component_entries,
  .groups = component_groups};

static const SchemaEntry rotation_entries[] = {
  KEY("centre", VECTOR, "m", "position that does not move", REQUIRED, AT(MotionSpec, centre)),
  KEY("rate", NUMBER, "rad/s", "angular velocity, counter-clockwise", REQUIRED, AT(MotionSpec, rate)),
  KEY("axis", VECTOR, NULL, "axis through the centre, any length", ONLY_3D, REQUIRED, AT(MotionSpec, axis)),
  {.key = NULL},
};
const SchemaTable schema_rotation = {.name = "rotation", .help = "A rigid rotation.", .entries = rotation_entries};

static const SchemaEntry motion_entries[] = {
  KEY("name", NAME, NULL, "how `measures` may call it", AT(MotionSpec, name)),
  KEY("on", TABLE, NULL, "which nodes of the grid", .table = &schema_selector, REQUIRED, AT(MotionSpec, on)),
  KEY("fix", AXES, NULL,
      "components that do not move: [x], [x, y], ...; or [normal]: nodes slide along the boundary that they stand in, "
      "inclined or curved, and do not leave it; where two such walls meet at more than 40 degrees they keep to both",
      TAG(MOTION_FIXED), AT(MotionSpec, component)),
  KEY("displacement", TABLE, NULL,
      "prescribed displacement from the start, or from that of the stage that brings the entry",
      .table = &schema_components, TAG(MOTION_DISPLACEMENT)),
  KEY("velocity", TABLE, NULL, "prescribed velocity", .table = &schema_components, TAG(MOTION_VELOCITY)),
  KEY("rotation", TABLE, NULL, "rigid rotation about a point", .table = &schema_rotation, TAG(MOTION_ROTATION), TURNS),
  KEY("amplitude", AMPLITUDE, NULL, "factor over time: [[time, factor], ...], linear between",
      .note = "1, or time / end for a displacement in statics", AT(MotionSpec, amplitude)),
  KEY("moves", BOOLEAN, NULL,
      "on a grid that is restored every step (mpm): does the place `on` take part in the motion, so that it is a rigid "
      "body that goes through the grid? Let it reach a cell into the material, so that it holds the nodes of the cells "
      "that its surface cuts. Else the place stays, and material flows away from it. With fem the nodes chosen at the "
      "start move in any case",
      .fallback = "false", AT(MotionSpec, moves)),
  KEY(
    "bodies", REFERENCES, NULL,
    "the bodies whose nodes it holds or moves; others have their own there, as far as an interface parts them: a base "
    "that is held up to its top face would hold what slides on it, too",
    .note = "all", .target = "bodies", AT(MotionSpec, bodies), .count = offsetof(MotionSpec, n_bodies)),
  KEY("absent", BOOLEAN, NULL,
      "of a case with stages: it is not there, until one of them says that it is; and from one on that says it is not",
      .fallback = "false", AT(MotionSpec, absent), STAGED),
  {.key = NULL},
};
const SchemaTable schema_motion = {.name = "boundary",
                                   .help = "Nodes whose motion is prescribed.",
                                   .entries = motion_entries,
                                   .groups = schema_one_tag,
                                   .size = sizeof(MotionSpec),
                                   .tag_offset = offsetof(MotionSpec, kind),
                                   .check = SchemaCheckMotion};

/* --- loads --- */
#define FACTOR_HELP                                                                                                  \
  "factor over places and time: a formula of x, y, z (m, where the material is when a step begins), X, Y, Z (where " \
  "it "                                                                                                              \
  "was undeformed) and t (s): " FORMULA_SIGNS ", such as max(0, 5 - y)"

static const SchemaEntry traction_entries[] = {
  KEY("name", NAME, NULL, "how `analysis.limit` may call it", AT(LoadSpec, name)),
  KEY(
    "on", TABLE, NULL,
    "a boundary of the grid, or of a body: of its shape where that is filled, of its own mesh if it has one, and else "
    "of its cells (then the load moves with it)",
    .table = &schema_selector, REQUIRED, AT(LoadSpec, on)),
  KEY("value", VECTOR, "N/m2", "force per undeformed boundary; it goes all round in axisymmetry", REQUIRED,
      AT(LoadSpec, value)),
  KEY("amplitude", AMPLITUDE, NULL, "factor over time", .note = "time / end in statics, 1 in dynamics",
      AT(LoadSpec, amplitude)),
  KEY("factor", TEXT, NULL, FACTOR_HELP, .note = "1", AT(LoadSpec, factor)),
  {.key = NULL},
};
static const SchemaTable traction = {.name = "traction",
                                     .help = "A load spread over a boundary.",
                                     .entries = traction_entries,
                                     .size = sizeof(LoadSpec),
                                     .tag_offset = offsetof(LoadSpec, kind),
                                     .check = SchemaCheckLoad};
static const SchemaEntry pressure_entries[] = {
  KEY("name", NAME, NULL, "how `analysis.limit` may call it", AT(LoadSpec, name)),
  KEY(
    "on", TABLE, NULL,
    "a boundary of the grid, or of a body, at the start that of its shape where that is filled, of its own mesh if it "
    "has one, and else of its cells; it moves with it",
    .table = &schema_selector, REQUIRED, AT(LoadSpec, on)),
  KEY("value", NUMBER, "N/m2",
      "force per present boundary, along its present normal: pushes into the material if positive", REQUIRED,
      AT(LoadSpec, value[0])),
  KEY("amplitude", AMPLITUDE, NULL, "factor over time", .note = "time / end in statics, 1 in dynamics",
      AT(LoadSpec, amplitude)),
  KEY("factor", TEXT, NULL, FACTOR_HELP, .note = "1", AT(LoadSpec, factor)),
  {.key = NULL},
};
static const SchemaTable pressure = {.name = "pressure",
                                     .help = "A pressure that turns and grows with the surface that it acts on.",
                                     .entries = pressure_entries,
                                     .size = sizeof(LoadSpec),
                                     .tag_offset = offsetof(LoadSpec, kind),
                                     .check = SchemaCheckLoad};
static const SchemaEntry point_load_entries[] = {
  KEY("name", NAME, NULL, "how `analysis.limit` may call it", AT(LoadSpec, name)),
  KEY("at", VECTOR, "m", "the piece of material that carries it, by its position at the start", REQUIRED,
      AT(LoadSpec, at)),
  KEY("force", VECTOR, "N", "the force; in axisymmetry that of the whole circle", REQUIRED, AT(LoadSpec, value)),
  KEY("amplitude", AMPLITUDE, NULL, "factor over time", .note = "time / end in statics, 1 in dynamics",
      AT(LoadSpec, amplitude)),
  KEY("factor", TEXT, NULL, FACTOR_HELP, .note = "1", AT(LoadSpec, factor)),
  {.key = NULL},
};
static const SchemaTable point_load = {.name = "point load",
                                       .help = "A force on a piece of material.",
                                       .entries = point_load_entries,
                                       .size = sizeof(LoadSpec),
                                       .tag_offset = offsetof(LoadSpec, kind),
                                       .check = SchemaCheckLoad};
static const SchemaEntry loads_entries[] = {
  KEY("gravity", VECTOR, "m/s2", "acceleration of gravity", .note = "0", AT(Case, gravity)),
  KEY("gravity_amplitude", AMPLITUDE, NULL, "factor over time", .note = "time / end in statics without k0, else 1",
      AT(Case, gravity_amplitude)),
  KEY("tractions", LIST, NULL, "loads spread over boundaries", .table = &traction, AT(Case, loads),
      .count = offsetof(Case, n_loads), ITEMS(LOAD_TRACTION)),
  KEY("pressures", LIST, NULL, "pressures that follow the surface", .table = &pressure, AT(Case, loads),
      .count = offsetof(Case, n_loads), ITEMS(LOAD_PRESSURE)),
  KEY("points", LIST, NULL, "point forces", .table = &point_load, AT(Case, loads), .count = offsetof(Case, n_loads),
      ITEMS(LOAD_POINT)),
  {.key = NULL},
};
const SchemaTable schema_loads = {
  .name = "loads", .help = "What acts on the material.", .entries = loads_entries, .check = SchemaCheckLoads};
