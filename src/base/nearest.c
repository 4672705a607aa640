#include "base/diag/diag.h"
#include <ctype.h>
#include <string.h>

#define LONGEST 64    /* words beyond this are never near each other */
#define LEAST_ALIKE 4 /* letters at the beginning of words that are kin */
#define TOO_SHORT 2   /* a word of so many letters with another one in it is any other word */

static int plain(char c) { return c == '_' ? '-' : tolower((unsigned char)c); }

static int nearest_least(int a, int b) { return a < b ? a : b; }

/* Damerau-Levenshtein (optimal string alignment); case and '_' against '-' do not count. */
static int nearest_distance(const char *a, const char *b)
{
  const int n = (int)strlen(a), m = (int)strlen(b);
  int row[3][LONGEST + 1];
  int *before = row[0], *last = row[1], *now = row[2];
  for (int j = 0; j <= m; ++j) last[j] = j;
  for (int i = 1; i <= n; ++i) {
    now[0] = i;
    for (int j = 1; j <= m; ++j) {
      const int differ = plain(a[i - 1]) != plain(b[j - 1]);
      now[j] = nearest_least(nearest_least(last[j] + 1, now[j - 1] + 1), last[j - 1] + differ);
      if (i > 1 && j > 1 && plain(a[i - 1]) == plain(b[j - 2]) && plain(a[i - 2]) == plain(b[j - 1]))
        now[j] = nearest_least(now[j], before[j - 2] + 1);
    }
    int *free_row = before;
    before = last;
    last = now;
    now = free_row;
  }
  return last[m];
}

/* How many letters two words begin with alike. */
static size_t nearest_alike(const char *a, const char *b)
{
  size_t n = 0;
  while (a[n] && plain(a[n]) == plain(b[n])) ++n;
  return n;
}

/* The word that begins as this one does for more than half of it: friction_angle of friction. */
static const char *nearest_kin(const char *word, const char *const *words)
{
  const char *best = NULL;
  size_t most = PetscMax(LEAST_ALIKE - 1, strlen(word) / 2);
  for (; *words; ++words) {
    const size_t alike = nearest_alike(word, *words);
    if (alike <= most) continue;
    most = alike;
    best = *words;
  }
  return best;
}

const char *diag_nearest(const char *word, const char *const *words)
{
  const char *best = NULL;
  const size_t length = word ? strlen(word) : 0;
  int least = 1 + (int)(length + 1) / 3;
  if (length == 0 || length > LONGEST) return NULL;
  for (const char *const *w = words; *w; ++w) {
    if (strlen(*w) > LONGEST) continue;
    const int distance = nearest_distance(word, *w);
    if (distance > 0 && length <= TOO_SHORT && strlen(*w) == length) continue;
    if (distance < least) {
      least = distance;
      best = *w;
    }
  }
  return best ? best : nearest_kin(word, words);
}

void diag_hint_names(Diag *diag, const char *word, const char *const *words)
{
  const char *nearest = diag_nearest(word, words);
  char list[500] = "";
  for (const char *const *w = words; *w; ++w) {
    const size_t used = strlen(list);
    snprintf(list + used, sizeof(list) - used, "%s%s", w == words ? "" : ", ", *w);
  }
  if (strlen(list) + 1 == sizeof(list)) strcpy(list + sizeof(list) - 4, "...");
  if (!list[0]) diag_hint(diag, "there are no names");
  else if (nearest) diag_hint(diag, "did you mean '%s'? There are: %s", nearest, list);
  else diag_hint(diag, "there are: %s", list);
}
