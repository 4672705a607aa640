/* Meshes of Gmsh: all formats give the same grid, on any number of ranks; positions are found;
 * broken files are named, never fatal. */
#include "mesh_test.h"

static void formats_agree(void **state)
{
  static const char *const options[] = {"-2 -format msh22", "-2 -format msh22 -bin", "-2 -format msh41",
                                        "-2 -format msh41 -bin"};
  PetscInt n_cells = 0, n_nodes = 0;
  PetscReal smallest = 0;
  (void)state;
  for (int k = 0; k < 4; ++k) {
    generate("plane", "plane.msh", options[k]);
    Grid *grid = read_mesh("plane.msh", 2);
    assert_int_equal(grid->type, CELL_TRIANGLE);
    check_plane(grid);
    if (!k) n_cells = grid->n_cells_global, n_nodes = grid->n_nodes_global, smallest = grid->smallest;
    assert_true(n_cells > 100);
    assert_int_equal(grid->n_cells_global, n_cells);
    assert_int_equal(grid->n_nodes_global, n_nodes);
    assert_near(grid->smallest, smallest);
    CALL(GridDestroy(&grid));
  }
}

static void quadrilaterals(void **state)
{
  (void)state;
  generate("plane", "quads.msh", "-2 -format msh41 -setnumber quads 1");
  Grid *grid = read_mesh("quads.msh", 2);
  assert_int_equal(grid->type, CELL_QUADRILATERAL);
  check_plane(grid);
  CALL(GridDestroy(&grid));
}

/* Half of the drawing is recombined; triangles stand before quadrilaterals on every rank. */
static void mixed(void **state)
{
  (void)state;
  generate("plane", "mixed.msh", "-2 -format msh22 -setnumber quads 2");
  Grid *grid = read_mesh("mixed.msh", 2);
  assert_int_equal(grid->type, CELL_QUADRILATERAL);
  assert_int_equal(grid->first_type, CELL_TRIANGLE);
  const PetscInt triangles = count_over_ranks(grid->n_first);
  assert_true(triangles > 50 && grid->n_cells_global - triangles > 50);
  for (PetscInt c = 0; c < grid->n_cells; ++c)
    assert_int_equal(grid->cell_node[4 * c + 2] == grid->cell_node[4 * c + 3], c < grid->n_first);
  check_plane(grid);
  CALL(GridDestroy(&grid));
}

static void solids(void **state)
{
  static const char *const options[] = {"-3 -format msh41 -bin", "-3 -format msh22",
                                        "-3 -format msh22 -bin -setnumber bricks 1",
                                        "-3 -format msh41 -setnumber bricks 1"};
  (void)state;
  for (int k = 0; k < 4; ++k) {
    PetscReal normal[3];
    generate("block", "block.msh", options[k]);
    Grid *grid = read_mesh("block.msh", 3);
    assert_int_equal(grid->type, k < 2 ? CELL_TETRAHEDRON : CELL_HEXAHEDRON);
    assert_near(grid_volume(grid), 3.75);
    assert_near(region_volume(grid, "low"), 2.5);
    assert_near(region_volume(grid, "high"), 1.25);
    assert_near(boundary_area(grid, "floor", normal), 2.5);
    assert_near(normal[2], -2.5);
    assert_near(boundary_area(grid, "roof", normal), 2.5);
    assert_near(normal[2], 2.5);
    assert_int_equal(owned_nodes(grid, grid_find_set(grid, "edge")), 5);
    assert_int_equal(count_over_ranks(grid_find_set(grid, "edge")->n_faces), 0);
    if (k >= 2) assert_int_equal(grid->n_cells_global, 64);
    check_ghosts(grid);
    CALL(GridDestroy(&grid));
  }
}

static void location(void **state)
{
  (void)state;
  for (int m = 0; m < MESHES; ++m) {
    const PetscReal inside[8] = {1, 2, 3, 2.5, 1.5, 0.7, 0.9, 3}, node[8] = {0, 1}, edge[8] = {1, 1};
    generate(meshes[m].source, "where.msh", meshes[m].options);
    Grid *grid = read_mesh("where.msh", meshes[m].dim);
    locate_in_cells(grid, inside);
    locate_in_cells(grid, node);
    if (grid->dim == 2) locate_in_cells(grid, edge);
    CALL(GridDestroy(&grid));
  }
}

