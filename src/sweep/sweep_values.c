#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include "sweep/sweep_spec.h"

void sweep_key_error(const SweepKey *key, const YamlDocument *document, Diag *diag, const char *format, ...)
{
  char text[512];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  if (key->node) yaml_error(document, diag, key->node, PETSC_FALSE, "%s", text);
  else sweep_word_error(diag, key->word, text);
}

const char *sweep_short_key(const SweepKey *key)
{
  const char *dot = strrchr(key->key, '.');
  return dot ? dot + 1 : key->key;
}

static PetscErrorCode AddValue(SweepKey *key, const char *value)
{
  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((size_t)(key->n + 1) * sizeof(char *), &key->value));
  PetscCall(PetscStrallocpy(value, &key->value[key->n++]));
  PetscFunctionReturn(0);
}

/* How many numbers stand in "a:b:c", if nothing else does: 0 for all else. */
static int parse_range(const char *text, double number[3])
{
  int n = 0;
  for (char *end; n < 3; text = end + 1) {
    number[n++] = strtod(text, &end);
    if (end == text || !isfinite(number[n - 1])) return 0;
    end += strspn(end, " ");
    if (!*end) return n;
    if (*end != ':') return 0;
  }
  return 0;
}

static PetscErrorCode AddRange(SweepKey *key, const char *text, const double r[3], const YamlDocument *document,
                               Diag *diag)
{
  const double steps = (r[1] - r[0]) / r[2];
  char number[32];

  PetscFunctionBeginUser;
  if (r[2] == 0 || steps < 0) {
    sweep_key_error(key, document, diag, "the range %s does not end: its step %s", text,
                    r[2] == 0 ? "is 0" : "leads away from its end");
    diag_hint(diag, r[2] == 0 ? "from:to:step, with a step other than 0" : "from:to:step; %g:%g:%g would end", r[0],
              r[1], -r[2]);
  } else if (steps > SWEEP_MOST_MEMBERS)
    sweep_key_error(key, document, diag, "the range %s has more than %d values", text, SWEEP_MOST_MEMBERS);
  else
    for (PetscInt i = 0; i <= (PetscInt)floor(steps + 1e-9); ++i) {
      /* 0.1:0.3:0.1 is 0.1, 0.2, 0.3: no digits of round-off */
      snprintf(number, sizeof number, "%.12g", r[0] + (double)i * r[2]);
      PetscCall(AddValue(key, number));
    }
  PetscFunctionReturn(0);
}

static PetscErrorCode AddItem(SweepKey *key, char *text, const YamlDocument *document, Diag *diag)
{
  double range[3];

  PetscFunctionBeginUser;
  text += strspn(text, " \t");
  for (size_t n = strlen(text); n > 0 && isspace((unsigned char)text[n - 1]);) text[--n] = '\0';
  const int n = parse_range(text, range);
  if (!text[0]) sweep_key_error(key, document, diag, "there is no value beside a comma of '%s'", key->text);
  else if (n == 2) {
    sweep_key_error(key, document, diag, "the range %s has no step", text);
    diag_hint(diag, "from:to:step, for example %s:%g", text, range[1] > range[0] ? 1. : -1.);
  } else if (n == 3) PetscCall(AddRange(key, text, range, document, diag));
  else PetscCall(AddValue(key, text));
  PetscFunctionReturn(0);
}

/* Up to the next comma that stands in no brackets and no quotes. */
static size_t item_length(const char *text)
{
  int depth = 0;
  char quote = 0;
  size_t n = 0;
  for (; text[n] && (depth > 0 || quote || text[n] != ','); ++n) {
    if (quote) quote = text[n] == quote ? 0 : quote;
    else if (strchr("'\"", text[n])) quote = text[n];
    else depth += strchr("[{", text[n]) ? 1 : strchr("]}", text[n]) ? -1 : 0;
  }
  return n;
}

void sweep_key_check_twice(const SweepKey *key, const YamlDocument *document, Diag *diag)
{
  for (PetscInt i = 0; i < key->n; ++i)
    for (PetscInt k = 0; k < i; ++k)
      if (!strcmp(key->value[i], key->value[k])) {
        sweep_key_error(key, document, diag, "the value %s of %s stands there twice", key->value[i], key->key);
        return;
      }
}

PetscErrorCode SweepKeyExpand(SweepKey *key, PetscBool quick, const YamlDocument *document, Diag *diag)
{
  const char *text = quick && key->quick ? key->quick : key->text;

  PetscFunctionBeginUser;
  for (const char *rest = text;; ++rest) {
    const size_t n = item_length(rest);
    char *item;
    PetscCall(PetscMalloc1(n + 1, &item));
    memcpy(item, rest, n);
    item[n] = '\0';
    PetscCall(AddItem(key, item, document, diag));
    PetscCall(PetscFree(item));
    rest += n;
    if (!*rest) break;
  }
  PetscFunctionReturn(0);
}

PetscReal sweep_number(const SweepKey *key, PetscInt i)
{
  double number[3];
  return parse_range(key->value[i], number) == 1 ? (PetscReal)number[0] : NAN;
}
