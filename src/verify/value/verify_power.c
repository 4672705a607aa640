/* Power laws: log(value - offset) = exponent log(at) + constant, by least squares over the rows. */
#include <math.h>
#include <string.h>
#include "verify/verify_private.h"

PetscBool power_takes(const PowerSpec *power, const RowSpec *row)
{
  return row->x > 0 && row->x >= power->from * (1 - 1e-9) && row->x <= power->to * (1 + 1e-9);
}

PetscReal verify_exponent(const VerifyRow *rows, PetscInt k, const PowerSpec *power)
{
  const StudySpec *study = rows[k].study;
  PetscReal x = 0, y = 0, xx = 0, xy = 0;
  PetscInt n = 0, wanted = 0;
  if (!power_takes(power, rows[k].row)) return NAN;
  for (PetscInt i = k; i >= 0 && rows[i].study == study && rows[i].series == rows[k].series; --i) {
    if (!power_takes(power, rows[i].row) || rows[i].result != RUN_DONE) continue;
    const PetscReal a = PetscLogReal(rows[i].row->x), b = PetscLogReal(PetscMax(rows[i].value - power->offset, 1e-300));
    x += a, y += b, xx += a * a, xy += a * b;
    ++n;
  }
  for (PetscInt i = 0; i < study->n_rows; ++i) wanted += power_takes(power, &study->rows[i]);
  return n < wanted ? NAN : (n * xy - x * y) / (n * xx - x * x);
}

void verify_power_text(const VerifyRow *rows, PetscInt first, PetscInt last, const PowerSpec *power, char text[512])
{
  const StudySpec *study = rows[first].study;
  size_t used = (size_t)snprintf(text, 512, "%s - %g goes with a power of %s from %g to %g:", study->measure,
                                 (double)power->offset, study->sweep.symbol, (double)power->from, (double)power->to);
  PetscInt n = 0;
  for (PetscInt k = first; k < last && used < 400; ++k) {
    const PetscReal exponent = verify_exponent(rows, k, power);
    if (PetscIsNanReal(exponent)) continue;
    used += (size_t)snprintf(text + used, 512 - used, "%s %.3f (%.40s)", n++ ? "," : "", (double)exponent,
                             rows[k].series->name);
  }
  if (n && power->has_exponent)
    snprintf(text + used, 512 - used, "; %g within %g asked for%s%.40s", (double)power->exponent, (double)power->within,
             power->series ? " of " : "", power->series ? power->series : "");
  if (!n) text[0] = '\0';
}
