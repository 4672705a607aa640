/* Seeding: the bodies become points, at the Gauss points of their cells. */
#include "points/fields.h"
#include "points/seed/seed.h"

void seed_path(PetscInt body, const char *key, size_t size, char *path)
{
  snprintf(path, size, "bodies[%d]%s%s", (int)body, *key ? "." : "", key);
}

PetscBool seed_tells(const Grid *grid)
{
  PetscMPIInt rank;
  MPI_Comm_rank(grid->comm, &rank);
  return rank == 0;
}

PetscReal seed_cell_volume(const Seeding *s, PetscInt cell)
{
  PetscReal x[CELL_MAX_NODES * 3];
  grid_cell_x(s->source, cell, x);
  return cell_volume_in(s->c->kinematics, grid_cell_type(s->source, cell), x);
}

static PetscErrorCode FindMaterial(Seeding *s)
{
  char path[128];
  PetscFunctionBeginUser;
  for (s->material = 0; s->material < s->c->n_materials; ++s->material) {
    if (!strcmp(s->c->materials[s->material].name, s->body->material)) PetscFunctionReturn(0);
  }
  s->material = -1;
  seed_path(s->b, "material", sizeof path, path);
  if (seed_tells(s->grid)) diag_error(s->diag, path, "there is no material '%s'", s->body->material);
  PetscFunctionReturn(0);
}

/* Where among the rules of a type this number of points stands; -1: nowhere. */
static PetscInt find_rule(CellType type, PetscInt n)
{
  const PetscInt *rules = cell_rules(type);
  for (PetscInt i = 0; rules[i] && rules[i] <= SEED_MAX_RULE; ++i)
    if (rules[i] == n) return i;
  return -1;
}

/* Domains shall cover their cell once: their points stand in the middle of equal parts. */
static void fill_rule(CellType type, PetscInt place, PetscBool domains, SeedRule *rule)
{
  rule->n = cell_rules(type)[place];
  rule->side = domains ? cell_lattice(type, rule->n, rule->xi, rule->weight) : 0;
  if (!rule->side) (void)cell_quadrature(type, rule->n, rule->xi, rule->weight);
}

/* PETSC_FALSE, and a message that lists the rules, if this number of points is none. Where a mesh
 * mixes two kinds of cells it may be a number of either, and the other kind takes the rule of the
 * same place in its list. */
static PetscBool choose_rule(Seeding *s)
{
  const CellType type = s->source->type;
  const PetscInt n = s->body->points_per_cell, *rules = cell_rules(type);
  PetscInt place = find_rule(type, n);
  char path[128], list[128] = "";
  if (place < 0 && grid_is_mixed(s->source)) place = find_rule(s->source->first_type, n);
  if (place >= 0) {
    fill_rule(type, place, s->domains, &s->rule);
    fill_rule(s->source->first_type, place, s->domains, &s->first_rule);
    return PETSC_TRUE;
  }
  for (PetscInt i = 0; rules[i]; ++i) {
    const size_t used = strlen(list);
    snprintf(list + used, sizeof list - used, "%s%d", i ? ", " : "", (int)rules[i]);
  }
  seed_path(s->b, "points_per_cell", sizeof path, path);
  if (seed_tells(s->grid)) {
    diag_error(s->diag, path, "no rule places %d points in a %s; there are rules with %s points", (int)n,
               cells[type].name, list);
  }
  return PETSC_FALSE;
}

const SeedRule *seed_rule(const Seeding *s, PetscInt cell)
{
  return cell < s->source->n_first ? &s->first_rule : &s->rule;
}

/* The region's set; NULL and a message if the body names one that does not exist. */
static PetscErrorCode FindRegion(const Seeding *s, const GridSet **set)
{
  PetscInt n_regions = 0;
  char path[128];
  PetscFunctionBeginUser;
  *set = grid_find_set(s->source, s->body->region);
  if (*set) PetscCallMPI(MPI_Allreduce(&(*set)->n_cells, &n_regions, 1, MPIU_INT, MPI_SUM, s->grid->comm));
  if (n_regions) PetscFunctionReturn(0);
  seed_path(s->b, "region", sizeof path, path);
  if (seed_tells(s->grid)) {
    const char **names;
    PetscCall(GridSetNames(s->source, &names));
    if (*set) diag_error(s->diag, path, "'%s' is a boundary, not a region: it has no cells", s->body->region);
    else diag_error(s->diag, path, "the mesh has no region '%s'", s->body->region);
    if (!*set) diag_hint_names(s->diag, s->body->region, names);
    PetscCall(PetscFree(names));
  }
  *set = NULL;
  PetscFunctionReturn(0);
}

