#include "picture/label.h"
#include <string.h>
#include "picture/gnuplot.h"

#define ROOM_WIDTH 560 /* pixels at which letters have their own size */
#define ROOM_HEIGHT 230

static PetscBool begins_letter(char c) { return ((unsigned char)c & 0xC0) != 0x80; }

static PetscInt count_letters(const char *text)
{
  PetscInt n = 0;
  for (; *text; ++text) n += begins_letter(*text);
  return n;
}

/* Where letter k begins. */
static const char *letter(const char *text, PetscInt k)
{
  for (; *text; ++text)
    if (begins_letter(*text) && k-- == 0) break;
  return text;
}

/* What is kept of the end. */
static const char *ending_of(const char *text, PetscInt n, PetscInt most)
{
  const char *bracket = strrchr(text, '[');
  if (bracket > text && bracket[-1] == ' ') return bracket - 1;
  return letter(text, n - most / 4);
}

void label_write(FILE *out, const char *text, PetscInt most)
{
  const PetscInt n = count_letters(text);
  char cut[1024];
  if (n <= most) {
    gnuplot_quote(out, text);
    return;
  }
  const char *ending = ending_of(text, n, most);
  const PetscInt kept = PetscMax(most - 1 - count_letters(ending), 3);
  snprintf(cut, sizeof cut, "%.*s…%s", (int)(letter(text, kept) - text), text, ending);
  gnuplot_quote(out, cut);
}

double label_scale(int width, int height)
{
  const double scale = PetscMin((double)width / ROOM_WIDTH, (double)height / ROOM_HEIGHT);
  return PetscMin(PetscMax(scale, 0.5), 1);
}
