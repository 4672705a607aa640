/* Rigid walls: seconds to read and prepare a sphere of 131,072 triangles from an STL file, and
 * nanoseconds to ask how near it is, beside the sphere by its formula; on one core.
 *
 *   cmake --build build --target bench_wall && build/bench/bench_wall
 *
 * `within` is 2 % of the radius, two cells of a grid of 100 cells. Figures are the best of five
 * passes. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>
#include "wall/wall.h"

enum { SIDE = 128, QUERIES = 100000 };

static double processor_now(void)
{
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double uniform(void) { return rand() / (RAND_MAX + 1.0); }

/* One triangle of an octant, by its corners' numbers along two sides, blown up to the unit sphere. */
static void write_triangle(FILE *out, int octant, const int place[3][2])
{
  const int odd = (octant & 1) ^ (octant >> 1 & 1) ^ (octant >> 2 & 1);
  float value[12] = {0};
  const uint16_t none = 0;
  for (int k = 0; k < 3; ++k) {
    const int a = place[odd ? 2 - k : k][0], b = place[odd ? 2 - k : k][1], c = SIDE - a - b;
    const double x[3] = {a, b, c}, length = sqrt(a * a + b * b + c * c);
    for (int d = 0; d < 3; ++d) value[3 + 3 * k + d] = (float)((octant >> d & 1 ? -1 : 1) * x[d] / length);
  }
  fwrite(value, sizeof value, 1, out);
  fwrite(&none, sizeof none, 1, out);
}

/* An octant of an octahedron in SIDE x SIDE triangles. */
static void write_octant(FILE *out, int octant)
{
  for (int i = 0; i < SIDE; ++i)
    for (int j = 0; j < SIDE - i; ++j)
      for (int up = 0; up < 2 - (i + j == SIDE - 1); ++up) {
        const int place[2][3][2] = {{{i, j}, {i + 1, j}, {i, j + 1}}, {{i + 1, j}, {i + 1, j + 1}, {i, j + 1}}};
        write_triangle(out, octant, place[up]);
      }
}

static void write_sphere(const char *path)
{
  const char head[80] = "sphere";
  const uint32_t n = 8 * SIDE * SIDE;
  FILE *out = fopen(path, "wb");
  if (!out) exit(1);
  fwrite(head, sizeof head, 1, out);
  fwrite(&n, sizeof n, 1, out);
  for (int octant = 0; octant < 8; ++octant) write_octant(out, octant);
  fclose(out);
}

typedef enum { ANYWHERE, NEAR_SHUFFLED, NEAR_IN_ORDER } Where;
static const char *const where_names[] = {"anywhere", "near, shuffled", "near, in order"};

/* Where material can be: outside of the sphere or inside; anywhere in its box, or within 1 % of the
 * radius from its surface, then along a spiral or shuffled. */
static void fill(Where where, int inside, double (*x)[3])
{
  for (int q = 0; q < QUERIES; ++q) {
    const double share = where == NEAR_IN_ORDER ? (q + 0.5) / QUERIES : uniform();
    const double turn = where == NEAR_IN_ORDER ? 150 * share : uniform(), z = 2 * share - 1;
    const double radius = 1 + (inside ? -0.01 : 0.01) * uniform(), side = radius * sqrt(1 - z * z);
    double length;
    x[q][0] = side * cos(2 * PETSC_PI * turn), x[q][1] = side * sin(2 * PETSC_PI * turn), x[q][2] = radius * z;
    if (where != ANYWHERE) continue;
    do {
      length = 0;
      for (int d = 0; d < 3; ++d) x[q][d] = 2 * uniform() - 1, length += x[q][d] * x[q][d];
    } while ((length > 1) == inside);
  }
}

static double nanoseconds(const Walls *walls, PetscReal t, double (*x)[3], int *found)
{
  double best = 1e300;
  for (int pass = 0; pass < 5; ++pass) {
    const double start = processor_now();
    *found = 0;
    for (int q = 0; q < QUERIES; ++q) {
      WallPlace place;
      *found += wall_near(walls, 0, t, x[q], 0.02, 0, &place);
    }
    best = PetscMin(best, (processor_now() - start) / QUERIES);
  }
  return 1e9 * best;
}

static PetscErrorCode Measure(const char *name, WallSpec *spec)
{
  static double x[QUERIES][3];
  Case c = {.kinematics = &kinematics_3d, .grid = {.kind = GRID_MESH}, .n_walls = 1, .walls = spec};
  Walls *walls;
  Diag *diag;

  PetscFunctionBeginUser;
  PetscCall(DiagCreate(&diag));
  double start = processor_now();
  PetscCall(WallsCreate(&c, diag, &walls));
  start = processor_now() - start;
  PetscCall(DiagFlush(diag, stderr));
  for (int where = 0; where < 3; ++where) {
    int found;
    fill((Where)where, spec->inside, x);
    const double each = nanoseconds(walls, 0.3, x, &found);
    printf("%-32s %8.3f s  %-15s %7.1f ns (%5.1f %% within)\n", name, start, where_names[where], each,
           100.0 * found / QUERIES);
  }
  PetscCall(WallsDestroy(&walls));
  PetscCall(DiagDestroy(&diag));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  char path[] = "/tmp/bench_wall_XXXXXX.stl";
  MotionSpec turn = {.kind = MOTION_ROTATION, .component = {1, 1, 1}, .axis = {1, 1, 1}, .rate = 1};

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  close(mkstemps(path, 4));
  write_sphere(path);
  for (int inside = 0; inside < 2; ++inside)
    for (int moving = 0; moving < 2; ++moving) {
      char name[64];
      WallSpec ball = {
        .shape = {.kind = SHAPE_BALL, .radius = 1}, .inside = inside, .n_motions = moving, .motions = &turn};
      WallSpec stl = ball;
      stl.shape = (Shape){.kind = SHAPE_SURFACE, .file = path, .scale = 1};
      snprintf(name, sizeof name, "sphere%s%s", inside ? ", container" : "", moving ? ", turning" : "");
      PetscCall(Measure(name, &ball));
      snprintf(name, sizeof name, "STL%s%s", inside ? ", container" : "", moving ? ", turning" : "");
      PetscCall(Measure(name, &stl));
    }
  unlink(path);
  PetscCall(PetscFinalize());
  return 0;
}
