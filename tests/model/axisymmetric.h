/* Cylinders about x = 0 for tests in axisymmetry. */
#pragma once
#include "case_builder.h"

/* Rubber (bench_init) between radii a and b, y from 0 to height, in n cells over a - b. */
static inline void tube(Bench *bench, const char *method, CellType cell, PetscReal a, PetscReal b, PetscReal height,
                        PetscInt n)
{
  bench_init(bench, method, cell, 0);
  bench->c.kinematics = &kinematics_axisymmetric;
  bench_grid(bench, (PetscReal[]){a, 0, 0}, (PetscReal[]){b, height, 0}, (b - a) / (PetscReal)n);
  bench_box(bench, 0, (PetscReal[]){a, 0, 0}, (PetscReal[]){b, height, 0});
}

static inline MotionSpec *tube_moved(Bench *bench, int axis, PetscReal at, int component, PetscReal value)
{
  MotionSpec *m = bench_motion(bench, axis, at, value != 0 ? MOTION_DISPLACEMENT : MOTION_FIXED, 1u << component);
  m->value[component] = value;
  return m;
}

/* Dead traction along x on the face x = at. */
static inline void tube_pressed(Bench *bench, PetscReal at, PetscReal pressure)
{
  bench_traction(bench, 0, at, NULL, pressure, 0, 0);
}

static inline PetscReal reaction(Model *m, PetscInt entry, PetscInt component)
{
  PetscReal value;
  const MeasureSpec measure = {.kind = "reaction", .component = component, .boundary = entry};
  CALL(ModelMeasure(m, &measure, 0, &value));
  return value;
}

/* To the end; no step may be halved. *iterations: the most that one took. */
static inline PetscInt run_through(Model *m)
{
  PetscInt most = 0;
  while (m->time < m->c->analysis.end * (1 - 1e-9)) {
    const StepReport r = model_step(m, m->c->analysis.end - m->time);
    CHECK(r.cuts == 0, "the step was halved");
    most = PetscMax(most, r.newton.iterations);
  }
  return most;
}

/* Present radius (component 0) or height of the node that stood at X when the mesh was made;
 * fem. */
static inline PetscReal *node_places(const Model *m)
{
  PetscReal *X;
  CALL(PetscMalloc1(m->grid->n_nodes * m->dim, &X));
  CALL(PetscArraycpy(X, m->grid->x, m->grid->n_nodes * m->dim));
  return X;
}

static inline PetscReal moved_to(const Model *m, const PetscReal *X, PetscReal x, PetscReal y, PetscInt component)
{
  PetscReal found = -PETSC_MAX_REAL;
  for (PetscInt i = 0; i < m->grid->n_nodes; ++i)
    if (PetscAbsReal(X[2 * i] - x) + PetscAbsReal(X[2 * i + 1] - y) < 1e-9) found = m->grid->x[2 * i + component];
  return model_max(m, found);
}

/* Order of an error that falls from `coarse` to `fine` when cells are halved. */
static inline PetscReal order_of(PetscReal coarse, PetscReal fine)
{
  return PetscLog2Real(PetscAbsReal(coarse) / PetscAbsReal(fine));
}
