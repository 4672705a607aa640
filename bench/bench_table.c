/* One table: the same cases by talus, implicit and explicit, by the bound program (explicit_bound.c) and by other
 * programs where they are installed. All take turns, in one run.
 *
 *   build/bench/bench_table [-rounds 3] [-only column]
 *
 * Seconds are the median of the rounds, of a core that worked for the program; the ratio is the median of the ratios
 * within a round, to the first row of the case. -only: cases whose name has this in it. Reading the case, making the
 * model and writing files are not counted but for CalculiX, of which the whole process is. */
#include "bench.h"
#include "input/case_file.h"

#define MOST_ROUNDS 15
#define COLUMN "cases/granular-collapse/case.yaml"
#define BEAM "cases/cantilever/case.yaml"
#define SOFT "column, 0.84 MPa, 0.5 s"
#define STIFF "column, 84 MPa, 0.1 s"
#define SHORT "column, undamped, 0.05 s"
#define SPACE "column in space, 4 ms"
#define STATIC "cantilever, 32 x 256 cells"
#define EXPLICIT "analysis.type=explicit analysis.step=0.01 "

typedef struct {
  const char *name, *program, *scheme, *precision;
  const char *file, *what; /* case of talus and what is set in it; or NULL, and a command that prints its row */
  PetscBool measures;      /* are all measures of the case taken at the end of every step of the run? */
} Row;

/* The first of a case is what its ratios are to. Grains a hundred times as stiff ask for a tenth of its step. */
static const Row rows[] = {
  {SOFT, "bound", "explicit", "single", NULL, "$BENCH/explicit_bound 1e-4 0.5", 0},
  {SOFT, "bound", "explicit", "double", NULL, "$BENCH/explicit_bound_double 1e-4 0.5", 0},
  {SOFT, "talus", "explicit", "double", COLUMN, EXPLICIT "analysis.end=0.5", 0},
  {SOFT, "talus", "explicit, measures", "double", COLUMN, EXPLICIT "analysis.end=0.5", 1},
  {SOFT, "talus", "implicit, 1 ms", "double", COLUMN, "analysis.step=1e-3 analysis.end=0.5", 0},
  {SOFT, "talus", "implicit, 2 ms", "double", COLUMN, "analysis.step=2e-3 analysis.end=0.5", 0},
  {STIFF, "bound", "explicit", "single", NULL, "$BENCH/explicit_bound 1e-5 0.1 200 1 1 1.5 84e6", 0},
  {STIFF, "talus", "explicit", "double", COLUMN, EXPLICIT "analysis.end=0.1 materials.grains.young=84e6", 0},
  {STIFF, "talus", "implicit, 1 ms", "double", COLUMN, "analysis.end=0.1 materials.grains.young=84e6", 0},
  {SHORT, "talus", "implicit, 1 ms", "double", COLUMN, "analysis.end=0.05 analysis.damping=0", 0},
  {SHORT, "Kratos", "implicit, 1 ms", "double", NULL, "python3 bench/peer_kratos.py column", 0},
  {SPACE, "talus", "explicit", "double", "bench/collapse.yaml",
   "analysis.type=explicit analysis.step=4e-3 analysis.end=4e-3", 0},
  {SPACE, "talus", "implicit, 0.5 ms", "double", "bench/collapse.yaml", "analysis.end=4e-3", 0},
  {STATIC, "talus", "mpm, static", "double", BEAM, "grid.size=0.03125", 0},
  {STATIC, "talus", "fem, static", "double", BEAM, "grid.size=0.03125 method=fem", 0},
  {STATIC, "CalculiX", "fem, static", "double", NULL, "python3 bench/peer_calculix.py", 0},
  {STATIC, "Kratos", "mpm, static", "double", NULL, "python3 bench/peer_kratos.py cantilever", 0},
};
#define N_ROWS ((PetscInt)PETSC_STATIC_ARRAY_LENGTH(rows))

