/* A mesh goes from rank to rank: what arrives is the grid that reading it would have made, whatever
 * way it went; and the cuts balance weights. */
#include "grid/search/directory.h"
#include "grid/mesh/mesh.h"
#include "mesh_test.h"

static PetscMPIInt ranks(void)
{
  PetscMPIInt size;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  return size;
}

static void same_numbers(PetscInt n, const PetscInt *a, const PetscInt *b)
{
  for (PetscInt i = 0; i < n; ++i) assert_int_equal(a[i], b[i]);
}

static void same_reals(PetscInt n, const PetscReal *a, const PetscReal *b)
{
  for (PetscInt i = 0; i < n; ++i) assert_true(a[i] == b[i]);
}

static void same_sets(const GridSet *a, const GridSet *b)
{
  assert_true(a->name == b->name || !strcmp(a->name, b->name));
  assert_int_equal(a->n_nodes, b->n_nodes);
  assert_int_equal(a->n_faces, b->n_faces);
  assert_int_equal(a->n_cells, b->n_cells);
  same_numbers(a->n_nodes, a->nodes, b->nodes);
  same_numbers(a->n_faces, a->face_cell, b->face_cell);
  same_numbers(a->n_faces, a->face_side, b->face_side);
  same_numbers(a->n_cells, a->cells, b->cells);
}

static void same_ghosts(const Grid *a, const Grid *b)
{
  PetscInt roots[2], leaves[2];
  const PetscInt *leaf[2];
  const PetscSFNode *root[2];
  CALL(PetscSFGetGraph(a->node_sf, &roots[0], &leaves[0], &leaf[0], &root[0]));
  CALL(PetscSFGetGraph(b->node_sf, &roots[1], &leaves[1], &leaf[1], &root[1]));
  assert_int_equal(roots[0], roots[1]);
  assert_int_equal(leaves[0], leaves[1]);
  for (PetscInt i = 0; i < leaves[0]; ++i) {
    assert_int_equal(leaf[0] ? leaf[0][i] : i, leaf[1] ? leaf[1][i] : i);
    assert_true(root[0][i].rank == root[1][i].rank && root[0][i].index == root[1][i].index);
  }
}

/* To the last bit. */
static void same_grids(const Grid *a, const Grid *b)
{
  const PetscInt n_sides = a->n_cells * cells[a->type].faces;
  assert_true(a->dim == b->dim && a->type == b->type && a->first_type == b->first_type && a->n_first == b->n_first &&
              a->nodes_per_cell == b->nodes_per_cell);
  assert_true(a->n_cells == b->n_cells && a->n_cells_global == b->n_cells_global);
  assert_true(a->n_owned == b->n_owned && a->n_nodes == b->n_nodes && a->n_nodes_global == b->n_nodes_global);
  assert_true(a->smallest == b->smallest);
  same_reals(3, a->min, b->min);
  same_reals(3, a->max, b->max);
  same_numbers(a->n_cells * a->nodes_per_cell, a->cell_node, b->cell_node);
  same_numbers(a->n_cells, a->global_cell, b->global_cell);
  same_numbers(a->n_nodes, a->global_node, b->global_node);
  same_numbers(a->n_nodes, a->mesh->file_node, b->mesh->file_node);
  same_numbers(n_sides, a->mesh->neighbour, b->mesh->neighbour);
  for (PetscInt k = 0, f = 0; k < n_sides; ++k)
    if (a->mesh->neighbour[k] <= -2) {
      assert_int_equal(a->mesh->far_cell[f], b->mesh->far_cell[f]);
      ++f;
    }
  same_reals(a->n_nodes * a->dim, a->x, b->x);
  same_reals(6 * ranks(), a->rank_bounds[0], b->rank_bounds[0]);
  same_ghosts(a, b);
  assert_int_equal(a->n_sets, b->n_sets);
  for (PetscInt s = 0; s < a->n_sets; ++s) same_sets(a->sets + s, b->sets + s);
  same_sets(&a->outer, &b->outer);
}

