/* Characters and bytes of a Gmsh file as numbers. */
#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include "grid/gmsh/msh_reader.h"

static PetscInt line_number(const MshReader *r)
{
  PetscInt line = 1;
  for (const char *c = r->data; c < r->at; ++c) line += *c == '\n';
  return line;
}

void msh_fail(MshReader *r, const char *format, ...)
{
  char text[512];
  va_list list;
  if (r->failed) return;
  r->failed = PETSC_TRUE;
  va_start(list, format);
  (void)vsnprintf(text, sizeof text, format, list);
  va_end(list);
  if (r->binary) (void)snprintf(r->message, r->message_size, "%s: %s", r->path, text);
  else (void)snprintf(r->message, r->message_size, "%s:%lld: %s", r->path, (long long)line_number(r), text);
}

void msh_skip_space(MshReader *r)
{
  while (r->at < r->end && (*r->at == ' ' || *r->at == '\t' || *r->at == '\n' || *r->at == '\r')) ++r->at;
}

void msh_skip_line(MshReader *r)
{
  while (r->at < r->end && *r->at != '\n') ++r->at;
  if (r->at < r->end) ++r->at;
}

/* Characters of a word that are worth showing. */
static int word_length(const char *word) { return (int)PetscMin(strcspn(word, " \t\r\n"), 12); }

PetscInt64 msh_text_int(MshReader *r)
{
  char *stop;
  if (r->failed) return 0;
  msh_skip_space(r);
  errno = 0;
  const long long value = r->at < r->end && *r->at != '$' ? strtoll(r->at, &stop, 10) : 0;
  if (r->at >= r->end) msh_fail(r, "the file ends in the middle: it is truncated");
  else if (*r->at == '$' || stop == r->at || errno)
    msh_fail(r, "an integer was expected, '%.*s' found", word_length(r->at), r->at);
  else r->at = stop;
  return r->failed ? 0 : value;
}

PetscReal msh_text_real(MshReader *r)
{
  char *stop;
  if (r->failed) return 0;
  msh_skip_space(r);
  const double value = r->at < r->end && *r->at != '$' ? strtod(r->at, &stop) : 0;
  if (r->at >= r->end) msh_fail(r, "the file ends in the middle: it is truncated");
  else if (*r->at == '$' || stop == r->at)
    msh_fail(r, "a number was expected, '%.*s' found", word_length(r->at), r->at);
  else if (!isfinite(value)) msh_fail(r, "a coordinate is not finite");
  else r->at = stop;
  return r->failed ? 0 : value;
}

void msh_take(MshReader *r, size_t n, void *value)
{
  memset(value, 0, n);
  if (r->failed) return;
  if ((size_t)(r->end - r->at) < n) {
    msh_fail(r, "the file ends in the middle: it is truncated");
    return;
  }
  memcpy(value, r->at, n);
  r->at += n;
}

PetscInt64 msh_int(MshReader *r)
{
  int32_t value;
  if (!r->binary) return msh_text_int(r);
  msh_take(r, sizeof value, &value);
  return value;
}

PetscInt64 msh_size(MshReader *r)
{
  int64_t value;
  if (!r->binary) return msh_text_int(r);
  msh_take(r, sizeof value, &value);
  return value;
}

PetscReal msh_real(MshReader *r)
{
  double value;
  if (!r->binary) return msh_text_real(r);
  msh_take(r, sizeof value, &value);
  if (!isfinite(value)) msh_fail(r, "a coordinate is not finite");
  return r->failed ? 0 : value;
}

PetscInt msh_count(MshReader *r, PetscInt64 n, PetscInt64 text_bytes, PetscInt64 binary_bytes, const char *what)
{
  const PetscInt64 room = (r->end - r->at) / (r->binary ? binary_bytes : text_bytes) + 1;
  if (r->failed) return 0;
  if (n < 0 || n > room || n > PETSC_MAX_INT / MSH_MAX_NODES) {
    msh_fail(r, "the file claims %lld %s but holds fewer: it is truncated or damaged", (long long)n, what);
    return 0;
  }
  return (PetscInt)n;
}

PetscInt msh_tag(MshReader *r, PetscInt64 tag, const char *what)
{
  if (tag <= 0 || tag > PETSC_MAX_INT) msh_fail(r, "%lld is no number of a %s", (long long)tag, what);
  return r->failed ? 0 : (PetscInt)tag;
}
