#include "picture/curves/keys.h"
#include <string.h>
#include "base/names.h"
#include "base/text.h"
#include "input/case_file.h"
#include "input/yaml/yaml.h"
#include "output/directory/run_dir_files.h"
#include "output/inputs.h"

/* All keys of all cases in the order in which they were met, with their values. */
typedef struct {
  Names names;
  PetscInt n, capacity, n_runs;
  char **key, **value;
} Table;

static PetscErrorCode TableAdd(Table *t, const char *key, PetscInt run, const char *value)
{
  PetscInt at = names_find(&t->names, key);

  PetscFunctionBeginUser;
  if (at < 0) {
    if (t->n == t->capacity) {
      t->capacity = 2 * t->capacity + 64;
      PetscCall(PetscRealloc((size_t)t->capacity * sizeof(char *), &t->key));
      PetscCall(PetscRealloc((size_t)(t->capacity * t->n_runs) * sizeof(char *), &t->value));
    }
    at = t->n++;
    PetscCall(PetscStrallocpy(key, &t->key[at]));
    for (PetscInt r = 0; r < t->n_runs; ++r) t->value[at * t->n_runs + r] = NULL;
    PetscCall(NamesSet(&t->names, t->key[at], at));
  }
  PetscCall(PetscFree(t->value[at * t->n_runs + run]));
  PetscCall(PetscStrallocpy(value, &t->value[at * t->n_runs + run]));
  PetscFunctionReturn(0);
}

static PetscBool plain_values(const YamlNode *node)
{
  for (PetscInt i = 0; i < node->n; ++i)
    if (node->child[i]->kind != YAML_SCALAR) return PETSC_FALSE;
  return node->kind == YAML_SEQUENCE;
}

/* Points of an amplitude, corners of a polygon. */
static PetscBool is_table(const YamlNode *node)
{
  for (PetscInt i = 0; i < node->n; ++i)
    if (!plain_values(node->child[i])) return PETSC_FALSE;
  return (PetscBool)(node->kind == YAML_SEQUENCE && node->n > 0);
}

/* A mapping is a value if it is empty: `basis: {cell: {}}`. Depth: that of a table. */
// NOLINTNEXTLINE(misc-no-recursion)
static void write_value(FILE *out, const YamlNode *node)
{
  if (node->kind == YAML_SCALAR) fputs(node->text, out);
  else if (node->kind == YAML_SEQUENCE) {
    fputc('[', out);
    for (PetscInt i = 0; i < node->n; ++i) {
      if (i) fputs(", ", out);
      write_value(out, node->child[i]);
    }
    fputc(']', out);
  } else fputs("{}", out);
}

/* Depth of YamlNodes is bounded by YAML_MAX_DEPTH. */
// NOLINTNEXTLINE(misc-no-recursion)
static PetscErrorCode Walk(const YamlNode *node, PetscInt run, Table *t)
{
  char path[1024], *value;
  TextStream stream;

  PetscFunctionBeginUser;
  if (node->kind != YAML_SCALAR && node->n > 0 && !plain_values(node) && !is_table(node)) {
    for (PetscInt i = 0; i < node->n; ++i) PetscCall(Walk(node->child[i], run, t));
    PetscFunctionReturn(0);
  }
  PetscCall(TextOpen(&stream));
  write_value(stream.out, node);
  PetscCall(TextClose(&stream, &value));
  PetscCall(TableAdd(t, yaml_path(node, path, sizeof path), run, value));
  PetscCall(PetscFree(value));
  PetscFunctionReturn(0);
}

