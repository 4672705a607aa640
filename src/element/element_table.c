#include "element/element_table.h"
#include <string.h>
#include "base/text.h"
#include "material/algebra/invariants.h"
#include "output/directory/run_dir_files.h"

static const char *const components[] = {"xx", "yy", "zz", "xy", "yz", "zx"};

static void fill(const DrivePoint *p, PetscInt stage, PetscReal *row)
{
  PetscReal F[9];
  drive_gradient(p->strain, F);
  row[ELEMENT_STAGE] = (PetscReal)stage;
  strain_logarithmic(F, row + ELEMENT_STRAIN);
  row[ELEMENT_SHEAR] = p->strain[3];
  row[ELEMENT_VOLUME] = p->strain[0] + p->strain[1] + p->strain[2];
  row[ELEMENT_DEVIATORIC] = strain_deviatoric(row + ELEMENT_STRAIN);
  memcpy(row + ELEMENT_STRESS, p->stress, sizeof p->stress);
  row[ELEMENT_PORE] = p->pore;
  row[ELEMENT_P] = stress_pressure(p->stress);
  row[ELEMENT_Q] = stress_deviatoric(p->stress);
  row[ELEMENT_FRICTION] = stress_mobilised_friction(p->stress) * 180 / PETSC_PI;
  memcpy(row + ELEMENT_LAW, p->state, (size_t)p->material->law->n_state * sizeof *row);
}

PetscErrorCode ElementTableAdd(ElementTable *t, PetscInt stage, const DrivePoint *point)
{
  PetscFunctionBeginUser;
  t->law = point->material->law;
  t->n_columns = ELEMENT_LAW + t->law->n_state;
  if (t->n == t->capacity) {
    t->capacity = 2 * t->capacity + 128;
    PetscCall(PetscRealloc((size_t)(t->capacity * t->n_columns) * sizeof *t->values, &t->values));
  }
  fill(point, stage, t->values + t->n++ * t->n_columns);
  PetscFunctionReturn(0);
}

static void write_tensor(FILE *out, const char *name, const char *unit)
{
  char column[64], label[TEXT_LABEL];
  for (int k = 0; k < 6; ++k) {
    snprintf(column, sizeof column, "%s_%s", name, components[k]);
    fprintf(out, ",%s", text_with_unit(column, unit, label));
  }
}

static void write_header(FILE *out, const Law *law)
{
  char label[TEXT_LABEL];
  fputs("stage", out);
  write_tensor(out, "strain", "");
  fputs(",shear,volume_strain,deviatoric_strain", out);
  write_tensor(out, "stress", "Pa");
  fputs(",pore_pressure [Pa],p [Pa],q [Pa],mobilised_friction [deg]", out);
  for (const LawField *f = law->fields; f->name; ++f)
    if (f->components == 6) write_tensor(out, f->name, f->unit);
    else fprintf(out, ",%s", text_with_unit(f->name, f->unit, label));
  fputc('\n', out);
}

PetscErrorCode ElementTableWrite(const ElementTable *t, const char *path, Diag *diag)
{
  char number[32], *text;
  TextStream stream;

  PetscFunctionBeginUser;
  PetscCall(TextOpen(&stream));
  write_header(stream.out, t->law);
  for (PetscInt i = 0; i < t->n * t->n_columns; ++i) {
    file_format_real(t->values[i], number);
    fprintf(stream.out, "%s%s", number, (i + 1) % t->n_columns ? "," : "\n");
  }
  PetscCall(TextClose(&stream, &text));
  const int error = file_write_text(path, text);
  PetscCall(PetscFree(text));
  if (error) diag_error(diag, NULL, "cannot write '%s': %s", path, strerror(error));
  PetscFunctionReturn(0);
}