/* Positions of a lattice over the mesh's box: found once if inside the polygon of plane.geo, else
 * nowhere; clamped ones are found. */
static void inside_and_outside(void **state)
{
  PetscMPIInt size;
  (void)state;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  generate("plane", "lattice.msh", "-2 -format msh41 -bin");
  Grid *grid = read_mesh("lattice.msh", 2);
  for (int i = -3; i <= 33; ++i)
    for (int j = -3; j <= 18; ++j) {
      PetscReal x[2] = {0.1 * i + 0.0123, 0.1 * j + 0.0456}, xi[2];
      const PetscReal low = x[0] < 2 ? 0 : 0.5 * (x[0] - 2);
      const PetscBool inside = x[0] > 0 && x[0] < 3 && x[1] > low && x[1] < low + 1;
      assert_int_equal(count_over_ranks(check_located(grid, x)), inside);
      if (inside || size > 1) continue;
      const PetscReal start[2] = {x[0], x[1]};
      grid_clamp(grid, x);
      assert_true(grid_locate(grid, x, -1, xi) >= 0);
      if (x[0] > 0.01 && x[0] < 1.99 && x[1] > 0.5) assert_near(PetscHypotReal(x[0] - start[0], x[1] - 1.0), 0);
      /* No boundary node is nearer than the position chosen. */
      const PetscReal moved = PetscHypotReal(x[0] - start[0], x[1] - start[1]);
      for (PetscInt k = 0; k < grid->outer.n_nodes; ++k) {
        const PetscReal *y = grid->x + 2 * grid->outer.nodes[k];
        assert_true(PetscHypotReal(y[0] - start[0], y[1] - start[1]) >= moved - 1e-12);
      }
    }
  const PetscReal nan[2] = {NAN, 0.5};
  PetscReal xi[2];
  assert_int_equal(grid_locate(grid, nan, 0, xi), -1);
  CALL(GridDestroy(&grid));
}

static void clamp_solid(void **state)
{
  PetscMPIInt size;
  (void)state;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  for (int bricks = 0; bricks < 2; ++bricks) {
    generate("block", "clamp.msh", bricks ? "-3 -setnumber bricks 1" : "-3");
    Grid *grid = read_mesh("clamp.msh", 3);
    PetscReal x[3] = {1.1, 0.3, -2.0}, y[3] = {-1.0, 0.4, 0.5}, xi[3];
    if (size == 1) {
      grid_clamp(grid, x);
      assert_near(PetscAbsReal(x[0] - 1.1) + PetscAbsReal(x[1] - 0.3) + PetscAbsReal(x[2]), 0);
      grid_clamp(grid, y);
      assert_near(PetscAbsReal(y[0]) + PetscAbsReal(y[1] - 0.4) + PetscAbsReal(y[2] - 0.5), 0);
      assert_true(grid_locate(grid, x, -1, xi) >= 0 && grid_locate(grid, y, -1, xi) >= 0);
    }
    CALL(GridDestroy(&grid));
  }
}

static PetscReal tip_weight(void *context, const PetscReal *x)
{
  (void)context;
  return x[0] > 2 ? 3.0 : 0.0;
}

static void weighted_partition(void **state)
{
  PetscMPIInt size;
  PetscReal load = 0, largest;
  (void)state;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  generate("plane", "fine.msh", "-2 -setnumber h 0.04");
  const Case c = mesh_case(in_folder("fine.msh"), 2);
  Grid *grid = make_grid(&c, tip_weight, NULL);
  for (PetscInt k = 0; k < grid->n_cells; ++k) {
    PetscReal x[6];
    grid_cell_x(grid, k, x);
    load += x[0] + x[2] + x[4] > 6 ? 1.0 : 0.05;
  }
  MPI_Allreduce(&load, &largest, 1, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD);
  assert_true(largest * size / sum_over_ranks(load) < 1.1);
  CALL(GridDestroy(&grid));
}

