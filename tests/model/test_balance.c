/* The grid is shared among the ranks anew as the material moves: nothing is lost on the way,
 * nothing changes but who has it, and the answers stay those of one rank. */
#include "case_builder.h"
#include "model/model_private.h"
#include "points/fields.h"

static PetscMPIInt ranks(void)
{
  PetscMPIInt size;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  return size;
}

/* All points of all ranks, by id: every field, packed. */
typedef struct {
  PetscInt n;
  size_t bytes;
  char *data;
} Everything;

static size_t record_bytes(const Points *points)
{
  PetscInt reals = 0;
  for (int f = 0; f < POINT_N_REAL; ++f) reals += points->components[f];
  return sizeof(PetscInt64) * 4 + sizeof(PetscReal) * (size_t)reals;
}

static void record(const Grid *grid, const Points *points, PetscInt p, char *out)
{
  const PetscInt64 head[4] = {points->id[p], points->body[p], points->material[p], grid->global_cell[points->cell[p]]};
  memcpy(out, head, sizeof head);
  out += sizeof head;
  for (int f = 0; f < POINT_N_REAL; ++f) {
    const size_t size = sizeof(PetscReal) * (size_t)points->components[f];
    if (size) memcpy(out, point_real(points, (PointReal)f, p), size);
    out += size;
  }
}

static int by_id(const void *a, const void *b)
{
  const PetscInt64 p = *(const PetscInt64 *)a, q = *(const PetscInt64 *)b;
  return (p > q) - (p < q);
}

static Everything gather(const Grid *grid, const Points *points)
{
  Everything all = {.bytes = record_bytes(points)};
  PetscMPIInt mine = (PetscMPIInt)(all.bytes * (size_t)points->n), count[8], start[9] = {0};
  char *data;
  CALL(PetscMalloc1((size_t)mine + 1, &data));
  for (PetscInt p = 0; p < points->n; ++p) record(grid, points, p, data + all.bytes * (size_t)p);
  CALL(MPI_Allgather(&mine, 1, MPI_INT, count, 1, MPI_INT, PETSC_COMM_WORLD));
  for (PetscMPIInt r = 0; r < ranks(); ++r) start[r + 1] = start[r] + count[r];
  CALL(PetscMalloc1((size_t)start[ranks()] + 1, &all.data));
  CALL(MPI_Allgatherv(data, mine, MPI_BYTE, all.data, count, start, MPI_BYTE, PETSC_COMM_WORLD));
  CALL(PetscFree(data));
  all.n = start[ranks()] / (PetscInt)all.bytes;
  qsort(all.data, (size_t)all.n, all.bytes, by_id);
  return all;
}

static void same_points(Everything *a, Everything *b, const char *what)
{
  CHECK(a->n == b->n, "%d and %d %s", (int)a->n, (int)b->n, what);
  CHECK(!memcmp(a->data, b->data, a->bytes * (size_t)a->n), "the %s have changed", what);
  CALL(PetscFree(a->data));
  CALL(PetscFree(b->data));
}

