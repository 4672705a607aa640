/* Writers of single values, the mirror image of the readers. */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include "input/schema/schema.h"

#define FIELD(type) (*(type const *)((const char *)source + e->offset))

void schema_write_real(FILE *out, PetscReal value)
{
  char text[40];
  for (int digits = 6; digits <= 17; ++digits) {
    snprintf(text, sizeof(text), "%.*g", digits, (double)value);
    if (strtod(text, NULL) == value) break;
  }
  fputs(text, out);
}

/* Words that stay themselves without quotes, as text. */
static PetscBool is_plain(const char *text)
{
  if (!isalpha((unsigned char)text[0]) && text[0] != '/') return PETSC_FALSE;
  if (!strcmp(text, "null") || !strcmp(text, "true") || !strcmp(text, "false")) return PETSC_FALSE;
  for (const char *p = text; *p; ++p)
    if (!isalnum((unsigned char)*p) && !strchr("_-./ ()+", *p)) return PETSC_FALSE;
  return text[strlen(text) - 1] != ' ';
}

void schema_write_text(FILE *out, const char *text)
{
  if (is_plain(text)) {
    fputs(text, out);
    return;
  }
  fputc('"', out);
  for (const char *p = text; *p; ++p) {
    if (*p == '"' || *p == '\\') fprintf(out, "\\%c", *p);
    else if (*p == '\n') fputs("\\n", out);
    else if (*p == '\t') fputs("\\t", out);
    else if (*p == '\r') fputs("\\r", out);
    else fputc(*p, out);
  }
  fputc('"', out);
}

static void write_reals(FILE *out, PetscInt n, const PetscReal *value)
{
  fputc('[', out);
  for (PetscInt i = 0; i < n; ++i) {
    fputs(i ? ", " : "", out);
    schema_write_real(out, value[i]);
  }
  fputc(']', out);
}

static void write_number(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  (void)c;
  schema_write_real(out, FIELD(PetscReal));
}

static void write_integer(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  (void)c;
  fprintf(out, "%" PetscInt_FMT, FIELD(PetscInt));
}

static void write_boolean(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  (void)c;
  fputs(FIELD(PetscBool) ? "true" : "false", out);
}

static void write_word(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  (void)c;
  for (const SchemaWord *w = e->words; w->word; ++w)
    if (w->value == FIELD(int)) fputs(w->word, out);
}

static void write_member(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  (void)c;
  for (int k = 0; e->registry[k]; ++k)
    if (e->registry[k] == FIELD(const void *)) fputs(schema_word(e, k).word, out);
}

static void write_string(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  (void)c;
  schema_write_text(out, FIELD(char *));
}

/* A boundary that has a name is written by it. */
static void write_boundary(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  const PetscInt index = FIELD(PetscInt);
  fprintf(out, "%" PetscInt_FMT, index);
  if (index < c->n_boundary && c->boundary[index].name) fprintf(out, "  # %s", c->boundary[index].name);
}

static void write_vector(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  write_reals(out, kinematics_dim(c->kinematics), &FIELD(PetscReal));
}

static void write_spin(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  const PetscReal *spin = &FIELD(PetscReal);
  if (kinematics_dim(c->kinematics) == 2) schema_write_real(out, spin[2]);
  else write_reals(out, 3, spin);
}

static void write_axis(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  (void)c;
  fputc("xyz"[FIELD(PetscInt)], out);
}

static void write_axes(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  const PetscBool *component = &FIELD(PetscBool);
  PetscInt n = 0;
  (void)c;
  fputc('[', out);
  for (PetscInt d = 0; d < 3; ++d)
    if (component[d]) fprintf(out, "%s%c", n++ ? ", " : "", "xyz"[d]);
  fputc(']', out);
}

static void write_interval(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  const PetscReal pair[2] = {FIELD(PetscReal), *(const PetscReal *)((const char *)source + e->second)};
  (void)c;
  if (pair[0] == pair[1]) schema_write_real(out, pair[0]);
  else write_reals(out, 2, pair);
}

