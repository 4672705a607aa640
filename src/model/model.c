#include "model/model.h"
#include "method/transfer/transfer.h"
#include "model/measure/measure.h"
#include "model/model_private.h"
#include "base/process/memory.h"

/* Work of a cell with this centre, in points: balances the partition. */
static PetscReal cell_weight(void *context, const PetscReal *centre)
{
  const Case *c = context;
  const PetscInt dim = kinematics_dim(c->kinematics);
  for (PetscInt b = 0; b < c->n_bodies; ++b)
    if (c->bodies[b].has_shape && !c->bodies[b].absent && shape_contains(&c->bodies[b].shape, dim, centre, 0))
      return (PetscReal)c->bodies[b].points_per_cell + cell_work(c->grid.cell);
  return 0;
}

/* The pressure of an exactly incompressible body has no memory: what alternates from step to step
 * in it stays for ever. */
static void check_ringing(const Model *m, const Material *material, Diag *diag)
{
  if (diag_errors(diag) || !m->formulation->pressure || material->compliance > 0) return;
  if (m->scheme->weights(&m->c->analysis, m->c->analysis.step).mean > 0.5) return;
  diag_warning(
    diag, "analysis.bossak",
    "material '%s' is exactly incompressible: without numerical damping its pressure and reactions ring from "
    "step to step",
    material->name);
  diag_hint(diag, "bossak: -0.1 damps that and little else");
}

/* Beyond the speed of light a step of a usual size crosses so many cells in waves that inertia
 * drowns in the round-off of stiffness. */
static void check_waves(const Material *material, Diag *diag)
{
  const PetscReal light = 3e8, speed = PetscSqrtReal(material->wave_modulus / material->density);
  char path[256];
  if (speed <= light) return;
  PetscSNPrintf(path, sizeof path, "materials.%s", material->name);
  diag_error(
    diag, path,
    "waves would run through '%s' at %.3g m/s, faster than light: its stiffness and its density cannot both be meant",
    material->name, (double)speed);
  diag_hint(diag, "a body that may count as rigid needs no more than waves much faster than its motion");
}

/* Will the tangents of material i stay symmetric throughout? */
static PetscBool stays_symmetric(const Case *c, PetscInt i, const Material *material)
{
  const PetscBool varies =
    c->analysis.type == ANALYSIS_FACTOR || c->strength.factor > 0 || c->materials[i].n_amplitudes > 0;
  if (case_is_mixed(c) && material->volume == VOLUME_COUPLED) return PETSC_FALSE;
  return material_symmetric(material, varies);
}

static PetscErrorCode CreateMaterials(Model *m, Diag *diag)
{
  const Case *c = m->c;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(c->n_materials, &m->materials));
  m->symmetric = !contact_rubs(c) && !case_load_follows(c) && !(m->scheme->inertia && contact_turns(c));
  for (PetscInt i = 0; i < c->n_materials; ++i) {
    Material *material = &m->materials[i];
    PetscCall(MaterialResolve(c, i, diag, material));
    if (!material->law) continue;
    if (m->scheme->inertia) check_ringing(m, material, diag);
    if (m->scheme->inertia) check_waves(material, diag);
    m->n_state = PetscMax(m->n_state, material->law->n_state);
    if (!stays_symmetric(c, i, material)) m->symmetric = PETSC_FALSE;
    m->courant_speed = PetscMax(m->courant_speed, PetscSqrtReal(material->wave_modulus / material->density));
  }
  PetscFunctionReturn(0);
}

