/* A sweep from the options of a command line, in their order: --along belongs to the --over before
 * it, --band to the --measure before it. */
#include <stdlib.h>
#include <string.h>
#include "sweep/sweep_spec.h"

static const char *const options[] = {"over", "along", "measure", "band"};

void sweep_word_error(Diag *diag, const SweepWord *word, const char *message)
{
  char text[512];
  const DiagPlace place = {.file = text, .width = 1};
  snprintf(text, sizeof text, "--%s %s", options[word->kind], word->text);
  diag_at(diag, DIAG_ERROR, &place, "%s", message);
}

/* A new last item of an array that is all zeros. */
static PetscErrorCode Grow(PetscInt *n, size_t size, void **array, void **item)
{
  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((size_t)(*n + 1) * size, array));
  *item = (char *)*array + (size_t)(*n)++ * size;
  PetscCall(PetscMemzero(*item, size));
  PetscFunctionReturn(0);
}

static PetscErrorCode AddKey(const SweepWord *word, Diag *diag, SweepSpecification *s)
{
  const char *equals = strchr(word->text, '=');
  SweepAxis *axis = s->n_axes ? &s->axes[s->n_axes - 1] : NULL;
  void *item = NULL;

  PetscFunctionBeginUser;
  if (!equals || equals == word->text || !equals[1]) {
    sweep_word_error(diag, word, "this is no key=values");
    diag_hint(diag, "for example --over materials.sugar.friction_angle=35:47:2 or --over grid.size=0.1,0.05");
  } else if (word->kind == SWEEP_ALONG && !axis) {
    sweep_word_error(diag, word, "there is no --over before it, along which it could vary");
  } else {
    if (word->kind == SWEEP_OVER) PetscCall(Grow(&s->n_axes, sizeof(SweepAxis), (void **)&s->axes, &item));
    else PetscCall(Grow(&axis->n_along, sizeof(SweepKey), (void **)&axis->along, &item));
    SweepKey *key = item; /* an axis begins with its key */
    key->word = word;
    PetscCall(PetscStrallocpy(word->text, &key->key));
    key->key[equals - word->text] = '\0';
    PetscCall(PetscStrallocpy(equals + 1, &key->text));
  }
  PetscFunctionReturn(0);
}

/* flow, flow:max, flow:mean:0.2:0.8 */
static PetscErrorCode AddMeasure(const SweepWord *word, Diag *diag, SweepSpecification *s)
{
  const char *words[8] = {NULL};
  char *part[4] = {NULL}, *rest, *end[2] = {NULL};
  void *item = NULL;
  PetscInt n = 0, take = 0;

  PetscFunctionBeginUser;
  PetscCall(Grow(&s->n_measures, sizeof(SweepMeasure), (void **)&s->measures, &item));
  Taken *taken = &((SweepMeasure *)item)->taken;
  PetscCall(PetscStrallocpy(word->text, &rest));
  taken->measure = rest; /* the part before the first colon is the name */
  taken->times = 1;
  while (rest && n < 4) part[n++] = strsep(&rest, ":");
  while (take_words[take].word && part[1] && strcmp(take_words[take].word, part[1])) ++take;
  for (PetscInt k = 0; take_words[k].word; ++k) words[k] = take_words[k].word;
  if (!take_words[take].word) {
    sweep_word_error(diag, word, "there is nothing of this name to be taken from a measure");
    diag_hint_names(diag, part[1], words);
  } else taken->take = (Take)take_words[take].value;
  if (n == 4 && !rest) {
    taken->has_window = PETSC_TRUE;
    taken->from = (PetscReal)strtod(part[2], &end[0]);
    taken->to = (PetscReal)strtod(part[3], &end[1]);
  }
  if (n == 3 || rest || (n == 4 && (*end[0] || *end[1] || taken->to < taken->from)))
    sweep_word_error(diag, word, "a window has two moments in s: measure:mean:0.2:0.8");
  PetscFunctionReturn(0);
}

/* NAME=lo:hi or NAME=value */
static PetscErrorCode AddBand(const SweepWord *word, Diag *diag, SweepSpecification *s)
{
  const char *equals = strrchr(word->text, '=');
  char *end = NULL;
  void *item = NULL;

  PetscFunctionBeginUser;
  if (!s->n_measures) {
    sweep_word_error(diag, word, "there is no --measure before it, to whose picture it could belong");
    PetscFunctionReturn(0);
  }
  SweepMeasure *measure = &s->measures[s->n_measures - 1];
  PetscCall(Grow(&measure->n_bands, sizeof(SweepBand), (void **)&measure->bands, &item));
  SweepBand *band = item;
  PetscCall(PetscStrallocpy(word->text, &band->name));
  if (equals) {
    band->name[equals - word->text] = '\0';
    band->low = band->high = (PetscReal)strtod(equals + 1, &end);
    if (*end == ':') band->high = (PetscReal)strtod(end + 1, &end);
  }
  if (!equals || equals == word->text || *end || !equals[1] || !(band->high >= band->low)) {
    sweep_word_error(diag, word, "this is no NAME=lowest:highest");
    diag_hint(diag, "for example --band 'experiments=60:70'");
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SweepFileFromWords(PetscInt n, const SweepWord *words, Diag *diag, SweepFile **sweeps)
{
  const PetscInt before = diag_errors(diag);

  PetscFunctionBeginUser;
  PetscCall(PetscNew(sweeps));
  PetscCall(PetscCalloc1(1, &(*sweeps)->sweeps));
  (*sweeps)->n = 1;
  for (PetscInt i = 0; i < n; ++i) {
    if (words[i].kind <= SWEEP_ALONG) PetscCall(AddKey(&words[i], diag, (*sweeps)->sweeps));
    else if (words[i].kind == SWEEP_MEASURE) PetscCall(AddMeasure(&words[i], diag, (*sweeps)->sweeps));
    else PetscCall(AddBand(&words[i], diag, (*sweeps)->sweeps));
  }
  if (diag_errors(diag) > before) PetscCall(SweepFileDestroy(sweeps));
  PetscFunctionReturn(0);
}
