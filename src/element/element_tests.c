/* Tests of the laboratory as prescribed components. */
#include <string.h>
#include "element/element_spec.h"

enum { XX, YY, ZZ, XY };

static const ElementTest isotropic = {.name = "isotropic",
                                      .help = "all normal stresses go to this pressure, Pa",
                                      .unit = "Pa",
                                      .component = YY,
                                      .sign = -1,
                                      .stress = {[XX] = PETSC_TRUE, [YY] = PETSC_TRUE, [ZZ] = PETSC_TRUE},
                                      .isotropic = PETSC_TRUE};
static const ElementTest triaxial = {
  .name = "triaxial",
  .help = "y shortens to this logarithmic strain (negative: it lengthens), the total stresses along x and z stay",
  .component = YY,
  .sign = -1,
  .stress = {[XX] = PETSC_TRUE, [ZZ] = PETSC_TRUE}};
static const ElementTest oedometer = {.name = "oedometer",
                                      .help = "y shortens to this logarithmic strain, x and z keep their lengths",
                                      .component = YY,
                                      .sign = -1};
static const ElementTest biaxial = {
  .name = "biaxial",
  .help = "y shortens to this logarithmic strain, z keeps its length (plane strain), the total stress along x stays",
  .component = YY,
  .sign = -1,
  .stress = {[XX] = PETSC_TRUE}};
static const ElementTest simple_shear = {
  .name = "simple-shear",
  .help = "lines along y lean towards x by this tangent, x and z keep their lengths, the total stress along y stays",
  .component = XY,
  .sign = 1,
  .stress = {[YY] = PETSC_TRUE}};

const ElementTest *const element_tests[] = {&triaxial, &oedometer, &simple_shear, &biaxial, &isotropic, NULL};

/* Strains count from here: `zz: 0` holds z. Shears that nobody names do not strain, normal stresses
 * that nobody names stay. */
static void stage_components(const ElementStage *s, DriveControl *control, const PetscReal from[6], PetscReal to[6])
{
  for (int k = 0; k < 6; ++k) {
    const ElementComponents *given = control->stress[k] ? &s->stress : &s->strain;
    if (given->given[k]) to[k] = given->value[k] + (s->relative || !control->stress[k] ? from[k] : 0);
  }
}

static void stage_test(const ElementStage *s, const PetscReal from[6], PetscReal to[6])
{
  const int k = s->test->component;
  to[k] = s->test->sign * s->to + (s->relative ? from[k] : 0);
  for (int i = 0; i < 3 && s->test->isotropic; ++i) to[i] = s->test->sign * s->to + (s->relative ? from[i] : 0);
}

void element_stage(const ElementStage *s, const DrivePoint *point, DriveControl *control, PetscReal from[6],
                   PetscReal to[6])
{
  control->undrained = s->undrained;
  for (int k = 0; k < 6; ++k)
    control->stress[k] = s->test ? s->test->stress[k] : s->stress.given[k] || (k < 3 && !s->strain.given[k]);
  drive_values(point, control, from);
  memcpy(to, from, 6 * sizeof *to);
  if (s->test) stage_test(s, from, to);
  else stage_components(s, control, from, to);
}

const char *element_stage_name(const ElementStage *s, size_t size, char *text)
{
  static const char *const words[] = {"xx", "yy", "zz", "xy", "yz", "zx"};
  size_t used = (size_t)snprintf(text, size, "%s", s->test ? s->test->name : "");
  for (int kind = 0; kind < 2 && !s->test; ++kind) {
    const ElementComponents *c = kind ? &s->stress : &s->strain;
    const char *before = kind ? "stress" : "strain";
    for (int k = 0; k < 6 && used < size; ++k) {
      if (!c->given[k]) continue;
      used += (size_t)snprintf(text + used, size - used, "%s%s %s", used && before[0] ? ", " : "", before, words[k]);
      before = "";
    }
  }
  if (s->undrained && used < size) snprintf(text + used, size - used, ", undrained");
  return text;
}
