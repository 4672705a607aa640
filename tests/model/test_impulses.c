/* Impulses of contact by the lumped mass (solve/contact/impulse/lumped.c) against those by a whole mass matrix that is
 * no more than its diagonal (whole.c): the one looks for impulses, the other for the motion of nodes. */
#include "case_builder.h"
#include "solve/contact/contact.h"

static const Model *of_product;

/* product = M x, on owners. */
static PetscErrorCode Multiply(void *context, const PetscReal *x, PetscReal *product)
{
  const PetscReal *mass = context;
  const PetscInt dim = of_product->dim;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < of_product->grid->n_nodes * dim; ++i)
    product[i] = i < of_product->grid->n_owned * dim ? mass[i / dim] * x[i] : 0;
  PetscFunctionReturn(0);
}

/* A block stands on a wall. */
static Model *standing(Bench *b, PetscInt dim, PetscReal friction, WallSpec *wall)
{
  const PetscInt up = dim - 1;
  bench_init(b, "mpm", dim == 2 ? CELL_QUADRILATERAL : CELL_HEXAHEDRON, 0);
  bench_grid(b, (PetscReal[]){0.125, 0.25, 0}, (PetscReal[]){2.125, 1.5, 1}, 0.25);
  bench_box(b, 0, (PetscReal[]){0.625, 0.5, 0.25}, (PetscReal[]){1.625, 1, 0.75});
  bench_dynamic(b, 1, 1e-3);
  b->c.analysis.mass = MASS_LUMPED;
  b->c.newton = (NewtonSpec){.residual = 1e-10, .max_iterations = 25, .ease = 6};
  b->c.gravity[up] = -9.81;
  *wall = (WallSpec){.name = (char *)"floor",
                     .shape = {.kind = SHAPE_HALF_SPACE},
                     .contact = friction > 0 ? CONTACT_FRICTION : CONTACT_FRICTIONLESS,
                     .friction = friction};
  wall->shape.point[up] = dim == 3 ? 0.25 : 0.5;
  wall->shape.normal[up] = 1;
  b->c.n_walls = 1;
  b->c.walls = wall;
  return bench_model(b, PETSC_COMM_WORLD);
}

/* Velocities of nodes that press a part of what touches into the wall and take the rest away; the same on all ranks. */
static void scatter(const Model *m, PetscReal *v)
{
  for (PetscInt node = 0; node < m->grid->n_nodes; ++node)
    for (PetscInt d = 0; d < m->dim; ++d) {
      const PetscReal *x = m->grid->x + node * m->dim;
      const PetscReal phase = 7 * x[0] + 13 * x[m->dim - 1] + (m->dim == 3 ? 11 * x[1] : 0) + 2.1 * (PetscReal)d;
      v[node * m->dim + d] = m->nodes->mass[node] > 0 ? 0.3 * sin(phase) - (d == m->dim - 1 ? 0.1 : 0) : 0;
    }
}

static void project(Model *m, PetscBool whole, PetscReal *v, ContactSum *sum)
{
  const PetscInt dofs = m->grid->n_nodes * m->dim;
  const ContactMass mass = {.multiply = Multiply, .context = m->nodes->mass, .diagonal = m->nodes->mass};
  PetscReal *given;
  CALL(PetscCalloc1(dofs, &given));
  of_product = m;
  scatter(m, v);
  *sum = (ContactSum){0};
  const ContactMotion motion = {.grid = m->grid,
                                .mass = m->nodes->mass,
                                .whole = whole ? &mass : NULL,
                                .frames = &m->boundary->frames,
                                .fixed = m->nodes->fixed,
                                .motion = v,
                                .given = given,
                                .du = m->nodes->du,
                                .glance = 1e-4,
                                .rate = 1e3};
  CALL(ContactProject(m->contact, &motion, sum));
  CALL(PetscFree(given));
}

static void test_rounds(void **state)
{
  (void)state;
  for (PetscInt dim = 2; dim < 4; ++dim)
    for (int rubs = 0; rubs < 2; ++rubs) {
      Bench b;
      WallSpec wall;
      Model *m = standing(&b, dim, 0.4 * rubs, &wall);
      const PetscInt dofs = m->grid->n_nodes * m->dim;
      PetscReal *v[2], apart[2] = {0, 0}, largest[2];
      ContactSum sum[2], all[2];
      for (int step = 0; step < 3; ++step) assert_true(model_step(m, 1).newton.converged);
      for (int whole = 0; whole < 2; ++whole) {
        CALL(PetscCalloc1(dofs, &v[whole]));
        project(m, (PetscBool)whole, v[whole], sum + whole);
        MPI_Allreduce(sum[whole].force, all[whole].force, 3, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD);
      }
      for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i) {
        apart[0] = PetscMax(apart[0], fabs(v[0][i] - v[1][i]));
        apart[1] = PetscMax(apart[1], fabs(v[0][i]));
      }
      MPI_Allreduce(apart, largest, 2, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD);
      PetscPrintf(PETSC_COMM_WORLD, "%d axes, friction %g: impulse %.10g, %.10g N s, motions %.1e of %.2f m/s apart\n",
                  (int)dim, 0.4 * rubs, (double)all[0].force[dim - 1], (double)all[1].force[dim - 1],
                  (double)largest[0], (double)largest[1]);
      CHECK(all[0].force[dim - 1] > 1, "an impulse of %g N s", all[0].force[dim - 1]);
      CHECK_CLOSE(all[0].force[dim - 1], all[1].force[dim - 1], 1e-5 * all[0].force[dim - 1]);
      CHECK(largest[0] <= 1e-5 * largest[1], "motions %g of %g m/s apart", largest[0], largest[1]);
      for (int whole = 0; whole < 2; ++whole) CALL(PetscFree(v[whole]));
      CALL(ModelDestroy(&m));
    }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_rounds)};
  return run_model_tests(argc, argv, tests);
}