/* outline: NULL where nobody asks how much material is above. */
static PetscErrorCode CreatePoints(Model *m, Outline *outline, Diag *diag)
{
  const Case *c = m->c;
  PointSeed *seed;
  PetscReal *initial;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(c->n_materials, &seed, c->n_materials * LAW_MAX_STATE, &initial));
  for (PetscInt i = 0; i < c->n_materials; ++i) {
    seed[i] = (PointSeed){.density = m->materials[i].density,
                          .n_state = m->materials[i].law->n_state,
                          .initial = initial + i * LAW_MAX_STATE};
    law_initial_state(m->materials[i].law, initial + i * LAW_MAX_STATE);
  }
  PetscCall(PointsCreate(m->dim, m->n_state, 0, &m->points));
  /* nothing is stored yet */
  if (m->formulation->pressure) m->points->components[POINT_PRESSURE] = 1;
  if (basis_find(c->basis.kind)->domains) m->points->components[POINT_DOMAIN] = m->dim;
  /* what lumped mass does not see of a rotation: nothing is lumped where points have domains, but in explicit steps */
  const PetscBool lumps = !basis_find(c->basis.kind)->domains || c->analysis.type == ANALYSIS_EXPLICIT;
  if (transfer_find(c->analysis.transfer)->slopes && lumps) m->points->components[POINT_SLOPE] = 2 * m->dim * m->dim;
  if (c->n_walls + c->n_interfaces) m->points->components[POINT_REACH] = 1;
  if (m->points->components[POINT_REACH]) m->points->components[POINT_CORNER] = m->dim;
  if (m->points->components[POINT_REACH]) m->points->components[POINT_FACE] = m->dim;
  if (c->n_interfaces) m->points->components[POINT_BESIDE] = m->dim;
  m->points->components[POINT_CONTACT] =
    (c->n_walls + c->n_interfaces) * contact_kept_partner(m->dim, contact_sides(c));
  if (m->grid->n_fields > 1 || (m->method->clouds && c->n_interfaces)) m->points->components[POINT_FIELD] = 1;
  m->points->components[POINT_FLOW] = c->stabilisation.room || case_writes(c, "plastic_increment") || raised_hardens(m);
  m->points->components[POINT_MECHANISM] = case_writes(c, "mechanism") ? m->dim : 0;
  for (PetscInt k = 0; k < c->n_measures; ++k)
    m->points->components[POINT_CARRIED] += measure_find(c->measures[k].kind)->events != NULL;
  PetscCall(PointsSeedOutlined(m->points, m->grid, c, seed, m->method->restores_grid, outline, diag));
  /* nothing moves in statics, nor in a stage after it because a body was told to at the start */
  if (!m->scheme->inertia) PetscCall(PetscArrayzero(m->points->real[POINT_V], m->points->n * m->dim));
  PetscCall(PetscFree2(seed, initial));
  PetscFunctionReturn(0);
}

/* Collective. The body whose point is nearest to x. */
static PetscErrorCode NearestBody(const Model *m, const PetscReal *x, PetscInt *body)
{
  struct {
    double square;
    int rank;
  } local, all;
  PetscReal square;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(m->comm, &rank));
  const PetscInt p = points_near(m->points, x, &square);
  local.square = (double)square, local.rank = rank;
  PetscCallMPI(MPI_Allreduce(&local, &all, 1, MPI_DOUBLE_INT, MPI_MINLOC, m->comm));
  *body = p >= 0 ? m->points->body[p] : 0;
  PetscCallMPI(MPI_Bcast(body, 1, MPIU_INT, all.rank, m->comm));
  PetscFunctionReturn(0);
}

/* One tracer per measure that follows one; the lowest rank whose cells hold it keeps it. */
static PetscErrorCode CreateTracers(Model *m, Diag *diag)
{
  PetscMPIInt rank, size, mine, first;
  PetscReal xi[3];
  char path[256];
  PetscInt i, body;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(m->comm, &rank));
  PetscCallMPI(MPI_Comm_size(m->comm, &size));
  PetscCall(FollowersCreate(m->dim, 0, &m->tracers));
  m->tracers->components[POINT_FIELD] = m->points->components[POINT_FIELD];
  for (PetscInt k = 0; k < m->c->n_measures; ++k) {
    const MeasureSpec *s = &m->c->measures[k];
    if (!measure_has_tracer(s)) continue;
    const PetscInt field = points_field_near(m->points, s->tracer);
    const PetscInt cell = grid_cell_in(m->grid, grid_locate(m->grid, s->tracer, -1, xi), field);
    mine = cell >= 0 ? rank : size;
    PetscCallMPI(MPI_Allreduce(&mine, &first, 1, MPI_INT, MPI_MIN, m->comm));
    if (first == size) {
      PetscCall(PetscSNPrintf(path, sizeof path, "measures.%s.of.tracer", s->name));
      diag_error(diag, path, "the tracer starts outside the grid");
    }
    PetscCall(NearestBody(m, s->tracer, &body));
    if (first != rank) continue;
    PetscCall(PointsAppend(m->tracers, &i));
    m->tracers->cell[i] = cell;
    m->tracers->id[i] = k;
    m->tracers->body[i] = k;
    if (m->tracers->components[POINT_FIELD]) m->tracers->real[POINT_FIELD][i] = (PetscReal)field;
    for (PetscInt d = 0; d < m->dim; ++d) {
      point_real(m->tracers, POINT_X, i)[d] = s->tracer[d];
      point_real(m->tracers, POINT_XI, i)[d] = xi[d];
    }
    if (m->c->n_bodies && m->scheme->inertia)
      body_velocity(m->c->bodies + body, m->dim, s->tracer, point_real(m->tracers, POINT_V, i));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ModelCreateFields(Model *m)
{
  const Discretisation parts = {.c = m->c,
                                .grid = m->grid,
                                .points = m->points,
                                .tracers = m->tracers,
                                .boundary = m->boundary,
                                .loads = m->loads,
                                .materials = m->materials};

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(m->grid->n_cells, &m->enabled));
  for (PetscInt i = 0; m->formulation->pressure && i < m->c->n_materials; ++i)
    m->pressure_scale = PetscMax(m->pressure_scale, m->materials[i].elastic.shear / m->grid->smallest);
  PetscCall(DiscretisationCreate(&parts, &m->space));
  m->nodes = m->space->nodes;
  PetscFunctionReturn(0);
}

