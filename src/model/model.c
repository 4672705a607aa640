#include "model/model.h"
#include "model/model_private.h"

/* Work of a cell with this centre, in points: balances the partition. */
static PetscReal cell_weight(void *context, const PetscReal *centre)
{
  const Case *c = context;
  const PetscInt dim = kinematics_dim(c->kinematics);
  for (PetscInt b = 0; b < c->n_bodies; ++b)
    if (c->bodies[b].has_shape && shape_contains(&c->bodies[b].shape, dim, centre, 0))
      return (PetscReal)c->bodies[b].points_per_cell + cell_work(c->grid.cell);
  return 0;
}

static void check_supported(const Case *c, Diag *diag)
{
  const Basis *basis = basis_find(c->basis.kind);
  if (c->kinematics == KINEMATICS_AXISYMMETRIC)
    diag_error(diag, "kinematics", "axisymmetric kinematics are not part of this version; plane-strain and 3d are");
  if (!method_find(c->method))
    diag_error(diag, "method", "method '%s' is not part of this version; mpm, fem and gmm are", c->method);
  if (!formulation_find(c->formulation))
    diag_error(diag, "formulation", "formulation '%s' is not part of this version; displacement and mixed are",
               c->formulation);
  else if (formulation_find(c->formulation)->pressure && !strcmp(c->method, "gmm"))
    diag_error(
      diag, "formulation",
      "formulation '%s' is not part of this version for method gmm, which takes displacement; mpm and fem take both",
      c->formulation);
  else if (formulation_find(c->formulation)->pressure && basis && basis->nodes != BASIS_OF_CELLS)
    diag_error(diag, "formulation", "formulation '%s' takes no other basis than 'cell', not '%s'", c->formulation,
               c->basis.kind);
  if (!basis || (method_find(c->method) && !method_takes(method_find(c->method), basis)))
    diag_error(diag, "basis", "method %s does not take the basis '%s'", c->method,
               c->basis.kind ? c->basis.kind : "cell");
  if (c->analysis.keep_velocity && strcmp(c->method, "mpm"))
    diag_error(diag, "analysis.keep_velocity",
               "only points of method mpm have a velocity apart from that of the nodes");
  for (PetscInt b = 0; b < c->n_bodies; ++b) {
    char path[64];
    PetscSNPrintf(path, sizeof path, "bodies[%d].mesh", (int)b);
    if (c->bodies[b].mesh && strcmp(c->method, "mpm"))
      diag_error(diag, path,
                 "a body with a mesh of its own needs method mpm; for fem and gmm give that mesh as grid.mesh");
  }
}

/* The pressure of an exactly incompressible body has no memory: what alternates from step to step in it stays for ever. */
static void check_ringing(const Case *c, const Material *material, Diag *diag)
{
  if (c->analysis.type != ANALYSIS_DYNAMIC || !case_is_mixed(c) || material->compliance > 0) return;
  if (c->analysis.gamma > 0.5) return;
  diag_warning(
    diag, "analysis.bossak",
    "material '%s' is exactly incompressible: without numerical damping its pressure and reactions ring from "
    "step to step",
    material->name);
  diag_hint(diag, "bossak: -0.1 damps that and little else");
}

/* Beyond the speed of light a step of a usual size crosses so many cells in waves that inertia drowns in the round-off of stiffness. */
static void check_waves(const Case *c, const Material *material, Diag *diag)
{
  const PetscReal light = 3e8, speed = PetscSqrtReal(material->wave_modulus / material->density);
  char path[256];
  if (c->analysis.type != ANALYSIS_DYNAMIC || speed <= light) return;
  PetscSNPrintf(path, sizeof path, "materials.%s", material->name);
  diag_error(
    diag, path,
    "waves would run through '%s' at %.3g m/s, faster than light: its stiffness and its density cannot both be meant",
    material->name, (double)speed);
  diag_hint(diag, "a body that may count as rigid needs no more than waves much faster than its motion");
}

static PetscErrorCode CreateMaterials(Model *m, Diag *diag)
{
  const Case *c = m->c;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(c->n_materials, &m->materials));
  m->symmetric = PETSC_TRUE;
  for (PetscInt i = 0; i < c->n_materials; ++i) {
    Material *material = &m->materials[i];
    PetscCall(MaterialResolve(c, i, diag, material));
    if (!material->law) continue;
    check_ringing(c, material, diag);
    check_waves(c, material, diag);
    m->n_state = PetscMax(m->n_state, material->law->n_state);
    if (!material->law->symmetric || (case_is_mixed(c) && material->volume == VOLUME_COUPLED))
      m->symmetric = PETSC_FALSE;
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
  if (m->formulation->pressure) m->points->components[POINT_PRESSURE] = 1; /* nothing is stored yet */
  PetscCall(PointsSeedOutlined(m->points, m->grid, c, seed, outline, diag));
  PetscCall(PetscFree2(seed, initial));
  PetscFunctionReturn(0);
}

