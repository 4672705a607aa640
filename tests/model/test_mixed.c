/* The mixed formulation as a whole: patch test, tangent, Cook's membrane against values of an
 * independent code, volume, momentum, numbers of points and of ranks, and which materials it
 * takes. */
#include "case_builder.h"
#include "material/pressure.h"
#include "model/model_private.h"

/* --- materials --- */
typedef struct {
  const char *law;
  PetscInt n;
  NamedValue value[6];
} Solid;

#define N(name, number)  \
  {                      \
    (char *)name, number \
  }
static const Solid solids[] = {
  {"neo-hookean-split", 2, {N("young", 1e6), N("poisson", 0.3)}},
  {"neo-hookean-split-log", 2, {N("young", 1e6), N("poisson", 0.5)}},
  {"neo-hookean", 2, {N("young", 1e6), N("poisson", 0.49)}},
  {"j2", 4, {N("young", 1e6), N("poisson", 0.4999), N("yield_stress", 3e4), N("hardening", 1e5)}},
  {"j2-log", 4, {N("young", 1e6), N("poisson", 0.5), N("yield_stress", 3e4), N("hardening", 0)}},
  {"mohr-coulomb", 4, {N("young", 1e6), N("bulk", INFINITY), N("friction_angle", 0), N("cohesion", 2e4)}},
  {"mohr-coulomb",
   5,
   {N("young", 1e6), N("poisson", 0.45), N("friction_angle", 30), N("dilatancy_angle", 5), N("cohesion", 5e4)}},
};

static void use_solid(Bench *b, const Solid *solid)
{
  b->c.formulation = (char *)"mixed";
  b->c.mixed.stabilisation = 8;
  b->material.law = (char *)solid->law;
  b->material.n_parameters = solid->n;
  b->material.parameters = (NamedValue *)solid->value;
}

/* --- patch test --- */
/* x(t) = F(t) X, F = R(t) (1 + t G): a strain, and a rotation but in rings. */
static void gradient_at(const Kinematics *kinematics, PetscReal t, PetscReal F[9])
{
  static const PetscReal plane[9] = {0.15, 0.18, 0, -0.07, -0.1, 0, 0, 0, 0},
                         space[9] = {0.12, 0.15, -0.06, -0.08, -0.1, 0.11, 0.05, -0.09, 0.2},
                         ring[9] = {0.1, 0, 0, 0, -0.2, 0, 0, 0, 0.1};
  const PetscReal *G = kinematics->hoop ? ring : (kinematics->dim == 2 ? plane : space);
  const PetscReal turn = kinematics->hoop ? 0 : 0.7 * t, c = cos(turn), s = sin(turn);
  const PetscReal R[9] = {c, -s, 0, s, c, 0, 0, 0, 1};
  PetscReal S[9];
  for (int i = 0; i < 9; ++i) S[i] = (i % 4 == 0) + t * G[i];
  tensor_multiply(R, S, F);
}

static void affine_motion(void *context, const PetscReal *x, PetscReal t0, PetscReal t1, PetscReal *increment)
{
  const Kinematics *kinematics = context;
  PetscReal F0[9], F1[9];
  gradient_at(kinematics, t0, F0);
  gradient_at(kinematics, t1, F1);
  affine_increment(kinematics->dim, F0, F1, x, increment);
}