static PetscBool centre_in_shape(const Seeding *s, PetscInt cell)
{
  PetscReal centre[3];
  if (!s->body->has_shape) return PETSC_TRUE;
  grid_cell_centre(s->source, cell, centre);
  return shape_contains(&s->body->shape, s->source->dim, centre, 0);
}

PetscBool body_fills_shape(const BodySpec *body, PetscBool equal)
{
  return body->fill == FILL_AUTO ? body->has_shape && equal : body->fill == FILL_SHAPE;
}

static PetscBool fills_shape(const Seeding *s) { return body_fills_shape(s->body, s->equal); }

typedef struct {
  PetscReal min[3], max[3];
} ShapeBox;

/* Most cells are far from a body: their samples need not be asked. */
static PetscBool near_shape(const Seeding *s, PetscInt cell, const ShapeBox *b)
{
  const PetscInt dim = s->source->dim;
  PetscReal x[CELL_MAX_NODES * 3];
  grid_cell_x(s->source, cell, x);
  for (PetscInt d = 0; d < dim; ++d) {
    PetscReal low = PETSC_MAX_REAL, high = -PETSC_MAX_REAL;
    for (PetscInt i = 0; i < grid_cell(s->source, cell)->nodes; ++i) {
      low = PetscMin(low, x[i * dim + d]);
      high = PetscMax(high, x[i * dim + d]);
    }
    if (low > b->max[d] || high < b->min[d]) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Room for the parts of one more cell. */
static PetscErrorCode MakeRoom(Seeding *s)
{
  PetscFunctionBeginUser;
  if (s->n_parts + SEED_MAX_RULE <= s->capacity) PetscFunctionReturn(0);
  s->capacity = PetscMax(64 * SEED_MAX_RULE, 2 * s->capacity);
  PetscCall(PetscRealloc((size_t)s->capacity * sizeof *s->part, &s->part));
  PetscFunctionReturn(0);
}

/* Is there anything of the body in the cell? If its surface cuts it the parts are measured. */
static PetscErrorCode LookInto(Seeding *s, PetscInt cell, const ShapeBox *b)
{
  SeedFill fill = centre_in_shape(s, cell) ? SEED_WHOLE : SEED_NONE;
  PetscFunctionBeginUser;
  if (fills_shape(s)) fill = near_shape(s, cell, b) ? seed_fill(s, cell) : SEED_NONE;
  if (fill == SEED_CUT) {
    PetscCall(MakeRoom(s));
    fill = seed_parts(s, cell, seed_rule(s, cell), s->part + s->n_parts);
  }
  if (fill == SEED_NONE) PetscFunctionReturn(0);
  if (s->cut) s->cut[s->n_cells] = fill == SEED_CUT ? s->n_parts : -1;
  if (fill == SEED_CUT) s->n_parts += seed_rule(s, cell)->n;
  s->cells[s->n_cells++] = cell;
  PetscFunctionReturn(0);
}

/* The cells in the region (if one is named) and in the shape (if there is one). *found is false
 * after a mistake. */
static PetscErrorCode ChooseCells(Seeding *s, PetscBool *found)
{
  const GridSet *set = NULL;
  PetscFunctionBeginUser;
  *found = PETSC_FALSE;
  if (s->body->region) {
    PetscCall(FindRegion(s, &set));
    if (!set) PetscFunctionReturn(0);
  }
  const PetscInt n = set ? set->n_cells : s->source->n_cells;
  ShapeBox b;
  PetscCall(PetscMalloc1(n, &s->cells));
  if (fills_shape(s)) {
    PetscCall(PetscMalloc1(n, &s->cut));
    shape_bounds(&s->body->shape, s->source->dim, b.min, b.max);
  }
  for (PetscInt k = 0; k < n; ++k) {
    const PetscInt cell = set ? set->cells[k] : k;
    if (s->source == s->grid && grid_field_of(s->grid, cell) != s->field) continue;
    PetscCall(LookInto(s, cell, &b));
  }
  *found = PETSC_TRUE;
  PetscFunctionReturn(0);
}

void body_velocity(const BodySpec *body, PetscInt dim, const PetscReal *x, PetscReal *v)
{
  PetscReal r[3] = {0, 0, 0}, full[3];
  const PetscReal *w = body->spin;
  for (PetscInt d = 0; d < dim; ++d) r[d] = x[d] - body->spin_centre[d];
  full[0] = (dim == 3 ? w[1] * r[2] : 0) - w[2] * r[1];
  full[1] = w[2] * r[0] - (dim == 3 ? w[0] * r[2] : 0);
  full[2] = w[0] * r[1] - w[1] * r[0];
  for (PetscInt d = 0; d < dim; ++d) v[d] = body->velocity[d] + full[d];
}

/* Its gradient, the same everywhere: columns are what a metre along each axis changes. */
static void seed_slope(const BodySpec *body, PetscInt dim, PetscReal *slope)
{
  PetscReal here[3], there[3], x[3] = {0, 0, 0};
  body_velocity(body, dim, x, here);
  for (PetscInt j = 0; j < dim; ++j) {
    x[j] = 1;
    body_velocity(body, dim, x, there);
    x[j] = 0;
    for (PetscInt i = 0; i < dim; ++i) slope[i * dim + j] = there[i] - here[i];
  }
}

/* Do the points of such a cell take equal parts? In rings of its section: times 2 pi r that is as
 * good as the Gauss rule in triangles, while in a quadrilateral that is no rectangle even a uniform
 * strain would be out of balance. */
static PetscBool shares_equally(const Seeding *s, CellType type)
{
  if (s->body->weights != WEIGHTS_AUTO) return s->body->weights == WEIGHTS_EQUAL;
  return s->equal && (!s->c->kinematics->hoop || type == CELL_TRIANGLE);
}

/* Distance from the body's surface. */
static PetscReal reach_of(const Seeding *s, PetscInt k, const PetscReal *x, PetscInt q, const PetscReal *position,
                          PetscReal section, PetscReal whole, const unsigned char *outer)
{
  static const unsigned char inside[CELL_MOST_SIDES] = {0};
  const CellType type = grid_cell_type(s->source, s->cells[k]);
  const SeedRule *rule = seed_rule(s, s->cells[k]);
  PetscReal at[3];
  if (!s->cut || s->cut[k] < 0) return seed_reach(type, x, position, section, rule, q, outer);
  cell_position(type, x, rule->xi + q * s->source->dim, at);
  return seed_depth(s, s->part + s->cut[k] + q, position, seed_reach(type, x, at, whole, rule, q, inside),
                    PetscPowReal(whole, 1 / (PetscReal)s->source->dim));
}

/* The q-th point of the k-th cell, with nodes at x. share: its part of the section, or of the
 * volume in space; < 0: that of the Gauss rule. part: what of it lies in the body. */
static PetscErrorCode SeedPoint(const Seeding *s, Points *points, PetscInt k, const PetscReal *x, PetscReal share,
                                PetscInt q, const SeedPart *part, const PointSeed *seed)
{
  const PetscInt dim = points->dim, cell = s->cells[k];
  const SeedRule *rule = seed_rule(s, cell);
  const PetscReal *xi = part ? part->xi : rule->xi + q * dim;
  unsigned char outer[CELL_MOST_SIDES];
  PetscInt p;
  PetscFunctionBeginUser;
  PetscCall(PointsAppend(points, &p));
  PetscReal *position = point_real(points, POINT_X, p);
  const PetscReal det = cell_map(grid_cell_type(s->source, cell), x, xi, position);
  const PetscReal whole = share < 0 ? rule->weight[q] * det : share;
  const PetscReal section = part ? part->share * cell_volume(grid_cell_type(s->source, cell), x) : whole;
  const PetscReal volume = section * kinematics_weight(s->c->kinematics, position[0]);
  *point_real(points, POINT_VOLUME, p) = volume;
  *point_real(points, POINT_MASS, p) = seed->density * volume;
  body_velocity(s->body, dim, position, point_real(points, POINT_V, p));
  if (s->domains)
    seed_domain(grid_cell_type(s->source, cell), x, xi, rule->side, part && !part->whole ? part->spread : NULL, section,
                point_real(points, POINT_DOMAIN, p));
  if (s->outer) seed_sides_at(s, k, x, xi, outer);
  if (s->outer) *point_real(points, POINT_REACH, p) = reach_of(s, k, x, q, position, section, whole, outer);
  if (points->components[POINT_CORNER] && part && s->outer)
    seed_corner_of_part(s, grid_cell_type(s->source, cell), x, part, position, *point_real(points, POINT_REACH, p),
                        outer, point_real(points, POINT_CORNER, p));
  if (points->components[POINT_CORNER] && !part)
    seed_corner(grid_cell_type(s->source, cell), x, position, rule, q, outer, point_real(points, POINT_CORNER, p),
                points->components[POINT_BESIDE] ? point_real(points, POINT_BESIDE, p) : NULL);
  if (s->faces && (part || s->source != s->grid || !s->equal))
    seed_face(s, cell, x, q, part, outer, point_real(points, POINT_FACE, p));
  if (points->components[POINT_SLOPE]) seed_slope(s->body, dim, point_real(points, POINT_SLOPE, p));
  if (seed->n_state) PetscCall(PetscArraycpy(point_real(points, POINT_STATE, p), seed->initial, seed->n_state));
  points->id[p] = s->first_id + (PetscInt64)s->source->global_cell[cell] * s->rule.n + q;
  points->body[p] = s->b;
  if (points->components[POINT_FIELD]) *point_real(points, POINT_FIELD, p) = (PetscReal)s->field;
  points->material[p] = s->material;
  if (s->source == s->grid) {
    points->cell[p] = cell;
    PetscCall(PetscArraycpy(point_real(points, POINT_XI, p), xi, dim));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode SeedCells(const Seeding *s, Points *points, const PointSeed *seed)
{
  PetscReal x[CELL_MAX_NODES * 3];
  PetscFunctionBeginUser;
  PetscCheck(seed->n_state <= points->components[POINT_STATE], PETSC_COMM_SELF, PETSC_ERR_ARG_SIZ,
             "a law stores %" PetscInt_FMT " numbers, the points have room for %" PetscInt_FMT, seed->n_state,
             points->components[POINT_STATE]);
  PetscCall(PointsReserveMore(points, s->n_cells * s->rule.n));
  for (PetscInt k = 0; k < s->n_cells; ++k) {
    const PetscInt n = seed_rule(s, s->cells[k])->n;
    const CellType type = grid_cell_type(s->source, s->cells[k]);
    grid_cell_x(s->source, s->cells[k], x);
    const PetscReal share = shares_equally(s, type) ? cell_volume(type, x) / (PetscReal)n : -1;
    const SeedPart *part = s->cut && s->cut[k] >= 0 ? s->part + s->cut[k] : NULL;
    for (PetscInt q = 0; q < n; ++q)
      if (!part || part[q].share > 0) PetscCall(SeedPoint(s, points, k, x, share, q, part ? part + q : NULL, seed));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode BodyMeshCreate(MPI_Comm comm, const Case *c, PetscInt b, Diag *diag, Grid **own)
{
  GridSpec spec = c->grid;
  char path[128];
  PetscFunctionBeginUser;
  spec.kind = GRID_MESH;
  spec.mesh = c->bodies[b].mesh;
  spec.mesh_scale = c->bodies[b].mesh_scale;
  seed_path(b, "mesh", sizeof path, path);
  PetscCall(GridCreateMesh(comm, &spec, kinematics_dim(c->kinematics), path, NULL, NULL, diag, own));
  PetscCall(GridCheckAxis(c->kinematics, path, diag, own));
  PetscFunctionReturn(0);
}

/* Ids of the next body start behind the largest that this one could use. */
static PetscErrorCode AdvanceIds(const Seeding *s, PetscInt64 *next)
{
  PetscInt last = -1, last_of_all;
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < s->source->n_cells; ++k) last = PetscMax(last, s->source->global_cell[k]);
  PetscCallMPI(MPI_Allreduce(&last, &last_of_all, 1, MPIU_INT, MPI_MAX, s->grid->comm));
  *next = s->first_id + ((PetscInt64)last_of_all + 1) * s->rule.n;
  PetscFunctionReturn(0);
}

/* The cells of the body, and what they hold of it. *found is false after a mistake. */
static PetscErrorCode ChooseSource(Seeding *s, PetscInt64 *next)
{
  PetscFunctionBeginUser;
  if (fills_shape(s) && !s->equal) {
    char path[128];
    seed_path(s->b, "fill", sizeof path, path);
    if (seed_tells(s->grid))
      diag_error(s->diag, path, "shape: fem and gmm take whole cells; let the mesh follow the body");
    PetscFunctionReturn(0);
  }
  if (!choose_rule(s)) PetscFunctionReturn(0);
  PetscCall(SeedFindMates(s));
  PetscCall(ChooseCells(s, &s->ready));
  if (!s->ready) PetscFunctionReturn(0);
  PetscCall(SeedCheckVolume(s));
  PetscCall(AdvanceIds(s, next));
  PetscFunctionReturn(0);
}

static PetscErrorCode ChooseBody(Seeding *s, PetscInt64 *next)
{
  Grid *own = NULL;
  PetscFunctionBeginUser;
  s->source = s->grid;
  s->first_id = *next;
  PetscCall(FindMaterial(s));
  if (s->material < 0) PetscFunctionReturn(0);
  if (s->body->mesh) {
    PetscCall(BodyMeshCreate(s->grid->comm, s->c, s->b, s->diag, &own));
    if (!own) PetscFunctionReturn(0);
    s->source = s->own = own;
  }
  PetscCall(ChooseSource(s, next));
  PetscFunctionReturn(0);
}

/* The points of a body whose cells are known. */
static PetscErrorCode SeedBody(Seeding *s, Points *points, const PointSeed *per_material)
{
  PetscBool fits;
  PetscFunctionBeginUser;
  PetscCall(SeedCheckRoom(s, points, &fits));
  if (!fits) PetscFunctionReturn(0);
  PetscCall(SeedCells(s, points, per_material + s->material));
  if (s->outline)
    PetscCall(OutlineAdd(s->outline, s->source, s->n_cells, s->cells, s->b, per_material[s->material].density));
  if (s->outline && fills_shape(s)) PetscCall(OutlineShape(s->outline, s->c->n_bodies, s->b, &s->body->shape));
  PetscFunctionReturn(0);
}

static PetscErrorCode SeedingClear(Seeding *s)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(s->cells));
  PetscCall(PetscFree(s->cut));
  PetscCall(PetscFree(s->part));
  PetscCall(PetscFree(s->outer));
  PetscCall(PetscFree(s->mate));
  PetscCall(GridDestroy(&s->own));
  PetscFunctionReturn(0);
}

/* Points of a body's own mesh know their place, not yet their cell nor their rank. */
static PetscErrorCode LocateSeeds(Points *points, const Grid *grid, const Case *c, Diag *diag)
{
  PetscInt n_lost;
  LostPoint *lost = NULL;
  PetscFunctionBeginUser;
  PetscCall(PointsRelocate(points, grid, OUTSIDE_STOP, &n_lost, &lost));
  PetscCall(PetscFree(lost));
  if (n_lost) PetscCall(SeedCheckLocated(points, grid, c, diag));
  PetscFunctionReturn(0);
}

static Seeding seeding_of(const Points *points, const Grid *grid, const Case *c, PetscInt b)
{
  return (Seeding){.c = c,
                   .grid = grid,
                   .b = b,
                   .field = grid->n_fields > 1 ? case_field(c, b) : 0,
                   .body = c->bodies + b,
                   .domains = points->components[POINT_DOMAIN] > 0,
                   .faces = points->components[POINT_FACE] > 0};
}

PetscErrorCode PointsSeedOutlined(Points *points, const Grid *grid, const Case *c, const PointSeed *per_material,
                                  PetscBool equal, Outline *outline, Diag *diag)
{
  PetscInt *place;
  PetscInt64 next = 0;
  PetscBool own_mesh = PETSC_FALSE;
  Seeding *all;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(grid->n_cells, &place));
  PetscCall(PetscMalloc1(c->n_bodies, &all));
  for (PetscInt k = 0; k < grid->n_cells; ++k) place[k] = -1;
  for (PetscInt b = 0; b < c->n_bodies; ++b) {
    all[b] = seeding_of(points, grid, c, b);
    all[b].diag = diag, all[b].equal = equal, all[b].outline = outline;
    if (!all[b].body->absent) PetscCall(ChooseBody(&all[b], &next));
    if (all[b].ready && all[b].source == grid) PetscCall(SeedCheckOverlap(all, &all[b], place));
    if (all[b].body->mesh) own_mesh = PETSC_TRUE;
  }
  if (points->components[POINT_REACH]) PetscCall(SeedFindSides(all, c->n_bodies));
  for (PetscInt b = 0; b < c->n_bodies; ++b) {
    if (all[b].ready) PetscCall(SeedBody(&all[b], points, per_material));
    PetscCall(SeedingClear(&all[b]));
  }
  PetscCall(PetscFree(all));
  PetscCall(PetscFree(place));
  if (own_mesh) PetscCall(LocateSeeds(points, grid, c, diag));
  PetscCall(PointsSort(points));
  PetscFunctionReturn(0);
}

PetscErrorCode PointsSeed(Points *points, const Grid *grid, const Case *c, const PointSeed *per_material,
                          PetscBool equal, Diag *diag)
{
  PetscFunctionBeginUser;
  PetscCall(PointsSeedOutlined(points, grid, c, per_material, equal, NULL, diag));
  PetscFunctionReturn(0);
}
