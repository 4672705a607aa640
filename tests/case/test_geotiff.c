/* GeoTIFF files, written here byte by byte, as GDAL reads them and talus gets them. Without gdal_translate only what is
 * said then is tried, and the test says so. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>
#include "case/terrain/relief.h"
#include "case/terrain/geotiff.h"

enum { COLUMNS = 5, ROWS = 4, MOST = 4096 };
static char file[] = "/tmp/talus_geotiff_XXXXXX";
static char message[1024];

static int open_file(void **state)
{
  (void)state;
  const int fd = mkstemp(file);
  return fd < 0 || close(fd);
}

static int remove_file(void **state)
{
  (void)state;
  return unlink(file);
}

/* A TIFF of doubles in one strip, little or big end first, as its specification has it. */
typedef struct {
  int big, n; /* which end is first; entries so far */
  unsigned char at[MOST];
  size_t behind; /* where the next values go */
} Tiff;

static void put(Tiff *t, size_t at, int bytes, uint64_t value)
{
  for (int k = 0; k < bytes; ++k) t->at[at + (size_t)(t->big ? bytes - 1 - k : k)] = (unsigned char)(value >> (8 * k));
}

/* Entry: tag, type (2 text, 3 short, 4 long, 12 double), values. */
static void entry(Tiff *t, int tag, int type, int count, const double *values, const char *text)
{
  const int bytes = type == 2 ? 1 : type == 3 ? 2 : type == 4 ? 4 : 8;
  const size_t at = 10 + 12 * (size_t)t->n++;
  const int inside = bytes * count <= 4;
  put(t, at, 2, (uint64_t)tag);
  put(t, at + 2, 2, (uint64_t)type);
  put(t, at + 4, 4, (uint64_t)count);
  size_t to = inside ? at + 8 : t->behind;
  if (!inside) put(t, at + 8, 4, t->behind), t->behind += (size_t)(bytes * count + bytes * count % 2);
  for (int k = 0; k < count; ++k, to += (size_t)bytes) {
    uint64_t bits;
    if (type == 2) bits = (unsigned char)text[k];
    else if (type == 12) memcpy(&bits, values + k, sizeof bits);
    else bits = (uint64_t)values[k];
    put(t, to, bytes, bits);
  }
}

static void one(Tiff *t, int tag, int type, double value) { entry(t, tag, type, 1, &value, NULL); }

static double height(int i, int j) { return i == 4 && j == 0 ? -9999 : 100 + 0.1 * i - 0.7 * j; }

typedef struct {
  int big, model, unit; /* GTModelType: 1 projected, 2 degrees, 0 nothing said; its unit: 9001 m, 9003 ft */
  double size[2];       /* of cells */
  int lacks_place, is_point;
} Kind;

/* Rows from north to south; the first one's outer corner (its centre if is_point) is (500000, 4000040). */
static void write_tiff(const Kind *kind)
{
  Tiff *t = calloc(1, sizeof *t);
  const size_t heights = 2048;
  t->big = kind->big;
  t->behind = 512;
  memcpy(t->at, t->big ? "MM" : "II", 2);
  put(t, 2, 2, 42);
  put(t, 4, 4, 8);
  one(t, 256, 4, COLUMNS), one(t, 257, 4, ROWS), one(t, 258, 3, 64), one(t, 259, 3, 1), one(t, 262, 3, 1);
  one(t, 273, 4, (double)heights), one(t, 277, 3, 1), one(t, 278, 4, ROWS), one(t, 279, 4, 8 * COLUMNS * ROWS);
  one(t, 339, 3, 3);
  if (!kind->lacks_place) {
    entry(t, 33550, 12, 3, (double[]){kind->size[0], kind->size[1], 0}, NULL);
    entry(t, 33922, 12, 6, (double[]){0, 0, 0, 500000, 4000040, 0}, NULL);
    double keys[] = {1,
                     1,
                     0,
                     3,
                     1024,
                     0,
                     1,
                     kind->model,
                     1025,
                     0,
                     1,
                     kind->is_point ? 2 : 1,
                     kind->model == 1 ? 3072 : 2048,
                     0,
                     1,
                     kind->model == 1 ? 32632 : 4326,
                     3076,
                     0,
                     1,
                     kind->unit};
    if (kind->unit) keys[3] = 4;
    if (kind->unit == 9003) keys[15] = 2227; /* California, zone 3 */
    if (kind->model) entry(t, 34735, 3, kind->unit ? 20 : 16, keys, NULL);
  }
  entry(t, 42113, 2, 6, NULL, "-9999");
  put(t, 8, 2, (uint64_t)t->n);
  for (int j = 0; j < ROWS; ++j)
    for (int i = 0; i < COLUMNS; ++i) {
      const double z = height(i, j);
      uint64_t bits;
      memcpy(&bits, &z, sizeof bits);
      put(t, heights + 8 * (size_t)(j * COLUMNS + i), 8, bits);
    }
  FILE *out = fopen(file, "wb");
  assert_true(out && fwrite(t->at, heights + 8 * COLUMNS * ROWS, 1, out) == 1 && fclose(out) == 0);
  free(t);
}