typedef struct {
  PetscReal seconds[MOST_ROUNDS], answer; /* front or deflection, m */
  int points, steps;
  double newton;   /* iterations a step; 0: not told */
  char note[1024]; /* why there is none */
} Result;

static PetscErrorCode ReadCase(const Row *row, Diag *diag, Case **c)
{
  char text[256], *rest = text;
  const char *set[8];
  PetscInt n = 0;

  PetscFunctionBeginUser;
  snprintf(text, sizeof text, "%s", row->what);
  for (const char *word; n < 8 && (word = strtok_r(NULL, " ", &rest));) set[n++] = word;
  PetscCall(CaseRead(PETSC_COMM_WORLD, row->file, n, set, diag, c));
  PetscFunctionReturn(0);
}

static PetscErrorCode Advance(Model *m, Result *r, PetscReal *seconds)
{
  const Case *c = m->c;
  StepReport report = {0};

  PetscFunctionBeginUser;
  const PetscReal start = processor_now(), end = c->analysis.end;
  while (m->time < end * (1 - 1e-12) && report.outcome == STEP_ACCEPTED) {
    PetscCall(ModelStep(m, end - m->time, &report));
    for (PetscInt k = 1; k < c->n_measures; ++k) PetscCall(ModelMeasure(m, &c->measures[k], k, &r->answer));
  }
  *seconds = processor_now() - start;
  const PetscBool explicitly = c->analysis.type == ANALYSIS_EXPLICIT ? PETSC_TRUE : PETSC_FALSE;
  r->steps = (int)(explicitly ? m->total_iterations : m->step);
  r->newton = explicitly ? 0 : (double)m->total_iterations / (double)m->step;
  PetscCall(ModelMeasure(m, &c->measures[0], 0, &r->answer));
  if (report.outcome != STEP_ACCEPTED) snprintf(r->note, sizeof r->note, "gave up: %s", report.reason);
  PetscFunctionReturn(0);
}

/* The first measure of both cases is the answer that is compared. */
static PetscErrorCode RunTalus(const Row *row, Result *r, PetscReal *seconds)
{
  Model *m = NULL;
  PetscInt points;
  Diag *diag;
  Case *c;

  PetscFunctionBeginUser;
  PetscCall(DiagCreate(&diag));
  PetscCall(ReadCase(row, diag, &c));
  PetscCall(DiagFlush(diag, stderr));
  PetscCheck(c && c->n_measures, PETSC_COMM_WORLD, PETSC_ERR_USER, "the benchmark's case has mistakes: %s", row->file);
  const PetscInt all = c->n_measures;
  if (!row->measures) c->n_measures = 1;
  PetscCall(ModelCreate(PETSC_COMM_WORLD, c, diag, &m));
  PetscCall(DiagFlush(diag, stderr));
  PetscCheck(m, PETSC_COMM_WORLD, PETSC_ERR_USER, "the benchmark's case has mistakes: %s", row->file);
  PetscCall(ModelCountPoints(m, &points));
  r->points = (int)points;
  PetscCall(Advance(m, r, seconds));
  PetscCall(ModelDestroy(&m));
  c->n_measures = all;
  PetscCall(CaseDestroy(&c));
  PetscCall(DiagDestroy(&diag));
  PetscFunctionReturn(0);
}

/* Programs print "N points, N steps, S s of a core, front X m", or "not installed: " and how to install them. */
static void run_other(const Row *row, Result *r, PetscReal *seconds)
{
  char line[256];
  double spent, answer;
  FILE *output = popen(row->what, "r");
  snprintf(r->note, sizeof r->note, "failed: %s", row->what);
  while (output && fgets(line, sizeof line, output)) {
    line[strcspn(line, "\n")] = 0;
    if (!strncmp(line, "not installed", 13)) snprintf(r->note, sizeof r->note, "%s", line);
    if (sscanf(line, "%d points, %d steps, %lf s of a core, %*s %lf m", &r->points, &r->steps, &spent, &answer) != 4)
      continue;
    *seconds = spent;
    r->answer = answer;
    r->note[0] = 0;
  }
  if (output) (void)pclose(output);
}