PetscErrorCode ModelDestroyFields(Model *m)
{
  PetscFunctionBeginUser;
  if (m->space && m->method->destroy) PetscCall(m->method->destroy(m->space));
  PetscCall(ExplicitDestroy(&m->explicit));
  PetscCall(DiscretisationDestroy(&m->space));
  PetscCall(PetscFree(m->enabled));
  PetscFunctionReturn(0);
}

/* Do bodies bring meshes into a grid whose nodes are free of these? */
static PetscBool brings_meshes(const Model *m)
{
  for (PetscInt b = 0; b < m->c->n_bodies && m->method->restores_grid; ++b)
    if (m->c->bodies[b].mesh && !m->c->bodies[b].absent) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Bodies become points, with the stress that they start with. */
static PetscErrorCode CreateBodies(Model *m, Diag *diag)
{
  Outline outline = {0};
  PetscInt errors;

  PetscFunctionBeginUser;
  PetscCall(CreatePoints(m, case_has_stress(m->c) || brings_meshes(m) ? &outline : NULL, diag));
  PetscCall(SplitCheck(m, diag));
  PetscCall(DiagReduce(m->comm, diag, &errors));
  if (!errors && brings_meshes(m)) PetscCall(AdviseOwnMeshes(m, &outline, diag));
  if (!errors) places_start(m);
  if (!errors) PetscCall(InitialStress(m, &outline, diag));
  for (PetscInt p = 0; p < m->points->n && !errors; ++p) size_start(m, p);
  PetscCall(DiagReduce(m->comm, diag, &errors));
  if (!errors && !case_goes_on(m->c)) stresses_check(m, diag); /* else when the state has given its stresses */
  PetscCall(OutlineClear(&outline));
  PetscFunctionReturn(0);
}

#define ALL_LAYERS (1 << 24) /* more than a box has */

/* Layers of cells beyond a rank's own whose nodes it must know; of a mesh those at its boundary where bodies meet. A
 * box that moves with its bodies takes them anywhere. */
static PetscInt layers_beyond(const Model *m)
{
  const Case *c = m->c;
  if (c->n_interfaces && !m->method->restores_grid && !m->method->clouds) return ALL_LAYERS;
  const PetscInt lap = c->analysis.type == ANALYSIS_EXPLICIT; /* points cross cells before they change ranks */
  const PetscInt meets = c->n_interfaces ? CONTACT_HALO : 0;
  /* coarse nodes beside a node (solve/levels) */
  const PetscBool box = (PetscBool)(c->grid.kind == GRID_BOX && !m->method->clouds);
  const PetscInt levels = box && case_is_static(&c->analysis) && !m->formulation->pressure;
  if (c->grid.kind != GRID_BOX) return meets;
  return PetscMax(basis_find(c->basis.kind)->halo, levels) + lap + meets;
}

/* Ranks know other nodes in each stage: outputs ask each stage's own model where they were drawn. */
static PetscErrorCode KeepDrawn(Model *m)
{
  PetscFunctionBeginUser;
  if (!m->method || m->method->restores_grid || m->method->clouds || !m->c->staged) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(m->grid->n_nodes * m->dim, &m->drawn));
  PetscCall(PetscArraycpy(m->drawn, m->grid->x, m->grid->n_nodes * m->dim));
  PetscFunctionReturn(0);
}