/* What says nothing of the numbers of a run. */
static PetscBool is_idle(const char *key)
{
  static const char *const idle[] = {"title", "output", "checkpoint", NULL};
  for (int k = 0; idle[k]; ++k) {
    const size_t n = strlen(idle[k]);
    if (!strncmp(key, idle[k], n) && (!key[n] || key[n] == '.')) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* The case of a run; NULL: there is none that can be read. */
static PetscErrorCode OpenCase(const char *folder, YamlDocument **document)
{
  char path[FILE_PATH], reason[256], *text;
  size_t size;
  Diag *ignored;

  PetscFunctionBeginUser;
  *document = NULL;
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/case.yaml", folder));
  if (!file_exists(folder, "case.yaml")) PetscFunctionReturn(0);
  PetscCall(FileReadEverywhere(PETSC_COMM_SELF, path, &size, &text, reason));
  if (reason[0]) PetscFunctionReturn(0);
  PetscCall(DiagCreate(&ignored));
  PetscCall(YamlCreate(path, text, size, ignored, document));
  PetscCall(DiagDestroy(&ignored));
  PetscCall(PetscFree(text));
  if (!(*document)->root) PetscCall(YamlDestroy(document));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadCase(const char *folder, PetscInt run, Table *t, PetscBool *read)
{
  YamlDocument *document;

  PetscFunctionBeginUser;
  PetscCall(OpenCase(folder, &document));
  *read = (PetscBool)(document != NULL);
  if (!document) PetscFunctionReturn(0);
  PetscCall(Walk(document->root, run, t));
  PetscCall(YamlDestroy(&document));
  PetscFunctionReturn(0);
}

#define CONTENTS " (contents)"

/* What stands in the files that the run has read. */
static PetscErrorCode ReadInputs(const char *folder, PetscInt run, Table *t)
{
  char key[600], value[64];
  Inputs inputs;

  PetscFunctionBeginUser;
  PetscCall(InputsRead(folder, &inputs));
  for (PetscInt k = 0; k < inputs.n; ++k) {
    const Input *input = &inputs.input[k];
    PetscCall(PetscSNPrintf(key, sizeof key, "%s" CONTENTS, input->key));
    snprintf(value, sizeof value, "%08llx in %lld bytes", (unsigned long long)input->seal.crc,
             (long long)input->seal.bytes);
    PetscCall(TableAdd(t, key, run, value));
  }
  PetscCall(InputsClear(&inputs));
  PetscFunctionReturn(0);
}

PetscErrorCode KeysMeasureIs(const char *folder, const char *name, const char *kind, const char *word, PetscBool *is)
{
  YamlDocument *document;

  PetscFunctionBeginUser;
  *is = PETSC_FALSE;
  PetscCall(OpenCase(folder, &document));
  if (!document) PetscFunctionReturn(0);
  const YamlNode *value = yaml_find(yaml_find(yaml_find(document->root, "measures"), name), kind);
  *is = (PetscBool)(value && value->kind == YAML_SCALAR && !strcmp(value->text, word));
  PetscCall(YamlDestroy(&document));
  PetscFunctionReturn(0);
}

/* Runs of older programs have not told what they read: nobody knows. */
static PetscBool is_untold(const char *key, char *const *value, PetscInt n_runs)
{
  const char *contents = strstr(key, CONTENTS);
  for (PetscInt r = 0; contents && r < n_runs; ++r)
    if (!value[r]) return PETSC_TRUE;
  return PETSC_FALSE;
}

static PetscBool row_differs(const Table *t, PetscInt at)
{
  char *const *value = t->value + at * t->n_runs;
  if (is_untold(t->key[at], value, t->n_runs)) return PETSC_FALSE;
  for (PetscInt r = 1; r < t->n_runs; ++r)
    if (!value[0] != !value[r] || (value[0] && strcmp(value[0], value[r]))) return PETSC_TRUE;
  return PETSC_FALSE;
}

#define WHOLE 40 /* letters of a table that is shown as it is */

/* The next point of a table that is written out, and how many letters it has; NULL behind the last. */
static const char *next_point(const char *at, int *length)
{
  const char *begin = strchr(at, '['), *end = begin ? strchr(begin, ']') : NULL;
  *length = end ? (int)(end - begin) + 1 : 0;
  return end ? begin : NULL;
}

static PetscInt count_points(const char *table)
{
  PetscInt n = 0;
  int length;
  for (const char *at = table + 1; (at = next_point(at, &length)); at += length) ++n;
  return n;
}

/* Point k of a table, of `length` letters; "-" where it has fewer. */
static const char *point_of(const char *table, PetscInt k, int *length)
{
  const char *at = table + 1;
  for (PetscInt i = 0; (at = next_point(at, length)); ++i, at += *length)
    if (i == k) return at;
  *length = 1;
  return "-";
}

static PetscBool is_table_text(const char *value) { return (PetscBool)(value && !strncmp(value, "[[", 2)); }

/* The first point that is not the same in all runs that have the table. */
static PetscInt first_other(char *const *value, PetscInt n_runs)
{
  for (PetscInt k = 0;; ++k) {
    const char *first = NULL, *point;
    int length = 0, its;
    for (PetscInt r = 0; r < n_runs; ++r) {
      if (!is_table_text(value[r])) continue;
      point = point_of(value[r], k, &its);
      if (first && (its != length || strncmp(first, point, (size_t)its) != 0)) return k;
      if (!first) first = point, length = its;
    }
    if (!first || first[0] == '-') return -1;
  }
}

/* Of tables too long for a line of a table: how many points, and the first that is another. */
static PetscErrorCode Shorten(char **value, PetscInt n_runs)
{
  PetscBool longer = PETSC_FALSE;
  char text[128];
  int length;

  PetscFunctionBeginUser;
  for (PetscInt r = 0; r < n_runs; ++r)
    longer = (PetscBool)(longer || (is_table_text(value[r]) && strlen(value[r]) > WHOLE));
  const PetscInt k = longer ? first_other(value, n_runs) : -1;
  for (PetscInt r = 0; r < n_runs && longer; ++r) {
    if (!is_table_text(value[r])) continue;
    const char *point = k < 0 ? NULL : point_of(value[r], k, &length);
    const int used = snprintf(text, sizeof text, "%d points", (int)count_points(value[r]));
    if (point) snprintf(text + used, sizeof text - (size_t)used, ", [%d]: %.*s", (int)k, PetscMin(length, 80), point);
    PetscCall(PetscFree(value[r]));
    PetscCall(PetscStrallocpy(text, &value[r]));
  }
  PetscFunctionReturn(0);
}

/* Keep the rows that differ, free the others. */
static PetscErrorCode Keep(Table *t, PetscBool any)
{
  const PetscInt n = t->n;

  PetscFunctionBeginUser;
  t->n = 0;
  for (PetscInt i = 0; i < n; ++i) {
    const PetscBool kept = any && !is_idle(t->key[i]) && row_differs(t, i);
    for (PetscInt r = 0; r < t->n_runs; ++r) {
      char **value = &t->value[i * t->n_runs + r];
      if (kept) t->value[t->n * t->n_runs + r] = *value;
      else PetscCall(PetscFree(*value));
    }
    if (kept) PetscCall(Shorten(t->value + t->n * t->n_runs, t->n_runs));
    if (kept) t->key[t->n++] = t->key[i];
    else PetscCall(PetscFree(t->key[i]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode KeysDiffer(PetscInt n_runs, const char *const *folders, DifferingKeys *keys)
{
  Table t = {.n_runs = n_runs};
  PetscBool all = PETSC_TRUE;

  PetscFunctionBeginUser;
  for (PetscInt r = 0; r < n_runs; ++r) {
    PetscBool read = PETSC_FALSE;
    PetscCall(ReadCase(folders[r], r, &t, &read));
    if (read) PetscCall(ReadInputs(folders[r], r, &t));
    all = all && read;
  }
  PetscCall(NamesFree(&t.names));
  PetscCall(Keep(&t, all));
  *keys = (DifferingKeys){.n = t.n, .n_runs = n_runs, .key = t.key, .value = t.value};
  PetscFunctionReturn(0);
}

PetscErrorCode DifferingKeysFree(DifferingKeys *keys)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < keys->n; ++i) PetscCall(PetscFree(keys->key[i]));
  for (PetscInt i = 0; i < keys->n * keys->n_runs; ++i) PetscCall(PetscFree(keys->value[i]));
  PetscCall(PetscFree(keys->key));
  PetscCall(PetscFree(keys->value));
  PetscFunctionReturn(0);
}

void keys_legend(const DifferingKeys *keys, PetscInt run, char legend[128])
{
  int used = 0;
  legend[0] = 0;
  for (PetscInt i = 0; i < keys->n && used < 64; ++i) {
    const char *value = keys->value[i * keys->n_runs + run], *unit = schema_unit(keys->key[i]),
               *dot = strrchr(keys->key[i], '.');
    used += snprintf(legend + used, 128 - (size_t)used, "%s%s = %s%s%s", i ? ", " : "", dot ? dot + 1 : keys->key[i],
                     value ? value : "-", value && unit ? " " : "", value && unit ? unit : "");
  }
  if (used >= 64) legend[0] = 0;
}
