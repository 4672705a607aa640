/* What a model would do without a word, and its user hardly means: said before the first step. */
#include "base/text.h"
#include "model/model_private.h"

#define NEARLY_INCOMPRESSIBLE 0.49

static const char *const cells_plural[4] = {"triangles", "quadrilaterals", "tetrahedra", "hexahedra"};

static const NamedValue *constant(const MaterialSpec *spec, const char *name)
{
  for (PetscInt i = 0; i < spec->n_parameters; ++i)
    if (!strcmp(spec->parameters[i].name, name)) return &spec->parameters[i];
  return NULL;
}

/* Does the material flow without change of volume? *key: what makes it so. */
static PetscBool flows_at_constant_volume(const MaterialSpec *spec, const Material *material, const char **key)
{
  const NamedValue *friction = constant(spec, "friction_angle");
  const Law *law = material->law;
  if (!law->yields || (friction && friction->value > 0)) return PETSC_FALSE;
  if (!friction && (!law->volume_law || law->volume_law(material->parameters) == VOLUME_COUPLED)) return PETSC_FALSE;
  *key = friction ? "friction_angle" : "law";
  return PETSC_TRUE;
}

static PetscBool only_simplices(const Model *m)
{
  return !grid_is_mixed(m->grid) && cells[m->grid->type].nodes == m->dim + 1;
}

/* Does each cell have more points at which its volume would have to stay than motions to obey them?
 * A single point in a quadrilateral or hexahedron asks for little (and holds little: see
 * seeding). */
static PetscBool cells_lock(const Model *m, const BodySpec *body)
{
  /* some of them, in a mixed mesh */
  const PetscBool simplex = cells[m->grid->first_type].nodes == m->dim + 1;
  return simplex || body->points_per_cell > 1;
}

static void hint_unlocked(const Model *m, const Material *material, Diag *diag)
{
  if (!m->method->clouds && !only_simplices(m))
    diag_hint(diag, "`formulation: mean-dilatation` keeps that away%s",
              material->law->volume ? ", and so does `mixed`" : "");
  else if (!material->law->volume)
    diag_hint(diag,
              "the law %s has no mixed form: a law that has one (see `talus list laws`), or a material that is less "
              "stiff against changes of volume",
              material->law->name);
  else if (!m->method->takes_pressure)
    diag_hint(diag,
              "method %s has no mixed form: take mpm or fem with `formulation: mixed`, or a material that is less "
              "stiff against changes of volume",
              m->method->name);
  else diag_hint(diag, "`formulation: mixed` keeps that away");
}

/* A linear triangle has one gradient and one change of volume, for all its points; rings of one differ a
 * little. A few of them, which Gmsh leaves where it makes pairs, hold the flow around them: 4 of 3615 cells
 * made a slope stronger by 1.5 % (cases/factor-of-safety). */
static PetscErrorCode AdviseSharing(const Model *m, Diag *diag)
{
  const Grid *grid = m->grid;
  const PetscBool rings = m->c->kinematics->hoop;
  const char *simplices = cells_plural[grid->first_type], *others = m->dim == 2 ? "quadrilaterals" : "hexahedra";
  PetscInt n = grid->n_first;

  PetscFunctionBeginUser;
  if (!m->formulation->cells || cells[grid->first_type].nodes != m->dim + 1) PetscFunctionReturn(0);
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &n, 1, MPIU_INT, MPI_SUM, m->comm));
  if (only_simplices(m)) {
    diag_warning(
      diag, "formulation", "formulation '%s' does %s for linear %s, which have %s change of volume at all their points",
      m->formulation->name, rings ? "next to nothing" : "nothing", simplices, rings ? "almost the same" : "the same");
    diag_hint(diag, "take %s, or `formulation: mixed` where the volume hardly changes",
              m->dim == 2 ? "quadrilaterals (of Gmsh: `Mesh.RecombineAll = 1;`)" : "hexahedra");
  } else {
    diag_warning(diag, "formulation",
                 "formulation '%s' does nothing for %lld of %lld cells, which are linear %s: what flows at constant "
                 "volume locks there, and the body may be too strong by several per cent",
                 m->formulation->name, (long long)n, (long long)grid->n_cells_global, simplices);
    diag_hint(diag, "take %s alone%s", others,
              m->dim == 2 ? " (of Gmsh: `Mesh.SubdivisionAlgorithm = 1;`, which cuts each cell in four)" : "");
  }
  PetscFunctionReturn(0);
}

/* Bulk modulus of a point as it begins, Pa: 9 K = c_iijj + 2 tr tau, of which c lacks the latter; 0: it bears none. */
static PetscReal bulk_of(const Model *m, PetscInt p, const Material *material)
{
  static const PetscReal identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  PetscReal state[LAW_MAX_STATE], tau[6], c[36], sum = 0;
  if (material->law->update(material->parameters, 1, identity, point_real(m->points, POINT_STATE, p), state, tau, c) !=
      LAW_OK)
    return 0;
  for (int i = 0; i < 3; ++i) sum += c[6 * i] + c[6 * i + 1] + c[6 * i + 2] + 2 * tau[i];
  return sum / 9;
}

