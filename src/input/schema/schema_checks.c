/* What a single key cannot know: defaults that depend on others, and keys that must fit
 * together. */
#include <math.h>
#include <string.h>
#include "basis/cell.h"
#include "case/terrain/relief.h"
#include "base/formula.h"
#include "input/schema/schema.h"

/* --- analysis --- */
static void resolve_steps(SchemaReader *r, const YamlNode *mapping, AnalysisSpec *a)
{
  const PetscBool is_static = case_is_static(a);
  const YamlNode *steps = yaml_find(mapping, "steps"), *step = yaml_find(mapping, "step");
  PetscInt n = 1;
  if (!yaml_find(mapping, "end")) {
    if (!is_static)
      SchemaKeyError(r, mapping, "key 'end' of analysis is missing: a dynamic analysis needs its end, in s");
    a->end = 1;
  }
  if (steps) schema_parse_integer(steps, &n);
  if (!steps && !step && !is_static)
    SchemaKeyError(r, mapping,
                   "key 'step' of analysis is missing: a dynamic analysis needs its time step, in s (or `steps`)");
  a->step = step ? a->step : a->end / (PetscReal)n;
  if (step && a->step > a->end)
    SchemaError(r, step, "analysis.step is larger than analysis.end (%g s)", (double)a->end);
}

static void resolve_bounds(SchemaReader *r, const YamlNode *mapping, AnalysisSpec *a)
{
  const YamlNode *smallest = yaml_find(mapping, "smallest"), *largest = yaml_find(mapping, "largest");
  if (!smallest) a->smallest = a->step / 1024;
  if (!largest) a->largest = a->step;
  if (smallest && a->smallest > a->step)
    SchemaError(r, smallest, "analysis.smallest is larger than the step (%g s)", (double)a->step);
  if (largest && a->largest < a->step)
    SchemaError(r, largest, "analysis.largest is smaller than the step (%g s)", (double)a->step);
}

static void resolve_newmark(const YamlNode *mapping, AnalysisSpec *a)
{
  const YamlNode *beta = yaml_find(mapping, "beta"), *gamma = yaml_find(mapping, "gamma");
  if (!beta) a->beta = analysis_usual_beta(a);
  if (!gamma) a->gamma = analysis_usual_gamma(a);
}

