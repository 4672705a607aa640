#include "base/diag/diag_impl.h"
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

PetscErrorCode DiagCreate(Diag **diag)
{
  PetscFunctionBeginUser;
  *diag = calloc(1, sizeof(**diag));
  PetscCheck(*diag, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for diagnostics");
  (*diag)->printer = -1;
  PetscFunctionReturn(0);
}

void diag_message_clear(DiagMessage *message)
{
  free(message->file);
  free(message->text);
  free(message->message);
  free(message->hint);
  memset(message, 0, sizeof(*message));
}

static void forget(Diag *diag)
{
  for (PetscInt i = 0; i < diag->n; ++i) diag_message_clear(&diag->messages[i]);
  diag->n = diag->errors = diag->warnings = 0;
  memset(diag->shown, 0, sizeof diag->shown);
  memset(diag->more, 0, sizeof diag->more);
}

PetscErrorCode DiagDestroy(Diag **diag)
{
  PetscFunctionBeginUser;
  if (*diag) {
    forget(*diag);
    if ((*diag)->context_destroy) (*diag)->context_destroy((*diag)->context);
    free((*diag)->messages);
    free(*diag);
    *diag = NULL;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode DiagSetResolver(Diag *diag, DiagResolver resolver, void *context)
{
  PetscFunctionBeginUser;
  if (diag->context_destroy) diag->context_destroy(diag->context);
  diag->resolver = resolver;
  diag->context = context;
  diag->context_destroy = NULL;
  PetscFunctionReturn(0);
}

PetscErrorCode DiagOwnContext(Diag *diag, void (*destroy)(void *))
{
  PetscFunctionBeginUser;
  diag->context_destroy = destroy;
  PetscFunctionReturn(0);
}

PetscBool diag_full(const Diag *diag, DiagSeverity severity)
{
  return diag->shown[severity == DIAG_ERROR] >= DIAG_MOST;
}

static void count(Diag *diag, DiagSeverity severity)
{
  diag->errors += severity == DIAG_ERROR;
  diag->warnings += severity == DIAG_WARNING;
}

/* One that is not kept; nor is its hint. */
static void count_only(Diag *diag, DiagSeverity severity)
{
  count(diag, severity);
  diag->more[severity == DIAG_ERROR] += 1;
  diag->stale_hint = PETSC_TRUE;
}

/* A message that finds no memory is lost, but it still counts. */
void diag_append(Diag *diag, DiagMessage *message)
{
  if (diag_full(diag, message->severity)) {
    count_only(diag, message->severity);
    diag_message_clear(message);
    return;
  }
  count(diag, message->severity);
  diag->shown[message->severity == DIAG_ERROR] += 1;
  if (diag->n == diag->capacity) {
    const PetscInt capacity = diag->capacity ? 2 * diag->capacity : 16;
    DiagMessage *grown = realloc(diag->messages, (size_t)capacity * sizeof(*grown));
    diag->stale_hint = !grown;
    if (!grown) {
      diag_message_clear(message);
      return;
    }
    diag->messages = grown;
    diag->capacity = capacity;
  }
  diag->stale_hint = PETSC_FALSE;
  diag->messages[diag->n++] = *message;
}

/* What is longer than any screen (a key of a megabyte) ends in dots, and not within a character. */
#define LONGEST_TEXT 2000

static char *cut_long(char *text)
{
  size_t n = LONGEST_TEXT;
  if (strlen(text) <= LONGEST_TEXT) return text;
  while (n > 0 && (text[n] & 0xC0) == 0x80) --n;
  memcpy(text + n, "...", 4);
  return text;
}

static char *diag_format(const char *format, va_list arguments)
{
  char *text = NULL;
  return vasprintf(&text, format, arguments) < 0 ? NULL : cut_long(text);
}

void diag_of_stage(Diag *diag, PetscInt k, const char *name)
{
  diag->stage = k;
  diag->stage_name[0] = '\0';
  if (k >= 0 && name) snprintf(diag->stage_name, sizeof diag->stage_name, "%s", name);
}

/* What an earlier stage was warned of. */
static PetscBool is_said(const Diag *diag, const DiagMessage *message)
{
  if (!diag->stage_name[0] || message->severity == DIAG_ERROR || !message->message) return PETSC_FALSE;
  for (const DiagMessage *m = diag->messages; m < diag->messages + diag->n; ++m)
    if (m->message && !strcmp(m->message, message->message) && m->line == message->line) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Whoever reads of a mistake in a stage must know in which. */
static void name_stage(const Diag *diag, DiagMessage *message)
{
  char *longer = NULL;
  if (!diag->stage_name[0] || message->severity != DIAG_ERROR || !message->message) return;
  if (asprintf(&longer, "%s (stage '%s')", message->message, diag->stage_name) < 0) return;
  free(message->message);
  message->message = longer;
}

static void record(Diag *diag, DiagSeverity severity, const DiagPlace *place, const char *format, va_list arguments)
{
  if (diag_full(diag, severity)) {
    count_only(diag, severity);
    return;
  }
  DiagMessage message = {.severity = severity, .line = place->line, .column = place->column, .width = place->width};
  message.file = place->file ? strdup(place->file) : NULL;
  message.text = place->text ? strdup(place->text) : NULL;
  message.message = diag_format(format, arguments);
  if (is_said(diag, &message)) {
    diag_message_clear(&message);
    diag->stale_hint = PETSC_TRUE;
    return;
  }
  name_stage(diag, &message);
  diag_append(diag, &message);
}

static void record_at_path(Diag *diag, DiagSeverity severity, const char *path, const char *format, va_list arguments)
{
  DiagPlace place = {.width = 1};
  char *staged = NULL;
  if (path && diag->stage_name[0] && asprintf(&staged, "@%d:%s", (int)diag->stage, path) < 0) staged = NULL;
  if (diag->resolver && !diag_full(diag, severity)) diag->resolver(diag->context, staged ? staged : path, &place);
  free(staged);
  record(diag, severity, &place, format, arguments);
}

void diag_error(Diag *diag, const char *path, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  record_at_path(diag, DIAG_ERROR, path, format, arguments);
  va_end(arguments);
}

void diag_warning(Diag *diag, const char *path, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  record_at_path(diag, DIAG_WARNING, path, format, arguments);
  va_end(arguments);
}

void diag_at(Diag *diag, DiagSeverity severity, const DiagPlace *place, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  record(diag, severity, place, format, arguments);
  va_end(arguments);
}

void diag_hint(Diag *diag, const char *format, ...)
{
  if (diag->n == 0 || diag->stale_hint) return;
  DiagMessage *newest = &diag->messages[diag->n - 1];
  va_list arguments;
  va_start(arguments, format);
  free(newest->hint);
  newest->hint = diag_format(format, arguments);
  va_end(arguments);
}

PetscInt diag_errors(const Diag *diag) { return diag->errors; }

PetscInt diag_warnings(const Diag *diag) { return diag->warnings; }

/* Where the file of message i was first mentioned: messages of one file stay together. */
static PetscInt file_rank(const Diag *diag, PetscInt i)
{
  const char *file = diag->messages[i].file ? diag->messages[i].file : "";
  PetscInt k = 0;
  while (k < i && strcmp(diag->messages[k].file ? diag->messages[k].file : "", file)) ++k;
  return k;
}

typedef struct {
  PetscInt file, index;
  int line, column;
} SortKey;

static int compare_keys(const void *a, const void *b)
{
  const SortKey *p = a, *q = b;
  if (p->file != q->file) return p->file < q->file ? -1 : 1;
  if (p->line != q->line) return p->line < q->line ? -1 : 1;
  if (p->column != q->column) return p->column < q->column ? -1 : 1;
  return p->index < q->index ? -1 : p->index > q->index;
}

static PetscBool prints_here(const Diag *diag)
{
  int initialised = 0, rank = 0;
  if (diag->printer >= 0) return diag->printer > 0;
  MPI_Initialized(&initialised);
  if (initialised) MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank == 0;
}

static void print_more(PetscInt n, const char *what, FILE *out)
{
  if (n > 0) fprintf(out, "and %" PetscInt_FMT " more %s%s\n", n, what, n > 1 ? "s" : "");
}

PetscErrorCode DiagPrint(const Diag *diag, FILE *out)
{
  SortKey *keys;

  PetscFunctionBeginUser;
  if (diag->n > 0 && prints_here(diag)) {
    PetscCall(PetscMalloc1(diag->n, &keys));
    for (PetscInt i = 0; i < diag->n; ++i) {
      const DiagMessage *m = &diag->messages[i];
      keys[i] = (SortKey){.file = file_rank(diag, i), .index = i, .line = m->line, .column = m->column};
    }
    qsort(keys, (size_t)diag->n, sizeof(*keys), compare_keys);
    for (PetscInt i = 0; i < diag->n; ++i) diag_message_print(&diag->messages[keys[i].index], out);
    print_more(diag->more[0], "warning", out);
    print_more(diag->more[1], "error", out);
    fflush(out);
    PetscCall(PetscFree(keys));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode DiagFlush(Diag *diag, FILE *out)
{
  PetscFunctionBeginUser;
  PetscCall(DiagPrint(diag, out));
  forget(diag);
  PetscFunctionReturn(0);
}
