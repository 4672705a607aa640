#include "base/text.h"
#include <stdlib.h>

PetscErrorCode TextOpen(TextStream *stream)
{
  PetscFunctionBeginUser;
  stream->out = open_memstream(&stream->text, &stream->size);
  PetscCheck(stream->out, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for a text");
  PetscFunctionReturn(0);
}

PetscErrorCode TextClose(TextStream *stream, char **text)
{
  PetscFunctionBeginUser;
  PetscCheck(!fclose(stream->out), PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for a text");
  PetscCall(PetscStrallocpy(stream->text, text));
  free(stream->text);
  PetscFunctionReturn(0);
}

const char *text_with_unit(const char *text, const char *unit, char buffer[TEXT_LABEL])
{
  const PetscBool known = unit && unit[0];
  snprintf(buffer, TEXT_LABEL, known ? "%.500s [%s]" : "%.500s", text, unit);
  return buffer;
}

const char *text_position(PetscInt dim, const PetscReal *x, char buffer[80])
{
  if (dim == 3) snprintf(buffer, 80, "(%g, %g, %g)", (double)x[0], (double)x[1], (double)x[2]);
  else snprintf(buffer, 80, "(%g, %g)", (double)x[0], (double)x[1]);
  return buffer;
}
