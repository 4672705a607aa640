/* Keys of shapes and selectors. */
#include "input/schema/keys/schema_keys.h"

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

static const SchemaEntry cylinder_entries[] = {
  KEY("base", VECTOR, "m", "centre of one end", REQUIRED, AT(Shape, point)),
  KEY("axis", VECTOR, NULL, "from there to the other end, any length", REQUIRED, AT(Shape, normal)),
  KEY("length", NUMBER, "m", "along the axis", REQUIRED, ABOVE(0), AT(Shape, length)),
  KEY("radius", NUMBER, "m", "radius", REQUIRED, ABOVE(0), AT(Shape, radii[0])),
  {.key = NULL},
};
static const SchemaTable cylinder = {
  .name = "cylinder", .help = "A cylinder with flat ends.", .entries = cylinder_entries, .check = SchemaCheckCylinder};

static const SchemaEntry cone_entries[] = {
  KEY("base", VECTOR, "m", "centre of one end", REQUIRED, AT(Shape, point)),
  KEY("axis", VECTOR, NULL, "from there to the other end, any length", REQUIRED, AT(Shape, normal)),
  KEY("length", NUMBER, "m", "along the axis", REQUIRED, ABOVE(0), AT(Shape, length)),
  KEY("radius", NUMBER, "m", "radius at the base", REQUIRED, AT_LEAST(0), AT(Shape, radii[0])),
  KEY("end_radius", NUMBER, "m", "radius at the other end", .fallback = "0", AT_LEAST(0), AT(Shape, radii[1])),
  {.key = NULL},
};
static const SchemaTable cone = {.name = "cone",
                                 .help = "A cone, or a part of one between two flat ends.",
                                 .entries = cone_entries,
                                 .check = SchemaCheckCone};

static const SchemaEntry terrain_entries[] = {
  KEY("file", FILE, NULL,
      "heights: an ESRI ASCII grid (.asc), or a GeoTIFF in metres, which GDAL's gdal_translate reads (apt install "
      "gdal-bin)",
      REQUIRED, AT(Shape, file)),
  KEY("scale", NUMBER, NULL, "m for one unit of the file, of its coordinates and heights", .fallback = "1", ABOVE(0),
      AT(Shape, scale)),
  KEY("offset", VECTOR, "m", "where the file's origin is", .note = "0", AT(Shape, offset)),
  {.key = NULL},
};
static const SchemaTable terrain = {
  .name = "terrain",
  .help =
    "What lies below a surface of heights along z, flat between three posts. The difference of two is what lies "
    "between "
    "them: a slide on its bed. Where a post has no height (NODATA_value) there is nothing. Heights are those of the "
    "middles of the file's cells: the terrain ends there, half a cell within the corner that xllcorner and yllcorner "
    "(or a GeoTIFF) give.",
  .entries = terrain_entries,
  .check = SchemaCheckTerrain};

/* What bodies, selectors and walls may be. */
#define SOLIDS                                                                                                  \
  KEY("box", TABLE, NULL, "a box along the axes", .table = &shape_box, TAG(SHAPE_BOX)),                         \
    KEY("circle", TABLE, NULL, "a circle", .table = &ball, ONLY_2D, TAG(SHAPE_BALL)),                           \
    KEY("sphere", TABLE, NULL, "a sphere", .table = &ball, ONLY_3D, TAG(SHAPE_BALL)),                           \
    KEY("cylinder", TABLE, NULL, "a cylinder", .table = &cylinder, ONLY_3D, TAG(SHAPE_CYLINDER)),               \
    KEY("cone", TABLE, NULL, "a cone or a frustum", .table = &cone, ONLY_3D, TAG(SHAPE_CONE)),                  \
    KEY("terrain", TABLE, NULL, "what lies below a surface of heights from a file", .table = &terrain, ONLY_3D, \
        TAG(SHAPE_TERRAIN)),                                                                                    \
    KEY("polygon", POLYGON, "m", "a polygon by its corners, closed by itself", ONLY_2D, TAG(SHAPE_POLYGON),     \
        AT(Shape, vertices), .count = offsetof(Shape, n_vertices)),                                             \
    KEY("half-space", TABLE, NULL, "one side of a plane", .table = &half_space, TAG(SHAPE_HALF_SPACE)),         \
    KEY("union", LIST, NULL, "what lies in any of these shapes", .table = &schema_shape, TAG(SHAPE_UNION),      \
        AT(Shape, children), .count = offsetof(Shape, n_children)),                                             \
    KEY("difference", LIST, NULL, "the first shape without all the others", .table = &schema_shape,             \
        TAG(SHAPE_DIFFERENCE), AT(Shape, children), .count = offsetof(Shape, n_children)),                      \
    KEY("intersection", LIST, NULL, "what lies in all of these shapes", .table = &schema_shape,                 \
        TAG(SHAPE_INTERSECTION), AT(Shape, children), .count = offsetof(Shape, n_children))

static const SchemaEntry shape_entries[] = {
  SOLIDS,
  {.key = NULL},
};
const SchemaTable schema_shape = {.name = "shape",
                                  .help = "A set of positions: exactly one of these keys.",
                                  .entries = shape_entries,
                                  .groups = schema_one_tag,
                                  .size = sizeof(Shape),
                                  .tag_offset = offsetof(Shape, kind),
                                  .check = SchemaCheckShape};