static PetscBool is_of_tracer(const MeasureSpec *s)
{
  return s->kind == MEASURE_DISPLACEMENT || s->kind == MEASURE_POSITION || s->kind == MEASURE_VELOCITY;
}

/* One tracer per measure that follows one; the lowest rank whose cells hold it keeps it. */
static PetscErrorCode CreateTracers(Model *m, Diag *diag)
{
  PetscMPIInt rank, size, mine, first;
  PetscReal xi[3];
  char path[256];
  PetscInt i;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(m->comm, &rank));
  PetscCallMPI(MPI_Comm_size(m->comm, &size));
  PetscCall(FollowersCreate(m->dim, 0, &m->tracers));
  for (PetscInt k = 0; k < m->c->n_measures; ++k) {
    const MeasureSpec *s = &m->c->measures[k];
    if (!is_of_tracer(s)) continue;
    const PetscInt cell = grid_locate(m->grid, s->tracer, -1, xi);
    mine = cell >= 0 ? rank : size;
    PetscCallMPI(MPI_Allreduce(&mine, &first, 1, MPI_INT, MPI_MIN, m->comm));
    if (first == size) {
      PetscCall(PetscSNPrintf(path, sizeof path, "measures.%s.of.tracer", s->name));
      diag_error(diag, path, "the tracer starts outside the grid");
    }
    if (first != rank) continue;
    PetscCall(PointsAppend(m->tracers, &i));
    m->tracers->cell[i] = cell;
    m->tracers->id[i] = k;
    m->tracers->body[i] = k;
    for (PetscInt d = 0; d < m->dim; ++d) {
      point_real(m->tracers, POINT_X, i)[d] = s->tracer[d];
      point_real(m->tracers, POINT_XI, i)[d] = xi[d];
    }
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ModelCreateFields(Model *m)
{
  const PetscInt dofs = m->grid->n_nodes * m->dim;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(m->grid->n_cells, &m->enabled));
  PetscCall(PetscCalloc1(dofs, &m->fixed));
  PetscCall(PetscCalloc1(m->grid->n_nodes, &m->idle));
  if (m->formulation->pressure) {
    PetscCall(PetscCalloc1(m->grid->n_nodes, &m->pressure));
    PetscCall(PetscCalloc1(m->grid->n_nodes, &m->volume));
    for (PetscInt i = 0; i < m->c->n_materials; ++i)
      m->pressure_scale = PetscMax(m->pressure_scale, m->materials[i].elastic.shear / m->grid->smallest);
  }
  PetscReal **const scratch[] = {&m->du, &m->force, &m->external, &m->history, &m->prescribed, &m->previous};
  PetscReal **const kept[] = {&m->reaction, &m->held, &m->rate, &m->echo};
  static const char *const kept_names[] = {"reaction", "held", "rate", "echo"}, *const units[] = {"N", "N", "N",
                                                                                                  "m/s2"};
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(scratch); ++k) {
    PetscCall(PetscCalloc1(dofs, scratch[k]));
    if (m->grid->cloud) PetscCall(GridCloudFollow(m->grid, scratch[k], m->dim, NULL, NULL));
  }
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(kept); ++k) {
    PetscCall(PetscCalloc1(dofs, kept[k]));
    if (m->grid->cloud) PetscCall(GridCloudFollow(m->grid, kept[k], m->dim, kept_names[k], units[k]));
  }
  PetscCall(StageCreate(m->c, m->grid, m->points, m->tracers, m->loads, m->materials, &m->stage));
  m->stage->boundary = m->boundary;
  PetscFunctionReturn(0);
}

PetscErrorCode ModelDestroyFields(Model *m)
{
  PetscReal **const nodal[] = {&m->du,   &m->force, &m->external, &m->history,  &m->prescribed, &m->reaction,
                               &m->held, &m->rate,  &m->echo,     &m->pressure, &m->volume,     &m->previous};

  PetscFunctionBeginUser;
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(nodal); ++k) PetscCall(PetscFree(*nodal[k]));
  PetscCall(PetscFree(m->enabled));
  PetscCall(PetscFree(m->idle));
  PetscCall(PetscFree(m->fixed));
  PetscFunctionReturn(0);
}