/* Of the stiffest point of body b, where a law's stiffness goes with the stress. */
static PetscErrorCode PoissonOf(const Model *m, PetscInt b, const Material *material, PetscReal *poisson)
{
  const PetscReal shear = material->elastic.shear;
  PetscReal bulk = 0;

  PetscFunctionBeginUser;
  *poisson = material->elastic.poisson;
  if (!material->law->elastic) PetscFunctionReturn(0);
  for (PetscInt p = 0; p < m->points->n; ++p)
    if (m->points->body[p] == b) bulk = PetscMax(bulk, bulk_of(m, p, material));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &bulk, 1, MPIU_REAL, MPIU_MAX, m->comm));
  if (bulk > 0) *poisson = (3 * bulk - 2 * shear) / (2 * (3 * bulk + shear));
  PetscFunctionReturn(0);
}

/* Measured (the footing of tests/program/traps.sh): quadrilaterals with four points, and triangles,
 * carry six times Prandtl's load and show no limit. */
static PetscErrorCode AdviseLocking(const Model *m, PetscInt b, PetscInt i, Diag *diag)
{
  const MaterialSpec *spec = &m->c->materials[i];
  const Material *material = &m->materials[i];
  const char *key = "poisson", *what;
  PetscReal poisson;
  char path[256];

  PetscFunctionBeginUser;
  if (m->formulation->pressure || m->formulation->cells || !cells_lock(m, &m->c->bodies[b])) PetscFunctionReturn(0);
  PetscCall(PoissonOf(m, b, material, &poisson));
  if (flows_at_constant_volume(spec, material, &key)) what = "yields without any change of its volume";
  else if (poisson < NEARLY_INCOMPRESSIBLE) PetscFunctionReturn(0);
  else if (material->law->elastic) key = "law", what = "hardly changes its volume under the stress that it begins with";
  else what = "hardly changes its volume";
  if (!constant(spec, key) && strcmp(key, "law")) key = "bulk"; /* poisson follows from it */
  PetscSNPrintf(path, sizeof path, "materials.%s.%s", spec->name, key);
  diag_warning(
    diag, path,
    "'%s' %s: with displacements as the only unknowns %s lock, so that the body is too stiff and carries too "
    "much, often several times",
    spec->name, what, m->method->clouds ? "clouds" : cells_plural[m->grid->type]);
  hint_unlocked(m, material, diag);
  PetscFunctionReturn(0);
}

/* --- walls that nothing meets --- */
/* " from (0, 0) to (1, 2) m", or nothing of a wall without end. */
static const char *extent_of(PetscInt dim, const PetscReal *min, const PetscReal *max, char text[192])
{
  char from[80], to[80];
  text[0] = 0;
  for (PetscInt d = 0; d < dim; ++d)
    if (min[d] <= -PETSC_MAX_REAL || max[d] >= PETSC_MAX_REAL) return text;
  snprintf(text, 192, " from %s to %s m", text_position(dim, min, from), text_position(dim, max, to));
  return text;
}

/* A mesh goes with its body, which may well come to a wall that it does not reach at the start; and a wall that moves
 * may come into the grid. */
static void advise_wall(const Model *m, PetscInt k, Diag *diag)
{
  const WallSpec *wall = m->c->walls + k;
  PetscReal min[3], max[3];
  PetscBool apart = PETSC_FALSE;
  char path[64], walls[192], grid[192];
  if (!m->method->restores_grid || wall->n_motions || wall->has_mass || wall->inside) return;
  wall_bounds(m->walls, k, 0, min, max);
  for (PetscInt d = 0; d < m->dim; ++d) apart |= min[d] > m->grid->max[d] || max[d] < m->grid->min[d];
  if (!apart) return;
  PetscSNPrintf(path, sizeof path, "walls[%d].shape", (int)k);
  diag_warning(diag, path, "wall '%s'%s lies outside of the grid%s: nothing meets it", wall->name,
               extent_of(m->dim, min, max, walls), extent_of(m->dim, m->grid->min, m->grid->max, grid));
}

/* Terrain ends at its last posts; material that goes farther falls beside it, and no message stops the run as long as
 * there are cells. */
