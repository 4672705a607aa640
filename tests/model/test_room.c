/* The room that points have: what is open, and J, go no farther than the density of points on the grid allows, in the
 * plane, in rings and in space, with all functions, on any ranks; grains that stand densely bear at once; and what has
 * flowed closer together than its volume allows is pressed by that. */
#include "case_builder.h"
#include "base/math/tensor.h"
#include "model/model_private.h"
#include "support/basis.h"

#define OPENING 7

static NamedValue sand[] = {{(char *)"young", 1e6},
                            {(char *)"poisson", 0.25},
                            {(char *)"friction_angle", 30},
                            {(char *)"cohesion", 0},
                            {(char *)"opening_memory", 1}};

static void ground(Bench *b, const Kinematics *kinematics, const char *basis)
{
  bench_init(b, "mpm", kinematics == &kinematics_3d ? CELL_HEXAHEDRON : CELL_QUADRILATERAL, 4);
  b->c.kinematics = kinematics;
  b->c.basis.kind = (char *)basis;
  b->c.stabilisation.room = PETSC_TRUE;
  bench_dynamic(b, 1, 1);
  b->material.law = (char *)"mohr-coulomb";
  b->material.n_parameters = 5;
  b->material.parameters = sand;
}

/* All points with this share of the mass and volume that fill the grid, this opening, and F = diag(j, 1, 1). */
static void set(Model *m, PetscReal share, PetscReal opening, PetscReal j)
{
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal F[9] = {j, 0, 0, 0, 1, 0, 0, 0, 1};
    m->points->real[POINT_VOLUME][p] *= share;
    m->points->real[POINT_MASS][p] *= share;
    m->points->real[POINT_J][p] = j;
    point_set_F(m->points, p, F);
    point_real(m->points, POINT_STATE, p)[OPENING] = opening;
  }
}

/* Density is that share everywhere, since sums over points are integrals over the cells; but domains of rings have
 * their means without r, which tells at the axis, and splines other shares of cells at the edges of the grid. */
static void bounded(const Kinematics *kinematics, const char *basis, PetscReal share, PetscReal opening, PetscReal j)
{
  const PetscReal most = -log(share), J = PetscMin(j, 1 / share);
  const PetscReal near = (kinematics->hoop && !strcmp(basis, "gimp")) || !strcmp(basis, "bspline") ? 0.06 : 1e-13;
  Bench b;
  ground(&b, kinematics, basis);
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  set(m, share, opening, j);
  CALL(ModelInitialise(m));
  PetscReal made;
  CALL(DiscretisationRoom(m->space, PETSC_FALSE, &made));
  CHECK(made == 0, "nothing is pressed");
  for (PetscInt p = 0; p < m->points->n; ++p) {
    PetscReal F[9];
    point_F(m->points, p, F);
    const PetscReal open = point_real(m->points, POINT_STATE, p)[OPENING];
    CHECK(PetscAbsReal(open - PetscMin(opening, most)) < near, "%s %s %g: %g", kinematics->name, basis, (double)share,
          (double)open);
    CHECK_CLOSE(m->points->real[POINT_J][p], J, near);
    CHECK_CLOSE(F[0] * F[4] * F[8], J, near);
    CHECK_CLOSE(F[0] / F[4], j, 1e-13);
    CHECK_CLOSE(F[8], kinematics == &kinematics_3d ? F[4] : 1, 1e-15);
  }
  CALL(ModelDestroy(&m));
}

static void test_bounds(void **state)
{
  const Kinematics *const kinematics[] = {&kinematics_plane_strain, &kinematics_axisymmetric, &kinematics_3d};
  (void)state;
  for (int k = 0; k < 3; ++k) {
    bounded(kinematics[k], "cell", 1, 0.4, 1.5);
    bounded(kinematics[k], "cell", 0.5, 0.4, 1.5); /* there is room for it */
    bounded(kinematics[k], "cell", 0.5, 0.9, 3);
    bounded(kinematics[k], "gimp", 0.8, 0.9, 3);
  }
  bounded(&kinematics_plane_strain, "bspline", 0.8, 0.1, 1.1);
  bounded(&kinematics_plane_strain, "bspline", 0.8, 0.9, 3);
}