/* More ranks than cells; and cells drawn clockwise, which are only turned. */
static void two_triangles(void **state)
{
  static const char text[] =
    "$MeshFormat\r\n2.2 0 8\r\n$EndMeshFormat\r\n$Nodes\r\n5\r\n10 0 0 0\r\n7 1 0 0\r\n3 1 1 0\r\n4 0 1 0\r\n"
    "99 9 9 9\r\n$EndNodes\r\n$Elements\r\n2\r\n5 2 2 0 1 10 3 7\r\n6 2 2 0 1 10 4 3\r\n$EndElements\r\n";
  (void)state;
  write_file("two.msh", text, sizeof text - 1);
  Grid *grid = read_mesh("two.msh", 2);
  assert_int_equal(grid->n_cells_global, 2);
  assert_int_equal(grid->n_nodes_global, 4); /* node 99 is nobody's */
  assert_int_equal(grid->n_sets, 0);
  assert_near(grid_volume(grid), 1.0);
  assert_near(grid->smallest, 1.0);
  check_ghosts(grid);
  CALL(GridDestroy(&grid));
}

static void through_gmsh(void **state)
{
  NamedValue parameters[] = {{(char *)"h", 0.5}, {(char *)"quads", 1}};
  Case c = mesh_case(TALUS_SOURCE_DIR "/tests/grid/plane.geo", 2);
  (void)state;
  Grid *grid = make_grid(&c, NULL, NULL);
  const PetscInt n_triangles = grid->n_cells_global;
  assert_int_equal(grid->type, CELL_TRIANGLE);
  check_plane(grid);
  CALL(GridDestroy(&grid));
  c.grid.n_parameters = 2;
  c.grid.parameters = parameters;
  grid = make_grid(&c, NULL, NULL);
  assert_int_equal(grid->type, CELL_QUADRILATERAL);
  assert_true(grid->n_cells_global < n_triangles);
  check_plane(grid);
  CALL(GridDestroy(&grid));
}

/* --- bad input --- */

/* What DiagFlush prints, on rank 0. */
static void collect(Diag *diag, size_t size, char *text)
{
  FILE *stream = tmpfile();
  assert_non_null(stream);
  CALL(DiagFlush(diag, stream));
  rewind(stream);
  text[fread(text, 1, size - 1, stream)] = 0;
  (void)fclose(stream);
}

/* The mesh must be refused with a message that has these words in it. */
static void refuse(const char *path, PetscInt dim, const char *words)
{
  Case c = mesh_case(path, dim);
  char text[4096];
  Diag *diag;
  Grid *grid = NULL;
  PetscInt errors;
  CALL(DiagCreate(&diag));
  CALL(GridCreate(PETSC_COMM_WORLD, &c, NULL, NULL, diag, &grid));
  assert_null(grid);
  CALL(DiagReduce(PETSC_COMM_WORLD, diag, &errors));
  assert_int_equal(errors, 1);
  collect(diag, sizeof text, text);
  if (!my_rank() && !strstr(text, words)) fail_msg("'%s' is not in: %s", words, text);
  CALL(DiagDestroy(&diag));
}

static void refuse_text(const char *text, PetscInt dim, const char *words)
{
  write_file("bad.msh", text, strlen(text));
  refuse(in_folder("bad.msh"), dim, words);
}

#define HEAD "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
#define SQUARE "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n"

