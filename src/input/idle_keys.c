/* Keys of dynamics in a case that has none: without effect, and so told. */
#include "input/idle_keys.h"
#include <math.h>
#include <string.h>
#include "base/text.h"
#include "method/transfer/transfer.h"

/* Is the key given, and would it change anything? */
static PetscBool asks(const YamlNode *analysis, const AnalysisSpec *a, const char *key)
{
  if (!yaml_find(analysis, key)) return PETSC_FALSE;
  if (!strcmp(key, "damping")) return (PetscBool)(a->damping != 0);
  if (!strcmp(key, "bossak")) return (PetscBool)(a->bossak != 0);
  if (!strcmp(key, "beta")) return (PetscBool)(fabs(a->beta - 0.25 * (1 - a->bossak) * (1 - a->bossak)) > 1e-12);
  if (!strcmp(key, "gamma")) return (PetscBool)(fabs(a->gamma - (0.5 - a->bossak)) > 1e-12);
  if (!strcmp(key, "mass")) return (PetscBool)(a->mass != MASS_CONSISTENT);
  if (!strcmp(key, "transfer")) return (PetscBool)(strcmp(a->transfer, transfers[0]->name) != 0);
  return (PetscBool)(strcmp(key, "keep_velocity") || a->keep_velocity);
}

static PetscBool is_still(const PetscReal v[3]) { return (PetscBool)(v[0] == 0 && v[1] == 0 && v[2] == 0); }

static void list_key(FILE *out, char first[128], const char *path)
{
  fprintf(out, "%s%s", first[0] ? ", " : "", path);
  if (!first[0]) snprintf(first, 128, "%s", path);
}

static void list_keys(FILE *out, char first[128], const YamlNode *root, const Case *c)
{
  static const char *const keys[] = {"damping", "bossak",   "beta", "gamma",
                                     "scheme",  "transfer", "mass", "keep_velocity"};
  char path[128];
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(keys); ++k) {
    snprintf(path, sizeof path, "analysis.%s", keys[k]);
    if (asks(yaml_find(root, "analysis"), &c->analysis, keys[k])) list_key(out, first, path);
  }
  for (PetscInt b = 0; b < c->n_bodies; ++b)
    for (int spin = 0; spin < 2; ++spin) {
      snprintf(path, sizeof path, "bodies[%d].%s", (int)b, spin ? "spin" : "velocity");
      if (!is_still(spin ? c->bodies[b].spin : c->bodies[b].velocity)) list_key(out, first, path);
    }
}

PetscErrorCode TellIdleKeys(const YamlDocument *document, const Case *c, Diag *diag)
{
  TextStream stream;
  char *text, first[128] = "";

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < case_stages(c); ++k)
    if (!case_is_static(&case_stage(c, k)->analysis)) PetscFunctionReturn(0);
  PetscCall(TextOpen(&stream));
  list_keys(stream.out, first, document->root, c);
  PetscCall(TextClose(&stream, &text));
  if (first[0])
    diag_warning(diag, first, "without effect, since nothing here is dynamic: %s (see analysis.type)", text);
  PetscCall(PetscFree(text));
  PetscFunctionReturn(0);
}
