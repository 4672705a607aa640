#include "output/checkpoint/checkpoint_contents.h"
#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>
#include "output/checkpoint/checkpoint.h"

/*   talus checkpoint
 *   version 3
 *   bytes 123456
 *   datasets 2
 *   points/position real 2 1000 8192 0123abcd
 *   model/time real 1 1 24192 01234567 everywhere
 *   end 89abcdef
 */
const char *const contents_types[] = {"real", "int64", "int32", "byte", NULL};

static const char title[] = "talus checkpoint\n";

static uint32_t text_crc(const char *text, size_t n)
{
  return (uint32_t)crc32(crc32(0, Z_NULL, 0), (const Bytef *)text, (uInt)n);
}

char *contents_write(const Contents *c)
{
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  if (!out) return NULL;
  fprintf(out, "%sversion %d\nbytes %" PRId64 "\ndatasets %d\n", title, CHECKPOINT_VERSION, (int64_t)c->file_bytes,
          (int)c->n);
  for (PetscInt i = 0; i < c->n; ++i) {
    const ContentsEntry *e = &c->entries[i];
    fprintf(out, "%s/%s %s %d %" PRId64 " %" PRId64 " %08" PRIx32 "%s\n", e->table, e->column, contents_types[e->type],
            (int)e->components, (int64_t)e->rows, (int64_t)e->offset, e->crc, e->everywhere ? " everywhere" : "");
  }
  fflush(out);
  const uint32_t crc = text_crc(text, size);
  fprintf(out, "end %08" PRIx32 "\n", crc);
  if (!fclose(out)) return text;
  free(text);
  return NULL;
}

static PETSC_ATTRIBUTE_FORMAT(2, 3) PetscBool refuse(char reason[256], const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(reason, 256, format, arguments);
  va_end(arguments);
  return PETSC_FALSE;
}

/* One `table/column type components rows offset crc [everywhere]`; no number is trusted. */
static PetscBool read_entry(const char *line, PetscInt64 file_bytes, ContentsEntry *e)
{
  char type[8], flag[12] = "", rest;
  int components;
  int64_t rows, offset;
  /* NOLINTNEXTLINE(cert-err34-c): checksum and checks below stop a number out of range */
  const int found = sscanf(line, "%47[a-z_0-9]/%47[a-z_0-9] %7s %d %" SCNd64 " %" SCNd64 " %8" SCNx32 " %11s %c",
                           e->table, e->column, type, &components, &rows, &offset, &e->crc, flag, &rest);
  if (found != 7 && found != 8) return PETSC_FALSE;
  if (found == 8 && strcmp(flag, "everywhere")) return PETSC_FALSE;
  int t = 0;
  while (contents_types[t] && strcmp(contents_types[t], type)) ++t;
  if (!contents_types[t]) return PETSC_FALSE;
  e->type = (ColumnType)t;
  e->components = components;
  e->rows = rows;
  e->offset = offset;
  e->everywhere = found == 8;
  if (components < 0 || components > 4096 || rows < 0 || rows > PETSC_MAX_INT || offset < 0 || offset > file_bytes)
    return PETSC_FALSE;
  const PetscInt64 row = (PetscInt64)column_type_bytes(e->type) * components;
  return row == 0 || rows <= (file_bytes - offset) / row;
}

/* All columns of a table stand together and have as many rows. */
static PetscBool is_consistent(const Contents *c, PetscInt i)
{
  const ContentsEntry *e = &c->entries[i], *before = i ? e - 1 : NULL;
  if (before && !strcmp(before->table, e->table)) {
    PetscInt first = i;
    while (first > 0 && !strcmp(c->entries[first - 1].table, e->table)) --first;
    if (i - first >= TABLE_MAX_COLUMNS) return PETSC_FALSE;
    return before->rows == e->rows && before->everywhere == e->everywhere;
  }
  for (PetscInt k = 0; k < i; ++k)
    if (!strcmp(c->entries[k].table, e->table)) return PETSC_FALSE;
  return PETSC_TRUE;
}

static PetscBool read_entries(char *text, PetscInt64 file_bytes, Contents *c, char reason[256])
{
  char *line = text;
  for (PetscInt i = 0; i < c->n; ++i) {
    char *end = strchr(line, '\n');
    if (end) *end = 0;
    if (!end || !read_entry(line, file_bytes, &c->entries[i]) || !is_consistent(c, i))
      return refuse(reason, "line %d of its contents makes no sense", (int)i + 5);
    line = end + 1;
  }
  return *line ? refuse(reason, "its contents list more than they count") : PETSC_TRUE;
}

/* The list in a text that ends behind `datasets`; the line `end` has been cut off. */
static PetscBool read_list(char *text, PetscInt64 file_bytes, Contents *c, char reason[256])
{
  int version = 0, n = 0, head = 0;
  int64_t bytes = 0;
  /* NOLINTNEXTLINE(cert-err34-c): checksum and checks below stop a number out of range */
  if (sscanf(text + strlen(title), "version %d\n", &version) != 1)
    return refuse(reason, "it does not tell its version");
  if (version != CHECKPOINT_VERSION)
    return refuse(reason, "it is of version %d, this program reads version %d", version, CHECKPOINT_VERSION);
  /* NOLINTNEXTLINE(cert-err34-c): checksum and checks below stop a number out of range */
  if (sscanf(text + strlen(title), "version %d\nbytes %" SCNd64 "\ndatasets %d%n", &version, &bytes, &n, &head) < 3 ||
      n < 0 || n > CONTENTS_MAX / 16 || text[strlen(title) + (size_t)head] != '\n')
    return refuse(reason, "its contents make no sense");
  if (bytes != file_bytes)
    return refuse(reason, "it is %" PRId64 " bytes long and should have %" PRId64, (int64_t)file_bytes, bytes);
  c->file_bytes = bytes;
  c->n = n;
  c->entries = calloc((size_t)n + 1, sizeof *c->entries);
  if (!c->entries) return refuse(reason, "there is no memory for its contents");
  if (read_entries(text + strlen(title) + head + 1, file_bytes, c, reason)) return PETSC_TRUE;
  free(c->entries);
  c->entries = NULL;
  return PETSC_FALSE;
}

PetscBool contents_read(const char *bytes, size_t n, PetscInt64 file_bytes, Contents *c, char reason[256])
{
  uint32_t crc;
  *c = (Contents){0};
  if (n < strlen(title) || memcmp(bytes, title, strlen(title))) return refuse(reason, "it is no checkpoint of talus");
  char *text = malloc(n + 1);
  if (!text) return refuse(reason, "there is no memory for its contents");
  memcpy(text, bytes, n);
  text[n] = 0;
  char *end = strstr(text, "\nend ");
  PetscBool ok = PETSC_FALSE;
  /* NOLINTNEXTLINE(cert-err34-c): checksum and checks below stop a number out of range */
  if (!end || sscanf(end, "\nend %8" SCNx32, &crc) != 1) refuse(reason, "its contents are cut off");
  else if (text_crc(text, (size_t)(end + 1 - text)) != crc) refuse(reason, "the checksum of its contents is wrong");
  else {
    end[1] = 0;
    ok = read_list(text, file_bytes, c, reason);
  }
  free(text);
  return ok;
}