static void bad_files(void **state)
{
  (void)state;
  refuse(in_folder("not-there.msh"), 2, "No such file");
  refuse(in_folder("not-there.geo"), 2, "cannot read");
  refuse(in_folder("mesh.vtk"), 2, "neither a .msh nor a .geo");
  if (!my_rank()) assert_int_equal(system("true"), 0);
  char command[128];
  (void)snprintf(command, sizeof command, "mkdir '%s'", in_folder("folder.msh"));
  if (!my_rank()) assert_int_equal(system(command), 0);
  refuse(in_folder("folder.msh"), 2, "cannot read");
  refuse_text("", 2, "empty");
  refuse_text(
    "\x7f"
    "ELF\x01\x02 garbage",
    2, "no Gmsh mesh");
  refuse_text("$MeshFormat\n4.0 0 8\n$EndMeshFormat\n", 2, "4.1");
  refuse_text("$MeshFormat\nx\n", 2, "bad.msh:2");
  refuse_text(HEAD, 2, "$Nodes");
  refuse_text(HEAD SQUARE, 2, "$Elements");
  refuse_text(HEAD "$Nodes\n4000000000\n1 0 0 0\n", 2, "truncated");
  refuse_text(HEAD "$Nodes\n-1\n", 2, "truncated");
  refuse_text(HEAD "$Nodes\n2\n1 0 0 0\n1 1 0 0\n$EndNodes\n$Elements\n0\n$EndElements\n", 2, "node 1 is given twice");
  refuse_text(HEAD "$Nodes\n1\n1 0 nan 0\n$EndNodes\n", 2, "not finite");
  refuse_text(HEAD SQUARE "$Elements\n1\n1 2 2 0 1 1 2 8\n$EndElements\n", 2, "element 1 names node 8");
  refuse_text(HEAD SQUARE "$Elements\n1\n1 15 2 0 1 1\n$EndElements\n", 2, "no triangles or quadrilaterals");
  refuse_text(HEAD SQUARE "$Elements\n1\n1 9 2 0 1 1 2 3 4 1 2\n$EndElements\n", 2, "second-order triangle");
  refuse_text(HEAD SQUARE "$Elements\n1\n1 2 2 0 1 1 2 3\n", 2, "truncated");
  refuse_text(HEAD SQUARE "$Elements\n1\n1 2 2 0 1 1 2 3\n$EndElements\n$Comments\nnever ended\n", 2, "$EndComments");
}

static void bad_meshes(void **state)
{
  (void)state;
  refuse_text(HEAD SQUARE "$Elements\n2\n1 2 2 0 1 1 2 3\n2 2 2 0 1 1 3 2\n$EndElements\n", 3,
              "no tetrahedra or hexahedra");
  refuse_text(HEAD SQUARE "$Elements\n2\n11 2 2 0 1 1 2 3\n12 2 2 0 1 1 4 3\n$EndElements\n", 2,
              "1 of 2 cells are inverted or have no volume: element 12");
  /* a bow tie */
  refuse_text(HEAD SQUARE "$Elements\n1\n11 3 2 0 1 1 3 2 4\n$EndElements\n", 2, "inverted");
  refuse_text(HEAD
              "$Nodes\n9\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 1 1\n9 2 0 0\n$EndNodes\n"
              "$Elements\n2\n1 5 2 0 1 1 2 3 4 5 6 7 8\n2 4 2 0 1 2 9 3 6\n$EndElements\n",
              3, "mixes 1 tetrahedra with 1 hexahedra");
  refuse_text(HEAD "$Nodes\n3\n1 0 0 0\n2 1 0 0.1\n3 1 1 0\n$EndNodes\n$Elements\n1\n1 2 2 0 1 1 2 3\n$EndElements\n",
              2, "node 2 has z = 0.1");
  refuse_text(HEAD
              "$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 1 1 0\n5 2 2 0\n$EndNodes\n"
              "$Elements\n3\n1 2 2 0 1 1 2 3\n2 2 2 0 1 2 4 3\n3 2 2 0 1 2 5 3\n$EndElements\n",
              2, "overlap");
  generate("block", "solid.msh", "-3");
  refuse(in_folder("solid.msh"), 2, "three-dimensional");
  generate("plane", "flat.msh", "-2");
  refuse(in_folder("flat.msh"), 3, "no tetrahedra");
  generate("plane", "second.msh", "-2 -setnumber order 2");
  refuse(in_folder("second.msh"), 2, "second-order");
}

#define SIDE_BY_SIDE(x, y)                                                                        \
  HEAD "$Nodes\n8\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 " x " 0 0\n6 2 0 0\n7 2 1 0\n8 " x " " y \
       " 0\n$EndNodes\n"                                                                          \
       "$Elements\n2\n1 3 2 0 1 1 2 3 4\n2 3 2 0 2 5 6 7 8\n$EndElements\n"