PetscErrorCode SchemaCheckReduction(SchemaReader *r, const YamlNode *mapping, void *target)
{
  const ReductionSpec *s = target;
  const YamlNode *most = mapping ? yaml_find(mapping, "most") : NULL;

  PetscFunctionBeginUser;
  if (s->most <= s->from)
    SchemaError(r, most ? most : mapping, "analysis.reduction.most must be larger than the first factor (%g), not %g",
                (double)s->from, (double)s->most);
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaCheckAnalysis(SchemaReader *r, const YamlNode *mapping, void *target)
{
  const AnalysisSpec *a = target;
  const YamlNode *reduction = yaml_find(mapping, "reduction"), *limit = yaml_find(mapping, "limit");

  PetscFunctionBeginUser;
  if (reduction && a->type != ANALYSIS_FACTOR)
    SchemaKeyError(r, reduction, "analysis.reduction belongs to `type: factor-of-safety`");
  if (limit && a->type != ANALYSIS_LIMIT) SchemaKeyError(r, limit, "analysis.limit belongs to `type: limit-load`");
  if (!limit && a->type == ANALYSIS_LIMIT)
    SchemaKeyError(r, mapping, "key 'limit' of analysis is missing: what is to be raised? limit: {raise: ...}");
  resolve_steps(r, mapping, target);
  resolve_bounds(r, mapping, target);
  resolve_newmark(mapping, target);
  ((AnalysisSpec *)target)->courant = case_courant(a);
  PetscFunctionReturn(0);
}

/* --- boxes --- */
static void check_corners(SchemaReader *r, const YamlNode *mapping, const PetscReal *min, const PetscReal *max)
{
  char path[512];
  for (PetscInt d = 0; d < r->dim; ++d)
    if (!(max[d] > min[d]))
      SchemaError(r, yaml_find(mapping, "max"), "%s: max must be larger than min, along %c %g is not larger than %g",
                  yaml_path(mapping, path, sizeof(path)), "xyz"[d], (double)max[d], (double)min[d]);
}

PetscErrorCode SchemaCheckBox(SchemaReader *r, const YamlNode *mapping, void *target)
{
  const GridSpec *grid = target;
  const YamlNode *min = yaml_find(mapping, "min");

  PetscFunctionBeginUser;
  check_corners(r, mapping, grid->min, grid->max);
  if (r->hoop && grid->min[0] < 0) {
    SchemaError(r, min->n ? min->child[0] : min, "grid.box.min: x is the radius, it cannot begin at %g",
                (double)grid->min[0]);
    diag_hint(r->diag, "the axis is at x = 0: a body that reaches it begins there");
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaCheckShapeBox(SchemaReader *r, const YamlNode *mapping, void *target)
{
  const Shape *shape = target;

  PetscFunctionBeginUser;
  check_corners(r, mapping, shape->min, shape->max);
  PetscFunctionReturn(0);
}

/* --- grid --- */
static void count_cells(SchemaReader *r, const YamlNode *size, PetscInt d, PetscReal length, PetscReal h,
                        PetscInt *count)
{
  const PetscReal exact = length / h, n = PetscMax(1, floor(exact + 0.5));
  *count = 1;
  if (exact > 1e9) {
    SchemaError(r, size, "grid.size %g makes more than 1e9 cells along %c", (double)h, "xyz"[d]);
    return;
  }
  *count = (PetscInt)n;
  if (fabs(n * h - length) <= 1e-6 * length) return;
  SchemaError(r, size, "grid.size %g does not divide the box along %c, which is %g m long", (double)h, "xyz"[d],
              (double)length);
  if (exact < 1) diag_hint(r->diag, "the largest cell possible is %.10g", (double)length);
  else
    diag_hint(r->diag, "near it are %.10g (%.0f cells) and %.10g (%.0f cells)", (double)(length / floor(exact)),
              floor(exact), (double)(length / ceil(exact)), ceil(exact));
}

static void resolve_counts(SchemaReader *r, const YamlNode *mapping, GridSpec *g)
{
  const YamlNode *size = yaml_find(mapping, "size");
  PetscReal h[3] = {1, 1, 1}, one;
  if (size && schema_parse_number(size, &one)) h[0] = h[1] = h[2] = one;
  else if (size) schema_parse_vector(size, h);
  for (PetscInt d = 0; size && d < PetscMin(r->dim, 3); ++d)
    count_cells(r, size, d, g->max[d] - g->min[d], h[d], &g->counts[d]);
}

static void resolve_cell(SchemaReader *r, const YamlNode *mapping, GridSpec *g)
{
  const YamlNode *cell = yaml_find(mapping, "cell"), *diagonal = yaml_find(mapping, "diagonal");
  if (!cell) g->cell = r->dim == 3 ? CELL_HEXAHEDRON : CELL_QUADRILATERAL;
  else if (cells[g->cell].dim != r->dim) {
    SchemaError(r, cell, "grid.cell: a %s has %d dimensions, this case has %d", cells[g->cell].name,
                (int)cells[g->cell].dim, (int)r->dim);
    diag_hint(r->diag, r->dim == 3 ? "use hexahedron or tetrahedron" : "use quadrilateral or triangle");
  } else if (diagonal && g->cell != CELL_TRIANGLE)
    SchemaKeyError(r, diagonal, "key 'diagonal' of grid belongs to cell: triangle");
}

PetscErrorCode SchemaCheckGrid(SchemaReader *r, const YamlNode *mapping, void *target)
{
  GridSpec *g = target;
  const PetscInt before = diag_errors(r->diag);

  PetscFunctionBeginUser;
  if (r->dim == 0) PetscFunctionReturn(0);
  for (PetscInt d = r->dim; d < 3; ++d) {
    g->counts[d] = 1;
    g->grading[d] = 1;
  }
  resolve_cell(r, mapping, g);
  r->has_grid = diag_errors(r->diag) == before;
  if (g->kind == GRID_MESH) PetscFunctionReturn(0);
  if (!yaml_find(mapping, "size") && !yaml_find(mapping, "counts")) {
    SchemaKeyError(r, mapping, "key 'size' of grid is missing: cell size in m (or `counts`: cells along each axis)");
    PetscFunctionReturn(0);
  }
  resolve_counts(r, mapping, g);
  PetscReal total = 1;
  for (PetscInt d = 0; d < r->dim; ++d) total *= (PetscReal)g->counts[d];
  if (total > (PetscReal)PETSC_MAX_INT / 8)
    SchemaKeyError(r, mapping, "grid has %g cells, more than this build can number", (double)total);
  PetscFunctionReturn(0);
}

/* --- shapes --- */
static PetscReal polygon_area(const Shape *s)
{
  PetscReal area = 0;
  for (PetscInt i = 0, j = s->n_vertices - 1; i < s->n_vertices; j = i++)
    area += 0.5 * (s->vertices[2 * j] * s->vertices[2 * i + 1] - s->vertices[2 * i] * s->vertices[2 * j + 1]);
  return fabs(area);
}

/* The list of corners of what is closed, also of a line whose last corner is its first one; NULL:
 * there is none. */
static const YamlNode *closed_corners(const YamlNode *mapping, const Shape *s)
{
  if (s->kind == SHAPE_POLYGON) return yaml_find(mapping, "polygon");
  if (s->kind == SHAPE_REVOLVED && !s->open) return yaml_find(yaml_find(mapping, "revolved"), "polygon");
  if (s->kind != SHAPE_LINE) return NULL;
  const PetscReal *first = s->vertices, *last = s->vertices + 2 * (s->n_vertices - 1);
  return first[0] == last[0] && first[1] == last[1] ? yaml_find(mapping, "line") : NULL;
}

PetscErrorCode SchemaCheckShape(SchemaReader *r, const YamlNode *mapping, void *target)
{
  const Shape *s = target;
  const YamlNode *corners = closed_corners(mapping, s);
  const PetscInt before = diag_errors(r->diag);
  char path[512];

  PetscFunctionBeginUser;
  yaml_path(mapping, path, sizeof(path));
  if (corners) PetscCall(SchemaCheckCrossing(r, corners, s->n_vertices, s->vertices));
  if (corners && s->kind != SHAPE_LINE && diag_errors(r->diag) == before && !(polygon_area(s) > 0))
    SchemaKeyError(r, mapping, "%s: the polygon has no area", path);
  if (s->kind == SHAPE_DIFFERENCE && s->n_children < 2)
    SchemaKeyError(r, mapping, "%s: a difference needs two shapes or more", path);
  if ((s->kind == SHAPE_UNION || s->kind == SHAPE_INTERSECTION) && s->n_children < 1)
    SchemaKeyError(r, mapping, "%s: no shape is given", path);
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaCheckHalfSpace(SchemaReader *r, const YamlNode *mapping, void *target)
{
  const Shape *s = target;
  const YamlNode *node = yaml_find(mapping, "normal") ? yaml_find(mapping, "normal") : yaml_find(mapping, "axis");
  char path[512];

  PetscFunctionBeginUser;
  if (s->normal[0] == 0 && s->normal[1] == 0 && s->normal[2] == 0)
    SchemaError(r, node, "%s has no direction", yaml_path(node, path, sizeof(path)));
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaCheckCylinder(SchemaReader *r, const YamlNode *mapping, void *target)
{
  Shape *s = target;

  PetscFunctionBeginUser;
  s->radii[1] = s->radii[0];
  PetscCall(SchemaCheckHalfSpace(r, mapping, target));
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaCheckCone(SchemaReader *r, const YamlNode *mapping, void *target)
{
  const Shape *s = target;
  char path[512];

  PetscFunctionBeginUser;
  if (!(s->radii[0] + s->radii[1] > 0))
    SchemaError(r, yaml_find(mapping, "radius"), "%s: both ends have radius 0", yaml_path(mapping, path, sizeof(path)));
  PetscCall(SchemaCheckHalfSpace(r, mapping, target));
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaCheckTerrain(SchemaReader *r, const YamlNode *mapping, void *target)
{
  Shape *s = target;
  char message[1024];

  PetscFunctionBeginUser;
  if (!s->file) PetscFunctionReturn(0);
  PetscCall(ReliefDestroy(&s->relief));
  PetscCall(ReliefRead(s->file, s->scale, s->offset, &s->relief, sizeof message, message));
  if (!s->relief) SchemaError(r, yaml_find(mapping, "file"), "%s", message);
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaCheckDisk(SchemaReader *r, const YamlNode *mapping, void *target)
{
  const Shape *s = target;
  char path[512];

  PetscFunctionBeginUser;
  if (s->radii[0] >= s->radii[1])
    SchemaError(r, yaml_find(mapping, "hole"), "%s.hole must be smaller than the radius, %g m",
                yaml_path(mapping, path, sizeof(path)), (double)s->radii[1]);
  PetscCall(SchemaCheckHalfSpace(r, mapping, target));
  PetscFunctionReturn(0);
}

/* From 270 to 90 is the right half. */
PetscErrorCode SchemaCheckArc(SchemaReader *r, const YamlNode *mapping, void *target)
{
  Shape *s = target;
  char path[512];

  PetscFunctionBeginUser;
  if (s->angle[1] < s->angle[0]) s->angle[1] += 360;
  if (s->angle[1] > s->angle[0] && s->angle[1] - s->angle[0] < 360) PetscFunctionReturn(0);
  SchemaError(r, yaml_find(mapping, "to"), "%s goes over %g degrees, an arc over more than 0 and less than 360",
              yaml_path(mapping, path, sizeof(path)), (double)(s->angle[1] - s->angle[0]));
  diag_hint(r->diag, "all of a circle, with an inside or as a container, is a `circle`");
  PetscFunctionReturn(0);
}

/* --- bodies --- */
static void check_points(SchemaReader *r, const YamlNode *mapping, BodySpec *b)
{
  static const PetscInt usual[4] = {
    [CELL_TRIANGLE] = 3, [CELL_QUADRILATERAL] = 4, [CELL_TETRAHEDRON] = 4, [CELL_HEXAHEDRON] = 8};
  const YamlNode *node = yaml_find(mapping, "points_per_cell");
  const PetscBool on_box = r->c->grid.kind == GRID_BOX && !b->mesh;
  char path[512], list[100] = "";
  yaml_path(mapping, path, sizeof(path));
  if (!node && !on_box)
    SchemaKeyError(r, mapping, "key 'points_per_cell' of %s is missing: on a mesh it must be given", path);
  if (!node && on_box) b->points_per_cell = usual[r->c->grid.cell];
  if (!node || !on_box) return; /* the cells of a mesh are known when it has been read */
  for (const PetscInt *rule = cell_rules(r->c->grid.cell); *rule; ++rule) {
    const size_t used = strlen(list);
    if (*rule == b->points_per_cell) return;
    snprintf(list + used, sizeof(list) - used, "%s%d", used ? ", " : "", (int)*rule);
  }
  SchemaError(r, node, "%s.points_per_cell: no Gauss rule of a %s has %d points; there are %s", path,
              cells[r->c->grid.cell].name, (int)b->points_per_cell, list);
}

PetscErrorCode SchemaCheckBody(SchemaReader *r, const YamlNode *mapping, void *target)
{
  BodySpec *b = target;
  char path[512];

  PetscFunctionBeginUser;
  yaml_path(mapping, path, sizeof(path));
  if (r->dim && r->has_grid) check_points(r, mapping, b);
  if (b->region && !b->mesh && r->c->grid.kind == GRID_BOX && yaml_find(yaml_find(r->document->root, "grid"), "box"))
    SchemaError(r, yaml_find(mapping, "region"),
                "%s.region: a box grid has no regions; give a shape, or a mesh with physical groups", path);
  if (b->fill == FILL_SHAPE && !b->has_shape)
    SchemaError(r, yaml_find(mapping, "fill"), "%s.fill: shape needs a `shape`", path);
  PetscFunctionReturn(0);
}

/* --- selectors, motion --- */
PetscErrorCode SchemaCheckSelector(SchemaReader *r, const YamlNode *mapping, void *target)
{
  static const char *const sides[] = {"left", "right", "bottom", "top", "front", "back", NULL};
  const Selector *on = target;
  const PetscInt n = r->dim == 3 ? 6 : 4;
  const char *words[7] = {NULL};
  char path[512];

  PetscFunctionBeginUser;
  if (!on->boundary || !r->dim || !yaml_find(yaml_find(r->document->root, "grid"), "box") || on->body)
    PetscFunctionReturn(0);
  for (PetscInt i = 0; i < n; ++i) {
    words[i] = sides[i];
    if (!strcmp(sides[i], on->boundary)) PetscFunctionReturn(0);
  }
  SchemaError(r, yaml_find(mapping, "boundary"), "%s: a box has no boundary '%s'",
              yaml_path(yaml_find(mapping, "boundary"), path, sizeof(path)), on->boundary);
  diag_hint_names(r->diag, on->boundary, words);
  PetscFunctionReturn(0);
}

/* Beside a normal an axis says all in the plane, and nothing that is true of any wall in space. */
static void check_slip(SchemaReader *r, const YamlNode *mapping, const MotionSpec *m)
{
  char path[512];
  if (!m->component[0] && !m->component[1] && !m->component[2]) return;
  SchemaError(r, yaml_find(mapping, "fix"), "%s.fix: beside the normal no other component stands",
              yaml_path(mapping, path, sizeof(path)));
  diag_hint(r->diag, r->dim == 2 ? "[x, y] holds nodes in the plane" : "give the others an entry of their own");
}

PetscErrorCode SchemaCheckMotion(SchemaReader *r, const YamlNode *mapping, void *target)
{
  MotionSpec *m = target;
  const YamlNode *rotation = yaml_find(mapping, "rotation");
  char path[512];

  PetscFunctionBeginUser;
  if (m->on.body) {
    SchemaKeyError(r, yaml_find(yaml_find(mapping, "on"), "body"),
                   "%s: motion is prescribed on the grid, not on a body", yaml_path(mapping, path, sizeof(path)));
    diag_hint(r->diag, "select by x, y, boundary or shape");
  }
  if (m->moves && (m->kind == MOTION_FIXED || m->on.boundary)) {
    SchemaKeyError(r, yaml_find(mapping, "moves"), "%s.moves: %s", yaml_path(mapping, path, sizeof(path)),
                   m->on.boundary ? "a boundary of the grid stays where it is" : "what is fixed does not move");
    diag_hint(r->diag, m->on.boundary ? "select by x, y or shape" : "leave it away");
  }
  if (m->component[NORMAL]) check_slip(r, mapping, m);
  if (m->kind == MOTION_ROTATION) {
    for (PetscInt d = 0; d < r->dim; ++d) m->component[d] = PETSC_TRUE;
    if (r->dim == 2) m->axis[2] = 1;
    if (m->axis[0] == 0 && m->axis[1] == 0 && m->axis[2] == 0 && r->dim)
      SchemaError(r, yaml_find(rotation, "axis"), "%s.rotation.axis has no direction",
                  yaml_path(mapping, path, sizeof(path)));
  }
  PetscFunctionReturn(0);
}

/* --- loads --- */
PetscErrorCode SchemaCheckLoad(SchemaReader *r, const YamlNode *mapping, void *target)
{
  static const char *const names[] = {"x", "y", "z", "X", "Y", "Z", "t", NULL};
  const LoadSpec *load = target;
  const PetscReal origin[3] = {0, 0, 0};
  LoadPlace place = {.dim = r->dim ? r->dim : 3, .X = origin, .x = origin};
  Formula formula = {.value = LoadPlaceValue, .context = &place, .at = load->factor};
  PetscReal value;
  char path[512];

  PetscFunctionBeginUser;
  if (!load->factor) PetscFunctionReturn(0);
  PetscCall(FormulaValue(&formula, &value));
  if (!formula.wrong) PetscFunctionReturn(0);
  const YamlNode *text = yaml_find(mapping, "factor");
  yaml_path(mapping, path, sizeof path);
  if (formula.name[0]) {
    SchemaError(r, text, "%s.factor: there is no '%s' here; coordinates and t are", path, formula.name);
    diag_hint_names(r->diag, formula.name, names);
  } else if (formula.wrong[0]) SchemaError(r, text, "%s.factor makes no sense from '%s' on", path, formula.wrong);
  else SchemaError(r, text, "%s.factor: something is missing at the end of '%s'", path, load->factor);
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaCheckLoads(SchemaReader *r, const YamlNode *mapping, void *target)
{
  const Case *c = target;
  const YamlNode *gravity = yaml_find(mapping, "gravity");

  PetscFunctionBeginUser;
  if (!r->hoop || c->gravity[0] == 0) PetscFunctionReturn(0);
  SchemaError(r, gravity->n ? gravity->child[0] : gravity,
              "loads.gravity: %g along x is not axisymmetric, gravity acts along the axis", (double)c->gravity[0]);
  diag_hint(r->diag, "the axis is y: gravity: [0, -9.81]");
  PetscFunctionReturn(0);
}