/* Points that fill the grid `share` times, stretched by j and having flowed: J, and the elastic volume of their state,
 * after they have heard of it; they forget it where the step is given up. */
static void parted(const char *law, const Kinematics *kinematics, PetscReal share, PetscReal j, PetscReal flow)
{
  const PetscReal excess = share * PetscMin(j, 1) - 1.04, much = excess > 0 ? PetscMin(4 * flow, 0.5) * excess : 0;
  const PetscBool j2 = !strcmp(law, "j2");
  NamedValue mud[] = {{(char *)"young", 1e6}, {(char *)"poisson", 0.25}, {(char *)"yield_stress", 100}};
  Bench b;
  ground(&b, kinematics, "cell");
  if (j2) b.material.law = (char *)law, b.material.n_parameters = 3, b.material.parameters = mud;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  set(m, share, 0, j);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    *point_real(m->points, POINT_FLOW, p) = flow;
    if (j2) point_real(m->points, POINT_STATE, p)[6] = 1, point_real(m->points, POINT_STATE, p)[OPENING] = 0;
  }
  CALL(ModelInitialise(m));
  PetscReal made, local = 0;
  CALL(DiscretisationRoom(m->space, PETSC_FALSE, &made));
  const PetscReal before = j > 1 ? 1 : j; /* there is no room for more */
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal *b_e = point_real(m->points, POINT_STATE, p);
    CHECK_CLOSE(m->points->real[POINT_J][p], before * exp(-much), 1e-13);
    CHECK_CLOSE(j2 ? b_e[6] : sqrt(sym_det(b_e)), exp(-much), 1e-13);
    local += m->points->real[POINT_WORK][p];
  }
  const PetscReal bulk = 1e6 / 3 / (1 - 2 * 0.25), room = much > 0 ? local / made : 1;
  if (much > 0) CHECK_CLOSE(room, 1, 1e-12);
  if (much > 0 && !j2) { /* Hencky's energy of points of all this rank */
    PetscReal volume = 0;
    for (PetscInt p = 0; p < m->points->n; ++p) volume += m->points->real[POINT_VOLUME][p];
    CHECK_CLOSE(made, 0.5 * bulk * much * much * volume, 1e-9 * made);
  }
  discretisation_room_back(m->space);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    CHECK_CLOSE(m->points->real[POINT_J][p], j, 0);
    CHECK_CLOSE(m->points->real[POINT_WORK][p], 0, 0);
  }
  CALL(ModelDestroy(&m));
}

/* Of points that are pressed by so much beside their shear stress of 100 Pa less is parted; those of a cell that share
 * their change of volume have the mean of what they would have. */
static PetscReal parted_under(PetscReal pressure, PetscBool shared)
{
  PetscReal made, J[2] = {1, 0};
  Bench b;
  ground(&b, &kinematics_plane_strain, "cell");
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  set(m, 1.24, 0, 1);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    PetscReal *tau = point_real(m->points, POINT_TAU, p);
    for (int k = 0; k < 3; ++k) tau[k] = -pressure;
    tau[3] = 100 / sqrt(3);
    *point_real(m->points, POINT_FLOW, p) = !shared ? 0.05 : p % 2 ? 0.1 : 0;
  }
  CALL(ModelInitialise(m));
  CALL(DiscretisationRoom(m->space, shared, &made));
  for (PetscInt p = 0; p < m->points->n; ++p) {
    J[0] = PetscMin(J[0], m->points->real[POINT_J][p]);
    J[1] = PetscMax(J[1], m->points->real[POINT_J][p]);
  }
  if (m->points->n) CHECK_CLOSE(J[0], J[1], 1e-13);
  CALL(ModelDestroy(&m));
  CALL(MPI_Allreduce(MPI_IN_PLACE, J, 1, MPIU_REAL, MPI_MIN, PETSC_COMM_WORLD));
  return -log(J[0]);
}