#define LIGHT 1e-3 /* Newton's method gains as many digits an iteration without it */

/* Does weight strain a cell so much that Newton's method misses what symmetric tangents leave out: how the pressure
 * that bears it goes with the nodes (formulation/kernels/mixed_kernels.h)? */
static PetscBool is_heavy(const Model *m)
{
  const PetscReal *g = m->c->gravity, pull = PetscSqrtReal(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
  const PetscBool bears = (PetscBool)(m->formulation && m->formulation->pressure);
  for (PetscInt i = 0; bears && i < m->c->n_materials; ++i) {
    const Material *material = m->materials + i;
    const PetscReal weight = material->density * pull * m->grid->smallest;
    if (m->c->mixed.stabilisation * weight > LIGHT * 12 * material->elastic.shear) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

static PetscErrorCode FindWeighing(Model *m)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(m->c->n_bodies, &m->weighs));
  for (PetscInt b = 0; b < m->c->n_bodies; ++b)
    m->weighs[b] = (PetscBool)(m->c->bodies[b].bears || case_is_static(&m->c->analysis));
  PetscFunctionReturn(0);
}

/* Materials, the grid, and the points that bodies become; *good: without mistakes. */
static PetscErrorCode BuildBodies(Model *m, Diag *diag, PetscBool *good)
{
  PetscInt errors;

  PetscFunctionBeginUser;
  *good = PETSC_FALSE;
  m->method = method_find(m->c->method);
  m->formulation = formulation_find(m->c->formulation);
  m->scheme = time_scheme_of(&m->c->analysis);
  supported_check(m, diag);
  if (m->formulation && m->scheme) PetscCall(CreateMaterials(m, diag));
  PetscCall(DiagReduce(m->comm, diag, &errors));
  if (errors) PetscFunctionReturn(0);
  strength_start(m, diag);
  equilibrium_check(m, diag);
  raised_start(m, diag);
  PetscCall(GridCreate(m->comm, m->c, cell_weight, (void *)m->c, diag, &m->grid));
  if (!m->grid) PetscFunctionReturn(0);
  if (is_heavy(m)) m->symmetric = PETSC_FALSE;
  PetscCall(FindWeighing(m));
  PetscCall(GridWiden(&m->grid, layers_beyond(m)));
  PetscCall(KeepDrawn(m));
  PetscCall(CreateBodies(m, diag));
  raised_advise(m, diag);
  PetscCall(DiagReduce(m->comm, diag, &errors));
  *good = (PetscBool)!errors;
  PetscFunctionReturn(0);
}

/* Everything after the parts that stand alone; each may find mistakes that make the next
 * meaningless. */
static PetscErrorCode Build(Model *m, Diag *diag)
{
  PetscInt errors;
  PetscBool good;

  PetscFunctionBeginUser;
  PetscCall(BuildBodies(m, diag, &good));
  if (!good) PetscFunctionReturn(0);
  PetscCall(WallsStart(m, diag));
  PetscCall(BoundaryCreate(m->grid, m->c, m->points, diag, &m->boundary));
  PetscCall(LoadsCreate(m->grid, m->c, m->points, m->method->restores_grid, diag, &m->loads));
  PetscCall(CreateTracers(m, diag));
  measures_check(m, diag);
  PetscCall(ModelAdvise(m, diag));
  PetscCall(AdviseOpenDrum(m, diag));
  PetscCall(DiagReduce(m->comm, diag, &errors));
  if (errors) PetscFunctionReturn(0);
  if (m->method->clouds) PetscCall(ModelToCloud(m));
  PetscCall(ModelCreateFields(m));
  PetscCall(SystemCreate(m->comm, m->dim, m->dim + (m->formulation->pressure ? 1 : 0), &m->system));
  PetscCall(NewtonCreate(m->comm, &m->c->newton, &m->newton));
  step_control_start(&m->control, m->c->analysis.step);
  PetscCall(ModelInitialise(m));
  PetscCall(ForcesCreate(m, diag));
  if (m->method->clouds) PetscCall(ModelWarnOfObstacles(m, diag));
  PetscCall(CheckLevel(m, diag));
  PetscCall(AdviseBeside(m, diag));
  if (!m->time) PetscCall(AdviseHangs(m, diag));
  if (!m->time) PetscCall(AdviseStairs(m, diag));
  if (!m->time && !case_goes_on(m->c)) PetscCall(AstrideLook(m));
  astride_tell(m, diag);
  PetscCall(AdvisePassing(m, diag));
  /* later bodies and walls are elsewhere: ModelTake */
  if (!m->time) PetscCall(CheckHeld(m, (PetscBool)!case_goes_on(m->c), diag));
  if (m->scheme->inertia) PetscCall(InitialAcceleration(m));
  else PetscCall(InitialReactions(m));
  PetscCall(EnergyStart(m));
  PetscCall(MeasuresStart(m));
  PetscCall(FollowersStart(m, diag));
  PetscCall(OutsideWarn(m, diag));
  PetscFunctionReturn(0);
}

static PetscErrorCode NewModel(MPI_Comm comm, const Case *c, Model **model)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(model));
  (*model)->comm = comm;
  (*model)->c = c;
  (*model)->dim = kinematics_dim(c->kinematics);
  (*model)->initial = (InitialState){.lacked = NAN, .left = NAN, .moved = NAN};
  (*model)->time = c->start; /* what a stage moves stands where it begins then */
  PetscFunctionReturn(0);
}

