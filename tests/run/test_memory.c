/* Memory that runs out at every place in turn: reading a case and its mesh, building the model, the
 * first step. Each time the error must come back as a code, and the process must live.
 *
 * Each try is a child process in which allocation number n fails, if it is made by talus, HDF5, or
 * PETSc through PetscMalloc. Not tried are those of libfyaml 0.7.12, which reads through NULL then,
 * of PETSc's hash tables, which ask malloc and never look, and of MPI, MUMPS and BLAS, which end
 * the process by themselves. TALUS_MEMORY_STRIDE=1 tries every one (make test-kill); usually most
 * are left out. */
#include <errno.h>
#include <execinfo.h>
#include <link.h>
#include <malloc.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include "../model/case_builder.h"
#include "base/process/memory.h"
#include "input/case_file.h"

#ifdef __SANITIZE_ADDRESS__

int main(void)
{
  puts("the sanitizer has an allocator of its own: nothing to try");
  return 0;
}

#else

/* --- an allocator that fails --- */
typedef struct {
  unsigned long count; /* allocations so far */
  unsigned long fails; /* number of the one that fails, from 1; 0: none */
  uintptr_t caller;    /* of the one that failed, 0: none did */
  int said;            /* did the diagnostics hold an error? */
  int code;            /* what came back */
} Account;

typedef struct {
  uintptr_t start, end;
  char name[40];
} Range;

static Account *account; /* shared with the child; NULL: all is well */
static Range range[32];
static int n_ranges, loud;

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t n, size_t size);
void *__libc_realloc(void *old, size_t size);
void *__libc_memalign(size_t alignment, size_t size);

static int fails(const void *caller)
{
  const uintptr_t at = (uintptr_t)caller;
  if (!account) return 0;
  for (int k = 0; k < n_ranges; ++k) {
    if (at < range[k].start || at >= range[k].end) continue;
    if (++account->count != account->fails) return 0;
    account->caller = at;
    if (loud) {
      void *frame[24];
      Account *kept = account;
      account = NULL;
      backtrace_symbols_fd(frame, backtrace(frame, 24), STDERR_FILENO);
      fputs("---\n", stderr);
      account = kept;
    }
    errno = ENOMEM;
    return 1;
  }
  return 0;
}

void *malloc(size_t size) { return fails(__builtin_return_address(0)) ? NULL : __libc_malloc(size); }
void *calloc(size_t n, size_t size) { return fails(__builtin_return_address(0)) ? NULL : __libc_calloc(n, size); }
void *realloc(void *old, size_t size) { return fails(__builtin_return_address(0)) ? NULL : __libc_realloc(old, size); }
void *memalign(size_t alignment, size_t size)
{
  return fails(__builtin_return_address(0)) ? NULL : __libc_memalign(alignment, size);
}
void *aligned_alloc(size_t alignment, size_t size)
{
  return fails(__builtin_return_address(0)) ? NULL : __libc_memalign(alignment, size);
}
int posix_memalign(void **result, size_t alignment, size_t size)
{
  if (fails(__builtin_return_address(0))) return ENOMEM;
  *result = __libc_memalign(alignment, size);
  return *result ? 0 : ENOMEM;
}

static int add_range(struct dl_phdr_info *info, size_t size, void *context)
{
  static const char *const libraries[] = {"libhdf5"};
  const char *name = info->dlpi_name;
  int wanted = !*name;
  (void)size, (void)context;
  for (int k = 0; k < 1; ++k) wanted |= strstr(name, libraries[k]) != NULL;
  for (int k = 0; wanted && k < info->dlpi_phnum && n_ranges < 32; ++k) {
    const ElfW(Phdr) *segment = &info->dlpi_phdr[k];
    if (segment->p_type != PT_LOAD || !(segment->p_flags & PF_X)) continue;
    Range *r = &range[n_ranges++];
    r->start = info->dlpi_addr + segment->p_vaddr;
    r->end = r->start + segment->p_memsz;
    snprintf(r->name, sizeof r->name, "%s", *name ? strrchr(name, '/') + 1 : "talus");
  }
  return 0;
}

static const char *library_of(uintptr_t at)
{
  for (int k = 0; k < n_ranges; ++k)
    if (at >= range[k].start && at < range[k].end) return range[k].name;
  return "?";
}

/* --- what is tried --- */
static PetscErrorCode Work(const char *file)
{
  Diag *diag;
  Case *c = NULL;
  Model *m = NULL;
  StepReport report;

  PetscFunctionBeginUser;
  PetscCall(DiagCreate(&diag));
  PetscCall(CaseRead(PETSC_COMM_SELF, file, 0, NULL, diag, &c));
  if (c) PetscCall(ModelCreate(PETSC_COMM_SELF, c, diag, &m));
  if (m) PetscCall(ModelStep(m, PETSC_MAX_REAL, &report));
  account->said = diag_errors(diag) > 0;
  if (loud) PetscCall(DiagFlush(diag, stderr));
  PetscCall(ModelDestroy(&m));
  PetscCall(CaseDestroy(&c));
  PetscCall(DiagDestroy(&diag));
  PetscFunctionReturn(0);
}

