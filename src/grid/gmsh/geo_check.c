#include "grid/gmsh/geo_check.h"
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "grid/gmsh/geo_script.h"

#define MAX_SCRIPTS 64 /* read with one .geo */

typedef struct {
  Diag *diag;
  char *seen[MAX_SCRIPTS]; /* real paths */
  int n_seen;
  PetscBool safe;
} Check;

/* Where in the script: its line, to be freed with PetscFree, goes into the place. */
static PetscErrorCode Place(const GeoScript *s, size_t at, size_t width, char **line, DiagPlace *place)
{
  size_t start = at, end = at;

  PetscFunctionBeginUser;
  *place = (DiagPlace){.file = s->path, .line = 1, .column = 1, .width = (int)PetscMax(width, 1)};
  while (start > 0 && s->text[start - 1] != '\n') --start;
  while (end < s->n && s->text[end] && s->text[end] != '\n' && s->text[end] != '\r') ++end;
  for (size_t i = 0; i < start; ++i) place->line += s->text[i] == '\n';
  for (size_t i = start; i < at; ++i) place->column += (s->text[i] & 0xC0) != 0x80;
  PetscCall(PetscCalloc1(end - start + 1, line));
  memcpy(*line, s->text + start, end - start);
  place->text = *line;
  PetscFunctionReturn(0);
}

static PetscErrorCode Tell(Check *check, const GeoScript *s, const GeoFinding *finding)
{
  DiagPlace place;
  char *line;

  PetscFunctionBeginUser;
  PetscCall(Place(s, finding->at, finding->width, &line, &place));
  diag_at(check->diag, DIAG_ERROR, &place, "this %s: a mesh script may do so only if you trust it", finding->reason);
  diag_hint(check->diag, "look at it; if you know what it does, --trust on the command line lets it");
  check->safe = PETSC_FALSE;
  PetscCall(PetscFree(line));
  PetscFunctionReturn(0);
}

/* As Gmsh does it: from the folder of the file that names it. */
static void resolve(const char *from, const char *name, char path[PETSC_MAX_PATH_LEN])
{
  const char *slash = strrchr(from, '/');
  if (name[0] == '/' || !slash) snprintf(path, PETSC_MAX_PATH_LEN, "%s", name);
  else snprintf(path, PETSC_MAX_PATH_LEN, "%.*s/%s", (int)(slash - from), from, name);
}

static PetscBool ends_as(const char *name, const char *const *endings)
{
  const char *dot = strrchr(name, '.');
  for (int i = 0; dot && endings[i]; ++i)
    if (!strcmp(dot, endings[i])) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Drawings and meshes, which Gmsh knows by their ending. */
static PetscBool is_data(const char *name)
{
  static const char *const endings[] = {".stl",  ".STL", ".step", ".STEP", ".stp",  ".STP", ".iges",
                                        ".IGES", ".igs", ".IGS",  ".brep", ".BREP", NULL};
  return ends_as(name, endings);
}

/* What else is a script for Gmsh, unless it begins as a mesh does. */
static PetscBool is_script(const char *name)
{
  static const char *const endings[] = {".geo", ".pos", ".msh", ".opt", NULL};
  return ends_as(name, endings);
}

/* Already read, or too many; it is remembered. */
static PetscErrorCode Remember(Check *check, const char *path, PetscBool *known)
{
  char real[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  /* not there: reading it will say so */
  if (!realpath(path, real)) snprintf(real, sizeof real, "%s", path);
  *known = PETSC_FALSE;
  for (int i = 0; i < check->n_seen; ++i)
    if (!strcmp(check->seen[i], real)) *known = PETSC_TRUE;
  if (!*known && check->n_seen < MAX_SCRIPTS) PetscCall(PetscStrallocpy(real, &check->seen[check->n_seen++]));
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckScript(Check *check, const char *path, PetscBool merged, const char **why);

/* A file that the script reads in. */
static PetscErrorCode Follow(Check *check, const GeoScript *s, const GeoInclusion *inclusion)
{
  GeoFinding finding = {inclusion->at, inclusion->width, inclusion->problem};
  char path[PETSC_MAX_PATH_LEN], reason[300];
  const char *why = NULL;
  PetscBool known;

  PetscFunctionBeginUser;
  if (!finding.reason && inclusion->merged && is_data(inclusion->name)) PetscFunctionReturn(0);
  if (!finding.reason && inclusion->merged && !is_script(inclusion->name))
    finding.reason = "reads a file that is neither a script nor a drawing";
  if (!finding.reason) {
    resolve(s->path, inclusion->name, path);
    if (!inclusion->certain && access(path, F_OK)) PetscFunctionReturn(0);
    PetscCall(Remember(check, path, &known));
    if (known) PetscFunctionReturn(0);
    if (check->n_seen == MAX_SCRIPTS) finding.reason = "reads more files than talus looks through";
    else PetscCall(CheckScript(check, path, inclusion->merged, &why));
    if (why) snprintf(reason, sizeof reason, "reads '%.200s', which cannot be read (%.60s)", inclusion->name, why);
    if (why) finding.reason = reason;
  }
  if (finding.reason && check->safe) PetscCall(Tell(check, s, &finding));
  PetscFunctionReturn(0);
}

/* What Gmsh's Merge takes for data whatever its ending is. */
static PetscBool begins_as_mesh(const char *text)
{
  return !strncmp(text, "$MeshFormat", 11) || !strncmp(text, "$PostFormat", 11);
}

static PetscErrorCode CheckScript(Check *check, const char *path, PetscBool merged, const char **why)
{
  GeoScript script;
  GeoFinding finding;
  GeoInclusion inclusion;

  PetscFunctionBeginUser;
  PetscCall(GeoScriptRead(path, &script, &finding, why));
  if (!*why && !(merged && begins_as_mesh(script.text))) {
    if (!finding.reason) geo_find_action(&script, &finding);
    if (finding.reason) PetscCall(Tell(check, &script, &finding));
    for (size_t at = 0; check->safe && geo_next_inclusion(&script, &at, &inclusion);)
      PetscCall(Follow(check, &script, &inclusion));
  }
  PetscCall(GeoScriptFree(&script));
  PetscFunctionReturn(0);
}

PetscErrorCode GeoCheck(const char *path, Diag *diag, PetscBool *safe)
{
  Check check = {.diag = diag, .safe = PETSC_TRUE};
  char options[PETSC_MAX_PATH_LEN];
  const char *why = NULL;
  PetscBool known;

  PetscFunctionBeginUser;
  snprintf(options, sizeof options, "%s.opt", path);
  PetscCall(Remember(&check, path, &known));
  PetscCall(CheckScript(&check, path, PETSC_FALSE, &why));
  if (!why && check.safe && !access(options, F_OK)) {
    PetscCall(CheckScript(&check, options, PETSC_FALSE, &why));
    if (why) diag_error(diag, NULL, "cannot read '%s': %s", options, why);
  } else if (why) diag_error(diag, NULL, "cannot read '%s': %s", path, why);
  for (int i = 0; i < check.n_seen; ++i) PetscCall(PetscFree(check.seen[i]));
  *safe = check.safe && !why;
  PetscFunctionReturn(0);
}