static Grid *travel(const Grid *old, const PetscMPIInt *owner)
{
  Grid *grid;
  CALL(MeshFromOwners(old, owner, &grid));
  return grid;
}

/* Every cell to a rank of its own choice. */
static Grid *scatter(const Grid *old, PetscInt step)
{
  PetscMPIInt *owner;
  CALL(PetscMalloc1(old->n_cells, &owner));
  for (PetscInt c = 0; c < old->n_cells; ++c) owner[c] = (PetscMPIInt)(old->global_cell[c] / step % ranks());
  Grid *grid = travel(old, owner);
  for (PetscInt c = 0; c < grid->n_cells; ++c) assert_int_equal(grid->global_cell[c] / step % ranks(), my_rank());
  CALL(PetscFree(owner));
  return grid;
}

/* Every cell to where it is in `home`. */
static Grid *send_home(const Grid *old, const Grid *home)
{
  DirectoryPlace *place;
  PetscMPIInt *owner;
  CALL(PetscMalloc2(old->n_cells, &place, old->n_cells, &owner));
  CALL(DirectoryFind(PETSC_COMM_WORLD, home->n_cells_global, home->n_cells, home->global_cell, old->n_cells,
                     old->global_cell, place));
  for (PetscInt c = 0; c < old->n_cells; ++c) owner[c] = (PetscMPIInt)place[c].rank;
  Grid *grid = travel(old, owner);
  CALL(PetscFree2(place, owner));
  return grid;
}

static void there_and_back(void **state)
{
  static const PetscReal inside[8] = {1, 2, 3, 2.5, 1.5, 0.7, 0.9, 3}, node[8] = {0, 1};
  (void)state;
  for (int m = 0; m < MESHES; ++m) {
    generate(meshes[m].source, "travel.msh", meshes[m].options);
    Grid *home = read_mesh("travel.msh", meshes[m].dim);
    Grid *first = scatter(home, 1), *second = scatter(first, 7), *back = send_home(second, home);
    same_grids(home, back);
    check_ghosts(second);
    if (meshes[m].dim == 2) check_plane(second);
    locate_in_cells(second, inside);
    locate_in_cells(second, node);
    CALL(GridDestroy(&first));
    CALL(GridDestroy(&second));
    CALL(GridDestroy(&back));
    CALL(GridDestroy(&home));
  }
}

/* All of it to the last rank, and to where it was. */
static void all_to_one(void **state)
{
  PetscMPIInt *owner;
  (void)state;
  generate("plane", "one.msh", "-2 -setnumber h 0.3");
  Grid *home = read_mesh("one.msh", 2);
  CALL(PetscMalloc1(home->n_cells, &owner));
  for (PetscInt c = 0; c < home->n_cells; ++c) owner[c] = ranks() - 1;
  Grid *grid = travel(home, owner);
  assert_int_equal(grid->n_cells, my_rank() == ranks() - 1 ? home->n_cells_global : 0);
  assert_int_equal(grid->n_nodes, my_rank() == ranks() - 1 ? home->n_nodes_global : 0);
  for (PetscInt i = 0; i < grid->n_nodes; ++i) assert_int_equal(grid->mesh->file_node[i], i);
  check_plane(grid);
  Grid *back = send_home(grid, home);
  same_grids(home, back);
  CALL(PetscFree(owner));
  CALL(GridDestroy(&grid));
  CALL(GridDestroy(&back));
  CALL(GridDestroy(&home));
}

/* Weight in a disk, and nothing elsewhere. */
static void weigh_disk(const Grid *grid, PetscReal x, PetscReal y, PetscReal radius, PetscReal *weight)
{
  for (PetscInt c = 0; c < grid->n_cells; ++c) {
    PetscReal at[3];
    grid_cell_centre(grid, c, at);
    weight[c] = PetscHypotReal(at[0] - x, at[1] - y) < radius ? 4.2 : 0;
  }
}

