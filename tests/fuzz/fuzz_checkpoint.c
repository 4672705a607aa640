/* Any bytes as a checkpoint; the same with the checksum of its contents mended, so that the parser
 * behind it is reached; and the tables of a model with any bytes in them, as a file would hand them
 * on whose checksums are right and whose numbers are not. The first byte chooses. */
#include <zlib.h>
#include "fuzz.h"
#include "input/case_file.h"
#include "output/checkpoint/checkpoint.h"
#include "output/checkpoint/checkpoint_contents.h"
#include "model/state/state.h"

static const char case_text[] =
  "kinematics: plane-strain\nmethod: mpm\nanalysis: {type: dynamic, step: 1e-3, end: 1}\n"
  "grid: {box: {min: [0, 0], max: [3, 2]}, size: 1}\n"
  "bodies: [{name: b, shape: {box: {min: [0, 0], max: [1, 1]}}, points_per_cell: 4, material: m}]\n"
  "materials: {m: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}\n"
  "boundary: [{on: {y: 0}, fix: [x, y]}]\nmeasures: {tip: {displacement: y, of: {tracer: [1, 1]}}}\n";
static const char cloud_text[] =
  "kinematics: plane-strain\nmethod: gmm\nbasis: {mls: {}}\nanalysis: {type: dynamic, step: 1e-3, end: 1}\n"
  "grid: {box: {min: [0, 0], max: [3, 2]}, size: 0.5}\n"
  "bodies: [{name: b, shape: {box: {min: [0, 0], max: [1, 1]}}, points_per_cell: 4, material: m}]\n"
  "materials: {m: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}\n"
  "boundary: [{on: {y: 0}, fix: [x, y]}]\nmeasures: {tip: {displacement: y, of: {tracer: [1, 1]}}}\n";
static Case *of_cells, *of_clouds;

static Model *NewModel(const Case *c)
{
  Diag *diag;
  Model *m;
  FUZZ_CALL(DiagCreate(&diag));
  FUZZ_CALL(ModelCreate(PETSC_COMM_SELF, c, diag, &m));
  FUZZ_CALL(DiagDestroy(&diag));
  if (!m) abort();
  return m;
}

static Case *NewCase(const char *text)
{
  char path[64];
  Diag *diag;
  Case *c;
  const int fd = fuzz_file((const uint8_t *)text, strlen(text), path);
  FUZZ_CALL(DiagCreate(&diag));
  FUZZ_CALL(CaseRead(PETSC_COMM_SELF, path, 0, NULL, diag, &c));
  FUZZ_CALL(DiagFlush(diag, stderr));
  FUZZ_CALL(DiagDestroy(&diag));
  if (!c) abort();
  close(fd);
  return c;
}

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
  (void)argc, (void)argv;
  fuzz_start();
  of_cells = NewCase(case_text);
  of_clouds = NewCase(cloud_text);
  return 0;
}

static void File(const uint8_t *data, size_t n)
{
  char path[64], reason[256];
  Tables *tables;
  const int fd = fuzz_file(data, n, path);
  const PetscErrorCode code = CheckpointRead(PETSC_COMM_SELF, path, &tables, reason);
  if (code && code != PETSC_ERR_FILE_UNEXPECTED && code != PETSC_ERR_FILE_OPEN) abort();
  if (code && !reason[0]) abort();
  FUZZ_CALL(TablesDestroy(&tables));
  close(fd);
}

/* The list of a file of 1 MB, with its last line made right. */
static void List(const uint8_t *data, size_t n)
{
  static const char head[] = "talus checkpoint\nversion " PetscStringize(CHECKPOINT_VERSION) "\nbytes 1000000\n";
  char reason[256];
  Contents c;
  const size_t size = strlen(head) + n + 32;
  char *text = calloc(size, 1);
  if (!text) abort();
  memcpy(text, head, strlen(head));
  memcpy(text + strlen(head), data, n);
  size_t end = strlen(text);
  if (text[end - 1] != '\n') text[end++] = '\n';
  const uint32_t crc = (uint32_t)crc32(crc32(0, Z_NULL, 0), (const Bytef *)text, (uInt)end);
  snprintf(text + end, size - end, "end %08x\n", crc);
  if (contents_read(text, strlen(text), 1000000, &c, reason)) free(c.entries);
  else if (!reason[0]) abort();
  free(text);
}

/* (table, column, byte, value) again and again. */
static void Numbers(const Case *c, const uint8_t *data, size_t n)
{
  Model *from = NewModel(c), *to = NewModel(c);
  StepReport report;
  Tables *tables;
  char reason[256];
  FUZZ_CALL(ModelActivate(from));
  FUZZ_CALL(TablesCreate(&tables));
  FUZZ_CALL(ModelToTables(from, tables));
  for (; n >= 4; data += 4, n -= 4) {
    const Table *table = tables->table[data[0] % tables->n];
    const Column *column = &table->column[data[1] % table->n];
    const size_t bytes = (size_t)(table->rows * column->components) * column_type_bytes(column->type);
    if (bytes) ((unsigned char *)column->data)[data[2] % bytes] = data[3];
  }
  FUZZ_CALL(ModelFromTables(to, tables, reason));
  if (!reason[0] && to->control.next > 1e-6 && to->control.next < 1) FUZZ_CALL(ModelStep(to, 1e-3, &report));
  FUZZ_CALL(TablesDestroy(&tables));
  FUZZ_CALL(ModelDestroy(&from));
  FUZZ_CALL(ModelDestroy(&to));
}

static void fuzz_one(const uint8_t *data, size_t n)
{
  if (n == 0) return;
  if (data[0] == 'n') Numbers(of_cells, data + 1, n - 1);
  else if (data[0] == 'c') Numbers(of_clouds, data + 1, n - 1);
  else if (data[0] == 'l') List(data + 1, n - 1);
  else File(data, n);
}
