/* Cases made by hand for tests of the whole solver, models from them, and checks that stop all
 * ranks together.
 *
 * A Bench owns a Case and all that it points to; it must not move, since the case holds its
 * addresses. */
#pragma once
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <unistd.h>
#include <cmocka.h>
#include "../conformance/random.h"
#include "base/math/tensor.h"
#include "model/model.h"

typedef struct {
  Case c;
  NamedValue constants[2];
  MaterialSpec material;
  BodySpec body[2];
  MotionSpec motion[8];
  LoadSpec load[4];
  MeasureSpec measure[6];
  Amplitude amplitude;
  PetscInt halved; /* in a mesh, of so many quadrilaterals one is two triangles; 0: none */
  char mesh[PETSC_MAX_PATH_LEN];
} Bench;

static inline PetscMPIInt ranks_of_world(void)
{
  PetscMPIInt ranks = 1;
  (void)MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  return ranks;
}

/* Do variants take turns on several ranks? TALUS_TEST_ALL=1: each of them runs on all numbers of ranks. */
static inline PetscBool take_turns(void) { return (PetscBool)(ranks_of_world() > 1 && !getenv("TALUS_TEST_ALL")); }

static inline size_t variants_apart(void) { return !take_turns() ? 1 : ranks_of_world() == 3 ? 4 : 2; }

/* Walks through variants. On several ranks they take turns, every other one on two and every fourth, from the second
 * on, on three: what ranks spoil they spoil in most of them, and a rank that waits costs more than one that works. */
#define EACH_VARIANT(k, n) \
  for (size_t k = take_turns() && ranks_of_world() == 3; k < (size_t)(n); k += variants_apart())
#define EACH_OF(k, list) EACH_VARIANT (k, PETSC_STATIC_ARRAY_LENGTH(list))
/* Triangles, quadrilaterals, tetrahedra, hexahedra up to `last`: the plane and space for any number of ranks. */
#define EACH_CELL(cell, last) \
  for (CellType cell = (CellType)(take_turns() && ranks_of_world() == 3); cell <= (last); cell += take_turns() ? 2 : 1)

/* A failed check on one rank ends all: the others would wait for it in a collective call for
 * ever. */
