#include "base/diag/diag.h"
#include <ctype.h>
#include <string.h>

#define LONGEST 64 /* words beyond this are never near each other */

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

const char *diag_nearest(const char *word, const char *const *words)
{
  const char *best = NULL;
  const size_t length = word ? strlen(word) : 0;
  int least = 1 + (int)(length + 1) / 3;
  if (length == 0 || length > LONGEST) return NULL;
  for (; *words; ++words) {
    if (strlen(*words) > LONGEST) continue;
    const int distance = nearest_distance(word, *words);
    if (distance < least) {
      least = distance;
      best = *words;
    }
  }
  return best;
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
