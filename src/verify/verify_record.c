/* docs/verification.md: one section a case, between two comments, replaced as a whole. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/text.h"
#include "output/directory/run_dir_files.h"
#include "verify/verify_private.h"

void verify_record_file(const char *folder, char file[PETSC_MAX_PATH_LEN])
{
  PetscSNPrintf(file, PETSC_MAX_PATH_LEN, "%s/../../docs/verification.md", folder);
}

/* A whole file as text (free), NULL with errno if it cannot be read. */
static char *read_text(const char *file)
{
  FILE *in = file_open_read(file);
  char *text = NULL;
  size_t size = 0;
  if (!in) return NULL;
  const ssize_t n = getdelim(&text, &size, '\0', in);
  const int error = ferror(in) ? EIO : 0;
  fclose(in);
  if (n >= 0 && !error) return text;
  free(text);
  errno = error;
  return error ? NULL : strdup("");
}

/* `text` with `section` where the marks stand; without marks, at the end. */
static void write_merged(FILE *out, const char *text, const char *begin, const char *end, const char *section)
{
  const char *from = strstr(text, begin), *to = from ? strstr(from, end) : NULL;
  if (from && to) fwrite(text, 1, (size_t)(from - text), out);
  else fprintf(out, "%s%s", text, text[0] && text[strlen(text) - 1] != '\n' ? "\n\n" : "\n");
  fprintf(out, "%s\n%s%s", begin, section, end);
  fputs(from && to ? to + strlen(end) : "\n", out);
}

PetscErrorCode VerifyRecord(const char *file, const char *name, const char *section, int *error)
{
  char begin[300], end[300], *merged, *text = read_text(file);
  TextStream stream;

  PetscFunctionBeginUser;
  *error = text ? 0 : errno;
  if (!text) PetscFunctionReturn(0);
  PetscCall(PetscSNPrintf(begin, sizeof begin, "<!-- begin %s -->", name));
  PetscCall(PetscSNPrintf(end, sizeof end, "<!-- end %s -->", name));
  PetscCall(TextOpen(&stream));
  write_merged(stream.out, text, begin, end, section);
  PetscCall(TextClose(&stream, &merged));
  *error = file_write_text(file, merged);
  PetscCall(PetscFree(merged));
  free(text);
  PetscFunctionReturn(0);
}
