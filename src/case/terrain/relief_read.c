/* ESRI ASCII grids: six lines of a word and a number, then the rows from north to south. */
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/file.h"
#include "case/terrain/relief.h"
#include "case/terrain/geotiff.h"

#define MOST_POSTS 50000000

typedef enum { KEY_COLUMNS, KEY_ROWS, KEY_X_CORNER, KEY_Y_CORNER, KEY_X_CENTRE, KEY_Y_CENTRE, KEY_SIZE, KEY_NONE } Key;
static const char *const keys[] = {"ncols",     "nrows",    "xllcorner",    "yllcorner", "xllcenter",
                                   "yllcenter", "cellsize", "nodata_value", NULL};

typedef struct {
  const char *at, *data, *path;
  size_t length, size;
  char *message;
  PetscReal head[KEY_NONE + 1];
  PetscBool has[KEY_NONE + 1];
} AscText;

static int line_of(const AscText *s)
{
  int line = 1;
  for (const char *p = s->data; p < s->at; ++p) line += *p == '\n';
  return line;
}

static size_t next_word(AscText *s)
{
  while (isspace((unsigned char)*s->at)) ++s->at;
  return strcspn(s->at, " \t\r\n");
}

static PetscBool take_number(AscText *s, const char *of, PetscReal *value)
{
  char *end;
  const size_t n = next_word(s);
  *value = strtod(s->at, &end);
  if (n && end == s->at + n && !isinf(*value)) {
    s->at = end;
    return PETSC_TRUE;
  }
  if (n)
    (void)snprintf(s->message, s->size, "%s:%d: %s is a number, not '%.*s'", s->path, line_of(s), of,
                   (int)PetscMin(n, 40), s->at);
  else (void)snprintf(s->message, s->size, "%s:%d: the file ends where %s should be", s->path, line_of(s), of);
  return PETSC_FALSE;
}

/* The first height may be none, "nan". */
static PetscBool is_key(const AscText *s, size_t n)
{
  return isalpha((unsigned char)*s->at) && !(n == 3 && !strncasecmp(s->at, "nan", 3));
}

static PetscBool take_head(AscText *s)
{
  for (size_t n = next_word(s); is_key(s, n); n = next_word(s)) {
    int k = 0;
    while (keys[k] && (strlen(keys[k]) != n || strncasecmp(s->at, keys[k], n))) ++k;
    if (!keys[k]) {
      (void)snprintf(s->message, s->size,
                     "%s:%d: unknown word '%.*s': an ESRI ASCII grid begins with ncols, nrows, xllcorner, yllcorner "
                     "(or xllcenter, yllcenter), cellsize and maybe NODATA_value",
                     s->path, line_of(s), (int)PetscMin(n, 40), s->at);
      return PETSC_FALSE;
    }
    s->at += n;
    if (!take_number(s, keys[k], &s->head[k])) return PETSC_FALSE;
    if (isnan(s->head[k]) && k != KEY_NONE) {
      (void)snprintf(s->message, s->size, "%s:%d: %s is a number, not nan", s->path, line_of(s), keys[k]);
      return PETSC_FALSE;
    }
    s->has[k] = PETSC_TRUE;
  }
  return PETSC_TRUE;
}

static PetscBool check_head(const AscText *s)
{
  const char *missing = s->has[KEY_SIZE] ? NULL : keys[KEY_SIZE];
  for (int d = 1; d >= 0; --d)
    if (!s->has[KEY_X_CORNER + d] && !s->has[KEY_X_CENTRE + d]) missing = keys[KEY_X_CORNER + d];
  for (int k = KEY_ROWS; k >= KEY_COLUMNS; --k)
    if (!s->has[k]) missing = keys[k];
  if (missing) {
    (void)snprintf(s->message, s->size, "%s: '%s' is missing: is it an ESRI ASCII grid?", s->path, missing);
    return PETSC_FALSE;
  }
  const PetscReal columns = s->head[KEY_COLUMNS], rows = s->head[KEY_ROWS];
  if (columns * rows > (PetscReal)s->length / 2) {
    (void)snprintf(s->message, s->size, "%s: the file is too short for %g columns and %g rows", s->path,
                   (double)columns, (double)rows);
    return PETSC_FALSE;
  }
  if (columns >= 2 && rows >= 2 && columns * rows <= MOST_POSTS && columns == floor(columns) && rows == floor(rows) &&
      s->head[KEY_SIZE] > 0)
    return PETSC_TRUE;
  (void)snprintf(s->message, s->size, "%s: %g columns and %g rows of cells of %g: 2 to %d whole ones of a size above 0",
                 s->path, (double)columns, (double)rows, (double)s->head[KEY_SIZE], MOST_POSTS);
  return PETSC_FALSE;
}