static void test_parts_what_rubs(void **state)
{
  const PetscReal all = 4 * 0.05 * 0.2;
  (void)state;
  CHECK_CLOSE(parted_under(0, PETSC_FALSE), all, 1e-12);
  CHECK_CLOSE(parted_under(499, PETSC_FALSE), all, 1e-12);
  CHECK_CLOSE(parted_under(1000, PETSC_FALSE), 0.25 * all, 1e-12); /* nearly fluid */
  CHECK_CLOSE(parted_under(-1000, PETSC_FALSE), all, 1e-12);
  CHECK_CLOSE(parted_under(0, PETSC_TRUE), all, 1e-12);
}

static void test_parts(void **state)
{
  (void)state;
  parted("mohr-coulomb", &kinematics_plane_strain, 1.24, 1, 0.05);
  parted("mohr-coulomb", &kinematics_axisymmetric, 1.24, 1, 0.05);
  parted("mohr-coulomb", &kinematics_3d, 1.24, 1, 0.05);
  parted("mohr-coulomb", &kinematics_3d, 1.24, 1.5, 1);    /* opened long ago; no more than half at once */
  parted("mohr-coulomb", &kinematics_3d, 1.24, 0.9, 0.05); /* denser by its law, too */
  parted("mohr-coulomb", &kinematics_3d, 1.24, 1, 0);      /* what stands still stays */
  parted("mohr-coulomb", &kinematics_3d, 1.03, 1, 0.05);   /* as uneven as points are */
  parted("j2", &kinematics_plane_strain, 1.24, 1, 0.05);
}

/* Mean of the stress yy of all points after the top has come down by 1e-3. */
static PetscReal pressed(PetscBool room, PetscReal opening)
{
  PetscReal sum[2] = {0, 0}, all[2];
  StepReport report;
  Bench b;
  ground(&b, &kinematics_plane_strain, "cell");
  b.c.stabilisation.room = room;
  if (room) b.c.analysis.type = ANALYSIS_STATIC; /* what is open has no stiffness */
  for (int axis = 0; axis < 2; ++axis)
    for (int high = 0; high < 2; ++high)
      bench_motion(&b, axis, high, MOTION_DISPLACEMENT, axis ? 2 : 1)->value[1] = axis && high ? -1e-3 : 0;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  set(m, 1, opening, 1);
  CALL(ModelStep(m, 1, &report));
  CHECK(report.newton.converged, "a block between four sides");
  for (PetscInt p = 0; p < m->points->n; ++p) {
    sum[0] += point_real(m->points, POINT_TAU, p)[1];
    sum[1] += 1;
  }
  MPI_Allreduce(sum, all, 2, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD);
  CALL(ModelDestroy(&m));
  return all[0] / all[1];
}

static void test_bears(void **state)
{
  const PetscReal modulus = 1e6 * (1 - 0.25) / (1 + 0.25) / (1 - 2 * 0.25);
  (void)state;
  CHECK_CLOSE(pressed(PETSC_FALSE, 0.2), 0, 0);
  CHECK_CLOSE(pressed(PETSC_TRUE, 0.2), modulus * log(1 - 1e-3), 1e-6);
  CHECK_CLOSE(pressed(PETSC_TRUE, 0), modulus * log(1 - 1e-3), 1e-6);
}

static void test_refused(void **state)
{
  Bench b;
  (void)state;
  ground(&b, &kinematics_plane_strain, "cell");
  b.c.method = (char *)"fem";
  bench_refused(&b, PETSC_COMM_WORLD, "stabilisation.room", "nodes of method fem go with the material");
  ground(&b, &kinematics_plane_strain, "cell");
  b.material.law = (char *)"neo-hookean";
  b.material.n_parameters = 2;
  bench_refused(&b, PETSC_COMM_WORLD, "stabilisation.room", "no material of the case yields");
  ground(&b, &kinematics_plane_strain, "cell");
  b.c.formulation = (char *)"mixed";
  bench_refused(&b, PETSC_COMM_WORLD, "stabilisation.room", "the mixed formulation has the volume");
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_bounds), cmocka_unit_test(test_parts),
                                     cmocka_unit_test(test_parts_what_rubs), cmocka_unit_test(test_bears),
                                     cmocka_unit_test(test_refused)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failures = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failures;
}