/* Stress and pressure as the law alone gives them, and nodes with the same pressure. */
static void check_patch(const Model *m)
{
  PetscReal F[9], initial[LAW_MAX_STATE], state[LAW_MAX_STATE], tau[6], worst[3] = {0, 0, 0};
  const Material *material = &m->materials[0];
  gradient_at(m->c->kinematics, m->time, F);
  law_initial_state(material->law, initial);
  CHECK(material->law->update(material->parameters, 1, F, initial, state, tau, NULL) == LAW_OK, "no stress");
  const PetscReal p = pressure_of_state(material, state, tau);
  for (PetscInt k = 0; k < m->points->n; ++k) {
    PetscReal f[9], t[6];
    point_F(m->points, k, f);
    point_tau(m->points, k, t);
    for (int i = 0; i < 9; ++i) worst[0] = PetscMax(worst[0], PetscAbsReal(f[i] - F[i]));
    for (int i = 0; i < m->points->components[POINT_TAU]; ++i)
      worst[1] = PetscMax(worst[1], PetscAbsReal(t[i] - tau[i]) / 1e6);
    worst[2] = PetscMax(worst[2], PetscAbsReal(m->points->real[POINT_PRESSURE][k] - p) / 1e6);
  }
  for (PetscInt node = 0; node < m->grid->n_nodes; ++node)
    if (m->nodes->touched[node]) worst[2] = PetscMax(worst[2], PetscAbsReal(m->nodes->pressure[node] - p) / 1e6);
  for (int k = 0; k < 3; ++k) CHECK(worst[k] <= 1e-10, "number %d is off by %g", k, (double)worst[k]);
}

static void patch(const char *method, CellType cell, const Kinematics *kinematics, const Solid *solid,
                  PetscBool distorted, PetscInt halved)
{
  Bench b;
  const PetscBool is_mpm = !strcmp(method, "mpm"), is_3d = cell >= CELL_TETRAHEDRON;
  const PetscReal below = is_mpm ? -0.5 : 0, above = 1 - below, planes[] = {below, 0, 1, above};
  const PetscInt dim = is_3d ? 3 : 2;
  bench_init(&b, method, cell, 0);
  b.c.kinematics = kinematics;
  use_solid(&b, solid);
  bench_grid(&b, (PetscReal[]){kinematics->hoop ? 0 : below, below, below}, (PetscReal[]){above, above, above},
             is_3d ? 0.5 : 0.25);
  b.body[0].weights = WEIGHTS_GAUSS;
  b.halved = halved;
  if (distorted) bench_distort(&b, 0.2, 4, planes);
  if (!is_mpm) b.c.analysis.step = b.c.analysis.largest = 0.5;
  for (int d = 0; d < dim; ++d)
    for (int side = 0; side < 2; ++side) bench_motion(&b, d, side, MOTION_FIXED, 7);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  m->boundary->field = affine_motion;
  m->boundary->field_context = (void *)kinematics;
  while (m->time < 1 - 1e-9) CHECK(model_step(m, 1 - m->time).cuts == 0, "the step was halved");
  check_patch(m);
  CALL(ModelDestroy(&m));
  bench_end(&b);
}

static void test_patch(void **state)
{
  static const char *const method[] = {"fem", "mpm"};
  (void)state;
  for (CellType cell = CELL_TRIANGLE; cell <= CELL_HEXAHEDRON; ++cell)
    for (int k = 0; k < 2; ++k)
      for (int distorted = 0; distorted < 2; ++distorted) {
        const Kinematics *straight = cell < CELL_TETRAHEDRON ? &kinematics_plane_strain : &kinematics_3d;
        patch(method[k], cell, straight, &solids[0], distorted != 0, 0);
        patch(method[k], cell, straight, &solids[2], distorted != 0, 0);
        if (cell >= CELL_TETRAHEDRON) continue;
        patch(method[k], cell, &kinematics_axisymmetric, &solids[0], distorted != 0, 0);
        patch(method[k], cell, &kinematics_axisymmetric, &solids[2], distorted != 0, 0);
      }
  for (int k = 0; k < 2; ++k) { /* some are two triangles */
    patch(method[k], CELL_QUADRILATERAL, &kinematics_plane_strain, &solids[2], PETSC_TRUE, 3);
    patch(method[k], CELL_QUADRILATERAL, &kinematics_axisymmetric, &solids[2], PETSC_TRUE, 3);
  }
}

/* --- tangent --- */
typedef struct {
  Model *m;
  Random random;
  PetscReal *du, *pressure; /* the state about which differences are taken */
} Subject;