#define CHECK(condition, ...)                                         \
  do {                                                                \
    if (!(condition)) {                                               \
      PetscMPIInt ranks_;                                             \
      MPI_Comm_size(PETSC_COMM_WORLD, &ranks_);                       \
      fprintf(stderr, "%s:%d: %s: ", __FILE__, __LINE__, #condition); \
      fprintf(stderr, __VA_ARGS__);                                   \
      fprintf(stderr, "\n");                                          \
      if (ranks_ > 1) MPI_Abort(PETSC_COMM_WORLD, 1);                 \
      fail();                                                         \
    }                                                                 \
  } while (0)
#define CALL(call) CHECK((call) == 0, "a call failed")
#define CHECK_CLOSE(value, expected, tolerance)                                                                     \
  CHECK(PetscAbsReal((value) - (expected)) <= (tolerance), "%.16g, not %.16g, off by %.3g > %.3g", (double)(value), \
        (double)(expected), (double)PetscAbsReal((value) - (expected)), (double)(tolerance))

/* Statics in one step of a body of neo-Hookean rubber (E = 1 MPa, nu = 0.3, 1000 kg/m3) on a grid
 * of the unit square or cube. */
static inline void bench_init(Bench *b, const char *method, CellType cell, PetscInt cells_per_side)
{
  const PetscBool is_3d = cell >= CELL_TETRAHEDRON;
  static const PetscInt points[] = {3, 4, 4, 8};
  *b = (Bench){0};
  b->constants[0] = (NamedValue){"young", 1e6};
  b->constants[1] = (NamedValue){"poisson", 0.3};
  b->material = (MaterialSpec){
    .name = "rubber", .law = "neo-hookean", .density = 1000, .n_parameters = 2, .parameters = b->constants};
  b->body[0] =
    (BodySpec){.name = "body", .material = "rubber", .has_shape = PETSC_TRUE, .points_per_cell = points[cell]};
  b->body[0].shape = (Shape){.kind = SHAPE_BOX, .max = {1, 1, 1}};
  b->c = (Case){
    .kinematics = is_3d ? &kinematics_3d : &kinematics_plane_strain,
    .method = (char *)method,
    .formulation = "displacement",
    .analysis = {.type = ANALYSIS_STATIC,
                 .end = 1,
                 .step = 1,
                 .smallest = 1. / 1024,
                 .largest = 1,
                 .contact = 1,
                 .beta = 0.25,
                 .gamma = 0.5},
    .grid = {.kind = GRID_BOX, .cell = cell, .max = {1, 1, 1}, .grading = {1, 1, 1}},
    .n_bodies = 1,
    .bodies = b->body,
    .n_materials = 1,
    .materials = &b->material,
    .boundary = b->motion,
    .loads = b->load,
    .measures = b->measure,
    .newton = {.residual = 1e-12, .increment = 1e-12, .max_iterations = 25, .ease = 6},
    .linear = LINEAR_DIRECT,
    .stabilisation = {.stiffness = 1e-6, .mass = 0.1, .curvature = 0.01, .follow = 0.02},
  };
  for (int d = 0; d < (is_3d ? 3 : 2); ++d) b->c.grid.counts[d] = cells_per_side;
}

static inline void bench_grid(Bench *b, const PetscReal min[3], const PetscReal max[3], PetscReal size)
{
  for (int d = 0; d < kinematics_dim(b->c.kinematics); ++d) {
    b->c.grid.min[d] = min[d];
    b->c.grid.max[d] = max[d];
    b->c.grid.counts[d] = (PetscInt)((max[d] - min[d]) / size + 0.5);
  }
}

static inline void bench_box(Bench *b, PetscInt body, const PetscReal min[3], const PetscReal max[3])
{
  b->body[body].shape = (Shape){.kind = SHAPE_BOX, .min = {min[0], min[1], min[2]}, .max = {max[0], max[1], max[2]}};
}

/* Dynamics with trapezoidal rule. */
static inline void bench_dynamic(Bench *b, PetscReal end, PetscReal step)
{
  b->c.analysis.type = ANALYSIS_DYNAMIC;
  b->c.analysis.end = end;
  b->c.analysis.step = b->c.analysis.largest = step;
  b->c.analysis.smallest = step / 1024;
}

/* Prescribe the components in mask (bit d) of all nodes on the plane x_axis = at; axis < 0: the
 * whole outer boundary. */
static inline MotionSpec *bench_motion(Bench *b, int axis, PetscReal at, MotionKind kind, unsigned mask)
{
  MotionSpec *m = &b->motion[b->c.n_boundary++];
  *m = (MotionSpec){.kind = kind};
  for (int d = 0; d < 3; ++d) m->component[d] = mask >> d & 1;
  if (axis >= 0) {
    m->on.has[axis] = PETSC_TRUE;
    m->on.min[axis] = m->on.max[axis] = at;
  }
  return m;
}

static inline LoadSpec *bench_traction(Bench *b, int axis, PetscReal at, const char *body, PetscReal x, PetscReal y,
                                       PetscReal z)
{
  LoadSpec *load = &b->load[b->c.n_loads++];
  *load = (LoadSpec){.kind = LOAD_TRACTION, .value = {x, y, z}};
  load->on.body = (char *)body;
  load->on.has[axis] = PETSC_TRUE;
  load->on.min[axis] = load->on.max[axis] = at;
  return load;
}

static inline MeasureSpec *bench_tracer(Bench *b, const char *kind, PetscInt component, PetscReal x, PetscReal y,
                                        PetscReal z)
{
  MeasureSpec *m = &b->measure[b->c.n_measures++];
  *m = (MeasureSpec){.name = "tracer", .kind = (char *)kind, .component = component, .tracer = {x, y, z}};
  return m;
}

static inline Model *bench_model(Bench *b, MPI_Comm comm)
{
  Diag *diag;
  Model *model = NULL;
  CALL(DiagCreate(&diag));
  CALL(ModelCreate(comm, &b->c, diag, &model));
  CALL(DiagFlush(diag, stderr));
  CALL(DiagDestroy(&diag));
  CHECK(model, "the case was refused");
  return model;
}

/* Stands for the case reader: says the path itself instead of the place in a file. */
static inline void show_path(void *context, const char *path, DiagPlace *place)
{
  (void)context;
  *place = (DiagPlace){.file = path};
}

/* What making a model of the case says, on the first rank: to be freed. *model NULL: it was refused. */
static inline char *bench_said(Bench *b, MPI_Comm comm, Model **model)
{
  Diag *diag;
  char *text = NULL;
  size_t size;
  FILE *out = open_memstream(&text, &size);
  CALL(DiagCreate(&diag));
  CALL(DiagSetResolver(diag, show_path, NULL));
  *model = NULL;
  CALL(ModelCreate(comm, &b->c, diag, model));
  CALL(DiagFlush(diag, out));
  fclose(out);
  CALL(DiagDestroy(&diag));
  return text;
}

/* The case must be refused with a message about `path` that holds `words`. */
static inline void bench_refused(Bench *b, MPI_Comm comm, const char *path, const char *words)
{
  PetscMPIInt rank;
  Model *model;
  char *text = bench_said(b, comm, &model);
  CHECK(!model, "the case was accepted");
  MPI_Comm_rank(comm, &rank);
  if (!rank) CHECK(strstr(text, path) && strstr(text, words), "no '%s' and '%s' in: %s", path, words, text);
  free(text);
}

/* It must be taken, with such a message, or, without words, with none about `path`. */
static inline void bench_warned(Bench *b, MPI_Comm comm, const char *path, const char *words)
{
  PetscMPIInt rank;
  Model *model;
  char *text = bench_said(b, comm, &model);
  CHECK(model, "the case was refused: %s", text);
  CALL(ModelDestroy(&model));
  MPI_Comm_rank(comm, &rank);
  if (!rank && !words) CHECK(!strstr(text, path), "it says %s", text);
  if (!rank && words) CHECK(strstr(text, path) && strstr(text, words), "no '%s' and '%s' in: %s", path, words, text);
  free(text);
}

static inline StepReport model_step(Model *model, PetscReal limit)
{
  StepReport report;
  CALL(ModelStep(model, limit, &report));
  CHECK(report.outcome == STEP_ACCEPTED, "step %d: %s", (int)model->step, report.reason);
  return report;
}

/* what: a measure as the case file has it, "momentum" or "energy: kinetic". */
static inline PetscReal model_sum(Model *model, const char *what, PetscInt component)
{
  char kind[32], word[32] = "";
  PetscReal value;
  sscanf(what, "%31[^:]: %31s", kind, word);
  const MeasureSpec measure = {.kind = kind, .word = word, .component = component};
  CALL(ModelMeasure(model, &measure, 0, &value));
  return value;
}

/* Of a wall: kind and word of a measure as the case file has them, "contact", "area". */
static inline PetscReal model_wall(Model *model, const char *wall, const char *kind, const char *word,
                                   PetscInt component)
{
  const MeasureSpec measure = {
    .kind = (char *)kind, .word = (char *)word, .component = component, .wall = (char *)wall};
  PetscReal value;
  CALL(ModelMeasure(model, &measure, 0, &value));
  return value;
}

static inline PetscReal model_max(const Model *model, PetscReal local)
{
  PetscReal all;
  CALL(MPI_Allreduce(&local, &all, 1, MPIU_REAL, MPIU_MAX, model->comm));
  return all;
}

/* Cauchy stress of the neo-Hookean law from F, written down again: lambda ln J I + mu (b - I), over
 * J. */
static inline void rubber_stress(const PetscReal F[9], PetscReal sigma[6])
{
  const PetscReal E = 1e6, nu = 0.3, mu = E / (2 * (1 + nu)), lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
  const PetscReal J =
    F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) + F[2] * (F[3] * F[7] - F[4] * F[6]);
  for (int k = 0; k < 6; ++k) {
    const int i = voigt_row[k], j = voigt_column[k];
    const PetscReal one = i == j, b = F[3 * i] * F[3 * j] + F[3 * i + 1] * F[3 * j + 1] + F[3 * i + 2] * F[3 * j + 2];
    sigma[k] = (lambda * log(J) * one + mu * (b - one)) / J;
  }
}

