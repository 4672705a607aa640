/* What the solver's benchmarks share: cases made by hand, one isolated pass over the points,
 * memory, the machine's bandwidth.
 *
 * Included by one program each; everything is static. */
#pragma once
#include <malloc.h>
#include <stdio.h>
#include <time.h>
#include <unistd.h>
#include "model/model_private.h"
#include "points/fields.h"

typedef struct {
  Case c;
  NamedValue constants[2];
  MaterialSpec material;
  BodySpec body;
  MotionSpec motion;
} BenchCase;

/* A model and what is known of it before its first step. */
typedef struct {
  Model *model;
  PetscInt points;
  PetscReal bytes_before; /* resident memory without it */
} Subject;

/* Seconds of one pass at rest, each the best of several. */
typedef struct {
  PetscReal points; /* residual, tangent and scatter into blocks */
  PetscReal matrix; /* blocks -> matrix */
  PetscReal bytes;  /* that both must move */
} Pass;

static inline PetscReal seconds_now(void)
{
  PetscLogDouble t;
  PetscTime(&t);
  return t;
}

/* Seconds that a core has worked for this process: on a busy machine less than the clock says. */
static inline PetscReal processor_now(void)
{
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (PetscReal)t.tv_sec + 1e-9 * (PetscReal)t.tv_nsec;
}

/* What both cases have in common; `b` must not move afterwards. */
static inline void bench_case(BenchCase *b, PetscInt dim, PetscReal young, PetscReal poisson)
{
  *b = (BenchCase){0};
  b->constants[0] = (NamedValue){"young", young};
  b->constants[1] = (NamedValue){"poisson", poisson};
  b->material = (MaterialSpec){
    .name = "rubber", .law = "neo-hookean", .density = 1000, .n_parameters = 2, .parameters = b->constants};
  b->body = (BodySpec){.name = "body", .material = "rubber", .has_shape = 1, .points_per_cell = dim == 2 ? 4 : 8};
  b->body.shape.kind = SHAPE_BOX;
  b->motion.component[0] = b->motion.component[1] = b->motion.component[2] = 1;
  b->motion.kind = MOTION_FIXED;
  b->c = (Case){
    .kinematics = dim == 2 ? &kinematics_plane_strain : &kinematics_3d,
    .method = (char *)"mpm",
    .formulation = (char *)"displacement",
    .grid = {.kind = GRID_BOX, .cell = dim == 2 ? CELL_QUADRILATERAL : CELL_HEXAHEDRON, .grading = {1, 1, 1}},
    .n_bodies = 1,
    .bodies = &b->body,
    .n_materials = 1,
    .materials = &b->material,
    .n_boundary = 1,
    .boundary = &b->motion,
    .newton = {.residual = 1e-8, .increment = 1e-10, .max_iterations = 25, .ease = 6},
    .stabilisation = {1e-6, 1e-3},
  };
  b->c.gravity[dim - 1] = -9.81;
}

/* A block of n cells along its edge of 1 m, in the cells from `first` on of a grid of 2 m that
 * holds it at its floor alone. The time step goes with the cell: a Courant number of 5.5. */
static inline void bench_block(BenchCase *b, PetscInt dim, PetscInt n, PetscInt first)
{
  const PetscReal h = 1.0 / (PetscReal)n, dt = 0.15 * h;
  bench_case(b, dim, 1e6, 0.3);
  for (PetscInt d = 0; d < dim; ++d) {
    b->body.shape.min[d] = (PetscReal)first * h;
    b->body.shape.max[d] = (PetscReal)first * h + 1;
    b->c.grid.max[d] = 2;
    b->c.grid.counts[d] = 2 * n;
  }
  b->motion.on.has[dim - 1] = 1;
  b->c.analysis = (AnalysisSpec){
    .type = ANALYSIS_DYNAMIC, .end = 1, .step = dt, .smallest = dt / 1024, .largest = dt, .beta = 0.25, .gamma = 0.5};
}

/* The same block when it meets the floor, at so many m/s along it. */
static inline void bench_landing_block(BenchCase *b, PetscInt dim, PetscInt n, PetscInt first, PetscReal along)
{
  bench_block(b, dim, n, first);
  b->body.shape.min[dim - 1] = 0;
  b->body.shape.max[dim - 1] = 1;
  b->body.velocity[0] = along;
  b->body.velocity[dim - 1] = -1;
  b->c.newton.residual = 1e-6;
}

/* Bytes of this process in memory. */
static inline PetscReal resident_bytes(void)
{
  long pages = 0;
  FILE *file = fopen("/proc/self/statm", "r");
  if (file) {
    if (fscanf(file, "%*d %ld", &pages) != 1) pages = 0;
    fclose(file);
  }
  return (PetscReal)pages * (PetscReal)sysconf(_SC_PAGESIZE);
}