static void advise_terrain(const Model *m, PetscInt k, Diag *diag)
{
  const WallSpec *wall = m->c->walls + k;
  PetscReal min[3], max[3], reach = 0;
  char path[64], posts[192], grid[192];
  if (!m->method->restores_grid || wall->shape.kind != SHAPE_TERRAIN || wall->n_motions || wall->has_mass) return;
  if (wall->inside) return;
  wall_bounds(m->walls, k, 0, min, max);
  for (PetscInt d = 0; d < 2; ++d) {
    if (min[d] > m->grid->max[d] || max[d] < m->grid->min[d]) return; /* which advise_wall tells */
    reach = PetscMax(reach, PetscMax(min[d] - m->grid->min[d], m->grid->max[d] - max[d]));
  }
  if (reach <= 1e-6 * m->grid->smallest) return;
  PetscSNPrintf(path, sizeof path, "walls[%d].shape.terrain", (int)k);
  diag_warning(diag, path,
               "the posts of terrain '%s' end within the grid%s, that reaches%s: what comes there falls past the "
               "terrain",
               wall->name, extent_of(2, min, max, posts), extent_of(2, m->grid->min, m->grid->max, grid));
  diag_hint(diag,
            "let the grid end at the last posts: they stand in the middle of the file's cells, half a cell within "
            "the corner that xllcorner and yllcorner give");
}

/* The pressure of the second equation is that before the flow, of which dilatancy takes something away at each point by
 * itself: changes of volume inside a cell are not held (docs/decisions.md, 263). */
static void tell_lost_way(const Model *m, Diag *diag)
{
  diag_warning(diag, "formulation",
               "with a dilatancy angle Newton's method may lose its way in the mixed formulation long before anything "
               "fails: %s",
               case_seeks(&m->c->analysis) ? "a factor of safety or a limit load of half and less"
                                           : "what yields may come out far too soft, or a step give up");
  diag_hint(diag, "take `formulation: mean-dilatation`%s, or `dilatancy_angle: 0` where no soil is pulled",
            !only_simplices(m) ? ""
            : m->dim == 2      ? " and quadrilaterals (of Gmsh: `Mesh.RecombineAll = 1;`)"
                               : " and hexahedra");
}

/* The points of a cell share its volume, but each dilates by what it shears: what does more presses itself, and bears
 * more, as long as it flows (docs/theory.md, section 17). */
static void advise_dilatancy(const Model *m, Diag *diag)
{
  const Case *c = m->c;
  if (!case_dilates(c) || !case_is_static(&c->analysis)) return;
  if (m->formulation->pressure) tell_lost_way(m, diag);
  if (!m->formulation->cells || only_simplices(m)) return;
  diag_warning(diag, "formulation",
               "soil that dilates comes out too strong where the points of a cell share its volume, by a quarter on "
               "coarse grids: a vertical cut with 10, 20, 40 cells in its height by 26, 16, 9 %%");
  diag_hint(diag,
            "halve the cells until the number stands still, or compare with `dilatancy_angle: 0` (5, 1.5 %%), or with "
            "`formulation: displacement` and `points_per_cell: 1` (2.7, 1.1 %%)");
}

/* --- reactions of nothing --- */
/* What several entries prescribe counts to one of them (boundary/sum.c). */
static PetscErrorCode AdviseReaction(const Model *m, const MeasureSpec *s, Diag *diag)
{
  PetscBool has;
  char path[256];

  PetscFunctionBeginUser;
  if (strcmp(s->kind, "reaction") != 0 || m->c->boundary[s->boundary].absent) PetscFunctionReturn(0);
  PetscCall(BoundaryHasOwn(m->boundary, m->grid, s->boundary, &has));
  if (has) PetscFunctionReturn(0);
  snprintf(path, sizeof path, "measures.%s.of.boundary", s->name);
  diag_warning(diag, path,
               "all that boundary[%d] prescribes is prescribed by other entries, too, which bear it: its reaction is 0",
               (int)s->boundary);
  diag_hint(
    diag,
    "what several entries prescribe counts to the plane side across it, else to the first of them: write this one "
    "before the others");
  PetscFunctionReturn(0);
}

PetscErrorCode ModelAdvise(const Model *m, Diag *diag)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; m->walls && k < m->c->n_walls; ++k) {
    advise_wall(m, k, diag);
    advise_terrain(m, k, diag);
  }
  advise_jumps(m, diag);
  PetscCall(AdviseUnits(m, diag));
  for (PetscInt b = 0; b < m->c->n_bodies; ++b)
    for (PetscInt i = 0; i < m->c->n_materials; ++i)
      if (!strcmp(m->c->bodies[b].material, m->c->materials[i].name)) PetscCall(AdviseLocking(m, b, i, diag));
  PetscCall(AdviseSharing(m, diag));
  PetscCall(AdviseThin(m, diag));
  PetscCall(AdviseCells(m, diag));
  PetscCall(AdvisePulses(m, diag));
  PetscCall(AdviseWaves(m, diag));
  advise_down(m, diag);
  advise_late(m, diag);
  advise_dilatancy(m, diag);
  advise_cones(m, diag);
  PetscCall(AdviseRows(m, diag));
  for (PetscInt k = 0; k < m->c->n_measures; ++k) PetscCall(AdviseReaction(m, m->c->measures + k, diag));
  PetscFunctionReturn(0);
}
