/* GranuFall's whole tube (cases/granufall: 200 mL in triangles of 1 mm with 6 points, E 1 MPa): what
 * a step and a Newton iteration of powder in rings cost, from the opening of the orifice on.
 *
 *   build/bench/bench_tube [-until 0.02] [-case cases/granufall/case.yaml] [-set KEY=VALUE,...]
 *
 * Seconds are those in which a core worked for this process. `pass`: residual and tangent at the end, best of 50. */
#include "bench.h"
#include "input/case_file.h"

enum { MOST = 32 };

static const char *const tube[] = {"grid.parameters={h: 1e-3, fill: 0.19325}", "bodies[0].points_per_cell=6",
                                   "materials.sugar.young=1e6", "analysis.largest=2e-4"};

static PetscErrorCode ReadCase(Diag *diag, Case **c)
{
  char file[PETSC_MAX_PATH_LEN] = "cases/granufall/case.yaml", *more[MOST];
  const char *set[MOST + 4];
  PetscInt n = MOST;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsGetString(NULL, NULL, "-case", file, sizeof file, NULL));
  PetscCall(PetscOptionsGetStringArray(NULL, NULL, "-set", more, &n, NULL));
  for (int i = 0; i < 4; ++i) set[i] = tube[i];
  for (PetscInt i = 0; i < n; ++i) set[4 + i] = more[i];
  PetscCall(CaseRead(PETSC_COMM_WORLD, file, (int)n + 4, set, diag, c));
  PetscFunctionReturn(0);
}

static PetscErrorCode Advance(Model *m, PetscReal until)
{
  StepReport report;
  PetscReal phase[PHASE_N], clock = 0;
  PetscInt points;

  PetscFunctionBeginUser;
  const PetscReal start = processor_now();
  while (m->time < until * (1 - 1e-12)) {
    PetscCall(ModelStep(m, until - m->time, &report));
    PetscCheck(report.outcome == STEP_ACCEPTED, PETSC_COMM_SELF, PETSC_ERR_NOT_CONVERGED, "%s", report.reason);
  }
  const PetscReal seconds = processor_now() - start, steps = (PetscReal)m->step, its = (PetscReal)m->total_iterations;
  PetscCall(ModelCountPoints(m, &points));
  printf("%d points to %g s: %d steps, %d Newton iterations (%.2f a step), %d cuts\n", (int)points, (double)m->time,
         (int)m->step, (int)m->total_iterations, (double)(its / steps), (int)m->cuts);
  printf("%.1f s, %.0f s for a second; %.2f ms a step, %.2f ms a Newton iteration\n  of a step [%%]:", (double)seconds,
         (double)(seconds / m->time), (double)(1e3 * seconds / steps), (double)(1e3 * seconds / its));
  model_times(m, phase);
  for (int k = 0; k < PHASE_N; ++k) clock += phase[k];
  for (int k = 0; k < PHASE_N; ++k) printf(" %s %.1f ", phase_names[k], (double)(100 * phase[k] / clock));
  printf("\n");
  PetscFunctionReturn(0);
}

/* Seconds of the points alone at the increments of the last step, from a second-level cache that other work has
 * filled, as between two iterations: best of several, with the tangent and without. */
static PetscErrorCode PassInFlow(Model *m, PetscInt repeats, PetscReal best[2])
{
  const PetscInt dofs = m->grid->n_nodes * m->dim, n = 1024 * 1024;
  PetscReal *others;

  PetscFunctionBeginUser;
  PetscCall(SystemWantSlots(m->system, PETSC_FALSE));
  PetscCall(PetscCalloc1(n, &others));
  PetscCall(PetscArraycpy(m->nodes->du, m->nodes->previous, dofs));
  best[0] = best[1] = PETSC_MAX_REAL;
  for (PetscInt k = 0; k < 2 * repeats; ++k) {
    const WeakFormInput in = weak_form_of(m, 4 / PetscSqr(m->control.next));
    WeakFormOutput out = {
      .force = m->nodes->force, .singles = k % 2 ? NULL : m->system->singles, .slot = m->system->slot};
    for (PetscInt i = 0; i < n; ++i) others[i] += 1;
    const PetscReal start = seconds_now();
    PetscCall(m->formulation->assemble(&in, &out));
    best[k % 2] = PetscMin(best[k % 2], seconds_now() - start);
    PetscCheck(out.status == LAW_OK, PETSC_COMM_SELF, PETSC_ERR_PLIB, "a point failed");
  }
  PetscCall(PetscFree(others));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  PetscReal until = 0.02, flowing[2];
  PetscInt points;
  Pass pass = {0};
  Model *m = NULL;
  Diag *diag;
  Case *c;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-until", &until, NULL));
  PetscCall(DiagCreate(&diag));
  PetscCall(ReadCase(diag, &c));
  if (c) PetscCall(ModelCreate(PETSC_COMM_WORLD, c, diag, &m));
  PetscCall(DiagFlush(diag, stderr));
  PetscCheck(m, PETSC_COMM_WORLD, PETSC_ERR_USER, "the benchmark's case has mistakes");
  PetscCall(Advance(m, until));
  PetscCall(ModelCountPoints(m, &points));
  PetscCall(PassMeasure(m, 4 / PetscSqr(m->control.next), 50, &pass));
  printf("  pass %.0f ns a point, blocks to matrix %.0f\n", (double)(1e9 * pass.points / (PetscReal)points),
         (double)(1e9 * pass.matrix / (PetscReal)points));
  PetscCall(PassInFlow(m, 50, flowing));
  printf("  in flow %.0f ns a point, without tangent %.0f\n", (double)(1e9 * flowing[0] / (PetscReal)points),
         (double)(1e9 * flowing[1] / (PetscReal)points));
  PetscCall(ModelDestroy(&m));
  PetscCall(CaseDestroy(&c));
  PetscCall(DiagDestroy(&diag));
  PetscCall(PetscFinalize());
  return 0;
}