/* What a node gets must not depend on the rank. */
static PetscReal node_noise(const Subject *s, PetscInt node, PetscInt component, PetscInt seed)
{
  Random random = {(uint64_t)(s->m->grid->global_node[node] * 64 + component * 8 + seed)};
  for (int k = 0; k < 3; ++k) (void)random_bits(&random);
  return random_real(&random, -1, 1);
}

/* Residual of all free unknowns at du + h d, p + h d; values too if asked for. */
static void residual(const Subject *s, PetscReal h, PetscInt seed, PetscBool tangent, Vec out)
{
  Model *m = s->m;
  const PetscInt dim = m->dim, n = m->grid->n_nodes;
  for (PetscInt node = 0; node < n; ++node) {
    for (PetscInt d = 0; d < dim; ++d)
      m->nodes->du[node * dim + d] =
        s->du[node * dim + d] + (m->nodes->fixed[node * dim + d] ? 0 : h * node_noise(s, node, d, seed));
    m->nodes->scaled_pressure[node] =
      s->pressure[node] + (m->nodes->idle[node] ? 0 : h * node_noise(s, node, dim, seed));
  }
  CALL(PetscArrayzero(m->nodes->force, n * dim));
  CALL(PetscArrayzero(m->nodes->volume, n));
  CALL(SystemWantSlots(m->system, PETSC_FALSE));
  CALL(SystemZero(m->system));
  WeakFormInput in = weak_form_of(m, m->c->analysis.type == ANALYSIS_DYNAMIC ? 40 : 0);
  WeakFormOutput o = {.force = m->nodes->force,
                      .volume = m->nodes->volume,
                      .values = tangent ? m->system->values : NULL,
                      .slot = m->system->slot};
  CALL(m->formulation->assemble(&in, &o));
  CHECK(o.status == LAW_OK, "no stress");
  CALL(GridSumToOwners(m->grid, dim, m->nodes->force));
  CALL(GridSumToOwners(m->grid, 1, m->nodes->volume));
  for (PetscInt node = 0; node < m->grid->n_owned; ++node) {
    for (PetscInt d = 0; d < dim; ++d)
      if (m->nodes->fixed[node * dim + d]) m->nodes->force[node * dim + d] = 0;
    if (m->nodes->idle[node]) m->nodes->volume[node] = 0;
  }
  CALL(SystemFromNodes(m->system, m->nodes->force, 0, dim, out));
  CALL(SystemFromNodes(m->system, m->nodes->volume, dim, 1, out));
}

static void direction(const Subject *s, PetscInt seed, Vec out)
{
  Model *m = s->m;
  for (PetscInt node = 0; node < m->grid->n_owned; ++node) {
    for (PetscInt d = 0; d < m->dim; ++d)
      m->nodes->force[node * m->dim + d] = m->nodes->fixed[node * m->dim + d] ? 0 : node_noise(s, node, d, seed);
    m->nodes->volume[node] = m->nodes->idle[node] ? 0 : node_noise(s, node, m->dim, seed);
  }
  CALL(SystemFromNodes(m->system, m->nodes->force, 0, m->dim, out));
  CALL(SystemFromNodes(m->system, m->nodes->volume, m->dim, 1, out));
}