static Relief *read_file(PetscReal scale, const PetscReal offset[3])
{
  Relief *relief;
  assert_int_equal(ReliefRead(file, scale, offset, &relief, sizeof message, message), 0);
  return relief;
}

static void needs_gdal(void)
{
  if (!system("command -v gdal_translate >/dev/null 2>&1")) return;
  print_message("skipped: there is no gdal_translate\n");
  skip();
}

/* Place, order of rows, heights to the last bit and what has none; both orders of bytes; with and without a system. */
static void Reads(void **state)
{
  (void)state;
  needs_gdal();
  for (int k = 0; k < 8; ++k) {
    const Kind kind = {.big = k & 1, .model = k & 2 ? 1 : 0, .is_point = k >= 6, .size = {10, 10}};
    const double half = kind.is_point ? 0 : 5;
    write_tiff(&kind);
    Relief *r = read_file(1, (const PetscReal[]){-500000, -4000000, 7});
    if (!r) fail_msg("%s", message);
    assert_true(r->n[0] == COLUMNS && r->n[1] == ROWS && r->step == 10);
    assert_true(fabs(r->low[0] - half) < 1e-6 && fabs(r->low[1] - (10 - half)) < 1e-6);
    for (int j = 0; j < ROWS; ++j)
      for (int i = 0; i < COLUMNS; ++i) {
        const PetscReal z = relief_post(r, i, ROWS - 1 - j);
        if (i == 4 && j == 0) assert_true(isnan(z));
        else assert_true(z == height(i, j) + 7);
      }
    assert_int_equal(ReliefDestroy(&r), 0);
  }
}

/* What would be read as something else is refused, with what mends it. */
static void Refuses(void **state)
{
  static const struct {
    Kind kind;
    const char *says;
  } bad[] = {
    {{.model = 2, .size = {10, 10}}, "its coordinates are degrees, not metres: gdalwarp"},
    {{.model = 1, .size = {10, 5}}, "its cells are 10 x 5 and not square: gdalwarp -r bilinear -tr 10 10"},
    {{.model = 1, .unit = 9003, .size = {10, 10}}, "not in metres: scale: 0.3048006096 makes metres of it"},
    {{.lacks_place = 1}, "does not say where its cells are: it is no GeoTIFF"},
  };
  const PetscReal zero[3] = {0, 0, 0};
  (void)state;
  needs_gdal();
  for (size_t k = 0; k < sizeof bad / sizeof *bad; ++k) {
    write_tiff(&bad[k].kind);
    if (read_file(1, zero)) fail_msg("not refused: %s", bad[k].says);
    if (!strstr(message, bad[k].says)) fail_msg("'%s' does not say '%s'", message, bad[k].says);
    if (bad[k].kind.unit != 9003) continue;
    Relief *r = read_file(1200.0 / 3937.0, zero);
    assert_true(r && fabs(r->step - 12000.0 / 3937.0) < 1e-9);
    assert_int_equal(ReliefDestroy(&r), 0);
  }
  assert_int_equal(truncate(file, 64), 0);
  assert_null(read_file(1, zero));
  if (!strstr(message, "gdal_translate cannot read it: ERROR")) fail_msg("%s", message);
}

/* Without the program: its package, and what to do elsewhere. A name cannot be an option. */
static void NoProgram(void **state)
{
  const PetscReal zero[3] = {0, 0, 0};
  char *paths = strdup(getenv("PATH")), folder[] = "/tmp/talus_geotiff_XXXXXX";
  (void)state;
  write_tiff(&(Kind){.model = 1, .size = {10, 10}});
  setenv("PATH", "/nowhere", 1);
  assert_null(read_file(1, zero));
  assert_non_null(strstr(message, "apt install gdal-bin"));
  assert_non_null(strstr(message, "gdal_translate -of AAIGrid /tmp/"));
  setenv("PATH", paths, 1);
  free(paths);
  needs_gdal();
  assert_true(mkdtemp(folder) && !chdir(folder) && !rename(file, "-of"));
  Relief *r;
  assert_int_equal(ReliefRead("-of", 1, zero, &r, sizeof message, message), 0);
  assert_true(r && r->n[0] == COLUMNS);
  assert_int_equal(ReliefDestroy(&r), 0);
  assert_true(!rename("-of", file) && !chdir("/") && !rmdir(folder));
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Reads), cmocka_unit_test(Refuses), cmocka_unit_test(NoProgram)};
  return cmocka_run_group_tests(tests, open_file, remove_file);
}
