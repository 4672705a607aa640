#include "grid/gmsh/geo_script.h"
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define LONGEST_SCRIPT (64 << 20)
/* Gmsh cuts a text after 1023 characters and reads its rest as commands */
#define LONGEST_TEXT 1000

static PetscErrorCode Load(const char *path, GeoScript *s, const char **why)
{
  struct stat info;
  ssize_t got = 0;

  PetscFunctionBeginUser;
  /* a pipe without a writer must not keep us waiting */
  const int fd = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  *why = fd < 0 || fstat(fd, &info)      ? strerror(errno)
         : !S_ISREG(info.st_mode)        ? "not a plain file"
         : info.st_size > LONGEST_SCRIPT ? "more than 64 MiB, too large for a script"
                                         : NULL;
  if (!*why) {
    PetscCall(PetscCalloc1((size_t)info.st_size + 1, &s->text));
    for (s->n = 0; (got = read(fd, s->text + s->n, (size_t)info.st_size - s->n)) > 0;) s->n += (size_t)got;
    if (got < 0) *why = strerror(errno);
  }
  if (fd >= 0) (void)close(fd);
  PetscFunctionReturn(0);
}

size_t geo_quote_end(const GeoScript *s, size_t at)
{
  const char *end = at + 1 < s->n ? memchr(s->text + at + 1, s->text[at], s->n - at - 1) : NULL;
  return end ? (size_t)(end - s->text) : s->n;
}

/* Past the comment at `at`. */
static size_t comment_end(const GeoScript *s, size_t at)
{
  const char *end = strstr(s->text + at + 2, s->text[at + 1] == '*' ? "*/" : "\n");
  if (!end) return s->n;
  return (size_t)(end - s->text) + (s->text[at + 1] == '*' ? 2 : 0);
}

/* What each byte is, as long as Gmsh does not lose its place. */
static void classify(GeoScript *s, GeoFinding *finding)
{
  for (size_t at = 0, end; at < s->n; at = end) {
    const char c = s->text[at], next = s->text[at + 1];
    GeoKind kind = GEO_CODE;
    end = at + 1;
    if (c == '"' || c == '\'') {
      kind = GEO_TEXT;
      end = PetscMin(geo_quote_end(s, at) + 1, s->n);
      if (end - at > LONGEST_TEXT && !finding->reason)
        *finding =
          (GeoFinding){at, 1, "begins a text of more than 1000 characters, which Gmsh would cut and go on as commands"};
    } else if (c == '/' && (next == '/' || next == '*')) {
      kind = GEO_COMMENT;
      end = comment_end(s, at);
    }
    memset(s->kind + at, (int)kind, end - at);
  }
}

static PetscBool makes_gmsh_jump(const char *word, size_t n)
{
  static const char *const words[] = {"If", "ElseIf", "Else", "For", "Macro", "Function", "Call", NULL};
  for (int i = 0; words[i]; ++i)
    if (strlen(words[i]) == n && !strncmp(words[i], word, n)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* From the first jump, or from a last line that has no end. */
static size_t find_doubt(const GeoScript *s)
{
  const char *line = memrchr(s->text, '\n', s->n);
  const size_t last = line ? (size_t)(line - s->text) + 1 : 0;
  for (size_t at = 0, end; at < last; at = end) {
    end = PetscMax(at + 1, geo_word_end(s, at));
    /* For goes back, too */
    if (s->kind[at] == GEO_CODE && makes_gmsh_jump(s->text + at, end - at)) return 0;
  }
  return last;
}

PetscErrorCode GeoScriptRead(const char *path, GeoScript *s, GeoFinding *finding, const char **why)
{
  PetscFunctionBeginUser;
  *s = (GeoScript){.path = path};
  *finding = (GeoFinding){0};
  PetscCall(Load(path, s, why));
  if (*why) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(s->n + 1, &s->kind));
  const char *zero = memchr(s->text, 0, s->n);
  if (zero) *finding = (GeoFinding){(size_t)(zero - s->text), 1, "is a byte that no text holds"};
  else classify(s, finding);
  s->doubtful_from = find_doubt(s);
  s->prints = strstr(s->text, "Printf") != NULL;
  PetscFunctionReturn(0);
}

PetscErrorCode GeoScriptFree(GeoScript *s)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(s->text));
  PetscCall(PetscFree(s->kind));
  PetscFunctionReturn(0);
}

size_t geo_next(const GeoScript *s, size_t at)
{
  const PetscBool code = at > 0 && s->kind[at - 1] == GEO_CODE;
  while (at < s->n && (geo_is_space(s->text[at]) || (code && s->kind[at] == GEO_COMMENT))) ++at;
  return at;
}

size_t geo_word_end(const GeoScript *s, size_t at)
{
  while (at < s->n && (geo_is_letter(s->text[at]) || geo_is_digit(s->text[at]))) ++at;
  return at;
}
