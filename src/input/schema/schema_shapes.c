/* Keys of shapes and selectors. */
#include "input/schema/schema_keys.h"

static const SchemaEntry shape_box_entries[] = {
  KEY("min", VECTOR, "m", "lower corner", REQUIRED, AT(Shape, min)),
  KEY("max", VECTOR, "m", "upper corner", REQUIRED, AT(Shape, max)),
  {.key = NULL},
};
static const SchemaTable shape_box = {
  .name = "shape box", .help = "A box along the axes.", .entries = shape_box_entries, .check = SchemaCheckShapeBox};

static const SchemaEntry ball_entries[] = {
  KEY("centre", VECTOR, "m", "centre", REQUIRED, AT(Shape, centre)),
  KEY("radius", NUMBER, "m", "radius", REQUIRED, ABOVE(0), AT(Shape, radius)),
  {.key = NULL},
};
static const SchemaTable ball = {
  .name = "circle or sphere", .help = "All positions within a radius.", .entries = ball_entries};

static const SchemaEntry half_space_entries[] = {
  KEY("point", VECTOR, "m", "a position on its surface", REQUIRED, AT(Shape, point)),
  KEY("normal", VECTOR, NULL, "points out of it, any length", REQUIRED, AT(Shape, normal)),
  {.key = NULL},
};
static const SchemaTable half_space = {.name = "half-space",
                                       .help = "Everything on one side of a plane (a line in 2D).",
                                       .entries = half_space_entries,
                                       .check = SchemaCheckHalfSpace};

static const SchemaEntry shape_entries[] = {
  KEY("box", TABLE, NULL, "a box along the axes", .table = &shape_box, TAG(SHAPE_BOX)),
  KEY("circle", TABLE, NULL, "a circle", .table = &ball, ONLY_2D, TAG(SHAPE_BALL)),
  KEY("sphere", TABLE, NULL, "a sphere", .table = &ball, ONLY_3D, TAG(SHAPE_BALL)),
  KEY("polygon", POLYGON, "m", "a polygon by its corners, closed by itself", ONLY_2D, TAG(SHAPE_POLYGON),
      AT(Shape, vertices), .count = offsetof(Shape, n_vertices)),
  KEY("half-space", TABLE, NULL, "one side of a plane", .table = &half_space, TAG(SHAPE_HALF_SPACE)),
  KEY("union", LIST, NULL, "what lies in any of these shapes", .table = &schema_shape, TAG(SHAPE_UNION),
      AT(Shape, children), .count = offsetof(Shape, n_children)),
  KEY("difference", LIST, NULL, "the first shape without all the others", .table = &schema_shape, TAG(SHAPE_DIFFERENCE),
      AT(Shape, children), .count = offsetof(Shape, n_children)),
  KEY("intersection", LIST, NULL, "what lies in all of these shapes", .table = &schema_shape, TAG(SHAPE_INTERSECTION),
      AT(Shape, children), .count = offsetof(Shape, n_children)),
  {.key = NULL},
};
const SchemaTable schema_shape = {.name = "shape",
                                  .help = "A set of positions: exactly one of these keys.",
                                  .entries = shape_entries,
                                  .groups = schema_one_tag,
                                  .size = sizeof(Shape),
                                  .tag_offset = offsetof(Shape, kind),
                                  .check = SchemaCheckShape};

/* --- selector --- */
static const SchemaEntry selector_entries[] = {
  KEY("x", INTERVAL, "m", "where x is this number, or lies between two", AT(Selector, min[0]),
      .second = offsetof(Selector, max[0]), GIVEN(Selector, has[0])),
  KEY("y", INTERVAL, "m", "the same for y", AT(Selector, min[1]), .second = offsetof(Selector, max[1]),
      GIVEN(Selector, has[1])),
  KEY("z", INTERVAL, "m", "the same for z", ONLY_3D, AT(Selector, min[2]), .second = offsetof(Selector, max[2]),
      GIVEN(Selector, has[2])),
  KEY(
    "boundary", TEXT, NULL,
    "a boundary by name: a physical group of the mesh; of a box left, right, bottom, top, front (z min), back (z max)",
    AT(Selector, boundary)),
  KEY("body", REFERENCE, NULL, "for loads: the boundary of this body, the load moves with it", .target = "bodies",
      AT(Selector, body)),
  KEY("shape", TABLE, NULL, "where the shape is", .table = &schema_shape, AT(Selector, shape),
      GIVEN(Selector, has_shape)),
  {.key = NULL},
};
const SchemaTable schema_selector = {
  .name = "selector",
  .help = "Where something acts: every condition given must hold; `on: {}` is the whole outer boundary.",
  .entries = selector_entries,
  .check = SchemaCheckSelector};