static PetscReal nodal_sum(const Model *m, const PetscReal *values)
{
  PetscReal sum = 0, all;
  for (PetscInt i = 0; i < m->grid->n_owned * m->dim; ++i) sum += values[i] * values[i];
  CALL(MPI_Allreduce(&sum, &all, 1, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  return all;
}

/* A block that slides along the floor of a long trough from one end to the other, pushed by a wall
 * that moves, with a load that it carries and a tracer. */
static void sliding(Bench *b, CellType cell, PetscReal size)
{
  bench_init(b, "mpm", cell, 0);
  bench_grid(b, (PetscReal[]){0, 0, 0}, (PetscReal[]){4, 1, 1}, size);
  bench_box(b, 0, (PetscReal[]){0, 0, 0.25}, (PetscReal[]){1.5, 0.5, 0.75});
  b->body[0].velocity[0] = 10;
  b->c.gravity[1] = -9.81;
  b->c.linear = LINEAR_DIRECT;
  bench_dynamic(b, 1, 0.01);
  bench_motion(b, 1, 0, MOTION_FIXED, 2);
  MotionSpec *wall = bench_motion(b, 0, 0, MOTION_VELOCITY, 1);
  wall->value[0] = 10;
  wall->moves = PETSC_TRUE;
  wall->on.min[0] = -size;
  bench_traction(b, 0, 1.5, "body", -1e3, 2e3, 0);
  bench_tracer(b, "position", 0, 0.5, 0.5, 0.5);
  b->measure[b->c.n_measures++] = (MeasureSpec){.name = "reaction", .kind = "reaction", .component = 1};
  b->c.parallel.imbalance = 1.2;
}

/* The whole way, beside the same on one rank and beside a partition that stays. */
static void all_the_way(Bench *b, PetscInt steps)
{
  const PetscReal threshold = b->c.parallel.imbalance;
  Model *m = bench_model(b, PETSC_COMM_WORLD), *alone = bench_model(b, PETSC_COMM_SELF);
  PetscReal v[2], worst = 0;
  b->c.parallel.imbalance = 0;
  Model *rigid = bench_model(b, PETSC_COMM_WORLD);
  for (PetscInt s = 0; s < steps; ++s) {
    b->c.parallel.imbalance = threshold;
    const StepReport r = model_step(m, PETSC_MAX_REAL);
    CHECK(r.imbalance == 0 || r.moved > 0, "no point moved");
    CHECK(r.imbalance == 0 || s > 0, "accelerations of the start would be lost");
    CHECK(r.imbalance == 0 || r.imbalance > threshold, "the grid was shared anew at %g", (double)r.imbalance);
    model_step(alone, PETSC_MAX_REAL);
    b->c.parallel.imbalance = 0;
    model_step(rigid, PETSC_MAX_REAL);
    worst = PetscMax(worst, m->balance.imbalance);
  }
  b->c.parallel.imbalance = threshold;
  const PointReal fields[] = {POINT_X, POINT_U, POINT_V, POINT_F, POINT_PRESSURE};
  for (size_t k = 0; k < sizeof fields / sizeof *fields; ++k) {
    const PetscReal off = points_difference(m, alone, fields[k]),
                    off_rigid = points_difference(rigid, alone, fields[k]);
    const PetscReal unit = fields[k] == POINT_PRESSURE ? 1e6 : 1;
    CHECK(off <= 1e-9 * unit && off_rigid <= 1e-9 * unit, "field %d is off by %g, without by %g", (int)k, (double)off,
          (double)off_rigid);
  }
  for (PetscInt k = 0; k < b->c.n_measures; ++k) {
    CALL(ModelMeasure(m, &b->measure[k], k, &v[0]));
    CALL(ModelMeasure(alone, &b->measure[k], k, &v[1]));
    CHECK_CLOSE(v[0], v[1], 1e-9 * (1 + PetscAbsReal(v[1])));
  }
  CHECK_CLOSE(m->external_work, alone->external_work, 1e-9 * (1 + PetscAbsReal(alone->external_work)));
  CHECK_CLOSE(m->boundary_work, alone->boundary_work, 1e-9 * (1 + PetscAbsReal(alone->boundary_work)));
  CHECK(rigid->balance.repartitions == 0 && alone->balance.repartitions == 0, "who asked for it?");
  if (ranks() > 1) {
    CHECK(m->balance.repartitions > 0, "never shared anew, although the imbalance was %g",
          (double)rigid->balance.largest);
    CHECK(worst < rigid->balance.largest - 0.3, "the imbalance grew to %g, without to %g", (double)worst,
          (double)rigid->balance.largest);
  }
  CALL(ModelDestroy(&m));
  CALL(ModelDestroy(&alone));
  CALL(ModelDestroy(&rigid));
}

static void test_sliding(void **state)
{
  (void)state;
  EACH_VARIANT (k, 3) {
    Bench b;
    sliding(&b, k == 2 ? CELL_TRIANGLE : CELL_QUADRILATERAL, k == 2 ? 0.25 : 0.125);
    if (k == 1) b.c.basis.kind = "gimp";
    all_the_way(&b, k == 2 ? 16 : 20);
  }
}

static void test_sliding_3d(void **state)
{
  Bench b;
  (void)state;
  sliding(&b, CELL_HEXAHEDRON, 0.25);
  all_the_way(&b, 12);
}

static void test_sliding_mixed(void **state)
{
  Bench b;
  (void)state;
  sliding(&b, CELL_QUADRILATERAL, 0.125);
  b.material.law = "neo-hookean-split";
  b.c.formulation = "mixed";
  b.c.mixed.stabilisation = 2;
  all_the_way(&b, 16);
}

/* Cells of a mesh travel with what is in them. Its sides stay where they are, and the body's. */
static void on_mesh(Bench *b)
{
  static const PetscReal plane[] = {0, 0.25, 0.5, 0.75, 1, 1.5, 4};
  bench_distort(b, 0.15, 7, plane);
}

static void test_sliding_mesh(void **state)
{
  static const struct {
    CellType cell;
    PetscReal size;
    PetscInt steps;
  } meshes[] = {{CELL_QUADRILATERAL, 0.125, 16}, {CELL_TRIANGLE, 0.25, 16}, {CELL_HEXAHEDRON, 0.25, 8}};
  Bench b;
  (void)state;
  EACH_OF (k, meshes) {
    sliding(&b, meshes[k].cell, meshes[k].size);
    on_mesh(&b);
    all_the_way(&b, meshes[k].steps);
    bench_end(&b);
  }
}

/* Before and after a repartition: points, tracers and carriers to the last bit, the boundary's
 * forces, nodal mass and motion. */
static void conserves(Bench *b)
{
  StepReport report = {0};
  b->c.parallel.imbalance = 0;
  Model *m = bench_model(b, PETSC_COMM_WORLD);
  for (PetscInt s = 0; s < 8; ++s) model_step(m, PETSC_MAX_REAL);
  CALL(ModelInitialise(m));
  Everything points = gather(m->grid, m->points), tracers = gather(m->grid, m->tracers),
             carriers = gather(m->grid, m->loads->carriers);
  const PetscReal reaction = nodal_sum(m, m->nodes->reaction), held = nodal_sum(m, m->nodes->held);
  const PetscReal v = nodal_sum(m, m->nodes->v);
  b->c.parallel.imbalance = 1 + 1e-9;
  CALL(ModelBalance(m, &report));
  CHECK(ranks() == 1 || (report.imbalance > 1 && report.moved > 0), "nothing happened at %g",
        (double)m->balance.imbalance);
  Everything after = gather(m->grid, m->points), tracers_after = gather(m->grid, m->tracers),
             carriers_after = gather(m->grid, m->loads->carriers);
  same_points(&points, &after, "points");
  same_points(&tracers, &tracers_after, "tracers");
  same_points(&carriers, &carriers_after, "carriers");
  CHECK_CLOSE(nodal_sum(m, m->nodes->reaction), reaction, 1e-14 * reaction);
  CHECK_CLOSE(nodal_sum(m, m->nodes->held), held, 1e-14 * held);
  CHECK_CLOSE(nodal_sum(m, m->nodes->v), v, 1e-12 * v);
  CALL(ModelDestroy(&m));
}

static void test_conservation(void **state)
{
  Bench b;
  (void)state;
  sliding(&b, CELL_QUADRILATERAL, 0.125);
  conserves(&b);
  on_mesh(&b);
  conserves(&b);
  bench_end(&b);
}

/* A body of one column of cells cannot be shared by cutting along it: the attempt must not be
 * repeated at every step, nor change anything. */
static void test_hopeless(void **state)
{
  Bench b;
  (void)state;
  sliding(&b, CELL_QUADRILATERAL, 0.25);
  bench_box(&b, 0, (PetscReal[]){0, 0, 0}, (PetscReal[]){0.25, 0.25, 1});
  b.c.n_boundary = 1;
  b.c.n_loads = b.c.n_measures = 0;
  Model *m = bench_model(&b, PETSC_COMM_WORLD);
  PetscInt tries = 0, tried = -1;
  for (PetscInt s = 0; s < 10; ++s) {
    model_step(m, PETSC_MAX_REAL);
    tries += m->balance.reached > 0 && m->balance.tried != tried;
    tried = m->balance.tried;
  }
  CHECK(tries <= 3, "tried %d times in 10 steps", (int)tries);
  CALL(ModelDestroy(&m));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_sliding),      cmocka_unit_test(test_sliding_3d),   cmocka_unit_test(test_sliding_mixed),
    cmocka_unit_test(test_sliding_mesh), cmocka_unit_test(test_conservation), cmocka_unit_test(test_hopeless),
  };
  return run_model_tests(argc, argv, tests);
}
