/* The dry column of cases/granular-collapse (aspect ratio 1.2, mesh 2): what a step and a Newton
 * iteration cost, and how many 0.5 s of collapse take with fixed steps and with steps under
 * control; what grains ten and a hundred times as stiff ask for (the last column: iterations beside those of the
 * first row, which may be 1.3); and what the same costs as a body about the axis x = 0.
 *
 *   build/bench/bench_column [-full] [-only "1 ms"] [-case cases/granular-collapse/case.yaml]
 *
 * `pass`: residual and tangent at the end, ns a point. Seconds are those in which a core worked for this process.
 * Steps of 0.1 ms go to 0.05 s, with -full to 0.5 s. */
#include "bench.h"
#include "input/case_file.h"

/* the code of the thesis, for the same 0.5 s, on this kind of machine */
#define THESIS_SECONDS 290.0
#define END 0.5
#define YOUNG 0.84e6 /* Pa, of the case */

typedef struct {
  const char *name, *kinematics;
  PetscReal step, largest, end; /* s; largest = step: fixed */
  PetscReal young;              /* Pa */
} Plan;

typedef struct {
  PetscReal seconds, phase[PHASE_N], front, time, pass;
  PetscInt steps, iterations, cuts;
  PetscBool gave_up;
} Outcome;

static PetscErrorCode ReadCase(const char *file, const Plan *plan, Diag *diag, Case **c)
{
  char text[5][64];
  const char *const set[5] = {text[0], text[1], text[2], text[3], text[4]};

  PetscFunctionBeginUser;
  snprintf(text[0], sizeof text[0], "analysis.step=%.15g", (double)plan->step);
  snprintf(text[1], sizeof text[1], "analysis.largest=%.15g", (double)plan->largest);
  snprintf(text[2], sizeof text[2], "analysis.end=%.15g", (double)END);
  snprintf(text[3], sizeof text[3], "kinematics=%s", plan->kinematics);
  snprintf(text[4], sizeof text[4], "materials.grains.young=%.15g", (double)plan->young);
  PetscCall(CaseRead(PETSC_COMM_WORLD, file, 5, set, diag, c));
  PetscFunctionReturn(0);
}

static PetscErrorCode Advance(Model *m, PetscReal end, Outcome *o)
{
  StepReport report;

  PetscFunctionBeginUser;
  *o = (Outcome){0};
  const PetscReal start = processor_now();
  while (m->time < end * (1 - 1e-12) && !o->gave_up) {
    PetscCall(ModelStep(m, end - m->time, &report));
    o->gave_up = report.outcome != STEP_ACCEPTED;
  }
  o->seconds = processor_now() - start;
  o->steps = m->step;
  o->iterations = m->total_iterations;
  o->cuts = m->cuts;
  o->time = m->time;
  model_times(m, o->phase);
  PetscFunctionReturn(0);
}

/* The farthest point of the case's own measure `front`. */
static PetscErrorCode Front(Model *m, PetscReal *front)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < m->c->n_measures; ++k)
    if (!strcmp(m->c->measures[k].name, "front")) PetscCall(ModelMeasure(m, &m->c->measures[k], k, front));
  PetscFunctionReturn(0);
}

static PetscErrorCode Measure(const char *file, const Plan *plan, Outcome *o, PetscInt *points)
{
  Model *m = NULL;
  Diag *diag;
  Case *c;
  Pass pass = {0};

  PetscFunctionBeginUser;
  PetscCall(DiagCreate(&diag));
  PetscCall(ReadCase(file, plan, diag, &c));
  if (c) PetscCall(ModelCreate(PETSC_COMM_WORLD, c, diag, &m));
  PetscCall(DiagFlush(diag, stderr));
  PetscCheck(m, PETSC_COMM_WORLD, PETSC_ERR_USER, "the benchmark's case has mistakes: %s", file);
  PetscCall(ModelCountPoints(m, points));
  PetscCall(Advance(m, plan->end, o));
  PetscCall(Front(m, &o->front));
  PetscCall(PassMeasure(m, 4 / PetscSqr(plan->step), 50, &pass));
  o->pass = pass.points / (PetscReal)*points;
  PetscCall(ModelDestroy(&m));
  PetscCall(CaseDestroy(&c));
  PetscCall(DiagDestroy(&diag));
  PetscFunctionReturn(0);
}

