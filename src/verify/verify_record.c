/* docs/verification.md: one section a case, between two comments, replaced as a whole or study by
 * study. */
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

/* The part of the text that gives way. */
typedef struct {
  const char *from, *to;
} Part;

/* Of a section its study's part: from its heading to the next, or to the end; empty there, if it has
 * none. */
static Part part_of_study(Part section, const char *study)
{
  char heading[300];
  PetscSNPrintf(heading, sizeof heading, "\n### %s:", study);
  const char *from = strstr(section.from, heading);
  if (!from || from > section.to) return (Part){section.to, section.to};
  const char *next = strstr(from + 1, "\n### ");
  return (Part){from, next && next < section.to ? next : section.to};
}

/* `text` with the section where its marks stand, without marks at the end. Of a study run alone its
 * part takes the place of the one there. */
static void write_merged(FILE *out, const char *text, const char *name, const VerifySection *section)
{
  char begin[300], end[300];
  PetscSNPrintf(begin, sizeof begin, "<!-- begin %s -->\n", name);
  PetscSNPrintf(end, sizeof end, "<!-- end %s -->", name);
  const char *from = strstr(text, begin), *to = from ? strstr(from, end) : NULL;
  if (!from || !to) {
    fprintf(out, "%s%s%s%s%s\n", text, text[0] && text[strlen(text) - 1] != '\n' ? "\n\n" : "\n", begin, section->all,
            end);
    return;
  }
  Part part = {from + strlen(begin), to};
  if (section->study) part = part_of_study(part, section->study);
  fwrite(text, 1, (size_t)(part.from - text), out);
  fprintf(out, "%s%s", section->study ? section->alone : section->all, part.to);
}

PetscErrorCode VerifyRecord(const char *file, const char *name, const VerifySection *section, int *error)
{
  char *merged, *text = read_text(file);
  TextStream stream;

  PetscFunctionBeginUser;
  *error = text ? 0 : errno;
  if (!text) PetscFunctionReturn(0);
  PetscCall(TextOpen(&stream));
  write_merged(stream.out, text, name, section);
  PetscCall(TextClose(&stream, &merged));
  *error = file_write_text(file, merged);
  PetscCall(PetscFree(merged));
  free(text);
  PetscFunctionReturn(0);
}
