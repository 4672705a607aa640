/* Writers of single values, the mirror image of the readers. */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include "input/schema/schema.h"

#define FIELD(type) (*(type const *)((const char *)source + e->offset))

void SchemaWriteReal(FILE *out, PetscReal value)
{
  char text[40];
  for (int digits = 6; digits <= 17; ++digits) {
    snprintf(text, sizeof(text), "%.*g", digits, (double)value);
    if (strtod(text, NULL) == value) break;
  }
  fputs(text, out);
}

/* Words that stay themselves without quotes, as text. */
static PetscBool IsPlain(const char *text)
{
  if (!isalpha((unsigned char)text[0]) && text[0] != '/') return PETSC_FALSE;
  if (!strcmp(text, "null") || !strcmp(text, "true") || !strcmp(text, "false")) return PETSC_FALSE;
  for (const char *p = text; *p; ++p)
    if (!isalnum((unsigned char)*p) && !strchr("_-./ ()+", *p)) return PETSC_FALSE;
  return text[strlen(text) - 1] != ' ';
}

void SchemaWriteText(FILE *out, const char *text)
{
  if (IsPlain(text)) {
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

static void WriteReals(FILE *out, PetscInt n, const PetscReal *value)
{
  fputc('[', out);
  for (PetscInt i = 0; i < n; ++i) {
    fputs(i ? ", " : "", out);
    SchemaWriteReal(out, value[i]);
  }
  fputc(']', out);
}

static void WriteNumber(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  (void)c;
  SchemaWriteReal(out, FIELD(PetscReal));
}

static void WriteInteger(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  (void)c;
  fprintf(out, "%" PetscInt_FMT, FIELD(PetscInt));
}

static void WriteBoolean(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  (void)c;
  fputs(FIELD(PetscBool) ? "true" : "false", out);
}

static void WriteWord(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  (void)c;
  for (const SchemaWord *w = e->words; w->word; ++w)
    if (w->value == FIELD(int)) fputs(w->word, out);
}

static void WriteString(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  (void)c;
  SchemaWriteText(out, FIELD(char *));
}

/* A boundary that has a name is written by it. */
static void WriteBoundary(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  const PetscInt index = FIELD(PetscInt);
  fprintf(out, "%" PetscInt_FMT, index);
  if (index < c->n_boundary && c->boundary[index].name) fprintf(out, "  # %s", c->boundary[index].name);
}

static void WriteVector(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  WriteReals(out, kinematics_dim(c->kinematics), &FIELD(PetscReal));
}

static void WriteSpin(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  const PetscReal *spin = &FIELD(PetscReal);
  if (kinematics_dim(c->kinematics) == 2) SchemaWriteReal(out, spin[2]);
  else WriteReals(out, 3, spin);
}

static void WriteAxis(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  (void)c;
  fputc("xyz"[FIELD(PetscInt)], out);
}

static void WriteAxes(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  const PetscBool *component = &FIELD(PetscBool);
  PetscInt n = 0;
  (void)c;
  fputc('[', out);
  for (PetscInt d = 0; d < 3; ++d)
    if (component[d]) fprintf(out, "%s%c", n++ ? ", " : "", "xyz"[d]);
  fputc(']', out);
}

static void WriteInterval(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  const PetscReal pair[2] = {FIELD(PetscReal), *(const PetscReal *)((const char *)source + e->second)};
  (void)c;
  if (pair[0] == pair[1]) SchemaWriteReal(out, pair[0]);
  else WriteReals(out, 2, pair);
}

static void WriteCounts(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  const PetscInt *counts = &FIELD(PetscInt);
  for (PetscInt d = 0; d < kinematics_dim(c->kinematics); ++d)
    fprintf(out, "%s%" PetscInt_FMT, d ? ", " : "[", counts[d]);
  fputc(']', out);
}

static void WriteAmplitude(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  const Amplitude *a = &FIELD(Amplitude);
  (void)c;
  fputc('[', out);
  for (PetscInt i = 0; i < a->n; ++i) {
    const PetscReal pair[2] = {a->time[i], a->value[i]};
    fputs(i ? ", " : "", out);
    WriteReals(out, 2, pair);
  }
  fputc(']', out);
}

static void WritePolygon(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  const PetscReal *vertices = FIELD(PetscReal *);
  const PetscInt n = *(const PetscInt *)((const char *)source + e->count);
  (void)c;
  fputc('[', out);
  for (PetscInt i = 0; i < n; ++i) {
    fputs(i ? ", " : "", out);
    WriteReals(out, 2, vertices + 2 * i);
  }
  fputc(']', out);
}

static void WriteEvery(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  const PetscReal every = FIELD(PetscReal);
  (void)c;
  if (every == 0) fputs("end", out);
  else if (every < 0) fprintf(out, "{steps: %.0f}", -(double)every);
  else SchemaWriteReal(out, every);
}

static void WriteFields(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  char **fields = FIELD(char **);
  const PetscInt n = *(const PetscInt *)((const char *)source + e->count);
  (void)c;
  fputc('[', out);
  for (PetscInt i = 0; i < n; ++i) fprintf(out, "%s%s", i ? ", " : "", fields[i]);
  fputc(']', out);
}

static void WriteNumbers(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  const NamedValue *values = FIELD(NamedValue *);
  const PetscInt n = *(const PetscInt *)((const char *)source + e->count);
  (void)c;
  fputc('{', out);
  for (PetscInt i = 0; i < n; ++i) {
    fputs(i ? ", " : "", out);
    SchemaWriteText(out, values[i].name);
    fputs(": ", out);
    SchemaWriteReal(out, values[i].value);
  }
  fputc('}', out);
}

static void WriteOptions(FILE *out, const Case *c, const SchemaEntry *e, const void *source)
{
  char **options = FIELD(char **);
  const PetscInt n = *(const PetscInt *)((const char *)source + e->count);
  (void)c;
  fputc('{', out);
  for (PetscInt i = 0; i < n; ++i) {
    const char *name = options[i] + 1, *space = strchr(name, ' ');
    const int length = space ? (int)(space - name) : (int)strlen(name);
    fprintf(out, "%s\"%.*s\": ", i ? ", " : "", length, name);
    if (space) SchemaWriteText(out, space + 1);
    else fputs("null", out);
  }
  fputc('}', out);
}

const SchemaWriteType schema_writers[TYPE_COUNT] = {
  [TYPE_NUMBER] = WriteNumber,       [TYPE_INTEGER] = WriteInteger,   [TYPE_BOOLEAN] = WriteBoolean,
  [TYPE_WORD] = WriteWord,           [TYPE_WORD_TEXT] = WriteString,  [TYPE_TEXT] = WriteString,
  [TYPE_NAME] = WriteString,         [TYPE_FILE] = WriteString,       [TYPE_LAW] = WriteString,
  [TYPE_REFERENCE] = WriteString,    [TYPE_BOUNDARY] = WriteBoundary, [TYPE_VECTOR] = WriteVector,
  [TYPE_SPIN] = WriteSpin,           [TYPE_AXIS] = WriteAxis,         [TYPE_SPIN_AXIS] = WriteAxis,
  [TYPE_AXES] = WriteAxes,           [TYPE_INTERVAL] = WriteInterval, [TYPE_COUNTS] = WriteCounts,
  [TYPE_AMPLITUDE] = WriteAmplitude, [TYPE_POLYGON] = WritePolygon,   [TYPE_EVERY] = WriteEvery,
  [TYPE_FIELDS] = WriteFields,       [TYPE_NUMBERS] = WriteNumbers,   [TYPE_OPTIONS] = WriteOptions,
};