/* --- shapes of walls alone --- */
static const SchemaEntry arc_entries[] = {
  KEY("centre", VECTOR, "m", "centre", REQUIRED, AT(Shape, centre)),
  KEY("radius", NUMBER, "m", "radius", REQUIRED, ABOVE(0), AT(Shape, radius)),
  KEY("from", NUMBER, "deg", "where it begins, from the x axis, counter-clockwise", REQUIRED, BETWEEN(-360, 360),
      AT(Shape, angle[0])),
  KEY("to", NUMBER, "deg", "where it ends, counter-clockwise from there", REQUIRED, BETWEEN(-360, 720),
      AT(Shape, angle[1])),
  {.key = NULL},
};
static const SchemaTable arc = {
  .name = "arc", .help = "A thin part of a circle.", .entries = arc_entries, .check = SchemaCheckArc};

static const SchemaEntry disk_entries[] = {
  KEY("centre", VECTOR, "m", "centre", REQUIRED, AT(Shape, centre)),
  KEY("normal", VECTOR, NULL, "across it, any length", REQUIRED, AT(Shape, normal)),
  KEY("radius", NUMBER, "m", "radius", REQUIRED, ABOVE(0), AT(Shape, radii[1])),
  KEY("hole", NUMBER, "m", "radius of a hole in its middle", .fallback = "0", AT_LEAST(0), AT(Shape, radii[0])),
  {.key = NULL},
};
static const SchemaTable disk = {
  .name = "disk", .help = "A thin plane disk, or a ring.", .entries = disk_entries, .check = SchemaCheckDisk};

static const SchemaEntry revolved_entries[] = {
  KEY("base", VECTOR, "m", "where height is 0, on the axis", REQUIRED, AT(Shape, point)),
  KEY("axis", VECTOR, NULL, "along which height is measured, any length", REQUIRED, AT(Shape, normal)),
  KEY("line", LINE, "m", "a thin section: [radius, height] of its corners", GIVEN(Shape, open), AT(Shape, vertices),
      .count = offsetof(Shape, n_vertices)),
  KEY("polygon", POLYGON, "m", "a closed section likewise; sides on the axis are no surface", AT(Shape, vertices),
      .count = offsetof(Shape, n_vertices)),
  {.key = NULL},
};
static const SchemaGroup revolved_groups[] = {{GROUP_ONE, {"line", "polygon", NULL}}, {GROUP_NONE, {NULL}}};
static PetscBool hide_in_revolved(const SchemaEntry *e, const void *source)
{
  return !strcmp(e->key, "polygon") && ((const Shape *)source)->open;
}
static const SchemaTable revolved = {.name = "revolved",
                                     .help = "A section turned about an axis: a tube, a funnel, a hopper.",
                                     .entries = revolved_entries,
                                     .groups = revolved_groups,
                                     .check = SchemaCheckHalfSpace,
                                     .hide = hide_in_revolved};

static const SchemaEntry surface_entries[] = {
  KEY("file", FILE, NULL, "triangles: .stl (ASCII or binary), or .msh of Gmsh", REQUIRED, AT(Shape, file)),
  KEY("group", TEXT, NULL, "physical surface of a .msh", .note = "all its surfaces", AT(Shape, group)),
  KEY("scale", NUMBER, NULL, "m for one unit of the file: 0.001 if that is mm", .fallback = "1", ABOVE(0),
      AT(Shape, scale)),
  KEY("offset", VECTOR, "m", "where the file's origin is", .note = "0", AT(Shape, offset)),
  KEY("open", BOOLEAN, NULL, "a thin wall without an inside; otherwise the surface must be closed", .fallback = "false",
      AT(Shape, open)),
  {.key = NULL},
};
static const SchemaTable surface = {
  .name = "surface",
  .help = "Triangles from a file. What they leave open (holes, slots) is open; which side is out is found out.",
  .entries = surface_entries};

static const SchemaEntry wall_shape_entries[] = {
  SOLIDS,
  KEY("line", LINE, "m", "thin, through these corners", ONLY_2D, TAG(SHAPE_LINE), AT(Shape, vertices),
      .count = offsetof(Shape, n_vertices)),
  KEY("arc", TABLE, NULL, "a thin part of a circle", .table = &arc, ONLY_2D, TAG(SHAPE_ARC)),
  KEY("disk", TABLE, NULL, "a thin plane disk or ring", .table = &disk, ONLY_3D, TAG(SHAPE_DISK)),
  KEY("revolved", TABLE, NULL, "a section turned about an axis", .table = &revolved, ONLY_3D, TAG(SHAPE_REVOLVED)),
  KEY("surface", TABLE, NULL, "triangles from a file", .table = &surface, ONLY_3D, TAG(SHAPE_SURFACE)),
  {.key = NULL},
};
const SchemaTable schema_wall_shape = {
  .name = "shape of a wall",
  .help =
    "Exactly one of these keys. Distances are exact, around corners too; at edges where shapes of a union, "
    "difference or intersection cut each other, they are those from the shapes.",
  .entries = wall_shape_entries,
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
  KEY("boundary", TEXT, NULL,
      "a boundary by name: a physical group of the mesh, or of the mesh that the body has of its own; of a box left, "
      "right, bottom, top, front (z min), back (z max)",
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
