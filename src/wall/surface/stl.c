/* STL: triangles of single precision (binary), or words and numbers (ASCII). */
#include <ctype.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/file.h"
#include "wall/surface/triangles.h"

enum { BINARY_HEAD = 84, BINARY_TRIANGLE = 50 };

typedef struct {
  const char *at, *data, *path;
  size_t size;
  char *message;
} StlText;

static PetscInt line_of(const StlText *s)
{
  PetscInt line = 1;
  for (const char *p = s->data; p < s->at; ++p) line += *p == '\n';
  return line;
}

/* The next word, which ends at white space; its length is 0 at the end. */
static size_t next_word(StlText *s)
{
  while (isspace((unsigned char)*s->at)) ++s->at;
  size_t n = 0;
  while (s->at[n] && !isspace((unsigned char)s->at[n])) ++n;
  return n;
}

static PetscBool is_word(const StlText *s, size_t n, const char *word)
{
  return n == strlen(word) && !strncasecmp(s->at, word, n);
}

/* Three finite numbers. */
static PetscBool take_vertex(StlText *s, PetscReal x[3])
{
  for (int d = 0; d < 3; ++d) {
    char *end;
    const size_t n = next_word(s);
    x[d] = strtod(s->at, &end);
    if (!n || end != s->at + n || !isfinite(x[d])) {
      (void)snprintf(s->message, s->size, "%s:%" PetscInt_FMT ": a vertex needs three numbers, not '%.*s'", s->path,
                     line_of(s), (int)PetscMin(n, 40), s->at);
      return PETSC_FALSE;
    }
    s->at = end;
  }
  return PETSC_TRUE;
}

/* Corners up to the end; with t = NULL they are only counted. Returns their number, or -1. */
static PetscInt walk_text(StlText *s, Triangles *t)
{
  PetscInt count = 0, in_facet = 0;
  for (size_t n; (n = next_word(s)); s->at += n) {
    PetscReal x[3];
    if (is_word(s, n, "solid") || is_word(s, n, "endsolid")) n = strcspn(s->at, "\n"); /* a name, of any words */
    if (is_word(s, n, "endfacet") || is_word(s, n, "facet")) {
      if (in_facet % 3 || (in_facet != 3 && is_word(s, n, "endfacet"))) {
        (void)snprintf(s->message, s->size, "%s:%" PetscInt_FMT ": a facet has three vertices, not %" PetscInt_FMT,
                       s->path, line_of(s), in_facet);
        return -1;
      }
      in_facet = 0;
    }
    if (!is_word(s, n, "vertex")) continue;
    s->at += n, n = 0;
    if (!take_vertex(s, x)) return -1;
    for (int d = 0; t && d < 3; ++d) t->corner[count / 3][count % 3][d] = x[d];
    ++count, ++in_facet;
  }
  if (!count || in_facet)
    (void)snprintf(s->message, s->size, "'%s' %s", s->path,
                   count ? "ends inside of a facet: it is truncated" : "has no triangles");
  return count && !in_facet ? count : -1;
}

static PetscErrorCode ReadText(StlText *s, Triangles *t)
{
  PetscFunctionBeginUser;
  const PetscInt corners = walk_text(s, NULL);
  if (corners < 0) PetscFunctionReturn(0);
  PetscCall(TrianglesAllocate(corners / 3, t));
  s->at = s->data;
  (void)walk_text(s, t);
  PetscFunctionReturn(0);
}

/* The numbers of the file are little-endian, as those of all machines that talus runs on. */
static PetscErrorCode ReadBinary(StlText *s, PetscInt n, Triangles *t)
{
  PetscFunctionBeginUser;
  PetscCall(TrianglesAllocate(n, t));
  for (PetscInt i = 0; i < n; ++i) {
    float value[12]; /* a normal that is not needed, three corners */
    memcpy(value, s->data + BINARY_HEAD + (size_t)BINARY_TRIANGLE * (size_t)i, sizeof value);
    for (int k = 0; k < 9; ++k) {
      t->corner[i][k / 3][k % 3] = (PetscReal)value[3 + k];
      if (!isfinite(value[3 + k]) && !s->message[0])
        (void)snprintf(s->message, s->size, "'%s': triangle %" PetscInt_FMT " has a corner that is no number", s->path,
                       i + 1);
    }
  }
  PetscFunctionReturn(0);
}

PetscErrorCode StlRead(const char *path, Triangles *t, size_t size, char *message)
{
  StlText s = {.path = path, .size = size};
  const char *why;
  char *data;
  size_t length;
  uint32_t n = 0;

  PetscFunctionBeginUser;
  s.message = message;
  message[0] = 0;
  PetscCall(FileLoad(path, &data, &length, &why));
  s.data = s.at = data;
  if (length >= BINARY_HEAD) memcpy(&n, data + BINARY_HEAD - sizeof n, sizeof n);
  const size_t expected = BINARY_HEAD + (size_t)BINARY_TRIANGLE * n;
  if (why) (void)snprintf(message, size, "cannot read '%s': %s", path, why);
  /* some binary files begin with "solid", too: their length tells */
  else if (n && length == expected) PetscCall(ReadBinary(&s, (PetscInt)n, t));
  else if (length > 5 && !strncasecmp(data, "solid", 5) && !memchr(data, 0, length)) PetscCall(ReadText(&s, t));
  else if (length >= BINARY_HEAD && strncasecmp(data, "solid", 5))
    (void)snprintf(message, size, "'%s' is no STL file: as a binary one with %u triangles it had %zu bytes, not %zu",
                   path, n, expected, length);
  else (void)snprintf(message, size, "'%s' is no STL file", path);
  PetscCall(PetscFree(data));
  PetscFunctionReturn(0);
}