PetscErrorCode ModelCellSizes(const Case *c, Diag *diag, PetscReal *range)
{
  Model *m;
  PetscBool good;

  PetscFunctionBeginUser;
  PetscCall(NewModel(PETSC_COMM_SELF, c, &m));
  PetscCall(BuildBodies(m, diag, &good));
  PetscCall(PetscArrayzero(range, 2 * c->n_bodies));
  if (good) sizes_of_bodies(m, range);
  PetscCall(ModelDestroy(&m));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelCreate(MPI_Comm comm, const Case *c, Diag *diag, Model **model)
{
  Model *m;
  PetscInt errors;

  PetscFunctionBeginUser;
  *model = NULL;
  PetscCall(NewModel(comm, c, &m));
  PetscCall(OptionsApply(m));
  PetscCall(MemoryHeld(comm, diag, &m->machine_memory));
  PetscCall(OptionsCheck(m, diag));
  PetscCall(Build(m, diag));
  PetscCall(DiagReduce(comm, diag, &errors));
  if (errors || !m->space) PetscCall(ModelDestroy(&m));
  *model = m;
  PetscFunctionReturn(0);
}

PetscErrorCode ModelDestroy(Model **model)
{
  Model *m = *model;

  PetscFunctionBeginUser;
  if (!m) PetscFunctionReturn(0);
  PetscCall(OptionsForget(m));
  PetscCall(NodalForcesDestroy(&m->forces));
  PetscCall(ContactDestroy(&m->contact));
  PetscCall(WallsDestroy(&m->walls));
  PetscCall(NewtonDestroy(&m->newton));
  PetscCall(SystemDestroy(&m->system));
  PetscCall(ModelDestroyFields(m));
  if (m->loads) PetscCall(LoadsDestroy(&m->loads));
  if (m->boundary) PetscCall(BoundaryDestroy(&m->boundary));
  if (m->tracers) PetscCall(PointsDestroy(&m->tracers));
  if (m->points) PetscCall(PointsDestroy(&m->points));
  if (m->grid) PetscCall(GridDestroy(&m->grid));
  PetscCall(PetscFree(m->drawn));
  PetscCall(PetscFree(m->balanced));
  PetscCall(PetscFree(m->remainder));
  PetscCall(PetscFree(m->weighs));
  PetscCall(PetscFree(m->pull));
  PetscCall(PetscFree(m->let_go));
  PetscCall(PetscFree(m->astride));
  PetscCall(PetscFree(m->raised.nodal));
  PetscCall(PetscFree2(m->unheld.dof, m->unheld.turns));
  PetscCall(PetscFree(m->materials));
  PetscCall(MeasuresEnd(m));
  PetscCall(PetscFree(m->load_memory));
  PetscCall(PetscFree(*model));
  PetscFunctionReturn(0);
}
