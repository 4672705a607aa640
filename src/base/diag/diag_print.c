/* How a message looks:
 *
 *   case.yaml:12:7: error: key 'yung' of materials.rubber is not known
 *     rubber: {yung: 90e6}
 *              ^~~~
 *     hint: did you mean 'young'?
 */
#include "base/diag/diag_impl.h"
#include <string.h>

#define SHOWN_BEFORE 70 /* characters of a long line that are shown before and after the place */
#define SHOWN_AFTER 40

static const char *const severity_name[] = {"note", "warning", "error"};

/* Bytes of the UTF-8 character at p; 1 for anything broken, which is shown as '?'. */
static int character_bytes(const unsigned char *p)
{
  const int n = p[0] < 0x80 ? 1 : p[0] >= 0xF0 ? 4 : p[0] >= 0xE0 ? 3 : p[0] >= 0xC2 ? 2 : 0;
  for (int i = 1; i < n; ++i)
    if ((p[i] & 0xC0) != 0x80) return 0;
  return n;
}

static void print_line(const char *text, int first, int last, FILE *out)
{
  int k = 1;
  for (const unsigned char *p = (const unsigned char *)text; *p; ++k) {
    const int n = character_bytes(p);
    if (k >= first && k <= last) {
      if (n == 0 || (n == 1 && (*p == 127 || (*p < 32 && *p != '\t')))) fputc('?', out);
      else fwrite(p, 1, (size_t)n, out);
    }
    p += n ? n : 1;
  }
  fputc('\n', out);
}

/* Spaces up to the column, but a tab for a tab: the caret stands under its character at any tab
 * width. */
static void print_caret(const char *text, int first, const DiagMessage *m, int length, FILE *out)
{
  const unsigned char *p = (const unsigned char *)text;
  for (int k = 1; k < m->column && *p; ++k) {
    const int n = character_bytes(p);
    if (k >= first) fputc(*p == '\t' ? '\t' : ' ', out);
    p += n ? n : 1;
  }
  fputc('^', out);
  for (int k = 1; k < m->width && m->column + k <= length; ++k) fputc('~', out);
  fputc('\n', out);
}

static int count_characters(const char *text)
{
  int length = 0;
  for (const unsigned char *p = (const unsigned char *)text; *p; ++length) {
    const int n = character_bytes(p);
    p += n ? n : 1;
  }
  return length;
}

static void print_source(const DiagMessage *m, FILE *out)
{
  const int length = count_characters(m->text);
  const PetscBool whole = length <= SHOWN_BEFORE + SHOWN_AFTER;
  const int first = !whole && m->column > SHOWN_BEFORE ? m->column - SHOWN_BEFORE : 1;
  const int last = whole ? length : m->column + SHOWN_AFTER;
  fputs("  ", out);
  print_line(m->text, first, last, out);
  if (m->column < 1) return;
  fputs("  ", out);
  print_caret(m->text, first, m, length < last ? length : last, out);
}

void diag_message_print(const DiagMessage *m, FILE *out)
{
  if (m->file) fprintf(out, "%s:", m->file);
  if (m->line > 0) fprintf(out, "%d:", m->line);
  if (m->line > 0 && m->column > 0) fprintf(out, "%d:", m->column);
  fprintf(out, "%s%s: %s\n", m->file ? " " : "", severity_name[m->severity],
          m->message ? m->message : "(no memory for the message)");
  if (m->text && m->line > 0) print_source(m, out);
  if (m->hint) fprintf(out, "  hint: %s\n", m->hint);
}