/* A mesh is made of the text for a case, of which one is told this, or nothing. */
static void tell_of(Case c, const char *text, const char *said)
{
  char *printed = NULL;
  size_t size;
  Diag *diag;
  Grid *grid;
  write_file("told.msh", text, strlen(text));
  CALL(DiagCreate(&diag));
  CALL(GridCreate(PETSC_COMM_WORLD, &c, NULL, NULL, diag, &grid));
  assert_non_null(grid);
  FILE *out = open_memstream(&printed, &size);
  CALL(DiagFlush(diag, out));
  (void)fclose(out);
  if (!my_rank() && said) assert_non_null(strstr(printed, said));
  else assert_string_equal(printed, "");
  free(printed);
  CALL(DiagDestroy(&diag));
  CALL(GridDestroy(&grid));
}

static void tell(const char *text, const char *said) { tell_of(mesh_case(in_folder("told.msh"), 2), text, said); }

/* Cells that touch and share no node. */
static void torn(void **state)
{
  (void)state;
  tell(SIDE_BY_SIDE("1", "1"), "2 pairs of nodes stand at one place, as at (1, 0)");
  tell(SIDE_BY_SIDE("1.00001", "1"), "2 pairs of nodes");
  tell(SIDE_BY_SIDE("1", "1.2"), "1 pair of nodes stands at one place, as at (1, 0)");
  tell(SIDE_BY_SIDE("1.01", "1"), NULL);
}

#define REGIONS(a, b)                                                                                \
  HEAD                                                                                               \
    "$Nodes\n8\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 1 0 0\n6 2 0 0\n7 2 1 0\n8 1 1 0\n$EndNodes\n" \
    "$Elements\n2\n1 3 2 " a " 1 1 2 3 4\n2 3 2 " b " 2 5 6 7 8\n$EndElements\n"

/* Unless they are of two bodies that meet at an interface; other bodies are torn all the same. */
static void met(void **state)
{
  char *between[] = {"b", "a"}, *others[] = {"a", "c"};
  BodySpec body[] = {{.name = "a", .region = "1"}, {.name = "b", .region = "2"}, {.name = "c", .region = "3"}};
  InterfaceSpec interface = {.n_between = 2, .between = between};
  Case c = mesh_case(in_folder("told.msh"), 2);
  (void)state;
  c.n_bodies = 3, c.bodies = body;
  c.n_interfaces = 1, c.interfaces = &interface;
  tell_of(c, REGIONS("1", "2"), NULL);
  tell_of(c, REGIONS("1", "3"), "2 pairs of nodes");
  tell_of(c, REGIONS("1", "1"), "2 pairs of nodes");
  interface.between = others;
  tell_of(c, REGIONS("1", "2"), "2 pairs of nodes");
}

#define LINES(n, lines)                                                                     \
  HEAD                                                                                      \
    "$PhysicalNames\n1\n1 7 \"top\"\n$EndPhysicalNames\n"                                   \
    "$Nodes\n7\n1 0 0 0\n2 1 0 0\n3 2 0 0\n4 2 1 0\n5 1 1 0\n6 0 1 0\n7 3 1 0\n$EndNodes\n" \
    "$Elements\n" n "\n1 3 2 0 1 1 2 5 6\n2 3 2 0 1 2 3 4 5\n" lines "$EndElements\n"

/* Sides of a boundary that no cell has, be it that they span two, or go to a node of none. */
static void strays(void **state)
{
  (void)state;
  tell(LINES("4", "3 1 2 7 1 5 6\n4 1 2 7 1 4 5\n"), NULL);
  tell(LINES("4", "3 1 2 7 1 5 6\n4 1 2 7 1 6 4\n"), "no cell has 1 of the 2 sides of 'top', as that around (1, 1)");
  tell(LINES("5", "3 1 2 7 1 5 6\n4 1 2 7 1 4 7\n5 1 2 7 1 6 4\n"),
       "2 of the 3 sides of 'top', as that around (2.5, 1)");
  tell(LINES("3", "3 1 2 7 1 6 4\n"), NULL); /* no boundary */
}

