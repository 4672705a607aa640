/* Is a row right? Plain arithmetic, the same on every rank. */
#include <math.h>
#include <stdarg.h>
#include <string.h>
#include "verify/verify_private.h"

static void fail(VerifyRow *r, const char *format, ...) PETSC_ATTRIBUTE_FORMAT(2, 3);

static void fail(VerifyRow *r, const char *format, ...)
{
  const size_t used = strlen(r->why);
  va_list arguments;
  r->pass = PETSC_FALSE;
  if (used + 4 >= sizeof r->why) return;
  va_start(arguments, format);
  if (used) strcpy(r->why + used, "; ");
  vsnprintf(r->why + strlen(r->why), sizeof r->why - strlen(r->why), format, arguments);
  va_end(arguments);
}

/* |a - b| over |b|; the plain difference if b is zero. */
static PetscReal size_of(PetscReal b) { return b == 0 ? 1 : PetscAbsReal(b); }
static PetscReal relative(PetscReal a, PetscReal b) { return PetscAbsReal(a - b) / size_of(b); }

PetscBool verify_has_errors(const StudySpec *study) { return study->has_exact; }

static void judge_reference(VerifyRow *r)
{
  const PetscReal tolerance = reference_tolerance(r->study, r->row, r->series);
  r->reference = reference_value(r->row, r->series);
  if (PetscIsNanReal(r->reference)) return;
  r->deviation = relative(r->value, r->reference);
  if (r->study->at_most && r->value <= r->reference) r->deviation = 0;
  if ((!r->study->at_most || r->value > r->reference) &&
      PetscAbsReal(r->value - r->reference) > tolerance * PetscAbsReal(r->reference) + r->study->absolute)
    fail(r, "%.3g %s, allowed %.3g", (double)r->deviation, r->study->at_most ? "above the bound" : "off the reference",
         (double)tolerance);
}

static PetscBool is_between(const ExactSpec *exact, PetscReal x)
{
  return x >= exact->from * (1 - 1e-9) && x <= exact->to * (1 + 1e-9);
}

/* The error, and how fast it falls from the row before. */
static void judge_order(VerifyRow *r, const VerifyRow *before)
{
  const ExactSpec *exact = &r->study->exact;
  const PetscReal limit = reference_exact(r->study, r->series);
  if (PetscIsNanReal(limit)) return;
  r->error = relative(r->value, limit);
  if (!before || !(before->error > 0) || !(r->error > 0) || !(r->row->x > 0) || !(before->row->x > 0)) return;
  r->order = PetscLogReal(before->error / r->error) / PetscAbsReal(PetscLogReal(before->row->x / r->row->x));
  if (exact->order == 0 || !is_between(exact, r->row->x) || !is_between(exact, before->row->x)) return;
  if (PetscAbsReal(r->order - exact->order) > exact->order_tolerance)
    fail(r, "order %.3f, expected %g within %g", (double)r->order, (double)exact->order,
         (double)exact->order_tolerance);
}

static const VerifyRow *find(const VerifyRow *rows, PetscInt k, const char *series)
{
  for (PetscInt i = k; i-- > 0;) {
    if (rows[i].study != rows[k].study) return NULL;
    if (rows[i].row == rows[k].row && !strcmp(rows[i].series->name, series))
      return rows[i].result == RUN_DONE ? &rows[i] : NULL;
  }
  return NULL;
}

static void judge_agreement(VerifyRow *rows, PetscInt k)
{
  VerifyRow *r = &rows[k];
  for (PetscInt i = 0; i < r->study->n_agree; ++i) {
    const AgreeSpec *agree = &r->study->agree[i];
    const VerifyRow *other = strcmp(agree->series, r->series->name) ? NULL : find(rows, k, agree->with);
    if (!other) continue;
    const PetscReal difference = relative(r->value, other->value);
    r->difference = PetscIsNanReal(r->difference) ? difference : PetscMax(r->difference, difference);
    if (!(difference <= agree->tolerance + agree->absolute / size_of(other->value)))
      fail(r, "%.3g off %s, allowed %.3g", (double)difference, agree->with, (double)agree->tolerance);
  }
}

static void judge_pace(VerifyRow *rows, PetscInt k)
{
  VerifyRow *r = &rows[k];
  const VerifyRow *other = r->study->pace ? find(rows, k, r->study->pace) : NULL;
  if (other && !r->shared && !other->shared && other->seconds > 0) r->pace = r->seconds / other->seconds;
}

static void judge_powers(VerifyRow *rows, PetscInt k)
{
  VerifyRow *r = &rows[k];
  for (PetscInt i = 0; i < r->study->n_powers; ++i) {
    const PowerSpec *power = &r->study->powers[i];
    const PetscReal exponent = verify_exponent(rows, k, power);
    if (!power->has_exponent || PetscIsNanReal(exponent)) continue;
    if (power->series && strcmp(power->series, r->series->name)) continue;
    if (!(PetscAbsReal(exponent - power->exponent) <= power->within))
      fail(r, "exponent %.3f, expected %g within %g", (double)exponent, (double)power->exponent, (double)power->within);
  }
}

static PetscReal reported(const VerifyRow *r, const char *name)
{
  const RunSummary *s = &r->summary;
  const PetscReal numbers[] = {(PetscReal)s->iterations, (PetscReal)s->iterations_per_step, (PetscReal)s->steps,
                               (PetscReal)s->halvings, r->seconds};
  for (PetscInt i = 0; report_numbers[i]; ++i)
    if (!strcmp(report_numbers[i], name)) return numbers[i];
  return NAN;
}

static void judge_limits(VerifyRow *r)
{
  for (PetscInt i = 0; i < r->study->n_limits; ++i) {
    const NamedValue *limit = &r->study->limits[i];
    const PetscReal value = reported(r, limit->name);
    if (!(value <= limit->value)) fail(r, "%s = %g, allowed %g", limit->name, (double)value, (double)limit->value);
  }
}

void verify_judge(VerifyRow *rows, PetscInt k)
{
  VerifyRow *r = &rows[k];
  const VerifyRow *before =
    k > 0 && rows[k - 1].series == r->series && rows[k - 1].result == RUN_DONE ? &rows[k - 1] : NULL;
  r->pass = PETSC_TRUE;
  r->why[0] = '\0';
  r->reference = r->deviation = r->error = r->order = r->difference = r->pace = NAN;
  if (r->result != RUN_DONE) {
    r->reference = reference_value(r->row, r->series);
    r->value = NAN;
    fail(r, r->summary.interrupted ? "interrupted" : "the run gave up, see %s/log.txt", r->folder);
    return;
  }
  if (PetscIsInfOrNanReal(r->value)) {
    fail(r, "the value is not finite");
    return;
  }
  judge_reference(r);
  judge_order(r, before);
  judge_agreement(rows, k);
  judge_powers(rows, k);
  judge_pace(rows, k);
  judge_limits(r);
}