/* Posts are the centres of cells. The solid ends so far below that nothing falls out of it. */
static PetscBool take_heights(AscText *s, PetscReal scale, const PetscReal offset[3], Relief *r)
{
  PetscReal lowest = PETSC_MAX_REAL, width = 0;
  for (PetscInt j = r->n[1] - 1; j >= 0; --j)
    for (PetscInt i = 0; i < r->n[0]; ++i) {
      PetscReal z, *height = r->height + j * r->n[0] + i;
      if (!take_number(s, "a height", &z)) return PETSC_FALSE;
      *height = s->has[KEY_NONE] && z == s->head[KEY_NONE] ? (PetscReal)NAN : scale * z + offset[2]; /* nan: none */
      if (*height < lowest) lowest = *height;
    }
  if (next_word(s)) {
    (void)snprintf(s->message, s->size, "%s:%d: more than the %d x %d heights that the head says", s->path, line_of(s),
                   (int)r->n[0], (int)r->n[1]);
    return PETSC_FALSE;
  }
  if (lowest == PETSC_MAX_REAL) {
    (void)snprintf(s->message, s->size, "%s: no post has a height", s->path);
    return PETSC_FALSE;
  }
  for (int d = 0; d < 2; ++d) width += (PetscReal)(r->n[d] - 1) * r->step;
  r->bottom = lowest - width;
  return PETSC_TRUE;
}

static PetscErrorCode Make(AscText *s, PetscReal scale, const PetscReal offset[3], Relief **relief)
{
  Relief *r;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&r));
  r->step = scale * s->head[KEY_SIZE];
  for (int d = 0; d < 2; ++d) {
    const PetscBool centre = s->has[KEY_X_CENTRE + d];
    r->n[d] = (PetscInt)s->head[KEY_COLUMNS + d];
    r->low[d] = centre ? s->head[KEY_X_CENTRE + d] : s->head[KEY_X_CORNER + d] + s->head[KEY_SIZE] / 2;
    r->low[d] = scale * r->low[d] + offset[d];
  }
  PetscCall(PetscMalloc1(r->n[0] * r->n[1], &r->height));
  if (take_heights(s, scale, offset, r)) *relief = r;
  else PetscCall(ReliefDestroy(&r));
  PetscFunctionReturn(0);
}

PetscErrorCode ReliefRead(const char *path, PetscReal scale, const PetscReal offset[3], Relief **relief, size_t size,
                          char *message)
{
  AscText s = {.path = path, .size = size, .message = message};
  const char *why = NULL;
  char *data;
  size_t length;

  PetscFunctionBeginUser;
  *relief = NULL;
  message[0] = '\0';
  PetscCall(FileLoad(path, &data, &length, &why));
  if (!data) (void)snprintf(message, size, "%s: %s", path, why);
  if (data && geotiff_begins(data, length)) {
    PetscCall(PetscFree(data));
    PetscCall(GeotiffText(path, scale, &data, &length, size, message));
  }
  if (data && strlen(data) != length)
    (void)snprintf(message, size, "%s: not a text: terrain is an ESRI ASCII grid or a GeoTIFF", path);
  else if (data) {
    s.at = s.data = data;
    s.length = length;
    if (take_head(&s) && check_head(&s)) PetscCall(Make(&s, scale, offset, relief));
  }
  PetscCall(PetscFree(data));
  PetscFunctionReturn(0);
}
