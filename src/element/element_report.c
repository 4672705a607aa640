/* The terminal: a line for each stage of the path. */
#include <string.h>
#include "element/element_table.h"
#include "picture/figure.h"

/* The row of a stage with a peak of q: larger than where the stage begins, and where it ends; -1 if
 * there is none. */
static PetscInt row_of_peak(const ElementTable *t, PetscInt stage)
{
  PetscInt best = -1, first = -1, last = -1;
  for (PetscInt i = 1; i < t->n; ++i) {
    if ((PetscInt)element_value(t, i, ELEMENT_STAGE) != stage) continue;
    if (first < 0) first = best = i - 1;
    if (element_value(t, i, ELEMENT_Q) > element_value(t, best, ELEMENT_Q)) best = i;
    last = i;
  }
  const PetscReal end = last < 0 ? 0 : element_value(t, last, ELEMENT_Q);
  return best > first && element_value(t, best, ELEMENT_Q) > (1 + 1e-9) * end ? best : -1;
}

static PetscInt last_row(const ElementTable *t, PetscInt stage)
{
  PetscInt last = -1;
  for (PetscInt i = 0; i < t->n; ++i)
    if ((PetscInt)element_value(t, i, ELEMENT_STAGE) == stage) last = i;
  return last;
}

/* One line: strains, invariants, and the friction mobilised. */
static void write_row(FILE *out, const ElementTable *t, PetscInt i, const char *name, const char *where, PetscReal unit)
{
  fprintf(out, "  %-26s %-8s %10.5g %10.5g %10.5g %10.5g %10.5g %10.5g %11.4g\n", name, where,
          (double)(0 - element_value(t, i, ELEMENT_STRAIN + 1)), (double)element_value(t, i, ELEMENT_SHEAR),
          (double)element_value(t, i, ELEMENT_VOLUME), (double)(unit * element_value(t, i, ELEMENT_P)),
          (double)(unit * element_value(t, i, ELEMENT_Q)), (double)(unit * element_value(t, i, ELEMENT_PORE)),
          (double)element_value(t, i, ELEMENT_FRICTION));
}

void element_report(FILE *out, const ElementSpec *spec, const ElementTable *t)
{
  PetscReal largest = 0;
  char pascal[64], p[80], q[80], u[80], name[160];
  for (PetscInt i = 0; i < t->n; ++i)
    for (int k = ELEMENT_PORE; k <= ELEMENT_Q; ++k) largest = PetscMax(largest, PetscAbsReal(element_value(t, i, k)));
  const PetscReal unit = figure_unit("Pa", largest, pascal);
  snprintf(p, sizeof p, "p' [%s]", pascal);
  snprintf(q, sizeof q, "q [%s]", pascal);
  snprintf(u, sizeof u, "u [%s]", pascal);
  fprintf(out, "  %-26s %-8s %10s %10s %10s %10s %10s %10s %11s\n", "stage", "", "-ln yy", "shear xy", "ln volume", p,
          q, u, "phi_m [deg]");
  write_row(out, t, 0, "start", "", unit);
  for (PetscInt s = 1; s <= spec->n_stages; ++s) {
    const PetscInt end = last_row(t, s), peak = row_of_peak(t, s);
    if (end < 0) break;
    element_stage_name(&spec->stages[s - 1], sizeof name, name);
    if (peak >= 0) {
      write_row(out, t, peak, name, "peak q", unit);
      name[0] = '\0';
    }
    write_row(out, t, end, name, "end", unit);
  }
}