static void check_tangent(const char *method, const char *basis, CellType cell, PetscBool ring, const Solid *solid,
                          PetscBool dynamic)
{
  Bench b;
  Subject s = {.random = {5}};
  Vec x, y, plus, minus;
  PetscReal off, size;
  const PetscReal h = 1e-6;
  bench_init(&b, method, cell, 2);
  if (ring) b.c.kinematics = &kinematics_axisymmetric;
  use_solid(&b, solid);
  b.c.basis.kind = basis;
  b.body[0].shape.max[0] = 0.5;
  if (dynamic) bench_dynamic(&b, 1, 0.01);
  bench_motion(&b, 1, 0, MOTION_FIXED, 7);
  s.m = bench_model(&b, PETSC_COMM_WORLD);
  CALL(ModelActivate(s.m));
  /* symmetric tangents leave out how the pressure that bears the weight goes with the nodes */
  for (PetscInt d = 0; d < s.m->dim && !s.m->symmetric; ++d) s.m->gravity[d] = 1e3 * (PetscReal)(d + 1);
  /* as if cells were not full */
  for (PetscInt g = 0; s.m->space->soft && g < s.m->space->support->n_groups; ++g) {
    s.m->space->soft[g] = 1e4 * (PetscReal)(g + 1);
    s.m->space->tie[g] = 10 * (PetscReal)(g + 1);
    s.m->space->pressure_tie[g] = 1e-8 * (PetscReal)(g + 1);
  }
  for (PetscInt i = 0; i < s.m->grid->n_nodes * s.m->dim; ++i)
    s.m->nodes->fixed[i] = s.m->boundary->fixed[i] || !s.m->nodes->touched[i / s.m->dim];
  for (PetscInt i = 0; i < s.m->grid->n_nodes; ++i) s.m->nodes->idle[i] = !s.m->nodes->touched[i];
  CALL(PetscCalloc2(s.m->grid->n_nodes * s.m->dim, &s.du, s.m->grid->n_nodes, &s.pressure));
  for (PetscInt node = 0; node < s.m->grid->n_nodes; ++node) {
    for (PetscInt d = 0; d < s.m->dim; ++d) s.du[node * s.m->dim + d] = 0.06 * node_noise(&s, node, d, 1);
    s.pressure[node] = 0.05 * node_noise(&s, node, s.m->dim, 1);
  }
  CALL(SystemCreateVec(s.m->system, &x));
  CALL(VecDuplicate(x, &y));
  CALL(VecDuplicate(x, &plus));
  CALL(VecDuplicate(x, &minus));
  residual(&s, 0, 0, PETSC_TRUE, y);
  CALL(SystemPrescribe(s.m->system, s.m->nodes->fixed, s.m->nodes->idle));
  CALL(SystemToMatrix(s.m->system));
  if (s.m->symmetric) {
    PetscBool is;
    CALL(MatIsSymmetric(s.m->system->matrix, 1e-9 * b.constants[0].value, &is));
    CHECK(is, "%s: not symmetric", solid->law);
  }
  for (PetscInt seed = 2; seed < 5; ++seed) {
    direction(&s, seed, x);
    CALL(MatMult(s.m->system->matrix, x, y));
    residual(&s, h, seed, PETSC_FALSE, plus);
    residual(&s, -h, seed, PETSC_FALSE, minus);
    CALL(VecAXPY(plus, -1, minus));
    CALL(VecAXPY(y, -0.5 / h, plus));
    CALL(VecNorm(y, NORM_2, &off));
    CALL(VecNorm(plus, NORM_2, &size));
    CHECK(off <= 2e-7 * size * 0.5 / h, "%s, %s cell %d: off by %g", solid->law, method, (int)cell,
          (double)(off / (size * 0.5 / h)));
  }
  CALL(VecDestroy(&x));
  CALL(VecDestroy(&y));
  CALL(VecDestroy(&plus));
  CALL(VecDestroy(&minus));
  CALL(PetscFree2(s.du, s.pressure));
  CALL(ModelDestroy(&s.m));
}

static void test_tangent(void **state)
{
  (void)state;
  for (CellType cell = CELL_TRIANGLE; cell <= CELL_HEXAHEDRON; ++cell)
    for (size_t k = 0; k < sizeof solids / sizeof solids[0]; ++k)
      for (int ring = 0; ring < (cell < CELL_TETRAHEDRON ? 2 : 1); ++ring)
        check_tangent(k % 2 ? "mpm" : "fem", "cell", cell, ring != 0, &solids[k], k % 3 == 0);
  for (size_t k = 0; k < sizeof solids / sizeof solids[0]; ++k) {
    check_tangent("mpm", "gimp", CELL_QUADRILATERAL, PETSC_FALSE, &solids[k], k % 3 == 0);
    check_tangent("mpm", "gimp", CELL_QUADRILATERAL, PETSC_TRUE, &solids[k], k % 3 == 1);
    check_tangent("mpm", "gimp", CELL_HEXAHEDRON, PETSC_FALSE, &solids[k], k % 3 == 2);
    check_tangent("mpm", "bspline", CELL_QUADRILATERAL, k % 2 == 0, &solids[k], k % 3 == 1);
  }
}