static inline PetscErrorCode SubjectCreate(const Case *c, Subject *s)
{
  Diag *diag;

  PetscFunctionBeginUser;
  (void)malloc_trim(0);
  s->bytes_before = resident_bytes();
  PetscCall(DiagCreate(&diag));
  PetscCall(ModelCreate(PETSC_COMM_WORLD, c, diag, &s->model));
  DiagFlush(diag, stderr);
  PetscCall(DiagDestroy(&diag));
  PetscCheck(s->model, PETSC_COMM_WORLD, PETSC_ERR_USER, "the benchmark's case has mistakes");
  PetscCall(ModelCountPoints(s->model, &s->points));
  PetscFunctionReturn(0);
}

static inline PetscErrorCode SubjectDestroy(Subject *s)
{
  PetscFunctionBeginUser;
  PetscCall(ModelDestroy(&s->model));
  PetscFunctionReturn(0);
}

/* Bytes that a pass moves if every array passes the memory bus once each time it is named here: N,
 * dN, volume, mass, material and state of a point; nodes, slots and stabilisation of a group; du,
 * history, fixed (read) and force (zeroed, read, written) of a node with unknowns; the tangent's
 * values zeroed, read and written by the scatter, then read and written into the matrix. */
static inline PetscReal pass_bytes(const Model *m)
{
  const PetscReal dim = (PetscReal)m->dim, nn = (PetscReal)m->grid->nodes_per_cell, real = sizeof(PetscReal),
                  integer = sizeof(PetscInt);
  const PetscReal point = real * (nn * (1 + dim) + 2 + (PetscReal)m->n_state) + integer;
  const PetscReal group = integer * (nn + nn * nn + 1) + 2 * real;
  const PetscReal node = dim * (5 * real + 1);
  const PetscReal value = 5 * real;
  const System *s = m->system;
  return point * (PetscReal)m->points->n + group * (PetscReal)m->space->support->n_groups +
         node * (PetscReal)s->n_rows + value * dim * dim * (PetscReal)s->row_start[s->n_rows];
}

/* Assemble at rest, several times; leaves the tangent in the model's matrix. */
static inline PetscErrorCode PassMeasure(Model *m, PetscReal inertia, PetscInt repeats, Pass *pass)
{
  const PetscInt dofs = m->grid->n_nodes * m->dim;

  PetscFunctionBeginUser;
  PetscCall(ModelActivate(m));
  PetscCall(SystemWantSlots(m->system, PETSC_FALSE));
  for (PetscInt i = 0; i < dofs; ++i) m->nodes->fixed[i] = m->boundary->fixed[i] || !m->nodes->touched[i / m->dim];
  PetscCall(PetscArrayzero(m->nodes->du, dofs));
  PetscCall(SystemPrescribe(m->system, m->nodes->fixed, m->nodes->idle));
  *pass = (Pass){PETSC_MAX_REAL, PETSC_MAX_REAL, pass_bytes(m)};
  for (PetscInt k = 0; k < repeats; ++k) {
    const WeakFormInput in = weak_form_of(m, inertia);
    WeakFormOutput out = {.force = m->nodes->force,
                          .values = m->system->single ? NULL : m->system->values,
                          .singles = m->system->single ? m->system->singles : NULL,
                          .slot = m->system->slot};
    const PetscReal start = seconds_now();
    PetscCall(PetscArrayzero(m->nodes->force, dofs));
    PetscCall(SystemZero(m->system));
    PetscCall(m->formulation->assemble(&in, &out));
    const PetscReal assembled = seconds_now();
    PetscCall(SystemToMatrix(m->system));
    const PetscReal end = seconds_now();
    pass->points = PetscMin(pass->points, assembled - start);
    pass->matrix = PetscMin(pass->matrix, end - assembled);
  }
  PetscFunctionReturn(0);
}

/* Bytes per second of a = b + s c on arrays that no cache holds, best of five: what STREAM calls
 * triad. */
static inline PetscErrorCode TriadMeasure(PetscReal *bandwidth)
{
  const PetscInt n = 32 * 1024 * 1024;
  PetscReal *a, *b, *c, best = PETSC_MAX_REAL;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n, &a, n, &b, n, &c));
  for (PetscInt i = 0; i < n; ++i) a[i] = b[i] = c[i] = 1;
  for (int k = 0; k < 5; ++k) {
    const PetscReal start = seconds_now(), s = 0.5 + k;
    for (PetscInt i = 0; i < n; ++i) a[i] = b[i] + s * c[i];
    best = PetscMin(best, seconds_now() - start + 0 * a[k]);
  }
  PetscCall(PetscFree3(a, b, c));
  *bandwidth = 3.0 * sizeof(PetscReal) * n / best;
  PetscFunctionReturn(0);
}

/* Bytes of one point in the table, and with its shape functions. */
static inline PetscReal table_bytes(const Model *m) { return (PetscReal)points_bytes(m->points); }
static inline PetscReal support_bytes(const Model *m)
{
  return (PetscReal)sizeof(PetscReal) * (PetscReal)(m->grid->nodes_per_cell * (1 + m->dim));
}