static PetscErrorCode Run(PetscInt round, Result *results, const char *only)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < N_ROWS; ++k) {
    Result *r = &results[k];
    if (r->note[0] || !strstr(rows[k].name, only)) continue;
    if (rows[k].file) PetscCall(RunTalus(&rows[k], r, &r->seconds[round]));
    else run_other(&rows[k], r, &r->seconds[round]);
  }
  PetscFunctionReturn(0);
}

static int compare(const void *a, const void *b)
{
  const PetscReal x = *(const PetscReal *)a, y = *(const PetscReal *)b;
  return (x > y) - (x < y);
}

/* Of seconds, or with `first` of what they are beside its seconds of the same round. */
static PetscReal median(PetscInt rounds, const Result *r, const Result *first)
{
  PetscReal sorted[MOST_ROUNDS];
  for (PetscInt k = 0; k < rounds; ++k) sorted[k] = r->seconds[k] / (first ? first->seconds[k] : 1);
  qsort(sorted, (size_t)rounds, sizeof *sorted, compare);
  return (sorted[(rounds - 1) / 2] + sorted[rounds / 2]) / 2;
}

static void print_row(const Row *row, const Result *r, const Result *first, PetscInt rounds)
{
  printf("%-26s %-9s %-18s %-9s", row->name, row->program, row->scheme, row->precision);
  if (r->note[0]) {
    printf(" %s\n", r->note);
    return;
  }
  const double seconds = (double)median(rounds, r, NULL);
  printf(" %7d %6d", r->points, r->steps);
  if (r->newton > 0) printf(" %6.1f", r->newton);
  else printf(" %6s", "");
  printf(" %8.3f %9.1f", seconds, 1e9 * seconds / r->points / r->steps);
  if (first->note[0]) printf(" %7s", "-");
  else printf(" %7.2f", (double)median(rounds, r, first));
  printf(" %9.4f\n", (double)r->answer);
}

static void print_table(const Result *results, PetscInt rounds, const char *only)
{
  PetscInt first = 0;
  printf("%-26s %-9s %-18s %-9s %7s %6s %8s %10s %7s %9s\n", "case", "program", "scheme", "precision", "points",
         "steps", "seconds", "ns", "ratio", "answer");
  for (PetscInt k = 0; k < N_ROWS; ++k) {
    if (strcmp(rows[k].name, rows[first].name)) first = k;
    if (strstr(rows[k].name, only)) print_row(&rows[k], &results[k], &results[first], rounds);
  }
  printf(
    "Newton: iterations a step; ns: of a point and step; ratio: to the first row of the case; answer: front of the "
    "column, deflection of the tip, m\n");
}

int main(int argc, char **argv)
{
  static Result results[N_ROWS];
  char only[64] = "", directory[PETSC_MAX_PATH_LEN];
  PetscInt rounds = 3;
  double load[2] = {0, 0};

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-rounds", &rounds, NULL));
  PetscCall(PetscOptionsGetString(NULL, NULL, "-only", only, sizeof only, NULL));
  rounds = PetscMin(PetscMax(rounds, 1), MOST_ROUNDS);
  snprintf(directory, sizeof directory, "%s", argv[0]);
  char *slash = strrchr(directory, '/');
  if (slash) *slash = 0;
  (void)setenv("BENCH", slash ? directory : ".", 1);
  (void)getloadavg(&load[0], 1);
  for (PetscInt k = 0; k < rounds; ++k) PetscCall(Run(k, results, only));
  (void)getloadavg(&load[1], 1);
  print_table(results, rounds, only);
  printf("%d rounds; load of the machine %.1f before and %.1f after, on %ld cores\n", (int)rounds, load[0], load[1],
         sysconf(_SC_NPROCESSORS_ONLN));
  return PetscFinalize();
}