/* --- Cook's membrane --- */
static void cook_place(void *context, PetscInt dim, PetscReal size, PetscReal *x)
{
  const PetscReal s = x[0], low = 44 * s, high = 44 + 16 * s;
  (void)context, (void)dim, (void)size;
  x[0] = 48 * s;
  x[1] = low + (high - low) * x[1];
}

/* Clamped at x = 0, pulled up by 1 N at x = 48; E = 70 Pa; triangles cut from low left to high
 * right. */
static void cook(Bench *b, CellType cell, PetscInt n, PetscReal nu, PetscInt points, PetscReal alpha)
{
  static NamedValue value[2];
  static PetscReal outline[] = {0, 0, 48, 44, 48, 60, 0, 44};
  bench_init(b, "fem", cell, n);
  use_solid(b, &(Solid){.law = "neo-hookean-split"});
  value[0] = (NamedValue)N("young", 70);
  value[1] = (NamedValue)N("poisson", nu);
  b->material.n_parameters = 2;
  b->material.parameters = value;
  b->c.mixed.stabilisation = alpha;
  /* 1e-12 lies below the round-off of 512 cells without stabilisation */
  b->c.newton.residual = 1e-11;
  b->body[0].points_per_cell = points;
  b->body[0].weights = WEIGHTS_GAUSS;
  b->body[0].shape = (Shape){.kind = SHAPE_POLYGON, .n_vertices = 4, .vertices = outline};
  bench_mesh(b, cook_place, NULL);
  bench_motion(b, 0, 0, MOTION_FIXED, 3);
  bench_traction(b, 0, 48, NULL, 0, 0.0625, 0);
  bench_tracer(b, "displacement", 1, 48, 60, 0);
}

static PetscReal corner(Model *m)
{
  PetscReal value;
  CALL(ModelMeasure(m, &m->c->measures[0], 0, &value));
  return value;
}

static PetscReal cook_corner(CellType cell, PetscInt n, PetscReal nu, PetscInt points, PetscReal alpha,
                             const char *formulation)
{
  Bench b;
  cook(&b, cell, n, nu, points, alpha);
  b.c.formulation = (char *)formulation;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  CHECK(model_step(m, 1).cuts == 0, "the step was halved");
  const PetscReal value = corner(m);
  CALL(ModelDestroy(&m));
  bench_end(&b);
  return value;
}

/* Values of an independent code (five digits; see docs/theory.md for the formulation that they
 * share). */
static void test_cook(void **state)
{
  static const struct {
    PetscInt n;
    PetscReal nu, alpha, corner;
  } row[] = {{4, 0.4999, 8, 0.19203}, {8, 0.4999, 8, 0.24096}, {8, 0.4999, 0, 0.18407},
             {8, 0.4999, 1, 0.22095}, {16, 0.33, 0, 0.29498},  {8, 0.33, 8, 0.26586},
             {8, 0.33, 1, 0.25529},   {2, 0.4999, 0, 0.07861}, {8, 0.999999 / 2, 0, 0.18362}};
  (void)state;
  for (size_t k = 0; k < sizeof row / sizeof row[0]; ++k) {
    const PetscReal value = cook_corner(CELL_TRIANGLE, row[k].n, row[k].nu, 1, row[k].alpha, "mixed");
    CHECK_CLOSE(value, row[k].corner, 6e-6);
  }
  CHECK_CLOSE(cook_corner(CELL_TRIANGLE, 8, 0.4999, 1, 0, "displacement"), 0.07446,
              6e-6); /* locked: a third of the converged value */
}

/* 16 cells a side with the program's default stabilisation, against the limit of fine meshes
 * (cases/cook); displacements alone lock. */
