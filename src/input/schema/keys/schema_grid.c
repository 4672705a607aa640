/* Keys of the grid and of the bodies in it. */
#include "base/formula.h"
#include "input/schema/keys/schema_keys.h"

static const SchemaWord cell_words[] = {
  {"triangle", CELL_TRIANGLE, "2D"},
  {"quadrilateral", CELL_QUADRILATERAL, "2D"},
  {"tetrahedron", CELL_TETRAHEDRON, "3D"},
  {"hexahedron", CELL_HEXAHEDRON, "3D"},
  {NULL, 0, NULL},
};
static const SchemaWord diagonal_words[] = {
  {"right", DIAGONAL_RIGHT, "from bottom left to top right"},
  {"left", DIAGONAL_LEFT, "from bottom right to top left"},
  {"alternating", DIAGONAL_ALTERNATING, "right and left by turns"},
  {"crossed", DIAGONAL_CROSSED, "both, with a node in the middle"},
  {NULL, 0, NULL},
};
static const SchemaWord outside_words[] = {
  {"stop", OUTSIDE_STOP, "end the run and say which point left"},
  {"remove", OUTSIDE_REMOVE, "take the point out"},
  {"keep-on-boundary", OUTSIDE_KEEP, "hold it at the nearest position inside"},
  {NULL, 0, NULL},
};
static const SchemaWord weights_words[] = {
  {"auto", WEIGHTS_AUTO, "equal for mpm (in axisymmetry of triangles alone), gauss for fem and gmm"},
  {"equal", WEIGHTS_EQUAL, "the points of a cell share its mass equally; in axisymmetry its section"},
  {"gauss", WEIGHTS_GAUSS, "by the weights of the Gauss rule"},
  {NULL, 0, NULL},
};

static const SchemaWord fill_words[] = {
  {"auto", FILL_AUTO, "shape for mpm, cells for fem and gmm, whose nodes belong to whole cells"},
  {"cells", FILL_CELLS, "whole cells, those whose middle lies in the shape"},
  {"shape", FILL_SHAPE,
   "what of each cell lies in the shape: points have the volume and the middle of their parts (mpm)"},
  {NULL, 0, NULL},
};

/* --- grid --- */
static const SchemaEntry box_entries[] = {
  KEY("min", VECTOR, "m", "lower corner", REQUIRED, AT(GridSpec, min)),
  KEY("max", VECTOR, "m", "upper corner", REQUIRED, AT(GridSpec, max)),
  {.key = NULL},
};
static const SchemaTable box = {
  .name = "grid box", .help = "The box that the grid fills.", .entries = box_entries, .check = SchemaCheckBox};

static const SchemaEntry grading_entries[] = {
  KEY("x", NUMBER, NULL, "size of the last cell over the first along x", .fallback = "1", ABOVE(0),
      AT(GridSpec, grading[0])),
  KEY("y", NUMBER, NULL, "the same along y", .fallback = "1", ABOVE(0), AT(GridSpec, grading[1])),
  KEY("z", NUMBER, NULL, "the same along z", .fallback = "1", ONLY_3D, ABOVE(0), AT(GridSpec, grading[2])),
  {.key = NULL},
};
static const SchemaTable grading = {
  .name = "grading", .help = "How cell sizes change through the box, 1: not at all.", .entries = grading_entries};

static const SchemaEntry grid_entries[] = {
  KEY("box", TABLE, NULL, "a box filled with equal cells", .table = &box, TAG(GRID_BOX)),
  KEY("mesh", FILE, NULL,
      "a Gmsh file instead: .msh, or .geo (meshed by gmsh; one that runs programs or writes files is refused without "
      "--trust)",
      TAG(GRID_MESH), AT(GridSpec, mesh)),
  KEY("size", SIZE, "m", "cell size: one number or one for each axis; must divide the box", ABOVE(0), INPUT_ONLY,
      .with = "box"),
  KEY("counts", COUNTS, NULL, "number of cells along each axis, in place of `size`", AT_LEAST(1), .with = "box",
      AT(GridSpec, counts)),
  KEY("cell", WORD, NULL, "shape of the cells of the box", .words = cell_words,
      .note = "quadrilateral in 2D, hexahedron in 3D", .with = "box", AT(GridSpec, cell)),
  KEY("diagonal", WORD, NULL, "how triangles cut the squares of the box", .words = diagonal_words, .fallback = "right",
      .with = "box", AT(GridSpec, diagonal)),
  KEY("grading", TABLE, NULL, "cell sizes that change through the box", .table = &grading, ALWAYS, .with = "box"),
  KEY("scale", NUMBER, NULL, "m for one unit of the mesh: 0.001 if that is mm", .fallback = "1", .with = "mesh",
      ABOVE(0), AT(GridSpec, mesh_scale)),
  KEY("parameters", NUMBERS, NULL, "numbers handed to the .geo file: {name: number}", .with = "mesh",
      AT(GridSpec, parameters), .count = offsetof(GridSpec, n_parameters)),
  KEY("outside", WORD, NULL, "what happens to a material point that leaves the grid", .words = outside_words,
      .fallback = "stop", AT(GridSpec, outside)),
  {.key = NULL},
};
static const SchemaGroup grid_groups[] = {
  {GROUP_ONE, {NULL}}, {GROUP_AT_MOST_ONE, {"size", "counts", NULL}}, {GROUP_NONE, {NULL}}};