static void write_counts(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  const PetscInt *counts = &FIELD(PetscInt);
  for (PetscInt d = 0; d < kinematics_dim(c->kinematics); ++d)
    fprintf(out, "%s%" PetscInt_FMT, d ? ", " : "[", counts[d]);
  fputc(']', out);
}

static void write_amplitude(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  const Amplitude *a = &FIELD(Amplitude);
  (void)c;
  fputc('[', out);
  for (PetscInt i = 0; i < a->n; ++i) {
    const PetscReal pair[2] = {a->time[i], a->value[i]};
    fputs(i ? ", " : "", out);
    write_reals(out, 2, pair);
  }
  fputc(']', out);
}

static void write_polygon(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  const PetscReal *vertices = FIELD(PetscReal *);
  const PetscInt n = *(const PetscInt *)((const char *)source + e->count);
  (void)c;
  fputc('[', out);
  for (PetscInt i = 0; i < n; ++i) {
    fputs(i ? ", " : "", out);
    write_reals(out, 2, vertices + 2 * i);
  }
  fputc(']', out);
}

static void write_every(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  const PetscReal every = FIELD(PetscReal);
  (void)c;
  if (every == 0) fputs("end", out);
  else if (every < 0) fprintf(out, "{steps: %.0f}", -(double)every);
  else schema_write_real(out, every);
}

static void write_fields(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  char **fields = FIELD(char **);
  const PetscInt n = *(const PetscInt *)((const char *)source + e->count);
  (void)c;
  fputc('[', out);
  for (PetscInt i = 0; i < n; ++i) fprintf(out, "%s%s", i ? ", " : "", fields[i]);
  fputc(']', out);
}

static void write_numbers(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  const NamedValue *values = FIELD(NamedValue *);
  const PetscInt n = *(const PetscInt *)((const char *)source + e->count);
  (void)c;
  fputc('{', out);
  for (PetscInt i = 0; i < n; ++i) {
    fputs(i ? ", " : "", out);
    schema_write_text(out, values[i].name);
    fputs(": ", out);
    schema_write_real(out, values[i].value);
  }
  fputc('}', out);
}

static void write_options(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  char **options = FIELD(char **);
  const PetscInt n = *(const PetscInt *)((const char *)source + e->count);
  (void)c;
  fputc('{', out);
  for (PetscInt i = 0; i < n; ++i) {
    const char *name = options[i] + 1, *space = strchr(name, ' ');
    const int length = space ? (int)(space - name) : (int)strlen(name);
    fprintf(out, "%s\"%.*s\": ", i ? ", " : "", length, name);
    if (space) schema_write_text(out, space + 1);
    else fputs("null", out);
  }
  fputc('}', out);
}

const SchemaWriteType schema_writers[TYPE_COUNT] = {
  [TYPE_NUMBER] = write_number,     [TYPE_INTEGER] = write_integer,  [TYPE_BOOLEAN] = write_boolean,
  [TYPE_WORD] = write_word,         [TYPE_WORD_TEXT] = write_string, [TYPE_TEXT] = write_string,
  [TYPE_NAME] = write_string,       [TYPE_FILE] = write_string,      [TYPE_REFERENCE] = write_string,
  [TYPE_BOUNDARY] = write_boundary, [TYPE_VECTOR] = write_vector,    [TYPE_SPIN] = write_spin,
  [TYPE_AXIS] = write_axis,         [TYPE_SPIN_AXIS] = write_axis,   [TYPE_AXES] = write_axes,
  [TYPE_INTERVAL] = write_interval, [TYPE_COUNTS] = write_counts,    [TYPE_AMPLITUDE] = write_amplitude,
  [TYPE_POLYGON] = write_polygon,   [TYPE_EVERY] = write_every,      [TYPE_MEMBER] = write_member,
  [TYPE_FIELDS] = write_fields,     [TYPE_NUMBERS] = write_numbers,  [TYPE_OPTIONS] = write_options,
};