static void test_locking(void **state)
{
  const PetscReal limit = 0.2762;
  (void)state;
  CHECK_CLOSE(cook_corner(CELL_QUADRILATERAL, 16, 0.4999, 4, 2, "mixed"), limit, 0.02 * limit);
  CHECK_CLOSE(cook_corner(CELL_QUADRILATERAL, 16, 0.4999, 4, 2, "mean-dilatation"), limit, 0.0205 * limit);
  const PetscReal u = cook_corner(CELL_TRIANGLE, 16, 0.4999, 1, 0, "displacement");
  CHECK(u < 0.3 * limit, "the displacement formulation should lock: %g m", (double)u);
}

/* Exactly incompressible: the limit of nearly so, with any number of points in a cell the same
 * equations. */
static void test_incompressible(void **state)
{
  const PetscReal one = cook_corner(CELL_TRIANGLE, 8, 0.5, 1, 8, "mixed"),
                  near = cook_corner(CELL_TRIANGLE, 8, 0.4999999, 1, 8, "mixed");
  (void)state;
  CHECK_CLOSE(one, near, 1e-6);
  for (PetscInt points = 3; points <= 12; points *= 2)
    CHECK_CLOSE(cook_corner(CELL_TRIANGLE, 8, 0.5, points, 8, "mixed"), one, 1e-9);
}

/* Newton's residuals fall quadratically, and the volume of the whole membrane stays. */
static void test_newton(void **state)
{
  Bench b;
  PetscReal local[2] = {0, 0}, all[2]; /* volume, its change */
  (void)state;
  cook(&b, CELL_TRIANGLE, 8, 0.5, 3, 8);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  const StepReport r = model_step(m, 1);
  CHECK(r.newton.iterations <= 5 && r.cuts == 0, "%d iterations", (int)r.newton.iterations);
  const PetscReal *h = r.newton.residual;
  const PetscInt last = r.newton.iterations;
  CHECK(h[last] <= 1e-10, "residual %g", (double)h[last]);
  CHECK(h[last - 1] > 1e-8 || h[last - 2] > 1e-4, "not quadratic: %g %g %g", (double)h[last - 2], (double)h[last - 1],
        (double)h[last]);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    local[0] += m->points->real[POINT_VOLUME][p];
    local[1] += m->points->real[POINT_VOLUME][p] * (m->points->real[POINT_J][p] - 1);
  }
  CALL(MPI_Allreduce(local, all, 2, MPIU_REAL, MPI_SUM, m->comm));
  CHECK(PetscAbsReal(all[1]) <= 1e-10 * all[0], "the volume changed by %g", (double)(all[1] / all[0]));
  CALL(ModelDestroy(&m));
  bench_end(&b);
}

/* Share of the nodal pressure that alternates from node to node: sum over cells of what the
 * projection takes away. */
static PetscReal roughness(PetscReal alpha)
{
  Bench b;
  PetscReal local[2] = {0, 0}, all[2];
  cook(&b, CELL_TRIANGLE, 8, 0.4999, 1, alpha);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  (void)model_step(m, 1);
  for (PetscInt k = 0; k < m->grid->n_cells; ++k) {
    PetscReal mean = 0;
    for (int i = 0; i < 3; ++i) mean += m->nodes->pressure[m->grid->cell_node[3 * k + i]] / 3;
    for (int i = 0; i < 3; ++i) local[0] += PetscSqr(m->nodes->pressure[m->grid->cell_node[3 * k + i]] - mean);
    local[1] += mean * mean;
  }
  CALL(MPI_Allreduce(local, all, 2, MPIU_REAL, MPI_SUM, m->comm));
  CALL(ModelDestroy(&m));
  bench_end(&b);
  return PetscSqrtReal(all[0] / all[1]);
}

static void test_checkerboard(void **state)
{
  const PetscReal without = roughness(0), with = roughness(8);
  (void)state;
  CHECK(without > 4 * with, "%g without, %g with stabilisation", (double)without, (double)with);
}