static PetscBool hide_in_grid(const SchemaEntry *e, const void *source)
{
  const GridSpec *g = source;
  if (!strcmp(e->key, "diagonal") && g->cell != CELL_TRIANGLE) return PETSC_TRUE;
  if (e->with && !strcmp(e->with, "box")) return g->kind != GRID_BOX;
  if (!strcmp(e->key, "scale")) return g->kind == GRID_BOX;
  return g->n_parameters == 0 && e->type == TYPE_NUMBERS;
}
const SchemaTable schema_grid = {.name = "grid",
                                 .help = "The background grid (mpm) or the mesh (fem).",
                                 .entries = grid_entries,
                                 .groups = grid_groups,
                                 .tag_offset = offsetof(GridSpec, kind),
                                 .check = SchemaCheckGrid,
                                 .hide = hide_in_grid};

/* --- bodies --- */
static const SchemaEntry stress_entries[] = {
  KEY("xx", TEXT, NULL, "along x; radial in axisymmetry", .note = "0", AT(BodySpec, stress[0])),
  KEY("yy", TEXT, NULL, "along y", .note = "0", AT(BodySpec, stress[1])),
  KEY("zz", TEXT, NULL, "along z: out of the plane, round the circle in axisymmetry", .note = "0",
      AT(BodySpec, stress[2])),
  KEY("xy", TEXT, NULL, "shear stress", .note = "0", AT(BodySpec, stress[3])),
  KEY("yz", TEXT, NULL, "shear stress", ONLY_3D, .note = "0", AT(BodySpec, stress[4])),
  KEY("zx", TEXT, NULL, "shear stress", ONLY_3D, .note = "0", AT(BodySpec, stress[5])),
  {.key = NULL},
};
static const SchemaTable body_stress = {
  .name = "stress of a body",
  .help =
    "Initial Cauchy stress in Pa, tension positive: formulas of x, y, z (m, where a point is), depth (m, below the "
    "surface of the highest material above it, against gravity) and weight (N/m2, of all that is above "
    "it): " FORMULA_SIGNS ".",
  .entries = stress_entries};
static const SchemaEntry body_entries[] = {
  KEY("name", NAME, NULL, "how measures, loads and pictures call it", REQUIRED, AT(BodySpec, name)),
  KEY("shape", TABLE, NULL, "where the material is at the start", .table = &schema_shape, AT(BodySpec, shape),
      GIVEN(BodySpec, has_shape)),
  KEY("region", TEXT, NULL, "a physical group of the grid's mesh", AT(BodySpec, region)),
  KEY("mesh", FILE, NULL, "a Gmsh file of its own that only places the points", AT(BodySpec, mesh)),
  KEY("scale", NUMBER, NULL, "m for one unit of `mesh`: 0.001 if that is mm", .fallback = "1", .with = "mesh", ABOVE(0),
      AT(BodySpec, mesh_scale)),
  KEY("material", REFERENCE, NULL, "a name from `materials`", .target = "materials", REQUIRED, AT(BodySpec, material)),
  KEY("points_per_cell", INTEGER, NULL, "material points in each cell, at its Gauss points",
      .note = "on a box: triangle 3, quadrilateral 4, tetrahedron 4, hexahedron 8; on a mesh it must be given",
      AT_LEAST(1), AT(BodySpec, points_per_cell)),
  KEY("weights", WORD, NULL, "how the points of a cell share its mass", .words = weights_words, .fallback = "auto",
      AT(BodySpec, weights)),
  KEY("fill", WORD, NULL, "what stands for a shape whose surface cuts cells", .words = fill_words, .fallback = "auto",
      AT(BodySpec, fill)),
  KEY("velocity", VECTOR, "m/s", "at the start", .note = "0", AT(BodySpec, velocity)),
  KEY("spin", SPIN, "rad/s", "at the start, about `spin_centre`: a number in 2D, a vector in 3D", .note = "0", TURNS,
      AT(BodySpec, spin)),
  KEY("spin_centre", VECTOR, "m", "position that does not move by the spin", .note = "the origin", TURNS,
      AT(BodySpec, spin_centre)),
  KEY(
    "k0", NUMBER, NULL,
    "initial stress: horizontal over vertical stress, the vertical one from the weight of the material that is above, "
    "of all bodies; gravity acts from the start then",
    AT_LEAST(0), AT(BodySpec, k0), GIVEN(BodySpec, has_k0)),
  KEY("stress", TABLE, NULL, "initial stress by formulas, in place of k0", .table = &body_stress,
      GIVEN(BodySpec, has_stress)),
  KEY("surface", NUMBER, "m",
      "height, against gravity, where the material above the body ends: a warning if it ends elsewhere", .with = "k0",
      AT(BodySpec, surface), GIVEN(BodySpec, has_surface)),
  KEY("absent", BOOLEAN, NULL,
      "of a case with stages: it is not there, until one of them says that it is; and from one on that says it is not",
      .fallback = "false", AT(BodySpec, absent), STAGED),
  {.key = NULL},
};
static const SchemaGroup body_groups[] = {{GROUP_AT_LEAST_ONE, {"shape", "region", "mesh", NULL}},
                                          {GROUP_AT_MOST_ONE, {"k0", "stress", NULL}},
                                          {GROUP_NONE, {NULL}}};
static PetscBool hide_in_body(const SchemaEntry *e, const void *source)
{
  const BodySpec *b = source;
  if (!strcmp(e->key, "scale")) return !b->mesh;
  return e->with && !b->has_surface;
}
const SchemaTable schema_body = {.name = "body",
                                 .help = "A piece of material.",
                                 .entries = body_entries,
                                 .groups = body_groups,
                                 .size = sizeof(BodySpec),
                                 .check = SchemaCheckBody,
                                 .hide = hide_in_body};
