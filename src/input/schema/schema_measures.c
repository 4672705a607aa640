/* Keys of the measures. */
#include "input/schema/schema_keys.h"

static const SchemaWord mass_words[] = {{"total", MEASURE_MASS, "of all points, or of the body given by `of`"},
                                        {NULL, 0, NULL}};
static const SchemaWord energy_words[] = {
  {"kinetic", MEASURE_KINETIC_ENERGY, "energy of motion"},
  {"elastic", MEASURE_ELASTIC_ENERGY, "stored in the material"},
  {"dissipated", MEASURE_DISSIPATED_ENERGY, "work of the stress that is not stored: plastic dissipation"},
  {"external", MEASURE_EXTERNAL_WORK, "work done by loads, gravity and prescribed motion"},
  {"damped", MEASURE_DAMPED_ENERGY, "taken by Rayleigh damping"},
  {"transfer", MEASURE_TRANSFER_ENERGY, "lost between points and grid, and at nodes that stop material"},
  {"outside", MEASURE_OUTSIDE_ENERGY,
   "gone with points that left the grid: with those removed, and in stopping those kept on its boundary"},
  {"balance", MEASURE_ENERGY_BALANCE,
   "kinetic + elastic + dissipated + damped + transfer + outside - external, less its value at the start, over the "
   "largest of "
   "these (no unit): 0 "
   "if all is accounted for; numerical damping shows here"},
  {NULL, 0, NULL},
};
static const SchemaWord surface_words[] = {
  {"front", MEASURE_SURFACE_FRONT, "farthest x at which the surface is still half a cell high, m"},
  {"height", MEASURE_SURFACE_HEIGHT, "height of the material above x = `at`, m"},
  {"slope", MEASURE_SURFACE_SLOPE,
   "angle of repose, positive if it falls towards +x, by least squares between a fifth and four fifths of the way from "
   "the highest "
   "place to the front, deg"},
  {NULL, 0, NULL},
};
static const SchemaWord outside_words[] = {
  {"removed", MEASURE_OUTSIDE_REMOVED, "points that `outside: remove` has taken out since the start, a number"},
  {"mass", MEASURE_OUTSIDE_MASS, "their mass, kg"},
  {"held", MEASURE_OUTSIDE_HELD, "points that `outside: keep-on-boundary` put back in the last step, a number"},
  {NULL, 0, NULL},
};
static const SchemaWord front_words[] = {{"points", FRONT_POINTS, "the farthest material point"},
                                         {"surface", FRONT_SURFACE, "the front of the free surface, with max: x in 2D"},
                                         {NULL, 0, NULL}};

static const SchemaWord roughness_words[] = {
  {"pressure", MEASURE_ROUGHNESS,
   "of the whole model's pressure: its root mean square distance from itself averaged over neighbours, over its own "
   "root mean square: 1 for a checkerboard, and for a smooth pressure less with every refinement"},
  {NULL, 0, NULL},
};

static const SchemaEntry of_entries[] = {
  KEY("tracer", VECTOR, "m",
      "a massless point carried by the material, out of the grid too, by its position at the start; nan from when no "
      "node of "
      "the grid carries it any more",
      AT(MeasureSpec, tracer)),
  KEY("body", REFERENCE, NULL, "a name from `bodies`", .target = "bodies", AT(MeasureSpec, body)),
  KEY("boundary", BOUNDARY, NULL, "an entry of `boundary`: its name, or its index counted from 0",
      AT(MeasureSpec, boundary)),
  {.key = NULL},
};
static const SchemaGroup of_groups[] = {{GROUP_ONE, {"tracer", "body", "boundary", NULL}}, {GROUP_NONE, {NULL}}};
static PetscBool is_tracer(const MeasureSpec *m) { return m->kind <= MEASURE_VELOCITY; }
static PetscBool hide_in_of(const SchemaEntry *e, const void *source)
{
  const MeasureSpec *m = source;
  if (e->type == TYPE_VECTOR) return !is_tracer(m);
  if (e->type == TYPE_BOUNDARY) return m->kind != MEASURE_REACTION;
  return PETSC_FALSE;
}
static const SchemaTable of = {
  .name = "of", .help = "What is measured.", .entries = of_entries, .groups = of_groups, .hide = hide_in_of};

static const SchemaEntry extent_entries[] = {
  KEY("max", AXIS, NULL, "largest coordinate along this axis", TAG(1), AT(MeasureSpec, component)),
  KEY("min", AXIS, NULL, "smallest coordinate along this axis", TAG(0), AT(MeasureSpec, component)),
  KEY("beyond", NUMBER, NULL,
      "share of the mass that may lie beyond: 0 is the farthest point, 0.01 the place within which 99 % are",
      .fallback = "0", BETWEEN(0, 1), AT(MeasureSpec, beyond)),
  {.key = NULL},
};
static const SchemaGroup extent_groups[] = {{GROUP_ONE, {"max", "min", NULL}}, {GROUP_NONE, {NULL}}};
static const SchemaTable extent = {.name = "extent",
                                   .help = "How far a body reaches.",
                                   .entries = extent_entries,
                                   .groups = extent_groups,
                                   .tag_offset = offsetof(MeasureSpec, maximum)};