/* --- dynamics --- */
/* A free body that turns, flies and is out of balance keeps its momentum. */
static void momentum(const char *method, const char *basis, CellType cell, const Solid *solid)
{
  Bench b;
  bench_init(&b, method, cell, 0);
  use_solid(&b, solid);
  b.c.basis.kind = basis;
  bench_grid(&b, (PetscReal[]){-0.5, -0.5, -0.5}, (PetscReal[]){1.5, 1.5, 1.5}, 0.25);
  if (strcmp(method, "mpm")) bench_grid(&b, (PetscReal[]){0, 0, 0}, (PetscReal[]){1, 1, 1}, 0.25);
  b.body[0].velocity[0] = 3;
  b.body[0].velocity[1] = -1;
  b.body[0].spin[2] = 10;
  bench_dynamic(&b, 0.03, 0.003);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  PetscReal before[2];
  for (PetscInt d = 0; d < 2; ++d) before[d] = model_sum(m, "momentum", d);
  for (int k = 0; k < 10; ++k) (void)model_step(m, 0.003);
  for (PetscInt d = 0; d < 2; ++d) CHECK_CLOSE(model_sum(m, "momentum", d), before[d], 1e-7 * 1000);
  CALL(ModelDestroy(&m));
}

static void test_momentum(void **state)
{
  (void)state;
  for (CellType cell = CELL_TRIANGLE; cell <= CELL_QUADRILATERAL; ++cell) {
    momentum("fem", "cell", cell, &solids[0]);
    momentum("mpm", "cell", cell, &solids[0]);
    momentum("mpm", "cell", cell, &solids[1]);
    momentum("mpm", "cell", cell, &solids[4]);
  }
  momentum("mpm", "gimp", CELL_QUADRILATERAL, &solids[0]);
  momentum("mpm", "gimp", CELL_QUADRILATERAL, &solids[4]);
}

/* --- ranks --- */
static void ranks(const char *method, const char *basis, CellType cell, PetscBool ring, const Solid *solid,
                  PetscBool dynamic)
{
  Bench b;
  bench_init(&b, method, cell, 4);
  if (ring) b.c.kinematics = &kinematics_axisymmetric;
  use_solid(&b, solid);
  b.c.basis.kind = basis;
  b.body[0].shape.max[1] = 0.75;
  b.c.gravity[1] = -20;
  if (dynamic) bench_dynamic(&b, 0.01, 0.002);
  else b.c.analysis.step = b.c.analysis.largest = 0.2;
  bench_motion(&b, 1, 0, MOTION_FIXED, 7);
  Model *m = bench_model(&b, PETSC_COMM_WORLD), *serial = bench_model(&b, PETSC_COMM_SELF);
  for (int k = 0; k < 5; ++k) {
    (void)model_step(m, 1);
    (void)model_step(serial, 1);
  }
  const PetscReal move = points_difference(m, serial, POINT_U), press = points_difference(m, serial, POINT_PRESSURE);
  CHECK(move <= 1e-9, "points are off by %g m", (double)move);
  CHECK(press <= 1e-4, "pressures are off by %g Pa", (double)press);
  CALL(ModelDestroy(&m));
  CALL(ModelDestroy(&serial));
}

static void test_ranks(void **state)
{
  (void)state;
  for (int ring = 0; ring < 2; ++ring) {
    ranks("fem", "cell", CELL_TRIANGLE, (PetscBool)ring, &solids[1], PETSC_FALSE);
    ranks("mpm", "cell", CELL_QUADRILATERAL, (PetscBool)ring, &solids[3], PETSC_TRUE);
    ranks("mpm", "cell", CELL_TRIANGLE, (PetscBool)ring, &solids[5], PETSC_TRUE);
    ranks("mpm", "gimp", CELL_QUADRILATERAL, (PetscBool)ring, &solids[1], PETSC_TRUE);
  }
  ranks("mpm", "cell", CELL_TETRAHEDRON, PETSC_FALSE, &solids[0], PETSC_FALSE);
  ranks("mpm", "gimp", CELL_HEXAHEDRON, PETSC_FALSE, &solids[5], PETSC_FALSE);
}

/* --- geostatic start --- */
/* A layer that starts with the stress of its weight stays where it is; without that it would settle
 * by millimetres. */
