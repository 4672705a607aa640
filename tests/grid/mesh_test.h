/* Meshes for tests: made by gmsh in a folder of the run's own, read, and compared with what their
 * drawings say. */
#pragma once
#include <stdlib.h>
#include <string.h>
#include "grid_test.h"

enum { MESHES = 5 };

/* One of each cell, and a mixture. */
static const struct {
  const char *source, *options;
  PetscInt dim;
} meshes[MESHES] = {{"plane", "-2 -setnumber h 0.3", 2},
                    {"plane", "-2 -setnumber h 0.4 -setnumber quads 1", 2},
                    {"block", "-3 -setnumber n 2", 3},
                    {"block", "-3 -setnumber n 3 -setnumber bricks 1", 3},
                    {"plane", "-2 -setnumber h 0.3 -setnumber quads 2", 2}};

static char folder[64]; /* where the meshes of this run stand; the same on every rank */

static inline PetscMPIInt my_rank(void)
{
  PetscMPIInt rank;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  return rank;
}

static inline const char *in_folder(const char *name)
{
  static char path[2][256];
  static int turn;
  turn = !turn;
  (void)snprintf(path[turn], sizeof path[turn], "%s/%s", folder, name);
  return path[turn];
}

static inline int setup(void **state)
{
  (void)state;
  if (!my_rank()) {
    (void)strcpy(folder, "/tmp/talus-grid-test-XXXXXX");
    if (!mkdtemp(folder)) return -1;
  }
  return MPI_Bcast(folder, sizeof folder, MPI_CHAR, 0, PETSC_COMM_WORLD);
}

static inline int teardown(void **state)
{
  char command[128];
  (void)state;
  MPI_Barrier(PETSC_COMM_WORLD);
  (void)snprintf(command, sizeof command, "rm -rf '%s'", folder);
  return my_rank() ? 0 : system(command);
}

/* Let gmsh write source.geo of this folder as `name`. */
static inline void generate(const char *source, const char *name, const char *options)
{
  char command[1024];
  int status = 0;
  (void)snprintf(command, sizeof command, "env -u OMPI_COMM_WORLD_SIZE gmsh -v 1 '%s/tests/grid/%s.geo' %s -o '%s'",
                 TALUS_SOURCE_DIR, source, options, in_folder(name));
  if (!my_rank()) status = system(command);
  MPI_Bcast(&status, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  assert_int_equal(status, 0);
}

static inline void write_file(const char *name, const char *content, size_t size)
{
  if (!my_rank()) {
    FILE *file = fopen(in_folder(name), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(content, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
  }
  MPI_Barrier(PETSC_COMM_WORLD);
}

static inline Case mesh_case(const char *path, PetscInt dim)
{
  Case c = {0};
  c.kinematics = dim == 3 ? &kinematics_3d : &kinematics_plane_strain;
  c.grid.kind = GRID_MESH;
  c.grid.mesh = (char *)path;
  return c;
}

static inline Grid *read_mesh(const char *name, PetscInt dim)
{
  const Case c = mesh_case(in_folder(name), dim);
  return make_grid(&c, NULL, NULL);
}

static inline PetscReal region_volume(const Grid *grid, const char *name)
{
  const GridSet *set = grid_find_set(grid, name);
  PetscReal volume = 0;
  assert_non_null(set);
  for (PetscInt k = 0; k < set->n_cells; ++k) {
    PetscReal x[3 * CELL_MAX_NODES];
    grid_cell_x(grid, set->cells[k], x);
    volume += cell_volume(grid_cell_type(grid, set->cells[k]), x);
  }
  return sum_over_ranks(volume);
}

static inline PetscReal boundary_area(const Grid *grid, const char *name, PetscReal normal[3])
{
  const GridSet *set = grid_find_set(grid, name);
  assert_non_null(set);
  return faces_area(grid, set, normal);
}

static inline void assert_near(PetscReal a, PetscReal b) { assert_true(PetscAbsReal(a - b) < 1e-9); }

static inline void check_ghosts(const Grid *grid)
{
  PetscReal total;
  check_ghost_sum(grid, &total);
  assert_true(total == (PetscReal)(grid->n_cells_global * grid->nodes_per_cell));
  check_ghost_positions(grid);
  assert_int_equal(count_over_ranks(grid->n_cells), grid->n_cells_global);
  assert_int_equal(count_over_ranks(grid->n_owned), grid->n_nodes_global);
}

/* What the drawing of plane.geo says. */
static inline void check_plane(const Grid *grid)
{
  PetscReal normal[3];
  assert_near(grid_volume(grid), 3.0);
  assert_near(region_volume(grid, "beam"), 2.0);
  assert_near(region_volume(grid, "tip"), 1.0);
  assert_near(region_volume(grid, "all of it"), 3.0);
  assert_near(boundary_area(grid, "wall", normal), 1.0);
  assert_near(normal[0], -1.0);
  assert_near(boundary_area(grid, "seam", normal), 1.0);
  assert_near(boundary_area(grid, "shore", normal), 3.0 + PetscSqrtReal(1.25));
  assert_near(normal[1], -3.0);
  assert_near(boundary_area(grid, "77", normal), 2.0); /* a group without a name */
  const GridSet *corner = grid_find_set(grid, "corner");
  assert_non_null(corner);
  assert_int_equal(owned_nodes(grid, corner), 1);
  for (PetscInt k = 0; k < corner->n_nodes; ++k)
    assert_near(grid->x[2 * corner->nodes[k]] + grid->x[2 * corner->nodes[k] + 1], 0);
  assert_near(faces_area(grid, &grid->outer, normal), 2 + 2 + 1 + 1 + 2 * PetscSqrtReal(1.25));
  for (int d = 0; d < 2; ++d) assert_near(normal[d], 0);
  assert_near(grid->max[0], 3.0);
  assert_near(grid->min[1], 0.0);
  check_ghosts(grid);
}

/* A position in each cell of each rank, at the weights given to its nodes. All ranks look for
 * it. */
static inline void locate_in_cells(const Grid *grid, const PetscReal *weights)
{
  PetscMPIInt size, rank;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  for (PetscMPIInt r = 0; r < size; ++r) {
    PetscInt n = grid->n_cells;
    MPI_Bcast(&n, 1, MPIU_INT, r, PETSC_COMM_WORLD);
    for (PetscInt c = 0; c < n; ++c) {
      PetscReal x[3] = {0, 0, 0}, sum = 0;
      for (PetscInt i = 0; i < grid->nodes_per_cell; ++i) sum += weights[i];
      for (PetscInt i = 0; i < grid->nodes_per_cell && r == rank; ++i)
        for (PetscInt d = 0; d < grid->dim; ++d)
          x[d] += weights[i] / sum * grid->x[grid->cell_node[c * grid->nodes_per_cell + i] * grid->dim + d];
      MPI_Bcast(x, 3, MPIU_REAL, r, PETSC_COMM_WORLD);
      const PetscInt found = check_located(grid, x);
      assert_int_equal(count_over_ranks(found), 1);
      PetscMPIInt ranks[8];
      const PetscReal holder = sum_over_ranks(found ? rank : 0);
      PetscBool named = found != 0;
      for (PetscInt k = grid_candidates(grid, x, 8, ranks) - 1; k >= 0; --k) named |= ranks[k] == (PetscMPIInt)holder;
      assert_true(named);
    }
  }
}