/* The child's exit status. */
static int try(Account *shared, unsigned long n, const char *file)
{
  int status = 0;
  *shared = (Account){.fails = n, .code = -1};
  const pid_t child = fork();
  if (!child) {
    alarm(60);
    signal(SIGSEGV, SIG_DFL);
    account = shared;
    const PetscErrorCode code = Work(file);
    account = NULL;
    shared->code = (int)code;
    _exit(0);
  }
  waitpid(child, &status, 0);
  return status;
}

static void exhaust(const char *name, const char *text)
{
  const char *stride_text = getenv("TALUS_MEMORY_STRIDE"), *first_text = getenv("TALUS_MEMORY_FIRST");
  const unsigned long tries = 120;
  unsigned long codes = 0, messages = 0, bad = 0, done = 0;
  char file[PETSC_MAX_PATH_LEN];
  Account *shared = mmap(NULL, sizeof *shared, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  snprintf(file, sizeof file, "%s/talus-memory-%d.yaml", getenv("TMPDIR") ? getenv("TMPDIR") : "/tmp", (int)getpid());
  FILE *out = fopen(file, "w");
  CHECK(out && shared != MAP_FAILED, "no file");
  fputs(text, out);
  fclose(out);
  CHECK(!try(shared, 0, file) && !shared->code && !shared->said, "%s fails with all memory there is", name);
  const unsigned long all = shared->count;
  const unsigned long stride = stride_text ? strtoul(stride_text, NULL, 10) : all / tries + 1;
  for (unsigned long n = first_text ? strtoul(first_text, NULL, 10) : 1; n <= all; n += stride, ++done) {
    const int status = try(shared, n, file);
    /* 1: PETSc 3.18, of its own objects */
    codes += shared->code == PETSC_ERR_MEM || shared->code == 1;
    messages += !shared->code && shared->said;
    if (loud) printf("code %d\n", shared->code);
    if (!status && (!shared->caller || shared->code > 0 || shared->said)) continue;
    ++bad;
    printf("%s, allocation %lu of %lu, by %s: %s %d\n", name, n, all, library_of(shared->caller),
           status ? "ends with status" : "goes on with code", status ? status : shared->code);
  }
  printf("%s: %lu of %lu allocations failed: %lu times 'out of memory', %lu times a message, %lu times neither\n", name,
         done, all, codes, messages, bad);
  unlink(file);
  CHECK(!bad, "%s does not bear it", name);
}

#define TOP "kinematics: plane-strain\nanalysis: {type: dynamic, step: 1e-3, end: 1e-2}\n"
#define MATERIALS                                                                 \
  "materials: {m: {law: neo-hookean, density: 1000, young: 1e6, poisson: 0.3}}\n" \
  "boundary: [{on: {y: 0}, fix: [x, y]}]\nmeasures: {tip: {displacement: y, of: {tracer: [1, 0.5]}}}\n"
#define BODIES \
  "bodies: [{name: b, shape: {box: {min: [0, 0], max: [1, 1]}}, points_per_cell: 4, material: m}]\n" MATERIALS
/* Larger than the body: a warning that finds no memory is lost, by design, and is nothing to try. */
#define BOX "grid: {box: {min: [-0.25, 0], max: [2, 1.25]}, size: 0.25}\n"

static void test_mpm(void **state)
{
  (void)state;
  exhaust("mpm", TOP "method: mpm\n" BOX BODIES "linear: iterative\n");
}

static void test_gmm(void **state)
{
  (void)state;
  exhaust("gmm", TOP "method: gmm\n" BOX BODIES "linear: iterative\n");
}

static void test_mesh(void **state)
{
  (void)state;
  exhaust("mesh", TOP "method: fem\ngrid: {mesh: " TALUS_SOURCE_DIR
                      "/tests/fuzz/corpus/mesh/plane_msh4_0.msh}\n"
                      "bodies: [{name: b, region: all of it, points_per_cell: 3, material: m}]\n" MATERIALS
                      "linear: iterative\n");
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_mpm), cmocka_unit_test(test_gmm),
                                     cmocka_unit_test(test_mesh)};
  if (MemoryInstall(argc, argv) || PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
  PetscPopSignalHandler();
  loud = getenv("TALUS_MEMORY_LOUD") != NULL;
  dl_iterate_phdr(add_range, NULL);
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}

#endif