static const SchemaEntry run_out_entries[] = {
  KEY("max", AXIS, NULL, "the front is the largest coordinate along this axis", TAG(1), AT(MeasureSpec, component)),
  KEY("min", AXIS, NULL, "the front is the smallest coordinate along this axis", TAG(0), AT(MeasureSpec, component)),
  KEY("speed", NUMBER, "m/s", "a front that advances more slowly has come to rest", REQUIRED, ABOVE(0),
      AT(MeasureSpec, speed)),
  KEY("front", WORD, NULL, "what is farthest", .words = front_words, .fallback = "points", AT(MeasureSpec, front)),
  {.key = NULL},
};
static const SchemaTable run_out = {
  .name = "run_out_time",
  .help = "The last time at which the front of a body advanced faster than a given speed; every step counts.",
  .entries = run_out_entries,
  .groups = extent_groups,
  .tag_offset = offsetof(MeasureSpec, maximum)};

static const SchemaEntry measure_entries[] = {
  KEY("displacement", AXIS, "m", "component of a tracer's displacement", TAG(MEASURE_DISPLACEMENT),
      AT(MeasureSpec, component)),
  KEY("position", AXIS, "m", "component of a tracer's position", TAG(MEASURE_POSITION), AT(MeasureSpec, component)),
  KEY("velocity", AXIS, "m/s", "component of a tracer's velocity", TAG(MEASURE_VELOCITY), AT(MeasureSpec, component)),
  KEY("extent", TABLE, "m", "largest or smallest coordinate of a body: {max: x}", .table = &extent,
      TAG(MEASURE_EXTENT)),
  KEY("mass", WORD, "kg", "mass", .words = mass_words, TAG(MEASURE_MASS), AT(MeasureSpec, kind)),
  KEY("momentum", AXIS, "kg m/s", "linear momentum", TAG(MEASURE_MOMENTUM), AT(MeasureSpec, component)),
  KEY("angular_momentum", SPIN_AXIS, "kg m2/s", "angular momentum about the origin", TAG(MEASURE_ANGULAR_MOMENTUM),
      AT(MeasureSpec, component)),
  KEY("spin", SPIN_AXIS, "rad/s", "angular velocity: angular momentum over inertia, both about the centre of mass",
      TAG(MEASURE_SPIN), AT(MeasureSpec, component)),
  KEY("energy", WORD, "J", "energy", .words = energy_words, AT(MeasureSpec, kind)),
  KEY("reaction", AXIS, "N",
      "force that holds a boundary; in dynamics its mean over the step, so that times the step it is the impulse",
      TAG(MEASURE_REACTION), AT(MeasureSpec, component)),
  KEY("surface", WORD, "m or deg", "free surface of a body: from the volume above x, in cells of the grid", ONLY_2D,
      .words = surface_words, AT(MeasureSpec, kind)),
  KEY("at", NUMBER, "m", "x for surface: height", .with = "surface", AT(MeasureSpec, at), GIVEN(MeasureSpec, has_at)),
  KEY("run_out_time", TABLE, "s", "when a body's front came to rest: {max: x, speed: 0.01}", .table = &run_out,
      TAG(MEASURE_RUN_OUT_TIME)),
  KEY("roughness", WORD, "", "how rough a field is", .words = roughness_words, AT(MeasureSpec, kind)),
  KEY("outside", WORD, "kg or a number", "what has left the grid (grid.outside)", .words = outside_words,
      AT(MeasureSpec, kind)),
  KEY(
    "outside_momentum", AXIS, "kg m/s",
    "momentum that went with points that left the grid: with those removed, and in stopping those kept on its boundary",
    TAG(MEASURE_OUTSIDE_MOMENTUM), AT(MeasureSpec, component)),
  KEY("of", TABLE, NULL, "which tracer, body or boundary", .table = &of),
  {.key = NULL},
};
static const SchemaGroup measure_groups[] = {
  {GROUP_ONE,
   {"displacement", "position", "velocity", "extent", "mass", "momentum", "angular_momentum", "spin", "energy",
    "reaction", "surface", "run_out_time", "roughness", "outside", "outside_momentum", NULL}},
  {GROUP_NONE, {NULL}}};
static PetscBool hide_in_measure(const SchemaEntry *e, const void *source)
{
  const MeasureSpec *m = source;
  const PetscBool energy = m->kind >= MEASURE_KINETIC_ENERGY && m->kind <= MEASURE_ENERGY_BALANCE;
  const PetscBool surface = m->kind >= MEASURE_SURFACE_FRONT && m->kind <= MEASURE_SURFACE_SLOPE;
  if (!strcmp(e->key, "energy")) return !energy;
  if (!strcmp(e->key, "surface")) return !surface;
  if (!strcmp(e->key, "roughness")) return m->kind != MEASURE_ROUGHNESS;
  if (!strcmp(e->key, "outside")) return !(m->kind >= MEASURE_OUTSIDE_REMOVED && m->kind <= MEASURE_OUTSIDE_HELD);
  if (!strcmp(e->key, "at")) return !m->has_at;
  if (!strcmp(e->key, "of")) return !(is_tracer(m) || m->body || m->kind == MEASURE_REACTION);
  return PETSC_FALSE;
}
const SchemaTable schema_measure = {.name = "measure",
                                    .help = "A number followed through the run, a column of history.csv.",
                                    .entries = measure_entries,
                                    .groups = measure_groups,
                                    .size = sizeof(MeasureSpec),
                                    .tag_offset = offsetof(MeasureSpec, kind),
                                    .check = SchemaCheckMeasure,
                                    .hide = hide_in_measure};