/* Largest difference of a field between the points of two models, matched by id; `serial` holds all
 * points on each rank. */
static inline PetscReal points_difference(const Model *parallel, const Model *serial, PointReal field)
{
  const Points *a = parallel->points, *s = serial->points;
  PetscReal largest = 0;
  PetscInt64 last = 0;
  PetscInt *at;
  for (PetscInt p = 0; p < s->n; ++p) last = PetscMax(last, s->id[p]);
  CALL(PetscMalloc1(last + 1, &at));
  for (PetscInt64 i = 0; i <= last; ++i) at[i] = -1;
  for (PetscInt p = 0; p < s->n; ++p) at[s->id[p]] = p;
  for (PetscInt p = 0; p < a->n; ++p) {
    CHECK(a->id[p] <= last && at[a->id[p]] >= 0, "point %d is missing", (int)a->id[p]);
    for (PetscInt k = 0; k < a->components[field]; ++k) {
      const PetscReal off = PetscAbsReal(point_real(a, field, p)[k] - point_real(s, field, at[a->id[p]])[k]);
      CHECK(!PetscIsInfOrNanReal(off), "point %d is nowhere", (int)a->id[p]);
      largest = PetscMax(largest, off);
    }
  }
  CALL(PetscFree(at));
  PetscInt n;
  CALL(ModelCountPoints(parallel, &n));
  CHECK(n == s->n, "%d points, not %d", (int)n, (int)s->n);
  return model_max(parallel, largest);
}

