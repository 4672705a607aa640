/* Writers of single values, the mirror image of the readers. */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include "input/schema/schema.h"

#define FIELD_AT(type, where) (*(type const *)((const char *)w->source + w->entry->where))
#define FIELD(type) FIELD_AT(type, offset)

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
  for (PetscInt i = 0; i < n; ++i) {
    fputs(i ? ", " : "[", out);
    schema_write_real(out, value[i]);
  }
  fputc(']', out);
}

/* The pairs of numbers that stand so many places apart at x and at y. */
static void write_pairs(FILE *out, PetscInt n, const PetscReal *x, const PetscReal *y, PetscInt apart)
{
  for (PetscInt i = 0; i < n; ++i) {
    fputs(i ? ", " : "[", out);
    write_reals(out, 2, (const PetscReal[]){x[apart * i], y[apart * i]});
  }
  fputc(']', out);
}

static void write_number(const SchemaWriting *w) { schema_write_real(w->out, FIELD(PetscReal)); }

static void write_integer(const SchemaWriting *w) { fprintf(w->out, "%" PetscInt_FMT, FIELD(PetscInt)); }

static void write_boolean(const SchemaWriting *w) { fputs(FIELD(PetscBool) ? "true" : "false", w->out); }

static void write_word(const SchemaWriting *w)
{
  for (const SchemaWord *word = w->entry->words; word->word; ++word)
    if (word->value == FIELD(int)) fputs(word->word, w->out);
}

static void write_member(const SchemaWriting *w)
{
  for (int k = 0; w->entry->registry[k]; ++k)
    if (w->entry->registry[k] == FIELD(const void *)) fputs(schema_word(w->entry, k).word, w->out);
}

static void write_string(const SchemaWriting *w) { schema_write_text(w->out, FIELD(char *)); }

/* A boundary that has a name is written by it. */
static void write_boundary(const SchemaWriting *w)
{
  const PetscInt index = FIELD(PetscInt);
  fprintf(w->out, "%" PetscInt_FMT, index);
  if (index < w->c->n_boundary && w->c->boundary[index].name) fprintf(w->out, "  # %s", w->c->boundary[index].name);
}

static void write_vector(const SchemaWriting *w)
{
  write_reals(w->out, kinematics_dim(w->c->kinematics), &FIELD(PetscReal));
}

static void write_spin(const SchemaWriting *w)
{
  const PetscReal *spin = &FIELD(PetscReal);
  if (kinematics_dim(w->c->kinematics) == 2) schema_write_real(w->out, spin[2]);
  else write_reals(w->out, 3, spin);
}

static void write_axis(const SchemaWriting *w) { fputc("xyz"[FIELD(PetscInt)], w -> out); }

static void write_axes(const SchemaWriting *w)
{
  const PetscBool *component = &FIELD(PetscBool);
  PetscInt n = 0;
  fputc('[', w->out);
  for (PetscInt d = 0; d < 3; ++d)
    if (component[d]) fprintf(w->out, "%s%c", n++ ? ", " : "", "xyz"[d]);
  if (component[NORMAL]) fprintf(w->out, "%snormal", n ? ", " : "");
  fputc(']', w->out);
}

static void write_interval(const SchemaWriting *w)
{
  const PetscReal pair[2] = {FIELD(PetscReal), FIELD_AT(PetscReal, second)};
  if (pair[0] == pair[1]) schema_write_real(w->out, pair[0]);
  else write_reals(w->out, 2, pair);
}

static void write_counts(const SchemaWriting *w)
{
  const PetscInt *counts = &FIELD(PetscInt);
  for (PetscInt d = 0; d < kinematics_dim(w->c->kinematics); ++d)
    fprintf(w->out, "%s%" PetscInt_FMT, d ? ", " : "[", counts[d]);
  fputc(']', w->out);
}

static void write_amplitude(const SchemaWriting *w)
{
  const Amplitude *a = &FIELD(Amplitude);
  write_pairs(w->out, a->n, a->time, a->value, 1);
}

static void write_polygon(const SchemaWriting *w)
{
  const PetscReal *vertices = FIELD(PetscReal *);
  write_pairs(w->out, FIELD_AT(PetscInt, count), vertices, vertices + 1, 2);
}

static void write_every(const SchemaWriting *w)
{
  const PetscReal every = FIELD(PetscReal);
  if (every == 0) fputs("end", w->out);
  else if (every < 0) fprintf(w->out, "{steps: %.0f}", -(double)every);
  else schema_write_real(w->out, every);
}