static void geostatic(const char *method, const Solid *solid, PetscReal k0, PetscReal alpha)
{
  Bench b;
  PetscReal largest = 0, off = 0;
  bench_init(&b, method, CELL_TRIANGLE, 4);
  use_solid(&b, solid);
  b.c.mixed.stabilisation = alpha; /* incompressible: just enough to determine all pressures */
  b.c.newton.residual = 1e-10;
  b.c.gravity[1] = -10;
  b.c.gravity_amplitude = (Amplitude){.n = 1, .time = (PetscReal[]){0}, .value = (PetscReal[]){1}};
  b.body[0].has_k0 = PETSC_TRUE;
  b.body[0].k0 = k0;
  b.body[0].surface = 1;
  bench_motion(&b, 1, 0, MOTION_FIXED, 3);
  for (int side = 0; side < 2; ++side) bench_motion(&b, 0, side, MOTION_FIXED, 1);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  CHECK(model_step(m, 1).cuts == 0, "the step was halved");
  for (PetscInt p = 0; p < m->points->n; ++p) {
    PetscReal sigma[6];
    CALL(ModelPointStress(m, p, sigma));
    off = PetscMax(off, PetscAbsReal(sigma[1] + 1e4 * (1 - point_real(m->points, POINT_X, p)[1])));
    for (int d = 0; d < 2; ++d) largest = PetscMax(largest, PetscAbsReal(point_real(m->points, POINT_U, p)[d]));
  }
  /* in a corner that belongs to one triangle only the stabilisation tells an incompressible body's
   * pressure */
  CHECK(largest <= (alpha > 0 ? 5e-6 : 1e-8), "%s: moved by %g m", solid->law, (double)largest);
  CHECK(off <= (alpha > 0 ? 150 : 0.1), "%s: stress off by %g Pa", solid->law, (double)off);
  CALL(ModelDestroy(&m));
}

static void test_geostatic(void **state)
{
  static const char *const method[] = {"fem", "mpm"};
  (void)state;
  for (int k = 0; k < 2; ++k) {
    geostatic(method[k], &solids[0], 0.4, 0);
    geostatic(method[k], &solids[1], 1, 0.01);
    geostatic(method[k], &solids[5], 1, 0.01);
    geostatic(method[k], &solids[6], 0.8, 0);
  }
}

/* --- what is refused --- */
static void test_refused(void **state)
{
  static const Solid hard[] = {
    {"neo-hookean", 2, {N("young", 1e6), N("poisson", 0.5)}},
    {"mohr-coulomb", 4, {N("young", 1e6), N("poisson", 0.5), N("friction_angle", 30), N("cohesion", 0)}},
    {"mohr-coulomb",
     5,
     {N("young", 1e6), N("poisson", 0.5), N("friction_angle", 0), N("cohesion", 10), N("tension_cutoff", 1)}}};
  Bench b;
  (void)state;
  for (size_t k = 0; k < sizeof hard / sizeof hard[0]; ++k) {
    bench_init(&b, "fem", CELL_TRIANGLE, 2);
    use_solid(&b, &hard[k]);
    bench_refused(&b, PETSC_COMM_WORLD, "materials.rubber", "cannot be exactly incompressible");
  }
  bench_init(&b, "fem", CELL_TRIANGLE, 2);
  use_solid(&b, &solids[1]);
  b.c.formulation = (char *)"displacement";
  bench_refused(&b, PETSC_COMM_WORLD, "materials.rubber.poisson", "formulation: mixed");
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_patch),    cmocka_unit_test(test_tangent),        cmocka_unit_test(test_cook),
    cmocka_unit_test(test_newton),   cmocka_unit_test(test_incompressible), cmocka_unit_test(test_checkerboard),
    cmocka_unit_test(test_momentum), cmocka_unit_test(test_ranks),          cmocka_unit_test(test_geostatic),
    cmocka_unit_test(test_refused),  cmocka_unit_test(test_locking),
  };
  return run_model_tests_in_turns(argc, argv, tests);
}