/* Bodies become points, with the stress that they start with. */
static PetscErrorCode CreateBodies(Model *m, Diag *diag)
{
  Outline outline = {0};
  PetscInt errors;

  PetscFunctionBeginUser;
  PetscCall(CreatePoints(m, case_has_k0(m->c) ? &outline : NULL, diag));
  PetscCall(DiagReduce(m->comm, diag, &errors));
  if (!errors) PetscCall(InitialStress(m, &outline, diag));
  PetscCall(OutlineClear(&outline));
  PetscFunctionReturn(0);
}

/* Everything after the parts that stand alone; each may find mistakes that make the next meaningless. */
static PetscErrorCode Build(Model *m, Diag *diag)
{
  PetscInt errors;

  PetscFunctionBeginUser;
  check_supported(m->c, diag);
  PetscCall(CreateMaterials(m, diag));
  PetscCall(DiagReduce(m->comm, diag, &errors));
  if (errors) PetscFunctionReturn(0);
  m->method = method_find(m->c->method);
  m->formulation = formulation_find(m->c->formulation);
  PetscCall(GridCreate(m->comm, m->c, cell_weight, (void *)m->c, diag, &m->grid));
  if (!m->grid) PetscFunctionReturn(0);
  if (basis_find(m->c->basis.kind)->check) PetscCall(basis_find(m->c->basis.kind)->check(m->grid, diag));
  PetscCall(CreateBodies(m, diag));
  PetscCall(DiagReduce(m->comm, diag, &errors));
  if (errors) PetscFunctionReturn(0);
  PetscCall(BoundaryCreate(m->grid, m->c, diag, &m->boundary));
  PetscCall(LoadsCreate(m->grid, m->c, m->points, diag, &m->loads));
  PetscCall(CreateTracers(m, diag));
  model_advise(m, diag);
  PetscCall(DiagReduce(m->comm, diag, &errors));
  if (errors) PetscFunctionReturn(0);
  if (m->method->couplings) PetscCall(ModelToCloud(m));
  PetscCall(ModelCreateFields(m));
  PetscCall(SystemCreate(m->comm, m->dim, m->dim + (m->formulation->pressure ? 1 : 0), &m->system));
  PetscCall(NewtonCreate(m->comm, &m->c->newton, &m->newton));
  step_control_start(&m->control, m->c->analysis.step);
  PetscCall(m->method->initialise(m->stage));
  if (m->method->couplings) PetscCall(ModelWarnOfObstacles(m, diag));
  PetscCall(CheckHeld(m, diag));
  if (m->c->analysis.type == ANALYSIS_DYNAMIC) PetscCall(InitialAcceleration(m));
  PetscCall(EnergyStart(m));
  PetscCall(MeasuresStart(m));
  PetscCall(FollowersStart(m, diag));
  PetscCall(OutsideWarn(m, diag));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelCreate(MPI_Comm comm, const Case *c, Diag *diag, Model **model)
{
  Model *m;
  PetscInt errors;

  PetscFunctionBeginUser;
  *model = NULL;
  PetscCall(PetscNew(&m));
  m->comm = comm;
  m->c = c;
  m->dim = kinematics_dim(c->kinematics);
  PetscCall(OptionsApply(m));
  PetscCall(OptionsCheck(m, diag));
  PetscCall(Build(m, diag));
  PetscCall(DiagReduce(comm, diag, &errors));
  if (errors || !m->stage) PetscCall(ModelDestroy(&m));
  *model = m;
  PetscFunctionReturn(0);
}

PetscErrorCode ModelDestroy(Model **model)
{
  Model *m = *model;

  PetscFunctionBeginUser;
  if (!m) PetscFunctionReturn(0);
  PetscCall(OptionsForget(m));
  PetscCall(NewtonDestroy(&m->newton));
  PetscCall(SystemDestroy(&m->system));
  if (m->stage && m->method->destroy) PetscCall(m->method->destroy(m->stage));
  PetscCall(StageDestroy(&m->stage));
  if (m->loads) PetscCall(LoadsDestroy(&m->loads));
  if (m->boundary) PetscCall(BoundaryDestroy(&m->boundary));
  if (m->tracers) PetscCall(PointsDestroy(&m->tracers));
  if (m->points) PetscCall(PointsDestroy(&m->points));
  if (m->grid) PetscCall(GridDestroy(&m->grid));
  PetscCall(PetscFree(m->materials));
  PetscCall(ModelDestroyFields(m));
  PetscCall(PetscFree(m->memory));
  PetscCall(PetscFree(m->load_memory));
  PetscCall(PetscFree(*model));
  PetscFunctionReturn(0);
}
