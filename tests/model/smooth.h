/* Bodies under which smooth shape functions must show: uniform strain while a free end crosses
 * cells, and a column that settles through the grid. */
#pragma once
#include "axisymmetric.h"

/* F, stress and place of all points are those of x = F X. */
static inline void check_uniform(const Model *m, const PetscReal F[9], PetscReal tolerance)
{
  PetscReal expected[6], sigma[6], f[9];
  rubber_stress(F, expected);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal *x = point_real(m->points, POINT_X, p), *u = point_real(m->points, POINT_U, p);
    point_F(m->points, p, f);
    CALL(ModelPointStress(m, p, sigma));
    for (int i = 0; i < 9; ++i) CHECK_CLOSE(f[i], F[i], tolerance);
    for (int i = 0; i < 6; ++i) CHECK_CLOSE(sigma[i] / 1e6, expected[i] / 1e6, tolerance);
    for (PetscInt i = 0; i < m->dim; ++i) {
      PetscReal at = 0;
      for (PetscInt j = 0; j < m->dim; ++j) at += F[3 * i + j] * (x[j] - u[j]);
      CHECK_CLOSE(x[i], at, tolerance);
    }
  }
}

/* A body of sixteen cells pressed to a quarter of its length in steps: its free end crosses cells
 * and ends anywhere in one. */
static inline PetscReal length_at(PetscReal t) { return 1 / (1 + 3 * t); }

static inline void press(void *context, const PetscReal *x, PetscReal t0, PetscReal t1, PetscReal *increment)
{
  (void)context;
  increment[0] = (length_at(t1) / length_at(t0) - 1) * x[0];
  increment[1] = 0;
}

/* In a grid of so many cells. */
static inline void pressed_body(const char *formulation, const char *basis, PetscInt points_per_cell, PetscInt length,
                                PetscReal tolerance)
{
  const PetscReal F[9] = {0.25, 0, 0, 0, 1, 0, 0, 0, 1};
  Bench b;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 1);
  bench_grid(&b, (PetscReal[3]){0, 0, 0}, (PetscReal[3]){(PetscReal)length, 4, 0}, 1);
  bench_box(&b, 0, (PetscReal[3]){0, 0, 0}, (PetscReal[3]){16, 4, 0});
  b.body[0].points_per_cell = points_per_cell;
  b.c.basis.kind = basis;
  b.c.formulation = (char *)formulation;
  b.c.analysis.step = b.c.analysis.largest = 1.0 / 3;
  bench_motion(&b, 0, 0, MOTION_FIXED, 1);
  bench_motion(&b, 1, 0, MOTION_FIXED, 2);
  bench_motion(&b, 1, 4, MOTION_FIXED, 2);
  bench_motion(&b, 0, 16, MOTION_FIXED, 3)->on.min[0] = 3.5;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  m->boundary->field = press;
  while (m->time < 1 - 1e-9) CHECK(model_step(m, 1 - m->time).cuts == 0, "the step was halved");
  CHECK(m->step == 3, "%d steps", (int)m->step);
  check_uniform(m, F, tolerance);
  CALL(ModelDestroy(&m));
  bench_end(&b);
}

/* A column of 50 m that settles under its weight in 40 static steps: in uniaxial strain the
 * vertical stress is the weight above, sigma_yy = -rho0 g (l0 - Y). Returns how far points are
 * off in the mean, over rho0 g l0. */
static inline PetscReal settled_column(const char *formulation, const char *basis, PetscInt n, PetscReal curvature)
{
  const PetscReal l0 = 50, h = l0 / (PetscReal)n, weight = 800;
  PetscReal local[2] = {0, 0}, sum[2], sigma[6], ratio[2] = {-PETSC_MAX_REAL, -PETSC_MAX_REAL};
  Bench b;
  bench_init(&b, "mpm", CELL_QUADRILATERAL, 1);
  bench_grid(&b, (PetscReal[3]){0, 0, 0}, (PetscReal[3]){h, l0 + h, 0}, h);
  bench_box(&b, 0, (PetscReal[3]){0, 0, 0}, (PetscReal[3]){h, l0, 0});
  b.constants[0].value = 1e4;
  b.constants[1].value = 0;
  b.material.density = weight / 10;
  b.c.gravity[1] = -10;
  b.c.basis.kind = basis;
  b.c.formulation = (char *)formulation;
  b.c.stabilisation.curvature = curvature;
  if (curvature == 0) b.c.stabilisation.follow = 0; /* the functions as they are */
  b.c.newton.residual = 1e-9;
  b.c.analysis.step = b.c.analysis.largest = 1.0 / 40;
  bench_motion(&b, 0, 0, MOTION_FIXED, 1);
  bench_motion(&b, 0, h, MOTION_FIXED, 1);
  bench_motion(&b, 1, 0, MOTION_FIXED, 2);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  (void)run_through(m);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal Y = point_real(m->points, POINT_X, p)[1] - point_real(m->points, POINT_U, p)[1];
    const PetscReal volume = m->points->real[POINT_VOLUME][p];
    CALL(ModelPointStress(m, p, sigma));
    local[0] += volume * PetscAbsReal(sigma[1] + weight * (l0 - Y)) / (weight * l0);
    local[1] += volume;
    ratio[0] = PetscMax(ratio[0], sigma[1] / (weight * (l0 - Y)));
    ratio[1] = PetscMax(ratio[1], -sigma[1] / (weight * (l0 - Y)));
  }
  CALL(MPI_Allreduce(MPI_IN_PLACE, ratio, 2, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD));
  CHECK_CLOSE(model_sum(m, "overburden: lowest_ratio", 0), -ratio[0], 1e-12);
  CHECK_CLOSE(model_sum(m, "overburden: highest_ratio", 0), ratio[1], 1e-12);
  CALL(MPI_Allreduce(local, sum, 2, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  CHECK_CLOSE(model_sum(m, "overburden: mean", 0), sum[0] / sum[1], 1e-14);
  CALL(ModelDestroy(&m));
  bench_end(&b);
  PetscPrintf(PETSC_COMM_WORLD, "column of %d cells with %s: stress off by %.3g\n", (int)n, basis,
              (double)(sum[0] / sum[1]));
  return sum[0] / sum[1];
}
