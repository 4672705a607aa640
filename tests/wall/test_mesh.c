/* Walls as lines and triangles: every middle of a piece lies on its wall, where that is by then, and pieces have the
 * length or the surface that the shape has in view. */
#include "walls.h"
#include "wall/facets/mesh.h"

#define SIZE 0.02

static double part(const WallMesh *mesh, PetscInt i)
{
  const double *a = mesh->x + 3 * i * mesh->dim, *b = a + 3, *c = mesh->dim == 3 ? a + 6 : a;
  double n[3], u[3], v[3];
  for (int d = 0; d < 3; ++d) u[d] = b[d] - a[d], v[d] = c[d] - a[d];
  if (mesh->dim == 2) return sqrt(u[0] * u[0] + u[1] * u[1]);
  for (int d = 0; d < 3; ++d) n[d] = u[(d + 1) % 3] * v[(d + 2) % 3] - u[(d + 2) % 3] * v[(d + 1) % 3];
  return 0.5 * sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
}

/* The wall at 0.7 s: pieces within `sagitta` of it, together `whole` within a share `off`. */
static void check(WallSpec spec, const Kinematics *kinematics, double whole, double off)
{
  const double min[3] = {-1, -1, -1}, max[3] = {2, 1, 1};
  const WallView view = {.min = min, .max = max, .size = SIZE};
  WallMesh mesh = {.dim = kinematics->dim};
  double sum = 0, worst = 0;
  OneWall one;
  wall_open(&one, kinematics, spec);
  assert_int_equal(WallMeshAdd(one.walls, 0, 0.7, &view, &mesh), 0);
  for (PetscInt i = 0; i < mesh.n; ++i) {
    double x[3] = {0, 0, 0};
    WallPlace place;
    for (PetscInt c = i * mesh.dim; c < (i + 1) * mesh.dim; ++c) {
      assert_int_equal(mesh.node[c], c);
      for (int d = 0; d < 3; ++d) x[d] += mesh.x[3 * c + d] / (double)mesh.dim;
    }
    sum += part(&mesh, i);
    assert_true(wall_near(one.walls, 0, 0.7, x, 9, 0, &place));
    worst = fmax(worst, fabs(place.gap));
  }
  if (worst > 3e-3 || fabs(sum - whole) > off * whole) fail_msg("%g off, %.9g instead of %.9g", worst, sum, whole);
  assert_int_equal(WallMeshFree(&mesh), 0);
  wall_close(&one);
}

static void Plane(void **state)
{
  double corners[] = {0, 0, 1, 0, 1, 0.5};
  const Kinematics *k = &kinematics_plane_strain;
  MotionSpec turn = {
    .kind = MOTION_ROTATION, .component = {1, 1, 1}, .centre = {0.3, 0.2}, .axis = {0, 0, 1}, .rate = 1};
  (void)state;
  check((WallSpec){.shape = {.kind = SHAPE_BALL, .centre = {0.5, 0}, .radius = 0.25}}, k, 0.5 * M_PI, 1e-3);
  check((WallSpec){.shape = {.kind = SHAPE_ARC, .centre = {0, 0}, .radius = 0.5, .angle = {10, 100}}}, k, M_PI / 4,
        1e-3);
  check((WallSpec){.shape = {.kind = SHAPE_BOX, .max = {0.3, 0.2}}}, k, 1, 1e-12);
  check((WallSpec){.shape = {.kind = SHAPE_POLYGON, .n_vertices = 3, .vertices = corners}}, k, 1.5 + sqrt(1.25), 1e-12);
  check(
    (WallSpec){.shape = {.kind = SHAPE_LINE, .n_vertices = 3, .vertices = corners}, .n_motions = 1, .motions = &turn},
    k, 1.5, 1e-12);
  /* from (-1, -0.5) to (2, 1) */
  check((WallSpec){.shape = {.kind = SHAPE_HALF_SPACE, .normal = {-1, 2}}}, k, 1.5 * sqrt(5), 1e-12);
  /* a lens: two arcs of 120 degrees */
  Shape two[2] = {{.kind = SHAPE_BALL, .centre = {0, 0}, .radius = 0.5},
                  {.kind = SHAPE_BALL, .centre = {0.5, 0}, .radius = 0.5}};
  check((WallSpec){.shape = {.kind = SHAPE_INTERSECTION, .n_children = 2, .children = two}}, k, 2 * M_PI / 3, 0.05);
}

static void Space(void **state)
{
  const Kinematics *k = &kinematics_3d;
  MotionSpec fall = {.kind = MOTION_VELOCITY, .component = {1, 1, 1}, .value = {0.1, -0.2, 0.3}};
  (void)state;
  check((WallSpec){.shape = {.kind = SHAPE_BALL, .radius = 0.5}, .n_motions = 1, .motions = &fall}, k, M_PI, 2e-3);
  check((WallSpec){.shape = {.kind = SHAPE_BOX, .max = {0.3, 0.2, 0.1}}}, k, 2 * (0.06 + 0.03 + 0.02), 1e-12);
  check(
    (WallSpec){
      .shape = {.kind = SHAPE_CYLINDER, .point = {0.1, 0, 0}, .normal = {1, 1, 0}, .radii = {0.3, 0.3}, .length = 0.5}},
    k, 2 * M_PI * 0.09 + 2 * M_PI * 0.3 * 0.5, 2e-3);
  check((WallSpec){.shape = {.kind = SHAPE_DISK, .normal = {0, 1, 1}, .radii = {0.1, 0.4}}}, k, M_PI * 0.15, 2e-3);
  check((WallSpec){.shape = {.kind = SHAPE_HALF_SPACE, .point = {0, 0, 0.5}, .normal = {0, 0, 1}}}, k, 6, 1e-12);
  check((WallSpec){.shape = {.kind = SHAPE_HALF_SPACE, .normal = {0, 1, 1}}}, k, 3 * 2 * sqrt(2), 1e-12);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Plane), cmocka_unit_test(Space)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