/* Is the coordinate one of the planes that must stay plane? */
static inline PetscBool on_plane(PetscReal x, PetscInt n, const PetscReal *plane)
{
  for (PetscInt i = 0; i < n; ++i)
    if (PetscAbsReal(x - plane[i]) < 1e-9) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Replace the box grid of the case by a Gmsh file of the same cells whose nodes are put elsewhere.
 * Collective; bench_end removes the file. */
typedef void (*BenchPlace)(void *context, PetscInt dim, PetscReal size, PetscReal *x);

/* An element of the file. */
static inline void bench_element(FILE *out, PetscInt number, int type, PetscInt n, const PetscInt *node)
{
  fprintf(out, "%d %d 2 0 1", (int)number, type);
  for (PetscInt i = 0; i < n; ++i) fprintf(out, " %d", (int)node[i] + 1);
  fprintf(out, "\n");
}

static inline void bench_elements(const Bench *b, const Grid *grid, FILE *out)
{
  static const int msh_type[] = {2, 3, 4, 5};
  const PetscInt nn = grid->nodes_per_cell, n_halved = b->halved ? (grid->n_cells + b->halved - 1) / b->halved : 0;
  PetscInt number = 0;
  fprintf(out, "$EndNodes\n$Elements\n%d\n", (int)(grid->n_cells + n_halved));
  for (PetscInt k = 0; k < grid->n_cells; ++k) {
    const PetscInt *node = grid->cell_node + k * nn;
    if (!b->halved || k % b->halved) {
      bench_element(out, ++number, msh_type[grid->type], nn, node);
      continue;
    }
    bench_element(out, ++number, msh_type[CELL_TRIANGLE], 3, node);
    bench_element(out, ++number, msh_type[CELL_TRIANGLE], 3, (PetscInt[]){node[2], node[3], node[0]});
  }
  fprintf(out, "$EndElements\n");
}

static inline void bench_mesh(Bench *b, BenchPlace place, void *context)
{
  PetscMPIInt rank;
  char folder[] = "/tmp/talus-test-XXXXXX";
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  if (!rank) {
    Diag *diag;
    Grid *grid = NULL;
    CALL(DiagCreate(&diag));
    CALL(GridCreate(PETSC_COMM_SELF, &b->c, NULL, NULL, diag, &grid));
    CHECK(grid, "no grid");
    CHECK(mkdtemp(folder), "no temporary folder");
    snprintf(b->mesh, sizeof b->mesh, "%s/grid.msh", folder);
    FILE *out = fopen(b->mesh, "w");
    fprintf(out, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n", (int)grid->n_nodes);
    for (PetscInt i = 0; i < grid->n_nodes; ++i) {
      PetscReal *x = grid->x + i * grid->dim;
      place(context, grid->dim, grid->smallest, x);
      fprintf(out, "%d", (int)i + 1);
      for (PetscInt d = 0; d < 3; ++d) fprintf(out, " %.17g", d < grid->dim ? x[d] : 0.0);
      fprintf(out, "\n");
    }
    bench_elements(b, grid, out);
    fclose(out);
    CALL(GridDestroy(&grid));
    CALL(DiagDestroy(&diag));
  }
  MPI_Bcast(b->mesh, sizeof b->mesh, MPI_CHAR, 0, PETSC_COMM_WORLD);
  b->c.grid.kind = GRID_MESH;
  b->c.grid.mesh = b->mesh;
}

typedef struct {
  Random random;
  PetscReal amount;
  PetscInt n_planes;
  const PetscReal *plane;
} BenchDistortion;

static inline void bench_shake(void *context, PetscInt dim, PetscReal size, PetscReal *x)
{
  BenchDistortion *d = context;
  PetscBool keep = PETSC_FALSE;
  for (PetscInt i = 0; i < dim; ++i) keep |= on_plane(x[i], d->n_planes, d->plane);
  for (PetscInt i = 0; i < dim && !keep; ++i) x[i] += d->amount * size * random_real(&d->random, -1, 1);
}

/* Nodes displaced at random by up to `amount` of the smallest cell; those on one of the planes (of
 * any axis) stay. */
static inline void bench_distort(Bench *b, PetscReal amount, PetscInt n_planes, const PetscReal *plane)
{
  BenchDistortion distortion = {.random = {7}, .amount = amount, .n_planes = n_planes, .plane = plane};
  bench_mesh(b, bench_shake, &distortion);
}

static inline void bench_end(Bench *b)
{
  PetscMPIInt rank;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  if (b->mesh[0] && !rank) {
    unlink(b->mesh);
    *strrchr(b->mesh, '/') = 0;
    rmdir(b->mesh);
  }
}

/* What prescribes the affine motion x = F X between two instants: dx = (F1 F0^-1 - 1) x at the
 * place x of the first. */
static inline void affine_increment(PetscInt dim, const PetscReal F0[9], const PetscReal F1[9], const PetscReal *x,
                                    PetscReal *increment)
{
  PetscReal inverse[9], ratio[9];
  tensor_inverse(F0, inverse);
  tensor_multiply(F1, inverse, ratio);
  for (PetscInt i = 0; i < dim; ++i) {
    increment[i] = -x[i];
    for (PetscInt j = 0; j < dim; ++j) increment[i] += ratio[3 * i + j] * x[j];
  }
}

/* turns: on several ranks every other test. */
static inline int run_model_some(int argc, char **argv, const struct CMUnitTest *tests, size_t n, PetscBool turns)
{
  struct CMUnitTest chosen[32];
  PetscMPIInt rank;
  size_t k = 0;
  if (n > PETSC_STATIC_ARRAY_LENGTH(chosen)) return 1;
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  if (rank && !freopen("/dev/null", "w", stdout)) return 1;
  turns = (PetscBool)(turns && take_turns());
  for (size_t i = turns && ranks_of_world() == 3; i < n; i += turns ? 2 : 1) chosen[k++] = tests[i];
  const int failed = _cmocka_run_group_tests("model", chosen, k, NULL, NULL);
  if (failed) MPI_Abort(PETSC_COMM_WORLD, 1);
  return PetscFinalize() ? 1 : failed;
}

#define run_model_group(argc, argv, tests, n) run_model_some(argc, argv, tests, n, PETSC_FALSE)
#define run_model_tests(argc, argv, tests) run_model_group(argc, argv, tests, PETSC_STATIC_ARRAY_LENGTH(tests))
/* Every other test on two ranks, the others on three. */
#define run_model_tests_in_turns(argc, argv, tests) \
  run_model_some(argc, argv, tests, PETSC_STATIC_ARRAY_LENGTH(tests), PETSC_TRUE)