static void write_texts(const SchemaWriting *w)
{
  const PetscInt n = FIELD_AT(PetscInt, count);
  fputc('[', w->out);
  for (PetscInt i = 0; i < n; ++i) {
    fputs(i ? ", " : "", w->out);
    schema_write_text(w->out, FIELD(char **)[i]);
  }
  fputc(']', w->out);
}

static void write_flags(const SchemaWriting *w)
{
  PetscInt n = 0;
  fputc('[', w->out);
  for (const SchemaWord *word = w->entry->words; word->word; ++word)
    if ((&FIELD(PetscBool))[word->value]) fprintf(w->out, "%s%s", n++ ? ", " : "", word->word);
  fputc(']', w->out);
}

static void write_numbers(const SchemaWriting *w)
{
  const PetscInt n = FIELD_AT(PetscInt, count);
  fputc('{', w->out);
  for (PetscInt i = 0; i < n; ++i) {
    const NamedValue *value = FIELD(NamedValue *) + i;
    fputs(i ? ", " : "", w->out);
    schema_write_text(w->out, value->name);
    fputs(": ", w->out);
    schema_write_real(w->out, value->value);
  }
  fputc('}', w->out);
}

static void write_amplitudes(const SchemaWriting *w)
{
  const PetscInt n = FIELD_AT(PetscInt, count);
  fputc('{', w->out);
  for (PetscInt i = 0; i < n; ++i) {
    const NamedAmplitude *one = FIELD(NamedAmplitude *) + i;
    fputs(i ? ", " : "", w->out);
    schema_write_text(w->out, one->name);
    fputs(": ", w->out);
    write_pairs(w->out, one->amplitude.n, one->amplitude.time, one->amplitude.value, 1);
  }
  fputc('}', w->out);
}

static void write_options(const SchemaWriting *w)
{
  const PetscInt n = FIELD_AT(PetscInt, count);
  fputc('{', w->out);
  for (PetscInt i = 0; i < n; ++i) {
    const char *name = FIELD(char **)[i] + 1, *space = strchrnul(name, ' ');
    fprintf(w->out, "%s\"%.*s\": ", i ? ", " : "", (int)(space - name), name);
    if (*space) schema_write_text(w->out, space + 1);
    else fputs("null", w->out);
  }
  fputc('}', w->out);
}

void schema_write_flow(FILE *out, const YamlNode *node)
{
  if (node->kind == YAML_SCALAR) {
    if (node->plain) fputs(node->text, out);
    else schema_write_text(out, node->text);
    return;
  }
  fputc(node->kind == YAML_MAPPING ? '{' : '[', out);
  for (PetscInt i = 0; i < node->n; ++i) {
    if (i) fputs(", ", out);
    if (node->kind == YAML_MAPPING) schema_write_text(out, node->child[i]->key), fputs(": ", out);
    schema_write_flow(out, node->child[i]);
  }
  fputc(node->kind == YAML_MAPPING ? '}' : ']', out);
}

const SchemaWriteType schema_writers[TYPE_COUNT] = {
  [TYPE_NUMBER] = write_number,
  [TYPE_INTEGER] = write_integer,
  [TYPE_BOOLEAN] = write_boolean,
  [TYPE_WORD] = write_word,
  [TYPE_WORD_TEXT] = write_string,
  [TYPE_TEXT] = write_string,
  [TYPE_NAME] = write_string,
  [TYPE_VALUES] = write_string,
  [TYPE_FILE] = write_string,
  [TYPE_REFERENCE] = write_string,
  [TYPE_BOUNDARY] = write_boundary,
  [TYPE_VECTOR] = write_vector,
  [TYPE_SPIN] = write_spin,
  [TYPE_AXIS] = write_axis,
  [TYPE_SPIN_AXIS] = write_axis,
  [TYPE_AXES] = write_axes,
  [TYPE_INTERVAL] = write_interval,
  [TYPE_COUNTS] = write_counts,
  [TYPE_AMPLITUDE] = write_amplitude,
  [TYPE_POLYGON] = write_polygon,
  [TYPE_EVERY] = write_every,
  [TYPE_MEMBER] = write_member,
  [TYPE_FIELDS] = write_texts,
  [TYPE_NUMBERS] = write_numbers,
  [TYPE_FLAGS] = write_flags,
  [TYPE_OPTIONS] = write_options,
  [TYPE_REFERENCES] = write_texts,
  [TYPE_LINE] = write_polygon,
  [TYPE_AMPLITUDES] = write_amplitudes,
};