static PetscReal imbalance(PetscInt n, const PetscReal *weight)
{
  PetscReal sum = 0, largest;
  for (PetscInt c = 0; c < n; ++c) sum += weight[c];
  CALL(MPI_Allreduce(&sum, &largest, 1, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  const PetscReal all = sum_over_ranks(sum);
  return all > 0 ? largest * ranks() / all : 1;
}

static Grid *share_by_disk(const Grid *old, PetscReal x, PetscReal y, PetscReal radius, PetscReal *reached)
{
  PetscReal *weight;
  Grid *grid;
  CALL(PetscMalloc1(old->n_cells, &weight));
  weigh_disk(old, x, y, radius, weight);
  CALL(GridRepartition(old, weight, PETSC_MAX_REAL, reached, &grid));
  CALL(PetscFree(weight));
  return grid;
}

/* A disk of weight goes through the mesh, and the ranks after it. Cells without weight count a
 * little, a fifteenth of all here, and their ranks have so much less of the disk. */
static void follows_weight(void **state)
{
  PetscReal reached, *weight;
  (void)state;
  generate("plane", "fine.msh", "-2 -setnumber h 0.04");
  Grid *grid = read_mesh("fine.msh", 2);
  for (int k = 0; k < 4; ++k) {
    const PetscReal x = 0.4 + 0.7 * k, y = x < 2 ? 0.5 : 0.5 + 0.5 * (x - 2);
    Grid *next = share_by_disk(grid, x, y, 0.45, &reached);
    CALL(PetscMalloc1(next->n_cells, &weight));
    weigh_disk(next, x, y, 0.45, weight);
    assert_near(imbalance(next->n_cells, weight), reached);
    CALL(PetscFree(weight));
    assert_true(reached < 1.12);
    check_plane(next);
    const PetscReal ghosts = sum_over_ranks((PetscReal)(next->n_nodes - next->n_owned));
    assert_true(ghosts < 100 * (ranks() - 1) + 1); /* 76 nodes along the mesh, 26 across */
    CALL(GridDestroy(&grid));
    grid = next;
  }
  Grid *idle = share_by_disk(grid, 99, 99, 0.1, &reached); /* nothing weighs anything: by cells */
  assert_true(reached == 1 && count_over_ranks(idle->n_cells) == grid->n_cells_global);
  assert_true(idle->n_cells * ranks() < 1.15 * grid->n_cells_global);
  CALL(GridDestroy(&idle));
  CALL(GridDestroy(&grid));
}

static void not_worth_it(void **state)
{
  PetscReal reached, *weight;
  Grid *next;
  (void)state;
  generate("plane", "rest.msh", "-2 -setnumber h 0.3");
  Grid *grid = read_mesh("rest.msh", 2);
  CALL(PetscCalloc1(grid->n_cells, &weight));
  weigh_disk(grid, 0.5, 0.5, 0.3, weight);
  CALL(GridRepartition(grid, weight, 0.999, &reached, &next));
  assert_true(!next && reached >= 1);
  CALL(PetscFree(weight));
  CALL(GridDestroy(&grid));
}

/* Into a table and back, from the mesh as it is read: the same grid to the last bit. */
static void by_table(void **state)
{
  PetscReal reached;
  (void)state;
  for (int m = 0; m < MESHES; ++m) {
    char reason[256] = "";
    Tables *tables;
    Grid *again;
    generate(meshes[m].source, "table.msh", meshes[m].options);
    Grid *grid = read_mesh("table.msh", meshes[m].dim), *shared = share_by_disk(grid, 0.7, 0.5, 0.4, &reached);
    CALL(TablesCreate(&tables));
    CALL(GridPartitionToTable(shared, tables));
    Table *table = tables_find(tables, "partition");
    CALL(GridFromPartition(grid, table, &again, reason));
    assert_int_equal(reason[0], 0);
    same_grids(shared, again);
    CALL(GridDestroy(&again));
    /* One rank's table is damaged, and all are told. */
    if (my_rank() == ranks() - 1)
      *(PetscInt64 *)table_data(table, "cell", COLUMN_INT64, 1, reason) = grid->n_cells_global;
    CALL(GridFromPartition(grid, table, &again, reason));
    assert_true(!again && strstr(reason, "no such cell"));
    reason[0] = 0;
    if (my_rank() == ranks() - 1) --table->rows;
    if (my_rank() == ranks() - 1)
      *(PetscInt64 *)table_data(table, "cell", COLUMN_INT64, 1, reason) = shared->global_cell[0];
    CALL(GridFromPartition(grid, table, &again, reason));
    assert_true(!again && strstr(reason, "is missing"));
    CALL(TablesDestroy(&tables));
    CALL(GridDestroy(&shared));
    CALL(GridDestroy(&grid));
  }
}

/* More ranks than cells. */
static void two_cells(void **state)
{
  static const char text[] =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n"
    "$Elements\n3\n1 2 2 1 1 1 2 3\n2 2 2 1 1 1 3 4\n3 1 2 5 1 3 4\n$EndElements\n";
  PetscReal reached;
  (void)state;
  write_file("two.msh", text, sizeof text - 1);
  Grid *grid = read_mesh("two.msh", 2), *shared = share_by_disk(grid, 0.5, 0.5, 1, &reached);
  assert_near(reached, ranks() == 1 ? 1 : ranks() / 2.0);
  assert_near(grid_volume(shared), 1.0);
  assert_near(region_volume(shared, "1"), 1.0);
  assert_int_equal(owned_nodes(shared, grid_find_set(shared, "5")), 2);
  assert_int_equal(count_over_ranks(grid_find_set(shared, "5")->n_faces), 1);
  check_ghosts(shared);
  Grid *back = send_home(shared, grid);
  same_grids(grid, back);
  CALL(GridDestroy(&back));
  CALL(GridDestroy(&shared));
  CALL(GridDestroy(&grid));
}

/* Every rank knows of a node that it has, a cell of its own or not, which sets it is in. */
static void same_on_owners(const Grid *grid, const GridSet *set)
{
  PetscReal *here, *there;
  PetscInt off = 0;
  CALL(PetscCalloc2(grid->n_nodes, &here, grid->n_nodes, &there));
  for (PetscInt k = 0; k < set->n_nodes; ++k) here[set->nodes[k]] = there[set->nodes[k]] = 1;
  CALL(GridToGhosts(grid, 1, there));
  for (PetscInt i = 0; i < grid->n_nodes; ++i) off += here[i] != there[i];
  assert_int_equal(count_over_ranks(off), 0);
  CALL(PetscFree2(here, there));
}

static void ghosts_of_surfaces(void **state)
{
  (void)state;
  generate("block", "wide.msh", "-3 -setnumber n 3 -setnumber bricks 1");
  Grid *grid = read_mesh("wide.msh", 3);
  const PetscInt before = count_over_ranks(grid->n_nodes);
  CALL(GridWiden(&grid, 2));
  assert_true(ranks() == 1 || count_over_ranks(grid->n_nodes) > before);
  for (PetscInt s = 0; s < grid->n_sets; ++s) same_on_owners(grid, grid->sets + s);
  same_on_owners(grid, &grid->outer);
  CALL(GridDestroy(&grid));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(there_and_back),     cmocka_unit_test(all_to_one), cmocka_unit_test(follows_weight),
    cmocka_unit_test(not_worth_it),       cmocka_unit_test(by_table),   cmocka_unit_test(two_cells),
    cmocka_unit_test(ghosts_of_surfaces),
  };
  return run_grid_tests(argc, argv, tests, sizeof tests / sizeof *tests, setup, teardown);
}