static void bad_geo(void **state)
{
  static const char text[] = "Point(1) = {0, 0, 0};\nLine(1) = {1, 2\n";
  (void)state;
  write_file("broken.geo", text, sizeof text - 1);
  refuse(in_folder("broken.geo"), 2, "gmsh could not mesh");
}

static void gmsh_is_missing(void **state)
{
  char *keep = NULL;
  (void)state;
  CALL(PetscStrallocpy(getenv("PATH"), &keep));
  (void)setenv("PATH", folder, 1);
  refuse(TALUS_SOURCE_DIR "/tests/grid/plane.geo", 2, "needs the program gmsh");
  (void)setenv("PATH", keep, 1);
  CALL(PetscFree(keep));
}

static char *load(const char *name, size_t *size)
{
  char *data = NULL;
  long n = 0;
  if (!my_rank()) {
    FILE *file = fopen(in_folder(name), "rb");
    assert_non_null(file);
    (void)fseek(file, 0, SEEK_END);
    n = ftell(file);
    rewind(file);
    data = malloc((size_t)n);
    assert_int_equal(fread(data, 1, (size_t)n, file), n);
    (void)fclose(file);
  }
  MPI_Bcast(&n, 1, MPI_LONG, 0, PETSC_COMM_WORLD);
  *size = (size_t)n;
  return data;
}

static const char *const damaged[] = {"-2 -format msh22", "-2 -format msh22 -bin", "-2 -format msh41",
                                      "-2 -format msh41 -bin"};

static void truncated_files(void **state)
{
  (void)state;
  for (int k = 0; k < 4; ++k) {
    size_t size;
    generate("plane", "whole.msh", damaged[k]);
    char *data = load("whole.msh", &size);
    for (size_t cut = 0; cut + 3 < size; cut += size / 40 + 1) {
      write_file("cut.msh", data, cut);
      refuse(in_folder("cut.msh"), 2, "cut.msh");
    }
    free(data);
  }
}

/* Damaged bytes: a grid or a message, whatever, but no crash and no hang. */
static void damaged_files(void **state)
{
  uint32_t seed = 12345;
  (void)state;
  for (int k = 0; k < 4; ++k) {
    size_t size;
    generate("plane", "whole.msh", damaged[k]);
    char *data = load("whole.msh", &size);
    for (int trial = 0; trial < 60; ++trial) {
      seed = seed * 1664525u + 1013904223u;
      const size_t at = seed % size;
      const char keep = data ? data[at] : 0;
      if (data) data[at] = (char)(seed >> 24);
      write_file("damaged.msh", data, size);
      if (data) data[at] = keep;
      Case c = mesh_case(in_folder("damaged.msh"), 2);
      Diag *diag;
      Grid *grid = NULL;
      PetscInt errors;
      CALL(DiagCreate(&diag));
      CALL(GridCreate(PETSC_COMM_WORLD, &c, NULL, NULL, diag, &grid));
      CALL(DiagReduce(PETSC_COMM_WORLD, diag, &errors));
      assert_true(!grid == (errors == 1));
      CALL(GridDestroy(&grid));
      CALL(DiagDestroy(&diag));
    }
    free(data);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(formats_agree),
    cmocka_unit_test(quadrilaterals),
    cmocka_unit_test(mixed),
    cmocka_unit_test(solids),
    cmocka_unit_test(location),
    cmocka_unit_test(inside_and_outside),
    cmocka_unit_test(clamp_solid),
    cmocka_unit_test(weighted_partition),
    cmocka_unit_test(two_triangles),
    cmocka_unit_test(through_gmsh),
    cmocka_unit_test(bad_files),
    cmocka_unit_test(bad_meshes),
    cmocka_unit_test(torn),
    cmocka_unit_test(met),
    cmocka_unit_test(strays),
    cmocka_unit_test(bad_geo),
    cmocka_unit_test(gmsh_is_missing),
    cmocka_unit_test(truncated_files),
    cmocka_unit_test(damaged_files),
  };
  return run_grid_tests(argc, argv, tests, sizeof tests / sizeof *tests, setup, teardown);
}