/* Shares of the phases, by the clock. */
static void print_phases(const Outcome *o)
{
  PetscReal clock = 0;
  for (int k = 0; k < PHASE_N; ++k) clock += o->phase[k];
  const PetscReal scale = 100 / clock;
  printf("     of a step [%%]:");
  for (int k = 0; k < PHASE_N; ++k) printf(" %s %.1f ", phase_names[k], (double)(scale * o->phase[k]));
  printf("\n");
}

static void print_row(const Plan *plan, const Outcome *o, const Outcome *first)
{
  const double steps = (double)o->steps, iterations = (double)PetscMax(o->iterations, 1);
  printf("%-24s %5.3g s %6d %7d %6.2f %4d %7.2f %8.3f %9.3f %6.0f  %8.4f", plan->name, (double)o->time, (int)o->steps,
         (int)o->iterations, iterations / steps, (int)o->cuts, (double)o->seconds, 1e3 * o->seconds / steps,
         1e3 * o->seconds / iterations, 1e9 * (double)o->pass, (double)o->front);
  if (plan->end == END && !strcmp(plan->kinematics, "plane-strain")) printf(" %7.0f", THESIS_SECONDS / o->seconds);
  else printf(" %7s", "-");
  if (plan->end == END && first->steps > 0)
    printf(" %6.2f %6.2f", steps / (double)first->steps, (double)o->iterations / (double)first->iterations);
  printf("%s\n", o->gave_up ? "  GAVE UP" : "");
  print_phases(o);
  fflush(stdout);
}

int main(int argc, char **argv)
{
  const Plan plans[] = {{"fixed, 1 ms", "plane-strain", 1e-3, 1e-3, END, YOUNG},
                        {"fixed, 2 ms", "plane-strain", 2e-3, 2e-3, END, YOUNG},
                        {"control, 1 to 4 ms", "plane-strain", 1e-3, 4e-3, END, YOUNG},
                        {"control, 1 to 10 ms", "plane-strain", 1e-3, 1e-2, END, YOUNG},
                        {"8.4 MPa, 1 ms", "plane-strain", 1e-3, 1e-3, END, 10 * YOUNG},
                        {"84 MPa, 1 ms", "plane-strain", 1e-3, 1e-3, END, 100 * YOUNG},
                        {"84 MPa, 2 ms", "plane-strain", 2e-3, 2e-3, END, 100 * YOUNG},
                        {"fixed, 0.1 ms", "plane-strain", 1e-4, 1e-4, 0.1 * END, YOUNG},
                        {"about the axis, 1 ms", "axisymmetric", 1e-3, 1e-3, END, YOUNG}};
  char file[PETSC_MAX_PATH_LEN] = "cases/granular-collapse/case.yaml", only[64] = "";
  PetscInt points;
  PetscBool full;
  Outcome o, first = {0};

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-full", &full));
  PetscCall(PetscOptionsGetString(NULL, NULL, "-case", file, sizeof file, NULL));
  PetscCall(PetscOptionsGetString(NULL, NULL, "-only", only, sizeof only, NULL));
  for (size_t k = 0; k < sizeof plans / sizeof plans[0]; ++k) {
    Plan plan = plans[k];
    if (!strstr(plan.name, only)) continue;
    if (full) plan.end = END;
    PetscCall(Measure(file, &plan, &o, &points));
    if (!first.steps)
      printf(
        "%d points; ratio: the thesis's code takes %g s for the same 0.5 s [target 50]; steps, Newton: beside fixed "
        "steps of "
        "1 ms\n\n"
        "%-24s %7s %6s %7s %6s %4s %7s %8s %9s %6s  %8s %7s %6s %6s\n",
        (int)points, THESIS_SECONDS, "", "to", "steps", "Newton", "a step", "cuts", "seconds", "ms/step", "ms/Newton",
        "pass", "front [m]", "ratio", "steps", "Newton");
    print_row(&plan, &o, &first);
    if (!first.steps) first = o;
  }
  PetscCall(PetscFinalize());
  return 0;
}
